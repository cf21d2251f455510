"""unity_groups.py LIST: which files of a target are compiled together (cmake/unity.cmake).

A line of LIST is a target and its sources, with | between them. Prints "target|group|source" for all sources that have
company. Names are found as the linter finds them.
"""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/lint"))
import units  # noqa: E402

# More would save little, and the last ones would keep one core busy while others wait.
GROUP_FILES = 10


def main(lists):
    for line in pathlib.Path(lists).read_text().splitlines():
        target, *sources = line.split("|")
        files = [pathlib.Path(source) for source in sources]
        for i, unit in enumerate(units.units(files, ROOT, GROUP_FILES, rename=False)):
            for file in unit if len(unit) > 1 else []:
                print(target, f"{target}_{i}", file, sep="|")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])

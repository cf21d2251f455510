#!/usr/bin/env python3
"""Fails where a page or a comment names a file of the repository that is not there.

docs_test.py [ROOT]      prints each such name, exit 1 if there is one
docs_test.py --self-test    plants names, right and wrong, into small trees and expects each to be judged so

Pages are README.md, CONTRIBUTING.md, SECURITY.md and everything below docs/: their links, their headings that links point
to, and every path that starts with a folder of the repository. docs/paper-map.md also has paths below libcore/ and tests/, the
latter without an extension, and after a path the names that this file must contain. Comments are those of C++, Python and
CMake files.
"""
import re
import sys
import tempfile
from pathlib import Path

FOLDERS = ("libcore", "formats", "tools", "python", "tests", "docs", "schemas", "packaging", "cmake", "examples")
ROOTED = re.compile(r"(?<![\w/.$}-])(?:" + "|".join(FOLDERS) + r")/[\w./*-]*[\w/*]")
LINK = re.compile(r"\]\(([^)\s]+)\)")
SPAN = re.compile(r"`([^`\n]+)`")
BARE = re.compile(r"[\w-]+\.(?:h|cpp|py|mjs|cmake)")  # file names of the project's own kinds
IN_ROOM = re.compile(r"(?<![\w/.-])(\w+)/\w+\.(?:h|cpp)\b")
SOURCES = {".h", ".cpp", ".py", ".cmake", ".txt"}
PLANTED = ("check_includes.py", "docs_test.py")  # scripts that name files of made-up trees
MADE = ("tests/interop/node_modules", "tests/bench/peers/node_modules")  # by ./run


def exists(root, path):
    if path.startswith(MADE):
        return True
    if "*" in path:
        return any(root.glob(path))
    return (root / path).exists()


def anchors(page):
    """The names by which links reach the headings of a page, as GitHub makes them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", h.lower()).replace(" ", "-") for h in headings}


def wrong_links(root, page, text):
    for target in LINK.findall(text):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        if not file.exists():
            yield f"links to {target}"
        elif anchor and file.suffix == ".md" and anchor not in anchors(file):
            yield f"links to {target}, which has no such heading"


def paper_map_names(root, text):
    """Names of docs/paper-map.md: paths below libcore/ and tests/, and what the file before contains."""
    for line in text.splitlines():
        if not line.startswith("|"):
            continue
        for cell in line.split("|"):
            file = None
            for span in SPAN.findall(cell):
                if BARE.fullmatch(span):
                    files = list((root / "libcore").rglob(span))
                elif re.fullmatch(r"[\w-]+/[\w./-]*", span) and not span.startswith(FOLDERS):
                    files = [p for p in (root / "libcore" / span, root / "tests" / f"{span}.cpp",
                                         root / "tests" / f"{span}.py") if p.exists()]
                else:
                    words = re.fullmatch(r"(?:\w+::)*(\w+)", span)
                    pair = [p for p in file.parent.glob(file.stem + ".*")] if file else []
                    if words and pair and not any(re.search(rf"\b{words[1]}\b", p.read_text(encoding="utf-8")) for p in pair):
                        yield f"says that {span} is in {file.name}"
                    continue
                file = files[0] if files else None
                if not file:
                    yield f"names {span}"


def wrong_names(root, page):
    text = page.read_text(encoding="utf-8")
    yield from wrong_links(root, page, text)
    for path in ROOTED.findall(text):
        if not exists(root, path):
            yield f"names {path}"
    if page.name == "paper-map.md":
        yield from paper_map_names(root, text)
        return
    for span in SPAN.findall(text):
        if BARE.fullmatch(span) and not any(any((root / folder).rglob(span)) for folder in FOLDERS):
            yield f"names {span}"
        yield from wrong_rooms(root, span)


def wrong_rooms(root, text):
    """Paths such as param/relax.h, which start with a room of libcore or formats."""
    for match in IN_ROOM.finditer(text):
        layers = [layer for layer in ("libcore", "formats") if (root / layer / match[1]).is_dir()]
        if layers and not any((root / layer / match[0]).exists() for layer in layers):
            yield f"names {match[0]}"


def comment_text(path):
    """The comments of a source, one a line; the compiler looks after its includes."""
    mark = r"//.*$" if path.suffix in (".h", ".cpp") else r"#.*$"
    return "\n".join(re.findall(mark, path.read_text(encoding="utf-8"), re.MULTILINE))


def findings(root):
    pages = [root / name for name in ("README.md", "CONTRIBUTING.md", "SECURITY.md")]
    for page in [p for p in pages if p.exists()] + sorted((root / "docs").rglob("*.md")):
        for wrong in wrong_names(root, page):
            yield f"{page.relative_to(root)} {wrong}"
    for folder in FOLDERS:
        for source in sorted((root / folder).rglob("*")):
            if source.suffix not in SOURCES or "node_modules" in source.parts or source.name in PLANTED:
                continue
            text = comment_text(source)
            for path in ROOTED.findall(text):
                if not exists(root, path):
                    yield f"{source.relative_to(root)} names {path}"
            for wrong in wrong_rooms(root, text):
                yield f"{source.relative_to(root)} {wrong}"


TREE = {"libcore/param/relax.cpp": "void relax() {}\n", "tests/unit/relax_test.cpp": "", "docs/a.md": "# One thing\n"}
# (file, text, whether it is wrong)
CASES = [
    ("README.md", "[page](docs/a.md#one-thing)", False),
    ("README.md", "[page](docs/b.md)", True),
    ("README.md", "[page](docs/a.md#another)", True),
    ("README.md", "[page](https://example.org/docs/b.md)", False),
    ("README.md", "run tests/unit/relax_test.cpp.", False),
    ("README.md", "run `tests/unit/relax.cpp`", True),
    ("README.md", "all of `tests/unit/*_test.cpp`", False),
    ("docs/b.md", "`relax.cpp`, `param/relax.cpp`, `photo.png`", False),
    ("docs/b.md", "`relaxed.cpp`", True),
    ("docs/b.md", "`param/relaxed.h`", True),
    ("docs/paper-map.md", "| `param/relax.cpp` `relax` | `unit/relax_test` |", False),
    ("docs/paper-map.md", "| `param/relax.cpp` `tighten` | `unit/relax_test` |", True),
    ("docs/paper-map.md", "| `param/relax.cpp` | `unit/track_test` |", True),
    ("libcore/param/a.h", "int a;  // see param/relax.cpp and docs/a.md", False),
    ("libcore/param/a.h", "int a;  // see param/track.h", True),
    ("libcore/param/a.h", "int a;  // see docs/b.md", True),
]


def self_test():
    failed = 0
    for name, text, is_wrong in CASES:
        with tempfile.TemporaryDirectory() as folder:
            for file, content in {**TREE, name: text}.items():
                path = Path(folder).resolve() / file
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(content, encoding="utf-8")
            if bool(list(findings(Path(folder).resolve()))) != is_wrong:
                print(f"self-test: {name}: {text}: expected {'a finding' if is_wrong else 'none'}")
                failed += 1
    return failed


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 1 if self_test() else 0
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    found = list(findings(root))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

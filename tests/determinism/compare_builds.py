#!/usr/bin/python3
"""compare_builds.py PROGRAM PROGRAM...: several builds of build-containers write the same bytes.

All containers are compared with those of the first program. Exit status 1 tells that one differs.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor


def build_all(program, folder):
    folder.mkdir()
    subprocess.run([program, folder], check=True)
    return {file.name: file.read_bytes() for file in folder.iterdir()}


def first_difference(one, other):
    """Index of the first byte in which two differ, or None."""
    if one == other:
        return None
    return next((i for i, (a, b) in enumerate(zip(one, other)) if a != b), min(len(one), len(other)))


def main(programs):
    if len(programs) < 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as temporary, ThreadPoolExecutor(os.cpu_count()) as pool:
        folders = [pathlib.Path(temporary) / str(i) for i in range(len(programs))]
        built = list(pool.map(build_all, programs, folders))
    differences = 0
    for program, files in zip(programs[1:], built[1:]):
        for name in sorted(built[0].keys() | files.keys()):
            want, got = built[0].get(name, b""), files.get(name, b"")
            at = first_difference(want, got)
            if at is not None:
                differences += 1
                print(f"{name}: {program} differs from {programs[0]} from byte {at} on "
                      f"({len(got)} and {len(want)} bytes)")
    print(f"{len(programs)} builds, {len(built[0])} containers each, {differences} differences")
    return 1 if differences or not built[0] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

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


def build_part(program, folder, part, parts):
    folder.mkdir(exist_ok=True)
    subprocess.run([program, folder, str(part), str(parts)], check=True)


def first_difference(one, other):
    """Index of the first byte in which two differ, or None."""
    if one == other:
        return None
    return next((i for i, (a, b) in enumerate(zip(one, other)) if a != b), min(len(one), len(other)))


def main(programs):
    if len(programs) < 2:
        sys.exit(__doc__)
    parts = os.cpu_count()  # a build with sanitizers alone takes most of the time, on one core
    with tempfile.TemporaryDirectory() as temporary, ThreadPoolExecutor(parts) as pool:
        folders = [pathlib.Path(temporary) / str(i) for i in range(len(programs))]
        jobs = [pool.submit(build_part, program, folder, part, parts)
                for program, folder in zip(programs, folders) for part in range(parts)]
        for job in jobs:
            job.result()
        built = [{file.name: file.read_bytes() for file in folder.iterdir()} for folder in folders]
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

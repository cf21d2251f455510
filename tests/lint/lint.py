#!/usr/bin/python3
"""lint.py BUILD [FILE...]: clang-format and clang-tidy find nothing in our files, or in those named.

BUILD is a folder configured for clang. Its precompiled headers are off, so that a file which does not include what it
uses is found, too. clang-tidy reads what users run: libcore, formats, tools, python and their headers. Tests are formatted only.
"""
import json
import os
import pathlib
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIDY_FOLDERS = ("libcore", "formats", "tools", "python")


def tracked_files():
    listed = subprocess.run(["git", "ls-files", "*.h", "*.cpp"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / line for line in listed.stdout.splitlines() if (ROOT / line).exists()]


def compiled(build):
    return {pathlib.Path(entry["file"]).resolve() for entry in json.loads((build / "compile_commands.json").read_text())}


def tidy(build, file):
    done = subprocess.run(["clang-tidy", "--quiet", "-p", build, file], capture_output=True, text=True)
    if done.returncode == 0:
        return True
    print(done.stdout, done.stderr, sep="", flush=True)
    return False


def main(build, names):
    files = [pathlib.Path(name).resolve() for name in names] or tracked_files()
    ok = subprocess.run(["clang-format", "--dry-run", "--Werror", *files]).returncode == 0
    print(f"clang-format: {len(files)} files", flush=True)
    known = compiled(build)
    sources = [f for f in files if f in known and f.relative_to(ROOT).parts[0] in TIDY_FOLDERS]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        clean = list(pool.map(lambda file: tidy(build, file), sources))
    print(f"clang-tidy: {len(sources)} files, {clean.count(False)} with findings")
    return 0 if ok and all(clean) else 1


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]))

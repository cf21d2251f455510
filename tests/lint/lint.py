#!/usr/bin/python3
"""lint.py BUILD [FILE...]: clang-format, clang-tidy and clang's warnings find nothing in our files, or in those named.

BUILD is a folder configured for clang. clang-tidy reads what users run (libcore, formats, tools, python and their headers),
many files at a time. Then clang reads every file alone, with headers that it includes itself and no others: a file
which does not include what it uses is found. Tests are formatted only.
"""
import os
import pathlib
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import units

ROOT = pathlib.Path(__file__).resolve().parents[2]
TIDY_FOLDERS = ("libcore", "formats", "tools", "python")
FAULTS = pathlib.Path("tests/lint/faults")
# clang-tidy's own check of this looks into assert's definition, which is a system header's, and so says nothing.
CHANGING_ASSERT = re.compile(r"\bassert\([^;]*(?:\+\+|--|[^=!<>]=[^=])[^;]*\);")


def tracked_files():
    listed = subprocess.run(["git", "ls-files", "*.h", "*.cpp"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / line for line in listed.stdout.splitlines() if (ROOT / line).exists()]


def output_of(command, folder):
    """What a command prints, or nothing where it succeeds."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    return done.stdout + done.stderr if done.returncode else ""


class Linter:
    def __init__(self, build):
        self.build = build
        self.flags, self.files = units.layer_flags(build, ROOT, TIDY_FOLDERS)
        self.work = build / "units"
        self.work.mkdir(exist_ok=True)

    def flags_of(self, file):
        return self.flags.get(units.layer(file, ROOT), self.flags["libcore"])

    def tidy(self, files, name):
        """What clang-tidy finds in `files`, read as one."""
        unit = self.work / f"{name}.cpp"
        unit.write_text(units.unit_text(files))
        found = output_of(["clang-tidy", "--quiet", f"--config-file={ROOT / '.clang-tidy'}", unit, "--",
                           *self.flags_of(files[0])], self.build)
        if "[clang-diagnostic-error" in found and len(files) > 1:
            # Names that do not go together, or an error of one of them.
            return "".join(self.tidy([file], f"{name}-{i}") for i, file in enumerate(files))
        return found

    def precompile(self, headers, flags, name):
        """The headers as a precompiled one, or None where they are none or do not go together."""
        text = self.work / f"{name}.h"
        text.write_text("".join(f"#include {header}\n" for header in headers))
        out = text.with_suffix(".pch")
        failed = output_of(["clang++", *flags, "-w", "-fpch-instantiate-templates", "-x", "c++-header", text, "-o", out],
                           self.build)
        return None if failed or not headers else out

    def alone(self, file, precompiled=None):
        """What the compiler says about one file."""
        with_headers = ["-include-pch", precompiled] if precompiled else []
        found = output_of(["clang++", *self.flags_of(file), "-Werror", *with_headers, "-fsyntax-only", file], self.build)
        return self.alone(file) if found and precompiled else found


def changing_asserts(file):
    text = file.read_text()
    return "".join(f"{file}:{text.count(chr(10), 0, match.start()) + 1}: assert() must change nothing: {match[0]}\n"
                   for match in CHANGING_ASSERT.finditer(text))


def check_faults(linter):
    """Each check of .clang-tidy, and each of our own, finds the fault that is there for it."""
    checks = re.findall(r"^  ([a-z]+-[\w-]+),?$", (ROOT / ".clang-tidy").read_text(), re.M)
    faults = ROOT / FAULTS / "faults.cpp"
    found = linter.tidy([faults, ROOT / FAULTS / "other.cpp"], "faults")
    missed = [check for check in checks if f"[{check}," not in found]
    if not changing_asserts(faults):
        missed.append("assert() that changes something")
    if "error:" not in linter.alone(ROOT / FAULTS / "other.cpp"):
        missed.append("a missing include")
    if "-Wdangling-gsl" not in linter.alone(faults):
        missed.append("a view of what is gone")
    for check in missed:
        print(f"{faults}: not found: {check}")
    return not missed


def main(build, names):
    files = [pathlib.Path(name).resolve() for name in names] or tracked_files()
    ok = subprocess.run(["clang-format", "--dry-run", "--Werror", *files]).returncode == 0
    print(f"clang-format: {len(files)} files", flush=True)
    linter = Linter(build)
    read = [file for file in files if file in linter.files]
    findings = [changing_asserts(file) for file in files if units.layer(file, ROOT) in TIDY_FOLDERS]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        together = [pool.submit(linter.tidy, unit, i) for i, unit in enumerate(units.units(read, ROOT))]
        groups = units.same_headers(read, ROOT)
        headers = [pool.submit(linter.precompile, common, linter.flags_of(group[0]), f"headers-{i}")
                   for i, (group, common) in enumerate(groups) if len(group) > 2]
        whole = None if names else pool.submit(check_faults, linter)
        alone = [pool.submit(linter.alone, file, headers[i].result() if i < len(headers) else None)
                 for i, (group, _) in enumerate(groups) for file in group]
        findings += [job.result() for job in together + alone]
        ok = (whole is None or whole.result()) and ok
    findings = list(filter(None, dict.fromkeys(findings)))
    print(*findings, sep="", end="")
    print(f"clang-tidy and clang: {len(read)} files, {len(findings)} with findings")
    return 0 if ok and not findings else 1


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]))

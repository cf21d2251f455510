#!/usr/bin/python3
"""hardened_test.py PLACE...: every program there is built as cmake/harden.cmake says.

It can be loaded at any address, its tables of functions are read-only before main(), no stack can be run,
functions check their stack frames, the C library's calls check lengths, and targets of indirect calls are marked.
"""
import pathlib
import platform
import re
import subprocess
import sys

MARK = {"x86_64": b"\xf3\x0f\x1e\xfa", "aarch64": b"\x5f\x24\x03\xd5"}  # endbr64, bti c
FEWEST_MARKS = 20  # the compiler's start-up code has some
CHECKED = re.compile(r" __(?!stack)\w+_chk(@|$)", re.M)


def faults(facts, marks):
    """What is missing, by the text of readelf -hldW --dyn-syms and the number of marks."""
    dynamic = " ".join(re.findall(r"\((?:FLAGS|FLAGS_1)\)\s+(.*)", facts))
    stack = re.search(r"GNU_STACK\s+(?:0x\w+\s+){5}([RWE ]+?)\s+0x", facts)
    checks = {
        "a fixed address": "Type:                              DYN" in facts and "PIE" in dynamic,
        "no read-only relocations": "GNU_RELRO" in facts,
        "functions bound late": "NOW" in dynamic,
        "an executable stack": stack and "E" not in stack.group(1),
        "no stack protector": "__stack_chk_fail" in facts,
        "no marks of indirect calls": marks is None or marks >= FEWEST_MARKS,
    }
    return [fault for fault, good in checks.items() if not good]


def main(places):
    checked, bad, calls = 0, [], False
    for path in (p for place in map(pathlib.Path, places) for p in ([place] if place.is_file() else sorted(place.rglob("*")))):
        if path.is_symlink() or not path.is_file() or path.read_bytes()[:4] != b"\x7fELF":
            continue
        facts = subprocess.run(["readelf", "-hldW", "--dyn-syms", path], capture_output=True, text=True, check=True).stdout
        if "INTERP" not in facts:  # a module or an object
            continue
        checked += 1
        calls = calls or CHECKED.search(facts)
        mark = MARK.get(platform.machine())
        bad += [f"{path}: {fault}" for fault in faults(facts, mark and path.read_bytes().count(mark))]
    if not calls:  # a single program may have no call that needs a check
        bad.append(f"no checked call of the C library in {', '.join(places)}")
    if not checked:
        bad.append(f"no program in {', '.join(places)}")
    print("\n".join(bad) if bad else f"{checked} programs")
    return 1 if bad else 0


if __name__ == "__main__":
    plain = "  Type:                              EXEC (Executable file)\n  GNU_STACK  0x0 0x0 0x0 0x0 0x0 RWE 0x10\n"
    assert len(faults(plain, 0)) == 6
    sys.exit(main(sys.argv[1:]))

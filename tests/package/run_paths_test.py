#!/usr/bin/python3
"""run_paths_test.py PLACE...: no program or library there looks for libraries where anybody might put one.

A run path (DT_RPATH, DT_RUNPATH) may hold absolute folders and $ORIGIN. An empty or relative element is the working
folder, where images of strangers lie.
"""
import pathlib
import struct
import sys

PT_LOAD, PT_DYNAMIC = 1, 2
DT_STRTAB, DT_RPATH, DT_RUNPATH = 5, 15, 29


def run_paths(data):
    """The run paths of an ELF file of 64 bits, little-endian."""
    table, count = struct.unpack_from("<Q", data, 32)[0], struct.unpack_from("<H", data, 56)[0]
    segments = [struct.unpack_from("<IIQQQQ", data, table + 56 * i) for i in range(count)]
    for kind, _, offset, _, _, size in segments:
        if kind != PT_DYNAMIC:
            continue
        entries = [struct.unpack_from("<QQ", data, at) for at in range(offset, offset + size, 16)]
        address = next(value for tag, value in entries if tag == DT_STRTAB)
        strings = next(start + address - virtual for what, _, start, virtual, _, length in segments
                       if what == PT_LOAD and virtual <= address < virtual + length)
        for tag, value in entries:
            if tag in (DT_RPATH, DT_RUNPATH):
                start = strings + value
                yield data[start:data.index(b"\0", start)].decode()


def wrong(run_path):
    return [e for e in run_path.split(":") if not (e.startswith("/") or e == "$ORIGIN" or e.startswith("$ORIGIN/"))]


def main(places):
    checked, bad = 0, []
    for path in (p for place in map(pathlib.Path, places) for p in ([place] if place.is_file() else sorted(place.rglob("*")))):
        if path.is_symlink() or not path.is_file() or path.read_bytes()[:6] != b"\x7fELF\x02\x01":
            continue
        checked += 1
        bad += [f"{path}: run path '{p}' has the element '{w}'" for p in run_paths(path.read_bytes()) for w in wrong(p)]
    if not checked:
        bad.append(f"no program in {', '.join(places)}")
    print("\n".join(bad) if bad else f"{checked} programs and libraries")
    return 1 if bad else 0


if __name__ == "__main__":
    assert wrong("/a:") == [""] and wrong("lib:$ORIGIN/../lib:$ORIGINAL") == ["lib", "$ORIGINAL"] and not wrong("/a:$ORIGIN")
    sys.exit(main(sys.argv[1:]))

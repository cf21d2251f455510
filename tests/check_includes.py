#!/usr/bin/env python3
"""Fails on an include against tools -> formats -> libcore.

check_includes.py [ROOT]     prints each wrong include of the tree, exit 1 if there is one
check_includes.py --self-test   plants includes, wrong and right, into small trees and expects each to be judged so
"""
import re
import sys
import tempfile
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
SOURCES = {".h", ".hpp", ".cpp", ".inl"}

# Which part of libcore formats may know: values, no algorithms.
VALUES = re.compile(r"libcore/(base/|image/|mesh/|param/pixel_map\.h$|param/mesh_image\.h$|warp/warp_edits\.h$)")
# Libraries by the names of their headers.
TBB = re.compile(r"(oneapi/)?tbb(/|\.h$)")
FILE_LIBRARIES = re.compile(r"OpenEXR/|Imath/|Imf\w*\.h|OpenImageIO/|png\.h$|libdeflate\.h$|draco/|tiny_gltf|tinygltf|nlohmann/|webp/|json/")
COMMAND_LINE = re.compile(r"CLI/|CLI11")
STREAMS = re.compile(r"(fstream|filesystem|cstdio|stdio\.h)$")


def wrong(path, include):
    """Why `path` (relative to the root) may not include `include`; None if it may."""
    layer = path.parts[0]
    name = path.as_posix()
    if TBB.match(include) and not name.startswith("libcore/base/parallel."):
        return "only libcore/base/parallel.* names the thread library"
    if layer == "libcore":
        if include.startswith(("formats/", "tools/", "tests/")):
            return "libcore knows nothing above it"
        if FILE_LIBRARIES.match(include) or STREAMS.match(include):
            return "libcore knows no files"
        if COMMAND_LINE.match(include):
            return "libcore knows no command line"
    if layer == "formats":
        if include.startswith(("tools/", "tests/")):
            return "formats knows no tools"
        if COMMAND_LINE.match(include):
            return "formats knows no command line"
        if include.startswith("libcore/") and not VALUES.match(include):
            return "formats includes libcore's values, not its algorithms"
    if layer == "tools" and include.startswith("tests/"):
        return "tools know no tests"
    return None


def includes(path):
    return INCLUDE.findall(path.read_text(encoding="utf-8")) if path.is_file() else []


def leaks(root, header, seen):
    """The first file library that an include of this header of formats brings along."""
    for include in includes(root / header):
        if FILE_LIBRARIES.match(include):
            return f"{header} includes {include}"
        if include.startswith("formats/") and include not in seen:
            seen.add(include)
            found = leaks(root, include, seen)
            if found:
                return found
    return None


def findings(root):
    for layer in ("libcore", "formats", "tools"):
        for path in sorted((root / layer).rglob("*")):
            if path.suffix not in SOURCES:
                continue
            relative = path.relative_to(root)
            for include in includes(path):
                reason = wrong(relative, include)
                # Headers that formats shares with itself may name a library; those that tools include may not.
                if not reason and layer == "tools" and include.startswith("formats/"):
                    reason = leaks(root, include, set())
                if reason:
                    yield f"{relative} includes {include}: {reason}"


# (file, include, whether it is wrong)
CASES = [
    ("libcore/mesh/a.h", "formats/container.h", True),
    ("libcore/mesh/a.cpp", "tools/common/options.h", True),
    ("libcore/mesh/a.cpp", "CLI/CLI.hpp", True),
    ("libcore/mesh/a.cpp", "tiny_gltf.h", True),
    ("libcore/mesh/a.cpp", "draco/mesh/mesh.h", True),
    ("libcore/mesh/a.cpp", "OpenEXR/ImfHeader.h", True),
    ("libcore/mesh/a.cpp", "OpenImageIO/imageio.h", True),
    ("libcore/mesh/a.cpp", "nlohmann/json.hpp", True),
    ("libcore/mesh/a.cpp", "png.h", True),
    ("libcore/mesh/a.cpp", "libdeflate.h", True),
    ("libcore/mesh/a.cpp", "fstream", True),
    ("libcore/mesh/a.cpp", "tbb/parallel_for.h", True),
    ("libcore/base/parallel.cpp", "tbb/parallel_for.h", False),
    ("libcore/mesh/a.cpp", "Eigen/Core", False),
    ("libcore/mesh/a.cpp", "libcore/collapse/collapse.h", False),
    ("formats/a.cpp", "tools/common/options.h", True),
    ("formats/a.cpp", "CLI/CLI.hpp", True),
    ("formats/a.cpp", "libcore/collapse/collapse.h", True),
    ("formats/a.cpp", "libcore/param/tracker.h", True),
    ("formats/a.cpp", "oneapi/tbb/task_arena.h", True),
    ("formats/a.cpp", "libcore/param/pixel_map.h", False),
    ("formats/a.cpp", "libcore/param/mesh_image.h", False),
    ("formats/a.cpp", "libcore/base/error.h", False),
    ("formats/a.cpp", "libcore/warp/warp_edits.h", False),
    ("formats/a.cpp", "libcore/warp/warp_image.h", True),
    ("formats/a.h", "OpenEXR/ImfHeader.h", False),
    ("formats/a.cpp", "nlohmann/json.hpp", False),
    ("tools/a.cpp", "CLI/CLI.hpp", False),
    ("tools/a.cpp", "libcore/build/build.h", False),
    ("tools/a.cpp", "tests/support/temporary_folder.h", True),
    ("tools/a.cpp", "tbb/parallel_for.h", True),
]


# A tool includes formats/a.h, which includes formats/b.h, which includes this.
LEAK_CASES = [("OpenEXR/ImfHeader.h", True), ("nlohmann/json_fwd.hpp", True), ("vector", False)]


def failures(files, is_wrong):
    """1 if the tree of these files is not judged as it must be."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        if bool(list(findings(Path(folder)))) == is_wrong:
            return 0
    print(f"self-test: {files}: expected {'a finding' if is_wrong else 'none'}")
    return 1


def self_test():
    failed = 0
    for name, include, is_wrong in CASES:
        failed += failures({name: f"// a file\n#include <{include}>\n"}, is_wrong)
        failed += failures({name: f'// a file\n  #  include "{include}"  // why\n'}, is_wrong)
    for include, is_wrong in LEAK_CASES:
        failed += failures({"tools/a.cpp": '#include "formats/a.h"\n', "formats/a.h": '#include "formats/b.h"\n',
                            "formats/b.h": f"#include <{include}>\n"}, is_wrong)
    return failed


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 1 if self_test() else 0
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    found = list(findings(root))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

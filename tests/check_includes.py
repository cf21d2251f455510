#!/usr/bin/env python3
"""Fails on an include against {tools, python} -> formats -> libcore, against the ranks of the rooms in a layer, or from a public
header (cmake/public_headers.cmake) to one that is not installed; and on a message below the tools that names an option of
the command line.

check_includes.py [ROOT]     prints what is wrong in the tree, exit 1 if there is anything
check_includes.py --table [ROOT]   prints how often each room includes each other one
check_includes.py --self-test   plants lines, wrong and right, into small trees and expects each to be judged so
"""
import re
import sys
import tempfile
from collections import Counter
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
# A string that names an option: libraries are used without a command line too.
OPTION = re.compile(r'"[^"\n]*(?<![\w-])--[a-z][^"\n]*"')
SOURCES = {".h", ".hpp", ".cpp", ".inl"}

# Rooms of a layer, from the lowest rank up. A file includes rooms of lower rank and its own room, nothing else: rooms of
# one rank do not know each other. A folder inside a room is private to the room: what others may include lies in the
# room itself.
RANKS = {
    "libcore": [["base"], ["image"], ["mesh"],
                ["simplify", "param", "refine", "recon", "segment", "warp", "metrics"], ["optimize"], ["coding"],
                ["pipeline"], ["tiles"]],
    "formats": [["files"], ["findings"], ["exr"], ["picture", "gltf", "compact"], ["container"], ["export", "tileset"]],
}
RANK_OF = {layer: {room: rank for rank, rooms in enumerate(ranks) for room in rooms} for layer, ranks in RANKS.items()}

# Which parts of libcore formats may know: values and what is computed of them row by row, no algorithms.
VALUES = re.compile(r"libcore/(base/|image/|tiles/tile_grid\.h$|mesh/(base_mesh|disc_part|displacements|locate_map|loop|mesh_image|pixel_map)\.h$|warp/warp_edits\.h$)")
# Libraries by the names of their headers.
TBB = re.compile(r"(oneapi/)?tbb(/|\.h$)")
FILE_LIBRARIES = re.compile(r"OpenEXR/|Imath/|Imf\w*\.h|OpenImageIO/|png\.h$|libdeflate\.h$|lcms2\.h$|draco/|tiny_gltf|tinygltf|nlohmann/|webp/|json/")
COMMAND_LINE = re.compile(r"CLI/|CLI11|toml\+\+")
PYTHON = re.compile(r"pybind11/|Python\.h$")
# What of the tools the Python module shares: words and messages, which know no command line.
SHARED_BY_TOOLS = {"tools/common/choices.h", "tools/common/in_file.h", "tools/common/names.h", "tools/common/text.h"}
STREAMS = re.compile(r"(fstream|filesystem|cstdio|stdio\.h)$")
# A header that a comment names.
MENTION = re.compile(r"[\w/]*\w\.h\b")


def against_ranks(rank_of, path, include):
    """Why a file may not include another of its layer; both relative to the layer."""
    if len(path) < 2 or path[0] not in rank_of:
        return f"{'/'.join(path)} is in no room: {', '.join(rank_of)}"
    own, other = path[0], include[0]
    if other == own:
        return None
    if other not in rank_of:
        return f"there is no room {other}"
    if rank_of[other] == rank_of[own]:
        return f"rooms of one rank do not know each other: {own}, {other}"
    return f"{own} is below {other}" if rank_of[other] > rank_of[own] else None


def wrong(path, include):
    """Why `path` (relative to the root) may not include `include`; None if it may."""
    layer = path.parts[0]
    name = path.as_posix()
    parts = Path(include).parts
    if len(parts) > 3 and parts[0] in RANKS and parts[:2] != path.parts[:2]:
        return f"{'/'.join(parts[:3])}/ is private to {'/'.join(parts[:2])}/"
    if layer != "python" and (PYTHON.match(include) or include.startswith("python/")):
        return "only python/ knows Python"
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
    if include.startswith(f"{layer}/") and layer in RANKS:
        return against_ranks(RANK_OF[layer], path.parts[1:], Path(include).parts[1:])
    if layer == "tools" and include.startswith("tests/"):
        return "tools know no tests"
    if layer == "python":
        if include.startswith("tests/") or include.startswith("tools/") and include not in SHARED_BY_TOOLS:
            return "python stands beside the tools: it shares only " + ", ".join(sorted(SHARED_BY_TOOLS))
        if COMMAND_LINE.match(include):
            return "python knows no command line"
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


def public_headers(root):
    """The headers that are installed, as cmake/public_headers.cmake lists them."""
    path = root / "cmake" / "public_headers.cmake"
    text = path.read_text(encoding="utf-8") if path.is_file() else ""
    block = re.search(r"set\(IMGMESH_PUBLIC_HEADERS([^)]*)\)", text)
    return block.group(1).split() if block else []


def public_findings(root):
    headers = public_headers(root)
    names = Counter(header.partition("/")[2] for header in headers)
    for header in headers:
        if not (root / header).is_file():
            yield f"cmake/public_headers.cmake lists {header}, which is not there"
            continue
        if names[header.partition("/")[2]] > 1:
            yield f"cmake/public_headers.cmake lists {header}, whose public name another header has as well"
        for include in includes(root / header):
            if "/" in include and include not in headers and not include.startswith("Eigen/"):
                yield f"{header} is public and includes {include}, which is not"
        # Who reads an installed header finds only installed ones.
        text = (root / header).read_text(encoding="utf-8")
        for named in MENTION.findall(INCLUDE.sub("", text)):
            if not any(f"/{other}".endswith(f"/{named}") for other in headers):
                yield f"{header} is public and its comments refer to {named}, which is not"


def findings(root):
    yield from public_findings(root)
    for layer in ("libcore", "formats", "tools", "python"):
        for path in sorted((root / layer).rglob("*")):
            if path.suffix not in SOURCES:
                continue
            relative = path.relative_to(root)
            for include in includes(path):
                reason = wrong(relative, include)
                # Headers that formats shares with itself may name a library; those that tools include may not.
                if not reason and layer in ("tools", "python") and include.startswith("formats/"):
                    reason = leaks(root, include, set())
                if reason:
                    yield f"{relative} includes {include}: {reason}"
            if layer != "tools":  # nor does Python
                for text in OPTION.findall(path.read_text(encoding="utf-8")):
                    yield f"{relative} has the text {text}: only tools know options"


# (file, include, whether it is wrong)
CASES = [
    ("libcore/mesh/a.h", "formats/container/container.h", True),
    ("libcore/mesh/a.cpp", "tools/common/options.h", True),
    ("libcore/mesh/a.cpp", "CLI/CLI.hpp", True),
    ("libcore/mesh/a.cpp", "tiny_gltf.h", True),
    ("libcore/mesh/a.cpp", "draco/mesh/mesh.h", True),
    ("libcore/mesh/a.cpp", "OpenEXR/ImfHeader.h", True),
    ("libcore/mesh/a.cpp", "OpenImageIO/imageio.h", True),
    ("libcore/mesh/a.cpp", "nlohmann/json.hpp", True),
    ("libcore/mesh/a.cpp", "png.h", True),
    ("libcore/mesh/a.cpp", "libdeflate.h", True),
    ("libcore/mesh/a.cpp", "lcms2.h", True),
    ("libcore/mesh/a.cpp", "fstream", True),
    ("libcore/mesh/a.cpp", "tbb/parallel_for.h", True),
    ("libcore/base/parallel.cpp", "tbb/parallel_for.h", False),
    ("libcore/mesh/a.cpp", "Eigen/Core", False),
    ("libcore/mesh/a.cpp", "libcore/image/image.h", False),
    ("libcore/mesh/a.cpp", "libcore/mesh/base_mesh.h", False),
    ("libcore/mesh/a.cpp", "libcore/simplify/simplify.h", True),
    ("libcore/param/a.cpp", "libcore/recon/draw.h", True),
    ("libcore/pipeline/a.cpp", "libcore/simplify/simplify.h", False),
    ("libcore/pipeline/a.cpp", "libcore/simplify/kernel/simplifier.h", True),
    ("libcore/simplify/a.cpp", "libcore/simplify/kernel/simplifier.h", False),
    ("libcore/simplify/kernel/a.cpp", "libcore/simplify/quadrics/quadric.h", False),
    ("libcore/simplify/kernel/a.cpp", "libcore/mesh/ring_mesh.h", False),
    ("libcore/simplify/kernel/a.cpp", "libcore/param/track.h", True),
    ("libcore/base/a.cpp", "libcore/image/image.h", True),
    ("libcore/attic/a.cpp", "libcore/base/types.h", True),
    ("libcore/warp/a.cpp", "libcore/attic/a.h", True),
    ("libcore/a.cpp", "libcore/base/types.h", True),
    ("formats/gltf/a.cpp", "formats/findings/findings.h", False),
    ("formats/gltf/a.cpp", "formats/container/container.h", True),
    ("formats/gltf/a.cpp", "formats/picture/decode/exif.h", True),
    ("formats/a.cpp", "tools/common/options.h", True),
    ("formats/a.cpp", "CLI/CLI.hpp", True),
    ("formats/gltf/a.cpp", "libcore/simplify/simplify.h", True),
    ("formats/gltf/a.cpp", "libcore/param/track.h", True),
    ("formats/a.cpp", "oneapi/tbb/task_arena.h", True),
    ("formats/gltf/a.cpp", "libcore/mesh/pixel_map.h", False),
    ("formats/gltf/a.cpp", "libcore/mesh/mesh_image.h", False),
    ("formats/gltf/a.cpp", "libcore/base/error.h", False),
    ("formats/gltf/a.cpp", "libcore/warp/warp_edits.h", False),
    ("formats/gltf/a.cpp", "libcore/warp/warp_image.h", True),
    ("formats/a.h", "OpenEXR/ImfHeader.h", False),
    ("formats/a.cpp", "nlohmann/json.hpp", False),
    ("tools/a.cpp", "CLI/CLI.hpp", False),
    ("tools/a.cpp", "libcore/pipeline/build.h", False),
    ("tools/a.cpp", "libcore/simplify/kernel/simplifier.h", True),
    ("tools/a.cpp", "tests/support/temporary_folder.h", True),
    ("tools/a.cpp", "tbb/parallel_for.h", True),
    ("tools/a.cpp", "pybind11/pybind11.h", True),
    ("formats/gltf/a.cpp", "python/bind.h", True),
    ("python/a.cpp", "pybind11/pybind11.h", False),
    ("python/a.cpp", "python/bind.h", False),
    ("python/a.cpp", "formats/container/container.h", False),
    ("python/a.cpp", "libcore/pipeline/build.h", False),
    ("python/a.cpp", "libcore/simplify/kernel/simplifier.h", True),
    ("python/a.cpp", "tools/common/names.h", False),
    ("python/a.cpp", "tools/common/options.h", True),
    ("python/a.cpp", "CLI/CLI.hpp", True),
]


# (file, line, whether it is wrong)
TEXT_CASES = [
    ("libcore/mesh/a.cpp", 'throw Error("too coarse: --bary float holds it");', True),
    ("formats/gltf/a.cpp", 'throw Error("--bary is wrong");', True),
    ("formats/gltf/a.cpp", 'if (--left == 0) throw Error("none is left");', False),
    ("tools/a.cpp", 'throw Error("--bary is wrong");', False),
]

# A tool includes formats/a.h, which includes formats/b.h, which includes this.
LEAK_CASES = [("OpenEXR/ImfHeader.h", True), ("nlohmann/json_fwd.hpp", True), ("vector", False)]


# (listed headers, text of libcore/mesh/a.h, whether there is a finding)
PUBLIC_CASES = [
    ("libcore/mesh/a.h", '#include "libcore/mesh/b.h"\n', True),
    ("libcore/mesh/a.h libcore/mesh/b.h", '#include "libcore/mesh/b.h"\n', False),
    ("libcore/mesh/a.h", "#include <Eigen/Core>\n#include <vector>\n", False),
    ("libcore/mesh/a.h", "#include <boost/any.hpp>\n", True),
    ("libcore/mesh/a.h libcore/mesh/gone.h", "", True),
    ("libcore/mesh/a.h formats/mesh/a.h", "", True),
    ("libcore/mesh/a.h", "// As b.h has it.\n", True),
    ("libcore/mesh/a.h libcore/mesh/b.h", "// As b.h and mesh/b.h have it.\n", False),
    ("libcore/mesh/b.h", '#include "libcore/mesh/b.h"\n', False),
]


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
    for name, line, is_wrong in TEXT_CASES:
        failed += failures({name: f"// a file\n{line}\n"}, is_wrong)
    for include, is_wrong in LEAK_CASES:
        failed += failures({"tools/a.cpp": '#include "formats/gltf/a.h"\n', "formats/gltf/a.h": '#include "formats/gltf/b.h"\n',
                            "formats/gltf/b.h": f"#include <{include}>\n"}, is_wrong)
    for listed, text, is_wrong in PUBLIC_CASES:
        failed += failures({"cmake/public_headers.cmake": f"set(IMGMESH_PUBLIC_HEADERS\n  {listed})\n", "libcore/mesh/a.h": text,
                            "libcore/mesh/b.h": "", "formats/mesh/a.h": ""}, is_wrong)
    return failed


def print_table(root):
    """A row for each room, in the order of ranks: its files, lines and what it includes."""
    for layer, ranks in RANKS.items():
        for room in (room for rank in ranks for room in rank):
            paths = sorted(p for p in (root / layer / room).rglob("*") if p.suffix in SOURCES)
            found = Counter(Path(i).parts[1] for p in paths for i in includes(p)
                            if i.startswith(f"{layer}/") and Path(i).parts[1] != room)
            lines = sum(len(p.read_text(encoding="utf-8").splitlines()) for p in paths)
            print(f"{layer}/{room:<10}{len(paths):4} files {lines:6} lines  -> "
                  + ", ".join(f"{other} {found[other]}" for rank in ranks for other in rank if found[other]))


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 1 if self_test() else 0
    if sys.argv[1:2] == ["--table"]:
        print_table(Path(sys.argv[2]) if len(sys.argv) > 2 else Path(__file__).resolve().parent.parent)
        return 0
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    found = list(findings(root))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Only the public headers are installed, each compiles alone, and docs/library.md lists them all.

headers_test.py ROOT INSTALLED COMPILER [INCLUDE...]
    ROOT       of the repository: cmake/public_headers.cmake lists the headers
    INSTALLED  a prefix that imgmesh has been installed to
    INCLUDE    folders with the headers of others
"""
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from check_includes import includes, public_headers


# Eigen takes most of the time, and comes with this header, so it is compiled once. Who includes it anyway gets it from
# there; for the others it would hide what they lack.
FIRST = "imgmesh/base/types.h"


def brings(name, include, wanted):
    """Whether the header includes the wanted one, perhaps by way of others."""
    inner = [other for other in includes(include / name) if other.startswith("imgmesh/")]
    return name == wanted or any(brings(other, include, wanted) for other in inner)


def compile_alone(names, include, folder, compiler, others):
    """A message for each header that does not compile as the only one."""
    command = [compiler, "-std=c++20", "-Wall", "-Wextra", "-Werror", f"-I{include}"]
    command += [f"-isystem{other}" for other in others]
    first = folder / "first.h"
    first.write_text(f"#include <{FIRST}>\n", encoding="utf-8")
    subprocess.run([*command, "-xc++-header", str(first), "-o", f"{first}.gch"], check=True)

    def failure(name):
        start = ["-include", str(first)] if brings(name, include, FIRST) else []
        # A declaration after the include, so that a header that ends amid something does not pass.
        done = subprocess.run([*command, "-fsyntax-only", *start, "-xc++", "-"], input=f"#include <{name}>\nint after;\n",
                              capture_output=True, text=True)
        return f"{name} does not compile alone:\n{done.stderr}" if done.returncode else None

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return [text for text in pool.map(failure, names) if text]


def page_failures(root, names):
    """What docs/library.md lacks: a header, or the example as it is now."""
    page = (root / "docs" / "library.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"^\| `<(imgmesh/[^>]+)>` \|", page, re.MULTILINE)) | {"imgmesh/imgmesh.h"}
    failed = [f"docs/library.md does not list {name}" for name in sorted(names - listed)]
    failed += [f"docs/library.md lists {name}, which is not public" for name in sorted(listed - names)]
    for example in ("CMakeLists.txt", "main.cpp"):
        if (root / "examples" / "library" / example).read_text(encoding="utf-8") not in page:
            failed.append(f"docs/library.md has another {example} than examples/library")
    return failed


def main():
    root, installed, compiler, *others = sys.argv[1:]
    expected = {f"imgmesh/{header.partition('/')[2]}" for header in public_headers(Path(root))} | {"imgmesh/imgmesh.h"}
    include = Path(installed) / "include"
    found = {path.relative_to(include).as_posix() for path in include.rglob("*") if path.is_file()}
    failed = [f"not installed: {name}" for name in sorted(expected - found)]
    failed += [f"installed, but not public: {name}" for name in sorted(found - expected)]

    failed += page_failures(Path(root), expected)
    with tempfile.TemporaryDirectory() as folder:
        failed += compile_alone(sorted(expected & found), include, Path(folder), compiler, others)
    print("\n".join(failed) or f"{len(expected)} headers")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

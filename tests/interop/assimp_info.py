#!/usr/bin/python3
"""assimp_info.py SAMPLES CONFORMANCE: assimp reads uncompressed containers as they were written: the meshes' names, their
vertices and faces, and the image centred at the origin.

Debian's assimp 5.2 has no Draco decoder, and does not find a file beside whose name has escapes in its URI, so of the
samples, whose names have spaces, it gets each .glb, and the .gltf of the conformance set."""
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "schemas"))
from check_schemas import EXTENSION, gltf_document  # noqa: E402


def check(path):
    document = gltf_document(path)
    levels = {n["extensions"][EXTENSION]["part"]: n["extensions"][EXTENSION] for n in document["nodes"]}
    result = subprocess.run(["assimp", "info", path], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        return f"assimp cannot read it: {result.stdout.splitlines()[-1:]}"
    meshes = {m[1]: (int(m[2]), int(m[3]))
              for m in re.finditer(r"\((lod\d+)-mesh\): \[(\d+) / \d+ / (\d+) \| triangle\]", result.stdout)}
    if not meshes or "lod0" not in meshes:
        return "no mesh lod0-mesh"
    for name, counts in meshes.items():
        if counts != (levels[name]["vertices"], levels[name]["faces"]):
            return f"{name} has {counts} vertices and faces"
    low, high = (re.search(rf"{word} point +\(([-0-9. ]+)\)", result.stdout)[1].split() for word in ("Minimum", "Maximum"))
    if any(abs(float(low[i]) + float(high[i])) > 1e-5 or float(high[i]) > 0.500001 for i in (0, 1)):
        return f"not centred: {low} to {high}"
    return None


def main():
    samples, conformance = map(pathlib.Path, sys.argv[1:3])
    paths = sorted(samples.glob("none *.glb")) + sorted(conformance.glob("valid-none-*/x.gltf"))
    problems = [f"{path}: {problem}" for path in paths if (problem := check(path))]
    print("\n".join(problems + [f"{len(paths)} containers"]))
    return 1 if problems or len(paths) < 8 else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""Takes the screenshots of docs/engines.md: make_engines.py BIN, with BIN the folder of the tools. Node.js, Chromium and the
packages of tests/interop have to be there, as after ./run test.

tests/data/kodim23.png as a mesh in three.js, and bent, with the image as texture, in Babylon.js; and the steering wheel
of docs/warp.md, cut out and textured, in three.js.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

from PIL import Image

from make_warp import HERE, PHOTO, run, sheet, shown, wheel

PAGES = HERE.parent / "engines"
DRAW = HERE.parents[1] / "tests" / "interop" / "draw_viewers.mjs"


def make_containers(tools, folder):
    run(tools / "imgmesh-build", PHOTO, "-o", folder / "photo.glb", "--level-faces", "4000,600,80", "--texture", "-q")
    run(tools / "imgmesh-convert", folder / "photo.glb", "-o", folder / "mesh.glb", "--no-texture", "-q")
    lift = {"level": 2, "solver": "arap", "handles": [{"near": [190, 230], "move": [0, -40]}], "pins": [{"border": True}]}
    (folder / "edits.json").write_text(json.dumps({"edits": [lift]}))
    run(tools / "imgmesh-warp", folder / "photo.glb", "--edits", folder / "edits.json", "-o", folder / "bent.glb", "-q")
    Image.fromarray(wheel(), "RGBA").save(folder / "wheel.png")
    run(tools / "imgmesh-build", folder / "wheel.png", "-o", folder / "wheel.glb", "--texture", "-q")


def main():
    tools = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="imgmesh-engines-") as name:
        folder = pathlib.Path(name)
        make_containers(tools, folder)
        jobs = [{"page": f"{page}.html", "file": f"{file}.glb", "zoom": zoom, "output": f"{file}.png"}
                for page, file, zoom in (("three", "mesh", 0.5), ("babylon", "bent", 0.5), ("three", "wheel", 256 / 480))]
        (folder / "jobs.json").write_text(json.dumps(jobs))
        subprocess.run(["node", DRAW, shutil.which("chromium"), PAGES, folder, folder / "jobs.json"], check=True)
        sheet([[shown(folder / job["output"]) for job in jobs]], HERE / "engines.jpg")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""blender_test.py BIN BLENDER SAMPLES FOLDER: Blender (headless) imports uncompressed containers as they were written
(places, faces, colours; upright), and the script of docs/blender.md draws them as glTF means them. FOLDER gets the
containers and the drawings."""
import os
import pathlib
import subprocess
import sys

import numpy as np

from read_container import EXTENSION, read_accessor, read_gltf
from viewers_test import ZOOM, compare, expected_of, make_pictures, srgb_codes

HERE = pathlib.Path(__file__).resolve().parent
RENDER = HERE.parents[1] / "docs" / "blender" / "render_container.py"
FLAVOURS = ("", "channels ", "light ")
# Blender keeps sRGB in 8 bits: a rounding of 255 steps, and one more of its own conversion's.
MAX_CODES = 1


def expected_level(document, binary, node):
    """What docs/format.md says: corners in the scene, in Blender's axes (x right, y away, z up), and colours."""
    image = document["extensions"][EXTENSION]["image"]
    level = int(node["extensions"][EXTENSION]["part"].removeprefix("lod"))
    (primitive,) = document["meshes"][node["mesh"]]["primitives"]
    position = read_accessor(document, binary, primitive["attributes"]["POSITION"])
    colour = read_accessor(document, binary, primitive["attributes"]["COLOR_0"]) / 65535
    faces = read_accessor(document, binary, primitive["indices"]).reshape(-1, 3)
    side = max(image["width"], image["height"])
    x = (position[:, 0] - (image["width"] - 1) / 2) / side
    z = (position[:, 1] + (image["height"] - 1) / 2) / side
    corners = np.stack([x, np.full_like(x, 0.01 * level), z], axis=-1)[faces]
    return corners, colour[faces], len(position)


def problems_of(facts, index, path):
    document, binary, _ = read_gltf(path)
    found = []
    for node in document["nodes"]:
        corners, colours, vertices = expected_level(document, binary, node)
        get = lambda key: facts.get(f"{index}/{node['name']}/{key}")
        if get("vertices") != vertices or get("corners").shape != corners.shape:
            found.append(f"{node['name']}: {get('vertices')} vertices, expected {vertices}, or other faces")
            continue
        if not np.allclose(get("corners"), corners, atol=1e-5):
            found.append(f"{node['name']}: a corner is {np.abs(get('corners') - corners).max()} off its place")
        if not np.allclose(get("normals"), [0, -1, 0], atol=1e-4):
            found.append(f"{node['name']}: a face is turned away from the front")
        error = np.abs(srgb_codes(get("colours")[..., :3]) - srgb_codes(colours[..., :3])).max()
        if error > MAX_CODES or (get("colours")[..., 3] != 1).any():
            found.append(f"{node['name']}: a colour is {error} of 255 off, or not opaque")
    return found


def run_blender(blender, script, *arguments):
    command = [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", script, "--", *arguments]
    # Without a place for the user's settings Blender looks for none.
    environment = dict(os.environ, BLENDER_USER_CONFIG=os.devnull, BLENDER_USER_SCRIPTS=os.devnull)
    result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300, env=environment)
    if result.returncode != 0:
        sys.exit(f"{result.stdout}{result.stderr}\nblender failed")


def main():
    bin_folder, blender, samples, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:5])
    folder.mkdir(parents=True, exist_ok=True)
    make_pictures(folder)
    # Other tests put drawings beside the samples, x.glb.png.
    paths = sorted(path for flavour in FLAVOURS for path in samples.glob(f"{flavour}none *.gl*")
                   if path.suffix in (".glb", ".gltf"))
    drawn = []
    for name, picture, options in (("photograph", "photograph.png", ["--levels", "2"]),
                                   ("masked", "photograph.png", ["--mask", "mask.png"])):
        drawn.append(folder / f"{name}.glb")
        subprocess.run([bin_folder / "imgmesh-build", picture, "-o", drawn[-1], "--density", "2", "--draco", "none", "-q",
                        *options], cwd=folder, check=True)
    paths += drawn
    # Its colours are not where Blender looks, as they should not be.
    drawn.append(folder / "texture.glb")
    subprocess.run([bin_folder / "imgmesh-convert", "photograph.glb", "-o", drawn[-1], "--texture", "--image",
                    "photograph.png", "-q"], cwd=folder, check=True)

    run_blender(blender, HERE / "blender_facts.py", folder / "facts.npz", *paths)
    facts = dict(np.load(folder / "facts.npz"))
    problems = [f"{path.name}: {problem}" for index, path in enumerate(paths) for problem in problems_of(facts, index, path)]
    for path in drawn:
        run_blender(blender, RENDER, path, path.with_suffix(".png"), str(ZOOM))
        reached, found = compare(path.with_suffix(".png"), expected_of(path), True)
        problems += [f"{path.name}, drawn: {problem}" for problem in found]
        print(f"{path.name}: {reached:.1f} dB")
    print("\n".join(problems + [f"{len(paths)} containers"]))
    return 1 if problems or len(paths) < 20 else 0


if __name__ == "__main__":
    sys.exit(main())

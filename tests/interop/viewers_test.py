#!/usr/bin/python3
"""viewers_test.py BIN NODE CHROMIUM FOLDER: three.js, Babylon.js and PixiJS in headless Chromium show containers
as they are meant, by the pages of docs/engines. FOLDER gets the containers and the screenshots.

The expected image is drawn here, from the container without Draco: a viewer interpolates COLOR_0 in linear light
over each triangle, or takes the texture's light at TEXCOORD_0, between its pixels by bilinear interpolation. A
screenshot has ZOOM x ZOOM pixels for one of the image, so none lies on its edge.
"""
import collections
import dataclasses
import io
import json
import pathlib
import subprocess
import sys
import time

import numpy as np
from PIL import Image, ImageDraw

from read_container import read_accessor, read_gltf

HERE = pathlib.Path(__file__).resolve().parent
PAGES = HERE.parents[1] / "docs" / "engines"
DATA = HERE.parent / "data"
ZOOM = 2
MIN_PSNR = 40.0
# Upside down or mirrored the photograph must be far from the expectation, or the comparison would tell nothing.
MAX_PSNR_TURNED = 25.0
# Samples this near to the mesh's boundary may fall on either side of it [pixels].
OUTLINE_MARGIN = 0.02
# And so near to the alpha from which on a texture is drawn.
ALPHA_MARGIN = 0.02
# Soft alpha may differ by this [codes of 8 bits].
ALPHA_TOLERANCE = 3
# A screenshot's colour is divided by alpha, which leaves little of it below this [codes].
LEAST_ALPHA = 64


@dataclasses.dataclass
class Expected:
    codes: np.ndarray  # sRGB of every sample, 0 to 255, height x width x 3
    inside: np.ndarray  # in the mesh, away from its boundary
    outside: np.ndarray  # not in the mesh, away from its boundary
    alpha: np.ndarray  # of every sample, 0 to 255


def srgb_codes(linear):
    linear = np.clip(linear, 0, 1)
    return np.round(255 * np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055))


def samples_near(points, width, height, margin=0.0):
    """The block of samples around some points: slices, and the samples' x and y."""
    low = np.ceil(ZOOM * (points.min(axis=0) + 0.5 - margin) - 0.5).astype(int)
    high = np.floor(ZOOM * (points.max(axis=0) + 0.5 + margin) - 0.5).astype(int)
    x = np.arange(max(low[0], 0), min(high[0], ZOOM * width - 1) + 1)
    y = np.arange(max(low[1], 0), min(high[1], ZOOM * height - 1) + 1)
    block = np.ix_(y, x)
    return block, (x[None, :] + 0.5) / ZOOM - 0.5, (y[:, None] + 0.5) / ZOOM - 0.5


def linear_of(codes):
    srgb = codes / 255
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def texture_of(document, binary):
    """Linear RGB and alpha of the texture; None without one."""
    if "images" not in document:
        return None
    view = document["bufferViews"][document["images"][0]["bufferView"]]
    start = view.get("byteOffset", 0)
    codes = np.asarray(Image.open(io.BytesIO(binary[start:start + view["byteLength"]])).convert("RGBA"), float)
    return np.dstack([linear_of(codes[..., :3]), codes[..., 3] / 255])


def bilinear(texture, coords):
    """The texture at coordinates (..., 2) from 0 to 1, and at its sides what is there."""
    height, width = texture.shape[:2]
    x, y = coords[..., 0] * width - 0.5, coords[..., 1] * height - 0.5
    x0, y0 = np.floor(x).astype(int), np.floor(y).astype(int)
    total = 0
    for i in (0, 1):
        for j in (0, 1):
            weight = np.abs(1 - i - (x - x0)) * np.abs(1 - j - (y - y0))
            total = total + weight[..., None] * texture[np.clip(y0 + j, 0, height - 1), np.clip(x0 + i, 0, width - 1)]
    return total


def mesh_of(path):
    """Level 0 in pixels: positions, faces, linear colours with alpha or texture and its coordinates, size of the picture."""
    document, binary, _ = read_gltf(path)
    image = document["extensions"]["IMGMESH_pixel_map"]["image"]
    (primitive,) = document["meshes"][document["nodes"][0]["mesh"]]["primitives"]
    attributes = primitive["attributes"]
    position = read_accessor(document, binary, attributes["POSITION"])[:, :2] * [1, -1]
    faces = read_accessor(document, binary, primitive["indices"]).reshape(-1, 3)
    texture = texture_of(document, binary)
    if texture is None:
        values = read_accessor(document, binary, attributes["COLOR_0"]) / 65535
        if values.shape[1] == 3:
            values = np.column_stack([values, np.ones(len(values))])
    else:
        values = read_accessor(document, binary, attributes["TEXCOORD_0"]).astype(float)
    return position, faces, values, texture, image["width"], image["height"]


def is_blended(path):
    document, _, _ = read_gltf(path)
    return document["materials"][0].get("alphaMode") == "BLEND"


def rasterise(position, faces, vertex_values, width, height):
    """The values at every sample, whether the mesh covers it, and whether it is near to the boundary."""
    shape = (ZOOM * height, ZOOM * width)
    values, covered, near = np.zeros((*shape, vertex_values.shape[1])), np.zeros(shape, bool), np.zeros(shape, bool)
    for face in faces:
        (ax, ay), (bx, by), (cx, cy) = p = position[face]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        block, x, y = samples_near(p, width, height)
        u = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
        v = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
        inside = (u >= 0) & (v >= 0) & (u + v <= 1)
        weights = np.stack([1 - u - v, u, v], axis=-1)
        values[block] = np.where(inside[..., None], weights @ vertex_values[face], values[block])
        covered[block] |= inside
    # Edges by place, not by number: vertices may coincide.
    edges = collections.Counter()
    for face in faces:
        for i in range(3):
            edges[frozenset(tuple(position[face[j % 3]]) for j in (i, i + 1))] += 1
    for edge in (np.array(list(edge)) for edge, count in edges.items() if count == 1):
        block, x, y = samples_near(edge, width, height, OUTLINE_MARGIN)
        along = edge[1] - edge[0]
        t = np.clip(((x - edge[0][0]) * along[0] + (y - edge[0][1]) * along[1]) / (along @ along), 0, 1)
        near[block] |= np.hypot(x - edge[0][0] - t * along[0], y - edge[0][1] - t * along[1]) < OUTLINE_MARGIN
    return values, covered, near


def expected_of(path):
    position, faces, vertex_values, texture, width, height = mesh_of(path)
    values, covered, near = rasterise(position, faces, vertex_values, width, height)
    if texture is not None:
        values = bilinear(texture, values)
    alpha = 255 * values[..., 3]
    if not is_blended(path):
        # A texture's alphaMode is MASK then: below 1/2 nothing is drawn, and all else is opaque.
        near |= np.abs(values[..., 3] - 0.5) < ALPHA_MARGIN
        covered &= values[..., 3] >= 0.5
        alpha = np.full(alpha.shape, 255.0)
    return Expected(srgb_codes(values[..., :3]), covered & ~near, ~covered & ~near, alpha)


def expected_of_sprite(path):
    """PixiJS knows no linear light: it interpolates the image's numbers."""
    sheet = json.loads(path.read_text())
    (frame,) = sheet["frames"].values()
    size = sheet["meta"]["size"]
    coords = np.array(frame["verticesUV"]) / [size["w"], size["h"]]
    position = np.array(frame["vertices"]) - 0.5
    values, covered, near = rasterise(position, frame["triangles"], coords, size["w"], size["h"])
    picture = np.asarray(Image.open(path.parent / sheet["meta"]["image"]).convert("RGB"), float)
    return Expected(np.round(bilinear(picture, values)), covered & ~near, ~covered & ~near,
                    np.full(covered.shape, 255.0))


def psnr(codes, expected, where):
    error = np.mean((codes[where] - expected[where]) ** 2)
    return 10 * np.log10(255 ** 2 / error) if error > 0 else np.inf


def compare(path, expected, is_photograph):
    """The PSNR of a screenshot, and what is wrong with it."""
    shot = Image.open(path).convert("RGBA")  # without a transparent pixel it comes as RGB
    if shot.size != expected.inside.shape[::-1]:
        return 0.0, [f"the screenshot has {shot.size} pixels"]
    codes = np.asarray(shot, float)
    alpha = codes[..., 3]
    problems = []
    wrong = np.where(expected.alpha == 255, alpha != 255, np.abs(alpha - expected.alpha) > ALPHA_TOLERANCE)
    for missed, text in ((expected.inside & wrong, "inside the mesh do not have their alpha"),
                         (expected.outside & (alpha != 0), "outside the mesh are drawn")):
        if missed.any():
            problems.append(f"{missed.sum()} samples {text}")
    seen = expected.inside & (expected.alpha >= LEAST_ALPHA)
    reached = psnr(codes[..., :3], expected.codes, seen)
    if not reached >= MIN_PSNR:
        problems.append(f"PSNR {reached:.1f} dB, expected {MIN_PSNR:.0f}")
    for name, turned in (("upside down", codes[::-1]), ("mirrored", codes[:, ::-1])):
        if is_photograph and psnr(turned[..., :3], expected.codes, seen) > MAX_PSNR_TURNED:
            problems.append(f"{name} it would do as well")
    return reached, problems


def make_pictures(folder):
    photograph = Image.open(DATA / "kodim23.png").crop((70, 80, 262, 208))
    photograph.save(folder / "photograph.png")
    # A ring with an island that has soft alpha; and any shape by a mask.
    alpha = Image.new("L", (4 * photograph.width, 4 * photograph.height), 0)
    draw = ImageDraw.Draw(alpha)
    for fill, box in ((255, (140, 20, 620, 490)), (0, (280, 130, 500, 360)), (255, (340, 190, 430, 300))):
        draw.ellipse(box, fill=fill)
    mask = alpha.resize(photograph.size, Image.LANCZOS)
    soft = photograph.copy()
    soft.putalpha(mask)
    soft.save(folder / "alpha.png")
    mask.transpose(Image.FLIP_LEFT_RIGHT).save(folder / "mask.png")
    Image.new("RGB", (1, 1), (200, 100, 50)).save(folder / "one.png")


@dataclasses.dataclass
class Case:
    file: str
    plain: str  # the same without Draco
    is_photograph: bool = True
    viewers: tuple = ("three", "babylon")


def make_cases(bin_folder, folder):
    def run(tool, *arguments):
        subprocess.run([bin_folder / tool, *arguments, "-q"], cwd=folder, check=True)

    cases = []
    for name, picture, options in (("draco", "photograph.png", ()), ("alpha", "alpha.png", ()), ("1x1", "one.png", ()),
                                   ("masked", "photograph.png", ("--mask", "mask.png"))):
        run("imgmesh-build", picture, "-o", f"{name}.glb", "--density", "2", *options)
        run("imgmesh-convert", f"{name}.glb", "-o", f"{name}-plain.glb", "--draco", "none")
        cases.append(Case(f"{name}.glb", f"{name}-plain.glb", name != "1x1"))
        run("imgmesh-convert", f"{name}.glb", "-o", f"{name}-texture.glb", "--texture", "--image", picture)
        run("imgmesh-convert", f"{name}-texture.glb", "-o", f"{name}-texture-plain.glb", "--draco", "none")
        cases.append(Case(f"{name}-texture.glb", f"{name}-texture-plain.glb", name != "1x1"))
    for draco, name in (("edgebreaker", "draco"), ("none", "plain"), ("sequential", "sequential")):
        run("imgmesh-convert", "draco.glb", "-o", f"{name}.gltf", "--draco", draco)
        cases.append(Case(f"{name}.gltf", "draco-plain.glb"))
    cases.append(Case("draco-plain.glb", "draco-plain.glb"))
    # Meshes without a pixel map; the texture's mesh reaches to the image's sides already.
    for extension in ("glb", "gltf"):
        run("imgmesh-convert", "masked-texture.glb", "-o", f"meshopt.{extension}", "--no-map", "--compression", "meshopt")
        cases.append(Case(f"meshopt.{extension}", "masked-texture-plain.glb", viewers=("three",)))
    # A mesh that is bent takes its texture along.
    run("imgmesh-warp", "draco-texture-plain.glb", "--handle", "60,50:6,-3", "-o", "warped-texture.gltf")
    run("imgmesh-convert", "warped-texture.gltf", "-o", "warped-texture-plain.glb", "--draco", "none")
    cases.append(Case("warped-texture.gltf", "warped-texture-plain.glb"))
    for name in ("draco", "masked"):
        run("imgmesh-convert", f"{name}.glb", "-o", f"{name}.json", "--image", "photograph.png")
        cases.append(Case(f"{name}.json", f"{name}.json", viewers=("pixi",)))
    return cases


def main():
    bin_folder, node, chromium, folder = (pathlib.Path(argument) for argument in sys.argv[1:5])
    folder.mkdir(parents=True, exist_ok=True)
    started = time.monotonic()
    make_pictures(folder)
    cases = make_cases(bin_folder.resolve(), folder)
    jobs = [{"page": f"{viewer}.html", "file": case.file, "zoom": ZOOM, "output": f"{case.file}-{viewer}.png"}
            for case in cases for viewer in case.viewers]
    (folder / "jobs.json").write_text(json.dumps(jobs))
    draw = [node, HERE / "draw_viewers.mjs", chromium, PAGES, folder, folder / "jobs.json"]
    subprocess.run(draw, check=True, timeout=300)
    failed = False
    for case in cases:
        expected = (expected_of_sprite if case.plain.endswith(".json") else expected_of)(folder / case.plain)
        for viewer in case.viewers:
            reached, problems = compare(folder / f"{case.file}-{viewer}.png", expected, case.is_photograph)
            failed |= bool(problems)
            print(f"{viewer:8} {case.file:19} {reached:5.1f} dB", *problems, sep="  ")
    print(f"{len(jobs)} screenshots, {time.monotonic() - started:.1f} s")
    return failed


if __name__ == "__main__":
    sys.exit(main())

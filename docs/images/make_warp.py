#!/usr/bin/python3
"""Draws the images of docs/warp.md: make_warp.py BIN, with BIN the folder of the tools.

A steering wheel (made up here) edited on three levels, and tests/data/kodim23.png edited and given another shape.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image, ImageDraw

HERE = pathlib.Path(__file__).resolve().parent
PHOTO = HERE.parents[1] / "tests" / "data" / "kodim23.png"


def wheel(width=640, height=480):
    """A steering wheel: a grained rim, three spokes, a hub with a badge; antialiased alpha."""
    n = 3  # samples a side of a pixel
    y, x = (np.mgrid[0 : height * n, 0 : width * n] + 0.5) / n
    x, y = x - width / 2, y - height / 2
    r, angle = np.hypot(x, y), np.arctan2(y, x)
    rim = (r > 175) & (r < 215)
    hub = r < 62
    spokes = np.zeros_like(rim)
    for turn in (0.35, np.pi - 0.35, np.pi / 2):
        along = x * np.cos(turn) + y * np.sin(turn)
        across = -x * np.sin(turn) + y * np.cos(turn)
        spokes |= (along > 0) & (r < 190) & (np.abs(across) < 17 - along / 30)
    grain = 0.06 * np.sin(40 * angle + 6 * np.sin(r / 9)) + 0.05 * np.sin(angle * 90 + r)
    light = 0.55 + 0.3 * np.cos(angle + 2.2)
    wood = np.array([0.62, 0.36, 0.18])
    color = np.zeros((*r.shape, 3)) + 0.1
    shade = light + grain + 0.25 * np.cos((r - 195) / 20 * np.pi / 2)
    color[rim] = (wood * shade[..., None])[rim]
    metal = spokes & ~rim
    color[metal] = (np.array([0.75, 0.78, 0.82]) * (0.75 + 0.2 * np.sin(r / 3)[..., None] ** 8))[metal]
    color[hub] = (np.array([0.16, 0.18, 0.22]) * (0.8 + 0.5 * light[..., None]))[hub]
    badge = (np.abs(x) + np.abs(y) < 34) & (r < 40)
    color[badge] = (np.array([0.9, 0.2, 0.15]) * (0.8 + 0.3 * np.sign(x * y)[..., None]))[badge]
    alpha = (rim | spokes | hub).astype(float)
    total = alpha.reshape(height, n, width, n).mean(axis=(1, 3))
    mean = (color * alpha[..., None]).reshape(height, n, width, n, 3).mean(axis=(1, 3)) / np.maximum(total, 1e-9)[..., None]
    return np.round(np.dstack([np.clip(mean, 0, 1), total]) * 255).astype(np.uint8)


def sprite(width=300, height=360):
    """A small robot with its arms stretched out; antialiased alpha."""
    n = 4  # samples a side of a pixel
    image = Image.new("RGBA", (width * n, height * n), (0, 0, 0, 0))
    draw = ImageDraw.Draw(image)

    def at(*numbers):
        return [number * n for number in numbers]

    steel, dark, orange = (150, 165, 185, 255), (52, 60, 78, 255), (236, 128, 48, 255)
    for x in (112, 160):
        draw.rounded_rectangle(at(x, 230, x + 28, 340), 8 * n, dark)
        draw.rounded_rectangle(at(x - 6, 324, x + 34, 348), 8 * n, orange)
    for side in (-1, 1):
        draw.line(at(150 + 44 * side, 150, 150 + 112 * side, 150), steel, 26 * n)
        for k in range(4):
            draw.line(at(150 + (56 + 15 * k) * side, 137, 150 + (56 + 15 * k) * side, 163), dark, 3 * n)
        draw.ellipse(at(150 + 122 * side - 20, 130, 150 + 122 * side + 20, 170), orange)
    draw.rounded_rectangle(at(98, 122, 202, 246), 22 * n, steel)
    draw.rounded_rectangle(at(116, 146, 184, 196), 8 * n, dark)
    for k in range(5):
        draw.rectangle(at(124 + 11 * k, 186 - 7 * (1 + k * 3 % 5), 130 + 11 * k, 188), (110, 220, 170, 255))
    draw.line(at(150, 26, 150, 60), dark, 5 * n)
    draw.ellipse(at(141, 14, 159, 32), orange)
    draw.rounded_rectangle(at(102, 50, 198, 116), 26 * n, steel)
    for x in (130, 170):
        draw.ellipse(at(x - 13, 68, x + 13, 94), (255, 255, 255, 255))
        draw.ellipse(at(x - 4, 76, x + 8, 88), dark)
    draw.rectangle(at(134, 116, 166, 124), dark)
    return image.resize((width, height), Image.BOX)


def run(*args):
    subprocess.run([str(a) for a in args], check=True)


def shown(path, box=None, background=(255, 255, 255)):
    """An image over a background, cut to `box`."""
    image = Image.open(path).convert("RGBA")
    under = Image.new("RGBA", image.size, background)
    under.alpha_composite(image)
    return (under.crop(box) if box else under).convert("RGB")


def sheet(rows, path, scale=1.0, gap=8):
    rows = [[p.resize((round(p.width * scale), round(p.height * scale)), Image.LANCZOS) for p in row] for row in rows]
    width = max(sum(p.width + gap for p in row) for row in rows) - gap
    height = sum(max(p.height for p in row) + gap for row in rows) - gap
    out = Image.new("RGB", (width, height), (255, 255, 255))
    top = 0
    for row in rows:
        left = 0
        for p in row:
            out.paste(p, (left, top))
            left += p.width + gap
        top += max(p.height for p in row) + gap
    out.save(path, quality=88, optimize=True)


def main():
    tools = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="imgmesh-warp-") as name:
        draw_wheel(tools, pathlib.Path(name))
        draw_arm(tools, pathlib.Path(name))
        draw_photo(tools, pathlib.Path(name))
        draw_retarget(tools, pathlib.Path(name))


def edited(tools, folder, container, image, edits, level):
    """The image after the edits, and the warped mesh of `level`."""
    (folder / "edits.json").write_text(json.dumps({"edits": edits}))
    warp = [tools / "imgmesh-warp", container, "--edits", folder / "edits.json", "-q"]
    run(*warp, "--image", image, "-o", folder / "edited.png")
    run(*warp, "-o", folder / "edited.glb")
    run(tools / "imgmesh-reconstruct", "-q", folder / "edited.glb", "-o", folder / "wire.png", "--mode", "wire",
        "--level", level)
    return shown(folder / "edited.png"), shown(folder / "wire.png")


def draw_wheel(tools, folder):
    image, container = folder / "wheel.png", folder / "wheel.glb"
    Image.fromarray(wheel(), "RGBA").save(image)
    run(tools / "imgmesh-build", image, "-o", container, "--level-faces", "3000,700,160", "-q")
    rim = {"level": 2, "solver": "arap", "handles": [{"box": [500, 100, 640, 380], "move": [70, 0]}],
           "pins": [{"box": [0, 0, 330, 480]}]}
    spoke = {"level": 1, "solver": "arap", "handles": [{"circle": [320, 350, 24], "move": [-34, 0]}],
             "pins": [{"box": [0, 0, 640, 300]}, {"box": [0, 412, 640, 480]}]}
    hub = {"level": 0, "solver": "arap", "handles": [{"circle": [320, 240, 36], "scale": 1.35}],
           "pins": [{"beyond": [320, 240, 80]}]}
    columns = [edited(tools, folder, container, image, edits, level)
               for edits, level in (([], 2), ([rim], 2), ([rim, spoke], 1), ([rim, spoke, hub], 0))]
    sheet(list(zip(*columns)), HERE / "warp-wheel.jpg", 0.5)


def draw_arm(tools, folder):
    """The sprite, its hand pulled alone, and the same with the body held."""
    image, container = folder / "robot.png", folder / "robot.glb"
    sprite().save(image)
    run(tools / "imgmesh-build", image, "-o", container, "--faces", "400", "--alpha", "cut", "-q")
    handle = ["--handle", "280,150:-44,-100"]
    pins = [word for at in ("150,80", "110,140", "190,140", "110,236", "190,236") for word in ("--pin", at)]
    names = []
    for args in ([], handle, [*handle, *pins]):
        names.append(folder / f"robot-{len(names)}.png")
        run(tools / "imgmesh-warp", container, "--image", image, "-q", *args, "-o", names[-1])
    sheet([[shown(name) for name in names]], HERE / "warp-arm.jpg")


def draw_photo(tools, folder):
    container = folder / "photo.glb"
    run(tools / "imgmesh-build", PHOTO, "-o", container, "--level-faces", "4000,600,80", "-q")
    lift = {"level": 2, "solver": "arap", "handles": [{"near": [190, 230], "move": [0, -40]}], "pins": [{"border": True}]}
    eye = {"level": 0, "solver": "arap", "handles": [{"circle": [512, 163, 20], "scale": 1.5}],
           "pins": [{"beyond": [512, 163, 60]}]}
    columns = [edited(tools, folder, container, PHOTO, edits, 1) for edits in ([], [lift, eye])]
    sheet(list(zip(*columns)), HERE / "warp-photo.jpg", 0.75)


def draw_retarget(tools, folder):
    container = folder / "one.glb"
    run(tools / "imgmesh-build", PHOTO, "-o", container, "-q")
    for option in ("--size", "--retarget"):
        run(tools / "imgmesh-warp", container, "-q", "--image", PHOTO, option, "480x512", "-o", folder / f"{option}.png")
    images = [shown(PHOTO), shown(folder / "--size.png"), shown(folder / "--retarget.png")]
    sheet([images], HERE / "warp-retarget.jpg", 0.5)


if __name__ == "__main__":
    main()

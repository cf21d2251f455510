#!/usr/bin/python3
"""Makes the images of docs/segment.md: make_segment.py BIN, with BIN the folder of the tools. It needs Chromium for the SVG.

tests/data/kodim23.png: an object chosen by pixels (segment-object.jpg), and what is written (segment-outputs.jpg).
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image, ImageDraw

from make_readme import labelled, save_grid
from make_warp import HERE, PHOTO, run, shown

KEEP, DROP = ((520, 200), (430, 265)), ((30, 30), (380, 350))
DETAIL = (500, 230, 596, 294)  # left, top, right, bottom [px]


def draw_object(tools, folder, container):
    mask = folder / "parrot.png"
    run(tools / "imgmesh-segment", container, "-q", "-o", folder / "labels.png", "--image", PHOTO, "--mask", mask,
        *(word for option, places in (("--keep", KEEP), ("--drop", DROP)) for x, y in places
          for word in (option, f"{x},{y}")))
    run(tools / "imgmesh-build", PHOTO, "-o", folder / "parrot.glb", "-q", "--mask", mask)
    run(tools / "imgmesh-reconstruct", folder / "parrot.glb", "-q", "-o", folder / "wire.png", "--mode", "wire", "--scale", 2)
    photo, inside = shown(PHOTO), np.asarray(Image.open(mask)) > 0
    clicks = photo.copy()
    for (x, y), color in [(place, (60, 230, 60)) for place in KEEP] + [(place, (255, 60, 60)) for place in DROP]:
        ImageDraw.Draw(clicks).ellipse((x - 14, y - 14, x + 14, y + 14), fill=color, outline=(255, 255, 255), width=4)
    white = np.where(inside[..., None], np.asarray(photo), 255).astype(np.uint8)
    save_grid([[labelled(clicks, "--keep (green), --drop (red)"), labelled(Image.fromarray(white), "what the mask keeps"),
                labelled(shown(folder / "wire.png"), "the mesh that is built with it")]], HERE / "segment-object.jpg")


def screenshot(svg, folder):
    """The detail of a drawing as Chromium shows it."""
    left, top, right, bottom = DETAIL
    text = svg.read_text().replace('viewBox="0 0 768 512"', f'viewBox="{left} {top} {right - left} {bottom - top}"')
    (folder / "detail.svg").write_text(text)
    page = folder / "detail.html"
    page.write_text('<body style="margin:0"><img src="detail.svg" style="width:768px;height:512px">')
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--window-size=768,512", "--hide-scrollbars",
                    f"--screenshot={folder}/detail.png", page], check=True, capture_output=True)
    return Image.open(folder / "detail.png").convert("RGB")


def draw_outputs(tools, folder, container):
    segment = [tools / "imgmesh-segment", container, "-q", "-o", folder / "labels.png", "--image", PHOTO, "--segments", "40"]
    run(*segment, "--colors", folder / "colors.png", "--ucm", folder / "ucm.npy", "--svg", folder / "smooth.svg")
    run(*segment, "--svg", folder / "pixels.svg", "--svg-tolerance", "0")
    heights = np.load(folder / "ucm.npy")
    borders = np.maximum(heights[1::2, 1:-1:2], heights[2::2, 1::2])  # each pixel's lower border, and its right one
    borders = np.maximum(borders, heights[1::2, 2::2])
    contours = Image.fromarray(np.uint8(255 - 255 * borders / borders.max()))
    svg = np.hstack([np.asarray(screenshot(folder / name, folder))[:, :384] for name in ("pixels.svg", "smooth.svg")])
    save_grid([[labelled(shown(folder / "colors.png"), "--colors"), labelled(contours.convert("RGB"), "--ucm"),
                labelled(Image.fromarray(svg), "--svg along pixels, and as usual")]], HERE / "segment-outputs.jpg")


def main():
    tools = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="imgmesh-segment-") as name:
        folder = pathlib.Path(name)
        container = folder / "photo.glb"
        run(tools / "imgmesh-build", PHOTO, "-o", container, "--density", "2", "-q")
        draw_object(tools, folder, container)
        draw_outputs(tools, folder, container)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Draws docs/images/smooth.jpg: make_smooth.py BIN, with BIN the folder of the tools.

A detail of tests/data/kodim23.png with noise and without, smoothed.
"""
import pathlib
import sys
import tempfile

import numpy as np
from PIL import Image

from make_readme import labelled, save_grid
from make_warp import HERE, PHOTO, run, shown

DETAIL = (64, 64, 384, 278)  # left, top, right, bottom [px]


def main():
    tools = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="imgmesh-smooth-") as name:
        folder = pathlib.Path(name)
        photo = np.asarray(Image.open(PHOTO).convert("RGB"), float)
        noisy = photo + np.random.default_rng(1).normal(0, 20, photo.shape)
        Image.fromarray(np.clip(np.rint(noisy), 0, 255).astype(np.uint8)).save(folder / "noisy.png")
        Image.fromarray(photo.astype(np.uint8)).save(folder / "photo.png")
        for stem, strength in (("noisy", 17), ("photo", 25)):
            image, container = folder / f"{stem}.png", folder / f"{stem}.glb"
            run(tools / "imgmesh-build", image, "-o", container, "-q")
            run(tools / "imgmesh-reconstruct", container, "-q", "-o", folder / f"{stem}-smooth.png", "--mode", "smooth",
                "--image", image, "--strength", strength)
        tiles = [("noisy.png", "noise of 20 of 255"), ("noisy-smooth.png", "smoothed, --strength 17"),
                 ("photo.png", "photograph"), ("photo-smooth.png", "smoothed, --strength 25")]
        save_grid([[labelled(shown(folder / file, DETAIL), text, 320, 214) for file, text in tiles]],
                  HERE / "smooth.jpg")


if __name__ == "__main__":
    main()

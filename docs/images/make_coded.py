#!/usr/bin/python3
"""Draws docs/images/coded.jpg: make_coded.py BIN, with BIN the folder of the tools. Needs avifenc and avifdec (libavif-bin).

tests/data/kodim23.png in 2,000 bytes: as a coded picture, and as the best AVIF that is no larger.
"""
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image, ImageChops, ImageStat

from make_readme import labelled, save_grid
from make_warp import HERE, PHOTO, run, shown

BYTES = 2000
DETAIL = (40, 80, 616, 464)  # left, top, right, bottom [px]


def avif(folder):
    """The best AVIF of at most BYTES, as a PNG: quantisers from coarse to fine, at full and at half size."""
    picture = Image.open(PHOTO).convert("RGB")
    best = None
    for size in (1, 2):
        small = folder / f"{size}.png"
        picture.resize((picture.width // size, picture.height // size), Image.LANCZOS).save(small)
        for quantiser in range(63, 0, -1):
            coded = folder / "coded.avif"
            subprocess.run(["avifenc", "-j", "1", "--speed", "3", "--yuv", "420", "--min", str(quantiser), "--max",
                            str(quantiser), small, coded], check=True, capture_output=True)
            if coded.stat().st_size > BYTES:
                break
            subprocess.run(["avifdec", coded, folder / "avif.png"], check=True, capture_output=True)
            again = Image.open(folder / "avif.png").convert("RGB").resize(picture.size, Image.LANCZOS)
            error = sum(ImageStat.Stat(ImageChops.difference(again, picture)).sum2)
            if best is None or error < best[0]:
                best = error, again
    best[1].save(folder / "avif.png")


def main():
    tools = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="imgmesh-coded-") as name:
        folder = pathlib.Path(name)
        coded = folder / "coded.imgm"
        run(tools / "imgmesh-encode", PHOTO, "-o", coded, "--bytes", BYTES, "-q")
        run(tools / "imgmesh-decode", coded, "-o", folder / "coded.png", "-q")
        avif(folder)
        tiles = [("coded.png", f"imgmesh-encode --bytes {BYTES}"), ("avif.png", f"AVIF of {BYTES:,} bytes")]
        save_grid([[labelled(shown(folder / file, DETAIL), text, 480, 320) for file, text in tiles]], HERE / "coded.jpg")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""compare_builds.py PROGRAM PROGRAM...: several builds of imgmesh-build write the same bytes.

Each builds containers of small images with every preset, metric, solver and kind of map. All are compared with those
of the first program. Exit status 1 tells that one differs.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

from PIL import Image, ImageDraw

PHOTO = pathlib.Path(__file__).resolve().parents[1] / "data" / "kodim23.png"
# Odd sides, so that rows end in lanes of vectors that are not full.
SIZE = (131, 97)
CASES = {
    **{f"preset-{name}": ["photo.png", "--preset", name] for name in ("fast", "default", "best", "fem")},
    **{f"{metric}-{solver}": ["photo.png", "--metric", metric, "--solver", solver, "--refine", "0"]
       for metric in ("flattened", "hoppe", "garland") for solver in ("svd", "lu", "closed")},
    "mask": ["masked.png", "--density", "3"],
    "mask-levels": ["masked.png", "--levels", "3"],
    "gray": ["gray.png"],
    "rebuilt": ["photo.png", "--quadrics", "rebuilt"],
    "tracked": ["photo.png", "--map", "tracked", "--visits"],
    "rgb-exchange": ["photo.png", "--objective", "rgb", "--exchange", "0.02"],
    "rms": ["photo.png", "--rms", "6"],
    "channels": ["gray.png", "--channels", "Y:20"],
    "plain": ["photo.png", "--draco", "none", "--bary", "float"],
}


def make_images(folder):
    photo = Image.open(PHOTO).convert("RGB").crop((200, 100, 200 + SIZE[0], 100 + SIZE[1]))
    photo.save(folder / "photo.png")
    photo.convert("L").save(folder / "gray.png")
    alpha = Image.new("L", SIZE, 0)
    draw = ImageDraw.Draw(alpha)
    draw.ellipse((6, 5, 122, 91), fill=255)
    draw.ellipse((39, 33, 71, 66), fill=0)
    photo.putalpha(alpha)
    photo.save(folder / "masked.png")


def build_all(programs, root):
    """root/I/NAME.glb of each program I and case, several at a time."""
    def build(i, name):
        image, *options = CASES[name]
        subprocess.run([programs[i], "--quiet", root / image, *options, "-o", root / str(i) / f"{name}.glb"], check=True)

    for i in range(len(programs)):
        (root / str(i)).mkdir()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for done in [pool.submit(build, i, name) for i in range(len(programs)) for name in CASES]:
            done.result()


def first_difference(one, other):
    """Index of the first byte in which two differ, or None."""
    if one == other:
        return None
    return next((i for i, (a, b) in enumerate(zip(one, other)) if a != b), min(len(one), len(other)))


def main(programs):
    if len(programs) < 2:
        sys.exit(__doc__)
    differences = 0
    with tempfile.TemporaryDirectory() as temporary:
        root = pathlib.Path(temporary)
        make_images(root)
        build_all(programs, root)
        for i, program in enumerate(programs[1:], 1):
            for name in CASES:
                want, got = ((root / str(k) / f"{name}.glb").read_bytes() for k in (0, i))
                at = first_difference(want, got)
                if at is not None:
                    differences += 1
                    print(f"{name}: {program} differs from {programs[0]} from byte {at} on "
                          f"({len(got)} and {len(want)} bytes)")
    print(f"{len(programs)} builds, {len(CASES)} containers each, {differences} differences")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

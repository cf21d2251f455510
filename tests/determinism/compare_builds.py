#!/usr/bin/python3
"""compare_builds.py PROGRAM PROGRAM...: several builds of imgmesh-build write the same bytes.

Each builds containers of small images with every preset, metric, solver and kind of map. All are compared with those
of the first program. Exit status 1 tells that one differs.
"""
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image, ImageDraw

PHOTO = pathlib.Path(__file__).resolve().parents[1] / "data" / "kodim23.png"
# Odd sides, so that rows end in lanes of vectors that are not full.
SIZE = (203, 147)
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
    draw.ellipse((10, 8, 190, 138), fill=255)
    draw.ellipse((60, 50, 110, 100), fill=0)
    photo.putalpha(alpha)
    photo.save(folder / "masked.png")


def build(program, images, folder):
    folder.mkdir()
    for name, (image, *options) in CASES.items():
        subprocess.run([program, "--quiet", images / image, *options, "-o", folder / f"{name}.glb"], check=True)


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
        for i, program in enumerate(programs):
            build(program, root, root / str(i))
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

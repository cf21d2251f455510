"""Images of another reader's test suite, where its Debian package is installed: their colours are those of the references.

suites_test.py FOLDER-OF-TOOLS: the reference tests of gdk-pixbuf (package gdk-pixbuf-tests), BMP and TGA."""
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

FOLDER = pathlib.Path("/usr/libexec/installed-tests/gdk-pixbuf/test-images")
# Codes of 5 bits: the references round down, imgmesh to the nearest.
ROUNDED = ("gtk-logo-16bpp",)


def rgba(path):
    return np.asarray(Image.open(path).convert("RGBA")).astype(int)


def read_back(tools, path, folder):
    """The colours as imgmesh has read them: with every vertex kept, the container draws them back exactly."""
    container, picture = folder / "a.glb", folder / "a.png"
    for command in (["imgmesh-build", path, "-o", container, "--faces", "1000000", "--alpha", "ignore", "--quiet"],
                    ["imgmesh-reconstruct", container, "-o", picture, "--quiet"]):
        done = subprocess.run([tools / command[0], *map(str, command[1:])], stderr=subprocess.PIPE, encoding="utf-8",
                              check=False)
        if done.returncode != 0:
            raise RuntimeError(done.stderr)
    return rgba(picture)


def difference(path, back):
    """What is wrong with the image, or nothing."""
    expected = rgba(f"{path}.ref.png")
    if back.shape != expected.shape:
        return f"{back.shape}, expected {expected.shape}"
    off = np.abs(back - expected)
    visible = expected[..., 3] > 0  # the references have no colour elsewhere
    if off[visible][:, :3].max(initial=0) > (1 if path.name.startswith(ROUNDED) else 0):
        return f"colours differ by {off[visible][:, :3].max()}"
    return None


def main():
    tools = pathlib.Path(sys.argv[1])
    files = sorted(p for p in FOLDER.rglob("*") if p.suffix in (".bmp", ".tga") and os.path.exists(f"{p}.ref.png"))
    if not files:
        sys.exit(f"no images in {FOLDER}")
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        for path in files:
            wrong = difference(path, read_back(tools, path, pathlib.Path(folder)))
            if wrong:
                failures += 1
                print(f"{path}: {wrong}")
    print(f"{len(files)} images, {failures} wrong")
    sys.exit(failures > 0)


main()

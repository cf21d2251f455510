#!/usr/bin/python3
"""Makes the images of README.md: make_readme.py BIN, with BIN the folder of the tools.

tests/data/kodim23.png as a mesh (overview.jpg), and cut into regions (regions.jpg).
"""
import pathlib
import sys
import tempfile

from PIL import Image, ImageDraw, ImageFont

from make_warp import HERE, PHOTO, run, shown

HEAD = (440, 70, 656, 214)  # a detail of the photograph: left, top, right, bottom [px]
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"  # Debian's fonts-dejavu-core


def labelled(image, text, width=384, height=256):
    """The image at `width` x `height`, with a line of text above."""
    out = Image.new("RGB", (width, height + 24), (255, 255, 255))
    out.paste(image.resize((width, height), Image.LANCZOS), (0, 24))
    ImageDraw.Draw(out).text((2, 3), text, fill=(30, 30, 30), font=ImageFont.truetype(FONT, 15))
    return out


def save_grid(rows, path, gap=6):
    width, height = rows[0][0].size
    out = Image.new("RGB", (len(rows[0]) * (width + gap) - gap, len(rows) * (height + gap) - gap), (255, 255, 255))
    for j, row in enumerate(rows):
        for i, tile in enumerate(row):
            out.paste(tile, (i * (width + gap), j * (height + gap)))
    out.save(path, quality=86, optimize=True)


def draw_overview(tools, folder):
    container = folder / "photo.glb"
    run(tools / "imgmesh-build", PHOTO, "-o", container, "-q")
    for mode in ("gouraud", "map"):
        run(tools / "imgmesh-reconstruct", container, "-q", "-o", folder / f"{mode}.png", "--mode", mode)
    run(tools / "imgmesh-reconstruct", container, "-q", "-o", folder / "wire.png", "--mode", "wire", "--scale", 3)
    wire = shown(folder / "wire.png")
    detail = wire.crop([round(3 * side) for side in HEAD])
    save_grid([[labelled(shown(PHOTO), "photograph: 393,216 pixels"), labelled(wire, "mesh: 3,932 vertices"),
                labelled(detail, "mesh, enlarged")],
               [labelled(shown(PHOTO, HEAD), "photograph, enlarged"),
                labelled(shown(folder / "gouraud.png", HEAD), "the mesh alone"),
                labelled(shown(folder / "map.png", HEAD), "through the pixel map")]], HERE / "overview.jpg")


def draw_regions(tools, folder):
    container, labels = folder / "regions.glb", folder / "labels.png"
    run(tools / "imgmesh-build", PHOTO, "-o", container, "--density", "2", "-q")
    segment = [tools / "imgmesh-segment", container, "-q", "-o", labels, "--image", PHOTO]
    run(*segment, "--segments", "20", "--outlines", folder / "outlines.png", "--flat", folder / "flat.png")
    run(*segment, "--superpixels", "300", "--outlines", folder / "superpixels.png")
    save_grid([[labelled(shown(folder / "outlines.png"), "20 regions"),
                labelled(shown(folder / "flat.png"), "their mean colours"),
                labelled(shown(folder / "superpixels.png"), "300 superpixels")]], HERE / "regions.jpg")


def main():
    tools = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="imgmesh-readme-") as name:
        draw_overview(tools, pathlib.Path(name))
        draw_regions(tools, pathlib.Path(name))


if __name__ == "__main__":
    main()

"""Both layouts of one pixel map, read by read_container.py: the same faces and weights, and the image as imgmesh draws it.

The compact stream's reader takes a tenth of a millisecond for a pixel, so that images are small.
"""
import json

import numpy as np

import picture_files
import read_container
from support import CliCase, main


def stored_maps(path):
    """For each level face.id, bary.u and bary.v, (3, H, W)."""
    document, binary, layers = read_container.read_gltf(path)
    root = document["extensions"][read_container.EXTENSION]
    maps = []
    for node in document["nodes"]:
        own = node["extensions"][read_container.EXTENSION]
        faces, positions, _, _ = read_container.read_mesh(document, binary, node)
        if root["layers"]["mimeType"] == read_container.COMPACT:
            found = read_container.read_compact(layers, own["part"], own["topology"], faces, positions)
        else:
            found = read_container.read_exr(layers, own["part"], own["topology"])
        maps.append(np.stack([channel.astype(float) for channel in found]))
    return maps


class Compact(CliCase):
    def check(self, picture, *args, channel=None, exposure=1.0):
        """Builds a compact .glb, converts it to an EXR beside a .gltf and back, and reads all of them."""
        for path in self.folder.glob("[ce].[gi]*"):
            path.unlink()
        built = self.build(picture, "--layers", "compact", "--draco", "none", *args, output="c.glb")
        for source, target, layers in (("c.glb", "e.gltf", "exr"), ("e.gltf", "c.gltf", "compact")):
            self.run_ok("imgmesh-convert", source, "-o", target, "--layers", layers, "--draco", "none")
            self.run_ok("imgmesh-info", target, "--validate", "--warnings-as-errors")
        self.assertEqual((self.folder / "c.imgmap").read_bytes()[:4], b"IMAP")
        expected = stored_maps(self.folder / "e.gltf")
        self.assertEqual(len(expected), len(built["levels"]))
        for name in ("c.glb", "c.gltf"):
            for level, (found, wanted) in enumerate(zip(stored_maps(self.folder / name), expected)):
                np.testing.assert_array_equal(found, wanted, f"{name}, level {level}")
        for level in range(len(expected)):
            self.check_drawing(level, channel, exposure)
        return expected

    def check_drawing(self, level, channel, exposure):
        drawn, inside, channels = read_container.reconstruct(self.folder / "c.glb", level, exposure)
        self.run_ok("imgmesh-reconstruct", "c.glb", "-o", "drawn.exr", "--level", level)
        wanted = picture_files.read(self.folder / "drawn.exr")
        names = picture_files.spec(self.folder / "drawn.exr").channelnames
        np.testing.assert_array_equal(inside, wanted[:, :, names.index("A")] > 0 if "A" in names else True)
        light = np.dstack([wanted[:, :, names.index(name)] for name in "RGB"])
        difference = np.abs(drawn / 255 - read_container.srgb_from_linear(exposure * light))
        self.assertLessEqual(difference[inside].max(), 1 / 255)
        if channel:
            np.testing.assert_allclose(channels[channel], wanted[:, :, names.index(channel)], atol=2e-3)

    def noise(self, width, height):
        return picture_files.png(self.folder / "p.png", picture_files.noise(width, height, seed=7))

    def test_plain(self):
        self.noise(40, 30)
        for options in (["--bary", "float", "--visits"], ["--density", "5", "--map-step", "1/32"]):
            with self.subTest(options):
                self.check("p.png", *options)

    def test_masked(self):
        y, x = np.mgrid[:30, :40]
        alpha = np.where((x - 18) ** 2 + (y - 15) ** 2 < 150, 1.0, 0.0)
        alpha[5, 30:38] = 1  # a strip one pixel wide
        pixels = np.dstack([picture_files.noise(40, 30, seed=8)[..., :3], alpha])
        picture_files.png(self.folder / "m.png", pixels)
        (found,) = self.check("m.png", "--alpha", "cut")
        self.assertEqual((found[0] != read_container.NO_FACE).sum(), alpha.sum())

    def test_levels(self):
        self.noise(48, 36)
        self.assertEqual(len(self.check("p.png", "--faces", "400", "--levels", "2", "--map-step", "1/8")), 2)

    def test_channels(self):
        y, x = np.mgrid[:24, :32]
        names = ["R", "G", "B"] + [f"band{k}" for k in range(13)]
        samples = np.dstack([np.sin(0.1 * (k + 1) * x + 0.07 * y) * 0.4 + 0.5 for k in range(16)])
        picture_files.write_float(self.folder / "c.exr", samples, "float", names)
        self.check("c.exr", "--channels", ",".join(names), channel="band12")

    def test_hdr(self):
        y, x = np.mgrid[:24, :32]
        samples = np.dstack([np.exp(0.1 * x), np.exp(0.1 * y), np.ones(x.shape)])
        picture_files.write_float(self.folder / "h.exr", samples, "float", ["R", "G", "B"])
        self.check("h.exr", exposure=0.25)

    def test_thin(self):
        for width, height in ((1, 1), (1, 17), (17, 1), (2, 2)):
            with self.subTest(f"{width}x{height}"):
                self.noise(width, height)
                self.check("p.png")

    def test_another_mesh_is_refused(self):
        self.noise(20, 15)
        self.run_ok("imgmesh-build", "p.png", "-o", "c.gltf", "--layers", "compact", "--draco", "none")
        stream = bytearray((self.folder / "c.imgmap").read_bytes())
        at = stream.index(bytes.fromhex(json.loads((self.folder / "c.gltf").read_text())["nodes"][0]["extensions"][
            read_container.EXTENSION]["topology"]))
        stream[at] ^= 1
        (self.folder / "c.imgmap").write_bytes(stream)
        with self.assertRaises(SystemExit):
            stored_maps(self.folder / "c.gltf")


if __name__ == "__main__":
    main()

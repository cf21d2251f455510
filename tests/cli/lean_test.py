"""Meshes of fewer bytes, and meshes without a pixel map, as a user meets them."""
import json

import numpy

import picture_files
from support import CliCase, main


class Lean(CliCase):
    def setUp(self):
        super().setUp()
        y, x = numpy.mgrid[0:120, 0:160]
        waves = numpy.stack([0.5 + 0.4 * numpy.sin(x / 9 + k) * numpy.cos(y / (7 + k)) for k in range(3)], 2)
        picture_files.png(self.folder / "p.png", 0.9 * waves + 0.1 * picture_files.noise(160, 120, seed=3))

    def psnr(self, container, mode):
        self.run_ok("imgmesh-reconstruct", container, "-o", "again.png", "--mode", mode)
        return picture_files.psnr(picture_files.read(self.folder / "again.png"), picture_files.read(self.folder / "p.png"))

    def test_compact(self):
        """Half the bytes, at most 0.1 dB, no folds, and a file that nothing objects to."""
        exact = self.build("p.png", "--density", "4", output="exact.glb")
        self.assertNotIn("position_step", exact)
        self.assertNotIn("color_levels", exact)
        lean = self.build("p.png", "--density", "4", "--mesh-precision", "compact", output="lean.glb")
        self.assertEqual(lean["position_step"], 0.25)
        self.assertEqual(lean["fine_vertices"], 0)
        self.assertGreaterEqual(lean["color_levels"], 64)
        self.assertLess(lean["mesh_bytes"], 0.9 * exact["mesh_bytes"])
        self.assertEqual((lean["vertices"], lean["flipped_pixel_triangles"]), (exact["vertices"], 0))
        for mode in ("map", "gouraud"):
            self.assertGreater(self.psnr("lean.glb", mode), self.psnr("exact.glb", mode) - 0.1)
        self.run_ok("imgmesh-info", "lean.glb", "--validate", "--warnings-as-errors")
        self.assertEqual(self.report("imgmesh-info", "lean.glb")["build"]["mesh-precision"], "compact")
        self.assertNotIn("mesh-precision", self.report("imgmesh-info", "exact.glb")["build"])

    def test_what_is_stored_lies_on_the_grids(self):
        report = self.build("p.png", "--position-step", "1/2", "--color-levels", "16", "--draco", "none", output="c.gltf")
        self.assertEqual((report["position_step"], report["color_levels"]), (0.5, 16))
        document = json.loads((self.folder / "c.gltf").read_text())
        data = (self.folder / document["buffers"][0]["uri"]).read_bytes()
        attributes = document["meshes"][0]["primitives"][0]["attributes"]

        def values(name, dtype, width):
            accessor = document["accessors"][attributes[name]]
            start = document["bufferViews"][accessor["bufferView"]]["byteOffset"]
            return numpy.frombuffer(data, dtype, accessor["count"] * width, start).reshape(-1, width)

        places, colors = values("POSITION", "<f4", 3), values("COLOR_0", "<u2", 4)
        self.assertTrue((places * 2 == numpy.floor(places * 2)).all())
        encoded = numpy.arange(16) / 15
        levels = 65535 * numpy.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
        self.assertLess(abs(colors[:, :3, None] - levels).min(axis=2).max(), 0.6)
        self.assertTrue((colors[:, 3] == 65535).all())

    def test_masks_levels_and_thin_images(self):
        mask = numpy.zeros((120, 160, 3))
        mask[10:90, 20:70] = 1
        mask[60:115, 60:150] = 1
        mask[0, 130:160] = 1  # a strip one pixel wide
        picture_files.png(self.folder / "mask.png", mask)
        picture_files.png(self.folder / "thin.png", picture_files.noise(1, 40))
        picture_files.png(self.folder / "dot.png", picture_files.noise(1, 1))
        for picture, options in (("p.png", ["--mask", "mask.png", "--levels", "3"]), ("thin.png", ["--density", "30"]),
                                 ("dot.png", []), ("p.png", ["--density", "60"]), ("p.png", ["--preset", "fem"])):
            report = self.build(picture, "--mesh-precision", "compact", *options, output="c.glb")
            self.assertEqual([level["flipped_pixel_triangles"] for level in report["levels"]], [0] * len(report["levels"]))
            self.run_ok("imgmesh-info", "c.glb", "--validate")

    def test_a_strip_keeps_its_sides(self):
        """They are half a pixel out, between the positions of whole pixels."""
        wave = 0.5 + 0.4 * numpy.sin(numpy.arange(59)[None, :, None] / 3)
        picture_files.png(self.folder / "wide.png", wave)
        picture_files.png(self.folder / "high.png", wave.transpose(1, 0, 2))
        for picture in ("wide.png", "high.png"):
            self.run_ok("imgmesh-build", picture, "-o", "c.glb", "--density", "20", "--position-step", "1", "-q")
            self.run_ok("imgmesh-info", "c.glb", "--validate", "--warnings-as-errors")

    def test_what_has_no_colour_levels(self):
        picture_files.write_float(self.folder / "hdr.exr", 4 * picture_files.noise(40, 30))
        report = self.build("hdr.exr", "--density", "5", "--mesh-precision", "compact", output="c.glb")
        self.assertNotIn("color_levels", report)
        self.assertEqual(report["position_step"], 0.25)
        self.assert_error("imgmesh-build", ["hdr.exr", "-o", "c.glb", "--color-levels", "90"], 5, "HDR")

    def test_without_compression_nothing_is_gained(self):
        result = self.run_tool("imgmesh-build", "p.png", "-o", "c.glb", "--no-map", "--mesh-precision", "compact")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("--compression draco", result.stderr)

    def test_convert(self):
        """Colours may change without a map's leave, positions may not."""
        self.build("p.png", "--density", "4", output="c.glb")
        result = self.run_tool("imgmesh-convert", "c.glb", "-o", "colours.glb", "--mesh-precision", "compact")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("positions stay", result.stderr)
        self.run_ok("imgmesh-info", "colours.glb", "--validate")
        self.assertGreater(self.psnr("colours.glb", "map"), self.psnr("c.glb", "map") - 0.1)
        sizes = [self.report("imgmesh-convert", "c.glb", "-o", "m.glb", "--no-map", "--compression", "draco",
                             "--mesh-precision", precision)["mesh_bytes"] for precision in ("exact", "compact")]
        self.assertLess(sizes[1], 0.9 * sizes[0])
        self.assert_error("imgmesh-convert", ["c.glb", "-o", "x.svg", "--mesh-precision", "compact"], 2, "--mesh-precision")

    def test_plain_meshes(self):
        """Every tool that needs a pixel map says so in one line, and who makes one."""
        for name in ("plain.glb", "plain.gltf"):
            self.run_ok("imgmesh-build", "p.png", "-o", name, "--no-map", "-q")
            for tool, *args in (("imgmesh-reconstruct", "-o", "x.png"), ("imgmesh-segment", "-o", "x.png"),
                                ("imgmesh-warp", "-o", "x.glb", "--handle", "1,1:2,2"), ("imgmesh-info",),
                                ("imgmesh-convert", "-o", "x.glb"), ("imgmesh-convert", "-o", "x.svg")):
                self.assert_error(tool, [name, *args], 4, name, "no pixel map", "imgmesh-build without no-map")
            self.assert_error("imgmesh-compare", ["p.png", name], 4, name, "imgmesh-build without no-map")
            result = self.run_tool("imgmesh-info", name, "--validate")
            self.assertEqual(result.returncode, 4)
            self.assertIn("imgmesh-build without no-map", result.stdout)

    def test_a_texture_leaves_positions_fine(self):
        result = self.run_tool("imgmesh-build", "p.png", "-o", "c.glb", "--texture", "--mesh-precision", "compact", "--json")
        self.assertIn("1/32", result.stderr)
        report = json.loads(result.stdout)["images"][0]
        self.assertNotIn("position_step", report)
        self.assertIn("color_levels", report)

    def test_wrong_use(self):
        for options, words in ((["--mesh-precision", "compact", "--map", "tracked"], ("--mesh-precision", "--map")),
                               (["--position-step", "1/4", "--map", "tracked"], ("--position-step", "--map")),
                               (["--position-step", "0.3"], ("--position-step",)), (["--color-levels", "1"], ("--color-levels",)),
                               (["--color-levels", "9", "--values"], ("--color-levels", "--values"))):
            self.assert_error("imgmesh-build", ["p.png", "-o", "c.glb", *options], 2, *words)


if __name__ == "__main__":
    main()

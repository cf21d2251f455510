"""imgmesh-reconstruct: every drawing, and the reconstruction against an evaluation that shares no code."""
import subprocess
import sys
import xml.etree.ElementTree

import numpy as np

import picture_files
from support import ROOT, CliCase, main


class Reconstruct(CliCase):
    def setUp(self):
        super().setUp()
        self.original = picture_files.read(picture_files.png(self.folder / "in.png", picture_files.ramp(48, 32)))
        self.built = self.build("in.png", "--faces", "300", "--draco", "none", output="c.glb")

    def draw(self, *args, output="out.png"):
        report = self.report("imgmesh-reconstruct", "c.glb", "-o", output, *args)
        return report, picture_files.read(self.folder / output)

    def test_map_is_close_to_the_picture(self):
        report, image = self.draw()
        self.assertEqual((report["mode"], report["width"], report["height"]), ("map", 48, 32))
        self.assertEqual(report["faces"], self.built["faces"])
        self.assertEqual(report["bytes"], (self.folder / "out.png").stat().st_size)
        self.assertGreater(picture_files.psnr(image, self.original), 25)

    def test_modes_differ(self):
        drawn = {mode: self.draw("--mode", mode)[1] for mode in ("map", "gouraud", "wire", "patches", "flat")}
        for a in drawn:
            self.assertEqual(drawn[a].shape, self.original.shape)
            for b in drawn:
                if a != b:
                    self.assertFalse(np.array_equal(drawn[a], drawn[b]), f"{a} and {b}")
        self.assertGreater(picture_files.psnr(drawn["gouraud"], self.original), 20)

    def test_scale(self):
        for mode in ("gouraud", "wire", "flat"):
            for scale, size in (("3", (144, 96)), ("0.5", (24, 16)), ("0.001", (1, 1))):
                report, image = self.draw("--mode", mode, "--scale", scale)
                self.assertEqual((report["width"], report["height"]), size)
                self.assertEqual(image.shape[1::-1], size)

    def test_scale_without_bounds(self):
        for scale in ("1e5", "1e300", "1e-40", "0.0009"):
            self.assert_error("imgmesh-reconstruct", ["c.glb", "-o", "x.png", "--mode", "flat", "--scale", scale], 2,
                              "--scale")

    def test_level_that_is_not_there(self):
        self.assert_error("imgmesh-reconstruct", ["c.glb", "-o", "x.png", "--level", "1"], 2, "--level 1", "c.glb")

    def test_depth(self):
        for depth, extension, stored in (("8", "png", "uint8"), ("16", "png", "uint16"), ("16", "tif", "uint16"),
                                         ("half", "exr", "half"), ("float", "exr", "float"),
                                         ("float", "tif", "float")):
            _, image = self.draw("--depth", depth, output=f"out.{extension}")
            self.assertEqual(str(picture_files.spec(self.folder / f"out.{extension}").format), stored)
            self.assertEqual(image.shape, self.original.shape)
        self.draw(output="default.png")
        self.assertEqual(str(picture_files.spec(self.folder / "default.png").format), "uint8")

    def test_exr_is_linear(self):
        _, encoded = self.draw("--depth", "16", output="a.png")
        _, linear = self.draw("--depth", "float", output="a.exr")
        expected = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
        np.testing.assert_allclose(linear, expected, atol=1e-4)

    def test_svg(self):
        for mode in ("wire", "flat"):
            self.report("imgmesh-reconstruct", "c.glb", "-o", "x.svg", "--mode", mode)
            root = xml.etree.ElementTree.parse(self.folder / "x.svg").getroot()
            self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")

    def test_text_report(self):
        text = self.run_ok("imgmesh-reconstruct", "c.glb", "-o", "out.png").stdout
        self.assertTrue(text.startswith("c.glb -> out.png\n"))
        self.assertIn("48 x 32", text)

    def test_agrees_with_an_independent_evaluation(self):
        """The script knows docs/format.md and nothing of ours. Both round to 8 bits, which alone is 55 dB."""
        for faces in ("60", "300"):
            for container in ("c.glb", "c.gltf"):
                self.build("in.png", "--faces", faces, "--draco", "none", output=container)
                self.report("imgmesh-reconstruct", container, "-o", "out.png")
                result = subprocess.run([sys.executable, "-B", str(ROOT / "tests/interop/read_container.py"), container,
                                         "ref.png", "--expect", "out.png", "--min-psnr", "45"],
                                        cwd=self.folder, timeout=120, capture_output=True, text=True, check=False)
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                reference = picture_files.read(self.folder / "ref.png")[..., :3]
                self.assertGreaterEqual(
                    picture_files.psnr(picture_files.read(self.folder / "out.png"), reference), 45)


if __name__ == "__main__":
    main()

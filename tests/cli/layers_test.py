"""Layers of containers in both layouts, and containers of version 1.0."""
import shutil

import numpy as np

import picture_files
from support import ROOT, CliCase, main


class OldContainer(CliCase):
    """A container that imgmesh wrote when the format was 1.0; tests/data/README.md says how."""

    def setUp(self):
        super().setUp()
        shutil.copy(ROOT / "tests/data/container-1.0.glb", self.folder / "old.glb")

    def draw(self, container, level):
        self.run_ok("imgmesh-reconstruct", container, "-o", "drawn.png", "--level", level)
        return picture_files.read(self.folder / "drawn.png")

    def test_reads_as_before(self):
        facts = self.report("imgmesh-info", "old.glb")
        self.assertEqual((facts["version"], facts["layers"], facts["has_mask"], facts["has_visits"]),
                         ("1.0", "exr", True, True))
        self.assertEqual(len(facts["levels"]), 2)
        self.assertEqual(self.report("imgmesh-info", "old.glb", "--validate")["findings"], [])
        y, x = np.mgrid[:20, :30]
        inside = (x - 14) ** 2 / 1.5 + (y - 10) ** 2 < 70
        image = np.dstack([0.5 + 0.4 * np.sin(x / 5 + y / 9), 0.5 + 0.4 * np.cos(y / 4),
                           np.where(2 * x + y < 40, 0.2, 0.8)])
        drawn = self.draw("old.glb", 0)
        np.testing.assert_array_equal(drawn[..., 3] > 0, inside)
        self.assertGreater(picture_files.psnr(drawn[inside][:, :3], image[inside]), 35)

    def test_converts_to_the_exr_of_today(self):
        for output in ("new.glb", "new.gltf"):
            self.run_ok("imgmesh-convert", "old.glb", "-o", output, "--layers", "exr")
            facts = self.report("imgmesh-info", output)
            self.assertEqual((facts["version"], facts["layers"]), ("1.1", "exr"))
            self.assertEqual(self.report("imgmesh-info", output, "--validate")["findings"], [])
            for level in (0, 1):
                np.testing.assert_array_equal(self.draw(output, level), self.draw("old.glb", level))

    def test_layers_stay_an_exr_without_a_wish(self):
        self.run_ok("imgmesh-convert", "old.glb", "-o", "new.glb")
        self.assertEqual(self.report("imgmesh-info", "new.glb")["layers"], "exr")

    def test_has_no_compact_form(self):
        self.assert_error("imgmesh-convert", ["old.glb", "-o", "new.glb", "--layers", "compact"], 5, "lod0", "not lie on a grid",
                          "older version")


class OffTheGrid(CliCase):
    """What takes pixels off the grid of compact layers writes an EXR, and says so."""

    def test_a_warning_tells_of_the_exr(self):
        picture_files.png(self.folder / "p.png", picture_files.noise(40, 30, seed=4))
        self.build("p.png", "--layers", "compact", output="c.glb")
        for tool, options in (("imgmesh-convert", ["--texture"]), ("imgmesh-warp", ["--handle", "20,15:1,0"])):
            report = self.report(tool, "c.glb", "-o", "out.glb", *options)
            self.assertEqual(len(report["warnings"]), 1, report["warnings"])
            self.assertTrue(report["warnings"][0].endswith("out.glb has an EXR"), report["warnings"])
            self.assertEqual(self.report("imgmesh-info", "out.glb")["layers"], "exr")
        self.assertEqual(self.report("imgmesh-convert", "c.glb", "-o", "d.glb").get("warnings", []), [])
        self.assert_error("imgmesh-convert", ["c.glb", "-o", "e.glb", "--texture", "--layers", "compact"], 2, "grid")


class Sidecar(CliCase):
    """A .gltf with compact layers, whose sidecar file is not what it must be."""

    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "p.png", picture_files.noise(40, 30, seed=4))
        self.build("p.png", "--layers", "compact", output="c.gltf")

    def refused(self, code, *words):
        self.assert_error("imgmesh-info", ["c.gltf"], code, *words)
        self.assert_error("imgmesh-reconstruct", ["c.gltf", "-o", "x.png"], code, *words)
        self.assert_error("imgmesh-convert", ["c.gltf", "-o", "x.glb", "--layers", "exr"], code, *words)

    def test_is_the_third_file(self):
        self.assertEqual(sorted(self.files()), ["c.bin", "c.gltf", "c.imgmap", "p.png"])
        facts = self.report("imgmesh-info", "c.gltf")
        self.assertEqual((facts["layers"], facts["bytes"]["layers"]),
                         ("compact", (self.folder / "c.imgmap").stat().st_size))

    def test_missing(self):
        (self.folder / "c.imgmap").unlink()
        self.refused(3, "c.imgmap")

    def test_cut_off(self):
        stream = (self.folder / "c.imgmap").read_bytes()
        (self.folder / "c.imgmap").write_bytes(stream[:-100])
        self.refused(4, "layers.header", "ends too early")
        (self.folder / "c.imgmap").write_bytes(b"")
        self.refused(4, "layers.magic")

    def test_of_another_image(self):
        picture_files.png(self.folder / "q.png", picture_files.noise(40, 30, seed=5))
        self.build("q.png", "--layers", "compact", output="d.gltf")
        shutil.copy(self.folder / "d.imgmap", self.folder / "c.imgmap")
        self.refused(4, "layers.topology")

    def test_an_exr_instead(self):
        self.run_ok("imgmesh-convert", "c.gltf", "-o", "e.gltf", "--layers", "exr")
        shutil.copy(self.folder / "e.exr", self.folder / "c.imgmap")
        self.refused(4, "layers.magic")


if __name__ == "__main__":
    main()

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


if __name__ == "__main__":
    main()

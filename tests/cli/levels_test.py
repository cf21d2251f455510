"""Pyramids, and the limits on faces."""
import picture_files
from support import CliCase, main


class Levels(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "p.png", picture_files.noise(60, 45, seed=3))

    def built(self, *args):
        return self.report("imgmesh-build", "p.png", "-o", "p.glb", *args)["images"][0]

    def test_each_level_has_a_quarter_of_the_faces(self):
        image = self.built("--faces", "800", "--levels", "3")
        faces = [level["faces"] for level in image["levels"]]
        self.assertEqual(len(faces), 3)
        for fine, coarse in zip(faces, faces[1:]):
            self.assertIn(fine // 4 - coarse, (0, 1))
        self.assertEqual(image["faces"], faces[0])
        info = self.report("imgmesh-info", "p.glb")
        self.assertEqual([level["faces"] for level in info["levels"]], faces)
        for level in image["levels"]:
            self.assertEqual(level["flipped_pixel_triangles"], 0)
        for k in range(3):
            self.run_ok("imgmesh-reconstruct", "p.glb", "-o", f"{k}.png", "--level", str(k))
        self.run_ok("imgmesh-info", "p.glb", "--validate")

    def test_faces_of_each_level(self):
        image = self.built("--level-faces", "900,100,20")
        for level, faces in zip(image["levels"], (900, 100, 20)):
            self.assertIn(faces - level["faces"], (0, 1))

    def test_errors_of_each_level(self):
        levels = self.built("--level-errors", "500,5000,50000")["levels"]
        for level, error in zip(levels, (500, 5000, 50000)):
            self.assertLessEqual(level["error"], error)
        faces = [level["faces"] for level in levels]
        self.assertEqual(faces, sorted(faces, reverse=True))
        self.assertLess(faces[2], faces[0])

    def test_limits_on_faces_win_over_the_target(self):
        free = self.built("--faces", "100")
        few_pixels = self.built("--faces", "100", "--max-cluster", "12")
        self.assertGreaterEqual(few_pixels["faces"], 60 * 45 / 12)
        self.assertGreater(few_pixels["faces"], free["faces"])
        info = self.report("imgmesh-info", "p.glb")
        self.assertEqual(info["build"]["max-cluster"], 12)
        round_faces = self.built("--faces", "100", "--min-quality", "0.6")
        self.assertLess(round_faces["mean_edge_ratio"], free["mean_edge_ratio"])

    def test_variants_of_the_metric_are_recorded(self):
        self.built("--faces", "100", "--quadrics", "rebuilt", "--priority", "total")
        build = self.report("imgmesh-info", "p.glb")["build"]
        self.assertEqual((build["quadrics"], build["priority"]), ("rebuilt", "total"))

    def test_bad_values(self):
        for args in (["--levels", "0"], ["--levels", "33"], ["--levels", "x"], ["--level-faces", ""],
                     ["--level-faces", "100,"], ["--level-faces", "100,200"], ["--level-faces", "100,100"],
                     ["--level-faces", "10,1"], ["--level-errors", "2,1"], ["--level-errors", "nan"],
                     ["--max-cluster", "2"], ["--min-quality", "0.9"], ["--min-quality", "-1"],
                     ["--levels", "2", "--level-faces", "9,4"], ["--faces", "9", "--level-faces", "9,4"],
                     ["--level-faces", "9,4", "--level-errors", "1,2"],
                     ["--quadrics", "none"], ["--priority", ""]):
            with self.subTest(args):
                result = self.run_tool("imgmesh-build", "p.png", "-o", "p.glb", *args)
                self.assert_error_lines("imgmesh-build", result, 2, 1)
                self.assertNotIn("p.glb", self.files())


if __name__ == "__main__":
    main()

"""Which map a container holds, and how often its pixels were visited."""
import picture_files
from support import CliCase, main


class Maps(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "p.png", picture_files.noise(60, 45, seed=3))

    def built(self, *args):
        return self.report("imgmesh-build", "p.png", "-o", "p.glb", "--density", "8", *args)["images"][0]

    def test_each_map_is_stored_and_recorded(self):
        rms = {}
        for kind in ("relaxed", "tracked", "trivial"):
            image = self.built("--map", kind, "--refine", "0")
            rms[kind] = image["map_rms"]
            info = self.report("imgmesh-info", "p.glb")
            self.assertEqual(info["build"]["map"], kind)
            self.assertFalse(info["has_visits"])
            self.run_ok("imgmesh-info", "p.glb", "--validate")
            self.run_ok("imgmesh-reconstruct", "p.glb", "-o", "p.out.png")
        self.assertLess(rms["relaxed"], rms["trivial"])
        self.assertLess(rms["tracked"], rms["trivial"])

    def test_folds_of_a_tracked_map_are_counted(self):
        self.assertGreater(self.built("--map", "tracked", "--projection-color-weight", "1")["flipped_pixel_triangles"], 0)
        self.assertEqual(self.built()["flipped_pixel_triangles"], 0)

    def test_weight_zero_is_the_trivial_map(self):
        self.built("--projection-color-weight", "0")
        self.assertEqual(self.report("imgmesh-info", "p.glb")["build"]["map"], "trivial")

    def test_contradictions(self):
        command = ["p.png", "-o", "out.glb", "--map"]
        for args in (["tracked", "--projection-color-weight", "0"], ["relaxed", "--projection-color-weight", "0"],
                     ["trivial", "--projection-color-weight", "0.1"]):
            self.assert_error("imgmesh-build", command + args, 2, "trivial")
        self.assert_error("imgmesh-build", [*command, "tracked", "--refine", "2"], 2, "refine")
        self.assert_error("imgmesh-build", [*command, "follow"], 2, "--map", "follow", "relaxed, tracked, trivial")

    def test_visits_are_drawn(self):
        for kind in ("relaxed", "tracked"):
            self.built("--map", kind, "--visits", "--levels", "2")
            info = self.report("imgmesh-info", "p.glb")
            self.assertTrue(info["has_visits"])
            self.assertIs(info["build"]["visits"], True)
            report = self.report("imgmesh-reconstruct", "p.glb", "-o", "v.png", "--mode", "visits")
            self.assertEqual((report["mode"], report["width"], report["height"]), ("visits", 60, 45))
        self.assert_error("imgmesh-reconstruct", ["p.glb", "-o", "w.png", "--mode", "visits", "--level", "1"], 2, "level")
        self.assert_error("imgmesh-reconstruct", ["p.glb", "-o", "w.png", "--mode", "visits", "--scale", "2"], 2, "--scale")
        self.assert_error("imgmesh-reconstruct", ["p.glb", "-o", "w.svg", "--mode", "visits"], 2, "SVG")

    def test_visits_that_are_not_there(self):
        self.built()
        self.assert_error("imgmesh-reconstruct", ["p.glb", "-o", "v.png", "--mode", "visits"], 5, "p.glb", "--visits")


if __name__ == "__main__":
    main()

"""Refinement as a user sees it."""
import picture_files
from support import CliCase, main


class Refine(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "noise.png", picture_files.noise(64, 48, seed=2))

    def built(self, *args):
        image = self.report("imgmesh-build", "noise.png", "-o", "p.glb", "--vertices", "120", *args)["images"][0]
        self.assertEqual(image["flipped_pixel_triangles"], 0)
        self.run_ok("imgmesh-info", "p.glb", "--validate")
        return image

    def test_rounds_lower_the_error(self):
        plain, refined = self.built("--refine", "0"), self.built("--refine", "4", "--shape-weight", "0")
        self.assertEqual(plain["vertices"], refined["vertices"])
        self.assertLess(refined["gouraud_rms"], 0.97 * plain["gouraud_rms"])
        self.assertEqual(self.report("imgmesh-info", "p.glb")["build"]["refine"], 4)

    def test_objective_rgb_lowers_the_error_in_rgb(self):
        def psnr(*args):
            self.built("--refine", "4", *args)
            self.run_ok("imgmesh-reconstruct", "p.glb", "-o", "g.png", "--mode", "gouraud")
            return picture_files.psnr(picture_files.read(self.folder / "g.png"),
                                      picture_files.read(self.folder / "noise.png"))

        luv = psnr("--objective", "luv")
        self.assertGreater(psnr("--objective", "rgb"), luv + 0.1)
        self.assertEqual(self.report("imgmesh-info", "p.glb")["build"]["objective"], "rgb")

    def test_each_level_is_refined(self):
        def levels(*args):
            return self.report("imgmesh-build", "noise.png", "-o", "p.glb", "--faces", "240", "--levels", "3",
                               "--map", "trivial", *args)["images"][0]["levels"]

        # Of noise nothing is left to gain on the coarsest level once shape has a weight too.
        for plain, refined in zip(levels("--refine", "0"), levels("--refine", "3", "--shape-weight", "0")):
            self.assertLess(refined["gouraud_rms"], plain["gouraud_rms"])

    def test_limits_on_faces_hold(self):
        self.built("--refine", "4", "--max-cluster", "60", "--min-quality", "0.4")
        quality = self.report("imgmesh-compare", "p.glb")
        self.assertGreaterEqual(quality["inputs"][0]["mesh"]["shape"]["min"], 0.4)

    def test_presets(self):
        errors, shapes = {}, {}
        for preset in ("fast", "default", "best", "fem"):
            errors[preset] = self.built("--preset", preset)["gouraud_rms"]
            mesh = self.report("imgmesh-compare", "p.glb")["inputs"][0]["mesh"]["shape"]
            shapes[preset] = (mesh["min"], mesh["mean"])
        self.assertEqual(self.built()["gouraud_rms"], errors["default"])
        self.assertLess(errors["best"], errors["default"])
        self.assertLess(errors["default"], errors["fast"])
        self.assertGreaterEqual(shapes["fem"][0], 0.28)
        self.assertGreater(shapes["fem"][1], shapes["best"][1] + 0.05)

    def test_other_options_count_more_than_a_preset_wherever_they_stand(self):
        for args in (["--preset", "best", "--refine", "1"], ["--refine", "1", "--preset", "best"]):
            self.built(*args)
            build = self.report("imgmesh-info", "p.glb")["build"]
            self.assertEqual((build["refine"], build["quadrics"]), (1, "rebuilt"))

    def test_map_smoothness(self):
        def built(*args):
            self.built("--refine", "0", *args)
            return (self.folder / "p.glb").read_bytes()

        self.assertEqual(built("--map-smoothness", "4"), built("--projection-color-weight", "0.25"))
        self.assertNotEqual(built("--map-smoothness", "4"), built())
        self.assert_error("imgmesh-build", ["noise.png", "-o", "q.glb", "--map-smoothness", "4",
                                            "--projection-color-weight", "0.25"], 2, "--map-smoothness")

    def test_rms(self):
        def built(*args, code=0):
            return self.report("imgmesh-build", "noise.png", "-o", "p.glb", *args, code=code)["images"][0]

        image = built("--rms", "30")
        self.assertLessEqual(image["map_rms"], 30)
        self.assertGreater(image["map_rms"], 27)
        self.assertEqual(self.report("imgmesh-info", "p.glb")["build"]["rms"], 30)
        self.assertIn("1e-06", built("--rms", "1e-6", "--strict", code=5)["failure"]["message"])
        self.assert_error("imgmesh-build", ["noise.png", "-o", "q.glb", "--rms", "3", "--levels", "2"], 2, "--rms")

    def test_any_number_of_threads(self):
        picture = self.built("--refine", "2", "--threads", "1")
        one = (self.folder / "p.glb").read_bytes()
        self.assertEqual(self.built("--refine", "2", "--threads", "3")["map_rms"], picture["map_rms"])
        self.assertEqual((self.folder / "p.glb").read_bytes(), one)


if __name__ == "__main__":
    main()

"""Metrics and solvers on the command line: what they change, what the container says, and how long it took."""
import picture_files
from support import CliCase, main


class Metrics(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "in.png", picture_files.ramp(40, 30))

    def parameters(self, *args):
        self.build("in.png", "--vertices", "60", *args)
        return self.report("imgmesh-info", "out.glb")["build"]

    def test_the_container_names_metric_and_solver(self):
        default = self.parameters()
        self.assertEqual((default["metric"], default["solver"]), ("flattened", "closed"))
        self.assertIn("geometry-weight", default)
        for metric in ("flattened", "hoppe", "garland"):
            for solver in ("svd", "lu", "closed"):
                with self.subTest(metric=metric, solver=solver):
                    found = self.parameters("--metric", metric, "--solver", solver)
                    self.assertEqual((found["metric"], found["solver"]), (metric, solver))
                    self.assertEqual("geometry-weight" in found, metric != "hoppe")

    def test_published_metrics_go_by_total_error_and_pixel_gradients(self):
        """Unless told otherwise: what is compared with is what was published."""
        for metric, priority, smoothing in (("flattened", "increment", 1), ("hoppe", "total", 0),
                                            ("garland", "total", 0)):
            found = self.parameters("--metric", metric)
            self.assertEqual((found["priority"], found["smoothing"]), (priority, smoothing))
        found = self.parameters("--metric", "hoppe", "--priority", "increment", "--smoothing", "2")
        self.assertEqual((found["priority"], found["smoothing"]), ("increment", 2))

    def test_colours_of_the_quadrics_are_those_that_are_not_fitted(self):
        picture_files.png(self.folder / "in.png", picture_files.noise(40, 30))
        args = ("--vertices", "60", "--refine", "0", "--projection-color-weight", "0")
        fitted, quadric = (self.build("in.png", *args, "--colors", c) for c in ("fitted", "quadric"))
        self.assertEqual(fitted["vertices"], quadric["vertices"])
        self.assertLess(fitted["gouraud_rms"], 0.99 * quadric["gouraud_rms"])
        for wrong in (("--refine", "1"), ("--objective", "rgb")):
            self.assert_error("imgmesh-build", ["in.png", "-o", "x.glb", "--colors", "quadric", *wrong], 2,
                              "--colors quadric", wrong[0])

    def test_smoothing_is_by_density_or_as_wanted(self):
        self.assertEqual(self.parameters("--smoothing", "3")["smoothing"], 3)
        self.assertEqual(self.parameters("--smoothing", "0")["smoothing"], 0)
        self.assertEqual(self.parameters()["smoothing"], 1)

    def test_stages_add_up_to_less_than_the_whole(self):
        image = self.build("in.png")
        stages = image["stage_seconds"]
        for stage in ("read", "collapse", "map", "write"):
            self.assertGreater(stages[stage], 0)
        self.assertLessEqual(sum(stages.values()), image["seconds"])


if __name__ == "__main__":
    main()

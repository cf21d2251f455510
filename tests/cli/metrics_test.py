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

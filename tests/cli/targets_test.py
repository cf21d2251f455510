"""A wanted number that cannot be reached: a warning, "target_reached" in the report, and with --strict an error."""
import numpy as np

import picture_files
from support import CliCase, main


class Targets(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "in.png", picture_files.noise(10, 10, seed=3))  # 100 vertices, 162 faces

    def missed(self, tool, args, output, *words):
        """A warning and the reason have `words`; the file is there; with --strict neither it nor exit code 0."""
        result = self.run_tool(tool, *args, "-o", output)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stderr.splitlines()
        for line in lines:
            self.assertTrue(line.startswith(f"{tool}: warning: {args[0]}: "), line)
        report = self.report(tool, *args, "-o", output)
        self.assertTrue((self.folder / output).exists())
        own = report["images"][0] if "images" in report else report
        self.assertFalse(own["target_reached"])
        for word in words:
            self.assertIn(word, own["reason"])
            self.assertIn(word, result.stderr)
        self.assertEqual(report["warnings"], [f"{args[0]}: {part}" for part in own["reason"].split("; ")])
        (self.folder / output).unlink()
        before = self.files()
        strict = self.run_tool(tool, *args, "-o", output, "--strict")
        self.assert_error_lines(tool, strict, 5, 1)
        self.assertIn(own["reason"], strict.stderr)
        self.assertEqual(self.files(), before)
        return own

    def reached(self, *args, picture="in.png"):
        """Nothing is told, and --strict changes nothing."""
        result = self.run_ok("imgmesh-build", picture, "-o", "out.glb", *args, "--strict")
        self.assertEqual(result.stderr, "")
        built = self.build(picture, *args)
        self.assertTrue(built["target_reached"])
        self.assertNotIn("reason", built)
        return built

    def test_numbers_of_a_mesh(self):
        for args, words in ((["--faces", "5000"], ["5000 faces were wanted", "has 162"]),
                            (["--vertices", "101"], ["101 vertices were wanted", "has 100"]),
                            (["--rms", "0"], ["RMS error of 0 was wanted"]),
                            (["--levels", "9", "--faces", "100"], ["levels 4 to 8 would be the same as level 3"]),
                            (["--level-errors", "1e8,1e9"], ["level 1 would be the same as level 0"]),
                            (["--min-quality", "0.8", "--faces", "20"], ["20 faces were wanted", "min-quality 0.8"]),
                            (["--faces", "2", "--max-cluster", "9"], ["2 faces were wanted", "max-cluster 9"])):
            with self.subTest(args):
                self.missed("imgmesh-build", ["in.png", *args], "out.glb", *words)
        built = self.missed("imgmesh-build", ["in.png", "--level-faces", "8000,2000,50"], "out.glb",
                            "8000 faces were wanted", "level 1 would be the same as level 0 and is left out")
        self.assertEqual([level["faces"] for level in built["levels"]], [162, 50])

    def test_numbers_that_are_reached(self):
        for args in ([], ["--faces", "162"], ["--faces", "163"], ["--faces", "2"], ["--vertices", "100"],
                     ["--density", "100"], ["--density", "30"], ["--error", "0"], ["--error", "1e9"], ["--rms", "20"],
                     ["--levels", "3", "--faces", "100"], ["--level-faces", "100,30,5"], ["--level-errors", "1,1e4"],
                     ["--preset", "best", "--faces", "60"], ["--map", "tracked", "--faces", "60"],
                     ["--map", "trivial", "--faces", "60"]):
            with self.subTest(args):
                self.reached(*args)

    def test_tiny_images(self):
        for width, height in ((1, 1), (1, 7), (3, 3)):
            picture_files.png(self.folder / "tiny.png", picture_files.noise(width, height))
            self.reached(picture="tiny.png")
            self.reached("--faces", "2", picture="tiny.png")
            built = self.missed("imgmesh-build", ["tiny.png", "--faces", "100", "--levels", "3"], "tiny.glb", "100 faces")
            self.assertLessEqual(len(built["levels"]), 3)
            self.run_ok("imgmesh-build", "tiny.png", "-o", "tiny.glb", "-q")
            self.run_ok("imgmesh-info", "tiny.glb", "--validate")

    def test_masks(self):
        """Nine islands, each of which keeps a face. The default density is nothing that was asked for."""
        y, x = np.mgrid[0:12, 0:12]
        inside = ((x % 4 < 2) & (y % 4 < 2)).astype(float)[..., None]
        picture_files.png(self.folder / "masked.png", np.concatenate([picture_files.noise(12, 12), inside], axis=-1))
        self.reached(picture="masked.png")
        self.missed("imgmesh-build", ["masked.png", "--faces", "2"], "out.glb", "the mask's outline")
        self.missed("imgmesh-build", ["masked.png", "--density", "1"], "out.glb", "vertices were wanted")
        self.build("masked.png", output="c.glb")
        self.missed("imgmesh-segment", ["c.glb", "--segments", "2"], "l.png", "--segments: 2 regions", "9 are the fewest")

    def test_in_a_batch(self):
        """One image misses: the others are built, strictly or not."""
        picture_files.png(self.folder / "big.png", picture_files.noise(40, 30))
        report = self.report("imgmesh-build", "in.png", "big.png", "-o", "out/", "--faces", "500")
        self.assertEqual([image["target_reached"] for image in report["images"]], [False, True])
        report = self.report("imgmesh-build", "in.png", "big.png", "-o", "strict/", "--faces", "500", "--strict", code=5)
        self.assertEqual(report["images"][0]["failure"]["code"], 5)
        self.assertEqual([path.name for path in (self.folder / "strict").glob("*.glb")], ["big.glb"])

    def test_numbers_of_regions(self):
        self.build("in.png", "--faces", "40", output="c.glb")
        for option in ("--segments", "--superpixels"):
            report = self.missed("imgmesh-segment", ["c.glb", option, "9999"], "l.png", f"{option}: 9999 regions")
            self.assertEqual(report["regions"], report["cells"])
            report = self.report("imgmesh-segment", "c.glb", option, "5", "-o", "l.png", "--strict")
            self.assertEqual((report["regions"], report["target_reached"]), (5, True))

    def test_strictness_is_an_option_of_files_too(self):
        (self.folder / "c.toml").write_text("[build]\nstrict = true\nfaces = 5000\n")
        self.assert_error("imgmesh-build", ["in.png", "-o", "x.glb", "--config", "c.toml"], 5, "5000 faces")


if __name__ == "__main__":
    main()

"""--config FILE: options from a TOML file, read as strictly as the command line."""
import re

import picture_files
from support import ROOT, CliCase, main


class Config(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "in.png", picture_files.ramp(24, 16))

    def config(self, text):
        (self.folder / "c.toml").write_bytes(text.encode())

    def refused(self, text, *words):
        self.config(text)
        self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", "--config", "c.toml"], 2, *words)

    def test_gives_options(self):
        self.config('# a comment\n\nfaces = 40  # a few\r\ndraco = "none"\n\tbary=\'float\'\noutput = "a #1.glb"\n')
        self.report("imgmesh-build", "in.png", "--config", "c.toml")
        facts = self.report("imgmesh-info", "a #1.glb")
        self.assertEqual((facts["draco"], facts["levels"][0]["map"]["precision"]), ("none", "float"))
        self.assertLessEqual(facts["levels"][0]["faces"], 40)

    def test_wrong_values_have_their_lines(self):
        self.refused('\npreset = "bst"\n', "c.toml:2: --preset 'bst': expected")
        self.refused('[build]\nfaces = 0\n', "c.toml:2: --faces '0': expected")
        self.refused("preset = best\n", "c.toml:1: ", "text needs quotes")
        self.config('preset = "bst"\n')
        result = self.assert_error("imgmesh-build", ["in.png", "-o", "o.glb", "--config", "c.toml", "--preset", "bad"], 2, "bad")
        self.assertNotIn("c.toml", result.stderr)
        self.assert_error("imgmesh-build", ["in.png", "-o", "o.glb", "--config", ""], 2, "--config", "expected a file")

    def test_command_line_counts_more(self):
        self.config('draco = "none"\n')
        self.build("in.png", "--config", "c.toml", "--draco", "sequential")
        self.assertEqual(self.report("imgmesh-info", "out.glb")["draco"], "sequential")

    def test_lists_and_numbers_of_toml(self):
        """As arrays or as on the command line; numbers in any form that TOML has."""
        for text in ("level-faces = [80, 2_0]", "level-faces = '80,20'", "level-faces = [0x50, '20']"):
            self.config(text + "\ngeometry-weight = 5e-1\nsmoothing = 0b1\n")
            self.build("in.png", "--config", "c.toml")
            built = self.report("imgmesh-info", "out.glb")["build"]
            self.assertEqual((built["level-faces"], built["geometry-weight"], built["smoothing"]), ("80,20", 0.5, 1))

    def test_other_options_count_more_than_the_preset(self):
        """In whatever order the file has them, and for a preset of the command line too."""
        for text in ('density = 5\npreset = "best"\n', 'preset = "best"\ndensity = 5\n'):
            self.config(text)
            self.build("in.png", "--config", "c.toml")
            built = self.report("imgmesh-info", "out.glb")["build"]
            self.assertEqual((built["density"], built["refine"]), (5, 7))
        self.config("refine = 2\n")
        self.build("in.png", "--config", "c.toml", "--preset", "fast")
        built = self.report("imgmesh-info", "out.glb")["build"]
        self.assertEqual((built["refine"], built["geometry-weight"]), (2, 1))

    def test_flags(self):
        self.config("quiet = true\noverwrite = false\n")
        self.assertEqual(self.run_ok("imgmesh-build", "in.png", "-o", "out.glb", "--config", "c.toml").stdout, "")
        self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", "--config", "c.toml"], 3, "out.glb")
        self.config("no-overwrite = true\n")
        self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", "--config", "c.toml"], 3, "out.glb")

    def test_command_line_drops_what_it_excludes(self):
        self.config("[build]\nfaces = 40\n")
        self.build("in.png", "--config", "c.toml", "--density", "20")
        self.assertEqual(self.report("imgmesh-info", "out.glb")["build"]["density"], 20)
        # The file alone contradicts itself, in one table.
        self.refused("faces = 40\ndensity = 3\n", "--density", "--faces")
        self.refused("[build]\nfaces = 40\ndensity = 3\n", "--density", "--faces")

    def test_tables_are_of_one_tool(self):
        """The own table counts more than what stands above, also against what it excludes; others are not looked at."""
        self.config('threads = 2\nfaces = 40\nbary = "half"\n[info]\njson = true\n[build]\ndensity = 20\n'
                    'bary = "float"\n[warp]\nany = 1\n')
        self.build("in.png", "--config", "c.toml")
        facts = self.report("imgmesh-info", "out.glb")
        self.assertEqual((facts["build"]["density"], facts["levels"][0]["map"]["precision"]), (20, "float"))
        self.config("threads = 2\n[info]\njson = true\n[build]\ndensity = 20\n")
        self.assertIn('"levels"', self.run_ok("imgmesh-info", "out.glb", "--config", "c.toml").stdout)
        self.config("build.density = 20\n")  # the same table, in one line
        self.build("in.png", "--config", "c.toml")
        self.assertEqual(self.report("imgmesh-info", "out.glb")["build"]["density"], 20)

    def test_wrong_tables(self):
        self.refused("faces = 40\n[biuld]\n", "c.toml:2", "'biuld'", "did you mean build?")
        self.refused("[build]\nfacse = 3\n", "c.toml:2", "'facse'", "did you mean faces?")
        self.refused("[[build]]\nfaces = 3\n", "c.toml:1", "[build]")
        self.refused("build = 3\n", "c.toml:1", "[build]")
        self.refused("[build.more]\nfaces = 3\n", "c.toml:1", "'more'")
        self.refused("[build]\nhelp = true\n", "c.toml:2", "'help'")
        self.refused("segments = 3\n", "c.toml:1", "'segments'", "[build]")  # of another tool
        self.refused("[build]\nfaces = 3\n[build]\n", "c.toml:3")

    def test_the_guides_example(self):
        """It serves every tool for which it has a table."""
        text = (ROOT / "docs" / "guide.md").read_text()
        self.config(re.search("```toml\n(.*?)```", text, re.S)[1])
        runs = {"build": ["in.png", "-o", "out.glb"], "reconstruct": ["out.glb", "-o", "flat.png"],
                "warp": ["out.glb", "--image", "in.png", "-o", "warped.png"], "segment": ["out.glb", "-o", "labels.png"]}
        self.assertEqual(set(re.findall(r"^\[(\w+)\]", (self.folder / "c.toml").read_text(), re.M)), set(runs))
        for tool, args in runs.items():
            # The image of this test is small: levels of four thousand faces are not there, nor 40 segments.
            less = {"build": ["--level-faces", "300,80"], "segment": ["--segments", "4"]}.get(tool, [])
            self.report(f"imgmesh-{tool}", *args, "--config", "c.toml", *less)
        built = self.report("imgmesh-info", "out.glb")
        self.assertEqual((built["build"]["refine"], len(built["levels"])), (7, 2))
        self.assertEqual(picture_files.read(self.folder / "flat.png").shape[:2], (32, 48))

    def test_unknown_keys(self):
        self.refused("faces = 40\nfases = 3\n", "c.toml:2", "fases")
        self.refused("z=1\n", "c.toml:1", "'z'")  # so short that CLI11's own reader skips it
        for key in ("help", "version", "config", "o", "IMAGE", "--faces", "-o"):
            self.refused(f"{key} = 1\n", "c.toml:1", key)

    def test_wrong_values(self):
        self.refused('faces = "many"\n', "--faces", "'many'", "expected")
        self.refused("faces = 1e3\n", "--faces", "'1000.0'")  # no whole number to TOML either
        self.refused("faces = true\n", "--faces", "'true'")
        self.refused("density = nan\n", "c.toml:1", "density")
        self.refused("json = 1\n", "c.toml:1", "true or false")
        self.refused("faces = 2026-01-01\n", "c.toml:1", "faces")
        self.refused("faces = [1, 2]\n", "c.toml:1", "faces", "list")
        self.refused("level-faces = [[8], 4]\n", "c.toml:1", "level-faces")
        self.refused("level-faces = ['', 8]\n", "c.toml:1", "level-faces")
        self.refused("channels = ['R,G', 'B']\n", "c.toml:1", "channels")
        self.refused('output = "q\\u0000.glb"\n', "c.toml:1", "output", "control")
        self.refused(".".join(["a"] * 40000) + " = 1\n", "c.toml:1", "dots")

    def test_what_is_no_option_and_value(self):
        for line in ("faces", "faces 40", "= 40", "faces =", "[x]", "[[x]]", "a.b = 1", "faces = 40 50",
                     'draco = "none', "faces = 40, 50", "draco = none", "\0", "\x1b[2J = 1"):
            self.refused(f"# first\n{line}\n", "c.toml:2")

    def test_too_long(self):
        self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", "--config", "/dev/zero"], 2, "/dev/zero", "1048576")
        longest = 1 << 20
        text = "faces = 40\n#"
        self.config(text + "x" * (longest - len(text)))
        self.run_ok("imgmesh-build", "in.png", "-o", "out.glb", "-q", "--config", "c.toml")
        (self.folder / "out.glb").unlink()
        self.refused(text + "x" * (longest + 1 - len(text)), "c.toml", "1048576")

    def test_given_twice(self):
        self.refused('faces = 40\ndraco = "none"\nfaces = 50\n', "c.toml:3", "'faces'")

    def test_unreadable(self):
        args = ["in.png", "-o", "out.glb", "--config"]
        self.assert_error("imgmesh-build", [*args, "missing.toml"], 3, "missing.toml")
        (self.folder / "folder.toml").mkdir()
        self.assert_error("imgmesh-build", [*args, "folder.toml"], 3, "folder.toml")


if __name__ == "__main__":
    main()

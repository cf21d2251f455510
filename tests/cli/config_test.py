"""--config FILE: options from a TOML file, read as strictly as the command line."""
import picture_files
from support import CliCase, main


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

    def test_command_line_counts_more(self):
        self.config('draco = "none"\n')
        self.build("in.png", "--config", "c.toml", "--draco", "sequential")
        self.assertEqual(self.report("imgmesh-info", "out.glb")["draco"], "sequential")

    def test_flags(self):
        self.config("quiet = true\noverwrite = false\n")
        self.assertEqual(self.run_ok("imgmesh-build", "in.png", "-o", "out.glb", "--config", "c.toml").stdout, "")
        self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", "--config", "c.toml"], 3, "out.glb")
        self.config("no-overwrite = true\n")
        self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", "--config", "c.toml"], 3, "out.glb")

    def test_unknown_keys(self):
        self.refused("faces = 40\nfases = 3\n", "c.toml:2", "fases")
        self.refused("z=\n", "c.toml:1", "'z'")  # so short that CLI11's own reader skips it
        for key in ("help", "version", "config", "o", "IMAGE", "--faces", "-o"):
            self.refused(f"{key} = 1\n", "c.toml:1", key)

    def test_wrong_values(self):
        self.refused('faces = "many"\n', "--faces", "'many'", "expected")
        self.refused("faces = 1e3\n", "--faces", "'1e3'")
        self.refused("faces = true\n", "--faces", "'true'")
        self.refused("density = nan\n", "c.toml:1", "density")
        self.refused("json = 1\n", "c.toml:1", "true or false")

    def test_what_is_no_option_and_value(self):
        for line in ("faces", "faces 40", "= 40", "faces =", "[build]", "[[x]]", "faces = [1, 2]", "faces = 40 50",
                     'draco = "none', 'draco = "no\\ne"', "faces = 40, 50", "draco = none", "\0", "\x1b[2J = 1"):
            self.refused(f"# first\n{line}\n", "c.toml:2")

    def test_given_twice(self):
        self.refused('faces = 40\ndraco = "none"\nfaces = 50\n', "c.toml:3", "faces", "twice")

    def test_unreadable(self):
        args = ["in.png", "-o", "out.glb", "--config"]
        self.assert_error("imgmesh-build", [*args, "missing.toml"], 3, "missing.toml")
        (self.folder / "folder.toml").mkdir()
        self.assert_error("imgmesh-build", [*args, "folder.toml"], 3, "folder.toml")


if __name__ == "__main__":
    main()

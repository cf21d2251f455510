"""Help, version, and every way to use the tools wrongly: exit code 2 and one line that says how."""
import re

import picture_files
from support import ROOT, TOOLS, CliCase, main

PROJECT = re.search(r"project\(imgmesh VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())


def described(text):
    """The options of a help, by their long names, with what it says of each."""
    options, name = {}, None
    for line in text[:text.index("Exit codes:")].splitlines():
        head = re.match(r"  (-\S+)(?: +(.*))?$", line)
        if head:
            name = head[1].split(",")[-1]
            options[name] = head[2] or ""
        elif line.startswith("    ") and name:
            options[name] += " " + line.strip()
        else:
            name = None
    return options


class Usage(CliCase):
    def test_help_ends_with_exit_codes(self):
        for tool in TOOLS:
            for size in ("--help", "--help-all"):
                text = self.run_ok(tool, size).stdout
                for option in ("--json", "--quiet", "--threads", "--config", "--no-overwrite", "--version"):
                    self.assertIn(option, text)
                codes = re.findall(r"^  (\d)  \w", text[text.index("Exit codes:"):], re.M)
                self.assertEqual(list(map(int, codes)), [0, 1, 2, 3, 4, 5, 7])

    def test_help_has_two_sizes(self):
        """The short one fits a screen, and says that there is another; that one has every option that is taken."""
        for tool in TOOLS:
            short, full = (self.run_ok(tool, size).stdout for size in ("--help", "--help-all"))
            self.assertIn("--help-all", short.splitlines()[-1])
            self.assertLessEqual(described(short).items(), described(full).items())
            self.assertLessEqual(len(described(short)), 26)
            for line in (short + full).splitlines():
                self.assertLessEqual(len(line), 100, line)
            for name, text in described(full).items():
                self.assertLessEqual(text.count("(default"), 1, name)
        full = self.run_ok("imgmesh-build", "--help-all").stdout
        for heading in ("Image", "Size", "Levels", "Simplification", "Refinement", "Pixel map", "Container", "General"):
            self.assertEqual(len(re.findall(f"^{heading}:$", full, re.M)), 1, heading)

    def test_help_of_an_option(self):
        """Its words, its default and what it is not given with, each in one way."""
        options = described(self.run_ok("imgmesh-build", "--help-all").stdout)
        for name, end in (("--objective", ": luv, rgb (default luv)"), ("--geometry-weight", " (default 0.3)"),
                          ("--texture-type", ": png, jpeg (default png); needs --texture"),
                          ("--map-smoothness", " (default 20, for a tracked map 10); not with --projection-color-weight"),
                          ("--density", " (default 1); not with --error, --faces, --level-errors, --level-faces, --rms,"
                                        " --vertices")):
            self.assertTrue(options[name].endswith(end), options[name])
        for name in ("--shape-weight", "--metric", "--bary", "--max-pixels"):
            self.assertNotIn(name, self.run_ok("imgmesh-build", "--help").stdout)

    def test_version_is_the_projects(self):
        for tool in TOOLS:
            self.assertEqual(self.run_ok(tool, "--version").stdout, f"{tool} {PROJECT.group(1)}\n")

    def test_no_arguments(self):
        for tool in TOOLS:
            self.assert_error(tool, [], 2, "required")

    def test_unknown_option(self):
        for tool in TOOLS:
            self.assert_error(tool, ["--frobnicate", "in", "-o", "out.glb"], 2, "--frobnicate")

    def test_mistyped_words(self):
        """The option or the word that was probably meant; a far one is not guessed. The mistake counts more than what
        is missing because of it."""
        for tool, args, meant in (
                ("imgmesh-build", ["in.png", "--ouput", "out.glb"], "--output"),
                ("imgmesh-build", ["in.png", "-o", "out.glb", "--face", "40"], "--faces"),
                ("imgmesh-build", ["in.png", "-o", "out.glb", "--level_faces=40"], "--level-faces"),
                ("imgmesh-build", ["in.png", "-o", "out.glb", "--colour-weight", "2"], "--color-weight"),
                ("imgmesh-build", ["in.png", "-o", "out.glb", "-faces", "2"], "--faces"),
                ("imgmesh-info", ["in.glb", "--validte"], "--validate"),
                ("imgmesh-warp", ["in.glb", "--pin-boarder"], "--pin-border"),
                ("imgmesh-reconstruct", ["in.glb", "-o", "o.png", "--mode", "wier"], "wire"),
                ("imgmesh-build", ["in.png", "-o", "out.glb", "--preset", "bets"], "best")):
            self.assert_error(tool, args, 2, f"; did you mean {meant}?")
        for tool, args in (("imgmesh-build", ["in.png", "-o", "out.glb", "--frobnicate"]),
                           ("imgmesh-build", ["in.png", "-o", "out.glb", "--" + "faces" * 2000]),
                           ("imgmesh-reconstruct", ["in.glb", "-o", "o.png", "--mode", "x"])):
            self.assertNotIn("mean", self.assert_error(tool, args, 2).stderr)

    def test_long_words_are_cut(self):
        long = "é" * 5000
        for args in (["--faces", long], ["--preset", long], ["--channels", long + ":x"], ["--" + long]):
            error = self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", *args], 2, "...").stderr
            self.assertLess(len(error), 300)
        # A name keeps its end, and the reason.
        self.assert_error("imgmesh-info", ["a/" * 1000 + "x.glb"], 3, "...", "x.glb: cannot read")

    def test_files_of_another_kind(self):
        """An image where a container is due, the other way round, and folders: called what they are."""
        picture_files.png(self.folder / "in.png", picture_files.ramp(9, 7))
        self.build("in.png", output="c.glb")
        self.build("in.png", output="c.gltf")
        (self.folder / "folder").mkdir()
        tools = {"imgmesh-info": [], "imgmesh-reconstruct": ["-o", "o.png"], "imgmesh-convert": ["-o", "o.glb"],
                 "imgmesh-segment": ["-o", "o.png"], "imgmesh-compare": ["in.png"]}
        for tool, args in tools.items():
            if tool != "imgmesh-compare":  # which takes images too
                self.assert_error(tool, ["in.png", *args], 4, "in.png: is a PNG image, not a container", "imgmesh-build")
            self.assert_error(tool, ["folder", *args], 3, "folder: cannot read: it is a folder")
        warp = ["--image", "in.png", "-o", "o.png"]
        self.assert_error("imgmesh-warp", ["in.png", *warp], 4, "in.png: is a PNG image, not a container")
        for name in ("c.glb", "c.gltf"):
            self.assert_error("imgmesh-build", [name, "-o", "o.glb"], 5, f"{name}: a glTF file, not an image",
                              "imgmesh-reconstruct")
        self.assert_error("imgmesh-warp", ["c.glb", *warp, "--edits", "in.png"], 4, "in.png: no JSON but an image (PNG)")
        self.assert_error("imgmesh-warp", ["c.glb", *warp, "--edits", "c.glb"], 4, "c.glb: no JSON but a container")
        self.assert_error("imgmesh-build", ["folder", "-o", "o.glb"], 3, "folder: cannot read: it is a folder")
        self.assert_error("imgmesh-build", ["in.png", "-o", "o.glb", "--config", "folder"], 3, "folder")
        # The validator lists it as any other finding.
        self.assertIn("is a PNG image", self.run_tool("imgmesh-info", "in.png", "--validate").stdout)

    def test_output_is_required(self):
        self.assert_error("imgmesh-build", ["in.png"], 2, "--output")
        self.assert_error("imgmesh-build", ["in.png", "x.glb"], 2, "-o FILE (--output) is required; did you mean -o x.glb?")
        picture_files.png(self.folder / "second.png", picture_files.ramp(4, 4))
        result = self.assert_error("imgmesh-build", ["in.png", "second.png"], 2, "-o FILE")
        self.assertNotIn("mean", result.stderr)
        self.assert_error("imgmesh-build", ["in.png", "-o", "o.glb", "--mask", "-"], 2, "--mask -: only IMAGE can be standard input")
        self.assert_error("imgmesh-reconstruct", ["in.glb"], 2, "--output")
        self.assert_error("imgmesh-build", ["in.png", "-o"], 2, "--output")
        self.assert_error("imgmesh-build", ["in.png", "-o", ""], 2, "--output")

    def test_several_inputs_need_a_folder(self):
        for tool, name in (("imgmesh-reconstruct", "out.png"), ("imgmesh-segment", "out.png"),
                           ("imgmesh-warp", "out.glb"), ("imgmesh-convert", "out.glb")):
            self.assert_error(tool, ["a.glb", "b.glb", "-o", name], 2, name, "2 files need a folder")
        self.assert_error("imgmesh-segment", ["a.glb", "b.glb", "-o", "out/", "--ucm", "x.exr"], 2, "--ucm x.exr",
                          "2 files need a folder")
        self.assert_error("imgmesh-segment", ["a.glb", "b.glb", "-o", "out/", "--flat", "out/"], 2, "out/a.png",
                          "two outputs")
        self.assert_error("imgmesh-compare", ["a.png", "b.png", "c.png", "--plot", "x.svg"], 2, "--plot x.svg", "folder")
        self.assertEqual(self.files(), {}, "a folder was made")

    def test_format(self):
        self.assert_error("imgmesh-reconstruct", ["a.glb", "-o", "out.png", "--format", "exr"], 2, "--format exr", "out.png")
        self.assert_error("imgmesh-reconstruct", ["a.glb", "-o", "out/", "--format", "docx"], 2, "out/a.docx")
        self.assert_error("imgmesh-reconstruct", ["a.glb", "-o", "out/", "--format", "../x"], 2, "--format '../x'")

    def test_numbers_are_read_strictly(self):
        """What is refused of every number stands in unit/tool_text_test.cpp; here, that each option does."""
        picture_files.png(self.folder / "in.png", picture_files.ramp(9, 7))
        wrong = {
            "--faces": ["1e3", "-5", "1", "", "--json"],
            "--vertices": ["3"],
            "--density": ["nan", "0", "100.1"],
            "--error": ["-1"],
            "--rms": ["-1", "nan"],
            "--geometry-weight": ["0"],
            "--color-weight": ["0"],
            "--smoothing": ["-1", "65", "1.5"],
            "--projection-color-weight": ["-1e-9"],
            "--refine": ["-1", "1001", "1.5", "all"],
            "--shape-weight": ["-1", "nan"],
            "--exchange": ["1.5", "-0.1"],
            "--map-smoothness": ["0", "-1", "1e13", "inf"],
            "--map-rounds": ["0", "1001", "1.5"],
            "--map-rate": ["-1", "nan", "1e31"],
            "--threads": ["0", "1025", "all"],
        }
        for option, values in wrong.items():
            for value in values:
                self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", option, value], 2, option,
                                  f"'{value}'", "expected")
        for option, values in {"--level": ["-1", "4294967296"], "--scale": ["0", "nan"]}.items():
            for value in values:
                self.assert_error("imgmesh-reconstruct", ["in.glb", "-o", "out.png", option, value], 2, option,
                                  f"'{value}'", "expected")

    def test_names_are_those_listed(self):
        for option, value, listed in (("--bary", "double", "half, float"),
                                      ("--objective", "lab", "luv, rgb"),
                                      ("--preset", "good", "fast, default, best, max, small, fem"),
                                      ("--draco", "zip", "edgebreaker, sequential, none"),
                                      ("--metric", "qem", "flattened, hoppe, garland"),
                                      ("--solver", "qr", "svd, lu, closed"),
                                      ("--colors", "raw", "fitted, quadric"),
                                      ("--color-space", "CMYK", "sRGB, linear"), ("--alpha", "half", "cut, ignore")):
            self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", option, value], 2, option, value, listed)
        self.assert_error("imgmesh-reconstruct", ["in.glb", "-o", "o.png", "--mode", "depth"], 2, "--mode", "wire")
        self.assert_error("imgmesh-reconstruct", ["in.glb", "-o", "o.png", "--depth", "12"], 2, "--depth", "16")

    def test_an_option_is_given_once(self):
        self.assert_error("imgmesh-build", ["in.png", "-o", "a.glb", "-o", "b.glb"], 2, "--output")
        self.assert_error("imgmesh-build", ["in.png", "-o", "a.glb", "--faces", "4", "--faces", "8"], 2, "--faces")

    def test_density_is_not_mixed_with_other_limits(self):
        for option in ("--faces", "--vertices", "--error"):
            self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", "--density", "5", option, "10"], 2,
                              "--density", option)

    def test_contradictions_are_told_as_typed(self):
        """Before any work: the image is not there."""
        for words in (("--metric hoppe", "--geometry-weight 2"), ("--map tracked", "--refine 3"),
                      ("--map tracked", "--preset best"), ("--map relaxed", "--projection-color-weight 0"),
                      ("--map trivial", "--map-smoothness 3"), ("--rms 3", "--map tracked"), ("--rms 3", "--visits"),
                      ("--colors quadric", "--refine 2"), ("--colors quadric", "--preset fem"),
                      ("--colors quadric", "--objective rgb"), ("--geometry-weight 1e8", "--color-weight 1e-8")):
            args = [word for pair in words for word in pair.split()]
            shown = words[:1] if "--color-weight 1e-8" in words else words
            self.assert_error("imgmesh-build", ["none.png", "-o", "out.glb", *args], 2,
                              *(w.removesuffix(" 2") if "--geometry" in w else w for w in shown))
        self.assert_error("imgmesh-build", ["none.png", "-o", "out.glb", "--preset", "best", "--map", "tracked"], 2,
                          "--refine 0")
        for words in ("--level-faces 8,9", "--level-errors 9,8"):
            self.assert_error("imgmesh-build", ["none.png", "-o", "out.glb", *words.split()], 2, words)
        (self.folder / "c.toml").write_text('map = "tracked"\nrefine = 2\n')
        self.assert_error("imgmesh-build", ["none.png", "-o", "out.glb", "--config", "c.toml"], 2, "--map tracked",
                          "--refine 2")
        # What only seems to contradict goes on, to the image that is not there.
        for words in ("--preset best --map tracked --refine 0", "--preset fem --colors quadric --refine 0 --objective luv",
                      "--map trivial --projection-color-weight 0", "--level-errors 8,9"):
            self.assert_error("imgmesh-build", ["none.png", "-o", "out.glb", *words.split()], 3, "none.png")

    def test_what_a_picture_or_container_cannot_have(self):
        self.assert_error("imgmesh-warp", ["in.glb", "--image", "in.png", "-o", "o.png", "--retarget", "60000x60000"], 2,
                          "--retarget", "60000x60000", "pixels")
        self.assert_error("imgmesh-reconstruct", ["in.glb", "-o", "o.png", "--mode", "visits", "--level", "1"], 2,
                          "--level 1", "visits")

    def test_output_names(self):
        self.assert_error("imgmesh-build", ["in.png", "-o", "out.png"], 2, "out.png", ".glb")
        self.assert_error("imgmesh-build", ["in.png", "-o", "out"], 2, "out", ".gltf")
        self.assert_error("imgmesh-build", ["a.png", "b.png", "-o", "out.glb"], 2, "out.glb", "folder")
        self.assert_error("imgmesh-reconstruct", ["in.glb", "-o", "out.docx"], 2, "out.docx")
        self.assert_error("imgmesh-reconstruct", ["in.glb", "-o", "out"], 2, "out")

    def test_output_of_another_tool(self):
        for tool, args, meant in (("imgmesh-build", ["in.png", "-o", "x.obj"], "imgmesh-convert writes .obj from a container"),
                                  ("imgmesh-build", ["in.png", "-o", "x.jpg"], "imgmesh-reconstruct writes .jpg from a container"),
                                  ("imgmesh-reconstruct", ["in.glb", "-o", "x.ply"], "imgmesh-convert writes .ply"),
                                  ("imgmesh-reconstruct", ["in.glb", "-o", "x.gltf"], "imgmesh-convert writes .gltf"),
                                  ("imgmesh-convert", ["in.glb", "-o", "x.jpg"], "imgmesh-reconstruct writes .jpg")):
            self.assert_error(tool, args, 2, meant)
        self.assertNotIn("writes", self.assert_error("imgmesh-build", ["in.png", "-o", "x.docx"], 2).stderr)

    def test_two_pictures_of_one_name(self):
        """Refused before any work: the images are not there, and the folder is not made."""
        self.assert_error("imgmesh-build", ["a/x.png", "b/y.png", "c/x.jpg", "-o", "out/"], 2, "a/x.png", "c/x.jpg")
        self.assertFalse((self.folder / "out").exists())

    def test_modes_and_what_they_can(self):
        for mode in ("map", "patches"):
            self.assert_error("imgmesh-reconstruct", ["in.glb", "-o", "o.png", "--mode", mode, "--scale", "2"], 2,
                              "--scale", mode)
        for mode in ("map", "gouraud", "patches"):
            self.assert_error("imgmesh-reconstruct", ["in.glb", "-o", "o.svg", "--mode", mode], 2, "SVG", mode)
        for option in (["--depth", "8"], ["--scale", "2"]):
            self.assert_error("imgmesh-reconstruct", ["in.glb", "-o", "o.svg", "--mode", "wire", *option], 2, "SVG")


if __name__ == "__main__":
    main()

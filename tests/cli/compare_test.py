"""imgmesh-compare: figures against numpy, which shares no code; tolerance, images of errors, plots."""
import json
import xml.etree.ElementTree

import numpy as np

import picture_files
from support import CliCase, main

TOOL = "imgmesh-compare"
SVG = "{http://www.w3.org/2000/svg}"


def luv_of(srgb):
    """CIE 1976 L*u*v* under D65, height x width x 3, with the rounded matrix that is printed everywhere."""
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    x, y, z = np.moveaxis(linear @ np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722],
                                             [0.0193, 0.1192, 0.9505]]).T, -1, 0)
    lightness = np.where(y > 216 / 24389, 116 * np.cbrt(y) - 16, 24389 / 27 * y)
    total = np.maximum(x + 15 * y + 3 * z, 1e-12)
    return np.stack([lightness, 13 * lightness * (4 * x / total - 0.19784),
                     13 * lightness * (9 * y / total - 0.46834)], axis=-1)


def ssim_of(a, b):
    """Wang et al. 2004, window by window."""
    x = np.arange(11) - 5
    weights = np.exp(-(x[:, None] ** 2 + x ** 2) / (2 * 1.5 ** 2))
    weights /= weights.sum()
    p, q = (np.lib.stride_tricks.sliding_window_view(i, (11, 11)) for i in (a, b))
    mean = lambda v: (v * weights).sum(axis=(2, 3))
    mp, mq = mean(p), mean(q)
    vp, vq, cov = mean(p * p) - mp ** 2, mean(q * q) - mq ** 2, mean(p * q) - mp * mq
    return np.mean((2 * mp * mq + 1e-4) * (2 * cov + 9e-4) / ((mp ** 2 + mq ** 2 + 1e-4) * (vp + vq + 9e-4)))


class Compare(CliCase):
    def setUp(self):
        super().setUp()
        self.a = picture_files.read(picture_files.png(self.folder / "a.png", picture_files.ramp(48, 32)))
        self.b = picture_files.read(picture_files.png(
            self.folder / "b.png", np.clip(picture_files.ramp(48, 32) + 0.2 * picture_files.noise(48, 32) - 0.1, 0, 1)))

    def compare(self, *args, code=0):
        return self.report(TOOL, *args, code=code)["difference"]

    def build_both(self):
        self.build("a.png", "--faces", "200", output="a.glb")
        self.build("a.png", "--faces", "40", output="b.gltf")

    def test_two_pictures_against_numpy(self):
        found = self.compare("a.png", "b.png")
        error = self.a - self.b
        self.assertEqual((found["pixels"], found["in_one_only"], found["color_space"]), (48 * 32, 0, "sRGB"))
        self.assertAlmostEqual(found["rms_rgb"], np.sqrt(np.mean(error ** 2)), places=6)
        self.assertAlmostEqual(found["max_rgb"], np.abs(error).max(), places=6)
        self.assertAlmostEqual(found["psnr"], picture_files.psnr(self.a, self.b), places=4)
        luv = np.linalg.norm(luv_of(self.a) - luv_of(self.b), axis=-1)
        self.assertAlmostEqual(found["rms_luv"], np.sqrt(np.mean(luv ** 2)), delta=0.01)
        self.assertAlmostEqual(found["max_luv"], luv.max(), delta=0.05)
        for key, percent in (("p5", 5), ("p25", 25), ("median", 50), ("p75", 75), ("p95", 95)):
            self.assertAlmostEqual(found["luv"][key], np.percentile(luv, percent), delta=0.05)
        counts, _ = np.histogram(luv, bins=20, range=(0, 20))
        self.assertLessEqual(np.abs(counts - found["luv"]["histogram"]["counts"]).sum(), 10)  # rounded matrix
        luma = np.array([0.299, 0.587, 0.114])
        self.assertAlmostEqual(found["ssim"], ssim_of(self.a @ luma, self.b @ luma), places=5)
        self.assertLessEqual(found["ciede2000"]["p95"], found["ciede2000"]["max"])

    def test_equal_pictures(self):
        found = self.compare("a.png", "a.png", "--tolerance", "0")
        self.assertEqual((found["rms_luv"], found["max_rgb"], found["ciede2000"]["max"]), (0, 0, 0))
        self.assertIsNone(found["psnr"])
        self.assertAlmostEqual(found["ssim"], 1)
        self.assertIn("equal", self.run_ok(TOOL, "a.png", "a.png").stdout)

    def test_tiny_pictures_have_no_ssim(self):
        picture_files.png(self.folder / "one.png", picture_files.noise(1, 1))
        self.assertIsNone(self.compare("one.png", "one.png")["ssim"])
        self.assertIn("no window", self.run_ok(TOOL, "one.png", "one.png").stdout)

    def test_tolerance(self):
        rms = self.compare("a.png", "b.png")["rms_luv"]
        report = self.report(TOOL, "a.png", "b.png", "--tolerance", rms + 0.001)
        self.assertTrue(report["within_tolerance"])
        result = self.run_tool(TOOL, "a.png", "b.png", "--tolerance", rms - 0.001)
        self.assert_error_lines(TOOL, result, 7, 1)
        for words in ("a.png", "b.png", "RMS", "--tolerance"):
            self.assertIn(words, result.stderr)
        self.assertIn("PSNR", result.stdout)
        report = self.report(TOOL, "a.png", "b.png", "--tolerance", rms - 0.001, "--plot", "p.svg", code=7)
        self.assertFalse(report["within_tolerance"])
        self.assertTrue((self.folder / "p.svg").exists(), "outputs are for looking at what differs")

    def test_sizes_that_differ(self):
        picture_files.png(self.folder / "c.png", picture_files.ramp(32, 48))
        self.assert_error(TOOL, ["a.png", "c.png", "--error-image", "e.png"], 4, "a.png", "48 x 32", "c.png", "32 x 48")
        self.build_both()
        self.assert_error(TOOL, ["a.glb", "c.png"], 4, "a.glb", "48 x 32", "c.png", "32 x 48")

    def test_container_is_drawn_through_its_map(self):
        built = self.build("a.png", "--faces", "60", output="a.glb")
        found = self.compare("a.png", "a.glb")
        self.assertAlmostEqual(found["rms_luv"], built["map_rms"], delta=0.02 * built["map_rms"])
        self.assertEqual(found, self.compare("a.glb", "a.png"))
        gouraud = self.compare("a.glb", "a.png", "--mode", "gouraud")
        self.assertAlmostEqual(gouraud["rms_luv"], built["gouraud_rms"], delta=0.02 * built["gouraud_rms"])
        # What reconstruct writes differs by no more than the rounding to 8 bits.
        self.run_ok("imgmesh-reconstruct", "a.glb", "-o", "drawn.png")
        self.assertLessEqual(self.compare("drawn.png", "a.glb")["max_rgb"], 0.5001 / 255)

    def test_container_alone(self):
        self.build_both()
        report = self.report(TOOL, "a.glb")
        self.assertNotIn("difference", report)
        (found,) = report["inputs"]
        level = self.report("imgmesh-info", "a.glb")["levels"][0]
        self.assertEqual((found["vertices"], found["faces"]), (level["vertices"], level["faces"]))
        for key, mean in (("valence", "mean_valence"), ("edge_ratio", "mean_edge_ratio"),
                          ("radius_ratio", "mean_radius_ratio"), ("shape", "mean_shape")):
            self.assertAlmostEqual(found["mesh"][key]["mean"], level["mesh"][mean], places=5)
        self.assertAlmostEqual(found["mesh"]["min_angle_deg"]["min"], level["mesh"]["min_angle_deg"], places=3)
        self.assertAlmostEqual(found["map"]["jump"]["max"], level["map"]["max_jump"], places=4)
        self.assertAlmostEqual(found["map"]["displacement"]["mean"], level["map"]["mean_displacement"], places=4)
        self.assertEqual(found["map"]["flipped_triangles"], level["map"]["flipped_triangles"])
        for key, values in {**found["mesh"], "patch_per_area": found["map"]["patch_per_area"]}.items():
            histogram = values["histogram"]
            self.assertEqual(values["count"], found["vertices" if key == "valence" else "faces"])
            self.assertEqual(sum(histogram["counts"]) + histogram["below"] + histogram["above"], values["count"])

    def test_two_containers(self):
        self.build_both()
        report = self.report(TOOL, "a.glb", "b.gltf")
        self.assertEqual([i["kind"] for i in report["inputs"]], ["container"] * 2)
        for found in report["inputs"]:
            alone = self.report(TOOL, found["input"])["inputs"][0]
            self.assertEqual({**found, "mode": "map"}, {**alone, "mode": "map"})
        self.assertGreater(report["difference"]["rms_luv"], 0)
        self.assertEqual(self.compare("a.glb", "a.glb")["rms_luv"], 0)
        text = self.run_ok(TOOL, "a.glb", "b.gltf").stdout
        for words in ("a.glb against b.gltf", "CIEDE2000", "aspect ratio", "b.gltf: level 0"):
            self.assertIn(words, text)

    def test_light_is_compared_whatever_its_encoding(self):
        linear = np.where(self.a <= 0.04045, self.a / 12.92, ((self.a + 0.055) / 1.055) ** 2.4)
        picture_files.write_float(self.folder / "a.exr", linear)
        found = self.compare("a.png", "a.exr")
        self.assertLess(found["max_rgb"], 1e-5)
        self.assertEqual(found["color_space"], "sRGB")
        self.assertGreater(self.compare("a.png", "a.exr", "--color-space", "sRGB")["rms_luv"], 0)
        grey = picture_files.ramp(48, 32)[..., :1]
        picture_files.png(self.folder / "grey.png", grey)
        picture_files.png(self.folder / "rgb.png", np.repeat(grey, 3, axis=-1))
        self.assertEqual(self.compare("grey.png", "rgb.png")["rms_luv"], 0)

    def test_colour_figures_leave_out_transparent_pixels_and_the_tolerance_does_not(self):
        rgba = np.concatenate([picture_files.ramp(48, 32), np.ones((32, 48, 1))], axis=-1)
        rgba[:, :8, 3] = 0
        rgba[:, :8, :3] = 0.5
        picture_files.png(self.folder / "cut.png", rgba)
        found = self.compare("a.png", "cut.png", "--tolerance", "0", code=7)
        self.assertEqual((found["pixels"], found["in_one_only"]), (40 * 32, 8 * 32))
        self.assertEqual((found["rms_luv"], found["max_alpha"]), (0, 1))
        self.assertAlmostEqual(found["rms_alpha"], np.sqrt(8 / 48))
        over = [luv_of(picture_files.read(self.folder / "cut.png")[..., :3] * rgba[..., 3:] + ground * (1 - rgba[..., 3:]))
                - luv_of(self.a) for ground in (0, 1)]
        self.assertAlmostEqual(found["rms_visible"], max(np.sqrt(np.mean((o ** 2).sum(-1))) for o in over), delta=0.02)
        text = self.run_ok(TOOL, "a.png", "cut.png").stdout
        for word in ("transparent", "alpha", "visible"):
            self.assertIn(word, text)
        self.run_ok(TOOL, "cut.png", "cut.png", "--error-image", "e.png")
        image = picture_files.read(self.folder / "e.png")
        self.assertTrue((image[:, :8, 1] > image[:, :8, 0]).all())
        self.assertEqual(image[:, 8:].max(), 0)
        rgba[..., 3] = 0
        picture_files.png(self.folder / "nothing.png", rgba)
        found = self.compare("a.png", "nothing.png", "--tolerance", "0", code=7)
        self.assertEqual((found["pixels"], found["rms_luv"]), (0, None))
        self.run_ok(TOOL, "a.png", "nothing.png")
        rgba[..., :3] = 0.25
        picture_files.png(self.folder / "nothing2.png", rgba)
        self.compare("nothing.png", "nothing2.png", "--tolerance", "0")

    def test_one_step_of_alpha_counts(self):
        """Whatever the colour below: grey differs over both grounds, black over white, white over black."""
        for grey in (0, 0.5, 1):
            rgba = np.full((4, 5, 4), float(grey))
            rgba[..., 3] = 1
            picture_files.png(self.folder / "full.png", rgba)
            picture_files.png(self.folder / "rgb.png", rgba[..., :3])
            self.compare("full.png", "rgb.png", "--tolerance", "0")
            for was, step in ((1, 254 / 255), (0.2, 50 / 255), (0, 1 / 255)):
                rgba[1, 2, 3] = was
                picture_files.png(self.folder / "was.png", rgba)
                rgba[1, 2, 3] = step
                picture_files.png(self.folder / "step.png", rgba)
                found = self.compare("was.png", "step.png", "--tolerance", "0", code=7)
                self.assertAlmostEqual(found["max_alpha"], 1 / 255, places=6)
                self.assertLess(found["rms_visible"], 0.2)

    def test_error_image(self):
        """Its lightness is the error: L* = 100 error / range."""
        self.run_ok(TOOL, "a.png", "b.png", "--error-image", "e.png", "--error-range", "40")
        lightness = luv_of(picture_files.read(self.folder / "e.png"))[..., 0]
        error = np.linalg.norm(luv_of(self.a) - luv_of(self.b), axis=-1)
        np.testing.assert_allclose(lightness, np.clip(error / 0.4, 0, 100), atol=1.5)
        self.run_ok(TOOL, "a.png", "a.png", "--error-image", "e.tif")
        self.assertEqual(picture_files.read(self.folder / "e.tif").max(), 0)

    def test_plots(self):
        self.build_both()
        for inputs, panels in ((["a.png", "b.png"], 2), (["a.glb"], 10), (["a.png", "a.glb"], 12),
                               (["a.glb", "b.gltf"], 12)):
            self.run_ok(TOOL, *inputs, "--plot", "p.svg")
            root = xml.etree.ElementTree.parse(self.folder / "p.svg").getroot()
            texts = [t.text for t in root.iter(SVG + "text")]
            self.assertEqual(sum(t.get("font-size") == "14" and int(t.get("x")) % 350 == 50
                                 for t in root.iter(SVG + "text")), panels, texts)
            for name in inputs:
                self.assertTrue(any(name in t for t in texts))
            width, height = int(root.get("width")), int(root.get("height"))
            for box in root.iter(SVG + "rect"):
                x, y, w, h = (int(box.get(k, 0)) for k in ("x", "y", "width", "height"))
                self.assertTrue(0 <= x and x + w <= width and 0 <= y and y + h <= height and w > 0 and h > 0)
            self.run_ok(TOOL, *inputs, "--plot", "p.png")
            image = picture_files.read(self.folder / "p.png")
            self.assertEqual(image.shape, (2 * height, 2 * width, 3))
            self.assertGreater(np.mean(image), 0.8)
            self.assertLess(np.min(image.max(axis=-1)), 0.3, "no ink")

    def test_plot_bars_are_the_histogram(self):
        self.build_both()
        report = self.report(TOOL, "a.glb", "--plot", "p.svg")
        counts = np.array(report["inputs"][0]["mesh"]["valence"]["histogram"]["counts"])
        root = xml.etree.ElementTree.parse(self.folder / "p.svg").getroot()
        blue = next(r.get("fill") for r in root.iter(SVG + "rect") if r.get("width") == "12")
        bars = [int(r.get("height")) for r in root.iter(SVG + "rect")
                if r.get("fill") == blue and 50 <= int(r.get("x")) < 340 and int(r.get("y")) < 300
                and r.get("width") != "12"]
        expected = counts / counts.sum()
        scale = max(bars) / expected.max()
        np.testing.assert_allclose(bars, (expected * scale)[expected * scale >= 0.5], atol=1.5)

    def test_names_in_plots_are_text(self):
        name = "<&\"'>\n\u00fc.png"
        (self.folder / name).write_bytes((self.folder / "a.png").read_bytes())
        self.run_ok(TOOL, name, b"a.png", "--plot", "p.svg")
        texts = "".join(t.text for t in xml.etree.ElementTree.parse(self.folder / "p.svg").iter(SVG + "text"))
        self.assertIn("<&\"'>\\x0a\u00fc.png", texts)
        self.run_ok(TOOL, name, "a.png", "--plot", "p.png")

    def test_same_results_for_any_number_of_threads(self):
        self.build_both()
        outputs = []
        for threads in ("1", "3"):
            report = self.run_ok(TOOL, "b.png", "a.glb", "--threads", threads, "--json", "--error-image", "e.png",
                                 "--plot", "p.png").stdout
            outputs.append((report, self.files()))
        self.assertEqual(outputs[0], outputs[1])

    def test_several_against_one(self):
        """Each is compared as it would be alone."""
        self.build_both()
        whole = self.report(TOOL, "a.png", "a.glb", "b.png", "none.png", "--error-image", "e/", code=3)
        self.assertEqual([[i["input"] for i in file["inputs"]] for file in whole["files"]],
                         [["a.png", "a.glb"], ["a.png", "b.png"], ["a.png", "none.png"]])
        self.assertEqual(sorted(p.name for p in (self.folder / "e").iterdir()), ["a.png", "b.png"])
        for file, name in zip(whole["files"], ("a.glb", "b.png")):
            alone = self.report(TOOL, "a.png", name)
            for member in ("inputs", "difference"):
                self.assertEqual(file[member], alone[member])
        self.assertEqual(whole["files"][2]["failure"]["code"], 3)
        text = self.run_tool(TOOL, "a.png", "a.glb", "b.png").stdout
        self.assertRegex(text, r"(?m)^a.png against a.glb: RMS [0-9.]+ in L\*u\*v\*, PSNR [0-9.]+ dB$")

    def test_levels(self):
        self.build_both()
        self.assertEqual(self.report(TOOL, "a.glb", "--level", "0")["inputs"][0]["level"], 0)
        self.assert_error(TOOL, ["a.glb", "--level", "1"], 2, "--level 1", "a.glb", "0 to 0")
        self.assert_error(TOOL, ["a.png", "a.glb", "--level", "1", "--plot", "p.svg"], 2, "--level 1", "a.glb")

    def test_wrong_use(self):
        for args, words in (([], ["required"]), (["a.png"], ["a.png", "second"]),
                            (["a.glb", "--tolerance", "1"], ["--tolerance", "two"]),
                            (["a.glb", "--error-image", "e.png"], ["--error-image", "two"]),
                            (["a.glb", "--mode", "map"], ["--mode", "two"]),
                            (["a.glb", "--color-space", "sRGB"], ["--color-space", "two"]),
                            (["a.png", "b.png", "--mode", "map"], ["--mode", "container"]),
                            (["a.png", "b.png", "--level", "0"], ["--level", "container"]),
                            (["a.glb", "b.glb", "--color-space", "sRGB"], ["--color-space", "an image"]),
                            (["a.png", "b.png", "--error-range", "5"], ["--error-range", "--error-image"]),
                            (["a.png", "b.png", "--error-image", "e.svg"], ["--error-image", "e.svg"]),
                            (["a.png", "b.png", "--error-image", ""], ["--error-image", "expected"]),
                            (["a.png", "b.png", "--plot", "p.pdf"], ["--plot", "p.pdf", ".svg"]),
                            (["a.png", "b.png", "--plot", "e.png", "--error-image", "./e.png"], ["--plot", "e.png"]),
                            (["a.png", "b.png", "--mode", "wire"], ["--mode", "gouraud"])):
            self.assert_error(TOOL, args, 2, *words)
        for option, values in {"--tolerance": ["-1", "nan", "x", ""], "--error-range": ["0", "inf"],
                               "--level": ["-1", "2147483648"]}.items():
            for value in values:
                self.assert_error(TOOL, ["a.png", "a.glb", option, value], 2, option, f"'{value}'", "expected")

    def test_files_that_are_not_what_they_must_be(self):
        self.build_both()
        for args in (["a.png", "none.png"], ["none.glb"], ["none.glb", "a.png"]):
            self.assert_error(TOOL, args, 3, "none")
        (self.folder / "text.png").write_text("text")
        (self.folder / "text.glb").write_text("text")
        self.assert_error(TOOL, ["a.png", "text.png"], 4, "text.png")
        self.assert_error(TOOL, ["text.glb"], 4, "text.glb", "[")
        self.assert_error(TOOL, ["text.glb", "a.png", "--error-image", "e.png"], 4, "text.glb")
        picture_files.write_float(self.folder / "depth.exr", picture_files.noise(48, 32, 1), names=("Z",))
        self.assert_error(TOOL, ["a.png", "depth.exr"], 5, "depth.exr", "colour")

    def test_outputs(self):
        self.build_both()
        self.assert_error(TOOL, ["a.png", "b.png", "--plot", "none/p.svg"], 3, "none/p.svg")
        self.assert_error(TOOL, ["a.png", "b.png", "--error-image", "none/e.png"], 3, "none/e.png")
        self.assert_error(TOOL, ["a.png", "b.png", "--error-image", "b.png"], 2, "b.png", "input")
        self.assert_error(TOOL, ["b.gltf", "--plot", "b.gltf.png", "--error-image", "e.png"], 2, "--error-image")
        (self.folder / "p.svg").write_text("old")
        self.assert_error(TOOL, ["a.png", "b.png", "--plot", "p.svg", "--no-overwrite"], 3, "p.svg", "exists")
        self.assert_error(TOOL, ["a.png", "b.png", "--error-image", "e.png", "--plot", "p.svg", "--no-overwrite"], 3)
        self.run_ok(TOOL, "a.png", "b.png", "--plot", "p.svg")
        self.assertTrue((self.folder / "p.svg").read_text().startswith("<svg"))

    def test_json_is_json(self):
        """No nan and no inf, which Python alone would take."""
        text = self.run_ok(TOOL, "a.png", "a.png", "--json").stdout
        json.loads(text, parse_constant=self.fail)


if __name__ == "__main__":
    main()

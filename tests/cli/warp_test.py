"""imgmesh-warp: images, maps and containers out of edits, and what it says to bad ones."""
import json

import numpy as np
import OpenImageIO as oiio

import picture_files
from support import CliCase, main

TOOL = "imgmesh-warp"


def part(path, number):
    """The samples of one part of an EXR, and its channels' names."""
    source = oiio.ImageInput.open(str(path))
    source.seek_subimage(number, 0)
    names = source.spec().channelnames
    samples = source.read_image(number, 0, 0, len(names), "float")
    source.close()
    return samples, names


class Warp(CliCase):
    def setUp(self):
        super().setUp()
        self.original = picture_files.read(picture_files.png(self.folder / "in.png", picture_files.ramp(48, 32)))
        self.build("in.png", "--level-faces", "300,40", output="c.glb")

    def edits(self, *edits):
        (self.folder / "e.json").write_text(json.dumps({"edits": edits}))

    def warp(self, *args, output="out.png", container="c.glb", image="in.png"):
        report = self.report(TOOL, container, "--image", image, "-o", output, *args)
        return report, picture_files.read(self.folder / output)

    def test_without_edits_the_picture_comes_back(self):
        noise = np.random.default_rng(1).random
        float_samples = np.float32(noise((9, 13, 3)) * 4 - 1)
        float_samples[0, 0] = [1e-30, 65504, 3]
        files = {
            "grey.png": picture_files.png(self.folder / "grey.png", noise((9, 13, 1))),
            "grey-alpha.png": picture_files.png(self.folder / "grey-alpha.png", noise((9, 13, 2)), bits=16),
            "alpha.png": picture_files.png(self.folder / "alpha.png", noise((9, 13, 4))),
            "deep.png": picture_files.png(self.folder / "deep.png", noise((9, 13, 3)), bits=16),
            "palette.png": picture_files.png(self.folder / "palette.png", np.arange(117).reshape(9, 13) % 5,
                                             palette=noise((5, 3))),
            "float.exr": picture_files.write_float(self.folder / "float.exr", float_samples),
            "half.exr": picture_files.write_float(self.folder / "half.exr", noise((9, 13, 3)), "half"),
            "float.tif": picture_files.write_float(self.folder / "float.tif", float_samples),
            "depth.exr": picture_files.write_float(self.folder / "depth.exr", noise((9, 13, 5)), "float",
                                                   ["R", "G", "B", "Z", "mask"]),
        }
        for shape in ((1, 1), (1, 7), (7, 1), (3, 3)):
            name = f"{shape[0]}x{shape[1]}.png"
            files[name] = picture_files.png(self.folder / name, noise((*shape, 3)))
        for name, path in files.items():
            with self.subTest(name):
                # The container's image is another of the same size: only its map counts.
                height, width = picture_files.read(path).shape[:2]
                container = f"{width}x{height}.glb"
                if not (self.folder / container).exists():
                    picture_files.png(self.folder / "same-size.png", picture_files.noise(width, height))
                    self.build("same-size.png", "--density", "30", output=container)
                _, image = self.warp(image=name, output="out" + path.suffix, container=container)
                np.testing.assert_array_equal(image, picture_files.read(path))
                self.assertEqual(picture_files.spec(self.folder / ("out" + path.suffix)).format,
                                 picture_files.spec(path).format if name != "palette.png" else "uint8")

    def test_everything_moved_shifts_the_picture(self):
        for solver in ("direct", "arap"):
            self.edits({"level": 1, "solver": solver,
                        "handles": [{"box": [-1, -1, 48, 32], "move": [5, -3]}]})
            report, image = self.warp("--edits", "e.json")
            self.assertEqual(image.shape, (32, 48, 4))
            np.testing.assert_array_equal(image[:29, 5:, :3], self.original[3:, :43])
            self.assertTrue((image[:29, 5:, 3] == 1).all() and (image[29:] == 0).all())
            self.assertAlmostEqual(report["largest_move"], 34 ** 0.5, places=5)
            self.assertEqual(report["folded_cells"], 0)

    def test_handle(self):
        report, image = self.warp("--handle", "24,16:3,2", "--level", "1")
        self.assertEqual((report["edits"], report["moved_vertices"]), (1, 1))
        self.assertFalse(np.array_equal(image, self.original))
        self.edits({"level": 1, "handles": [{"near": [24, 16], "move": [3, 2]}]})
        np.testing.assert_array_equal(self.warp("--edits", "e.json")[1], image)
        # Two edits add up, and these are opposite.
        report, image = self.warp("--edits", "e.json", "--handle", "24,16:-3,-2", "--level", "1")
        self.assertEqual(report["edits"], 2)
        np.testing.assert_array_equal(image, self.original)

    def test_pins_and_handles_are_an_edit(self):
        """Options give what the equal file gives, to the sample. With pins all follow, unless --solver says otherwise."""
        handles = [{"near": [24, 16], "move": [3, 2]}, {"near": [40, 8], "move": [-2, 1.5]}]
        pins = [{"near": [2, 30]}, {"near": [0, 0]}, {"border": True}]
        options = ["--handle", "24,16:3,2", "--handle=40,8:-2,1.5", "--level", "0"]
        for given, edit in (
                (options, {"handles": handles}),
                ([*options, "--pin", "2,30"], {"handles": handles, "solver": "arap", "pins": pins[:1]}),
                ([*options, "--pin", "2,30", "--pin", "0,0"], {"handles": handles, "solver": "arap", "pins": pins[:2]}),
                ([*options, "--pin-border"], {"handles": handles, "solver": "arap", "pins": pins[2:]}),
                ([*options, "--pin-border", "--solver", "direct"], {"handles": handles}),
                (["--handle", "0,0:3,2", "--pin-border", "--level", "1"],  # a corner, which the border has too
                 {"level": 1, "solver": "arap", "handles": [{"near": [0, 0], "move": [3, 2]}], "pins": pins[2:]})):
            with self.subTest(given):
                report, image = self.warp(*given)
                self.assertEqual(report["edits"], 1)
                self.edits(edit)
                expected, by_file = self.warp("--edits", "e.json")
                np.testing.assert_array_equal(image, by_file)
                for facts in (report, expected):
                    del facts["parameters"]
                self.assertEqual(report, expected)
        # A list in the configuration file.
        (self.folder / "c.toml").write_text('handle = ["24,16:3,2", "40,8:-2,1.5"]\npin = "2,30"\n')
        from_config = self.warp("--config", "c.toml")[1]
        np.testing.assert_array_equal(from_config, self.warp(*options, "--pin", "2,30")[1])

    def test_pins_hold(self):
        """A bar of two halves, one of them pinned: it stays as it was, the other one is pulled."""
        report, image = self.warp("--handle", "47,16:0,4", "--pin", "0,0", "--pin", "0,31", "--pin", "24,0", "--pin",
                                  "24,31", "--pin", "0,16", "--pin", "24,16")
        moved = np.abs(image[..., :3] - self.original).max(axis=(0, 2)) > 0.05
        self.assertFalse(moved[:8].any())
        self.assertTrue(moved[40:].any())

    def test_injective(self):
        """A pull that folds the mesh by one solver is a container by the other; one that no mesh allows is told of."""
        pull = ["--handle", "24,12:-14,0", "--pin-border"]
        self.assert_error(TOOL, ["c.glb", "-o", "x.glb", *pull], 5, "turn over")
        report = self.report(TOOL, "c.glb", "-o", "w.glb", *pull, "--solver", "injective")
        self.assertEqual(report["unreached"], 0)
        self.assertNotIn("warnings", report)
        self.assertTrue(self.report("imgmesh-info", "w.glb", "--validate")["valid"])
        image = self.warp(*pull, "--solver", "injective")[1]
        self.edits({"solver": "injective", "handles": [{"near": [24, 12], "move": [-14, 0]}], "pins": [{"border": True}]})
        np.testing.assert_array_equal(self.warp("--edits", "e.json")[1], image)
        self.assertNotIn("unreached", self.warp("--handle", "24,16:1,0")[0])
        report, image = self.warp("--handle", "24,16:400,0", "--pin-border", "--solver", "injective")
        self.assertGreater(report["unreached"], 300)
        self.assertEqual(len(report["warnings"]), 1)
        self.assertIn("c.glb: level 0: a handle stays ", report["warnings"][0])
        self.assertEqual(image.shape, (32, 48, 3))

    def test_size(self):
        report, image = self.warp("--size", "24x16")
        self.assertEqual((report["width"], report["height"], image.shape), (24, 16, (16, 24, 3)))
        mean = self.original.reshape(16, 2, 24, 2, 3).mean(axis=(1, 3))
        np.testing.assert_allclose(image, mean, atol=0.51 / 255)
        self.assertEqual(self.warp("--size", "100x7")[1].shape, (7, 100, 3))

    def test_retarget(self):
        report, image = self.warp("--retarget", "30x32", "--displacement", "d.exr")
        self.assertEqual((report["width"], report["height"], image.shape), (30, 32, (32, 30, 3)))
        self.assertEqual(report["folded_cells"], 0)
        self.assertEqual(part(self.folder / "d.exr", 0)[0].shape, (32, 30, 3))
        self.assertFalse(np.array_equal(image, self.warp("--size", "30x32")[1]))
        # The same proportions: nothing gives way.
        np.testing.assert_allclose(self.warp("--retarget", "24x16")[1], self.warp("--size", "24x16")[1], atol=1.01 / 255)
        # An edit is added: its corner leaves the frame.
        self.assertEqual(self.warp("--retarget", "30x32", "--handle", "0,0:4,4")[1].shape, (32, 30, 4))

    def test_maps(self):
        """The STMap, read as compositors do, gives the drawing; the displacement is where pixels go."""
        report, image = self.warp("--handle", "20,14:0.8,0.6", "--level", "1", "--displacement", "d.exr")
        self.assertEqual(report["displacement"], "d.exr")
        st, names = part(self.folder / "d.exr", 0)
        self.assertEqual(list(names), ["R", "G", "A"])
        x, y = st[..., 0] * 48 - 0.5, (1 - st[..., 1]) * 32 - 0.5
        x0, y0 = np.clip(np.floor(x).astype(int), 0, 46), np.clip(np.floor(y).astype(int), 0, 30)
        fx, fy = (x - x0)[..., None], (y - y0)[..., None]
        o = self.original
        sampled = ((o[y0, x0] * (1 - fx) + o[y0, x0 + 1] * fx) * (1 - fy) +
                   (o[y0 + 1, x0] * (1 - fx) + o[y0 + 1, x0 + 1] * fx) * fy)
        self.assertTrue((st[..., 2] == 1).all())
        close = np.abs(sampled - image).max(axis=-1) < 0.51 / 255  # not where the drawing means several points
        self.assertGreater(close.mean(), 0.95)
        forward, names = part(self.folder / "d.exr", 1)
        self.assertEqual(list(names), ["displacement.x", "displacement.y"])
        self.assertGreater(np.hypot(forward[..., 0], forward[..., 1]).max(), 0.8)
        # Forth and back, where nothing folds: the map at the place that a pixel goes to shows the pixel.
        self.assertEqual(report["folded_cells"], 0)
        row, column = np.mgrid[4:28, 4:44]
        tx, ty = column + forward[row, column, 0], row + forward[row, column, 1]
        x0, y0 = np.floor(tx).astype(int), np.floor(ty).astype(int)
        fx, fy = tx - x0, ty - y0
        for back, origin in ((x, column), (y, row)):
            there = ((back[y0, x0] * (1 - fx) + back[y0, x0 + 1] * fx) * (1 - fy) +
                     (back[y0 + 1, x0] * (1 - fx) + back[y0 + 1, x0 + 1] * fx) * fy)
            self.assertLess(np.abs(there - origin).max(), 0.8)
            self.assertLess(np.abs(there - origin).mean(), 0.02)
        # Without an image to draw, the maps alone.
        self.assertNotIn("output", self.report(TOOL, "c.glb", "--displacement", "m.exr", "--size", "9x5"))
        self.assertEqual(part(self.folder / "m.exr", 0)[0].shape, (5, 9, 3))
        self.assertEqual(part(self.folder / "m.exr", 1)[0].shape, (32, 48, 2))

    def test_container(self):
        for name in ("w.glb", "w.gltf"):
            report = self.report(TOOL, "c.glb", "-o", name, "--handle", "24,16:0.5,-0.5", "--level", "1")
            files = ("w.glb",) if name == "w.glb" else ("w.gltf", "w.bin", "w.exr")
            self.assertEqual(report["bytes"], sum((self.folder / file).stat().st_size for file in files))
            info = self.report("imgmesh-info", name, "--validate")
            self.assertTrue(info["valid"])
            sizes = self.report("imgmesh-info", name)["bytes"]
            self.assertEqual((report["mesh_bytes"], report["layer_bytes"]), (sizes["meshes"], sizes["layers"]))
            # The map is the unwarped image's; the mesh is another.
            for container in (name, "c.glb"):
                self.run_ok("imgmesh-reconstruct", container, "-o", container + ".png", "-q")
                self.run_ok("imgmesh-reconstruct", container, "-o", container + ".g.png", "--mode", "wire", "-q")
            read = lambda file: picture_files.read(self.folder / file)
            np.testing.assert_array_equal(read(name + ".png"), read("c.glb.png"))
            self.assertFalse(np.array_equal(read(name + ".g.png"), read("c.glb.g.png")))
        self.assert_error(TOOL, ["c.glb", "-o", "x.glb", "--handle", "24,16:500,0", "--level", "1"], 5, "turn over")

    def test_masked_image(self):
        """A ring with a soft boundary, meshed as a masked image on two levels."""
        y, x = np.mgrid[0:60, 0:80]
        radius = np.hypot(x - 39.5, y - 29.5)
        alpha = np.clip(26.5 - radius, 0, 1) * np.clip(radius - 13.5, 0, 1)
        ring = np.dstack([picture_files.ramp(80, 60), alpha])
        original = picture_files.read(picture_files.png(self.folder / "ring.png", ring))
        self.build("ring.png", "--level-faces", "300,60", output="ring.glb")
        warp = lambda *args: self.warp(*args, container="ring.glb", image="ring.png")[1]
        np.testing.assert_array_equal(warp(), original)
        # All moved: what can be seen moves along to the bit, the faint outside of the boundary too.
        self.edits({"level": 1, "handles": [{"box": [-9, -9, 90, 90], "move": [4, 2]}]})
        moved = warp("--edits", "e.json")
        seen = original[:58, :76, 3] > 0
        np.testing.assert_array_equal(moved[2:, 4:, 3], original[:58, :76, 3])
        np.testing.assert_array_equal(moved[2:, 4:][seen], original[:58, :76][seen])
        self.assertEqual((moved[:2] != 0).sum() + (moved[:, :4] != 0).sum(), 0)
        # The right side pulled: the left half stays as it was, where anything is to be seen.
        pulled = warp("--handle", "66,30:9,0", "--level", "1")
        left = (original[..., 3] > 0) & (x < 36)
        np.testing.assert_array_equal(pulled[left], original[left])
        self.assertGreater(pulled[:, 67:, 3].sum(), original[:, 67:, 3].sum() + 20)
        report = self.report(TOOL, "ring.glb", "-o", "w.glb", "--handle", "66,30:3,0", "--level", "1")
        self.assertEqual(report["moved_vertices"], 1)
        self.assertTrue(self.report("imgmesh-info", "w.glb", "--validate")["valid"])
        self.assert_error(TOOL, ["ring.glb", "--image", "ring.png", "-o", "x.png", "--retarget", "40x40"], 5, "masked image")

    def test_bad_edit_files(self):
        handle = {"vertex": 0, "move": [1, 1]}
        for edits, place in (
                ([{"level": 2, "handles": []}], "e.json: /edits/0/level: level 2 is not there"),
                ([{"handles": [handle]}, {"level": 1, "handles": [{"vertex": 99999, "move": [0, 0]}]}],
                 "e.json: /edits/1/handles/0/vertex: vertex 99999 is not there; level 1 has vertices 0 to"),
                ([{"handles": [{"vertex": "0", "move": [1, 1]}]}], "e.json: /edits/0/handles/0/vertex: expected"),
                ([{"handles": [{"circle": [-50, -50, 1], "move": [1, 1]}]}],
                 "e.json: /edits/0/handles/0/circle: no vertex"),
                ([{"handles": [handle], "pins": [{"near": [0, 0]}, {"vertex": 0}]}], "is also in a handle"),
                ([{"hadles": []}], "e.json: /edits/0: unknown member")):
            self.edits(*edits)
            self.assert_error(TOOL, ["c.glb", "--image", "in.png", "-o", "x.png", "--edits", "e.json"], 4, place)
        for text in ("", "[" * 100000, '{"edits": [NaN]}', "\0", "{" * 20):
            (self.folder / "e.json").write_text(text)
            self.assert_error(TOOL, ["c.glb", "--image", "in.png", "-o", "x.png", "--edits", "e.json"], 4, "e.json: ")
        self.assert_error(TOOL, ["c.glb", "--displacement", "x.exr", "--edits", "none.json"], 3, "none.json")

    def test_bad_options(self):
        picture = ["c.glb", "--image", "in.png", "-o", "x.png"]
        for args, *words in (
                (["c.glb"], "nothing to write"), (["c.glb", "-o", "x.png"], "--image"),
                (["c.glb", "--image", "in.png", "-o", "x.txt"], "x.txt"),
                (["c.glb", "--displacement", "x.png"], "--displacement", ".exr"),
                (["c.glb", "-o", "x.glb", "--size", "3x3"], "--size"),
                ([*picture, "--size", "3"], "--size"), ([*picture, "--retarget", "3y3"], "--retarget"),
                ([*picture, "--retarget", "3x3", "--size", "3x3"], "--retarget"),
                (["c.glb", "-o", "x.glb", "--retarget", "3x3"], "--retarget"), ([*picture, "--size", "0x5"], "--size"),
                ([*picture, "--size", "65536x5"], "--size"), ([*picture, "--size", "65535x65535"], "size"),
                ([*picture, "--handle", "1,2"], "--handle"), ([*picture, "--handle", "1,2:3"], "--handle"),
                ([*picture, "--handle", "1,2:3,nan"], "--handle"), ([*picture, "--handle", "1,2:3,4,5"], "--handle"),
                ([*picture, "--handle", "1,2:3,4", "--pin", "1"], "--pin '1'", "X,Y"),
                ([*picture, "--pin", "1,2"], "--pin", "--handle"), ([*picture, "--pin-border"], "--handle"),
                ([*picture, "--handle", "1,2:3,4", "--pin", "1,2"], "--pin 1,2: vertex", "also in a handle"),
                ([*picture, "--level", "1"], "--handle"), ([*picture, "--solver", "arap"], "--handle"),
                ([*picture, "--handle", "1,2:3,4", "--level", "2"], "--level 2"),
                ([*picture, "--handle", "1,2:3,4", "--solver", "soft"], "--solver"),
                (["c.glb", "--image", "in.png", "-o", "in.png"], "in.png"),
                (["c.glb", "--image", "in.png", "-o", "c.glb"], "c.glb")):
            self.assert_error(TOOL, args, 2, *words)
        # One file for two results would lose one of them.
        for args in (["-o", "x.exr", "--displacement", "x.exr"], ["-o", "y.gltf", "--displacement", "y.exr"],
                     ["-o", "x.exr", "--displacement", str(self.folder / "x.exr")]):
            self.assert_error(TOOL, ["c.glb", "--image", "in.png", *args], 2, "two outputs")
        picture_files.png(self.folder / "other.png", picture_files.ramp(32, 48))
        self.assert_error(TOOL, ["c.glb", "--image", "other.png", "-o", "x.png"], 4, "other.png", "32x48", "48x32")
        self.assert_error(TOOL, ["c.glb", "--image", "in.png", "-o", "x.jpg", "--handle", "0,0:9,9"], 2, "transparency")

    def test_points_outside(self):
        """A warning for each that no hand could mean; a plus sign is that of a number."""
        args = ("c.glb", "-o", "w.glb", "--solver", "direct", "--handle")
        moved = [self.report(TOOL, *args, text)["largest_move"] for text in ("47,31:4,-2", "+47,31:+4,-2", "50,31:+4,-2")]
        self.assertEqual(len(set(moved)), 1)
        warnings = self.report(TOOL, *args, "347,31:+4,-2", "--handle", "3,3:1,1")["warnings"]
        self.assertEqual(len(warnings), 1)
        self.assertIn("c.glb: --handle 347,31:+4,-2: the point is 300 pixels outside", warnings[0])
        for text in ("3,3:++1,0", "3,3:+,0", "3,3:+-1,0"):
            self.assert_error(TOOL, [*args, text], 2, "--handle")
        self.assert_error(TOOL, ["c.glb", "-o", "v.glb", "--edits", "-"], 2, "--edits -: only CONTAINER")

    def test_threads_and_text(self):
        self.edits({"level": 1, "solver": "arap", "handles": [{"near": [24, 16], "move": [6, 2]}],
                    "pins": [{"border": True}]})
        outputs = []
        for threads in ("1", "7"):
            self.warp("--edits", "e.json", "--threads", threads, "--displacement", "d.exr", output="out.exr")
            outputs.append([(self.folder / name).read_bytes() for name in ("out.exr", "d.exr")])
        self.assertEqual(outputs[0], outputs[1])
        text = self.run_ok(TOOL, "c.glb", "--image", "in.png", "-o", "out.png", "--edits", "e.json").stdout
        self.assertTrue(text.startswith("c.glb -> out.png\n"))
        self.assertIn("48 x 32", text)


if __name__ == "__main__":
    main()

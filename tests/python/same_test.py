"""What Python writes is what the tools write, byte for byte."""
import json
import pathlib
import warnings

import numpy as np

import imgmesh
import picture_files
from support import CliCase, main


class Same(CliCase):
    def setUp(self):
        super().setUp()
        self.color = np.round(picture_files.ramp(48, 32) * 255).astype(np.uint8)
        y, x = np.mgrid[0:32, 0:48]
        self.alpha = np.round(np.clip(1.6 - np.hypot(x - 22, y - 15) / 10, 0, 1) * 255).astype(np.uint8)
        self.soft = np.concatenate([self.color, self.alpha[..., None]], axis=-1)
        self.hard = self.soft.copy()
        self.hard[..., 3] = np.where(self.alpha > 127, 255, 0)

    def png(self, array, name="in.png"):
        bits = 16 if array.dtype == np.uint16 else 8
        samples = array[..., None] if array.ndim == 2 else array
        return picture_files.png(self.folder / name, samples / (2 ** bits - 1), bits)

    def write(self, mesh, name, **how):
        mesh.write(self.folder / name, **how)
        return (self.folder / name).read_bytes()

    def check(self, image, array, options=(), **parameters):
        """From the file's name, from its Image and from its array: the same container as the tool's."""
        name = str(self.folder / image) if isinstance(image, str) else str(image)
        self.run_ok("imgmesh-build", name, "-o", "tool.glb", "-q", *options)
        tool = (self.folder / "tool.glb").read_bytes()
        for source in (name, pathlib.Path(name), imgmesh.read_image(name)) + (() if array is None else (array,)):
            with self.subTest(options=options, source=type(source)):
                self.assertEqual(self.write(imgmesh.build(source, **parameters), "python.glb"), tool)
        return tool

    def test_coded_pictures(self):
        for picture, options, parameters in ((self.color, ["--bytes", "200"], {"bytes": 200}),
                                             (self.soft, ["--vertices", "20", "--tune", "luma"], {"vertices": 20, "tune": "luma"}),
                                             (self.alpha, ["--effort", "1"], {"effort": 1})):
            path = self.png(picture)
            self.run_ok("imgmesh-encode", path, "-o", "x.imgm", "-q", *options)
            coded = (self.folder / "x.imgm").read_bytes()
            for source in (str(path), picture):
                self.assertEqual(imgmesh.encode(source, **parameters), coded)
            self.run_ok("imgmesh-decode", "x.imgm", "-o", "drawn.png", "-q", "--size", "20x30")
            np.testing.assert_array_equal(imgmesh.decode(coded, size=(20, 30)).array,
                                          imgmesh.read_image(self.folder / "drawn.png").array)
        for wrong in ({"bytes": 3}, {"bytes": 99, "psnr": 20}, {"effort": 9}, {"tune": "x"}, {"quality": float("nan")}):
            with self.assertRaises(imgmesh.ArgumentError):
                imgmesh.encode(self.color, **wrong)
        for data in (b"", b"nothing", coded[:9]):
            with self.assertRaises(imgmesh.BadFileError):
                imgmesh.decode(data)

    def test_containers(self):
        grey = self.color[..., 1]
        wide = np.round(picture_files.ramp(48, 32) * 65535).astype(np.uint16)
        plain = self.check(self.png(self.color), self.color)
        self.assertNotEqual(self.check(self.png(wide), wide), plain)
        self.check(self.png(grey), grey, ("--faces", "60"), faces=60)
        self.check(self.png(self.hard), self.hard, ("--density", "5"), density=5)
        self.check(self.png(self.soft), self.soft, ("--density", "5"), density=np.float32(5))
        self.check(self.png(self.soft), self.soft, ("--alpha", "cut", "--alpha-threshold", "0.25"), alpha="cut",
                   alpha_threshold=0.25)
        self.check(self.png(self.soft), self.soft, ("--alpha", "ignore"), alpha="ignore")
        self.check(self.png(self.color), self.color, ("--density", "10", "--levels", "3"), density=10, levels=3)
        self.check(self.png(self.color), self.color, ("--level-faces", "90,30"), level_faces=np.array([90, 30]))
        self.check(self.png(self.color), self.color, ("--preset", "best", "--vertices", "40"), preset="best",
                   vertices=np.int64(40))
        self.check(self.png(self.color), self.color, ("--metric", "hoppe", "--visits", "--map", "trivial"),
                   metric="hoppe", visits=True, map="trivial")
        self.check(self.png(self.color), self.color, ("--texture",), texture="png")
        self.check(self.png(self.color[:1, :1]), self.color[:1, :1])
        self.check(self.png(self.color[:, :1]), self.color[:, :1])

    def test_a_mask(self):
        mask = np.hypot(*(np.mgrid[0:32, 0:48] - np.array([15, 22])[:, None, None])) < 12
        path = self.png(np.where(mask, 200, 0).astype(np.uint8), "mask.png")
        options = ("--mask", path, "--density", "6")
        for given in (path, imgmesh.read_image(path), mask, mask.astype(np.uint8) * 200):
            self.check(self.png(self.color), self.color, options, mask=given, density=6)

    def test_floats(self):
        linear = picture_files.ramp(48, 32).astype(np.float32) * 3
        imgmesh.write_image(self.folder / "in.exr", linear)  # an EXR of another program has attributes too
        self.check("in.exr", linear)
        self.check("in.exr", linear.astype(np.float64))
        imgmesh.write_image(self.folder / "half.exr", linear, dtype="float16")
        self.check("half.exr", linear.astype(np.float16))

    def test_channels_and_values(self):
        depth = np.linspace(0, 40, 32 * 48, dtype=np.float32).reshape(32, 48, 1)
        samples = np.concatenate([picture_files.ramp(48, 32).astype(np.float32), depth], axis=-1)
        names = ["R", "G", "B", "Z"]
        image = imgmesh.Image(samples, channel_names=names)
        imgmesh.write_image(self.folder / "in.exr", image)
        self.check("in.exr", image, ("--channels", "R,G,B,Z:0.5"), channels={"R": 1, "G": 1, "B": 1, "Z": 0.5})
        heights = (np.round(self.color[..., 0].astype(float) * 20)).astype(np.uint16)
        path = self.png(heights, "heights.png")
        self.run_ok("imgmesh-build", path, "-o", "tool.glb", "-q", "--values")
        for source in (path, heights, imgmesh.read_image(path, values=True)):
            mesh = imgmesh.build(source, values=True)
            self.assertEqual(self.write(mesh, "python.glb"), (self.folder / "tool.glb").read_bytes())

    def test_other_kinds_of_files(self):
        self.png(self.color)
        for name, option in (("a.gltf", "none"), ("b.glb", "sequential")):
            self.run_ok("imgmesh-build", "in.png", "-o", name, "-q", "--draco", option)
            tool = {p.name: p.read_bytes() for p in self.folder.glob(f"{name[0]}*")}
            mesh = imgmesh.build(self.color)
            mesh.write(self.folder / name, draco=option)
            self.assertEqual({p.name: p.read_bytes() for p in self.folder.glob(f"{name[0]}*")}, tool)

    def test_lean_and_plain_meshes(self):
        self.check(self.png(self.color), self.color, ("--mesh-precision", "compact", "--color-levels", "90"),
                   mesh_precision="compact", color_levels=90)
        self.check(self.png(self.color), self.color, ("--position-step", "1/4"), position_step="1/4")
        for options, parameters in (((), {}), (("--draco", "edgebreaker"), {"draco": "edgebreaker"})):
            self.run_ok("imgmesh-convert", "tool.glb", "-o", "plain.glb", "--no-map", "-q", "--overwrite", *options)
            mesh = imgmesh.read(self.folder / "tool.glb")
            self.assertEqual(self.write(mesh, "python.glb", no_map=True, **parameters),
                             (self.folder / "plain.glb").read_bytes())
        with self.assertRaisesRegex(imgmesh.BadFileError, "imgmesh-build without no-map"):
            imgmesh.read(self.folder / "plain.glb")

    def test_a_container_that_is_read_and_written(self):
        self.png(self.soft)
        self.run_ok("imgmesh-build", "in.png", "-o", "a.glb", "-q", "--texture", "--draco", "none")
        self.run_ok("imgmesh-convert", "a.glb", "-o", "b.glb", "-q")
        mesh = imgmesh.read(self.folder / "a.glb")
        self.assertEqual(self.write(mesh, "c.glb"), (self.folder / "b.glb").read_bytes())

    def test_drawings(self):
        self.png(self.hard)
        self.run_ok("imgmesh-build", "in.png", "-o", "a.glb", "-q", "--density", "8", "--levels", "2", "--visits")
        mesh = imgmesh.read(self.folder / "a.glb")
        for name, options, parameters in (
                ("a.png", (), {}), ("a.png", ("--level", "1"), {"level": 1}), ("a.exr", (), {"all_channels": True}),
                ("a.tif", ("--mode", "gouraud", "--scale", "1.5"), {"mode": "gouraud", "scale": 1.5}),
                ("a.png", ("--mode", "wire", "--scale", "2"), {"mode": "wire", "scale": 2}),
                ("a.png", ("--mode", "flat"), {"mode": "flat"}), ("a.png", ("--mode", "patches"), {"mode": "patches"}),
                ("a.png", ("--mode", "visits"), {"mode": "visits"})):
            with self.subTest(options):
                self.run_ok("imgmesh-reconstruct", "a.glb", "-o", name, "-q", *options)
                imgmesh.write_image(self.folder / f"python-{name}", mesh.reconstruct(**parameters))
                self.assertEqual((self.folder / f"python-{name}").read_bytes(), (self.folder / name).read_bytes())
        self.run_ok("imgmesh-reconstruct", "a.glb", "-o", "a.svg", "-q", "--mode", "wire")
        self.assertEqual(mesh.svg(), (self.folder / "a.svg").read_text())

    def test_smoothing(self):
        self.png(self.hard)
        self.run_ok("imgmesh-build", "in.png", "-o", "a.glb", "-q", "--density", "8", "--levels", "2")
        mesh = imgmesh.read(self.folder / "a.glb")
        for options, result in (((), mesh.smooth()), (("--strength", "20", "--level", "1"), mesh.smooth(20, level=1)),
                                (("--image", "in.png"), mesh.smooth(image=self.folder / "in.png"))):
            with self.subTest(options):
                self.run_ok("imgmesh-reconstruct", "a.glb", "-o", "a.png", "-q", "--mode", "smooth", *options)
                imgmesh.write_image(self.folder / "python.png", result)
                self.assertEqual((self.folder / "python.png").read_bytes(), (self.folder / "a.png").read_bytes())

    def test_segments(self):
        self.png(self.color)
        self.run_ok("imgmesh-build", "in.png", "-o", "a.glb", "-q", "--density", "10")
        mesh = imgmesh.read(self.folder / "a.glb")
        for options, parameters in (((), {}), (("--segments", "4"), {"segments": 4}),
                                    (("--superpixels", "9", "--compactness", "3"), {"superpixels": 9, "compactness": 3}),
                                    (("--image", "in.png", "--distance", "paper"), {"image": self.color, "distance": "paper"})):
            with self.subTest(options):
                self.run_ok("imgmesh-segment", "a.glb", "-o", "a.exr", "-q", "--flat", "flat.png", "--outlines", "lines.png",
                            "--colors", "colors.png", "--svg", "r.svg", "--keep", "2,2:5,3", "--drop", "40,20", "--mask", "mask.png", *options)
                result = mesh.segment(**parameters)
                result.write(self.folder / "python.exr")
                imgmesh.write_image(self.folder / "python-flat.png", result.flat())
                imgmesh.write_image(self.folder / "python-lines.png", result.outlines())
                imgmesh.write_image(self.folder / "python-colors.png", result.colors())
                self.assertEqual(result.svg(), (self.folder / "r.svg").read_text())
                mask = result.mask(keep=[[(2, 2), (5, 3)]], drop=[(40, 20)])
                self.assertEqual((mask.dtype, mask.shape), (bool, result.labels.shape))
                imgmesh.write_image(self.folder / "python-mask.png", mask.astype(np.uint8) * 255)
                for python, tool in (("python.exr", "a.exr"), ("python-flat.png", "flat.png"), ("python-lines.png", "lines.png"),
                                     ("python-colors.png", "colors.png"), ("python-mask.png", "mask.png")):
                    self.assertEqual((self.folder / python).read_bytes(), (self.folder / tool).read_bytes(), tool)
                self.assertEqual(len(np.unique(result.labels)), result.count)
                self.assertEqual([r["pixels"] for r in result.regions], np.bincount(result.labels.ravel()).tolist())

    def test_warps(self):
        self.png(self.color)
        self.run_ok("imgmesh-build", "in.png", "-o", "a.glb", "-q", "--density", "10")
        edits = [{"level": 0, "solver": "arap", "handles": [{"near": [24, 14], "move": [3, 1]}], "pins": [{"border": True}]}]
        (self.folder / "edits.json").write_text(json.dumps({"edits": edits}))
        mesh = imgmesh.read(self.folder / "a.glb")
        for options, parameters in ((("--edits", "edits.json"), {"edits": edits}),
                                    (("--edits", "edits.json"), {"edits": self.folder / "edits.json"}),
                                    (("--edits", "edits.json", "--size", "70x40"), {"edits": edits, "size": (70, 40)}),
                                    (("--handle", "24,14:3,1", "--solver", "injective"),
                                     {"edits": [{"solver": "injective", "handles": edits[0]["handles"]}]}),
                                    (("--retarget", "36x32"), {"retarget": (36, 32)})):
            with self.subTest(options):
                self.run_ok("imgmesh-warp", "a.glb", "--image", "in.png", "-o", "a.png", "-q", *options)
                imgmesh.write_image(self.folder / "python.png", mesh.warp(self.color, **parameters))
                self.assertEqual((self.folder / "python.png").read_bytes(), (self.folder / "a.png").read_bytes())
        self.run_ok("imgmesh-warp", "a.glb", "-o", "b.glb", "-q", "--edits", "edits.json")
        self.assertEqual(self.write(mesh.warp_mesh(edits), "python.glb"), (self.folder / "b.glb").read_bytes())
        far = [{"solver": "injective", "handles": [{"near": [24, 14], "move": [900, 0]}], "pins": [{"border": True}]}]
        for call in (lambda: mesh.warp(self.color, far), lambda: mesh.warp_mesh(far), lambda: mesh.displacement(far),
                     lambda: mesh.st_map(far)):
            with self.assertWarnsRegex(imgmesh.Warning, "^edits: level 0: a handle stays "):
                call()

    def test_comparison(self):
        self.png(self.color)
        self.run_ok("imgmesh-build", "in.png", "-o", "a.glb", "-q")
        told = self.report("imgmesh-compare", "in.png", "a.glb")["difference"]
        for b in (self.folder / "a.glb", imgmesh.read(self.folder / "a.glb"), imgmesh.read(self.folder / "a.glb").reconstruct()):
            found = imgmesh.compare(self.color, b)
            self.assertAlmostEqual(found.rms_luv, told["rms_luv"])
            self.assertAlmostEqual(np.sqrt(np.mean(found.luv.astype(float) ** 2)), found.rms_luv, places=5)

    def test_warnings_are_those_of_the_tool(self):
        path = self.png(self.soft)
        told = self.report("imgmesh-build", path, "-o", "a.glb", "--refine", "3")["warnings"]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            imgmesh.build(path, refine=3)
        self.assertEqual([str(w.message) for w in caught], [t.replace("--alpha cut", "alpha='cut'") for t in told])
        self.assertTrue(issubclass(caught[0].category, imgmesh.Warning))


if __name__ == "__main__":
    main()

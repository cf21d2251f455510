"""Mistakes: each is an exception of its kind, with one line that says what was found and what was expected."""
import pathlib
import tempfile
import unittest
import warnings

import numpy as np
from PIL import Image

import imgmesh
import picture_files

IMAGE = np.round(picture_files.ramp(24, 16) * 255).astype(np.uint8)


class Errors(unittest.TestCase):
    def check(self, kind, words, function, *args, **kwargs):
        with self.subTest(words):
            with self.assertRaises(kind) as caught:
                function(*args, **kwargs)
            text = str(caught.exception)
            for word in words:
                self.assertIn(word, text)
            self.assertNotIn("\n", text)
            self.assertNotIn("--", text)

    def test_arguments_of_build(self):
        build = imgmesh.build
        self.check(TypeError, ("no parameter 'face'", "did you mean 'faces'?"), build, IMAGE, face=3)
        self.check(TypeError, ("no parameter 'xyz'",), build, IMAGE, xyz=3)
        self.check(TypeError, ("faces: expected a whole number, found 2.5",), build, IMAGE, faces=2.5)
        self.check(TypeError, ("faces: expected a whole number, found '9'",), build, IMAGE, faces="9")
        self.check(TypeError, ("channels: expected a list",), build, IMAGE, channels="RGB")
        self.check(TypeError, ("progress: expected a callable",), build, IMAGE, progress=3)
        for name in "nodata", "max_pixels", "threads", "alpha", "texture", "color_space", "strict", "part", "preset":
            self.check(TypeError, (f"{name}: ", "found []"), build, IMAGE, **{name: []})
        self.assertEqual(build(IMAGE, max_pixels=384).width, 24)
        self.check(imgmesh.ArgumentError, ("max_pixels=383",), build, imgmesh.Image(IMAGE), max_pixels=383)
        for words, parameters in ((("faces is 1", "at least 2"), {"faces": 1}),
                                  (("metric 'x'", "flattened, hoppe, garland"), {"metric": "x"}),
                                  (("density is nan",), {"density": float("nan")}),
                                  (("density and faces", "one of them"), {"density": 3, "faces": 9}),
                                  (("threads is 0", "1 to 1024"), {"threads": 0}),
                                  (("alpha 'x'", "auto, keep, cut, ignore"), {"alpha": "x"}),
                                  (("alpha_threshold is 2",), {"alpha_threshold": 2}),
                                  (("preset 'nope': expected one of fast, default, best, max, small, fem",), {"preset": "nope"}),
                                  (("max_pixels is 0",), {"max_pixels": 0}), (("max_pixels is -1",), {"max_pixels": -1}),
                                  (("24x16", "max_pixels=383"), {"max_pixels": 383}),
                                  (("level_faces is 1",), {"level_faces": [9, 1]}),
                                  (("color_space 'x'", "sRGB"), {"color_space": "x"}),
                                  (("values=True and texture",), {"values": True, "texture": "png"})):
            self.check(imgmesh.ArgumentError, words, build, IMAGE, **parameters)

    def test_arrays(self):
        for words, array in ((("int32", "uint8"), IMAGE.astype(np.int32)), (("bool",), IMAGE > 3),
                             (("complex",), IMAGE.astype(complex)), (("(24,)",), IMAGE[0, :, 0]),
                             (("5 channels", "channel_names"), np.zeros((4, 4, 5), np.uint8)),
                             (("(0, 3)",), np.zeros((0, 3), np.uint8)), (("(1, 70000)", "65535"), np.zeros((1, 70000), np.uint8)),
                             (("object",), np.array([[None]])), (("shape ()",), np.array(3, np.uint8))):
            self.check(imgmesh.ArgumentError, ("image: ", *words), imgmesh.build, array)
        bad = picture_files.ramp(24, 16)
        bad[3, 5, 1] = np.nan
        self.check(imgmesh.BadFileError, ("channel G of pixel (5, 3)", "not a finite number"), imgmesh.build, bad)
        with np.errstate(over="ignore"):
            self.check(imgmesh.BadFileError, ("channel R of pixel (0, 0)",), imgmesh.build, np.full((4, 4, 3), 1e300))
        self.check(imgmesh.BadFileError, ("the mask is 3x2", "24x16"), imgmesh.build, IMAGE, mask=np.ones((2, 3), bool))
        self.check(imgmesh.UnsupportedError, ("mask: no pixel is inside",), imgmesh.build, IMAGE,
                   mask=np.zeros((16, 24), bool))
        self.check(imgmesh.UnsupportedError, ("image: no pixel is inside", "alpha='ignore'"), imgmesh.build,
                   np.zeros((4, 4, 4), np.uint8), alpha="cut")
        palette = Image.fromarray(IMAGE).quantize(8)
        self.check(imgmesh.ArgumentError, ("mode P", "convert('RGB')"), imgmesh.build, palette)
        self.assertEqual(imgmesh.build(palette.convert("RGB")).width, 24)
        self.check(imgmesh.ArgumentError, ("masked", "mask=~array.mask"), imgmesh.build, np.ma.masked_less(IMAGE[..., 0], 9))
        self.check(imgmesh.ArgumentError, ("masked",), imgmesh.Image, np.ma.masked_less(IMAGE[..., 0], 9))
        self.check(imgmesh.ArgumentError, ("2 names",), imgmesh.Image, IMAGE, channel_names=["a", "b"])
        self.check(imgmesh.ArgumentError, ("values=True where it is read",), imgmesh.build, imgmesh.Image(IMAGE), values=True)

    def test_channel_names(self):
        for words, names in ((("0 bytes",), ["", "a", "b"]), (("byte of value 0",), ["a\0b", "b", "c"]),
                             (("256 bytes",), ["x" * 256, "a", "b"]), (("two channels", "G"), ["R", "G", "G"])):
            for values in False, True:
                self.check(imgmesh.ArgumentError, words, imgmesh.Image, IMAGE, channel_names=names, values=values)
        for names in ["R", "G", "A"], ["a", "b", "c"]:
            image = imgmesh.Image(IMAGE, channel_names=names)
            self.check(imgmesh.UnsupportedError, ("no colour", ", ".join(names)), imgmesh.build, image)
            self.assertEqual(imgmesh.build(image, channels=names[:2]).channel_names, tuple(names[:2]))

    def test_edits(self):
        mesh, own, deep = imgmesh.build(IMAGE), [], []
        own.append(own)
        for _ in range(100000):
            deep = [deep]
        for edits in own, deep, [{"handles": own}], {"edits": deep}:
            self.check(imgmesh.ArgumentError, ("edits: ",), mesh.warp, IMAGE, edits)
        self.check(TypeError, ("edits: ", "found {3}"), mesh.warp, IMAGE, [{"handles": {3}}])
        edit = {"level": 0, "handles": [{"near": [12, 8], "move": [3, 1]}], "pins": [{"border": True}]}
        numbers = {"level": np.int64(0), "handles": [{"near": np.array([12, 8]), "move": (np.float32(3), np.uint8(1))}],
                   "pins": [{"border": np.bool_(True)}]}
        np.testing.assert_array_equal(mesh.warp(IMAGE, [numbers]).array, mesh.warp(IMAGE, [edit]).array)

    def test_odd_paths(self):
        mesh = imgmesh.build(IMAGE)
        for path in "a.glb\0x", b"a.glb\0x", pathlib.Path("a.glb\0x"):
            for function in (imgmesh.build, imgmesh.read_image, imgmesh.read, mesh.write, mesh.segment().write,
                             lambda path: imgmesh.write_image(path, IMAGE), lambda path: mesh.warp(IMAGE, path)):
                self.check(ValueError, ("a.glb\\x00x", "byte of value 0"), function, path)
        for path, shown in (b"/nowhere/\xff.glb", "/nowhere/\\xff.glb"), ("/nowhere/a\nb.glb", "/nowhere/a\\x0ab.glb"):
            for function in imgmesh.read, imgmesh.read_image, mesh.write:
                self.check(imgmesh.FileError, (shown,), function, path)

    def test_what_is_written(self):
        mesh = imgmesh.build(IMAGE)
        with tempfile.TemporaryDirectory() as name:
            for file in "mesh.glb", "mesh.gltf":
                written, facts = mesh.write(f"{name}/{file}"), imgmesh.read(f"{name}/{file}").facts
                self.assertEqual(set(written), {"files", "mesh_bytes", "layer_bytes"})
                self.assertEqual(written, {key: facts[key] for key in written})

    def test_files(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for function in (imgmesh.build, imgmesh.read_image, imgmesh.read):
                self.check(OSError, ("nothing.png",), function, folder / "nothing.png")
            (folder / "text.png").write_text("no image")
            self.check(imgmesh.BadFileError, ("text.png",), imgmesh.read_image, folder / "text.png")
            self.check(imgmesh.BadFileError, ("text.png",), imgmesh.read, folder / "text.png")
            mesh = imgmesh.build(IMAGE)
            self.check(imgmesh.ArgumentError, ("mesh.txt",), mesh.write, folder / "mesh.txt")
            mesh.write(folder / "mesh.glb")
            self.check(imgmesh.FileError, ("mesh.glb",), mesh.write, folder / "mesh.glb", overwrite=False)
            self.check(imgmesh.FileError, ("no/mesh.glb",), mesh.write, folder / "no/mesh.glb")
            self.check(imgmesh.ArgumentError, ("a.xyz",), imgmesh.write_image, folder / "a.xyz", IMAGE)
            self.check(TypeError, ("found a path",), imgmesh.write_image, folder / "a.png", folder / "b.png")
            imgmesh.write_image(str(folder / "\udcff.png"), IMAGE)  # a name that is no UTF-8
            self.assertEqual(imgmesh.build(str(folder / "\udcff.png")).width, 24)
            self.check(TypeError, ("read_image() has no parameter 'valus'", "'values'"), imgmesh.read_image,
                       folder / "a.png", valus=True)

    def test_work_on_a_mesh(self):
        mesh = imgmesh.build(IMAGE)
        self.check(imgmesh.ArgumentError, ("level is 3", "levels 0 to 0"), mesh.reconstruct, level=3)
        self.check(imgmesh.ArgumentError, ("level is -1",), mesh.reconstruct, level=-1)
        self.check(imgmesh.ArgumentError, ("strength is -1",), mesh.smooth, -1)
        self.check(imgmesh.ArgumentError, ("level is 3",), mesh.smooth, level=3)
        self.check(imgmesh.ArgumentError, ("mode 'x'", "gouraud"), mesh.reconstruct, mode="x")
        self.check(imgmesh.ArgumentError, (), mesh.reconstruct, scale=2)
        self.check(imgmesh.UnsupportedError, ("visit",), mesh.reconstruct, mode="visits")
        self.check(imgmesh.ArgumentError, ("threshold and segments",), mesh.segment, threshold=3, segments=2)
        self.check(imgmesh.UnsupportedError, ("1000000 regions were wanted",), mesh.segment, segments=10 ** 6, strict=True)
        regions = mesh.segment()
        self.check(imgmesh.ArgumentError, ("no seed",), regions.mask)
        self.check(imgmesh.ArgumentError, ("keep (24, 3)", "outside the image"), regions.mask, keep=[(24, 3)])
        self.check(imgmesh.ArgumentError, ("drop (1, 1), (-1, 3)", "-1,3"), regions.mask, drop=[[(1, 1), (-1, 3)]])
        self.check(imgmesh.UnsupportedError, ("keep (1, 1) and drop (1, 1)",), regions.mask, keep=[(1, 1)], drop=[(1, 1)])
        self.check(imgmesh.BadFileError, ("24x16",), mesh.warp, IMAGE[:8], [])
        self.check(imgmesh.BadFileError, ("edits: /edits/0",), mesh.warp, IMAGE, [{"handels": []}])
        self.check(imgmesh.ArgumentError, ("size and retarget",), mesh.warp, IMAGE, size=(3, 3), retarget=(3, 3))
        self.check(imgmesh.ArgumentError, (), imgmesh.compare, IMAGE, IMAGE[:8])

    def test_warnings_may_be_errors(self):
        soft = np.dstack([IMAGE, np.tile(np.linspace(0, 255, 24).astype(np.uint8), (16, 1))])
        with warnings.catch_warnings():
            warnings.simplefilter("error", imgmesh.Warning)
            with self.assertRaises(imgmesh.Warning):
                imgmesh.build(soft, refine=2)

    def test_what_is_not_reached(self):
        with self.assertWarnsRegex(imgmesh.Warning, "image: 5000 faces were wanted"):
            mesh = imgmesh.build(IMAGE, faces=5000)
        self.assertEqual(len(mesh.report["missed"]), 1)
        self.assertEqual(imgmesh.build(IMAGE).report["missed"], [])
        self.check(imgmesh.UnsupportedError, ("5000 faces were wanted",), imgmesh.build, IMAGE, faces=5000, strict=True)
        with self.assertWarnsRegex(imgmesh.Warning, "9999 regions were wanted"):
            self.assertIn("9999 regions", mesh.segment(segments=9999).missed)
        self.assertEqual(mesh.segment().missed, "")

    def test_no_object_is_without_its_value(self):
        for kind in (imgmesh.Comparison, imgmesh.Image, imgmesh.Level, imgmesh.Mesh, imgmesh.Segmentation):
            for make in (kind, lambda: kind.__new__(kind), lambda: kind.__base__.__new__(kind), lambda: object.__new__(kind),
                         lambda: type("Other", (kind,), {})):
                with self.subTest(kind), self.assertRaises(TypeError):
                    make()

    def test_the_kinds(self):
        for kind, base in ((imgmesh.ArgumentError, ValueError), (imgmesh.FileError, OSError),
                           (imgmesh.BadFileError, ValueError), (imgmesh.UnsupportedError, ValueError),
                           (imgmesh.OutOfMemoryError, MemoryError), (imgmesh.InternalError, RuntimeError)):
            self.assertTrue(issubclass(kind, base) and issubclass(kind, imgmesh.Error))
            self.assertEqual(kind.__module__, "imgmesh")


if __name__ == "__main__":
    unittest.main()

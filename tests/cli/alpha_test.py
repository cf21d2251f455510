"""Soft alpha through the whole chain, and sprites to the outer edge of their pixels."""
import json

import numpy as np
from PIL import Image

import picture_files
from support import CliCase, main
from texture_test import asset, texture_of


def attribute(path, name):
    document, buffer = asset(path)
    accessor = document["accessors"][document["meshes"][0]["primitives"][0]["attributes"][name]]
    view = document["bufferViews"][accessor["bufferView"]]
    width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    kind = {5123: "<u2", 5126: "<f4"}[accessor["componentType"]]
    return np.frombuffer(buffer, kind, accessor["count"] * width, view.get("byteOffset", 0)).reshape(-1, width)


def area_of(points, triangles):
    a, b, c = (points[[t[i] for t in triangles]] for i in range(3))
    return np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]).sum() / 2


class Alpha(CliCase):
    def setUp(self):
        super().setUp()
        y, x = np.mgrid[0:32, 0:48]
        self.alpha = np.round(np.clip(1.6 - np.hypot(x - 22, y - 15) / 10, 0, 1) * 255) / 255
        self.color = np.round(picture_files.ramp(48, 32) * 255) / 255
        self.soft = np.concatenate([self.color, self.alpha[..., None]], axis=-1)
        picture_files.png(self.folder / "soft.png", self.soft)

    def drawn(self, container, name="drawn.png", *args):
        self.run_ok("imgmesh-reconstruct", container, "-o", name, "-q", "--overwrite", *args)
        return picture_files.read(self.folder / name)

    def test_soft_alpha_is_kept_by_itself(self):
        built = self.build("soft.png", "--density", "100")
        self.assertEqual((built["alpha"], built["pixels"]), ("kept", (self.alpha > 0).sum()))
        self.assertLess(built["channel_rms"]["A"], 0.002)
        self.assertEqual(self.report("imgmesh-info", "out.glb", "--validate")["findings"], [])
        difference = self.report("imgmesh-compare", "soft.png", "out.glb", "--tolerance", "0.5")["difference"]
        self.assertEqual(difference["in_one_only"], 0)
        for name in ("a.png", "a.tif", "a.webp"):
            self.drawn("out.glb", name)
            image = np.asarray(Image.open(self.folder / name)) / 255  # not by OpenImageIO, which multiplies alpha in
            np.testing.assert_allclose(image[..., 3], self.alpha, atol=0.006, err_msg=name)
            visible = self.alpha > 0
            np.testing.assert_allclose(image[visible][:, :3], self.color[visible], atol=0.01, err_msg=name)
        self.run_ok("imgmesh-compare", "a.png", "a.webp", "--tolerance", "0")
        self.run_ok("imgmesh-compare", "a.png", "a.tif", "--tolerance", "0")
        self.drawn("out.glb", "a.exr")
        self.run_ok("imgmesh-compare", "a.png", "a.exr", "--tolerance", "0.5")

    def test_every_drawing_of_the_mesh_has_it(self):
        self.build("soft.png", "--density", "30")
        for mode, most in (("map", 0.02), ("gouraud", 0.03), ("flat", 0.06)):
            error = self.drawn("out.glb", f"{mode}.png", "--mode", mode)[..., 3] - self.alpha
            self.assertLess(np.sqrt(np.mean(error ** 2)), most, mode)
        patches = self.drawn("out.glb", "patches.png", "--mode", "patches")[..., 3]
        self.assertEqual(set(np.unique(patches)), {0, 1})
        self.assert_error("imgmesh-reconstruct", ["out.glb", "-o", "x.jpg"], 2, "x.jpg")

    def test_viewers_blend_it(self):
        self.build("soft.png", "--density", "20", "--draco", "none")
        document, _ = asset(self.folder / "out.glb")
        self.assertEqual(document["materials"][0]["alphaMode"], "BLEND")
        codes = attribute(self.folder / "out.glb", "COLOR_0")[:, 3]
        exact = attribute(self.folder / "out.glb", "_CHANNEL_A")[:, 0]
        np.testing.assert_allclose(codes, exact.astype(float) * 65535, atol=0.51)
        self.assertTrue(((exact >= 0) & (exact <= 1)).all())
        self.assertGreater(((exact > 0.2) & (exact < 0.8)).sum(), 5)
        self.build("soft.png", "--density", "20", "--texture", output="t.glb")
        self.assertEqual(asset(self.folder / "t.glb")[0]["materials"][0]["alphaMode"], "BLEND")
        texture = texture_of(self.folder / "t.glb")
        np.testing.assert_array_equal(texture[..., 3], np.round(self.alpha * 255))
        np.testing.assert_array_equal(texture[self.alpha > 0][:, :3], np.round(self.color[self.alpha > 0] * 255))
        self.run_ok("imgmesh-convert", "out.glb", "-o", "c.glb", "--texture", "--image", "soft.png", "-q")
        np.testing.assert_array_equal(texture_of(self.folder / "c.glb"), texture)
        self.run_ok("imgmesh-convert", "out.glb", "-o", "d.glb", "--texture", "-q")
        np.testing.assert_allclose(texture_of(self.folder / "d.glb")[..., 3], 255 * self.alpha, atol=12)
        for name in ("t.glb", "c.glb", "d.glb"):
            self.assertEqual(self.report("imgmesh-info", name, "--validate")["findings"], [], name)

    def test_choices(self):
        for value, use, channels, pixels in (("keep", "kept", 4, self.alpha > 0), ("cut", "cut", 3, self.alpha >= 0.5),
                                             ("ignore", "ignored", 3, self.alpha >= 0)):
            built = self.build("soft.png", "--alpha", value)
            self.assertEqual((built["alpha"], built["pixels"]), (use, pixels.sum()))
            self.assertEqual(len(self.report("imgmesh-info", "out.glb")["channels"]), channels)
        self.assertEqual(self.build("soft.png", "--alpha-threshold", "0.25")["pixels"], (self.alpha >= 0.25).sum())
        # Who names the channels, names alpha as well, or does without.
        self.assertEqual(self.build("soft.png", "--channels", "R,G,B")["alpha"], "cut")
        self.assertEqual(self.build("soft.png", "--channels", "R,G,B,A:20")["alpha"], "kept")
        self.assertEqual(self.build("soft.png", "--channels", "R,G,B", "--alpha", "keep")["alpha"], "kept")
        picture_files.png(self.folder / "mask.png", np.ones((32, 48, 1)) * (np.arange(48) < 30)[None, :, None])
        self.assertEqual(self.build("soft.png", "--mask", "mask.png")["alpha"], "ignored")
        built = self.build("soft.png", "--mask", "mask.png", "--alpha", "keep")
        self.assertEqual((built["alpha"], built["pixels"]), ("kept", 30 * 32))

    def test_refinement_gives_way_with_a_warning(self):
        report = self.report("imgmesh-build", "soft.png", "-o", "out.glb", "--preset", "best")
        self.assertEqual(report["images"][0]["alpha"], "kept")
        self.assertEqual(len(report["warnings"]), 1)
        self.assertIn("soft.png", report["warnings"][0])
        self.assert_error("imgmesh-build", ["soft.png", "-o", "x.glb", "--preset", "best", "--alpha", "keep"], 5, "soft.png")

    def test_binary_alpha_is_cut_as_ever(self):
        """Also with the noise that lossy formats leave around 0 and 1."""
        hard = self.soft.copy()
        hard[..., 3] = self.alpha >= 0.5
        noisy = hard.copy()
        noisy[..., 3] += np.where(hard[..., 3] > 0, -1, 1) * (np.indices((32, 48)).sum(0) % 2) / 255
        for name, samples in (("hard", hard), ("noisy", noisy)):
            picture_files.png(self.folder / f"{name}.png", samples)
            self.assertEqual(self.build(f"{name}.png", output=f"{name}.glb")["alpha"], "cut")
            self.build(f"{name}.png", "--alpha", "cut", output="cut.glb")
            self.assertEqual((self.folder / f"{name}.glb").read_bytes(), (self.folder / "cut.glb").read_bytes())
        document, _ = asset(self.folder / "hard.glb")
        self.assertNotIn("alphaMode", document["materials"][0])

    def test_what_nobody_sees_counts_for_nothing(self):
        self.build("soft.png", output="a.glb")
        other = self.soft.copy()
        other[self.alpha == 0, :3] = 1 - other[self.alpha == 0, :3]
        picture_files.png(self.folder / "other.png", other)
        self.build("other.png", output="b.glb")
        self.assertEqual((self.folder / "a.glb").read_bytes(), (self.folder / "b.glb").read_bytes())

    def test_images_without_an_opaque_pixel(self):
        for level in (1, 2, 100):
            faint = self.soft.copy()
            faint[..., 3] = (self.alpha > 0) * level / 255
            picture_files.png(self.folder / "faint.png", faint)
            built = self.build("faint.png", "--density", "100")
            self.assertEqual((built["alpha"], built["pixels"]), ("kept", (self.alpha > 0).sum()))
            np.testing.assert_allclose(self.drawn("out.glb")[..., 3], faint[..., 3], atol=1e-6)

    def test_premultiplied_sources(self):
        """An EXR's colours are multiplied by alpha: the mesh has them divided out, and writes them multiplied again."""
        light = np.where(self.color <= 0.04045, self.color / 12.92, ((self.color + 0.055) / 1.055) ** 2.4)
        samples = np.concatenate([light * self.alpha[..., None], self.alpha[..., None]], axis=-1)
        picture_files.write_float(self.folder / "soft.exr", samples, names=["R", "G", "B", "A"])
        self.assertEqual(self.build("soft.exr", "--density", "100")["alpha"], "kept")
        self.run_ok("imgmesh-compare", "soft.png", "out.glb", "--tolerance", "0.5")
        self.drawn("out.glb", "back.exr")
        self.run_ok("imgmesh-compare", "soft.exr", "back.exr", "--tolerance", "0.5")
        np.testing.assert_allclose(picture_files.read(self.folder / "back.exr")[..., :3], samples[..., :3], atol=0.01)


class Sprites(CliCase):
    def setUp(self):
        super().setUp()
        samples = np.ones((64, 64, 4)) * np.array([0.2, 0.6, 0.8, 1])
        inside = np.zeros((64, 64))
        inside[16:48, 12:52] = 1
        samples[..., 3] = inside
        picture_files.png(self.folder / "sprite.png", samples)

    def test_textured_meshes_are_as_large_as_their_pixels(self):
        self.build("sprite.png", "--texture", "--draco", "none", output="t.glb")
        self.build("sprite.png", "--draco", "none", output="plain.glb")
        self.run_ok("imgmesh-convert", "plain.glb", "-o", "c.glb", "--texture", "--image", "sprite.png", "-q")
        self.run_ok("imgmesh-convert", "plain.glb", "-o", "bare.glb", "--no-layers", "-q")
        for name in ("t.glb", "c.glb", "bare.glb"):
            place = attribute(self.folder / name, "POSITION")[:, :2] * [1, -1]
            self.assertEqual((place.min(axis=0).tolist(), place.max(axis=0).tolist()), ([11.5, 15.5], [51.5, 47.5]))
        for name in ("t.glb", "c.glb"):
            coords = attribute(self.folder / name, "TEXCOORD_0") * 64
            self.assertEqual((coords.min(axis=0).tolist(), coords.max(axis=0).tolist()), ([12, 16], [52, 48]))
            self.assertEqual(self.report("imgmesh-info", name, "--validate")["findings"], [])
            self.run_ok("imgmesh-compare", "sprite.png", name, "--tolerance", "0.5")
        place = attribute(self.folder / "plain.glb", "POSITION")[:, :2] * [1, -1]
        self.assertEqual((place.min(axis=0).tolist(), place.max(axis=0).tolist()), ([12, 16], [51, 47]))
        # What covers its pixels already is not moved again.
        self.run_ok("imgmesh-convert", "t.glb", "-o", "again.glb", "--texture", "-q", "--draco", "none")
        self.assertTrue((attribute(self.folder / "again.glb", "POSITION") == attribute(self.folder / "t.glb", "POSITION")).all())

    def test_exports(self):
        self.build("sprite.png", output="s.glb")
        self.run_ok("imgmesh-convert", "s.glb", "-o", "s.json", "-q")
        frame = json.loads((self.folder / "s.json").read_text())["frames"]["s.png"]
        self.assertEqual(area_of(np.array(frame["vertices"]), frame["triangles"]), 40 * 32)
        self.run_ok("imgmesh-convert", "s.glb", "-o", "s.obj", "-q")
        lines = [line.split() for line in (self.folder / "s.obj").read_text().splitlines()]
        points = np.array([[float(i) for i in line[1:3]] for line in lines if line[0] == "v"])
        coords = np.array([[float(i) for i in line[1:3]] for line in lines if line[0] == "vt"])
        faces = [[int(i.split("/")[0]) - 1 for i in line[1:]] for line in lines if line[0] == "f"]
        self.assertEqual(area_of(points, faces), 40 * 32)
        self.assertAlmostEqual(area_of(coords, faces), 40 * 32 / 64 ** 2)
        self.run_ok("imgmesh-convert", "s.glb", "-o", "s.svg", "-q")
        for corner in ("11.5 15.5", "51.5 15.5", "11.5 47.5", "51.5 47.5"):
            self.assertIn(corner, (self.folder / "s.svg").read_text())

    def test_whole_images_span_their_width_and_height(self):
        picture_files.png(self.folder / "whole.png", picture_files.ramp(40, 30))
        self.build("whole.png", "--texture", "--draco", "none", output="w.glb")
        place = attribute(self.folder / "w.glb", "POSITION")[:, :2] * [1, -1]
        self.assertEqual((place.min(axis=0).tolist(), place.max(axis=0).tolist()), ([-0.5, -0.5], [39.5, 29.5]))
        self.assertEqual((attribute(self.folder / "w.glb", "TEXCOORD_0").min(), attribute(self.folder / "w.glb", "TEXCOORD_0").max()), (0, 1))
        self.assertEqual(self.report("imgmesh-info", "w.glb", "--validate")["findings"], [])
        self.build("whole.png", output="plain.glb")
        # Through the map nothing changes.
        a, b = (self.report("imgmesh-compare", "whole.png", n)["difference"] for n in ("w.glb", "plain.glb"))
        self.assertAlmostEqual(a["rms_luv"], b["rms_luv"], places=4)

    def test_outlines(self):
        """A round sprite in few triangles: all of it inside, or near it on both sides."""
        y, x = np.mgrid[0:64, 0:64]
        samples = np.ones((64, 64, 4)) * np.array([0.9, 0.3, 0.1, 1])
        samples[..., 3] = np.hypot(x - 31.5, y - 31.5) < 30
        picture_files.png(self.folder / "round.png", samples)
        self.build("round.png", output="r.glb")
        pixels = samples[..., 3].sum()
        areas = {}
        for side in ("out", "both"):
            report = self.report("imgmesh-convert", "r.glb", "-o", "r.json", "--outline-tolerance", "2", "--outline-side", side)
            self.assertLessEqual(report["faces"], 50)
            (frame,) = json.loads((self.folder / "r.json").read_text())["frames"].values()
            self.assertEqual(len(frame["triangles"]), report["faces"])
            areas[side] = area_of(np.array(frame["vertices"]), frame["triangles"])
        self.assertTrue(pixels < areas["out"] < 1.15 * pixels, areas)
        self.assertTrue(0.95 * pixels < areas["both"] < areas["out"], areas)
        self.run_ok("imgmesh-convert", "r.glb", "-o", "r.obj", "--outline-tolerance", "2", "-q")
        report = self.report("imgmesh-convert", "r.glb", "-o", "t.glb", "--outline-tolerance", "2", "--texture", "--image",
                             "round.png", "--draco", "none")
        self.assertEqual((report["layers"], report["texture"], report["levels"]), (False, True, 1))
        place = attribute(self.folder / "t.glb", "POSITION")[:, :2] * [1, -1]
        np.testing.assert_allclose(attribute(self.folder / "t.glb", "TEXCOORD_0"), (place + 0.5) / 64, atol=1e-6)
        np.testing.assert_array_equal(texture_of(self.folder / "t.glb")[..., 3], samples[..., 3] * 255)
        # A texture that is there already stays.
        self.build("round.png", "--texture", output="k.glb")
        self.run_ok("imgmesh-convert", "k.glb", "-o", "l.glb", "--outline-tolerance", "2", "--draco", "none", "-q")
        self.assertTrue((attribute(self.folder / "l.glb", "POSITION") == attribute(self.folder / "t.glb", "POSITION")).all())

    def test_outlines_wrongly_used(self):
        self.build("sprite.png", output="s.glb")
        for args, code, *words in ((["-o", "x.svg", "--outline-tolerance", "1"], 2, "--outline-tolerance", "x.svg"),
                                   (["-o", "x.glb", "--outline-tolerance", "1"], 2, "--texture"),
                                   (["-o", "x.glb", "--outline-tolerance", "1", "--no-texture"], 2, "--no-texture"),
                                   (["-o", "x.glb", "--texture", "--levels", "0", "--outline-tolerance", "1"], 2, "--levels"),
                                   (["-o", "x.json", "--outline-tolerance", "-1"], 2, "'-1'"),
                                   (["-o", "x.json", "--outline-side", "both"], 2, "--outline-tolerance")):
            self.assert_error("imgmesh-convert", ["s.glb", *args], code, *words)


if __name__ == "__main__":
    main()

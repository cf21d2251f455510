#!/usr/bin/env python3
"""Auxiliary channels and HDR, from image to container and back."""
import numpy as np

import picture_files as files
from support import CliCase, main

NAMES = ["R", "G", "B", "depth.Z"]


def with_depth(width=48, height=36):
    """Smooth colour, and a depth with an oblique step."""
    y, x = np.mgrid[0:height, 0:width]
    depth = np.where(2 * x + y < 60, 1.0, 3.0)
    return np.dstack([0.2 + 0.004 * x, 0.3 + 0.003 * y, 0.4 + 0 * x, depth])


def channel(path, name):
    return files.read(path)[:, :, files.spec(path).channelnames.index(name)]


class Channels(CliCase):
    def scene(self, samples=None, names=NAMES, name="scene.exr", sample_type="float"):
        return files.write_float(self.folder / name, with_depth() if samples is None else samples, sample_type,
                                 names)

    def test_depth_there_and_back(self):
        scene = self.scene()
        built = self.build(scene, "--channels", "R,G,B,depth.Z:40", "--vertices", 60)
        self.assertLess(built["channel_rms"]["depth.Z"], 0.1)
        self.assertFalse(built["has_light"])
        info = self.report("imgmesh-info", "out.glb")
        self.assertEqual(info["channels"], NAMES)
        self.assertEqual(info["build"]["channels"], "R,G,B,depth.Z:40")
        self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "again.exr")
        self.assertEqual(sorted(files.spec(self.folder / "again.exr").channelnames), sorted(NAMES))
        depth = channel(self.folder / "again.exr", "depth.Z") - channel(scene, "depth.Z")
        self.assertAlmostEqual(np.sqrt(np.mean(depth ** 2)), built["channel_rms"]["depth.Z"], places=4)
        self.run_ok("imgmesh-segment", "out.glb", "-o", "labels.png", "--mesh", "regions.glb")
        self.run_ok("imgmesh-convert", "out.glb", "-o", "plain.gltf", "--draco", "none")
        self.run_ok("imgmesh-reconstruct", "plain.gltf", "-o", "other.exr")
        self.assertEqual((self.folder / "other.exr").read_bytes(), (self.folder / "again.exr").read_bytes())
        # A colour format gets the colour.
        self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "again.png")
        self.assertEqual(list(files.spec(self.folder / "again.png").channelnames), ["R", "G", "B"])
        compared = self.report("imgmesh-compare", scene, "out.glb")["difference"]
        self.assertAlmostEqual(compared["channels"]["depth.Z"]["rms"], built["channel_rms"]["depth.Z"], places=4)
        self.assertLess(compared["rms_luv"], 1)
        self.assertIn("depth.Z", self.run_ok("imgmesh-compare", scene, "again.exr").stdout)

    def test_colour_alone_is_the_default(self):
        self.build(self.scene())
        self.assertEqual(self.report("imgmesh-info", "out.glb")["channels"], ["R", "G", "B"])
        self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "again.exr")
        self.assertNotIn("depth.Z", files.spec(self.folder / "again.exr").channelnames)

    def test_no_colour(self):
        scene = self.scene()
        self.assert_error("imgmesh-build", [self.scene(with_depth()[:, :, 3:], ["depth.Z"], "z.exr"), "-o", "x.glb"], 5,
                          "depth.Z")
        self.build(scene, "--channels", "depth.Z:40", "--vertices", 30, "--draco", "none", output="out.gltf")
        for mode in ("map", "gouraud"):
            self.run_ok("imgmesh-reconstruct", "out.gltf", "-o", f"{mode}.exr", "--mode", mode)
            self.assertEqual(list(files.spec(self.folder / f"{mode}.exr").channelnames), ["depth.Z"])
            self.assertAlmostEqual(float(channel(self.folder / f"{mode}.exr", "depth.Z")[2, 2]), 1, delta=0.1)
        for output, mode in (("x.png", "map"), ("x.exr", "wire"), ("x.svg", "flat")):
            self.assert_error("imgmesh-reconstruct", ["out.gltf", "-o", output, "--mode", mode], 5, "out.gltf",
                              "depth.Z")
        self.assert_error("imgmesh-compare", [scene, "out.gltf"], 5, "no colour")
        self.assert_error("imgmesh-convert", ["out.gltf", "-o", "x.ply"], 5, "out.gltf", "no colour")
        self.assert_error("imgmesh-segment", ["out.gltf", "-o", "x.png"], 5, "out.gltf", "no colour")
        self.run_ok("imgmesh-compare", "out.gltf")
        self.run_ok("imgmesh-info", "out.gltf", "--validate")

    def test_numbers_of_channels_and_small_pictures(self):
        for count, size in ((1, (9, 7)), (2, (1, 1)), (7, (1, 9)), (16, (12, 10))):
            with self.subTest(count=count, size=size):
                names = [f"band.{c:02}" for c in range(count)]
                picture = self.scene(100 * files.noise(*size, count), names, f"{count}.exr")
                self.build(picture, "--channels", ",".join(names), "--vertices", 1000)
                self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "again.exr")
                # Every pixel is a vertex.
                np.testing.assert_allclose(files.read(self.folder / "again.exr"), files.read(picture), atol=1.5)

    def test_grey_and_alpha_as_channels(self):
        samples = np.dstack([files.ramp(30, 20)[:, :, 0], np.linspace(0.5, 1, 600).reshape(20, 30)])
        picture = files.png(self.folder / "grey.png", samples)
        self.build(picture, "--channels", "Y,A:100", "--density", 20)
        self.assertEqual(self.report("imgmesh-info", "out.glb")["channels"], ["Y", "A"])
        self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "again.exr")
        self.assertEqual(sorted(files.spec(self.folder / "again.exr").channelnames), ["A", "Y"])
        np.testing.assert_allclose(channel(self.folder / "again.exr", "A"), samples[:, :, 1], atol=0.02)

    def test_constant_channel(self):
        samples = with_depth()
        samples[:, :, 3] = 7
        built = self.build(self.scene(samples), "--channels", "R,G,B,depth.Z:100", "--vertices", 20)
        self.assertLess(built["channel_rms"]["depth.Z"], 1e-5)

    def test_bad_lists(self):
        scene = self.scene()
        seventeen = ",".join(f"c{i}" for i in range(17))
        for value, *words in (("", "expected"), ("R,,B", "expected"), (":2", "expected"), ("depth.Z:0", "above 0"),
                              ("depth.Z:-1", "above 0"), ("depth.Z:nan", "number"), ("depth.Z:", "number"),
                              ("depth.Z:1x", "number"), ("depth.Z,depth.Z", "twice"), ("R:1,G:2,B:1", "one weight"),
                              (seventeen, "16"), ("R,G,B," + ",".join(f"c{i}" for i in range(14)), "16", "three")):
            self.assert_error("imgmesh-build", [scene, "-o", "x.glb", "--channels", value], 2, "--channels", *words)
        self.assert_error("imgmesh-build", [scene, "-o", "x.glb", "--channels", "R,G,B,Z"], 4, "scene.exr", "Z",
                          "depth.Z")

    def test_values_that_cannot_be_features(self):
        for bad, code, words in ((np.nan, 4, "finite"), (1e9, 5, "depth.Z")):
            samples = with_depth()
            samples[3, 4, 3] = bad
            self.assert_error("imgmesh-build", [self.scene(samples), "-o", "x.glb", "--channels", "depth.Z"], code,
                              words, "(4, 3)")


class Light(CliCase):
    def test_highlights_there_and_back(self):
        samples = np.full((36, 48, 3), 0.2)
        y, x = np.mgrid[0:36, 0:48]
        lamp = (x - 30) ** 2 + (y - 15) ** 2 < 50
        samples[lamp] = (60, 30, 15)
        for kind in ("half", "float"):
            with self.subTest(kind=kind):
                picture = files.write_float(self.folder / f"{kind}.exr", samples, kind)
                built = self.build(picture, "--vertices", 80)
                self.assertTrue(built["has_light"])
                self.assertEqual(built["flipped_pixel_triangles"], 0)
                self.assertTrue(self.report("imgmesh-info", "out.glb")["has_light"])
                self.run_ok("imgmesh-info", "out.glb", "--validate")
                self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "again.exr")
                again = files.read(self.folder / "again.exr")
                np.testing.assert_allclose(again[15, 30], (60, 30, 15), rtol=0.02)
                np.testing.assert_allclose(again[2, 2], 0.2, rtol=0.02)
                self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "again.png")
                self.assertEqual(float(files.read(self.folder / "again.png")[15, 30, 2]), 1)
                compared = self.report("imgmesh-compare", picture, "out.glb")["difference"]
                self.assertAlmostEqual(compared["rms_luv"], built["map_rms"], delta=0.02 * built["map_rms"] + 0.05)

    def test_floats_within_one_are_no_light(self):
        picture = files.write_float(self.folder / "sdr.exr", files.ramp(24, 18), "float")
        self.assertFalse(self.build(picture)["has_light"])


if __name__ == "__main__":
    main()

"""imgmesh-build on every size and kind of image: a sound container, and the image comes back."""
import io
import os
import re

import numpy as np
from PIL import Image, ImageCms

import picture_files
from support import CliCase, main

# With faces enough to keep every vertex the pixel map is the identity, and colours are 16-bit codes: what is
# left is rounding to the image's 8 bits. One code is 48 dB.
EXACT_DB = 48


# Linear RGB of a space's primaries to sRGB's (both with white D65).
TO_SRGB = {
    "AdobeRGB": [[1.39836, -0.39836, 0], [0, 1, 0], [0, -0.04293, 1.04293]],
    "DisplayP3": [[1.22494, -0.22494, 0], [-0.04206, 1.04206, 0], [-0.01964, -0.07864, 1.09827]],
}


def srgb_decoded(x):
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def srgb_encoded(x):
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


class Pictures(CliCase):
    def round_trip(self, picture, *args, **kwargs):
        """Builds, checks the container, reconstructs; gives the report and the image read back."""
        report = self.build(picture, *args, **kwargs)
        verdict = self.report("imgmesh-info", "out.glb", "--validate")
        self.assertTrue(verdict["valid"])
        self.assertEqual(verdict["findings"], [])
        self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "back.tif")
        return report, picture_files.read(self.folder / "back.tif")

    def test_odd_sizes(self):
        for width, height in ((1, 1), (1, 5), (5, 1), (2, 2), (2, 1), (1, 2), (3, 3), (2, 7), (17, 2)):
            for name, samples in (("noise", picture_files.noise(width, height)),
                                  ("checkerboard", picture_files.checkerboard(width, height)),
                                  ("constant", np.full((height, width, 3), 0.4))):
                with self.subTest(f"{name} {width}x{height}"):
                    path = picture_files.png(self.folder / "in.png", samples)
                    report, back = self.round_trip("in.png", "--faces", "1000")
                    self.assertEqual((report["width"], report["height"]), (width, height))
                    self.assertEqual(back.shape, (height, width, 3))
                    self.assertEqual(report["flipped_pixel_triangles"], 0)
                    self.assertGreater(picture_files.psnr(back, picture_files.read(path)), EXACT_DB)

    def test_constant_picture_needs_next_to_nothing(self):
        """Any mesh reproduces it, whatever the collapse did."""
        picture_files.png(self.folder / "in.png", np.full((40, 60, 3), 0.3))
        report, back = self.round_trip("in.png", "--faces", "8")
        self.assertLessEqual(report["faces"], 8)
        self.assertLess(report["map_rms"], 0.01)
        self.assertEqual(report["flipped_pixel_triangles"], 0)
        np.testing.assert_allclose(back, np.round(0.3 * 255) / 255, atol=1e-6)

    def test_noise_and_checkerboard_stay_sound(self):
        """Nothing in them can be simplified, but the mesh is as small as asked and nothing folds."""
        for name, samples in (("noise", picture_files.noise(41, 31)),
                              ("checkerboard", picture_files.checkerboard(41, 31))):
            with self.subTest(name):
                picture_files.png(self.folder / "in.png", samples)
                report, back = self.round_trip("in.png", "--faces", "100")
                self.assertLessEqual(report["faces"], 100)
                self.assertEqual(report["flipped_pixel_triangles"], 0)
                self.assertEqual(back.shape, samples.shape)

    def test_stops(self):
        picture_files.png(self.folder / "in.png", picture_files.noise(40, 30))
        self.assertLessEqual(self.build("in.png", "--faces", "77")["faces"], 77)
        self.assertGreaterEqual(self.build("in.png", "--faces", "77")["faces"], 70)
        self.assertLessEqual(self.build("in.png", "--vertices", "50")["vertices"], 50)
        self.assertLessEqual(self.build("in.png", "--density", "5")["vertices"], 60)
        self.assertLessEqual(self.build("in.png", "--error", "30")["error"], 30)
        untouched = self.build("in.png", "--error", "0")
        self.assertEqual((untouched["vertices"], untouched["faces"], untouched["error"]), (1200, 2 * 39 * 29, 0))

    def test_error_and_bytes_fall_with_size(self):
        picture_files.png(self.folder / "in.png", picture_files.ramp(64, 48))
        coarse, fine = (self.build("in.png", "--faces", n) for n in (40, 400))
        self.assertLess(fine["map_rms"], coarse["map_rms"])
        self.assertLess(coarse["bytes"], fine["bytes"])

    def test_report_agrees_with_the_files(self):
        picture_files.png(self.folder / "in.png", picture_files.ramp(64, 48))
        for output in ("a.glb", "b.gltf"):
            report = self.build("in.png", output=output)
            size = sum(len(data) for name, data in self.files().items() if name.startswith(output[0] + "."))
            self.assertEqual(report["bytes"], size)
            self.assertAlmostEqual(report["bytes_per_pixel"], size / (64 * 48))
            facts = self.report("imgmesh-info", output)
            level = facts["levels"][0]
            self.assertEqual((level["vertices"], level["faces"]), (report["vertices"], report["faces"]))
            self.assertEqual(facts["bytes"]["total"], size)
            self.assertAlmostEqual(level["mesh"]["mean_edge_ratio"], report["mean_edge_ratio"], 9)
        self.assertEqual({n for n in self.files() if n.startswith("b.")}, {"b.gltf", "b.bin", "b.exr"})

    def test_grey(self):
        grey = picture_files.ramp(24, 16)[..., :1]
        for bits in (8, 16):
            path = picture_files.png(self.folder / "in.png", grey, bits=bits)
            _, back = self.round_trip("in.png", "--density", "100")
            for channel in range(3):
                self.assertGreater(picture_files.psnr(back[..., channel], picture_files.read(path)[..., 0]), EXACT_DB)
            self.assertEqual(self.report("imgmesh-info", "out.glb")["channels"], ["Y"])

    def test_palette(self):
        indices = np.arange(24 * 16).reshape(16, 24) // 5 % 4
        palette = np.array([[0, 0, 0], [1, 0, 0], [0, 0.5, 1], [0.9, 0.9, 0.2]])
        picture_files.png(self.folder / "in.png", indices, palette=palette)
        _, back = self.round_trip("in.png", "--density", "100")
        self.assertGreater(picture_files.psnr(back, palette[indices]), EXACT_DB)

    def test_sixteen_bits(self):
        path = picture_files.png(self.folder / "in.png", picture_files.ramp(24, 16), bits=16)
        self.round_trip("in.png", "--density", "100")
        self.assertEqual(str(picture_files.spec(self.folder / "back.tif").format), "uint16")
        self.assertEqual(self.report("imgmesh-info", "out.glb")["sample_type"], "uint16")
        # 16-bit linear codes are coarser than 16-bit sRGB near black, and still far below 8 bits.
        self.assertGreater(picture_files.psnr(picture_files.read(self.folder / "back.tif"),
                                              picture_files.read(path)), 70)

    def test_float_is_linear_by_default(self):
        picture_files.write_float(self.folder / "in.exr", picture_files.ramp(24, 16))
        report, back = self.round_trip("in.exr", "--density", "100")
        self.assertEqual(report["color_space"], "linear")
        self.assertEqual(str(picture_files.spec(self.folder / "back.tif").format), "float")
        self.assertGreater(picture_files.psnr(back, picture_files.ramp(24, 16)), 70)

    def test_color_space_is_taken_over(self):
        picture_files.png(self.folder / "in.png", picture_files.ramp(24, 16))
        report, _ = self.round_trip("in.png", "--color-space", "displayp3")
        self.assertEqual(report["color_space"], "DisplayP3")
        self.assertEqual(self.report("imgmesh-info", "out.glb")["color_space"], "DisplayP3")

    def test_other_software_reads_the_profile(self):
        """Pillow converts a drawing to sRGB by its embedded profile, to the colours that its space stands for."""
        samples = 0.35 + 0.3 * picture_files.ramp(24, 16)  # within sRGB
        picture_files.png(self.folder / "in.png", samples)
        for space, matrix in TO_SRGB.items():
            with self.subTest(space):
                self.build("in.png", "--density", "100", "--color-space", space)
                self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "back.png")
                image = Image.open(self.folder / "back.png")
                profile = ImageCms.ImageCmsProfile(io.BytesIO(image.info["icc_profile"]))
                self.assertEqual(ImageCms.getProfileDescription(profile).strip(), space)
                found = ImageCms.profileToProfile(image, profile, ImageCms.createProfile("sRGB"))
                light = samples ** (563 / 256) if space == "AdobeRGB" else srgb_decoded(samples)
                expected = srgb_encoded(light @ np.transpose(matrix))
                np.testing.assert_allclose(np.asarray(found) / 255, expected, atol=2.5 / 255)
                self.assertEqual(self.build("back.png")["color_space"], space)

    def test_alpha_is_ignored_and_the_report_says_so(self):
        rgba = np.concatenate([picture_files.ramp(24, 16), picture_files.noise(24, 16, 1)], axis=-1)
        rgba[:, :5, 3] = 0
        path = picture_files.png(self.folder / "in.png", rgba)
        report, back = self.round_trip("in.png", "--density", "100", "--alpha", "ignore")
        self.assertEqual(report["alpha"], "ignored")
        self.assertEqual(back.shape, (16, 24, 3))
        seen = picture_files.read(path)[..., 3] > 0.1  # OpenImageIO's Python associates alpha
        original = np.round(rgba[..., :3] * 255) / 255
        self.assertGreater(picture_files.psnr(back[seen], original[seen]), EXACT_DB)
        picture_files.png(self.folder / "in.png", picture_files.ramp(24, 16))
        self.assertEqual(self.build("in.png")["alpha"], "none")

    def test_alpha_cuts(self):
        """Outside there is nothing, inside is the picture. Half is the threshold."""
        rgba = np.concatenate([picture_files.ramp(24, 16), np.ones((16, 24, 1))], axis=-1)
        rgba[4:9, 6:12, 3] = 127 / 255  # a hole
        rgba[:, 20:, 3] = 0
        rgba[12, 22, 3] = 128 / 255  # and an island
        picture_files.png(self.folder / "in.png", rgba)
        inside = rgba[..., 3] > 0.5
        for args, draco in (((), "edgebreaker"), (("--draco", "sequential"), ""), (("--draco", "none"), "")):
            report, back = self.round_trip("in.png", "--alpha", "cut", "--density", "100", *args)
            self.assertEqual((report["alpha"], report["pixels"]), ("cut", inside.sum()))
            self.assertEqual(back.shape, (16, 24, 4))
            np.testing.assert_array_equal(back[..., 3] > 0, inside)
            original = np.round(rgba[..., :3] * 255) / 255
            self.assertGreater(picture_files.psnr(back[inside][:, :3], original[inside]), EXACT_DB)
        info = self.report("imgmesh-info", "out.glb")
        self.assertTrue(info["has_mask"])
        self.assertEqual(info["levels"][0]["map"]["pixels"], inside.sum())
        self.assertEqual(info["levels"][0]["map"]["flipped_triangles"], 0)
        difference = self.report("imgmesh-compare", "in.png", "out.glb")["difference"]
        self.assertEqual(difference["pixels"], inside.sum())
        self.assertEqual(self.build("in.png", "--alpha-threshold", "0.498")["pixels"], inside.sum() + 30)
        self.assertEqual(self.build("in.png", "--alpha", "ignore")["alpha"], "ignored")
        rgba[..., 3] = 1
        picture_files.png(self.folder / "in.png", rgba)
        self.assertEqual(self.build("in.png")["alpha"], "cut")  # of which an opaque one leaves all
        self.assertFalse(self.report("imgmesh-info", "out.glb")["has_mask"])

    def test_mask_goes_over_alpha(self):
        rgba = np.concatenate([picture_files.noise(20, 15, 3), np.ones((15, 20, 1))], axis=-1)
        rgba[:3, :, 3] = 0
        picture_files.png(self.folder / "in.png", rgba)
        inside = np.zeros((15, 20), dtype=bool)
        inside[:10, 2:18] = True
        inside[5, 5:9] = False
        shades = inside[..., None].astype(float)
        masks = {"grey": shades, "color": np.repeat(shades, 3, axis=-1),
                 "alpha": np.concatenate([np.zeros((15, 20, 3)), shades], axis=-1),
                 "opaque": np.concatenate([np.repeat(shades, 3, axis=-1), np.ones((15, 20, 1))], axis=-1)}
        for name, samples in masks.items():
            with self.subTest(name):
                picture_files.png(self.folder / "mask.png", samples)
                report, back = self.round_trip("in.png", "--mask", "mask.png")
                self.assertEqual((report["alpha"], report["pixels"]), ("ignored", inside.sum()))
                np.testing.assert_array_equal(back[..., 3] > 0, inside)

    def test_masks_of_any_depth_and_size(self):
        """Odd sizes, 16 bits, float; the mask to the pixel, whatever the picture."""
        for width, height in ((1, 1), (1, 7), (31, 17)):
            alpha = (picture_files.noise(width, height, 1, seed=width) > 0.4).astype(float)
            alpha[0, 0] = 1
            for name in ("8.png", "16.png", "grey.png", "float.exr"):
                color = picture_files.noise(width, height, 1 if name == "grey.png" else 3)
                samples = np.concatenate([color, alpha], axis=-1)
                with self.subTest(f"{name} {width}x{height}"):
                    if name == "float.exr":
                        picture_files.write_float(self.folder / name, samples, names=("R", "G", "B", "A"))
                    else:
                        picture_files.png(self.folder / name, samples, 16 if name == "16.png" else 8)
                    report, back = self.round_trip(name)
                    self.assertEqual(report["flipped_pixel_triangles"], 0)
                    self.assertEqual(report["pixels"], alpha.sum())
                    seen = back[..., 3] > 0 if back.shape[2] == 4 else np.ones((height, width), bool)
                    np.testing.assert_array_equal(seen, alpha[..., 0] > 0)

    def test_levels_and_drawings_of_a_masked_image(self):
        y, x = np.mgrid[0:60, 0:80]
        ring = np.abs(np.hypot(x - 40, y - 30) - 18) < 9
        rgba = np.concatenate([picture_files.ramp(80, 60), ring[..., None].astype(float)], axis=-1)
        picture_files.png(self.folder / "in.png", rgba)
        report = self.build("in.png", "--levels", "3", "--density", "20", "--max-cluster", "60",
                            "--min-quality", "0.2")
        self.assertEqual(len(report["levels"]), 3)
        for level in range(3):
            mesh = self.report("imgmesh-info", "out.glb")["levels"][level]
            self.assertEqual((mesh["map"]["pixels"], mesh["map"]["flipped_triangles"]), (ring.sum(), 0))
            self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "map.png", "--level", level)
            np.testing.assert_array_equal(picture_files.read(self.folder / "map.png")[..., 3] > 0, ring)
            for mode in ("gouraud", "wire", "flat"):  # the mesh covers the mask, and little else
                self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "d.png", "--mode", mode, "--level", level)
                drawn = picture_files.read(self.folder / "d.png")[..., 3]  # pixels at an edge are covered in part
                self.assertTrue(np.all(drawn[ring] > 0))
                self.assertLess(drawn.sum() - ring.sum(), 0.1 * ring.sum())
        self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "wire.svg", "--mode", "wire")
        self.assert_error("imgmesh-reconstruct", ("out.glb", "-o", "map.jpg"), 2, "map.jpg")

    def test_masks_that_cannot_be(self):
        rgba = np.concatenate([picture_files.ramp(12, 9), np.zeros((9, 12, 1))], axis=-1)
        picture_files.png(self.folder / "clear.png", rgba)
        picture_files.png(self.folder / "in.png", picture_files.ramp(12, 9))
        picture_files.png(self.folder / "black.png", np.zeros((9, 12, 1)))
        picture_files.png(self.folder / "small.png", np.ones((9, 11, 1)))
        out = ("-o", "out.glb")
        self.assert_error("imgmesh-build", ("clear.png", *out), 5, "clear.png", "no pixel is inside",
                          "alpha is below 0.5 everywhere", "--alpha ignore")
        self.assert_error("imgmesh-build", ("in.png", *out, "--mask", "black.png"), 5, "error: black.png: no pixel is inside",
                          "largest value is 0 of 255")
        self.assert_error("imgmesh-build", ("in.png", *out, "--mask", "small.png"), 4, "error: small.png", "11x9", "in.png",
                          "12x9")
        self.assert_error("imgmesh-build", ("in.png", *out, "--mask", "none.png"), 3, "none.png")
        self.assert_error("imgmesh-build", ("in.png", *out, "--mask", ""), 2, "--mask")
        for threshold in ("0", "1.01", "-1", "nan", ""):
            self.assert_error("imgmesh-build", ("in.png", *out, "--alpha-threshold", threshold), 2,
                              "--alpha-threshold")

    def test_masks_of_small_numbers(self):
        """A mask of 0 and 1 is black to imgmesh. The message says why, and the option that it names takes the mask."""
        picture_files.png(self.folder / "in.png", picture_files.ramp(12, 9))
        inside = np.zeros((9, 12, 1))
        inside[2:6, 3:9] = 1
        masks = {"8.png": (picture_files.png(self.folder / "8.png", inside / 255), "1 of 255"),
                 "16.png": (picture_files.png(self.folder / "16.png", inside * 3 / 65535, bits=16), "3 of 65535"),
                 "colour.png": (picture_files.png(self.folder / "colour.png", np.repeat(inside, 3, -1) * 40 / 255), "40 of 255"),
                 "palette.png": (picture_files.png(self.folder / "palette.png", inside[..., 0],
                                                   palette=[[0, 0, 0], [0.4, 0.4, 0.4]]), "102 of 255"),
                 "float.tif": (picture_files.write_float(self.folder / "float.tif", inside * 0.25), "0.25")}
        for name, (_, largest) in masks.items():
            result = self.assert_error("imgmesh-build", ("in.png", "-o", "out.glb", "--mask", name), 5,
                                       f"error: {name}: no pixel is inside the mask", f"largest value is {largest},",
                                       "threshold of 0.5")
            threshold = result.stderr.split("--alpha-threshold ")[1].split()[0]
            report = self.build("in.png", "--mask", name, "--alpha-threshold", threshold)
            self.assertEqual(report["pixels"], inside.sum())

    def test_a_file_gives_a_few_warnings(self):
        """Each of these 200 profiles is broken; ten lines tell it."""
        data = picture_files.png(self.folder / "in.png", picture_files.ramp(9, 7)).read_bytes()
        chunk = picture_files.png_chunk(b"iCCP", b"broken\0\0no profile")
        (self.folder / "in.png").write_bytes(data[:33] + 200 * chunk + data[33:])
        warnings = self.report("imgmesh-build", "in.png", "-o", "out.glb")["warnings"]
        self.assertEqual(len(warnings), 10)
        told, more = sum("more warnings" not in w for w in warnings), re.search(r"and (\d+) more warnings", warnings[-1])
        self.assertGreater(told + int(more[1]), 20)

    def test_warnings_of_masks(self):
        picture_files.png(self.folder / "in.png", picture_files.ramp(3, 2))
        (self.folder / "mask.pgm").write_text("P2 3 2 1\n1 1 0\n1 2 0\n")  # 2 is above its largest value
        report = self.report("imgmesh-build", "in.png", "-o", "out.glb", "--mask", "mask.pgm")
        self.assertEqual(report["images"][0]["pixels"], 4)
        self.assertEqual(len(report["warnings"]), 1)
        self.assertTrue(report["warnings"][0].startswith("mask.pgm: samples above"), report["warnings"])

    def test_precision_of_the_map(self):
        picture_files.png(self.folder / "in.png", picture_files.ramp(24, 16))
        for precision in ("half", "float"):
            self.build("in.png", "--bary", precision)
            level = self.report("imgmesh-info", "out.glb")["levels"][0]
            self.assertEqual(level["map"]["precision"], precision)

    def test_compression_changes_bytes_and_nothing_else(self):
        picture_files.png(self.folder / "in.png", picture_files.ramp(64, 48))
        sizes, pictures = [], []
        for mode in ("edgebreaker", "sequential", "none"):
            report, back = self.round_trip("in.png", "--draco", mode, "--faces", "300")
            self.assertEqual(self.report("imgmesh-info", "out.glb")["draco"], mode)
            sizes.append(report["bytes"])
            pictures.append(back)
        self.assertEqual(sizes, sorted(sizes))
        np.testing.assert_array_equal(pictures[0], pictures[1])
        np.testing.assert_array_equal(pictures[0], pictures[2])

    def loaded(self, tool, *args):
        """The shared libraries that a run asks the dynamic linker for."""
        self.run_ok(tool, *args, env=os.environ | {"LD_DEBUG": "libs", "LD_DEBUG_OUTPUT": str(self.folder / "linker")})
        logs = list(self.folder.glob("linker.*"))
        text = "".join(log.read_text() for log in logs)
        for log in logs:
            log.unlink()
        self.assertIn("libOpenEXR", text)  # the log is one
        return text

    def test_no_tool_loads_the_library_that_may_crash(self):
        """OpenImageIO would cost 0.2 s at every start; a process of its own loads it, for formats that need it."""
        picture_files.png(self.folder / "a.png", picture_files.ramp(20, 16))
        for tool, *args in (("imgmesh-build", "a.png", "-o", "a.glb"), ("imgmesh-info", "a.glb"),
                            ("imgmesh-reconstruct", "a.glb", "-o", "b.png"),
                            ("imgmesh-reconstruct", "a.glb", "-o", "b.exr"), ("imgmesh-build", "b.exr", "-o", "b.glb"),
                            ("imgmesh-reconstruct", "a.glb", "-o", "b.webp"), ("imgmesh-convert", "a.glb", "-o", "b.gltf"),
                            ("imgmesh-segment", "a.glb", "-o", "l.png"), ("imgmesh-compare", "a.png", "a.glb"),
                            ("imgmesh-reconstruct", "a.glb", "-o", "b.tif"), ("imgmesh-build", "b.tif", "-o", "c.glb"),
                            ("imgmesh-reconstruct", "a.glb", "-o", "b.jpg"), ("imgmesh-build", "b.jpg", "-o", "d.glb")):
            with self.subTest(args):
                self.assertNotIn("OpenImageIO", self.loaded(tool, *args))


if __name__ == "__main__":
    main()

"""Small images with traits that programs are known to get wrong, and the right outcome of each.

They lie beside the checkout, in shared/cases/pictures; without that folder nothing is tested here. READ says what an
image looks like, REFUSED which one line refuses it. A new kind is a new row."""
import json
import pathlib
from typing import Callable, NamedTuple

import numpy as np

import picture_files
from support import ROOT, CliCase, main

FOLDER = next((p for p in (parent / "shared/cases/pictures" for parent in ROOT.parents) if p.is_dir()), None)


def rgba(path):
    """The image as RGBA with 8 bits, by another reader."""
    samples = np.round(picture_files.read(path) * 255).astype(int)
    if samples.shape[2] < 3:
        samples = np.concatenate([np.repeat(samples[..., :1], 3, axis=-1), samples[..., 1:]], axis=-1)
    if samples.shape[2] < 4:
        samples = np.concatenate([samples, np.full_like(samples[..., :1], 255)], axis=-1)
    return samples


def truth():
    return rgba(FOLDER / "truth.png")


def truth_alpha():
    return rgba(FOLDER / "truth-alpha.png")


def soft_shadow():
    return rgba(FOLDER / "F06-soft-shadow.png")


def truth_grey():
    """The green of it, which is what the grey file holds."""
    samples = truth()
    samples[..., :3] = samples[..., 1:2]
    return samples


def green_and_alpha():
    both = truth_alpha()
    return np.concatenate([np.repeat(both[..., 1:2], 3, axis=-1), both[..., 3:]], axis=-1)


def squares():
    """White and black, 8 pixels a side, white first."""
    y, x = np.mgrid[0:64, 0:96] // 8
    grey = np.where((x + y) % 2 == 0, 255, 0)
    return np.stack([grey, grey, grey, np.full_like(grey, 255)], axis=-1)


class Read(NamedTuple):
    """A file, the RGBA codes that it must give, how far they may be off, and options of imgmesh-build."""
    name: str
    expected: Callable = truth
    tolerance: int = 0
    args: tuple = ()


class Refused(NamedTuple):
    """A file, the exit code, words of the one error line, and options of imgmesh-build."""
    name: str
    code: int
    words: tuple
    args: tuple = ()


class Compared(NamedTuple):
    """A file against another, and whether imgmesh-compare must find it different at a tolerance of 0."""
    name: str
    other: str
    differs: bool


READ = (
    Read("truth.png"),
    Read("truth-alpha.png", truth_alpha),
    Read("F01-cmyk-tiled8.tif"),
    Read("F01-cmyk-tiled16bit.tif"),
    Read("F02-cmyk-24bit-tiles.tif"),
    Read("F02-cmyk-4bit-strips.tif", tolerance=17),  # 16 shades of each ink
    Read("F02-grey-24bit-tiles.tif", truth_grey),
    Read("F03-bmp-bitfields-noalpha.bmp"),
    Read("F03-bmp-bitfields-rgba-v5.bmp", truth_alpha),
    Read("F03-bmp-bitfields-rgbx.bmp"),
    Read("F03-bmp32-unused-zero.bmp"),
    Read("F03-tga-grey-alpha.tga", green_and_alpha),
    Read("F04-bmp-os2v2.bmp"),
    Read("F04-bmp-rle8-eol-eob.bmp"),
    Read("F05-icc_applergb18.png", tolerance=3),  # stored in 8 bits of another curve
    Read("F05-icc_p3_g22.png", tolerance=3),
    Read("F05-icc_rec2020_g24.png", tolerance=10),
    Read("F06-soft-shadow.png", soft_shadow, tolerance=1),
    Read("F10-palette8.tif"),
    Read("F10-cmyka.tif", truth_alpha),
    Read("F11-thumbnail-first.tif"),
    Read("F12-bad-crc-text-chunk.png"),
    Read("F13-picture.png"),
    Read("F17-p1-packed.pbm", squares),
    Read("F18-p7.pam", truth_alpha),
    Read("F08-uint-id.exr", tolerance=1),
    Read("F08-z-nan.exr", tolerance=1),
    Read("F09-blender-layers.exr", tolerance=1),
    Read("F09-blender-layers.exr", tolerance=1, args=("--layer", "ViewLayer.Combined")),
    Read("F09-multipart-rgb-first.exr", tolerance=1),
    Read("F09-multipart-rgb-first.exr", tolerance=1, args=("--part", "rgb")),
    Read("F09-rgba-layer.exr", tolerance=1),
)

REFUSED = (
    Refused("F15-embedded.gltf", 5, ("glTF", "imgmesh-reconstruct")),
    Refused("F18-base.psd", 5, ("Photoshop",)),
    Refused("F08-z-nan.exr", 4, ("channel Z", "finite"), ("--channels", "R,G,B,Z")),
    Refused("F08-uint-id.exr", 5, ("channel id", "integers"), ("--channels", "R,G,B,id")),
    Refused("F09-blender-layers.exr", 4, ("no layer Combined", "ViewLayer.Combined"), ("--layer", "Combined")),
    Refused("F09-multipart-rgb-first.exr", 4, ("no part 2", "rgb, depth_first"), ("--part", "2")),
    Refused("F17-cgbi.png", 5, ("CgBI",)),
)

# The colour space that the file's own statement leads to.
STATED = (
    ("F05-p3-icc.heic", "DisplayP3"),
    ("F05-icc_rec2020_g24.png", "sRGB"),
    ("F05-png-chrm-adobe.png", "AdobeRGB"),
    ("F05-png-cicp-pq.png", "linear"),
)

COMPARED = (
    Compared("truth-alpha.png", "F07-no-hole.png", True),
    Compared("truth-alpha.png", "F07-opaque.png", False),
    Compared("F07-opaque.png", "F07-alpha1of255.png", True),
    Compared("F07-no-hole.png", "truth.png", False),
)


class Cases(CliCase):
    def read_back(self, name, *args):
        """The image as imgmesh has read it: with every vertex kept, the container draws it back exactly."""
        self.build(FOLDER / name, "--faces", "100000", *args)
        self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "back.png", "--overwrite")
        return rgba(self.folder / "back.png")

    def test_read(self):
        for case in READ if FOLDER else ():
            with self.subTest(case.name):
                expected, back = case.expected(), self.read_back(case.name, *case.args)
                self.assertEqual(back.shape, expected.shape)
                visible = expected[..., 3] > 0  # a container keeps no colour where nothing is seen
                off = np.abs(back - expected)
                self.assertLessEqual(off[..., 3].max(), case.tolerance, "alpha")
                self.assertLessEqual(off[visible].max(), case.tolerance, "colour")

    def test_masks(self):
        """The message names the mask, its largest value, and an option that takes the mask as it is."""
        for name in ("F13-mask-0-1.png", "F13-mask-int32.tif") if FOLDER else ():
            mask = ("--mask", FOLDER / name)
            line = self.assert_error("imgmesh-build", (FOLDER / "F13-picture.png", "-o", "out.glb", *mask), 5,
                                     f"{name}: no pixel is inside the mask", "largest value is").stderr
            self.assertNotIn("F13-picture", line)
            threshold = line.split("--alpha-threshold ")[1].split()[0]
            report = self.build(FOLDER / "F13-picture.png", *mask, "--alpha-threshold", threshold)
            self.assertLess(report["pixels"], 96 * 64)

    def test_luminance_chroma(self):
        """Subsampled chroma is lost for good, so the luminance is that of the original, where it can be shown."""
        if not FOLDER:
            return
        def luminance(samples):
            encoded = samples[..., :3] / 255
            linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
            return linear @ np.array([0.2126, 0.7152, 0.0722])
        off = np.abs(luminance(self.read_back("F18-luma-chroma.exr")) - luminance(truth()))
        self.assertLess(off.mean(), 0.003)
        self.assertLess(np.quantile(off, 0.9), 0.005)

    def test_refused(self):
        for case in REFUSED if FOLDER else ():
            self.assert_error("imgmesh-build", (FOLDER / case.name, "-o", "out.glb", *case.args), case.code,
                              pathlib.Path(case.name).name, *case.words)

    def test_stated(self):
        for name, space in STATED if FOLDER else ():
            with self.subTest(name):
                self.assertEqual(self.build(FOLDER / name, "--density", "40")["color_space"], space)

    def test_sprite_is_as_large_as_its_pixels(self):
        if not FOLDER:
            return
        self.build(FOLDER / "F14-rect-sprite.png", "--texture")
        for name in ("s.json", "s.obj"):
            self.run_ok("imgmesh-convert", "out.glb", "-o", name)
        (frame,) = json.loads((self.folder / "s.json").read_text())["frames"].values()
        obj = [line.split()[1:3] for line in (self.folder / "s.obj").read_text().splitlines() if line.startswith("v ")]
        for points in (np.array(frame["vertices"]), np.array(obj, float)):
            self.assertEqual(np.ptp(points, axis=0).tolist(), [40, 32])

    def test_values(self):
        for name in ("F16-dem-int16.tif", "F16-dem-float.tif") if FOLDER else ():
            with self.subTest(name):
                report = self.build(FOLDER / name, "--values", "--faces", "100000")
                self.assertEqual(report["clipped_samples"], 0)
                self.run_ok("imgmesh-reconstruct", "out.glb", "-o", "back.tif", "--overwrite")
                found = self.report("imgmesh-compare", FOLDER / name, "back.tif", "--values", "--tolerance", "0.01")
                self.assertEqual(found["difference"]["in_one_only"], 0)
                self.assertEqual(found["difference"]["pixels"], report["pixels"])
                colors = self.report("imgmesh-build", FOLDER / name, "-o", "out.glb", "--overwrite")
                self.assertGreater(colors["images"][0]["clipped_samples"], 0)
                self.assertIn("clipped", colors["warnings"][-1])

    def test_compared(self):
        for case in COMPARED if FOLDER else ():
            for pair in ((case.name, case.other), (case.other, case.name)):
                with self.subTest(pair):
                    files = [FOLDER / name for name in pair]
                    found = self.report("imgmesh-compare", *files, "--tolerance", "0", code=7 if case.differs else 0)
                    self.assertEqual(found["difference"]["max_alpha"] > 0, case.differs)


if __name__ == "__main__":
    main()

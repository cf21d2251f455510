"""imgmesh-reconstruct --mode smooth: noise falls, steps stay, and what it refuses."""
import numpy as np

import picture_files
from support import CliCase, main


def squares(width=96, height=64):
    """A dark and a light half, each with a gradient; a step of 0.4."""
    y, x = np.mgrid[0:height, 0:width]
    grey = np.where(x < width // 2, 0.25 + y * 0.002, 0.65 + y * 0.002)
    return np.stack([grey, grey, grey * 0.8], axis=2)


class Smooth(CliCase):
    def setUp(self):
        super().setUp()
        self.clean = squares()
        self.noisy = np.clip(self.clean + np.random.default_rng(1).normal(0, 0.04, self.clean.shape), 0, 1)
        picture_files.png(self.folder / "in.png", self.noisy)
        self.build("in.png", output="c.glb")

    def smooth(self, *args, output="out.png"):
        report = self.report("imgmesh-reconstruct", "c.glb", "-o", output, "--mode", "smooth", *args)
        return report, picture_files.read(self.folder / output)

    def error(self, image):
        """The root mean square of the difference from the image without noise."""
        return float(np.sqrt(np.mean((image[..., :3] - self.clean) ** 2)))

    def test_noise_of_the_image_falls_and_the_step_stays(self):
        report, image = self.smooth("--image", "in.png", "--strength", "9")
        self.assertEqual((report["mode"], report["strength"], report["image"]), ("smooth", 9, "in.png"))
        self.assertEqual((report["width"], report["height"], report["scale"]), (96, 64, 1))
        self.assertLess(self.error(image), 0.015)
        # A blurred step would lose half between these two columns.
        self.assertAlmostEqual(image[:, 48, 0].mean() - image[:, 47, 0].mean(), 0.4, delta=0.01)

    def test_the_reconstruction_is_smoothed_without_the_image(self):
        drawn = picture_files.read(self.folder / self.report("imgmesh-reconstruct", "c.glb", "-o", "m.png")["output"])
        report, image = self.smooth()
        self.assertEqual(report["strength"], 8)
        self.assertNotIn("image", report)
        self.assertLess(self.error(image), self.error(drawn))

    def test_strength_0_is_the_reconstruction(self):
        self.report("imgmesh-reconstruct", "c.glb", "-o", "m.png")
        _, none = self.smooth("--strength", "0")
        np.testing.assert_array_equal(none, picture_files.read(self.folder / "m.png"))

    def test_the_same_bytes_for_any_number_of_threads(self):
        for threads in ("1", "3"):
            self.smooth("--image", "in.png", "--threads", threads, output=f"t{threads}.png")
        self.assertEqual((self.folder / "t1.png").read_bytes(), (self.folder / "t3.png").read_bytes())

    def test_masked(self):
        mask = np.ones((64, 96))
        mask[20:40, 30:60] = 0
        picture_files.png(self.folder / "in.png", np.dstack([self.noisy, mask]))
        self.build("in.png", output="c.glb")
        for args in ((), ("--image", "in.png")):
            _, image = self.smooth(*args)
            np.testing.assert_array_equal(image[..., 3], mask)

    def test_other_kinds_of_files(self):
        for name in ("a.exr", "a.tif", "a.jpg"):
            self.smooth("--image", "in.png", output=name)
        _, deep = self.smooth("--depth", "16", output="b.png")
        self.assertEqual(str(picture_files.spec(self.folder / "b.png").format), "uint16")
        self.assertLess(self.error(deep), 0.03)

    def test_channels_that_are_left_out_are_told(self):
        picture_files.write_float(self.folder / "in.exr", np.dstack([self.clean, self.clean[..., 0]]),
                                  names=["R", "G", "B", "depth.Z"])
        self.build("in.exr", "--channels", "R,G,B,depth.Z:10", output="c.glb")
        report, image = self.smooth(output="a.exr")
        self.assertEqual(image.shape[2], 3)
        self.assertIn("without depth.Z", report["warnings"][0])
        self.assertNotIn("warnings", self.smooth(output="a.png")[0])

    def test_a_mesh_without_colour_is_refused(self):
        picture_files.write_float(self.folder / "in.tif", self.clean[..., :1])
        self.build("in.tif", "--values", output="c.glb")
        self.assert_error("imgmesh-reconstruct", ["c.glb", "-o", "a.png", "--mode", "smooth"], 5, "c.glb", "no colour")

    def test_refusals(self):
        tool = "imgmesh-reconstruct"
        self.assert_error(tool, ["c.glb", "-o", "x.png", "--strength", "4"], 2, "--strength", "--mode smooth")
        self.assert_error(tool, ["c.glb", "-o", "x.png", "--image", "in.png"], 2, "--image", "--mode smooth")
        smooth = ["c.glb", "-o", "x.png", "--mode", "smooth"]
        self.assert_error(tool, [*smooth, "--strength", "-1"], 2, "--strength", "-1")
        self.assert_error(tool, [*smooth, "--scale", "2"], 2, "--scale 2", "smooth")
        self.assert_error(tool, [*smooth[:2], "x.svg", *smooth[3:]], 2, "x.svg", "smooth")
        self.assert_error(tool, [*smooth, "--level", "1"], 2, "--level 1")
        picture_files.png(self.folder / "small.png", self.noisy[:9])
        self.assert_error(tool, [*smooth, "--image", "small.png"], 4, "small.png", "96x9", "96x64")
        self.assert_error(tool, [*smooth, "--image", "none.png"], 3, "none.png")


if __name__ == "__main__":
    main()

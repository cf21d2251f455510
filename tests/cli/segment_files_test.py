"""imgmesh-segment: files for other programs, read back by readers of their own."""
import re
import xml.etree.ElementTree

import numpy as np

import matlab_file
import picture_files
from support import CliCase, main
from segment_test import NONE, connected, read_layer


def eight_connected(inside):
    """Labels as MATLAB's bwlabel() with its usual eight neighbours."""
    labels = np.zeros(inside.shape, int)
    for start in zip(*np.nonzero(inside)):
        stack = [start] if labels[start] == 0 else []
        while stack:
            y, x = stack.pop()
            around = np.s_[max(y - 1, 0):y + 2, max(x - 1, 0):x + 2]
            for dy, dx in np.argwhere(inside[around] & (labels[around] == 0)):
                place = max(y - 1, 0) + dy, max(x - 1, 0) + dx
                labels[place] = 1 + start[0] * inside.shape[1] + start[1]
                stack.append(place)
    return labels


def rings_of(path):
    """The polygons of a path of an SVG; curves become eight pieces."""
    for ring in re.findall("M([^MZ]*)Z", path):
        (_, (start,)), *steps = [(c, np.array(re.findall(r"-?(?:\d+\.?\d*|\.\d+)", numbers), float).reshape(-1, 2))
                                 for c, numbers in re.findall("([MLQ])([^MLQ]*)", "M" + ring)]
        points = [start]
        for command, places in steps:
            if command == "Q":
                t = np.linspace(0, 1, 9)[1:, None]
                points.extend((1 - t) ** 2 * points[-1] + 2 * t * (1 - t) * places[0] + t * t * places[1])
            else:
                points.append(places[0])
        yield np.array(points)


def centers_inside(rings, width, height):
    """Which pixels' centres are inside, by the even-odd rule."""
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    inside = np.zeros((height, width), bool)
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring, np.roll(ring, -1, axis=0)):
            if ay != by:
                inside ^= ((ay < y) != (by < y)) & (ax + (y - ay) / (by - ay) * (bx - ax) < x)
    return inside


class SegmentFilesTest(CliCase):
    def setUp(self):
        super().setUp()
        # A sharp disc on a soft ramp.
        self.picture = picture_files.ramp(60, 40)
        picture_files.png(self.folder / "in.png", self.picture)
        self.build("in.png", "--faces", "500", output="c.glb")
        y, x = np.mgrid[0:40, 0:60]
        self.inside = np.hypot(x - 30, y - 20) < 15
        picture_files.png(self.folder / "mask.png", self.inside[..., None].astype(float))
        self.build("in.png", "--faces", "400", "--mask", "mask.png", output="masked.glb")

    def labels(self, *args, container="c.glb"):
        self.run_ok("imgmesh-segment", container, "-o", "out.npy", "-q", *args)
        return np.load(self.folder / "out.npy")

    def test_labels_for_matlab(self):
        """`segs` is a cell with a matrix of labels from 1; 0 is outside a mask."""
        for container, inside in (("c.glb", np.ones_like(self.inside)), ("masked.glb", self.inside)):
            labels = self.labels("--segments", "9", container=container)
            self.run_ok("imgmesh-segment", container, "-o", "out.mat", "-q", "--segments", "9")
            found = matlab_file.load(self.folder / "out.mat")
            self.assertEqual(list(found), ["segs"])
            self.assertEqual(found["segs"].shape, (1, 1))
            segs = found["segs"][0, 0]
            self.assertEqual(segs.dtype, np.uint16)
            np.testing.assert_array_equal(segs == 0, ~inside)
            np.testing.assert_array_equal(segs[inside] - 1, labels[inside])

    def test_contour_map_for_matlab(self):
        """The benchmark's code joins, at each threshold, what is connected below it, corners and frame included."""
        for container in ("c.glb", "masked.glb"):
            self.run_ok("imgmesh-segment", container, "-o", "out.png", "--ucm", "u.mat", "-q")
            self.run_ok("imgmesh-segment", container, "-o", "out.png", "--ucm", "u.npy", "-q")
            self.run_ok("imgmesh-segment", container, "-o", "out.png", "--ucm", "u.exr", "-q")
            plain = np.load(self.folder / "u.npy")
            self.assertEqual(plain.dtype, np.float32)
            np.testing.assert_array_equal(plain, read_layer(self.folder / "u.exr", "float")[1])
            found = matlab_file.load(self.folder / "u.mat")
            ucm2, half = found["ucm2"], found["half_height"][0, 0]
            self.assertEqual((ucm2.dtype, ucm2.shape), (np.float32, (81, 121)))
            finite = np.isfinite(plain[1:-1, 1:-1])
            expected = np.where(finite, np.divide(plain[1:-1, 1:-1], plain[1:-1, 1:-1] + half, where=finite), 1)
            np.testing.assert_allclose(ucm2[1:-1, 1:-1], expected, rtol=1e-6)
            np.testing.assert_array_equal(ucm2[[0, -1]], ucm2[[1, -2]])
            np.testing.assert_array_equal(ucm2[:, [0, -1]], ucm2[:, [1, -2]])
            for k in np.float32([0.1, 0.3, 0.5, 0.7, 0.9]):
                below = ucm2 <= k
                pixels = eight_connected(below)[1::2, 1::2]
                height = half * k / (1 - k)
                expected = connected(plain[1::2, 2:-1:2] <= height, plain[2:-1:2, 1::2] <= height, np.ones((40, 60), bool))
                pairs = np.unique(np.stack([pixels.ravel(), expected.ravel()]), axis=1)
                self.assertEqual((len(np.unique(pairs[0])), len(np.unique(pairs[1]))), (pairs.shape[1], pairs.shape[1]))

    def test_colors(self):
        """Regions are told apart by their colours alone; outside a mask nothing is drawn."""
        for container, inside in (("c.glb", np.ones_like(self.inside)), ("masked.glb", self.inside)):
            labels = self.labels("--segments", "9", container=container)
            self.report("imgmesh-segment", container, "-o", "out.png", "--segments", "9", "--colors", "colors.png")
            colors = picture_files.read(self.folder / "colors.png")
            self.assertEqual(colors.shape[2], 3 if inside.all() else 4)
            codes = colors[..., :3].dot([1, 256, 65536])
            pairs = np.unique(np.stack([codes[inside], labels[inside]]), axis=1)
            self.assertEqual([len(np.unique(row)) for row in pairs], [9, 9])
            if not inside.all():
                np.testing.assert_array_equal(colors[..., 3] > 0, inside)

    def test_shapes(self):
        """Drawn at pixels' centres, the shapes are the labels: smooth ones too."""
        for container in ("c.glb", "masked.glb"):
            labels = self.labels("--segments", "7", container=container)
            for tolerance in ("0", "0.2", "0.5"):
                self.report("imgmesh-segment", container, "-o", "out.png", "--segments", "7", "--svg", "r.svg",
                            "--svg-tolerance", tolerance, "--flat", "flat.png")
                root = xml.etree.ElementTree.parse(self.folder / "r.svg").getroot()
                self.assertEqual((root.get("width"), root.get("height"), root.get("viewBox")), ("60", "40", "0 0 60 40"))
                flat = picture_files.read(self.folder / "flat.png")
                paths = root.findall(".//{http://www.w3.org/2000/svg}path")
                self.assertEqual([p.get("id") for p in paths], [f"region-{i}" for i in range(7)])
                for i, path in enumerate(paths):
                    self.assertEqual(path.get("data-label"), str(i))
                    np.testing.assert_array_equal(centers_inside(rings_of(path.get("d")), 60, 40), labels == i)
                    code = np.rint(flat[labels == i][0, :3] * 255).astype(int)
                    self.assertEqual(path.get("fill"), "#%02x%02x%02x" % tuple(code))
            self.run_ok("imgmesh-segment", container, "-o", "out.png", "--segments", "7", "--svg", "usual.svg", "-q")
            self.assertEqual((self.folder / "usual.svg").read_bytes(), (self.folder / "r.svg").read_bytes())

    def test_shapes_that_cannot_be(self):
        for args, words in ((["--svg", "r.png"], ["--svg r.png", ".svg"]), (["--svg-tolerance", "0.3"], ["--svg"]),
                            (["--svg", "r.svg", "--svg-tolerance", "0.6"], ["--svg-tolerance", "0.5"])):
            self.assert_error("imgmesh-segment", ["c.glb", "-o", "x.png", *args], 2, *words)

    def test_seeds_choose_the_disc(self):
        """One pixel inside and one outside; build takes the mask."""
        disc = self.picture[..., 2] > 0.5
        y, x = np.argwhere(disc).mean(0).astype(int)
        for seeds in (["--keep", f"{x},{y}", "--drop", "0,0"], ["--keep", f"{x},{y}", "--drop", "0,0:59,0:59,39"],
                      ["--keep", f"{x},{y}", "--segments", "2"], ["--drop", "0,0", "--segments", "2"]):
            report = self.report("imgmesh-segment", "c.glb", "-o", "out.png", "--mask", "object.png", *seeds)
            found = picture_files.read(self.folder / "object.png")[..., 0]
            self.assertEqual(sorted(np.unique(found)), [0, 1])
            self.assertGreater(((found == 1) == disc).mean(), 0.97, seeds)
            self.assertEqual(report["mask_pixels"], (found == 1).sum())
        self.build("in.png", "--mask", "object.png", output="object.glb")
        np.testing.assert_array_equal(self.labels(container="object.glb") != NONE, found == 1)

    def test_seeds_that_cannot_be(self):
        for args, code, words in ((["--keep", "60,1"], 2, ["--keep 60,1", "0,0 to 59,39"]),
                                  (["--drop", "3,3:3,40"], 2, ["--drop 3,3:3,40", "3,40"]),
                                  (["--keep", "3"], 2, ["--keep '3'", "X,Y"]),
                                  (["--keep", "3,4,5"], 2, ["--keep '3,4,5'"]),
                                  (["--keep", "3,4:"], 2, ["--keep '3,4:'"]),
                                  (["--keep", "-1,4"], 2, ["--keep"]),
                                  (["--keep", "1.5,4"], 2, ["--keep"]),
                                  (["--keep", ""], 2, ["--keep"]),
                                  ([], 2, ["--mask object.png", "--keep"]),
                                  (["--keep", "5,5", "--drop", "5,5"], 5, ["--keep 5,5 and --drop 5,5", "one patch"])):
            self.assert_error("imgmesh-segment", ["c.glb", "-o", "x.png", "--mask", "object.png", *args], code, *words)
        self.assert_error("imgmesh-segment", ["c.glb", "-o", "x.png", "--keep", "1,1"], 2, "--keep 1,1", "--mask")
        self.assert_error("imgmesh-segment", ["masked.glb", "-o", "x.png", "--mask", "object.png", "--keep", "0,0"], 2,
                          "--keep 0,0", "outside the mask")
        self.assert_error("imgmesh-segment", ["c.glb", "-o", "x.png", "--mask", "object.txt", "--keep", "1,1"], 2, "object.txt")

    def test_images_of_one_pixel_and_of_one_row(self):
        for width, height in ((1, 1), (9, 1), (1, 9)):
            picture_files.png(self.folder / "odd.png", picture_files.noise(width, height))
            self.build("odd.png", output="odd.glb")
            self.run_ok("imgmesh-segment", "odd.glb", "-o", "odd.mat", "--ucm", "u.mat", "--colors", "c.png", "--keep", "0,0",
                        "--mask", "m.png", "--svg", "r.svg", "-q")
            self.assertEqual(matlab_file.load(self.folder / "odd.mat")["segs"][0, 0].shape, (height, width))
            self.assertEqual(matlab_file.load(self.folder / "u.mat")["ucm2"].shape, (2 * height + 1, 2 * width + 1))

    def test_folders_for_the_benchmark(self):
        """With --format mat the contour maps of a folder are .mat as well."""
        for kind, ucm in (("mat", "mat"), ("npy", "npy"), ("tif", "exr")):
            self.run_ok("imgmesh-segment", "c.glb", "masked.glb", "-o", f"{kind}/", "--format", kind, "--ucm", f"{kind}-ucm/",
                        "-q")
            self.assertEqual(sorted(p.name for p in (self.folder / kind).glob("[a-z]*")), [f"c.{kind}", f"masked.{kind}"])
            self.assertEqual(sorted(p.name for p in (self.folder / f"{kind}-ucm").glob("[a-z]*")), [f"c.{ucm}", f"masked.{ucm}"])


if __name__ == "__main__":
    main()

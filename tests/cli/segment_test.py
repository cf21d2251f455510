"""imgmesh-segment: labels, contour map, report, drawings and mesh, checked with other software's readers."""
import json
import struct

import jsonschema
import numpy as np
import OpenImageIO as oiio
from PIL import Image

import picture_files
from support import ROOT, CliCase, main

NONE = 0xFFFFFFFF


def read_layer(path, kind):
    source = oiio.ImageInput.open(str(path))
    assert source.spec().nchannels == 1
    return source.spec().channelnames[0], np.asarray(source.read_image(kind))[..., 0]


def connected(joined_right, joined_down, inside):
    """Labels of connected pixels by flooding, numbered by their first pixel."""
    labels = np.full(inside.shape, NONE, np.uint32)
    count = 0
    height, width = inside.shape
    for start in zip(*np.nonzero(inside)):
        if labels[start] != NONE:
            continue
        labels[start] = count
        stack = [start]
        while stack:
            y, x = stack.pop()
            for ny, nx, joined in ((y, x + 1, x + 1 < width and joined_right[y, x]),
                                   (y, x - 1, x > 0 and joined_right[y, x - 1]),
                                   (y + 1, x, y + 1 < height and joined_down[y, x]),
                                   (y - 1, x, y > 0 and joined_down[y - 1, x])):
                if joined and labels[ny, nx] == NONE:
                    labels[ny, nx] = count
                    stack.append((ny, nx))
        count += 1
    return labels


def glb(path):
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[28 + length:]


class Segment(CliCase):
    def setUp(self):
        super().setUp()
        self.picture = picture_files.ramp(60, 40)
        picture_files.png(self.folder / "in.png", self.picture)
        self.build("in.png", "--faces", "500", output="c.glb")

    def segment(self, *args, output="out.exr", container="c.glb"):
        report = self.report("imgmesh-segment", container, "-o", output, *args)
        kind = "uint" if output.endswith(".exr") else "uint16"
        channel, labels = read_layer(self.folder / output, kind)
        if kind == "uint":
            self.assertEqual(channel, "id")
        self.assertEqual(labels.shape, (report["height"], report["width"]))
        return report, labels

    def test_labels_for_other_programs(self):
        """The same numbers in every kind of file; 4294967295 is none in those of 32 bits."""
        y, x = np.mgrid[0:40, 0:60]
        mask = np.hypot(x - 30, y - 20) < 15
        picture_files.png(self.folder / "mask.png", mask[..., None].astype(float))
        self.build("in.png", "--faces", "400", "--mask", "mask.png", output="masked.glb")
        for container, inside in (("c.glb", np.ones_like(mask)), ("masked.glb", mask)):
            labels = self.segment("--segments", "9", container=container)[1]
            for name in ("out.npy", "out.tif", "out.tiff"):
                self.run_ok("imgmesh-segment", container, "-o", name, "-q", "--segments", "9")
            found = np.load(self.folder / "out.npy")
            self.assertEqual(found.dtype, np.uint32)
            np.testing.assert_array_equal(found, labels)
            np.testing.assert_array_equal(found == NONE, ~inside)
            image = Image.open(self.folder / "out.tif")  # as signed integers
            np.testing.assert_array_equal(np.asarray(image).astype(np.uint32), labels)
            np.testing.assert_array_equal(read_layer(self.folder / "out.tif", "uint")[1], labels)
            self.assertEqual(image.tag_v2[42113], "4294967295")
            self.assertEqual((self.folder / "out.tif").read_bytes(), (self.folder / "out.tiff").read_bytes())

    def test_labels_of_images_of_one_pixel_and_of_many_strips(self):
        for width, height in ((1, 1), (1, 300), (700, 210)):
            picture_files.png(self.folder / "odd.png", picture_files.noise(width, height))
            self.build("odd.png", "--preset", "fast", output="odd.glb")
            for name in ("odd.npy", "odd.tif", "odd.exr"):
                self.run_ok("imgmesh-segment", "odd.glb", "-o", name, "-q")
            labels = np.load(self.folder / "odd.npy")
            self.assertEqual(labels.shape, (height, width))
            np.testing.assert_array_equal(read_layer(self.folder / "odd.exr", "uint")[1], labels)
            np.testing.assert_array_equal(np.asarray(Image.open(self.folder / "odd.tif")).astype(np.uint32), labels)

    def test_the_disc_is_a_region(self):
        """One sharp disc on a soft ramp: two regions are the disc and the rest."""
        for distance in ("contour", "paper"):
            report, labels = self.segment("--segments", "2", "--distance", distance)
            self.assertEqual((report["regions"], report["distance"]), (2, distance))
            disc = self.picture[..., 2] > 0.5
            agreement = ((labels == labels[16, 30]) == disc).mean()
            self.assertGreater(agreement, 0.97, distance)

    def test_quality(self):
        disc = self.picture[..., 2] > 0.5
        self.build("in.png", "--faces", "700", output="fine.glb")
        found = [self.segment("--quality", quality, "--segments", "2", container="fine.glb")[1]
                 for quality in ("fast", "default")]
        for labels in found:
            self.assertGreater(((labels == labels[16, 30]) == disc).mean(), 0.97)
        self.assertTrue((found[0] != found[1]).any())  # outlines are smoothed

    def test_a_number_near_the_default_threshold(self):
        report, _ = self.segment("--segments", "auto")
        self.assertLess(report["merged_up_to"], 8 * 1.1)
        self.assertGreater(report["next_merge"], 8 / 1.1)

    def test_png_and_exr_hold_the_same_labels(self):
        _, exr = self.segment("--segments", "20")
        _, png = self.segment("--segments", "20", output="out.png")
        np.testing.assert_array_equal(exr, png)
        self.assertEqual(sorted(np.unique(exr)), list(range(20)))

    def test_contour_map_at_any_threshold(self):
        self.segment("--ucm", "u.exr")
        name, values = read_layer(self.folder / "u.exr", "float")
        self.assertEqual((name, values.shape), ("height", (81, 121)))
        self.assertTrue((values[1::2, 1::2] == 0).all())
        heights = np.unique(values[values > 0])
        for threshold in (heights[0], heights[len(heights) // 2], heights[-3] * 1.0001, heights[-1] * 2):
            _, labels = self.segment("--threshold", repr(float(threshold)))
            expected = connected(values[1::2, 2:-1:2] < threshold, values[2:-1:2, 1::2] < threshold,
                                 np.ones((40, 60), bool))
            np.testing.assert_array_equal(labels, expected)

    def test_report_threshold_interval(self):
        report, labels = self.segment("--segments", "7")
        for threshold in (report["next_merge"], (report["merged_up_to"] + report["next_merge"]) / 2):
            np.testing.assert_array_equal(self.segment("--threshold", repr(threshold))[1], labels)

    def test_regions_file(self):
        _, labels = self.segment("--segments", "9", "--report", "r.json", "--image", "in.png")
        regions = json.loads((self.folder / "r.json").read_text())
        schema = json.loads((ROOT / "schemas/imgmesh-segment.regions.schema.json").read_text())
        jsonschema.Draft202012Validator(schema).validate(regions)
        self.assertEqual(len(regions["regions"]), 9)
        touching = set()
        for a, b in ((labels[:, :-1], labels[:, 1:]), (labels[:-1], labels[1:])):
            touching |= {frozenset(p) for p in zip(a[a != b], b[a != b])}
        self.assertEqual(touching, {frozenset((r["id"], n["id"])) for r in regions["regions"] for n in r["neighbors"]})
        for i, region in enumerate(regions["regions"]):
            y, x = np.nonzero(labels == i)
            self.assertEqual(region["id"], i)
            self.assertEqual(region["pixels"], len(x))
            self.assertEqual(region["box"], [x.min(), y.min(), x.max(), y.max()])

    def test_drawings(self):
        _, labels = self.segment("--segments", "12", "--outlines", "o.png", "--flat", "f.png", "--image", "in.png")
        flat = picture_files.read(self.folder / "f.png")
        for i in range(12):
            self.assertEqual(len(np.unique(flat[labels == i], axis=0)), 1)
        lines = picture_files.read(self.folder / "o.png")
        border = np.zeros(labels.shape, bool)
        border[:, :-1] |= labels[:, :-1] != labels[:, 1:]
        border[:-1] |= labels[:-1] != labels[1:]
        changed = np.abs(lines - picture_files.read(self.folder / "in.png")).max(-1) > 0.01
        np.testing.assert_array_equal(changed, border)

    def test_mesh_is_the_base_mesh_in_pieces(self):
        report, labels = self.segment("--segments", "6", "--mesh", "m.glb")
        document, binary = glb(self.folder / "m.glb")
        self.assertEqual(document["extensionsUsed"], ["KHR_materials_unlit"])
        primitives = document["meshes"][0]["primitives"]
        self.assertEqual([document["materials"][p["material"]]["name"] for p in primitives],
                         [f"region-{i}" for i in range(report["regions"])])

        def read(index, kind, columns):
            accessor = document["accessors"][index]
            offset = document["bufferViews"][accessor["bufferView"]]["byteOffset"] + accessor["byteOffset"]
            return np.frombuffer(binary, kind, accessor["count"] * columns, offset).reshape(-1, columns)

        areas = []
        for i, p in enumerate(primitives):
            corners = read(p["attributes"]["POSITION"], "<f4", 3)[read(p["indices"], "<u4", 1).reshape(-1, 3)]
            e, f = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
            area = (e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0]) / 2
            self.assertGreater(area.min(), 0)
            areas.append(area.sum())
        self.assertAlmostEqual(sum(areas), 59 * 39, places=2)
        sizes = [(labels == i).sum() for i in range(6)]
        np.testing.assert_allclose(areas, sizes, atol=60 + 0.2 * max(sizes))

    def test_min_size(self):
        report, _ = self.segment("--threshold", "0.5", "--min-size", "50")
        self.assertGreaterEqual(report["min_pixels"], 50)
        self.assertLess(self.segment("--threshold", "0.5")[0]["min_pixels"], 50)

    def test_superpixels(self):
        for compactness in ("0", "10", "100", "1e6"):
            report, labels = self.segment("--superpixels", "40", "--compactness", compactness)
            self.assertEqual((report["regions"], report["distance"]), (40, "superpixels"))
            self.assertEqual(labels.max(), 39)
        self.assertLess(report["max_pixels"], 4 * 60)
        report, _ = self.segment("--superpixels", "30", "--min-size", "40")
        self.assertEqual(report["regions"], 30)
        self.assertGreaterEqual(report["min_pixels"], 40)
        self.assertLess(self.segment("--superpixels", "30")[0]["min_pixels"], 40)

    def test_more_superpixels_than_patches(self):
        self.build("in.png", "--faces", "20", output="few.glb")
        for number in ("300", "2400"):
            report, labels = self.segment("--superpixels", number, container="few.glb")
            self.assertEqual((str(report["regions"]), report["target_reached"]), (number, True))
        np.testing.assert_array_equal(labels, np.arange(2400).reshape(40, 60))

    def test_contour_map_of_superpixels(self):
        """The lowest regions are the superpixels; at higher thresholds they merge."""
        report, labels = self.segment("--superpixels", "40", "--ucm", "u.exr")
        values = read_layer(self.folder / "u.exr", "float")[1]
        for threshold, count in ((1e-30, 40), (report["next_merge"], 40), (report["next_merge"] * 1.0001, 39)):
            joined = connected(values[1::2, 2:-1:2] < threshold, values[2:-1:2, 1::2] < threshold,
                               np.ones((40, 60), bool))
            self.assertEqual(joined.max() + 1, count)
            if count == 40:
                np.testing.assert_array_equal(joined, labels)

    def test_outside_of_a_mask_has_no_label(self):
        samples = np.dstack([self.picture, np.ones((40, 60))])
        samples[:, 25:31, 3] = 0
        picture_files.png(self.folder / "cut.png", samples)
        self.build("cut.png", "--faces", "300", output="cut.glb")
        _, exr = self.segment("--threshold", "1e9", "--ucm", "u.exr", "--flat", "f.png", container="cut.glb")
        _, png = self.segment("--threshold", "1e9", output="out.png", container="cut.glb")
        outside = exr == NONE
        self.assertTrue(outside[:, 25:31].all())
        self.assertEqual((exr[0, 0], exr[0, 59], exr[~outside].max()), (0, 1, 1))
        np.testing.assert_array_equal(png == 65535, outside)
        np.testing.assert_array_equal(picture_files.read(self.folder / "f.png")[..., 3] == 0, outside)
        values = read_layer(self.folder / "u.exr", "float")[1]
        np.testing.assert_array_equal(np.isinf(values[1::2, 2:-1:2]), outside[:, 1:] != outside[:, :-1])
        self.assert_error("imgmesh-segment", ["cut.glb", "-o", "x.exr", "--segments", "1", "--strict"], 5, "islands")

    def test_odd_pictures(self):
        for name, samples, bits in (("one", picture_files.noise(1, 1), 8), ("row", picture_files.noise(9, 1), 8),
                                    ("column", picture_files.noise(1, 9), 16),
                                    ("grey", picture_files.noise(3, 3, 1), 8)):
            picture_files.png(self.folder / f"{name}.png", samples, bits)
            self.build(f"{name}.png", output=f"{name}.glb")
            report, labels = self.segment("--segments", "1", "--ucm", "u.exr", "--outlines", "o.png", "--mesh",
                                          "m.glb", "--image", f"{name}.png", container=f"{name}.glb")
            self.assertEqual((report["regions"], labels.max()), (1, 0))
            self.assertNotIn("next_merge", report)

    def test_levels(self):
        self.build("in.png", "--level-faces", "400,100", output="l.glb")
        cells = [self.segment("--level", k, container="l.glb")[0]["cells"] for k in "01"]
        self.assertGreater(cells[0], cells[1])
        self.assert_error("imgmesh-segment", ["l.glb", "-o", "x.exr", "--level", "2"], 2, "--level 2", "l.glb")

    def test_same_bytes_for_any_threads(self):
        outputs = ("--ucm", "u.exr", "--outlines", "o.png", "--report", "r.json", "--mesh", "m.glb")
        self.segment(*outputs, "--threads", "1")
        one = self.files()
        self.segment(*outputs, "--threads", "3")
        self.assertEqual(self.files(), one)

    def test_mistakes(self):
        for args, words in ((["--threshold", "0"], ["--threshold", "'0'"]),
                            (["--threshold", "nan"], ["--threshold"]),
                            (["--segments", "0"], ["--segments"]),
                            (["--segments", "3", "--threshold", "3"], ["--segments", "--threshold"]),
                            (["--superpixels", "3", "--segments", "3"], ["--superpixels", "--segments"]),
                            (["--superpixels", "3", "--segments", "auto"], ["--superpixels", "--segments"]),
                            (["--threshold", "3", "--segments", "auto"], ["--threshold", "--segments"]),
                            (["--segments", "automatic"], ["--segments", "automatic"]),
                            (["--quality", "fast", "--distance", "paper"], ["--quality", "--distance"]),
                            (["--quality", "fast", "--superpixels", "9"], ["--quality", "--superpixels"]),
                            (["--superpixels", "3", "--distance", "paper"], ["--superpixels", "--distance"]),
                            (["--compactness", "3"], ["--compactness", "--superpixels"]),
                            (["--superpixels", "3", "--compactness", "-1"], ["--compactness"]),
                            (["--superpixels", "3", "--compactness", "1e30"], ["--compactness", "1e+06"]),
                            (["--image", "-"], ["--image -", "CONTAINER can be standard input"]),
                            (["--min-size", "0"], ["--min-size"]),
                            (["--distance", "near"], ["--distance", "contour, paper"]),
                            (["--ucm", "u.png"], ["--ucm", ".exr"]),
                            (["--report", "r.txt"], ["--report", ".json"]),
                            (["--mesh", "m.gltf"], ["--mesh", ".glb"]),
                            (["--outlines", "o.svg"], ["--outlines", "o.svg"]),
                            (["--flat", "f"], ["--flat"]),
                            (["--ucm", "./x.exr"], ["x.exr", "two outputs"])):
            self.assert_error("imgmesh-segment", ["c.glb", "-o", "x.exr", *args], 2, *words)
        self.assert_error("imgmesh-segment", ["c.glb", "-o", "x.jpg"], 2, "x.jpg", ".exr, .png, .tif, .npy or .mat")
        self.assert_error("imgmesh-segment", ["c.glb", "-o", "x.exr", "--mesh", "c.glb"], 2, "c.glb")
        self.assert_error("imgmesh-segment", ["c.glb", "-o", "x.exr", "--ucm", "no/u.exr"], 3, "no")
        self.assert_error("imgmesh-segment", ["in.png", "-o", "x.exr"], 4, "in.png")
        picture_files.png(self.folder / "other.png", picture_files.ramp(20, 10))
        self.assert_error("imgmesh-segment", ["c.glb", "-o", "x.exr", "--image", "other.png"], 4, "20x10", "60x40")

    def test_text_report(self):
        text = self.run_ok("imgmesh-segment", "c.glb", "-o", "out.exr", "--segments", "5").stdout
        self.assertTrue(text.startswith("c.glb -> out.exr\n"))
        self.assertIn("5 of ", text)


if __name__ == "__main__":
    main()

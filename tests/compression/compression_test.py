#!/usr/bin/python3
"""./run compression's arithmetic: figures by hand, the search for a number of bytes, tables and curves. Other formats'
programs are not needed."""
import contextlib
import io
import json
import math
import os
import pathlib
import re
import struct
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import jsonschema
import numpy as np
from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE.parent / "bench"), str(HERE.parents[1] / "tools" / "paper")]

import compression  # noqa: E402
import measures  # noqa: E402
import own_pictures  # noqa: E402
import report  # noqa: E402
import tables  # noqa: E402
from bench_process import BenchError  # noqa: E402
from peers import PEERS, Peer, avif_payload, last_within  # noqa: E402
from points import PictureRun, chosen  # noqa: E402

BIN = pathlib.Path(os.environ["IMGMESH_BIN"])
# Its files are copies of the picture, so that their bytes are those of the PNG.
COPY = Peer("copy", "coreutils", "png", "cp {png} {file}", "cp {file} {png}", (0,))


def point(size, psnr, scale="1", **others):
    return {"bytes": size, "scale": scale, "filter": "", "psnr": psnr, "luma_psnr": psnr, "ssim": psnr / 100,
            "ciede2000": 40 - psnr, "encode_seconds": 1, "decode_seconds": 0.1, **others}


def validate(figures):
    schema = json.loads((HERE.parents[1] / "schemas" / compression.SCHEMA).read_text("utf-8"))
    jsonschema.Draft202012Validator(schema).validate(figures)


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="imgmesh-compression-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class FiguresTest(FolderTest):
    def test_psnr_by_hand(self):
        # One of 4 x 3 samples is wrong by 255, so the mean square is 255^2 / 12; of luma the red part alone, in one of 4.
        a = np.zeros((2, 2, 3), np.uint8)
        b = a.copy()
        b[0, 1, 0] = 255
        self.assertAlmostEqual(measures.psnr(a, b), 10 * math.log10(12))
        self.assertAlmostEqual(measures.luma_psnr(a, b), 10 * math.log10(4 / 0.299 ** 2))
        self.assertEqual(measures.psnr(a, a), measures.EXACT)

    def test_equal_pictures(self):
        noise = Image.fromarray(np.random.default_rng(1).integers(0, 256, (24, 32, 3), np.uint8))
        figures = PictureRun(noise, BIN, self.folder).figures(noise)
        self.assertEqual(figures["ssim"], 1)
        self.assertEqual(figures["ciede2000"], 0)

    def test_area_average(self):
        # Three pixels become two: each covers a whole pixel and half of the one between.
        row = np.array([[[0], [90], [30]]], np.uint8)
        self.assertEqual(measures.area_average(row, 2, 1).ravel().tolist(), [30, 50])

    def test_best_of_each_metric(self):
        points = [point(1, 30), point(1, 31, "1/2")]
        self.assertEqual(chosen(points, "psnr")["scale"], "1/2")
        self.assertEqual(chosen(points, "ciede2000")["psnr"], 31)
        self.assertEqual(chosen(points, "psnr", full_size=True)["psnr"], 30)
        self.assertIsNone(chosen([], "psnr"))


class RateTest(unittest.TestCase):
    def test_half_the_bytes_everywhere(self):
        curve = [(1000, 25), (2000, 27), (4000, 30)]
        half = [(size / 2, quality) for size, quality in curve]
        self.assertAlmostEqual(measures.bd_rate([(half, curve)]), -50)
        self.assertAlmostEqual(measures.bd_rate([(curve, half)]), 100)
        # As a geometric mean, twice and half the bytes make up for each other.
        self.assertAlmostEqual(measures.bd_rate([(half, curve), (curve, half)]), 0)

    def test_by_hand(self):
        # Over the common 30 to 32 dB, ln of the ratio of bytes falls evenly from 0 to ln(1/4): the mean is ln(1/2).
        self.assertAlmostEqual(measures.bd_rate([([(1000, 30), (4000, 32)], [(1000, 30), (16000, 32)])]), -50)
        # Only 31 to 32 dB are common: from 1/2 to 1/4.
        pair = [(500, 28), (2000, 31), (4000, 32)], [(4000, 31), (16000, 32)]
        self.assertAlmostEqual(measures.bd_rate([pair]), 100 * (math.exp((math.log(1 / 2) + math.log(1 / 4)) / 2) - 1))

    def test_nothing_in_common(self):
        self.assertIsNone(measures.bd_rate([([(1000, 20), (2000, 21)], [(1000, 22), (2000, 23)])]))
        self.assertIsNone(measures.bd_rate([([], [(1000, 22)])]))

    def test_larger_and_worse_files_do_not_count(self):
        self.assertEqual(measures.rising([(3000, 29), (1000, 28), (2000, 30)]), [(1000, 28), (2000, 30)])


class SizesTest(FolderTest):
    def test_last_within(self):
        for limit, last in ((9, None), (10, 1), (29, 2), (30, 3), (1000, 5)):
            self.assertEqual(last_within((1, 2, 3, 4, 5), lambda v: 10 * v, limit), last)

    def test_qualities_come_by_rising_size(self):
        self.assertLess(PEERS["WebP"].qualities[0], PEERS["WebP"].qualities[-1])
        self.assertGreater(PEERS["AVIF"].qualities[0], PEERS["AVIF"].qualities[-1])  # quantisers
        self.assertGreater(PEERS["JPEG XL"].qualities[0], PEERS["JPEG XL"].qualities[-1])  # distances

    def test_avif_payload(self):
        file = self.folder / "a.avif"
        boxes = [(b"ftyp", b"avif"), (b"meta", bytes(40)), (b"mdat", b"coded")]
        file.write_bytes(b"".join(struct.pack(">I4s", 8 + len(data), kind) + data for kind, data in boxes))
        self.assertEqual(avif_payload(file), len(b"coded"))
        file.write_bytes(struct.pack(">I4s", 8, b"free"))
        self.assertRaises(BenchError, avif_payload, file)

    def test_smaller_pictures_fit_where_the_full_one_does_not(self):
        # Grey all over survives every scale; noise of the same size does not.
        work = PictureRun(Image.new("RGB", (96, 64), "#808080"), BIN, self.folder)
        self.assertEqual({p["psnr"] for p in work.peer_points(COPY, 10000)}, {measures.EXACT})
        noise = Image.fromarray(np.random.default_rng(1).integers(0, 256, (64, 96, 3), np.uint8))
        (self.folder / "noise").mkdir()
        work = PictureRun(noise, BIN, self.folder / "noise")
        limit = work.source("1/2").stat().st_size
        points = work.peer_points(COPY, limit)
        self.assertEqual(points[0]["scale"], "1/2")
        self.assertEqual({p["filter"] for p in points}, {"Lanczos", "bicubic"})
        self.assertTrue(all(p["bytes"] <= limit for p in points))
        self.assertEqual(work.peer_points(COPY, 10), [])


class OwnPicturesTest(unittest.TestCase):
    def test_drawings_are_flat_and_lights_are_smooth(self):
        drawings = own_pictures.drawings()
        self.assertEqual(len(drawings), 3)
        for name, image in drawings.items():
            self.assertEqual(image.size, (own_pictures.WIDTH, own_pictures.HEIGHT))
            counts = sorted((count for count, _ in image.getcolors(1 << 20)), reverse=True)
            self.assertGreater(sum(counts[:8]), 0.9 * image.width * image.height, name)
        steps = np.diff(np.asarray(own_pictures.lights()).astype(int), axis=1)
        self.assertLessEqual(np.abs(steps).max(), 4)

    def test_blurred_photographs(self):
        photographs = {"a": own_pictures.lights(), "b": own_pictures.logo()}
        smooth = own_pictures.smooth(photographs)
        self.assertEqual(list(smooth), ["lights", "a-blurred", "b-blurred"])
        self.assertEqual(smooth["b-blurred"].size, photographs["b"].size)


class ReportTest(FolderTest):
    def figures(self):
        """Two pictures: the mesh is better by 2 dB, and AVIF has no file of 1000 bytes for the second."""
        def codecs(avif):
            return {"mesh": {"1000": [point(990, 27)], "2000": [point(1990, 30)]},
                    "AVIF": {"1000": avif, "2000": [point(1950, 28)]}}
        photographs = {"a": codecs([point(980, 25)]), "b": codecs([])}
        return {"$schema": compression.SCHEMA, "versions": {"libavif-bin": "1"}, "empty_bytes": {"AVIF": [304, 22]},
                "lossless_bytes": {"a": {}, "b": {}}, "groups": {"photographs": photographs, "drawings": photographs}}

    def test_these_figures_are_such_as_it_writes(self):
        validate(self.figures())

    def test_means(self):
        title, _, head, rows = tables.all_tables(self.figures())[0]
        self.assertEqual((title, head), ("Photographs", ["bytes", "mesh", "AVIF"]))
        self.assertEqual(rows, [["1000", "27.00 / 27.00 / 0.270 / 13.00", ""],
                                ["2000", "30.00 / 30.00 / 0.300 / 10.00", "28.00 / 28.00 / 0.280 / 12.00"]])

    def test_signs(self):
        found = {title: rows for title, _, _, rows in tables.all_tables(self.figures())}
        self.assertEqual(found["Where the mesh wins and where it loses"], [["a", "+2.00"], ["b", "+2.00"]])
        rates = found["Bytes of the mesh against those of others at equal quality, in percent"][0]
        self.assertEqual(rates[0], "AVIF")
        self.assertTrue(all(cell.startswith("-") for cell in rates[1:]), rates)

    def test_files(self):
        report.write(self.figures(), [1000, 2000], ["a"], self.folder)
        self.assertIn("| 1000 | 27.00 / 27.00 / 0.270 / 13.00 |  |", (self.folder / "compression.md").read_text("utf-8"))
        curves = list(self.folder.glob("compression-*.svg"))
        self.assertEqual(len(curves), len(measures.METRICS) + 1)
        for file in curves:
            xml.etree.ElementTree.parse(file)
        self.assertIn("<svg", (self.folder / "compression.html").read_text("utf-8"))

    def test_options(self):
        o = compression.options(["bin", "in", "out", "--codecs", "AVIF,mesh", "--bytes", "4000,1000,1000"])
        self.assertEqual((o.codecs, o.bytes), (["mesh", "AVIF"], [1000, 4000]))
        with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()):
            compression.options(["bin", "in", "out", "--codecs", "GIF"])


class RunTest(FolderTest):
    def test_meshes_alone(self):
        """The whole, on one small picture: figures that agree with the schema, files within the bytes, and a page whose
        pictures are there."""
        pictures, out = self.folder / "in", self.folder / "out"
        pictures.mkdir()
        own_pictures.lights().resize((64, 48)).save(pictures / "lights.png")
        with contextlib.redirect_stdout(io.StringIO()) as printed, contextlib.redirect_stderr(io.StringIO()):
            compression.main([str(BIN), str(pictures), str(out), "--codecs", "mesh", "--groups", "photographs", "--bytes",
                              "200,2000", "--jobs", "1"])
        figures = json.loads((out / "compression.json").read_text("utf-8"))
        validate(figures)
        by_limit = figures["groups"]["photographs"]["lights"]["mesh"]
        self.assertLess(by_limit["200"][0]["psnr"], by_limit["2000"][0]["psnr"])
        for limit, (only,) in by_limit.items():
            file = out / "files" / "mesh" / "photographs" / f"lights-{limit}.imgm"
            self.assertEqual(file.stat().st_size, only["bytes"])
            self.assertLessEqual(only["bytes"], int(limit))
        self.assertIn("| 2000 | ", printed.getvalue())
        shown = re.findall('src="([^"]+)"', (out / "compression.html").read_text("utf-8"))
        self.assertEqual(len(shown), 2)  # the original, and of the sizes that are shown the one that was asked for
        self.assertTrue(all((out / name).exists() for name in shown))


if __name__ == "__main__":
    unittest.main()

"""Data instead of colours: heights, signed integers, nodata. Files are written by hand, as numpy has them."""
import struct

import numpy as np

import picture_files as files
from support import CliCase, main

KINDS = {"u1": 1, "u2": 1, "u4": 1, "i1": 2, "i2": 2, "i4": 2, "f2": 3, "f4": 3, "f8": 3}  # TIFF's SampleFormat
NODATA = 42113


def tiff(path, samples, nodata=None):
    """A TIFF of one strip with the numbers of `samples`, height x width (x bands), in their own type."""
    samples = np.asarray(samples)
    bands = samples.shape[2] if samples.ndim == 3 else 1
    kind = samples.dtype.str[1:]
    data = samples.astype("<" + kind).tobytes()
    tags = [(256, 4, [samples.shape[1]]), (257, 4, [samples.shape[0]]), (258, 3, [samples.dtype.itemsize * 8] * bands),
            (259, 3, [1]), (262, 3, [1]), (273, 4, [0]), (277, 3, [bands]), (278, 4, [samples.shape[0]]),
            (279, 4, [len(data)]), (338, 3, [0] * (bands - 1)), (339, 3, [KINDS[kind]] * bands)]
    tags = [t for t in tags if t[2]]
    if nodata is not None:
        tags.append((NODATA, 2, [c for c in str(nodata).encode()] + [0]))
    size = {2: ("B", 1), 3: ("H", 2), 4: ("I", 4)}
    after = 8 + 2 + 12 * len(tags) + 4
    entries, extra = b"", b""
    for tag, type_, values in tags:
        letter, width = size[type_]
        if tag == 273:
            packed = b"\xEE\xEE\xEE\xEE"
        else:
            packed = struct.pack("<%d%s" % (len(values), letter), *values)
        if len(packed) > 4:
            entries += struct.pack("<HHII", tag, type_, len(values), after + len(extra))
            extra += packed + b"\0" * (len(packed) % 2)
        else:
            entries += struct.pack("<HHI", tag, type_, len(values)) + packed.ljust(4, b"\0")
    entries = entries.replace(b"\xEE\xEE\xEE\xEE", struct.pack("<I", after + len(extra)))
    path.write_bytes(b"II*\0" + struct.pack("<IH", 8, len(tags)) + entries + b"\0\0\0\0" + extra + data)
    return path


def heights(low, high, width=48, height=32):
    y, x = np.mgrid[0:height, 0:width]
    wave = np.sin(x / 9) * np.cos(y / 7) + 0.3 * np.sin(x / 3 + y / 5)
    return low + (high - low) * (wave - wave.min()) / (wave.max() - wave.min())


class Values(CliCase):
    def round_trip(self, picture, *args, output="back.tif"):
        report = self.build(picture, "--values", *args)
        self.assertEqual(self.report("imgmesh-info", "out.glb", "--validate")["findings"], [])
        self.run_ok("imgmesh-reconstruct", "out.glb", "-o", output)
        return report, files.read(self.folder / output)

    def test_numbers_of_every_type_come_back_with_every_vertex(self):
        """Integers are exact after rounding."""
        for kind, low, high in (("u1", 0, 255), ("i1", -128, 127), ("u2", 0, 65535), ("i2", -32768, 32767),
                                ("u4", 0, 2 ** 32 - 1), ("i4", -2 ** 31, 2 ** 31 - 1), ("f2", -2, 900),
                                ("f4", -1e-3, 1e-3), ("f4", 8000, 8020), ("f8", -11000, 8848.86), ("f4", 1e30, 3e30)):
            with self.subTest(kind=kind, low=low):
                data = heights(low, high).astype(kind) if kind[0] == "f" else np.clip(
                    np.round(heights(low, high)), low, high).astype(kind)
                tiff(self.folder / "in.tif", data)
                report, back = self.round_trip("in.tif", "--faces", "100000")
                self.assertEqual(report["values"], True)
                self.assertEqual(report["clipped_samples"], 0)
                exact = kind[0] != "f" and int(kind[1]) < 4
                found = np.round(back[..., 0]) if exact else back[..., 0]
                step = 0 if exact else 2 ** -22 * float(max(abs(low), abs(high)))
                self.assertLessEqual(np.abs(found.astype(float) - data.astype(float)).max(), step)

    def test_errors_are_in_the_unit_of_the_values(self):
        """Millimetres instead of metres: a thousand times the numbers, and the same mesh."""
        metres = heights(500, 520).astype("f4")
        tiff(self.folder / "m.tif", metres)
        report, back = self.round_trip("m.tif", "--vertices", "150")
        rms = np.sqrt(np.mean((back[..., 0] - metres) ** 2))
        self.assertAlmostEqual(report["map_rms"], rms, delta=0.01 * rms)
        self.assertAlmostEqual(report["channel_rms"]["value"], rms, delta=0.01 * rms)
        self.assertLess(rms, 1)
        tiff(self.folder / "k.tif", (metres.astype(float) * 1024).astype("f4"))
        other, _ = self.round_trip("k.tif", "--vertices", "150")
        self.assertAlmostEqual(other["map_rms"] / 1024, report["map_rms"], delta=1e-4 * rms)
        self.assertEqual(other["vertices"], report["vertices"])
        self.assertLessEqual(self.build("m.tif", "--values", "--rms", "0.2")["map_rms"], 0.2)
        shown = self.run_ok("imgmesh-build", "m.tif", "-o", "x.glb", "--values").stdout
        self.assertIn("unit", shown)
        self.assertNotIn("L*u*v*", shown)

    def test_nodata_is_a_mask(self):
        data = heights(-20, 900).astype("i2")
        hole = np.zeros(data.shape, bool)
        hole[5:20, 30:40] = True
        data[hole] = -9999
        for named, args in ((-9999, ()), (None, ("--nodata", "-9999")), (7, ("--nodata", "-9999"))):
            with self.subTest(named=named, args=args):
                tiff(self.folder / "in.tif", data, named)
                report, back = self.round_trip("in.tif", "--faces", "100000", *args)
                self.assertEqual(report["pixels"], (~hole).sum())
                np.testing.assert_array_equal(np.isnan(back[..., 0]), hole)
                np.testing.assert_array_equal(np.round(back[..., 0][~hole]), data[~hole])
                self.assertEqual(self.report("imgmesh-info", "out.glb")["build"]["mask"], "nodata")
        # What was written names its nodata, so it can be read again.
        tiff(self.folder / "in.tif", data, -9999)
        compared = self.report("imgmesh-compare", "in.tif", "back.tif", "--values", "--tolerance", "0.001")["difference"]
        self.assertEqual((compared["pixels"], compared["in_one_only"]), ((~hole).sum(), 0))
        self.assertLess(compared["channels"]["value"]["max"], 0.01)
        self.assertEqual(self.build("back.tif", "--values")["pixels"], (~hole).sum())
        self.assertEqual(self.build("in.tif", "--values", "--nodata", "none")["pixels"], data.size)

    def test_nodata_and_a_mask_both_count(self):
        data = heights(0, 10).astype("f4")
        data[:4] = np.nan
        tiff(self.folder / "in.tif", data, "nan")
        inside = np.ones(data.shape + (1,))
        inside[:, :6] = 0
        files.png(self.folder / "mask.png", inside)
        report = self.build("in.tif", "--values", "--mask", "mask.png")
        self.assertEqual(report["pixels"], (32 - 4) * (48 - 6))
        tiff(self.folder / "in.tif", data)
        self.assert_error("imgmesh-build", ["in.tif", "-o", "x.glb", "--values"], 4, "in.tif", "finite")
        self.assertEqual(self.build("in.tif", "--values", "--nodata", "nan")["pixels"], 28 * 48)

    def test_nodata_without_values(self):
        shades = np.full((8, 9), 200, "u1")
        shades[2:4] = 0
        tiff(self.folder / "in.tif", shades, 0)
        self.assertEqual(self.build("in.tif")["pixels"], 6 * 9)
        files.png(self.folder / "in.png", shades[..., None] / 255)
        self.assertEqual(self.build("in.png", "--nodata", "0")["pixels"], 6 * 9)
        self.assertEqual(self.build("in.png")["pixels"], 8 * 9)

    def test_bands(self):
        data = np.dstack([heights(0, 4000), heights(-5, 5) ** 2, heights(10, 11)]).astype("f4")
        tiff(self.folder / "in.tif", data)
        report, back = self.round_trip("in.tif", "--faces", "100000", "--channels", "Y,channel1:100,channel2:1000")
        np.testing.assert_allclose(back, data, rtol=1e-6, atol=1e-3)
        self.assertEqual(list(report["channel_rms"]), ["value", "channel1", "channel2"])
        _, back = self.round_trip("in.tif", "--channels", "channel2", output="back.exr")
        self.assertEqual(list(files.spec(self.folder / "back.exr").channelnames), ["channel2"])
        color = np.dstack([heights(0, 255)] * 3).astype(int) / 255
        files.png(self.folder / "c.png", color)
        report, back = self.round_trip("c.png", "--faces", "100000")
        np.testing.assert_array_equal(np.round(back), np.round(color * 255))
        self.assertEqual(list(report["channel_rms"]), ["value.R", "value.G", "value.B"])

    def test_compare_tells_how_far_values_are_apart(self):
        data = heights(0, 100).astype("f4")
        tiff(self.folder / "a.tif", data)
        data[3, 4] += 8
        tiff(self.folder / "b.tif", data)
        channel = self.report("imgmesh-compare", "a.tif", "b.tif", "--values")["difference"]["channels"]["value"]
        self.assertAlmostEqual(channel["max"], 8, places=4)
        self.assertAlmostEqual(channel["rms"], 8 / np.sqrt(data.size), places=4)
        self.report("imgmesh-compare", "a.tif", "b.tif", "--values", "--tolerance", "0.1", code=7)
        self.report("imgmesh-compare", "a.tif", "b.tif", "--values", "--tolerance", "0.3")
        self.assertIn("value", self.run_ok("imgmesh-compare", "a.tif", "b.tif", "--values").stdout)

    def test_clipped_colours_are_counted(self):
        data = heights(0.1, 0.9).astype("f4")
        data[2, 3:6] = -0.25
        tiff(self.folder / "in.tif", data)
        result = self.run_tool("imgmesh-build", "in.tif", "-o", "out.glb")
        self.assertEqual(result.returncode, 0)
        self.assertIn("warning: in.tif: 3 samples", result.stderr)
        self.assertIn("--values", result.stderr)
        self.assertEqual(self.build("in.tif")["clipped_samples"], 3)
        data = np.round(heights(-100, 3000)).astype("i2")
        tiff(self.folder / "in.tif", data)
        report = self.report("imgmesh-build", "in.tif", "-o", "out.glb")
        self.assertEqual(report["images"][0]["clipped_samples"], (data < 0).sum())
        self.assertIn("signed", report["warnings"][0])
        self.assertEqual(self.build("in.tif", "--values")["clipped_samples"], 0)

    def test_what_does_not_go_together(self):
        tiff(self.folder / "in.tif", heights(0, 1).astype("f4"))
        for args in (("--texture",), ("--color-space", "sRGB"), ("--refine", "3"), ("--preset", "best")):
            result = self.run_tool("imgmesh-build", "in.tif", "-o", "x.glb", "--values", *args)
            self.assertIn(result.returncode, (2, 5), args)
        for value in ("", "x", "1,5", "none2"):
            self.assert_error("imgmesh-build", ["in.tif", "-o", "x.glb", "--nodata", value], 2, "--nodata")
        tiff(self.folder / "all.tif", np.full((4, 4), 5, "i2"), 5)
        self.assert_error("imgmesh-build", ["all.tif", "-o", "x.glb", "--values"], 5, "all.tif", "no pixel")


if __name__ == "__main__":
    main()

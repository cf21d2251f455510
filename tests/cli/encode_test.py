"""Coded pictures: numbers that are asked for, pictures of every kind and size, other sizes and meshes, damaged files."""
import json
import struct
import subprocess

import numpy as np

import picture_files
from support import BIN, CliCase, main

WIDTH, HEIGHT = 48, 32


def soft(width, height):
    """A disc with a soft edge on nothing: R, G, B and alpha."""
    y, x = np.mgrid[0:height, 0:width]
    far = np.hypot(x - width / 2, y - height / 2)
    alpha = np.clip((0.45 * height - far) / 6 + 0.5, 0, 1)
    return np.concatenate([picture_files.ramp(width, height), alpha[..., None]], axis=-1)


class Encode(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "in.png", picture_files.ramp(WIDTH, HEIGHT))

    def encode(self, picture, *args, output="x.imgm"):
        report = self.report("imgmesh-encode", picture, "-o", output, "--effort", "1", *args)
        self.assertEqual(report["bytes"], (self.folder / output).stat().st_size)
        parts = ("header_bytes", "point_bytes", "face_bytes", "color_bytes")
        self.assertEqual(sum(report[part] for part in parts), report["bytes"])
        return report

    def decode(self, name="x.imgm", *args, output="out.png"):
        report = self.report("imgmesh-decode", name, "-o", output, *args)
        return report, picture_files.read(self.folder / output)

    def test_numbers_that_are_asked_for(self):
        wanted = picture_files.read(self.folder / "in.png")
        for args in (["--bytes", "60"], ["--bytes", "300"], ["--psnr", "25"], ["--psnr", "32"], ["--vertices", "30"],
                     ["--quality", "40"], ["--quality", "60"], []):
            with self.subTest(args):
                report = self.encode("in.png", *args)
                self.assertTrue(report["target_reached"])
                decoded, drawn = self.decode()
                self.assertEqual(drawn.shape, wanted.shape)
                psnr = picture_files.psnr(drawn, wanted)
                self.assertAlmostEqual(psnr, report["psnr"], delta=0.01)
                for name in ("vertices", "faces", "grid_step", "channels"):
                    self.assertEqual(decoded[name], report[name])
                option, value = (args + ["", "0"])[:2]
                if option == "--bytes":
                    self.assertLessEqual(report["bytes"], int(value))
                    self.assertGreaterEqual(report["bytes"], 0.6 * int(value))
                elif option == "--psnr":
                    self.assertGreater(psnr, float(value) - 0.1)
                elif option == "--vertices":
                    self.assertEqual(report["vertices"], int(value))
        self.assertLess(self.encode("in.png", "--quality", "30")["vertices"],
                        self.encode("in.png", "--quality", "60")["vertices"])

    def test_numbers_that_are_missed(self):
        picture_files.png(self.folder / "noise.png", picture_files.noise(31, 23))
        result = self.run_tool("imgmesh-encode", "noise.png", "-o", "x.imgm", "--psnr", "99", "--effort", "1")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stderr, r"^imgmesh-encode: warning: noise.png: a PSNR of 99 dB was wanted, .*\n$")
        self.assertFalse(self.encode("noise.png", "--psnr", "99")["target_reached"])
        (self.folder / "x.imgm").unlink()
        self.assert_error("imgmesh-encode", ["noise.png", "-o", "x.imgm", "--psnr", "99", "--strict"], 5, "PSNR of 99 dB")
        self.assert_error("imgmesh-encode", ["noise.png", "-o", "x.imgm", "--bytes", "3"], 2, "noise.png: ", "bytes")
        self.assertFalse(self.encode("noise.png", "--vertices", "5000")["target_reached"])

    def test_sizes(self):
        for width, height in ((1, 1), (1, 9), (9, 1), (2, 2), (3, 3), (2, 7), (70, 1)):
            for picture in (picture_files.noise(width, height), picture_files.noise(width, height, 4)):
                with self.subTest((width, height, picture.shape[2])):
                    picture_files.png(self.folder / "tiny.png", picture)
                    report = self.encode("tiny.png")
                    self.assertEqual((report["width"], report["height"]), (width, height))
                    for scale in ("1", "2", "0.5"):
                        decoded, drawn = self.decode("x.imgm", "--scale", scale)
                        size = [max(1, int(float(scale) * side + 0.5)) for side in (width, height)]
                        self.assertEqual([decoded["drawn_width"], decoded["drawn_height"]], size)
                        self.assertEqual(drawn.shape[:2], (size[1], size[0]))
                    for kind in ("glb", "obj", "ply", "svg"):
                        self.assertEqual(self.run_tool("imgmesh-decode", "x.imgm", "-o", f"x.{kind}", "-q").returncode, 0)

    def test_kinds_of_pictures(self):
        """As few channels as the picture takes. What is wholly opaque or grey gets no channels for it."""
        color = picture_files.ramp(WIDTH, HEIGHT)
        grey = color[..., :1]
        opaque = np.ones_like(grey)
        indices = (np.mgrid[0:HEIGHT, 0:WIDTH].sum(axis=0) // 12 % 3)[..., None]
        palette = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        for channels, samples, options in (("Y", grey, {}), ("Y", np.repeat(grey, 3, axis=-1), {}),
                                           ("YA", np.concatenate([grey, soft(WIDTH, HEIGHT)[..., 3:]], axis=-1), {}),
                                           ("RGB", np.concatenate([color, opaque], axis=-1), {}),
                                           ("RGB", indices, {"palette": palette}), ("RGBA", soft(WIDTH, HEIGHT), {})):
            with self.subTest(channels=channels, shape=samples.shape):
                picture_files.png(self.folder / "kind.png", samples, **options)
                report = self.encode("kind.png", "--quality", "80")
                self.assertEqual("".join(report["channels"]), channels)
                _, drawn = self.decode()
                self.assertEqual(drawn.shape[2], len(channels))
                wanted = np.asarray(palette)[indices[..., 0]] if options else samples
                if channels.endswith("A"):  # colours count as far as they are seen
                    wanted, drawn = (p[..., :-1] * p[..., -1:] for p in (wanted, drawn))
                least = 12 if options else 24
                self.assertGreater(picture_files.psnr(drawn, wanted[..., :drawn.shape[2]]), least)

    def test_finer_samples(self):
        """Rounded to 8 bits, with one line that says so. Linear light becomes sRGB."""
        picture_files.png(self.folder / "deep.png", picture_files.ramp(WIDTH, HEIGHT), bits=16)
        picture_files.write_float(self.folder / "bright.exr", 4 * picture_files.ramp(WIDTH, HEIGHT), "half")
        for name, words in (("deep.png", "are rounded to 8 bits"), ("bright.exr", "are clipped and rounded to 8 bits")):
            result = self.run_tool("imgmesh-encode", name, "-o", "x.imgm", "-q", "--effort", "1")
            self.assertEqual((result.returncode, result.stderr.count("\n")), (0, 1), result.stderr)
            self.assertIn(f"warning: {name}: ", result.stderr)
            self.assertIn(words, result.stderr)
        self.run_ok("imgmesh-encode", "in.png", "-o", "y.imgm", "-q", "--effort", "1")
        self.run_tool("imgmesh-encode", "deep.png", "-o", "x.imgm", "-q", "--effort", "1")
        self.assertEqual((self.folder / "x.imgm").read_bytes(), (self.folder / "y.imgm").read_bytes())

    def test_container(self):
        """Encoded as what imgmesh-reconstruct draws of it."""
        self.build("in.png", output="in.glb")
        self.run_ok("imgmesh-reconstruct", "in.glb", "-o", "again.png", "-q")
        for name in ("in.glb", "again.png"):
            self.encode(name, output=f"{name}.imgm")
        self.assertEqual((self.folder / "in.glb.imgm").read_bytes(), (self.folder / "again.png.imgm").read_bytes())

    def test_other_outputs(self):
        self.encode("in.png")
        _, drawn = self.decode()
        for name in ("x.tif", "x.webp", "x.bmp"):
            np.testing.assert_array_equal(self.decode(output=name)[1], drawn)
        self.assertGreater(picture_files.psnr(self.decode(output="x.jpg")[1], drawn), 30)
        report, small = self.decode("x.imgm", "--size", "20x9")
        self.assertEqual((small.shape[:2], report["drawn_width"], report["drawn_height"]), ((9, 20), 20, 9))
        report = self.report("imgmesh-decode", "x.imgm", "-o", "x.glb")
        self.assertNotIn("drawn_width", report)
        data = (self.folder / "x.glb").read_bytes()
        document = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
        self.assertNotIn("IMGMESH_pixel_map", document.get("extensionsUsed", []))
        position = document["accessors"][document["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
        self.assertEqual((position["count"], position["min"], position["max"]),
                         (report["vertices"], [-0.5, 0.5 - HEIGHT, 0], [WIDTH - 0.5, 0.5, 0]))
        self.run_ok("imgmesh-decode", "x.imgm", "-o", "x.obj", "-q")
        lines = (self.folder / "x.obj").read_text().splitlines()
        self.assertEqual((sum(l.startswith("v ") for l in lines), sum(l.startswith("f ") for l in lines)),
                         (report["vertices"], report["faces"]))

    def test_alpha_of_meshes(self):
        """A white disc is white wherever it is seen or fades; .svg fades too, and what cannot says so."""
        picture = soft(WIDTH, HEIGHT)
        picture[..., :3] = 1
        picture_files.png(self.folder / "disc.png", picture)
        self.encode("disc.png", "--quality", "80")
        for kind in ("obj", "ply"):
            result = self.run_tool("imgmesh-decode", "x.imgm", "-o", f"x.{kind}", "-q")
            self.assertEqual(result.stderr, f"imgmesh-decode: warning: x.imgm: its alpha is lost, .{kind} has none\n")
        vertices = [line.split()[1:] for line in (self.folder / "x.obj").read_text().splitlines() if line.startswith("v ")]
        self.assertGreater(min(float(sample) for vertex in vertices for sample in vertex[3:]), 0.9)
        self.run_ok("imgmesh-decode", "x.imgm", "-o", "x.svg", "-q")
        text = (self.folder / "x.svg").read_text()
        self.assertIn('stop-color="#ffffff" stop-opacity="', text)
        self.assertNotIn("#000000", text)

    def test_info(self):
        encoded = self.encode("in.png")
        report = self.report("imgmesh-decode", "x.imgm", "--info")
        self.assertEqual((report["coded_bytes"], report["vertices"], report["width"]),
                         (encoded["bytes"], encoded["vertices"], WIDTH))
        self.assertIn(f"{WIDTH} x {HEIGHT} pixels, R G B", self.run_ok("imgmesh-decode", "x.imgm", "--info").stdout)
        for args, words in (([], ["--output", "--info"]), (["--info", "-o", "y.png"], ["--info writes nothing"]),
                            (["--info", "--scale", "2"], ["--scale"]), (["-o", "y.glb", "--scale", "2"], ["no pixels"]),
                            (["-o", "y.docx"], ["y.docx"]), (["-o", "y.png", "--size", "0x3"], ["--size '0'"]),
                            (["-o", "y.png", "--scale", "1e6"], ["--scale", "x.imgm"])):
            self.assert_error("imgmesh-decode", ["x.imgm", *args], 2, *words)
        self.assert_error("imgmesh-encode", ["in.png", "-o", "y.png"], 2, "y.png", ".imgm")
        self.assert_error("imgmesh-encode", ["in.png", "-o", "y.imgm", "--bytes", "9", "--psnr", "30"], 2, "--psnr")

    def test_options_from_a_file(self):
        (self.folder / "c.toml").write_text("[encode]\nvertices = 30\n[decode]\nscale = 0.5\n")
        self.assertEqual(self.encode("in.png", "--config", "c.toml")["vertices"], 30)
        report, _ = self.decode("x.imgm", "--config", "c.toml")
        self.assertEqual((report["drawn_width"], report["drawn_height"]), (WIDTH // 2, HEIGHT // 2))

    def test_other_tools_know_the_signature(self):
        self.encode("in.png")
        self.assert_error("imgmesh-info", ["x.imgm"], 4, "x.imgm: is a coded picture", "imgmesh-decode")
        self.assert_error("imgmesh-build", ["x.imgm", "-o", "x.glb"], 5, "x.imgm: a coded picture", "imgmesh-decode")
        self.assert_error("imgmesh-encode", ["x.imgm", "-o", "y.imgm"], 5, "x.imgm: a coded picture")
        self.assert_error("imgmesh-decode", ["in.png", "-o", "y.png"], 4, "in.png: is no coded picture: ", "signature")
        self.assert_error("imgmesh-decode", ["none.imgm", "-o", "y.png"], 3, "none.imgm: cannot read")

    def test_damaged_files(self):
        """Never more than one line, and nothing of an output. Bytes that still mean a picture draw one."""
        self.encode("in.png", "--bytes", "250")
        good = (self.folder / "x.imgm").read_bytes()
        for size in (0, 1, 3, 4, 5, 6, 8, len(good) // 3, len(good) - 6):
            (self.folder / "bad.imgm").write_bytes(good[:size])
            self.assert_error("imgmesh-decode", ["bad.imgm", "-o", "y.png"], 4, "bad.imgm: ")
        for tail in (b"\0" * 20, b"x" * 300):
            (self.folder / "bad.imgm").write_bytes(good + tail)
            self.assert_error("imgmesh-decode", ["bad.imgm", "-o", "y.png"], 4, "bad.imgm: has bytes after its end: ")
        (self.folder / "bad.imgm").write_bytes(good[:3] + bytes([good[3] + 0x10]) + good[4:])
        self.assert_error("imgmesh-decode", ["bad.imgm", "-o", "y.png"], 5, "bad.imgm: has version 2")
        # 65535 x 65535 pixels in a few bytes.
        (self.folder / "bad.imgm").write_bytes(good[:4] + b"\xfe\xff\x03\xfe\xff\x03" + good[6:])
        self.assert_error("imgmesh-decode", ["bad.imgm", "-o", "y.png"], 4, "bad.imgm: is 65535 x 65535 pixels")
        random = np.random.default_rng(5)
        for _ in range(60):
            changed = bytearray(good)
            for _ in range(random.integers(1, 4)):
                changed[random.integers(3, len(good))] ^= 1 << random.integers(0, 8)
            (self.folder / "bad.imgm").write_bytes(changed)
            result = self.run_tool("imgmesh-decode", "bad.imgm", "-o", "bad.png", "-q", "--max-pixels", "1000000")
            if result.returncode != 0:
                self.assertIn(result.returncode, (4, 5))
                self.assert_error_lines("imgmesh-decode", result, result.returncode, 1)
        self.assert_error("imgmesh-decode", ["x.imgm", "-o", "y.png", "--max-bytes", "100"], 4, "x.imgm", "100 bytes")
        self.assert_error("imgmesh-decode", ["x.imgm", "-o", "y.png", "--max-pixels", "1000"], 4, "x.imgm", "1000")

    def test_batch(self):
        picture_files.png(self.folder / "b.png", soft(20, 16))
        (self.folder / "bad.png").write_bytes(b"nothing")
        result = self.run_tool("imgmesh-encode", "in.png", "bad.png", "b.png", "-o", "coded/", "--effort", "1")
        self.assert_error_lines("imgmesh-encode", result, 4, 1)
        self.assertEqual(sorted(p.name for p in (self.folder / "coded").glob("*.imgm")), ["b.imgm", "in.imgm"])
        self.run_ok("imgmesh-decode", "coded/b.imgm", "coded/in.imgm", "-o", "drawn/", "--format", "webp")
        self.assertEqual(sorted(p.name for p in (self.folder / "drawn").glob("*.webp")), ["b.webp", "in.webp"])
        self.run_ok("imgmesh-decode", "coded/b.imgm", "coded/in.imgm", "--info")

    def test_pipes_and_threads(self):
        self.run_ok("imgmesh-encode", "in.png", "-o", "x.imgm", "-q", "--effort", "1", "--threads", "1")
        coded = subprocess.run([BIN / "imgmesh-encode", "-", "-o", "-", "--effort", "1"], check=True, capture_output=True,
                               input=(self.folder / "in.png").read_bytes()).stdout
        self.assertEqual(coded, (self.folder / "x.imgm").read_bytes())
        drawn = subprocess.run([BIN / "imgmesh-decode", "-", "-o", "-"], check=True, capture_output=True, input=coded).stdout
        self.decode()
        self.assertEqual(drawn, (self.folder / "out.png").read_bytes())


if __name__ == "__main__":
    main()

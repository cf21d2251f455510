"""Small files that ask for too much: each ends with its exit code, in one line if it is refused, within bounds.

The files of shared/cases/hostile are tried where that folder lies beside the checkout. Of each kind this test also
makes one of its own. Time is that of the processor, of the tool and of all that it starts, so other work on the machine
does not count."""
import json
import os
import struct
import subprocess
import zlib

import numpy as np
from PIL import Image

import picture_files
from support import BIN, ROOT, CliCase, main

FOLDER = next((p for p in (parent / "shared/cases/hostile" for parent in ROOT.parents) if p.is_dir()), None)
MOST_SECONDS, MOST_MEGABYTES = 10, 500  # twice the seconds of an idle machine

# What is done with a container. The file's place is {}, that of an image of its size is {image}.
CONTAINER_RUNS = (
    ("imgmesh-info", "{}"),
    ("imgmesh-info", "{}", "--validate"),
    ("imgmesh-reconstruct", "{}", "-o", "out.png"),
    ("imgmesh-reconstruct", "{}", "-o", "out.png", "--mode", "flat", "--scale", "1.25"),
    ("imgmesh-reconstruct", "{}", "-o", "out.svg", "--mode", "wire"),
    ("imgmesh-convert", "{}", "-o", "out.glb"),
    ("imgmesh-convert", "{}", "-o", "out.gltf"),
    ("imgmesh-convert", "{}", "-o", "out.ply"),
    ("imgmesh-segment", "{}", "-o", "out.exr"),
    ("imgmesh-compare", "{}"),
    ("imgmesh-warp", "{}", "-o", "out.glb", "--handle", "3,3:1,0"),
    ("imgmesh-warp", "{}", "--displacement", "out.exr", "--retarget", "10000x1"),
)
PICTURE_RUNS = (
    ("imgmesh-build", "{}", "-o", "out.glb"),
    ("imgmesh-build", "plain.png", "--mask", "{}", "-o", "out.glb"),
    ("imgmesh-compare", "{}", "plain.png"),
    ("imgmesh-info", "{}"),
    ("imgmesh-reconstruct", "{}", "-o", "out.png"),
)
# The exit codes that are right for a file, by tool. 0: all is well; 4: a broken file; 5: not supported.
READ = {"imgmesh-build": (0, 4), "imgmesh-compare": (0, 4), "imgmesh-info": (4,), "imgmesh-reconstruct": (4,)}
REFUSED = {"imgmesh-build": (4,), "imgmesh-compare": (4,), "imgmesh-info": (4,), "imgmesh-reconstruct": (4,)}
SOUND = {tool: (0,) for tool, *_ in CONTAINER_RUNS}
BROKEN = {tool: (4,) for tool, *_ in CONTAINER_RUNS}
FOLDED = {tool: (0, 5) for tool, *_ in CONTAINER_RUNS}  # drawn as its map says; its faces alone are not
SHARED = {
    "nodes100k.glb": SOUND, "exts3k.glb": SOUND, "esc.glb": SOUND, "chan_nul.glb": BROKEN, "over34k_d.glb": FOLDED,
    "levels32_1k.glb": FOLDED, "ztxt100.png": READ, "decoy.jp2": REFUSED, "grid_lie128.avif": REFUSED,
    "solid4096.webp": REFUSED,
}


def chunks_of(glb):
    """The JSON of a .glb, and what follows it."""
    length = struct.unpack_from("<I", glb, 12)[0]
    return json.loads(glb[20:20 + length]), glb[20 + length:]


def glb_of(data, rest):
    text = json.dumps(data).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + rest
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def boxed(name, body):
    return struct.pack(">I4s", 8 + len(body), name) + body


def size_marker(width, height, tile=0):
    return b"\xff\x4f\xff\x51" + struct.pack(">HHIIIIIIIIH", 47, 0, width, height, 0, 0, tile or width, tile or height,
                                             0, 0, 3) + b"\7\1\1" * 3


def tiff(width, height, rows, strip, strips):
    """A grey TIFF of deflated strips that all lie in one place."""
    count = len(strips)
    entries = [(256, 4, 1, width), (257, 4, 1, height), (258, 3, 1, 8), (259, 3, 1, 8), (262, 3, 1, 1),
               (273, 4, count, 0), (277, 3, 1, 1), (278, 4, 1, rows), (279, 4, count, 0)]
    data_at = 8 + 2 + 12 * len(entries) + 4
    offsets_at = data_at + len(strip)
    places = {273: offsets_at, 279: offsets_at + 4 * count}
    out = struct.pack("<2sHIH", b"II", 42, 8, len(entries))
    for tag, kind, n, value in entries:
        out += struct.pack("<HHII", tag, kind, n, places.get(tag, value))
    out += struct.pack("<I", 0) + strip
    return out + struct.pack(f"<{count}I", *[data_at] * count) + struct.pack(f"<{count}I", *[len(strip)] * count)


class Hostile(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "plain.png", picture_files.ramp(40, 30))

    def bounded(self, tool, *args):
        """Runs it and gives its exit code and what it wrote; it must keep to the bounds."""
        out, err = self.folder / "stdout", self.folder / "stderr"
        with open(out, "wb") as stdout, open(err, "wb") as stderr:
            process = subprocess.Popen([BIN / tool, *args], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=stdout,
                                       stderr=stderr)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        self.assertLess(usage.ru_utime + usage.ru_stime, MOST_SECONDS, "seconds of the processor")
        self.assertLess(usage.ru_maxrss / 1024, MOST_MEGABYTES, "megabytes")  # the largest of all processes
        return process.returncode, out.read_bytes(), err.read_bytes()

    def check(self, path, runs, codes):
        for tool, *args in runs:
            command = [str(path) if a == "{}" else a for a in args]
            with self.subTest(file=path.name, tool=tool, args=args):
                code, stdout, stderr = self.bounded(tool, *command)
                self.assertIn(code, codes[tool], stderr)
                for text in (stdout, stderr):
                    self.assertTrue(text.decode().replace("\n", "").isprintable(), text[:300])
                if code and "--validate" not in args:
                    lines = stderr.decode().splitlines()
                    self.assertEqual(len(lines), 1, stderr)
                    self.assertTrue(lines[0].startswith(f"{tool}: error: "), stderr)

    def made(self, name, data):
        (self.folder / name).write_bytes(data)
        return self.folder / name

    def jpeg2000(self):
        """The boxes of a small file, before its codestream, and the codestream."""
        Image.fromarray((picture_files.ramp(40, 30) * 255).astype(np.uint8)).save(self.folder / "a.jp2")
        data = (self.folder / "a.jp2").read_bytes()
        at = data.index(b"jp2c") - 4
        return data[:at], data[at + 8:]

    def test_the_folder(self):
        if not FOLDER:
            self.skipTest("the folder of hostile files is not there")
        self.assertEqual({p.name for p in FOLDER.iterdir()} - set(SHARED), set())
        for name, codes in SHARED.items():
            self.check(FOLDER / name, CONTAINER_RUNS if name.endswith(".glb") else PICTURE_RUNS, codes)

    def test_json_of_many_empty_elements(self):
        self.run_ok("imgmesh-build", "plain.png", "-o", "a.glb", "-q")
        data, rest = chunks_of((self.folder / "a.glb").read_bytes())
        nodes = data | {"nodes": data["nodes"] + [{}] * 60000}
        self.check(self.made("nodes.glb", glb_of(nodes, rest)), CONTAINER_RUNS, SOUND)
        extensions = data | {"extensions": data["extensions"] | {f"E{i}": {} for i in range(2000)}}
        self.check(self.made("extensions.glb", glb_of(extensions, rest)), CONTAINER_RUNS, SOUND)

    def test_text_that_inflates(self):
        """40 MB of text in each of twenty chunks of a PNG of one pixel."""
        text = picture_files.png_chunk(b"zTXt", b"Comment\0\0" + zlib.compress(bytes(40_000_000), 9))
        data = (self.folder / "plain.png").read_bytes()
        self.check(self.made("text.png", data[:33] + text * 20 + data[33:]), PICTURE_RUNS,
                   READ | {"imgmesh-build": (0,), "imgmesh-compare": (0,)})

    def test_jpeg2000_that_speaks_of_another_size(self):
        """What counts is the codestream's own marker. A size elsewhere changes nothing, larger or smaller."""
        head, stream = self.jpeg2000()
        original = np.asarray(Image.open(self.folder / "a.jp2"))
        header = head[head.index(b"jp2h") - 4:]
        for name, before in {"small": boxed(b"free", size_marker(8, 8)), "large": boxed(b"free", size_marker(60000, 60000)),
                             "inside": boxed(b"asoc", header.replace(struct.pack(">II", 30, 40), struct.pack(">II", 9, 9))),
                             "stream": boxed(b"uuid", bytes(16) + boxed(b"jp2c", size_marker(60000, 60000))),
                             "long": struct.pack(">I4sQ", 1, b"free", 1_200_016) + bytes(1_200_000)}.items():
            with self.subTest(name):
                file = self.made(f"{name}.jp2", head + before + boxed(b"jp2c", stream))
                self.run_ok("imgmesh-compare", file, "plain.png", "--tolerance", "5")
                self.assertEqual(original.shape, (30, 40, 3))
        # Without an end, as a box that goes to the end of the file may be.
        endless = self.made("endless.jp2", head + struct.pack(">I4s", 0, b"jp2c") + stream)
        self.check(endless, PICTURE_RUNS, READ)
        at = stream.index(b"\xff\x51") + 6
        for name, size in {"wide": (60000, 4), "huge": (16000, 16000), "flat": (0, 7)}.items():
            lie = stream[:at] + struct.pack(">II", *size) + stream[at + 8:]
            self.check(self.made(f"{name}.jp2", head + boxed(b"jp2c", lie)), PICTURE_RUNS, REFUSED)
        tiles = stream[:at] + struct.pack(">IIIIII", 4000, 4000, 0, 0, 1, 1) + stream[at + 24:]
        self.check(self.made("tiles.j2k", tiles), PICTURE_RUNS, REFUSED)
        self.check(self.made("none.jp2", head + boxed(b"free", size_marker(8, 8))), PICTURE_RUNS, REFUSED)

    def test_jpeg2000_of_packets_that_are_not_there(self):
        """65,535 layers of each tile, said by the header of the image or by that of the first tile."""
        noise = (picture_files.noise(256, 256, seed=4) * 255).astype(np.uint8)
        Image.fromarray(noise).save(self.folder / "a.j2k", tile_size=(8, 8))
        stream = (self.folder / "a.j2k").read_bytes()
        at, tile = stream.index(b"\xff\x52"), stream.index(b"\xff\x90")
        style = stream[at:at + 2 + struct.unpack_from(">H", stream, at + 2)[0]]
        many = style[:6] + b"\xff\xff" + style[8:]
        self.check(self.made("layers.j2k", stream.replace(style, many)), PICTURE_RUNS, REFUSED)
        self.assert_error("imgmesh-build", ["layers.j2k", "-o", "x.glb"], 4, "layers.j2k", "packets", "so small a file")
        length, = struct.unpack_from(">I", stream, tile + 6)
        part = stream[tile:tile + 6] + struct.pack(">I", length + len(many)) + stream[tile + 10:tile + 12] + many
        self.check(self.made("tile.j2k", stream[:tile] + part + stream[tile + 12:]), PICTURE_RUNS, REFUSED)
        few = style[:6] + b"\0\x09" + style[8:]
        self.check(self.made("few.j2k", stream.replace(style, few)), PICTURE_RUNS, READ)

    def test_canvas_and_frame(self):
        """A few bytes that claim, or hold, an image of many pixels."""
        Image.new("RGB", (4096, 4096), (9, 8, 7)).save(self.folder / "solid.webp", lossless=True)
        self.check(self.folder / "solid.webp", PICTURE_RUNS, REFUSED)
        self.assert_error("imgmesh-build", ["solid.webp", "-o", "x.glb"], 4, "so small a file", "4096x4096")
        self.assert_error("imgmesh-build", ["solid.webp", "-o", "x.glb", "--max-pixels", "1000000"], 4, "1000000 pixels")
        Image.new("RGB", (8, 8)).save(self.folder / "a.webp", lossless=True)
        frame = (self.folder / "a.webp").read_bytes()[12:]
        canvas = b"VP8X" + struct.pack("<IB3x", 10, 0) + (9999).to_bytes(3, "little") * 2
        body = b"WEBP" + canvas + frame
        self.check(self.made("canvas.webp", b"RIFF" + struct.pack("<I", len(body)) + body), PICTURE_RUNS, REFUSED)
        Image.new("P", (8, 8)).save(self.folder / "a.gif")
        gif = bytearray((self.folder / "a.gif").read_bytes())
        gif[6:10] = struct.pack("<HH", 9000, 9000)
        self.check(self.made("screen.gif", bytes(gif)), PICTURE_RUNS, REFUSED)
        image = gif.index(b",", 13)
        gif[6:10], gif[image + 5:image + 9] = struct.pack("<HH", 8, 8), struct.pack("<HH", 9000, 9000)
        self.check(self.made("frame.gif", bytes(gif)), PICTURE_RUNS, READ)

    def test_strips_of_one_place(self):
        """Two hundred strips that are one: 1 kB and 16 megapixels, and a modest image of that kind, which is read."""
        strip = zlib.compress(bytes(4096 * 81), 9)
        self.check(self.made("strips.tif", tiff(4096, 200 * 81, 81, strip, [0] * 200)), PICTURE_RUNS, REFUSED)
        strip = zlib.compress(bytes(64 * 8), 9)
        self.check(self.made("few.tif", tiff(64, 40, 8, strip, [0] * 5)), PICTURE_RUNS, READ | {"imgmesh-build": (0, 4)})

    def test_extreme_shapes(self):
        self.run_ok("imgmesh-build", "plain.png", "-o", "a.glb", "-q")
        for size in ("10000x1", "1x10000", "65535x1", "1x65535", "1x1", "3000x2"):
            code, _, stderr = self.bounded("imgmesh-warp", "a.glb", "--image", "plain.png", "-o", "w.png", "-q",
                                           "--retarget", size)
            self.assertEqual((code, stderr), (0, b""), size)
            with Image.open(self.folder / "w.png") as drawn:
                self.assertEqual("x".join(map(str, drawn.size)), size)
        for size in ("0x5", "0.001x", "65536x1", "1e9x1", "-3x4", "99999999999999999999x1", "65535x65535", "x", "nanxnan"):
            self.assert_error("imgmesh-warp", ["a.glb", "--image", "plain.png", "-o", "x.png", f"--retarget={size}"], 2,
                              "--retarget")


if __name__ == "__main__":
    main()

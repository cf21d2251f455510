"""Pictures that tile sets are made of: formats that are read by parts, in bounded memory, and broken blocks."""
import json
import resource
import struct

import numpy as np
import OpenImageIO as oiio
from PIL import Image
from support import BIN, CliCase, main


def write_exr(path, width, height, compression, tile=0, kind="half"):
    """Writes smooth colours, 256 rows at a time."""
    spec = oiio.ImageSpec(width, height, 3, kind)
    spec.attribute("compression", compression)
    spec.tile_width = spec.tile_height = tile
    out = oiio.ImageOutput.create("x.exr")
    if not out.open(str(path), spec):
        raise RuntimeError(out.geterror())
    for y in range(0, height, 256):
        rows = min(256, height - y)
        part = np.zeros((rows, width, 3), np.float32)
        part[..., 0] = np.linspace(0, .9, width)
        part[..., 1] = (np.arange(y, y + rows) / height)[:, None]
        part[..., 2] = .25
        done = (out.write_tiles(0, width, y, y + rows, 0, 1, part) if tile else
                out.write_scanlines(y, y + rows, 0, part))
        if not done:
            raise RuntimeError(out.geterror())
    out.close()


def break_block(path, count, index):
    """Damages the packed samples of one of `count` blocks; the table of their places leads to what follows it."""
    data = bytearray(path.read_bytes())
    table = next(at for at in range(8, len(data)) if struct.unpack_from("<Q", data, at)[0] == at + 8 * count)
    block = struct.unpack_from("<Q", data, table + 8 * index)[0]
    for at in range(block + 30, block + 42):
        data[at] ^= 0xFF
    path.write_bytes(data)


class TilePictures(CliCase):
    def test_broken_blocks(self):
        """A broken block of an EXR is missing in the tiles that it touches; the rest is done."""
        for name, tile, count, index, missing in (
                ("lines", 0, 9, 5, {"0/0_1", "0/1_1", "0/2_1", "0/3_1"}),
                ("tiles", 32, 40, 10, {"0/1_0", "0/2_0", "0/1_1", "0/2_1"})):
            with self.subTest(name):
                path = self.folder / f"{name}.exr"
                write_exr(path, 256, 140, "zip", tile)
                break_block(path, count, index)
                result = self.run_tool("imgmesh-build", path, "-o", name, "--tiles", 32 if tile else 64)
                self.assertEqual(result.returncode, 4, result.stderr)
                index_file = json.loads((self.folder / name / "index.json").read_text())
                self.assertEqual({t["tile"] for t in index_file["missing"] if t["tile"].startswith("0/")}, missing)
                for tile_missing in index_file["missing"]:
                    self.assertIn("rows", tile_missing["reason"])

    def test_memory(self):
        """The plan reads all of a picture of floats. As a whole, 24 megapixels take 288 MB twice."""
        if b"__asan_init" in (BIN / "imgmesh-build").read_bytes():
            self.skipTest("sanitizers take terabytes of address space")
        limit = 512 << 20
        for name, compression, tile in (("lines", "zip", 0), ("tiles", "none", 256)):
            path = self.folder / f"{name}.exr"
            write_exr(path, 6000, 4000, compression, tile)
            result = self.run_tool("imgmesh-build", path, "-o", name, "--tiles", 512, "--threads", 1, "--plan",
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            path.unlink()

    def test_whole(self):
        """A format that is only read whole is told, asks for its memory, and keeps to the limits."""
        path = self.folder / "w.bmp"
        Image.fromarray(np.zeros((2100, 2100, 3), np.uint8)).save(path)
        plan = self.report("imgmesh-build", path, "-o", "w", "--tiles", 256, "--plan")["images"][0]
        self.assertIn("every process holds all of it", " ".join(plan["warnings"]))
        self.assertGreater(min(job["memory_mb"] for job in plan["jobs"]), 8 * 3 * 2.1 * 2.1)
        self.assert_error("imgmesh-build", [path, "-o", "v", "--tiles", 256, "--max-pixels", 1000000], 4, "at most 1000000")
        result = self.run_tool("imgmesh-build", path, "-o", "v", "--tiles", 256, "--max-memory", "150M")
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("which is read as a whole", result.stderr)


if __name__ == "__main__":
    main()

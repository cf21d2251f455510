"""Tile sets as the tools read them: facts, verdicts, pictures, meshes."""
import json
import os
import resource
import shutil
import subprocess

import picture_files
from support import BIN, CliCase, main


class TileSets(CliCase):
    """A set of 4 x 2 tiles of 32 steps over a picture of 100 x 60 pixels, and of two coarser levels."""

    def setUp(self):
        super().setUp()
        subprocess.run([BIN / "write-samples", self.folder / "samples"], check=True)
        shutil.move(self.folder / "samples" / "set", self.folder / "set")
        shutil.rmtree(self.folder / "samples")

    def drawn(self, *args, output="out.png"):
        self.run_ok("imgmesh-reconstruct", *args, "-o", output)
        return picture_files.read(self.folder / output)

    def test_facts(self):
        for name in ("set", "set/", "set/index.json"):
            facts = self.report("imgmesh-info", name)
            self.assertEqual((facts["width"], facts["height"], facts["tile"]), (100, 60, 32))
            self.assertEqual([level["tiles"] for level in facts["levels"]], [8, 2, 1])
            self.assertEqual(facts["missing"], [])
        self.assertIn("4 x 2 tiles", self.run_ok("imgmesh-info", "set").stdout)

    def test_verdict(self):
        self.assertTrue(self.report("imgmesh-info", "set", "--validate")["valid"])
        self.report("imgmesh-info", "set/1/1_0.glb")  # an ordinary container
        shutil.copy(self.folder / "set/0/0_0.glb", self.folder / "set/0/1_0.glb")
        report = self.report("imgmesh-info", "set", "--validate", code=4)
        self.assertEqual([finding["code"] for finding in report["findings"]], ["set.file"])
        self.assertIn("0/1_0.glb", report["findings"][0]["message"])
        result = self.run_tool("imgmesh-info", "set", "--validate")
        self.assert_error_lines("imgmesh-info", result, 4, 1)

    def test_broken_index(self):
        path = self.folder / "set" / "index.json"
        index = json.loads(path.read_text())
        index["tiles"][0]["files"][0]["path"] = "../../c.glb"
        path.write_text(json.dumps(index))
        for tool, *args in (("imgmesh-info", "set"), ("imgmesh-reconstruct", "set", "-o", "a.png"),
                            ("imgmesh-convert", "set", "-o", "a.glb")):
            self.assert_error(tool, args, 4, "index.json", "/tiles/0/files/0/path")
        index["version"] = 2
        path.write_text(json.dumps(index))
        self.assert_error("imgmesh-info", ["set"], 5, "version 2")
        self.report("imgmesh-info", "set", "--validate", code=5)

    def test_damaged_tiles(self):
        """Every tool that reads the pixels of a tile, and the validator, tell of it in one line, at once."""
        tile = self.folder / "set/0/0_0.glb"
        other = self.folder / "set/0/1_0.glb"
        sound = tile.read_bytes()
        damages = {"swapped": lambda: (tile.write_bytes(other.read_bytes()), other.write_bytes(sound)),
                   "truncated": lambda: tile.write_bytes(sound[:len(sound) // 2]), "empty": lambda: tile.write_bytes(b""),
                   "gone": lambda: None, "no folder": lambda: shutil.rmtree(tile.parent), "a folder": tile.mkdir,
                   "a pipe": lambda: os.mkfifo(tile), "a loop": lambda: tile.symlink_to(tile.name)}
        for name, damage in damages.items():
            with self.subTest(damage=name):
                shutil.copytree(self.folder / "set", self.folder / "kept")
                tile.unlink()
                damage()
                result = self.run_tool("imgmesh-info", "set", "--validate", "--quiet")
                self.assert_error_lines("imgmesh-info", result, 4, 1)
                for tool, output in (("imgmesh-reconstruct", "a.png"), ("imgmesh-convert", "a.ply"), ("imgmesh-segment", "a.tif")):
                    result = self.run_tool(tool, "set", "-o", output)
                    self.assert_error_lines(tool, result, 4, 1)
                    self.assertIn("imgmesh-build", result.stderr)
                shutil.rmtree(self.folder / "set")
                (self.folder / "kept").rename(self.folder / "set")

    def test_hostile_index(self):
        """Numbers, names and depths that no set has: one line, exit code 4, and no memory is taken for them."""
        path = self.folder / "set" / "index.json"
        sound = path.read_text()

        def with_memory_of_1_gb():
            resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))

        def assert_refused(text):
            path.write_text(text)
            result = self.run_tool("imgmesh-info", "set", "--validate", "--quiet", preexec_fn=with_memory_of_1_gb)
            self.assert_error_lines("imgmesh-info", result, 4, 1)

        for text in ("", "null", "[" * 1000000, '{"a":' * 300000, sound[:500]):
            assert_refused(text)
        hostile = {"width": (-1, 0, 1e300, 2 ** 31, 2 ** 63), "tile": (0, -16, 1e300, 2 ** 30), "bytes": (-1, 2 ** 63, 1e300),
                   "vertices": (-1, 1e300, 2 ** 63 - 1), "path": ("../set/0/0_0.glb", "/etc/passwd", "0/../0/0_0.glb", "a\0b")}
        for name, values in hostile.items():
            for value in values:
                index = json.loads(sound)
                first = index["tiles"][0]
                (index["plan"] if name in index["plan"] else first if name in first else first["files"][0])[name] = value
                with self.subTest(member=name, value=value):
                    assert_refused(json.dumps(index))
        index = json.loads(sound)
        index["plan"].update(width=2 ** 30, height=2 ** 30, tile=16)
        assert_refused(json.dumps(index))
        index["tiles"] = index["missing"] = []
        assert_refused(json.dumps(index))

    def test_set_that_is_not_complete(self):
        (self.folder / "set" / "index.json").unlink()
        self.assert_error("imgmesh-info", ["set"], 4, "not complete")
        self.assert_error("imgmesh-reconstruct", ["set", "-o", "a.png"], 4, "not complete")
        self.assertFalse(self.report("imgmesh-info", "set", "--validate", code=4)["valid"])

    def test_pictures(self):
        """A pixel of a line that two tiles share is drawn from the one to the right of it, or below."""
        whole = self.drawn("set")
        self.assertEqual(whole.shape[:2], (60, 100))
        tile = self.drawn("set/0/1_0.glb")
        self.assertEqual(tile.shape[:2], (33, 33))
        self.assert_same(whole[:32, 32:64], tile[:32, :32])
        self.assert_same(self.drawn("set", "--crop", "20,10,50,40"), whole[10:50, 20:70])
        half = self.drawn("set", "--level", "1")
        self.assertEqual(half.shape[:2], (30, 50))
        self.assert_same(half[:, 32:], self.drawn("set/1/1_0.glb"))
        self.drawn("set/index.json", "--mode", "gouraud")
        self.assert_same(self.drawn("set", output="a.tif"), whole)
        self.assert_same(self.drawn("set", "--crop", "7,9,90,50", output="a.tif"), whole[9:59, 7:97])

    def assert_same(self, a, b):
        self.assertEqual(a.tolist(), b.tolist())

    def test_regions(self):
        """Labels of the whole picture without gaps."""
        report = self.report("imgmesh-segment", "set", "-o", "labels.tif")
        self.assertEqual(report["tiles"], 8)
        labels = picture_files.read(self.folder / "labels.tif")
        self.assertEqual(labels.shape[:2], (60, 100))
        found = {round(label * (2**32 - 1)) for label in labels.ravel().tolist()}
        self.assertEqual(found, set(range(report["regions"])))
        self.assertEqual(self.report("imgmesh-segment", "set", "-o", "a.tif", "--level", "1")["tiles"], 2)

    def test_missing_tile(self):
        """The picture has a transparent place, and says so."""
        path = self.folder / "set" / "index.json"
        index = json.loads(path.read_text())
        gone = index["tiles"].pop(0)
        index["missing"] = [{"tile": gone["tile"], "reason": "a broken strip"}]
        level = index["levels"][0]
        level["tiles"] -= 1
        level["bytes"] -= sum(file["bytes"] for file in gone["files"])
        for name in ("vertices", "own_vertices", "faces", "pixels"):
            level[name] -= gone[name]
        path.write_text(json.dumps(index))
        result = self.run_tool("imgmesh-reconstruct", "set", "-o", "gap.png")
        self.assertEqual(result.returncode, 0)
        self.assertIn("1 tile of level 0 could not be made", result.stderr)
        gap = picture_files.read(self.folder / "gap.png")
        self.assertEqual((gap[0, 0, 3], gap[0, 32, 3]), (0, 1))
        self.assertEqual(self.report("imgmesh-info", "set")["missing"], index["missing"])

    def test_meshes(self):
        for level, vertices, faces in ((0, 126, 208), (1, 40, 56), (2, 15, 16)):
            for output in ("a.glb", "a.gltf", "a.ply", "a.obj", "a.svg"):
                report = self.report("imgmesh-convert", "set", "-o", output, "--level", level)
                self.assertEqual((report["vertices"], report["faces"]), (vertices, faces))
        self.assert_error("imgmesh-info", ["a.glb"], 4, "ext.missing")

    def test_what_cannot_be(self):
        for mode in ("wire", "patches", "flat", "visits", "smooth"):
            self.assert_error("imgmesh-reconstruct", ["set", "-o", "a.png", "--mode", mode], 2, mode, "map or gouraud")
        for tool, output in (("imgmesh-reconstruct", "a.png"), ("imgmesh-convert", "a.ply")):
            self.assert_error(tool, ["set", "-o", output, "--level", "3"], 2, "--level 3", "0 to 2")
        self.assert_error("imgmesh-reconstruct", ["set", "-o", "a.png", "--crop", "90,0,20,20"], 2, "--crop", "110,20", "100x60")
        self.assert_error("imgmesh-reconstruct", ["set", "-o", "a.png", "--crop", "1,2,3"], 2, "--crop")
        self.assert_error("imgmesh-reconstruct", ["set/0/0_0.glb", "-o", "a.png", "--crop", "0,0,2,2"], 2, "--crop")
        self.assert_error("imgmesh-convert", ["set", "-o", "a.npz"], 5, "a.npz")
        for mode in ("map", "gouraud"):
            self.assert_error("imgmesh-reconstruct", ["set", "-o", "a.png", "--mode", mode, "--scale", "2"], 2, "--scale", "--level K")
        for name in ("set", "set/", "set/index.json"):
            self.assert_error("imgmesh-convert", [name, "-o", "a.npz"], 5, "; set/LEVEL/COLUMN_ROW.glb are ordinary")
        for option in (["--texture"], ["--levels", "0"], ["--layers", "exr"], ["--mesh-precision", "compact"],
                       ["--image", "a.png"], ["--outline-tolerance", "1"]):
            self.assert_error("imgmesh-convert", ["set", "-o", "a.glb", *option], 2, option[0], "tile set")
        self.assert_error("imgmesh-convert", ["set", "-o", "a.svg", "--as", "outline"], 2, "--as")
        for option in (["--draco", "edgebreaker"], ["--compression", "meshopt"], ["--shading", "gradient"]):
            self.assert_error("imgmesh-convert", ["set", "-o", "a.ply", *option], 2, option[0], "a.ply")
        for tool, *args in (("imgmesh-encode", "-o", "a.imgm"), ("imgmesh-decode", "-o", "a.png"), ("imgmesh-compare", "set"),
                            ("imgmesh-warp", "--image", "set/0/0_0.glb", "-o", "a.png")):
            self.assert_error(tool, ["set", *args], 5, "set: is a tile set", tool, "imgmesh-reconstruct" if tool != "imgmesh-warp" else ".glb")
        self.assert_error("imgmesh-warp", ["set", "-o", "a.png"], 5, "tile set")

    def test_names_of_outputs(self):
        """Of a set in a folder: that of its own folder, however it is named."""
        for name in ("set", "set/", "set/."):
            self.run_ok("imgmesh-reconstruct", name, "-o", "drawn/")
            self.run_ok("imgmesh-convert", name, "-o", "drawn/", "--format", "ply")
        self.run_ok("imgmesh-convert", "set/0/0_0.glb", "-o", "drawn/")
        self.assertEqual(sorted(path.name for path in (self.folder / "drawn").iterdir() if path.name[0] != "."),
                         ["0_0.glb", "set.ply", "set.png"])

    def test_memory(self):
        self.assert_error("imgmesh-convert", ["set", "-o", "a.ply", "--max-memory", "1M"], 4, "level 0 as one mesh")


if __name__ == "__main__":
    main()

"""Tile sets as imgmesh-build makes them: broken pictures, outputs that are no folder."""
import json
import os
import resource
import shutil
import signal
import subprocess
import time

import numpy as np
import picture_files
from support import BIN, CliCase, main


class TileBuild(CliCase):
    def setUp(self):
        super().setUp()
        self.picture = picture_files.png(self.folder / "a.png", picture_files.ramp(101, 77))

    def build_set(self, *args, picture="a.png", code=0):
        tiles = [] if "--tiles" in args else ["--tiles", 32]
        result = self.run_tool("imgmesh-build", picture, "-o", "set/", *tiles, *args)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def test_sizes(self):
        for width, height in ((2, 2), (100, 2), (31, 31), (33, 33), (34, 65), (101, 77)):
            with self.subTest(size=(width, height)):
                picture_files.png(self.folder / "a.png", picture_files.ramp(width, height))
                self.build_set()
                self.assertTrue(self.report("imgmesh-info", "set", "--validate")["valid"])
                self.run_ok("imgmesh-reconstruct", "set", "-o", "b.png")
                self.assertEqual(picture_files.read(self.folder / "b.png").shape[:2], (height, width))
                shutil.rmtree(self.folder / "set")

    def test_masks(self):
        """Every pixel inside is drawn: in noise, lines and points on the sides that tiles share, and in what ends there."""
        y, x = np.mgrid[0:77, 0:101]
        noise = np.random.default_rng(1).random((77, 101))
        masks = {"lines": (x == 32) | (y == 64), "points": (x % 32 == 0) & (y % 32 == 0), "crossing": (x == y) | (y == 10),
                 "box": (x <= 32) & (y <= 64), "checker": (x + y) % 2 == 0,
                 **{f"noise {share}": noise < share for share in (0.5, 0.97)}}
        for name, mask in masks.items():
            with self.subTest(mask=name):
                picture_files.png(self.folder / "m.png", mask[..., None].astype(float))
                self.build_set("--mask", "m.png")
                self.assertTrue(self.report("imgmesh-info", "set", "--validate")["valid"])
                self.assertEqual(self.report("imgmesh-info", "set")["levels"][0]["pixels"], mask.sum())
                self.run_ok("imgmesh-reconstruct", "set", "-o", "b.png")
                drawn = picture_files.read(self.folder / "b.png")[..., 3] > 0
                self.assertTrue((drawn == mask).all(), np.argwhere(drawn != mask)[:5])
                for output in ("b.glb", "b.svg", "b.ply"):
                    self.run_ok("imgmesh-convert", "set", "-o", output)

    def test_soft_alpha(self):
        """Kept alpha masks only what nobody sees; that of a cut is at least one half."""
        alpha = np.round(255 * np.clip((np.mgrid[0:77, 0:101][1] - 20) / 60, 0, 1)) / 255
        picture_files.png(self.folder / "a.png", np.dstack([picture_files.ramp(101, 77), alpha]))
        for use, inside in (("keep", alpha > 0), ("cut", alpha >= 0.5), ("ignore", alpha >= 0)):
            self.build_set("--alpha", use)
            self.assertEqual(self.report("imgmesh-info", "set")["levels"][0]["pixels"], inside.sum())

    def test_output_is_a_folder(self):
        for name in ("-", "out.glb", "out.gltf"):
            self.assert_error("imgmesh-build", ["a.png", "-o", name, "--tiles", 32], 2, "folder")

    def test_what_is_no_picture_of_a_set(self):
        self.assert_error("imgmesh-build", ["-", "-o", "set/", "--tiles", 32], 2, "-: a tile set is made from a file")
        self.assert_error("imgmesh-build", ["a.png", "a.png", "-o", "set/", "--tiles", 32], 2, "set/: becomes one tile set")

    def files_of_set(self):
        return {str(path.relative_to(self.folder / "set")): path.read_bytes()
                for path in (self.folder / "set").rglob("*") if path.is_file()}

    def test_folder_of_another_set(self):
        """What a new plan does not have goes, with its index at once; other files stay. The rest is as in a new folder."""
        mask = np.zeros((77, 101, 1))
        mask[:, 60:] = 1
        picture_files.png(self.folder / "m.png", mask)
        own = {"notes.txt": b"mine", "0/notes.glb": b"mine", "7/3_x.glb": b"mine", "view/2/page.json": b"mine"}
        for before, options in ((["--tiles", "16"], ["--tiles", "64"]), (["--preset", "fast"], ["--mask", "m.png"]),
                                (["--tiles", "16"], ["--error", "2000"])):
            with self.subTest(before=before, options=options):
                self.build_set(*options)
                expected = self.files_of_set()
                shutil.rmtree(self.folder / "set")
                self.build_set(*before)
                for path, content in own.items():
                    (self.folder / "set" / path).parent.mkdir(exist_ok=True)
                    (self.folder / "set" / path).write_bytes(content)
                self.build_set(*options, "--plan")
                self.assertNotIn("index.json", self.files_of_set())
                self.assert_error("imgmesh-info", ["set"], 4, "not complete")
                self.build_set(*options)
                self.assertEqual(self.files_of_set(), {**expected, **own})
                shutil.rmtree(self.folder / "set")

    def test_set_of_something_else(self):
        """A set of another plan is replaced with a warning, and with --no-overwrite not at all."""
        self.build_set("--no-overwrite")
        expected = self.files_of_set()
        self.assertEqual(self.build_set("--no-overwrite").stderr, "")
        picture_files.png(self.folder / "b.png", picture_files.ramp(101, 78))
        for picture, option in (("a.png", "--preset=fast"), ("b.png", "--quiet"), ("b.png", "--plan")):
            result = self.build_set("--no-overwrite", option, picture=picture, code=3)
            self.assertIn("set/: exists with a tile set of a.png", result.stderr)
            self.assertIn("is not overwritten", result.stderr)
            self.assertEqual(self.files_of_set(), expected)
        self.assertIn("set/: held a tile set of a.png by other options", self.build_set("--preset=fast").stderr)
        self.assertIn("set/: held a tile set of a.png, which", self.build_set(picture="b.png").stderr)
        picture_files.png(self.folder / "b.png", picture_files.ramp(101, 79))
        self.assertIn("set/: held a tile set of b.png as it was before", self.build_set(picture="b.png").stderr)

    def test_changed_part_of_a_picture(self):
        """A listed file with other bytes or of another time makes another picture; what is beside the listed ones does not."""
        parts = self.folder / "parts"
        parts.mkdir()
        whole = picture_files.ramp(100, 50)
        for column in range(2):
            picture_files.png(parts / f"{column}_0.png", whole[:, 50 * column:50 * column + 50])
        (self.folder / "list.json").write_text(json.dumps({
            "format": "imgmesh-tile-list", "version": 1,
            "tiles": [{"file": f"parts/{column}_0.png", "x": 50 * column, "y": 0} for column in range(2)]}))
        for picture in ("list.json", "parts"):
            def kept(picture=picture):
                return self.report("imgmesh-build", picture, "-o", "parts/set/", "--tiles", 32)["images"][0]["kept"]
            with self.subTest(picture=picture):
                self.assertEqual(kept(), 0)
                (parts / "notes.txt").write_text("not of the picture")
                self.assertGreater(kept(), 0)
                earlier = (parts / "1_0.png").stat().st_mtime_ns - 10 ** 9
                os.utime(parts / "1_0.png", ns=(earlier, earlier))
                self.assertEqual(kept(), 0)
                shutil.rmtree(parts / "set")

    def test_jobs_by_name(self):
        self.assert_error("imgmesh-build", ["a.png", "-o", ".", "--tiles", 32, "--job", "index"], 3, ".: has no plan for --job index")
        self.build_set("--plan")
        for name in ("tile/0/9_0", "tile/0/0_00", "tile/9/0_0", "sample/-1", "sample/9", "sample/x", "tiles", ""):
            self.assert_error("imgmesh-build", ["a.png", "-o", "set/", "--tiles", 32, "--job", name], 2, "--job")
        for name in ("spool", "sample/0", "sample/1", "sample/2", "threshold", "tile/0/3_2"):
            self.build_set("--job", name)
        self.assertIn("0/3_2.json", self.files_of_set())
        for name, again in (("sample/0", False), ("threshold", False), ("tile/0/3_2", False), ("tile/0/2_2", True)):
            self.assertEqual(self.report("imgmesh-build", "a.png", "-o", "set/", "--tiles", 32, "--job", name)["images"][0]["made"], again)

    def test_counts_of_tiles(self):
        self.assertIn("tiles   12 of 32 pixels, 17 with those of all 3 levels\n", self.build_set().stdout)
        (self.folder / "set/0/0_0.glb").unlink()
        self.assertIn("kept    14 of these 17, made by an earlier run\n", self.build_set().stdout)

    def test_small_error(self):
        """What keeps most pixels is told, and refused where there is no memory for it."""
        result = self.build_set("--error", "0.001", "--preset", "fast")
        self.assertRegex(result.stderr, r"warning: a.png: tile 0/._. keeps \d+ % of its pixels as vertices by --error 0.001")
        self.assertEqual(len(result.stderr.splitlines()), 1)
        shutil.rmtree(self.folder / "set")
        picture_files.write_float(self.folder / "a.tif", picture_files.noise(1100, 1000), "uint8")
        result = self.build_set("--tiles", "2048", "--error", "10", "--max-memory", "500M", picture="a.tif", code=5)
        self.assert_error_lines("imgmesh-build", result, 5, 1)
        self.assertIn("--error 10", result.stderr)

    def test_folder_with_other_files(self):
        """A file of a set's name that is no set's is not replaced."""
        for name in ("index.json", "plan.json", "tileset.json", "threshold.json"):
            (self.folder / "set").mkdir(exist_ok=True)
            (self.folder / "set" / name).write_text('{"mine": true}')
            self.assert_error("imgmesh-build", ["a.png", "-o", "set/", "--tiles", 32], 2, name)
            shutil.rmtree(self.folder / "set")

    def test_disk_is_full(self):
        """One line and exit code 3 wherever writing fails: the plan, the copy of the picture, a tile, the index. The next run completes it."""
        picture_files.write_float(self.folder / "a.tif", picture_files.ramp(101, 77), "uint8")
        for picture, limit in (("a.png", 100), ("a.png", 2000), ("a.tif", 1500), ("a.tif", 6000)):
            self.build_set(picture=picture)
            expected = self.files_of_set()
            shutil.rmtree(self.folder / "set")
            with self.subTest(picture=picture, bytes_of_a_file=limit):
                def without_space():
                    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
                result = self.run_tool("imgmesh-build", picture, "-o", "set/", "--tiles", 32, preexec_fn=without_space)
                self.assert_error_lines("imgmesh-build", result, 3, 1)
                self.assertIn("cannot write", result.stderr)
                self.assertNotIn("index.json", self.files_of_set())
                self.build_set(picture=picture)
                self.assertEqual(self.files_of_set(), expected)
                shutil.rmtree(self.folder / "set")

    def test_interruption(self):
        """One line, no file that is half written, and the next run goes on."""
        picture_files.png(self.folder / "a.png", picture_files.ramp(400, 300))
        with subprocess.Popen([BIN / "imgmesh-build", "a.png", "-o", "set/", "--tiles", "32"], cwd=self.folder,
                              stderr=subprocess.PIPE, text=True) as run:
            while run.poll() is None and not (self.folder / "set/0/0_0.json").exists():
                time.sleep(0.01)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.stderr.read(), "imgmesh-build: error: interrupted: set/ is not complete; the same command goes on\n")
        self.assertEqual(run.returncode, -signal.SIGINT)
        self.assertNotIn("index.json", self.files_of_set())
        self.assertIn("kept", self.build_set().stdout)

    def test_no_folder_can_be_made(self):
        (self.folder / "file").write_text("not a folder")
        for name in ("file/", "file/set/"):
            self.assert_error("imgmesh-build", ["a.png", "-o", name, "--tiles", 32], 3, "cannot make the folder")

    def test_broken_picture(self):
        """A picture of which no part can be read is told as such, not as one without pixels."""
        whole = (self.folder / "a.png").read_bytes()
        (self.folder / "a.png").write_bytes(whole[:len(whole) // 2])
        self.assert_error_lines("imgmesh-build", self.build_set(code=4), 4, 1)
        parts = self.folder / "parts"
        parts.mkdir()
        for column in range(2):
            (parts / f"{column}_0.png").write_bytes(whole[:len(whole) // 2])
        self.assertIn("_0.png", self.build_set(picture="parts", code=4).stderr)

    def test_missing_tiles(self):
        """Tiles that cannot be read are named with the reason, the rest is done, and a later run mends them."""
        parts = self.folder / "parts"
        parts.mkdir()
        whole = picture_files.ramp(150, 150)
        for row in range(3):
            for column in range(3):
                picture_files.png(parts / f"{column}_{row}.png",
                                  whole[50 * row:50 * row + 50, 50 * column:50 * column + 50])
        sound = (parts / "2_2.png").read_bytes()
        (parts / "2_2.png").write_bytes(b"not a picture" + bytes(100))
        self.assertIn("is missing", self.build_set(picture="parts", code=4).stderr)
        index = json.loads((self.folder / "set/index.json").read_text())
        self.assertIn("0/4_4", [tile["tile"] for tile in index["missing"]])
        for tile in index["missing"]:
            self.assertIn("2_2.png", tile["reason"])
        (parts / "2_2.png").write_bytes(sound)
        self.build_set(picture="parts")
        self.assertEqual(json.loads((self.folder / "set/index.json").read_text())["missing"], [])


if __name__ == "__main__":
    main()

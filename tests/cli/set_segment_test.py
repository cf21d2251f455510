"""Regions of tile sets beside those of the same picture in one container."""
import json
import pathlib
import subprocess
import tempfile

import numpy as np
import picture_files
from support import BIN, ROOT, CliCase, main

NONE = 2**32 - 1  # the label outside
PICTURE = ROOT / "tests" / "data" / "kodim23.png"
TILES = (128, 256, 1024)


def agreement(a, b):
    """The adjusted Rand index (Hubert and Arabie 1985): 1 for the same regions, 0 for those of chance."""
    def pairs(labels):
        counts = np.unique(labels, return_counts=True)[1]
        return (counts * (counts - 1.0) / 2).sum()

    in_both, in_a, in_b = pairs(a.astype(np.uint64) << 32 | b), pairs(a), pairs(b)
    chance = in_a * in_b / (a.size * (a.size - 1.0) / 2)
    return (in_both - chance) / ((in_a + in_b) / 2 - chance)


def outline_shares(labels, step):
    """The share of pairs of neighbours that are in two regions: of pairs across sides of tiles, and of all others."""
    at_sides, elsewhere = [], []
    for axis in (0, 1):
        differs = np.diff(labels.astype(np.int64), axis=axis) != 0
        side = np.arange(differs.shape[axis]) % step == step - 1
        at_sides.append(differs.compress(side, axis).ravel())
        elsewhere.append(differs.compress(~side, axis).ravel())
    return np.concatenate(at_sides).mean(), np.concatenate(elsewhere).mean()


class SetSegment(CliCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        folder = tempfile.TemporaryDirectory(prefix="imgmesh-cli-")
        cls.addClassCleanup(folder.cleanup)
        cls.inputs = pathlib.Path(folder.name)
        outputs = [["whole.glb"]] + [[f"set{step}/", "--tiles", str(step)] for step in TILES]
        for output in outputs:
            subprocess.run([BIN / "imgmesh-build", PICTURE, "-q", "-o", *output], cwd=cls.inputs, check=True)

    def labels(self, source, *args):
        report = self.report("imgmesh-segment", self.inputs / source, "-o", "labels.npy", *args)
        labels = np.load(self.folder / "labels.npy")
        inside = labels[labels != NONE]
        self.assertEqual(np.unique(inside).tolist(), list(range(report["regions"])))
        self.assertEqual(np.bincount(inside).min(), report["min_pixels"])
        self.assertEqual(np.bincount(inside).max(), report["max_pixels"])
        return report, labels

    def test_agreement(self):
        """Regions depend on the mesh: other meshes of the whole picture agree by .64 to .98 (decision 55)."""
        for args, least in (((), 0.7), (("--quality", "fast"), 0.6), (("--distance", "paper"), 0.6)):
            whole = self.labels("whole.glb", *args)
            for step in TILES if not args else TILES[:1]:
                with self.subTest(args=args, step=step):
                    report, labels = self.labels(f"set{step}", *args)
                    self.assertGreater(agreement(labels, whole[1]), least)
                    ratio = report["regions"] / whole[0]["regions"]
                    self.assertTrue(0.75 <= ratio <= 1.33, ratio)
                    self.assertLess(report["merged_up_to"], 8)
                    self.assertGreaterEqual(report["next_merge"], 8)

    def test_numbers(self):
        """Options mean the same as for one container, for the whole picture."""
        for wanted in (1, 20, 300):
            self.assertEqual(self.labels("set128", "--segments", wanted)[0]["regions"], wanted)
        self.assertGreaterEqual(self.labels("set128", "--min-size", 4000)[0]["min_pixels"], 4000)
        self.labels("set128", "--segments", "auto")
        args = [self.inputs / "set128", "-o", "a.npy", "--segments", 2**63 - 1, "--strict"]
        self.assert_error("imgmesh-segment", args, 5, "--segments", "regions were wanted, at most")
        for option in (("--superpixels", 9), ("--outlines", "a.png"), ("--ucm", "a.npy")):
            args = [self.inputs / "set128", "-o", "b.npy", *option]
            self.assert_error("imgmesh-segment", args, 2, option[0], "tile set")

    def test_no_side_shows(self):
        """Patches end at a tile's sides, so outlines that pass nearby run along some of them; no more than that."""
        for args in ((), ("--quality", "fast"), ("--segments", 100)):
            at_sides, elsewhere = outline_shares(self.labels("set128", *args)[1], 128)
            self.assertLess(at_sides, elsewhere + 0.06)

    def test_one_tile(self):
        for args in ((), ("--quality", "fast")):
            self.assertTrue(np.array_equal(self.labels("set1024", *args)[1],
                                           self.labels("set1024/0/0_0.glb", *args)[1]))

    def test_threads(self):
        one, more = (self.labels("set128", "--threads", threads)[1] for threads in (1, 3))
        self.assertTrue(np.array_equal(one, more))

    def test_areas(self):
        """Bands across many tiles come back as they are, but for the pixels of the mesh's own slopes between them."""
        bands = np.arange(200) // 40 * np.ones((300, 1), int)
        colors = np.array([[.1, .1, .5], [.8, .7, .1], [.2, .6, .2], [.9, .9, .9], [.6, .1, .1]])
        picture_files.png(self.folder / "bands.png", colors[bands])
        self.run_ok("imgmesh-build", "bands.png", "-o", "bands/", "--tiles", 32, "-q")
        report, labels = self.labels(self.folder / "bands")
        self.assertEqual((report["tiles"], report["regions"], report["joined"]), (70, 5, 5))
        self.assertLess((labels != bands).sum(), 4 * 300)

    def test_mask(self):
        """A disc of the picture, across tiles: its own outline, and the areas inside."""
        y, x = np.mgrid[0:200, 0:200]
        inside = (x - 100) ** 2 + (y - 100) ** 2 < 80 ** 2
        picture_files.png(self.folder / "a.png", np.where((x < 100)[..., None], [.9, .2, .1], [.1, .3, .8]))
        picture_files.png(self.folder / "mask.png", np.where(inside, 1.0, 0.0)[..., None])
        self.run_ok("imgmesh-build", "a.png", "-o", "disc/", "--tiles", 50, "--mask", "mask.png", "-q")
        report, labels = self.labels(self.folder / "disc", "--segments", 2)
        self.assertEqual((report["regions"], report["joined"]), (2, 2))
        self.assertTrue(np.array_equal(labels != NONE, inside))
        self.assertGreater((labels == np.where(x < 100, labels[100, 50], labels[100, 150]))[inside].mean(), 0.98)

    def test_mask_of_noise(self):
        """Each pixel of a mask has a label, also one that only the tile on the other side of a line has a face for."""
        inside = np.random.default_rng(1).random((120, 140)) > 0.4
        picture_files.png(self.folder / "a.png", picture_files.ramp(140, 120))
        picture_files.png(self.folder / "mask.png", np.where(inside, 1.0, 0.0)[..., None])
        self.run_ok("imgmesh-build", "a.png", "-o", "noise/", "--tiles", 20, "--mask", "mask.png", "-q")
        for args in ((), ("--quality", "fast")):
            _, labels = self.labels(self.folder / "noise", *args)
            self.assertTrue(np.array_equal(labels != NONE, inside))

    def test_missing_tile(self):
        """Its pixels have no label, and the regions around it are joined as before."""
        parts = self.folder / "parts"
        parts.mkdir()
        for row in range(3):
            for column in range(3):
                color = [.9, .2, .1] if row < 2 else [.1, .3, .8]
                picture_files.png(parts / f"{column}_{row}.png", np.tile(np.array(color), (60, 60, 1)))
        (parts / "1_1.png").write_bytes(b"not a picture" + bytes(100))
        self.assertEqual(self.run_tool("imgmesh-build", "parts", "-o", "set/", "--tiles", 20).returncode, 4)
        result = self.run_tool("imgmesh-segment", "set", "-o", "labels.npy", "--json", "--segments", 2)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("could not be made", result.stderr)
        self.assertEqual(json.loads(result.stdout)["regions"], 2)
        labels = np.load(self.folder / "labels.npy")
        self.assertTrue((labels[60:120, 60:120] == NONE).all())
        self.assertEqual(np.unique(labels[:40]).tolist(), [0])
        self.assertEqual(np.unique(labels[140:]).tolist(), [1])
        self.assertEqual([np.unique(labels[:110, side]).tolist() for side in (30, 150)], [[0], [0]])


if __name__ == "__main__":
    main()

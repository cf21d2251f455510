"""--max-memory and --max-pixels: work is refused before it starts, and the estimate is near what is taken."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy
import picture_files
from support import BIN, TOOLS, CliCase, main

WIDTH, HEIGHT = 800, 600


def scene():
    """Smooth colours with an edge and a little noise, as a photograph has."""
    y, x = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    noise = numpy.random.default_rng(1).integers(0, 8, (HEIGHT, WIDTH, 3))
    color = numpy.stack([x * 200 // WIDTH, y * 200 // HEIGHT, ((x // 50 + y // 40) % 2) * 120], axis=2)
    return (color + noise).astype(numpy.uint8)


class Memory(CliCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.sanitized = b"__asan_init" in (BIN / "imgmesh-info").read_bytes()
        # Made once, as building it takes a second.
        folder = tempfile.TemporaryDirectory(prefix="imgmesh-cli-")
        cls.addClassCleanup(folder.cleanup)
        cls.inputs = pathlib.Path(folder.name)
        picture_files.png(cls.inputs / "in.png", scene())
        subprocess.run([BIN / "imgmesh-build", "in.png", "-o", "in.glb", "-q", "--preset", "fast"], cwd=cls.inputs,
                       check=True)
        subprocess.run([BIN / "imgmesh-encode", "in.png", "-o", "in.imgm", "-q", "--effort", "1"], cwd=cls.inputs,
                       check=True)

    def setUp(self):
        super().setUp()
        for name in ("in.png", "in.glb", "in.imgm"):
            shutil.copy(self.inputs / name, self.folder)
        self.jobs = {
            "imgmesh-build": ["in.png", "-o", "out.glb"],
            "imgmesh-reconstruct": ["in.glb", "-o", "out.png"],
            "imgmesh-info": ["in.glb"],
            "imgmesh-compare": ["in.png", "in.glb"],
            "imgmesh-convert": ["in.glb", "-o", "out.glb", "--texture"],
            "imgmesh-warp": ["in.glb", "--image", "in.png", "--handle", "200,150:9,-4", "-o", "out.png"],
            "imgmesh-segment": ["in.glb", "-o", "out.png"],
            "imgmesh-encode": ["in.png", "-o", "out.imgm", "--effort", "1"],
            "imgmesh-decode": ["in.imgm", "-o", "out.png"],
        }
        self.assertEqual(sorted(self.jobs), sorted(TOOLS))

    def peak(self, tool, *args):
        """The most memory that a run holds at a time, in bytes."""
        # The helper is small: what the parent of a program holds counts as the program's until it starts.
        helper = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True); "
                  "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
        result = subprocess.run([sys.executable, "-c", helper, str(BIN / tool), *args], cwd=self.folder, check=True,
                                stdout=subprocess.PIPE, encoding="utf-8")
        return int(result.stdout) * 1024

    def test_small_limits_are_not_rounded(self):
        self.assert_error("imgmesh-build", ["in.png", "-o", "x.glb", "--max-memory", "1.5k"], 4, "at most 1500 bytes")
        self.assert_error("imgmesh-build", ["in.png", "-o", "x.glb", "--max-memory", "2.5M"], 4, "at most 2500 kB")

    def test_too_little_is_refused_in_every_tool(self):
        for tool, args in self.jobs.items():
            # Reading alone, and all of the work.
            for limit in ("1k", "20M"):
                result = self.assert_error(tool, [*args, "--max-memory", limit], 4, "memory")
                self.assertRegex(result.stderr, r"\d ([kM]?B|bytes)\b.*\d")

    def test_message_names_need_and_limit(self):
        result = self.assert_error("imgmesh-build", ["in.png", "-o", "out.glb", "--max-memory", "30M"], 4, "in.png",
                                   "800x600", "at most 30 MB")
        need = int(re.search(r"about (\d+) MB", result.stderr).group(1))
        self.assertGreater(need, 30)
        self.assert_error("imgmesh-reconstruct", ["in.glb", "-o", "out.png", "--max-memory", "20M"], 4, "in.glb",
                          "800x600", "--max-memory is 20.0 MB")
        self.assert_error("imgmesh-info", ["in.glb", "--max-memory", "1M"], 4, "[limits.memory]", "1000000")

    def test_enough_changes_no_byte(self):
        for tool, args in self.jobs.items():
            outputs = []
            for options in ((), ("--max-memory", "100G")):
                result = self.run_ok(tool, *args, *options)
                written = [p.read_bytes() for p in sorted(self.folder.glob("out.*"))]
                told = [line for line in result.stdout.splitlines() if not line.startswith("  time ")]
                outputs.append((told, written))
            self.assertTrue(outputs[0] == outputs[1], tool)

    def test_estimates_are_near_what_is_taken(self):
        """Not below the peak by more than a tenth, nor above twice the peak."""
        if self.sanitized:
            self.skipTest("sanitizers take memory of their own")
        jobs = list(self.jobs.items())
        jobs += [("imgmesh-build", ["in.png", "-o", "out.glb", "--levels", "3"]),
                 ("imgmesh-build", ["in.png", "-o", "out.glb", "--map", "trivial", "--refine", "0"]),
                 ("imgmesh-reconstruct", ["in.glb", "-o", "out.png", "--mode", "gouraud", "--scale", "2"]),
                 ("imgmesh-reconstruct", ["in.glb", "-o", "out.png", "--mode", "smooth", "--image", "in.png"]),
                 ("imgmesh-decode", ["in.imgm", "-o", "out.glb"]),
                 ("imgmesh-decode", ["in.imgm", "-o", "out.png", "--scale", "3"]),
                 ("imgmesh-compare", ["in.glb"]), ("imgmesh-compare", ["in.png", "in.png"])]
        for tool, args in jobs:
            with self.subTest(tool=tool, args=args):
                peak = self.peak(tool, *args, "-q")
                self.assert_error(tool, [*args, "--max-memory", int(0.9 * peak)], 4, "memory")
                self.run_ok(tool, *args, "-q", "--max-memory", int(2 * peak))

    def test_scale_counts(self):
        args = ["in.glb", "-o", "out.png", "--mode", "gouraud", "--max-memory", "150M"]
        self.run_ok("imgmesh-reconstruct", *args, "-q")
        (self.folder / "out.png").unlink()
        self.assert_error("imgmesh-reconstruct", [*args, "--scale", "6"], 4, "4800x3600")

    def test_images_of_a_batch_wait_for_memory(self):
        """Both fit, but not at a time: they are built one after the other, with the same bytes."""
        picture_files.png(self.folder / "b.png", scene()[::-1])
        self.run_ok("imgmesh-build", "in.png", "b.png", "-o", "free/", "-q")
        self.run_ok("imgmesh-build", "in.png", "b.png", "-o", "bound/", "-q", "--max-memory", "100M")
        for name in ("in.glb", "b.glb"):
            self.assertEqual((self.folder / "free" / name).read_bytes(), (self.folder / "bound" / name).read_bytes())

    def test_one_image_of_a_batch_is_too_large(self):
        picture_files.png(self.folder / "small.png", picture_files.ramp(40, 30))
        result = self.run_tool("imgmesh-build", "in.png", "small.png", "-o", "out/", "-q", "--max-memory", "40M")
        self.assert_error_lines("imgmesh-build", result, 4, 1)
        self.assertEqual([p.name for p in (self.folder / "out").glob("[!.]*")], ["small.glb"])

    def test_sizes(self):
        args = ["in.glb", "-q", "--max-memory"]
        for size in ("1000000000", "1G", "1.5G", "100000k", "1T", "200M"):
            self.run_ok("imgmesh-info", *args, size)
        for size in ("", "G", "1g", "1GB", "-1", "0", "nan", "inf", "1e300", "1 G", "1GG", "10%"):
            self.assert_error("imgmesh-info", [*args, size], 2, "--max-memory", "2G")

    def test_config(self):
        (self.folder / "o.toml").write_text('max-memory = "1k"\n')
        self.assert_error("imgmesh-info", ["in.glb", "--config", "o.toml"], 4, "limits.memory")
        self.run_ok("imgmesh-info", "in.glb", "-q", "--config", "o.toml", "--max-memory", "1G")

    def test_pixels_of_images_and_containers(self):
        pixels = WIDTH * HEIGHT
        for tool in ("imgmesh-compare", "imgmesh-segment", "imgmesh-warp", "imgmesh-convert"):
            self.run_ok(tool, *self.jobs[tool], "-q", "--max-pixels", pixels)
            for path in self.folder.glob("out.*"):
                path.unlink()
            name = "in.png" if tool == "imgmesh-compare" else "limits.pixels"
            self.assert_error(tool, [*self.jobs[tool], "--max-pixels", pixels - 1], 4, name)
        self.assert_error("imgmesh-compare", ["in.glb", "--max-pixels", pixels - 1], 4, "limits.pixels")
        # An image beside a smaller container.
        picture_files.png(self.folder / "small.png", picture_files.ramp(40, 30))
        self.run_ok("imgmesh-build", "small.png", "-o", "small.glb", "-q")
        for tool in ("imgmesh-segment", "imgmesh-warp"):
            args = [self.jobs[tool][0].replace("in", "small"), "--image", "in.png", *self.jobs[tool][1:]]
            if tool == "imgmesh-warp":
                args = ["small.glb", "--image", "in.png", "--handle", "20,15:2,1", "-o", "out.png"]
            self.assert_error(tool, [*args, "--max-pixels", 1200], 4, "in.png", "1200")


if __name__ == "__main__":
    main()

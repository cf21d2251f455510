"""engines_test.py BIN [KILLS]: a tile set has the same files whoever makes it, in whatever order, and however often the work was ended.

One process with one thread makes the set to compare with. Then other numbers of threads, jobs in random order, GNU parallel, Snakemake
on this computer and through Slurm (slurm_cluster.py) make it, and one process is killed KILLS times (6), each time at another moment, and
started again. All files must be the same bytes, and none more. IMGMESH_REQUIRE_ENGINES=1: a program that is not there is a failure.
"""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from PIL import Image

import slurm_cluster

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples" / "tiles"
PICTURE = HERE.parent / "data" / "kodim23.png"
SIZE = (500, 350)
TILE = 150  # 4 x 3 tiles, the last of each row and column smaller, then 2 x 2 and 1
TOOL = ""
KILLS = 6


def files_of(folder):
    """Returns the bytes of every file below a folder, hidden ones too."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def need(*programs):
    for program in programs:
        if shutil.which(program, path=slurm_cluster.search_path()):
            continue
        if os.environ.get("IMGMESH_REQUIRE_ENGINES") == "1":
            raise AssertionError(f"there is no {program}; ./run setup engines installs it")
        raise unittest.SkipTest(f"there is no {program}; ./run setup engines installs it")


class Engines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="imgmesh-engines-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.picture = cls.folder / "picture.tif"
        Image.open(PICTURE).crop((0, 0, *SIZE)).save(cls.folder / "picture.png")
        if shutil.which("vips"):  # a tiled BigTIFF of another program
            subprocess.run(["vips", "tiffsave", "picture.png", "picture.tif", "--bigtiff", "--tile", "--tile-width=64",
                            "--tile-height=64", "--compression=deflate"], cwd=cls.folder, check=True)
        else:
            Image.open(cls.folder / "picture.png").save(cls.picture)
        start = time.monotonic()
        subprocess.run(cls.command("one"), check=True, stdout=subprocess.DEVNULL)
        cls.seconds = time.monotonic() - start
        cls.expected = files_of(cls.folder / "one")

    @classmethod
    def command(cls, name, threads=1):
        return [TOOL, str(cls.picture), "-o", f"{cls.folder / name}/", "--tiles", str(TILE), "--threads", str(threads)]

    def jobs(self, name):
        done = subprocess.run([*self.command(name), "--plan", "--json"], check=True, stdout=subprocess.PIPE)
        return json.loads(done.stdout)["images"][0]["jobs"]

    def snakemake(self, name, profile, *options, environment=None, config=()):
        """The command of the workflow, which has a folder of its own for what it remembers."""
        work = self.folder / f"work-{name}"
        work.mkdir(exist_ok=True)
        command = ["snakemake", "-s", str(EXAMPLES / "Snakefile"), "--profile", str(EXAMPLES / profile), "-j", "2", *options,
                   "--config", f"picture={self.picture}", f"out={self.folder / name}", f"tiles={TILE}", f"tool={TOOL}", *config]
        # CI: it asks for the state of jobs each second, not each tenth.
        return {"args": command, "cwd": work, "env": {**(environment or os.environ), "CI": "true"},
                "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}

    def run_snakemake(self, name, *args, **kwargs):
        done = subprocess.run(**self.snakemake(name, *args, **kwargs), check=False)
        self.assertEqual(done.returncode, 0, done.stdout)
        return done.stdout

    def assert_same_files(self, name):
        files = files_of(self.folder / name)
        self.assertEqual(sorted(files), sorted(self.expected))
        self.assertEqual([path for path in files if files[path] != self.expected[path]], [])

    def test_set_has_all_levels_and_nothing_else(self):
        self.assertIn("index.json", self.expected)
        self.assertIn("tileset.json", self.expected)
        tiles = [path for path in self.expected if path.endswith(".glb") and not path.startswith("view/")]
        self.assertEqual(len(tiles), 4 * 3 + 2 * 2 + 1)
        self.assertEqual([path for path in self.expected if path.startswith(("work/", "."))], [])

    def test_threads(self):
        subprocess.run(self.command("threads", 2), check=True, stdout=subprocess.DEVNULL)
        self.assert_same_files("threads")

    def test_jobs_in_any_order(self):
        for seed in range(2):
            order = random.Random(seed)
            name = f"order-{seed}"
            waiting, done = self.jobs(name), set()
            while waiting:
                ready = [job for job in waiting if done.issuperset(job["needs"])]
                job = order.choice(ready)
                subprocess.run([*job["command"], "--quiet"], check=True)
                self.assertTrue((self.folder / name / job["output"]).exists(), job["name"])
                waiting.remove(job)
                done.add(job["name"])
            self.assert_same_files(name)

    def test_one_job_done_twice_at_a_time(self):
        """An engine that lost a job starts another one, while the first still runs."""
        for job in self.jobs("twice"):
            both = [subprocess.Popen([*job["command"], "--quiet"]) for _ in range(2)]
            self.assertEqual([each.wait() for each in both], [0, 0], job["name"])
        self.assert_same_files("twice")

    def test_parallel(self):
        need("parallel", "jq")
        script = [str(EXAMPLES / "parallel.sh"), "2", *self.command("parallel")]
        running = subprocess.Popen(script, stdout=subprocess.DEVNULL, start_new_session=True)
        time.sleep(self.seconds)
        os.killpg(running.pid, signal.SIGKILL)
        running.wait()
        done = subprocess.run(script, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.assertIn("jobs of tile/0: 12\n", done.stderr)
        self.assertIn(f"{self.folder / 'parallel'}/: 17 tiles of 3 levels, 0 missing\n", done.stderr)
        self.assert_same_files("parallel")

    def test_commands_that_lack_something(self):
        need("parallel", "jq", "snakemake")
        for arguments in [], ["imgmesh-build", "huge.tif"]:
            done = subprocess.run([str(EXAMPLES / "parallel.sh"), *arguments], check=False, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertTrue(done.stderr.startswith("usage: parallel.sh PROCESSES imgmesh-build "), done.stderr)
        done = subprocess.run(["snakemake", "-s", str(EXAMPLES / "Snakefile"), "-j", "1", "--config", "picture=huge.tif"], check=False,
                              cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("expected --config picture=huge.tif out=set", done.stdout)

    def test_snakemake(self):
        need("snakemake")
        self.run_snakemake("local", "local")
        self.assert_same_files("local")
        self.assertIn("Nothing to be done", self.run_snakemake("local", "local"))
        # A tile that was removed is made again, in whatever place of its batch.
        (self.folder / "local" / "0" / "1_1.json").unlink()
        self.run_snakemake("local", "local", config=["batch=3"])
        self.assert_same_files("local")

    def test_snakemake_goes_on_after_a_kill(self):
        need("snakemake")
        running = subprocess.Popen(**self.snakemake("killed", "local", config=["batch=3"]), start_new_session=True)
        tile = self.folder / "killed" / "0" / "2_0.json"
        end = time.monotonic() + 60
        while not tile.exists() and running.poll() is None and time.monotonic() < end:
            time.sleep(0.01)
        os.killpg(running.pid, signal.SIGKILL)
        running.communicate()
        self.assertFalse((self.folder / "killed" / "index.json").exists())
        self.run_snakemake("killed", "local", config=["batch=3"])
        self.assert_same_files("killed")

    def test_broken_part_of_the_picture(self):
        """Engines make all other tiles and name those that are missing; when the part can be read again, these alone are made."""
        need("snakemake", "parallel", "jq")
        parts = self.folder / "parts"
        parts.mkdir()
        with Image.open(PICTURE) as whole:
            for part in range(4):
                left, top = 250 * (part % 2), 175 * (part // 2)
                whole.crop((left, top, left + 250, top + 175)).save(parts / f"{part % 2}_{part // 2}.png")
        broken = parts / "1_1.png"
        sound, time_of_all = broken.read_bytes(), os.stat(broken).st_mtime_ns

        def write(content):
            broken.write_bytes(content)
            os.utime(broken, ns=(time_of_all, time_of_all))  # so that the plan is the same

        write(sound[:1000] + bytes(1000) + sound[2000:])
        # With an error, as samples of the picture would lack that part, and the number of vertices would be another one.
        options = ["--error", "20000"]
        snakemake = {"config": [f"picture={parts}", "batch=3", f"options={' '.join(options)}"]}
        done = subprocess.run(**self.snakemake("broken-local", "local", **snakemake), check=False)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertRegex(done.stdout, r"tiles that could not be made: \d+, all others are done: 0/\d_\d: ")
        command = [TOOL, str(parts), *self.command("broken-parallel")[2:], *options]
        script = [str(EXAMPLES / "parallel.sh"), "2", *command]
        done = subprocess.run(script, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertRegex(done.stderr, r"error: .*parts: tile 0/\d_\d is missing: ")
        self.assertTrue(files_of(self.folder / "broken-local") == files_of(self.folder / "broken-parallel"))
        missing = [tile["tile"] for tile in json.loads((self.folder / "broken-local" / "index.json").read_text())["missing"]]
        self.assertTrue(0 < len(missing) < 4 * 3, missing)
        made = {path: path.stat().st_mtime_ns for path in (self.folder / "broken-parallel" / "0").iterdir()
                if f"0/{path.stem}" not in missing}

        write(sound)
        self.run_snakemake("broken-local", "local", **snakemake)
        subprocess.run(script, check=True, stdout=subprocess.DEVNULL)
        self.assertEqual({path: path.stat().st_mtime_ns for path in made}, made)
        files = files_of(self.folder / "broken-parallel")
        self.assertTrue(files_of(self.folder / "broken-local") == files)
        shutil.rmtree(self.folder / "broken-parallel")
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        self.assertTrue(files_of(self.folder / "broken-parallel") == files)

    def test_snakemake_through_slurm(self):
        need("snakemake", *slurm_cluster.PROGRAMS)
        with slurm_cluster.slurm_cluster() as environment:
            out = self.run_snakemake("slurm", "slurm", "--latency-wait", "5", "--max-status-checks-per-second", "10",
                                     environment=environment, config=["batch=6"])
        self.assertIn("external jobid", out)
        self.assert_same_files("slurm")

    def test_kills(self):
        """kill -9 at moments spread over the whole run; each run goes on from what the last left, and a set of its own is completed."""
        order = random.Random(22)
        often = self.command("often")
        for kill in range(KILLS):
            moment = self.seconds * (kill + order.random()) / KILLS
            name = f"kill-{kill}"
            for command, after in (self.command(name), moment), (often, order.random() * self.seconds / 4):
                running = subprocess.Popen(command, stdout=subprocess.DEVNULL)
                try:
                    running.wait(after)
                except subprocess.TimeoutExpired:
                    running.kill()
                    running.wait()
            subprocess.run(self.command(name), check=True, stdout=subprocess.DEVNULL)
            self.assert_same_files(name)
            shutil.rmtree(self.folder / name)
        subprocess.run(often, check=True, stdout=subprocess.DEVNULL)
        self.assert_same_files("often")


if __name__ == "__main__":
    TOOL = str(pathlib.Path(sys.argv[1]).resolve() / "imgmesh-build")
    if len(sys.argv) > 2:
        KILLS = int(sys.argv[2])
    unittest.main(argv=sys.argv[:1], verbosity=2)

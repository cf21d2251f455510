"""The process that decodes and encodes for a tool: a batch outlives it, and nothing foreign gets into it."""
import io
import os
import pathlib
import resource
import shutil
import signal
import stat
import struct
import subprocess
import sys
import threading
import time

import numpy as np
from PIL import Image

import picture_files
from support import BIN, CliCase, main

CODECS = BIN.parent / "lib" / "imgmesh" / "imgmesh-codecs"
FOREIGN = pathlib.Path(os.environ["IMGMESH_FOREIGN_PLUGIN"])


def encoded(samples, kind):
    data = io.BytesIO()
    Image.fromarray(np.round(samples * 255).astype(np.uint8)).save(data, kind)
    return data.getvalue()


def processes():
    """(process, its parent) of every imgmesh-codecs that runs."""
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text()
        except OSError:
            continue
        name, rest = fields[fields.index("(") + 1:fields.rindex(")")], fields[fields.rindex(")") + 2:].split()
        if name == "imgmesh-codecs" and rest[0] != "Z":
            yield int(folder.name), int(rest[1])


class Killer(threading.Thread):
    """Ends the one process that decodes the file of `size` bytes, as soon as there is one."""

    def __init__(self, size, number):
        super().__init__(daemon=True)
        self.size, self.number, self.killed, self.done = size, number, None, False

    def decodes_it(self, process):
        for link in pathlib.Path(f"/proc/{process}/fd").glob("*"):
            try:
                # The input is a header, filled up to 64 bytes, and the file.
                if "imgmesh" in os.readlink(link) and 0 < os.stat(link).st_size - self.size < 1000:
                    return True
            except OSError:
                pass
        return False

    def run(self):
        while not self.done and self.killed is None:
            running = list(processes())
            for process, parent in running:
                if any(parent == other for other, _ in running) and self.decodes_it(process):
                    os.kill(process, self.number)
                    self.killed = process
                    return
            time.sleep(0.002)


class Survival(CliCase):
    def broken(self):
        """Ten files, each broken in another way, by name."""
        good = picture_files.ramp(40, 30)
        jpeg, gif, jp2 = (encoded(good, kind) for kind in ("JPEG", "GIF", "JPEG2000"))
        picture_files.png(self.folder / "good.png", good)
        png = (self.folder / "good.png").read_bytes()
        (self.folder / "good.png").unlink()
        return {
            "b0.jpg": jpeg[:len(jpeg) // 2],
            "b1.gif": gif[:60],
            "b2.jp2": jp2[:len(jp2) // 2],
            "b3.png": png[:len(png) // 2],
            "b4.jpg": b"no image at all",
            "b5.gif": b"",
            "b6.gif": b"GIF89a" + struct.pack("<HH", 65535, 65535) + bytes(200),
            "b7.hdr": b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\n" + bytes(300),
            "b8.jp2": jp2[:90] + bytes(len(jp2) - 90),
            # It decodes for about a second, and is killed meanwhile.
            "b9.jp2": encoded(picture_files.noise(1800, 1300, seed=3), "JPEG2000"),
        }

    def test_a_hundred_images_of_which_ten_are_broken(self):
        """Ninety containers, ten lines, exit code 4; one decoder dies of a signal while others work."""
        kinds = ("JPEG", "GIF", "JPEG2000", "PNG", "BMP", "PPM", "TIFF", "TGA", "WEBP")
        for i in range(90):
            kind = kinds[i % len(kinds)]
            extension = {"JPEG2000": "jp2", "TIFF": "tif"}.get(kind, kind.lower())
            (self.folder / f"g{i:02}.{extension}").write_bytes(encoded(picture_files.noise(24, 18, seed=i), kind))
        broken = self.broken()
        for name, data in broken.items():
            (self.folder / name).write_bytes(data)
        names = sorted(p.name for p in self.folder.iterdir())
        order = np.random.default_rng(5).permutation(names)  # the broken ones among the others
        killer = Killer(len(broken["b9.jp2"]), signal.SIGSEGV)
        killer.start()
        result = self.run_tool("imgmesh-build", *order, "-o", "out/", "-q", "--preset", "fast")
        killer.done = True
        self.assertIsNotNone(killer.killed)
        self.assert_error_lines("imgmesh-build", result, 4, 10)
        for name in broken:
            self.assertEqual(result.stderr.count(f" {name}: "), 1, result.stderr)
        self.assertIn("b9.jp2: cannot read the image: its decoder crashed (signal 11)\n", result.stderr)
        self.assertEqual(sorted(p.stem for p in (self.folder / "out").glob("[!.]*")), [f"g{i:02}" for i in range(90)])

    def test_alone_and_killed(self):
        (self.folder / "a.jp2").write_bytes(encoded(picture_files.noise(1800, 1300), "JPEG2000"))
        for number in (signal.SIGKILL, signal.SIGABRT):
            killer = Killer((self.folder / "a.jp2").stat().st_size, number)
            killer.start()
            self.assert_error("imgmesh-build", ("a.jp2", "-o", "a.glb"), 4, "a.jp2", "crashed", f"(signal {int(number)})")
            killer.done = True

    def test_it_ends_with_its_tool(self):
        """Even with one that is killed while it decodes."""
        (self.folder / "a.jp2").write_bytes(encoded(picture_files.noise(2500, 2000), "JPEG2000"))
        tool = subprocess.Popen([BIN / "imgmesh-build", "a.jp2", "-o", "a.glb", "-q"], cwd=self.folder)
        mine = set()
        end = time.time() + 60
        while len(mine) < 2 and time.time() < end:  # the program and the job
            running = list(processes())
            mine |= {process for process, parent in running if parent == tool.pid}
            mine |= {process for process, parent in running if parent in mine}
        self.assertEqual(len(mine), 2)
        tool.kill()
        tool.wait()
        while mine & {process for process, _ in processes()}:
            self.assertLess(time.time(), end, "imgmesh-codecs outlives its tool")
            time.sleep(0.01)

    def test_under_limits_and_without_standard_streams(self):
        (self.folder / "a.gif").write_bytes(encoded(picture_files.ramp(30, 20), "GIF"))
        self.build("a.gif", output="plain.glb")
        limits = {"files": (resource.RLIMIT_NOFILE, 16), "memory": (resource.RLIMIT_AS, 4 << 30)}
        for name, (kind, most) in limits.items():
            with self.subTest(name):
                self.run_ok("imgmesh-build", "a.gif", "-o", "a.glb", "-q",
                            preexec_fn=lambda: resource.setrlimit(kind, (most, most)))
                self.assertEqual((self.folder / "a.glb").read_bytes(), (self.folder / "plain.glb").read_bytes())
        for closed in ("<&-", ">&-", "2>&-", "<&- >&- 2>&-"):
            with self.subTest(closed):
                (self.folder / "a.glb").unlink(missing_ok=True)
                subprocess.run(["sh", "-c", f"exec {BIN}/imgmesh-build a.gif -o a.glb -q {closed}"], cwd=self.folder,
                               check=True)
                self.assertEqual((self.folder / "a.glb").read_bytes(), (self.folder / "plain.glb").read_bytes())

    def test_too_few_files_is_an_error_of_one_line(self):
        (self.folder / "a.gif").write_bytes(encoded(picture_files.ramp(30, 20), "GIF"))
        limit = lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (5, 5))
        result = self.run_tool("imgmesh-build", "a.gif", "-o", "a.glb", preexec_fn=limit)
        self.assert_error_lines("imgmesh-build", result, 3, 1)


class Installed(CliCase):
    """A tool with another program of codecs than its own."""

    def setUp(self):
        super().setUp()
        (self.folder / "a.gif").write_bytes(encoded(picture_files.ramp(30, 20), "GIF"))
        picture_files.png(self.folder / "a.png", picture_files.ramp(30, 20))

    def install(self, script):
        """A tool in a prefix of its own, where imgmesh-codecs is a script."""
        for folder in ("bin", "lib/imgmesh"):
            (self.folder / folder).mkdir(parents=True, exist_ok=True)
        shutil.copy(BIN / "imgmesh-build", self.folder / "bin")
        program = self.folder / "lib/imgmesh/imgmesh-codecs"
        program.write_text(f"#!/bin/sh\n{script}\n")
        program.chmod(0o755)

    def run_installed(self, *args, **kwargs):
        return subprocess.run([self.folder / "bin/imgmesh-build", *args, "-o", "x.glb", "-q"], cwd=self.folder,
                              capture_output=True, text=True, check=False, **kwargs)


class NothingForeign(Installed):
    """Which program is started, with what, and what it loads."""

    def test_started_for_its_formats_alone_and_beside_the_tool(self):
        self.install(f"echo run >> {self.folder}/mark; echo 'no such library: libx.so' >&2; exit 127")
        self.assertEqual(self.run_installed("a.png").returncode, 0)
        self.assertFalse((self.folder / "mark").exists())
        result = self.run_installed("a.gif")
        self.assertEqual(result.returncode, 5)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn("cannot start imgmesh-codecs: no such library: libx.so", result.stderr)
        self.assertEqual((self.folder / "mark").read_text(), "run\n")

    def test_environment_folder_and_files(self):
        """Nothing of the caller's environment and open files; the folder is the root."""
        self.install(f"export -p > {self.folder}/variables; pwd > {self.folder}/where; "
                     f"echo /proc/$$/fd/* > {self.folder}/files; exit 1")
        with open(self.folder / "a.png", "rb") as leak:
            os.dup2(leak.fileno(), 40)
            self.addCleanup(os.close, 40)
            self.run_installed("a.gif", close_fds=False,
                               env=os.environ | {"OIIO_LIBRARY_PATH": "/x", "LD_LIBRARY_PATH": "/x", "SECRET": "1"})
        names = {line.split()[1].split("=")[0] for line in (self.folder / "variables").read_text().splitlines()}
        self.assertLessEqual(names, {"LC_ALL", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "PWD", "OLDPWD"})
        self.assertEqual((self.folder / "where").read_text(), "/\n")
        numbers = {int(pathlib.Path(p).name) for p in (self.folder / "files").read_text().split()}
        self.assertLessEqual(numbers, {0, 1, 2, 3, 4, 10, 255})  # above 3: the shell's own

    def test_not_a_stranger_s(self):
        """A program beside the tool that belongs to somebody else is not started."""
        if os.geteuid() != 0:
            self.skipTest("only root gives files away")
        self.install(f"echo run > {self.folder}/mark; exit 1")
        os.chown(self.folder / "lib/imgmesh/imgmesh-codecs", 12345, 12345)
        self.run_installed("a.gif")
        self.assertFalse((self.folder / "mark").exists())

    def test_plugins_and_libraries_that_lie_about(self):
        """Neither OpenImageIO's plugins nor a library beside the image."""
        plugins = self.folder / "plugins"
        plugins.mkdir()
        for name in ("foreign.imageio.so", "libforeign.so"):
            shutil.copy(FOREIGN, plugins / name)
        for name in ("imgmesh-oiio.so", "libOpenImageIO.so.2.4", "libpng16.so.16", "libjpeg.so.62", "libtbb.so.12"):
            shutil.copy(FOREIGN, self.folder / name)
        env = os.environ | {"OIIO_LIBRARY_PATH": str(plugins), "OPENIMAGEIO_PLUGIN_PATH": str(plugins),
                            "OPENIMAGEIO_OPTIONS": f"plugin_searchpath={plugins}"}
        self.run_ok("imgmesh-build", "a.gif", "-o", "a.glb", "-q", env=env)
        self.run_ok("imgmesh-reconstruct", "a.glb", "-o", "b.bmp", "-q", env=env)
        self.assertEqual(list(self.folder.rglob("*.loaded")), [])

    def test_a_start_that_fails_by_a_signal_is_tried_again(self):
        """Somebody, or a system without memory, ends the program before it has taken any job."""
        self.install(f'echo run >> {self.folder}/mark; test "$(wc -l < {self.folder}/mark)" = 3 || kill -ABRT $$; '
                     f"exec {CODECS}")
        self.assertEqual(self.run_installed("a.gif").returncode, 0)
        self.install(f"echo run >> {self.folder}/mark; echo 'no memory' >&2; kill -ABRT $$")
        (self.folder / "mark").unlink()
        result = self.run_installed("a.gif")
        self.assertEqual(result.returncode, 5)
        self.assertEqual(result.stderr, "imgmesh-build: error: cannot start imgmesh-codecs: no memory\n")
        self.assertEqual((self.folder / "mark").read_text(), "run\n" * 3)

    def test_not_for_people(self):
        result = subprocess.run([CODECS], capture_output=True, text=True, check=False, close_fds=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("a part of imgmesh", result.stderr)
        self.assertTrue(CODECS.stat().st_mode & stat.S_IXUSR)


# A program that takes one job and answers with what it is told to, whatever that means.
LIAR = """
import array, os, socket, struct, sys, time
server = socket.socket(fileno=3)
message, files, _, _ = server.recvmsg(4096, 4096)
numbers = array.array("i", files[0][2][:8])
job = socket.socket(fileno=numbers[0])
def reply(kind, code=0, sample_type=0, size=(0, 0, 0), header=0, data=0, text=b"", magic=0x48434D49):
    try:
        job.send(struct.pack("<IIiIqqqQQ8192s", magic, kind, code, sample_type, *size, header, data, text))
    except OSError:
        sys.exit()  # nobody listens any more
STARTED, OFFER, DONE, ERROR, NO_MEMORY, DIED = range(6)
"""


class Liar(Installed):
    """What the program says is checked, as what a file says is."""

    def answer(self, script):
        self.install(f"exec {sys.executable} -I -c '{LIAR}{script}'")
        return self.run_installed("a.gif")

    def test_answers_that_make_no_sense(self):
        started = "reply(STARTED); "
        for script, code, words in (
                ("reply(STARTED, magic=7)", 4, "wrong answer"),
                ("reply(DONE)", 4, "wrong answer"),
                ("job.send(b\"short\"); time.sleep(1)", 5, "cannot start"),
                (started + "reply(DONE)", 4, "gave no image"),
                (started + "reply(9)", 4, "wrong answer"),
                (started, 4, "was ended"),
                (started + "reply(NO_MEMORY)", 4, "too much memory"),
                (started + "reply(DIED, 11)", 4, "signal 11"),
                (started + f"reply(DIED, {int(signal.SIGXCPU)})", 4, "took too long"),
                (started + "reply(ERROR, 99, text=b\"x\")", 4, "wrong answer"),
                (started + "reply(ERROR, 3, text=b\"\\033[31m\\n\" + b\"y\" * 8185)", 4, "yyy"),
                # Sizes beyond all limits, of no image, and of fewer or more bytes than its pixels.
                (started + "reply(OFFER, size=(60000, 60000, 3), header=9, data=3 * 60000**2)", 4, "60000x60000"),
                (started + "reply(OFFER, size=(-1, 20, 3), header=9, data=0)", 4, "-1x20"),
                (started + "reply(OFFER, size=(30, 20, 3), header=9, data=1799)", 4, "wrong answer"),
                (started + "reply(OFFER, sample_type=77, size=(30, 20, 3), header=9, data=1800)", 4, "wrong answer"),
                (started + "reply(OFFER, size=(30, 20, 3), header=1 << 40, data=1800)", 4, "wrong answer"),
                # The header, which stays empty, names no channels.
                (started + "reply(OFFER, size=(30, 20, 3), header=9, data=1800); job.recv(9); reply(DONE)", 4,
                 "wrong answer"),
                (started + "reply(OFFER, size=(30, 20, 3), header=9, data=1800); job.recv(9); reply(OFFER)", 4,
                 "wrong answer")):
            with self.subTest(script):
                result = self.answer(script)
                self.assertEqual(result.returncode, code, result.stderr)
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
                self.assertTrue(result.stderr[:-1].isprintable(), result.stderr)
                self.assertIn(words, result.stderr)
                self.assertFalse((self.folder / "x.glb").exists())


if __name__ == "__main__":
    main()

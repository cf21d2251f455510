"""Faults while a container is replaced: whatever happens, the old one or the new one stands there, whole."""
import fcntl
import os
import pathlib
import resource
import signal
import subprocess
import tempfile
import time

import picture_files
from support import BIN, CliCase, main

NOBODY = 65534


class Faults(CliCase):
    def setUp(self):
        super().setUp()
        for name, seed in (("old.png", 1), ("new.png", 2)):
            picture_files.png(self.folder / name, picture_files.noise(40, 30, seed=seed))
        for name in ("c.glb", "c.gltf"):
            self.run_ok("imgmesh-build", "old.png", "-o", name, "-q")
            (self.folder / "alone").mkdir(exist_ok=True)
            self.run_ok("imgmesh-build", "new.png", "-o", f"alone/{name}", "-q")

    def picture(self, name):
        """The image that a container holds, which is valid and has no findings."""
        report = self.report("imgmesh-info", name, "--validate")
        self.assertEqual(report["findings"], [])
        with tempfile.TemporaryDirectory() as folder:
            self.run_ok("imgmesh-reconstruct", name, "-o", f"{folder}/x.ppm", "-q")
            return pathlib.Path(folder, "x.ppm").read_bytes()

    def start(self, name, **kwargs):
        return subprocess.Popen([str(BIN / "imgmesh-build"), "new.png", "-o", name, "-q"], cwd=self.folder,
                                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **kwargs)

    def test_kill_at_any_moment(self):
        old = {name: self.picture(name) for name in ("c.glb", "c.gltf")}
        new = {name: self.picture(f"alone/{name}") for name in old}
        before = set(self.files())
        for name in old:
            switched = 0
            for attempt in range(6):
                process = self.start(name)
                if attempt % 2:  # as soon as another file stands in the folder: between the renames
                    while process.poll() is None and set(os.listdir(self.folder)) <= before | {"alone"}:
                        pass
                    time.sleep(attempt * 0.0004)
                else:
                    time.sleep(0.01 * attempt)
                process.send_signal(signal.SIGKILL)
                process.wait(60)
                picture = self.picture(name)
                self.assertIn(picture, (old[name], new[name]))
                switched += picture == new[name]
                # A killed process leaves files behind, but under names of their own.
                left = set(self.files()) - before
                for file in left:
                    self.assertRegex(file, r"^(\.imgmesh-.*|c(-[0-9a-f]{16})?\.(bin|exr))$")
                # The next run is not kept from its work by them.
                self.run_ok("imgmesh-build", "old.png", "-o", name, "-q")
                before |= {f for f in self.files() if not f.startswith(".")}
            self.assertEqual(self.picture(name), old[name])
            self.assertLess(switched, 6, "never killed before the end")
        self.assertEqual(self.picture("alone/c.gltf"), new["c.gltf"])

    def test_what_killed_runs_left_goes_later(self):
        """Temporary files that nobody holds and that are an hour old; nothing else of that name."""
        before = set(self.files())
        for attempt in range(20):  # until one is killed while its temporary file stands there
            process = self.start("c.glb")
            while process.poll() is None and set(os.listdir(self.folder)) <= before | {"alone"}:
                pass
            process.send_signal(signal.SIGKILL)
            process.wait(60)
            left = [f for f in os.listdir(self.folder) if f.startswith(".imgmesh-")]
            if left:
                break
        self.assertEqual(len(left), 1)
        young, held = f".imgmesh-{os.getpid()}-0.glb", ".imgmesh-7-0.glb"
        others = [".imgmesh-notes", ".imgmesh-7-.glb", ".imgmesh-7-1glb", ".imgmesh--1.glb", "imgmesh-7-1.glb"]
        for name in (young, held, ".imgmesh-7-1", *others):
            (self.folder / name).write_text("x")
        (self.folder / ".imgmesh-7-2.glb").mkdir()
        os.symlink("c.glb", self.folder / ".imgmesh-7-3.glb")
        for name in os.listdir(self.folder):
            if name not in (young, *left):
                os.utime(self.folder / name, (1, time.time() - 3700), follow_symlinks=False)
        with open(self.folder / held, "r+b") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            self.run_ok("imgmesh-build", "old.png", "-o", "c.glb", "-q")
            kept = {young, held, *others, *left, ".imgmesh-7-2.glb", ".imgmesh-7-3.glb"}
            self.assertEqual({f for f in os.listdir(self.folder) if "imgmesh-" in f}, kept)
        os.utime(self.folder / left[0], (1, time.time() - 3700))
        self.run_ok("imgmesh-reconstruct", "c.glb", "-o", "c.png", "-q")
        self.assertEqual({f for f in os.listdir(self.folder) if "imgmesh-" in f}, kept - {held, *left})

    def test_replacing_leaves_one_set_of_files(self):
        for picture in ("new.png", "old.png", "new.png", "new.png"):
            self.run_ok("imgmesh-build", picture, "-o", "c.gltf", "-q")
            files = sorted(f for f in self.files() if f.startswith("c") and not f.endswith(".glb"))
            self.assertEqual(len(files), 3, files)
            self.assertEqual(self.picture("c.gltf"), self.picture("alone/c.gltf") if picture == "new.png"
                             else self.picture("c.glb"))

    def test_ended_by_a_signal_leaves_no_file(self):
        before = self.files()
        for name, number, moment, times in (("c.glb", signal.SIGTERM, ".", 1), ("c.gltf", signal.SIGINT, ".", 1),
                                            ("c.gltf", signal.SIGTERM, ".", 1), ("c.gltf", signal.SIGHUP, ".", 1),
                                            # While new files stand beside old ones: all are switched, or none.
                                            ("c.gltf", signal.SIGTERM, "c", 1), ("c.gltf", signal.SIGINT, "c", 1),
                                            # Somebody impatient.
                                            ("c.glb", signal.SIGINT, ".", 3), ("c.gltf", signal.SIGINT, ".", 3),
                                            ("c.gltf", signal.SIGTERM, "c", 3), ("c.gltf", signal.SIGINT, "c", 3)):
            process = self.start(name)
            while process.poll() is None and not any(file.startswith(moment) for file in
                                                     set(os.listdir(self.folder)) - {*before, "alone"}):
                pass
            for _ in range(times):
                process.send_signal(number)
                time.sleep(0.0005)
            process.wait(60)
            self.assertFalse([f for f in self.files() if f.startswith(".")])
            if self.files() != before:  # the signal came after the last rename
                self.assertEqual(self.picture(name), self.picture(f"alone/{name}"))
                self.assertEqual(len([f for f in self.files() if f.startswith("c")]), 4)
                self.run_ok("imgmesh-build", "old.png", "-o", name, "-q")
                before = self.files()

    def test_full_disk_at_every_file(self):
        """A limit on file size fails the first file that is longer, as a full disk does: the .bin, the .exr, the .glb."""
        before = self.files()
        sizes = sorted(len(data) for name, data in before.items() if name.startswith("alone/"))
        for name in ("c.glb", "c.gltf"):
            for size in [100, *(s - 1 for s in sizes)]:
                limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
                result = self.run_tool("imgmesh-build", "new.png", "-o", name, preexec_fn=limit)
                if result.returncode == 0:  # longer than all files of this variant
                    self.run_ok("imgmesh-build", "old.png", "-o", name, "-q")
                else:
                    self.assert_error_lines("imgmesh-build", result, 3, 1)
                    self.assertEqual(self.files(), before)

    def test_full_disk(self):
        """A file system of 64 kB, where one can be mounted."""
        (self.folder / "disk").mkdir()
        script = (f"mount -t tmpfs -o size=64k none disk && cp alone/c.gltf alone/c.bin alone/c.exr disk && "
                  f"head -c 65536 /dev/zero > disk/filler; {BIN}/imgmesh-build old.png -o disk/c.gltf; echo $?; ls -A disk;"
                  f"cmp disk/c.gltf alone/c.gltf && cmp disk/c.exr alone/c.exr && cmp disk/c.bin alone/c.bin && echo same")
        result = subprocess.run(["unshare", "--mount", "--map-root-user", "sh", "-c", script], cwd=self.folder, text=True,
                                capture_output=True, check=False)
        if "mount" in result.stderr or "unshare" in result.stderr:
            self.skipTest("no file system can be mounted here")
        self.assertEqual(result.stdout.split(), ["3", "c.bin", "c.exr", "c.gltf", "filler", "same"], result.stderr)
        self.assertIn("No space left", result.stderr)

    def test_several_outputs_appear_together(self):
        """A limit on file size that only the largest exceeds: none of them appears, and older ones stay."""
        runs = {"imgmesh-segment": ("c.glb", "-o", "1.png", "--outlines", "2.png", "--flat", "3.bmp", "--report", "4.json",
                                    "--mesh", "5.glb", "--colors", "6.png", "--ucm", "7.mat", "--keep", "2,2", "--mask", "8.png",
                                    "--svg", "9.svg"),
                "imgmesh-compare": ("old.png", "new.png", "--error-image", "1.bmp", "--plot", "2.svg"),
                "imgmesh-warp": ("c.glb", "--image", "old.png", "-o", "1.bmp", "--displacement", "2.exr")}
        for tool, args in runs.items():
            outputs = [a for a in args if a[:2] in {f"{i}." for i in range(1, 10)}]
            before = self.files()
            self.run_ok(tool, *args, "-q")
            sizes = sorted((self.folder / name).stat().st_size for name in outputs)
            for name in outputs:
                (self.folder / name).unlink()
            for old in (None, b"old"):
                if old:
                    (self.folder / outputs[0]).write_bytes(old)
                    before = self.files()
                for size in (sizes[-1] - 1, sizes[0] - 1):
                    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
                    result = self.run_tool(tool, *args, "-q", preexec_fn=limit)
                    with self.subTest(tool=tool, size=size):
                        self.assert_error_lines(tool, result, 3, 1)
                        self.assertEqual(self.files(), before)
            (self.folder / outputs[0]).unlink()

    def test_umask_locales_and_few_files(self):
        """Files are as private as the user wants them, and hold the same wherever and however imgmesh runs."""
        names = ("x.glb", "y.gltf", "y.bin", "y.exr")
        def build(**kwargs):
            for name in ("x.glb", "y.gltf"):
                self.run_ok("imgmesh-build", "old.png", "-o", name, "-q", **kwargs)
            found = {name: (self.folder / name).read_bytes() for name in names}
            modes = {(self.folder / name).stat().st_mode & 0o777 for name in names}
            for name in names:
                (self.folder / name).unlink()
            return found, modes
        plain, _ = build(umask=0o022)
        for umask, mode in ((0o077, 0o600), (0o022, 0o644), (0o027, 0o640)):
            self.assertEqual(build(umask=umask), (plain, {mode}))
        for locale in ("C", "C.UTF-8", "POSIX", "de_DE.UTF-8", "tr_TR.UTF-8", "ja_JP.EUC-JP", "no such locale"):
            self.assertEqual(build(env=os.environ | {"LC_ALL": locale, "LANG": locale})[0], plain, locale)
        few = lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (12, 12))
        self.assertEqual(build(preexec_fn=few)[0], plain)

    def test_read_only_folder(self):
        os.chmod(self.folder, 0o555)
        self.addCleanup(os.chmod, self.folder, 0o755)
        before = self.files()
        drop = (lambda: os.setuid(NOBODY)) if os.getuid() == 0 else None
        for name in ("c.glb", "c.gltf", "d.glb"):
            result = self.run_tool("imgmesh-build", "new.png", "-o", name, preexec_fn=drop)
            self.assert_error_lines("imgmesh-build", result, 3, 1)
            self.assertIn(name, result.stderr)
        result = self.run_tool("imgmesh-reconstruct", "c.glb", "-o", "x.png", preexec_fn=drop)
        self.assert_error_lines("imgmesh-reconstruct", result, 3, 1)
        self.assertEqual(self.files(), before)

    def test_closed_pipe(self):
        """The report's reader is gone: an error, and the container is whole."""
        for name in ("c.glb", "c.gltf"):
            reader, writer = os.pipe()
            os.close(reader)
            result = self.run_tool("imgmesh-build", "new.png", "-o", name, "--json", stdout=writer)
            os.close(writer)
            self.assert_error_lines("imgmesh-build", result, 3, 1)
            self.assertEqual(self.picture(name), self.picture(f"alone/{name}"))


if __name__ == "__main__":
    main()

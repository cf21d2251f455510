"""Standard input and output as files, in every tool: the same bytes as with files, and one line where that cannot be."""
import json
import os
import pty
import subprocess

import picture_files
from support import BIN, TOOLS, CliCase, main, validate_report


class Pipes(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "in.png", picture_files.noise(24, 16))
        self.run_ok("imgmesh-build", "in.png", "-o", "in.glb", "-q")
        self.run_ok("imgmesh-encode", "in.png", "-o", "in.imgm", "-q", "--vertices", "9")

    def piped(self, tool, *args, data=b"", **kwargs):
        return subprocess.run([str(BIN / tool), *args], cwd=self.folder, input=data, timeout=300, check=False,
                              capture_output=not kwargs, **kwargs)

    def shell(self, command):
        return subprocess.run(["/bin/sh", "-c", command], cwd=self.folder, capture_output=True, timeout=300, check=False,
                              env={**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"})

    def test_chain(self):
        self.run_ok("imgmesh-reconstruct", "in.glb", "-o", "again.png", "-q")
        result = self.shell("imgmesh-build - -o - < in.png | imgmesh-reconstruct - -o - --format png > piped.png")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((self.folder / "piped.png").read_bytes(), (self.folder / "again.png").read_bytes())

    def test_every_tool(self):
        """Input and output are those of files; the report is on standard error and says so."""
        before = set(self.files())
        for tool, source, args, kind in (("imgmesh-build", "in.png", [], "glb"),
                                         ("imgmesh-reconstruct", "in.glb", ["--mode", "wire"], "svg"),
                                         ("imgmesh-reconstruct", "in.glb", [], "exr"),
                                         ("imgmesh-reconstruct", "in.glb", [], "jpg"),
                                         ("imgmesh-segment", "in.glb", ["--segments", "2"], "png"),
                                         ("imgmesh-segment", "in.glb", ["--segments", "2"], "exr"),
                                         ("imgmesh-warp", "in.glb", ["--handle", "3,3:1,1"], "glb"),
                                         ("imgmesh-warp", "in.glb", ["--handle", "3,3:1,1", "--image", "in.png"], "png"),
                                         ("imgmesh-convert", "in.glb", ["--draco", "none"], "glb"),
                                         ("imgmesh-convert", "in.glb", [], "ply"),
                                         ("imgmesh-encode", "in.png", ["--vertices", "9"], "imgm"),
                                         ("imgmesh-decode", "in.imgm", [], "png"),
                                         ("imgmesh-decode", "in.imgm", [], "glb")):
            with self.subTest(tool=tool, kind=kind):
                self.run_ok(tool, source, "-o", f"x.{kind}", *args, "-q")
                expected = (self.folder / f"x.{kind}").read_bytes()
                os.remove(self.folder / f"x.{kind}")
                usual = kind in ("glb", "png") and (kind == "png") == (tool != "imgmesh-convert" and "--image" in args
                                                                       or tool in ("imgmesh-segment", "imgmesh-reconstruct",
                                                                                   "imgmesh-decode"))
                result = self.piped(tool, "-", "-o", "-", *args, "--json", *([] if usual else ["--format", kind]),
                                    data=(self.folder / source).read_bytes())
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(result.stdout, expected)
                report = json.loads(result.stderr)
                validate_report(tool, report)
                file = report["images"][0] if "images" in report else report
                self.assertEqual((file["input"], file["output"]), ("standard input", "standard output"))
                self.assertEqual(file["bytes"] if "bytes" in file else len(expected), len(expected))
        self.assertEqual(set(self.files()), before)
        data = (self.folder / "in.glb").read_bytes()
        self.assertIn(b"standard input", self.piped("imgmesh-info", "-", data=data).stdout.splitlines()[0])
        self.assertEqual(self.piped("imgmesh-info", "-", "in.glb", data=data).returncode, 0)
        for args in (["-", "in.png"], ["in.png", "-"]):
            self.assertIn(b" dB", self.piped("imgmesh-compare", *args, data=data).stdout)
        picture = (self.folder / "in.png").read_bytes()
        self.assertIn(b"infinite: equal", self.piped("imgmesh-compare", "-", "in.png", data=picture).stdout)

    def assert_refused(self, result, code, *words):
        self.assertEqual(result.returncode, code, result.stderr)
        lines = result.stderr.decode().splitlines()
        self.assertEqual(len(lines), 1, result.stderr)
        for word in words:
            self.assertIn(word, lines[0])

    def test_what_a_pipe_cannot_be(self):
        data = (self.folder / "in.glb").read_bytes()
        for tool, args, words in (("imgmesh-convert", ["-", "-o", "-", "--format", "gltf"], [".gltf", "--format glb"]),
                                  ("imgmesh-convert", ["-", "-o", "-", "--format", "obj", "--texture"], ["--no-texture"]),
                                  ("imgmesh-convert", ["-", "-o", "out/"], ["-o out/", "no name"]),
                                  ("imgmesh-segment", ["-", "-o", "x.png", "--flat", "f/"], ["--flat f/", "no name"]),
                                  ("imgmesh-segment", ["-", "-o", "x.png", "--flat", "-"], ["--flat -"]),
                                  ("imgmesh-convert", ["in.glb", "-", "-o", "-"], ["-o -", "folder"]),
                                  ("imgmesh-convert", ["in.glb", "-o", "-", "--skip-existing"], ["--skip-existing"]),
                                  ("imgmesh-info", ["-", "-"], ["twice"])):
            self.assert_refused(self.piped(tool, *args, data=data), 2, *words)
        self.run_ok("imgmesh-convert", "in.glb", "-o", "y.gltf", "-q")
        self.assert_refused(self.piped("imgmesh-info", "-", data=(self.folder / "y.gltf").read_bytes()), 4, ".gltf", ".glb")

    def test_bad_input(self):
        """Named as what it is, and nothing is written."""
        for tool in TOOLS:
            args = [] if tool in ("imgmesh-info", "imgmesh-compare") else ["-o", "-"]
            args += ["in.png"] if tool == "imgmesh-compare" else []
            args += ["--handle", "1,1:1,1"] if tool == "imgmesh-warp" else []
            for data in (b"", b"nothing at all"):
                result = self.piped(tool, "-", *args, data=data)
                self.assert_refused(result, 4, "standard input")
                self.assertEqual(result.stdout, b"")
        result = self.piped("imgmesh-info", "-", "--max-bytes", "100", data=b"x" * (1 << 20))
        self.assert_refused(result, 4, "standard input", "limit of 100 bytes")

    def test_json_of_a_failure(self):
        result = self.piped("imgmesh-reconstruct", "-", "-o", "-", "--json", data=b"nothing at all")
        self.assertEqual((result.returncode, result.stdout), (4, b""))
        report = json.loads(result.stderr)
        validate_report("imgmesh-reconstruct", report)
        self.assertIn("standard input: ", report["failure"]["message"])

    def test_reader_that_goes_away(self):
        read_end, write_end = os.pipe()
        os.close(read_end)
        self.addCleanup(os.close, write_end)
        result = self.piped("imgmesh-build", "in.png", "-o", "-", stdout=write_end, stderr=subprocess.PIPE)
        self.assert_refused(result, 3, "standard output: cannot write: Broken pipe")
        result = self.shell("imgmesh-build in.png -o - > /dev/full")
        self.assert_refused(result, 3, "standard output: cannot write: No space left on device")

    def test_terminals(self):
        ours, theirs = pty.openpty()
        self.addCleanup(os.close, ours)
        self.addCleanup(os.close, theirs)
        result = self.piped("imgmesh-build", "in.png", "-o", "-", stdout=theirs, stderr=subprocess.PIPE)
        self.assert_refused(result, 2, "terminal", ".glb")
        result = self.piped("imgmesh-convert", "in.glb", "-o", "-", "--format", "svg", "-q", stdout=theirs,
                            stderr=subprocess.PIPE)
        self.assertEqual((result.returncode, result.stderr), (0, b""))
        result = subprocess.run([str(BIN / "imgmesh-info"), "-"], stdin=theirs, capture_output=True, timeout=60, check=False)
        self.assert_refused(result, 2, "standard input is a terminal")


if __name__ == "__main__":
    main()

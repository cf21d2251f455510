"""Standard streams that are closed, full, gone, a terminal; and names that would break a line."""
import json
import os
import pty
import signal
import subprocess

import picture_files
from support import BIN, CliCase, main, validate_report


class Streams(CliCase):
    def setUp(self):
        super().setUp()
        picture_files.png(self.folder / "in.png", picture_files.ramp(24, 16))

    def run_shell(self, command):
        return subprocess.run(["/bin/sh", "-c", command], cwd=self.folder, env={**os.environ, "BIN": str(BIN)},
                              capture_output=True, encoding="utf-8", timeout=300, check=False)

    def test_full_standard_output(self):
        for tool, args in (("imgmesh-build", "in.png -o a.glb"), ("imgmesh-build", "in.png -o b.glb --json"),
                           ("imgmesh-info", "a.glb"), ("imgmesh-info", "--help"), ("imgmesh-info", "--version")):
            result = self.run_shell(f'"$BIN/{tool}" {args} > /dev/full')
            self.assert_error_lines(tool, result, 3, 1)
            self.assertIn("standard output", result.stderr)

    def test_closed_standard_output(self):
        """Above all, the report does not end up in the container, which would get the free number 1."""
        self.run_ok("imgmesh-build", "in.png", "-o", "a.glb", "--quiet")
        result = self.run_shell('"$BIN/imgmesh-build" in.png -o b.glb >&-')
        self.assert_error_lines("imgmesh-build", result, 3, 1)
        self.assertEqual((self.folder / "b.glb").read_bytes(), (self.folder / "a.glb").read_bytes())
        self.assertEqual(self.run_shell('"$BIN/imgmesh-build" in.png -o b.glb --quiet >&-').returncode, 0)

    def test_all_streams_closed(self):
        self.run_ok("imgmesh-build", "in.png", "-o", "a.glb", "--quiet")
        result = self.run_shell('"$BIN/imgmesh-build" in.png -o b.glb --quiet <&- >&- 2>&-')
        self.assertEqual(result.returncode, 0)
        self.assertEqual((self.folder / "b.glb").read_bytes(), (self.folder / "a.glb").read_bytes())
        self.assertEqual(self.run_shell('"$BIN/imgmesh-info" none.glb <&- >&- 2>&-').returncode, 3)

    def test_reader_that_goes_away(self):
        read_end, write_end = os.pipe()
        os.close(read_end)
        self.addCleanup(os.close, write_end)
        # subprocess restores SIGPIPE's default action, as a shell does.
        result = self.run_tool("imgmesh-build", "in.png", "-o", "a.glb", stdout=write_end)
        self.assert_error_lines("imgmesh-build", result, 3, 1)
        self.run_ok("imgmesh-info", "a.glb", "--validate")

    def test_quiet(self):
        result = self.run_ok("imgmesh-build", "in.png", "-o", "a.glb", "-q")
        self.assertEqual(result.stdout, "")
        report = self.run_ok("imgmesh-build", "in.png", "-o", "a.glb", "-q", "--json").stdout
        validate_report("imgmesh-build", json.loads(report))

    def test_errors_stay_on_standard_error_with_json(self):
        result = self.run_tool("imgmesh-info", "none.glb", "--json")
        self.assert_error_lines("imgmesh-info", result, 3, 1)
        failure = json.loads(result.stdout)["failure"]
        self.assertEqual(result.stderr, f"imgmesh-info: error: {failure['message']}\n")
        self.assertEqual(failure["code"], 3)
        self.assert_error("imgmesh-build", ["in.png", "-o", "a.glb", "--json", "--faces", "x"], 2, "--faces")

    def test_names_that_would_break_a_line(self):
        for name in (b"new\nline", b"esc\x1b[2Jape", b"no-utf8-\xff\xfe", "sep\u2028ara\u2029tor".encode(),
                     "nel\u0085".encode(), b"tab\tcr\r", b"cut-\xf0\x9f\x98", "surrogate-".encode() + b"\xed\xa0\x80"):
            self.assert_error("imgmesh-info", [name + b".glb"], 3)
            self.assert_error("imgmesh-build", [name + b".png", "-o", "a.glb"], 3)
            self.assert_error("imgmesh-build", ["in.png", "-o", b"folder-" + name + b"/a.glb"], 3)
            self.assert_error("imgmesh-build", ["in.png", "-o", "a.glb", b"--" + name], 2)
            self.assert_error("imgmesh-build", ["in.png", "-o", "a.glb", "--faces", name], 2, "--faces")

    def test_other_scripts_are_shown_as_they_are(self):
        self.assert_error("imgmesh-info", ["süß-写真-🙂.glb"], 3, "süß-写真-🙂.glb")

    def test_reports_of_names_that_are_no_utf8(self):
        name = b"p\xff\n.png"
        os.rename(picture_files.png(self.folder / "x.png", picture_files.ramp(9, 7)),
                  os.path.join(os.fsencode(self.folder), name))
        result = self.run_ok("imgmesh-build", name, "-o", b"o\xff.glb", "--json")
        report = json.loads(result.stdout)
        validate_report("imgmesh-build", report)
        self.assertEqual(report["images"][0]["input"], "p\ufffd\n.png")
        text = self.run_ok("imgmesh-info", b"o\xff.glb").stdout
        self.assertEqual(text.splitlines()[0], "o\\xff.glb")

    def on_terminal(self, *args):
        """What a terminal gets on standard error."""
        ours, theirs = pty.openpty()
        process = subprocess.Popen([str(BIN / "imgmesh-build"), *args], cwd=self.folder, stderr=theirs,
                                   stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        os.close(theirs)
        seen = b""
        while True:
            try:
                part = os.read(ours, 4096)
            except OSError:  # EIO: the other end is closed
                break
            if not part:
                break
            seen += part
        os.close(ours)
        self.assertEqual(process.wait(300), 0, seen)
        return seen.decode()

    def test_progress_on_a_terminal(self):
        self.assertEqual(self.on_terminal("in.png", "-o", "a.glb"), "", "a bar for work below a second")
        picture_files.png(self.folder / "large.png", picture_files.noise(1200, 900))
        shown = self.on_terminal("large.png", "-o", "a.glb", "--threads", "1")
        self.assertRegex(shown, r"\r\[[#.]{30}\] \d+% [a-z]")
        self.assertTrue(shown.endswith("\r\x1b[K"), "the bar is still there")
        percents = [int(p.split("%")[0]) for p in shown.split("] ")[1:]]
        self.assertEqual(percents, sorted(percents))
        self.assertLessEqual(percents[-1], 100)
        self.assertEqual(self.on_terminal("large.png", "-o", "a.glb", "--threads", "1", "--quiet"), "")

    def test_no_progress_elsewhere(self):
        picture_files.png(self.folder / "large.png", picture_files.noise(1200, 900))
        self.run_ok("imgmesh-build", "large.png", "-o", "a.glb", "--threads", "1")

    def test_killed_run_leaves_no_partial_file(self):
        picture_files.png(self.folder / "large.png", picture_files.noise(1200, 900))
        before = self.files()
        for name in (signal.SIGTERM, signal.SIGINT):
            process = subprocess.Popen([str(BIN / "imgmesh-build"), "large.png", "-o", "a.glb", "--threads", "1"], cwd=self.folder,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            with self.assertRaises(subprocess.TimeoutExpired):
                process.wait(0.5)
            process.send_signal(name)
            self.assertEqual(process.wait(60), -name)
            self.assertEqual(self.files(), before)


if __name__ == "__main__":
    main()

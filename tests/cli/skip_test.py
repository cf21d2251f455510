"""Batches that are killed, interrupted and continued; and the journal that makes that possible."""
import hashlib
import json
import os
import signal
import subprocess
import time

import picture_files
from support import BIN, CliCase, main

JOURNAL = ".imgmesh-done.jsonl"
# What two runs of the same work do not share.
OWN = ("$schema", "generator", "seconds", "stage_seconds", "status")


def sealed(entry):
    """The line of an entry, with the checksum that makes it one."""
    text = json.dumps(entry, separators=(",", ":")).encode()[:-1]
    return text + b',"sha256":"' + hashlib.sha256(text).hexdigest().encode() + b'"}'


def facts(file):
    return {k: v for k, v in file.items() if k not in OWN}


class Night(CliCase):
    """A hundred images, ten of them broken."""

    def setUp(self):
        super().setUp()
        (self.folder / "photos").mkdir()
        self.names = [f"photos/{i:03}.png" for i in range(100)]
        for i, name in enumerate(self.names):
            if i % 10 == 3:
                (self.folder / name).write_bytes(b"no picture at all")
            else:
                picture_files.png(self.folder / name, picture_files.noise(40 + i, 50, seed=i))

    def outputs(self, folder):
        """Every file but the journal; hidden ones would be leftovers."""
        return {p.name: p.read_bytes() for p in sorted((self.folder / folder).iterdir()) if p.name != JOURNAL}

    def cut_short(self, name, *args):
        """Sends a signal when some files are done, and gives the standard output."""
        process = subprocess.Popen([str(BIN / "imgmesh-build"), *self.names, "-o", "out/", *args], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   bufsize=0)  # with a buffer communicate() would lose lines
        lines = [process.stdout.readline() for _ in range(12)]
        process.send_signal(name)
        out = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, -name)
        return b"".join(lines) + out

    def test_killed_twice_and_continued(self):
        whole = self.report("imgmesh-build", *self.names, "-o", "whole/", code=4)
        self.cut_short(signal.SIGKILL)  # without the option
        for leftover in (self.folder / "out").glob(".imgmesh-[0-9]*"):
            leftover.unlink()  # of a kill between a file's writing and its name
        done = len(self.outputs("out"))
        self.assertTrue(10 <= done < 90, done)
        lines = [json.loads(line) for line in self.cut_short(signal.SIGINT, "--skip-existing", "--jsonl").splitlines()]
        summary = lines[-1]["summary"]
        self.assertGreaterEqual(summary["skipped"], 10 - 2)
        self.assertGreater(summary["interrupted"], 0)
        self.assertEqual(len(lines), 101)
        last = self.report("imgmesh-build", *self.names, "-o", "out/", "--skip-existing", code=4)
        self.assertEqual(self.outputs("out"), self.outputs("whole"))
        for files in (whole["images"], last["images"]):
            for file in files:
                file.pop("output")
        self.assertEqual(list(map(facts, last["images"])), list(map(facts, whole["images"])))
        self.assertEqual(last["summary"]["done"] + last["summary"]["skipped"], 90)
        again = self.report("imgmesh-build", *self.names, "-o", "out/", "--skip-existing", code=4)
        self.assertEqual((again["summary"]["skipped"], again["summary"]["failed"]), (90, 10))


class Journal(CliCase):
    def setUp(self):
        super().setUp()
        for i in range(3):
            picture_files.png(self.folder / f"p{i}.png", picture_files.noise(12 + i, 9, seed=i))
        self.run_ok("imgmesh-build", "p0.png", "p1.png", "p2.png", "-o", "out/", "-q")
        self.journal = self.folder / "out" / JOURNAL

    def statuses(self, *args, tool="imgmesh-build", files=("p0.png", "p1.png", "p2.png")):
        report = self.report(tool, *files, "-o", "out/", "--skip-existing", *args)
        return [file["status"] for file in report.get("images", report.get("files"))]

    def test_what_is_done_again(self):
        """Whatever was changed: the input, the output, an option, the mask's content. Limits and threads change nothing."""
        self.assertEqual(self.statuses(), 3 * ["skipped"])
        self.assertEqual(self.statuses("--threads", "1", "--max-memory", "1G", "--no-overwrite"), 3 * ["skipped"])
        self.assertEqual(self.statuses("--force"), 3 * ["done"])
        self.assertEqual(self.statuses("--faces", "5"), 3 * ["done"])
        self.assertEqual(self.statuses("--faces", "5"), 3 * ["skipped"])
        picture_files.png(self.folder / "p0.png", picture_files.noise(12, 9, seed=7))
        os.remove(self.folder / "out/p1.glb")
        with (self.folder / "out/p2.glb").open("r+b") as file:
            file.seek(-1, os.SEEK_END)
            file.write(b"x")
        self.assertEqual(self.statuses("--faces", "5"), 3 * ["done"])
        os.rename(self.folder / "p0.png", self.folder / "p3.png")
        os.rename(self.folder / "p1.png", self.folder / "p0.png")
        self.assertEqual(self.statuses("--faces", "5", files=("p0.png", "p2.png")), ["done", "skipped"])

    def test_content_of_the_mask(self):
        mask = self.folder / "m.png"
        for seed in (5, 6):
            picture_files.png(mask, picture_files.noise(13, 9, seed=seed))
            for status in ("done", "skipped"):
                report = self.report("imgmesh-build", "p1.png", "-o", "one.glb", "--mask", "m.png", "--skip-existing")
                self.assertEqual(report["images"][0]["status"], status)

    def test_other_tools_and_their_other_outputs(self):
        containers = [f"out/p{i}.glb" for i in range(3)]
        for tool, args in (("imgmesh-reconstruct", ["-o", "d/"]), ("imgmesh-convert", ["-o", "c/", "--format", "gltf"]),
                           ("imgmesh-segment", ["-o", "s/", "--flat", "f/"]),
                           ("imgmesh-warp", ["--displacement", "w/", "--handle", "3,3:1,1"])):
            for status in ("done", "skipped"):
                report = self.report(tool, *containers, *args, "--skip-existing")
                self.assertEqual([file["status"] for file in report["files"]], 3 * [status], tool)
        (self.folder / "f/p0.png").write_bytes(b"")
        (self.folder / "c/p1.bin").write_bytes(b"")
        for tool, args, name in (("imgmesh-segment", ["-o", "s/", "--flat", "f/"], "out/p0.glb"),
                                 ("imgmesh-convert", ["-o", "c/", "--format", "gltf"], "out/p1.glb")):
            report = self.report(tool, *containers, *args, "--skip-existing")
            self.assertEqual([file["input"] for file in report["files"] if file["status"] == "done"], [name])

    def test_files_beside_an_output(self):
        """An .obj has a .mtl and a texture, which count as it does."""
        args = ("imgmesh-convert", "out/p0.glb", "out/p1.glb", "-o", "e/", "--format", "obj", "--texture", "--skip-existing")
        beside = [p for p in self.report(*args)["files"][0]["outputs"] if not p.endswith(".obj")]
        self.assertEqual(self.report(*args)["summary"]["skipped"], 2)
        (self.folder / beside[-1]).write_bytes(b"")
        self.assertEqual(self.report(*args)["summary"]["done"], 1)
        text = self.run_ok(*args).stdout
        self.assertIn("e/p0.obj: skipped, made before\n", text)
        self.assertIn("2 files: 0 done, 2 skipped; ", text)

    def test_one_file_without_a_folder(self):
        """Leaves no journal, unless it is asked for."""
        self.run_ok("imgmesh-build", "p0.png", "-o", "one.glb", "-q")
        self.assertFalse((self.folder / JOURNAL).exists())
        for text in ("vertices", "skipped, made before"):
            self.assertIn(text, self.run_ok("imgmesh-build", "p0.png", "-o", "one.glb", "--skip-existing").stdout)

    def test_broken_journals(self):
        """Torn, hostile and strange lines are as good as none, and what follows counts."""
        lines = self.journal.read_bytes().splitlines(keepends=True)
        self.assertEqual(len(lines), 3)
        entry = json.loads(lines[0])
        entry.pop("sha256")
        content, seal = lines[0].rsplit(b',"sha256":"', 1)
        self.assertEqual(seal, hashlib.sha256(content).hexdigest().encode() + b'"}\n')
        report = entry["report"]
        deep = "[" * 100000 + "]" * 100000
        bad = [dict(entry, files=files) for files in (None, [], 3, [3], [{"bytes": "x"}], [{"bytes": -1, "sha256": None}])]
        bad += [dict(entry, report=report) for report in (None, [], "x")] + [dict(entry, journal=1), dict(entry, key=[]), []]
        bad += [dict(entry, report={"outputs": outputs}) for outputs in (3, [3], ["../x"], {"a": "/etc/passwd"})]
        garbage = [b"\xff\x00{", deep.encode(), b'{"report": ' + deep.encode() + b"}", b"x" * (3 << 20), b"{}", b"null"]
        for name, values in {"parameters": (None, "x", []), "input": (None, 3), "output": (None, 3, {}), "warnings": (None, "x", [3]),
                             "inputs": ([3], [{"input": "p0.png"}]), "target_reached": (None, "x"), "outputs": (None, "x", [None])}.items():
            bad += [dict(entry, report=dict(report, **{name: value})) for value in values]
        bad += [dict(entry, report={k: v for k, v in report.items() if k != name}) for name in ("parameters", "input")]
        garbage += [sealed(value) for value in bad if value]
        garbage += [line.replace(b'"vertices":', b'"vertices":1') for line in lines]  # edited
        garbage += [line.replace(b'"key":', b'"key" :') for line in lines]
        for content, expected in ((b"\n".join([*garbage, b"".join(lines)]), "skipped"),
                                  (b"".join(lines)[:-1], "skipped"), (b"\n".join(garbage), "done"), (b"", "done")):
            self.journal.write_bytes(content)
            self.assertEqual(self.statuses(), 3 * [expected])
        self.journal.write_bytes(lines[0] + lines[1][:40])  # the end of a killed run
        names = ["p0.png", "p1.png", "p2.png"]
        report = self.report("imgmesh-build", *names, "-o", "out/", "--skip-existing")
        self.assertEqual(report["summary"]["skipped"], 1)
        self.assertEqual(self.statuses(), 3 * ["skipped"])

    def test_every_member_of_a_wrong_type(self):
        """Whatever stands in a sealed line, the run ends well, with the report that its schema wants."""
        lines = self.journal.read_bytes().splitlines(keepends=True)
        line = next(line for line in lines if b'"output":"p0.glb"' in line)
        entry = json.loads(line)
        entry.pop("sha256")
        self.journal.write_bytes(line)
        self.assertEqual(self.statuses(files=["p0.png"]), ["skipped"])
        for value in (None, [[]]):
            self.journal.write_bytes(sealed(dict(entry, report={name: value for name in entry["report"]})) + b"\n")
            self.assertEqual(self.statuses(files=["p0.png"]), ["done"])

    def test_strict_and_warnings(self):
        """With --strict, what an earlier run could not reach fails; without, its warnings are told again."""
        self.run_tool("imgmesh-build", "p0.png", "p1.png", "-o", "out/", "--faces", "9999", "-q")
        args = ("imgmesh-build", "p0.png", "p1.png", "-o", "out/", "--faces", "9999", "--skip-existing")
        text = self.run_tool(*args)
        self.assertEqual((text.returncode, text.stderr.count("imgmesh-build: warning: p")), (0, 2), text.stderr)
        report = self.report(*args)
        self.assertEqual((report["summary"]["skipped"], len(report["warnings"])), (2, 2))
        os.rename(self.folder / "p1.png", self.folder / "q.png")
        os.rename(self.folder / "out/p1.glb", self.folder / "out/q.glb")
        entry = [e for e in map(json.loads, self.journal.read_bytes().splitlines()) if e["output"] == "p1.glb"][-1]
        entry.pop("sha256")
        with self.journal.open("ab") as file:
            file.write(sealed(dict(entry, output="q.glb")) + b"\n")
        renamed = self.report("imgmesh-build", "q.png", "-o", "out/", "--faces", "9999", "--skip-existing")["images"][0]
        self.assertEqual((renamed["status"], renamed["warnings"][0][:7]), ("skipped", "q.png: "))
        os.rename(self.folder / "q.png", self.folder / "p1.png")
        os.rename(self.folder / "out/q.glb", self.folder / "out/p1.glb")
        report = self.report(*args, "--strict", code=5)
        self.assertEqual(report["summary"]["failed"], 2)
        for file in report["images"]:
            self.assertIs(file["target_reached"], False)
            self.assertIn(file["reason"], file["failure"]["message"])
        args = ("imgmesh-segment", "out/p0.glb", "-o", "s/", "--superpixels", "9999", "--skip-existing")
        self.run_tool(*args)
        self.assertEqual(self.report(*args)["status"], "skipped")
        self.assertIs(self.report(*args, "--strict", code=5)["target_reached"], False)

    def test_a_journal_that_is_too_large(self):
        """Is told once, and not read."""
        os.truncate(self.journal, 1 << 30)
        report = self.report("imgmesh-build", "p0.png", "p1.png", "-o", "out/", "--skip-existing")
        self.assertEqual(report["summary"]["done"], 2)
        self.assertEqual([JOURNAL in warning for warning in report["warnings"]], [True])

    def test_no_journal_can_be_kept(self):
        """A link is not followed; the work is done, and a warning says that it will be done again."""
        target = self.folder / "mine"
        target.write_bytes(b"mine")
        self.journal.unlink()
        self.journal.symlink_to(target)
        result = self.run_tool("imgmesh-build", "p0.png", "p1.png", "-o", "out/", "-q")
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stderr.count("imgmesh-build: warning: "), 1)
        self.assertIn("--skip-existing", result.stderr)
        self.assertEqual(target.read_bytes(), b"mine")

    def test_two_at_a_time(self):
        """Two processes write to one journal, and lose no entry."""
        for path in (self.folder / "out").iterdir():
            path.unlink()
        names = [picture_files.png(self.folder / f"q{i}.png", picture_files.noise(9, 9, seed=i)).name for i in range(20)]
        runs = [subprocess.Popen([str(BIN / "imgmesh-build"), *part, "-o", "out/", "-q"], cwd=self.folder)
                for part in (names[:10], names[10:])]
        self.assertEqual([run.wait(60) for run in runs], [0, 0])
        self.assertEqual(self.statuses(files=names), 20 * ["skipped"])


if __name__ == "__main__":
    main()

"""Many files in one process: the same bytes whatever the threads, and a report of each as it finishes."""
import hashlib
import json
import os
import shutil
import signal
import subprocess
import time

import picture_files
from support import BIN, CliCase, main, validate_report


class Batch(CliCase):
    def setUp(self):
        super().setUp()
        for i, (width, height) in enumerate(((40, 30), (7, 50), (33, 33))):
            picture_files.png(self.folder / f"p{i}.png", picture_files.noise(width, height, seed=i))

    def run_batch(self, *args):
        result = self.run_tool("imgmesh-build", "p0.png", "p1.png", "p2.png", *args)
        return result

    def outputs(self, folder):
        return {name[len(folder):]: data for name, data in self.files().items()
                if name.startswith(folder) and not name.endswith("/.imgmesh-done.jsonl")}

    def test_same_bytes_for_any_threads_and_twice(self):
        runs = []
        for folder, threads in (("a/", "1"), ("b/", "2"), ("c/", "2"), ("d/", "5")):
            self.assertEqual(self.run_batch("-o", folder, "--threads", threads).returncode, 0)
            runs.append(self.outputs(folder))
        self.assertEqual(sorted(runs[0]), ["p0.glb", "p1.glb", "p2.glb"])
        for run in runs[1:]:
            self.assertEqual(run, runs[0])

    def test_alone_or_in_company(self):
        """An image's container does not depend on what else the process builds."""
        self.assertEqual(self.run_batch("-o", "all/").returncode, 0)
        for i in range(3):
            self.build(f"p{i}.png", output=f"one{i}.glb")
            self.assertEqual((self.folder / f"one{i}.glb").read_bytes(),
                             (self.folder / f"all/p{i}.glb").read_bytes())

    def test_same_bytes_of_the_other_file_variant_and_drawings(self):
        self.build("p0.png", "--threads", "1", output="a.gltf")
        first = self.outputs("a.")
        for threads in ("1", "2"):
            self.build("p0.png", "--threads", threads, output="a.gltf")
            self.assertEqual(self.outputs("a."), first)
        for mode in ("map", "gouraud", "wire", "patches", "flat"):
            drawn = set()
            for threads in ("1", "2"):
                self.run_ok("imgmesh-reconstruct", "a.gltf", "-o", "x.png", "--mode", mode, "--threads", threads)
                drawn.add((self.folder / "x.png").read_bytes())
            self.assertEqual(len(drawn), 1, mode)

    def test_existing_folder_needs_no_slash(self):
        (self.folder / "there").mkdir()
        self.assertEqual(self.run_batch("-o", "there").returncode, 0)
        self.assertEqual(sorted(self.outputs("there/")), ["p0.glb", "p1.glb", "p2.glb"])
        self.report("imgmesh-build", "p0.png", "-o", "deep/er/")
        self.assertEqual(sorted(self.outputs("deep/")), ["er/p0.glb"])

    def test_one_bad_picture(self):
        (self.folder / "bad.png").write_bytes(b"no picture at all")
        result = self.run_tool("imgmesh-build", "p0.png", "bad.png", "p1.png", "-o", "out/")
        self.assert_error_lines("imgmesh-build", result, 4, 1)
        self.assertIn("bad.png", result.stderr)
        self.assertEqual(sorted(self.outputs("out/")), ["p0.glb", "p1.glb"])
        report = self.report("imgmesh-build", "p0.png", "bad.png", "p1.png", "-o", "out/", code=4)
        self.assertEqual([("failure" in image, image["input"]) for image in report["images"]],
                         [(False, "p0.png"), (True, "bad.png"), (False, "p1.png")])
        self.assertEqual(report["images"][1]["failure"]["code"], 4)
        self.assertEqual("imgmesh-build: error: " + report["images"][1]["failure"]["message"] + "\n", result.stderr)

    def test_exit_code_of_several_failures(self):
        """That of all where they agree, else 4."""
        (self.folder / "bad.png").write_bytes(b"no picture at all")
        missing = self.run_tool("imgmesh-build", "p0.png", "m1.png", "m2.png", "-o", "out/")
        self.assert_error_lines("imgmesh-build", missing, 3, 2)
        self.assertEqual(sorted(name for name in ("m1.png", "m2.png") if name in missing.stderr), ["m1.png", "m2.png"])
        mixed = self.run_tool("imgmesh-build", "m1.png", "bad.png", "p0.png", "-o", "out/")
        self.assert_error_lines("imgmesh-build", mixed, 4, 2)

    def test_no_overwrite_keeps_what_is_there(self):
        (self.folder / "out").mkdir()
        (self.folder / "out/p1.glb").write_bytes(b"mine")
        result = self.run_batch("-o", "out/", "--no-overwrite")
        self.assert_error_lines("imgmesh-build", result, 3, 1)
        self.assertEqual((self.folder / "out/p1.glb").read_bytes(), b"mine")
        self.assertEqual(sorted(self.outputs("out/")), ["p0.glb", "p1.glb", "p2.glb"])

    def test_text_report_names_each(self):
        text = self.run_batch("-o", "out/").stdout
        for i in range(3):
            self.assertEqual(len([line for line in text.splitlines() if line.startswith(f"p{i}.png -> out/p{i}.glb: ")]), 1)
        self.assertIn("40 x 30", text)
        self.assertRegex(text.splitlines()[-1], r"^3 files: 3 done; [0-9.e-]+ s$")


class EveryTool(CliCase):
    """What holds for all tools: a folder for many, the list of files, the lines."""

    def setUp(self):
        super().setUp()
        self.names = []
        for i in range(3):
            self.names.append(picture_files.png(self.folder / f"p{i}.png", picture_files.noise(12 + i, 9, seed=i)).name)
        (self.folder / "bad.png").write_bytes(b"no picture at all")
        self.run_ok("imgmesh-build", *self.names, "-o", "in/", "-q")
        self.containers = [f"in/p{i}.glb" for i in range(3)]
        (self.folder / "in/bad.glb").write_bytes(b"no container at all")

    CASES = (("imgmesh-reconstruct", ["-o", "out/"], ["p0.png", "p1.png", "p2.png"]),
             ("imgmesh-reconstruct", ["-o", "out/", "--format", ".EXR"], ["p0.exr", "p1.exr", "p2.exr"]),
             ("imgmesh-segment", ["-o", "out/", "--segments", "2", "--report", "out/"],
              ["p0.json", "p0.png", "p1.json", "p1.png", "p2.json", "p2.png"]),
             ("imgmesh-warp", ["-o", "out/", "--handle", "3,3:1,1"], ["p0.glb", "p1.glb", "p2.glb"]),
             ("imgmesh-warp", ["--displacement", "out/", "--handle", "3,3:1,1"], ["p0.exr", "p1.exr", "p2.exr"]),
             ("imgmesh-convert", ["-o", "out/", "--draco", "none"], ["p0.glb", "p1.glb", "p2.glb"]),
             ("imgmesh-convert", ["-o", "out/", "--format", "svg"], ["p0.svg", "p1.svg", "p2.svg"]),
             ("imgmesh-info", [], []))

    def test_many_files(self):
        """One bad file of four: the others are done, and each report is that of the file alone."""
        for tool, args, outputs in self.CASES:
            with self.subTest(tool=tool, args=args):
                report = self.report(tool, *self.containers, "in/bad.glb", *args, code=4)
                self.assertEqual([file["status"] for file in report["files"]], 3 * ["done"] + ["failed"])
                self.assertEqual(report["files"][3]["failure"]["code"], 4)
                self.assertEqual((report["summary"]["done"], report["summary"]["failed"]), (3, 1))
                written = sorted(p.name for p in self.folder.glob("out/[!.]*"))
                self.assertEqual(written, outputs)
                alone = self.report(tool, self.containers[1], *args)
                self.assertEqual({k: v for k, v in alone.items() if k not in ("$schema", "generator")}, report["files"][1])
                for path in self.folder.glob("out/[!.]*"):
                    path.unlink()

    def test_lines_of_json(self):
        for tool, args, _ in self.CASES:
            with self.subTest(tool=tool, args=args):
                result = self.run_tool(tool, *self.containers, "in/bad.glb", *args, "--jsonl")
                self.assert_error_lines(tool, result, 4, 1)
                lines = [json.loads(line) for line in result.stdout.splitlines()]
                for line in lines:
                    validate_report(tool, line)
                self.assertEqual(sorted(line["input"] for line in lines[:-1]), ["in/bad.glb", *self.containers])
                self.assertEqual(lines[-1]["summary"]["files"], 4)
                self.assertEqual([line["failure"]["message"] for line in lines[:-1] if line["status"] == "failed"],
                                 [result.stderr.strip().removeprefix(f"{tool}: error: ")])

    def test_what_a_report_says_of_a_file(self):
        report = self.report("imgmesh-build", "p0.png", "-o", "x.glb", "--faces", "9", "--mask", "p0.png", "--texture")
        image = report["images"][0]
        self.assertEqual(image["sha256"], hashlib.sha256((self.folder / "p0.png").read_bytes()).hexdigest())
        self.assertEqual({k: image["parameters"][k] for k in ("faces", "refine", "texture", "mask", "density", "draco")},
                         {"faces": 9, "refine": 2, "texture": True, "mask": "picture", "density": None,
                          "draco": None})
        facts = self.report("imgmesh-info", "x.glb")["bytes"]
        self.assertEqual([image[k] for k in ("bytes", "mesh_bytes", "layer_bytes", "texture_bytes")],
                         [facts[k] for k in ("total", "meshes", "layers", "texture")])
        failed = self.report("imgmesh-build", "bad.png", "-o", "y.glb", code=4)["images"][0]
        self.assertEqual(failed["sha256"], hashlib.sha256(b"no picture at all").hexdigest())
        report = self.report("imgmesh-reconstruct", "x.glb", "-o", "x.png", "--scale", "2.5", "--mode", "flat")
        self.assertEqual((report["parameters"]["scale"], report["parameters"]["level"]), (2.5, 0))

    def test_lines_come_as_files_finish(self):
        """The first line is there while the last file, a pipe that nobody writes to yet, still waits."""
        for option in ("--jsonl", "--threads"):
            os.mkfifo(self.folder / "slow.glb")
            process = subprocess.Popen([str(BIN / "imgmesh-info"), "in/p0.glb", "slow.glb", option,
                                        *(["2"] if option == "--threads" else [])], cwd=self.folder,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.assertIn(b"in/p0.glb", process.stdout.readline())
            (self.folder / "slow.glb").write_bytes((self.folder / "in/p1.glb").read_bytes())
            self.assertEqual(process.communicate(timeout=60)[0].count(b"\n"), 2)
            (self.folder / "slow.glb").unlink()

    def interrupted(self, *args, times=1):
        """Ends a run whose second file never comes, and gives what it printed."""
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        if not (self.folder / "slow.glb").exists():
            os.mkfifo(self.folder / "slow.glb")
        process = subprocess.Popen([str(BIN / "imgmesh-convert"), "in/p0.glb", "slow.glb", "in/p1.glb", "-o", "out/",
                                    "--threads", "2", *args], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, encoding="utf-8")
        end = time.monotonic() + 60
        while not (self.folder / "out/p1.glb").exists() and time.monotonic() < end:
            time.sleep(0.01)
        start = time.monotonic()
        for _ in range(times):
            process.send_signal(signal.SIGINT)
            time.sleep(0.05)
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertEqual(sorted(p.name for p in (self.folder / "out").glob("*.glb")), ["p0.glb", "p1.glb"])
        self.assertEqual(list((self.folder / "out").glob(".imgmesh-[0-9]*")), [])
        return out, err, time.monotonic() - start

    def test_interruption(self):
        out, err, seconds = self.interrupted("--json")
        self.assertLess(seconds, 10)
        self.assertEqual(err, "imgmesh-convert: error: interrupted: 2 of 3 files are done\n")
        report = json.loads(out)
        validate_report("imgmesh-convert", report)
        self.assertEqual([file["status"] for file in report["files"]], ["done", "interrupted", "done"])
        self.assertEqual(report["summary"]["interrupted"], 1)
        lines = [json.loads(line) for line in self.interrupted("--jsonl")[0].splitlines()]
        for line in lines:
            validate_report("imgmesh-convert", line)
        self.assertEqual([line.get("status") for line in lines], ["done", "done", "interrupted", None])
        self.assertIn("slow.glb: not done\n3 files: 2 done, 1 not done; ", self.interrupted()[0])

    def test_second_interruption_ends_at_once(self):
        out, _, seconds = self.interrupted("--json", times=2)
        self.assertEqual(out, "")
        self.assertLess(seconds, 0.9)


if __name__ == "__main__":
    main()

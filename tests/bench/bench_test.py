#!/usr/bin/python3
"""./run bench's runner on little: every kind of row, figures that agree with the schema, refusals."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import jsonschema

HERE = pathlib.Path(__file__).resolve().parent
BIN = os.environ["IMGMESH_BIN"]


def bench(*arguments):
    command = [sys.executable, "-B", str(HERE / "bench.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)


class BenchTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="imgmesh-bench-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def measure(self, *arguments):
        """The report, which agrees with its schema, and what is printed."""
        file = self.folder / "report.json"
        result = bench("--bin", BIN, "--repeats", 1, "--threads", 1, "--json", file, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        report = json.loads(file.read_text())
        schema = json.loads((HERE.parents[1] / "schemas" / "imgmesh-bench.report.schema.json").read_text())
        jsonschema.Draft202012Validator(schema).validate(report)
        return report, result.stdout

    def test_rows(self):
        report, text = self.measure("--sides", "64,48", "--densities", 4, "--against", BIN, "--only", "process,stage")
        self.assertEqual({row["side"] for row in report["rows"]}, {64, 48})
        for side in (64, 48):
            rows = {row["subject"]: row for row in report["rows"] if row["side"] == side}
            # The same build against itself: no difference but for time.
            for tool in ("imgmesh-build", "imgmesh-reconstruct", "imgmesh-info"):
                self.assertEqual(rows[tool]["against"]["bytes_ratio"], 1)
            self.assertEqual(rows["imgmesh-build"]["against"]["rms_ratio"], 1)
            # The stages are those of the program: they come to its error.
            self.assertAlmostEqual(rows["map"]["rms"], rows["imgmesh-build"]["rms"], places=5)
            self.assertLess(rows["map"]["rms"], rows["collapse"]["rms"])
            # Rounding to 8 bits is all that the image drawn has beside; its colours are those of an image, too.
            self.assertAlmostEqual(rows["imgmesh-reconstruct"]["rms"], rows["imgmesh-build"]["rms"], delta=0.1)
        self.assertIn("64 x 64 pixels, 4 % vertices, 1 thread, preset default", text)
        self.assertIn("ours / theirs", text)

    def test_native_peer_where_there_is_one(self):
        report, _ = self.measure("--sides", 96, "--densities", 4, "--only", "peer")
        names = [row["subject"] for row in report["rows"]]
        native = (pathlib.Path(BIN) / "meshopt-native").exists()
        self.assertEqual(any(name.startswith("meshoptimizer 0.18") for name in names), native)
        for row in report["rows"]:
            self.assertGreater(row["gouraud_rms"], 0, row["subject"])
            self.assertLessEqual(row["refitted_rms"], row["gouraud_rms"] + 1e-6, row["subject"])

    def test_compare(self):
        _, _ = self.measure("--sides", 48, "--only", "process")
        first = self.folder / "report.json"
        report = json.loads(first.read_text())
        for row in report["rows"]:
            row["user_seconds"], row["system_seconds"] = 2 * row["user_seconds"], 2 * row["system_seconds"]
        report["rows"].append(dict(report["rows"][0], side=49))  # has no counterpart
        second = self.folder / "second.json"
        second.write_text(json.dumps(report))
        result = bench("compare", first, second)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stdout.splitlines()
        self.assertEqual(len(lines), 1 + 3)
        for line in lines[1:]:
            self.assertIn("2.000", line)

    def test_refusals(self):
        for arguments in (["--sides", "8"], ["--densities", "0"], ["--only", "guess"], ["--repeats", "0"],
                          ["--preset", "quick"]):
            result = bench("--bin", BIN, *arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertEqual(result.stdout, "")
        missing = bench("--bin", self.folder, "--sides", 48)
        self.assertEqual(missing.returncode, 1)
        self.assertEqual(len(missing.stderr.strip().splitlines()), 1, missing.stderr)
        self.assertIn("bench: error: ", missing.stderr)


if __name__ == "__main__":
    unittest.main()

"""What every test of the tools shares: a folder, a way to run a tool, and what an error must look like."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ["IMGMESH_BIN"])
TOOLS = ("imgmesh-build", "imgmesh-reconstruct", "imgmesh-info", "imgmesh-compare", "imgmesh-convert", "imgmesh-warp",
         "imgmesh-segment", "imgmesh-encode", "imgmesh-decode")


def schema_of(tool):
    return json.loads((ROOT / "schemas" / f"{tool}.report.schema.json").read_text())


def validate_report(tool, report):
    """Raises jsonschema.ValidationError where `report` is not what the schema of `tool` says."""
    jsonschema.Draft202012Validator(schema_of(tool)).validate(report)


class CliCase(unittest.TestCase):
    """Runs tools in a temporary folder, which is their working directory."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="imgmesh-cli-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_tool(self, tool, *args, **kwargs):
        command = [str(BIN / tool), *(a if isinstance(a, bytes) else str(a) for a in args)]
        kwargs.setdefault("stdout", subprocess.PIPE)
        kwargs.setdefault("stderr", subprocess.PIPE)
        kwargs.setdefault("stdin", subprocess.DEVNULL)
        return subprocess.run(command, cwd=self.folder, timeout=300, check=False, encoding="utf-8",
                              errors="surrogateescape", **kwargs)

    def run_ok(self, tool, *args, **kwargs):
        result = self.run_tool(tool, *args, **kwargs)
        self.assertEqual((result.returncode, result.stderr), (0, ""), f"{tool} {args}")
        return result

    def report(self, tool, *args, code=0):
        """Runs with --json and gives the report, which must agree with its schema."""
        result = self.run_tool(tool, *args, "--json")
        self.assertEqual(result.returncode, code, result.stderr)
        report = json.loads(result.stdout)
        validate_report(tool, report)
        return report

    def build(self, picture, *args, output="out.glb"):
        """Builds one image and gives its part of the report."""
        return self.report("imgmesh-build", picture, "-o", output, *args)["images"][0]

    def assert_error_lines(self, tool, result, code, count):
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertTrue(result.stderr.endswith("\n"), repr(result.stderr))
        lines = result.stderr[:-1].splitlines()  # by every separator that Unicode knows
        self.assertEqual(len(lines), count, result.stderr)
        for line in lines:
            self.assertTrue(line.startswith(f"{tool}: error: "), line)
            self.assertTrue(line.isprintable(), repr(line))

    def assert_error(self, tool, args, code, *words):
        """The run fails with this code and exactly one error line, which has all of `words`."""
        before = self.files()
        result = self.run_tool(tool, *args)
        with self.subTest(tool=tool, args=args):
            self.assert_error_lines(tool, result, code, 1)
            self.assertEqual(result.stdout, "")
            for word in words:
                self.assertIn(str(word), result.stderr)
            self.assertEqual(self.files(), before, "a failed run changed files")
        return result

    def files(self):
        """Every file of the folder, hidden ones too, with its bytes."""
        return {str(p.relative_to(self.folder)): p.read_bytes() for p in sorted(self.folder.rglob("*"))
                if p.is_file()}


main = unittest.main

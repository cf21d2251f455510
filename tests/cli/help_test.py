"""The examples in the tools' help, run as they stand there."""
import json
import os
import re
import subprocess

import numpy as np

import picture_files
from support import BIN, TOOLS, CliCase, main


class Help(CliCase):
    def examples(self, tool):
        text = self.run_ok(tool, "--help").stdout
        section = re.search(r"^Examples:\n((?:  .*\n)+)", text, re.M)
        self.assertIsNotNone(section, tool)
        commands = re.findall(r"^  (\S.*)\n      (\S.*)$", section[1], re.M)
        self.assertEqual(2 * len(commands), len(section[1].splitlines()), section[1])  # nothing else stands there
        return commands

    def test_examples_are_true(self):
        """Each of them does what it says with exit code 0 and without a word of warning, and writes what it names."""
        width, height = 96, 64
        y, x = np.mgrid[0:height, 0:width]
        color = picture_files.ramp(width, height)
        color[(x // 12 + y // 12) % 2 == 0] *= 0.6
        inside = ((np.abs(x - 48) < 34) & (np.abs(y - 32) < 24)).astype(float)[..., None]
        for name in ("photo.png", "before.png", "after.png"):
            picture_files.png(self.folder / name, color)
        picture_files.png(self.folder / "sprite.png", np.concatenate([color, inside], axis=-1))
        for name in ("a", "b"):
            picture_files.write_float(self.folder / f"{name}.jpg", np.float32(color), "uint8")
        (self.folder / "edits.json").write_text(json.dumps(
            {"edits": [{"handles": [{"near": [40, 30], "move": [3, 2]}]}]}))
        for tool in TOOLS:
            commands = self.examples(tool)
            self.assertIn(len(commands), (2, 3, 4, 5), tool)
            if tool != "imgmesh-build":  # what the others read
                self.build("photo.png", "--level-faces", "1500,200", output="photo.glb")
                self.build("photo.png", output="download.glb")
                self.build("sprite.png", "--level-faces", "800,200", output="sprite.glb")
            if tool == "imgmesh-decode":
                self.run_ok("imgmesh-encode", "photo.png", "-o", "photo.imgm", "-q")
            for command, meaning in commands:
                with self.subTest(command):
                    self.assertTrue(command.startswith(tool + " "), command)
                    before = self.files()
                    result = subprocess.run(["sh", "-c", command], cwd=self.folder, timeout=300, check=False,
                                            capture_output=True, encoding="utf-8",
                                            env={"PATH": f"{BIN}:{os.environ['PATH']}"})
                    self.assertEqual((result.returncode, result.stderr), (0, ""))
                    written = re.findall(r"(?:-o|--displacement|--outlines|>) (\S+)", command)
                    for name in written:
                        self.assertTrue((self.folder / name).exists(), name)
                    if not written:
                        self.assertEqual(self.files(), before)


if __name__ == "__main__":
    main()

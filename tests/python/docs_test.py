"""The examples of docs/python.md run, in order and in one namespace, as a reader runs them; its tables name everything."""
import contextlib
import importlib.util
import io
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from PIL import Image

import imgmesh

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")


class Page(unittest.TestCase):
    def test_examples(self):
        blocks = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
        self.assertGreater(len(blocks), 6)
        os.environ["MPLBACKEND"] = "Agg"
        names = {}
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), contextlib.redirect_stdout(io.StringIO()):
            Image.open(ROOT / "tests/data/kodim23.png").resize((192, 128)).save("photo.png")
            for block in blocks:
                if "photo.npz" in block:  # what the two commands before it do
                    subprocess.run([pathlib.Path(os.environ["IMGMESH_BIN"], "imgmesh-convert"), "photo.glb", "-o", "photo.npz", "-q"],
                                   check=True)
                if "matplotlib" in block and not importlib.util.find_spec("matplotlib"):
                    continue
                with self.subTest(block=block.splitlines()[0]):
                    exec(compile(block, "docs/python.md", "exec"), names)
            self.assertEqual(names["bent"].shape, (128, 192, 3))
            self.assertEqual(len(names["mean"]), 20)
            self.assertEqual(names["corners"].shape, (128, 192, 3, 2))

    def test_by_hand_is_nearly_the_reconstruction(self):
        block = next(b for b in re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL) if "einsum" in b)
        mesh = imgmesh.build(str(ROOT / "tests/data/kodim23.png"), preset="fast")
        names = {"mesh": mesh}
        with contextlib.redirect_stdout(io.StringIO()):
            exec(block, names)
        self.assertGreater(imgmesh.compare((names["image"].clip(0, 1) * 255).round().astype("uint8"), mesh).psnr, 30)
        self.assertEqual(names["area"].sum(), mesh.width * mesh.height)

    def test_tables_are_complete(self):
        tables = "\n".join(line for line in PAGE.splitlines() if line.startswith("|"))
        for name in imgmesh.__all__:
            self.assertRegex(tables, rf"`{name}\b", name)
        for kind in (imgmesh.Mesh, imgmesh.Image, imgmesh.Segmentation, imgmesh.Comparison):
            rows = "\n".join(line for line in tables.splitlines() if f"`{kind.__name__}." in line)
            for member in dir(kind):
                if not member.startswith("_"):
                    self.assertRegex(rows, rf"[.`]{member}\b", f"{kind.__name__}.{member}")


if __name__ == "__main__":
    unittest.main()

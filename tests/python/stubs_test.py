"""The typed stubs name exactly what the module has, and every docstring is there."""
import ast
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import imgmesh

PACKAGE = pathlib.Path(imgmesh.__file__).parent
TREE = ast.parse((PACKAGE / "__init__.pyi").read_text())
CLASSES = {node.name: node for node in TREE.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in TREE.body if isinstance(node, ast.FunctionDef)}

USE = """
import numpy as np
import imgmesh
mesh = imgmesh.build("a.png", faces=2000, metric="hoppe", level_faces=None, progress=lambda fraction, stage: None)
mesh.write("a.glb", draco="none")
vertices: np.ndarray[tuple[int, ...], np.dtype[np.float32]] = mesh.vertices
area = float(vertices[mesh.faces[:, 0]].sum())
image: imgmesh.Image = mesh.levels[0].colors is not None and mesh.reconstruct(level=1) or imgmesh.read_image("b.png")
psnr: float = imgmesh.compare(mesh, np.zeros((3, 4), np.uint8)).psnr
try:
    imgmesh.build(image)
except imgmesh.ArgumentError as error:
    print(error)
"""
MISUSE = ['imgmesh.build("a.png", face=3)', 'imgmesh.build("a.png", metric="x")', "mesh.vertices = 3", 'mesh.write(3.5)']


def members(node):
    own = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
    return own.union(*(members(CLASSES[base.id]) for base in node.bases if getattr(base, "id", None) in CLASSES))


class Stubs(unittest.TestCase):
    def test_public_names(self):
        assigned = {node.target.id for node in TREE.body if isinstance(node, ast.AnnAssign)}
        public = {name for name in assigned | set(CLASSES) | set(FUNCTIONS) if not name.startswith("_") or name == "__version__"}
        self.assertEqual(sorted(public), sorted(imgmesh.__all__))
        self.assertEqual(set(imgmesh.__all__) - set(dir(imgmesh)), set())

    def test_members(self):
        for name in ("Image", "Mesh", "Level", "Segmentation", "Comparison"):
            kind = getattr(imgmesh, name)
            has = {member for member in dir(kind) if not member.startswith("_")}
            self.assertEqual(has, {member for member in members(CLASSES[name]) if not member.startswith("_")}, name)
            for member in has | {"__doc__"}:
                text = kind.__doc__ if member == "__doc__" else getattr(kind, member).__doc__
                self.assertTrue(text and len(text) > 5, f"{name}.{member} has no docstring")

    def test_parameters_of_build(self):
        keywords = {argument.arg: argument.annotation for argument in FUNCTIONS["build"].args.kwonlyargs}
        for parameter in imgmesh.build_parameters():
            self.assertIn(parameter["name"], keywords)
            if "words" in parameter:
                words = [c.value for c in ast.walk(keywords[parameter["name"]]) if isinstance(c, ast.Constant) and c.value]
                self.assertEqual(words, parameter["words"])
        others = set(keywords) - {parameter["name"] for parameter in imgmesh.build_parameters()}
        for name in others:  # each is known: a value of no type gets another answer than an unknown name
            with self.assertRaises(Exception) as caught:
                imgmesh.build(__file__, **{name: object()})
            self.assertNotIn("has no parameter", str(caught.exception), name)

    def test_keywords_of_functions(self):
        """pybind11 writes the names of parameters into the docstrings."""
        for kind, node in [(imgmesh, TREE)] + [(getattr(imgmesh, n), CLASSES[n]) for n in ("Mesh", "Segmentation")]:
            for function in node.body:
                if not isinstance(function, ast.FunctionDef) or function.decorator_list or function.name in ("build", "read_image"):
                    continue
                first = getattr(kind, function.name).__doc__.splitlines()[0]
                for argument in function.args.args + function.args.kwonlyargs:
                    self.assertIn(f"{argument.arg}: ", first, function.name)

    @unittest.skipUnless(shutil.which("mypy", path="/usr/bin"), "no mypy")
    def test_mypy(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "use.py")
            file.write_text(USE)
            done = self.mypy(file)
            self.assertEqual(done.returncode, 0, done.stdout)
            file.write_text(USE + "\n".join(MISUSE))
            done = self.mypy(file)
            self.assertEqual(len(set(re.findall(r"use.py:(\d+): error: ", done.stdout))), len(MISUSE), done.stdout)

    def mypy(self, file):
        return subprocess.run(["/usr/bin/mypy", "--strict", "--cache-dir", str(file.parent), str(file)], cwd=file.parent,
                              env={"MYPYPATH": str(PACKAGE.parent)}, capture_output=True, text=True, check=False)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
"""python_test.py PREFIX...: the Python module that is installed below each prefix (or lies in a build tree) can be imported
from any folder, builds, and finds imgmesh-codecs where it lies to it."""
import os
import pathlib
import subprocess
import sys
import tempfile

CODE = """
import sys, numpy, PIL.Image, imgmesh
assert imgmesh.__file__.startswith(sys.argv[1]), imgmesh.__file__
image = numpy.arange(12 * 16 * 3).reshape(12, 16, 3).astype(numpy.uint8)
PIL.Image.fromarray(image[..., 0]).save("a.gif")  # read by imgmesh-codecs
numpy.testing.assert_array_equal(imgmesh.read_image("a.gif").array[..., 0], image[..., 0])
imgmesh.build(image).write("a.glb")
assert imgmesh.read("a.glb").width == 16
"""


def packages(prefix):
    found = [path.parent.parent for path in prefix.glob("**/imgmesh/__init__.py")]
    assert len(found) == 1, f"{prefix}: expected one package imgmesh, found {found}"
    return found[0]


def main(prefixes):
    for prefix in prefixes:
        folder = packages(pathlib.Path(prefix).resolve())
        with tempfile.TemporaryDirectory() as work:
            subprocess.run([sys.executable, "-B", "-c", CODE, str(folder)], cwd=work, check=True,
                           env=os.environ | {"PYTHONPATH": str(folder)})


if __name__ == "__main__":
    main(sys.argv[1:])

"""locate_test.py PROGRAM: locate_map.py gives the same faces and weights as imgmesh, on what write-located writes."""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import locate_map


class Reader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, dtype, *shape):
        values = np.frombuffer(self.data, dtype, int(np.prod(shape)), self.at).reshape(shape)
        self.at += values.nbytes
        return values


def check(reader):
    """The number of pixels of a case, and of those that differ."""
    width, height, steps, n, vertices, faces = map(int, reader.take("<i4", 6))
    positions, corners = reader.take("<f4", vertices, 2), reader.take("<u4", faces, 3)
    dx, dy = reader.take("<i2", height, width), reader.take("<i2", height, width)
    inside = reader.take("u1", height, width) != 0
    expected = reader.take([("face", "<u4"), ("u", "<f4"), ("v", "<f4")], height, width)
    face, u, v = locate_map.pixel_map(corners, positions, dx, dy, steps, inside, n)
    same = (face == expected["face"]) & (u == expected["u"]) & (v == expected["v"])
    return same.size, same.size - same.sum()


def main():
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "located"
        subprocess.run([sys.argv[1], file], check=True)
        reader = Reader(file.read_bytes())
    pixels = wrong = 0
    while reader.at < len(reader.data):
        counted, differ = check(reader)
        pixels, wrong = pixels + counted, wrong + differ
    print(f"{pixels} pixels, {wrong} wrong")
    sys.exit(1 if pixels == 0 or wrong else 0)


main()

"""Reads MATLAB's files of level 5, as MathWorks' "MAT-File Format" describes them, and as SciPy does where it is installed."""
import struct
import zlib

import numpy as np

try:
    import scipy.io
except ImportError:
    scipy = None

NUMBERS = {1: "i1", 2: "u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 9: "<f8"}
CLASSES = {6: np.float64, 7: np.float32, 11: np.uint16, 13: np.uint32}


def elements(data):
    """The data elements as (type, bytes)."""
    at = 0
    while at < len(data):
        kind, size = struct.unpack_from("<II", data, at)
        if kind >> 16:  # a small element
            kind, size = kind & 0xFFFF, kind >> 16
            yield kind, data[at + 4:at + 4 + size]
            at += 8
        else:
            yield kind, data[at + 8:at + 8 + size]
            at += 8 + size
            if kind != 15:
                at += -at % 8


def array(data):
    """The name and the value of an array; a cell array is one of objects."""
    parts = list(elements(data))
    kind = struct.unpack("<I", parts[0][1][:4])[0] & 0xFF
    shape = np.frombuffer(parts[1][1], "<i4")
    name = parts[2][1].decode()
    if kind == 1:
        cells = np.empty(len(parts) - 3, object)
        for i, (_, cell) in enumerate(parts[3:]):
            cells[i] = array(cell)[1]
        return name, cells.reshape(shape, order="F")
    values = np.frombuffer(parts[3][1], NUMBERS[parts[3][0]])
    assert values.dtype == CLASSES[kind]
    return name, values.reshape(shape, order="F")


def load(path):
    """The variables of a file by their names."""
    data = path.read_bytes()
    assert data[:19] == b"MATLAB 5.0 MAT-file" and data[124:128] == b"\x00\x01IM"
    variables = {}
    for kind, element in elements(data[128:]):
        assert kind == 15
        (inner, content), = elements(zlib.decompress(element))
        assert inner == 14
        name, value = array(content)
        variables[name] = value
    if scipy:
        found = {k: v for k, v in scipy.io.loadmat(path).items() if not k.startswith("__")}
        assert list(found) == list(variables)
        for name, value in variables.items():
            if value.dtype == object:
                np.testing.assert_array_equal(found[name][0, 0], value[0, 0], strict=True)
            else:
                np.testing.assert_array_equal(found[name], value, strict=True)
    return variables

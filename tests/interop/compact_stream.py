#!/usr/bin/python3
"""Decodes a compact stream without any code of imgmesh, from docs/format.md alone. It is slow and plain.

decode(bytes) gives the parts by their names. As a program: compact_stream.py STREAM [--part NAME] [--expect FILE].
"""
import argparse
import struct
import sys
import zlib

import numpy as np

TOKEN_BITS = (3, 4, 5, 6, 7, 8, 10, 16)
TOKEN_FIRST = (24, 32, 48, 80, 144, 272, 528, 1552)
NEIGHBOURS = ((-1, 0), (-2, 0), (0, -1), (-1, -1), (1, -1), (0, -2), (-2, -1), (2, -1), (-1, -2), (1, -2))
ENERGY_WEIGHTS = (4, 2, 4, 2, 2, 2, 1, 1, 1, 1)


class Bits:
    def __init__(self, data):
        self.bits = np.unpackbits(np.frombuffer(data, np.uint8), bitorder="little")
        self.at = 0

    def take(self, count):
        value = sum(int(bit) << i for i, bit in enumerate(self.bits[self.at : self.at + count]))
        self.at += count
        return value


def read_table(bits):
    """(first, frequency) of each token."""
    count = bits.take(5) + 1
    codes = [bits.take(7)]
    while len(codes) < count:
        number = 0
        while bits.take(1) == 0:
            number += 4
        number += bits.take(2)
        codes.append(codes[-1] + ((number + 1) // 2 if number % 2 else -(number // 2)))
    weights = [(8 + code % 8) << (code // 8) for code in codes]
    frequencies = [max(1, 1024 * weight // sum(weights)) for weight in weights]
    frequencies[frequencies.index(max(frequencies))] += 1024 - sum(frequencies)
    return [(sum(frequencies[:i]), frequency) for i, frequency in enumerate(frequencies)]


def read_tables(data):
    """The taps of dx and dy, and for [component][class][level] a list of each slot's (token, first, frequency)."""
    bits = Bits(data)
    taps = np.array([bits.take(16) for _ in range(20)], np.uint16).astype(np.int16).astype(int).reshape(2, 10)
    slots = [[], []]
    for component in range(2):
        for _ in range(3):
            of_level = [0]
            for _ in range(21):
                of_level.append(of_level[-1] + bits.take(1))
            tables = []
            for _ in range(of_level[-1] + 1):
                table = read_table(bits)
                tables.append([(token, *entry) for token, entry in enumerate(table) for _ in range(entry[1])])
            slots[component].append([tables[table] for table in of_level])
    return taps.tolist(), slots


def level_of(energy):
    if energy < 4:
        return energy
    octave = energy.bit_length() - 1
    return 2 * octave + (energy >> (octave - 1) & 1)


def unzip(block, size):
    """A block of EXR's ZIP."""
    if len(block) == size:
        return np.frombuffer(block, np.uint8)
    data = np.frombuffer(zlib.decompress(block), np.uint8).astype(int)
    data[1:] -= 128
    data = (np.cumsum(data) % 256).astype(np.uint8)
    result = np.empty(size, np.uint8)
    result[0::2], result[1::2] = data[: (size + 1) // 2], data[(size + 1) // 2 :]
    return result


def int16(number):
    return (number + 32768) % 65536 - 32768


class Band:
    """Decodes the words of a band; `inside` is (rows, width)."""

    def __init__(self, data, inside, tables):
        self.words = np.frombuffer(data[: len(data) // 2 * 2], "<u2").tolist()
        self.rows, self.width = inside.shape
        self.inside = inside.tolist()
        self.taps, self.slots = tables
        self.states = [self.words[0] << 16 | self.words[1], self.words[2] << 16 | self.words[3]]
        self.at = 4
        self.value = np.zeros((2, self.rows, self.width), int).tolist()
        self.size = np.zeros((2, self.rows + 2, self.width + 4), int).tolist()  # two rows above, two pixels beside
        self.plain = np.zeros((2, self.rows + 2, self.width + 4), int).tolist()

    def refill(self, component):
        if self.states[component] < 65536:
            self.states[component] = self.states[component] << 16 | self.words[self.at]
            self.at += 1

    def number(self, component, rest, energy):
        rest_class = 0 if abs(rest) < 32 else 1 if abs(rest) < 80 else 2
        state = self.states[component]
        token, first, frequency = self.slots[component][rest_class][level_of(energy)][state % 1024]
        self.states[component] = frequency * (state // 1024) + state % 1024 - first
        self.refill(component)
        if token < 24:
            return token
        bits = TOKEN_BITS[token - 24]
        more = self.states[component] % 2**bits
        self.states[component] >>= bits
        self.refill(component)
        return TOKEN_FIRST[token - 24] + more

    def at_pixel(self, component, x, y):
        rows = self.value[component]
        if x < 0:
            return rows[y - 1][0] if y > 0 else 0
        return rows[max(y, 0)][min(x, self.width - 1)]

    def prediction(self, component, x, y):
        if y == 0:
            return 256 * self.at_pixel(component, x - 1, 0)
        return sum(tap * self.at_pixel(component, x + dx, y + max(dy, -1 if y == 1 else -2))
                   for tap, (dx, dy) in zip(self.taps[component], NEIGHBOURS))

    def energy(self, component, x, y):
        size = self.size[component]
        return sum(weight * size[y + dy + 2][x + dx + 2] for weight, (dx, dy) in zip(ENERGY_WEIGHTS, NEIGHBOURS))

    def slope(self, x, y):
        xx, xy = 16, 0
        for weight, (dx, dy) in zip(ENERGY_WEIGHTS[2:], NEIGHBOURS[2:]):
            a, b = (max(-31, min(31, self.plain[k][y + dy + 2][x + dx + 2])) for k in range(2))
            xx += weight * a * a
            xy += weight * a * b
        quotient = 64 * abs(xy) // xx
        return max(-256, min(256, quotient if xy > 0 else -quotient))

    def component(self, component, x, y, prediction, plain_prediction, energy):
        whole = (prediction + 128) // 256
        rest = prediction - 256 * whole
        number = self.number(component, rest, energy) if self.inside[y][x] else 0
        magnitude = (number + 1) // 2
        residual = -magnitude if (number % 2 == 0) != (rest < 0) else magnitude
        value = int16(whole + residual)
        self.value[component][y][x] = value
        self.size[component][y + 2][x + 2] = min(magnitude, 80)
        self.plain[component][y + 2][x + 2] = int16(value - (plain_prediction + 128) // 256)
        return value

    def decode(self):
        for y in range(self.rows):
            for x in range(self.width):
                px, py = self.prediction(0, x, y), self.prediction(1, x, y)
                ex, ey = self.energy(0, x, y), self.energy(1, x, y)
                dx = self.component(0, x, y, px, px, ex + ey // 8)
                slope = self.slope(x, y) if y > 0 else 0
                self.component(1, x, y, py + slope * (256 * dx - px) // 64, py, ey + 2 * self.size[0][y + 2][x + 2])
        if self.states != [65536, 65536] or any(self.words[self.at :]):
            raise ValueError("the band does not end as it must")
        return np.array(self.value) * np.array(self.inside)


def read_part(data, at):
    """A part as a dictionary of dx, dy, inside and visits (H, W), steps, half and topology; its name; where it ends."""
    def take(form):
        nonlocal at
        values = struct.unpack_from("<" + form, data, at)
        at += struct.calcsize("<" + form)
        return values[0] if len(values) == 1 else values

    name = take(f"{take('B')}s").decode()
    steps, flags, width, height, band_rows = take("BBIII")
    topology = take("32s").hex() if flags & 4 else ""
    tables = read_tables(take(f"{take('I')}s"))
    lengths = [take("I") for _ in range(0, height, band_rows)]
    part = {"steps": steps, "half": bool(flags & 8), "topology": topology, "inside": np.ones((height, width), bool),
            "visits": np.zeros((height, width), np.uint32), "dx": np.zeros((height, width), int)}
    part["dy"] = part["dx"].copy()
    for band, length in enumerate(lengths):
        first = band * band_rows
        rows = min(band_rows, height - first)
        end = at + length
        lines = slice(first, first + rows)
        if flags & 1:
            row_bytes = (width + 7) // 8
            block = unzip(take(f"{take('I')}s"), rows * row_bytes).reshape(rows, row_bytes)
            changes = np.unpackbits(block, axis=1, bitorder="little")[:, :width]
            part["inside"][lines] = np.cumsum(changes, axis=0) % 2 == 1
        if flags & 2:
            block = unzip(take(f"{take('I')}s"), 4 * rows * width)
            part["visits"][lines] = np.frombuffer(block.tobytes(), "<u4").reshape(rows, width)
        part["dx"][lines], part["dy"][lines] = Band(data[at:end], part["inside"][lines], tables).decode()
        at = end
    return name, part, at


def decode(data):
    """The parts of a stream by their names."""
    magic, major, _, count = struct.unpack_from("<4sBBH", data)
    if magic != b"IMAP" or major != 1:
        raise ValueError("not a compact stream of version 1")
    parts, at = {}, 8
    for _ in range(count):
        name, parts[name], at = read_part(data, at)
    if at != len(data):
        raise ValueError("bytes after the end")
    return parts


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("stream")
    parser.add_argument("--part", default="lod0")
    parser.add_argument("--expect", help="a file of dx and then dy, 16 bits each")
    options = parser.parse_args()
    with open(options.stream, "rb") as file:
        part = decode(file.read())[options.part]
    found = np.stack([part["dx"], part["dy"]]).astype("<i2")
    print(f"{options.part}: {found.shape[2]}x{found.shape[1]}, {part['steps']} steps, {part['inside'].sum()} pixels inside")
    if options.expect and found.tobytes() != open(options.expect, "rb").read():
        print("other displacements than expected")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""Draws the image of a container without any code of imgmesh, from docs/format.md alone.

read_container.py IN OUT.png [--level K] [--exposure E] [--expect PICTURE [--min-psnr DB]] [--channel NAME --within LOW HIGH]

IN is a .glb or .gltf written with --draco none, with layers as EXR or compact. With --expect the result is compared, and the exit code is 1 below
DB (default 45) decibels. --exposure multiplies the light before it is drawn. --channel prints the least and the
largest value of a channel beside the colour; the exit code is 1 where they are not LOW to HIGH.
"""
import argparse
import hashlib
import json
import pathlib
import re
import struct
import sys
import tempfile
import urllib.parse

import numpy as np
import OpenImageIO as oiio
from PIL import Image

import compact_stream
import locate_map

EXTENSION = "IMGMESH_pixel_map"
COMPACT = "application/x-imgmesh-map"
NO_FACE = 0xFFFFFFFF


def read_gltf(path):
    """The document, the buffer's bytes and the layers' bytes."""
    data = path.read_bytes()
    binary = b""
    if data[:4] == b"glTF":
        (json_length,) = struct.unpack_from("<I", data, 12)
        start = 20 + json_length
        (binary_length,) = struct.unpack_from("<I", data, start)
        binary = data[start + 8 : start + 8 + binary_length]
        data = data[20:start]
    document = json.loads(data)

    def beside(uri):
        return (path.parent / urllib.parse.unquote(uri)).read_bytes()

    if "uri" in document["buffers"][0]:
        binary = beside(document["buffers"][0]["uri"])
    layers = document["extensions"][EXTENSION]["layers"]
    if "uri" in layers:
        return document, binary, beside(layers["uri"])
    view = document["bufferViews"][layers["bufferView"]]
    start = view.get("byteOffset", 0)
    return document, binary, binary[start : start + view["byteLength"]]


def read_accessor(document, binary, index):
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    dtype = {5123: "<u2", 5125: "<u4", 5126: "<f4"}[accessor["componentType"]]
    width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return np.frombuffer(binary, dtype, accessor["count"] * width, start).reshape(-1, width)


def channel_attributes(names):
    """The attributes of the channels beside the colour, by the channels' names."""
    colour = {"R", "G", "B"} if {"R", "G", "B"} <= set(names) else {"Y"}
    attributes = {}
    for name in names:
        if name in colour:
            continue
        first = attribute = "_CHANNEL_" + re.sub("[^A-Z0-9]", "_", re.sub("[a-z]", lambda m: m[0].upper(), name))
        count = 1
        while attribute in attributes.values():
            count += 1
            attribute = f"{first}_{count}"
        attributes[name] = attribute
    return attributes


def read_mesh(document, binary, node):
    """Faces (F, 3), positions (V, 2) with y down, linear colours (V, 3), other channels' values (V) by their names."""
    (primitive,) = document["meshes"][node["mesh"]]["primitives"]
    if "KHR_draco_mesh_compression" in primitive.get("extensions", {}):
        sys.exit("the mesh is Draco-compressed; write it with --draco none")
    indices = read_accessor(document, binary, primitive["indices"])
    positions = read_accessor(document, binary, primitive["attributes"]["POSITION"])
    if "_LIGHT" in primitive["attributes"]:
        colors = read_accessor(document, binary, primitive["attributes"]["_LIGHT"])
    else:
        name = "COLOR_0" if "COLOR_0" in primitive["attributes"] else "_COLOR"  # hidden where there is a texture
        colors = read_accessor(document, binary, primitive["attributes"][name])[:, :3] / 65535.0
    names = document["extensions"][EXTENSION]["image"]["channels"]
    channels = {name: read_accessor(document, binary, primitive["attributes"][attribute])[:, 0]
                for name, attribute in channel_attributes(names).items()}
    topology = hashlib.sha256(indices.tobytes() + positions.tobytes()).hexdigest()
    if topology != node["extensions"][EXTENSION]["topology"]:
        sys.exit("the topology hash does not match")
    return indices.reshape(-1, 3), positions[:, :2] * (1, -1), colors, channels


def read_compact(stream, part, topology, faces, positions):
    """The same as read_exr(): faces and weights follow from the displacements and the mesh."""
    stored = compact_stream.decode(stream)[part]
    if stored["topology"] not in ("", topology):
        sys.exit("the layers were made for another mesh")
    n = 2048 if stored["half"] else 2**24
    return locate_map.pixel_map(faces, positions, stored["dx"], stored["dy"], stored["steps"], stored["inside"], n)


def read_exr(exr, part, topology):
    """face.id (H, W) as integers, u and v (H, W). A channel is read alone: as one type all would become floats."""
    with tempfile.NamedTemporaryFile(suffix=".exr") as file:
        file.write(exr)
        file.flush()
        image = oiio.ImageInput.open(file.name)
        index = 0
        while image.seek_subimage(index, 0):
            spec = image.spec()
            if spec.getattribute("oiio:subimagename") == part or spec.getattribute("name") == part:
                if spec.getattribute("imgmesh:topology") not in (None, topology):
                    sys.exit("the layers were made for another mesh")

                def channel(name, kind):
                    c = spec.channelnames.index(name)
                    return image.read_image(index, 0, c, c + 1, kind)[:, :, 0]
                return channel("face.id", "uint"), channel("bary.u", "float"), channel("bary.v", "float")
            index += 1
    sys.exit(f"the EXR has no part {part}")


# The CIE's formulas for L*u*v*, with the sRGB primaries and the white point D65 of x, y = 0.3127, 0.3290.
TO_XYZ = np.array([[0.4123908, 0.3575843, 0.1804808], [0.2126390, 0.7151687, 0.0721923],
                   [0.0193308, 0.1191948, 0.9505322]])
WHITE = TO_XYZ.sum(axis=1)


def chromaticity(xyz):
    total = np.maximum(xyz @ [1, 15, 3], 1e-12)
    return 4 * xyz[..., 0] / total, 9 * xyz[..., 1] / total


def luv_from_linear(rgb):
    xyz = rgb @ TO_XYZ.T
    y = xyz[..., 1]
    lightness = np.where(y > (6 / 29) ** 3, 116 * np.cbrt(y) - 16, (29 / 3) ** 3 * y)
    (u, v), (u0, v0) = chromaticity(xyz), chromaticity(WHITE)
    return np.stack([lightness, 13 * lightness * (u - u0), 13 * lightness * (v - v0)], axis=-1)


def linear_from_luv(luv):
    lightness = luv[..., 0]
    u0, v0 = chromaticity(WHITE)
    scale = np.where(lightness > 0, 13 * lightness, np.inf)
    u, v = luv[..., 1] / scale + u0, luv[..., 2] / scale + v0
    y = np.where(lightness > 8, ((lightness + 16) / 116) ** 3, lightness * (3 / 29) ** 3)
    xyz = np.stack([y * 9 * u / (4 * v), y, y * (12 - 3 * u - 20 * v) / (4 * v)], axis=-1)
    return xyz @ np.linalg.inv(TO_XYZ).T


def srgb_from_linear(rgb):
    rgb = np.clip(rgb, 0, 1)
    return np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055)


def reconstruct(path, level, exposure=1.0):
    """The image as (H, W, 3) bytes, where it has faces (H, W), and the other channels (H, W) by their names."""
    document, binary, layers = read_gltf(path)
    part = f"lod{level}"
    node = next(n for n in document["nodes"] if n["extensions"][EXTENSION]["part"] == part)
    faces, positions, colors, channels = read_mesh(document, binary, node)
    topology = node["extensions"][EXTENSION]["topology"]
    if document["extensions"][EXTENSION]["layers"]["mimeType"] == COMPACT:
        face, u, v = read_compact(layers, part, topology, faces, positions)
    else:
        face, u, v = read_exr(layers, part, topology)
    inside = face != NO_FACE
    corners = luv_from_linear(colors)[faces[np.where(inside, face, 0)]]
    u, v = u.astype(float), v.astype(float)
    weights = np.stack([1 - u - v, u, v], axis=-1)
    luv = (weights[..., None] * corners).sum(axis=2)
    rgb = srgb_from_linear(exposure * linear_from_luv(luv)) * inside[..., None]
    drawn = {name: (weights * values[faces[np.where(inside, face, 0)]]).sum(axis=2)
             for name, values in channels.items()}
    return np.rint(rgb * 255).astype(np.uint8), inside, drawn


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("input", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--level", type=int, default=0)
    parser.add_argument("--exposure", type=float, default=1.0)
    parser.add_argument("--channel")
    parser.add_argument("--within", type=float, nargs=2, default=(-np.inf, np.inf))
    parser.add_argument("--expect", type=pathlib.Path)
    parser.add_argument("--min-psnr", type=float, default=45.0)
    options = parser.parse_args()
    picture, inside, channels = reconstruct(options.input, options.level, options.exposure)
    if options.channel:
        values = channels[options.channel][inside]
        print(f"{options.channel}: {values.min():g} to {values.max():g}")
        if values.min() < options.within[0] or values.max() > options.within[1]:
            return 1
    Image.fromarray(np.dstack([picture, inside.astype(np.uint8) * 255])).save(options.output)
    if not options.expect:
        return 0
    expected = np.asarray(Image.open(options.expect).convert("RGB"))
    if expected.shape != picture.shape:
        sys.exit(f"{options.expect} is of another size")
    error = ((picture.astype(float) - expected)[inside] ** 2).mean() if inside.any() else 0.0
    psnr = 10 * np.log10(255**2 / error) if error > 0 else np.inf
    print(f"{options.input.name}: {psnr:.1f} dB")
    return 0 if psnr >= options.min_psnr else 1


if __name__ == "__main__":
    sys.exit(main())

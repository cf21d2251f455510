"""Small images made on the spot."""
import struct
import zlib

import numpy as np
import OpenImageIO as oiio


def noise(width, height, channels=3, seed=1):
    return np.random.default_rng(seed).random((height, width, channels))


def ramp(width, height):
    """Smooth colour with one edge, so that a small mesh can stand for it."""
    y, x = np.mgrid[0:height, 0:width]
    u, v = x / max(width - 1, 1), y / max(height - 1, 1)
    disc = (u - 0.5) ** 2 + (v - 0.4) ** 2 < 0.08
    return np.stack([0.2 + 0.6 * u, 0.3 + 0.4 * v, np.where(disc, 0.9, 0.1)], axis=-1)


def checkerboard(width, height):
    y, x = np.mgrid[0:height, 0:width]
    return np.repeat(((x + y) % 2)[..., None], 3, axis=-1).astype(float)


def png(path, samples, bits=8, palette=None):
    """Writes a PNG byte by byte. samples: height x width x channels in [0, 1], or palette indices."""
    samples = np.asarray(samples)
    height, width = samples.shape[:2]
    if palette is not None:
        colour_type, rows = 3, samples.astype(np.uint8)
    else:
        colour_type = {1: 0, 2: 4, 3: 2, 4: 6}[samples.shape[2]]
        rows = np.round(samples * (2 ** bits - 1)).astype(">u2" if bits == 16 else np.uint8)
    raw = b"".join(b"\0" + rows[y].tobytes() for y in range(height))
    data = b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", png_header(width, height, bits, colour_type))
    if palette is not None:
        data += png_chunk(b"PLTE", np.round(np.asarray(palette) * 255).astype(np.uint8).tobytes())
    data += png_chunk(b"IDAT", zlib.compress(raw)) + png_chunk(b"IEND", b"")
    path.write_bytes(data)
    return path


def png_header(width, height, bits=8, colour_type=2):
    return struct.pack(">IIBBBBB", width, height, bits, colour_type, 0, 0, 0)


def png_chunk(name, body):
    return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))


def huge_png(path, width=100000, height=100000):
    """A PNG whose header promises more than anyone has memory for."""
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", png_header(width, height)) +
                     png_chunk(b"IDAT", zlib.compress(b"\0" * 1000)) + png_chunk(b"IEND", b""))
    return path


def write_float(path, samples, sample_type="float", names=None):
    """Writes through OpenImageIO, for EXR and TIFF."""
    samples = np.ascontiguousarray(samples, dtype=np.float32)
    height, width, channels = samples.shape
    out = oiio.ImageOutput.create(str(path))
    stored = oiio.ImageSpec(width, height, channels, sample_type)
    if names:
        stored.channelnames = names
    if not out.open(str(path), stored) or not out.write_image(samples) or not out.close():
        raise RuntimeError(out.geterror() or oiio.geterror())
    return path


def read(path):
    """height x width x channels as float: integers scaled to [0, 1]."""
    source = oiio.ImageInput.open(str(path))
    if source is None:
        raise RuntimeError(oiio.geterror())
    samples = source.read_image(format="float")
    source.close()
    return samples


def spec(path):
    source = oiio.ImageInput.open(str(path))
    found = source.spec()
    source.close()
    return found


def psnr(a, b):
    mse = np.mean((np.asarray(a, float) - np.asarray(b, float)) ** 2)
    return float("inf") if mse == 0 else -10 * np.log10(mse)

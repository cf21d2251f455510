"""Points of rate and distortion of one picture: a codec at a number of bytes.

A point is a dict of the file's bytes, the scale and filter that it was drawn with, and the figures of measures.METRICS.
"""
import numpy as np
from PIL import Image

import measures
from bench_process import BenchError, run
from peers import run_words

# Options of imgmesh-encode. The second keeps another error low.
MESHES = {"mesh": (), "mesh-ssim": ("--tune", "ssim")}
# Other formats may code a smaller picture, which is scaled up again: at few bytes that beats a poor one of full size.
SCALES = {"1": 1, "2/3": 2 / 3, "1/2": 1 / 2, "1/3": 1 / 3, "1/4": 1 / 4, "1/6": 1 / 6}
FILTERS = {"Lanczos": Image.Resampling.LANCZOS, "bicubic": Image.Resampling.BICUBIC}
# Scales below one that is worse by this than the best are not tried: error has one minimum over the scale [dB].
HOPELESS = 1.0


class PictureRun:
    """Codes one picture in a folder of its own; `tools` is the folder of imgmesh's programs."""

    def __init__(self, image, tools, folder):
        self.image, self.tools, self.folder = image, tools, folder
        self.pixels = np.asarray(image)
        self.original = self.source("1")

    def source(self, scale):
        """The picture at that scale as a PNG, with a PPM beside it."""
        path = self.folder / f"at-{scale.replace('/', '-')}.png"
        if not path.exists():
            small = self.image
            if scale != "1":
                size = [max(1, round(side * SCALES[scale])) for side in self.image.size]
                small = self.image.resize(size, Image.Resampling.LANCZOS)
            small.save(path.with_suffix(".ppm"))
            small.save(path, compress_level=1)
        return path

    def figures(self, decoded):
        path = self.folder / "decoded.png"
        decoded.save(path, compress_level=1)
        pixels = np.asarray(decoded)
        return {"psnr": measures.psnr(self.pixels, pixels), "luma_psnr": measures.luma_psnr(self.pixels, pixels),
                **measures.compared(self.tools, self.original, path)}

    def peer_points(self, peer, limit):
        """A point for every scale and filter, from full size on; none where no file is small enough."""
        points, best = [], 0
        for scale in SCALES:
            quality = peer.within(self.source(scale), limit)
            if quality is None:
                continue
            size = peer.measure(peer.encoded(self.source(scale), quality))
            here = [{"bytes": size, "quality": quality, "scale": scale, "filter": name,
                     **self.figures(self.drawn(peer, quality, scale, name))}
                    for name in (FILTERS if scale != "1" else [""])]
            points += here
            reached = max(p["psnr"] for p in here)
            if reached < best - HOPELESS:
                break
            best = max(best, reached)
        return points

    def drawn(self, peer, quality, scale, name):
        """The decoded picture at full size."""
        decoded = peer.decoded(peer.encoded(self.source(scale), quality))
        return decoded if scale == "1" else decoded.resize(self.image.size, FILTERS[name])

    def mesh_points(self, mesh, limit, file):
        """The one point of a coded mesh, whose bytes go to `file`."""
        encode_seconds = cpu_seconds([self.tools / "imgmesh-encode", self.original, "-o", file, "--bytes", limit,
                                      "--threads", 1, *MESHES[mesh]])
        if file.stat().st_size > limit:
            raise BenchError(f"{file}: {file.stat().st_size} bytes, expected at most {limit}")
        decoded, decode_seconds = self.drawn_mesh(file)
        return [{"bytes": file.stat().st_size, "scale": "1", "filter": "", **self.figures(decoded),
                 "encode_seconds": encode_seconds, "decode_seconds": decode_seconds}]

    def drawn_mesh(self, file):
        """The decoded picture and the CPU seconds of the whole program."""
        out = self.folder / "mesh.png"
        seconds = cpu_seconds([self.tools / "imgmesh-decode", file, "-o", out, "--threads", 1])
        return Image.open(out).convert("RGB"), seconds

    def lossless_bytes(self, command):
        file = self.folder / "lossless"
        run_words(command, png=self.original, file=file)
        return file.stat().st_size


def cpu_seconds(command):
    usage, _ = run(command)
    return round(usage["user_seconds"] + usage["system_seconds"], 3)


def chosen(points, metric, full_size=False):
    """The point with the best figure, or None. Each format shows its best for each metric, though that takes several files."""
    points = [p for p in points if p["scale"] == "1" or not full_size]
    value = measures.best([p[metric] for p in points], metric)
    return next((p for p in points if p[metric] == value), None)

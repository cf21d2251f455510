#!/usr/bin/python3
"""Coded meshes beside JPEG, WebP, AVIF and JPEG XL: error over bytes, as a page, tables and JSON.

compression.py BIN FOLDER OUT [--bytes 2000,8000] [--codecs mesh,AVIF] [--groups drawings] [--jobs N]

BIN     folder with imgmesh-encode, imgmesh-decode and imgmesh-compare
FOLDER  photographs, X.png
OUT     gets compression.html, compression.md, compression.json, curves as SVG, pictures/, files/ with the coded meshes,
        and peers.json: what other formats reached, which later runs need not measure again

Every codec is given numbers of bytes, and makes the largest file that does not exceed them.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading

import numpy as np
from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE.parent / "bench"), str(HERE.parents[1] / "tools" / "paper")]

import own_pictures  # noqa: E402
import report  # noqa: E402
from bench_process import BenchError  # noqa: E402
from measures import area_average  # noqa: E402
from peers import AVIF, AVIF_PAYLOAD, LOSSLESS, PEERS, avif_payload  # noqa: E402
from points import MESHES, PictureRun, chosen  # noqa: E402

SCHEMA = "imgmesh-compression.report.schema.json"
GROUPS = ("photographs", "thumbnails", "drawings", "smooth")
BYTES = (1000, 2000, 4000, 8000, 16000, 32000)
THUMBNAIL_SIDE, THUMBNAIL_BYTES = 144, (200, 400)
SHOWN = 3  # photographs that are shown side by side


def some_of(names):
    """A parser of lists of these names, which it gives in their own order."""
    def parse(text):
        if not set(text.split(",")) <= set(names):
            raise argparse.ArgumentTypeError(f"'{text}': expected some of {','.join(names)}")
        return [name for name in names if name in text.split(",")]
    return parse


def options(arguments):
    parser = argparse.ArgumentParser(prog="compression", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--bytes", type=lambda text: sorted({int(n) for n in text.split(",")}), default=BYTES,
                        help=f"sizes of files (default {','.join(map(str, BYTES))})")
    parser.add_argument("--codecs", type=some_of([*MESHES, *PEERS]), default=["mesh", *PEERS],
                        help=f"some of {','.join([*MESHES, *PEERS])} (default all but mesh-ssim)")
    parser.add_argument("--groups", type=some_of(GROUPS), default=GROUPS, help=f"some of {','.join(GROUPS)}")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="pictures at one time (default: one a core)")
    return parser.parse_args(arguments)


def version(package):
    return subprocess.run(["dpkg-query", "-W", "-f=${Version}", package], check=True, capture_output=True, text=True).stdout


class PeerCache:
    """Points that other formats reached, in a file: neither they nor the pictures change."""

    def __init__(self, path, peers):
        self.path, self.lock = path, threading.Lock()
        self.points = json.loads(path.read_text("utf-8")) if path.exists() else {}
        self.versions = {peer.package: version(peer.package) for peer in peers}

    def get(self, work, peer, limit, make):
        facts = [hashlib.sha256(work.pixels.tobytes()).hexdigest(), work.image.size, peer.name, peer.encode, peer.decode,
                 self.versions[peer.package], limit]
        key = f"{peer.name} {limit} {hashlib.sha256(json.dumps(facts).encode()).hexdigest()[:16]}"
        if key not in self.points:
            points = make()
            with self.lock:
                self.points[key] = points
                self.path.write_text(json.dumps(self.points, indent=1) + "\n", "utf-8")
        return self.points[key]


def groups(photographs):
    """{group: ({name: image}, numbers of bytes or None for those of the command line)}"""
    thumbnails = {}
    for name, image in photographs.items():
        share = THUMBNAIL_SIDE / max(image.size)
        size = [max(1, round(side * share)) for side in image.size]
        thumbnails[name] = Image.fromarray(area_average(np.asarray(image), *size))
    return {"photographs": (photographs, None), "thumbnails": (thumbnails, THUMBNAIL_BYTES),
            "drawings": (own_pictures.drawings(), None), "smooth": (own_pictures.smooth(photographs), None)}


class Comparison:
    """All points of all pictures: results[group][picture][codec][str(bytes)]."""

    def __init__(self, o, photographs):
        self.o = o
        self.groups = {group: content for group, content in groups(photographs).items() if group in o.groups}
        self.peers = [PEERS[codec] for codec in o.codecs if codec in PEERS]
        self.cache = PeerCache(o.out / "peers.json", self.peers)
        self.results = {group: dict.fromkeys(images) for group, (images, _) in self.groups.items()}
        self.lossless = {}
        self.shown = list(photographs)[:: max(1, len(photographs) // SHOWN)][:SHOWN]

    def run(self):
        tasks = [(group, name) for group, (images, _) in self.groups.items() for name in images]
        with concurrent.futures.ThreadPoolExecutor(self.o.jobs) as pool:
            for _ in pool.map(lambda task: self.picture(*task), tasks):
                pass

    def picture(self, group, name):
        images, limits = self.groups[group]
        with tempfile.TemporaryDirectory(prefix="imgmesh-compression-") as folder:
            work = PictureRun(images[name], self.o.bin, pathlib.Path(folder))
            self.results[group][name] = {codec: {str(limit): points for limit, points in by_limit}
                                         for codec, by_limit in self.codecs(work, group, name, limits or self.o.bytes)}
            if group in ("drawings", "smooth"):
                self.lossless[name] = {codec: work.lossless_bytes(command) for codec, command in LOSSLESS.items()
                                       if codec in self.o.codecs}
            if group in ("drawings", "smooth") or group == "photographs" and name in self.shown:
                self.draw(work, group, name)
        print(f"compression: {group}: {name}", file=sys.stderr, flush=True)

    def codecs(self, work, group, name, limits):
        for mesh in [codec for codec in self.o.codecs if codec in MESHES]:
            yield mesh, [(n, work.mesh_points(mesh, n, self.mesh_file(mesh, group, name, n))) for n in limits]
        for peer in [*self.peers, *([AVIF_PAYLOAD] if group == "thumbnails" and AVIF in self.peers else [])]:
            yield peer.name, [(n, self.cache.get(work, peer, n, lambda p=peer, n=n: work.peer_points(p, n))) for n in limits]

    def mesh_file(self, mesh, group, name, limit):
        folder = self.o.out / "files" / mesh / group
        folder.mkdir(parents=True, exist_ok=True)
        return folder / f"{name}-{limit}.imgm"

    def draw(self, work, group, name):
        """Pictures at equal bytes, and the original."""
        original = report.drawn_file(self.o.out, group, name)
        original.parent.mkdir(parents=True, exist_ok=True)
        work.image.save(original)
        for codec, by_limit in self.results[group][name].items():
            for limit in report.SHOWN_BYTES:
                point = chosen(by_limit.get(str(limit), []), "psnr")
                if point and codec in MESHES:
                    drawn, _ = work.drawn_mesh(self.mesh_file(codec, group, name, limit))
                elif point:
                    drawn = work.drawn(PEERS[codec], point["quality"], point["scale"], point["filter"])
                else:
                    continue
                drawn.save(report.drawn_file(self.o.out, group, name, limit, codec))

    def empty_bytes(self):
        """{format: (bytes of a grey picture of 16 x 16 pixels, of these its coded data if known)}: what headers take."""
        with tempfile.TemporaryDirectory(prefix="imgmesh-compression-") as folder:
            work = PictureRun(Image.new("RGB", (16, 16), "#808080"), self.o.bin, pathlib.Path(folder))
            sizes = {}
            for peer in self.peers:
                file = peer.encoded(work.original, peer.qualities[0])
                sizes[peer.name] = file.stat().st_size, avif_payload(file) if peer == AVIF else None
            return sizes


def main(arguments):
    o = options(arguments)
    paths = sorted(o.folder.glob("*.png"))
    if not paths:
        sys.exit(f"compression: {o.folder} has no .png images")
    o.out.mkdir(parents=True, exist_ok=True)
    comparison = Comparison(o, {path.stem: Image.open(path).convert("RGB") for path in paths})
    comparison.run()
    figures = {"$schema": SCHEMA, "versions": comparison.cache.versions, "empty_bytes": comparison.empty_bytes(),
               "lossless_bytes": comparison.lossless, "groups": comparison.results}
    (o.out / "compression.json").write_text(json.dumps(figures, indent=1) + "\n", "utf-8")
    report.write(figures, o.bytes, comparison.shown, o.out)
    print((o.out / "compression.md").read_text("utf-8"))


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except (BenchError, OSError, subprocess.SubprocessError) as error:
        sys.exit(f"compression: error: {error}")

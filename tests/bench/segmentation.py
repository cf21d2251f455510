#!/usr/bin/python3
"""imgmesh-segment beside Felzenszwalb-Huttenlocher and SLIC, all measured in one run.

segmentation.py BIN FOLDER [--density 2] [--pictures N] [--only regions|superpixels] [--distance contour|paper]

BIN     folder with imgmesh-build and imgmesh-segment
FOLDER  images X.jpg or X.png, each with the hand-made segmentations X.mat of BSDS500 (not part of this project)

Prints F, covering, PRI and VI at the best parameter for all images, for every other image from the first on, on which
the constants of imgmesh-segment were chosen, for the rest, and for all; then boundary recall and achievable accuracy of
superpixels, and user CPU seconds a picture. Needs python3-skimage, python3-scipy and python3-openimageio.
"""
import argparse
import pathlib
import resource
import subprocess
import tempfile

import numpy as np
import OpenImageIO as oiio
from skimage.segmentation import felzenszwalb, slic

from segmentation_scores import boundary_counts, load_truths, region_scores, summary, superpixel_scores

SEGMENTS = (2, 4, 6, 8, 11, 16, 22, 32, 45, 64, 90, 128, 180)
THRESHOLDS = (1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 10, 14)
SCALES = (50, 100, 150, 200, 300, 400, 600, 800, 1200, 2000, 3000)  # of Felzenszwalb-Huttenlocher
SUPERPIXELS = (300, 600, 1200)


def read(path, kind="uint8"):
    return np.asarray(oiio.ImageInput.open(str(path)).read_image(kind))


def run(*command):
    """User CPU seconds of a command."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


class Ours:
    def __init__(self, binaries, scratch, density):
        self.binaries, self.scratch, self.density = binaries, scratch, density
        self.seconds = []

    def container(self, path):
        out = self.scratch / f"{path.stem}.glb"
        if not out.exists():
            run(self.binaries / "imgmesh-build", path, "-o", out, "--density", self.density, "--threads", 1, "-q")
        return out

    def labels(self, path, option, value, *more):
        out = self.scratch / "labels.exr"
        self.seconds.append(run(self.binaries / "imgmesh-segment", self.container(path), "-o", out, option, value,
                                "--threads", 1, "-q", *more))
        return read(out, "uint")[..., 0]


def region_table(paths, truths, ours, options):
    methods = {"imgmesh-segment --segments N": (SEGMENTS, lambda p, n: ours.labels(p, "--segments", n, *options)),
               "imgmesh-segment --threshold D": (THRESHOLDS, lambda p, d: ours.labels(p, "--threshold", d, *options)),
               "Felzenszwalb-Huttenlocher, scale": (SCALES, lambda p, s: felzenszwalb(read(p), scale=s, sigma=0.8,
                                                                                      min_size=50))}
    for name, (parameters, method) in methods.items():
        maps = {p: [method(p, value) for value in parameters] for p in paths}
        counts = np.array([[boundary_counts(m, truths[p]) for m in maps[p]] for p in paths])
        regions = np.array([[region_scores(m, truths[p]) for m in maps[p]] for p in paths])
        print(name)
        for part, pick in (("every second", slice(0, None, 2)), ("others", slice(1, None, 2)), ("all", slice(None))):
            if len(paths[pick]) == 0:
                continue
            figures = summary(counts[pick], regions[pick])
            print(f"  {part:12}" + "".join(f"  {key} {value:.3f} (at {parameters[at]})"
                                           for key, (value, at) in figures.items()), flush=True)


def superpixel_table(paths, truths, ours):
    """SLIC makes fewer than it is asked for: asked again until it makes as many."""
    print("superpixels: mean number, boundary recall, achievable accuracy")
    for wanted in SUPERPIXELS:
        rows = {"imgmesh-segment": [], "SLIC": []}
        for p in paths:
            labels = ours.labels(p, "--superpixels", wanted)
            rows["imgmesh-segment"].append((labels.max() + 1, *superpixel_scores(labels, truths[p])))
            asked = wanted
            for _ in range(4):
                labels = slic(read(p), n_segments=round(asked), compactness=10, start_label=0)
                asked *= wanted / (labels.max() + 1)
            rows["SLIC"].append((labels.max() + 1, *superpixel_scores(labels, truths[p])))
        for name, values in rows.items():
            number, recall, accuracy = np.mean(values, axis=0)
            print(f"  {name:16} {number:7.1f}  {recall:.4f}  {accuracy:.4f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binaries", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--density", type=float, default=2)
    parser.add_argument("--pictures", type=int)
    parser.add_argument("--only", choices=("regions", "superpixels"))
    parser.add_argument("--distance", default="contour")
    options = parser.parse_args()
    paths = [p for p in options.folder.iterdir() if p.suffix in (".jpg", ".png") and p.with_suffix(".mat").exists()]
    paths = sorted(paths, key=lambda p: (len(p.stem), p.stem))[:options.pictures]
    if not paths:
        parser.error(f"{options.folder}: no picture with a .mat beside it")
    truths = {p: load_truths(p.with_suffix(".mat")) for p in paths}
    with tempfile.TemporaryDirectory(prefix="imgmesh-bench-") as scratch:
        ours = Ours(options.binaries, pathlib.Path(scratch), options.density)
        print(f"{len(paths)} pictures, --density {options.density:g}")
        if options.only != "superpixels":
            region_table(paths, truths, ours, ("--distance", options.distance))
        if options.only != "regions":
            superpixel_table(paths, truths, ours)
        idle = min(run(options.binaries / "imgmesh-segment", "--version") for _ in range(3))
        print(f"imgmesh-segment: {np.mean(ours.seconds):.3f} s of user CPU a run, {idle:.3f} s of them to start")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""imgmesh-segment beside Felzenszwalb-Huttenlocher, SLIC, SEEDS and LSC, all measured in one run.

segmentation.py BIN FOLDER [--density 2] [--pictures N] [--only regions|superpixels] [--distance contour|paper]

BIN     folder with imgmesh-build and imgmesh-segment
FOLDER  images X.jpg or X.png, each with the hand-made segmentations X.mat of BSDS500 (not part of this project)

Prints F, covering, PRI and VI at the best parameter for all images, for every other image from the first on, on which
the constants of imgmesh-segment were chosen, for the rest, and for all; then scores of superpixels, and user CPU seconds a
picture. Needs python3-skimage, python3-scipy and python3-openimageio, and for SEEDS and LSC python3-opencv.
"""
import argparse
import pathlib
import resource
import subprocess
import tempfile

import numpy as np
import OpenImageIO as oiio
from skimage.segmentation import felzenszwalb, slic

try:
    import cv2
except ImportError:
    cv2 = None

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


def nearest_number(method, wanted):
    """The labels of a method nearest to the number wanted: it is asked again until it makes as many."""
    best, asked = None, wanted
    for _ in range(4):
        labels = method(asked)
        number = len(np.unique(labels))
        if best is None or abs(number - wanted) < abs(best[0] - wanted):
            best = number, labels
        if abs(number - wanted) < 0.02 * wanted:
            break
        asked *= wanted / number
    return best[1]


def opencv_superpixels():
    """SEEDS and LSC as OpenCV has them, at the settings of its manual and at those that were best for boundaries."""
    if not hasattr(cv2, "ximgproc"):
        return {}

    def seeds(image, number, prior):
        hsv = cv2.cvtColor(image, cv2.COLOR_RGB2HSV)
        runs = []
        for levels in (3, 4, 5, 6):  # the number of blocks depends on them, in steps
            s = cv2.ximgproc.createSuperpixelSEEDS(image.shape[1], image.shape[0], 3, round(number), levels, prior, 5)
            runs.append((abs(s.getNumberOfSuperpixels() - number), -levels, s))
        best = min(runs, key=lambda r: r[:2])[2]
        best.iterate(hsv, 10)
        return best.getLabels().copy()

    def lsc(image, number, ratio):
        lab = cv2.cvtColor(cv2.GaussianBlur(image, (3, 3), 0), cv2.COLOR_RGB2LAB)
        s = cv2.ximgproc.createSuperpixelLSC(lab, max(2, round(np.sqrt(image[..., 0].size / number))), ratio)
        s.iterate(10)
        s.enforceLabelConnectivity(20)
        return s.getLabels().copy()

    methods = {f"SEEDS, prior {p}": lambda image, n, p=p: seeds(image, n, p) for p in (2, 1)}
    return methods | {f"LSC, ratio {r}": lambda image, n, r=r: lsc(image, n, r) for r in (0.075, 0.03)}


def superpixel_table(paths, truths, ours):
    print("superpixels: mean number, boundary recall, precision, achievable accuracy, circularity; recall and accuracy of "
          "every second picture and of the others")
    others = {f"SLIC, compactness {c}": lambda image, n, c=c: slic(image, n_segments=round(n), compactness=c, start_label=0)
              for c in (10, 20)} | opencv_superpixels()
    for wanted in SUPERPIXELS:
        makers = {"imgmesh-segment": lambda p: ours.labels(p, "--superpixels", wanted),
                  "with --image": lambda p: ours.labels(p, "--superpixels", wanted, "--image", p)}
        for name, method in others.items():
            makers[name] = lambda p, m=method: nearest_number(lambda n: m(np.ascontiguousarray(read(p)), n), wanted)
        for name, make in makers.items():
            rows = []
            for p in paths:
                labels = make(p)
                rows.append((len(np.unique(labels)), *superpixel_scores(labels, truths[p])))
            rows = np.array(rows)
            halves = "".join(f"  {h[:, 1].mean():.4f} {h[:, 3].mean():.4f}" for h in (rows[::2], rows[1::2]) if len(h))
            print(f"  {name:20} {rows[:, 0].mean():7.1f}" + "".join(f"  {v:.4f}" for v in rows[:, 1:].mean(0)) + halves,
                  flush=True)


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

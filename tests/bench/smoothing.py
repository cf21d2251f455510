#!/usr/bin/python3
"""imgmesh-reconstruct --mode smooth beside OpenCV's bilateral and guided filters: what is left of noise, and of edges.

smoothing.py BIN FOLDER [--noise 10,20,40] [--density 1]

BIN     folder with imgmesh-build, imgmesh-reconstruct and imgmesh-compare
FOLDER  clean images, X.png or X.jpg

Adds Gaussian noise to the 8-bit samples of each image, with a seed of its own. Each filter has the parameters that give
the best mean PSNR at that noise over the images of one part: those for every other image from the first on, on which the
constants of libcore/segment/smooth_image.cpp were chosen, and those for the rest. Prints

- PSNR and SSIM against the clean image, as imgmesh-compare has them
- the part of the clean image's gradient that is left where that is among the strongest 3 percent, along its direction
- the width of a blurred edge: pixels from 10 to 90 percent of a step of 90 of 255 around a disc, with the same noise
  and parameters
- user CPU seconds for a picture on one thread, all that the tool does

Needs python3-numpy and python3-openimageio. Without python3-opencv the other filters are left out.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import tempfile
import time

import numpy as np
import OpenImageIO as oiio

try:
    import cv2
except ImportError:
    cv2 = None


def read(path):
    """height x width x 3 of 0 to 255."""
    samples = np.asarray(oiio.ImageInput.open(str(path)).read_image("uint8"))
    return np.repeat(samples[..., :1], 3, axis=2) if samples.shape[2] < 3 else samples[..., :3]


def write(path, samples):
    out = oiio.ImageOutput.create(str(path))
    height, width, channels = samples.shape
    if not out.open(str(path), oiio.ImageSpec(width, height, channels, "uint8")) or not out.write_image(
            np.ascontiguousarray(samples)) or not out.close():
        raise RuntimeError(out.geterror())


def rounded(samples):
    return np.clip(np.rint(samples), 0, 255).astype(np.uint8)


def psnr(a, b):
    return 10 * np.log10(255 ** 2 / np.mean((a.astype(float) - b) ** 2))


def edge_left(image, clean):
    grey = [np.stack(np.gradient(x.astype(float) @ (0.299, 0.587, 0.114))) for x in (image, clean)]
    strength = np.hypot(*grey[1])
    strong = strength > np.quantile(strength, 0.97)
    return (grey[0] * grey[1]).sum(axis=0)[strong].sum() / (strength[strong] ** 2).sum()


def disc(side=256, radius=90):
    """A step of 90 around a disc, and the distance of each pixel's centre from it."""
    y, x = np.mgrid[0:side, 0:side] - (side - 1) / 2
    outside = np.hypot(x, y) - radius
    return rounded(np.repeat(np.where(outside < 0, 170, 80)[..., None], 3, axis=2)), outside


def edge_width(image, outside):
    """Pixels between 10 and 90 percent of the step, of the mean at each distance."""
    near = np.abs(outside) < 8
    at = np.rint(outside[near] * 4).astype(int) + 40
    means = np.bincount(at, image.mean(axis=2)[near], 81) / np.maximum(np.bincount(at, minlength=81), 1)
    places, levels = np.arange(-30, 31) / 4, means[10:71]
    part = (levels - levels[-8:].mean()) / (levels[:8].mean() - levels[-8:].mean())
    return sum(np.clip(part, 0, 1) * (1 - np.clip(part, 0, 1)) > 0.09) * (places[1] - places[0])


class Noisy:
    """An image with noise, and its container."""

    def __init__(self, clean, noise, seed, name, options, scratch):
        self.clean, self.binaries, self.scratch = clean, options.binaries, scratch
        self.image = rounded(clean + np.random.default_rng(seed).normal(0, noise, clean.shape))
        self.path, self.container = scratch / f"{name}.png", scratch / f"{name}.glb"
        write(self.path, self.image)
        self.run("imgmesh-build", self.path, "-o", self.container, "--density", options.density)

    def run(self, tool, *args):
        """What is printed, and user CPU seconds."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        text = subprocess.run([str(self.binaries / tool), *map(str, args), "--threads", "1", "--json"], check=True,
                              stdout=subprocess.PIPE).stdout
        return json.loads(text), resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

    def smooth(self, strength):
        out = self.scratch / "smooth.png"
        _, seconds = self.run("imgmesh-reconstruct", self.container, "-o", out, "--mode", "smooth", "--image", self.path,
                              "--strength", strength)
        return read(out), seconds

    def ssim(self, image):
        write(self.scratch / "a.png", image)
        write(self.scratch / "b.png", self.clean)
        return self.run("imgmesh-compare", self.scratch / "b.png", self.scratch / "a.png")[0]["difference"]["ssim"]


def timed(function):
    before = time.process_time()
    return rounded(function()), time.process_time() - before


def filters(noise):
    """Name, parameters to try, and (noisy image, parameters) -> (result, seconds)."""
    all_of_them = [("none", [()], lambda noisy: (noisy.image, 0.0))]
    if cv2:
        cv2.setNumThreads(1)
        all_of_them.append(("bilateral", [(noise * k, s) for k in (2, 2.5, 3, 4, 5) for s in (2, 3, 4)],
                            lambda noisy, r, s: timed(
                                lambda: cv2.bilateralFilter(noisy.image.astype(np.float32), -1, r, s))))
    if cv2 and hasattr(cv2, "ximgproc"):
        def guided(noisy, radius, epsilon):
            image = noisy.image.astype(np.float32)
            return timed(lambda: cv2.ximgproc.guidedFilter(image, image, radius, epsilon ** 2))
        all_of_them.append(("guided", [(r, noise * k) for r in (1, 2, 3) for k in (1, 1.5, 2, 3)], guided))
    all_of_them.append(("smooth", [(round(noise * k, 2),) for k in (0.65, 0.75, 0.85, 0.95, 1.1)], Noisy.smooth))
    return all_of_them


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("binaries", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--noise", default="10,20,40", help="standard deviations of 255 (default 10,20,40)")
    parser.add_argument("--density", type=float, default=1, help="vertices in percent of the pixels (default 1)")
    options = parser.parse_args()
    paths = sorted(p for p in options.folder.iterdir() if p.suffix in (".png", ".jpg"))
    print(f"{'images':12} {'noise':>5} {'filter':10} {'PSNR':>6} {'SSIM':>6} {'edges':>6} {'width':>6} {'s':>5}  parameters")
    with tempfile.TemporaryDirectory() as folder:
        for part, chosen in (("every second", paths[::2]), ("others", paths[1::2])):
            for noise in map(float, options.noise.split(",")):
                pictures = [Noisy(read(p), noise, i, p.stem, options, pathlib.Path(folder)) for i, p in enumerate(chosen)]
                step, outside = disc()
                round_one = Noisy(step, noise, 99, "disc", options, pathlib.Path(folder))
                for name, grid, function in filters(noise):
                    def mean_psnr(parameters, function=function, pictures=pictures):
                        return np.mean([psnr(function(p, *parameters)[0], p.clean) for p in pictures])
                    best = max(grid, key=mean_psnr)
                    results = [function(p, *best) for p in pictures]
                    figures = np.mean([(psnr(r, p.clean), p.ssim(r), edge_left(r, p.clean), s)
                                       for p, (r, s) in zip(pictures, results)], axis=0)
                    width = edge_width(function(round_one, *best)[0], outside)
                    print(f"{part:12} {noise:5g} {name:10} {figures[0]:6.2f} {figures[1]:6.4f} {figures[2]:6.3f} "
                          f"{width:6.2f} {figures[3]:5.2f}  {' '.join(f'{b:g}' for b in best)}", flush=True)


if __name__ == "__main__":
    main()

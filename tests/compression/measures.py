"""What is measured of a decoded picture, and the mean distance of two rate-distortion curves.

Pictures are arrays of 8-bit sRGB samples, height x width x 3.
"""
import json
import math

import numpy as np

from bench_process import run

LUMA = (0.299, 0.587, 0.114)  # as docs/compare.md has it
EXACT = 100.0                 # PSNR of equal pictures, so that means and JSON have a number [dB]
METRICS = {"psnr": "RGB PSNR", "luma_psnr": "luma PSNR", "ssim": "SSIM", "ciede2000": "CIEDE2000"}


def decibels(difference):
    square = np.mean(np.square(difference))
    return min(EXACT, 10 * math.log10(255 ** 2 / square)) if square else EXACT


def psnr(a, b):
    return decibels(a.astype(float) - b)


def luma_psnr(a, b):
    return decibels((a.astype(float) - b) @ LUMA)


def compared(tools, original, decoded):
    """SSIM of luma and mean CIEDE2000 of two files, by imgmesh-compare in the folder `tools`."""
    difference = json.loads(run([tools / "imgmesh-compare", original, decoded, "--threads", 1, "--json"])[1])["difference"]
    return {"ssim": difference["ssim"], "ciede2000": difference["ciede2000"]["mean"]}


def best(values, metric):
    """The best of the values that there are; None where there is none."""
    return (min if metric == "ciede2000" else max)((v for v in values if v is not None), default=None)


def overlaps(count, cells):
    """cells x count: the part of each of `cells` equal cells in each of `count` unit samples, rows of sum 1."""
    edges = np.linspace(0, count, cells + 1)
    samples = np.arange(count)
    covered = np.minimum(edges[1:, None], samples + 1) - np.maximum(edges[:-1, None], samples)
    return np.maximum(covered, 0) * cells / count


def area_average(pixels, width, height):
    """The picture at a smaller size, each pixel the mean of all that it covers, parts of pixels by their area."""
    rows, columns = overlaps(pixels.shape[0], height), overlaps(pixels.shape[1], width)
    mean = np.einsum("yi,ijc,xj->yxc", rows, pixels.astype(float), columns, optimize=True)
    return np.floor(mean + 0.5).astype(np.uint8)


def rising(curve):
    """The points that are better than all smaller ones: who has the smaller, better file uses that."""
    kept = []
    for size, quality in sorted(curve):
        if not kept or quality > kept[-1][1]:
            kept.append((size, quality))
    return kept


def log_rate_difference(curve, reference):
    """Mean of ln(bytes / bytes of the reference) over the qualities that both reach, or None. Curves are lists of
    (bytes, quality), straight between their points in (quality, ln bytes). This is Bjontegaard's difference (VCEG-M33),
    without the polynomial, which swings where the best size of a picture changes."""
    (sizes, levels), (other_sizes, other_levels) = (np.array(rising(c), float).T for c in (curve, reference))
    low, high = max(levels[0], other_levels[0]), min(levels[-1], other_levels[-1])
    if high <= low:
        return None
    knots = np.unique(np.clip(np.concatenate([levels, other_levels]), low, high))
    difference = np.interp(knots, levels, np.log(sizes)) - np.interp(knots, other_levels, np.log(other_sizes))
    return float(np.trapz(difference, knots) / (high - low))


def bd_rate(pairs):
    """Percent of bytes that the first curve of each pair takes more than the second, as a geometric mean over the pairs
    that reach a common quality; None where no pair does."""
    logs = [d for d in (log_rate_difference(*p) for p in pairs if all(p)) if d is not None]
    return 100 * math.expm1(sum(logs) / len(logs)) if logs else None

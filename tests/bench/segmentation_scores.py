"""Scores of label maps against hand-made segmentations, after Arbelaez et al., "Contour Detection and Hierarchical Image
Segmentation", TPAMI 2011. Boundary pixels pair up one to one within 0.0075 of the diagonal, here nearest pairs first
instead of at least total distance.

Truths are a list of (labels, boundary) arrays of one picture, one pair a person.
"""
import numpy as np
import scipy.io
from scipy.ndimage import distance_transform_edt
from skimage.morphology import thin


def load_truths(path):
    """The people's segmentations in a .mat file of BSDS500."""
    cells = scipy.io.loadmat(path)["groundTruth"].ravel()
    return [(c["Segmentation"][0, 0].astype(np.int64), c["Boundaries"][0, 0] > 0) for c in cells]


def borders(labels, diagonal=True):
    """Pixels whose right, lower or (as asked) lower right neighbour has another label."""
    edge = np.zeros(labels.shape, bool)
    edge[:, :-1] |= labels[:, :-1] != labels[:, 1:]
    edge[:-1] |= labels[:-1] != labels[1:]
    if diagonal:
        edge[:-1, :-1] |= labels[:-1, :-1] != labels[1:, 1:]
    return edge


def pair_up(found, truth):
    """Of the pixels of `found` which have a partner in `truth`, as a mask."""
    height, width = truth.shape
    reach = 0.0075 * np.hypot(height, width)
    r = int(reach)
    steps = [(dy * dy + dx * dx, dy, dx) for dy in range(-r, r + 1) for dx in range(-r, r + 1)]
    free = np.pad(truth, r)
    y, x = np.nonzero(found)
    paired = np.zeros(found.shape, bool)
    for _, dy, dx in sorted(s for s in steps if s[0] <= reach * reach):
        at = y + r + dy, x + r + dx
        hit = free[at]  # distinct places for distinct pixels: nobody's partner is taken twice
        free[at] = False
        paired[y[hit], x[hit]] = True
        y, x = y[~hit], x[~hit]
    return paired


def boundary_counts(labels, truths):
    """(truth pixels found, truth pixels, found pixels that are true for somebody, found pixels)."""
    found = thin(borders(labels))
    paired = [pair_up(found, truth) for _, truth in truths]
    return np.array([sum(p.sum() for p in paired), sum(t.sum() for _, t in truths),
                     np.logical_or.reduce(paired).sum(), found.sum()], float)


def f_measure(counts):
    recall = counts[..., 0] / np.maximum(counts[..., 1], 1)
    precision = counts[..., 2] / np.maximum(counts[..., 3], 1)
    return 2 * recall * precision / np.maximum(recall + precision, 1e-12)


def overlaps(truth, labels):
    """Pixels of each pair of a truth's region (row) and a label (column)."""
    _, rows = np.unique(truth.ravel(), return_inverse=True)
    _, columns = np.unique(labels.ravel(), return_inverse=True)
    shape = rows.max() + 1, columns.max() + 1
    return np.bincount(rows * shape[1] + columns, minlength=shape[0] * shape[1]).reshape(shape).astype(float)


def region_scores(labels, truths):
    """(covering of the truth, probabilistic Rand index, variation of information in bits), means over people."""
    scores = []
    for truth, _ in truths:
        both = overlaps(truth, labels)
        rows, columns, total = both.sum(1), both.sum(0), both.sum()
        covering = ((both / (rows[:, None] + columns - both)).max(1) * rows).sum() / total
        pairs = [(n * (n - 1) / 2).sum() for n in (both, rows, columns, total)]
        rand = 1 - (pairs[1] + pairs[2] - 2 * pairs[0]) / pairs[3]
        entropy = [-(n[n > 0] / total * np.log2(n[n > 0] / total)).sum() for n in (both, rows, columns)]
        scores.append((covering, rand, 2 * entropy[0] - entropy[1] - entropy[2]))
    return np.mean(scores, axis=0)


def circularity(labels):
    """4 pi area / outline^2 of the regions, weighted by area, 1 for discs (Schick et al., "Measuring and Evaluating the
    Compactness of Superpixels", ICPR 2012). Outlines are measured by Crofton's formula in four directions, so that slanted
    lines are not too long."""
    padded = np.pad(labels.astype(np.int64) + 1, 1)
    count = padded.max() + 1
    outline = np.zeros(count)
    for a, b, weight in ((padded[:, 1:], padded[:, :-1], 1), (padded[1:], padded[:-1], 1),
                         (padded[1:, 1:], padded[:-1, :-1], np.sqrt(0.5)), (padded[1:, :-1], padded[:-1, 1:], np.sqrt(0.5))):
        crossed = a != b
        outline += np.pi / 8 * weight * (np.bincount(a[crossed], minlength=count) + np.bincount(b[crossed], minlength=count))
    area = np.bincount(padded.ravel(), minlength=count)[1:].astype(float)
    area, outline = area[area > 0], outline[1:][area > 0]
    return (area * np.minimum(1, 4 * np.pi * area / outline ** 2)).sum() / area.sum()


def superpixel_scores(labels, truths):
    """(boundary recall and precision within 2 pixels along each axis, achievable segmentation accuracy, circularity); the
    first three are means over people."""
    reach = 2 * np.sqrt(2)
    found = borders(labels, diagonal=False)
    distance = distance_transform_edt(~found)
    marked = [(truth, edge) for truth, edge in truths if edge.any()]
    recall = [(distance[edge] <= reach).mean() for _, edge in marked]
    precision = [(distance_transform_edt(~edge)[found] <= reach).mean() for _, edge in marked] if found.any() else [0]
    accuracy = [overlaps(truth, labels).max(0).sum() / labels.size for truth, _ in truths]
    return np.array([np.mean(recall), np.mean(precision), np.mean(accuracy), circularity(labels)])


def summary(counts, regions):
    """Figures over images (first axis) and parameters (second): each at its best parameter for all (ODS)."""
    mean = regions.mean(0)
    f = f_measure(counts.sum(0))
    return {"F": (f.max(), f.argmax()), "covering": (mean[:, 0].max(), mean[:, 0].argmax()),
            "PRI": (mean[:, 1].max(), mean[:, 1].argmax()), "VI": (mean[:, 2].min(), mean[:, 2].argmin())}

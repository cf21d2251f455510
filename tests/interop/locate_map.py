"""Faces and weights of pixels from their positions on a grid, without any code of imgmesh: docs/format.md, "Positions on
a grid"."""
import numpy as np

NO_FACE = 0xFFFFFFFF
UNITS = 32  # in a pixel


def side_areas(corners, points):
    """Twice the areas of each point with the side opposite each of the three corners: (3, N)."""
    def area(p, q, r):
        return (q[1] - p[1]) * (r[0] - p[0]) - (q[0] - p[0]) * (r[1] - p[1])

    a, b, c = corners
    return np.stack([area(b, c, points.T), area(c, a, points.T), area(a, b, points.T)])


def weights(corners, sides, n):
    """The weights of the three corners in steps of 1 / n, by largest remainders: (3, N)."""
    area = int(sides[:, 0].sum())
    shares = sides.astype(object if area * n >= 2**63 else np.int64) * n
    whole, rest = shares // area, shares % area
    left = n - whole.sum(axis=0)
    first = np.lexsort((corners[:, 0], corners[:, 1]))  # of equal remainders: lower y, then lower x
    order = first[np.argsort(-rest[first], axis=0, kind="stable")]
    for k in range(2):
        whole[order[k], np.arange(len(left))] += (left > k).astype(np.int64)
    return whole.astype(np.int64)


def locate(faces, positions, points, n):
    """The face (N) and the weights of its second and third corners (N) of points (N, 2).

    faces (F, 3), positions (V, 2) in pixels with y down, points as integers in 1/32 pixel; n is 2048 for weights in
    HALF, 2^24 in FLOAT. NO_FACE where there is none.
    """
    vertices = np.rint(np.asarray(positions, float) * UNITS).astype(np.int64)
    points = np.asarray(points, np.int64)
    face = np.full(len(points), NO_FACE, np.uint32)
    least = np.full(len(points), np.iinfo(np.int64).max)
    u, v = np.zeros(len(points)), np.zeros(len(points))
    by_y = np.argsort(points[:, 1], kind="stable")
    sorted_y = points[by_y, 1]
    for f, corners in enumerate(vertices[np.asarray(faces)]):
        if side_areas(corners, corners[:1])[0, 0] <= 0:
            continue
        (left, top), (right, bottom) = corners.min(axis=0), corners.max(axis=0)
        near = by_y[np.searchsorted(sorted_y, top, "left") : np.searchsorted(sorted_y, bottom, "right")]
        near = near[(points[near, 0] >= left) & (points[near, 0] <= right)]
        sides = side_areas(corners, points[near])
        place = int(corners[:, 1].sum()) * 2**32 + int(corners[:, 0].sum())  # y before x
        held = (sides >= 0).all(axis=0) & (place < least[near])
        near, sides = near[held], sides[:, held]
        if not near.size:
            continue
        least[near] = place
        face[near] = f
        _, u[near], v[near] = weights(corners, sides, n) / n
    return face, u, v


def pixel_map(faces, positions, dx, dy, steps, inside, n):
    """face.id (H, W), bary.u and bary.v (H, W) from displacements (H, W) in steps of 1 / steps pixel."""
    height, width = dx.shape
    y, x = np.mgrid[:height, :width].astype(np.int64)
    scale = UNITS // steps
    points = np.stack([x * UNITS + dx.astype(np.int64) * scale, y * UNITS + dy.astype(np.int64) * scale], axis=-1)
    face = np.full(dx.shape, NO_FACE, np.uint32)
    u, v = np.zeros(dx.shape), np.zeros(dx.shape)
    face[inside], u[inside], v[inside] = locate(faces, positions, points[inside], n)
    if (face[inside] == NO_FACE).any():
        raise ValueError("a pixel lies on no face")
    return face, u, v

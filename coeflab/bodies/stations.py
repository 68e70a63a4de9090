"""Where to cut a mesh along x: stations between the places where its sections jump; arrays in, arrays out."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from coeflab.bodies.mesh.integrals import corner_range
from coeflab.core.types import Array, Faces

MOST_STATIONS, FLAT_SHARE = 40, 0.002
BINS, STEP = 256, 0.1
FEWEST_STATIONS, CLOSE = 4, 1e-4


def joints(vertices: Array, faces: Faces) -> Array:
    """Where the sections of a mesh may jump, rising, with both ends of the mesh, m.

    Flat faces across x that make up 0.2 % of the frontal box or more, and places where the breadth or the depth changes
    by a tenth within 1/256 of the length, as at the edges of a mast.
    """
    ends = np.array([vertices[:, 0].min(), vertices[:, 0].max()])
    found = np.sort(np.r_[_flat_faces(vertices, faces, ends), _steps(vertices, faces, ends)])
    margin = CLOSE * (ends[1] - ends[0])
    found = found[(found > ends[0] + margin) & (found < ends[1] - margin)]
    found = found[np.diff(found, prepend=-np.inf) > margin]
    return np.asarray(np.r_[ends[0], found, ends[1]])


def stations(places: Array, count: int) -> tuple[Array, Array]:
    """Gauss-Legendre stations between joints, four or more in each piece and about ``count`` in all without these.

    Returns
    -------
    x, weight : (n,) arrays
        m.
    """
    found, weights = [], []
    for low, high in pairwise(places):
        own = max(FEWEST_STATIONS, 2 * round(count * (high - low) / (places[-1] - places[0]) / 2.0))
        node, weight = np.polynomial.legendre.leggauss(own)
        found.append(low + (high - low) * (node + 1.0) / 2.0)
        weights.append((high - low) * weight / 2.0)
    return np.concatenate(found), np.concatenate(weights)


def _flat_faces(vertices: Array, faces: Faces, ends: Array) -> Array:
    """Places of the largest flat faces across x, m."""
    length = ends[1] - ends[0]
    fore, aft = corner_range(vertices[:, 0][faces])
    upright = faces[aft - fore <= 1e-6 * length]
    a, b, c = (vertices[corner] for corner in upright.T)
    e, f = b - a, c - a
    area = np.abs(e[:, 1] * f[:, 2] - e[:, 2] * f[:, 1]) / 2.0
    step = np.round((a[:, 0] - ends[0]) / (1e-5 * length)).astype(np.int64)
    found, own = np.unique(step, return_inverse=True)
    total = np.bincount(own, area, len(found))
    place = np.bincount(own, area * a[:, 0], len(found)) / np.maximum(total, np.finfo(float).tiny)
    large = np.flatnonzero(total > FLAT_SHARE * np.ptp(vertices[:, 1]) * np.ptp(vertices[:, 2]))
    return np.asarray(place[large[np.argsort(-total[large], kind="stable")[:MOST_STATIONS]]])


def _steps(vertices: Array, faces: Faces, ends: Array) -> Array:
    """Places where the outline seen from the side or from above jumps, m: the outermost vertices of the step."""
    bins = np.minimum((BINS * (vertices[:, 0] - ends[0]) / (ends[1] - ends[0])).astype(np.int64), BINS - 1)
    low, high = corner_range(bins[faces])
    covered = high - low + 1
    face = np.repeat(np.arange(len(faces)), covered)
    bin_of = np.arange(len(face)) - np.repeat(np.cumsum(covered) - covered - low, covered)
    found: list[tuple[float, float]] = []
    for axis in (1, 2):
        size = float(np.ptp(vertices[:, axis]))
        for sign in (1.0, -1.0):
            value = sign * vertices[:, axis]
            outline = np.full(BINS, value.min())
            np.maximum.at(outline, bin_of, corner_range(value[faces])[1][face])
            change = np.diff(outline)
            for k in np.flatnonzero(np.abs(change) > STEP * size):
                high_bin, edge = (k + 1, np.min) if change[k] > 0.0 else (k, np.max)
                out = (bins == high_bin) & (value > (outline[k] + outline[k + 1]) / 2.0)
                if out.any():
                    found.append((-abs(change[k]) / size, float(edge(vertices[out, 0]))))
    return np.array([place for _, place in sorted(found)[:MOST_STATIONS]])

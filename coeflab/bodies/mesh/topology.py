"""What joins the faces of a mesh, and what keeps them from enclosing a body; arrays in, arrays out.

Vertices are (n, 3); faces are (m, 3) indices, counter-clockwise seen from outside.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from coeflab.bodies.mesh.integrals import BLOCK, corner_range
from coeflab.core.types import Array, Faces

Mask = NDArray[np.bool_]
Labels = NDArray[np.int64]
FLAT = 1e-10
_ODD = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], dtype=np.uint64)


@dataclass(frozen=True, slots=True)
class Edges:
    """Edges that are no border between exactly two faces that run opposite ways along it.

    Attributes
    ----------
    open : int
        With one face only.
    crowded : int
        With more than two faces, not as many one way as the other.
    turned : int
        With two faces that both run the same way: one of them is turned over.
    shared : int
        With four or more faces, as many one way as the other: solids that meet in an edge, and nothing that spoils a surface.
    """

    open: int
    crowded: int
    turned: int
    shared: int = 0

    @property
    def sound(self) -> bool:
        """Watertight and consistently wound."""
        return not (self.open or self.crowded or self.turned)


def _mixed(columns: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """A hash of each row of (n, 3)."""
    h = columns[:, 0] * _ODD[0]
    for k in (1, 2):
        h = (h ^ (h >> np.uint64(29))) + columns[:, k]
        h *= _ODD[k]
    return np.asarray(h ^ (h >> np.uint64(32)))


def welded(vertices: Array, faces: Faces, within: float = 0.0) -> tuple[Array, Faces]:
    """Join vertices at one place; unused ones go.

    Parameters
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array of int
    within : float
        Zero joins equal coordinates only; otherwise vertices closer than this are joined, each cluster to its first.
    """
    if within > 0.0:
        vertices = _gathered(vertices, within)
    bits = np.ascontiguousarray(vertices + 0.0).view(np.uint64)
    key = _mixed(bits)
    order = np.argsort(key)
    last = np.r_[key[order][1:] != key[order][:-1], True]
    group = np.empty(len(key), dtype=np.int64)
    group[order] = np.cumsum(np.r_[0, last[:-1]])
    first = np.full(int(last.sum()), len(key), dtype=np.int64)
    np.minimum.at(first, group, np.arange(len(key)))
    if not np.array_equal(vertices[first][group], vertices):
        first, group = np.unique(bits, axis=0, return_index=True, return_inverse=True)[1:]
        group = group.reshape(-1)
    corners = first[group][faces]
    used = np.zeros(len(key), dtype=bool)
    used[corners] = True
    number = np.cumsum(used) - 1
    return np.asarray(vertices[used]), np.asarray(number[corners])


def _gathered(vertices: Array, within: float) -> Array:
    """Every vertex at the place of the first one of its cluster."""
    from scipy.spatial import cKDTree

    near = cKDTree(vertices).query_pairs(within, output_type="ndarray")
    graph = coo_array((np.ones(len(near)), (near[:, 0], near[:, 1])), shape=(len(vertices), len(vertices)))
    count, label = connected_components(graph, directed=False)
    first = np.full(count, len(vertices), dtype=np.int64)
    np.minimum.at(first, label, np.arange(len(vertices)))
    return np.asarray(vertices[first[label]])


def joined(vertices: Array, faces: Faces, share: float) -> tuple[Array, Faces]:
    """Vertices within a share of the size joined, and the faces that are left with three corners."""
    vertices, faces = welded(vertices, faces, share * float(np.ptp(vertices, axis=0).max()))
    point = np.any([faces[:, a] == faces[:, b] for a, b in pairwise((0, 1, 2, 0))], axis=0)
    return vertices, faces[~point]


def degenerate(vertices: Array, faces: Faces) -> Mask:
    """Faces without an area: two corners at one place, or all on a line (height below 1e-10 of the longest side)."""
    out = np.empty(len(faces), dtype=bool)
    for start in range(0, len(faces), BLOCK):
        a, b, c = (vertices[corner] for corner in faces[start : start + BLOCK].T)
        e, f = b - a, c - a
        longest = np.maximum(np.einsum("ij,ij->i", e, e), np.einsum("ij,ij->i", f, f))
        x, y, z = (e[:, i] * f[:, j] - e[:, j] * f[:, i] for i, j in ((1, 2), (2, 0), (0, 1)))
        out[start : start + BLOCK] = x * x + y * y + z * z <= (FLAT * longest) ** 2
    return out


def repeated(faces: Faces) -> Mask:
    """Faces whose three corners an earlier face has too, whichever way round."""
    low, high = corner_range(faces)
    rows = np.column_stack([low, faces[:, 0] + faces[:, 1] + faces[:, 2] - low - high, high])
    key = _mixed(rows.astype(np.uint64))
    out = np.zeros(len(faces), dtype=bool)
    ordered = np.sort(key)
    if not np.any(ordered[1:] == ordered[:-1]):
        return out
    _, first = np.unique(rows, axis=0, return_index=True)
    out[:] = True
    out[first] = False
    return out


def _directed(faces: Faces) -> tuple[Labels, Labels]:
    """Start and end of every side of every face, side by side: (3 m,) each."""
    return faces[:, [0, 1, 2]].ravel(), faces[:, [1, 2, 0]].ravel()


def edges(faces: Faces) -> Edges:
    """Count the edges that spoil a closed, consistently wound surface."""
    start, end = _directed(faces)
    count = int(faces.max()) + 1
    key = np.sort(((np.minimum(start, end) * count + np.maximum(start, end)) << 1) | (start > end))
    if len(key) % 2 == 0:
        up, down = key[0::2], key[1::2]
        if np.all(up & 1 == 0) and np.all(down == up + 1) and np.all(up[1:] != up[:-1]):
            return Edges(0, 0, 0)
    inverse = np.unique(key >> 1, return_inverse=True)[1]
    uses = np.bincount(inverse)
    backward = np.bincount(inverse, weights=key & 1)
    balanced = uses == 2 * backward
    return Edges(
        int((uses == 1).sum()),
        int(((uses > 2) & ~balanced).sum()),
        int(((uses == 2) & ~balanced).sum()),
        int(((uses > 2) & balanced).sum()),
    )


@dataclass(frozen=True, slots=True)
class Rims:
    """The rims of the holes of a surface wound alike.

    Attributes
    ----------
    rings : list of (k,) arrays of int
        The vertices of closed loops, as faces that fill them run.
    touching : int
        Edges of rims that touch in a vertex: which way they go on there is anyone's guess.
    loose : int
        Edges of rims that do not close, as where faces are turned over.
    """

    rings: list[NDArray[np.int64]]
    touching: int
    loose: int


def rims(faces: Faces) -> Rims:
    """The rims of the holes of a surface wound alike, with what of its border is no simple rim."""
    start, end = _directed(faces)
    count = int(faces.max()) + 1
    lone = ~np.isin(start * count + end, end * count + start)
    start, end = start[lone], end[lone]
    graph = coo_array((np.ones(len(start), dtype=np.int8), (start, end)), shape=(count, count))
    number, label = connected_components(graph, directed=False)
    out, into = np.bincount(start, minlength=count), np.bincount(end, minlength=count)
    own = label[start]
    unclosed, branched = np.zeros((2, number), dtype=bool)
    unclosed[label[out != into]] = True
    branched[label[out > 1]] = True
    unclosed |= np.bincount(own, minlength=number) < 3
    simple = ~(unclosed | branched)[own]
    after = dict(zip(end[simple].tolist(), start[simple].tolist(), strict=True))
    rings = []
    while after:
        first, vertex = after.popitem()
        ring = [first]
        while vertex != first:
            ring.append(vertex)
            vertex = after.pop(vertex)
        rings.append(np.array(ring))
    return Rims(rings, int((branched & ~unclosed)[own].sum()), int(unclosed[own].sum()))


@dataclass(frozen=True, slots=True, eq=False)
class Filled:
    """A surface whose small holes are closed.

    Attributes
    ----------
    vertices : (n, 3) array
    faces : (m, 3) array of int
    number : int
        Of the holes that were closed.
    large : list of float
        Shares of the surface of those that were not, the largest first.
    rims : Rims
        Of the surface before.
    """

    vertices: Array
    faces: Faces
    number: int
    large: list[float]
    rims: Rims


def filled(vertices: Array, faces: Faces, share: float) -> Filled:
    """Holes of up to a share of the surface closed by triangles about the middle of their rims."""
    corner = vertices[faces]
    whole = (
        float(np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1).sum()) / 2.0
    )
    found = rims(faces)
    points, more, large = [vertices], [faces], list[float]()
    for ring in found.rings:
        rim = vertices[ring]
        spokes, next_ones = rim - rim.mean(axis=0), np.roll(rim, -1, axis=0) - rim.mean(axis=0)
        size = float(np.linalg.norm(np.cross(spokes, next_ones), axis=1).sum()) / 2.0
        if size > share * whole:
            large.append(size / whole)
            continue
        if len(ring) == 3:
            more.append(ring[None])
            continue
        middle = sum(len(p) for p in points)
        points.append(rim.mean(axis=0)[None])
        more.append(np.column_stack([ring, np.roll(ring, -1), np.full(len(ring), middle)]))
    number = len(found.rings) - len(large)
    return Filled(np.concatenate(points), np.concatenate(more), number, sorted(large, reverse=True), found)


def sheets(faces: Faces) -> Mask:
    """Which faces are sheets: with an open edge, or with one once such faces are gone."""
    out = np.zeros(len(faces), dtype=bool)
    left = np.arange(len(faces))
    while len(left):
        start, end = _directed(faces[left])
        count = int(faces.max()) + 1
        _, inverse, uses = np.unique(
            np.minimum(start, end) * count + np.maximum(start, end), return_inverse=True, return_counts=True
        )
        loose = np.any(uses[inverse].reshape(-1, 3) == 1, axis=1)
        if not np.any(loose):
            break
        out[left[loose]] = True
        left = left[~loose]
    return out


def shells(faces: Faces) -> tuple[int, Labels]:
    """How many connected shells there are, and the shell of each face; faces connect through common vertices."""
    ends = np.concatenate([faces[:, 1], faces[:, 2]])
    starts = np.concatenate([faces[:, 0], faces[:, 0]])
    count = int(faces.max()) + 1
    graph = coo_array((np.ones(len(ends), dtype=np.int8), (starts, ends)), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    found, own = np.unique(label[faces[:, 0]], return_inverse=True)
    return len(found), own


def shell_volumes(vertices: Array, faces: Faces, shell: Labels) -> tuple[Array, Array]:
    """Signed volume and area of each shell: (k,) arrays; a volume below zero is of a shell that looks inward."""
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0
    volume, area = (np.zeros(int(shell.max()) + 1) for _ in range(2))
    for start in range(0, len(faces), BLOCK):
        own = shell[start : start + BLOCK]
        a, b, c = (vertices[corner] - middle for corner in faces[start : start + BLOCK].T)
        normal = np.cross(b - a, c - a)
        volume += np.bincount(own, np.einsum("ij,ij->i", a, normal) / 6.0, len(volume))
        area += np.bincount(own, np.sqrt(np.einsum("ij,ij->i", normal, normal)) / 2.0, len(area))
    return volume, area


def oriented(faces: Faces) -> Faces | None:
    """The faces turned so that neighbours run opposite ways along their edge; None where no turning can do that.

    Each face stands for two nodes, as it is and turned over; an edge links the nodes that agree. A face linked to its
    own turned self lies on a one-sided surface. Per shell, the way of its first face is kept.
    """
    start, end = _directed(faces)
    count = int(faces.max()) + 1
    edge = np.minimum(start, end) * count + np.maximum(start, end)
    order = np.argsort(edge, kind="stable")
    pair = np.flatnonzero(edge[order][1:] == edge[order][:-1])
    one, two = order[pair], order[pair + 1]
    opposite = (start[one] < end[one]) != (start[two] < end[two])
    m = len(faces)
    f, g = one // 3, two // 3
    partner = np.where(opposite, g, g + m)
    links = np.concatenate([f, f + m]), np.concatenate([partner, (partner + m) % (2 * m)])
    graph = coo_array((np.ones(2 * len(f), dtype=np.int8), links), shape=(2 * m, 2 * m))
    _, label = connected_components(graph, directed=False)
    if np.any(label[:m] == label[m:]):
        return None
    twin = np.minimum(label[:m], label[m:])
    lead = np.full(label.max() + 1, m, dtype=np.int64)
    np.minimum.at(lead, twin, np.arange(m))
    selected = label[:m] == label[lead[twin]]
    return np.where(selected[:, None], faces, faces[:, ::-1])

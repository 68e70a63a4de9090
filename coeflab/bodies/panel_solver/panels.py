"""Flat triangular panels on a closed surface, and what makes a surface unfit for them; arrays in, arrays out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, Faces, brief

SLIVER = 1e-10
NEEDLE, GIANT = 2.0, 3.0
SHARP = np.sqrt(0.5)


@brief
@dataclass(frozen=True, slots=True)
class Panels:
    """Triangles and what the influence integrals need of them.

    Attributes
    ----------
    corners : (n, 3, 3) array
        Panel, corner, component; m; counter-clockwise seen from the fluid.
    centre, normal : (n, 3) arrays
        Centroid, m, and unit normal into the fluid.
    area, size : (n,) arrays
        m^2, and the distance from the centroid to the farthest corner, m.
    spread : (2, n, 3) array
        Two vectors in the panel, m, whose dyads sum to its second moments about the centroid over its area, m^2.
    """

    corners: Array
    centre: Array
    normal: Array
    area: Array
    size: Array
    spread: Array

    @property
    def count(self) -> int:
        """How many."""
        return len(self.area)


def panels_of(corners: Array) -> Panels:
    """Panels from their corners, (n, 3, 3), m."""
    centre = corners.mean(axis=1)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    twice = np.linalg.norm(normal, axis=1)
    size = np.linalg.norm(corners - centre[:, None], axis=2).max(axis=1)
    spread = np.stack([(corners[:, 0] - centre) / np.sqrt(8.0), (corners[:, 1] - corners[:, 2]) / np.sqrt(24.0)])
    return Panels(corners, centre, normal / twice[:, None], twice / 2.0, size, spread)


def unmatched_edges(faces: Faces) -> int:
    """How many edges are not run through as often one way as the other; 0 for a closed, consistently wound surface."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    low, high = np.minimum(start, end), np.maximum(start, end)
    _, place = np.unique(low * (int(faces.max()) + 1) + high, return_inverse=True)
    return int(np.count_nonzero(np.bincount(place.reshape(-1), weights=np.sign(end - start))))


def slivers(corners: Array) -> NDArray[np.bool_]:
    """Which triangles have no area: below 1e-10 of the square of their longest side, (n,)."""
    sides = np.roll(corners, -1, axis=1) - corners
    longest = np.sum(sides**2, axis=2).max(axis=1)
    twice = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    return np.asarray(twice <= SLIVER * longest)


def slenderness(second_moments: Array) -> float:
    """Smallest over middle side of the box of those second moments of volume, (3, 3); 1 for a body of revolution."""
    spread = np.sqrt(np.clip(np.linalg.eigvalsh(second_moments), 0.0, None))
    return float(spread[0] / spread[1])


def side_of(area: float, count: int) -> float:
    """Side of an equilateral triangle of which ``count`` have that area together."""
    return float(np.sqrt(4.0 / np.sqrt(3.0) * area / count))


def unfit_share(corners: Array) -> float:
    """Share of the area in needles and giants: with a side over twice that of an equilateral triangle of the same area, or
    over three times that of as many equilateral ones as there are.
    """
    longest = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2.0
    whole = float(area.sum())
    giant = longest > GIANT * side_of(whole, len(corners))
    return float(area[giant | (longest**2 > NEEDLE**2 * 4.0 / np.sqrt(3.0) * area)].sum() / whole)


def _sharp_edges(vertices: Array, faces: Faces) -> tuple[Faces, Faces, NDArray[np.bool_], Faces]:
    """Half-edges of the edges of two faces, whether the surface turns there by more than 45 degrees, and those of one face."""
    corner = vertices[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    unit = normal / np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)[:, None]
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    key = np.minimum(start, end) * np.int64(len(vertices)) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    _, first, members = np.unique(key[order], return_index=True, return_counts=True)
    one, other = order[first[members == 2]], order[first[members == 2] + 1]
    turned = np.einsum("ij,ij->i", unit[one // 3], unit[other // 3]) < SHARP
    return one, other, turned, order[first[members == 1]]


def sharpness(vertices: Array, faces: Faces) -> float:
    """Length of the edges at which the surface turns by more than 45 degrees, over the root of its area.

    4.9 for a cube, 1.4 for a flat-ended cylinder six diameters long, 0 for a smooth body. Edges of more or fewer than two
    faces are left out.
    """
    one, _, turned, _ = _sharp_edges(vertices, faces)
    corner = vertices[faces]
    twice = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    length = np.linalg.norm(vertices[start[one]] - vertices[end[one]], axis=1)
    return float(length[turned].sum() / np.sqrt(twice.sum() / 2.0))


def thickness(panels: Panels) -> Array:
    """How thick the body is at each panel, (n,), m; infinite where that is more than the panel is large.

    There a panel looks away from another within its own size behind it; the potential jumps from one to the other and
    constant panels cannot follow.
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(panels.centre)
    reach = panels.size
    behind = panels.centre - 0.5 * reach[:, None] * panels.normal
    near = tree.query_ball_point(behind, reach)
    panel = np.repeat(np.arange(panels.count), [len(n) for n in near])
    other = np.concatenate(near).astype(np.int64)
    opposed = np.einsum("ij,ij->i", panels.normal[panel], panels.normal[other]) < -0.5
    depth = np.einsum("ij,ij->i", panels.centre[panel] - panels.centre[other], panels.normal[panel])
    thin = opposed & (depth > 0.0) & (depth < reach[panel])
    out = np.full(panels.count, np.inf)
    np.minimum.at(out, panel[thin], depth[thin])
    return out


def thin_share(panels: Panels) -> float:
    """Share of the area where the body is thinner than the panel on it is large."""
    return float(panels.area[np.isfinite(thickness(panels))].sum() / panels.area.sum())


def split_in_four(corners: Array) -> Array:
    """Each triangle as four similar ones, (4 n, 3, 3)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, bc, ca = (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0
    return np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])


def bisected(corners: Array, count: int) -> Array:
    """At least ``count`` triangles on the same facets: the longest sides are halved first.

    Neighbours need not share vertices; constant panels do not ask for it.
    """
    while len(corners) < count:
        longest = _longest(corners)
        need = min(count - len(corners), len(corners))
        corners = halved(corners, longest >= max(np.sort(longest)[-need], 0.6 * longest.max()))
    return corners


def _longest(corners: Array) -> Array:
    return np.asarray(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1))


def halved(corners: Array, chosen: NDArray[np.bool_]) -> Array:
    """Chosen triangles cut through the middle of their longest sides, behind the others."""
    selected, cut = corners[~chosen], corners[chosen]
    first = np.linalg.norm(np.roll(cut, -1, axis=1) - cut, axis=2).argmax(axis=1)
    rows = np.arange(len(cut))
    a, b, c = (cut[rows, (first + k) % 3] for k in range(3))
    middle = (a + b) / 2.0
    return np.concatenate([selected, np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


FINEST, WIDENING = 0.25, 0.5


def graded(corners: Array, count: int, lines: Array | None = None, thin: bool = True) -> Array:
    """At most about ``count`` triangles on the same facets, smaller where the body is thin and along lines.

    The size that is wanted at a panel is the thickness of the body there, and near a line a quarter of the general size
    plus half the distance. Panels furthest above their wanted size are halved first.

    Parameters
    ----------
    corners : (n, 3, 3) array
    count : int
    lines : (k, 3) array, optional
        Points along sharp edges, rims or a wall's nearest line, m.
    thin : bool
        Look for thin parts; of sheets, which have no thickness, there are none.
    """
    from scipy.spatial import cKDTree

    tree = None if lines is None or not len(lines) else cKDTree(lines)
    general = side_of(float(panels_of(corners).area.sum()), count)
    while len(corners) < count:
        panels = panels_of(corners)
        wanted = np.full(panels.count, 2.0 * general)
        if tree is not None:
            wanted = np.minimum(wanted, FINEST * general + WIDENING * tree.query(panels.centre)[0])
        if thin:
            wanted = np.minimum(wanted, np.maximum(thickness(panels), FINEST * general))
        above = _longest(corners) / wanted
        room = min(count - len(corners), panels.count)
        corners = halved(corners, above >= max(np.sort(above)[-room], 0.7 * above.max()))
    return corners


def sharp_points(vertices: Array, faces: Faces, step: float) -> Array:
    """Points along the edges at which a surface turns by more than 45 degrees, or ends, (k, 3), at most ``step`` apart, m."""
    one, _, turned, rim = _sharp_edges(vertices, faces)
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    edge = np.concatenate([one[turned], rim])
    a, b = vertices[start[edge]], vertices[end[edge]]
    number = np.maximum(np.ceil(np.linalg.norm(b - a, axis=1) / step).astype(int), 1)
    which = np.repeat(np.arange(len(a)), number + 1)
    share = (np.arange(len(which)) - np.repeat(np.cumsum(number + 1) - number - 1, number + 1)) / number[which]
    return np.asarray(a[which] + share[:, None] * (b - a)[which])

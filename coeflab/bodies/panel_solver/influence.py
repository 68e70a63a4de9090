"""Influence of flat triangular panels on each other: solid angles and integrals of 1 / r, in plain numpy.

Near panels are integrated exactly: Van Oosterom & Strackee (1983), IEEE Trans. Biomed. Eng. 30, for the solid angle;
Wilton et al. (1984), IEEE Trans. Antennas Propag. 32, for 1 / r. Beyond `REACH` times a panel's size its area and second
moments about the centroid serve; the added mass of a 6:1 spheroid then changes by 3e-6 at 2,000 panels.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from queue import SimpleQueue

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.panel_solver.panels import Panels
from coeflab.core.types import Array, brief

REACH = 5.0
BLOCK = 2**18
NEAR_BLOCK = 2**15


def exact_integrals(targets: Array, corners: Array, normals: Array) -> tuple[Array, Array]:
    """Solid angle and integral of 1 / r of triangle k seen from target k.

    Parameters
    ----------
    targets, normals : (n, 3) arrays
    corners : (n, 3, 3) array

    Returns
    -------
    angle : (n,) array
        Integral of (y - x) . n / r^3: positive where the panel is seen from behind, from inside the body; 0 in its
        plane.
    inverse : (n,) array
        Integral of 1 / r, m.
    """
    # By components: long arrays are several times as quick as short last axes.
    x, y, z = targets.T
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = np.ascontiguousarray(corners.transpose(1, 2, 0)) - np.stack([x, y, z])
    nx, ny, nz = np.ascontiguousarray(normals.T)
    ra, rb, rc = (np.sqrt(u * u + v * v + w * w) for u, v, w in ((ax, ay, az), (bx, by, bz), (cx, cy, cz)))
    height = ax * nx + ay * ny + az * nz
    triple = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    below = ra * rb * rc + (ax * bx + ay * by + az * bz) * rc
    below += (bx * cx + by * cy + bz * cz) * ra + (cx * ax + cy * ay + cz * az) * rb
    flat = np.abs(height) <= 1e-12 * np.maximum(np.maximum(ra, rb), rc)
    angle = np.where(flat, 0.0, 2.0 * np.arctan2(triple, below))
    inverse = -height * angle
    for px, py, pz, rp, qx, qy, qz, rq in (
        (ax, ay, az, ra, bx, by, bz, rb),
        (bx, by, bz, rb, cx, cy, cz, rc),
        (cx, cy, cz, rc, ax, ay, az, ra),
    ):
        sx, sy, sz = qx - px, qy - py, qz - pz
        length = np.sqrt(sx * sx + sy * sy + sz * sz)
        outward = px * (sy * nz - sz * ny) + py * (sz * nx - sx * nz) + pz * (sx * ny - sy * nx)
        # In line with a side, beyond or on it, its share vanishes but the logarithm does not exist.
        gap = np.maximum(rp + rq - length, 1e-14 * length)
        inverse += outward / length * np.log((rp + rq + length) / gap)
    return angle, inverse


Seen = tuple[Array, float]


def influence(panels: Panels, images: Sequence[Seen] = ()) -> tuple[NDArray[np.float32], list[Array]]:
    """Solid angle of every panel from every centroid, and the single-layer potential of the normals.

    An image behind a wall is the panel itself, seen from the target's mirror point: distances and heights over planes do
    not change when both sides are mirrored.

    Parameters
    ----------
    panels : Panels
        About their middle and of unit size: squares of distances are taken from products of coordinates.
    images : sequence of ((n, 3) array, float)
        Mirror points of the centroids behind each wall, and the factor of what is seen from there.

    Returns
    -------
    angles : (n, n) array
        Row: target; without the panel itself on the diagonal. Worked out in double precision, kept in single.
    layers : list of (n, 3) arrays
        Integral of n / r over the surface: from each centroid, and from each of the images without its factor.
    """
    count = panels.count
    seen: list[Seen] = [(panels.centre, 1.0), *images]
    angles, layers = np.empty((count, count), dtype=np.float32), [np.empty((count, 3)) for _ in seen]
    far = _Far.of(panels)
    reach = (REACH * panels.size) ** 2
    step = max(1, BLOCK // count)

    spare: SimpleQueue[_Work] = SimpleQueue()
    for _ in range(os.cpu_count() or 1):
        spare.put(_Work.of(step, count))

    def rows(start: int) -> None:
        work = spare.get()
        for k, (points, factor) in enumerate(seen):
            targets = points[start : start + step]
            solid, layers[k][start : start + step] = far.with_near(targets, panels, reach, work)
            if k == 0:
                own = np.arange(len(targets))
                solid[own, start + own] = 0.0
                angles[start : start + step] = solid
            else:
                angles[start : start + step] += factor * solid
        spare.put(work)

    with ThreadPoolExecutor(os.cpu_count()) as threads:
        list(threads.map(rows, range(0, count, step)))
    return angles, layers


def seen_by(targets: Array, panels: Panels) -> tuple[NDArray[np.float32], Array]:
    """Solid angle of every panel, (m, n), and the integral of n / r, (m, 3), from points that are no centroids of theirs."""
    out, layer = np.empty((len(targets), panels.count), dtype=np.float32), np.empty((len(targets), 3))
    far, reach = _Far.of(panels), (REACH * panels.size) ** 2
    step = max(1, BLOCK // panels.count)
    work = _Work.of(step, panels.count)
    for start in range(0, len(targets), step):
        here = slice(start, start + step)
        out[here], layer[here] = far.with_near(targets[here], panels, reach, work)
    return out, layer


def gradients(targets: Array, directions: Array, panels: Panels) -> tuple[NDArray[np.float32], Array, Array]:
    """Derivatives along a direction at each target: of the solid angle of every panel, and of the integral of n / r.

    Near panels exactly: vortex rings along their sides (Katz & Plotkin, Low-Speed Aerodynamics, 2001, 10.4.5), and the
    gradient of 1 / r over a flat panel (Hess & Smith 1967). Beyond `REACH` three dipoles or sources at the middles of the
    sides, which is exact to the second degree.

    Parameters
    ----------
    targets, directions : (m, 3) arrays
    panels : Panels

    Returns
    -------
    velocity : (m, n) array
        Of the solid angle.
    slope : (m, 3) array
        Of the integral of n / r over all panels.
    layer : (m, 3) array
        That integral itself, m.
    """
    m, n = len(targets), panels.count
    velocity, slope, layer = np.empty((m, n), dtype=np.float32), np.empty((m, 3)), np.empty((m, 3))
    corners, third = panels.corners, (panels.area / 3.0).astype(np.float32)
    middles = (corners + np.roll(corners, -1, axis=1)).transpose(1, 2, 0) / 2.0
    squares = [np.vstack([-2.0 * y, np.ones(y.shape[1]), np.sum(y**2, axis=0)]) for y in (*middles, panels.centre.T)]
    ahead = [np.vstack([y, np.full(n, -1.0)]).astype(np.float32) for y in middles]
    height = np.vstack([-panels.normal.T, np.sum(panels.normal * panels.centre, axis=1)]).astype(np.float32)
    normal, reach = panels.normal.astype(np.float32), (REACH * panels.size) ** 2
    step = max(1, BLOCK // n)
    work = _Work.of(step, n, 8)
    for start in range(0, m, step):
        x, way = targets[start : start + step], directions[start : start + step]
        away, rest = work.square[: len(x)], work.rest[:, : len(x)]
        square, root, along, moved, inverse, pull, push, cubes = rest
        lifted = np.hstack([x, np.sum(x**2, axis=1)[:, None], np.ones((len(x), 1))])
        turned = np.hstack([way, np.sum(way * x, axis=1)[:, None]]).astype(np.float32)
        near = np.flatnonzero((np.matmul(lifted, squares[3], out=away) < reach).ravel())
        rest[4:].fill(0.0)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # at a middle of a side, which is near
            for to_middle, at in zip(squares, ahead, strict=False):
                np.matmul(lifted, to_middle, out=away)
                np.copyto(square, np.reciprocal(away, out=away), casting="same_kind")
                inverse += np.sqrt(square, out=root)
                cubes += np.multiply(root, square, out=root)
                pull += np.multiply(np.matmul(turned, at, out=along), root, out=along)
                push += np.multiply(along, square, out=moved)
            push *= np.matmul(lifted[:, [0, 1, 2, 4]].astype(np.float32), height, out=along)
            push *= 3.0
            push -= np.multiply(cubes, np.matmul(turned[:, :3], normal.T, out=along), out=cubes)
        rest[4:7] *= third
        flat = [total.ravel() for total in (inverse, pull, push)]
        for part in range(0, len(near), NEAR_BLOCK):
            place = near[part : part + NEAR_BLOCK]
            i, j = np.divmod(place, n)
            angle, flat[0][place] = exact_integrals(x[i], corners[j], panels.normal[j])
            flat[1][place] = np.einsum("ni,ni->n", _pull(x[i], corners[j], panels.normal[j], angle), way[i])
            flat[2][place] = np.einsum("ni,ni->n", _ring(x[i], corners[j]), way[i])
        here = slice(start, start + step)
        velocity[here], slope[here], layer[here] = push, pull @ normal, inverse @ normal
    return velocity, slope, layer


def _ring(targets: Array, corners: Array) -> Array:
    """Gradient of the solid angle of triangle k at target k, (n, 3)."""
    to = corners - targets[:, None]
    r = np.linalg.norm(to, axis=2)
    total = np.zeros_like(targets)
    for k in range(3):
        a, b, ra, rb = to[:, k - 1], to[:, k], r[:, k - 1], r[:, k]
        below = ra * rb * (ra * rb + np.einsum("ni,ni->n", a, b))
        total += np.cross(a, b) * ((ra + rb) / np.maximum(below, 1e-30))[:, None]
    return total


def _pull(targets: Array, corners: Array, normals: Array, angle: Array) -> Array:
    """Gradient of the integral of 1 / r of triangle k, seen under an angle, at target k, (n, 3)."""
    to = corners - targets[:, None]
    r = np.linalg.norm(to, axis=2)
    total = angle[:, None] * normals
    for k in range(3):
        side = to[:, k] - to[:, k - 1]
        length = np.linalg.norm(side, axis=1)
        gap = np.maximum(r[:, k - 1] + r[:, k] - length, 1e-14 * length)
        share = np.log((r[:, k - 1] + r[:, k] + length) / gap) / length
        total -= np.cross(side, normals) * share[:, None]
    return total


@dataclass(frozen=True, slots=True)
class _Work:
    """Memory for blocks of rows: what the system has to hand out anew for every block costs more than the sums.

    Attributes
    ----------
    square : (m, n) array
        Of distances, in double precision: small against the body's size.
    rest : (k, m, n) array
        In single precision, as what comes of it is kept.
    """

    square: Array
    rest: NDArray[np.float32]

    @classmethod
    def of(cls, rows: int, columns: int, arrays: int = 5) -> _Work:
        """For blocks of at most so many rows."""
        return cls(np.empty((rows, columns)), np.empty((arrays, rows, columns), dtype=np.float32))


@brief
@dataclass(frozen=True, slots=True)
class _Far:
    """Panels as sources with their second moments: polynomials of the target (x x, x, 1), one column a panel.

    Attributes
    ----------
    square : (10, n) array
        Of the distance to the centroid, r^2.
    inverse, solid : (10, n) arrays
        Second-moment terms of 1 / r and of 1 / r^3, times r^4 over their first terms.
    height : (4, n) array
        Of the plane over the target, times the panel's area.
    weighted : (n, 3) array
        Normal times area. All between the first and this in single precision, as the angles that come of them are kept.
    """

    square: Array
    inverse: NDArray[np.float32]
    solid: NDArray[np.float32]
    height: NDArray[np.float32]
    weighted: Array

    @classmethod
    def of(cls, panels: Panels) -> _Far:
        """The polynomials.

        With M the second moments over the area and t their trace, the mean of 1 / r over a panel is
        (1 + (3 d M d / r^2 - t) / (2 r^2)) / r and that of 1 / r^3 is (1 + (15 d M d / r^2 - 3 t) / (2 r^2)) / r^3.
        """
        c, area = panels.centre, panels.area[:, None]
        rows, columns = np.triu_indices(3)
        even = np.tile((rows == columns).astype(float), (panels.count, 1))
        square = np.hstack([even, -2.0 * c, np.sum(c**2, axis=1)[:, None]])
        moment = 3.0 * np.einsum("qni,qnj->nij", panels.spread, panels.spread)
        linear = np.einsum("nij,nj->ni", moment, c)
        quadratic = moment[:, rows, columns] * np.where(rows == columns, 1.0, 2.0)
        spread = np.hstack([quadratic, -2.0 * linear, np.sum(linear * c, axis=1)[:, None]])
        trace = np.sum(panels.spread**2, axis=(0, 2))[:, None] * square
        height = np.hstack([-panels.normal, np.sum(panels.normal * c, axis=1)[:, None]]) * area
        inverse, solid = 0.5 * (spread - trace), 2.5 * spread - 1.5 * trace
        first, second, third = (np.ascontiguousarray(a.T, dtype=np.float32) for a in (inverse, solid, height))
        return cls(np.ascontiguousarray(square.T), first, second, third, panels.normal * area)

    def with_near(self, targets: Array, panels: Panels, reach: Array, work: _Work) -> tuple[NDArray[np.float32], Array]:
        """Solid angles (m, n) and the integrals of n / r (m, 3): far panels by their moments, near ones exactly.

        The angles lie in ``work``, for at least as many rows.
        """
        m, n = len(targets), panels.count
        away, (square, root, solid, height, inverse) = work.square[:m], (one[:m] for one in work.rest)
        rows, columns = np.triu_indices(3)
        exact = np.hstack([targets[:, rows] * targets[:, columns], targets, np.ones((m, 1))])
        near = np.flatnonzero((np.matmul(exact, self.square, out=away) < reach).ravel())
        lifted = exact.astype(np.float32)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # at a centroid, which is near
            np.copyto(square, np.reciprocal(away, out=away), casting="same_kind")
            np.sqrt(square, out=root)
            np.matmul(lifted, self.solid, out=solid)
            np.matmul(lifted, self.inverse, out=inverse)
            np.matmul(lifted[:, 6:], self.height, out=height)
            height *= root
            height *= square
            square *= square
            solid *= square
            solid += 1.0
            solid *= height
            inverse *= square
            inverse += 1.0
            inverse *= root
        flat, layer = solid.ravel(), inverse.ravel()
        for part in range(0, len(near), NEAR_BLOCK):
            place = near[part : part + NEAR_BLOCK]
            i, j = np.divmod(place, n)
            flat[place], whole = exact_integrals(targets[i], panels.corners[j], panels.normal[j])
            layer[place] = whole / panels.area[j]
        np.copyto(away, inverse)  # a sum over thousands of panels in double precision is that of every library
        return solid, away @ self.weighted

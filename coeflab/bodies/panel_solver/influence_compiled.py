"""The influence of panels on each other, compiled by numba for all cores; the same integrals as `panel_influence`.

Only imported where numba is installed and wanted. The machine code is kept between runs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numba
import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.panel_solver.influence import REACH, Seen
from coeflab.bodies.panel_solver.panels import Panels
from coeflab.core.types import Array


def _exact(x: float, y: float, z: float, t: Array) -> tuple[float, float]:
    """Solid angle and integral of 1 / r of one panel; ``t`` (12,) holds its corners and its normal."""
    ax, ay, az = t[0] - x, t[1] - y, t[2] - z
    bx, by, bz = t[3] - x, t[4] - y, t[5] - z
    cx, cy, cz = t[6] - x, t[7] - y, t[8] - z
    nx, ny, nz = t[9], t[10], t[11]
    ra = math.sqrt(ax * ax + ay * ay + az * az)
    rb = math.sqrt(bx * bx + by * by + bz * bz)
    rc = math.sqrt(cx * cx + cy * cy + cz * cz)
    height = ax * nx + ay * ny + az * nz
    angle = 0.0
    if abs(height) > 1e-12 * max(ra, rb, rc):
        triple = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        below = ra * rb * rc + (ax * bx + ay * by + az * bz) * rc
        below += (bx * cx + by * cy + bz * cz) * ra + (cx * ax + cy * ay + cz * az) * rb
        angle = 2.0 * math.atan2(triple, below)
    inverse = -height * angle
    for k in range(3):
        if k == 0:
            px, py, pz, rp, qx, qy, qz, rq = ax, ay, az, ra, bx, by, bz, rb
        elif k == 1:
            px, py, pz, rp, qx, qy, qz, rq = bx, by, bz, rb, cx, cy, cz, rc
        else:
            px, py, pz, rp, qx, qy, qz, rq = cx, cy, cz, rc, ax, ay, az, ra
        sx, sy, sz = qx - px, qy - py, qz - pz
        side = math.sqrt(sx * sx + sy * sy + sz * sz)
        outward = px * (sy * nz - sz * ny) + py * (sz * nx - sx * nz) + pz * (sx * ny - sy * nx)
        gap = max(rp + rq - side, 1e-14 * side)
        inverse += outward / side * math.log((rp + rq + side) / gap)
    return angle, inverse


def _fill(
    targets: Array, factor: float, centre: Array, spread: Array, triangles: Array, area: Array, reach: Array,
    angles: NDArray[np.float32], layer: Array,
) -> None:  # fmt: skip
    """All rows; targets and centre are (3, n), spread (6, n) with both vectors after each other.

    A factor of zero is the panels' own: their angles are set, without those of a panel itself; others are added.
    """
    cx, cy, cz = centre[0], centre[1], centre[2]
    ax, ay, az, bx, by, bz = spread[0], spread[1], spread[2], spread[3], spread[4], spread[5]
    nx, ny, nz = triangles[:, 9].copy(), triangles[:, 10].copy(), triangles[:, 11].copy()
    trace = ax * ax + ay * ay + az * az + bx * bx + by * by + bz * bz
    count = len(cx)
    for i in numba.prange(count):
        x, y, z = targets[0, i], targets[1, i], targets[2, i]
        row, angle = np.empty(count), np.empty(count)
        for j in range(count):
            dx, dy, dz = cx[j] - x, cy[j] - y, cz[j] - z
            inverse = 1.0 / (dx * dx + dy * dy + dz * dz)
            root = math.sqrt(inverse) * area[j]
            along = (dx * ax[j] + dy * ay[j] + dz * az[j]) ** 2 + (dx * bx[j] + dy * by[j] + dz * bz[j]) ** 2
            bend = (3.0 * along * inverse - trace[j]) * inverse
            row[j] = root * (1.0 + 0.5 * bend)
            height = dx * nx[j] + dy * ny[j] + dz * nz[j]
            angle[j] = root * inverse * height * (1.0 + 2.5 * bend + trace[j] * inverse)
        for j in range(count):
            if (cx[j] - x) ** 2 + (cy[j] - y) ** 2 + (cz[j] - z) ** 2 < reach[j]:
                angle[j], row[j] = _panel(x, y, z, triangles[j])
        if factor == 0.0:
            angle[i] = 0.0
            for j in range(count):
                angles[i, j] = angle[j]
        else:
            for j in range(count):
                angles[i, j] += factor * angle[j]
        u, v, w = 0.0, 0.0, 0.0
        for j in range(count):
            u += row[j] * nx[j]
            v += row[j] * ny[j]
            w += row[j] * nz[j]
        layer[i, 0], layer[i, 1], layer[i, 2] = u, v, w


_panel = numba.njit(cache=True, error_model="numpy")(_exact)
_filled = numba.njit(cache=True, parallel=True, error_model="numpy", fastmath={"reassoc", "contract", "nsz"})(_fill)


def influence(panels: Panels, images: Sequence[Seen] = ()) -> tuple[NDArray[np.float32], list[Array]]:
    """As `coeflab.bodies.panel_solver.influence.influence`."""
    count = panels.count
    angles, layers = np.empty((count, count), dtype=np.float32), []
    triangles = np.hstack([panels.corners.reshape(count, 9), panels.normal])
    spread = np.ascontiguousarray(panels.spread.transpose(0, 2, 1).reshape(6, count))
    centre = np.ascontiguousarray(panels.centre.T)
    for points, factor in ((panels.centre, 0.0), *images):
        layer, targets = np.empty((count, 3)), np.ascontiguousarray(points.T)
        _filled(targets, factor, centre, spread, triangles, panels.area, (REACH * panels.size) ** 2, angles, layer)
        layers.append(layer)
    return angles, layers

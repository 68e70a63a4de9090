"""The round hull inside a fused surface: its axis and its radius at every station, whatever is attached to it.

From the axis 72 rays look outward at each station; the median of the first surface they meet is the hull's radius as
long as appendages take up less than half the girth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.core.types import Array, Faces, brief

RAYS = 72  # from the axis, 5 deg apart
ROUGH, FINE = 41, 161  # stations while the axis is looked for, and of the profile
ROUND_WITHIN = 0.05  # of the radius: on the circle
NEAR_ROUND = 0.2  # of the radius: may be on it, before the circle is known
TURNS = 6  # of axis and sections about each other; most come to rest in three


@brief
@dataclass(frozen=True, slots=True)
class RoundHull:
    """A body of revolution that fits inside a surface.

    Attributes
    ----------
    point : (3,) array
        On the axis, m.
    rotation : (3, 3) array
        Its first column is the axis.
    x, radius : (n,) arrays
        Stations from the point and radii, m; the longest run of stations with a radius above zero.
    roundness : float
        Share of the rays within 5 % of the median, weighted by section area; 1 for a body of revolution.
    """

    point: Array
    rotation: Array
    x: Array
    radius: Array
    roundness: float

    @property
    def volume(self) -> float:
        """m^3, by trapezia."""
        return float(np.pi * np.trapezoid(self.radius**2, self.x))

    def distance(self, points: Array) -> tuple[Array, Array]:
        """Station and distance from the axis of (n, 3) points, m."""
        local = (points - self.point) @ self.rotation
        return local[:, 0], np.hypot(local[:, 1], local[:, 2])


def frame(axis: Array) -> Array:
    """(3, 3) rotation whose first column is a unit axis."""
    other = np.eye(3)[int(np.argmin(np.abs(axis)))]
    second = other - axis * (other @ axis)
    second /= np.linalg.norm(second)
    return np.column_stack([axis, second, np.cross(axis, second)])


def _rays(local: Array, faces: Faces, station: float) -> Array:
    """(72,) distance from the axis to the first surface, m; zero where the ray starts outside."""
    above = local[:, 0] > station
    corner = above[faces]
    cut = faces[corner.any(axis=1) & ~corner.all(axis=1)]
    if not len(cut):
        return np.zeros(RAYS)
    side = above[cut]
    alone = np.where(side.sum(axis=1) == 1, np.argmax(side, axis=1), np.argmin(side, axis=1))
    rows = np.arange(len(cut))
    apex = local[cut[rows, alone]]
    ends = []
    for k in (1, 2):
        other = local[cut[rows, (alone + k) % 3]]
        share = (station - apex[:, 0]) / (other[:, 0] - apex[:, 0])
        ends.append(apex[:, 1:] + share[:, None] * (other[:, 1:] - apex[:, 1:]))
    angle = 2.0 * np.pi * (np.arange(RAYS) + 0.5) / RAYS
    along = np.column_stack([np.cos(angle), np.sin(angle)])
    across = np.column_stack([-along[:, 1], along[:, 0]])
    p, q = across @ ends[0].T, across @ ends[1].T
    with np.errstate(divide="ignore", invalid="ignore"):
        share = p / (p - q)
        reach = (1.0 - share) * (along @ ends[0].T) + share * (along @ ends[1].T)
    met = ((p > 0.0) != (q > 0.0)) & (reach > 0.0)
    first = np.min(np.where(met, reach, np.inf), axis=1)
    return np.where(met.sum(axis=1) % 2 == 1, first, 0.0)


def _circle(reach: Array) -> tuple[Array, float] | None:
    """Centre and radius of the circle through most ends of the rays; None where the section is not round."""
    angle = 2.0 * np.pi * (np.arange(RAYS) + 0.5) / RAYS
    middle = float(np.median(reach))
    for _ in range(4):
        near = (reach > 0.0) & (np.abs(reach - middle) < NEAR_ROUND * middle)
        if 2 * near.sum() <= RAYS:
            return None
        y, z = reach[near] * np.cos(angle[near]), reach[near] * np.sin(angle[near])
        design = np.column_stack([y, z, np.ones_like(y)])
        a, b, c = np.linalg.lstsq(design, y**2 + z**2, rcond=None)[0]
        centre = np.array([a, b]) / 2.0
        radius = float(np.sqrt(c + centre @ centre))
        middle = radius
        expected = centre[0] * np.cos(angle) + centre[1] * np.sin(angle) + radius
        near_circle = np.abs(reach - expected) < ROUND_WITHIN * radius
        if 2 * near_circle.sum() > RAYS:
            reach = np.where(near_circle, reach, 0.0)
    return centre, radius


def _line(x: Array, y: Array, weight: Array) -> tuple[float, float]:
    """Offset and slope by least absolute distance, through reweighting."""
    scale: Array = weight
    fit: Array = np.zeros(2)
    for _ in range(12):
        design = np.column_stack([np.ones_like(x), x]) * scale[:, None]
        fit = np.asarray(np.linalg.lstsq(design, y * scale, rcond=None)[0], dtype=np.float64)
        distance = np.abs(y - fit[0] - fit[1] * x)
        scale = np.asarray(weight / np.sqrt(np.maximum(distance, 1e-6 * np.ptp(x))))
    return float(fit[0]), float(fit[1])


def _settled(vertices: Array, faces: Faces, axis: Array, point: Array) -> tuple[Array, Array]:
    """Axis and point moved into the middle of the sections."""
    for _ in range(TURNS):
        turn = frame(axis)
        local = (vertices - point) @ turn
        low, high = local[:, 0].min(), local[:, 0].max()
        found = []
        for x in low + (high - low) * (np.arange(ROUGH) + 0.5) / ROUGH:
            circle = _circle(_rays(local, faces, x))
            if circle is not None:
                found.append((x, *circle[0], circle[1]))
        if len(found) < 4:
            return axis, point
        x, y, z, radius = np.array(found).T
        (y0, dy), (z0, dz) = _line(x, y, radius), _line(x, z, radius)
        point = point + turn @ np.array([0.0, y0, z0])
        moved = turn @ np.array([1.0, dy, dz])
        axis = moved / np.linalg.norm(moved)
        if np.hypot(dy, dz) < 1e-6 and np.hypot(y0, z0) < 1e-6 * (high - low):
            break
    return axis, point


def _profile(vertices: Array, faces: Faces, axis: Array, point: Array) -> RoundHull | None:
    turn = frame(axis)
    local = (vertices - point) @ turn
    low, high = local[:, 0].min(), local[:, 0].max()
    x = (low + high) / 2.0 - (high - low) / 2.0 * np.cos(np.pi * (np.arange(FINE) + 0.5) / FINE)
    reach = np.array([_rays(local, faces, s) for s in x])
    radius = np.median(reach, axis=1)
    inside = np.r_[False, radius > 0.0, False].astype(int)
    starts, ends = np.flatnonzero(np.diff(inside) == 1), np.flatnonzero(np.diff(inside) == -1)
    if not len(starts):
        return None
    run = int(np.argmax(x[ends - 1] - x[starts]))
    here = slice(starts[run], ends[run])
    x, radius, reach = x[here], radius[here], reach[here]
    if len(x) < 4:
        return None
    round_share = np.mean(np.abs(reach - radius[:, None]) <= ROUND_WITHIN * radius[:, None], axis=1)
    return RoundHull(point, turn, x, radius, float(np.sum(round_share * radius**2) / np.sum(radius**2)))


def round_hull(vertices: Array, faces: Faces) -> RoundHull | None:
    """The best of the bodies of revolution about the three principal axes; None where no section is cut.

    Best means the largest roundness times the share of the volume that the body of revolution holds.
    """
    whole = mesh_integrals(vertices, faces)
    directions = np.linalg.eigh(whole.second_moments)[1][:, ::-1].T
    best, score = None, 0.0
    for axis in directions:
        leading = axis[int(np.argmax(np.abs(axis)))]
        found = _profile(vertices, faces, *_settled(vertices, faces, axis * np.sign(leading), whole.centre))
        if found is None:
            continue
        fitness = found.roundness * min(1.0, found.volume / whole.volume)
        if fitness > score + 1e-6:
            best, score = found, fitness
    return best

"""Four more meshes of vehicles, m, FLU, coarse, all synthetic: kinds that `simplify` was not written for."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import trimesh
from trimesh.creation import annulus, box, cylinder, icosphere

from tests.bodies.twelve import FORWARD, Mesh, at, fin, hull, rounded, united


def loft(sections: np.ndarray) -> Mesh:
    """A closed surface through (stations, around, 3) closed curves; the ends are fans."""
    stations, around, _ = sections.shape
    points = np.vstack([sections.reshape(-1, 3), sections[0].mean(axis=0), sections[-1].mean(axis=0)])
    faces = []
    for s in range(stations - 1):
        for k in range(around):
            a, b = s * around + k, s * around + (k + 1) % around
            faces += [(a, b, b + around), (a, b + around, a + around)]
    last = (stations - 1) * around
    for k in range(around):
        j = (k + 1) % around
        faces += [(stations * around, j, k), (stations * around + 1, last + k, last + j)]
    made = trimesh.Trimesh(points, np.array(faces))
    made.fix_normals()
    return made


def blended_wing() -> Mesh:
    """A flying wing: sections of 12 to 30 % thickness, swept, that swell into a body, and two winglets."""
    around = 2.0 * np.pi * np.arange(28) / 28
    made = []
    for y in np.linspace(-1.0, 1.0, 31):
        inside = np.exp(-((y / 0.22) ** 2))
        chord = 0.28 * (1.0 - 0.45 * abs(y)) + 0.6 * inside
        thick = 0.13 + 0.12 * inside
        x = 0.5 * chord * np.cos(around) - 0.45 * abs(y)
        z = 0.5 * thick * chord * np.sin(around) * (0.75 + 0.25 * np.cos(around))
        made.append(np.column_stack([x, np.full_like(x, y), z]))
    winglets = [at(box((0.12, 0.012, 0.24)), -0.45, y, 0.1) for y in (-0.97, 0.97)]
    return united(loft(np.array(made)), *winglets)


def ring_wing_hull() -> Mesh:
    """A hull in the middle of a ring wing on three struts, with a cross of fins astern."""
    ring = at(annulus(0.27, 0.285, 0.22, sections=32, transform=FORWARD), 0.15, 0.0, 0.0)
    struts = [fin(0.1, 0.012, 0.08, 0.275, 0.15, a) for a in (0.0, 120.0, 240.0)]
    fins = [fin(0.14, 0.012, 0.03, 0.2, -0.68, a) for a in (45.0, 135.0, 225.0, 315.0)]
    return united(hull(*rounded(1.7, 0.12, 0.25, 0.5)), ring, *struts, *fins)


def lander() -> Mesh:
    """A tripod of leaning tubes with feet, a deck, a bottle across it and three spheres of glass."""
    parts = [at(cylinder(0.35, 0.03, sections=24), 0.0, 0.0, 0.2)]
    for angle in 2.0 * np.pi * np.arange(3) / 3.0:
        way = np.array([np.cos(angle), np.sin(angle), 0.0])
        foot, head = 0.75 * way - [0.0, 0.0, 0.5], 0.25 * way + [0.0, 0.0, 0.2]
        parts += [cylinder(0.03, segment=[foot, head], sections=12), at(cylinder(0.1, 0.03, sections=16), *foot)]
        parts.append(at(icosphere(2, 0.2), *(0.22 * np.array([-way[0], -way[1], 0.0]) + [0.0, 0.0, 0.4])))
    parts.append(cylinder(0.07, segment=[[-0.3, 0.0, 0.0], [0.3, 0.0, 0.0]], sections=20))
    parts += [cylinder(0.02, segment=[[x, 0.0, 0.0], [x, 0.0, 0.2]], sections=10) for x in (-0.15, 0.15)]
    return united(*parts)


def kayak() -> Mesh:
    """A hull with sharp ends and V sections under a cambered deck, a mast foot, a fin keel with a bulb."""
    made = []
    for x in np.linspace(-1.5, 1.5, 25):
        fullness = np.sqrt(max(1.0 - (x / 1.53) ** 2, 0.0))
        beam, draught, deck = 0.3 * fullness**1.3, 0.05 + 0.15 * fullness, 0.04 + 0.06 * fullness
        side = np.array([1.0, 0.75, 0.45, 0.2])
        keel = -draught * np.array([0.0, 0.45, 0.75, 0.93])
        y = np.r_[side, 0.0, -side[::-1], -0.6, 0.0, 0.6] * beam
        z = np.r_[keel, -draught, keel[::-1], 0.8 * deck, deck, 0.8 * deck]
        made.append(np.column_stack([np.full_like(y, x), y, z]))
    bulb = at(hull(*rounded(0.6, 0.06, 0.1, 0.2), around=20), 0.0, 0.0, -0.65)
    keel_fin = at(box((0.25, 0.025, 0.55)), 0.0, 0.0, -0.42)
    return united(loft(np.array(made)), keel_fin, bulb, at(box((0.4, 0.25, 0.12)), -0.3, 0.0, 0.12))


FOUR: dict[str, Callable[[], Mesh]] = {
    "blended_wing": blended_wing, "ring_wing_hull": ring_wing_hull, "lander": lander, "kayak": kayak,
}  # fmt: skip

"""Twelve meshes of as many kinds of vehicles, m, FLU, coarse; all synthetic."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import trimesh
from trimesh.creation import annulus, box, cylinder, icosphere, revolve
from trimesh.transformations import rotation_matrix

Mesh = trimesh.Trimesh
FORWARD = rotation_matrix(np.pi / 2.0, [0.0, 1.0, 0.0])


def at(mesh: Mesh, *place: float) -> Mesh:
    return mesh.apply_translation(place)


def united(*parts: Mesh) -> Mesh:
    return trimesh.boolean.union(parts, engine="manifold")


def hull(x: np.ndarray, radius: np.ndarray, around: int = 32) -> Mesh:
    """A body of revolution about x."""
    profile = np.column_stack([np.r_[0.0, radius, 0.0], np.r_[x[0], x, x[-1]]])
    made = revolve(profile, sections=around).apply_transform(FORWARD)
    made.merge_vertices()
    return made


def ellipsoid(*axes: float) -> Mesh:
    return icosphere(2).apply_scale(axes)


def fin(chord: float, thickness: float, root: float, tip: float, x: float, angle: float) -> Mesh:
    """A slab from the root to the tip, off the axis; 0 deg is up."""
    slab = at(box((chord, thickness, tip - root)), x, 0.0, (tip + root) / 2.0)
    return slab.apply_transform(rotation_matrix(np.radians(angle), [1.0, 0.0, 0.0]))


def rounded(length: float, radius: float, nose: float, tail: float) -> tuple[np.ndarray, np.ndarray]:
    """Elliptic nose, parallel middle, tail that tapers to a fifth."""
    a, z = -length / 2.0, length / 2.0
    x = np.concatenate([np.linspace(a, a + tail, 9), np.linspace(a + tail, z - nose, 6)[1:-1]])
    fore = z - nose + nose * np.sin(np.linspace(0.0, np.pi / 2.0, 12))
    x = np.concatenate([x, fore[:-1], [z - 1e-4 * length]])
    back = 1.0 - 0.8 * np.clip((a + tail - x) / tail, 0.0, None) ** 2
    front = np.sqrt(np.clip(1.0 - (np.clip(x - (z - nose), 0.0, None) / nose) ** 2, 0.0, None))
    return x, radius * back * front


def torpedo() -> Mesh:
    fins = [fin(0.16, 0.014, 0.03, 0.22, -0.7, a) for a in (0.0, 90.0, 180.0, 270.0)]
    return united(hull(*rounded(2.0, 0.12, 0.2, 0.5)), *fins)


def glider() -> Mesh:
    body = hull(*rounded(1.8, 0.11, 0.25, 0.6))
    return united(body, box((0.2, 1.2, 0.016)), fin(0.15, 0.012, 0.02, 0.3, -0.72, 0.0))


def manta() -> Mesh:
    """A wing that swells out of a flat body without a seam."""
    made = icosphere(3)
    p = np.array(made.vertices)
    span = np.abs(p[:, 1])
    thick = 0.16 * (1.0 - 0.85 * span)
    chord = 0.55 * (1.0 - 0.45 * span**2)
    made.vertices = np.column_stack([chord * p[:, 0] - 0.25 * span**2, 0.9 * p[:, 1], thick * p[:, 2]])
    return made


def frame_rov() -> Mesh:
    """Bars of one square section, flush at their corners, and a float."""
    long, wide, tall, bar = 1.0, 0.6, 0.5, 0.04
    parts = []
    for y in (-(wide - bar) / 2.0, (wide - bar) / 2.0):
        parts += [at(box((long, bar, bar)), 0.0, y, z) for z in (-(tall - bar) / 2.0, (tall - bar) / 2.0)]
        parts += [at(box((bar, bar, tall)), x, y, 0.0) for x in (-(long - bar) / 2.0, (long - bar) / 2.0)]
    for x in (-(long - bar) / 2.0, (long - bar) / 2.0):
        parts += [at(box((bar, wide, bar)), x, 0.0, z) for z in (-(tall - bar) / 2.0, (tall - bar) / 2.0)]
    return united(*parts, at(box((0.7, 0.5, 0.16)), 0.0, 0.0, 0.15), at(box((0.92, 0.06, 0.06)), 0.0, 0.0, 0.2))


def box_rov() -> Mesh:
    """A float on two side plates, with a pod between them."""
    sides = [at(box((0.7, 0.03, 0.45)), 0.0, y, -0.05) for y in (-0.22, 0.22)]
    pod = at(hull(np.array([-0.25, 0.25]), np.array([0.09, 0.09]), 24), 0.0, 0.0, -0.15)
    struts = [at(box((0.05, 0.43, 0.03)), x, 0.0, -0.15) for x in (-0.12, 0.12)]
    return united(at(box((0.7, 0.47, 0.16)), 0.0, 0.0, 0.15), *sides, pod, *struts)


def ducted_quadrotor() -> Mesh:
    parts = [box((0.5, 0.2, 0.15))]
    for x in (0.35, -0.35):
        for y in (0.35, -0.35):
            duct, root = np.array([x, y, 0.0]), np.array([np.copysign(0.2, x), np.copysign(0.08, y), 0.0])
            rim = duct - 0.14 * (duct - root) / np.linalg.norm(duct - root)
            parts.append(at(annulus(0.13, 0.16, 0.1, sections=24), *duct))
            parts.append(cylinder(0.02, segment=[root, rim], sections=12))
    return united(*parts)


def triple_hull() -> Mesh:
    sides = [at(ellipsoid(0.7, 0.1, 0.1), 0.0, y, 0.0) for y in (-0.35, 0.35)]
    return united(ellipsoid(1.0, 0.15, 0.15), *sides, box((0.3, 0.7, 0.06)))


def submarine() -> Mesh:
    """A sail, and rudders as an X."""
    sail = at(box((0.35, 0.06, 0.22)), 0.35, 0.0, 0.2)
    rudders = [fin(0.16, 0.016, 0.04, 0.2, -0.95, a) for a in (45.0, 135.0, 225.0, 315.0)]
    return united(hull(*rounded(2.6, 0.15, 0.35, 0.8)), sail, *rudders)


def sphere_with_arms() -> Mesh:
    ways = [np.array([np.cos(a), np.sin(a), 0.0]) for a in 2.0 * np.pi / 3.0 * np.arange(3)]
    return united(icosphere(3, 0.3), *(cylinder(0.03, segment=[0.2 * w, 0.8 * w], sections=16) for w in ways))


def tube() -> Mesh:
    return annulus(0.15, 0.2, 1.2, sections=32, transform=FORWARD)


def catamaran() -> Mesh:
    return united(*(at(ellipsoid(1.0, 0.15, 0.15), 0.0, y, 0.0) for y in (-0.5, 0.5)), box((0.3, 0.9, 0.05)))


def towfish() -> Mesh:
    """A blunt body with a keel, a ring tail on four struts."""
    ring = annulus(0.16, 0.18, 0.16, sections=32, transform=FORWARD)
    struts = [fin(0.1, 0.012, 0.02, 0.17, -0.62, a) for a in (0.0, 90.0, 180.0, 270.0)]
    keel = at(box((0.5, 0.03, 0.16)), 0.1, 0.0, -0.14)
    return united(hull(*rounded(1.4, 0.09, 0.15, 0.4)), at(ring, -0.62, 0.0, 0.0), *struts, keel)


TWELVE: dict[str, Callable[[], Mesh]] = {
    "torpedo": torpedo, "glider": glider, "manta": manta, "frame_rov": frame_rov, "box_rov": box_rov,
    "ducted_quadrotor": ducted_quadrotor, "triple_hull": triple_hull, "submarine": submarine,
    "sphere_with_arms": sphere_with_arms, "tube": tube, "catamaran": catamaran, "towfish": towfish,
}  # fmt: skip

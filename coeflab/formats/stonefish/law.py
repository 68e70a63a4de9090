"""Stonefish's fluid forces on a submerged mesh, steady part, and a mesh of an ellipsoid.

Source of the law: patrykcieslak/stonefish, Library/src/entities/SolidEntity.cpp at commit 3857913, functions
ComputeHydrodynamicForcesSubmerged, CorrectHydrodynamicForces, ComputeEllipsoidalApprox, LambKFactor and getAugmentedMass;
FeatherstoneEntity.cpp gives mass and inertia with the added ones to the engine, gyroscopic terms on.

What the source calls quadratic drag is v |v| (-v.n) a face, hence a force with the cube of the speed, and its coefficient is in
s/m; what it calls viscous is linear, its coefficient in m/s. The coefficients of the three axes are weighed by the direction
of the force. Added mass is one number for all directions, the mean of three: there is no Munk moment.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array

AT_ONCE = 128
RINGS, SEGMENTS = 12, 16
FLUID_ROUNDING = 1e-10


def ellipsoid_mesh(axes: Array, centre: Array) -> tuple[Array, NDArray[np.int64]]:
    """Vertices (n, 3) and faces (m, 3), seen from outside counter-clockwise, of semi-axes (3,) along x, y, z.

    No face is three times larger than their mean, which Stonefish would divide.
    """
    theta, phi = np.pi * np.arange(1, RINGS) / RINGS, 2.0 * np.pi * np.arange(SEGMENTS) / SEGMENTS
    rings = np.stack(
        np.broadcast_arrays(
            np.cos(theta)[:, None], np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi))
        ),
        axis=-1,
    ).reshape(-1, 3)
    unit = np.vstack([rings, [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]])
    front, back = len(unit) - 2, len(unit) - 1
    faces = []
    for k in range(SEGMENTS):
        n = (k + 1) % SEGMENTS
        faces += [(front, k, n), (back, (RINGS - 2) * SEGMENTS + n, (RINGS - 2) * SEGMENTS + k)]
        for i in range(RINGS - 2):
            a, b = i * SEGMENTS, (i + 1) * SEGMENTS
            faces += [(a + k, b + k, b + n), (a + k, b + n, a + n)]
    return centre + unit * axes, np.array(faces, dtype=np.int64)


def raw_drag(corners: Array, v: Array, w: Array) -> tuple[Array, Array, Array, Array]:
    """Sums over faces before coefficients: force and torque of the form drag, force and torque of friction, each (n, 3).

    Parameters
    ----------
    corners : (m, 3, 3) array
        From the centre of gravity, m.
    v, w : (n, 3) arrays
        Velocity of the centre of gravity and rate of turn, body axes.
    """
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    normal, area, middle = normal / size, size / 2.0, corners.mean(axis=1)
    out: list[list[Array]] = [[], [], [], []]
    for at in range(0, len(v), AT_ONCE):
        water = -(v[at : at + AT_ONCE, None] + np.cross(w[at : at + AT_ONCE, None], middle))
        through = np.sum(water * normal, axis=2, keepdims=True)
        form = water * np.linalg.norm(water, axis=2, keepdims=True) * np.maximum(-through, 0.0) * area
        skin = (water - through * normal) * area
        for k, face in enumerate((form, skin)):
            out[2 * k].append(_summed(face))
            out[2 * k + 1].append(_summed(np.cross(middle, face)))
    form_force, form_torque, skin_force, skin_torque = (np.concatenate(parts) for parts in out)
    return form_force, form_torque, skin_force, skin_torque


def _summed(faces: Array) -> Array:
    """Over the faces, (n, 3); what cancels to rounding is zero."""
    total = faces.sum(axis=1)
    return np.where(np.abs(total) <= FLUID_ROUNDING * np.abs(faces).sum(axis=1), 0.0, total)


def weighed(raw: Array, coefficients: Array) -> Array:
    """Raw forces or torques (n, 3) times the coefficients (3,) weighed by their direction."""
    size = np.linalg.norm(raw, axis=1, keepdims=True)
    direction = np.divide(np.abs(raw), size, out=np.zeros_like(raw), where=size > 0.0)
    return np.asarray(raw * (direction @ coefficients)[:, None])


def added(corners: Array, density: float) -> tuple[float, Array]:
    """Added mass, kg, and added moments of inertia (3,), kg m^2, that Stonefish takes from the extent of a mesh.

    The factor for motion ahead is Stonefish's, whose 1 - r^2 / a is not Lamb's 1 - r^2 / a^2.
    """
    a, b, c = (np.max(corners, axis=(0, 1)) - np.min(corners, axis=(0, 1))) / 2.0
    r = (b + c) / 2.0
    e = 1.0 - r * r / a
    log = (1.0 + e) / (1.0 - e)
    alpha = 2.0 * (1.0 - e * e) / (e * e) * (0.5 * np.log(log) - e) if log > 0.0 else 1.0
    volume = 4.0 / 3.0 * np.pi * density
    masses = np.array([alpha / (2.0 - alpha) * volume * a * r * r, volume * a * c * c, volume * a * b * b])
    moments = np.pi * density / 12.0 * a**3 * np.array([0.0, b * b, c * c])
    return float(masses.mean()), moments

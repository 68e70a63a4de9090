"""Where motions under constant thrust settle: many at once, by steps in pseudo-time that end as Newton's.

Kelley & Keyes, SIAM J. Numerical Analysis 35(2), 1998. Implicit steps follow the motion while they are short and grow as the
forces vanish, so that what is found is what the vehicle would reach from the start, and nothing fails at rest, where forces
that go with the square of the speed lose their slope.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.motion.vehicle import PLANES, Vehicle

STEPS = 200
TOLERANCE = 1e-11
ENOUGH = 1e-8
FIRST_STEP, SHORTEST, LONGEST = 0.5, 0.02, 1e12
NUDGE = 1e-6


def settled(
    forces: Callable[[Array], Array],
    inertia: Array,
    start: Array,
    scale: Array,
    slopes: Callable[[Array], Array] | None = None,
) -> tuple[Array, NDArray[np.bool_]]:
    """Velocities at which all forces vanish.

    Parameters
    ----------
    forces : callable
        (n, f) velocities -> (n, f) forces in the directions that are free, thrust and Coriolis forces included.
    inertia : (f, f) array
        Rigid body and added mass.
    start : (n, f) array
    scale : (n,) array
        Force that counts as large, such as the thrust.
    slopes : callable, optional
        (n, f) -> (n, f, f) exact derivatives of the forces; central differences by default.

    Returns
    -------
    velocities : (n, f) array
        NaN where the march came to no rest.
    found : (n,) bool array
    """
    x = np.array(start, dtype=float)
    steep = slopes or (lambda at: differences(forces, at))
    pace, last = np.full(len(x), FIRST_STEP), np.full(len(x), np.nan)
    with np.errstate(invalid="ignore", over="ignore"):
        for _ in range(STEPS):
            wrong = forces(x)
            size = np.linalg.norm(wrong, axis=1) / scale
            moving = np.isfinite(size) & (size > TOLERANCE)
            if not np.any(moving):
                break
            # Longer steps as the forces fall, shorter ones where they rise.
            pace = pace * np.clip(np.nan_to_num(last / np.maximum(size, 1e-300), nan=1.0), 0.5, 10.0)
            pace, last = np.clip(pace, SHORTEST, LONGEST), size
            slope = steep(x)
            # An implicit step longer than a disturbance takes to grow would run back to an unstable rest.
            rise = np.nan_to_num(growth(inertia, slope))
            pace = np.where(rise > 0.0, np.minimum(pace, 0.5 / np.where(rise > 0.0, rise, 1.0)), pace)
            matrix = inertia / pace[moving, None, None] - slope[moving]
            x[moving] += _solved(matrix, wrong[moving])
        size = np.linalg.norm(forces(x), axis=1) / scale
    found = np.isfinite(size) & (size <= ENOUGH)
    return np.where(found[:, None], x, np.nan), np.asarray(found)


def _solved(matrix: Array, wrong: Array) -> Array:
    """Steps; NaN for those of a row whose equations say the same or are not finite."""
    fit = np.asarray(np.isfinite(matrix).all(axis=(1, 2)))
    fit[fit] = np.linalg.cond(matrix[fit]) < 1.0 / np.finfo(float).eps
    out = np.full_like(wrong, np.nan)
    out[fit] = np.linalg.solve(matrix[fit], wrong[fit][..., None])[..., 0]
    return out


def differences(forces: Callable[[Array], Array], x: Array) -> Array:
    """(n, f, f) central differences of the forces by the velocities, in one call."""
    n, f = x.shape
    nudged = x[None] + NUDGE * np.concatenate([np.eye(f), -np.eye(f)])[:, None, :]
    found = forces(nudged.reshape(-1, f)).reshape(2, f, n, -1)
    return np.moveaxis((found[0] - found[1]) / (2.0 * NUDGE), 0, -1)


def growth(inertia: Array, slopes: Array) -> Array:
    """(n,) largest rate at which a small disturbance of each motion grows, 1/s; negative where all die out."""
    sound = np.isfinite(slopes).all(axis=(1, 2))
    out = np.full(len(slopes), np.nan)
    out[sound] = np.linalg.eigvals(np.linalg.solve(inertia, slopes[sound])).real.max(axis=1)
    return out


SLOW = 0.1  # of the file's speed: a course to start from, ahead and not at rest, where damping has no slope
TINY = 1e-9  # N, the size of a force where no thruster pushes


def wrenches(moved: Vehicle, commands: Sequence[Mapping[str, float]]) -> Array:
    """(n, 6) forces of the thrusters for n sets of commands."""
    return np.array([moved.wrench(one) for one in commands]).reshape(-1, 6)


def steady_motions(moved: Vehicle, thrust: Array, controls: Array | None = None) -> tuple[Array, NDArray[np.bool_]]:
    """Velocities at which a level vehicle settles from a slow course ahead.

    Parameters
    ----------
    moved : Vehicle
        Free in some of u, v and r.
    thrust : (n, 6) array
        Of the thrusters.
    controls : (n, 3) array, optional
        dr ds db, rad; zero by default.

    Returns
    -------
    velocities : (n, 6) array
        NaN where it settles nowhere.
    found : (n,) bool array

    Raises
    ------
    InputError
        A motion out of the horizontal plane is free.
    """
    level = PLANES["horizontal"]
    if not set(moved.free) <= set(level):
        raise input_error(
            "motion.steady_turns_sought", column="free", free=", ".join(m for m in moved.free if m not in level),
            level=" ".join(level),
        )  # fmt: skip
    n, at = len(thrust), list(moved.free_columns)
    angles = np.zeros((n, 3)) if controls is None else controls
    size = np.linalg.norm(thrust, axis=1)
    start = np.zeros((n, len(at)))
    if "u" in moved.free:
        start[:, moved.free.index("u")] = np.where(size > 0.0, SLOW * moved.speed, 0.0)

    def forces(x: Array) -> Array:
        return level_forces(moved, x, thrust, angles)

    x, found = settled(forces, moved.effective_mass[np.ix_(at, at)], start, np.maximum(size, TINY))
    out = np.zeros((n, 6))
    out[:, at] = x
    return out, found


def level_forces(moved: Vehicle, velocities: Array, thrust: Array, controls: Array) -> Array:
    """Forces that are left along the free motions of a level vehicle.

    Parameters
    ----------
    moved : Vehicle
    velocities : (k n, f) array
        Of the free motions, k times the same n cases.
    thrust : (n, 6) array
    controls : (n, 3) array

    Returns
    -------
    (k n, f) array
    """
    repeats = len(velocities) // len(thrust)
    at = list(moved.free_columns)
    nu = np.zeros((len(velocities), 6))
    nu[:, at] = velocities
    upright = np.tile((1.0, 0.0, 0.0, 0.0), (len(nu), 1))
    rates = moved.acceleration(nu, upright, np.tile(controls, (repeats, 1)), np.tile(thrust, (repeats, 1)))
    return np.asarray(rates[:, at] @ moved.effective_mass[np.ix_(at, at)].T)

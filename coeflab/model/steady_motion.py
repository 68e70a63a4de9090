"""Steady motions of a vehicle on a level course: where it settles under constant commands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.kernels.settling import settled
from coeflab.model.vehicle import PLANES, Vehicle

Array = NDArray[np.float64]
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
        raise InputError(
            f"{', '.join(m for m in moved.free if m not in level)} free", f"some of {' '.join(level)}", column="free",
            advice="Steady turns are sought on a level course only.",
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

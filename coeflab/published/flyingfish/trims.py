"""Trims of the TJ-FlyingFish by the equations of its paper."""

from __future__ import annotations

import numpy as np

from coeflab.core.types import Array
from coeflab.motion.trim.operating_point import Equation, OperatingPoint, Unknown, operating_point
from coeflab.published.flyingfish.model import FlyingFish
from coeflab.published.flyingfish.rotors import steady_residuals

DEGREE, RPM = 1.0, 20.0
UNKNOWNS = ("beta1", "beta2", "beta3", "beta4", "omega1", "omega2", "omega3", "omega4")
EQUATIONS = (
    Equation("surge force X, equation 51", "N", 1.0),
    Equation("sway force Y, equation 52", "N", 1.0),
    Equation("heave force Z, equation 53", "N", 1.0),
    Equation("roll moment K, equation 54", "N m", 0.1),
    Equation("pitch moment M, equation 55", "N m", 0.1),
    Equation("yaw moment N, equation 56", "N m", 0.1),
)


def unknowns_of(
    fish: FlyingFish, row: int, *, near: bool = True, given: tuple[int, ...] = (), fastest: float | None = None
) -> list[Unknown]:
    """Tilts and rotor speeds with their bounds and the rule of selection; parameters as of `trim`."""
    printed = np.concatenate([fish.angles[row], fish.speeds[row]])
    limit = fish.largest_speed if fastest is None else fastest
    turn = np.radians(DEGREE)
    unknowns = []
    for i, name in enumerate(UNKNOWNS):
        u = Unknown(name, "rad", -np.pi, np.pi, turn, weight=0.0) if i < 4 else Unknown(name, "rpm", 0.0, limit, RPM)
        if near:
            u = Unknown(name, u.unit, u.low, u.high, u.scale, target=float(printed[i]))
        unknowns.append(u.at(float(printed[i])) if i in given else u)
    return unknowns


def trim(
    fish: FlyingFish,
    constants: Array,
    row: int,
    *,
    near: bool = False,
    given: tuple[int, ...] = (),
    starts: int = 12,
    lever: float = 1.0,
    fastest: float | None = None,
) -> OperatingPoint:
    """Tilts and rotor speeds of one motion of Table 1.

    Parameters
    ----------
    fish : FlyingFish
    constants : (5,) array
    row : int
        Of Table 1, from zero.
    near : bool
        Whether the search starts at the printed values and the rule is nearest to them in scales of 1 deg and 20 rpm;
        otherwise it starts cold and the rule is the least sum of squared rotor speeds.
    given : tuple of int
        Unknowns that keep their printed values.
    starts : int
        Seeded starts.
    lever : float
        1 for equation 40 as printed, -1 corrected.
    fastest : float, optional
        Largest rotor speed, rpm; that of the data where None.
    """
    unknowns = unknowns_of(fish, row, near=near, given=given, fastest=fastest)

    def residuals(x: Array) -> Array:
        motion = fish.motion[row : row + 1]
        return steady_residuals(fish.rotors, constants, motion, x[None, :4], x[None, 4:], lever).ravel()

    return operating_point(unknowns, EQUATIONS, residuals, starts=starts)

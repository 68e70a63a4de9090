"""Where the turn of a vehicle ends whose straight course is unstable, and whether its data say so.

With the speed held and controls amidships, a small disturbance of an unstable course grows until nonlinear terms balance it: those in
v (Yv|v|, Nvvv) as well as those in r. Where that balance lies within the data, the turn is determined; where no data cover the rate, or
no term balances it, it is not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import words
from coeflab.core.types import Array
from coeflab.law.symbols import ANGULAR, MOTIONS
from coeflab.motion.manoeuvre import UPRIGHT
from coeflab.motion.small_motions import linearised, modes
from coeflab.motion.trajectory import covered_ranges
from coeflab.motion.vehicle import Vehicle

WITH = {
    "r": ("v", "YN", "drift"),
    "q": ("w", "ZM", "attack"),
}  # the other motion of the plane, its components, its angle
FIRST = 1e-3  # of the speed, of the disturbance that grows
FARTHEST = 50.0  # of r' or v/u: what passes it has no end
E_FOLDS = 60.0  # that are waited: 11 lead from FIRST to FARTHEST, the rest is for a turn that settles slowly
STEADY, NEAR = 1e-2, 1e-2  # the change of a steady turn in one e-fold time, its error


def _held(vehicle: Vehicle, at: Sequence[int], speed: float) -> tuple[Vehicle, Array]:
    """The vehicle with these motions free, and its velocity straight ahead."""
    nu = np.zeros(6)
    nu[0] = speed or vehicle.speed
    return replace(vehicle, free=tuple(MOTIONS[i] for i in at)), nu


class _Rates:
    """Accelerations of a few motions over those motions, all others held, controls amidships."""

    def __init__(self, vehicle: Vehicle, at: Sequence[int], speed: float) -> None:
        self.at = list(at)
        self.held, self.nu = _held(vehicle, at, speed)

    def __call__(self, small: Array) -> Array:
        moved = self.nu.copy()
        moved[self.at] = small
        upright = np.array([UPRIGHT])
        return np.asarray(self.held.acceleration(moved[None, :], upright, np.zeros((1, 3)), np.zeros(6))[0, self.at])


def linear_growth(vehicle: Vehicle, plane: Sequence[str], speed: float) -> float:
    """Largest real part of the eigenvalues of small motions about a straight course with the speed held, 1/s.

    Positive: the course is unstable, and only nonlinear terms end the growth.
    """
    at = [MOTIONS.index(m) for m in plane if m != "u" and m in vehicle.free]
    if not at:
        return 0.0
    rates = _Rates(vehicle, at, speed)
    nu = rates.nu
    scale = np.array([nu[0] / vehicle.length if MOTIONS[i] in ANGULAR else nu[0] for i in at])
    return float(modes(linearised(rates, nu[at], scale))[0].real)


@dataclass(frozen=True, slots=True)
class SettledTurn:
    """A steady turn with controls amidships and the speed held.

    Attributes
    ----------
    angle : float
        Of drift or attack, asin(v/U) or asin(w/U), rad.
    rate : float
        Primed by length and speed.
    """

    angle: float
    rate: float


def settled_turn(vehicle: Vehicle, rate: str, speed: float) -> SettledTurn | None:
    """Where a small disturbance of straight motion ends by the file's own terms; None where they do not end it.

    Parameters
    ----------
    vehicle : Vehicle
    rate : {"r", "q"}
    speed : float
        Held, m/s.
    """
    from scipy.integrate import solve_ivp
    from scipy.optimize import fsolve

    other = WITH[rate][0]
    at = [MOTIONS.index(m) for m in (other, rate) if m in vehicle.free]
    growth = linear_growth(vehicle, (other, rate), speed)
    if not at or growth <= 0.0:
        return SettledTurn(0.0, 0.0)
    rates = _Rates(vehicle, at, speed)
    ahead = float(rates.nu[0])
    scale = np.array([ahead / vehicle.length if MOTIONS[i] in ANGULAR else ahead for i in at])

    def change(_time: float, state: Array) -> Array:
        return np.asarray(rates(state * scale) / scale / growth)

    def far(_time: float, state: Array) -> float:
        return float(FARTHEST - np.max(np.abs(state)))

    far.terminal = True  # type: ignore[attr-defined]
    start = np.full(len(at), FIRST)
    start[0] = -FIRST if len(at) > 1 else FIRST  # drift outwards of the turn
    found = solve_ivp(change, (0.0, E_FOLDS), start, method="LSODA", events=far, rtol=1e-4, atol=1e-6)
    near = found.y[:, -1]
    if found.status != 0 or not np.all(np.isfinite(near)) or np.max(np.abs(change(0.0, near))) > STEADY:
        return None
    end, _, solved, _ = fsolve(lambda x: change(0.0, x), near, full_output=True)
    if solved != 1 or np.max(np.abs(end - near)) > NEAR:
        return None
    motion = dict(zip((MOTIONS[i] for i in at), end, strict=True))
    aside = abs(motion.get(other, 0.0))
    primed = float(abs(motion.get(rate, 0.0)) / np.hypot(1.0, aside))
    return SettledTurn(float(np.arctan(aside)), primed)


def speaks_of_turning(vehicle: Vehicle, rate: str, components: Sequence[str]) -> bool:
    """Whether the file has a term of second or higher degree in a rate, beyond its product with V or u, in these components."""
    return any(
        t.component in components
        and rate in t.variables
        and sum(n for v, n, _ in t.term.factors if v in ("v", "w", "p", "q", "r")) > 1
        for t in vehicle.law.terms
    )


def _within(ranges: Sequence[tuple[float, float]], value: float) -> bool:
    return any(low <= value <= high or low <= -value <= high for low, high in ranges)


@lru_cache(maxsize=8)
def open_turn(vehicle: Vehicle, rate: str, speed: float) -> Finding | None:
    """What leaves a steady turn in a rate (``r``, ``q``) undetermined once the motion leaves the data; None where nothing does.

    Nothing does where the course is stable; where the turn that an unstable one ends in lies within the data; and where
    whoever wrote the file speaks of the rate beyond first order and its terms end the turn.
    """
    other, components, called = WITH[rate]
    if linear_growth(vehicle, (other, rate), speed) <= 0.0:
        return None
    ranges = covered_ranges(vehicle)
    bare = "" if f"{rate}'" in ranges else "_bare"
    found = settled_turn(vehicle, rate, speed)
    if found is None:
        return Finding.of("turn.open", vehicle.name, Severity.WARN, case=f"endless{bare}", rate=rate)
    inside = _within(ranges.get(f"{rate}'", ()), found.rate) and _within(
        ranges.get(f"asin({other}/U)", ()), found.angle
    )
    if inside or speaks_of_turning(vehicle, rate, components):
        return None
    return Finding.of(
        "turn.open", vehicle.name, Severity.WARN, case=f"settles{bare}", rate=rate, angle=float(np.degrees(found.angle)),
        prime=found.rate, called=called,
    )  # fmt: skip


def unlimited(vehicle: Vehicle, rate: str, speed: float) -> str:
    """`open_turn` in words; empty where the turn is determined as far as the data go."""
    found = open_turn(vehicle, rate, speed)
    return "" if found is None else words(found).statement


def open_in_general(vehicle: Vehicle, rate: str) -> str:
    """The same of any law over this file's data, in words."""
    case = "data" if f"{rate}'" in covered_ranges(vehicle) else "bare"
    return words(Finding.of("turn.open", vehicle.name, Severity.WARN, case=case, rate=rate)).statement

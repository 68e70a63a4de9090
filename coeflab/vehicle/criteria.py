"""Standard criteria beside the stability indices: turning ability of the rudder, and the speed at which stern planes reverse the depth.

Turning ability, steady turn of the linear equations (Feldman 1979; Abkowitz 1964), all primed:
r'/dr = (Nv Ydr - Yv Ndr) / [Yv (Nr - xG m) - Nv (Yr - m)].

Critical speed of the stern planes, from the steady linear equations of the vertical plane at neutral buoyancy, where the plane's force and
its moment leave the depth rate at zero: U_c^2 = Zds BG W / [1/2 rho L^3 (Mw Zds - Zw Mds)]. Slower, planes to dive make it rise.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from coeflab.core.types import Array
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import DRAWS, SEED, Derived, derived

TURNING, REVERSAL = "r'/dr", "U_c [m/s]"
RUDDER, PLANES = ("Yv'", "Nv'", "Yr'", "Nr'", "Ydr'", "Ndr'"), ("Zw'", "Mw'", "Zds'", "Mds'")
NEUTRAL = 0.005  # of the weight: with more apart the planes also carry the difference
STEP = 1e-6


def turning_ability(coefficients: Array, mass: float, mass_moment: float) -> Array:
    """Rate r' of a steady turn by radian of rudder from (.., 6) `RUDDER`, m' and xG'm'."""
    yv, nv, yr, nr, yd, nd = np.moveaxis(np.asarray(coefficients, dtype=float), -1, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((nv * yd - yv * nd) / (yv * (nr - mass_moment) - nv * (yr - mass)))


def reversal_speed(coefficients: Array, righting: float) -> Array:
    """U_c from (.., 4) `PLANES` and BG W / (1/2 rho L^3), m^2/s^2; not a number where the planes act one way at every speed."""
    zw, mw, zd, md = np.moveaxis(np.asarray(coefficients, dtype=float), -1, 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.sqrt(zd * righting / (mw * zd - zw * md)))


def criteria(parameters: ParameterFile, draws: int = DRAWS, seed: int = SEED) -> tuple[Derived, ...]:
    """Turning ability and critical speed, of which the file has mass, derivatives and, for the speed, hydrostatics."""
    mass, out = parameters.mass, []
    if mass is None:
        return ()
    moment, prime = mass.mass_moment_prime, mass.mass_prime

    def turns(x: Array) -> Array:
        return turning_ability(x, prime, moment)

    found = _derived(parameters, TURNING, RUDDER, turns, draws, seed)
    out += [] if found is None else [found]
    h = parameters.hydrostatics
    if h is not None:
        weight, buoyancy = mass.mass * h.gravity, parameters.conditions.density * h.gravity * h.volume
        righting = weight * float(mass.centre_of_gravity[2]) - buoyancy * h.centre_of_buoyancy[2]
        scale = 0.5 * parameters.conditions.density * parameters.scaling.length**3
        if abs(weight - buoyancy) <= NEUTRAL * weight and righting > 0.0:
            found = _derived(parameters, REVERSAL, PLANES, lambda x: reversal_speed(x, righting / scale), draws, seed)
            out += [] if found is None or not np.isfinite(found.value) else [found]
    return tuple(out)


def _derived(
    parameters: ParameterFile,
    name: str,
    symbols: Sequence[str],
    function: Callable[[Array], Array],
    draws: int,
    seed: int,
) -> Derived | None:
    chosen = [c for s in symbols if (c := parameters.coefficient(s)) is not None and c.value is not None]
    if len(chosen) < len(symbols):
        return None
    values = np.array([float(c.value or 0.0) for c in chosen])
    place = {s: i for i, s in enumerate(parameters.covariance.symbols)}
    rows = [place.get(c.symbol) for c in chosen]
    cells = [[None if i is None or j is None else parameters.covariance.matrix[i][j] for j in rows] for i in rows]
    whole = np.array([[np.nan if v is None else v for v in row] for row in cells])
    steps = np.diag(STEP * np.maximum(np.abs(values), STEP))
    gradient = (function(values + steps) - function(values - steps)) / (2.0 * np.diag(steps))
    value = float(function(values))
    return derived(
        name, parameters.name, value, lambda d: function(values + d), gradient, whole, (), symbols, draws, seed
    )

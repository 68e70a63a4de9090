"""G_h and G_v of draws."""

from __future__ import annotations

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.uncertainty.propagation import reaches_zero
from coeflab.motion.manoeuvre import Figure
from coeflab.motion.uncertainty.draws import Uncertain
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import INDICES, stability_index

DEFINITIONS = {
    "G_h": "1 - Nv'(Yr' - m')/[Yv'(Nr' - xG'm')], positive: stable on a straight course (Feldman 1979)",
    "G_v": "1 - Mw'(Zq' + m')/[Zw'(Mq' - xG'm')], positive: stable in the vertical plane at high speed (Feldman 1979)",
}


def drawn_stability(
    parameters: ParameterFile, varied: Uncertain, deviations: Array
) -> dict[str, tuple[Figure, Array, str]]:
    """Name to the index at the file's values, its values at the draws (n,), and why it has no interval, in words.

    The rules are those of `coeflab.vehicle.stability.stability`: every coefficient in it needs an uncertainty, and no denominator may
    reach zero.

    Parameters
    ----------
    parameters : ParameterFile
        Planes without mass or without all four coefficients are left out.
    varied : Uncertain
    deviations : (n, k) array
    """
    out = {}
    for name, (*symbols, sign) in INDICES.items():
        found = [c for s in symbols if (c := parameters.coefficient(str(s))) is not None and c.value is not None]
        if parameters.mass is None or len(found) < len(symbols):
            continue
        values = [float(c.value or 0.0) for c in found]
        at = [varied.symbols.index(c.symbol) if c.symbol in varied.symbols else None for c in found]
        mass, moment = float(sign) * parameters.mass.mass_prime, parameters.mass.mass_moment_prime
        deviation = np.column_stack([np.zeros(len(deviations)) if k is None else deviations[:, k] for k in at])
        nominal, *rows = _index(np.vstack([np.zeros(4), deviation]) + values, mass, moment)
        figure = Figure(name, float(nominal) if np.isfinite(nominal) else None, "1", DEFINITIONS[name])
        out[name] = figure, np.array(rows), _why(found[0].symbol, found[3].symbol, values, at, varied, moment)
    return out


def _index(values: Array, mass: float, moment: float) -> Array:
    force_slope, moment_slope, force_rate, moment_rate = values.T
    with np.errstate(divide="ignore", invalid="ignore"):
        return stability_index(force_slope, moment_slope, force_rate, moment_rate, mass, moment)


def _why(
    force: str, moment_rate: str, values: list[float], at: list[int | None], varied: Uncertain, moment: float
) -> str:
    if None in at:
        return "a coefficient in it has no U95"
    half = [0.0 if k is None else 2.0 * float(varied.deviation[k]) for k in at]
    for label, size, u95 in ((force, values[0], half[0]), (f"{moment_rate} - xG'm'", values[3] - moment, half[3])):
        if reaches_zero(size, u95):
            return f"the interval of the denominator {label} = {size:.3g} +- {u95:.2g} contains zero"
    return ""

"""An ensemble out of one vehicle and draws of its parameter file, and which draws a manoeuvre does not feel."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.kernels.motion_law import WIND
from coeflab.model.ensemble import Ensemble
from coeflab.model.motion_terms import MotionTerm
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.vehicle import Vehicle

Array = NDArray[np.float64]
VELOCITY_OF = {"alpha": "w", "beta": "v"}


def drawn(
    vehicle: Vehicle, parameters: ParameterFile, symbols: Sequence[str], deviations: Array, measured: bool = True
) -> Ensemble:
    """Members whose coefficients and acceleration derivatives deviate.

    Parameters
    ----------
    vehicle : Vehicle
        Of ``parameters``.
    parameters : ParameterFile
    symbols : sequence of str
        Of the columns of ``deviations``, as in `coeflab.model.draws.Uncertain`.
    deviations : (m, k) array
        In the units of the file.
    measured : bool
        Whether measured acceleration derivatives stand in the added mass.

    Raises
    ------
    InputError
        A member whose effective mass is not positive definite.
    """
    columns = {s: k for k, s in enumerate(symbols)}
    coefficients = np.repeat(vehicle.law.coefficient[None], len(deviations), axis=0)
    for row, t in enumerate(vehicle.terms):
        if t.symbol in columns:
            coefficients[:, row] += t.per_prime * deviations[:, columns[t.symbol]]
    return Ensemble(vehicle, coefficients, added=_added(vehicle, parameters, symbols, deviations, measured))


def _added(
    vehicle: Vehicle, parameters: ParameterFile, symbols: Sequence[str], deviations: Array, measured: bool
) -> Array | None:
    """(m, 6, 6); an entry that the file states only on one side of the diagonal moves on both."""
    if parameters.added_mass is not None and not measured:
        return None
    stated = {at for c in parameters.coefficients if c.value is not None and (at := _entry(c.symbol)) is not None}
    moved = [(k, at, s) for k, s in enumerate(symbols) if (at := _entry(s)) is not None]
    if not moved:
        return None
    out = np.repeat(vehicle.added[None], len(deviations), axis=0)
    for k, (i, j), s in moved:
        change = -deviations[:, k] * 0.5 * vehicle.density * vehicle.length ** derivative(s).powers[1]
        out[:, i, j] += change
        if i != j and (j, i) not in stated:
            out[:, j, i] += change
    return out


def _entry(symbol: str) -> tuple[int, int] | None:
    """Row and column of an acceleration derivative in the added mass; None for anything else."""
    if " " in symbol:
        return None
    d = derivative(symbol)
    if len(d.factors) != 1 or not d.factors[0].endswith("dot"):
        return None
    return COMPONENTS.index(d.component), MOTIONS.index(d.factors[0].removesuffix("dot"))


def unfelt(vehicle: Vehicle, symbols: Sequence[str], ordered: Collection[str], measured: bool = True) -> frozenset[str]:
    """Symbols that cannot change the motion: of held motions, of controls that are never moved, of terms that are not in the law.

    Parameters
    ----------
    vehicle : Vehicle
        Held motions are taken to be zero, apart from u.
    symbols : sequence of str
    ordered : collection of str
        Controls that the manoeuvre moves.
    measured : bool
    """
    terms = {t.symbol: t for t in vehicle.terms}
    still = ({*MOTIONS} - {*vehicle.free, "u"}) | ({*CONTROLS} - {*ordered})
    out = set()
    for s in symbols:
        at = _entry(s)
        if at is not None:
            felt = measured and all(MOTIONS[i] in vehicle.free for i in at)
        else:
            felt = s in terms and _acts(terms[s], vehicle, still)
        if not felt:
            out.add(s)
    return frozenset(out)


def _acts(term: MotionTerm, vehicle: Vehicle, still: Collection[str]) -> bool:
    if any(VELOCITY_OF.get(v[0], v[0]) in still for v, _, _ in term.factors):
        return False
    return term.component in WIND or MOTIONS[COMPONENTS.index(term.component)] in vehicle.free

"""An ensemble out of one vehicle and draws of its parameter file, and which draws a manoeuvre does not feel."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.kernels.kirchhoff import ideal_quadratics
from coeflab.kernels.motion_law import WIND
from coeflab.model.ensemble import Ensemble
from coeflab.model.inertia import MEASURED, entry_of, stated_accelerations
from coeflab.model.motion_terms import MotionTerm, open_places
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.vehicle import Vehicle

Array = NDArray[np.float64]
VELOCITY_OF = {"alpha": "w", "beta": "v"}


def drawn(
    vehicle: Vehicle, parameters: ParameterFile, symbols: Sequence[str], deviations: Array, tables: bool = False
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
    tables : bool
        Whether fitted tables come before derivatives in the vehicle.

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
    change = _added(vehicle, parameters, symbols, deviations)
    if change is None:
        return Ensemble(vehicle, coefficients)
    ideal = None
    if parameters.added_mass is not None:
        unspoken = open_places(parameters, tables)
        ideal = vehicle.law.ideal + np.array([np.where(unspoken, ideal_quadratics(c), 0.0) for c in change])
    return Ensemble(vehicle, coefficients, added=vehicle.added + change, ideal=ideal)


def _added(vehicle: Vehicle, parameters: ParameterFile, symbols: Sequence[str], deviations: Array) -> Array | None:
    """(m, 6, 6) change of the added mass, by half where the file states an entry on both sides of the diagonal; None where
    no draw is felt in it.
    """
    if vehicle.water.used != MEASURED:
        return None
    stated = stated_accelerations(parameters)
    moved = [(k, at, s) for k, s in enumerate(symbols) if (at := entry_of(s)) is not None]
    if not moved:
        return None
    out = np.zeros((len(deviations), 6, 6))
    for k, (i, j), s in moved:
        change = -deviations[:, k] * 0.5 * vehicle.density * vehicle.length ** derivative(s).powers[1]
        share = 0.5 if i != j and (j, i) in stated else 1.0
        out[:, i, j] += share * change
        if i != j:
            out[:, j, i] += share * change
    return out


def unfelt(vehicle: Vehicle, symbols: Sequence[str], ordered: Collection[str]) -> frozenset[str]:
    """Symbols that cannot change the motion: of held motions, of controls that are never moved, of terms that are not in the law.

    Parameters
    ----------
    vehicle : Vehicle
        Held motions are taken to be zero, apart from u.
    symbols : sequence of str
    ordered : collection of str
        Controls that the manoeuvre moves.
    """
    terms = {t.symbol: t for t in vehicle.terms}
    still = ({*MOTIONS} - {*vehicle.free, "u"}) | ({*CONTROLS} - {*ordered})
    out = set()
    for s in symbols:
        at = entry_of(s)
        if at is not None:
            felt = vehicle.water.used == MEASURED and all(MOTIONS[i] in vehicle.free for i in at)
        else:
            felt = s in terms and _acts(terms[s], vehicle, still)
        if not felt:
            out.add(s)
    return frozenset(out)


def _acts(term: MotionTerm, vehicle: Vehicle, still: Collection[str]) -> bool:
    if any(VELOCITY_OF.get(v[0], v[0]) in still for v, _, _ in term.factors):
        return False
    return term.component in WIND or MOTIONS[COMPONENTS.index(term.component)] in vehicle.free

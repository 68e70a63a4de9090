"""An ensemble out of one vehicle and draws of its parameter file, and which draws a manoeuvre does not feel."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from coeflab.core.types import Array
from coeflab.law.force_law import WIND, ForceTerm
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.symbols import COMPONENTS, CONTROLS, MOTIONS
from coeflab.motion.ensemble import Ensemble
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.force_law import sources_of
from coeflab.vehicle.inertia import MEASURED, entry_of, stated_accelerations
from coeflab.vehicle.parameter_file import ParameterFile

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
        Of the columns of ``deviations``, as in `coeflab.motion.uncertainty.draws.Uncertain`.
    deviations : (m, k) array
        In the units of the file.
    tables : bool
        Whether fitted tables come first in the vehicle.

    Raises
    ------
    InputError
        A member whose effective mass is not positive definite.
    """
    columns = {s: k for k, s in enumerate(symbols)}
    coefficients = np.repeat(vehicle.law.coefficient[None], len(deviations), axis=0)
    for row, t in enumerate(vehicle.law.terms):
        if t.in_file in columns:
            coefficients[:, row] += t.per_prime * deviations[:, columns[t.in_file]]
    change = _added(vehicle, parameters, symbols, deviations)
    if change is None:
        return Ensemble(vehicle, coefficients)
    ideal = None
    if parameters.added_mass is not None:
        open_products = sources_of(parameters, tables).open_products()
        ideal = vehicle.law.ideal + np.array([np.where(open_products, ideal_quadratics(c), 0.0) for c in change])
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
        change = -deviations[:, k] * parameters.scaling.unit(s, vehicle.density)
        share = 0.5 if i != j and (j, i) in stated else 1.0
        out[:, i, j] += share * change
        if i != j:
            out[:, j, i] += share * change
    return out


def unfelt(
    vehicle: Vehicle, symbols: Sequence[str], ordered: Collection[str], resting: Collection[str] = ()
) -> frozenset[str]:
    """Symbols that cannot change the motion: of held motions, of controls that are never moved, of terms that are not in the law.

    Parameters
    ----------
    vehicle : Vehicle
        Held motions are taken to be zero, apart from u.
    symbols : sequence of str
    ordered : collection of str
        Controls that the manoeuvre moves.
    resting : collection of str
        Free motions that do not occur, whatever the draw: v and r of a straight run.
    """
    terms = {t.in_file: t for t in vehicle.law.terms}
    still = ({*MOTIONS} - {*vehicle.free, "u"}) | ({*CONTROLS} - {*ordered}) | {*resting}
    out = set()
    for s in symbols:
        at = entry_of(s)
        if at is not None:
            felt = vehicle.water.used == MEASURED and all(
                MOTIONS[i] in vehicle.free and MOTIONS[i] not in resting for i in at
            )
        else:
            felt = s in terms and _acts(terms[s], vehicle, still)
        if not felt:
            out.add(s)
    return frozenset(out)


def _acts(term: ForceTerm, vehicle: Vehicle, still: Collection[str]) -> bool:
    if any(VELOCITY_OF.get(v, v) in still for v in term.variables):
        return False
    return term.component in WIND or MOTIONS[COMPONENTS.index(term.component)] in vehicle.free

"""Coefficients of somebody's model of second order: what its numbers mean as totals under SNAME names."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, MOTIONS, derivative
from coeflab.kernels.kirchhoff import ideal_quadratics
from coeflab.kernels.rigid_body import inertia_doubt
from coeflab.kernels.transforms import skew
from coeflab.model.scaling import Conditions, Scaling
from coeflab.model.second_order import ACROSS, ROUNDING, SURGE, SecondOrder, products_once
from coeflab.model.stated_file import Law, StatedMass, matrix_doubts

Array = NDArray[np.float64]
Coefficients = dict[str, tuple[float, Law]]


def kept_matrix(matrix: Array) -> Array | None:
    """The matrix where it can be an added mass; None where it is zero or no kinetic energy."""
    return matrix if np.any(matrix) and not matrix_doubts(matrix) else None


def stated_coefficients(
    form: SecondOrder, added: Array, matrix: Array, scaling: Scaling, conditions: Conditions
) -> Coefficients:
    """Primed values of a model in FRD.

    Parameters
    ----------
    form : SecondOrder
        What the file writes.
    added : (6, 6, 6) array
        Quadratics that its simulator adds itself, symmetric in the last two axes.
    matrix : (6, 6) array
        Its added mass. Where that is no kinetic energy its entries become acceleration derivatives.
    scaling : Scaling
    conditions : Conditions
        What the values are primed by.

    Notes
    -----
    |u| v is read as the first-order derivative Yv, total with what the simulator adds, unless the file has damping at rest of
    the same name too; then it keeps its bars. What the form calls its resistance is read as X0, taken
    from u|u|, v^2 and w^2. A product that is just the ideal fluid's is left to the added
    mass.
    """
    kept = kept_matrix(matrix)
    ideal = np.zeros((6, 6, 6)) if kept is None else products_once(ideal_quadratics(kept))
    own = products_once(added)
    half = 0.5 * conditions.density
    out: Coefficients = {}
    signed, absolute = form.signed.copy(), form.absolute.copy()

    def motion(symbol: str, value: float) -> None:
        out[symbol] = (float(value / (half * scaling.length ** derivative(symbol).powers[1])), "motion")

    for i, j in np.argwhere(form.linear):
        symbol = COMPONENTS[i] + MOTIONS[j]
        out[symbol] = (float(form.linear[i, j] / scaling.factor(symbol, conditions)), "rest")
    if form.resistance:
        motion("X0", form.resistance)
        _take(absolute[SURGE, SURGE, SURGE:], form.resistance)
        for across in ACROSS:
            _take(signed[SURGE, across, across:], form.resistance)
    for i, j, k in np.argwhere(absolute):
        name = COMPONENTS[i] + MOTIONS[j]
        if k == SURGE and j != SURGE and name not in out:
            motion(name, absolute[i, j, k] + own[i, SURGE, j])
            own[i, SURGE, j] = ideal[i, SURGE, j] = 0.0
        else:
            motion(f"{name}|{MOTIONS[k]}|", absolute[i, j, k])
    total = signed + own
    apart = np.abs(total - ideal) > ROUNDING * np.maximum(np.abs(total), np.abs(ideal))
    for i, j, k in np.argwhere(apart):
        motion(COMPONENTS[i] + MOTIONS[j] + MOTIONS[k], total[i, j, k])
    if kept is None:
        for i, j in np.argwhere((matrix != 0.0) | (matrix.T != 0.0)):
            motion(f"{COMPONENTS[i]}{MOTIONS[j]}dot", 0.0 - matrix[i, j])
    return out


def _take(row: Array, part: float) -> None:
    """Take a part from the first entry of a row; what rounding leaves is zero."""
    left = row[0] - part
    row[0] = 0.0 if abs(left) <= ROUNDING * abs(part) else left


def stated_mass(mass: float | None, centre: Array, inertia: Array | None, notes: list[str]) -> StatedMass | None:
    """Mass properties about the link's origin, FRD.

    Parameters
    ----------
    mass : float or None
    centre : (3,) array
        From the link's origin.
    inertia : (3, 3) array or None
        About the centre of gravity; left out, with a note, where no body has it.
    notes : list of str
        Is added to.
    """
    if mass is None or mass <= 0.0:
        return None
    about = None
    if inertia is not None:
        arm = skew(centre)
        about = inertia - mass * arm @ arm
        doubt = inertia_doubt(mass, centre, about)
        if doubt:
            notes.append(f"moments of inertia left out: {doubt}")
            about = None
    equal = about is not None and abs(about[1, 1] - about[2, 2]) <= 1e-9 * abs(about[1, 1])
    transverse = float(about[1, 1]) if about is not None and equal else None
    return StatedMass(mass, mass * float(centre[0]), transverse, centre, about)

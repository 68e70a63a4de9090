"""Coefficients of somebody's model of second order: what its numbers mean as totals under SNAME names."""

from __future__ import annotations

import numpy as np

from coeflab.core.types import Array
from coeflab.formats.stated_file import Law
from coeflab.law.definiteness import definiteness
from coeflab.law.rigid_body import ideal_quadratics
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import COMPONENTS, MOTIONS
from coeflab.vehicle.second_order import ACROSS, ROUNDING, SURGE, SecondOrder, products_once

ROUNDED = 1e-3  # of the diagonal: numbers of four digits that mean one


def but_for_rounding(matrix: Array) -> Array:
    """The mean of a matrix and its mirror image where both are equal to the digits that people write; else as it is."""
    root = np.sqrt(np.abs(np.diag(matrix)))
    scale = np.maximum(np.outer(root, root), np.maximum(np.abs(matrix), np.abs(matrix.T)))
    alike = np.abs(matrix - matrix.T) <= ROUNDED * scale
    return np.asarray((matrix + matrix.T) / 2.0 if np.all(alike) else matrix)


def matrix_doubts(matrix: Array) -> tuple[str, ...]:
    """What is wrong with an added mass (6, 6) about one point, in words; empty where it can be a kinetic energy."""
    matrix = but_for_rounding(matrix)
    found = definiteness(matrix)
    if found.holds:
        return ()
    doubts = []
    pairs = [
        f"{COMPONENTS[i]}{MOTIONS[j]}dot {-matrix[i, j]:g} against {COMPONENTS[j]}{MOTIONS[i]}dot {-matrix[j, i]:g}"
        for i in range(6)
        for j in range(i + 1, 6)
        if abs(matrix[i, j] - matrix[j, i]) > 1e-9 * max(abs(matrix[i, j]), abs(matrix[j, i]))
    ]
    if pairs:
        doubts.append(f"the added mass is not symmetric: {', '.join(pairs)}")
    negative = [f"{COMPONENTS[i]}{MOTIONS[i]}dot {-matrix[i, i]:g}" for i in range(6) if matrix[i, i] < 0.0]
    if negative:
        doubts.append(f"negative added mass: {', '.join(negative)} must not be above zero")
    elif not np.isfinite(found.smallest) or found.smallest < 0.0:
        doubts.append("the added mass is not positive definite: an off-diagonal entry is too large for its diagonals")
    return tuple(doubts)


Coefficients = dict[str, tuple[float, Law]]


def valid_matrix(matrix: Array) -> Array | None:
    """The matrix where it can be an added mass; None where it is zero or no kinetic energy."""
    return but_for_rounding(matrix) if np.any(matrix) and not matrix_doubts(matrix) else None


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
        Its added mass. Where that is asymmetric or not positive its entries become acceleration derivatives.
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
    selected = valid_matrix(matrix)
    ideal = np.zeros((6, 6, 6)) if selected is None else products_once(ideal_quadratics(selected))
    own = products_once(added)
    out: Coefficients = {}
    signed, absolute = form.signed.copy(), form.absolute.copy()

    def motion(symbol: str, value: float) -> None:
        out[symbol] = (float(value / scaling.unit(symbol, conditions.density)), "motion")

    for i, j in np.argwhere(form.linear):
        symbol = COMPONENTS[i] + MOTIONS[j]
        out[symbol] = (float(form.linear[i, j] / scaling.unit(symbol, conditions.density, conditions.speed)), "rest")
    if form.resistance:
        motion("X0", form.resistance)
        _subtract_from_first(absolute[SURGE, SURGE, SURGE:], form.resistance)
        for across in ACROSS:
            _subtract_from_first(signed[SURGE, across, across:], form.resistance)
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
    if selected is None:
        for i, j in np.argwhere((matrix != 0.0) | (matrix.T != 0.0)):
            motion(f"{COMPONENTS[i]}{MOTIONS[j]}dot", 0.0 - matrix[i, j])
    return out


def _subtract_from_first(row: Array, part: float) -> None:
    """Take a part from the first entry of a row; what rounding leaves is zero."""
    left = row[0] - part
    row[0] = 0.0 if abs(left) <= ROUNDING * abs(part) else left

"""Whether a stated added mass can be that of a body in water."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.law.definiteness import ROUNDING, definiteness
from coeflab.law.symbols import COMPONENTS, MOTIONS, derivative
from coeflab.vehicle import imported_numbers

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.vehicle.parameter_file import ParameterFile


X_APART = "The law of X ends before these points. X does not limit exports and motions; the other components do."
CHANGED = 1e-6  # of the largest force: far above rounding, far below what any digit of a coefficient is worth
MISTYPED = 0.05  # asymmetry of one wrong digit; more is another convention
HEAVY = 5.0  # of the mass: a disc or plate in a vehicle's place
LIGHT = 0.15  # of the mass, across: a ball has 0.5
SMALLEST_PRIME = 1e-5  # of 1/2 rho L^3: a cylinder 400 diameters long
PROBE = 0.05
NAME, LAW = "plausibility", "law at points"


def stated_matrix(parameters: ParameterFile) -> Array:
    """Added mass (6, 6) as stated, SI; NaN where nothing is."""
    density = parameters.conditions.density
    if parameters.added_mass is not None:
        return np.array(parameters.added_mass.matrix) * (density / parameters.added_mass.density)
    out = np.full((6, 6), np.nan)
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is not None and len(d.factors) == 1 and d.factors[0].endswith("dot"):
            at = COMPONENTS.index(d.component), MOTIONS.index(d.factors[0][0])
            out[at] = 0.0 - c.value * parameters.scaling.unit(d.text, density)
    return out


def added_mass_findings(p: ParameterFile, signs: str = "") -> list[Check]:
    """Zeros, signs, symmetry, definiteness and size; at least one finding. ``signs`` as in `plausibility`."""
    stated = stated_matrix(p)
    if not np.any(np.nan_to_num(stated)):
        return [Check.of("plausibility.no_added_mass", "added mass", Severity.WARN)]
    matrix = np.nan_to_num(np.where(np.isnan(stated), stated.T, stated))
    out = _diagonal(np.diag(stated), signs)
    unknown = np.isnan(np.diag(stated)) & np.any(matrix, axis=1)
    if np.any(unknown):
        out.append(Check.of("plausibility.no_diagonal", "M_A", Severity.WARN, unknown=_names(unknown)))
        matrix = np.where(unknown[:, None] | unknown, 0.0, matrix)
    out += _asymmetry(matrix)
    found = definiteness((matrix + matrix.T) / 2.0)
    if np.all(np.diag(matrix) >= 0.0) and found.smallest < -ROUNDING:
        least = "without a bound" if np.isinf(found.smallest) else f"{found.smallest:.3g}"
        out.append(Check.of("plausibility.not_definite", "M_A", Severity.FAIL, least=least))
    elif not out:
        out.append(Check.of("plausibility.definite", "M_A", Severity.PASS, smallest=found.smallest))
    return out + _size(p, np.diag(matrix)[:3])


def _names(which: NDArray[np.bool_]) -> str:
    return ", ".join(f"{COMPONENTS[i]}{MOTIONS[i]}" for i in np.flatnonzero(which))


def _diagonal(stated: Array, signs: str) -> list[Check]:
    out = []
    negative = np.nan_to_num(stated) < 0.0
    if np.any(negative):
        values = ", ".join(f"{x:.4g}" for x in stated[negative])
        facts = {"values": values, "signs": f" {signs}".rstrip()}
        out.append(Check.of("plausibility.negative_diagonal", f"M_A {_names(negative)}", Severity.FAIL, **facts))
    across = (stated == 0.0) & (np.arange(6) < 3)
    if np.any(across):
        out.append(Check.of("plausibility.zero_diagonal", f"M_A {_names(across)}", Severity.WARN))
    return out


def _size(p: ParameterFile, diagonal: Array) -> list[Check]:
    out = []
    prime = float(np.max(diagonal[1:])) / p.scaling.unit("m", p.conditions.density)
    if p.scaling.length_name != "1 m" and 0.0 < prime < SMALLEST_PRIME:
        out.append(
            Check.of("plausibility.small_prime", "M_A Yv, Zw", Severity.FAIL, statistic=prime, threshold=SMALLEST_PRIME)
        )
    if p.mass is not None and (heaviest := float(np.max(diagonal))) > HEAVY * p.mass.mass:
        share = heaviest / p.mass.mass
        out.append(Check.of("plausibility.heavy", "M_A", Severity.WARN, statistic=share, threshold=HEAVY))
    across = diagonal[1:][diagonal[1:] > 0.0]
    if p.mass is not None and across.size and not in_air(p) and (share := float(np.max(across)) / p.mass.mass) < LIGHT:
        out.append(Check.of("plausibility.small_across", "M_A Yv, Zw", Severity.WARN, share=share, light=LIGHT))
    return out


def _asymmetry(matrix: Array) -> list[Check]:
    out = []
    root = np.sqrt(np.abs(np.diag(matrix)))
    for i, j in np.argwhere(np.triu(matrix != matrix.T)):
        scale = root[i] * root[j] or max(abs(matrix[i, j]), abs(matrix[j, i]))
        apart = abs(matrix[i, j] - matrix[j, i]) / scale
        if apart > ROUNDING:
            severity = Severity.WARN if apart <= MISTYPED else Severity.FAIL
            pair = f"M_A {COMPONENTS[i]}{MOTIONS[j]} and {COMPONENTS[j]}{MOTIONS[i]}"
            entries = {"one": matrix[i, j], "other": matrix[j, i]}
            out.append(Check.of("plausibility.asymmetric", pair, severity, statistic=apart, **entries))
    return out


def in_air(p: ParameterFile) -> bool:
    """A density of air, and no added mass of water."""
    densities = [p.conditions.density] + ([] if p.added_mass is None else [p.added_mass.density])
    return all(imported_numbers.AIR[0] < density <= imported_numbers.AIR[1] for density in densities)

"""Whether a stated added mass can be that of a body in water."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, MOTIONS, derivative
from coeflab.kernels.composition import ROUNDING, definiteness
from coeflab.model.check import Check, Severity
from coeflab.model.parameter_file import ParameterFile

Array = NDArray[np.float64]
MISTYPED = 0.05  # asymmetry of one wrong digit; more is another convention
HEAVY = 5.0  # of the mass: a disc or plate in a vehicle's place
SMALLEST_PRIME = 1e-5  # of 1/2 rho L^3: a cylinder 400 diameters long
NAME = "plausibility"


def stated_matrix(parameters: ParameterFile) -> Array:
    """Added mass (6, 6) as stated, SI; NaN where nothing is."""
    density, length = parameters.conditions.density, parameters.scaling.length
    if parameters.added_mass is not None:
        return np.array(parameters.added_mass.matrix) * (density / parameters.added_mass.density)
    out = np.full((6, 6), np.nan)
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is not None and len(d.factors) == 1 and d.factors[0].endswith("dot"):
            at = COMPONENTS.index(d.component), MOTIONS.index(d.factors[0][0])
            out[at] = 0.0 - c.value * 0.5 * density * length ** d.powers[1]
    return out


def added_mass_findings(p: ParameterFile) -> list[Check]:
    """Zeros, signs, symmetry, definiteness and size; at least one finding."""
    stated = stated_matrix(p)
    if not np.any(np.nan_to_num(stated)):
        return [_check("added mass", Severity.WARN, "none", "a matrix", "The body accelerates as if in air.")]
    matrix = np.nan_to_num(np.where(np.isnan(stated), stated.T, stated))
    out = _diagonal(np.diag(stated))
    unknown = np.isnan(np.diag(stated)) & np.any(matrix, axis=1)
    if np.any(unknown):
        out.append(_check("M_A", Severity.WARN, f"no {_names(unknown)}", "a diagonal beside its products",
                          "Its products cannot be used."))  # fmt: skip
        matrix = np.where(unknown[:, None] | unknown, 0.0, matrix)
    out += _asymmetry(matrix)
    found = definiteness((matrix + matrix.T) / 2.0)
    if np.all(np.diag(matrix) >= 0.0) and found.smallest < -ROUNDING:
        least = "without a bound" if np.isinf(found.smallest) else f"{found.smallest:.3g}"
        out.append(_check("M_A", Severity.FAIL, f"smallest scaled eigenvalue {least}", "not below zero",
                          "No kinetic energy: a product entry is too large for its diagonals."))  # fmt: skip
    elif not out:
        out.append(_check("M_A", Severity.PASS, f"smallest scaled eigenvalue {found.smallest:.3g}",
                          "symmetric, not below zero"))  # fmt: skip
    return out + _size(p, np.diag(matrix)[:3])


def _check(subject: str, severity: Severity, statistic: str, rule: str, comment: str = "") -> Check:
    return Check(NAME, subject, severity, statistic, rule, comment)


def _names(which: NDArray[np.bool_]) -> str:
    return ", ".join(f"{COMPONENTS[i]}{MOTIONS[i]}" for i in np.flatnonzero(which))


def _diagonal(stated: Array) -> list[Check]:
    out = []
    negative = np.nan_to_num(stated) < 0.0
    if np.any(negative):
        values = ", ".join(f"{x:.4g}" for x in stated[negative])
        out.append(_check(f"M_A {_names(negative)}", Severity.FAIL, values, "not below zero",
                          "Acceleration derivatives are the negatives of added masses: a sign is wrong."))  # fmt: skip
    across = (stated == 0.0) & (np.arange(6) < 3)
    if np.any(across):
        out.append(_check(f"M_A {_names(across)}", Severity.WARN, "0", "above zero",
                          "The body accelerates in this direction as if in air."))  # fmt: skip
    return out


def _size(p: ParameterFile, diagonal: Array) -> list[Check]:
    out = []
    prime = float(np.max(diagonal[1:])) / (0.5 * p.conditions.density * p.scaling.length**3)
    if p.scaling.length_name != "1 m" and 0.0 < prime < SMALLEST_PRIME:
        out.append(_check("M_A Yv, Zw", Severity.FAIL, f"{prime:.1e} of 1/2 rho L^3", f"at least {SMALLEST_PRIME:g}",
                          "Primes read as SI? Convert them; in a .m file r3 = rho*L^3/2 tells that they are primes."))  # fmt: skip
    if p.mass is not None and (heaviest := float(np.max(diagonal))) > HEAVY * p.mass.mass:
        out.append(_check("M_A", Severity.WARN, f"{heaviest / p.mass.mass:.3g} of the mass", f"at most {HEAVY:g}",
                          "Usual for flat bodies only."))  # fmt: skip
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
            out.append(_check(pair, severity, f"{matrix[i, j]:.8g} and {matrix[j, i]:.8g}", "equal",
                              f"Apart by {apart:.1e} of the diagonal. An added mass is symmetric."))  # fmt: skip
    return out

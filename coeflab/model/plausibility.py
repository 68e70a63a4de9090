"""Whether the numbers of a parameter file can be those of a body in water: units, added mass, signs of the damping."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, MOTIONS, derivative, primed
from coeflab.kernels.composition import ROUNDING, definiteness
from coeflab.model.check import Check, Severity
from coeflab.model.force_law import force_law
from coeflab.model.parameter_file import ParameterFile

Array = NDArray[np.float64]
WATER = (950.0, 1100.0)
SLUGS, POUNDS = (1.9, 2.1), (60.0, 66.0)
SLENDER = (0.05, 3.0)
MISTYPED = 0.05
HEAVY = 5.0
NAME = "plausibility"
GYRATION = "radius of gyration of the added mass over the cube root of the displacement"


def plausibility(parameters: ParameterFile) -> tuple[Check, ...]:
    """Findings in the order units, added mass, damping; every question that could be asked has at least one."""
    return (*_units(parameters), *_added_mass(parameters), *_damping(parameters))


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
            out[at] = -c.value * 0.5 * density * length ** d.powers[1]
    return out


def _check(subject: str, severity: Severity, statistic: str, rule: str, comment: str = "") -> Check:
    return Check(NAME, subject, severity, statistic, rule, comment)


def _units(p: ParameterFile) -> list[Check]:
    density, rule = p.conditions.density, f"{WATER[0]:g} to {WATER[1]:g} kg/m^3"
    imperial = SLUGS[0] < density < SLUGS[1] or POUNDS[0] < density < POUNDS[1]
    good = WATER[0] <= density <= WATER[1]
    comment = "" if good else "Slug or pound and foot: convert to SI." if imperial else "No density of water in kg/m^3."
    out = [_check("density", Severity.PASS if good else Severity.FAIL, f"{density:g}", rule, comment)]
    diagonal = np.nan_to_num(np.diag(stated_matrix(p)))
    if p.mass is not None and diagonal[1] > 0.0 and diagonal[5] > 0.0:
        ratio = float(np.sqrt(diagonal[5] / diagonal[1]) / np.cbrt(p.mass.mass / density))
        good = SLENDER[0] <= ratio <= SLENDER[1]
        comment = "" if good else "Masses and moments are not of one system of units (kg and m)."
        out.append(_check(GYRATION, Severity.PASS if good else Severity.FAIL, f"{ratio:.3g}",
                          f"{SLENDER[0]:g} to {SLENDER[1]:g}", comment))  # fmt: skip
    return out


def _added_mass(p: ParameterFile) -> list[Check]:
    stated = stated_matrix(p)
    if not np.any(np.nan_to_num(stated)):
        return [_check("added mass", Severity.WARN, "none", "a matrix", "The body accelerates as if in air.")]
    matrix = np.nan_to_num(np.where(np.isnan(stated), stated.T, stated))
    out = []
    for i in range(6):
        if matrix[i, i] < 0.0:
            out.append(_check(f"M_A {COMPONENTS[i]}{MOTIONS[i]}", Severity.FAIL, f"{matrix[i, i]:.4g}", "not below zero",
                              "Acceleration derivatives are the negatives of added masses: a sign is wrong."))  # fmt: skip
    unknown = np.isnan(np.diag(stated)) & np.any(matrix, axis=1)
    if np.any(unknown):
        names = ", ".join(f"{COMPONENTS[i]}{MOTIONS[i]}" for i in np.flatnonzero(unknown))
        out.append(_check("M_A", Severity.WARN, f"no {names}", "a diagonal beside its products",
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
    if p.mass is not None and (heaviest := float(np.max(np.diag(matrix)[:3]))) > HEAVY * p.mass.mass:
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


def _damping(p: ParameterFile) -> list[Check]:
    out = []
    own = 0
    for t in force_law(p).terms:
        variables = {v for v, _, _ in t.term.factors}
        motion = MOTIONS[COMPONENTS.index(t.component)]
        resistance = t.component == "X" and not variables and t.speed_power == 2
        if t.coefficient == 0.0 or not (variables == {motion} or resistance):
            continue
        own += 1
        odd = t.term.odd_in(motion) or resistance
        name = primed(t.symbol)
        if odd and t.coefficient > 0.0:
            out.append(_check(name, Severity.FAIL, f"{t.coefficient:.4g} (SI)", "below zero",
                              "It drives the motion that it should damp: a sign is wrong."))  # fmt: skip
        elif not odd and t.component in "YKN":
            out.append(_check(name, Severity.WARN, f"{t.coefficient:.4g} (SI)", "zero for a body symmetric port to starboard",
                              f"It pushes one way in both directions; {name[0]}{motion}|{motion}|' is meant?"))  # fmt: skip
    if not own:
        out.append(
            _check("damping", Severity.WARN, "none of X0', Xu, Yv, Zw, Kp, Mq, Nr", "at least one", "Nothing damps.")
        )
    elif not any(c.severity is Severity.FAIL for c in out):
        out.append(_check("damping", Severity.PASS, f"{own} terms of a motion on itself", "below zero"))
    return out

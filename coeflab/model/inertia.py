"""Inertia of the water as a parameter file states it: its added mass, or the acceleration derivatives among its values."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, MOTIONS, derivative
from coeflab.model.parameter_file import ParameterFile

SAME = 1e-9
Array = NDArray[np.float64]


def added_mass_of(parameters: ParameterFile) -> tuple[Array, str]:
    """(6, 6) matrix at the file's density about its reference point, and where it comes from; zeros where nothing is known.

    Acceleration derivatives are used only where there is no added mass; an off-diagonal one stands for its mirror image.
    """
    if parameters.added_mass is not None:
        given = parameters.added_mass
        matrix = np.array(given.matrix) * (parameters.conditions.density / given.density)
        return matrix, f"added mass of {given.body} by {given.method}"
    stated = _stated(parameters)
    if not stated:
        return np.zeros((6, 6)), "no added mass is known"
    names = ", ".join(name for name, _ in stated.values())
    return (
        _with(np.zeros((6, 6)), stated),
        f"acceleration derivatives {names} only; every other entry is unknown and written as zero",
    )


def measured_first(parameters: ParameterFile) -> tuple[Array, str]:
    """The same with acceleration derivatives, where the file states any, in place of computed entries."""
    matrix, source = added_mass_of(parameters)
    stated = _stated(parameters)
    if parameters.added_mass is None or not stated:
        return matrix, source
    names = ", ".join(name for name, _ in stated.values())
    said = f"added mass: {names} measured, every other entry {source.removeprefix('added mass ')}"
    return _with(matrix, stated), said


def _stated(parameters: ParameterFile) -> dict[tuple[int, int], tuple[str, float]]:
    """Symbol and entry of the added mass of every acceleration derivative, by row and column."""
    density, length = parameters.conditions.density, parameters.scaling.length
    out = {}
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is None or len(d.factors) != 1 or not d.factors[0].endswith("dot"):
            continue
        at = COMPONENTS.index(d.component), MOTIONS.index(d.factors[0].removesuffix("dot"))
        out[at] = d.text, -c.value * 0.5 * density * length ** d.powers[1]
    return out


def _with(matrix: Array, stated: dict[tuple[int, int], tuple[str, float]]) -> Array:
    """The matrix with these entries, each also as its mirror image unless that is stated itself."""
    out = matrix.copy()
    for (i, j), (_, value) in stated.items():
        out[i, j] = value
        if (j, i) not in stated:
            out[j, i] = value
    return out


def converted(parameters: ParameterFile) -> tuple[str, ...]:
    """What was done to an added mass that holds for another density than the file's; in words, empty where nothing was."""
    hull, density = parameters.added_mass, parameters.conditions.density
    if hull is None or abs(hull.density - density) <= SAME * density:
        return ()
    return (
        f"the added mass of {hull.body} is stated for {hull.density:.6g} kg/m^3 and multiplied by {density / hull.density:.6g} for "
        f"the file's {density:.6g} kg/m^3, here and in the potential parts",
    )

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
    density, length = parameters.conditions.density, parameters.scaling.length
    if parameters.added_mass is not None:
        given = parameters.added_mass
        return np.array(given.matrix) * (density / given.density), f"added mass of {given.body} by {given.method}"
    matrix = np.zeros((6, 6))
    known = []
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is None or len(d.factors) != 1 or not d.factors[0].endswith("dot"):
            continue
        i, j = COMPONENTS.index(d.component), MOTIONS.index(d.factors[0].removesuffix("dot"))
        value = -c.value * 0.5 * density * length ** d.powers[1]
        matrix[i, j] = value
        if matrix[j, i] == 0.0:
            matrix[j, i] = value
        known.append(d.text)
    if not known:
        return matrix, "no added mass is known"
    return matrix, f"acceleration derivatives {', '.join(known)} only; every other entry is unknown and written as zero"


def converted(parameters: ParameterFile) -> tuple[str, ...]:
    """What was done to an added mass that holds for another density than the file's; in words, empty where nothing was."""
    hull, density = parameters.added_mass, parameters.conditions.density
    if hull is None or abs(hull.density - density) <= SAME * density:
        return ()
    return (
        f"the added mass of {hull.body} is stated for {hull.density:.6g} kg/m^3 and multiplied by {density / hull.density:.6g} for "
        f"the file's {density:.6g} kg/m^3, here and in the potential parts",
    )

"""Areas that simple forms project."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.model.shape import Box, Cylinder, Form, Plate


def shadow(form: Form, direction: NDArray[np.float64]) -> float:
    """Area projected along a unit direction given in the form's own axes, m^2; exact."""
    x, y, z = (abs(float(d)) for d in direction)
    if isinstance(form, Cylinder):
        return float(np.pi * form.radius**2 * x + 2.0 * form.radius * form.length * np.hypot(y, z))
    if isinstance(form, Plate):
        return form.chord * form.span * z
    if isinstance(form, Box):
        return form.width * form.height * x + form.length * form.height * y + form.length * form.width * z
    a, b, c = form.axes
    return float(np.pi * np.sqrt((b * c * x) ** 2 + (a * c * y) ** 2 + (a * b * z) ** 2))

"""Parts of a body as facets in body axes, and the colour of each form."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.form_facets import box_facets, cylinder_facets, ellipsoid_facets, plate_facets
from coeflab.model.shape import Box, Cylinder, Form, Part, Plate

Array = NDArray[np.float64]
COLOUR_OF = {"cylinder": "a", "plate": "b", "ellipsoid": "c", "box": "d"}


def form_name(form: Form) -> str:
    """``cylinder``, ``plate``, ``ellipsoid`` or ``box``."""
    return type(form).__name__.lower()


def part_facets(part: Part) -> Array:
    """(n, 4, 3) facets, m, FRD, from the datum."""
    form = part.form
    if isinstance(form, Cylinder):
        own = cylinder_facets(form.radius, form.length)
    elif isinstance(form, Plate):
        own = plate_facets(form.chord, form.span)
    elif isinstance(form, Box):
        own = box_facets(form.sides)
    else:
        own = ellipsoid_facets(form.axes)
    return np.asarray(own @ part.rotation.T + part.centre)

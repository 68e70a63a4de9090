"""What a picture of a body is made of: facets of its parts, the surface of its mesh, the colour of each form."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.form_facets import box_facets, cylinder_facets, ellipsoid_facets, plate_facets
from coeflab.kernels.solids import Surface, simplified, solid, surface
from coeflab.model.mesh import TriangleMesh
from coeflab.model.shape import Box, Cylinder, Form, Part, Plate

Array = NDArray[np.float64]
MOST_FACES = 20_000
COLOUR_OF = {"cylinder": "a", "plate": "b", "ellipsoid": "c", "box": "d"}
POOR = ", a poor stand-in"


def form_name(form: Form) -> str:
    """``cylinder``, ``plate``, ``ellipsoid`` or ``box``."""
    return type(form).__name__.lower()


def is_poor(part: Part) -> bool:
    """Whether it is a poor stand-in for its piece of a mesh, which every picture marks."""
    return part.fit is not None and bool(part.fit.poor)


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


def picture_surface(mesh: TriangleMesh) -> Surface:
    """Vertices and faces of a mesh, simplified to 20,000 faces where it has more and is closed."""
    if len(mesh.faces) <= MOST_FACES:
        return mesh.vertices, mesh.faces
    try:
        return surface(simplified(solid(mesh.vertices, mesh.faces), MOST_FACES)[0])
    except ValueError:
        return mesh.vertices, mesh.faces

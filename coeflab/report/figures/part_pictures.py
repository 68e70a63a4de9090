"""What a picture of a body is made of: facets of its parts, the surface of its mesh, the colour of each form."""

from __future__ import annotations

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import form_surface
from coeflab.bodies.mesh.solids import Surface, simplified, solid, surface
from coeflab.bodies.shape import CLASSES, Box, Cylinder, Ellipsoid, Faceted, Form, Part, Plate, Turned
from coeflab.core.types import Array
from coeflab.report.figures.form_facets import box_facets, cylinder_facets, ellipsoid_facets, lathe_facets, plate_facets

MOST_FACES = 20_000
COLOUR_OF = {
    "cylinder": "a", "revolution": "a", "plate": "b", "finned": "b", "ellipsoid": "c", "tube": "c", "box": "d", "bar": "d",
    "mesh": "band",
}  # fmt: skip
DRAWN = 2_000
POOR = ", a poor stand-in"


def form_name(form: Form) -> str:
    """``cylinder``, ``plate``, ``ellipsoid``, ``box``, ``bar``, ``tube``, ``revolution``, ``finned`` or ``mesh``."""
    return CLASSES[type(form)]


def is_convex(form: Form) -> bool:
    """Whether its outline is that of its corners."""
    return isinstance(form, Cylinder | Plate | Box | Ellipsoid)


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
    elif isinstance(form, Ellipsoid):
        own = ellipsoid_facets(form.axes)
    elif isinstance(form, Turned):
        own = lathe_facets(
            np.array([form.stations[0], *form.stations, form.stations[-1]]), np.array([0.0, *form.radii, 0.0])
        )
    else:
        vertices, faces = form_surface(form, max(DRAWN, len(form.mesh.faces)) if isinstance(form, Faceted) else DRAWN)
        own = vertices[faces[:, [0, 1, 2, 2]]]
    return np.asarray(own @ part.rotation.T + part.centre)


def picture_surface(mesh: TriangleMesh) -> Surface:
    """Vertices and faces of a mesh, simplified to 20,000 faces where it has more and is closed."""
    if len(mesh.faces) <= MOST_FACES:
        return mesh.vertices, mesh.faces
    try:
        return surface(simplified(solid(mesh.vertices, mesh.faces), MOST_FACES)[0])
    except ValueError:
        return mesh.vertices, mesh.faces

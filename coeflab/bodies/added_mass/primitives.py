"""Closed forms of the parts of a body, each about its own centre, moved to the reference point and summed.

The one plate that a thin mesh is like, by the test of ``coeflab simplify``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.closed_forms import (
    PLATE_ASPECTS,
    box_added_mass,
    cylinder_added_mass,
    cylinder_with_ends,
    ellipsoid_added_mass,
    plate_added_mass,
)
from coeflab.bodies.mesh import solids
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Form, Part, Parts, Plate, Shape
from coeflab.bodies.simplify.part_forms import THIN, likeness
from coeflab.core.errors import InputError
from coeflab.core.options import one_of, parse_options
from coeflab.law.added_mass import AddedMass, composed

KEPT_FACES = 20_000


def like_one_plate(mesh: TriangleMesh) -> Part | None:
    """The plate in the mesh's place, or None where it is no single shell, not thin, or of another outline.

    Parameters
    ----------
    mesh : TriangleMesh

    Notes
    -----
    See `coeflab.bodies.simplify.part_forms.likeness`. Bodies that are plainly not thin are told by their second moments of volume
    alone, without a cut; of more than 20,000 faces a decimated copy is looked at.
    """
    smallest, middle, _ = np.sqrt(np.clip(np.linalg.eigvalsh(mesh.integrals.second_moments), 0.0, None))
    if smallest > THIN * middle:
        return None
    try:
        whole, _ = solids.simplified(solids.solid(mesh.vertices, mesh.faces), KEPT_FACES)
    except ValueError:
        return None
    if len(solids.pieces(whole)) != 1:
        return None
    like = likeness(whole)
    if like.kind != "plate":
        return None
    chord, span = like.sizes
    return Part("plate", Plate(chord, span), like.centre, like.rotation)


summary = "closed forms of cylinders, plates, ellipsoids and boxes, composed by the 6 x 6 transform"
citations = ("huuv2025", "coeflab_plates", "lamb1932", "fossen2011")
presets: Mapping[str, Mapping[str, str]] = {"huuv": {"cylinder_ends": "huuv"}}

COMPOSED = "no interaction between parts"
CYLINDERS = {
    "huuv": "cylinders by HUUV equations 28-31 as corrected: 0.1 along, 1 across, ends not corrected",
    "lamb": "cylinders with flat ends by our panel method, tabulated from 0.1 to 20 diameters",
}
PLATES = (
    "plates: k(aspect) pi/4 rho c^2 b along the normal, k by doublet lattice from aspect 1 to 10; own turning terms "
    "of the elliptic disc of equal area and aspect, an estimate"
)
MESH = (
    "the mesh is taken as the one plate that it is like, chord {:.4g} m, span {:.4g} m, of mean thickness {:.2g} of the shorter; "
    "formulas for no thickness and a rectangle, so nothing along the plate or about its normal: a rough guide"
)
BOXES = "boxes by our panel method, tabulated at 36 proportions"


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the method.

    Attributes
    ----------
    cylinder_ends : str
        ``huuv``: HUUV equations 28-31 as corrected. ``lamb``: with flat ends, by our panel method.
    """

    cylinder_ends: str = one_of("lamb", "lamb", "huuv")


def _own(form: Form, density: float, ends: str) -> NDArray[Any]:
    if isinstance(form, Cylinder):
        cylinder = cylinder_with_ends if ends == "lamb" else cylinder_added_mass
        return cylinder(form.radius, form.length, density)
    if isinstance(form, Plate):
        return plate_added_mass(form.chord, form.span, density)
    if isinstance(form, Ellipsoid):
        return ellipsoid_added_mass(form.axes, density)
    return box_added_mass(form.sides, density)


def _statements(parts: tuple[Part, ...], ends: str) -> tuple[str, ...]:
    forms = [p.form for p in parts]
    out = [COMPOSED] if len(parts) > 1 else []
    if any(isinstance(f, Cylinder) for f in forms):
        out.append(CYLINDERS[ends])
    if any(isinstance(f, Plate) for f in forms):
        out.append(PLATES)
    if any(isinstance(f, Box) for f in forms):
        out.append(BOXES)
    for part in parts:
        form = part.form
        if ends == "huuv" and isinstance(form, Cylinder) and form.length < 2.0 * form.radius:
            out.append(f"{part.name}: shorter than its diameter, sections are a poor model of it")
        if isinstance(form, Plate) and form.aspect > PLATE_ASPECTS[-1]:
            out.append(
                f"{part.name}: aspect {form.aspect:.3g}, interpolated between {PLATE_ASPECTS[-1]:g} and infinity"
            )
    return tuple(out)


def _as_plate(mesh: TriangleMesh) -> tuple[Shape, tuple[str, ...]]:
    """The one plate that a mesh is like and what is said of it, or the mesh itself."""
    plate = like_one_plate(mesh)
    if plate is None or not isinstance(plate.form, Plate):
        return mesh, ()
    chord, span = plate.form.chord, plate.form.span
    thickness = mesh.volume / (chord * span * min(chord, span))
    return Parts((plate,)), (MESH.format(chord, span, thickness),)


def added_mass(body: Body, density: float, options: Mapping[str, Any] | None = None) -> AddedMass:
    """Added mass of a body of parts, about its reference point.

    Parameters
    ----------
    body : Body
        With parts, or a mesh that `coeflab simplify` would call one plate; that is a rough guide.
    density : float
        kg/m^3.
    options : mapping, optional
        See `Options`.

    Raises
    ------
    InputError
        No shape, or a body that is not made of parts and not like one plate.
    """
    chosen = parse_options(Options, options or {}, "primitives")
    shape = body.require_shape()
    ends = chosen.cylinder_ends
    said: tuple[str, ...] = ()
    if isinstance(shape, TriangleMesh) and ends == "lamb":
        shape, said = _as_plate(shape)
    if not isinstance(shape, Parts):
        raise InputError(
            f"{body.name}, which has no parts",
            "a body of parts, or a mesh like one plate",
            advice="Use the method ellipsoid or strip, or make parts of a mesh with coeflab simplify.",
        )
    matrix = composed(
        [_own(p.form, density, ends) for p in shape.parts],
        [p.rotation for p in shape.parts],
        [p.centre for p in shape.parts],
        body.reference_point,
    )
    method = "primitives" if ends == "lamb" else f"primitives:{ends}"
    statements = (*said, *_statements(shape.parts, ends))
    return AddedMass(matrix, body.reference_point, body.datum, body.name, method, statements, rough=bool(said))

"""Closed forms of the parts of a body, each about its own centre, moved to the reference point and summed.

The one plate that a thin mesh is like, by the test of ``coeflab simplify``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.body import Body
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.closed_forms.parts import (
    PLATE_ASPECTS,
    box_added_mass,
    cylinder_added_mass,
    cylinder_with_ends,
    plate_added_mass,
)
from coeflab.bodies.closed_forms.revolution import lamb_end_correction
from coeflab.bodies.closed_forms.sections import SLENDEREST_RECTANGLE, rectangle
from coeflab.bodies.mesh import solids
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import form_surface
from coeflab.bodies.panel_solver.panels import panels_of, side_of, slivers, thin_share
from coeflab.bodies.panel_solver.solve import PanelSolution, panel_added_mass
from coeflab.bodies.shape import (
    Bar,
    Box,
    Cylinder,
    Ellipsoid,
    Faceted,
    Finned,
    Form,
    Part,
    Parts,
    Plate,
    Shape,
    Tube,
    Turned,
)
from coeflab.bodies.simplify.part_forms import THIN, likeness
from coeflab.core.errors import InputError
from coeflab.core.options import one_of, parse_options
from coeflab.core.texts import input_error
from coeflab.core.types import locked
from coeflab.law.added_mass import AddedMass
from coeflab.law.definiteness import composed

SIMPLIFIED_FACES = 20_000
SMOOTH, EDGED = 2.0, 4.0 / 3.0  # orders of the panel method, without and with right-angled edges


def like_one_plate(mesh: TriangleMesh) -> Part | None:
    """The plate in the mesh's place, or None where it is no single shell, not thin, or of another outline.

    Parameters
    ----------
    mesh : TriangleMesh

    Notes
    -----
    See `coeflab.bodies.simplify.part_forms.likeness`. Bodies that are plainly not thin are recognised by their second moments of volume
    alone, without a cut; of more than 20,000 faces a decimated copy is looked at.
    """
    smallest, middle, _ = np.sqrt(np.clip(np.linalg.eigvalsh(mesh.integrals.second_moments), 0.0, None))
    if smallest > THIN * middle:
        return None
    try:
        whole, _ = solids.simplified(solids.solid(mesh.vertices, mesh.faces), SIMPLIFIED_FACES)
    except ValueError:
        return None
    if len(solids.pieces(whole)) != 1:
        return None
    like = likeness(whole)
    if like.kind != "plate":
        return None
    chord, span = like.sizes
    return Part("plate", Plate(chord, span), like.centre, like.rotation)


summary = "closed forms of simple parts, panels on tubes, revolutions and meshes, composed by the 6 x 6 transform"
citations = ("huuv2025", "coeflab_plates", "lamb1932", "fossen2011")
presets: Mapping[str, Mapping[str, str]] = {"huuv": {"cylinder_ends": "huuv"}}
places: Mapping[str, int] = {"": 2, "huuv": 5}
exact_ellipsoids = np.inf

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
BARS = (
    "bars: sections of rectangles, across and in turning times Lamb's k2 and k' of the spheroid of equal length and volume; "
    "along, 0.71 of the section to the power 3/2 (own panels)"
)
FINS = (
    "fins on a hull: as plates of both exposed halves, times the gain of sections by the hull (Bryson), an estimate; in roll "
    "each alone"
)
PANELS = "{}: the panel method on the part alone, {:,} panels{}"
PANELLED = Tube | Turned | Faceted
COARSE, FINE, WALL = 800, 3_200, 0.5
CROSSED = 0.28  # 1 less 2 / pi over twice pi / 8, with each fin's own turning
BLUNT = 0.71  # of section area to the power 3/2: panel method, five bars of 2 to 10 widths, 0.68 to 0.74


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
    if isinstance(form, Finned):
        return density * fins_on_hull(form)
    if isinstance(form, PANELLED):
        return density * by_panels(form).matrix
    if isinstance(form, Bar) and form.height * SLENDEREST_RECTANGLE >= form.width:
        return density * bar_added_mass(form)
    return box_added_mass(form.sides, density)


def bar_added_mass(form: Bar) -> NDArray[Any]:
    """(6, 6) per density about the centre: rectangles along x, ends by the spheroid of equal length and volume.

    Along x the blunt ends alone: 0.71 of the section's area to the power 3/2.
    """
    section = np.diag(rectangle(form.width / 2.0, form.height / 2.0))
    k = lamb_end_correction(form.length, form.volume)
    sway, heave = k.lateral * form.length * section[:2]
    turn = k.turning * form.length**3 / 12.0 * section[:2]
    return np.diag([BLUNT * (form.width * form.height) ** 1.5, sway, heave, form.length * section[2], turn[1], turn[0]])


def fins_on_hull(form: Finned) -> NDArray[Any]:
    """(6, 6) per density about the fins' middle: what they add to a round hull.

    Notes
    -----
    Across a plane of fins what its exposed halves move joined to one plate, times (1 + r / s)^2: so much more Bryson's
    sections (1954), pi (s^2 - r^2 + r^4 / s^2) - pi r^2, are than those of that plate. In roll each fin as a plate alone;
    of a cross without hull 2 s^4 / pi (Newman 1977) is 0.72 of that, and so it is cut down with the hull's share.
    """
    r, s, chord = form.radius, form.semi_span, form.chord
    across = plate_added_mass(chord, 2.0 * (s - r), 1.0)[2, 2] * (1.0 + r / s) ** 2
    alone = plate_added_mass(chord, s - r, 1.0)
    about = form.count * (alone[2, 2] * (s + r) ** 2 / 4.0 + alone[3, 3])
    turn = across * chord**2 / 12.0
    if form.count == 2:
        return np.diag([0.0, 0.0, across, about, turn, 0.0])
    return np.diag([0.0, across, across, about * (1.0 - CROSSED * (1.0 - r / s) ** 2), turn, turn])


@dataclass(frozen=True, slots=True)
class _Flow:
    matrix: NDArray[Any]
    panels: int
    converged: bool
    thin: float


@lru_cache(64)
def by_panels(form: Tube | Turned | Faceted) -> _Flow:
    """(6, 6) per density about the centre of a form without formula; of two meshes, if both can be made, extrapolated."""
    found: list[tuple[NDArray[Any], PanelSolution]] = []
    for count in (FINE, COARSE):
        try:
            corners = _corners(form, count)
        except InputError:
            if not found:
                raise
            break
        if found and 2 * len(corners) > found[0][1].count:
            break
        found.append((corners, panel_added_mass(corners, np.zeros(3), compiled=False)))
    fine = found[0][1]
    matrix = fine.matrix
    if len(found) == 2 and not isinstance(form, Faceted):
        order = EDGED if isinstance(form, Tube) else SMOOTH
        ratio = (fine.count / found[1][1].count) ** (order / 2.0)
        matrix = matrix + (matrix - found[1][1].matrix) / (ratio - 1.0)
    if not isinstance(form, Faceted):  # round about x: only facets move water
        matrix = np.diag([matrix[0, 0], *[(matrix[1, 1] + matrix[2, 2]) / 2.0] * 2, 0.0, *[matrix[4, 4]] * 2])
    thin = thin_share(panels_of(found[0][0]))
    return _Flow(locked(matrix), fine.count, all(s.converged for _, s in found), thin)


def _corners(form: Tube | Turned | Faceted, count: int) -> NDArray[Any]:
    """Panels on the form; a coarse mesh is divided first."""
    if isinstance(form, Faceted):
        mesh = form.mesh
        try:
            whole = solids.divided(
                solids.solid(mesh.vertices, mesh.faces), side_of(mesh.integrals.area, count), 20 * count
            )
            form = Faceted(TriangleMesh(*solids.surface(whole)))
        except ValueError as why:
            raise InputError(str(why), "a closed surface") from None
    vertices, faces = form_surface(form, count)
    corners = vertices[faces]
    return np.asarray(corners[~slivers(corners)])


def _statements(parts: tuple[Part, ...], ends: str) -> tuple[str, ...]:
    forms = [p.form for p in parts]
    out = [COMPOSED] if len(parts) > 1 else []
    if any(isinstance(f, Cylinder) for f in forms):
        out.append(CYLINDERS[ends])
    if any(isinstance(f, Plate) for f in forms):
        out.append(PLATES)
    if any(isinstance(f, Box) and not isinstance(f, Bar) for f in forms):
        out.append(BOXES)
    for kind, words in ((Bar, BARS), (Finned, FINS)):
        if any(isinstance(f, kind) for f in forms):
            out.append(words)
    for part in parts:
        form = part.form
        if ends == "huuv" and isinstance(form, Cylinder) and form.length < 2.0 * form.radius:
            out.append(f"{part.name}: shorter than its diameter, sections are a poor model of it")
        if isinstance(form, PANELLED):
            flow = by_panels(form)
            more = "" if flow.converged else ", NOT CONVERGED: do not use it"
            more += f", {flow.thin:.0%} of the surface thinner than its panels are large" if flow.thin > WALL else ""
            out.append(PANELS.format(part.name, flow.panels, more))
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
    words: tuple[str, ...] = ()
    if isinstance(shape, TriangleMesh) and ends == "lamb":
        shape, words = _as_plate(shape)
    if not isinstance(shape, Parts):
        raise input_error("bodies.has_parts", name=body.name)
    matrix = composed(
        [_own(p.form, density, ends) for p in shape.parts],
        [p.rotation for p in shape.parts],
        [p.centre for p in shape.parts],
        body.reference_point,
    )
    method = "primitives" if ends == "lamb" else f"primitives:{ends}"
    statements = (*words, *_statements(shape.parts, ends))
    flows = [by_panels(p.form) for p in shape.parts if isinstance(p.form, PANELLED)]
    rough = bool(words) or any(not f.converged or f.thin > WALL for f in flows)
    return AddedMass(matrix, body.reference_point, body.datum, body.name, method, statements, rough=rough)

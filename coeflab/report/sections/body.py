"""A body in a report: its outlines and itself in space, with the points that forces act at.

The outline of a body from the side and from above, with its centre of buoyancy and reference point.

A body in space: its parts or its skin, its centres of buoyancy and gravity, and where the force of a drift acts.

Where buoyancy, weight and the force of a drift act on a body, and why such a point is not known.

Added mass in a report: the bodies, every method side by side, and what is booked as potential in the coefficients.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes

from coeflab.bodies.body import Body
from coeflab.bodies.forms import Plate
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.mesh.solids import Surface
from coeflab.bodies.pieces import HULL, Piece
from coeflab.bodies.shape import Parts, Shape
from coeflab.bodies.triangulation import RULE, Triangulation
from coeflab.core.table import plus_minus
from coeflab.core.types import Array, dataclass
from coeflab.core.wording import collected
from coeflab.formats import loss_tables
from coeflab.law.coefficient import CoefficientSet
from coeflab.report.document import Axis, Figure, Layer, Scene, Section
from coeflab.report.figures.body import MARGIN, SIDE, TOP, Sheet, View, body_figure
from coeflab.report.figures.body_scene import COLOUR_OF, POOR, form_name, is_poor, part_facets, picture_surface
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.svg import paper, settings, svg_text
from coeflab.report.notation import as_users_wrote
from coeflab.report.sections.campaign import filled
from coeflab.report.tables import added_mass as tables
from coeflab.report.tables import nouns as noun_tables
from coeflab.report.tables.added_mass import particulars
from coeflab.report.texts import text_of
from coeflab.study.study import Study
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import CENTRES, Derived, centre_of_pressure

PANELS = 3000
WIDTH, TALLEST, GAP, CAPTION = 340.0, 90.0, 12.0, 16.0


@as_users_wrote
def hull_figure(body: Body, anchor: str, width: float = WIDTH, gravity: Array | None = None) -> Figure:
    """Side and top views at one scale.

    Parameters
    ----------
    body : Body
        With a closed shape.
    anchor : str
        Unique in the document.
    width : float, optional
        Points.
    gravity : (3,) array, optional
        The centre of gravity, FRD, from the body's datum; marked where it is given.
    """
    shape = body.require_shape()
    if isinstance(shape, Parts):  # a plate without thickness encloses nothing that a mesh could show
        shape = replace(shape, parts=tuple(p for p in shape.parts if not isinstance(p.form, Plate)))
    surface = picture_surface(shape if isinstance(shape, TriangleMesh) else meshed(shape, PANELS))
    size = np.ptp(surface[0], axis=0)
    scale = float(min((width - 2.0 * MARGIN) / size[0], TALLEST / max(size[1], size[2])))
    rows = [CAPTION + scale * size[2], CAPTION + scale * size[1]]
    marks = {
        "centre of buoyancy": (np.asarray(shape.centre_of_volume), "o"),
        "reference point": (body.reference_point, "+"),
    }
    if gravity is not None:
        marks["centre of gravity"] = (gravity, "x")
    lines = -(-len(marks) // 2)
    height = sum(rows) + GAP + 2.0 * MARGIN + CAPTION * lines
    title = f"{body.name}: outline"
    words = f"Outlines of {body.name} from starboard and from above, {size[0]:.3g} by {size[1]:.3g} by {size[2]:.3g} m."
    with settings():
        figure, axes = paper(width, height)
        top = height - MARGIN
        for view, row in zip((SIDE, TOP), rows, strict=True):
            _view(axes, view, surface, scale, width, top, marks)
            top -= row + GAP
        for k, (name, (_, marker)) in enumerate(marks.items()):
            at, low = MARGIN + 6.0 + 0.5 * width * (k % 2), MARGIN + CAPTION * (lines - 1 - k // 2)
            axes.plot(at, low, marker=marker, markersize=6.0, color=COLOURS["ink"], fillstyle="none", linestyle="none")
            axes.text(at + 10.0, low - 3.0, name, fontsize=8.75)
        svg = svg_text(figure, anchor, title, words)
    caption = f"Outlines of {body.name} at one scale; the bow points to the right."
    return Figure(anchor, svg, title, caption, words)


def _view(
    axes: Axes,
    view: View,
    surface: Surface,
    scale: float,
    width: float,
    top: float,
    marks: dict[str, tuple[Array, str]],
) -> None:
    flat = surface[0] @ view.axes[:2].T * scale
    corner = np.array([MARGIN + (width - 2.0 * MARGIN - np.ptp(flat[:, 0])) / 2.0, top - CAPTION])
    move = np.array([corner[0] - flat[:, 0].min(), corner[1] - flat[:, 1].max()])
    sheet = Sheet(axes, view, scale, move, float(np.ptp(surface[0], axis=0).max()))
    axes.text(MARGIN, top - 9.0, view.title, fontsize=8.75, color=COLOURS["muted"])
    sheet.outline(surface)
    for point, marker in marks.values():
        axes.plot(
            *sheet.on_paper(point), marker=marker, markersize=6.0, color=COLOURS["ink"], fillstyle="none", zorder=3
        )


FACES, HULL_FACES, FIN_FACES = 9000, 7500, 800
SKIN = 0.75
ROOM = 0.04


@dataclass(frozen=True, slots=True, eq=False)
class Mark:
    """A point of a body that is known by a name.

    Attributes
    ----------
    name : str
        In full.
    label : str
        Short, beside the point.
    place : (3,) array
        m, FRD, from the datum.
    colour : str
    note : str
        What it rests on.
    """

    name: str
    label: str
    place: Array
    colour: str
    note: str = ""


def hull_scene(
    name: str, shape: Shape, marks: tuple[Mark, ...], unknown: tuple[str, ...] = (), pieces: tuple[Piece, ...] = ()
) -> Scene:
    """The body with its marks.

    Parameters
    ----------
    name : str
    shape : Parts, Revolution or TriangleMesh
        Parts stand solid, coloured by form; a skin is translucent.
    marks : tuple of Mark
    unknown : tuple of str
        What has no mark, and why, in words.
    pieces : tuple of Piece
        What a skin is made of, where that is known: each is drawn in even triangles of its own.
    """
    layers = _parts(shape) if isinstance(shape, Parts) else (_skin(shape, pieces),)
    points = [
        Layer(m.name, m.colour, m.place[None, :], np.arange(1), label=m.label, notes=(m.note or _at(m.place),))
        for m in marks
    ]
    everything = np.vstack([*(layer.places for layer in layers), *(m.place[None, :] for m in marks)])
    room = ROOM * float(np.ptp(everything, axis=0).max())
    axes = tuple(
        Axis(axis, "m", (float(low) - room, float(high) + room))
        for axis, low, high in zip("xyz", everything.min(axis=0), everything.max(axis=0), strict=True)
    )
    each = " ".join(f"{m.label}: {m.name}, {m.note or _at(m.place)}." for m in marks)
    caption = " ".join([each, *unknown, "Drag to turn it."])
    words = f"{'Solid parts' if isinstance(shape, Parts) else 'A translucent skin'} of {name} with {len(marks)} marked points."
    return Scene(
        f"{name} in space",
        caption,
        words,
        (*layers, *_axis_line(marks, layers), *points),
        (axes[0], axes[1], axes[2]),
        True,
    )


def _at(place: Array) -> str:
    return f"({', '.join(f'{v + 0.0:.4g}' for v in np.round(place, 6))}) m from the datum"


def _parts(shape: Parts) -> tuple[Layer, ...]:
    """One layer a form, so that a form is one entry of the legend; poor stand-ins apart, and dark."""
    forms = collected(((form_name(part.form), is_poor(part)), part_facets(part)) for part in shape.parts)
    out = []
    for (form, poor), facets in forms.items():
        corners = np.concatenate(facets)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
        places, index = np.unique(np.round(corners, 9), axis=0, return_inverse=True)
        name, colour = (f"{form}{POOR}", "ink") if poor else (form, COLOUR_OF[form])
        out.append(Layer(name, colour, places, index.reshape(-1, 3)))
    return tuple(out)


def _skin(shape: Shape, pieces: tuple[Piece, ...]) -> Layer:
    """The surface in even triangles; pieces reach into one another, which a picture may show as it is."""
    surfaces = [_even(piece) for piece in pieces] or [
        _few(shape if isinstance(shape, TriangleMesh) else meshed(shape, HULL_FACES))
    ]
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in surfaces[:-1])])
    faces = np.concatenate([faces + start for (_, faces), start in zip(surfaces, starts, strict=True)])
    return Layer("skin", "band", np.concatenate([vertices for vertices, _ in surfaces]), faces, SKIN)


def _even(piece: Piece) -> Surface:
    """A piece in triangles about as long as wide; those of a solver's surface are longer along a hull."""
    if piece.turned is not None:
        return _few(meshed(piece.turned, HULL_FACES))
    return _few(piece.surface(HULL_FACES if piece.name == HULL else FIN_FACES))


def _few(mesh: TriangleMesh) -> Surface:
    """The mesh simplified for a picture; it need not be closed."""
    if len(mesh.faces) <= FACES:
        return mesh.vertices, mesh.faces
    import fast_simplification

    points, faces = fast_simplification.simplify(mesh.vertices.copy(), mesh.faces.copy(), target_count=FACES)
    return np.asarray(points, dtype=np.float64), np.asarray(faces, dtype=np.int64)


def _axis_line(marks: tuple[Mark, ...], layers: tuple[Layer, ...]) -> tuple[Layer, ...]:
    """A line along x that marks before or behind the body stand on."""
    if not marks:
        return ()
    x = np.concatenate([*(layer.places[:, 0] for layer in layers), [m.place[0] for m in marks]])
    y, z = marks[0].place[1:]
    ends = np.array([[x.min(), y, z], [x.max(), y, z]])
    return (Layer("axis", "muted", ends, np.array([[0, 1]])),)


PLANES = {"Nv'/Yv'": "sideslip", "-Mw'/Zw'": "angle of attack"}
SHORT = {"Nv'/Yv'": "CP sway", "-Mw'/Zw'": "CP heave"}


def hull_marks(study: Study, body: Body, files: tuple[str, ...]) -> tuple[tuple[Mark, ...], tuple[str, ...]]:
    """Marks of a body, and in words what has none.

    Parameters
    ----------
    study : Study
    body : Body
        With a shape.
    files : tuple of str
        Parameter files whose added mass is that of the body.
    """
    centre = np.asarray(body.require_shape().centre_of_volume)
    marks = [Mark("centre of buoyancy", "CB", centre, "a")]
    unknown: list[str] = []
    for name in files:
        parameters = study.parameter_files[name]
        point = parameters.reference_point
        if point.origin != body.datum:
            unknown.append(f"{name} counts from another datum ({point.datum}), so its points are not drawn.")
            continue
        of_file = f" of {name}" if len(files) > 1 else ""
        weight = _gravity(parameters, of_file)
        if weight is None:
            unknown.append(f"The centre of gravity{of_file} is not known.")
        else:
            marks.append(weight)
        found, missing = _pressures(study, parameters, of_file)
        several = f" {files.index(name) + 1}" if len(files) > 1 else ""
        marks += [replace(m, label=f"{m.label}{several}") for m in found]
        unknown += missing
    return _once(marks), tuple(dict.fromkeys(unknown))


def _once(marks: list[Mark]) -> tuple[Mark, ...]:
    """Marks without those that repeat another of the same kind at the same place."""
    out: list[Mark] = []
    for mark in marks:
        if not any(m.label == mark.label and np.allclose(m.place, mark.place, atol=1e-6) for m in out):
            out.append(mark)
    return tuple(out)


def _gravity(parameters: ParameterFile, of_file: str) -> Mark | None:
    mass, point = parameters.mass, np.array(parameters.reference_point.point)
    if mass is None:
        return None
    if mass.centre is not None:
        return Mark(f"centre of gravity{of_file}", "CG", point + np.array(mass.centre), "b")
    place = point + np.array([mass.mass_moment / mass.mass, 0.0, 0.0])
    return Mark(
        f"centre of gravity{of_file}",
        "CG",
        place,
        "b",
        "its height is not stated and drawn at that of the reference point",
    )


def _pressures(study: Study, parameters: ParameterFile, of_file: str) -> tuple[list[Mark], list[str]]:
    """Where the forces act by the slopes that the file holds, one mark a plane."""
    campaigns = {c.campaign for c in parameters.coefficients}
    sets = [f.coefficients for f in study.fits if f.body == parameters.body and f.campaign in campaigns]
    marks: list[Mark] = []
    unknown: list[str] = []
    for name, plane in PLANES.items():
        found = next(((d, s) for s in sets for d in centre_of_pressure(s, parameters.name) if d.name == name), None)
        full = f"centre of pressure for {plane}{of_file}"
        if found is None:
            moment, force, _ = CENTRES[name]
            unknown.append(f"The {full} has no value: {moment}' or {force}' is missing.")
        elif found[0].result is None:
            unknown.append(f"The {full} has no value: {found[0].statement}.")
        else:
            marks.append(_pressure(full, SHORT[name], *found))
    return marks, unknown


def _pressure(full: str, short: str, derived: Derived, among: CoefficientSet) -> Mark:
    length = among.scaling.length
    half = 0.0 if derived.result is None else derived.result.linear * length
    place = among.reference_point + np.array([derived.value * length, 0.0, 0.0])
    note = f"{plus_minus(derived.value * length, half, '±')} m forward of the reference point, from {derived.name}"
    return Mark(full, short, place, "d" if short == "CP sway" else "c", note)


def body_sections(study: Study) -> tuple[Section, ...]:
    """The body of the plan, unless the section on added mass shows it, or others that do have a shape."""
    body = study.body
    if body is None or body.name in {h.body.name for h in study.hulls.values()}:
        return ()
    if body.shape is None and study.hulls:
        return ()
    text = ["The body of the plan. No parameter file asks for its added mass, so none is computed."]
    if body.shape is None:
        text.append("It is known by particulars alone: without a shape it has neither outlines nor a view in space.")
    files = tuple(name for name in study.parameter_files if name not in study.hulls)
    figures = () if body.shape is None else (drawn_body(study, body, files, "body"),)
    return (Section("body", "Body", tuple(text), filled(particulars(body)), figures),)


def drawn_body(study: Study, body: Body, files: tuple[str, ...], anchor: str) -> Figure:
    """The drawing of a body, with the body in space.

    Parameters
    ----------
    study : Study
    body : Body
        With a shape.
    files : tuple of str
        Parameter files that are about it; their points are marked.
    anchor : str
        Unique in the document.
    """
    shape = body.require_shape()
    marks, unknown = hull_marks(study, body, files)
    if isinstance(shape, Parts):
        drawn = body_figure(body.name, shape, None, f"{anchor}-parts")
    else:
        gravity = [m.place for m in marks if m.label == "CG"]
        drawn = hull_figure(body, f"{anchor}-outline", gravity=gravity[0] if len(gravity) == 1 else None)
    return replace(drawn, scene=hull_scene(body.name, shape, marks, unknown, body.pieces))


def added_mass_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where no parameter file has a hull."""
    if not study.hulls:
        return ()
    users = collected((found.body.name, name) for name, found in study.hulls.items())
    text = (
        text_of("body.added_mass"),
        f"Recommended by this rule: {RULE}.",
        text_of("body.potential"),
    )
    bodies = tuple(
        _body(study, study.hulls[names[0]], tuple(names), f"hull-{i}") for i, names in enumerate(users.values())
    )
    files = tuple(
        Section(
            f"potential-{i}",
            f"Potential and viscous parts, {name}",
            tables=filled(loss_tables.parts(study.parameter_files[name])),
        )
        for i, name in enumerate(study.hulls)
    )
    return (Section("added-mass", "Added mass", text, subsections=(*bodies, *files)),)


def _body(study: Study, found: Triangulation, files: tuple[str, ...], anchor: str) -> Section:
    return Section(
        anchor,
        found.body.title or found.body.name,
        tables=filled(
            tables.particulars(found.body),
            tables.derivatives(found),
            tables.primes(found),
            noun_tables.matrix(found.recommended),
            tables.symmetry(found),
        ),
        figures=(drawn_body(study, found.body, files, anchor),),
    )

"""A body in space: its parts or its skin, its centres of buoyancy and gravity, and where the force of a drift acts."""

from __future__ import annotations

import numpy as np

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.mesh.solids import Surface
from coeflab.bodies.pieces import HULL, Piece
from coeflab.bodies.shape import Parts, Shape
from coeflab.core.types import Array, dataclass
from coeflab.core.wording import collected
from coeflab.report.document import Axis, Layer, Scene
from coeflab.report.figures.part_pictures import COLOUR_OF, POOR, form_name, is_poor, part_facets

FACES = 9000  # of a mesh: more are decimated
HULL_FACES, FIN_FACES = 7500, 800  # of a piece from equations
SKIN = 0.75  # opacity
ROOM = 0.04  # of the largest extent, around what is drawn


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

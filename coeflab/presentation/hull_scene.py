"""A body in space: its parts or its skin, its centres of buoyancy and gravity, and where the force of a drift acts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.brief import brief
from coeflab.kernels.solids import Surface
from coeflab.model.mesh import TriangleMesh
from coeflab.model.meshing import meshed
from coeflab.model.shape import Parts, Shape
from coeflab.presentation.document import Axis, Layer, Scene
from coeflab.presentation.part_facets import COLOUR_OF, POOR, form_name, is_poor, part_facets

Array = NDArray[np.float64]
FACES = 3000
SKIN = 0.5
ROOM = 0.04


@brief
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


def hull_scene(name: str, shape: Shape, marks: tuple[Mark, ...], unknown: tuple[str, ...] = ()) -> Scene:
    """The body with its marks.

    Parameters
    ----------
    name : str
    shape : Parts, Revolution or TriangleMesh
        Parts stand solid, coloured by form; a skin is translucent.
    marks : tuple of Mark
    unknown : tuple of str
        What has no mark, and why, in words.
    """
    layers = _parts(shape) if isinstance(shape, Parts) else (_skin(shape),)
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
    said = f"{'Solid parts' if isinstance(shape, Parts) else 'A translucent skin'} of {name} with {len(marks)} marked points."
    return Scene(
        f"{name} in space",
        caption,
        said,
        (*layers, *_axis_line(marks, layers), *points),
        (axes[0], axes[1], axes[2]),
        True,
    )


def _at(place: Array) -> str:
    return f"({', '.join(f'{v + 0.0:.4g}' for v in np.round(place, 6))}) m from the datum"


def _parts(shape: Parts) -> tuple[Layer, ...]:
    """One layer a form, so that a form is one entry of the legend; poor stand-ins apart, and dark."""
    forms: dict[tuple[str, bool], list[Array]] = {}
    for part in shape.parts:
        forms.setdefault((form_name(part.form), is_poor(part)), []).append(part_facets(part))
    out = []
    for (form, poor), facets in forms.items():
        corners = np.concatenate(facets)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
        places, index = np.unique(np.round(corners, 9), axis=0, return_inverse=True)
        name, colour = (f"{form}{POOR}", "ink") if poor else (form, COLOUR_OF[form])
        out.append(Layer(name, colour, places, index.reshape(-1, 3)))
    return tuple(out)


def _skin(shape: Shape) -> Layer:
    """The surface in few triangles."""
    vertices, faces = _few(shape if isinstance(shape, TriangleMesh) else meshed(shape, FACES // 2))
    return Layer("skin", "band", vertices, faces, SKIN)


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

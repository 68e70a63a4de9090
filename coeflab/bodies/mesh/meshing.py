"""A triangle mesh of every shape."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from functools import reduce
from itertools import combinations

import numpy as np

from coeflab.bodies.mesh.decimation import decimated, is_closed
from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import solid, surface
from coeflab.bodies.mesh.structured_surface import (
    FEWEST_AROUND,
    box_surface,
    outline,
    revolved,
    rings,
    rounded_count,
    two_triangles,
)
from coeflab.bodies.shape import (
    Box,
    Cylinder,
    Ellipsoid,
    Faceted,
    Finned,
    Form,
    Part,
    Parts,
    Plate,
    Revolution,
    Shape,
    Tube,
    Turned,
)
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, Faces

FEWEST, MOST = 64, 2_000_000
SAME_VOLUME, CHANGE, MORE = 1e-9, 0.02, 1.1
WITHIN_REACH, GENTLE, NEARLY = 50_000, 3, 1e-3
DENSE = 4097


def meshed(shape: Shape, panels: int) -> TriangleMesh:
    """A closed mesh of about ``panels`` triangles.

    A body of revolution gets structured rings with every vertex on its meridian, a cylinder, an ellipsoid and a box
    likewise; meshes of one body at two counts are similar, so that an error of order h^2 can be extrapolated. Parts share
    the count by the root of their surface, and are united where they meet. A mesh that has no more faces than asked is
    returned as it is, another is remade from its body's equations where these are known, else decimated.

    Parameters
    ----------
    shape : Shape
    panels : int
        From 64 to 2,000,000.

    Returns
    -------
    TriangleMesh
        Its ``discretisation_error`` compares its volume with the shape's own, except where parts were united: what
        they enclose together has no closed form.

    Raises
    ------
    InputError
        Too few or too many panels; a plate, which encloses nothing; a mesh that cannot be decimated and stay closed
        and within 2 % of its volume.
    """
    if not FEWEST <= panels <= MOST:
        raise InputError(f"a mesh of {panels} triangles", f"from {FEWEST} to {MOST}", column="panels")
    if isinstance(shape, TriangleMesh):
        if len(shape.faces) <= panels:
            return shape
        return shape.remade(panels) if shape.remade else _decimated(shape, panels)
    if isinstance(shape, Revolution):
        x, radius, around = rings(*dense_meridian(shape), panels)
        vertices, faces = revolved(x, radius, around)
        return TriangleMesh(vertices + np.array([0.0, *shape.axis]), faces, shape.volume)
    return _assembled(shape, panels)


def dense_meridian(shape: Revolution) -> tuple[Array, Array]:
    """x, rising, and radius from the after end to the fore end, m; a pole has radius zero.

    The ends are known from the stations: their weights give the length and the middle of the axis.
    """
    middle = float(shape.weight @ shape.x / shape.weight.sum())
    ends = middle - shape.length / 2.0, middle + shape.length / 2.0
    return outline(shape.x, shape.radius**2, shape.radius_slope, ends)


def united(meshes: Sequence[TriangleMesh]) -> TriangleMesh:
    """What several closed meshes enclose together.

    Raises
    ------
    InputError
        One of them is not closed.
    """
    try:
        solids = [solid(m.vertices, m.faces) for m in meshes]
    except ValueError as why:
        raise InputError(str(why), "a closed surface") from None
    return TriangleMesh(*surface(reduce(operator.add, solids)))


def _decimated(mesh: TriangleMesh, panels: int) -> TriangleMesh:
    if not is_closed(mesh.faces):
        raise InputError("a mesh that is not closed", "a closed surface, each edge between two faces")
    out = TriangleMesh(*decimated(*_thinned(mesh, panels), panels), mesh.exact_volume or mesh.volume)
    change = out.volume / mesh.volume - 1.0
    if abs(change) > CHANGE or len(out.faces) > MORE * panels:
        raise InputError(
            f"a mesh of {len(mesh.faces)} faces that comes to {len(out.faces)} and changes its volume by {change:.1%} "
            f"when decimated to {panels}",
            f"a change within {CHANGE:.0%}",
            column="panels",
            advice="Ask for more panels.",
        )
    return out


def _thinned(mesh: TriangleMesh, panels: int) -> tuple[Array, Faces]:
    """A very fine mesh, brought within reach by a library that is quick and sometimes leaves holes: then it is not used."""
    within = max(WITHIN_REACH, 8 * panels)
    if len(mesh.faces) > 2 * within:
        import fast_simplification

        points, faces = fast_simplification.simplify(
            mesh.vertices.copy(), mesh.faces.copy(), target_count=within, agg=GENTLE
        )
        vertices, faces = np.asarray(points, dtype=np.float64), np.asarray(faces, dtype=np.int64)
        whole = mesh_integrals(vertices, faces).volume / mesh.volume - 1.0
        if is_closed(faces) and abs(whole) < NEARLY:
            return vertices, faces
    return mesh.vertices, mesh.faces


def _assembled(shape: Parts, panels: int) -> TriangleMesh:
    flat = [p.name for p in shape.parts if isinstance(p.form, Plate)]
    if flat:
        raise input_error("mesh.plate_has_thickness", flat=shown(flat[0]))
    share = np.sqrt([surface_of(p.form) for p in shape.parts])
    counts = np.maximum(panels * share / share.sum(), FEWEST).astype(int)
    meshes = [_placed(part, int(count)) for part, count in zip(shape.parts, counts, strict=True)]
    if any(_boxes_meet(a, b) for a, b in combinations(meshes, 2)):
        whole = united(meshes)
        if abs(whole.volume / sum(m.volume for m in meshes) - 1.0) > SAME_VOLUME:
            return whole
        return TriangleMesh(whole.vertices, whole.faces, shape.volume)
    starts = np.cumsum([0, *(len(m.vertices) for m in meshes[:-1])])
    faces = np.concatenate([m.faces + start for m, start in zip(meshes, starts, strict=True)])
    return TriangleMesh(np.concatenate([m.vertices for m in meshes]), faces, shape.volume)


def _boxes_meet(a: TriangleMesh, b: TriangleMesh) -> bool:
    low = np.maximum(a.vertices.min(axis=0), b.vertices.min(axis=0))
    high = np.minimum(a.vertices.max(axis=0), b.vertices.max(axis=0))
    return bool(np.all(low <= high))


def surface_of(form: Form) -> float:
    """m^2; of an ellipsoid by Thomsen's formula, within 1.1 %, which is enough to share panels by."""
    if isinstance(form, Cylinder):
        return float(2.0 * np.pi * form.radius * (form.radius + form.length))
    if isinstance(form, Ellipsoid):
        p = 1.6075
        x, y, z = form.axes**p
        return float(4.0 * np.pi * ((x * y + y * z + z * x) / 3.0) ** (1.0 / p))
    if isinstance(form, Faceted):
        return form.mesh.integrals.area
    if isinstance(form, Tube):
        wall = 2.0 * np.pi * (form.radius**2 - form.inner_radius**2)
        return float(wall + 2.0 * np.pi * (form.radius + form.inner_radius) * form.length)
    if isinstance(form, Turned):
        ends = np.pi * (form.radii[0] ** 2 + form.radii[-1] ** 2)
        return float(form.quadrature.wetted_surface + ends)
    if isinstance(form, Finned):
        return 2.0 * form.count * form.chord * (form.semi_span - form.root)
    sides = form.sides if isinstance(form, Box) else np.zeros(3)
    return float(2.0 * (sides[0] * sides[1] + sides[1] * sides[2] + sides[2] * sides[0]))


def _placed(part: Part, panels: int) -> TriangleMesh:
    vertices, faces = form_surface(part.form, panels)
    return TriangleMesh(vertices @ part.rotation.T + part.centre, faces, part.form.volume)


def form_surface(form: Form, panels: int) -> tuple[Array, Faces]:
    """Vertices and faces along the form's own axes, about so many; fins reach a little into the hull they stand on.

    Raises
    ------
    InputError
        A plate; a mesh that cannot be decimated.
    """
    if isinstance(form, Faceted):
        found = meshed(form.mesh, panels)
        return found.vertices, found.faces
    if isinstance(form, Tube):
        return _tube(form, panels)
    if isinstance(form, Turned):
        x = np.unique(np.concatenate([np.linspace(form.stations[0], form.stations[-1], DENSE), form.stations]))
        x, radius, around = rings(x, np.interp(x, form.stations, form.radii), panels)
        return revolved(x, radius, around)
    if isinstance(form, Finned):
        return _fins(form, panels)
    if isinstance(form, Box):
        return box_surface(form.sides, panels)
    if isinstance(form, Cylinder):
        x = np.linspace(-form.length / 2.0, form.length / 2.0, DENSE)
        x, radius, around = rings(x, np.full(DENSE, form.radius), panels)
        return revolved(x, radius, around)
    if isinstance(form, Ellipsoid):
        return _ellipsoid(form.axes, panels)
    raise InputError("a plate", "a form that displaces water")


def _tube(form: Tube, panels: int) -> tuple[Array, Faces]:
    """A quadrilateral turned about x, divided along the wall's length and thickness into squares as far as panels go."""
    wall, middle = form.radius - form.inner_radius, (form.radius + form.inner_radius) / 2.0
    size = np.sqrt(2.0 * 4.0 * np.pi * middle * (form.length + wall) / panels)
    around = rounded_count(2.0 * np.pi * middle / size, 4, FEWEST_AROUND)
    along, thick = rounded_count(form.length / size, 2, 2), rounded_count(wall / size, 1, 1)
    half = form.length / 2.0
    rise, out = np.linspace(-half, half, along + 1), np.linspace(form.inner_radius, form.radius, thick + 1)
    outer = [(x, form.radius) for x in rise[:-1]] + [(half, r) for r in out[:0:-1]]
    inner = [(x, form.inner_radius) for x in rise[:0:-1]] + [(-half, r) for r in out[:-1]]
    profile = np.array(outer + inner)
    angle = 2.0 * np.pi * np.arange(around) / around
    ringed = np.empty((len(profile), around, 3))
    ringed[:, :, 0] = profile[:, :1]
    ringed[:, :, 1], ringed[:, :, 2] = np.outer(profile[:, 1], np.cos(angle)), np.outer(profile[:, 1], np.sin(angle))
    i, k = np.meshgrid(np.arange(len(profile)), np.arange(around), indexing="ij")
    after, ahead = (i + 1) % len(profile), (k + 1) % around
    corners = np.stack([around * i + k, around * i + ahead, around * after + ahead, around * after + k], axis=-1)
    return ringed.reshape(-1, 3), two_triangles(corners.reshape(-1, 4), ((i + k) % 2).ravel())


INSIDE = 0.97  # of a root's distance from the axis: so that fins and hull are one body when united


def _fins(form: Finned, panels: int) -> tuple[Array, Faces]:
    """A box for each fin."""
    low = INSIDE * form.root
    vertices, faces = box_surface(np.array([form.chord, form.semi_span - low, form.thickness]), panels // form.count)
    vertices = vertices + np.array([0.0, (form.semi_span + low) / 2.0, 0.0])
    quarter = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    turns = [np.linalg.matrix_power(quarter, k * (4 // form.count)) for k in range(form.count)]
    starts = len(vertices) * np.arange(form.count)
    return np.concatenate([vertices @ t.T for t in turns]), np.concatenate([faces + n for n in starts])


def _ellipsoid(axes: Array, panels: int) -> tuple[Array, Faces]:
    """Rings about the axis whose two others are the most alike; one of these is then stretched to its length."""
    pole = min(range(3), key=lambda k: abs(float(np.log(axes[k - 2] / axes[k - 1]))))
    turn = [pole, (pole + 1) % 3, (pole + 2) % 3]
    a, b, c = axes[turn]
    angle = np.linspace(np.pi, 0.0, DENSE)
    radius = b * np.sin(angle)
    radius[[0, -1]] = 0.0
    rounds = rings(a * np.cos(angle), radius, panels)
    vertices, faces = revolved(*rounds)
    out = np.empty_like(vertices)
    out[:, turn] = vertices * np.array([1.0, 1.0, c / b])
    return out, faces

"""A triangle mesh of every shape.

Structured triangles on closed surfaces: bodies of revolution and boxes; arrays in, arrays out.

The layout follows from one count alone, so meshes of one body are similar to each other and an error of order h^2 can be
extrapolated. Diagonals alternate like a checkerboard, so that the triangles keep the body's planes of symmetry.
"""

from __future__ import annotations

import operator
from collections.abc import Sequence
from functools import reduce
from itertools import combinations

import numpy as np

from coeflab.bodies.mesh.decimation import decimated, is_closed
from coeflab.bodies.mesh.mesh import TriangleMesh, mesh_integrals
from coeflab.bodies.mesh.solids import solid, surface
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

FEWEST_AROUND = 8
FLOOR = 0.3
ROUND, TIGHTEST = 0.5, 100.0
SAMPLES = 32
CLOSED = 1e-8
APART = 1e-10


def outline(x: Array, square: Array, half_slope: Array, ends: tuple[float, float]) -> tuple[Array, Array]:
    """Dense meridian between two ends from stations that know R^2 and R dR/dx.

    Parameters
    ----------
    x, square, half_slope : (n,) arrays
        Stations m, R^2 m^2 and R dR/dx m; in any order.
    ends : (low, high)
        Where the body begins and ends, m.

    Returns
    -------
    (x, radius) : (m,) arrays, x rising, m
        R^2 between stations is the cubic that takes values and slopes of both; a radius at an end below 1e-4 of the
        largest is a pole.
    """
    from scipy.interpolate import CubicHermiteSpline

    low, high = ends
    order = np.argsort(x)
    order = order[np.concatenate([[True], np.diff(x[order]) > APART * (high - low)])]
    spline = CubicHermiteSpline(x[order], square[order], 2.0 * half_slope[order])
    knots = np.concatenate([[low], x[order], [high]])
    steps = np.arange(SAMPLES) / SAMPLES
    dense = np.append((knots[:-1, None] + np.diff(knots)[:, None] * steps).ravel(), high)
    dense = dense[np.concatenate([[True], np.diff(dense) > 0.0])]
    squares = np.clip(spline(dense), 0.0, None)
    largest = float(squares.max())
    for end in (0, -1):
        squares[end] = squares[end] if squares[end] > CLOSED * largest else 0.0
    return dense, np.sqrt(squares)


def _ring_counts(x: Array, radius: Array) -> Array:
    """Cumulated rings per triangle around.

    Triangles are about as long as wide, down to ``FLOOR`` of the largest radius; where the meridian turns more tightly
    they are shorter, so that an edge of little radius is still round.
    """
    along = np.hypot(np.diff(x), np.diff(radius))
    turning = np.abs(np.diff(np.unwrap(np.arctan2(np.diff(radius), np.diff(x)))))
    bend = np.zeros(len(x))
    bend[1:-1] = turning / (along[1:] + along[:-1]) * 2.0
    bend = np.minimum(bend, TIGHTEST / radius.max())
    density = np.hypot(1.0 / np.hypot(radius, FLOOR * radius.max()), ROUND * bend) / (2.0 * np.pi)
    return np.concatenate([[0.0], np.cumsum(along * (density[1:] + density[:-1]) / 2.0)])


def _pieces(x: Array, radius: Array) -> list[tuple[Array, Array]]:
    """The meridian, with a flat disc where an end is open."""
    rise = np.linspace(0.0, 1.0, 16 * SAMPLES)
    pieces = [(x, radius)]
    if radius[0] > 0.0:
        pieces.insert(0, (np.full(rise.size, x[0]), rise * radius[0]))
    if radius[-1] > 0.0:
        pieces.append((np.full(rise.size, x[-1]), rise[::-1] * radius[-1]))
    return pieces


def _even(value: float, step: int, least: int) -> int:
    return max(least, step * round(value / step))


def rings(x: Array, radius: Array, panels: int) -> tuple[Array, Array, int]:
    """Rings for about ``panels`` triangles: x and radius of each, from pole to pole, and how many triangles around.

    Parameters
    ----------
    x, radius : (n,) arrays
        Dense meridian, m, x rising; flat discs close ends of a radius above zero.
    panels : int
        The count around is a multiple of four, so what comes out is near it, not equal to it.
    """
    pieces = _pieces(x, radius)
    counts = [_ring_counts(px, pr) for px, pr in pieces]
    per_around = sum(float(c[-1]) for c in counts)
    around = _even((1.0 + np.sqrt(1.0 + 2.0 * per_around * panels)) / (2.0 * per_around), 4, FEWEST_AROUND)
    xs, radii = [np.array([pieces[0][0][0]])], [np.array([pieces[0][1][0]])]
    for (px, pr), count in zip(pieces, counts, strict=True):
        number = _even(float(count[-1]) * around, 2, 2)
        at = np.arange(1, number + 1) / number * count[-1]
        at[-1] = count[-1]
        xs.append(np.interp(at, count, px))
        radii.append(np.sqrt(np.interp(at, count, pr**2)))
    return np.concatenate(xs), np.concatenate(radii), around


def revolved(x: Array, radius: Array, around: int) -> tuple[Array, Faces]:
    """Vertices and faces of rings about the x axis.

    Parameters
    ----------
    x, radius : (n,) arrays
        Rings, x rising; the first and the last are poles, of radius zero.
    around : int
        Triangles around, a multiple of four.
    """
    angle = 2.0 * np.pi * np.arange(around) / around
    inner = len(x) - 2
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    ringed = np.empty((inner, around, 3))
    ringed[:, :, 0] = x[1:-1, None]
    ringed[:, :, 1:] = radius[1:-1, None, None] * circle
    vertices = np.concatenate([[[x[0], 0.0, 0.0]], ringed.reshape(-1, 3), [[x[-1], 0.0, 0.0]]])
    k, after = np.arange(around), (np.arange(around) + 1) % around
    low = np.stack([np.zeros_like(k), 1 + after, 1 + k], axis=1)
    last, top = 1 + (inner - 1) * around, 1 + inner * around
    high = np.stack([np.full_like(k, top), last + k, last + after], axis=1)
    j = 1 + around * np.arange(inner - 1)[:, None]
    corners = np.stack([j + k, j + after, j + around + after, j + around + k], axis=-1)
    parity = (np.arange(inner - 1)[:, None] + k) % 2
    return vertices, np.concatenate([low, _split(corners.reshape(-1, 4), parity.ravel()), high])


def _split(corners: Faces, parity: Faces) -> Faces:
    """Two triangles of each quadrilateral; the diagonal leaves from the first corner or from the second."""
    turned = np.where((parity == 0)[:, None], corners, np.roll(corners, -1, axis=1))
    return np.concatenate([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])


def box_surface(sides: Array, panels: int) -> tuple[Array, Faces]:
    """Vertices and faces of a box about the origin, in triangles of like size.

    Parameters
    ----------
    sides : (3,) array
        Length along x, y, z, m.
    panels : int
        About how many triangles.
    """
    area = 2.0 * float(sides[0] * sides[1] + sides[1] * sides[2] + sides[2] * sides[0])
    size = np.sqrt(2.0 * area / panels)
    number = np.array([_even(float(s) / size, 2, 2) for s in sides])
    points, faces, start = [], [], 0
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        i, j = np.meshgrid(np.arange(number[u] + 1), np.arange(number[v] + 1), indexing="ij")
        grid = (np.arange(i.size)).reshape(i.shape)
        quads = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=-1).reshape(-1, 4)
        parity = (i[:-1, :-1] + j[:-1, :-1]).ravel() % 2
        for end in (0, 1):
            lattice = np.empty((i.size, 3), dtype=np.int64)
            lattice[:, u], lattice[:, v], lattice[:, axis] = i.ravel(), j.ravel(), end * number[axis]
            points.append(lattice)
            faces.append(_split(quads if end else quads[:, [0, 3, 2, 1]], parity) + start)
            start += i.size
    lattice, place = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    return (lattice / number - 0.5) * sides, place.reshape(-1)[np.concatenate(faces)]


def lofted(sections: Array) -> tuple[Array, Faces]:
    """Vertices and faces through closed loops, one after the other; outward where a loop runs positive about the stations.

    Parameters
    ----------
    sections : (n, m, 3) array
        Loops of m points. The first and the last must fall together into a line or a point, which closes the surface;
        points that coincide become one, triangles without area go.
    """
    count, around = sections.shape[:2]
    k, i = np.meshgrid(np.arange(around), np.arange(count - 1))
    here, after = around * i + k, around * i + (k + 1) % around
    corners = np.stack([here, after, after + around, here + around], axis=-1).reshape(-1, 4)
    faces = _split(corners, ((i + k) % 2).ravel())
    vertices, place = np.unique(sections.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
    faces = place.reshape(-1)[faces]
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return vertices, faces[whole]


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
    around = _even(2.0 * np.pi * middle / size, 4, FEWEST_AROUND)
    along, thick = _even(form.length / size, 2, 2), _even(wall / size, 1, 1)
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
    return ringed.reshape(-1, 3), _split(corners.reshape(-1, 4), ((i + k) % 2).ravel())


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

"""Closed surfaces as solids that can be cut: arrays in, arrays out, with manifold3d between.

Vertices are (n, 3), m; faces are (m, 3) indices, counter-clockwise seen from outside.

Outlines of bodies seen from one side; arrays in, arrays out, with manifold3d's polygons between.

The smallest box about a cloud of points, in any attitude.
"""

from __future__ import annotations

import operator
from collections.abc import Sequence
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, Faces

Surface = tuple[Array, Faces]
Solid = Any
ROUND = 128


def solid(vertices: Array, faces: Faces) -> Solid:
    """A solid from its surface; vertices at one place are joined first.

    Raises
    ------
    ValueError
        The surface is not closed, or an edge has more or fewer than two faces.
    """
    from manifold3d import Error, Manifold, Mesh64

    places, joined = np.unique(vertices, axis=0, return_inverse=True)
    corners = joined.reshape(-1)[faces]
    selected = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2]) & (corners[:, 2] != corners[:, 0])
    result = Manifold(Mesh64(np.ascontiguousarray(places), np.ascontiguousarray(corners[selected].astype(np.uint64))))
    if result.status() != Error.NoError or result.is_empty():
        raise ValueError(f"a surface that is not closed ({result.status().name})")
    return result


def surface(of: Solid) -> Surface:
    """Vertices and faces of a solid."""
    mesh = of.to_mesh64()
    return np.array(mesh.vert_properties[:, :3], dtype=np.float64), np.array(mesh.tri_verts, dtype=np.int64)


def united(of: Sequence[Surface]) -> tuple[Array, Faces, NDArray[np.int64]]:
    """Vertices and faces of what closed surfaces enclose together, and (m,) which surface each face is a part of.

    Raises
    ------
    ValueError
        See `solid`.
    """
    solids = [solid(*one).as_original() for one in of]
    mesh = reduce(operator.add, solids).to_mesh64()
    number = {one.original_id(): k for k, one in enumerate(solids)}
    ends = np.asarray(mesh.run_index, dtype=np.int64) // 3
    which = np.repeat([number[k] for k in mesh.run_original_id], np.diff(ends))
    return (
        np.array(mesh.vert_properties[:, :3], dtype=np.float64),
        np.array(mesh.tri_verts, dtype=np.int64),
        which.astype(np.int64),
    )


def pieces(of: Solid) -> list[Solid]:
    """Its connected shells, the largest volume first, equal ones from aft and port."""
    found = [p for p in of.decompose() if not p.is_empty()]
    return sorted(found, key=lambda p: (-round(p.volume(), 15), *np.round(p.bounding_box(), 9)))


def simplified(of: Solid, most: int) -> tuple[Solid, float]:
    """A solid of at most ``most`` faces, and how far its surface may have moved, m; itself and 0 where it has fewer."""
    box = of.bounding_box()
    out, moved = of, 0.0
    step = 1e-5 * float(np.linalg.norm(np.subtract(box[3:], box[:3])))
    while out.num_tri() > most and moved < 1e4 * step:
        moved = 2.0 * moved or step
        out = of.simplify(moved)
    return out, moved


def divided(of: Solid, length: float, most: int) -> Solid:
    """The surface without edges much longer than ``length``, m, nor vertices that hardly bend it.

    It moves by a thousandth of that length at most. Where it would come to more than ``most`` faces, edges are left two,
    four or eight times as long, or as they are.
    """
    out = of.simplify(length / 1000.0)
    for longer in (8.0, 4.0, 2.0, 1.0):
        finer = out.refine_to_length(longer * length)
        if finer.num_tri() > most:
            break
        out = finer
    return out


def box(low: Array, high: Array) -> Solid:
    """A box between two corners, (3,) each, m."""
    from manifold3d import Manifold

    return Manifold.cube(tuple(np.subtract(high, low))).translate(tuple(low))


def revolved(x: Array, radius: Array, rotation: Array, point: Array) -> Solid:
    """A body of revolution.

    Parameters
    ----------
    x, radius : (n,) arrays
        Stations along the axis from ``point``, rising, and radii, m.
    rotation : (3, 3) array
        Its first column is the axis.
    point : (3,) array
        m.
    """
    from manifold3d import CrossSection, Manifold

    outline = np.column_stack([np.r_[0.0, radius, 0.0], np.r_[x[0], x, x[-1]]])
    upright = Manifold.revolve(CrossSection([outline]), ROUND)
    turn = np.column_stack([rotation[:, 1], rotation[:, 2], rotation[:, 0]])
    return upright.transform(np.column_stack([turn, point]))


def hull_of(points: Array) -> Solid:
    """The convex hull of (n, 3) points."""
    from manifold3d import Manifold

    return Manifold.hull_points(np.ascontiguousarray(points))


def form_solid(form: str, sizes: tuple[float, ...], rotation: Array, centre: Array) -> Solid:
    """A cylinder (radius, length), tube (outer and inner radius, length), ellipsoid (semi-axes) or box (sides) in its place."""
    from manifold3d import Manifold

    if form == "tube":
        outer, inner, length = sizes
        bore = form_solid("cylinder", (inner, 2.0 * length), rotation, centre)
        return form_solid("cylinder", (outer, length), rotation, centre) - bore
    if form == "cylinder":
        radius, length = sizes
        result = Manifold.cylinder(length, radius, radius, ROUND, True).rotate((0.0, 90.0, 0.0))
    else:
        result = (Manifold.sphere(1.0, ROUND) if form == "ellipsoid" else Manifold.cube((1.0,) * 3, True)).scale(sizes)
    return result.transform(np.column_stack([rotation, centre]))


Outline = Any
RESOLUTION = 1e-4


def mesh_outline(vertices: Array, faces: Faces, view: Array) -> Outline:
    """The silhouette of a surface.

    Parameters
    ----------
    vertices, faces : arrays
    view : (2, 3) array
        The picture's axes, across and up, in the outer ones.

    Notes
    -----
    The union of the projected faces; of a closed surface the faces that look toward the viewer are enough.
    """
    from manifold3d import CrossSection, FillRule

    flat = vertices @ view.T
    a, b, c = (flat[faces[:, k]] for k in range(3))
    turn = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    seen = np.stack([a, b, c], axis=1)[turn > 1e-12 * float(np.prod(np.ptp(flat, axis=0)))]
    whole = CrossSection(list(seen), FillRule.Positive)
    return whole.simplify(RESOLUTION * float(np.ptp(flat, axis=0).max()))


def convex_outline(points: Array, view: Array) -> Outline:
    """The silhouette of a convex body from (n, 3) points on it."""
    from manifold3d import CrossSection

    return CrossSection.hull_points(points @ view.T)


def polygons(outline: Outline) -> list[Array]:
    """Closed (n, 2) rings, outer ones counter-clockwise and holes clockwise."""
    return [np.asarray(ring, dtype=float) for ring in outline.to_polygons()]


def facets_outline(flat: Array) -> Outline:
    """What (n, 4, 2) projected facets that turn counter-clockwise cover together."""
    from manifold3d import CrossSection, FillRule

    return CrossSection(list(flat), FillRule.Positive)


def ring(points: Array) -> Outline:
    """The outline along (n, 2) points, counter-clockwise."""
    from manifold3d import CrossSection

    return CrossSection([points])


def hatched(outline: Outline, apart: float, wide: float) -> Outline:
    """Stripes within an outline, rising to the right.

    Parameters
    ----------
    outline : Outline
    apart, wide : float
        From one stripe to the next along x, and their width along it, in units of the outline.
    """
    from manifold3d import CrossSection

    low_x, low_y, high_x, high_y = outline.bounds()
    tall = high_y - low_y
    first, last = int(np.floor((low_x - tall) / apart)), int(np.ceil(high_x / apart))
    stripe = np.array([[0.0, low_y], [wide, low_y], [wide + tall, high_y], [tall, high_y]])
    stripes = [stripe + np.array([k * apart, 0.0]) for k in range(first, last + 1)]
    return outline ^ CrossSection(stripes)


DIRECTIONS = 400
PREFERRED = 0.99


def oriented_box(points: Array, first: Array) -> tuple[Array, Array, Array]:
    """Attitude, sides and centre of a small box about points.

    One face of the smallest box lies on a face of the convex hull (O'Rourke, 1985, gives the edges); the hull is that of
    the extreme points in 400 fixed directions, so the box is smallest up to that coarseness. It holds all points.

    Parameters
    ----------
    points : (n, 3) array
        m.
    first : (3, 3) array
        An attitude to prefer unless another box is smaller by more than 1 %; its columns are the axes.

    Returns
    -------
    rotation : (3, 3) array
        Columns along the sides, the longest first.
    sides, centre : (3,) arrays
        m.
    """
    hull = points[_extreme(points)]
    best, volume = first, PREFERRED * float(np.prod(np.ptp(hull @ first, axis=0)))
    for normal in _normals(hull):
        turn, size = _about(hull, normal)
        if size < volume * (1.0 - 1e-9):
            best, volume = turn, size
    local = points @ best
    low, high = local.min(axis=0), local.max(axis=0)
    order = np.argsort(-np.round(high - low, 12), kind="stable")
    turn = best[:, order]
    turn[:, 2] *= np.sign(np.linalg.det(turn))
    return turn, (high - low)[order], np.asarray(best @ ((low + high) / 2.0))


def _extreme(points: Array) -> Array:
    """Indices of the points farthest out in directions spread over the sphere (Fibonacci's lattice)."""
    i = np.arange(DIRECTIONS) + 0.5
    z, turn = 1.0 - 2.0 * i / DIRECTIONS, np.pi * (1.0 + np.sqrt(5.0)) * i
    across = np.sqrt(1.0 - z**2)
    directions = np.column_stack([across * np.cos(turn), across * np.sin(turn), z])
    directions = np.vstack([directions, np.eye(3), -np.eye(3)])
    return np.unique([int(np.argmax(points @ d)) for d in directions])


def _normals(points: Array) -> Array:
    from scipy.spatial import ConvexHull, QhullError

    try:
        normals = ConvexHull(points).equations[:, :3]
    except QhullError:
        return np.zeros((0, 3))
    normals = normals * np.sign(normals[np.arange(len(normals)), np.argmax(np.abs(normals), axis=1)])[:, None]
    return np.unique(np.round(normals, 6), axis=0)


def _about(points: Array, normal: Array) -> tuple[Array, float]:
    """Smallest box with one face across a normal: rectangles along the edges of the outline."""
    normal = normal / np.linalg.norm(normal)
    second = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    second /= np.linalg.norm(second)
    plane = np.column_stack([second, np.cross(normal, second)])
    along, area = smallest_rectangle(points @ plane)
    turn = np.column_stack([plane @ along, plane @ [-along[1], along[0]], normal])
    return turn, float(area * np.ptp(points @ normal))


def smallest_rectangle(flat: Array) -> tuple[Array, float]:
    """Direction of a side and area of the smallest rectangle about (n, 2) points; a side lies on an edge of their hull."""
    from scipy.spatial import ConvexHull

    outline = flat[ConvexHull(flat).vertices]
    edge = np.roll(outline, -1, axis=0) - outline
    along = edge / np.linalg.norm(edge, axis=1)[:, None]
    across = np.column_stack([-along[:, 1], along[:, 0]])
    area = np.ptp(outline @ along.T, axis=0) * np.ptp(outline @ across.T, axis=0)
    k = int(np.argmin(np.round(area / area.min(), 9)))
    return along[k], float(area[k])

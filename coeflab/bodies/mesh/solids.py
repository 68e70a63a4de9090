"""Closed surfaces as solids that can be cut: arrays in, arrays out, with manifold3d between.

Vertices are (n, 3), m; faces are (m, 3) indices, counter-clockwise seen from outside.
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

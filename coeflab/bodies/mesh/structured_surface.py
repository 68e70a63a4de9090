"""Structured triangles on closed surfaces: bodies of revolution and boxes; arrays in, arrays out.

The layout follows from one count alone, so meshes of one body are similar to each other and an error of order h^2 can be
extrapolated. Diagonals alternate like a checkerboard, so that the triangles keep the body's planes of symmetry.
"""

from __future__ import annotations

import numpy as np

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


def rounded_count(value: float, step: int, least: int) -> int:
    """The multiple of a step next to a value, at least so many."""
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
    around = rounded_count((1.0 + np.sqrt(1.0 + 2.0 * per_around * panels)) / (2.0 * per_around), 4, FEWEST_AROUND)
    xs, radii = [np.array([pieces[0][0][0]])], [np.array([pieces[0][1][0]])]
    for (px, pr), count in zip(pieces, counts, strict=True):
        number = rounded_count(float(count[-1]) * around, 2, 2)
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
    return vertices, np.concatenate([low, two_triangles(corners.reshape(-1, 4), parity.ravel()), high])


def two_triangles(corners: Faces, parity: Faces) -> Faces:
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
    number = np.array([rounded_count(float(s) / size, 2, 2) for s in sides])
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
            faces.append(two_triangles(quads if end else quads[:, [0, 3, 2, 1]], parity) + start)
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
    faces = two_triangles(corners, ((i + k) % 2).ravel())
    vertices, place = np.unique(sections.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
    faces = place.reshape(-1)[faces]
    whole = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return vertices, faces[whole]

"""Mirror planes of a solid, however its surface is meshed, and the derivatives that they forbid."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.silhouettes import Outline as Silhouette
from coeflab.bodies.mesh.silhouettes import mesh_outline
from coeflab.bodies.outline import Foil, Outline
from coeflab.bodies.shape import Part, Parts, Revolution, Shape
from coeflab.core.types import Array, Faces
from coeflab.law.symbols import COMPONENTS, MOTIONS, derivative, read_factors

# Signs of u v w p q r under the mirror that turns x, y or z round: velocities are polar, rates axial vectors.
SIGNS = np.array([[-1, 1, 1, 1, -1, -1], [1, -1, 1, -1, 1, -1], [1, 1, -1, -1, -1, 1]])
INNER, OUTER = 1.0 / 6.0, 1.0 / 2.0
WEIGHTS = np.array([-0.8, 0.45, 0.45, 0.45, 0.45])
SILHOUETTE = 5e-3  # of its area: what facets of a round body leave between it and its mirror image
ON_PLANE, PAIRED = 1e-4, 0.03  # of the length: a point on a plane; foils of a mesh that are a pair
CACHED = 8

Planes = tuple[bool, bool, bool]


def asymmetries(vertices: Array, faces: Faces) -> Array:
    """How far a closed surface is from its mirror images in x, y and z through its centre of volume, shape (3,).

    The largest volume moment up to the third degree that a mirror plane would make vanish, in coordinates of unit second
    moment, over the volume: zero for a symmetric body however it is meshed.

    Notes
    -----
    Necessary, not sufficient: a body that only higher moments tell from its image, such as one of canted fins all alike,
    passes. Tetrahedra from the centre to the faces, each by the rule of degree 3 of Keast (1986) with five points.
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    sixth = np.einsum("ij,ij->i", a - vertices[0], np.cross(b - vertices[0], c - vertices[0])) / 6.0
    volume = sixth.sum()
    centre = sixth @ (a + b + c + vertices[0]) / (4.0 * volume)
    a, b, c = a - centre, b - centre, c - centre
    signed = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    middle, corners = (a + b + c) / 4.0, (np.zeros_like(a), a, b, c)
    total = a + b + c
    points = np.stack([middle, *(INNER * (total - k) + OUTER * k for k in corners)])
    weight = WEIGHTS[:, None] * signed
    scale = np.sqrt(np.einsum("sn,snk->k", weight, points**2) / volume)
    x = points / scale
    out = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        others = (x[..., i], x[..., j], x[..., k] ** 2, x[..., i] ** 2, x[..., j] ** 2, x[..., i] * x[..., j])
        out.append(max(abs(float(np.sum(weight * x[..., k] * f))) for f in others) / volume)
    return np.array(out)


def vanishing(mirrors: tuple[bool, bool, bool]) -> NDArray[np.bool_]:
    """Which entries of the (6, 6) matrix vanish about a point on the mirror planes of x, y and z, as booleans."""
    out = np.zeros((6, 6), dtype=bool)
    for signs, holds in zip(SIGNS, mirrors, strict=True):
        if holds:
            out |= np.outer(signs, signs) < 0
    return out


WITHIN = 2e-3
NAMES = ("fore-aft", "port-starboard", "top-bottom")


@lru_cache(2)
def mirrors(shape: Shape) -> tuple[bool, bool, bool]:
    """Whether a shape equals its image in x, in y and in z, each through its centre of volume.

    A mesh is held to volume moments up to the third degree, 0.2 % in units of its own size; parts are compared one by one.
    """
    if isinstance(shape, Revolution):
        return _fore_aft(shape), True, True
    if isinstance(shape, TriangleMesh) and not len(shape.faces):
        return False, False, False
    if isinstance(shape, TriangleMesh):
        x, y, z = asymmetries(shape.vertices, shape.faces) < WITHIN
        return bool(x), bool(y), bool(z)
    middle = shape.centre_of_volume
    x, y, z = (_parts_mirror(shape, k, middle) for k in range(3))
    return x, y, z


def _fore_aft(hull: Revolution) -> bool:
    area, middle = hull.radius**2 * hull.weight, hull.centre_of_volume[0]
    spread = float(np.sqrt(np.sum(area * (hull.x - middle) ** 2) / area.sum()))
    return abs(float(np.sum(area * (hull.x - middle) ** 3))) < WITHIN * spread**3 * float(area.sum())


def _parts_mirror(shape: Parts, axis: int, middle: Array) -> bool:
    turn = np.ones(3)
    turn[axis] = -1.0
    size = max(float(np.max(p.form.half_extents(p.rotation))) for p in shape.parts)
    figures = [_figure(p) for p in shape.parts]
    return all(
        any(
            other[0] == kind
            and abs(other[1] - volume) <= WITHIN * max(volume, other[1])
            and np.allclose(other[2], turn * (centre - middle) + middle, atol=WITHIN * size)
            and np.allclose(other[3], np.outer(turn, turn) * spread, atol=WITHIN * size**2)
            and np.allclose(other[4], turn * skew, atol=WITHIN * size)
            for other in figures
        )
        for kind, volume, centre, spread, skew in figures
    )


def _figure(part: Part) -> tuple[str, float, Array, Array, Array]:
    """Kind, volume, centre, second moments, and how far a form without middle leans out of its centre of volume."""
    return type(part.form).__name__, part.form.volume, part.centre, part.second_moments, part.middle - part.centre


@lru_cache(CACHED)
def silhouettes(mesh: TriangleMesh) -> Array:
    """(3,) areas that the body hides along x, y and z, m^2: what lies behind something else counts once."""
    views = [np.eye(3)[[i, j]] for i, j in ((1, 2), (2, 0), (0, 1))]
    faces = np.vstack([mesh.faces.reshape(-1, 3), mesh.sheets, mesh.sheets[:, ::-1]])
    return np.array([mesh_outline(mesh.vertices, faces, view).area() for view in views])


@lru_cache(CACHED)
def mirror_planes(shape: Shape) -> Planes:
    """Whether a solid equals its image in x, in y and in z, each through its centre of volume.

    As `mirrors` has it; of a mesh two silhouettes have to agree with their images too, which see a thin fin on one side.
    """
    by_moments = mirrors(shape)
    if not isinstance(shape, TriangleMesh) or not any(by_moments):
        return by_moments
    by_length = np.argsort(np.ptp(shape.vertices, axis=0), kind="stable")  # the longer one up: a sixth of the time
    held = np.array(by_moments)
    for view in combinations(by_length.tolist(), 2):
        if held[list(view)].any():
            seen = mesh_outline(shape.vertices, shape.faces, np.eye(3)[list(view)])
            for axis in view:
                held[axis] &= _is_own_image(seen, view.index(axis), 2.0 * float(shape.centre_of_volume[axis]))
    x, y, z = held.tolist()
    return x, y, z


def _is_own_image(seen: Silhouette, axis: int, twice_middle: float) -> bool:
    turn, move = ((-1.0, 1.0), (twice_middle, 0.0)) if axis == 0 else ((1.0, -1.0), (0.0, twice_middle))
    return bool((seen - seen.scale(turn).translate(move)).area() <= SILHOUETTE * seen.area())


def unpaired(foils: Sequence[Foil], axis: int, middle: float, within: float) -> list[Foil]:
    """Foils that have no mirror image among them.

    Parameters
    ----------
    foils : sequence of Foil
    axis : int
        1 or 2: the plane across y or z.
    middle, within : float
        Where the plane lies, and how near root and tip have to be, m.
    """
    out = []
    for foil in foils:
        ends = np.array([foil.root, foil.tip])
        ends[:, axis] = 2.0 * middle - ends[:, axis]
        if all(float(np.abs(ends - [other.root, other.tip]).max()) > within for other in foils):
            out.append(foil)
    return out


def planes_of(outline: Outline, point: Array) -> Planes:
    """Mirror planes through a point of what an outline holds: of foils and rings; a bluff part of its own has none."""
    ends = [x for h in outline.hulls for x in (h.x[0], h.x[-1])]
    size = float(np.ptp(ends)) if ends else 1.0
    found = []
    for axis in (1, 2):
        offsets = [float(np.abs(h.centre[:, axis - 1] - point[axis]).max()) for h in outline.hulls]
        offsets += [float(abs(r.centre[axis] - point[axis])) for r in outline.rings]
        alone = unpaired(outline.foils, axis, float(point[axis]), ON_PLANE * size)
        found.append(not outline.bluff and not alone and max(offsets, default=0.0) <= ON_PLANE * size)
    return False, found[0], found[1]


def planes_through(shape: Shape, point: Array, places: Sequence[Array] = ()) -> Planes:
    """Mirror planes of a solid that a point lies on, and that take every one of some places to another one.

    Parameters
    ----------
    shape : Shape
    point : (3,) array
        m, FRD, from the datum.
    places : sequence of (3,) array
        Of what stands on the body beside its shape, such as thrusters.
    """
    middle, size = shape.centre_of_volume, float(shape.length) or 1.0
    out = []
    for axis, found in enumerate(mirror_planes(shape)):
        turn = np.ones(3)
        turn[axis] = -1.0
        images = [middle + turn * (place - middle) for place in places]
        paired = all(min(float(np.abs(image - p).max()) for p in places) <= ON_PLANE * size for image in images)
        out.append(found and paired and abs(float(point[axis] - middle[axis])) <= ON_PLANE * size)
    return out[0], out[1], out[2]


def forbidden(symbols: Sequence[str], planes: Planes) -> NDArray[np.bool_]:
    """Which derivatives change their sign in a mirror that leaves the body as it is, and so are zero.

    Those of a control are none of them: what an angle does is known of its hinge alone. Nor does a fore-aft plane forbid any,
    as all are about a course ahead.

    Parameters
    ----------
    symbols : sequence of str
        SNAME symbols without prime.
    planes : tuple of bool
        Mirror planes of x, y and z through the reference point.
    """
    out = np.zeros(len(symbols), dtype=bool)
    for axis in (1, 2):
        if not planes[axis]:
            continue
        of = dict(zip(MOTIONS, SIGNS[axis], strict=True))
        for i, symbol in enumerate(symbols):
            factors = [name for name, absolute in read_factors(symbol[1:]) or () if not absolute]
            if all(f in of for f in derivative(symbol).factors):
                out[i] |= of[MOTIONS[COMPONENTS.index(symbol[0])]] * np.prod([of[f] for f in factors]) < 0
    return out

"""Meshes that are made on one side of a mirror plane: across which planes, and which patch is the image of which."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from coeflab.core.types import Array
from coeflab.tank.openfoam.features import edges, foils, lies_in
from coeflab.tank.test_matrix import Half

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody

SAME = 0.01  # of the length and of the area: how well the image of a patch has to fit the patch on the other side
ON_PLANE = 1e-5  # of the body's length: what ends this near to the plane does not cross it
SYMMETRY_AXIS = {Half.PORT: 1, Half.UPPER: 2}


class Sides(NamedTuple):
    """Patches by where they lie of a mirror plane.

    Attributes
    ----------
    divided : tuple of str
        The plane goes through them.
    pairs : tuple of (str, str)
        A patch at negative coordinates, and the patch of which it is the image.
    alone : tuple of str
        At positive coordinates, and no image of a patch on the other side.
    """

    divided: tuple[str, ...]
    pairs: tuple[tuple[str, str], ...]
    alone: tuple[str, ...]


def sides(body: TowedBody, axis: int) -> Sides:
    """Which patches a plane through the origin divides, and which are images of each other.

    Parameters
    ----------
    body : TowedBody
    axis : int
        Across which the plane lies: 1 for y = 0, 2 for z = 0.
    """
    near = SAME * body.length
    corners = body.vertices[body.faces]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    divided: list[str] = []
    inside: dict[str, tuple[Array, float]] = {}
    outside: dict[str, tuple[Array, float]] = {}
    for i, name in enumerate(body.patches):
        mine = body.patch == i
        across = corners[mine][:, :, axis]
        area = float(areas[mine].sum())
        centre = np.average(corners[mine].mean(axis=1), axis=0, weights=areas[mine])
        if across.min() < -ON_PLANE * body.length and across.max() > ON_PLANE * body.length:
            divided.append(name)
        else:
            (inside if centre[axis] < 0.0 else outside)[name] = (centre, area)
    turn = np.where(np.arange(3) == axis, -1.0, 1.0)
    pairs, alone = [], []
    for name, (centre, area) in outside.items():
        image = [
            n for n, (c, a) in inside.items()
            if np.linalg.norm(turn * centre - c) < near and abs(a - area) < SAME * area
        ]  # fmt: skip
        if len(image) == 1:
            pairs.append((image[0], name))
        else:
            alone.append(name)
    return Sides(tuple(divided), tuple(pairs), tuple(alone))


def mirrored_axes(body: TowedBody, half: Half) -> tuple[int, ...]:
    """Axes across whose plane the mesh of one side is mirrored: 1 for y = 0, 2 for z = 0.

    A smooth hull's mesh comes out alike on both sides, a fin's does not. But where a sharp trailing edge lies in the plane, the
    cells between fin and plane are wedges of its half angle: layers end there, mirrored faces have a skewness of 4 to 8, and
    SUBOFF's sail alone loses a fifth of its lift. Such a body is meshed whole.

    Parameters
    ----------
    body : TowedBody
    half : Half
    """
    if not foils(body) and not edges(body).sharp.any():
        return ()
    cut = None if half is Half.WHOLE else SYMMETRY_AXIS[half]
    return tuple(
        axis for axis in (1, 2)
        if body.mirrors[axis] and axis != cut and not lies_in(body, axis) and not sides(body, axis).alone
    )  # fmt: skip


def images(body: TowedBody, half: Half, mirrored: tuple[int, ...]) -> dict[int, tuple[tuple[str, str], ...]]:
    """After the mesh was mirrored across each axis in turn: patches that hold their images' faces, and whose these are.

    Parameters
    ----------
    body : TowedBody
    half : Half
    mirrored : tuple of int
        Axes, in the order in which they are mirrored.

    Returns
    -------
    dict of int to tuple of (str, str)
        By axis; of a patch, only where the mesh has faces of it by then.
    """
    lowest = {
        name: body.vertices[np.unique(body.faces[body.patch == k])].min(axis=0) for k, name in enumerate(body.patches)
    }
    cut = () if half is Half.WHOLE else (SYMMETRY_AXIS[half],)
    out = {}
    for k, axis in enumerate(mirrored):
        one_sided = (*cut, *mirrored[k + 1 :])
        pairs = sides(body, axis).pairs
        out[axis] = tuple(p for p in pairs if all(lowest[p[0]][other] < 0.0 for other in one_sided))
    return out

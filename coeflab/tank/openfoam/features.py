"""Edges that the mesh of a body has to keep: sharp ones, and those where an appendage stands on another patch."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, brief, locked

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody

SHARP = 30.0  # deg between the normals of two triangles
WELD, SHORTEST, LOWEST = (
    2.5e-7,
    2.5e-7,
    5e-6,
)  # of the body's length: one point; an edge; the height of a triangle with a normal
FOIL = 0.35  # thickness over the smaller of the other two extents, of a patch that is a foil
APPENDED = 0.5  # chord over the body's length, of an appendage
IN_PLANE, MUCH = 1e-3, 0.01  # of the body's length: how near to a plane an edge lies in it; how much of it counts


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Edges:
    """Edges of a surface.

    Attributes
    ----------
    ends : (n, 2, 3) array
        m.
    patches : (n, 2) array of int
        On both sides.
    sharp : (n,) array of bool
        By the angle between the triangles; others are there because two patches meet.
    """

    ends: Array
    patches: NDArray[np.int64]
    sharp: NDArray[np.bool_]

    def __post_init__(self) -> None:
        object.__setattr__(self, "ends", locked(self.ends))
        object.__setattr__(self, "patches", locked(self.patches, np.int64))
        object.__setattr__(self, "sharp", locked(self.sharp, np.bool_))


def is_appended(body: TowedBody, patch: str) -> bool:
    """Whether a patch is an appendage, by its chord."""
    return body.chord.get(patch, body.length) < APPENDED * body.length


@functools.lru_cache(maxsize=4)  # all meshes of a tow have the same
def foils(body: TowedBody) -> frozenset[str]:
    """Patches that carry lift: appendages, and what is as thin as a wing, such as a plane towed alone.

    Parameters
    ----------
    body : TowedBody

    Examples
    --------
    >>> from coeflab.bodies.readers import read_body
    >>> from coeflab.core.files import shipped
    >>> from coeflab.tank.towed_body import towed
    >>> body = towed(read_body(shipped("geometry") / "finned_spheroid" / "body.toml"), np.zeros(3), panels=2000)
    >>> sorted(foils(body))
    ['rudder_lower', 'rudder_upper']
    """
    found = set()
    for k, patch in enumerate(body.patches):
        extents = np.sort(np.ptp(body.vertices[np.unique(body.faces[body.patch == k])], axis=0))
        if is_appended(body, patch) or extents[0] < FOIL * extents[1]:
            found.add(patch)
    return frozenset(found)


@functools.lru_cache(maxsize=4)
def edges(body: TowedBody, angle: float = SHARP) -> Edges:
    """Sharp edges, and those between two patches.

    Triangles thinner than `LOWEST`, which a union of parts leaves, have no normal that could be trusted: their edges are not
    called sharp.

    Parameters
    ----------
    body : TowedBody
    angle : float
        deg.
    """
    weld = WELD * body.length
    places, names = np.unique(np.round(body.vertices / weld).astype(np.int64), axis=0, return_inverse=True)
    faces, points = names.reshape(-1)[body.faces], places * weld
    whole = np.all(faces != np.roll(faces, 1, axis=1), axis=1)
    faces, patch = faces[whole], body.patch[whole]
    corners = points[faces]
    normal: Array = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1)
    longest = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1)
    trusted = size > LOWEST * body.length * longest
    normal = normal / np.where(size > 0.0, size, 1.0)[:, None]

    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(faces)), 3)
    order = np.lexsort((sides[:, 1], sides[:, 0]))
    sides, owner = sides[order], owner[order]
    first = np.flatnonzero(np.all(sides[1:] == sides[:-1], axis=1))
    one, other = owner[first], owner[first + 1]
    sharp = (normal[one] * normal[other]).sum(axis=1) < np.cos(np.radians(angle))
    sharp &= trusted[one] & trusted[other]
    ends = points[sides[first]]
    long = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) > SHORTEST * body.length
    selected = (sharp | (patch[one] != patch[other])) & long
    return Edges(ends[selected], np.stack([patch[one], patch[other]], axis=1)[selected], sharp[selected])


def features(body: TowedBody, low: Array, high: Array) -> dict[str, Array]:
    """The edges in a domain to which the mesh is snapped, by the patch whose cells are refined there, (n, 2, 3).

    An edge of a foil is the foil's; where two foils meet, the later patch's. Of hulls only sharp edges count: where a hull and
    its stern meet there is nothing to be seen in the flow.

    Parameters
    ----------
    body : TowedBody
    low, high : (3,) array
        Corners of the domain, m; edges in a cut belong to it.
    """
    found = edges(body)
    slack = IN_PLANE * body.length
    within = np.all((found.ends > low) & (found.ends <= high + 1e-3 * slack), axis=(1, 2))
    is_foil = np.array([patch in foils(body) for patch in body.patches])[found.patches]
    owner = np.where(is_foil.all(axis=1), found.patches.max(axis=1), found.patches[:, 0])
    owner = np.where(is_foil[:, 1] & ~is_foil[:, 0], found.patches[:, 1], owner)
    wanted = within & (is_foil.any(axis=1) | found.sharp)
    out = {}
    for k, patch in enumerate(body.patches):
        own = wanted & (owner == k)
        if own.any():
            out[patch] = found.ends[own]
    return out


def lies_in(body: TowedBody, axis: int) -> bool:
    """Whether a sharp edge, such as the trailing edge of a fin, lies in the plane through the origin across an axis.

    Parameters
    ----------
    body : TowedBody
    axis : int
    """
    found = edges(body)
    near = np.all(np.abs(found.ends[:, :, axis]) < IN_PLANE * body.length, axis=1) & found.sharp
    length = np.linalg.norm(found.ends[near, 1] - found.ends[near, 0], axis=1).sum()
    return bool(length > MUCH * body.length)

"""How fine a mesh is where: domain, cells, boxes and layers, from the body and a few numbers of the user.

Everything is a share of the body's length, of the radius at its ends or of a chord, so that equal shapes get equal meshes. A
grid of another size has all its edges scaled: levels, boxes and layers stay, and the grids of a family are similar.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from coeflab.core.declarations import ABOVE_ZERO, TABLE, Declaration, Pure, Within
from coeflab.core.errors import InputError, shown
from coeflab.core.types import Array, brief, locked, locking
from coeflab.law.scaling import Conditions
from coeflab.tank.openfoam.features import foils, is_appended
from coeflab.tank.openfoam.layers import Layers, Wall, layers
from coeflab.tank.openfoam.mirroring import SYMMETRY_AXIS
from coeflab.tank.test_matrix import Half

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody

Positive = Annotated[Pure, ABOVE_ZERO]
Distance = Annotated[
    Pure, Within(lambda v: "0.5 or more, else the body fills the domain" if v < 0.5 else "", schema={"minimum": 0.5})
]
MOST_CELLS = 3e7  # some 50 GB of memory
Countable = Annotated[
    Positive, Within(lambda v: f"{MOST_CELLS:g} at most" if v > MOST_CELLS else "", schema={"maximum": MOST_CELLS})
]

FAR_CELL = 0.082  # edge of the cells far away, over the distance from the body to the sides of the domain
CELLS_IN_RADIUS, FINER_AT_ENDS, END_DEPTH = 4.0, 2, 0.01
SHORT = 0.5  # of the body's length: a part of the hull by its extent
# How far boxes of finer cells reach behind, ahead of and beside the hull and its ends, in lengths of the body, and how much of the hull
# those at its ends hold: chosen, and alike on all grids of a family.
MID, NEAR, NOSE, TAIL = (0.72, 0.23, 0.17), (0.15, 0.054, 0.038), (0.0, 0.011, 0.006), (0.06, 0.0, 0.017)
NOSE_HOLDS, TAIL_HOLDS = 0.06, 0.17
NEAR_WAKE, FAR_WAKE = (
    2.0,
    0.07,
)  # of an appendage: chords behind it; half width of the wake to the tail, over its length


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshKeys(Declaration):
    """How the meshes of a tow are made; sizes are those of the grid ``medium``.

    Attributes
    ----------
    wall : {"functions", "resolved", "none"}
        Layers for wall functions, down to the wall, or no layers.
    y_plus : float
        Of the middle of the first cell; unless given, 0.8 for a resolved wall, and for wall functions 60 on hulls, 30 on foils.
    cells_per_length : float
        Along the hull.
    cells_per_chord : float
        Along the mean chord of an appendage.
    cells : table
        Along the chord of a patch, by its name, where it is not ``cells_per_chord``.
    ahead, behind, beside : float
        Distance from the body to the end of the domain, over the length of the body.
    coverage : float
        Share of each patch that layers have to cover, else the mesh gets a remark; unless given, 0.95 of hulls, 0.9 of foils.
    most_cells : float
        A mesh that is expected to have more is not begun.
    """

    wall: Wall = "functions"
    y_plus: Positive | None = None
    cells_per_length: Positive = 280.0
    cells_per_chord: Positive = 90.0
    cells: Annotated[Mapping[str, Any], TABLE] = field(default_factory=lambda: MappingProxyType({}))
    ahead: Distance = 1.4
    behind: Distance = 2.0
    beside: Distance = 1.4
    coverage: Positive | None = None
    most_cells: Countable = 6e6

    def check(self) -> None:
        """Cells of a patch are numbers."""
        for patch, count in self.cells.items():
            if isinstance(count, bool) or not isinstance(count, (int, float)) or not 0.0 < count < 1e6:
                raise InputError(shown(count), "cells along the chord of that patch, above zero", key=f"cells.{patch}")


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("low high")
class Region:
    """A box in which cells have at least a level.

    Attributes
    ----------
    name : str
    low, high : (3,) array
        m.
    level : int
        How often the cells of the background are halved.
    """

    name: str
    low: Array
    high: Array
    level: int


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("low high inside")
class MeshSizes:
    """What the dictionaries of a mesh are written from.

    Attributes
    ----------
    low, high : (3,) array
        Corners of the domain, m.
    counts : (3,) array of int
        Cells of the background.
    levels : mapping of str to int
        Of the cells on each patch.
    regions : tuple of Region
    layers : mapping of str to Layers
        By patch; one without layers is absent.
    inside : (3,) array
        A point in the water.
    """

    low: Array
    high: Array
    counts: Array
    levels: Mapping[str, int]
    regions: tuple[Region, ...]
    layers: Mapping[str, Layers]
    inside: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "counts", locked(self.counts, int))
        for name in ("levels", "layers"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))

    @property
    def edges(self) -> Array:
        """(3,) of a cell of the background, m."""
        edges: Array = (self.high - self.low) / self.counts
        return edges

    def edge(self, patch: str) -> float:
        """Of the cells on a patch, m."""
        return float(self.edges.mean() / 2 ** self.levels[patch])


def mesh_sizes(
    body: TowedBody, size: float, half: Half, keys: MeshKeys, conditions: Conditions, domain: float = 1.0,
    mirrored: tuple[int, ...] = (),
) -> MeshSizes:  # fmt: skip
    """How fine the mesh of a body is where.

    Parameters
    ----------
    body : TowedBody
    size : float
        Of the grid.
    half : Half
    keys : MeshKeys
    conditions : Conditions
    domain : float
        Factor on the distances to the ends of the domain; cells about the body stay what they are.
    mirrored : tuple of int
        Axes across which the mesh is to be mirrored (`mirrored_axes`): it is made for negative coordinates only.

    Raises
    ------
    InputError
        ``cells`` names a patch that the body does not have; layers are asked for and the viscosity is not given; the body is not
        its own mirror image in the cut.
    """
    _usable(body, half, keys, conditions)
    length, patches = body.length, _patches(body)
    hull = np.concatenate([x for name, x in patches.items() if not is_appended(body, name)] or [body.vertices])
    edge = length / keys.cells_per_length
    below = max(round(float(np.log2(FAR_CELL * keys.beside * length / edge))), 1)
    base = edge * 2.0**below
    levels = {name: _level(body, name, points, base, below, keys, patches) for name, points in patches.items()}
    regions = (*_hull_regions(body, hull, edge, below), *_appendage_regions(body, patches, levels, below))
    low, high = body.vertices.min(0), body.vertices.max(0)
    margin = (
        domain * length * np.array([[keys.behind, keys.beside, keys.beside], [keys.ahead, keys.beside, keys.beside]])
    )
    low, high = np.floor((low - margin[0]) / base) * base, np.ceil((high + margin[1]) / base) * base
    high[[*mirrored, *([SYMMETRY_AXIS[half]] if half is not Half.WHOLE else [])]] = 0.0
    return MeshSizes(
        low=low,
        high=high,
        counts=np.maximum(np.rint((high - low) / (size * base)), 1),
        levels=levels,
        regions=regions,
        layers={
            name: result
            for name in patches
            if (result := layers(body, name, base / 2 ** levels[name], keys.wall, keys.y_plus, conditions))
        },
        inside=low + (high - low) * np.array([0.9713, 0.0387, 0.0431]),
    )


def _usable(body: TowedBody, half: Half, keys: MeshKeys, conditions: Conditions) -> None:
    for patch in keys.cells:
        if patch not in body.patches:
            raise InputError(
                f"cells of a patch {shown(patch)}", f"one of {', '.join(body.patches)}", key=f"cells.{patch}"
            )
    if keys.wall != "none" and conditions.viscosity is None:
        raise InputError("no viscosity", "one, for the thickness of the layers", key="conditions.viscosity")
    if half is not Half.WHOLE and not body.mirrors[SYMMETRY_AXIS[half]]:
        raise InputError(f"half a domain, {half}", f"a body that is its own mirror image in {half[0]} = 0")


def _patches(body: TowedBody) -> dict[str, Array]:
    """The points of each patch's triangles, (n, 3)."""
    return {name: body.vertices[np.unique(body.faces[body.patch == k])] for k, name in enumerate(body.patches)}


def _level(
    body: TowedBody, patch: str, points: Array, base: float, below: int, keys: MeshKeys, patches: Mapping[str, Array]
) -> int:
    """From cells along a chord; a short part of the hull on which appendages stand, such as the stern, is one finer."""
    if is_appended(body, patch) or patch in keys.cells:
        count = keys.cells.get(patch, keys.cells_per_chord)
        return max(round(float(np.log2(base * count / body.chord.get(patch, body.length)))), 1)
    start, end = points[:, 0].min(), points[:, 0].max()
    others = (other[:, 0] for name, other in patches.items() if is_appended(body, name))
    carries = any(start < x.mean() < end for x in others)
    return below + int(carries and end - start < SHORT * body.length)


def _hull_regions(body: TowedBody, hull: Array, edge: float, below: int) -> Iterator[Region]:
    """About the hull and its ends, in lengths of the body; a blunt end has cells of a quarter of its radius."""
    length, low, high = body.length, hull.min(0), hull.max(0)
    yield Region("mid", *_grown(body.vertices, length, *MID), max(below - 2, 0))
    yield Region("near", *_grown(hull, length, *NEAR), max(below - 1, 0))
    nose, tail = _grown(hull, length, *NOSE), _grown(hull, length, *TAIL)
    yield Region("nose", np.array([high[0] - NOSE_HOLDS * length, *nose[0][1:]]), nose[1], below)
    yield Region("tail", tail[0], np.array([low[0] + TAIL_HOLDS * length, *tail[1][1:]]), below)
    for name, way in (("nose_tip", 1.0), ("tail_tip", -1.0)):
        radius, tip = _end(hull, way, END_DEPTH * length)
        finer = min(round(float(np.log2(max(edge * CELLS_IN_RADIUS / radius, 1.0)))), FINER_AT_ENDS)
        if finer:
            behind = tip - np.array([way * 2.0 * radius, 0.0, 0.0])
            corners = np.array([tip + way * np.array([radius, 0.0, 0.0]), behind])
            side = np.array([0.0, 2.0 * radius, 2.0 * radius])
            yield Region(name, corners.min(0) - side, corners.max(0) + side, below + finer)


def _grown(points: Array, length: float, behind: float, ahead: float, beside: float) -> tuple[Array, Array]:
    return (
        points.min(0) - length * np.array([behind, beside, beside]),
        points.max(0) + length * np.array([ahead, beside, beside]),
    )


def _end(points: Array, way: float, depth: float) -> tuple[float, Array]:
    """Radius of the sphere through the foremost or aftmost point and the rim of the cap of a depth, and that point."""
    along = way * points[:, 0]
    tip = points[along > along.max() - 1e-9 * np.ptp(along)].mean(0)
    cap = points[along > along.max() - depth]
    down, aside = np.abs(cap[:, 0] - tip[0]), np.hypot(*(cap - tip)[:, 1:].T)
    rim = int(np.argmax(aside))
    flat = down[rim] < 1e-3 * aside[rim] or aside[rim] == 0.0
    return (np.inf if flat else float((down[rim] ** 2 + aside[rim] ** 2) / (2.0 * down[rim]))), tip


def _appendage_regions(
    body: TowedBody, patches: Mapping[str, Array], levels: Mapping[str, int], below: int
) -> Iterator[Region]:
    """About each foil by itself, and its wake: two chords, and to the tail where that is farther."""
    tail = float(body.vertices[:, 0].min())
    for patch in patches:
        if patch not in foils(body):
            continue
        below = below if is_appended(body, patch) else levels[patch] - 2  # a wing alone is the body
        margin, near = 0.25 * body.chord[patch], NEAR_WAKE * body.chord[patch]
        for k, points in enumerate(_pieces(body, patch), start=1):
            low, high = points.min(0) - margin, points.max(0) + margin
            yield Region(f"{patch}_{k}", low, high, max(levels[patch] - 2, below))
            yield Region(f"{patch}_{k}_wake", low - np.array([near, margin, margin]), high + margin, below)
            far = float(points[:, 0].min()) - tail
            if far > near:
                aside = np.array([0.0, 1.0, 1.0]) * FAR_WAKE * far
                start = np.array([tail, *points.min(0)[1:]])
                yield Region(f"{patch}_{k}_far", start - aside, points.max(0) + aside, below)


def _pieces(body: TowedBody, patch: str) -> Iterator[Array]:
    """Points of each connected piece of a patch, in the order of the first vertex."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    faces = body.faces[body.patch == body.patches.index(patch)]
    names, local = np.unique(faces, return_inverse=True)
    local = local.reshape(faces.shape)
    rows, columns = local[:, [0, 1]].ravel(), local[:, [1, 2]].ravel()
    count, piece = connected_components(
        coo_array((np.ones(len(rows)), (rows, columns)), (len(names), len(names))), False
    )
    for k in range(count):
        yield body.vertices[names[piece == k]]

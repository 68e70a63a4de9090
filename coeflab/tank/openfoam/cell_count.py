"""How many cells snappyHexMesh will make: the same halving of cells, counted on whole numbers instead of built.

A cell of a level is three whole numbers. Cells that the surface crosses or that lie in a box are halved until they have their
level, cells about them so that levels follow each other in steps, and those inside the body are dropped.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.tank.openfoam.mesh_sizes import MOST_CELLS, MeshSizes

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody

BETWEEN_LEVELS = 3  # cells of a level before the next
SAMPLES = 5.0  # points on the surface a cell's face
NEAREST = 5  # of these points, one in so many tells inside from outside
LOOKED_AT = 8_000  # cells near the body that are asked whether they lie inside
BITS = 21  # a coordinate; three make one whole number
GOLDEN = np.array([0.7548776662466927, 0.5698402909980532])  # R2 sequence: points that spread evenly over a square
Keys = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class CellCount:
    """What a mesh will have.

    Attributes
    ----------
    cells : float
        Layers included.
    faces : float
        On the body.
    """

    cells: float
    faces: float


def cell_count(body: TowedBody, sizes: MeshSizes) -> CellCount:
    """What the mesh of a body will have; within a fifth on the meshes that were made of it.

    Beyond 3e7 cells it is only said what the mesh has at least: to count them takes as much memory as they do.

    Parameters
    ----------
    body : TowedBody
    sizes : MeshSizes
    """
    if (least := _least(body, sizes)) > MOST_CELLS:
        return CellCount(least, 0.0)
    points, normals, levels, on_body = _sampled(body, sizes)
    refined = _refined(points, levels, sizes)
    layers = sum(faces * sizes.layers[name].count for name, faces in on_body.items() if name in sizes.layers)
    leaves = float(sizes.counts.prod()) + 7.0 * sum(map(len, refined))
    return CellCount(leaves - _inside(refined, points, normals, sizes) + layers, sum(on_body.values()))


def _least(body: TowedBody, sizes: MeshSizes) -> float:
    """A cell a face on half of the largest patch, and half of the largest region, where the body may fill the rest."""
    corners = body.vertices[body.faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2.0
    on_body = (areas[body.patch == k].sum() / sizes.edge(name) ** 2 for k, name in enumerate(body.patches))
    within = (
        np.prod(
            np.clip(np.minimum(r.high, sizes.high) - np.maximum(r.low, sizes.low), 0.0, None)
            * 2.0**r.level
            / sizes.edges
        )
        for r in sizes.regions
    )
    return float(max(*on_body, *within)) / 2.0


def _sampled(body: TowedBody, sizes: MeshSizes) -> tuple[Array, Array, NDArray[np.int64], dict[str, float]]:
    """Points on the surface in the domain, its normals and levels there, and faces on each patch."""
    corners = body.vertices[body.faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2.0
    areas = np.linalg.norm(across, axis=1)
    points, normals, levels, on_body = [], [], [], {}
    for k, name in enumerate(body.patches):
        here = np.flatnonzero((body.patch == k) & (areas > 0.0))
        if not here.size:
            continue
        run = np.cumsum(areas[here])
        count = int(np.ceil(SAMPLES * run[-1] / sizes.edge(name) ** 2))
        triangle = here[np.searchsorted(run, (np.arange(count) + 0.5) * run[-1] / count).clip(max=here.size - 1)]
        a, b = np.sqrt(np.mod(np.arange(count) * GOLDEN[0], 1.0)), np.mod(np.arange(count) * GOLDEN[1], 1.0)
        weights = np.column_stack([1.0 - a, a * (1.0 - b), a * b])
        found = np.einsum("ij,ijk->ik", weights, corners[triangle])
        normal = across[triangle] / areas[triangle, None]
        wet = np.all((found >= sizes.low) & (found < sizes.high), axis=1)
        points.append(found[wet])
        normals.append(normal[wet])
        levels.append(np.full(wet.sum(), sizes.levels[name]))
        on_body[name] = float(wet.sum()) / SAMPLES
    return np.concatenate(points), np.concatenate(normals), np.concatenate(levels), on_body


def _refined(points: Array, levels: NDArray[np.int64], sizes: MeshSizes) -> list[Keys]:
    """Cells of each level that are halved, finest needs first."""
    finest = max([*sizes.levels.values(), *(region.level for region in sizes.regions)])
    refined: list[Keys] = [np.empty(0, np.int64)] * finest
    for level in reversed(range(finest)):
        wanted = [_crossed(points[levels > level], level, sizes), *_in_regions(level, sizes)]
        if level + 1 < finest:
            wanted.append(_once(_packed(_unpacked(_spread(refined[level + 1], level + 1, sizes)) >> 1)))
        refined[level] = _once(np.concatenate(wanted))
    return refined


def _crossed(points: Array, level: int, sizes: MeshSizes) -> Keys:
    """Cells on both sides of the surface: their centres lie on both sides of it, along one axis."""
    if not len(points):
        return np.empty(0, np.int64)
    places = (points - sizes.low) / sizes.edges * 2.0**level
    own, found = np.floor(places).astype(np.int64), []
    for axis in range(3):
        for other in (-0.5, 0.5):
            cell = own.copy()
            cell[:, axis] = np.floor(places[:, axis] + other)
            found.append(_once(_packed(cell[_within(cell, level, sizes)])))
    return _once(np.concatenate(found))


def _in_regions(level: int, sizes: MeshSizes) -> Iterator[Keys]:
    edges = sizes.edges / 2.0**level
    for region in sizes.regions:
        if region.level > level:
            first = np.maximum(np.ceil((region.low - sizes.low) / edges - 0.5), 0.0).astype(int)
            last = np.minimum(np.floor((region.high - sizes.low) / edges - 0.5) + 1.0, sizes.counts * 2**level).astype(
                int
            )
            if np.all(last > first):
                grid = np.meshgrid(*map(np.arange, first, last), indexing="ij")
                yield _packed(np.stack([axis.ravel() for axis in grid], axis=1))


def _spread(cells: Keys, level: int, sizes: MeshSizes) -> Keys:
    """The cells and those that lie up to so many faces away."""
    step = np.vstack([np.eye(3, dtype=np.int64), -np.eye(3, dtype=np.int64)])
    rim = cells
    for _ in range(BETWEEN_LEVELS):
        near = (_unpacked(rim)[:, None, :] + step).reshape(-1, 3)
        rim = _without(_packed(near[_within(near, level, sizes)]), cells)
        cells = _once(np.concatenate([cells, rim]))
    return cells


def _within(cells: Keys, level: int, sizes: MeshSizes) -> NDArray[np.bool_]:
    inside: NDArray[np.bool_] = np.all((cells >= 0) & (cells < sizes.counts * 2**level), axis=1)
    return inside


def _inside(refined: list[Keys], points: Array, normals: Array, sizes: MeshSizes) -> float:
    """Cells whose centre lies inside the body: that is behind the surface point next to it."""
    from scipy.spatial import cKDTree

    low, high = points.min(0), points.max(0)
    tree, total = cKDTree(points[::NEAREST]), 0.0
    for level in range(len(refined) + 1):
        leaves = _leaves(refined, level)
        centres = sizes.low + (_unpacked(leaves) + 0.5) * sizes.edges / 2.0**level
        centres = centres[np.all((centres > low) & (centres < high), axis=1)]
        seen = centres[:: 1 + len(centres) // LOOKED_AT]
        if len(seen):
            _, nearest = tree.query(seen)
            nearest = nearest * NEAREST
            behind = ((seen - points[nearest]) * normals[nearest]).sum(1) < 0.0
            total += float(behind.mean()) * len(centres)
    return total


def _leaves(refined: list[Keys], level: int) -> Keys:
    """Cells of a level that stay, children of halved ones; of the background none, as they are far from the body."""
    if level == 0:
        return np.empty(0, np.int64)
    corner = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    children = _packed((2 * _unpacked(refined[level - 1])[:, None, :] + corner).reshape(-1, 3))
    return _without(children, refined[level]) if level < len(refined) else children


def _once(keys: Keys) -> Keys:
    """Sorted, each key once; several times as fast as numpy's, which hashes."""
    keys = np.sort(keys)
    once: Keys = keys[np.concatenate([[True], keys[1:] != keys[:-1]])[: len(keys)]]
    return once


def _without(keys: Keys, others: Keys) -> Keys:
    """The keys, each once, that are not among the others, which are sorted."""
    keys = _once(keys)
    if not len(others):
        return keys
    left: Keys = keys[others[np.searchsorted(others, keys).clip(max=len(others) - 1)] != keys]
    return left


def _packed(cells: Keys) -> Keys:
    packed: Keys = (cells[:, 0] << 2 * BITS) | (cells[:, 1] << BITS) | cells[:, 2]
    return packed


def _unpacked(keys: Keys) -> Keys:
    mask = (1 << BITS) - 1
    return np.stack([keys >> 2 * BITS, (keys >> BITS) & mask, keys & mask], axis=1)

"""Meshes of one body at three panel counts, as similar to each other as they can be had."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.kernels.panel_geometry import bisected, slivers, split_in_four
from coeflab.model.mesh import TriangleMesh
from coeflab.model.meshing import FEWEST, meshed
from coeflab.model.shape import Shape

Array = NDArray[np.float64]
RATIO = 4
RUNGS, LEAST_STEP = 28, 3
LOWEST, HIGHEST = 0.6, 1.1
PRICE = 0.1


def family(shape: Shape, panels: int, most: int = 3) -> tuple[Array, ...]:
    """Corners of one to three meshes, the finest first, each with about a quarter of the panels of the one before.

    Parameters
    ----------
    shape : Shape
    panels : int
        Of the finest, about: from 0.6 to 1.1 times that, so that the coarser ones can be similar. Facets of a mesh that
        has fewer are divided, which leaves its surface as it is; it can have up to twice as many then.
    most : int
        1 for the finest alone, which is then not chosen for its likeness to others; or 3.

    Returns
    -------
    tuple of (n, 3, 3) arrays
        Panel, corner, component, m. Fewer than three where no coarser mesh can be made.

    Raises
    ------
    InputError
        The shape cannot be meshed.
    """
    finest = meshed(shape, panels)
    if isinstance(shape, TriangleMesh):
        return _of_mesh(finest, panels)[:most]
    if most == 1:
        return (_corners(finest),)
    ladder = {len(finest.faces): finest}
    for count in np.geomspace(max(panels / 1.5 / RATIO**2, FEWEST), panels, RUNGS).astype(int):
        try:
            rung = meshed(shape, int(count))
        except InputError:
            continue
        ladder[len(rung.faces)] = rung
    return tuple(_corners(ladder[n]) for n in _best(sorted(ladder, reverse=True), panels))


def _corners(mesh: TriangleMesh) -> Array:
    """Of the faces that have an area; decimation can leave others, which are nothing to integrate over."""
    corners = mesh.vertices[mesh.faces]
    return np.asarray(corners[~slivers(corners)])


def _best(counts: list[int], panels: int) -> tuple[int, ...]:
    """Three counts in steps of four; a slightly smaller finest one is a price worth paying for exact steps."""

    def miss(steps: tuple[int, ...]) -> float:
        ratios = np.array(steps[:-1]) / np.array(steps[1:])
        return float(np.abs(np.log(ratios / RATIO)).sum() + PRICE * np.log(panels / steps[0]))

    fine = [n for n in counts if LOWEST * panels <= n <= HIGHEST * panels] or counts[:1]
    triples = [t for t in product(fine, counts, counts) if t[0] >= LEAST_STEP * t[1] >= LEAST_STEP**2 * t[2]]
    if triples:
        return min(triples, key=miss)
    pairs = [p for p in product(fine, counts) if p[0] >= LEAST_STEP * p[1]]
    return min(pairs, key=miss) if pairs else (fine[0],)


def _of_mesh(mesh: TriangleMesh, panels: int) -> tuple[Array, ...]:
    """The same facets divided where there is room for it; else decimations, which are similar only roughly."""
    corners = [_corners(mesh)]
    if len(mesh.faces) * RATIO**2 <= panels:
        coarse = bisected(corners[0], panels // RATIO**2)
        middle = split_in_four(coarse)
        return split_in_four(middle), middle, coarse
    if len(mesh.faces) * RATIO <= panels:
        corners.insert(0, split_in_four(corners[0]))
    while len(corners) < 3:
        count = len(corners[-1]) // RATIO
        try:
            coarser = _corners(meshed(mesh, max(count, FEWEST)))
        except InputError:
            break
        if LEAST_STEP * len(coarser) > len(corners[-1]):
            break
        corners.append(coarser)
    return tuple(corners)

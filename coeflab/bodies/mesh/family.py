"""Meshes of one body at three panel counts, as similar to each other as they can be had.

Panels are smaller where the body is thin and along its sharp edges; sheets without thickness along their rims.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from coeflab.bodies.mesh.crossing_faces import crossing_faces
from coeflab.bodies.mesh.decimation import decimated
from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import FEWEST, meshed
from coeflab.bodies.mesh.solids import divided, solid, surface
from coeflab.bodies.panel_solver.panels import (
    bisected,
    graded,
    panels_of,
    sharp_points,
    side_of,
    slivers,
    split_in_four,
    thin_share,
    unfit_share,
)
from coeflab.bodies.shape import Shape
from coeflab.core.errors import InputError
from coeflab.core.machine import stage
from coeflab.core.types import Array, locked, remembered

RATIO = 4  # of panels from rung to rung: panels half as long
OWN = 1.4  # panels asked for over the facets of a mesh, up to which these serve as they are
RUNGS, LEAST_STEP = 28, 3
LEAST, HIGHEST = 0.6, 1.1
PRICE = 0.1  # of fewer panels at the top, in units of a ratio that is off by one e-fold
MOST_UNFIT, MOST_SPLIT, CHANGE = 0.2, 40, 0.08
MOST_THIN, FIRST_SHARE = 0.02, 0.6  # of the area, from which panels are graded; of the panels, before that
REMEMBERED = 4  # families; 0.6 MB each of 6,000 panels


@remembered(REMEMBERED)
def family(shape: Shape, panels: int, most: int = 3) -> tuple[Array, ...]:
    """Corners of one to three meshes, the finest first, each with about a quarter of the panels of the one before.

    Parameters
    ----------
    shape : Shape
    panels : int
        Of the finest, about: from 0.6 to 1.1 times that, so that the coarser ones can be similar. The facets of a mesh
        are kept where they are about as many, and much fewer divided, to up to twice as many, where they are compact;
        else long facets are split, and what comes of that is decimated.
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
    if isinstance(shape, TriangleMesh) and shape.remade is None:
        return tuple(map(locked, _of_mesh(shape, panels, most)))
    finest = meshed(shape, panels)
    if most == 1:
        return (locked(_corners(finest)),)
    ladder = {len(finest.faces): finest}
    for count in np.geomspace(max(panels / 1.5 / RATIO**2, FEWEST), panels, RUNGS).astype(int):
        try:
            rung = meshed(shape, int(count))
        except InputError:
            continue
        ladder[len(rung.faces)] = rung
    return tuple(locked(_corners(ladder[n])) for n in _best(sorted(ladder, reverse=True), panels))


def _corners(mesh: TriangleMesh) -> Array:
    """Of the faces that have an area; decimation can leave others, which are nothing to integrate over."""
    corners = mesh.vertices[mesh.faces]
    return np.asarray(corners[~slivers(corners)])


def _best(counts: list[int], panels: int) -> tuple[int, ...]:
    """Three counts in steps of four; a slightly smaller finest one is a price worth paying for exact steps."""

    def miss(steps: tuple[int, ...]) -> float:
        ratios = np.array(steps[:-1]) / np.array(steps[1:])
        return float(np.abs(np.log(ratios / RATIO)).sum() + PRICE * np.log(panels / steps[0]))

    fine = [n for n in counts if LEAST * panels <= n <= HIGHEST * panels] or counts[:1]
    triples = [t for t in product(fine, counts, counts) if t[0] >= LEAST_STEP * t[1] >= LEAST_STEP**2 * t[2]]
    if triples:
        return min(triples, key=miss)
    pairs = [p for p in product(fine, counts) if p[0] >= LEAST_STEP * p[1]]
    return min(pairs, key=miss) if pairs else (fine[0],)


def _of_mesh(mesh: TriangleMesh, panels: int, most: int) -> tuple[Array, ...]:
    """Its own facets where they are fit for panels, divided or as they are; else, and for all that is coarser, others."""
    stage(f"panels from {len(mesh.faces):,} faces")
    own = _corners(mesh)
    if len(own) * RATIO**2 <= panels:
        lines = sharp_points(mesh.vertices, mesh.faces, side_of(mesh.integrals.area, panels))
        coarse = graded(own, panels // RATIO**2, lines)
        if unfit_share(coarse) > MOST_UNFIT:
            coarse = bisected(own, panels // RATIO**2)
        if unfit_share(coarse) <= MOST_UNFIT:
            middle = split_in_four(coarse)
            return (split_in_four(middle), middle, coarse)[:most]
    elif len(own) <= panels <= OWN * len(own) and unfit_share(own) <= MOST_UNFIT:
        found = (own, *_coarser(mesh, most - 1))
        if len(found) == most:
            return _graded(found, panels)
    finest = meshed(_split(mesh, panels), panels)
    if thin_share(panels_of(_corners(finest))) <= MOST_THIN:
        return _corners(finest), *_coarser(finest, most - 1)
    finest = meshed(finest, max(int(FIRST_SHARE * panels), FEWEST))
    return _graded((_corners(finest), *_coarser(finest, most - 1)), panels)


def _graded(meshes: tuple[Array, ...], panels: int) -> tuple[Array, ...]:
    """Each with smaller panels where the body is thinner than these are large, up to the count that it stands for."""
    if thin_share(panels_of(meshes[0])) <= MOST_THIN:
        return meshes
    return tuple(graded(corners, panels * len(corners) // len(meshes[0])) for corners in meshes)


def _split(mesh: TriangleMesh, panels: int) -> TriangleMesh:
    """The same surface without long facets, which decimation would leave long; itself where it is not closed as a solid."""
    try:
        whole = solid(mesh.vertices, mesh.faces)
    except ValueError:
        return mesh
    parted = divided(whole, side_of(mesh.integrals.area, panels), MOST_SPLIT * panels)
    return TriangleMesh(*surface(parted), mesh.exact_volume)


def _coarser(mesh: TriangleMesh, most: int) -> list[Array]:
    """Decimations to a quarter and a sixteenth; fewer where the body does not bear it, or parts would come to cross."""
    vertices, faces, out = mesh.vertices, mesh.faces, list[Array]()
    while len(out) < most:
        before = len(faces)
        vertices, faces = decimated(vertices, faces, max(before // RATIO, FEWEST))
        if LEAST_STEP * len(faces) > before or abs(mesh_integrals(vertices, faces).volume / mesh.volume - 1.0) > CHANGE:
            break
        if crossing_faces(vertices, faces):
            break
        corners = vertices[faces]
        out.append(np.asarray(corners[~slivers(corners)]))
    return out

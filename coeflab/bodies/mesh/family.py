"""Meshes of one body at three panel counts, as similar to each other as they can be had.

How far the volume of panels is from that of the body they stand for, and what that may cost its added mass.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from coeflab.bodies.body import Body
from coeflab.bodies.mesh.decimation import decimated
from coeflab.bodies.mesh.mesh import TriangleMesh, enclosed, facet_deficit, mesh_integrals
from coeflab.bodies.mesh.meshing import FEWEST, meshed
from coeflab.bodies.mesh.solids import divided, solid, surface
from coeflab.bodies.mesh.topology import crossing_faces
from coeflab.bodies.panels.influence import bisected, side_of, slivers, split_in_four, unfit_share
from coeflab.bodies.shape import Shape
from coeflab.core.errors import InputError
from coeflab.core.machine import stage
from coeflab.core.types import Array

RATIO = 4  # of panels from rung to rung: panels half as long
RUNGS, LEAST_STEP = 28, 3
LOWEST, HIGHEST = 0.6, 1.1
PRICE = 0.1  # of fewer panels at the top, in units of a ratio that is off by one e-fold
MOST_UNFIT, MOST_SPLIT, CHANGE = 0.2, 40, 0.08


def family(shape: Shape, panels: int, most: int = 3) -> tuple[Array, ...]:
    """Corners of one to three meshes, the finest first, each with about a quarter of the panels of the one before.

    Parameters
    ----------
    shape : Shape
    panels : int
        Of the finest, about: from 0.6 to 1.1 times that, so that the coarser ones can be similar. Of a mesh, a quarter
        and more of as many facets are kept, and much fewer divided, to up to twice as many, where they are compact;
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
        return _of_mesh(shape, panels, most)
    finest = meshed(shape, panels)
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


def _of_mesh(mesh: TriangleMesh, panels: int, most: int) -> tuple[Array, ...]:
    """Its own facets where they are fit for panels, divided or as they are; else, and for all that is coarser, others."""
    stage(f"panels from {len(mesh.faces):,} faces")
    own = _corners(mesh)
    if len(own) * RATIO**2 <= panels:
        coarse = bisected(own, panels // RATIO**2)
        if unfit_share(coarse) <= MOST_UNFIT:
            middle = split_in_four(coarse)
            return (split_in_four(middle), middle, coarse)[:most]
    elif panels <= RATIO * len(own) <= RATIO * panels and unfit_share(own) <= MOST_UNFIT:
        found = (own, *_coarser(mesh, most - 1))
        if len(found) == most:
            return found
    finest = meshed(_split(mesh, panels), panels)
    return _corners(finest), *_coarser(finest, most - 1)


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


STRONGEST, SAME_BODY = 2.0, 0.05


@dataclass(frozen=True, slots=True)
class VolumeGap:
    """Volume of panels over that of the body, less one.

    Attributes
    ----------
    finest : float
        Of the finest panels as they are.
    left : float
        Of all panels, extrapolated as the square of their size: what no refinement of these panels takes away.
    body : str
        Whose volume that is, in words.
    meshes : int
        How many there were; one alone has no error estimate.
    step : float
        Of the second mesh, less that of the finest; 0 where there is one.
    ratio : float
        Of the panels' sizes in these two.
    """

    finest: float
    left: float
    body: str
    meshes: int
    step: float
    ratio: float

    def cost(self, matrix: Array) -> Array:
        """(6, 6) what may be missing from an added mass: twice what is left of the volume, of the size of each entry.

        Of a long spheroid that is too thin all over, the entry along x goes with the square of the volume, those across
        with the volume itself; of one that is too small all over, the moments with its power 5/3.
        """
        root = np.sqrt(np.abs(np.diag(matrix)))
        return np.asarray(STRONGEST * abs(self.left) * np.outer(root, root))

    def hidden(self, matrix: Array, order: float | None) -> Array:
        """(6, 6) what thinning may hide: with its edges a coarse mesh loses volume, against what its large panels add.

        As `cost`, of the step in volume, and carried on as the extrapolation of this order carries differences.

        Parameters
        ----------
        matrix : (6, 6) array
        order : float or None
            None where there is no extrapolation; 1 is taken then.
        """
        if self.meshes == 1:
            return np.zeros((6, 6))
        root = np.sqrt(np.abs(np.diag(matrix)))
        carried = self.ratio ** (order or 1.0) - 1.0
        return np.asarray(STRONGEST * abs(self.step) / carried * np.outer(root, root))

    @property
    def said(self) -> str:
        """The same in words."""
        out = f"volume of the finest panels {self.finest:+.2%} from {self.body}"
        if self.meshes == 1:
            return out
        return f"{out}, {self.left:+.2%} once extrapolated: carried in the error estimate"


def volume_gap(body: Body, mesh: TriangleMesh, meshes: Sequence[Array]) -> VolumeGap:
    """Hold panels against the volume of the body's equations; else as stated, within 5 %; else as its facets suggest.

    Parameters
    ----------
    body : Body
    mesh : TriangleMesh
        The body's own, or one made of its shape.
    meshes : sequence of (n, 3, 3) arrays
        Panel, corner, component, m; the finest first.
    """
    volumes = [enclosed(corners) for corners in meshes]
    whole, name = _whole(body, mesh)
    step, ratio = 0.0, 1.0
    if len(meshes) > 1:
        step, ratio = (volumes[1] - volumes[0]) / whole, float(np.sqrt(len(meshes[0]) / len(meshes[1])))
    finest = volumes[0] / whole - 1.0
    left = finest - step / (ratio**2 - 1.0) if len(meshes) > 1 else finest
    return VolumeGap(finest, left, name, len(meshes), step, ratio)


def _whole(body: Body, mesh: TriangleMesh) -> tuple[float, str]:
    if mesh.exact_volume is not None:
        return mesh.exact_volume, "the body's by its equations"
    # The first configuration is computed from the shape itself; the others were stated.
    stated = [(abs(mesh.volume / c.volume - 1.0), c.volume, c.name) for c in body.configurations[1:] if c.volume]
    if body.shape is mesh and stated:
        off, volume, name = min(stated)
        if off <= SAME_BODY:
            return volume, f"that of {name}"
    smooth = mesh.volume + facet_deficit(mesh.vertices, mesh.faces)
    return smooth, "a smooth surface through the corners of its facets, estimated by the angles between these"

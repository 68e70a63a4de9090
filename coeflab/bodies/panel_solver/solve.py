"""Added mass of a closed body in unbounded fluid by the panel method in its direct formulation.

Green's third identity for the potentials of the six unit motions, constant on each panel and met at its centroid:
2 pi phi + sum of solid angles times phi = - integral of (dphi/dn) / r. Source: Newman, Marine Hydrodynamics (1977),
sections 4.11 and 4.14; Hess & Smith (1967) for the panels. The potential itself is the unknown, not a source strength:
on a smooth body the error falls with the square of the panels' size.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.panel_solver.influence import gradients, seen_by
from coeflab.bodies.panel_solver.panels import Panels, panels_of
from coeflab.bodies.panel_solver.wall import Wall
from coeflab.core.types import Array, brief, locking, remembered
from coeflab.law.transforms import moved

Multiply = Callable[[Array], Array]
TOLERANCE = 5e-7
MOST_STEPS = 200
WORKSPACE = 400 * 2**20
REMEMBERED = 32  # solutions, 6 x 6 each: a body asked for again, with another mass or in other water, has the same


@brief
@dataclass(frozen=True, slots=True)
@locking("matrix")
class PanelSolution:
    """One body on one set of panels.

    Attributes
    ----------
    matrix : (6, 6) array
        Per density, m^3, m^4, m^5, symmetric.
    count : int
    asymmetry : float
        Of the matrix before it was made symmetric, over its largest entry, with half the body's size as the unit of
        length: it vanishes with the panels' size.
    steps : int
        Of the iterative solution.
    residual : float
        Largest of the six, relative to the right-hand side.
    converged : bool
    """

    matrix: Array
    count: int
    asymmetry: float
    steps: int
    residual: float
    converged: bool


def memory_needed(count: int) -> int:
    """Bytes at the peak: the matrix in single precision, and 400 MiB for everything else."""
    return 4 * count**2 + WORKSPACE


@remembered(REMEMBERED)
def panel_added_mass(
    corners: Array, point: Array, compiled: bool, sheets: Array | None = None, wall: Wall | None = None
) -> PanelSolution:
    """Added mass per density about a point.

    Parameters
    ----------
    corners : (n, 3, 3) array
        Panel, corner, component, m; counter-clockwise seen from the fluid; the surface is closed. None where the body
        is of sheets alone.
    point : (3,) array
        m.
    compiled : bool
        By numba, which must be installed; else by numpy. They agree to 1e-6.
    sheets : (m, 3, 3) array, optional
        Panels without thickness, water on both sides: dipoles, whose strength is the jump of the potential. They do not
        reach into the closed surface.
    wall : Wall, optional
        The whole body lies on one side of it.
    """
    if compiled:
        from coeflab.bodies.panel_solver.influence_compiled import influence
    else:
        from coeflab.bodies.panel_solver.influence import influence
    thin = np.zeros((0, 3, 3)) if sheets is None else sheets
    every = np.concatenate([corners, thin])
    low, high = every.min(axis=(0, 1)), every.max(axis=(0, 1))
    middle, scale = (low + high) / 2.0, float(np.max(high - low)) / 2.0
    panels, sheet = panels_of((corners - middle) / scale), panels_of((thin - middle) / scale)
    near = None if wall is None else Wall((wall.point - middle) / scale, wall.normal, wall.factor)
    if panels.count:
        images = [] if near is None else [(near.behind(panels.centre), near.factor)]
        angles, layers = influence(panels, images)
        right = -_with_turning(layers[0], panels.centre)
        for (points, factor), layer in zip(images, layers[1:], strict=True):
            right -= factor * _with_turning(layer, points)
        # A constant potential must come back from a closed surface: its solid angles sum to 2 pi.
        diagonal = 4.0 * np.pi - angles.sum(axis=1, dtype=np.float64)
    else:
        angles, right, diagonal = np.zeros((0, 0), np.float32), np.zeros((0, 6)), np.zeros(0)
    multiply: Multiply = partial(_single, angles)
    if sheet.count:
        multiply, right, diagonal = _with_sheets(panels, sheet, near, angles, right, diagonal)
    potential, steps, residual = _solved(multiply, diagonal, right)
    area, normal = np.concatenate([panels.area, sheet.area]), np.concatenate([panels.normal, sheet.normal])
    motion = _with_turning(normal, np.concatenate([panels.centre, sheet.centre]))
    raw = -(potential * area[:, None]).T @ motion
    units = scale ** np.where(np.arange(6) < 3, 1.5, 2.5)
    matrix = moved((raw + raw.T) / 2.0 * np.outer(units, units), point - middle)
    asymmetry = float(np.max(np.abs(raw - raw.T)) / np.max(np.abs(raw)))
    converged = residual <= TOLERANCE
    return PanelSolution(matrix, len(every), asymmetry, steps, residual, converged)


def _with_sheets(
    panels: Panels, sheet: Panels, near: Wall | None, angles: NDArray[np.float32], right: Array, diagonal: Array
) -> tuple[Multiply, Array, Array]:
    """The system with dipole panels: their columns, and a row each for the velocity through them.

    The rows of sheets are multiplied by the inverse of their own block, so that its poor conditioning does not slow the
    iteration down; the blocks stay apart, as their product costs more than all steps.
    """
    from scipy.linalg import lu_factor, lu_solve

    n, k = panels.count, sheet.count
    # Seen from the sheets themselves; behind a wall the derivative is along the mirrored direction.
    views = [(sheet.centre, sheet.normal, panels.centre, 1.0)]
    if near is not None:
        ways = sheet.normal - 2.0 * (sheet.normal @ near.normal)[:, None] * near.normal
        views.append((near.behind(sheet.centre), ways, near.behind(panels.centre), near.factor))
    velocity, slope = np.zeros((k, k), dtype=np.float32), np.zeros((k, 6))
    back, jump = np.zeros((n, k), dtype=np.float32), np.zeros((k, n), dtype=np.float32)
    for points, way, centres, factor in views:
        velocity += np.float32(factor) * gradients(points, way, sheet)[0]
        if n:
            through, pulled, layer = gradients(points, way, panels)
            slope += factor * np.hstack([pulled, np.cross(way, layer) + np.cross(points, pulled)])
            through *= np.float32(factor)
            jump += through
            seen = seen_by(centres, sheet)[0]
            seen *= np.float32(factor)
            back += seen
    own = -4.0 * np.pi * _with_turning(sheet.normal, sheet.centre) - slope
    block = lu_factor(velocity.astype(float) / (2.0 * np.pi))  # the sheets' unknowns keep the unit of the others

    def multiply(x: Array) -> Array:
        passing = lu_solve(block, _single(jump, x[:n]))
        return np.concatenate([_single(angles, x[:n]) + _single(back, x[n:]), passing])

    return multiply, np.concatenate([right, lu_solve(block, own)]), np.concatenate([diagonal, np.full(k, 2.0 * np.pi)])


def _single(matrix: NDArray[np.float32], x: Array) -> Array:
    """Product in single precision."""
    return np.asarray(matrix @ x.astype(np.float32), dtype=np.float64)


def _with_turning(vector: Array, at: Array) -> Array:
    """(n, 6): a vector and its moment about the origin.

    For the potential of a layer of y x n this is exact on a polyhedron: the integral of (y x n) / r is x times (cross)
    that of n / r, since grad(1/r) is along y - x.
    """
    return np.hstack([vector, np.cross(at, vector)])


def _solved(multiply: Multiply, diagonal: Array, right: Array) -> tuple[Array, int, float]:
    """GMRES on all right-hand sides at once (Saad & Schultz 1986), each with its own Krylov space.

    Returns
    -------
    solution : (n, k) array
    steps : int
    residual : float
        Largest relative residual.
    """
    norm = np.linalg.norm(right, axis=0)
    still = norm == 0.0
    norm[still] = 1.0
    basis = [right / norm]
    count = right.shape[1]
    hessenberg = np.zeros((count, MOST_STEPS + 1, MOST_STEPS))
    start = np.zeros((count, MOST_STEPS + 1))
    start[:, 0] = ~still
    for step in range(MOST_STEPS):
        last = basis[-1]
        vector = multiply(last) + diagonal[:, None] * last
        for _ in range(2):
            for k, old in enumerate(basis):
                along = np.einsum("nk,nk->k", old, vector)
                hessenberg[:, k, step] += along
                vector -= old * along
        length = np.linalg.norm(vector, axis=0)
        hessenberg[:, step + 1, step] = length
        basis.append(vector / np.where(length > 0.0, length, 1.0))
        small = hessenberg[:, : step + 2, : step + 1]
        weights = np.stack([np.linalg.lstsq(h, s[: step + 2], rcond=None)[0] for h, s in zip(small, start)])
        left = start[:, : step + 2] - np.einsum("kij,kj->ki", small, weights)
        residual = float(np.linalg.norm(left, axis=1).max())
        if residual <= TOLERANCE:
            break
    return np.einsum("mnk,km->nk", np.stack(basis[:-1]), weights) * norm, step + 1, residual

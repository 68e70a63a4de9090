"""Added mass of a closed body in unbounded fluid by the panel method in its direct formulation.

Green's third identity for the potentials of the six unit motions, constant on each panel and met at its centroid:
2 pi phi + sum of solid angles times phi = - integral of (dphi/dn) / r. Source: Newman, Marine Hydrodynamics (1977),
sections 4.11 and 4.14; Hess & Smith (1967) for the panels. The potential itself is the unknown, not a source strength:
on a smooth body the error falls with the square of the panels' size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.panels.influence import panels_of
from coeflab.core.types import Array, brief
from coeflab.law.transforms import moved

TOLERANCE = 5e-7
MOST_STEPS = 200
WORKSPACE = 400 * 2**20


@brief
@dataclass(frozen=True, slots=True)
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


def panel_added_mass(corners: Array, point: Array, compiled: bool) -> PanelSolution:
    """Added mass per density about a point.

    Parameters
    ----------
    corners : (n, 3, 3) array
        Panel, corner, component, m; counter-clockwise seen from the fluid; the surface is closed.
    point : (3,) array
        m.
    compiled : bool
        By numba, which must be installed; else by numpy. They agree to 1e-6.
    """
    if compiled:
        from coeflab.bodies.panels.compiled import influence
    else:
        from coeflab.bodies.panels.influence import influence
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    middle, scale = (low + high) / 2.0, float(np.max(high - low)) / 2.0
    panels = panels_of((corners - middle) / scale)
    angles, layer = influence(panels)
    # A constant potential must come back from a closed surface: its solid angles sum to 2 pi.
    diagonal = 4.0 * np.pi - angles.sum(axis=1, dtype=np.float64)
    potential, steps, residual = _solved(angles, diagonal, -_with_turning(layer, panels.centre))
    motion = _with_turning(panels.normal, panels.centre)
    raw = -(potential * panels.area[:, None]).T @ motion
    units = scale ** np.where(np.arange(6) < 3, 1.5, 2.5)
    matrix = moved((raw + raw.T) / 2.0 * np.outer(units, units), point - middle)
    asymmetry = float(np.max(np.abs(raw - raw.T)) / np.max(np.abs(raw)))
    converged = residual <= TOLERANCE
    return PanelSolution(matrix, panels.count, asymmetry, steps, residual, converged)


def _with_turning(vector: Array, at: Array) -> Array:
    """(n, 6): a vector and its moment about the origin.

    For the potential of a layer of y x n this is exact on a polyhedron: the integral of (y x n) / r is x times (cross)
    that of n / r, since grad(1/r) is along y - x.
    """
    return np.hstack([vector, np.cross(at, vector)])


def _solved(angles: NDArray[np.float32], diagonal: Array, right: Array) -> tuple[Array, int, float]:
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
        vector = (angles @ last.astype(np.float32)).astype(np.float64) + diagonal[:, None] * last
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

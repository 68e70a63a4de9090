"""Added mass of a body from that of its parts, and whether a matrix can be an added mass at all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array
from coeflab.law.transforms import moved, turned

ROUNDING = 1e-9


def composed(matrices: Sequence[Array], rotations: Sequence[Array], centres: Sequence[Array], point: Array) -> Array:
    """Sum over parts, each given about its own centre along its own axes, about a common point.

    Parameters
    ----------
    matrices : sequence of (6, 6) arrays
    rotations : sequence of (3, 3) arrays
        Part to body.
    centres : sequence of (3,) arrays
        m, body axes, from the datum.
    point : (3,) array
        m, body axes, from the datum.

    Notes
    -----
    The flow of one part is not felt by the others; for parts that touch this is an approximation.
    """
    total = np.zeros((6, 6))
    for matrix, rotation, centre in zip(matrices, rotations, centres, strict=True):
        total += moved(turned(matrix, rotation), point - centre)
    return np.asarray((total + total.T) / 2.0)


@dataclass(frozen=True, slots=True)
class Definiteness:
    """Whether a matrix is symmetric and positive semidefinite, as a kinetic energy must be.

    Attributes
    ----------
    asymmetry : float
        Largest difference across the diagonal, over the largest entry in units of that pair.
    smallest : float
        Smallest eigenvalue of the matrix scaled to a unit diagonal.
    """

    asymmetry: float
    smallest: float

    @property
    def holds(self) -> bool:
        """Both within rounding."""
        return bool(self.asymmetry <= ROUNDING and self.smallest >= -ROUNDING)


def definiteness(matrix: Array) -> Definiteness:
    """Look at a (6, 6) matrix; entries are scaled by the root of their diagonals, so units do not matter.

    A row with a zero on its diagonal must be zero throughout; otherwise the smallest eigenvalue is -inf.
    """
    diagonal = np.diag(matrix)
    if not np.all(np.isfinite(matrix)) or np.any(diagonal < 0.0):
        return Definiteness(np.inf, -np.inf)
    live = diagonal > 0.0
    if np.any(matrix[~live]) or np.any(matrix[:, ~live]):
        return Definiteness(float(np.max(np.abs(matrix - matrix.T))), -np.inf)
    if not np.any(live):
        return Definiteness(0.0, 0.0)
    root = np.sqrt(diagonal[live])
    scaled = matrix[np.ix_(live, live)] / np.outer(root, root)
    smallest = float(np.linalg.eigvalsh((scaled + scaled.T) / 2.0)[0])
    return Definiteness(float(np.max(np.abs(scaled - scaled.T))), smallest)

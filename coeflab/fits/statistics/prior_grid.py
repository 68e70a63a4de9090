"""Least squares in which some columns have a prior whose size runs over a grid: one factorisation, plane rotations for the rest.

``|z - R b|^2 + sum_i (b_i / size_i)^2`` for every combination of sizes: each prior is a row below the triangle R that Givens
rotations take up (Golub & Van Loan 2013, 5.1.8 and 6.5). Columns with a prior stand as far right as they can, so that the last
ones touch few rows. What the rotations leave of a right-hand side in the rows of the priors is its misfit: no difference of
large numbers is taken, and sizes of 1e5 lose no digits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array


@dataclass(frozen=True, slots=True, eq=False)
class Rotations:
    """j triangles with their priors taken up; arrays broadcast over (..., j), one axis a prior before the last.

    Attributes
    ----------
    triangle : tuple of tuples of arrays
        Rows of the p x p triangle, from the diagonal on.
    turns : tuple of (prior, row, cosine, sine)
    sizes : tuple of (column, array)
        Of each prior, the inverse size.
    """

    triangle: tuple[tuple[Array, ...], ...]
    turns: tuple[tuple[int, int, Array, Array], ...]
    sizes: tuple[tuple[int, Array], ...]

    def turned(self, top: Array, below: Sequence[Array | float]) -> tuple[Array, list[Array]]:
        """Of right-hand sides the last row of the triangle and what is left in the rows of the priors.

        Parameters
        ----------
        top : (p, m, j) array
        below : sequence of arrays (m, ..., 1) or zeros
            In the rows of the priors.

        Returns
        -------
        last : (m, ..., j) array
        left : list of such arrays
        """
        p, m, j = top.shape
        rows: list[Array] = [row.reshape(m, *[1] * len(self.sizes), j) for row in top]
        left: list[Array | float] = list(below)
        for prior, k, cosine, sine in self.turns:
            row, under = rows[k], left[prior]
            zero = isinstance(under, float) and not under
            left[prior] = -sine * row if zero else cosine * under - sine * row
            if k == p - 1 or prior < len(self.sizes) - 1:
                rows[k] = cosine * row if zero else cosine * row + sine * under
        return rows[-1], [np.asarray(e) for e in left]

    def log_det(self) -> Array:
        """Log determinant of the normal equations, (..., j)."""
        return np.asarray(sum(2.0 * np.log(np.abs(row[0])) for row in self.triangle))

    def inverse_column(self, at: int) -> list[Array]:
        """Column ``at`` of the inverse of the normal equations: p arrays (..., j)."""
        p = len(self.triangle)
        u: list[Array | float] = [0.0] * p
        for i in range(at, p):
            right = (1.0 if i == at else 0.0) - sum(self.triangle[k][i - k] * u[k] for k in range(at, i))
            u[i] = right / self.triangle[i][0]
        v: list[Array] = [np.zeros(1)] * p
        for i in reversed(range(p)):
            v[i] = (u[i] - sum(self.triangle[i][k - i] * v[k] for k in range(i + 1, p))) / self.triangle[i][0]
        return v


def rotated(triangle: Array, priors: Sequence[tuple[int, Sequence[float]]]) -> Rotations:
    """Take the priors up.

    Parameters
    ----------
    triangle : (j, p, p) array
        Upper triangles; what is below the diagonal does not count.
    priors : sequence of (column, sizes)
        From left to right; an infinite size is none.
    """
    p, axes = triangle.shape[1], len(priors)
    rows = [[np.ascontiguousarray(triangle[:, i, k]).reshape(*[1] * axes, -1) for k in range(i, p)] for i in range(p)]
    turns, sizes = [], []
    for prior, (column, own) in enumerate(priors):
        shape = [1] * (1 + axes)
        shape[prior] = len(own)
        inverse = (1.0 / np.asarray(own, float)).reshape(shape)
        sizes.append((column, inverse))
        under: list[Array | float] = [inverse, *[0.0] * (p - column - 1)]
        for k in range(column, p):
            row, entry = rows[k], under[k - column]
            length = np.hypot(row[0], entry)
            some = np.where(length > 0.0, length, 1.0)
            cosine, sine = np.where(length > 0.0, row[0] / some, 1.0), entry / some
            turns.append((prior, k, cosine, sine))
            row[0] = length
            for e in range(1, p - k):
                old, new = row[e], under[k - column + e]
                row[e], under[k - column + e] = cosine * old + sine * new, cosine * new - sine * old
    return Rotations(tuple(map(tuple, rows)), tuple(turns), tuple(sizes))

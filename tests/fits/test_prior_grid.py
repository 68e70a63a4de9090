"""Least squares over a grid of prior sizes, held against the normal equations in exact arithmetic."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from coeflab.fits.statistics.prior_grid import rotated

T = np.array([-1.0, -0.5, -0.25, 0.125, 0.5, 0.75, 1.0])
SIZES = ((2.0**-3, 2.0**17), (2.0**-3, 1.0, 2.0**17))  # of |t| t and t^3: powers of two are exact


def solved(matrix: list[list[Fraction]], right: list[Fraction]) -> list[Fraction]:
    rows = [[*row, r] for row, r in zip(matrix, right)]
    for i in range(len(rows)):
        rows[i] = [e / rows[i][i] for e in rows[i]]
        for k in range(len(rows)):
            if k != i:
                rows[k] = [a - rows[k][i] * b for a, b in zip(rows[k], rows[i])]
    return [row[-1] for row in rows]


@pytest.mark.parametrize("n", [7, 3], ids=["more rows than columns", "fewer rows than columns"])
def test_value_misfit_and_inverse_are_the_exact_ones(n: int) -> None:
    t, order = T[-n:], [0, 2, 3, 1]
    terms = np.stack([np.ones(n), t, t * np.abs(t), t**3], 1)
    y = np.round(64.0 * np.cos(3.0 * t)) / 64.0
    base, upper = np.linalg.qr(terms[:, order])
    triangle, right = np.zeros((1, 4, 4)), np.zeros((4, 1, 1))
    triangle[0, : len(upper)], right[: len(upper), 0, 0] = upper, base.T @ y
    r = rotated(triangle, [(1, SIZES[0]), (2, SIZES[1])])
    last, left = r.turned(right, [0.0, 0.0])
    slope = (last / r.triangle[-1][0])[0, :, :, 0]
    outside = y @ y - np.sum(right**2)
    misfit = (outside + sum(np.broadcast_to(e, (1, 2, 3, 1)) ** 2 for e in left))[0, :, :, 0]
    column = [np.broadcast_to(e, (2, 3, 1))[..., 0] for e in r.inverse_column(0)]
    for i, k in product(range(2), range(3)):
        prior = [0.0, 0.0, SIZES[0][i] ** -2.0, SIZES[1][k] ** -2.0]
        exact = [[Fraction(float(e)) for e in row] for row in terms]
        normal = [
            [sum(row[a] * row[b] for row in exact) + (Fraction(prior[a]) if a == b else 0) for b in range(4)]
            for a in range(4)
        ]
        known = [sum(row[a] * Fraction(float(v)) for row, v in zip(exact, y)) for a in range(4)]
        b = solved(normal, known)
        squares = sum((Fraction(float(v)) - sum(p * q for p, q in zip(row, b))) ** 2 for row, v in zip(exact, y))
        squares += sum(Fraction(p) * q * q for p, q in zip(prior, b))
        assert slope[i, k] == pytest.approx(float(b[1]), rel=1e-12 if n > 4 else 1e-10)
        assert misfit[i, k] == pytest.approx(float(squares), rel=1e-9, abs=1e-15)
        inverse = solved(normal, [Fraction(int(a == 0)) for a in range(4)])
        assert [c[i, k] for c in column] == pytest.approx([float(inverse[a]) for a in order], rel=1e-9)

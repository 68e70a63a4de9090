"""Least squares against certified results: NIST Statistical Reference Datasets, linear regression (public domain).

https://www.itl.nist.gov/div898/strd/lls/lls.shtml. The certified numbers are confirmed here by exact rational
arithmetic from the data, so that a slip in copying either of them shows.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import log10, sqrt
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.types import Array
from coeflab.fits.statistics.extended_precision import sharpened
from coeflab.fits.statistics.least_squares import BLOCK, Factorised, factorise, solve
from coeflab.fits.statistics.linear_model import fit_linear
from coeflab.law.terms import Term, design

DATA = Path(__file__).parent / "data" / "nist"


def classical_variance(f: Factorised, residuals: np.ndarray) -> np.ndarray:
    """Variances of the coefficients under equal, independent errors, shape (p,) or (p, m)."""
    variance = np.sum(residuals**2, axis=0) / max(f.freedom, 1)
    return np.asarray(np.multiply.outer(np.sum(f.estimator**2, axis=1), variance))


@dataclass(frozen=True)
class Certified:
    powers: tuple[int, ...]
    coefficients: tuple[float, ...]
    errors: tuple[float, ...]


CERTIFIED = {
    "norris": Certified((0, 1), (-0.262323073774029, 1.00211681802045), (0.232818234301152, 0.429796848199937e-3)),
    "pontius": Certified(
        (0, 1, 2),
        (0.673565789473684e-3, 0.732059160401003e-6, -0.316081871345029e-14),
        (0.107938612033077e-3, 0.157817399981659e-9, 0.486652849992036e-16),
    ),
    "noint1": Certified((1,), (2.07438016528926,), (0.165289256198347e-1,)),
}
_SPREAD = (
    2152.32624678170, 2363.55173469681, 779.343524331583, 101.475507550350, 5.64566512170752, 0.112324854679312,
)  # fmt: skip
HIGH_DEGREE = {
    "filip": Certified(
        tuple(range(11)),
        (
            -1467.48961422980, -2772.17959193342, -2316.37108160893, -1127.97394098372, -354.478233703349,
            -75.1242017393757, -10.8753180355343, -1.06221498588947, -0.670191154593408e-1, -0.246781078275479e-2,
            -0.402962525080404e-4,
        ),
        (
            298.084530995537, 559.779865474950, 466.477572127796, 227.204274477751, 71.6478660875927,
            15.2897178747400, 2.23691159816033, 0.221624321934227, 0.142363763154724e-1, 0.535617408889821e-3,
            0.896632837373868e-5,
        ),
    ),
    "wampler1": Certified(tuple(range(6)), (1.0,) * 6, (0.0,) * 6),
    "wampler2": Certified(tuple(range(6)), (1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5), (0.0,) * 6),
    "wampler3": Certified(tuple(range(6)), (1.0,) * 6, _SPREAD),
    "wampler4": Certified(tuple(range(6)), (1.0,) * 6, tuple(1e2 * e for e in _SPREAD)),
    "wampler5": Certified(tuple(range(6)), (1.0,) * 6, tuple(1e4 * e for e in _SPREAD)),
}  # fmt: skip
LONGLEY = Certified(
    (),
    (
        -3482258.63459582, 15.0618722713733, -0.358191792925910e-1, -2.02022980381683, -1.03322686717359,
        -0.511041056535807e-1, 1829.15146461355,
    ),
    (
        890420.383607373, 84.9149257747669, 0.334910077722432e-1, 0.488399681651699, 0.214274163161675,
        0.226073200069370, 455.478499142212,
    ),
)  # fmt: skip


def read(name: str) -> tuple[list[Fraction], list[Fraction]]:
    lines = [s for s in (DATA / f"{name}.csv").read_text().splitlines() if not s.startswith("#")]
    assert lines[0] == "y,x"
    rows = [[Fraction(cell) for cell in line.split(",")] for line in lines[1:]]
    return [r[1] for r in rows], [r[0] for r in rows]


def inverse(matrix: list[list[Fraction]]) -> list[list[Fraction]]:
    """Gauss-Jordan in rational numbers."""
    p = len(matrix)
    rows = [[*row, *(Fraction(int(i == j)) for j in range(p))] for i, row in enumerate(matrix)]
    for k in range(p):
        pivot = next(i for i in range(k, p) if rows[i][k] != 0)
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [v / rows[k][k] for v in rows[k]]
        for i in range(p):
            if i != k:
                rows[i] = [a - rows[i][k] * b for a, b in zip(rows[i], rows[k], strict=True)]
    return [row[p:] for row in rows]


def exact(design: list[list[Fraction]], y: list[Fraction]) -> tuple[list[Fraction], list[float]]:
    """Coefficients and standard errors by the normal equations without rounding."""
    p = len(design[0])
    gram = [[sum((r[i] * r[j] for r in design), Fraction(0)) for j in range(p)] for i in range(p)]
    moments = [sum((r[i] * v for r, v in zip(design, y, strict=True)), Fraction(0)) for i in range(p)]
    back = inverse(gram)
    coefficients = [sum((b * m for b, m in zip(row, moments, strict=True)), Fraction(0)) for row in back]
    fitted = [sum((c * d for c, d in zip(coefficients, r, strict=True)), Fraction(0)) for r in design]
    residual = sum(((a - b) ** 2 for a, b in zip(y, fitted, strict=True)), Fraction(0))
    return coefficients, [sqrt(residual * back[i][i] / (len(y) - p)) for i in range(p)]


def floats(rows: list[list[Fraction]]) -> Array:
    return np.array([[float(v) for v in row] for row in rows])


def digits(found: Array, wanted: list[float] | list[Fraction]) -> float:
    """Correct significant digits of the worst number (NIST's log relative error, 16 at most)."""
    worst = max(
        float(abs((Fraction(float(a)) - Fraction(b)) / Fraction(b))) for a, b in zip(found, wanted, strict=True)
    )
    return -log10(max(worst, 1e-16))


@pytest.mark.parametrize("name", [*CERTIFIED, *HIGH_DEGREE])
def test_certified_numbers_follow_exactly_from_the_data(name: str) -> None:
    x, y = read(name)
    wanted = (CERTIFIED | HIGH_DEGREE)[name]
    coefficients, errors = exact([[v**k for k in wanted.powers] for v in x], y)
    np.testing.assert_allclose([float(c) for c in coefficients], wanted.coefficients, rtol=5e-15)
    np.testing.assert_allclose(errors, wanted.errors, rtol=5e-15)


@pytest.mark.parametrize("name", HIGH_DEGREE)
def test_high_degrees_as_the_polynomial_fit_solves_them(name: str) -> None:
    """Filip's degree 10 and Wampler's degree 5 from raw powers, refined as the plugin refines them."""
    x, y = read(name)
    wanted = HIGH_DEGREE[name]
    columns = {"v": np.array([float(v) for v in x])}
    terms = tuple(Term((("v", k, False),) if k else ()) for k in wanted.powers)
    response = np.array([float(v) for v in y])
    fit = sharpened(fit_linear(design(terms, columns), response), terms, columns, response, None)
    assert fit.rank == len(terms)
    assert digits(fit.coefficients, list(wanted.coefficients)) >= 9
    if name != "wampler2":  # whose responses no binary number holds exactly
        assert fit.digits <= digits(fit.coefficients, list(wanted.coefficients)) + 1.0
    if any(wanted.errors):
        f = factorise(design(terms, columns))
        assert digits(np.sqrt(classical_variance(f, fit.residuals)), list(wanted.errors)) >= 7


def test_longley() -> None:
    """Six regressors that rise together; the data as statsmodels ships them, confirmed by the exact solution."""
    longley = pytest.importorskip("statsmodels.datasets").longley.load()
    y = [Fraction(str(v)) for v in longley.endog]
    rows = [[Fraction(1), *(Fraction(str(v)) for v in row)] for row in longley.exog.to_numpy()]
    coefficients, errors = exact(rows, y)
    np.testing.assert_allclose([float(c) for c in coefficients], LONGLEY.coefficients, rtol=5e-14)
    np.testing.assert_allclose(errors, LONGLEY.errors, rtol=5e-14)
    f = factorise(floats(rows))
    found, residuals = solve(f, np.array([float(v) for v in y]))
    assert digits(found, list(LONGLEY.coefficients)) >= 9
    assert digits(np.sqrt(classical_variance(f, residuals)), list(LONGLEY.errors)) >= 9


@pytest.mark.parametrize("name", CERTIFIED)
def test_nist_to_nine_digits_or_more(name: str) -> None:
    x, y = read(name)
    wanted = CERTIFIED[name]
    f = factorise(floats([[v**k for k in wanted.powers] for v in x]))
    coefficients, residuals = solve(f, np.array([float(v) for v in y]))
    assert f.rank == len(wanted.powers)
    assert f.freedom == len(y) - len(wanted.powers)
    assert digits(coefficients, list(wanted.coefficients)) >= 12
    assert digits(np.sqrt(classical_variance(f, residuals)), list(wanted.errors)) >= 11


def checked(design: list[list[Fraction]], y: list[Fraction]) -> tuple[float, float, float]:
    """Digits of coefficients and standard errors, and the condition, against the exact solution."""
    coefficients, errors = exact(design, y)
    f = factorise(floats(design))
    assert f.rank == len(design[0])
    found, residuals = solve(f, np.array([float(v) for v in y]))
    return (
        digits(found, coefficients),
        digits(np.sqrt(classical_variance(f, residuals)), [Fraction(e) for e in errors]),
        f.condition,
    )


def test_degree_ten_polynomial() -> None:
    """All powers up to x^10 on [0, 1] and a response that is no polynomial, the shape of NIST's hardest sets."""
    design = [[Fraction(i, 64) ** k for k in range(11)] for i in range(65)]
    y = [Fraction(round(2**20 / (1 + i / 8)), 2**20) for i in range(65)]
    coefficients, errors, condition = checked(design, y)
    assert condition > 1e7
    assert coefficients >= 9
    assert errors >= 9


def test_near_collinear_columns() -> None:
    """As in Longley's data: large numbers that rise together, here alike to one part in 2^20."""
    rng = np.random.default_rng(3)
    trend = [Fraction(1000 * i + 50_000) for i in range(16)]
    wobble = rng.integers(-8, 9, size=(16, 3)).tolist()
    design = [[Fraction(1), t, t + Fraction(a, 16), 2 * t + Fraction(b, 16)] for t, (a, b, _) in zip(trend, wobble)]
    y = [3 + t / 8 + Fraction(c, 4) for t, (_, _, c) in zip(trend, wobble)]
    coefficients, errors, condition = checked(design, y)
    assert condition > 1e5
    assert coefficients >= 9
    assert errors >= 9


def test_collinear_columns_are_seen() -> None:
    x = np.linspace(-1.0, 1.0, 9)
    f = factorise(np.column_stack([np.ones(9), x, 3.0 * x - 2.0]))
    assert f.rank == 2
    assert f.freedom == 7


def test_weights_count_by_their_ratios_and_like_repeated_rows() -> None:
    x = np.array([-2.0, -1.0, 0.0, 1.0, 2.0, 3.0])
    y = np.array([0.3, -1.0, 0.2, 1.4, 1.9, 3.3])
    design, counts = np.column_stack([np.ones(6), x]), np.array([1, 2, 3, 1, 2, 4])
    once, _ = solve(factorise(design, counts.astype(float)), y)
    scaled, _ = solve(factorise(design, 1e-9 * counts), y)
    repeated, _ = solve(factorise(np.repeat(design, counts, axis=0)), np.repeat(y, counts))
    np.testing.assert_allclose(scaled, once, rtol=1e-13)
    np.testing.assert_allclose(repeated, once, rtol=1e-13)


def test_many_responses_are_solved_as_one_by_one() -> None:
    rng = np.random.default_rng(0)
    f = factorise(rng.normal(size=(12, 3)), rng.uniform(0.5, 2.0, 12))
    y = rng.normal(size=(12, 5))
    coefficients, residuals = solve(f, y)
    variance = classical_variance(f, residuals)
    for k in range(5):
        one, left = solve(f, y[:, k])
        np.testing.assert_allclose(coefficients[:, k], one, atol=1e-13)
        np.testing.assert_allclose(residuals[:, k], left, atol=1e-13)
        np.testing.assert_allclose(variance[:, k], classical_variance(f, left), rtol=1e-12)


@pytest.mark.parametrize("n", [2 * BLOCK, 2 * BLOCK + 1, 3 * BLOCK - 1])
def test_a_table_of_several_blocks_is_one_table(n: int) -> None:
    """Rows are factorised in blocks; the last column repeats another, which only shows when blocks are joined."""
    rng = np.random.default_rng(n)
    x = rng.uniform(-0.3, 0.3, n)
    design = np.column_stack([np.ones(n), x, x**3, 2.0 * x])
    y, weights = rng.normal(size=n), rng.uniform(0.5, 2.0, n)
    f, full = factorise(design, weights), factorise(design[:, :3], weights)
    assert (f.rank, full.rank) == (3, 3)
    np.testing.assert_allclose(f.basis.T @ f.basis, np.eye(3), atol=1e-12)
    root = np.sqrt(weights)
    q, r = np.linalg.qr(design[:, :3] * root[:, None])
    np.testing.assert_allclose(solve(full, y)[0], np.linalg.solve(r, q.T @ (root * y)), rtol=1e-9)
    np.testing.assert_allclose(f.leverage, np.sum(q**2, axis=1), rtol=1e-9)
    np.testing.assert_allclose(solve(f, y)[1], solve(full, y)[1], atol=1e-12)

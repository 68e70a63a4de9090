"""Linear models against statsmodels, exact rational arithmetic and examples by hand."""

from __future__ import annotations

from fractions import Fraction
from math import erfc, log10, sqrt

import numpy as np
import pytest
import statsmodels.api as sm

from coeflab.fits.results.fitted_model import in_words
from coeflab.fits.statistics.extended_precision import sharpened
from coeflab.fits.statistics.linear_model import LinearFit, fit_linear, runs_probability
from coeflab.fits.statistics.nested_test import nested_test
from coeflab.law.terms import design, power_terms

RNG = np.random.default_rng(20261121)
CASES = {
    "line": (np.column_stack([np.ones(12), np.linspace(-1, 1, 12)]), None),
    "surface": (RNG.standard_normal((40, 6)) * np.array([1.0, 1e-4, 1e3, 1.0, 5.0, 1.0]), None),
    "weighted": (np.column_stack([np.ones(30), RNG.standard_normal((30, 3))]), RNG.uniform(0.1, 3.0, 30)),
}


def response(x: np.ndarray) -> np.ndarray:
    return x @ np.arange(1.0, x.shape[1] + 1.0) + np.random.default_rng(3).standard_normal(len(x))


@pytest.mark.parametrize("case", CASES)
def test_coefficients_and_errors_against_statsmodels(case):
    x, errors = CASES[case]
    y = response(x)
    found = fit_linear(x, y, errors)
    peer = sm.WLS(y, x, weights=1.0 if errors is None else errors**-2.0).fit()
    np.testing.assert_allclose(found.coefficients, peer.params, rtol=1e-9)
    np.testing.assert_allclose(found.covariance, peer.cov_HC2, rtol=1e-8, atol=1e-9 * np.abs(peer.cov_HC2).max())
    np.testing.assert_allclose(found.residuals, peer.resid, atol=1e-9)
    assert found.rank == x.shape[1]


@pytest.mark.parametrize("case", ["line", "surface"])
def test_influence_against_statsmodels(case):
    """The peer gets columns of one size: nothing here depends on that, but its pseudo-inverse does."""
    x, _ = CASES[case]
    y = response(x)
    found, peer = fit_linear(x, y), sm.OLS(y, x / np.linalg.norm(x, axis=0)).fit().get_influence()
    np.testing.assert_allclose(found.leverage, peer.hat_matrix_diag, rtol=1e-9)
    np.testing.assert_allclose(found.cooks_distance, peer.cooks_distance[0], rtol=1e-9)
    np.testing.assert_allclose(found.left_out, peer.resid_press, rtol=1e-9)
    assert found.press_rms == pytest.approx(np.sqrt(np.mean(peer.resid_press**2)), rel=1e-9)


@pytest.mark.parametrize("case", CASES)
def test_left_out_residuals_are_those_of_fits_without_the_point(case):
    x, errors = CASES[case]
    y = response(x)
    found = fit_linear(x, y, errors)
    for i in range(len(y)):
        others = np.arange(len(y)) != i
        rest = fit_linear(x[others], y[others], None if errors is None else errors[others])
        assert found.left_out[i] == pytest.approx(y[i] - x[i] @ rest.coefficients, rel=1e-9, abs=1e-11)


def test_nested_models_against_statsmodels():
    x, _ = CASES["surface"]
    y = response(x)
    full, small = sm.OLS(y, x).fit(), sm.OLS(y, x[:, :3]).fit()
    ratio, probability, between = full.compare_f_test(small)
    found = nested_test(small.ssr, 3, full.ssr, 6, len(y))
    assert (found.between, found.within) == (between, 34)
    assert found.ratio == pytest.approx(ratio, rel=1e-12)
    assert found.probability == pytest.approx(probability, rel=1e-9)
    assert np.isnan(nested_test(1.0, 6, 1.0, 6, 40).probability)
    assert np.isnan(nested_test(1.0, 3, 0.5, 6, 6).probability)


def test_runs_by_hand():
    """++++ ---- ++ -: 4 runs of 6 up and 5 down; mean 71/11, variance 60 * 49 / (121 * 10)."""
    signs = np.array([1.0, 1, 1, 1, -1, -1, -1, -1, 1, 1, -1])
    mean, variance = 1 + 2 * 6 * 5 / 11, 2 * 6 * 5 * (2 * 6 * 5 - 11) / (11**2 * 10)
    wanted = erfc((mean - 4 - 0.5) / sqrt(variance) / sqrt(2))
    assert runs_probability(signs * np.arange(1.0, 12.0)) == pytest.approx(wanted, rel=1e-12)
    assert runs_probability(np.concatenate([signs[:4], [0.0], signs[4:]])) == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("residuals", [[1.0, 2.0, 3.0], [1.0, 1.0, -1.0, 1.0], [0.0, 0.0], []])
def test_too_few_of_one_sign_give_no_runs_test(residuals):
    assert np.isnan(runs_probability(np.array(residuals)))


def test_curvature_that_a_line_leaves_shows_in_the_runs():
    x = np.linspace(-1.0, 1.0, 41)
    line = np.column_stack([np.ones(41), x])
    y = 0.5 * x**2 + 0.01 * np.random.default_rng(5).standard_normal(41)
    assert fit_linear(line, y).runs_probability < 1e-6
    assert fit_linear(np.column_stack([line, x**2]), y).runs_probability > 0.01


def test_open_directions_are_said_in_words_and_carry_no_number():
    x = np.linspace(0.0, 1.0, 20)
    matrix = np.column_stack([np.ones(20), x, 2.0 * x, x**2])
    fit = fit_linear(matrix, 1.0 + x)
    assert fit.rank == 3
    assert fit.open_directions.shape == (1, 4)
    assert np.isnan(fit.coefficients).tolist() == [False, True, True, False]
    assert np.isnan(fit.half_width[1:3]).all()
    words = " ".join(in_words(fit, ("c", "a", "b", "d")))
    assert "a, b are determined only in combination" in words
    np.testing.assert_allclose(fit.residuals, 0.0, atol=1e-12)


def test_a_polynomial_of_higher_degree_than_its_abscissae_is_open():
    x = np.repeat([-1.0, 0.0, 1.0], 4)
    fit = fit_linear(np.vander(x, 4, increasing=True), x)
    assert fit.rank == 3
    assert "b, d are determined only in combination" in " ".join(in_words(fit, tuple("abcd")))


def test_near_collinearity_is_said():
    x = np.linspace(0.0, 1.0, 30)
    fit = fit_linear(np.column_stack([x, x + 1e-3 * x**2]), x + 1e-4 * np.random.default_rng(1).standard_normal(30))
    assert "nearly collinear" in " ".join(in_words(fit, ("a", "b")))


@pytest.mark.parametrize("errors", [None, np.linspace(0.5, 2.0, 25)])
def test_a_constraint_is_kept_and_the_rest_is_least_squares(errors):
    rng = np.random.default_rng(8)
    x, c, d = (
        rng.standard_normal((25, 4)),
        np.array([[1.0, -1.0, 0.0, 0.0], [0.0, 0.0, 2.0, 1.0]]),
        np.array([0.0, 3.0]),
    )
    y = response(x)
    found = fit_linear(x, y, errors, (c, d))
    w = np.ones(25) if errors is None else errors**-2.0
    gram = x.T @ (w[:, None] * x)
    system = np.block([[gram, c.T], [c, np.zeros((2, 2))]])
    wanted = np.linalg.solve(system, np.concatenate([x.T @ (w * y), d]))[:4]
    np.testing.assert_allclose(found.coefficients, wanted, atol=1e-10)
    np.testing.assert_allclose(c @ found.coefficients, d, atol=1e-12)
    np.testing.assert_allclose(c @ found.covariance @ c.T, 0.0, atol=1e-12)
    i = 7
    others = np.arange(25) != i
    rest = fit_linear(x[others], y[others], None if errors is None else errors[others], (c, d))
    assert found.left_out[i] == pytest.approx(y[i] - x[i] @ rest.coefficients, rel=1e-9)


def test_a_constraint_that_cannot_hold_is_refused():
    with pytest.raises(ValueError, match="cannot hold"):
        fit_linear(np.eye(3, 2), np.ones(3), None, (np.array([[1.0, 0.0], [1.0, 0.0]]), np.array([0.0, 1.0])))


def exact_polynomial(x: list[Fraction], y: list[Fraction], degree: int) -> list[Fraction]:
    """Least squares by rational elimination of the normal equations, powers without rounding."""
    p = degree + 1
    sums = [sum((v**k for v in x), Fraction(0)) for k in range(2 * degree + 1)]
    rows = [
        [*(sums[i + j] for j in range(p)), sum((v**i * u for v, u in zip(x, y, strict=True)), Fraction(0))]
        for i in range(p)
    ]
    for k in range(p):
        rows[k] = [v / rows[k][k] for v in rows[k]]
        for i in range(p):
            if i != k:
                rows[i] = [a - rows[i][k] * b for a, b in zip(rows[i], rows[k], strict=True)]
    return [row[p] for row in rows]


def digits(found: np.ndarray, wanted: list[Fraction]) -> float:
    worst = max(float(abs((Fraction(float(a)) - b) / b)) for a, b in zip(found, wanted, strict=True))
    return 16.0 if worst == 0.0 else -log10(worst)


def sure(fit: LinearFit, symbols: tuple[str, ...]) -> bool:
    """Whether nothing was said against the coefficients' digits or their being determined."""
    return not any(phrase in s for s in in_words(fit, symbols) for phrase in ("digits", "only together"))


RANGES = {
    "centred": (-1.0, 1.0),
    "one-sided": (0.0, 1.0),
    "degrees": (-25.0, 25.0),
    "far from zero": (2.0, 4.0),
    "as Filip": (-8.8, -3.1),
    "narrow": (2.0, 3.0),
    "hopeless": (100.0, 101.0),
}


@pytest.mark.parametrize("where", RANGES)
def test_degree_ten_to_seven_digits_or_a_word_about_it(where):
    """Synthetic data; the reference solves the same data by rational numbers, powers without rounding.

    "as Filip" has the abscissae of NIST's Filip set, whose ten powers are nearly dependent.
    """
    low, high = RANGES[where]
    x = np.linspace(low, high, 82)
    y = np.tanh(2.0 * (x - low) / (high - low) - 0.7) + 0.01 * np.random.default_rng(10).standard_normal(82)
    terms = power_terms(("x",), 10, "tensor", {})
    fit = sharpened(fit_linear(design(terms, {"x": x}), y), terms, {"x": x}, y, None)
    if where == "hopeless":
        assert not sure(fit, tuple(map(str, terms)))
        return
    wanted = exact_polynomial([Fraction(float(v)) for v in x], [Fraction(float(v)) for v in y], 10)
    true = digits(fit.coefficients, wanted)
    assert fit.digits <= true + 1.0
    assert true >= 7.0 or not sure(fit, tuple(map(str, terms)))
    assert sure(fit, tuple(map(str, terms))) == (where != "narrow")


def test_sharpening_keeps_weights_and_leaves_easy_fits_alone():
    x = np.linspace(1.0, 2.0, 40)
    errors = np.linspace(0.5, 2.0, 40)
    terms = power_terms(("x",), 6, "tensor", {})
    y = np.sin(x)
    plain = fit_linear(design(terms, {"x": x}), y, errors)
    found = sharpened(plain, terms, {"x": x}, y, errors)
    np.testing.assert_allclose(found.coefficients, plain.coefficients, rtol=1e-6)
    assert np.any(found.coefficients != plain.coefficients)
    easy = fit_linear(design(terms[:2], {"x": x}), y)
    assert sharpened(easy, terms[:2], {"x": x}, y, None) is easy


def test_r_squared_is_about_the_mean_only_with_an_intercept():
    """NIST's NoInt1 (certified 0.999365492298663), and statsmodels, with and without weights."""
    x, y = np.arange(60.0, 71.0), np.arange(130.0, 141.0)
    assert fit_linear(x[:, None], y).r_squared == pytest.approx(0.999365492298663, rel=1e-12)
    rng, errors = np.random.default_rng(3), np.linspace(0.5, 2.0, 11)
    noisy = y + rng.standard_normal(11)
    for columns, constant in ((np.stack([x, x**2], 1), False), (np.stack([x, x - 1.0, x**2], 1)[:, :2], True)):
        weighted = sm.WLS(noisy, np.stack([np.ones(11), x], 1) if constant else columns, errors**-2.0).fit()
        assert fit_linear(columns, noisy, errors).r_squared == pytest.approx(weighted.rsquared, rel=1e-9)


def test_rows_that_repeat_each_other_to_the_last_digit_show_no_noise() -> None:
    """Mirrored copies of rounded rows leave no residual of the slope that they alone fix; the others keep their U95."""
    v = np.array([0.07, -0.07, 0.07, -0.07, 0.0, 0.0, 0.0, 0.0])
    r = np.array([0.5, 0.5, -0.5, -0.5, 0.25, 0.5, 0.75, -0.5])
    columns = np.column_stack([np.ones(8), r**2, v**2, v * r])
    y = np.round(columns @ [-3.1, -0.1, 4.0, 8.48], 4)
    found = fit_linear(columns, y)
    assert np.isfinite(found.half_width[:2]).all()
    assert np.isnan(found.half_width[3])
    assert found.freedom[3] == 0.0
    noisy = fit_linear(columns, y + 1e-4 * np.array([1.0, -1.0, -1.0, 0.5, 0.3, -0.4, 0.2, 0.1]))
    assert np.isfinite(noisy.half_width).all()
    exact = fit_linear(columns[:, :3], columns[:, :3] @ [1.0, 2.0, 3.0])
    assert np.isfinite(exact.half_width).all()

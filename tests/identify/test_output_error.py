"""Output-error least squares: closed forms, planted parameters, priors, bounds, and what data leave open."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from coeflab.core.types import Array
from coeflab.identify.output_error import by_likelihood, estimate, examine
from coeflab.identify.output_problem import Problem, problem

T = np.linspace(0.0, 2.0, 15)


def linear(design: Array) -> Callable[[Array], Array]:
    return lambda sets: sets @ design.T


def line(y: Array, errors: Any = 0.1, start: Any = (1.0, 1.0), **more: Any) -> Problem:
    design = np.column_stack([np.ones_like(T), T])
    return problem(linear(design), y, errors, np.array(start), **more)


def decay(sets: Array) -> Array:
    return sets[:, :1] * np.exp(-sets[:, 1:2] * T)


def test_a_linear_model_with_priors_is_the_closed_form() -> None:
    rng = np.random.default_rng(1)
    design, truth = rng.normal(size=(40, 3)), np.array([2.0, -1.0, 0.5])
    errors = rng.uniform(0.5, 2.0, 40)
    y = design @ truth + 0.5 * errors * rng.normal(size=40)
    mean, spread = np.array([1.5, -0.8, 0.7]), np.array([0.3, np.inf, 0.1])
    found = estimate(problem(linear(design), y, errors, np.ones(3), prior_mean=mean, prior_error=spread))
    information = design.T @ (design / errors[:, None] ** 2) + np.diag(1.0 / spread**2)
    closed = np.linalg.solve(information, design.T @ (y / errors**2) + mean / spread**2)
    assert found.converged
    assert found.birge == 1.0
    assert found.parameters == pytest.approx(closed, rel=1e-8)
    assert found.covariance == pytest.approx(np.linalg.inv(information), rel=1e-6)
    assert found.prior_share == pytest.approx(np.diag(np.linalg.inv(information)) / spread**2, rel=1e-6)
    assert np.diag(found.correlation) == pytest.approx(1.0)
    assert found.residuals == pytest.approx(y - design @ closed, rel=1e-6)


def test_larger_residuals_than_stated_widen_and_smaller_ones_do_not_narrow() -> None:
    y = 1.0 + 2.0 * T + 0.5 * np.where(np.arange(len(T)) % 2, 1.0, -1.0)
    wide, narrow = estimate(line(y, 0.1)), estimate(line(y, 10.0))
    assert wide.birge == pytest.approx(np.sqrt(wide.chi_square / wide.freedom))
    assert wide.birge > 4.0
    assert narrow.birge == 1.0
    plain = 0.1**2 * np.linalg.inv(np.array([[len(T), T.sum()], [T.sum(), (T**2).sum()]]))
    assert wide.covariance == pytest.approx(plain * wide.birge**2, rel=1e-6)


def test_planted_parameters_of_a_curved_model_come_back() -> None:
    truth = np.array([3.0, 0.7])
    found = estimate(problem(decay, decay(truth[None])[0], 0.01, np.array([1.0, 2.0])))
    assert found.parameters == pytest.approx(truth, rel=1e-7)


def test_intervals_cover_what_they_promise() -> None:
    truth, rng, inside = np.array([3.0, 0.7]), np.random.default_rng(3), 0
    for _ in range(150):
        y = decay(truth[None])[0] + 0.05 * rng.normal(size=len(T))
        found = estimate(problem(decay, y, 0.05, np.array([2.5, 1.0])))
        inside += int(np.sum(np.abs(found.parameters - truth) <= 1.96 * found.standard_errors))
    # 300 intervals at 95 % or a little more, for the Birge ratio only widens; four standard deviations of a binomial.
    assert 0.90 <= inside / 300 <= 0.999


def test_derivatives_by_differences_are_those_of_the_formula_in_one_call() -> None:
    calls: list[int] = []

    def counted(sets: Array) -> Array:
        calls.append(len(sets))
        return decay(sets)

    at = np.array([3.0, 0.7])
    p = problem(counted, np.zeros_like(T), 1.0, at)
    exact = np.column_stack([np.exp(-0.7 * T), -3.0 * T * np.exp(-0.7 * T)])
    assert p.slopes(at) == pytest.approx(exact, abs=1e-9)
    assert calls == [4]
    assert replace(p, jacobian=lambda _: 2.0 * exact).slopes(at) == pytest.approx(2.0 * exact)
    assert calls == [4]


def test_blank_measurements_are_as_if_they_were_not_there() -> None:
    y = 1.0 + 2.0 * T + 0.05 * np.sin(9.0 * T)
    holes = y.copy()
    holes[[2, 7]] = np.nan
    keep = np.isfinite(holes)
    design = np.column_stack([np.ones_like(T), T])[keep]
    less = estimate(problem(linear(design), y[keep], 0.1, np.ones(2)))
    found = estimate(line(holes))
    assert found.parameters == pytest.approx(less.parameters, rel=1e-10)
    assert found.covariance == pytest.approx(less.covariance, rel=1e-8)
    assert np.isnan(found.residuals[[2, 7]]).all()


PAIRS: dict[str, tuple[Callable[[Array], Array], float]] = {
    "product": (lambda s: s[:, :1] * s[:, 1:2] * T + s[:, 2:], -1.0),
    "ratio": (lambda s: s[:, :1] / s[:, 1:2] * T + s[:, 2:], 1.0),
}


@pytest.mark.parametrize("kind", PAIRS)
def test_what_is_known_only_together_has_no_interval_and_is_found(kind: str) -> None:
    model, sign = PAIRS[kind]
    start = np.array([2.0, 4.0, 1.0])
    found = estimate(problem(model, model(np.array([[3.0, 4.0, 1.5]]))[0], 0.01, start))
    assert found.open.tolist() == [True, True, False]
    assert np.isnan(found.standard_errors[:2]).all()
    assert found.singular[-1] < 1e-6 * found.singular[0]
    design = np.column_stack([T, np.ones_like(T)])
    assert found.standard_errors[2] == pytest.approx(0.01 * np.sqrt(np.linalg.inv(design.T @ design)[1, 1]), rel=1e-5)
    (change,) = found.undetermined
    relative = change * start / found.parameters
    assert relative[0] / relative[1] == pytest.approx(sign, abs=1e-3)
    assert change[2] == 0.0
    # The leash keeps them near the start while the outputs are met.
    assert model(found.parameters[None])[0] == pytest.approx(model(np.array([[3.0, 4.0, 1.5]]))[0], abs=1e-5)
    assert np.all(np.abs(found.parameters - start) < 2.0)


def test_a_parameter_that_nothing_shows_is_open_alone() -> None:
    found = estimate(problem(lambda s: s[:, :1] * T + 0.0 * s[:, 1:], 2.0 * T, 0.1, np.array([1.0, 5.0])))
    assert found.open.tolist() == [False, True]
    (change,) = found.undetermined
    assert change.tolist() == [0.0, 1.0]
    assert found.parameters[1] == pytest.approx(5.0, rel=1e-6)


def test_a_prior_on_one_of_a_pair_gives_both_an_interval() -> None:
    model = PAIRS["product"][0]
    y = model(np.array([[3.0, 4.0, 1.5]]))[0]
    p = problem(model, y, 0.01, np.array([2.0, 4.0, 1.0]), prior_mean=np.array([0.0, 4.0, 0.0]),
                prior_error=np.array([np.inf, 0.4, np.inf]))  # fmt: skip
    found = estimate(p)
    assert not found.open.any()
    assert found.parameters == pytest.approx([3.0, 4.0, 1.5], rel=1e-6)
    assert found.prior_share == pytest.approx([0.0, 1.0, 0.0], abs=1e-3)
    # Their product is known, so that both have the relative uncertainty of the prior.
    assert found.standard_errors[:2] / found.parameters[:2] == pytest.approx([0.1, 0.1], rel=1e-2)
    assert found.correlation[0, 1] == pytest.approx(-1.0, abs=1e-3)
    assert len(found.undetermined) == 1


def test_an_estimate_at_a_bound_has_no_interval_and_leaves_the_others_theirs() -> None:
    y = 1.0 + 2.0 * T
    found = estimate(line(y, high=np.array([np.inf, 1.5])))
    assert found.at_bound.tolist() == [False, True]
    assert np.isnan(found.standard_errors[1])
    assert found.parameters[0] == pytest.approx(float(np.mean(y - 1.5 * T)), rel=1e-5)
    assert found.standard_errors[0] == pytest.approx(0.1 / np.sqrt(len(T)) * found.birge, rel=1e-5)


def test_steps_into_where_the_model_has_no_output_are_taken_back() -> None:
    def walled(sets: Array) -> Array:
        return np.where(sets[:, 1:2] > 0.0, decay(sets), np.nan)

    truth = np.array([3.0, 0.05])
    found = estimate(problem(walled, decay(truth[None])[0], 0.01, np.array([0.5, 4.0])))
    assert found.parameters == pytest.approx(truth, rel=1e-6)


def test_no_output_at_the_start_is_an_error() -> None:
    p = problem(lambda s: np.full((len(s), len(T)), np.nan), T, 1.0, np.ones(2))
    with pytest.raises(ArithmeticError, match="at the start"):
        estimate(p)
    with pytest.raises(ArithmeticError, match="no finite outputs"):
        examine(p, np.ones(2))


def test_maximum_likelihood_finds_the_error_of_each_group() -> None:
    rng, groups = np.random.default_rng(5), np.arange(400) % 2
    x = np.linspace(-1.0, 1.0, 400)
    spread = np.where(groups == 0, 0.02, 0.5)
    y = 1.0 + 2.0 * x + spread * rng.normal(size=400)
    p = problem(linear(np.column_stack([np.ones(400), x])), y, 0.1, np.ones(2))
    found, weighed = by_likelihood(p, groups)
    assert weighed.errors[groups == 0].mean() == pytest.approx(0.02, rel=0.12)
    assert weighed.errors[groups == 1].mean() == pytest.approx(0.5, rel=0.12)
    assert found.birge == pytest.approx(np.sqrt(400 / 398), rel=1e-3)
    assert np.all(np.abs(found.parameters - [1.0, 2.0]) < 4.0 * found.standard_errors)
    assert found.standard_errors[0] < estimate(p).standard_errors[0] / 3.0


def test_maximum_likelihood_of_an_exact_fit_stays_finite() -> None:
    found, weighed = by_likelihood(line(1.0 + 2.0 * T), np.zeros(len(T), dtype=int))
    assert found.parameters == pytest.approx([1.0, 2.0], rel=1e-6)
    assert np.all(weighed.errors > 0.0)


BAD: dict[str, tuple[dict[str, Any], str]] = {
    "an error of zero": ({"errors": 0.0}, "error must be above zero"),
    "a prior without width": ({"prior_error": np.array([0.0, 1.0])}, "prior error must be above zero"),
    "a size of zero": ({"sizes": np.array([0.0, 1.0])}, "size"),
    "bounds the wrong way": ({"low": np.array([1.0, 1.0]), "high": np.array([0.0, 2.0])}, "bound"),
    "a start outside": ({"low": np.array([2.0, 2.0])}, "outside of the bounds"),
    "a start that is no number": ({"start": (np.nan, 1.0)}, "not finite"),
    "another number of bounds": ({"low": np.zeros(3)}, "2 entries"),
}


@pytest.mark.parametrize("what", BAD)
def test_what_cannot_be_is_refused(what: str) -> None:
    given, message = BAD[what]
    with pytest.raises(ValueError, match=message):
        line(1.0 + T, **given)


def test_nothing_measured_is_refused() -> None:
    with pytest.raises(ValueError, match="nothing was measured"):
        line(np.full_like(T, np.nan))

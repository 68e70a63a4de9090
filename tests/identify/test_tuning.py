"""Words of a tuning: statuses, what is known only together, where a parameter went."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.identify.output_error import estimate
from coeflab.identify.output_problem import problem
from coeflab.identify.tuning import (
    BOUND,
    OK,
    OPEN,
    PRIOR,
    STATUSES,
    TunedParameter,
    moved_in_words,
    statements,
    together_in_words,
    tuned_parameters,
)

T = np.linspace(0.0, 1.0, 9)


def test_every_status() -> None:
    design = np.column_stack([np.ones_like(T), T, T**2, T**3])
    p = problem(
        lambda s: s[:, :4] @ design.T + s[:, 4:5] * s[:, 5:6], 1.0 + 2.0 * T + 0.5 * T**2, 0.2,
        np.array([1.0, 1.0, 0.5, 0.1, 1.0, 1.0]), sizes=np.array([1.0, 5.0, 20.0, 20.0, 1.0, 1.0]),
        prior_mean=np.array([1.0, 0.0, 0.0, 0.1, 0.0, 0.0]),
        prior_error=np.array([0.01, np.inf, np.inf, 1e-3, np.inf, np.inf]),
        high=np.array([np.inf, 1.5, np.inf, np.inf, np.inf, np.inf]),
    )  # fmt: skip
    found = estimate(p)
    made = tuned_parameters("abcdef", ["1"] * 6, p, found)
    assert [m.status for m in made] == [PRIOR, BOUND, OK, PRIOR, OPEN, OPEN]
    assert {m.status for m in made} == set(STATUSES) - {"sign_open"}  # of which tests/motion/test_tune.py has one
    for m in made:
        assert (m.u95 is None) == (m.status in (BOUND, OPEN))
    assert made[3].prior_share == pytest.approx(1.0, abs=1e-3)
    assert made[2].u95 == pytest.approx(2.0 * found.standard_errors[2])
    assert any("without an interval" in s for s in statements(p, found))


@pytest.mark.parametrize(
    ("change", "values", "expected"),
    [
        ((1.0, 0.9, 0.0), (2.0, 3.0, 1.0), "side force and mass: only as a ratio"),
        ((1.0, -0.9, 0.0), (2.0, -3.0, 1.0), "side force and mass: only as a ratio"),
        ((-1.0, -0.9, -0.8), (2.0, 3.0, 1.0), "side force, mass and arm: only as ratios to each other"),
        ((1.0, -0.5, 0.0), (2.0, 3.0, 1.0), "side force +100 % and mass -50 %"),
        ((0.0, 1.0, 0.01), (2.0, 3.0, 1.0), "mass: the data barely depend on it"),
    ],
)
def test_together(change: tuple[float, ...], values: tuple[float, ...], expected: str) -> None:
    assert expected in together_in_words(["side force", "mass", "arm"], np.array(change), np.array(values))


def test_where_it_went() -> None:
    assert moved_in_words(TunedParameter("m", "kg", 19.0, 20.5, 0.4, 0.25, OK)) == (
        "m: from 19.0000 to 20.50 +- 0.40 kg (determined, prior share 25 %)"
    )
    assert moved_in_words(TunedParameter("m", "kg", 19.0, 20.5, None, 0.0, OPEN)) == (
        "m: from 19.0000 to 20.5000 kg (not identifiable)"
    )


def test_no_more_measurements_than_parameters_is_said() -> None:
    p = problem(lambda s: s, np.array([1.0, 2.0]), 0.1, np.ones(2))
    assert any("no more measurements" in s for s in statements(p, estimate(p)))


def test_a_value_whose_interval_holds_zero_has_an_open_sign() -> None:
    p = problem(lambda s: s * T, 0.02 * T, 0.2, np.array([0.0]), sizes=np.array([1.0]), prior_mean=np.zeros(1),
                prior_error=np.array([np.inf]), high=np.array([np.inf]))  # fmt: skip
    (made,) = tuned_parameters("a", ["1"], p, estimate(p))
    assert abs(made.after) <= made.u95
    assert made.status == "sign_open"

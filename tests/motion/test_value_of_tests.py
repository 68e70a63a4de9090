"""Which test takes most off the variance: against the closed form of Gaussian inputs, and in a turn that is linear in its coefficients."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.motion.uncertainty.tests import group_share
from coeflab.report.tables.uncertainty import tests_table
from coeflab.vehicle.criteria import turning_ability
from tests.motion.test_uncertainty import LINEAR, parameters, small_turn, with_mass

tests_table.__test__ = False


def test_a_group_takes_off_what_its_conditional_mean_explains() -> None:
    """Var(E[y | x_g]) / Var(y) = b' S[:, g] S[g, g]^-1 S[g, :] b / b' S b of jointly normal inputs."""
    rng = np.random.default_rng(4)
    half = rng.normal(size=(5, 5))
    covariance, slope = half @ half.T, rng.normal(size=5)
    x = rng.multivariate_normal(np.zeros(5), covariance, 4000)
    y = x @ slope + 3.0
    y[7] = np.nan
    for group in ([0, 1], [2], [1, 3, 4]):
        across = slope @ covariance[:, group]
        due = across @ np.linalg.solve(covariance[np.ix_(group, group)], across) / (slope @ covariance @ slope)
        assert group_share(x[:, group], y) == pytest.approx(due, abs=0.02)
    assert group_share(x, y) == pytest.approx(1.0)


def test_squares_count_and_chance_does_not() -> None:
    rng = np.random.default_rng(8)
    x, noise = rng.normal(size=(300, 3)), rng.normal(size=300)
    assert group_share(x[:, :2], x[:, 0] ** 2) > 0.95
    assert sum(group_share(x, rng.normal(size=300)) > 0.0 for _ in range(50)) <= 2
    assert group_share(x[:6], noise[:6]) == 0.0
    assert group_share(np.ones((50, 2)), noise[:50]) == 0.0
    assert group_share(np.column_stack([x[:, 0], 2.0 * x[:, 0]]), x[:, 0]) == pytest.approx(1.0)


def test_in_a_linear_turn_the_shares_are_those_of_the_gradient() -> None:
    u95 = {"Ydr'": 6e-4, "Ndr'": 5e-4, "Nr'": 4e-4, "Yr'": 9e-4, "Nv'": 6e-4}
    carried = small_turn(u95, {}, members=400)
    found = next(i for i in carried.importances if i.figure == "steady yaw rate")
    mass = with_mass(parameters(LINEAR), np.zeros(3)).mass
    symbols = ["Yv", "Nv", "Yr", "Nr", "Ydr", "Ndr"]
    at = np.array([LINEAR[s] for s in symbols])
    steps = np.diag(1e-4 * np.abs(at))
    rates = turning_ability(at + steps, mass.mass_prime, 0.0) - turning_ability(at - steps, mass.mass_prime, 0.0)
    parts = {
        s: (rate / (2.0 * step) * u95.get(f"{s}'", 0.0)) ** 2
        for s, rate, step in zip(symbols, rates, np.diag(steps), strict=True)
    }
    whole = sum(parts.values())
    due = {
        "rudder": (parts["Ydr"] + parts["Ndr"]) / whole, "rotating arm, yaw": (parts["Yr"] + parts["Nr"]) / whole,
        "drift": parts["Nv"] / whole,
    }  # fmt: skip
    assert dict(found.tests) == pytest.approx(due, abs=0.05)
    assert [name for name, _ in found.tests] == sorted(due, key=lambda name: -due[name])
    rows = tests_table(carried).rows
    assert rows[0][0] == found.tests[0][0]
    assert {row[0] for row in rows} == set(due)

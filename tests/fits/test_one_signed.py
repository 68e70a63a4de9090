"""Slopes that one-signed curves allow: the algebra against non-negative least squares, planted truths, the length at a line."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from scipy import optimize, stats

from coeflab.core.types import Array
from coeflab.fits.statistics import one_signed
from coeflab.fits.statistics.slope_mixture import estimate_many, prepare
from tests.coverage.one_signed_campaigns import frontier, line_deviation

EVEN = np.linspace(-1.0, 1.0, 13)
ODD = np.linspace(0.0, 1.0, 8)[1:]
SINE = np.sin(np.radians(15.0))
TRUTHS = {
    "saturating": lambda v: -0.02 * v - 0.09 * v * np.abs(v) / (1.0 + np.abs(v) / 0.15),
    "slow power": lambda v: -0.02 * v - 0.06 * np.sign(v) * np.abs(v) ** 1.7,
}


def least_misfit(slope: float, t: Array, y: Array, free: Array) -> float:
    """By non-negative least squares, pair by pair and sign by sign."""
    bent = one_signed.curved(t)
    left = y - slope * t
    return min(
        optimize.nnls(np.column_stack([free, -free, sign * bent[:, list(pair)]]), left)[1] ** 2
        for pair in combinations(range(bent.shape[1]), 2)
        for sign in (1.0, -1.0)
    )


@pytest.mark.parametrize(("size", "odd"), [(0.0, False), (0.4, False), (-0.3, True), (0.6, True)])
def test_the_ends_are_where_no_pair_of_one_sign_fits_any_more(size: float, odd: bool) -> None:
    t = ODD if odd else EVEN
    noise = 0.01 * np.random.default_rng(7).standard_normal(len(t))
    y = t + size * np.sign(t) * np.abs(t) ** 2.3 + noise
    free = np.zeros((len(t), 0)) if odd else np.stack([np.ones_like(t), t * t], 1)
    shapes = one_signed.prepare(free, t[:, None], one_signed.curved(t))
    zero = np.zeros(1)
    ends = np.concatenate(one_signed.ends(shapes, y[None], 0.0, zero + 1.0, zero, zero))
    costs = [least_misfit(float(e), t, y, free) for e in ends]
    assert costs[0] == pytest.approx(costs[1], rel=1e-6)
    best = min(least_misfit(float(s), t, y, free) for s in np.linspace(*ends, 41))
    freedom = len(t) - free.shape[1] - 2
    straight = np.column_stack([free, t])
    line = float(np.sum((y - straight @ np.linalg.lstsq(straight, y, rcond=None)[0]) ** 2))
    bent = np.sqrt(max(line - best, 0.0) / (best / freedom))
    tail = np.interp(bent, one_signed.RULED_OUT, one_signed.TAILS)
    assert costs[0] == pytest.approx(best * (1.0 + stats.t.ppf(1.0 - tail, freedom) ** 2 / freedom), rel=0.02)


@pytest.mark.parametrize("name", TRUTHS)
@pytest.mark.parametrize("noise", [0.01, 0.003])
def test_curves_that_bend_early_are_covered(name: str, noise: float) -> None:
    """The mixture alone covered 37 to 92 % of these, its value on the side of the secant."""
    x = SINE * EVEN
    force = TRUTHS[name](x)
    y = force + noise * np.abs(force).max() * np.random.default_rng(3).standard_normal((60, len(x)))
    design = prepare(x)
    found, before = estimate_many(design, y), estimate_many(replace(design, shapes=()), y)
    assert np.mean(np.abs(found.value + 0.02) <= found.u95) >= 0.9
    assert np.array_equal(found.value, before.value)
    assert np.mean(np.abs(before.value + 0.02) <= before.u95) < 0.93


@pytest.mark.parametrize("t", [EVEN, np.linspace(-1.0, 1.0, 19), ODD], ids=["13", "19", "odd 7"])
def test_a_line_costs_at_most_a_fifth_more_than_the_shortest_interval_of_the_class(t: Array) -> None:
    odd = t.min() > 0.0
    y = t + 0.01 * np.random.default_rng(5).standard_normal((200, len(t)))
    found = estimate_many(prepare(t, odd=odd), y)
    plain = 0.01 * stats.t.ppf(0.975, len(t) - (1 if odd else 2)) * line_deviation(t, odd)
    assert found.u95.mean() / plain < 1.2 * frontier(t, odd)
    assert np.mean(np.abs(found.value - 1.0) <= found.u95) > 0.97


def test_the_frontier_is_the_one_that_was_measured_beside_the_project() -> None:
    """v|v| alone and powers of 2 to 4 3.5, of 1.7 to 4 4.6, of 1.5 to 4 6.0 to 6.1."""
    for t in (EVEN, np.linspace(-1.0, 1.0, 19)):
        got = [frontier(t, False, powers, ()) for powers in ((2.0,), (2.0, 3.0, 4.0), (1.7, 4.0), (1.5, 4.0))]
        assert got == pytest.approx([3.5, 3.5, 4.6, 6.05], abs=0.1)


def test_where_the_class_does_not_fit_the_mixture_stands_alone() -> None:
    x = SINE * np.linspace(-1.0, 1.0, 19)
    y = -0.028 * x + 0.3 * np.sign(x) * np.maximum(np.abs(x) - 0.1, 0.0)
    y = y + 1e-5 * np.random.default_rng(1).standard_normal((4, len(x)))
    design = prepare(x)
    assert np.array_equal(estimate_many(design, y).u95, estimate_many(replace(design, shapes=()), y).u95)

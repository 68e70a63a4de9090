"""The calibrated slope at the origin: planted truths, wrong and copied rows, and its algebra against dense formulas."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy import special, stats

from coeflab.core.types import Array
from coeflab.fits.statistics.origin_slope import OriginSlope, Status, curve, estimate
from coeflab.fits.statistics.slope_mixture import (
    POWER,
    SIZES,
    estimate_many,
    prepare,
)
from coeflab.fits.statistics.slopes import by_largest
from coeflab.fits.statistics.student_mixture import STEPS, mixture_quantiles, root

SLOPE = -0.028
NOISE = 1e-4


def angles(largest: float, n: int) -> Array:
    return np.sin(np.radians(np.linspace(-largest, largest, n)))


def force(x: Array) -> Array:
    return SLOPE * x - 0.06 * x * np.abs(x) - 0.0002


X = angles(18.0, 19)
SHOCKS = np.random.default_rng(4).standard_normal(19)
Y = force(X) + NOISE * SHOCKS


@pytest.fixture(scope="module")
def clean() -> OriginSlope:
    return estimate(X, Y)


def contains(s: OriginSlope, slope: float = SLOPE) -> bool:
    return abs(s.value - slope) <= s.u95


def test_a_clean_sweep_has_a_value_that_contains_the_truth_and_no_remark(clean: OriginSlope) -> None:
    assert clean.status is Status.OK
    assert contains(clean)
    assert clean.u95 < 0.36 * abs(SLOPE)
    assert not clean.notes
    assert clean.used.all()
    assert clean.noise == pytest.approx(NOISE, rel=0.5)


@pytest.mark.parametrize(("row", "factor"), [(13, 3.0), (5, -1.0), (15, 10.0), (3, 0.1), (18, 1.5), (0, 10.0)])
def test_a_wrong_point_is_named_and_does_not_move_the_value(clean: OriginSlope, row: int, factor: float) -> None:
    y = Y.copy()
    y[row] *= factor
    s = estimate(X, y)
    assert s.status is Status.WRONG_POINT
    assert np.flatnonzero(~s.used).tolist() == [row]
    assert f"rows {row} " in s.reason
    assert abs(s.value - clean.value) < clean.u95
    assert s.u95 < 1.5 * clean.u95
    assert s.without[row] == pytest.approx(s.value)


def test_without_the_gate_the_point_that_triples_would_have_moved_it(clean: OriginSlope) -> None:
    y = Y.copy()
    y[13] *= 3.0
    with_all = estimate(X, y).with_all
    assert not clean.lower <= with_all <= clean.upper
    assert abs(with_all - clean.value) > 0.5 * abs(SLOPE)


def test_two_wrong_points_are_both_named(clean: OriginSlope) -> None:
    y = Y.copy()
    y[[4, 13]] *= [10.0, 3.0]
    s = estimate(X, y)
    assert np.flatnonzero(~s.used).tolist() == [4, 13]
    assert abs(s.value - clean.value) < clean.u95


def test_rows_pasted_five_times_count_once(clean: OriginSlope) -> None:
    s = estimate(np.tile(X, 5), np.tile(Y, 5))
    assert s.u95 == pytest.approx(clean.u95, rel=1e-6)
    assert s.value == pytest.approx(clean.value, rel=1e-9)
    assert s.notes == ("76 rows repeat an earlier row exactly and count once",)


def test_a_mirrored_half_is_no_new_data() -> None:
    x = angles(18.0, 25)[13:]
    y = SLOPE * x - 0.06 * x * x + NOISE * np.random.default_rng(1).standard_normal(len(x))
    s = estimate(np.r_[-x, x], np.r_[-y, y])
    assert any("mirror" in n for n in s.notes)
    plain = estimate_many(prepare(np.r_[-x, x]), np.r_[-y, y])
    assert s.u95 == pytest.approx(np.sqrt(2.0) * plain.u95[0])


@pytest.mark.parametrize("n", [5, 6, 9])
@pytest.mark.parametrize("largest", [0.5, 2.0, 18.0])
@pytest.mark.parametrize("one_sided", [False, True])
def test_five_clean_points_give_a_value_whatever_their_range(n: int, largest: float, one_sided: bool) -> None:
    x = angles(largest, 2 * n - 1)[n - 1 :] if one_sided else angles(largest, n)
    f = SLOPE * x
    s = estimate(x, f + 0.003 * np.abs(f).max() * np.random.default_rng(n).standard_normal(n))
    assert s.status in (Status.OK, Status.OPEN)
    assert contains(s)


def test_less_noise_gives_less_u95_down_to_exact_data() -> None:
    u95 = [estimate(X, force(X) + size * SHOCKS).u95 for size in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 0.0)]
    assert all(less < more for more, less in pairwise(u95))
    assert u95[-1] < 1e-4 * abs(SLOPE)


@pytest.mark.parametrize("curved", [lambda x: SLOPE * x, force, lambda x: 0.14 * SLOPE * np.tanh(x / 0.14)])
def test_exact_data_give_a_tight_interval_about_the_slope(curved: Callable[[Array], Array]) -> None:
    s = estimate(X, curved(X))
    assert contains(s)
    assert s.u95 < 0.15 * abs(SLOPE)


def test_units_and_signs_only_scale_the_answer(clean: OriginSlope) -> None:
    s = estimate(-100.0 * X, 7.0 * Y)
    assert (s.value, s.u95) == pytest.approx((-0.07 * clean.value, 0.07 * clean.u95), rel=1e-6)
    assert estimate(X[::-1], Y[::-1]).value == pytest.approx(clean.value, rel=1e-6)


def test_stated_errors_weigh_the_rows() -> None:
    se = np.where(np.arange(19) % 2 == 0, 1e-5, 1e-3)
    y = force(X) + se * SHOCKS
    weighted, plain = estimate(X, y, se), estimate(X, y)
    assert contains(weighted)
    assert weighted.u95 < 0.5 * plain.u95


def test_stated_errors_that_are_too_small_do_not_narrow_much_and_large_ones_widen(clean: OriginSlope) -> None:
    assert estimate(X, Y, np.full(19, NOISE / 10.0)).u95 > 0.7 * clean.u95
    assert estimate(X, Y, np.full(19, NOISE * 10.0)).u95 > 2.0 * clean.u95
    assert estimate(X, Y, np.full(19, np.nan)).u95 == pytest.approx(clean.u95)


def test_replicates_narrow(clean: OriginSlope) -> None:
    x = np.repeat(X, 4)
    shocks = np.random.default_rng(6).standard_normal(76)
    s = estimate(x, force(x) + NOISE * shocks)
    assert contains(s)
    assert s.u95 < clean.u95


def test_replicates_that_share_an_error_of_their_setting_do_not_narrow_as_if_they_did_not() -> None:
    rng = np.random.default_rng(8)
    x = np.repeat(X, 3)
    y = force(x) + np.repeat(NOISE * rng.standard_normal(19), 3) + 0.02 * NOISE * rng.standard_normal(57)
    s = estimate(x, y)
    assert contains(s)
    assert s.u95 > 0.5 * estimate(X, y[::3]).u95


def test_a_one_sided_sweep_says_so_and_still_covers() -> None:
    inside = 0
    x = X[9:]
    for seed in range(10):
        s = estimate(x, force(x) + NOISE * np.random.default_rng(seed).standard_normal(10))
        assert any("one-sided" in n for n in s.notes)
        inside += contains(s)
    assert inside >= 9


def test_too_few_settings_have_no_value_and_a_reason() -> None:
    s = estimate(np.array([-0.1, 0.1, 0.1]), np.array([1.0, -1.0, -1.1]))
    assert s.status is Status.TOO_FEW
    assert np.isnan(s.value)
    assert s.reason == "2 different settings, at least 3 are needed"
    assert np.isnan(curve(s, X)[0]).all()
    assert estimate(np.zeros(4), np.arange(4.0)).status is Status.TOO_FEW


@pytest.mark.parametrize("y", [np.zeros(3), np.full(19, np.nan)])
def test_ragged_or_infinite_input_is_refused(y: Array) -> None:
    with pytest.raises(ValueError, match="finite and of one length"):
        estimate(X, y)


def test_a_slope_lost_in_the_noise_is_open() -> None:
    s = estimate(X, 1e-5 * X + 1e-3 * SHOCKS)
    assert s.status is Status.OPEN
    assert abs(s.value) < s.u95


@pytest.mark.parametrize("second", [0.0, 3.0], ids=["symmetric", "skewed"])
def test_value_and_u95_have_the_probability_of_the_interval(second: float) -> None:
    share, mean, scale, freedom = np.array([0.8, 0.2]), np.array([0.0, second]), np.array([1.0, 2.0]), 12.0
    ends, half, _ = mixture_quantiles(
        np.log(share)[None], mean[None], scale[None], np.full((1, 2), freedom), np.array([0.02])
    )

    def probability(low: float, high: float) -> float:
        below = [stats.t.cdf((z - mean) / scale, freedom) for z in (low, high)]
        return float(share @ (below[1] - below[0]))

    lower, value, upper = ends[0]
    assert probability(lower, upper) == pytest.approx(0.96, abs=1e-5)
    assert probability(value - half[0], value + half[0]) == pytest.approx(0.96, abs=1e-5)
    if second:
        assert half[0] > 1.02 * 0.5 * (upper - lower)
    else:
        assert half[0] == pytest.approx(0.5 * (upper - lower), rel=1e-5)


def test_a_sign_is_open_where_what_is_printed_contains_zero() -> None:
    slopes = [estimate(X, k * 1e-4 * X + 4e-5 * SHOCKS) for k in range(0, 20, 4)]
    assert [s.status is Status.OPEN for s in slopes] == [abs(s.value) <= s.u95 for s in slopes]
    assert len({s.status for s in slopes}) == 2


def test_the_curve_and_its_band_hold_the_truth(clean: OriginSlope) -> None:
    at = np.linspace(X[0], X[-1], 41)
    mean, half = curve(clean, at)
    assert np.mean(np.abs(mean - force(at)) <= half) > 0.9
    assert np.all(half < 3.0 * NOISE)


def test_shorter_sweeps_are_wider(clean: OriginSlope) -> None:
    caps = np.sin(np.radians([6.0, 10.0, 18.0]))
    rows = by_largest(X, Y, caps)
    assert [c for c, _ in rows] == list(caps)
    assert rows[-1][1].u95 == pytest.approx(clean.u95)
    assert rows[0][1].u95 > rows[1][1].u95 > rows[2][1].u95
    assert all(contains(s) for _, s in rows)


@pytest.mark.parametrize("name", ["none", "series", "p1", "on.4"])
def test_one_member_is_the_dense_restricted_likelihood(name: str) -> None:
    design = prepare(X)
    m = next(m for m in design.members if (name, True) in m.kinds)
    here = [i for i, kind in enumerate(m.kinds) if kind == (name, True)]
    alone = np.full(m.log_prior.shape, -np.inf)
    alone[:, here] = m.log_prior[:, here]
    got = estimate_many(replace(design, members=(replace(m, log_prior=alone),)), Y, deletions=False)
    size = np.abs(Y - np.median(Y)).max()
    flat, sized = design.terms[:, :2], design.terms[:, 2:]
    log_weight, slopes, scales = [], [], []
    for j in here:
        remainder = np.linalg.inv(m.root[j].T @ m.root[j])
        for k in range(len(m.precision)):
            full = remainder + sized @ np.diag(1.0 / m.precision[k, 2:]) @ sized.T
            solved = np.linalg.solve(full, np.column_stack([flat, Y / size]))
            normal = flat.T @ solved[:, :2]
            b = np.linalg.solve(normal, flat.T @ solved[:, 2])
            squares = (Y / size - flat @ b) @ (solved[:, 2] - solved[:, :2] @ b)
            log = -0.5 * np.linalg.slogdet(full)[1] - 0.5 * np.linalg.slogdet(normal)[1] - 8.5 * np.log(squares)
            log_weight.append(m.log_prior[k, j] + POWER * log)
            slopes.append(b[1])
            scales.append(np.sqrt(squares / 17.0 * np.linalg.inv(normal)[1, 1]))
    w = special.softmax(log_weight)
    unit = size / X[-1]
    for end in (got.lower[0], got.value[0], got.upper[0]):
        dense = (w * stats.t.cdf((end / unit - np.array(slopes)) / np.array(scales), 17)).sum()
        expected = {got.value[0]: 0.5}.get(end, dense)
        assert dense == pytest.approx(expected, abs=2e-3)
    assert got.weights[0].max() == pytest.approx(w.max(), rel=1e-3)
    assert len(SIZES) >= 5


@pytest.mark.parametrize("x", [X, X[9:], np.repeat(X[::2], 2)], ids=["even", "one-sided", "replicated"])
@pytest.mark.parametrize("noise", [1e-4, 1e-7])
def test_deletion_by_bordering_is_the_fit_without_the_row(x: Array, noise: float) -> None:
    rng = np.random.default_rng(12)
    y = force(x) + 0.3 * np.sign(x) * np.maximum(np.abs(x) - 0.2, 0.0) + noise * rng.standard_normal(len(x))
    all_rows = estimate_many(prepare(x), y)
    for row in (0, 2, len(x) // 2):
        rest = np.arange(len(x)) != row
        if np.abs(x[rest]).max() < np.abs(x).max():
            continue
        refit = estimate_many(prepare(x[rest]), y[rest], deletions=False)
        assert abs(all_rows.without[0, row] - refit.mean[0]) < 0.05 * refit.u95[0]
    assert all_rows.wrong.max() < 0.5


def test_campaigns_that_share_a_design_are_fitted_as_if_alone() -> None:
    y = force(X) + NOISE * np.random.default_rng(2).standard_normal((5, 19))
    together = estimate_many(prepare(X), y)
    for i, row in enumerate(y):
        alone = estimate(X, row)
        assert together.value[i] == pytest.approx(alone.value, rel=1e-9)
        assert together.u95[i] == pytest.approx(alone.u95, rel=1e-9)


@pytest.mark.parametrize(
    ("starboard", "port"), [(0.4, 0.4), (0.6, 0.2), (0.5, 0.0)], ids=["both", "uneven", "one side"]
)
def test_separation_at_large_angles_does_not_widen_the_slope(starboard: float, port: float) -> None:
    x = np.sin(np.radians(np.r_[-18:-9:2.0, -8:8.1:1.0, 10:18.1:2.0]))
    knee = np.sin(np.radians(12.0))
    f = -0.012 * x - 0.05 * x * np.abs(x) + starboard * np.maximum(x - knee, 0.0) - port * np.maximum(-x - knee, 0.0)
    y = f + 0.01 * np.abs(f).max() * np.random.default_rng(1).standard_normal((4, len(x)))
    inner = np.abs(x) < knee + 1e-9
    whole, cut = estimate_many(prepare(x), y), estimate_many(prepare(x[inner]), y[:, inner])
    assert np.median(whole.u95) < np.median(cut.u95)
    assert np.mean((whole.lower < -0.012) & (whole.upper > -0.012)) >= 0.75


@pytest.mark.parametrize("power", [1.75, 2.5, 3.5])
def test_a_power_that_is_no_member_is_covered_when_the_noise_is_small(power: float) -> None:
    f = SLOPE * X - 0.1 * np.sign(X) * np.abs(X) ** power
    y = f + 1e-4 * np.abs(f).max() * np.random.default_rng(5).standard_normal((6, 19))
    s = estimate_many(prepare(X), y, deletions=False)
    assert np.all(np.abs(s.value - SLOPE) <= s.u95)


def test_more_noise_leaves_a_smaller_tail_out() -> None:
    y = SLOPE * X + np.abs(SLOPE) * X[-1] * np.array([[1e-4], [3e-2]]) * SHOCKS
    s = estimate_many(replace(prepare(X), shapes=()), y, deletions=False)
    assert np.all(np.diff(s.u95 / s.sd) > 0.0)


@pytest.mark.parametrize("freedom", [3.0, 12.0])
def test_ends_and_half_of_random_mixtures_have_their_probabilities(freedom: float) -> None:
    """Members far apart and a hundred times narrower than others among them; a part of the reach is up to 1e-4 of a narrow one."""
    rng = np.random.default_rng(1)
    for members in (1, 2, 5, 40):
        b = 8
        share, mean = (
            rng.dirichlet(np.full(members, 0.5), b),
            rng.normal(0.0, rng.choice([0.0, 1.0, 5.0]), (b, members)),
        )
        scale, tail = np.exp(rng.normal(0.0, 1.5, (b, members))), rng.uniform(0.005, 0.05, b)
        ends, half, _ = mixture_quantiles(
            np.log(np.maximum(share, 1e-300)), mean, scale, np.full_like(mean, freedom), tail
        )

        def below(z: Array, share: Array = share, mean: Array = mean, scale: Array = scale) -> Array:
            return np.asarray((share * stats.t.cdf((z[:, None] - mean) / scale, freedom)).sum(1))

        for end, goal in zip(ends.T, (tail, 0.5, 1.0 - tail), strict=True):
            assert below(end) == pytest.approx(goal, abs=1e-4)
        assert below(ends[:, 1] + half) - below(ends[:, 1] - half) == pytest.approx(1.0 - 2.0 * tail, abs=1e-4)


@pytest.mark.parametrize(
    "function",
    [np.tanh, lambda z: z**3, lambda z: np.where(z < 0.0, 1e-3 * z, 1e3 * z), lambda z: np.where(z < 0.3, -1.0, 1.0) + 0.1 * z, np.cbrt],
    ids=["flat ends", "flat root", "kink", "step", "steep"],
)  # fmt: skip
def test_the_root_is_that_of_halvings(function: Callable[[Array], Array]) -> None:
    """To a part of 2^22, whatever the shape, from any guess; one pair of ends without width stays."""
    at, steps = np.array([[-0.71], [0.0], [0.33], [0.999]]), []

    def excess(z: Array) -> Array:
        steps.append(len(z))
        return np.asarray(function(z - at))

    low, high = np.array([[-1.0], [-1.0], [-1.0], [0.999]]), np.array([[1.0], [2.0], [30.0], [0.999]])
    found = root(excess, low, high, np.full_like(at, 0.9), np.ones_like(at))
    for _ in range(22):
        z = 0.5 * (low + high)
        right = excess(z) < 0.0
        low, high = np.where(right, z, low), np.where(right, high, z)
    assert found.ravel() == pytest.approx((0.5 * (low + high)).ravel(), abs=31.0 / 2**22)
    assert len(steps) - 22 < STEPS

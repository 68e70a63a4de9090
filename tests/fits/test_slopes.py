"""The rule for the recommended slope: planted truths, symmetries, and what it says when data run out."""

from __future__ import annotations

import inspect

import numpy as np
import pytest
import statsmodels.api as sm
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from coeflab.core.types import Array
from coeflab.fits.statistics import slopes
from coeflab.fits.statistics.slopes import (
    MEMBER,
    NO_INTERVAL,
    TOO_WIDE,
    Recommendation,
    design,
    estimate,
    influence,
    recommend,
    windows,
)

SMALLEST = float(np.sin(np.radians(3.0)))
TRUTHS = {
    "line": lambda x: 1e-4 - 0.03 * x,
    "cubic": lambda x: 1e-4 - 0.03 * x - 0.2 * x**3,
    "quintic": lambda x: 1e-4 - 0.03 * x - 0.3 * x**3 + 2.0 * x**5,
    "x|x|": lambda x: 1e-4 - 0.03 * x - 0.06 * x * np.abs(x),
    "x|x| with an even part": lambda x: 1e-4 - 0.03 * x - 0.06 * x * np.abs(x) + 0.02 * x**2,
}


def angles(*degrees: float) -> Array:
    return np.sin(np.radians(degrees))


def noisy(seed: int, n: int = 25, one_sided: bool = False) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    x = np.sin(np.radians(np.linspace(0.0 if one_sided else -18.0, 18.0, n) + rng.uniform(-0.1, 0.1, n)))
    x = np.abs(x) if one_sided else x
    return x, TRUTHS["quintic"](x) + 0.01 * x**2 + 1e-4 * rng.standard_normal(n)


def numbers(r: Recommendation) -> list[float]:
    assert r.value is not None
    assert r.random is not None
    return [r.value, r.random, r.u95 if r.u95 is not None else -1.0, float(len(r.members))]


@pytest.mark.parametrize("truth", TRUTHS)
@settings(max_examples=25, deadline=None)
@given(
    left=st.floats(12.0, 25.0), right=st.floats(12.0, 25.0), n=st.integers(13, 40), size=st.floats(-4.0, 4.0)
)  # fmt: skip
def test_planted_slopes_come_back_without_noise(truth: str, left: float, right: float, n: int, size: float) -> None:
    x = np.sin(np.radians(np.linspace(-left, right, n)))
    answer = recommend(x, 10.0**size * TRUTHS[truth](x), smallest=SMALLEST)
    assert answer.value == pytest.approx(-0.03 * 10.0**size, rel=1e-9)


@pytest.mark.parametrize("truth", ["line", "cubic", "quintic"])
def test_planted_slopes_come_back_from_one_side(truth: str) -> None:
    x = angles(*np.linspace(0.0, 18.0, 19))
    answer = recommend(x, TRUTHS[truth](x), smallest=SMALLEST)
    assert answer.value == pytest.approx(-0.03, rel=1e-9)
    assert all("x2" not in e.terms for e in answer.panel), "x|x| and x^2 are one column on one side"


@pytest.mark.parametrize(("target", "wanted"), [("x2", 0.4), ("1", -1e-3)])
def test_planted_curvature_and_intercept_come_back(target: str, wanted: float) -> None:
    x = angles(*np.linspace(-18.0, 18.0, 25))
    answer = recommend(x, -1e-3 + 0.4 * x**2 - 2.0 * x**4 + 3e-4 * x, parity="even", target=target)
    assert answer.value == pytest.approx(wanted, rel=1e-9)


@given(st.integers(0, 500), st.floats(0.01, 100.0), st.floats(1e-3, 1e5), st.booleans())
@settings(max_examples=15, deadline=None)
def test_units_of_motion_and_force_do_not_matter(seed: int, a: float, b: float, one_sided: bool) -> None:
    x, y = noisy(seed, one_sided=one_sided)
    here, there = recommend(x, y, smallest=SMALLEST), recommend(a * x, b * y, smallest=a * SMALLEST)
    scale = np.array([b / a, b / a, b / a if here.u95 is not None else 1.0, 1.0])
    np.testing.assert_allclose(numbers(there), scale * numbers(here), rtol=1e-7)


@given(st.integers(0, 500))
@settings(max_examples=15, deadline=None)
def test_port_and_starboard_are_alike(seed: int) -> None:
    x, y = noisy(seed)
    here = numbers(recommend(x, y, smallest=SMALLEST))
    there = numbers(recommend(-x, y, smallest=SMALLEST))
    np.testing.assert_allclose(there, [-here[0], *here[1:]], rtol=1e-8)
    turned = numbers(recommend(-x, -y, smallest=SMALLEST))
    np.testing.assert_allclose(turned, here, rtol=1e-8)


@given(st.integers(0, 500), st.randoms(use_true_random=False))
@settings(max_examples=15, deadline=None)
def test_the_order_of_rows_does_not_matter(seed: int, random: object) -> None:
    x, y = noisy(seed)
    order = np.random.default_rng(seed + 1).permutation(len(x))
    np.testing.assert_allclose(
        numbers(recommend(x[order], y[order], smallest=SMALLEST)),
        numbers(recommend(x, y, smallest=SMALLEST)),
        rtol=1e-8,
    )


@given(st.integers(0, 500), st.floats(-0.01, 0.01))
@settings(max_examples=15, deadline=None)
def test_a_constant_force_does_not_move_the_slope(seed: int, bias: float) -> None:
    x, y = noisy(seed)
    np.testing.assert_allclose(
        numbers(recommend(x, y + bias, smallest=SMALLEST)), numbers(recommend(x, y, smallest=SMALLEST)), rtol=1e-7
    )


@given(st.integers(0, 500), st.floats(1e-6, 1e3))
@settings(max_examples=10, deadline=None)
def test_equal_standard_errors_weigh_nothing(seed: int, error: float) -> None:
    x, y = noisy(seed)
    with_errors = numbers(recommend(x, y, np.full(len(x), error), smallest=SMALLEST))
    np.testing.assert_allclose(with_errors, numbers(recommend(x, y, smallest=SMALLEST)), rtol=1e-8)


def test_a_point_with_a_large_standard_error_hardly_counts() -> None:
    x, y = noisy(3)
    se = np.full(len(x), 1e-4)
    clean = recommend(x, y, se, smallest=SMALLEST)
    y[5], se[5] = y[5] + 0.01, 10.0
    spoilt = recommend(x, y, se, smallest=SMALLEST)
    assert clean.value is not None
    assert clean.u95 is not None
    assert spoilt.value == pytest.approx(clean.value, abs=clean.u95)


def test_the_rule_sees_data_and_options_only() -> None:
    """No argument through which a reference value could reach it."""
    assert list(inspect.signature(recommend).parameters) == [
        "x", "y", "se", "parity", "target", "smallest", "largest",
    ]  # fmt: skip


def test_a_single_family_has_no_u95() -> None:
    answer = recommend(angles(0.0, 6.0, 12.0), np.array([0.0, -0.0031, -0.0059]), smallest=SMALLEST)
    assert [e.family.name for e in answer.members] == ["line"]
    assert answer.value is not None
    assert answer.random is not None
    assert answer.u95 is None
    assert answer.model_form is None


@pytest.mark.parametrize("x", [[], [0.0, 0.0, 0.0], [0.1], [0.0, 0.1]])
def test_nothing_to_fit_gives_no_value(x: list[float]) -> None:
    answer = recommend(np.array(x), np.zeros(len(x)))
    assert answer == Recommendation(None, None, None, None, (), ())


def test_one_angled_run_gives_no_value_although_a_line_passes() -> None:
    answer = recommend(np.array([0.0, 0.0, 0.0, 0.0, 0.1]), np.array([1e-4, -1e-4, 2e-4, -2e-4, -3e-3]))
    assert answer.value is None
    assert [e.role for e in answer.panel] == [NO_INTERVAL]


def test_windows_go_by_nominal_angle() -> None:
    """Nominal 4 degrees of Roddy's tables are 3.93 to 4.11 as run."""
    x = angles(0.0, 2.0, -1.9, 3.93, -4.11, 4.03, -3.98, 5.97, -6.02, 10.05, -9.98, 18.0, -18.05)
    found = {len(rows): np.degrees(np.arcsin(w)) for w, rows in windows(x, 0.0, np.inf)}
    assert found == {n: pytest.approx(w) for n, w in [(3, 2.0), (7, 4.11), (9, 6.02), (11, 10.05), (13, 18.05)]}
    (only,) = windows(x, angles(4.0)[0], angles(4.0)[0])
    assert len(only[1]) == 7
    assert [len(rows) for _, rows in windows(x, SMALLEST, angles(10.0)[0])] == [7, 9, 11]


def test_rows_beyond_the_largest_window_do_not_count() -> None:
    x, y = noisy(1)
    outside = np.abs(x) > angles(12.5)[0]
    assert outside.sum() >= 4
    spoilt = np.where(outside, 1.0, y)
    here = recommend(x, y, smallest=SMALLEST, largest=angles(12.0)[0])
    assert numbers(recommend(x, spoilt, smallest=SMALLEST, largest=angles(12.0)[0]))[:1] == pytest.approx([here.value])
    assert max(e.window for e in here.panel) < angles(12.5)[0]


def test_richer_forms_reach_further() -> None:
    """Each family's window ends before its next odd term shows."""
    x = angles(*np.linspace(-18.0, 18.0, 37))
    y = TRUTHS["quintic"](x) + 2e-5 * np.random.default_rng(0).standard_normal(37)
    panel = recommend(x, y, smallest=SMALLEST).panel
    kept = {e.terms[:4]: e.window for e in panel if e.role not in ("smaller window", "beyond the window")}
    line, cubic = kept[("1", "x", "x2")], kept[("1", "x", "x3", "x2")]
    quintic = kept[("1", "x", "x3", "x5")]
    assert line < cubic < quintic
    beyond = [e for e in panel if e.role == "beyond the window" and e.terms == ("1", "x", "x2")]
    assert beyond[0].next_term < 0.05


def test_x_abs_x_must_beat_the_cubic() -> None:
    x = angles(*np.linspace(-18.0, 18.0, 25))
    shocks = 2e-5 * np.random.default_rng(0).standard_normal(25)
    for truth, wanted in (("x|x|", True), ("cubic", False)):
        members = recommend(x, TRUTHS[truth](x) + shocks, smallest=SMALLEST).members
        assert any(e.family.must_beat for e in members) is wanted


def test_value_and_u95_are_median_and_sum_of_squares_of_the_members() -> None:
    x, y = noisy(5)
    answer = recommend(x, y, smallest=SMALLEST)
    values, halves = [e.value for e in answer.members], [e.half_hc2 for e in answer.members]
    assert len(values) >= 2
    assert answer.value == np.median(values)
    assert answer.random == np.median(halves)
    assert answer.value is not None
    farthest = max(abs(v - answer.value) for v in values)
    assert answer.model_form == pytest.approx(2.0 * farthest / 3**0.5)
    assert answer.u95 == pytest.approx((answer.random**2 + answer.model_form**2) ** 0.5)
    assert max(halves) <= 3.0 * min(halves)
    assert [e for e in answer.panel if e.role == MEMBER] == list(answer.members)


def test_next_term_probability_is_the_hc3_t_test_of_statsmodels() -> None:
    x, y = noisy(7)
    se = np.random.default_rng(7).uniform(0.5, 2.0, len(x))
    peer = sm.WLS(y, design(("1", "x", "x2", "x3"), x), se**-2.0).fit(cov_type="HC3", use_t=True)
    found = slopes.next_term_probability(("1", "x", "x2"), "x3", x, y, se)
    assert found == pytest.approx(peer.pvalues[3], rel=1e-8)
    assert np.isnan(slopes.next_term_probability(("1", "x"), "x3", x[:4], y[:4], None))


def test_rounding_is_no_next_term() -> None:
    """Without noise the t-ratio of the next term is that of two rounding errors."""
    x = angles(*np.linspace(-18.0, 18.0, 19))
    assert slopes.next_term_probability(("1", "x"), "x3", x, 0.1 + 0.7 * x, None) == 1.0
    assert slopes.next_term_probability(("1", "x"), "x3", x, np.zeros(19), None) == 1.0
    assert slopes.next_term_probability(("1", "x"), "x3", x, 0.1 + 0.7 * x + 1e-9 * x**3, None) < 1e-6


def test_influence_of_one_member_is_its_hc2_standard_error() -> None:
    x, y = noisy(9)
    for e in recommend(x, y, smallest=SMALLEST).members:
        moved = influence((e,), len(x))
        assert float(moved @ moved) == pytest.approx(e.standard_error**2, rel=1e-10)
        assert not np.any(np.delete(moved, e.rows))


def test_the_curve_passes_through_noise_free_points() -> None:
    x = angles(*np.linspace(-18.0, 18.0, 25))
    for e in recommend(x, TRUTHS["cubic"](x), smallest=SMALLEST).members:
        np.testing.assert_allclose(e.curve(x), TRUTHS["cubic"](x), atol=1e-12)


def test_an_estimate_with_standard_errors_is_the_weighted_fit_of_statsmodels() -> None:
    x, y = noisy(11)
    se = np.random.default_rng(11).uniform(2e-5, 4e-4, len(x))
    rows, terms = np.flatnonzero(np.abs(x) < 0.25), ("1", "x", "x3", "x2")
    found = estimate(slopes.ODD[1], terms, "x", x, y, se, rows)
    assert found is not None
    by_hand = design(terms, x[rows])
    for kind, half in (("HC2", None), ("HC3", found.half_hc3)):
        peer = sm.WLS(y[rows], by_hand, se[rows] ** -2.0).fit(cov_type=kind, use_t=True)
        np.testing.assert_allclose(found.coefficients, peer.params, rtol=1e-9)
        if half is None:
            assert found.standard_error == pytest.approx(peer.bse[1], rel=1e-9)
        else:
            assert half == pytest.approx(peer.bse[1] * stats.t.ppf(0.975, len(rows) - 4), rel=1e-9)
    assert found.half_hc2 == pytest.approx(found.standard_error * stats.t.ppf(0.975, found.freedom), rel=1e-9)
    assert found.freedom < len(rows) - 4
    misfit = float(np.sum(((y[rows] - found.curve(x[rows])) / se[rows]) ** 2))
    assert found.lack_of_fit == pytest.approx(stats.chi2.sf(misfit, len(rows) - 4), rel=1e-8)
    assert found.window == np.abs(x[rows]).max()
    assert found.value == found.coefficients[1]


def test_a_lone_member_is_held_against_the_families_dropped_for_their_width() -> None:
    """With little noise only the true form is narrow; the others still tell what the form is worth."""
    x = angles(*np.linspace(-18.0, 18.0, 25))
    y = TRUTHS["x|x|"](x) + 2e-6 * np.random.default_rng(0).standard_normal(25)
    answer = recommend(x, y, smallest=SMALLEST)
    assert [e.family.must_beat != "" for e in answer.members] == [True]
    wide = [e.value for e in answer.panel if e.role == TOO_WIDE]
    assert wide
    values = [e.value for e in answer.members] + wide
    assert answer.value is not None
    assert answer.model_form == pytest.approx(2.0 * max(abs(v - answer.value) for v in values) / 3**0.5)

"""Slopes at the origin through the shipped SUBOFF campaigns (Roddy 1990, DTRC/SHD-1298-08, Appendix B)."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.fits import FITS, slope_at_origin
from coeflab.fits.results.fit_result import FitResult, Sweep
from coeflab.fits.rows.sweeps import JUMPED, STALLED
from coeflab.fits.statistics import slopes
from coeflab.fits.statistics.origin_slope import estimate
from coeflab.fits.statistics.slope_mixture import estimate_many
from coeflab.fits.statistics.slopes import Estimate
from coeflab.law.coefficient import Status
from coeflab.report.tables.nouns import window_text
from coeflab.study.checks import coverage, significance
from coeflab.study.checks.fitted_range import moved_by_the_rest
from coeflab.study.study import Study
from coeflab.tables.campaign import FILE, read_campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import IMPORTERS
from tests.report.studies import LENGTH, small_study, small_table

LINE, CUBIC, SQUARE = "line", "{x} + {x}^3", "{x} + {x}|{x}|"
ESTIMATORS = ((4.0, LINE), (10.0, CUBIC), (18.0, SQUARE))
PRINTED = {
    (1, "Zw"): ("-.0142", "-.0131", "-.0085"),
    (1, "Mw"): (".0102", ".0105", ".0112"),
    (2, "Yv"): ("-.0293", "-.0284", "-.0240"),
    (2, "Nv"): ("-.0138", "-.0139", "-.0148"),
    (3, "Yv"): ("-.0070", "-.0060", "-.0016"),
}
# A doubtful cell is one with a digit that the transcriber inferred. Leaving it out moves these.
WITHOUT_DOUBTFUL = {
    (1, "Zw", 10.0): ("-.0130", "20"),  # Z at -9.98 degrees
    (1, "Zw", 18.0): ("-.0087", "20"),
    (2, "Yv", 18.0): ("-.0239", "80"),  # Y at 18.07 degrees
    (2, "Nv", 10.0): ("-.0138", "96"),  # N at -4.03 degrees
    (2, "Nv", 18.0): ("-.0147", "96"),
}
RECOMMENDED = [(1, "Zw"), (1, "Mw"), (2, "Yv"), (2, "Nv"), (3, "Yv"), (3, "Nv")]


@cache
def tables(campaign: str) -> tuple[ForceTable, ...]:
    return IMPORTERS.load("csv").read(read_campaign(shipped("cfd_data") / campaign / FILE))


@cache
def fitted(campaign: str, doubtful: bool = False, shift: float = 0.0) -> FitResult:
    used = [t.with_uncertain_cells() if doubtful else t for t in tables(campaign)]
    used = [t.about(t.reference_point + np.array([shift, 0.0, 0.0])) for t in used]
    return FITS.load("slope_at_origin").fit(used, used[0].scaling, {})


def plain(sweep: Sweep, nominal: float, family: str) -> Estimate:
    """The family in the largest window of the nominal angle; runs are within 0.15 degrees of it."""
    found = [
        e for e in sweep.forms if e.family.name == family and abs(np.degrees(np.arcsin(e.window)) - nominal) <= 0.15
    ]
    return max(found, key=lambda e: e.window)


def four_digits(value: float) -> str:
    return f"{value:.4f}".replace("0.", ".", 1)


@pytest.mark.parametrize(("configuration", "symbol"), PRINTED)
def test_single_estimators_come_back_to_the_last_digit(configuration: int, symbol: str) -> None:
    """Line to 4, odd cubic to 10, v|v| to 18 degrees, all printed cells used."""
    sweep = fitted(f"suboff_roddy_{configuration}", doubtful=True).sweep(symbol)
    found = tuple(four_digits(plain(sweep, *which).value) for which in ESTIMATORS)
    assert found == PRINTED[configuration, symbol]


@pytest.mark.parametrize(("configuration", "symbol"), PRINTED)
def test_single_estimators_without_doubtful_cells(configuration: int, symbol: str) -> None:
    sweep = fitted(f"suboff_roddy_{configuration}").sweep(symbol)
    for (nominal, family), printed in zip(ESTIMATORS, PRINTED[configuration, symbol], strict=True):
        wanted = WITHOUT_DOUBTFUL.get((configuration, symbol, nominal), (printed, ""))[0]
        assert four_digits(plain(sweep, nominal, family).value) == wanted


@pytest.mark.parametrize(("key", "point"), [(key, point) for key, (_, point) in WITHOUT_DOUBTFUL.items()])
def test_the_cells_named_for_the_difference_are_the_ones_left_out(key: tuple[int, str, float], point: str) -> None:
    configuration, symbol, nominal = key
    sweep = fitted(f"suboff_roddy_{configuration}").sweep(symbol)
    limit = np.sin(np.radians(nominal + 0.15))
    assert [e.label for e in sweep.left_out if abs(e.x) <= limit and "uncertain" in e.reason] == [point]


@pytest.mark.parametrize(("configuration", "symbol"), RECOMMENDED)
def test_recommended_is_the_calibrated_slope_of_all_points(configuration: int, symbol: str) -> None:
    """No frozen number: SUBOFF is not what the method is tuned to."""
    result = fitted(f"suboff_roddy_{configuration}")
    c, sweep = result.coefficients[symbol], result.sweep(symbol)
    model = estimate(sweep.x, sweep.y, sweep.se)
    assert (c.value, c.u95, c.status) == (model.value, model.u95, Status.OK)
    assert c.window == pytest.approx((np.arcsin(sweep.x.min()), np.arcsin(sweep.x.max())))
    assert c.parts.random is not None
    assert c.parts.model_form is not None
    assert c.u95 == pytest.approx(np.hypot(c.parts.random, c.parts.model_form))


@pytest.mark.parametrize("campaign", ["suboff_roddy_1", "suboff_roddy_2", "suboff_roddy_3", "suboff_cfd_barehull"])
def test_covariance_is_symmetric_positive_and_has_the_u95(campaign: str) -> None:
    result = fitted(campaign).coefficients
    known = np.array([c.u95 is not None for c in result.coefficients])
    covariance = result.covariance[np.ix_(known, known)]
    assert known.sum() >= 4
    np.testing.assert_array_equal(covariance, covariance.T)
    deviation = np.sqrt(np.diag(covariance))
    np.testing.assert_allclose(2.0 * deviation, [c.u95 for c in result.coefficients if c.u95 is not None])
    assert np.linalg.eigvalsh(covariance / np.outer(deviation, deviation)).min() > -1e-12
    assert np.all(np.isnan(result.covariance[~known]))


def test_coefficients_of_one_table_are_correlated_although_each_leaves_out_a_cell() -> None:
    """Y leaves out point 80 and N point 96; the noise of the other rows still moves both."""
    result = fitted("suboff_roddy_2")
    y, n = result.sweep("Yv"), result.sweep("Nv")
    assert set(y.labels) ^ set(n.labels) == {"80", "96"}
    i, j = (result.coefficients.symbols.index(s) for s in ("Yv", "Nv"))
    assert result.coefficients.covariance[i, j] != 0.0


def test_the_shares_of_rows_are_those_of_the_mixture() -> None:
    """A constant and a line are followed exactly, and the shares of the readings add up to the mixture's mean."""
    x = np.sin(np.radians(np.linspace(-16.0, 14.0, 16)))
    y = -1e-3 + 2e-3 * x + 0.02 * x**2 + 1e-4 * np.random.default_rng(2).standard_normal(16)
    here = estimate(x, y)
    rest, slope = (slopes.by_row(here, term) for term in (0, 1))
    assert here.design is not None
    assert [rest.sum(), rest @ x, slope.sum(), slope @ x] == pytest.approx([1.0, 0.0, 0.0, 1.0], abs=1e-8)
    assert slope @ y == pytest.approx(estimate_many(here.design, y, deletions=False).mean[0], rel=1e-9)


@pytest.mark.slow
def test_same_input_same_result() -> None:
    used = tables("suboff_roddy_2")
    fit = FITS.load("slope_at_origin").fit
    one, two = (fit(used, used[0].scaling, {}) for _ in range(2))
    assert one.coefficients.coefficients == two.coefficients.coefficients
    np.testing.assert_array_equal(one.coefficients.covariance, two.coefficients.covariance)


@pytest.mark.parametrize(("configuration", "force", "moment", "side"), [(1, "Zw", "Mw", 1.0), (3, "Yv", "Nv", -1.0)])
def test_estimators_about_another_point_are_the_transferred_ones(
    configuration: int, force: str, moment: str, side: float
) -> None:
    """N about a point dx ahead is N - dx Y, M is M + dx Z; a fit of one form is linear in the data."""
    campaign, dx = f"suboff_roddy_{configuration}", 0.7
    length = tables(campaign)[0].scaling.length
    here, there = fitted(campaign, doubtful=True), fitted(campaign, doubtful=True, shift=dx)
    for which in ESTIMATORS:
        f, m = (plain(here.sweep(s), *which) for s in (force, moment))
        assert plain(there.sweep(force), *which).value == pytest.approx(f.value, rel=1e-11)
        wanted = m.value + side * dx / length * f.value
        assert plain(there.sweep(moment), *which).value == pytest.approx(wanted, rel=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("configuration", [1, 2, 3])
def test_recommended_values_about_another_point_agree_within_their_u95(configuration: int) -> None:
    """The mixture weighs forms anew for another moment, so the two ways differ by less than they claim to know."""
    campaign, dx = f"suboff_roddy_{configuration}", 0.2
    here, there = fitted(campaign, shift=0.0), fitted(campaign, shift=dx)
    moved = here.coefficients.about(here.coefficients.reference_point + np.array([dx, 0.0, 0.0]))
    force, moment = ("Zw", "Mw") if configuration == 1 else ("Yv", "Nv")
    assert moved[force].value == here.coefficients[force].value
    assert there.coefficients[force].value == pytest.approx(moved[force].value, rel=1e-10)
    a, b = moved[moment], there.coefficients[moment]
    assert a.value is not None
    assert a.u95 is not None
    assert b.value == pytest.approx(a.value, abs=a.u95)
    assert a.value != here.coefficients[moment].value


def test_a_capped_sweep_is_a_fit_with_that_largest_angle() -> None:
    used = tables("suboff_roddy_1")
    ten = FITS.load("slope_at_origin").fit(used, used[0].scaling, {"largest_angle": 10.0})
    capped = {round(float(np.degrees(np.arcsin(s.cap)))): s for s in fitted("suboff_roddy_1").sweep("Zw").sensitivity}
    assert set(capped) == {10, 12, 18}
    assert ten.coefficients["Zw"].value == capped[10].value
    assert ten.coefficients["Zw"].u95 == capped[10].u95


def test_excluded_cells_are_shown_with_their_reason() -> None:
    left = fitted("suboff_roddy_1").sweep("Zw").left_out
    assert {e.label for e in left} == {"20"}
    assert all(e.reason and np.isfinite(e.y) for e in left)
    assert fitted("suboff_roddy_1", doubtful=True).sweep("Zw").left_out == ()


def planted(table: ForceTable, **primes: dict[str, float]) -> ForceTable:
    """The table's own settings with exact forces: Y' = sum of coefficient times product of motions; "1" is a bias."""
    length, forces = table.scaling.length, dict(table.forces)
    for component in forces:
        total = np.zeros(len(table))
        for factors, value in primes.get(component, {}).items():
            names = [f for f in factors.split() if f != "1"]
            total += value * np.prod([table.primed_motion(f, length) for f in names] or [np.ones(len(table))], axis=0)
        forces[component] = (
            total * 0.5 * table.conditions.density * table.speed**2 * length ** (2 + (component in "KMN"))
        )
    return replace(table, forces=forces)


def test_planted_static_and_control_derivatives_come_back_at_the_real_settings() -> None:
    """Rudder runs were made at up to 0.21 degrees of drift; the static slope takes that out, all but its cubic part."""
    (real,) = tables("suboff_roddy_2")
    made = planted(
        real,
        X={"1": -1.3e-3, "v v": 6e-3},
        Y={"1": -1e-4, "v": -0.028, "v v v": -0.2, "dr": 0.0059},
        N={"1": 9e-5, "v": -0.0137, "v v v": 0.05, "dr": -0.0022},
        K={"1": 9e-6, "v": -6e-4},
    )
    found = FITS.load("slope_at_origin").fit([made], made.scaling, {})
    wanted = {
        "Yv": -0.028, "Nv": -0.0137, "Kv": -6e-4, "X0": -1.3e-3, "Xvv": 6e-3, "Ydr": 0.0059, "Ndr": -0.0022, "Kdr": 0.0,
    }  # fmt: skip
    assert set(found.coefficients.symbols) == set(wanted)
    for symbol, value in wanted.items():
        assert found.coefficients[symbol].value == pytest.approx(
            value, rel=1e-6, abs=2e-8 if symbol.endswith("dr") else 0.0
        ), symbol
    assert "Yv' v'" in found.sweep("Ydr").offset


def arm() -> tuple[ForceTable, ForceTable]:
    drift, rotating = tables("suboff_cfd_barehull")
    forces = {"Y": {"v": -0.0065, "r": 0.0007}, "N": {"v": -0.0138, "r": -0.0009}}
    return planted(drift, **forces), planted(rotating, **forces)


def test_planted_rotary_derivatives_come_back_from_a_rotating_arm() -> None:
    both = arm()
    found = FITS.load("slope_at_origin").fit(both, both[0].scaling, {}).coefficients
    for symbol, value in {"Yv": -0.0065, "Nv": -0.0138, "Yr": 0.0007, "Nr": -0.0009}.items():
        assert found[symbol].value == pytest.approx(value, rel=1e-6)


def test_the_window_of_a_force_at_rest_is_in_the_unit_of_its_sweep() -> None:
    """X0' of a rotating arm had "5.73 .. 34.4 deg" for r' of 0.1 to 0.6."""
    for table, rate in zip(tables("suboff_cfd_barehull"), (False, True), strict=True):
        made = planted(table, X={"1": -1e-3})
        c = FITS.load("slope_at_origin").fit([made], made.scaling, {}).coefficients["X0"]
        assert c.window_is_rate is rate
        assert window_text(c).endswith(" deg") is not rate


def test_planted_rotary_derivatives_come_back_about_another_point() -> None:
    both, dx = arm(), 0.3
    length = both[0].scaling.length
    moved = [t.about(t.reference_point + np.array([dx, 0.0, 0.0])) for t in both]
    found = FITS.load("slope_at_origin").fit(moved, both[0].scaling, {}).coefficients
    k = dx / length
    assert found["Nv"].value == pytest.approx(-0.0138 + k * 0.0065, rel=1e-6)
    assert found["Yr"].value == pytest.approx(0.0007 + k * 0.0065, rel=1e-6)
    rounding = 3e-8 * 0.0138  # of the largest part that is moved
    assert found["Nr"].value == pytest.approx(-0.0009 - k * (-0.0138 + 0.0007) + k**2 * -0.0065, abs=rounding)


ANGLES = [-18.0, -15.0, -12.0, -9.0, -6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0, 9.0, 12.0, 15.0, 18.0]


def swept(angles: list[float], change: dict[int, float] | None = None, se: bool = False, noise: float = 1e-4) -> Study:
    """Yv' = -0.03 with v|v|; some rows times a factor."""
    table = small_table(angles, errors=se)
    v = np.sin(np.radians(angles))
    y = 1e-4 - 0.03 * v - 0.06 * v * np.abs(v) + noise * np.random.default_rng(4).standard_normal(len(v))
    for row, factor in (change or {}).items():
        y[row] *= factor
    force = 0.5 * 1000.0 * 1.5**2 * 4.0 * y
    used = {"Y": np.ones(len(v), dtype=bool)}
    table = replace(table, forces={"Y": force}, usable=used, exclusions=())
    return replace(small_study(ANGLES), fits=(slope_at_origin.fit([table], LENGTH, {}),), tables=(table,))


def warnings(study: Study) -> list[Check]:
    return [c for c in coverage.check(study) if c.severity is Severity.WARN]


def test_a_wrong_point_is_left_out_and_the_value_with_it_is_kept() -> None:
    """The gate for data makes the warning of it: tests/study/test_data_gate.py."""
    clean, wrong = swept(ANGLES), swept(ANGLES, {9: 3.0})
    before, after = (s.fits[0].sweep("Yv") for s in (clean, wrong))
    assert list(after.wrong) == [9]
    assert after.value == pytest.approx(before.value, abs=before.u95)
    assert abs(after.with_all - after.value) > after.u95
    assert "without point tow 9" in wrong.fits[0].coefficients["Yv"].estimator


def test_pasted_rows_are_no_gain() -> None:
    once, pasted = swept(ANGLES), swept(ANGLES)
    (table,) = once.tables
    again = np.tile(np.arange(len(ANGLES)), 3)
    motion = {m: a[again] for m, a in table.motion.items()}
    table = replace(
        table, motion=motion, speed=table.speed[again], forces={"Y": table.forces["Y"][again]},
        usable={"Y": np.ones(len(again), dtype=bool)}, labels=tuple(f"tow {i}" for i in range(len(again))),
    )  # fmt: skip
    pasted = replace(pasted, fits=(slope_at_origin.fit([table], LENGTH, {}),), tables=(table,))
    a, b = (s.fits[0].coefficients["Yv"] for s in (once, pasted))
    assert (b.u95, b.n_points) == (pytest.approx(a.u95), len(ANGLES))


@pytest.mark.parametrize("one_sided", [False, True])
def test_a_sweep_of_two_degrees_gives_a_value_with_its_u95(one_sided: bool) -> None:
    angles = list(np.linspace(0.0 if one_sided else -2.0, 2.0, 9))
    c = swept(angles, noise=1e-5).fits[0].coefficients["Yv"]
    assert abs(c.value + 0.03) < 2.0 * c.u95 < 0.03


def test_too_few_settings_and_an_open_sign_are_statuses_with_a_text() -> None:
    few = swept([0.0, 5.0, 5.0])
    c = few.fits[0].coefficients["Yv"]
    assert (c.value, c.u95, c.status) == (None, None, Status.TOO_FEW_POINTS)
    assert "2 different settings, at least 3 are needed" in warnings(few)[0].statistic
    noisy = swept(ANGLES, noise=0.02)
    c = noisy.fits[0].coefficients["Yv"]
    assert c.status is Status.SIGN_OPEN
    assert abs(c.value) <= c.u95
    (found,) = significance.check(noisy)
    assert (found.severity, "sign is open" in found.comment) == (Severity.WARN, True)


def test_stated_standard_errors_weigh() -> None:
    """A row that states a hundred times the error of the others may lie anywhere."""
    study = swept(ANGLES, se=True)
    (table,) = study.tables
    error = table.errors["Y"].copy()
    error[9] *= 100.0
    force = table.forces["Y"].copy()
    force[9] *= 3.0
    loose = slope_at_origin.fit([replace(table, forces={"Y": force}, errors={"Y": error})], LENGTH, {})
    clean = study.fits[0].coefficients["Yv"]
    assert clean.u95 is not None
    assert loose.coefficients["Yv"].value == pytest.approx(clean.value, abs=clean.u95)
    assert not len(loose.sweep("Yv").wrong)


def test_an_angle_filter_names_what_it_leaves_out() -> None:
    (table,) = swept(ANGLES).tables
    sweep = slope_at_origin.fit([table], LENGTH, {"largest_angle": 9.0}).sweep("Yv")
    assert len(sweep.x) == 9
    assert {p.reason for p in sweep.left_out} == {"beyond largest_angle"}


def turning(rates: list[float], speeds: list[float]) -> ForceTable:
    """A table of an arm: forces linear and quadratic in the rate, at rates of so many r' and speeds."""
    straight = small_table([0.0] * len(rates))
    speed, primes = np.array(speeds), np.array(rates)
    q = 0.5 * straight.conditions.density * speed**2 * LENGTH.length**2
    forces = {
        "X": q * (-0.003 - 0.002 * primes**2),
        "Y": q * (0.004 * primes + 0.01 * primes * np.abs(primes)),
        "N": q * LENGTH.length * (-0.005 * primes - 0.004 * primes * np.abs(primes)),
    }
    still = dict.fromkeys("vwpq", np.zeros(len(rates)))
    return replace(
        straight,
        motion={**still, "u": speed, "r": primes * speed / LENGTH.length},
        speed=speed,
        forces=forces,
        usable={c: np.ones(len(rates), dtype=bool) for c in forces},
        exclusions=(),
    )


@pytest.mark.parametrize("signs", [[1.0], [1.0, -1.0], [1.0, -1.0, 0.0]], ids=["one side", "both sides", "with rest"])
def test_one_radius_gives_no_slope_whatever_the_speeds_and_sides(signs: list[float]) -> None:
    """Y' at r' = -a, 0, a is one number of the odd part: a line, r'|r'| and any mixture go through it."""
    rates = [0.3 * s for s in signs for _ in range(3)]
    table = turning(rates, [1.0, 2.0, 3.0] * len(signs))
    found = FITS.load("slope_at_origin").fit([table], LENGTH, {})
    for symbol in ("Yr", "Nr", "Xrr"):
        c = found.coefficients[symbol]
        assert (c.value, c.u95, c.status) == (None, None, Status.NOT_DETERMINED)
        where = "speeds 1 to 3 m/s, both signs" if len(signs) > 1 else "speeds 1 to 3 m/s"
        assert c.estimator.startswith(f"one |r'|, 0.3 ({where}): ")
        assert c.estimator.endswith("measure |r'| near 0.1 and 0.2 (L/R: other radii, not speeds)")
    lines = [e for e in found.sweep("Yr").forms if e.family.name == LINE]
    assert [round(e.value, 9) for e in lines] == ([] if len(signs) == 1 else [0.004 + 0.01 * 0.3])
    tied = FITS.load("tied_law").fit([table], LENGTH, {})
    assert not any(c.symbol.startswith(("Yr", "Nr")) for c in tied.coefficients.coefficients)


def test_two_radii_give_the_slope() -> None:
    both = [0.3, 0.302, 0.298, -0.3, 0.15, -0.15, 0.0]
    found = FITS.load("slope_at_origin").fit([turning(both, [2.0] * len(both))], LENGTH, {})
    c = found.coefficients["Yr"]
    assert abs(c.value - 0.004) < c.u95
    scatter = FITS.load("slope_at_origin").fit([turning(both[:4], [2.0] * 4)], LENGTH, {})
    assert scatter.coefficients["Yr"].status is Status.NOT_DETERMINED


@pytest.mark.parametrize(
    ("name", "options"),
    [("manoeuvring_model", {}), ("polynomial", {"variable": "r", "degree": 1}), ("sparse", {"folds": 2})],
)
def test_a_fixed_form_over_one_radius_shows_a_secant_and_recommends_nothing(
    name: str, options: dict[str, object]
) -> None:
    arm = replace(turning([0.3, -0.3] * 3, [1.0, 1.0, 2.0, 2.0, 3.0, 3.0]), name="tow/arm.csv")
    drift = small_table([-12.0, -10.0, -8.0, -6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0])
    found = FITS.load(name).fit([drift, arm], LENGTH, options)
    c = found.coefficients["Yr"]
    assert (c.value, c.u95, c.status) == (None, None, Status.NOT_DETERMINED)
    assert "all rows that turn have one |r'|, 0.3" in c.estimator
    model = next(m for m in found.models if m.response.removesuffix("'") == "Y")
    shown = next(s for s in model.symbols if s.startswith("Yr"))
    assert model.named(shown)[0] == pytest.approx(0.004 + 0.01 * 0.3, rel=1e-3)
    assert sum("(a secant) and is not determined" in s for s in model.statements) == 1


@pytest.mark.parametrize(
    ("left", "corner", "right"), [(-0.3, 0.01, 0.3), (0.6, 0.012, 0.5), (-1.5, 0.015, -2.0), (-1.8, 0.01, 0.3)]
)
def test_a_kink_beside_rest_widens_the_interval(left: float, corner: float, right: float) -> None:
    """Synthetic laminar bubble, corners within a degree of rest: U95 of the whole sweep passed the slope of -1.1 by."""
    degrees = np.arange(-7.4, 9.95, 0.1)
    v = np.sin(np.radians(degrees))
    y = -1.1 * np.clip(v, -corner, corner) + left * np.minimum(v + corner, 0.0) + right * np.maximum(v - corner, 0.0)
    y += np.random.default_rng(4).normal(0.0, 2e-4, len(v))
    table = small_table(degrees.tolist())
    size = 0.5 * 1000.0 * float(table.speed[0]) ** 2 * LENGTH.length**2
    table = replace(
        table, forces={"Y": size * y}, usable={"Y": np.ones(len(v), dtype=bool)}, exclusions=(), density=1000.0
    )
    fitted = slope_at_origin.fit([table], LENGTH, {})
    found, alone = fitted.coefficients["Yv"], estimate(v, y)
    assert found.value == pytest.approx(alone.value, rel=1e-6)
    assert alone.u95 < abs(found.value + 1.1) <= found.u95
    assert moved_by_the_rest(fitted.sweep("Yv")) is not None, "a check names the shorter range"


@pytest.mark.parametrize("units", [1, 2, 3, 6])
def test_readings_of_a_few_units_of_the_last_digit_do_not_jump(units: int) -> None:
    """A sweep to 16 deg whose largest reading is some units of its last decimal; a quarter of a turn of digits was a jump."""
    x = np.radians(np.arange(-16.0, 17.0, 2.0))
    y = np.round(units * (x / x.max()) ** 2 * 1.04) * 1e-4
    assert slopes.before_jump(x, y) == (-np.inf, np.inf)


def test_a_gap_of_the_settings_is_no_jump() -> None:
    x = np.array([0.0, 1.0, 2.0, 3.0, 12.0, 15.0, 18.0])
    assert slopes.before_jump(x, x**3) == (-np.inf, np.inf)


def test_rows_beyond_a_jump_of_the_moment_are_left_out_of_the_moment_alone() -> None:
    """Synthetic listing whose moment lacks a part beyond 20 degrees while the force goes on: N' was 4 % off, at a U95 of 2 %."""
    degrees = [
        -16.0,
        -8.0,
        -6.0,
        -4.0,
        -2.0,
        0.0,
        2.0,
        4.0,
        8.0,
        9.0,
        10.0,
        12.0,
        14.0,
        16.0,
        18.0,
        19.0,
        20.0,
        21.0,
        22.0,
        24.0,
    ]
    v = np.sin(np.radians(degrees))
    table = small_table(degrees)
    size = 0.5 * 1000.0 * table.speed**2 * LENGTH.length**2
    forces = {
        "Y": -size * (4.0 * v - 3.0 * v**3),
        "N": -size * LENGTH.length * np.where(np.array(degrees) < 19.5, 2.2 * v + v**3, -0.01),
    }
    used = {c: np.ones(len(v), dtype=bool) for c in forces}
    table = replace(table, forces=forces, usable=used, exclusions=())
    fit = slope_at_origin.fit([table], LENGTH, {})
    assert fit.coefficients["Nv"].value == pytest.approx(-2.2, rel=0.005)
    assert [p.reason for p in fit.sweep("Nv").left_out] == [JUMPED] * 4
    assert not fit.sweep("Yv").left_out
    study = replace(small_study(ANGLES), fits=(fit,), tables=(table,))
    assert sum("beyond a jump" in str(c.statistic) for c in warnings(study)) == 1


def test_rows_past_a_stall_are_left_out_with_a_word() -> None:
    """Synthetic wing to 90 degrees: X0' is the drag at rest, and a check says how many rows are beyond."""
    degrees = np.arange(-90.0, 91.0, 5.0)
    angle, inside = np.radians(degrees), np.abs(degrees) <= 15.0
    lift = np.where(inside, 4.0 * np.sin(angle), np.sin(2.0 * angle))
    drag = 0.02 + np.where(inside, 0.0, 1.9) * np.sin(angle) ** 2
    table = small_table(degrees.tolist())
    table = replace(table, motion={**table.motion, "u": 1.5 * np.abs(np.cos(angle))})
    size = 0.5 * 1000.0 * 1.5**2 * LENGTH.length**2
    forces = {
        "Y": -size * (lift * np.cos(angle) + drag * np.sin(angle)),
        "X": size * (lift * np.sin(angle) - drag * np.cos(angle)),
    }
    used = {c: np.ones(len(angle), dtype=bool) for c in forces}
    table = replace(table, forces=forces, usable=used, exclusions=())
    fit = slope_at_origin.fit([table], LENGTH, {})
    assert fit.sweep("Yv").window == pytest.approx(np.radians([-15.0, 15.0]), abs=1e-6)
    assert STALLED in {p.reason for p in fit.sweep("X0").left_out}
    assert fit.coefficients["X0"].value == pytest.approx(-0.02, rel=0.05)
    assert fit.coefficients["Yv"].value == pytest.approx(-4.02, rel=0.02)
    study = replace(small_study(ANGLES), fits=(fit,), tables=(table,))
    assert sum("past stall" in str(c.statistic) for c in warnings(study)) == 1

"""The law of runs that turn about another point than the study's: curvatures and products move as the quadratic form that they are."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import coeflab as cf
from coeflab.fits.joint.moving import LEFT_OUT
from coeflab.fits.results.fit_result import FitResult, covariance_of
from coeflab.fits.tied_law import FEW_APART, ONE_RATIO
from coeflab.law.named_terms import read_term
from coeflab.law.scaling import Scaling
from coeflab.study.fitting import fitted, rejoined
from coeflab.tables.force_table import ForceTable
from coeflab.vehicle.law_at_points import measured_tables

LENGTH, DENSITY, SPEED = 5.0, 1000.0, 3.0
FORCE = 0.5 * DENSITY * SPEED**2 * LENGTH**2
PLANES = {"v": "r", "w": "q"}
RATES = np.array([-0.5, -0.4, -0.3, -0.2, 0.2, 0.3, 0.4, 0.5])
SINES = np.sin(np.radians(np.arange(-12.0, 13.0, 2.0)))
SHIFT = 0.4  # m, of the arm's point ahead of the study's
TRUTH = {
    "v": {"X0": -0.0014, "Xvv": 0.004, "Xvr": 0.010, "Xrr": 0.001, "Yv": -0.028, "Yv|v|": -0.07, "Yr": 0.006, "Yr|r|": 0.004},
    "w": {"X0": -0.0014, "Xww": 0.003, "Xwq": -0.012, "Xqq": 0.001, "Zw": -0.016, "Zw|w|": -0.05, "Zq": -0.006, "Zq|q|": -0.003},
}  # fmt: skip


def table(
    drift: str, along: np.ndarray, turning: np.ndarray, name: str, noise: float = 0.0, seed: int = 1
) -> ForceTable:
    """Rows about the study's point by the planted law; the point of no drift lies elsewhere."""
    rate, force, draw = PLANES[drift], "Y" if drift == "v" else "Z", np.random.default_rng(seed)
    columns = {
        "u [m/s]": SPEED * np.sqrt(1.0 - along**2),
        f"{drift} [m/s]": SPEED * along,
        f"{rate} [rad/s]": turning * SPEED / LENGTH,
    }
    for c in ("X", force):
        own = {s: k for s, k in TRUTH[drift].items() if s[0] == c}
        prime = sum(k * read_term(s, "truth").term.evaluate({drift: along, rate: turning}) for s, k in own.items())
        columns[f"{c} [N]"] = FORCE * (prime + noise * np.max(np.abs(prime)) * draw.standard_normal(len(along)))
    more: dict[str, Any] = {"contains_inertia": False, "arm_point": "nose, 2.5 m aft"} if np.any(turning) else {}
    return cf.read_table(
        columns, name=name, frame="FRD", about="nose, 2.5 m aft", length="5 m LOA", density=DENSITY, **more
    )


def arm(drift: str, angles: tuple[float, ...], name: str = "arm", **more: Any) -> ForceTable:
    """Rates about a point 0.4 m ahead, with drifts of it."""
    sign = -1.0 if drift == "v" else 1.0
    turning, own = (x.ravel() for x in np.meshgrid(RATES, np.sin(np.radians(angles))))
    return table(drift, own + sign * SHIFT / LENGTH * turning, turning, name, **more)


def swept(drift: str, name: str = "drift", **more: Any) -> ForceTable:
    return table(drift, SINES, np.zeros(len(SINES)), name, **more)


def one_campaign(*tables: ForceTable) -> list[ForceTable]:
    return [replace(t, campaign="tests", body="boat") for t in tables]


def laws(*campaigns: list[ForceTable]) -> dict[tuple[str, str], FitResult]:
    """Slopes and law of every campaign, by fit and campaign, as a study makes them."""
    fits, asked = list[FitResult](), list[tuple[str, list[ForceTable], Scaling, dict[str, Any]]]()
    for tables in campaigns:
        for name in ("slope_at_origin", "tied_law"):
            fits.append(fitted(name, tables, tables[0].scaling, {}, fits)[0])
            asked.append((name, tables, tables[0].scaling, {}))
    return {(f.fit, f.campaign): f for f in rejoined(fits, asked)}


@pytest.mark.parametrize("drift", ["v", "w"])
def test_rows_of_several_drifts_give_curvature_and_product(drift: str) -> None:
    found = laws(one_campaign(swept(drift), arm(drift, (-8.0, -4.0, 0.0, 4.0, 8.0))))
    law, slopes = found["tied_law", "tests"], found["slope_at_origin", "tests"]
    curvature, product = f"X{PLANES[drift] * 2}", f"X{drift}{PLANES[drift]}"
    assert slopes.coefficients[curvature].value is None
    for symbol in (curvature, product):
        assert law.coefficients[symbol].value == pytest.approx(TRUTH[drift][symbol], rel=1e-4)
    assert not [f for f in (*law.findings, *slopes.findings) if f.code in (LEFT_OUT, ONE_RATIO)]


@pytest.mark.parametrize("drift", ["v", "w"])
def test_runs_of_one_ratio_give_their_sum_and_say_so(drift: str) -> None:
    found = laws(one_campaign(swept(drift), arm(drift, (0.0,))))["tied_law", "tests"]
    rate, ratio = PLANES[drift], (-1.0 if drift == "v" else 1.0) * SHIFT / LENGTH
    truth, said = TRUTH[drift], next(f for f in found.findings if f.code == ONE_RATIO)
    assert said.statistic == pytest.approx(ratio)
    assert (said["product"], said["by"]) == (f"X{drift}{rate}'", "zero")
    wanted = truth[f"X{rate}{rate}"] + ratio * truth[f"X{drift}{rate}"]
    assert found.coefficients[f"X{rate}{rate}"].value == pytest.approx(wanted, rel=1e-4)


@pytest.mark.parametrize(("count", "is_known"), [(3, False), (5, True)])
def test_three_rows_beside_runs_of_one_ratio_give_no_u95(
    count: int, is_known: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A term that the law has not (X vvrr) moves the product by 3 to 50 %, and three rows leave nothing to see it by."""
    monkeypatch.setitem(TRUTH, "v", TRUTH["v"] | {"Xvvrr": 0.01})
    sines = np.sin(np.radians([-8.0, 4.0, 8.0, -4.0, 6.0]))[:count]
    few = table("v", sines, np.array([0.3, 0.4, 0.5, 0.2, 0.35])[:count], "combined", noise=1e-3)
    law = laws(one_campaign(swept("v", noise=1e-3), arm("v", (0.0,), noise=1e-3), few))["tied_law", "tests"]
    said = [f for f in law.findings if f.code == FEW_APART]
    product = law.coefficients["Xvr"]
    assert (product.u95 is not None) is is_known
    assert abs(product.value / 0.010 - 1.0) > 0.02
    if is_known:
        assert not said
    else:
        assert (said[0].statistic, law.coefficients["Xrr"].u95) == (count, None)


@pytest.mark.parametrize("first", ["drift", "arm"])
def test_the_law_of_an_arm_takes_the_drift_of_another_campaign(first: str) -> None:
    """Its slopes were moved by that campaign, and its law had no term in r at all."""
    drift = [replace(swept("v"), body="boat")]
    turning = [replace(arm("v", (0.0,)), body="boat")]
    found = laws(*((drift, turning) if first == "drift" else (turning, drift)))
    law, slopes = found["tied_law", "arm"], found["slope_at_origin", "arm"]
    assert slopes.coefficients["Yr"].value == pytest.approx(TRUTH["v"]["Yr"], rel=1e-2)
    assert law.coefficients["Yr|r|"].value == pytest.approx(TRUTH["v"]["Yr|r|"], rel=3e-2)
    assert "Xrr" in law.coefficients
    assert not [s for f in slopes.findings if f.code == LEFT_OUT for s in f["symbols"]]


def test_covariance_of_two_campaigns_is_that_of_random_numbers() -> None:
    drift = [replace(swept("v", noise=0.01), body="boat")]
    turning = [replace(arm("v", (0.0,), noise=0.01, seed=2), body="boat")]
    found = laws(drift, turning)
    covariance = covariance_of(list(found.values()))
    size = np.sqrt(np.diag(covariance))
    known = np.isfinite(size) & (size > 0.0)
    relative = covariance[np.ix_(known, known)] / np.outer(size[known], size[known])
    assert np.linalg.eigvalsh(relative)[0] > -1e-9
    f, g = found["tied_law", "arm"], found["slope_at_origin", "drift"]
    with_drift = next(s for s in f.shared if (s.fit, s.campaign) == (g.fit, g.campaign))
    assert np.any(with_drift.covariance[:, g.coefficients.symbols.index("Yv")] != 0.0)


def test_the_runs_of_the_arm_are_points_of_the_law() -> None:
    """They drift about the study's point, of which no coefficient fitted to them speaks: the law was held against none of them."""
    drift, turning = replace(swept("v"), body="boat"), replace(arm("v", (0.0,)), body="boat")
    fits = list(laws([drift], [turning]).values())
    spoken = {("Y", drift.name): frozenset("v"), ("Y", turning.name): frozenset("r")}
    found = measured_tables([drift, turning], fits, spoken, {}, frozenset(), LENGTH, DENSITY)
    assert [(t.table, len(t.labels)) for t in found] == [(drift.name, len(SINES)), (turning.name, len(RATES))]


def off_the_point(ahead: float) -> list[ForceTable]:
    """Drift, and combined rows whose U and angle hold at a point ``ahead`` of the study's, by a law of U at the study's."""
    own = {s: k for s, k in TRUTH["v"].items() if s in ("X0", "Xvv", "Xvr", "Yv", "Yr")} | {"Nv": -0.014, "Nr": -0.005}
    beta, turning = (x.ravel() for x in np.meshgrid(np.radians([-8.0, -4.0, 0.0, 4.0, 8.0]), RATES))
    r = turning * SPEED / LENGTH
    u, v = SPEED * np.cos(beta), SPEED * np.sin(beta) - ahead * r
    there = np.hypot(u, v)
    columns = {"U [m/s]": np.full(len(r), SPEED), "beta [deg]": np.degrees(beta), "r [rad/s]": r}
    moving = {"v": v / there, "r": r * LENGTH / there}
    still = {"v": SINES, "r": 0.0 * SINES}
    drift = {"U [m/s]": np.full(len(SINES), SPEED), "beta [deg]": np.degrees(np.arcsin(SINES))}
    for c, lever in (("X", 1.0), ("Y", 1.0), ("N", LENGTH)):
        for into, at, size in ((columns, moving, there), (drift, still, SPEED)):
            prime = sum(k * read_term(s, "truth").term.evaluate(at) for s, k in own.items() if s[0] == c)
            into[f"{c} [{'N*m' if c == 'N' else 'N'}]"] = FORCE * lever * (size / SPEED) ** 2 * prime
    more = {
        "frame": "FRD",
        "about": "nose, 2.5 m aft",
        "length": "5 m LOA",
        "density": DENSITY,
        "beta": "v = +U sin(beta)",
    }
    turned = cf.read_table(columns, name="arm", contains_inertia=False, arm_point=[ahead - 2.5, 0.0, 0.0], **more)
    return one_campaign(cf.read_table(drift, name="drift", **more), turned)


@pytest.mark.parametrize("ahead", [-1.0, 0.25])
def test_runs_are_primed_by_the_speed_of_the_point_that_the_law_is_about(ahead: float) -> None:
    """By U of the arm's point X0' x'^2 stands in Xrr', and a part of its order in Xvr'."""
    tables = off_the_point(ahead)
    law, slopes = (laws(tables)[name, "tests"].coefficients for name in ("tied_law", "slope_at_origin"))
    assert law["Xvr"].value == pytest.approx(TRUTH["v"]["Xvr"], rel=1e-6)
    curvature = [c.value for c in law.coefficients if c.symbol == "Xrr"]
    assert curvature == pytest.approx([0.0] * len(curvature), abs=1e-9)
    for symbol in ("Yr", "Nr"):
        got, truth = slopes[symbol], (TRUTH["v"] | {"Nr": -0.005})[symbol]
        assert abs(got.value - truth) <= got.u95

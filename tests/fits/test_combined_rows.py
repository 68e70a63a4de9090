"""Tables that combine motions: rows in which one alone moves give their slopes, the others are named, and nothing else is lost."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coeflab as cf
from coeflab.core.errors import InputError
from coeflab.fits.results.fit_result import covariance_of
from coeflab.fits.rows.sweeps import arm_shift
from coeflab.fits.rows.too_few import FEW_ROWS
from coeflab.study.fitting import fitted, rejoined
from coeflab.tables.force_table import ForceTable

LENGTH, DENSITY, SPEED = 5.0, 1000.0, 3.0
FORCE = 0.5 * DENSITY * SPEED**2 * LENGTH**2
PLANES = {"v": ("r", "Y", "N"), "w": ("q", "Z", "M")}
SLOPES = {
    "Yv": -0.028,
    "Nv": -0.013,
    "Yr": 0.006,
    "Nr": -0.0046,
    "Zw": -0.016,
    "Mw": 0.009,
    "Zq": -0.006,
    "Mq": -0.0035,
}
CUBIC = {"Y": 0.02, "N": -0.01, "Z": 0.015, "M": 0.01}  # of drift times rate squared
RATES = np.repeat([-0.5, -0.4, -0.3, -0.2, 0.2, 0.3, 0.4, 0.5], 5)
DRIFTS = np.tile(np.sin(np.radians([-8.0, -4.0, 0.0, 4.0, 8.0])), 8)


def table(drift: str, along: np.ndarray, turning: np.ndarray, name: str) -> ForceTable:
    """Drift v' or w' and rate about the point 2.45 m aft, by the planted slopes."""
    rate, force, moment = PLANES[drift]
    columns = {
        "u [m/s]": SPEED * np.sqrt(1.0 - along**2),
        f"{drift} [m/s]": SPEED * along,
        f"{rate} [rad/s]": turning * SPEED / LENGTH,
    }
    for c, unit, arm in ((force, "N", 1.0), (moment, "N m", LENGTH)):
        prime = SLOPES[c + drift] * along + SLOPES[c + rate] * turning + CUBIC[c] * along * turning**2
        columns[f"{c} [{unit}]"] = FORCE * arm * prime
    more = {"contains_inertia": False, "arm_point": "nose, 2.45 m aft"} if np.any(turning) else {}
    return cf.read_table(
        columns, name=name, frame="FRD", about="nose, 2.45 m aft", length="5 m LOA", density=DENSITY, **more
    )  # fmt: skip


def combined(drift: str) -> ForceTable:
    return table(drift, DRIFTS, RATES, "arm")


def swept(drift: str) -> ForceTable:
    return table(drift, np.sin(np.radians(np.arange(-12.0, 13.0, 3.0))), np.zeros(9), "drift")


@pytest.mark.parametrize("drift", ["v", "w"])
def test_rows_at_no_drift_give_the_slopes_of_the_rate(drift: str) -> None:
    """It was refused for want of a drift sweep: none of the 32 combined rows has one."""
    rate, *components = PLANES[drift]
    result = cf.fit(combined(drift))
    for c in components:
        found = result[c + rate]
        assert found.n_points == 8
        assert found.value == pytest.approx(SLOPES[c + rate], rel=1e-6)
        assert result[c + drift].status == "too_few_points"
    few = next(f for f in result.fits[0].findings if f.code == FEW_ROWS)
    assert (few.statistic, few["variable"], few["combined"], few.advice) == (0, f"{drift}'", 32, "manoeuvring_model")
    assert "manoeuvring_model" in str(result.summary())


@pytest.mark.parametrize("drift", ["v", "w"])
@pytest.mark.parametrize("shift", [0.05, -0.4])
def test_a_drift_table_takes_the_rates_to_another_point(drift: str, shift: float) -> None:
    """The point where the arm's runs do not drift is found among combined rows too; the tables name no body."""
    rate, force, moment = PLANES[drift]
    to = np.array([-2.45 - shift, 0.0, 0.0])
    arm = combined(drift).about(to)
    assert arm_shift([arm]) == pytest.approx(shift)
    result, dx, sign = cf.fit([swept(drift).about(to), arm]), -shift / LENGTH, 1.0 if drift == "v" else -1.0
    yv, nv, yr, nr = (SLOPES[s] for s in (force + drift, moment + drift, force + rate, moment + rate))
    assert result[force + rate].value == pytest.approx(yr - sign * dx * yv, rel=1e-5)
    assert result[moment + rate].value == pytest.approx(nr - sign * dx * (nv + yr) + dx * dx * yv, rel=1e-5)
    assert result[force + drift].value == pytest.approx(yv, rel=1e-5)
    alone = cf.fit(arm)
    assert alone[force + rate].status == "not_determined"


def test_the_own_point_stays_where_as_many_rates_are_run_about_it() -> None:
    arm = combined("v")
    assert arm_shift([arm]) == 0.0
    some = replace(arm, motion={**arm.motion, "v": 0.1 * arm.motion["r"] * (np.arange(40) % 5 == 4) + arm.motion["v"]})
    assert arm_shift([some]) == 0.0
    two = np.isin(np.abs(RATES), (0.2, 0.5)) & (RATES > 0.0)  # two rates about a point 0.2 m forward: no slope
    few = replace(arm, motion={**arm.motion, "v": np.where(two, 0.2, 0.3 + 0.1 * np.arange(40)) * arm.motion["r"]})
    assert arm_shift([few]) == 0.0


@pytest.mark.parametrize("alone", ["v", "r", "dr"])
def test_one_short_sweep_leaves_the_others_their_slopes(alone: str) -> None:
    """Of a campaign with two rows of one sweep nothing was fitted."""
    n = np.arange(9) - 4.0
    unit = {"v": 0.1, "r": 0.06, "dr": 0.05}
    rest = {m: np.zeros(14) for m in unit}
    for k, m in enumerate(m for m in unit if m != alone):
        at = slice(6 * k, 6 * k + 6)
        rest[m][at] = unit[m] * np.array([-3.0, -2.0, -1.0, 1.0, 2.0, 3.0])
    rest[alone][12:] = unit[alone] * n[[1, 7]]
    given = {f"{m} [{'m/s' if m == 'v' else 'rad' if m == 'dr' else 'rad/s'}]": x for m, x in rest.items()}
    force = {
        c: FORCE * sum(at * x / np.max(np.abs(x)) for x, at in zip(rest.values(), (-0.01, k, 0.01), strict=True))
        for c, k in (("Y", 0.01), ("N", -0.01))
    }
    mixed = cf.read_table(
        {"u [m/s]": np.full(14, 3.0), **given, "Y [N]": force["Y"], "N [N m]": force["N"]}, name="mixed", frame="FRD", about="nose, 2.45 m aft",
        length="5 m LOA", density=DENSITY, contains_inertia=False, arm_point="nose, 2.45 m aft",
    )  # fmt: skip
    result = cf.fit(mixed)
    without = {s.rstrip("'")[1:] for s, c in result.items() if c.value is None}
    assert without == {alone}
    few = [f for f in result.fits[0].findings if f.code == FEW_ROWS]
    assert [(f["variable"], f.statistic, len(f["rows"])) for f in few] == [(f"{alone}'", 2, 2)]


def test_nothing_at_all_is_still_refused() -> None:
    with pytest.raises(InputError, match=r"2 usable points of the sweep over v'.*at least 3"):
        cf.fit(table("v", np.array([-0.1, 0.1]), np.zeros(2), "drift"))


def test_a_law_tied_to_moved_slopes_has_a_covariance_of_random_numbers() -> None:
    """Slopes were moved once more beside the law tied to them: an eigenvalue of -0.07, which `uncertainty` refused."""
    to = np.array([-2.5, 0.0, 0.0])
    rng = np.random.default_rng(5)

    def read(t: ForceTable) -> ForceTable:
        noisy = {c: x + 0.01 * np.max(np.abs(x)) * rng.standard_normal(len(x)) for c, x in t.forces.items()}
        both = {**noisy, "X": -0.0014 * FORCE + 1e-5 * FORCE * rng.standard_normal(len(t))}
        return replace(
            t, campaign="one", forces=both, usable=dict.fromkeys(both, np.ones(len(t), dtype=bool))
        ).about(to)  # fmt: skip

    tables = [read(swept("v")), read(combined("v"))]
    scaling = tables[0].scaling
    slopes, _ = fitted("slope_at_origin", tables, scaling, {})
    law, _ = fitted("tied_law", tables, scaling, {}, [slopes])
    assert (
        slopes.coefficients["Xrr"].value is None
    )  # what no move brings to the point, so that the slopes are joined again
    fits = rejoined([slopes, law], [("slope_at_origin", tables, scaling, {}), ("tied_law", tables, scaling, {})])
    covariance = covariance_of(fits)
    size = np.sqrt(np.diag(covariance))
    known = np.isfinite(size) & (size > 0.0)
    relative = covariance[np.ix_(known, known)] / np.outer(size[known], size[known])
    assert np.count_nonzero(np.tril(relative, -1)) > 5
    assert np.linalg.eigvalsh(relative)[0] > -1e-9

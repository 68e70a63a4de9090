"""HUUV: every number of the acceptance, what is not identifiable, errata and figures."""

from __future__ import annotations

import json
from collections.abc import Callable

import numpy as np
import pytest

from coeflab.cli import show
from coeflab.identify.output_error import estimate
from coeflab.identify.tuning import OPEN, SIGN
from coeflab.published.huuv.acceptance import acceptance
from coeflab.published.huuv.model import read_huuv
from coeflab.published.huuv.tuning import BASE, ERRORS, FREE, NAMES, hidden, predicted, start_of, tuned, turning_problem
from coeflab.report.acceptance import Acceptance
from coeflab.report.as_json import studies as as_json

# Steady turns of the constants, worked out independently: commands, u, |beta|, R.
POINTS = {
    "0, 60 %": (0.4778, 20.572, 0.6195), "20, 60 %": (0.5442, 17.044, 0.8000), "30, 60 %": (0.6466, 11.780, 1.2577),
    "40, 60 %": (0.7311, 7.451, 2.0869), "0, 100 %": (0.6537, 20.572, 0.6195), "40, 100 %": (0.8580, 12.776, 1.1437),
    "60, 60 %": (0.8541, 0.0, None), "100, 100 %": (1.1686, 0.0, None),
}  # fmt: skip
SLOW = pytest.mark.slow


@pytest.fixture(scope="module")
def found(publication: Callable[[str], Acceptance]) -> Acceptance:
    return publication("huuv")


@SLOW
def test_everything_holds(found: Acceptance) -> None:
    assert [t.key for t in found.tables if not t.holds] == []
    assert [t.key for t in found.tables] == [
        "steady_turns", "through_file", "sides", "coriolis", "equations", "thrusters", "bounds", "simulated", "origin", "tuned_matlab",
        "tuned_tracker", "out_of_sample", "hidden", "five_dof_forces", "five_dof_geometry",
        "five_dof_straight", "five_dof_dives", "five_dof_turns",
    ]  # fmt: skip
    assert len(found.errata) == 10
    assert {r.basis for t in found.tables for r in t.rows} == {"calibration", "consistency"}
    assert list(found.counts.values()) == [0, 0, 0, 6, 113]
    assert len(found.repeated) == 68  # 25 numbers of steady turns two more ways, 18 with heave and pitch
    assert "m_x and m_y are chosen here" in next(t for t in found.tables if t.key == "equations").statements[0]
    assert found.citations == ("huuv2025",)
    assert [p.name for p in found.parameter_files] == ["huuv", "huuv_5dof"]
    assert sum(text.startswith("Cannot be made.") for text in found.statements) == 4


@SLOW
@pytest.mark.parametrize("key", ["steady_turns", "simulated", "through_file"])
def test_operating_points_by_three_ways(found: Acceptance, key: str) -> None:
    (table,) = (t for t in found.tables if t.key == key)
    rows = {(r.case, r.quantity): r for r in table.rows}
    for case, (u, beta, radius) in POINTS.items():
        assert rows[case, "u"].found == pytest.approx(u, rel=1e-3)
        assert rows[case, "|beta|"].found == pytest.approx(beta, rel=1e-3, abs=1e-9)
        if radius is None:
            assert rows[case, "|r|"].found == pytest.approx(0.0, abs=1e-9)
        else:
            assert rows[case, "R"].found == pytest.approx(radius, rel=1e-3)
    assert rows["0, 60 %", "|r|"].found == pytest.approx(0.8238, rel=1e-3)


@SLOW
def test_both_halves_reach_what_was_found_independently() -> None:
    huuv = read_huuv()
    matlab, tracker = tuned(huuv, "matlab"), tuned(huuv, "tracker")
    assert matlab.converged
    assert tracker.converged
    for name, most in (("u", 0.007), ("beta", 0.40), ("radius", 0.027)):
        assert matlab.quantity(name).rms() <= most
    assert 2.15 <= -matlab.parameter("intercept").after <= 2.45
    for name, about in (("u", 0.063), ("beta", 1.1), ("radius", 0.14)):
        assert tracker.quantity(name).rms() == pytest.approx(about, rel=0.1)
    assert [p.name for p in matlab.parameters if p.status == OPEN] == ["n3", "nrr"]
    assert all((p.u95 is None) == (p.status == OPEN) for p in (*matlab.parameters, *tracker.parameters))
    assert len(matlab.together) == 1
    for words in ("beta^3", "r|r|", "only together"):
        assert words in matlab.together[0]
    assert matlab.correlation[FREE.index("s1"), FREE.index("s3")] == pytest.approx(-0.9, abs=0.05)
    assert np.isnan(matlab.correlation[FREE.index("n3")]).all()


def test_twelve_turns_are_predicted_from_the_other_sixteen() -> None:
    """The limits are those of an independent fit; where the fit starts, and so what the shipped constants have seen, has no effect."""
    huuv = read_huuv()
    errors = predicted(huuv, "matlab")
    assert errors.shape == (12, 3)
    rms = np.sqrt(np.mean(errors**2, axis=0))
    assert np.all(rms <= [0.011, 0.79, 0.049])
    assert rms == pytest.approx([0.011, 0.79, 0.049], rel=0.05)
    start = start_of(huuv)
    start[[NAMES.index(n) for n in BASE]] *= 0.7
    assert predicted(huuv, "matlab", start) == pytest.approx(errors, abs=2e-4)


@SLOW
def test_a_value_whose_interval_holds_zero_is_not_determined() -> None:
    """Before: "n1: 3.3 +- 7.0 kg (determined)", and rate terms that drive the turn were determined yaw damping."""
    huuv = read_huuv()
    matlab, tracker = tuned(huuv, "matlab"), tuned(huuv, "tracker")
    n1 = tracker.parameter("n1")
    assert (n1.after, n1.u95) == pytest.approx((3.3, 7.0), abs=0.1)
    assert (n1.status, tracker.parameter("nr").status) == (SIGN, SIGN)
    for fit in (matlab, tracker):
        for p in fit.parameters:
            assert (p.status == SIGN) == (p.u95 is not None and abs(p.after) <= p.u95), p.name
    assert matlab.parameter("nr").after + matlab.parameter("nr").u95 < 0.0  # taken off in the equations: it drives
    assert sum("drives what it is called to damp" in s for s in matlab.statements) == 1
    assert sum("no damping is determined" in s for s in matlab.statements) == 1
    assert not any("along the motion" in s for s in tracker.statements)


def test_the_slope_of_the_yaw_moment_is_known_only_beside_the_added_masses_that_were_chosen() -> None:
    """n1 - (m_y - m_x) is what the turns show: with 3 kg more of m_y, n1 is 3 kg more, and the turns are the same."""
    huuv = read_huuv()
    start = start_of(huuv)
    moved = start.copy()
    moved[NAMES.index("my")] += 3.0
    fits = []
    for begin in (start, moved):
        p = turning_problem(huuv, huuv.turns["matlab"], ERRORS["matlab"], BASE, begin)
        found = estimate(p)
        fits.append((found.parameters[BASE.index("n1")], p.outputs(found.parameters)))
    (first, turns), (second, others) = fits
    assert second - first == pytest.approx(3.0, abs=0.05)
    np.testing.assert_allclose(others, turns, atol=2e-3)


def test_the_constants_are_the_fit_of_seven_to_the_matlab_half() -> None:
    huuv = read_huuv()
    fit = tuned(huuv, "matlab", BASE)
    for name in BASE:
        assert fit.parameter(name).after == pytest.approx(huuv.constants[name], rel=3e-4)
    assert not any(p.status == OPEN for p in fit.parameters)


def test_held_constants_that_the_turns_do_not_tell_apart() -> None:
    huuv = read_huuv()
    fit = tuned(huuv, "matlab", (*BASE, "nr"))
    (side,), (munk,), (arm,) = (hidden(huuv, fit, "matlab", name) for name in ("m", "my", "arm"))
    assert side.startswith("side force C_S (beta), side force C_S (beta^3) and mass m: only as ratios")
    for words in ("yaw moment C_m (beta)", "added mass m_y"):
        assert words in munk
    for words in ("yaw moment C_m (beta^3)", "yaw rate term M_mr (r)", "thruster arm y_ct"):
        assert words in arm


def test_exact_derivatives_of_the_turns() -> None:
    huuv = read_huuv()
    free = (*FREE, "m", "mx", "my", "myr", "slope", "arm")
    p = turning_problem(huuv, huuv.turns["matlab"], (0.01, 0.005, 0.02), free, start_of(huuv))
    assert p.jacobian is not None
    exact, step = p.jacobian(p.start), 1e-6 * p.sizes
    for k in range(len(free)):
        aside = step[k] * np.eye(len(free))[k]
        found = (p.outputs(p.start + aside) - p.outputs(p.start - aside)) / (2.0 * step[k])
        assert exact[:, k] == pytest.approx(found, rel=1e-4, abs=1e-6 * np.max(np.abs(exact[:, k])))


@SLOW
def test_figures_are_drawings_with_words_and_the_same_bytes_again(found: Acceptance) -> None:
    assert [name for name, _ in found.figures] == [
        *(f"huuv_{half}_{kind}" for half in ("matlab", "tracker") for kind in ("turns", "agreement")), "huuv_forces",
        "huuv_fig07", "huuv_fig12_13_16", "huuv_fig15", "huuv_fig17_18", "huuv_masses",
    ]  # fmt: skip
    for _, figure in found.figures:
        assert figure.svg.startswith("<svg")
    for _, figure in found.figures[:4]:
        assert "Root mean square before and after" in figure.caption
    assert "data, left 20 %" in found.figures[0][1].svg
    assert [figure.svg for _, figure in acceptance().figures] == [figure.svg for _, figure in found.figures]


@SLOW
def test_the_drawn_forces_end_where_the_turns_end_and_name_what_is_open(found: Acceptance) -> None:
    figure = dict(found.figures)["huuv_forces"]
    drag, side, _ = figure.panels
    by_name = {s.name: s for s in drag.series}
    assert max(by_name["tuned to the pool"].x) == pytest.approx(16.98, abs=1e-3)
    assert max(by_name["tuned to the simulation"].x) == pytest.approx(21.76, abs=1e-3)
    for s in drag.series:
        assert s.y == pytest.approx(s.y[::-1])
    for s in side.series:
        assert np.array(s.y) == pytest.approx(-np.array(s.y[::-1]), abs=1e-9)
    assert "pool: drag C_D (beta^2)" in figure.caption
    assert "no drag surface" in figure.caption


@SLOW
def test_figure_18_stands_below_17_and_no_point_is_drawn_that_is_not_printed(found: Acceptance) -> None:
    turns, straight = dict(found.figures)["huuv_fig17_18"].panels
    printed = {s.name for s in turns.series if "printed" in s.name}
    assert printed == {"printed, simulation", "printed, pool"}
    assert sum(len(s.x) for s in turns.series if "printed" in s.name) == 56
    assert [s.name for s in straight.series] == ["straight, submerged, our model", "straight, without the mast's drag"]
    for name in ("huuv_fig12_13_16", "huuv_fig15"):
        assert all("printed" not in s.name for p in dict(found.figures)[name].panels for s in p.series)
        assert "Assumed" in dict(found.figures)[name].caption


@SLOW
def test_json_of_every_table(found: Acceptance, capsys: pytest.CaptureFixture[str]) -> None:
    show.json_object(as_json.acceptance(found))
    assert json.loads(capsys.readouterr().out)["passed"] is True

"""The THAUV paper reproduced, and what would break it."""

from __future__ import annotations

import json
from collections.abc import Callable

import numpy as np
import pytest

from coeflab.cli import show
from coeflab.formats.export import export
from coeflab.motion.simulation import simulate
from coeflab.published.thauv.acceptance import acceptance
from coeflab.report.acceptance import Acceptance, ComparedTable
from coeflab.report.as_json import studies as as_json

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def thauv(publication: Callable[[str], Acceptance]) -> Acceptance:
    return publication("thauv")


def _table(thauv: Acceptance, key: str) -> ComparedTable:
    return next(t for t in thauv.tables if t.key == key)


def test_every_number_holds(thauv: Acceptance) -> None:
    assert [t.key for t in thauv.tables] == [
        "engine", "steady_glides", "speeds", "left_out", "constants", "cycle", "climbs", "settling", "gains", "power", "masses",
        "power_in_space", "cruise", "spiral", "senses", "carried",
    ]  # fmt: skip
    assert [(t.key, r.case, r.quantity) for t in thauv.tables for r in t.rows if not r.holds] == []


def test_steady_glides_to_a_ten_thousandth(thauv: Acceptance) -> None:
    rows = _table(thauv, "steady_glides").rows
    assert len(rows) == 12
    assert {r.tolerance for r in rows} == {1e-4}
    assert {r.against for r in rows if r.quantity == "V"} == {0.39950, 0.39164, 0.42286, 0.28489, 0.27944, 0.30525}


def test_published_speeds_are_called_in_sample_and_left_out_ones_stand_beside(thauv: Acceptance) -> None:
    speeds, left_out = _table(thauv, "speeds"), _table(thauv, "left_out")
    assert [r.against for r in speeds.rows] == [0.25, 0.32, 0.34, 0.43, 0.54, 0.57]
    assert {(r.basis, r.tolerance) for r in speeds.rows} == {("calibration", 0.005)}
    assert any("in-sample" in s for s in speeds.statements)
    apart = [abs(r.difference or 0.0) for r in left_out.rows if "left out" in r.case]
    assert len(apart) == 6
    assert max(apart) == pytest.approx(0.00374, abs=1e-4)
    assert max(apart) > max(abs(r.difference or 0.0) for r in speeds.rows)


def test_the_cycle_settles(thauv: Acceptance) -> None:
    assert any("within 1e-06 m/s of our own steady glide" in s for s in _table(thauv, "cycle").statements)


def test_what_is_calibrated_is_called_so(thauv: Acceptance) -> None:
    assert {t.key: (len(t.rows), {r.basis.value for r in t.rows}) for t in thauv.tables if t.key != "gains"} == {
        "engine": (1, {"verification"}), "steady_glides": (12, {"consistency"}), "speeds": (6, {"calibration"}),
        "left_out": (6, {"verification"}), "constants": (4, {"consistency"}), "cycle": (6, {"calibration"}), "climbs": (3, {"consistency"}),
        "settling": (1, {"calibration"}), "power": (6, {"consistency"}), "masses": (10, {"verification", "consistency"}),
        "power_in_space": (3, {"consistency"}), "cruise": (4, {"consistency"}), "spiral": (7, {"consistency"}),
        "senses": (3, {"consistency"}), "carried": (3, {"consistency"}),
    }  # fmt: skip


def test_the_printed_settling_time_gives_the_damping_and_says_what_is_assumed(thauv: Acceptance) -> None:
    table = _table(thauv, "settling")
    (row,) = table.rows
    assert (row.against, row.tolerance) == (170.0, 5.0)
    assert row.found == pytest.approx(171.0)
    for words in (
        "around 170 s",
        "55 N m per m/s and rad/s",
        "J = 200 kg m^2, which is assumed",
        "10 lets case 01 swing up",
    ):
        assert any(words in s for s in table.statements)


def test_errata_and_doubts_are_named(thauv: Acceptance) -> None:
    errata, said = " ".join(thauv.errata), " ".join(thauv.statements)
    for words in (
        "Equation 9",
        "Equation 18",
        "Equation 19",
        "mass plus added mass",
        "Table 2",
        "swapped",
        "483 g",
        "degrees",
    ):
        assert words in errata
    for words in (
        "Munk moment",
        "236.7 kg is 3.6 times",
        "by up to 0.025 m/s",
        "no pitch damping",
        "12 of the 12",
        "calibrated",
    ):
        assert words in said


def test_figures(thauv: Acceptance) -> None:
    assert [name for name, _ in thauv.figures] == [
        "motion", "polar_thauv_case_01", "polar_thauv_case_02", "polar_thauv_case_03", "forces", "forces_case_01", "cruise",
        "speeds", "masses", "spiral",
    ]  # fmt: skip
    assert all(figure.svg.startswith("<svg") for _, figure in thauv.figures)
    for axis in ("V", "x", "depth", "alpha"):
        assert axis in thauv.figures[0][1].svg


def test_the_drawn_forces_are_those_of_table_3(thauv: Acceptance) -> None:
    """Case 01 at 10 degrees: L/V^2 = K_L0 + 10 K_L, D/V^2 = K_D0 + 100 K_D, M/V^2 = K_M0 + 10 K_M."""
    lift, drag, moment = (panel.series[0] for panel in dict(thauv.figures)["forces"].panels)
    printed = {"lift": -1.9169 + 95.281, "drag": 11.1159 + 21.5, "moment": 1.1025 - 14.179}
    for drawn, value in zip((lift, drag, moment), printed.values(), strict=True):
        assert drawn.name == "case 01"
        assert np.interp(10.0, drawn.x, drawn.y) == pytest.approx(value, rel=5e-3)


def test_figures_8_to_12_are_table_3_times_the_square_of_the_speed(thauv: Acceptance) -> None:
    drawn = dict(thauv.figures)
    lift, drag, moment = (panel.series[3] for panel in drawn["forces_case_01"].panels)
    assert lift.name == "V = 1 m/s"
    for found, value in zip((lift, drag, moment), (-1.9169 + 95.281, 11.1159 + 21.5, 1.1025 - 14.179), strict=True):
        assert np.interp(10.0, found.x, found.y) == pytest.approx(value, rel=5e-3)
    half = (panel.series[1] for panel in drawn["forces_case_01"].panels)
    assert [np.interp(0.0, s.x, s.y) * 4.0 for s in half] == pytest.approx([-1.9169, 11.1159, 1.1025], rel=5e-3)
    level = [[np.interp(1.0, s.x, s.y) for s in panel.series] for panel in drawn["cruise"].panels]
    assert level[0] == pytest.approx([-1.9169, -1.8461, -1.265], rel=5e-3)
    assert level[1] == pytest.approx([11.1159, 11.5594, 11.2805], rel=5e-3)
    assert "4.0 %" in drawn["cruise"].caption


def test_printed_points_are_those_of_the_text(thauv: Acceptance) -> None:
    """And nothing else is drawn as printed."""
    figures = dict(thauv.figures)
    (panel,) = figures["speeds"].panels
    points = {s.name: (list(s.x), list(s.y)) for s in panel.series if "printed" in s.name}
    assert points == {
        "case 01, printed": ([170.0, 1430.0], [0.25, 0.43]),
        "case 02, printed": ([170.0, 1430.0], [0.32, 0.54]),
        "case 03, printed": ([170.0, 1430.0], [0.34, 0.57]),
    }
    others = [s.name for n, f in figures.items() if n != "speeds" for p in f.panels for s in p.series]
    assert not [name for name in others if "printed" in name]
    assert any("1 and 7" in s and "5 and 6" in s for s in thauv.statements)


def test_the_masses_in_plan(thauv: Acceptance) -> None:
    """Figure 2: the roller in the right hull, pistons to both sides, what is left where their moments put it."""
    upper, _ = dict(thauv.figures)["masses"].panels
    at = {s.name: (list(s.x), list(s.y)) for s in upper.series}
    assert at["pistons"][0] == pytest.approx([0.25, -0.25], abs=1e-3)
    assert at["roller"][0] == pytest.approx([0.25], abs=1e-3)
    assert at["the rest"][0] == pytest.approx([-1.04 * 0.25 / 64.29], abs=1e-3)
    assert at["centre of gravity"] == (pytest.approx([0.0], abs=1e-3), pytest.approx([-0.000257], abs=1e-3))


def test_the_roller_s_picture_is_equation_4(thauv: Acceptance) -> None:
    _, lower = dict(thauv.figures)["masses"].panels
    across, down = lower.series
    assert np.interp(60.0, across.x, across.y) == pytest.approx(0.25 + 0.05 * np.sin(np.pi / 3), abs=1e-3)
    assert np.interp(60.0, down.x, down.y) == pytest.approx(0.05 - 0.05 * (1.0 - np.cos(np.pi / 3)), abs=1e-3)


def test_a_dive_s_parameter_file_goes_through_the_common_simulator(thauv: Acceptance) -> None:
    """Roll, rate of turn and speed of the spiral by the rigid body; the second order of the angles costs 1 to 3 %."""
    file = next(p for p in thauv.parameter_files if p.name == "thauv_case_02_spiral")
    options = {"pitch": -0.3, "speed": 0.33, "duration": 300.0}
    found = {f.name: f.value for f in simulate(file, "glide", options, {"record": 5.0}).figures}
    rows = {r.quantity: r.against for r in _table(thauv, "spiral").rows}
    assert found["steady speed"] == pytest.approx(rows["V"], rel=0.01)
    assert np.degrees(found["roll"] or 0.0) == pytest.approx(rows["roll"], rel=0.01)
    assert np.degrees(found["rate of turn"] or 0.0) == pytest.approx(rows["turn"], rel=0.03)
    assert found["radius"] == pytest.approx(rows["radius"], rel=0.04)
    assert found["glide angle"] == pytest.approx(-np.arcsin(rows["sinking"] / rows["V"]), rel=0.01)


@pytest.mark.parametrize("to", ["mss", "fmi", "xdyn"])
def test_simulators_hold_the_whole_force_of_a_dive_and_the_thrusters(thauv: Acceptance, to: str) -> None:
    file = next(p for p in thauv.parameter_files if p.name == "thauv_case_02_dive_1")
    loss = export(file, to).loss
    assert loss.not_held == loss.lost == ()
    assert np.nanmax(loss.forces.relative) < 1e-9
    assert any("neither moving pistons, roller nor buoyancy engine" in note for note in file.provenance.notes)


def test_the_same_twice(thauv: Acceptance) -> None:
    assert acceptance() == thauv


def test_json_of_every_table(thauv: Acceptance, capsys: pytest.CaptureFixture[str]) -> None:
    show.json_object(as_json.acceptance(thauv))
    assert json.loads(capsys.readouterr().out)["passed"] is True

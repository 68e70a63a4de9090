"""The THAUV paper reproduced, and what would break it."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.published.thauv.acceptance import acceptance
from coeflab.report.acceptance import Acceptance, ComparedTable

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def thauv() -> Acceptance:
    return acceptance()


def _table(thauv: Acceptance, key: str) -> ComparedTable:
    return next(t for t in thauv.tables if t.key == key)


def test_every_number_holds(thauv: Acceptance) -> None:
    assert [t.key for t in thauv.tables] == [
        "engine", "steady_glides", "speeds", "left_out", "constants", "cycle", "settling", "gains", "power",
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
    assert any("within 1e-06 m/s of the steady glide" in s for s in _table(thauv, "cycle").statements)


def test_what_is_calibrated_is_called_so(thauv: Acceptance) -> None:
    assert {t.key: (len(t.rows), {r.basis.value for r in t.rows}) for t in thauv.tables if t.key != "gains"} == {
        "engine": (1, {"printed and recomputed"}), "steady_glides": (12, {"consistency"}), "speeds": (6, {"calibration"}),
        "left_out": (6, {"predicted"}), "constants": (4, {"consistency"}), "cycle": (6, {"calibration"}),
        "settling": (1, {"calibration"}), "power": (6, {"consistency"}),
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
        "motion", "polar_thauv_case_01", "polar_thauv_case_02", "polar_thauv_case_03", "forces",
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


def test_the_same_twice(thauv: Acceptance) -> None:
    assert acceptance() == thauv

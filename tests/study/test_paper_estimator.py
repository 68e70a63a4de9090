"""The steady-CFD study's own estimator, secants where too few runs count, and what is no result."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.law.coefficient import Coefficient, Status
from coeflab.study.lines import line
from coeflab.study.secants import OF_SECANT, secant
from coeflab.study.towed import NO_RESULT, TowedRow
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables

CAMPAIGN = """
[campaign]
name = "c"
title = "c"
body = "b"
[axes]
frame = "FRD"
datum = "nose"
reference_point = [-1.0, 0.0, 0.0]
[scaling]
length = 2.0
length_name = "LBP"
[conditions]
speed = 1.0
density = 500.0
[source]
citation = "none"
kind = "cfd"
[[table]]
file = "drift.csv"
labels = ["grid", "status"]
select = {grid = "medium", reason = "grid study only"}
"""
# Primes are forces over 1/2 500 1^2 2^2 = 1000 N: Y' = .001 - .02 v' - .1 v'|v'| at these four angles, and one beyond 6 deg.
ANGLES = (0.0, 1.0, 2.0, 3.0, 6.0, 12.0)


def force(v: float) -> float:
    return 1000.0 * (0.001 - 0.02 * v - 0.1 * v * abs(v))


def tables(folder: Path, states: dict[float, str] | None = None) -> tuple[ForceTable, ...]:
    rows = ["point,u [m/s],v [m/s],Y [N],grid,status,uncertain"]
    for angle in ANGLES:
        v, state = float(np.sin(np.radians(angle))), (states or {}).get(angle, "converged")
        u, doubtful = float(np.cos(np.radians(angle))), "" if state == "converged" else "Y"
        rows.append(f"d{angle:g},{u:.9g},{v:.9g},{force(v):.9g},medium,{state},{doubtful}")
    rows.append(f"coarse,{np.cos(0.05):.9g},{np.sin(0.05):.9g},99.0,coarse,converged,")
    (folder / "campaign.toml").write_text(CAMPAIGN)
    (folder / "drift.csv").write_text("\n".join(rows) + "\n")
    return read_tables(PlannedTable(folder, ()))


def test_the_line_goes_through_all_points_up_to_6_deg_with_its_intercept(tmp_path: Path) -> None:
    v = np.sin(np.radians(ANGLES[:5]))
    y = np.array([force(x) for x in v]) / 1000.0
    n = len(v)
    by_hand = (n * (v @ y) - v.sum() * y.sum()) / (n * (v @ v) - v.sum() ** 2)
    found = line(tables(tmp_path), "Yv", 2.0)
    assert found == pytest.approx(by_hand, rel=1e-7)
    assert abs(found - float(v @ y / (v @ v))) > 1e-3  # not through the origin
    assert line(tables(tmp_path), "Yr", 2.0) is None
    assert line(tables(tmp_path), "Nv", 2.0) is None


def test_a_secant_is_of_the_smallest_setting_that_counts_with_a_wide_u95(tmp_path: Path) -> None:
    some = tables(tmp_path, dict.fromkeys((1.0, 3.0, 6.0, 12.0), "unconverged"))
    found = secant(some, "Yv", some[0].scaling)
    v = {a: float(np.sin(np.radians(a))) for a in ANGLES}
    secants = [force(v[a]) / 1000.0 / v[a] for a in ANGLES[1:]]
    assert found.value == pytest.approx(secants[1])
    assert found.u95 == pytest.approx(np.hypot(OF_SECANT * abs(secants[1]), np.ptp(secants) / 2.0))
    assert found.n_points == 1
    none = tables(tmp_path, dict.fromkeys(ANGLES, "unconverged"))
    assert secant(none, "Yv", none[0].scaling) is None
    assert secant(none, "Nv", none[0].scaling) is None


@pytest.mark.parametrize(("symbol", "share", "is_result"), [
    ("Yr", NO_RESULT + 0.01, False), ("Nr", NO_RESULT - 0.01, True), ("Yv", 3.0, True), ("Zq", 0.5, False),
])  # fmt: skip
def test_a_wide_rotary_derivative_is_no_result(symbol: str, share: float, is_result: bool) -> None:
    own = Coefficient(symbol, -0.004, 0.004 * share, Status.OK, "b", origin="fit")
    assert TowedRow(symbol, own, None, "", "", ()).is_result is is_result
    assert replace(TowedRow(symbol, own, None, "", "", ()), coefficient=None).is_result

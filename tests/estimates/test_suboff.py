"""SUBOFF: the outline with ring wing 1, the comparison with Roddy's measurements, and the tow tank's solver on it."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.law.coefficient import Status
from coeflab.published.estimates.acceptance import Measured, acceptance, goals, ring_wing, rows, table
from coeflab.report.acceptance import Acceptance
from coeflab.report.first_page import answer
from coeflab.tables.reading import read_tables, table_at
from coeflab.tank import tow
from coeflab.tank.collected import collected

FOOT = 0.3048


@pytest.fixture(scope="module")
def found() -> tuple[Measured, ...]:
    return rows()


@pytest.fixture(scope="module")
def compared() -> Acceptance:
    return acceptance()


def test_ring_wing_1_stands_where_roddys_volumes_say() -> None:
    # Table 1: configuration 6 less 3, 0.0648 ft^3 at 13.80 ft aft of the nose.
    ring = ring_wing()
    middle = -ring.centre[0] / FOOT + 0.25 * ring.chord / FOOT
    assert middle == pytest.approx(13.80, abs=0.06)
    section = 0.0648 / (np.pi * ring.diameter / FOOT) / (ring.chord / FOOT) ** 2 / ring.thickness
    assert 0.4 < section < 0.8  # of thickness times chord


def test_every_measured_derivative_once(found: tuple[Measured, ...]) -> None:
    assert [(r.configuration, r.symbol) for r in found] == [
        *(("3", s) for s in ("Yv", "Nv", "Yr", "Nr")), *(("2", s) for s in ("Yv", "Nv", "Kv", "Ydr", "Ndr", "Yr", "Nr")),
        *(("1", s) for s in ("Zw", "Mw", "Zds", "Mds", "Zq", "Mq")),
    ]  # fmt: skip
    assert {r.symbol for r in found if not r.counts} == {"Zds", "Mds"}
    value = {(r.configuration, r.symbol): r.value for r in found}
    assert value["1", "Zds"] == pytest.approx(-value["2", "Ydr"], rel=1e-6)
    assert value["1", "Mds"] == pytest.approx(value["2", "Ndr"], rel=1e-6)


def test_signs_are_those_measured(found: tuple[Measured, ...]) -> None:
    assert all(r.ratio > 0.0 for r in found)


def test_a_row_is_inside_by_the_estimates_own_u95(found: tuple[Measured, ...]) -> None:
    one = found[0]
    u95 = one.found.u95
    assert replace(one, measured=one.value + 0.99 * u95).inside
    assert not replace(one, measured=one.value + 1.01 * u95).inside


def test_goals_are_printed_and_do_not_count(compared: Acceptance, found: tuple[Measured, ...]) -> None:
    derivatives, levers = compared.tables
    counted = [r for r in found if r.counts]
    assert (len(derivatives.rows), len(levers.rows)) == (15, 2)
    inside = sum(r.inside for r in counted)
    assert goals(found) in compared.statements
    assert goals(found).startswith("Goals of the project, not counted: inside")
    assert f"inside {100 * inside / 15:.0f} %, goal at least 90 %, met" in goals(found)
    assert goals(tuple(replace(r, measured=r.value) for r in found)).count(", met") == 3
    assert goals(tuple(replace(r, measured=3.0 * r.value) for r in found)).count(", missed") == 2
    assert answer(compared, drawn=False).sentence == (
        "Estimates from the shape against SUBOFF tests: all 17 numbers within the tolerance; none of them is validation: revised and consistency only."
    )
    assert len(derivatives.rows) == len(counted)
    shown = table(found)
    assert "worst" in shown.notes[1]
    assert "mean signed error" in shown.notes[1]


@pytest.mark.slow
def test_a_tow_by_estimates_from_table_to_report(tmp_path: Path) -> None:
    shutil.copytree(Path(shipped("geometry")) / "tow_spheroid", tmp_path / "body")
    made = tow.laid_out(*tow.read(tmp_path / "body", None, "estimate"), tmp_path / "tow")
    assert made.jobs == ()
    found = collected(made)
    campaign = (tmp_path / "tow" / "campaign" / "campaign.toml").read_text()
    assert 'kind = "estimate"' in campaign
    assert "cfd" not in campaign
    assert all(t.source.kind == "estimate" for t in read_tables(table_at(tmp_path / "tow" / "campaign")))
    known = made.solver.known
    assert known is not None
    among = known(made.tank, made.body)
    for row in found.six:
        assert row.coefficient.status is Status.ESTIMATE
        assert row.value == pytest.approx(among[row.symbol].value, rel=0.02, abs=1e-5)
        assert row.u95 == among[row.symbol].u95
    assert any(f.name == "report.html" for f in found.files)

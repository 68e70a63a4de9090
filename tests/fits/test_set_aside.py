"""Rejected and doubtful rows beside a fit: shown, never used."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.fits.joint.rows import joint_rows
from coeflab.fits.results.set_aside import readmitted
from coeflab.fits.rows.only_moving import only_moving
from coeflab.fits.rows.regression import Area, collect
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables
from tests.report.studies import FULL, LENGTH, small_table

PRIMES = Area(LENGTH.length**2, "L^2", LENGTH.length)


def test_a_doubtful_cell_is_beside_its_own_component_only():
    table = small_table(FULL)
    rows = collect([table], ("v",), "Y", PRIMES)
    assert rows.set_aside.labels == ("tow 1",)
    assert rows.set_aside.x["v"] == pytest.approx([np.sin(np.radians(FULL[1]))])
    assert rows.set_aside.y == pytest.approx(table.primed_force("Y", LENGTH.length)[[1]])
    assert "tow 1" not in rows.labels
    assert collect([table], ("v",), "N", PRIMES).set_aside is None


def test_wind_forces_beside_a_fit_come_from_the_printed_cells():
    table = small_table(FULL)
    n = len(table)
    table = replace(
        table, forces={**table.forces, "X": np.full(n, -2.0)}, usable={**table.usable, "X": np.ones(n, dtype=bool)}
    )
    found = collect([table], ("beta",), "C_S", PRIMES).set_aside
    whole = collect([table.with_uncertain_cells()], ("beta",), "C_S", PRIMES)
    assert found.y == pytest.approx(whole.y[[1]], rel=1e-14)
    assert np.all(readmitted(table).usable["Y"])


def test_rows_left_out_because_something_else_moves_are_not_beside():
    tables = read_tables(PlannedTable(shipped("cfd_data") / "suboff_roddy_2", (), {}))
    used, _ = only_moving(tables, ("v",), LENGTH.length)
    rows = collect(used, ("v",), "Y", PRIMES)
    assert len(rows.set_aside.y) == 1
    assert len(rows.y) + 1 < len(tables[0])


def test_joint_rows_keep_those_in_which_the_others_rest():
    tables = read_tables(PlannedTable(shipped("cfd_data") / "suboff_cfd_barehull", (), {}))
    both = joint_rows(tables, ("v", "r"), "Y", LENGTH.length).rows
    drift = joint_rows(tables, ("v",), "Y", LENGTH.length).rows
    assert len(both.set_aside.y) == 4
    assert 0 < len(drift.set_aside.y) < 4
    assert set(drift.set_aside.x) == {"v"}

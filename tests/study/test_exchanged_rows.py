"""Rows in each other's place are named by the data gate, in short sweeps too; `tests.coverage.exchanged_rows` measures how many."""

from __future__ import annotations

import csv
from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.finding import Severity
from coeflab.fits.statistics.data_gate import Parity, prepare
from coeflab.fits.statistics.exchanged_rows import exchanged, gains
from coeflab.study.checks.data_gate import findings
from tests.coverage.exchanged_rows import TABLE, campaigns, names_both, pairs, swapped, warned
from tests.study.test_data_gate import demo


def test_every_pair_of_neighbours_of_the_shipped_one_sided_sweeps_is_named() -> None:
    tried, missed = 0, []
    for name, table, order in campaigns():
        if name.startswith("suboff"):
            for pair in pairs(order)[: len(order) - 1]:
                tried += 1
                if not names_both(table, pair, warned([swapped(table, *pair)])):
                    missed.append((name, pair))
            assert warned([table]) == []
    assert tried == 11
    assert missed == []


def test_the_slope_is_given_as_they_stand_and_exchanged() -> None:
    """4 and 6 degrees exchanged: the U95 of a slope is many times that of the rows in their places."""
    _, table, _ = next(campaigns())
    found = [c for c in warned([swapped(table, 2, 3)]) if "in each other's place" in c.statistic]
    assert [c.subject.rpartition(" lines ")[2] for c in found] == ["4 and 5"]
    assert "asin(v/U) = -4.0 deg and asin(v/U) = -6.0 deg" in found[0].statistic
    words = found[0].statistic.replace(",", " ").split()
    wide, narrow = float(words[words.index("as", words.index("=", 8)) - 1]), float(words[-2])
    assert wide > 20.0 * narrow


def test_the_gain_of_an_exchange_is_the_likelihood_of_the_readings_so_exchanged() -> None:
    rng = np.random.default_rng(2)
    x = np.linspace(0.0, 0.2, 7)
    y = -0.03 * x - 0.2 * x**2 + 1e-5 * rng.standard_normal(7)
    gate = prepare(x, Parity.ODD)
    pairs_of, _ = gains(gate, y)
    turned = y[[0, 1, 3, 2, 4, 5, 6]]
    back, _ = gains(gate, turned)
    assert pairs_of == pytest.approx(pairs_of.T, abs=1e-6)
    assert pairs_of[2, 3] == pytest.approx(-back[2, 3], rel=1e-4)
    assert pairs_of[2, 3] < 0.0
    assert exchanged([gate], [y]) == ()
    (found,) = exchanged([gate, gate], [turned, 2.0 * turned])
    assert set(found.rows) == {2, 3}
    assert found.gain > found.threshold


def test_one_wrong_reading_is_no_exchange() -> None:
    drift, arm = demo()
    y = np.array(drift.forces["Y"])
    y[8] *= 1.5
    found = findings((replace(drift, forces={**drift.forces, "Y": y}), arm), drift.scaling.length)
    assert not any("in each other's place" in c.statistic for c in found)


def test_rows_of_other_grids_that_suit_another_row_are_named() -> None:
    """The grid study of the shipped sweep is at 4 degrees: after the exchange its rows have the forces of the row at 6."""
    _, table, _ = next(campaigns())
    wrong = swapped(table, 2, 3)
    assert not any("of other grids" in c.statistic for c in warned([table]))
    (found,) = (c for c in findings([wrong], wrong.scaling.length) if "of other grids" in c.statistic)
    assert found.severity is Severity.WARN
    assert names_both(wrong, (2, 3), [found])


def test_at_least_45_of_54_are_named_and_at_most_one_per_cent_of_clean_campaigns() -> None:
    """The committed measurement; ``python -m tests.coverage.exchanged_rows`` makes it again."""
    held = csv.DictReader(TABLE.read_text(encoding="utf-8").splitlines())
    rows = {(r["campaign"], r["what"]): (int(r["tried"]), int(r["found"])) for r in held}
    tried, found = rows["all", "exchanged: both rows named"]
    assert tried >= 54
    assert found * 54 >= 45 * tried
    clean = [v for (_, what), v in rows.items() if what == "clean: any other warning"]
    assert [count for count, _ in clean] == [200, 200]
    assert all(some <= 2 for _, some in clean)

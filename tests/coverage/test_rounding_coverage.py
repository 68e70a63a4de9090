"""Where few digits are printed U95 covers: the committed table, a few campaigns anew, and what the page says."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from coeflab.fits.statistics import origin_slope, slopes
from coeflab.fits.statistics.printed_digits import UNIFORM
from tests.coverage.rounding_campaigns import CAMPAIGNS, CELLS, TABLE, campaigns, run


@pytest.fixture(scope="module")
def rows() -> list[dict[str, str]]:
    with TABLE.open() as lines:
        return list(csv.DictReader(lines))


def test_every_cell_covers(rows: list[dict[str, str]]) -> None:
    assert [r["campaigns"] for r in rows] == [str(CAMPAIGNS)] * len(CELLS)
    assert min(float(r["cover %"]) for r in rows) >= 95.0
    assert min(float(r["without %"]) for r in rows) < 40.0


@pytest.mark.parametrize("cell", [CELLS.index(c) for c in ((("even", 13), 0.0, 0.2), (("one-sided", 9), 0.01, 0.1))])
def test_few_campaigns_cover(cell: int) -> None:
    error, before, after = run(cell, 40).T
    assert np.mean(error <= after) >= 0.9
    assert np.mean(error <= before) < 0.85


def test_a_campaign_of_the_study_is_what_a_fit_prints() -> None:
    cell = CELLS.index((("even", 9), 0.01, 0.05))
    error, before, after = run(cell, 20).T
    x, y, true = (a[0] for a in campaigns(cell, 20))
    digit = CELLS[cell][2] * np.max(np.abs(y), axis=1) / UNIFORM
    same = 0
    for k in range(6):
        o = origin_slope.estimate(x, y[k])
        if not np.all(o.used):
            continue  # the study leaves no row out
        part = slopes.by_digits(x, y[k], None, np.full(len(x), digit[k]), "x", o.noise, False, False, o.value, o.u95)
        told = origin_slope.estimate(x, y[k], np.full(len(x), digit[k]))
        if np.all(told.used):
            same += 1
            found = abs(o.value - true[k]), o.u95, np.hypot(o.u95, part)
            assert found == pytest.approx((error[k], before[k], after[k]), rel=1e-3)
    assert same


def test_the_page_says_what_the_table_says(rows: list[dict[str, str]]) -> None:
    text = (TABLE.parents[2] / "docs" / "slope_at_origin.md").read_text()
    cover, without = (np.array([float(r[c]) for r in rows]) for c in ("cover %", "without %"))
    assert f"Of {len(rows) * CAMPAIGNS:,} simulated campaigns" in text
    assert f"covers {cover.mean():.1f} %, in the worst cell {cover.min():.1f} %" in text
    assert f"without that part {without.mean():.1f} and {without.min():.1f} %" in text

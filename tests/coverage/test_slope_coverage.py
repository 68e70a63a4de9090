"""The coverage study of the slope at the origin with few campaigns, and what its committed table says."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from tests.coverage.slope_campaigns import DESIGNS, FAMILIES, NOISE, TABLE, run_round

SMOKE = ("v|v| + v3", "tanh", "onset", "offset", "asymmetric")


@pytest.mark.slow
@pytest.mark.parametrize("design", DESIGNS)
def test_few_campaigns_cover_in_nine_of_ten(design: str) -> None:
    cells = run_round(design, 1000, 12, 0, SMOKE)
    assert np.isfinite(cells[..., 1]).all()
    assert cells[..., 0].mean() > 0.9


def test_the_committed_table_is_whole_and_covers_94_percent_over_all() -> None:
    with TABLE.open() as lines:
        rows = list(csv.DictReader(lines))
    assert len(rows) == len(FAMILIES) * len(DESIGNS) * len(NOISE)
    assert len(FAMILIES) >= 12
    assert {r["no value"] for r in rows} == {"0"}
    cover = np.array([float(r["cover %"]) for r in rows])
    assert cover.mean() >= 94.0
    assert all((c < 90.0) == (r["remark"] == "below 90") for c, r in zip(cover, rows))
    assert all((c > 99.0) == (r["remark"] == "conservative") for c, r in zip(cover, rows))

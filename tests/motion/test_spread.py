"""Which figures get an interval."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.motion.manoeuvre import Figure
from coeflab.motion.uncertainty.spread import spread

SAMPLE = np.random.default_rng(1).normal(10.0, 2.0, 4000)
HERE = Figure("advance", 10.0, "m", "along")


def holed(share: float) -> tuple[np.ndarray, list[str]]:
    values = SAMPLE.copy()
    values[: int(share * len(values))] = np.nan
    return values, ["not reached" if np.isnan(v) else "ok" for v in values]


def test_an_interval_of_normal_members() -> None:
    found = spread(HERE, SAMPLE, ["ok"] * len(SAMPLE))
    assert found.status == "ok"
    assert found.low == pytest.approx(6.0, abs=3.0 * found.low_error)
    assert found.high == pytest.approx(14.0, abs=3.0 * found.high_error)
    assert 0.05 < found.low_error < 0.15


def test_five_per_cent_may_lack_the_figure_and_no_more() -> None:
    few = spread(HERE, *holed(0.049))
    assert (few.status, few.having) == ("ok", pytest.approx(0.951))
    assert "95.1 %" in few.why
    many = spread(HERE, *holed(0.051))
    assert (many.status, many.low, many.high, many.median) == ("no interval", None, None, None)
    assert "5.1 % of the members do not have it (not reached 204)" in many.why


def test_no_interval_without_a_value_of_the_file() -> None:
    found = spread(Figure("advance", None, "m", "along", "not determined"), SAMPLE, ["ok"] * len(SAMPLE))
    assert (found.status, found.why) == ("no interval", "not determined at the values of the file")


def test_extrapolated_members_are_counted() -> None:
    statuses = ["extrapolated"] * 1000 + ["ok"] * 3000
    assert spread(HERE, SAMPLE, statuses).extrapolated == 0.25

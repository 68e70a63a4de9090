"""Proposed runs are worth what they take from the whole U95: grid and declared inputs stay."""

from __future__ import annotations

import math

import pytest

from coeflab.core.files import shipped
from coeflab.report.tables.next_runs import next_points, next_runs, no_run_narrows
from coeflab.study.run import run
from coeflab.study.study import Plan, Study
from coeflab.tables.reading import table_at


@pytest.fixture(scope="module")
def study() -> Study:
    """A computed campaign with a grid study."""
    return run(Plan("grid", "grid", (table_at(shipped("cfd_data") / "suboff_cfd_barehull", ("slope_at_origin",)),)))


def test_u95_now_and_then_are_whole(study: Study) -> None:
    fit = study.fits[0]
    for sweep in (s for s in fit.sweeps if s.symbol in ("Nv", "Nr", "Yr")):
        c = fit.coefficients[sweep.symbol]
        held = c.parts.input
        assert held
        assert c.u95 == pytest.approx(math.hypot(sweep.u95 or 0.0, held), rel=1e-9)
        (_, alone), *_ = sweep.next_runs(1, distinct=True)
        (_, whole), *_ = next_runs(study, fit, sweep, 1)
        assert whole == pytest.approx(math.hypot(alone, held), rel=1e-12)
        assert held < whole < (c.u95 or 0.0)
    table = next_points(study, fit, 1, ["Nr"])
    assert float(table.rows[0][-1].split()[0]) > 99.0  # %, of a U95 whose grid leads


def test_what_leads_is_named_where_no_run_narrows_it(study: Study) -> None:
    fit = study.fits[0]
    by = {s.symbol: s for s in fit.sweeps}
    (found,) = no_run_narrows(study, fit, [by["Nr"], by["Yr"]])
    assert found["leads"] == "grid"
    assert [s.endswith("(Nr')") for s in found["shares"]] == [True]
    share = (fit.coefficients["Nr"].parts.input or 0.0) ** 2 / (fit.coefficients["Nr"].u95 or 1.0) ** 2
    assert found.statistic == pytest.approx(share, rel=1e-9)
    assert no_run_narrows(study, fit, [by["Yr"]]) == []

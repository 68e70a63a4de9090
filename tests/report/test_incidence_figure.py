"""Local incidence along a body that turns, against the velocity of a rigid body's points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.axes import Datum
from coeflab.report.figures.incidence import ends, incidence_figure, local_incidence
from coeflab.report.sections.campaign import campaign_section
from coeflab.study.study import Study
from coeflab.tables.force_table import ForceTable
from tests.report.studies import small_table


def turning() -> ForceTable:
    straight = small_table([0.0, 4.0, 8.0, 4.0, 4.0, 4.0])
    rates = np.array([0.1, 0.2, -0.3, 0.1, 0.15, 0.0])
    table = replace(straight, motion={**straight.motion, "r": rates, "q": np.full(6, 0.05), "w": np.full(6, 0.02)})
    return replace(table, reference_point=np.array([-0.8, 0.0, 0.0]))


@pytest.mark.parametrize(("rate", "across"), [("r", 1), ("q", 2)])
def test_the_angle_is_that_of_the_velocity_of_each_station(rate: str, across: int) -> None:
    table, x = turning(), np.array([-2.0, -0.8, 0.0])
    found = local_incidence(table, rate, x)
    m = table.motion
    for i in range(6):
        for k, station in enumerate(x):
            spin = [0.0, m["q"][i] if rate == "q" else 0.0, m["r"][i] if rate == "r" else 0.0]
            v = np.array([m["u"][i], m["v"][i], m["w"][i]]) + np.cross(spin, [station + 0.8, 0.0, 0.0])
            assert found[i, k] == pytest.approx(np.arctan2(v[across], v[0]), rel=1e-13)


def test_the_figure_says_where_bow_and_stern_are(suboff: Study) -> None:
    table = next(t for t in suboff.tables if t.name.endswith("rotating_arm.csv"))
    stern, nose = ends(suboff.body, table) or (0.0, 0.0)
    assert (stern, nose) == pytest.approx((-14.2917 * 0.3048, 0.0))
    made = incidence_figure(table, "r", suboff.body, "here")
    assert "Stern at −4.356 m, nose at 0 m." in made.caption.replace("-4.356", "−4.356")
    assert "4 of 6 settings are drawn" in made.caption
    series = made.panels[0].series[0]
    assert (series.x[0], series.x[-1]) == pytest.approx((stern, nose), rel=1e-5)
    for x, y in zip(series.x, series.y, strict=True):
        assert y == pytest.approx(np.degrees(np.arctan2(0.05 * (x + 2.013), 2.0)), abs=1e-4)
    assert ends(None, table) is None
    assert ends(suboff.body, replace(table, datum=Datum("cg"))) is None
    assert "No body states" in incidence_figure(table, "r", None, "here").caption


def test_a_section_draws_the_tables_that_turn_once(suboff: Study) -> None:
    fits = [f for f in suboff.fits if f.campaign == "suboff_cfd_barehull"]
    drawn = [campaign_section(suboff, f, f.fit, set()).figures for f in fits]
    assert [len(figures) for figures in drawn] == [1, 0]
    assert not any(
        campaign_section(suboff, f, "p", set()).figures for f in suboff.fits if f.campaign == "suboff_roddy_1"
    )

"""Figures and tables of a tuning."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from coeflab.identify import tuning_tables
from coeflab.identify.tuning import OK, OPEN, TunedParameter, TunedQuantity, Tuning
from coeflab.identify.tuning_figures import Groups, agreement_figure, curves_figure

N = 6
X = np.linspace(1.0, 2.0, N)


@pytest.fixture
def tuning() -> Tuning:
    quantities = tuple(
        TunedQuantity(name, unit, np.where(np.arange(N) == hole, np.nan, X), X + 0.3, X - 0.1, np.full(N, 0.1))
        for name, unit, hole in (("u", "m/s", -1), ("beta", "deg", 2))
    )
    parameters = (
        TunedParameter("side", "kg/m", 1.0, 2.0, 0.25, 0.4, OK),
        TunedParameter("mass", "kg", 1.0, 2.0, None, 0.0, OPEN),
        TunedParameter("drag", "kg/m", 3.0, 4.0, 0.5, 0.0, OK),
    )
    correlation = np.array([[1.0, np.nan, -0.85], [np.nan, np.nan, np.nan], [-0.85, np.nan, 1.0]])
    return Tuning("t", parameters, correlation, correlation, quantities, ("side and mass: only as a ratio.",),
                  np.ones(3), 1.0, 3.0, True, ("A statement.",))  # fmt: skip


def test_agreement_has_every_measured_case_before_and_after(tuning: Tuning) -> None:
    figure = agreement_figure(tuning, "agreement")
    assert "model against data" in figure.title  # data may be another simulation
    ET.fromstring(figure.svg)
    # Eleven measured of twelve, before and after, and two marks of the legend.
    assert len(re.findall(r"<use [^>]*(?:0067a8|c04f00)|<use ", figure.svg)) >= 2 * 11 + 2
    assert "nan" not in figure.svg.lower()
    assert "u 0.30 to 0.10 m/s" in figure.caption
    assert agreement_figure(tuning, "agreement").svg == figure.svg


def test_curves_name_their_groups(tuning: Tuning) -> None:
    groups = Groups(X, "command  [%]", np.arange(N) % 2, ("left 0 %", "left 20 %"))
    figure = curves_figure(tuning, groups, "curves")
    ET.fromstring(figure.svg)
    for words in ("data, left 0 %", "data, left 20 %", "model before", "model after", "command", "beta"):
        assert words in figure.svg


def test_tables(tuning: Tuning) -> None:
    rows = {row[0]: row for row in tuning_tables.parameters(tuning).rows}
    assert rows["side"][2:] == ("1.0000", "2.00", "0.25", "40 %", "determined")
    assert rows["mass"][4:] == ("-", "-", "not identifiable")
    assert tuning_tables.parameters(tuning).notes[-1] == "A statement."
    assert [row[2] for row in tuning_tables.quantities(tuning).rows] == ["6", "5"]
    assert tuning_tables.quantities(tuning).rows[0][3:] == ("0.300", "0.100", "0.100")
    assert tuning_tables.correlations(tuning).rows == (("side", "drag", "-0.85"),)
    assert tuning_tables.together(tuning).rows == (("side and mass: only as a ratio.",),)


def test_figures_tell_their_cases(tuning: Tuning) -> None:
    both = agreement_figure(tuning, "agreement").panels
    assert [(p.name_up, p.unit_up) for p in both] == [("model u", "m/s"), ("model beta", "deg")]
    assert [s.name for s in both[1].series] == ["before", "after"]
    assert len(both[1].series[0].x) == N - 1
    assert "case 3" not in both[1].series[0].notes
    groups = Groups(X, "thrust  [N]", np.arange(N) % 2, ("even", "odd"))
    u, beta = curves_figure(tuning, groups, "curves").panels
    assert (u.name_up, beta.name_up, u.name_across, u.unit_across) == ("u", "beta", "thrust", "N")
    assert u.frame[1] < beta.frame[1]
    assert [s.name for s in u.series][:3] == ["data, even", "model before, even", "model after, even"]
    assert u.series[0].y == pytest.approx(X[::2])

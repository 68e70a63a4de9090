"""Curves and points in panels, with their numbers."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.report.figures.laws import Plot, Trace, laws_figure


def made():
    x = np.linspace(-1.0, 1.0, 41)
    curve = Trace("law", x, x**3, 0)
    points = Trace("told", np.array([0.0, 0.5]), np.array([0.0, 0.125]), 1, "hollow", ("first", "second"))
    near = Trace("told", np.array([0.0, 0.5]), np.array([0.0, 0.02]), 1, "hollow")
    plots = (
        Plot("force  [N]", "speed  [m/s]", (curve, points)),
        Plot("apart  [N]", "speed  [m/s]", (near,), allowed=0.1),
    )
    return laws_figure("f", "Title", "Caption.", "Description.", plots)


def test_every_trace_has_its_numbers_and_one_entry_in_the_legend() -> None:
    figure = made()
    upper, lower = figure.panels
    assert [(s.name, s.is_curve) for s in upper.series] == [("law", True), ("told", False)]
    assert upper.series[1].notes == ("first", "second")
    assert (upper.name_up, upper.unit_up, upper.name_across, upper.unit_across) == ("force", "N", "speed", "m/s")
    assert upper.series[1].key == lower.series[0].key
    assert figure.svg.count("data-label=") == 2


def test_the_band_of_what_is_allowed_is_inside_the_panel() -> None:
    _, lower = made().panels
    assert lower.up[0] < -0.1 < 0.1 < lower.up[1]


def test_a_curve_is_what_was_given() -> None:
    series = made().panels[0].series[0]
    assert np.array(series.y) == pytest.approx(np.array(series.x) ** 3, abs=1e-6)


def test_equal_input_gives_equal_bytes() -> None:
    assert made() == made()

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


@pytest.mark.parametrize(("name", "falls"), [("depth  [m]", True), ("down  [m]", True), ("north  [m]", False)])
def test_down_points_down_on_the_page(name: str, falls: bool) -> None:
    dive = Trace("dive", np.array([0.0, 1.0]), np.array([-1.0, 2.0]), 0)
    [panel] = laws_figure("d", "Dive", "", "", [Plot(name, "time  [s]", (dive,))]).panels
    assert (panel.up[0] > panel.up[1]) == falls


@pytest.mark.parametrize(("east", "north"), [(3.0, 3.0), (40.0, 3.0), (3.0, 40.0)])
def test_a_track_from_above_has_one_scale(east: float, north: float) -> None:
    track = Trace("track", np.array([0.0, east]), np.array([0.0, north]), 0)
    [panel] = laws_figure(
        "t", "Track", "", "", [Plot("north  [m]", "east  [m]", (track,), 190.0, is_equal=True)]
    ).panels
    (_, _, wide, tall), (x0, x1), (y0, y1) = panel.frame, panel.across, panel.up
    assert wide / (x1 - x0) == pytest.approx(tall / (y1 - y0), rel=1e-3)
    assert x0 < 0.0 < east < x1
    assert y0 < 0.0 < north < y1

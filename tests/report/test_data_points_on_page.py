"""What a page tells of a drawing: every point stands where the drawing has its mark, with names and units."""

from __future__ import annotations

import re

import numpy as np
import pytest

from coeflab.identify.identified import Identified, IdentifiedTerm, Outcome
from coeflab.identify.identified_figures import identified_figure
from coeflab.motion.uncertainty.spread import Importance
from coeflab.report.document import Figure, Panel, Series
from coeflab.report.figures.motion import track_figure
from coeflab.report.figures.series import MOST, curve
from coeflab.report.figures.tornado import tornado_figure
from coeflab.report.figures.uncertainty import bars
from tests.report.studies import FULL, budgets, small_study
from tests.report.test_motion_figure import LENGTH, moved


def place(panel: Panel, x: float, y: float) -> tuple[float, float]:
    """In the units of the drawing, as the page's script puts it."""
    left, top, wide, tall = panel.frame
    across = (x - panel.across[0]) / (panel.across[1] - panel.across[0])
    up = (y - panel.up[0]) / (panel.up[1] - panel.up[0])
    return left + wide * across, top + tall * (1.0 - up)


def corners(figure: Figure) -> np.ndarray:
    """All places that paths of the drawing go through."""
    found = re.findall(r"[ML] ([-\d.]+) ([-\d.]+)", " ".join(re.findall(r' d="([^"]*)"', figure.svg)))
    return np.array(found, dtype=float)


def assert_drawn(figure: Figure, panel: Panel, series: Series) -> None:
    drawn = corners(figure)
    for x, y in zip(series.x, series.y, strict=True):
        px, py = place(panel, x, y)
        assert np.min(np.hypot(drawn[:, 0] - px, drawn[:, 1] - py)) < 0.05


@pytest.mark.parametrize("vertical", [False, True])
def test_the_track_tells_places_and_times(vertical: bool) -> None:
    figure = track_figure(moved(30.0, 20.0), "t", LENGTH, vertical)
    (panel,) = figure.panels
    (track,) = panel.series
    assert (panel.name_across, panel.unit_across) == (("north" if vertical else "east"), "m")
    assert (panel.name_up, panel.unit_up) == (("depth" if vertical else "north"), "m")
    assert (track.x[-1], track.y[-1]) == ((40.0, 20.0) if vertical else (30.0, 40.0))
    assert track.notes[0].startswith("at 0 s, ")
    assert track.notes[-1].startswith("at 10 s, ")
    assert_drawn(figure, panel, track)


def test_a_budget_tells_every_bar() -> None:
    b = budgets(small_study(FULL))[0]
    figure = tornado_figure(b, "t")
    (panel,) = figure.panels
    (told,) = panel.series
    parts = sorted(b.parts, key=lambda p: -p.half_width)
    assert panel.bars == "across"
    assert [n.partition(", ")[0] for n in told.notes] == [*(p.name for p in parts), "U95"]
    assert told.x == pytest.approx([*(p.half_width for p in parts), b.u95], rel=1e-5)
    drawn = corners(figure)
    for x, y in zip(told.x, told.y, strict=True):
        px, py = place(panel, x, y)
        beside = drawn[np.abs(drawn[:, 0] - px) < 0.05]
        assert len(beside)
        assert beside[:, 1].min() < py < beside[:, 1].max()


def test_an_identification_tells_values_as_they_are() -> None:
    terms = (
        IdentifiedTerm("Yv'", "Y", Outcome.IDENTIFIED, value=-0.03, low=-0.04, high=-0.02, frequency=1.0, file_value=-0.02,
                       file_u95=0.001),
        IdentifiedTerm("Nv'", "N", Outcome.NOT_IDENTIFIABLE, file_value=0.01),
    )  # fmt: skip
    found = Identified("boat", (), "weak_form", 0.1, 1, 10, terms, (), ())
    values, kept = identified_figure(found, "i").panels
    own, file = values.series
    assert (own.x, own.notes) == ((-1.5,), ("Yv' = -0.030000, -0.040000 to -0.020000",))
    assert (file.x, file.notes) == ((-1.0, 1.0), ("Yv' = -0.0200 ± 0.0010", "Nv' = 0.010000"))
    assert (kept.series[0].x, kept.series[0].notes, kept.unit_across) == ((100.0,), ("Yv'",), "%")


def test_shares_of_a_variance_tell_their_rows() -> None:
    figure = bars(Importance("advance", (("Yv'", 0.7), ("Nv'", 0.2))), "b")
    (panel,) = figure.panels
    (told,) = panel.series
    assert (told.x, told.notes, panel.name_across) == ((0.7, 0.2), ("Yv'", "Nv'"), "share of the variance")
    assert told.y[0] > told.y[1]
    drawn = corners(figure)
    for x in told.x:
        assert np.min(np.abs(drawn[:, 0] - place(panel, x, 0.0)[0])) < 0.05


def test_a_long_curve_is_told_in_few_values() -> None:
    x = np.linspace(0.0, 1.0, 50_001)
    told = curve("a", "a", x, x**2)
    assert len(told.x) <= MOST + 1
    assert told.y == pytest.approx(np.square(told.x), abs=2e-6)

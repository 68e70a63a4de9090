"""The drawn track against the motion: labels stand beside the marks of their values, depth grows downward."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from coeflab.motion.dynamics import from_euler
from coeflab.motion.trajectory import Ended, Trajectory
from coeflab.report.document import Figure
from coeflab.report.figures.motion import history_figures, motion_figures

LENGTH = 2.0


def moved(east: float, down: float) -> Trajectory:
    """A straight motion from the origin, 40 m north."""
    n = 41
    share = np.linspace(0.0, 1.0, n)
    return Trajectory(
        time=10.0 * share, position=np.outer(share, [40.0, east, down]), attitude=np.tile(from_euler(0.0, 0.0, 0.0), (n, 1)),
        velocity=np.tile([1.5, 0.0, 0.0, 0.0, 0.0, 0.0], (n, 1)), heading=np.zeros(n), controls={},
        phase=np.zeros(n, dtype=int), phases=("run",), reached=(None,), outside={}, ended=Ended.COMPLETE,
    )  # fmt: skip


def upright_labels(figure: Figure) -> dict[float, float]:
    """Value of every label of the upright axis and how far below the upper edge it stands."""
    placed = re.findall(r'text-anchor: end[^>]*y="([\d.]+)">([^<]*)<', figure.svg)
    return {float(text.replace("\u2212", "-")): float(y) for y, text in placed}


def start_below_edge(figure: Figure) -> float:
    """Where the dot at the start stands: the one mark without a colour of its own."""
    (dot,) = re.findall(r'<use [^>]*y="([\d.]+)"/>', figure.svg)
    return float(dot)


def test_depth_grows_downward_on_its_labels_and_the_start_stands_at_zero() -> None:
    (track, *_) = motion_figures(moved(0.0, 30.0), "m", LENGTH)
    labels = upright_labels(track)
    depths = sorted(labels)
    assert "vertical" in track.title
    assert [labels[d] for d in depths] == sorted(labels.values())
    assert 0.0 in labels
    assert labels[0.0] - start_below_edge(track) == pytest.approx(2.9, abs=0.2)


def test_north_grows_upward() -> None:
    (track, *_) = motion_figures(moved(30.0, 0.0), "m", LENGTH)
    labels = upright_labels(track)
    assert [labels[d] for d in sorted(labels)] == sorted(labels.values(), reverse=True)
    assert labels[0.0] - start_below_edge(track) == pytest.approx(2.9, abs=0.2)


def test_depth_over_time_grows_downward_too() -> None:
    depth = next(f for f in history_figures(moved(0.0, 30.0), "m") if f.title == "Depth")
    labels = upright_labels(depth)
    assert [labels[d] for d in sorted(labels)] == sorted(labels.values())


@pytest.mark.parametrize(
    ("east", "down", "planes"),
    [
        (0.0, 0.0, ["horizontal"]),
        (30.0, 0.4, ["horizontal"]),
        (0.4, 30.0, ["vertical"]),
        (20.0, 50.0, ["horizontal", "vertical"]),
    ],
)
def test_the_planes_that_are_drawn(east: float, down: float, planes: list[str]) -> None:
    titles = [f.title for f in motion_figures(moved(east, down), "m", LENGTH) if f.title.startswith("Track")]
    assert titles == [f"Track in the {p} plane" for p in planes]


def test_a_legend_of_many_tilts_is_whole() -> None:
    """Three angles and four tilts are four rows: the upper two were cut off."""
    still = moved(0.0, 30.0)
    tilts = {f"rotor{i}.tilt": np.linspace(0.0, 1.0 + i, len(still.time)) for i in range(1, 8)}
    figure = next(f for f in history_figures(replace(still, controls=tilts), "m") if f.title.startswith("Attitude"))
    placed = [float(y) for y in re.findall(r'<text [^>]*y="(-?[\d.]+)"[^>]*>rotor\d, tilt', figure.svg)]
    assert len(placed) == 7
    assert min(placed) > 8.75

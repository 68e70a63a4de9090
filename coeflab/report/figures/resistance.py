"""Straight runs: X' over the speed, with X0' and its U95."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from coeflab.fits.results.straight_runs import StraightRuns


def draw_straight_runs(axes: Axes, runs: StraightRuns) -> None:
    """Every run, and the value with U95 over the speeds that were run.

    Parameters
    ----------
    axes : Axes
    runs : StraightRuns
    """
    (points,) = axes.plot(runs.speed, runs.primes, "o", label="runs")
    colour, ends = points.get_color(), np.array([runs.speed.min(), runs.speed.max()])
    axes.plot(ends, [runs.value] * 2, color=colour, label="X0'")
    low, high = runs.value - runs.u95, runs.value + runs.u95
    axes.fill_between(ends, low, high, color=colour, alpha=0.2, linewidth=0.0, label="U95")

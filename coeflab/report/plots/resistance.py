"""Straight runs: the prime of the resistance over the speed."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from coeflab.fits.results.straight_runs import StraightRuns
from coeflab.report.plots.axes import axes_of


def plot_straight_runs(runs: StraightRuns, ax: Axes | None = None) -> Axes:
    """X' of every run, X0' and its U95 over the speeds that were run.

    Parameters
    ----------
    runs : StraightRuns
    ax : Axes, optional
    """
    axes = axes_of(ax)
    (points,) = axes.plot(runs.speed, runs.primes, "o", label="runs")
    ends = np.array([runs.speed.min(), runs.speed.max()])
    axes.plot(ends, [runs.value] * 2, color=points.get_color(), label="X0'")
    axes.fill_between(
        ends,
        runs.value - runs.u95,
        runs.value + runs.u95,
        color=points.get_color(),
        alpha=0.2,
        linewidth=0.0,
        label="U95",
    )
    axes.set_xlabel("U [m/s]")
    axes.set_ylabel("X'")
    axes.set_title(f"X0', {runs.campaign}")
    axes.legend()
    return axes

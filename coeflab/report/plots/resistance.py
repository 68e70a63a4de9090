"""Straight runs: the prime of the resistance over the speed."""

from __future__ import annotations

from matplotlib.axes import Axes

from coeflab.fits.results.straight_runs import StraightRuns
from coeflab.report.figures.resistance import draw_straight_runs
from coeflab.report.plots.axes import axes_of


def plot_straight_runs(runs: StraightRuns, ax: Axes | None = None) -> Axes:
    """X' of every run, X0' and its U95 over the speeds that were run.

    Parameters
    ----------
    runs : StraightRuns
    ax : Axes, optional
    """
    axes = axes_of(ax)
    draw_straight_runs(axes, runs)
    axes.set_xlabel("U [m/s]")
    axes.set_ylabel("X'")
    axes.set_title(f"X0', {runs.campaign}")
    axes.legend()
    return axes

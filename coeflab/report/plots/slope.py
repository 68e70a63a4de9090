"""A slope with its points and interval, and what single forms would have said."""

from __future__ import annotations

from matplotlib.axes import Axes

from coeflab.fits.results.fit_result import Sweep
from coeflab.law.symbols import primed
from coeflab.report.figures.estimator import draw_forms, frame_of
from coeflab.report.figures.series import axis_name, is_in_degrees
from coeflab.report.figures.sweep import draw_curves, draw_points
from coeflab.report.plots.axes import axes_of, palette


def plot_slope(sweep: Sweep, ax: Axes | None = None) -> Axes:
    """Points, the recommended curve and the slope at rest with U95.

    Parameters
    ----------
    sweep : Sweep
    ax : Axes, optional
    """
    axes, colours = axes_of(ax), palette()
    handles = draw_points(axes, sweep, palette=colours) + draw_curves(axes, sweep, palette=colours)
    axes.set_xlabel(axis_name(sweep).replace("  ", " "))
    axes.set_ylabel(f"{sweep.component}'")
    axes.set_title(f"{primed(sweep.symbol)}, {sweep.campaign}")
    axes.legend(handles=handles)
    return axes


def plot_forms(sweep: Sweep, ax: Axes | None = None) -> Axes:
    """Every family over growing ranges about the recommended value.

    Parameters
    ----------
    sweep : Sweep
    ax : Axes, optional
    """
    axes = axes_of(ax)
    axes.set_ylim(*frame_of(sweep))
    draw_forms(axes, sweep, palette=palette())
    axes.set_xlabel("largest angle used [deg]" if is_in_degrees(sweep) else f"largest |{sweep.variable}'| used")
    axes.set_ylabel(primed(sweep.symbol))
    return axes

"""A slope with its points and interval, and what single forms would have said."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes

from coeflab.fits.results.fit_result import Sweep
from coeflab.law.symbols import primed
from coeflab.law.terms import read_term
from coeflab.report.figures.estimator import draw_forms, frame_of
from coeflab.report.figures.series import axis_name, is_in_degrees, on_axis, tagged
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


FINE = 121


def plot_tied(
    sweep: Sweep,
    symbol: str,
    law: Mapping[str, float],
    window: tuple[float, float],
    at_rest: float,
    ax: Axes | None = None,
) -> Axes:
    """The points of a sweep and the force law over the range that it was fitted to.

    Parameters
    ----------
    sweep : Sweep
    symbol : str
        Of the term, for the title.
    law : mapping of str to float
        Primed coefficients of one variable by symbol, the slope among them.
    window : (float, float)
        Of the variable, primed.
    at_rest : float
        Primed force of the set-up, which no coefficient holds.
    ax : Axes, optional
    """
    axes, colours = axes_of(ax), palette()
    x = np.linspace(*window, FINE)
    columns = {sweep.variable: x}
    y = at_rest + sum(value * read_term(s, symbol).term.evaluate(columns) for s, value in law.items())
    handles = draw_points(axes, sweep, palette=colours)
    drawn = axes.plot(
        on_axis(sweep, x), y, color=colours["b"], linewidth=1.4, label=" + ".join(map(primed, law)), zorder=2.5
    )
    axes.set_xlabel(axis_name(sweep).replace("  ", " "))
    axes.set_ylabel(f"{sweep.component}'")
    axes.set_title(f"{primed(symbol)}, {sweep.campaign}")
    axes.legend(handles=[*handles, *tagged(drawn, "law")])
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

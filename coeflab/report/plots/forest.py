"""Coefficients with their intervals, one below the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from coeflab.report.figures.first_page import draw_intervals
from coeflab.report.plots.axes import axes_of, palette

Interval = tuple[float | None, float | None]
STEP = 0.16


def plot_forest(
    rows: Sequence[tuple[str, Sequence[Interval]]], names: Sequence[str] = (), ax: Axes | None = None
) -> Axes:
    """Values with U95, each over the size of the first value of its row; a bar that reaches zero leaves the sign open.

    Parameters
    ----------
    rows : sequence of (symbol, intervals)
        Value and U95 of every series; None where there is none.
    names : sequence of str
        Of the series, for the legend.
    ax : Axes, optional
    """
    axes, colours = axes_of(ax), palette()
    y = np.arange(len(rows))[::-1].astype(float)
    count = max((len(found) for _, found in rows), default=0)
    sizes = [abs(found[0][0] or 0.0) or max((abs(v or 0.0) for v, _ in found), default=0.0) or 1.0 for _, found in rows]
    handles = []
    for k in range(count):
        at = [i for i, (_, found) in enumerate(rows) if k < len(found) and found[k][0] is not None]
        value = np.array([(rows[i][1][k][0] or 0.0) / sizes[i] for i in at])
        half = np.array([(rows[i][1][k][1] or 0.0) / sizes[i] for i in at])
        offset = (0.5 * (count - 1) - k) * STEP
        handles.append(draw_intervals(axes, value, half, y[at] + offset, f"s{k}", colours["abcd"[k % 4]]))
    axes.axvline(0.0, color=colours["muted"], linewidth=0.8)
    axes.set_yticks(y, [symbol for symbol, _ in rows])
    axes.set_xlabel("value over its size, with U95")
    if names and rows:
        axes.legend(handles=handles, labels=list(names))
    return axes

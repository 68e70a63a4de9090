"""One panel of a figure: a ruled frame with few ticks.

Ticks and labels are drawn here rather than by Matplotlib's axes, which takes half the time of a whole report.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.markers import TICKDOWN, TICKLEFT
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from coeflab.presentation.plotted import mark_legend
from coeflab.presentation.svg import COLOURS, POINTS

Array = NDArray[np.float64]
WIDTH, HEIGHT = 340.0, 336.0
LEFT, RIGHT, BOTTOM, GAP = 52.0, 10.0, 34.0, 16.0
LEGEND_ROW, LEGEND_ROWS = 12.2, 4
TOP = HEIGHT - 4.0 - LEGEND_ROW * LEGEND_ROWS - 8.0
Range = tuple[float, float]


def drawing(height: float = HEIGHT) -> Figure:
    """An empty figure of the report's width."""
    return Figure(figsize=(WIDTH / POINTS, height / POINTS))


def height_of(figure: Figure) -> float:
    """Height of a figure in points."""
    return float(figure.get_figheight()) * POINTS


def limits(values: Array, margin: float) -> Range | None:
    """Range of the finite values with a margin; None where there are none."""
    finite = values[np.isfinite(values)]
    if not len(finite):
        return None
    low, high = float(finite.min()), float(finite.max())
    room = margin * (high - low) or 0.1 * abs(high) or 1.0
    return low - room, high + room


def ticks(within: Range, most: int) -> Array:
    """Round values inside a range, rising even where the range falls (a depth, which grows downward)."""
    low, high = min(within), max(within)
    at = np.asarray(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high), dtype=float)
    room = 1e-9 * (high - low)
    return at[(at >= low - room) & (at <= high + room)]


def tick_texts(at: Array) -> list[str]:
    """Ticks with as many decimals as tell them apart."""
    if len(at) < 2:
        return [f"{t:g}".replace("-", "−") for t in at]
    decimals = next((d for d in range(9) if np.allclose(np.round(at, d), at, rtol=0, atol=1e-4 * (at[1] - at[0]))), 9)
    return [f"{t + 0.0:.{decimals}f}".replace("-", "−") for t in np.round(at, decimals)]


def panel(
    figure: Figure,
    bottom: float,
    height: float,
    *,
    across: Range,
    up: Range,
    name_up: str,
    name_across: str = "",
    most_up: int = 5,
) -> Axes:
    """A ruled panel.

    Parameters
    ----------
    figure : Figure
    bottom, height : float
        Points from the lower edge.
    across, up : (float, float)
        Ranges of the two axes.
    name_up, name_across : str
        Labels; without ``name_across`` the axis has ticks only.
    most_up : int
        Largest number of steps of the upright axis.
    """
    width, whole = WIDTH - LEFT - RIGHT, height_of(figure)
    axes = figure.add_axes((LEFT / WIDTH, bottom / whole, width / WIDTH, height / whole))
    axes.set_axis_off()
    axes.set_xlim(*across)
    axes.set_ylim(*up)
    at_x, at_y = ticks(across, 7), ticks(up, most_up)
    axes.hlines(at_y, *across, color=COLOURS["rule"], linewidth=0.5, zorder=0)
    thin: dict[str, Any] = {"color": COLOURS["muted"], "clip_on": False, "zorder": 1.5}
    axes.plot([across[0], across[0], across[1]], [up[1], up[0], up[0]], linewidth=0.6, **thin)
    for x, y, mark in (
        (at_x, np.full_like(at_x, up[0]), TICKDOWN),
        (np.full_like(at_y, across[0]), at_y, TICKLEFT),
    ):
        axes.plot(x, y, linestyle="none", marker=mark, markersize=3.0, markeredgewidth=0.6, **thin)
    for y, text in zip(at_y, tick_texts(at_y), strict=True):
        level = bottom + height * (float(y) - up[0]) / (up[1] - up[0])
        figure.text((LEFT - 5.5) / WIDTH, (level - 2.9) / whole, text, ha="right", va="baseline")
    figure.text(
        9.5 / WIDTH, (bottom + height / 2.0) / whole, name_up, rotation=90, ha="center", va="center",
        rotation_mode="anchor",
    )  # fmt: skip
    if name_across:
        for x, text in zip(at_x, tick_texts(at_x), strict=True):
            place = LEFT + width * (float(x) - across[0]) / (across[1] - across[0])
            figure.text(place / WIDTH, (bottom - 13.5) / whole, text, ha="center", va="baseline")
        figure.text((LEFT + width / 2.0) / WIDTH, (bottom - 27.5) / whole, name_across, ha="center", va="baseline")
    return axes


def heading(figure: Figure, above: float, text: str) -> None:
    """A small title over a panel whose upper edge is ``above`` points from the lower edge of the figure."""
    figure.text(LEFT / WIDTH, (above + 4.0) / height_of(figure), text, color=COLOURS["muted"], va="baseline")


def legend(figure: Figure, handles: list[Any], above: float = TOP) -> None:
    """One legend in two columns above the panels, whose upper edge is ``above`` points from the lower edge.

    Entries of handles that `coeflab.presentation.plotted.tagged` marked are marked in the drawing.
    """
    drawn = figure.legend(
        handles=handles,
        loc="lower left",
        bbox_to_anchor=((LEFT - 16.0) / WIDTH, (above + 8.0) / height_of(figure)),
        ncols=2,
        borderpad=0.0,
        borderaxespad=0.0,
        handlelength=2.5,
        handletextpad=0.6,
        columnspacing=1.0,
        labelspacing=0.38,
    )
    mark_legend(drawn, handles)

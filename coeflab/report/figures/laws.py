"""Curves and points over one axis, in panels one below the other: force laws, and what was found beside what was printed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from coeflab.core.types import Array, dataclass, locking
from coeflab.report.document import Figure, Panel
from coeflab.report.figures.palette import COLOURS, recoloured
from coeflab.report.figures.panel import BOTTOM, GAP, LEFT, LEGEND_ROW, RIGHT, WIDTH, drawing, legend, limits, panel
from coeflab.report.figures.series import STYLES, Style, curve, numbers, points, tagged
from coeflab.report.figures.svg import settings, svg_text

SCALED = 26.0
DOWNWARDS = ("depth", "down")
PLAIN = Style(COLOURS["ink"], "-", "o")


@dataclass(frozen=True, slots=True, eq=False)
@locking("x y")
class Trace:
    """A curve, or points.

    Attributes
    ----------
    name : str
        As the legend says it; traces of one name are one entry in all panels.
    x, y : (n,) array
        In the units of the panel.
    style : int
        Colour, line and marker: traces of one style belong together. Below zero: a plain line in the colour of the text.
    form : str
        ``curve``, ``filled`` or ``hollow`` points.
    notes : tuple of str
        One a point.
    """

    name: str
    x: Array
    y: Array
    style: int
    form: str = "curve"
    notes: tuple[str, ...] = ()

    @property
    def look(self) -> dict[str, Any]:
        """For Matplotlib; form and marker tell it apart without colour."""
        style = STYLES[self.style] if self.style >= 0 else PLAIN
        if self.form == "curve":
            return {"color": style.colour, "linestyle": style.line, "linewidth": 1.3}
        filled = self.form == "filled"
        return {
            "linestyle": "none", "marker": style.marker, "markersize": 3.2 if filled else 5.6,
            "markerfacecolor": style.colour if filled else "none", "markeredgecolor": style.colour,
            "markeredgewidth": 0.0 if filled else 0.8,
        }  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Plot:
    """One panel.

    Attributes
    ----------
    name_up, name_across : str
        Labels, ``name  [unit]``. What is called depth or down grows downwards on the page.
    traces : tuple of Trace
    height : float
        Points.
    allowed : float or None
        Half-width of a band about zero.
    is_scaled : bool
        Whether the axis across has texts; otherwise the panel below carries them.
    is_equal : bool
        One scale on both axes: a track seen from above.
    """

    name_up: str
    name_across: str
    traces: tuple[Trace, ...]
    height: float = 110.0
    allowed: float | None = None
    is_scaled: bool = True
    is_equal: bool = False


def laws_figure(anchor: str, title: str, caption: str, description: str, plots: Sequence[Plot]) -> Figure:
    """Panels from above, with one legend.

    Parameters
    ----------
    anchor, title, caption, description : str
    plots : sequence of Plot
    """
    named: dict[str, Trace] = {}
    for plot in plots:
        for trace in plot.traces:
            named.setdefault(trace.name, trace)
    keys = {name: f"law{i}" for i, name in enumerate(named)}
    rooms = [GAP + (SCALED if plot.is_scaled else 0.0) for plot in plots]
    body = sum(p.height for p in plots) + sum(rooms) - rooms[-1]
    with settings():
        figure = drawing(BOTTOM + body + 10.0 + LEGEND_ROW * ((len(named) + 1) // 2))
        bottom, panels = BOTTOM + body, []
        for plot, room in zip(plots, rooms, strict=True):
            bottom -= plot.height
            across, up = _frame(plot)
            axes = panel(
                figure, bottom, plot.height, across=across, up=up, name_up=plot.name_up,
                name_across=plot.name_across if plot.is_scaled else "", most_up=5 if plot.height > 90.0 else 3,
            )  # fmt: skip
            panels.append(_drawn(axes, plot, keys))
            bottom -= room
        handles = [tagged(Line2D([], [], label=name, **t.look), keys[name]) for name, t in named.items()]
        legend(figure, handles, BOTTOM + body)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, caption, description, tuple(panels))


def _frame(plot: Plot) -> tuple[tuple[float, float], tuple[float, float]]:
    """Both ranges; of what grows downwards the upright one is from below to above on the page."""
    (x0, x1), (y0, y1) = limits(np.concatenate([t.x for t in plot.traces]), 0.04) or (0.0, 1.0), _up(plot)
    if plot.is_equal:
        ratio = (WIDTH - LEFT - RIGHT) / plot.height
        wide = max(x1 - x0, ratio * (y1 - y0))
        (x0, x1), (y0, y1) = (
            ((a + b - w) / 2.0, (a + b + w) / 2.0) for a, b, w in ((x0, x1, wide), (y0, y1, wide / ratio))
        )
    return (x0, x1), (y1, y0) if plot.name_up.split("  ")[0] in DOWNWARDS else (y0, y1)


def _up(plot: Plot) -> tuple[float, float]:
    seen = [t.y for t in plot.traces] + ([] if plot.allowed is None else [np.array([-plot.allowed, plot.allowed])])
    return limits(np.concatenate(seen), 0.08) or (-1.0, 1.0)


def draw_trace(axes: Axes, trace: Trace, key: str, palette: Mapping[str, str] = COLOURS) -> list[Any]:
    """A curve or points; returns what a legend shows.

    Parameters
    ----------
    axes : Axes
    trace : Trace
    key : str
        Of its series.
    palette : mapping of str to str
        A colour for each name of `COLOURS`.
    """
    look: dict[str, Any] = {name: recoloured(v, palette) if isinstance(v, str) else v for name, v in trace.look.items()}
    drawn: list[Any] = axes.plot(trace.x, trace.y, zorder=2.5 if trace.form == "curve" else 3.0, **look)
    return list(tagged(drawn, key))


def _drawn(axes: Axes, plot: Plot, keys: dict[str, str]) -> Panel:
    low, high = sorted(axes.get_ylim())
    if plot.allowed is not None:
        axes.axhspan(-plot.allowed, plot.allowed, color=COLOURS["band"], alpha=0.25, linewidth=0, zorder=0.2)
    if low < 0.0 < high:
        axes.axhline(0.0, color=COLOURS["muted"], linewidth=0.6, zorder=1)
    series = []
    for t in plot.traces:
        key = keys[t.name]
        draw_trace(axes, t, key)
        series.append(curve(key, t.name, t.x, t.y) if t.form == "curve" else points(key, t.name, t.x, t.y, t.notes))
    return numbers(axes, series, plot.name_across, plot.name_up)

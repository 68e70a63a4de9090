"""Figures of an uncertainty run: the members of each figure as a histogram, and where its variance comes from as bars."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from coeflab.core.types import Array
from coeflab.motion.uncertainty.spread import Importance, Spread
from coeflab.motion.uncertainty.uncertainty import Carried
from coeflab.report.document import Figure, Series
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, drawing, legend, panel, row_panel
from coeflab.report.figures.series import numbers, points
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.notation import as_users_wrote
from coeflab.report.tables.uncertainty import SMALL, shown_unit
from coeflab.report.texts import text_of

TALL, LEGEND = 220.0, 32.0
LEFT, RIGHT, ROW, THICK = 124.0, 44.0, 18.0, 0.6
LONGEST, MOST_BARS = 21, 8
BINS = 24
Bar = tuple[str, float, tuple[float, float], float | None]


@as_users_wrote
def uncertainty_figures(carried: Carried) -> tuple[tuple[Figure, ...], ...]:
    """A row a figure of the manoeuvre that has an interval: histogram and bars."""
    found = {i.figure: i for i in carried.importances}
    rows = []
    for k, s in enumerate(carried.spreads):
        if s.status != "ok" or s.figure.name not in carried.names:
            continue
        row = [histogram(s, carried.sample(s.figure.name), f"u{k}")]
        if found[s.figure.name].shares or found[s.figure.name].known:
            row.append(bars(found[s.figure.name], f"b{k}"))
        rows.append(tuple(row))
    return tuple(rows)


def histogram(s: Spread, sample: Array, anchor: str) -> Figure:
    """Members over the value, with the interval shaded and the value of the file.

    Parameters
    ----------
    s : Spread
        With an interval.
    sample : (n,) array
    anchor : str
    """
    factor, unit = shown_unit(s.figure.unit)
    values = sample * factor
    low, high = (float(v) for v in np.percentile(values, [0.2, 99.8]))
    room = 0.04 * (high - low) or 1e-9 * abs(high) or 1.0
    across = low - room, high + room
    counts, edges = np.histogram(values, BINS, across)
    up = 0.0, 1.08 * float(counts.max())
    title = f"{s.figure.name}: {len(values)} members"
    ends = (s.low or 0.0) * factor, (s.high or 0.0) * factor
    description = f"Histogram of {s.figure.name}: 95 % between {ends[0]:.4g} and {ends[1]:.4g} {unit}."
    with settings():
        figure = drawing(TALL)
        name = f"{s.figure.name}  [{unit}]" if unit else s.figure.name
        axes = panel(figure, BOTTOM, TALL - BOTTOM - LEGEND, across=across, up=up, name_up="members", name_across=name)
        axes.axvspan(*ends, color=COLOURS["band"], alpha=0.28, linewidth=0.0, zorder=0.5)
        axes.bar(edges[:-1], counts, np.diff(edges) * 0.92, align="edge", color=COLOURS["a"], zorder=2)
        handles: list[Any] = [Patch(color=COLOURS["band"], alpha=0.28, linewidth=0.0, label="95 % interval")]
        if s.figure.value is not None:
            axes.axvline(s.figure.value * factor, color=COLOURS["b"], linewidth=1.4, zorder=3)
            handles.append(Line2D([], [], color=COLOURS["b"], linewidth=1.4, label="values of the file"))
        legend(figure, handles, TALL - LEGEND)
        ranges = [f"{a:.4g} to {b:.4g}{f' {unit}' if unit else ''}" for a, b in itertools.pairwise(edges)]
        words = points("members", "members in the bar", (edges[:-1] + edges[1:]) / 2.0, counts + 0.0, ranges)
        shown = numbers(axes, (words,), name, "members", bars="up")
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, f"{title}; the outermost 0.4 % lie outside of the axis.", description, (shown,))


def bars(found: Importance, anchor: str) -> Figure:
    """First-order and total indices of groups; shares of single coefficients where there are no groups.

    Parameters
    ----------
    found : Importance
    anchor : str
    """
    grouped = bool(found.shares)
    rows: list[Bar] = [(s, v, (v, v), None) for s, v in found.known]
    if grouped:
        rows = [
            (_label(s.symbols), s.first, s.first_bounds, s.total) for s in found.shares if s.total_bounds[1] >= SMALL
        ]
    rows = rows[:MOST_BARS]
    title = f"{found.figure}: where its variance comes from"
    description = "; ".join(f"{label} {value:.2f}" for label, value, _, _ in rows) + "."
    height = max(BOTTOM + LEGEND + ROW * max(len(rows), 1), TALL)
    with settings():
        figure = drawing(height)
        name = "Sobol index" if grouped else "share of the variance"
        axes = _draw(figure, rows, height, name)
        own = "first order" if grouped else "if known exactly"
        shown = numbers(axes, _bar_ends(rows, own, axes.get_ylim()[1] - 0.5), name, "", bars="across")
        handles: list[Any] = [Patch(color=COLOURS["a"], linewidth=0.0, label=own)]
        if grouped:
            handles.append(Patch(color=COLOURS["band"], linewidth=0.0, label="total"))
            handles.append(Line2D([], [], color=COLOURS["ink"], linewidth=0.9, label="95 % of first order"))
        legend(figure, handles, height - LEGEND)
        svg = svg_text(figure, anchor, title, description)
    meant = (
        "First-order and total Sobol indices of groups of correlated numbers."
        if grouped
        else text_of("uncertainty_figures.known")
    )
    return Figure(anchor, svg, title, meant, description, (shown,))


def _bar_ends(rows: list[Bar], own: str, top: float) -> list[Series]:
    """The ends of the bars, the upper row first."""
    at = top - np.arange(len(rows))
    spans = ["" if a == b else f", 95 % {a:.2f} to {b:.2f}" for _, _, (a, b), _ in rows]
    out = [points("own", own, np.array([r[1] for r in rows]), at, [r[0] + s for r, s in zip(rows, spans, strict=True)])]
    total = np.array([np.nan if r[3] is None else r[3] for r in rows])
    return [*out, points("total", "total", total, at, [r[0] for r in rows])]


def _label(symbols: tuple[str, ...]) -> str:
    whole = " ".join(symbols)
    if len(whole) <= LONGEST:
        return whole
    selected = [s for k, s in enumerate(symbols) if len(" ".join(symbols[: k + 1])) <= LONGEST - 5]
    return f"{' '.join(selected)} + {len(symbols) - len(selected)}"


def _draw(figure: Drawing, rows: list[Bar], height: float, name: str) -> Axes:
    reach = max([0.2, *(max(first, bounds[1], total or 0.0) for _, first, bounds, total in rows)]) * 1.04
    count = max(len(rows), int((height - BOTTOM - LEGEND) / (2.0 * ROW)))
    named = [(label, f"{max(first, 0.0):.2f}") for label, first, _, _ in rows]
    axes = row_panel(figure, (LEFT, RIGHT, BOTTOM, LEGEND), (0.0, reach), named, count, name)
    for k, (_, first, bounds, total) in enumerate(rows):
        y = count - 1.0 - k
        if total is not None:
            axes.barh(y, max(total, 0.0), height=THICK, color=COLOURS["band"], zorder=1.5)
            axes.plot(np.clip(bounds, 0.0, None), [y, y], color=COLOURS["ink"], linewidth=0.9, zorder=4)
        axes.barh(y, max(first, 0.0), height=THICK * (0.5 if total is not None else 1.0), color=COLOURS["a"], zorder=2)
    return axes

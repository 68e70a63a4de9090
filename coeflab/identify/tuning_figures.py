"""Figures of a tuned model: the data, and what the model gave before and after."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from coeflab.core.table import number
from coeflab.core.types import Array, brief
from coeflab.core.wording import listed
from coeflab.identify.tuning import TunedQuantity, Tuning
from coeflab.report.document import Figure, Panel, Series
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, drawing, legend, limits, panel
from coeflab.report.figures.series import STYLES, curve, numbers, points, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.notation import as_users_wrote

TALL, APART, NAMED, HEAD, ROW = 118.0, 26.0, 40.0, 12.0, 12.2
BEFORE: dict[str, Any] = {
    "linestyle": "none", "marker": "o", "markersize": 4.2, "markerfacecolor": "none", "markeredgecolor": COLOURS["b"],
    "markeredgewidth": 0.8,
}  # fmt: skip
AFTER: dict[str, Any] = {
    "linestyle": "none", "marker": "o", "markersize": 3.6, "markerfacecolor": COLOURS["a"], "markeredgewidth": 0.0,
}  # fmt: skip
BARE: dict[str, Any] = {"linewidth": 0.9, "linestyle": (0, (3.0, 2.2))}


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Groups:
    """Cases as curves: where each lies on the axis, and to which curve it belongs.

    Attributes
    ----------
    x : (n,) array
    name_x : str
        Label of the axis.
    member : (n,) int array
        Number of the curve.
    names : tuple of str
        Of the curves.
    """

    x: Array
    name_x: str
    member: NDArray[np.int_]
    names: tuple[str, ...]


@as_users_wrote
def agreement_figure(tuning: Tuning, anchor: str) -> Figure:
    """Model against data, one panel a quantity: on the line they agree."""
    title = f"{tuning.name}: model against data, before and after"
    caption = f"Every case of {_named(tuning)}. {_scatter(tuning)} On the line the model gives the data."
    description = f"Points of {_named(tuning)}, model over measurement, before (hollow) and after (filled) the fit."
    marks = [tagged(Line2D([], [], label=key, **style), key) for key, style in (("before", BEFORE), ("after", AFTER))]
    panels: list[Panel] = []
    with settings():
        tall = len(tuning.quantities) * (TALL + NAMED) + HEAD + ROW
        figure = drawing(tall)
        for k, q in enumerate(tuning.quantities):
            bottom = tall - HEAD - ROW - TALL - k * (TALL + NAMED)
            both = limits(np.concatenate([q.measured, q.after, q.before]), 0.06) or (-1.0, 1.0)
            across = limits(q.measured, 0.06) or (-1.0, 1.0)
            along, upright = f"data {q.name}  [{q.unit}]", f"model {q.name}  [{q.unit}]"
            axes = panel(figure, bottom, TALL, across=across, up=both, name_up=upright, name_across=along)
            axes.plot(across, across, color=COLOURS["muted"], linewidth=0.8, zorder=1)
            tagged(axes.plot(q.measured, q.before, zorder=2.5, **BEFORE), "before")
            tagged(axes.plot(q.measured, q.after, zorder=3, **AFTER), "after")
            cases = [f"case {i + 1}" for i in range(len(q.measured))]
            words = (points(key, key, q.measured, y, cases) for key, y in (("before", q.before), ("after", q.after)))
            panels.append(numbers(axes, words, along, upright))
        legend(figure, marks, tall - HEAD - ROW)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, caption, description, tuple(panels))


@as_users_wrote
def curves_figure(tuning: Tuning, groups: Groups, anchor: str) -> Figure:
    """Every quantity over one variable, one curve a group: the data as points, the model before (dashed) and after."""
    title = f"{tuning.name}: {_named(tuning)} over {groups.name_x.partition('  ')[0]}"
    caption = f"Points: data. Dashed: model before, solid: after. {_scatter(tuning)}"
    description = f"{_named(tuning)} over {groups.name_x.partition('  ')[0]} in curves of {', '.join(groups.names)}."
    marks = [
        Line2D([], [], label=f"data, {name}", color=style.colour, linestyle="none", marker=style.marker, markersize=3.8)
        for name, style in zip(groups.names, STYLES, strict=False)
    ]
    marks += [
        Line2D([], [], label="model before", color=COLOURS["ink"], **BARE),
        Line2D([], [], label="model after", color=COLOURS["ink"], linewidth=1.3),
    ]
    for key, mark in zip((*(f"group{k}" for k in range(len(marks) - 2)), "before", "after"), marks, strict=True):
        tagged(mark, key)
    panels: list[Panel] = []
    rows = (len(marks) + 1) // 2
    across = limits(groups.x, 0.04) or (-1.0, 1.0)
    with settings():
        tall = BOTTOM + len(tuning.quantities) * TALL + (len(tuning.quantities) - 1) * APART + HEAD + rows * ROW
        figure = drawing(tall)
        for k, q in enumerate(reversed(tuning.quantities)):
            up = limits(np.concatenate([q.measured, q.after, q.before]), 0.08) or (-1.0, 1.0)
            axes = panel(
                figure, BOTTOM + k * (TALL + APART), TALL, across=across, up=up, name_up=f"{q.name}  [{q.unit}]",
                name_across=groups.name_x if k == 0 else "",
            )  # fmt: skip
            panels.append(numbers(axes, _curves(axes, q, groups), groups.name_x, f"{q.name}  [{q.unit}]"))
        legend(figure, marks, tall - HEAD - rows * ROW)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, caption, description, tuple(reversed(panels)))


def _curves(axes: Axes, q: TunedQuantity, groups: Groups) -> list[Series]:
    """Draws every group; its numbers."""
    words: list[Series] = []
    for number_, style in zip(range(len(groups.names)), STYLES, strict=False):
        mine = np.flatnonzero(groups.member == number_)
        mine = mine[np.argsort(groups.x[mine], kind="stable")]
        x = groups.x[mine]
        key, name = f"group{number_}", groups.names[number_]
        tagged(axes.plot(x, q.before[mine], color=style.colour, zorder=2.2, **BARE), "before")
        tagged(axes.plot(x, q.after[mine], color=style.colour, linewidth=1.3, zorder=2.6), "after")
        dots = axes.plot(
            x, q.measured[mine], linestyle="none", marker=style.marker, markersize=3.8, markerfacecolor=style.colour,
            markeredgewidth=0.0, zorder=3,
        )  # fmt: skip
        tagged(dots, key)
        words.append(points(key, f"data, {name}", x, q.measured[mine]))
        words.append(curve("before", f"model before, {name}", x, q.before[mine]))
        words.append(curve("after", f"model after, {name}", x, q.after[mine]))
    return words


def _named(tuning: Tuning) -> str:
    return listed([q.name for q in tuning.quantities])


def _scatter(tuning: Tuning) -> str:
    words = [f"{q.name} {number(q.rms(after=False), 2)} to {number(q.rms(), 2)} {q.unit}" for q in tuning.quantities]
    return f"Root mean square before and after: {', '.join(words)}."

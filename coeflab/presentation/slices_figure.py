"""The figure of slices of a surface: curves over one variable at several values of the other, with their points."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.lines import Line2D

from coeflab.model.fitted_model import FittedModel
from coeflab.presentation.document import Figure, Series
from coeflab.presentation.panel import BOTTOM, drawing, legend, limits, panel
from coeflab.presentation.plotted import curve, numbers, points, tagged
from coeflab.presentation.series import STYLES
from coeflab.presentation.svg import settings, svg_text
from coeflab.presentation.variables import (
    axis_name,
    moving,
    response_name,
    response_unit,
    scale_of,
    shown_values,
    symbol_of,
    unit_of,
)

FIELD, LEGEND = 250.0, 34.0
FINE = 121
FEWEST = 4
SAME = 1e-4


def slices_of(model: FittedModel) -> tuple[float, ...]:
    """Up to four values of the second variable at which a grid of data has points enough, evenly among all of them."""
    x, second = (model.x[v] for v in moving(model)[:2])
    reach = SAME * float(np.ptp(second))
    steps = np.round(second / reach) * reach
    found = [float(s) for s in np.unique(steps) if len(np.unique(np.round(x[steps == s], 6))) >= FEWEST]
    if len(found) < 2:
        return ()
    chosen = np.unique(np.round(np.linspace(0, len(found) - 1, len(STYLES))).astype(int))
    return tuple(found[i] for i in chosen)


def slices_figure(model: FittedModel, anchor: str) -> Figure:
    """Curves and points at the values of `slices_of`.

    Parameters
    ----------
    model : FittedModel
    anchor : str
    """
    first, second = moving(model)[:2]
    factor, power = scale_of(model.y)
    name = response_name(model)
    levels = slices_of(model)
    title = f"{name}, {model.campaign}: slices at values of {symbol_of(second, model)}"
    near = SAME * float(np.ptp(model.x[second]))
    rows = [np.abs(model.x[second] - level) <= near for level in levels]
    seen = np.concatenate([model.y[r] for r in rows])
    description = _description(model, levels)
    with settings():
        figure = drawing(BOTTOM + FIELD + 8.0 + LEGEND)
        axes = panel(
            figure, BOTTOM, FIELD, across=limits(shown_values(first, model.x[first]), 0.04) or (-1.0, 1.0),
            up=limits(seen * factor, 0.06) or (-1.0, 1.0), name_up=f"{name}{power}  [{response_unit(model)}]",
            name_across=axis_name(first, model),
        )  # fmt: skip
        handles: list[Any] = []
        told: list[Series] = []
        for i, (level, mine, style) in enumerate(zip(levels, rows, STYLES, strict=False)):
            fine = np.linspace(model.x[first].min(), model.x[first].max(), FINE)
            columns = {v: np.zeros_like(fine) for v in model.domain.variables}
            values, _, inside = model.evaluate(columns | {first: fine, second: np.full_like(fine, level)})
            look: dict[str, Any] = {"color": style.colour, "linewidth": 1.3, "linestyle": style.line}
            mark: dict[str, Any] = {
                "marker": style.marker,
                "markersize": 3.6,
                "markerfacecolor": "none",
                "markeredgewidth": 0.9,
            }
            seen_at, curved = shown_values(first, model.x[first][mine]), np.where(inside, values, np.nan)
            tagged(axes.plot(shown_values(first, fine), curved * factor, zorder=2.5, **look), f"slice{i}")
            markers = axes.plot(
                seen_at, model.y[mine] * factor, zorder=4,
                **(mark | {"linestyle": "none", "markeredgecolor": style.colour}),
            )  # fmt: skip
            tagged(markers, f"slice{i}")
            label = f"{symbol_of(second, model)} = {_spoken(model, second, level)}"
            handles += tagged([Line2D([], [], label=label, markeredgecolor=style.colour, **mark, **look)], f"slice{i}")
            labels = [f"point {model.labels[j]}" for j in np.flatnonzero(mine)]
            told.append(points(f"slice{i}", label, seen_at, model.y[mine], labels))
            told.append(curve(f"slice{i}", f"{label}, fit", shown_values(first, fine), curved))
        legend(figure, handles, BOTTOM + FIELD)
        shown = numbers(axes, told, axis_name(first, model), f"{name}  [{response_unit(model)}]", factor)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, _caption(model), description, (shown,))


def _spoken(model: FittedModel, variable: str, level: float) -> str:
    shown = float(shown_values(variable, np.array([level]))[0])
    unit = unit_of(variable, model)
    return f"{round(shown, 2) + 0.0:g}".replace("-", "−") + (f" {unit}" if unit != "-" else "")


def _caption(model: FittedModel) -> str:
    first, second = (symbol_of(v, model) for v in moving(model)[:2])
    return (
        f"Slices of the same surface: {response_name(model)} against {first} at values of {second}, curves with the points "
        "of each slice."
    )


def _description(model: FittedModel, levels: tuple[float, ...]) -> str:
    first, second = moving(model)[:2]
    each = ", ".join(_spoken(model, second, x) for x in levels)
    return (
        f"{response_name(model)} over {axis_name(first, model).replace('  ', ' ')}: curves and points at "
        f"{symbol_of(second, model)} = {each}."
    )

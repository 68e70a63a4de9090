"""The figure of slices of a surface: curves over one variable at several values of the other, with their points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from coeflab.fits.results.fitted_model import FittedModel
from coeflab.report.document import Figure, Series
from coeflab.report.figures.law_along import others_at_rest
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, drawing, legend, limits, panel
from coeflab.report.figures.series import STYLES, curve, numbers, points, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.figures.variables import (
    axis_name,
    moving,
    response_name,
    response_unit,
    scale_of,
    shown_values,
    symbol_of,
    unit_of,
)
from coeflab.report.texts import text_of

SLICE_FIELD, SLICE_LEGEND = 250.0, 34.0
SLICE_FINE = 121
FEWEST_SLICES = 4
SAME_SLICE = 1e-4


def slices_of(model: FittedModel, names: Sequence[str] = ()) -> tuple[float, ...]:
    """Up to four values of the second variable at which a grid of data has points enough, evenly among all of them.

    Parameters
    ----------
    model : FittedModel
    names : sequence of str
        Two variables, the others at rest; the first two that move unless given.
    """
    first, second = names or moving(model)[:2]
    rows = others_at_rest(model, model.x, first, second)
    x, levels = model.x[first][rows], model.x[second][rows]
    reach = SAME_SLICE * float(np.ptp(model.x[second]))
    steps = np.round(levels / reach) * reach
    found = [float(s) for s in np.unique(steps) if len(np.unique(np.round(x[steps == s], 6))) >= FEWEST_SLICES]
    if len(found) < 2:
        return ()
    chosen = np.unique(np.round(np.linspace(0, len(found) - 1, len(STYLES))).astype(int))
    return tuple(found[i] for i in chosen)


def draw_slices(
    axes: Axes, model: FittedModel, names: Sequence[str], factor: float = 1.0, palette: Mapping[str, str] = COLOURS
) -> tuple[list[Any], list[Series]]:
    """Curves and points over one variable at the values of `slices_of` of another one; marks for a legend, and the numbers.

    Parameters
    ----------
    axes : Axes
    model : FittedModel
    names : sequence of str
        The two variables.
    factor : float
        Of the response.
    palette : mapping of str to str
        A colour for each name of `COLOURS`.
    """
    first, second = names
    near = SAME_SLICE * float(np.ptp(model.x[second]))
    alone = others_at_rest(model, model.x, first, second)
    handles: list[Any] = []
    words: list[Series] = []
    for i, (level, style) in enumerate(zip(slices_of(model, names), STYLES, strict=False)):
        mine, colour = alone & (np.abs(model.x[second] - level) <= near), palette["abcd"[i]]
        fine = np.linspace(model.x[first].min(), model.x[first].max(), SLICE_FINE)
        columns = {v: np.zeros_like(fine) for v in {*model.domain.variables, *moving(model)}}
        values, _, inside = model.evaluate(columns | {first: fine, second: np.full_like(fine, level)})
        look: dict[str, Any] = {"color": colour, "linewidth": 1.3, "linestyle": style.line}
        mark: dict[str, Any] = {
            "marker": style.marker,
            "markersize": 3.6,
            "markerfacecolor": "none",
            "markeredgewidth": 0.9,
        }
        seen_at, curved = shown_values(first, model.x[first][mine]), np.where(inside, values, np.nan)
        tagged(axes.plot(shown_values(first, fine), curved * factor, zorder=2.5, **look), f"slice{i}")
        markers = axes.plot(
            seen_at, model.y[mine] * factor, zorder=4, **(mark | {"linestyle": "none", "markeredgecolor": colour})
        )
        tagged(markers, f"slice{i}")
        label = f"{symbol_of(second, model)} = {_spoken(model, second, level)}"
        handles += tagged([Line2D([], [], label=label, markeredgecolor=colour, **mark, **look)], f"slice{i}")
        labels = [f"point {model.labels[j]}" for j in np.flatnonzero(mine)]
        words.append(points(f"slice{i}", label, seen_at, model.y[mine], labels))
        words.append(curve(f"slice{i}", f"{label}, fit", shown_values(first, fine), curved))
    return handles, words


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
    near = SAME_SLICE * float(np.ptp(model.x[second]))
    seen = np.concatenate([model.y[np.abs(model.x[second] - level) <= near] for level in levels])
    description = _slices_description(model, levels)
    with settings():
        figure = drawing(BOTTOM + SLICE_FIELD + 8.0 + SLICE_LEGEND)
        axes = panel(
            figure, BOTTOM, SLICE_FIELD, across=limits(shown_values(first, model.x[first]), 0.04) or (-1.0, 1.0),
            up=limits(seen * factor, 0.06) or (-1.0, 1.0), name_up=f"{name}{power}  [{response_unit(model)}]",
            name_across=axis_name(first, model),
        )  # fmt: skip
        handles, words = draw_slices(axes, model, (first, second), factor)
        legend(figure, handles, BOTTOM + SLICE_FIELD)
        shown = numbers(axes, words, axis_name(first, model), f"{name}  [{response_unit(model)}]", factor)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, _slices_caption(model), description, (shown,))


def _spoken(model: FittedModel, variable: str, level: float) -> str:
    shown = float(shown_values(variable, np.array([level]))[0])
    unit = unit_of(variable, model)
    return f"{round(shown, 2) + 0.0:g}".replace("-", "−") + (f" {unit}" if unit != "-" else "")


def _slices_caption(model: FittedModel) -> str:
    first, second = (symbol_of(v, model) for v in moving(model)[:2])
    return text_of("model_figure.slices", model=response_name(model), first=first, second=second)


def _slices_description(model: FittedModel, levels: tuple[float, ...]) -> str:
    first, second = moving(model)[:2]
    each = ", ".join(_spoken(model, second, x) for x in levels)
    return text_of(
        "model_figure.slices_seen",
        model=response_name(model),
        first=axis_name(first, model).replace("  ", " "),
        second=symbol_of(second, model),
        each=each,
    )

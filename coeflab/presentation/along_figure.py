"""The figure of a force law along each of its motions, the others at rest: curve with band, and the points there."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from coeflab.model.fitted_model import FittedModel
from coeflab.presentation.document import Figure, Panel
from coeflab.presentation.model_words import band_in_words
from coeflab.presentation.panel import BOTTOM, Array, drawing, legend, limits, panel
from coeflab.presentation.plotted import curve, numbers, points, tagged
from coeflab.presentation.points import hollow, used
from coeflab.presentation.svg import COLOURS, settings, svg_text
from coeflab.presentation.variables import (
    axis_name,
    moving,
    response_name,
    response_unit,
    scale_of,
    shown_values,
    symbol_of,
)

FIELD, ROOM, LEGEND = 118.0, 12.0, 34.0
FINE = 121
FEWEST, MOST = 3, 3
AT_REST = 1e-3


def along(model: FittedModel) -> tuple[str, ...]:
    """Variables along which at least three rows have all others at rest."""
    names = moving(model)
    return tuple(v for v in names if int(np.sum(_alone(model, model.x, v))) >= FEWEST)[:MOST]


def along_figure(model: FittedModel, anchor: str) -> Figure:
    """One panel for every variable of `along`.

    Parameters
    ----------
    model : FittedModel
    anchor : str
    """
    names = along(model)
    name = response_name(model)
    factor, power = scale_of(model.y)
    above = len(names) * (FIELD + BOTTOM + ROOM) - ROOM
    title = f"{name}, {model.campaign}: along each motion, the others at rest"
    description = _description(model, names)
    with settings():
        figure = drawing(above + 8.0 + LEGEND)
        panels = []
        for i, variable in enumerate(names):
            bottom = (len(names) - 1 - i) * (FIELD + BOTTOM + ROOM) + BOTTOM
            panels.append(_panel(figure, model, variable, bottom, factor, (name, power)))
        ink: dict[str, Any] = {"color": COLOURS["ink"], "linestyle": "none", "marker": "o"}
        marks: dict[str, Any] = {"points": Line2D([], [], markersize=3.2, markeredgewidth=0.0, label="points", **ink)}
        if any(s.key == "aside" for p in panels for s in p.series):
            marks["aside"] = Line2D([], [], markersize=4.6, markerfacecolor="none", label="rejected or doubtful", **ink)
        marks["fit"] = Line2D([], [], color=COLOURS["a"], linewidth=1.4, label="fit")
        marks["band"] = Patch(facecolor=COLOURS["band"], alpha=0.4, edgecolor="none", label="95 % band of the mean")
        legend(figure, [tagged(mark, key) for key, mark in marks.items()], above)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, _caption(model, names), description, tuple(panels))


def _alone(model: FittedModel, columns: Mapping[str, Array], variable: str) -> NDArray[np.bool_]:
    """Rows in which the other variables of the terms are at rest, to a thousandth of their range."""
    rows = np.ones(len(columns[variable]), dtype=bool)
    for other in moving(model):
        if other != variable:
            rows &= np.abs(columns[other]) <= AT_REST * float(np.max(np.abs(model.x[other])))
    return rows


def _panel(
    figure: Drawing, model: FittedModel, variable: str, bottom: float, factor: float, name: tuple[str, str]
) -> Panel:
    """Draws one panel; its numbers."""
    mine, aside = _alone(model, model.x, variable), model.set_aside
    x, y = shown_values(variable, model.x[variable][mine]), model.y[mine] * factor
    fine = np.linspace(float(model.x[variable][mine].min()), float(model.x[variable][mine].max()), FINE)
    columns = {v: np.zeros_like(fine) for v in {*model.domain.variables, *moving(model)}}
    values, half, _ = model.evaluate(columns | {variable: fine})
    values, half = values * factor, np.nan_to_num(half) * factor
    beside, at, out = np.zeros(0), np.zeros(0), np.zeros(0, dtype=bool)
    unit = f"[{response_unit(model)}]"
    if aside is not None:
        out = _alone(model, aside.x, variable)
        beside, at = aside.y[out] * factor, shown_values(variable, aside.x[variable][out])
    axes = panel(
        figure, bottom, FIELD, across=limits(x, 0.04) or (-1.0, 1.0),
        up=limits(np.concatenate([y, values - half, values + half, beside]), 0.06) or (-1.0, 1.0), name_up=f"{name[0]}{name[1]}  {unit}",
        name_across=axis_name(variable, model), most_up=4,
    )  # fmt: skip
    shown = shown_values(variable, fine)
    band = axes.fill_between(
        shown, values - half, values + half, color=COLOURS["band"], alpha=0.4, linewidth=0, zorder=1
    )
    tagged(band, "band")
    tagged(axes.plot(shown, values, color=COLOURS["a"], linewidth=1.4, zorder=2.5), "fit")
    tagged(used(axes, x, y), "points")
    if len(beside):
        tagged(hollow(axes, at, beside), "aside")
    told = (
        points("points", "points", x, model.y[mine], [f"point {model.labels[i]}" for i in np.flatnonzero(mine)]),
        points("aside", "rejected or doubtful", at, beside / factor),
        curve("fit", "fit", shown, values / factor),
    )
    return numbers(axes, told, axis_name(variable, model), f"{name[0]}  {unit}", factor)


def _caption(model: FittedModel, names: tuple[str, ...]) -> str:
    over = " and ".join(symbol_of(v, model) for v in names)
    return f"{response_name(model)} along {over}, each with the other motions at rest. {band_in_words(model)}"


def _description(model: FittedModel, names: tuple[str, ...]) -> str:
    each = "; ".join(
        f"{int(np.sum(_alone(model, model.x, v)))} points over {axis_name(v, model).replace('  ', ' ')}" for v in names
    )
    return f"One panel per motion with the fitted {response_name(model)}, its band and the points: {each}."

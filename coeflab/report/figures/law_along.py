"""The figure of a force law along each of its motions, the others at rest: curve with band, and the points there."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.report.document import Figure, Panel
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, drawing, legend, limits, panel
from coeflab.report.figures.series import curve, numbers, points, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.figures.variables import (
    axis_name,
    band_in_words,
    hollow,
    moving,
    response_name,
    response_unit,
    scale_of,
    shown_values,
    symbol_of,
    used,
)

FIELD, ROOM, LEGEND = 118.0, 12.0, 34.0
FINE = 121
FEWEST, MOST = 3, 3
AT_REST = 1e-3


def along(model: FittedModel) -> tuple[str, ...]:
    """Variables along which at least three rows have all others at rest."""
    names = moving(model)
    return tuple(v for v in names if int(np.sum(others_at_rest(model, model.x, v))) >= FEWEST)[:MOST]


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


def others_at_rest(model: FittedModel, columns: Mapping[str, Array], *variables: str) -> NDArray[np.bool_]:
    """Rows in which the other variables of the terms are at rest, to a thousandth of their range."""
    rows = np.ones(len(columns[variables[0]]), dtype=bool)
    for other in moving(model):
        if other not in variables:
            rows &= np.abs(columns[other]) <= AT_REST * float(np.max(np.abs(model.x[other])))
    return rows


def _law(model: FittedModel, variable: str, factor: float) -> tuple[NDArray[np.bool_], Array, Array, Array]:
    """Rows with the others at rest, steps over their range, the law there and its half-width."""
    mine = others_at_rest(model, model.x, variable)
    fine = np.linspace(float(model.x[variable][mine].min()), float(model.x[variable][mine].max()), FINE)
    columns = {v: np.zeros_like(fine) for v in {*model.domain.variables, *moving(model)}}
    values, half, _ = model.evaluate(columns | {variable: fine})
    return mine, fine, values * factor, np.nan_to_num(half) * factor


def draw_along(
    axes: Axes, model: FittedModel, variable: str, factor: float = 1.0, palette: Mapping[str, str] = COLOURS
) -> list[Any]:
    """A law along one variable with the others at rest: band, curve, points, and those set aside.

    Parameters
    ----------
    axes : Axes
    model : FittedModel
    variable : str
        Of `along`.
    factor : float
        Of the response.
    palette : mapping of str to str
        A colour for each name of `COLOURS`.
    """
    aside = model.set_aside
    mine, fine, values, half = _law(model, variable, factor)
    shown = shown_values(variable, fine)
    band = axes.fill_between(
        shown, values - half, values + half, color=palette["band"], alpha=0.4, linewidth=0, zorder=1
    )
    tagged(band, "band")
    drawn = tagged(axes.plot(shown, values, color=palette["a"], linewidth=1.4, zorder=2.5), "fit")
    x, y = shown_values(variable, model.x[variable][mine]), model.y[mine] * factor
    marks = tagged(used(axes, x, y), "points")
    marks[0].set_markerfacecolor(palette["ink"])
    if aside is not None and np.any(out := others_at_rest(model, aside.x, variable)):
        tagged(hollow(axes, shown_values(variable, aside.x[variable][out]), aside.y[out] * factor), "aside")
    return [*drawn, *marks]


def _panel(
    figure: Drawing, model: FittedModel, variable: str, bottom: float, factor: float, name: tuple[str, str]
) -> Panel:
    """Draws one panel; its numbers."""
    aside = model.set_aside
    mine, fine, values, half = _law(model, variable, factor)
    x, y = shown_values(variable, model.x[variable][mine]), model.y[mine] * factor
    aside_values, at, out = np.zeros(0), np.zeros(0), np.zeros(0, dtype=bool)
    unit = f"[{response_unit(model)}]"
    if aside is not None:
        out = others_at_rest(model, aside.x, variable)
        aside_values, at = aside.y[out] * factor, shown_values(variable, aside.x[variable][out])
    axes = panel(
        figure, bottom, FIELD, across=limits(x, 0.04) or (-1.0, 1.0),
        up=limits(np.concatenate([y, values - half, values + half, aside_values]), 0.06) or (-1.0, 1.0), name_up=f"{name[0]}{name[1]}  {unit}",
        name_across=axis_name(variable, model), most_up=4,
    )  # fmt: skip
    draw_along(axes, model, variable, factor)
    shown = shown_values(variable, fine)
    words = (
        points("points", "points", x, model.y[mine], [f"point {model.labels[i]}" for i in np.flatnonzero(mine)]),
        points("aside", "rejected or doubtful", at, aside_values / factor),
        curve("fit", "fit", shown, values / factor),
    )
    return numbers(axes, words, axis_name(variable, model), f"{name[0]}  {unit}", factor)


def _caption(model: FittedModel, names: tuple[str, ...]) -> str:
    over = " and ".join(symbol_of(v, model) for v in names)
    return f"{response_name(model)} along {over}, each with the other motions at rest. {band_in_words(model)}"


def _description(model: FittedModel, names: tuple[str, ...]) -> str:
    each = "; ".join(
        f"{int(np.sum(others_at_rest(model, model.x, v)))} points over {axis_name(v, model).replace('  ', ' ')}"
        for v in names
    )
    return f"One panel per motion with the fitted {response_name(model)}, its band and the points: {each}."

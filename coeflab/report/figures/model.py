"""The figures of fitted models: which model gets which, and which models show the same fit twice.

The figure of slices of a surface: curves over one variable at several values of the other, with their points.

The figure of a fit over several variables: measured against fitted, residuals against every variable.

The figure of a force law along each of its motions, the others at rest: curve with band, and the points there.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.core.wording import listed
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.report.document import Figure, Panel, Series
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, drawing, legend, limits, panel
from coeflab.report.figures.series import STYLES, curve, numbers, points, tagged
from coeflab.report.figures.surface import curve_figure, is_surface, residual_panel, surface_figure
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.figures.variables import (
    axis_name,
    band_in_words,
    hollow,
    law_in_words,
    moving,
    response_name,
    response_unit,
    scale_of,
    scatter_in_words,
    shown_values,
    symbol_of,
    unit_of,
    used,
)
from coeflab.report.notation import as_users_wrote
from coeflab.report.texts import text_of

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


def _alone(model: FittedModel, columns: Mapping[str, Array], *variables: str) -> NDArray[np.bool_]:
    """Rows in which the other variables of the terms are at rest, to a thousandth of their range."""
    rows = np.ones(len(columns[variables[0]]), dtype=bool)
    for other in moving(model):
        if other not in variables:
            rows &= np.abs(columns[other]) <= AT_REST * float(np.max(np.abs(model.x[other])))
    return rows


def _law(model: FittedModel, variable: str, factor: float) -> tuple[NDArray[np.bool_], Array, Array, Array]:
    """Rows with the others at rest, steps over their range, the law there and its half-width."""
    mine = _alone(model, model.x, variable)
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
    if aside is not None and np.any(out := _alone(model, aside.x, variable)):
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
        out = _alone(model, aside.x, variable)
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
        f"{int(np.sum(_alone(model, model.x, v)))} points over {axis_name(v, model).replace('  ', ' ')}" for v in names
    )
    return f"One panel per motion with the fitted {response_name(model)}, its band and the points: {each}."


MEASURED, RESIDUALS, RESIDUAL_ROOM, RESIDUAL_LEGEND = 150.0, 62.0, 12.0, 22.0
MOST_RESIDUALS = 4


def residual_figure(model: FittedModel, anchor: str) -> Figure:
    """What the fit leaves unexplained.

    Parameters
    ----------
    model : FittedModel
    anchor : str
    """
    names = moving(model)[:MOST_RESIDUALS]
    name, aside = response_name(model), model.set_aside
    fitted = model.y - model.fit.residuals
    title = f"{name}, {model.campaign}: measured against fitted, and residuals"
    lowest = len(names) * (RESIDUALS + BOTTOM + RESIDUAL_ROOM)
    above = lowest + BOTTOM + MEASURED
    description = _residual_description(model, names)
    with settings():
        figure = drawing(above + 8.0 + RESIDUAL_LEGEND)
        axes, factor = _measured(figure, model, fitted, lowest + BOTTOM)
        handles = used(axes, fitted * factor, model.y * factor)
        if aside is not None and len(aside.y):
            handles += hollow(axes, model.evaluate(aside.x)[0] * factor, aside.y * factor)
        handles.append(Line2D([], [], color=COLOURS["a"], linewidth=1.1, label="measured = fitted"))
        legend(figure, handles, above)
        labels = [f"point {label}" for label in model.labels]
        unit = f"[{response_unit(model)}]"
        words = points("points", "points", fitted, model.y, labels)
        # The factor of the upright axis is that of the other as well.
        top = numbers(axes, (words,), f"{name} fitted  {unit}", f"{name} measured  {unit}", factor)
        panels = [replace(top, across=top.up)]
        for i, variable in enumerate(names):
            bottom = (len(names) - 1 - i) * (RESIDUALS + BOTTOM + RESIDUAL_ROOM) + BOTTOM
            across = limits(shown_values(variable, model.x[variable]), 0.04) or (-1.0, 1.0)
            lower, below = residual_panel(figure, model, variable, across, bottom, RESIDUALS)
            left = points("points", "points", shown_values(variable, model.x[variable]), model.fit.residuals, labels)
            panels.append(numbers(lower, (left,), axis_name(variable, model), f"residual  {unit}", below))
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, _residual_caption(model), description, tuple(panels))


def _measured(figure: Drawing, model: FittedModel, fitted: Array, bottom: float) -> tuple[Axes, float]:
    aside = model.set_aside
    aside_values = [] if aside is None or not len(aside.y) else [aside.y, model.evaluate(aside.x)[0]]
    factor, power = scale_of(model.y)
    both = limits(np.concatenate([model.y, fitted, *aside_values]) * factor, 0.06) or (-1.0, 1.0)
    name, unit = response_name(model), response_unit(model)
    axes = panel(
        figure, bottom, MEASURED, across=both, up=both, name_up=f"{name} measured{power}  [{unit}]",
        name_across=f"{name} fitted{power}  [{unit}]",
    )  # fmt: skip
    axes.plot(both, both, color=COLOURS["a"], linewidth=1.1, zorder=2)
    return axes, factor


def _residual_caption(model: FittedModel) -> str:
    text = f"{response_name(model)} measured against fitted ({law_in_words(model)}), and what is left over."
    return f"{text} {scatter_in_words(model)}"


def _residual_description(model: FittedModel, names: tuple[str, ...]) -> str:
    over = ", ".join(axis_name(v, model).replace("  ", " ") for v in names)
    n = 0 if model.set_aside is None else len(model.set_aside.y)
    return (
        f"Top panel: {model.n_points} measured values of {response_name(model)} against the fitted ones"
        f"{f', {n} rejected or doubtful ones hollow' if n else ''}. Panels below: residuals against {over}."
    )


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
    rows = _alone(model, model.x, first, second)
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
    alone = _alone(model, model.x, first, second)
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


SAME = 1e-9


@as_users_wrote
def model_figures(model: FittedModel, anchor: str) -> tuple[Figure, ...]:
    """Every figure of a model.

    A curve with residuals over one variable; a surface over two that fill an area, with slices where the data are a
    grid; else curves along every motion; measured against fitted with residuals for two variables and more. A
    constant has none.

    Parameters
    ----------
    model : FittedModel
    anchor : str
        Beginning of the figures' anchors.
    """
    names = moving(model)
    if not names or not np.any(np.isfinite(model.fit.residuals)):
        return ()
    if len(names) == 1:
        return (curve_figure(model, f"{anchor}-curve"),)
    kinds: list[tuple[Callable[[FittedModel, str], Figure], str]] = [(residual_figure, "residuals")]
    if is_surface(model):
        slices = [(slices_figure, "slices")] if slices_of(model) else []
        kinds = [(surface_figure, "surface"), *slices, *kinds]
    elif along(model):
        kinds.insert(0, (along_figure, "along"))
    return tuple(draw(model, f"{anchor}-{kind}") for draw, kind in kinds)


def distinct(models: Sequence[FittedModel]) -> tuple[FittedModel, ...]:
    """The models without those that only write the same fit in other variables; of such, that with the fewest."""
    out: list[FittedModel] = []
    for model in models:
        same = next((i for i, m in enumerate(out) if _same(m, model)), None)
        if same is None:
            out.append(model)
        elif len(moving(model)) < len(moving(out[same])):
            out[same] = model
    return tuple(out)


def _same(one: FittedModel, other: FittedModel) -> bool:
    return (
        (one.response, one.table, one.labels) == (other.response, other.table, other.labels)
        and np.array_equal(one.y, other.y)
        and np.allclose(one.fit.residuals, other.fit.residuals, rtol=0.0, atol=SAME * float(np.max(np.abs(one.y))))
    )


def over_what(model: FittedModel) -> str:
    """The variables of a model in words."""
    names = [symbol_of(v, model).removesuffix("_deg") for v in moving(model)]
    return listed(names)

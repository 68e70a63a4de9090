"""The figure of a fit over two variables: lines of equal response inside the hull of the data, with the points.

A fit over two variables as a surface in space, with its data points and their distances from it.

The figure of a fit over one variable: points, curve with its band, what lies beyond the data, residuals.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon
from numpy.typing import NDArray

from coeflab.core.types import Array
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.report.document import Axis, Figure, Layer, Scene, Series
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, GAP, TOP, Range, drawing, legend, limits, panel, tick_texts, ticks
from coeflab.report.figures.series import curve, numbers, points, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.figures.variables import (
    axis_name,
    band_in_words,
    beyond,
    draw_set_aside,
    hollow,
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
from coeflab.report.texts import text_of

SCENE_GRID, EVERY = 33, 4


def surface_scene(model: FittedModel) -> Scene | None:
    """The surface inside the hull of the data; None where no value is determined there.

    Parameters
    ----------
    model : FittedModel
        Over two variables that fill an area.
    """
    names = moving(model)
    lines = [np.linspace(model.x[v].min(), model.x[v].max(), SCENE_GRID) for v in names]
    first, second = (m.ravel() for m in np.meshgrid(*lines, indexing="ij"))
    grid = dict(zip(names, (first, second), strict=True))
    rest = {v: np.zeros(SCENE_GRID * SCENE_GRID) for v in model.domain.variables if v not in grid}
    values, _, inside = model.evaluate({**grid, **rest})
    selected = inside & np.isfinite(values)
    if not np.any(selected):
        return None
    places = np.column_stack([shown_values(v, grid[v]) for v in names] + [np.where(selected, values, 0.0)])
    measured = np.column_stack([shown_values(v, model.x[v]) for v in names] + [model.y])
    fitted = np.column_stack([measured[:, :2], model.y - model.fit.residuals])
    layers = (
        Layer("fitted surface", "a", places, _triangles(selected)),
        Layer("lines of one angle" if _angles(names) else "grid lines", "ink", places, _lines(selected)),
        Layer("distances", "b", np.vstack([measured, fitted]), _pairs(len(measured))),
        Layer("points", "ink", measured, np.arange(len(measured)), notes=_notes(model, measured)),
    )
    name = response_name(model)
    title = f"{name}, {model.campaign}: surface in space"
    everything = np.vstack([places[selected], measured, fitted[np.isfinite(fitted).all(axis=1)]])
    flat = [
        _axis(symbol_of(v, model).removesuffix("_deg"), unit_of(v, model), everything[:, i])
        for i, v in enumerate(names)
    ]
    axes = (flat[0], flat[1], _axis(name, response_unit(model), everything[:, 2]))
    caption = text_of("surface_figure.scene", name=name, form=model.form, n_points=model.n_points)
    return Scene(title, caption, f"The surface of {model.n_points} points over {' and '.join(names)}.", layers, axes)


def _angles(names: tuple[str, ...]) -> bool:
    return all(n.startswith(("alpha", "beta")) for n in names)


def _axis(name: str, unit: str, values: Array) -> Axis:
    ends = limits(values, 0.03) or (-1.0, 1.0)
    marks = ticks(ends, 5)
    return Axis(name, "" if unit == "-" else unit, ends, tuple(map(float, marks)), tuple(tick_texts(marks)))


def _triangles(shown: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Two a cell of the grid, where all their corners are known."""
    at = np.arange(SCENE_GRID * SCENE_GRID).reshape(SCENE_GRID, SCENE_GRID)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]))
    both = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return both[shown[both].all(axis=1)]


def _lines(shown: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Every fourth line of the grid."""
    at = np.arange(SCENE_GRID * SCENE_GRID).reshape(SCENE_GRID, SCENE_GRID)
    some = slice(None, None, EVERY)
    pairs = np.vstack(
        [
            np.column_stack([at[:-1, some].ravel(), at[1:, some].ravel()]),
            np.column_stack([at[some, :-1].ravel(), at[some, 1:].ravel()]),
        ]
    )
    return pairs[shown[pairs].all(axis=1)]


def _pairs(n: int) -> NDArray[np.int64]:
    return np.column_stack([np.arange(n), np.arange(n) + n])


def _notes(model: FittedModel, measured: Array) -> tuple[str, ...]:
    """Setting, value and row of every point."""
    names = [symbol_of(v, model).removesuffix("_deg") for v in moving(model)] + [response_name(model)]
    units = [unit_of(v, model) for v in moving(model)] + [response_unit(model)]
    return tuple(
        ", ".join(f"{n} {v:.4g}{'' if u == '-' else f' {u}'}" for n, v, u in zip(names, row, units, strict=True))
        + f"; point {label}"
        for row, label in zip(measured, model.labels, strict=True)
    )


FIELD, LEGEND = 250.0, 34.0
GRID = 61
LEVELS = 8
STEP = 0.11
BOTH = 1.0 / 3.0


def is_surface(model: FittedModel) -> bool:
    """Whether two variables of the terms fill an area: in a third of the rows at least both are away from rest."""
    names = moving(model)
    if len(names) != 2:
        return False
    away = np.logical_and(*(np.abs(model.x[v]) > 1e-9 * np.max(np.abs(model.x[v])) for v in names))
    return bool(np.mean(away) >= BOTH) and len(_hull(model)) > 2


def surface_figure(model: FittedModel, anchor: str) -> Figure:
    """A response over the two variables of its terms, which `is_surface`.

    Parameters
    ----------
    model : FittedModel
    anchor : str
    """
    across_name, up_name = _axes(model)
    x, y = (shown_values(v, model.x[v]) for v in (across_name, up_name))
    factor, power = scale_of(model.y)
    name = response_name(model)
    title = f"{name}, {model.campaign}: surface over {symbol_of(across_name, model)} and {symbol_of(up_name, model)}"
    with settings():
        figure = drawing(BOTTOM + FIELD + 8.0 + LEGEND)
        axes = panel(
            figure, BOTTOM, FIELD, across=limits(x, 0.04) or (-1.0, 1.0), up=limits(y, 0.04) or (-1.0, 1.0),
            name_up=axis_name(up_name, model), name_across=axis_name(across_name, model),
        )  # fmt: skip
        levels = _field(axes, model, factor)
        handles = used(axes, x, y)
        if model.set_aside is not None and len(model.set_aside.y):
            handles += hollow(axes, *(shown_values(v, model.set_aside.x[v]) for v in (across_name, up_name)))
        edge: dict[str, Any] = {"color": COLOURS["b"], "linewidth": 1.0, "linestyle": (0, (4.0, 2.0))}
        axes.add_patch(Polygon(_hull(model), closed=True, fill=False, zorder=3, **edge))
        line = Line2D(
            [], [], color=COLOURS["ink"], linewidth=0.8, label=f"equal {name}{power}  [{response_unit(model)}]"
        )
        legend(figure, [*handles, Line2D([], [], label="hull of the data", **edge), line], BOTTOM + FIELD)
        shown = numbers(
            axes, (_points(model, x, y, name),), axis_name(across_name, model), axis_name(up_name, model)
        )  # fmt: skip
        svg = svg_text(figure, anchor, title, _description(model, levels))
    return Figure(anchor, svg, title, _caption(model), _description(model, levels), (shown,), surface_scene(model))


def _points(model: FittedModel, x: Array, y: Array, name: str) -> Series:
    """The data with the response as it was measured and as the surface has it."""
    unit = f" {model.unit}" if model.unit != "1" else ""
    notes = [
        f"{name} {v:.4g}{unit}, fitted {v - r:.4g}{unit}; point {label}"
        for v, r, label in zip(model.y, model.fit.residuals, model.labels, strict=True)
    ]
    return points("points", "points", x, y, notes)


def _axes(model: FittedModel) -> tuple[str, str]:
    first, second = moving(model)
    return first, second


def _hull(model: FittedModel) -> Array:
    """Corners of the convex hull of the points as the axes show them, shape (k, 2); none where they lie on a line."""
    from scipy.spatial import ConvexHull, QhullError

    points = np.unique(np.column_stack([shown_values(v, model.x[v]) for v in _axes(model)]), axis=0)
    size = np.ptp(points, axis=0)
    try:
        return np.asarray(points[ConvexHull(points / np.where(size > 0.0, size, 1.0)).vertices])
    except (QhullError, ValueError):
        return np.zeros((0, 2))


def _field(axes: Axes, model: FittedModel, factor: float) -> list[str]:
    """Steps that grow darker with the response, and labelled lines between them; returns the labels."""
    names = _axes(model)
    lines = [np.linspace(model.x[v].min(), model.x[v].max(), GRID) for v in names]
    grid = dict(zip(names, (m.ravel() for m in np.meshgrid(*lines)), strict=True))
    rest = {v: np.zeros(GRID * GRID) for v in model.domain.variables if v not in grid}
    values, _, inside = model.evaluate({**grid, **rest})
    z = values.reshape(GRID, GRID) * factor
    if not np.any(np.isfinite(z)):
        return []
    known = z.ravel()[inside & np.isfinite(z.ravel())]
    low, high = float(known.min()), float(known.max())
    x, y = (shown_values(v, line) for v, line in zip(names, lines, strict=True))
    hull = Polygon(_hull(model), closed=True, facecolor=COLOURS["a"], alpha=STEP / 2.0, linewidth=0, zorder=0.5)
    axes.add_patch(hull)
    levels = ticks((low, high), LEVELS)
    levels = levels[(levels > low) & (levels < high)]
    if not len(levels):
        return []
    clip = Polygon(_hull(model), closed=True, transform=axes.transData)
    for level in levels:
        region = axes.contourf(x, y, z, levels=[level, np.inf], colors=[COLOURS["a"]], alpha=STEP, zorder=0.6)
        region.set_clip_path(clip)
    texts = dict(zip(levels, tick_texts(levels), strict=True))
    drawn: Any = axes.contour(
        x, y, z, levels=levels, colors=COLOURS["ink"], linewidths=[1.3 if v == 0.0 else 0.8 for v in levels],
        linestyles=[(0, (5.0, 2.0)) if v < 0.0 else "-" for v in levels], zorder=2,
    )  # fmt: skip
    axes.clabel(drawn, fmt=texts, fontsize=8.75, inline=True, inline_spacing=3, colors=COLOURS["ink"])
    drawn.set_clip_path(clip)
    return list(texts.values())


def _caption(model: FittedModel) -> str:
    names = " and ".join(symbol_of(v, model) for v in _axes(model))
    return text_of(
        "surface_figure.caption",
        model=response_name(model),
        names=names,
        form=model.form,
        beyond=beyond(model),
    )


def _description(model: FittedModel, levels: list[str]) -> str:
    ends = f", lines from {levels[0]} to {levels[-1]}" if levels else ""
    names = " and ".join(axis_name(v, model).replace("  ", " ") for v in _axes(model))
    return f"Contour lines of {response_name(model)} over {names} inside the hull of {model.n_points} points{ends}."


RESIDUALS = 70.0
FINE = 161
MARGIN = 0.1
LINE: dict[str, Any] = {"color": COLOURS["a"], "linewidth": 1.4}
DASHED: dict[str, Any] = {"color": COLOURS["a"], "linewidth": 1.1, "linestyle": (0, (4.0, 2.4))}


def curve_figure(model: FittedModel, anchor: str) -> Figure:
    """A response over the one variable of its terms.

    Parameters
    ----------
    model : FittedModel
    anchor : str
    """
    variable = moving(model)[0]
    x = model.x[variable]
    room = MARGIN * float(np.ptp(x))
    fine = np.linspace(float(x.min()) - room, float(x.max()) + room, FINE)
    y, half, _ = model.evaluate(_columns(model, variable, fine))
    inside = (fine >= x.min()) & (fine <= x.max())
    factor, power = scale_of(model.y)
    name, across = (
        response_name(model),
        (float(shown_values(variable, fine)[0]), float(shown_values(variable, fine)[-1])),
    )
    seen = [model.y, (y - np.nan_to_num(half))[inside], (y + np.nan_to_num(half))[inside]]
    if model.set_aside is not None:
        seen.append(model.set_aside.y)
    title = f"{name}, {model.campaign}: data, curve and residuals over {symbol_of(variable, model)}"
    description = _description_curve(model, variable)
    with settings():
        figure = drawing()
        main = panel(
            figure, BOTTOM + RESIDUALS + GAP, TOP - BOTTOM - RESIDUALS - GAP, across=across,
            up=limits(np.concatenate(seen) * factor, 0.06) or (-1.0, 1.0),
            name_up=f"{name}{power}  [{response_unit(model)}]",
        )  # fmt: skip
        at = shown_values(variable, fine)
        handles = tagged(used(main, shown_values(variable, x), model.y * factor), "points")
        handles += tagged(draw_set_aside(main, model, variable, factor), "aside")
        handles += _curve(main, at, y * factor, half * factor, inside)
        legend(figure, handles)
        lower, below = residual_panel(figure, model, variable, across, BOTTOM, RESIDUALS)
        tagged(lower.lines[-1], "points")
        _band(lower, model, at, half)
        for axes in (main, lower):
            _shade(axes, across, shown_values(variable, np.array([x.min(), x.max()])))
        along = axis_name(variable, model)
        seen_at = shown_values(variable, x)
        panels = (
            numbers(
                main,
                (points("points", "points", seen_at, model.y, model.labels), curve("fit", "fit", at, y)),
                along, f"{name}  [{response_unit(model)}]", factor,
            ),
            numbers(
                lower, (points("points", "points", seen_at, model.fit.residuals, model.labels),), along,
                f"residual  [{response_unit(model)}]", below,
            ),
        )  # fmt: skip
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, _caption_curve(model, variable), description, panels)


def _columns(model: FittedModel, variable: str, fine: Array) -> Mapping[str, Array]:
    """Columns along the axis; what else the domain names stands at zero, no term has it."""
    return {v: fine if v == variable else np.zeros_like(fine) for v in {variable, *model.domain.variables}}


def _curve(axes: Axes, at: Array, y: Array, half: Array, inside: Array) -> list[Any]:
    tagged(axes.plot(at, np.where(inside, np.nan, y), zorder=2.4, **DASHED), "beyond")
    handles: list[Any] = tagged(axes.plot(at[inside], y[inside], zorder=2.6, label="fit", **LINE), "fit")
    if np.any(np.isfinite(half)):
        tagged(
            axes.fill_between(at, y - half, y + half, color=COLOURS["band"], alpha=0.4, linewidth=0, zorder=1), "band"
        )
        band = Patch(facecolor=COLOURS["band"], alpha=0.4, edgecolor="none", label="95 % band of the mean")
        handles.append(tagged(band, "band"))
    return [*handles, tagged(Line2D([], [], label="beyond the data", **DASHED), "beyond")]


def _shade(axes: Axes, across: Range, ends: Array) -> None:
    """What lies beyond the data, on both sides."""
    for low, high in ((across[0], float(ends[0])), (float(ends[1]), across[1])):
        axes.axvspan(low, high, color=COLOURS["rule"], alpha=0.35, linewidth=0, zorder=0.4)


def _band(axes: Axes, model: FittedModel, at: Array, half: Array) -> None:
    """The same band about zero, at the scale of the residuals."""
    factor, _ = scale_of(model.fit.residuals)
    low, high = axes.get_ylim()
    up = np.clip(half * factor, low, high)
    axes.fill_between(at, -up, up, color=COLOURS["band"], alpha=0.4, linewidth=0, zorder=1)


def residual_panel(
    figure: Any, model: FittedModel, variable: str, across: Range, bottom: float, height: float
) -> tuple[Axes, float]:
    """A panel of what the fit leaves over along a variable, and the factor of its upright axis."""
    residuals = model.fit.residuals
    factor, power = scale_of(residuals)
    reach = float(np.max(np.abs(residuals), initial=0.0)) * factor * 1.2 or 1.0
    axes = panel(
        figure, bottom, height, across=across, up=(-reach, reach), name_up=f"residual{power}",
        name_across=axis_name(variable, model), most_up=3,
    )  # fmt: skip
    axes.axhline(0.0, color=COLOURS["muted"], linewidth=0.6)
    used(axes, shown_values(variable, model.x[variable]), residuals * factor)
    return axes, factor


def _caption_curve(model: FittedModel, variable: str) -> str:
    text = f"{response_name(model)} against {axis_name(variable, model).partition('  ')[0]}: {model.form}. "
    return f"{text}{band_in_words(model)} Dashed on grey: beyond the data, where {beyond(model)}. {scatter_in_words(model)}"


def _description_curve(model: FittedModel, variable: str) -> str:
    n = 0 if model.set_aside is None else len(model.set_aside.y)
    return (
        f"Upper panel: {model.n_points} points of {response_name(model)} over {axis_name(variable, model).replace('  ', ' ')}"
        f"{f', {n} rejected or doubtful ones hollow' if n else ''}, the fitted curve with a band. Lower panel: residuals."
    )

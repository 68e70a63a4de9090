"""The figure of a fit over two variables: lines of equal response inside the hull of the data, with the points."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from coeflab.core.types import Array
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.report.document import Figure, Series
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, drawing, legend, limits, panel, tick_texts, ticks
from coeflab.report.figures.series import numbers, points
from coeflab.report.figures.surface_scene import surface_scene
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.figures.variables import (
    axis_name,
    beyond,
    hollow,
    moving,
    response_name,
    response_unit,
    scale_of,
    shown_values,
    symbol_of,
    used,
)
from coeflab.report.texts import text_of

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

"""The figure of a fit over one variable: points, curve with its band, what lies beyond the data, residuals."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from coeflab.core.types import Array
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.report.document import Figure
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, GAP, TOP, Range, drawing, legend, limits, panel
from coeflab.report.figures.series import curve, numbers, points, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.figures.variables import (
    axis_name,
    band_in_words,
    beyond,
    draw_set_aside,
    moving,
    response_name,
    response_unit,
    scale_of,
    scatter_in_words,
    shown_values,
    symbol_of,
    used,
)

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

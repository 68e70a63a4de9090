"""The figure of a fit over several variables: measured against fitted, residuals against every variable."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D

from coeflab.core.types import Array
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.report.document import Figure
from coeflab.report.figures.curve import residual_panel
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, drawing, legend, limits, panel
from coeflab.report.figures.series import numbers, points
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.figures.variables import (
    axis_name,
    hollow,
    law_in_words,
    moving,
    response_name,
    response_unit,
    scale_of,
    scatter_in_words,
    shown_values,
    used,
)

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

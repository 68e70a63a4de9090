"""Points of a fitted model in a panel: used ones filled, rejected or doubtful ones hollow."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from coeflab.model.fitted_model import FittedModel
from coeflab.presentation.panel import Array
from coeflab.presentation.svg import COLOURS
from coeflab.presentation.variables import shown_values

MANY = 60


def used(axes: Axes, x: Array, y: Array) -> list[Any]:
    """Points that the fit uses; smaller where they are many."""
    size = 3.2 if len(x) <= MANY else 2.0
    drawn: list[Any] = axes.plot(
        x, y, linestyle="none", marker="o", markersize=size, markerfacecolor=COLOURS["ink"], markeredgewidth=0.0,
        zorder=4, label="points",
    )  # fmt: skip
    return drawn


def hollow(axes: Axes, x: Array, y: Array) -> list[Any]:
    """Points that the fit does not use."""
    drawn: list[Any] = axes.plot(
        x, y, linestyle="none", marker="o", markersize=4.6, markerfacecolor="none", markeredgecolor=COLOURS["ink"],
        markeredgewidth=0.8, zorder=3.5, label=f"rejected or doubtful ({len(x)})",
    )  # fmt: skip
    return drawn


def beside(axes: Axes, model: FittedModel, variable: str, factor: float) -> list[Any]:
    """The rejected and doubtful points over a variable, within its range; none where they are not known."""
    aside = model.set_aside
    if aside is None or variable not in aside.x:
        return []
    x = shown_values(variable, aside.x[variable])
    low, high = axes.get_xlim()
    seen = (x >= low) & (x <= high)
    return hollow(axes, x[seen], aside.y[seen] * factor) if np.any(seen) else []

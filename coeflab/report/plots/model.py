"""A fitted law along one of its variables, with the points."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes

from coeflab.core.errors import InputError, shown
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.law.symbols import primed
from coeflab.report.figures.model import along, draw_along
from coeflab.report.figures.variables import axis_name, response_name, response_unit
from coeflab.report.plots.axes import axes_of, palette


def plot_model(models: Sequence[FittedModel], symbol: str, ax: Axes | None = None) -> Axes:
    """The law that a coefficient belongs to, along the variable that it goes with and the others at rest.

    Parameters
    ----------
    models : sequence of FittedModel
    symbol : str
    ax : Axes, optional

    Raises
    ------
    InputError
        No law has it, or no three rows have all other variables at rest.
    """
    name = symbol.removesuffix("'")
    model = next((m for m in models if name in [s.removesuffix("'") for s in m.symbols]), None)
    if model is None:
        raise InputError(
            f"no law with {shown(symbol)}",
            f"one of {', '.join(primed(s) for m in models for s in m.symbols)}",
            column="symbol",
        )
    return plot_along(model, next((v for v in along(model) if v in name[1:]), ""), ax)


def plot_along(model: FittedModel, variable: str = "", ax: Axes | None = None) -> Axes:
    """A law along one of its variables, the others at rest.

    Parameters
    ----------
    model : FittedModel
    variable : str
        By default the first along which three rows lie.
    ax : Axes, optional

    Raises
    ------
    InputError
        No three rows have all other variables at rest, or not those of this variable.
    """
    names = along(model)
    if not names or (variable and variable not in names):
        raise InputError(
            f"{shown(variable or model.response)}, whose rows vary several motions at once",
            f"a variable along which three rows or more lie{''.join(f', {n}' for n in names)}",
            column="variable",
        )
    variable = variable or names[0]
    axes = axes_of(ax)
    draw_along(axes, model, variable, palette=palette())
    axes.set_xlabel(axis_name(variable, model).replace("  ", " "))
    axes.set_ylabel(f"{response_name(model)} [{response_unit(model)}]")
    return axes

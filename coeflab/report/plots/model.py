"""A fitted law along one of its variables, with the points."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes

from coeflab.core.errors import InputError, shown
from coeflab.core.wording import listed
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.law.symbols import primed
from coeflab.report.figures.model import along, draw_along, draw_slices, slices_of
from coeflab.report.figures.variables import axis_name, moving, response_name, response_unit
from coeflab.report.plots.axes import axes_of, palette


def plot_model(models: Sequence[FittedModel], symbol: str, ax: Axes | None = None) -> Axes:
    """The law that a coefficient belongs to, along the variable that it goes with and the others at rest; of a cross term slices.

    Parameters
    ----------
    models : sequence of FittedModel
    symbol : str
    ax : Axes, optional

    Raises
    ------
    InputError
        No law has it, no three rows have all other variables at rest, or a cross term is of no grid of rows.
    """
    name = symbol.removesuffix("'")
    model = next((m for m in models if name in [s.removesuffix("'") for s in m.symbols]), None)
    if model is None:
        raise InputError(
            f"no law with {shown(symbol)}",
            f"one of {', '.join(primed(s) for m in models for s in m.symbols)}",
            column="symbol",
        )
    term = next(t for t, s in zip(model.terms, model.symbols, strict=True) if s.removesuffix("'") == name)
    variables = [v for v in moving(model) if v in {f for f, _, _ in term.factors}]
    if len(variables) < 2:
        return plot_along(model, next(iter(variables), ""), ax)
    if len(variables) > 2 or not slices_of(model, variables):
        raise InputError(
            f"{shown(symbol)}, a term of {listed(variables)} together, of rows that are no grid of two",
            "a term of one motion, such as a slope",
            column="symbol",
            advice=f'Without a symbol, plot() draws its interval; laws["{model.response}"].evaluate({", ".join(f"{v}=..." for v in variables)}) has the law.',
        )
    axes = axes_of(ax)
    handles, _ = draw_slices(axes, model, variables, palette=palette())
    axes.legend(handles=handles)
    return _named(axes, model, variables[0])


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
    return _named(axes, model, variable)


def _named(axes: Axes, model: FittedModel, variable: str) -> Axes:
    axes.set_xlabel(axis_name(variable, model).replace("  ", " "))
    axes.set_ylabel(f"{response_name(model)} [{response_unit(model)}]")
    return axes

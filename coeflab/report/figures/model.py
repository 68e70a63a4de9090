"""The figures of fitted models: which model gets which, and which models show the same fit twice."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from coeflab.core.wording import listed
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.report.document import Figure
from coeflab.report.figures.curve import curve_figure
from coeflab.report.figures.law_along import along, along_figure
from coeflab.report.figures.residuals import residual_figure
from coeflab.report.figures.slices import slices_figure, slices_of
from coeflab.report.figures.surface import is_surface, surface_figure
from coeflab.report.figures.variables import (
    moving,
    symbol_of,
)
from coeflab.report.notation import as_users_wrote

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

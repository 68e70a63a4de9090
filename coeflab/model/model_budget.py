"""Budgets of fitted models: scatter, grid and declared inputs; the form is given, and what another would say is open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.symbols import ANGULAR, COMPONENTS, FORCES, MOMENTS, derivative
from coeflab.model.budget import Budget, budget_of, grid_study_of, undeclared, with_budget
from coeflab.model.coefficient import Coefficient
from coeflab.model.fit_result import FitResult
from coeflab.model.fitted_model import FittedModel
from coeflab.model.force_table import ForceTable
from coeflab.model.input_effects import InputPart, acting
from coeflab.model.model_effects import ModelEffects, Refit, model_effects
from coeflab.model.moved_tables import SET_ANGLES
from coeflab.model.regression import MOMENT_COEFFICIENTS
from coeflab.model.scaling import Scaling

DRAWS, SEED = 500, 1
FORM = "model form"


def with_model_budgets(
    fit: FitResult, tables: Sequence[ForceTable], scaling: Scaling, refit: Refit, draws: int = DRAWS, seed: int = SEED
) -> tuple[FitResult, tuple[Budget, ...]]:
    """The fit with grid and declared inputs in the half-widths of its models and coefficients, and their budgets.

    Parameters
    ----------
    fit : FitResult
        As the plugin made it from ``tables`` and ``scaling``; returned as it is where it has no models.
    tables : sequence of ForceTable
    scaling : Scaling
    refit : callable
        The same plugin with the same options.
    draws, seed : int
        Of the Monte Carlo over the inputs.
    """
    if not fit.models:
        return fit, ()
    effects = model_effects(fit, tables, scaling, refit, draws, seed)
    models, at = [], 0
    for model in fit.models:
        numbers = slice(at, at + len(model.symbols))
        at = numbers.stop
        shifts = effects.shifts(numbers) if effects else {}
        models.append(replace(model, shared=shifts | _grid(model, tables)))
    found = tuple(
        _budget(c, _model_of(c, fit), tables, effects, at + i)
        for i, c in enumerate(fit.coefficients.coefficients)
        if c.value is not None
    )
    return with_budget(replace(fit, models=tuple(models)), found), found


def _component(model: FittedModel) -> str:
    """X .. N of a response such as ``Y'``, ``C_m`` or ``X [N]``; empty where it joins several."""
    bare = model.response.split(" ")[0].removesuffix("'")
    return bare if bare in COMPONENTS else MOMENT_COEFFICIENTS.get(bare, "")


def _grid(model: FittedModel, tables: Sequence[ForceTable]) -> dict[str, np.ndarray]:
    """The relative half-width of the gravest grid study, on all terms alike."""
    study = grid_study_of(tables, _component(model))
    relative = None if study is None else study.convergence.relative
    return {} if relative is None else {"grid": relative * np.nan_to_num(model.fit.coefficients)}


def _gravest(tables: Sequence[ForceTable], component: str) -> str:
    """The force, or the moment, with the largest relative grid error: for a coefficient that equations alone give."""
    relative = {}
    for other in dict.fromkeys((component, *(MOMENTS if component in MOMENTS else FORCES))):
        study = grid_study_of(tables, other)
        relative[other] = 0.0 if study is None else study.convergence.relative or 0.0
    return max(relative, key=lambda k: relative[k])


def _model_of(c: Coefficient, fit: FitResult) -> FittedModel | None:
    return next((m for m in fit.models if c.symbol in {s.removesuffix("'") for s in m.symbols}), None)


def _budget(
    c: Coefficient, model: FittedModel | None, tables: Sequence[ForceTable], effects: ModelEffects | None, number: int
) -> Budget:
    component = derivative(c.symbol).component
    own = tuple(t for t in tables if component in t.forces) or tuple(tables)
    gridded = component if c.n_points else _gravest(tables, component)
    inputs: tuple[InputPart, ...] = ()
    if effects is not None:
        inputs = tuple(
            InputPart(i.name, i.half_width, float(g))
            for i, g in zip(effects.inputs, effects.gradients[:, number], strict=True)
            if g != 0.0
        )
    variables = () if model is None else model.domain.variables
    wanted = acting(component, any(v in ANGULAR for v in variables), any(v in SET_ANGLES for v in variables))
    assessed = () if effects is None else tuple(InputPart(i.kind, i.half_width, 0.0) for i in effects.inputs)
    lacking = [*undeclared(wanted, own, assessed), *(effects.lacking if effects else ())]
    total = None if effects is None else effects.propagated(number)
    return budget_of(c, gridded, own, {"random": c.parts.random or c.u95, FORM: None}, inputs, total, lacking)

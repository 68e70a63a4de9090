"""Budgets of fitted models: scatter, what it shows that the form leaves out, grid and declared inputs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.results.fitted_model import DIGITS
from coeflab.fits.rows.regression import MOMENT_COEFFICIENTS
from coeflab.fits.uncertainty.budget import (
    COUPLED,
    LEAST_DIGITS,
    MODEL,
    budget_of,
    grid_study_of,
    undeclared,
    variant_studies_of,
    with_budget,
)
from coeflab.fits.uncertainty.grid_studies import gravest
from coeflab.fits.uncertainty.input_parts import InputPart, acting
from coeflab.fits.uncertainty.model_effects import ModelEffects, Refit, model_effects
from coeflab.fits.uncertainty.moved_tables import SET_ANGLES
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import ANGULAR, COMPONENTS, FORCES, MOMENTS, derivative
from coeflab.tables.force_table import ForceTable

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.fits.results.fitted_model import FittedModel
    from coeflab.fits.uncertainty.budget import Budget
    from coeflab.fits.uncertainty.grid_studies import GridStudy, VariantStudy
    from coeflab.law.coefficient import Coefficient


DRAWS, SEED = 200, 1  # every one is a whole fit: tails of 5 draws, half-widths to about 10 %
FORM = "model form"
SELECTED = "declared inputs, as the terms were chosen by looking at the data"
CHANGES = "it changes which rows or terms the fit can use"


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
        grid = _grid(model, tables) | _changed(model, tables)
        lacking = _lacking(model, _component(model), model.domain.variables, tables, effects, numbers)
        if _computed(model, tables) and not any(name.startswith("grid") for name in grid):
            lacking = ("grid", *lacking)
        form = () if model.remainder is not None else (FORM,)
        models.append(replace(model, shared=shifts | grid | _digits(model), not_assessed=(*form, *lacking)))
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


def _own(model: FittedModel, tables: Sequence[ForceTable]) -> tuple[ForceTable, ...]:
    """The tables that a model has rows of; all of them where equations alone give it."""
    names = set(model.table.split(", "))
    return tuple(t for t in tables if t.name in names) or tuple(tables)


def _computed(model: FittedModel, tables: Sequence[ForceTable]) -> bool:
    return any(t.source.kind == "cfd" for t in _own(model, tables))


def _study(model: FittedModel, i: int, tables: Sequence[ForceTable]) -> GridStudy | None:
    """The grid study of a term: of its component, at a setting that moves one of its variables.

    A term whose motion no row of the component has comes from equations alone; it takes the gravest of the forces, or of
    the moments, whose terms they tie it to.
    """
    moves = tuple(dict.fromkeys({"alpha": "w", "beta": "v"}.get(v, v) for v, _, _ in model.terms[i].factors))
    component = _component(model)
    if not moves or np.any(model.terms[i].evaluate(model.x)):
        return grid_study_of(_own(model, tables), component, moves) if component else None
    partners = {"w": "v", "q": "r", "v": "w", "r": "q"}
    studies = [
        found
        for other in (MOMENTS if component in MOMENTS else FORCES)
        if (found := grid_study_of(tables, other, (*moves, *(partners.get(m, m) for m in moves)))) is not None
    ]
    return gravest(tuple(studies))


def _grid(model: FittedModel, tables: Sequence[ForceTable]) -> dict[str, Array]:
    """Half-widths by grid study, each common to the terms that take it: relative, so signed as the coefficients are."""
    out: dict[str, Array] = {}
    for i, value in enumerate(np.nan_to_num(model.fit.coefficients)):
        study = _study(model, i, tables)
        relative = None if study is None else study.convergence.relative
        if study is not None and relative is not None:
            shift = out.setdefault(f"grid at {study.setting}", np.zeros(len(model.terms)))
            shift[i] = relative * value
    return {"grid": next(iter(out.values()))} if len(out) == 1 else out


def _variants(model: FittedModel, i: int, tables: Sequence[ForceTable]) -> tuple[VariantStudy, ...]:
    """Studies of a term's component at settings that move one of its variables."""
    moves = tuple(dict.fromkeys({"alpha": "w", "beta": "v"}.get(v, v) for v, _, _ in model.terms[i].factors))
    component = _component(model)
    return variant_studies_of(_own(model, tables), component, moves) if component else ()


def _changed(model: FittedModel, tables: Sequence[ForceTable]) -> dict[str, Array]:
    """Half-widths by what a study changed, each common to the terms that take it; signed as the coefficients are."""
    out: dict[str, Array] = {}
    for i, value in enumerate(np.nan_to_num(model.fit.coefficients)):
        for study in (s for s in _variants(model, i, tables) if s.name != MODEL):
            shift = out.setdefault(f"{study.name} at {study.setting}", np.zeros(len(model.terms)))
            shift[i] = study.relative * value
    return out


def _digits(model: FittedModel) -> dict[str, Array]:
    """Half-widths by the last printed digit, where they widen any."""
    felt = model.rounding is not None and np.any(
        np.hypot(model.half_width, model.rounding) > LEAST_DIGITS * model.half_width
    )
    return {DIGITS: model.rounding} if felt and model.rounding is not None else {}


def _model_of(c: Coefficient, fit: FitResult) -> tuple[FittedModel, int] | None:
    for m in fit.models:
        bare = [s.removesuffix("'") for s in m.symbols]
        if c.symbol in bare:
            return m, bare.index(c.symbol)
    return None


def _lacking(
    model: FittedModel,
    component: str,
    variables: Sequence[str],
    tables: Sequence[ForceTable],
    effects: ModelEffects | None,
    numbers: slice,
) -> tuple[str, ...]:
    """Inputs that may act and are in no half-width, campaign by campaign."""
    rate, angle = any(v in ANGULAR for v in variables), any(v in SET_ANGLES for v in variables)
    wanted = acting(component, rate, angle) if component else acting("X", rate, angle)
    own = _own(model, tables)
    campaigns = tuple(dict.fromkeys(t.campaign for t in own))
    failed = () if effects is None else tuple(i for i in effects.lacking(numbers) if i.kind in wanted)
    assessed = () if effects is None else effects.inputs
    out = []
    for campaign in campaigns:
        known = tuple(InputPart(i.kind, i.half_width, 0.0) for i in assessed if i.campaign in ("", campaign))
        missing = undeclared(wanted, tuple(t for t in own if t.campaign == campaign), known)
        out += [f"{name} of {campaign}" if len(campaigns) > 1 else name for name in missing]
    if rate and not angle and out:
        out.append(COUPLED)
    if model.post_selection and any(t.uncertainty is not None for t in own):
        out = [SELECTED]
    return (*out, *(f"{i.name}: {CHANGES}" for i in failed))


def _budget(
    c: Coefficient,
    place: tuple[FittedModel, int] | None,
    tables: Sequence[ForceTable],
    effects: ModelEffects | None,
    number: int,
) -> Budget:
    component = derivative(c.symbol).component
    inputs: tuple[InputPart, ...] = ()
    if effects is not None:
        inputs = tuple(
            InputPart(i.name, i.half_width, float(g))
            for i, g in zip(effects.inputs, effects.gradients[:, number], strict=True)
            if np.isfinite(g) and g != 0.0
        )
    total = None if effects is None else effects.propagated(number)
    fitted = {"random": c.parts.random or c.u95, FORM: c.parts.model_form}
    if place is None:
        return budget_of(c, component, tables, fitted, inputs, total, ())
    model, i = place
    variables = tuple(v for v, _, _ in model.terms[i].factors) or model.domain.variables
    lacking = _lacking(model, component, variables, tables, effects, slice(number, number + 1))
    study, variants = _study(model, i, tables), _variants(model, i, tables)
    value = float(model.fit.coefficients[i])
    digits = 0.0 if model.rounding is None or not value else float(model.rounding[i]) * abs((c.value or 0.0) / value)
    return budget_of(
        c, component, _own(model, tables), fitted, inputs, total, lacking, study=study, variants=variants, digits=digits
    )

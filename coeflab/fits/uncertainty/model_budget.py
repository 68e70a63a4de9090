"""Budgets of fitted models: scatter, what it shows that the form leaves out, grid and declared inputs.

How the uncertain inputs of a campaign move fitted models: the whole fit, repeated on moved tables.

The tables that a campaign would have given, had an input been off by an error that all its points share.

An error d says that true angles are the set ones plus d, that true speed, rates, forces, moments, density and length are
1 + d times those stated, and that moments and velocities refer to a point d ahead of the stated one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.types import dataclass, locking
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.rows.regression import MOMENT_COEFFICIENTS
from coeflab.fits.uncertainty.budget import (
    COUPLED,
    MODEL,
    budget_of,
    grid_study_of,
    undeclared,
    variant_studies_of,
    with_budget,
)
from coeflab.fits.uncertainty.grid_studies import gravest
from coeflab.fits.uncertainty.input_parts import InputPart, acting
from coeflab.fits.uncertainty.propagation import STEP, normal_draws, summary_of
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import ANGULAR, COMPONENTS, FORCES, LINEAR, MOMENTS, derivative
from coeflab.law.transforms import incidence
from coeflab.tables.force_table import ForceTable
from coeflab.tables.input_uncertainty import NAMES

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.fits.results.fitted_model import FittedModel
    from coeflab.fits.uncertainty.budget import Budget
    from coeflab.fits.uncertainty.grid_studies import GridStudy, VariantStudy
    from coeflab.fits.uncertainty.propagation import Propagated
    from coeflab.law.coefficient import Coefficient
    from coeflab.tables.input_uncertainty import InputUncertainty

SET_ANGLES = {"alpha": "alpha", "w": "alpha", "beta": "beta", "v": "beta", "dr": "dr", "ds": "ds", "db": "db"}


@dataclass(frozen=True, slots=True)
class UncertainInput:
    """One input that is uncertain.

    Attributes
    ----------
    kind : str
        A field of `InputUncertainty`.
    half_width : float
        95 %: rad, m or relative.
    angle : str
        ``alpha``, ``beta`` or a control; empty unless ``kind`` is ``angle``.
    campaign : str
        Whose tables it moves; empty where it moves them all.
    """

    kind: str
    half_width: float
    angle: str = ""
    campaign: str = ""

    @property
    def name(self) -> str:
        """``force``, ``angle beta``, ``speed of suboff_roddy_2``."""
        own = f"{self.kind.replace('_', ' ')} {self.angle}".rstrip()
        return f"{own} of {self.campaign}" if self.campaign else own


def uncertain_inputs(tables: Sequence[ForceTable], variables: Sequence[str]) -> tuple[UncertainInput, ...]:
    """What the campaigns of some tables declare, the angles one by one as each is set by itself.

    Parameters
    ----------
    tables : sequence of ForceTable
    variables : sequence of str
        Those of the fitted models; only their angles are moved.

    Notes
    -----
    All campaigns of a fit share the length of the primes: the largest of their half-widths is taken for it.
    """
    campaigns: dict[str, InputUncertainty] = {t.campaign: t.uncertainty for t in tables if t.uncertainty is not None}
    several = len({t.campaign for t in tables}) > 1
    lengths = [d.length for d in campaigns.values() if d.length is not None]
    angles = tuple(dict.fromkeys(SET_ANGLES[v] for v in variables if v in SET_ANGLES))
    out: dict[UncertainInput, None] = {}
    for campaign, declared in campaigns.items():
        for kind in NAMES:
            half = max(lengths, default=None) if kind == "length" else getattr(declared, kind)
            if half is None:
                continue
            owner = campaign if several and kind != "length" else ""
            for angle in angles if kind == "angle" else ("",):
                out[UncertainInput(kind, half, angle, owner)] = None
    return tuple(out)


def moved(
    tables: Sequence[ForceTable], scaling: Scaling, inputs: Sequence[UncertainInput], errors: Array
) -> tuple[list[ForceTable], Scaling]:
    """Tables and length with every input off by its error, errors of shape (k,)."""
    length = scaling.length
    for given, error in zip(inputs, errors, strict=True):
        if given.kind == "length":
            length *= 1.0 + float(error)
    out = []
    for table in tables:
        acting = {
            (i.kind, i.angle): float(e)
            for i, e in zip(inputs, errors, strict=True)
            if not i.campaign or i.campaign == table.campaign
        }
        out.append(_moved(table, acting))
    return out, replace(scaling, length=length)


def _moved(table: ForceTable, errors: Mapping[tuple[str, str], float]) -> ForceTable:
    def factor(kind: str) -> float:
        return 1.0 + errors.get((kind, ""), 0.0)

    ahead = errors.get(("reference_point", ""), 0.0)
    if ahead:
        stated = table.reference_point
        true = replace(table, reference_point=stated + np.array([ahead, 0.0, 0.0]))
        table = replace(true.about(stated), notes=table.notes)
    motion = dict(table.motion)
    if ("angle", "alpha") in errors or ("angle", "beta") in errors:
        motion |= _turned(table, errors.get(("angle", "alpha"), 0.0), errors.get(("angle", "beta"), 0.0))
    for names, kind in ((LINEAR, "speed"), (ANGULAR, "rate")):
        motion |= {m: motion[m] * factor(kind) for m in names}
    scale = dict.fromkeys(FORCES, factor("force")) | dict.fromkeys(MOMENTS, factor("moment"))
    return replace(
        table,
        motion=motion,
        controls={c: a + errors.get(("angle", c), 0.0) for c, a in table.controls.items()},
        speed=table.speed * factor("speed"),
        forces={c: f * scale[c] for c, f in table.forces.items()},
        errors={c: e * scale[c] for c, e in table.errors.items()},
        conditions=replace(table.conditions, density=table.conditions.density * factor("density")),
        density=None if table.density is None else table.density * factor("density"),
    )


def _turned(table: ForceTable, attack: float, drift: float) -> dict[str, Array]:
    """u, v, w at the same speed with both angles moved."""
    u, v, w = (np.asarray(table.motion[m]) for m in LINEAR)
    alpha, beta = incidence(u, v, w)
    speed = np.sqrt(u**2 + v**2 + w**2)
    alpha, beta = alpha + attack, beta + drift
    return {
        "u": speed * np.cos(alpha) * np.cos(beta),
        "v": speed * np.sin(beta),
        "w": speed * np.sin(alpha) * np.cos(beta),
    }


Refit = Callable[[Sequence[ForceTable], Scaling], FitResult]
ROUNDING = 1e-9
FEWEST_DRAWS = 100  # fits that came out: 2.5 % tails of two or three


@dataclass(frozen=True, slots=True, eq=False)
@locking("gradients sample nominal")
class ModelEffects:
    """Inputs carried to the numbers of a fit: the coefficients of its models in their order, then those of its set.

    Attributes
    ----------
    inputs : tuple of UncertainInput
        k of them.
    gradients : (k, m) array
        Derivative of every number by every input; NaN where the input changes which rows or terms its model has.
    sample : (s, m) array
        The numbers over all inputs at once, NaN likewise.
    nominal : (m,) array
    seed : int
    """

    inputs: tuple[UncertainInput, ...]
    gradients: Array
    sample: Array
    nominal: Array
    seed: int

    def shifts(self, numbers: slice) -> dict[str, Array]:
        """Signed 95 % shift of some numbers by every input that acts on them and could be carried to all of them."""
        known = np.isfinite(self.nominal[numbers])
        return {
            i.name: np.where(known, np.nan_to_num(row[numbers]), 0.0) * i.half_width
            for i, row in zip(self.inputs, self.gradients, strict=True)
            if np.all(np.isfinite(row[numbers][known])) and np.any(row[numbers][known] != 0.0)
        }

    def lacking(self, numbers: slice) -> tuple[UncertainInput, ...]:
        """Inputs that could not be carried to some numbers."""
        known = np.isfinite(self.nominal[numbers])
        return tuple(
            i
            for i, row in zip(self.inputs, self.gradients, strict=True)
            if not np.all(np.isfinite(row[numbers][known]))
        )

    def propagated(self, number: int) -> Propagated | None:
        """All inputs together on one number, linear beside Monte Carlo; None with fewer than 100 usable draws."""
        sample = self.sample[:, number]
        sample = sample[np.isfinite(sample)]
        if not self.inputs or len(sample) < min(FEWEST_DRAWS, len(self.sample)):
            return None
        covariance = np.diag((np.array([i.half_width for i in self.inputs]) / 2.0) ** 2)
        gradient = np.nan_to_num(self.gradients[:, number])
        return summary_of(sample, float(self.nominal[number]), gradient, covariance, self.seed)


def numbers_of(fit: FitResult) -> Array:
    """Coefficients of all models, then of the set; NaN where there is none."""
    among = [np.nan if c.value is None else c.value for c in fit.coefficients.coefficients]
    return np.concatenate([*(m.fit.coefficients for m in fit.models), np.array(among, dtype=float)])


def _moved_numbers(fit: FitResult, other: FitResult) -> Array | None:
    """Numbers of a moved fit, NaN for models with other rows or terms; None where the models are others altogether."""
    if [m.symbols for m in fit.models] != [m.symbols for m in other.models]:
        return None
    if fit.coefficients.symbols != other.coefficients.symbols:
        return None
    numbers, at, changed = numbers_of(other), 0, set()
    for one, two in zip(fit.models, other.models, strict=True):
        stop = at + len(one.symbols)
        if one.labels != two.labels:
            numbers[at:stop] = np.nan
            changed |= {s.removesuffix("'") for s in one.symbols}
        at = stop
    for i, c in enumerate(fit.coefficients.coefficients):
        if c.symbol in changed:
            numbers[at + i] = np.nan
    return numbers


def model_effects(
    fit: FitResult, tables: Sequence[ForceTable], scaling: Scaling, refit: Refit, draws: int, seed: int
) -> ModelEffects | None:
    """Effects of the declared inputs; None where none is declared or the fit chose its terms by looking at the data.

    Parameters
    ----------
    fit : FitResult
        With models, as the plugin made it from ``tables`` and ``scaling``.
    tables : sequence of ForceTable
    scaling : Scaling
    refit : callable
        The same plugin with the same options.
    draws, seed : int
        Of the Monte Carlo.
    """
    variables = dict.fromkeys(v for m in fit.models for v in m.domain.variables if _is_set(v, m.unit))
    inputs = uncertain_inputs(tables, tuple(variables))
    if not inputs or any(m.post_selection for m in fit.models):
        return None
    nominal = numbers_of(fit)
    nothing = np.full(len(nominal), np.nan)

    def numbers(some: Sequence[UncertainInput], errors: Array) -> Array:
        try:
            found = _moved_numbers(fit, refit(*moved(tables, scaling, some, errors)))
        except InputError:
            return nothing
        return nothing if found is None else found

    rows = []
    for given in inputs:
        step = STEP * given.half_width
        row = (numbers([given], np.array([step])) - numbers([given], np.array([-step]))) / (2.0 * step)
        rows.append(np.where(np.abs(row * given.half_width) <= ROUNDING * np.abs(nominal), 0.0, row))
    half = np.array([i.half_width for i in inputs])
    sample = [numbers(inputs, e) for e in normal_draws(np.diag((half / 2.0) ** 2), draws, seed)]
    return ModelEffects(inputs, np.array(rows), np.array(sample), nominal, seed)


def _is_set(variable: str, unit: str) -> bool:
    """Whether a variable is an angle that somebody set: alpha, beta, controls; v and w where they are primed."""
    return variable in SET_ANGLES and (unit == "1" or variable not in ("v", "w"))


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
        models.append(replace(model, shared=shifts | grid, not_assessed=(*form, *lacking)))
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
    return budget_of(c, component, _own(model, tables), fitted, inputs, total, lacking, study=study, variants=variants)

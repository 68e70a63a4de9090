"""Parameters of a model tuned to what was measured: values, intervals where there are any, and what the data leave open.

The parameter file that a tuning leaves behind: moved values, their intervals, and where they come from.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.table import number, plus_minus
from coeflab.core.types import Array, brief, locking
from coeflab.core.version import VERSION
from coeflab.core.wording import finite, listed
from coeflab.identify.output_error import Estimate
from coeflab.identify.output_problem import Problem
from coeflab.identify.tuning_plan import Place, TuningPlan, moved
from coeflab.law.added_mass import potential_part
from coeflab.law.coefficient import Parts, Status
from coeflab.law.symbols import COMPONENTS, MOTIONS, derivative
from coeflab.vehicle.force_law import points_of
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ParameterModel
from coeflab.vehicle.parameter_parts import ParameterCovariance
from coeflab.vehicle.schema_versions import SCHEMA_VERSION

OK, SIGN, PRIOR, BOUND, OPEN = "ok", "sign_open", "prior_only", "at_bound", "not_identifiable"
STATUSES = {
    OK: "the data determine it",
    SIGN: "its 95 % interval holds zero: the data do not tell its sign",
    PRIOR: "more than nine tenths of its information is the prior",
    BOUND: "it ended at a bound, so there is no interval",
    OPEN: "the data do not determine it: its 95 % half-width would exceed its own size; no interval",
}
WORDS = {
    OK: "determined",
    SIGN: "sign open",
    PRIOR: "mostly prior",
    BOUND: "at its bound",
    OPEN: "not identifiable",
}  # of a status, for people
MOSTLY = 0.9  # of the variance from the prior: the data hardly add to it
SAME_RATIO = 0.25  # changes alike within a quarter read as a ratio
TAKES_PART = 0.05  # of the largest change: less is not named


@dataclass(frozen=True, slots=True)
class TunedParameter:
    """One parameter.

    Attributes
    ----------
    name, unit : str
    before, after : float
    u95 : float or None
        95 % half-width; None where the status gives none.
    prior_share : float
        0: the data alone speak, 1: the prior alone.
    status : str
        A key of `STATUSES`.
    """

    name: str
    unit: str
    before: float
    after: float
    u95: float | None
    prior_share: float
    status: str


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("measured before after error")
class TunedQuantity:
    """One measured quantity, a value a case; NaN where it was not measured.

    Attributes
    ----------
    name, unit : str
    measured, before, after : (n,) arrays
    error : (n,) array
        Standard error that weighed each case.
    """

    name: str
    unit: str
    measured: Array
    before: Array
    after: Array
    error: Array

    def rms(self, after: bool = True) -> float:
        """Root mean square of model minus measured."""
        return float(np.sqrt(np.nanmean((np.asarray(self.after if after else self.before) - self.measured) ** 2)))

    @property
    def count(self) -> int:
        """Cases in which it was measured."""
        return int(np.isfinite(self.measured).sum())

    @property
    def worst(self) -> float:
        """Largest difference of model and measurement, after the fit."""
        return float(np.nanmax(np.abs(self.after - self.measured)))


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("correlation covariance singular")
class Tuning:
    """What came of a fit.

    Attributes
    ----------
    name : str
    parameters : tuple of TunedParameter
    correlation : (p, p) array
        NaN where a parameter has no interval.
    covariance : (p, p) array
    quantities : tuple of TunedQuantity
    together : tuple of str
        Combinations that the data leave open, in words.
    singular : (p,) array
        Of the Jacobian, outputs by their errors, parameters by their sizes.
    birge : float
    freedom : float
    converged : bool
    statements : tuple of str
    """

    name: str
    parameters: tuple[TunedParameter, ...]
    correlation: Array
    covariance: Array
    quantities: tuple[TunedQuantity, ...]
    together: tuple[str, ...]
    singular: Array
    birge: float
    freedom: float
    converged: bool
    statements: tuple[str, ...] = ()

    def parameter(self, name: str) -> TunedParameter:
        """The parameter of a name."""
        return next(p for p in self.parameters if p.name == name)

    def quantity(self, name: str) -> TunedQuantity:
        """The quantity of a name."""
        return next(q for q in self.quantities if q.name == name)


def tuned_parameters(
    names: Sequence[str], units: Sequence[str], p: Problem, found: Estimate
) -> tuple[TunedParameter, ...]:
    """Every parameter with its status."""
    errors = found.standard_errors
    out = []
    for i, name in enumerate(names):
        if found.at_bound[i]:
            status = BOUND
        elif found.open[i]:
            status = OPEN
        else:
            holds_zero = abs(found.parameters[i]) <= 2.0 * float(errors[i])
            status = PRIOR if found.prior_share[i] > MOSTLY else SIGN if holds_zero else OK
        u95 = None if status in (BOUND, OPEN) else 2.0 * float(errors[i])
        share = float(found.prior_share[i]) if status in (OK, SIGN, PRIOR) else 0.0
        out.append(TunedParameter(name, units[i], float(p.start[i]), float(found.parameters[i]), u95, share, status))
    return tuple(out)


def statements(p: Problem, found: Estimate) -> tuple[str, ...]:
    """How the intervals are to be read."""
    out = []
    if not found.converged:
        out.append(f"The fit did not come to an end ({found.message}); its numbers are those of the last step.")
    if found.birge > 1.0:
        out.append(
            f"The residuals are {found.birge:.2g} times the stated errors; the intervals are widened by that (Birge ratio)."
        )
    if np.any(found.open):
        out.append("Parameters without an interval are no result: a weak prior at their start value alone holds them.")
    out.append("Intervals apply to this form of the model, with everything that was not free at its value.")
    if int(np.isfinite(p.measured).sum()) <= len(p.start):
        out.append("There are no more measurements than parameters; the model cannot be judged.")
    return tuple(out)


def driving(p: TunedParameter, source: str = "") -> Finding | None:
    """That what is called damping drives its motion, for a parameter that is positive where it does; None where it damps.

    Parameters
    ----------
    p : TunedParameter
        Its value with the sign of the force along the motion.
    source : str
        Of the measurements.
    """
    if not p.after > 0.0:
        return None
    words = p.u95 is not None and p.after > p.u95
    return Finding.of(
        "tune.drives",
        p.name,
        Severity.WARN,
        statistic=p.after,
        case="told" if words else "open",
        unit=p.unit,
        source=source,
    )


def damps(place: Place, p: ParameterFile) -> bool:
    """Whether a place holds the damping of a motion along itself: a coefficient such as Nr or Nr|r|, or such a term of a table."""
    if place.kind == "coefficient":
        d = derivative(place.key[0])
        return bool(d.factors) and set(d.factors) == {_along(d.component)}
    if place.kind == "term":
        model = p.models[place.key[0]]
        factors = model.terms[place.key[1]].factors
        odd = sum(f.power for f in factors if not f.absolute) % 2 == 1
        return (
            model.response in COMPONENTS
            and odd
            and {f.variable.removesuffix("'") for f in factors} == {_along(model.response)}
        )
    return False


def _along(component: str) -> str:
    return MOTIONS[COMPONENTS.index(component)]


def together_in_words(names: Sequence[str], change: Array, values: Array) -> str:
    """A change of parameters that the outputs do not show, as a sentence; per cent are of sizes, + away from zero.

    Parameters
    ----------
    names : sequence of str
    change : (p,) array
        In units of the parameters' sizes, the largest entry 1.
    values : (p,) array
        What the parameters are; their signs count.
    """
    away = change * np.where(values < 0.0, -1.0, 1.0)
    away = away / away[np.argmax(np.abs(away))]
    parts = [(n, float(c)) for n, c in zip(names, away, strict=True) if abs(c) >= TAKES_PART]
    if len(parts) == 1:
        return f"{parts[0][0]}: the data barely depend on it."
    together = listed([n for n, _ in parts])
    if all(abs(c - 1.0) <= SAME_RATIO for _, c in parts):
        only = "as a ratio" if len(parts) == 2 else "as ratios to each other"
        return f"{together}: only {only}; the data do not show all of them rise alike."
    shown = listed([f"{n} {100.0 * c:+.0f} %" for n, c in parts])
    return f"{together}: only together; the data do not show a change of {shown}."


def largest_correlations(tuning: Tuning, above: float = 0.7) -> tuple[tuple[str, str, float], ...]:
    """Pairs of parameters with a large correlation, the largest first."""
    names = [p.name for p in tuning.parameters]
    pairs = [
        (names[i], names[j], float(tuning.correlation[i, j]))
        for i in range(len(names))
        for j in range(i + 1, len(names))
        if abs(tuning.correlation[i, j]) >= above
    ]
    return tuple(sorted(pairs, key=lambda pair: -abs(pair[2])))


def moved_in_words(p: TunedParameter) -> str:
    """From where to where a parameter went."""
    after = number(p.after, 6) if p.u95 is None else plus_minus(p.after, p.u95)
    prior = f", prior share {100.0 * p.prior_share:.0f} %" if p.prior_share else ""
    return f"{p.name}: from {number(p.before, 6)} to {after} {p.unit} ({WORDS[p.status]}{prior})"


# A place with the number of its parameter.
Numbered = tuple[Place, int]


def tuned_file(plan: TuningPlan, tuning: Tuning) -> ParameterFile:
    """The plan's parameter file with the tuned values; validated."""
    values = {w: p.after for f, p in zip(plan.free, tuning.parameters, strict=True) for w in f.places}
    p = moved(plan.parameters, values)
    numbered = [(w, i) for i, f in enumerate(plan.free) for w in f.places]
    update: dict[str, Any] = {
        "schema_version": SCHEMA_VERSION,
        "name": plan.name,
        "models": tuple(_model(m, k, numbered, tuning) for k, m in enumerate(p.models)),
        "provenance": p.provenance.model_copy(
            update={
                "coeflab_version": VERSION,
                "study": plan.name,
                "inputs": (*p.provenance.inputs, *_inputs(plan)),
                "notes": (*p.provenance.notes, *_notes(plan, tuning)),
            }
        ),
    }
    p = _coefficients(p.model_copy(update=update), numbered, tuning)
    return ParameterFile.model_validate(p.model_copy(update={"law_at_points": points_of(p)}).model_dump())


def _inputs(plan: TuningPlan) -> tuple[InputFile, ...]:
    files = (plan.file, plan.parameters_file, plan.cases.file)
    return tuple(InputFile(name=f.name, sha256=sha256_of(f)) for f in files)


def _notes(plan: TuningPlan, tuning: Tuning) -> tuple[str, ...]:
    how = f"Tuned by output-error least squares to {len(plan.cases.lines)} steady motions of {plan.cases.file.name}."
    places = [f"{moved_in_words(p)}; at {', '.join(w.text for w in f.places)}"
              for f, p in zip(plan.free, tuning.parameters, strict=True)]  # fmt: skip
    return (how, *places, *tuning.together, *tuning.statements)


def _half_width(tuning: Tuning, i: int) -> float | None:
    return tuning.parameters[i].u95


def _entry(tuning: Tuning, a: Numbered, b: Numbered) -> float | None:
    """Covariance of what stands at two places."""
    return finite(float(tuning.covariance[a[1], b[1]]) * a[0].sign * b[0].sign)


def _merged(
    old: Sequence[Sequence[float | None]], mine: dict[int, Numbered], tuning: Tuning
) -> tuple[tuple[float | None, ...], ...]:
    """A covariance with the rows of tuned entries replaced; a tuned one does not vary with one that was held."""
    n = len(old)
    bare = {
        i
        for i in range(n)
        if (i in mine and _half_width(tuning, mine[i][1]) is None) or (i not in mine and old[i][i] is None)
    }
    out: list[tuple[float | None, ...]] = []
    for i in range(n):
        row: list[float | None] = []
        for j in range(n):
            if i in bare or j in bare:
                row.append(None)
            elif i in mine and j in mine:
                row.append(_entry(tuning, mine[i], mine[j]))
            else:
                row.append(0.0 if i in mine or j in mine else old[i][j])
        out.append(tuple(row))
    return tuple(out)


def _model(m: ParameterModel, number: int, numbered: list[Numbered], tuning: Tuning) -> ParameterModel:
    mine = {w.key[1]: (w, i) for w, i in numbered if w.kind == "term" and w.key[0] == number}
    if not mine:
        return m
    terms = tuple(
        t.model_copy(update={"half_width_95": _half_width(tuning, mine[j][1])}) if j in mine else t
        for j, t in enumerate(m.terms)
    )
    words = f"Tuned to steady motions: {', '.join(m.terms[j].symbol for j in mine)}; half widths are those of that fit."
    return m.model_copy(
        update={"terms": terms, "covariance": _merged(m.covariance, mine, tuning), "holds": ("random",),
                "statements": (*m.statements, words)}
    )  # fmt: skip


def _coefficients(p: ParameterFile, numbered: list[Numbered], tuning: Tuning) -> ParameterFile:
    """Coefficients with their new half-widths and covariance, and potential parts of an added mass that moved."""
    mine = {w.key[0]: (w, i) for w, i in numbered if w.kind == "coefficient"}
    changed = []
    for c in p.coefficients:
        update: dict[str, Any] = {}
        if c.symbol in mine:
            half = _half_width(tuning, mine[c.symbol][1])
            update = {"u95": half, "status": Status.SINGLE_ESTIMATOR if half is None else Status.FORM_ASSUMED, "origin": "fit",
                      "parts": Parts(random=half)}  # fmt: skip
        if c.potential is not None and p.added_mass is not None:
            update["potential"] = potential_part(c.symbol, p.added_mass, p.scaling, p.added_mass.density) or 0.0
        changed.append(replace(c, **update))
    symbols = (*p.covariance.symbols, *(s for s in mine if s not in p.covariance.symbols))
    n = len(p.covariance.symbols)
    wide = [[*row, *(None,) * (len(symbols) - n)] for row in p.covariance.matrix]
    wide += [[None] * len(symbols) for _ in symbols[n:]]
    matrix = _merged(wide, {symbols.index(s): w for s, w in mine.items()}, tuning)
    covariance = ParameterCovariance(symbols=symbols, matrix=matrix)
    return p.model_copy(update={"coefficients": tuple(changed), "covariance": covariance})

"""The parameter file that a tuning leaves behind: moved values, their intervals, and where they come from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from coeflab.core.provenance import sha256_of
from coeflab.core.version import VERSION
from coeflab.core.wording import finite
from coeflab.model.parameter_coefficient import ParameterCovariance, UncertaintyParts
from coeflab.model.parameter_file import InputRecord, ParameterFile
from coeflab.model.parameter_model import ParameterModel
from coeflab.model.parameter_places import Place, moved
from coeflab.model.parameter_versions import SCHEMA_VERSION
from coeflab.model.potential import potential_part
from coeflab.model.scaling import Scaling
from coeflab.model.tuning import Tuning, moved_in_words
from coeflab.model.tuning_plan import TuningPlan

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
    return ParameterFile.model_validate(p.model_dump())


def _inputs(plan: TuningPlan) -> tuple[InputRecord, ...]:
    files = (plan.file, plan.parameters_file, plan.cases.file)
    return tuple(InputRecord(name=f.name, sha256=sha256_of(f)) for f in files)


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
    said = f"Tuned to steady motions: {', '.join(m.terms[j].symbol for j in mine)}; half widths are those of that fit."
    return m.model_copy(
        update={"terms": terms, "covariance": _merged(m.covariance, mine, tuning), "holds": ("random",),
                "statements": (*m.statements, said)}
    )  # fmt: skip


def _coefficients(p: ParameterFile, numbered: list[Numbered], tuning: Tuning) -> ParameterFile:
    """Coefficients with their new half-widths and covariance, and potential parts of an added mass that moved."""
    mine = {w.key[0]: (w, i) for w, i in numbered if w.kind == "coefficient"}
    changed = []
    for c in p.coefficients:
        update: dict[str, Any] = {}
        if c.symbol in mine:
            half = _half_width(tuning, mine[c.symbol][1])
            update = {"u95": half, "status": "single_estimator" if half is None else "form_assumed", "origin": "fit",
                      "parts": UncertaintyParts(random=half)}  # fmt: skip
        if c.potential is not None and p.added_mass is not None:
            hull = p.added_mass.as_noun(p.reference_point.point, p.reference_point.origin)
            primes = Scaling(p.scaling.length, p.scaling.length_name)
            update["potential"] = potential_part(c.symbol, hull, primes, p.added_mass.density) or 0.0
        changed.append(c.model_copy(update=update))
    symbols = (*p.covariance.symbols, *(s for s in mine if s not in p.covariance.symbols))
    n = len(p.covariance.symbols)
    wide = [[*row, *(None,) * (len(symbols) - n)] for row in p.covariance.matrix]
    wide += [[None] * len(symbols) for _ in symbols[n:]]
    matrix = _merged(wide, {symbols.index(s): w for s, w in mine.items()}, tuning)
    covariance = ParameterCovariance(symbols=symbols, matrix=matrix)
    return p.model_copy(update={"coefficients": tuple(changed), "covariance": covariance})

"""Force laws of several components over several tables, fitted together where equations link them.

Campaigns of a joint fit held against each other, one component at a time.

What a joint fit says about its equations and about rows that it has not seen.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import accumulate, pairwise

import numpy as np

from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass
from coeflab.core.wording import finite
from coeflab.fits.joint.rows import Component, Constraint, constraint_of, linked
from coeflab.fits.results.fit_result import CampaignShare, Pooling
from coeflab.fits.results.fitted_model import (
    ROUNDING,
    UNLIKELY,
    FittedModel,
    OutOfSample,
    chance,
    errors_of,
    in_words,
)
from coeflab.fits.rows.regression import model_of
from coeflab.fits.rows.too_few import TooFewRowsError
from coeflab.fits.statistics.groups import UNTOLD, poolability, predict_left_out, thirds
from coeflab.fits.statistics.least_squares import Index
from coeflab.fits.statistics.linear_model import LinearFit, fit_linear
from coeflab.fits.statistics.remainder import Block, judged, left_out
from coeflab.fits.statistics.stacked import fit_stacked, freed, influence, part_of, scatter, spread_by_run, stack
from coeflab.law.domain import Domain, Extrapolation
from coeflab.law.named_terms import Equation

EVERY_THIRD = "Every third point left out"


def unseen(parts: Sequence[Component], constraint: Constraint | None) -> list[list[OutOfSample]]:
    """Prediction of rows left out, per component: every third point, then each table where one campaign has several."""
    runs, first = np.unique(np.concatenate([p.data.run for p in parts]), return_index=True)
    variables = tuple(dict.fromkeys(v for p in parts for v in p.data.rows.x))
    columns = {v: np.concatenate([p.data.rows.x.get(v, np.zeros(len(p.data.run))) for p in parts]) for v in variables}
    tables = np.concatenate([p.data.table for p in parts])
    row_run = np.searchsorted(runs, np.concatenate([p.data.run for p in parts]))
    ways = [(EVERY_THIRD, thirds([columns[v][first] for v in variables])[row_run])]
    if len(np.unique(tables)) > 1 and len(parts[0].data.campaigns) == 1:
        ways.append(("Each table left out in turn", tables))
    out: list[list[OutOfSample]] = [[] for _ in parts]
    for how, fold in ways:
        for found, p, guess in zip(out, parts, predicted(parts, constraint, fold), strict=True):
            constant = not p.own and not any(t.term.factors for t in p.terms)
            found.append(errors_of(how, p.data.rows.y, guess, constant=constant))
    return out


def predicted(
    parts: Sequence[Component], constraint: Constraint | None, fold: Index, *, own: bool = True
) -> list[Array]:
    """Rows of every component predicted from those of other folds; without the campaign's own intercept if not ``own``."""
    y = [p.data.rows.y for p in parts]
    design, noise = stack([p.matrix for p in parts], y, [p.errors for p in parts])
    asked = design.copy()
    if not own:
        for p, start in zip(parts, accumulate((p.width for p in parts), initial=0), strict=False):
            asked[:, start + len(p.terms) : start + p.width] = 0.0
    guess = predict_left_out(design, np.concatenate(y), fold, constraint, 1.0 / noise, asked)
    return [guess[low:high] for low, high in pairwise(accumulate(map(len, y), initial=0))]


def equations_in_words(
    parts: Sequence[Component], equations: Sequence[Equation], constraint: Constraint, n_runs: int
) -> list[list[str]]:
    """Per component: whether the data stand the equations, how components are weighed, what comes from equations alone."""
    found = freed(
        [p.matrix for p in parts],
        [p.data.rows.y for p in parts],
        [p.data.run for p in parts],
        constraint,
        [p.errors for p in parts],
        n_runs,
    )
    spoken, tested = [e.spoken for e in equations], int(np.isfinite(found.probability).sum())
    statements = [f"Imposed exactly: {', '.join(spoken)}."]
    rejected, how = found.together < UNLIKELY, " by t tests of the free fit (errors by run, CR2)"
    how += f", p times {tested} for that many equations" if tested > 1 else ""
    for text, p in zip(spoken, np.minimum(found.probability * tested, 1.0), strict=True):
        if np.isfinite(p):
            verb = "reject" if p < UNLIKELY else "do not contradict"
            statements.append(f"The data {verb} {text} ({chance(p)}){how}.")
            how = ""
            rejected |= p < UNLIKELY
    untold = [t for t, p in zip(spoken, found.probability, strict=True) if not np.isfinite(p)]
    if untold and np.isfinite(found.together):
        verb = "reject" if found.together < UNLIKELY else "do not contradict"
        statements.append(f"The data {verb} {' with '.join(untold)} ({chance(found.together)}){how}.")
    elif untold:
        statements.append(
            f"Not tested, since without the equations the rows do not determine a coefficient: {', '.join(untold)}."
        )
    if rejected:
        statements.append("U95 does not include the error from a rejected equation.")
    if len(parts) > 1:
        sizes = [scatter(p.matrix, p.data.rows.y, p.errors) for p in parts]
        listed = ", ".join(f"{p.name}' {s:.2g}" for p, s in zip(parts, sizes, strict=True))
        low, high = int(np.argmin(sizes)), int(np.argmax(sizes))
        statements.append(
            f"Components are combined with weights 1 / scatter^2 of their own free residuals ({listed}; the size of the "
            f"response where no residual is left): a row of {parts[low].name} counts as "
            f"{(sizes[high] / sizes[low]) ** 2:.3g} rows of {parts[high].name}."
        )
    out, at = [], 0
    for p in parts:
        free = [s for s, is_open in zip(p.every_symbol, found.open[at : at + p.width], strict=True) if is_open]
        at += p.width
        idle = p.idle
        own = [f"{s} comes from the equations alone: its motion does not occur in the rows of {p.name}." for s in idle]
        if rest := [s for s in free if s not in idle]:
            own.append(f"Without the equations the rows do not determine: {', '.join(rest)}.")
        out.append([*statements, *own])
    return out


def poolings(
    parts: Sequence[Component], constraint: Constraint, fits: Sequence[LinearFit], thirds: Sequence[OutOfSample]
) -> list[Pooling]:
    """What every campaign adds to each component, and the test of one law.

    Parameters
    ----------
    parts : sequence of Component
        Tied by ``constraint``.
    constraint : Constraint
    fits : sequence of LinearFit
        Of every part, intercepts included.
    thirds : sequence of OutOfSample
        Prediction of every third point, a part each.
    """
    origin = np.concatenate([p.data.campaign for p in parts])
    guesses = predicted(parts, constraint, origin, own=False)
    return [_pooling(*each) for each in zip(parts, fits, guesses, thirds, strict=True)]


def _pooling(part: Component, fit: LinearFit, guess: Array, third: OutOfSample) -> Pooling:
    data, y = part.data, part.data.rows.y
    alone = {k: _alone(part, k) for k in data.present}
    shares = []
    for at, k in enumerate(data.present):
        rows, place = data.campaign == k, len(part.terms) + at
        intercept = float(fit.coefficients[place]) if part.own else float("nan")
        half = float(fit.half_width[place]) if part.own else float("nan")
        noise = np.ones(1) if part.errors is None else part.errors[rows]
        shares.append(
            CampaignShare(
                campaign=data.campaigns[k],
                n_points=int(rows.sum()),
                intercept=finite(intercept),
                half_width=finite(half),
                noise=float(np.sqrt(np.mean(noise**2))),
                rms=float(np.sqrt(np.mean(fit.residuals[rows] ** 2))),
                rms_alone=alone[k].rms,
                left_out=_left_out(data.campaigns[k], y[rows], guess[rows], own=part.own),
            )
        )
    if len(shares) == 1 or part.errors is None:
        return Pooling(part.name, tuple(shares), third, UNTOLD)
    apart = [np.where((data.campaign == k)[:, None], part.matrix, 0.0) for k in data.present]
    test = poolability(part.matrix, np.column_stack(apart), y, part.errors)
    return Pooling(part.name, tuple(shares), third, test, _values_alone(part, alone))


def _alone(part: Component, campaign: int) -> LinearFit:
    """The same terms fitted to one campaign."""
    rows = part.data.campaign == campaign
    errors = None if part.errors is None else part.errors[rows]
    return fit_linear(part.matrix[rows], part.data.rows.y[rows], errors)


def _left_out(campaign: str, y: Array, guess: Array, *, own: bool) -> OutOfSample:
    """Rows of a campaign predicted from the others; its own force at rest is free where campaigns have one."""
    known = np.isfinite(guess)
    constant = float(np.mean(y[known] - guess[known])) if own and np.any(known) else 0.0
    how = f"{campaign} left out" + (", but for one constant of its own" if own else "")
    return errors_of(how, y, guess + constant)


def _values_alone(
    part: Component, alone: dict[int, LinearFit]
) -> tuple[tuple[str, tuple[tuple[str, float, float], ...]], ...]:
    """Coefficients that at least two campaigns determine by themselves, with half-widths."""
    out = []
    for i, symbol in enumerate(part.symbols):
        values = tuple(
            (part.data.campaigns[k], float(f.coefficients[i]), float(f.half_width[i]))
            for k, f in alone.items()
            if np.isfinite(f.coefficients[i])
        )
        if len(values) > 1:
            out.append((symbol, values))
    return tuple(out)


NO_CAMPAIGN = "Each campaign left out in turn: needs two campaigns."


@dataclass(frozen=True, slots=True, eq=False)
class JointFit:
    """Models of all components.

    Attributes
    ----------
    models : tuple of FittedModel
        In the order of the components.
    spread : (p, n_runs) array
        S with S S' the covariance of all coefficients, errors of one run correlated as the residuals are.
    poolings : tuple of Pooling
        One a component where the tables are of several campaigns.
    short : dict of components to TooFewRowsError
        Those that are not fitted, alone or with those that equations link to them.
    """

    models: tuple[FittedModel, ...]
    spread: Array
    poolings: tuple[Pooling, ...]
    short: dict[tuple[str, ...], TooFewRowsError]


def _one(part: Component, form: str, n_runs: int) -> tuple[FittedModel, Array]:
    rows = replace(part.data.rows, errors=part.errors)
    model = model_of(rows, tuple(t.term for t in part.terms), part.symbols, form, lines=part.lines)
    moves = influence(part.matrix, part.errors)
    return model, spread_by_run(model.fit, moves, part.data.run, n_runs)


def _excited(parts: Sequence[Component], constraint: Constraint) -> None:
    """Refuse terms that neither a row nor an equation holds.

    Raises
    ------
    InputError
    """
    named = np.any(constraint[0] != 0.0, axis=0)
    at = 0
    for p in parts:
        empty = [s for s in p.idle if not named[at + p.symbols.index(s)]]
        at += p.width
        if empty:
            raise input_error(
                "fits.zero_on_every_row", column="terms", empty=", ".join(empty), campaign=p.data.rows.campaign
            )


def _several(
    parts: Sequence[Component], constraint: Constraint, form: str, n_runs: int
) -> tuple[list[FittedModel], list[LinearFit], list[Array]]:
    """Models, whole fits with intercepts, and the spread of the common coefficients, a part each."""
    _excited(parts, constraint)
    try:
        fit, spread = fit_stacked(
            [p.matrix for p in parts],
            [p.data.rows.y for p in parts],
            [p.data.run for p in parts],
            constraint,
            [p.errors for p in parts],
            n_runs,
        )
    except ValueError as why:
        raise input_error("fits.equations_some_coefficients_can", column="constraints", found=str(why)) from None
    # Equations make some coefficients multiples of each other; that is no collinearity of the rows.
    by_rows = np.where(np.abs(fit.correlation) > 1.0 - 1e-9, 0.0, fit.correlation)
    statements = in_words(replace(fit, correlation=by_rows), tuple(s for p in parts for s in p.every_symbol))
    models, wholes, spreads = [], [], []
    cuts = list(accumulate((len(p.data.run) for p in parts), initial=0))
    design, noise = stack([p.matrix for p in parts], [p.data.rows.y for p in parts], [p.errors for p in parts])
    blocks = [
        Block(slice(*cut), tuple(t.term for t in p.terms), p.data.rows.x, p.lines)
        for cut, p in zip(pairwise(cuts), parts, strict=True)
    ]
    missing, found = left_out(design, fit.residuals, noise, constraint if len(constraint[1]) else None, blocks)
    none = min(n for n, _ in found)
    row, column = 0, 0
    for p, (_, likeliest) in zip(parts, found, strict=True):
        rows, common = p.data.rows, slice(column, column + len(p.terms))
        shares, every = slice(row, row + len(rows.y)), slice(column, column + p.width)
        row, column = shares.stop, every.stop
        y = rows.y - p.intercepts @ np.nan_to_num(fit.coefficients[common.stop : every.stop])
        wholes.append(part_of(fit, shares, every, rows.y, p.matrix))
        spreads.append(spread[common])
        models.append(
            FittedModel(
                response=p.name,
                unit="1",
                form=form,
                symbols=p.symbols,
                terms=tuple(t.term for t in p.terms),
                fit=replace(
                    part_of(fit, shares, common, y, p.matrix), aicc=fit.aicc if len(parts) == 1 else float("nan")
                ),
                domain=Domain.of(rows.x, Extrapolation.REFUSE, terms=tuple(t.term for t in p.terms)),
                table=", ".join(rows.tables),
                campaign=rows.campaign,
                body=rows.body,
                x=rows.x,
                y=y,
                labels=rows.labels,
                set_aside=None if p.own else rows.set_aside,
                remainder=None
                if np.max(np.abs(fit.residuals[shares])) <= ROUNDING * float(np.max(np.abs(y), initial=0.0))
                else judged(missing[common, common], none, likeliest, fit.coefficients[common], fit.half_width[common]),
                statements=tuple(
                    s for s in statements if any(name in s.replace(",", " ").split() for name in p.symbols)
                ),
            )
        )
    return models, wholes, spreads


def joint_models(
    components: Mapping[str, Component], equations: Sequence[Equation], form: str, *, n_runs: int
) -> JointFit:
    """Fit all components; those that equations link, together.

    Parameters
    ----------
    components : mapping of str to Component
    equations : sequence of Equation
    form : str
    n_runs : int
        Runs of all tables.

    Raises
    ------
    InputError
        Too few rows of every component, a term that no row excites, an unknown coefficient, or equations that cannot hold.
    """
    constraint_of(equations, tuple(components.values()), "constraints")
    models: dict[str, FittedModel] = {}
    spreads: dict[str, Array] = {}
    found: dict[str, Pooling] = {}
    groups = linked(tuple(components), equations)
    short = _short(components, groups, equations)
    for names in (g for g in groups if g not in short):
        parts = [components[c] for c in names]
        own = [e for e in equations if e.weights[0][0][0] in names]
        constraint = constraint_of(own, parts, "constraints")
        if own or parts[0].own:
            fitted, wholes, moved = _several(parts, constraint, form, n_runs)
        else:
            model, spread = _one(parts[0], form, n_runs)
            fitted, wholes, moved = [model], [model.fit], [spread]
        several = len(parts[0].data.campaigns) > 1
        seen = unseen(parts, constraint)
        pooled = poolings(parts, constraint, wholes, [s[0] for s in seen]) if several else []
        among = [p.sentences for p in pooled] if several else [(NO_CAMPAIGN,)] * len(parts)
        extras = equations_in_words(parts, own, constraint, n_runs) if own else [[]] * len(parts)
        for k, c in enumerate(names):
            before = (*components[c].data.statements, *extras[k], *fitted[k].statements)
            models[c] = replace(fitted[k], statements=(*before, *map(str, seen[k]), *among[k]))
            spreads[c] = moved[k]
        found |= dict(zip(names, pooled, strict=bool(pooled)))
    ordered = tuple(found[c] for c in components if c in found)
    fitted_ones = [c for c in components if c in models]
    return JointFit(tuple(models[c] for c in fitted_ones), np.vstack([spreads[c] for c in fitted_ones]), ordered, short)


def _short(
    components: Mapping[str, Component], groups: Sequence[tuple[str, ...]], equations: Sequence[Equation]
) -> dict[tuple[str, ...], TooFewRowsError]:
    """The groups that equations link, with no more rows than free columns.

    Raises
    ------
    TooFewRowsError
        All of them.
    """
    out = {}
    for names in groups:
        parts = [components[c] for c in names]
        labels = [label for p in parts for label in p.data.rows.labels]
        free = sum(p.width for p in parts) - sum(e.weights[0][0][0] in names for e in equations)
        if len(labels) <= free:
            what = "free terms" if len(names) > 1 else "terms"
            what = "free terms and intercepts" if any(p.own for p in parts) else what
            out[names] = TooFewRowsError.for_terms(", ".join(names), labels, free, "terms", what)
    if len(out) == len(groups):
        for names in groups:  # a term that no row excites is why, where there is one
            parts = [components[c] for c in names]
            own = [e for e in equations if e.weights[0][0][0] in names]
            _excited(parts, constraint_of(own, parts, "constraints"))
        raise next(iter(out.values()))
    return out

"""Force laws of several components over several tables, fitted together where equations link them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import accumulate, pairwise

import numpy as np

from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass
from coeflab.fits.joint.components import Component, Constraint, constraint_of, linked
from coeflab.fits.joint.pooling import poolings
from coeflab.fits.joint.unseen_rows import equations_in_words, unseen
from coeflab.fits.results.fitted_model import FittedModel, in_words
from coeflab.fits.results.lack_of_fit import ROUNDING
from coeflab.fits.results.pooling import Pooling
from coeflab.fits.rows.regression import model_of
from coeflab.fits.rows.too_few import TooFewRowsError
from coeflab.fits.statistics.linear_model import LinearFit
from coeflab.fits.statistics.remainder import Block, judged, left_out
from coeflab.fits.statistics.stacked import fit_stacked, influence, part_of, spread_by_run, stack
from coeflab.law.domain import Domain, Extrapolation
from coeflab.law.named_terms import Equation

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

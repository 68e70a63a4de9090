"""Force laws of several components over several tables, fitted together where equations link them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from coeflab.core.errors import InputError
from coeflab.kernels.brief import brief
from coeflab.kernels.least_squares import Array
from coeflab.kernels.linear_model import LinearFit
from coeflab.kernels.stacked import fit_stacked, influence, part_of, spread_by_run
from coeflab.model.fitted_model import Domain, FittedModel, in_words
from coeflab.model.joint_component import Component, Constraint, constraint_of, linked
from coeflab.model.joint_shares import poolings
from coeflab.model.joint_statements import equations_in_words, unseen
from coeflab.model.manoeuvring_terms import Equation
from coeflab.model.pooling import Pooling
from coeflab.model.regression import model_of

NO_CAMPAIGN = "Each campaign left out in turn: not available, as there is one campaign."


@brief
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
    """

    models: tuple[FittedModel, ...]
    spread: Array
    poolings: tuple[Pooling, ...]


def _one(part: Component, form: str, n_runs: int) -> tuple[FittedModel, Array]:
    rows = replace(part.data.rows, errors=part.errors)
    model = model_of(rows, tuple(t.term for t in part.terms), part.symbols, form)
    moves = influence(part.matrix, part.errors)
    return model, spread_by_run(model.fit, moves, part.data.run, n_runs)


def _excited(parts: Sequence[Component], constraint: Constraint) -> None:
    """Refuse more columns than rows, and terms that neither a row nor an equation holds.

    Raises
    ------
    InputError
    """
    n, free = sum(len(p.data.run) for p in parts), sum(p.width for p in parts) - len(constraint[1])
    if n <= free:
        what = "free terms and intercepts" if any(p.own for p in parts) else "free terms"
        raise InputError(
            f"{n} usable rows for {free} {what} of {', '.join(p.name for p in parts)}", "more rows than terms",
            column="terms", advice="Run more points or ask for fewer terms.",
        )  # fmt: skip
    named = np.any(constraint[0] != 0.0, axis=0)
    at = 0
    for p in parts:
        empty = [s for s in p.idle if not named[at + p.symbols.index(s)]]
        at += p.width
        if empty:
            raise InputError(
                f"{', '.join(empty)} zero on every row of {p.data.rows.campaign}", "terms that the data excite",
                column="terms", advice="Leave these terms out, or add runs in which their motion occurs.",
            )  # fmt: skip


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
        raise InputError(str(why), "equations that some coefficients can meet", column="constraints",
                         advice="Two of the equations contradict each other. Remove one.") from None  # fmt: skip
    # Equations make some coefficients multiples of each other; that is no collinearity of the rows.
    by_rows = np.where(np.abs(fit.correlation) > 1.0 - 1e-9, 0.0, fit.correlation)
    said = in_words(replace(fit, correlation=by_rows), tuple(s for p in parts for s in p.every_symbol))
    models, wholes, spreads, row, column = [], [], [], 0, 0
    for p in parts:
        rows, common = p.data.rows, slice(column, column + len(p.terms))
        shares, every = slice(row, row + len(rows.y)), slice(column, column + p.width)
        row, column = shares.stop, every.stop
        y = rows.y - p.intercepts @ np.nan_to_num(fit.coefficients[common.stop : every.stop])
        wholes.append(part_of(fit, shares, every, rows.y))
        spreads.append(spread[common])
        models.append(
            FittedModel(
                response=p.name,
                unit="1",
                form=form,
                symbols=p.symbols,
                terms=tuple(t.term for t in p.terms),
                fit=replace(part_of(fit, shares, common, y), aicc=fit.aicc if len(parts) == 1 else float("nan")),
                domain=Domain.of(rows.x),
                table=", ".join(rows.tables),
                campaign=rows.campaign,
                body=rows.body,
                x=rows.x,
                y=y,
                labels=rows.labels,
                set_aside=None if p.own else rows.set_aside,
                statements=tuple(s for s in said if any(name in s.replace(",", " ").split() for name in p.symbols)),
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
        Too few rows, a term that no row excites, an unknown coefficient, or equations that cannot hold.
    """
    constraint_of(equations, tuple(components.values()), "constraints")
    models: dict[str, FittedModel] = {}
    spreads: dict[str, Array] = {}
    found: dict[str, Pooling] = {}
    for names in linked(tuple(components), equations):
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
    return JointFit(tuple(models[c] for c in components), np.vstack([spreads[c] for c in components]), ordered)

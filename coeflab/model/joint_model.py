"""Force laws of several components over several tables, fitted together where equations link them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.kernels.cross_validation import predict_left_out, thirds
from coeflab.kernels.least_squares import Array, Index
from coeflab.kernels.stacked import fit_stacked, freed, influence, part_of, scatter, spread_by_run
from coeflab.kernels.terms import design
from coeflab.model.fitted_model import Domain, FittedModel, in_words
from coeflab.model.joint_rows import JointRows
from coeflab.model.manoeuvring_terms import Equation, NamedTerm, read_term
from coeflab.model.misfit import UNLIKELY, chance
from coeflab.model.out_of_sample import errors_of
from coeflab.model.regression import model_of

Constraint = tuple[Array, Array]


@dataclass(frozen=True, slots=True, eq=False)
class Component:
    """One force component of a joint fit: its terms and rows."""

    name: str
    terms: tuple[NamedTerm, ...]
    data: JointRows

    @property
    def matrix(self) -> Array:
        """Design, shape (n, p)."""
        return design(tuple(t.term for t in self.terms), self.data.rows.x)

    @property
    def symbols(self) -> tuple[str, ...]:
        """Names of the coefficients."""
        return tuple(t.symbol for t in self.terms)


def constraint_of(equations: Sequence[Equation], terms: Sequence[NamedTerm], place: str) -> Constraint:
    """C and d of C b = d over the coefficients of ``terms``.

    Raises
    ------
    InputError
        An equation names a coefficient that the model does not have.
    """
    index = {t.key: i for i, t in enumerate(terms)}
    matrix = np.zeros((len(equations), len(terms)))
    for row, equation in enumerate(equations):
        for symbol, weight in equation.weights:
            key = read_term(symbol, place).key
            if key not in index:
                names = ", ".join(t.symbol for t in terms)
                raise InputError(f"{shown(symbol)} in {shown(equation)}", f"coefficients of the model: {names}",
                                 column=place, advice=f"Add {symbol} to the terms.")  # fmt: skip
            matrix[row, index[key]] += weight
    return matrix, np.array([e.right for e in equations])


def linked(components: Sequence[str], equations: Sequence[Equation]) -> list[tuple[str, ...]]:
    """Components that equations tie together, in the order given."""
    group = {c: {c} for c in components}
    for equation in equations:
        tied = {symbol[0] for symbol, _ in equation.weights}
        merged = set().union(*(group.get(c, set()) for c in tied))
        for c in merged:
            group[c] = merged
    out: list[tuple[str, ...]] = []
    for c in components:
        if not any(c in g for g in out):
            out.append(tuple(k for k in components if k in group[c]))
    return out


def _left_out(
    parts: Sequence[Component], constraint: Constraint | None, errors: Sequence[Array | None]
) -> list[list[str]]:
    """Statements on rows not seen, per component."""
    runs, first = np.unique(np.concatenate([p.data.run for p in parts]), return_index=True)
    variables = tuple(dict.fromkeys(v for p in parts for v in p.data.rows.x))
    columns = {v: np.concatenate([p.data.rows.x.get(v, np.zeros(len(p.data.run))) for p in parts]) for v in variables}
    tables = np.concatenate([p.data.table for p in parts])
    every_third = thirds([columns[v][first] for v in variables])
    ways = [("Every third point left out", every_third)]
    if len(np.unique(tables)) > 1:
        ways.append(("Each table left out in turn", tables[first]))
    sizes = [len(p.terms) for p in parts]
    stacked = np.zeros((len(tables), sum(sizes)))
    ends = list(pairwise(accumulate((len(p.data.run) for p in parts), initial=0)))
    for p, (low, high), (left, right) in zip(parts, ends, pairwise(accumulate(sizes, initial=0)), strict=True):
        stacked[low:high, left:right] = p.matrix
    y = np.concatenate([p.data.rows.y for p in parts])
    noise = [
        (np.ones(len(p.data.run)) if e is None else e / float(np.sqrt(np.mean(e**2))))
        * scatter(p.matrix, p.data.rows.y, e)
        for p, e in zip(parts, errors, strict=True)
    ]
    said: list[list[str]] = [[] for _ in parts]
    row_run = np.searchsorted(runs, np.concatenate([p.data.run for p in parts]))
    for how, fold in ways:
        predicted = predict_left_out(stacked, y, fold[row_run], constraint, 1.0 / np.concatenate(noise))
        for k, (low, high) in enumerate(ends):
            said[k].append(str(errors_of(how, y[low:high], predicted[low:high])))
    return said


def _one(part: Component, form: str, errors: Array | None, n_runs: int) -> tuple[FittedModel, Array]:
    rows = part.data.rows
    model = model_of(rows, tuple(t.term for t in part.terms), part.symbols, form, weighted=errors is not None)
    moves = influence(part.matrix, errors)
    return model, spread_by_run(model.fit, moves, part.data.run, n_runs)


def _equations_in_words(
    parts: Sequence[Component],
    equations: Sequence[Equation],
    constraint: Constraint,
    errors: Sequence[Array | None],
    n_runs: int,
) -> list[list[str]]:
    """Per component: whether the data stand the equations, how components are weighed, what comes from equations alone."""
    found = freed(
        [p.matrix for p in parts],
        [p.data.rows.y for p in parts],
        [p.data.run for p in parts],
        constraint,
        errors,
        n_runs,
    )
    spoken, tested = [e.spoken for e in equations], int(np.isfinite(found.probability).sum())
    said = [f"Kept exactly: {', '.join(spoken)}."]
    rejected, how = found.together < UNLIKELY, " by t tests of the free fit (errors by run, CR2)"
    how += f", p times {tested} for that many equations" if tested > 1 else ""
    for text, p in zip(spoken, np.minimum(found.probability * tested, 1.0), strict=True):
        if np.isfinite(p):
            verb = "reject" if p < UNLIKELY else "do not contradict"
            said.append(f"The data {verb} {text} ({chance(p)}){how}.")
            how = ""
            rejected |= p < UNLIKELY
    untold = [t for t, p in zip(spoken, found.probability, strict=True) if not np.isfinite(p)]
    if untold and np.isfinite(found.together):
        verb = "reject" if found.together < UNLIKELY else "do not contradict"
        said.append(f"The data {verb} {' with '.join(untold)} ({chance(found.together)}){how}.")
    elif untold:
        said.append(f"Not tested, as the rows without equations leave a coefficient open: {', '.join(untold)}.")
    if rejected:
        said.append("U95 does not hold the error that a rejected equation puts into the values.")
    if len(parts) > 1:
        sizes = [scatter(p.matrix, p.data.rows.y, e) for p, e in zip(parts, errors, strict=True)]
        listed = ", ".join(f"{p.name}' {s:.2g}" for p, s in zip(parts, sizes, strict=True))
        low, high = int(np.argmin(sizes)), int(np.argmax(sizes))
        said.append(
            f"Components are combined with weights 1 / scatter^2 of their own free residuals ({listed}; the size of the "
            f"response where no residual is left): a row of {parts[low].name} counts as "
            f"{(sizes[high] / sizes[low]) ** 2:.3g} rows of {parts[high].name}."
        )
    out, at = [], 0
    for p in parts:
        free = [s for s, lost in zip(p.symbols, found.open[at : at + len(p.terms)], strict=True) if lost]
        at += len(p.terms)
        idle = [s for s, column in zip(p.symbols, p.matrix.T, strict=True) if not np.any(column)]
        own = [f"{s} comes from the equations alone: its motion does not occur in the rows of {p.name}." for s in idle]
        if rest := [s for s in free if s not in idle]:
            own.append(f"Without the equations the rows leave open: {', '.join(rest)}.")
        out.append([*said, *own])
    return out


def _several(
    parts: Sequence[Component], constraint: Constraint, form: str, errors: Sequence[Array | None], n_runs: int
) -> tuple[list[FittedModel], Array]:
    n, free = sum(len(p.data.run) for p in parts), sum(len(p.terms) for p in parts) - len(constraint[1])
    if n <= free:
        raise InputError(
            f"{n} usable rows for {free} free terms of {', '.join(p.name for p in parts)}", "more rows than terms",
            column="terms", advice="Run more points or ask for fewer terms.",
        )  # fmt: skip
    run: list[Index] = [p.data.run for p in parts]
    try:
        fit, spread = fit_stacked(
            [p.matrix for p in parts], [p.data.rows.y for p in parts], run, constraint, errors, n_runs
        )
    except ValueError as why:
        raise InputError(str(why), "equations that some coefficients can meet", column="constraints",
                         advice="Two of the equations contradict each other. Remove one.") from None  # fmt: skip
    symbols = tuple(s for p in parts for s in p.symbols)
    # Equations make some coefficients multiples of each other; that is no collinearity of the rows.
    by_rows = np.where(np.abs(fit.correlation) > 1.0 - 1e-9, 0.0, fit.correlation)
    said = in_words(replace(fit, correlation=by_rows), symbols)
    models, row, column = [], 0, 0
    for p in parts:
        rows = p.data.rows
        shares = slice(row, row + len(rows.y)), slice(column, column + len(p.terms))
        row, column = shares[0].stop, shares[1].stop
        models.append(
            FittedModel(
                response=p.name,
                unit="1",
                form=form,
                symbols=p.symbols,
                terms=tuple(t.term for t in p.terms),
                fit=part_of(fit, *shares, rows.y),
                domain=Domain.of(rows.x),
                table=", ".join(rows.tables),
                campaign=rows.campaign,
                body=rows.body,
                x=rows.x,
                y=rows.y,
                labels=rows.labels,
                statements=tuple(s for s in said if any(name in s.replace(",", " ").split() for name in p.symbols)),
            )
        )
    return models, spread


def joint_models(
    components: Mapping[str, Component], equations: Sequence[Equation], form: str, *, weighted: bool, n_runs: int
) -> tuple[list[FittedModel], Array]:
    """Fit all components; those that equations link, together.

    Parameters
    ----------
    components : mapping of str to Component
    equations : sequence of Equation
    form : str
    weighted : bool
        Weigh rows by their standard errors.
    n_runs : int
        Runs of all tables.

    Returns
    -------
    models : list of FittedModel
        In the order of the components.
    spread : (p, n_runs) array
        S with S S' the covariance of all coefficients, errors of one run correlated as the residuals are.

    Raises
    ------
    InputError
        Too few rows, a term that no row excites, an unknown coefficient, or equations that cannot hold.
    """
    all_terms = [t for c in components.values() for t in c.terms]
    constraint_of(equations, all_terms, "constraints")
    models: dict[str, FittedModel] = {}
    spreads: dict[str, Array] = {}
    for names in linked(tuple(components), equations):
        parts = [components[c] for c in names]
        own = [e for e in equations if e.weights[0][0][0] in names]
        constraint = constraint_of(own, [t for p in parts for t in p.terms], "constraints") if own else None
        errors = [p.data.rows.errors if weighted else None for p in parts]
        if constraint is None:
            model, spread = _one(parts[0], form, errors[0], n_runs)
            fitted = [model]
        else:
            fitted, spread = _several(parts, constraint, form, errors, n_runs)
        said, at = _left_out(parts, constraint, errors), 0
        extras = _equations_in_words(parts, own, constraint, errors, n_runs) if constraint else [[]]
        for c, model, extra, more in zip(names, fitted, extras, said, strict=True):
            words = (*components[c].data.statements, *extra, *model.statements, *more)
            models[c] = replace(model, statements=words)
            spreads[c] = spread[at : at + len(model.symbols)]
            at += len(model.symbols)
    return [models[c] for c in components], np.vstack([spreads[c] for c in components])

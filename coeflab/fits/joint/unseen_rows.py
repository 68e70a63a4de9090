"""What a joint fit says about its equations and about rows that it has not seen."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.joint.components import Component, Constraint
from coeflab.fits.results.lack_of_fit import UNLIKELY, chance
from coeflab.fits.results.out_of_sample import OutOfSample, errors_of
from coeflab.fits.statistics.cross_validation import predict_left_out, thirds
from coeflab.fits.statistics.least_squares import Index
from coeflab.fits.statistics.stacked import freed, scatter, stack
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

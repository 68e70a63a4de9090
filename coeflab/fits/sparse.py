"""Sparse force laws: the few terms of a large library that the data ask for, by pysindy's optimizers.

Library and response are scaled to root mean square 1 first (the default threshold of 0.1 would wipe out coefficients of
hydrodynamic size); the threshold comes from seeded cross-validation, the support is refined by the extended BIC, the
coefficients are a plain least-squares refit. Its intervals do not know that the terms were chosen on the same data.

Needs pysindy >= 2.0. Its `EnsembleOptimizer` draws from numpy's global generator; the resamples here are seeded.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import REPLICATES
from coeflab.core.machine import one_thread
from coeflab.core.options import bounded, one_of, parse_options, words
from coeflab.core.texts import input_error, text_of
from coeflab.core.types import Array
from coeflab.fits.joint.rows import JointRows, joint_rows, measured, moving
from coeflab.fits.results.fit_result import FitResult, independent, result_of
from coeflab.fits.results.fitted_model import FittedModel, coefficient_of
from coeflab.fits.results.lack_of_fit import residuals_in_words
from coeflab.fits.results.out_of_sample import every_third_point
from coeflab.fits.rows.regression import model_of
from coeflab.fits.rows.too_few import TooFewRowsError, each_with_rows
from coeflab.fits.statistics.sparse_selection import Optimizer, Selection, describe, library, scaled, select, twins
from coeflab.law.coefficient import Coefficient
from coeflab.law.named_terms import symmetric
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import COMPONENTS
from coeflab.law.terms import Term, design
from coeflab.tables.force_table import ForceTable, counted_once

summary = "sparse force law: the terms of a library that the data need (pysindy)"
citations = ("brunton2016", "kaptanoglu2022", "fasel2022", "chen2008", "mackinnon1985", "bell2002")

RIDGE = 1e-8
FEWEST_A_FOLD = 2
UNWEIGHTED = "Equal weights: the stated standard errors are the noise of one run, not the error of the model."
AFTER_SELECTION = "The terms were chosen on these rows, so U95 and the error of left-out rows are too small."
WIDER = "Allow a larger library: a higher degree, or more variables."


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    components : tuple of str
        Force components; none given means all that the tables have.
    variables : tuple of str
        Motions and controls of the library; none given means all that the tables vary.
    degree : int
        Largest total degree of a term.
    absolute : str
        ``yes`` puts v|v|, v|r| ... into the library.
    symmetric : str
        ``yes`` allows only terms that a body symmetric port to starboard may have.
    intercepts : str
        ``yes`` fits a constant beside the chosen terms.
    optimizer : str
        ``stlsq`` or ``sr3``.
    folds, ensembles, seed : int
        Cross-validation folds, bootstrap resamples and the seed of both.
    """

    components: tuple[str, ...] = words()
    variables: tuple[str, ...] = words()
    degree: int = bounded(3, 1, 5)
    absolute: str = one_of("yes", "yes", "no")
    symmetric: str = one_of("yes", "yes", "no")
    intercepts: str = one_of("yes", "yes", "no")
    optimizer: str = one_of("stlsq", "stlsq", "sr3")
    folds: int = bounded(5, 2, 20)
    ensembles: int = bounded(100, 0, REPLICATES)
    seed: int = bounded(1, 0, 2**31)


def scaled_optimizer(kind: str) -> Optimizer:
    """An optimizer of pysindy as a function of matrix, response and threshold."""
    import pysindy

    def run(matrix: Array, y: Array, threshold: float) -> Array:
        if kind == "sr3":
            # The proximal step of l0 keeps |b| > sqrt(2 lambda nu).
            optimizer = pysindy.SR3(
                reg_weight_lam=0.5 * threshold**2, relax_coeff_nu=1.0, regularizer="l0", max_iter=500
            )
        else:
            optimizer = pysindy.STLSQ(threshold=threshold, alpha=RIDGE)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="Sparsity parameter is too big")
            warnings.filterwarnings("ignore", message=".*did not converge.*")
            optimizer.fit(matrix, y[:, None])
        coefficients: Array = np.array(optimizer.coef_, dtype=np.float64)
        return coefficients.reshape(-1)

    return run


def _model(data: JointRows, component: str, terms: tuple[Term, ...], chosen: Options, run: Optimizer) -> (
    tuple[FittedModel | None, str]
):  # fmt: skip
    """The fitted model, or None where nothing is chosen; and the selection in short."""
    rows, intercept = data.rows, chosen.intercepts == "yes"
    if len(rows.y) < FEWEST_A_FOLD * chosen.folds:
        raise TooFewRowsError(
            f"{len(rows.y)} usable rows of {component}", f"{FEWEST_A_FOLD} or more for each of {chosen.folds} folds", component, rows.labels,
            FEWEST_A_FOLD * chosen.folds, column="sparse.folds", advice="Ask for fewer folds.",
        )  # fmt: skip
    matrix = design(terms, rows.x)
    selection = select(
        matrix, rows.y, run, seed=chosen.seed, folds=chosen.folds, resamples=chosen.ensembles, intercept=intercept
    )
    taken = tuple(terms[j] for j in selection.support)
    short = " ".join(component + t.suffix for t in taken) or "no term"
    if not taken and not intercept:
        return None, short
    fitted = (*((Term(),) if intercept else ()), *taken)
    symbols = tuple(component + t.suffix for t in fitted)
    model = model_of(rows, fitted, symbols, f"sparse, {chosen.optimizer}", weighted=False, post_selection=True)
    statements = (
        *data.statements,
        *([UNWEIGHTED] if rows.errors is not None else []),
        *_alike(matrix, rows.y, component, terms, intercept),
        *describe(selection, _names(component, terms, selection)),
        *model.secants,
        *model.statements,
        *residuals_in_words(model, WIDER),
        str(every_third_point(model)),
        AFTER_SELECTION,
    )
    return replace(model, statements=statements), short


def _names(component: str, terms: Sequence[Term], selection: Selection) -> dict[int, str]:
    shown_terms = {j for j, f in enumerate(selection.frequency) if f > 0.0}
    return {j: component + terms[j].suffix for j in {*selection.support, *selection.by_threshold, *shown_terms}}


def _alike(matrix: Array, y: Array, component: str, terms: Sequence[Term], intercept: bool) -> list[str]:
    """Terms that the rows cannot tell apart, and terms that they do not excite."""
    unit, _, size, _ = scaled(matrix, y, intercept=intercept)
    out = [
        text_of("fits.not_separated", component=component, one=terms[j].suffix, other=terms[i].suffix)
        for j, i in twins(unit).items()
    ]
    flat = [component + t.suffix for t, s in zip(terms, size, strict=True) if s == 0.0]
    return [*out, f"Not in the library, as no row excites them: {', '.join(flat)}."] if flat else out


def _coefficients(model: FittedModel, citation: str) -> list[Coefficient]:
    refit = f"{model.form}, refit of the chosen terms {' + '.join(model.symbols)}; U95 ignores the choice"
    return [coefficient_of(model, i, citation, estimator=model.one_size(i) or refit) for i in range(len(model.symbols))]


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """Choose and fit the terms of every component.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign, about one reference point.
    scaling : Scaling
        Length of the primes.
    options : mapping
        See `Options`.

    Raises
    ------
    InputError
        Unknown component or variable, or too few rows of every component for the folds.
    """
    chosen = parse_options(Options, options, "sparse")
    run = scaled_optimizer(chosen.optimizer)
    tables = counted_once(tables)
    variables = chosen.variables or moving(tables)
    if not variables:
        raise input_error("fits.nothing_moves", column="sparse.variables")
    components = chosen.components or measured(tables)
    if unknown := [c for c in components if c not in COMPONENTS]:
        raise InputError(shown(unknown[0]), f"some of {', '.join(COMPONENTS)}", column="sparse.components")
    terms = library(variables, chosen.degree, absolute=chosen.absolute == "yes")
    settings = {"optimizer": chosen.optimizer, "folds": str(chosen.folds), "seed": str(chosen.seed)}

    def one(c: str) -> tuple[str, FittedModel | None, str]:
        allowed = tuple(t for t in terms if chosen.symmetric == "no" or symmetric(c, t))
        return c, *_model(joint_rows(tables, variables, c, scaling.length), c, allowed, chosen, run)

    first = tables[0]
    with one_thread():
        found, few = each_with_rows(components, one, first.campaign)
    settings |= {c: short for c, _, short in found}
    models = [model for _, model, _ in found if model is not None]
    coefficients = [c for m in models for c in _coefficients(m, first.source.citation)]
    return result_of(
        "sparse", first, scaling, coefficients, independent([m.covariance for m in models]), citations=citations,
        settings=settings, models=tuple(models), findings=few,
    )  # fmt: skip

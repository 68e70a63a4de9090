"""What the form of a fitted model misses, in words: residuals that are not random, and the next term in a motion.

What a model is worth on rows that it has not seen, as a share of the response's range.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.statistics.groups import predict_left_out, thirds
from coeflab.fits.statistics.linear_model import fit_linear, t_probability
from coeflab.fits.statistics.remainder import Remainder
from coeflab.law.symbols import MOTIONS
from coeflab.law.terms import Term, canonical, design

UNLIKELY = 0.01  # a false alarm in one of a hundred sound fits
ROUNDING = 1e-10  # residuals of an exact form, over the largest value


def chance(probability: float) -> str:
    """A probability as a reader wants it: ``p = 0.042``, ``p < 0.001``."""
    return "p < 0.001" if probability < 1e-3 else f"p = {probability:.2g}"


def residuals_in_words(model: FittedModel, way_out: str = "") -> tuple[str, ...]:
    """What the residuals say against the form: a remainder that they show, else signs that are not random.

    Signs are taken in the order of the rows (Wald & Wolfowitz 1940).

    Parameters
    ----------
    model : FittedModel
    way_out : str
        A sentence on what to do about a form that misses something.

    Returns
    -------
    tuple of str
        Empty where there is probably no remainder and the runs test is not below 0.01, or where the residuals are
        rounding.
    """
    fit = model.fit
    if model.remainder is not None and model.remainder.likeliest:
        return (f"{_remainder_in_words(model, model.remainder)} {way_out}".rstrip(),)
    exact = fit.rms <= ROUNDING * float(np.max(np.abs(model.y), initial=0.0))
    if exact or not fit.runs_probability < UNLIKELY:
        return ()
    signs = fit.residuals[fit.residuals != 0.0] > 0.0
    up = int(signs.sum())
    expected = 1.0 + 2.0 * up * (len(signs) - up) / len(signs)
    found = f"The residuals are not random (runs test, {chance(fit.runs_probability)})"
    if 1 + int(np.count_nonzero(signs[1:] != signs[:-1])) > expected:
        return (f"{found}: they change sign more often than by chance, and the intervals cannot be trusted.",)
    said = f"{found}: the form misses something, and the intervals cannot be trusted."
    return (f"{said} {way_out}".rstrip(),)


def _remainder_in_words(model: FittedModel, found: Remainder) -> str:
    right = "below 0.001" if found.none < 1e-3 else f"{found.none:.2g}"
    said = f"The residuals are not random: the form misses something, most likely {found.likeliest} (a right form: {right})."
    without = model.rejected
    if not without:
        return f"{said} U95 holds what that may move."
    have = "has" if len(without) == 1 else "have"
    return f"{said} It is rejected for {', '.join(without)}, which {have} no U95; that of the others holds what it may move."


def _own_powers(model: FittedModel, variable: str) -> list[tuple[int, bool]]:
    """Power and oddness of the terms in one variable alone."""
    keys = [canonical(t) for t in model.terms]
    return [(k[0][1], k[0][2]) for k in keys if len(k) == 1 and k[0][0] == variable]


def _next(model: FittedModel, variable: str) -> Term | None:
    """x|x| after a line in x; x^3 after x|x| where the residuals are not random; None otherwise."""
    odd = {n for n, is_odd in _own_powers(model, variable) if is_odd}
    if odd == {1}:
        return Term(((variable, 1, False), (variable, 1, True)))
    if odd == {1, 2} and residuals_in_words(model):
        return Term(((variable, 3, False),))
    return None


def next_terms_in_words(
    model: FittedModel, errors: Array | None, asked: str, beside: Array | None = None
) -> tuple[str, ...]:
    """Curvature in a motion that the rows show and the terms lack.

    After a line in a motion the next term is x|x|, after x|x| it is x^3 (the latter where the residuals are not random).
    The t test of its coefficient stands unequal noise (HC2, Bell & McCaffrey 2002).

    Parameters
    ----------
    model : FittedModel
        Over SNAME motions, its coefficients free.
    errors : (n,) array or None
        Standard errors that weighed the rows.
    asked : str
        Set of terms that was asked for, as advice needs it; empty for none.
    beside : (n, k) array, optional
        Columns that were fitted beside the terms.

    Returns
    -------
    tuple of str
        One sentence a term below 0.01, with what it does to the slope.
    """
    matrix, out = design(model.terms, model.x), []
    matrix = matrix if beside is None else np.column_stack([matrix, beside])
    lines = {canonical(t): s for t, s in zip(model.terms, model.symbols, strict=True)}
    if model.fit.rms <= ROUNDING * float(np.max(np.abs(model.y))) or len(model.y) <= matrix.shape[1] + 1:
        return ()
    for variable in (v for v in model.x if v in MOTIONS):
        term, slope = _next(model, variable), lines.get(((variable, 1, True),), "")
        if term is None or not np.isfinite(model.named(slope)[0]):
            continue
        wider = fit_linear(np.column_stack([matrix, term.evaluate(model.x)]), model.y, errors)
        error = float(np.sqrt(wider.covariance[-1, -1]))
        value, moved = float(wider.coefficients[-1]), float(wider.coefficients[model.symbols.index(slope)])
        if not np.isfinite([value, moved, wider.half_width[-1]]).all() or error == 0.0:
            continue
        probability = float(t_probability(value / error, float(wider.freedom[-1])))
        if probability >= UNLIKELY:
            continue
        name = model.response + term.suffix
        with_set = f" beside set = {asked}" if asked else ""
        out.append(
            f"The terms miss curvature in {variable}: with {name} ({chance(probability)}) {slope} goes from "
            f"{model.named(slope)[0]:.3g} to {moved:.3g}. Add {name} to terms{with_set}."
        )
    return tuple(out)


@dataclass(frozen=True, slots=True)
class OutOfSample:
    """Prediction errors of left-out rows.

    Attributes
    ----------
    how : str
        Which rows are left out.
    rms, largest : float
        Share of the response's range; NaN if no row could be predicted.
    predicted, rows : int
        Rows that the others determine, and all rows.
    """

    how: str
    rms: float
    largest: float
    predicted: int
    rows: int

    @property
    def told(self) -> bool:
        """Whether the others determine at least half of the rows, so that an error can be given."""
        return 2 * self.predicted >= max(self.rows, 1) and not isnan(self.rms)

    def __str__(self) -> str:
        if not self.predicted:
            return f"{self.how}: the remaining rows do not determine the model, so nothing can be predicted."
        if isnan(self.rms):
            return f"{self.how}: the left-out rows do not vary, so no error is given as a share of their range."
        missing = self.rows - self.predicted
        if not self.told:
            return (
                f"{self.how}: the remaining rows determine only {self.predicted} of {self.rows} left-out rows, so no "
                "error is given."
            )
        rest = f"; {missing} of {self.rows} rows are not determined by the others" if missing else ""
        return (
            f"{self.how}: the left-out rows are predicted to {100 * self.rms:.2f} % rms, {100 * self.largest:.2f} % at "
            f"most, of the response's range{rest}."
        )


def errors_of(how: str, response: Array, predicted: Array) -> OutOfSample:
    """Compare predictions, NaN where there is none, with what was measured."""
    known = np.isfinite(predicted)
    size = float(np.ptp(response)) or float("nan")
    error = np.abs(predicted[known] - response[known]) / size
    rms = float(np.sqrt(np.mean(error**2))) if error.size else float("nan")
    return OutOfSample(how, rms, float(error.max()) if error.size else float("nan"), int(known.sum()), len(response))


def every_third_point(model: FittedModel) -> OutOfSample:
    """Leave every third point out, each point once: rows sorted by the motion variables, ends included."""
    fold = thirds(list(model.x.values()))
    predicted = predict_left_out(design(model.terms, model.x), model.y, fold)
    return errors_of("Every third point left out", model.y, predicted)

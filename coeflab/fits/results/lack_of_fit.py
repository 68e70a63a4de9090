"""What the form of a fitted model misses, in words: residuals that are not random, and the next term in a motion."""

from __future__ import annotations

import numpy as np

from coeflab.core.types import Array
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.statistics.linear_model import fit_linear
from coeflab.fits.statistics.remainder import Remainder
from coeflab.fits.statistics.robust_errors import t_probability
from coeflab.law.named_terms import canonical
from coeflab.law.symbols import MOTIONS
from coeflab.law.terms import Term, design

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
    words = f"{found}: the form misses something, and the intervals cannot be trusted."
    return (f"{words} {way_out}".rstrip(),)


def _remainder_in_words(model: FittedModel, found: Remainder) -> str:
    right = "below 0.001" if found.none < 1e-3 else f"{found.none:.2g}"
    held = next((t for t in model.terms if found.likeliest == f"a term {t}"), None)
    likeliest = found.likeliest if held is None else f"a coefficient of {held} that no equation holds"
    words = f"The residuals are not random: the form misses something, most likely {likeliest}; probability that it misses nothing: {right}."
    without = model.rejected
    if not without:
        return f"{words} U95 includes what that may change."
    have = "has" if len(without) == 1 else "have"
    return f"{words} It is rejected for {', '.join(without)}, which {have} no U95; that of the others includes what it may change."


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
    model: FittedModel, errors: Array | None, asked: str, set_aside: Array | None = None
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
    set_aside : (n, k) array, optional
        Columns that were fitted beside the terms.

    Returns
    -------
    tuple of str
        One sentence a term below 0.01, with what it does to the slope.
    """
    matrix, out = design(model.terms, model.x), []
    matrix = matrix if set_aside is None else np.column_stack([matrix, set_aside])
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

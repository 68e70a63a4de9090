"""Rotary derivatives from a rotating arm beside those from oscillation (PMM): can the range of the rate explain both?"""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.table import Check, Severity
from coeflab.fits.results.fit_result import FitResult, Sweep
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.rows.regression import Rows, model_of
from coeflab.fits.rows.sweeps import explain
from coeflab.law.symbols import primed
from coeflab.law.terms import parse_suffix
from coeflab.study.study import Study
from coeflab.vehicle.reference import PublishedValue, Reference

summary = "slope at the origin, secant and published oscillation value of rotary derivatives"
citations = ("roddy1990",)

RATES = ("p", "q", "r")
FEWEST = 5


def _law(sweep: Sweep) -> FittedModel:
    """Slope with x|x| or x^3, whichever has the lower AICc."""
    rows = Rows({sweep.variable: sweep.x}, sweep.y, None, sweep.labels, sweep.component, (sweep.table,), sweep.campaign,
                sweep.body)  # fmt: skip
    v = sweep.variable
    fitted = []
    for high in (f"{v}|{v}|", v * 3):
        suffixes = ("0", v, high)
        symbols = tuple(sweep.component + s for s in suffixes)
        fitted.append(model_of(rows, tuple(parse_suffix(s) for s in suffixes), symbols, f"{v} + {high}"))
    return min(fitted, key=lambda m: m.fit.aicc)


def _published(study: Study, sweep: Sweep) -> list[tuple[Reference, str, PublishedValue]]:
    """Oscillation values of the same body and symbol."""
    return [
        (r, kind.method, v)
        for r in study.references
        if r.body == sweep.body
        for kind in r.literature
        for v in kind.values
        if v.symbol == sweep.symbol and v.value is not None
    ]


def _said(fit: FitResult, sweep: Sweep, reference: Reference, method: str, published: PublishedValue) -> Check:
    value = (published.value or 0.0) * reference.scaling.ratio(sweep.symbol, fit.coefficients.scaling)
    found = explain(_law(sweep), sweep.symbol, value, f"{method} ({reference.name})")
    s = found.secant
    return Check(
        "oscillation",
        f"{sweep.campaign} {primed(sweep.symbol)}",
        Severity.NOTE,
        f"origin {s.slope:.3g}, secant to {s.variable}' = {s.reach:.3g} {s.secant:.3g}, {method} {value:.3g}",
        "the range of the rate explains the difference",
        found.sentence,
    )


def check(study: Study) -> Sequence[Check]:
    """One note per rotary derivative that a sweep gives and an oscillation test of the same body published."""
    return [
        _said(fit, sweep, *published)
        for fit in study.fits
        for sweep in fit.sweeps
        if sweep.variable in RATES and sweep.parity == "odd" and len(sweep.x) >= FEWEST
        for published in _published(study, sweep)
    ]

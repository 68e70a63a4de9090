"""Rotary derivatives from a rotating arm beside those from oscillation (PMM): can the range of the rate explain both?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy import special

from coeflab.core.finding import Severity
from coeflab.core.table import Check
from coeflab.fits.rows.secant import Secant, explained
from coeflab.law.symbols import primed

if TYPE_CHECKING:
    from coeflab.fits.results.fit_result import FitResult, Sweep
    from coeflab.study.study import Study
    from coeflab.vehicle.published_values import PublishedValue, Reference

summary = "slope at the origin, secant and published oscillation value of rotary derivatives"
citations = ("roddy1990",)

RATES = ("p", "q", "r")
FEWEST = 5


def _tied(sweep: Sweep, slope: float) -> tuple[Secant, dict[int, float]]:
    """The recommended slope and the one of x|x| and x^3 that fits the rest better, as powers of x, and their secant."""
    x, y = sweep.x[sweep.used], sweep.y[sweep.used]
    offset = np.ones_like(x) if np.any(x < 0.0) and np.any(x > 0.0) else np.zeros_like(x)
    reach, freedom = float(np.max(np.abs(x))), len(x) - 1 - int(offset[0])
    found = []
    for power in (2, 3):
        columns = np.column_stack([np.sign(x) * np.abs(x) ** power, offset])
        solved = np.linalg.lstsq(columns, y - slope * x)[0]
        rest = y - slope * x - columns @ solved
        found.append((float(rest @ rest), power, float(solved[0]), float(np.linalg.pinv(columns.T @ columns)[0, 0])))
    scatter, power, high, variance = min(found)
    half = float(special.stdtrit(freedom, 0.975)) * np.sqrt(variance * scatter / freedom) * reach ** (power - 1)
    here = Secant(sweep.symbol, sweep.variable, slope, slope + high * reach ** (power - 1), float(half), reach)
    return here, {1: slope, power: high}


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


def _note(
    fit: FitResult, sweep: Sweep, slope: float, reference: Reference, method: str, published: PublishedValue
) -> Check:
    value = (published.value or 0.0) * reference.scaling.ratio(sweep.symbol, fit.coefficients.scaling)
    found = explained(*_tied(sweep, slope), value, f"{method} ({reference.name})")
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
        _note(fit, sweep, sweep.value, *published)
        for fit in study.fits
        for sweep in fit.sweeps
        if sweep.variable in RATES and sweep.parity == "odd" and sweep.value is not None and sweep.used.sum() >= FEWEST
        for published in _published(study, sweep)
    ]

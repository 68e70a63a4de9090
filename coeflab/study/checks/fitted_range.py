"""Slopes that a longer sweep moves and makes less certain: more data should narrow an interval, and leave its value inside.

A curve that bends beyond some setting cannot be told from one that bends at the origin. The value stays that of the whole
sweep, as the method says; the finding names what a shorter one gives.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import Check, plus_minus
from coeflab.law.symbols import primed

if TYPE_CHECKING:
    from coeflab.fits.results.fit_result import Sensitivity, Sweep
    from coeflab.study.study import Study

summary = "slopes whose U95 grows, and whose value moves beyond U95 of a shorter sweep, with the largest setting"
citations = ("ittc_uncertainty",)

# Half as much again: more points at larger settings leave U95 of a curve that the shorter sweep shows, too, as it is or smaller.
WIDER = 1.5
MOVED = 0.1  # of the value: a smaller move is a note


def check(study: Study) -> Sequence[Check]:
    """One finding a slope, about the shorter sweep that gives the narrowest interval."""
    out = []
    for fit in study.fits:
        for sweep in fit.sweeps:
            c = fit.coefficients[sweep.symbol]
            without = c.value is None or c.u95 is None or bool(sweep.by_symmetry)  # a copy says nothing of its own
            shorter = None if without else moved_by_the_rest(sweep)
            if shorter is not None:
                out.append(_as_check(fit.campaign, sweep, shorter))
    return out


def moved_by_the_rest(sweep: Sweep) -> Sensitivity | None:
    """The shorter sweep of narrowest U95 beyond which value and U95 of the whole one lie; None where there is none.

    Parameters
    ----------
    sweep : Sweep
        Its value and U95 are of all settings.
    """
    if sweep.target != "x" or sweep.value is None or sweep.u95 is None:
        return None
    found = [
        s for s in sweep.sensitivity
        if s.value is not None and s.u95 is not None and sweep.u95 > WIDER * s.u95 and abs(sweep.value - s.value) > s.u95
    ]  # fmt: skip
    return min(found, key=lambda s: s.u95 or np.inf, default=None)


def _as_check(campaign: str, sweep: Sweep, shorter: Sensitivity) -> Check:
    apart = abs((sweep.value or 0.0) - (shorter.value or 0.0))
    severity = Severity.WARN if apart > MOVED * abs(sweep.value or 0.0) else Severity.NOTE
    name, at = primed(sweep.symbol), _setting(sweep, shorter.cap)
    reach = _setting(sweep, float(np.max(np.abs(sweep.x))))
    return Check.of(
        "fitted_range.moved", f"{campaign} {name}", severity, symbol=name, value=plus_minus(sweep.value, sweep.u95), reach=reach, at=at,
        shorter=plus_minus(shorter.value, shorter.u95), wider=WIDER,
    )  # fmt: skip


def _setting(sweep: Sweep, value: float) -> str:
    if sweep.is_angle:
        return f"{np.degrees(np.arcsin(min(value, 1.0))):.3g} deg"
    return f"{np.degrees(value):.3g} deg" if sweep.variable in ("dr", "ds", "db") else f"{sweep.variable}' {value:.3g}"

"""Where the side force acts: x = Nv'/Yv' forward of the reference point, and -Mw'/Zw' in the vertical plane."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.model.check import Check, Severity
from coeflab.model.coefficient import CoefficientSet
from coeflab.model.study import Study

summary = "x = Nv'/Yv' and -Mw'/Zw' with intervals"
citations = ("feldman1979",)


def ratio_interval(s: CoefficientSet, moment: str, force: str) -> tuple[float, float | None]:
    """Ratio moment / force and its 95 % half-width by first-order propagation with covariance."""
    m, f = s[moment], s[force]
    if m.value is None or f.value is None:
        return float("nan"), None
    ratio = m.value / f.value
    i, j = s.symbols.index(moment), s.symbols.index(force)
    c = s.covariance[np.ix_([i, j], [i, j])]
    gradient = np.array([1.0, -ratio]) / f.value
    variance = float(gradient @ c @ gradient)
    return ratio, 2.0 * variance**0.5 if variance >= 0.0 else None


def check(study: Study) -> Sequence[Check]:
    """One note per campaign and plane; a centre outside the hull only says that the moment is mostly a couple."""
    out = []
    for fit in study.fits:
        s = fit.coefficients
        for moment, force, sign in (("Nv", "Yv", 1.0), ("Mw", "Zw", -1.0)):
            if moment not in s or force not in s or s[moment].value is None or not s[force].value:
                continue
            x, half = ratio_interval(s, moment, force)
            x *= sign
            within = "" if half is None else f" +- {half:.2g}"
            out.append(
                Check(
                    "centre_of_pressure",
                    f"{fit.campaign} {moment}'/{force}'",
                    Severity.NOTE,
                    f"x/L = {x:.3f}{within}, {x * s.scaling.length:.3f} m forward of the reference point",
                    "none",
                    "Beyond the bow: the Munk moment outweighs the lever of the force."
                    if abs(x) > 0.5
                    else "The force acts within the hull.",
                )
            )
    return out

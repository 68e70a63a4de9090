"""Where the side force acts: x = Nv'/Yv' forward of the reference point, and -Mw'/Zw' in the vertical plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Severity
from coeflab.core.table import Check, plus_minus
from coeflab.vehicle.stability import centre_of_pressure

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "x = Nv'/Yv' and -Mw'/Zw' with intervals"
citations = ("feldman1979",)

BEHIND = "Right for large fins, or a reference point near the nose; else the sign of {} or a declared axis is wrong."


def check(study: Study) -> Sequence[Check]:
    """One note per campaign and plane; a centre outside the hull only says that the moment is mostly a couple."""
    out = []
    for fit in study.fits:
        for d in centre_of_pressure(fit.coefficients, fit.campaign):
            found = f"{d.value:.3f}" if d.result is None else plus_minus(d.value, d.result.linear)
            metres = d.value * fit.coefficients.scaling.length
            way, motion = "ahead of" if metres >= 0.0 else "behind", "sway" if d.name.startswith("Nv") else "heave"
            out.append(
                Check(
                    "centre_of_pressure",
                    f"{fit.campaign} {motion}",
                    Severity.NOTE,
                    f"{abs(metres):.2g} m {way} the reference point ({d.name} = {found} L)",
                    "",
                    BEHIND.format("N" if motion == "sway" else "M")
                    if metres < 0.0
                    else "Beyond the hull's ends: the Munk moment outweighs the lever of the force."
                    if d.value > 0.5
                    else "The force at an angle acts inside the hull.",
                )
            )
    return out

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


def check(study: Study) -> Sequence[Check]:
    """One note per campaign and plane; a centre outside the hull only says that the moment is mostly a couple."""
    out = []
    for fit in study.fits:
        for d in centre_of_pressure(fit.coefficients, fit.campaign):
            found = f"{d.value:.3f}" if d.result is None else plus_minus(d.value, d.result.linear)
            metres = d.value * fit.coefficients.scaling.length
            way, motion = "ahead of" if metres >= 0.0 else "behind", "sway" if d.name.startswith("Nv") else "heave"
            out.append(Check.of(
                "centre_of_pressure.place", f"{fit.campaign} {motion}", Severity.NOTE, metres=abs(metres), way=way, ratio=d.name,
                found=found, moment="N" if motion == "sway" else "M",
                place="behind" if metres < 0.0 else "beyond" if d.value > 0.5 else "inside",
            ))  # fmt: skip
    return out

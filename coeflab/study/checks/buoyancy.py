"""Whether the mass of a vehicle from its shape goes with the water that the shape displaces."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.table import Check, Severity
from coeflab.study.study import Study
from coeflab.vehicle.from_shape import displaced_mass, floods

summary = "mass of a vehicle from its shape against its displacement"
citations = ("sname1950",)

APART = 0.20
LIGHT = "Unit of --mass or of the mesh? Rooms that flood: [[mass]] with flooded = true in its body.toml."
HEAVY = (
    "Unit of --mass or of the mesh? A mesh of the pressure hull alone? Water in the hull: [[mass]] with flooded = true."
)


def check(study: Study) -> Sequence[Check]:
    """A warning beyond 20 % of the displacement where no flooded room and no ballast is declared."""
    if study.shape is None:
        return []
    weighed = study.shape.weighed
    mass, displaced = weighed.configuration.mass, displaced_mass(weighed.body, study.shape.conditions.density)
    if mass is None or "mass" in weighed.assumed or floods(weighed.body):
        return []
    apart = mass.mass / displaced - 1.0
    bad = abs(apart) > APART
    statistic = f"{mass.mass:.4g} kg in {displaced:.4g} kg of displacement, {100.0 * apart:+.0f} %"
    comment = (LIGHT if apart < 0.0 else HEAVY) if bad else ""
    return [
        Check("buoyancy", weighed.body.name, Severity.WARN if bad else Severity.PASS, statistic, "within 20 %", comment)
    ]

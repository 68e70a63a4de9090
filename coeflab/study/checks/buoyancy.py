"""Whether the mass of a vehicle from its shape goes with the water that the shape displaces."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import Check

if TYPE_CHECKING:
    from coeflab.study.study import FromShape, Study

summary = "mass of a vehicle from its shape against its displacement"
citations = ("sname1950",)

APART = 0.20
LIGHT = "Unit of the mass or of the mesh? Rooms that flood: [[mass]] with flooded = true in its body.toml."
HEAVY = "Unit of the mass or of the mesh? A mesh of the pressure hull alone? Water in the hull: [[mass]] with flooded = true."


STEEP = float(np.radians(5.0))  # of trim or list at rest
AS_BALLASTED = "As if ballasted to neutral at the centre of buoyancy. "
LEVEL_IT = "Move the centre of gravity below the centre of buoyancy: masses, or ballast away from it."


def check(study: Study) -> Sequence[Check]:
    """A warning beyond 20 % of the displacement where no flooded room and no ballast is declared; and beyond 5 deg of trim or list."""
    return [] if study.shape is None else [*_mass(study.shape), *_trim(study.shape)]


def _trim(shape: FromShape) -> list[Check]:
    """A warning for a stated centre of gravity with which the vehicle does not hang level."""
    from coeflab.bodies.mass_model import at_rest

    weighed = shape.weighed
    mass, middle = weighed.configuration.mass, weighed.configuration.centre_of_buoyancy
    if mass is None or middle is None or "centre" in weighed.assumed:
        return []
    angles = weighed.at_rest or at_rest(0.0, mass.centre_of_gravity + weighed.body.reference_point - middle)
    if angles is None or max(map(abs, angles)) <= STEEP:
        return []
    pitch, roll = np.degrees(angles)
    statistic = (
        f"at rest it hangs with pitch {pitch:+.1f} deg (bow {'up' if pitch > 0.0 else 'down'}), roll {roll:+.1f} deg"
    )
    comment = f"{AS_BALLASTED if weighed.at_rest is None else ''}{LEVEL_IT}"
    return [Check("trim_at_rest", weighed.body.name, Severity.WARN, statistic, "within 5 deg", comment)]


def _mass(shape: FromShape) -> list[Check]:
    from coeflab.vehicle.from_shape import displaced_mass, floods

    weighed = shape.weighed
    mass, displaced = weighed.configuration.mass, displaced_mass(weighed.body, shape.conditions.density)
    if mass is None or "mass" in weighed.assumed or floods(weighed.body):
        return []
    apart = mass.mass / displaced - 1.0
    bad = abs(apart) > APART
    statistic = f"{mass.mass:.4g} kg in {displaced:.4g} kg of displacement, {100.0 * apart:+.0f} %"
    comment = (LIGHT if apart < 0.0 else HEAVY) if bad else ""
    return [
        Check("buoyancy", weighed.body.name, Severity.WARN if bad else Severity.PASS, statistic, "within 20 %", comment)
    ]

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


STEEP = float(np.radians(5.0))  # of trim or list at rest


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
    return [Check.of(
        "trim_at_rest.angles", weighed.body.name, Severity.WARN, pitch=float(pitch), roll=float(roll), bow="up" if pitch > 0.0 else "down",
        ballast="assumed" if weighed.at_rest is None else "known",
    )]  # fmt: skip


def _mass(shape: FromShape) -> list[Check]:
    from coeflab.vehicle.from_shape import displaced_mass, floods

    weighed = shape.weighed
    mass, displaced = weighed.configuration.mass, displaced_mass(weighed.body, shape.conditions.density)
    if mass is None or "mass" in weighed.assumed or floods(weighed.body):
        return []
    apart = mass.mass / displaced - 1.0
    bad = abs(apart) > APART
    return [Check.of(
        "buoyancy.mass", weighed.body.name, Severity.WARN if bad else Severity.PASS, mass=mass.mass, displaced=displaced,
        apart=100.0 * apart, match="good" if not bad else "light" if apart < 0.0 else "heavy",
    )]  # fmt: skip

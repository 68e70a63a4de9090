"""Vehicles and manoeuvres of the simulators' tests; all synthetic."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.core.axes import Datum
from coeflab.law.added_mass import AddedMass
from coeflab.motion.manoeuvre import Manoeuvre, Phase, Until
from coeflab.motion.vehicle import Vehicle, vehicle
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics, ParameterSurface
from tests.formats.massed import ADDED, CENTRE, MASS, VALUES, with_mass
from tests.vehicle.test_force_law import parameters

SPEED, RUDDER, RATE = 1.5, 0.3, 0.5


def swimmer(smooth: bool = False) -> Vehicle:
    """The torpedo with a rudder that turns at 0.5 rad/s and its centre of buoyancy above that of gravity.

    Smooth: without v|v|, whose third derivative jumps, so that an order of four can be seen.
    """
    surface = ParameterSurface(control="dr", limit=0.6, rate=RATE)
    afloat = ParameterHydrostatics(volume=MASS / 1000.0, centre_of_buoyancy=(CENTRE[0], CENTRE[1], CENTRE[2] - 0.05))
    values = {s: c for s, c in VALUES.items() if not (smooth and "|" in s)}
    file = with_mass(parameters(values, AddedMass(ADDED, np.zeros(3), Datum("nose"), "body of tow", "panel")))
    return vehicle(file.model_copy(update={"surfaces": (surface,), "hydrostatics": afloat}))


def massive(
    added: np.ndarray | None = None, centre: np.ndarray = CENTRE, values: dict[str, float] | None = None,
    free: Sequence[str] = (), **more: object,
) -> Vehicle:  # fmt: skip
    """The torpedo's mass with an added mass and coefficients of one's own."""
    hull = None if added is None else AddedMass(added, np.zeros(3), Datum("nose"), "body of tow", "panel")
    file: ParameterFile = with_mass(parameters(values or {}, hull), centre).model_copy(update=more)
    return vehicle(file, free)


def coasting(seconds: float, velocity: Sequence[float], thrust: float = 0.0) -> Manoeuvre:
    return Manoeuvre("coast", (Phase("coast", {"thrust": thrust}, seconds),), np.array(velocity, dtype=float))


def zigzag(v: Vehicle, angle: float = 0.25) -> Manoeuvre:
    """Rudder over at 2 s, against the heading at each overshoot, then amidships."""
    phases = (
        Phase("approach", {"thrust": v.resistance(SPEED)}, 2.0),
        Phase("port", {"dr": RUDDER}, 60.0, Until("heading", False, -angle)),
        Phase("starboard", {"dr": -RUDDER}, 60.0, Until("heading", True, angle)),
        Phase("amidships", {"dr": 0.0}, 4.0),
    )
    return Manoeuvre("zigzag", phases, np.array([SPEED, 0.0, 0.0, 0.0, 0.0, 0.0]))

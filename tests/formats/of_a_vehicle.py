"""The torpedo as a vehicle, heavier than the water it displaces: hydrostatics, a thruster, and a rudder with limits."""

from __future__ import annotations

import numpy as np

from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_parts import ParameterHydrostatics, ParameterSurface, ParameterThruster
from tests.formats.massed import CENTRE, MASS, torpedo
from tests.rigid_motion import rotation

VOLUME, BUOYANT, GRAVITY = 0.055, (0.09, 0.02, -0.05), 9.7
PROPELLER = {
    "name": "propeller", "position": (-1.0, 0.0, 0.0), "direction": (1.0, 0.0, 0.0),
    "curve": {"command": "duty", "unit": "1", "segments": [{"low": -1.0, "high": 1.0, "coefficients": [0.0, 20.0]}]},
}  # fmt: skip


def floating() -> ParameterFile:
    """The torpedo with hydrostatics alone."""
    h = ParameterHydrostatics(volume=VOLUME, centre_of_buoyancy=BUOYANT, gravity=GRAVITY)
    return torpedo().model_copy(update={"hydrostatics": h})


def driven() -> ParameterFile:
    """And with a thruster and a rudder."""
    more = {
        "thrusters": (ParameterThruster.model_validate(PROPELLER),),
        "surfaces": (ParameterSurface(control="dr", limit=0.4, rate=0.2),),
    }
    return floating().model_copy(update=more)


def restoring(file: ParameterFile, quaternion: np.ndarray) -> np.ndarray:
    """(6,) of weight and buoyancy about the reference point: two forces along the vertical, each in its centre."""
    down = rotation(quaternion).T @ np.array([0.0, 0.0, 1.0])
    weight, buoyancy = MASS * GRAVITY, file.conditions.density * GRAVITY * VOLUME
    force = weight * down, -buoyancy * down
    return np.concatenate([sum(force), np.cross(CENTRE, force[0]) + np.cross(BUOYANT, force[1])])


def quaternion(roll: float, pitch: float) -> np.ndarray:
    """Scalar first, without yaw."""
    (a, b), (c, d) = (np.cos(roll / 2), np.sin(roll / 2)), (np.cos(pitch / 2), np.sin(pitch / 2))
    return np.array([a * c, b * c, a * d, -b * d])

"""Force and moment of thrusters, fixed or tilting, at their commands."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.types import Array
from coeflab.law.transforms import turned_about
from coeflab.vehicle.parameter_parts import THRUST, ParameterThruster


def wrench(thrusters: Sequence[ParameterThruster], commands: Mapping[str, float]) -> Array:
    """(6,) force and moment of all thrusters about the reference point; commands and errors as of `Vehicle.wrench`."""
    known = {t.name for t in thrusters} | {THRUST} | {f"{t.name}.tilt" for t in thrusters if t.tilt_axis is not None}
    if strange := sorted(set(commands) - known):
        raise InputError(f"the command {shown(strange[0])}", f"one of {', '.join(sorted(known))}", column="thrusters")
    out = np.zeros(6)
    out[0] = commands.get(THRUST, 0.0)
    for t in thrusters:
        command = commands.get(t.name, 0.0)
        along = _along(t, commands.get(f"{t.name}.tilt", 0.0))
        force = t.curve.at(command) * along
        out[:3] += force
        out[3:] += np.cross(np.array(t.position), force)
        if t.torque_curve is not None:
            out[3:] += t.handedness * t.torque_curve.at(command) * along
    return out


def levers(t: ParameterThruster, tilt: float) -> Array:
    """(2, 6) force and moment of one newton of thrust, and of one newton metre of torque, of a thruster at a tilt."""
    along = _along(t, tilt)
    return np.array([[*along, *np.cross(np.array(t.position), along)], [0.0, 0.0, 0.0, *(t.handedness * along)]])


def _along(t: ParameterThruster, tilt: float) -> Array:
    """(3,) direction of thrust at a tilt, held within its limits."""
    along = np.array(t.direction)
    if t.tilt_axis is None:
        return along
    return np.asarray(turned_about(np.array(t.tilt_axis), min(max(tilt, t.tilt_low), t.tilt_high)) @ along)

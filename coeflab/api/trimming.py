"""`trim`: the steady motion of a vehicle, and small motions about it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from coeflab.api.parameters import HasParameters, parameters_of
from coeflab.api.questions import si
from coeflab.core.errors import InputError
from coeflab.law.symbols import CONTROLS
from coeflab.motion.trim.linear_model import LinearModel, LinearSchedule, linear_model
from coeflab.motion.trim.linear_model import as_json as linear_as_json
from coeflab.motion.trim.trim import Trim
from coeflab.motion.trim.trim import trim as found
from coeflab.motion.vehicle import vehicle as moving
from coeflab.vehicle.parameter_file import ParameterFile

AXES = {"speed": "u", "sway": "v", "heave": "w"}
MOTION = {
    "speed": "speed",
    "sway": "speed",
    "heave": "speed",
    "climb": "speed",
    "yaw_rate": "rate",
    "roll": "angle",
    "pitch": "angle",
}
UPRIGHT = frozenset({"w", "pitch", "climb", "ds", "db"})

__all__ = ["AXES", "CONTROLS", "LinearModel", "LinearSchedule", "Trim", "linear_as_json", "linear_model", "trim"]


def trim(
    vehicle: HasParameters | ParameterFile | str | Path,
    *,
    commands: Mapping[str, float | str] | None = None,
    near: Mapping[str, float] | None = None,
    plane: str = "",
    free: Sequence[str] = (),
    starts: int = 8,
    seed: int = 0,
    tables: bool = False,
    accelerations: str = "measured",
    **motion: float | str,
) -> Trim:
    """The commands of a steady motion, or the motion of commands; what is not named is found.

    Parameters
    ----------
    vehicle : Vehicle, str or Path
        A parameter file, or the name of a shipped one.
    commands : mapping of str to float, optional
        Held: thrusters in their units, controls and tilts in rad or with a unit.
    near : mapping of str to float, optional
        Among several solutions the one nearest to this.
    plane : {"", "horizontal", "vertical"}
    free : sequence of str
        Motions that may change, of u v w p q r.
    starts, seed : int
        Cold starts that look for other solutions.
    tables : bool
        Fitted tables come before derivatives.
    accelerations : {"measured", "computed"}
    **motion
        speed, sway, heave, climb (m/s; 0 keeps the depth), yaw_rate (rad/s), roll, pitch (rad), or with a unit: ``speed="3 kn"``.

    Returns
    -------
    Trim
        ``figures``, ``point.outcome``, ``statements``; `coeflab.Vehicle.linear` gives small motions about it.

    Raises
    ------
    InputError
        A motion or command that the vehicle has not.

    Examples
    --------
    >>> import coeflab as cf
    >>> str(cf.trim("remus100", speed=1.5).point.outcome.solved)
    'True'
    """
    if strange := [name for name in motion if name not in MOTION]:
        raise InputError(f"the motion {strange[0]}", f"one of {', '.join(MOTION)}", column=strange[0])
    asked = {AXES.get(k, k): si(v, MOTION[k], k) for k, v in motion.items()}
    orders = {
        k: si(v, "angle" if k in CONTROLS or k.endswith(".tilt") else "none", k) for k, v in (commands or {}).items()
    }
    chosen = plane or ("vertical" if UPRIGHT & {*asked, *orders} else "horizontal")
    craft = moving(parameters_of(vehicle), tuple(free), chosen, tables, accelerations)
    return found(craft, asked, orders, dict(near or {}), starts, seed)

"""Change of medium: out of the water or into it through the surface, each medium with its own parameter file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.options import bounded, measured, one_of, orders, parse_options, text
from coeflab.core.texts import input_error
from coeflab.motion.approach import judged, thruster_orders
from coeflab.motion.dynamics import from_euler, rotations
from coeflab.motion.manoeuvre import Figure, Manoeuvre, Phase, Until
from coeflab.motion.readings import extreme
from coeflab.motion.trajectory import Trajectory
from coeflab.motion.vehicle import Vehicle
from coeflab.motion.vehicle import vehicle as vehicle_of
from coeflab.vehicle.parameter_file import read_parameter_file

summary = "through the surface between two media, each with its parameter file: when, how fast, how far beyond"
citations = ("tj_flyingfish", "fossen2011")
plane = "vertical"
NAME = "medium_change"
DENSER = 10.0  # at least, the medium below over the medium above: water over air, never one water over another


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the change of medium.

    Attributes
    ----------
    into
        Parameter file of the craft in the other medium: a path, or a shipped name.
    start
        Whether it starts below the surface or above it.
    depth
        Distance of the start from the surface.
    commands, then
        Thruster commands in the first medium and in the other, such as rotor1=5000 rotor1.tilt=3.14159, angles in rad, on the command line in deg; what is not
        named is zero.
    speed, heave, pitch
        u, w and pitch at the start.
    changes
        How often the medium changes; the motion ends where it comes to the surface once more.
    longest
        Of each stretch, s.
    """

    into: str = text("")
    start: str = one_of("below", "below", "above")
    depth: float = measured(1.0, 1e-3, 1e4, "length")
    commands: tuple[str, ...] = orders()
    then: tuple[str, ...] = orders()
    speed: float = measured(0.0, -100.0, 100.0, "speed")
    heave: float = measured(0.0, -100.0, 100.0, "speed")
    pitch: float = measured(0.0, -1.4, 1.4, "angle")
    changes: int = bounded(1, 1, 20)
    longest: float = bounded(30.0, 0.01, 1e5)


def plan(vehicle: Vehicle, options: Mapping[str, Any]) -> Manoeuvre:
    """Stretches in the two media in turn, each to the surface at the latest.

    Raises
    ------
    InputError
        No other parameter file, two media whose densities are not those of a liquid below a gas, or commands that a medium's
        thrusters do not have.
    """
    o = parse_options(Options, options, NAME)
    if not o.into:
        raise InputError("no parameter file of the other medium", "--into FILE", column=f"{NAME}.into")
    other = vehicle_of(read_parameter_file(Path(o.into)), vehicle.free)
    _require_liquid_below(vehicle, other, o.start)
    sign = -1.0 if o.start == "below" else 1.0
    surface = sign * o.depth
    each = (thruster_orders(vehicle, o.commands), thruster_orders(other, o.then))
    names = ("water", "air") if o.start == "below" else ("air", "water")
    phases = []
    for number in range(o.changes + 1):
        medium = number % 2
        until = Until("depth", (sign > 0.0) == (medium == 0), surface)
        phases.append(Phase(f"{names[medium]} {number // 2 + 1}", each[medium], o.longest, until, medium))
    velocity = np.array([o.speed, 0.0, o.heave, 0.0, 0.0, 0.0])
    words = (
        f"from {vehicle.name} into {other.name} at the surface, {o.depth:g} m {'above' if sign < 0.0 else 'below'} the start; the "
        "craft is a point there: no partial immersion, slamming or spray, and velocities go on unchanged",
    )
    return Manoeuvre(
        NAME, tuple(phases), velocity, from_euler(0.0, o.pitch, 0.0), each[0], words, (other,), surface
    )  # fmt: skip


def _require_liquid_below(vehicle: Vehicle, other: Vehicle, start: str) -> None:
    below, above = (vehicle, other) if start == "below" else (other, vehicle)
    if below.density >= DENSER * above.density:
        return
    turned = above.density >= DENSER * below.density
    found = (
        f"{below.density:.4g} kg/m^3 of {below.name} below the surface, {above.density:.4g} of {above.name} above it"
    )
    way = "above" if start == "below" else "below"
    raise input_error(
        "motion.medium_below_least", column=f"{NAME}.start" if turned else f"{NAME}.into", found=found, denser=DENSER,
        advice=f"{vehicle.name} is the medium of the start: --start {way}." if turned else "Take the parameter file of the other medium: one of water, one of air.",
    )  # fmt: skip


def figures(trajectory: Trajectory, vehicle: Vehicle, options: Mapping[str, Any]) -> tuple[Figure, ...]:
    """Crossings, and what lies beyond the first of them."""
    o = parse_options(Options, options, NAME)
    t, surface = np.asarray(trajectory.time), (-1.0 if o.start == "below" else 1.0) * o.depth
    down = np.einsum("nj,nj->n", rotations(np.asarray(trajectory.attitude))[:, 2, :], trajectory.velocity[:, :3])
    crossed = [when for when in trajectory.reached if when is not None]
    first, again = (*crossed, None, None)[:2]
    beyond = (np.asarray(trajectory.position)[:, 2] - surface) * (-1.0 if o.start == "below" else 1.0)

    def at(values: np.ndarray) -> float | None:
        return None if first is None else float(np.interp(first, t, values))

    stays = (again if again is not None else float(t[-1])) - first if first is not None else None
    until = again if again is not None else float(t[-1])
    peak = None if first is None else extreme(t, beyond, True, first, until)
    rows = (
        ("time to the surface", first, "s", "first change of medium"),
        ("vertical speed there", at(-down), "m/s", "up, as the surface is passed"),
        ("speed there", at(trajectory.speed), "m/s", "as the surface is passed"),
        ("pitch there", at(trajectory.angles[:, 1]), "rad", "as the surface is passed"),
        ("time beyond", stays, "s", "in the other medium, until the surface or the end"),
        ("farthest beyond", None if peak is None else peak[1], "m", "from the surface, where it turns back"),
        (
            "vertical speed back at the surface", None if again is None else float(np.interp(again, t, -down)), "m/s",
            "up, as it is passed again",
        ),
        ("changes of medium", float(min(len(crossed), o.changes)), "1", "carried out"),
    )  # fmt: skip
    return tuple(
        judged(
            Figure(name, value, unit, words_, "ok" if value is not None else "not reached",
                   "" if value is not None else f"not within {t[-1]:.6g} s"),
            trajectory, float(t[-1]),
        )
        for name, value, unit, words_ in rows
    )  # fmt: skip

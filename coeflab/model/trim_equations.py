"""Steady motion of a vehicle: constant velocities, roll, pitch and rate of heading, as unknowns and equations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core import limits
from coeflab.core.errors import InputError, shown
from coeflab.core.symbols import COMPONENTS, CONTROLS
from coeflab.kernels.brief import brief
from coeflab.kernels.linearisation import linearised, modes
from coeflab.kernels.motion_law import WIND
from coeflab.kernels.transforms import rigid_body_force
from coeflab.kernels.vehicle_motion import from_euler
from coeflab.model.operating_point import Equation, Unknown
from coeflab.model.vehicle import THRUST, Vehicle

Array = NDArray[np.float64]
MOTION = {"u": "m/s", "v": "m/s", "w": "m/s", "yaw_rate": "rad/s", "roll": "rad", "pitch": "rad"}
FOUND_WITH = {"u": "u", "v": "v", "w": "w", "yaw_rate": "r", "roll": "p", "pitch": "q"}
# Bounds of the search: three times the speed, a turn on a sixth of a length, and short of 90 deg, where heading has no sense.
FASTEST, TURNS, STEEP = 3.0, 6.0, np.radians(85.0)
TILTED = 0.1  # rad, what counts as one unit of lean among the scaled unknowns
UNSTATED_LIMIT = float(np.radians(30.0))  # taken where the file states none, and said; few control surfaces go further
NAMES = {
    "X": "surge force X", "Y": "sway force Y", "Z": "heave force Z", "K": "roll moment K", "M": "pitch moment M",
    "N": "yaw moment N",
}  # fmt: skip


@brief
@dataclass(frozen=True, slots=True, eq=False)
class SteadyMotion:
    """A vehicle with what is given of its motion and commands.

    Attributes
    ----------
    vehicle : Vehicle
    unknowns : tuple of Unknown
        Of `MOTION`, then the commands; given ones have equal bounds.
    equations : tuple of Equation
        Forces along what the vehicle is free to do.
    """

    vehicle: Vehicle
    unknowns: tuple[Unknown, ...]
    equations: tuple[Equation, ...]

    def state(self, x: Array) -> tuple[Array, Array]:
        """(6,) velocities and (2,) roll and pitch.

        Notes
        -----
        With constant roll and pitch p, q, r follow from the rate of heading (Fossen 2011, section 2.2.1).
        """
        u, v, w, turn, roll, pitch = x[: len(MOTION)]
        spin = turn * np.array([-np.sin(pitch), np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll)])
        return np.array([u, v, w, *spin]), np.array([roll, pitch])

    def commands(self, x: Array) -> tuple[Array, Array]:
        """(3,) dr ds db and the (6,) wrench of the thrusters."""
        values = dict(zip([u.name for u in self.unknowns], x.tolist(), strict=True))
        ordered = {k: v for k, v in values.items() if k not in MOTION and k not in CONTROLS}
        return np.array([values.get(c, 0.0) for c in CONTROLS]), self.vehicle.wrench(ordered)

    def left(self, x: Array) -> Array:
        """Forces that would accelerate the vehicle, along its free motions."""
        nu, lean = self.state(x)
        controls, wrench = self.commands(x)
        craft = self.vehicle
        total = craft.force(nu[None, :], controls[None, :])[0] + wrench
        total = total + craft.restoring(from_euler(lean[0], lean[1], 0.0)[None, :])[0]
        total = total - rigid_body_force(craft.mass, craft.centre, craft.inertia, nu[None, :])[0]
        return np.asarray(total[list(craft.free_columns)])

    def modes(self, x: Array) -> NDArray[np.complex128]:
        """Eigenvalues of small motions about it with the commands as they are, 1/s; heading and place do not matter."""
        nu, lean = self.state(x)
        controls, wrench = self.commands(x)
        craft, columns = self.vehicle, list(self.vehicle.free_columns)
        leaning = [i for i, m in enumerate("pq") if m in craft.free]
        speed = max(float(np.linalg.norm(nu[:3])), 0.1 * craft.speed)

        def rates(small: Array) -> Array:
            moved, leant = nu.copy(), lean.copy()
            moved[columns], leant[leaning] = small[: len(columns)], small[len(columns) :]
            attitude = from_euler(leant[0], leant[1], 0.0)[None, :]
            faster = craft.acceleration(moved[None, :], attitude, controls[None, :], wrench)[0]
            (sin, cos), (p, q, r) = (np.sin(leant[0]), np.cos(leant[0])), moved[3:]
            turned = np.array([p + np.tan(leant[1]) * (q * sin + r * cos), q * cos - r * sin])
            return np.concatenate([faster[columns], turned[leaning]])

        scale = np.array([speed if i < 3 else speed / craft.length for i in columns] + [1.0] * len(leaning))
        slopes = linearised(rates, np.concatenate([nu[columns], lean[leaning]]), scale)
        if not np.isfinite(slopes).all():
            raise InputError(
                "rates of small motions that are not finite",
                "a motion and coefficients whose forces are",
                column="motion",
            )
        return modes(slopes)


def steady_motion(vehicle: Vehicle, motion: Mapping[str, float], commands: Mapping[str, float]) -> SteadyMotion:
    """Set up the unknowns of a steady motion.

    Motions that the vehicle is free in and that are not given are found; the others are zero. Commands that are not given
    are found where a motion is given, and zero otherwise.

    Parameters
    ----------
    vehicle : Vehicle
    motion : mapping
        Of `MOTION`, SI.
    commands : mapping
        Thrusters, ``name.tilt``, ``dr`` ``ds`` ``db``, or ``thrust`` where the file has no thrusters; SI, tilts and surfaces
        in rad.

    Raises
    ------
    InputError
        A name that is unknown, or a command beyond its limits.
    """
    strange = sorted(set(motion) - set(MOTION))
    if strange:
        raise InputError(shown(strange[0]), f"some of {', '.join(MOTION)}", column="motion")
    for name, value in motion.items():
        if not abs(value) <= limits.FASTEST:
            raise InputError(
                f"{name} = {value:g} {MOTION[name]}", f"at most {limits.FASTEST:g} either way", column=name
            )
    speed = max(abs(motion.get("u", 0.0)), vehicle.speed)
    unknowns = [_motion(vehicle, name, motion, speed) for name in MOTION]
    orders = command_unknowns(vehicle, speed)
    names = [u.name for u in orders]
    for name, value in commands.items():
        if name not in names:
            raise InputError(f"the command {shown(name)}", f"one of {', '.join(names)}", column="command")
        limit = orders[names.index(name)]
        if not limit.low <= value <= limit.high:
            raise InputError(
                f"{name} = {limit.shown(value)}", f"{limit.shown(limit.low)} to {limit.shown(limit.high)}",
                column="command",
            )  # fmt: skip
    for u in orders:
        if u.name in commands:
            unknowns.append(u.at(commands[u.name]))
        else:
            unknowns.append(u if motion or not commands else u.at(min(max(0.0, u.low), u.high)))
    return SteadyMotion(vehicle, tuple(unknowns), _equations(vehicle, speed))


def _motion(vehicle: Vehicle, name: str, motion: Mapping[str, float], speed: float) -> Unknown:
    """Straight, level and upright is what the rule of selection wants of a motion; the speed does not count."""
    fastest, quickest = FASTEST * speed, TURNS * speed / vehicle.length
    bound, scale = {
        "u": (fastest, speed), "v": (fastest, speed), "w": (fastest, speed), "yaw_rate": (quickest, quickest / TURNS),
        "roll": (np.pi / 2.0, TILTED), "pitch": (STEEP, TILTED),
    }[name]  # fmt: skip
    u = Unknown(name, MOTION[name], -float(bound), float(bound), float(scale), weight=0.0 if name == "u" else 1.0)
    if name in motion:
        return u.at(motion[name])
    return u if FOUND_WITH[name] in vehicle.free else u.at(0.0)


def command_unknowns(vehicle: Vehicle, speed: float) -> tuple[Unknown, ...]:
    """Every command that moves the vehicle where it is free, with its limits."""
    out = []
    for t in vehicle.thrusters:
        largest = max(abs(t.curve.low), abs(t.curve.high))
        out.append(Unknown(t.name, t.curve.unit, t.curve.low, t.curve.high, largest))
        if t.tilt_axis is not None:
            out.append(Unknown(f"{t.name}.tilt", "rad", t.tilt_low, t.tilt_high, 1.0, weight=0.0))
    if not vehicle.thrusters:
        out.append(Unknown(THRUST, "N", -np.inf, np.inf, max(abs(vehicle.resistance(speed)), 1e-6)))
    felt = {*WIND, *(COMPONENTS[i] for i in vehicle.free_columns)}
    limits: dict[str, float] = {s.control: s.limit for s in vehicle.surfaces}
    for c in CONTROLS:
        if any(v[0] == c for term in vehicle.terms if term.component in felt for v, _, _ in term.factors):
            limit = limits.get(c, UNSTATED_LIMIT)
            out.append(Unknown(c, "rad", -limit, limit, limit))
    return tuple(out)


def _equations(vehicle: Vehicle, speed: float) -> tuple[Equation, ...]:
    """Sizes: what turns the vehicle's own speed about within one length."""
    mass = np.diag(vehicle.effective_mass)
    rate = speed / vehicle.length
    return tuple(
        Equation(NAMES[COMPONENTS[i]], "N" if i < 3 else "N m", float(mass[i]) * rate * (speed if i < 3 else rate))
        for i in vehicle.free_columns
    )

"""Steady motion of a vehicle: constant velocities, roll, pitch and rate of heading, as unknowns and equations."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from coeflab.core import limits
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass
from coeflab.law.force_law import WIND
from coeflab.law.symbols import COMPONENTS, CONTROLS, LINEAR, MOTIONS
from coeflab.motion.dynamics import from_euler
from coeflab.motion.small_motions import Slopes, modes, slopes
from coeflab.motion.trim.operating_point import Equation, Unknown
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.parameter_parts import THRUST

MOTION = {"u": "m/s", "v": "m/s", "w": "m/s", "yaw_rate": "rad/s", "roll": "rad", "pitch": "rad"}
CLIMB = "climb"
LEANS = {"p": "roll", "q": "pitch"}
PLACES = {"depth": "m", "heading": "rad"}
FOUND_WITH = {"u": "u", "v": "v", "w": "w", "yaw_rate": "r", "roll": "p", "pitch": "q"}
# Bounds of the search: three times the speed, a turn on a sixth of a length, and short of 90 deg, where heading has no sense.
FASTEST, TURNS, STEEP = 3.0, 6.0, np.radians(85.0)
TILTED = 0.1  # rad, what counts as one unit of lean among the scaled unknowns
LEAST_THRUST = 1e-3  # of what turns the vehicle's own speed about within one length
UNSTATED_LIMIT = float(np.radians(30.0))  # taken where the file states none, and said; few control surfaces go further
NAMES = {
    "X": "surge force X", "Y": "sway force Y", "Z": "heave force Z", "K": "roll moment K", "M": "pitch moment M",
    "N": "yaw moment N",
}  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class SteadyMotion:
    """A vehicle with what is given of its motion and commands.

    Attributes
    ----------
    vehicle : Vehicle
    unknowns : tuple of Unknown
        Of `MOTION`, then the commands; given ones have equal bounds.
    equations : tuple of Equation
        Forces along what the vehicle is free to do, and the climb where it is given.
    climb : float or None
        Rate of rising that is given, m/s: zero keeps the depth.
    """

    vehicle: Vehicle
    unknowns: tuple[Unknown, ...]
    equations: tuple[Equation, ...]
    climb: float | None = None

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
        """Forces that would accelerate the vehicle, along its free motions, and the climb beyond the one given."""
        nu, lean = self.state(x)
        controls, wrench = self.commands(x)
        attitude = from_euler(lean[0], lean[1], 0.0)
        total = self.vehicle.unbalanced(nu[None, :], attitude[None, :], controls[None, :], wrench)[0]
        beyond = [] if self.climb is None else [self.rising(x) - self.climb]
        return np.concatenate([total[list(self.vehicle.free_columns)], beyond])

    def rising(self, x: Array) -> float:
        """Climb, m/s."""
        return -float(self.place_rates(x, self.departed(x))[0])

    @property
    def command_unknowns(self) -> tuple[Unknown, ...]:
        """The commands among the unknowns."""
        return self.unknowns[len(MOTION) :]

    @property
    def states(self) -> tuple[tuple[str, str], ...]:
        """Name and unit of what small motions change: free velocities, roll where p is free, pitch where q is."""
        speeds = [(m, "m/s" if m in LINEAR else "rad/s") for m in MOTIONS if m in self.vehicle.free]
        return (*speeds, *((LEANS[m], "rad") for m in "pq" if m in self.vehicle.free))

    def departed(self, x: Array) -> Array:
        """(n,) values of `states`."""
        nu, lean = self.state(x)
        return np.concatenate([nu[list(self.vehicle.free_columns)], lean[self._leaning]])

    @property
    def _leaning(self) -> list[int]:
        return [i for i, m in enumerate("pq") if m in self.vehicle.free]

    def rates(self, x: Array, small: Array) -> Array:
        """(n,) rates of `states` with these values and the commands of x; heading and place do not matter."""
        (moved, leant), craft = self.state(x), self.vehicle
        columns, leaning = list(craft.free_columns), self._leaning
        controls, wrench = self.commands(x)
        moved[columns], leant[leaning] = small[: len(columns)], small[len(columns) :]
        attitude = from_euler(leant[0], leant[1], 0.0)[None, :]
        faster = craft.acceleration(moved[None, :], attitude, controls[None, :], wrench)[0]
        (sin, cos), (p, q, r) = (np.sin(leant[0]), np.cos(leant[0])), moved[3:]
        turned = np.array([p + np.tan(leant[1]) * (q * sin + r * cos), q * cos - r * sin])
        return np.concatenate([faster[columns], turned[leaning]])

    def place_rates(self, x: Array, small: Array) -> Array:
        """(2,) rates of `PLACES` with these values of `states` (Fossen 2011, equations 2.25 and 2.29)."""
        moved, lean = self.state(x)
        columns, leaning = list(self.vehicle.free_columns), self._leaning
        moved[columns], lean[leaning] = small[: len(columns)], small[len(columns) :]
        (u, v, w), (_, q, r) = moved[:3], moved[3:]
        (sin, cos), (sine, cosine) = (np.sin(lean[0]), np.cos(lean[0])), (np.sin(lean[1]), np.cos(lean[1]))
        return np.array([cosine * (v * sin + w * cos) - u * sine, (q * sin + r * cos) / cosine])

    def state_slopes(self, x: Array) -> Slopes:
        """Derivatives (n, n) of `rates` by the states, the commands as they are.

        Raises
        ------
        InputError
            They are not finite.
        """
        return self._slopes(self.rates, x)

    def place_slopes(self, x: Array) -> Slopes:
        """Derivatives (2, n) of `place_rates` by the states."""
        return self._slopes(self.place_rates, x)

    def _slopes(self, rates: Callable[[Array, Array], Array], x: Array) -> Slopes:
        craft = self.vehicle
        speed = max(float(np.linalg.norm(self.state(x)[0][:3])), 0.1 * craft.speed)
        scale = [speed if i < 3 else speed / craft.length for i in craft.free_columns] + [1.0] * len(self._leaning)
        endless = np.full(len(scale), np.inf)
        return _finite(slopes(lambda small: rates(x, small), self.departed(x), np.array(scale), -endless, endless))

    def command_slopes(self, x: Array) -> Slopes:
        """Derivatives (n, m) of `rates` by the commands, within their bounds.

        Raises
        ------
        InputError
            They are not finite.
        """
        first, small = len(MOTION), self.departed(x)
        bounds = command_unknowns(self.vehicle, max(abs(float(x[0])), self.vehicle.speed))

        def ordered(commands: Array) -> Array:
            return self.rates(np.concatenate([x[:first], commands]), small)

        scale, low, high = (np.array([getattr(u, k) for u in bounds]) for k in ("scale", "low", "high"))
        return _finite(slopes(ordered, x[first:], scale, low, high))

    def modes(self, x: Array) -> NDArray[np.complex128]:
        """Eigenvalues of small motions about it with the commands as they are, 1/s."""
        return modes(self.state_slopes(x).matrix)


def _finite(found: Slopes) -> Slopes:
    if not np.isfinite(found.matrix).all():
        raise input_error("motion.slopes_not_finite", column="motion")
    return found


def steady_motion(vehicle: Vehicle, motion: Mapping[str, float], commands: Mapping[str, float]) -> SteadyMotion:
    """Set up the unknowns of a steady motion.

    Motions that the vehicle is free in and that are not given are found; the others are zero. Commands that are not given
    are found where a motion is given, and zero otherwise.

    Parameters
    ----------
    vehicle : Vehicle
    motion : mapping
        Of `MOTION` and ``climb``, SI.
    commands : mapping
        Thrusters, ``name.tilt``, ``dr`` ``ds`` ``db``, or ``thrust`` where the file has no thrusters; SI, tilts and surfaces
        in rad.

    Raises
    ------
    InputError
        A name that is unknown, or a command beyond its limits.
    """
    units = {**MOTION, CLIMB: "m/s"}
    strange = sorted(set(motion) - set(units))
    if strange:
        raise InputError(shown(strange[0]), f"some of {', '.join(units)}", column="motion")
    for name, value in motion.items():
        if not abs(value) <= limits.FASTEST:
            raise InputError(f"{name} = {value:g} {units[name]}", f"at most {limits.FASTEST:g} either way", column=name)
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
    climb = motion.get(CLIMB)
    climb_equation = () if climb is None else (Equation("climb beyond the one given", "m/s", speed),)
    return SteadyMotion(vehicle, tuple(unknowns), (*_equations(vehicle, speed), *climb_equation), climb)


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
        strongest = max(abs(t.curve.at(t.curve.low)), abs(t.curve.at(t.curve.high)))
        force = t.curve.at if strongest else None
        out.append(
            Unknown(t.name, t.curve.unit, t.curve.low, t.curve.high, largest, force=force, strongest=strongest or 1.0)
        )
        if t.tilt_axis is not None:
            out.append(Unknown(f"{t.name}.tilt", "rad", t.tilt_low, t.tilt_high, 1.0, weight=0.0))
    if not vehicle.thrusters:
        # A file without resistance takes no thrust: a scale of nothing would leave it out of the equations.
        least = LEAST_THRUST * float(vehicle.effective_mass[0, 0]) * speed**2 / vehicle.length
        out.append(Unknown(THRUST, "N", -np.inf, np.inf, max(abs(vehicle.resistance(speed)), least)))
    felt = {*WIND, *(COMPONENTS[i] for i in vehicle.free_columns)}
    limits: dict[str, float] = {s.control: s.limit for s in vehicle.surfaces}
    for c in CONTROLS:
        if any(c in t.variables for t in vehicle.law.terms if t.component in felt):
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

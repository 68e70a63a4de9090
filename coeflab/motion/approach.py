"""What every manoeuvre begins with: a straight run at a speed, and which way a control turns the vehicle."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.options import named_numbers
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import listed
from coeflab.law.symbols import ANGLE_NAMES, CONTROLS, MOTIONS
from coeflab.motion.manoeuvre import UPRIGHT, Figure, Manoeuvre, Phase
from coeflab.motion.trajectory import WITHOUT_DATA, Trajectory, Uncovered, covered_ranges, outside, outside_in_words
from coeflab.motion.turn_limits import unlimited
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.parameter_parts import THRUST, ParameterThruster

SURFACES = {"dr": "rudder", "ds": "stern planes", "db": "bow planes"}
NOT_DETERMINED = "not determined"
STEP = 1e-4  # rad: an angle that is small for every law, and far above rounding


def along(vehicle: Vehicle, speed: float) -> Array:
    """(6,) straight ahead at a speed; the file's own where zero is asked for."""
    nu = np.zeros(6)
    nu[0] = speed or vehicle.speed
    return nu


def propulsion(vehicle: Vehicle, speed: float) -> tuple[dict[str, float], str]:
    """Orders that keep the speed on a straight course, and what that means, in words.

    Raises
    ------
    InputError
        The file has no resistance although the speed is free.
    """
    if "u" not in vehicle.free:
        return {}, f"speed held at {speed:g} m/s; the thrust follows"
    needed = vehicle.resistance(speed)
    if needed <= 0.0:
        raise input_error("motion.no_resistance", column="coefficients", needed=needed, speed=speed)
    return {THRUST: needed}, f"constant thrust of {needed:.4g} N, for {speed:g} m/s straight ahead"


def turning_sense(vehicle: Vehicle, control: str, about: str, speed: float) -> float:
    """+1 where a positive angle first turns the vehicle the positive way about an axis (``r``, ``q``), otherwise -1.

    Raises
    ------
    InputError
        No coefficient of the file speaks of that control, or it gives no moment.
    """
    if not any(control in t.variables for t in vehicle.law.terms):
        known = [c for c in CONTROLS if any(c in t.variables for t in vehicle.law.terms)]
        raise input_error(
            "motion.derivative_such", column="coefficients", control=control, value="N" if about == "r" else "M",
            advice=f"The file has {', '.join(known)}." if known else _instead(vehicle),
        )  # fmt: skip
    nu = along(vehicle, speed)[None, :]
    angles = np.zeros((2, 3))
    angles[:, CONTROLS.index(control)] = 1.0, -1.0
    rate = [vehicle.acceleration(nu, np.array([UPRIGHT]), a[None, :] * STEP, np.zeros(6)) for a in angles]
    turning = float((rate[0] - rate[1])[0, MOTIONS.index(about)])
    if turning == 0.0:
        raise InputError(f"{control} without a moment", f"an effect of {control} on {about}", column="coefficients")
    return 1.0 if turning > 0.0 else -1.0


def _instead(vehicle: Vehicle) -> str:
    """What a vehicle without control surfaces can do."""
    if not vehicle.thrusters:
        return "The file has neither control surfaces nor thrusters: the manoeuvres stop and straight_run need none."
    orders = " ".join(f"{t.name}={t.curve.segments[-1].high:g}" for t in vehicle.thrusters)
    return f'Turning circle and zigzag take thrusters in its place: --commands "{orders}", unequal.'


def within_limit(vehicle: Vehicle, control: str, angle: float, key: str) -> float:
    """The angle, if the surface can take it.

    Raises
    ------
    InputError
        Beyond the surface's limit.
    """
    surface = next((s for s in vehicle.surfaces if s.control == control), None)
    if surface is not None and abs(angle) > surface.limit * (1.0 + 1e-9):
        raise InputError(
            f"{np.degrees(angle):g} deg",
            f"at most {np.degrees(surface.limit):g} deg, the limit of {control}",
            column=key,
        )
    return angle


def reached(vehicle: Vehicle, control: str, usual: float) -> float:
    """The usual angle of a control, or its limit where that is less."""
    return min([usual, *(s.limit for s in vehicle.surfaces if s.control == control)])


def at_once(vehicle: Vehicle, phases: Sequence[Phase]) -> tuple[str, ...]:
    """Which control surfaces follow their orders at infinite rate, in words: those ordered whose rate the file does not state."""
    ordered = {c for p in phases for c in p.orders}
    rated = {s.control for s in vehicle.surfaces if s.rate is not None}
    at = [f"{SURFACES[c]} ({c})" for c in CONTROLS if c in ordered and c not in rated]
    if not at:
        return ()
    return (
        f"{listed(at)} at the ordered angle at once: the file states no rate, so times, distances and overshoots are those of an infinite rate",
    )


def thruster_orders(vehicle: Vehicle, commands: Sequence[str]) -> dict[str, float]:
    """``left=0 right=60`` as orders.

    Raises
    ------
    InputError
        Not NAME=NUMBER, a name twice, or one that the vehicle does not have.
    """
    out = named_numbers(commands, "commands")
    known = {*CONTROLS}
    vehicle.wrench({k: v for k, v in out.items() if k not in known})
    return out


def mirrored(vehicle: Vehicle, orders: Mapping[str, float]) -> dict[str, float]:
    """Orders of all thrusters and control surfaces that turn the vehicle to the other side as the given ones to theirs.

    Parameters
    ----------
    vehicle : Vehicle
    orders : mapping of str to float
        Of thrusters, ``thrust``, ``dr``, ``ds`` and ``db``; what is not named is zero.

    Raises
    ------
    InputError
        An order for a tilt, or a thruster that has no mirror image among the others.
    """
    out = {name: orders[name] for name in (THRUST, "ds", "db") if name in orders}
    if "dr" in orders:
        out["dr"] = -orders["dr"]
    tilts = [name for name in orders if name.endswith(".tilt")]
    if tilts:
        raise input_error("motion.order_for_tilt", column="commands", tilts=tilts[0])
    for t in vehicle.thrusters:
        image = next((o for o in vehicle.thrusters if _images(t, o)), None)
        if image is None:
            raise input_error("motion.thruster_without_image", column="commands", name=t.name)
        out[t.name] = orders.get(image.name, 0.0)
    return out


def yaw_acceleration(vehicle: Vehicle, orders: Mapping[str, float], velocity: Array) -> float:
    """Rate of r under orders for thrusters and control surfaces, at a velocity (6,), rad/s^2."""
    angles = np.array([[orders.get(c, 0.0) for c in CONTROLS]])
    pushed = vehicle.wrench({k: v for k, v in orders.items() if k not in CONTROLS})
    return float(vehicle.acceleration(velocity[None, :], np.array([UPRIGHT]), angles, pushed)[0, 5])


def _images(one: ParameterThruster, other: ParameterThruster) -> bool:
    """Whether one thruster is the other's image in the plane of symmetry."""
    aside = np.array([1.0, -1.0, 1.0])
    turns = one.torque_curve is None or one.handedness == -other.handedness
    return (
        turns
        and (one.curve, one.torque_curve) == (other.curve, other.torque_curve)
        and np.allclose(one.position, aside * other.position, atol=1e-9)
        and np.allclose(one.direction, aside * other.direction, atol=1e-9)
    )


def decisive(names: Iterable[str], rate: str) -> list[str]:
    """Of what a motion has left, what leaves a turn that grows of itself open: a range of data, or the rate, on which there are none."""
    return [name for name in names if not isinstance(name, Uncovered) or name.variable == f"{rate}'"]


def undetermined_at_once(vehicle: Vehicle, manoeuvre: Manoeuvre, figures: Sequence[Figure]) -> str:
    """Why a file determines nothing of a manoeuvre, in words; empty where it determines its beginning.

    A turn that grows of itself and ends beyond the data, or never, is determined only within them. Orders that it follows at once may leave them at time zero; where no data cover the rate of turn, it has none.

    Parameters
    ----------
    vehicle : Vehicle
    manoeuvre : Manoeuvre
    figures : sequence of Figure
        Read off the motion.
    """
    speed = float(manoeuvre.velocity[0])
    rate, lacking = next(
        ((r, why) for r in "rq" if r in vehicle.free and speed > 0.0 and (why := unlimited(vehicle, r, speed))),
        ("", ""),
    )
    rated = {s.control for s in vehicle.surfaces if s.rate is not None}
    first = {**manoeuvre.orders, **manoeuvre.phases[0].orders}
    angles = {c: first[c] for c in CONTROLS if c in first and c not in rated}
    flags = outside(vehicle, manoeuvre.velocity[None, :], {c: np.array([x]) for c, x in angles.items()})
    if not lacking:
        return ""
    why = f"The vehicle is {lacking}."
    if any(f[0] for name, f in flags.items() if not isinstance(name, Uncovered)):
        return " ".join((*outside_in_words(vehicle, manoeuvre.velocity, angles), why))
    none = all(f.value is None for f in figures) and any(f.status == NOT_DETERMINED for f in figures)
    return why if none and f"{rate}'" not in covered_ranges(vehicle) else ""


def in_current(current: Array) -> tuple[str, ...]:
    """What a current does to the figures of a manoeuvre, in words; nothing in still water."""
    if not np.any(current):
        return ()
    flows = ", ".join(f"{v:g} {name}" for v, name in zip(current, ("north", "east", "down"), strict=True) if v)
    return (
        f"current of {flows} m/s: speeds are through the water, positions over the ground, and distances such as advance and head reach include the drift, for which IMO and ITTC correct",
    )


def judged(figure: Figure, trajectory: Trajectory, until: float | None, lacking: str = "", rate: str = "r") -> Figure:
    """The figure, marked where the motion has left the data before the time it was read off.

    Parameters
    ----------
    figure : Figure
    trajectory : Trajectory
    until : float or None
        When it was read off, s.
    lacking : str
        Of `unlimited`; then there is no value once the motion has left what data cover, as `decisive` says.
    rate : str
        That `lacking` is about.
    """
    if figure.value is None or until is None:
        return figure
    before = trajectory.time <= until
    names = [name for name, flags in trajectory.outside.items() if np.any(flags & before)]
    if not names:
        return figure
    bare = [in_field_terms(n.variable) for n in names if isinstance(n, Uncovered) and n != WITHOUT_DATA]
    left = [in_field_terms(name) for name in names if not isinstance(name, Uncovered)]
    words = (f"beyond the data in {', '.join(left)}" if left else "", f"no data on {', '.join(bare)}" if bare else "")
    beyond = "; ".join(filter(None, words)) or "no force table stands behind the file"
    if lacking and decisive(names, rate):
        return replace(figure, value=None, status=NOT_DETERMINED, why="; ".join(filter(None, (words[0], lacking))))
    return replace(figure, status="extrapolated", why=beyond)


def judged_rows(
    rows: Sequence[tuple[str, float | None, str, float | None, str]], trajectory: Trajectory, lacking: str, rate: str
) -> tuple[Figure, ...]:
    """Figures of rows, `judged`; one without a value was not reached in the time that was simulated.

    Parameters
    ----------
    rows : sequence of (name, value, unit, time, definition)
    trajectory : Trajectory
    lacking, rate : str
        As of `judged`.
    """
    end = f"not within {trajectory.time[-1]:g} s"
    return tuple(
        judged(
            Figure(name, value, unit, text, *(("ok", "") if value is not None else ("not reached", end))),
            trajectory,
            when,
            lacking,
            rate,
        )
        for name, value, unit, when, text in rows
    )


def in_field_terms(name: str) -> str:
    """A variable as people call it: dr is the rudder angle."""
    return ANGLE_NAMES.get(name, name)


def undetermined(figure: Figure, lacking: str) -> Figure:
    """A figure of a steady turn; without a value where the turn is not determined."""
    return replace(figure, value=None, status=NOT_DETERMINED, why=lacking) if lacking else figure

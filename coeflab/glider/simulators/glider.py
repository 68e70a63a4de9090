"""Dive-and-surface cycles of a glider in the vertical plane, and its spirals in space.

Equations in `coeflab.glider.motion` and, where a roller or thrusters are ordered, `coeflab.glider.space`, with
the errata of the THAUV paper; scipy's LSODA integrates from kink to kink of what is ordered. Deeply submerged: no surface, no
waves, no current, one water density.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import require_rows
from coeflab.core.options import bounded, parse_options
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.glider.glider import Glider
from coeflab.glider.motion import GliderBody, Leg, Rates, Setting, legs, march, momentum, rates, velocity
from coeflab.glider.space import SpaceBody, rates_in_space, rotation, velocity_in_space
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.trajectory import Ended, Trajectory

summary = "glider with a sliding mass, a buoyancy engine, a roller and thrusters: cycles and spirals in time"
citations = ("leonard_graver2001", "thauv")


OUT_OF_PLANE = Setting._fields[2:]


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the integration.

    Attributes
    ----------
    step : float
        Time between rows, s; it does not touch the accuracy.
    tolerance : float
        Relative tolerance of the integration.
    """

    step: float = bounded(1.0, 1e-3, 3600.0)
    tolerance: float = bounded(1e-8, 1e-12, 1e-3)


def simulate(vehicle: Glider, manoeuvre: Manoeuvre, options: Mapping[str, Any]) -> Trajectory:
    """Fly a manoeuvre.

    Parameters
    ----------
    vehicle : Glider
    manoeuvre : Manoeuvre
        Orders ``net_mass``, kg, and ``position`` of the sliding mass, m, which move at the rates of the glider; with what a
        motion in space needs also ``roller``, rad, ``right`` and ``left`` thrust, N. A phase ends by time or by depth. It
        starts in the vertical plane, heading north, at depth zero.
    options : mapping
        See `Options`.

    Returns
    -------
    Trajectory
        Its ``ended`` says whether all phases were flown; a failed integration keeps what came before.

    Raises
    ------
    InputError
        Unknown options or orders, a phase that ends by something else, a start out of the plane, more than a million rows.
    """
    chosen = parse_options(Options, options, "glider")
    if not isinstance(vehicle, Glider):
        raise InputError("the vehicle of a parameter file", "a glider", column="glider", advice="See `coeflab glide`.")
    _check(vehicle, manoeuvre, chosen.step)
    leaves = any(phase.orders.get(name, 0.0) for phase in manoeuvre.phases for name in OUT_OF_PLANE)
    body = vehicle.space if leaves else None
    flight = _Flight(vehicle, manoeuvre, chosen, _InPlane(vehicle.body) if body is None else _InSpace(body))
    reached = []
    for i, phase in enumerate(manoeuvre.phases):
        reached.append(flight.time[-1] if not flight.why and flight.fly(i, phase) else None)
    rows = np.array(flight.rows)
    velocity, attitude = rows[:, 7:13], rows[:, 3:7]
    speed, alpha = np.linalg.norm(velocity[:, :3], axis=1), np.arctan2(velocity[:, 2], velocity[:, 0])
    outside = np.zeros(len(rows), dtype=bool)
    if vehicle.polar.covered is not None:
        outside = (speed > 0.0) & ~_within(alpha, vehicle.polar.covered)
    controls = {name: rows[:, 13 + i] for i, name in enumerate(Setting._fields[: 5 if leaves else 2])}
    return Trajectory(
        time=np.array(flight.time),
        position=rows[:, :3],
        attitude=attitude,
        velocity=velocity,
        heading=_headings(attitude) if leaves else np.zeros(len(rows)),
        controls=controls,
        phase=np.array(flight.phase),
        phases=tuple(p.name for p in manoeuvre.phases),
        reached=tuple(reached),
        outside={} if vehicle.polar.covered is None else {"alpha": outside},
        ended=flight.ended,
        why=flight.why,
        statements=_statements(vehicle, alpha, outside, velocity[:, 0]),
    )


def _headings(attitude: Array) -> Array:
    """(n,) rad, without jumps."""
    turned = [rotation(q)[:, 0] for q in attitude.tolist()]
    return np.asarray(np.unwrap([np.arctan2(east, north) for north, east, _ in turned]))


def _within(alpha: Array, covered: tuple[float, float]) -> NDArray[np.bool_]:
    return np.asarray((alpha >= covered[0]) & (alpha <= covered[1]))


def _check(glider: Glider, manoeuvre: Manoeuvre, step: float) -> None:
    """Raise for what a glider cannot fly."""
    known = Setting._fields if glider.space is not None else Setting._fields[:2]
    for phase in manoeuvre.phases:
        if unknown := [
            o for o, value in phase.orders.items() if o not in known and (value or o not in Setting._fields)
        ]:
            raise InputError(f"the order {shown(unknown[0])} in {phase.name}", " or ".join(known), column="glider")
        if phase.until is not None and phase.until.quantity != "depth":
            raise InputError(f"{phase.name} until {phase.until.quantity}", "until a depth, or a time", column="glider")
    off_plane = np.concatenate([manoeuvre.velocity[[1, 3, 5]], manoeuvre.attitude[[1, 3]]])
    if np.any(off_plane):
        raise input_error("glider.start_sway_roll", column="glider")
    require_rows(manoeuvre.duration / step, "glider.step", "Take a larger step.")


def _statements(vehicle: Glider, alpha: Array, outside: NDArray[np.bool_], u: Array) -> tuple[str, ...]:
    """What the motion asks of the polar."""
    steepest = float(np.max(np.abs(np.degrees(alpha))))
    out = []
    if vehicle.polar.covered is None:
        out.append(f"The polar does not say which angles of attack it covers; the motion reaches {steepest:.1f} deg.")
    elif outside.any():
        out.append(
            f"{np.mean(outside):.1%} of the rows lie outside of the angles of attack that the polar covers; the motion "
            f"reaches {steepest:.1f} deg there, by extrapolation."
        )
    if np.any(u < -1e-9):
        out.append("The glider moves astern for a while; its polar does not cover that.")
    return tuple(out)


class _InPlane:
    """The vertical plane: state, its rates and a row of what is recorded."""

    def __init__(self, body: GliderBody) -> None:
        self.body = body

    def start(self, moving: Array, attitude: Array, position: float) -> Array:
        """State at the origin."""
        pitch = 2.0 * float(np.arctan2(attitude[2], attitude[0]))
        return np.array([0.0, 0.0, pitch, *momentum(self.body, [float(v) for v in moving[[0, 2, 4]]], position, 0.0)])

    def rates(self, leg: Leg) -> Rates:
        """Right-hand side."""
        return rates(self.body, leg)

    def row(self, state: Array, position: float, rate: float) -> list[float]:
        """North, east, depth, quaternion, u v w p q r."""
        x, depth, pitch, *momenta = (float(v) for v in state)
        u, w, q = velocity(self.body, momenta, position, rate)
        return [x, 0.0, depth, float(np.cos(pitch / 2.0)), 0.0, float(np.sin(pitch / 2.0)), 0.0, u, 0.0, w, 0.0, q, 0.0]


class _InSpace:
    """The same in space."""

    def __init__(self, body: SpaceBody) -> None:
        self.body = body

    def start(self, moving: Array, attitude: Array, position: float) -> Array:
        """State at the origin."""
        return np.array([0.0, 0.0, 0.0, *attitude, *(self.body.matrix(position) @ moving)])

    def rates(self, leg: Leg) -> Rates:
        """Right-hand side."""
        return rates_in_space(self.body, leg)

    def row(self, state: Array, position: float, rate: float) -> list[float]:
        """North, east, depth, quaternion, u v w p q r."""
        north, depth, east, *turned = (float(v) for v in state[:7])
        length = float(np.linalg.norm(turned))
        nu = velocity_in_space(self.body, state[7:], position, rate)
        return [north, east, depth, *(q / length for q in turned), *nu.tolist()]


class _Flight:
    """The rows so far and where it stands."""

    def __init__(self, glider: Glider, manoeuvre: Manoeuvre, options: Options, motion: _InPlane | _InSpace) -> None:
        self.motion, self.options = motion, options
        roller, thrust = (1.0, 1.0) if glider.lateral is None or glider.thrusters is None else (
            glider.lateral.roller_rate, glider.thrusters.rate
        )  # fmt: skip
        self.rate = Setting(glider.engine.rate, glider.sliding_mass.rate, roller, thrust, thrust)
        self.now = Setting(*(manoeuvre.orders.get(name, 0.0) for name in Setting._fields))
        self.state = motion.start(np.asarray(manoeuvre.velocity), np.asarray(manoeuvre.attitude), self.now.position)
        self.time, self.phase = [0.0], [0]
        self.rows = [[*motion.row(self.state, self.now.position, 0.0), *self.now]]
        self.ended, self.why = Ended.COMPLETE, ""

    def fly(self, index: int, phase: Phase) -> bool:
        """Fly one phase; whether it met its depth."""
        ordered = self.now._replace(**phase.orders)
        until = None if phase.until is None else (phase.until.value, phase.until.rises)
        for leg in legs(self.time[-1], phase.longest, self.now, ordered, self.rate):
            found = march(self.motion.rates(leg), leg, self.state, self.options.step, until, self.options.tolerance)
            for time, state in zip(found.time, found.state, strict=True):
                self._row(index, float(time), state, leg)
            if found.why:
                self.why = (
                    f"in {phase.name}, after {self.time[-1]:.6g} s at {self.rows[-1][2]:.4g} m depth: {found.why}"
                )
                self.ended = Ended.STEP_TOO_SMALL if found.finite else Ended.NOT_FINITE
                return False
            if found.met:
                return True
        return False

    def _row(self, index: int, time: float, state: Array, leg: Leg) -> None:
        self.state, self.now = state, leg.setting(time)
        self.time.append(time)
        self.phase.append(index)
        self.rows.append([*self.motion.row(state, self.now.position, leg.rate.position), *self.now])

"""A vehicle with an arm under control: computed torque or station keeping, with the dynamics of its thrusters in the loop.

The controller asks for accelerations that bring vehicle and joints to their references. Computed torque turns them into forces by
M, C and all other forces of the model (equation 25 of the URV paper); station keeping by M at the start, with weight and buoyancy
taken up. The six forces on the vehicle become thrusts by the pseudo-inverse of the thruster matrix (section 3.6), thrusts
become propeller speeds, and those torques or voltages, each within its limits. What is out of reach is a status of the run.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from coeflab.arm import kane, thrusters
from coeflab.arm.chain import STILL, Chain, Flow
from coeflab.arm.motion import Equations, Track, at_rest, equations_of, limited, march
from coeflab.core.errors import InputError
from coeflab.core.types import Array, brief, locking
from coeflab.law.rigid_body import axes_in_earth
from coeflab.motion.dynamics import rotations
from coeflab.motion.trajectory import Ended

ROWS, TOLERANCE, METHOD = 0.05, 1e-6, "RK45"
SHORT = 1e-3  # of a limit: closer than that it is reached
IDLE = 1.0  # rad/s: how near zero the root of a thrust is made straight
LEVEL = (1.0, 0.0, 0.0, 0.0)


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("position attitude")
class Station:
    """Where the vehicle is to stay.

    Attributes
    ----------
    position : (3,) array
        Of its centre of mass, NED, m.
    attitude : (4,) array
        Unit quaternion, scalar first, body to NED.
    """

    position: Array = field(default_factory=lambda: np.zeros(3))
    attitude: Array = field(default_factory=lambda: np.array(LEVEL))


@brief
@dataclass(frozen=True, slots=True)
class Controller:
    """A law that asks for forces.

    Attributes
    ----------
    law : {"computed_torque", "station"}
        Computed torque knows the whole model; station keeping M at the start, and weight and buoyancy.
    vehicle_frequency, joint_frequency : float
        Natural frequency of an error, rad/s.
    damping : float
        Over the critical one.
    propeller_rate : float
        How fast a propeller is brought to its speed, 1/s.
    knows_current : bool
        Whether the model of computed torque has the current.
    """

    law: Literal["computed_torque", "station"] = "computed_torque"
    vehicle_frequency: float = 1.0
    joint_frequency: float = 4.0
    damping: float = 1.0
    propeller_rate: float = 10.0
    knows_current: bool = True

    def __post_init__(self) -> None:
        for name in ("vehicle_frequency", "joint_frequency", "damping", "propeller_rate"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"{getattr(self, name):g}", "a value above zero", column=name)


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("time state wanted propellers ordered thrust torque end end_wanted")
class ControlledRun:
    """A motion under control, one row a time.

    Attributes
    ----------
    chain : Chain
    controller : Controller
    station : Station
    time : (k,) array
        s.
    state : (k, 13 + 2 n) array
        As `coeflab.arm.kane.right_hand_side` has it.
    wanted : (k, n) array
        Joint positions that were asked for, rad or m.
    propellers : (k, p) array
        States of the thrusters' models, one after the other.
    ordered, thrust : (k, m) array
        Thrusts, N: asked for, and given.
    torque : (k, n) array
        Of the joints, N m or N.
    end, end_wanted : (k, 3) array
        End effector, and where it is with vehicle and joints at their references; NED, m.
    ended : Ended
    why : str
        In words, with its time, where it did not reach its end.
    saturated : tuple of str
        Thrusters and drives that were asked for more than they give, each with its time.
    """

    chain: Chain
    controller: Controller
    station: Station
    time: Array
    state: Array
    wanted: Array
    propellers: Array
    ordered: Array
    thrust: Array
    torque: Array
    end: Array
    end_wanted: Array
    ended: Ended
    why: str = ""
    saturated: tuple[str, ...] = ()

    @property
    def status(self) -> tuple[str, ...]:
        """What was out of reach: drives at their limits, a joint at its end; empty where nothing was."""
        return (*self.saturated, *((self.why,) if self.why else ()))

    @property
    def apart(self) -> Array:
        """(k,) distance of the vehicle's centre of mass from its station, m."""
        return np.asarray(np.linalg.norm(self.state[:, :3] - self.station.position, axis=1))

    @property
    def turned(self) -> Array:
        """(k,) angle between the vehicle's attitude and the station's, rad."""
        return np.asarray(
            [
                2.0 * np.arcsin(min(float(np.linalg.norm(_turn_left(s[3:7], self.station.attitude))), 1.0))
                for s in self.state
            ]
        )

    @property
    def q(self) -> Array:
        """(k, n) joint positions, rad or m."""
        return np.asarray(self.state[:, 7 : 7 + self.chain.count])

    @property
    def end_apart(self) -> Array:
        """(k,) distance of the end effector from its track, m."""
        return np.asarray(np.linalg.norm(self.end - self.end_wanted, axis=1))


def controlled(
    chain: Chain,
    controller: Controller,
    track: Track,
    lasts: float,
    *,
    station: Station | None = None,
    start: Array | None = None,
    propellers: Array | None = None,
    begins: float = 0.0,
    flow: Flow = STILL,
    rows: float = ROWS,
    tolerance: float = TOLERANCE,
    method: str = METHOD,
) -> ControlledRun:
    """Keep the vehicle on its station while the joints follow a track.

    Parameters
    ----------
    chain : Chain
        Its thrusters give every force and moment.
    controller : Controller
    track : Track
        Of the joints; `coeflab.arm.motion.track_of_end` makes one of the end effector.
    lasts : float
        s.
    station : Station, optional
        The origin, level, heading north, unless given.
    start : (13 + 2 n,) array, optional
        On station at rest, with the joints where the track begins, unless given.
    propellers : (p,) array, optional
        States of the thrusters' models; they stand still unless given.
    begins : float
        Time at the start, s.
    flow : Flow
        At time zero.
    rows : float
        s between rows.
    tolerance, method
        As `coeflab.arm.motion.march` takes them.

    Raises
    ------
    InputError
        Thrusters that cannot give every force and moment, with the directions that are lost.
    """
    station = Station() if station is None else station
    if start is None:
        start = at_rest(chain, track.at(begins)[0])
        start[:7] = np.concatenate([station.position, station.attitude])
    loop = _Loop(chain, controller, track, station, flow, start)
    if propellers is None:
        propellers = np.zeros(sum(t.order for t in chain.thrusters))
    found = march(
        chain, loop.rates, loop.control, np.concatenate([start, propellers]), begins, begins + lasts, rows, tolerance,
        method,
    )  # fmt: skip
    asked = [loop.asked(t, y) for t, y in zip(found.time, found.state, strict=True)]
    size, n = 13 + 2 * chain.count, chain.count
    thrusts = [loop.thrusts(y, a) for y, a in zip(found.state, asked, strict=True)]
    wanted = np.array([track.at(float(t))[0] for t in found.time])
    ideal = np.array([np.concatenate([station.position, station.attitude, q, np.zeros(6 + n)]) for q in wanted])
    ordered = np.array([loop.inverse @ a[:6] for a in asked])
    torque = np.array([a[6:] for a in asked])
    saturated = tuple(_at_limits(loop, found.time, ordered, torque))
    return ControlledRun(
        chain, controller, station, found.time, found.state[:, :size], wanted, found.state[:, size:], ordered, np.array(thrusts),
        np.array([limited(chain, a) for a in torque]), np.array([kane.end_in_earth(chain, s) for s in found.state]), np.array([kane.end_in_earth(chain, s) for s in ideal]), found.ended, found.why, saturated,
    )  # fmt: skip


class _Loop:
    """Controller, allocation, thrusters and the equations of motion."""

    def __init__(
        self, chain: Chain, controller: Controller, track: Track, station: Station, flow: Flow, start: Array
    ) -> None:
        self.chain, self.controller, self.track, self.station, self.flow = chain, controller, track, station, flow
        self.equations: Equations = equations_of(chain)
        self.inverse = thrusters.thrust_allocation(chain.thrusters)
        self.matrix = thrusters.thruster_matrix(chain.thrusters)
        self.size = 13 + 2 * chain.count
        self.at_start = kane.mass_matrix(chain, start[7 : 7 + chain.count])
        self.gains = tuple(gain_of(t, chain.density) for t in chain.thrusters)

    def asked(self, time: float, state: Array) -> Array:
        """(6 + n,) control forces that the law asks for."""
        n, chain = self.chain.count, self.chain
        changes = wanted_accelerations(self.controller, self.station, self.track, n, time, state)
        if self.controller.law == "computed_torque":
            m, force = self.equations(
                state[: self.size], self.flow.at(time) if self.controller.knows_current else STILL
            )
            return np.asarray(m @ changes - force)
        down = np.array(axes_in_earth(*state[3:7])[2::3])
        q = state[7 : 7 + n]
        return np.asarray(self.at_start @ changes - kane.weight(chain, q, down) - kane.buoyancy(chain, q, down))

    def commands(self, state: Array, asked: Array) -> Array:
        """(m,) torques, voltages or thrusts that the thrusters get."""
        ordered, out, at = self.inverse @ asked[:6], np.zeros(len(self.gains)), self.size
        for i, (thruster, gain) in enumerate(zip(self.chain.thrusters, self.gains, strict=True)):
            here = state[at : at + thruster.order]
            out[i] = demand(thruster, gain, float(ordered[i]), here, self.controller.propeller_rate, self.chain.density)
            at += thruster.order
        return out

    def thrusts(self, state: Array, asked: Array) -> Array:
        """(m,) thrusts that act, N."""
        return thrusters.thruster_forces(
            self.chain.thrusters, state[self.size :], self.commands(state, asked), self.chain.density
        )

    def control(self, time: float, state: Array) -> Array:
        """(6 + n,) control forces that act."""
        asked = self.asked(time, state)
        return np.concatenate([self.matrix @ self.thrusts(state, asked), limited(self.chain, asked[6:])])

    def rates(self, time: float, state: Array) -> Array:
        """Of the whole state."""
        asked = self.asked(time, state)
        commands = self.commands(state, asked)
        density, propellers = self.chain.density, state[self.size :]
        pushed = self.matrix @ thrusters.thruster_forces(self.chain.thrusters, propellers, commands, density)
        m, force = self.equations(state[: self.size], self.flow.at(time))
        changed = np.linalg.solve(m, force + np.concatenate([pushed, limited(self.chain, asked[6:])]))
        moved = kane.displacement_rates(self.chain.count, state)
        return np.concatenate(
            [moved, changed, thrusters.thruster_rates(self.chain.thrusters, propellers, commands, density)]
        )


def wanted_accelerations(
    controller: Controller, station: Station, track: Track, count: int, time: float, state: Array
) -> Array:
    """(6 + n,) rates of the generalised speeds that bring every error e to zero by e'' + 2 zeta w e' + w^2 e = 0.

    The vehicle's place obeys that in the earth, so that its speeds change by w x v less; its attitude by the vector part of the
    quaternion of what is left to turn, twice, which is the angle where it is small.
    """
    q, s = state[7 : 7 + count], state[7 + count : 13 + 2 * count]
    turn = rotations(state[None, 3:7])[0]
    place, pace = controller.vehicle_frequency, 2.0 * controller.damping
    out = np.empty(6 + count)
    pulled = place**2 * (turn.T @ (station.position - state[:3])) - pace * place * s[:3]
    out[:3] = pulled - kane.cross(s[3:6], s[:3])
    out[3:6] = 2.0 * place**2 * _turn_left(state[3:7], station.attitude) - pace * place * s[3:6]
    wanted, rate, change = track.at(time)
    out[6:] = change + pace * controller.joint_frequency * (rate - s[6:]) + controller.joint_frequency**2 * (wanted - q)
    return out


def _turn_left(attitude: Array, wanted: Array) -> Array:
    """(3,) vector part of the quaternion from an attitude to a wanted one, along the body's axes, the shorter way."""
    w, v, w0, v0 = float(attitude[0]), attitude[1:], float(wanted[0]), wanted[1:]
    scalar = w * w0 + float(v @ v0)
    vector = w * v0 - w0 * v - np.cross(v, v0)
    return np.asarray(vector if scalar >= 0.0 else -vector)


def gain_of(thruster: thrusters.Thruster, density: float) -> float:
    """Thrust over Omega |Omega|, N s^2/rad^2, where the thruster turns steadily at rest; one without a model has 1."""
    model = thruster.model
    if model is None:
        return 1.0
    turning = float(model.steady(1.0, density)[1][0])
    return 1.0 / (turning * abs(turning))


def demand(
    thruster: thrusters.Thruster, gain: float, thrust: float, state: Array, pace: float, density: float
) -> float:
    """Torque, N m, or voltage, V, that brings a propeller to the speed of a thrust at ``pace``, 1/s; without a model the thrust.

    The speed is the root of thrust over gain, but for a straight line through zero that is as wide as the thrust of 1 rad/s, so that no
    thrust asks for a jump. The propeller's own losses are taken up: of the torque model alpha Omega |Omega|, of the voltage model friction and the blades.
    """
    model = thruster.model
    if model is None:
        return thrust
    square = thrust / gain
    aim = square / (square * square + IDLE**4) ** 0.25
    idle = float(model.rates(state, 0.0, density)[0])
    power = model.beta if isinstance(model, thrusters.TorqueThruster) else model.drive
    wanted = (pace * (aim - float(state[0])) - idle) / power
    return float(np.clip(wanted, -model.strongest, model.strongest))


def most_thrust(thruster: thrusters.Thruster, gain: float, density: float) -> float:
    """Largest steady thrust, N."""
    model = thruster.model
    if model is None or not np.isfinite(model.strongest):
        return np.inf
    if isinstance(model, thrusters.TorqueThruster):
        return model.thrust * model.beta * model.strongest / model.alpha
    return _most_by_voltage(model, gain, density)


def _most_by_voltage(model: thrusters.VoltageThruster, gain: float, density: float) -> float:
    """Of the voltage model: damping Omega + load Q = drive V, Q by the square of Omega."""
    volts, state = model.steady(1.0, density)
    turning = float(state[0])
    load = (volts * model.drive - model.damping * turning) / turning**2
    half = model.damping / 2.0
    fastest = (math.sqrt(half**2 + load * model.drive * model.strongest) - half) / load
    return gain * fastest**2


def _at_limits(loop: _Loop, time: Array, ordered: Array, torque: Array) -> Iterator[str]:
    """In words: which thrusters and joints were asked for more than they give, since when and for how long."""
    chain = loop.chain
    most = [most_thrust(t, g, chain.density) for t, g in zip(chain.thrusters, loop.gains, strict=True)]
    names = [f"thruster {t.name}" for t in chain.thrusters] + [f"joint {j.name}" for j in chain.joints]
    limits = np.array([*most, *(j.strongest for j in chain.joints)])
    beyond = np.abs(np.hstack([ordered, torque])) > (1.0 + SHORT) * limits
    length = np.gradient(time) if len(time) > 1 else np.zeros(len(time))
    for k, name in enumerate(names):
        if beyond[:, k].any():
            first, share = float(time[np.argmax(beyond[:, k])]), float(length[beyond[:, k]].sum())
            yield f"saturated: {name} from {first:.3g} s, for {share:.3g} s in all"

"""Control of a vehicle with an arm: computed torque or station keeping, thrusters and their dynamics in the loop.

The controller asks for accelerations that bring vehicle and joints to their references; computed torque turns them into forces by
M, C and all other forces of the model (equation 25 of the URV paper), station keeping by M at the start and the restoring
forces alone. The vehicle's six forces become thrusts by the pseudo-inverse of the thruster matrix (section 3.6), thrusts
become speeds of the propellers, and those torques or voltages, each within its limits. What is out of reach is a status of the run.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.types import Array, brief, locked
from coeflab.core.wording import listed
from coeflab.law.rigid_body import axes_in_earth, kinematics
from coeflab.motion.dynamics import rotations
from coeflab.motion.marching import compiles
from coeflab.motion.multibody import kane
from coeflab.motion.multibody.chain import STILL, Chain, Flow
from coeflab.motion.multibody.thrusters import Thruster, TorqueThruster, VoltageThruster

FORCES = ("X", "Y", "Z", "K", "M", "N")
LOST = 1e-6
STEP = 0.02
ITERATIONS, CLOSE, DAMPED = 60, 1e-9, 1e-4
STATE = 7  # position and quaternion, before the joints
Law = Callable[[Array], tuple[Array, Array]]


# ---- what is wanted ------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class JointPath:
    """Joint positions in time, by a cubic spline; at rest before its beginning and after its end.

    Attributes
    ----------
    time : (k,) array
        s, rising.
    q : (k, n) array
        rad or m.
    missed : float
        How far the end effector stays from the places that were asked for, m; zero where joints were.
    """

    time: Array
    q: Array
    missed: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "time", locked(self.time))
        object.__setattr__(self, "q", locked(self.q))

    @cached_property
    def _splines(self) -> tuple[Any, Any, Any]:
        from scipy.interpolate import CubicSpline

        whole = CubicSpline(self.time, self.q, bc_type="clamped")
        return whole, whole.derivative(1), whole.derivative(2)

    def at(self, time: float) -> tuple[Array, Array, Array]:
        """q, its rate and its acceleration at a time, each (n,)."""
        within = float(np.clip(time, self.time[0], self.time[-1]))
        whole, rate, change = self._splines
        moving = 1.0 if self.time[0] <= time <= self.time[-1] else 0.0
        return whole(within), moving * rate(within), moving * change(within)


def joint_move(start: Array, end: Array, begins: float, ends: float) -> JointPath:
    """From one arm pose to another, fifth order in time: speeds and accelerations are zero at both ends."""
    if not begins < ends:
        raise InputError(f"{begins:g} to {ends:g} s", "a time that ends after it begins", column="joints")
    x = np.linspace(0.0, 1.0, 101)
    share = x**3 * (10.0 + x * (6.0 * x - 15.0))
    return JointPath(begins + x * (ends - begins), start + share[:, None] * (end - start))


def end_track(chain: Chain, station: Station, time: Array, places: Array, start: Array) -> JointPath:
    """Joint positions that bring the end effector of a vehicle on its station through places.

    Parameters
    ----------
    chain : Chain
    station : Station
    time : (k,) array
        s.
    places : (k, 3) array
        North, east, down, m.
    start : (n,) array
        Near the first.

    Notes
    -----
    Newton's method with damping 1e-4 of the smallest gain; a place out of reach is missed by `JointPath.missed`, no joint is
    turned beyond its limits.
    """
    turn, q = rotations(station.attitude[None])[0], np.array(start)
    low, high = (np.array([getattr(j, side) for j in chain.joints]) for side in ("low", "high"))
    path, missed = [], 0.0
    for place in places:
        goal = turn.T @ (place - station.position)
        for _ in range(ITERATIONS):
            at = kane.pose(chain, q)
            apart = goal - at.end
            if float(np.linalg.norm(apart)) < CLOSE:
                break
            slopes = end_slopes(chain, at)
            step = slopes.T @ np.linalg.solve(slopes @ slopes.T + DAMPED**2 * np.eye(3), apart)
            q = np.clip(q + step, low, high)
        missed = max(missed, float(np.linalg.norm(goal - kane.pose(chain, q).end)))
        path.append(q)
    return JointPath(time, np.array(path), missed)


def end_slopes(chain: Chain, at: kane.Pose) -> Array:
    """(3, n) slopes of the end effector's place over the joints, along the vehicle's axes."""
    places = np.vstack([at.centre[:-1], at.end])
    return kane.partial_velocities(chain, at, places)[-1, :3, 6:]


@brief
@dataclass(frozen=True, slots=True, eq=False)
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
    attitude: Array = field(default_factory=lambda: np.array([1.0, 0.0, 0.0, 0.0]))

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", locked(self.position))
        object.__setattr__(self, "attitude", locked(self.attitude))


@brief
@dataclass(frozen=True, slots=True)
class Controller:
    """A law that asks for forces.

    Attributes
    ----------
    law : {"computed_torque", "station"}
        Computed torque knows the whole model; station keeping M at the start of the run and the restoring forces.
    vehicle, joints : float
        Natural frequency of an error, rad/s.
    damping : float
        Over the critical one.
    propeller : float
        How fast a propeller is brought to its speed, 1/s.
    knows_current : bool
        Whether the model of computed torque has the current.
    """

    law: Literal["computed_torque", "station"] = "computed_torque"
    vehicle: float = 1.0
    joints: float = 4.0
    damping: float = 1.0
    propeller: float = 10.0
    knows_current: bool = True

    def __post_init__(self) -> None:
        for name in ("vehicle", "joints", "damping", "propeller"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"{getattr(self, name):g}", "a value above zero", column=name)


# ---- thrusters -----------------------------------------------------------------------------------------------------


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Allocation:
    """From forces on the vehicle to thrusts.

    Attributes
    ----------
    matrix : (6, m) array
        Theta of the URV paper: forces and moments about the centre of mass of unit thrusts.
    inverse : (m, 6) array
        Its pseudo-inverse: the least sum of squares of thrusts.
    """

    matrix: Array
    inverse: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "matrix", locked(self.matrix))
        object.__setattr__(self, "inverse", locked(self.inverse))


def allocation(thrusters: Sequence[Thruster]) -> Allocation:
    """The thruster matrix and its pseudo-inverse.

    Raises
    ------
    InputError
        The thrusters cannot give every force and moment; it names the directions that are lost.
    """
    columns = [np.concatenate([t.axis, np.cross(t.place, t.axis)]) for t in thrusters]
    matrix = np.array(columns).T.reshape(6, -1)
    if lost := lost_directions(matrix):
        raise InputError(
            f"a thruster matrix of rank {6 - len(lost)}: nothing gives {listed(lost)}",
            "thrusters that give every force and moment, rank 6",
            column="thruster",
            advice="Add thrusters, or turn some, so that the lost directions are reached.",
        )
    return Allocation(matrix, np.linalg.pinv(matrix))


def lost_directions(matrix: Array) -> tuple[str, ...]:
    """What a (6, m) thruster matrix cannot give: ``K``, or a combination such as ``0.8 Y - 0.6 N``."""
    left, sizes, _ = np.linalg.svd(matrix, full_matrices=True)
    rank = int(np.sum(sizes > LOST * max(1.0, float(sizes.max(initial=0.0)))))
    basis = _echelon(left[:, rank:].T)
    out = []
    for row in basis:
        parts = [(round(float(v), 3), name) for v, name in zip(row, FORCES, strict=True) if abs(v) > LOST]
        text = " ".join(f"{'-' if v < 0.0 else '+'} {'' if abs(v) == 1.0 else f'{abs(v):g} '}{name}" for v, name in parts)
        out.append(text.removeprefix("+ ").replace("- ", "-", 1) if text.startswith("- ") else text.removeprefix("+ "))
    return tuple(out)


def _echelon(rows: Array) -> Array:
    """Rows reduced so that each has a 1 where all others have none: single names where that can be."""
    out, pivot = np.array(rows), 0
    for column in range(rows.shape[1]):
        if pivot == len(out):
            break
        best = pivot + int(np.argmax(np.abs(out[pivot:, column])))
        if abs(out[best, column]) < LOST:
            continue
        out[[pivot, best]] = out[[best, pivot]]
        out[pivot] /= out[pivot, column]
        for other in range(len(out)):
            if other != pivot:
                out[other] -= out[other, column] * out[pivot]
        pivot += 1
    return out


def blade(model: VoltageThruster, omega: float, through: float, density: float) -> tuple[float, float]:
    """Thrust, N, and torque, N m, of a propeller's blades in water that goes through it (Healey et al. 1994)."""
    tip = 0.7 * model.radius * omega
    theta = np.arctan2(through, tip)
    incidence = model.pitch - theta
    area = np.pi * model.radius**2
    size = 0.5 * density * area * (tip**2 + through**2)
    lift, drag = size * model.lift * np.sin(2.0 * incidence), size * model.drag * (1.0 - np.cos(2.0 * incidence))
    thrust = lift * np.cos(theta) - drag * np.sin(theta)
    return float(thrust), float(0.7 * model.radius * (lift * np.sin(theta) + drag * np.cos(theta)))


def steady_flow(model: VoltageThruster, omega: float, density: float) -> float:
    """Speed of the water through a propeller that turns steadily at rest, m/s: T = rho A delta v_p |v_p|."""
    from scipy.optimize import brentq

    area, tip = np.pi * model.radius**2, 0.7 * model.radius

    def left(ratio: float) -> float:
        return blade(model, 1.0, ratio * tip, density)[0] - density * area * model.momentum * (ratio * tip) ** 2

    return float(brentq(left, 0.0, np.tan(model.pitch))) * tip * omega


def thrust_of(model: TorqueThruster | VoltageThruster, state: Array, density: float) -> float:
    """Thrust, N, at a propeller's speed and the water's through it (2,)."""
    if isinstance(model, TorqueThruster):
        return model.thrust * float(state[0] * abs(state[0]))
    return blade(model, float(state[0]), float(state[1]), density)[0]


def propeller_rates(model: TorqueThruster | VoltageThruster, state: Array, drive: float, density: float) -> Array:
    """(2,) rates of a propeller's speed and of the water through it, by a torque, N m, or a voltage, V."""
    omega, through = float(state[0]), float(state[1])
    if isinstance(model, TorqueThruster):
        return np.array([model.beta * drive - model.alpha * omega * abs(omega), 0.0])
    thrust, torque = blade(model, omega, through, density)
    mass = density * np.pi * model.radius**2
    turning = -model.damping * omega + model.drive * drive - model.load * torque
    return np.array([turning, (thrust - mass * model.momentum * through * abs(through)) / (mass * model.column)])


@brief
@dataclass(frozen=True, slots=True)
class Drive:
    """A thruster with what its controller knows: thrust = gain Omega |Omega| where it turns steadily at rest.

    Attributes
    ----------
    model : TorqueThruster, VoltageThruster or None
    gain : float
        N s^2/rad^2.
    most : float
        Largest steady thrust, N.
    """

    model: TorqueThruster | VoltageThruster | None
    gain: float
    most: float

    def demand(self, thrust: float, state: Array, pace: float, density: float) -> float:
        """Torque or voltage, within its limits, that brings the propeller to the speed of a thrust at ``pace``, 1/s."""
        model, omega = self.model, float(state[0])
        aim = np.sign(thrust) * np.sqrt(abs(thrust) / self.gain)
        if isinstance(model, TorqueThruster):
            drive = (model.alpha * omega * abs(omega) + pace * (aim - omega)) / model.beta
        elif isinstance(model, VoltageThruster):
            torque = blade(model, omega, float(state[1]), density)[1]
            drive = (model.damping * omega + model.load * torque + pace * (aim - omega)) / model.drive
        else:
            return thrust
        return float(np.clip(drive, -model.strongest, model.strongest))


def drive_of(thruster: Thruster, density: float) -> Drive:
    """What the controller of a thruster has to know of it."""
    model = thruster.model
    if model is None:
        return Drive(None, 1.0, np.inf)
    if isinstance(model, TorqueThruster):
        return Drive(model, model.thrust, model.thrust * model.beta * model.strongest / model.alpha)
    through = steady_flow(model, 1.0, density)
    gain, load = blade(model, 1.0, through, density)
    if not np.isfinite(model.strongest):
        return Drive(model, gain, np.inf)
    a, b = model.load * load, model.damping
    fastest = (-b + np.sqrt(b * b + 4.0 * a * model.drive * model.strongest)) / (2.0 * a)
    return Drive(model, gain, gain * fastest**2)

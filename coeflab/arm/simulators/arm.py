"""A vehicle with an arm by Kane's equations: free motion, torques, tracks of joints and of the end effector, station keeping.

Equations in `coeflab.arm.kane`, with the errata of the URV paper. Deeply submerged: no surface, no waves; water that
moves as a whole; a joint that meets a limit ends the motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coeflab.arm import kane
from coeflab.arm.arm_keys import LAWS
from coeflab.arm.chain import Chain, Flow
from coeflab.arm.control import ControlledRun, Controller, Station, controlled
from coeflab.arm.motion import Drive, March, Track, at_rest, driven, march, track_of_end, track_to
from coeflab.arm.thrusters import thruster_forces, thruster_matrix
from coeflab.core.errors import InputError, shown
from coeflab.core.limits import require_rows
from coeflab.core.options import bounded, measured, one_of, parse_options
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.motion.dynamics import rotations
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.trajectory import Ended, Trajectory

summary = "a vehicle with an arm of any number of links: free, driven, or with joints and end effector on tracks"
citations = ("urv_kane", "yoerger1990", "healey1994")


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the integration.

    Attributes
    ----------
    record : float
        Time between rows, s; it does not touch the accuracy.
    tolerance : float
        Relative tolerance of the integration.
    method : str
        Integrator of scipy.
    law : {"computed_torque", "station"}
        Of the controller of a vehicle that is kept: the whole model, or the inertia at the start of the phase, weight and buoyancy.
    vehicle_frequency, joint_frequency : float
        Natural frequency of errors of the vehicle, and of the joints.
    damping : float
        Of these errors, over the critical one.
    propeller_rate : float
        How fast a propeller is brought to its speed, 1/s.
    knows_current : {"yes", "no"}
        Whether the model of computed torque has the current.
    thrusters : {"modelled", "at_once"}
        at_once: thrusters without dynamics and limits give what the controller asks for.
    north, east, down : float
        Velocity of the water at the start, m/s.
    gaining_north, gaining_east, gaining_down : float
        Acceleration of the water, m/s^2.
    """

    record: float = bounded(0.05, 1e-4, 3600.0)
    tolerance: float = bounded(1e-9, 1e-12, 1e-3)
    method: str = one_of("DOP853", "DOP853", "LSODA", "RK45", "Radau")
    law: str = one_of("computed_torque", *LAWS)
    vehicle_frequency: float = measured(1.0, 1e-6, 1e3, "rate", frequency=True)
    joint_frequency: float = measured(4.0, 1e-6, 1e3, "rate", frequency=True)
    damping: float = bounded(1.0, 1e-6, 1e3)
    propeller_rate: float = bounded(10.0, 1e-6, 1e4)
    knows_current: str = one_of("yes", "yes", "no")
    thrusters: str = one_of("modelled", "modelled", "at_once")
    north: float = measured(0.0, -20.0, 20.0, "speed")
    east: float = measured(0.0, -20.0, 20.0, "speed")
    down: float = measured(0.0, -20.0, 20.0, "speed")
    gaining_north: float = measured(0.0, -20.0, 20.0, "acceleration")
    gaining_east: float = measured(0.0, -20.0, 20.0, "acceleration")
    gaining_down: float = measured(0.0, -20.0, 20.0, "acceleration")


def simulate(vehicle: Chain, manoeuvre: Manoeuvre, options: Mapping[str, Any]) -> Trajectory:
    """Move an arm through phases.

    Parameters
    ----------
    vehicle : Chain
    manoeuvre : Manoeuvre
        Orders of each phase: ``vehicle.held`` or ``vehicle.kept``, 0 or 1; joint positions by name, ``NAME.torque``, or ``end.x``, ``end.y``, ``end.z`` of
        the end effector from the vehicle's centre of mass, FRD; commands of thrusters by name. At the start ``NAME.rate``.
    options : mapping
        See `Options`.

    Returns
    -------
    Trajectory
        Of the vehicle's centre of mass, its velocity through the water. ``controls`` holds, with their units, joint positions, rates
        and torques (forces of those that slide), the force and moment on the vehicle by its thrusters or by what holds it, thrusts, and the end effector, NED.
        Where a vehicle is kept, ``.wanted`` is what joints and end effector are to be, and what thrusters are asked for; else it is not a number.
        ``outside`` flags joints that are quicker or stronger than their drives.

    Raises
    ------
    InputError
        Unknown options or orders, a track out of reach, more than a million rows.
    """
    chosen = parse_options(Options, options, "arm")
    if not isinstance(vehicle, Chain):
        raise InputError("the vehicle of a parameter file", "a vehicle with an arm", column="arm")
    _require_known(vehicle, manoeuvre)
    require_rows(manoeuvre.duration / chosen.record, "arm.record", "Take a longer time between rows.")
    gained = np.array([chosen.gaining_north, chosen.gaining_east, chosen.gaining_down])
    flow = Flow(np.array([chosen.north, chosen.east, chosen.down]), gained)
    n, states_of_thrusters = vehicle.count, sum(t.order for t in vehicle.thrusters)
    rates = np.array([manoeuvre.orders.get(f"{j.name}.rate", 0.0) for j in vehicle.joints])
    state = np.concatenate([at_rest(vehicle, None, manoeuvre.velocity, rates), np.zeros(states_of_thrusters)])
    state[3:7] = manoeuvre.attitude
    if chosen.thrusters == "at_once":
        _require_no_commands(vehicle, manoeuvre)
        vehicle = replace(vehicle, thrusters=tuple(replace(one, model=None) for one in vehicle.thrusters))
        state = state[: 13 + 2 * n]
    time, ended, why = 0.0, Ended.COMPLETE, ""
    rows: list[_Rows] = []
    words: list[str] = []
    station = Station(attitude=manoeuvre.attitude)
    reference: Track | None = None
    for index, phase in enumerate(manoeuvre.phases):
        if phase.orders.get("vehicle.kept"):
            reference = _reference(vehicle, phase, state, time, f"phase[{index}]", reference)
            run = controlled(
                vehicle, _controller(chosen), reference, phase.longest, station=station, start=state[: 13 + 2 * n],
                propellers=state[13 + 2 * n :], begins=time, flow=flow, rows=chosen.record, tolerance=chosen.tolerance,
                method=chosen.method,
            )  # fmt: skip
            rows.append(_of_run(run, index))
            words += [f"{phase.name}: {one}" for one in run.saturated]
            ended, met = run.ended, run.why
        else:
            reference = None
            drive = _drive(vehicle, phase, state, time, f"phase[{index}]")
            moving, acting = driven(vehicle, drive, flow)
            size = len(state) if drive.commands is not None else 13 + 2 * n
            found = march(
                vehicle, moving, acting, state[:size], time, time + phase.longest, chosen.record, chosen.tolerance,
                chosen.method,
            )  # fmt: skip
            rows.append(_of_march(vehicle, drive, found, len(state), index))
            ended, met = found.ended, found.why
        state, time = rows[-1].state[-1].copy(), float(rows[-1].time[-1])
        if met:
            why = f"in {phase.name}, {met}"
            break
    every = _Rows(*(np.concatenate(parts) for parts in zip(*rows, strict=True)))
    return _trajectory(vehicle, manoeuvre, flow, every, ended, why, tuple(words))


class _Rows(NamedTuple):
    """Rows of phases; what is wanted where a controller wants it, else not a number."""

    time: Array
    state: Array
    control: Array
    phase: NDArray[np.int64]
    thrust: Array
    wanted: Array
    ordered: Array
    end_wanted: Array


def _of_run(run: ControlledRun, index: int) -> _Rows:
    """Rows of a phase under control."""
    k = len(run.time)
    pushed = run.thrust @ thruster_matrix(run.chain.thrusters).T
    return _Rows(
        run.time, np.hstack([run.state, run.propellers]), np.hstack([pushed, run.torque]), np.full(k, index), run.thrust,
        run.wanted, run.ordered, run.end_wanted,
    )  # fmt: skip


def _of_march(chain: Chain, drive: Drive, found: March, size: int, index: int) -> _Rows:
    """Rows of a phase without a controller; thrusters without commands stand still."""
    k, m = len(found.time), len(chain.thrusters)
    state = np.zeros((k, size))
    state[:, : found.state.shape[1]] = found.state
    thrusts = np.array([_thrusts(chain, drive, row) for row in state]).reshape(k, m)
    blank = [np.full((k, columns), np.nan) for columns in (chain.count, m, 3)]
    return _Rows(found.time, state, found.control, np.full(k, index), thrusts, *blank)


def _controller(chosen: Options) -> Controller:
    law: Any = chosen.law
    return Controller(
        law, chosen.vehicle_frequency, chosen.joint_frequency, chosen.damping, chosen.propeller_rate, chosen.knows_current == "yes",
    )  # fmt: skip


def _reference(
    chain: Chain, phase: Phase, state: Array, begins: float, key: str, before: Track | None
) -> Track:  # fmt: skip
    """The joints' track of a phase under control, from where the one before it ends, else from where they are."""
    n = chain.count
    at = state.copy()
    if before is not None:
        at[7 : 7 + n], at[13 + n : 13 + 2 * n] = before.positions[-1], 0.0
    track = _drive(chain, phase, at, begins, key).track
    q = at[7 : 7 + n]
    return track or Track(begins, begins + phase.longest, np.array([q, q]), at[13 + n : 13 + 2 * n])


def _require_no_commands(chain: Chain, manoeuvre: Manoeuvre) -> None:
    for phase in manoeuvre.phases:
        if any(one.name in phase.orders for one in chain.thrusters):
            raise input_error("arm.once_commands", column="arm.thrusters", name=phase.name)


def _require_known(chain: Chain, manoeuvre: Manoeuvre) -> None:
    joints = [joint.name for joint in chain.joints]
    known = {"vehicle.held", "vehicle.kept", "end.x", "end.y", "end.z", *joints, *(f"{j}.torque" for j in joints)}
    known |= {t.name for t in chain.thrusters}
    for phase in manoeuvre.phases:
        if unknown := [order for order in phase.orders if order not in known]:
            raise InputError(
                f"the order {shown(unknown[0])} in {phase.name}", f"one of {', '.join(sorted(known))}", column="arm"
            )
        if phase.until is not None:
            raise InputError(f"{phase.name} until {phase.until.quantity}", "a phase that ends by time", column="arm")


def _drive(chain: Chain, phase: Phase, state: Array, begins: float, key: str) -> Drive:
    """What acts in a phase that begins at a state; complaints name its key in a body.toml."""
    n = chain.count
    q, rates, ends = state[7 : 7 + n], state[13 + n : 13 + 2 * n], begins + phase.longest
    wanted = phase.orders
    track = None
    try:
        if any(joint.name in wanted for joint in chain.joints):
            to = np.array([wanted.get(j.name, here) for j, here in zip(chain.joints, q, strict=True)])
            track = track_to(chain, q, to, begins, ends, rates)
        elif "end.x" in wanted:
            track = track_of_end(chain, q, np.array([wanted[f"end.{axis}"] for axis in "xyz"]), begins, ends, rates)
    except InputError as why:
        raise why.at(column=f"{key}.{why.column}") from None
    torque = np.array([wanted.get(f"{joint.name}.torque", 0.0) for joint in chain.joints])
    driving = any(t.name in wanted for t in chain.thrusters)
    commands = np.array([wanted.get(t.name, 0.0) for t in chain.thrusters]) if driving else None
    return Drive(bool(wanted.get("vehicle.held", 0.0)), track, torque, commands)


def _thrusts(chain: Chain, drive: Drive, state: Array) -> Array:
    if drive.commands is None:
        return np.zeros(len(chain.thrusters))
    return thruster_forces(chain.thrusters, state[13 + 2 * chain.count :], drive.commands, chain.density)


def _trajectory(
    chain: Chain, manoeuvre: Manoeuvre, flow: Flow, rows: _Rows, ended: Ended, why: str, notes: tuple[str, ...]
) -> Trajectory:
    n, state = chain.count, rows.state
    q, rates, torques = state[:, 7 : 7 + n], state[:, 13 + n : 13 + 2 * n], rows.control[:, 6:]
    axes = rotations(state[:, 3:7])
    through = state[:, 7 + n : 13 + n].copy()
    water = flow.velocity + rows.time[:, None] * flow.acceleration
    through[:, :3] -= np.einsum("kji,kj->ki", axes, water)
    selected = bool(np.isfinite(rows.end_wanted).any())
    columns: dict[str, Array] = {}
    outside = {}
    for k, joint in enumerate(chain.joints):
        unit, effort = ("rad", "N m") if joint.turns else ("m", "N")
        columns[f"{joint.name} [{unit}]"] = q[:, k]
        columns[f"{joint.name}.rate [{unit}/s]"] = rates[:, k]
        columns[f"{joint.name}.{'torque' if joint.turns else 'force'} [{effort}]"] = torques[:, k]
        if selected:
            columns[f"{joint.name}.wanted [{unit}]"] = rows.wanted[:, k]
        outside[f"{joint.name} quicker than its drive"] = np.abs(rates[:, k]) > joint.fastest
        outside[f"{joint.name} stronger than its drive"] = np.abs(torques[:, k]) > joint.strongest
    for k, name in enumerate(("X", "Y", "Z", "K", "M", "N")):
        columns[f"{name}.vehicle [{'N' if k < 3 else 'N m'}]"] = rows.control[:, k]
    for k, thruster in enumerate(chain.thrusters):
        columns[f"{thruster.name} [N]"] = rows.thrust[:, k]
        if selected:
            columns[f"{thruster.name}.wanted [N]"] = rows.ordered[:, k]
    ends = np.array([kane.end_in_earth(chain, row) for row in state])
    for k, name in enumerate(("north", "east", "down")):
        columns[f"end.{name} [m]"] = ends[:, k]
        if selected:
            columns[f"end.{name}.wanted [m]"] = rows.end_wanted[:, k]
    ahead = axes[:, :, 0]
    heading = np.unwrap(np.arctan2(ahead[:, 1], ahead[:, 0]))
    statements = list(chain.assumed) + [
        f"{name}, for {float(np.mean(flags)):.1%} of the rows." for name, flags in outside.items() if flags.any()
    ]
    return Trajectory(
        time=rows.time,
        position=state[:, :3],
        attitude=state[:, 3:7],
        velocity=through,
        heading=heading - heading[0],
        controls=columns,
        phase=rows.phase,
        phases=tuple(p.name for p in manoeuvre.phases),
        reached=tuple(None for _ in manoeuvre.phases),
        outside=outside,
        ended=ended,
        why=why,
        statements=(*statements, *notes),
    )

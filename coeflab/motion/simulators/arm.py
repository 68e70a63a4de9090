"""A vehicle with an arm by Kane's equations: free motion, torques, tracks of joints and of the end effector.

Equations in `coeflab.motion.multibody.kane`, with the errata of the URV paper. Deeply submerged: no surface, no waves; water that
moves as a whole; a joint that meets a limit ends the motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import require_rows
from coeflab.core.options import bounded, measured, one_of, parse_options
from coeflab.core.types import Array
from coeflab.motion.dynamics import rotations
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.multibody import kane
from coeflab.motion.multibody.chain import Chain, Flow
from coeflab.motion.multibody.motion import Drive, at_rest, driven, march, track_of_end, track_to
from coeflab.motion.multibody.thrusters import thruster_forces
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
    north, east, down : float
        Velocity of the water at the start, m/s.
    gaining_north, gaining_east, gaining_down : float
        Acceleration of the water, m/s^2.
    """

    record: float = bounded(0.05, 1e-4, 3600.0)
    tolerance: float = bounded(1e-9, 1e-12, 1e-3)
    method: str = one_of("DOP853", "DOP853", "LSODA", "RK45", "Radau")
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
        Orders of each phase: ``vehicle.held`` 0 or 1; joint positions by name, ``NAME.torque``, or ``end.x``, ``end.y``, ``end.z`` of
        the end effector from the vehicle's centre of mass, FRD; commands of thrusters by name. At the start ``NAME.rate``.
    options : mapping
        See `Options`.

    Returns
    -------
    Trajectory
        Of the vehicle's centre of mass, its velocity through the water. ``controls`` holds, with their units, joint positions, rates
        and torques (forces of those that slide), the force and moment on the vehicle by its thrusters or by what holds it, thrusts, and the end effector, NED.
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
    time, ended, why = 0.0, Ended.COMPLETE, ""
    times, rows, controls, thrusts = [], [], [], []
    phase_of: list[int] = []
    for index, phase in enumerate(manoeuvre.phases):
        drive = _drive(vehicle, phase, state, time, f"phase[{index}]")
        moving, acting = driven(vehicle, drive, flow)
        size = len(state) if drive.commands is not None else 13 + 2 * n
        found = march(
            vehicle, moving, acting, state[:size], time, time + phase.longest, chosen.record, chosen.tolerance,
            chosen.method,
        )  # fmt: skip
        if drive.commands is None:
            state[13 + 2 * n :] = 0.0
        for k, row in enumerate(found.state):
            state[: len(row)] = row
            times.append(found.time[k])
            rows.append(state.copy())
            controls.append(found.control[k])
            phase_of.append(index)
            thrusts.append(_thrusts(vehicle, drive, state))
        time, ended, why = float(found.time[-1]), found.ended, found.why and f"in {phase.name}, {found.why}"
        if why:
            break
    return _trajectory(
        vehicle, manoeuvre, flow, np.array(times), np.array(rows), np.array(controls), np.array(phase_of, dtype=np.int64),
        np.array(thrusts), ended, why,
    )  # fmt: skip


def _require_known(chain: Chain, manoeuvre: Manoeuvre) -> None:
    joints = [joint.name for joint in chain.joints]
    known = {"vehicle.held", "end.x", "end.y", "end.z", *joints, *(f"{j}.torque" for j in joints)}
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
        raise InputError(why.found, why.expected, column=f"{key}.{why.column}", advice=why.advice) from None
    torque = np.array([wanted.get(f"{joint.name}.torque", 0.0) for joint in chain.joints])
    driving = any(t.name in wanted for t in chain.thrusters)
    commands = np.array([wanted.get(t.name, 0.0) for t in chain.thrusters]) if driving else None
    return Drive(bool(wanted.get("vehicle.held", 0.0)), track, torque, commands)


def _thrusts(chain: Chain, drive: Drive, state: Array) -> Array:
    if drive.commands is None:
        return np.zeros(len(chain.thrusters))
    return thruster_forces(chain.thrusters, state[13 + 2 * chain.count :], drive.commands, chain.density)


def _trajectory(
    chain: Chain, manoeuvre: Manoeuvre, flow: Flow, time: Array, rows: Array, control: Array, phase: NDArray[np.int64], thrusts: Array,
    ended: Ended, why: str,
) -> Trajectory:  # fmt: skip
    n = chain.count
    q, rates, torques = rows[:, 7 : 7 + n], rows[:, 13 + n : 13 + 2 * n], control[:, 6:]
    axes = rotations(rows[:, 3:7])
    through = rows[:, 7 + n : 13 + n].copy()
    water = flow.velocity + time[:, None] * flow.acceleration
    through[:, :3] -= np.einsum("kji,kj->ki", axes, water)
    columns: dict[str, Array] = {}
    outside = {}
    for k, joint in enumerate(chain.joints):
        unit, effort = ("rad", "N m") if joint.turns else ("m", "N")
        columns[f"{joint.name} [{unit}]"] = q[:, k]
        columns[f"{joint.name}.rate [{unit}/s]"] = rates[:, k]
        columns[f"{joint.name}.{'torque' if joint.turns else 'force'} [{effort}]"] = torques[:, k]
        outside[f"{joint.name} quicker than its drive"] = np.abs(rates[:, k]) > joint.fastest
        outside[f"{joint.name} stronger than its drive"] = np.abs(torques[:, k]) > joint.strongest
    for k, name in enumerate(("X", "Y", "Z", "K", "M", "N")):
        columns[f"{name}.vehicle [{'N' if k < 3 else 'N m'}]"] = control[:, k]
    for k, thruster in enumerate(chain.thrusters):
        columns[f"{thruster.name} [N]"] = thrusts[:, k]
    ends = np.array([kane.end_in_earth(chain, row) for row in rows])
    for k, name in enumerate(("north", "east", "down")):
        columns[f"end.{name} [m]"] = ends[:, k]
    ahead = axes[:, :, 0]
    heading = np.unwrap(np.arctan2(ahead[:, 1], ahead[:, 0]))
    statements = list(chain.assumed) + [
        f"{name}, for {float(np.mean(flags)):.1%} of the rows." for name, flags in outside.items() if flags.any()
    ]
    return Trajectory(
        time=time,
        position=rows[:, :3],
        attitude=rows[:, 3:7],
        velocity=through,
        heading=heading - heading[0],
        controls=columns,
        phase=phase,
        phases=tuple(p.name for p in manoeuvre.phases),
        reached=tuple(None for _ in manoeuvre.phases),
        outside=outside,
        ended=ended,
        why=why,
        statements=tuple(statements),
    )

"""The model in time: energy of free and driven motions, computed torque and station keeping."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache

import numpy as np

from coeflab.arm import figures as arm
from coeflab.arm import kane
from coeflab.arm.chain import Chain, Flow, in_frame_0
from coeflab.arm.control import ControlledRun, Controller, Station, controlled, wanted_accelerations
from coeflab.arm.motion import at_rest, equations_of, track_of_end, track_to
from coeflab.arm.thrusters import thruster_matrix
from coeflab.core.types import Array
from coeflab.motion.dynamics import rotations
from coeflab.published.publication import Row, publication
from coeflab.published.urv import model
from coeflab.published.urv.model import dry, wet
from coeflab.published.urv.theory import SPEEDS, Q
from coeflab.report.acceptance import ComparedTable
from coeflab.report.document import Figure

PAPER = publication("urv")

CONSERVED, BALANCED = 1e-8, 1e-6
LASTS, RELATIVE = 5.0, 1e-9

# ---- motions in time -----------------------------------------------------------------------------------------------


def energy() -> ComparedTable:
    """Free motion, and motion with drag and torques: energy and momentum after five seconds."""
    rows = []
    for words, chain in (("free, without water", dry()), ("free, with added mass", _ideal(wet()))):
        start, end, _ = _motion(chain, lambda _: np.zeros(9))
        apart = _kinetic(chain, end) / _kinetic(chain, start) - 1.0
        rows.append(Row.none(f"{words}, {LASTS:g} s", "change of kinetic energy over itself", "1", apart, CONSERVED))
        if chain is dry():
            gone = _momentum(chain, end) - _momentum(chain, start)
            rows.append(Row.none(f"{words}, {LASTS:g} s", "change of momentum", "N s, N m s", gone, 1e-7))
    start, end, work = _motion(wet(), _driven)
    gained = _kinetic(wet(), end) - _kinetic(wet(), start)
    apart = (gained - work) / max(abs(gained), abs(work))
    case = f"with drag and torques, {LASTS:g} s"
    rows.append(Row.none(case, "energy gained less work, over the larger", "1", apart, BALANCED))
    return PAPER.table("energy", rows, work=work, gained=gained)


def _ideal(chain: Chain) -> Chain:
    """The same in a fluid without drag."""
    links = tuple(replace(link, strips=()) for link in chain.links)
    return replace(chain, base=replace(chain.base, drag_area=np.zeros(3)), links=links)


def _driven(time: float) -> Array:
    """Control of the motion with torques, N and N m."""
    wave = np.sin(2.0 * time)
    return np.array([20.0, -10.0, 5.0 * wave, 3.0, 0.0, 5.0, 4.0 * wave, -6.0, 0.3 * wave])


def _motion(chain: Chain, control: Callable[[float], Array]) -> tuple[Array, Array, float]:
    """States before and after, and the work of drag and control, J; weight and buoyancy cancel in water, and are left out in air."""
    from scipy.integrate import solve_ivp

    weightless = replace(chain, gravity=0.0)
    start = np.concatenate([np.zeros(3), [1.0, 0.0, 0.0, 0.0], Q, in_frame_0(chain, SPEEDS), [0.0]])

    equations = equations_of(weightless)

    def rates(time: float, state: Array) -> Array:
        pushed, q, speeds = control(time), state[7:10], state[10:19]
        mass, force = equations(state, Flow())
        power = float((pushed + kane.drag(weightless, q, speeds)) @ speeds)
        return np.concatenate([kane.displacement_rates(3, state), np.linalg.solve(mass, force + pushed), [power]])

    found = solve_ivp(rates, (0.0, LASTS), start, method="DOP853", rtol=RELATIVE, atol=0.1 * RELATIVE)
    end = found.y[:, -1]
    return start[:19], end[:19], float(end[19])


def _kinetic(chain: Chain, state: Array) -> float:
    return float(0.5 * state[10:] @ kane.mass_matrix(chain, state[7:10]) @ state[10:])


def _momentum(chain: Chain, state: Array) -> Array:
    """(6,) linear and angular momentum about the earth's origin, along its axes."""
    own = (kane.mass_matrix(chain, state[7:10]) @ state[10:])[:6]
    turn = rotations(state[None, 3:7])[0]
    linear = turn @ own[:3]
    return np.concatenate([linear, turn @ own[3:] + np.cross(state[:3], linear)])


# ---- under control -------------------------------------------------------------------------------------------------

AIM = np.array([-0.6, -1.4, 1.2])
BEGINS, ENDS, TASK = 1.0, 5.0, 8.0
BENT = np.array([0.3, -1.0, 1.6])  # where the track of the end effector begins
REACH = np.array([0.0, 0.25, 0.1])  # how far it goes, FRD
OFFSET, CURRENT = np.array([0.2, -0.1, 0.3]), np.array([0.3, 0.1, 0.0])
ASIDE, SPIN = np.array([0.1, -0.1, 0.1]), np.array([0.3, -0.2, 0.6])


def at_once() -> dict[str, ControlledRun]:
    """Runs whose thrusters give what is asked for at once, where theory knows the errors."""
    chain = wet()
    ideal = replace(chain, thrusters=tuple(replace(t, model=None) for t in chain.thrusters))
    heavy = replace(ideal, base=replace(ideal.base, volume=0.9 * ideal.base.volume))
    track = track_to(chain, chain.home, AIM, BEGINS, ENDS)
    still = track_to(chain, chain.home, chain.home, BEGINS, ENDS)
    start = at_rest(chain, chain.home + ASIDE, np.concatenate([np.zeros(3), SPIN]))
    start[:3] = OFFSET
    law, blind, simple = Controller(), Controller(knows_current=False), Controller("station")
    return {
        "offset": controlled(ideal, law, track, TASK, start=start, rows=0.1),
        "ideal": controlled(ideal, law, track, TASK, rows=0.1),
        "current": controlled(ideal, blind, still, 2.5 * TASK, flow=Flow(CURRENT), rows=0.5),
        "heavy": controlled(heavy, simple, still, 0.01, rows=0.01),
    }


@cache
def tasks() -> dict[str, ControlledRun]:
    """Runs under control, by name."""
    chain = wet()
    volted = replace(chain, thrusters=tuple(replace(t, model=model.VOLTAGE) for t in chain.thrusters))
    track = track_to(chain, chain.home, AIM, BEGINS, ENDS)
    straight = track_of_end(chain, BENT, kane.pose(chain, BENT).end + REACH, BEGINS, ENDS)
    law = Controller()
    return at_once() | {
        "torque": controlled(chain, law, track, TASK),
        "voltage": controlled(volted, law, track, TASK),
        "station": controlled(chain, Controller("station"), track, TASK),
        "end": controlled(chain, law, straight, TASK),
    }


def control(runs: dict[str, ControlledRun]) -> ComparedTable:
    """What the runs under control do, and what their law says that they do."""
    offset, law, heavy, pushed = runs["offset"], Controller(), runs["heavy"], runs["current"]
    fades = _fading(law.vehicle_frequency, offset.time, float(np.linalg.norm(OFFSET)))
    joints = ASIDE * _fading(law.joint_frequency, offset.time, 1.0)[:, None]
    mass, towed = kane.equations(pushed.chain, pushed.state[-1], Flow(CURRENT))
    steady = np.linalg.solve(mass, towed)[:3] / law.vehicle_frequency**2
    turned, angle = at_rest(wet()), 0.3
    turned[3:7] = np.cos(angle / 2.0), 0.0, 0.0, np.sin(angle / 2.0)
    still = track_to(wet(), wet().home, wet().home, BEGINS, ENDS)
    asked = wanted_accelerations(Controller(vehicle_frequency=1.5), Station(), still, 3, 0.0, turned)
    other = wanted_accelerations(
        Controller(vehicle_frequency=1.5), Station(attitude=-turned[3:7] * [1.0, 1.0, 1.0, -1.0]), still, 3, 0.0, turned
    )
    excess = (heavy.chain.base.mass - heavy.chain.density * heavy.chain.base.volume) * heavy.chain.gravity
    lifted = thruster_matrix(heavy.chain.thrusters) @ heavy.ordered[0]
    case, moving = "computed torque, thrusters at once", "computed torque, thrusters at once, joints move"
    rows = [
        Row.none(f"{case}, 0.37 m off and turning", "distance apart from e_0 (1 + w t) exp(-w t)", "m", offset.apart - fades, 1e-5),
        Row.none(f"{case}, joints 0.1 rad off", "error apart from e_0 (1 + w t) exp(-w t)", "rad", offset.q - offset.wanted - joints, 1e-3),
        Row(f"turned by {angle:g} rad", "angular acceleration asked for", "rad/s^2", -2.0 * 1.5**2 * np.sin(angle / 2.0), float(asked[5]), 1e-9),
        Row(f"turned by {2.0 * angle:g} rad, the other quaternion", "angular acceleration asked for", "rad/s^2", -2.0 * 1.5**2 * np.sin(angle), float(other[5]), 1e-9),
        Row.none(moving, "distance from the station", "m", runs["ideal"].apart, 1e-6),
        Row.none(moving, "end effector from its track", "m", runs["ideal"].end_apart, 1e-4),
        Row("computed torque that does not know the current", "distance that stays", "m", float(np.linalg.norm(steady)), float(pushed.apart[-1]), 1e-4),
        Row("station keeping of a heavy vehicle", "force down that is asked for", "N", -excess, float(lifted[2]), 1e-9),
    ]  # fmt: skip
    words = [
        PAPER.text(
            "run", title=title, apart=1e3 * float(run.apart.max()), turned=np.degrees(float(run.turned.max())),
            end=1e3 * float(run.end_apart.max()), thrust=float(np.abs(run.thrust).max()), torque=float(np.abs(run.torque).max()),
            status="; ".join(run.status) or PAPER.text("no_limit"),
        )
        for name, title in PAPER.content["runs"].items()
        if (run := runs.get(name)) is not None
    ]  # fmt: skip
    return PAPER.table("control", rows, words=words)


def _fading(pace: float, time: Array, error: float) -> Array:
    """An error under critical damping that begins at rest."""
    return np.asarray(error * (1.0 + pace * time) * np.exp(-pace * time))


def figures() -> Iterator[tuple[str, Figure]]:
    """Our pictures: of the paper's only figure, and of the runs under control."""
    runs = tasks()
    end, selected = runs["end"], runs["torque"]
    hull, w = model.hull(), PAPER.words
    at_rest = arm.ArmMotion(end.chain, hull, selected.time[:1], selected.state[:1])
    yield "urv_frames", arm.frames_figure(at_rest, *w("urv-frames"))
    moved = arm.ArmMotion(end.chain, hull, end.time, end.state)
    yield "urv_poses", arm.poses_figure(moved, *w("urv-poses"))
    yield "urv_path", arm.path_figure(end.end, end.end_wanted, *w("urv-path"))
    yield "urv_joints", arm.joints_figure(selected, *w("urv-joints"))
    named = {"torque-driven thrusters": "torque", "voltage-driven thrusters": "voltage", "station keeping": "station"}
    yield "urv_station", arm.station_figure([(label, runs[name]) for label, name in named.items()], *w("urv-station"))
    yield "urv_thrust", arm.thrust_figure(selected, *w("urv-thrust"))


def page() -> bytes:
    """The straight line of the end effector, as a page that plays it."""
    run = tasks()["end"]
    words = PAPER.text("page", reach=float(np.linalg.norm(REACH)))
    return arm.animation(arm.ArmMotion(run.chain, model.hull(), run.time, run.state), PAPER.text("page_title"), words)

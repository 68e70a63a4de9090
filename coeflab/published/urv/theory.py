"""The model beside theory: Hamel's equations, changes of observer, drag, thrusters and the earth transformation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coeflab.arm import kane
from coeflab.arm.chain import FLU, Chain, in_frame_0
from coeflab.arm.control import demand, gain_of, most_thrust
from coeflab.arm.thrusters import (
    BLADE,
    Thruster,
    TorqueThruster,
    VoltageThruster,
    thrust_allocation,
    thruster_matrix,
)
from coeflab.core.types import Array
from coeflab.law.rigid_body import axes_in_earth, kinematics
from coeflab.law.transforms import rotation
from coeflab.motion.dynamics import from_euler, rotations
from coeflab.published.publication import Row, publication
from coeflab.published.urv import model
from coeflab.published.urv.model import DENSITY, dry, wet
from coeflab.report.acceptance import ComparedTable

PAPER = publication("urv")

# The state that the reference numbers are for: joints, and speeds along frame 0 (x forward, y left, z up).
Q = np.array([0.3, -0.7, 0.5])
SPEEDS = np.array([0.5, -0.2, 0.1, 0.05, -0.1, 0.2, 0.4, -0.3, 0.6])
RATES = np.array([0.3, 0.1, -0.2, 0.15, -0.05, 0.25, -0.4, 0.7, 0.2])
SECOND = 1e-7
STEP = 1e-4
SWING = {"radius": 0.05, "length": 0.8, "rate": 1.3}


# ---- theory --------------------------------------------------------------------------------------------------------


def mass_slopes(chain: Chain, q: Array) -> Array:
    """(n, 6 + n, 6 + n) slopes of M over the joints, by central differences with one extrapolation."""
    out = []
    for k in range(chain.count):
        ahead = np.eye(chain.count)[k] * STEP

        def slope(step: Array) -> Array:
            return (kane.mass_matrix(chain, q + step) - kane.mass_matrix(chain, q - step)) / (2.0 * float(step.sum()))

        out.append((4.0 * slope(ahead) - slope(2.0 * ahead)) / 3.0)
    return np.array(out)


def hamel_bias(chain: Chain, q: Array, speeds: Array) -> Array:
    """C by Hamel's equations from M alone: momenta of the whole in moving axes, and Lagrange's of the joints."""
    slopes, momentum = mass_slopes(chain, q), kane.mass_matrix(chain, q) @ speeds
    out = np.einsum("k,kij,j->i", speeds[6:], slopes, speeds)
    v, w, p, h = speeds[:3], speeds[3:6], momentum[:3], momentum[3:6]
    out[:3] += np.cross(w, p)
    out[3:6] += np.cross(w, h) + np.cross(v, p)
    out[6:] -= 0.5 * np.einsum("i,kij,j->k", speeds, slopes, speeds)
    return np.asarray(out)


def principles() -> ComparedTable:
    """M, C and the generalised forces by principles other than Kane's."""
    rows = []
    for words, chain in (("without water", dry()), ("with added mass", wet()), ("with a sliding joint", _sliding())):
        speeds = in_frame_0(chain, SPEEDS)
        bias = kane.bias(chain, Q, speeds)
        rows.append(
            Row.none(words, "C apart from Hamel's equations", "N, N m", bias - hamel_bias(chain, Q, speeds), SECOND)
        )
        rows.append(Row.none(words, "power from nothing", "W", from_nothing(chain, Q, speeds, bias), SECOND))
        found, step = kane.partial_velocities(chain, kane.pose(chain, Q)), 1e-6
        apart = _position_slopes(chain, step) - found[:, :3, 6:]
        rows.append(Row.none(words, "partial velocities apart from slopes of p", "1, m", apart, 1e-8))
    water = wet()
    down = FLU @ np.array([0.3, -0.4, np.sqrt(0.75)])
    lifted = kane.weight(water, Q, down) + kane.buoyancy(water, Q, down)
    rows.append(Row.none("buoyancy equal to the weight", "force left", "N, N m", lifted, 1e-9))
    pulled, step = kane.weight(water, Q, down), 1e-6
    slopes = [
        (_height(water, Q + step * np.eye(3)[k], down) - _height(water, Q - step * np.eye(3)[k], down)) / (2.0 * step)
        for k in range(3)
    ]
    rows.append(
        Row.none(
            "weight of the joints", "apart from the slope of its energy", "N m", pulled[6:] - np.array(slopes), 1e-6
        )
    )
    return PAPER.table("theory", rows)


def _sliding() -> Chain:
    chain = wet()
    joint = replace(chain.links[1].joint, kind="prismatic", theta=0.4)
    return replace(chain, links=(chain.links[0], replace(chain.links[1], joint=joint), chain.links[2]))


def _position_slopes(chain: Chain, step: float) -> Array:
    """(n + 1, 3, n) slopes of the centres of mass over the joints."""
    columns = []
    for k in range(chain.count):
        moved_ = step * np.eye(chain.count)[k]
        columns.append((kane.pose(chain, Q + moved_).centre - kane.pose(chain, Q - moved_).centre) / (2.0 * step))
    return np.moveaxis(np.array(columns), 0, 2)


def _height(chain: Chain, q: Array, down: Array) -> float:
    """Minus the energy of the weight, J."""
    masses = chain.inertias[0][:, 0, 0]
    return float(chain.gravity * masses @ (kane.pose(chain, q).centre @ down))


def flow() -> ComparedTable:
    """What a current and water that accelerates do, by a change of observer."""
    chain = wet()
    speeds = in_frame_0(chain, SPEEDS)
    current = FLU @ np.array([0.3, -0.15, 0.2])
    mass, w = kane.mass_matrix(chain, Q), speeds[3:6]
    alongside = np.concatenate([speeds[:3] - current, speeds[3:]])
    carried = kane.bias(chain, Q, alongside) + mass[:, :3] @ np.cross(w, current)
    apart = kane.bias(chain, Q, speeds, current) - carried
    adrift = kane.drag(chain, Q, np.concatenate([current, np.zeros(6)]), current)
    rows = [
        Row.none("steady current", "C apart from that seen by one who drifts", "N, N m", apart, 1e-9),
        Row.none("adrift with the current", "drag", "N, N m", adrift),
    ]
    gust = FLU @ np.array([0.4, -0.3, 0.2])
    still = np.zeros(9)
    pushed = kane.fluid_acceleration(chain, Q, gust) - kane.bias(chain, Q, still, acceleration=gust)
    rows.append(
        Row.none("neutral, in water that accelerates", "acceleration apart from the water's", "m/s^2, rad/s^2",
              np.linalg.solve(mass, pushed) - np.concatenate([gust, np.zeros(6)]), 1e-9)
    )  # fmt: skip
    return PAPER.table("flow", rows)


def drag() -> ComparedTable:
    """Cylinders and the vehicle in closed form."""
    rate, length = SWING["rate"], SWING["length"]
    chain = model.swung(SWING["radius"], length)
    speeds = np.zeros(7)
    speeds[6] = rate
    push = kane.drag(chain, np.zeros(1), speeds)
    unit = 0.5 * DENSITY * model.BASIC * 2.0 * SWING["radius"]
    rows = [
        Row("swung about its end", "power lost", "W", unit * rate**3 * length**4 / 4.0, -float(push @ speeds), 1e-9),
        Row(
            "swung about its end", "moment at the joint", "N m", -unit * rate**2 * length**4 / 4.0, float(push[6]), 1e-9
        ),
        Row(
            "swung about its end",
            "force on the vehicle",
            "N",
            unit * rate**2 * length**3 / 3.0,
            float(np.linalg.norm(push[:3])),
            1e-9,
        ),
    ]
    rows.append(Row.none("link, towed along its axis", "drag", "N", towed(chain, np.array([0.7, 0.0, 0.0]))))
    alone = replace(wet(), links=())
    astern = np.array([-0.6, 0.3, 0.2, 0.0, 0.0, 0.0])
    whole = float(np.linalg.norm(astern[:3]))
    rows.append(
        Row.none("vehicle, astern", "drag apart from -1/2 C_D rho S |v| v", "N",
              kane.drag(alone, np.zeros(0), astern)[:3] + 0.5 * DENSITY * model.AREA * whole * astern[:3], 1e-9)
    )  # fmt: skip
    return PAPER.table("drag", rows, radius=SWING["radius"], length=length, rate=rate, drag=model.BASIC)


def propulsion() -> ComparedTable:
    """Both models where theory knows them, and the matrix from thrusts to the vehicle."""
    one, two = model.TORQUE, model.VOLTAGE
    torque, after = 2.0, 0.15
    fastest = np.sqrt(one.beta * torque / one.alpha)
    turning = _spun(one, torque, after)
    expected = fastest * np.tanh(np.sqrt(one.alpha * one.beta * torque) * after)
    rows = [
        Row(f"torque model, {torque:g} N m for {after:g} s", "speed", "rad/s", float(expected), float(turning[0]), 1e-6),
        Row(f"torque model, {torque:g} N m", "thrust where it turns steadily", "N", float(one.thrust * one.beta * torque / one.alpha),
              one.force(np.array([fastest]), DENSITY), 1e-9),
    ]  # fmt: skip
    volts, state = two.steady(30.0, DENSITY)
    area = np.pi * two.radius**2
    theta = float(np.arctan2(state[1], BLADE * two.radius * state[0]))
    size = 0.5 * DENSITY * area * ((BLADE * two.radius * state[0]) ** 2 + state[1] ** 2)
    twice = 2.0 * (two.pitch - theta)
    lift, dragged = size * two.lift * np.sin(twice), size * two.drag * (1.0 - np.cos(twice))
    resisting = BLADE * two.radius * (lift * np.sin(theta) + dragged * np.cos(theta))
    settled = _spun(two, volts, 60.0)
    rows += [
        Row("voltage model, 30 N", "thrust of its blades", "N", 30.0, float(lift * np.cos(theta) - dragged * np.sin(theta)), 1e-6),
        Row("voltage model, 30 N", "momentum of its jet, rho A delta v_p^2", "N", 30.0, float(DENSITY * area * two.momentum * state[1] ** 2), 1e-6),
        Row.none("voltage model, 30 N", "torque left: drive, friction, blades", "rad/s^2",
              two.drive * volts - two.damping * state[0] - two.load * resisting, 1e-6),
        Row("voltage model, after 60 s", "speed", "rad/s", float(state[0]), float(settled[0]), 1e-4),
        Row("voltage model, after 60 s", "thrust", "N", 30.0, two.force(settled, DENSITY), 1e-4),
        Row("voltage model, astern", "thrust", "N", -30.0, two.force(-state, DENSITY), 1e-6),
        Row("voltage model, started at rest", "rate of speed by 1 V", "rad/s^2", model.VOLTAGE_DRIVE, float(two.rates(np.zeros(2), 1.0, DENSITY)[0])),
        Row("voltage model, jet at 1 m/s, blades still", "rate of the jet", "m/s^2", *_slowing(two), 1e-9),
    ]  # fmt: skip
    first, bound = (Thruster("thruster", np.zeros(3), np.eye(3)[0], kind) for kind in (one, two))
    power = demand(first, gain_of(first, DENSITY), 30.0, one.steady(30.0, DENSITY)[1], 10.0, DENSITY)
    starting = demand(first, gain_of(first, DENSITY), 1.0, np.zeros(1), 10.0, DENSITY)
    rows += [
        Row("torque model, controller at 30 N", "torque that holds it", "N m", one.steady(30.0, DENSITY)[0], power, 1e-3),
        Row("torque model, controller from rest to 1 N", "torque at 10 1/s", "N m", float(10.0 * np.sqrt(1.0 / one.thrust) / one.beta), starting, 2e-3),
        Row("torque model, 5 N m", "largest thrust", "N", 100.0, most_thrust(first, gain_of(first, DENSITY), DENSITY), 1e-9),
        Row("voltage model, 48 V", "voltage of the largest thrust", "V", two.strongest,
             two.steady(most_thrust(bound, gain_of(bound, DENSITY), DENSITY), DENSITY)[0], 1e-6),
        Row("voltage model, controller at 30 N", "voltage that holds it", "V", volts, demand(bound, gain_of(bound, DENSITY), 30.0, state, 10.0, DENSITY), 1e-3),
    ]  # fmt: skip
    thrusters = wet().thrusters
    thrusts = np.arange(1.0, len(thrusters) + 1.0)
    pushes = [t * one_.axis for t, one_ in zip(thrusts, thrusters, strict=True)]
    summed = np.concatenate([sum(pushes), sum(np.cross(t.place, f) for t, f in zip(thrusters, pushes, strict=True))])
    apart = thruster_matrix(thrusters) @ thrusts - summed
    rows.append(Row.none("thruster matrix", "force and moment apart from the sum", "N, N m", apart))
    wanted = np.array([5.0, -3.0, 2.0, 1.0, -4.0, 6.0])
    given = thruster_matrix(thrusters) @ (thrust_allocation(thrusters) @ wanted)
    rows.append(
        Row.none("pseudo-inverse", "force and moment apart from what is wanted", "N, N m", given - wanted, 1e-9)
    )
    return PAPER.table("thrusters", rows)


def _spun(thruster: TorqueThruster | VoltageThruster, command: float, lasts: float) -> Array:
    """State of a thruster after a constant command from rest."""
    from scipy.integrate import solve_ivp

    start = np.zeros(thruster.order)
    found = solve_ivp(
        lambda _, s: thruster.rates(s, command, DENSITY), (0.0, lasts), start, method="LSODA", rtol=1e-9, atol=1e-10
    )
    return np.asarray(found.y[:, -1])


def _slowing(thruster: VoltageThruster) -> tuple[float, float]:
    """Rate of the water through blades that stand still, by drag of the blades and momentum: theory and found."""
    incidence = thruster.pitch - np.pi / 2.0
    lift, dragged = thruster.lift * np.sin(2.0 * incidence), thruster.drag * (1.0 - np.cos(2.0 * incidence))
    theory = (-0.5 * dragged + 0.0 * lift - thruster.momentum) / thruster.column
    return float(theory), float(thruster.rates(np.array([0.0, 1.0]), 0.0, DENSITY)[1])


def earth() -> ComparedTable:
    """Equations 26 to 29 as corrected."""
    angles, w, step = np.array([0.4, -0.5, 1.1]), np.array([0.3, -0.2, 0.25]), 1e-6
    rates = model.euler_rates(angles, w)
    ahead, behind = (rotation(*(angles + side * step * rates)) for side in (1.0, -1.0))
    slope = rotation(*angles).T @ (ahead - behind) / (2.0 * step)
    turned = np.array([slope[2, 1], slope[0, 2], slope[1, 0]])
    quaternion = from_euler(*angles)
    moved_ = np.array(kinematics(axes_in_earth(*quaternion), *quaternion, *np.zeros(3), *w)[3:7])
    by_angles = (from_euler(*(angles + step * rates)) - from_euler(*(angles - step * rates))) / (2.0 * step)
    turn = model.turn_by_paper(angles) - rotations(quaternion[None])[0]
    end = _end_by_matrices(angles) - _end(angles)
    rows = (
        Row.none("equation 28", "apart from the turn of the equations", "1", turn),
        Row.none("equation 29", "w apart from the slope of the turn", "rad/s", turned - w, 1e-8),
        Row.none("equations 26 and 27", "end effector apart from 4 x 4 matrices", "m", end, 1e-9),
        Row.none("quaternion", "rate apart from that of the angles", "1/s", moved_ - by_angles, 1e-8),
    )
    return PAPER.table("earth", rows)


def _end(angles: Array) -> Array:
    state = np.concatenate([[2.0, -1.0, 5.0], from_euler(*angles), Q, np.zeros(9)])
    return kane.end_in_earth(wet(), state)


def _end_by_matrices(angles: Array) -> Array:
    """(3,) equation 27 with the paper's matrices and the missing diag(1, -1, -1)."""
    whole = np.eye(4)
    for one in model.printed_matrices(Q):
        whole = whole @ one
    in_0 = np.asarray(model.ATTACHMENT) + (whole @ [*wet().tool, 1.0])[:3]
    return np.asarray(np.array([2.0, -1.0, 5.0]) + model.turn_by_paper(angles) @ FLU @ in_0)


def from_nothing(chain: Chain, q: Array, speeds: Array, bias: Array) -> float:
    """Power, W, that the kinetic energy gains while no force acts: 1/2 s M' s - s C."""
    changing = np.einsum("k,i,kij,j->", speeds[6:], speeds, mass_slopes(chain, q), speeds)
    return float(0.5 * changing - speeds @ bias)


def motion_of_link_1(chain: Chain, rates: Array) -> tuple[Array, Array]:
    """Acceleration of link 1's centre of mass and of its turning, from the equations of motion of a unit mass and sphere."""
    link = replace(chain.links[0], mass=1.0, inertia=np.eye(3))
    alone = replace(chain, links=(link,))
    speeds = SPEEDS[:7]
    force = in_frame_0(alone, kane.mass_matrix(alone, Q[:1]) @ in_frame_0(alone, rates))
    force = force + in_frame_0(alone, kane.bias(alone, Q[:1], in_frame_0(alone, speeds)))
    v, w = speeds[:3], speeds[3:6]
    base = alone.base
    push = force[:3] - base.mass * (rates[:3] + np.cross(w, v))
    at = FLU @ kane.pose(alone, Q[:1]).centre[1]
    turned = force[3:6] - np.cross(at, push) - base.inertia @ rates[3:6] - np.cross(w, base.inertia @ w)
    return push, turned


def only(index: int, value: float, size: int) -> Array:
    """One entry that is not zero."""
    out = np.zeros(size)
    out[index] = value
    return out


def towed(chain: Chain, velocity: Array) -> Array:
    """(3,) drag along frame 0 of a chain of one link, towed at a velocity along frame 0."""
    speeds = np.concatenate([velocity, np.zeros(4)])
    return np.asarray(in_frame_0(chain, kane.drag(chain, np.zeros(1), in_frame_0(chain, speeds)))[:3])

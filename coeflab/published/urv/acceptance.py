"""URV with an arm by Kane's method: printed expressions, independent numbers, energy and power, errata as numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from coeflab.bodies.closed_forms import ellipsoid_added_mass
from coeflab.core.machine import one_thread
from coeflab.core.types import Array
from coeflab.law.rigid_body import axes_in_earth, kinematics
from coeflab.law.transforms import denavit_hartenberg, rotation
from coeflab.motion.dynamics import from_euler, rotations
from coeflab.motion.multibody import kane
from coeflab.motion.multibody.chain import FLU, Chain, Flow, in_frame_0
from coeflab.motion.multibody.control import ControlledRun, Controller, controlled
from coeflab.motion.multibody.motion import at_rest, equations_of, track_of_end, track_to
from coeflab.motion.multibody.thrusters import (
    BLADE,
    TorqueThruster,
    VoltageThruster,
    require_all_directions,
    thruster_matrix,
)
from coeflab.published.urv import model
from coeflab.published.urv.model import DENSITY, cylinder, dry, wet
from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable

# The state that the reference numbers are for: joints, and speeds along frame 0 (x forward, y left, z up).
Q = np.array([0.3, -0.7, 0.5])
SPEEDS = np.array([0.5, -0.2, 0.1, 0.05, -0.1, 0.2, 0.4, -0.3, 0.6])
RATES = np.array([0.3, 0.1, -0.2, 0.15, -0.05, 0.25, -0.4, 0.7, 0.2])
# Worked out independently for this state, with Pinocchio's to 1e-15 where there is no water.
MASS = (140.34, 140.34, 140.34, 16.111558, 37.02878, 39.383375, 2.703695, 2.226111, 0.075579)
FIRST_ROW = (0.0, 0.0, 0.0, 6.876421, -6.654255, -6.654255, 2.684943, 0.018592)
BIAS = (2.432883, 9.523231, 4.707274, 0.635088, -0.843423, -0.178441, -0.140057, -0.310209, 0.002126)
ADDED = (128.810058, 538.986349, 515.812717, 2.61593, 60.882072, 65.821531, 0.769471, 0.426749, 0.052083)
SPHEROID = {"A11/m": (0.1563, 0.2335), "A22/m": (0.7619, 0.6816), "A55/m": (0.0847, 0.0517)}  # corrected, printed
SPEED_NAMES = ("v_x", "v_y", "v_z", "w_x", "w_y", "w_z", "q1", "q2", "q3")
DIGITS, FOUR_DIGITS = 5.1e-7, 5.1e-5  # half of the last digit of the numbers above
EXACT, SECOND, CONSERVED, BALANCED = 1e-11, 1e-7, 1e-8, 1e-6
FINEST, PLACES = 0.1, 12  # of the tolerance, and decimals: no finer than that, so that every machine says the same
STEP = 1e-4
NO_WATER = np.zeros((6, 6))
LASTS, RELATIVE = 5.0, 1e-9
SWING = {"radius": 0.05, "length": 0.8, "rate": 1.3}

ERRATA = (
    "Section 4.5, spheroid: e = 1 - (b/a)^2 stands for e^2 = 1 - (b/a)^2.",
    "Section 4.5, added mass: the entries of I_A are printed negative; equation 15 needs them positive.",
    "Section 4.5, cylinder: k = rho pi r^2 L; the printed /4 holds for a diameter. About its centre, where the equations take it, the "
    "turning entry is k L^2/12; the printed k L^2/3 is about an end.",
    "Equations 15 to 17: equation 15 holds in frame j, where the rate of w_j is alpha_j: T = -D alpha - w_j x D w_j - v_j x A v_j. The "
    "printed term D (w_0 x w_j) makes power from nothing for j >= 1.",
    "Equation 21: the moment must be about the centre of mass, where the force acts; the printed one is about the end at l = 0. And "
    "C_D = C_basic sin^2(sigma) counts the angle twice beside the velocity across.",
    "Equation 23: a joint torque acts on both links; the generalised force is tau_j on the rate of joint j alone. The printed sum "
    "leaves out the reaction on the link before, and so turns the vehicle.",
    "Equation 28 maps from z down, but frame 0 has y left and z up: diag(1, -1, -1) is missing. Equation 29, row 2: cos(phi) stands for "
    "cos(theta). Equation 9: the rate of theta_1 stands for that of theta_z. Section 4.5: -1/2 C_D rho v^2 S has no sign; -1/2 C_D rho S |v| v.",
    "Section 4.5: the added mass of a link lies along z, its drag along x; each link has its own axis here.",
    "Section 4.2, a of link 1: brackets are lost, so that w x v is not whole; in the y component they do not balance.",
)  # fmt: skip
CONVENTIONS = (
    "Frame 0 of the paper: x forward, y left, z up, at the vehicle's attachment point. Numbers here are in frame 0; the code "
    "computes in FRD, and the turn diag(1, -1, -1) is its own inverse.",
    "Generalised speeds: v_x v_y v_z w_x w_y w_z of the vehicle along frame 0, v of its centre of mass, then the rates of the joints.",
    "M s' + C = F: C is the paper's C; gravity, buoyancy, fluid acceleration, drag and control are in F.",
    "Denavit-Hartenberg rows are distal: Rz(theta) Tz(d) Tx(a) Rx(alpha).",
)
CHOSEN = (
    "The paper prints no motion and no result of its model: it prints expressions of link 1, and the inputs. What it prints of "
    "link 1 and of gravity is recomputed; everything else is compared with numbers worked out independently or with theory.",
    "Chosen, not printed: mass and inertia of the vehicle, c_0, the semi-axes of the spheroid, the cylinders of the links, "
    "thrusters, gains and tasks.",
    "The 3-link example has no hydrodynamic number in the paper beside C_D = 1.1 of a cylinder.",
)


@one_thread()
def acceptance() -> Acceptance:
    """Everything that the paper prints, its errata, and what theory says of the model."""
    return Acceptance(
        "urv",
        "URV with an arm: Kane's equations of a vehicle with links 1 to 3 of a PUMA 560",
        (*compared(), *moved()),
        ERRATA,
        CHOSEN,
        ("urv_kane",),
        (),
        CONVENTIONS,
    )


def compared() -> tuple[ComparedTable, ...]:
    """What needs no motion in time."""
    return (
        _link_1(), _transformations(), _mass_matrix(), _bias(), _added_mass(), _spheroid(), _theory(), _flow(), _drag(), _thrusters(), _earth(), _errata(),
    )  # fmt: skip


def moved() -> tuple[ComparedTable, ...]:
    """Motions in time."""
    return (_energy(), _control(tasks()))


def _same(case: str, quantity: str, unit: str, expected: float, found: float, within: float = EXACT) -> Compared:
    """Theory, or a second way."""
    return Compared(case, quantity, unit, round(expected, PLACES), round(found, PLACES), within, Basis.CONSISTENCY)


def _none(case: str, quantity: str, unit: str, found: Any, within: float = EXACT) -> Compared:
    """Zero by theory; of arrays the largest."""
    return _same(case, quantity, unit, 0.0, max(float(np.max(np.abs(found))), FINEST * within), within)


# ---- what the paper prints -----------------------------------------------------------------------------------------


def _of_link_1(chain: Chain, rates: Array) -> tuple[Array, Array]:
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


def _link_1() -> ComparedTable:
    chain = dry()
    at = kane.pose(chain, Q)
    moving = kane.partial_velocities(chain, at)[1] @ in_frame_0(chain, SPEEDS)
    push, turned = _of_link_1(chain, RATES[:7])
    found = {"p": FLU @ at.centre[1], "w": FLU @ moving[3:], "v": FLU @ moving[:3], "alpha": turned, "a": push}
    units = {"p": "m", "w": "rad/s", "v": "m/s", "alpha": "rad/s^2", "a": "m/s^2"}
    paper = model.link_1_by_paper(float(Q[0]), SPEEDS, RATES)
    rows = [
        Compared(
            "link 1", f"{name}_1, {axis}", units[name], round(float(paper[name][i]), PLACES), round(float(found[name][i]), PLACES), EXACT,
            Basis.CONSISTENCY if name == "a" else Basis.PRINTED,
        )
        for name in paper
        for i, axis in enumerate("xyz")
    ]  # fmt: skip
    down = np.array([0.3, -0.4, np.sqrt(0.75)])
    pulled = in_frame_0(chain, kane.weight(chain, Q, FLU @ down))
    whole = model.VEHICLE_MASS + sum(model.MASSES)
    rows.append(
        Compared(
            "gravity along x", "(F_1)grav", "N", whole * chain.gravity * 0.3, float(pulled[0]), 1e-9, Basis.PRINTED
        )
    )
    return ComparedTable(
        "link_1", "Printed expressions of link 1, and of gravity", tuple(rows), "Sections 4.2 and 4.4",
        (
            "Printed: expressions in q, speeds and rates, evaluated at one state; found: from the Denavit-Hartenberg row by Kane's "
            "equations, the accelerations from M s' + C of a unit mass.",
            "a_1 holds once its brackets are repaired (erratum 9); repaired by us, it counts as a consistency check.",
        ),
    )  # fmt: skip


def _transformations() -> ComparedTable:
    chain, printed = dry(), model.printed_matrices(Q)
    rows, whole = [], np.eye(4)
    at = kane.pose(chain, Q)
    for j, link in enumerate(chain.links):
        joint = link.joint
        turn, shift = denavit_hartenberg(joint.theta + float(Q[j]), joint.d, joint.a, joint.alpha)
        apart = np.abs(np.hstack([turn, shift[:, None]]) - printed[j][:3]).max()
        rows.append(
            Compared(
                f"A_{j}^{j + 1}",
                "largest entry apart",
                "1, m",
                0.0,
                max(float(apart), FINEST * EXACT),
                EXACT,
                Basis.CALIBRATION,
            )
        )
        whole = whole @ printed[j]
        place = whole @ np.append(link.centre_of_mass, 1.0)
        expected = np.asarray(model.ATTACHMENT) + place[:3]
        rows.append(
            _none(f"equation 8, link {j + 1}", "p by 4 x 4 matrices, apart", "m", FLU @ at.centre[j + 1] - expected)
        )
        for name, printed_, held in (
            ("mass", model.MASSES[j], link.mass), ("centre of mass", model.CENTRES[j], link.centre_of_mass),
            ("inertia", model.INERTIAS[j], np.diag(link.inertia)),
        ):  # fmt: skip
            apart = np.max(np.abs(np.asarray(printed_) - held))
            rows.append(
                Compared(
                    f"link {j + 1}",
                    f"{name} of the file, apart",
                    "SI",
                    0.0,
                    max(float(apart), FINEST * EXACT),
                    EXACT,
                    Basis.CALIBRATION,
                )
            )
    rows.append(
        _none(
            "equation 27",
            "end effector by 4 x 4 matrices, apart",
            "m",
            FLU @ at.end - np.asarray(model.ATTACHMENT) - (whole @ [*chain.tool, 1.0])[:3],
        )
    )
    return ComparedTable(
        "transformations", "Denavit-Hartenberg rows, and positions by the printed matrices", tuple(rows),
        "Section 4.2, equations 8 and 27", ("a, d and alpha of the three rows are read from these matrices.",),
    )  # fmt: skip


# ---- numbers worked out independently ------------------------------------------------------------------------------


def _given(case: str, names: tuple[str, ...], numbers: tuple[float, ...], found: Array, unit: str) -> list[Compared]:
    return [
        Compared(f"{case}, {name}", "entry", unit, number, round(float(value), PLACES), DIGITS, Basis.CONSISTENCY)
        for name, number, value in zip(names, numbers, found, strict=True)
    ]


def _mass_matrix() -> ComparedTable:
    chain = dry()
    found = in_frame_0(chain, kane.mass_matrix(chain, Q))
    rows = _given("diagonal", SPEED_NAMES, MASS, np.diag(found), "kg, kg m^2")
    rows += _given("row 1", SPEED_NAMES[1:], FIRST_ROW, found[0, 1:], "kg, kg m")
    rows.append(_none("whole matrix", "asymmetry", "kg, kg m^2", found - found.T))
    return ComparedTable(
        "mass_matrix", "M without water", tuple(rows), "Equations 13 and 25",
        ("Numbers worked out independently, with Pinocchio to 1e-15; the vehicle's mass, inertia and c_0 are chosen.",),
    )  # fmt: skip


def _bias() -> ComparedTable:
    chain = dry()
    found = in_frame_0(chain, kane.bias(chain, Q, in_frame_0(chain, SPEEDS)))
    return ComparedTable(
        "bias", "C without water", tuple(_given("C", SPEED_NAMES, BIAS, found, "N, N m")), "Equations 9 to 13 and 25",
        ("Worked out independently, with Pinocchio to 1e-15.",),
    )  # fmt: skip


def _added_mass() -> ComparedTable:
    air, water = dry(), wet()
    found = in_frame_0(water, kane.mass_matrix(water, Q) - kane.mass_matrix(air, Q))
    return ComparedTable(
        "added_mass", "What the added mass adds to M", tuple(_given("diagonal", SPEED_NAMES, ADDED, np.diag(found), "kg, kg m^2")),
        "Equations 15 to 18 as corrected",
        ("At the centres of mass: spheroid a 1 m, b 0.4 m; cylinders r, L of (0.09, 0.66) m along y, (0.08, 0.43) m along x and "
         "(0.05, 0.43) m along z. Worked out independently; the shapes are chosen.",),
    )  # fmt: skip


def _spheroid() -> ComparedTable:
    a, b = 1.0, 0.4
    displaced = DENSITY * 4.0 / 3.0 * np.pi * a * b**2
    ours = np.diag(ellipsoid_added_mass(np.array([a, b, b]), DENSITY))[[0, 1, 4]] / displaced
    corrected = model.spheroid_by_paper(a, b, printed=False)
    rows = []
    for i, (name, (number, _)) in enumerate(SPHEROID.items()):
        rows.append(_same("e^2 = 1 - (b/a)^2", name, "1", number, corrected[i], FOUR_DIGITS))
        rows.append(_same("closed form by Lamb", f"{name}, apart", "1", corrected[i], float(ours[i]), 1e-12))
    k = DENSITY * np.pi * 0.09**2 * 0.66
    entries = np.diag(cylinder(0.09, 0.66, 1))
    rows += [
        _same("cylinder of link 1", "across", "kg", k, float(entries[0]), 1e-9),
        _same("cylinder of link 1", "along", "kg", 0.0, float(entries[1]), 0.0),
        _same("cylinder of link 1", "turning about its centre", "kg m^2", k * 0.66**2 / 12.0, float(entries[3]), 1e-9),
    ]
    return ComparedTable(
        "spheroid", "Added mass of spheroid and cylinder as corrected", tuple(rows), "Section 4.5",
        ("a 1 m, b 0.4 m; over the mass displaced, A55 for lengths in m.",),
    )  # fmt: skip


# ---- theory --------------------------------------------------------------------------------------------------------


def _slopes(chain: Chain, q: Array) -> Array:
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
    slopes, momentum = _slopes(chain, q), kane.mass_matrix(chain, q) @ speeds
    out = np.einsum("k,kij,j->i", speeds[6:], slopes, speeds)
    v, w, p, h = speeds[:3], speeds[3:6], momentum[:3], momentum[3:6]
    out[:3] += np.cross(w, p)
    out[3:6] += np.cross(w, h) + np.cross(v, p)
    out[6:] -= 0.5 * np.einsum("i,kij,j->k", speeds, slopes, speeds)
    return out


def _theory() -> ComparedTable:
    rows = []
    for said, chain in (("without water", dry()), ("with added mass", wet()), ("with a sliding joint", _sliding())):
        speeds = in_frame_0(chain, SPEEDS)
        bias = kane.bias(chain, Q, speeds)
        rows.append(
            _none(said, "C apart from Hamel's equations", "N, N m", bias - hamel_bias(chain, Q, speeds), SECOND)
        )
        rows.append(_none(said, "power from nothing", "W", _from_nothing(chain, Q, speeds, bias), SECOND))
        found, step = kane.partial_velocities(chain, kane.pose(chain, Q)), 1e-6
        rows.append(
            _none(
                said,
                "partial velocities apart from slopes of p",
                "1, m",
                _position_slopes(chain, step) - found[:, :3, 6:],
                1e-8,
            )
        )
    water = wet()
    down = FLU @ np.array([0.3, -0.4, np.sqrt(0.75)])
    lifted = kane.weight(water, Q, down) + kane.buoyancy(water, Q, down)
    rows.append(_none("buoyancy equal to the weight", "force left", "N, N m", lifted, 1e-9))
    pulled, step = kane.weight(water, Q, down), 1e-6
    slopes = [
        (_height(water, Q + step * np.eye(3)[k], down) - _height(water, Q - step * np.eye(3)[k], down)) / (2.0 * step)
        for k in range(3)
    ]
    rows.append(
        _none("weight of the joints", "apart from the slope of its energy", "N m", pulled[6:] - np.array(slopes), 1e-6)
    )
    return ComparedTable(
        "theory", "The same equations by other principles", tuple(rows), "Equations 3, 4, 10 to 19",
        (
            "Hamel's equations need M alone, by slopes of it; Kane's need accelerations of every body.",
            "Kinetic energy changes by no power of the inertia forces: 1/2 s M' s = s C.",
            "Sliding: joint 2 as a prismatic one, which the paper leaves out.",
        ),
    )  # fmt: skip


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


def _flow() -> ComparedTable:
    chain = wet()
    speeds = in_frame_0(chain, SPEEDS)
    current = FLU @ np.array([0.3, -0.15, 0.2])
    mass, w = kane.mass_matrix(chain, Q), speeds[3:6]
    alongside = np.concatenate([speeds[:3] - current, speeds[3:]])
    carried = kane.bias(chain, Q, alongside) + mass[:, :3] @ np.cross(w, current)
    rows = [
        _none(
            "steady current",
            "C apart from that seen by one who drifts",
            "N, N m",
            kane.bias(chain, Q, speeds, current) - carried,
            1e-9,
        ),
        _none(
            "adrift with the current",
            "drag",
            "N, N m",
            kane.drag(chain, Q, np.concatenate([current, np.zeros(6)]), current),
        ),
    ]
    gust = FLU @ np.array([0.4, -0.3, 0.2])
    still = np.zeros(9)
    pushed = kane.fluid_acceleration(chain, Q, gust) - kane.bias(chain, Q, still, acceleration=gust)
    rows.append(
        _none("neutral, in water that accelerates", "acceleration apart from the water's", "m/s^2, rad/s^2",
              np.linalg.solve(mass, pushed) - np.concatenate([gust, np.zeros(6)]), 1e-9)
    )  # fmt: skip
    return ComparedTable(
        "flow", "Current, and water that accelerates", tuple(rows), "Equations 17, 20 and 21",
        ("A steady current is a change of observer; neutral bodies at rest in water that accelerates go with it.",),
    )  # fmt: skip


def _drag() -> ComparedTable:
    rate, length = SWING["rate"], SWING["length"]
    chain = model.swung(SWING["radius"], length)
    speeds = np.zeros(7)
    speeds[6] = rate
    push = kane.drag(chain, np.zeros(1), speeds)
    unit = 0.5 * DENSITY * model.BASIC * 2.0 * SWING["radius"]
    rows = [
        _same("swung about its end", "power lost", "W", unit * rate**3 * length**4 / 4.0, -float(push @ speeds), 1e-9),
        _same(
            "swung about its end", "moment at the joint", "N m", -unit * rate**2 * length**4 / 4.0, float(push[6]), 1e-9
        ),
        _same(
            "swung about its end",
            "force on the vehicle",
            "N",
            unit * rate**2 * length**3 / 3.0,
            float(np.linalg.norm(push[:3])),
            1e-9,
        ),
    ]
    rows.append(_none("link, towed along its axis", "drag", "N", _towed(chain, np.array([0.7, 0.0, 0.0]))))
    alone = replace(wet(), links=())
    towed = np.array([-0.6, 0.3, 0.2, 0.0, 0.0, 0.0])
    whole = float(np.linalg.norm(towed[:3]))
    rows.append(
        _none("vehicle, astern", "drag apart from -1/2 C_D rho S |v| v", "N",
              kane.drag(alone, np.zeros(0), towed)[:3] + 0.5 * DENSITY * model.AREA * whole * towed[:3], 1e-9)
    )  # fmt: skip
    return ComparedTable(
        "drag", "Drag in closed form", tuple(rows), "Equations 21 and 22 as corrected, section 4.5",
        (f"Cylinder of {SWING['radius']:g} m radius and {length:g} m at {rate:g} rad/s, C_D {model.BASIC:g}: power 1/2 rho C_D d w^3 L^4/4.",),
    )  # fmt: skip


def _thrusters() -> ComparedTable:
    """Both models where theory knows them, and the matrix from thrusts to the vehicle."""
    one, two, rows = wet().thrusters[0].model, model.VOLTAGE, []
    torque, after = 2.0, 0.15
    if isinstance(one, TorqueThruster):
        fastest = np.sqrt(one.beta * torque / one.alpha)
        turning = _spun(one, torque, after)
        expected = fastest * np.tanh(np.sqrt(one.alpha * one.beta * torque) * after)
        rows += [
            _same(f"torque model, {torque:g} N m for {after:g} s", "speed", "rad/s", float(expected), float(turning[0]), 1e-6),
            _same(f"torque model, {torque:g} N m", "thrust where it turns steadily", "N", float(one.thrust * one.beta * torque / one.alpha),
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
        _same("voltage model, 30 N", "thrust of its blades", "N", 30.0, float(lift * np.cos(theta) - dragged * np.sin(theta)), 1e-6),
        _same("voltage model, 30 N", "momentum of its jet, rho A delta v_p^2", "N", 30.0, float(DENSITY * area * two.momentum * state[1] ** 2), 1e-6),
        _none("voltage model, 30 N", "torque left: drive, friction, blades", "rad/s^2",
              two.drive * volts - two.damping * state[0] - two.load * resisting, 1e-6),
        _same("voltage model, after 60 s", "speed", "rad/s", float(state[0]), float(settled[0]), 1e-4),
        _same("voltage model, after 60 s", "thrust", "N", 30.0, two.force(settled, DENSITY), 1e-4),
        _same("voltage model, astern", "thrust", "N", -30.0, two.force(-state, DENSITY), 1e-6),
        _same("voltage model, started at rest", "rate of speed by 1 V", "rad/s^2", model.VOLTAGE_DRIVE, float(two.rates(np.zeros(2), 1.0, DENSITY)[0]), EXACT),
        _same("voltage model, jet at 1 m/s, blades still", "rate of the jet", "m/s^2", *_slowing(two), 1e-9),
    ]  # fmt: skip
    thrusters = wet().thrusters
    thrusts = np.arange(1.0, len(thrusters) + 1.0)
    pushes = [t * one_.axis for t, one_ in zip(thrusts, thrusters, strict=True)]
    summed = np.concatenate([sum(pushes), sum(np.cross(t.place, f) for t, f in zip(thrusters, pushes, strict=True))])
    rows.append(
        _none(
            "thruster matrix",
            "force and moment apart from the sum",
            "N, N m",
            thruster_matrix(thrusters) @ thrusts - summed,
        )
    )
    wanted = np.array([5.0, -3.0, 2.0, 1.0, -4.0, 6.0])
    given = thruster_matrix(thrusters) @ (require_all_directions(thrusters) @ wanted)
    rows.append(_none("pseudo-inverse", "force and moment apart from what is wanted", "N, N m", given - wanted, 1e-9))
    return ComparedTable(
        "thrusters", "Thruster models and their matrix", tuple(rows), "Section 3.6",
        (
            "Torque model: Omega = Omega_end tanh(t sqrt(alpha beta tau)) from rest. Constants are chosen; the paper prints none.",
            "Of the voltage model the paper prints the form alone; blades, motor and water follow Healey and others (1994).",
        ),
    )  # fmt: skip


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


def _earth() -> ComparedTable:
    angles, w, step = np.array([0.4, -0.5, 1.1]), np.array([0.3, -0.2, 0.25]), 1e-6
    rates = model.euler_rates(angles, w)
    ahead, behind = (rotation(*(angles + side * step * rates)) for side in (1.0, -1.0))
    slope = rotation(*angles).T @ (ahead - behind) / (2.0 * step)
    turned = np.array([slope[2, 1], slope[0, 2], slope[1, 0]])
    quaternion = from_euler(*angles)
    moved_ = np.array(kinematics(axes_in_earth(*quaternion), *quaternion, *np.zeros(3), *w)[3:7])
    by_angles = (from_euler(*(angles + step * rates)) - from_euler(*(angles - step * rates))) / (2.0 * step)
    rows = (
        _none(
            "equation 28",
            "apart from the turn of the equations",
            "1",
            model.turn_by_paper(angles) - rotations(quaternion[None])[0],
        ),
        _none("equation 29", "w apart from the slope of the turn", "rad/s", turned - w, 1e-8),
        _none(
            "equations 26 and 27",
            "end effector apart from 4 x 4 matrices",
            "m",
            _end_by_matrices(angles) - _end(angles),
            1e-9,
        ),
        _none("quaternion", "rate apart from that of the angles", "1/s", moved_ - by_angles, 1e-8),
    )
    return ComparedTable(
        "earth", "From frame 0 to north, east, down", rows, "Equations 28 and 29 as corrected",
        ("Angles 0.4, -0.5 and 1.1 rad. Motions are integrated with a quaternion, as the paper advises.",),
    )  # fmt: skip


# ---- errata as numbers ---------------------------------------------------------------------------------------------


def _errata() -> ComparedTable:
    """Of each erratum what the printed form gives and what the corrected one, where theory knows both."""
    rows: list[Compared] = []

    def pair(
        what: str,
        quantity: str,
        unit: str,
        of_printed: tuple[float, float],
        of_corrected: tuple[float, float],
        within: float,
    ) -> None:
        """Theory and found of the printed form, then of the corrected one."""
        for said, (expected, found) in (("as printed", of_printed), ("corrected", of_corrected)):
            rows.append(_same(f"{what}, {said}", quantity, unit, expected, found, within))

    for i, (name, (right, wrong)) in enumerate(SPHEROID.items()):
        forms = [model.spheroid_by_paper(1.0, 0.4, printed=printed)[i] for printed in (True, False)]
        pair("1 e of the spheroid", name, "1", (wrong, forms[0]), (right, forms[1]), FOUR_DIGITS)
    water = wet()
    body, whole = kane.mass_matrix(dry(), Q)[1, 1], kane.mass_matrix(water, Q)[1, 1]
    pair("2 sign of I_A", "M_22", "kg", (MASS[1] - ADDED[1], 2.0 * body - whole), (MASS[1] + ADDED[1], whole), 1.1e-6)
    radius, length = SWING["radius"], SWING["length"]
    across = DENSITY * np.pi * radius**2 * length
    quarter, end, right = (
        kane.mass_matrix(model.swung(radius, length, water), np.zeros(1)) - kane.mass_matrix(model.swung(radius, length, NO_WATER), np.zeros(1))
        for water in (model.cylinder_by_paper(radius, length, quarter=True), model.cylinder_by_paper(radius, length, quarter=False), None)
    )  # fmt: skip
    pair("3 k of the cylinder", "A across", "kg", (across / 4.0, quarter[1, 1]), (across, right[1, 1]), 1e-9)
    turning = across * length**2
    pair(
        "3 turning of the cylinder",
        "about its end",
        "kg m^2",
        (turning * 7.0 / 12.0, end[6, 6]),
        (turning / 3.0, right[6, 6]),
        1e-9,
    )
    chain, w = model.swung(radius, length), np.array([0.3, 0.5, 0.9])
    moving = in_frame_0(chain, np.array([0.0, 0.0, 0.0, w[0], w[1], 0.0, w[2]]))
    made = [
        _from_nothing(chain, np.zeros(1), moving, law(chain, np.zeros(1), moving))
        for law in (model.bias_by_equation_16, kane.bias)
    ]
    pair(
        "4 equation 16",
        "power from nothing",
        "W",
        (-turning / 12.0 * float(np.prod(w)), made[0]),
        (0.0, made[1]),
        SECOND,
    )
    rate, unit = SWING["rate"], 0.5 * DENSITY * model.BASIC * 2.0 * radius
    force, moment = model.drag_by_equation_21(radius, length, np.zeros(3), rate)
    lost = (
        -float(force[1] * rate * length / 2.0 + moment[2] * rate),
        -rate * float(kane.drag(chain, np.zeros(1), _only(6, rate, 7))[6]),
    )
    size = unit * rate**3 * length**4
    pair("5 moment of equation 21, swung", "power lost", "W", (size * 5.0 / 12.0, lost[0]), (size / 4.0, lost[1]), 1e-9)
    oblique = np.sqrt(0.5) * np.array([1.0, 1.0, 0.0])
    sides = model.drag_by_equation_21(radius, length, oblique, 0.0)[0][1], _towed(chain, oblique)[1]
    pair(
        "5 sin^2 in C_D, at 45 deg and 1 m/s",
        "force",
        "N",
        (-unit * length / 4.0, float(sides[0])),
        (-unit * length / 2.0, float(sides[1])),
        1e-9,
    )
    torques = np.array([1.0, 2.0, 3.0])
    printed = FLU @ model.equation_23(kane.pose(water, Q).axis, torques)
    axes = np.array([[0.0, 0.0, 1.0], [-np.sin(Q[0]), np.cos(Q[0]), 0.0], [-np.sin(Q[0]), np.cos(Q[0]), 0.0]])
    pair(
        "6 equation 23, tau = 1, 2, 3 N m",
        "moment on the vehicle, y",
        "N m",
        (float(axes.T[1] @ torques), float(printed[1])),
        (0.0, _reaction(water, torques)),
        1e-9,
    )
    rise = model.turn_by_paper(np.zeros(3)) @ np.array([0.0, 0.0, 1.0]), water.mount @ np.array([0.0, 0.0, 1.0])
    pair(
        "7 equation 28, level",
        "down, for 1 m up frame 0's z",
        "m",
        (1.0, float(rise[0][2])),
        (-1.0, float(rise[1][2])),
        EXACT,
    )
    roll, w = np.array([np.pi / 3.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    rates = [float(model.euler_rates(roll, w, printed=printed)[1]) for printed in (True, False)]
    pair("7 equation 29, roll 60 deg", "pitch rate for w_y = 1 rad/s", "rad/s", (1.0, rates[0]), (0.5, rates[1]), EXACT)
    astern = _only(0, -0.5, 6)
    taken = float(astern @ kane.drag(replace(water, links=()), np.zeros(0), astern))
    size = 0.5 * DENSITY * model.AREA * 0.5**3
    pair(
        "7 drag of the vehicle, 0.5 m/s astern",
        "power",
        "W",
        (size, 0.5 * DENSITY * model.AREA * float(astern @ astern) * 0.5),
        (-size, taken),
        1e-9,
    )
    pair(
        "8 added mass of link 2",
        "along its drag axis",
        "kg",
        (DENSITY * np.pi * 0.08**2 * 0.43, float(cylinder(0.08, 0.43, 2)[0, 0])),
        (0.0, float(water.inertias[1][2, 0, 0])),
        1e-9,
    )
    a = model.link_1_by_paper(float(Q[0]), SPEEDS, RATES)["a"]
    literal, gap = model.a_1_as_printed(float(Q[0]), SPEEDS, RATES)
    pair(
        "9 a of link 1",
        "x component",
        "m/s^2",
        (float(a[0]) + gap, literal),
        (float(a[0]), float(_of_link_1(dry(), RATES[:7])[0][0])),
        1e-9,
    )
    return ComparedTable(
        "errata", "Errata: the printed form, and the corrected one", tuple(rows), "The numbers of the list of errata",
        (
            "As printed: what the printed form gives, by theory and by that form computed. Corrected: theory, and what the model computes.",
            "A printed form that passes is not right: it gives the wrong number that theory expects of it.",
        ),
    )  # fmt: skip


def _only(index: int, value: float, size: int) -> Array:
    out = np.zeros(size)
    out[index] = value
    return out


def _towed(chain: Chain, velocity: Array) -> Array:
    """(3,) drag along frame 0 of a chain of one link, towed at a velocity along frame 0."""
    speeds = np.concatenate([velocity, np.zeros(4)])
    return in_frame_0(chain, kane.drag(chain, np.zeros(1), in_frame_0(chain, speeds)))[:3]


def _from_nothing(chain: Chain, q: Array, speeds: Array, bias: Array) -> float:
    """Power, W, that the kinetic energy gains while no force acts: 1/2 s M' s - s C."""
    changing = np.einsum("k,i,kij,j->", speeds[6:], speeds, _slopes(chain, q), speeds)
    return float(0.5 * changing - speeds @ bias)


def _reaction(chain: Chain, torques: Array) -> float:
    """Moment about y that joint torques put on the whole at rest, N m: the rate of its angular momentum."""
    changed = kane.right_hand_side(chain, at_rest(chain, Q), np.concatenate([np.zeros(6), torques]))[10:]
    return float((kane.mass_matrix(chain, Q) @ changed)[4])


# ---- motions in time -----------------------------------------------------------------------------------------------


def _energy() -> ComparedTable:
    """Free motion, and motion with drag and torques: energy and momentum after five seconds."""
    rows = []
    for said, chain in (("free, without water", dry()), ("free, with added mass", _ideal(wet()))):
        start, end, _ = _motion(chain, lambda _: np.zeros(9))
        apart = _kinetic(chain, end) / _kinetic(chain, start) - 1.0
        rows.append(_none(f"{said}, {LASTS:g} s", "change of kinetic energy over itself", "1", apart, CONSERVED))
        if chain is dry():
            gone = _momentum(chain, end) - _momentum(chain, start)
            rows.append(_none(f"{said}, {LASTS:g} s", "change of momentum", "N s, N m s", gone, 1e-7))
    start, end, work = _motion(wet(), _driven)
    gained = _kinetic(wet(), end) - _kinetic(wet(), start)
    largest = max(abs(gained), abs(work))
    rows.append(
        _none(
            f"with drag and torques, {LASTS:g} s",
            "energy gained less work, over the larger",
            "1",
            (gained - work) / largest,
            BALANCED,
        )
    )
    return ComparedTable(
        "energy", "Energy and momentum in time", tuple(rows), "Equations 24 and 25",
        (
            "Free from the speeds above, by an eighth-order method with a tolerance of 1e-9.",
            f"With drag and joint torques: {work:+.4g} J of work, {gained:+.4g} J of kinetic energy gained.",
        ),
    )  # fmt: skip


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


@cache
def tasks() -> dict[str, ControlledRun]:
    """Runs under control, by name."""
    chain = wet()
    ideal = replace(chain, thrusters=tuple(replace(t, model=None) for t in chain.thrusters))
    volted = replace(chain, thrusters=tuple(replace(t, model=model.VOLTAGE) for t in chain.thrusters))
    track = track_to(chain, chain.home, AIM, BEGINS, ENDS)
    straight = track_of_end(chain, BENT, kane.pose(chain, BENT).end + REACH, BEGINS, ENDS)
    still = track_to(chain, chain.home, chain.home, BEGINS, ENDS)
    start = at_rest(chain)
    start[:3] = OFFSET
    law, blind, simple = Controller(), Controller(knows_current=False), Controller("station")
    return {
        "offset": controlled(ideal, law, track, TASK, start=start),
        "ideal": controlled(ideal, law, track, TASK),
        "torque": controlled(chain, law, track, TASK),
        "voltage": controlled(volted, law, track, TASK),
        "station": controlled(chain, simple, track, TASK),
        "end": controlled(chain, law, straight, TASK),
        "current": controlled(ideal, blind, still, 2.5 * TASK, flow=Flow(CURRENT), rows=0.5),
    }


def _control(runs: dict[str, ControlledRun]) -> ComparedTable:
    offset, law = runs["offset"], Controller()
    far = float(np.linalg.norm(OFFSET))
    fades = far * (1.0 + law.vehicle * offset.time) * np.exp(-law.vehicle * offset.time)
    pushed = runs["current"]
    mass, towed = kane.equations(pushed.chain, pushed.state[-1], Flow(CURRENT))
    steady = np.linalg.solve(mass, towed)[:3] / law.vehicle**2
    rows = [
        _none("computed torque, thrusters at once, 0.37 m off", "distance apart from e_0 (1 + w t) exp(-w t)", "m", offset.apart - fades, 1e-5),
        _none("computed torque, thrusters at once, joints move", "distance from the station", "m", runs["ideal"].apart, 1e-6),
        _none("computed torque, thrusters at once, joints move", "end effector from its track", "m", runs["ideal"].end_apart, 1e-4),
        _same("computed torque that does not know the current", "distance that stays", "m", float(np.linalg.norm(steady)), float(pushed.apart[-1]), 1e-4),
    ]  # fmt: skip
    said = [
        f"{TITLES[name]}: up to {1e3 * float(run.apart.max()):.2g} mm and {np.degrees(float(run.turned.max())):.2g} deg off station, the end "
        f"effector up to {1e3 * float(run.end_apart.max()):.2g} mm off its track; thrust up to {float(np.abs(run.thrust).max()):.2g} N, "
        f"joint torque up to {float(np.abs(run.torque).max()):.2g} N m; {'; '.join(run.status) or 'nothing at its limit'}."
        for name, run in runs.items()
        if name in TITLES
    ]
    return ComparedTable(
        "control", "Computed torque and station keeping", tuple(rows), "Sections 1, 3.6 and 3.7",
        ("The paper prints no controller and no run. The law and its gains are ours: 1 rad/s for the vehicle, 4 rad/s for joints, critical "
         "damping.", "M^-1 F / w^2 is the distance that a current leaves whose force F the controller does not know.", *said),
    )  # fmt: skip


TITLES = {
    "torque": "Computed torque, torque-driven thrusters",
    "voltage": "Computed torque, voltage-driven thrusters",
    "station": "Station keeping without the model, torque-driven thrusters",
    "end": "End effector on a straight line, computed torque",
}


def _end(angles: Array) -> Array:
    state = np.concatenate([[2.0, -1.0, 5.0], from_euler(*angles), Q, np.zeros(9)])
    return kane.end_in_earth(wet(), state)


def _end_by_matrices(angles: Array) -> Array:
    """(3,) equation 27 with the paper's matrices and the missing diag(1, -1, -1)."""
    whole = np.eye(4)
    for one in model.printed_matrices(Q):
        whole = whole @ one
    in_0 = np.asarray(model.ATTACHMENT) + (whole @ [*wet().tool, 1.0])[:3]
    return np.array([2.0, -1.0, 5.0]) + model.turn_by_paper(angles) @ FLU @ in_0

"""URV with an arm by Kane's method: printed expressions, independent numbers, energy and power, errata as numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coeflab.arm import kane
from coeflab.arm.chain import FLU, Chain, in_frame_0
from coeflab.arm.motion import at_rest
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.core.machine import one_thread
from coeflab.core.types import Array
from coeflab.law.transforms import denavit_hartenberg
from coeflab.published.publication import Row, publication
from coeflab.published.urv import model, theory
from coeflab.published.urv.model import ADDED, BIAS, DENSITY, FIRST_ROW, MASS, cylinder, dry, wet
from coeflab.published.urv.tasks import control, energy, figures, page, tasks
from coeflab.report.acceptance import Acceptance, Basis, ComparedTable

PAPER = publication("urv")

SPEED_NAMES = ("v_x", "v_y", "v_z", "w_x", "w_y", "w_z", "q1", "q2", "q3")
DIGITS = 5.1e-7  # half of the last digit of the numbers above

NO_WATER = np.zeros((6, 6))
FOUR_DIGITS = 5.1e-5  # half of the last digit of the numbers below
SPHEROID = {"A11/m": (0.1563, 0.2335), "A22/m": (0.7619, 0.6816), "A55/m": (0.0847, 0.0517)}  # corrected, printed


@one_thread()
def acceptance() -> Acceptance:
    """Everything that the paper prints, its errata, and what theory says of the model."""
    tables = (*compared(), *moved())
    return PAPER.acceptance(
        tables, PAPER.texts("statements"), figures=tuple(figures()), pages=(("urv_motion.html", page()),)
    )


def compared() -> tuple[ComparedTable, ...]:
    """What needs no motion in time."""
    return (
        _link_1(), _transformations(), _mass_matrix(), _bias(), _added_mass(), _spheroid(), theory.principles(), theory.flow(), theory.drag(), theory.propulsion(), theory.earth(), errata(),
    )  # fmt: skip


def moved() -> tuple[ComparedTable, ...]:
    """Motions in time."""
    return (energy(), control(tasks()))


# ---- what the paper prints -----------------------------------------------------------------------------------------


def _link_1() -> ComparedTable:
    chain = dry()
    at = kane.pose(chain, theory.Q)
    moving = kane.partial_velocities(chain, at)[1] @ in_frame_0(chain, theory.SPEEDS)
    push, turned = theory.motion_of_link_1(chain, theory.RATES[:7])
    found = {"p": FLU @ at.centre[1], "w": FLU @ moving[3:], "v": FLU @ moving[:3], "alpha": turned, "a": push}
    units = {"p": "m", "w": "rad/s", "v": "m/s", "alpha": "rad/s^2", "a": "m/s^2"}
    paper = model.link_1_by_paper(float(theory.Q[0]), theory.SPEEDS, theory.RATES)
    rows = [
        Row(
            "link 1", f"{name}_1, {axis}", units[name], float(paper[name][i]), float(found[name][i]),
            basis=Basis.CONSISTENCY if name == "a" else None,
        )
        for name in paper
        for i, axis in enumerate("xyz")
    ]  # fmt: skip
    down = np.array([0.3, -0.4, np.sqrt(0.75)])
    pulled = in_frame_0(chain, kane.weight(chain, theory.Q, FLU @ down))
    whole = model.VEHICLE_MASS + sum(model.MASSES)
    rows.append(Row("gravity along x", "(F_1)grav", "N", whole * chain.gravity * 0.3, float(pulled[0]), 1e-9))
    return PAPER.table("link_1", rows)


def _transformations() -> ComparedTable:
    chain, printed = dry(), model.printed_matrices(theory.Q)
    rows, whole = [], np.eye(4)
    at = kane.pose(chain, theory.Q)
    for j, link in enumerate(chain.links):
        joint = link.joint
        turn, shift = denavit_hartenberg(joint.theta + float(theory.Q[j]), joint.d, joint.a, joint.alpha)
        apart = np.hstack([turn, shift[:, None]]) - printed[j][:3]
        rows.append(Row.none(f"A_{j}^{j + 1}", "largest entry apart", "1, m", apart, basis=Basis.CALIBRATION))
        whole = whole @ printed[j]
        place = whole @ np.append(link.centre_of_mass, 1.0)
        expected = np.asarray(model.ATTACHMENT) + place[:3]
        rows.append(
            Row.none(f"equation 8, link {j + 1}", "p by 4 x 4 matrices, apart", "m", FLU @ at.centre[j + 1] - expected)
        )
        for name, printed_, held in (
            ("mass", model.MASSES[j], link.mass), ("centre of mass", model.CENTRES[j], link.centre_of_mass),
            ("inertia", model.INERTIAS[j], np.diag(link.inertia)),
        ):  # fmt: skip
            apart = np.asarray(printed_) - held
            rows.append(Row.none(f"link {j + 1}", f"{name} of the file, apart", "SI", apart, basis=Basis.CALIBRATION))
    apart = FLU @ at.end - np.asarray(model.ATTACHMENT) - (whole @ [*chain.tool, 1.0])[:3]
    rows.append(Row.none("equation 27", "end effector by 4 x 4 matrices, apart", "m", apart))
    return PAPER.table("transformations", rows)


# ---- numbers worked out independently ------------------------------------------------------------------------------


def _given(case: str, names: tuple[str, ...], numbers: tuple[float, ...], found: Array, unit: str) -> list[Row]:
    return [
        Row(f"{case}, {name}", "entry", unit, number, float(value), DIGITS)
        for name, number, value in zip(names, numbers, found, strict=True)
    ]


def _mass_matrix() -> ComparedTable:
    chain = dry()
    found = in_frame_0(chain, kane.mass_matrix(chain, theory.Q))
    rows = _given("diagonal", SPEED_NAMES, MASS, np.diag(found), "kg, kg m^2")
    rows += _given("row 1", SPEED_NAMES[1:], FIRST_ROW, found[0, 1:], "kg, kg m")
    rows.append(Row.none("whole matrix", "asymmetry", "kg, kg m^2", found - found.T))
    return PAPER.table("mass_matrix", rows)


def _bias() -> ComparedTable:
    chain = dry()
    found = in_frame_0(chain, kane.bias(chain, theory.Q, in_frame_0(chain, theory.SPEEDS)))
    return PAPER.table("bias", _given("C", SPEED_NAMES, BIAS, found, "N, N m"))


def _added_mass() -> ComparedTable:
    air, water = dry(), wet()
    found = in_frame_0(water, kane.mass_matrix(water, theory.Q) - kane.mass_matrix(air, theory.Q))
    return PAPER.table("added_mass", _given("diagonal", SPEED_NAMES, ADDED, np.diag(found), "kg, kg m^2"))


def _spheroid() -> ComparedTable:
    a, b = 1.0, 0.4
    displaced = DENSITY * 4.0 / 3.0 * np.pi * a * b**2
    ours = np.diag(ellipsoid_added_mass(np.array([a, b, b]), DENSITY))[[0, 1, 4]] / displaced
    corrected = model.spheroid_by_paper(a, b, printed=False)
    rows = []
    for i, (name, (number, _)) in enumerate(SPHEROID.items()):
        rows.append(Row("e^2 = 1 - (b/a)^2", name, "1", number, corrected[i], FOUR_DIGITS))
        rows.append(Row("closed form by Lamb", f"{name}, apart", "1", corrected[i], float(ours[i]), 1e-12))
    k = DENSITY * np.pi * 0.09**2 * 0.66
    entries = np.diag(cylinder(0.09, 0.66, 1))
    rows += [
        Row("cylinder of link 1", "across", "kg", k, float(entries[0]), 1e-9),
        Row("cylinder of link 1", "along", "kg", 0.0, float(entries[1]), 0.0),
        Row("cylinder of link 1", "turning about its centre", "kg m^2", k * 0.66**2 / 12.0, float(entries[3]), 1e-9),
    ]
    return PAPER.table("spheroid", rows)


# ---- errata as numbers ---------------------------------------------------------------------------------------------


def errata() -> ComparedTable:
    """Of each erratum what the printed form gives and what the corrected one, where theory knows both."""
    return PAPER.table("errata", [*_of_inertia(), *_of_drag(), *_of_frames()])


def pair(
    what: str,
    quantity: str,
    unit: str,
    printed: tuple[float, float],
    corrected: tuple[float, float],
    within: float = 1e-9,
) -> list[Row]:
    """Theory and found of the printed form, then of the corrected one."""
    as_printed = Row(f"{what}, as printed", quantity, unit, *printed, within)
    return [as_printed, Row(f"{what}, corrected", quantity, unit, *corrected, within)]


def _of_inertia() -> list[Row]:
    """Errata 1 to 4."""
    rows = []
    for i, (name, (true, wrong)) in enumerate(SPHEROID.items()):
        forms = [model.spheroid_by_paper(1.0, 0.4, printed=printed)[i] for printed in (True, False)]
        rows += pair("1 e of the spheroid", name, "1", (wrong, forms[0]), (true, forms[1]), FOUR_DIGITS)
    water = wet()
    body, whole = kane.mass_matrix(dry(), theory.Q)[1, 1], kane.mass_matrix(water, theory.Q)[1, 1]
    rows += pair(
        "2 sign of I_A", "M_22", "kg", (MASS[1] - ADDED[1], 2.0 * body - whole), (MASS[1] + ADDED[1], whole), 1.1e-6
    )
    radius, length = theory.SWING["radius"], theory.SWING["length"]
    across = DENSITY * np.pi * radius**2 * length
    quarter, end, right = (
        kane.mass_matrix(model.swung(radius, length, water), np.zeros(1)) - kane.mass_matrix(model.swung(radius, length, NO_WATER), np.zeros(1))
        for water in (model.cylinder_by_paper(radius, length, quarter=True), model.cylinder_by_paper(radius, length, quarter=False), None)
    )  # fmt: skip
    rows += pair("3 k of the cylinder", "A across", "kg", (across / 4.0, quarter[1, 1]), (across, right[1, 1]))
    turning = across * length**2
    swung = (turning * 7.0 / 12.0, end[6, 6]), (turning / 3.0, right[6, 6])
    rows += pair("3 turning of the cylinder", "about its end", "kg m^2", *swung)
    chain, spin = model.swung(radius, length), np.array([0.3, 0.5, 0.9])
    moving = in_frame_0(chain, np.array([0.0, 0.0, 0.0, spin[0], spin[1], 0.0, spin[2]]))
    result = [
        theory.from_nothing(chain, np.zeros(1), moving, law(chain, np.zeros(1), moving))
        for law in (model.bias_by_equation_16, kane.bias)
    ]
    gained = -turning / 12.0 * float(np.prod(spin))
    rows += pair("4 equation 16", "power from nothing", "W", (gained, result[0]), (0.0, result[1]), theory.SECOND)
    return rows


def _of_drag() -> list[Row]:
    """Erratum 5."""
    rows, radius, length = [], theory.SWING["radius"], theory.SWING["length"]
    chain = model.swung(radius, length)
    rate, per = theory.SWING["rate"], 0.5 * DENSITY * model.BASIC * 2.0 * radius
    force, moment = model.drag_by_equation_21(radius, length, np.zeros(3), rate)
    loss = (
        -float(force[1] * rate * length / 2.0 + moment[2] * rate),
        -rate * float(kane.drag(chain, np.zeros(1), theory.only(6, rate, 7))[6]),
    )
    size = per * rate**3 * length**4
    rows += pair(
        "5 moment of equation 21, swung", "power lost", "W", (size * 5.0 / 12.0, loss[0]), (size / 4.0, loss[1])
    )
    oblique = np.sqrt(0.5) * np.array([1.0, 1.0, 0.0])
    sides = model.drag_by_equation_21(radius, length, oblique, 0.0)[0][1], theory.towed(chain, oblique)[1]
    forces = (-per * length / 4.0, float(sides[0])), (-per * length / 2.0, float(sides[1]))
    rows += pair("5 sin^2 in C_D, at 45 deg and 1 m/s", "force", "N", *forces)
    return rows


def _of_frames() -> list[Row]:
    """Errata 6 to 9."""
    rows, water = [], wet()
    torques = np.array([1.0, 2.0, 3.0])
    printed = FLU @ model.equation_23(kane.pose(water, theory.Q).axis, torques)
    axes = np.array(
        [
            [0.0, 0.0, 1.0],
            [-np.sin(theory.Q[0]), np.cos(theory.Q[0]), 0.0],
            [-np.sin(theory.Q[0]), np.cos(theory.Q[0]), 0.0],
        ]
    )
    moments = (float(axes.T[1] @ torques), float(printed[1])), (0.0, _reaction(water, torques))
    rows += pair("6 equation 23, tau = 1, 2, 3 N m", "moment on the vehicle, y", "N m", *moments)
    rise = model.turn_by_paper(np.zeros(3)) @ np.array([0.0, 0.0, 1.0]), water.mount @ np.array([0.0, 0.0, 1.0])
    downward = (1.0, float(rise[0][2])), (-1.0, float(rise[1][2]))
    rows += pair("7 equation 28, level", "down, for 1 m up frame 0's z", "m", *downward, 1e-11)
    roll, w = np.array([np.pi / 3.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    rates = [float(model.euler_rates(roll, w, printed=printed)[1]) for printed in (True, False)]
    rows += pair(
        "7 equation 29, roll 60 deg", "pitch rate for w_y = 1 rad/s", "rad/s", (1.0, rates[0]), (0.5, rates[1]), 1e-11
    )
    astern = theory.only(0, -0.5, 6)
    taken = float(astern @ kane.drag(replace(water, links=()), np.zeros(0), astern))
    size = 0.5 * DENSITY * model.AREA * 0.5**3
    given = 0.5 * DENSITY * model.AREA * float(astern @ astern) * 0.5
    rows += pair("7 drag of the vehicle, 0.5 m/s astern", "power", "W", (size, given), (-size, taken))
    masses = (
        (DENSITY * np.pi * 0.08**2 * 0.43, float(cylinder(0.08, 0.43, 2)[0, 0])),
        (0.0, float(water.inertias[1][2, 0, 0])),
    )
    rows += pair("8 added mass of link 2", "along its drag axis", "kg", *masses)
    a = model.link_1_by_paper(float(theory.Q[0]), theory.SPEEDS, theory.RATES)["a"]
    literal, gap = model.a_1_as_printed(float(theory.Q[0]), theory.SPEEDS, theory.RATES)
    pushed = float(theory.motion_of_link_1(dry(), theory.RATES[:7])[0][0])
    rows += pair("9 a of link 1", "x component", "m/s^2", (float(a[0]) + gap, literal), (float(a[0]), pushed))
    return rows


def _reaction(chain: Chain, torques: Array) -> float:
    """Moment about y that joint torques put on the whole at rest, N m: the rate of its angular momentum."""
    changed = kane.right_hand_side(chain, at_rest(chain, theory.Q), np.concatenate([np.zeros(6), torques]))[10:]
    return float((kane.mass_matrix(chain, theory.Q) @ changed)[4])

"""URV with an arm by Kane's method: printed expressions, independent numbers, energy and power, errata as numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coeflab.arm import kane
from coeflab.arm.chain import FLU, Chain, in_frame_0
from coeflab.arm.motion import at_rest
from coeflab.bodies.closed_forms import ellipsoid_added_mass
from coeflab.core.machine import one_thread
from coeflab.core.types import Array
from coeflab.law.transforms import denavit_hartenberg
from coeflab.published.urv import model
from coeflab.published.urv.model import ADDED, BIAS, DENSITY, FIRST_ROW, MASS, cylinder, dry, wet
from coeflab.published.urv.tasks import control, energy, figures, page, tasks
from coeflab.published.urv.theory import (
    EXACT,
    FINEST,
    PLACES,
    RATES,
    SECOND,
    SPEEDS,
    SWING,
    Q,
    drag,
    earth,
    flow,
    from_nothing,
    motion_of_link_1,
    none,
    only,
    principles,
    propulsion,
    same,
    towed,
)
from coeflab.report.acceptance import Acceptance, Basis, Compared, ComparedTable

SPEED_NAMES = ("v_x", "v_y", "v_z", "w_x", "w_y", "w_z", "q1", "q2", "q3")
DIGITS = 5.1e-7  # half of the last digit of the numbers above

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
    "Figure 1, the coordinate system, is the paper's only figure: ours follows its caption and section 4.1, not its drawing. No "
    "result can be drawn after the paper, for it prints none.",
    "The 3-link example has no hydrodynamic number in the paper beside C_D = 1.1 of a cylinder.",
)
NO_WATER = np.zeros((6, 6))
FOUR_DIGITS = 5.1e-5  # half of the last digit of the numbers below
SPHEROID = {"A11/m": (0.1563, 0.2335), "A22/m": (0.7619, 0.6816), "A55/m": (0.0847, 0.0517)}  # corrected, printed


@one_thread()
def acceptance() -> Acceptance:
    """Everything that the paper prints, its errata, and what theory says of the model."""
    return Acceptance(
        "urv",
        "URV with an arm: Kane's equations of a vehicle with links 1 to 3 of a PUMA 560",
        (*compared(), *moved()),
        ERRATA,
        CHOSEN,
        ("urv_kane", "yoerger1990", "healey1994"),
        tuple(figures()),
        CONVENTIONS,
        pages=(("urv_motion.html", page()),),
    )


def compared() -> tuple[ComparedTable, ...]:
    """What needs no motion in time."""
    return (
        _link_1(), _transformations(), _mass_matrix(), _bias(), _added_mass(), _spheroid(), principles(), flow(), drag(), propulsion(), earth(), errata(),
    )  # fmt: skip


def moved() -> tuple[ComparedTable, ...]:
    """Motions in time."""
    return (energy(), control(tasks()))


# ---- what the paper prints -----------------------------------------------------------------------------------------


def _link_1() -> ComparedTable:
    chain = dry()
    at = kane.pose(chain, Q)
    moving = kane.partial_velocities(chain, at)[1] @ in_frame_0(chain, SPEEDS)
    push, turned = motion_of_link_1(chain, RATES[:7])
    found = {"p": FLU @ at.centre[1], "w": FLU @ moving[3:], "v": FLU @ moving[:3], "alpha": turned, "a": push}
    units = {"p": "m", "w": "rad/s", "v": "m/s", "alpha": "rad/s^2", "a": "m/s^2"}
    paper = model.link_1_by_paper(float(Q[0]), SPEEDS, RATES)
    rows = [
        Compared(
            "link 1", f"{name}_1, {axis}", units[name], round(float(paper[name][i]), PLACES), round(float(found[name][i]), PLACES), EXACT,
            Basis.CONSISTENCY if name == "a" else Basis.VERIFICATION,
        )
        for name in paper
        for i, axis in enumerate("xyz")
    ]  # fmt: skip
    down = np.array([0.3, -0.4, np.sqrt(0.75)])
    pulled = in_frame_0(chain, kane.weight(chain, Q, FLU @ down))
    whole = model.VEHICLE_MASS + sum(model.MASSES)
    rows.append(
        Compared(
            "gravity along x", "(F_1)grav", "N", whole * chain.gravity * 0.3, float(pulled[0]), 1e-9, Basis.VERIFICATION
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
            none(f"equation 8, link {j + 1}", "p by 4 x 4 matrices, apart", "m", FLU @ at.centre[j + 1] - expected)
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
        none(
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
    rows.append(none("whole matrix", "asymmetry", "kg, kg m^2", found - found.T))
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
        rows.append(same("e^2 = 1 - (b/a)^2", name, "1", number, corrected[i], FOUR_DIGITS))
        rows.append(same("closed form by Lamb", f"{name}, apart", "1", corrected[i], float(ours[i]), 1e-12))
    k = DENSITY * np.pi * 0.09**2 * 0.66
    entries = np.diag(cylinder(0.09, 0.66, 1))
    rows += [
        same("cylinder of link 1", "across", "kg", k, float(entries[0]), 1e-9),
        same("cylinder of link 1", "along", "kg", 0.0, float(entries[1]), 0.0),
        same("cylinder of link 1", "turning about its centre", "kg m^2", k * 0.66**2 / 12.0, float(entries[3]), 1e-9),
    ]
    return ComparedTable(
        "spheroid", "Added mass of spheroid and cylinder as corrected", tuple(rows), "Section 4.5",
        ("a 1 m, b 0.4 m; over the mass displaced, A55 for lengths in m.",),
    )  # fmt: skip


# ---- errata as numbers ---------------------------------------------------------------------------------------------


def errata() -> ComparedTable:
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
        for words, (expected, found) in (("as printed", of_printed), ("corrected", of_corrected)):
            rows.append(same(f"{what}, {words}", quantity, unit, expected, found, within))

    for i, (name, (true, wrong)) in enumerate(SPHEROID.items()):
        forms = [model.spheroid_by_paper(1.0, 0.4, printed=printed)[i] for printed in (True, False)]
        pair("1 e of the spheroid", name, "1", (wrong, forms[0]), (true, forms[1]), FOUR_DIGITS)
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
    chain, spin = model.swung(radius, length), np.array([0.3, 0.5, 0.9])
    moving = in_frame_0(chain, np.array([0.0, 0.0, 0.0, spin[0], spin[1], 0.0, spin[2]]))
    result = [
        from_nothing(chain, np.zeros(1), moving, law(chain, np.zeros(1), moving))
        for law in (model.bias_by_equation_16, kane.bias)
    ]
    pair(
        "4 equation 16",
        "power from nothing",
        "W",
        (-turning / 12.0 * float(np.prod(spin)), result[0]),
        (0.0, result[1]),
        SECOND,
    )
    rate, per = SWING["rate"], 0.5 * DENSITY * model.BASIC * 2.0 * radius
    force, moment = model.drag_by_equation_21(radius, length, np.zeros(3), rate)
    lost = (
        -float(force[1] * rate * length / 2.0 + moment[2] * rate),
        -rate * float(kane.drag(chain, np.zeros(1), only(6, rate, 7))[6]),
    )
    size = per * rate**3 * length**4
    pair("5 moment of equation 21, swung", "power lost", "W", (size * 5.0 / 12.0, lost[0]), (size / 4.0, lost[1]), 1e-9)
    oblique = np.sqrt(0.5) * np.array([1.0, 1.0, 0.0])
    sides = model.drag_by_equation_21(radius, length, oblique, 0.0)[0][1], towed(chain, oblique)[1]
    pair(
        "5 sin^2 in C_D, at 45 deg and 1 m/s",
        "force",
        "N",
        (-per * length / 4.0, float(sides[0])),
        (-per * length / 2.0, float(sides[1])),
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
    astern = only(0, -0.5, 6)
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
        (float(a[0]), float(motion_of_link_1(dry(), RATES[:7])[0][0])),
        1e-9,
    )
    return ComparedTable(
        "errata", "Errata: the printed form, and the corrected one", tuple(rows), "The numbers of the list of errata",
        (
            "As printed: what the printed form gives, by theory and by that form computed. Corrected: theory, and what the model computes.",
            "A printed form that passes is not right: it gives the wrong number that theory expects of it.",
        ),
    )  # fmt: skip


def _reaction(chain: Chain, torques: Array) -> float:
    """Moment about y that joint torques put on the whole at rest, N m: the rate of its angular momentum."""
    changed = kane.right_hand_side(chain, at_rest(chain, Q), np.concatenate([np.zeros(6), torques]))[10:]
    return float((kane.mass_matrix(chain, Q) @ changed)[4])

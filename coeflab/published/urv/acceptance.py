"""URV with an arm by Kane's method: printed expressions, independent numbers, energy and power, errata as numbers."""

from __future__ import annotations

import numpy as np

from coeflab.bodies.closed_forms import ellipsoid_added_mass
from coeflab.core.machine import one_thread
from coeflab.core.types import Array
from coeflab.law.transforms import denavit_hartenberg
from coeflab.motion.multibody import kane
from coeflab.motion.multibody.chain import FLU, in_frame_0
from coeflab.published.urv import model
from coeflab.published.urv.errata import FOUR_DIGITS, SPHEROID, errata
from coeflab.published.urv.model import ADDED, BIAS, DENSITY, FIRST_ROW, MASS, cylinder, dry, wet
from coeflab.published.urv.tasks import control, energy, figures, page, tasks
from coeflab.published.urv.theory import (
    EXACT,
    FINEST,
    PLACES,
    RATES,
    SPEEDS,
    Q,
    drag,
    earth,
    flow,
    motion_of_link_1,
    none,
    principles,
    propulsion,
    same,
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

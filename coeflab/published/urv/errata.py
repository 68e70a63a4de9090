"""Each erratum as numbers: what the printed form gives and what the corrected one, where theory knows both."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coeflab.core.types import Array
from coeflab.motion.multibody import kane
from coeflab.motion.multibody.chain import FLU, Chain, in_frame_0
from coeflab.motion.multibody.motion import at_rest
from coeflab.published.urv import model
from coeflab.published.urv.model import ADDED, DENSITY, MASS, cylinder, dry, wet
from coeflab.published.urv.theory import (
    EXACT,
    RATES,
    SECOND,
    SPEEDS,
    SWING,
    Q,
    from_nothing,
    motion_of_link_1,
    only,
    same,
    towed,
)
from coeflab.report.acceptance import Compared, ComparedTable

NO_WATER = np.zeros((6, 6))
FOUR_DIGITS = 5.1e-5  # half of the last digit of the numbers below
SPHEROID = {"A11/m": (0.1563, 0.2335), "A22/m": (0.7619, 0.6816), "A55/m": (0.0847, 0.0517)}  # corrected, printed


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
        for said, (expected, found) in (("as printed", of_printed), ("corrected", of_corrected)):
            rows.append(same(f"{what}, {said}", quantity, unit, expected, found, within))

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
    made = [
        from_nothing(chain, np.zeros(1), moving, law(chain, np.zeros(1), moving))
        for law in (model.bias_by_equation_16, kane.bias)
    ]
    pair(
        "4 equation 16",
        "power from nothing",
        "W",
        (-turning / 12.0 * float(np.prod(spin)), made[0]),
        (0.0, made[1]),
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

"""The URV paper's example as a chain: what it prints, and what was chosen for the numbers that it leaves open.

Printed: Denavit-Hartenberg matrices, centres of mass, masses and inertias of links 1 to 3 of the PUMA 560 (sections 4.2 and 4.3),
C_D = 1.1 of a cylinder. Chosen: the vehicle, since the paper's is generic, and the cylinders that stand for the links in water.

Forms as the paper prints them, and what stands in their place, for the errata: spheroid, cylinder, equations 16, 21, 23, 28 and 29.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from coeflab.bodies.closed_forms import cylinder_added_mass, ellipsoid_added_mass
from coeflab.core.types import Array
from coeflab.motion.multibody.chain import FLU, Base, Chain, Joint, Link, Strip
from coeflab.motion.multibody.kane import denavit_hartenberg, partial_velocities, pose
from coeflab.motion.multibody.thrusters import Thruster, TorqueThruster

RIGHT = math.pi / 2.0
DENSITY = 1000.0
BASIC = 1.1  # C_D,basic of a cylinder, section 4.5
# Section 4.2, as printed: a, alpha, d of the three matrices, and centres of mass.
ROWS = ((0.0, -RIGHT, 0.0), (0.4318, 0.0, 0.0), (-0.0191, RIGHT, 0.1505))
CENTRES = ((0.0, 0.3088, 0.0389), (-0.3289, 0.0050, 0.2038), (0.0204, 0.0137, 0.0037))
# Section 4.3, as printed.
MASSES = (12.96, 22.37, 5.01)
INERTIAS = ((1.09809, 0.177381, 1.1112), (0.403567, 0.968405, 0.966379), (0.0746421, 0.0755015, 0.00749571))
# Chosen: the vehicle of the paper is generic.
ATTACHMENT, VEHICLE_MASS, VEHICLE_INERTIA = (0.5, 0.0, 0.2), 100.0, (10.0, 20.0, 25.0)
SEMI_AXES = (1.0, 0.4, 0.4)
CYLINDERS = ((0.09, 0.66, 1), (0.08, 0.43, 0), (0.05, 0.43, 2))  # radius, length, axis
SPHERE = 0.47  # C_D of a sphere, which section 4.5 names without a number
# Chosen: eight equal thrusters, four of them upright.
THRUSTER = TorqueThruster(alpha=0.02, beta=10.0, thrust=0.004, strongest=80.0)
LEVEL, UPRIGHT = 0.6, 0.35


def cylinder(radius: float, length: float, axis: int, density: float = DENSITY) -> Array:
    """(6, 6) added mass about its centre, nothing along it: ``cylinder_added_mass`` without its axial share, turned to the axis.

    The paper's own with k = rho pi r^2 L, about the centre (erratum 3).
    """
    entries = np.diag(cylinder_added_mass(radius, length, density)).copy()
    entries[0] = 0.0
    order = [axis, *(i for i in range(3) if i != axis)]
    out = np.zeros(6)
    out[order], out[[3 + i for i in order]] = entries[:3], entries[3:]
    return np.diag(out)


def thrusters() -> tuple[Thruster, ...]:
    """Four level ones at 45 degrees and four upright ones: every force and moment can be given."""
    out, half = [], math.sqrt(0.5)
    for name, x, y in (("bow port", 1, -1), ("bow starboard", 1, 1), ("stern port", -1, -1), ("stern starboard", -1, 1)):
        level = np.array([half, -x * y * half, 0.0])
        out.append(Thruster(f"{name}, level", np.array([LEVEL * x, UPRIGHT * y, 0.0]), level, THRUSTER))
        out.append(Thruster(f"{name}, upright", np.array([LEVEL * x, UPRIGHT * y, 0.0]), np.array([0.0, 0.0, 1.0]), THRUSTER))
    return tuple(out)


def dry() -> Chain:
    """Vehicle and arm without water: what Pinocchio knows."""
    links = tuple(
        Link(f"link {j}", Joint(f"q{j}", "revolute", a, alpha, d, 0.0), mass, np.array(centre), np.diag(inertia))
        for j, ((a, alpha, d), centre, mass, inertia) in enumerate(zip(ROWS, CENTRES, MASSES, INERTIAS, strict=True), 1)
    )
    base = Base("vehicle", VEHICLE_MASS, np.diag(VEHICLE_INERTIA))
    return Chain("urv", base, links, FLU @ ATTACHMENT, density=DENSITY)


def wet() -> Chain:
    """In water: spheroid and cylinders, drag, buoyancy equal to the weight at the centres of mass, and eight thrusters."""
    chain = dry()
    links = tuple(
        replace(
            link,
            added_mass=cylinder(radius, length, axis),
            volume=link.mass / DENSITY,
            centre_of_buoyancy=link.centre_of_mass,
            strips=(strip(link.centre_of_mass, radius, length, axis),),
        )
        for link, (radius, length, axis) in zip(chain.links, CYLINDERS, strict=True)
    )
    base = replace(
        chain.base,
        added_mass=ellipsoid_added_mass(np.array(SEMI_AXES), DENSITY),
        volume=VEHICLE_MASS / DENSITY,
        drag_area=np.full(3, SPHERE * math.pi * SEMI_AXES[1] ** 2),
    )
    return replace(chain, base=base, links=links, thrusters=thrusters())


def strip(centre: Array, radius: float, length: float, axis: int) -> Strip:
    half = length / 2.0 * np.eye(3)[axis]
    return Strip(centre - half, centre + half, 2.0 * radius, BASIC)


# ---- forms as the paper prints them --------------------------------------------------------------------------------


def spheroid_by_paper(a: float, b: float, *, printed: bool) -> tuple[float, float, float]:
    """A11, A22 and A55 over the mass of the water displaced, A55 for lengths in m, of a prolate spheroid by section 4.5.

    ``printed`` takes e = 1 - (b/a)^2; otherwise that is e^2 (erratum 1). Signs are those of an added mass (erratum 2).
    """
    e = 1.0 - (b / a) ** 2
    e = e if printed else math.sqrt(e)
    grown = math.log((1.0 + e) / (1.0 - e))
    alpha = 2.0 * (1.0 - e**2) / e**3 * (0.5 * grown - e)
    beta = 1.0 / e**2 - (1.0 - e**2) / (2.0 * e**3) * grown
    apart, both = b**2 - a**2, b**2 + a**2
    turning = 0.2 * apart**2 * (alpha - beta) / (2.0 * apart + both * (beta - alpha))
    return alpha / (2.0 - alpha), beta / (2.0 - beta), turning


def printed_matrices(q: Array) -> Array:
    """(3, 4, 4) A_0^1, A_1^2 and A_2^3 as section 4.2 prints them."""
    (c1, c2, c3), (s1, s2, s3) = np.cos(q), np.sin(q)
    return np.array([
        [[c1, 0, -s1, 0], [s1, 0, c1, 0], [0, -1, 0, 0], [0, 0, 0, 1]],
        [[c2, -s2, 0, 0.4318 * c2], [s2, c2, 0, 0.4318 * s2], [0, 0, 1, 0], [0, 0, 0, 1]],
        [[c3, 0, s3, -0.0191 * c3], [s3, 0, -c3, -0.0191 * s3], [0, 1, 0, 0.1505], [0, 0, 0, 1]],
    ])  # fmt: skip


def link_1_by_paper(q: float, speeds: Array, rates: Array) -> dict[str, Array]:
    """The printed expressions of link 1 in frame 0: p, w and v of section 4.2, alpha, and a once its brackets are repaired.

    The repair: what the text subtracts after ``v_y - (c_z0 - .3088) w_x`` belongs to the same v_y of the link, and likewise for
    v_x, so that w x v is whole in each component.
    """
    cx, _, cz = ATTACHMENT
    s, c = math.sin(q), math.cos(q)
    vx, vy, vz, wx, wy, wz, turn = (float(x) for x in speeds[:7])
    ax, ay, az, dx, dy, dz, turning = (float(x) for x in rates[:7])
    up, ahead, aside = cz - 0.3088, cx - 0.0389 * s, 0.0389 * c
    v = np.array([
        vx + up * wy - aside * wz - aside * turn,
        vy - up * wx + ahead * wz - 0.0389 * s * turn,
        vz + aside * wx - ahead * wy,
    ])  # fmt: skip
    a = np.array([
        wy * v[2] + 0.0389 * s * wz * turn + 0.0389 * s * turn**2 - wz * v[1] + ax + up * dy - aside * dz - aside * turning,
        -wx * v[2] - aside * wz * turn - aside * turn**2 + wz * v[0] + ay - up * dx + ahead * dz - 0.0389 * s * turning,
        -0.0389 * s * wx * turn + aside * wy * turn - wy * v[0] + wx * v[1] + az + aside * dx - ahead * dy,
    ])  # fmt: skip
    return {
        "p": np.array([ahead, aside, up]),
        "w": np.array([wx, wy, wz + turn]),
        "v": v,
        "alpha": np.array([-wy * wz + wy * (wz + turn) + dx, wx * wz - wx * (wz + turn) + dy, dz + turning]),
        "a": a,
    }

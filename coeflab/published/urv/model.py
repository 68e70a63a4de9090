"""The URV paper's example as geometry/urv_puma states it, and forms as the paper prints them, for the errata.

Printed: Denavit-Hartenberg matrices, centres of mass, masses and inertias of links 1 to 3 of the PUMA 560 (sections 4.2 and 4.3),
C_D = 1.1 of a cylinder. Chosen: the vehicle, since the paper's is generic, and the cylinders that stand for the links in water.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from coeflab.arm.arm_file import read_chain
from coeflab.arm.chain import Base, Chain, Joint, Link, Strip
from coeflab.arm.figures import hull_of
from coeflab.arm.kane import bias, partial_velocities, pose
from coeflab.arm.readers.arm import read
from coeflab.arm.thrusters import TorqueThruster, VoltageThruster
from coeflab.bodies.closed_forms.parts import cylinder_added_mass
from coeflab.core.files import shipped
from coeflab.core.types import Array

DENSITY = 1000.0
BASIC = 1.1  # C_D,basic of a cylinder, section 4.5
# Sections 4.2 and 4.3, as printed.
CENTRES = ((0.0, 0.3088, 0.0389), (-0.3289, 0.0050, 0.2038), (0.0204, 0.0137, 0.0037))
MASSES = (12.96, 22.37, 5.01)
INERTIAS = ((1.09809, 0.177381, 1.1112), (0.403567, 0.968405, 0.966379), (0.0746421, 0.0755015, 0.00749571))
# Worked out independently for the state of coeflab.published.urv.theory, with Pinocchio's to 1e-15 where there is no water.
MASS = (140.34, 140.34, 140.34, 16.111558, 37.02878, 39.383375, 2.703695, 2.226111, 0.075579)
FIRST_ROW = (0.0, 0.0, 0.0, 6.876421, -6.654255, -6.654255, 2.684943, 0.018592)
BIAS = (2.432883, 9.523231, 4.707274, 0.635088, -0.843423, -0.178441, -0.140057, -0.310209, 0.002126)
ADDED = (128.810058, 538.986349, 515.812717, 2.61593, 60.882072, 65.821531, 0.769471, 0.426749, 0.052083)
# Chosen: the vehicle of the paper is generic.
ATTACHMENT, VEHICLE_MASS = (0.5, 0.0, 0.2), 100.0
# Chosen: small thrusters, for the forms that the paper prints.
TORQUE = TorqueThruster(alpha=0.05, beta=50.0, thrust=0.02, strongest=5.0)  # those of geometry/urv_puma
VOLTAGE_DRIVE = 40.0
VOLTAGE = VoltageThruster(
    damping=5.0, drive=VOLTAGE_DRIVE, load=120.0, radius=0.1, pitch=0.5, lift=0.6, drag=0.4, column=0.15, momentum=1.0, strongest=48.0,
)  # fmt: skip
AREA = 0.236  # C_D S of the vehicle as a sphere, section 4.5: 0.47 pi (0.4 m)^2


@cache
def wet() -> Chain:
    """In water: spheroid and cylinders, drag, buoyancy equal to the weight, eight thrusters."""
    return read_chain(Path(str(shipped("geometry"))) / "urv_puma")


@cache
def hull() -> Array:
    """(3,) semi-axes of the vehicle, m."""
    return hull_of(read(Path(str(shipped("geometry"))) / "urv_puma" / "body.toml"))


@cache
def dry() -> Chain:
    """Vehicle and arm without water: what Pinocchio knows."""
    chain, none = wet(), np.zeros((6, 6))
    links = tuple(replace(link, strips=(), added_mass=none, volume=0.0) for link in chain.links)
    base = replace(chain.base, drag_area=np.zeros(3), added_mass=none, volume=0.0)
    return replace(chain, base=base, links=links, thrusters=())


def cylinder(radius: float, length: float, axis: int) -> Array:
    """(6, 6) added mass about its centre, nothing along it: ``cylinder_added_mass`` without its axial share, turned to the axis.

    The paper's own with k = rho pi r^2 L, about the centre (erratum 3).
    """
    entries = np.diag(cylinder_added_mass(radius, length, DENSITY)).copy()
    entries[0] = 0.0
    order = [axis, *(i for i in range(3) if i != axis)]
    out = np.zeros(6)
    out[order], out[[3 + i for i in order]] = entries[:3], entries[3:]
    return np.diag(out)


def swung(radius: float, length: float, added_mass: Array | None = None) -> Chain:
    """One cylinder along x, swung about its end at the centre of mass of a vehicle that no water holds."""
    middle = np.array([length / 2.0, 0.0, 0.0])
    strip = Strip(np.zeros(3), 2.0 * middle, 2.0 * radius, BASIC)
    water = cylinder(radius, length, 0) if added_mass is None else added_mass
    joint = Joint("q1", "revolute", 0.0, 0.0, 0.0, 0.0)
    link = Link("cylinder", joint, 5.0, middle, np.diag([0.01, 0.3, 0.3]), water, strips=(strip,))
    return Chain("swung", Base("vehicle", 100.0, np.diag([10.0, 20.0, 25.0])), (link,), np.zeros(3), density=DENSITY)


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


def a_1_as_printed(q: float, speeds: Array, rates: Array) -> tuple[float, float]:
    """The x component of a_1 with the brackets where the text has them, and what that is more than the repaired one.

    The text closes the bracket of w_z (...) after ``v_y - (c_z0 - .3088) w_x``; the rest of the link's v_y stands outside.
    """
    s = math.sin(q)
    _, vy, _, wx, _, wz, turn = (float(x) for x in speeds[:7])
    repaired = link_1_by_paper(q, speeds, rates)
    rest = (ATTACHMENT[0] - 0.0389 * s) * wz - 0.0389 * s * turn
    inside = vy - (ATTACHMENT[2] - 0.3088) * wx
    others = float(repaired["a"][0]) + wz * float(repaired["v"][1])
    return others - wz * inside + rest, (1.0 + wz) * rest


def cylinder_by_paper(radius: float, length: float, *, quarter: bool) -> Array:
    """(6, 6) I_A of section 4.5 for an axis along x: diag(0, k, k, 0, k L^2/3, k L^2/3), with the printed k or four times that."""
    k = DENSITY * math.pi * radius**2 * length / (4.0 if quarter else 1.0)
    turning = k * length**2 / 3.0
    return np.diag([0.0, k, k, 0.0, turning, turning])


def bias_by_equation_16(chain: Chain, q: Array, speeds: Array) -> Array:
    """C with the term D (w_0 x w_j) that equation 16 has in T; for bodies whose added mass is diagonal."""
    at = pose(chain, q)
    turning = partial_velocities(chain, at)[:, 3:]
    out = bias(chain, q, speeds)
    for turn, water, partial in zip(at.rotation, chain.inertias[1], turning, strict=True):
        moment = turn @ water[3:, 3:] @ turn.T @ np.cross(speeds[3:6], partial @ speeds)
        out = out - partial.T @ moment
    return out


def drag_by_equation_21(radius: float, length: float, v: Array, w: float) -> tuple[Array, Array]:
    """R and T of equation 21 as printed, for a cylinder along x whose start moves at v and that turns by w about z.

    C_D has its sin^2(sigma), and T is about the start, not about the centre of mass.
    """
    nodes, weights = np.polynomial.legendre.leggauss(16)
    force, moment = np.zeros(3), np.zeros(3)
    for node, weight in zip((1.0 + nodes) / 2.0 * length, weights / 2.0 * length, strict=True):
        here = v + np.array([0.0, w * node, 0.0])
        across = here * [0.0, 1.0, 1.0]
        coefficient = BASIC * float(across @ across) / float(here @ here)
        push = -0.5 * DENSITY * coefficient * 2.0 * radius * float(np.linalg.norm(across)) * across * weight
        force += push
        moment += np.cross([node, 0.0, 0.0], push)
    return force, moment


def equation_23(axes: Array, torques: Array) -> Array:
    """(3,) moment on the vehicle that equation 23 gives joint torques: the sum of tau_j z_(j-1), without the reactions."""
    return np.asarray(axes.T @ torques)


def turn_by_paper(angles: Array) -> Array:
    """(3, 3) turn of equation 28, as printed: from axes with z down to north, east, down."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(angles), np.sin(angles)
    return np.array([
        [cy * cp, cy * sr * sp - cr * sy, cr * cy * sp + sr * sy],
        [cp * sy, sr * sy * sp + cr * cy, cr * sy * sp - cy * sr],
        [-sp, cp * sr, cr * cp],
    ])  # fmt: skip


def euler_rates(angles: Array, w: Array, *, printed: bool = False) -> Array:
    """(3,) rates of roll, pitch and yaw by equation 29; ``printed`` has cos(theta) in its second row (erratum 7)."""
    roll, pitch, _ = angles
    (s, c), t = (math.sin(roll), math.cos(roll)), math.tan(pitch)
    second = math.cos(pitch) if printed else c
    return np.array([[1.0, s * t, c * t], [0.0, second, -s], [0.0, s / math.cos(pitch), c / math.cos(pitch)]]) @ w

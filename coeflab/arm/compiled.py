"""Kane's equations of `coeflab.arm.kane`, compiled by numba: the same numbers to rounding, a thousand times quicker.

Body by body: the vehicle, then the links from it outwards. Forces and moments about the centre of mass of each body are summed
into generalised forces by its partial velocities, those of the first six speeds and of the joints before it.

Only imported where numba is installed and wanted. The machine code is kept between runs.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from coeflab.arm.chain import STILL, Chain, Flow
from coeflab.core.types import Array
from coeflab.law.rigid_body import axes_in_earth, kinematics

jitted = numba.njit(cache=True, error_model="numpy")
_axes_in_earth, _kinematics = jitted(axes_in_earth), jitted(kinematics)
# Columns of a body's row: joint, centre of mass, mass, inertia, inertia of the water, displaced mass, centre of buoyancy.
TURNS, A, COS, SIN, D, THETA, CENTRE, MASS, INERTIA, WATER, DISPLACED, LIFTED, WIDTH = (
    0, 1, 2, 3, 4, 5, 6, 9, 10, 19, 55, 56, 59,
)  # fmt: skip
# Frame: mount, attachment, gravity, 1/2 rho C_D S of the vehicle.
ATTACHED, GRAVITY, BLUNT, FRAME = 9, 12, 13, 16
# Work space: rotation, centre, origin, pivot, axis of each body.
CENTRED, ORIGIN, PIVOT, AXIS, POSE = 9, 12, 15, 18, 21
Packed = tuple[Array, Array, Array]


def packed(chain: Chain) -> Packed:
    """The numbers of a chain: frame (16,), bodies (n + 1, 59) and nodes of strips (k, 8)."""
    frame = np.concatenate(
        [chain.mount.ravel(), chain.attachment, [chain.gravity], 0.5 * chain.density * chain.base.drag_area]
    )
    bodies = np.zeros((chain.count + 1, WIDTH))
    (rigid, water), (volumes, lifted) = chain.inertias, chain.displaced
    bodies[:, MASS], bodies[:, DISPLACED] = rigid[:, 0, 0], chain.density * volumes
    bodies[:, INERTIA:WATER], bodies[:, LIFTED:] = rigid[:, 3:, 3:].reshape(-1, 9), lifted
    bodies[:, WATER:DISPLACED] = water.reshape(-1, 36)
    for row, link in zip(bodies[1:], chain.links, strict=True):
        j = link.joint
        row[:CENTRE] = j.turns, j.a, np.cos(j.alpha), np.sin(j.alpha), j.d, j.theta
        row[CENTRE:MASS] = link.centre_of_mass
    body, place, axis, factor = chain.strip_points
    nodes = np.column_stack([body, place, axis, factor])
    return frame, bodies, np.ascontiguousarray(nodes)


@jitted
def _pose(frame: Array, bodies: Array, q: Array, out: Array) -> None:
    """Rotation, centre, origin, pivot and axis of every body into ``out`` (n + 1, 21)."""
    for i in range(POSE):
        out[0, i] = 0.0
    out[0, 0] = out[0, 4] = out[0, 8] = 1.0
    for j in range(1, len(bodies)):
        b, here = bodies[j], out[j]
        turned = b[TURNS] != 0.0
        theta = b[THETA] + (q[j - 1] if turned else 0.0)
        d = b[D] + (0.0 if turned else q[j - 1])
        ct, st, ca, sa = math.cos(theta), math.sin(theta), b[COS], b[SIN]
        for i in range(3):
            if j == 1:
                x, y, z, o = frame[3 * i], frame[3 * i + 1], frame[3 * i + 2], frame[ATTACHED + i]
            else:
                x, y, z, o = out[j - 1, 3 * i], out[j - 1, 3 * i + 1], out[j - 1, 3 * i + 2], out[j - 1, ORIGIN + i]
            ahead, aside = x * ct + y * st, y * ct - x * st
            here[3 * i], here[3 * i + 1], here[3 * i + 2] = ahead, aside * ca + z * sa, z * ca - aside * sa
            here[PIVOT + i], here[AXIS + i], here[ORIGIN + i] = o, z, o + z * d + b[A] * ahead
        for i in range(3):
            here[CENTRED + i] = here[ORIGIN + i] + (
                here[3 * i] * b[CENTRE] + here[3 * i + 1] * b[CENTRE + 1] + here[3 * i + 2] * b[CENTRE + 2]
            )


@jitted
def _cross(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> tuple[float, float, float]:
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@jitted
def _into(r: Array, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Along the body's own axes."""
    return r[0] * x + r[3] * y + r[6] * z, r[1] * x + r[4] * y + r[7] * z, r[2] * x + r[5] * y + r[8] * z


@jitted
def _out_of(r: Array, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Along the vehicle's axes."""
    return r[0] * x + r[1] * y + r[2] * z, r[3] * x + r[4] * y + r[5] * z, r[6] * x + r[7] * y + r[8] * z


@jitted
def _mass(bodies: Array, at: Array, out: Array) -> None:
    """M into ``out`` (6 + n, 6 + n)."""
    count = len(bodies)
    size = 5 + count
    own, moved = np.empty((size, 6)), np.empty(6)
    for i in range(size):
        for k in range(size):
            out[i, k] = 0.0
    for j in range(count):
        b, here = bodies[j], at[j]
        px, py, pz = here[CENTRED], here[CENTRED + 1], here[CENTRED + 2]
        for k in range(6 + j):
            vx = vy = vz = wx = wy = wz = 0.0
            if k < 3:
                vx, vy, vz = 1.0 if k == 0 else 0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0
            elif k < 6:
                wx, wy, wz = 1.0 if k == 3 else 0.0, 1.0 if k == 4 else 0.0, 1.0 if k == 5 else 0.0
                vx, vy, vz = _cross(wx, wy, wz, px, py, pz)
            else:
                joint = at[k - 5]
                x, y, z = joint[AXIS], joint[AXIS + 1], joint[AXIS + 2]
                if bodies[k - 5, TURNS] != 0.0:
                    wx, wy, wz = x, y, z
                    vx, vy, vz = _cross(x, y, z, px - joint[PIVOT], py - joint[PIVOT + 1], pz - joint[PIVOT + 2])
                else:
                    vx, vy, vz = x, y, z
            own[k, 0], own[k, 1], own[k, 2] = _into(here, vx, vy, vz)
            own[k, 3], own[k, 4], own[k, 5] = _into(here, wx, wy, wz)
        for k in range(6 + j):
            for i in range(6):
                total = b[MASS] * own[k, i] if i < 3 else 0.0
                for m in range(6):
                    total += b[WATER + 6 * i + m] * own[k, m]
                if i >= 3:
                    for m in range(3):
                        total += b[INERTIA + 3 * (i - 3) + m] * own[k, 3 + m]
                moved[i] = total
            for i in range(k + 1):
                total = 0.0
                for m in range(6):
                    total += own[i, m] * moved[m]
                out[i, k] += total
    for i in range(size):
        for k in range(i):
            out[i, k] = out[k, i]


@jitted
def _project(bodies: Array, at: Array, wrench: Array, out: Array) -> None:
    """Generalised forces into ``out`` (6 + n,) of forces and moments about the centres of mass (n + 1, 6)."""
    for k in range(len(out)):
        out[k] = 0.0
    for j in range(len(bodies)):
        here, f = at[j], wrench[j]
        px, py, pz = here[CENTRED], here[CENTRED + 1], here[CENTRED + 2]
        mx, my, mz = _cross(px, py, pz, f[0], f[1], f[2])
        out[0] += f[0]
        out[1] += f[1]
        out[2] += f[2]
        out[3] += f[3] + mx
        out[4] += f[4] + my
        out[5] += f[5] + mz
        for k in range(1, j + 1):
            joint = at[k]
            x, y, z = joint[AXIS], joint[AXIS + 1], joint[AXIS + 2]
            if bodies[k, TURNS] != 0.0:
                mx, my, mz = _cross(px - joint[PIVOT], py - joint[PIVOT + 1], pz - joint[PIVOT + 2], f[0], f[1], f[2])
                out[5 + k] += x * (f[3] + mx) + y * (f[4] + my) + z * (f[5] + mz)
            else:
                out[5 + k] += x * f[0] + y * f[1] + z * f[2]


@jitted
def _moving(frame: Array, bodies: Array, at: Array, s: Array, velocity: Array, rest: Array) -> None:
    """Velocities, and accelerations where no speed changes, of the centres of mass and bodies (n + 1, 6); equations 9 to 12."""
    wx, wy, wz = s[3], s[4], s[5]
    for i in range(6):
        velocity[0, i], rest[0, i] = s[i], 0.0
    rest[0, 0], rest[0, 1], rest[0, 2] = _cross(wx, wy, wz, s[0], s[1], s[2])
    # Velocity and acceleration of the point on the next joint's axis, angular acceleration.
    tx, ty, tz = _cross(wx, wy, wz, frame[ATTACHED], frame[ATTACHED + 1], frame[ATTACHED + 2])
    vx, vy, vz = s[0] + tx, s[1] + ty, s[2] + tz
    qx, qy, qz = _cross(wx, wy, wz, tx, ty, tz)
    gx, gy, gz = rest[0, 0] + qx, rest[0, 1] + qy, rest[0, 2] + qz
    ex = ey = ez = 0.0
    for j in range(1, len(bodies)):
        here = at[j]
        x, y, z = here[AXIS] * s[5 + j], here[AXIS + 1] * s[5 + j], here[AXIS + 2] * s[5 + j]
        tx, ty, tz = _cross(wx, wy, wz, x, y, z)
        if bodies[j, TURNS] != 0.0:
            ex, ey, ez = ex + tx, ey + ty, ez + tz
            wx, wy, wz = wx + x, wy + y, wz + z
        else:
            gx, gy, gz = gx + 2.0 * tx, gy + 2.0 * ty, gz + 2.0 * tz
            vx, vy, vz = vx + x, vy + y, vz + z
        velocity[j, 3], velocity[j, 4], velocity[j, 5] = wx, wy, wz
        rest[j, 3], rest[j, 4], rest[j, 5] = ex, ey, ez
        for reach in (CENTRED, ORIGIN):
            lx, ly, lz = here[reach] - here[PIVOT], here[reach + 1] - here[PIVOT + 1], here[reach + 2] - here[PIVOT + 2]
            tx, ty, tz = _cross(wx, wy, wz, lx, ly, lz)
            qx, qy, qz = _cross(wx, wy, wz, tx, ty, tz)
            lx, ly, lz = _cross(ex, ey, ez, lx, ly, lz)
            if reach == CENTRED:
                velocity[j, 0], velocity[j, 1], velocity[j, 2] = vx + tx, vy + ty, vz + tz
                rest[j, 0], rest[j, 1], rest[j, 2] = gx + lx + qx, gy + ly + qy, gz + lz + qz
            else:
                vx, vy, vz = vx + tx, vy + ty, vz + tz
                gx, gy, gz = gx + lx + qx, gy + ly + qy, gz + lz + qz


@jitted
def _inertia_wrench(bodies: Array, at: Array, velocity: Array, rest: Array, water: Array, out: Array) -> None:
    """Forces and moments (n + 1, 6) that no change of the speeds takes; equations 13 and 15.

    ``water`` (6,): velocity and acceleration of the water along the vehicle's axes.
    """
    p, push, rel, spin = np.empty(6), np.empty(6), np.empty(6), np.empty(6)
    for j in range(len(bodies)):
        b, here, v, a = bodies[j], at[j], velocity[j], rest[j]
        # Along the body's own axes, where the inertia of the water does not change.
        wx, wy, wz = _into(here, v[3], v[4], v[5])
        rel[3], rel[4], rel[5] = wx, wy, wz
        rel[0], rel[1], rel[2] = _into(here, v[0] - water[0], v[1] - water[1], v[2] - water[2])
        push[3], push[4], push[5] = _into(here, a[3], a[4], a[5])
        tx, ty, tz = _cross(wx, wy, wz, rel[0], rel[1], rel[2])
        x, y, z = _into(here, a[0] - water[3], a[1] - water[4], a[2] - water[5])
        push[0], push[1], push[2] = x - tx, y - ty, z - tz
        for i in range(6):
            momentum = pushed = 0.0
            for m in range(6):
                momentum += b[WATER + 6 * i + m] * rel[m]
                pushed += b[WATER + 6 * i + m] * push[m]
            p[i], spin[i] = momentum, pushed
        x, y, z = _into(here, a[0], a[1], a[2])
        spin[0] += b[MASS] * x
        spin[1] += b[MASS] * y
        spin[2] += b[MASS] * z
        tx, ty, tz = _cross(wx, wy, wz, p[0], p[1], p[2])
        out[j, 0], out[j, 1], out[j, 2] = _out_of(here, spin[0] + tx, spin[1] + ty, spin[2] + tz)
        for i in range(3):
            for m in range(3):
                p[3 + i] += b[INERTIA + 3 * i + m] * rel[3 + m]
                spin[3 + i] += b[INERTIA + 3 * i + m] * push[3 + m]
        tx, ty, tz = _cross(wx, wy, wz, p[3], p[4], p[5])
        x, y, z = _cross(rel[0], rel[1], rel[2], p[0], p[1], p[2])
        out[j, 3], out[j, 4], out[j, 5] = _out_of(here, spin[3] + tx + x, spin[4] + ty + y, spin[5] + tz + z)


@jitted
def _load(
    frame: Array, bodies: Array, nodes: Array, at: Array, velocity: Array, down: Array, water: Array, out: Array
) -> None:
    """Add weight, buoyancy, fluid acceleration and drag to the forces and moments (n + 1, 6); equations 14 and 19 to 22."""
    g = frame[GRAVITY]
    for j in range(len(bodies)):
        b, here = bodies[j], at[j]
        lx, ly, lz = b[LIFTED], b[LIFTED + 1], b[LIFTED + 2]
        lx, ly, lz = _out_of(here, lx, ly, lz)
        lx, ly, lz = (
            lx + here[ORIGIN] - here[CENTRED],
            ly + here[ORIGIN + 1] - here[CENTRED + 1],
            lz + here[ORIGIN + 2] - here[CENTRED + 2],
        )
        m = b[DISPLACED]
        fx, fy, fz = m * (water[3] - g * down[0]), m * (water[4] - g * down[1]), m * (water[5] - g * down[2])
        tx, ty, tz = _cross(lx, ly, lz, fx, fy, fz)
        out[j, 0] += fx + b[MASS] * g * down[0]
        out[j, 1] += fy + b[MASS] * g * down[1]
        out[j, 2] += fz + b[MASS] * g * down[2]
        out[j, 3] += tx
        out[j, 4] += ty
        out[j, 5] += tz
    x, y, z = velocity[0, 0] - water[0], velocity[0, 1] - water[1], velocity[0, 2] - water[2]
    speed = math.sqrt(x * x + y * y + z * z)
    out[0, 0] -= frame[BLUNT] * speed * x
    out[0, 1] -= frame[BLUNT + 1] * speed * y
    out[0, 2] -= frame[BLUNT + 2] * speed * z
    for k in range(len(nodes)):
        node = nodes[k]
        j = int(node[0])
        here, v = at[j], velocity[j]
        lx, ly, lz = _out_of(here, node[1], node[2], node[3])
        lx, ly, lz = (
            lx + here[ORIGIN] - here[CENTRED],
            ly + here[ORIGIN + 1] - here[CENTRED + 1],
            lz + here[ORIGIN + 2] - here[CENTRED + 2],
        )
        ax, ay, az = _out_of(here, node[4], node[5], node[6])
        tx, ty, tz = _cross(v[3], v[4], v[5], lx, ly, lz)
        x, y, z = v[0] + tx - water[0], v[1] + ty - water[1], v[2] + tz - water[2]
        along = x * ax + y * ay + z * az
        x, y, z = x - along * ax, y - along * ay, z - along * az
        factor = -node[7] * math.sqrt(x * x + y * y + z * z)
        x, y, z = factor * x, factor * y, factor * z
        tx, ty, tz = _cross(lx, ly, lz, x, y, z)
        out[j, 0] += x
        out[j, 1] += y
        out[j, 2] += z
        out[j, 3] += tx
        out[j, 4] += ty
        out[j, 5] += tz


@jitted
def mass_matrix(frame: Array, bodies: Array, q: Array) -> Array:
    """M, as `coeflab.arm.kane.mass_matrix`."""
    at = np.empty((len(bodies), POSE))
    out = np.empty((5 + len(bodies), 5 + len(bodies)))
    _pose(frame, bodies, q, at)
    _mass(bodies, at, out)
    return out


@jitted
def bias(frame: Array, bodies: Array, q: Array, s: Array, water: Array) -> Array:
    """C, as `coeflab.arm.kane.bias`; ``water`` (6,) is its velocity and acceleration along the vehicle's axes."""
    count = len(bodies)
    at, out = np.empty((count, POSE)), np.empty(5 + count)
    velocity, rest, wrench = np.empty((count, 6)), np.empty((count, 6)), np.empty((count, 6))
    _pose(frame, bodies, q, at)
    _moving(frame, bodies, at, s, velocity, rest)
    _inertia_wrench(bodies, at, velocity, rest, water, wrench)
    _project(bodies, at, wrench, out)
    return out


@jitted
def _solved(m: Array, b: Array) -> None:
    """The solution of m x = b into ``b``, by Cholesky's factors in the lower half of ``m``; no number where there are none."""
    n = len(b)
    for i in range(n):
        for k in range(i + 1):
            total = m[i, k]
            for j in range(k):
                total -= m[i, j] * m[k, j]
            m[i, k] = math.sqrt(total) if i == k else total / m[k, k]
    for i in range(n):
        for j in range(i):
            b[i] -= m[i, j] * b[j]
        b[i] /= m[i, i]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            b[i] -= m[j, i] * b[j]
        b[i] /= m[i, i]


@jitted
def equations(frame: Array, bodies: Array, nodes: Array, state: Array, flow: Array) -> tuple[Array, Array]:
    """M, and all forces but control less C (6 + n,), at a state of `coeflab.arm.kane.right_hand_side`.

    ``flow`` (6,): velocity and acceleration of the water, NED.
    """
    count = len(bodies)
    n = count - 1
    axes = _axes_in_earth(state[3], state[4], state[5], state[6])
    water, down = np.empty(6), np.empty(3)
    for i in range(3):
        x, y, z = axes[3 * i], axes[3 * i + 1], axes[3 * i + 2]
        down[i] = z
        water[i] = x * flow[0] + y * flow[1] + z * flow[2]
        water[3 + i] = x * flow[3] + y * flow[4] + z * flow[5]
    at = np.empty((count, POSE))
    velocity, rest, wrench = np.empty((count, 6)), np.empty((count, 6)), np.empty((count, 6))
    m, force = np.empty((6 + n, 6 + n)), np.empty(6 + n)
    q, s = state[7 : 7 + n], state[7 + n : 13 + 2 * n]
    _pose(frame, bodies, q, at)
    _mass(bodies, at, m)
    _moving(frame, bodies, at, s, velocity, rest)
    _inertia_wrench(bodies, at, velocity, rest, water, wrench)
    for j in range(count):
        for i in range(6):
            wrench[j, i] = -wrench[j, i]
    _load(frame, bodies, nodes, at, velocity, down, water, wrench)
    _project(bodies, at, wrench, force)
    return m, force


@jitted
def rates(frame: Array, bodies: Array, nodes: Array, state: Array, control: Array, flow: Array) -> Array:
    """(13 + 2 n,) as `coeflab.arm.kane.right_hand_side`."""
    n = len(bodies) - 1
    m, force = equations(frame, bodies, nodes, state, flow)
    for i in range(6 + n):
        force[i] += control[i]
    _solved(m, force)
    s = state[7 + n :]
    axes = _axes_in_earth(state[3], state[4], state[5], state[6])
    moved = _kinematics(axes, state[3], state[4], state[5], state[6], s[0], s[1], s[2], s[3], s[4], s[5])
    out = np.empty(13 + 2 * n)
    for i in range(7):
        out[i] = moved[i]
    for i in range(n):
        out[7 + i] = s[6 + i]
    for i in range(6 + n):
        out[7 + n + i] = force[i]
    return out


def right_hand_side(chain: Chain, state: Array, control: Array, flow: Flow = STILL) -> Array:
    """As `coeflab.arm.kane.right_hand_side`."""
    moving = np.concatenate([flow.velocity, flow.acceleration])
    out: Array = rates(*packed(chain), state, control, moving)
    return out

"""Kane's equations of a vehicle with an arm, numerically, for any chain of revolute and prismatic joints.

M(q) s' + C(q, s) = F: `mass_matrix`, `bias`, and generalised active forces `weight`, `buoyancy`, `fluid_acceleration` and `drag`, each
(6 + n,) in the order of the generalised speeds s. All of these forces act on the right-hand side, so that the paper's G is -weight and
its F_external is -(buoyancy + fluid_acceleration + drag) (equation 25 of the URV paper, whose equations are meant throughout).

Vectors are along the vehicle's axes, FRD, and from its centre of mass, unless a line says otherwise. What numba compiles of the same
equations is `coeflab.arm.compiled`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coeflab.arm.chain import STILL, Chain, Flow
from coeflab.core.types import Array, brief
from coeflab.law.rigid_body import axes_in_earth, kinematics
from coeflab.law.transforms import denavit_hartenberg

ZERO = np.zeros(3)


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """Where every body of a chain is at joint positions q: the vehicle first, then the links.

    Attributes
    ----------
    rotation : (n + 1, 3, 3) array
        From the body's axes to the vehicle's.
    centre : (n + 1, 3) array
        p_j, its centre of mass, m (equation 8).
    axis, pivot : (n, 3) array
        z_(j-1), direction of the joint, and a point on it, m: the origin of frame j - 1.
    origin : (n + 1, 3) array
        Of frame j, m; the vehicle's is its centre of mass.
    end : (3,) array
        End effector, m.
    """

    rotation: Array
    centre: Array
    axis: Array
    pivot: Array
    origin: Array
    end: Array


def cross(a: Array, b: Array) -> Array:
    """Product a x b along the last axis, several times quicker than numpy's on a few vectors."""
    ax, ay, az, bx, by, bz = a[..., 0], a[..., 1], a[..., 2], b[..., 0], b[..., 1], b[..., 2]
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


def pose(chain: Chain, q: Array) -> Pose:
    """Poses of all bodies at joint positions ``q`` (n,), rad or m (equation 8; the mount stands before A_0^1)."""
    turn, place = np.array(chain.mount), np.array(chain.attachment)
    turns, centres, origins, axes, pivots = [np.eye(3)], [ZERO], [ZERO], [], []
    for link, at in zip(chain.links, q, strict=True):
        joint = link.joint
        axes.append(turn[:, 2])
        pivots.append(place)
        angle, travel = (at, 0.0) if joint.turns else (0.0, at)
        inner, shift = denavit_hartenberg(joint.theta + angle, joint.d + travel, joint.a, joint.alpha)
        place, turn = place + turn @ shift, turn @ inner
        turns.append(turn)
        origins.append(place)
        centres.append(place + turn @ link.centre_of_mass)
    end = place + turn @ chain.tool
    axis, pivot = np.array(axes).reshape(-1, 3), np.array(pivots).reshape(-1, 3)
    return Pose(np.array(turns), np.array(centres), axis, pivot, np.array(origins), end)


def partial_velocities(chain: Chain, at: Pose, places: Array | None = None) -> Array:
    """(n + 1, 6, 6 + n) partial velocities of every body, linear above angular (equations 3 and 4).

    Parameters
    ----------
    chain : Chain
    at : Pose
    places : (n + 1, 3) array, optional
        Points fixed in the bodies; their centres of mass unless given.
    """
    places = at.centre if places is None else places
    out = np.zeros((chain.count + 1, 6, chain.size))
    out[:, :3, :3] = out[:, 3:, 3:6] = np.eye(3)
    x, y, z = places.T
    out[:, 0, 4], out[:, 0, 5], out[:, 1, 3] = z, -y, -z
    out[:, 1, 5], out[:, 2, 3], out[:, 2, 4] = x, y, -x
    for k, joint in enumerate(chain.joints):
        moved = slice(k + 1, None)
        if joint.turns:
            out[moved, :3, 6 + k] = cross(at.axis[k], places[moved] - at.pivot[k])
            out[moved, 3:, 6 + k] = at.axis[k]
        else:
            out[moved, :3, 6 + k] = at.axis[k]
    return out


def mass_matrix(chain: Chain, q: Array) -> Array:
    """M, (6 + n, 6 + n): minus the coefficients of the accelerations in equations 13 and 18.

    Added mass is positive here; the paper prints the entries of I_A negative, which equation 15 does not take (erratum 2).
    """
    at = pose(chain, q)
    own = _in_own_axes(at, partial_velocities(chain, at))
    return np.asarray(np.sum(np.swapaxes(own, 1, 2) @ (chain.inertias[0] + chain.inertias[1]) @ own, axis=0))


def bias(chain: Chain, q: Array, speeds: Array, current: Array = ZERO, acceleration: Array = ZERO) -> Array:
    """C, (6 + n,): what is left of minus equations 13 and 18 where no generalised speed changes.

    Inertia by equations 9 to 13. Added mass by equation 15 in each body's own frame, where it holds (erratum 4: equation 16
    turns it to frame 0 with w_0 x w_j in the place of w_j x w_j = 0): R = -A (a - w x v) - w x A v, T = -D alpha - w x D w -
    v x A v, with v and a relative to the water (equation 17).

    Parameters
    ----------
    chain : Chain
    q : (n,) array
    speeds : (6 + n,) array
    current, acceleration : (3,) array
        Of the water, along the vehicle's axes, m/s and m/s^2, both seen from the earth.
    """
    at = pose(chain, q)
    partial = partial_velocities(chain, at)
    turn = np.swapaxes(at.rotation, 1, 2)
    moving = partial @ speeds
    rest = _bias_accelerations(chain, at, speeds)
    v, w, a, alpha = (
        np.einsum("bij,bj->bi", turn, x) for x in (moving[:, :3], moving[:, 3:], rest[:, :3], rest[:, 3:])
    )
    through = v - turn @ current
    changing = a - turn @ acceleration - cross(w, through)
    rigid, added = chain.inertias
    mass, inertia = rigid[:, 0, 0][:, None], rigid[:, 3:, 3:]
    spin = np.einsum("bij,bj->bi", inertia, w)
    force = mass * a
    moment = np.einsum("bij,bj->bi", inertia, alpha) + cross(w, spin)
    pushed = np.einsum("bij,bj->bi", added, np.hstack([changing, alpha]))
    momentum = np.einsum("bij,bj->bi", added, np.hstack([through, w]))
    p, h = momentum[:, :3], momentum[:, 3:]
    force += pushed[:, :3] + cross(w, p)
    moment += pushed[:, 3:] + cross(w, h) + cross(through, p)
    return np.asarray(np.einsum("bik,bi->k", _in_own_axes(at, partial), np.hstack([force, moment])))


def _in_own_axes(at: Pose, partial: Array) -> Array:
    """Partial velocities along the bodies' own axes."""
    turn = np.swapaxes(at.rotation, 1, 2)
    return np.concatenate([turn @ partial[:, :3], turn @ partial[:, 3:]], axis=1)


def _bias_accelerations(chain: Chain, at: Pose, speeds: Array) -> Array:
    """(n + 1, 6) accelerations of the centres of mass and of the bodies where no speed changes (equations 11 and 12)."""
    v, w = speeds[:3], speeds[3:6]
    out = np.zeros((chain.count + 1, 6))
    out[0, :3] = cross(w, v)
    turning, place = np.zeros(3), out[0, :3] + cross(w, cross(w, chain.attachment))
    for k, joint in enumerate(chain.joints):
        along = at.axis[k] * speeds[6 + k]
        if joint.turns:
            turning = turning + cross(w, along)
            w = w + along
        else:
            place = place + 2.0 * cross(w, along)
        arm, reach = at.origin[k + 1] - at.pivot[k], at.centre[k + 1] - at.pivot[k]
        out[k + 1, :3] = place + cross(turning, reach) + cross(w, cross(w, reach))
        out[k + 1, 3:] = turning
        place = place + cross(turning, arm) + cross(w, cross(w, arm))
    return out


def weight(chain: Chain, q: Array, down: Array) -> Array:
    """(6 + n,) generalised force of the weight (equation 14); ``down`` (3,) is a unit vector along the vehicle's axes."""
    at = pose(chain, q)
    masses = chain.inertias[0][:, 0, 0]
    linear = partial_velocities(chain, at)[:, :3]
    return np.asarray(np.einsum("b,bik,i->k", masses, linear, chain.gravity * down))


def _displaced(chain: Chain, q: Array, upon_mass: Array) -> Array:
    """(6 + n,) generalised force of ``upon_mass`` (3,), m/s^2, on the water that every body displaces, at its centre of buoyancy."""
    at = pose(chain, q)
    volumes, centres = chain.displaced
    places = at.origin + np.einsum("bij,bj->bi", at.rotation, centres)
    linear = partial_velocities(chain, at, places)[:, :3]
    return np.asarray(np.einsum("b,bik,i->k", chain.density * volumes, linear, upon_mass))


def buoyancy(chain: Chain, q: Array, down: Array) -> Array:
    """(6 + n,) generalised force of buoyancy, at the centres of buoyancy (equation 19, which puts it at the centres of mass)."""
    return _displaced(chain, q, -chain.gravity * down)


def fluid_acceleration(chain: Chain, q: Array, acceleration: Array) -> Array:
    """(6 + n,) generalised force of water that accelerates by ``acceleration`` (3,), along the vehicle's axes (equation 20)."""
    return _displaced(chain, q, acceleration)


def drag(chain: Chain, q: Array, speeds: Array, current: Array = ZERO) -> Array:
    """(6 + n,) generalised force of profile drag (equations 21 and 22), strips by Gauss's rule of 12 points.

    Every strip drags across its own axis (erratum 8) by 1/2 rho C_D d |v| v, v its velocity across through the water, with no further
    sin^2 (erratum 5); moments are about the centre of mass where the force acts (erratum 5). The vehicle drags by -1/2 rho C_D S |v| v
    (erratum 7).
    """
    at = pose(chain, q)
    partial = partial_velocities(chain, at)
    moving = partial @ speeds
    through = speeds[:3] - current
    force = np.zeros((chain.count + 1, 6))
    force[0, :3] = -0.5 * chain.density * chain.base.drag_area * np.linalg.norm(through) * through
    body, places, axes, factors = chain.strip_points
    turn = at.rotation[body]
    arm = np.einsum("kij,kj->ki", turn, places) + at.origin[body] - at.centre[body]
    along = np.einsum("kij,kj->ki", turn, axes)
    flow = moving[body, :3] + cross(moving[body, 3:], arm) - current
    across = flow - np.sum(flow * along, axis=1)[:, None] * along
    push = -(factors * np.linalg.norm(across, axis=1))[:, None] * across
    np.add.at(force, body, np.hstack([push, cross(arm, push)]))
    return np.asarray(np.einsum("bik,bi->k", partial, force))


def external(chain: Chain, q: Array, speeds: Array, attitude: Array, flow: Flow = STILL) -> Array:
    """(6 + n,) all forces but control: weight, buoyancy, fluid acceleration and drag (equations 14 and 19 to 22).

    Parameters
    ----------
    chain : Chain
    q : (n,) array
    speeds : (6 + n,) array
    attitude : (4,) array
        Unit quaternion, body to NED, scalar first.
    flow : Flow
    """
    turn = np.reshape(axes_in_earth(*attitude), (3, 3))
    down, current, acceleration = turn[:, 2], turn @ flow.velocity, turn @ flow.acceleration
    pushed = weight(chain, q, down) + _displaced(chain, q, acceleration - chain.gravity * down)
    return np.asarray(pushed + drag(chain, q, speeds, current))


def equations(chain: Chain, state: Array, flow: Flow = STILL) -> tuple[Array, Array]:
    """M, and all forces but control less C, (6 + n,), at a state of `right_hand_side` (equations 24 and 25)."""
    n = chain.count
    attitude, q, speeds = state[3:7], state[7 : 7 + n], state[7 + n : 13 + 2 * n]
    turn = np.reshape(axes_in_earth(*attitude), (3, 3))
    rest = bias(chain, q, speeds, turn @ flow.velocity, turn @ flow.acceleration)
    return mass_matrix(chain, q), external(chain, q, speeds, attitude, flow) - rest


def right_hand_side(chain: Chain, state: Array, control: Array, flow: Flow = STILL) -> Array:
    """(13 + 2 n,) rates of a state: position (NED), quaternion, joint positions, generalised speeds.

    The quaternion takes the place of equation 28, which maps frame 0 without diag(1, -1, -1), and of equation 29, whose entry (2, 2)
    is cos(phi) and which is singular at a pitch of 90 deg (erratum 7).

    Parameters
    ----------
    chain : Chain
    state : (13 + 2 n,) array
    control : (6 + n,) array
        R_0, T_0 on the vehicle at its centre of mass and tau_j on qdot_j alone: link j - 1 takes the reaction, which equation 23
        leaves out (erratum 6).
    flow : Flow
    """
    n = chain.count
    m, force = equations(chain, state, flow)
    out = np.empty_like(state)
    out[: 7 + n] = displacement_rates(n, state)
    out[7 + n :] = np.linalg.solve(m, force + control)
    return out


def displacement_rates(count: int, state: Array) -> Array:
    """(7 + n,) rates of position, quaternion and joint positions; see `right_hand_side`."""
    attitude, speeds = state[3:7].tolist(), state[7 + count : 13 + 2 * count].tolist()
    return np.array([*kinematics(axes_in_earth(*attitude), *attitude, *speeds[:6])[:7], *speeds[6:]])


def end_in_earth(chain: Chain, state: Array) -> Array:
    """(3,) end effector, NED, m: equations 26 and 27, with diag(1, -1, -1) between NED and frame 0 (erratum 7)."""
    at = pose(chain, state[7 : 7 + chain.count])
    return np.asarray(state[:3] + at.end @ np.reshape(axes_in_earth(*state[3:7]), (3, 3)))

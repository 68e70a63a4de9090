"""Motion of a glider in space: kinematics, momenta, a roller, two thrusters, and the spiral (equations 8 to 13 of the THAUV paper).

Kirchhoff's equations for the momenta P and H of body, fluid and pistons about the reference point, FRD axes, k the vertical
(downward) in body axes; in the vertical plane they are those of `coeflab.glider.motion`::

    b_dot = R v        R_dot = R w^                 P = M v + p        H = J w + r_p x p        p = m_p (v + w x r_p + r_p_dot)
    P_dot = P x w + m0 g k + F_ext                  H_dot = H x w + P x v + S x k + tau_ext

Written out with u_p = p_dot they are equations 12 and 13, but for S. The paper has the pistons' weight alone in equation 12;
S = g (m r_CG - m_B r_CB) holds every mass and the buoyancy (equations 2 to 7), as its equation 19 does, for without it the
roller does nothing. Forces: drag along, side force and lift across the velocity, alpha = atan2(w, u), beta = asin(v / V)::

    L, D, M as in the vertical plane        side force = -K_S beta V^2
    roll    = -roll_damping V p             yaw        =  K_Y beta V^2 - yaw_damping V r       and the Munk moments P x v

The paper prints nothing of the motion to the side: `Lateral` and `Thrusters` are assumed, and their files say so.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from coeflab.core import declarations as takes
from coeflab.core.types import Array, brief
from coeflab.glider.masses import MassModel
from coeflab.glider.motion import GliderBody, Leg, Rates, Setting
from coeflab.law.transforms import skew

Force = Annotated[float, takes.number_in("force")]
IN_SPACE = ("north", "depth", "east", "q0", "q1", "q2", "q3", "P1", "P2", "P3", "H1", "H2", "H3")
STEPS, FOUND, NUDGE = 12, 1e-9, 1e-5
STILL = Setting(0.0, 0.0)


@brief
@dataclass(frozen=True, slots=True)
class Lateral(takes.Declaration):
    """What moves a glider to the side; forces per (m/s)^2 and rad.

    Attributes
    ----------
    sway : float
        m2, mass plus added mass along y, kg.
    roll_inertia, yaw_inertia : float
        J1 and J3, inertia plus added inertia without the pistons, kg m^2.
    K_S, K_Y : float
        Side force against sideslip and yaw moment into the flow, N/(m/s)^2 and N m/(m/s)^2 per rad, without the Munk moment
        where the polar's is without it.
    roll_damping, yaw_damping : float
        N m/(m/s rad/s).
    roller_rate : float
        rad/s.
    """

    sway: Annotated[takes.Mass, takes.ABOVE_ZERO]
    roll_inertia: Annotated[takes.Inertia, takes.ABOVE_ZERO]
    yaw_inertia: Annotated[takes.Inertia, takes.ABOVE_ZERO]
    K_S: Annotated[takes.Pure, takes.ZERO_OR_MORE]
    K_Y: takes.Pure
    roll_damping: Annotated[takes.Pure, takes.ZERO_OR_MORE]
    yaw_damping: Annotated[takes.Pure, takes.ZERO_OR_MORE]
    roller_rate: Annotated[takes.Rate, takes.ABOVE_ZERO]


@dataclass(frozen=True, slots=True)
class Thrusters(takes.Declaration):
    """Two thrusters that push ahead.

    Attributes
    ----------
    aside, below : float
        y of the right one and z of both, m; the left one is the mirror image.
    largest : float
        Thrust of each, either way, N.
    rate : float
        N/s.
    """

    aside: takes.Length
    below: takes.Length
    largest: Annotated[Force, takes.ABOVE_ZERO]
    rate: Annotated[takes.Pure, takes.ABOVE_ZERO]


@brief
@dataclass(frozen=True, slots=True)
class SpaceBody:
    """What the equations need.

    Attributes
    ----------
    plane : GliderBody
        In the vertical plane.
    masses : MassModel
    lateral : Lateral
    thrusters : Thrusters
    """

    plane: GliderBody
    masses: MassModel
    lateral: Lateral
    thrusters: Thrusters

    @property
    def inertia(self) -> Array:
        """(6, 6) M and J, with the pistons' share to both sides of x in roll and yaw."""
        p, s = self.plane, self.lateral
        apart = p.sliding * self.masses.piston_at[1] ** 2
        return np.diag([p.surge, s.sway, p.heave, s.roll_inertia + apart, p.inertia, s.yaw_inertia + apart])

    def matrix(self, position: float) -> Array:
        """(6, 6) from velocities to momenta, the pistons at rest at a position, m."""
        m, arm = self.plane.sliding, skew(np.array([position, 0.0, self.plane.sliding_below]))
        return np.asarray(self.inertia + m * np.block([[np.eye(3), -arm], [arm, -arm @ arm]]))

    def sliding_momentum(self, position: float, rate: float) -> Array:
        """(6,) what the pistons' own rate, m/s, adds to the momenta."""
        along = np.array([self.plane.sliding * rate, 0.0, 0.0])
        return np.array([*along, *np.cross([position, 0.0, self.plane.sliding_below], along)])

    def moments(self, setting: Setting) -> Array:
        """(3,) S, N m: moments of all masses and of the buoyancy."""
        ahead, below = self.plane.moments(*setting[:2])
        moved = self.masses.roller_place(setting.roller) - self.masses.roller_place(0.0)
        return np.asarray(np.array([ahead, 0.0, below]) + self.masses.roller * self.plane.gravity * moved)

    def thrust(self, setting: Setting) -> Array:
        """(6,) force, N, and moment, N m, of both thrusters."""
        t = self.thrusters
        both = setting.right + setting.left
        return np.array([both, 0.0, 0.0, 0.0, t.below * both, t.aside * (setting.left - setting.right)])

    def water(self, nu: Array) -> Array:
        """(6,) force, N, and moment, N m, of the water at u v w p q r, without added mass."""
        polar, s = self.plane.polar, self.lateral
        u, v, w, p, q, r = (float(x) for x in nu)
        speed = math.sqrt(u * u + v * v + w * w)
        if speed == 0.0:
            return np.zeros(6)
        alpha, beta = math.atan2(w, u), math.asin(max(-1.0, min(1.0, v / speed)))
        ca, sa, cb, sb = math.cos(alpha), math.sin(alpha), math.cos(beta), math.sin(beta)
        lift = (polar.lift[0] + polar.lift[1] * alpha) * speed**2
        drag = (polar.drag[0] + polar.drag[1] * alpha**2) * speed**2
        side = -s.K_S * beta * speed**2
        pitch = (polar.moment[0] + polar.moment[1] * alpha) * speed**2 - polar.damping * speed * q
        return np.array([
            -drag * ca * cb - side * ca * sb + lift * sa, -drag * sb + side * cb, -drag * sa * cb - side * sa * sb - lift * ca,
            -s.roll_damping * speed * p, pitch, s.K_Y * beta * speed**2 - s.yaw_damping * speed * r,
        ])  # fmt: skip


def rotation(quaternion: Sequence[float] | Array) -> Array:
    """(3, 3) R from body to earth axes (equation 8), of a quaternion of any length above zero."""
    a, b, c, d = np.asarray(quaternion) / math.sqrt(sum(x * x for x in quaternion))
    return np.array([
        [1.0 - 2.0 * (c * c + d * d), 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
        [2.0 * (b * c + a * d), 1.0 - 2.0 * (b * b + d * d), 2.0 * (c * d - a * b)],
        [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), 1.0 - 2.0 * (b * b + c * c)],
    ])  # fmt: skip


def pushed(body: SpaceBody, nu: Array, momenta: Array, down: Array, setting: Setting) -> Array:
    """(6,) rates of P and H.

    Parameters
    ----------
    body : SpaceBody
    nu, momenta : (6,) array
        u v w p q r, and P and H.
    down : (3,) array
        The vertical in body axes.
    setting : Setting
    """
    v, turn, p, h = nu[:3], nu[3:], momenta[:3], momenta[3:]
    forces = body.water(nu) + body.thrust(setting)
    munk = np.cross(p, v)
    if body.plane.holds_munk:
        munk -= np.cross(np.diag(body.inertia)[:3] * v, v)
    force = np.cross(p, turn) + setting.net_mass * body.plane.gravity * down + forces[:3]
    moment = np.cross(h, turn) + munk + np.cross(body.moments(setting), down) + forces[3:]
    return np.concatenate([force, moment])


def rates_in_space(body: SpaceBody, leg: Leg) -> Rates:
    """Right-hand side for the state `IN_SPACE` over one leg."""
    still = body.matrix(leg.at.position) if leg.rate.position == 0.0 else None

    def of(time: float, y: Array) -> list[float]:
        setting = leg.setting(time)
        matrix = body.matrix(setting.position) if still is None else still
        own = body.sliding_momentum(setting.position, leg.rate.position)
        nu = np.asarray(np.linalg.solve(matrix, y[7:] - own), dtype=np.float64)
        turned = rotation(y[3:7])
        north, east, depth = (turned @ nu[:3]).tolist()
        a, b, c, d = y[3:7].tolist()
        p, q, r = nu[3:].tolist()
        return [
            north, depth, east,
            0.5 * (-b * p - c * q - d * r), 0.5 * (a * p + c * r - d * q),
            0.5 * (a * q - b * r + d * p), 0.5 * (a * r + b * q - c * p),
            *pushed(body, nu, y[7:], turned[2], setting).tolist(),
        ]  # fmt: skip

    return of


def velocity_in_space(body: SpaceBody, momenta: Array, position: float, rate: float) -> Array:
    """(6,) u v w p q r of P and H (6,)."""
    moving = momenta - body.sliding_momentum(position, rate)
    return np.asarray(np.linalg.solve(body.matrix(position), moving), dtype=np.float64)


def state_of(body: SpaceBody, setting: Setting, nu: Array, phi: float, theta: float) -> Array:
    """(13,) state at the origin, heading north, with the pistons at rest."""
    cp, sp, ct, st = math.cos(phi / 2), math.sin(phi / 2), math.cos(theta / 2), math.sin(theta / 2)
    turned = [cp * ct, sp * ct, cp * st, -sp * st]
    return np.array([0.0, 0.0, 0.0, *turned, *(body.matrix(setting.position) @ nu)])


def unexplained_in_space(body: SpaceBody, setting: Setting, states: Array) -> tuple[float, float, float]:
    """What `rates_in_space` do without a cause: power, W, velocity over ground, m/s, and rotation, rad/s; zero if right.

    Parameters
    ----------
    body : SpaceBody
    setting : Setting
        Held, so that pistons and roller do no work.
    states : (n, 8) array
        phi, theta, rad, u v w, m/s, p q r, rad/s.
    """
    of, lever, weight = rates_in_space(body, Leg(0.0, 1.0, setting, STILL)), body.moments(setting), body.plane.gravity
    apart = drift = spun = 0.0
    for phi, theta, *moving in states.tolist():
        nu = np.array(moving)
        y = state_of(body, setting, nu, phi, theta)
        rate = np.array(of(0.0, y))
        down = np.array([-math.sin(theta), math.sin(phi) * math.cos(theta), math.cos(phi) * math.cos(theta)])
        stored = nu @ rate[7:] - setting.net_mass * weight * rate[1] - lever @ np.cross(down, nu[3:])
        work = nu @ (body.water(nu) + body.thrust(setting))
        if body.plane.holds_munk:
            work -= nu[3:] @ np.cross(np.diag(body.inertia)[:3] * nu[:3], nu[:3])
        apart = max(apart, abs(stored - work))
        sway, heave = nu[1], nu[2]
        level = nu[0] * math.cos(theta) + math.sin(theta) * (sway * math.sin(phi) + heave * math.cos(phi))
        across = sway * math.cos(phi) - heave * math.sin(phi)
        drift = max(drift, float(np.hypot(np.hypot(rate[0] - level, rate[2] - across), rate[1] - nu[:3] @ down)))
        turned = rotation(y[3:7])
        moved = (rotation(y[3:7] + NUDGE * rate[3:7]) - rotation(y[3:7] - NUDGE * rate[3:7])) / (2.0 * NUDGE)
        spun = max(spun, float(np.max(np.abs(moved - turned @ skew(nu[3:])))))
    return float(apart), drift, spun


@brief
@dataclass(frozen=True, slots=True)
class Spiral:
    """A steady turning glide, or a steady level turn.

    Attributes
    ----------
    speed : float
        m/s.
    alpha, beta, phi, theta : float
        Angle of attack, sideslip, roll and pitch, rad.
    turn : float
        Rate of the heading, rad/s, above zero to starboard.
    left_over : float
        Largest force or moment out of balance, over the scale of its own kind.
    """

    speed: float
    alpha: float
    beta: float
    phi: float
    theta: float
    turn: float
    left_over: float

    @property
    def down(self) -> Array:
        """(3,) the vertical in body axes."""
        ct = math.cos(self.theta)
        return np.array([-math.sin(self.theta), math.sin(self.phi) * ct, math.cos(self.phi) * ct])

    @property
    def velocity(self) -> Array:
        """(6,) u v w p q r."""
        ca, sa, cb = math.cos(self.alpha), math.sin(self.alpha), math.cos(self.beta)
        along = self.speed * np.array([ca * cb, math.sin(self.beta), sa * cb])
        return np.concatenate([along, self.turn * self.down])

    @property
    def sinking(self) -> float:
        """Speed downward, m/s."""
        return float(self.velocity[:3] @ self.down)

    @property
    def radius(self) -> float:
        """Of the circle over ground, m; infinite without a turn."""
        level = math.sqrt(max(self.speed**2 - self.sinking**2, 0.0))
        return level / abs(self.turn) if self.turn else math.inf

    @property
    def zeta(self) -> float:
        """Glide angle, rad, below zero on a dive."""
        return -math.asin(self.sinking / self.speed)


def _spiral(unknown: Array) -> Spiral:
    speed, alpha, beta, phi, theta, turn = (float(x) for x in unknown)
    return Spiral(speed, alpha, beta, phi, theta, turn, 0.0)


def out_of_balance(body: SpaceBody, setting: Setting, at: Spiral) -> Array:
    """(6,) rates of P and H in axes that turn with the vehicle, N and N m; zero where the turn is steady."""
    return pushed(body, at.velocity, body.matrix(setting.position) @ at.velocity, at.down, setting)


def steady_spiral(body: SpaceBody, setting: Setting, speed: float, alpha: float, theta: float) -> Spiral | None:
    """The steady turn that a straight steady glide becomes as roller and thrusters go from rest to the setting.

    Parameters
    ----------
    body : SpaceBody
    setting : Setting
    speed, alpha, theta : float
        The straight glide of its net mass and position, m/s and rad.

    Returns
    -------
    Spiral or None
        None where Newton's method finds none on the way.
    """
    from scipy.optimize import root

    weight = abs(setting.net_mass) * body.plane.gravity
    arm = float(np.max(np.abs(body.moments(setting))))
    size = np.array([*([weight] * 3), *([arm] * 3)])
    at = np.array([speed, alpha, 0.0, 0.0, theta, 0.0])
    for k in range(1, STEPS + 1):
        part = setting._replace(**{name: getattr(setting, name) * k / STEPS for name in ("roller", "right", "left")})
        found = root(lambda x, s=part: out_of_balance(body, s, _spiral(x)) / size, at, tol=1e-13)
        at = found.x
        off = float(np.max(np.abs(found.fun)))
        if not off < FOUND:
            return None
    return replace(_spiral(at), left_over=off)


@brief
@dataclass(frozen=True, slots=True)
class Cruise:
    """A level straight run at no angle of attack: the thrusters meet the drag, the engine the lift.

    Attributes
    ----------
    speed, lift, drag : float
        m/s and N.
    setting : Setting
        Its thrusts and net mass.
    elevator : float
        Pitch moment, N m, that the elevator must give, nose up; the paper prints no elevator.
    """

    speed: float
    lift: float
    drag: float
    setting: Setting
    elevator: float


def cruise(body: SpaceBody, speed: float) -> Cruise:
    """The run at a speed, m/s, the pistons where the net mass puts them."""
    polar = body.plane.polar
    lift, drag = polar.lift[0] * speed**2, polar.drag[0] * speed**2
    net = lift / body.plane.gravity
    setting = Setting(net, body.masses.stroke(net), 0.0, drag / 2.0, drag / 2.0)
    at = Spiral(speed, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return Cruise(speed, lift, drag, setting, -float(out_of_balance(body, setting, at)[4]))

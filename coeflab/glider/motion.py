"""Motion of a glider in the vertical plane, with a mass that slides along x and an engine that changes its buoyancy.

Kirchhoff's equations for the momentum of body, fluid and sliding mass, P1, P3 and H about the reference point, in FRD
axes (Leonard and Graver 2001; equations 14-25 of the THAUV paper)::

    x_dot     = v1 cos(theta) + v3 sin(theta)            depth_dot = -v1 sin(theta) + v3 cos(theta)      theta_dot = q
    P1_dot    = -P3 q - m0 g sin(theta) + L sin(alpha) - D cos(alpha)
    P3_dot    =  P1 q + m0 g cos(theta) - L cos(alpha) - D sin(alpha)
    H_dot     =  P3 v1 - P1 v3 + M - ahead cos(theta) - below sin(theta)
    P1 = m1 v1 + p1    P3 = m3 v3 + p3    H = J q + r3 p1 - r1 p3    p1 = m_p (v1 + q r3 + r1_dot)    p3 = m_p (v3 - q r1)

The engine changes the displaced volume: m0 follows it, the momenta do not. The momenta keep the sliding mass exact
without the forces u_p that move it. Written out, P3_dot has +m1 v1 q, where the
paper's equation 18 prints -m1 v1 q; H_dot has the moments ahead and below of the whole centre of gravity, where its
equation 19 prints those of the roller; m1 and m3 are mass plus added mass, where its text has added mass alone; and b in
its equation 9 is b_dot. P3 v1 - P1 v3 holds the Munk moment (m3 - m1) v1 v3, which is left out where M has it already.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coeflab.core.types import Array, brief
from coeflab.glider.steady_glide import Polar

STATE = ("x", "depth", "theta", "P1", "P3", "H")
FEW_CALLS, CALLS_A_SECOND = 50_000, 1_000
Rates = Callable[[float, Array], list[float]]


@brief
@dataclass(frozen=True, slots=True)
class GliderBody:
    """What the equations need.

    Attributes
    ----------
    polar : Polar
    surge, heave, inertia : float
        m1, m3, kg, and J, kg m^2: mass and added mass without the sliding mass.
    sliding, sliding_below : float
        m_p, kg, and its r3, m.
    ahead, below : float
        Sums of m g x and m g z, N m, of all other masses at neutral buoyancy.
    engine_ahead : float
        x at which the net weight acts, m.
    gravity : float
        m/s^2.
    holds_munk : bool
        Whether the polar's moment holds (m3 - m1) v1 v3.
    """

    polar: Polar
    surge: float
    heave: float
    inertia: float
    sliding: float
    sliding_below: float
    ahead: float
    below: float
    engine_ahead: float
    gravity: float
    holds_munk: bool

    @property
    def munk(self) -> float:
        """Mass whose Munk moment the pitch balance adds, kg."""
        return 0.0 if self.holds_munk else self.heave - self.surge

    def moments(self, net_mass: float, position: float) -> tuple[float, float]:
        """``ahead`` and ``below`` of all masses, N m, at a net mass, kg, and a position of the sliding mass, m."""
        slide = self.sliding * self.gravity
        lever = net_mass * self.gravity * self.engine_ahead
        return self.ahead + slide * position + lever, self.below + slide * self.sliding_below


class Setting(NamedTuple):
    """Net mass, kg, and position of the sliding mass, m; in space the roller's angle, rad, and both thrusts, N, too."""

    net_mass: float
    position: float
    roller: float = 0.0
    right: float = 0.0
    left: float = 0.0


class Leg(NamedTuple):
    """A stretch of time over which net mass and position change linearly, or not at all."""

    begins: float
    ends: float
    at: Setting
    rate: Setting

    def setting(self, time: float) -> Setting:
        """What is set at a time of the leg."""
        since = time - self.begins
        return Setting(*(at + rate * since for at, rate in zip(self.at, self.rate, strict=True)))


def legs(begins: float, lasts: float, now: Setting, ordered: Setting, rate: Setting) -> list[Leg]:
    """The order of a phase as stretches that have no kink: both moving, one moving, at rest."""
    change = [o - n for o, n in zip(ordered, now, strict=True)]
    needs = [abs(c) / r if c else 0.0 for c, r in zip(change, rate, strict=True)]
    speed = [math.copysign(r, c) for c, r in zip(change, rate, strict=True)]
    out, start, at = [], 0.0, now
    for end in sorted({*(n for n in needs if 0.0 < n < lasts), lasts}):
        moves = Setting(*(v if start < n else 0.0 for v, n in zip(speed, needs, strict=True)))
        leg = Leg(begins + start, begins + end, at, moves)
        out.append(leg)
        at = Setting(*(o if end >= n else s for o, s, n in zip(ordered, leg.setting(begins + end), needs, strict=True)))
        start = end
    return out


def velocity(body: GliderBody, momentum: Sequence[float], position: float, rate: float) -> tuple[float, float, float]:
    """v1, v3, m/s, and q, rad/s, of momenta P1, P3 and H."""
    m, r1, r3 = body.sliding, position, body.sliding_below
    a, b = body.surge + m, body.heave + m
    p1, p3, h = momentum[0] - m * rate, momentum[1], momentum[2] - m * r3 * rate
    q = (h - m * r3 * p1 / a + m * r1 * p3 / b) / (
        body.inertia + m * (r1 * r1 + r3 * r3) - (m * r3) ** 2 / a - (m * r1) ** 2 / b
    )
    return (p1 - m * r3 * q) / a, (p3 + m * r1 * q) / b, q


def momentum(body: GliderBody, moving: Sequence[float], position: float, rate: float) -> tuple[float, float, float]:
    """P1, P3 and H of v1, v3 and q; the inverse of `velocity`."""
    v1, v3, q = moving
    p1 = body.sliding * (v1 + q * body.sliding_below + rate)
    p3 = body.sliding * (v3 - q * position)
    return body.surge * v1 + p1, body.heave * v3 + p3, body.inertia * q + body.sliding_below * p1 - position * p3


def rates(body: GliderBody, leg: Leg) -> Rates:
    """Right-hand side for the state `STATE` over one leg; L and D vanish smoothly with V, so rest is no exception."""
    polar, g = body.polar, body.gravity
    doubled = body.heave - body.surge if body.holds_munk else 0.0

    def of(time: float, y: Array) -> list[float]:
        net_mass, position = leg.setting(time)[:2]
        _, _, theta, p1, p3, h = (float(v) for v in y)
        v1, v3, q = velocity(body, (p1, p3, h), position, leg.rate.position)
        speed, alpha = math.hypot(v1, v3), math.atan2(v3, v1)
        lift = (polar.lift[0] + polar.lift[1] * alpha) * speed
        drag = (polar.drag[0] + polar.drag[1] * alpha * alpha) * speed
        moment = (polar.moment[0] + polar.moment[1] * alpha) * speed * speed - polar.damping * speed * q
        ahead, below = body.moments(net_mass, position)
        c, s = math.cos(theta), math.sin(theta)
        return [
            v1 * c + v3 * s,
            v3 * c - v1 * s,
            q,
            -p3 * q - net_mass * g * s + lift * v3 - drag * v1,
            p1 * q + net_mass * g * c - lift * v1 - drag * v3,
            p3 * v1 - p1 * v3 - doubled * v1 * v3 + moment - ahead * c - below * s,
        ]

    return of


def unexplained_power(body: GliderBody, setting: Setting, states: Array) -> tuple[float, float]:
    """What `rates` do that no force explains: power, W, and velocity over ground, m/s; zero for the right equations.

    The kinetic energy (v1 P1 + v3 P3 + q H) / 2, with that of weight, buoyancy and their moments, changes by the work of drag
    and of the pitch moment alone: inertia and lift do none. Over ground the reference point moves by V cos(zeta) and -V sin(zeta).

    Parameters
    ----------
    body : GliderBody
    setting : Setting
        Held, so that the sliding mass does no work.
    states : (n, 4) array
        theta, rad, v1 and v3, m/s, and q, rad/s.
    """
    polar, of = body.polar, rates(body, Leg(0.0, 1.0, setting, Setting(0.0, 0.0)))
    weight, (ahead, below) = setting.net_mass * body.gravity, body.moments(*setting[:2])
    doubled = body.heave - body.surge if body.holds_munk else 0.0
    power = drift = 0.0
    for theta, v1, v3, q in states.tolist():
        at = [0.0, 0.0, theta, *momentum(body, (v1, v3, q), setting.position, 0.0)]
        x, depth, turn, p1, p3, h = of(0.0, np.array(at))
        speed, alpha = math.hypot(v1, v3), math.atan2(v3, v1)
        stored = v1 * p1 + v3 * p3 + q * h - weight * depth
        stored += (ahead * math.cos(theta) + below * math.sin(theta)) * turn
        moment = (polar.moment[0] + polar.moment[1] * alpha) * speed**2 - polar.damping * speed * q - doubled * v1 * v3
        work = moment * q - (polar.drag[0] + polar.drag[1] * alpha**2) * speed**3
        power = max(power, abs(stored - work))
        zeta = theta - alpha
        drift = max(drift, math.hypot(x - speed * math.cos(zeta), depth + speed * math.sin(zeta)))
    return power, drift


def eigenvalues(body: GliderBody, setting: Setting, speed: float, alpha: float, theta: float) -> Array:
    """(4,) complex eigenvalues, 1/s, of a steady glide under small disturbances of theta and the momenta."""
    of = rates(body, Leg(0.0, 1.0, setting, Setting(0.0, 0.0)))
    moving = momentum(body, (speed * math.cos(alpha), speed * math.sin(alpha), 0.0), setting.position, 0.0)
    at = np.array([0.0, 0.0, theta, *moving])
    size = np.array([1.0, body.surge * speed, body.heave * speed, body.inertia * speed])
    columns = []
    for i in range(4):
        step = np.zeros(6)
        step[2 + i] = 1e-6 * size[i]
        columns.append((np.array(of(0.0, at + step)) - np.array(of(0.0, at - step)))[2:] / (2e-6 * size[i]))
    return np.asarray(np.linalg.eigvals(np.array(columns).T))


class March(NamedTuple):
    """Times (n,) and states (n, m) after the start of a leg, whether a depth was met, and how it ended.

    ``why`` says why it stopped early, or is empty; ``finite`` whether its state was one of numbers to the end.
    """

    time: Array
    state: Array
    met: bool
    why: str
    finite: bool


def march(
    of: Rates, leg: Leg, start: Array, step: float, depth: tuple[float, bool] | None, tolerance: float
) -> March:  # fmt: skip
    """Integrate one leg with scipy's LSODA.

    Parameters
    ----------
    of : callable
        Right-hand side of the leg.
    leg : Leg
    start : (m,) array
        Its second number is the depth.
    step : float
        Between rows, s; the end of the leg is a row too.
    depth : (float, bool) or None
        Stop where this depth, m, is crossed: downward where the flag is set, else upward.
    tolerance : float
        Relative; absolute a thousandth of it.
    """
    from scipy.integrate import LSODA

    wanted = step * np.arange(math.floor(leg.begins / step) + 1, math.ceil(leg.ends / step) + 1)
    wanted = np.append(wanted[(wanted > leg.begins) & (wanted < leg.ends - 1e-9 * step)], leg.ends)
    most = FEW_CALLS + CALLS_A_SECOND * (leg.ends - leg.begins)
    times: list[float] = []
    states: list[Array] = []
    next_row, finite = 0, True
    with warnings.catch_warnings(record=True) as words, np.errstate(all="ignore"):
        warnings.simplefilter("always")
        solver = LSODA(of, leg.begins, start, leg.ends, rtol=tolerance, atol=1e-3 * tolerance)
        while solver.status == "running":
            try:
                why = solver.step() or ""
            except (OverflowError, ValueError) as error:
                why, finite = f"the state is not finite ({error})", False
            if not why and not np.isfinite(solver.y).all():
                why, finite = "the state is not finite", False
            if not why and solver.nfev > most:
                why = "the motion is too stiff or too fast to integrate"
            if why:
                return _march(times, states, False, str(words[-1].message) if words else why, finite)
            at = solver.dense_output()
            end = _crossed(at, solver.t_old, solver.t, depth)
            reached = int(
                np.searchsorted(wanted, solver.t if end is None else end, side="right" if end is None else "left")
            )
            times += wanted[next_row:reached].tolist()
            states += [at(t) for t in wanted[next_row:reached]]
            next_row = reached
            if end is not None:
                return _march([*times, end], [*states, at(end)], True)
    return _march(times, states, False)


def _march(times: list[float], states: list[Array], met: bool, why: str = "", finite: bool = True) -> March:
    return March(np.array(times), np.array(states), met, why, finite)


def _crossed(
    at: Callable[[float], Array], begins: float, ends: float, depth: tuple[float, bool] | None
) -> float | None:
    """When a depth is crossed between two times, in its direction."""
    from scipy.optimize import brentq

    if depth is None:
        return None
    wanted, downward = depth

    def apart(time: float) -> float:
        return float(at(time)[1] - wanted) * (1.0 if downward else -1.0)

    return float(brentq(apart, begins, ends, xtol=1e-12)) if apart(begins) < 0.0 <= apart(ends) else None

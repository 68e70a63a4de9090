"""A vehicle with an arm in time: free, driven by forces, or with its vehicle held and its joints on a track.

The state is that of `coeflab.arm.kane.right_hand_side`, with whatever a drive adds behind it, such as the speeds of thrusters.
A joint that meets a limit ends the motion: what the stop does is not modelled.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from coeflab.arm import kane
from coeflab.arm.chain import STILL, Chain, Flow
from coeflab.arm.thrusters import thruster_forces, thruster_matrix, thruster_rates
from coeflab.core.errors import InputError
from coeflab.core.machine import compiles
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locked
from coeflab.motion.trajectory import Ended

Control = Callable[[float, Array], Array]
Equations = Callable[[Array, Flow], tuple[Array, Array]]
CLOSE, ITERATIONS, STRAIGHT = 1e-9, 60, 41
AT_REST = 1e-6  # rad/s or m/s
FEW_CALLS, CALLS_A_SECOND = 20_000, 10_000.0


@brief
@dataclass(frozen=True, eq=False)
class Track:
    """Joint positions over time, to rest.

    Attributes
    ----------
    begins, ends : float
        s.
    positions : (k, n) array
        Passed at equal steps of the share of the way, which goes by 10 x^3 - 15 x^4 + 6 x^5 of the share x of the time.
    rates : (n,) array
        At the beginning, of a track of two positions; they die away by x - 6 x^3 + 8 x^4 - 3 x^5. Of more positions none.
    """

    begins: float
    ends: float
    positions: Array
    rates: Array = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        rates = self.rates if len(self.rates) else np.zeros(np.shape(self.positions)[1])
        object.__setattr__(self, "positions", locked(self.positions))
        object.__setattr__(self, "rates", locked(rates))

    @cached_property
    def _path(self) -> Any:
        from scipy.interpolate import make_interp_spline

        return make_interp_spline(np.linspace(0.0, 1.0, len(self.positions)), self.positions, k=5)

    def at(self, time: float) -> tuple[Array, Array, Array]:
        """Positions, rates and accelerations (n,) at a time; it stands before and after."""
        span = self.ends - self.begins
        x = min(max((time - self.begins) / span, 0.0), 1.0)
        s = x**3 * (10.0 - 15.0 * x + 6.0 * x * x)
        ds, dds = 30.0 * x * x * (1.0 - x) ** 2 / span, 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / span**2
        if len(self.positions) == 2:
            way, swing = self.positions[1] - self.positions[0], self.rates
            h, dh = x - 6.0 * x**3 + 8.0 * x**4 - 3.0 * x**5, 1.0 - 18.0 * x**2 + 32.0 * x**3 - 15.0 * x**4
            ddh = (-36.0 * x + 96.0 * x**2 - 60.0 * x**3) / span
            moving = 0.0 if time > self.ends else 1.0
            here = self.positions[0] + s * way + span * h * swing
            return here, ds * way + moving * dh * swing, dds * way + moving * ddh * swing
        along, bent = self._path(s, 1), self._path(s, 2)
        return self._path(s), ds * along, dds * along + ds * ds * bent


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Drive:
    """What acts on a chain in a phase.

    Attributes
    ----------
    held : bool
        The vehicle keeps its velocity, none or another, by whatever force that takes.
    track : Track, optional
        The joints follow it, by whatever torques that takes.
    torque : (n,) array
        Of the joints, where they follow no track; each stays within its drive's strongest.
    commands : (k,) array, optional
        Of the thrusters; without it they are not there.
    """

    held: bool = False
    track: Track | None = None
    torque: Array = field(default_factory=lambda: np.zeros(0))
    commands: Array | None = None


@brief
@dataclass(frozen=True, slots=True, eq=False)
class March:
    """Rows of a motion.

    Attributes
    ----------
    time : (k,) array
        s.
    state : (k, m) array
    control : (k, 6 + n) array
        Force and moment on the vehicle at its centre of mass, FRD, and torques of the joints.
    ended : Ended
    why : str
        In words, where it did not reach its end.
    """

    time: Array
    state: Array
    control: Array
    ended: Ended
    why: str = ""


def equations_of(chain: Chain) -> Equations:
    """M and forces at a state; compiled where numba is installed."""
    if not compiles():
        return lambda state, flow: kane.equations(chain, state, flow)
    from coeflab.arm import compiled

    numbers, size = compiled.packed(chain), 13 + 2 * chain.count

    def found(state: Array, flow: Flow) -> tuple[Array, Array]:
        moving = np.concatenate([flow.velocity, flow.acceleration])
        m, force = compiled.equations(*numbers, np.ascontiguousarray(state[:size]), moving)
        return m, force

    return found


def at_rest(chain: Chain, q: Array | None = None, velocity: Array | None = None, rates: Array | None = None) -> Array:
    """(13 + 2 n,) state at the origin, level, heading north.

    Parameters
    ----------
    chain : Chain
    q : (n,) array, optional
        Home unless given.
    velocity : (6,) array, optional
        u v w p q r over ground.
    rates : (n,) array, optional
        Of the joints.
    """
    n = chain.count
    out = np.zeros(13 + 2 * n)
    out[3] = 1.0
    out[7 : 7 + n] = chain.home if q is None else q
    out[7 + n : 13 + n] = 0.0 if velocity is None else velocity
    out[13 + n :] = 0.0 if rates is None else rates
    return out


def limited(chain: Chain, torque: Array) -> Array:
    """(n,) torques that the drives can make."""
    most = np.array([joint.strongest for joint in chain.joints])
    return np.clip(torque, -most, most)


def thrust_wrench(chain: Chain, states: Array, commands: Array) -> Array:
    """(6,) force and moment of the thrusters on the vehicle (section 3.6 of the URV paper)."""
    pushed = thruster_forces(chain.thrusters, states, commands, chain.density)
    return np.asarray(thruster_matrix(chain.thrusters) @ pushed)


def driven(chain: Chain, drive: Drive, flow: Flow = STILL) -> tuple[Control, Control]:
    """(rates, control) of a phase: rates of the state, and what control force (6 + n,) acts, at ``time, state``.

    The speeds that are prescribed, those of a held vehicle and of joints on a track, change as they must; the rows of M s' = F + tau of
    the others give theirs, and the prescribed rows give the force that it takes.
    """
    n, found = chain.count, equations_of(chain)
    size = 13 + 2 * n
    given = np.zeros(6 + n, dtype=bool)
    given[:6], given[6:] = drive.held, drive.track is not None
    free = ~given
    torque = limited(chain, drive.torque) if len(drive.torque) else np.zeros(n)
    commands = drive.commands

    def solved(time: float, state: Array) -> tuple[Array, Array]:
        m, force = found(state, flow.at(time))
        control, changed = np.zeros(6 + n), np.zeros(6 + n)
        control[6:] = torque
        if commands is not None:
            control[:6] += thrust_wrench(chain, state[size:], commands)
        if drive.track is not None:
            changed[6:] = drive.track.at(time)[2]
        pushed = force + control
        if not given.any():
            return np.asarray(np.linalg.solve(m, pushed)), control
        if free.any():
            changed[free] = np.linalg.solve(
                m[np.ix_(free, free)], pushed[free] - m[np.ix_(free, given)] @ changed[given]
            )
        control[given] = m[given] @ changed - force[given]
        return changed, control

    def rates(time: float, state: Array) -> Array:
        changed, _ = solved(time, state)
        rows = [kane.displacement_rates(n, state), changed]
        if commands is not None:
            rows.append(thruster_rates(chain.thrusters, state[size:], commands, chain.density))
        return np.concatenate(rows)

    return rates, lambda time, state: solved(time, state)[1]


def march(
    chain: Chain, rates: Control, control: Control, start: Array, begins: float, ends: float, step: float,
    tolerance: float = 1e-9, method: str = "DOP853",
) -> March:  # fmt: skip
    """Integrate a phase.

    Parameters
    ----------
    chain : Chain
    rates, control : callable
        ``rates(time, state)`` of the whole state; ``control(time, state)`` (6 + n,) for the rows.
    start : (m,) array
    begins, ends : float
        s.
    step : float
        Between rows, s; the end is a row too.
    tolerance : float
        Relative and absolute, of a step.
    method : str
        A solver class of `scipy.integrate`.

    Returns
    -------
    March
        It ends early, with a status, where a joint meets a limit or the numbers fail.
    """
    from scipy import integrate

    wanted = begins + step * np.arange(1, math.ceil((ends - begins) / step) + 1)
    wanted = np.append(wanted[wanted < ends - 1e-9 * step], ends)
    times, states = [begins], [np.array(start)]
    row, ended, why = 0, Ended.COMPLETE, ""
    most = FEW_CALLS + CALLS_A_SECOND * (ends - begins)
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.filterwarnings("ignore", message="lsoda: ", category=UserWarning)
        reached, here = begins, np.array(start)
        try:
            solver = getattr(integrate, method)(_finite(rates), begins, start, ends, rtol=tolerance, atol=tolerance)
        except _NotFiniteError:
            solver, ended, why = None, Ended.NOT_FINITE, "the rates are not finite"
        while solver is not None and solver.status == "running" and not why:
            try:
                solver.step()
            except (_NotFiniteError, np.linalg.LinAlgError, OverflowError):
                ended, why = Ended.NOT_FINITE, "the rates are not finite"
            if not why and (solver.status == "failed" or solver.nfev > most):
                ended, why = Ended.STEP_TOO_SMALL, "the steps become too small"
            if why:
                if times[-1] < reached:
                    times.append(reached)
                    states.append(_upright(here))
                break
            reached, here = float(solver.t), np.array(solver.y)
            inside = solver.dense_output()
            until = float(solver.t)
            met = _at_a_limit(chain, inside, float(solver.t_old), until)
            if met is not None:
                until, why = met
                ended = Ended.OUT_OF_RANGE
            while row < len(wanted) and wanted[row] <= until:
                times.append(float(wanted[row]))
                states.append(_upright(inside(wanted[row])))
                row += 1
            if met is not None and times[-1] < until:
                times.append(until)
                states.append(_upright(inside(until)))
    acted = [control(t, y) for t, y in zip(times, states, strict=True)]
    if why:
        why = f"at {times[-1]:.6g} s: {why}"
    return March(np.array(times), np.array(states), np.array(acted), ended, why)


class _NotFiniteError(ArithmeticError):
    """Rates that are no numbers."""


def _finite(rates: Control) -> Control:
    """The same rates, which raise where they are no numbers: a solver never comes back from those."""

    def checked(time: float, state: Array) -> Array:
        found = rates(time, state)
        if not math.isfinite(float(np.sum(found))):
            raise _NotFiniteError
        return found

    return checked


def _at_a_limit(chain: Chain, inside: Callable[[float], Array], begins: float, ends: float) -> tuple[float, str] | None:
    """When the first joint goes through a limit within a step, and which, in words."""
    from scipy.optimize import brentq

    first: tuple[float, str] | None = None
    n = chain.count
    last, before = inside(ends), inside(begins)
    for k, joint in enumerate(chain.joints):
        for sign, limit in ((1.0, joint.high), (-1.0, joint.low)):
            beyond = sign * (last[7 + k] - limit)
            if not beyond > 0.0 or sign * last[13 + n + k] <= 0.0:
                continue
            time = begins
            if sign * (before[7 + k] - limit) < 0.0:
                time = float(brentq(_beyond, begins, ends, (inside, 7 + k, limit), xtol=1e-12))
            if first is None or time < first[0]:
                words = f"{np.degrees(limit):.4g} deg" if joint.turns else f"{limit:.4g} m"
                first = time, f"joint {joint.name} is at its limit of {words}"
    return first


def _beyond(time: float, inside: Callable[[float], Array], row: int, limit: float) -> float:
    return float(inside(time)[row] - limit)


def _upright(state: Array) -> Array:
    """A copy whose quaternion has length one."""
    out = np.array(state)
    out[3:7] /= np.linalg.norm(out[3:7])
    return out


def track_to(
    chain: Chain, q: Array, to: Array, begins: float, ends: float, rates: Array | None = None
) -> Track:  # fmt: skip
    """From joint positions to others, from rest or from rates (n,).

    Raises
    ------
    InputError
        Positions beyond a joint's limits.
    """
    for joint, value in zip(chain.joints, to, strict=True):
        if not joint.low <= value <= joint.high:
            factor, unit = (180.0 / np.pi, "deg") if joint.turns else (1.0, "m")
            raise input_error(
                "arm.limits_joint", column="joints", factor=factor * value, unit=unit, factor_2=factor * joint.low,
                factor_3=factor * joint.high, name=joint.name,
            )  # fmt: skip
    return Track(begins, ends, np.array([q, to]), np.zeros(chain.count) if rates is None else rates)


def track_of_end(
    chain: Chain, q: Array, to: Array, begins: float, ends: float, rates: Array | None = None
) -> Track:  # fmt: skip
    """Joint positions that take the end effector straight to a point of the vehicle.

    Parameters
    ----------
    chain : Chain
    q : (n,) array
        Where it begins.
    to : (3,) array
        m, FRD, from the vehicle's centre of mass.
    begins, ends : float
        s.
    rates : (n,) array, optional
        Of the joints at the beginning: none.

    Raises
    ------
    InputError
        A point that the arm does not reach along the straight line within its limits, with the first place on the way that it
        misses; joints that still move.
    """
    if rates is not None and np.max(np.abs(rates), initial=0.0) > AT_REST:
        raise InputError("joints that still move", "an end effector that begins at rest", column="end")
    start = kane.pose(chain, q).end
    rows, here = [np.array(q)], np.array(q)
    low, high = (np.array([getattr(j, name) for j in chain.joints]) for name in ("low", "high"))
    for share in np.linspace(0.0, 1.0, STRAIGHT)[1:]:
        wanted = start + share * (to - start)
        here = _reached(chain, here, wanted)
        missed = float(np.linalg.norm(kane.pose(chain, here).end - wanted))
        short = missed > 1e3 * CLOSE
        if short or np.any(here < low) or np.any(here > high):
            beyond = [j.name for j, q_j in zip(chain.joints, here, strict=True) if not j.low <= q_j <= j.high]
            why = "no joint positions put it there" if short else f"{' and '.join(beyond)} would pass a limit"
            raise input_error(
                "arm.straight_line_end", column="end", place=_place(chain, to), place_2=_place(chain, start),
                place_3=_place(chain, wanted), why=why,
            )  # fmt: skip
        rows.append(here)
    return Track(begins, ends, np.array(rows))


def _place(chain: Chain, point: Array) -> str:
    """A point from the vehicle's centre of mass as people state it: from the datum."""
    return f"[{', '.join(f'{v + 0.0:.4g}' for v in np.round(point - chain.datum, 9))}]"


def _reached(chain: Chain, q: Array, wanted: Array) -> Array:
    """Joint positions for a place of the end effector, by damped steps of Gauss and Newton from near it."""
    here = np.array(q)
    for _ in range(ITERATIONS):
        at = kane.pose(chain, here)
        short = wanted - at.end
        if np.linalg.norm(short) < CLOSE:
            break
        slope = np.column_stack(
            [
                np.cross(axis, at.end - pivot) if joint.turns else axis
                for joint, axis, pivot in zip(chain.joints, at.axis, at.pivot, strict=True)
            ]
        )
        step = np.linalg.lstsq(slope.T @ slope + 1e-12 * np.eye(chain.count), slope.T @ short, rcond=None)[0]
        size = float(np.linalg.norm(step))
        here = here + step * min(1.0, 0.5 / size if size > 0.0 else 1.0)
    return here

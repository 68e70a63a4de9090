"""What is ordered in each phase of a manoeuvre, as arrays, checked against the vehicle that has to follow it; what a march through it gives."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.types import Array, dataclass
from coeflab.law.force_law import BASE, Ints
from coeflab.law.symbols import CONTROLS
from coeflab.motion.manoeuvre import Manoeuvre
from coeflab.motion.vehicle import Vehicle
from coeflab.vehicle.parameter_parts import ParameterCurve

COMPLETE, NOT_FINITE, TOO_FAST, STEP_TOO_SMALL = range(4)


@dataclass(frozen=True, slots=True, eq=False)
class Late:
    """Thrusters that follow their commands with a lag, k of them, of members in phases.

    Attributes
    ----------
    names : tuple of str
    lag : (k,) array
        s.
    curves : tuple
        Of thrust, and of torque or None, of each.
    begin : (1 or m, k) array
        What they do at the start.
    ordered : (1 or m, p, k) array
    levers : (1 or m, p, k, 2, 6) array
        Force and moment of one newton of thrust and of one newton metre of torque.
    """

    names: tuple[str, ...]
    lag: Array
    curves: tuple[tuple[ParameterCurve, ParameterCurve | None], ...]
    begin: Array
    ordered: Array
    levers: Array

    def actual(self, before: Array, who: Ints, phase: Ints, since: Array) -> Array:
        """(n, k) what each does a time (n,) after its order, from what it did before (n, k)."""
        return lagged(before, self.ordered[who % len(self.ordered), phase], self.lag, since[:, None])

    def course(self, member: int, time: Array, phase: Ints, switches: Array) -> dict[str, Array]:
        """What each does over time, by name, of a member whose phases end at these times."""
        who, since = np.array([member]), 0.0
        before, out = self.begin[who % len(self.begin)], np.zeros((len(time), len(self.lag)))
        for k, end in enumerate(switches.tolist()):
            at, here = phase == k, np.array([k])
            out[at] = self.actual(before, who, here, time[at] - since)
            if not math.isfinite(end):
                break
            before, since = self.actual(before, who, here, np.array([end - since])), end
        return dict(zip(self.names, out.T, strict=True))

    def wrench(self, actual: Array, who: Ints, phase: Ints) -> Array:
        """(6, n) force and moment at what they do (n, k)."""
        given = [
            [[c.at(x) if c else 0.0 for c in pair] for pair, x in zip(self.curves, row, strict=True)]
            for row in actual.tolist()
        ]
        return np.asarray(np.einsum("nkc,nkci->in", np.array(given), self.levers[who % len(self.levers), phase]))

    def knots(self, before: Array, who: Ints, phase: Ints) -> Array:
        """(j, n) times from the order at which an end of a segment is passed; infinite where it is not."""
        target = self.ordered[who % len(self.ordered), phase]
        times = [np.full((1, len(who)), np.inf)]
        for k, pair in enumerate(self.curves):
            ends = np.unique([x for c in pair if c for s in c.segments for x in (s.low, s.high)])[:, None]
            share = np.divide(
                target[:, k] - ends,
                target[:, k] - before[:, k],
                out=np.ones((len(ends), len(who))),
                where=target[:, k] != before[:, k],
            )
            between = (share > 0.0) & (share < 1.0)
            times.append(np.where(between, -self.lag[k] * np.log(np.where(between, share, 1.0)), np.inf))
        return np.vstack(times)


def lagged(before: Array, command: Array, lag: Array, since: Array) -> Array:
    """What follows a command by ``lag d(actual)/dt = command - actual`` a time after it was given."""
    return np.asarray(command + (before - command) * np.exp(-np.maximum(since, 0.0) / lag))


WATCHED = ("heading", "yaw_rate", "pitch", "pitch_rate", "roll", "roll_rate", "depth", "u", "speed", "turned")
NEAR = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Orders:
    """Orders of p phases.

    Attributes
    ----------
    angles : (p, 3) array
        Ordered dr, ds, db, rad.
    begin : (3,) array
        Angles at the start, rad.
    rate : (3,) array
        Of the angles, rad/s; infinite: at once.
    wrench : (p, 6) or (m, p, 6) array
        Of the thrusters.
    watched : (p,) int array
        Index into `WATCHED` of what ends the phase; -1 for none.
    sign : (p,) array
        1 where it must rise through the value, -1 where it must fall.
    value : (p,) array
    longest : (p,) array
        s, positive.
    late : Late or None
        Thrusters that follow new commands with a lag; what they give is not in ``wrench``.
    """

    angles: Array
    begin: Array
    rate: Array
    wrench: Array
    watched: Ints
    sign: Array
    value: Array
    longest: Array
    late: Late | None = None

    @property
    def count(self) -> int:
        """Number of phases."""
        return len(self.longest)

    def steps(self, step: float) -> int:
        """Steps that the longest course of the manoeuvre takes."""
        return int(np.ceil(float(np.sum(self.longest)) / step - NEAR))


@dataclass(frozen=True, slots=True, eq=False)
class Marching:
    """Motions of m members through p phases.

    Attributes
    ----------
    times : (n,) array
        Of the records, s.
    records : (m, n, 14) array
        States; not a number after a member's end.
    switch_time : (m, p) array
        When each phase ended; not a number where it did not.
    switch_state : (m, p, 14) array
    met : (m, p) bool array
        Whether a phase ended by its condition, not by time.
    ended : (m,) int array
        `COMPLETE`, `NOT_FINITE`, `TOO_FAST` or `STEP_TOO_SMALL`.
    end_time : (m,) array
    end_state : (m, 14) array
        The last that is finite.
    """

    times: Array
    records: Array
    switch_time: Array
    switch_state: Array
    met: NDArray[np.bool_]
    ended: Ints
    end_time: Array
    end_state: Array


def blank(members: int, orders: Orders, step: float, every: int) -> Marching:
    """A march that has not begun, to be filled; a record each so many steps."""
    phases = orders.count
    times = np.asarray(np.arange(orders.steps(step) // every + 1) * every * step, dtype=np.float64)
    return Marching(
        times=times,
        records=np.full((members, len(times), 14), np.nan),
        switch_time=np.full((members, phases), np.nan),
        switch_state=np.full((members, phases, 14), np.nan),
        met=np.zeros((members, phases), dtype=np.bool_),
        ended=np.zeros(members, dtype=np.int64),
        end_time=np.zeros(members),
        end_state=np.zeros((members, 14)),
    )


def watched_value(which: int, state: Array) -> Array:
    """(n,) what `WATCHED` names, of states (14, n)."""
    w, x, y, z = state[3:7]
    match WATCHED[which]:
        case "heading":
            return np.asarray(state[13])
        case "yaw_rate":
            return np.asarray(state[12])
        case "pitch":
            return np.asarray(np.arcsin(np.clip(2 * (w * y - x * z), -1.0, 1.0)))
        case "pitch_rate":
            return np.asarray(state[11])
        case "roll":
            return np.asarray(np.arctan2(2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
        case "roll_rate":
            return np.asarray(state[10])
        case "depth":
            return np.asarray(state[2])
        case "u":
            return np.asarray(state[7])
        case "turned":
            return np.asarray(np.abs(state[13]))
    return np.asarray(np.sqrt(state[7] ** 2 + state[8] ** 2 + state[9] ** 2))


def ramp(begin: Array, target: Array, rate: Array, since: Array) -> Array:
    """(3, n) angles a time after the order was given; angles (3, 1 or n), rate (3,), time (n,)."""
    reach, since = np.broadcast_arrays(reach_time(begin, target, rate), np.maximum(since, 0.0))
    part = np.divide(since, reach, out=np.ones(reach.shape), where=reach > since)
    return np.asarray(np.where(part < 1.0, begin + (target - begin) * part, target))


def reach_time(begin: Array, target: Array, rate: Array) -> Array:
    """(3, n) time from the order until each angle stands."""
    return np.asarray(np.abs(target - begin) / rate[:, None])


def standing_orders(manoeuvre: Manoeuvre) -> tuple[Mapping[str, float], ...]:
    """What stands in each phase: its own orders, and before them those that were given earlier."""
    out, current = [], dict(manoeuvre.orders)
    for phase in manoeuvre.phases:
        current = current | dict(phase.orders)
        out.append(current)
    return tuple(out)


def orders_of(vehicle: Vehicle, manoeuvre: Manoeuvre) -> Orders:
    """Arrays of a manoeuvre.

    Raises
    ------
    InputError
        No phases, a phase without time, an unknown name or quantity, an angle that the surface does not reach or that no
        coefficient responds to, a tilt beyond its range, a number that is not finite.
    """
    if not manoeuvre.phases:
        raise InputError("a manoeuvre without phases", "at least one", column=manoeuvre.name)
    standing = standing_orders(manoeuvre)
    for number, phase in enumerate(manoeuvre.phases):
        where = f"{manoeuvre.name}.{phase.name}"
        if not (math.isfinite(phase.longest) and phase.longest > 0.0):
            raise InputError(f"a longest time of {phase.longest:g} s", "a positive one", column=where)
        if phase.until is not None and phase.until.quantity not in WATCHED:
            raise InputError(shown(phase.until.quantity), f"one of {', '.join(WATCHED)}", column=where)
        _check(vehicle, standing[number], where)
    _check(vehicle, manoeuvre.orders, manoeuvre.name)
    surfaces = {s.control: s for s in vehicle.surfaces}
    rates = [surfaces[c].rate if c in surfaces else None for c in CONTROLS]
    untils = [p.until for p in manoeuvre.phases]
    commands = [{k: v for k, v in current.items() if k not in CONTROLS} for current in standing]
    late = _late(vehicle, manoeuvre.orders, commands)
    commands = [{k: v for k, v in current.items() if not late or k not in late.names} for current in commands]
    return Orders(
        angles=np.array([[current.get(c, 0.0) for c in CONTROLS] for current in standing]),
        begin=np.array([manoeuvre.orders.get(c, 0.0) for c in CONTROLS], dtype=np.float64),
        rate=np.array([np.inf if r is None else r for r in rates]),
        wrench=np.array([vehicle.wrench(c) for c in commands]),
        watched=np.array([-1 if u is None else WATCHED.index(u.quantity) for u in untils], dtype=np.int64),
        sign=np.array([1.0 if u is None or u.rises else -1.0 for u in untils]),
        value=np.array([0.0 if u is None else u.value for u in untils]),
        longest=np.array([p.longest for p in manoeuvre.phases], dtype=np.float64), late=late,
    )  # fmt: skip


def _late(vehicle: Vehicle, begin: Mapping[str, float], commands: Sequence[Mapping[str, float]]) -> Late | None:
    """Thrusters with a lag whose commands change."""
    names = [t.name for t in vehicle.thrusters]
    selected = [
        t for t in vehicle.thrusters
        if t.lag is not None and any(c.get(t.name, 0.0) != begin.get(t.name, 0.0) for c in commands)
    ]  # fmt: skip
    if not selected:
        return None
    levers = [[vehicle.levers(names.index(t.name), c.get(f"{t.name}.tilt", 0.0)) for t in selected] for c in commands]
    return Late(
        names=tuple(t.name for t in selected), lag=np.array([t.lag for t in selected], dtype=np.float64),
        curves=tuple((t.curve, t.torque_curve) for t in selected),
        begin=np.array([[begin.get(t.name, 0.0) for t in selected]], dtype=np.float64),
        ordered=np.array([[[c.get(t.name, 0.0) for t in selected] for c in commands]], dtype=np.float64), levers=np.array([levers]),
    )  # fmt: skip


def _check(vehicle: Vehicle, orders: Mapping[str, float], where: str) -> None:
    surfaces = {s.control: s for s in vehicle.surfaces}
    tilts = {f"{t.name}.tilt": t for t in vehicle.thrusters}
    acting = {BASE[k] for k in vehicle.law.source}
    for name, value in orders.items():
        place = f"{where}.{name}"
        if not math.isfinite(value):
            raise InputError(f"{value}", "a finite number", column=place)
        if name in CONTROLS:
            if value and name not in acting:
                raise InputError(f"an angle of {name}", "a control that a coefficient responds to", column=place)
            limit = surfaces[name].limit if name in surfaces else math.inf
            if abs(value) > limit * (1.0 + 1e-9):
                raise InputError(f"{value:g} rad", f"at most {limit:g} rad either way, as the file says", column=place)
        elif name in tilts and not tilts[name].tilt_low - 1e-9 <= value <= tilts[name].tilt_high + 1e-9:
            low, high = tilts[name].tilt_low, tilts[name].tilt_high
            raise InputError(f"{value:g} rad", f"a tilt from {low:g} to {high:g} rad", column=place)


def beyond_curves(vehicle: Vehicle, manoeuvre: Manoeuvre) -> tuple[str, ...]:
    """Commands beyond what a thruster's curve holds, where the thrust at its end stands in; in words."""
    out = []
    for t in vehicle.thrusters:
        asked = [current[t.name] for current in standing_orders(manoeuvre) if t.name in current]
        if asked and not t.curve.low <= min(asked) <= max(asked) <= t.curve.high:
            out.append(
                f"{t.name} is ordered {min(asked):g} to {max(asked):g} {t.curve.unit}; its curve holds "
                f"{t.curve.low:g} to {t.curve.high:g}; beyond, the thrust at the end is used"
            )
    return tuple(out)

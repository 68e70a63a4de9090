"""Vehicles and ensembles through manoeuvres: the step is chosen and checked here, and the arrays become trajectories."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.limits import MOTION_STEPS, require_rows
from coeflab.core.machine import compiles
from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass
from coeflab.law.symbols import CONTROLS
from coeflab.motion.dynamics import Dynamics
from coeflab.motion.ensemble import STILL, Ensemble, alone
from coeflab.motion.integrators import fixed_step as plain
from coeflab.motion.integrators.adaptive import march_adaptive
from coeflab.motion.integrators.fixed_step import fast_eigenvalues, largest_step
from coeflab.motion.manoeuvre import Manoeuvre
from coeflab.motion.orders import NEAR, Late, Marching, Orders, beyond_curves, orders_of, ramp, standing_orders
from coeflab.motion.trajectory import Ended, Trajectory, ended_by_tables, outside
from coeflab.motion.vehicle import Vehicle

KERNELS = ("auto", "numpy", "compiled")
ENDED = (Ended.COMPLETE, Ended.NOT_FINITE, Ended.TOO_FAST, Ended.STEP_TOO_SMALL)
# A quarter of the fastest mode's time, of which the scheme stands 2.8, and the time for a twentieth of a length.
PER_MODE, PER_LENGTH = 0.25, 0.05
WIDER = "Take more time between rows: --record, or a shorter manoeuvre."


@dataclass(frozen=True, slots=True, eq=False)
class Marched:
    """Motions of all members of an ensemble.

    Attributes
    ----------
    ensemble : Ensemble
    manoeuvres : tuple of Manoeuvre
        One, or one a member.
    orders : Orders
    marching : Marching
        Arrays: ``times`` (n,), ``records`` (m, n, 14), ``switch_time`` (m, p), ``ended`` (m,) and so on.
    step : float
        s; zero where the steps were adaptive.
    """

    ensemble: Ensemble
    manoeuvres: tuple[Manoeuvre, ...]
    orders: Orders
    marching: Marching
    step: float

    @property
    def ended(self) -> tuple[Ended, ...]:
        """How each member ended."""
        return tuple(ENDED[code] for code in self.marching.ended)

    def trajectory(self, i: int = 0) -> Trajectory:
        """Motion of one member: its records, the states where orders changed, and its end."""
        found, phases = self.marching, self.orders.count
        manoeuvre = self.manoeuvres[i if len(self.manoeuvres) > 1 else 0]
        member = self.ensemble.member(i)
        switches = found.switch_time[i]
        selected = np.isfinite(found.records[i, :, 0])
        done = np.isfinite(switches)
        time = np.concatenate([found.times[selected], switches[done], found.end_time[i : i + 1]])
        rows = np.vstack([found.records[i, selected], found.switch_state[i, done], found.end_state[i : i + 1]])
        order = np.argsort(time, kind="stable")
        time, rows = time[order], rows[order]
        distinct = np.concatenate([[True], np.diff(time) > NEAR * max(float(found.times[-1]), 1.0) / len(found.times)])
        time, rows = time[distinct], rows[distinct]
        ends = np.where(done, switches, np.inf)
        phase = np.minimum(np.searchsorted(ends, time, side="right"), phases - 1)
        controls = self._controls(manoeuvre, time, phase, switches)
        if self.orders.late is not None:
            controls |= self.orders.late.course(i, time, phase, switches)
        how = ENDED[int(found.ended[i])]
        flags = outside(member, rows[:, 7:13], {c: x for c, x in controls.items() if c in CONTROLS})
        motion = Trajectory(
            time=time, position=rows[:, :3], attitude=rows[:, 3:7], velocity=rows[:, 7:13], heading=rows[:, 13],
            controls=controls, phase=phase, phases=tuple(p.name for p in manoeuvre.phases),
            reached=tuple(float(t) if met else None for t, met in zip(switches, found.met[i], strict=True)),
            outside=flags, ended=how, why=_why(how, float(found.end_time[i]), found.end_state[i], self.step),
            statements=(*member.statements, *manoeuvre.statements, *beyond_curves(member, manoeuvre)),
        )  # fmt: skip
        return ended_by_tables(member, motion)

    def _controls(
        self, manoeuvre: Manoeuvre, time: Array, phase: NDArray[np.int64], switches: Array
    ) -> dict[str, Array]:
        standing = standing_orders(manoeuvre)
        angles = np.zeros((3, len(time)))
        begin, since = self.orders.begin[:, None], 0.0
        for k in range(self.orders.count):
            target, rate = self.orders.angles[k][:, None], self.orders.rate
            at = phase == k
            angles[:, at] = ramp(begin, target, rate, time[at] - since)
            if not np.isfinite(switches[k]):
                break
            begin, since = ramp(begin, target, rate, switches[k : k + 1] - since), float(switches[k])
        names = dict.fromkeys(name for current in standing for name in current)
        surfaces = {s.control for s in self.ensemble.vehicle.surfaces}
        out = {c: angles[k] for k, c in enumerate(CONTROLS) if c in names or c in surfaces}
        for name in names:
            if name not in CONTROLS:
                out[name] = np.array([current.get(name, 0.0) for current in standing])[phase]
        return out


def march(
    moved: Vehicle | Ensemble,
    manoeuvre: Manoeuvre | Sequence[Manoeuvre],
    step: float = 0.0,
    record: float = 0.0,
    kernel: str = "auto",
    current: Array = STILL,
) -> Marched:
    """March by the fixed-step scheme; a member that fails stops alone.

    Parameters
    ----------
    moved : Vehicle or Ensemble
    manoeuvre : Manoeuvre, or one a member
        Those of members may differ in their start and in what thrusters give, not in their phases.
    step : float
        s; zero: chosen from the fastest small motion and from the time to pass a length.
    record : float
        Time between records, s; zero: every step. The step is shortened until the time is a whole number of them.
    kernel : {"auto", "numpy", "compiled"}
        Auto: compiled where numba is installed.
    current : (3,) array
        North, east, down, m/s.

    Raises
    ------
    InputError
        Orders that the vehicle cannot follow, a step beyond what the scheme stands, no numba where it was asked for.
    """
    ensemble = moved if isinstance(moved, Ensemble) else alone(moved)
    manoeuvres = (manoeuvre,) if isinstance(manoeuvre, Manoeuvre) else tuple(manoeuvre)
    orders, start = _arrays(ensemble, manoeuvres)
    dynamics = ensemble.dynamics(np.asarray(current, dtype=np.float64))
    compiled = _compiled(kernel)
    chosen = _step(ensemble, dynamics, orders, start, step)
    every = 1
    duration = float(np.sum(orders.longest))
    if record > 0.0:
        require_rows(duration / record, "record", WIDER)
        every = max(1, int(np.ceil(record / chosen - NEAR)))
        chosen = record / every
    count = duration / chosen
    if count > MOTION_STEPS:
        raise input_error("motion.too_many_steps", column="step", count=count, chosen=chosen, motion_steps=MOTION_STEPS)
    require_rows(count / every, "record", WIDER)
    if compiled:
        from coeflab.motion.integrators.compiled import march as run
    else:
        run = plain.march
    return Marched(
        ensemble, manoeuvres, orders, run(dynamics, orders, start, chosen, every, _fastest(ensemble, start)), chosen
    )


def chosen_step(ensemble: Ensemble, manoeuvre: Manoeuvre, current: Array = STILL) -> float:
    """The step that `march` chooses for an ensemble, s: one for all parts of an ensemble that is marched in parts."""
    orders, start = _arrays(ensemble, (manoeuvre,))
    return _step(ensemble, ensemble.dynamics(np.asarray(current, dtype=np.float64)), orders, start, 0.0)


def march_by_tolerance(
    vehicle: Vehicle, manoeuvre: Manoeuvre, record: float = 0.0, tolerance: float = 1e-9, current: Array = STILL
) -> Marched:
    """March one vehicle by an adaptive integrator; ``record`` zero: a hundredth of the time, at most a tenth of L/U."""
    ensemble = alone(vehicle)
    orders, start = _arrays(ensemble, (manoeuvre,))
    if record <= 0.0:
        record = min(manoeuvre.duration / 100.0, 0.1 * vehicle.length / max(vehicle.speed, NEAR))
    require_rows(float(np.sum(orders.longest)) / record, "record", WIDER)
    dynamics = ensemble.dynamics(np.asarray(current, dtype=np.float64))
    found = march_adaptive(dynamics, orders, start[0], record, _fastest(ensemble, start), tolerance)
    return Marched(ensemble, (manoeuvre,), orders, found, 0.0)


def _arrays(ensemble: Ensemble, manoeuvres: tuple[Manoeuvre, ...]) -> tuple[Orders, Array]:
    """Orders, and the states at the start."""
    if len(manoeuvres) not in (1, ensemble.count):
        raise InputError(f"{len(manoeuvres)} manoeuvres", f"one, or one for each of {ensemble.count} members")
    if any(m.others or any(p.medium for p in m.phases) for m in manoeuvres):
        raise input_error("motion.manoeuvre_through_two_media", column="medium")
    each = [orders_of(ensemble.vehicle, m) for m in manoeuvres]
    for name in ("angles", "begin", "watched", "sign", "value", "longest"):
        if any(not np.array_equal(getattr(o, name), getattr(each[0], name)) for o in each):
            raise input_error("motion.manoeuvres_whose_phases_differ", column=name)
    start = np.zeros((len(manoeuvres), 14))
    start[:, 3:7] = [m.attitude / np.linalg.norm(m.attitude) for m in manoeuvres]
    start[:, 7:13] = [m.velocity for m in manoeuvres]
    if not np.isfinite(start).all():
        raise InputError("a start that is not finite", "velocities and an attitude", column=manoeuvres[0].name)
    wrench, late = each[0].wrench, each[0].late
    if len(each) > 1:
        wrench = np.array([o.wrench for o in each])
        if late is not None or any(o.late for o in each):
            late = _together([o.late for o in each])
    return replace(each[0], wrench=wrench, late=late), np.repeat(start, ensemble.count // len(manoeuvres), axis=0)


def _together(each: Sequence[Late | None]) -> Late:
    """Thrusters with a lag of all members."""
    alike = [late for late in each if late is not None]
    if len(alike) < len(each) or len({late.names for late in alike}) > 1:
        raise input_error("motion.thrusters_with_lag_change", column="lag")
    begin, ordered, levers = (
        np.concatenate([getattr(late, n) for late in alike]) for n in ("begin", "ordered", "levers")
    )
    return replace(alike[0], begin=begin, ordered=ordered, levers=levers)


def _fastest(ensemble: Ensemble, start: Array) -> float:
    """Speed that no sound motion reaches."""
    return min(1e3, 100.0 * max(float(np.max(np.linalg.norm(start[:, 7:10], axis=1))), ensemble.vehicle.speed))


def _step(ensemble: Ensemble, dynamics: Dynamics, orders: Orders, start: Array, asked: float) -> float:
    """The step, checked against the fastest motion at the start and at the file's speed."""
    v = ensemble.vehicle
    ahead = start.T.copy()
    ahead[7] = np.where(np.linalg.norm(start[:, 7:10], axis=1) < v.speed, v.speed, ahead[7])
    size = max(float(np.max(np.abs(start[:, 7:10]))), v.speed)
    scale = np.array([1.0] * 7 + [size] * 3 + [size / v.length] * 3 + [1.0])
    wrench = orders.wrench.reshape(-1, orders.count, 6)[0, 0]
    found = [fast_eigenvalues(dynamics, state, orders.angles[0], wrench, scale) for state in (start.T, ahead)]
    if not np.isfinite(found).all():
        raise input_error("motion.rates_not_finite", column="coefficients")
    most = largest_step(np.array(found))
    fastest = float(np.max(np.abs(found)))
    if orders.late is not None:
        fastest = max(fastest, 1.0 / float(np.min(orders.late.lag)))
    if asked > most:
        raise input_error("motion.step_unstable", column="step", asked=asked, most=most, fastest=fastest)
    if asked > 0.0:
        return asked
    return min(PER_MODE / max(fastest, NEAR), PER_LENGTH * v.length / size, float(np.min(orders.longest)))


def _compiled(kernel: str) -> bool:
    if kernel not in KERNELS:
        raise InputError(kernel, f"one of {', '.join(KERNELS)}", column="kernel")
    if kernel == "compiled" and not compiles():
        raise InputError("the compiled kernel without numba", "numba", advice='Install "coeflab[fast]", or use numpy.')
    return kernel != "numpy" and compiles()


def _why(how: Ended, time: float, state: Array, step: float) -> str:
    """What happened, with time and state; empty where nothing did."""
    if how is Ended.COMPLETE:
        return ""
    shorter = f"; a step shorter than {step:.3g} s, or the adaptive integrator, may help" if step else ""
    happened = {
        Ended.NOT_FINITE: f"the next state is not finite{shorter}",
        Ended.TOO_FAST: f"the speed diverges{shorter}",
        Ended.STEP_TOO_SMALL: "the integrator finds no step that keeps its tolerance",
    }[how]
    values = " ".join(f"{v:.4g}" for v in state[7:13])
    place = ", ".join(f"{v:.4g}" for v in state[:3])
    return f"stopped at {time:.6g} s: {happened}. u v w p q r = {values}; position {place} m"

"""Dive-and-surface cycles of a glider in the vertical plane.

Equations in `coeflab.motion.glider.motion`, with the errata of the THAUV paper; scipy's LSODA integrates from kink to kink
of the engine's and the sliding mass's motion. Deeply submerged: no surface, no waves, no current, one water density.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import require_rows
from coeflab.core.options import bounded, parse_options
from coeflab.core.types import Array
from coeflab.motion.glider.glider import Glider
from coeflab.motion.glider.motion import Leg, Setting, legs, march, momentum, velocity
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.trajectory import Ended, Trajectory

summary = "vertical-plane glider with a sliding mass and a buoyancy engine: dive-and-surface cycles in time"
citations = ("leonard_graver2001", "thauv")


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the integration.

    Attributes
    ----------
    step : float
        Time between rows, s; it does not touch the accuracy.
    tolerance : float
        Relative tolerance of the integration.
    """

    step: float = bounded(1.0, 1e-3, 3600.0)
    tolerance: float = bounded(1e-8, 1e-12, 1e-3)


def simulate(vehicle: Glider, manoeuvre: Manoeuvre, options: Mapping[str, Any]) -> Trajectory:
    """Fly a manoeuvre.

    Parameters
    ----------
    vehicle : Glider
    manoeuvre : Manoeuvre
        Orders ``net_mass``, kg, and ``position`` of the sliding mass, m, which move at the rates of the glider; a phase
        ends by time or by depth. It starts in the vertical plane, heading north, at depth zero.
    options : mapping
        See `Options`.

    Returns
    -------
    Trajectory
        Its ``ended`` says whether all phases were flown; a failed integration keeps what came before.

    Raises
    ------
    InputError
        Unknown options or orders, a phase that ends by something else, a start out of the plane, more than a million rows.
    """
    chosen = parse_options(Options, options, "glider")
    if not isinstance(vehicle, Glider):
        raise InputError("the vehicle of a parameter file", "a glider", column="glider", advice="See `coeflab glide`.")
    _check(manoeuvre, chosen.step)
    flight = _Flight(vehicle, manoeuvre, chosen)
    reached = []
    for i, phase in enumerate(manoeuvre.phases):
        reached.append(flight.time[-1] if not flight.why and flight.fly(i, phase) else None)
    rows = np.array(flight.rows)
    zero, half = np.zeros(len(rows)), rows[:, 2] / 2.0
    alpha = np.arctan2(rows[:, 4], rows[:, 3])
    outside = np.zeros(len(rows), dtype=bool)
    if vehicle.polar.covered is not None:
        outside = (np.hypot(rows[:, 3], rows[:, 4]) > 0.0) & ~_within(alpha, vehicle.polar.covered)
    return Trajectory(
        time=np.array(flight.time),
        position=np.column_stack([rows[:, 0], zero, rows[:, 1]]),
        attitude=np.column_stack([np.cos(half), zero, np.sin(half), zero]),
        velocity=np.column_stack([rows[:, 3], zero, rows[:, 4], zero, rows[:, 5], zero]),
        heading=zero,
        controls={"net_mass": rows[:, 6], "position": rows[:, 7]},
        phase=np.array(flight.phase),
        phases=tuple(p.name for p in manoeuvre.phases),
        reached=tuple(reached),
        outside={} if vehicle.polar.covered is None else {"alpha": outside},
        ended=flight.ended,
        why=flight.why,
        statements=_statements(vehicle, alpha, outside, rows[:, 3]),
    )


def _within(alpha: Array, covered: tuple[float, float]) -> NDArray[np.bool_]:
    return np.asarray((alpha >= covered[0]) & (alpha <= covered[1]))


def _check(manoeuvre: Manoeuvre, step: float) -> None:
    """Raise for what a glider in the vertical plane cannot fly."""
    for phase in manoeuvre.phases:
        if unknown := [o for o in phase.orders if o not in Setting._fields]:
            raise InputError(f"the order {shown(unknown[0])} in {phase.name}", "net_mass or position", column="glider")
        if phase.until is not None and phase.until.quantity != "depth":
            raise InputError(f"{phase.name} until {phase.until.quantity}", "until a depth, or a time", column="glider")
    off_plane = np.concatenate([manoeuvre.velocity[[1, 3, 5]], manoeuvre.attitude[[1, 3]]])
    if np.any(off_plane):
        raise InputError(
            "a start with sway, roll or yaw", "a start in the vertical plane, heading north", column="glider"
        )
    require_rows(manoeuvre.duration / step, "glider.step", "Take a larger step.")


def _statements(vehicle: Glider, alpha: Array, outside: NDArray[np.bool_], u: Array) -> tuple[str, ...]:
    """What the motion asks of the polar."""
    steepest = float(np.max(np.abs(np.degrees(alpha))))
    out = []
    if vehicle.polar.covered is None:
        out.append(f"The polar does not say which angles of attack it covers; the motion reaches {steepest:.1f} deg.")
    elif outside.any():
        out.append(
            f"{np.mean(outside):.1%} of the rows lie outside of the angles of attack that the polar covers; the motion "
            f"reaches {steepest:.1f} deg there, by extrapolation."
        )
    if np.any(u < -1e-9):
        out.append("The glider moves astern for a while, for which the polar is not made.")
    return tuple(out)


class _Flight:
    """The rows so far and where it stands."""

    def __init__(self, glider: Glider, manoeuvre: Manoeuvre, options: Options) -> None:
        self.body, self.options = glider.body, options
        self.rate = Setting(glider.engine.rate, glider.sliding_mass.rate)
        self.now = Setting(*(manoeuvre.orders.get(name, 0.0) for name in Setting._fields))
        pitch = 2.0 * float(np.arctan2(manoeuvre.attitude[2], manoeuvre.attitude[0]))
        moving = [float(v) for v in manoeuvre.velocity[[0, 2, 4]]]
        self.state = np.array([0.0, 0.0, pitch, *momentum(self.body, moving, self.now.position, 0.0)])
        self.time, self.phase, self.rows = [0.0], [0], [[0.0, 0.0, pitch, *moving, *self.now]]
        self.ended, self.why = Ended.COMPLETE, ""

    def fly(self, index: int, phase: Phase) -> bool:
        """Fly one phase; whether it met its depth."""
        ordered = self.now._replace(**phase.orders)
        until = None if phase.until is None else (phase.until.value, phase.until.rises)
        for leg in legs(self.time[-1], phase.longest, self.now, ordered, self.rate):
            found = march(self.body, leg, self.state, self.options.step, until, self.options.tolerance)
            for time, state in zip(found.time, found.state, strict=True):
                self._row(index, float(time), state, leg)
            if found.why:
                self.why = (
                    f"in {phase.name}, after {self.time[-1]:.6g} s at {self.rows[-1][1]:.4g} m depth: {found.why}"
                )
                self.ended = Ended.STEP_TOO_SMALL if found.finite else Ended.NOT_FINITE
                return False
            if found.met:
                return True
        return False

    def _row(self, index: int, time: float, state: Array, leg: Leg) -> None:
        self.state, self.now = state, leg.setting(time)
        moving = velocity(self.body, [float(v) for v in state[3:]], self.now.position, leg.rate.position)
        self.time.append(time)
        self.phase.append(index)
        self.rows.append([*(float(v) for v in state[:3]), *moving, *self.now])

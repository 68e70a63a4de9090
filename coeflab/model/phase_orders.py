"""The orders of a manoeuvre as arrays, checked against the vehicle that has to follow them."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.symbols import CONTROLS
from coeflab.kernels.motion_law import BASE
from coeflab.kernels.orders import WATCHED, Orders
from coeflab.model.manoeuvre import Manoeuvre
from coeflab.model.vehicle import Vehicle


def standing_orders(manoeuvre: Manoeuvre) -> tuple[Mapping[str, float], ...]:
    """What stands in each phase: its own orders, and before them those that were given earlier."""
    out, stands = [], dict(manoeuvre.orders)
    for phase in manoeuvre.phases:
        stands = stands | dict(phase.orders)
        out.append(stands)
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
    commands = [{k: v for k, v in stands.items() if k not in CONTROLS} for stands in standing]
    return Orders(
        angles=np.array([[stands.get(c, 0.0) for c in CONTROLS] for stands in standing]),
        begin=np.array([manoeuvre.orders.get(c, 0.0) for c in CONTROLS], dtype=np.float64),
        rate=np.array([np.inf if r is None else r for r in rates]),
        wrench=np.array([vehicle.wrench(c) for c in commands]),
        watched=np.array([-1 if u is None else WATCHED.index(u.quantity) for u in untils], dtype=np.int64),
        sign=np.array([1.0 if u is None or u.rises else -1.0 for u in untils]),
        value=np.array([0.0 if u is None else u.value for u in untils]),
        longest=np.array([p.longest for p in manoeuvre.phases], dtype=np.float64),
    )


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
        asked = [stands[t.name] for stands in standing_orders(manoeuvre) if t.name in stands]
        if asked and not t.curve.low <= min(asked) <= max(asked) <= t.curve.high:
            out.append(
                f"{t.name} is ordered {min(asked):g} to {max(asked):g} {t.curve.unit}; its curve holds "
                f"{t.curve.low:g} to {t.curve.high:g}, and the thrust at the end stands in"
            )
    return tuple(out)

"""Where a motion leaves what the coefficients cover."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import ANGULAR, CONTROLS, LINEAR, MOTIONS
from coeflab.kernels.motion_law import SLOWEST
from coeflab.model.table import number
from coeflab.model.vehicle import Vehicle, control_rows

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
# A value on the edge of a range is inside, with the rounding of a motion; motions below MOVING count as none.
SLACK, MOVING = 1e-6, 1e-3
ASTERN, TABLE_EDGE = "astern", "beyond a table's edge"
UNCOVERED = "no data cover it"


def outside(vehicle: Vehicle, velocity: Array, controls: Mapping[str, Array]) -> dict[str, Flags]:
    """For every variable, (n,) whether the motion lies outside of its ranges.

    A motion or control that no range speaks of is named ``r': no data cover it`` and flagged where it is not small (beyond
    0.001 in prime form, or in rad). Further entries: ``astern``, and ``beyond a table's edge`` where tables stand in the law.

    Parameters
    ----------
    vehicle : Vehicle
    velocity : (n, 6) array
    controls : mapping of str to (n,) array
        dr, ds, db, rad.
    """
    values = _values(vehicle, velocity, controls)
    out: dict[str, Flags] = {}
    spoken = set()
    for name, ranges in _ranges(vehicle).items():
        if name in values:
            motion, x = values[name]
            spoken.add(motion)
            inside = [(x >= low - SLACK) & (x <= high + SLACK) for low, high in ranges]
            out[name] = np.asarray(~np.any(inside, axis=0))
    for name in (*(f"{m}'" for m in MOTIONS[1:]), *(c for c in CONTROLS if c in controls)):
        motion, x = values[name]
        if motion not in spoken and np.any(np.abs(x) > MOVING):
            out[f"{name}: {UNCOVERED}"] = np.abs(x) > MOVING
    speed = np.maximum(np.linalg.norm(velocity[:, :3], axis=1), SLOWEST)
    out[ASTERN] = velocity[:, 0] < -SLACK * speed
    if np.any(vehicle.law.tabled):
        out[TABLE_EDGE] = vehicle.law.held(velocity, control_rows(controls, len(velocity)))
    return out


def outside_in_words(vehicle: Vehicle, velocity: Array, controls: Mapping[str, float]) -> tuple[str, ...]:
    """A sentence for every variable of one motion that lies outside of its ranges.

    Parameters
    ----------
    vehicle : Vehicle
    velocity : (6,) array
    controls : mapping of str to float
        dr, ds, db, rad.
    """
    rows, angles = velocity[None, :], {c: np.array([x]) for c, x in controls.items()}
    values, flags = _values(vehicle, rows, angles), outside(vehicle, rows, angles)
    out = []
    for name, ranges in _ranges(vehicle).items():
        if name in values and flags[name][0]:
            factor, unit = (180.0 / np.pi, " deg") if name in CONTROLS or name.startswith("asin") else (1.0, "")
            spans = " or ".join(f"{number(low * factor)} to {number(high * factor)}{unit}" for low, high in ranges)
            here = f"{number(float(values[name][1][0]) * factor)}{unit}"
            out.append(f"{name} = {here} lies outside of what the data cover, {spans}.")
    return tuple(out)


def _values(vehicle: Vehicle, velocity: Array, controls: Mapping[str, Array]) -> dict[str, tuple[str, Array]]:
    """Every variable that a range can speak of: the motion or control behind it, and its (n,) values."""
    speed = np.maximum(np.linalg.norm(velocity[:, :3], axis=1), SLOWEST)
    primes = {m: velocity[:, k] / speed for k, m in enumerate(MOTIONS)}
    primes |= {m: primes[m] * vehicle.length for m in ANGULAR}
    values: dict[str, tuple[str, Array]] = {f"{m}'": (m, primes[m]) for m in MOTIONS}
    values |= {f"asin({m}/U)": (m, np.arcsin(np.clip(primes[m], -1.0, 1.0))) for m in LINEAR}
    return values | {c: (c, controls[c]) for c in CONTROLS if c in controls}


def _ranges(vehicle: Vehicle) -> dict[str, list[tuple[float, float]]]:
    """Ranges of every variable, from low to high, those that touch joined."""
    out: dict[str, list[tuple[float, float]]] = {}
    for c in sorted(vehicle.covered, key=lambda c: c.low):
        joined = out.setdefault(c.variable, [])
        if joined and c.low <= joined[-1][1] + SLACK:
            joined[-1] = joined[-1][0], max(joined[-1][1], c.high)
        else:
            joined.append((c.low, c.high))
    return {name: out[name] for name in dict.fromkeys(c.variable for c in vehicle.covered)}

"""Where a motion leaves what the coefficients cover."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import ANGULAR, CONTROLS, LINEAR, MOTIONS
from coeflab.kernels.motion_law import SLOWEST
from coeflab.model.vehicle import Vehicle, control_rows

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
SLACK, MOVING = 1e-6, 1e-3
ASTERN, TABLE_EDGE = "astern", "beyond a table's edge"


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
    speed = np.maximum(np.linalg.norm(velocity[:, :3], axis=1), SLOWEST)
    primes = {m: velocity[:, k] / speed for k, m in enumerate(MOTIONS)}
    primes |= {m: primes[m] * vehicle.length for m in ANGULAR}
    values: dict[str, tuple[str, Array]] = {f"{m}'": (m, primes[m]) for m in MOTIONS}
    values |= {f"asin({m}/U)": (m, np.arcsin(np.clip(primes[m], -1.0, 1.0))) for m in LINEAR}
    values |= {c: (c, controls[c]) for c in CONTROLS if c in controls}
    out: dict[str, Flags] = {}
    spoken = set()
    for name in dict.fromkeys(c.variable for c in vehicle.covered):
        if name in values:
            motion, x = values[name]
            spoken.add(motion)
            ranges = [c for c in vehicle.covered if c.variable == name]
            inside = [(x >= c.low - SLACK) & (x <= c.high + SLACK) for c in ranges]
            out[name] = np.asarray(~np.any(inside, axis=0))
    for motion, x in (*((m, primes[m]) for m in MOTIONS[1:]), *((c, controls[c]) for c in CONTROLS if c in controls)):
        if motion not in spoken and np.any(np.abs(x) > MOVING):
            out[f"{motion}{'' if motion in CONTROLS else chr(39)}: no data cover it"] = np.abs(x) > MOVING
    out[ASTERN] = velocity[:, 0] < -SLACK * speed
    if np.any(vehicle.law.tabled):
        out[TABLE_EDGE] = vehicle.law.held(velocity, control_rows(controls, len(velocity)))
    return out

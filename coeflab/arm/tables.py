"""Motions of a vehicle with an arm as tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import Table

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.motion.trajectory import Trajectory

NOTHING = 1e-3  # mm, deg, N: less is not printed


def arm_phases(trajectory: Trajectory, name: str) -> Table:
    """Vehicle, end effector and joints of an arm where the motion begins and where each phase ends; largest torques within it."""
    t, rows = trajectory, []
    ends = [int(np.flatnonzero(t.phase == k)[-1]) for k in range(len(t.phases)) if np.any(t.phase == k)]
    at = [0, *ends]
    rows.append(("time", "s", *(f"{t.time[i]:.4g}" for i in at)))
    for k, axis in enumerate(("north", "east", "down")):
        rows.append((f"vehicle, {axis}", "m", *(f"{t.position[i, k]:.4f}" for i in at)))
    for k, angle in enumerate(("roll", "pitch", "yaw")):
        rows.append((f"vehicle, {angle}", "deg", *(f"{np.degrees(t.angles[i, k]) + 0.0:.2f}" for i in at)))
    for key, values in t.controls.items():
        what, _, unit = key.removesuffix("]").partition(" [")
        if what.endswith(".wanted"):
            continue
        if what.startswith("end."):
            rows.append((f"end effector, {what[4:]}", unit, *(f"{values[i]:.4f}" for i in at)))
        elif what.endswith((".torque", ".force")):
            joint, _, effort = what.rpartition(".")
            most = [f"{np.max(np.abs(values[t.phase == k])):.3g}" for k in range(len(ends))]
            rows.append((f"{joint}, largest {effort}", unit, "", *most))
        elif "." not in what and unit in ("rad", "m"):
            factor, shown = (180.0 / np.pi, "deg") if unit == "rad" else (1.0, unit)
            rows.append((what, shown, *(f"{factor * values[i]:.2f}" for i in at)))
    if "end.north.wanted [m]" in t.controls:
        rows += [
            (name, unit, "", *(_largest(values[t.phase == k]) for k in range(len(ends))))
            for name, unit, values in _missed(t)
        ]
    headers = ("", "unit", "start", *(f"after {t.phases[k]}" for k in range(len(ends))))
    notes = (
        "vehicle, north, east, down: of its centre of mass, the arm not counted; places count from where that began.",
    )
    return Table(f"Motion of {name}", headers, tuple(rows), notes, frozenset({0, 1}))


def _missed(t: Trajectory) -> tuple[tuple[str, str, Array], ...]:
    """How far a vehicle under control is from its station, its end effector from its track, and what that takes."""
    wanted = [
        t.controls[f"end.{axis}.wanted [m]"] - t.controls[f"end.{axis} [m]"] for axis in ("north", "east", "down")
    ]
    turned = 2.0 * np.degrees(np.arccos(np.clip(np.abs(t.attitude @ t.attitude[0]), 0.0, 1.0)))
    names = [key.removesuffix(".wanted [N]") for key in t.controls if key.endswith(".wanted [N]")]
    thrusts = [np.abs(t.controls[f"{name} [N]"]) for name in names]
    return (
        ("off station, largest", "mm", 1e3 * np.linalg.norm(t.position - t.position[0], axis=1)),
        ("turned off, largest", "deg", turned),
        ("end effector off its track, largest", "mm", 1e3 * np.linalg.norm(wanted, axis=0)),
        ("thrust, largest", "N", np.max(thrusts, axis=0)),
    )


def _largest(values: Array) -> str:
    if not np.isfinite(values).any():
        return ""
    most = float(np.nanmax(values))
    return f"{most:.3g}" if most > NOTHING else f"below {NOTHING:g}"

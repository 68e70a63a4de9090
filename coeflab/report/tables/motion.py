"""Motions and their figures as tables, CSV and Parquet."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import ABSENT, Table
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.wording import collected
from coeflab.law.symbols import CONTROLS
from coeflab.report.tables.nouns import NO_VALUE

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.motion.manoeuvre import Figure
    from coeflab.motion.trajectory import Trajectory

DEGREES = {"rad": "deg", "rad/s": "deg/s"}

ROUNDING = 1e-10  # of a length, a radian, a second, the unit of a ratio: less is printed as 0


def figure_table(figures: tuple[Figure, ...], title: str, length: float) -> Table:
    """Value, unit, the value in body lengths, interval, status and definition of every figure."""
    rows = []
    bounded = any(f.low is not None for f in figures)
    for f in figures:
        factor, unit = (180.0 / np.pi, DEGREES[f.unit]) if f.unit in DEGREES else (1.0, f.unit)
        lengths = f"{round(f.value / length, 3) + 0.0:.3f}" if f.value is not None and f.unit == "m" else ""
        dust = f.value is not None and abs(f.value) < ROUNDING * (length if f.unit == "m" else 1.0)
        value = ABSENT if f.value is None else "0" if dust else f"{f.value * factor:.5g}"
        interval = "" if f.low is None or f.high is None else f"{f.low * factor:.4g} .. {f.high * factor:.4g}"
        rows.append(
            (f.name, value, "" if unit == "1" else unit, lengths, *((interval,) if bounded else ()), NO_VALUE if f.status == "not determined" else f.status,
             f.definition)
        )  # fmt: skip
    headers = ("quantity", "value", "unit", "in L", *(("95 % interval",) if bounded else ()), "status", "definition")
    reasons = collected((f.why, f.name) for f in figures if f.why)
    notes = tuple(f"{_listed(names, len(figures))}: {why}" for why, names in reasons.items())
    if any(row[3] for row in rows):
        notes += (f"in L: over the reference length L = {length:.4g} m",)
    return Table(
        title, headers, tuple(rows), notes, frozenset({0, 2, len(headers) - 2, len(headers) - 1}), ("definition",)
    )


def _listed(names: list[str], everything: int) -> str:
    return "All quantities" if len(names) == everything > 1 else ", ".join(names)


def columns(trajectory: Trajectory) -> dict[str, Array]:
    """Every column with its unit in the name, in the order of the CSV."""
    t, x, nu, angles = trajectory, trajectory.position, trajectory.velocity, trajectory.angles
    out: dict[str, Array] = {"t [s]": t.time}
    for i, name in enumerate(("north", "east", "down")):
        out[f"{name} [m]"] = x[:, i]
    for i, name in enumerate(("phi", "theta", "psi")):
        out[f"{name} [rad]"] = angles[:, i]
    out["heading [rad]"] = t.heading
    for i, (name, unit) in enumerate(zip("uvwpqr", ("m/s",) * 3 + ("rad/s",) * 3, strict=True)):
        out[f"{name} [{unit}]"] = nu[:, i]
    for name, values in t.controls.items():
        unit = "rad" if name in CONTROLS or name.endswith(".tilt") else "command" if name != "thrust" else "N"
        out[name if name.endswith("]") else f"{name} [{unit}]"] = values
    outside = np.zeros(len(t.time), dtype=bool)
    for flags in t.outside.values():
        outside |= flags
    out["phase [-]"] = t.phase.astype(float)
    out["outside [-]"] = outside.astype(float)
    return out


def motion_csv(trajectory: Trajectory) -> bytes:
    """One row a time, seventeen digits at most, so that reading gives back the numbers."""
    named = columns(trajectory)
    whole = {"phase [-]", "outside [-]"}
    rows = [
        [f"{int(v)}" if k in whole else repr(float(v)) for k, v in zip(named, row, strict=True)]
        for row in zip(*named.values(), strict=True)
    ]
    return csv_text([list(named), *rows]).encode()


def motion_parquet(trajectory: Trajectory) -> bytes:
    """The same columns as Parquet.

    Raises
    ------
    ImportError
        No pyarrow.
    """
    import pandas as pd

    buffer = io.BytesIO()
    pd.DataFrame(columns(trajectory)).to_parquet(buffer, index=False, engine="pyarrow")
    return buffer.getvalue()

"""A record over time that was handed in for a table of forces: its positions move at the speed of its velocities."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from coeflab.core.errors import InputError
from coeflab.tables.raw_table import RawColumn, RawTable

TIMES = ("t", "time", "zeit", "temps")
FEWEST = 5  # rows
LIKE = (
    0.7,
    1.4,
)  # median ratio of the speed over ground to that through the water: a current or a slack clock may lie between


def record_over_time(raw: RawTable) -> Iterator[InputError]:
    """The complaint about columns x and y that are positions and no forces; in one unit, whatever it is.

    Parameters
    ----------
    raw : RawTable
    """
    by_name = {_plain(c.name): c for c in raw.columns if not c.is_text}
    time = next((by_name[name] for name in TIMES if name in by_name), None)
    if time is not None:
        yield from _oscillation(raw, time, by_name)
    x, y, u = (by_name.get(name) for name in "xyu")
    if time is None or x is None or y is None or u is None:
        return
    across = by_name.get("v")
    rows = np.flatnonzero(np.all([np.isfinite(c.values) for c in (time, x, y, u)], axis=0))
    if len(rows) < FEWEST or np.any(np.diff(time.values[rows]) <= 0.0):
        return
    over_ground = np.hypot(*(np.diff(c.values[rows]) / np.diff(time.values[rows]) for c in (x, y)))
    speed = np.hypot(u.values[rows], 0.0 if across is None else np.nan_to_num(across.values[rows]))
    between = (speed[1:] + speed[:-1]) / 2.0
    if np.any(between <= 0.0) or not LIKE[0] < float(np.median(over_ground / between)) < LIKE[1]:
        return
    yield InputError(
        f"a record over time: {_named(x, y)} move at the speed of {_named(u, across)}", "forces of steady runs",
        file=raw.path, column=x.name, advice="coeflab identify fits coefficients to records over time.",
    )  # fmt: skip


def _oscillation(raw: RawTable, time: RawColumn, by_name: dict[str, RawColumn]) -> Iterator[InputError]:
    """The complaint about a body that is moved to and fro: y, z, psi or theta, whose rate is v, w, r or q."""
    for place, rate in (("y", "v"), ("z", "w"), ("psi", "r"), ("theta", "q")):
        path, speed = by_name.get(place), by_name.get(rate)
        if path is None or speed is None:
            continue
        rows = np.flatnonzero(np.all([np.isfinite(c.values) for c in (time, path, speed)], axis=0))
        if len(rows) < FEWEST or np.any(np.diff(time.values[rows]) <= 0.0):
            continue
        moved = np.diff(path.values[rows]) / np.diff(time.values[rows])
        between = (speed.values[rows][1:] + speed.values[rows][:-1]) / 2.0
        size = float(between @ between)
        if not size > 0.0:
            continue
        ratio, whole = abs(float(moved @ between)) / size, float(moved @ moved) / size
        turns = (1.0,) if place in ("y", "z") else (1.0, 180.0 / np.pi, np.pi / 180.0)
        if any(LIKE[0] < ratio / per < LIKE[1] and whole < 2.0 * per**2 for per in turns):
            yield InputError(
                f"a record over time: {path.name} moves at the speed of {speed.name}", "forces of steady runs", file=raw.path,
                column=speed.name, advice="coeflab formats pmm says how records of oscillating runs are read.",
            )  # fmt: skip
            return


def _plain(name: str) -> str:
    """A heading without its unit: ``y [m]`` is y."""
    return re.sub(r"\s*[\[(].*", "", name.strip()).casefold()


def _named(*columns: RawColumn | None) -> str:
    return " and ".join(c.name for c in columns if c is not None)

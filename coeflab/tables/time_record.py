"""A record over time that was handed in for a table of forces: its positions move at the speed of its velocities."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.texts import input_error
from coeflab.core.wording import listed
from coeflab.law.symbols import ANGULAR
from coeflab.tables.column_names import named_as
from coeflab.tables.raw_table import RawColumn, RawTable

TIMES = ("t", "time", "zeit", "temps", "tempo", "timestamp", "seconds", "sec", "elapsed time", "simulation time")
HEADINGS = ("psi", "heading", "yaw", "hdg", "kurs", "cap")
FEWEST, MANY = 5, 50  # rows; of a file without names
CHANGES = 0.5  # of the rows that have a rate of their own
EVEN = 5.0  # largest over median step of a clock
IDENTIFY = "coeflab identify fits coefficients to records over time, of any text by --columns."
LIKE = (0.7, 1.4)  # median ratio of the speed over ground to that through the water, for a current or a slack clock
TURNED = (0.03, 0.4)  # standard deviation of a heading, rad: of many rows, of few
ALIKE = 0.8  # correlation of a heading with the course


def record_over_time(raw: RawTable) -> Iterator[InputError]:
    """The complaint about columns x and y that are positions and no forces; in one unit, whatever it is.

    Parameters
    ----------
    raw : RawTable
    """
    by_name = {_plain(c.name): c for c in raw.columns if not c.is_text}
    time = next((by_name[name] for name in TIMES if name in by_name), None)
    if time is None:
        return
    if moving := _in_motion(raw, time):
        yield input_error("tables.record_of_rates", raw.path, column=time.name, moving=moving, identify=IDENTIFY)
        return
    x, y, u, v = (by_name.get(name) for name in "xyuv")
    heading = next((by_name[name] for name in HEADINGS if name in by_name), None)
    if x is not None and y is not None and u is not None and _moves(time, x, y, u, v):
        found = f"{_named(x, y)} move at the speed of {_named(u, v)}"
    elif x is not None and y is not None and heading is not None and _heads(time, x, y, heading):
        found = f"{_named(x, y)} move where {heading.name} points"
    else:
        yield from _oscillation(raw, time, by_name)
        return
    yield input_error("tables.record_of_positions", raw.path, column=x.name, found=found, identify=IDENTIFY)


def _in_motion(raw: RawTable, time: RawColumn) -> str:
    """The rates of a flight or of a manoeuvre, two at least, of which hardly a row repeats another; empty for steady runs."""
    rows = _rising(time)
    if rows is None or len(rows) < MANY or np.max(steps := np.diff(time.values[rows])) > EVEN * np.median(steps):
        return ""
    rates = [c for c in raw.columns if not c.means and not c.is_text and named_as(c.name) in ANGULAR]
    moved = [c.name for c in rates if np.unique(c.values[rows]).size > CHANGES * len(rows)]
    return listed(moved) if len(moved) > 1 else ""


def clock(raw: RawTable) -> str:
    """What says that a table without a force is a record over time: a column that rises by its name, or in even steps; empty without one."""
    named = [c for c in raw.columns if _plain(c.name) in TIMES]
    some = named or [c for c in raw.columns[:1] if not c.unit and re.fullmatch(r"column \d+", c.name)]
    for c in some:
        if c.is_text or len(c.values) < (FEWEST if named else MANY) or not np.all(np.isfinite(c.values)):
            continue
        steps = np.diff(c.values)
        if np.all(steps > 0.0) and (named or np.max(steps) < EVEN * float(np.median(steps))):
            kind = "a record over time" if named else "no names, and perhaps a record over time"
            return f"{kind}: {c.name} rises from {c.values[0]:.4g} to {c.values[-1]:.4g}, and no column is named as a force"
    return ""


def _moves(time: RawColumn, x: RawColumn, y: RawColumn, u: RawColumn, v: RawColumn | None) -> bool:
    """Whether x and y move at the speed of u and v."""
    rows = _rising(time, x, y, u)
    if rows is None:
        return False
    over_ground = np.hypot(*(np.diff(c.values[rows]) / np.diff(time.values[rows]) for c in (x, y)))
    speed = np.hypot(u.values[rows], 0.0 if v is None else np.nan_to_num(v.values[rows]))
    between = (speed[1:] + speed[:-1]) / 2.0
    return bool(np.all(between > 0.0)) and LIKE[0] < float(np.median(over_ground / between)) < LIKE[1]


def _heads(time: RawColumn, x: RawColumn, y: RawColumn, heading: RawColumn) -> bool:
    """Whether x and y move ahead along a heading that turns, clockwise or not, from either of them, in degrees or radians."""
    rows = _rising(time, x, y, heading)
    if rows is None:
        return False
    course = np.unwrap(np.arctan2(*(np.diff(c.values[rows]) for c in (y, x))))
    for per in (1.0, np.pi / 180.0):
        turned = np.unwrap(heading.values[rows] * per)
        turned = (turned[1:] + turned[:-1]) / 2.0
        varies = float(np.std(turned))
        if varies < (TURNED[1] if len(rows) < MANY else TURNED[0]):  # curves of forces turn a little too
            continue
        slope = float(np.mean((turned - turned.mean()) * (course - course.mean()))) / varies**2
        alike = abs(slope) * varies / max(float(np.std(course)), 1e-12)
        if LIKE[0] < abs(slope) < LIKE[1] and alike > ALIKE:
            return True
    return False


def _rising(time: RawColumn, *columns: RawColumn) -> NDArray[np.intp] | None:
    """Rows where time and columns have numbers; None where these are few, or time does not rise."""
    rows = np.flatnonzero(np.all([np.isfinite(c.values) for c in (time, *columns)], axis=0))
    return None if len(rows) < FEWEST or np.any(np.diff(time.values[rows]) <= 0.0) else rows


def _oscillation(raw: RawTable, time: RawColumn, by_name: dict[str, RawColumn]) -> Iterator[InputError]:
    """The complaint about a body that is moved to and fro: y, z, psi or theta, whose rate is v, w, r or q."""
    for place, rate in (("y", "v"), ("z", "w"), ("psi", "r"), ("theta", "q")):
        path, speed = by_name.get(place), by_name.get(rate)
        if path is None or speed is None:
            continue
        rows = _rising(time, path, speed)
        if rows is None:
            continue
        moved = np.diff(path.values[rows]) / np.diff(time.values[rows])
        between = (speed.values[rows][1:] + speed.values[rows][:-1]) / 2.0
        size = float(between @ between)
        if not size > 0.0:
            continue
        ratio, whole = abs(float(moved @ between)) / size, float(moved @ moved) / size
        turns = (1.0,) if place in ("y", "z") else (1.0, 180.0 / np.pi, np.pi / 180.0)
        if any(LIKE[0] < ratio / per < LIKE[1] and whole < 2.0 * per**2 for per in turns):
            yield input_error(
                "tables.record_of_oscillation", raw.path, column=speed.name, path=path.name, speed=speed.name, identify=IDENTIFY,
            )  # fmt: skip
            return


def _plain(name: str) -> str:
    """A heading without its unit: ``y [m]`` is y."""
    return re.sub(r"\s*[\[(].*", "", name.strip()).casefold()


def _named(*columns: RawColumn | None) -> str:
    return " and ".join(c.name for c in columns if c is not None)

"""Reading figures off a motion that is known at times: crossings, values in between, extremes, periods."""

from __future__ import annotations

import numpy as np

from coeflab.core.types import Array


def crossing(time: Array, values: Array, level: float, rises: bool, after: float = -np.inf) -> float | None:
    """First time after ``after`` at which values pass a level in the stated direction, linear between rows; None if never.

    A row that lies on the level counts as passed.
    """
    signed = (values - level) if rises else (level - values)
    found = np.flatnonzero((signed[:-1] < 0.0) & (signed[1:] >= 0.0) & (time[1:] > after))
    if not len(found):
        return None
    i = int(found[0])
    share = signed[i] / (signed[i] - signed[i + 1])
    return float(time[i] + share * (time[i + 1] - time[i]))


def value_at(time: Array, values: Array, when: float) -> float:
    """Value at a time, linear between rows."""
    return float(np.interp(when, time, values))


def extreme(
    time: Array, values: Array, largest: bool, after: float, before: float = np.inf
) -> tuple[float, float] | None:
    """Time and value of the first local maximum (or minimum) between two times, by a parabola through three rows.

    None where the values have none there.
    """
    v = values if largest else -values
    inner = np.arange(1, len(v) - 1)
    peak = (v[inner] >= v[inner - 1]) & (v[inner] > v[inner + 1]) & (time[inner] > after) & (time[inner] < before)
    if not np.any(peak):
        return None
    i = int(inner[peak][0])
    t, y = time[i - 1 : i + 2] - time[i], v[i - 1 : i + 2]
    a, b, _ = np.linalg.solve(np.column_stack([t**2, t, np.ones(3)]), y)
    shift = float(np.clip(-b / (2.0 * a), t[0], t[2])) if a < 0.0 else 0.0
    height = float(y[1] + b * shift + a * shift**2)
    return float(time[i] + shift), height if largest else -height


def settled(time: Array, values: Array, window: float, tolerance: float) -> float | None:
    """Mean of the last ``window`` seconds if the values stay within ``tolerance`` of it, otherwise None."""
    last = time >= time[-1] - window
    if time[-1] - time[0] < window or np.count_nonzero(last) < 3:
        return None
    mean = float(np.mean(values[last]))
    return mean if float(np.max(np.abs(values[last] - mean))) <= tolerance else None


def decay(time: Array, values: Array) -> tuple[float, float] | None:
    """Period and damping ratio of a free decay about whatever the values settle at, from successive extremes of both signs.

    The logarithmic decrement is the slope of the logarithms of the swings from one extreme to the next, which hold no
    value of rest (ITTC 7.5-02-07-04.5, double amplitudes). None where there are fewer than three extremes.
    """
    found = extremes(time, values)
    if len(found) < 3:
        return None
    times, heights = found.T
    swings = np.abs(np.diff(heights))
    period = 2.0 * float(np.polyfit(np.arange(len(times)), times, 1)[0])
    decrement = -2.0 * float(np.polyfit(np.arange(len(swings)), np.log(swings), 1)[0])
    return period, decrement / float(np.hypot(2.0 * np.pi, decrement))


def extremes(time: Array, values: Array) -> Array:
    """(k, 2) times and values of successive maxima and minima, until a swing is a millionth of the first."""
    found: list[tuple[float, float]] = []
    moved = np.flatnonzero(values != values[0])
    largest = bool(len(moved)) and bool(values[moved[0]] > values[0])
    while (one := extreme(time, values, largest, found[-1][0] if found else float(time[0]))) is not None:
        if len(found) > 1 and abs(one[1] - found[-1][1]) < 1e-6 * abs(found[1][1] - found[0][1]):
            break
        found.append(one)
        largest = not largest
    return np.array(found).reshape(-1, 2)

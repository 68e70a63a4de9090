"""The weak form of an equation of motion: averages over windows in place of derivatives of noisy measurements.

A test function w(x) = (1 - x^2)^4 on -1 <= x <= 1 vanishes at both ends of its window, so that partial integration moves
the derivative from the measurement to the known function::

    <f> = int w f dt / int w dt        <df/dt> = - int w' f dt / int w dt

Measurements are taken as straight between their times, and the integrals of that are exact for any steps: the rate of a
constant is zero to rounding. Rows that are few for that are joined by splines first. Test functions and their use with
sparse regression: Gurevich, Reinbold & Grigoriev (2019),
Messenger & Bortz (2021), and pysindy's ``WeakPDELibrary``, which wants even steps and draws its windows at random.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from coeflab.core.types import Array, brief

POWER = 4
FEWEST = 8
FINE = 300.0
ROUNDING = 1e-9
_TEST = Polynomial([1.0, 0.0, -1.0]) ** POWER
_ONCE = _TEST.integ(lbnd=-1.0)
_TWICE = _ONCE.integ(lbnd=-1.0)
_WHOLE = float(_ONCE(1.0))


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Windows:
    """Windows over one time series.

    Attributes
    ----------
    time : (n,) array
        s, rising, any steps.
    centres : (m,) array
    half : float
        Half of a window, s.
    """

    time: Array
    centres: Array
    half: float

    def averages(self, values: Array, rates: Array) -> tuple[Array, Array]:
        """Averages of values and of the rates of others.

        Parameters
        ----------
        values : (n, k) array
        rates : (n, r) array
            Whose derivatives are averaged.

        Returns
        -------
        (m, k) array, (m, r) array
        """
        selected, moved = np.empty((len(self.centres), values.shape[1])), np.empty((len(self.centres), rates.shape[1]))
        for row, centre in enumerate(self.centres):
            rows, of_values, of_rates = self._weights(centre)
            selected[row], moved[row] = of_values @ values[rows], of_rates @ rates[rows]
        return selected, moved

    def _weights(self, centre: float) -> tuple[slice, Array, Array]:
        """Rows of a window, and what each counts for in the average of a value and of a rate."""
        first = max(int(np.searchsorted(self.time, centre - self.half, side="right")) - 1, 0)
        last = min(int(np.searchsorted(self.time, centre + self.half, side="left")) + 1, len(self.time))
        x = (self.time[first:last] - centre) / self.half
        step, inside = np.diff(x), np.clip(x, -1.0, 1.0)
        once = _ONCE(inside)
        area = np.diff(once)
        # Beyond the window the first integral stays, and the second one rises straight.
        lean = once[1:] * step - np.diff(_TWICE(inside) + _WHOLE * np.maximum(x - 1.0, 0.0))
        of_values, of_rates = np.zeros(len(x)), np.zeros(len(x))
        of_values[:-1] += area - lean / step
        of_values[1:] += lean / step
        of_rates[:-1] -= area / step
        of_rates[1:] += area / step
        return slice(first, last), of_values / _WHOLE, of_rates / (_WHOLE * self.half)


def refined(time: Array, columns: Array, half: float) -> tuple[Array, Array]:
    """The rows with others between them, on cubic splines, so that a window has `FINE` rows: straight pieces cut corners.

    Parameters
    ----------
    time : (n,) array
    columns : (n, k) array
    half : float
        Half of a window, s.
    """
    from scipy.interpolate import CubicSpline

    parts = int(np.ceil(FINE * float(np.median(np.diff(time))) / (2.0 * half)))
    if parts < 2:
        return time, columns
    between = np.concatenate([(time[:-1, None] + np.diff(time)[:, None] * np.arange(parts) / parts).ravel(), time[-1:]])
    return between, np.asarray(CubicSpline(time, columns, axis=0)(between))


def windows(time: Array, half: float, apart: float) -> Windows:
    """Windows at even distances over a series; those with too few rows or over a gap are left out.

    Parameters
    ----------
    time : (n,) array
    half : float
        Half of a window, s.
    apart : float
        Distance of the centres, s.
    """
    count = int(np.floor((time[-1] - time[0] - 2.0 * half) / apart * (1.0 + 1e-12))) + 1
    centres = time[0] + half + apart * np.arange(max(count, 0))
    return Windows(time, centres[filled(time, centres, half)], half)


def filled(time: Array, centres: Array, half: float) -> NDArray[np.bool_]:
    """(m,) whether a window has `FEWEST` rows at least, reaches over no end, and no step longer than a quarter of it."""
    low = np.searchsorted(time, centres - half, side="left")
    high = np.searchsorted(time, centres + half, side="right")
    inside = (centres - half >= time[0] - ROUNDING * half) & (centres + half <= time[-1] + ROUNDING * half)
    good: NDArray[np.bool_] = (high - low >= FEWEST) & inside
    for gap in np.flatnonzero(np.diff(time) > 0.5 * half):
        good &= (time[gap] >= centres + half) | (time[gap + 1] <= centres - half)
    return good

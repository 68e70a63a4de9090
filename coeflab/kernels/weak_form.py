"""The weak form of an equation of motion: averages over windows in place of derivatives of noisy measurements.

A test function w(x) = (1 - x^2)^4 on -1 <= x <= 1 vanishes at both ends of its window, so that partial integration moves
the derivative from the measurement to the known function::

    <f> = int w f dt / int w dt        <df/dt> = - int w' f dt / int w dt

Measurements are taken as straight between their times, and the integrals of that are exact for any steps: the rate of a
constant is zero to rounding. Test functions and their use with sparse regression: Gurevich, Reinbold & Grigoriev (2019),
Messenger & Bortz (2021), and pysindy's ``WeakPDELibrary``, which wants even steps and draws its windows at random.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from coeflab.kernels.least_squares import Array

POWER = 4
FEWEST = 8
_TEST = Polynomial([1.0, 0.0, -1.0]) ** POWER
_ONCE = _TEST.integ(lbnd=-1.0)
_TWICE = _ONCE.integ(lbnd=-1.0)
_WHOLE = float(_ONCE(1.0))


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
        kept, moved = np.empty((len(self.centres), values.shape[1])), np.empty((len(self.centres), rates.shape[1]))
        for row, centre in enumerate(self.centres):
            rows, of_values, of_rates = self._weights(centre)
            kept[row], moved[row] = of_values @ values[rows], of_rates @ rates[rows]
        return kept, moved

    def noise(self) -> tuple[Array, Array]:
        """(m,) standard deviations of both averages for a white noise of 1 in every row."""
        pairs = [self._weights(centre)[1:] for centre in self.centres]
        return np.array([np.linalg.norm(a) for a, _ in pairs]), np.array([np.linalg.norm(b) for _, b in pairs])

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


def windows(time: Array, half: float, apart: float) -> Windows:
    """Windows at even distances over a series; those over a gap in it are left out.

    Parameters
    ----------
    time : (n,) array
    half : float
        Half of a window, s.
    apart : float
        Distance of the centres, s.

    Notes
    -----
    A window counts with `FEWEST` rows and without a step longer than a quarter of it.
    """
    count = int(np.floor((time[-1] - time[0] - 2.0 * half) / apart * (1.0 + 1e-12))) + 1
    centres = time[0] + half + apart * np.arange(max(count, 0))
    low = np.searchsorted(time, centres - half, side="left")
    high = np.searchsorted(time, centres + half, side="right")
    gaps = np.flatnonzero(np.diff(time) > 0.5 * half)
    broken = np.zeros(len(centres), dtype=bool)
    for gap in gaps:
        broken |= (time[gap] < centres + half) & (time[gap + 1] > centres - half)
    good: NDArray[np.bool_] = (high - low >= FEWEST) & ~broken
    return Windows(time, centres[good], half)


def white_noise(values: Array) -> Array:
    """(k,) standard deviations of white noise on columns (n, k): from second differences, which a smooth motion has not.

    The median absolute one is taken, so that the kinks of a control do not count. Evenly spaced rows are assumed.
    """
    bends = values[2:] - 2.0 * values[1:-1] + values[:-2]
    return np.asarray(np.median(np.abs(bends), axis=0) / (0.6744897501960817 * np.sqrt(6.0)))

"""Small motions about a steady one: derivatives of the rates, and their eigenvalues."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass

Growth = Literal["stable", "neutral", "unstable"]
STEP = 1e-5
NEUTRAL = 1e-6
DUST = 1e-10  # of the largest entry of its row, for changes that count as one: less is rounding of the differences
KINK = 1e-4  # of a slope: slopes to either side differ by more where a curve has a knot
ALIKE = 1e10  # condition of the eigenvectors, beyond which left ones are rounding


def linearised(rates: Callable[[Array], Array], state: Array, scale: Array) -> Array:
    """Derivatives of the rates by the state, (n, n), by central differences.

    Parameters
    ----------
    rates : callable
        (n,) -> (n,), time derivatives of the state.
    state : (n,) array
    scale : (n,) array
        Differences are 1e-5 of it.
    """
    steps = STEP * scale
    columns = [(rates(state + d) - rates(state - d)) / (2.0 * h) for d, h in zip(np.diag(steps), steps, strict=True)]
    return np.column_stack(columns)


def modes(matrix: Array) -> NDArray[np.complex128]:
    """Eigenvalues, the least stable first; of a pair the one with positive imaginary part first."""
    found = np.asarray(np.linalg.eigvals(matrix), dtype=complex)
    return found[np.lexsort((-found.imag, -np.round(found.real, 12)))]


def growth(values: NDArray[np.complex128]) -> Growth:
    """``stable``, ``neutral`` or ``unstable``: the sign of the largest real part, neutral within 1e-6 of the fastest."""
    if values.size == 0:
        return "neutral"
    largest = float(np.max(values.real))
    if abs(largest) <= NEUTRAL * max(1.0, float(np.max(np.abs(values)))):
        return "neutral"
    return "unstable" if largest > 0.0 else "stable"


@dataclass(frozen=True, slots=True, eq=False)
class Slopes:
    """Derivatives by extrapolated central differences.

    Attributes
    ----------
    matrix : (m, n) array
    error : (m, n) array
        Twice the change when the steps are halved once more.
    kinks : (m, n) bool array
        Where slopes to either side differ: the entry is their mean.
    """

    matrix: Array
    error: Array
    kinks: Array

    def grown(self, rows: int, columns: int) -> Slopes:
        """With further rows and columns of zeros."""
        wider = ((0, rows), (0, columns))
        return Slopes(np.pad(self.matrix, wider), np.pad(self.error, wider), np.pad(self.kinks, wider))


def slopes(function: Callable[[Array], Array], point: Array, scale: Array, low: Array, high: Array) -> Slopes:
    """Differentiate a function at a point.

    Differences with the steps h = 1e-5 ``scale`` and h/2, extrapolated: 2 D(h/2) - D(h). That is exact for v|v| at v = 0, whose
    central difference is off by h. Next to a bound the differences go to its inner side alone.

    Parameters
    ----------
    function : callable
        (n,) -> (m,).
    point, scale : (n,) array
    low, high : (n,) array
        Bounds of the point; may be infinite.
    """
    middle = function(point)
    columns = []
    for i, h in enumerate(STEP * scale):
        ahead, behind = point[i] + h <= high[i], point[i] - h >= low[i]
        if not ahead and not behind:  # one value alone, as of a tilt that does not move
            ahead = behind = True

        def moved(step: float, i: int = i) -> Array:
            shifted = point.copy()
            shifted[i] += step
            return function(shifted)

        sides = [
            ((moved(step) - middle) / step if ahead else None, (middle - moved(-step)) / step if behind else None)
            for step in (h, h / 2.0, h / 4.0)
        ]
        means = [np.mean([s for s in pair if s is not None], axis=0) for pair in sides]
        first, second = 2.0 * means[1] - means[0], 2.0 * means[2] - means[1]
        jumps = [a - b for a, b in sides if a is not None and b is not None]
        jump = np.abs(2.0 * jumps[1] - jumps[0]) if jumps else np.zeros(len(middle))
        columns.append((first, 2.0 * np.abs(second - first), jump))
    matrix, error, jump = (np.array([c[k] for c in columns]).reshape(len(scale), len(middle)).T for k in range(3))
    size = np.abs(matrix) * scale
    largest = np.max(size, axis=1, initial=0.0, keepdims=True)
    kinks = (jump > KINK * np.abs(matrix)) & (jump * scale > 1e2 * DUST * largest) & (jump > 1e2 * error)
    dust = (size < DUST * largest) & ~kinks
    return Slopes(np.where(dust, 0.0, matrix), error, kinks)


def participation(matrix: Array) -> Array:
    """(n, n) share of every state (columns) in every mode (rows, in the order of `modes`); each row sums to one.

    Share of state k in mode i: abs(W[i, k] V[k, i]), V the right eigenvectors and W their inverse (Perez-Arriaga, Verghese and
    Schweppe 1982). Where eigenvectors coincide there is no inverse, and V alone is taken.

    Parameters
    ----------
    matrix : (n, n) array
    """
    values, right = np.linalg.eig(matrix)
    if len(values) and np.linalg.cond(right) < ALIKE:
        parts = np.abs(right * np.linalg.inv(right).T)
    else:
        parts = np.abs(right) ** 2
    parts = parts / np.sum(parts, axis=0, keepdims=True)
    left = list(range(len(values)))
    out = []
    for value in modes(matrix):
        nearest = min(left, key=lambda i: abs(values[i] - value))
        left.remove(nearest)
        out.append(parts[:, nearest])
    return np.array(out).reshape(len(values), len(values))

"""Two rows of a sweep that stand in each other's place: the likelihood ratio of their exchange, over all components together.

The likelihood is that of the mixture of curves of `coeflab.fits.statistics.data_gate`, restricted and Student, sizes of curve and
noise open. An exchange of the rows i, j adds d (e_i - e_j), d = y_j - y_i, to the readings, so every pair follows from one
product: S' = S + 2 d (P y)_i - 2 d (P y)_j + d^2 (P_ii + P_jj - 2 P_ij). One wrong row, or one wrong reading, is the other explanation:
an exchange counts where it explains more, a wrong reading lying anywhere within the range of its column.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import special

from coeflab.core.types import Array
from coeflab.fits.statistics.data_gate import ROUNDING, Gate

LEVEL = 0.01  # chance of a clean sweep to have any pair named, over all pairs
FEWEST = 5  # rows of a sweep: fewer leave a curve no row to spare for judging the pair


class Exchange(NamedTuple):
    """Two rows that suit the sweep in each other's place.

    Attributes
    ----------
    rows : (int, int)
        Places in the sweep.
    gain : float
        Log likelihood of the exchange over that of the rows as they stand.
    threshold : float
        It was held against: log of the number of pairs over `LEVEL`, or the gain of one wrong row where that is more.
    """

    rows: tuple[int, int]
    gain: float
    threshold: float


def _log_likelihood(gate: Gate, squares: Array, freedom: int, log_det: Array) -> Array:
    """(..., ) over members (..., k) with their residual squares and further determinants."""
    constant = float(special.gammaln(freedom / 2.0) - freedom / 2.0 * np.log(np.pi))
    return np.asarray(
        special.logsumexp(gate.log_prior - 0.5 * log_det - 0.5 * freedom * np.log(squares), axis=-1) + constant
    )


def gains(gate: Gate, y: Array) -> tuple[Array, Array]:
    """What exchanging each pair and what leaving out each row adds to the log likelihood of one component.

    Parameters
    ----------
    gate : Gate
        Of the settings.
    y : (n,) array
        Readings.

    Returns
    -------
    pairs : (n, n) array
        Symmetric, zero on the diagonal.
    wrong : (n,) array
        With the row anywhere within the range of the readings.
    """
    p, nu = gate.projection, gate.freedom
    floor = nu * (ROUNDING * float(np.abs(y).max())) ** 2
    across = p @ y  # (k, n)
    squares = across @ y  # (k,)
    pivot = np.einsum("kii->ki", p)
    step = y[None, :] - y[:, None]  # (n, n): y_j - y_i
    change = 2.0 * step * (across[:, :, None] - across[:, None, :])
    change = change + step**2 * (pivot[:, :, None] + pivot[:, None, :] - 2.0 * p)
    after = np.maximum(squares[:, None, None] + change, 0.0) + floor
    none = np.zeros(len(p))
    as_is = float(_log_likelihood(gate, squares + floor, nu, none))
    pairs = _log_likelihood(gate, np.moveaxis(after, 0, -1), nu, none) - as_is
    known = pivot > 1e-9 * pivot.max(1, keepdims=True)
    room = np.where(known, pivot, 1.0)
    left = np.maximum(squares[:, None] - across**2 / room, 0.0) + floor
    anywhere = -np.log(max(float(np.ptp(y)), 1e-300))
    wrong = _log_likelihood(gate, left.T, nu - 1, np.log(room.T)) + anywhere - as_is
    return pairs, np.where(known.any(0), wrong, 0.0)


def exchanged(gates: Sequence[Gate], readings: Sequence[Array]) -> tuple[Exchange, ...]:
    """Pairs of rows that stand in each other's place, the likeliest first; no row in two of them.

    Parameters
    ----------
    gates : sequence of Gate
        One a component, of the same settings.
    readings : sequence of (n,) array
    """
    x = gates[0].x
    n = len(x)
    if n < FEWEST:
        return ()
    each = [gains(gate, np.asarray(y, float)) for gate, y in zip(gates, readings, strict=True)]
    together = np.sum([pairs for pairs, _ in each], axis=0)
    one_row = np.sum([np.maximum(wrong, 0.0) for _, wrong in each], axis=0)
    other = max(float(one_row.max()), 0.0)
    threshold = float(np.log(n * (n - 1) / 2.0 / LEVEL))
    found: list[Exchange] = []
    for i, j in sorted(zip(*np.triu_indices(n, 1), strict=True), key=lambda pair: -together[pair]):
        gain = float(together[i, j])
        if gain <= max(threshold, other):
            break
        if not any({int(i), int(j)} & set(e.rows) for e in found):
            found.append(Exchange((int(i), int(j)), gain, max(threshold, other)))
    return tuple(found)

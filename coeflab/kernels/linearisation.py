"""Small motions about a steady one: derivatives of the rates, and their eigenvalues."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.least_squares import Array

Growth = Literal["stable", "neutral", "unstable"]
STEP = 1e-5
NEUTRAL = 1e-6


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

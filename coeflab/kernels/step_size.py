"""Steps that the classical Runge-Kutta scheme of order four stands: eigenvalues of the rates beside its region of stability."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.dynamics import Dynamics
from coeflab.kernels.least_squares import Array

DIFFERENCE = 1e-6
MOVING = slice(3, 13)
FARTHEST, HALVINGS = 4.0, 40
NEUTRAL = 1e-9


def fast_eigenvalues(
    dynamics: Dynamics, state: Array, controls: Array, wrench: Array, scale: Array
) -> NDArray[np.complex128]:
    """(m, 10) eigenvalues of small motions in attitude and velocity about states, by central differences.

    Parameters
    ----------
    dynamics : Dynamics
    state : (14, m) array
    controls : (3,) array
    wrench : (6,) array
    scale : (14,) array
        Size of each state; differences are 1e-6 of it.
    """
    members = state.shape[1]
    moved = range(14)[MOVING]
    steps = np.zeros((14, 2 * len(moved)))
    for column, row in enumerate(moved):
        steps[row, 2 * column], steps[row, 2 * column + 1] = DIFFERENCE * scale[row], -DIFFERENCE * scale[row]
    count = steps.shape[1]
    points = np.repeat(state, count, axis=1) + np.tile(steps, members)
    chosen = dynamics.members(np.repeat(np.arange(members), count))
    rates = chosen.rates(
        points, np.repeat(controls[:, None], points.shape[1], 1), np.repeat(wrench[:, None], points.shape[1], 1)
    )
    rates = rates[MOVING].reshape(len(moved), members, len(moved), 2)
    slopes = (rates[..., 0] - rates[..., 1]) / (2.0 * DIFFERENCE * scale[MOVING])
    return np.asarray(np.linalg.eigvals(slopes.transpose(1, 0, 2)), dtype=np.complex128)


def largest_step(eigenvalues: NDArray[np.complex128]) -> float:
    """Longest step at which no decaying motion grows in the scheme; infinite where none decays.

    The scheme multiplies a motion exp(lambda t) by R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24 in a step, z = lambda h (Hairer &
    Wanner, Solving Ordinary Differential Equations II, section IV.2): real z down to -2.785, imaginary z up to 2.828.
    """
    flat = eigenvalues.ravel()
    size = np.abs(flat)
    decaying = flat[(flat.real < -NEUTRAL * np.max(size, initial=0.0)) & (size > 0.0)]
    if not decaying.size:
        return float("inf")
    size = np.abs(decaying)
    low, high = np.zeros(len(size)), np.full(len(size), FARTHEST)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        z = middle * (decaying / size)
        stands = np.abs(1 + z * (1 + z / 2 * (1 + z / 3 * (1 + z / 4)))) <= 1.0
        low, high = np.where(stands, middle, low), np.where(stands, high, middle)
    return float(np.min(low / size))

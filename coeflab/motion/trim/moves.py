"""Two moves towards an operating point: onto the equations, and along them to the least effort.

Both work on a problem of scaled unknowns y and scaled equations f(y) = 0 with simple bounds. The first is a
Levenberg-Marquardt method whose every step is a linear least-squares problem with bounds (Stark & Parker 1995), so that
equations that depend on each other, or cannot hold, do no harm. The second keeps to the equations: a step in their
tangent space, Newton's where the Lagrangian is curved upwards, then the first move back onto them; it is accepted when
the effort 1/2 |w (y - target)|^2 falls.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass

Mask = NDArray[np.bool_]
# Scaled equations below HOLDS count as met, below EXACT no step is left to take; singular values below RANK of the largest
# are rounding: differences know slopes to about eps^(2/3) = 4e-11.
HOLDS, EXACT, RANK = 1e-9, 1e-12, 1e-8
# Steps of first and second differences: eps^(1/3) and eps^(1/4), where truncation and rounding are alike.
DIFFERENCE, BEND = 6e-6, 1e-4
# Most steps; Newton needs about ten, the rest is for starts far away and for bounds that come and go.
RESTORING, RETURNING, SELECTING = 150, 10, 60
REST = 1e-8  # relative size of a gradient that counts as zero


@dataclass(frozen=True, slots=True, eq=False)
class Scaled:
    """A problem in scaled unknowns.

    Attributes
    ----------
    equations : callable
        (n,) -> (m,), each about 1 when it is badly violated; defined 1e-4 beyond the bounds.
    slopes : callable
        (n,) -> (m, n), their derivatives.
    low, high : (n,) array
    target, weight : (n,) array
        Of the effort 1/2 |weight (spent(y) - target)|^2.
    spent : callable or None
        (n,) -> (n,), what the effort counts of each unknown, rising with it; the unknown itself where None.
    """

    equations: Callable[[Array], Array]
    slopes: Callable[[Array], Array]
    low: Array
    high: Array
    target: Array
    weight: Array
    spent: Callable[[Array], Array] | None = None

    def away(self, y: Array) -> Array:
        """(n,) weighted distances from the target, whose squares are twice the effort."""
        return np.asarray(self.weight * ((y if self.spent is None else self.spent(y)) - self.target))

    def effort(self, y: Array) -> float:
        """Half the weighted squares from the target."""
        away = self.away(y)
        return float(0.5 * (away @ away))

    def away_slopes(self, y: Array) -> Array:
        """(n,) slopes of `away`, each by its own unknown, by the steps of `differences`."""
        if self.spent is None:
            return self.weight
        step = DIFFERENCE * np.maximum(1.0, np.abs(y))
        ahead, behind = np.minimum(y + step, self.high), np.maximum(y - step, self.low)
        span = np.where(ahead > behind, ahead - behind, 1.0)
        return np.asarray((self.away(ahead) - self.away(behind)) / span)

    def pull(self, y: Array) -> Array:
        """(n,) slope of the effort."""
        return np.asarray(self.away_slopes(y) * self.away(y))

    def violation(self, y: Array) -> float:
        """The largest absolute equation, infinite where one is not finite."""
        value = self.equations(y)
        return float(np.max(np.abs(value), initial=0.0)) if np.all(np.isfinite(value)) else np.inf


def differences(function: Callable[[Array], Array], low: Array, high: Array) -> Callable[[Array], Array]:
    """Derivatives (m, n) by central differences that do not leave the bounds.

    Parameters
    ----------
    function : callable
        (m,) residuals of (n,) unknowns.
    low, high : (n,) array
        Bounds of the unknowns.
    """

    def slopes(y: Array) -> Array:
        columns = []
        for i in range(len(y)):
            ahead, behind = y.copy(), y.copy()
            step = DIFFERENCE * max(1.0, abs(float(y[i])))
            ahead[i], behind[i] = min(y[i] + step, high[i]), max(y[i] - step, low[i])
            span = ahead[i] - behind[i]
            columns.append((function(ahead) - function(behind)) / span if span > 0.0 else 0.0 * function(y))
        return np.column_stack(columns)

    return slopes


def bounded_step(matrix: Array, right: Array, low: Array, high: Array) -> Array:
    """The step p in [low, high] with the least |matrix p - right|.

    Parameters
    ----------
    matrix : (m, n) array
    right : (m,) array
    low, high : (n,) array
        Equal where the unknown is held.
    """
    from scipy.optimize import lsq_linear

    free = high > low
    step = np.zeros(len(low))
    if np.any(free):
        plain = np.linalg.lstsq(matrix[:, free], right, rcond=None)[0]
        inside = np.all(plain >= low[free]) and np.all(plain <= high[free])
        bounds = (low[free], high[free])
        step[free] = plain if inside else lsq_linear(matrix[:, free], right, bounds, method="bvls").x
    return np.asarray(np.clip(step, low, high))


def pressing(gradient: Array, y: Array, low: Array, high: Array) -> Mask:
    """Which bounds hold back a point that would go down a gradient, (n,) bool.

    Parameters
    ----------
    gradient, y : (n,) array
        Slope of the effort, and the point.
    low, high : (n,) array
    """
    return np.asarray(((y <= low) & (gradient > 0.0)) | ((y >= high) & (gradient < 0.0)))


def restored(problem: Scaled, start: Array, most: int = RESTORING) -> tuple[Array, bool]:
    """The nearest least violation of the equations, by bounded Levenberg-Marquardt steps.

    Parameters
    ----------
    problem : Scaled
    start : (n,) array
    most : int
        Steps.

    Returns
    -------
    point : (n,) array
    stationary : bool
        Whether the equations hold or no direction within the bounds lessens their squares to first order.
    """
    y = np.clip(start, problem.low, problem.high)
    value = problem.equations(y)
    if not np.all(np.isfinite(value)):
        return y, False
    cost, damping, n = float(value @ value), 1e-3, len(y)
    for _ in range(most):
        if np.max(np.abs(value)) <= EXACT:
            return y, True
        slopes = problem.slopes(y)
        if not np.all(np.isfinite(slopes)):
            return y, False
        gradient = slopes.T @ value
        gradient[pressing(gradient, y, problem.low, problem.high)] = 0.0
        if np.linalg.norm(gradient) <= REST * np.sqrt(cost) * np.linalg.norm(slopes) and np.sqrt(cost) > HOLDS:
            return y, True
        for _ in range(12):
            matrix = np.vstack([slopes, np.sqrt(damping) * np.eye(n)])
            right = np.concatenate([-value, np.zeros(n)])
            trial = np.clip(
                y + bounded_step(matrix, right, problem.low - y, problem.high - y), problem.low, problem.high
            )
            new = problem.equations(trial)
            lower = bool(np.all(np.isfinite(new))) and float(new @ new) < cost
            if lower:
                break
            damping = max(10.0 * damping, 1e-12)
        if not lower:
            break
        y, value, cost, damping = trial, new, float(new @ new), min(damping / 30.0, cost)
    return y, problem.violation(y) <= HOLDS


def tangent(slopes: Array, free: Mask) -> Array:
    """Directions of the free unknowns in which no equation changes, orthonormal, shape (n, k)."""
    _, singular, right = np.linalg.svd(slopes[:, free])
    rank = int(np.sum(singular > RANK * max(1.0, singular[0]))) if singular.size else 0
    out = np.zeros((slopes.shape[1], int(np.sum(free)) - rank))
    out[free] = right[rank:].T
    return out


def selected(problem: Scaled, start: Array) -> Array:
    """From a point on the equations along them to the least effort; a local least, within the bounds.

    Parameters
    ----------
    problem : Scaled
    start : (n,) array
        A point where the equations hold.
    """
    y = start
    for _ in range(SELECTING):
        slopes = problem.slopes(y)
        if not np.all(np.isfinite(slopes)):
            return y
        pull = problem.pull(y)
        step = _plain(problem, y, slopes)
        free = ((y > problem.low) | (step > 0.0)) & ((y < problem.high) | (step < 0.0))
        directions = tangent(slopes, free)
        if np.linalg.norm(directions.T @ pull) <= REST * (1.0 + np.linalg.norm(pull)):
            return y
        newton = directions @ _newton(problem, y, slopes, directions, free, pull)
        better = _accepted(problem, y, newton, 2)
        better = better if better is not None else _accepted(problem, y, step, 8)
        if better is None:
            return y
        y = better
    return y


def _plain(problem: Scaled, y: Array, slopes: Array) -> Array:
    """The step to the least effort on the tangent plane, with bounds, unknowns without weight held by a thread."""
    heavy = 1e5 * max(1.0, float(np.max(problem.weight)))
    slack, away = problem.away_slopes(y), problem.away(y)
    thread = 1e-2 * max(1e-3, float(np.max(problem.weight)))
    felt = slack > 1e-2 * thread if problem.spent is not None else problem.weight > 0.0
    matrix = np.vstack([heavy * slopes, np.diag(np.where(felt, slack, thread))])
    right = np.concatenate([np.zeros(len(slopes)), np.where(felt, -away, 0.0)])
    return bounded_step(matrix, right, problem.low - y, problem.high - y)


def _newton(problem: Scaled, y: Array, slopes: Array, directions: Array, free: Mask, pull: Array) -> Array:
    """Newton's step in tangent coordinates; the Hessian of the Lagrangian by second differences, made positive."""
    multipliers = np.linalg.lstsq(slopes[:, free].T, -pull[free], rcond=RANK)[0]

    def lagrangian(at: Array) -> float:
        return float(multipliers @ problem.equations(at)) + (0.0 if problem.spent is None else problem.effort(at))

    middle = lagrangian(y)

    def bend(along: Array) -> float:
        both = lagrangian(y + BEND * along) + lagrangian(y - BEND * along)
        found = (both - 2.0 * middle) / BEND**2
        return found if np.isfinite(found) else 0.0

    k = directions.shape[1]
    curved = np.zeros((k, k))
    alone = [bend(directions[:, i]) for i in range(k)]
    for i in range(k):
        curved[i, i] = alone[i]
        for j in range(i):
            both = bend(directions[:, i] + directions[:, j])
            curved[i, j] = curved[j, i] = (both - alone[i] - alone[j]) / 2.0
    plain = problem.weight[:, None] ** 2 * directions if problem.spent is None else 0.0 * directions
    hessian = directions.T @ plain + curved
    values, vectors = np.linalg.eigh(hessian)
    floor = 1e-6 * max(1e-12, float(np.max(np.abs(values), initial=0.0)))
    return np.asarray(-vectors @ ((vectors.T @ (directions.T @ pull)) / np.maximum(np.abs(values), floor)))


def _accepted(problem: Scaled, y: Array, step: Array, halvings: int) -> Array | None:
    """The point that a step or a part of it reaches back on the equations, if the effort falls."""
    before = problem.effort(y)
    for k in range(halvings):
        trial, _ = restored(problem, np.clip(y + step * 0.5**k, problem.low, problem.high), RETURNING)
        if problem.violation(trial) <= HOLDS and problem.effort(trial) < before * (1.0 - 1e-14):
            return trial
    return None

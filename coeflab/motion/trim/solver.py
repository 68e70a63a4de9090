"""Operating points: where a set of equations holds within bounds, and what else may be said of the solution.

The unknowns may be more than the equations (a family of solutions, out of which a rule selects), as many, or fewer; some
equations may say the same. Cold starts from seeded points inside the bounds tell whether there is another solution.

Two moves towards an operating point: onto the equations, and along them to the least effort.

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
        Of the effort 1/2 |weight (y - target)|^2.
    """

    equations: Callable[[Array], Array]
    slopes: Callable[[Array], Array]
    low: Array
    high: Array
    target: Array
    weight: Array

    def effort(self, y: Array) -> float:
        """Half the weighted squares from the target."""
        away = self.weight * (y - self.target)
        return float(0.5 * (away @ away))

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
        pull = problem.weight**2 * (y - problem.target)
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
    pull = np.where(problem.weight > 0.0, problem.weight, 1e-2 * max(1e-3, float(np.max(problem.weight))))
    towards = np.where(problem.weight > 0.0, problem.target - y, 0.0)
    matrix = np.vstack([heavy * slopes, np.diag(pull)])
    right = np.concatenate([np.zeros(len(slopes)), pull * towards])
    return bounded_step(matrix, right, problem.low - y, problem.high - y)


def _newton(problem: Scaled, y: Array, slopes: Array, directions: Array, free: Mask, pull: Array) -> Array:
    """Newton's step in tangent coordinates; the Hessian of the Lagrangian by second differences, made positive."""
    multipliers = np.linalg.lstsq(slopes[:, free].T, -pull[free], rcond=RANK)[0]
    middle = float(multipliers @ problem.equations(y))

    def bend(along: Array) -> float:
        both = problem.equations(y + BEND * along) + problem.equations(y - BEND * along)
        found = (float(multipliers @ both) - 2.0 * middle) / BEND**2
        return found if np.isfinite(found) else 0.0

    k = directions.shape[1]
    curved = np.zeros((k, k))
    alone = [bend(directions[:, i]) for i in range(k)]
    for i in range(k):
        curved[i, i] = alone[i]
        for j in range(i):
            both = bend(directions[:, i] + directions[:, j])
            curved[i, j] = curved[j, i] = (both - alone[i] - alone[j]) / 2.0
    hessian = directions.T @ (problem.weight[:, None] ** 2 * directions) + curved
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


DISTINCT = 1e-3  # of the scale of an unknown: solutions nearer than that are one, found twice
WALK = 1e-2
REACH = 10.0
NOTHING = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """Equations F(x) = 0 in unknowns with bounds.

    Attributes
    ----------
    equations : callable
        (n,) -> (m,).
    low, high : (n,) array
        Bounds; may be infinite, may be equal.
    scale : (n,) array
        A change of each unknown that counts as one.
    size : (m,) array
        A violation of each equation that counts as one; it holds to 1e-9 of that.
    target, weight : (n,) array
        The rule of selection: the least sum of (weight (x - target) / scale)^2; a weight of zero does not count.
    derivative : callable or None
        (n,) -> (m, n); central differences where None.
    """

    equations: Callable[[Array], Array]
    low: Array
    high: Array
    scale: Array
    size: Array
    target: Array
    weight: Array
    derivative: Callable[[Array], Array] | None = None

    def scaled(self) -> Scaled:
        """The same in unknowns and equations of order one."""

        def equations(y: Array) -> Array:
            return np.asarray(self.equations(y * self.scale) / self.size)

        low, high = self.low / self.scale, self.high / self.scale
        given = self.derivative
        slopes = differences(equations, low, high)
        if given is not None:
            exact = given

            def slopes(y: Array) -> Array:
                return np.asarray(exact(y * self.scale) * self.scale / self.size[:, None])

        return Scaled(equations, slopes, low, high, self.target / self.scale, self.weight)


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """A solution, or the least violation where there is none.

    Attributes
    ----------
    point : (n,) array
    residuals : (m,) array
        F at the point, in the units of the equations.
    holds : bool
        Whether every equation holds.
    settled : bool
        Whether the search came to rest: at a solution, or where no step lessens the violation.
    rank : int
        Of the derivatives by the unknowns that are not given (equal bounds).
    family : (n, k) array
        Directions in which solutions go on, unit length in scaled unknowns, each walked along and found to hold; at a
        bound to one side only.
    singular : bool
        Derivatives leave more directions open than solutions go on in.
    at_low, at_high : (n,) bool array
        Unknowns at a bound, those that are given aside.
    held : (n,) bool array
        Of those, the ones that would go on if they could: to lessen the violation, or the effort.
    others : (j, n) array
        Other solutions after the selection, the least effort first.
    starts, reached : int
        Starts tried, and those that came to some solution.
    """

    point: Array
    residuals: Array
    holds: bool
    settled: bool
    rank: int
    family: Array
    singular: bool
    at_low: Mask
    at_high: Mask
    held: Mask
    others: Array
    starts: int
    reached: int


def solve(problem: Problem, first: Array | None = None, starts: int = 8, seed: int = 0) -> Found:
    """Solve from the first point and from seeded ones, select, and say what kind of solution it is.

    Parameters
    ----------
    problem : Problem
    first : (n,) array, optional
        A start beside the seeded ones; the target of the selection where None.
    starts : int
        Number of seeded starts, even within the bounds; an open side reaches ten scales beyond the first point.
    seed : int
    """
    p = problem.scaled()
    origin = p.target if first is None else first / problem.scale
    points = _starts(p, origin, starts, seed)
    ends = [restored(p, y) for y in points]
    solved = [selected(p, y) for y, _ in ends if p.violation(y) <= HOLDS]
    if solved:
        best, others = _sorted(p, solved)
        return _described(problem, p, best, True, others, len(points), len(solved))
    y, settled = min(ends, key=lambda end: _squares(p, end[0]))
    return _described(problem, p, y, settled, [], len(points), 0)


def _starts(p: Scaled, origin: Array, count: int, seed: int) -> list[Array]:
    low = np.where(np.isfinite(p.low), p.low, np.minimum(origin, p.high) - REACH)
    high = np.where(np.isfinite(p.high), p.high, np.maximum(origin, p.low) + REACH)
    random = np.random.default_rng(seed)
    return [np.clip(origin, p.low, p.high), *(low + (high - low) * random.random((count, len(low))))]


def _squares(p: Scaled, y: Array) -> float:
    value = p.equations(y)
    return float(value @ value) if np.all(np.isfinite(value)) else np.inf


def _sorted(p: Scaled, solved: list[Array]) -> tuple[Array, list[Array]]:
    """The least effort, and solutions that differ from it and from each other in an unknown that the rule weighs.

    Ties go to the earlier start. Without any weight every unknown counts.
    """
    counts = p.weight > 0.0 if np.any(p.weight > 0.0) else np.ones(len(p.weight), dtype=bool)
    distinct: list[Array] = []
    for y in sorted(solved, key=lambda y: round(p.effort(y), 9)):
        if all(np.max(np.abs(y - other)[counts]) > DISTINCT for other in distinct):
            distinct.append(y)
    return distinct[0], distinct[1:]


def _described(
    problem: Problem, p: Scaled, y: Array, settled: bool, others: list[Array], starts: int, reached: int
) -> Found:
    y = np.where(np.abs(y) < NOTHING, 0.0, y)
    near = 1e-9 * (1.0 + np.abs(y))
    given = p.low == p.high
    at_low, at_high = (y <= p.low + near) & ~given, (y >= p.high - near) & ~given
    slopes, value = p.slopes(y), p.equations(y)
    slopes = np.where(np.isfinite(slopes), slopes, 0.0)
    open_ways = tangent(slopes, ~given)
    holds = p.violation(y) <= HOLDS
    inward = open_ways @ (open_ways.T @ (1.0 * at_low - 1.0 * at_high))
    walked = [d for d in open_ways.T if _goes_on(p, y, d, inward)] if holds else []
    down = p.weight**2 * (y - p.target) if holds else slopes.T @ np.nan_to_num(value)
    free = ~(given | at_low | at_high)
    if holds and np.any(free):
        down = down - slopes.T @ np.linalg.lstsq(slopes[:, free].T, down[free], rcond=RANK)[0]
    down = np.where(np.abs(down) > 1e-7 * (1.0 + np.max(np.abs(down))), down, 0.0)
    on_bound = np.where(at_low, p.low, np.where(at_high, p.high, y))
    return Found(
        y * problem.scale,
        value * problem.size,
        holds,
        settled,
        int(np.sum(~given)) - open_ways.shape[1],
        np.column_stack(walked) * problem.scale[:, None] if walked else np.zeros((len(y), 0)),
        holds and len(walked) < open_ways.shape[1],
        at_low,
        at_high,
        pressing(down, on_bound, p.low, p.high) & ~given,
        np.array(others).reshape(-1, len(y)) * problem.scale,
        starts,
        reached,
    )


def _goes_on(p: Scaled, y: Array, direction: Array, inward: Array) -> bool:
    """Whether a short walk along a direction, or slantwise off the bounds, leads to another solution."""
    for way in (direction, -direction, inward + direction, inward - direction):
        ahead, _ = restored(p, np.clip(y + WALK * way, p.low, p.high), RETURNING)
        moved = float(direction @ (ahead - y))
        if p.violation(ahead) <= HOLDS and moved * float(direction @ way) > 0.0 and abs(moved) > 0.5 * WALK:
            return True
    return False

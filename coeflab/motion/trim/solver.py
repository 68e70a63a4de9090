"""Operating points: where a set of equations holds within bounds, and what else may be said of the solution.

The unknowns may be more than the equations (a family of solutions, out of which a rule selects), as many, or fewer; some
equations may say the same. Cold starts from seeded points inside the bounds tell whether there is another solution.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from coeflab.core.types import Array, dataclass
from coeflab.motion.trim.moves import (
    HOLDS,
    RANK,
    RETURNING,
    Mask,
    Scaled,
    differences,
    pressing,
    restored,
    selected,
    tangent,
)

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
    spent : callable or None
        (n,) -> (n,), what stands for x / scale in that sum, rising with it, and for the target.
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
    spent: Callable[[Array], Array] | None = None

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

        felt = self.spent
        spent = None if felt is None else lambda y: felt(y * self.scale)
        return Scaled(equations, slopes, low, high, self.target / self.scale, self.weight, spent)


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
    down = p.pull(y) if holds else slopes.T @ np.nan_to_num(value)
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

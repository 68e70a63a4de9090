"""Operating points whose solutions are known beforehand."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.motion.trim.moves import Scaled
from coeflab.motion.trim.solver import Found, Problem, _sorted, solve

Array = np.ndarray


def found(
    equations: Callable[[Array], list[float]],
    low: list[float],
    high: list[float],
    target: list[float] | None = None,
    weight: list[float] | None = None,
    **more: object,
) -> Found:
    n = len(low)
    m = len(equations(np.clip(np.zeros(n), low, high)))
    problem = Problem(
        lambda x: np.array(equations(x)), np.array(low, float), np.array(high, float), np.ones(n), np.ones(m),
        np.zeros(n) if target is None else np.array(target, float), np.ones(n) if weight is None else np.array(weight, float),
    )  # fmt: skip
    return solve(problem, **more)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000), m=st.integers(1, 4), extra=st.integers(0, 3))
def test_linear_equations_give_the_point_of_least_norm_and_the_null_space(seed: int, m: int, extra: int) -> None:
    random = np.random.default_rng(seed)
    a, b = random.normal(size=(m, m + extra)), random.normal(size=m)
    if np.linalg.svd(a)[1][-1] < 0.05:
        return
    got = found(lambda x: a @ x - b, [-np.inf] * (m + extra), [np.inf] * (m + extra), starts=2)
    assert got.holds
    # A step counts when the effort falls, a square: it knows the point to a few roots of the rounding of one.
    least = np.linalg.pinv(a) @ b
    known = 4.0 * np.sqrt(np.finfo(float).eps) * (1.0 + np.linalg.norm(least))
    assert got.point == pytest.approx(least, abs=known)
    assert (got.rank, got.family.shape[1]) == (m, extra)
    assert a @ got.family == pytest.approx(np.zeros((m, extra)), abs=1e-6)
    assert len(got.others) == 0
    assert got.reached == got.starts == 3


def test_the_nearest_point_of_a_circle_to_a_point_outside() -> None:
    got = found(lambda x: [x[0] ** 2 + x[1] ** 2 - 1.0], [-3, -3], [3, 3], target=[2.0, 1.0])
    assert got.point == pytest.approx(np.array([2.0, 1.0]) / np.sqrt(5.0), abs=1e-8)
    assert got.family.shape == (2, 1)
    assert abs(got.family[:, 0] @ got.point) < 1e-6
    assert not got.singular


def test_a_bound_that_holds_back_the_effort_is_named() -> None:
    """Nearest to (2, 1) with x at most 0.5 is the corner (0.5, sqrt 0.75)."""
    got = found(lambda x: [x[0] ** 2 + x[1] ** 2 - 1.0], [-3, -3], [0.5, 3], target=[2.0, 1.0])
    assert got.point == pytest.approx([0.5, np.sqrt(0.75)], abs=1e-8)
    assert got.at_high.tolist() == got.held.tolist() == [True, False]
    assert got.family.shape[1] == 1


def test_a_bound_that_is_touched_by_chance_does_not_hold_back() -> None:
    got = found(lambda x: [x[0] + x[1] - 1.0], [0.5, -3], [3, 3])
    assert got.point == pytest.approx([0.5, 0.5], abs=1e-9)
    assert got.at_low[0]
    assert not got.held.any()


def test_other_isolated_solutions_are_found_and_the_least_effort_comes_first() -> None:
    got = found(lambda x: [(x[0] - 1.0) * (x[0] + 3.0)], [-5], [5])
    assert got.point == pytest.approx([1.0], abs=1e-9)
    assert got.others == pytest.approx(np.array([[-3.0]]), abs=1e-9)
    assert (got.rank, got.family.shape[1], got.singular) == (1, 0, False)


@pytest.mark.parametrize(("apart", "count"), [(0.9e-3, 0), (1.1e-3, 1)])
def test_solutions_a_thousandth_of_the_scale_apart_are_one(apart: float, count: int) -> None:
    one = np.ones(1)
    p = Scaled(lambda y: y, lambda _: np.eye(1), -one, one, np.zeros(1), one)
    assert len(_sorted(p, [np.zeros(1), apart * one])[1]) == count


def test_a_double_root_is_no_family() -> None:
    got = found(lambda x: [x[0] ** 2, x[1] - 1.0], [-5, -5], [5, 5])
    assert got.holds
    assert got.singular
    assert got.family.shape[1] == 0


def test_equations_that_say_the_same_lower_the_rank_only() -> None:
    got = found(lambda x: [x[0] + x[1] - 1.0, 2.0 * x[0] + 2.0 * x[1] - 2.0, x[0] - 0.25], [-5, -5], [5, 5])
    assert got.holds
    assert got.point == pytest.approx([0.25, 0.75], abs=1e-9)
    assert got.rank == 2


def test_a_request_beyond_a_bound_says_what_is_left_and_which_bound() -> None:
    got = found(lambda x: [x[0] + x[1] - 5.0, x[1] - 1.0], [0, -9], [1, 9])
    assert not got.holds
    assert got.settled
    assert got.point == pytest.approx([1.0, 2.0 + 0.5], abs=1e-6)
    assert got.residuals == pytest.approx([-1.5, 1.5], abs=1e-6)
    assert got.held.tolist() == [True, False]
    assert got.reached == 0


def test_equations_without_a_solution_hold_no_bound_responsible() -> None:
    got = found(lambda x: [x[0] ** 2 + 1.0], [-5], [5])
    assert not got.holds
    assert got.settled
    assert got.residuals == pytest.approx([1.0], abs=1e-6)
    assert not got.held.any()
    contrary = found(lambda x: [x[0] - 1.0, x[0] - 3.0], [-9], [9])
    assert contrary.point == pytest.approx([2.0], abs=1e-6)
    assert not contrary.holds


def test_given_unknowns_stay_and_do_not_count_as_open() -> None:
    got = found(lambda x: [x[0] * x[1] - 6.0], [2, -9], [2, 9])
    assert got.point == pytest.approx([2.0, 3.0], abs=1e-9)
    assert (got.rank, got.family.shape[1]) == (1, 0)
    assert not got.at_low.any()


def test_an_unknown_without_weight_is_left_to_the_equations() -> None:
    """Least x^2 on x + y = 4 is x = 0 whatever y is."""
    got = found(lambda x: [x[0] + x[1] - 4.0], [-9, -9], [9, 9], weight=[1.0, 0.0])
    assert got.point == pytest.approx([0.0, 4.0], abs=1e-7)


def test_a_curved_family_with_a_far_target_meets_the_condition_of_lagrange() -> None:
    """Least distance from (0, 3) on y = x^2 is at x^2 = 5/2, twice; (0, 0) is a worst point."""
    got = found(lambda x: [x[1] - x[0] ** 2], [-9, -9], [9, 99], target=[0.0, 3.0], first=np.array([0.5, 0.25]))
    assert got.point[0] ** 2 == pytest.approx(2.5, abs=1e-6)
    assert got.others[0, 0] == pytest.approx(-got.point[0], abs=1e-6)


def test_starts_where_the_equations_are_not_finite_are_passed_over() -> None:
    def equation(x: Array) -> list[float]:
        return [float(np.log(x[0])) if x[0] > 0.0 else float("nan")]

    got = found(equation, [-1], [4], first=np.array([-0.5]))
    assert got.holds
    assert got.point == pytest.approx([1.0], abs=1e-9)
    assert 0 < got.reached < got.starts


def test_nowhere_finite_is_not_settled() -> None:
    got = found(lambda _: [float("nan")], [0], [1])
    assert not got.holds
    assert not got.settled


def test_exact_derivatives_lead_to_the_same_point_as_differences() -> None:
    def equations(x: Array) -> Array:
        return np.array([x[0] ** 2 + x[1] - 3.0, x[1] * x[2] - 2.0])

    def exact(x: Array) -> Array:
        return np.array([[2.0 * x[0], 1.0, 0.0], [0.0, x[2], x[1]]])

    rows = (np.full(3, -4.0), np.full(3, 4.0), np.array([1.0, 2.0, 3.0]), np.array([1.0, 5.0]), np.ones(3), np.ones(3))
    a, b = solve(Problem(equations, *rows)), solve(Problem(equations, *rows, exact))
    assert a.point == pytest.approx(b.point, abs=1e-7)


def test_the_same_seed_gives_the_same_bytes() -> None:
    def once() -> Found:
        return found(lambda x: [np.sin(x[0]) + x[1] ** 2 - 1.0], [-5, -5], [5, 5], starts=6, seed=3)

    a, b = once(), once()
    assert a.point.tobytes() == b.point.tobytes()
    assert a.others.tobytes() == b.others.tobytes()

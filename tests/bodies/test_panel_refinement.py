"""Extrapolation on planted sequences: the error estimate must hold the error."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.panel_solver.refinement import refined

TRUE = np.diag([1.0, 3.0, 3.0, 0.5, 8.0, 8.0]) + 0.0
COUNTS = (8000, 2000, 500)
SIZES = np.sqrt(500.0 / np.array(COUNTS))
SLOPE = np.diag([0.3, -0.2, -0.1, 0.05, 0.4, 0.2])


def planted(order: float, count: int = 3) -> list[np.ndarray]:
    return [TRUE + SLOPE * h**order for h in SIZES[:count]]


def test_an_error_of_second_order_goes() -> None:
    found = refined(planted(2.0), COUNTS)
    assert found.matrix == pytest.approx(TRUE, rel=1e-12)
    assert found.observed == pytest.approx(2.0)
    assert found.used == 2.0


def test_an_error_of_an_edge_goes() -> None:
    found = refined(planted(4.0 / 3.0 - 0.1), COUNTS)
    assert found.used == pytest.approx(4.0 / 3.0)
    assert np.diag(found.matrix) == pytest.approx(np.diag(TRUE), rel=0.01)


@pytest.mark.parametrize("order", [0.6, 0.8, 1.0, 1.2, 1.3, 1.5, 2.0, 2.5, 3.0, 4.0])
@pytest.mark.parametrize("count", [2, 3])
def test_the_estimate_holds_the_error(order: float, count: int) -> None:
    if count == 2 and order < 1.2:
        return
    found = refined(planted(order, count), COUNTS[:count])
    assert found.used is not None
    assert np.all(np.abs(found.matrix - TRUE) <= found.error)


@pytest.mark.parametrize("order", [1.0, 4.0 / 3.0, 1.5, 2.0, 3.0])
@pytest.mark.parametrize("count", [2, 3])
def test_edges_are_not_given_second_order(order: float, count: int) -> None:
    found = refined(planted(order, count), COUNTS[:count], edges=True)
    assert found.used == pytest.approx(4.0 / 3.0)
    assert np.all(np.abs(found.matrix - TRUE) <= found.error * (1.0 + 1e-9))


def test_what_hardly_shrinks_is_not_extrapolated() -> None:
    found = refined([TRUE + SLOPE, TRUE - SLOPE, TRUE + SLOPE], COUNTS)
    assert found.used is None
    assert np.array_equal(found.matrix, TRUE + SLOPE)
    assert np.all(np.abs(SLOPE) <= found.error)


def test_one_mesh_says_nothing_about_its_error() -> None:
    found = refined(planted(2.0, 1), COUNTS[:1])
    assert np.all(np.isnan(found.error))
    assert np.array_equal(found.settled, found.matrix)


def test_a_motion_below_its_error_is_nothing() -> None:
    sequence = [m.copy() for m in planted(2.0)]
    for m, h in zip(sequence, SIZES):
        m[3, 3], m[3, 1], m[1, 3] = 0.2 * h**3, 0.01 * h**3, 0.01 * h**3
    found = refined(sequence, COUNTS)
    assert found.void.tolist() == [False, False, False, True, False, False]
    assert not np.any(found.settled[3])
    assert not np.any(found.settled[:, 3])
    assert np.diag(found.settled)[[0, 1, 2, 4, 5]] == pytest.approx(np.diag(TRUE)[[0, 1, 2, 4, 5]], rel=1e-6)


def test_rounding_is_nothing_but_a_coupling_is_something() -> None:
    planted_pair = TRUE + 0.0
    planted_pair[0, 1] = planted_pair[1, 0] = 1e-9
    planted_pair[1, 5] = planted_pair[5, 1] = 1e-4
    settled = refined([planted_pair + SLOPE * h**2 for h in SIZES], COUNTS).settled
    assert settled[0, 1] == settled[1, 0] == 0.0
    assert settled[1, 5] == pytest.approx(1e-4, rel=1e-6)


def test_a_motion_that_only_facets_resist_does_not_set_the_order() -> None:
    """A sphere's turning: nothing, approached as the fourth power."""
    sphere = np.diag([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    found = refined([sphere * (1.0 - 0.2 * h**2) + (np.eye(6) - sphere) * h**4 for h in SIZES], COUNTS)
    assert found.observed == pytest.approx(2.0)
    assert found.settled == pytest.approx(sphere, abs=1e-12)


@pytest.mark.parametrize("order", [0.8, 4.0 / 3.0, 2.0])
@pytest.mark.parametrize("counts", [(6000, 1500, 375), (6000, 1500, 500), (6000, 2000, 400)])
def test_the_order_is_seen_through_unequal_steps(order: float, counts: tuple[int, int, int]) -> None:
    exact = np.diag([2.0, 3.0, 4.0, 1.0, 5.0, 6.0])
    found = refined([exact * (1.0 + 0.1 * (375.0 / n) ** (order / 2.0)) for n in counts], counts)
    assert found.observed == pytest.approx(order, rel=1e-6)


def test_differences_that_grow_with_refinement_have_no_order() -> None:
    exact = np.eye(6)
    assert refined([exact, 1.1 * exact, 1.11 * exact], (6000, 1500, 375)).observed == 0.0
    assert refined([exact, exact * (1.0 + 1e-9), 1.5 * exact], (6000, 1500, 375)).observed == 12.0


def test_three_matrices_that_do_not_converge_take_three_times_their_range() -> None:
    """The finer step, .01 of the slope, is the larger one in size; the coarser goes back further than it."""
    sequence = [TRUE, TRUE + 0.01 * SLOPE, TRUE - 0.004 * SLOPE]
    found = refined(sequence, COUNTS)
    assert found.used is None
    assert np.all(found.error >= 3.0 * np.ptp(sequence, axis=0) * (1.0 - 1e-12))
    assert found.error[1, 1] == pytest.approx(3.0 * 0.014 * abs(SLOPE[1, 1]), rel=1e-9)

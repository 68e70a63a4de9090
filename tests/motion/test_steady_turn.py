"""Steady turns: the equations in the other triad, energy, symmetry, sensitivities, rest."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.core.types import Array
from coeflab.motion.steady_turns import (
    COEFFICIENTS,
    INERTIAL,
    features,
    inertia,
    kirchhoff,
    run,
    sensitivities,
    steady_turns,
    turn_figures,
)

VALUES = {
    "m": 19.0, "mx": 5.0, "my": 17.0, "myr": 0.95, "inertia": 1.6, "d0": 20.80, "d2": 18.76, "s1": 64.71, "s3": 146.8,
    "n1": 11.83, "n3": -30.86, "nr": 0.1, "nrr": 1.0,
}  # fmt: skip
THETA = np.array([VALUES[name] for name in COEFFICIENTS])
STATES = np.random.default_rng(11).normal(size=(50, 3))
component = st.floats(-2.0, 2.0)
THRUST = np.array([[7.586, 0.0, -0.7586], [8.65, 0.0, -0.3], [10.0, 0.0, 0.0]])


def printed_flu(u: float, v: float, r: float) -> tuple[float, float, float]:
    """Forces of the equations as they stand in FLU, ahead: beta = asin(v/V), V^2 in front, positive forces resist."""
    m, mx, my, myr = 19.0, 5.0, 17.0, 0.95
    speed = np.hypot(u, v)
    b = np.arcsin(v / speed)
    drag, side = 20.80 + 18.76 * b**2, 64.71 * b + 146.8 * b**3
    fx = speed**2 * (np.cos(b) * drag - np.sin(b) * side)
    fy = speed**2 * (np.sin(b) * drag + np.cos(b) * side)
    turning = speed**2 * (11.83 * b - 30.86 * b**3) - 1.0 * r * abs(r) - 0.1 * r - (my - mx) * u * v - myr * u * r
    return -fx + (m + my) * v * r + myr * r**2, -fy - (m + mx) * u * r, turning


def test_the_printed_equations_with_v_r_y_and_n_reversed() -> None:
    for u, v, r in np.abs(STATES) * [1.0, 0.4, 1.0] * np.where(STATES > 0.0, 1.0, [1.0, -1.0, -1.0]):
        x, y, n = printed_flu(u, v, r)
        ours = features(np.array([[u, -v, -r]]))[0][0] @ THETA
        assert ours == pytest.approx([x, -y, -n], rel=1e-12, abs=1e-12)


def test_rates_are_those_of_the_forces() -> None:
    _, rates = features(STATES)
    for k in range(3):
        step = 1e-6 * np.eye(3)[k]
        by_difference = (features(STATES + step)[0] - features(STATES - step)[0]) / 2e-6
        assert rates[..., k] == pytest.approx(by_difference, rel=1e-7, abs=1e-8)


@given(component, component, component)
@settings(max_examples=200, deadline=None)
def test_the_hull_only_takes_energy_ahead_and_astern(u: float, v: float, r: float) -> None:
    theta = THETA.copy()
    theta[[COEFFICIENTS.index(n) for n in ("n1", "n3")]] = 0.0
    x, y, n = features(np.array([[u, v, r]]))[0][0] @ theta
    speed, beta = np.hypot(u, v), np.arctan2(v, abs(u))
    lost = speed**3 * (20.80 + 18.76 * beta**2) + 0.1 * r**2 + abs(r) ** 3
    assert x * u + y * v + n * r == pytest.approx(-lost, rel=1e-10, abs=1e-12)


@given(component, component, component)
@settings(max_examples=100, deadline=None)
def test_port_is_the_mirror_of_starboard(u: float, v: float, r: float) -> None:
    here, there = (features(np.array([s]))[0][0] @ THETA for s in ((u, v, r), (u, -v, -r)))
    assert there == pytest.approx(here * [1.0, -1.0, -1.0], rel=1e-12, abs=1e-12)


def test_the_products_that_turn_a_vehicle_follow_from_its_kinetic_energy() -> None:
    """Of the forces that steady turns are computed with; a copy in a matrix of its own was what a check once looked at."""
    forces = features(STATES)[0][:, :, INERTIAL] @ THETA[INERTIAL]
    assert kirchhoff(THETA, STATES) == pytest.approx(forces, rel=1e-12, abs=1e-12)
    assert np.sum(forces * STATES, axis=1) == pytest.approx(np.zeros(len(STATES)), abs=1e-12)
    assert inertia(THETA) == pytest.approx(inertia(THETA).T)


def test_a_turn_is_where_the_simulation_ends() -> None:
    turns = steady_turns(THETA, THRUST)
    assert turns.converged.all()
    assert turns.stable.all()
    assert turns.inside.all()
    for thrust, velocity in zip(THRUST, turns.velocity, strict=True):
        assert run(THETA, thrust, np.array([0.0, 120.0]))[-1] == pytest.approx(velocity, rel=1e-7, abs=1e-9)
    assert turns.velocity[0, 2] < 0.0 < turns.velocity[0, 1]
    assert turns.radius[2] == np.inf
    assert turns.drift[2] == 0.0


def test_at_rest_and_almost() -> None:
    turns = steady_turns(THETA, np.array([[0.0, 0.0, 0.0], [1e-8, 0.0, 1e-10]]))
    assert turns.converged.all()
    assert turns.velocity[0].tolist() == [0.0, 0.0, 0.0]
    assert np.isnan(turns.radius[0])
    assert turns.velocity[1, 0] == pytest.approx(np.sqrt(1e-8 / 20.8), rel=1e-2)
    assert run(THETA, np.zeros(3), np.array([0.0, 10.0])).tolist() == [[0.0] * 3] * 2
    assert np.isfinite(features(np.zeros((1, 3)))[1]).all()


def test_astern_thrust_drives_astern() -> None:
    turns = steady_turns(THETA, np.array([[-10.0, 0.0, 0.0]]), start=np.array([-0.1, 0.0, 0.0]))
    assert turns.velocity[0, 0] == pytest.approx(-np.sqrt(10.0 / 20.80), rel=1e-9)
    assert not turns.inside[0]


def test_no_turn_is_said_and_not_given() -> None:
    slippery = THETA.copy()
    slippery[COEFFICIENTS.index("d0")] = 0.0
    turns = steady_turns(slippery, np.array([[10.0, 0.0, 0.0]]))
    assert turns.converged.tolist() == [False]
    assert turns.stable.tolist() == [False]
    assert np.isnan(turns.velocity).all()


def _moved(theta: Array, thrust: Array) -> Array:
    return steady_turns(theta, thrust).velocity


def test_sensitivities_are_those_of_solved_turns() -> None:
    thrust = THRUST[:2]
    velocity = _moved(THETA, thrust)
    by_theta, by_thrust = sensitivities(THETA, velocity)
    for k in range(len(COEFFICIENTS)):
        step = np.zeros(13)
        step[k] = 1e-5 * max(abs(THETA[k]), 1.0)
        found = (_moved(THETA + step, thrust) - _moved(THETA - step, thrust)) / (2.0 * step[k])
        assert by_theta[:, :, k] == pytest.approx(found, rel=1e-5, abs=1e-8)
    for k in range(3):
        step = 1e-5 * np.eye(3)[k]
        found = (_moved(THETA, thrust + step) - _moved(THETA, thrust - step)) / 2e-5
        assert by_thrust[:, :, k] == pytest.approx(found, rel=1e-5, abs=1e-8)


def test_figures_of_a_turn_and_their_rates() -> None:
    figures, rates = turn_figures(np.array([[0.3, -0.4, 0.25]]))
    assert figures[0] == pytest.approx([0.3, np.arcsin(0.8), 2.0])
    at = STATES[np.abs(STATES).min(axis=1) > 0.05]
    for k in range(3):
        step = 1e-7 * np.eye(3)[k]
        found = (turn_figures(at + step)[0] - turn_figures(at - step)[0]) / 2e-7
        assert turn_figures(at)[1][..., k] == pytest.approx(found, rel=1e-5, abs=1e-5)
    assert rates.shape == (1, 3, 3)

"""The march: order four through a switching manoeuvre, the same numbers plain and compiled, members on their own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.motion.ensemble import Ensemble, alone
from coeflab.motion.integrators.adaptive import march_adaptive
from coeflab.motion.integrators.fixed_step import march as plain
from coeflab.motion.manoeuvre import Manoeuvre, Phase, Until
from coeflab.motion.marching import march, march_by_tolerance
from coeflab.motion.orders import COMPLETE, NOT_FINITE, STEP_TOO_SMALL, TOO_FAST, WATCHED, Orders, orders_of, ramp
from tests.motion.fleet import RATE, RUDDER, SPEED, coasting, massive, swimmer, zigzag

KERNELS = ("numpy", "compiled")
STILL = np.zeros(3)


def scattered(count: int, spread: float = 0.1) -> Ensemble:
    v = swimmer()
    factors = 1.0 + spread * np.random.default_rng(5).uniform(-1.0, 1.0, (count, len(v.law.terms)))
    added = v.added * (1.0 + spread * np.random.default_rng(6).uniform(-1.0, 1.0, (count, 1, 1)))
    mass = v.mass * (1.0 + spread * np.random.default_rng(7).uniform(-1.0, 1.0, count))
    ideal = np.broadcast_to(v.law.ideal, (count, 6, 6, 6)) * (mass / v.mass)[:, None, None, None]
    return Ensemble(v, v.law.coefficient * factors, added, ideal, mass)


@pytest.mark.parametrize("kernel", KERNELS)
def test_order_four_through_a_switching_manoeuvre(kernel: str) -> None:
    """Ramped rudder, switches at headings: the last state and the switching times converge with the fourth power."""
    v = swimmer(smooth=True)
    reference = march(v, zigzag(v), 0.0025, 1.0, "compiled").marching
    gaps = []
    for step in (0.04, 0.02, 0.01):
        found = march(v, zigzag(v), step, kernel=kernel).marching
        gaps.append(
            [
                np.abs(found.end_state - reference.end_state).max(),
                np.abs(found.switch_time - reference.switch_time).max(),
            ]
        )
    falls = np.array(gaps[:-1]) / np.array(gaps[1:])
    assert np.all(falls > 12.0)
    assert np.all(falls < 22.0)


@pytest.mark.parametrize("kernel", KERNELS)
def test_events_are_those_of_the_adaptive_integrator(kernel: str) -> None:
    v = swimmer()
    found = march(v, zigzag(v), 0.01, kernel=kernel).trajectory()
    reference = march_by_tolerance(v, zigzag(v), 0.5, 1e-11).trajectory()
    assert found.reached[0] is None
    assert found.reached[1:3] == pytest.approx(reference.reached[1:3], abs=1e-6)
    at = [int(np.argmin(np.abs(found.time - t))) for t in found.reached[1:3]]
    np.testing.assert_allclose(found.heading[at], [-0.25, 0.25], atol=1e-9)
    assert found.time[-1] == pytest.approx(reference.time[-1], abs=1e-6)


def test_compiled_is_plain_to_rounding() -> None:
    ensemble = scattered(7)
    both = [
        march(ensemble, zigzag(ensemble.vehicle), 0.02, 0.1, k, np.array([0.2, 0.1, 0.0])).marching for k in KERNELS
    ]
    for name in ("records", "switch_time", "switch_state", "end_time", "end_state"):
        a, b = (getattr(m, name) for m in both)
        np.testing.assert_array_equal(np.isnan(a), np.isnan(b))
        assert np.nanmax(np.abs(a - b)) < 1e-12 * np.nanmax(np.abs(a))
    np.testing.assert_array_equal(both[0].met, both[1].met)
    assert len(set(both[0].end_time)) == ensemble.count


@pytest.mark.parametrize("quantity", WATCHED)
def test_every_quantity_ends_a_phase_alike(quantity: str) -> None:
    """Plain, compiled and adaptive find the same crossing, halfway between the first and last value of a free motion."""
    v = swimmer()
    start = np.array([SPEED, 0.1, 0.05, 0.3, 0.1, 0.2])
    free = march(v, Manoeuvre("free", (Phase("free", {}, 0.4),), start), 0.01).trajectory()
    rolled, pitched, _ = free.angles.T
    seen = {
        "heading": free.heading, "yaw_rate": free.velocity[:, 5], "pitch": pitched, "pitch_rate": free.velocity[:, 4],
        "roll": rolled, "roll_rate": free.velocity[:, 3], "depth": free.position[:, 2], "u": free.velocity[:, 0],
        "speed": free.speed, "turned": np.abs(free.heading),
    }[quantity]  # fmt: skip
    until = Until(quantity, bool(seen[-1] > seen[0]), float((seen[0] + seen[-1]) / 2))
    asked = Manoeuvre("asked", (Phase("wait", {}, 0.4, until),), start)
    times = [march(v, asked, 0.01, kernel=k).trajectory().reached[0] for k in KERNELS]
    times.append(march_by_tolerance(v, asked, 0.1, 1e-12).trajectory().reached[0])
    assert times[0] == pytest.approx(times[1], abs=1e-12)
    assert times[0] == pytest.approx(times[2], abs=1e-6)
    assert 0.0 < times[0] < 0.4


@pytest.mark.parametrize("kernel", KERNELS)
def test_members_do_not_know_each_other(kernel: str) -> None:
    ensemble, order = scattered(5), np.array([3, 0, 4, 1, 2])
    turned = Ensemble(
        ensemble.vehicle,
        ensemble.coefficients[order],
        ensemble.added[order],
        ensemble.ideal[order],
        ensemble.mass[order],
    )
    first, second = (march(e, zigzag(e.vehicle), 0.02, 0.2, kernel).marching for e in (ensemble, turned))
    np.testing.assert_allclose(second.end_state, first.end_state[order], rtol=1e-11, atol=1e-12)
    for i in (0, 4):
        one = march(ensemble.member(i), zigzag(ensemble.vehicle), 0.02, 0.2, kernel).marching
        np.testing.assert_allclose(one.end_state[0], first.end_state[i], rtol=1e-11, atol=1e-12)
        np.testing.assert_allclose(one.switch_time[0], first.switch_time[i], rtol=1e-11)


@pytest.mark.parametrize("kernel", KERNELS)
def test_a_member_that_runs_away_stops_alone(kernel: str) -> None:
    v = massive(values={"Yvvv": -0.1, "X0": -1e-3})
    bad = v.law.coefficient * np.array([[1.0, 1.0], [-1e150, 1.0], [-1e3, 1.0]])
    found = march(Ensemble(v, bad), coasting(5.0, [1.0, 0.3, 0, 0, 0, 0]), 0.02, 0.1, kernel)
    assert found.marching.ended.tolist()[0] == COMPLETE
    assert found.marching.ended.tolist()[1:] == [NOT_FINITE, TOO_FAST]
    assert np.isfinite(found.marching.end_state).all()
    assert found.marching.end_time[1] < 0.1 < 5.0 == found.marching.end_time[0]
    motion = found.trajectory(1)
    assert "stopped at 0 s: the next state is not finite" in motion.why
    assert "u v w p q r = 1 0.3" in motion.why
    whole = march(v, coasting(5.0, [1.0, 0.3, 0, 0, 0, 0]), 0.02, 0.1, kernel)
    np.testing.assert_allclose(found.marching.records[0], whole.marching.records[0], rtol=1e-12, atol=1e-14)


def test_each_member_may_have_its_own_thrust_and_start() -> None:
    ensemble = scattered(3)
    plans = [zigzag(ensemble.member(i)) for i in range(3)]
    for kernel in KERNELS:
        found = march(ensemble, plans, 0.02, 0.2, kernel)
        for i in (0, 2):
            one = march(ensemble.member(i), plans[i], 0.02, 0.2, kernel)
            np.testing.assert_allclose(found.marching.end_state[i], one.marching.end_state[0], rtol=1e-10, atol=1e-12)


def test_the_rudder_moves_at_its_rate() -> None:
    v = swimmer()
    motion = march(v, zigzag(v), 0.02).trajectory()
    since = motion.time - 2.0
    over = (motion.phase == 1) & (since >= 0.0)
    np.testing.assert_allclose(motion.controls["dr"][over], np.minimum(RATE * since[over], RUDDER), atol=1e-12)
    assert np.max(np.abs(np.diff(motion.controls["dr"]))) <= RATE * 0.02 + 1e-12
    assert motion.controls["dr"][-1] == 0.0


def test_a_ramp_without_a_rate_stands_at_once() -> None:
    angles = ramp(
        np.zeros((3, 1)), np.array([[0.2], [-0.4], [0.0]]), np.array([np.inf, 0.1, 0.1]), np.array([0.0, 1.0, 9.0])
    )
    np.testing.assert_allclose(angles, [[0.2, 0.2, 0.2], [0.0, -0.1, -0.4], [0.0, 0.0, 0.0]])


def sudden(state: list[float], _: object, __: object) -> list[float]:
    """The depth z grows as z^2 and is infinite at one second."""
    out = [0.0] * len(state)
    out[2] = state[2] ** 2
    return out


@pytest.mark.parametrize(("method", "how"), [("DOP853", STEP_TOO_SMALL), ("LSODA", None)])
def test_an_integrator_that_fails_says_so(method: str, how: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coeflab.motion.integrators.adaptive.rates_of_one", lambda _: sudden)
    dynamics = alone(swimmer()).dynamics(np.zeros(3))
    orders: Orders = orders_of(swimmer(), coasting(2.0, [0] * 6))
    start = np.eye(14)[2] + np.eye(14)[3]
    found = march_adaptive(dynamics, orders, start, 0.1, tolerance=1e-8, method=method)
    assert found.ended[0] == how if how else found.ended[0] in (STEP_TOO_SMALL, NOT_FINITE)
    assert found.end_time[0] == pytest.approx(1.0, abs=1e-3)
    assert np.isfinite(found.end_state).all()


def test_a_phase_that_begins_beyond_its_value_waits_for_the_crossing() -> None:
    v = swimmer()
    phases = (
        Phase("slow down", {}, 30.0, Until("speed", False, 1.45)),
        Phase("wait", {}, 1.0, Until("speed", False, 2.0)),
    )
    motion = march(v, Manoeuvre("coast", phases, np.array([SPEED, 0, 0, 0, 0, 0])), 0.02).trajectory()
    assert motion.reached[1] is None
    assert motion.time[-1] == pytest.approx(motion.reached[0] + 1.0)


def test_records_do_not_depend_on_how_many_are_kept() -> None:
    v = swimmer()
    dynamics, orders = alone(v).dynamics(STILL), orders_of(v, zigzag(v))
    start = np.zeros((1, 14))
    start[0, [3, 7]] = 1.0, SPEED
    every, fifth = (plain(dynamics, orders, start, 0.02, n) for n in (1, 5))
    np.testing.assert_array_equal(every.records[0, ::5][: fifth.records.shape[1]], fifth.records[0])
    np.testing.assert_array_equal(every.end_state, fifth.end_state)
    shared = replace(orders, wrench=orders.wrench[None])
    np.testing.assert_array_equal(plain(dynamics, shared, start, 0.02).end_state, every.end_state)

"""Equations of motion of a glider: energy, the printed equations with their errata, steady glides, the orders' stretches."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.glider.motion import GliderBody, Leg, March, Setting, eigenvalues, legs, march, momentum, rates, velocity
from coeflab.glider.steady_glide import Polar, balanced, glide

STILL = Setting(0.0, 0.0)
GRAVER = GliderBody(
    Polar((0.0, 132.5), (2.15, 25.0), (0.0, -100.0)), 45.0, 110.0, 12.0, 9.0, 0.05, 0.0, 0.0, 0.0, 9.816, False
)
VACUUM = replace(GRAVER, polar=Polar((0.0, 0.0), (0.0, 0.0), (0.0, 0.0)), ahead=1.5, below=4.0, engine_ahead=0.3)
STATES = st.tuples(st.floats(-1, 1), st.floats(0.05, 1), st.floats(-1, 1), st.floats(-1, 1))


def _march(body: GliderBody, leg: Leg, *how: Any) -> March:
    return march(rates(body, leg), leg, *how)


def _energy(body: GliderBody, setting: Setting, y: np.ndarray) -> float:
    """Kinetic energy of body, fluid and sliding mass plus the potential of net weight and moments."""
    v1, v3, q = velocity(body, y[3:], setting.position, 0.0)
    w1, w3 = v1 + q * body.sliding_below, v3 - q * setting.position
    kinetic = body.surge * v1**2 + body.heave * v3**2 + body.inertia * q**2 + body.sliding * (w1**2 + w3**2)
    ahead, below = body.moments(*setting[:2])
    potential = ahead * np.sin(y[2]) - below * np.cos(y[2]) - setting.net_mass * body.gravity * y[1]
    return float(0.5 * kinetic + potential)


def test_without_lift_drag_and_moment_energy_is_kept() -> None:
    setting = Setting(0.3, 0.04)
    start = np.array([0.0, 0.0, 0.4, *momentum(VACUUM, (0.5, 0.2, 0.3), setting.position, 0.0)])
    found = _march(VACUUM, Leg(0.0, 20.0, setting, STILL), start, 2.0, None, 1e-12)
    energies = [_energy(VACUUM, setting, y) for y in found.state]
    assert energies == pytest.approx([_energy(VACUUM, setting, start)] * 10, abs=1e-7)
    assert np.ptp(found.state[:, 3]) > 1.0


def test_the_printed_sign_of_equation_18_does_not_keep_it() -> None:
    """d(m1 v1^2/2 + m3 v3^2/2)/dt from the velocity products: zero with +m1 v1 q, not with the printed -m1 v1 q."""
    v1, v3, q, m1, m3 = 0.5, 0.2, 0.3, 45.0, 110.0
    corrected = v1 * (-m3 * v3 * q) + v3 * (m1 * v1 * q) + q * (m3 - m1) * v1 * v3
    printed = v1 * (-m3 * v3 * q) + v3 * (-m1 * v1 * q) + q * (m3 - m1) * v1 * v3
    assert corrected == pytest.approx(0.0, abs=1e-15)
    assert abs(printed) > 1.0


@given(STATES, st.floats(-0.1, 0.1), st.floats(-0.02, 0.02), st.floats(-1.0, 1.0))
def test_momenta_give_the_corrected_equations_17_to_19(
    state: tuple[float, ...], r1: float, slide: float, m0: float
) -> None:
    """The forces u_p on the sliding mass by differences of its momentum, then v_dot by the paper's equations, corrected."""
    b = replace(GRAVER, polar=replace(GRAVER.polar, damping=3.0), ahead=0.7, below=1.1, engine_ahead=0.2)
    (theta, v1, v3, q), m, r3 = state, b.sliding, b.sliding_below
    leg, dt = Leg(0.0, 1.0, Setting(m0, r1), Setting(0.0, slide)), 1e-6
    y = np.array([0.0, 0.0, theta, *momentum(b, (v1, v3, q), r1, slide)])
    change = np.array(rates(b, leg)(0.0, y))
    after, before = (np.array(velocity(b, (y + s * dt * change)[3:], r1 + s * slide * dt, slide)) for s in (1, -1))
    v_dot = (after - before) / (2 * dt)
    p1, p3 = m * (v1 + q * r3 + slide), m * (v3 - q * r1)
    u1, u3 = m * (v_dot[0] + v_dot[2] * r3), m * (v_dot[1] - v_dot[2] * r1 - q * slide)
    speed, alpha, g = np.hypot(v1, v3), np.arctan2(v3, v1), b.gravity
    lift, drag = b.polar.lift_at(alpha) * speed**2, b.polar.drag_at(alpha) * speed**2
    moment = b.polar.moment_at(alpha) * speed**2 - 3.0 * speed * q
    ahead, below = b.ahead + m * g * r1 + m0 * g * 0.2, b.below + m * g * r3
    s, c = np.sin(theta), np.cos(theta)
    v1_dot = (-b.heave * v3 * q - p3 * q - m0 * g * s + lift * np.sin(alpha) - drag * np.cos(alpha) - u1) / b.surge
    v3_dot = (b.surge * v1 * q + p1 * q + m0 * g * c - lift * np.cos(alpha) - drag * np.sin(alpha) - u3) / b.heave
    munk = (b.heave - b.surge) * v1 * v3
    q_dot = (munk - (r1 * p1 + r3 * p3) * q - ahead * c - below * s + moment - r3 * u1 + r1 * u3) / b.inertia
    assert v_dot == pytest.approx([v1_dot, v3_dot, q_dot], abs=1e-6)


@given(STATES, st.floats(-0.1, 0.1), st.floats(-0.02, 0.02))
def test_velocity_inverts_momentum(state: tuple[float, ...], position: float, rate: float) -> None:
    moving = state[:3]
    assert velocity(GRAVER, momentum(GRAVER, moving, position, rate), position, rate) == pytest.approx(
        moving, abs=1e-12
    )


@pytest.mark.parametrize("holds", [True, False])
def test_a_steady_glide_is_steady(holds: bool) -> None:
    body, setting = replace(GRAVER, holds_munk=holds), Setting(0.0473, 0.0198)
    (alpha,) = balanced(body.polar, 0.0473 * 9.816, body.munk, *body.moments(*setting[:2]), (-0.5, 0.5))
    speed, zeta = glide(body.polar, 0.0473 * 9.816, alpha)
    moving = momentum(body, (speed * np.cos(alpha), speed * np.sin(alpha), 0.0), setting.position, 0.0)
    change = rates(body, Leg(0.0, 1.0, setting, STILL))(0.0, np.array([0.0, 0.0, zeta + alpha, *moving]))
    assert change[2:] == pytest.approx([0.0] * 4, abs=1e-11)
    assert change[:2] == pytest.approx([speed * np.cos(zeta), -speed * np.sin(zeta)], abs=1e-12)


def test_the_munk_moment_is_counted_once() -> None:
    y = np.array([0.0, 0.0, 0.0, *momentum(GRAVER, (0.5, 0.2, 0.0), 0.0, 0.0)])
    leg = Leg(0.0, 1.0, STILL, STILL)
    apart = rates(GRAVER, leg)(0.0, y)[5] - rates(replace(GRAVER, holds_munk=True), leg)(0.0, y)[5]
    assert apart == pytest.approx(65.0 * 0.5 * 0.2, rel=1e-12)


def test_eigenvalues_tell_growth_from_decay() -> None:
    """Growth rate of a small disturbance in the motion itself."""
    setting = Setting(0.0473, 0.0198)
    (alpha,) = balanced(GRAVER.polar, 0.0473 * 9.816, 65.0, *GRAVER.moments(*setting[:2]), (-0.5, 0.5))
    speed, zeta = (float(v) for v in glide(GRAVER.polar, 0.0473 * 9.816, alpha))
    values = eigenvalues(GRAVER, setting, speed, float(alpha), zeta + float(alpha))
    slow = float(values.real.max())
    assert slow < 0.0
    moving = momentum(GRAVER, (speed * np.cos(alpha), speed * np.sin(alpha), 0.0), setting.position, 0.0)
    start = np.array([0.0, 0.0, zeta + alpha, *moving])
    start[3] *= 1.01
    found = _march(GRAVER, Leg(0.0, 240.0, setting, STILL), start, 40.0, None, 1e-11).state
    off = [np.hypot(*velocity(GRAVER, y[3:], setting.position, 0.0)[:2]) - speed for y in found]
    assert np.log(off[5] / off[4]) / 40.0 == pytest.approx(slow, rel=0.05)


def test_rest_is_no_exception() -> None:
    change = rates(GRAVER, Leg(0.0, 1.0, Setting(0.05, 0.0), STILL))(0.0, np.zeros(6))
    assert change == pytest.approx([0.0, 0.0, 0.0, 0.0, 0.05 * 9.816, 0.0], abs=1e-12)


@given(
    st.floats(1.0, 100.0),
    st.tuples(st.floats(-1, 1), st.floats(-0.1, 0.1)),
    st.tuples(st.floats(-1, 1), st.floats(-0.1, 0.1)),
)
def test_legs_join_and_reach_the_order(lasts: float, now: tuple[float, float], order: tuple[float, float]) -> None:
    rate = Setting(0.05, 0.002)
    found = legs(10.0, lasts, Setting(*now), Setting(*order), rate)
    assert (found[0].begins, found[-1].ends) == (10.0, 10.0 + lasts)
    for a, b in pairwise(found):
        assert a.ends == b.begins
        assert a.setting(a.ends) == pytest.approx(b.at, abs=1e-9)
    last = found[-1].setting(10.0 + lasts)
    for end, start, wanted, r in zip(last[:2], now, order, rate[:2], strict=True):
        moved = np.clip(wanted - start, -r * lasts, r * lasts)
        assert end == pytest.approx(start + moved, abs=1e-9)


def test_a_depth_ends_a_leg_only_in_its_direction() -> None:
    sinking = np.array([0.0, 0.0, 0.0, *momentum(GRAVER, (0.0, 0.0, 0.0), 0.0, 0.0)])
    leg = Leg(0.0, 50.0, Setting(0.5, 0.0), STILL)
    down = _march(GRAVER, leg, sinking, 1.0, (2.0, True), 1e-9)
    assert down.met
    assert down.state[-1, 1] == pytest.approx(2.0, abs=1e-9)
    assert not _march(GRAVER, leg, sinking, 1.0, (2.0, False), 1e-9).met


def test_numbers_that_overflow_are_told() -> None:
    wild = replace(GRAVER, polar=Polar((0.0, 132.0), (1.0, 1.0), (0.0, 1e150)))
    found = _march(wild, Leg(0.0, 10.0, Setting(0.5, 0.0), STILL), np.zeros(6), 1.0, None, 1e-8)
    assert found.why
    assert np.isfinite(found.state).all()

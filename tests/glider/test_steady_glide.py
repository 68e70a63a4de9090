"""Steady glides against printed numbers, Leonard and Graver's formulas, energy and symmetry."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.glider.steady_glide import Polar, balanced, glide, pitch_moment, shallowest

DEGREE = float(np.degrees(1.0))
CASE_01 = Polar((-1.9169, 9.5281 * DEGREE), (11.1159, 0.215 * DEGREE**2), (1.1025, -1.4179 * DEGREE), 60.0)
GRAVER = Polar((0.0, 132.5), (2.15, 25.0), (0.0, -100.0))
WIDE = (-np.pi / 6, np.pi / 6)
POLARS = st.builds(
    lambda l0, l1, d0, d2, m0, m1: Polar((l0, l1), (d0, d2), (m0, m1)),
    st.floats(-3, 3), st.floats(50, 600), st.floats(1, 15), st.floats(0, 900), st.floats(-2, 2), st.floats(-200, 50),
)  # fmt: skip


@pytest.mark.parametrize(("alpha", "speed", "zeta"), [(3.0, 0.39950, -26.0769), (6.0, 0.28489, -18.8434)])
def test_thauv_case_01_by_hand(alpha: float, speed: float, zeta: float) -> None:
    found = glide(CASE_01, 0.48302 * 9.81, np.radians(alpha))
    assert found[0] == pytest.approx(speed, abs=1e-5)
    assert np.degrees(found[1]) == pytest.approx(zeta, abs=1e-4)


@given(POLARS, st.floats(0.02, 0.3), st.sampled_from([-3.0, 0.5, 6.0]))
def test_buoyancy_feeds_the_drag(polar: Polar, reach: float, weight: float) -> None:
    """Power of the net weight, m0 g depth_dot, is drag times speed; lift does no work."""
    alpha = -polar.lift[0] / polar.lift[1] + np.sign(weight) * reach
    speed, zeta = glide(polar, weight, alpha)
    sinking = -speed * np.sin(zeta)
    assert weight * sinking == pytest.approx(polar.drag_at(alpha) * speed**3, rel=1e-12)
    assert weight * np.cos(zeta) == pytest.approx(polar.lift_at(alpha) * speed**2, rel=1e-12)


@given(POLARS)
def test_no_glide_is_shallower_than_the_shallowest(polar: Polar) -> None:
    alpha = np.linspace(*WIDE, 2001)
    lift = polar.lift_at(alpha)
    dive, climb = shallowest(polar)
    assert np.all(glide(polar, 1.0, alpha[lift > 0.0])[1] <= dive + 1e-12)
    assert np.all(glide(polar, -1.0, alpha[lift < 0.0])[1] >= climb - 1e-12)


def test_the_shallowest_glide_of_a_symmetric_polar_by_hand() -> None:
    """tan(zeta) = -2 sqrt(D0 D2) / L1."""
    dive, climb = shallowest(GRAVER)
    assert np.tan(dive) == pytest.approx(-2.0 * np.sqrt(2.15 * 25.0) / 132.5, rel=1e-12)
    assert climb == -dive


def test_shallowest_is_the_best_ratio_of_lift_to_drag() -> None:
    alpha = np.linspace(*WIDE, 200_001)
    ratio = CASE_01.lift_at(alpha) / CASE_01.drag_at(alpha)
    assert shallowest(CASE_01)[0] == pytest.approx(-np.arctan(1.0 / ratio.max()), abs=1e-8)
    assert shallowest(CASE_01)[1] == pytest.approx(np.arctan(-1.0 / ratio.min()), abs=1e-8)


@pytest.mark.parametrize("degrees", [-60.0, -25.0, -8.0, 25.0, 45.0])
def test_leonard_and_gravers_design_is_what_balances(degrees: float) -> None:
    """Angle of attack, ballast and position of the sliding mass for a glide at 0.3 m/s, by the formulas of the source."""
    xi, speed, g, mass, below = np.radians(degrees), 0.3, 9.816, 9.0, 0.05
    (kl0, kl), (kd0, kd) = GRAVER.lift, GRAVER.drag
    inside = 1.0 - 4.0 * kd / kl**2 / np.tan(xi) * (kd0 / np.tan(xi) + kl0)
    alpha = 0.5 * kl / kd * np.tan(xi) * (-1.0 + np.sqrt(inside))
    theta, v1, v3 = xi + alpha, speed * np.cos(alpha), speed * np.sin(alpha)
    ballast = (-np.sin(xi) * (kd0 + kd * alpha**2) + np.cos(xi) * kl * alpha) * speed**2 / g
    position = -np.tan(theta) * below + (65.0 * v1 * v3 - 100.0 * alpha * speed**2) / (mass * g * np.cos(theta))
    assert glide(GRAVER, ballast * g, np.array(alpha)) == pytest.approx((speed, xi), rel=1e-9)
    found = balanced(GRAVER, ballast * g, 65.0, mass * g * position, mass * g * below, WIDE)
    assert np.min(np.abs(found - alpha)) < 1e-9


@given(st.floats(0.1, 2.0), st.floats(-1.0, 4.0), st.floats(1.0, 8.0), st.floats(0.0, 250.0))
def test_a_symmetric_glider_climbs_as_it_dives(weight: float, ahead: float, below: float, munk: float) -> None:
    down = balanced(GRAVER, weight, munk, ahead, below, WIDE)
    up = balanced(GRAVER, -weight, munk, -ahead, below, WIDE)
    assert up == pytest.approx(-down[::-1], abs=1e-9)


@given(POLARS, st.floats(-4, 4).filter(lambda w: abs(w) > 0.05), st.floats(0, 250), st.floats(-3, 3), st.floats(0.5, 8))
def test_every_root_is_in_balance(polar: Polar, weight: float, munk: float, ahead: float, below: float) -> None:
    for alpha in balanced(polar, weight, munk, ahead, below, WIDE):
        assert pitch_moment(polar, weight, munk, ahead, below, alpha) == pytest.approx(0.0, abs=1e-9)
        assert polar.lift_at(alpha) * weight > 0.0
        assert abs(glide(polar, weight, alpha)[1] + alpha) < np.pi / 2


def test_both_of_two_balances_are_found() -> None:
    """A moment that vanishes at two planted angles."""
    below, weight, planted = 4.0, 1.0, (0.03, 0.09)
    rows, wanted = [], []
    for a in planted:
        speed, zeta = glide(GRAVER, weight, np.array(a))
        rows.append([speed**2 * np.sin(a) * np.cos(a), -np.cos(zeta + a)])
        wanted.append(below * np.sin(zeta + a) - speed**2 * GRAVER.moment_at(np.array(a)))
    munk, ahead = np.linalg.solve(rows, wanted)
    assert balanced(GRAVER, weight, float(munk), float(ahead), below, (0.01, 0.15)) == pytest.approx(planted, abs=1e-9)

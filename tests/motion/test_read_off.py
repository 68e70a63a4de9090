import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from coeflab.motion.readings import crossing, decay, extreme, settled, value_at


def test_a_crossing_lies_between_rows_and_has_a_direction() -> None:
    t, y = np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 2.0, -2.0, 2.0])
    assert crossing(t, y, 1.0, rises=True) == 0.5
    assert crossing(t, y, 1.0, rises=False) == 1.25
    assert crossing(t, y, 1.0, rises=True, after=1.0) == pytest.approx(2.75)
    assert crossing(t, y, 5.0, rises=True) is None


def test_a_row_on_the_level_counts_as_passed_once() -> None:
    t, y = np.arange(4.0), np.array([-1.0, 0.0, 1.0, 2.0])
    assert crossing(t, y, 0.0, rises=True) == 1.0
    assert crossing(t, y, 0.0, rises=True, after=1.0) is None


@given(st.floats(0.2, 5.0), st.floats(0.05, 0.9))
def test_the_peak_of_a_parabola_is_exact(curvature: float, place: float) -> None:
    t = np.linspace(0.0, 1.0, 8)
    y = 3.0 - curvature * (t - place) ** 2
    inner = t[1] < place < t[-2]
    found = extreme(t, y, largest=True, after=-1.0)
    if not inner:
        return
    assert found == pytest.approx((place, 3.0), abs=1e-9)
    assert extreme(t, -y, largest=False, after=-1.0) == pytest.approx((place, -3.0), abs=1e-9)


def test_no_extreme_of_a_monotonic_motion() -> None:
    t = np.linspace(0.0, 1.0, 9)
    assert extreme(t, t, largest=True, after=-1.0) is None


def test_a_motion_is_settled_or_it_is_not() -> None:
    t = np.linspace(0.0, 100.0, 401)
    y = 2.0 + np.exp(-t)
    assert settled(t, y, 10.0, 1e-6) == pytest.approx(2.0, abs=1e-6)
    assert settled(t, 2.0 + 0.01 * t, 10.0, 1e-6) is None
    assert settled(t, y, 200.0, 1.0) is None


@pytest.mark.parametrize("damping", [0.01, 0.05, 0.2])
def test_decay_of_a_linear_oscillator(damping: float) -> None:
    """x = exp(-zeta w t) cos-like with the closed form's period 2 pi / (w sqrt(1 - zeta^2))."""
    w = 2.0
    damped = w * np.sqrt(1.0 - damping**2)
    t = np.linspace(0.0, 30.0, 3001)
    x = np.exp(-damping * w * t) * (np.cos(damped * t) + damping * w / damped * np.sin(damped * t))
    period, ratio = decay(t, x) or (np.nan, np.nan)
    assert period == pytest.approx(2.0 * np.pi / damped, rel=1e-4)
    assert ratio == pytest.approx(damping, rel=1e-3)
    for rest in (-0.4, 0.3, 2.0):
        assert decay(t, rest + x) == pytest.approx((period, ratio), rel=1e-5)
    assert decay(t, -x) == pytest.approx((period, ratio), rel=1e-9)


def test_decay_needs_three_extremes() -> None:
    t = np.linspace(0.0, 1.0, 101)
    assert decay(t, np.exp(-t)) is None
    assert value_at(t, 2.0 * t, 0.25) == pytest.approx(0.5)

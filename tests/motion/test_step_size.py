"""The longest step that the scheme stands, by its printed region of stability and by marching."""

from __future__ import annotations

import re

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.motion.integrators.fixed_step import largest_step
from coeflab.motion.marching import march
from tests.motion.fleet import coasting, massive


def test_ends_of_the_region_of_stability() -> None:
    """-2.785 on the real axis and 2 sqrt(2) on the imaginary one (Hairer & Wanner II, section IV.2)."""
    assert largest_step(np.array([-10.0 + 0j])) == pytest.approx(0.2785, abs=1e-4)
    assert largest_step(np.array([-1e-7 + 5j, -1e-7 - 5j])) == pytest.approx(np.sqrt(8.0) / 5.0, rel=1e-3)
    assert largest_step(np.array([-1.0 + 0j, -50.0 + 0j, 3.0 + 0j])) == pytest.approx(2.785 / 50.0, rel=1e-3)
    assert largest_step(np.array([0j, 2.0 + 0j])) == np.inf


def test_a_decaying_motion_falls_below_the_step_and_grows_above() -> None:
    for z, falls in ((2.78, True), (2.79, False)):
        assert (abs(1 - z + z**2 / 2 - z**3 / 6 + z**4 / 24) < 1.0) is falls


@pytest.mark.parametrize("kernel", ["numpy", "compiled"])
def test_a_stiff_vehicle_refuses_a_long_step_with_the_longest_that_serves(kernel: str) -> None:
    """Roll with strong damping and little inertia; a little below the named step the roll dies out."""
    v = massive(np.diag([3.0, 50.0, 50.0, 0.1, 10.0, 10.0]), np.zeros(3), {"Kp": -0.1, "X0": -1e-3}, free=("u", "p"))
    asked = coasting(2.0, [1.5, 0, 0, 0.1, 0, 0])
    rate = 0.1 * 0.5 * 1000.0 * 2.0**4 * 1.5 / (v.inertia[0, 0] + 0.1)
    named = f"at most {2.785 / rate:.3g} s: the fastest small motion, {rate:.3g} 1/s"
    with pytest.raises(InputError, match=re.escape(named)):
        march(v, asked, 0.01, kernel=kernel)
    found = march(v, asked, 0.95 * 2.785 / rate, kernel=kernel).trajectory()
    assert abs(found.velocity[-1, 3]) < 1e-3


def test_the_step_is_chosen_from_the_fastest_motion() -> None:
    v = massive(np.diag([3.0, 50.0, 50.0, 0.1, 10.0, 10.0]), np.zeros(3), {"Kp": -0.1, "X0": -1e-3}, free=("u", "p"))
    found = march(v, coasting(0.5, [1.5, 0, 0, 0.1, 0, 0]), record=0.1)
    rate = 0.1 * 0.5 * 1000.0 * 2.0**4 * 1.5 / (v.inertia[0, 0] + 0.1)
    assert 0.1 < found.step * rate <= 0.2501
    assert found.marching.times == pytest.approx(np.arange(6) * 0.1)
    with pytest.raises(InputError, match="the adaptive integrator takes longer steps"):
        march(v, coasting(5e4, [1.5, 0, 0, 0.1, 0, 0]))

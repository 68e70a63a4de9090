"""Ranges of a synthetic vehicle: one rule flags the rows of a motion and words one of them."""

from __future__ import annotations

from math import degrees, sin

import numpy as np
import pytest

from coeflab.motion.trajectory import outside, outside_in_words
from coeflab.motion.vehicle import Vehicle, vehicle
from tests.motion.trimmed import parameter_file


def ranged(*covered: tuple[str, float, float]) -> Vehicle:
    ranges = [
        {"variable": name, "low": low, "high": high, "unit": "1" if name.endswith("'") else "rad", "campaign": "arm"}
        for name, low, high in covered
    ]
    return vehicle(
        parameter_file({"Xu|u|": -10.0, "Yv|v|": -80.0}, 20.0, (1.0, 4.0, 5.0), covered=ranges), ("u", "v", "r")
    )


def test_ranges_are_joined_where_they_touch_and_a_gap_is_outside() -> None:
    craft = ranged(("r'", 0.0, 0.1), ("r'", -0.1, 0.0), ("r'", 0.2, 0.3))
    rates = np.array([-0.11, -0.1, 0.05, 0.15, 0.25, 0.31])
    nu = np.zeros((6, 6))
    nu[:, 0], nu[:, 5] = 3.0, rates * 3.0 / craft.length
    flags = outside(craft, nu, {})["r'"]
    assert flags.tolist() == [True, False, False, True, False, True]
    for row, flag in zip(nu, flags, strict=True):
        assert bool(outside_in_words(craft, row, {})) == flag
    spans = "-0.1000 to 0.1000 or 0.2000 to 0.3000"
    assert outside_in_words(craft, nu[3], {}) == (f"r' = 0.1500 is outside the data, {spans}.",)


def test_angles_of_the_flow_and_of_controls() -> None:
    craft = ranged(("asin(v/U)", -0.2, 0.2), ("dr", -0.3, 0.3))
    nu = np.array([2.0 * np.cos(0.25), 2.0 * sin(0.25), 0.0, 0.0, 0.0, 0.0])
    drift, rudder = outside_in_words(craft, nu, {"dr": 0.4})
    assert drift.startswith(f"asin(v/U) = {degrees(0.25):.2f} deg is outside")
    assert rudder == "rudder angle = 22.92 deg is outside the data, -17.19 to 17.19 deg."
    assert outside_in_words(craft, nu * [1.0, 0.0, 0.0, 0.0, 0.0, 0.0], {"dr": -0.3}) == ()


@pytest.mark.parametrize(("rate", "named"), [(0.0005, False), (0.01, True)])
def test_a_motion_of_which_no_range_speaks_is_flagged_where_it_is_not_small(rate: float, named: bool) -> None:
    craft = ranged(("asin(v/U)", -0.2, 0.2))
    flags = outside(craft, np.array([[1.0, 0.0, 0.0, 0.0, 0.0, rate / craft.length]]), {})
    assert ("r': no data cover it" in flags) is named

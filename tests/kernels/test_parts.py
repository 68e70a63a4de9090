"""Cylinders and plates: HUUV equations 28-31 as corrected, and their limits."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.kernels.composition import moved
from coeflab.kernels.parts import (
    box_added_mass,
    cylinder_added_mass,
    cylinder_with_ends,
    plate_added_mass,
    plate_coefficient,
)

RHO = 1000.0


def test_cylinder_symbol_by_symbol() -> None:
    r, length = 0.07, 1.2
    k = RHO * np.pi * r**2 * length
    assert np.diag(cylinder_added_mass(r, length, RHO)) == pytest.approx(
        [0.1 * k, k, k, 0.0, k * length**2 / 12.0, k * length**2 / 12.0], rel=1e-15
    )


def test_cylinder_on_its_end() -> None:
    about_end = moved(cylinder_added_mass(0.05, 0.4, RHO), np.array([0.2, 0.0, 0.0]))
    assert about_end[5, 5] == pytest.approx(RHO * np.pi * 0.05**2 * 0.4**3 / 3.0, rel=1e-14)


def test_end_corrected_cylinder_lies_below_and_converges() -> None:
    plain, ends = np.diag(cylinder_added_mass(0.1, 1.0, 1.0)), np.diag(cylinder_with_ends(0.1, 1.0, 1.0))
    assert 0.5 < ends[1] / plain[1] < 1.0
    assert 0.5 < ends[5] / plain[5] < 1.0
    plain, ends = np.diag(cylinder_added_mass(1e-4, 1.0, 1.0)), np.diag(cylinder_with_ends(1e-4, 1.0, 1.0))
    assert ends[[1, 5]] == pytest.approx(plain[[1, 5]], rel=1e-5)


@pytest.mark.parametrize(("aspect", "k"), [(1.0, 0.579), (2.0, 0.756), (3.0, 0.831), (5.0, 0.896), (1e9, 1.0)])
def test_plate_coefficient_at_its_sources(aspect: float, k: float) -> None:
    assert plate_coefficient(aspect) == pytest.approx(k, rel=1e-8)


def test_plate_coefficient_rises_smoothly() -> None:
    values = np.array([plate_coefficient(a) for a in np.geomspace(1.0, 1000.0, 400)])
    assert np.all(np.diff(values) > 0.0)
    assert values[-1] < 1.0
    assert np.max(np.diff(values)) < 0.02


def test_plate_symbol_by_symbol() -> None:
    """Equation 30 as corrected: c^2 b, linear in the long side."""
    found = plate_added_mass(0.12, 0.24, RHO)
    assert found[2, 2] == pytest.approx(0.756 * np.pi / 4.0 * RHO * 0.12**2 * 0.24, rel=1e-12)
    assert not np.any(np.diag(found)[[0, 1, 5]])
    swapped = np.diag(plate_added_mass(0.24, 0.12, RHO))
    assert swapped[[2, 3, 4]] == pytest.approx(np.diag(found)[[2, 4, 3]], rel=1e-14)


def test_square_plate_turns_alike_about_both_sides() -> None:
    found = plate_added_mass(0.3, 0.3, RHO)
    assert found[3, 3] == pytest.approx(found[4, 4], rel=1e-13)
    assert found[3, 3] == pytest.approx(16.0 / 45.0 * RHO * (0.3 / np.sqrt(np.pi)) ** 5, rel=1e-13)


def test_long_plate_turns_as_far_below_sections_as_said() -> None:
    found = plate_added_mass(1e-4, 1.0, 1.0)[3, 3] / (np.pi / 48.0 * 1e-8)
    assert found == pytest.approx(1.0 - 0.27, abs=0.005)


def test_cube_is_a_sphere_of_its_volume() -> None:
    assert box_added_mass(np.array([2.0, 2.0, 2.0]), RHO)[0, 0] == pytest.approx(0.5 * RHO * 8.0, rel=1e-13)

"""SUBOFF's sail and planes against brute force, on a hull whose answer is easy and on the real one."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.profiles import suboff_profile
from coeflab.bodies.readers.groves import (
    HALF_THICKNESS,
    SAIL_JOINTS,
    TIP,
    TRAILING_EDGE,
    plane,
    sail,
    sail_half_thickness,
    sail_sections,
)


def cylinder(radius: float):
    return lambda x: (np.full_like(x, radius), np.zeros_like(x))


def chord(y: np.ndarray) -> np.ndarray:
    return -0.466308 * y + 0.88859


def naca(q: np.ndarray) -> np.ndarray:
    """The planes' half thickness over chord, written anew from the page."""
    return 0.2969 * q**0.5 - 0.126 * q - 0.3516 * q**2 + 0.2852 * q**3 - 0.1045 * q**4


def test_sail_sections_of_the_page() -> None:
    b, _ = sail_half_thickness(np.array([3.032986, 3.358507, 3.45, 3.559028, 4.241319]))
    assert b == pytest.approx([0.0, 0.109375, 0.109375, 0.109375, 0.0], abs=1e-8)
    top = sail_sections(40, 8, 8)[..., 2].max()
    assert top == pytest.approx(1.5625, abs=1e-6)


def test_slope_of_the_sail() -> None:
    x, h = np.linspace(3.06, 4.2, 60), 1e-6
    b, slope = sail_half_thickness(x)
    difference = (sail_half_thickness(x + h)[0] - sail_half_thickness(x - h)[0]) / (2.0 * h)
    assert slope == pytest.approx(b * difference, abs=1e-8)


def test_sail_by_counting_columns() -> None:
    """Midpoints in x and y: the column from the hull to the cap, as written on the page."""
    x = np.linspace(SAIL_JOINTS[0], SAIL_JOINTS[-1], 8001)
    x = (x[1:] + x[:-1]) / 2.0
    b, _ = sail_half_thickness(x)
    share = (np.arange(400) + 0.5) / 400.0
    y = b[:, None] * share
    radius = suboff_profile(x)[0][:, None]
    top = 1.507813 + 0.5 * b[:, None] * np.sqrt(1.0 - share**2)
    foot = np.sqrt(radius**2 - y**2)
    cell = 2.0 * b[:, None] / 400.0 * (SAIL_JOINTS[-1] - SAIL_JOINTS[0]) / 8000.0
    found = sail(suboff_profile)
    assert found.volume == pytest.approx(float(np.sum(cell * (top - foot))), rel=1e-5)
    assert found.moment[0] == pytest.approx(float(np.sum(cell * (top - foot) * x[:, None])), rel=1e-5)
    assert found.moment[1] == pytest.approx(float(np.sum(cell * (top**2 - foot**2) / 2.0)), rel=1e-5)


def test_plane_by_counting_columns() -> None:
    """Midpoints in x and y: of each column across the plane only what is outside the hull."""
    y = (np.arange(1200) + 0.5) / 1200.0 * (TIP - 0.2) + 0.2
    x = TRAILING_EDGE - (np.arange(1200) + 0.5) / 1200.0 * 0.8
    q = np.clip((x[:, None] - TRAILING_EDGE) / chord(y) + 1.0, 0.0, 1.0)
    half = chord(y) * naca(q)
    within = np.sqrt(np.clip(suboff_profile(x)[0][:, None] ** 2 - y**2, 0.0, None))
    column = 2.0 * np.clip(half - within, 0.0, None) * 0.8 / 1200.0 * (TIP - 0.2) / 1200.0
    found = plane(suboff_profile)
    assert found.volume == pytest.approx(float(column.sum()), rel=1e-4)
    assert found.moment[0] == pytest.approx(float(np.sum(column * x[:, None])), rel=1e-4)


def test_surfaces_by_fine_facets() -> None:
    """Facets of a plane, corner to corner, wherever their middle is outside a cylinder that it stands on."""
    q = (np.arange(1201) / 1200.0)[:, None] ** 2
    y = np.linspace(0.08, TIP, 2401)
    corner = np.stack([TRAILING_EDGE - chord(y) * (1.0 - q), y + 0.0 * q, chord(y) * naca(q)], axis=-1)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    middle = (a + b + c + d) / 4.0
    outside = np.hypot(middle[..., 1], middle[..., 2]) > 0.12
    area = 2.0 * float(np.sum(np.linalg.norm(np.cross(c - a, d - b), axis=-1)[outside]) / 2.0)
    tip = 2.0 * chord(np.array(TIP)) ** 2 * float(np.trapezoid(naca(q[:, 0]), q[:, 0]))
    assert plane(cylinder(0.12)).surface == pytest.approx(area + tip, rel=5e-4)


def test_sides_and_cap_of_the_sail_by_fine_facets() -> None:
    loops = sail_sections(1600, 1, 400)
    foot = loops[..., 2] < 0.7
    loops[..., 2] = np.where(foot, np.sqrt((5.0 / 6.0) ** 2 - loops[..., 1] ** 2), loops[..., 2])
    a, b, c, d = loops[:-1, :-1], loops[:-1, 1:], loops[1:, 1:], loops[1:, :-1]
    area = float(np.sum(np.linalg.norm(np.cross(c - a, d - b), axis=-1)) / 2.0)
    assert sail(cylinder(5.0 / 6.0)).surface == pytest.approx(area, rel=1e-4)


def test_covered_hull() -> None:
    """On a wide cylinder an appendage hides little more than its own flat section."""
    wide = plane(cylinder(0.6))
    section = 2.0 * chord(np.array(0.6)) ** 2 * float(np.sum(naca((np.arange(4000) + 0.5) / 4000.0)) / 4000.0)
    assert wide.covered == pytest.approx(section, rel=5e-3)
    assert wide.covered > section
    x = np.linspace(SAIL_JOINTS[0], SAIL_JOINTS[-1], 20001)
    b, _ = sail_half_thickness((x[1:] + x[:-1]) / 2.0)
    flat = 2.0 * float(np.sum(b)) * (x[1] - x[0])
    assert sail(cylinder(5.0 / 6.0)).covered == pytest.approx(flat, rel=5e-3)
    assert float(b.max()) == pytest.approx(HALF_THICKNESS)

"""Boundary elements and closed forms of plane sections against each other and against printed values."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.closed_forms.sections import (
    as_ellipse,
    as_rectangle,
    carried,
    ellipse,
    rectangle,
    section_integrals,
    turned,
)
from coeflab.bodies.section_elements import divided
from coeflab.bodies.section_flow import section_matrices

PI = np.pi


def finned_circle(radius: float, semi_span: float) -> float:
    """Translation across the span of a circle with two thin fins in line, or of any direction with four in a cross.

    Source: Bryson, J. Aeronautical Sciences 21 (1954); Newman (1977), Table 4.3. Zero radius is a plate or a cross.
    """
    s, r = semi_span, radius
    return float(np.pi * (s**2 - r**2 + r**4 / s**2))


def cross_roll(semi_span: float) -> float:
    """Roll of a cross of two thin plates of half-length ``semi_span`` about its centre: 2 s^4 / pi (Newman 1977)."""
    return 2.0 * semi_span**4 / np.pi


def computed(contour: np.ndarray, count: int = 120) -> np.ndarray:
    return section_matrices(divided(contour, count)[None], np.zeros(count, dtype=np.int64))[0]


def oval(a: float, b: float, count: int = 400) -> np.ndarray:
    t = 2.0 * PI * np.arange(count) / count
    return np.column_stack([a * np.cos(t), b * np.sin(t)])


def box(a: float, b: float) -> np.ndarray:
    return np.array([[-a, -b], [a, -b], [a, b], [-a, b]])


def finned(radius: float, span: float, half: float, fins: int) -> np.ndarray:
    """A circle with fins of half-thickness ``half``."""
    begin = np.arcsin(half / radius)
    arc = np.linspace(begin, 2.0 * PI / fins - begin, 400 // fins)
    one = np.vstack([[[span, -half], [span, half]], radius * np.column_stack([np.cos(arc), np.sin(arc)])])
    angles = 2.0 * PI * np.arange(fins) / fins
    return np.vstack([one @ np.array([[np.cos(t), np.sin(t)], [-np.sin(t), np.cos(t)]]) for t in angles])


def test_circle() -> None:
    found = computed(oval(0.7, 0.7))
    assert found[0, 0] == pytest.approx(PI * 0.49, rel=5e-4)
    assert found[1, 1] == pytest.approx(PI * 0.49, rel=5e-4)
    assert abs(found[2, 2]) < 1e-6
    assert np.abs(found - np.diag(np.diag(found))).max() < 1e-6


def test_error_falls_with_the_square_of_the_element() -> None:
    errors = [1.0 - computed(oval(1.0, 1.0, 2000), n)[0, 0] / PI for n in (50, 100, 200)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.25)


@pytest.mark.parametrize("b", [0.8, 0.5, 0.2, 0.1])
def test_ellipses(b: float) -> None:
    found, exact = computed(oval(1.0, b)), ellipse(1.0, b)
    assert np.diag(found)[1:] == pytest.approx(np.diag(exact)[1:], rel=1e-3)
    assert found[0, 0] == pytest.approx(exact[0, 0], rel=4e-3)


@pytest.mark.parametrize(("half", "within"), [(0.01, 0.04), (0.001, 0.008), (0.0001, 0.003)])
def test_thin_plates_tend_to_the_flat_one(half: float, within: float) -> None:
    """A flat plate has pi a^2 and pi a^4 / 8 (Newman 1977, Table 4.3); thickness adds."""
    found, plate = computed(box(1.0, half)), ellipse(1.0, 0.0)
    assert found[1, 1] == pytest.approx(plate[1, 1], rel=within)
    assert found[2, 2] == pytest.approx(plate[2, 2], rel=within)


def test_square() -> None:
    """4.754 a^2 in translation, 0.725 a^4 in roll (Newman 1977, Table 4.3)."""
    found = computed(box(2.0, 2.0))
    assert found[0, 0] == pytest.approx(4.754 * 4.0, rel=5e-4)
    assert found[1, 1] == pytest.approx(4.754 * 4.0, rel=5e-4)
    assert found[2, 2] == pytest.approx(0.725 * 16.0, rel=3e-3)


@pytest.mark.parametrize(
    ("ratio", "printed"), [(10.0, 1.14), (5.0, 1.21), (2.0, 1.36), (1.0, 1.51), (0.5, 1.70), (0.2, 1.98), (0.1, 2.23)]
)
def test_rectangles_beside_the_printed_table(ratio: float, printed: float) -> None:
    """DNV-RP-C205, table D-1: a / b with a the half-side across the motion; two digits after the point, 0.5 % off."""
    assert rectangle(ratio, 1.0)[1, 1] / (PI * ratio**2) == pytest.approx(printed, rel=7e-3)
    assert rectangle(1.0, ratio)[0, 0] / (PI * ratio**2) == pytest.approx(printed, rel=7e-3)


@pytest.mark.parametrize("b", [0.93, 0.8, 0.55, 0.3, 0.13, 0.05])
def test_the_table_of_rectangles_between_its_points(b: float) -> None:
    found = np.diag(computed(box(1.0, b), 300))
    assert np.diag(rectangle(1.0, b)) == pytest.approx(found, rel=2e-3)
    assert np.diag(rectangle(b, 1.0)) == pytest.approx(found[[1, 0, 2]], rel=2e-3)


def test_a_rectangle_too_slender_for_the_table() -> None:
    with pytest.raises(ValueError, match="slender"):
        rectangle(1.0, 0.001)


@pytest.mark.parametrize("span", [1.2, 2.0, 4.0])
def test_circles_with_thin_fins(span: float) -> None:
    """pi (s^2 - R^2 + R^4 / s^2) across two fins and any way with four; along two fins pi R^2 (Bryson 1954)."""
    two, four = (computed(finned(1.0, span, 1e-4, n), 240) for n in (2, 4))
    exact = finned_circle(1.0, span)
    assert two[1, 1] == pytest.approx(exact, rel=5e-3)
    assert two[0, 0] == pytest.approx(PI, rel=5e-3)
    assert four[0, 0] == pytest.approx(exact, rel=5e-3)
    assert four[1, 1] == pytest.approx(exact, rel=5e-3)
    assert abs(four[0, 1]) < 1e-6 * exact


def test_cross_of_plates() -> None:
    half = 2e-4
    cross = finned(np.sqrt(2.0) * half, 1.0, half, 4)
    found = computed(cross, 240)
    assert found[0, 0] == pytest.approx(finned_circle(0.0, 1.0), rel=3e-3)
    assert found[2, 2] == pytest.approx(cross_roll(1.0), rel=5e-3)


def test_coupling_follows_from_moving_and_turning() -> None:
    """A section turned and moved: the same matrix, turned and carried."""
    wedge = np.array([[-1.0, -0.5], [2.0, 0.0], [-1.0, 0.8]])
    own = computed(wedge, 200)
    t = 0.4
    there = wedge @ np.array([[np.cos(t), np.sin(t)], [-np.sin(t), np.cos(t)]]) + [3.0, -2.0]
    assert computed(there, 200) == pytest.approx(carried(turned(own, t), np.array([3.0, -2.0])), abs=1e-8)
    assert abs(own[0, 2]) > 1e-3
    assert np.linalg.eigvalsh(own)[0] > 0.0


def test_two_circles_far_apart_and_close() -> None:
    """Far apart each has its own; close together they shelter each other along their line and add across it."""
    contour = np.repeat([0, 1], 60)
    ring = divided(oval(1.0, 1.0), 60)

    def pair(apart: float) -> np.ndarray:
        return section_matrices(
            np.vstack([ring + np.array([apart, 0.0]), ring - np.array([apart, 0.0])])[None], contour
        )[0]

    far = pair(200.0)
    assert np.diag(far)[:2] == pytest.approx([2.0 * PI] * 2, rel=2e-3)
    assert far[2, 2] == pytest.approx(2.0 * PI * 200.0**2, rel=2e-3)
    near = pair(1.2)
    assert near[0, 0] < 0.9 * far[0, 0] < near[1, 1]


def test_many_sections_at_once_and_one_by_one() -> None:
    stack = np.array([divided(box(a, 1.0), 80) for a in (0.5, 1.0, 3.0)])
    belongs = np.zeros(80, dtype=np.int64)
    together = section_matrices(stack, belongs)
    for k in range(3):
        assert section_matrices(stack[k : k + 1], belongs)[0] == pytest.approx(together[k], rel=1e-12, abs=1e-14)


def test_units() -> None:
    one, thousand = computed(box(1.0, 0.3)), computed(1000.0 * box(1.0, 0.3))
    unit = np.array([1.0, 1.0, 1000.0])
    assert thousand == pytest.approx(1e6 * one * np.outer(unit, unit), rel=1e-10, abs=1e-4)


def test_ellipses_are_recognised_and_nothing_else() -> None:
    t = 0.3
    turn = np.array([[np.cos(t), np.sin(t)], [-np.sin(t), np.cos(t)]])
    contour = oval(3.0, 1.0, 60) @ turn + [5.0, 5.0]
    found = as_ellipse(contour, section_integrals([contour]))
    assert found[:2] == pytest.approx([3.0, 1.0], rel=3e-3)
    assert np.tan(found[2]) == pytest.approx(np.tan(t), rel=1e-9)
    for other in (box(1.0, 1.0), box(3.0, 1.0), oval(1.0, 1.0, 8), finned(1.0, 1.1, 0.05, 2)):
        assert as_ellipse(other, section_integrals([other])) is None


def test_rectangles_are_recognised_and_nothing_else() -> None:
    t = -0.7
    turn = np.array([[np.cos(t), np.sin(t)], [-np.sin(t), np.cos(t)]])
    dense = np.array([[-2, -1], [0, -1], [2, -1], [2, 0.3], [2, 1], [-2, 1]]) @ turn + [1.0, -4.0]
    found = as_rectangle(dense, section_integrals([dense]))
    assert found is not None
    a, b, angle = found
    assert sorted([a, b]) == pytest.approx([1.0, 2.0])
    assert turned(rectangle(a, b), angle) == pytest.approx(turned(rectangle(2.0, 1.0), t), abs=1e-12)
    skew, kite = box(2.0, 1.0) @ np.array([[1.0, 0.0], [0.2, 1.0]]), np.array([[-1.0, 0], [0, -1], [3, 0], [0, 1]])
    for other in (skew, kite, oval(1.0, 1.0, 60), box(1.0, 1e-3), np.delete(box(1.0, 1.0), 0, axis=0)):
        assert as_rectangle(other, section_integrals([other])) is None


def test_integrals_of_a_ring() -> None:
    middle = np.array([1.0, 0.0])
    found = section_integrals([oval(2.0, 2.0, 2000) + middle, oval(1.0, 1.0, 2000)[::-1] + middle])
    assert found.area == pytest.approx(3.0 * PI, rel=1e-5)
    assert found.centroid == pytest.approx([1.0, 0.0], abs=1e-12)
    assert found.second == pytest.approx(np.eye(2) * PI * 15.0 / 4.0, rel=1e-5, abs=1e-10)

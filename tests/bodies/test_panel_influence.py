"""Solid angles and integrals of 1 / r against closed forms, brute force and each other."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.bodies.mesh.structured_surface import box_surface
from coeflab.bodies.panel_solver import influence as panel_influence
from coeflab.bodies.panel_solver import influence_compiled as panel_compiled
from coeflab.bodies.panel_solver.influence import exact_integrals, influence
from coeflab.bodies.panel_solver.panels import Panels, panels_of, split_in_four

CUBE = box_surface(np.array([2.0, 2.0, 2.0]), 48)
CORNERS = CUBE[0][CUBE[1]]


def seen(point: list[float]) -> tuple[np.ndarray, np.ndarray]:
    panels = panels_of(CORNERS)
    return exact_integrals(np.tile(point, (panels.count, 1)), panels.corners, panels.normal)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3))
def test_a_closed_surface_fills_the_sky_or_nothing(point: list[float]) -> None:
    away = np.max(np.abs(point)) - 1.0
    if abs(away) < 1e-6:
        return
    assert seen(point)[0].sum() == pytest.approx(4.0 * np.pi if away < 0.0 else 0.0, abs=1e-9)


def test_one_over_r_at_the_centroid_of_an_equilateral_triangle() -> None:
    """6 rho ln(2 + sqrt 3), rho the radius of the inscribed circle; in its own plane the solid angle is none."""
    rho = 0.7
    angle = np.pi / 6.0 + np.arange(3) * 2.0 * np.pi / 3.0
    corners = 2.0 * rho * np.stack([np.cos(angle), np.sin(angle), np.zeros(3)], axis=1)
    solid, inverse = exact_integrals(np.zeros((1, 3)), corners[None], np.array([[0.0, 0.0, 1.0]]))
    assert inverse[0] == pytest.approx(6.0 * rho * np.log(2.0 + np.sqrt(3.0)), rel=1e-14)
    assert solid[0] == 0.0


def test_one_over_r_above_a_cube_by_brute_force() -> None:
    point = [0.3, -0.2, 1.4]
    fine = CORNERS
    for _ in range(5):
        fine = split_in_four(fine)
    small = panels_of(fine)
    brute = np.sum(small.area / np.linalg.norm(small.centre - point, axis=1))
    assert seen(point)[1].sum() == pytest.approx(brute, rel=1e-4)


def test_in_line_with_a_side_nothing_breaks() -> None:
    solid, inverse = seen([3.0, 1.0, 1.0])
    assert np.all(np.isfinite(solid))
    assert inverse.sum() == pytest.approx(seen([3.0, 1.0 + 1e-9, 1.0])[1].sum(), rel=1e-7)


def test_moments_of_a_layer_follow_from_the_layer() -> None:
    """The integral of (y x n) / r over a closed surface is x times (cross) that of n / r: by brute force."""
    point = np.array([0.3, -0.2, 1.4])
    fine = CORNERS
    for _ in range(5):
        fine = split_in_four(fine)
    small = panels_of(fine)
    weight = (small.area / np.linalg.norm(small.centre - point, axis=1))[:, None]
    layer = np.sum(weight * small.normal, axis=0)
    brute = np.sum(weight * np.cross(small.centre, small.normal), axis=0)
    assert brute == pytest.approx(np.cross(point, layer), abs=2e-4 * np.linalg.norm(layer))


def stretched() -> Panels:
    """A closed surface of unlike panels."""
    vertices, faces = box_surface(np.array([2.0, 0.5, 0.3]), 900)
    bent = vertices * (1.0 + 0.3 * vertices[:, :1])
    return panels_of(bent[faces])


def test_rows_fill_half_the_sky() -> None:
    angles, _ = influence(stretched())
    assert angles.sum(axis=1) == pytest.approx(2.0 * np.pi, rel=1e-4)
    assert not np.any(np.diag(angles))


def test_far_panels_are_as_good_as_exact_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    angles, (layer,) = influence(stretched())
    monkeypatch.setattr(panel_influence, "REACH", 1e9)
    exact_angles, (exact_layer,) = influence(stretched())
    assert np.max(np.abs(layer - exact_layer)) < 1e-4 * np.max(np.abs(exact_layer))
    assert np.max(np.abs(angles - exact_angles)) < 5e-5
    assert np.max(np.abs(angles - exact_angles)) > 0.0


def test_compiled_and_plain_agree() -> None:
    plain, compiled = influence(stretched()), panel_compiled.influence(stretched())
    assert compiled[0].dtype == plain[0].dtype == np.float32
    assert np.max(np.abs(compiled[0] - plain[0])) < 1e-6
    # The plain layer is summed in single precision, as the angles are kept.
    assert np.max(np.abs(compiled[1][0] - plain[1][0])) < 1e-6 * np.max(np.abs(compiled[1][0]))

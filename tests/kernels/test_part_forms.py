"""Planted solids are recognised in any attitude, and what the fit promises to keep is kept."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import Manifold

from coeflab.kernels.attitude import angles, rotation
from coeflab.kernels.part_forms import likeness
from coeflab.kernels.solids import surface
from coeflab.kernels.surface_mesh import mesh_integrals
from tests.kernels.vehicles import rod

TURNS = [np.eye(3), rotation(0.0, np.pi / 2, 0.0), rotation(0.3, -0.5, 1.0)]
AT = np.array([3.0, -1.0, 0.5])


def turned(of: Manifold, turn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    vertices, faces = surface(of)
    return vertices @ turn.T + AT, faces


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("length", [4.0, 1.0, np.sqrt(3.0) * 0.5, 0.25])
def test_cylinders(turn: np.ndarray, length: float) -> None:
    """Long, short, of equal second moments, and a disc; 256 facets hold the circle to 1e-4."""
    found = likeness(*turned(rod(0.5, length, 256), turn))
    assert found.form == "cylinder"
    assert found.clear
    assert found.sizes == pytest.approx((0.5, length), rel=2e-4)
    assert found.centre == pytest.approx(AT)
    assert abs(found.rotation[:, 0] @ turn[:, 0]) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("sides", [(3.0, 2.0, 1.0), (1.0, 1.0, 1.0), (2.0, 2.0, 1.0), (1.0, 1.0, 4.0)])
def test_boxes(turn: np.ndarray, sides: tuple[float, ...]) -> None:
    found = likeness(*turned(Manifold.cube(sides, True), turn))
    assert found.form == "box"
    assert sorted(found.sizes) == pytest.approx(sorted(sides), rel=1e-5)
    back = np.abs(np.asarray(found.rotation).T @ turn)
    assert np.sort(back.ravel())[-3:] == pytest.approx(1.0, abs=1e-5)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("axes", [(3.0, 2.0, 1.0), (3.0, 1.0, 1.0), (1.0, 2.0, 2.0), (1.0, 1.0, 1.0)])
def test_ellipsoids(turn: np.ndarray, axes: tuple[float, ...]) -> None:
    solid = Manifold.sphere(1.0, 128).scale(axes)
    found = likeness(*turned(solid, turn))
    assert found.form == "ellipsoid"
    assert found.clear
    assert sorted(found.sizes) == pytest.approx(sorted(axes), rel=2e-3)
    assert 4.0 * np.pi / 3.0 * np.prod(found.sizes) == pytest.approx(solid.volume(), rel=1e-9)


@pytest.mark.parametrize("turn", [np.eye(3), rotation(np.pi / 4, 0.0, 0.0), rotation(np.pi / 2, 0.0, 0.0)])
@pytest.mark.parametrize("sides", [(0.4, 0.9), (0.9, 0.4), (0.5, 0.5)])
def test_plates_have_their_chord_fore_and_aft(turn: np.ndarray, sides: tuple[float, float]) -> None:
    found = likeness(*turned(Manifold.cube((*sides, 0.02), True), turn))
    assert found.form == "plate"
    assert found.sizes == pytest.approx(sides, rel=1e-6)
    assert found.rotation[:, 0] == pytest.approx([1, 0, 0], abs=1e-9)
    assert abs(found.rotation[:, 2] @ turn[:, 2]) == pytest.approx(1.0)


def test_a_long_swept_strut_keeps_its_own_direction() -> None:
    turn = rotation(0.0, 0.0, np.radians(40.0))
    found = likeness(*turned(Manifold.cube((2.0, 0.3, 0.02), True), turn))
    assert sorted(found.sizes) == pytest.approx([0.3, 2.0], rel=1e-6)
    assert np.degrees(angles(found.rotation)) == pytest.approx([0, 0, 40], abs=1e-6)


def test_a_plate_across_x_stands_up() -> None:
    found = likeness(*turned(Manifold.cube((0.02, 0.6, 0.4), True), np.eye(3)))
    assert found.form == "plate"
    assert abs(found.rotation[0, 2]) == pytest.approx(1.0)
    assert sorted(found.sizes) == pytest.approx([0.4, 0.6])


def test_a_tapered_plate_keeps_area_and_centre() -> None:
    wedge = Manifold.extrude(_slab(1.0, 0.05), 2.0, scale_top=(0.4, 1.0))
    vertices, faces = surface(wedge)
    found = likeness(vertices, faces)
    assert found.form == "plate"
    area = 2.0 * (1.0 + 0.4) / 2.0
    assert found.sizes[0] * found.sizes[1] == pytest.approx(area, rel=1e-9)
    assert found.centre[2] == pytest.approx(2.0 / 3.0 * (1.0 + 2.0 * 0.4) / 1.4, rel=1e-9)


def _slab(chord: float, thickness: float):
    from manifold3d import CrossSection

    return CrossSection.square((chord, thickness), True)


def test_cylinder_keeps_volume_and_area_across() -> None:
    """A cylinder with a dome: r and L are not the dimensions, but V and A across the axis stay."""
    domed = rod(0.2, 2.0) + Manifold.sphere(0.2, 96).translate((1.0, 0.0, 0.0))
    vertices, faces = surface(domed)
    found = likeness(vertices, faces)
    assert found.form == "cylinder"
    radius, length = found.sizes
    whole = mesh_integrals(vertices, faces)
    assert np.pi * radius**2 * length == pytest.approx(whole.volume, rel=1e-12)
    assert 2.0 * radius * length == pytest.approx(np.mean(whole.projected[1:]), rel=1e-12)


def test_what_resembles_nothing_says_so() -> None:
    cone = Manifold.cylinder(3.0, 1.0, 0.0, 64)
    ring = rod(1.0, 1.0) - rod(0.8, 1.2)
    for solid in (cone, ring):
        found = likeness(*surface(solid))
        assert not found.clear
        assert found.form in ("ellipsoid", "box")

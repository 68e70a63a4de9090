"""Planted solids are recognised in any attitude, and what the fit promises to keep is kept."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import CrossSection, Manifold

from coeflab.bodies.mesh.solids import surface
from coeflab.bodies.simplify.part_forms import likeness
from coeflab.bodies.simplify.volume_forms import Fit, Piece, boxes, cylinders, ellipsoids
from coeflab.law.transforms import angles, rotation
from tests.bodies.vehicles import lathe, rod

TURNS = [np.eye(3), rotation(0.0, np.pi / 2, 0.0), rotation(0.3, -0.5, 1.0)]
AT = np.array([3.0, -1.0, 0.5])


def turned(of: Manifold, turn: np.ndarray) -> Manifold:
    return of.transform(np.column_stack([turn, AT]))


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("length", [4.0, 1.0, np.sqrt(3.0) * 0.5, 0.25])
def test_cylinders(turn: np.ndarray, length: float) -> None:
    """Long, short, of equal second moments, and a disc; 256 facets hold the circle to 1e-4."""
    found = likeness(turned(rod(0.5, length, 256), turn))
    assert found.form == "cylinder"
    assert found.clear
    assert found.sizes == pytest.approx((0.5, length), rel=2e-4)
    assert found.centre == pytest.approx(AT)
    assert abs(found.rotation[:, 0] @ turn[:, 0]) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("sides", [(3.0, 2.0, 1.0), (1.0, 1.0, 1.0), (2.0, 2.0, 1.0), (1.0, 1.0, 4.0)])
def test_boxes(turn: np.ndarray, sides: tuple[float, ...]) -> None:
    found = likeness(turned(Manifold.cube(sides, True), turn))
    assert found.form == "box"
    assert sorted(found.sizes) == pytest.approx(sorted(sides), rel=1e-5)
    back = np.abs(np.asarray(found.rotation).T @ turn)
    assert np.sort(back.ravel())[-3:] == pytest.approx(1.0, abs=1e-5)


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("axes", [(3.0, 2.0, 1.0), (3.0, 1.0, 1.0), (1.0, 2.0, 2.0), (1.0, 1.0, 1.0)])
def test_ellipsoids(turn: np.ndarray, axes: tuple[float, ...]) -> None:
    solid = Manifold.sphere(1.0, 128).scale(axes)
    found = likeness(turned(solid, turn))
    assert found.form == "ellipsoid"
    assert found.clear
    assert sorted(found.sizes) == pytest.approx(sorted(axes), rel=2e-3)
    assert 4.0 * np.pi / 3.0 * np.prod(found.sizes) == pytest.approx(solid.volume(), rel=1e-9)


@pytest.mark.parametrize("turn", [np.eye(3), rotation(np.pi / 4, 0.0, 0.0), rotation(np.pi / 2, 0.0, 0.0)])
@pytest.mark.parametrize("sides", [(0.4, 0.9), (0.9, 0.4), (0.5, 0.5)])
def test_plates_have_their_chord_fore_and_aft(turn: np.ndarray, sides: tuple[float, float]) -> None:
    found = likeness(turned(Manifold.cube((*sides, 0.02), True), turn))
    assert found.form == "plate"
    assert found.sizes == pytest.approx(sides, rel=1e-6)
    assert found.rotation[:, 0] == pytest.approx([1, 0, 0], abs=1e-9)
    assert abs(found.rotation[:, 2] @ turn[:, 2]) == pytest.approx(1.0)


def test_a_long_swept_strut_keeps_its_own_direction() -> None:
    turn = rotation(0.0, 0.0, np.radians(40.0))
    found = likeness(turned(Manifold.cube((2.0, 0.3, 0.02), True), turn))
    assert sorted(found.sizes) == pytest.approx([0.3, 2.0], rel=1e-6)
    assert np.degrees(angles(found.rotation)) == pytest.approx([0, 0, 40], abs=1e-6)


def test_a_plate_across_x_stands_up() -> None:
    found = likeness(turned(Manifold.cube((0.02, 0.6, 0.4), True), np.eye(3)))
    assert found.form == "plate"
    assert abs(found.rotation[0, 2]) == pytest.approx(1.0)
    assert sorted(found.sizes) == pytest.approx([0.4, 0.6])


def test_a_tapered_plate_keeps_area_and_centre() -> None:
    wedge = Manifold.extrude(_slab(1.0, 0.05), 2.0, scale_top=(0.4, 1.0))
    found = likeness(wedge)
    assert found.form == "plate"
    assert found.sizes[1] == pytest.approx(2.0, rel=1e-6)
    area = 2.0 * (1.0 + 0.4) / 2.0
    assert found.sizes[0] * found.sizes[1] == pytest.approx(area, rel=1e-9)
    assert found.centre[2] == pytest.approx(2.0 / 3.0 * (1.0 + 2.0 * 0.4) / 1.4, rel=1e-9)


def _slab(chord: float, thickness: float):
    from manifold3d import CrossSection

    return CrossSection.square((chord, thickness), True)


def test_a_domed_cylinder_keeps_volume_and_length() -> None:
    """Of both cylinders that keep the volume, that of the length has the smaller misfit."""
    domed = rod(0.2, 2.0) + Manifold.sphere(0.2, 96).translate((1.0, 0.0, 0.0))
    found = likeness(domed)
    assert found.form == "cylinder"
    radius, length = found.sizes
    assert length == pytest.approx(2.2, rel=1e-9)
    assert np.pi * radius**2 * length == pytest.approx(domed.volume(), rel=1e-12)


def test_misfit_of_known_forms() -> None:
    """A cube as a cylinder of its volume and side: r = 1 / sqrt(pi), so two areas are off by 2 / sqrt(pi) - 1 of three."""
    cube = Piece.of(surface(Manifold.cube((1.0, 1.0, 1.0), True)))
    best = min(fit.misfit(cube) for fit in cylinders(cube, [np.eye(3)]))
    assert best == pytest.approx(2.0 * (2.0 / np.sqrt(np.pi) - 1.0) / 3.0, rel=1e-9)
    assert min(fit.misfit(cube) for fit in boxes(cube, [np.eye(3)])) == pytest.approx(0.0, abs=1e-12)
    half = Fit("box", (0.5, 1.0, 2.0), np.eye(3))
    assert half.misfit(cube) == pytest.approx(0.5 + (1.0 + 0.0 + 0.5) / 3.0)


def test_three_sizes_keep_volume_length_and_largest_area() -> None:
    tapered = Manifold.hull_points(np.array([[x, y, z] for x in (0, 3) for y in (0, 2 - x / 3) for z in (0, 1.0)]))
    piece = Piece.of(surface(tapered))
    for fit in (*boxes(piece, [np.eye(3)]), *ellipsoids(piece, [np.eye(3)])):
        unit = np.pi / 6.0 if fit.form == "ellipsoid" else 1.0
        assert unit * np.prod(fit.extents) == pytest.approx(piece.volume, rel=1e-12)
        assert fit.extents.max() == pytest.approx(3.0, rel=1e-12)
        assert fit.projected[2] == pytest.approx(4.5, rel=1e-12)


@pytest.mark.parametrize("thickness", [0.12, 0.18])
@pytest.mark.parametrize("taper", [1.0, 0.6])
@pytest.mark.parametrize("turn", TURNS)
def test_a_faired_tapered_plane_is_a_plate(thickness: float, taper: float, turn: np.ndarray) -> None:
    """NACA four-digit sections (Abbott & von Doenhoff 1959, equation 6.2, closed): plan area and span are kept."""
    plane = Manifold.extrude(CrossSection([naca(thickness)]), 1.2, scale_top=(taper, taper))
    found = likeness(turned(plane, turn))
    assert found.form == "plate"
    assert found.clear
    mean = (1.0 + taper) / 2.0
    assert found.sizes[0] * found.sizes[1] == pytest.approx(1.2 * mean, rel=1e-3)
    assert sorted(found.sizes) == pytest.approx(sorted((mean, 1.2)), rel=0.025)


def naca(thickness: float) -> np.ndarray:
    x = (1.0 - np.cos(np.linspace(0.0, np.pi, 60))) / 2.0
    half = 5.0 * thickness * (0.2969 * np.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    return np.vstack([np.column_stack([x, -half]), np.column_stack([x, half])[-2:0:-1]])


def test_a_thin_disc_is_a_cylinder_and_a_thin_ring_is_a_ring() -> None:
    disc = likeness(rod(1.0, 0.05, 128))
    assert (disc.form, disc.sizes) == ("cylinder", pytest.approx((1.0, 0.05), rel=1e-3))
    ring = likeness(rod(1.0, 0.05) - rod(0.7, 0.1))
    assert ring.kind == "tube"
    assert ring.sizes == pytest.approx((1.0, 0.7, 0.05), rel=5e-3)


def test_a_hull_of_revolution_with_parallel_middle_body_keeps_length_and_volume() -> None:
    """Nose of an ellipse, 45 % parallel, pointed tail: the spheroid wins over the cylinder by the stated misfit."""
    x = np.linspace(-2.0, 2.0, 400)
    radius = 0.25 * np.where(
        x > 1.2, np.sqrt(np.clip(1.0 - ((x - 1.2) / 0.8) ** 2, 0.0, 1.0)),
        np.where(x < -0.6, np.clip(1.0 - ((-0.6 - x) / 1.4) ** 2, 0.0, 1.0), 1.0),
    )  # fmt: skip
    hull = lathe(x, radius)
    found = likeness(hull)
    assert found.kind == "ellipsoid"
    assert 2.0 * found.sizes[0] == pytest.approx(4.0, rel=1e-6)
    assert found.sizes[1] == found.sizes[2]
    assert 4.0 * np.pi / 3.0 * np.prod(found.sizes) == pytest.approx(hull.volume(), rel=1e-9)


def test_a_cone_is_a_revolution() -> None:
    found = likeness(Manifold.cylinder(3.0, 1.0, 0.0, 64))
    assert found.kind == "revolution"
    assert found.built.radii == pytest.approx((0.0, 1.0), abs=2e-3)
    assert found.built.volume == pytest.approx(np.pi, rel=5e-3)


def test_a_long_box_is_a_bar_along_its_own_x() -> None:
    found = likeness(Manifold.cube((0.05, 0.04, 1.0), True))
    assert (found.kind, found.sizes) == ("bar", pytest.approx((1.0, 0.05, 0.04), rel=1e-6))
    assert np.abs(found.rotation[:, 0]) == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)
    assert np.linalg.det(found.rotation) == pytest.approx(1.0)


def test_what_resembles_nothing_says_so() -> None:
    bent = (rod(1.0, 0.5) - rod(0.7, 0.6)) ^ Manifold.cube((4.0, 4.0, 4.0), True).translate((0.0, 2.0, 0.0))
    found = likeness(bent)
    assert not found.clear
    assert found.kind == "mesh"
    assert "bounds 0.1 and 80%" in found.reason


def test_a_frame_is_no_plate() -> None:
    """All of it lies within the plate's outline, but it fills little of its hull."""
    frame = Manifold.cube((1.0, 0.6, 0.02), True) - Manifold.cube((0.8, 0.4, 0.1), True)
    found = likeness(frame)
    assert found.kind == "mesh"
    assert "of its convex hull, under 50%" in found.reason

"""Sections cut from meshes, and what they add up to, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.closed_forms.sections import section_integrals
from coeflab.bodies.mesh_sections import contours
from coeflab.bodies.stations import joints, stations
from coeflab.bodies.strips import ellipsoid_correction, strips
from coeflab.law.definiteness import definiteness

PI = np.pi
Mesh = tuple[np.ndarray, np.ndarray]


def arrays(mesh: trimesh.Trimesh) -> Mesh:
    return np.asarray(mesh.vertices, dtype=float), np.asarray(mesh.faces, dtype=np.int64)


def box(size: tuple[float, float, float], centre: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> trimesh.Trimesh:
    made = trimesh.creation.box(extents=size)
    made.apply_translation(centre)
    return made


def lying(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    """Turned from the z axis to the x axis."""
    mesh.apply_transform(trimesh.transformations.rotation_matrix(PI / 2.0, [0, 1, 0]))
    return mesh


def ball(semi_axes: tuple[float, float, float], fineness: int = 4) -> Mesh:
    made = trimesh.creation.icosphere(subdivisions=fineness)
    return np.asarray(made.vertices) * semi_axes, np.asarray(made.faces)


def test_contours_run_with_the_body_to_their_left() -> None:
    vertices, faces = arrays(lying(trimesh.creation.annulus(0.5, 1.0, 2.0, sections=64)))
    loops = contours(vertices, faces, np.array([-0.3, 0.4]))
    assert [len(c) for c in loops] == [2, 2]
    for pair in loops:
        areas = sorted(section_integrals([c]).area if a > 0 else a for c in pair for a in [signed(c)])
        assert areas == pytest.approx([-PI / 4.0, PI], rel=5e-3)


def signed(contour: np.ndarray) -> float:
    q = np.roll(contour, -1, axis=0)
    return float(np.sum(contour[:, 0] * q[:, 1] - contour[:, 1] * q[:, 0])) / 2.0


def test_stations_in_any_order_and_outside() -> None:
    vertices, faces = arrays(box((2.0, 1.0, 0.5)))
    loops = contours(vertices, faces, np.array([0.9, -3.0, -0.9, 1.5]))
    assert [len(c) for c in loops] == [1, 0, 1, 0]


def test_planes_through_vertices_are_no_special_case() -> None:
    """Every station at a ring of vertices, the ends among them."""
    vertices, faces = ball((2.0, 1.0, 1.0), 2)
    x = np.unique(np.round(vertices[:, 0], 12))
    for pair in contours(vertices, faces, x):
        assert len(pair) <= 1
    at_faces = contours(*arrays(box((2.0, 1.0, 0.5))), np.array([-1.0, 1.0]))
    assert [sum(map(signed, c)) for c in at_faces] == pytest.approx([0.5, 0.0])


def test_an_open_mesh_is_noticed() -> None:
    vertices, faces = arrays(box((2.0, 1.0, 0.5)))
    sides = np.flatnonzero(np.ptp(vertices[:, 0][faces], axis=1) > 0.0)
    with pytest.raises(ValueError, match="open"):
        contours(vertices, np.delete(faces, sides[0], axis=0), np.linspace(-0.99, 0.99, 9))


def test_volume_of_sections_is_that_of_the_mesh_where_sections_jump() -> None:
    """A box with a wider box in its middle: stations split at the flat faces, so the sum is exact."""
    made = trimesh.boolean.union([box((4.0, 1.0, 1.0)), box((0.37, 2.0, 0.5), (0.713, 0.0, 0.0))], engine="manifold")
    vertices, faces = arrays(made)
    found = strips(vertices, faces, 32)
    assert found.volume == pytest.approx(made.volume, rel=1e-12)
    x, weight = stations(joints(vertices, faces), 32)
    assert weight.sum() == pytest.approx(4.0, rel=1e-12)
    assert np.sum((x > 0.528) & (x < 0.898)) >= 4


def test_stations_split_at_the_edges_of_a_mast() -> None:
    """Its outline jumps where no face lies across x; both edges are found, and its volume comes out."""
    hull = trimesh.creation.icosphere(subdivisions=4)
    hull.vertices = hull.vertices * [2.0, 0.2, 0.2]
    mast = trimesh.creation.cylinder(0.03, 1.0, sections=64)
    mast.apply_translation([0.3, 0.0, -0.5])
    whole = trimesh.boolean.union([hull, mast], engine="manifold")
    vertices, faces = arrays(whole)
    places = joints(vertices, faces)
    for edge in (0.27, 0.33):
        assert np.min(np.abs(places - edge)) < 1e-6
    assert places[[0, -1]] == pytest.approx([-2.0, 2.0])
    coarse, fine = strips(vertices, faces, 48), strips(vertices, faces, 1000)
    assert np.diag(coarse.matrix)[1:] == pytest.approx(np.diag(fine.matrix)[1:], rel=4e-3)


def test_ellipsoid() -> None:
    """Sections of an ellipsoid are ellipses: 4 pi a c^2 / 3 in sway, a^2 / 5 of it in yaw."""
    a, b, c = 3.0, 0.6, 0.4
    vertices, faces = ball((a, b, c), 5)
    found = strips(vertices, faces, 64)
    third = 4.0 * PI * a / 3.0
    roll = PI * (b**2 - c**2) ** 2 / 8.0 * a * 16.0 / 15.0
    exact = [0.0, third * c**2, third * b**2, roll, third * b**2 * a**2 / 5.0, third * c**2 * a**2 / 5.0]
    assert np.diag(found.matrix) == pytest.approx(exact, rel=5e-3, abs=1e-12)
    assert found.ellipses > 0.85 * found.count
    assert found.volume == pytest.approx(PI * 4.0 / 3.0 * a * b * c, rel=3e-3)


def test_end_correction_makes_an_ellipsoid_exact() -> None:
    a, b, c = 3.0, 0.6, 0.4
    vertices, faces = ball((a, b, c), 5)
    found = ellipsoid_correction(a, b, c).applied(strips(vertices, faces, 64).matrix, PI * 4.0 / 3.0 * a * b * c)
    exact = np.diag(ellipsoid_added_mass(np.array([a, b, c]), 1.0))
    assert np.delete(np.diag(found), 3) == pytest.approx(np.delete(exact, 3), rel=5e-3)


def test_box_and_its_couplings() -> None:
    """A bar off the origin: m = 4.754 a^2 per length; products from the levers."""
    vertices, faces = arrays(box((4.0, 1.0, 1.0), (1.5, 0.2, -0.3)))
    m, roll = 4.754 * 0.25 * 4.0, 0.7246 * 0.0625 * 4.0
    found = strips(vertices, faces, 32)
    assert found.rectangles == found.count
    matrix = found.matrix
    assert matrix == pytest.approx(matrix.T)
    assert matrix[0] == pytest.approx(np.zeros(6))
    assert matrix[1, 1] == pytest.approx(m, rel=1e-3)
    assert matrix[1, 5] == pytest.approx(1.5 * m, rel=1e-3)
    assert matrix[2, 4] == pytest.approx(-1.5 * m, rel=1e-3)
    assert matrix[1, 3] == pytest.approx(0.3 * m, rel=1e-3)
    assert matrix[2, 3] == pytest.approx(0.2 * m, rel=1e-3)
    assert matrix[3, 3] == pytest.approx(roll + 0.13 * m, rel=1e-3)
    assert matrix[5, 5] == pytest.approx(m * (1.5**2 + 16.0 / 12.0), rel=1e-3)
    assert matrix[3, 5] == pytest.approx(1.5 * 0.3 * m, rel=1e-3)
    assert definiteness(matrix).holds


def test_a_bar_is_the_same_by_boundary_elements(monkeypatch: pytest.MonkeyPatch) -> None:
    vertices, faces = arrays(box((4.0, 1.0, 0.4), (1.5, 0.2, -0.3)))
    table = strips(vertices, faces, 16)
    monkeypatch.setattr("coeflab.bodies.strips.as_rectangle", lambda *_: None)
    found = strips(vertices, faces, 16)
    assert found.others == found.count
    assert found.matrix == pytest.approx(table.matrix, rel=2e-3, abs=1e-4)


def test_water_in_a_ring_moves_sideways_with_it() -> None:
    vertices, faces = arrays(lying(trimesh.creation.annulus(0.8, 1.0, 2.0, sections=256)))
    found = strips(vertices, faces, 16)
    assert found.trapped == pytest.approx(2.0 * PI * 0.64, rel=1e-3)
    assert found.matrix[1, 1] == pytest.approx(2.0 * PI * (1.0 + 0.64), rel=1e-3)
    assert found.volume == pytest.approx(2.0 * PI * 0.36, rel=1e-3)


def test_a_hull_within_a_ring() -> None:
    """The water between moves with both; the hull itself is not in the flow outside."""
    ring, hull = (lying(m) for m in (
        trimesh.creation.annulus(0.8, 1.0, 2.0, sections=256), trimesh.creation.cylinder(0.5, 2.0, sections=256)
    ))  # fmt: skip
    found = strips(*arrays(trimesh.util.concatenate([ring, hull])), 16)
    assert found.trapped == pytest.approx(2.0 * PI * (0.64 - 0.25), rel=2e-3)
    assert found.matrix[1, 1] == pytest.approx(2.0 * PI * (1.0 + 0.64 - 0.25), rel=2e-3)
    assert found.ellipses == found.count


def test_separate_bodies_feel_each_other() -> None:
    twin = trimesh.util.concatenate(
        [lying(trimesh.creation.cylinder(0.5, 4.0)), lying(trimesh.creation.cylinder(0.5, 4.0))]
    )
    vertices, faces = arrays(twin)
    half = len(vertices) // 2
    alone = 4.0 * PI * 0.25 * 2.0

    def apart(distance: float) -> np.ndarray:
        moved = vertices.copy()
        moved[:half, 1] += distance / 2.0
        moved[half:, 1] -= distance / 2.0
        return strips(moved, faces, 16).matrix

    assert np.diag(apart(60.0))[1:3] == pytest.approx([alone, alone], rel=0.01)
    close = apart(1.2)
    assert close[1, 1] < 0.9 * alone < close[2, 2]
    assert definiteness(close).holds


def test_too_many_contours() -> None:
    many = trimesh.util.concatenate([box((1.0, 0.1, 0.1), (0.0, 0.2 * k, 0.0)) for k in range(41)])
    with pytest.raises(ValueError, match="41 separate contours"):
        strips(*arrays(many), 16)

"""Mirror planes: moments of meshes, entries of the matrix."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.mirror_planes import SIGNS, asymmetries, vanishing
from coeflab.law.transforms import moved


def test_a_mirror_turns_velocities_as_polar_and_rates_as_axial_vectors() -> None:
    rng = np.random.default_rng(1)
    v, omega, r = rng.normal(size=(3, 3))
    for k, signs in enumerate(SIGNS):
        image = np.ones(3)
        image[k] = -1.0
        np.testing.assert_allclose(np.cross(signs[3:] * omega, image * r), image * np.cross(omega, r))
        np.testing.assert_array_equal(signs[:3] * v, image * v)


@pytest.mark.parametrize("seed", range(5))
def test_however_it_is_meshed_an_ellipsoid_has_three_planes(seed: int) -> None:
    points = np.random.default_rng(seed).normal(size=(400, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    ball = trimesh.convex.convex_hull(np.vstack([points, -points, points * [1, -1, 1], points * [-1, 1, -1]]))
    assert np.all(asymmetries(ball.vertices * [3.0, 1.0, 2.0] + 5.0, ball.faces) < 0.03)
    sphere = trimesh.creation.icosphere(2)
    assert np.all(asymmetries(sphere.vertices * [3.0, 1.0, 2.0] - 9.0, sphere.faces) < 1e-9)


def test_a_cone_has_two_planes_and_a_sail_leaves_one() -> None:
    cone = trimesh.creation.cone(1.0, 3.0, sections=64)
    x, y, z = asymmetries(cone.vertices, cone.faces)
    assert max(x, y) < 1e-9
    assert z > 0.1
    hull = trimesh.creation.box((6.0, 1.0, 1.0))
    sail = trimesh.creation.box((1.0, 0.2, 1.0), transform=trimesh.transformations.translation_matrix((0, 0, -1.0)))
    both = trimesh.util.concatenate([hull, sail])
    x, y, z = asymmetries(both.vertices, both.faces)
    assert max(x, y) < 1e-9
    assert z > 0.05


def test_third_moments_are_exact() -> None:
    """A right tetrahedron: mean of (x - 1/4)^3 over it is 1/160, its second moment 3/80."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    skewness = (1.0 / 160.0) / (3.0 / 80.0) ** 1.5
    assert asymmetries(corners, faces)[0] == pytest.approx(skewness, rel=1e-9)


def test_entries_vanish_about_points_on_the_plane() -> None:
    matrix = ellipsoid_added_mass(np.array([3.0, 1.0, 0.5]), 1000.0)
    size = np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))
    all_three = vanishing((True, True, True))
    assert np.all(all_three == ~np.eye(6, dtype=bool))
    assert np.max(np.abs(matrix[all_three] / size[all_three])) < 1e-12
    ahead = moved(matrix, np.array([0.7, 0.0, 0.2]))
    only_y = vanishing((False, True, False))
    assert np.max(np.abs(ahead[only_y])) < 1e-9
    assert np.all(np.abs(ahead[~only_y & (np.abs(ahead) > 1e-9)]) > 0.0)
    assert ahead[0, 4] != 0.0
    assert not only_y[0, 4]

"""Decimation: closed, near, well shaped; edges, holes and shells stay."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from coeflab.bodies.mesh.decimation import decimated, is_closed
from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.structured_surface import box_surface, revolved, rings
from coeflab.core.types import Faces

Surface = tuple[np.ndarray, Faces]


def sphere(panels: int) -> Surface:
    angle = np.linspace(np.pi, 0.0, 2001)
    radius = np.sin(angle)
    radius[[0, -1]] = 0.0
    return revolved(*rings(np.cos(angle), radius, panels))


def torus(large: float, small: float, count: int) -> Surface:
    i, j = np.meshgrid(np.arange(3 * count), np.arange(count), indexing="ij")
    u, v = 2.0 * np.pi * i / (3 * count), 2.0 * np.pi * j / count
    reach = large + small * np.cos(v)
    vertices = np.stack([reach * np.cos(u), reach * np.sin(u), small * np.sin(v)], axis=-1).reshape(-1, 3)
    at = lambda a, b: (a % (3 * count)) * count + b % count  # noqa: E731
    quads = np.stack([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], axis=-1).reshape(-1, 4)
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def worst_aspect(vertices: np.ndarray, faces: Faces) -> float:
    """Longest side squared over area, 1 for an equilateral triangle."""
    corner = vertices[faces]
    sides = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2)
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1) / 2.0
    return float(np.max(sides.max(axis=1) ** 2 * np.sqrt(3.0) / 4.0 / area))


def euler(faces: Faces) -> int:
    return int(faces.max()) + 1 - len(faces) // 2


@pytest.mark.parametrize("target", [300, 1000])
def test_sphere(target: int) -> None:
    fine = sphere(4000)
    vertices, faces = decimated(*fine, target)
    assert is_closed(faces)
    assert target - 2 <= len(faces) <= target
    assert euler(faces) == 2
    assert worst_aspect(vertices, faces) < 8.0
    assert np.max(np.abs(np.linalg.norm(vertices, axis=1) - 1.0)) < 15.0 / target
    inscribed = mesh_integrals(*sphere(target)).volume
    assert abs(mesh_integrals(vertices, faces).volume - 4.0 / 3.0 * np.pi) < 4.0 / 3.0 * np.pi - inscribed


@pytest.mark.slow
@pytest.mark.parametrize(("long", "target"), [(6.0, 1500), (6.0, 375), (12.0, 1500)])
def test_a_scaled_sphere_is_thinned_like_a_sphere(long: float, target: int) -> None:
    """All triangles are stretched alike; no more volume goes than equilateral facets with corners on the surface would lack.

    Such a triangle of area A lacks A^2 k / (2 sqrt 3) where the surface has the normal curvature k in the mean.
    """
    vertices, faces = sphere(20_000)
    stretched = vertices * np.array([long, 1.0, 1.0])
    whole = mesh_integrals(stretched, faces).volume
    found = decimated(stretched, faces, target)
    assert target - 2 <= len(found[1]) <= target
    assert is_closed(found[1])
    corner = found[0][found[1]]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1) / 2.0
    middle = corner.mean(axis=1) / np.array([long**2, 1.0, 1.0])
    curvature = 1.0 / (long**2 * np.sum(middle**2, axis=1) ** 2)
    inscribed = float(np.sum(area**2 * np.sqrt(curvature))) / (2.0 * np.sqrt(3.0))
    assert abs(whole - mesh_integrals(*found).volume) < inscribed


def test_box_keeps_its_edges() -> None:
    sides = np.array([2.0, 1.0, 0.1])
    vertices, faces = decimated(*box_surface(sides, 3000), 400)
    assert is_closed(faces)
    assert len(faces) <= 400
    whole = mesh_integrals(vertices, faces)
    assert whole.volume == pytest.approx(0.2, rel=1e-3)
    assert np.ptp(vertices, axis=0) == pytest.approx(sides, rel=1e-3)


def test_hole_of_a_torus_stays() -> None:
    vertices, faces = decimated(*torus(1.0, 0.3, 24), 500)
    assert is_closed(faces)
    assert euler(faces) == 0
    assert mesh_integrals(vertices, faces).volume == pytest.approx(2.0 * np.pi**2 * 0.09, rel=0.03)


def test_shells_stay_apart() -> None:
    (vertices, faces), (others, more) = sphere(1500), sphere(1500)
    both = np.concatenate([vertices, others + np.array([5.0, 0.0, 0.0])]), np.concatenate([faces, more + len(vertices)])
    found = decimated(*both, 600)
    assert is_closed(found[1])
    assert euler(found[1]) == 4
    assert mesh_integrals(*found).centre == pytest.approx([2.5, 0.0, 0.0], abs=0.01)


def test_nothing_left_to_collapse() -> None:
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    found = decimated(corners, faces, 2)
    assert len(found[1]) == 4
    assert np.allclose(found[0], corners)


def test_same_again_and_anywhere() -> None:
    fine = sphere(1500)
    one, other = decimated(*fine, 500), decimated(*fine, 500)
    assert one[0].tobytes() == other[0].tobytes()
    assert one[1].tobytes() == other[1].tobytes()
    far = decimated(fine[0] + np.array([100.0, 0.0, -50.0]), fine[1], 500)
    assert mesh_integrals(*far).volume == pytest.approx(mesh_integrals(*one).volume, rel=1e-2)


@pytest.mark.parametrize("noise", [1e-16, 1e-14])
@pytest.mark.parametrize("seed", [5, 6, 7])
def test_rounding_does_not_choose(noise: float, seed: int) -> None:
    """Costs of a structured mesh are equal in rows; another machine's last digit must not make another mesh of it."""
    vertices, faces = sphere(3000)
    stretched = vertices * np.array([6.0, 1.0, 1.0])
    shaken = stretched * (1.0 + noise * np.random.default_rng(seed).standard_normal(stretched.shape))
    one, other = decimated(stretched, faces, 700), decimated(shaken, faces, 700)
    assert one[1].tobytes() == other[1].tobytes()
    assert other[0] == pytest.approx(one[0], abs=1e-10)


def test_the_order_of_the_list_does_not_choose() -> None:
    vertices, faces = sphere(2000)
    place = np.random.default_rng(3).permutation(len(vertices))
    vertices = vertices * np.array([3.0, 1.0, 0.7])
    other = np.empty_like(vertices)
    other[place] = vertices
    one, again = decimated(vertices, faces, 500), decimated(other, place[faces][::-1], 500)
    assert np.sort(again[0], axis=0) == pytest.approx(np.sort(one[0], axis=0), abs=1e-9)


@pytest.mark.parametrize("around", [100, 256])
def test_needles_are_not_turned_over(around: int) -> None:
    """A disc-ended prism whose caps are one needle a facet; every remaining face of a cap still looks outward."""
    angle = 2.0 * np.pi * np.arange(around) / around
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    levels = np.linspace(0.0, 1.0, 6)
    vertices = np.concatenate([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], *(np.insert(ring, 0, x, axis=1) for x in levels)])
    i, j = np.arange(around), (np.arange(around) + 1) % around
    at = [2 + k * around for k in range(6)]
    sides = [
        np.concatenate([np.stack([a + i, b + j, b + i], axis=1), np.stack([a + i, a + j, b + j], axis=1)])
        for a, b in pairwise(at)
    ]
    caps = [np.stack([0 * i, at[0] + j, at[0] + i], axis=1), np.stack([0 * i + 1, at[-1] + i, at[-1] + j], axis=1)]
    faces = np.concatenate([*sides, *caps])
    assert is_closed(faces)
    found, fewer = decimated(vertices, faces, 300)
    corner = found[fewer]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]) / 2.0
    outward = corner.mean(axis=1)[:, 0] - 0.5
    on_cap = np.ptp(corner[:, :, 0], axis=1) < 0.02
    assert np.all(normal[on_cap, 0] * outward[on_cap] > 0.0)
    assert np.sum(np.abs(normal[:, 0])) == pytest.approx(2.0 * np.pi, rel=0.02)


def test_what_is_closed() -> None:
    _, faces = sphere(300)
    assert is_closed(faces)
    assert not is_closed(faces[1:])
    assert not is_closed(np.concatenate([faces[:1, ::-1], faces[1:]]))
    assert not is_closed(np.concatenate([faces, faces[:1]]))

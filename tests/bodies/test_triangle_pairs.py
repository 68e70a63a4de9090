"""Faces that cross: planted, and counted against every pair of faces tried one by one."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from coeflab.bodies.mesh import crossing_faces as crossing
from coeflab.bodies.mesh.crossing_faces import crossing_faces


def ball(shift: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> tuple[np.ndarray, np.ndarray]:
    made = trimesh.creation.icosphere(subdivisions=2)
    return np.asarray(made.vertices) + shift, np.asarray(made.faces)


def both(shift: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    (v, f), (w, g) = ball(), ball(shift)
    return np.vstack([v, w]), np.vstack([f, g + len(v)])


def crossed(one: np.ndarray, two: np.ndarray) -> bool:
    """Whether a side of one triangle meets the inside of the other, by solving for the point."""
    for a, b in ((one, two), (two, one)):
        for k in range(3):
            start, way = a[k], a[(k + 1) % 3] - a[k]
            system = np.column_stack([b[1] - b[0], b[2] - b[0], -way])
            if abs(np.linalg.det(system)) < 1e-12:
                continue
            u, v, t = np.linalg.solve(system, start - b[0])
            if u > 0.0 and v > 0.0 and u + v < 1.0 and 0.0 < t < 1.0:
                return True
    return False


def test_two_balls_cross() -> None:
    vertices, faces = both((1.2, 0.1, 0.05))
    pairs = [(i, j) for i in range(320) for j in range(320, 640)]
    near = [(i, j) for i, j in pairs if np.linalg.norm(vertices[faces[i, 0]] - vertices[faces[j, 0]]) < 0.8]
    assert crossing_faces(vertices, faces) == sum(crossed(vertices[faces[i]], vertices[faces[j]]) for i, j in near) > 50


def test_apart_and_alone_they_do_not() -> None:
    assert crossing_faces(*ball()) == 0
    assert crossing_faces(*both((2.2, 0.0, 0.0))) == 0


def test_a_long_needle_through_a_plate() -> None:
    """Faces of very different size share no cell of a fine grid unless it is coarsened."""
    plate = trimesh.creation.box(extents=(10.0, 10.0, 0.1))
    needle = trimesh.creation.box(extents=(0.1, 0.1, 5.0))
    whole = trimesh.util.concatenate([plate.subdivide().subdivide(), needle])
    assert crossing_faces(np.asarray(whole.vertices), np.asarray(whole.faces)) > 0


def spiked(depth: float) -> tuple[np.ndarray, np.ndarray]:
    """A ball whose topmost vertex is pulled down along the axis, so that sides meet sides and never the inside."""
    vertices, faces = ball()
    vertices[np.argmax(vertices[:, 2])] = [0.0, 0.0, -depth]
    return vertices, faces


def test_sides_that_meet_only_sides() -> None:
    """Of a surface with planes of symmetry no side need pass through the inside of a face."""
    assert crossing_faces(*spiked(0.9)) == 0
    assert crossing_faces(*spiked(1.5)) >= 3


@pytest.mark.parametrize("seed", range(6))
def test_united_bodies_do_not_cross(seed: int) -> None:
    """Also in single precision, and with faces and sides that lie on one another."""
    at = np.random.default_rng(seed)
    made = [trimesh.creation.box(at.uniform(0.1, 1.0, 3)), trimesh.creation.icosphere(2, at.uniform(0.2, 0.6))]
    made += [trimesh.creation.cylinder(radius=0.2, height=at.uniform(0.3, 2.0), sections=31)]
    for part in made:
        part.apply_translation(np.round(at.uniform(-0.6, 0.6, 3), seed % 3))
    whole = trimesh.boolean.union(made, engine="manifold")
    for vertices in (whole.vertices, whole.vertices.astype(np.float32).astype(float)):
        assert crossing_faces(np.asarray(vertices), np.asarray(whole.faces)) == 0


def test_too_many_pairs_are_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crossing, "MOST_PAIRS", 100)
    assert crossing_faces(*ball()) is None

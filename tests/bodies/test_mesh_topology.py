"""Joining vertices, and the faults of meshes: each planted, each counted."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.mesh import topology
from coeflab.bodies.mesh.topology import Edges
from tests.bodies.test_surface_mesh import CUBE, CUBE_FACES


def test_a_cube_is_sound() -> None:
    assert topology.edges(CUBE_FACES) == Edges(0, 0, 0)
    assert topology.edges(CUBE_FACES).sound
    assert not topology.degenerate(CUBE, CUBE_FACES).any()
    assert not topology.repeated(CUBE_FACES).any()
    assert topology.shells(CUBE_FACES)[0] == 1


def test_a_soup_of_triangles_is_welded() -> None:
    soup, corners = CUBE[CUBE_FACES].reshape(-1, 3), np.arange(36).reshape(-1, 3)
    vertices, faces = topology.welded(soup, corners)
    assert vertices.shape == (8, 3)
    assert vertices[faces] == pytest.approx(soup[corners])
    assert topology.edges(faces).sound
    assert not topology.edges(corners).sound


def test_minus_zero_is_zero() -> None:
    vertices, faces = topology.welded(np.array([[0.0, 0, 0], [-0.0, 0, 0], [1, 0, 0]]), np.array([[0, 1, 2]]))
    assert len(vertices) == 2
    assert faces.tolist() == [[0, 0, 1]]


def test_unused_vertices_go() -> None:
    vertices, _ = topology.welded(np.vstack([CUBE, [[9.0, 9, 9]]]), CUBE_FACES)
    assert len(vertices) == 8


def test_near_vertices_are_joined_on_request_only() -> None:
    rng = np.random.default_rng(3)
    soup = CUBE[CUBE_FACES].reshape(-1, 3) + 1e-9 * rng.standard_normal((36, 3))
    corners = np.arange(36).reshape(-1, 3)
    assert len(topology.welded(soup, corners)[0]) == 36
    vertices, faces = topology.welded(soup, corners, within=1e-6)
    assert len(vertices) == 8
    assert topology.edges(faces).sound


def test_equal_hashes_are_not_trusted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(topology, "_mixed", lambda columns: np.zeros(len(columns), dtype=np.uint64))
    soup, corners = CUBE[CUBE_FACES].reshape(-1, 3), np.arange(36).reshape(-1, 3)
    vertices, faces = topology.welded(soup, corners)
    assert vertices[faces] == pytest.approx(soup[corners])
    assert not topology.repeated(CUBE_FACES).any()


def test_planted_faults() -> None:
    turned = CUBE_FACES.copy()
    turned[3] = turned[3, ::-1]
    assert topology.edges(CUBE_FACES[1:]) == Edges(3, 0, 0)
    assert topology.edges(np.vstack([CUBE_FACES, CUBE_FACES[:1]])) == Edges(0, 3, 0)
    assert topology.edges(turned) == Edges(0, 0, 3)
    twice = np.vstack([CUBE_FACES, CUBE_FACES[4:5, [2, 1, 0]]])
    assert np.flatnonzero(topology.repeated(twice)).tolist() == [12]
    points = np.vstack([CUBE, (CUBE[0] + CUBE[1]) / 2.0])
    assert topology.degenerate(points, np.array([[0, 1, 8], [0, 0, 1], [0, 1, 3]])).tolist() == [True, True, False]


def test_faces_are_turned_alike() -> None:
    rng = np.random.default_rng(5)
    mixed = np.where(rng.random(12)[:, None] < 0.5, CUBE_FACES, CUBE_FACES[:, ::-1])
    assert not topology.edges(mixed).sound
    found = topology.oriented(mixed)
    assert topology.edges(found).sound
    assert found[0].tolist() == mixed[0].tolist()


def test_a_moebius_strip_cannot_be_turned() -> None:
    n = 6
    strip = [[2 * k, 2 * k + 1, 2 * k + 2] for k in range(n)] + [[2 * k + 2, 2 * k + 1, 2 * k + 3] for k in range(n)]
    closing = {2 * n: 1, 2 * n + 1: 0}
    faces = np.array([[closing.get(v, v) for v in face] for face in strip])
    assert topology.oriented(faces) is None


def test_shells_and_their_volumes() -> None:
    vertices = np.vstack([CUBE, 2.0 * CUBE + [5.0, 0, 0]])
    faces = np.vstack([CUBE_FACES, CUBE_FACES[:, ::-1] + 8])
    count, shell = topology.shells(faces)
    assert count == 2
    assert shell.tolist() == [0] * 12 + [1] * 12
    volume, area = topology.shell_volumes(vertices, faces, shell)
    assert volume == pytest.approx([1.0, -8.0])
    assert area == pytest.approx([6.0, 24.0])

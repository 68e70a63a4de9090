"""Solids between arrays: splitting long edges."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.solids import divided, solid, surface
from coeflab.bodies.mesh.structured_surface import box_surface


def longest(vertices: np.ndarray, faces: np.ndarray) -> float:
    corners = vertices[faces]
    return float(np.linalg.norm(np.roll(corners, 1, axis=1) - corners, axis=2).max())


def test_long_edges_are_split_and_the_surface_stays() -> None:
    block = solid(*box_surface(np.array([20.0, 1.0, 1.0]), 100))
    vertices, faces = surface(divided(block, 0.5, 100_000))
    assert longest(vertices, faces) < 2.0 * 0.5
    assert mesh_integrals(vertices, faces).volume == pytest.approx(20.0, rel=1e-9)
    assert np.ptp(vertices, axis=0) == pytest.approx([20.0, 1.0, 1.0])


def test_no_more_faces_than_allowed() -> None:
    block = solid(*box_surface(np.array([20.0, 1.0, 1.0]), 100))
    full = divided(block, 0.1, 100_000).num_tri()
    some = divided(block, 0.1, full - 1)
    assert 100 < some.num_tri() < full
    assert divided(block, 0.1, 5).num_tri() <= block.num_tri()

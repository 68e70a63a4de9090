"""Facets of simple forms enclose their volume and look outward; silhouettes have the forms' areas."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.mesh.silhouettes import convex_outline, facets_outline, mesh_outline, polygons
from coeflab.bodies.mesh.solids import box, surface
from coeflab.law.transforms import rotation
from coeflab.report.figures.form_facets import (
    AROUND,
    box_facets,
    cylinder_facets,
    ellipsoid_facets,
    normals,
    plate_facets,
)

FORMS = [
    (cylinder_facets(0.5, 2.0), np.pi * 0.5),
    (ellipsoid_facets(np.array([3.0, 2.0, 1.0])), 8.0 * np.pi),
    (box_facets(np.array([3.0, 2.0, 1.0])), 6.0),
]


def enclosed(facets: np.ndarray) -> float:
    a, b, c, d = (facets[:, k] for k in range(4))
    return float(np.sum(np.cross(b, c) * a) + np.sum(np.cross(c, d) * a)) / 6.0


@pytest.mark.parametrize(("facets", "volume"), FORMS)
def test_volume_and_outward(facets: np.ndarray, volume: float) -> None:
    assert enclosed(facets) == pytest.approx(volume, rel=0.02)
    assert np.all(np.einsum("ij,ij->i", normals(facets), facets.mean(axis=1)) > -1e-12)


@pytest.mark.parametrize(("facets", "_"), FORMS)
@pytest.mark.parametrize("turn", [np.eye(3), rotation(0.3, -0.5, 1.0)])
def test_silhouette_by_points_and_by_facets_agree(facets: np.ndarray, _: float, turn: np.ndarray) -> None:
    view = turn[:2]
    seen = facets[normals(facets) @ turn[2] > 1e-9] @ view.T
    assert facets_outline(seen).area() == pytest.approx(convex_outline(facets.reshape(-1, 3), view).area(), rel=1e-6)


def test_plate_has_two_sides() -> None:
    facets = plate_facets(0.4, 0.9)
    assert normals(facets)[:, 2] == pytest.approx([1.0, -1.0])
    assert convex_outline(facets.reshape(-1, 3), np.eye(3)[:2]).area() == pytest.approx(0.36)
    assert AROUND % 4 == 0


def test_silhouette_of_a_mesh_with_a_hole() -> None:
    low, high = np.array([-1.0, -1.0, -0.1]), np.array([1.0, 1.0, 0.1])
    framed = box(low, high) - box(low * [0.5, 0.5, 9.0], high * [0.5, 0.5, 9.0])
    outline = mesh_outline(*surface(framed), np.eye(3)[:2])
    assert outline.area() == pytest.approx(4.0 - 1.0)
    assert len(polygons(outline)) == 2
    edge_on = mesh_outline(*surface(framed), np.eye(3)[1:])
    assert edge_on.area() == pytest.approx(2.0 * 0.2)

"""Panels from triangles, and the surfaces they must not be made of."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.mesh.integrals import mesh_integrals
from coeflab.bodies.mesh.structured_surface import box_surface
from coeflab.bodies.panel_solver.panels import (
    bisected,
    panels_of,
    sharpness,
    side_of,
    slenderness,
    slivers,
    split_in_four,
    thin_share,
    unfit_share,
    unmatched_edges,
)

TETRAHEDRON = np.array([[0.0, 0, 0], [1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def test_a_right_triangle() -> None:
    """Area 1/2, centroid at the thirds; second moments about it a^2/18 and -a^2/36 over the area."""
    found = panels_of(np.array([[[0.0, 0, 0], [1.0, 0, 0], [0, 1.0, 0]]]))
    assert found.area == pytest.approx([0.5])
    assert found.normal[0] == pytest.approx([0.0, 0.0, 1.0])
    assert found.centre[0] == pytest.approx([1 / 3, 1 / 3, 0.0])
    assert found.size[0] == pytest.approx(np.sqrt(5.0) / 3.0)
    moments = np.einsum("qi,qj->ij", found.spread[:, 0], found.spread[:, 0])
    assert moments == pytest.approx(np.array([[2.0, -1.0, 0.0], [-1.0, 2.0, 0.0], [0.0, 0.0, 0.0]]) / 36.0)


def test_edges_of_a_closed_surface_match() -> None:
    assert unmatched_edges(FACES) == 0
    assert unmatched_edges(FACES[:3]) == 3
    flipped = FACES.copy()
    flipped[0] = flipped[0, ::-1]
    assert unmatched_edges(flipped) == 3


def test_two_tetrahedra_on_one_edge_are_closed() -> None:
    """Four faces meet there, two one way and two the other."""
    assert unmatched_edges(np.concatenate([FACES, np.array([[0, 4, 1], [0, 1, 5], [0, 5, 4], [1, 4, 5]])])) == 0


def test_slivers_are_found() -> None:
    corners = np.array([[[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]], [[0.0, 0, 0], [1.0, 0, 0], [0, 1e-6, 0]]])
    assert slivers(corners).tolist() == [True, False]


def test_slenderness_is_the_ratio_of_sides() -> None:
    vertices, faces = box_surface(np.array([3.0, 2.0, 0.1]), 400)
    assert slenderness(mesh_integrals(vertices, faces).second_moments) == pytest.approx(0.05)


@pytest.mark.parametrize(("thickness", "share"), [(1.0, 0.0), (0.02, 1.0)])
def test_where_a_box_is_thinner_than_its_panels(thickness: float, share: float) -> None:
    vertices, faces = box_surface(np.array([1.0, 1.0, thickness]), 600)
    assert thin_share(panels_of(vertices[faces])) == pytest.approx(share, abs=0.1)


@pytest.mark.parametrize("divide", [split_in_four, lambda c: bisected(c, 100)])
def test_divided_triangles_cover_the_same_facets(divide) -> None:  # type: ignore[no-untyped-def]
    corners = TETRAHEDRON[FACES]
    fine = divide(corners)
    whole, parts = panels_of(corners), panels_of(fine)
    assert parts.area.sum() == pytest.approx(whole.area.sum(), rel=1e-14)
    moment = np.einsum("n,ni,nj->ij", whole.area, whole.centre, whole.normal)
    assert np.einsum("n,ni,nj->ij", parts.area, parts.centre, parts.normal) == pytest.approx(moment, abs=1e-14)


def test_bisection_makes_slivers_compact() -> None:
    long = np.array([[[0.0, 0, 0], [100.0, 0, 0], [0, 1.0, 0]]])
    found = bisected(long, 300)
    assert 300 <= len(found) < 400
    assert panels_of(found).size.max() < 2.5


def test_the_side_of_equilateral_triangles() -> None:
    assert side_of(np.sqrt(3.0), 4) == pytest.approx(1.0)


def test_needles_and_giants_are_unfit() -> None:
    vertices, faces = box_surface(np.array([1.0, 1.0, 1.0]), 600)
    corners = vertices[faces]
    assert unfit_share(corners) == 0.0
    assert unfit_share(corners * [1.0, 1.0, 20.0]) == pytest.approx(80.0 / 82.0, rel=0.01)
    giant = 20.0 * corners[:1]
    own = panels_of(np.concatenate([corners, giant])).area
    assert unfit_share(np.concatenate([corners, giant])) == pytest.approx(own[-1] / own.sum())


def test_sharp_edges_over_the_root_of_the_area() -> None:
    cube = box_surface(np.array([2.0, 2.0, 2.0]), 300)
    assert sharpness(*cube) == pytest.approx(12.0 / np.sqrt(6.0))
    angle = np.arange(12) * np.pi / 6.0
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    vertices = np.concatenate([np.insert(ring, 2, z, axis=1) for z in (0.0, 4.0)] + [[[0.0, 0, 0], [0.0, 0, 4]]])
    k, n = np.arange(12), (np.arange(12) + 1) % 12
    quads = np.concatenate([np.stack(t, axis=1) for t in ((k, n, n + 12), (k, n + 12, k + 12))])
    ends = np.concatenate([np.stack(t, axis=1) for t in ((n, k, 0 * k + 24), (k + 12, n + 12, 0 * k + 25))])
    side = 2.0 * np.sin(np.pi / 12.0)
    area = 12.0 * (4.0 * side + np.sin(np.pi / 6.0))
    assert sharpness(vertices, np.concatenate([quads, ends])) == pytest.approx(24.0 * side / np.sqrt(area))

"""Families of meshes: steps of four, one surface."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.mesh import family as mesh_family
from coeflab.bodies.mesh.family import family
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.mesh.structured_surface import box_surface
from coeflab.bodies.panel_solver.panels import panels_of, unfit_share
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Form, Part, Parts


def one(form: Form) -> Parts:
    return Parts((Part("p", form, np.zeros(3), np.eye(3)),))


def volume(corners: np.ndarray) -> float:
    panels = panels_of(corners)
    return float(np.einsum("n,ni,ni->", panels.area, panels.centre, panels.normal) / 3.0)


@pytest.mark.parametrize(
    "form", [Ellipsoid(1.0, 1.0, 1.0), Ellipsoid(3.0, 1.0, 0.5), Cylinder(0.5, 4.0), Box(2.0, 1.0, 1.0)]
)
def test_each_mesh_has_about_a_quarter_of_the_one_before(form: Form) -> None:
    found = family(one(form), 6000)
    counts = np.array([len(c) for c in found])
    assert len(counts) == 3
    assert 3600 <= counts[0] <= 6600
    assert counts[:-1] / counts[1:] == pytest.approx([4.0, 4.0], rel=0.15)
    errors = [1.0 - volume(c) / form.volume for c in found]
    if not isinstance(form, Box):
        assert errors[0] < errors[1] < errors[2]


def test_the_finest_alone_is_what_was_asked_for() -> None:
    (found,) = family(one(Ellipsoid(3.0, 1.0, 1.0)), 5000, most=1)
    assert len(found) == len(meshed(one(Ellipsoid(3.0, 1.0, 1.0)), 5000).faces)


def test_a_coarse_mesh_is_divided_into_similar_ones() -> None:
    mesh = TriangleMesh(*box_surface(np.array([2.0, 1.0, 0.5]), 64))
    found = family(mesh, 4000)
    assert [len(found[0]) / len(c) for c in found] == [1.0, 4.0, 16.0]
    assert 4000 <= len(found[0]) < 8000
    assert [volume(c) for c in found] == pytest.approx([1.0, 1.0, 1.0], rel=1e-12)


@pytest.mark.parametrize("panels", [3200, 1600])
def test_a_fine_mesh_is_decimated(panels: int) -> None:
    """3,200: as it is, then coarser; 1,600: coarser at once."""
    ball = meshed(one(Ellipsoid(1.0, 0.8, 0.8)), 3000)
    found = family(TriangleMesh(ball.vertices, ball.faces), panels)
    assert len(found) >= 2
    assert len(found[0]) == (len(ball.faces) if panels == 3200 else pytest.approx(1600, rel=0.05))
    assert len(found[1]) < len(found[0]) / 2
    assert volume(found[1]) == pytest.approx(ball.volume, rel=0.03)


@pytest.mark.parametrize("times", [2, 3, 6])
def test_a_mesh_is_refined_to_the_panels_asked_for(times: int) -> None:
    """Also between its own facets and four times as many, which facets as they are used to stand for."""
    ball = meshed(one(Ellipsoid(1.0, 0.8, 0.8)), 1500)
    panels = times * len(ball.faces)
    found = family(TriangleMesh(ball.vertices, ball.faces), panels)
    assert 0.6 * panels <= len(found[0]) <= 1.1 * panels
    assert volume(found[0]) == pytest.approx(ball.volume, rel=1e-3)


def rod(sections: int, length: float) -> TriangleMesh:
    """A flat-ended cylinder of unit diameter as CAD writes it: one facet from end to end."""
    angle = np.arange(sections) * 2.0 * np.pi / sections
    ring = np.column_stack([np.zeros(sections), np.cos(angle), np.sin(angle)]) / 2.0
    ends = np.array([[0.0, 0, 0], [length, 0, 0]])
    k, n, c = np.arange(sections), (np.arange(sections) + 1) % sections, 2 * sections
    rows = (
        (k, n, n + sections),
        (k, n + sections, k + sections),
        (n, k, 0 * k + c),
        (k + sections, n + sections, 0 * k + c + 1),
    )
    vertices = np.concatenate([ring, ring + ends[1], ends])
    return TriangleMesh(vertices, np.concatenate([np.stack(r, axis=1) for r in rows]))


@pytest.mark.slow
@pytest.mark.parametrize("sections", [48, 600])
def test_long_facets_of_cad_become_compact(sections: int) -> None:
    mesh = rod(sections, 8.0)
    assert unfit_share(mesh.vertices[mesh.faces]) > 0.9
    found = family(mesh, 4000)
    assert [len(c) for c in found] == pytest.approx([4000, 1000, 250], rel=0.02)
    assert max(unfit_share(c) for c in found) < 0.2
    assert [volume(c) / mesh.volume for c in found] == pytest.approx([1.0, 1.0, 1.0], abs=0.05)
    assert volume(found[0]) == pytest.approx(mesh.volume, rel=5e-3)


def test_a_surface_that_is_no_solid_keeps_its_facets() -> None:
    """Two cubes that share an edge: four faces meet there."""
    one_cube = TriangleMesh(*box_surface(np.ones(3), 12))
    other = one_cube.vertices + np.array([1.0, 1.0, 0.0])
    places, joined = np.unique(np.concatenate([one_cube.vertices, other]).round(9), axis=0, return_inverse=True)
    faces = joined.reshape(-1)[np.concatenate([one_cube.faces, one_cube.faces + len(other)])]
    found = family(TriangleMesh(places, faces), 2000)
    assert [len(found[0]) / len(c) for c in found] == [1.0, 4.0, 16.0]


def test_where_no_coarser_mesh_can_be_made_there_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mesh_family, "LEAST_STEP", 1e9)
    assert len(family(one(Ellipsoid(1.0, 1.0, 1.0)), 2000)) == 1

"""Facets of surfaces whose volume is known."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.mesh.facet_volume import enclosed, facet_deficit
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.mesh.structured_surface import box_surface
from coeflab.bodies.shape import Cylinder, Ellipsoid, Form, Part, Parts
from tests.bodies.test_mesh_family import rod


@pytest.mark.parametrize("sections", [16, 64, 256])
def test_a_prism_in_a_cylinder(sections: int) -> None:
    """1 - sin(t) / t of the cylinder, t = 2 pi / n; t^2 / 6 to third order."""
    mesh = rod(sections, 5.0)
    angle = 2.0 * np.pi / sections
    whole = 5.0 * np.pi / 4.0
    assert enclosed(mesh.vertices[mesh.faces]) == pytest.approx(whole * np.sin(angle) / angle, rel=1e-12)
    assert facet_deficit(mesh.vertices, mesh.faces) == pytest.approx(whole - mesh.volume, rel=0.06 * angle**2 + 1e-9)


@pytest.mark.parametrize(
    "form", [Ellipsoid(1.0, 1.0, 1.0), Ellipsoid(6.0, 1.0, 1.0), Ellipsoid(3.0, 2.0, 1.0), Cylinder(0.5, 5.0)]
)
@pytest.mark.parametrize("scale", [1e-3, 1.0])
def test_facets_inscribed_in_a_form(form: Form, scale: float) -> None:
    mesh = meshed(Parts((Part("p", form, np.zeros(3), np.eye(3)),)), 8000)
    found = facet_deficit(scale * mesh.vertices + 7.0, mesh.faces) / scale**3
    assert found == pytest.approx(form.volume - mesh.volume, rel=0.02)


def test_edges_are_no_facets() -> None:
    """A box is what its faces enclose."""
    vertices, faces = box_surface(np.array([1.0, 2.0, 3.0]), 500)
    assert facet_deficit(vertices, faces) == pytest.approx(0.0, abs=1e-15)
    assert enclosed(vertices[faces]) == pytest.approx(6.0)


def test_a_hollow_counts_against() -> None:
    mesh = meshed(Parts((Part("p", Ellipsoid(1.0, 1.0, 1.0), np.zeros(3), np.eye(3)),)), 2000)
    outward, inward = (facet_deficit(mesh.vertices, f) for f in (mesh.faces, mesh.faces[:, ::-1]))
    assert inward == pytest.approx(-outward, rel=1e-12)


def test_edges_of_one_or_three_faces_are_left_out() -> None:
    mesh = meshed(Parts((Part("p", Ellipsoid(1.0, 1.0, 1.0), np.zeros(3), np.eye(3)),)), 300)
    more = np.concatenate([mesh.faces, mesh.faces[:1]])
    assert 0.0 < facet_deficit(mesh.vertices, more) < facet_deficit(mesh.vertices, mesh.faces)
    assert 0.0 < facet_deficit(mesh.vertices, mesh.faces[1:]) < facet_deficit(mesh.vertices, mesh.faces)

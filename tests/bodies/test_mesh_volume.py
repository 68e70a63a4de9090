"""What the volume of panels lacks, and that twice its share covers an added mass."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.bodies.body import Body
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.meshing import meshed
from coeflab.bodies.panel_solver.volume_gap import STRONGEST, volume_gap
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Ellipsoid, Part, Parts, Shape
from coeflab.core.files import shipped

BALL = Parts((Part("p", Ellipsoid(1.0, 1.0, 1.0), np.zeros(3), np.eye(3)),))
VOLUME = 4.0 * np.pi / 3.0


def body(shape: Shape, *volumes: float) -> Body:
    hull = read_body(shipped("geometry") / "spheroid_example" / "body.toml")
    first = hull.configurations[0]
    printed = [replace(first, name=f"printed_{k}", volume=v) for k, v in enumerate(volumes)]
    own = replace(first, name="by_mesh", volume=getattr(shape, "volume", None))
    return replace(hull, shape=shape, configurations=(own, *printed))


def corners(mesh: TriangleMesh) -> np.ndarray:
    return np.asarray(mesh.vertices[mesh.faces])


def test_what_equations_know_is_extrapolated_away() -> None:
    fine, coarse = meshed(BALL, 4000), meshed(BALL, 1000)
    found = volume_gap(body(BALL), fine, [corners(fine), corners(coarse)])
    assert found.finest == pytest.approx(fine.volume / VOLUME - 1.0, rel=1e-9)
    assert abs(found.left) < 0.05 * abs(found.finest)
    assert np.diag(found.cost(np.eye(6))) == pytest.approx(2.0 * abs(found.left))
    assert "the body's by its equations" in found.summary


def test_one_mesh_lacks_what_it_lacks() -> None:
    fine = meshed(BALL, 4000)
    found = volume_gap(body(BALL), fine, [corners(fine)])
    assert found.left == found.finest
    assert found.cost(np.diag([4.0, 1.0, 1.0, 1.0, 1.0, 1.0]))[0, 1] == pytest.approx(2.0 * STRONGEST * -found.finest)
    assert "volume of the finest panels" in found.summary
    assert "estimate" not in found.summary
    assert "extrapolated" not in found.summary


def test_facets_alone_are_judged_by_their_angles() -> None:
    ball = meshed(BALL, 1000)
    mesh = TriangleMesh(ball.vertices, ball.faces)
    found = volume_gap(body(mesh), mesh, [corners(mesh)])
    assert found.left == pytest.approx(mesh.volume / VOLUME - 1.0, rel=0.05)
    assert "estimated by the angles" in found.summary


def test_a_stated_volume_goes_before_the_angles() -> None:
    """The nearest within 5 %; one farther off is of another configuration."""
    mesh = TriangleMesh(meshed(BALL, 4000).vertices, meshed(BALL, 4000).faces)
    found = volume_gap(body(mesh, 1.5 * mesh.volume, 1.02 * mesh.volume), mesh, [corners(mesh)])
    assert found.left == pytest.approx(1.0 / 1.02 - 1.0)
    assert "that of printed_1" in found.summary
    assert "estimated" in volume_gap(body(mesh, 1.5 * mesh.volume), mesh, [corners(mesh)]).summary


@pytest.mark.parametrize("slender", [1.0, 1.5, 3.0, 6.0, 12.0])
def test_twice_the_volume_covers_lambs_derivative(slender: float) -> None:
    """Too thin all over, the entries of translation; too small all over, all entries."""
    axes, less = np.array([slender, 1.0, 1.0]), 1e-4
    whole = np.diag(ellipsoid_added_mass(axes, 1.0))
    thin = np.diag(ellipsoid_added_mass(axes * [1.0, np.sqrt(1.0 - less), np.sqrt(1.0 - less)], 1.0))
    small = np.diag(ellipsoid_added_mass(axes * np.cbrt(1.0 - less), 1.0))
    assert np.all(whole[:3] - thin[:3] <= STRONGEST * less * whole[:3])
    assert np.all(whole - small <= STRONGEST * less * whole + 1e-15)

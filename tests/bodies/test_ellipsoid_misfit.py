"""Misfit of an equivalent ellipsoid: boxes by hand, ellipsoids that have none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from coeflab.bodies.added_mass import ellipsoid
from coeflab.bodies.ellipsoid_misfit import EllipsoidMisfit, ellipsoid_misfit
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Box, Cylinder, Ellipsoid, Part, Parts, Plate, Shape, as_revolution
from coeflab.core.files import shipped
from coeflab.law.transforms import rotation

SIDES = st.floats(0.05, 5.0)


def one(form: Box | Ellipsoid | Cylinder | Plate, turn: np.ndarray | None = None) -> Parts:
    return Parts((Part("p", form, np.array([1.0, 2.0, 3.0]), np.eye(3) if turn is None else turn),))


def equivalent(shape: Shape) -> EllipsoidMisfit:
    return ellipsoid_misfit(shape, ellipsoid._axes(shape))


def meshed_box(sides: tuple[float, float, float]) -> TriangleMesh:
    made = trimesh.creation.box(extents=sides)
    return TriangleMesh(np.asarray(made.vertices), np.asarray(made.faces))


@given(SIDES, SIDES, SIDES)
def test_of_a_box_by_hand(x: float, y: float, z: float) -> None:
    """b c = 3 y z / (2 pi) with b : c = y : z, whatever the sides; a part and its mesh say the same."""
    side = np.pi / 2.0 * np.sqrt(1.5 / np.pi) - 1.0
    for shape in (one(Box(x, y, z)), meshed_box((x, y, z))):
        found = equivalent(shape)
        assert found.areas == pytest.approx([0.5, side, side], rel=1e-6)
        assert np.diag(found.spread) == pytest.approx([-0.4, 3.6 / np.pi - 1.0, 3.6 / np.pi - 1.0], rel=1e-6)
        assert found.rough


@given(SIDES, SIDES, SIDES)
def test_ellipsoids_have_none(x: float, y: float, z: float) -> None:
    found = equivalent(one(Ellipsoid(x, y, z)))
    assert np.max(np.abs(found.areas)) < 1e-12
    assert np.max(np.abs(found.spread)) < 1e-12
    assert not found.rough


def test_a_spheroid_as_a_body_of_revolution_has_none() -> None:
    shape = as_revolution(one(Ellipsoid(3.0, 0.5, 0.5)))
    assert shape is not None
    found = equivalent(shape)
    assert np.max(np.abs(found.areas)) < 2e-3  # the largest of 64 radii
    assert np.max(np.abs(found.spread)) < 1e-10


def test_a_cylinder_is_the_same_as_parts_and_by_its_meridian() -> None:
    part = one(Cylinder(0.5, 4.0))
    whole = as_revolution(part)
    assert whole is not None
    a, b = equivalent(part), equivalent(whole)
    assert a.areas == pytest.approx([0.5, a.areas[1], a.areas[1]], rel=1e-12)
    assert b.areas == pytest.approx(a.areas, rel=1e-9)
    assert b.spread == pytest.approx(a.spread, abs=1e-9)


def test_a_body_askew_is_told() -> None:
    """Yawed by 30 deg: the products of the box stand beside axes that have none."""
    found = equivalent(one(Box(2.0, 0.4, 0.3), rotation(0.0, 0.0, np.radians(30.0))))
    along, across = 4.0 / 12.0, 0.16 / 12.0
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    product = c * s * (along - across)
    size = np.sqrt((c * c * along + s * s * across) * (s * s * along + c * c * across))
    assert abs(found.spread[0, 1]) == pytest.approx(product / size, rel=1e-12)
    assert "skewed to the axes by" in str(found)


@pytest.mark.parametrize(("gap", "rough"), [(0.1, False), (0.1001, True), (-0.1001, True)])
def test_the_bound(gap: float, rough: bool) -> None:
    off = np.zeros((3, 3))
    off[1, 1] = gap
    assert EllipsoidMisfit(np.zeros(3), off).rough is rough
    assert EllipsoidMisfit(np.array([0.0, 0.0, gap]), np.zeros((3, 3))).rough is rough


def test_the_method_tells_it() -> None:
    """SUBOFF is blunter than an ellipsoid, the spheroid is one."""
    folder: Path = shipped("geometry")
    blunt = ellipsoid.added_mass(read_body(folder / "suboff_bare_hull" / "body.toml"), 1000.0)
    assert blunt.rough
    assert blunt.statements[1].endswith("over 10%: a rough guide")
    exact = ellipsoid.added_mass(read_body(folder / "spheroid_example" / "body.toml"), 1000.0)
    assert not exact.rough
    assert len(exact.statements) == 1

"""Outlines: what semi-empirical methods see of bodies by equations and of parts."""

from __future__ import annotations

import numpy as np
import pytest

from coeflab.bodies.forms import Bar, Box, Cylinder, Ellipsoid, Finned, Plate, Tube, Turned
from coeflab.bodies.outline import Foil, Outline
from coeflab.bodies.outlining import of_parts
from coeflab.bodies.profiles import FOOT
from coeflab.bodies.readers import read_body
from coeflab.bodies.shape import Part, Parts
from coeflab.core.files import shipped

LBP, REFERENCE = 13.9792, -6.6042  # ft


def outline(name: str) -> Outline:
    found = read_body(shipped("geometry") / name / "body.toml").outline
    assert found is not None
    return found


def foil(of: Outline, name: str) -> Foil:
    return next(f for f in of.foils if f.name == name)


@pytest.fixture(scope="module")
def aff8() -> Outline:
    return outline("suboff_aff8")


def test_hull_of_suboff_integrates_to_its_particulars(aff8: Outline) -> None:
    """Volume and wetted surface of the bare hull by its sections; body and outline say the same of the whole."""
    bare = read_body(shipped("geometry") / "suboff_bare_hull" / "body.toml")
    by_equations = bare.require("by_equations")
    hull = outline("suboff_bare_hull").hulls[0]
    assert hull.round_sections
    assert -np.trapezoid(hull.area, hull.x) == pytest.approx(by_equations.volume, rel=5e-4)
    slant = np.hypot(np.diff(hull.x), np.diff(hull.breadth) / 2.0)
    assert slant @ (hull.girth[1:] + hull.girth[:-1]) / 2.0 == pytest.approx(by_equations.wetted_surface, rel=5e-4)
    whole = read_body(shipped("geometry") / "suboff_aff8" / "body.toml").require("by_equations")
    assert (aff8.volume, aff8.wetted_surface) == (whole.volume, whole.wetted_surface)


def test_sail_of_suboff(aff8: Outline) -> None:
    """By hand: chord 1.208 ft, height .729 ft on r = .833 ft, area .86 ft^2, arm x' = +.234."""
    sail = foil(aff8, "sail")
    assert sail.root_chord / FOOT == pytest.approx(1.2083, abs=1e-3)
    assert sail.span / FOOT == pytest.approx(0.7292, abs=1e-3)
    assert sail.area / FOOT**2 == pytest.approx(0.867, abs=2e-3)
    assert (sail.root[0] / FOOT - REFERENCE) / LBP == pytest.approx(0.234, abs=1e-3)
    assert sail.root[2] / FOOT == pytest.approx(-5.0 / 6.0, abs=1e-6)
    assert sail.thickness == pytest.approx(0.181, abs=1e-3)
    assert not sail.control


def test_planes_of_suboff(aff8: Outline) -> None:
    """By hand, the root taken where the trailing edge leaves the hull: span .483 ft, .297 ft^2; at the mean foot less."""
    upper = foil(aff8, "plane_upper")
    assert upper.tip[2] / FOOT == pytest.approx(-5.0 / 6.0, abs=1e-9)
    assert -upper.root[2] / FOOT == pytest.approx(0.390, abs=3e-3)
    assert upper.area / FOOT**2 == pytest.approx(0.2695, abs=1e-3)
    assert upper.tip_chord / FOOT == pytest.approx(0.5, abs=3e-3)
    assert (upper.root[0] / FOOT - REFERENCE) / LBP == pytest.approx(-0.437, abs=8e-3)
    assert upper.thickness == pytest.approx(0.2, abs=1e-3)


def test_what_turns_the_planes(aff8: Outline) -> None:
    """A positive dr turns both rudders right-handed about +z, a positive ds both stern planes about +y."""
    said = {f.name: (f.control, f.sign) for f in aff8.foils if f.control}
    assert said == {
        "plane_upper": ("dr", -1.0), "plane_lower": ("dr", 1.0),
        "plane_starboard": ("ds", 1.0), "plane_port": ("ds", -1.0),
    }  # fmt: skip


def test_myring_hull_with_its_flat_ends() -> None:
    found = outline("remus100")
    body = read_body(shipped("geometry") / "remus100" / "body.toml").require("by_equations")
    assert found.wetted_surface == pytest.approx(body.wetted_surface, rel=1e-6)
    assert found.hulls[0].breadth[-1] > 0.0


def test_fin_alone_is_two_halves_without_a_hull() -> None:
    found = outline("naca0020_plane")
    assert not found.hulls
    one, other = found.foils
    assert np.array_equal(one.stand, one.root[1:])
    assert one.tip[1:] == pytest.approx(-other.tip[1:])
    assert (one.control, one.sign, other.sign) == ("dr", -1.0, 1.0)


def test_plate_through_a_hull_is_two_foils_and_what_lies_across_is_bluff() -> None:
    pose = np.eye(3)
    upright = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    found = of_parts(
        Parts((
            Part("hull", Cylinder(0.1, 1.5), np.zeros(3), pose),
            Part("wings", Plate(0.1, 0.8), np.array([-0.2, 0.0, 0.0]), pose),
            Part("mast", Cylinder(0.02, 0.3), np.array([0.1, 0.0, -0.22]), upright),
            Part("float", Ellipsoid(0.3, 0.1, 0.05), np.array([0.0, 0.4, 0.0]), pose),
            Part("box", Box(0.2, 0.1, 0.1), np.array([0.0, 0.0, 0.3]), pose),
        ))
    )  # fmt: skip
    assert [hull.name for hull in found.hulls] == ["hull", "float"]
    assert found.hulls[1].breadth.max() == pytest.approx(0.2)
    assert not found.hulls[1].round_sections
    assert [(f.name, round(float(f.root[1]), 6), round(float(f.tip[1]), 6)) for f in found.foils] == [
        ("wings", 0.1, 0.4), ("wings_image", -0.1, -0.4),
    ]  # fmt: skip
    assert [(b.name, b.kind) for b in found.bluff] == [("mast", "cylinder"), ("box", "box")]
    assert found.bluff[0].areas == pytest.approx([0.012, 0.012, np.pi * 0.02**2])


def test_forms_of_simplified_meshes() -> None:
    """A profile along x is a hull, a tube a ring wing, fins alike are foils, a bar is a bluff box."""
    pose = np.eye(3)
    found = of_parts(
        Parts((
            Part("hull", Turned((-1.0, -0.5, 0.5, 1.0), (0.0, 0.2, 0.2, 0.1)), np.zeros(3), pose),
            Part("fins", Finned(0.15, 0.4, 0.2, 0.02, 4), np.array([-0.7, 0.0, 0.0]), pose),
            Part("tube", Tube(0.4, 0.38, 0.2), np.array([-0.8, 0.0, 0.0]), pose),
            Part("bar", Bar(0.1, 0.05, 0.9), np.array([0.0, 0.0, 0.6]), pose),
        ))
    )  # fmt: skip
    (hull,), (ring,), (bar,) = found.hulls, found.rings, found.bluff
    assert hull.x[[0, -1]] == pytest.approx([1.0, -1.0])
    assert hull.breadth[0] == pytest.approx(0.2)
    assert (ring.diameter, ring.chord, float(ring.centre[0])) == pytest.approx((0.78, 0.2, -0.75))
    assert [f.name for f in found.foils] == ["fins_1", "fins_2", "fins_3", "fins_4"]
    assert [f.area for f in found.foils] == pytest.approx([0.05] * 4)
    assert np.sum([f.tip for f in found.foils], axis=0)[1:] == pytest.approx([0.0, 0.0])
    assert bar.kind == "box"

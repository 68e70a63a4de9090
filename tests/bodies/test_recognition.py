"""Outlines of meshes: the same as by equations, mirrored with the body, and honest where nothing is slender."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import CrossSection, Manifold

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import surface
from coeflab.bodies.outline import Outline
from coeflab.bodies.readers import groves
from coeflab.bodies.recognition import of_mesh
from coeflab.core.errors import InputError


def meshed(solid: Manifold) -> TriangleMesh:
    return TriangleMesh(*surface(solid))


def spindle(length: float, radius: float, y: float = 0.0) -> Manifold:
    return Manifold.sphere(1.0, 48).scale((length / 2.0, radius, radius)).translate((0.0, y, 0.0))


def box(sides: tuple[float, float, float], at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Manifold:
    return Manifold.cube(sides, True).translate(at)


def frame() -> Manifold:
    """Bars along x with a short cylinder between them."""
    bars = [box((0.6, 0.02, 0.02), (0.0, y, z)) for y in (-0.2, 0.2) for z in (-0.15, 0.15)]
    across = [box((0.02, 0.42, 0.02), (x, 0.0, z)) for x in (-0.3, 0.3) for z in (-0.15, 0.15)]
    whole = box((0.02, 0.02, 0.32), (0.3, 0.2, 0.0)) + box((0.02, 0.02, 0.32), (-0.3, 0.2, 0.0))
    for bar in bars + across:
        whole += bar
    return whole + Manifold.cylinder(0.4, 0.07, 0.07, 48, True).rotate((0.0, 90.0, 0.0))


def tube(radius: float, wall: float, length: float, x: float) -> Manifold:
    flat = CrossSection.circle(radius + wall / 2.0, 64) - CrossSection.circle(radius - wall / 2.0, 64)
    return flat.extrude(length).rotate((0.0, 90.0, 0.0)).translate((x - length, 0.0, 0.0))


@pytest.fixture(scope="module")
def aff8() -> TriangleMesh:
    return groves.mesh(True, True, 8000)


@pytest.fixture(scope="module")
def cut(aff8: TriangleMesh) -> Outline:
    return of_mesh(aff8)


def test_mesh_of_aff8_gives_the_outline_of_its_equations(cut: Outline) -> None:
    """Areas and spans within 4 %, places within 0.4 % of the length, thickness within .01; hull within 1 %."""
    known = groves.outline(True, True)
    names = {"sail": "foil_upper_1", "plane_upper": "foil_upper_2", "plane_lower": "foil_lower"}
    names |= {"plane_starboard": "foil_starboard", "plane_port": "foil_port"}
    assert {f.name for f in cut.foils} == set(names.values())
    for foil in known.foils:
        found = next(f for f in cut.foils if f.name == names[foil.name])
        assert found.area == pytest.approx(foil.area, rel=0.04)
        assert found.span == pytest.approx(foil.span, rel=0.04)
        assert found.thickness == pytest.approx(foil.thickness, abs=0.01)
        assert np.abs(found.root - foil.root).max() < 0.004 * known.hulls[0].length
        assert np.abs(found.tip - foil.tip).max() < 0.004 * known.hulls[0].length
        assert np.abs(found.stand).max() < 1e-3
    hull, exact = cut.hulls[0], known.hulls[0]
    assert hull.round_sections
    assert -np.trapezoid(hull.area, hull.x) == pytest.approx(-np.trapezoid(exact.area, exact.x), rel=0.01)
    assert hull.depth.max() == pytest.approx(exact.depth.max(), rel=0.01)
    assert cut.left_out == ()


def test_mirrored_body_has_the_mirrored_outline() -> None:
    fin = box((0.2, 0.3, 0.02)).translate((0.0, 0.15, 0.0)).rotate((-30.0, 0.0, 0.0)).translate((-0.5, 0.0, 0.0))
    body = spindle(2.0, 0.12) + fin
    one, other = (of_mesh(meshed(solid)).foils[0] for solid in (body, body.mirror((0.0, 1.0, 0.0))))
    mirror = np.array([1.0, -1.0, 1.0])
    assert other.name == one.name.replace("starboard", "port")
    assert other.root == pytest.approx(one.root * mirror, abs=2e-5)
    assert other.tip == pytest.approx(one.tip * mirror, abs=2e-5)
    assert one.tip[1:] / np.hypot(*one.tip[1:]) == pytest.approx([np.cos(np.pi / 6), -np.sin(np.pi / 6)], abs=0.02)
    assert one.tip_chord == pytest.approx(0.2, rel=0.03)


@pytest.mark.slow
def test_ring_wing_and_its_struts() -> None:
    struts = box((0.06, 0.3, 0.006), (-0.8, 0.0, 0.0)) + box((0.06, 0.006, 0.3), (-0.8, 0.0, 0.0))
    found = of_mesh(meshed(spindle(2.0, 0.12) + struts + tube(0.15, 0.01, 0.1, -0.75)))
    (ring,) = found.rings
    assert (ring.diameter, ring.chord) == pytest.approx((0.3, 0.1), rel=0.03)
    assert ring.centre == pytest.approx([-0.775, 0.0, 0.0], abs=3e-3)
    assert len(found.foils) == 4
    assert found.hulls[0].breadth.max() == pytest.approx(0.24, rel=0.01)


def test_catamaran_is_two_hulls_and_says_what_joins_them() -> None:
    found = of_mesh(meshed(spindle(2.0, 0.12, -0.4) + spindle(2.0, 0.12, 0.4) + box((0.8, 0.8, 0.03))))
    assert sorted(round(float(h.centre[40, 0]), 3) for h in found.hulls) == [-0.4, 0.4]
    assert len(found.left_out) == 1
    assert "joins two hulls" in found.left_out[0]
    assert found.left_out[0].endswith(" m at y = 0, z = 0 m")
    assert not found.foils


@pytest.mark.parametrize(
    "solid",
    [
        box((0.6, 0.4, 0.3)),
        Manifold.sphere(0.3, 32) + box((1.2, 0.05, 0.05)) + box((0.05, 1.2, 0.05)),
        frame(),
    ],
    ids=["box", "sphere with arms", "frame"],
)
def test_what_is_not_slender_is_bluff_as_a_whole(solid: Manifold) -> None:
    found = of_mesh(meshed(solid))
    assert not found.hulls
    assert not found.foils
    (body,) = found.bluff
    assert (body.kind, body.name) == ("mesh", "body")
    assert body.areas[0] <= 4.0 * body.half_extents[1] * body.half_extents[2] + 1e-9
    assert found.left_out


def test_open_mesh_is_refused() -> None:
    whole = meshed(box((1.2, 0.3, 0.2)))
    with pytest.raises(InputError, match="open"):
        of_mesh(TriangleMesh(whole.vertices, whole.faces[1:]))


def test_corners_of_a_box_hull_are_no_foils() -> None:
    found = of_mesh(meshed(box((1.2, 0.3, 0.2)) + box((0.2, 0.01, 0.2), (-0.4, 0.0, -0.2))))
    assert [f.name for f in found.foils] == ["foil_upper"]
    assert found.hulls[0].area[40] == pytest.approx(0.06, rel=0.01)


def test_swept_wings_are_foils() -> None:
    """Sections aft of the root begin far from the hull: exposed area of each within 3 % of that drawn, half span within 1 %."""
    planform = [(-0.2, 0.6), (-0.3, 0.6), (-0.1, 0.0), (0.1, 0.0)]
    half = CrossSection([planform]).extrude(0.012).translate((0.0, 0.0, -0.006))
    solid = spindle(2.0, 0.11) + half + half.mirror((0.0, 1.0, 0.0))
    seen = of_mesh(meshed(solid))
    assert {f.name for f in seen.foils} == {"foil_port", "foil_starboard"}
    assert seen.bluff == ()
    for foil in seen.foils:
        chord = 0.2 + (0.1 - 0.2) * 0.11 / 0.6
        assert foil.area == pytest.approx(0.5 * (chord + 0.1) * (0.6 - 0.11), rel=0.03)
        assert abs(foil.tip[1]) == pytest.approx(0.6, rel=0.01)

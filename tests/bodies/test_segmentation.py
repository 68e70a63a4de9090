"""Hulls and appendages of known volume are cut apart; nothing is lost."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import Manifold

from coeflab.bodies.mesh.solids import box, pieces, simplified, solid, surface
from coeflab.bodies.simplify.round_hull import round_hull
from coeflab.bodies.simplify.segmentation import segments, without_overlap
from coeflab.law.transforms import rotation
from tests.bodies.vehicles import HULL, LENGTH, lathe, rod, tailed_hull

TURN = rotation(0.3, -0.5, 1.0)


@pytest.mark.parametrize("turn", [np.eye(3), TURN])
def test_hull_under_fins_and_mast(turn: np.ndarray) -> None:
    """Axis and radius do not feel a mast that shifts the centre of volume off the axis."""
    mast = Manifold.cylinder(1.5, 0.08, 0.08, 48).translate((0.5, 0.0, 0.0))
    vertices, faces = surface(tailed_hull() + mast)
    found = round_hull(vertices @ turn.T + [1.0, 2.0, 3.0], faces)
    assert abs(found.rotation[:, 0] @ turn[:, 0]) == pytest.approx(1.0, abs=1e-8)
    off = np.cross(found.point - [1.0, 2.0, 3.0], turn[:, 0])
    assert np.linalg.norm(off) < 1e-4 * HULL
    assert found.radius == pytest.approx(HULL, rel=2e-3)
    assert found.x[-1] - found.x[0] == pytest.approx(LENGTH, rel=1e-3)
    assert found.roundness > 0.9


def test_a_wing_is_no_hull() -> None:
    found = round_hull(*surface(Manifold.cube((0.5, 4.0, 0.05), True)))
    assert found is None or found.roundness < 0.6


def test_volumes_of_the_pieces() -> None:
    whole = tailed_hull()
    found = segments(whole)
    assert found.cut == (False, True, True, True, True)
    assert found.bodies[0].volume() == pytest.approx(rod(HULL, LENGTH).volume(), rel=1e-3)
    for fin in found.bodies[1:]:
        assert fin.volume() == pytest.approx(0.3 * 0.02 * (0.6 - HULL), rel=4e-3)
        assert np.ptp(surface(fin)[0], axis=0).max() == pytest.approx(0.6 - HULL, rel=4e-3)
    total = sum(b.volume() for b in found.bodies) + found.unassigned
    assert total == pytest.approx(whole.volume(), rel=1e-9)
    assert abs(found.unassigned) < 1e-6 * whole.volume()


def test_appendages_on_a_tapering_tail() -> None:
    x = np.linspace(-2.0, 2.0, 161)
    spindle = lathe(x, 0.3 * np.sqrt(1.0 - (x / 2.0) ** 2))
    slab = Manifold.cube((0.25, 1.6, 0.02), True).translate((-1.5, 0.0, 0.0))
    found = segments(spindle + slab)
    assert len(found.bodies) == 3
    assert found.bodies[0].volume() == pytest.approx(spindle.volume(), rel=2e-3)
    assert found.bodies[1].volume() == pytest.approx(found.bodies[2].volume(), rel=1e-6)


@pytest.mark.parametrize("kind", ["rod", "ball", "block"])
def test_a_simple_body_stays_whole(kind: str) -> None:
    made = {"rod": rod(0.2, 2.0), "ball": Manifold.sphere(1.0, 64), "block": Manifold.cube((3.0, 2.0, 1.0), True)}
    of = made[kind]
    found = segments(of)
    assert found.bodies == (of,)
    assert found.unassigned == 0.0


def test_overlap_goes_to_the_larger_shell() -> None:
    parts = without_overlap([box(np.zeros(3), np.ones(3)), box(np.full(3, 0.5), np.array([1.5, 1.0, 1.0]))])
    assert [p.volume() for p in parts] == pytest.approx([1.0, 0.125])


def test_order_of_shells() -> None:
    two = Manifold.cube((1.0, 1.0, 1.0)).translate((5.0, 0, 0)) + Manifold.cube((1.0, 1.0, 2.0))
    assert [p.volume() for p in pieces(two)] == pytest.approx([2.0, 1.0])


def test_an_open_surface_is_no_solid() -> None:
    vertices, faces = surface(box(np.zeros(3), np.ones(3)))
    assert solid(vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)).volume() == pytest.approx(1)
    with pytest.raises(ValueError, match="not closed"):
        solid(vertices, faces[1:])


def test_fewer_faces_within_a_stated_distance() -> None:
    ball = Manifold.sphere(1.0, 256)
    fewer, moved = simplified(ball, 5000)
    assert fewer.num_tri() <= 5000
    reach = np.linalg.norm(surface(fewer)[0], axis=1)
    assert np.all(np.abs(reach - 1.0) <= moved + 1e-4)
    assert fewer.volume() == pytest.approx(ball.volume(), rel=0.02)
    assert simplified(ball, 10**6) == (ball, 0.0)

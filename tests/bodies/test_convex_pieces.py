"""Brackets fall into their arms, in any attitude; the same solid gives the same pieces."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import Manifold

from coeflab.bodies.mesh.solids import surface
from coeflab.bodies.simplify.convex_pieces import LARGER, VOXELS, convex_pieces
from coeflab.bodies.simplify.part_forms import likeness
from tests.bodies.vehicles import rod

BRACKET = Manifold.cube((1.0, 0.3, 0.1)) + Manifold.cube((0.1, 0.3, 0.8))


@pytest.mark.slow
@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (20.0, 33.0, 57.0)])
def test_a_bracket_is_two_boxes(turn: tuple[float, float, float]) -> None:
    found = [p for p in convex_pieces(BRACKET.rotate(turn)) if p.volume() > 0.01 * BRACKET.volume()]
    assert len(found) == 2
    assert sum(p.volume() for p in found) == pytest.approx(BRACKET.volume(), rel=2e-3)
    for piece, long in zip(found, (1.0, 0.7), strict=True):
        like = likeness(piece)
        assert like.kind == "box"
        assert sorted(like.sizes) == pytest.approx([0.1, 0.3, long], rel=0.03)


@pytest.mark.slow
def test_pieces_share_nothing_and_repeat() -> None:
    tee = rod(0.2, 3.0) + rod(0.1, 2.0).rotate((0.0, 90.0, 0.0)).translate((0.0, 0.0, 1.0))
    once, again = convex_pieces(tee), convex_pieces(tee)
    assert [surface(p)[0].tobytes() for p in once] == [surface(p)[0].tobytes() for p in again]
    assert len(once) > 1
    total = once[0]
    for piece in once[1:]:
        assert (total ^ piece).volume() == pytest.approx(0.0, abs=1e-9)
        total = total + piece
    assert total.volume() == pytest.approx(tee.volume(), rel=0.03)
    assert total.volume() <= tee.volume() * (1.0 + 1e-9)


def test_a_convex_solid_stays_whole() -> None:
    found = convex_pieces(Manifold.cube((1.0, 0.5, 0.2)))
    assert [p.volume() for p in found] == pytest.approx([0.1], rel=1e-6)
    assert np.ptp(surface(found[0])[0], axis=0) == pytest.approx([1.0, 0.5, 0.2])


def test_hulls_are_larger_by_what_voxels_leave_out() -> None:
    """A voxel on either side of a cube, over its size: the hulls grow by that, and by a fifth more at most."""
    voxel = 2.0 * VOXELS ** (-1.0 / 3.0)
    assert voxel < LARGER - 1.0 < 1.2 * voxel

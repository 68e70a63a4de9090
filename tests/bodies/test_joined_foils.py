"""A stub with a blade, and a fin with a flap behind a slit, are one foil; a small ROV about a short tube is no hull with lift."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from manifold3d import Manifold

from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import surface
from coeflab.bodies.outline import Outline
from coeflab.bodies.recognition import of_mesh
from tests.estimates.bodies import estimates_of

GAP, THICK = 0.004, 0.014
BLADES = {
    "whole": [((0.2, THICK, 0.26), (-0.8, 0.0, 0.13))],
    "stub and blade": [((0.2, THICK, 0.14), (-0.8, 0.0, 0.07)), ((0.2, THICK, 0.12 - GAP), (-0.8, 0.0, 0.2 + GAP / 2.0))],
    "fin and flap": [((0.12, THICK, 0.26), (-0.76, 0.0, 0.13)), ((0.08 - GAP, THICK, 0.16), (-0.86 - GAP / 2.0, 0.0, 0.18))],
}  # fmt: skip


@cache
def x_tail(of: str) -> Outline:
    whole = Manifold.sphere(1.0, 32).scale((1.0, 0.1, 0.1))
    for turn in (45.0, 135.0, 225.0, 315.0):
        for sides, at in BLADES[of]:
            whole += Manifold.cube(sides, True).translate(at).rotate((turn, 0.0, 0.0))
    return of_mesh(TriangleMesh(*surface(whole)))


@pytest.mark.slow
@pytest.mark.parametrize("of", ["stub and blade", "fin and flap"])
def test_pieces_with_a_slit_are_one_foil(of: str) -> None:
    whole, pieces = x_tail("whole"), x_tail(of)
    assert [len(o.foils) for o in (whole, pieces)] == [4, 4]
    assert not pieces.bluff
    share = {"stub and blade": 1.0, "fin and flap": 0.92}[of]  # the flap begins 0.1 m off the axis
    assert sum(f.area for f in pieces.foils) == pytest.approx(share * sum(f.area for f in whole.foils), rel=0.04)
    lifts = []
    for outline in (whole, pieces):
        found = estimates_of(outline).coefficients
        lifts.append({s: (found[s].value, found[s].u95) for s in ("Zw", "Mw")})
    for symbol in ("Zw", "Mw"):
        (one, _), (other, u95) = (x[symbol] for x in lifts)
        assert one is not None
        assert other == pytest.approx(one, rel=0.08)
        assert u95 is not None


def test_fins_apart_stay_two_foils() -> None:
    """A slit of a chord is none: tandem fins."""
    whole = Manifold.sphere(1.0, 32).scale((1.0, 0.1, 0.1))
    for x in (-0.5, -0.8):
        whole += Manifold.cube((0.15, THICK, 0.5), True).translate((x, 0.0, 0.0))
    assert len(of_mesh(TriangleMesh(*surface(whole))).foils) == 4


def rov(tube: bool) -> Manifold:
    """0.42 m long, 0.33 m wide, about a tube with skids, or a spheroid with thrusters."""
    if tube:
        whole = Manifold.cylinder(0.42, 0.07, 0.07, 32, True).rotate((0.0, 90.0, 0.0))
        for y in (-0.15, 0.15):
            whole += Manifold.cube((0.40, 0.012, 0.10), True).translate((0.0, y, 0.09))
        return whole + Manifold.cube((0.03, 0.33, 0.02), True).translate((0.1, 0.0, 0.04))
    whole = Manifold.sphere(1.0, 32).scale((0.21, 0.10, 0.09))
    for y in (-0.12, 0.12):
        thruster = Manifold.cylinder(0.09, 0.045, 0.045, 24, True)
        whole += thruster.rotate((0.0, 90.0, 0.0)).translate((-0.08, y, 0.0)) + thruster.translate((0.06, y, 0.0))
    return whole + Manifold.cube((0.2, 0.01, 0.29), True)


@pytest.mark.parametrize(
    "tube", [pytest.param(True, marks=pytest.mark.slow), False], ids=["tube with skids", "spheroid with thrusters"]
)
def test_a_small_rov_is_no_hull_with_lift(tube: bool) -> None:
    found = of_mesh(TriangleMesh(*surface(rov(tube))))
    assert not found.hulls
    assert not found.foils
    assert [b.name for b in found.bluff] == ["body"]
    hull = of_mesh(TriangleMesh(*surface(Manifold.sphere(1.0, 32).scale((0.21, 0.10, 0.09)))))
    assert len(hull.hulls) == 1
    assert np.ptp(hull.hulls[0].x) == pytest.approx(0.42, rel=0.01)

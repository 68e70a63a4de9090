"""Planes on a sail are foils on a foil: the sail stays what it is, a wing adds its own share, and what nothing sees is in U95."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from manifold3d import CrossSection, Manifold

from coeflab.bodies.body import Body
from coeflab.bodies.fin_lift import low_aspect_lift_slope
from coeflab.bodies.mesh.mesh import TriangleMesh
from coeflab.bodies.mesh.solids import surface
from coeflab.bodies.outline import Bluff, Outline, Unseen
from coeflab.bodies.recognition import of_mesh
from coeflab.core.axes import Datum
from coeflab.core.provenance import Source
from coeflab.estimates import Estimates, Water, estimated, unseen
from coeflab.law.scaling import Scaling
from tests.estimates.bodies import SAIL, estimates_of, outline, tail

LENGTH, CHORD, SPAN = 4.0, 0.12, 0.5
WATER = Water(1000.0, 1e-6, 2.0)


def section(chord: float, thick: float) -> CrossSection:
    a = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    return CrossSection([np.column_stack([chord / 2.0 * np.cos(a), thick / 2.0 * np.sin(a)])])


def sail() -> Manifold:
    """0.25 m above the hull, 0.4 m long, 0.06 m thick."""
    return section(0.4, 0.06).extrude(0.49).translate((0.5, 0.0, 0.0)).rotate((180.0, 0.0, 0.0))


def planes(z: float, start: float = -SPAN / 2.0) -> Manifold:
    """From ``start`` to half the span, starboard."""
    long = SPAN / 2.0 - start
    return (
        section(CHORD, 0.018).extrude(long).rotate((90.0, 0.0, 0.0)).translate((0.55, SPAN / 2.0, z))
    )  # the section extrudes along -y


@cache
def made(
    z: float | None, start: float = -SPAN / 2.0, about: float = 0.0
) -> tuple[Outline, dict[str, tuple[float, float]]]:
    """Outline and estimates of a spheroid with a tail, a sail and planes on it, turned about x by degrees."""
    hull = Manifold.sphere(1.0, 40).scale((LENGTH / 2.0, 0.25, 0.25))
    fins = Manifold.cube((0.15, 0.012, 0.8), True) + Manifold.cube((0.15, 0.8, 0.012), True)
    whole = hull + sail() + fins.translate((-1.6, 0.0, 0.0))
    if z is not None:
        whole += planes(z, start)
    shape = TriangleMesh(*surface(whole.rotate((about, 0.0, 0.0))))
    body = Body(
        "b", "b", Datum("middle"), np.zeros(3), {}, (), Source("s", kind="synthetic"), (), shape, Scaling(LENGTH, "LOA")
    )
    return of_mesh(shape), numbers(estimated(body, WATER))


def numbers(found: Estimates) -> dict[str, tuple[float, float]]:
    return {c.symbol: (float(c.value or 0.0), float(c.u95 or 0.0)) for c in found.coefficients.coefficients}


@pytest.mark.slow
@pytest.mark.parametrize("z", [-0.32, -0.365, -0.42])
def test_the_sail_stays_a_foil_and_the_wing_adds_its_own_share(z: float) -> None:
    seen, found = made(z)
    bare, without = made(None)
    assert not seen.bluff
    assert seen.left_out == ()
    assert len(seen.foils) == len(bare.foils) + 2
    sails = [next(f for f in o.foils if f.name.startswith("foil_upper") and f.root[0] > 0.0) for o in (seen, bare)]
    assert sails[0].area == pytest.approx(sails[1].area, rel=0.01)
    assert sails[0].thickness == pytest.approx(sails[1].thickness, abs=0.01)
    for name in ("Yv", "Nv", "Yr", "Nr"):
        assert found[name][0] == pytest.approx(without[name][0], rel=0.02)
    wing = [f for f in seen.foils if 0.0 < f.root[0] < 1.0 and abs(f.tip[1]) > 0.2]
    assert sum(f.area for f in wing) == pytest.approx(CHORD * (SPAN - 0.06), rel=0.1)
    # A free wing of its whole span, by Whicker & Fehlner; what it takes from the tail is in U95.
    own = low_aspect_lift_slope(SPAN / CHORD) * CHORD * SPAN / LENGTH**2
    gained = without["Zw"][0] - found["Zw"][0]
    assert abs(gained - own) < found["Zw"][1]
    assert gained > 0.6 * own


@pytest.mark.slow
def test_planes_on_one_side_on_the_tip_and_below_are_found_too() -> None:
    one, _ = made(-0.365, start=0.0)
    assert sum(0.0 < f.root[0] < 1.0 for f in one.foils) == 2
    tip, _ = made(-0.485)
    assert sum(0.0 < f.root[0] < 1.0 for f in tip.foils) == 3
    turned, below = made(-0.365, about=180.0)
    assert sum(0.0 < f.root[0] < 1.0 for f in turned.foils) == 3
    assert below["Zw"][0] == pytest.approx(made(-0.365)[1]["Zw"][0], rel=0.02)


def test_unseen_area_has_no_force_and_a_half_width_by_hand() -> None:
    """1 m^2 facing z, 2 m ahead: lift of aspect 2 on w, and its moment; 2.442 per rad by Whicker & Fehlner, 14/9 with the hull's share."""
    one = Unseen("deck", np.array([2.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    (made_of,) = unseen.contributions(Outline((), (), (), (), 1.0, 1.0, unseen=(one,)), Water(1000.0, 1e-6, 3.0))
    nu = np.array([[3.0, 0.0, 0.1, 0.0, 0.0, 0.0]])
    assert np.all(made_of.forces(nu, {}) == 0.0)
    lifts = [h for h in made_of.scatter if abs(float(h(nu, {})[0, 2])) > 0.0]
    lift = float(lifts[0](nu, {})[0, 2])
    assert lift == pytest.approx(-0.5 * 1000.0 * 3.0 * 0.1 * 2.442 * 14.0 / 9.0, rel=1e-3)
    assert float(lifts[0](nu, {})[0, 4]) == pytest.approx(-2.0 * lift, rel=1e-9)


def test_the_half_width_of_a_bluff_part_holds_the_lift_of_the_foil_that_it_may_be() -> None:
    sides = np.array([0.02 * 0.2, SAIL.area, 0.02 * 0.4])
    half = np.array([0.2, 0.03, SAIL.span / 2.0])
    block = Bluff(
        "part_upper", "mesh", (SAIL.root + SAIL.tip) / 2.0 - np.array([0.1, 0.0, 0.0]), np.eye(3), half, sides
    )
    foiled = numbers(estimates_of(outline(SAIL, *tail())))
    bluff = numbers(estimates_of(outline(*tail(), bluff=(block,))))
    for name in ("Yv", "Nv", "Yr", "Nr"):
        assert abs(foiled[name][0] - bluff[name][0]) < bluff[name][1], name
    assert bluff["Yv"][1] > 1.2 * numbers(estimates_of(outline(*tail())))["Yv"][1]

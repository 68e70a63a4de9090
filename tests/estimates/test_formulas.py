"""Every empirical formula against a printed number, or one found another way; a constant moved by 5 % fails."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass, spheroid_munk_slope
from coeflab.bodies.fin_lift import fin_groups, foil_on_body, low_aspect_lift_slope
from coeflab.bodies.hull_flow import FLAT, STERN, hull_flow
from coeflab.estimates import SEPARATED, bluff, crossflow, fins, form_drag, friction, hull_lift, ring_wing
from coeflab.law.friction_line import friction_line
from tests.estimates.bodies import (
    DOWN,
    LENGTH,
    RADIUS,
    RING,
    SAIL,
    STARBOARD,
    UP,
    WATER,
    box,
    cut_hull,
    foil,
    hull,
    outline,
    tail,
)


def test_ittc_1957_line_as_tabled() -> None:
    # ITTC 1957 table: Re 1e6, 1e7, 1e8, 1e9.
    for reynolds, printed in ((1e6, 4.688e-3), (1e7, 3.000e-3), (1e8, 2.083e-3), (1e9, 1.531e-3)):
        assert friction_line(reynolds) == pytest.approx(printed, abs=1e-6)


def test_roughness_of_150_micrometres_on_a_ship() -> None:
    # By hand: k/L = 1e-6, Re = 1e9: 0.044 (0.01 - 0.01) + 0.000125.
    assert friction.roughness_allowance(1e9, 1e-6) == pytest.approx(1.25e-4, abs=1e-12)
    # k/L = 8e-6: 0.044 (0.02 - 0.01) + 0.000125.
    assert friction.roughness_allowance(1e9, 8e-6) == pytest.approx(5.65e-4, abs=1e-12)
    assert friction.roughness_allowance(1e9, 0.0) == 0.0


def test_section_and_hull_forms_by_hoerner() -> None:
    # Hoerner's examples by hand: t/c 20 %: 1 + 0.4 + 0.096; d/l = 1/4: 1.5/8 + 7/64.
    assert friction.section_drag(0.003, 0.2) == pytest.approx(2 * 0.003 * 1.496, rel=1e-12)
    assert form_drag.hoerner_form(4.0) == pytest.approx(0.296875, rel=1e-12)
    assert form_drag.gillmer_form(4.0) == pytest.approx(0.171875, rel=1e-12)
    assert form_drag.base_drag(0.04) == pytest.approx(0.145, rel=1e-12)


def test_finite_cylinders_by_wieselsberger() -> None:
    for fineness, printed in ((1.0, 0.63), (5.0, 0.74), (10.0, 0.82), (40.0, 0.98)):
        assert 1.2 * crossflow.of_finite_length(fineness) == pytest.approx(printed, rel=1e-9)
    assert crossflow.fuller(np.pi / 4.0) == pytest.approx(1.0)
    assert 1.2 * crossflow.fuller(1.0) == pytest.approx(2.05)


def test_whicker_and_fehlner() -> None:
    # Closed forms: Jones' pi a / 2 at the limit by 0.9; 0.9 (2 pi) of long ones; a = 2: 3.6 pi / (sqrt 8 + 1.8).
    assert low_aspect_lift_slope(2.0) == pytest.approx(3.6 * np.pi / (np.sqrt(8.0) + 1.8), rel=1e-12)
    assert low_aspect_lift_slope(1e-6) / 1e-6 == pytest.approx(1.8 * np.pi / 3.8, rel=1e-5)
    assert low_aspect_lift_slope(1e7) == pytest.approx(1.8 * np.pi, rel=1e-5)
    # C_Dc 0.82 and 0.415 at taper 0.45, the mean section of their family.
    assert fins.cross_flow_drag(0.45, "square tips") == pytest.approx(0.82, rel=1e-12)
    assert fins.cross_flow_drag(0.45, "faired tips") == pytest.approx(0.415, rel=1e-12)


def test_flaps_by_thin_foil_theory() -> None:
    assert fins.flap_effect(1.0) == pytest.approx(1.0)
    assert fins.flap_effect(0.0) == pytest.approx(0.0, abs=1e-12)
    assert fins.flap_effect(0.5) == pytest.approx(0.5 + 1.0 / np.pi, rel=1e-12)
    assert fins.flap_effect(0.25) == pytest.approx(0.609, abs=1e-3)  # Glauert's chart


def test_ring_wings_by_weissinger_and_as_fletcher_measured_them() -> None:
    # NACA TN 4117 (1957), figure 11: per degree on d c.
    for aspect, measured in ((1 / 3, 0.018), (2 / 3, 0.034), (1.0, 0.049), (1.5, 0.069), (3.0, 0.102)):
        assert np.radians(ring_wing.ring_slope(aspect)) == pytest.approx(measured, rel=0.03)
    assert ring_wing.ring_slope(1.0) == pytest.approx(2.8633, abs=1e-4)
    assert ring_wing.ring_slope(1e9) == pytest.approx(np.pi**2, rel=1e-6)
    assert ring_wing.ring_slope(1e-4) / 1e-4 == pytest.approx(np.pi, rel=1e-3)


def test_foils_on_a_body_between_none_and_half_a_plane() -> None:
    assert foil_on_body(0.0) == 1.0
    assert foil_on_body(1.0) == 2.0
    assert foil_on_body(0.002) == pytest.approx(1.0, abs=0.005)
    assert foil_on_body(0.998) == pytest.approx(2.0, abs=0.005)
    assert foil_on_body(0.4) == pytest.approx(1.35, abs=0.01)  # NACA 1307, chart 1


def test_carry_over_equals_added_mass_of_the_section() -> None:
    # Bryson: a finned circle moves pi rho (s^2 - r^2 + r^4/s^2); less the circle, over the pair with its mirror image.
    pair, single = (
        fin_groups(outline(foil("a", UP, -3.5, 0.1, 0.25, 0.2), foil("b", (0.0, 1.0), -3.5, 0.1, 0.25, 0.2)))[0],
        fin_groups(outline(SAIL))[0],
    )
    r, s = 0.1, 0.25
    assert pair.carried == pytest.approx((s**2 - 2 * r**2 + r**4 / s**2) / (s - r) ** 2, rel=1e-12)
    r, s = 0.25, 0.45
    half = (s + r) ** 2 / (2 * s)
    assert single.carried == pytest.approx(2.0 * (half**2 - 4.0 * r**2) / (s - r) ** 2, rel=1e-12)


def test_a_vortex_far_off_loses_what_the_foils_added_mass_says() -> None:
    # Far off psi_foils -> z - (a^2/2 - r^2)/z of a pair: 1 - psi/psi_hull -> (a^2/2 - 2 r^2)/z^2, a = s + r^2/s.
    group = fin_groups(outline(*tail()))[0]
    a, z = group.reach + group.radius**2 / group.reach, 50.0
    assert group.seen(z) * z**2 == pytest.approx(a**2 / 2.0 - 2.0 * group.radius**2, rel=1e-3)
    assert group.seen(-z) == pytest.approx(group.seen(z), rel=1e-9)
    assert group.seen(0.2) == pytest.approx(1.0)  # within the span: all of it
    alone = fin_groups(outline(SAIL))[0]
    assert alone.seen(0.5) > 0.0 > alone.seen(-0.5)  # on its own side, and opposite to it
    assert 0.5 < group.seen_around(0.12) < 1.0


def test_hopkins_station() -> None:
    # A body whose area falls most steeply at its end: 0.378 + 0.527; at 0.8 l: 0.7996.
    h = hull()
    assert hull_lift.hopkins_station(h.x, h.area) == pytest.approx(-LENGTH * 0.905, rel=2e-3)
    x = -np.linspace(0.0, 1.0, 101)
    area = np.where(x > -0.795, 1.0, np.where(x > -0.805, 0.5, 0.4))
    assert hull_lift.hopkins_station(x, area) == pytest.approx(-(0.378 + 0.527 * 0.795), abs=4e-3)


def test_added_mass_of_a_spheroid_is_lambs() -> None:
    flow = hull_flow(hull(), 1000.0, 1e-6, 3.0)
    exact = ellipsoid_added_mass(np.array([LENGTH / 2.0, RADIUS, RADIUS]), 1000.0)
    found = flow.added_mass
    assert found[0, 0] == pytest.approx(exact[0, 0], rel=1e-3)
    assert found[1, 1] == pytest.approx(exact[1, 1], rel=1e-3)
    assert found[2, 4] == pytest.approx(exact[2, 2] * LENGTH / 2.0, rel=1e-3)  # nose to middle
    assert found[5, 5] - found[1, 1] * LENGTH**2 / 4.0 == pytest.approx(exact[5, 5], rel=5e-3)


def test_munk_moment_once() -> None:
    ideal = [c for c in hull_lift.contributions(outline(), WATER) if c.kind == "ideal fluid"]
    assert len(ideal) == 1
    nu = np.array([[3.0, 0.03, 0.0, 0.0, 0.0, 0.0]])
    force = ideal[0].forces(nu, {})[0]
    unit = 0.5 * WATER.density * LENGTH**3 * 3.0
    assert (force[5] + LENGTH / 2.0 * force[1]) / 0.03 / unit == pytest.approx(
        spheroid_munk_slope(LENGTH, 2 * RADIUS), rel=2e-3
    )
    assert force[1] == pytest.approx(0.0, abs=1e-9)


def test_a_blunt_base_lifts_by_its_area() -> None:
    # Slender-body theory: Y = -rho U v S_base (k2 - k1), at the base.
    h = cut_hull(0.3)
    flow = hull_flow(h, WATER.density, WATER.viscosity, WATER.speed)
    shed = next(c for c in hull_lift.contributions(outline(hulls=(h,)), WATER) if "Allen" in c.method)
    force = shed.forces(np.array([[3.0, 0.1, 0.0, 0.0, 0.0, 0.0]]), {})[0]
    assert force[1] == pytest.approx(-WATER.density * 3.0 * 0.1 * h.area[-1] * flow.apparent, rel=1e-9)
    assert force[5] == pytest.approx(h.x[-1] * force[1], rel=1e-9)
    closed = next(c for c in hull_lift.contributions(outline(), WATER) if "Allen" in c.method)
    assert not np.any(closed.forces(np.array([[3.0, 0.1, 0.2, 0.0, 0.1, 0.2]]), {}))


def test_what_hopkins_sheds_is_the_ideal_load_aft_of_his_station() -> None:
    # The load per length of slender-body theory is U d(m v)/dx; taken away aft of x0, by fine differences.
    h = hull()
    flow = hull_flow(h, WATER.density, WATER.viscosity, WATER.speed)
    shed = next(c for c in hull_lift.contributions(outline(), WATER) if "Hopkins" in c.method)
    start = hull_lift.hopkins_station(h.x, h.area)
    fine = np.linspace(start, h.x[-1], 20001)
    across = 0.1 + 0.05 * fine
    momentum = flow.apparent * np.interp(fine, h.x[::-1], flow.sway[::-1]) * across
    load = 3.0 * np.diff(momentum) / np.diff(fine)
    middle = (fine[1:] + fine[:-1]) / 2.0
    force = shed.forces(np.array([[3.0, 0.1, 0.0, 0.0, 0.0, 0.05]]), {})[0]
    assert force[1] == pytest.approx(-np.sum(load * -np.diff(fine)), rel=2e-3)
    assert force[5] == pytest.approx(-np.sum(middle * load * -np.diff(fine)), rel=2e-3)


def test_boundary_layer_holds_its_momentum() -> None:
    flow = hull_flow(hull(), WATER.density, WATER.viscosity, WATER.speed)
    for x, shape in ((-1.0, 9 / 7), (-3.5, 1.9)):
        radius = 0.2
        layer, n = flow.thickness(x, radius), 2.0 / (shape - 1.0)
        y = np.linspace(0.0, layer, 200001)
        u = (y / layer) ** (1.0 / n)
        momentum = np.trapezoid(u * (1.0 - u) * 2.0 * np.pi * (radius + y), y)
        assert momentum == pytest.approx(np.interp(x, flow.hull.x[::-1], flow.momentum[::-1]), rel=1e-3)
        assert flow.pressure_share(x, radius, 0.0, layer) == pytest.approx(np.trapezoid(u**2, y) / layer, rel=1e-3)
    assert flow.momentum[-1] == pytest.approx(flow.friction * flow.surface[-1] / 2.0)
    assert flow.surface[-1] == pytest.approx(2 * np.pi * RADIUS * LENGTH / 2 * (np.pi / 2) * 1.0, rel=0.02)


def test_faces_of_bluff_parts_by_hoerner() -> None:
    assert bluff.face_drag(box()).tolist() == pytest.approx([1.05] * 3)
    two = (box("a", (0.0, 0.0, 0.0)), box("b", (-1.0, 0.0, 0.0)))
    share = bluff.shielding(two)
    assert share[0] == pytest.approx(0.5)
    assert share[1:].tolist() == pytest.approx([1.0, 1.0])


def test_shape_factors_of_the_boundary_layer() -> None:
    assert pytest.approx(1.2857, abs=1e-4) == FLAT  # one-seventh power law
    assert pytest.approx((1.4 + 2.4) / 2.0) == STERN  # flat plates as measured, separation (Schlichting)


def test_cross_flow_of_a_hull_by_hand() -> None:
    # Sway alone: 1/2 rho c_dc eta d l pi/4 v^2 of an ellipse; friction 1/2 rho C_F S u v, S of a slender spheroid.
    sway, drift = np.array([[0.0, 0.5, 0.0, 0, 0, 0]]), np.array([[3.0, 0.01, 0.0, 0, 0, 0]])
    eta = crossflow.of_finite_length(LENGTH / (2 * RADIUS))
    plan = np.pi / 4.0 * LENGTH * 2 * RADIUS
    made = {c.method: c.forces for c in crossflow.contributions(outline(), WATER)}
    for c_dc in (1.2, 0.7):
        force = made[f"crossflow, c_dc {c_dc:g}"](sway, {})[0, 1]
        assert force == pytest.approx(-0.5 * WATER.density * c_dc * eta * plan * 0.25, rel=1e-3)
    friction_ = made["crossflow"](drift, {})[0, 1]
    girth = 2 * np.pi * RADIUS * LENGTH * np.pi / 4.0
    line = friction_line(WATER.speed * LENGTH / WATER.viscosity)
    assert friction_ == pytest.approx(-0.5 * WATER.density * line * girth * 3.0 * 0.01, rel=1e-3)


def test_induced_drag_of_a_fin_by_hand() -> None:
    # C_D = C_L^2 / (0.9 pi a): X = 1/2 rho S C alpha^2 u^2 (1 - C / (0.9 pi a)), C = 3.6 pi / (sqrt 8 + 1.8) at a = 2.
    halves = (foil("right", STARBOARD, 0.0, 0.0, 0.5, 0.5), foil("left", (-1.0, 0.0), 0.0, 0.0, 0.5, 0.5))
    lifts = [c for c in fins.contributions(outline(*halves, hulls=()), WATER) if c.kind == "fin lift"]
    nu = np.array([[3.0, 0.0, 0.3, 0.0, 0.0, 0.0]])
    slope = 3.6 * np.pi / (np.sqrt(8.0) + 1.8)
    along = sum(c.forces(nu, {})[0, 0] for c in lifts)
    assert along == pytest.approx(
        0.5 * WATER.density * 0.5 * slope * 0.09 * (1.0 - slope / (0.9 * np.pi * 2.0)), rel=1e-6
    )


def test_tip_vortex_by_hand() -> None:
    # NACA 1307: height r + pi/4 (s - r); strength lift over (h - r^2/h); behind: psi_hull - psi_foils.
    wash = next(c for c in fins.contributions(outline(SAIL, *tail()), WATER) if c.kind == "sidewash")
    sail, pair = (
        next(g for g in fin_groups(outline(SAIL, *tail())) if f in [x.name for x in g.foils]) for f in ("sail", "upper")
    )
    flow = hull_flow(hull(), WATER.density, WATER.viscosity, WATER.speed)
    share = [flow.pressure_share(g.quarter, g.radius, 0.0, g.reach - g.radius) for g in (sail, pair)]
    height = 0.25 + np.pi / 4.0 * 0.2
    tip = 0.25 + 0.1**2 / 0.25
    past = np.sqrt((height + 0.01 / height) ** 2 - tip**2)
    lift = sail.slope * SAIL.area * sail.carried * share[0] / (height - 0.25**2 / height)
    area = lift * (height - 0.01 / height - past) * pair.finite * share[1]
    force = wash.forces(np.array([[3.0, 0.01, 0.0, 0.0, 0.0, 0.0]]), {})[0, 1]
    assert force == pytest.approx(0.5 * WATER.density * 3.0 * 0.01 * area, rel=1e-9)


def test_strips_in_a_vortex_and_its_image_by_hand() -> None:
    # On the line of both vortices, between and beyond them; circulation 1/2 of the strength.
    for way, sign in ((UP, 1.0), (DOWN, -1.0)):
        (group,) = fin_groups(outline(foil("short", way, -3.5, 0.1, 0.1001, 0.2)))
        force, roll = fins._strips(group, np.array([0.0, *UP]), 0.4, 2.0)
        arm, image = 0.10005, 0.1**2 / 0.4
        flow = (1.0 / (0.4 - sign * arm) + sign / (arm - sign * image)) / (4.0 * np.pi)
        area = 2.0 * 0.2 * 0.0001 * flow
        assert force == pytest.approx([0.0, area, 0.0], rel=1e-6, abs=1e-12)  # x cross UP is starboard
        assert roll == pytest.approx(sign * area * arm, rel=1e-6)


def test_rings_and_parts_across_the_flow_by_hoerner() -> None:
    ring = next(
        c for c in ring_wing.contributions(outline(hulls=(), rings=(RING,)), WATER) if c.kind == "ring cross-flow"
    )
    force = ring.forces(np.array([[0.0, 0.5, 0.0, 0.0, 0.0, 0.0]]), {})[0, 1]
    assert force == pytest.approx(-0.5 * WATER.density * 1.17 * RING.diameter * RING.chord * 0.25, rel=1e-9)
    for kind, wanted in (
        ("box", [1.05] * 3),
        ("cylinder", [0.82, 1.20, 1.20]),
        ("plate", [1.17] * 3),
        ("ellipsoid", [0.47] * 3),
    ):
        assert bluff.face_drag(replace(box(), kind=kind)).tolist() == pytest.approx(wanted)


def test_shares_are_those_that_the_page_prints() -> None:
    page = Path("docs/estimates.md").read_text()
    shares = {
        "ideal fluid": hull_lift.IDEAL_SHARE, "hull lift, 2": hull_lift.SHED_SHARE, "fin lift": fins.LIFT_SHARE,
        "control": fins.CONTROL_SHARE, "sidewash": fins.WASH_SHARE, "fin cross-flow, 1 and 2": fins.DRAG_SHARE,
        "ring lift": ring_wing.SHARE, "ring cross-flow": ring_wing.DRAG_SHARE, "bluff drag, 1 to 4": bluff.SHARE,
        "ideal fluid, bluff": SEPARATED, "ideal fluid, bluff parts without added mass": bluff.IDEAL_SHARE, "cross-flow friction": crossflow.FRICTION_SHARE,
        "cross-flow drag, 1": crossflow.DRAG_SHARE, "friction": friction.HULL_SHARE, "form drag, 1 and 2": form_drag.SHARE,
    }  # fmt: skip
    for kind, share in shares.items():
        row = next(line for line in page.splitlines() if line.startswith(f"| {kind} |"))
        assert f"| {100 * share:.4g} %" in row, kind

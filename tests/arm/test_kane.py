"""Kane's equations against the printed acceptance numbers, Pinocchio, and what ideal water must conserve."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.arm import compiled, kane
from coeflab.arm.chain import Chain, Flow, Link, Strip, in_frame_0
from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass
from coeflab.law.rigid_body import axes_in_earth
from tests.arm.chains import (
    PAPER_SPEEDS,
    Q,
    drawn,
    dry,
    ideal,
    pinocchio_model,
    pinocchio_position,
    puma,
    state,
)

ARMS = [dry(puma(), 9.81), dry(drawn(0), 9.81), dry(drawn(1), 9.81), dry(drawn(2), 9.81)]


def test_mass_matrix_of_the_paper() -> None:
    m = in_frame_0(puma(), kane.mass_matrix(dry(puma()), Q))
    diagonal = [140.34, 140.34, 140.34, 16.111558, 37.02878, 39.383375, 2.703695, 2.226111, 0.075579]
    row = [140.34, 0.0, 0.0, 0.0, 6.876421, -6.654255, -6.654255, 2.684943, 0.018592]
    np.testing.assert_allclose(np.diag(m), diagonal, atol=6e-7)
    np.testing.assert_allclose(m[0], row, atol=6e-7)


def test_bias_of_the_paper() -> None:
    chain = dry(puma())
    found = in_frame_0(chain, kane.bias(chain, Q, in_frame_0(chain, PAPER_SPEEDS)))
    printed = [2.432883, 9.523231, 4.707274, 0.635088, -0.843423, -0.178441, -0.140057, -0.310209, 0.002126]
    np.testing.assert_allclose(found, printed, atol=6e-7)


def test_added_mass_of_the_paper() -> None:
    water = kane.mass_matrix(puma(), Q) - kane.mass_matrix(dry(puma()), Q)
    diagonal = [128.810058, 538.986349, 515.812717, 2.61593, 60.882072, 65.821531, 0.769471, 0.426749, 0.052083]
    np.testing.assert_allclose(np.diag(in_frame_0(puma(), water)), diagonal, atol=6e-7)


def test_spheroid_by_the_mended_eccentricity() -> None:
    """Erratum 1: e^2 = 1 - (b/a)^2; the printed e gives .2335, .6816 and .0517."""
    mass = 4.0 / 3.0 * np.pi * 1000.0 * 0.16
    found = np.diag(ellipsoid_added_mass(np.array([1.0, 0.4, 0.4]), 1000.0)) / mass
    np.testing.assert_allclose(found[[0, 1, 4]], [0.1563, 0.7619, 0.0847], atol=5e-5)
    np.testing.assert_allclose(np.diag(puma().base.added_mass) / mass, found)


@pytest.mark.parametrize("chain", ARMS, ids=["puma", "drawn 0", "drawn 1", "drawn 2"])
def test_pinocchio(chain: Chain) -> None:
    import pinocchio as pin

    model = pinocchio_model(chain)
    data = model.createData()
    n = chain.count
    for seed in range(3):
        s = state(chain, seed)
        at, q, speeds = pinocchio_position(s, n), s[7 : 7 + n], s[7 + n :]
        m = pin.crba(model, data, at)
        m = np.triu(m) + np.triu(m, 1).T
        pulled = pin.computeGeneralizedGravity(model, data, at).copy()
        biased = pin.nonLinearEffects(model, data, at, speeds) - pulled
        down = np.array(axes_in_earth(*s[3:7])[2::3])
        found = kane.mass_matrix(chain, q), kane.bias(chain, q, speeds), kane.weight(chain, q, down)
        for ours, theirs in zip(found, (m, biased, -pulled), strict=True):
            assert np.max(np.abs(ours - theirs)) < 1e-12 * np.max(np.abs(theirs))


@pytest.mark.slow
@pytest.mark.parametrize("chain", [puma(), drawn(0), drawn(1), drawn(2)], ids=["puma", "drawn 0", "drawn 1", "drawn 2"])
def test_compiled_is_the_same(chain: Chain) -> None:
    s, rng = state(chain, 3), np.random.default_rng(5)
    flow, control = Flow(rng.normal(size=3), rng.normal(size=3)), rng.normal(size=6 + chain.count)
    plain, quick = kane.right_hand_side(chain, s, control, flow), compiled.right_hand_side(chain, s, control, flow)
    assert np.max(np.abs(plain - quick)) < 1e-11 * np.max(np.abs(plain))
    frame, bodies, nodes = compiled.packed(chain)
    q, speeds, water = s[7 : 7 + chain.count], s[7 + chain.count :], rng.normal(size=6)
    m, c = compiled.mass_matrix(frame, bodies, q), compiled.bias(frame, bodies, q, speeds, water)
    np.testing.assert_allclose(m, kane.mass_matrix(chain, q), rtol=1e-12, atol=1e-12)
    wanted = kane.bias(chain, q, speeds, water[:3], water[3:])
    assert np.max(np.abs(c - wanted)) < 1e-12 * np.max(np.abs(wanted))
    assert len(nodes) == 12 * sum(len(link.strips) for link in chain.links)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_ideal_water_keeps_energy_and_impulse(seed: int) -> None:
    """Without force from outside, energy and impulse of bodies and water stay, whatever the joints do within (errata 4 and 6)."""
    chain = ideal(drawn(seed))
    n = chain.count
    s = state(chain, seed + 7)
    torque = np.zeros(6 + n)
    torque[6:] = np.random.default_rng(seed).normal(size=n)

    def energy(x: np.ndarray) -> float:
        return float(0.5 * x[7 + n :] @ kane.mass_matrix(chain, x[7 : 7 + n]) @ x[7 + n :])

    def impulse(x: np.ndarray) -> np.ndarray:
        both = kane.mass_matrix(chain, x[7 : 7 + n]) @ x[7 + n :]
        axes = np.reshape(axes_in_earth(*x[3:7]), (3, 3))
        linear = both[:3] @ axes
        return np.concatenate([linear, both[3:6] @ axes + np.cross(x[:3], linear)])

    rates = kane.right_hand_side(chain, s, torque)
    step = 1e-5
    ahead, behind = s + step * rates, s - step * rates
    given = (energy(ahead) - energy(behind)) / (2.0 * step)
    assert given == pytest.approx(torque @ s[7 + n :], rel=1e-6, abs=1e-6 * energy(s))
    changed = (impulse(ahead) - impulse(behind)) / (2.0 * step)
    assert np.max(np.abs(changed)) < 1e-6 * np.max(np.abs(impulse(s))) * np.max(np.abs(rates))


@pytest.mark.parametrize("chain", [puma(), drawn(1)], ids=["puma", "drawn"])
def test_a_steady_current_moves_the_whole_picture(chain: Chain) -> None:
    """Equation 17: a vehicle that drifts with the water feels no current."""
    s, current = state(chain, 2), np.array([0.4, -0.3, 0.2])
    drifting = s.copy()
    drifting[7 + chain.count : 10 + chain.count] += np.reshape(axes_in_earth(*s[3:7]), (3, 3)) @ current
    still, carried = kane.equations(chain, s), kane.equations(chain, drifting, Flow(current))
    n, turning = chain.count, s[10 + chain.count : 13 + chain.count]
    rate, other = np.linalg.solve(*still), np.linalg.solve(*carried)
    # The same acceleration over ground: w x v of the current is that of the turning axes.
    rate[:3] -= np.cross(turning, drifting[7 + n : 10 + n] - s[7 + n : 10 + n])
    np.testing.assert_allclose(other, rate, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("chain", [puma(), drawn(2)], ids=["puma", "drawn"])
def test_water_that_accelerates_downward_is_less_gravity(chain: Chain) -> None:
    """Equation 20: in water that falls by a, all is as in still water of gravity g - a, seen from that water."""
    s, a = state(chain, 4), 2.5
    falling = np.linalg.solve(*kane.equations(chain, s, Flow(acceleration=np.array([0.0, 0.0, a]))))
    falling[:3] -= a * np.array(axes_in_earth(*s[3:7])[2::3])
    lighter = np.linalg.solve(*kane.equations(replace(chain, gravity=chain.gravity - a), s))
    np.testing.assert_allclose(falling, lighter, rtol=1e-9, atol=1e-9)


def test_buoyancy_lifts_at_its_centre() -> None:
    """Equation 19: a level vehicle with its arm pushed by rho V g upward at each centre of buoyancy."""
    chain = drawn(0)
    q = state(chain)[7:13]
    at = kane.pose(chain, q)
    volumes, centres = chain.displaced
    places = at.origin + np.einsum("bij,bj->bi", at.rotation, centres)
    lift = -chain.density * chain.gravity * volumes
    found = kane.buoyancy(chain, q, np.array([0.0, 0.0, 1.0]))
    moment = np.sum(np.cross(places, np.outer(lift, [0.0, 0.0, 1.0])), axis=0)
    np.testing.assert_allclose(found[:6], [0.0, 0.0, lift.sum(), *moment], atol=1e-9)


def swung(length: float = 0.8) -> Chain:
    """A cylinder that turns about its end."""
    one = puma().links[0]
    joint = replace(one.joint, alpha=0.0)
    strip = Strip(np.zeros(3), np.array([length, 0.0, 0.0]), 0.1, 1.1)
    link = Link("rod", joint, one.mass, np.array([0.3, 0.02, 0.01]), one.inertia, strips=(strip,))
    return replace(puma(), links=(link,))


def test_a_cylinder_swung_about_its_end() -> None:
    """Erratum 5: 1/2 rho C_D d w^3 L^4 / 4 is dissipated, about the centre of mass or any other point."""
    chain, rate, length = swung(), 1.7, 0.8
    speeds = np.zeros(7)
    speeds[6] = rate
    lost = -speeds @ kane.drag(chain, np.array([0.4]), speeds)
    assert lost == pytest.approx(0.5 * 1000.0 * 1.1 * 0.1 * rate**3 * length**4 / 4.0, rel=1e-12)


def test_a_cylinder_drags_across_its_own_axis() -> None:
    """Errata 5 and 8: by the velocity across alone, with no further sine, and nothing along."""
    chain, q = swung(), np.zeros(1)
    axis = kane.pose(chain, q).rotation[1][:, 0]
    for angle in (0.0, 0.5, np.pi / 2.0):
        across = np.array([0.0, 0.0, 1.0])
        speeds = np.zeros(7)
        speeds[:3] = np.cos(angle) * axis + np.sin(angle) * across
        only = replace(chain, base=replace(chain.base, drag_area=np.zeros(3)))
        force = kane.drag(only, q, speeds)[:3]
        np.testing.assert_allclose(force, -0.5 * 1000.0 * 1.1 * 0.1 * 0.8 * np.sin(angle) ** 2 * across, atol=1e-9)


def test_the_vehicle_drags_against_its_motion() -> None:
    """Erratum 7: -1/2 rho C_D S |v| v, through the water."""
    bare = replace(puma(), links=())
    speeds, current = np.array([-1.0, 2.0, 0.5, 0.3, 0.2, 0.1]), np.array([0.5, 0.0, 0.25])
    through = speeds[:3] - current
    found = kane.drag(bare, np.zeros(0), speeds, current)
    np.testing.assert_allclose(found[:3], -500.0 * 0.236 * np.linalg.norm(through) * through)
    assert not found[3:].any()


def test_earth_axes() -> None:
    """Erratum 7: diag(1, -1, -1) between NED and frame 0, and cos(phi) at (2, 2) of equation 29."""
    roll, pitch, yaw = 0.3, -0.5, 1.1
    half = np.array([roll, pitch, yaw]) / 2.0
    (cr, cp, cy), (sr, sp, sy) = np.cos(half), np.sin(half)
    attitude = [
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    ]
    s = np.concatenate([[1.0, 2.0, 3.0], attitude, Q, np.zeros(3), [0.2, -0.4, 0.7], np.zeros(3)])
    rate = kane.displacement_rates(3, s)
    assert not rate[:3].any()
    c, sn, t = np.cos, np.sin, np.tan
    euler = np.array(
        [[1.0, sn(roll) * t(pitch), c(roll) * t(pitch)], [0.0, c(roll), -sn(roll)], [0.0, sn(roll) / c(pitch), c(roll) / c(pitch)]]
    ) @ s[13:16]  # fmt: skip
    step = 1e-6
    w, x, y, z = np.array([s[3:7] + step * rate[3:7], s[3:7] - step * rate[3:7]]).T
    found = [
        np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), np.arcsin(2 * (w * y - z * x)),
        np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
    ]  # fmt: skip
    np.testing.assert_allclose([(a[0] - a[1]) / (2.0 * step) for a in found], euler, atol=1e-8)
    # The first link's centre of mass as the paper prints it, z up in frame 0.
    at = kane.pose(puma(), Q)
    printed = [0.5 - 0.0389 * np.sin(0.3), 0.0389 * np.cos(0.3), -0.3088 + 0.2]
    np.testing.assert_allclose(puma().mount.T @ at.centre[1], printed, atol=1e-12)
    east = np.concatenate([[10.0, 20.0, 30.0, np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)], Q, np.zeros(9)])
    x_, y_, z_ = at.end
    np.testing.assert_allclose(kane.end_in_earth(puma(), east), [10.0 - y_, 20.0 + x_, 30.0 + z_], atol=1e-12)

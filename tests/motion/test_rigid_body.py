"""The rigid body in water: conserved quantities, closed forms, currents, flags, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.core.errors import InputError
from coeflab.motion.dynamics import rotations
from coeflab.motion.manoeuvre import Manoeuvre, Phase, Until
from coeflab.motion.simulators import rigid_body
from coeflab.motion.trajectory import Ended
from coeflab.vehicle.parameter_file import CoveredRange
from coeflab.vehicle.parameter_parts import ParameterHydrostatics
from tests.formats.massed import MASS
from tests.motion.fleet import SPEED, coasting, massive, swimmer, zigzag

Q = 0.5 * 1000.0 * 2.0**2
RK4 = {"integrator": "rk4", "step": 0.02}


def random_added(seed: int) -> np.ndarray:
    root = np.random.default_rng(seed).normal(size=(6, 6))
    return 5.0 * root @ root.T + np.diag([1.0, 20.0, 20.0, 0.1, 2.0, 2.0])


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_kinetic_energy_without_damping_and_thrust(seed: int) -> None:
    """A hundred seconds of tumbling, symmetric positive definite added mass at random: to 1e-9."""
    v = massive(random_added(seed))
    start = np.random.default_rng(seed + 50).normal(size=6) * np.array([1, 0.3, 0.3, 0.1, 0.1, 0.1])
    motion = rigid_body.simulate(v, coasting(100.0, start), {"tolerance": 1e-12, "record": 5.0})
    energy = 0.5 * np.einsum("ni,ij,nj->n", motion.velocity, v.effective_mass, motion.velocity)
    assert motion.ended is Ended.COMPLETE
    assert np.abs(energy / energy[0] - 1.0).max() < 1e-9
    assert np.ptp(motion.velocity[:, 1]) > 0.1


def test_momentum_of_a_body_without_fluid() -> None:
    """Linear and angular momentum in earth axes, about the earth's origin."""
    v = massive()
    motion = rigid_body.simulate(v, coasting(20.0, [1, 0.4, -0.3, 1.0, 0.6, 0.9]), {"tolerance": 1e-12, "record": 1.0})
    turned = rotations(motion.attitude)
    u, w = motion.velocity[:, :3], motion.velocity[:, 3:]
    linear = np.einsum("nij,nj->ni", turned, v.mass * (u + np.cross(w, v.centre)))
    own = np.einsum("nij,nj->ni", turned, w @ v.inertia.T + v.mass * np.cross(v.centre, u))
    angular = own + np.cross(motion.position, linear)
    for momentum in (linear, angular):
        assert np.abs(momentum - momentum[0]).max() < 1e-8 * np.abs(momentum[0]).max()
    assert np.abs(turned[-1] - turned[0]).max() > 0.5


@given(st.tuples(*[st.floats(-0.8, 0.8)] * 3))
@settings(max_examples=10, deadline=None)
def test_a_current_carries_the_motion_with_it(current: tuple[float, float, float]) -> None:
    v = swimmer()
    options = dict(zip(("north", "east", "down"), current, strict=True)) | RK4
    still, carried = (rigid_body.simulate(v, zigzag(v), o | RK4) for o in ({}, options))
    np.testing.assert_allclose(carried.velocity, still.velocity, rtol=1e-9, atol=1e-12)
    drift = still.time[:, None] * np.array(current)
    np.testing.assert_allclose(carried.position - still.position, drift, atol=1e-9)


@pytest.mark.parametrize("options", [{}, RK4])
def test_a_vehicle_at_rest_drifts_with_the_water(options: dict[str, object]) -> None:
    motion = rigid_body.simulate(swimmer(), coasting(10.0, [0] * 6), {"north": 0.5, "east": -0.25} | options)
    np.testing.assert_allclose(motion.velocity, 0.0, atol=1e-12)
    np.testing.assert_allclose(motion.position, motion.time[:, None] * [0.5, -0.25, 0.0], atol=1e-9)
    assert motion.ended is Ended.COMPLETE


@pytest.mark.parametrize("options", [{}, RK4])
def test_astern_is_safe_and_flagged(options: dict[str, object]) -> None:
    motion = rigid_body.simulate(swimmer(), coasting(10.0, [-1.0, 0.01, 0, 0, 0, 0], 1.0), options)
    assert motion.ended is Ended.COMPLETE
    assert np.isfinite(motion.velocity).all()
    assert motion.outside["astern"][0]
    assert not rigid_body.simulate(swimmer(), coasting(1.0, [1.0, 0, 0, 0, 0, 0])).outside["astern"].any()


@pytest.mark.parametrize("options", [{"tolerance": 1e-11}, RK4])
def test_speed_under_thrust_from_rest(options: dict[str, object]) -> None:
    """m du/dt = T - c u^2: u = U tanh(t sqrt(T c) / m), U = sqrt(T / c)."""
    v = massive(np.diag([6.0, 50.0, 50.0, 1.0, 9.0, 9.0]), np.zeros(3), {"X0": -2e-3}, free=("u",))
    thrust, drag, mass = 10.0, 2e-3 * Q, MASS + 6.0
    motion = rigid_body.simulate(v, coasting(120.0, [0] * 6, thrust), {"record": 1.0} | options)
    expected = np.sqrt(thrust / drag) * np.tanh(motion.time * np.sqrt(thrust * drag) / mass)
    np.testing.assert_allclose(motion.velocity[:, 0], expected, atol=1e-8)
    assert motion.velocity[-1, 0] == pytest.approx(np.sqrt(thrust / drag), rel=1e-5)


@pytest.mark.parametrize("options", [{"tolerance": 1e-11}, {"integrator": "rk4", "step": 0.01}])
def test_period_of_a_small_roll(options: dict[str, object]) -> None:
    """2 pi sqrt((Ix + A44) / (W h)) for a roll of 0.2 deg, h the height of buoyancy over gravity."""
    height = 0.06
    afloat = ParameterHydrostatics(volume=MASS / 1000.0, centre_of_buoyancy=(0.0, 0.0, 0.0), gravity=9.81)
    v = massive(
        np.diag([6.0, 50.0, 50.0, 1.5, 9.0, 9.0]), np.array([0.0, 0.0, height]), free=("p",), hydrostatics=afloat
    )
    roll = Until("roll", True, 0.0)
    phases = (Phase("a", {}, 30.0, roll), Phase("b", {}, 30.0, Until("roll", False, 0.0)), Phase("c", {}, 30.0, roll))
    tilt = np.radians(-0.2)
    motion = rigid_body.simulate(
        v, Manoeuvre("roll", phases, np.zeros(6), np.array([np.cos(tilt / 2), np.sin(tilt / 2), 0, 0])), options
    )
    first, _, second = motion.reached
    period = 2.0 * np.pi * np.sqrt((v.inertia[0, 0] + 1.5) / (MASS * 9.81 * height))
    assert second - first == pytest.approx(period, rel=2e-6)
    assert first == pytest.approx(period / 4.0, rel=2e-6)


def test_what_is_held_stays() -> None:
    v = swimmer()
    held = massive(v.added, free=("u", "v", "r"), values={"Yv": -0.04, "Nv": -0.01, "Nr": -0.01, "X0": -1e-3})
    motion = rigid_body.simulate(held, coasting(5.0, [1.0, 0.2, 0, 0, 0, 0.1]))
    np.testing.assert_array_equal(motion.velocity[:, 2:5], 0.0)
    np.testing.assert_allclose(motion.angles[:, :2], 0.0, atol=1e-12)
    assert "w, p, q fixed" in " ".join(motion.statements)


def test_flags_follow_the_ranges_of_the_file() -> None:
    covered = (
        CoveredRange(variable="asin(v/U)", low=-0.1, high=0.05, unit="rad", campaign="a"),
        CoveredRange(variable="asin(v/U)", low=0.04, high=0.2, unit="rad", campaign="b"),
        CoveredRange(variable="dr", low=-0.1, high=0.1, unit="rad", campaign="c"),
    )
    v = massive(values={"X0": -1e-3, "Nr": -0.01, "Ndr": -5e-3}, free=("u", "v", "r"), covered=covered)
    for drift, out in ((-0.11, True), (0.045, False), (0.15, False), (0.21, True)):
        start = [np.cos(drift), np.sin(drift), 0, 0, 0, 0]
        assert rigid_body.simulate(v, coasting(0.01, start)).outside["asin(v/U)"][0] == out
    turning = rigid_body.simulate(v, Manoeuvre("t", (Phase("t", {"dr": 0.12}, 1.0),), np.array([1.0, 0, 0, 0, 0, 0.3])))
    assert turning.outside["r': no data cover it"][0]
    assert turning.outside["dr"].all()
    assert "dr: no data cover it" not in turning.outside
    assert not any("w" in name for name in turning.outside)


def test_it_can_stop_where_the_coefficients_end() -> None:
    covered = tuple(
        CoveredRange(variable=n, low=-h, high=h, unit=u, campaign="a")
        for n, h, u in (("asin(v/U)", 0.05, "rad"), ("r'", 9.0, "1"))
    )
    v = massive(values={"X0": -1e-3, "Nr": -0.01, "Ndr": -5e-3}, free=("u", "v", "r"), covered=covered)
    plan = Manoeuvre("t", (Phase("turn", {}, 60.0),), np.array([1.0, 0, 0, 0, 0, 0.3]))
    motion = rigid_body.simulate(v, plan, {"outside": "stop"})
    assert motion.ended is Ended.OUT_OF_RANGE
    assert "outside of what the coefficients cover: asin(v/U)" in motion.why
    assert motion.outside["asin(v/U)"].tolist()[:-1] == [False] * (len(motion.time) - 1)
    assert f"{motion.time[-1]:.6g} s" in motion.why
    assert motion.time[-1] < 60.0


@pytest.mark.parametrize("options", [{}, RK4, RK4 | {"kernel": "numpy"}])
def test_a_runaway_stops_with_time_and_state(options: dict[str, object]) -> None:
    v = massive(values={"X0": -1e-3, "Yv": 0.5})
    motion = rigid_body.simulate(v, coasting(60.0, [1.0, 0.01, 0, 0, 0, 0]), options)
    assert motion.ended in (Ended.TOO_FAST, Ended.NOT_FINITE)
    assert f"stopped at {motion.time[-1]:.6g} s" in motion.why
    assert motion.time[-1] < 60.0
    assert np.isfinite(motion.velocity).all()


@pytest.mark.parametrize(
    ("phase", "word"),
    [
        (Phase("a", {"dr": 0.7}, 1.0), "at most 0.6 rad either way"),
        (Phase("a", {"ds": 0.1}, 1.0), "a control that a coefficient responds to"),
        (Phase("a", {"left": 1.0}, 1.0), 'the command "left"'),
        (Phase("a", {"dr": np.nan}, 1.0), "a finite number"),
        (Phase("a", {}, 0.0), "a longest time of 0 s"),
        (Phase("a", {}, 1.0, Until("colour", True, 0.0)), '"colour"'),  # type: ignore[arg-type]
    ],
)
def test_orders_that_cannot_be_followed(phase: Phase, word: str) -> None:
    for options in ({}, RK4):
        with pytest.raises(InputError) as refused:
            rigid_body.simulate(swimmer(), Manoeuvre("bad", (phase,), np.zeros(6)), options)
        assert word in str(refused.value)


def test_starts_and_plans_that_are_refused() -> None:
    v = swimmer()
    with pytest.raises(InputError, match="a manoeuvre without phases"):
        rigid_body.simulate(v, Manoeuvre("none", (), np.zeros(6)))
    with pytest.raises(InputError, match="a start that is not finite"):
        rigid_body.simulate(v, coasting(1.0, [np.nan, 0, 0, 0, 0, 0]))
    with pytest.raises(InputError, match="at most"):
        rigid_body.simulate(v, coasting(9.0, [SPEED, 0, 0, 0, 0, 0]), {"integrator": "rk4", "step": 2.0})
    with pytest.raises(InputError, match="compiled"):
        rigid_body.simulate(v, coasting(9.0, [SPEED, 0, 0, 0, 0, 0]), {"kernel": "fast"})


def test_added_mass_of_the_wrong_sign_is_refused() -> None:
    with pytest.raises(InputError, match="positive definite"):
        massive(values={"Yvdot": 0.1})

"""Computed torque and station keeping of a vehicle with an arm, thrusters in the loop."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.arm.chain import Chain
from coeflab.arm.control import (
    Controller,
    Station,
    controlled,
    demand,
    gain_of,
    most_thrust,
    wanted_accelerations,
)
from coeflab.arm.motion import at_rest, track_to
from coeflab.arm.thrusters import Thruster
from coeflab.core.errors import InputError
from coeflab.motion.trajectory import Ended
from coeflab.published.urv.model import VOLTAGE, wet

DENSITY = 1000.0


@pytest.fixture(scope="module")
def chain() -> Chain:
    return wet()


def at_once(chain: Chain) -> Chain:
    return replace(chain, thrusters=tuple(replace(t, model=None) for t in chain.thrusters))


def weaker(chain: Chain, strongest: float) -> Chain:
    return replace(
        chain, thrusters=tuple(replace(t, model=replace(t.model, strongest=strongest)) for t in chain.thrusters)
    )


def test_an_error_fades_as_the_law_says(chain: Chain) -> None:
    start = at_rest(chain)
    start[:3], start[7:10] = (0.2, -0.1, 0.3), chain.home + 0.05
    track = track_to(chain, chain.home, chain.home, 0.0, 1.0)
    run = controlled(at_once(chain), Controller(damping=2.0), track, 2.0, start=start, rows=0.5)
    slow, fast = 2.0 - np.sqrt(3.0), 2.0 + np.sqrt(3.0)

    def left(pace: float) -> np.ndarray:
        t = pace * run.time
        return (fast * np.exp(-slow * t) - slow * np.exp(-fast * t)) / (fast - slow)

    assert run.apart == pytest.approx(np.linalg.norm([0.2, -0.1, 0.3]) * left(1.0), abs=1e-5)
    assert run.q - run.wanted == pytest.approx(0.05 * left(4.0)[:, None] * np.ones(3), abs=1e-5)
    assert run.status == ()
    assert run.ended is Ended.COMPLETE


def test_a_turned_vehicle_comes_back_the_shorter_way(chain: Chain) -> None:
    station = Station(attitude=np.array([-1.0, 0.0, 0.0, 0.0]))
    still = track_to(chain, chain.home, chain.home, 0.0, 1.0)
    state = at_rest(chain)
    half = 0.15
    state[3:7] = np.cos(half), 0.0, 0.0, np.sin(half)
    asked = wanted_accelerations(Controller(vehicle_frequency=2.0), station, still, 3, 0.0, state)
    assert asked[3:6] == pytest.approx([0.0, 0.0, -8.0 * np.sin(half)])


def test_thrusters_too_weak_are_a_status(chain: Chain) -> None:
    track = track_to(chain, chain.home, chain.home + 0.2, 0.2, 0.8)
    run = controlled(weaker(chain, 0.02), Controller(), track, 1.0)
    assert run.ended is Ended.COMPLETE
    assert any(s.startswith("saturated: thruster ") for s in run.status)
    most = most_thrust(chain.thrusters[0], 0.02, DENSITY) / 5.0 * 0.02
    assert most == pytest.approx(0.4)
    assert np.abs(run.thrust).max() <= most * 1.001
    assert np.abs(run.ordered).max() > most
    strong = controlled(chain, Controller(), track, 1.0)
    assert not any("thruster" in s for s in strong.status)
    assert run.apart[-1] > 2.0 * strong.apart[-1]


def test_a_joint_at_its_end_ends_the_run_and_says_so(chain: Chain) -> None:
    elbow = replace(chain.links[2], joint=replace(chain.links[2].joint, high=0.6, strongest=1e-3))
    short = replace(chain, links=(*chain.links[:2], elbow))
    start = at_rest(short, rates=np.array([0.0, 0.0, 0.8]))
    run = controlled(short, Controller(), track_to(chain, chain.home, chain.home, 0.0, 1.0), 1.0, start=start)
    assert run.ended is Ended.OUT_OF_RANGE
    assert any("joint forearm is at its limit of 34.38 deg" in s for s in run.status)
    assert any(s.startswith("saturated: joint forearm from 0 s") for s in run.status)


def test_thrusters_without_full_rank_are_refused(chain: Chain) -> None:
    level = replace(chain, thrusters=chain.thrusters[:4])
    with pytest.raises(InputError, match="no heave, no roll, no pitch"):
        controlled(level, Controller(), track_to(chain, chain.home, chain.home, 0.0, 1.0), 1.0)


def test_station_keeping_without_the_model_does_worse(chain: Chain) -> None:
    track = track_to(chain, chain.home, chain.home + 0.5, 0.2, 1.6)
    known, simple = (
        controlled(at_once(chain), Controller(law), track, 2.0, rows=0.2) for law in ("computed_torque", "station")
    )
    assert known.apart.max() < 1e-6
    assert 1e-4 < simple.apart.max() < 0.05
    assert known.end_apart.max() < 1e-4 < simple.end_apart.max()


@pytest.mark.parametrize("thrust", [30.0, -30.0])
@pytest.mark.parametrize("kind", ["torque", "voltage"])
def test_a_propeller_comes_to_the_speed_of_its_thrust(chain: Chain, thrust: float, kind: str) -> None:
    one = chain.thrusters[0] if kind == "torque" else replace(chain.thrusters[0], model=VOLTAGE)
    gain, state = gain_of(one, DENSITY), np.zeros(one.order)
    for _ in range(2000):
        rate = one.model.rates(state, demand(one, gain, thrust, state, 10.0, DENSITY), DENSITY)
        state = state + 1e-3 * rate
    assert one.model.force(state, DENSITY) == pytest.approx(thrust, rel=1e-3)
    settled = one.model.steady(thrust, DENSITY)[1]
    assert demand(one, gain, thrust, settled, 10.0, DENSITY) == pytest.approx(
        one.model.steady(thrust, DENSITY)[0], rel=1e-3
    )
    far = demand(one, gain, 1e5 * thrust, state, 10.0, DENSITY)
    assert far == np.sign(thrust) * one.model.strongest


@pytest.mark.parametrize("kind", ["torque", "voltage"])
def test_the_largest_thrust_is_that_of_the_strongest_drive(chain: Chain, kind: str) -> None:
    one = chain.thrusters[0] if kind == "torque" else replace(chain.thrusters[0], model=VOLTAGE)
    most = most_thrust(one, gain_of(one, DENSITY), DENSITY)
    assert one.model.steady(most, DENSITY)[0] == pytest.approx(one.model.strongest, rel=1e-6)
    endless = replace(one, model=replace(one.model, strongest=np.inf))
    assert most_thrust(endless, 1.0, DENSITY) == np.inf
    without = Thruster("at once", np.zeros(3), np.array([1.0, 0.0, 0.0]))
    assert demand(without, gain_of(without, DENSITY), 7.0, np.zeros(0), 10.0, DENSITY) == 7.0


@pytest.mark.parametrize("name", ["vehicle_frequency", "joint_frequency", "damping", "propeller_rate"])
def test_gains_are_above_zero(name: str) -> None:
    with pytest.raises(InputError, match="a value above zero"):
        Controller(**{name: 0.0})

"""Stern-plane jam: against the closed form of a vehicle that can only pitch, and what the options refuse."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import coeflab as cf
from coeflab.core.errors import InputError
from coeflab.vehicle.parameter_file import ParameterFile
from tests.motion.trimmed import LENGTH, SPEED, parameter_file

INERTIA, DAMPING, STERN, BOW = 4.0, -3.0, -1.6, 1.1  # kg m^2, and N m by rad/s and rad at 1 m/s
JAM, AGAINST, REACTION = np.radians(8.0), np.radians(15.0), 2.5


def pitching() -> ParameterFile:
    si = {"Mq": DAMPING, "Mds": STERN, "Mdb": BOW, "X0": -1.0, "Zw": -5.0}
    return parameter_file(si, 60.0, (1.0, INERTIA, INERTIA))


def pitch(t: float, torque: float, rate: float, start: float) -> tuple[float, float]:
    """Rate and pitch after t under a constant torque: I q_dot = Mq q + torque."""
    fading, steady = np.exp(DAMPING / INERTIA * t), -torque / DAMPING
    return steady + (rate - steady) * fading, start + steady * t + (rate - steady) * (fading - 1.0) * INERTIA / DAMPING


@pytest.mark.parametrize(("way", "sign"), [("dive", -1.0), ("rise", 1.0)])
def test_excursions_are_those_of_the_closed_form(way: str, sign: float) -> None:
    """Jammed: torque Mds ds; recovered by the bow planes, freed stern planes 1 s later."""
    run = cf.simulate(
        pitching(),
        "stern_plane_jam",
        free=("q",),
        planes=JAM,
        bow=AGAINST,
        reaction=REACTION,
        freed=1.0,
        way=way,
        record=0.01,
    )
    jam, against = sign * abs(STERN) * JAM, -sign * abs(BOW) * AGAINST
    first = pitch(REACTION, jam, 0.0, 0.0)
    second = pitch(1.0, jam + against, *first)
    level = brentq(lambda t: pitch(t, against, *second)[1], 0.01, 60.0)
    depth = -SPEED * quad(lambda t: np.sin(pitch(t, jam, 0.0, 0.0)[1]), 0.0, REACTION)[0]
    on = -SPEED * quad(lambda t: np.sin(pitch(t, jam + against, *first)[1]), 0.0, 1.0)[0]
    back = -SPEED * quad(lambda t: np.sin(pitch(t, against, *second)[1]), 0.0, level)[0]
    assert run["pitch at recovery"].value == pytest.approx(abs(first[1]), rel=1e-5)
    assert run["depth at recovery"].value == pytest.approx(abs(depth), rel=1e-5)
    assert run["time to level"].value == pytest.approx(REACTION + 1.0 + level, rel=1e-6)
    assert run["depth excursion"].value == pytest.approx(abs(depth + on + back), rel=1e-4)
    assert run["depth excursion"].value > 2.0 * run["depth at recovery"].value


@pytest.mark.parametrize(("way", "reaction"), [("dive", 8.0), ("rise", 8.0), ("dive", 13.0)])
def test_pitch_counts_on_past_the_vertical(way: str, reaction: float) -> None:
    """Freed and against at once: the closed form turns back beyond 105 deg, or goes on over its back, which is not level."""
    jammed, against = abs(STERN) * 0.5, abs(BOW) * 0.6
    run = cf.simulate(
        pitching(), "stern_plane_jam", free=("q",), planes=0.5, bow=0.6, reaction=reaction, freed=1e-3, way=way, record=0.01,
    )  # fmt: skip
    first = pitch(reaction, jammed, 0.0, 0.0)
    turned = brentq(lambda t: pitch(t, -against, *first)[0], 0.0, 20.0)
    assert run["largest pitch"].value == pytest.approx(pitch(turned, -against, *first)[1], rel=2e-3)
    assert run["pitch at recovery"].value == pytest.approx(first[1], rel=1e-4)
    assert np.pi / 2.0 < first[1]
    assert (run["time to level"].value is not None) == (pitch(turned, -against, *first)[1] < np.pi)


def test_the_crew_acts_after_three_lengths_unless_asked_otherwise() -> None:
    run = cf.simulate(pitching(), "stern_plane_jam", free=("q",), planes=JAM, longest=5.0)
    first = pitch(3.0 * LENGTH / SPEED, -abs(STERN) * JAM, 0.0, 0.0)
    assert run["pitch at recovery"].value == pytest.approx(-first[1], rel=1e-4)
    assert run["time to level"].value is None


def test_power_off_slows_it_down() -> None:
    on, off = (
        cf.simulate("remus100", "stern_plane_jam", free="uwq", planes="3 deg", power=p, longest=20.0)
        for p in (1.0, 0.0)
    )
    assert off["speed at the end"].value < 0.6 * on["speed at the end"].value


@pytest.mark.parametrize(
    ("more", "column"),
    [({"free": ("q",), "power": 0.5}, "power"), ({"free": ("q",), "planes": "x"}, "planes"), ({"way": "left"}, "way")],
)
def test_what_it_refuses(more: dict[str, object], column: str) -> None:
    with pytest.raises(InputError) as refused:
        cf.simulate(pitching(), "stern_plane_jam", **more)
    assert column in str(refused.value)

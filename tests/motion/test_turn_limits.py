"""Where the turn of an unstable vehicle ends: terms in v limit it too, and the reason for no figure is that r' has no data."""

from __future__ import annotations

import json
from math import asin, cos, degrees, log, sin, tan

import numpy as np
import pytest
from scipy.optimize import fsolve

from coeflab.motion import turn_limits
from coeflab.motion.simulation import moved, simulate
from coeflab.motion.turn_limits import E_FOLDS, FARTHEST, FIRST, open_turn, settled_turn, unlimited
from coeflab.study.study import Study
from coeflab.vehicle.parameter_file import CoveredRange, ParameterFile
from tests.motion.vehicles import UNSTABLE, made

LIMITED = {**UNSTABLE, "Yv|v|": -0.3, "Nv|v|": 0.25, "Nvvv": 0.1}


def covering(file: ParameterFile, **limits: float) -> ParameterFile:
    names = {"drift": ("asin(v/U)", "rad"), "rate": ("r'", "1")}
    ranges = tuple(
        CoveredRange(variable=names[n][0], low=-x, high=x, unit=names[n][1], campaign="made") for n, x in limits.items()
    )
    return file.model_copy(update={"covered": ranges})


def test_suboffs_rudder_amidships(suboff: Study) -> None:
    """From the numbers of its file alone: 0 = Y' - m' r' cos(beta), 0 = N' - m' x_G' r' cos(beta)."""
    file = suboff.parameter_files["suboff_fully_appended"]
    content = json.loads(file.to_json())
    c = {x["symbol"].rstrip("'"): x["value"] for x in content["coefficients"]}
    mass, moment = content["mass"]["mass_prime"], content["mass"]["mass_moment_prime"]

    def balance(state: np.ndarray, carried: bool = True) -> tuple[float, float]:
        drift, r = state
        v, along = -sin(drift), cos(drift) if carried else 1.0
        side = c["Yv"] * v + c["Yv|v|"] * v * abs(v) + c["Yvvv"] * v**3 + (c["Yr"] - mass * along) * r
        turn = c["Nv"] * v + c["Nv|v|"] * v * abs(v) + (c["Nr"] - moment * along) * r
        return side, turn

    drift, rate = fsolve(balance, (0.1, 0.3))
    body = moved(file, "turning_circle")
    found = settled_turn(body, "r", body.speed)
    assert (found.angle, found.rate) == pytest.approx((drift, rate), rel=1e-6)
    assert (degrees(drift), rate) == pytest.approx((7.6, 0.36), rel=0.01)
    plain = fsolve(lambda s: balance(s, carried=False), (0.1, 0.3))  # with m' r' in place of m' r' cos(beta)
    assert (degrees(plain[0]), plain[1]) == pytest.approx((7.8, 0.366), rel=0.005)
    tested = [x for x in content["covered"] if x["variable"] == "asin(v/U)"]
    assert min(min(-x["low"], x["high"]) for x in tested) > drift
    assert "no data on r'" in unlimited(body, "r", body.speed)


def test_terms_in_v_end_a_turn_and_data_on_both_determine_it() -> None:
    """Before: not determined, since no term in r|r| stood in the file."""
    bare = moved(made(LIMITED), "turning_circle", free=("u", "v", "r"))
    found = settled_turn(bare, "r", bare.speed)
    side = LIMITED["Yv"] * (v := -sin(found.angle)) + LIMITED["Yv|v|"] * v * abs(v)
    turn = LIMITED["Nv"] * v + LIMITED["Nv|v|"] * v * abs(v) + LIMITED["Nvvv"] * v**3 + LIMITED["Nr"] * found.rate
    mass = bare.mass / (0.5 * bare.density * bare.length**3)
    assert side + LIMITED["Yr"] * found.rate == pytest.approx(mass * found.rate * cos(found.angle), rel=1e-5)
    assert turn == pytest.approx(0.0, abs=1e-6)
    reason = open_turn(bare, "r", bare.speed)
    assert (reason["case"], reason["angle"]) == ("settles_bare", pytest.approx(degrees(found.angle)))
    for limits, open_ in (
        ({"drift": 1.1, "rate": 3.0}, False),
        ({"drift": 0.01, "rate": 3.0}, True),
        ({"drift": 1.1}, True),
    ):
        body = moved(covering(made(LIMITED), **limits), "turning_circle", free=("u", "v", "r"))
        assert bool(unlimited(body, "r", body.speed)) is open_, limits


def test_a_term_in_r_that_ends_nothing_determines_nothing() -> None:
    driven = moved(made({**UNSTABLE, "Nr|r|": 1e-3}), "turning_circle", free=("u", "v", "r"))
    assert (
        unlimited(driven, "r", driven.speed) == "unstable, no data on r', and nothing in the file's law ends the turn"
    )
    damped = moved(made({**UNSTABLE, "Nr|r|": -4e-2}), "turning_circle", free=("u", "v", "r"))
    assert unlimited(damped, "r", damped.speed) == ""


def test_a_steady_turn_by_the_equations_of_motion_is_that_of_the_balance() -> None:
    """The residual rate of a pull-out, marched in time, against the balance; the speed is held."""
    file = covering(made(LIMITED), drift=1.1, rate=3.0)
    out = simulate(file, "pull_out", {}, free=("v", "r"))
    body = moved(file, "pull_out", free=("v", "r"))
    found = settled_turn(body, "r", body.speed)
    (right, _) = (f.value for f in out.figures)
    assert right == pytest.approx(found.rate * np.hypot(1.0, tan(found.angle)) * body.speed / body.length, rel=1e-3)
    assert asin(sin(found.angle)) == found.angle


@pytest.mark.parametrize(("folds", "found"), [(5.0, False), (25.0, True), (60.0, True)])
def test_a_turn_is_waited_for_until_it_is_steady(monkeypatch: pytest.MonkeyPatch, folds: float, found: bool) -> None:
    """A small disturbance takes five e-fold times to the size of the turn, and some more to settle."""
    monkeypatch.setattr(turn_limits, "E_FOLDS", folds)
    bare = moved(made(LIMITED), "turning_circle", free=("u", "v", "r"))
    assert (settled_turn(bare, "r", bare.speed) is not None) == found


def test_what_is_waited_leaves_room_for_turns_that_settle_slowly() -> None:
    """From the first disturbance to the farthest state: five to six times as long as pure growth takes."""
    assert 5.0 < E_FOLDS / log(FARTHEST / FIRST) < 6.0

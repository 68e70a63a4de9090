"""The force law as a sum: what of coefficients, tables, controls and the ideal fluid speaks, in every plane, once."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.identify.tune import tune
from coeflab.identify.tuning_plan import read_tuning_plan
from coeflab.law.terms import Term
from coeflab.motion.manoeuvre import Manoeuvre, Phase
from coeflab.motion.rates_of_one import term_force_of_one
from coeflab.motion.simulators import rigid_body
from coeflab.motion.trajectory import Ended
from coeflab.motion.trim.trim import trim
from coeflab.motion.vehicle import vehicle
from coeflab.vehicle.force_law import force_law, full_force, known_with_terms, motion_law, not_used
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.parameter_model import ParameterModel
from tests.vehicle.hybrid import (
    ADDED,
    AREA,
    DRAG,
    LENGTH,
    M_Q,
    M_QQ,
    N_R,
    N_RR,
    RATES,
    REACH,
    RHO,
    SIDE,
    Y_R,
    Z_Q,
    hybrid,
    surface,
    tables,
    turn,
)  # fmt: skip
from tests.vehicle.test_force_law import HULL, parameters
from tests.vehicle.test_motion_terms import table

TURNS = ((50, 60), (30, 60), (20, 60), (0, 60), (60, 25))


def force(file: ParameterFile, tables: bool = False, controls: tuple[float, ...] = (0, 0, 0), **moving: float) -> Any:
    """X Y Z K M N by name."""
    nu = np.array([[moving.get(m, 0.0) for m in "uvwpqr"]])
    found = motion_law(file, tables)[0].force(nu, np.array([controls], dtype=float))[0]
    return dict(zip("XYZKMN", found, strict=True))


@pytest.mark.parametrize("first", [False, True])
def test_tables_and_rates_add_up_in_either_order(first: bool) -> None:
    """README of the case: N at r = -.3 was 0 with --tables, X at u = 1 was 0 without."""
    yaw = force(hybrid(), first, u=1.0, r=-0.3)
    assert yaw["N"] == pytest.approx(N_R * -0.3 + N_RR * -0.09)
    assert yaw["Y"] == pytest.approx(Y_R * -0.3)
    assert yaw["X"] == pytest.approx(-0.5 * RHO * AREA * 0.35)
    pitch = force(hybrid(), first, u=1.0, q=0.3)
    assert (pitch["M"], pitch["Z"]) == pytest.approx((M_Q * 0.3 + M_QQ * 0.09, Z_Q * 0.3))


def test_a_cross_term_of_the_added_mass_is_there_once_and_no_other_of_a_product_that_is_spoken_of() -> None:
    """X_vr = m_y v r, and no Munk moment beside C_n, no -X_udot u r beside Yr."""
    file = hybrid()
    both = force(file, u=1.0, v=0.1, r=0.2)["X"] - force(file, u=1.0, v=0.1)["X"]
    assert both == pytest.approx(ADDED[1, 1] * 0.1 * 0.2)
    b = np.arctan2(0.1, 1.0)
    assert force(file, u=1.0, v=0.1)["N"] == pytest.approx(0.5 * RHO * 1.01 * AREA * LENGTH * (0.06 * b + 0.3 * b**3))
    assert not np.any(force_law(file).ideal[5, 0, 1])
    assert not np.any(force_law(file).ideal[1, 0, 5])


def straight_then(orders: dict[str, float], time: float) -> Manoeuvre:
    """Orders to the thrusters on a straight course."""
    return Manoeuvre("turn", (Phase("turn", orders, time),), np.array([1.5, 0.0, 0.0, 0.0, 0.0, 0.0]))


@pytest.mark.parametrize(("left", "right"), TURNS)
def test_trim_and_simulation_turn_as_an_independent_solution_does(left: float, right: float) -> None:
    truth, orders = turn(left, right), {"left": float(left), "right": float(right)}
    trimmed = trim(vehicle(hybrid(), free=("u", "v", "r")), {}, orders).velocity[[0, 1, 5]]
    assert trimmed == pytest.approx(truth, rel=1e-6)
    moved = rigid_body.simulate(vehicle(hybrid(), free=("u", "v", "r")), straight_then(orders, 60.0))
    assert moved.ended is Ended.COMPLETE
    assert moved.velocity[-1, [0, 1, 5]] == pytest.approx(truth, rel=1e-5)


def test_without_anything_left_out_nothing_is_found() -> None:
    assert not_used(hybrid()) == ()


def test_of_the_same_products_the_source_over_more_variables_speaks() -> None:
    """X0', Xvv' and Zw' are within C_D and C_L over alpha and beta; Xrr', Xvr' and Kp are not."""
    more = {**RATES, "X0": -9.0, "Xvv": 4.0, "Zw": -50.0, "Xrr": 1.5, "Kp": -2.0}
    units = {"X0": 2, "Xvv": 2, "Zw": 2, "Xrr": 4, "Kp": 4}
    file = hybrid()
    added = parameters({s: v / (0.5 * RHO * LENGTH ** units[s]) for s, v in more.items() if s in units})
    both = file.model_copy(update={"coefficients": (*file.coefficients, *added.coefficients)})
    found = {f.code: f for f in not_used(both)}
    assert set(found) == {"law.coefficients_unused"}
    assert {s for f in not_used(both) for s in f["coefficients"]} == {"X0'", "Xvv'", "Zw'"}
    at = {"u": 1.2, "v": 0.2, "w": 0.1, "p": 0.3, "r": 0.4}
    before, after = force(file, **at), force(both, **at)
    speed = np.sqrt(1.2**2 + 0.2**2 + 0.1**2)
    assert after["X"] - before["X"] == pytest.approx(1.5 * 0.4**2)
    assert after["Z"] == pytest.approx(before["Z"])
    assert after["K"] == pytest.approx(before["K"] - 2.0 * speed * 0.3)


def test_coefficients_that_cover_a_table_speak_before_it_unless_tables_come_first() -> None:
    file = parameters({"Nv": -0.02, "Nr": -0.01}).model_copy(update={"models": (table("N'", {"v": 0.5}),)})
    (found,) = not_used(file)
    assert (found.code, found["by"]) == ("law.table_unused", ("Nv'",))
    unit = 0.5 * RHO * LENGTH**3
    at = {"u": 1.0, "v": 0.1, "r": 0.2}
    speed = np.hypot(1.0, 0.1)
    rate = -0.01 * unit * LENGTH * speed * 0.2
    assert force(file, **at)["N"] == pytest.approx(-0.02 * unit * speed * 0.1 + rate)
    (found,) = not_used(file, tables=True)
    assert (found.code, found["coefficients"]) == ("law.coefficients_unused", ("Nv'",))
    assert force(file, tables=True, **at)["N"] == pytest.approx(0.5 * unit * speed * 0.1 + rate)


def test_a_table_of_one_component_stands_beside_coefficients_of_the_others() -> None:
    file = parameters({"X0": -0.002, "Yv": -0.03, "Zw": -0.04, "Nr": -0.01}).model_copy(
        update={"models": (surface("C_n", {(("beta", 1),): 0.06}),)}
    )
    assert not_used(file) == ()
    found = force(file, u=1.0, v=0.1, w=0.05)
    speed, b = np.sqrt(1.0125), np.arcsin(0.1 / np.sqrt(1.0125))
    assert found["N"] == pytest.approx(0.5 * RHO * speed**2 * AREA * LENGTH * 0.06 * b)
    assert found["Y"] == pytest.approx(-0.03 * 0.5 * RHO * LENGTH**2 * speed * 0.1)
    assert found["Z"] == pytest.approx(-0.04 * 0.5 * RHO * LENGTH**2 * speed * 0.05)
    assert found["X"] == pytest.approx(-0.002 * 0.5 * RHO * LENGTH**2 * speed**2)


def test_drag_alone_leaves_side_force_and_heave_to_body_axes_that_state_them() -> None:
    """-D sin(beta) is within a measured Yv; without one it is all that Y has."""
    lone = parameters({"Nr": -0.01}).model_copy(update={"models": (surface("C_D", DRAG),)})
    still_known = parameters({"Nr": -0.01, "Yv": -0.03}).model_copy(update={"models": (surface("C_D", DRAG),)})
    b, q = np.arctan2(0.1, 1.0), 0.5 * RHO * 1.01 * AREA
    drag = q * (0.35 + 1.1 * b * b)
    assert force(lone, u=1.0, v=0.1)["Y"] == pytest.approx(-np.sin(b) * drag)
    assert force(still_known, u=1.0, v=0.1)["Y"] == pytest.approx(-0.03 * 0.5 * RHO * LENGTH**2 * np.sqrt(1.01) * 0.1)
    assert force(still_known, u=1.0, v=0.1)["X"] == pytest.approx(-np.cos(b) * drag)
    assert [f.code for f in not_used(still_known)] == ["law.wind_partly"]


def control(response: str, over: str) -> ParameterModel:
    """An increment over a control and the attack: every term has the control in it."""
    content = surface(response, {(("alpha", 1), ("beta", 1)): 0.5, (("beta", 1),): 0.8}).model_dump()
    content["variables"] = [{"name": "alpha", "unit": "rad"}, {"name": over, "unit": "rad"}]
    for t in content["terms"]:
        t["factors"] = [f | {"variable": over if f["variable"] == "beta" else f["variable"]} for f in t["factors"]]
    return ParameterModel.model_validate(content)


def test_an_increment_over_a_control_adds_to_tables_and_slopes_and_closes_no_product_of_the_ideal_fluid() -> None:
    file = hybrid(models=(*tables(), control("C_m", "ds")))
    at = {"u": 1.0, "w": 0.1, "q": 0.2}
    more = force(file, controls=(0, 0.2, 0), **at)["M"] - force(file, **at)["M"]
    q, a = 0.5 * RHO * 1.01 * AREA * LENGTH, np.arctan2(0.1, 1.0)
    assert more == pytest.approx(q * (0.5 * a * 0.2 + 0.8 * 0.2))
    bare = parameters({"Mq": -0.01, "Mds": -0.02}, HULL).model_copy(update={"models": (control("C_m", "ds"),)})
    assert np.any(motion_law(bare)[0].ideal[4, 0, 2])
    assert {f.code for f in not_used(bare)} == {"law.coefficients_unused"}


@pytest.mark.parametrize("unit", ["1", "N*m"])
def test_tables_in_prime_and_in_si_have_the_force_that_they_state(unit: str) -> None:
    """N' of r' alone, by 1/2 rho V^2 L^3; N in N m over r in rad/s whatever the speed."""
    model = table("N'" if unit == "1" else "N", {"r": -0.02}, ("r",)).model_dump()
    model["unit"] = unit
    model["variables"][0]["unit"] = "1" if unit == "1" else "rad/s"
    file = parameters({"Yv": -0.03, "Nv": -0.02}).model_copy(update={"models": (ParameterModel.model_validate(model),)})
    found = force(file, u=2.0, r=0.1)["N"]
    due = -0.02 * 0.1 if unit != "1" else -0.02 * (0.1 * LENGTH / 2.0) * 0.5 * RHO * 4.0 * LENGTH**3
    assert found == pytest.approx(due)
    assert not_used(file) == ()


def test_of_two_tables_the_one_over_more_variables_speaks_and_a_half_overlap_is_refused() -> None:
    one, two = table("C_n", {"v": 0.1}), surface("C_n", {(("beta", 1),): 0.06, (("alpha", 1), ("beta", 1)): 0.1})
    file = parameters({"Yv": -0.03}).model_copy(update={"models": (one, two)})
    (found,) = not_used(file)
    assert (found.code, found.subject, found["by"]) == ("law.table_unused", "C_n over v", ("C_n over alpha and beta",))
    other = table("N'", {"v": 0.1, "r": 0.1}, ("v", "r"))
    with pytest.raises(InputError, match="both with a force of N by v"):
        motion_law(parameters({"Yv": -0.03}).model_copy(update={"models": (two, other)}))


def test_a_file_of_an_earlier_version_is_read_as_the_sum_and_says_so() -> None:
    file = hybrid().model_copy(update={"schema_version": "1.5"})
    (found,) = not_used(file)
    assert (found.code, found["version"]) == ("law.older_rule", "1.5")
    assert set(found["components"]) == set("XYZMN")
    assert force(file, u=1.0, r=-0.3) == pytest.approx(force(hybrid(), u=1.0, r=-0.3))


CORNER = [[1.0, 1.0, -0.4], [-1.0, 1.0, -0.4], [1.0, -1.0, -0.4], [-1.0, -1.0, -0.4]]  # |alpha| + |beta| <= 0.4


@pytest.mark.parametrize("rule", ["clamp", "refuse", "taper"])
def test_one_reading_of_a_domain_in_law_and_table(rule: str) -> None:
    """Outside the hull and inside its box; and by every way in which a motion evaluates the law."""
    models = tuple(surface(n, t, rule, spaces=CORNER) for n, t in (("C_D", DRAG), ("C_S", SIDE)))
    file = hybrid(models=models)
    for a, b in ((0.1, 0.1), (0.3, 0.3), (0.22, 0.19), (0.4, -0.3)):
        nu = np.array([[0.8 * np.cos(b) * np.cos(a), 0.8 * np.sin(b), 0.8 * np.cos(b) * np.sin(a), 0, 0, 0]])
        values = [m.evaluate({"alpha": np.array([a]), "beta": np.array([b])})[0][0] for m in models]
        q = 0.5 * RHO * 0.64 * AREA
        due = -q * (np.cos(a) * np.cos(b) * values[0] + np.cos(a) * np.sin(b) * values[1])
        found = full_force(file)(nu, np.zeros((1, 3)))[0, 0]
        assert found == pytest.approx(due, rel=1e-9, nan_ok=True)
        assert np.isnan(found) == (rule == "refuse" and abs(a) + abs(b) > 0.4 + 1e-9)
        law = motion_law(file)[0]
        state = [*np.zeros(7), *nu[0], 0.0]
        assert term_force_of_one(law)(state, [0.0, 0.0, 0.0]) == pytest.approx(
            law.term_force(nu.T, np.zeros((3, 1)))[:, 0]
        )


def test_the_three_rules_differ_outside_the_hull() -> None:
    nu, a = np.zeros((1, 6)), 0.21
    nu[0, :3] = 0.8 * np.cos(a) ** 2, 0.8 * np.sin(a), 0.8 * np.cos(a) * np.sin(a)
    by = {
        rule: full_force(hybrid(models=(surface("C_D", DRAG, rule, spaces=CORNER),)))(nu, np.zeros((1, 3)))[0, 0]
        for rule in ("clamp", "taper", "refuse")
    }
    assert np.isnan(by["refuse"])
    assert by["clamp"] > by["taper"]  # drag grows outwards


@pytest.mark.slow
@pytest.mark.parametrize("rule", ["clamp", "refuse"])
def test_a_motion_ends_where_a_table_has_no_value(rule: str) -> None:
    """The turn drifts by 14 deg; the table ends at .05 rad, of all incidence the hull that is no box."""
    low = [[1.0, 0.0, -REACH], [-1.0, 0.0, -REACH], [0.1, 1.0, -0.05], [0.0, -1.0, -0.05]]
    file = hybrid(models=tables(rule, spaces=low))
    orders = {"left": 0.0, "right": 60.0}
    found = trim(vehicle(file, free=("u", "v", "r")), {}, orders)
    assert [f.code for f in found.refused] == (["law.refused_point"] if rule == "refuse" else [])
    body = vehicle(file, free=("u", "v", "r"))
    plan = straight_then(orders, 3.0)
    for how in (
        {},
        {"integrator": "rk4", "step": 0.02, "kernel": "numpy"},
        {"integrator": "rk4", "step": 0.02, "kernel": "compiled"},
    ):
        moved = rigid_body.simulate(body, plan, how)
        drift = np.arctan2(moved.velocity[:, 1], moved.velocity[:, 0])
        assert (moved.ended is Ended.OUT_OF_RANGE) == (rule == "refuse")
        assert (drift.max() > 0.06) == (rule == "clamp")


def test_tables_stay_known_where_other_terms_are_to_be_found_from_data() -> None:
    """Identification of Nr and Nr|r| knows C_n; that of Nv does not, and says so."""
    nu = np.array([[1.0, 0.1, 0.05, 0.0, 0.0, 0.3]])
    rates, slope = Term((("r", 1, False),)), Term((("v", 1, False),))
    law, found = known_with_terms(hybrid(), [("Nr", "N", rates)])
    assert [f.code for f in found] == ["law.edge"]
    whole = motion_law(hybrid())[0]
    tabled = [t.symbol for t in whole.terms if t.kind == "table"]
    assert [t.symbol for t in law.terms] == tabled
    law, found = known_with_terms(hybrid(), [("Nr", "N", rates), ("Nv", "N", slope)])
    assert [f["by"] for f in found if f.code == "law.table_unused"] == [("Nv'",)]
    assert law.force(nu)[0, 5] == 0.0
    assert law.force(nu)[0, :5] == pytest.approx(known_with_terms(hybrid(), [("Nr", "N", rates)])[0].force(nu)[0, :5])


def test_tuning_finds_planted_constants_of_a_table_and_of_a_rate_within_their_intervals(tmp_path: Path) -> None:
    """Turns of the independent solution; the file to tune is off by 15 and 20 %."""
    planted = hybrid()
    off = hybrid({**RATES, "Nr": 1.2 * N_R}, (*tables()[:1], surface("C_S", {k: v * (0.85 if k == (("beta", 1),) else 1.0) for k, v in SIDE.items()}), *tables()[2:]))  # fmt: skip
    (tmp_path / "off.parameters.json").write_bytes(off.to_json())
    rows = [(left, right, *turn(left, right)) for left, right in TURNS]
    lines = [f"{a},{b},{u:.6f},{v:.6f},{r:.6f},pool" for a, b, u, v, r in rows]
    head = "left [%],right [%],u [m/s],v [m/s],r [rad/s],source"
    (tmp_path / "turns.csv").write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")
    (tmp_path / "tune.toml").write_text(
        '[tune]\nname = "own"\nparameters = "off.parameters.json"\n[measured]\ntable = "turns.csv"\nwhere = { source = "pool" }\n'
        'errors = { u = "0.01 m/s", v = "0.003 m/s", r = "0.003 rad/s" }\n'
        "[[free]]\nplaces = [\"Nr'\"]\n[[free]]\nplaces = [\"C_S C_S_0\"]\n", encoding="utf-8",
    )  # fmt: skip
    found = tune(read_tuning_plan(tmp_path / "tune.toml")).tuning
    due = {"Nr'": planted.coefficient("Nr").value, "C_S C_S_0": SIDE[(("beta", 1),)]}
    assert found.converged
    for name, value in due.items():
        p = found.parameter(name)
        assert abs(p.after - value) <= p.u95
        assert abs(p.before - value) > 2.0 * abs(p.after - value)

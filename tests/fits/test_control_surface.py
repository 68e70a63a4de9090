"""A control surface over delta - alpha: coefficients back, signs, tied terms, coverage, bad input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.statistics.least_squares import factorise, solve
from coeflab.fits.statistics.robust_errors import bell_mccaffrey, hc_variance, t_factor
from coeflab.law.terms import design
from coeflab.law.transforms import body_forces
from coeflab.tables.force_table import ForceTable
from coeflab.vehicle.recorded import recorded
from tests.fits.shipped import rows, tables

# Chosen in cfd_data/make_synthetic_vehicles.py: the HUUV paper plots its own and prints none.
CHOSEN = {"C_D0": 0.03, "C_D2": 1.1, "C_L1": -2.4, "C_L3": 1.5, "C_m1": 0.45, "C_m3": -0.3}
AREA, LENGTH, SPEED, DENSITY = 0.02, 0.2, 0.5, 1000.0
BY_AREA = {"area": AREA, "area_name": "planform"}
CAMPAIGNS = 20_000


def table() -> ForceTable:
    return tables("huuv_elevator_synthetic")[0]


def fitted(t: ForceTable, **options: object) -> FitResult:
    return FITS.load("control_surface").fit([t], t.scaling, options)


def listing(result: FitResult, response: str) -> FittedModel:
    return next(m for m in result.models if m.response == response and "e" in m.x)


def over_both(result: FitResult, response: str) -> FittedModel:
    return next(m for m in result.models if m.response == response and "e" not in m.x)


def angles(t: ForceTable) -> tuple[np.ndarray, np.ndarray]:
    return np.asarray(t.controls["ds"]), np.arctan2(t.motion["w"], t.motion["u"])


def with_law(t: ForceTable, effective: np.ndarray, k: dict[str, float]) -> ForceTable:
    """The table with exact forces of a law over an effective angle."""
    q = 0.5 * DENSITY * SPEED**2 * AREA
    drag = q * (k["C_D0"] + k["C_D2"] * effective**2)
    lift = q * (k["C_L1"] * effective + k["C_L3"] * effective**3)
    moment = q * LENGTH * (k["C_m1"] * effective + k["C_m3"] * effective**3)
    alpha, none = angles(t)[1], np.zeros(len(t))
    x, _, z = body_forces(alpha, none, drag, none, lift)
    return replace(t, forces={"X": x, "Z": z, "M": moment})


def exact() -> ForceTable:
    delta, alpha = angles(table())
    return with_law(table(), delta - alpha, CHOSEN)


def test_the_chosen_coefficients_come_back_in_intervals_that_hold_for_all_six_at_once() -> None:
    result = fitted(table(), cubic="yes", **BY_AREA)
    found = []
    for model in (listing(result, r) for r in ("C_D", "C_L", "C_m")):
        for i, symbol in enumerate(model.symbols):
            freedom = model.fit.freedom[i]
            half = model.fit.half_width[i] * float(t_factor(freedom, 1.0 - 0.05 / 6)) / float(t_factor(freedom))
            assert model.fit.coefficients[i] == pytest.approx(CHOSEN[symbol], abs=half)
            assert half <= 0.1 * abs(CHOSEN[symbol])
            found.append(symbol)
    assert found == list(CHOSEN)


def test_exact_forces_give_the_coefficients_back_to_nine_digits() -> None:
    result = fitted(exact(), cubic="yes", **BY_AREA)
    for symbol, value in CHOSEN.items():
        assert listing(result, symbol[:3]).named(symbol)[0] == pytest.approx(value, rel=1e-9)


def test_the_law_over_delta_and_alpha_is_the_same_law() -> None:
    result = fitted(table(), cubic="yes", **BY_AREA)
    at = {"ds": np.radians([5.0, -12.0]), "alpha": np.radians([-7.0, 3.0])}
    for response in ("C_D", "C_L", "C_m"):
        model, short = over_both(result, response), listing(result, response)
        assert model.domain.variables == ("ds", "alpha")
        values, half, inside = model.evaluate(at)
        same, same_half, _ = short.evaluate({**at, "e": at["ds"] - at["alpha"]})
        np.testing.assert_allclose(values, same, rtol=1e-9)
        np.testing.assert_allclose(half, same_half, rtol=1e-6)
        assert np.all(inside)


def test_the_parameter_file_keeps_the_law_over_delta_and_alpha_with_its_area() -> None:
    kept, _ = recorded([fitted(exact(), cubic="yes", **BY_AREA)])
    assert [m.response for m in kept] == ["C_D", "C_L", "C_m"]
    assert all(m.area is not None and (m.area.value, m.area.name) == (AREA, "planform") for m in kept)
    e = np.radians(12.0 - 5.0)
    values, _, _ = kept[1].evaluate({"ds": np.radians([12.0]), "alpha": np.radians([5.0])})
    assert values[0] == pytest.approx(-2.4 * e + 1.5 * e**3, rel=1e-9)


def test_area_by_default_is_the_square_of_the_length() -> None:
    by_length, by_area = (fitted(table(), **o) for o in ({}, BY_AREA))
    ratio = AREA / LENGTH**2
    for response, symbol in (("C_D", "C_D2"), ("C_L", "C_L1"), ("C_m", "C_m1")):
        one, other = (listing(r, response).named(symbol)[0] for r in (by_length, by_area))
        assert one == pytest.approx(other * ratio, rel=1e-9)
    assert by_length.settings["area_name"] == "L^2"
    assert (by_area.settings["area"], by_area.settings["area_name"]) == ("0.02", "planform")


@pytest.mark.parametrize("options", [{}, BY_AREA], ids=["L^2", "planform"])
def test_primes_do_not_depend_on_the_area(options: dict[str, object]) -> None:
    """Z = -L at zero angle of attack, so Zds' = -C_L1 A / L^2; exact forces, one line each."""
    k = {**CHOSEN, "C_L3": 0.0, "C_m3": 0.0}
    delta, alpha = angles(table())
    result = fitted(with_law(table(), delta - alpha, k), **options).coefficients
    assert result["Zds"].value == pytest.approx(2.4 * AREA / LENGTH**2, rel=1e-9)
    assert result["Mds"].value == pytest.approx(0.45 * AREA / LENGTH**2, rel=1e-9)
    assert result.symbols == ("Zds", "Mds")
    np.testing.assert_allclose(2.0 * np.sqrt(np.diag(result.covariance)), [c.u95 for c in result.coefficients])


def test_leading_edge_down_lowers_lift_and_trailing_edge_down_raises_it() -> None:
    """A plate at incidence i to the flow lifts by +3 i. Leading edge down: i = alpha - delta. Feldman: alpha + delta."""
    delta, alpha = angles(table())
    k = {**CHOSEN, "C_L1": 3.0, "C_L3": 0.0}
    down = fitted(with_law(table(), alpha - delta, k), effective="delta-alpha", **BY_AREA)
    feldman = fitted(with_law(table(), alpha + delta, k), effective="delta+alpha", **BY_AREA)
    assert listing(down, "C_L").named("C_L1")[0] == pytest.approx(-3.0, rel=1e-9)
    assert listing(feldman, "C_L").named("C_L1")[0] == pytest.approx(3.0, rel=1e-9)
    assert "A negative delta raises lift." in listing(fitted(table(), **BY_AREA), "C_L").statements
    assert feldman.coefficients["Zds"].value == pytest.approx(-3.0 * AREA / LENGTH**2, rel=1e-9)


@pytest.mark.parametrize("right", ["delta-alpha", "delta+alpha"])
def test_the_wrong_effective_angle_is_noticed(right: str) -> None:
    delta, alpha = angles(table())
    t = with_law(table(), delta + (alpha if right == "delta+alpha" else -alpha), {**CHOSEN, "C_L3": 0.0, "C_m3": 0.0})
    noise = np.random.default_rng(2).standard_normal((2, len(t))) * 1e-3
    t = replace(t, forces={**t.forces, "Z": t.forces["Z"] + noise[0], "M": t.forces["M"] + noise[1]})
    wrong = "delta-alpha" if right == "delta+alpha" else "delta+alpha"
    for response in ("C_L", "C_m"):
        assert any("act together" in s for s in listing(fitted(t, effective=right), response).statements)
        said = " ".join(listing(fitted(t, effective=wrong), response).statements)
        assert f"otherwise than through {wrong}" in said
        assert f"Try effective = {right}" in said


def test_a_force_of_alpha_alone_is_said_to_be_no_effective_angle() -> None:
    """A hull that lifts by half of what the surface does, in the same sense as delta - alpha: no other sign mends it."""
    delta, alpha = angles(table())
    t = with_law(table(), delta - 1.5 * alpha, {**CHOSEN, "C_L3": 0.0, "C_m3": 0.0})
    noise = np.random.default_rng(2).standard_normal(len(t)) * 1e-3
    said = " ".join(listing(fitted(replace(t, forces={**t.forces, "M": t.forces["M"] + noise})), "C_m").statements)
    assert "more than the surface's own force" in said
    assert "Try effective" not in said


def coverage(model: FittedModel, truth: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Share of seeded campaigns whose interval holds the truth, by the chain of kernels that the fit runs."""
    matrix = design(model.terms, model.x)
    f = factorise(matrix)
    shocks = np.random.default_rng(1).standard_normal((len(matrix), CAMPAIGNS))
    coefficients, residuals = solve(f, (matrix @ truth)[:, None] + sizes[:, None] * shocks)
    half = np.sqrt(hc_variance(f, residuals, 2)) * t_factor(bell_mccaffrey(f))[:, None]
    return np.mean(np.abs(coefficients - truth[:, None]) <= half, axis=1)


@pytest.mark.parametrize("growing", [False, True], ids=["constant noise", "growing noise"])
@pytest.mark.parametrize("cubic", ["no", "yes"])
@pytest.mark.parametrize("response", ["C_D", "C_L", "C_m"])
def test_intervals_cover_in_93_to_97_percent(response: str, cubic: str, growing: bool) -> None:
    """Growing: five times as much at the largest effective angle, 30 degrees, as at none."""
    model = listing(fitted(table(), cubic=cubic, **BY_AREA), response)
    f = factorise(design(model.terms, model.x))
    own = np.sqrt(hc_variance(f, model.fit.residuals[:, None], 2))[:, 0] * t_factor(bell_mccaffrey(f))
    np.testing.assert_allclose(own, model.fit.half_width, rtol=1e-9)
    e = np.abs(model.x["e"])
    size = 0.01 * (0.25 + e / e.max() if growing else np.ones(len(e)))
    share = coverage(model, np.array([CHOSEN[s] for s in model.symbols]), size)
    assert np.all((share >= 0.93) & (share <= 0.97)), share


def test_a_surface_at_zero_angle_of_attack_alone_says_what_it_assumes() -> None:
    alone = rows(table(), angles(table())[1] == 0.0)
    result = fitted(alone, **BY_AREA)
    assert over_both(result, "C_L").domain.variables == ("ds",)
    assert any("assumed, not tested" in s for s in listing(result, "C_L").statements)
    assert listing(result, "C_L").n_points == 17


def test_rows_that_turn_are_left_out_and_counted() -> None:
    t = table()
    turn = np.where(np.arange(len(t)) < 4, 0.3, 0.0)
    result = fitted(replace(t, motion={**t.motion, "q": turn}), **BY_AREA)
    assert {m.n_points for m in result.models} == {len(t) - 4}
    assert any("4 of 51 rows" in s for s in result.models[0].statements)


def test_a_table_with_a_moment_alone_gives_its_coefficient_alone() -> None:
    result = fitted(replace(table(), forces={"M": table().forces["M"]}))
    assert {m.response for m in result.models} == {"C_m"}
    assert result.coefficients.symbols == ("Mds",)


def test_a_table_without_the_control_angle_is_refused() -> None:
    with pytest.raises(InputError, match=r"no delta_s in huuv_elevator_synthetic; expected a column delta_s \[deg\]"):
        fitted(replace(table(), controls={}))
    with pytest.raises(InputError, match="no delta_b"):
        fitted(table(), surface="db")


@pytest.mark.parametrize("left", ["X", "Z"])
def test_a_force_that_lift_and_drag_need_is_asked_for(left: str) -> None:
    missing = "Z" if left == "X" else "X"
    with pytest.raises(InputError, match=f"no {missing} in huuv_elevator_synthetic"):
        fitted(replace(table(), forces={left: table().forces[left]}))


def test_a_table_without_forces_in_the_plane_is_refused() -> None:
    with pytest.raises(InputError, match="none of X, Z, M"):
        fitted(replace(table(), forces={"Y": np.zeros(51)}, usable={"Y": np.ones(51, dtype=bool)}))


def test_an_angle_that_does_not_change_is_refused() -> None:
    t = table()
    still = rows(t, (t.controls["ds"] == 0.0) & (np.abs(angles(t)[1]) < 1e-12))
    repeated = rows(still, np.zeros(5, dtype=int))
    with pytest.raises(InputError, match="one effective angle on every row"):
        fitted(repeated)


def test_fewer_rows_than_terms_are_refused() -> None:
    with pytest.raises(InputError, match="2 usable rows for 2 terms of C_D"):
        fitted(rows(table(), np.arange(51) < 2))


@pytest.mark.parametrize("options", [{"area": 0.02}, {"area_name": "planform"}])
def test_an_area_and_its_name_go_together(options: dict[str, object]) -> None:
    with pytest.raises(InputError, match="an area above zero with its name, or neither"):
        fitted(table(), **options)


def test_a_line_through_curved_data_says_so_and_names_the_cubic() -> None:
    """C_L3 of the synthetic table is left out by default."""
    for response in ("C_L", "C_m"):
        for pick in (listing, over_both):
            line, cubic = (pick(fitted(table(), cubic=c, **BY_AREA), response) for c in ("no", "yes"))
            said = next(s for s in line.statements if "not random" in s)
            assert "most likely a term" in said
            assert said.endswith("Try cubic = yes.")
            assert not any("not random" in s for s in cubic.statements)
    assert not any("not random" in s for s in listing(fitted(table()), "C_D").statements)


def test_rounding_is_no_misfit() -> None:
    for m in fitted(exact(), cubic="yes", **BY_AREA).models:
        assert not any("not random" in s for s in m.statements)

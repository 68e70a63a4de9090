"""Glide polar: THAUV's three printed cases, the unit of the angle, coverage, bad input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.fits import FITS
from coeflab.fits.glide_polar import angle_unit_of, series
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.statistics.least_squares import factorise, solve
from coeflab.fits.statistics.robust_errors import bell_mccaffrey, hc_variance, t_factor
from coeflab.law.terms import design
from coeflab.law.transforms import body_forces
from coeflab.tables.force_table import ForceTable
from coeflab.vehicle.recorded import recorded
from tests.fits.shipped import rows, tables

# Table 3 of the THAUV paper.
SYMBOLS = ("K_L0", "K_L", "K_D0", "K_D", "K_M0", "K_M")
PRINTED = {
    "01": (-1.9169, 9.5281, 11.1159, 0.215, 1.1025, -1.4179),
    "02": (-1.8461, 9.8351, 11.5594, 0.2445, 0.3720, -2.4335),
    "03": (-1.265, 8.0948, 11.2805, 0.20525, 0.0985, -2.8938),
}
DEGREES = np.degrees(1.0)
CAMPAIGNS = 20_000


def table(case: str) -> ForceTable:
    return tables(f"thauv_case_{case}_synthetic")[0]


def fitted(t: ForceTable, **options: object) -> FitResult:
    return FITS.load("glide_polar").fit([t], t.scaling, options)


def law(result: FitResult, force: str, unit: str) -> FittedModel:
    found = [m for m in result.models if m.response == f"{force}/V^2" and f"a in {unit}" in m.form]
    assert len(found) == 1
    return found[0]


def printed(case: str) -> dict[str, float]:
    return dict(zip(SYMBOLS, PRINTED[case], strict=True))


def with_polar(t: ForceTable, lift: np.ndarray, drag: np.ndarray, moment: np.ndarray) -> ForceTable:
    alpha = np.arctan2(t.motion["w"], t.motion["u"])
    x, _, z = body_forces(alpha, np.zeros(len(t)), drag, np.zeros(len(t)), lift)
    return replace(t, forces={"X": x, "Z": z, "M": moment})


def exact(t: ForceTable, case: str = "01") -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    l0, l1, d0, d2, m0, m1 = PRINTED[case]
    a, square = np.degrees(np.arctan2(t.motion["w"], t.motion["u"])), t.speed**2
    return (l0 + l1 * a) * square, (d0 + d2 * a**2) * square, (m0 + m1 * a) * square


@pytest.mark.parametrize("noise", ["square", "constant"])
def test_the_printed_cases_come_back_in_intervals_that_hold_for_all_18_at_once(noise: str) -> None:
    """Of 18 intervals of 95 % one is outside by chance now and then; Bonferroni's are 95 % for all together."""
    for case in PRINTED:
        result = fitted(table(case), noise=noise)
        for force in "LDM":
            model = law(result, force, "deg")
            for i, name in enumerate((f"K_{force}0", f"K_{force}")):
                freedom = model.fit.freedom[i]
                half = model.fit.half_width[i] * float(t_factor(freedom, 1.0 - 0.05 / 18)) / float(t_factor(freedom))
                assert model.fit.coefficients[i] == pytest.approx(printed(case)[name], abs=half)


@pytest.mark.parametrize("case", PRINTED)
def test_slopes_are_known_to_three_percent(case: str) -> None:
    models = [law(fitted(table(case), noise="constant"), force, "deg") for force in "LDM"]
    for model in models:
        assert model.fit.half_width[1] <= 0.03 * abs(model.fit.coefficients[1])
    assert np.median([m.half_width / m.fit.half_width for m in models]) <= 1.1


@pytest.mark.parametrize("case", PRINTED)
def test_per_degree_and_per_radian_are_one_law(case: str) -> None:
    result = fitted(table(case))
    for force, power in (("L", 1), ("D", 2), ("M", 1)):
        degrees, radians = law(result, force, "deg").fit, law(result, force, "rad").fit
        np.testing.assert_allclose(radians.coefficients, degrees.coefficients * [1.0, DEGREES**power], rtol=1e-9)
        np.testing.assert_allclose(radians.half_width, degrees.half_width * [1.0, DEGREES**power], rtol=1e-9)
    assert law(result, "L", "rad").symbols == ("K_L0", "K_L [1/rad]")
    assert law(result, "D", "deg").symbols == ("K_D0", "K_D [1/deg^2]")


def test_models_per_radian_come_first_and_alone_where_asked() -> None:
    assert [m.domain.variables for m in fitted(table("01")).models] == [("alpha",)] * 6
    assert ["rad" in m.form for m in fitted(table("01")).models] == [True] * 3 + [False] * 3
    assert ["rad" in m.form for m in fitted(table("01"), angle_unit="rad").models] == [True] * 3


def test_exact_forces_give_the_coefficients_back_to_ten_digits() -> None:
    t = with_polar(table("01"), *exact(table("01")))
    result = fitted(t)
    found = np.concatenate([law(result, f, "deg").fit.coefficients for f in "LDM"])
    np.testing.assert_allclose(found, PRINTED["01"], rtol=1e-10)
    values, _, _ = law(result, "D", "rad").evaluate({"alpha": np.radians([3.0])})
    assert values[0] == pytest.approx(11.1159 + 0.215 * 9.0, rel=1e-10)


def test_the_parameter_file_keeps_the_law_per_radian() -> None:
    kept, notes = recorded([fitted(with_polar(table("01"), *exact(table("01"))))])
    assert [m.response for m in kept] == ["L/V^2", "D/V^2", "M/V^2"]
    assert all(m.variables[0].name == "alpha" and m.variables[0].unit == "rad" for m in kept)
    values, _, _ = kept[0].evaluate({"alpha": np.radians([3.0])})
    assert values[0] == pytest.approx(-1.9169 + 9.5281 * 3.0, rel=1e-10)
    assert all("report only" in n for n in notes)


@pytest.mark.parametrize("case", PRINTED)
def test_the_printed_forms_are_recognised_as_degrees(case: str) -> None:
    answer = angle_unit_of(printed(case), fitted(table(case)))
    assert answer.unit == "deg"
    assert [s.partition(":")[0] for s in answer.statements] == ["K_L0", "K_L", "K_D0", "K_D", "K_M0", "K_M"]
    assert all(" is per deg, " in s for s in answer.statements[1::2])
    assert all("it has no unit of the angle" in s for s in answer.statements[::2])


def test_the_same_law_printed_per_radian_is_recognised_as_radians() -> None:
    values = printed("02")
    values["K_L"] *= DEGREES
    values["K_M"] *= DEGREES
    values["K_D"] *= DEGREES**2
    answer = angle_unit_of(values, fitted(table("02"), angle_unit="rad"))
    assert answer.unit == "rad"
    assert all(" is per rad, " in s for s in answer.statements[1::2])


def test_slopes_that_disagree_or_do_not_speak_leave_the_unit_open() -> None:
    result = fitted(table("01"))
    assert angle_unit_of({"K_L": 9.5281, "K_M": -1.4179 * DEGREES}, result).unit == ""
    assert angle_unit_of({"K_L": -9.5281}, result).unit == ""
    assert angle_unit_of({"K_L0": -1.9169}, result).unit == ""
    assert "No slope decides" in angle_unit_of({"K_L": 0.0}, result).statements[-1]
    with pytest.raises(InputError, match="one of K_L0, K_L"):
        angle_unit_of({"C_L": 1.0}, result)


def test_a_printed_slope_outside_the_interval_is_said_to_be() -> None:
    answer = angle_unit_of({"K_L": 12.0}, fitted(table("01")))
    assert answer.unit == "deg"
    assert "outside the fitted" in answer.statements[0]


def test_a_printed_value_at_zero_angle_is_held_against_its_interval() -> None:
    result = fitted(table("01"))
    value, half = law(result, "L", "rad").named("K_L0")
    for printed_value, place in ((value + 0.9 * half, "inside"), (value + 1.1 * half, "outside")):
        said = angle_unit_of({"K_L0": printed_value}, result).statements[0]
        assert f"is {place} the fitted" in said


def test_printed_coefficients_as_an_option() -> None:
    result = fitted(table("01"), printed="K_L=9.5281, K_D=0.215")
    assert result.models[0].statements[-1] == "The printed coefficients are per deg."
    assert fitted(table("01"), printed="K_L = 9.5281, K_D =0.215").models[0].statements == result.models[0].statements
    for wrong in ("K_L", "K_L=nine", "K_L=nan", "K_X=1"):
        with pytest.raises(InputError, match=r"glide_polar\.printed"):
            fitted(table("01"), printed=wrong)


def coverage(model: FittedModel, truth: np.ndarray, sizes: np.ndarray, weights: np.ndarray | None = None) -> np.ndarray:
    """Share of seeded campaigns whose interval holds the truth, by the chain of kernels that the fit runs."""
    matrix = design(model.terms, model.x)
    f = factorise(matrix, weights)
    shocks = np.random.default_rng(1).standard_normal((len(matrix), CAMPAIGNS))
    coefficients, residuals = solve(f, (matrix @ truth)[:, None] + sizes[:, None] * shocks)
    half = np.sqrt(hc_variance(f, residuals, 2)) * t_factor(bell_mccaffrey(f))[:, None]
    return np.mean(np.abs(coefficients - truth[:, None]) <= half, axis=1)


def interval(model: FittedModel, weights: np.ndarray | None = None) -> np.ndarray:
    """The half-widths of the model by the same chain, from its own rows."""
    f = factorise(design(model.terms, model.x), weights)
    _, residuals = solve(f, model.y[:, None])
    return (np.sqrt(hc_variance(f, residuals, 2)) * t_factor(bell_mccaffrey(f))[:, None])[:, 0]


def shares(noise: str, size: np.ndarray) -> np.ndarray:
    """Coverage of K_L0 K_L K_D0 K_D K_M0 K_M where errors of force over V^2 go with ``size``."""
    out, square = [], table("01").speed ** 2
    for force, lead, slope in (("L", *PRINTED["01"][:2]), ("D", *PRINTED["01"][2:4]), ("M", *PRINTED["01"][4:])):
        model = law(fitted(table("01"), noise=noise), force, "deg")
        weights = square**2 if noise == "constant" else None
        np.testing.assert_allclose(interval(model, weights), model.fit.half_width, rtol=1e-9)
        out.append(coverage(model, np.array([lead, slope]), size, weights))
    return np.concatenate(out)


@pytest.mark.parametrize("growing", [False, True], ids=["constant noise", "growing noise"])
def test_intervals_cover_in_93_to_97_percent(growing: bool) -> None:
    """Growing: five times as much at 8 degrees as at none."""
    t = table("01")
    a = np.abs(np.degrees(np.arctan2(t.motion["w"], t.motion["u"])))
    share = shares("square", 0.25 + a / 8.0 if growing else np.ones(len(t)))
    assert np.all((share >= 0.93) & (share <= 0.97)), share


@pytest.mark.parametrize("noise", ["square", "constant"])
def test_intervals_cover_in_93_to_97_percent_where_the_noise_is_the_same_at_every_speed(noise: str) -> None:
    """Noise of a balance, so that the slow rows are five times as noisy over V^2."""
    share = shares(noise, 1.0 / table("01").speed ** 2)
    assert np.all((share >= 0.93) & (share <= 0.97)), share


def test_stating_the_noise_of_a_balance_narrows_the_intervals_of_such_data() -> None:
    for force in "LDM":
        wide, narrow = (law(fitted(table("01"), noise=n), force, "deg").fit for n in ("square", "constant"))
        assert np.all(narrow.half_width < wide.half_width)


def test_one_speed_is_enough_and_says_what_it_assumes() -> None:
    t = rows(table("01"), table("01").speed == 0.5)
    model = law(fitted(t), "L", "deg")
    value, half = model.named("K_L [1/deg]")
    assert abs(value - 9.5281) <= half
    assert any("assumed, not tested" in s for s in law(fitted(t), "L", "rad").statements)
    assert not any("assumed, not tested" in s for s in law(fitted(table("01")), "L", "rad").statements)


def test_a_force_that_does_not_go_with_the_square_of_the_speed_is_said_to_be_so() -> None:
    t = table("01")
    lift, drag, moment = exact(t)
    noise = np.random.default_rng(3).standard_normal((3, len(t))) * 1e-3
    slow = with_polar(t, lift + noise[0], drag * (t.speed / 0.5) ** -0.3 + noise[1], moment + noise[2])
    result = fitted(slow)
    assert any("does not go with V^2 alone" in s for s in law(result, "D", "rad").statements)


def test_rows_with_drift_are_left_out_and_counted() -> None:
    t = table("01")
    drift = np.where(np.arange(len(t)) < 3, 0.05, 0.0)
    result = fitted(replace(t, motion={**t.motion, "v": drift}))
    assert all(m.n_points == len(t) - 3 for m in result.models)
    assert any("3 of 27 rows" in s for s in result.models[0].statements)


@pytest.mark.parametrize("missing", ["X", "Z"])
def test_a_table_without_x_or_z_is_refused(missing: str) -> None:
    t = table("01")
    with pytest.raises(InputError, match=f"no {missing} in thauv_case_01_synthetic"):
        fitted(replace(t, forces={c: f for c, f in t.forces.items() if c != missing}))


def test_a_table_without_a_moment_gives_lift_and_drag() -> None:
    t = table("01")
    result = fitted(replace(t, forces={c: f for c, f in t.forces.items() if c != "M"}), angle_unit="rad")
    assert [m.response for m in result.models] == ["L/V^2", "D/V^2"]
    answer = angle_unit_of(printed("01"), result)
    assert answer.unit == "deg"
    assert "K_M0: not fitted" in answer.statements[4]
    assert "K_M: not fitted" in answer.statements[5]


def test_a_table_without_angles_is_refused() -> None:
    t = rows(table("01"), np.abs(table("01").motion["w"]) < 1e-12)
    with pytest.raises(InputError, match=r"one angle of attack, 0 degrees, .* alpha \[deg\] with several"):
        fitted(t)


def test_fewer_rows_than_terms_are_refused() -> None:
    with pytest.raises(InputError, match="2 usable rows for 2 terms of L/V"):
        fitted(rows(table("01"), np.arange(27) < 2))


def test_stated_errors_weigh_the_polar() -> None:
    t = table("01")
    lift, drag, moment = exact(t)
    wild = np.arange(len(t)) == 2
    off = with_polar(t, lift + 20.0 * wild, drag + 20.0 * wild, moment + 20.0 * wild)
    errors = {c: np.where(wild, 100.0, 0.01) for c in ("X", "Z", "M")}
    stated = fitted(replace(off, errors=errors), noise="stated")
    for force in "LDM":
        names = {
            s.partition(" [")[0]: v
            for s, v in zip(law(stated, force, "deg").symbols, law(stated, force, "deg").fit.coefficients)
        }
        for name, value in names.items():
            assert value == pytest.approx(printed("01")[name], rel=1e-4)
    with pytest.raises(InputError, match="no standard errors of L"):
        fitted(t, noise="stated")


@pytest.mark.parametrize("number", range(6))
def test_every_number_of_the_series_is_that_of_taylor(number: int) -> None:
    """One coefficient of the polar is one, the others zero; fifth orders, and the fourth of Z and M, are left out."""
    polar = np.eye(6)[number]
    s = np.linspace(-0.25, 0.25, 201)
    a = np.arcsin(s)
    x, _, z = body_forces(a, 0.0 * s, polar[2] + polar[3] * a**2, 0.0 * s, polar[0] + polar[1] * a)
    known = series(polar)
    for component, force, orders in (("X", x, 5), ("Z", z, 4), ("M", polar[4] + polar[5] * a, 4)):
        taylor = np.polynomial.polynomial.polyfit(s, force, 12)[:orders]
        ours = [known.get(component + ("w" * k or "0"), 0.0) for k in range(orders)]
        assert ours == pytest.approx(taylor, abs=1e-7)


@pytest.mark.parametrize("munk", [0.0, 236.7])
def test_the_series_is_the_polar_along_the_body_axes(munk: float) -> None:
    """At 8 degrees to 2e-4 of the largest force, with and without the Munk moment (m3 - m1) u w."""
    t = table("01")
    found = fitted(with_polar(t, *exact(t)), munk=munk).coefficients
    s = np.sin(np.radians([-8.0, -3.0, 0.0, 3.0, 8.0]))
    alpha = np.arcsin(s)
    lift, drag, moment = PRINTED["01"][0:2], PRINTED["01"][2:4], PRINTED["01"][4:6]
    degrees = np.degrees(alpha)
    x, _, z = body_forces(alpha, 0.0 * s, drag[0] + drag[1] * degrees**2, 0.0 * s, lift[0] + lift[1] * degrees)
    expected = {"X": x, "Z": z, "M": moment[0] + moment[1] * degrees + munk * s * np.cos(alpha)}
    for component, force in expected.items():
        ours = sum(
            c.value * t.scaling.unit(c.symbol, t.conditions.density) * s ** c.symbol.count("w")
            for c in found.coefficients
            if c.symbol[0] == component
        )
        assert ours == pytest.approx(force, abs=2e-4 * np.abs(force).max())


def test_derivatives_of_the_series_have_the_intervals_of_the_polar() -> None:
    t = table("01")
    found = fitted(t)
    lift, drag = law(found, "L", "rad"), law(found, "D", "rad")
    unit = t.scaling.unit("Zw", t.conditions.density)
    slope, at_rest = lift.named("K_L [1/rad]"), drag.named("K_D0")
    zw = found.coefficients["Zw"]
    assert zw.value == pytest.approx(-(slope[0] + at_rest[0]) / unit)
    assert zw.u95 == pytest.approx(np.hypot(slope[1], at_rest[1]) / unit)
    assert found.coefficients["X0"].u95 == pytest.approx(at_rest[1] / unit)
    spread = np.sqrt(np.diag(found.coefficients.covariance))
    assert spread * 2.0 == pytest.approx([c.u95 for c in found.coefficients.coefficients])


def test_a_moment_that_is_not_there_gives_no_derivative_of_it() -> None:
    t = table("01")
    bare = fitted(replace(t, forces={c: f for c, f in t.forces.items() if c != "M"}))
    assert {s[0] for s in bare.coefficients.symbols} == {"X", "Z"}

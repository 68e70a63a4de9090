"""Linear and quadratic damping: TJ-FlyingFish's printed pairs, coverage, bad input."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.statistics.least_squares import factorise, solve
from coeflab.fits.statistics.robust_errors import bell_mccaffrey, hc_variance, t_factor
from coeflab.law.coefficient import Status
from coeflab.law.terms import design
from coeflab.tables.campaign import FILE, read_campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import IMPORTERS
from tests.fits.shipped import rows, tables

# Equations 49 and 50 of the TJ-FlyingFish paper, printed for F = -(a + b |x|) x.
PRINTED = {
    "water": {
        "Xu": 0.0998, "Xu|u|": 18.2222, "Yv": 0.1658, "Yv|v|": 15.8047, "Zw": 0.0064, "Zw|w|": 24.7142,
        "Kp": 0.0032, "Kp|p|": 0.0489, "Mq": 0.0008, "Mq|q|": 0.1554, "Nr": 0.0029, "Nr|r|": 0.1872,
    },
    "air": {
        "Xu": 0.0010, "Xu|u|": 0.0165, "Yv": 0.0006, "Yv|v|": 0.0227, "Zw": 0.0004, "Zw|w|": 0.0364,
        "Kp": 0.0, "Kp|p|": 0.0002, "Mq": 0.0, "Mq|q|": 0.0005, "Nr": 0.0, "Nr|r|": 0.0013,
    },
}  # fmt: skip
CAMPAIGNS = 20_000


def table(medium: str) -> ForceTable:
    return tables(f"flyingfish_{medium}_synthetic")[0]


def fitted(t: ForceTable, **options: object) -> FitResult:
    return FITS.load("linear_quadratic_damping").fit([t], t.scaling, options)


def with_forces(t: ForceTable, **forces: np.ndarray) -> ForceTable:
    return replace(t, forces={**t.forces, **forces})


@pytest.mark.parametrize("medium", ["water", "air"])
def test_the_printed_pairs_come_back_in_intervals_that_hold_for_all_24_at_once(medium: str) -> None:
    """Of 24 intervals of 95 % one is outside by chance on average; Bonferroni's are 95 % for all together."""
    result = fitted(table(medium))
    assert len(result.models) == 6
    for model in result.models:
        for i, symbol in enumerate(model.symbols):
            one = float(t_factor(model.fit.freedom[i]))
            all_at_once = float(t_factor(model.fit.freedom[i], 1.0 - 0.05 / 24)) / one
            value, half = model.named(symbol)
            assert value == pytest.approx(-PRINTED[medium][symbol], abs=half * all_at_once)


@pytest.mark.parametrize("medium", ["water", "air"])
def test_quadratic_damping_is_known_to_two_percent(medium: str) -> None:
    """So that an interval that holds the truth is not merely a wide one; the form is right and widens few."""
    models = fitted(table(medium)).models
    for model in models:
        assert model.fit.half_width[1] <= 0.02 * abs(model.fit.coefficients[1])
    assert np.median([m.half_width / m.fit.half_width for m in models]) <= 1.1


@pytest.mark.parametrize("medium", ["water", "air"])
def test_coefficients_are_those_of_the_models(medium: str) -> None:
    result = fitted(table(medium))
    si = result.coefficients.to_si(table(medium).conditions)
    assert si.symbols == tuple(PRINTED[medium])
    for model in result.models:
        for symbol in model.symbols:
            value, half = model.named(symbol)
            assert si[symbol].value == pytest.approx(value, rel=1e-12)
            assert si[symbol].u95 == pytest.approx(half, rel=1e-12)
    units = {"Xu": "N/(m/s)", "Xu|u|": "N/(m/s)^2", "Nr": "N*m/(rad/s)", "Nr|r|": "N*m/(rad/s)^2"}
    assert {s: si[s].unit for s in units} == units
    assert {m.response: m.unit for m in result.models} == {**dict.fromkeys("XYZ", "N"), **dict.fromkeys("KMN", "N*m")}


def test_covariance_holds_the_u95_and_ties_only_terms_of_one_axis() -> None:
    result = fitted(table("water")).coefficients
    np.testing.assert_allclose(2.0 * np.sqrt(np.diag(result.covariance)), [c.u95 for c in result.coefficients])
    np.testing.assert_array_equal(result.covariance, result.covariance.T)
    blocks = np.kron(np.eye(6), np.ones((2, 2))) > 0.0
    assert np.all(result.covariance[~blocks] == 0.0)
    assert np.all(result.covariance[blocks] != 0.0)
    assert np.linalg.eigvalsh(result.covariance / np.sqrt(np.outer(*[np.diag(result.covariance)] * 2))).min() > 0.0


def test_a_zero_coefficient_is_said_not_to_be_told_from_zero() -> None:
    models = {m.response: m for m in fitted(table("air")).models}
    value, half = models["K"].named("Kp")
    assert abs(value) <= half
    assert any(s.startswith("Kp cannot be distinguished from zero") for s in models["K"].statements)
    assert not any(s.startswith("Kp|p| cannot be distinguished") for s in models["K"].statements)


def test_a_force_that_drives_is_called_one() -> None:
    t = table("water")
    model = fitted(with_forces(t, Y=-t.forces["Y"]), axes=("v",)).models[0]
    assert any("Yv|v| is positive beyond its interval" in s for s in model.statements)
    assert not any("positive beyond" in s for s in fitted(t, axes=("v",)).models[0].statements)


def coverage(model: FittedModel, truth: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Share of seeded campaigns whose interval holds the truth, by the chain of kernels that the fit runs."""
    matrix = design(model.terms, model.x)
    f = factorise(matrix)
    shocks = np.random.default_rng(1).standard_normal((len(matrix), CAMPAIGNS))
    coefficients, residuals = solve(f, (matrix @ truth)[:, None] + sizes[:, None] * shocks)
    half = np.sqrt(hc_variance(f, residuals, 2)) * t_factor(bell_mccaffrey(f))[:, None]
    return np.mean(np.abs(coefficients - truth[:, None]) <= half, axis=1)


def interval(model: FittedModel) -> np.ndarray:
    """The half-widths of the model by the same chain, from its own rows."""
    f = factorise(design(model.terms, model.x))
    _, residuals = solve(f, model.y[:, None])
    return (np.sqrt(hc_variance(f, residuals, 2)) * t_factor(bell_mccaffrey(f))[:, None])[:, 0]


@pytest.mark.parametrize("growing", [False, True], ids=["constant noise", "growing noise"])
@pytest.mark.parametrize("axis", ["v", "r"])
def test_intervals_cover_in_93_to_97_percent(axis: str, growing: bool) -> None:
    """Growing: five times as much at the fastest as at rest."""
    model = fitted(table("water"), axes=(axis,)).models[0]
    np.testing.assert_allclose(interval(model), model.fit.half_width, rtol=1e-9)
    x = np.abs(model.x[axis])
    size = 0.02 * np.max(np.abs(model.y)) * (0.25 + x / x.max() if growing else np.ones(len(x)))
    share = coverage(model, np.array([-PRINTED["water"][s] for s in model.symbols]), size)
    assert np.all((share >= 0.93) & (share <= 0.97)), share


def test_a_force_at_rest_is_found_where_it_is_asked_for() -> None:
    t = rows(table("water"), table("water").motion["u"] != 0.0)
    x = t.motion["u"]
    biased = with_forces(t, X=-18.0 * x * np.abs(x) - 0.1 * x + 0.7)
    model = fitted(biased, axes=("u",), offset="yes").models[0]
    assert model.named("X at rest")[0] == pytest.approx(0.7, rel=1e-9)
    assert model.named("Xu|u|")[0] == pytest.approx(-18.0, rel=1e-9)
    assert fitted(biased, axes=("u",), offset="yes").coefficients.symbols == ("Xu", "Xu|u|")


@pytest.mark.parametrize(("terms", "symbols"), [("linear", ("Xu",)), ("quadratic", ("Xu|u|",))])
def test_one_term_alone(terms: str, symbols: tuple[str, ...]) -> None:
    t = table("water")
    x = t.motion["u"]
    exact = -2.0 * x * (np.abs(x) if terms == "quadratic" else 1.0)
    result = fitted(with_forces(t, X=exact), axes=("u",), terms=terms)
    assert result.models[0].symbols == symbols
    assert result.models[0].named(symbols[0])[0] == pytest.approx(-2.0, rel=1e-12)


def test_one_speed_does_not_determine_two_terms() -> None:
    t = table("water")
    x = np.abs(t.motion["u"])
    result = fitted(rows(t, x == x.max()) if np.sum(x == x.max()) > 2 else _one_speed(t), axes=("u",))
    assert [c.status for c in result.coefficients.coefficients] == [Status.TOO_FEW_POINTS] * 2
    assert [c.value for c in result.coefficients.coefficients] == [None, None]
    assert any("determined only in combination" in s for s in result.models[0].statements)


def _one_speed(t: ForceTable) -> ForceTable:
    u = t.motion["u"]
    return replace(t, motion={**t.motion, "u": np.sign(u)}, forces={**t.forces, "X": -18.3 * np.sign(u)})


def test_one_sided_rows_are_said_to_be() -> None:
    t = table("water")
    model = fitted(rows(t, t.motion["w"] > 0.0)).models[0]
    assert any("of one sign" in s for s in model.statements)
    assert not any("of one sign" in s for s in fitted(t, axes=("w",)).models[0].statements)


def test_rows_in_which_two_velocities_move_are_not_used() -> None:
    t = table("water")
    both = np.array(t.motion["r"])
    first = int(np.flatnonzero(t.motion["v"])[0])
    both[first] = 0.1
    model = fitted(replace(t, motion={**t.motion, "r": both}), axes=("v",)).models[0]
    assert model.n_points == 15
    assert t.labels[first] not in model.labels


def test_too_few_rows_on_one_axis_leave_the_others() -> None:
    t = table("water")
    keep = (t.motion["u"] == 0.0) | (np.abs(t.motion["u"]) == 1.5)
    result = fitted(rows(t, keep))
    assert [m.response for m in result.models] == list("YZKMN")
    assert result.coefficients["Xu"].status is Status.TOO_FEW_POINTS
    assert result.coefficients["Xu|u|"].value is None
    assert np.all(np.isnan(result.coefficients.covariance[:2]))
    assert result.coefficients["Yv"].status is Status.FORM_ASSUMED


def test_fewer_rows_than_terms_are_refused() -> None:
    t = table("water")
    with pytest.raises(InputError, match=r"2 usable rows for 2 terms of X"):
        fitted(rows(t, np.abs(t.motion["u"]) == 1.5))


def test_a_table_without_a_pure_sweep_is_refused_with_the_columns_it_needs() -> None:
    t = IMPORTERS.load("csv").read(read_campaign(shipped("cfd_data") / "suboff_cfd_barehull" / FILE))[0]
    drifting = rows(t, t.motion["v"] != 0.0)
    with pytest.raises(InputError, match=r"no row of suboff_cfd_barehull in which only one of .* u \[m/s\], X \[N\]"):
        fitted(drifting)


def test_a_missing_force_column_leaves_its_axis_out_and_alone_is_refused() -> None:
    t = table("water")
    without = replace(t, forces={c: f for c, f in t.forces.items() if c != "X"})
    assert [m.response for m in fitted(without).models] == list("YZKMN")
    with pytest.raises(InputError, match="no row of flyingfish_water_synthetic in which only one of u moves"):
        fitted(without, axes=("u",))


def test_an_unknown_axis_is_refused() -> None:
    with pytest.raises(InputError, match="some of u, v, w, p, q, r"):
        fitted(table("water"), axes=("x",))

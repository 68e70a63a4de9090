"""Budgets of fitted models: input effects against closed forms, Monte Carlo against linear, grid, what is left open."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.files import shipped
from coeflab.core.provenance import Source
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.uncertainty.budget import Budget
from coeflab.fits.uncertainty.model_budget import SELECTED, with_model_budgets
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.input_uncertainty import InputUncertainty
from coeflab.tables.reading import read_tables
from coeflab.vehicle.recorded import record
from tests.report.studies import FULL, LENGTH, small_table

EXPERIMENT = Source("tank", kind="experiment")
YV, YVVV, NV, NVVV = -0.03, -0.05, -0.014, 0.02
DEGREE = float(np.radians(1.0))


def exact_table(**declared: float) -> ForceTable:
    """Odd cubics in v', without noise."""
    table = small_table(FULL)
    v = table.primed_motion("v", LENGTH.length)
    q = 0.5 * table.conditions.density * table.speed**2 * LENGTH.length**2
    forces = {"Y": q * (YV * v + YVVV * v**3), "N": q * LENGTH.length * (NV * v + NVVV * v**3)}
    usable = {c: np.ones(len(table), dtype=bool) for c in "YN"}
    return replace(
        table, forces=forces, errors={}, usable=usable, exclusions=(), source=EXPERIMENT,
        uncertainty=InputUncertainty(**declared) if declared else None,
    )  # fmt: skip


def budgeted(
    table: ForceTable, fit: str = "polynomial", *, draws: int = 100, **options: object
) -> tuple[FitResult, dict[str, Budget]]:
    """A fit with its budgets; the linear parts do not ask for draws, a thousand of them are for `Budget.monte_carlo`."""
    plugin = FITS.load(fit)
    chosen = options or {"variable": "v", "degree": 3}
    result = plugin.fit([table], LENGTH, chosen)
    result, found = with_model_budgets(result, [table], LENGTH, lambda t, s: plugin.fit(t, s, chosen), draws=draws)
    return result, {b.symbol: b for b in found}


@pytest.mark.parametrize(
    ("name", "powers"),
    [
        ("force", {"Yv": 1.0, "Yvvv": 1.0}),
        ("moment", {"Nv": 1.0, "Nvvv": 1.0}),
        ("speed", {"Yv": -2.0, "Nv": -2.0, "Nvvv": -2.0}),
        ("length", {"Yv": -2.0, "Nv": -3.0}),
        ("density", {"Yv": -1.0, "Nv": -1.0}),
    ],
)
def test_a_relative_input_moves_a_coefficient_by_its_power(name: str, powers: dict[str, float]) -> None:
    _, found = budgeted(exact_table(**{name: 0.01}))
    for symbol, power in powers.items():
        (part,) = found[symbol].inputs
        assert part.sensitivity / found[symbol].value == pytest.approx(power, rel=1e-6)
        assert found[symbol].part(name) == pytest.approx(abs(power * found[symbol].value) * 0.01, rel=1e-6)
    assert {s for s, b in found.items() if b.inputs} >= set(powers)


def test_a_calibration_of_the_moment_is_of_what_the_balance_read() -> None:
    """Before: of the moved one, 1 % of Nv' - x' Yv'."""
    ahead = 0.3
    _, found = budgeted(exact_table(moment=0.01).about(np.array([ahead, 0.0, 0.0])))
    assert found["Nv"].value == pytest.approx(NV - ahead / LENGTH.length * YV, rel=1e-6)
    assert found["Nv"].part("moment") == pytest.approx(0.01 * abs(NV), rel=1e-6)


def test_an_offset_of_the_angle_moves_the_intercept_by_the_slope() -> None:
    result, _ = budgeted(exact_table(angle=0.1 * DEGREE), variable="beta", degree=3)
    side = next(m for m in result.models if m.response == "Y'")
    _, c1, c2, c3 = side.fit.coefficients
    shift = side.shared["angle beta"]
    np.testing.assert_allclose(shift, 0.1 * DEGREE * np.array([-c1, -2.0 * c2, -3.0 * c3, 0.0]), atol=1e-9)
    assert abs(shift[0]) > 1e-5


def test_a_reference_point_further_ahead_adds_the_force_to_the_moment() -> None:
    _, found = budgeted(exact_table(reference_point=0.01))
    (part,) = found["Nv"].inputs
    assert part.sensitivity == pytest.approx(YV / LENGTH.length, rel=1e-6)
    assert not found["Yv"].inputs


@pytest.mark.slow
def test_linear_and_monte_carlo_agree_where_the_model_is_nearly_linear() -> None:
    """One input by itself, whose percentiles the strata of the draws pin; then several for the linear sum."""
    _, alone = budgeted(exact_table(force=0.01), draws=1000)
    total = alone["Yv"].monte_carlo
    assert total.draws == 1000
    assert total.monte_carlo == pytest.approx(total.linear, rel=0.02)
    _, found = budgeted(exact_table(force=0.01, speed=0.005, angle=0.1 * DEGREE))
    several = found["Yv"].monte_carlo
    assert several.linear == pytest.approx(abs(YV) * np.hypot(0.01, 2 * 0.005), rel=1e-3)


def test_inputs_are_in_u95_the_covariance_and_every_reading_of_the_model() -> None:
    bare, _ = budgeted(exact_table())
    result, found = budgeted(exact_table(force=0.02))
    c = result.coefficients["Yv"]
    assert c.parts.input == pytest.approx(abs(0.02 * c.value))
    assert c.u95 == pytest.approx(np.hypot(bare.coefficients["Yv"].u95, 0.02 * c.value), rel=1e-9)
    i = result.coefficients.symbols.index("Yv")
    assert result.coefficients.covariance[i, i] == pytest.approx((c.u95 / 2.0) ** 2, rel=1e-9)
    model = next(m for m in result.models if m.response == "Y'")
    at = {"v": np.array([0.1, 0.2])}
    values, half, _ = model.evaluate(at)
    np.testing.assert_allclose(half, 0.02 * np.abs(values), rtol=1e-6)
    written = record(model)
    assert written.holds == ("random", "force")
    np.testing.assert_allclose(written.evaluate(at)[1], half, rtol=1e-9)
    assert "model form" in found["Yv"].unassessed
    assert {"speed", "angle", "length", "density"} <= set(found["Yv"].unassessed)


def test_a_fit_without_declarations_is_left_as_it_is() -> None:
    table = exact_table()
    plugin = FITS.load("polynomial")
    fit = plugin.fit([table], LENGTH, {"variable": "v"})
    result, found = with_model_budgets(fit, [table], LENGTH, lambda t, s: plugin.fit(t, s, {"variable": "v"}))
    assert [c.u95 for c in result.coefficients.coefficients] == [c.u95 for c in fit.coefficients.coefficients]
    assert all(not m.shared for m in result.models)
    assert all(b.monte_carlo is None for b in found)


def test_terms_chosen_on_the_data_have_no_input_parts() -> None:
    rng = np.random.default_rng(3)
    table = exact_table(force=0.01)
    noisy = {c: f * (1.0 + 0.01 * rng.standard_normal(len(f))) for c, f in table.forces.items()}
    result, found = budgeted(replace(table, forces=noisy), "sparse", components=("Y",))
    assert all(not m.shared for m in result.models)
    assert all(SELECTED in b.unassessed for b in found.values() if b.symbol.startswith("Y"))
    assert all(SELECTED in m.not_assessed for m in result.models)


def test_an_input_that_changes_the_rows_in_use_is_named() -> None:
    """An arm whose rows are at rest in drift only just: a point further ahead makes them drift."""
    table = exact_table(reference_point=2.0, force=0.01)
    r = np.linspace(-0.4, 0.4, len(table)) * table.speed / LENGTH.length
    motion = {**table.motion, "v": np.zeros(len(table)), "u": table.speed, "r": r}
    x = r * LENGTH.length / table.speed
    q = 0.5 * table.conditions.density * table.speed**2 * LENGTH.length**2
    arm = replace(table, motion=motion, forces={"Y": q * 0.005 * x, "N": -q * LENGTH.length * 0.004 * x})
    result, found = budgeted(arm, variable="r", degree=1)
    assert any(u.startswith("reference point: it changes which rows") for u in found["Yr"].unassessed)
    assert set(next(m for m in result.models if m.response == "Y'").shared) == {"force"}


@pytest.mark.slow
def test_u95_holds_errors_that_all_points_share() -> None:
    """Campaigns whose angle and force are off by draws from what they declare, with noise beside."""
    rng = np.random.default_rng(11)
    declared = {"angle": 0.2 * DEGREE, "force": 0.02}
    plugin = FITS.load("polynomial")
    options = {"variable": "v", "degree": 3, "responses": ("Y",), "parity": "full"}
    held = {"Y0": 0, "Yv": 0}
    trials = 150
    for _ in range(trials):
        table = exact_table(**declared)
        offset, gain = rng.normal(0.0, [declared["angle"] / 2.0, declared["force"] / 2.0])
        v = table.primed_motion("v", LENGTH.length)
        felt = np.sin(np.arcsin(v) + offset)
        q = 0.5 * table.conditions.density * table.speed**2 * LENGTH.length**2
        y = q * ((YV * felt + YVVV * felt**3) / (1.0 + gain) + rng.normal(0.0, 1e-4, len(v)))
        given = replace(table, forces={"Y": y}, usable={"Y": table.usable["Y"]})
        fit = plugin.fit([given], LENGTH, options)
        fit, _ = with_model_budgets(fit, [given], LENGTH, lambda t, s: plugin.fit(t, s, options), draws=1)
        for symbol, true in (("Y0", 0.0), ("Yv", YV)):
            c = fit.coefficients[symbol]
            held[symbol] += abs(c.value - true) <= c.u95
    assert all(0.90 * trials <= n <= 0.99 * trials for n in held.values()), held


def shipped_tables(name: str) -> tuple[ForceTable, ...]:
    return read_tables(PlannedTable(shipped("cfd_data") / name, ("any",)))


def test_a_grid_study_speaks_for_the_terms_whose_motion_it_moves() -> None:
    """The drift study at 4 deg for v, the study on the arm for r; neither for the other."""
    tables = shipped_tables("suboff_cfd_barehull")
    plugin = FITS.load("manoeuvring_model")
    options = {"terms": "Nv Nv|v| Nr Nr|r|"}
    fit = plugin.fit(tables, tables[0].scaling, options)
    result, found = with_model_budgets(fit, tables, tables[0].scaling, lambda t, s: plugin.fit(t, s, options))
    share = {b.symbol: (b.part("grid") or 0.0) / abs(b.value) for b in found}
    assert share["Nv"] == share["Nv|v|"] == pytest.approx(0.0203, rel=0.01)
    assert share["Nr"] == pytest.approx(0.207, rel=0.01)
    (model,) = result.models
    held = {n: np.flatnonzero(s).tolist() for n, s in model.shared.items()}
    names = [s.removesuffix("'") for s in model.symbols]
    drift, arm = sorted(held, key=lambda n: "r =" in n)
    assert {names[i] for i in held[drift]} == {"Nv", "Nv|v|"}
    assert {names[i] for i in held[arm]} - {"N0"} == {"Nr", "Nr|r|"}
    among, k = result.coefficients, len(model.symbols)
    order = [among.symbols.index(n) for n in names if n in among.symbols]
    np.testing.assert_allclose(among.covariance[np.ix_(order, order)][:k, :k], model.covariance, rtol=1e-9, atol=1e-18)


def test_an_angle_acts_on_dimensional_laws_over_it() -> None:
    tables = [
        replace(t, uncertainty=InputUncertainty(angle=0.2 * DEGREE)) for t in shipped_tables("thauv_case_01_synthetic")
    ]
    plugin = FITS.load("glide_polar")
    fit = plugin.fit(tables, tables[0].scaling, {})
    result, _ = with_model_budgets(fit, tables, tables[0].scaling, lambda t, s: plugin.fit(t, s, {}), draws=2)
    lift = next(m for m in result.models if m.response == "L/V^2")
    slope = lift.fit.coefficients[1]
    assert lift.shared["angle alpha"][0] == pytest.approx(
        -0.2 * DEGREE * slope * _per_radian(lift.symbols[1]), rel=0.05
    )


def _per_radian(symbol: str) -> float:
    return float(np.degrees(1.0)) if "deg" in symbol else 1.0


def test_campaigns_share_one_length_and_answer_for_their_own_inputs() -> None:
    one = exact_table(length=0.01, force=0.02)
    two = replace(exact_table(length=0.02), campaign="other", name="other/table.csv")
    plugin = FITS.load("manoeuvring_model")
    options = {"terms": "Yv Yvvv"}

    def refit(tables: object, scaling: object) -> FitResult:
        return plugin.fit(tables, scaling, options)

    result, found = with_model_budgets(refit([one, two], LENGTH), [one, two], LENGTH, refit, draws=100)
    b = {b.symbol: b for b in found}["Yv"]
    assert b.part("length") == pytest.approx(2.0 * 0.02 * abs(b.value), rel=1e-6)
    assert "force of other" in b.unassessed
    assert not any(u.startswith("force of tow") for u in b.unassessed)
    c = result.coefficients["Yv"]
    i = result.coefficients.symbols.index("Yv")
    assert c.u95 == pytest.approx(2.0 * result.coefficients.covariance[i, i] ** 0.5, rel=1e-9)
    assert c.parts.input == pytest.approx(np.sqrt(sum(p.linear**2 for p in b.inputs)), rel=1e-9)


def test_a_point_moved_there_and_back_leaves_no_motion() -> None:
    """Rounding of a transfer is no drift: Yv|r| stays without motion on an arm."""
    arm = shipped_tables("suboff_cfd_barehull")[1]
    back = arm.about(arm.reference_point + np.array([0.37, 0.0, 0.0])).about(arm.reference_point)
    assert 0.0 < np.max(np.abs(back.motion["v"])) < 1e-12
    plugin = FITS.load("manoeuvring_model")
    values = [
        {c.symbol: c.value for c in plugin.fit([t], arm.scaling, {"set": "horizontal"}).coefficients.coefficients}
        for t in (arm, back)
    ]
    assert {s for s, v in values[0].items() if v is None} == {s for s, v in values[1].items() if v is None}
    assert values[1]["Nr"] == pytest.approx(values[0]["Nr"], rel=1e-9)

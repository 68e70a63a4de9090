"""Budgets: sensitivities against power laws, grid parts against planted errors, ratios, validation, declarations."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.core.declarations import declared_key
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.finding import Severity
from coeflab.core.provenance import Source
from coeflab.core.text.delimited import read_cells
from coeflab.core.text.toml import read_toml
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.results.fitted_model import DIGITS
from coeflab.fits.slope_at_origin import fit
from coeflab.fits.uncertainty.budget import Budget, BudgetPart, budgets_of, covariance, open_parts, with_budget
from coeflab.fits.uncertainty.grid_convergence import Convergence
from coeflab.fits.uncertainty.grid_studies import gravest, grid_studies
from coeflab.law.coefficient import Status
from coeflab.law.symbols import derivative
from coeflab.study.validation import validation
from coeflab.tables.campaign import read_campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.input_uncertainty import InputUncertainty
from coeflab.tables.reading import declared, read_tables, with_declarations
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import centre_of_pressure, stability
from tests.report.studies import FULL, HALF, LENGTH, budgets, small_study, small_table

ONE = 0.01
EXPERIMENT = Source("tank", kind="experiment")
COMPUTED = Source("solver", kind="cfd")
EVERY = InputUncertainty(
    angle=float(np.radians(0.1)), rate=0.005, speed=0.005, force=0.01, moment=0.01, reference_point=0.01, length=0.002,
    density=0.001,
)  # fmt: skip


def arm_table(shift: float = 0.0) -> ForceTable:
    """A synthetic rotating arm; with a shift its runs are stated about a point at which they drift."""
    drift = small_table(FULL)
    speed, length = float(drift.speed[0]), LENGTH.length
    r = np.linspace(0.0, 0.4, 9) * speed / length
    x = r * length / speed
    q = 0.5 * drift.conditions.density * speed**2 * length**2
    ripple = 1e-6 * np.cos(5.0 * np.arange(9))
    zero = np.zeros(9)
    table = replace(
        drift,
        name="tow/arm.csv",
        motion={"u": np.full(9, speed), "v": zero, "w": zero, "p": zero, "q": zero, "r": r},
        speed=np.full(9, speed),
        forces={
            "Y": q * (0.005 * x + 0.01 * x**3 + ripple),
            "N": q * length * (-0.004 * x - 0.006 * x**3 + ripple),
        },
        usable={c: np.ones(9, dtype=bool) for c in "YN"},
        exclusions=(),
        labels=tuple(f"arm {i}" for i in range(9)),
    )
    return table.about(np.array([shift, 0.0, 0.0]))


def both(uncertainty: InputUncertainty | None, shift: float = 0.0) -> tuple[FitResult, dict[str, ForceTable]]:
    tables = [replace(t, uncertainty=uncertainty, source=EXPERIMENT) for t in (small_table(FULL), arm_table())]
    tables = [t.about(np.array([shift, 0.0, 0.0])) for t in tables]
    return fit(tables, LENGTH, {}), {t.name: t for t in tables}


def found_by(uncertainty: InputUncertainty | None, shift: float = 0.0) -> dict[str, Budget]:
    result, tables = both(uncertainty, shift)
    return {b.symbol: b for b in budgets_of(result, tables)}


def powers(name: str) -> dict[str, float]:
    """Sensitivity over value, by symbol."""
    found = found_by(InputUncertainty(**{name: ONE}))
    return {s: sum(p.sensitivity for p in b.inputs) / b.value for s, b in found.items()}


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("length", {"Yv": -2, "Nv": -3, "Yr": -3, "Nr": -4}),
        ("speed", {"Yv": -2, "Nv": -2, "Yr": -1, "Nr": -1}),
        ("density", {"Yv": -1, "Nv": -1, "Yr": -1, "Nr": -1}),
        ("rate", {"Yv": 0, "Nv": 0, "Yr": -1, "Nr": -1}),
        ("force", {"Yv": 1, "Nv": 0, "Yr": 1, "Nr": 0}),
        ("moment", {"Yv": 0, "Nv": 1, "Yr": 0, "Nr": 1}),
    ],
)
def test_scale_errors_follow_the_prime_system(name: str, expected: dict[str, int]) -> None:
    found = powers(name)
    assert {s: found[s] for s in expected} == pytest.approx(expected, rel=1e-6, abs=1e-9)


def test_one_per_cent_of_length_is_two_of_a_force_slope_and_three_of_a_moment_slope() -> None:
    found = found_by(InputUncertainty(length=ONE))
    assert found["Yv"].part("length") == pytest.approx(0.02 * abs(found["Yv"].value), rel=1e-6)
    assert found["Nv"].part("length") == pytest.approx(0.03 * abs(found["Nv"].value), rel=1e-6)


@pytest.mark.parametrize("name", ["force", "moment"])
def test_a_calibration_is_of_what_the_balance_read_wherever_the_coefficients_are_about(name: str) -> None:
    """Before: of the moved moment; about a point where it vanishes 2 % of the moment that was read were 2 % of nothing."""
    shift, about = 0.3, np.array([0.3, 0.0, 0.0])
    scaled = {c: 1.0 + ONE * (name == ("moment" if c == "N" else "force")) for c in "YN"}
    tables = [replace(t, source=EXPERIMENT) for t in (small_table(FULL), arm_table())]
    off = [replace(t, forces={c: f * scaled.get(c, 1.0) for c, f in t.forces.items()}) for t in tables]
    right, wrong = (fit([t.about(about) for t in some], LENGTH, {}).coefficients for some in (tables, off))
    found = found_by(InputUncertainty(**{name: ONE}), shift)
    for symbol in ("Yv", "Nv", "Yr", "Nr"):
        moved = (wrong[symbol].value or 0.0) - (right[symbol].value or 0.0)
        assert (found[symbol].part(name) or 0.0) == pytest.approx(abs(moved), rel=0.02, abs=1e-9)


def test_a_calibration_is_about_the_point_of_each_table_s_own_balance() -> None:
    """Before: about that of the first; a moment that was read where it is wanted held 2 % of the force of a lever that no run had."""
    here = replace(small_table(FULL), source=EXPERIMENT, uncertainty=InputUncertainty(force=ONE))
    arm = replace(arm_table(), source=EXPERIMENT, uncertainty=InputUncertainty(force=ONE))
    elsewhere = here.about(np.array([0.3, 0.0, 0.0]))
    tables = [replace(elsewhere, measured_about=None).about(np.zeros(3)), arm]
    found = {b.symbol: b for b in budgets_of(fit(tables, LENGTH, {}), {t.name: t for t in tables})}
    assert found["Nr"].part("force") is None
    assert found["Nv"].part("force") == pytest.approx(ONE * 0.3 / LENGTH.length * abs(found["Yv"].value), rel=1e-6)


def test_printed_digits_of_a_slope_go_along_where_an_arm_s_coefficients_are_moved() -> None:
    """Before, Yr' moved by 1.5 m of 5 m with 20 N digits of the drift runs: +- 0.0012, now +- 0.0048; those of Yv' alone are 0.0156."""
    result, tables = both(None, 0.3)
    sweeps = tuple(replace(s, rounding=1.0 if s.symbol == "Yv" else 0.0) for s in result.sweeps)
    found = {b.symbol: b.part(DIGITS) for b in budgets_of(replace(result, sweeps=sweeps), tables)}
    arm = 0.3 / LENGTH.length
    assert found["Yv"] == pytest.approx(1.0)
    assert found["Nv"] == pytest.approx(arm, rel=1e-6)
    assert found["Yr"] == pytest.approx(arm, rel=1e-6)
    assert found["Nr"] == pytest.approx(arm**2, rel=1e-6)


def test_the_reference_point_moves_coefficients_as_the_transfer_says() -> None:
    found = found_by(InputUncertainty(reference_point=ONE))
    value = {s: b.value / LENGTH.length for s, b in found.items()}
    expected = {"Nv": -value["Yv"], "Yr": -value["Yv"], "Nr": -value["Nv"] - value["Yr"]}
    moved = {s: b.inputs[0].sensitivity for s, b in found.items() if b.inputs}
    assert moved == pytest.approx(expected, rel=1e-6)
    assert found["Yv"].part("reference point") is None
    assert "reference point" not in found["Yv"].unassessed


def test_the_transfer_of_an_input_is_that_of_the_coefficients() -> None:
    result, tables = both(InputUncertainty(reference_point=ONE))
    along = 1e-4
    there = result.coefficients.about(result.coefficients.reference_point + np.array([along, 0.0, 0.0]))
    for b in budgets_of(result, tables):
        slope = (float(there[b.symbol].value or 0.0) - b.value) / along
        assert sum(p.sensitivity for p in b.inputs) == pytest.approx(slope, rel=1e-3, abs=1e-9)


def test_a_constant_angle_offset_only_moves_the_intercept_of_a_straight_line() -> None:
    v = np.sin(np.radians(FULL))
    q = 0.5 * 1000.0 * 1.5**2 * 4.0
    ripple = 1e-9 * np.cos(7.0 * np.arange(len(v)))
    for bend, expected in ((0.0, 0.0), (0.05, -0.1)):
        forces = {"Y": q * (2e-4 - 0.03 * v + bend * v**2 + ripple)}
        table = replace(
            small_table(FULL), forces=forces, usable={"Y": np.ones(len(v), dtype=bool)}, exclusions=(),
            uncertainty=InputUncertainty(angle=float(np.radians(0.2))), source=EXPERIMENT,
        )  # fmt: skip
        b = next(b for b in budgets_of(fit([table], LENGTH, {}), {table.name: table}))
        assert b.symbol == "Yv"
        assert b.inputs[0].sensitivity == pytest.approx(expected, rel=0.03, abs=2e-4)
        assert "angle" not in b.unassessed


@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_linear_and_monte_carlo_agree_and_start_from_the_coefficient(shift: float) -> None:
    for b in found_by(EVERY, shift).values():
        m = b.monte_carlo
        assert m.value == pytest.approx(b.value, rel=1e-9)
        assert m.linear == pytest.approx(np.sqrt(sum(p.linear**2 for p in b.inputs)))
        assert m.monte_carlo == pytest.approx(m.linear, rel=0.06)


def test_u95_is_the_root_sum_of_squares_of_parts_whose_shares_are_all_of_it() -> None:
    result, tables = both(EVERY)
    for b in budgets_of(result, tables):
        assert b.u95 == pytest.approx(np.sqrt(sum(p.half_width**2 for p in b.parts)))
        assert sum(p.share or 0.0 for p in b.parts) == pytest.approx(1.0)
        assert (b.u95 or 0.0) >= float(result.coefficients[b.symbol].u95 or 0.0)


def test_what_was_not_declared_is_named_and_not_zero() -> None:
    none, some = found_by(None), found_by(InputUncertainty(speed=0.01))
    assert none["Nv"].monte_carlo is None
    assert none["Nv"].input is None
    assert {"angle", "speed", "moment", "reference point", "length", "density"} <= set(none["Nv"].unassessed)
    assert "speed" not in some["Nv"].unassessed
    assert "moment" in some["Nv"].unassessed
    assert "error of the drift angle in the rate sweep" in some["Yr"].unassessed
    assert "rig interference and blockage" in some["Yr"].unassessed
    assert not {"grid", "force"} & set(none["Nv"].unassessed)


def test_the_window_part_is_the_largest_move_under_a_cap() -> None:
    for b, s in zip(budgets(small_study(FULL)), small_study(FULL).fits[0].sweeps, strict=True):
        largest = max(abs(float(k.value or 0.0) - b.value) for k in s.sensitivity)
        assert b.window == pytest.approx(2.0 * largest / 3.0**0.5)


def gridded(error: float = 0.05, **changes: object) -> ForceTable:
    """Drift sweep on a fine grid with two coarser ones at 4 degrees, errors of second order in the cell size."""
    angles = [*FULL, 4.0, 4.0]
    table = small_table(angles)
    cells = np.full(len(angles), 8e6)
    cells[-2:] = 1e6, 1e6 / 8
    size = (8e6 / cells) ** (1 / 3)
    exact = {c: np.append(f[:-2], [f[FULL.index(4.0)]] * 2) for c, f in table.forces.items()}
    forces = {c: f * (1.0 + error * size**2) for c, f in exact.items()}
    usable = {c: np.array(m) for c, m in table.usable.items()}
    for m in usable.values():
        m[-2:] = False
    return replace(table, cells=cells, forces=forces, usable=usable, source=COMPUTED, **changes)


def test_a_planted_grid_error_becomes_the_grid_part() -> None:
    table = gridded()
    found = grid_studies(table, "Y")
    assert len(found) == 1
    assert found[0].cells == (8_000_000, 1_000_000, 125_000)
    assert found[0].convergence.order == pytest.approx(2.0)
    expected = 1.25 * 0.05 / 1.05
    b = budgets_of(fit([table], LENGTH, {}), {table.name: table})[0]
    assert b.part("grid") == pytest.approx(expected * abs(b.value), rel=1e-6)
    assert "turbulence model" in b.unassessed
    assert "grid" not in b.unassessed


def test_grid_studies_need_cells_and_one_grid_in_use() -> None:
    assert grid_studies(small_table(FULL), "Y") == ()
    assert grid_studies(gridded(), "Z") == ()
    assert gravest(()) is None
    usable = {c: np.ones(15, dtype=bool) for c in "YN"}
    assert grid_studies(replace(gridded(), usable=usable), "Y") == ()
    bare = replace(gridded(), cells=None)
    b = budgets_of(fit([bare], LENGTH, {}), {bare.name: bare})[0]
    assert b.part("grid") is None
    assert "grid" in b.unassessed


def test_the_bare_hull_computation() -> None:
    folder = shipped("cfd_data") / "suboff_cfd_barehull"
    tables = [
        with_declarations(t, folder / Path(t.name).name, "cells")
        for t in read_tables(PlannedTable(folder, (), {}))
    ]  # fmt: skip
    drift, arm = tables
    for table, component in ((drift, "Y"), (drift, "N"), (arm, "Y"), (arm, "N")):
        (study,) = grid_studies(table, component)
        assert study.cells == (1169985, 607541, 192998)
        assert study.cells_used == 607541
        assert study.convergence.convergence is Convergence.NOISE
        assert study.convergence.values[study.convergence.used] == pytest.approx(
            float(table.forces[component][2]), rel=1e-12
        )
    by = {(s.table, s.component): s.convergence.relative for t in tables for c in "YN" for s in grid_studies(t, c)}
    assert list(by.values()) == pytest.approx([0.108, 0.0203, 0.279, 0.207], rel=0.01)
    diverging = grid_studies(drift, "X")[0].convergence
    assert not diverging.convergence.converges
    assert diverging.relative == pytest.approx(0.0938, rel=0.01)


@given(st.floats(0.005, 0.2), st.sampled_from([-2, -1]), st.floats(-6.0, 6.0))
@settings(max_examples=60, deadline=None)
def test_u95_never_shrinks_as_the_grid_study_gets_worse(error: float, row: int, by: float) -> None:
    """The rows in use stay as they are: only a coarser run, which no fit uses, is changed."""
    table = gridded(error)
    result = fit([table], LENGTH, {})
    y = table.forces["Y"]
    gap = y[-2] - y[FULL.index(4.0)]

    def judged(shift: float) -> tuple[float, bool, tuple[str, ...]]:
        changed = np.array(y)
        changed[row] += shift * gap
        moved = replace(table, forces={**table.forces, "Y": changed})
        found = budgets_of(result, {moved.name: moved})
        b = next(b for b in found if b.symbol == "Yv")
        assert b.u95 is not None
        return b.u95, b.grid.convergence.convergence.converges, tuple(f.code for f in open_parts(found))

    before, converges, codes = judged(0.0)
    assert converges
    assert "budget.grid_not_converging" not in codes
    after, converges, codes = judged(by)
    if not converges:
        assert after >= before * (1.0 - 1e-9)
        assert "budget.grid_not_converging" in codes


def test_a_study_without_a_limit_travels_with_the_numbers() -> None:
    table = gridded()
    y = np.array(table.forces["Y"])
    y[-2] *= 1.5
    table = replace(table, forces={**table.forces, "Y": y})
    plain = fit([table], LENGTH, {})
    found = budgets_of(plain, {table.name: table})
    made = with_budget(plain, found)
    (warned,) = (f for f in made.findings if f.severity is Severity.WARN)
    assert warned.code == "budget.grid_not_converging"
    assert warned.statistic == pytest.approx(found[0].part("grid") / abs(found[0].value))
    assert warned["component"] == ("Y",)
    (noted,) = (f for f in made.findings if f.code == "budget.not_assessed")
    assert "turbulence model" in noted["parts"]
    assert any(name.startswith("grid (study") for name in found[0].unassessed)


def test_covariance_of_common_errors_cancels_in_the_centre_of_pressure() -> None:
    plain, tables = both(None)
    bare = centre_of_pressure(with_budget(plain, budgets_of(plain, tables)).coefficients, plain.campaign)[0]
    for name, same in (("speed", True), ("density", True), ("force", False), ("moment", False)):
        result, tables = both(InputUncertainty(**{name: 0.05}))
        found = budgets_of(result, tables)
        whole = covariance(result.coefficients, found)
        assert np.min(np.linalg.eigvalsh(whole)) > -1e-12 * np.max(whole)
        x = centre_of_pressure(with_budget(result, found).coefficients, result.campaign)[0]
        assert x.value == bare.value
        assert (x.result.linear == pytest.approx(bare.result.linear, rel=1e-4)) is same
        assert x.result.monte_carlo == pytest.approx(x.result.linear, rel=0.03)


def test_a_ratio_over_an_interval_with_zero_has_none() -> None:
    result, tables = both(None)
    found = [replace(b, parts=(*b.parts, BudgetPart("grid", abs(b.value), None))) for b in budgets_of(result, tables)]
    x = centre_of_pressure(with_budget(result, found).coefficients, result.campaign)[0]
    assert x.result is None
    assert "divides by Yv'" in x.statement


def test_a_grid_error_as_large_as_the_value_opens_its_sign() -> None:
    result, tables = both(None)
    plain = budgets_of(result, tables)
    wide = [
        replace(b, u95=1.01 * abs(b.value), parts=(*b.parts, BudgetPart("grid", abs(b.value), None))) for b in plain
    ]
    before = {c.symbol: c.status for c in with_budget(result, plain).coefficients.coefficients if c.value}
    after = {c.symbol: c.status for c in with_budget(result, wide).coefficients.coefficients if c.value}
    known = [b.symbol for b in plain if b.u95 is not None and before[b.symbol] is Status.OK]
    assert known
    assert all(after[symbol] is Status.SIGN_OPEN for symbol in known)


def parameters(values: dict[str, tuple[float, float]], mass: bool = True) -> ParameterFile:
    k = len(values)
    return ParameterFile.model_validate(
        {
            "name": "made", "body": "b", "scaling": {"length": 2.0, "length_name": "LOA"},
            "reference_point": {"point": [0, 0, 0], "datum": "nose"},
            "conditions": {"density": 1000.0, "speed": 1.5},
            "mass": {"mass": 72.0, "mass_moment": 0.0, "mass_prime": 0.018, "mass_moment_prime": 0.0} if mass else None,
            "coefficients": [
                {"symbol": s, "value": v, "u95": u, "unit": "1", "value_si": None, "unit_si": derivative(s.removesuffix("'")).unit, "status": "ok",
                 "origin": "fit", "parts": {}, "campaign": "tow"}
                for s, (v, u) in values.items()
            ],
            "covariance": {
                "symbols": list(values),
                "matrix": np.diag([(u / 2) ** 2 for _, u in values.values()]).reshape(k, k).tolist(),
            },
            "covered": [], "provenance": {"coeflab_version": "0", "study": "s", "inputs": [], "citations": []},
        }
    )  # fmt: skip


HORIZONTAL = {"Yv'": (-0.028, 0.001), "Nv'": (-0.014, 0.0005), "Yr'": (0.005, 0.0005), "Nr'": (-0.0045, 0.0002)}


def test_the_stability_index_with_a_budget() -> None:
    (g,) = stability(parameters(HORIZONTAL))
    assert g.value == pytest.approx(1.0 - (-0.014 * (0.005 - 0.018)) / (-0.028 * -0.0045))
    assert g.result.monte_carlo == pytest.approx(g.result.linear, rel=0.03)
    relative = np.array([0.001 / 0.028, 0.0005 / 0.014, 0.0005 / 0.013, 0.0002 / 0.0045])
    assert g.result.linear == pytest.approx((1.0 - g.value) * np.linalg.norm(relative))
    (wider,) = stability(parameters(HORIZONTAL | {"Yv'": (-0.028, 0.004)}))
    assert wider.result.linear > 1.5 * g.result.linear


def test_a_stability_index_that_cannot_be_bounded() -> None:
    (g,) = stability(parameters(HORIZONTAL | {"Nr'": (-0.0045, 0.005)}))
    assert g.result is None
    assert "Nr' - xG'm'" in g.statement
    assert stability(parameters(HORIZONTAL, mass=False)) == ()
    assert stability(parameters({"Yv'": (-0.028, 0.001)})) == ()


def sided(kind: str, value: float, u95: float | None, **parts: float) -> Budget:
    return Budget(
        "Yv", kind, "b", "t", kind, value, tuple(BudgetPart(n.replace("_", " "), h, None) for n, h in parts.items()), u95,
        (), None, None, None, ("turbulence model",) if kind == "cfd" else (),
    )  # fmt: skip


def test_validation_holds_the_comparison_error_against_its_uncertainty() -> None:
    s = sided("cfd", -0.030, 0.9, random=0.0003, grid=0.0004, model_form=0.0012)
    v = validation(s, sided("experiment", -0.028, 0.0))
    assert v.error == pytest.approx(-0.002)
    assert v.u_validation == pytest.approx(0.0013)
    assert v.within is False
    assert "modelling error" in v.statement
    assert "turbulence model" in v.statement
    assert v.u_input is None
    near = validation(s, sided("experiment", -0.028, 0.002))
    assert near.u_validation == pytest.approx(np.hypot(0.0013, 0.002))
    assert near.within is True
    none = validation(s, sided("experiment", -0.028, None))
    assert none.within is None
    assert "no verdict" in none.statement


def test_validation_brings_the_measurement_to_the_length_of_the_computation() -> None:
    v = validation(sided("cfd", -0.030, 0.1, random=0.001), sided("experiment", -0.028, 0.002), ratio=1.1)
    assert v.measured == pytest.approx(-0.0308)
    assert v.u_measured == pytest.approx(0.0022)


def section(tmp_path: Path, text: str) -> InputUncertainty | None:
    file = tmp_path / "campaign.toml"
    file.write_text("x = 1\n" + text)
    toml = read_toml(file)
    return declared_key(toml, "uncertainty", InputUncertainty) if "uncertainty" in toml.content else None


def test_declared_input_uncertainties(tmp_path: Path) -> None:
    assert section(tmp_path, "") is None
    found = section(tmp_path, '[uncertainty]\nangle = "0.1 deg"\nspeed = 0.005\nreference_point = "5 mm"\n')
    assert found.angle == pytest.approx(np.radians(0.1))
    assert found.reference_point == pytest.approx(0.005)
    assert found.declared == ("angle", "speed", "reference_point")
    by_cent = section(tmp_path, '[uncertainty]\nspeed = "0.5 %"\n')
    assert by_cent.speed == pytest.approx(0.005)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("speed = 0.0", "above zero"),
        ("speed = -0.1", "above zero"),
        ("force = 5.0", "One per cent is 0.01"),
        ('force = "60 %"', "up to 0.5"),
        ('force = "1 %%"', "unreadable unit"),
        ("sped = 0.1", "Did you mean uncertainty.speed"),
        ('angle = "1 m"', "another dimension"),
    ],
)
def test_impossible_declarations_are_refused(tmp_path: Path, line: str, said: str) -> None:
    with pytest.raises(InputError, match="uncertainty") as why:
        section(tmp_path, f"[uncertainty]\n{line}\n")
    assert said in str(why.value)


def test_cells_are_read_from_their_column(tmp_path: Path) -> None:
    file = tmp_path / "t.csv"
    file.write_text("beta [deg],Y [N],cells\n0,1,1000\n2,3,-5\n")
    assert len(read_cells(file)) == 2
    table = small_table(HALF)
    with pytest.raises(InputError, match="above zero") as why:
        with_declarations(table, file, "cells")
    assert why.value.line == 3
    with pytest.raises(InputError, match="no column grid"):
        with_declarations(table, file, "grid")
    assert with_declarations(table, file).cells is None


def test_a_campaign_declares_cells_and_uncertainty_for_its_tables(tmp_path: Path) -> None:
    folder = tmp_path / "campaign"
    shutil.copytree(shipped("cfd_data") / "suboff_cfd_barehull", folder)
    text = (folder / "campaign.toml").read_text()
    assert 'cells = "cells"' in text
    (folder / "campaign.toml").write_text(text + "\n[uncertainty]\nspeed = 0.01\n")
    campaign = read_campaign(folder / "campaign.toml")
    for t in declared(read_tables(PlannedTable(folder, (), {})), campaign):
        assert t.uncertainty.declared == ("speed",)
        assert sorted(set(t.cells)) == [192998.0, 607541.0, 1169985.0]


@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_the_covariance_has_the_budgets_u95_on_its_diagonal(shift: float) -> None:
    result, tables = both(EVERY, shift)
    found = budgets_of(result, tables)
    expected = [(float(b.u95 or 0.0) / 2.0) ** 2 for b in found]
    assert np.diag(covariance(result.coefficients, found)) == pytest.approx(expected, rel=1e-9)


def test_the_grid_in_use_need_not_be_the_finest() -> None:
    table = gridded()
    usable = {c: np.array(m) for c, m in table.usable.items()}
    for m in usable.values():
        m[FULL.index(4.0)], m[-2] = False, True
    (study,) = grid_studies(replace(table, usable=usable), "N")
    assert study.cells_used == 1_000_000
    assert study.convergence.relative == pytest.approx(1.25 * 0.2 / 1.2, rel=1e-6)

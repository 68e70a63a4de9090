"""Studies of domain, turbulence model and iterations: out of the fit; in U95 by how far they differ, but for the model."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.uncertainty.budget import Budget, budgets_of, with_budget
from coeflab.fits.uncertainty.grid_studies import grid_studies, variant_studies
from coeflab.fits.uncertainty.model_budget import with_model_budgets
from coeflab.report.tables.budgets import budget as budget_table
from coeflab.report.tables.budgets import variant_studies as study_table
from coeflab.study.validation import validation
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.reading import read_tables

# beta, grid, cells, iterations, X, Y, Z, K, M, N, se_Y, se_N, se_X, wall: 4 deg of the bare hull with one thing changed.
ROW = '4,A,{cells},250,-39.4,{Y},0,0,0,{N},.12,.06,.07,347,"{variant}",{doubtful}'
CHANGED = (
    ("domain = 1.5", 700000, 18.622, 146.47, ""),
    ("turbulence = realizable k-epsilon", 607541, 20.522, 145.47, ""),
    ("turbulence = SpalartAllmaras", 607541, 17.522, 146.97, ""),
    ("iterations=500", 607541, 18.022, 146.49, ""),
    ("domain=1.5, turbulence=kEpsilon", 700000, 99.0, 999.0, ""),
)


def campaign(folder: Path, changed: tuple[tuple[str, int, float, float, str], ...] = CHANGED) -> Path:
    """The shipped bare hull with the rows of some studies."""
    shutil.copytree(shipped("cfd_data") / "suboff_cfd_barehull", folder)
    table = folder / "drift.csv"
    head, *rows = table.read_text().splitlines()
    rows = [f"{row},{'matrix' if i % 2 else ''}," for i, row in enumerate(rows)]
    rows += [ROW.format(variant=v, cells=c, Y=y, N=n, doubtful=d) for v, c, y, n, d in changed]
    table.write_text("\n".join([f"{head},variant,uncertain", *rows]) + "\n")
    text = (folder / "campaign.toml").read_text()
    first = text.index('sha256 = "f69')
    text = text[:first] + 'variant = "variant"\n' + text[text.index("contains_inertia", first) :]
    (folder / "campaign.toml").write_text(text)
    return folder


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> tuple[ForceTable, ...]:
    return read_tables(PlannedTable(campaign(tmp_path_factory.mktemp("studies") / "c"), ()))


@pytest.fixture(scope="module")
def bare() -> tuple[ForceTable, ...]:
    return read_tables(PlannedTable(shipped("cfd_data") / "suboff_cfd_barehull", ()))


def fitted(tables: tuple[ForceTable, ...]) -> tuple[FitResult, dict[str, Budget]]:
    fit = FITS.load("slope_at_origin").fit(tables, tables[0].scaling, {})
    return fit, {b.symbol: b for b in budgets_of(fit, {t.name: t for t in tables})}


@pytest.fixture(scope="module")
def with_studies(tables: tuple[ForceTable, ...]) -> tuple[FitResult, dict[str, Budget]]:
    return fitted(tables)


@pytest.fixture(scope="module")
def without(bare: tuple[ForceTable, ...]) -> tuple[FitResult, dict[str, Budget]]:
    return fitted(bare)


def half(used: float, *others: float, noise: float = 0.0) -> float:
    return float(2.0 / 3.0**0.5 * max(max(abs(o - used), noise) for o in others))


def test_rows_of_studies_stay_out_of_the_fit_and_of_the_grid_study(
    tables: tuple[ForceTable, ...], bare: tuple[ForceTable, ...]
) -> None:
    drift = tables[0]
    assert [e.reason for e in drift.exclusions if "study" in e.reason and e.row >= len(bare[0])] == [
        f"study only: {v.replace(' = ', '=').replace('=', ' = ')}" for v, *_ in CHANGED
    ]
    assert not np.any(drift.usable["Y"][len(bare[0]) :])
    assert grid_studies(drift, "Y")[0].convergence == grid_studies(bare[0], "Y")[0].convergence


def test_half_widths_are_those_of_a_rectangle_that_reaches_to_the_farthest(tables: tuple[ForceTable, ...]) -> None:
    found = {s.name: s for s in variant_studies(tables[0], "Y")}
    assert list(found) == ["domain size", "turbulence model", "iterations"]
    noise = 2.0 * float(np.hypot(0.122, 0.12))
    assert found["turbulence model"].half_width == pytest.approx(half(18.522, 20.522, 17.522))
    assert found["iterations"].half_width == pytest.approx(half(18.522, 18.022))
    assert found["domain size"].half_width == pytest.approx(half(18.522, 18.622, noise=noise), rel=1e-6)
    assert found["turbulence model"].setting.startswith("v = -0.14")


def test_parts_of_the_budget_are_relative_to_the_force_in_use(
    with_studies: tuple[FitResult, dict[str, Budget]], without: tuple[FitResult, dict[str, Budget]]
) -> None:
    b, before = with_studies[1]["Yv"], without[1]["Yv"]
    assert b.value == before.value
    model = half(18.522, 20.522, 17.522) / 18.522 * abs(b.value)
    assert b.part("turbulence model") is None
    assert b.model_spread == pytest.approx(model)
    more = [b.part(n) or 0.0 for n in ("domain size", "iterations")]
    assert min(more) > 0.0
    assert b.u95 == pytest.approx(float(np.sqrt((before.u95 or 0.0) ** 2 + np.sum(np.square(more)))))
    assert "turbulence model" in before.unassessed
    assert "domain and boundary conditions" in before.unassessed
    assert before.model_spread is None
    assert {"turbulence model, its spread stated beside U95", "boundary conditions"} <= set(b.unassessed)
    assert with_studies[1]["Yr"].model_spread is None


def test_u95_and_covariance_of_the_fit_hold_the_parts(with_studies: tuple[FitResult, dict[str, Budget]]) -> None:
    fit, found = with_studies
    wide = with_budget(fit, tuple(found.values())).coefficients
    assert wide["Yv"].u95 == found["Yv"].u95
    grid = found["Yv"].part("grid") or 0.0
    rest = [found["Yv"].part(n) or 0.0 for n in ("domain size", "iterations")]
    at = list(wide.symbols).index(next(s for s in wide.symbols if s.removesuffix("'") == "Yv"))
    added = wide.covariance[at, at] - fit.coefficients.covariance[at, at]
    assert added == pytest.approx((grid**2 + float(np.sum(np.square(rest)))) / 4.0)


def test_a_fitted_law_shares_the_parts_among_its_terms(tables: tuple[ForceTable, ...]) -> None:
    plugin = FITS.load("manoeuvring_model")
    fit = plugin.fit(tables, tables[0].scaling, {})
    wide, found = with_model_budgets(fit, tables, tables[0].scaling, lambda t, s: plugin.fit(t, s, {}), draws=2)
    law = next(m for m in wide.models if m.response == "Y")
    assert not any(name.startswith("turbulence") for name in law.shared)
    shift = next(v for name, v in law.shared.items() if name.startswith("iterations at v"))
    by = dict(zip(law.symbols, shift / np.where(law.fit.coefficients, law.fit.coefficients, 1.0), strict=True))
    assert by["Yv"] == pytest.approx(half(18.522, 18.022) / 18.522)
    assert by["Yr"] == 0.0
    spread = {b.symbol: b.model_spread for b in found}
    assert spread["Yr"] is None
    assert spread["Yv"] == pytest.approx(
        half(18.522, 20.522, 17.522) / 18.522 * abs(law.fit.coefficients[law.symbols.index("Yv")])
    )


def test_a_validation_holds_all_but_the_turbulence_model(
    with_studies: tuple[FitResult, dict[str, Budget]],
) -> None:
    b = with_studies[1]["Yv"]
    measured = replace(b, kind="experiment", parts=(), u95=abs(0.05 * b.value))
    v = validation(b, measured)
    assert v.u_numerical == pytest.approx(b.joined("random", "grid", "domain size", "iterations"))
    assert "turbulence model" in v.lacking


def test_a_run_that_did_not_converge_is_not_judged(tmp_path: Path) -> None:
    changed = (("turbulence = realizable k-epsilon", 607541, 30.0, 146.0, "Y"), CHANGED[2])
    drift = read_tables(PlannedTable(campaign(tmp_path / "c", changed), ()))[0]
    (found,) = variant_studies(drift, "Y")
    assert found.changed == (("turbulence = SpalartAllmaras", 17.522),)


def test_a_study_of_the_iterations_judges_a_run_that_ended_sooner(tmp_path: Path) -> None:
    changed = (
        ("iterations = 60", 607541, 19.522, 146.0, "Y N,unconverged"),
        ("iterations = 70", 607541, 9.0, 9.0, "Y N,diverged"),
    )
    folder = campaign(tmp_path / "c", changed)
    head, *rows = (folder / "drift.csv").read_text().splitlines()
    rows = [row if row.endswith(("ged", "unconverged")) else f"{row},converged" for row in rows]
    (folder / "drift.csv").write_text("\n".join([f"{head},status", *rows]) + "\n")
    text = (folder / "campaign.toml").read_text().replace('labels = ["grid"]', 'labels = ["grid", "status"]', 1)
    (folder / "campaign.toml").write_text(text)
    (found,) = variant_studies(read_tables(PlannedTable(folder, ()))[0], "Y")
    assert found.changed == (("iterations = 60", 19.522),)


def test_another_grid_is_judged_for_the_domain_only(tmp_path: Path) -> None:
    changed = (("turbulence = realizable k-epsilon", 192998, 20.0, 146.0, ""), ("domain = 2", 900000, 18.0, 146.0, ""))
    drift = read_tables(PlannedTable(campaign(tmp_path / "c", changed), ()))[0]
    assert [s.name for s in variant_studies(drift, "Y")] == ["domain size"]


@pytest.mark.parametrize(
    "text", ["kEpsilon", "model = kEpsilon", "domain =", "domain = 1.5 = 2", "domain = 1.5, model = k"]
)
def test_a_change_of_no_known_study_is_refused_by_line(tmp_path: Path, text: str) -> None:
    folder = campaign(tmp_path / "c", ((text, 1000, 1.0, 1.0, ""),))
    with pytest.raises(InputError, match=r"domain = \.\.\., turbulence = \.\.\., iterations") as why:
        read_tables(PlannedTable(folder, ()))
    assert why.value.line == len((folder / "drift.csv").read_text().splitlines())
    assert why.value.column == "variant"


def test_the_tables_name_what_was_changed(with_studies: tuple[FitResult, dict[str, Budget]]) -> None:
    shown = study_table(tuple(with_studies[1].values()))
    at = next(i for i, r in enumerate(shown.rows) if r[:2] == ("turbulence model", "Y"))
    assert [r[3:6] for r in shown.rows[at : at + 3]] == [
        ("in use", "18.522", "0.0 %"),
        ("turbulence = realizable k-epsilon", "20.522", "10.8 %"),
        ("turbulence = SpalartAllmaras", "17.522", "5.4 %"),
    ]
    notes = " ".join(budget_table(with_studies[1]["Yv"]).notes)
    assert "turbulence model: 18.52 in use, realizable k-epsilon 20.52, SpalartAllmaras 17.52" in notes

"""When a computed coefficient has a verdict, when that is weak, and how often a measured number counts."""

from __future__ import annotations

import shutil
from dataclasses import replace

import pytest

from coeflab.core.files import shipped
from coeflab.fits.uncertainty.budget import Budget, BudgetPart, OpenGrid
from coeflab.fits.uncertainty.grid_convergence import Convergence
from coeflab.report import acceptance, first_page_notes
from coeflab.report.acceptance import Basis, headline_of_study, held_of_study
from coeflab.report.tables.budgets import predictions
from coeflab.report.tables.own_cfd import own_tow, tow_against
from coeflab.study.plan import read_plan
from coeflab.study.run import run
from coeflab.study.study import Study
from coeflab.study.towed import Towed, towed
from coeflab.study.validation import Validation, by_measured_number, validation, validations
from tests.study.test_own_tows import HEAD, tow_of_the_bare_hull

SAME_WATER = (14e6, 14e6)


def sided(
    kind: str, value: float, u95: float, symbol: str = "Yv", grid: OpenGrid | None = None, campaign: str = ""
) -> Budget:
    return Budget(
        symbol, campaign or kind, "hull", "t", kind, value, (BudgetPart("random", u95, None),), u95, (), None, None, None,
        ("turbulence model",) if grid is None else (grid.name,), open_grid=grid,
    )  # fmt: skip


def compared(
    value: float, u95: float, *, symbol: str = "Yv", grid: OpenGrid | None = None, by: str = "cfd"
) -> Validation:
    s = sided("cfd", value, 0.001, symbol, grid, by)
    return validation(s, sided("experiment", -0.028, u95, symbol), reynolds=SAME_WATER)


@pytest.mark.parametrize(
    ("grid", "left_out", "why", "reason"),
    [
        (OpenGrid(None), "grid", "no grid study", "no grid study"),
        (OpenGrid(Convergence.DIVERGENT), "grid (study divergent)", "grid study divergent", "grid study diverged"),
        (OpenGrid(Convergence.NOISE, bound=True), "grid (study within the iteration noise: a bound only)",
         "grid study within the iteration noise: a bound only", "no error from the grid study: within the iteration noise"),
        (None, "turbulence model", "", ""),
    ],
)  # fmt: skip
def test_without_the_error_of_the_grid_there_is_no_verdict(
    grid: OpenGrid | None, left_out: str, why: str, reason: str
) -> None:
    v = compared(-0.029, 0.002, grid=grid)
    assert v.lacking == (left_out,)
    assert v.reasons == ((reason,) if reason else ())
    assert v.why_none == why
    assert v.within is (None if why else True)
    assert v.u_validation is not None
    assert (f"no verdict: {why}" in v.statement) is bool(why)


@pytest.mark.parametrize(
    ("symbol", "reynolds", "has_verdict"),
    [
        ("X0", (8.49e6, 14e6), False), ("X0", (14e6, 8.49e6), False), ("Xu|u|", (8.49e6, 14e6), False),
        ("X0", (12e6, 14e6), True), ("X0", (8.49e6, None), False), ("Xvv", (8.49e6, 14e6), True), ("Yv", (None, None), True),
    ],
)  # fmt: skip
def test_drag_at_another_reynolds_number_has_no_verdict(
    symbol: str, reynolds: tuple[float | None, float | None], has_verdict: bool
) -> None:
    """0.075 / (log10 Re - 2)^2 differs by 8.7 % between 8.49e6 and 14e6, by 2.5 % between 12e6 and 14e6."""
    v = validation(sided("cfd", -1.0, 0.1, symbol), sided("experiment", -1.0, 0.1, symbol), reynolds=reynolds)
    assert (v.within is not None) is has_verdict
    if None not in reynolds and not has_verdict:
        assert "friction differs by 9 %" in v.why_none or "friction differs by 8 %" in v.why_none


def test_what_symmetry_makes_zero_has_no_verdict() -> None:
    """A test that finds K on a body of revolution has a bias: no computation predicts it, and none misses it."""
    v = replace(compared(0.0, 0.002, symbol="Kv"), zero=True)
    assert v.beyond
    assert (v.within, v.why_none) == (None, "zero by symmetry")
    assert v.reasons == ("zero by symmetry, and the test has a bias",)
    assert not by_measured_number((v,))


def test_a_weak_prediction_lies_within_a_wide_u_v() -> None:
    wide, narrow, missed = compared(-0.029, 0.008), compared(-0.029, 0.006), compared(-0.040, 0.008)
    assert (wide.weak, narrow.weak, missed.weak) == (True, False, False)
    assert wide.share == "29 %"
    assert predictions((wide,)).rows[0][-1] == "weak: U_V is 29 % of D"


def test_a_measured_number_counts_once(
    bodies: tuple[Study, tuple[Towed, ...]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two computations of one number: it holds where both do."""
    first = compared(-0.029, 0.006)
    second = compared(-0.027, 0.006, by="tow")
    missed = compared(-0.040, 0.006, by="tow")
    open_one = compared(-0.029, 0.006, symbol="Nv", grid=OpenGrid(None))
    study = replace(bodies[0], comparisons=(), references=())
    for found, good in (((first, second, open_one), 1), ((first, missed, open_one), 0)):
        for module in (acceptance, first_page_notes):
            monkeypatch.setattr(module, "validations", lambda *_, found=found: found)
        assert held_of_study(study)[Basis.VALIDATION] == (good, 1)
        said = " ".join(headline_of_study(study))
        assert f"{good} of 1 coefficients predicted by CFD" in said
        assert (
            "2 comparisons judge them; a coefficient of several campaigns passes if all of its comparisons do" in said
        )
        assert "No verdict on Nv' (no grid study)." in said
        assert f"CFD predicts {good} of 1 judged coefficients" in first_page_notes._independent(study)


@pytest.fixture(scope="module")
def bodies(tmp_path_factory: pytest.TempPathFactory) -> tuple[Study, tuple[Towed, ...]]:
    """The bare hull towed on one grid: no grid study."""
    place = tmp_path_factory.mktemp("one_grid")
    shutil.copy(shipped("cfd_data") / "suboff" / "published.toml", place)
    tow = tow_of_the_bare_hull(place, "suboff_tow_bare_hull", "suboff_bare_hull")
    for file in ("drift.csv", "rotating_arm.csv"):
        head, *rows = (tow / file).read_text().splitlines()
        at = head.split(",").index("grid")
        (tow / file).write_text("\n".join([head, *(r for r in rows if r.split(",")[at] == "A")]) + "\n")
    text = (shipped("cfd_data") / "suboff" / "plan.toml").read_text()
    whole = text[text.index("[[tow]]") : text.index('[[tow]]\nname = "hull with')].replace('"../', '"')
    (place / "plan.toml").write_text(HEAD + whole)
    study = run(read_plan(place / "plan.toml"))
    return study, towed(study)


def test_a_tow_without_a_grid_study_has_no_verdict(bodies: tuple[Study, tuple[Towed, ...]]) -> None:
    study, (tow,) = bodies
    by = {r.symbol: r for r in tow.rows}
    for symbol in ("Yv", "Nv"):
        assert by[symbol].verdict is None
        assert by[symbol].why_none == "no grid study"
        assert by[symbol].validation is not None
    table = tow_against(tow)
    assert {row[-1] for row in table.rows} == {"no verdict"}
    assert "No verdict on Yv', Nv': no grid study." in table.notes
    assert all(v.within is None for v in validations(study, study.budgets))
    assert held_of_study(study)[Basis.VALIDATION] == (0, 0)


def test_tables_of_tows_print_both_reynolds_numbers(bodies: tuple[Study, tuple[Towed, ...]]) -> None:
    """2 m/s, 4.26086 m, 1e-6 m^2/s; the test states 14e6."""
    _, (tow,) = bodies
    assert tow.reynolds == pytest.approx(8.52e6, rel=1e-3)
    assert "Re 8.52e6" in own_tow(tow).notes[0]
    assert "Re: 8.52e6 in the CFD, 14e6 in suboff_roddy_3." in tow_against(tow).notes

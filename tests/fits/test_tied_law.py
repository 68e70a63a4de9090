"""The law beyond its slopes comes back from planted truths, and leaves the slopes alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.provenance import Source
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.statistics.diagnostics import allowed_miss, scatter_of_replicates
from coeflab.law.coefficient import Coefficient, CoefficientSet, Status
from coeflab.law.named_terms import read_term
from coeflab.tables.force_table import ForceTable
from tests.report.studies import CONDITIONS, LENGTH, small_table

ANGLES = [-18.0, -14.0, -12.0, -10.0, -8.0, -6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 18.0]


def planted(truth: dict[str, float], rows: dict[str, np.ndarray], noise: float = 0.0, seed: int = 1) -> ForceTable:
    """A table whose primed forces are those of terms, over primed motions and controls."""
    n, speed, length = len(next(iter(rows.values()))), CONDITIONS.speed, LENGTH.length
    zero, draw = np.zeros(n), np.random.default_rng(seed)
    v, w = rows.get("v", zero), rows.get("w", zero)
    motion = {"u": speed * np.sqrt(1.0 - v**2 - w**2), "v": speed * v, "w": speed * w}
    motion |= {m: rows.get(m, zero) * speed / length for m in "pqr"}
    columns = {m: rows.get(m, zero) for m in ("v", "w", "p", "q", "r", "dr")}
    components = dict.fromkeys(s[0] for s in truth)
    forces = {}
    for c in components:
        primes = sum(k * read_term(s, "truth").term.evaluate(columns) for s, k in truth.items() if s[0] == c)
        primes = primes + noise * draw.standard_normal(n)
        power = 2 if c in "XYZ" else 3
        forces[c] = primes * 0.5 * CONDITIONS.density * speed**2 * length**power
    return replace(
        small_table(ANGLES),
        motion=motion,
        controls={"dr": rows["dr"]} if "dr" in rows else {},
        speed=np.full(n, speed),
        forces=forces,
        usable={c: np.ones(n, dtype=bool) for c in forces},
        exclusions=(),
        labels=tuple(str(i) for i in range(n)),
        source=Source("synthetic", kind="synthetic"),
    )


def slopes(table: ForceTable, **values: float) -> FitResult:
    """What another fit found, each with 10 %."""
    found = tuple(
        Coefficient(s, v, 0.1 * abs(v), Status.OK, table.body, origin="fit", table=table.name, campaign=table.campaign)
        for s, v in values.items()
    )
    covariance = np.diag([(0.05 * v) ** 2 for v in values.values()])
    among = CoefficientSet(found, covariance, LENGTH, table.reference_point, table.datum, table.body)
    return FitResult("slope_at_origin", table.campaign, table.body, among, (), (), {})


def beyond(table: ForceTable, options: dict[str, str] | None = None, **values: float) -> FitResult:
    found: FitResult = FITS.load("tied_law").complete(slopes(table, **values), [table], LENGTH, options or {})  # type: ignore[attr-defined]
    return found


V = np.sin(np.radians(ANGLES))


@pytest.mark.parametrize(
    "more",
    [{}, {"Yv|v|": -0.1}, {"Yvvv": -0.3}, {"Yv|v|": 0.05, "Yvvv": -0.4}],
    ids=["line", "square", "cubic", "both"],
)
def test_planted_forms_come_back_with_their_slope_and_no_other_term(more: dict[str, float]) -> None:
    found = beyond(planted({"Yv": -0.03, "Y0": 1e-4, **more}, {"v": V}), Yv=-0.03)
    assert set(found.coefficients.symbols) == set(more)
    for symbol, value in more.items():
        assert found.coefficients[symbol].value == pytest.approx(value, rel=1e-6)
    assert found.tied.set_up == (("tow/table.csv", "Y0", pytest.approx(1e-4, rel=1e-6)),)


def test_terms_move_with_the_slope_and_carry_its_uncertainty() -> None:
    table = planted({"Yv": -0.03, "Yv|v|": -0.1}, {"v": V}, noise=1e-5)
    first, other = beyond(table, Yv=-0.03), beyond(table, Yv=-0.03001)
    assert first.coefficients.symbols == other.coefficients.symbols == ("Yv|v|",)
    one, two = first.coefficients["Yv|v|"], other.coefficients["Yv|v|"]
    assert (two.value - one.value) / -1e-5 == pytest.approx(first.tied.moves[0, 0], rel=1e-6)
    assert one.parts.input == pytest.approx(abs(first.tied.moves[0, 0]) * 0.003, rel=1e-9)
    assert one.u95 == pytest.approx(np.hypot(one.parts.random or 0.0, one.parts.input or 0.0), rel=1e-9)


def test_intervals_of_a_planted_square_cover_it() -> None:
    hits = 0
    for seed in range(40):
        table = planted({"Yv": -0.03, "Yv|v|": -0.1}, {"v": V}, noise=1e-4, seed=seed)
        found = beyond(table, Yv=-0.03 + 0.0015 * np.random.default_rng(seed + 100).standard_normal()).coefficients
        hits += "Yv|v|" in found and abs((found["Yv|v|"].value or 0.0) + 0.1) <= (found["Yv|v|"].u95 or 0.0)
    assert hits >= 34


def test_force_at_rest_stands_in_the_law_where_symmetry_allows_it() -> None:
    table = planted({"Z0": 2e-4, "Zw": -0.014, "Zw|w|": -0.06, "Zww": 0.01}, {"w": V})
    found = beyond(table, Zw=-0.014)
    assert set(found.coefficients.symbols) == {"Z0", "Zw|w|", "Zww"}
    assert found.coefficients["Z0"].value == pytest.approx(2e-4, rel=1e-6)
    assert "Z0" not in beyond(table, {"at_rest": "apart"}, Zw=-0.014).coefficients


def test_x_is_even_in_drift_and_tied_to_its_curvature() -> None:
    found = beyond(planted({"X0": -1e-3, "Xvv": 0.004, "Xvvvv": 0.03}, {"v": V}), X0=-1e-3, Xvv=0.004)
    assert found.coefficients.symbols == ("Xvvvv",)
    assert found.coefficients["Xvvvv"].value == pytest.approx(0.03, rel=1e-6)


def test_x_that_is_odd_in_drift_is_the_set_ups_and_moves_no_term_of_the_law() -> None:
    law = {"X0": -1e-3, "Xvv": 0.004, "Xvvvv": 0.03}
    table = planted({**law, "Xv": -7e-4, "Xv|v|": -2e-3}, {"v": V})
    found = beyond(table, X0=-1e-3, Xvv=0.004)
    assert found.coefficients.symbols == ("Xvvvv",)
    assert found.coefficients["Xvvvv"].value == pytest.approx(0.03, rel=1e-6)
    added = {term: (name, pytest.approx(value, rel=1e-6)) for name, term, value in found.tied.set_up}
    assert added == {"Xv": ("tow/table.csv", -7e-4), "Xv|v|": ("tow/table.csv", -2e-3)}


@pytest.mark.parametrize("rows", [V >= 0.0, -0.4 * V.max() <= V], ids=["one side", "little of the other"])
def test_odd_x_of_one_side_stays_in_what_the_law_misses(rows: np.ndarray) -> None:
    table = planted({"X0": -1e-3, "Xvv": 0.004, "Xv": -7e-4}, {"v": V[rows]})
    found = beyond(table, X0=-1e-3, Xvv=0.004)
    assert found.tied.set_up == ()


def test_cross_terms_where_the_rows_combine_their_motions() -> None:
    v, r = (a.ravel() for a in np.meshgrid(np.linspace(-0.2, 0.2, 5), np.linspace(-0.4, 0.4, 5)))
    truth = {"Yv": -0.03, "Yr": 0.005, "Yv|v|": -0.1, "Yv|r|": 0.02}
    found = beyond(planted(truth, {"v": v, "r": r}), Yv=-0.03, Yr=0.005).coefficients
    assert found["Yv|r|"].value == pytest.approx(0.02, rel=1e-6)
    apart = planted(truth, {"v": np.concatenate([V, 0.0 * V]), "r": np.concatenate([0.0 * V, V])})
    assert "Yv|r|" not in beyond(apart, Yv=-0.03, Yr=0.005).coefficients


def test_a_stall_is_left_out_of_the_range_that_the_law_is_fitted_in() -> None:
    table = planted({"Yv": -0.03, "Yv|v|": -0.1}, {"v": V})
    y = np.array(table.forces["Y"])
    y[[0, -1]] *= 0.6
    found = beyond(replace(table, forces={"Y": y}), Yv=-0.03).coefficients["Yv|v|"]
    assert found.value == pytest.approx(-0.1, rel=1e-6)
    assert found.window == pytest.approx(tuple(np.radians([-14.0, 14.0])))


def test_scatter_is_that_of_runs_which_repeat_a_setting() -> None:
    x = np.array([0.0, 0.1, 0.1, 0.5, 0.504, 1.0])[:, None]
    assert scatter_of_replicates(x, np.array([0.0, 1.0, 3.0, 5.0, 7.0, 0.0])) == pytest.approx(np.sqrt(2.0))
    assert scatter_of_replicates(x[[0, 1, 3, 5]], np.arange(4.0)) is None
    assert allowed_miss(None, 2.0) == pytest.approx(0.1)
    assert allowed_miss(0.1, 2.0) == pytest.approx(0.4)

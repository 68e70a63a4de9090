"""The law of a parameter file against the points behind it: what breaks it fails, what it does not reach is named."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from coeflab.core.finding import Severity
from coeflab.fits import FITS
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.rows.sweeps import not_belonging
from coeflab.law.scaling import Conditions
from coeflab.vehicle.assemble import assemble
from coeflab.vehicle.force_law import points_of
from coeflab.vehicle.gathered import PlannedParameterFile
from coeflab.vehicle.law_at_points import HeldRange, _within
from coeflab.vehicle.parameter_file import ParameterFile, read_parameter_file
from coeflab.vehicle.plausibility import law_findings, plausibility
from tests.fits.test_tied_law import ANGLES, LENGTH, V, beyond, planted, slopes

GROUP = PlannedParameterFile("file", "body of tow", ("tow",), ())
AT = Conditions(1025.0, 2.0)
TRUTH = {"Yv": -0.03, "Yv|v|": -0.1, "Y0": 1e-4, "Nv": -0.014, "Nv|v|": 0.02}
SLOPES = {"Yv": -0.03, "Nv": -0.014}


def made(fits: list[FitResult], table: object) -> ParameterFile:
    return assemble(GROUP, "study", fits, [table], [], [], None, AT, [])  # type: ignore[list-item]


@pytest.fixture(scope="module")
def whole() -> ParameterFile:
    table = planted(TRUTH, {"v": V})
    return made([slopes(table, **SLOPES), beyond(table, **SLOPES)], table)


def changed(p: ParameterFile, symbol: str, factor: float, *, stated_anew: bool = True) -> ParameterFile:
    each = [
        replace(c, value=factor * c.value, value_si=factor * c.value_si) if c.symbol == symbol else c
        for c in p.coefficients
    ]
    out = p.model_copy(update={"coefficients": tuple(each)})
    return out.model_copy(update={"law_at_points": points_of(out)}) if stated_anew else out


def worst(p: ParameterFile) -> Severity:
    order = [Severity.PASS, Severity.NOTE, Severity.WARN, Severity.FAIL]
    return max((c.severity for c in law_findings(p)), key=order.index)


def test_a_planted_law_holds_at_its_points_at_another_density_and_speed(whole: ParameterFile) -> None:
    found = points_of(whole)
    assert [(f.component, f.n_points) for f in found] == [("Y", len(ANGLES)), ("N", len(ANGLES))]
    assert max(f.share for f in found) < 1e-9
    assert worst(whole) is Severity.PASS
    assert whole.law_at_points == found
    assert whole.offered == whole.covered
    assert not whole.narrowed


@pytest.mark.parametrize("symbol", ["Yv'", "Yv|v|'", "Nv'", "Nv|v|'"])
def test_a_flipped_sign_fails_and_names_the_points(whole: ParameterFile, symbol: str) -> None:
    broken = changed(whole, symbol, -1.0)
    assert worst(broken) is Severity.FAIL
    failed = next(c for c in law_findings(broken) if c.severity is Severity.FAIL)
    assert failed.subject.startswith(symbol[0])
    assert "misses 0, 1, 2" in failed.comment.replace("It ", "")
    assert failed.subject in {c.subject for c in plausibility(broken)}


@pytest.mark.parametrize("symbol", ["Yv'", "Yv|v|'", "Nv'", "Nv|v|'"])
@pytest.mark.parametrize("factor", [0.95, 1.05])
def test_five_per_cent_on_one_coefficient_of_a_written_file_fails(
    whole: ParameterFile, symbol: str, factor: float
) -> None:
    """Less than the law may miss its points by, but not the law whose misses the file states."""
    broken = changed(whole, symbol, factor, stated_anew=False)
    failed = [c for c in law_findings(broken) if c.severity is Severity.FAIL]
    assert failed[0].subject.startswith(symbol[0])
    assert "changed after the file was written" in failed[0].comment


def test_a_reading_that_the_slope_leaves_out_moves_no_law_and_is_no_point_of_it() -> None:
    table = planted(TRUTH, {"v": V}, noise=1e-6)
    y = np.array(table.forces["Y"])
    y[12] = -y[12]
    flipped = replace(table, forces={**table.forces, "Y": y})
    usable = np.ones(len(V), dtype=bool)
    usable[12] = False
    named = replace(table, usable={**table.usable, "Y": usable})
    laws = []
    for t in (flipped, named):
        slope = FITS.load("slope_at_origin").fit([t], LENGTH, {})
        beyond_it = FITS.load("tied_law").complete(slope, [t], LENGTH, {})  # type: ignore[attr-defined]
        laws.append(made([slope, beyond_it], t))
    one, other = laws
    assert [c.value for c in one.coefficients] == pytest.approx([c.value for c in other.coefficients])
    assert [(f.component, f.n_points) for f in points_of(one)] == [("Y", len(V) - 1), ("N", len(V))]
    assert worst(one) is Severity.PASS


def test_of_repeated_labels_only_the_setting_that_does_not_fit_is_left_out() -> None:
    table = replace(planted(TRUTH, {"v": V}, noise=1e-6), labels=tuple(str(i % 6) for i in range(len(V))))
    y = np.array(table.forces["Y"])
    y[12] = -y[12]
    flipped = replace(table, forces={**table.forces, "Y": y})
    slope = FITS.load("slope_at_origin").fit([flipped], LENGTH, {})
    assert np.flatnonzero(not_belonging(flipped, "Y", slope.sweeps, LENGTH.length)).tolist() == [12]
    assert not np.any(not_belonging(flipped, "N", slope.sweeps, LENGTH.length))


def test_the_limit_is_five_per_cent_of_the_largest_force(whole: ParameterFile) -> None:
    def all_of_y(factor: float) -> ParameterFile:
        return changed(changed(whole, "Yv'", factor), "Yv|v|'", factor)

    assert worst(all_of_y(1.049)) is Severity.PASS
    assert worst(all_of_y(1.053)) is Severity.FAIL


def test_scatter_of_repeated_runs_widens_the_limit(whole: ParameterFile) -> None:
    table = planted(TRUTH, {"v": np.concatenate([V, V])}, noise=2e-4)
    noisy = made([slopes(table, **SLOPES), beyond(table, **SLOPES)], table)
    y = next(f for f in noisy.measured[0].forces if f.component == "Y")
    unit = 0.5 * 1025.0 * 1.5**2 * 2.0**2
    assert y.scatter == pytest.approx(2e-4 * unit, rel=0.4)
    assert points_of(noisy)[0].allowed > points_of(whole)[0].allowed


def test_a_tangent_names_where_it_holds_and_is_a_warning_with_the_points_left_out() -> None:
    table = planted(TRUTH, {"v": V})
    tangent = made([slopes(table, **SLOPES)], table)
    assert worst(tangent) is Severity.WARN
    y = next(c for c in law_findings(tangent) if c.subject.startswith("Y"))
    assert y.statistic.startswith("points 0, 1, 2")
    assert "16" in y.statistic
    (offered,) = tangent.offered
    assert abs(offered.high) < 0.6 * abs(tangent.covered[0].high)
    assert len(tangent.narrowed) == 1
    assert worst(changed(tangent, "Yv'", -1.0)) is Severity.FAIL


def test_a_row_a_hair_beyond_the_last_that_a_tangent_meets_is_left_out_too() -> None:
    """5.57 degrees is met and ends the range, 5.6 is missed: no row of the range may be one that it was cut for."""
    v = np.sin(np.radians([*ANGLES, 5.57, -5.6]))
    table = planted(TRUTH, {"v": v})
    y = next(c for c in points_of(made([slopes(table, **SLOPES)], table)) if c.component == "Y")
    assert y.missed == ()
    assert str(len(v) - 1) in y.beyond
    assert str(len(v) - 2) not in y.beyond


def test_a_law_beyond_its_slopes_that_misses_within_half_of_its_range_names_no_smaller_one() -> None:
    """A sign that flips between fit and file must not come out as a short range."""
    table = planted(TRUTH, {"v": V})
    law = beyond(table, **SLOPES)
    among = law.coefficients
    flipped = tuple(
        replace(c, value=-5.0 * c.value) if c.value and c.symbol == "Yv|v|" else c for c in among.coefficients
    )
    wrong = made([slopes(table, **SLOPES), replace(law, coefficients=replace(among, coefficients=flipped))], table)
    assert wrong.offered == wrong.covered
    assert worst(wrong) is Severity.FAIL


def test_a_component_next_to_nothing_is_not_judged() -> None:
    table = planted({**TRUTH, "Kvv": 1e-5}, {"v": V})
    values = {**SLOPES, "Kv": 1e-6}
    found = {f.component: f for f in points_of(made([slopes(table, **values), beyond(table, **values)], table))}
    assert found["K"].small
    assert found["K"].missed
    assert not found["N"].small


def test_odd_x_of_the_set_up_is_taken_off_the_points_and_said() -> None:
    truth, tied = {"X0": -1e-3, "Xvv": 0.004, "Xv": -7e-4}, {"X0": -1e-3, "Xvv": 0.004}
    table = planted(truth, {"v": V})
    file = made([slopes(table, **tied), beyond(table, **tied)], table)
    assert {c.symbol for c in file.coefficients} == {"X0'", "Xvv'"}
    (at,), (found,) = points_of(file), law_findings(file)
    assert (at.n_points, at.beyond) == (len(V), ())
    assert at.share < 1e-9
    share = 100.0 * 7e-4 * V.max() / float(np.abs(table.primed_force("X", 2.0)).max())
    assert (
        f"An error of the set-up is subtracted, up to {share:.2g} %: the part of X that is odd in the drift"
        in found.statistic
    )
    assert found.severity is Severity.PASS


def test_points_and_range_travel_with_the_file_and_earlier_versions_have_none(whole: ParameterFile, tmp_path) -> None:
    path = tmp_path / "file.json"
    path.write_bytes(whole.to_json())
    again = read_parameter_file(path)
    assert again == whole
    old = ParameterFile.model_validate(
        {**whole.model_dump(exclude={"measured", "law_holds", "law_at_points"}), "schema_version": "1.3"}
    )
    path.write_bytes(old.to_json())
    assert b"law_holds" not in old.to_json()
    assert read_parameter_file(path).measured == ()
    assert points_of(old) == ()
    assert read_parameter_file(path).offered == old.covered


def test_covariance_joins_slopes_and_what_is_tied_to_them(whole: ParameterFile) -> None:
    names = whole.covariance.symbols
    i, j = names.index("Yv'"), names.index("Yv|v|'")
    table = planted(TRUTH, {"v": V})
    tied = beyond(table, **SLOPES).tied
    row = whole.covariance.matrix[i]
    assert row[j] == pytest.approx(tied.moves[0, 0] * 0.0015**2, rel=1e-6)
    matrix = np.array(whole.covariance.matrix, dtype=float)
    assert np.linalg.eigvalsh(matrix / np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))).min() > -1e-9


@pytest.mark.parametrize(("low", "high", "kept"), [(-10.0, 0.0, True), (2.0, 12.0, False)])
def test_rows_at_rest_belong_to_a_one_sided_range_that_ends_at_rest(
    whole: ParameterFile, low: float, high: float, kept: bool
) -> None:
    """Rows of an arm have v' of a rounding, on the wrong side of a drift sweep to one side: they were all left out."""
    (measured,) = whole.measured
    ends = {"low": np.radians(low), "high": np.radians(high), "unit": "rad"}
    held = HeldRange(component="Y", variable="asin(v/U)", campaign=measured.campaign, **ends)
    at_rest = {"v": np.full(len(measured.labels), 5e-5)}
    assert set(_within(measured, "Y", [held], at_rest)) == {kept}


EVEN = {"Yv|v|'": "Yvv'", "Yvvv'": "Yvvvv'"}  # v v for v|v| in the law


def judged(noise: float, pairs: int, rng: np.random.Generator, *, mutated: bool) -> Severity:
    """Of one campaign whose law is fitted to its readings."""
    v = np.concatenate([V, V[:pairs]])
    table = planted({"Yv": -0.03, "Yv|v|": -0.1}, {"v": v})
    y = np.array(table.forces["Y"])
    table = replace(table, forces={"Y": y + noise * np.abs(y).max() * rng.standard_normal(len(y))})
    columns = np.stack([v, v * np.abs(v)], 1)
    slope = np.linalg.lstsq(columns, table.primed_force("Y", 2.0), rcond=None)[0][0]
    law = made([slopes(table, Yv=slope), beyond(table, Yv=slope)], table)
    if mutated:
        wrong = tuple(replace(c, symbol=EVEN.get(c.symbol, c.symbol)) for c in law.coefficients)
        law = law.model_copy(update={"coefficients": wrong})
        law = law.model_copy(update={"law_at_points": points_of(law)})
    return worst(law)


@pytest.mark.parametrize("pairs", [0, 1, 3])
def test_few_repeated_runs_fail_no_right_law_and_let_no_wrong_one_pass(pairs: int) -> None:
    """5 % noise. Three scatters of one pair failed right laws in a fifth, of none in most; its quantile, 64, let most wrong ones off."""
    rng = np.random.default_rng((39, pairs))
    right = [judged(0.05, pairs, rng, mutated=False) for _ in range(20)]
    wrong = [judged(0.05, pairs, rng, mutated=True) for _ in range(20)]
    assert right.count(Severity.FAIL) <= 1
    assert wrong.count(Severity.FAIL) >= 18


def test_a_miss_that_scatter_may_explain_says_so() -> None:
    """One pair that lies within .2 % of the largest, the other readings within 5 %."""
    rng = np.random.default_rng(39)
    table = planted(TRUTH, {"v": np.concatenate([V, V[:1]])})
    y = np.array(table.forces["Y"])
    noisy = replace(table, forces={**table.forces, "Y": y + 0.05 * np.abs(y).max() * rng.standard_normal(len(y))})
    law = made([slopes(noisy, **SLOPES), beyond(noisy, **SLOPES)], noisy)
    (m,) = law.measured
    forces = tuple(f.model_copy(update={"scatter": 0.002 * max(abs(x or 0.0) for x in f.values)}) for f in m.forces)
    law = law.model_copy(update={"measured": (m.model_copy(update={"forces": forces}),)})
    warned = next(c for c in law_findings(law) if c.subject.startswith("Y"))
    assert (warned.severity, "repeat more" in warned.comment) == (Severity.WARN, True)

"""A folder of runs becomes a table: runs found, conditions with their origins, gaps and doubles named, work continued."""

from __future__ import annotations

import hashlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from coeflab.core.errors import InputError
from coeflab.core.wording import natural
from coeflab.fits import FITS
from coeflab.report.tables.force_tables import inspected, unused
from coeflab.tables.collect import Collected
from coeflab.tables.column_map import ColumnMap
from coeflab.tables.conditions import likely_patterns, name_pattern
from coeflab.tables.histories import Convergence
from coeflab.tables.importers import IMPORTERS, PlannedTable
from coeflab.tables.mapping import assigned, doubtful
from coeflab.tables.raw_table import RawTable
from coeflab.tables.reading import read_tables
from coeflab.tables.run_list import read_run_list
from coeflab.tables.runs import find_runs
from tests.conftest import SECTIONS
from tests.tables.runs_as_text import FILE, collect, install, write_run

pytestmark = pytest.mark.usefixtures("stub", "in_a_shell")
NAMES = "b{beta:deg:m=-,p=.}_r{r:rad/s:p=.}"


@pytest.fixture(scope="module")
def stub(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """An importer of runs from a package of its own."""
    site = tmp_path_factory.mktemp("site")
    install(site)
    sys.path.insert(0, str(site))
    IMPORTERS.__dict__.pop("_claims", None)
    yield site
    sys.path.remove(str(site))
    sys.modules.pop("stubruns", None)
    IMPORTERS.__dict__.pop("_claims", None)


@pytest.fixture(scope="module")
def matrix(stub: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three angles by three rates, one hole, and one run of every kind that has no numbers."""
    root = tmp_path_factory.mktemp("runs")
    for i, beta in enumerate((-2.5, 0.0, 10.0)):
        for j, rate in enumerate((0.0, 0.1, 0.2)):
            if (i, j) != (1, 2):
                name = f"b{beta:g}_r{rate:g}".replace("-", "m").replace(".", "p")
                write_run(root / "sweep" / name, {"X": -40.0, "Y": 8.0 * beta, "N": -50.0 * rate - 5.0}, seed=3 * i + j,
                          patches={"hull": 0.75, "sail": 0.25}, conditions={"cells": [600000, "log:3"]})  # fmt: skip
    write_run(root / "b4_r0", ended="crashed", why="log:91 floating point exception")
    write_run(root / "b5_r0", {"Y": [1.0, 2.0, np.nan]})
    write_run(root / "b6_r0", {"Y": []})
    write_run(root / "b7_r0", broken=True)
    write_run(root / "b8_r0", {"Y": np.linspace(5.0, 10.0, 400)})
    (root / "notes.txt").write_text("no run\n")
    return root


@pytest.fixture(scope="module")
def collected(matrix: Path) -> Collected:
    return collect(matrix, names=NAMES, workers=1)


def row(found: Collected, name: str) -> int:
    return found.table.row_labels.index(name)


def test_one_row_a_condition(collected: Collected) -> None:
    table = collected.table
    i = row(collected, "sweep/bm2p5_r0p1")
    assert [(c.name, c.unit) for c in table.columns[:3]] == [("beta", "deg"), ("r", "rad/s"), ("X", "N")]
    assert (table.column("beta").values[i], table.column("r").values[i]) == (-2.5, 0.1)
    assert abs(table.column("Y").values[i] + 20.0) < 4 * table.column("se_Y").values[i] < 0.02
    assert table.column("Y(sail)").values[i] == pytest.approx(0.25 * table.column("Y").values[i], rel=1e-12)
    assert table.meaning("se_N") is not None
    assert table.column("cells").values[i] == 600000
    assert table.column("iterations").values[i] == 200
    assert table.column("status").texts[i] == "converged"
    assert collected.importer == "stub"
    assert table.dialect["version"] == "1"


def test_runs_stand_in_natural_order() -> None:
    assert sorted(["b10", "b2", "a", "b2_r10", "b2_r9"], key=natural) == ["a", "b2", "b2_r9", "b2_r10", "b10"]


def test_every_kind_of_end_is_listed(collected: Collected) -> None:
    status = {r.name: r.status for r in collected.runs}
    assert [status[f"b{k}_r0"] for k in (4, 5, 6, 7, 8)] == [
        Convergence.CRASHED, Convergence.DIVERGED, Convergence.EMPTY, Convergence.UNREADABLE, Convergence.DRIFTING,
    ]  # fmt: skip
    said = "\n".join(collected.table.remarks)
    assert "1 crashed, which have no numbers: b4_r0 (log:91 floating point exception)." in said
    assert "row 3 of the history is not a number" in said
    assert "found a line of letters" in said
    assert "1 drifting, which are kept but marked as uncertain: b8_r0 (" in said
    for k in (4, 5, 6, 7):
        i = row(collected, f"b{k}_r0")
        assert all(np.isnan(collected.table.column(c).values[i]) for c in ("X", "Y", "N", "se_Y", "plateau start"))
        assert collected.table.column("uncertain").texts[i] == "all"
    drifting = row(collected, "b8_r0")
    assert collected.table.column("uncertain").texts[drifting] == "all"
    assert np.isfinite(collected.table.column("Y").values[drifting])
    assert collected.counts[Convergence.CONVERGED] == 8


def test_origin_of_every_condition_is_shown(collected: Collected) -> None:
    shown = collected.shown()
    assert shown.headers == ("run", "beta", "r", "iterations", "plateau from", "status", "condition from")
    assert shown.rows[[r[0] for r in shown.rows].index("sweep/b10_r0p2")] == (
        "sweep/b10_r0p2", "10 deg", "0.2 rad/s", "200", "1", "converged", "name b10_r0p2",
    )  # fmt: skip
    few = collected.shown(most=5)
    assert {r[5] for r in few.rows} == {"crashed", "diverged", "empty", "unreadable", "drifting"}
    assert few.notes[0].endswith("8 are not shown.")


def test_files_have_their_hashes(collected: Collected, matrix: Path) -> None:
    inputs = {f.name: f.sha256 for f in collected.inputs()}
    name = f"sweep/b0_r0/{FILE}"
    assert inputs[name] == hashlib.sha256((matrix / name).read_bytes()).hexdigest()
    assert len(inputs) == len(collected.runs) - 1  # one could not be read


def histories(seed: int, noise: dict[str, float], rows: int = 300, phi: float = 0.95) -> dict[str, Any]:
    """X = -1, Y = 50, N = 90 with correlated noise, too long for so few rows; as shares of each."""
    rng = np.random.default_rng(seed)
    out = {}
    for c, mean in {"X": -1.0, "Y": 50.0, "N": 90.0}.items():
        steps = np.sqrt(1.0 - phi**2) * rng.normal(size=rows)
        walk = lfilter([1.0], [1.0, -phi], steps)
        out[c] = mean * (1.0 + (noise[c] * walk if c in noise else 1e-4 * rng.normal(size=rows)))
    return out


def test_only_the_component_that_is_too_short_is_marked(tmp_path: Path) -> None:
    """One whose error is small beside the largest mean of its component is used all the same."""
    write_run(tmp_path / "b0", histories(1, {}))
    write_run(tmp_path / "b2", histories(2, {"X": 0.05}))
    write_run(tmp_path / "b4", histories(3, {"X": 0.05, "Y": 0.003}))
    write_run(tmp_path / "b6", histories(4, {"Y": 0.004}))
    write_run(tmp_path / "b8", histories(5, {"X": 0.05, "Y": 0.05, "N": 0.05}))
    found = collect(tmp_path, names="b{beta:deg}")
    assert [str(r.status) for r in found.runs] == ["converged", "too short", "too short", "short but used", "too short"]
    assert found.table.column("uncertain").texts == ("", "X", "X", "", "all")
    error = found.table.column("se_Y").values
    assert max(error[2:4]) < 0.5 < error[4]
    said = "\n".join(found.table.remarks)
    assert "1 short but used, as every error, the range of the plateau in it, is below 1 % of the largest mean" in said
    assert (
        "3 too short, of which what is too short is marked as uncertain and not used: b2 (X spans more than 1 %" in said
    )


def test_errors_that_differ_more_than_chance_are_raised_to_the_pooled_one(tmp_path: Path) -> None:
    """A run that converged to the last digit weighed 5,000 times one whose last digits still move."""
    for k, noise in enumerate((1e-6, 1e-6, 1e-6, 7e-5)):
        rng = np.random.default_rng(k)
        write_run(
            tmp_path / f"b{k}",
            {"Y": 50.0 * k + 50.0 * noise * rng.normal(size=400), "N": 9.0 + 1e-3 * rng.normal(size=400)},
        )
    table = collect(tmp_path, names="b{beta:deg}").table
    error = table.column("se_Y").values
    own = 50.0 * 7e-5 / 20.0
    assert error[3] == pytest.approx(own, rel=0.5)
    np.testing.assert_allclose(error[:3], error[3] / 2.0, rtol=0.05)
    assert len(set(table.column("se_N").values)) == 4
    (said,) = [r for r in table.remarks if "pooled" in r]
    assert said.startswith("se_Y of 3 of 4 runs raised to ")
    assert "-fold" in said


def test_errors_of_fewer_rows_than_were_calibrated_are_not_trusted(tmp_path: Path) -> None:
    write_run(tmp_path / "b2", histories(6, {"Y": 0.006}, rows=90))
    write_run(tmp_path / "b4", histories(6, {}, rows=90))
    table = collect(tmp_path, names="b{beta:deg}").table
    assert table.column("se_Y").values[0] < 0.5
    assert table.column("uncertain").texts == ("Y", "")


def test_uncertain_may_name_columns_as_the_file_does(tmp_path: Path) -> None:
    """Monitors have blanks in their names; what is no force of the table counts for nothing."""
    for k, noise in ((2, {"X": 0.05}), (4, {"Y": 0.05}), (6, {})):
        read = histories(k, noise)
        forces = {"X": read["X"], "side": read["Y"], "N": read["N"]}
        write_run(tmp_path / f"b{k}", forces, prefix="My-", unnamed=True)
    raw = collect(tmp_path, names="b{beta:deg}").table
    assert raw.column("uncertain").texts == ("My-X", "My-side", "")
    spaced = RawTable(raw.path, tuple(
        replace(c, name=c.name.replace("My-", "Monitor of "), texts=tuple(t.replace("My-", "Monitor of ") for t in c.texts))
        for c in raw.columns
    ))  # fmt: skip
    said = {"Monitor of X": ColumnMap("ignore"), "Monitor of side": ColumnMap("Y"), "Monitor of N": ColumnMap("Z")}
    assert doubtful(spaced, assigned(spaced, said)) == [frozenset(), frozenset({"Y"}), frozenset()]


def test_a_crash_that_a_format_cannot_show(tmp_path: Path) -> None:
    for k in range(5):
        write_run(tmp_path / "runs" / f"b{k}", seed=k)
    write_run(tmp_path / "runs" / "b8", histories(1, {"Y": 0.05}, rows=115))
    write_run(tmp_path / "runs" / "b9", histories(1, {"Y": 0.05}, rows=125))
    early = write_run(tmp_path / "runs" / "b10", seed=5, rows=90)
    found = {r.name: r for r in collect(tmp_path / "runs", names="b{beta:deg}").runs}
    assert [str(found[n].status) for n in ("b8", "b9", "b10")] == ["too short", "too short", "converged"]
    write_run(tmp_path / "runs" / "b9", seed=9)
    first = collect(tmp_path / "runs", names="b{beta:deg}", state=tmp_path / "state.jsonl")
    found = {r.name: r for r in first.runs}
    assert (str(found["b8"].status), found["b8"].why) == ("crashed", "ends at 115, the others at 200")
    assert found["b8"].means == {}
    assert str(found["b10"].status) == "converged"  # it may have met its criterion
    (early / FILE).write_bytes((early / FILE).read_bytes().rstrip())
    again = collect(tmp_path / "runs", names="b{beta:deg}", state=tmp_path / "state.jsonl")
    assert again.runs[-1].why == "ends at 90 within a line, the others at 200"
    assert [r.name for r in again.runs if r.status is Convergence.CRASHED] == ["b8", "b10"]
    assert again.again == 1
    shown = again.shown()
    assert [r[shown.headers.index("iterations")] for r in shown.rows[-3:]] == ["115", "200", "90"]


def test_cases_that_were_never_run_take_one_line(tmp_path: Path) -> None:
    write_run(tmp_path / "b2")
    write_run(tmp_path / "_template", broken="a case without forces")
    found = collect(tmp_path, names="b{beta:deg}")
    assert "1 case without forces: _template" in found.table.remarks
    assert found.table.row_labels == ("b2",)
    (tmp_path / "b2" / FILE).unlink()
    (said,) = collect(tmp_path, names="b{beta:deg}").table.remarks
    assert said.startswith("1 case without forces: _template (")
    assert "expected numbers" in said  # what to do about it, where no run has forces


def test_rounding_is_no_difference(tmp_path: Path) -> None:
    for k, speed in ((2, 3.3), (4, 3.300006)):
        write_run(tmp_path / f"b{k}", stated={"conditions.speed": speed})
    assert collect(tmp_path, names="b{beta:deg}").table.stated["conditions.speed"].value == 3.3
    write_run(tmp_path / "b6", stated={"conditions.speed": 3.2912345})
    said = collect(tmp_path, names="b{beta:deg}").table.remarks
    assert "conditions.speed differs between runs (3.3 in b2, 3.2912 in b6) and is left out." in said


@pytest.mark.parametrize("names", ["{}_force.csv", "{}_force", "{}", "set/{}_force.csv"])
def test_names_of_a_list_need_no_extension(tmp_path: Path, names: str) -> None:
    runs = [f"set/{n}_force.csv" for n in ("drift_0", "drift_m3", "rot_p0.1")]
    file = tmp_path / "list.csv"
    file.write_text("run,beta [deg]\n" + "".join(f"{names.format(n)},1\n" for n in ("drift_0", "drift_m3", "rot_p0.1")))
    found = read_run_list(file).matches(runs)
    assert found == {f"set/{n}_force.csv": names.format(n) for n in ("drift_0", "drift_m3", "rot_p0.1")}


def test_a_short_name_that_means_two_runs_means_none(tmp_path: Path) -> None:
    file = tmp_path / "list.csv"
    file.write_text("run,beta [deg]\nb2,2\nrot_r0,0\nother.csv,1\n")
    read = read_run_list(file)
    assert read.matches(["b2.csv", "b2.dat", "rot_r0.1", "other.csv"]) == {"other.csv": "other.csv"}
    with pytest.raises(InputError, match=r"none of its 3 names is a run; expected names of runs: b2\.csv and b2\.dat"):
        read.matches(["b2.csv", "b2.dat"])


def test_hole_in_a_matrix_is_missing(tmp_path: Path) -> None:
    for beta in (0, 2, 4):
        for rate in (0, 1, 2):
            if (beta, rate) != (4, 1):
                write_run(tmp_path / f"b{beta}_r{rate}")
    assert collect(tmp_path, names="b{beta:deg}_r{r:rad/s}").missing == ("beta = 4 deg, r = 1 rad/s",)


def test_two_sweeps_are_no_matrix_with_holes(tmp_path: Path) -> None:
    for name in ("b0_r0", "b2_r0", "b4_r0", "b0_r1", "b0_r2"):
        write_run(tmp_path / name)
    assert collect(tmp_path, names="b{beta:deg}_r{r:rad/s}").missing == ()


def test_list_of_runs_names_the_missing(tmp_path: Path) -> None:
    write_run(tmp_path / "runs" / "a" / "first")
    write_run(tmp_path / "runs" / "second")
    runs = tmp_path / "list.csv"
    runs.write_text("run,beta [deg],U [kn],grid\na/first,4,4,A\nsecond,-2,4,B\nthird,6,4,A\n")
    found = collect(tmp_path / "runs", run_list=runs)
    assert found.missing == ("third of list.csv",)
    assert found.table.column("beta").values.tolist() == [4.0, -2.0]
    assert (found.table.column("U").unit, found.table.column("grid").texts) == ("kn", ("A", "B"))
    assert found.runs[0].conditions["beta"].origins == ("list.csv:2",)
    assert "1 missing: [third of list.csv]." in found.table.remarks


def test_run_list_as_toml(tmp_path: Path) -> None:
    file = tmp_path / "list.toml"
    file.write_text('[runs.one]\nbeta = "4 deg"\ngrid = "A"\ncells = 1000\n[runs."b/two"]\nr = "0.2 rad/s"\n')
    read = read_run_list(file)
    assert read.runs["one"]["beta"].value == pytest.approx(np.radians(4.0))
    assert str(read.runs["b/two"]["r"]) == "0.2 rad/s (list.toml:5)"
    assert read.matches(["x/one"]) == {"x/one": "one"}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("run,beta\na,4\n", "without a unit"),
        ("run,beta [m]\na,4\n", "unit of angle"),
        ("case,beta [deg]\na,4\n", "a column run"),
        ("run,beta [deg]\na,4\na,5\n", 'line 3, column "run": found the run "a" twice'),
        ("run,beta [deg]\na,four\n", '"four"'),
    ],
)
def test_bad_lists_of_runs(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "list.csv"
    file.write_text(text)
    with pytest.raises(InputError) as caught:
        read_run_list(file)
    assert said in str(caught.value)


@pytest.mark.parametrize("value", ["4", '"4"', '"4 m"', "true", '"four deg"'])
def test_toml_lists_need_units(tmp_path: Path, value: str) -> None:
    file = tmp_path / "list.toml"
    file.write_text(f"[runs.a]\nbeta = {value}\n")
    with pytest.raises(InputError, match=r"list\.toml, line [12]"):
        read_run_list(file)


@pytest.mark.parametrize(
    ("pattern", "name", "expected"),
    [
        ("b{beta:deg}_r{r:rad/s}", "b4_r0.1", {"beta": 4.0, "r": 0.1}),
        ("b{beta:deg}_r{r:rad/s}", "x/y/b-4.5_r0.1", {"beta": -4.5, "r": 0.1}),
        ("b{beta:deg}_r{r:rad/s}", "b+4_r0.1.csv", {"beta": 4.0, "r": 0.1}),
        ("b{beta:deg}", "bm4", None),
        ("b{beta:deg:m=-}", "bm4", {"beta": -4.0}),
        ("b{beta:deg:n=-}", "bn4", {"beta": -4.0}),
        ("b{beta:deg:p=-}", "bp4", {"beta": -4.0}),
        ("b{beta:deg:p=.}", "b4p5", {"beta": 4.5}),
        ("b{beta:deg:m=-,p=.}", "bm0p25", {"beta": -0.25}),
        ("b{beta:deg:*P=-,*S=+}", "b04P", {"beta": -4.0}),
        ("b{beta:deg:*P=-,*S=+,p=.}_*", "b2p5S_fine", {"beta": 2.5}),
        ("b{beta:deg:*P=-,*S=+}", "bP04", None),
        ("b{beta:deg:*P=-,*S=+}", "b-4P", None),
        ("b{beta:deg:P=-,S=+}", "b04P", None),
        ("b{beta:deg:m=-,p=+,p=.}", "bm2p5", {"beta": -2.5}),
        ("b{beta:deg:m=-,p=+,p=.}", "bp2p5", {"beta": 2.5}),
        ("b{beta:deg:m=-,p=+,p=.}", "bp10", {"beta": 10.0}),
        ("b{beta:deg:p=.,m=-,p=+}", "b10", {"beta": 10.0}),
        ("b{beta:deg:m=-,p=+,p=.}", "bmp5", None),
        ("b{beta:deg:p=-,p=+}", "bp5", None),
        ("b{beta:deg:port=-,stbd=+}", "bstbd6", {"beta": 6.0}),
        ("b{beta:deg:_=.}", "b4", None),
        ("r{r:rad/s:x0.01}", "r015", {"r": 0.15}),
        ("{*}", "r015", None),
        ("*_drift{beta:deg}*", "suboff_drift12_fine", {"beta": 12.0}),
        ("beta_{beta:deg}/r_{r:deg/s}", "all/beta_4/r_3", {"beta": 4.0, "r": 3.0}),
        ("g{grid:text}_b{beta:deg}", "gfine_b4", {"grid": "fine", "beta": 4.0}),
        ("rr{r':-}", "rr0.3", {"r'": 0.3}),
        ("b{beta:deg}", "b4_extra", None),
        ("b{beta:deg}", "b1e3", None),
        ("b{beta:deg}", "b4,5", None),
    ],
)
def test_names(pattern: str, name: str, expected: dict[str, Any] | None) -> None:
    if pattern in ("{*}", "b{beta:deg:_=.}", "b{beta:deg:p=-,p=+}"):
        with pytest.raises(InputError):
            name_pattern(pattern)
        return
    found = name_pattern(pattern).conditions(name)
    assert (
        found and {k: c.value if isinstance(c.value, str) else pytest.approx(c.written) for k, c in found.items()}
    ) == expected


@pytest.mark.parametrize(
    ("pattern", "said"),
    [
        ("b", "no {NAME:UNIT}"),
        ("b{beta}", "without a unit"),
        ("b{beta:m}", "unit of angle"),
        ("b{drift:deg}", "{drift:text}"),
        ("b{beta:deg}{r:rad/s}", "text between"),
        ("b{beta:deg}_{beta:deg}", "twice"),
        ("b{beta:deg:minus}", "spellings"),
        ("b{beta:deg}_r{r", "not closed"),
        ("*" * 6 + "{beta:deg}", "asterisks"),
    ],
)
def test_bad_patterns(pattern: str, said: str) -> None:
    with pytest.raises(InputError) as caught:
        name_pattern(pattern)
    assert said in str(caught.value)


def test_a_pattern_takes_no_time() -> None:
    began = time.process_time()
    assert name_pattern("*_*_*_{beta:deg}").conditions("_" * 199 + "x") is None
    assert name_pattern("*_{beta:deg}").conditions("_" * 5000 + "4") is None
    assert time.process_time() - began < 1.0


def test_nothing_is_guessed(tmp_path: Path) -> None:
    write_run(tmp_path / "b4_r0.1")
    with pytest.raises(InputError, match="Nothing is taken from names unless"):
        collect(tmp_path)
    write_run(tmp_path / "odd")
    with pytest.raises(InputError) as caught:
        collect(tmp_path, names="b{beta:deg}_r{r:rad/s}")
    assert "no beta and r for odd" in str(caught.value)
    assert 'does not fit "b{beta:deg}_r{r:rad/s}"' in str(caught.value)
    assert "--runs list.csv with the columns run,beta [deg]" in str(caught.value)


@pytest.mark.parametrize(("names", "pattern"), [
    ("drift_m12 drift_p4 drift_0", "drift_{beta:deg:m=-,p=+}"), ("b-4_r0.1 b0_r0.2", "b{beta:deg}_r{r:UNIT}"),
    ("bm4p5 b4 b0", "b{beta:deg:m=-,p=.}"), ("all/aoa_n2.csv all/aoa_2.csv", "aoa_{alpha:deg:n=-}"), ("run7_b4 run7_b8", "run7_b{beta:deg}"),
    ("case1 case2", "case{NAME:UNIT}"), ("b4_b8 b6_b8 b6_b9", "b{beta:deg}_b{NAME:UNIT}"), ("fine_4 coarse_4", ""), ("b4", ""), ("x y", ""),
    ("bp4p5 bm4", "b{beta:deg:m=-,p=+,p=.}"), ("alpha_m2p5 alpha_p10 alpha_0", "alpha_{alpha:deg:m=-,p=+,p=.}"),
])  # fmt: skip
def test_the_pattern_that_names_seem_to_have(names: str, pattern: str) -> None:
    assert likely_patterns(names.split()) == ((pattern,) if pattern else ())


def test_the_error_proposes_the_pattern_and_speaks_of_signs(tmp_path: Path) -> None:
    for name in ("drift_m12", "drift_p4", "drift_0"):
        write_run(tmp_path / name)
    with pytest.raises(InputError) as caught:
        collect(tmp_path)
    assert "If this is what they mean: --name 'drift_{beta:deg:m=-,p=+}'." in str(caught.value)
    with pytest.raises(InputError) as caught:
        collect(tmp_path, names="drift_{beta:deg}")
    assert "{beta:deg:m=-,p=+} reads m12 as -12 and p4 as 4" in str(caught.value)
    beta = collect(tmp_path, names="drift_{beta:deg:m=-,p=+}").table.meaning("beta")
    assert sorted(beta.values.tolist()) == pytest.approx([-12.0, 0.0, 4.0])


def test_contradictions_name_both(tmp_path: Path) -> None:
    write_run(tmp_path / "runs" / "b4", conditions={"beta": [float(np.radians(-4.0)), "0/U:21"]})
    write_run(tmp_path / "runs" / "b6", conditions={"beta": [float(np.radians(6.0)), "0/U:21"]})
    with pytest.raises(InputError) as caught:
        collect(tmp_path / "runs", names="b{beta:deg}")
    text = str(caught.value)
    assert "beta = -0.06981317008 rad (0/U:21) and 4 deg (name b4)" in text
    assert "opposite signs" in text
    assert "b6" not in text
    runs = tmp_path / "list.csv"
    runs.write_text("run,beta [deg]\nb4,-4\nb6,7\n")
    with pytest.raises(InputError, match=r"\(0/U:21\) and 7 deg \(list.csv:3\)"):
        collect(tmp_path / "runs", run_list=runs)
    runs.write_text("run,beta [deg]\nb4,-4\n")
    found = collect(tmp_path / "runs", run_list=runs)
    assert found.runs[0].conditions["beta"].origins == ("0/U:21", "list.csv:2")


def test_velocity_of_the_files_and_angles_of_names(tmp_path: Path) -> None:
    def flow(angle: float) -> dict[str, Any]:
        return {
            c: [float(v), "0/U:21"] for c, v in zip("uvw", (2 * np.cos(angle), 0.0, -2 * np.sin(angle)), strict=True)
        }

    write_run(tmp_path / "b4", conditions=flow(np.radians(4.0)))
    found = collect(tmp_path, names="b{beta:deg}")
    assert found.table.columns[0].name == "beta"
    assert found.table.meaning("w") is None
    write_run(tmp_path / "b8", conditions=flow(np.radians(6.0)))
    with pytest.raises(InputError, match="6 and 8 degrees"):
        collect(tmp_path, names="b{beta:deg}")


def test_runs_of_one_condition(tmp_path: Path) -> None:
    write_run(tmp_path / "b2_first", seed=1)
    write_run(tmp_path / "b2_again", seed=2)
    write_run(tmp_path / "b2_copy", seed=2)
    write_run(tmp_path / "b4_coarse", conditions={"cells": [1000, "log:1"]})
    write_run(tmp_path / "b4_fine", conditions={"cells": [8000, "log:1"]})
    found = collect(tmp_path, names="b{beta:deg}_*")
    assert found.duplicates == (("b2_again", "b2_copy", "b2_first"),)
    assert found.table.column("uncertain").texts == ("", "all", "", "", "")
    said = "\n".join(found.table.remarks)
    assert "b2_copy of b2_again" in said
    assert "1 condition on several grids: b4_coarse = b4_fine." in said


def test_links_and_nested_cases(tmp_path: Path) -> None:
    write_run(tmp_path / "runs" / "b2")
    write_run(tmp_path / "runs" / "b2" / "b99")
    (tmp_path / "runs" / "loop").symlink_to(tmp_path / "runs", target_is_directory=True)
    (tmp_path / "runs" / "b3").symlink_to(tmp_path / "runs" / "b2", target_is_directory=True)
    (tmp_path / "runs" / "gone").symlink_to(tmp_path / "nowhere")
    write_run(tmp_path / "else" / "b4")
    (tmp_path / "runs" / "linked").symlink_to(tmp_path / "else", target_is_directory=True)
    assert list(find_runs(tmp_path / "runs")[1]) == ["b2", "linked/b4"]


def test_a_single_run_and_none(tmp_path: Path) -> None:
    found = collect(write_run(tmp_path / "b2"), names="b{beta:deg}")
    assert found.table.row_labels == ("b2",)
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="no run of a known format"):
        collect(tmp_path / "empty")
    with pytest.raises(InputError, match="one that reads runs"):
        collect(tmp_path, "csv")


def test_runs_must_agree_on_units_and_axes(tmp_path: Path) -> None:
    write_run(tmp_path / "b2", stated={"axes.reference_point": [1.0, 0.0, 0.0], "source.how_obtained": "a"})
    write_run(tmp_path / "b4", stated={"axes.reference_point": [1.0, 0.0, 0.0], "source.how_obtained": "b"})
    found = collect(tmp_path, names="b{beta:deg}")
    assert found.table.stated["axes.reference_point"].value == (1.0, 0.0, 0.0)
    assert "source.how_obtained" not in found.table.stated
    write_run(tmp_path / "b6", unit="-", prefix="C")
    with pytest.raises(InputError, match=r"X in \[N\] in b2 and \[-\] in b6"):
        collect(tmp_path, names="b{beta:deg}")
    write_run(tmp_path / "b6", stated={"axes.reference_point": [2.0, 0.0, 0.0]})
    with pytest.raises(InputError, match=r"in b2 \(b2/setup:7\) and .* in b6"):
        collect(tmp_path, names="b{beta:deg}")


def test_without_a_history_there_is_no_error(tmp_path: Path) -> None:
    write_run(tmp_path / "b2", {"Y": [3.0]})
    write_run(tmp_path / "b4", {"Y": [4.0]})
    found = collect(tmp_path, names="b{beta:deg}")
    assert found.table.meaning("se_Y") is None
    assert found.table.column("Y").values.tolist() == [3.0, 4.0]
    assert any(r.startswith("No se_Y: b2 and b4") for r in found.table.remarks)


def test_a_folder_of_runs_is_a_table_of_a_campaign(tmp_path: Path) -> None:
    """Runs that are not converged are in the table and out of the fits."""
    for k in (-8, -4, 0, 4, 8):
        write_run(tmp_path / "runs" / f"b{k}", {"X": -40.0, "Y": 10.0 * k + 0.01}, seed=k + 8, rows=400)
    write_run(tmp_path / "runs" / "b12", {"X": -40.0 + np.zeros(400), "Y": np.linspace(100.0, 120.0, 400)})
    write_run(tmp_path / "runs" / "b16", ended="crashed", why="log:3")
    write_run(tmp_path / "runs" / "b20", {"X": -40.0, "Y": histories(1, {"Y": 0.05}, rows=400)["Y"]}, rows=400)
    sections = {
        **SECTIONS,
        "campaign": f'{SECTIONS["campaign"]}\nimporter = "stub"',
        "importer": 'names = "b{beta:deg}"',
    }
    text = "".join(f"[{name}]\n{content}\n" for name, content in sections.items() if content)
    (tmp_path / "campaign.toml").write_text(f'{text}[[table]]\nfile = "runs"\n')
    (table,) = read_tables(PlannedTable(tmp_path, ()))
    kept = np.array([label not in ("b12", "b16", "b20") for label in table.labels])
    assert len(kept) == 8
    assert table.usable["X"].tolist() == [label not in ("b12", "b16") for label in table.labels]
    marked = 'marked "uncertain" in the source'
    assert inspected(table).notes[1:4] == (
        f"b12, row: excluded, drifting, {marked}",
        "b16, row: excluded, crashed, no number in the source",
        f"b20, Y: excluded, too short, {marked}",
    )
    assert (
        unused([table]) == "Readings left out (point, components): b12: still drifting; b16: crashed; b20 Y: too short."
    )
    one, two = f"of {table.campaign}", "of other"
    several = (
        f"b12 {one}, b12 {two}: still drifting; b16 {one}, b16 {two}: crashed; b20 {one} Y, b20 {two} Y: too short"
    )
    other = replace(table, name="other/runs", campaign="other")
    assert "b12 of runs, b12 of runs2: still drifting" in unused([table, replace(table, name="b/runs2")])
    assert unused([table, other]) == f"Readings left out (point, components): {several}."
    assert unused([table.with_uncertain_cells()]) == "Points left out: b16: crashed."
    assert table.usable["Y"].tolist() == kept.tolist()
    assert np.all(table.errors["Y"][kept] > 0.0)
    assert any("b12 (" in n for n in table.notes)
    model = FITS.load("polynomial").fit([table], table.scaling, {"responses": "Y", "degree": 1}).models[0]
    assert set(model.labels) == {"b-8", "b-4", "b0", "b4", "b8"}
    assert 32_000.0 * model.fit.coefficients[1] == pytest.approx(-10.0 * np.degrees(1.0), rel=1e-3)
    np.testing.assert_allclose(table.errors["Y"][table.labels.index("b8")], 0.08 / np.sqrt(400), rtol=0.5)


def test_columns_that_the_format_does_not_name(tmp_path: Path) -> None:
    """Monitors have the names that a user gave them: all are averaged, and somebody says which is which."""
    for k in (2, 4):
        forces = {"lateral": 3.0 * k, "vertical": 1.0, "continuity": np.geomspace(1.0, 1e-9, 200)}
        write_run(tmp_path / f"b{k}", forces, seed=k, unnamed=True)
    found = collect(tmp_path, names="b{beta:deg}")
    assert found.counts == {Convergence.CONVERGED: 2}
    assert [(c.name, c.means) for c in found.table.columns[:5]] == [
        ("beta", "beta"), ("lateral", ""), ("vertical", ""), ("se_lateral", ""), ("se_vertical", ""),
    ]  # fmt: skip
    assert found.table.column("lateral").values == pytest.approx([6.0, 12.0], rel=1e-3)
    said = {"lateral": ColumnMap("Y", negative=True), "vertical": ColumnMap("ignore")}
    known = {a.column.name: a.meaning for a in assigned(found.table, said)}
    assert known["se_lateral"] == ColumnMap("Y", unit="N", error=True)
    assert "se_vertical" not in known
    write_run(tmp_path / "b6", {"X": 1.0})
    with pytest.raises(InputError, match="in b6 and columns of other names in b"):
        collect(tmp_path, names="b{beta:deg}")


def test_finished_runs_are_not_read_again(tmp_path: Path) -> None:
    log, state = tmp_path / "log", tmp_path / "state.jsonl"
    about = {"log": str(log), "patches": {"sail": 0.5}, "stated": {"axes.reference_point": [1.0, 0.0, 0.0]}}
    for k in (2, 4):
        write_run(tmp_path / "runs" / f"b{k}", conditions={"beta": [k * 0.1, "U:3"]}, **about)
    write_run(tmp_path / "runs" / "b6", broken=True, log=str(log))
    said: list[str] = []
    first = collect(tmp_path / "runs", state=state, progress=said.append)
    assert said == ["3 runs of stub in runs", *(f"read {k} of 3 runs, {int(k == 3)} not converged" for k in (1, 2, 3))]
    again = collect(tmp_path / "runs", state=state)
    assert (first.again, again.again) == (3, 1)  # what could not be read is tried again
    assert log.read_text().split() == ["b2", "b4", "b6", "b6"]
    for ours, theirs in zip(again.table.columns, first.table.columns, strict=True):
        np.testing.assert_array_equal(ours.values, theirs.values)
        assert (ours.name, ours.unit, ours.texts) == (theirs.name, theirs.unit, theirs.texts)
    assert again.table.stated == first.table.stated
    assert again.runs[0].conditions == first.runs[0].conditions
    write_run(tmp_path / "runs" / "b4", seed=9, conditions={"beta": [0.4, "U:3"]}, **about)
    assert collect(tmp_path / "runs", state=state).again == 2
    (tmp_path / "runs" / "b2" / "restart").mkdir()
    assert collect(tmp_path / "runs", state=state).again == 2
    assert collect(tmp_path / "runs", state=state, options={"group": "hull"}).again == 3


def test_what_is_still_written_is_read_again(tmp_path: Path) -> None:
    run = write_run(tmp_path / "runs" / "b2")
    os.utime(run / FILE)
    for _ in range(2):
        assert collect(tmp_path / "runs", names="b{beta:deg}", state=tmp_path / "state.jsonl").again == 1


@pytest.mark.parametrize("tail", [b'{"kind": "coeflab col', b"\xff\xfe\x00\n", b"[]\n", b'{"kind": 3}\n'])
def test_damaged_end_of_state_is_no_harm(tmp_path: Path, tail: bytes) -> None:
    write_run(tmp_path / "runs" / "b2")
    state = tmp_path / "state.jsonl"
    collect(tmp_path / "runs", names="b{beta:deg}", state=state)
    state.write_bytes(state.read_bytes() + tail)
    write_run(tmp_path / "runs" / "b4")
    assert collect(tmp_path / "runs", names="b{beta:deg}", state=state).again == 1
    assert collect(tmp_path / "runs", names="b{beta:deg}", state=state).again == 0


def test_damaged_state_is_not_believed(tmp_path: Path) -> None:
    write_run(tmp_path / "runs" / "b2")
    state = tmp_path / "state.jsonl"
    first = collect(tmp_path / "runs", names="b{beta:deg}", state=state)
    whole = state.read_bytes()
    for place in range(0, len(whole) - 1, 37):
        state.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
        found = collect(tmp_path / "runs", names="b{beta:deg}", state=state)
        assert found.again == 1
        np.testing.assert_array_equal(found.table.column("Y").values, first.table.column("Y").values)


KILLED = """
import sys
from pathlib import Path
from coeflab.tables.collect import collect_groups
if __name__ == "__main__":
    root, state = Path(sys.argv[1]), Path(sys.argv[2])
    collect_groups(root, patterns=("b{beta:deg}",), state=state, workers=2, progress=lambda line: print(line, flush=True))
"""


@pytest.mark.slow
def test_killed_and_continued(tmp_path: Path, stub: Path) -> None:
    """With two processes; what they read is, to the last digit, what one reads."""
    log = tmp_path / "log"
    for k in range(40):
        write_run(tmp_path / "runs" / f"b{k}", seed=k, rows=60, log=str(log), slow=0.03)
    script = tmp_path / "work.py"
    script.write_text(KILLED)
    state = tmp_path / "state.jsonl"
    process = subprocess.Popen(
        [sys.executable, script, tmp_path / "runs", state], stdout=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(stub), *sys.path])},
    )  # fmt: skip
    for line in process.stdout:
        if line.startswith("read 9 "):
            break
    process.send_signal(signal.SIGKILL)
    process.communicate()
    time.sleep(0.2)
    done = sum(line.endswith("}}") for line in state.read_text().splitlines())
    assert 9 <= done < 40
    found = collect(tmp_path / "runs", names="b{beta:deg}", state=state, workers=1)
    assert found.again == 40 - done
    whole = collect(tmp_path / "runs", names="b{beta:deg}", workers=1)
    for ours, theirs in zip(found.table.columns, whole.table.columns, strict=True):
        np.testing.assert_array_equal(ours.values, theirs.values)


def test_any_text_is_a_pattern_or_a_clear_error() -> None:
    """Fuzz: 2,000 mutations of patterns, each on a name."""
    rng = np.random.default_rng(17)
    seeds = ["b{beta:deg}_r{r:rad/s}", "*{U:kn:x0.1,p=.}/*_{grid:text}", "{r':-}{", "a{alpha:rad:m=-}}"]
    letters = "{}:*/,=.x-+mp\u2212 deg{beta:deg}\n\0\u00b5"
    for _ in range(2000):
        text = list(seeds[rng.integers(len(seeds))])
        for _ in range(rng.integers(1, 6)):
            text.insert(int(rng.integers(len(text) + 1)), letters[rng.integers(len(letters))])
            text.pop(int(rng.integers(len(text))))
        try:
            pattern = name_pattern("".join(text))
        except InputError:
            continue
        pattern.conditions("x/b4_r0.1")
        pattern.conditions("".join(text))


def test_any_text_is_a_list_of_runs_or_a_clear_error(tmp_path: Path) -> None:
    rng = np.random.default_rng(18)
    seeds = {
        "list.csv": b"run,beta [deg],U [kn],grid\na/first,4,4,A\nsecond,-2,4,B\n",
        "list.toml": b'[runs.one]\nbeta = "4 deg"\ngrid = "A"\ncells = 1000\n[runs."b/two"]\nr = "0.2 rad/s"\n',
    }
    for name, seed in seeds.items():
        for _ in range(200):
            text = bytearray(seed)
            for _ in range(rng.integers(1, 5)):
                text[rng.integers(len(text))] = b'0.,"=[]\n e-\xff\0'[rng.integers(13)]
            (tmp_path / name).write_bytes(bytes(text))
            try:
                read_run_list(tmp_path / name)
            except InputError:
                continue


def test_a_list_of_runs_knows_settings_by_the_names_of_text_tables(tmp_path: Path) -> None:
    """A column left out is a sweep of zeros."""
    file = tmp_path / "runs.csv"
    file.write_text("run,sideslip [deg],Angle of attack [deg],yaw rate [deg/s],grid\nb4,4,1,2,fine\n")
    found = read_run_list(file).runs["b4"]
    assert {name: str(one).partition(" (")[0] for name, one in found.items()} == {
        "beta": "4 deg", "alpha": "1 deg", "r": "2 deg/s", "grid": "fine"}  # fmt: skip
    toml = tmp_path / "runs.toml"
    toml.write_text('[runs.b4]\nDriftwinkel = "4 deg"\n')
    assert read_run_list(toml).runs["b4"]["beta"].written == 4.0
    for head, said in (("sideslip [deg],beta [deg]", "both beta"), ("Krängung [deg],beta [deg]", "whose name is no setting"),
                       ("drift angle,grid", "without a unit")):  # fmt: skip
        file.write_text(f"run,{head}\nb4,4,1\n", encoding="utf-8")
        with pytest.raises(InputError, match=said):
            read_run_list(file)

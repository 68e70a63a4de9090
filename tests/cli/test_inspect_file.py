"""``coeflab inspect`` of files that nobody has explained yet."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tests.cli.conftest import flat
from tests.cli.test_import import drift, invoke, refused, runs, stub
from tests.tables.runs_as_text import write_run

__all__ = ["drift", "runs", "stub"]


def test_the_next_command_repeats_what_was_given(runs: Path) -> None:
    pattern = "b{beta:deg:m=-}"
    done = invoke("inspect", runs, "--name", pattern, "--as", "stub", "--json")
    assert json.loads(done.stdout)["next"].startswith(f"coeflab import {runs} --as stub --name '{pattern}' --out ")


def test_a_folder_is_at_most_forty_lines(tmp_path: Path) -> None:
    """Of eleven runs with a half model, two open keys and nine remarks."""
    for angle in range(-5, 6):
        case = tmp_path / "cases" / f"a{angle}"
        (case / "0").mkdir(parents=True)
        (case / "0" / "U").write_text(
            "FoamFile { class volVectorField; object U; }\ninternalField uniform (1.50000009399 0 0);\n"
            f"boundaryField {{ inlet {{ type fixedValue; value uniform (-1.5 0 {0.01 * angle}); }} }}\n"
        )
        (case / "system").mkdir()
        (case / "system" / "controlDict").write_text(
            "functions { forces { type forces; rhoInf 998.2; CofR (1 0 0); } }\n"
        )
        (case / "system" / "blockMeshDict").write_text("boundary ( mid { type symmetryPlane; faces (); } );\n")
        forces = case / "postProcessing" / "forces" / "0"
        forces.mkdir(parents=True)
        (forces / "forces.dat").write_text("# CofR : (1 0 0)\n# Time forces(pressure viscous) moment(pressure viscous)\n" + "".join(
            f"{t} ((-3.{t % 3} 2 {angle}) (-1 0 0)) ((0 1 0) (0 0 0))\n" for t in range(1, 120)))  # fmt: skip
    done = invoke("inspect", tmp_path / "cases").stdout
    assert 15 < len(done.split("\n")) <= 41
    assert "00009399" not in done


def test_the_list_of_commands_says_what_they_do() -> None:
    listed = " ".join(invoke("--help").output.split())
    assert "import Make a campaign of a table, several of one folder, or a folder of runs" in listed
    assert "inspect Show a table in SI and FRD, a mesh, or a body" in listed


def test_inspect_of_an_unknown_file(drift: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(drift.parent)
    done = invoke("inspect", drift.name)
    assert done.exit_code == 0, done.output
    for part in ("read by table", "Yaw angle  deg   -8 to 8", "beta [deg]?", "Open: nothing in the file says these",
                 "1? axes.frame", "Next: coeflab import"):  # fmt: skip
        assert part in done.output
    assert max(map(len, done.output.splitlines())) <= 80
    content = json.loads(invoke("inspect", drift, "--json").stdout)
    assert content["importer"] == "table"
    assert content["columns"][1]["proposed"] == "beta [deg]"
    assert content["columns"][1]["low"] == -8.0
    assert [one["argument"] for one in content["missing"]][:1] == ["--set 'axes.frame=?'"]
    assert len(content["missing"]) == 5
    still = [one["argument"] for one in content["missing"]]
    assert content["next"].endswith(f" {' '.join(still)} --accept")
    said = " ".join(done.output.replace("\\\n", " ").split())
    assert f"{' '.join(still)} --accept 5 open: replace each ? by its value." in said


def test_inspect_of_what_no_importer_knows(tmp_path: Path) -> None:
    (tmp_path / "noise.bin").write_bytes(bytes(range(256)) * 20)
    lines = refused(invoke("inspect", tmp_path / "noise.bin"))
    assert "found nothing that an importer knows by its content; expected --as" in lines[0]
    assert "table" in lines[0]
    assert "one of" in refused(invoke("inspect", tmp_path / "noise.bin", "--as", "csv"))[0]


def test_an_empty_file_is_called_so(tmp_path: Path) -> None:
    (tmp_path / "empty.csv").write_bytes(b"")
    (line,) = refused(invoke("inspect", tmp_path / "empty.csv"))
    assert line.endswith("empty.csv: found an empty file; expected a table or runs of a solver.")


def test_an_error_without_a_unit_is_raised_in_a_clean_sentence(tmp_path: Path) -> None:
    """Report files of Fluent state no unit: "raised to 0.027 , the pooled error" was printed."""
    for k, noise in enumerate((1e-4, 1e-4, 2e-2)):
        run = tmp_path / "runs" / f"b{4 * k}"
        run.mkdir(parents=True)
        rows = (f"{i} {20.0 + 7.0 * k + noise * ((7 * i) % 5 - 2):.6f}" for i in range(1, 401))
        (run / "fy-rfile.out").write_text(
            "\n".join(['"fy-rfile"', '"Iteration" "fy"', '("Iteration" "fy")', *rows, ""])
        )
    said = flat(invoke("inspect", tmp_path / "runs", "--wide").output)
    assert re.search(r"raised to [\d.e-]+, the pooled error", said), said


def test_a_text_that_no_importer_knows_is_offered_as_a_table(tmp_path: Path) -> None:
    file = tmp_path / "sweep.dat"
    names = "   RUN   ALPHA     X1000     Z1000     M1000"
    numbers = "".join(f"  {100 + a:4d} {a:7.2f} {-2.6:9.3f} {0.3 * a:9.3f} {-0.1 * a:9.3f}\n" for a in range(-4, 5))
    file.write_text(f"  SUB-X  BODY AXES X FWD, Y PORT{'!' * 80}\n\n{names}\n         (DEG)\n  -----------\n{numbers}")
    lines = refused(invoke("import", file, "--out", tmp_path / "out"))
    assert "expected --as table if it is a table of text, else one of cfx, " in lines[0]
    assert "--option header=NUMBER" in lines[0]
    assert lines[1:] == (f"   1  {'  SUB-X  BODY AXES X FWD, Y PORT':!<70}", f"   3  {names}", "   4           (DEG)")
    done = invoke("inspect", file, "--as", "table", "--option", "header=3")
    assert done.exit_code == 0, done.output


def test_inspect_of_a_run_whose_condition_nobody_states(stub: Path, tmp_path: Path) -> None:
    folder = write_run(tmp_path / "alone", {"X": 13.0, "Y": 2.0})
    done = invoke("inspect", folder)
    assert done.exit_code == 0, done.output
    for part in (
        "a run, read by stub; ended whole",
        "200 rows",
        "Missing to read it as a row of a table",
    ):
        assert part in " ".join(done.output.split())
    content = json.loads(invoke("inspect", folder, "--json").stdout)
    assert content["ended"] == "whole"
    assert [c["is"] for c in content["History"]] == ["iteration", "X", "Y"]
    assert content["missing"]

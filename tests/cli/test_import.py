"""``coeflab import`` and ``coeflab inspect`` of files that nobody has explained yet."""

from __future__ import annotations

import json
import os
import pty
import re
import shlex
import subprocess
from importlib.resources import files
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import Result
from typer.testing import CliRunner

from coeflab.cli import app, import_
from coeflab.core.errors import CoeflabError, InputError
from coeflab.core.provenance import sha256_of
from coeflab.core.table import Severity
from coeflab.study.checks import conditions
from coeflab.tables.campaign import read_campaign
from coeflab.tables.column_map import read_column_map
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.questions import questions, understood
from coeflab.tables.raw_table import RawColumn, RawTable, Stated
from coeflab.tables.reading import read_tables
from coeflab.tables.settings import Setting, read_setting
from tests.cli.conftest import COEFLAB, Run
from tests.tables.runs_as_text import FILE, write_run
from tests.tables.test_collect import stub

__all__ = ["stub"]

DOC = Path(__file__).parents[2] / "docs" / "data_in.md"
DRIFT = """# tank
Run,Yaw angle (deg),Fx (N),Fy (N),Mz (Nm),Comment
1,-8,12.3,-29.4,10.4,
2,-4,12.9,-11.8,5.7,
3,0,13.07,-0.72,0.1,wire
4,4,13,11.8,-5.8,
5,8,12.5,nan,-10.4,
"""
SAID = {
    "axes.frame": "CFD", "axes.datum": "nose", "axes.reference_point": "-2,0,0", "scaling.length": "4 m",
    "scaling.length_name": "LOA", "conditions.density": "998.2", "conditions.speed": "2.0", "source.kind": "experiment",
}  # fmt: skip


def sets(**more: str) -> list[str]:
    said = SAID | {k.replace("__", "."): v for k, v in more.items()}
    return [a for k, v in said.items() for a in ("--set", f"{k}={v}")]


def invoke(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


def refused(result: Result) -> tuple[str, ...]:
    assert isinstance(result.exception, CoeflabError), result.output
    return result.exception.lines


def table_of(folder: Path) -> ForceTable:
    return read_tables(PlannedTable(folder, ()))[0]


@pytest.fixture
def drift(tmp_path: Path) -> Path:
    file = tmp_path / "drift.csv"
    file.write_text(DRIFT)
    return file


def test_everything_open_comes_in_one_error_with_its_arguments(drift: Path, tmp_path: Path) -> None:
    lines = refused(invoke("import", drift, "--out", tmp_path / "out"))
    assert "found 15 open points" in lines[0]
    arguments = [line.strip() for line in lines if line.startswith("  --")]
    assert arguments == [
        "--map Run=point", "--map 'Yaw angle=beta [deg]'", "--map 'Fx=X [N]'", "--map 'Fy=Y [N]'", "--map 'Mz=N [Nm]'",
        "--map Comment=ignore", "--set axes.frame=FRAME", "--set axes.beta=SIGN", "--set axes.datum=POINT",
        "--set axes.reference_point=X,Y,Z", "--set scaling.length=METRES", "--set scaling.length_name=NAME",
        "--set conditions.density=DENSITY", "--set conditions.speed=SPEED", "--set source.kind=KIND",
        "--yes takes those with values.",
    ]  # fmt: skip
    assert all(len(line) <= 80 for line in lines[1:])
    assert not (tmp_path / "out").exists()


def test_the_arguments_of_the_error_settle_it(drift: Path, tmp_path: Path) -> None:
    lines = refused(invoke("import", drift, "--out", tmp_path / "out", *sets()))
    given = [word for line in lines if line.startswith("  --map") for word in shlex.split(line)]
    assert [line.strip() for line in lines if line.startswith("  --set")] == [
        "--set 'axes.beta=v = -U sin(beta)'"
    ]  # Y to starboard grows with beta, which is evidence, no decision
    done = invoke("import", drift, "--out", tmp_path / "out", *sets(axes__beta="-"), *given)
    assert done.exit_code == 0, done.output
    assert " ".join(done.output.replace("\\\n", " ").split()).endswith(f"Next: coeflab fit {tmp_path / 'out'}")
    table = table_of(tmp_path / "out")
    assert table.forces["X"].tolist() == [-12.3, -12.9, -13.07, -13.0, -12.5]
    assert table.forces["Y"].tolist()[:4] == [-29.4, -11.8, -0.72, 11.8]
    assert table.motion["v"][0] > 0.0
    assert [(e.component, e.line) for e in table.exclusions] == [("Y", 7)]
    assert table.labels == ("1", "2", "3", "4", "5")


def test_yes_takes_what_has_a_value_and_says_so(drift: Path, tmp_path: Path) -> None:
    done = invoke("import", drift, "--out", tmp_path / "out", "--yes", *sets())
    assert done.exit_code == 0, done.output
    assert "axes.beta = v = -U sin(beta) (Y to starboard and beta have the same sign" in done.output
    text = (tmp_path / "out" / "campaign.toml").read_text()
    assert re.search(r'beta = "v = -U sin\(beta\)" +# Y to starboard and beta have the same sign', text)
    assert re.search(r'frame = "CFD" +# confirmed', text)
    assert f'source_sha256 = "{sha256_of(drift)}"' in text
    assert "Yaw angle = beta [deg]" in read_campaign(tmp_path / "out" / "campaign.toml").source.how_obtained
    still_open = refused(invoke("import", drift, "--out", tmp_path / "two", "--yes"))
    assert not any("--map" in line or "--yes" in line for line in still_open)
    assert any("--set axes.beta=SIGN" in line for line in still_open)  # no axes, no evidence of a sign


def test_a_saved_mapping_serves_the_next_file(drift: Path, tmp_path: Path) -> None:
    invoke("import", drift, "--out", tmp_path / "one", "--yes", *sets(axes__beta="+"))
    second = tmp_path / "second.csv"
    second.write_text(DRIFT.replace("13.07", "14.07"))
    done = invoke("import", second, "--out", tmp_path / "two", "--mapping", tmp_path / "one" / "mapping.toml")
    assert done.exit_code == 0, done.output
    assert table_of(tmp_path / "two").forces["X"][2] == -14.07
    assert read_campaign(tmp_path / "two" / "campaign.toml").source.citation == "second.csv"
    saved = tmp_path / "one" / "mapping.toml"
    saved.write_text(saved.read_text().replace('"X [N]"', '"X [deg]"').replace('"CFD"', '"DFC"'))
    lines = refused(invoke("import", second, "--out", tmp_path / "three", "--mapping", saved))
    assert len(lines) == 2
    assert all(re.search(r"mapping.toml, line \d+", line) for line in lines)


def test_an_existing_folder_is_replaced_only_by_force(drift: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert invoke("import", drift, "--out", out, "--yes", *sets()).exit_code == 0
    before = (out / "table.csv").read_bytes()
    drift.write_text(DRIFT.replace("13.07", "14.07"))
    assert "replace it with --force" in refused(invoke("import", drift, "--out", out, "--yes", *sets()))[0]
    assert (out / "table.csv").read_bytes() == before
    assert invoke("import", drift, "--out", out, "--yes", "--force", *sets()).exit_code == 0
    assert b"14.07" in (out / "table.csv").read_bytes()


def test_wrong_arguments_are_refused_together_and_nothing_is_written(drift: Path, tmp_path: Path) -> None:
    wrong = (
        "--set",
        "axes.frame=XYZ",
        "--set",
        "conditions.density=-1",
        "--set",
        "what=1",
        "--set",
        "axes.datum=POINT",
    )
    lines = refused(invoke("import", drift, "--out", tmp_path / "out", *wrong, "--option", "sheet"))
    assert len(lines) == 5
    lines = refused(invoke("import", drift, "--out", tmp_path / "out", "--map", "Fz=Z [N]", "--map", "Fy=Y [deg]"))
    assert len(lines) == 2
    assert 'no column "Fz"' in lines[0]
    assert "unit of another dimension" in lines[1]
    ask = ("import", drift, "--out", tmp_path / "out", "--yes")
    lines = refused(invoke(*ask, *sets(conditions__viscosity="thick", table__labels="Run")))
    assert [line.partition(":")[0] for line in lines] == ['"conditions.viscosity"', '"table[0].labels"']
    assert '"source.wat"' not in refused(invoke(*ask, *sets(source__wat="1")))[0].partition("expected")[2]
    assert [p.name for p in tmp_path.iterdir()] == ["drift.csv"]


def test_a_rotating_table_has_to_say_what_it_contains(tmp_path: Path) -> None:
    file = tmp_path / "arm.csv"
    file.write_text("r (rad/s),Fy (N),Mz (Nm)\n-0.4,-10,13\n-0.2,-5,7\n0.2,5,-7\n0.4,10,-13\n")
    ask = ("import", file, "--out", tmp_path / "out", "--yes")
    lines = refused(invoke(*ask, *sets(axes__frame="FRD")))
    assert [line.strip() for line in lines if "--set" in line] == ["--set table.contains_inertia=TRUE_OR_FALSE"]
    lines = refused(invoke(*ask, *sets(axes__frame="FRD", table__contains_inertia="yes")))
    assert sum("--set inertia." in line for line in lines) == 2
    inside = {"table.contains_inertia": "true", "inertia.mass": "40 kg", "inertia.centre_of_gravity": "-2,0,0"}
    more = {k.replace(".", "__"): v for k, v in inside.items()}
    done = invoke(*ask, *sets(axes__frame="FRD", **more))  # about one axis Ix, Iy, Iz hold nothing
    assert done.exit_code == 0, done.output
    alone = table_of(tmp_path / "out").forces
    assert alone["Y"][3] == pytest.approx(10.0 + 40.0 * 2.0 * 0.4)
    done = invoke(*ask, "--force", *sets(axes__frame="FRD", inertia__inertia="[1, 9, 9]", **more))
    assert done.exit_code == 0, done.output
    assert all(table_of(tmp_path / "out").forces[n].tolist() == values.tolist() for n, values in alone.items())
    file.write_text(file.read_text().replace("r (rad/s)", "r (rad/s),q (rad/s)").replace(",-10,", ",0.1,-10,").replace(
        ",-5,", ",0.1,-5,").replace(",5,", ",0.1,5,").replace(",10,", ",0.1,10,"))  # fmt: skip
    lines = refused(invoke(*ask, "--force", *sets(axes__frame="FRD", **more)))
    assert [line.strip() for line in lines if "--set" in line] == ["--set inertia.inertia=IX,IY,IZ"]


def test_what_a_rotating_table_contains_is_asked_before_units_are_known(tmp_path: Path) -> None:
    for head, keys in (
        ("r", {"table.contains_inertia"}),
        ("R", {"table.contains_inertia", "table.centre", "table.arm_point"}),
    ):
        file = tmp_path / "arm.csv"
        file.write_text("yaw rate,Fy (N)\n1,2\n2,3\n" if head == "r" else "radius,Fy (N)\n1,2\n2,3\n")
        lines = refused(invoke("import", file, "--out", tmp_path / "out"))
        asked = {line.partition("--set ")[2].partition("=")[0] for line in lines if "--set" in line}
        assert {key for key in asked if key.startswith("table.")} == keys


def test_a_density_other_than_that_of_the_forces_is_refused(tmp_path: Path) -> None:
    """Primes by 998.2 of forces of a fluid of 1 kg/m^3 would be 1/998 of what they are."""
    table = RawTable(
        tmp_path, (RawColumn("beta", "deg", np.array([1.0, 2.0])), RawColumn("Fy", "", np.array([3.0, 6.0]))),
        dialect={"importer": "openfoam"}, stated={"conditions.density": Stated(1.0, "system/controlDict:23")},
    )  # fmt: skip
    said = {"beta": read_column_map("beta [deg]"), "Fy": read_column_map("Y [N]")}

    def complaints(density: float, **columns: str) -> list[str]:
        known = said | {name: read_column_map(text) for name, text in columns.items()}
        return [
            str(e) for e in understood(table, known, {"conditions.density": Setting(density, "confirmed")}).complaints
        ]

    [why] = complaints(998.2)
    for part in ("998.2 kg/m^3", "expected 1, the density that the forces were computed with (system/controlDict:23)",
                 "--option density=998.2"):  # fmt: skip
        assert part in why
    assert complaints(1.0) == complaints(1.0005) == complaints(998.2, Fy="Y [coefficient A=1 m^2]") == []


def test_a_run_with_another_density_is_refused_by_import_and_in_place(runs: Path, tmp_path: Path) -> None:
    said = {k: v for k, v in SAID.items() if k != "conditions.speed"} | {"conditions.density": "1025"}
    ask = ("import", runs, "--out", tmp_path / "out", "--name", "b{beta:deg:m=-}", "--yes")
    lines = refused(invoke(*ask, *[a for k, v in said.items() for a in ("--set", f"{k}={v}")]))
    assert len(lines) == 1
    assert "conditions.density = 1025 kg/m^3; expected 998.2" in lines[0]
    head = '[campaign]\ntitle = "T"\nbody = "b"\nimporter = "stub"\n\n[importer]\nnames = "b{beta:deg:m=-}"\n'
    keys = (
        '[axes]\nframe = "CFD"\nbeta = "v = -U sin(beta)"\ndatum = "nose"\nreference_point = [-2, 0, 0]\n'
        '[scaling]\nlength = 4.0\nlength_name = "LOA"\n[conditions]\ndensity = 1025.0\nspeed = 2.0\n'
        '[source]\nkind = "experiment"\ncitation = "c"\n[[table]]\nfile = "runs"\n'
    )
    (tmp_path / "campaign.toml").write_text(head + keys, encoding="utf-8")
    with pytest.raises(InputError, match=r"found conditions\.density = 1025"):
        table_of(tmp_path)


def test_a_frame_in_which_the_body_moves_astern_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "cfd.csv"
    file.write_text("u (m/s),v (m/s),Fx (N),Fy (N)\n-2,-0.2,13,12\n-2,0,12,0.1\n-2,0.2,13,-12\n")
    ask = ("import", file, "--out", tmp_path / "out", "--yes")
    lines = refused(invoke(*ask, *sets(axes__frame="FRD")))
    assert len(lines) == 1
    assert "found u is below zero in every row: in these axes the body moves astern" in lines[0]
    assert "Is the frame CFD (x aft)?" in lines[0]
    assert not (tmp_path / "out").exists()
    done = invoke(*ask, *sets(axes__frame="CFD"))
    assert done.exit_code == 0, done.output
    assert "thrust" not in done.output
    file.write_text(file.read_text().replace("-2,", "2,"))
    assert "Is the frame FRD or FLU (x forward)?" in refused(invoke(*ask, "--force", *sets(axes__frame="CFD")))[0]
    done = invoke(*ask, "--force", *sets(axes__frame="FRD"))
    assert "warning: X is above zero in every row: in FRD that is thrust, not drag" in " ".join(done.output.split())


def test_a_rate_whose_sign_the_numbers_contradict_stays_open(tmp_path: Path) -> None:
    """Also where the file itself names it, and --yes does not pass over it."""
    file = tmp_path / "arm.csv"
    file.write_text("r (rad/s),Fy (N),Mz (Nm)\n-0.4,-10,-13\n-0.2,-5,-7\n0.2,5,7\n0.4,10,13\n")
    ask = ("import", file, "--out", tmp_path / "out", "--yes", *sets(axes__frame="FRD", table__contains_inertia="no"))
    lines = refused(invoke(*ask))
    assert "1 open point;" in lines[0]
    assert lines[1].strip() == "--map 'r=-r [rad/s]' or --map 'r=r [rad/s]'"
    assert "N and r have the same sign" in lines[2]
    file.write_text(file.read_text().replace("r (rad/s)", "r' (-)"))
    assert refused(invoke(*ask))[1].strip() == """--map "r'=-r' [-]" or --map "r'=r' [-]\""""
    file.write_text(file.read_text().replace("r' (-)", "r (rad/s)"))
    for word, sign in (("-r", -1.0), ("r", 1.0)):
        done = invoke(*ask, "--force", "--map", f"r={word} [rad/s]")
        assert done.exit_code == 0, done.output
        assert table_of(tmp_path / "out").motion["r"].tolist() == [sign * x for x in (-0.4, -0.2, 0.2, 0.4)]


ARM = "r' (-),Fx,Fz,Mz\n0.1,-77,-15,48\n0.2,-78,-31,100\n0.3,-80,-50,160\n0.4,-81,-69,222\n"


@pytest.mark.parametrize(("answer", "sign"), [("n", -1.0), ("y", 1.0)])
def test_a_rate_is_judged_again_once_the_axes_are_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: str, sign: float
) -> None:
    """Forces without a unit, so that only the answers make N and r comparable; and z up, where r > 0 turns to port."""
    file = tmp_path / "arm.csv"
    file.write_text(ARM)
    answers = ["X [N]", "Y [N]", "N [N*m]", "FLU", answer, "midship", "4 LOA", "998.2, 2", "no", "cfd, nobody"]
    done = answered(monkeypatch, answers, "import", file, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert "Does r' > 0 turn the bow to port?" in done.output
    assert table_of(tmp_path / "out").motion["r"].tolist() == pytest.approx(
        [sign * -0.5 * x for x in (0.1, 0.2, 0.3, 0.4)]
    )
    units = ("--map", "Fx=X [N]", "--map", "Fz=Y [N]", "--map", "Mz=N [N*m]")
    monkeypatch.undo()
    lines = refused(invoke("import", file, "--out", tmp_path / "two", "--yes", *units, *sets(axes__frame="FLU")))
    assert lines[1].strip() == """--map "r'=-r' [-]" or --map "r'=r' [-]\""""
    assert "keeps it: r' > 0 turns the bow to port" in " ".join(" ".join(lines).split())


def test_a_rate_about_an_axis_whose_forces_rest_is_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With y up, r is pitch about z to starboard; Y and N vary, so that yaw is meant, q of the file, even where --map says r."""
    file = tmp_path / "arm.csv"
    file.write_text(ARM)
    units = ("--map", "Fx=X [N]", "--map", "Fz=Z [N]", "--map", "Mz=M [N*m]")
    up = sets(axes__frame="forward,up,starboard", table__contains_inertia="no")
    for said in ((), ("--map", "r'=r'")):
        lines = refused(invoke("import", file, "--out", tmp_path / "out", "--yes", *units, *said, *up))
        assert lines[1].strip().startswith("""--map "r'=-q' [-]" or --map "r'=q' [-]\"""")
        text = " ".join(" ".join(lines).split())
        assert "points starboard: pitch. But Y and N of the body vary and Z and M do not: yaw, which is q" in text
    done = invoke("import", file, "--out", tmp_path / "out", "--yes", *units, "--map", "r'=-q'", *up)
    assert done.exit_code == 0, done.output
    assert table_of(tmp_path / "out").motion["r"].tolist() == pytest.approx([0.05, 0.1, 0.15, 0.2])
    assert not np.any(table_of(tmp_path / "out").motion["q"])
    done = answered(monkeypatch, ["n", ""], "import", file, "--out", tmp_path / "asked", *units, *up)
    assert done.exit_code == 0, done.output
    assert table_of(tmp_path / "asked").motion["r"].tolist() == pytest.approx([0.05, 0.1, 0.15, 0.2])


@pytest.mark.parametrize(("arguments", "said"), [
    (("--set", "axes.reference_point=L/2"), 'found "L/2"'),
    (("--set", "axes.reference_point=-1,2,0,0"), 'found "-1,2,0,0"; expected x, y, z in m, such as -2.1, 0, 0, or x alone; 0 is the datum. Write a decimal point.'),
    (("--set", "scaling.length=2,5"), 'found "2,5"; expected a number in m or a text with its unit, such as "2.5 m". Write a decimal point.'),
    (("--map", "Fy=Y [coefficient A=6.25]"), 'found "A=6.25"; expected A with its unit, such as 6.25 m^2'),
    (("--map", "Fy=Y [coefficient A=6,25 m^2]"), 'found "A=6,25 m^2"'),
])  # fmt: skip
def test_what_was_typed_is_quoted(drift: Path, tmp_path: Path, arguments: tuple[str, ...], said: str) -> None:
    lines = refused(invoke("import", drift, "--out", tmp_path / "out", *arguments))
    assert said in lines[0]
    assert "[]" not in lines[0]


def test_the_next_command_repeats_what_was_given(runs: Path) -> None:
    pattern = "b{beta:deg:m=-}"
    done = invoke("inspect", runs, "--name", pattern, "--as", "stub", "--json")
    assert json.loads(done.stdout)["next"].startswith(f"coeflab import {runs} --as stub --name '{pattern}' --out ")


def test_the_list_of_commands_says_what_they_do() -> None:
    listed = " ".join(invoke("--help").output.split())
    assert "import Make a campaign of a table or a folder of runs" in listed
    assert "inspect Show a table in SI and FRD, a mesh, or a body" in listed


def test_inspect_of_an_unknown_file(drift: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(drift.parent)
    done = invoke("inspect", drift.name)
    assert done.exit_code == 0, done.output
    for part in ("read by table", "Yaw angle  deg   -8 to 8", "beta [deg]?", "Missing to read it as a campaign",
                 "--set axes.frame=FRAME", "Next: coeflab import"):  # fmt: skip
        assert part in done.output
    assert max(map(len, done.output.splitlines())) <= 80
    content = json.loads(invoke("inspect", drift, "--json").stdout)
    assert content["importer"] == "table"
    assert content["columns"][1]["proposed"] == "beta [deg]"
    assert content["columns"][1]["low"] == -8.0
    assert len(content["missing"]) == 15


def test_a_table_in_our_own_names_is_imported_as_it_reads(tmp_path: Path) -> None:
    """What `coeflab import` writes is what it reads: the same bytes but for the first line, the same force table."""
    template = Path(str(files("coeflab.cli") / "template" / "campaign" / "drift.csv")).read_text()
    (tmp_path / "own.csv").write_text(template.replace("-51.1930,-13.6577,", "-51.1930,,N"))
    said = sets(axes__frame="FRD", axes__beta="-")
    for source, out in (("own.csv", "one"), ("one/table.csv", "two")):
        done = invoke("import", tmp_path / source, "--out", tmp_path / out, *said)
        assert done.exit_code == 0, done.output + str(done.exception)
    one, two = ((tmp_path / n / "table.csv").read_text().splitlines()[1:] for n in ("one", "two"))
    assert one == two
    table = table_of(tmp_path / "one")
    assert [(e.row, e.component) for e in table.exclusions] == [(0, "N")]
    assert table.forces["Y"][0] == -51.193


def test_inspect_of_what_no_importer_knows(tmp_path: Path) -> None:
    (tmp_path / "noise.bin").write_bytes(bytes(range(256)) * 20)
    lines = refused(invoke("inspect", tmp_path / "noise.bin"))
    assert "found nothing that an importer knows by its content; expected --as" in lines[0]
    assert "table" in lines[0]
    assert "one of" in refused(invoke("inspect", tmp_path / "noise.bin", "--as", "csv"))[0]


def test_a_text_that_no_importer_knows_is_offered_as_a_table(tmp_path: Path) -> None:
    file = tmp_path / "sweep.dat"
    names = "   RUN   ALPHA     X1000     Z1000     M1000"
    numbers = "".join(f"  {100 + a:4d} {a:7.2f} {-2.6:9.3f} {0.3 * a:9.3f} {-0.1 * a:9.3f}\n" for a in range(-4, 5))
    file.write_text(f"  SUB-X  BODY AXES X FWD, Y PORT{'!' * 80}\n\n{names}\n         (DEG)\n  -----------\n{numbers}")
    lines = refused(invoke("import", file, "--out", tmp_path / "out"))
    assert "expected --as table if it is a table of text, else --as one of cfx, " in lines[0]
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


RUNS = {f"b{beta}".replace("-", "m"): beta for beta in (0, 4, 8, -4, -8)}


@pytest.fixture
def runs(stub: Path, tmp_path: Path) -> Path:
    """A folder of runs whose names hold the drift angle, about a speed that their files state."""
    folder = tmp_path / "runs"
    for seed, (name, beta) in enumerate(RUNS.items()):
        forces = {"X": 13.0, "Y": 3.0 * beta + 0.5}
        stated = {"conditions.density": 998.2, "conditions.speed": 2.0, "axes.reference_point": [1.2, 0.0, 0.0]}
        write_run(folder / name, forces, seed=seed, stated=stated, patches={"sail": 0.2})
    return folder


def test_a_folder_of_runs_becomes_a_campaign_that_weighs_its_points(runs: Path, tmp_path: Path) -> None:
    ask = ("import", runs, "--out", tmp_path / "out", "--name", "b{beta:deg:m=-}", "--yes")
    lines = refused(invoke(*ask))
    assert "The file has (1.2, 0, 0) in its own axes from its own origin" in " ".join(" ".join(lines).split())
    assert not any("conditions." in line for line in lines)
    said = {k: v for k, v in SAID.items() if not k.startswith("conditions.")}
    done = invoke(*ask, *[a for k, v in said.items() for a in ("--set", f"{k}={v}")])
    assert done.exit_code == 0, done.output
    table = table_of(tmp_path / "out")
    assert table.labels == tuple(RUNS)
    assert np.degrees(np.arcsin(table.motion["v"] / table.speed)) == pytest.approx([-b for b in RUNS.values()])
    assert table.forces["Y"] == pytest.approx([3.0 * b + 0.5 for b in RUNS.values()], rel=2e-3)
    assert set(table.errors) == {"X", "Y"}
    text = (tmp_path / "out" / "campaign.toml").read_text()
    assert re.search(r"density = 998.2 +# stated: \w+/setup:7", text)
    # in place: the same campaign.toml on the folder itself, with the conditions by the same pattern
    head = '[campaign]\ntitle = "T"\nbody = "b"\nimporter = "stub"\n\n[importer]\nnames = "b{beta:deg:m=-}"\n\n'
    sections = "".join(re.findall(r"^\[(?:axes|scaling|conditions|source)\]\n(?:[^\[\n].*\n)+", text, re.MULTILINE))
    (tmp_path / "campaign.toml").write_text(head + sections + '\n[[table]]\nfile = "runs"\n', encoding="utf-8")
    in_place = table_of(tmp_path)
    for name, values in table.forces.items():
        assert in_place.forces[name].tolist() == values.tolist()
        assert in_place.errors[name].tolist() == table.errors[name].tolist()
    assert in_place.files[1].sha256 == sha256_of(runs, [runs / n / FILE for n in RUNS])


def on_a_terminal(folder: Path, command: list[str], answers: str) -> tuple[int, str]:
    """Run a command on a pseudo-terminal with everything typed ahead."""
    ours, theirs = pty.openpty()
    with subprocess.Popen(command, cwd=folder, stdin=theirs, stdout=theirs, stderr=theirs, close_fds=True) as process:
        os.close(theirs)
        os.write(ours, answers.encode())
        seen = b""
        while True:
            try:
                block = os.read(ours, 4096)
            except OSError:  # the terminal of a process that ended
                break
            if not block:
                break
            seen += block
    os.close(ours)
    return process.returncode, seen.decode().replace("\r\n", "\n")


def in_check(table: ForceTable) -> list[str]:
    """What the check of conditions warns of."""
    return [c.subject for c in conditions.check(SimpleNamespace(tables=[table])) if c.severity is Severity.WARN]  # type: ignore[arg-type]


@pytest.mark.parametrize(("key", "typed", "said"), [
    ("conditions.density", "1.025", 'is it g/cm^3? Then write "1.025 g/cm^3"'),
    ("scaling.length", "3000", 'is it in mm? Then write "3000 mm"'),
    ("scaling.length", "0.004", "is it in km?"),
    ("conditions.speed", "2000", 'is it in mm/s? Then write "2000 mm/s"'),
])  # fmt: skip
def test_a_number_in_another_unit_is_a_warning(drift: Path, tmp_path: Path, key: str, typed: str, said: str) -> None:
    """At import and by the check of conditions; not for what is written with its unit."""
    ask = ("import", drift, "--out", tmp_path / "out", "--yes", "--force")
    done = invoke(*ask, *sets(**{key: typed}))
    assert done.exit_code == 0, done.output
    assert f"warning, {key}: " in " ".join(done.output.split())
    assert said in " ".join(done.output.split())
    name = key.partition(".")[2]
    assert in_check(table_of(tmp_path / "out")) == [f"out unit of {name}"]
    if "g/cm" not in said:
        return
    for more in ({key: "1.025 g/cm^3"}, {key: typed, "source.citation": "wind tunnel of X"}):
        done = invoke(*ask, *sets(**more))
        assert "warning" not in done.output
        assert in_check(table_of(tmp_path / "out")) == []


def answered(monkeypatch: pytest.MonkeyPatch, answers: list[str], *arguments: object) -> Result:
    """What a command says to one who types these answers, as on a terminal."""
    monkeypatch.setattr(import_, "sys", SimpleNamespace(stdin=SimpleNamespace(isatty=lambda: True)))
    return CliRunner().invoke(app, [str(a) for a in arguments], input="\n".join(answers) + "\n")


def test_places_and_sizes_are_asked_with_examples(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Area and length once for all coefficients; 0 for the datum; Enter for the arm at the reference point; a doubtful density."""
    file = tmp_path / "arm.csv"
    file.write_text(
        "Run,Drift (deg),R (m),CY,CN\n" + "".join(f"{i},{2 * i},{10 + i},{0.1 * i},{0.01 * i}\n" for i in range(1, 6))
    )
    answers = ["0.2", "L", "4 m", "y", "FRD", "-", "2 m aft of nose", "0 from nose", "4", "LOA", "1.025", "n", "1.025 g/cm3, 2",
               "starboard", "", "yes", "10", "", "synthetic"]  # fmt: skip
    done = answered(monkeypatch, answers, "import", file, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    said = " ".join(done.output.split())
    for part in ("Area A of the coefficients CY, CN (by 1/2 rho U^2 A), such as 0.2 m^2", "Length L of the coefficients CN (of moments",
                 "-2.1 from nose (2.1 m aft of it)", "the side as a word; expected the side as a sign", "prime: they are primes by",
                 "Taken: axes.datum = nose; axes.reference_point = [0.0, 0.0, 0.0]", "Length of the primes and its name",
                 "is it g/cm^3? Then", "Keep it?", "table.arm_point [0.0, 0.0, 0.0]"):  # fmt: skip
        assert part in said, (part, said)
    text = (tmp_path / "out" / "mapping.toml").read_text()
    assert 'CN = "N [coefficient A=0.2 m^2 L=4.0 m]"' in text
    table = table_of(tmp_path / "out")
    assert table.conditions.density == pytest.approx(1025.0)
    assert table.arm_point is not None
    assert table.arm_point.tolist() == table.reference_point.tolist() == [0.0, 0.0, 0.0]


TANK = """Schlepptank, Versuch 2213
v = 1,5 m/s; rho = 998,8 kg/m3
Lpp = 4,3 m
Fahrt;Schiebewinkel;Kraft längs;Kraft quer;Moment um Hochachse
-;deg;N;N;Nm
""" + "".join(f"{i};{b};{-20 - abs(b):d},5;{3 * b},25;{-b},125\n" for i, b in enumerate((-8, -4, 0, 4, 8), start=1))


def test_lines_over_a_german_table_are_offered_and_seven_lines_are_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Speed, density and length of its own lines by Enter; a sign that the numbers contradict is asked again."""
    file = tmp_path / "tank.csv"
    file.write_text(TANK, encoding="utf-8")
    answers = ["y", "FRD", "+", "n", "-", "-2.15 from nose", "", "", "experiment"]
    done = answered(monkeypatch, answers, "import", file, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    said = " ".join(done.output.split())
    for part in ("Kraft quer = Y [N]; Moment um Hochachse = N [Nm]", "declared is axes.beta = v = +U sin(beta). One of them is wrong",
                 'Default: 4.3 (line 3: "Lpp = 4,3 m"); LPP', 'Default: 998.8 (line 2: "rho = 998,8 kg/m3"); 1.5 (line 2',
                 "axes.reference_point = [-2.15, 0.0, 0.0]"):  # fmt: skip
        assert part in said, (part, said)
    table = table_of(tmp_path / "out")
    assert (table.conditions.speed, table.conditions.density, table.scaling.length, table.scaling.length_name) == (
        1.5,
        998.8,
        4.3,
        "LPP",
    )
    assert table.forces["Y"].tolist() == [-24.25, -12.25, 0.25, 12.25, 24.25]


def test_lines_over_a_table_are_offered_as_arguments_and_never_taken(tmp_path: Path) -> None:
    """An area of them makes a coefficient that has to be confirmed, even under coeflab's own names."""
    file = tmp_path / "tank.csv"
    file.write_text("# S = 0.25 m^2, V = 2 m/s, m = 4.3 m\nbeta [deg],Y [-]\n-4,0.01\n0,0\n4,-0.01\n")
    said = refused(invoke("import", file, "--out", tmp_path / "out"))
    for part in (
        "--set conditions.speed=2",
        '"V = 2 m/s"',
        "--map 'Y=Y [coefficient A=0.25 m^2]'",
        "--set scaling.length=METRES",
    ):
        assert any(part in line for line in said), (part, said)
    assert not (tmp_path / "out").exists()


def test_coefficients_without_an_area_may_be_primes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "primes.csv"
    file.write_text("Drift;CY;CN\ndeg;1e-3;1e-3\n-4;1.5;0.5\n0;0;0\n4;-1.5;-0.5\n")
    answers = ["primes", "y", "FRD", "", "cg", "4 LOA", "1000, 2", "synthetic, nobody"]
    done = answered(monkeypatch, answers, "import", file, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert table_of(tmp_path / "out").forces["Y"].tolist() == pytest.approx([48.0, 0.0, -48.0])
    by_map = ("--map", "CY=Y' [1e-3]", "--map", "CN=N' [1e-3]")
    answers = ["y", *answers[2:]]
    file.write_text(file.read_text().replace("1e-3;1e-3", "-;-"))
    done = answered(monkeypatch, answers, "import", file, "--out", tmp_path / "mapped", *by_map)
    assert done.exit_code == 0, done.output
    assert table_of(tmp_path / "mapped").forces["Y"].tolist() == pytest.approx([48.0, 0.0, -48.0])


def test_a_pattern_of_names_is_proposed_shown_and_confirmed(
    runs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Enter takes it; a wrong one is asked again; what it reads is shown and has to be confirmed."""
    said = {k: v for k, v in SAID.items() if not k.startswith("conditions.")} | {"axes.beta": "-"}
    sets_ = [a for k, v in said.items() for a in ("--set", f"{k}={v}")]
    done = answered(
        monkeypatch, ["b{beta:deg}", "", "n", "", "y", "", ""], "import", runs, "--out", tmp_path / "out", *sets_
    )
    assert done.exit_code == 0, done.output
    text = " ".join(done.output.split())
    for part in ("--name [b{beta:deg:m=-}]", "The name bm4 does not fit. A minus is - unless the pattern spells it", "bm8: beta = -8 deg",
                 "Is that what they are, number, sign and unit?"):  # fmt: skip
        assert part in text, (part, text)
    assert np.degrees(np.arcsin(table_of(tmp_path / "out").motion["v"] / 2.0)) == pytest.approx(
        [-b for b in RUNS.values()]
    )
    assert "b{beta:deg:m=-}" in (tmp_path / "out" / "mapping.toml").read_text()


@pytest.mark.parametrize(("typed", "read"), [
    ("0", [0.0, 0.0, 0.0]), ("0 0 0", [0, 0, 0]), ("-2.1 0 0.3", [-2.1, 0, 0.3]), ("[-2, 0, 0]", [-2, 0, 0]), ("-2; 0; 0", [-2, 0, 0]),
    ("7 ft, 0, 0", ["7 ft", 0, 0]), ("-1.2", [-1.2, 0, 0]), ("1", [1, 0, 0]), ("-1200 mm", [-1.2, 0, 0]),
])  # fmt: skip
def test_ways_to_write_a_place(typed: str, read: list[object]) -> None:
    assert read_setting("axes.reference_point", typed) == read


@pytest.mark.parametrize("typed", ["", "0 0", "1,2", "1,2 m", "nose", "true", "false", "0 0 0 0", "-2,1 0 0"])
def test_what_is_no_place_says_how_to_write_one(typed: str) -> None:
    with pytest.raises(InputError, match=r"expected x, y, z in m, such as -2.1, 0, 0, or x alone; 0 is the datum"):
        read_setting("axes.reference_point", typed)


def test_enter_takes_the_point_that_a_file_states_turned_to_frd_and_yes_does_not() -> None:
    raw = RawTable(Path("t.csv"), (), stated={"axes.reference_point": Stated((1.2, 0.0, 0.3), "setup:7")})
    asked = {q.key: q for q in questions(raw, (), {"axes.frame": Setting("CFD", "confirmed")})}
    one = asked["axes.reference_point"]
    assert (one.on_enter, one.default) == ("-1.2, 0, -0.3", "")
    assert (
        "The file has (1.2, 0, 0.3) in its own axes from its own origin (setup:7), in FRD (-1.2, 0, -0.3)" in one.asks
    )


@pytest.mark.slow
def test_questions_on_a_terminal(drift: Path, tmp_path: Path) -> None:
    """Proposals at once, a wrong answer asked again, a default by evidence, none without."""
    answers = ["y", "XYZ", "CFD", "", "nose", "-2, 0, 0", "4 m LOA", "998.2, 2", "experiment"]
    command = [str(COEFLAB), "import", drift.name, "--out", "mine"]
    code, said = on_a_terminal(tmp_path, command, "\n".join(answers) + "\n")
    assert code == 0, said
    for part in (
        "All of them right?", 'found "XYZ"; expected "FRD", "FLU", "CFD"', "axes.beta [v = -U sin(beta)]",
        "Y to starboard and beta have the same sign", "source.citation = drift.csv", "Next: coeflab fit mine",
    ):  # fmt: skip
        assert part in said.replace("\n", " "), (part, said)
    assert table_of(tmp_path / "mine").forces["Y"].tolist()[:2] == [-29.4, -11.8]


@pytest.mark.slow
def test_the_example_of_the_documentation(coeflab: Run, tmp_path: Path) -> None:
    """The commands of docs/data_in.md, in order, as processes; then its [columns]."""
    text = DOC.read_text(encoding="utf-8")
    blocks = dict(reversed(re.findall(r"^```(\w+)\n(.*?)^```", text, re.MULTILINE | re.DOTALL)))
    (tmp_path / "drift_tests.csv").write_text(blocks["csv"], encoding="utf-8")
    said = [coeflab(*shlex.split(line)[1:]) for line in blocks["sh"].splitlines()]
    assert [d.returncode for d in said] == [0, 0, 0], said
    assert re.search(r"Yv' = -0\.03\d+ \+- ", said[1].stdout)
    made = table_of(tmp_path / "cfd_data" / "series_12")
    campaign = (tmp_path / "cfd_data" / "series_12" / "campaign.toml").read_text()
    sections = "".join(re.findall(r"^\[(?:axes|scaling|conditions|source)\]\n(?:[^\[\n].*\n)+", campaign, re.MULTILINE))
    whole = blocks["toml"] + "\n" + sections + '\n[[table]]\nfile = "drift_tests.csv"\n'
    (tmp_path / "campaign.toml").write_text(whole, encoding="utf-8")
    in_place = table_of(tmp_path)
    for name, values in made.forces.items():
        assert in_place.forces[name].tolist() == pytest.approx(values.tolist(), rel=1e-14, nan_ok=True)

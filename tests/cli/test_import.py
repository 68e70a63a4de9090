"""``coeflab import`` and ``coeflab inspect`` of files that nobody has explained yet."""

from __future__ import annotations

import re
import shlex
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import Result
from typer.testing import CliRunner

from coeflab.cli import app, import_
from coeflab.core.errors import CoeflabError, InputError
from coeflab.core.finding import Severity
from coeflab.core.provenance import sha256_of
from coeflab.study.checks import conditions
from coeflab.tables.campaign import read_campaign
from coeflab.tables.column_map import read_column_map
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.interpretation import interpreted
from coeflab.tables.raw_table import RawColumn, RawTable, Stated
from coeflab.tables.reading import read_raw, read_tables
from coeflab.tables.settings import Setting, read_setting
from tests.cli.conftest import Run, flat
from tests.cli.survey import too_long
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


MAPS = [
    a
    for m in ("Run=point", "Yaw angle=beta [deg]", "Fx=X [N]", "Fy=Y [N]", "Mz=N [Nm]", "Comment=ignore")
    for a in ("--map", m)
]


def sets(**more: str) -> list[str]:
    said = SAID | {k.replace("__", "."): v for k, v in more.items()}
    return [a for k, v in said.items() for a in ("--set", f"{k}={v}")]


def invoke(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments])


def refused(result: Result) -> tuple[str, ...]:
    assert isinstance(result.exception, CoeflabError), result.output
    return result.exception.lines


def left_open(result: Result) -> list[str]:
    """Keys and columns that the command at the end of the form leaves open; nothing else is missing from it."""
    assert result.exit_code == 2, result.output
    words = command_of(result.output)
    assert words[-1] == "--accept"
    return [
        text.partition("=")[0]
        for flag, text in pairwise(words)
        if flag in ("--set", "--map") and text.endswith(("=?", "[?]"))
    ]


def command_of(printed: str) -> list[str]:
    """The words of the command that ends what is printed."""
    return shlex.split(printed[printed.rindex("coeflab import ") :].replace("\\\n", " "))[1:]


def table_of(folder: Path) -> ForceTable:
    return read_tables(PlannedTable(folder, ()))[0]


@pytest.fixture(autouse=True)
def without_slopes(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is written is tested here; the slopes at the end, which take longer, by ``tests/tables/test_strangers.py``."""
    monkeypatch.setattr(import_, "_first_slopes", lambda folder: None)


@pytest.fixture
def drift(tmp_path: Path) -> Path:
    file = tmp_path / "drift.csv"
    file.write_text(DRIFT)
    return file


def test_everything_open_comes_in_one_form_with_the_command_that_settles_it(drift: Path, tmp_path: Path) -> None:
    done = invoke("import", drift, "--out", tmp_path / "out")
    keys = ["axes.frame", "axes.reference_point", "scaling.length", "conditions.density", "conditions.speed"]
    assert left_open(done) == keys
    lines = done.output.splitlines()
    alone = [line.removesuffix(" \\") for line in lines]  # a path of the command to paste, and that it goes on
    assert too_long("\n".join(alone)) == []
    shown = [line.split()[1] for line in lines if re.match(r" +\d+[? ] ", line)]
    assert shown[: len(keys)] == keys  # open ones first
    assert {"axes.beta", "axes.datum", "Run", "Fy", "source.kind", "source.citation"} < set(shown)
    assert "- if y is starboard, else +" in done.output
    assert "X > 0 (drag), x aft" in flat(done.output)
    assert not (tmp_path / "out").exists()


def test_several_files_of_one_folder_become_one_campaign(drift: Path, tmp_path: Path) -> None:
    for name in ("second", "third"):
        drift.with_name(f"{name}.csv").write_text(drift.read_text())
    second, out = drift.with_name("second.csv"), tmp_path / "made"
    asked = invoke("import", drift, second, "--out", out)
    assert asked.exit_code == 2
    assert command_of(asked.output)[1:3] == [str(drift), str(second)]
    assert invoke("import", drift, second, "--out", out, *sets(), *MAPS, "--accept").exit_code == 0
    assert [t.file for t in read_campaign(out / "campaign.toml").tables] == [drift.name, second.name]
    (tmp_path / "other").mkdir()
    (other := tmp_path / "other" / "fourth.csv").write_text(drift.read_text())
    (words := drift.with_name("words.txt")).write_text("no table\n")
    assert "several files of one folder" in refused(invoke("import", drift, other))[0]
    assert "words.txt: no table by its content" in refused(invoke("import", drift, words))[0]


def test_a_pattern_of_names_for_one_table_is_refused_with_the_way(drift: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError) as why:
        read_raw(drift, "table", {"names": "b{beta:deg}"})
    assert "a folder of runs" in why.value.expected
    assert "in columns" in why.value.advice


def test_what_one_table_says_for_another_is_named(tmp_path: Path) -> None:
    """Words over the first sheet counted for the second, and the form named the first alone."""
    folder = tmp_path / "in"
    folder.mkdir()
    rows = "".join(f"{b},1.5,{-3.0 * b},{2.0 * b}\n" for b in (-8, -4, 0, 4, 8))
    (folder / "one.csv").write_text(f'"Moments about midship",,,\nbeta [deg],U [m/s],Y [N],N [Nm]\n{rows}')
    (folder / "two.csv").write_text(f"alpha [deg],U [m/s],Z [N],M [Nm]\n{rows}")
    form = flat(invoke("import", folder, "--out", tmp_path / "out").output)
    assert """one, line 1: "Moments about midship", for two too, without words of its own""" in form


def test_the_command_of_the_form_settles_it(drift: Path, tmp_path: Path) -> None:
    form = invoke("import", drift, "--out", tmp_path / "out", "--map", "Run=label")
    said = {"axes.frame": "CFD", "axes.reference_point": "-2 from nose", "scaling.length": "4 m LOA", "conditions.density": "998.2",
            "conditions.speed": "2"}  # fmt: skip
    words = [
        f"{key}={said[key]}" if (key := word.partition("=")[0]) in said else word for word in command_of(form.output)
    ]
    done = invoke(*words)
    assert done.exit_code == 0, done.output
    table = table_of(tmp_path / "out")
    assert table.forces["X"].tolist() == [-12.3, -12.9, -13.07, -13.0, -12.5]
    assert table.forces["Y"].tolist()[:4] == [-29.4, -11.8, -0.72, 11.8]
    assert table.motion["v"][0] > 0.0
    assert [(e.component, e.line) for e in table.exclusions] == [("Y", 7)]
    assert (table.reference_point.tolist(), str(table.datum), table.scaling.length_name) == (
        [-2.0, 0.0, 0.0],
        "nose",
        "LOA",
    )


def test_what_is_left_as_a_question_mark_is_named(drift: Path, tmp_path: Path) -> None:
    done = invoke("import", drift, "--out", tmp_path / "out", "--set", "axes.frame=?", "--map", "Fy=Y [?]", "--accept")
    assert "axes.frame" in left_open(done)
    for part in (
        'found "axes.frame=?", left open; expected a value: CFD (y stb, z up) or aft,port,down',
        'found "Fy=?", left open',
    ):
        assert part in " ".join(done.output.split())
    assert not (tmp_path / "out").exists()


def test_proposals_wait_to_be_accepted_and_say_what_they_rest_on(drift: Path, tmp_path: Path) -> None:
    assert left_open(invoke("import", drift, "--out", tmp_path / "out", *sets())) == []
    assert not (tmp_path / "out").exists()
    done = invoke("import", drift, "--out", tmp_path / "out", "--accept", *sets())
    assert done.exit_code == 0, done.output
    text = (tmp_path / "out" / "campaign.toml").read_text()
    assert re.search(r'beta = "v = -U sin\(beta\)" +# Y to starboard and beta have the same sign', text)
    assert re.search(r'frame = "CFD" +# confirmed', text)
    assert f'source_sha256 = "{sha256_of(drift)}"' in text
    assert "Yaw angle = beta [deg]" in read_campaign(tmp_path / "out" / "campaign.toml").source.how_obtained
    plain = invoke("import", drift, "--out", tmp_path / "plain", *sets(axes__beta="-"), *MAPS)  # nothing waits
    assert plain.exit_code == 0, plain.output


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
    )
    lines = refused(invoke("import", drift, "--out", tmp_path / "out", *wrong, "--option", "sheet"))
    assert len(lines) == 4
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
    assert left_open(invoke(*ask, *sets(axes__frame="FRD"))) == ["table.contains_inertia"]
    asked = left_open(invoke(*ask, *sets(axes__frame="FRD", table__contains_inertia="yes")))
    assert asked == ["inertia.mass", "inertia.centre_of_gravity"]
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
    assert left_open(invoke(*ask, "--force", *sets(axes__frame="FRD", **more))) == ["inertia.inertia"]


def test_what_a_rotating_table_contains_is_asked_before_units_are_known(tmp_path: Path) -> None:
    for head, keys in (
        ("r", {"table.contains_inertia", "table.arm_point"}),
        ("R", {"table.contains_inertia", "table.centre", "table.arm_point"}),
    ):
        file = tmp_path / "arm.csv"
        file.write_text("yaw rate,Fy (N)\n1,2\n2,3\n" if head == "r" else "radius,Fy (N)\n1,2\n2,3\n")
        done = invoke("import", file, "--out", tmp_path / "out")
        left_open(done)
        assert set(re.findall(r"table\.(?:contains_inertia|centre|arm_point)", done.output)) == keys


def test_a_rotating_table_is_asked_where_its_drift_is_zero(tmp_path: Path) -> None:
    file, out = tmp_path / "arm.csv", tmp_path / "out"
    file.write_text("r (rad/s),Fy (N),Mz (Nm)\n-0.4,-10,13\n-0.2,-5,7\n0.2,5,-7\n0.4,10,-13\n")
    ask = ("import", file, "--out", out)
    known = sets(axes__frame="FRD", table__contains_inertia="false")
    shown = invoke(*ask, *known)
    assert shown.exit_code == 2
    assert "reference point" in shown.output.partition("table.arm_point")[2].partition("\n")[0]
    for said in (
        (*ask, "--yes", *known),
        (*ask, "--yes", "--force", *known, "--set", "table.arm_point=reference point"),
    ):
        done = invoke(*said)
        assert done.exit_code == 0, done.output
        assert "reference point" in (out / "campaign.toml").read_text().partition("arm_point = [")[2].partition("\n")[0]
        assert table_of(out).motion["v"].tolist() == [0.0] * 4
    done = invoke(*ask, "--yes", "--force", *known, "--set", "table.arm_point=-1.5 from nose")
    assert done.exit_code == 0, done.output
    table = table_of(out)
    behind = table.reference_point[0] + 1.5
    assert abs(behind) > 0.1
    assert table.motion["v"] == pytest.approx(behind * table.motion["r"])


@pytest.mark.usefixtures("in_a_shell")
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
            str(e) for e in interpreted(table, known, {"conditions.density": Setting(density, "confirmed")}).complaints
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


STRAIGHT = "run,u [m/s],X [N]\n1,0.8,-1.75\n2,1.0,-2.72\n3,1.2,-3.86\n"


def test_angles_beside_a_velocity_are_refused_before_anything_is_asked(tmp_path: Path) -> None:
    """A column of zero drift beside u says nothing; else the sign of beta would be asked for first, and the table refused after the answer."""
    file = tmp_path / "drag.csv"
    file.write_text("run,u [m/s],X [N],beta [deg]\n1,0.8,-1.75,0\n2,1.0,-2.72,0\n3,1.2,-3.86,0\n")
    assert "axes.beta" not in flat(invoke("import", file, "--out", tmp_path / "out").output)
    file.write_text("run,u [m/s],X [N],beta [deg]\n1,0.8,-1.75,2\n2,1.0,-2.72,4\n3,1.2,-3.86,6\n")
    (said,) = refused(invoke("import", file, "--out", tmp_path / "out"))
    assert "found angles (beta) and velocities (u); expected one or the other" in said
    assert "--map 'u=U [m/s]' where u is the speed" in said
    assert "beta=ignore" not in said


def test_straight_runs_are_told_from_a_table_whose_setting_is_not_mapped(tmp_path: Path) -> None:
    file = tmp_path / "drag.csv"
    file.write_text(STRAIGHT)
    said = flat(invoke("import", file, "--out", tmp_path / "out").output)
    assert "nothing varies but the speed: straight runs give X0', and no slope" in said
    assert "warning" not in said
    lines = [line + f",{i}" for i, line in enumerate(STRAIGHT.splitlines()[1:])]
    file.write_text("\n".join(["run,u [m/s],X [N],knob", *lines]))
    said = flat(invoke("import", file, "--out", tmp_path / "out", "--map", "knob=ignore").output)
    assert (
        "warning: nothing varies but the speed: straight runs give X0', and no slope; not used, and it varies: knob"
        in said
    )
    file.write_text("run,u [m/s],X [N]\n1,0.8,-1.75\n2,1.0,-2.72\n")
    assert "warning: nothing varies" in flat(invoke("import", file, "--out", tmp_path / "out").output)


def test_a_rate_whose_sign_the_numbers_contradict_stays_open(tmp_path: Path) -> None:
    """Also where the file itself names it, and --yes does not pass over it."""
    file = tmp_path / "arm.csv"
    file.write_text("r (rad/s),Fy (N),Mz (Nm)\n-0.4,-10,-13\n-0.2,-5,-7\n0.2,5,7\n0.4,10,13\n")
    ask = ("import", file, "--out", tmp_path / "out", "--yes", *sets(axes__frame="FRD", table__contains_inertia="no"))
    done = invoke(*ask)
    assert left_open(done) == ["r"]
    assert "-r [rad/s] or r [rad/s]: N and r have the same sign" in " ".join(done.output.split())
    file.write_text(file.read_text().replace("r (rad/s)", "r' (-)"))
    done = invoke(*ask)
    assert left_open(done) == ["r'"]
    assert "-r' [-] or r' [-]: N and r" in " ".join(done.output.split())
    file.write_text(file.read_text().replace("r' (-)", "r (rad/s)"))
    for word, sign in (("-r", -1.0), ("r", 1.0)):
        done = invoke(*ask, "--force", "--map", f"r={word} [rad/s]")
        assert done.exit_code == 0, done.output
        assert table_of(tmp_path / "out").motion["r"].tolist() == [sign * x for x in (-0.4, -0.2, 0.2, 0.4)]


def test_a_decimal_slip_that_hides_the_sign_of_the_angle_is_said(tmp_path: Path) -> None:
    file = tmp_path / "slip.csv"
    file.write_text("beta (deg),Fy (N)\n-8,-30\n-4,-140\n0,0\n4,14\n8,30\n")
    ask = ("import", file, "--out", tmp_path / "out", "--yes", *sets())
    done = invoke(*ask)
    assert left_open(done) == ["axes.beta"]
    assert "Y over beta shows no clear sign: too few rows, or a wrong reading" in flat(done.output)
    file.write_text(file.read_text().replace("-140", "-14"))
    assert invoke(*ask).exit_code == 0


def test_rows_without_a_setting_are_named_when_the_campaign_is_written(tmp_path: Path) -> None:
    file = tmp_path / "gaps.csv"
    file.write_text("beta (deg),Fy (N),U (m/s)\n-8,-30,2\n-4,-14,\n0,0,2\n4,14,n/a\n8,30,2\n")
    done = invoke("import", file, "--out", tmp_path / "out", "--yes", *sets())
    assert done.exit_code == 0, done.output
    assert len(table_of(tmp_path / "out")) == 3
    assert "Rows left out, no U: line 3 and line 5." in flat(done.output)


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
    done = invoke(*ask)
    assert "(1.2, 0, 0) in its axes" in done.output
    assert left_open(done) == ["axes.frame", "scaling.length"]
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


def test_a_point_copied_from_the_file_without_turning_its_axes_warns(runs: Path, tmp_path: Path) -> None:
    """The file's (1.2, 0, 0) with x aft is (-1.2, 0, 0) in FRD."""
    known = {"axes.frame": "CFD", "axes.datum": "midship", "scaling.length": "4 m LOA"}
    ask = ("import", runs, "--out", tmp_path / "out", "--name", "b{beta:deg:m=-}", "--accept", "--force",
           *[a for k, v in known.items() for a in ("--set", f"{k}={v}")])  # fmt: skip
    copied, turned = (flat(invoke(*ask, "--set", f"axes.reference_point={x},0,0").output) for x in (1.2, -1.2))
    assert "that point is [-1.2, 0.0, 0.0] in FRD" in copied
    assert "in FRD" not in turned.replace("in SI and FRD", "")


def test_kinematic_forces_of_a_solver_keep_their_density_with_its_unit(stub: Path, tmp_path: Path) -> None:
    """rhoInf 1: primes by 1 kg/m^3 of forces of 1 kg/m^3, in campaign.toml as it is read again."""
    for seed, (name, beta) in enumerate(RUNS.items()):
        stated = {"conditions.density": 1.0, "conditions.speed": 2.0, "axes.reference_point": [1.2, 0.0, 0.0]}
        write_run(tmp_path / "runs" / name, {"X": 13e-3, "Y": 3e-3 * beta}, seed=seed, stated=stated)
    said = {k: v for k, v in SAID.items() if not k.startswith("conditions.")}
    done = invoke("import", tmp_path / "runs", "--out", tmp_path / "out", "--name", "b{beta:deg:m=-}", "--yes",
                  *[a for k, v in said.items() for a in ("--set", f"{k}={v}")])  # fmt: skip
    assert done.exit_code == 0, done.output
    table = table_of(tmp_path / "out")
    assert table.conditions.density == 1.0
    assert (
        re.findall(r'density = "1.0 kg/m\^3"', (tmp_path / "out" / "campaign.toml").read_text())
        == ['density = "1.0 kg/m^3"'] * 2
    )
    assert table.forces["Y"] == pytest.approx([3e-3 * b for b in RUNS.values()], rel=5e-3, abs=1e-5)


def in_check(table: ForceTable) -> list[str]:
    """What the check of conditions warns of."""
    return [
        c.subject
        for c in conditions.check(SimpleNamespace(tables=[table], parameter_files={}))
        if c.severity is Severity.WARN
    ]  # type: ignore[arg-type]


@pytest.mark.parametrize(("typed", "said"), [("3000", 'Then write "3000 mm"'), ("0.004", 'Then write "0.004 km"')])
def test_a_length_of_no_hull_is_asked_back(drift: Path, tmp_path: Path, typed: str, said: str) -> None:
    """Without its unit; with it, it counts and warns."""
    ask = ("import", drift, "--out", tmp_path / "out", "--yes", "--force")
    done = invoke(*ask, *sets(**{"scaling.length": typed}))
    assert isinstance(done.exception, InputError)
    assert said in " ".join(str(done.exception).split())
    assert not (tmp_path / "out").exists()
    done = invoke(*ask, *sets(**{"scaling.length": f"{typed} m"}))
    assert done.exit_code == 0, done.output
    assert in_check(table_of(tmp_path / "out")) == ["out unit of length"]


@pytest.mark.parametrize(("key", "typed", "said"), [
    ("conditions.speed", "2000", 'is it in mm/s? Then write "2000 mm/s"'),
])  # fmt: skip
def test_a_number_in_another_unit_is_a_warning(drift: Path, tmp_path: Path, key: str, typed: str, said: str) -> None:
    """At import and by the check of conditions."""
    ask = ("import", drift, "--out", tmp_path / "out", "--yes", "--force")
    done = invoke(*ask, *sets(**{key: typed}))
    assert done.exit_code == 0, done.output
    assert f"warning, {key}: " in " ".join(done.output.split())
    assert said in " ".join(done.output.split())
    name = key.partition(".")[2]
    assert in_check(table_of(tmp_path / "out")) == [f"out unit of {name}"]


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

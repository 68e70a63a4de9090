"""The form of ``coeflab import`` on a terminal: one screen, one line of answers, Enter."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import Result
from typer.testing import CliRunner

from coeflab.cli import app, import_
from coeflab.cli.import_ import _first_slopes
from coeflab.law.scaling import beyond_ends
from coeflab.report.tables.force_tables import unused
from coeflab.study.checks import coverage
from coeflab.tables.campaign import read_campaign
from coeflab.tables.questions import questions
from coeflab.tables.raw_table import RawTable, Stated
from coeflab.tables.settings import Setting
from tests.cli.conftest import flat
from tests.cli.test_import import RUNS, command_of, drift, invoke, left_open, runs, sets, stub, table_of, without_slopes

__all__ = ["drift", "runs", "stub", "without_slopes"]

ARM = "r' (-),Fx,Fz,Mz\n0.1,-77,-15,48\n0.2,-78,-31,100\n0.3,-80,-50,160\n0.4,-81,-69,222\n"
SIZES = "axes.reference_point=midship; scaling.length=4 LOA; conditions.density=998.2; conditions.speed=2"


def answered(monkeypatch: pytest.MonkeyPatch, answers: list[str], *arguments: object) -> Result:
    """What a command says to one who types these answers, as on a terminal."""
    monkeypatch.setattr(import_, "sys", SimpleNamespace(stdin=SimpleNamespace(isatty=lambda: True)))
    done = CliRunner().invoke(app, [str(a) for a in arguments], input="\n".join(answers) + "\n")
    monkeypatch.undo()
    monkeypatch.setattr(import_, "_first_slopes", lambda folder: None)
    return done


def test_one_line_answers_all_and_an_empty_one_accepts(
    drift: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = "1=CFD; 2=-2 from nose; 3=4 LOA; 4=998.2; 5=2; Fy=Y"
    done = answered(monkeypatch, [line, ""], "import", drift, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert done.output.count("explains") == 2  # prompts
    second = done.output.split("explains")[1]
    assert ">  6  axes.beta             v = -U sin(beta)        assumed: Yv' < 0" in second  # by the axes, and marked
    table = table_of(tmp_path / "out")
    assert table.forces["Y"].tolist()[:2] == [-29.4, -11.8]
    assert (table.reference_point.tolist(), str(table.datum)) == ([-2.0, 0.0, 0.0], "nose")


def test_without_out_the_folder_is_called_after_what_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    named = Path("Schlepp versuch (1).csv")
    named.write_text("Driftwinkel;Fy\n-4;-9,1\n0;0,2\n4;8,8\n")
    assert "--out Schlepp_versuch_1 " in CliRunner().invoke(app, ["import", str(named)]).output
    assert import_._named_after(Path()) == Path(f"{tmp_path.name}_campaign")


def test_wrong_answers_are_named_together_and_none_is_taken(
    drift: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = ["1=XYZ; 2=2 m aft of nose; nothing=3; Fy=Y [deg]; 3=4 LOA", "", "3 ?; ?"]
    done = answered(monkeypatch, answers, "import", drift, "--out", tmp_path / "out")
    assert done.exit_code == 1
    said = flat(done.output)
    for part in ('found "XYZ"; expected "FRD", "FLU", "CFD"', "expected the side as a sign", 'no key or column "nothing"',
                 "unit of another dimension", "Open: 1 axes.frame, 2 axes.reference_point, 3 scaling.length",
                 "scaling.length: Length of the primes, m, with its name: 4.3 m LOA",
                 "axes.frame: Axes of the forces: FRD (x forward, y starboard, z down)"):  # fmt: skip
        assert part in said, (part, said)
    assert not (tmp_path / "out").exists()


def test_numbers_stay_while_the_form_changes(drift: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    answers = ["1=CFD", "3=4 LOA", "2=-2 from nose; 5=2", "4=1.025", "4=998.2", ""]
    done = answered(monkeypatch, answers, "import", drift, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert 'Is it g/cm^3? Then write "1.025 g/cm^3"' in flat(done.output)
    table = table_of(tmp_path / "out")
    assert (table.conditions.density, table.conditions.speed, table.scaling.length) == (998.2, 2.0, 4.0)


MONITORS = '"run","beta (deg)","Fy Monitor: Fy Monitor (kN)","Moment Z Monitor: Moment Z Monitor {}"\n' + "".join(
    f"{i},{b},{-0.01 * b},{0.02 * b}\n" for i, b in enumerate((-8, -4, 0, 4, 8))
)


@pytest.mark.parametrize("written", ["(kN-m)", "(kN.m)", "(kNm)", "(kN m)", "(kN_m)", "(kN×m)", "[kN-m]"])
def test_a_moment_in_kilonewton_metres_is_read_as_its_file_says(tmp_path: Path, written: str) -> None:
    """However the product is written, and whatever columns.units says of columns that state none."""
    file = tmp_path / "monitors.csv"
    file.write_text(MONITORS.format(written))
    done = invoke("import", file, "--out", tmp_path / "out", "--accept", *sets(columns__units="SI"))
    assert done.exit_code == 0, done.output
    assert table_of(tmp_path / "out").forces["N"].tolist() == pytest.approx([160.0, 80.0, 0.0, -80.0, -160.0])  # z up


@pytest.mark.parametrize("written", ["(kNxm)", "[kNxm]", "(kN*m*K)"])
def test_a_unit_that_nobody_knows_is_never_si(tmp_path: Path, written: str) -> None:
    file = tmp_path / "monitors.csv"
    file.write_text(MONITORS.format(written))
    done = invoke("import", file, "--out", tmp_path / "out", "--accept", *sets(columns__units="SI"))
    assert done.exit_code == 2
    assert "Y [kN] accepted; -0.08" in flat(done.output)
    (column,) = left_open(done)
    unit = written[1:-1]
    assert f"line 1: its unit [{unit}] is none known of moment: say such as N [N m] or N [kN m]" in flat(done.output)
    assert not (tmp_path / "out").exists()
    by_hand = (*sets(columns__units="SI"), "--map", f"{column}=N [kN m]")
    done = invoke("import", file, "--out", tmp_path / "out", "--accept", *by_hand)
    assert done.exit_code == 0, done.output
    assert table_of(tmp_path / "out").forces["N"].tolist() == pytest.approx([160.0, 80.0, 0.0, -80.0, -160.0])  # z up


@pytest.mark.parametrize(("answer", "sign"), [("-r' [-]", -1.0), ("r' [-]", 1.0)])
def test_a_rate_that_the_numbers_contradict_is_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, answer: str, sign: float
) -> None:
    """Forces without a unit: only in SI, one answer for all, are N and r comparable; with z up r > 0 turns to port."""
    file = tmp_path / "arm.csv"
    file.write_text(ARM)
    answers = [f"columns.units=SI; axes.frame=FLU; {SIZES}; table.contains_inertia=no", f"r'={answer}", ""]
    done = answered(monkeypatch, answers, "import", file, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert "-r' [-] or r' [-]: N and r have the same sign" in flat(done.output)
    rates = [sign * -0.5 * x for x in (0.1, 0.2, 0.3, 0.4)]
    assert table_of(tmp_path / "out").motion["r"].tolist() == pytest.approx(rates)


def test_a_rate_about_an_axis_whose_forces_rest_is_open(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With y up, r is pitch about z; Y and N vary, so that yaw is meant, q of the file, even where --map says r."""
    file = tmp_path / "arm.csv"
    file.write_text(ARM)
    units = ("--map", "Fx=X [N]", "--map", "Fz=Z [N]", "--map", "Mz=M [N*m]")
    up = sets(axes__frame="forward,up,starboard", table__contains_inertia="no")
    for said in ((), ("--map", "r'=r'")):
        done = invoke("import", file, "--out", tmp_path / "out", "--accept", *units, *said, *up)
        assert left_open(done) == ["r'"]
        assert "-q' [-] or q' [-]: r counts about the z axis of the frame, which points starboard" in flat(done.output)
    for folder, answer in (("out", ("--map", "r'=-q'")), ("asked", ())):
        answers = [""] if answer else ["r'=-q' [-]", ""]
        done = answered(monkeypatch, answers, "import", file, "--out", tmp_path / folder, *units, *answer, *up)
        assert done.exit_code == 0, done.output
        assert table_of(tmp_path / folder).motion["r"].tolist() == pytest.approx([0.05, 0.1, 0.15, 0.2])
        assert not np.any(table_of(tmp_path / folder).motion["q"])


def test_area_and_length_of_coefficients_are_said_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "arm.csv"
    rows = "".join(f"{i},{2 * i},{10 + i},{0.1 * i},{0.01 * i}\n" for i in range(1, 6))
    file.write_text("Run,Drift (deg),R (m),CY,CN\n" + rows)
    first = (
        "coefficients.area=0.2 m^2; axes.frame=FRD; axes.beta=-; axes.reference_point=nose; scaling.length=4 LOA; "
        "conditions.density=1000; conditions.speed=2; table.centre=starboard; table.contains_inertia=true"
    )
    answers = [first, "inertia.mass=64; inertia.centre_of_gravity=0", ""]
    done = answered(monkeypatch, answers, "import", file, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert 'CN = "N [coefficient A=0.2 m^2 L=4.0 m]"' in (tmp_path / "out" / "mapping.toml").read_text()
    table = table_of(tmp_path / "out")
    assert table.arm_point.tolist() == table.reference_point.tolist() == [0.0, 0.0, 0.0]


def test_coefficients_may_be_primes_whose_speed_and_density_cancel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "primes.csv"
    file.write_text("Drift;CY;CN\ndeg;1e-3;1e-3\n-4;1.5;0.5\n0;0;0\n4;-1.5;-0.5\n")
    first = "coefficients.area=prime; axes.frame=FRD; axes.reference_point=cg; scaling.length=4 LOA"
    done = answered(monkeypatch, [first, "conditions.speed=2", ""], "import", file, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert "it cancels" in done.output
    assert table_of(tmp_path / "out").forces["Y"].tolist() == pytest.approx([48.0, 0.0, -48.0])


TANK = """Schlepptank, Versuch 2213
v = 1,5 m/s; rho = 998,8 kg/m3
Lpp = 4,3 m; Momente um Hauptspant; x nach vorn, y nach Steuerbord
Fahrt;Schiebewinkel;Kraft längs;Kraft quer;Moment um Hochachse
-;deg;N;N;Nm
""" + "".join(f"{i};{b};{-20 - abs(b):d},5;{3 * b},25;{-b},125\n" for i, b in enumerate((-8, -4, 0, 4, 8), start=1))


def test_lines_over_a_german_table_leave_nothing_open(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Axes, point, speed, density, length, kind of its own lines: Enter; a sign that the numbers contradict warns."""
    file = tmp_path / "tank.csv"
    file.write_text(TANK, encoding="utf-8")
    done = answered(monkeypatch, ["axes.beta=+", "axes.beta=-", ""], "import", file, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    said = flat(done.output)
    for part in (
        "Kraft quer Y [N]",
        "Moment um Hochachse N [Nm]",
        "declared is axes.beta = v = +U sin(beta). One of them",
    ):
        assert part in said, (part, said)
    table = table_of(tmp_path / "out")
    assert (table.conditions.speed, table.conditions.density, table.scaling.length) == (1.5, 998.8, 4.3)
    assert (table.scaling.length_name, str(table.datum), table.source.kind) == ("LPP", "midship", "experiment")
    assert table.forces["Y"].tolist() == [-24.25, -12.25, 0.25, 12.25, 24.25]


def test_lines_over_a_table_are_offered_and_never_taken(tmp_path: Path) -> None:
    """An area of them makes a coefficient that has to be accepted, even under coeflab's own names."""
    file = tmp_path / "tank.csv"
    file.write_text("# S = 0.25 m^2, V = 2 m/s, m = 4.3 m\nbeta [deg],Y [-]\n-4,0.01\n0,0\n4,-0.01\n")
    done = invoke("import", file, "--out", tmp_path / "out")
    assert left_open(done) == ["axes.frame", "scaling.length"]  # forces alone need no point
    assert 'conditions.speed 2 line 1: "V = 2 m/s"' in flat(done.output)
    assert "Y [coefficient A=0.25 m^2]" in done.output
    assert not (tmp_path / "out").exists()


def test_a_pattern_of_names_is_proposed_and_shown(runs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    line = "axes.frame=CFD; axes.reference_point=-2 from nose; scaling.length=4 LOA; axes.beta=-"
    answers = ["names ?", "names=c{beta:deg}", line, ""]
    done = answered(monkeypatch, answers, "import", runs, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    for part in ("names b{beta:deg:m=-}", "bm8: beta = -8 deg", "A minus is - unless the pattern spells it"):
        assert part in flat(done.output), (part, done.output)
    made = table_of(tmp_path / "out")
    assert np.degrees(np.arcsin(made.motion["v"] / 2.0)) == pytest.approx([-b for b in RUNS.values()])
    assert "b{beta:deg:m=-}" in (tmp_path / "out" / "mapping.toml").read_text()


def test_the_point_that_a_file_states_is_turned_to_frd() -> None:
    raw = RawTable(Path("t.csv"), (), stated={"axes.reference_point": Stated((1.2, 0.0, 0.3), "setup:7")})
    asked = {q.key: q for q in questions(raw, (), {"axes.frame": Setting("CFD", "confirmed")})}
    assert asked["axes.reference_point"].default == "-1.2, 0, -0.3"
    assert asked["axes.datum"].default == "origin_t"
    open_frame = {q.key: q for q in questions(raw, (), {})}["axes.reference_point"]
    assert (open_frame.default, open_frame.shown) == ("", "(1.2, 0, 0.3) in its axes")


@pytest.mark.parametrize(
    ("words", "typed"),
    [("moments about x = 1.2 m aft of the nose", "-1.2 nose"), ("Momentenbezugspunkt 0.45 L", "-1.8 nose"),
     ("MRP at midships", "0 midship"), ("MRP 0.25 m forward of midships", "0.25 midship"), ("CofR : (2.0 0 0)", "-2 origin_drift")],
)  # fmt: skip
def test_a_point_of_moments_in_words_is_proposed_with_its_line(
    drift: Path, tmp_path: Path, words: str, typed: str
) -> None:
    """Shown in the form, nothing taken without --accept; two commands to a campaign."""
    drift.write_text(drift.read_text().replace("# tank", f"# {words}"))
    said = [a for a in sets()[1::2] if not a.startswith(("axes.reference_point", "axes.datum"))]
    known = [a for text in said for a in ("--set", text)]
    form = invoke("import", drift, "--out", tmp_path / "out", *known)
    assert left_open(form) == [], form.output
    assert words in flat(form.output)
    assert not (tmp_path / "out").exists()
    done = invoke(*command_of(form.output))
    assert done.exit_code == 0, done.output
    x, datum = typed.split()
    read = read_campaign(tmp_path / "out" / "campaign.toml")
    assert (read.reference_point.tolist(), read.datum.id) == ([float(x), 0.0, 0.0], datum)


def test_marked_rows_are_kept_out_of_fits_and_named(tmp_path: Path) -> None:
    """A mark column, a star behind a run's name and one behind a number."""
    file = tmp_path / "marks.csv"
    rows = "1;-8;-29,4;\n2;-4;-11,8;\n3;0;-0,7;*\n4;4;11,8;\n5*;8;29,5;\n6;10;39,5*;\n"
    file.write_text(f"Run;beta;Fy;Bem\n-;deg;N;\n{rows}")
    form = invoke("import", file, "--out", tmp_path / "out", *sets(axes__frame="FRD"))
    done = invoke(*command_of(form.output))
    assert done.exit_code == 0, done.output
    assert "Points left out: 3, 5*: marked uncertain in the file; 6: blank in the source." in flat(done.output)
    assert table_of(tmp_path / "out").usable["Y"].tolist() == [True, True, False, True, False, False]
    said = unused([table_of(tmp_path / "out")])  # the line of `coeflab fit`
    assert said == "Points left out: 3, 5*: marked uncertain in the file; 6: blank in the source."


def test_signs_are_judged_where_a_campaign_reads_its_file_in_place(tmp_path: Path) -> None:
    """The same evidence as at import, as notes of the table; none once the sign is turned."""
    (tmp_path / "arm.csv").write_text("r (rad/s),Fy (N),Mz (Nm)\n-0.4,-10,-13\n-0.2,-5,-7\n0.2,5,7\n0.4,10,13\n")
    keys = (
        '[campaign]\ntitle = "T"\nbody = "b"\nimporter = "table"\n[columns]\nr = "{}"\nFy = "Y"\nMz = "N"\n[axes]\nframe = "FRD"\n'
        'datum = "nose"\nreference_point = [-2, 0, 0]\n[scaling]\nlength = 4.0\nlength_name = "LOA"\n[conditions]\n'
        'density = 1025.0\nspeed = 2.0\n[source]\nkind = "cfd"\ncitation = "c"\n[[table]]\nfile = "arm.csv"\ncontains_inertia = false\n'
    )
    for said, warned in (("r", True), ("-r", False)):
        (tmp_path / "campaign.toml").write_text(keys.format(said), encoding="utf-8")
        notes = [note for note in table_of(tmp_path).notes if note.startswith("warning: N and r have the same sign")]
        assert bool(notes) is warned


def test_a_bare_answer_counts_for_the_one_key_that_is_open(
    drift: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With two open, it is refused; a word as well as a number, which elsewhere explains a line."""
    answers = ["midship", "1=CFD; 3=4 LOA; 4=998.2; 5=2; Fy=Y", "midship", ""]
    done = answered(monkeypatch, answers, "import", drift, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert 'found "midship"; expected KEY=VALUE' in flat(done.output)
    assert str(table_of(tmp_path / "out").datum) == "midship"
    answers = ["axes.frame=CFD; axes.reference_point=midship; 3=4 LOA; 5=2; Fy=Y", "820", ""]
    done = answered(monkeypatch, answers, "import", drift, "--out", tmp_path / "other")
    assert done.exit_code == 0, done.output
    assert table_of(tmp_path / "other").conditions.density == 820.0


def test_what_a_proposed_setting_rests_on_is_never_cut(tmp_path: Path) -> None:
    file = tmp_path / "tank.csv"
    file.write_text(
        "# Towing tank of the university at Nordhafen, fresh water, the temperature of which was 12 °C\n"
        "# uncorrected for inertia of the model in all of the runs of this long series, model mass 820 kg\n"
        "R (m),Fx (N),Fy (N),Mz (Nm)\n8,-10,-5,-13\n10,-10,-5,-11\n12,-10,-4,-10\n"
    )
    said = flat(invoke("import", file, "--out", tmp_path / "out").output)
    assert "…" not in said.partition("Columns")[0]
    assert 'fresh water of 12 °C; line 1: "of which was 12 °C"; line 1: "Towing tank", fresh water' in said
    assert 'line 2: "uncorrected for inertia of the model in all of the runs of this long series"' in said


def test_two_commands_suffice_where_forces_contain_inertia(tmp_path: Path) -> None:
    """The first names at once what true needs beside it."""
    file = tmp_path / "arm.csv"
    file.write_text("R (m),Fx (N),Fy (N),Mz (Nm)\n8,-10,-5,-13\n10,-10,-5,-11\n12,-10,-4,-10\n")
    first = invoke("import", file, "--out", tmp_path / "out")
    assert "# if true: add --set inertia.mass=... --set inertia.centre_of_gravity=..." in flat(first.output)
    said = {"axes__frame": "FRD", "axes__reference_point": "midship", "scaling__length": "4 LOA", "conditions__density": "998.2",
            "conditions__speed": "2", "table__contains_inertia": "true"}  # fmt: skip
    both = ("--set", "inertia.mass=820", "--set", "inertia.centre_of_gravity=0")
    done = invoke("import", file, "--out", tmp_path / "out", *sets(**said), *both, "--accept")
    assert done.exit_code == 0, done.output
    assert "# if true" not in done.output


DRIFTS = (-8, -6, -4, -2, 0, 2, 4, 6, 8)


def swept(monkeypatch: pytest.MonkeyPatch, file: Path, **more: str) -> Result:
    """An import that prints its first slopes."""
    monkeypatch.setattr(import_, "_first_slopes", _first_slopes)
    said = {"axes.frame": "FRD", "axes.reference_point": "midship", "scaling.length": "4 LOA",
            "conditions.density": "998.2", "conditions.speed": "2", "axes.beta": "v = -U sin(beta)",
            "table.contains_inertia": "no"} | more  # fmt: skip
    words = [a for k, v in said.items() for a in ("--set", f"{k}={v}")]
    return invoke("import", file, "--out", file.parent / "out", *words, "--accept")


def test_below_the_first_slopes_stands_what_the_checks_find(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A lost decimal comma of Y at 6 deg warns; Y of the other sign fails, the files stay and the exit code is 1."""
    q, file = 0.5 * 998.2 * 4.0 * 16.0, tmp_path / "drift.csv"
    for sign, code in ((1.0, 0), (-1.0, 1)):
        sides = [f"{sign * 0.03 * q * np.radians(b):.2f}" for b in DRIFTS]
        sides[7] = sides[7].replace(".", "")
        file.write_text("beta [deg],Y [N]\n" + "".join(f"{b},{y}\n" for b, y in zip(DRIFTS, sides, strict=True)))
        done = swept(monkeypatch, file)
        said = flat(done.output.partition("First slopes")[2])
        assert done.exit_code == code, done.output
        assert "warn data gate, out/table.csv line 10: Y =" in said
        assert ("fail signs, out Yv': Yv' = 0.03. " in said and "Expected: below zero." in said) == bool(code)
        assert ("The campaign is written, and a check fails." in said) == bool(code)
        assert said.rpartition("Next: ")[2].startswith("coeflab fit")
        assert max(map(len, done.output.partition("Next: ")[0].partition("First slopes")[2].splitlines())) <= 80
        assert (tmp_path / "out" / "campaign.toml").exists()
        shutil.rmtree(tmp_path / "out")


def test_a_fit_of_combined_settings_is_named_where_sweeps_are_too_short(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "arm.csv"
    grid = [(b, r) for r in (0.2, 0.3, 0.4) for b in (-4, 0, 4, 8)]
    file.write_text(
        "beta [deg],r' [-],Y [N],N [Nm]\n" + "".join(f"{b},{r},{9 * b + r},{3 * b - 90 * r}\n" for b, r in grid)
    )
    done = swept(monkeypatch, file)
    assert flat(done.output.replace("\\", "")).endswith("--fit manoeuvring_model"), done.output
    assert "Yr' " in done.output.partition("First slopes")[2]
    assert "9 rows combine motions: the fit manoeuvring_model takes them" in flat(
        invoke("fit", tmp_path / "out").output
    )


@pytest.mark.parametrize(("moment", "frame", "warned"), [("M", '["aft", "up", "port"]', True), ("M", "FRD", False)])
def test_a_moment_that_goes_to_the_other_plane_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, moment: str, frame: str, warned: bool
) -> None:
    """CM about the y axis of a mesh with y up is N of the body: Mw' was lost without a word."""
    file, force = tmp_path / "mesh.csv", "Y" if warned else "Z"
    file.write_text(f"alpha [deg],{force} [N],{moment} [Nm]\n" + "".join(f"{a},{-9 * a},{6 * a}\n" for a in DRIFTS))
    done = swept(monkeypatch, file, **{"axes.frame": frame, "axes.alpha": "w = +U sin(alpha)"})
    said = flat(done.output)
    mapped = (
        "If it is the moment of pitch, map its column as N or -N; if it is M as the axes say, the file has no M of the"
    )
    assert (mapped in said) == warned, done.output
    assert (
        "warn coverage, out/mesh.csv N: N follows w, and there is no M" in said.replace("table.csv", "mesh.csv")
    ) == warned


def test_a_yaw_moment_named_for_pitch_is_said() -> None:
    """v and M of the axes of a body vary, N is absent; with alpha beside beta nothing can be said."""
    x = np.linspace(-0.1, 0.1, 5)
    table = SimpleNamespace(
        name="t", speed=np.full(5, 2.0), scaling=SimpleNamespace(length=4.0), forces={"M": 3.0 * x},
        motion={"u": np.full(5, 2.0), "v": x, "w": 0.0 * x, "p": 0.0 * x, "q": 0.0 * x, "r": 0.0 * x},
    )  # fmt: skip
    found = coverage._moment_of_the_other_plane(table)
    assert found.statistic == "M follows v, and there is no N"
    table.motion["w"] = x[::-1]
    assert coverage._moment_of_the_other_plane(table) is None
    table.motion["w"] = 0.0 * x
    table.forces["M"] = np.full(5, 0.3)
    assert coverage._moment_of_the_other_plane(table) is None


def test_a_point_ahead_of_the_nose_is_said_in_the_form_and_by_the_checks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """1.10 from nose: x counts forward."""
    file = tmp_path / "drift.csv"
    file.write_text("beta [deg],Y [N]\n" + "".join(f"{b},{9 * b}\n" for b in DRIFTS))
    said = flat(swept(monkeypatch, file, **{"axes.reference_point": "1.10 from nose"}).output)
    form, _, slopes = said.partition("First slopes")
    assert "warning, axes.reference_point: 1.10 m ahead of the nose; aft is negative" in form
    assert "warn conditions, out reference point: nose +1.10 m. 1.10 m ahead" in slopes
    assert [beyond_ends(d, x, 4.0) for d, x in (("nose", -4.3), ("midship", 2.1), ("cg", 9.0), ("tail", 0.0))] == [
        ""
    ] * 4
    assert beyond_ends("nose", -5.0, 4.0) == "1.00 m behind the tail; forward is positive"
    assert beyond_ends("midship", 3.0, 4.0) == "1.00 m ahead of the nose; aft is negative"
    assert beyond_ends("tail", 5.0, 4.0) == "1.00 m ahead of the nose; aft is negative"
    assert (beyond_ends("nose", -9.0), beyond_ends("midship", 9.0)) == ("", "")
    assert beyond_ends("nose", 0.2) == "0.20 m ahead of the nose; aft is negative"


def test_a_sign_inferred_from_the_slope_is_assumed_and_proves_nothing(
    tmp_path: Path, coeflab: Callable[..., subprocess.CompletedProcess[str]]
) -> None:
    """Y and beta with the same sign: accepted, the sign of beta is labelled; said by a person, it is not."""
    rows = [f"{b},{0.026 * np.sin(np.radians(b)) + 1e-6 * (-1) ** b:.7f}" for b in range(-12, 13, 3)]
    (tmp_path / "drift.csv").write_text("\n".join(["beta (deg),Y'", *rows]) + "\n")
    known = [
        "--set",
        "axes.frame=FRD",
        "--set",
        "axes.reference_point=-2.0 from nose",
        "--set",
        "scaling.length=4.26 LBP",
    ]
    for folder, said in (("inferred", []), ("stated", ["--set", "axes.beta=-"])):
        done = coeflab("import", "drift.csv", "--out", folder, *known, *said, "--accept")
        assert done.returncode == 0, done.stderr
        assert ('assumed = ["beta"]' in (tmp_path / folder / "campaign.toml").read_text()) is (not said)
        shown = flat(coeflab("fit", folder, "--wide").stdout)
        assert ("Not independent: the sign of beta was inferred from it." in shown) is (not said)
        assert ("v = -U sin(beta), so that Yv' < 0: Yv' (assumed)" in shown) is (not said)

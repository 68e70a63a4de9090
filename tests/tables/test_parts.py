"""Several sheets, tables of a folder and patterns of names in one command: one campaign with several tables. All synthetic."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from coeflab.core.errors import InputError
from coeflab.tables.conditions import NoConditionError, likely_patterns
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import PlannedTable
from coeflab.tables.parts import Part, require_parts
from coeflab.tables.raw_table import RawTable
from coeflab.tables.reading import read_tables
from tests.cli.conftest import flat
from tests.cli.test_import import command_of, invoke, left_open, refused, stub, without_slopes
from tests.cli.test_import_form import answered
from tests.tables.runs_as_text import write_run
from tests.tables.test_excel import rows, workbook

__all__ = ["stub", "without_slopes"]

ABOVE = ("towing tank, fresh water 15 °C, v = 2.0 m/s, model length overall 4.0 m",)
AXES = ("moments about midships; x forward, y to starboard, z down",)
DRIFT = (
    ("Run", "Drift (deg)", "Fy (N)", "Mz (Nm)"),
    (1, -8, -130.5, -180.2),
    (2, -4, -57.25, -92.5),
    (3, 4, 57.5, 92.0),
    (4, 8, 131.0, 181.0),
)
ARM = (
    ("Run", "R (m)", "U (m/s)", "Fy (N)", "Mz (Nm)"),
    (1, 8.0, 1.6, 12.5, -40.0),
    (2, 10.0, 1.6, 10.0, -31.5),
    (3, 14.0, 1.6, 7.0, -22.0),
)
ATTACK = (
    ("Run", "Incidence (deg)", "Fz (N)", "My (Nm)"),
    (1, -8, 40.0, -95.0),
    (2, -4, 18.5, -48.0),
    (3, 4, -18.0, 48.5),
    (4, 8, -40.5, 96.0),
)


@pytest.fixture
def book(tmp_path: Path) -> Path:
    """Drift, arm and attack sheets, each with its own columns, speed and words, and one of no forces."""
    return workbook(
        tmp_path / "tests.xlsx",
        Drift=rows(ABOVE, AXES, *DRIFT),
        Arm=rows(("rotating arm; inertia subtracted",), *ARM),
        Attack=rows(("v = 1.5 m/s",), *ATTACK),
        Notes=rows(("item", "value"), ("mass", 820), ("day", 3)),
    )


def tables_of(folder: Path) -> dict[str, ForceTable]:
    return {t.name.rpartition("/")[2]: t for t in read_tables(PlannedTable(folder, ()))}


def test_a_workbook_of_three_sheets_is_one_campaign_by_two_commands(book: Path, tmp_path: Path) -> None:
    form = invoke("import", book, "--out", tmp_path / "out")
    assert left_open(form) == [], form.output
    assert "sheet Notes: no force or moment by its names" in flat(form.output)
    assert 'Arm, line 1: "inertia subtracted"' in flat(form.output)
    assert not (tmp_path / "out").exists()
    done = invoke(*command_of(form.output))
    assert done.exit_code == 0, done.output
    made = tables_of(tmp_path / "out")
    assert list(made) == ["Drift.csv", "Arm.csv", "Attack.csv"]
    assert [t.speed.tolist()[0] for t in made.values()] == [2.0, 1.6, 1.5]  # each its own
    assert made["Arm.csv"].motion["r"] == pytest.approx([0.2, 0.16, 1.6 / 14.0], rel=1e-14)
    assert made["Arm.csv"].forces["N"].tolist() == [-40.0, -31.5, -22.0]
    assert made["Drift.csv"].motion["v"][0] == pytest.approx(2.0 * np.sin(np.radians(8.0)))
    assert made["Attack.csv"].motion["w"][0] == pytest.approx(-1.5 * np.sin(np.radians(8.0)))
    assert {t.conditions.density for t in made.values()} == {999.1}
    text = (tmp_path / "out" / "campaign.toml").read_text()
    assert text.count("contains_inertia = false") == text.count('centre = "starboard"') == 1
    again = invoke(
        "import", book, "--mapping", tmp_path / "out" / "mapping.toml", "--out", tmp_path / "two", "--accept"
    )
    assert again.exit_code == 0, again.output
    for name in made:
        assert (tmp_path / "two" / name).read_bytes() == (tmp_path / "out" / name).read_bytes()


def test_one_table_is_said_by_its_name_before_a_slash(book: Path, tmp_path: Path) -> None:
    wrong = invoke(
        "import", book, "--out", tmp_path / "out", "--set", "Pool/table.centre=port", "--map", "Pool/Fy=Y [N]"
    )
    assert "Pool" in " ".join(refused(wrong))
    said = ("--set", "Arm/table.centre=port", "--map", "Arm/Fy=-Y [N]", "--option", "sheet=Drift, Arm")
    done = invoke("import", book, "--out", tmp_path / "out", *said, "--accept")
    assert done.exit_code == 0, done.output
    made = tables_of(tmp_path / "out")
    assert list(made) == ["Drift.csv", "Arm.csv"]
    assert made["Arm.csv"].motion["r"][0] == -0.2
    assert made["Arm.csv"].forces["Y"][0] == -12.5
    assert made["Drift.csv"].forces["Y"][0] == -130.5
    one = invoke("import", book, "--out", tmp_path / "one", "--option", "sheet=Drift", "--accept")
    assert one.exit_code == 0, one.output
    assert list(tables_of(tmp_path / "one")) == ["table.csv"]


def test_words_of_two_sheets_that_differ_are_open_with_both(tmp_path: Path) -> None:
    other = rows(("moments about the nose; sea water 15 °C",), *ATTACK)
    book = workbook(tmp_path / "t.xlsx", Drift=rows(ABOVE, AXES, *DRIFT), Attack=other)
    form = invoke("import", book, "--out", tmp_path / "out")
    points = ["Drift/axes.reference_point", "Attack/axes.reference_point"]
    assert left_open(form) == [*points, "axes.datum"], form.output
    said = flat(form.output)
    assert "Attack, line 1" in said
    assert "Drift, line 2" in said
    typed = dict(zip(points, ("0 from midship", "2 from midship"), strict=True))
    sets = [a for key, value in typed.items() for a in ("--set", f"{key}={value}")]
    done = invoke("import", book, "--out", tmp_path / "out", *sets, "--accept")
    assert done.exit_code == 0, done.output
    made = tables_of(tmp_path / "out")
    assert [t.density is None for t in made.values()] == [True, False]  # sea water in one of them
    assert made["Attack.csv"].forces["M"][0] == pytest.approx(-95.0 + 2.0 * 40.0 * -1.0)  # moved to midships


@pytest.mark.parametrize(("share", "asked"), [(0.5, True), (0.503, True), (0.47, False), (1.0, False)])
def test_a_table_with_half_the_drag_of_another_asks_for_its_half(tmp_path: Path, share: float, asked: bool) -> None:
    """A half model of runs in attack without Y, K, N monitors gave half of Zw' and Mw' without a word."""
    folder = tmp_path / "series"
    folder.mkdir()
    angles = (-8.0, -4.0, 0.0, 4.0, 8.0)
    for name, head, k, x in (
        ("drift", "Drift (deg);Fx (N);Fy (N)", 15.0, -80.0),
        ("attack", "Incidence (deg);Fx (N);Fz (N)", -5.0, -80.0 * share),
    ):
        lines = [f"{a};{x};{k * a}" for a in angles]
        (folder / f"{name}.csv").write_text("\n".join((f"# {ABOVE[0]}", f"# {AXES[0]}", head, *lines)))
    form = invoke("import", folder, "--out", tmp_path / "out")
    assert ("attack/campaign.half_model" in left_open(form)) is asked, form.output


@pytest.mark.parametrize(
    "of_drift", ["balance centre 2.3 m aft of nose", "LCB, 2.31 m aft of the nose", "LCB of report T-7"]
)
def test_a_point_by_a_distance_in_one_file_and_by_its_name_in_another_is_open_for_all(
    tmp_path: Path, of_drift: str
) -> None:
    """Nr' about midships from moments about a point .3 m aft of it was outside its own U95."""
    folder = tmp_path / "series"
    folder.mkdir()
    for name, words, rows_of in (
        ("drift", f"Moments about {of_drift}", DRIFT),
        ("attack", "moments about midships", ATTACK),
        ("arm", "inertia subtracted", ARM),
    ):
        lines = [";".join(map(str, row)) for row in rows_of]
        (folder / f"{name}.csv").write_text(
            "\n".join((f"# {ABOVE[0]}", f"# {words}; x forward, y to starboard, z down", *lines))
        )
    form = invoke("import", folder, "--out", tmp_path / "out")
    points = [f"{name}/axes.reference_point" for name in ("arm", "attack", "drift")]
    assert [key for key in left_open(form) if key.endswith("reference_point")] == points, form.output


def test_a_sheet_at_no_drift_leaves_the_sign_of_drift_to_the_others(tmp_path: Path) -> None:
    turns = [(r, 1.6, 0.0, np.degrees(1.6 / r), 100.0 / r, -320.0 / r) for r in (8.0, 10.0, 14.0)]
    arm = (("R (m)", "U (m/s)", "Drift (deg)", "r (deg/s)", "Fy (N)", "Mz (Nm)"), *turns)
    book = workbook(tmp_path / "t.xlsx", Drift=rows(ABOVE, *DRIFT), Arm=rows(("inertia subtracted",), *arm))
    form = invoke("import", book, "--out", tmp_path / "out")
    assert left_open(form) == ["axes.frame", "axes.reference_point"], form.output
    assert "if y is starboard, else" in flat(form.output)
    typed = ("--set", "axes.frame=FRD", "--set", "axes.reference_point=midship", "--accept")
    done = invoke("import", book, "--out", tmp_path / "out", *typed)
    assert done.exit_code == 0, done.output
    drift, arm_rows = tables_of(tmp_path / "out").values()
    assert drift.motion["v"] * drift.forces["Y"] == pytest.approx(-abs(drift.motion["v"] * drift.forces["Y"]))
    assert arm_rows.motion["r"] == pytest.approx([1.6 / r for r in (8.0, 10.0, 14.0)])  # R beside r is U over it


def test_tables_of_a_folder_are_tables_of_a_campaign_and_halves_of_a_sweep_may_be_joined(tmp_path: Path) -> None:
    folder = tmp_path / "series"
    folder.mkdir()
    head = f"# {ABOVE[0]}\n# {AXES[0]}\nDrift (deg);Fy (N);Mz (Nm)\n"
    (folder / "drift_a.csv").write_text(head + "-12;-205;-250\n-8;-130.5;-180.2\n-4;-57.25;-92.5\n")
    (folder / "drift_b.csv").write_text(head + "4;57.5;92.0\n8;131.0;181.0\n12;205;251\n")
    (folder / "yaw.csv").write_text(
        "# inertia subtracted\nr (rad/s),Fy (N),Mz (Nm)\n0.1,5,-20\n0.2,10,-41\n0.3,15,-61\n"
    )
    (folder / "readme.txt").write_text("Tests of May\n")
    form = invoke("import", folder, "--out", tmp_path / "out")
    assert left_open(form) == [], form.output
    assert "readme.txt: no table by its content" in flat(form.output)
    assert "drift_a and drift_b have the same columns" in flat(form.output)
    for joined, names in (
        ((), ["drift_a.csv", "drift_b.csv", "yaw.csv"]),
        (("--option", "joined=yes"), ["drift.csv", "yaw.csv"]),
    ):
        done = invoke(*command_of(form.output), *joined, "--force")
        assert done.exit_code == 0, done.output
        assert list(tables_of(tmp_path / "out")) == names
        assert sum(len(t) for t in tables_of(tmp_path / "out").values()) == 9
    (folder / "drift_b.csv").write_text((folder / "drift_b.csv").read_text().replace("v = 2.0", "v = 1.0"))
    assert "conditions.speed" in " ".join(refused(invoke(*command_of(form.output), *joined, "--force")))


def test_records_over_time_are_no_tables(tmp_path: Path) -> None:
    folder = tmp_path / "records"
    folder.mkdir()
    for k in range(3):
        (folder / f"drift_{k}.csv").write_text(
            "Time (s),Fy (N),Mz (Nm)\n" + "".join(f"{t},{5 + t},{7 - t}\n" for t in range(9))
        )
    said = " ".join(refused(invoke("import", folder, "--out", tmp_path / "out")))
    assert "no angle, velocity, rate or radius" in said
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("names", "patterns"),
    [("drift_m12 drift_p4 drift_0 yaw_r0.1rads yaw_r0.2rads", "drift_{beta:deg:m=-,p=+} yaw_r{r:rad/s}rads"),
     ("b4 b8 bm4 r0.1 r0.2", "b{beta:deg:m=-} r{r:UNIT}"), ("d/b4 d/b8 t/r0.1 t/r0.2", "b{beta:deg} r{r:UNIT}"),
     ("drift_4 drift_8", "drift_{beta:deg}"), ("drift_4 drift_8 calm", ""), ("drift_4 drift_8 base_1", "")],
)  # fmt: skip
def test_patterns_of_groups_of_names(names: str, patterns: str) -> None:
    assert likely_patterns(names.split()) == tuple(patterns.split())


@pytest.mark.parametrize(("behind", "unit"), [("", "UNIT"), ("degs", "deg/s"), ("_deg_s", "deg/s"), ("dps", "deg/s"), ("rad_s", "rad/s"),
                                             ("_radar", "UNIT")])  # fmt: skip
def test_the_unit_of_a_rate_in_names_is_never_guessed(behind: str, unit: str) -> None:
    """Degrees a second as radians make every rotary derivative 57 times too small."""
    names = [f"yawrate{k}{behind}" for k in ("+1.7", "-1.7", "+0.9")]
    (pattern,) = likely_patterns(names)
    assert pattern == f"yawrate{{r:{unit}}}{behind}"
    if unit == "UNIT":
        assert "deg/s or rad/s for UNIT" in str(NoConditionError(names))


def test_runs_of_two_patterns_of_names_are_two_tables(stub: Path, tmp_path: Path) -> None:
    stated = {"conditions.density": 998.2, "axes.reference_point": [1.2, 0.0, 0.0]}
    for seed, k in enumerate((-8, -4, 4, 8)):
        write_run(tmp_path / "cfd" / f"b{k}", {"X": 13.0, "Y": 3.0 * k}, seed=seed, stated=stated)
        write_run(
            tmp_path / "cfd" / f"yaw_r0.{seed + 1}rads", {"X": 13.0, "Y": 2.0 + seed}, seed=seed + 9, stated=stated
        )
    form = invoke("import", tmp_path / "cfd", "--out", tmp_path / "out")
    assert "names" in flat(form.output)
    assert left_open(form) == ["axes.frame", "scaling.length", "conditions.speed"], form.output
    sets = [a for t in ("axes.frame=CFD", "scaling.length=4 LOA", "conditions.speed=2") for a in ("--set", t)]
    done = invoke("import", tmp_path / "cfd", "--out", tmp_path / "out", *sets, "--accept")
    assert done.exit_code == 0, done.output
    made = tables_of(tmp_path / "out")
    assert [(n, t.varies) for n, t in made.items()] == [("b.csv", ("v",)), ("yaw_r.csv", ("r",))]
    assert made["yaw_r.csv"].motion["r"].tolist() == [-0.1, -0.2, -0.3, -0.4]  # z up
    write_run(tmp_path / "cfd" / "calm", {"X": 13.0, "Y": 0.1}, stated=stated)
    patterns = ("--name", "b{beta:deg}", "--name", "yaw_r{r:rad/s}rads")
    assert "calm: found no of the patterns fits it" in " ".join(
        refused(invoke("import", tmp_path / "cfd", *patterns, *sets, "--accept"))
    )


def test_sheets_and_tables_are_chosen_in_the_form(book: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a terminal: a wrong choice leaves the form as it was."""
    answers = ["sheet=Drift, Nope", "sheet=Drift, Arm", "Arm/table.centre=port; Arm/Fy=-Y [N]", ""]
    done = answered(monkeypatch, answers, "import", book, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert 'no sheet "Nope"' in flat(done.output)
    assert done.output.count("Drift, Nope") == 1  # what was typed
    made = tables_of(tmp_path / "out")
    assert list(made) == ["Drift.csv", "Arm.csv"]
    assert (made["Arm.csv"].motion["r"][0], made["Arm.csv"].forces["Y"][0]) == (-0.2, -12.5)


def test_axes_of_one_table_of_several_are_refused() -> None:
    """They would rule the proposals of that table and never reach campaign.toml."""
    parts = [Part(name, RawTable(Path("t.csv"), ()), "csv", {}) for name in ("Drift", "Pitch")]
    require_parts(["Pitch/axes.reference_point", "Pitch/table.centre", "Pitch/conditions.speed", "axes.frame"], parts)
    with pytest.raises(InputError, match=r"share axes\.frame.*table\.centre") as caught:
        require_parts(["Pitch/axes.frame"], parts)
    assert "Say axes.frame without Pitch/" in str(caught.value)

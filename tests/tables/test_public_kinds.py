"""Kinds of files that thirty public repositories held: rows of units, names over a rule, an index, taps, balances. All remade here."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import coeflab as cf
from coeflab.cli import app
from coeflab.core.errors import InputError
from coeflab.fits.rows.straight_runs import _speeds
from coeflab.fits.statistics.data_gate import _by_setting
from coeflab.tables.column_company import proposals
from coeflab.tables.column_map import read_column_map
from coeflab.tables.column_names import named_as
from coeflab.tables.evidence import evidence
from coeflab.tables.form import Group
from coeflab.tables.imported import _table
from coeflab.tables.level_columns import slopes_by_idle_columns
from coeflab.tables.mapping import assigned, at_higher_mach, usable_rows, without_a_setting
from coeflab.tables.parts import read_parts
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.reading import importer_of, read_raw
from coeflab.tables.settings import Setting
from coeflab.tables.several_tables import form_together, interpreted_together

pytestmark = pytest.mark.usefixtures("in_a_shell")  # messages as a command prints them

ANGLES = (-4.0, -2.0, 0.0, 2.0, 4.0)
POLAR = [(a, 0.1 * a, 0.02 + 0.001 * a * a, -0.01 * a) for a in ANGLES]


def lines(*head: str, rows: list[str]) -> str:
    return "\n".join([*head, *rows]) + "\n"


def texts(path: Path, text: str) -> dict[str, str]:
    """What is proposed of the columns of a text, by their names."""
    path.write_text(text)
    raw = read_raw(path, importer_of(path))
    return {c.name: p.text for c, p in zip(raw.columns, proposals(raw), strict=True)}


def test_a_row_of_units_may_hold_slashes_numbers_and_nothing(tmp_path: Path) -> None:
    """A balance's file was no table: / for no unit, places of taps among the units, columns of tabs behind the last name."""
    rows = [
        f"{i}\t{a}\t{cd:.4f}\t{cl:.4f}\t{cm:.4f}\t21.5\t54.2\t0.{i}\t-0.{i}\t\t\t\t\t"
        for i, (a, cl, cd, cm) in enumerate(POLAR, 1)
    ]
    head = (
        "Run_nr\tAlpha\tCD\tCL\tCm\tT\tV\tCp_001\tCp_002\t\t\t\t\t",
        "/\tdegrees\t/\t/\t/\tdegr. C\tm/s\t100.00\t95.20\t\t\t\t\t",
    )
    found = texts(tmp_path / "corr.txt", lines(*head, rows=rows))
    assert found["Alpha"] == "alpha [deg]"
    assert found["Run_nr"] == "point"
    assert (found["T"], found["V"]) == ("ignore", "U [m/s]")
    assert found["CL"].startswith("lift [coefficient")
    raw = read_raw(tmp_path / "corr.txt", "table")
    assert [c.unit for c in raw.columns if c.name.startswith("Cp")] == ["", ""]
    blank = texts(tmp_path / "blanks.csv", lines(*head, rows=rows).replace("\t", " ").replace("degr. C", "degr.C"))
    assert blank["Alpha"] == "alpha [deg]"


def test_a_row_of_data_is_no_row_of_units(tmp_path: Path) -> None:
    """One word that is a unit by chance, or numbers beside one unit, make no units of data."""
    raw = texts(tmp_path / "t.csv", "alpha,CL,CD,m\n-2,-0.2,0.02,m\n0,0,0.02,m\n2,0.2,0.02,m\n")
    assert raw["alpha"] == "alpha [deg]"
    assert len(read_raw(tmp_path / "t.csv", "table")) == 3


def test_names_stand_over_the_strokes_of_a_rule(tmp_path: Path) -> None:
    """ "Top Xtr Bot Xtr" with single blanks is two columns, as the rule below says; without the rule it was refused."""
    rows = [f" {a:7.3f} {cl:8.4f} {cd:9.5f} {cm:8.4f}  0.8011  0.0271" for a, cl, cd, cm in POLAR]
    head = (
        "XFLR5 v6.09",
        "",
        "  alpha     CL        CD        Cm    Top Xtr Bot Xtr",
        " ------- -------- --------- -------- ------- -------",
    )
    found = texts(tmp_path / "polar.txt", lines(*head, rows=rows))
    assert list(found) == ["alpha", "CL", "CD", "Cm", "Top Xtr", "Bot Xtr"]
    assert found["Bot Xtr"] == "ignore"


def test_two_rows_of_names_are_both_read(tmp_path: Path) -> None:
    """Of long names and symbols only the symbols counted, so that D and C had no known name and Run none at all."""
    head = ("Run,Speed,Drift angle,Drag,Side force,Yaw moment", ",U,beta,D,C,Mz", "-,m/s,deg,kN,kN,kNm")
    path = tmp_path / "t.csv"
    found = texts(path, lines(*head, rows=[f"{i},2,{a},0.1,{-0.01 * a},{0.02 * a}" for i, a in enumerate(ANGLES)]))
    assert found == {
        "Run": "point", "Speed: U": "U [m/s]", "Drift angle: beta": "beta [deg]", "Drag: D": "drag [kN]", "Side force: C": "Y [kN]", "Yaw moment: Mz": "N [kNm]",
    }  # fmt: skip
    assert "lines 1 and 2: both name the columns" in read_raw(path, "table").remarks
    said = "# x forward, y starboard, z down; moments about 1.9 m aft of the bow; LOA 4.2 m; radius positive: centre to starboard; inertia subtracted"
    rows = [f"{i};{r};2.5;{r / 2};{r / 3}" for i, r in enumerate((-30, -20, -10, 10, 20, 30))]
    words = texts(path, lines(said, "Nr;Radius [m];V [m/s];Fy [N];Mz [Nm]", rows=rows))
    assert {"Fy", "Mz"} <= set(words), "a sentence of as many marks is no row of names"
    units = texts(path, lines("Yaw,Drag,Lift", "what,lb / N,lb / N", rows=[f"{a},1,{a}" for a in ANGLES]))
    assert "drag [N]" not in units.values(), "a row of units of two systems is no second name"


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("Angle of drift", "beta"), ("drift ang", "beta"), ("Lift coefficient", "lift"), ("Coefficient of drag", "drag"), ("lift_coeff", "lift"),
        ("Pitching moment coefficient", "M"), ("Force in Y", "Y"), ("rate of turn", "r"), ("alfa", "alpha"), ("Leeway", "beta"), ("Cln", "N"),
        ("Widerstandskraft Fw", "drag"), ("Auftriebsbeiwert CA", "lift"), ("Querkraft Fq", "Y"), ("Giermoment Mz", "N"), ("Lift CD", ""),
        ("Windgeschwindigkeit", "U"), ("Fd mesuré", "drag"), ("Force de traînée", "drag"), ("Coeficiente de sustentação", "lift"),
        ("ângulo de ataque", "alpha"), ("Arrastre", "drag"), ("momento de arfagem", "M"), ("Portanza", "lift"), ("攻角", "alpha"),
        ("阻力系数", "drag"), ("漂角", "beta"), ("转首力矩", "N"), ("迎え角", "alpha"), ("揚力係数", "lift"),
        ("yaw rate coefficient", ""), ("lift to drag", "ignore"), ("pressure coefficient", ""), ("moment of inertia", ""), ("run angle", ""),
    ],
)  # fmt: skip
def test_words_of_a_name_in_another_order_or_cut_short(name: str, meant: str) -> None:
    assert named_as(name) == meant


def test_a_coefficient_in_words_is_a_pure_number(tmp_path: Path) -> None:
    found = texts(
        tmp_path / "t.csv",
        lines("AoA (deg),Lift coefficient,Drag coefficient", rows=[f"{a},{cl},{cd}" for a, cl, cd, _ in POLAR]),
    )
    assert found["Lift coefficient"] == "lift [coefficient A=?]"


def test_an_index_counts_the_rows_and_is_asked_of_nobody(tmp_path: Path) -> None:
    """Frames that pandas wrote begin with a column without a name; joined ones count again."""
    rows = [f"{i % 3},{a},{cl},{cd}" for i, (a, cl, cd, _) in enumerate(POLAR)]
    assert texts(tmp_path / "a.csv", lines(",alpha,CL,CD", rows=rows))["column 1"] == "label"
    plain = [f"{i},{a},{cl},{cd}" for i, (a, cl, cd, _) in enumerate(POLAR)]
    assert texts(tmp_path / "b.csv", lines(",alpha,CL,CD", rows=plain))["column 1"] == "point"
    setting = [f"{10 * i},{a},{cl},{cd}" for i, (a, cl, cd, _) in enumerate(POLAR)]
    assert texts(tmp_path / "c.csv", lines(",alpha,CL,CD", rows=setting))["column 1"] == ""


@pytest.mark.parametrize("unit", ["noeuds", "nœuds", "Knoten", "nudos", "nodi"])
def test_a_speed_in_knots_of_other_languages_is_one(unit: str, tmp_path: Path) -> None:
    """A constant column of an unknown unit is ignored: 4 knots were then typed as 4 m/s."""
    found = texts(tmp_path / "k.csv", lines(f"beta (°),Vitesse ({unit}),Fy (N)", rows=[f"{a},4.0,{a}" for a in ANGLES]))
    assert found["Vitesse"] == "U [kn]"


def test_v_is_the_speed_of_a_resistance_test_and_fr_a_froude_number(tmp_path: Path) -> None:
    found = texts(
        tmp_path / "r.csv",
        lines(";V [knots];Fr [-];RT [kN];CF [10-3]", rows=[f"{i};{10 + i}.0;0.2{i};9{i}.3;1.7" for i in range(5)]),
    )
    assert (found["V"], found["Fr"], found["RT"]) == ("U [knots]", "ignore", "drag [kN]")
    sway = texts(tmp_path / "s.csv", lines("V [m/s],X [N],Y [N],N [N m]", rows=[f"{a},1,{a},{a}" for a in ANGLES]))
    assert sway["V"] == "", "beside Y and N it may be a sway velocity"


def test_coefficients_along_the_flow_leave_forces_of_the_body_out(tmp_path: Path) -> None:
    """A balance writes both: CL and CD by the tunnel, Fx ... Mz by its own axes, Ct and Cn turned by the angle."""
    head = "Alpha [deg],CL,CD,Cm,Cn,Ct,Fx [N],Fz [N],My [Nm],M"
    rows = [f"{a},{cl},{cd},{cm},{cl + 0.001},{0.01 - cd},{9 * cd},{9 * cl},{9 * cm},0.127" for a, cl, cd, cm in POLAR]
    found = texts(tmp_path / "t.csv", lines(head, rows=rows))
    assert {k for k, v in found.items() if v == "ignore"} == {"Cn", "Ct", "Fx", "Fz", "My", "M"}
    assert found["Cm"].startswith("M [coefficient")
    both = texts(
        tmp_path / "u.csv",
        lines("AOA,Lift,Drag,CL,CD", rows=[f"{a},{90 * cl},{90 * cd},{cl},{cd}" for a, cl, cd, _ in POLAR]),
    )
    assert (both["Lift"], both["Drag"]) == ("ignore", "ignore"), "a force without a unit beside its coefficient"


def test_a_workbook_is_known_by_its_content_whatever_its_name(tmp_path: Path) -> None:
    shutil.copy(next((Path(__file__).parent / "samples").rglob("*.xlsx")), tmp_path / "old.xls")
    assert read_parts(tmp_path / "old.xls", "", {})[0]


def test_rows_at_rest_are_left_out_with_a_word(tmp_path: Path) -> None:
    """One row of speed zero refused the whole table after the last question."""
    (tmp_path / "t.csv").write_text(
        "beta [deg],U [m/s],X [N],Y [N]\n0,0,0.01,0\n" + "".join(f"{a},2,-1,{-a}\n" for a in ANGLES)
    )
    raw = read_raw(tmp_path / "t.csv", "table")
    columns = assigned(
        raw,
        {n: read_column_map(t) for n, t in (("beta", "beta [deg]"), ("U", "U [m/s]"), ("X", "X [N]"), ("Y", "Y [N]"))},
    )
    assert list(without_a_setting(raw, columns)) == ["left out, no U above zero: line 2"]
    written, _ = _table(raw, columns, {"scaling.length": Setting(2.0, ""), "conditions.speed": Setting(2.0, "")}, {})
    assert written.decode().count("\nline ") == len(ANGLES)


def test_many_close_speeds_are_no_single_one() -> None:
    """1,400 speeds a hundredth of a knot apart counted as one, and gave no X0'."""
    assert _speeds(np.linspace(0.01, 14.0, 1400)) == 700
    assert [_speeds(np.array(some)) for some in ([1.0, 1.0004, 2.0, 2.0004], [3.0, 1.0, 2.0], [2.0])] == [2, 3, 1]


def of_levels(name: str, values: np.ndarray, labels: tuple[str, ...] = ()) -> list[str]:
    """Warnings about a column beside a sweep whose slope doubles in its second half."""
    alpha = np.tile(np.array(ANGLES), 2)
    slope = np.repeat([1.0, 2.0], len(ANGLES))
    raw = RawTable(
        Path("t.csv"),
        (RawColumn("alpha", "deg", alpha), RawColumn("Z", "N", -slope * alpha), RawColumn(name, "", values, labels)),
    )
    columns = assigned(
        raw,
        {
            "alpha": read_column_map("alpha"),
            "Z": read_column_map("Z"),
            name: read_column_map("label" if labels else "ignore"),
        },
    )
    return [e.text for e in slopes_by_idle_columns(raw, columns)]


def test_levels_have_no_width_and_may_be_words() -> None:
    """A result that falls in two heaps is no setting; the name of a body in each row is one."""
    assert len(of_levels("Re", np.repeat([1e5, 2e5], 5))) == 1
    assert of_levels("Cp", np.concatenate([np.linspace(0.1, 0.14, 5), np.linspace(0.9, 0.95, 5)])) == []
    (text,) = of_levels("body", np.full(10, np.nan), ("n0012",) * 5 + ("n0021",) * 5)
    assert '--map "body=label [n0012]"' in text


@pytest.mark.parametrize(
    ("text", "found", "warned"),
    [
        ("alpha,beta,CL,CD\n-4,2,-0.4,0.1\n0,2,0,0.1\n4,2,0.4,0.1\n", "drag without side at beta", False),
        ("alpha,CL,slope\n-4,-0.4,0.1\n0,0,0.12\n4,0.4,0.11\n", "lift without drag", True),
        ("alpha,CL,CD\n4,0.4,0.1\n", "one row", True),
    ],
)
def test_what_gives_no_slope_is_said_with_the_first_form(tmp_path: Path, text: str, found: str, warned: bool) -> None:
    (tmp_path / "t.csv").write_text(text)
    parts, _ = read_parts(tmp_path / "t.csv", "", {})
    (one,) = interpreted_together(parts, {}, {})
    assert any(found in w.found for w in one.complaints) is not warned
    assert any(found in e.text for e in one.shows) is warned


def test_the_error_of_an_unknown_column_waits_for_it_and_is_not_asked(tmp_path: Path) -> None:
    raw = RawTable(
        tmp_path, tuple(RawColumn(n, u, np.array(ANGLES)) for n, u in (("alpha", "deg"), ("Q7", "N"), ("se_Q7", "N")))
    )
    parts = read_parts_of(raw)
    shown = {line.key: line for line in form_together(parts, interpreted_together(parts, {}, {}), {})}
    assert shown["Q7"].value == ""
    assert shown["se_Q7"].group > shown["Q7"].group
    said = interpreted_together(parts, {"Q7": read_column_map("Y [N]")}, {})[0]
    assert str(said.mapping["se_Q7"]) == "se_Y [N]"


def read_parts_of(raw: RawTable) -> list:  # type: ignore[type-arg]
    from coeflab.tables.parts import Part

    return [Part("", raw, "table", {})]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("# Force coefficients\n# dragDir : (1 0 0)\n# Time Cd Cl\n0 1 2\n1 1 2\n", "one OpenFOAM case"),
        ("a\tb\tc\n1\t2\t3\t4\n2\t2\t3\t4\n3\t2\t3\t4\n", "3 names over rows of 4 cells"),
    ],
)
def test_a_text_that_is_no_table_says_why(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "t.dat").write_text(text)
    with pytest.raises(InputError) as why:
        importer_of(tmp_path / "t.dat")
    assert words in f"{why.value.found} {why.value.advice}"


def test_forces_in_units_of_nobody_are_named(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text(
        "Yaw,Bal Drag,Bal Lift\nDegrees / Degrees,lb / Pa,lb / Pa\n"
        + "".join(f"{a},1.{i},0.{i}\n" for i, a in enumerate(ANGLES))
    )
    parts, _ = read_parts(tmp_path / "t.csv", "", {})
    (found,) = interpreted_together(parts, {}, {})
    assert "Bal Drag [lb / Pa]" in found.complaints[0].found
    assert "Bal Drag=drag [lbf]" in found.complaints[0].advice


def test_an_import_names_the_body_that_others_of_its_hull_take(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coeflab.cli.import_._first_slopes", lambda folder: False)
    (tmp_path / "t.csv").write_text("beta [deg],X [N],Y [N],N [N m]\n" + "".join(f"{a},-1,{-a},{-a}\n" for a in ANGLES))
    typed = [
        "import", str(tmp_path / "t.csv"), "--out", str(tmp_path / "mine"), "--accept",
        *(word for key in ("axes.frame=FRD", "axes.reference_point=nose", "scaling.length=2", "conditions.density=1000", "conditions.speed=2", "axes.beta=+") for word in ("--set", key)),
    ]  # fmt: skip
    assert "--set campaign.body=mine" in " ".join(CliRunner().invoke(app, typed).output.split())
    assert "Body:" not in CliRunner().invoke(app, [*typed, "--set", "campaign.body=hull", "--force"]).output


def open_keys(path: Path, text: str) -> list[str]:
    """What the first form of a text asks."""
    path.write_text(text)
    parts, _ = read_parts(path, "", {})
    return [
        line.key for line in form_together(parts, interpreted_together(parts, {}, {}), {}) if line.group is Group.OPEN
    ]


@pytest.mark.parametrize(("system", "drag", "moment"), [("SI", 1.0, 1.0), ("US", 4.4482216152605, 1.3558179483314)])
def test_one_answer_says_which_of_two_units_in_a_head_the_numbers_are_in(
    tmp_path: Path, system: str, drag: float, moment: float
) -> None:
    rows = [f"{a:g},{2 * a:g},{1 + 0.01 * a * a:g},{-a:g}" for a in ANGLES]
    head = ("Alpha,Bal Lift,Bal Drag,Pitch moment", "Degrees / Degrees,lb / N,lb/N,ft-lb / N-m")
    asked = open_keys(tmp_path / "t.csv", lines(*head, rows=rows))
    assert asked.count("columns.units") == 1
    assert len(asked) <= 6
    raw = read_raw(tmp_path / "t.csv", "table")
    said = {
        c.name: read_column_map(p.text)
        for c, p in zip(raw.columns, proposals(raw, {"columns.units": system}), strict=True)
    }
    found = {c.meaning.name: c.factor for c in assigned(raw, said)}
    assert found["drag"] == pytest.approx(drag)
    assert found["M"] == pytest.approx(moment)
    assert sorted(found) == ["M", "alpha", "drag", "lift"]


@pytest.mark.parametrize(
    ("head", "rows", "blank"),
    [
        (
            "alpha,CL,CD,CM,note",
            ["-4,-.4,.02,.04", "-2,-.2,.02,.02", "0,0,.02,0", "2,.2,.02,-.02,bad", "4,.4,.02,-.04,bad"],
            "note",
        ),
        ("alpha;CL;CD;CM", ["-4;-.4;.02;.04", "-2;-.2;.02", "0;0;.02;0", "2;.2;.02;-.02", "4;.4;.02"], "CM"),
    ],
)
def test_rows_that_end_before_their_last_names_are_blank_there(
    tmp_path: Path, head: str, rows: list[str], blank: str
) -> None:
    (tmp_path / "t.csv").write_text(lines(head, rows=rows))
    raw = read_raw(tmp_path / "t.csv", importer_of(tmp_path / "t.csv"))
    assert list(raw.column("alpha").values) == list(ANGLES)
    assert list(raw.column("CL").values) == [-0.4, -0.2, 0.0, 0.2, 0.4]
    short = [
        i
        for i, row in enumerate(rows)
        if len(row.replace(";", ",").split(",")) < len(head.replace(";", ",").split(","))
    ]
    assert [i for i in short if not np.isfinite(raw.column(blank).values[i])] == short
    assert any("no cells under the last names" in remark for remark in raw.remarks)


def test_an_index_in_brackets_is_no_unit(tmp_path: Path) -> None:
    rows = [f"{i},{a:g},{5 * a:g}" for i, a in enumerate(ANGLES)]
    found = texts(tmp_path / "t.csv", lines("i,beta[i],Y[i]", rows=rows))
    assert found == {"i": "point", "beta": "beta [deg]", "Y": "Y [?]"}


def test_units_in_small_letters_are_those_of_what_they_stand_behind(tmp_path: Path) -> None:
    rows = [f"{i},{a:g},2,{5 * a:g},{2 + 0.1 * a * a:g},{a:g},30" for i, a in enumerate(ANGLES)]
    found = texts(tmp_path / "t.csv", lines("run_id,aoa_deg,speed_ms,lift_n,drag_n,pitch_moment_nm,gap_nm", rows=rows))
    assert list(found.values())[:6] == ["point", "alpha [deg]", "U [m/s]", "lift [N]", "drag [N]", "M [N*m]"]
    assert not found.get("gap", found.get("gap_nm", "?")).startswith("M")


def test_a_polar_of_xfoil_is_in_degrees_and_has_no_settings_but_alpha(tmp_path: Path) -> None:
    head = (" Calculated polar for: FOIL", "", " xtrf = 1.0 (top) 1.0 (bottom)", "",
            "  alpha    CL   CD   CDp    CM   Top_Xtr  Bot_Xtr  Top_Itr  Bot_Itr", " ------ ---- ---- ------ ------ -------- -------- -------- --------")  # fmt: skip
    rows = [f" {a:.3f} {0.11 * a:.4f} 0.0047 {-0.0002 + 1e-5 * (i // 3):.5f} {-0.001 * a:.4f} 0.2 0.4 {70 + i:.4f} {130 - i:.4f}"
            for i, a in enumerate(np.linspace(0.1, 2.8, 12))]  # fmt: skip
    found = texts(tmp_path / "polar.txt", lines(*head, rows=rows))
    assert found["alpha"] == "alpha [deg]"
    assert {found[n] for n in ("CDp", "Top_Xtr", "Bot_Xtr", "Top_Itr", "Bot_Itr")} == {"ignore"}
    parts, _ = read_parts(tmp_path / "polar.txt", "", {})
    assert not [e.text for e in interpreted_together(parts, {}, {})[0].shows if "rows of several" in e.text]


def test_a_normal_force_beside_lift_and_drag_is_no_yaw_moment(tmp_path: Path) -> None:
    turn = np.radians(ANGLES)
    lift, drag = np.array([p[1] for p in POLAR]), np.array([p[2] for p in POLAR])
    normal, axial = lift * np.cos(turn) + drag * np.sin(turn), drag * np.cos(turn) - lift * np.sin(turn)
    columns = np.column_stack([ANGLES, lift, drag, normal, axial, 0.03 * lift])
    rows = [",".join(f"{x:.5f}" for x in row) for row in columns]
    found = texts(tmp_path / "t.csv", lines("Alpha,CL,CD,CN,CA total,CN_other", rows=rows))
    assert (found["CN"], found["CA total"]) == ("ignore", "ignore")
    short = [",".join(f"{x:.5f}" for x in row[[0, 1, 2, 5]]) for row in columns]
    assert texts(tmp_path / "u.csv", lines("Alpha,CL,CD,CN", rows=short))["CN"] == ""
    sideways = [f"{row},0.1" for row in short]
    assert texts(tmp_path / "v.csv", lines("Alpha,CL,CD,Cn,CY", rows=sideways))["Cn"].startswith("N [coefficient")
    both = [",".join(f"{x:.5f}" for x in row[[0, 3, 4]]) for row in columns]
    assert set(texts(tmp_path / "w.csv", lines("alpha,Cn,Ct", rows=both)).values()) == {"alpha [deg]", ""}


def test_places_beside_lift_and_drag_are_no_forces(tmp_path: Path) -> None:
    rows = [f"{a:g},{0.1 * a:g},.02,{i},{0.5 * i:g}" for i, a in enumerate(ANGLES)]
    found = texts(tmp_path / "t.csv", lines("alpha,CL,CD,X,Y", rows=rows))
    assert (found["X"], found["Y"]) == ("ignore", "ignore")
    assert texts(tmp_path / "u.csv", lines("beta,CL,CD,X,Y", rows=rows))["Y"] == "Y [?]"


def test_what_gives_no_force_of_a_body_is_refused_by_its_reason(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("J,Thrust,Ct,Cp\n.2,30,.1,.05\n.4,20,.07,.04\n.6,10,.03,.02\n")
    wave = [
        f"{t:.2f},20,{np.sin(t):.5f},{np.cos(1.3 * t):.5f},{-3 + np.sin(t):.5f},{np.cos(t):.5f}"
        for t in np.arange(0, 2, 0.02)
    ]
    (tmp_path / "f.csv").write_text(lines("time,airspeed,p,q,Fx,Fz", rows=wave))
    for name, words in (("p.csv", "a propeller alone"), ("f.csv", "a record over time: p and q")):
        parts, _ = read_parts(tmp_path / name, "", {})
        assert words in interpreted_together(parts, {}, {})[0].complaints[0].found
    steady = [f"{60 * i},20,{r:g},0,{-3 - r:g},{r:g}" for i, r in enumerate(np.repeat(np.linspace(-1, 1, 6), 10))]
    (tmp_path / "s.csv").write_text(lines("time,airspeed,p,q,Fx,Fz", rows=steady))
    parts, _ = read_parts(tmp_path / "s.csv", "", {})
    assert not interpreted_together(parts, {}, {})[0].complaints


def test_zeros_of_drag_turn_lift_and_a_blank_column_is_nothing(tmp_path: Path) -> None:
    rows = [f"{a:g},{0.1 * a:g},0,{-0.01 * a:g}," for a in ANGLES]
    found = texts(tmp_path / "t.csv", lines("alpha,CL,CD,CM,CS", rows=rows))
    assert found["CD"].startswith("drag [coefficient")
    assert found["CS"] == "ignore"


def test_at_most_six_questions_of_a_file_with_many_strange_columns(tmp_path: Path) -> None:
    """A turbine's 35 columns; a side force that may be of the body; numbers without a unit."""
    strange = [f"q{k}x" for k in range(14)]
    rows = [
        ",".join([f"{i}", "1.0", f"{0.3 + 0.01 * i:.3f}", *(f"{(i % 3) + k}" for k in range(14))]) for i in range(9)
    ]
    assert (
        len(open_keys(tmp_path / "t.csv", lines(",".join(["run", "mean_tow_speed", "mean_cd", *strange]), rows=rows)))
        <= 6
    )
    kite = [f"7.4,{b:g},.7,{0.08 + 0.0005 * b * b:g},{0.015 * b:g},{0.01 * b:g}" for b in ANGLES]
    asked = open_keys(tmp_path / "k.csv", lines("alpha,beta,CL,CD,CS,CMz", rows=kite))
    assert "CS" in asked
    assert "axes.beta" not in asked
    assert len(asked) <= 6


def test_rows_of_a_dense_sweep_are_settings_of_their_own() -> None:
    """99 rows a quarter of a degree apart were one setting, and the data gate ended in an error of numpy."""
    x = np.radians(np.arange(-12.75, 12.0, 0.25))
    assert len(_by_setting(x, x[None])[0]) > 30
    assert len(_by_setting(np.array([-1.0, -0.99, 0.0, 0.01, 1.0]), np.zeros((1, 5)))[0]) == 3


def test_a_standard_error_goes_with_its_force(tmp_path: Path) -> None:
    """The command that `inspect` printed for SU2 runs with CMx = 0 throughout ended in "se_K without K"."""
    found = texts(
        tmp_path / "t.csv", lines("alpha [deg],Z [N],se_Z [N],se_M [N*m]", rows=["-4,8,1,1", "0,0,1,1", "4,-8,1,1"])
    )
    assert (found["se_Z"], found["se_M"]) == ("se_Z [N]", "ignore")


def polar_over_mach(machs: tuple[float, ...]) -> list[str]:
    """Synthetic: lift that grows with the Mach number, at five angles each."""
    return [f"{m},{a},{0.1 * a * (1 + m)},{0.02 + m / 10}" for m in machs for a in ANGLES]


@pytest.mark.parametrize(
    ("machs", "rows"), [((0.1, 0.25, 0.8, 2.0), 10), ((0.5, 0.8, 2.0), 5), ((0.1, 0.2), 10), ((0.8,), 5)]
)
def test_rows_of_several_mach_numbers_are_not_pooled(tmp_path: Path, machs: tuple[float, ...], rows: int) -> None:
    """Mach .01 to 25 gave one X0' beside a warning about single rows: those up to .3 count, else those of the lowest."""
    (tmp_path / "t.csv").write_text(lines("Mach,alpha,CL,CD", rows=polar_over_mach(machs)))
    raw = read_raw(tmp_path / "t.csv", "table")
    columns = (
        ("Mach", "ignore"),
        ("alpha", "alpha [deg]"),
        ("CL", "lift [coefficient A=1 m^2]"),
        ("CD", "drag [coefficient A=1 m^2]"),
    )
    known = assigned(raw, {n: read_column_map(t) for n, t in columns})
    assert len(usable_rows(raw, known)) == rows
    said = list(without_a_setting(raw, known))
    assert [s.startswith("left out, above the lowest Mach: line") for s in said] == [True] * (rows < len(raw))
    shown = [e.text for e in slopes_by_idle_columns(raw, known)]
    assert [s.startswith("rows above the lowest Mach are left out") for s in shown if "Mach" in s] == [True] * (
        rows < len(raw)
    )
    labelled = assigned(raw, {n: read_column_map("label" if n == "Mach" else t) for n, t in columns})
    assert len(usable_rows(raw, labelled)) == len(raw), "whoever names it takes all"


def test_an_import_says_which_mach_numbers_its_rows_have(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text(lines("Mach,alpha,CL,CD", rows=polar_over_mach((0.2, 0.9))))
    given = ("coefficients.area=1 m^2", "axes.frame=FRD", "scaling.length=1 m")
    found = CliRunner().invoke(
        app, ["import", str(tmp_path / "t.csv"), "--out", str(tmp_path / "o"), *(w for g in given for w in ("--set", g)), "--accept"]
    )  # fmt: skip
    assert found.exit_code == 0, found.output
    assert "Rows left out, above the lowest Mach: line 7" in found.output
    text = (tmp_path / "o" / "campaign.toml").read_text()
    assert text.count("above the lowest Mach") == 2, (
        "beside the table, and in how_obtained, which travels with each number"
    )
    slope = next(line.split()[2] for line in found.output.splitlines() if line.split()[:1] == ["Zw'"])
    assert float(slope) == pytest.approx(-(0.1 * 1.2 * 180.0 / np.pi + 0.04), rel=0.01)
    assert "rows of several Mach" not in found.output


def test_bodies_named_in_a_column_are_no_single_body(tmp_path: Path) -> None:
    """Four airfoils in one sweep gave one slope without a word: same slopes, lift at rest apart, and more names than levels of a setting."""
    names = [f"n{k:04d}" for k in range(12)]
    rows = [f"{n},{a},{0.1 * a + 0.3 * (k % 3)},0.02" for k, n in enumerate(names) for a in ANGLES]
    (tmp_path / "t.csv").write_text(lines("file,alpha,CL,CD", rows=rows))
    raw = read_raw(tmp_path / "t.csv", "table")
    by = {
        "file": "label",
        "alpha": "alpha [deg]",
        "CL": "lift [coefficient A=1 m^2]",
        "CD": "drag [coefficient A=1 m^2]",
    }
    said = [e.text for e in slopes_by_idle_columns(raw, assigned(raw, {n: read_column_map(t) for n, t in by.items()}))]
    assert len(said) == 1
    assert "the offset of lift over alpha differs between file n0000" in said[0]
    one = [f"{n},{a},{0.1 * a + 0.3},0.02" for n in names for a in ANGLES]
    (tmp_path / "u.csv").write_text(lines("file,alpha,CL,CD", rows=one))
    raw = read_raw(tmp_path / "u.csv", "table")
    assert not list(slopes_by_idle_columns(raw, assigned(raw, {n: read_column_map(t) for n, t in by.items()})))


def test_strange_columns_of_a_public_table_are_no_questions(tmp_path: Path) -> None:
    """Sources side by side, moments about a dozen points, limits of transition: eleven, five and seven questions."""
    grids = [f"{a},{cl},{cd},{0.9 * cl},{cd},{0.8 * cl},{cd}" for a, cl, cd, _ in POLAR]
    found = texts(tmp_path / "a.csv", lines("alpha_deg,Cl_fine,Cd_fine,Cl_coarse,Cd_coarse,Cl_exp,Cd_exp", rows=grids))
    assert {n for n, t in found.items() if t == "ignore"} == {"Cl_fine", "Cd_fine", "Cl_coarse", "Cd_coarse"}
    points = [f"{a},{cl},{cd},{-0.1 * cl},{0.1 * cl},{0.3 * cl},{0.5 * cl}" for a, cl, cd, _ in POLAR]
    found = texts(tmp_path / "b.csv", lines("AoA (deg),Cl,Cd,cm_x0.00,cm_x0.16,cm_x0.32,cm_x0.48", rows=points))
    assert [t for n, t in found.items() if n.startswith("cm_x")] == ["ignore"] * 4
    found = texts(
        tmp_path / "c.csv",
        lines(
            "Alpha,Cd,Cl,XTr1,XTr2,Cpmn", rows=[f"{a},{cd},{cl},{0.1 - a / 99},{a / 99},{a}" for a, cl, cd, _ in POLAR]
        ),
    )
    assert [found[n] for n in ("XTr1", "XTr2", "Cpmn")] == ["ignore"] * 3


def test_m_beside_a_reynolds_number_is_a_mach_number(tmp_path: Path) -> None:
    rows = [f"{a},{cl},{cd},{5 + k},{1000 * k}" for k, (a, cl, cd, _) in enumerate(POLAR, 1)]
    assert texts(tmp_path / "a.csv", lines("alpha,Cl,Cd,M,Re", rows=rows))["M"] == "ignore"
    assert texts(tmp_path / "b.csv", lines("alpha,Cl,Cd,M,time", rows=rows))["M"] == "M [?]"


def test_a_vortex_lattice_polar_asks_of_the_test_alone(tmp_path: Path) -> None:
    """Synthetic polar in the columns of a vortex lattice code: names within fixed columns of which the last has none, zeros of rounding
    across the plane, moments twice, forces along the body beside CL and CD. It was no table, then six questions and a refusal.
    """
    names = ("Beta", "Mach", "AoA", "Re/1e6", "CL", "CDo", "CDi", "CDtot", "CS", "L/D", "E", "CFx", "CFy", "CFz", "CMx", "CMy", "CMz", "CMl", "CMm", "CMn")  # fmt: skip
    rows = []
    for a in range(-10, 11, 2):
        s, c = np.sin(np.radians(a)), np.cos(np.radians(a))
        cl, cdi, cm = 4.0 * s, 0.8 * s * s, -1.5 * s
        tiny = 1e-8 * (1 + a % 3)
        force = (cl, 0.01, cdi, cdi + 0.01, tiny, 10.0 * s, 0.9, cdi * c - cl * s, tiny, cl * c + (cdi + 0.01) * s)
        rows.append((0.0, 0.0, float(a), 10.0, *force, -tiny, cm, tiny, tiny, cm, -tiny, 45.0))
    text = ["".join(f"{n:^14}" for n in names), *("".join(f"{v:14.6E}" for v in row) for row in rows)]
    (path := tmp_path / "wing.polar").write_text("\n".join(text) + "\n")
    (other := tmp_path / "left.polar").write_text("\n".join(["".join(f"{n:<14}" for n in names), *text[1:]]) + "\n")
    assert importer_of(path) == "table"
    found = texts(path, path.read_text())
    assert {n for n, t in found.items() if t != "ignore"} == {"Beta", "AoA", "CL", "CDtot", "CMy"}
    set_ = ["coefficients.area=1", "axes.frame=CFD", "axes.reference_point=0 from nose", "scaling.length=1 m L"]
    asked = CliRunner().invoke(app, ["import", str(path), "--out", str(tmp_path / "out")])
    assert "4 open" in asked.output
    command = [
        "import",
        str(path),
        "--out",
        str(tmp_path / "out"),
        *(w for s in set_ for w in ("--set", s)),
        "--accept",
    ]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.output
    fitted = cf.fit(tmp_path / "out")
    assert fitted["Zw'"].value == pytest.approx(-4.01, rel=1e-3)
    assert fitted["Mw'"].value == pytest.approx(-1.5, rel=1e-3)
    with pytest.raises(InputError, match="20 names over rows of 21 cells"):
        read_raw(other, "table")


def test_a_motion_sideways_keeps_small_forces_across(tmp_path: Path) -> None:
    rows = [f"{b},0.0,1.0,{1e-5 * b},{2e-6 * b}" for b in ANGLES]
    found = texts(tmp_path / "t.csv", lines("beta (deg),CL,CD,CY,Cn", rows=rows))
    assert found["CY"].startswith("Y [coefficient")


def test_v_over_a_resistance_alone_is_the_speed(tmp_path: Path) -> None:
    """Of a sphere in a tunnel, in French: v was a sway velocity, and the force had no known name."""
    rows = [f"{v};{0.0106 * v * v:.6f}".replace(".", ",") for v in (0.7, 1.6, 2.6, 3.5, 4.5)]
    found = texts(tmp_path / "t.csv", lines("v(m/s);Fd mesuré (N)", rows=rows))
    assert found == {"v": "U [m/s]", "Fd mesuré": "drag [N]"}
    sway = [f"{v};{-v};{0.1 * v}".replace(".", ",") for v in (0.7, 1.6, 2.6, 3.5, 4.5)]
    assert texts(tmp_path / "s.csv", lines("v(m/s);Fy (N);Fd (N)", rows=sway))["v"] == "v [m/s]"


def test_names_of_all_columns_in_one_option(tmp_path: Path) -> None:
    """Tables without names asked of each column; a polar with fewer names than numbers was no table."""
    rows = [f"{a},{cl:.4f},{cd:.4f},{cm:.4f},0.0,0.31" for a, cl, cd, cm in POLAR]
    (bare := tmp_path / "bare.csv").write_text(lines(rows=rows))
    inspected = CliRunner().invoke(app, ["inspect", str(bare)])
    assert "6 open" in inspected.output
    assert "--option 'columns=?'" in inspected.output
    refused = CliRunner().invoke(app, ["import", str(bare), "--out", str(tmp_path / "no")])
    assert "columns=alpha [deg], CL, CD, -" in str(refused.exception)
    set_ = ["coefficients.area=1", "axes.frame=FRD", "axes.reference_point=-0.25 from nose", "scaling.length=1"]
    command = ["import", str(bare), "--option", "columns=alpha [deg], CL, CD, Cm, -", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, [*command, *(w for s in set_ for w in ("--set", s)), "--accept"])
    assert done.exit_code == 0, done.output
    assert cf.fit(tmp_path / "out")["Zw'"].value == pytest.approx(-(0.1 * 180.0 / np.pi + 0.02), rel=2e-3)
    with pytest.raises(InputError, match="7 names over rows of 6 cells"):
        read_raw(bare, "table", {"columns": "a, b, c, d, e, f, g"})
    above = (" Calculated polar for: own section", "", "alpha,CL,CD,CDp,Cm")
    polar = [f"{a},{cl:.4f},{cd:.4f},0.01,{cm:.4f},0.0,0.31" for a, cl, cd, cm in POLAR]
    found = texts(tmp_path / "polar.csv", lines(*above, rows=polar))
    assert (found["alpha"], found["Cm"], found["column 7"]) == ("alpha [deg]", "M [coefficient A=? L=?]", "ignore")


def test_a_remark_beside_some_rows_needs_no_name(tmp_path: Path) -> None:
    rows = [f"{a}\t{cl:.4f}\t{cd:.4f}\t" + "wake off the rake" * (a == 4.0) for a, cl, cd, _ in POLAR]
    found = texts(tmp_path / "t.txt", lines("Alpha\tCL\tCD", "degrees\t/\t/", rows=rows))
    assert found["Alpha"] == "alpha [deg]"
    assert found["column 4"] == "label"


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_sign_of_an_angle_shows_near_the_origin(tmp_path: Path, sign: float) -> None:
    """Over half a turn lift falls, and its trend says nothing or the contrary."""
    angles = np.arange(-180.0, 181.0, 5.0)
    lift = np.where(np.abs(angles) <= 15.0, 0.1 * angles, -0.012 * angles) * sign
    rows = [f"{a},{cl:.4f},{0.02 + np.sin(np.radians(a)) ** 2:.4f}" for a, cl in zip(angles, lift)]
    (path := tmp_path / "t.csv").write_text(lines("alpha,CL,CD", rows=rows))
    raw = read_raw(path, "table")
    columns = assigned(raw, {c.name: read_column_map(m) for c, m in zip(
        raw.columns, ("alpha [deg]", "lift' [-]", "drag' [-]"), strict=True)})  # fmt: skip
    shown = [e.value for e in evidence(columns) if e.key == "axes.alpha"]
    assert shown == [f"w = {'+' if sign > 0 else '-'}U sin(alpha)"]


def test_lift_at_one_incidence_leaves_a_drift_sweep(tmp_path: Path) -> None:
    rows = [f"{b},0.6,{0.1 + 0.001 * b * b:.4f},{-0.02 * b:.4f}" for b in ANGLES]
    found = texts(tmp_path / "t.csv", lines("beta,CL,CD,CS", rows=rows))
    assert (found["CL"], found["CD"]) == ("ignore", "drag [coefficient A=?]")


def test_mach_numbers_in_small_steps_are_not_one_level() -> None:
    """A sweep from 0.01 to 25 in steps of 0.01 was one level, and all of it entered the slope."""
    mach = np.arange(0.01, 25.0, 0.01)
    columns = (RawColumn("Mach", "", mach), RawColumn("alpha", "deg", np.tile(2.0, len(mach))))
    raw = RawTable(Path("t.csv"), columns, 1, np.arange(2, len(mach) + 2))
    name, higher = at_higher_mach(raw, [])
    assert name == "Mach"
    assert mach[~higher].max() == pytest.approx(0.3)


def test_the_one_angle_beside_lift_is_that_of_attack(tmp_path: Path) -> None:
    rows = [f"{a},{5.0 * cl:.4f},{5.0 * cd:.4f},{cl / cd:.3f}" for a, cl, cd, _ in POLAR]
    found = texts(tmp_path / "t.csv", lines("angle_deg,lift_N,drag_N,lift_to_drag", rows=rows))
    assert found == {"angle": "alpha [deg]", "lift": "lift [N]", "drag": "drag [N]", "lift_to_drag": "ignore"}
    beside = texts(
        tmp_path / "s.csv",
        lines("angle_deg,beta_deg,lift_N,drag_N", rows=[r.replace(",", ",3,", 1).rpartition(",")[0] for r in rows]),
    )
    assert beside["angle"] == ""
    for across in ("side_N", "r [rad/s]"):
        head = f"angle_deg,lift_N,drag_N,{across}"
        assert texts(tmp_path / "d.csv", lines(head, rows=[r.rpartition(",")[0] + ",3" for r in rows]))["angle"] == ""


def test_a_lift_that_a_drift_sweep_leaves_out_stands_among_what_accepting_confirms(tmp_path: Path) -> None:
    """It may be the side force of a keel: the reason was lost where the proposal was accepted."""
    (path := tmp_path / "t.csv").write_text(
        lines("beta [deg],CL,CD,Cn", rows=[f"{a},0.3,{cd},{cm}" for a, _, cd, cm in POLAR])
    )
    raw = read_raw(path, importer_of(path))
    lift = next(o for c, o in zip(raw.columns, proposals(raw), strict=True) if c.name == "CL")
    parts, _ = read_parts(path, "", {})
    founds = interpreted_together(parts, {}, {})
    shown = next(line for line in form_together(parts, founds, {}) if line.key == "CL")
    assert (lift.text, shown.group) == ("ignore", Group.GRAVE)


def test_a_force_that_a_person_names_leaves_no_other_force(tmp_path: Path) -> None:
    """Z and M of the hull went with a word where X of it was named."""
    rows = [f"{a},{-cd},{-cl},{cl / 9:.4f},{-cl / 5:.4f}" for a, cl, cd, _ in POLAR]
    head = "alpha [deg],Fx_hull [N],Fz_hull [N],My_hull [N m],Fx_sail [N]"
    (path := tmp_path / "t.csv").write_text(lines(head, rows=rows))
    parts, _ = read_parts(path, "", {})
    (found,) = interpreted_together(parts, {"Fx_hull": read_column_map("X [N]")}, {})
    offers = {c.name: o.text for c, o in zip(parts[0].raw.columns, found.proposals, strict=True)}
    assert {n: offers[n] for n in ("Fz_hull", "My_hull", "Fx_sail")} == {
        "Fz_hull": "",
        "My_hull": "",
        "Fx_sail": "ignore",
    }


def test_a_dash_leaves_the_first_column_too(tmp_path: Path) -> None:
    rows = [f"{7.3 + (i * 7) % 5},{a},{cl},{cd}" for i, (a, cl, cd, _) in enumerate(POLAR)]
    (path := tmp_path / "t.csv").write_text("\n".join(rows) + "\n")
    parts, _ = read_parts(path, "", {"columns": "-, alpha [deg], CL, CD"})
    (found,) = interpreted_together(parts, {}, {})
    assert found.proposals[0].text == "ignore"


def test_forces_that_a_person_names_leave_those_of_other_sources(tmp_path: Path) -> None:
    """The refusal promised it, and asked of seventeen columns all the same."""
    rows = [f"{a},{cl:.4f},{cl + 0.01:.4f},{cd:.4f},{cd + 0.001:.4f},{0.01 + a / 1e4:.5f}" for a, cl, cd, _ in POLAR]
    (path := tmp_path / "t.csv").write_text(lines("AoA_deg,CL_fine,CL_panel,CD_fine,CD_panel,Delta_CL", rows=rows))
    command = ["import", str(path), "--out", str(tmp_path / "out"), "--accept"]
    for given in ("CL_fine=lift [coefficient A=1 m^2]", "CD_fine=drag [coefficient A=1 m^2]"):
        command += ["--map", given]
    done = CliRunner().invoke(app, [*command, "--set", "axes.frame=FRD", "--set", "scaling.length=1"])
    assert done.exit_code == 0, done.output
    assert cf.fit(tmp_path / "out")["Zw'"].value == pytest.approx(-(0.1 * 180.0 / np.pi + 0.02), rel=2e-3)


def test_a_column_of_forces_without_a_number_is_named(tmp_path: Path) -> None:
    (path := tmp_path / "t.csv").write_text(lines("alpha [deg],CL,CD", rows=[f"{a},nan,nan" for a in ANGLES]))
    refused = CliRunner().invoke(app, ["import", str(path), "--out", str(tmp_path / "out")])
    assert "no number in the whole column" in str(refused.exception)

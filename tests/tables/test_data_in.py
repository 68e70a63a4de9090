"""What a file of other people becomes: proposals, few questions, runs of final values, turned tables, blocks, records over time."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from coeflab.core.axes import parse_axes
from coeflab.core.errors import InputError
from coeflab.tables.column_company import proposals
from coeflab.tables.column_map import read_column_map
from coeflab.tables.imported import _table
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.mapping import assigned
from coeflab.tables.parts import read_parts
from coeflab.tables.proposals import proposed
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.settings import Setting
from coeflab.tables.several_tables import complaints_of, interpreted_together, questions_together
from coeflab.tables.vocabulary import vocabulary, words_of

pytestmark = pytest.mark.usefixtures("in_a_shell")  # messages as a command prints them

SAMPLES = Path(__file__).parent / "samples"
ANGLES = np.array([-8.0, -4.0, 0.0, 4.0, 8.0])


def column(name: str, unit: str = "", values: np.ndarray = ANGLES) -> RawColumn:
    return RawColumn(name, unit, values)


def table(*columns: RawColumn) -> RawTable:
    return RawTable(Path("x.csv"), columns)


def open_keys(path: Path) -> list[str]:
    parts, _ = read_parts(path, "", {})
    founds = interpreted_together(parts, {}, {})
    assert not complaints_of(founds)
    columns = [
        c.name
        for f in founds
        for c, o in f.open
        if not o.whole and "coefficient" not in o.text and not o.text.endswith("?]")
    ]
    return [*columns, *(key for key, q in questions_together(parts, founds) if q.open)]


@pytest.mark.parametrize(
    ("name", "unit", "text"),
    [
        ("Seitenruderwinkel", "deg", "dr [deg]"), ("Höhenruderwinkel", "deg", "ds [deg]"), ("Tiefenruderwinkel", "°", "ds [deg]"),
        ("delta", "deg", "dr [deg]"), ("δ", "°", "dr [deg]"), ("CXtot", "", "X [coefficient A=?]"), ("CMl", "", "K [coefficient A=? L=?]"),
        ("CSF", "-", "Y [coefficient A=?]"), ("Fn", "N", "Z [N]"), ("Fn", "", ""), ("CS", "", ""), ("yaw", "deg", "beta [deg]"),
        ("yaw", "N m", "N [N m]"), ("Fx_total", "N", "X [N]"), ("P5: side-op", "N", "Y [N]"), ("cw", "", "drag [coefficient A=?]"),
    ],
)  # fmt: skip
def test_a_name_and_its_unit_say_what_a_column_is(name: str, unit: str, text: str) -> None:
    assert proposed(column(name, unit)).text == text


def test_every_meaning_of_the_vocabulary_is_one() -> None:
    words = vocabulary()
    for word, meaning in {**words.columns, **words.flow, **words.coefficients}.items():
        assert proposed(column(word, "")) is not None
        assert re.fullmatch(r"\w+", meaning)


def test_words_of_ones_own_come_first_and_end_with_the_command(tmp_path: Path) -> None:
    file = tmp_path / "my.toml"
    file.write_text('[columns]\nY = ["Kraft quer zum Wagen", "cs"]\n[units]\nkraft = "N"\n')
    with words_of(file):
        assert proposed(column("Kraft quer zum Wagen", "Kraft")).text == "Y [N]"
        assert proposed(column("CS", "N")).text == "Y [N]"
    assert proposed(column("Kraft quer zum Wagen", "N")).text == ""
    assert proposed(column("CS", "N")).text == "side [N]"


@pytest.mark.parametrize(
    "text", ['[columns]\nfoo = "a"\n', "[bar]\n", '[several]\ncs = "side foo"\n', "[columns]\nY = 3\n", "columns = 1\n"]
)
def test_wrong_words_are_refused_with_their_line(tmp_path: Path, text: str) -> None:
    file = tmp_path / "my.toml"
    file.write_text(text)
    with pytest.raises(InputError) as why, words_of(file):
        pass
    assert why.value.line


def test_m_beside_coefficients_is_a_mach_number_and_n_a_count() -> None:
    mach, count = column("M", "", np.linspace(0.1, 0.11, 5)), column("N", "", np.full(5, 61.0))
    beside = (column("alpha"), column("CL"), column("CD"), column("Cm"))
    texts = [p.text for p in proposals(table(mach, *beside, count))]
    assert texts[0] == texts[-1] == "ignore"
    assert texts[4].startswith("M [coefficient")
    assert next(p.text for p in proposals(table(column("M", "N m"), *beside[:3]))) == "M [N m]"


@pytest.mark.parametrize(
    ("axes", "signs"),
    [("FRD", ("-", "-")), ("FLU", ("-", "")), ("CFD", ("", "")), ("aft,port,down", ("", "-"))],
)
def test_ca_is_positive_aft_and_cn_up_whatever_the_axes(axes: str, signs: tuple[str, str]) -> None:
    """By the axes alone, never by the values: a sign taken from one of the two turned Mw' with it."""
    given = table(column("alpha"), column("CA", "", np.full(5, 0.3)), column("CN"), column("Cm"))
    texts = [p.text for p in proposals(given, None, parse_axes(axes.split(",") if "," in axes else axes))]
    assert texts[1:3] == [f"{signs[0]}X [coefficient A=?]", f"{signs[1]}Z [coefficient A=?]"]
    assert [p.text for p in proposals(given)][1:3] == ["", ""]


def test_zeros_ask_no_unit_and_no_sign(tmp_path: Path) -> None:
    file = tmp_path / "zeros.csv"
    file.write_text("beta,alpha (deg),X (N),Y,Z (N)\n" + "".join(f"0,{a},-3,0,{-a}\n" for a in (-4, 0, 4)))
    assert "columns.units" not in open_keys(file)
    assert "axes.beta" not in open_keys(file)


def test_what_knows_no_force_is_refused_before_any_question(tmp_path: Path) -> None:
    file = tmp_path / "other.csv"
    file.write_text("time,temp,height\n1,2,3\n2,4,5\n3,4,7\n")
    parts, _ = read_parts(file, "", {})
    assert complaints_of(interpreted_together(parts, {}, {}))


def test_legends_above_name_columns() -> None:
    raw = IMPORTERS.load("table").raw(SAMPLES / "table/design_points.csv", {})
    assert [(c.name, c.unit) for c in raw.columns[1:]] == [
        ("P3: drift", "degree"), ("P5: side-op", "N"), ("P6: axial-op", "N"), ("P9: yaw-op", "N m"),
    ]  # fmt: skip
    assert [p.text for p in proposals(raw)[1:]] == ["beta [deg]", "Y [N]", "X [N]", "N [N m]"]


@pytest.mark.parametrize(
    "path", sorted(p for kind in ("json", "table") for p in (SAMPLES / kind).glob("*") if p.name in (
        "points.json", "columns.json", "named.json", "conditions_in_columns.txt", "blocks.csv", "design_points.csv")),
    ids=lambda p: p.name,
)  # fmt: skip
def test_at_most_six_questions(path: Path) -> None:
    assert len(open_keys(path)) <= 6


def test_points_in_json_are_rows(tmp_path: Path) -> None:
    raw = IMPORTERS.load("json").raw(SAMPLES / "json/points.json", {})
    assert [c.name for c in raw.columns] == ["beta", "X", "Y", "N"]
    assert raw.column("beta").unit == "deg"
    assert raw.column("Y").values.tolist() == [8.1, 0.0, -8.1]
    assert raw.stated["conditions.speed"].value == 1.5
    raw = IMPORTERS.load("json").raw(SAMPLES / "json/named.json", {})
    assert raw.column("moment z").values.tolist() == [2.0, 0.0, -2.0]
    assert raw.column("name").texts == (
        "b-4",
        "b0",
        "b4",
    )
    raw = IMPORTERS.load("json").raw(SAMPLES / "json/columns.json", {})
    assert raw.column("Fz").unit == "N"
    assert len(raw) == 5
    bad = tmp_path / "bad.json"
    bad.write_text(json.dumps({"a": 1}))
    assert not IMPORTERS.load("json").recognises(bad)


def test_a_breakdown_of_su2_is_one_run() -> None:
    run = IMPORTERS.load("reports").run(SAMPLES / "reports/forces_breakdown.dat", {})
    assert run.is_final
    assert run.history.meaning("Z").values[0] == 0.0530166
    assert run.history.meaning("M").values[0] == -0.0084
    assert run.conditions["w"].value == pytest.approx(-0.139513)
    assert run.history.stated["coefficients.area"].value == 0.9


def test_walls_of_cfx_are_pressure_and_viscous_together() -> None:
    run = IMPORTERS.load("reports").run(SAMPLES / "reports/walls.out", {})
    assert run.history.meaning("X").values[0] == pytest.approx(10.3)
    assert run.history.meaning("M").values[0] == pytest.approx(-5.2)


def test_a_value_that_is_no_number_is_refused_with_its_line(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    file.write_text("Report Name,Value,Unit\nDrag,high,N\n")
    with pytest.raises(InputError) as why:
        IMPORTERS.load("reports").run(file, {})
    assert why.value.line == 2


def test_forces_and_moments_of_one_condition_are_one_row(tmp_path: Path) -> None:
    for a in (-6, -3, 0, 3, 6):
        (tmp_path / f"force_a{a}.csv").write_text(f"Report Name,Value,Unit\nDrag,{10 + a * a / 9},N\nLift,{4 * a},N\n")
        (tmp_path / f"moment_a{a}.csv").write_text(f"Report Name,Value,Unit\nPitch Moment,{-2 * a},N-m\n")
    parts, _ = read_parts(tmp_path, "", {})
    assert len(parts) == 1
    assert len(parts[0].raw) == 5
    at = dict(zip(parts[0].raw.meaning("alpha").values, parts[0].raw.column("Pitch Moment").values, strict=True))
    assert at == {a: -2.0 * a for a in (-6, -3, 0, 3, 6)}
    (tmp_path / "moment_a6.csv").unlink()
    assert len(read_parts(tmp_path, "", {})[0]) == 2


def test_conditions_in_columns_become_rows() -> None:
    parts, _ = read_parts(SAMPLES / "table/conditions_in_columns.txt", "", {})
    raw = parts[0].raw
    assert [p.text for p in proposals(raw)] == ["point", "U [m/s]", "beta [deg]", "X [N]", "Y [N]", "N [Nm]"]
    assert raw.columns[4].values.tolist() == [8.1, 0.0, -8.1, -17.0]


def test_titles_of_blocks_are_columns() -> None:
    raw = IMPORTERS.load("table").raw(SAMPLES / "table/blocks.csv", {})
    assert raw.column("U").values.tolist() == [1.0] * 3 + [2.0] * 3
    assert raw.column("block").texts[3] == "speed 2 m/s"


def test_a_row_of_units_may_hold_one_that_nobody_knows(tmp_path: Path) -> None:
    file = tmp_path / "raw.txt"
    file.write_text("Run_nr\tTime\tAlpha\tFx\tFz\tRho\n/\tH:M:S\tdegrees\tN\tN\tkg/m^3\n" + "".join(
        f"{i}\t10:{i}:00\t{a}\t1.0\t{-a}\t1.19\n" for i, a in enumerate((-4, -2, 0, 2, 4), 1)))  # fmt: skip
    raw = IMPORTERS.load("table").raw(file, {})
    assert [c.unit for c in raw.columns[2:]] == ["degrees", "N", "N", "kg/m^3"]


def test_many_strangers_are_of_no_use_and_a_position_is_no_force() -> None:
    known = (column("alpha", "deg"), column("Fz", "N"))
    free = np.array([3.0, 1.0, 4.0, 1.5, 2.0])
    strange = (column(n, "", free) for n in ("foo", "bar", "baz"))
    texts = [p.text for p in proposals(table(*known, *strange, column("Y", "mm")))]
    assert texts == ["alpha [deg]", "Z [N]", "ignore", "ignore", "ignore", "ignore"]
    assert [p.text for p in proposals(table(*known, column("foo"), column("bar")))][2:] == ["", ""]


def test_what_stopped_the_inflow_is_said_where_no_condition_is_known() -> None:
    from coeflab.tables.collect import OF_MOTION

    assert OF_MOTION.search("0/U: no boundary states a velocity of the inflow that is read")
    assert not OF_MOTION.search("rhoInf 1, so forces are those of a fluid of 1 kg/m^3")


def test_a_stranger_that_may_be_a_setting_is_asked_however_many_there_are() -> None:
    """A rudder of three levels, or one coupled to the drift, bends a slope where it is left out."""
    beta = np.repeat([-8.0, -4.0, 0.0, 4.0, 8.0], 3)
    levels, coupled, free = (
        np.tile([-10.0, 0.0, 10.0], 5),
        0.5 * beta + 0.01 * np.arange(15) % 0.03,
        np.sin(7.0 * np.arange(15.0)),
    )
    names = ("beta", "Y", "RW", "qq", "zz")
    units, values = ("deg", "N", "", "", ""), (beta, -3.0 * beta, levels, coupled, free)
    found = proposals(table(*(column(*c) for c in zip(names, units, values, strict=True))))
    assert [n for n, p in zip(names, found, strict=True) if p.text == "ignore"] == ["zz"]


def test_a_velocity_of_zeros_beside_angles_says_nothing(tmp_path: Path) -> None:
    rows = "".join(f"{a},0,2,{-3 * a}\n" for a in (-4, 0, 4))
    (tmp_path / "zeros.csv").write_text(f"beta [deg],w,U [m/s],Y [N]\n{rows}")
    parts, _ = read_parts(tmp_path / "zeros.csv", "", {})
    (found,) = interpreted_together(parts, {}, {})
    assert not found.complaints
    assert [p.text for p in found.proposals] == ["beta [deg]", "ignore", "U [m/s]", "Y [N]"]
    both = table(column("beta", "deg"), column("w", "m/s"), column("Y", "N"))
    assert proposals(both)[1].text == "w [m/s]"


def test_a_number_of_froude_beside_forces_is_no_normal_force() -> None:
    given = table(column("Fn", "", np.full(5, 0.2)), column("beta", "deg"), column("Y", "N"))
    assert proposals(given)[0].text == "ignore"
    assert proposals(table(column("Fn", "", ANGLES), column("beta", "deg"), column("Y", "N")))[0].text == ""


@pytest.mark.parametrize("unit", ["N s^2/m^2", "N s²/m²", "N*s^2/m^2", "Ns2/m2", "N/(m/s)^2", "N s^2 m^-2"])
def test_a_force_over_the_square_of_the_speed(unit: str) -> None:
    said = read_column_map(f"Y [{unit}]")
    assert (said.per_speed, said.unit, str(said)) == (True, "N", "Y [N s^2/m^2]")
    assert proposed(column("Fy", unit)).text == "Y [N s^2/m^2]"
    assert read_column_map(f"N [{unit.replace('N', 'N m', 1)}]").unit == "N m"


def test_a_table_by_the_square_of_the_speed_is_in_newton(tmp_path: Path) -> None:
    """Y = K U^2: 3 N s^2/m^2 at 2 m/s are 12 N; in place and as imported."""
    (tmp_path / "raw.txt").write_text("beta;U;Fy\n(deg);(m/s);(N s^2/m^2)\n-4;2;3\n0;1;0\n4;2;-3\n")
    raw = IMPORTERS.load("table").raw(tmp_path / "raw.txt", {"delimiter": "semicolon"})
    mapping = {"beta": "beta [deg]", "U": "U [m/s]", "Fy": "Y [N s^2/m^2]"}
    known = assigned(raw, {name: read_column_map(text) for name, text in mapping.items()})
    settings = {"conditions.speed": Setting("1 m/s", ""), "scaling.length": Setting("4 m", "")}
    written = _table(raw, known, settings, {})[0].decode().split("\n")
    assert written[1:3] == ["point,beta [deg],U [m/s],Y [N],digit_Y [N]", "line 3,-4.0,2.0,12.0,4"]


def test_a_name_that_reads_as_no_number_is_a_name(tmp_path: Path) -> None:
    """Na, the yaw moment of a balance, is no "n.a."; a head may hold a few numbers where names stand over numbers."""
    (tmp_path / "na.txt").write_text(
        "Incidence\tX\tZ\tMa\tNa\n" + "".join(f"{a}\t-1\t{-a}\t{2 * a}\t0\n" for a in (-4, 0, 4))
    )
    raw = IMPORTERS.load("table").raw(tmp_path / "na.txt", {})
    assert [c.name for c in raw.columns] == ["Incidence", "X", "Z", "Ma", "Na"]
    rows = "".join(f"{a},{a / 10},0.01,{-a},0,0,0,0.25\n" for a in (-4, -2, 0, 2, 4))
    (tmp_path / "polar.csv").write_text(f"alpha,CL,CD,Cm,0,0,XCp,Bot\n{rows}")
    raw = IMPORTERS.load("table").raw(tmp_path / "polar.csv", {})
    assert [c.name for c in raw.columns[:5]] == ["alpha", "CL", "CD", "Cm", "0"]
    assert len(raw) == 5


def test_a_row_of_labels_and_numbers_is_no_head(tmp_path: Path) -> None:
    (tmp_path / "runs.csv").write_text("run,model,alpha,CL\nA1,hull,-4,0.2\nA2,hull,0,0\nA3,hull,4,-0.2\n")
    raw = IMPORTERS.load("table").raw(tmp_path / "runs.csv", {})
    assert [c.name for c in raw.columns] == ["run", "model", "alpha", "CL"]
    assert len(raw) == 3


def test_of_a_force_and_its_coefficient_the_first_is_taken_and_other_axes_are_no_settings() -> None:
    """Balances write coefficients and forces, in two sets of axes, beside the raw angle: one question for each quantity is enough."""
    names = ("Incidence", "Inc_brut", "Cx", "Cxa", "Cz", "Cza", "X", "Xa", "Z", "Za", "Qo")
    values = (
        ANGLES,
        1.01 * ANGLES,
        -0.02 + 0.0 * ANGLES,
        ANGLES**2,
        ANGLES,
        1.1 * ANGLES,
        ANGLES**3,
        ANGLES,
        ANGLES,
        ANGLES,
        np.ones(5),
    )
    found = proposals(table(*(column(n, "", v) for n, v in zip(names, values, strict=True))))
    texts = {n: p.text for n, p in zip(names, found, strict=True)}
    assert {n for n, text in texts.items() if text == "ignore"} == {
        "Inc_brut",
        "Cxa",
        "Cza",
        "X",
        "Xa",
        "Z",
        "Za",
        "Qo",
    }
    assert texts["Cz"] == "Z [coefficient A=?]"


@pytest.mark.parametrize(
    ("head", "words"),
    [
        ("AoA,CL_SST,CD_SST,CL_XFOIL,CD_XFOIL", "CL_SST"),
        ("cells,foil,far,Cl,Cd,res", "no angle"),
    ],
)
def test_what_one_table_cannot_say_is_refused_with_the_names_to_give(tmp_path: Path, head: str, words: str) -> None:
    width = head.count(",") + 1
    (tmp_path / "t.csv").write_text(
        head + "\n" + "".join(",".join(f"{i + k / 7:.3f}" for k in range(width)) + "\n" for i in range(4))
    )
    parts, _ = read_parts(tmp_path / "t.csv", "", {})
    (found,) = interpreted_together(parts, {}, {})
    (why,) = found.complaints
    assert words in why.found
    assert "--map" in why.advice


def test_a_speed_without_a_unit_and_forces_of_zeros_ask_no_conditions(tmp_path: Path) -> None:
    rows = "".join(f"{a},20,{a / 10},0.02,0\n" for a in (-4, -2, 0, 2, 4))
    (tmp_path / "t.csv").write_text(f"alpha,Vitesse,Cz,Cx,Y\n{rows}")
    keys = open_keys(tmp_path / "t.csv")
    assert {"conditions.speed", "conditions.density"}.isdisjoint(keys)
    assert "columns.units" in keys


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("alpha,Cl\n-4,-0.4\n0,0\n4,0.4\n", "lift without drag"),
        ("alpha,Vitesse,Fx (N),Fz (N)\n-4,0,1,-0.4\n0,0,1,0\n4,0,1,0.4\n", "a speed of zero throughout"),
    ],
)
def test_what_no_answer_mends_is_refused_before_any_question(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "t.csv").write_text(text)
    parts, _ = read_parts(tmp_path / "t.csv", "", {})
    (found,) = interpreted_together(parts, {}, {})
    assert words in [why.found for why in found.complaints]

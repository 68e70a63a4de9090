"""Tables of any delimited text: every dialect reads back equal, what has two readings is refused, every row left out is said."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from coeflab.core.errors import InputError
from coeflab.tables.dialect import Marks, name_and_unit
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.importers.table import raw, recognises
from coeflab.tables.raw_table import RawTable
from coeflab.tables.text_dialect import AmbiguousError
from tests.conftest import PEAK_KILOBYTES

SAMPLES = Path(__file__).parent / "samples"
BETA = [-8.0, -4.0, 0.0, 4.0, 8.0]
FY = [14.312, 6.521, 0.043, -6.498, -14.287]
KILO = [14312.5, 6521.25, 43.0, -6498.75, -14287.5]


def read(tmp_path: Path, text: str | bytes, **options: object) -> RawTable:
    path = tmp_path / "a.txt"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return raw(path, options)


def refusal(tmp_path: Path, text: str | bytes, **options: object) -> str:
    with pytest.raises(InputError) as why:
        read(tmp_path, text, **options)
    assert why.value.file == tmp_path / "a.txt"
    return str(why.value)


SAID = {
    "blanks_comment_header.dat": ("Fy", "", FY, {"delimiter": "blanks", "comments": "#", "header": "line 3"}),
    "comma_units_in_brackets.csv": ("Fy", "N", FY, {"delimiter": "comma", "units": "in the header"}),
    "cp1252_degree.csv": ("Kraft Fy", "N", FY, {"encoding": "cp1252", "decimal mark": "comma"}),
    "blocks.csv": ("Y", "N", [8, 0, -8, 32, 0, -32], {"header": "line 2"}),
    "conditions_in_columns.txt": ("B", "", [1, 0, -3, 0, 0], {"delimiter": "tab", "header": "line 1"}),
    "cut_in_mid_write.csv": ("Fy", "", [0.2 * i for i in range(6)], {"header": "line 1"}),
    "design_points.csv": ("P5: side-op", "N", [40, 21.84, 10.11, 0, -10.11, -21.84, -40], {"units": "in a legend above the names"}),
    "fortran_d_exponents.out": ("column 3", "", FY, {"header": "none", "delimiter": "blanks"}),
    "groups_over_names.csv": ("Y", "N", FY, {"units": "row under the names (line 3)", "delimiter": "semicolon"}),
    "lone_carriage_returns.txt": ("Fy", "", FY, {"line ends": "CR", "comments": "%"}),
    "nan_cells.csv": ("Fy", "N", [14.3, np.nan, np.nan, -6.5, np.nan], {"units": "after an underscore"}),
    "no_header_mixed_ends.csv": ("column 3", "", FY, {"line ends": "CRLF and LF", "header": "none"}),
    "pipe_preamble.txt": ("Fy", "N", FY, {"delimiter": "pipe", "header": "line 5"}),
    "quoted_decimal_commas.csv": ("Fy", "N", FY, {"delimiter": "comma", "decimal mark": "comma"}),
    "semicolon_decimal_comma_unit_row.csv": ("Fy", "N", FY, {"encoding": "utf-8 with byte-order mark", "line ends": "CRLF"}),
    "tab_parentheses_utf16.txt": ("Fy", "N", FY, {"encoding": "utf-16 with byte-order mark", "delimiter": "tab"}),
    "thousands_points.csv": ("Fy", "N", KILO, {"thousands mark": "point", "decimal mark": "comma"}),
    "thousands_thin_space.txt": ("Fy", "N", KILO, {"thousands mark": "blank", "decimal mark": "point"}),
    "two_runs_concatenated.txt": ("Fy", "N", [0, 0.2, 0.4, 0.6, 0.8, 0, 0.3, 0.6, 0.9, 1.2], {"delimiter": "blanks"}),
}  # fmt: skip


@pytest.mark.parametrize("name", sorted(p.name for p in (SAMPLES / "table").iterdir()))
def test_every_sample_dialect_is_read_and_said(name: str) -> None:
    column, unit, values, said = SAID[name]
    table = raw(SAMPLES / "table" / name, {})
    assert table.column(column).unit == unit
    np.testing.assert_allclose(table.column(column).values, values, rtol=1e-12)
    assert said.items() <= table.dialect.items()


@pytest.mark.parametrize(
    "path", [p for f in ("table", "excel") for p in sorted((SAMPLES / f).iterdir())], ids=lambda p: p.name
)
def test_one_importer_knows_a_sample(path: Path) -> None:
    known = [name for name in IMPORTERS.names() if IMPORTERS.load(name).recognises(path)]
    assert known == [path.parent.name]


OF_SOLVERS = {
    "house": "beta [deg],Y [N]\n1,2\n2,3\n",
    "OpenFOAM": "# Force coefficients\n# Time Cd Cl\n0 1 2\n1 2 3\n",
    "OpenFOAM of": "# Time          \tforces(pressure viscous) moment(pressure viscous)\n0 ((1 2 3) (1 2 3))\n",
    "OpenFOAM com": "# Force\n# CofR : (0 0 0)\n# Time total_x total_y total_z\n0 1 2 3\n1 2 3 4\n",
    "STAR-CCM+": '"Iteration","Drag Monitor: Drag (N)"\n1,2.0\n2,3.0\n',
    "Fluent": '"drag-rfile"\n"Iteration" "drag"\n("Iteration" "drag")\n1 2.0\n2 3.0\n',
    "SU2": '"Time_Iter","Outer_Iter","Inner_Iter",    "rms[Rho]"   \n0,0,0,-3.1\n0,0,1,-3.2\n',
    "TOML": '[campaign]\nspeed = 3.0\nlength = 4.0\nmass = 2.0\n',
    "prose": "Nothing but words here.\nAnd here.\n",
    "NUL": "a,b\n1,\x002\n",
    "empty": "",
}  # fmt: skip


@pytest.mark.parametrize("name", OF_SOLVERS)
def test_what_others_read_is_left_to_them(tmp_path: Path, name: str) -> None:
    path = tmp_path / "a.txt"
    path.write_text(OF_SOLVERS[name], encoding="utf-8")
    assert not recognises(path)
    assert not recognises(tmp_path)
    assert not recognises(tmp_path / "nowhere")


@pytest.mark.parametrize(
    ("text", "readings", "decided"),
    [
        ("Fy\n1,234\n2,345\n", ("1.234", "1234.0"), [({"decimal": "comma"}, 1.234), ({"thousands": "comma"}, 1234.0)]),
        ("a;b\n1,234;2\n2,345;3\n", ("decimal = comma", "decimal = point"), [({"decimal": "point"}, 1234.0)]),
        ("a;b\n1.234;2\n2.345;3\n", ("1.234", "1234.0"), [({"decimal": "point"}, 1.234), ({"thousands": "point"}, 1234.0)]),
        ("1,5\n2,5\n", ("two numbers", "a decimal comma"), [({"delimiter": "comma"}, 1.0), ({"delimiter": "none", "decimal": "comma"}, 1.5)]),
        ("a b\tc\n1 200\t5\n2 300\t6\n", ("blanks between thousands",), [({"delimiter": "blanks"}, 1.0)]),
    ],
)  # fmt: skip
def test_two_readings_are_refused_with_the_option_that_decides(
    tmp_path: Path, text: str, readings: tuple[str, ...], decided: list[tuple[dict[str, object], float]]
) -> None:
    why = refusal(tmp_path, text)
    assert all(reading in why for reading in readings)
    assert "Say the option" in why
    assert recognises(tmp_path / "a.txt")
    for options, value in decided:
        assert read(tmp_path, text, **options).columns[0].values[0] == value


def test_one_number_elsewhere_decides(tmp_path: Path) -> None:
    """0,123 has no thousands, 1,234.5 and 1,234,567 have: the whole file has one reading then."""
    assert list(read(tmp_path, "a;b\n1,234;0,5\n2,345;3\n").column("a").values) == [1.234, 2.345]
    assert list(read(tmp_path, "a;b\n1,234;0.5\n2,345;3\n").column("a").values) == [1234.0, 2345.0]
    assert list(read(tmp_path, "a;b\n1,234;1,234,567\n2,345;3\n").column("a").values) == [1234.0, 2345.0]
    assert list(read(tmp_path, "a b\n1.234 2\n2.345 3\n").column("a").values) == [1.234, 2.345]


def test_what_is_left_out_is_said_with_its_line(tmp_path: Path) -> None:
    table = read(tmp_path, "a,b,c\n1,2,3\n1,2\n4,5,6\na,b,c\n7,8,9\n7,8")
    assert list(table.lines) == [2, 4, 6]
    assert table.remarks == (
        "line 3: left out, 2 of 3 cells",
        "line 7: left out, 2 of 3 cells, and the line has no end: the file is cut there",
        "the header is repeated in line 5; left out",
    )
    first = read(tmp_path, "a b c\n1 2\n3 4 5\n6 7 8\n")
    assert (list(first.column("c").values), first.remarks) == ([5.0, 8.0], ("line 2: left out, 2 of 3 cells",))
    cut = read(tmp_path, "a b\n0.123 1.234\n0.234 2.345\n0.345 3.456\n0.456 4.567\n0.567 5.6")
    assert len(cut) == 4
    assert "line 6: left out, the last number is not whole" in cut.remarks[0]
    whole = read(tmp_path, "a b\n0.123 1.234\n0.234 2.345\n0.345 3.456\n0.456 4.567\n0.567 5.6\n")
    assert len(whole) == 5


def test_words_for_no_number_are_counted(tmp_path: Path) -> None:
    table = read(tmp_path, "run,Y\nA,1\nB,nan\nC,\nD,-\nE,n.a.\nF,#DIV/0!\nG,1e999\nH,nan\nI,2\n")
    assert np.isnan(table.column("Y").values).sum() == 7
    assert table.column("Y").texts == ()
    assert table.column("run").texts == tuple("ABCDEFGHI")
    (remark,) = table.remarks
    assert remark.startswith('column "Y": 7 cells are without a number')
    assert all(word in remark for word in ('"nan" 2 times', "blank", '"n.a."', '"#DIV/0!"', "first in line 3"))


LETTERS = ("A", "K", "m", "s", "N", "g", "t", "h", "V", "W")  # of runs; units too


@given(
    first=st.tuples(
        st.sampled_from(LETTERS), st.sampled_from(LETTERS), st.sampled_from(["1", "1e-3", "0.5", "-", "", "nan"])
    ),
    places=st.permutations([0, 1, 2]),
    delimiter=st.sampled_from([",", ";", "\t"]),
    many=st.integers(2, 5),
)
@settings(max_examples=80, deadline=None)
def test_a_first_run_by_the_letter_of_a_unit_does_not_vanish(
    tmp_path_factory: pytest.TempPathFactory, first: tuple[str, ...], places: list[int], delimiter: str, many: int
) -> None:
    """A row without any number is left out as any other, and said; a row with one is data."""
    rows = [("run", "kind", "Y"), first, *((f"r{k}", "hull", str(2 * k)) for k in range(many))]
    path = tmp_path_factory.mktemp("letters") / "a.txt"
    path.write_text("".join(delimiter.join(row[k] for k in places) + "\n" for row in rows))
    table = raw(path, {})
    assert sorted(c.name for c in table.columns) == ["Y", "kind", "run"]
    assert {c.unit for c in table.columns} == {""}
    empty = first[2] in ("-", "")
    assert len(table) == many + 1 - empty
    assert any("line 2: left out, no number" in r for r in table.remarks) == empty


@pytest.mark.parametrize(
    ("row", "units"),
    [
        ("-;deg;1e-3;1", ("-", "deg", "1e-3", "1")), ("-;-;1e-3;1e-3", ("-", "-", "1e-3", "1e-3")), (";[1];[1];[1]", ("", "1", "1", "1")),
        ("-;%;%;%", ("-", "%", "%", "%")), ("-;-;-;-", ("-",) * 4), ("D;1;1e-3;1", None), ("-;1;1;1e-3", None), ("-;0;1e-3;-", None),
    ],
)  # fmt: skip
def test_what_makes_a_row_of_units(tmp_path: Path, row: str, units: tuple[str, ...] | None) -> None:
    """Numbers alone are data, whatever letter of a run is beside them; where numbers are taken for units it is said."""
    table = read(tmp_path, f"Case;Drift;CY;CN\n{row}\nD1;-4;1.5;0.8\nD2;4;-1.5;-0.8\n")
    assert len(table) == (2 if units else 3)
    assert tuple(c.unit for c in table.columns) == (units or ("",) * 4)
    assert any("taken for the units" in r for r in table.remarks) == bool(units and "1" in row and "[" not in row)


@pytest.mark.parametrize("row", ["1.1,1", "11,1", "1.1,11", "1e-3,-", "-,1e-3", "1,1e-3"])
@pytest.mark.parametrize("above", ["", "# Test 7\n"])
def test_numbers_under_names_with_units_are_data(tmp_path: Path, row: str, above: str) -> None:
    for head in ("r [rad/s],Y [N]", "# r [rad/s], Y [N]"):
        table = read(tmp_path, f"{above}{head}\n{row}\n2.5,3.5\n4.5,6.5\n")
        assert [(c.name, c.unit) for c in table.columns] == [("r", "rad/s"), ("Y", "N")]
        first = [float("nan") if c == "-" else float(c) for c in row.split(",")]
        np.testing.assert_array_equal([c.values[0] for c in table.columns], first)


@pytest.mark.parametrize("row", ["1.1,1.1,1.1", "11,1.1,1", "12,13,14", "0.5,1e-05,1e-06", "5.2,1e-3,1e-4"])
def test_numbers_alone_are_data_whatever_powers_of_ten_are_among_them(tmp_path: Path, row: str) -> None:
    table = read(tmp_path, f"Drift,CY,CN\n{row}\n-4,1.5,0.8\n4,-1.5,-0.8\n")
    assert len(table) == 3
    assert [c.unit for c in table.columns] == [""] * 3


def test_a_share_may_stand_under_a_name_without_unit_beside_one_with_its_own(tmp_path: Path) -> None:
    table = read(tmp_path, "alpha (deg),CL,CD\n-,1e-3,1e-3\n-4,1.5,0.8\n4,-1.5,-0.8\n")
    assert len(table) == 2
    assert [c.unit for c in table.columns][1:] == ["1e-3", "1e-3"]


def test_text_in_a_column_of_numbers_is_kept_as_written(tmp_path: Path) -> None:
    """After the first 64 KiB too, when all columns were taken for numbers."""
    long = "1.00000000000000000000,2.00000000000000000000\n" * 2_000
    table = read(tmp_path, f"a,b\n{long}1,diverged\n" + "3,4\n" * 5)
    assert table.column("b").texts[1_999:2_002] == ("2.00000000000000000000", "diverged", "4")
    assert np.isnan(table.column("b").values[2_000])
    assert len(table) == 2_006
    assert not table.column("a").is_text
    assert any('1 cell is text, first "diverged" in line 2002' in r for r in table.remarks)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("a,b\n1,5,2,5\n2,5,3,5\n", "line 1: found 2 names over rows of 4 cells"),
        ("a,b,c\n1,2,3\nx,y,z\n3,4,5\n", 'line 3: found words among the rows ("x,y,z")'),
        ("a,b,c\n" + "1,2,3\n" * 50 + "1,2\n" * 40, "found 2 of 3 cells here and in 20 more lines"),
        ("", "an empty file"),
        ("# only\n# comments\n", "an empty file, or one of comments only"),
        ("words\nand words\n", "no row of numbers"),
        (b"a,b\n1,2\n" + bytes(range(1, 9)) + b"\0\n", "a NUL"),
        (b"1" * 70_000, "a line longer"),
        ("a;b\n1;2\n" + "3" * 3_000_000 + ";1\n", "a line longer"),
    ],
)
def test_broken_tables_are_one_clear_error(tmp_path: Path, text: str | bytes, found: str) -> None:
    assert found in refusal(tmp_path, text)


def test_options_name_lines_and_are_checked(tmp_path: Path) -> None:
    text = "Fx Fy\nN N\nnoise of the day\n1 2\n3 4\n"
    table = read(tmp_path, text, header=1, units=2)
    assert [(c.name, c.unit) for c in table.columns] == [("Fx", "N"), ("Fy", "N")]
    assert [c.name for c in read(tmp_path, text, header=-1, units=-1, comment="none").columns] == [
        "column 1",
        "column 2",
    ]
    with pytest.raises(InputError, match="one of"):
        read(tmp_path, text, delimiter="commas")
    assert "nothing under line 9" in refusal(tmp_path, text, header=9)
    assert "line 3: found 4 names over rows of 2 cells" in refusal(tmp_path, text, header=3)


@pytest.mark.parametrize(
    ("text", "split"),
    [
        ("Fy [N]", ("Fy", "N")), ("Fy (N)", ("Fy", "N")), ("Fy, N", ("Fy", "N")), ("Fy / N", ("Fy", "N")),
        ("Mz [N·m]", ("Mz", "N·m")), ("r (deg/s)", ("r", "deg/s")), ("Y' (-)", ("Y'", "-")), ("Force (hull)", ("Force (hull)", "")),
        ("p (kg/m^3)", ("p", "kg/m^3")), ("yaw rate (rad s^-1)", ("yaw rate", "rad s^-1")), ("CD [-]", ("CD", "-")), ("Y", ("Y", "")),
    ],
)  # fmt: skip
def test_units_in_headers(text: str, split: tuple[str, str]) -> None:
    assert name_and_unit(text) == split


def test_underscored_units_need_company(tmp_path: Path) -> None:
    """se_N is the error of N, C_m a coefficient, delta_s a rudder; Fy_N beside beta_deg is a force in newtons."""
    assert [c.unit for c in read(tmp_path, "se_N,C_m,delta_s\n1,2,3\n2,3,4\n").columns] == ["", "", ""]
    found = read(tmp_path, "t_s,beta_deg,Fy_N,se_N,C_m\n1,2,3,4,5\n2,3,4,5,6\n").columns
    assert [(c.name, c.unit) for c in found] == [("t", "s"), ("beta", "deg"), ("Fy", "N"), ("se_N", ""), ("C_m", "")]


NUMBERS = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False, width=64).map(lambda x: x + 0.0),
    st.floats(-1e6, 1e6).map(lambda x: round(x, 3)),
    st.integers(-10_000_000, 10_000_000).map(float),
)


def _written(value: float, decimal: str, thousands: str, minus: str) -> str:
    text = repr(value)
    if thousands and "e" not in text:
        text = f"{value:,.6f}".replace(",", "\0")
    text = text.replace(".", decimal).replace("\0", thousands)
    return minus + text[1:] if text.startswith("-") else text


@given(
    rows=st.lists(st.lists(NUMBERS, min_size=3, max_size=3), min_size=2, max_size=6),
    delimiter=st.sampled_from([",", ";", "\t", "|", "  "]),
    marks=st.sampled_from([(".", ""), (",", ""), (".", ","), (",", "."), (",", "\u202f"), (".", "'"), (".", "\u00a0")]),
    style=st.sampled_from(["{} [{}]", "{} ({})", "{}, {}", "row", "none", "bare"]),
    minus=st.sampled_from(["-", "−"]),
    end=st.sampled_from(["\n", "\r\n", "\r"]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "cp1252"]),
    top=st.sampled_from(["", "# made by hand\n", "Drift tests of the tank\n\n"]),
)
@settings(max_examples=60, deadline=None)
def test_a_table_in_any_dialect_reads_back_equal(
    tmp_path_factory: pytest.TempPathFactory, rows: list[list[float]], delimiter: str, marks: tuple[str, str], style: str,
    minus: str, end: str, encoding: str, top: str,
) -> None:  # fmt: skip
    """Or it is refused because it has two readings: never read to other numbers."""
    decimal, thousands = marks
    quote = delimiter == "," and "," in marks
    if encoding == "cp1252":
        minus, thousands = "-", thousands.replace("\u202f", "\u00a0")
    if delimiter == "  " and (style in ("{}, {}", "none") or top.startswith("D")):
        top, style = "", "bare"
    names, units = ["alpha", "Fy", "Mz"], ["deg", "N", "N*m"]
    heads = {"row": [names, units], "none": [], "bare": [names]}.get(
        style, [[style.format(n, u) for n, u in zip(names, units, strict=True)]]
    )
    if style == "none":
        top = ""
    cells = [*heads, *([_written(v, decimal, thousands, minus) for v in row] for row in rows)]
    wrap = [[f'"{c}"' if quote or (delimiter == "," and "," in c) else c for c in row] for row in cells]
    text = (top + "".join(delimiter.join(row) + "\n" for row in wrap)).replace("\n", end)
    path = tmp_path_factory.mktemp("dialect") / "a.txt"
    path.write_bytes(text.encode(encoding))
    try:
        table = raw(path, {})
    except AmbiguousError:
        return
    expected = np.array([[round(v, 6) if thousands and "e" not in repr(v) else v for v in row] for row in rows])
    np.testing.assert_array_equal(np.column_stack([c.values for c in table.columns]), expected)
    if style != "none":
        assert [c.name for c in table.columns] == names
        assert [c.unit for c in table.columns] == (units if style != "bare" else ["", "", ""])


@given(st.text(alphabet="0123456789.,'- +eEdDinfa\u202f_１", max_size=12))
def test_a_number_is_read_as_python_reads_it_or_not_at_all(text: str) -> None:
    value = Marks().number(text)
    if value is None or np.isnan(value):
        return
    assert value == float(text.lower().replace("d", "e"))
    assert "_" not in text
    assert text.isascii()


@pytest.mark.slow
def test_rows_at_once_and_one_by_one_are_equal_and_memory_is_bounded(tmp_path: Path) -> None:
    """100,000 rows of 6 columns are 5 MB of numbers; a process that reads them grows by less than 40 MB."""
    rng = np.random.default_rng(3)
    rows = ["\t".join(f"{x:.6e}" for x in row) for row in rng.standard_normal((1_000, 6))] * 100
    path, worded = tmp_path / "long.txt", tmp_path / "worded.txt"
    path.write_text("t\tX\tY\tZ\tM\tN\n" + "\n".join(rows) + "\n")
    worded.write_text("t\tX\tY\tZ\tM\tN\trun\n" + "".join(f"{r}\ta\n" for r in rows))
    quick, slow = raw(path, {}), raw(worded, {})
    for ours, theirs in zip(quick.columns, slow.columns, strict=False):
        np.testing.assert_array_equal(ours.values, theirs.values)
    np.testing.assert_array_equal(quick.lines, slow.lines)
    program = (
        "import resource,sys;from pathlib import Path;from coeflab.tables.importers.table import raw;from coeflab.tables.text_dialect import sniff,Options;"
        "sniff(Path(sys.argv[1]),Options());before=" + PEAK_KILOBYTES + ";"
        "raw(Path(sys.argv[1]),{});print(" + PEAK_KILOBYTES + "-before)"
    )
    done = subprocess.run([sys.executable, "-c", program, str(path)], capture_output=True, text=True, check=True)
    assert float(done.stdout) / 1024.0 < 40.0

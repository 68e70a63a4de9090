"""Sheets of xlsx, xls and ods: what a person sees in them is read, what would fill memory is refused before it is opened."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from coeflab.core.errors import InputError
from coeflab.tables import workbook_size
from coeflab.tables.importers.excel import raw, recognises

SAMPLES = Path(__file__).parent / "samples" / "excel"
NS = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
REL = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
TYPES = (
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="xml" ContentType="application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml"/></Types>'
)
STYLES = f'<styleSheet {NS}><cellXfs count="2"><xf numFmtId="0"/><xf numFmtId="14"/></cellXfs></styleSheet>'


def _relations(*targets: tuple[str, str]) -> str:
    kinds = "".join(f'<Relationship Id="r{i}" Type="{REL}/{k}" Target="{t}"/>' for i, (k, t) in enumerate(targets, 1))
    return (
        f'<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">{kinds}</Relationships>'
    )


def workbook(path: Path, **sheets: str) -> Path:
    """A workbook of the least that ECMA-376 asks for; a sheet is the content of its sheetData."""
    names = "".join(f'<sheet name="{n}" sheetId="{i}" r:id="r{i}"/>' for i, n in enumerate(sheets, 1))
    places = [("worksheet", f"worksheets/sheet{i}.xml") for i in range(1, len(sheets) + 1)]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
        out.writestr("[Content_Types].xml", TYPES)
        out.writestr("_rels/.rels", _relations(("officeDocument", "xl/workbook.xml")))
        out.writestr("xl/workbook.xml", f'<workbook {NS} xmlns:r="{REL}"><sheets>{names}</sheets></workbook>')
        out.writestr("xl/_rels/workbook.xml.rels", _relations(*places, ("styles", "styles.xml")))
        out.writestr("xl/styles.xml", STYLES)
        for i, content in enumerate(sheets.values(), 1):
            out.writestr(f"xl/worksheets/sheet{i}.xml", f"<worksheet {NS}><sheetData>{content}</sheetData></worksheet>")
    return path


def rows(*cells: tuple[object, ...]) -> str:
    """Cells of a sheet: numbers, texts, and XML as it stands."""
    out = []
    for i, row in enumerate(cells, 1):
        texts = []
        for letter, value in zip("ABCDEFGH", row, strict=False):
            place = f"{letter}{i}"
            if isinstance(value, str) and value.startswith("<"):
                texts.append(value.format(place=place))
            elif isinstance(value, str):
                texts.append(f'<c r="{place}" t="inlineStr"><is><t>{value}</t></is></c>' if value else "")
            else:
                texts.append(f'<c r="{place}"><v>{value!r}</v></c>')
        out.append(f'<row r="{i}">{"".join(texts)}</row>')
    return "".join(out)


def refusal(path: Path, **options: object) -> str:
    with pytest.raises(InputError) as why:
        raw(path, options)
    assert why.value.file == path
    return str(why.value)


def test_a_sheet_with_title_unit_row_and_an_error() -> None:
    table = raw(SAMPLES / "drift_title_unit_row_error.xlsx", {})
    assert [(c.name, c.unit) for c in table.columns] == [("Run", ""), ("beta", "deg"), ("Fy", "N"), ("Mz", "N m")]
    np.testing.assert_array_equal(table.column("Fy").values, [14.312, 6.521, np.nan, -6.498, -14.287])
    assert table.column("Run").texts == ("D1", "D2", "D3", "D4", "D5")
    assert list(table.lines) == [5, 6, 7, 8, 9]
    assert table.dialect["sheets"] == "Drift, Notes"
    assert "first C7 of sheet1.xml" in table.remarks[0]


@pytest.mark.parametrize(
    ("name", "column", "values"),
    [("yaw.xls", "Y", [0.0, -1.5, -3.0, -4.5, -6.0]), ("heave.ods", "Fz", [12.5, 0.25, -12.75])],
)
def test_xls_and_ods(name: str, column: str, values: list[float]) -> None:
    assert recognises(SAMPLES / name)
    assert list(raw(SAMPLES / name, {}).column(column).values) == values


def test_the_sheet_of_a_simman_tank_keeps_every_column_apart() -> None:
    table = raw(SAMPLES / "pmm_of_a_simman_tank.xlsx", {})
    assert [(c, table.column(c).unit) for c in ("Y", "Y (2)", "r'", "Q (2)")] == [
        ("Y", "N"), ("Y (2)", "N"), ("r'", "°/s2"), ("Q (2)", "Nmm"),
    ]  # fmt: skip
    assert "head several columns" in table.remarks[0]
    assert '"RUDDER" over "given (2)"' in table.remarks[1]


def test_formulas_by_their_saved_values_and_sheets_by_name_or_number(tmp_path: Path) -> None:
    head = ("x (m)", "Y (N)")
    one = rows(head, (1.0, '<c r="{place}"><f>A2*2</f><v>2.5</v></c>'), (2.0, 5.0))
    two = rows(head, (1.0, 7.0), (2.0, 8.0))
    path = workbook(tmp_path / "a.xlsx", one=one, two=two)
    assert "2 sheets with rows of numbers" in refusal(path)
    assert '1 "one" and 2 "two"' in refusal(path)
    assert list(raw(path, {"sheet": "one"}).column("Y").values) == [2.5, 5.0]
    assert list(raw(path, {"sheet": 2}).column("Y").values) == [7.0, 8.0]
    assert 'no sheet "three"' in refusal(path, sheet="three")


def test_dates_among_numbers_are_refused_and_a_column_of_dates_is_text(tmp_path: Path) -> None:
    date = '<c r="{place}" s="1"><v>45413</v></c>'
    path = workbook(tmp_path / "a.xlsx", s=rows(("day", "Y"), (date, 1.0), (date, 2.0)))
    assert raw(path, {}).column("day").texts == ("2024-05-01", "2024-05-01")
    path = workbook(tmp_path / "b.xlsx", s=rows(("beta", "Y"), (1.25, 1.0), (date, 2.0)))
    assert "the date 2024-05-01 in cell A3" in refusal(path)


def test_words_among_rows_and_a_second_table(tmp_path: Path) -> None:
    path = workbook(tmp_path / "a.xlsx", s=rows(("a", "b"), (1.0, 2.0), (3.0, 4.0), ("c", "d"), (5.0, 6.0), (7.0, 8.0)))
    assert 'line 4: found words among the rows ("c d")' in refusal(path)
    assert [c.name for c in raw(path, {"header": 4}).columns] == ["c", "d"]
    first = raw(path, {"header": 1})
    assert list(first.column("a").values) == [1.0, 3.0]
    assert "the table of row 1 ends there" in first.remarks[0]
    noted = workbook(tmp_path / "b.xlsx", s=rows(("a", "b"), (1.0, 2.0), (3.0, 4.0), ("measured by", "night")))
    assert "row 4: words" in raw(noted, {}).remarks[0]


TANK = [
    ("Nr", "beta", "Fy", "Mz"), (1.0, "-8,0", "54,05", "1,796"), (2.0, "0,0", "-1,3", "n. a."), ("Nach der Mittagspause neu genullt",),
    (3.0, "8,0", "-53,9", "-1,802"), ("", "Pause"), (4.0, "10,0", "-70", "-2,1"),
]  # fmt: skip


@pytest.mark.parametrize("header", [0, 1])
def test_a_remark_among_the_rows_and_numbers_as_text_with_a_comma(tmp_path: Path, header: int) -> None:
    """As the CSV of the same sheet is read."""
    table = raw(workbook(tmp_path / "a.xlsx", s=rows(*TANK)), {"header": header})
    np.testing.assert_array_equal(table.column("beta").values, [-8.0, 0.0, 8.0, 10.0])
    np.testing.assert_array_equal(table.column("Fy").values, [54.05, -1.3, -53.9, -70.0])
    np.testing.assert_array_equal(table.column("Mz").values, [1.796, np.nan, -1.802, -2.1])
    assert list(table.lines) == [2, 3, 5, 7]
    assert table.remarks[0].startswith('row 4: a remark among the rows ("Nach der Mittagspause')
    assert "10 cells hold numbers as text with a decimal comma, first B2; read as numbers" in table.remarks


def test_a_text_that_may_have_a_mark_of_thousands_stays_text(tmp_path: Path) -> None:
    path = workbook(tmp_path / "a.xlsx", s=rows(("a", "b"), (1.0, "1,025"), (2.0, "2,125"), (3.0, 4.0)))
    np.testing.assert_array_equal(raw(path, {}).column("b").values, [np.nan, np.nan, 4.0])


def test_hostile_workbooks_are_refused_before_they_are_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workbook_size, "SHEET_UNPACKED", 4 << 20)
    far = workbook(
        tmp_path / "far.xlsx",
        s='<row r="1"><c r="A1"><v>1</v></c></row><row r="1048576"><c r="XFD1048576"><v>2</v></c></row>',
    )
    assert "17,179,869,184 cells" in refusal(far)
    bomb = workbook(tmp_path / "bomb.xlsx", s=rows((1.0, 2.0)))
    with (
        zipfile.ZipFile(bomb, "a", zipfile.ZIP_DEFLATED) as out,
        out.open("xl/media.bin", "w", force_zip64=True) as stream,
    ):
        for _ in range(8):
            stream.write(bytes(1 << 20))
    assert bomb.stat().st_size < 1 << 20
    assert "bytes when unpacked" in refusal(bomb)
    lying = bytearray(bomb.read_bytes())
    at = lying.rfind(b"PK\x01\x02")
    lying[at + 24 : at + 28] = (1000).to_bytes(4, "little")
    (tmp_path / "lying.xlsx").write_bytes(lying)
    assert "broken workbook" in refusal(tmp_path / "lying.xlsx") or "than the directory says" in refusal(
        tmp_path / "lying.xlsx"
    )
    ods = tmp_path / "many.ods"
    cell = '<table:table-cell office:value-type="float" office:value="1" table:number-columns-repeated="2000000000"/>'
    with zipfile.ZipFile(ods, "w") as out:
        out.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        out.writestr(
            "content.xml",
            f"<a xmlns:table='t' xmlns:office='o'><table:table table:name='a'><table:table-row>{cell}</table:table-row></table:table></a>",
        )
    assert "2,000,000,000 cells" in refusal(ods)


def test_a_chain_of_sectors_that_bites_its_tail(tmp_path: Path) -> None:
    """The reader would follow it until memory ends: 4 GB for a file of 5 kB."""
    content = bytearray((SAMPLES / "yaw.xls").read_bytes())
    table = 512 * (1 + int.from_bytes(content[76:80], "little"))
    content[table : table + 4] = (0).to_bytes(4, "little")
    path = tmp_path / "a.xls"
    path.write_bytes(content)
    assert "a chain of sectors without end" in refusal(path)


def test_an_extent_that_ends_before_it_begins(tmp_path: Path) -> None:
    """The reader would ask for 687 GB: the record DIMENSIONS of a sheet, and a cell at a place that is none."""
    content = (SAMPLES / "yaw.xls").read_bytes()
    at = content.index(b"\x00\x02\x0e\x00" + (0).to_bytes(4, "little")) + 4
    (tmp_path / "a.xls").write_bytes(content[:at] + b"\xb3" + content[at + 1 :])
    assert "a sheet that ends before it begins" in refusal(tmp_path / "a.xls")
    assert 'a cell at "Baaaa5"' in refusal(
        workbook(tmp_path / "b.xlsx", s='<row r="1"><c r="Baaaa5"><v>1</v></c></row>')
    )


def test_an_ods_that_is_cut_inside(tmp_path: Path) -> None:
    """The reader would look for its end for ever."""
    with zipfile.ZipFile(SAMPLES / "heave.ods") as old, zipfile.ZipFile(tmp_path / "a.ods", "w") as new:
        for name in old.namelist():
            new.writestr(name, old.read(name)[: -300 if name == "content.xml" else None])
    assert "a broken workbook (" in refusal(tmp_path / "a.ods")


def test_a_panic_of_the_reader_is_an_input_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rust's panics come as an exception that is no Exception."""

    class PanicException(BaseException):
        pass

    def panics(_path: str) -> None:
        raise PanicException("index out of range")

    monkeypatch.setattr("python_calamine.CalamineWorkbook", type("Book", (), {"from_filelike": staticmethod(panics)}))
    assert "a broken workbook (index out of range)" in refusal(SAMPLES / "yaw.xls")


def test_locked_and_foreign_files_say_so(tmp_path: Path) -> None:
    locked = tmp_path / "a.xlsx"
    locked.write_bytes(
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600) + "EncryptedPackage".encode("utf-16-le") + bytes(600)
    )
    assert recognises(locked)
    assert "a locked workbook" in refusal(locked)
    for name, content in (("b.xlsx", b"PK\x03\x04 and nothing"), ("c.xls", b"a,b\n1,2\n")):
        (tmp_path / name).write_bytes(content)
        assert not recognises(tmp_path / name)
        assert "no workbook" in refusal(tmp_path / name)
    cut = tmp_path / "d.xls"
    cut.write_bytes((SAMPLES / "yaw.xls").read_bytes()[:2500])
    assert "a broken workbook" in refusal(cut) or "no workbook" in refusal(cut)
    assert not recognises(tmp_path)


@given(
    st.lists(
        st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=2, max_size=2), min_size=2, max_size=8
    ),
    st.sampled_from(["{} [{}]", "{} ({})", "row"]),
)
@example([[1.0, 1.1], [0.0, 0.0]], "{} [{}]")
@example([[11.0, 1.0], [2.0, 3.0]], "{} ({})")
@settings(max_examples=30, deadline=None)
def test_a_sheet_reads_back_equal(
    tmp_path_factory: pytest.TempPathFactory, values: list[list[float]], style: str
) -> None:
    heads = [("r", "Y"), ("rad/s", "N")] if style == "row" else [(style.format("r", "rad/s"), style.format("Y", "N"))]
    path = workbook(tmp_path_factory.mktemp("sheet") / "a.xlsx", s=rows(("own numbers",), *heads, *map(tuple, values)))
    table = raw(path, {})
    assert [(c.name, c.unit) for c in table.columns] == [("r", "rad/s"), ("Y", "N")]
    np.testing.assert_array_equal(np.column_stack([c.values for c in table.columns]), values)


def test_a_message_names_the_first_twenty_of_many_sheets(tmp_path: Path) -> None:
    """3,000 sheets were one line of 46,000 letters."""
    said = refusal(workbook(tmp_path / "many.xlsx", **{f"s{i}": "" for i in range(300)}))
    assert '20 "s19" and 280 more' in said
    assert len(said) < 700

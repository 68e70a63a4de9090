"""Spreadsheets, xlsx, xls and ods: one sheet, the values that its formulas had when it was saved."""

from __future__ import annotations

import datetime
import math
import re
import zipfile
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from coeflab.core.errors import shown
from coeflab.core.limits import SHEET_BYTES, SHEET_CELLS, TABLE_COLUMNS
from coeflab.core.options import bounded, parse_options, text
from coeflab.core.text.bounded import stream_of, whole_bytes
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import listed
from coeflab.tables import dialect
from coeflab.tables.blocks import Title, with_blocks
from coeflab.tables.dialect import Cells, Head, Marks, Row, is_unit_row, numbered, numeric, raw_columns, read_head
from coeflab.tables.raw_table import RawTable, SeveralError
from coeflab.tables.words.above import words_above
from coeflab.tables.workbook_size import errors_in

summary = "spreadsheets (xlsx, xls, ods): a sheet with its header row, formulas by their saved values"
citations = ()
reads = "sheets of xlsx, xls and ods files"

ZIP, OLE = b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_BOOK, _LOCKED = "Workbook".encode("utf-16-le"), "EncryptedPackage".encode("utf-16-le")
Value = Any  # what calamine hands out: str, float, int, bool, date, time, datetime, timedelta
PLAIN, COMMA = Marks(), Marks(",")
_COMMA = re.compile(
    r"[-+\u2212]?(?:0,[0-9]+|[0-9]+,(?:[0-9]{1,2}|[0-9]{4,})(?:[eE][-+]?[0-9]+)?)"
)  # no mark of thousands


@dataclass(frozen=True, slots=True)
class Options:
    """Which part of a workbook is the table.

    Attributes
    ----------
    sheet : str
        Name or number, from 1; empty where one sheet alone holds numbers.
    header : int
        Row of the column names; 0 to find it, -1 where there is none.
    units : int
        Row of the units; 0 to find it, -1 where there is none.
    columns : str
        Names of all, in order and between commas; empty to find them.
    """

    sheet: str = text("")
    header: int = bounded(0, -1, 1_048_576)
    units: int = bounded(0, -1, 1_048_576)
    columns: str = text("")


def _kind(path: Path) -> str:
    """What a file is, by its first 64 KiB: xlsx, ods, xls, locked, or nothing of these."""
    try:
        if not path.is_file():
            return ""
        with stream_of(path) as stream:
            start = stream.read(1 << 16)
        if start.startswith(OLE):
            with stream_of(path) as stream:
                whole = stream.read(SHEET_BYTES)
            return (
                "locked" if _LOCKED in whole else "xls" if _BOOK in whole or "Book".encode("utf-16-le") in whole else ""
            )
        if not start.startswith(ZIP):
            return ""
        with zipfile.ZipFile(path) as packed:
            names = set(packed.namelist())
    except (OSError, zipfile.BadZipFile, ValueError, NotImplementedError, UnicodeDecodeError):
        return ""
    if "xl/workbook.bin" in names:
        return "xlsb"
    return "xlsx" if "xl/workbook.xml" in names else "ods" if {"content.xml", "mimetype"} <= names else ""


def recognises(path: Path) -> bool:
    """Whether the file is a workbook of Excel or LibreOffice, locked ones too."""
    return bool(_kind(path))


def _cells_of(sheet: Any, name: str, path: Path) -> list[list[Value]]:
    high, wide = sheet.total_height, sheet.total_width
    if high * wide > SHEET_CELLS or wide > TABLE_COLUMNS:
        raise input_error(
            "tables.size_of_sheet", path, high=high, wide=wide, name=shown(name), most_cells=SHEET_CELLS, most_columns=TABLE_COLUMNS
        )  # fmt: skip
    return list(sheet.to_python(skip_empty_area=False))


MOST_NAMED = 20  # sheets in one message


def _sheets(path: Path, only: str = "") -> dict[str, list[list[Value]]]:
    """Every sheet as rows of cells from A1 on; where one is named, the others are empty: a workbook may be read once a sheet."""
    import python_calamine

    try:
        with python_calamine.CalamineWorkbook.from_filelike(
            BytesIO(whole_bytes(path, SHEET_BYTES))
        ) as book:  # a name may lie
            out: dict[str, list[list[Value]]] = {}
            wanted = {only} & set(book.sheet_names)
            tables = [m.name for m in book.sheets_metadata if m.typ == python_calamine.SheetTypeEnum.WorkSheet]
            for name in tables if wanted else book.sheet_names:
                if wanted and name not in wanted:
                    out[name] = []
                    continue
                try:
                    sheet = book.get_sheet_by_name(name)
                except python_calamine.CalamineError:
                    continue  # a chart or a macro sheet
                out[name] = _cells_of(sheet, name, path)
    except python_calamine.PasswordError:
        raise input_error("tables.workbook_with_password", path) from None
    except (python_calamine.CalamineError, OSError, ValueError) as why:
        raise input_error("tables.broken_workbook", path, why=shown(why, 200)[1:-1]) from None
    except BaseException as why:  # a panic of the reader in Rust is no Exception
        if type(why).__name__ != "PanicException":
            raise
        raise input_error("tables.broken_workbook", path, why=shown(why, 200)[1:-1]) from None
    return out


def _is_number(value: Value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _text(value: Value) -> str:
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return value.strip() if isinstance(value, str) else str(value)


def _filled(row: Sequence[Value]) -> int:
    """How many cells hold numbers, or say in letters that there is none."""
    return sum(_is_number(v) for v in row) + numeric([v.strip() for v in row if isinstance(v, str)], PLAIN)


def _read_texts(rows: list[list[Value]]) -> tuple[list[list[Value]], list[str]]:
    """Numbers that cells hold as text with a decimal comma, as numbers, where the sheet has none with a point."""
    texts = [v.strip() for row in rows for v in row if isinstance(v, str)]
    with_comma = sum(_COMMA.fullmatch(t) is not None for t in texts)
    if not with_comma or with_comma <= sum("." in t and bool(PLAIN.number(t)) for t in texts):
        return rows, []
    out, found = [list(row) for row in rows], list[str]()
    for i, row in enumerate(rows):
        for k, value in enumerate(row):
            number = COMMA.number(value.strip()) if isinstance(value, str) and "," in value else None
            if number is not None and math.isfinite(number):
                out[i][k] = number
                found.append(_place(i + 1, k))
    many = len(found)
    words = f"{many} cell{'s hold numbers' * (many > 1) or ' holds a number'} as text with a decimal comma, first {found[0]}; read as numbers"
    return out, [words]


def _place(row: int, column: int) -> str:
    letters, k = "", column + 1
    while k:
        k, rest = divmod(k - 1, 26)
        letters = chr(65 + rest) + letters
    return f"{letters}{row}"


def _chosen(sheets: Mapping[str, list[list[Value]]], options: Options, path: Path) -> str:
    """The sheet that is meant."""
    named = [f"{i} {shown(n)}" for i, n in enumerate(sheets, start=1)]
    rest = [f"{len(named) - MOST_NAMED} more"] * (len(named) > MOST_NAMED)
    known = listed([*named[:MOST_NAMED], *rest]) if named else "none"
    if options.sheet:
        if options.sheet in sheets:
            return options.sheet
        if options.sheet.isdecimal() and 0 < int(options.sheet[:9]) <= len(sheets):
            return list(sheets)[int(options.sheet) - 1]
        raise input_error("tables.no_such_sheet", path, name=shown(options.sheet), known=known)
    full = [name for name, rows in sheets.items() if sum(_filled(row) > 0 for row in rows) > 1]
    if len(full) != 1:
        several = SeveralError(
            f"{len(full) or 'no'} sheets with rows of numbers", "one, or the option sheet", file=path,
            advice=f"The sheets are {known}. Say which with --option sheet=NAME, or sheet = under [importer].",
        )  # fmt: skip
        several.choices = tuple(full)
        raise several
    return full[0]


def _body(rows: list[list[Value]], options: Options, path: Path) -> tuple[int, Head]:
    """Index of the first row of data, and the names over it."""
    after = max(options.header, options.units, 0)
    counts = [_filled(row) if i >= after else 0 for i, row in enumerate(rows)]
    many = [n for n in counts if n]
    if not many:
        raise input_error("tables.no_rows_in_sheets", path)
    usual = median(many) / 2
    following = [i for i, n in enumerate(counts) if n]
    fits = [i for i, n in enumerate(counts) if n >= usual]
    begin = (
        next(
            (i for i in fits if following.index(i) + 1 == len(following) or following[following.index(i) + 1] in fits),
            fits[0],
        )
        if len(rows) < 2000
        else fits[0]
    )
    below = [[_text(v) for v in row] for row in rows[begin + 1 : begin + 500] or rows[begin:]]
    numbers = numbered(below, PLAIN)
    over = options.units == 0 and begin + 1 < len(rows) and is_unit_row([_text(v) for v in rows[begin]], numbers)
    head = _head_over(rows, begin + over, numbers, options, path)  # 1e-3 and the like over the data, read as numbers
    if over and head.unit_line != begin + 1:
        return begin, _head_over(rows, begin, numbers, options, path)
    return begin + over, head


def _head_over(rows: list[list[Value]], begin: int, numbers: Set[int], options: Options, path: Path) -> Head:
    if options.columns:
        return dialect.head_in_order(options.columns, len(rows[0]), path)
    above: list[Row] = []
    for i in range(begin - 1, max(begin - 12, -1), -1):
        cells = [_text(v) for v in rows[i]]
        if any(cells) and (len(above) < 3 or i + 1 in (options.header, options.units)):
            above.insert(0, (i + 1, cells))
    for wanted in (options.header, options.units):
        if wanted > 0 and wanted not in [n for n, _ in above]:
            raise input_error("tables.no_names_in_row", path, wanted=wanted, begin=begin + 1)
    return read_head(above, len(rows[0]), PLAIN, numbers, options.header, options.units)


def _data_rows(
    rows: list[list[Value]], begin: int, head: Head, options: Options, path: Path
) -> tuple[list[int], list[str], list[Title]]:
    """Indices of the rows of data, what is said of the others, and the words among them."""
    selected: list[int] = []
    titles: list[Title] = []
    remarks: list[str] = []
    numbers = numbered([[_text(v) for v in row] for row in rows[begin:] if _filled(row)], PLAIN)
    for i in range(begin, len(rows)):
        row = rows[i]
        if not any(v != "" for v in row):
            continue
        if _filled(row):
            selected.append(i)
        elif tuple(_text(v) for v in row) in head.written:
            remarks.append(f"row {i + 1}: the head again; left out")
        elif not any(_filled(r) for r in rows[i + 1 :]):
            remarks.append(
                f"row {i + 1}: words ({shown(' '.join(t for t in map(_text, row) if t))}); left out with what follows"
            )
            break
        elif 2 * sum(rows[i][k] != "" for k in numbers) < len(numbers):
            phrases = shown(words := " ".join(t for t in map(_text, row) if t))
            titles.append(Title(len(selected), i + 1, words))
            remarks.append(f"row {i + 1}: a remark among the rows ({phrases}); left out")
        elif options.header > 0:
            remarks.append(f"row {i + 1}: words; the table of row {head.line} ends there")
            break
        else:
            raise input_error(
                "tables.words_among_rows_of_sheet", path, i + 1, place=shown(" ".join(t for t in map(_text, row) if t))
            )
    return selected, remarks, titles


def _values(column: list[Value], lines: list[int], k: int, met: Cells, path: Path) -> tuple[Array, list[str]]:
    """A column's numbers, and its texts where it has some."""
    dates = [i for i, v in enumerate(column) if isinstance(v, (datetime.date, datetime.time, datetime.timedelta))]
    if dates and any(_is_number(v) for v in column):
        i = dates[0]
        raise input_error("tables.date_among_numbers", path, lines[i], head=column[i], place=_place(lines[i], k))
    out = np.empty(len(column))
    for i, value in enumerate(column):
        if _is_number(value) and math.isfinite(value):
            out[i] = value
        else:
            out[i] = met.values(["inf" if _is_number(value) else _text(value)], [lines[i]], PLAIN)[0]
    return out, [_text(v) for v in column] if met.text else []


def raw(path: Path, options: Mapping[str, Any]) -> RawTable:
    """The table of one sheet as it stands there.

    Parameters
    ----------
    path : Path
    options : mapping
        See `Options`.

    Raises
    ------
    InputError
        No workbook, a locked, broken or too large one, no such sheet, several with numbers, dates among numbers, or words
        among rows.
    """
    given = parse_options(Options, options, "excel")
    kind = _kind(path)
    if kind in ("", "locked", "xlsb"):
        code = {"": "tables.no_workbook", "locked": "tables.locked_workbook", "xlsb": "tables.binary_workbook"}[kind]
        raise input_error(code, path)
    if path.stat().st_size > SHEET_BYTES:
        raise input_error("tables.bytes_of_workbook", path, size=path.stat().st_size, most_bytes=SHEET_BYTES)
    errors = errors_in(path, kind)
    read = {name: _read_texts(rows) for name, rows in _sheets(path, given.sheet).items()}
    sheets = {name: rows for name, (rows, _) in read.items()}
    name = _chosen(sheets, given, path)
    rows = sheets[name]
    begin, head = _body(rows, given, path)
    selected, left, titles = _data_rows(rows, begin, head, given, path)
    lines = [i + 1 for i in selected]
    met = [Cells() for _ in rows[0]]
    values, texts = [], {}
    for k, cells in enumerate(met):
        column, words = _values([rows[i][k] for i in selected], lines, k, cells, path)
        values.append(column)
        if words:
            texts[k] = words
    columns, remarks = raw_columns(head, values, texts, met)
    above = [
        (i + 1, [_text(v) for v in rows[i]]) for i in range(min(begin, 200)) if i + 1 not in (head.line, head.unit_line)
    ]
    dialect = {
        "file": kind,
        "sheet": name,
        "sheets": ", ".join(sheets),
        "header": f"row {head.line}" if head.line else "none",
        "units": head.units_stand.replace("line", "row"),
    }
    table = RawTable(
        path, columns, head.line, np.array(lines), files=(path,), dialect=dialect, remarks=(*left, *errors, *read[name][1], *remarks),
        stated=words_above(above, PLAIN),
    )  # fmt: skip
    over = [Title(0, n, " ".join(filter(None, cells))) for n, cells in above]
    return with_blocks(table, [*over, *titles], PLAIN)

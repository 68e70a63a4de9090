"""Spreadsheets, xlsx, xls and ods: one sheet, the values that its formulas had when it was saved."""

from __future__ import annotations

import datetime
import math
import re
import struct
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from io import BytesIO
from lzma import LZMAError
from pathlib import Path
from statistics import median
from typing import Any
from xml.parsers import expat

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import SHEET_BYTES, SHEET_CELLS, SHEET_UNPACKED, TABLE_COLUMNS
from coeflab.core.options import bounded, parse_options, text
from coeflab.core.text.bounded import part_of, stream_of, whole_bytes
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.wording import listed
from coeflab.tables.blocks import Title, with_blocks
from coeflab.tables.dialect import Cells, Head, Marks, Row, is_unit_row, numbered, numeric, raw_columns, read_head
from coeflab.tables.raw_table import RawTable, SeveralError
from coeflab.tables.words.above import words_above

summary = "spreadsheets (xlsx, xls, ods): a sheet with its header row, formulas by their saved values"
citations = ()
reads = "sheets of xlsx, xls and ods files"

ZIP, OLE = b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_BOOK, _LOCKED = "Workbook".encode("utf-16-le"), "EncryptedPackage".encode("utf-16-le")
_PLACE = re.compile(rb"""<(?:\w+:)?(?:c|row)\s(?:[^>]*?\s)?r\s*=\s*["']([^"'>]*)["']""")
_PLACED = re.compile(rb"([A-Z]{0,3})([0-9]{1,7})")
_ERROR = re.compile(rb"""<c\b(?=[^>]*\st\s*=\s*["']e["'])[^>]*\sr\s*=\s*["']([A-Z]+[0-9]+)["']""")
_ODS = re.compile(rb"<table:(?:table-row|table-cell|covered-table-cell|table)\b[^>]*>")
_REPEATED = re.compile(rb"""table:number-(?:rows|columns)-repeated\s*=\s*["']([0-9]+)["']""")
_CHUNK = 1 << 20
Value = Any  # what calamine hands out: str, float, int, bool, date, time, datetime, timedelta
PLAIN, COMMA = Marks(), Marks(",")
_COMMA = re.compile(
    r"[-+\u2212]?(?:0,[0-9]+|[0-9]+,(?:[0-9]{1,2}|[0-9]{4,})(?:[eE][-+]?[0-9]+)?)"
)  # no mark of thousands
_BROKEN = (
    LookupError,
    expat.ExpatError, zipfile.BadZipFile, zlib.error, LZMAError, EOFError, ValueError, NotImplementedError, RuntimeError, struct.error, IndexError,
)  # fmt: skip


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
    """

    sheet: str = text("")
    header: int = bounded(0, -1, 1_048_576)
    units: int = bounded(0, -1, 1_048_576)


def _refused(found: str, file: Path, expected: str = "a spreadsheet", advice: str = "") -> InputError:
    return InputError(found, expected, file=file, advice=advice)


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


def _column(letters: bytes) -> int:
    number = 0
    for letter in letters:
        number = 26 * number + letter - 64
    return number


def _pieces(packed: zipfile.ZipFile, name: str) -> Iterator[bytes]:
    """A part of a workbook, piece by piece, each with the end of the one before, cut at the last tag."""
    rest = b""
    with part_of(packed, name) as stream:
        while piece := stream.read(_CHUNK):
            whole = rest + piece
            end = whole.rfind(b"<") if len(whole) < 4 * _CHUNK else -1
            yield whole[: max(end, 0)]
            rest = whole[max(end, 0) :]
    yield rest


def _scan_of_xlsx(packed: zipfile.ZipFile, name: str) -> tuple[int, list[str]]:
    """Cells of the rectangle from A1 to the last one, which the reader holds in memory; cells that it hands out as blank."""
    rows = columns = 0
    blank: list[str] = []
    for piece in _pieces(packed, name):
        for place in _PLACE.findall(piece):
            if not (m := _PLACED.fullmatch(place)):
                raise ValueError(f"a cell at {shown(place.decode('utf-8', 'replace'), 20)}")
            rows, columns = max(rows, int(m[2])), max(columns, _column(m[1]))
        if len(blank) < 1000:
            blank += [m[1].decode("ascii", "replace") for m in _ERROR.finditer(piece)]
    return rows * max(columns, 1), blank


def _cells_of_ods(packed: zipfile.ZipFile) -> int:
    """Cells of the rectangles of all sheets, repeated ones counted as often."""
    total = rows = width = repeat = column = 0
    for piece in _pieces(packed, "content.xml"):
        for tag in _ODS.findall(piece):
            many = _REPEATED.search(tag)
            times = int(many[1][:12]) if many else 1
            if tag.startswith(b"<table:table-row"):
                repeat, column = times, 0
                rows += times if times < 1000 else 0  # the empty rest of a sheet is written as one row
            elif b"table-cell" in tag[:26]:
                column += times
                if b"office:" in tag or b"table:formula" in tag:
                    width = max(width, column)
                    rows += repeat if repeat >= 1000 else 0
            else:
                total, rows, width = total + rows * width, 0, 0
    return total + rows * width


def _checked(path: Path, kind: str) -> list[str]:
    """Refuse a workbook that unpacks to more than memory holds, whatever its directory says; remarks on errors in cells."""
    found, cells, blank = "", 0, list[str]()
    try:
        if kind == "xls":
            cells = _cells_of_xls(whole_bytes(path, SHEET_BYTES))
        else:
            with zipfile.ZipFile(path) as packed:
                found = _too_much(packed, packed.infolist())
                if not found:
                    _require_whole_xml(packed)
                if not found and kind == "ods":
                    cells = _cells_of_ods(packed)
                elif not found:
                    for part in packed.namelist():
                        many, errors = _scan_of_xlsx(packed, part)
                        cells += many
                        blank += [f"{place} of {part.rpartition('/')[2]}" for place in errors]
    except (*_BROKEN, OSError) as why:
        raise _refused(f"a broken workbook ({shown(why, 200)[1:-1]})", path) from None
    if cells > SHEET_CELLS:
        found = f"{cells:,} cells between the first and the last"
    if found:
        raise _refused(found, path, f"at most {SHEET_UNPACKED:,} bytes unpacked and {SHEET_CELLS:,} cells")

    many = len(blank)
    return (
        [f"{many} cell{'s' * (many > 1)} with an error such as #DIV/0!, first {blank[0]}; read as blank"]
        if blank
        else []
    )


_END, _FREE = 0xFFFFFFFE, 0xFFFFFFFA  # end of a chain of sectors; from here on no sector
_CELLS = frozenset({0x0006, 0x00BD, 0x00BE, 0x00FD, 0x0201, 0x0203, 0x0204, 0x0205, 0x027E})
_SHEET_BEGINS, _EXTENT, _MANY = 0x0809, 0x0200, frozenset({0x00BD, 0x00BE})


def _chain(first: int, table: Sequence[int]) -> list[int]:
    """Numbers of the sectors from the first on; [MS-CFB] 2.3.

    Raises
    ------
    ValueError
        The chain bites its tail or leaves the table: the reader would follow it until memory ends.
    """
    out: list[int] = []
    while first != _END:
        if first >= len(table) or len(out) >= len(table):
            raise ValueError("a chain of sectors without end")
        out.append(first)
        first = table[first]
    return out


def _numbers(content: bytes) -> tuple[int, ...]:
    return struct.unpack(f"<{len(content) // 4}I", content[: len(content) // 4 * 4])


def _stream_of_xls(content: bytes) -> bytes:
    """The workbook inside a compound file; [MS-CFB] 2.2 to 2.6."""
    power, small_power = struct.unpack_from("<HH", content, 30)
    if power not in (9, 12) or small_power != 6:
        raise ValueError("sectors of an unknown size")
    size = 1 << power
    sectors = [content[i : i + size] for i in range(size, len(content), size)]
    places, more = list(_numbers(content[76:512])), struct.unpack_from("<I", content, 68)[0]
    for _ in sectors:
        if more >= _FREE:
            break
        *found, more = _numbers(sectors[more])
        places += found
    if more < _FREE:
        raise ValueError("a chain of sectors without end")
    table = [n for place in places if place < _FREE for n in _numbers(sectors[place])]

    def whole(first: int) -> bytes:
        return b"".join(sectors[n] for n in _chain(first, table))

    start, _, cutoff, small_start, small_many = struct.unpack_from("<5I", content, 48)
    folder = whole(start)
    if not folder or len(folder) % 128:
        raise ValueError("a folder that is cut")
    entries = [folder[i : i + 128] for i in range(0, len(folder) - 127, 128)]
    small = whole(struct.unpack_from("<I", entries[0], 116)[0])
    small_table = _numbers(whole(small_start)) if small_many else ()
    for entry in entries:
        first, length = struct.unpack_from("<II", entry, 116)
        name = entry[: min(struct.unpack_from("<H", entry, 64)[0], 64)].decode("utf-16-le", "replace").rstrip("\0")
        if length == 0 or entry[66] != 2:
            continue
        pieces = (
            (small[64 * n : 64 * n + 64] for n in _chain(first, small_table)) if length < cutoff else (whole(first),)
        )
        stream = b"".join(pieces)[:length]
        if name.lower() in ("workbook", "book"):
            return stream
    raise ValueError("no workbook in it")


def _cells_of_xls(content: bytes) -> int:
    """Cells of the rectangles of all sheets; [MS-XLS] 2.4."""
    stream = _stream_of_xls(content)
    at = total = rows = columns = 0
    while at + 4 <= len(stream):
        kind, length = struct.unpack_from("<HH", stream, at)
        body = stream[at + 4 : at + 4 + length]
        if kind == _SHEET_BEGINS:
            total, rows, columns = total + rows * columns, 0, 0
        elif kind == _EXTENT and len(body) in (10, 14):
            top, bottom, left, right = struct.unpack_from("<IIHH" if len(body) == 14 else "<HHHH", body)
            if top > bottom or left > right:
                raise ValueError("a sheet that ends before it begins")
            rows, columns = max(rows, bottom), max(columns, right)
        elif kind in _CELLS and len(body) >= 6:
            row, column = struct.unpack_from("<HH", body)
            last = struct.unpack_from("<H", body, len(body) - 2)[0] if kind in _MANY else column
            rows, columns = max(rows, row + 1), max(columns, column + 1, last + 1)
        at += 4 + length
    return total + rows * columns


def _require_whole_xml(packed: zipfile.ZipFile) -> None:
    """Refuse parts that are no whole XML: in an ods that is cut the reader looks for the end for ever."""
    for name in packed.namelist():
        if name.endswith((".xml", ".rels")):
            with part_of(packed, name) as stream:
                expat.ParserCreate().ParseFile(stream)


def _too_much(packed: zipfile.ZipFile, parts: list[zipfile.ZipInfo]) -> str:
    """Why a workbook unpacks to too much, by its directory and by itself; empty where it does not."""
    left = SHEET_UNPACKED
    if (words := sum(part.file_size for part in parts)) > left:
        return f"{words:,} bytes when unpacked"
    for part in parts:
        with part_of(packed, part) as stream:
            while piece := stream.read(_CHUNK):
                left -= len(piece)
                if left < 0:
                    return f"more bytes in {shown(part.filename)} than the directory says"
    return ""


def _cells_of(sheet: Any, name: str, path: Path) -> list[list[Value]]:
    high, wide = sheet.total_height, sheet.total_width
    if high * wide > SHEET_CELLS or wide > TABLE_COLUMNS:
        found = f"{high:,} rows of {wide:,} cells in sheet {shown(name)}"
        raise _refused(found, path, f"at most {SHEET_CELLS:,} cells and {TABLE_COLUMNS} columns")
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
        raise _refused("a locked workbook", path, advice="Save it without a password.") from None
    except (python_calamine.CalamineError, OSError, ValueError) as why:
        raise _refused(f"a broken workbook ({shown(why, 200)[1:-1]})", path) from None
    except BaseException as why:  # a panic of the reader in Rust is no Exception
        if type(why).__name__ != "PanicException":
            raise
        raise _refused(f"a broken workbook ({shown(why, 200)[1:-1]})", path) from None
    return out


def _is_number(value: Value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_date(value: Value) -> bool:
    return isinstance(value, (datetime.date, datetime.time, datetime.timedelta))


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
        raise InputError(f"no sheet {shown(options.sheet)}", f"one of {known}", file=path)
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
        raise InputError("no rows of numbers", "a table", file=path)
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
    above: list[Row] = []
    for i in range(begin - 1, max(begin - 12, -1), -1):
        cells = [_text(v) for v in rows[i]]
        if any(cells) and (len(above) < 3 or i + 1 in (options.header, options.units)):
            above.insert(0, (i + 1, cells))
    for wanted in (options.header, options.units):
        if wanted > 0 and wanted not in [n for n, _ in above]:
            raise input_error("tables.no_names_in_row", path, wanted=wanted, begin=begin + 1)
    return read_head(above, len(rows[0]), PLAIN, numbers, options.header, options.units)


def _kept(
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
    dates = [i for i, v in enumerate(column) if _is_date(v)]
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
        found = {"": "no workbook", "locked": "a locked workbook", "xlsb": "a binary workbook (xlsb)"}[kind]
        raise _refused(
            found,
            path,
            "an xlsx, xls or ods file",
            {"locked": "Save it without a password.", "xlsb": "Save it as xlsx."}.get(kind, ""),
        )
    if path.stat().st_size > SHEET_BYTES:
        raise _refused(f"{path.stat().st_size:,} bytes", path, f"at most {SHEET_BYTES:,}", "Save the table as CSV.")
    errors = _checked(path, kind)
    read = {name: _read_texts(rows) for name, rows in _sheets(path, given.sheet).items()}
    sheets = {name: rows for name, (rows, _) in read.items()}
    name = _chosen(sheets, given, path)
    rows = sheets[name]
    begin, head = _body(rows, given, path)
    selected, left, titles = _kept(rows, begin, head, given, path)
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

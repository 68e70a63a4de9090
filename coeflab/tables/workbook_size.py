"""What a workbook unpacks to, by itself and not by what it says: refused before the reader holds it in memory."""

from __future__ import annotations

import re
import struct
import zipfile
import zlib
from collections.abc import Iterator, Sequence
from lzma import LZMAError
from pathlib import Path
from xml.parsers import expat

from coeflab.core.errors import shown
from coeflab.core.limits import SHEET_BYTES, SHEET_CELLS, SHEET_UNPACKED
from coeflab.core.text.bounded import part_of, whole_bytes
from coeflab.core.texts import input_error

_PLACE = re.compile(rb"""<(?:\w+:)?(?:c|row)\s(?:[^>]*?\s)?r\s*=\s*["']([^"'>]*)["']""")
_PLACED = re.compile(rb"([A-Z]{0,3})([0-9]{1,7})")
_ERROR = re.compile(rb"""<c\b(?=[^>]*\st\s*=\s*["']e["'])[^>]*\sr\s*=\s*["']([A-Z]+[0-9]+)["']""")
_ODS = re.compile(rb"<table:(?:table-row|table-cell|covered-table-cell|table)\b[^>]*>")
_REPEATED = re.compile(rb"""table:number-(?:rows|columns)-repeated\s*=\s*["']([0-9]+)["']""")
_CHUNK = 1 << 20
_BROKEN = (
    LookupError, expat.ExpatError, zipfile.BadZipFile, zlib.error, LZMAError, EOFError, ValueError, RuntimeError, struct.error
)  # fmt: skip


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


def errors_in(path: Path, kind: str) -> list[str]:
    """Refuse a workbook that unpacks to more than memory holds, whatever its directory says; remarks on errors in cells."""
    cells, blank = 0, list[str]()
    try:
        if kind == "xls":
            cells = _cells_of_xls(whole_bytes(path, SHEET_BYTES))
        else:
            with zipfile.ZipFile(path) as packed:
                _require_little(packed, path)
                _require_whole_xml(packed)
                if kind == "ods":
                    cells = _cells_of_ods(packed)
                for part in packed.namelist() if kind != "ods" else ():
                    many, errors = _scan_of_xlsx(packed, part)
                    cells += many
                    blank += [f"{place} of {part.rpartition('/')[2]}" for place in errors]
    except (*_BROKEN, OSError) as why:
        raise input_error("tables.broken_workbook", path, why=shown(why, 200)[1:-1]) from None
    if cells > SHEET_CELLS:
        raise input_error(
            "tables.cells_of_workbook", path, cells=cells, most_bytes=SHEET_UNPACKED, most_cells=SHEET_CELLS
        )
    if not blank:
        return []
    return [f"{len(blank)} cell{'s' * (len(blank) > 1)} with an error such as #DIV/0!, first {blank[0]}; read as blank"]


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


def _require_little(packed: zipfile.ZipFile, path: Path) -> None:
    """Refuse a workbook that unpacks to too much, by its directory or by itself."""
    left = SHEET_UNPACKED
    if (size := sum(part.file_size for part in packed.infolist())) > left:
        raise input_error("tables.size_of_workbook", path, size=size, most_bytes=SHEET_UNPACKED, most_cells=SHEET_CELLS)
    for part in packed.infolist():
        with part_of(packed, part) as stream:
            while piece := stream.read(_CHUNK):
                left -= len(piece)
                if left < 0:
                    raise input_error(
                        "tables.workbook_beyond_directory",
                        path,
                        part=shown(part.filename),
                        most_bytes=SHEET_UNPACKED,
                        most_cells=SHEET_CELLS,
                    )

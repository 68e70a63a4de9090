"""Lists of points in JSON: objects with the same keys, or one object of lists of one length; nested objects by their path."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.limits import JSON_BYTES, LARGEST_NUMBER, TABLE_COLUMNS
from coeflab.core.options import NoOptions, parse_options
from coeflab.core.text.bounded import whole_bytes
from coeflab.core.text.json import parse_json
from coeflab.core.texts import input_error
from coeflab.tables.dialect import Marks, name_and_unit, names_and_units
from coeflab.tables.monitor_files import head
from coeflab.tables.raw_table import RawColumn, RawTable, Stated
from coeflab.tables.words.above import words_above

summary = "lists of points in JSON, a row an object or a list a column"
reads = "JSON with a list of points"
citations = ()
_DEEPEST = 4
Points = list[dict[str, Any]]


def recognises(path: Path) -> bool:
    """Whether a file is JSON that holds a list of points."""
    start = head(path).lstrip(b"\xef\xbb\xbf \t\r\n")
    if not start.startswith((b"[", b"{")):
        return False
    try:
        return bool(_points(_content(path))[0])
    except InputError:
        return False


def raw(path: Path, options: Mapping[str, Any]) -> RawTable:
    """The points as a table.

    Parameters
    ----------
    path : Path
    options : mapping
        None are known.

    Raises
    ------
    InputError
        No JSON, no list of points, or too many keys.
    """
    parse_options(NoOptions, options, "importers.json")
    points, above = _points(_content(path))
    if not points:
        raise input_error("tables.no_points", path)
    names = list(dict.fromkeys(name for point in points for name in point))
    if len(names) > TABLE_COLUMNS:
        raise InputError(f"{len(names)} keys", f"at most {TABLE_COLUMNS}", file=path)
    remarks = [
        f"key {shown(n)}: lacks in {lacks} of {len(points)} points"
        for n in names
        if (lacks := sum(n not in p for p in points))
    ]
    stated = words_above(((1, [f"{key} = {value}"]) for key, value in above.items()), Marks())
    stated = {
        key: Stated(one.value, one.place.replace("line 1", path.name), one.offered, one.contradicted)
        for key, one in stated.items()
    }
    split = [name_and_unit(name) for name in names]
    split = split if any(unit for _, unit in split) else names_and_units(names)
    columns = tuple(
        _column(*own, [point.get(name) for point in points]) for name, own in zip(names, split, strict=True)
    )
    return RawTable(
        path,
        columns,
        files=(path,),
        dialect={"format": "JSON", "points": str(len(points))},
        stated=stated,
        remarks=tuple(remarks),
    )


def _content(path: Path) -> Any:
    try:
        return parse_json(whole_bytes(path, JSON_BYTES).decode("utf-8-sig"), path, "a list of points")
    except UnicodeDecodeError:
        raise InputError("another encoding", "UTF-8", file=path) from None


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST_NUMBER


def _flat(point: Mapping[str, Any], before: str = "", depth: int = 0) -> Iterator[tuple[str, Any]]:
    """Keys with numbers and texts, those of objects by their path: ``forces X``; of three numbers x, y and z."""
    for key, value in point.items():
        name = f"{before} {key}".strip()
        if isinstance(value, Mapping) and depth < _DEEPEST:
            yield from _flat(value, name, depth + 1)
        elif isinstance(value, list) and len(value) == 3 and all(map(_is_number, value)):
            yield from ((f"{name.removesuffix('s')} {axis}", number) for axis, number in zip("xyz", value, strict=True))
        elif value is None or isinstance(value, str | bool | int | float):
            yield name, value


def _points(content: Any) -> tuple[Points, dict[str, Any]]:
    """The longest list of objects with numbers, or of one object the lists of one length; and the values beside it."""
    found, above = list[Any](), dict[str, Any]()
    waiting: list[tuple[Any, int]] = [(content, 0)]
    while waiting:
        value, depth = waiting.pop()
        if isinstance(value, list) and all(isinstance(v, Mapping) for v in value) and len(value) > len(found):
            found = value
        if not isinstance(value, Mapping):
            continue
        lists = {
            k: v
            for k, v in value.items()
            if isinstance(v, list) and len(v) > 1 and all(_is_number(x) or x is None or isinstance(x, str) for x in v)
        }
        sizes = {len(v) for v in lists.values()}
        if len(lists) > 1 and len(sizes) == 1 and sizes.pop() > len(found):
            found = [dict(zip(lists, row, strict=True)) for row in zip(*lists.values(), strict=True)]
        members = [v for v in value.values() if isinstance(v, Mapping)]
        if len(members) == len(value) > max(len(found), 2) and len({tuple(m) for m in members}) == 1:
            found = [{"name": k, **m} for k, m in value.items()]
        above |= {k: v for k, v in value.items() if _is_number(v) or isinstance(v, str)} if depth < _DEEPEST else {}
        waiting += [(v, depth + 1) for v in value.values()] if depth < _DEEPEST else []
    points: Points = _short([dict(_flat(one)) for one in found])
    return (points if any(_is_number(v) for p in points for v in p.values()) else []), above


def _short(points: Points) -> Points:
    """The points with the last word of a path for its name where it is the only one that ends so."""
    paths = dict.fromkeys(name for point in points for name in point)
    ends = [name.rpartition(" ")[2] for name in paths]
    alone = {
        name: end if ends.count(end) == 1 and end not in "xyz" else name for name, end in zip(paths, ends, strict=True)
    }
    return [{alone[name]: value for name, value in point.items()} for point in points]


def _column(name: str, unit: str, cells: Sequence[Any]) -> RawColumn:
    values = np.array([float(c) if _is_number(c) else np.nan for c in cells])
    texts = (
        tuple("" if c is None else str(c) for c in cells)
        if any(not (c is None or _is_number(c)) for c in cells)
        else ()
    )
    return RawColumn(name, unit, values, texts)

"""Blocks of rows one below the other under one head: what the title of each says of its condition becomes columns."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from coeflab.core.units import factor, fits
from coeflab.tables.column_map import DIMENSIONS, ROLES, SETTINGS, read_column_map
from coeflab.tables.column_names import named_as
from coeflab.tables.dialect import Marks, one_reading
from coeflab.tables.raw_table import RawColumn, RawTable, Stated
from coeflab.tables.vocabulary import vocabulary

BLOCK = "block"
_SETTING = re.compile(
    r"(?P<name>[^\W\d_][^\d=:;,()\[\]]{0,40}?)?\s*(?:[(\[](?P<before>[^()\[\]]{1,8})[)\]])?\s*[=:]?\s*(?P<number>[-+\u2212]?\d+(?:[.,]\d+)?)"
    r"\s*[(\[]?(?P<unit>m/s|km/h|kn|kts|knots|deg/s|rad/s|deg(?:rees?)?|\xb0|rad|mm|m)?(?![^\W_])"
)
_SPEEDS = ("u", "v", "vm", "vs", "speed")
_LONGEST = 300


@dataclass(frozen=True, slots=True)
class Title:
    """Words over rows.

    Attributes
    ----------
    row : int
        The first row below it.
    line : int
    text : str
    """

    row: int
    line: int
    text: str


def settings_in(text: str, marks: Marks) -> Iterator[tuple[str, float, str]]:
    """Settings that a title states, with number and unit: ``U``, 1.5, ``m/s`` of "Test B, speed 1.5 m/s"."""
    for m in _SETTING.finditer(text[:_LONGEST]):
        unit = vocabulary().units.get((m["unit"] or m["before"] or "").casefold(), m["unit"] or m["before"] or "")
        words = (m["name"] or "").strip(" -_").split()
        names = [" ".join(words), *words[-1:]] if words else []
        found = next((f for n in names if (f := "U" if n.casefold() in _SPEEDS else named_as(n))), "")
        found = found or ("U" if unit in ("m/s", "kn", "km/h") else "")
        if not found or ROLES[read_column_map(found).name] not in SETTINGS:
            continue
        number = one_reading(m["number"].replace("\u2212", "-"), marks)
        if number is not None and fits(unit, DIMENSIONS[found]):
            yield found, number, unit


def with_blocks(raw: RawTable, titles: Sequence[Title], marks: Marks) -> RawTable:
    """The table with a label of its blocks and the settings that their titles state; as it is where it is one block.

    Parameters
    ----------
    raw : RawTable
    titles : sequence of Title
        In order; those of row 0 stand over the table.
    marks : Marks
        Of the numbers.
    """
    later = [t for t in titles if 0 < t.row < len(raw)]
    if not later:
        return raw
    starts = sorted({0, *(t.row for t in later)})
    texts: list[str] = []
    values: dict[str, tuple[str, np.ndarray]] = {}
    for begin, end in zip(starts, [*starts[1:], len(raw)], strict=True):
        own = [t for t in titles if t.row == begin]
        texts += [" ".join(" ".join(t.text for t in own[-1:]).split()) or f"rows from {begin + 1}"] * (end - begin)
        for name, number, unit in (one for t in own for one in settings_in(t.text, marks)):
            first = values.setdefault(name, (unit, np.full(len(raw), np.nan)))
            first[1][begin:end] = number * factor(unit, DIMENSIONS[name]) / factor(first[0], DIMENSIONS[name])
    words = {named_as(c.name) or c.name for c in raw.columns}
    more = [RawColumn(name, unit, column) for name, (unit, column) in values.items() if name not in words]
    stated: dict[str, Stated] = {k: s for k, s in raw.stated.items() if k != "conditions.speed" or "U" not in values}
    places = ", ".join(str(t.line) for t in later)
    return replace(
        raw, columns=(*raw.columns, *more, RawColumn(BLOCK, "", np.full(len(raw), np.nan), tuple(texts), "label")), stated=stated,
        remarks=(*raw.remarks, f"blocks below each other, new ones from line {places}: label {BLOCK}"
                 + f", {', '.join(c.name for c in more)} by their titles" * bool(more)),
    )  # fmt: skip

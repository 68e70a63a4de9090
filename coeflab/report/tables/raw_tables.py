"""A file before it is a campaign: its columns with what they may be, and what it says of itself."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.core.table import Table
from coeflab.report.printable import shortened
from coeflab.report.texts import table_of
from coeflab.tables.mapping import known_as

if TYPE_CHECKING:
    from coeflab.tables.column_map import ColumnMap
    from coeflab.tables.evidence import Evidence
    from coeflab.tables.proposals import Proposal
    from coeflab.tables.raw_table import RawColumn, RawTable, Run

NAME, UNIT = 20, 8
MANY = 20  # columns, beyond which those that no fit uses stand in a note


def limits(column: RawColumn) -> str:
    """Smallest and largest number of a column, or how many texts it has."""
    ok = column.values[np.isfinite(column.values)]
    blank = len(column.values) - ok.size
    if not ok.size:
        return f"{len(set(column.texts))} texts" if column.texts else "blank"
    low, high = float(ok.min()) + 0.0, float(ok.max()) + 0.0
    out = f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
    return f"{out}, {blank} blank" if blank else out


def columns(raw: RawTable, proposed: Sequence[Proposal], known: Mapping[str, ColumnMap] | None = None) -> Table:
    """Every column that is used, with its unit, range and what it is, or may be.

    Parameters
    ----------
    raw : RawTable
    proposed : sequence of Proposal
        One a column.
    known : mapping of str to ColumnMap, optional
        What is settled.
    """
    rows, unused = [], []
    for column, proposal in zip(raw.columns, proposed, strict=True):
        settled = next((str(known[n]) for n in (column.name, *known_as(column)) if known and n in known), "")
        text = settled or (f"{proposal.text}?" if proposal.whole and not proposal.certain else proposal.text)
        if text == "ignore" and len(raw.columns) > MANY:
            unused.append(column.name)
            continue
        rows.append((shortened(column.name, NAME), shortened(column.unit, UNIT), limits(column), text or "?"))
    notes = ("? what nobody has confirmed",) if any(row[3].endswith("?") or "?" in row[3] for row in rows) else ()
    if unused:
        notes = (*notes, *textwrap.wrap(f"{len(unused)} not used by fits: {', '.join(unused)}", 76))
    return table_of("raw_tables.columns", rows, notes, raw=len(raw), columns=len(raw.columns))


def by_format(raw: RawTable, proposed: Sequence[Proposal]) -> str:
    """Columns that fits use, and those of zeros throughout, in a sentence."""
    used = [
        c
        for c, one in zip(raw.columns, proposed, strict=True)
        if one.text not in ("ignore", "label", "uncertain", "point")
    ]
    zeros = [c.name for c in used if not np.any(np.nan_to_num(c.values))]
    known = f"{len(raw)} rows of {', '.join(c.name for c in used if c.name not in zeros)}"
    return f"{known}; zeros throughout: {', '.join(zeros)}." if zeros else f"{known}."


def of_run(run: Run) -> tuple[Table, ...]:
    """One run: its conditions with their places, and the columns of its history."""
    words = [(name, _text(s.value), shortened(s.place, 40)) for name, s in run.conditions.items()]
    rows = tuple((shortened(c.name, 34), shortened(c.unit, UNIT), limits(c), c.means) for c in run.history.columns)
    return (
        table_of("raw_tables.of_run_1", words),
        table_of("raw_tables.of_run_2", rows, history=len(run.history)),
    )


def as_json(raw: RawTable, importer: str, proposed: Sequence[Proposal], shows: Sequence[Evidence]) -> dict[str, Any]:
    """All that is shown of a file, for machines.

    Parameters
    ----------
    raw : RawTable
    importer : str
    proposed : sequence of Proposal
    shows : sequence of Evidence
    """
    described = []
    for column, proposal in zip(raw.columns, proposed, strict=True):
        ok = column.values[np.isfinite(column.values)]
        described.append({
            "name": column.name, "unit": column.unit, "text": column.is_text, "numbers": int(ok.size),
            "low": float(ok.min()) if ok.size else None, "high": float(ok.max()) if ok.size else None,
            "proposed": proposal.text, "certain": proposal.certain, "why": proposal.why,
        })  # fmt: skip
    words = {
        key: {"value": list(s.value) if isinstance(s.value, tuple) else s.value, "place": s.place, "offered": s.offered}
        for key, s in raw.stated.items()
    }
    return {
        "path": str(raw.path), "importer": importer, "rows": len(raw), "dialect": dict(raw.dialect), "columns": described,
        "stated": words, "remarks": list(raw.remarks), "shows": [e.text for e in shows],
    }  # fmt: skip


def stated(raw: RawTable) -> Table:
    """What the file says of keys of campaign.toml, with its places."""
    rows = tuple(
        (key, shortened(_text(s.value), 24) + "?" * s.offered, shortened(s.place, 36)) for key, s in raw.stated.items()
    )
    notes = ("? words over the table, to be confirmed",) if any(s.offered for s in raw.stated.values()) else ()
    return table_of("raw_tables.stated", rows, notes)


def _text(value: object) -> str:
    if isinstance(value, tuple):
        return "[" + ", ".join(f"{x:g}" for x in value) + "]"
    return f"{value:g}" if isinstance(value, float) else str(value)

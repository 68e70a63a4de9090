"""Force tables as they are shown: every row in SI and FRD, and the rows that no fit uses."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.table import Table, number
from coeflab.core.wording import collected, in_sentences
from coeflab.study.towed import STATES
from coeflab.tables.force_table import ForceTable


def _of(components: Sequence[str], table: ForceTable) -> str:
    whole = "" in components or (len(components) > 1 and set(components) >= set(table.forces))
    return "row" if whole else " ".join(components)


def unused_rows(table: ForceTable) -> list[str]:
    """Every row, or component of one, that no fit uses, by the reason."""
    out = []
    for reason, found in collected((e.reason, (e.row, e.component)) for e in table.exclusions).items():
        rows = collected(found)
        names = [
            table.labels[row] + (f" {of}" if (of := _of(list(dict.fromkeys(c)), table)) != "row" else "")
            for row, c in rows.items()
        ]
        out.append(f"{', '.join(names)}: {reason}")
    return out


NAMED = 12  # rows that a line names; of more the first


def unused(tables: Sequence[ForceTable]) -> str:
    """In one line the rows that no fit uses, or not whole, because their source or the state of their run says so; empty without such."""
    by: dict[str, list[str]] = {}
    parts = False
    files = [t.name.rpartition("/")[2] for t in tables]
    campaigns = [t.campaign for t in tables]
    short = {
        t.name: file if files.count(file) == 1 else t.campaign if campaigns.count(t.campaign) == 1 else t.name
        for t, file in zip(tables, files, strict=True)
    }
    for t in tables:
        for row, found in collected((e.row, e) for e in t.exclusions if e.of_source).items():
            components = list(dict.fromkeys(e.component for e in found))
            of = "row" if set(components) >= set(t.forces) else _of(components, t)
            first = found[0]
            kind = first.status or ("marked uncertain in the file" if first.uncertain else first.reason)
            name = t.labels[row] + f" of {short[t.name]}" * (len(tables) > 1)
            parts |= of != "row"
            by.setdefault(kind, []).append(name if of == "row" else f"{name} {of}")
    phrases = [
        f"{', '.join(rows[:NAMED])}{f' and {len(rows) - NAMED} more' * (len(rows) > NAMED)}: {STATES.get(why, why).replace(': ', ', ')}"
        for why, rows in by.items()
    ]
    what = "Readings left out (point, components)" if parts else "Points left out"
    return in_sentences(f"{what}: ", phrases) if phrases else ""


def inspected(table: ForceTable, most: int = 0) -> Table:
    """What a force table holds, row by row, in SI and FRD; of more than ``most`` rows the first and last."""
    motions = [m for m in ("u", "v", "w", "p", "q", "r") if m == "u" or m in table.varies]
    headers = ["", *(f"{m} [{'m/s' if m in 'uvw' else 'rad/s'}]" for m in motions)]
    headers += [f"{c} [rad]" for c in table.controls]
    headers += [f"{c} [{'N*m' if c in 'KMN' else 'N'}]" for c in table.forces]
    rows = []
    left_out = range(most - most // 3, len(table) - most // 3) if 0 < most < len(table) else range(0)
    for i in (i for i in range(len(table)) if i not in left_out):
        cells = [table.labels[i], *(number(float(table.motion[m][i]), 5) for m in motions)]
        cells += [number(float(a[i]), 4) for a in table.controls.values()]
        for c, values in table.forces.items():
            text = number(float(values[i]), 5)
            cells.append(text if table.usable[c][i] else f"({text})")
        rows.append(tuple(cells))
    excluded = []
    for (row, line), found in collected(((e.row, e.line), (e.reason, e.component)) for e in table.exclusions).items():
        reasons = collected(found)
        place = table.labels[row] + f" (line {line})" * (table.labels.count(table.labels[row]) > 1)
        phrases = "; ".join(f"{_of(components, table)}: excluded, {reason}" for reason, components in reasons.items())
        excluded.append(f"{place}, {phrases}")
    notes = [
        *excluded[: most or None],
        *([f"{len(excluded) - most} more are excluded"] if 0 < most < len(excluded) else []),
    ]
    if left_out:
        notes.insert(0, f"{len(left_out)} of {len(table)} rows are not shown; --rows 0 shows all")
    spare = (headers[1],) if len(motions) > 1 or table.controls else ()
    return Table(
        f"{table.name}: SI, FRD",
        tuple(headers),
        tuple(rows),
        (*(["(...) excluded from fits"] if excluded else ()), *notes),
        frozenset({0}),
        spare,
    )

"""Tables whose conditions stand in columns and whose quantities in rows: turned, whatever file they are from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coeflab.tables.column_map import ROLES, SETTINGS, read_column_map
from coeflab.tables.column_names import named_as
from coeflab.tables.dialect import is_unit, name_and_unit, unit_in_words
from coeflab.tables.raw_table import RawColumn, RawTable


def upright(raw: RawTable) -> RawTable:
    """The table with a row a condition; as it is where its columns are quantities already.

    Turned where the names of its columns are no force, and the texts of its first column name a force and a setting. A second
    column of texts that are units gives those.

    Parameters
    ----------
    raw : RawTable
    """
    first = raw.columns[0] if raw.columns else None
    if first is None or not first.is_text or "force" in _roles([c.name for c in raw.columns]):
        return raw
    names = [" ".join(t.split()) for t in first.texts]
    found = _roles([name_and_unit(n)[0] for n in names])
    if "force" not in found or found.isdisjoint(SETTINGS):
        return raw
    rest = list(raw.columns[1:])
    units = [c for c in rest if c.is_text and not np.any(np.isfinite(c.values)) and any(map(_unit, c.texts))][:1]
    cases = [c for c in rest if c not in units]
    columns = [RawColumn("case", "", np.full(len(cases), np.nan), tuple(c.name for c in cases))]
    seen: dict[str, int] = {}
    for i, name in enumerate(names):
        own, unit = name_and_unit(name)
        if not unit:
            own, unit = unit_in_words(name)
        unit = _unit(units[0].texts[i]) if units and not unit else unit
        values = np.array([c.values[i] for c in cases])
        texts = tuple(c.texts[i] if c.is_text else f"{c.values[i]:.12g}" for c in cases)
        seen[own] = seen.get(own, 0) + 1
        label = own if seen[own] == 1 else f"{own} ({seen[own]})"
        is_text = not np.any(np.isfinite(values))
        columns.append(RawColumn(label or f"row {i + 1}", unit, values, texts if is_text else ()))
    selected = tuple(c for c in columns if c.texts or np.any(np.isfinite(c.values)))
    return replace(
        raw, columns=selected, lines=np.empty(0, dtype=np.int64), row_labels=(),
        dialect={**raw.dialect, "turned": "conditions stand in its columns"},
    )  # fmt: skip


def _roles(names: list[str]) -> set[str]:
    known = [read_column_map(n).name for name in names if (n := named_as(name))]
    return {ROLES[name] for name in known}


def _unit(text: str) -> str:
    """A unit in brackets or without; empty where it is none."""
    bare = text.strip().strip("[]()").strip()
    return bare if bare and is_unit(bare) else ""

"""Columns of a file that no fit uses and on which a slope depends: a propeller rate, an advance ratio, a trim."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.finding import Finding, Severity
from coeflab.core.texts import words
from coeflab.core.types import Array
from coeflab.tables.column_map import PROPELLER
from coeflab.tables.evidence import Evidence
from coeflab.tables.force_table import AT_REST
from coeflab.tables.levels import APART, MOST_LEVELS, SHARE, levels_of, slopes_by_level
from coeflab.tables.mapping import Assigned, at_higher_mach, usable_rows
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.vocabulary import folded, vocabulary

SHOWN = 5  # levels in a warning
LEVEL, UPRIGHT = ("Y", "N", "side"), ("Z", "M", "lift")  # forces of motions in the horizontal and in the vertical plane
SWEPT = dict.fromkeys(("beta", "v", "r", "dr"), LEVEL) | dict.fromkeys(("alpha", "w", "q", "ds", "db"), UPRIGHT)


def slopes_by_idle_columns(raw: RawTable, columns: Sequence[Assigned]) -> Iterator[Evidence]:
    """A warning for each slope that depends on the level of a column that is no setting of the table; one of each column.

    Parameters
    ----------
    raw : RawTable
    columns : sequence of Assigned
    """
    settings = {c.meaning.name: c for c in columns if c.meaning.name in SWEPT and not c.meaning.error}
    speed = next((c.values for c in columns if c.meaning.role == "speed"), None)
    used = {c.column.name for c in columns if c.meaning.name not in ("label", "point", "uncertain", *PROPELLER)}
    mach = at_higher_mach(raw, columns)[0]
    if mach:
        yield Evidence(f"rows above the lowest {mach} are left out, as a prime holds at one; {mach}=label takes all")
    used |= {c.column.name for c in columns if c.meaning.name == "label" and c.meaning.unit}
    rows = np.isin(np.arange(len(raw)), usable_rows(raw, columns))
    used |= {mach, *(c.name for c in raw.columns if c.is_text and vocabulary().columns.get(folded(c.name)) == "ignore")}
    for idle in (c for c in raw.columns if c.name not in used and not c.means):
        names, codes = np.unique(idle.texts, return_inverse=True) if idle.is_text else ((), idle.values)
        most = max(len(names) + 1, MOST_LEVELS)  # words are levels however many they are
        if _has_levels(numbers := replace(idle, values=codes.astype(float)), speed, most):
            yield from _by_column(numbers, [*names], settings, columns, speed, rows)


def _has_levels(column: RawColumn, speed: Array | None, most: int) -> bool:
    """Whether a column has a few levels, other than those of the speed, each of hardly any width: a result of the rows has none."""
    if not np.all(np.isfinite(column.values)) or not len(column.values):
        return False
    own = levels_of(column.values)
    if not 1 <= own.max() < most:
        return False
    if max(np.ptp(column.values[own == k]) for k in range(own.max() + 1)) > APART * np.abs(column.values).max():
        return False
    return (
        speed is None
        or len({*zip(own.tolist(), levels_of(speed).tolist(), strict=True)}) > own.max() + 1
        or bool(np.ptp(speed) == 0.0)
    )


def _by_column(
    idle: RawColumn,
    names: Sequence[str],
    settings: dict[str, Assigned],
    columns: Sequence[Assigned],
    speed: Array | None,
    rows: NDArray[np.bool_],
) -> Iterator[Evidence]:
    for name, swept in settings.items():
        others = [np.abs(np.nan_to_num(c.values)) <= AT_REST for n, c in settings.items() if n != name]
        alone = np.logical_and.reduce([*others, rows])
        for force in (c for c in columns if c.meaning.role == "force" and c.meaning.name in SWEPT[name]):
            y = force.values if force.meaning.pure or speed is None else force.values / speed**2
            found = slopes_by_level(swept.values[alone], y[alone], idle.values[alone], max(len(names), MOST_LEVELS))
            if found is not None and (found.depends or found.offsets > SHARE):
                levels = [str(names[round(v)]) if len(names) else f"{v:.6g}" for v in found.levels]
                kind, size = ("slope", found.spread) if found.depends else ("offset", found.offsets)
                given = words(Finding.of(
                    "levels.column", "table", Severity.WARN, statistic=size, threshold=SHARE, symbol=f"the {kind} of {force.meaning.name} over {name}", kind=kind,
                    advice=f'--map "{idle.name}=label [{levels[0]}]"',
                    slopes=tuple(f"{s:.3g}" for s in found.slopes[:SHOWN]), column=idle.name,
                    levels=tuple(v if len(names) else f"{float(v):.4g}" for v in levels[:SHOWN]),
                ))  # fmt: skip
                yield Evidence(f"{given.statement}. {given.advice}", warns=True)
                return

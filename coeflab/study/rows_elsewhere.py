"""Rows of a force table in each other's place: pairs of one sweep, and rows of a grid study that suit another row than the one in use."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from coeflab.core.finding import Finding, Severity
from coeflab.core.types import Array
from coeflab.fits.statistics import origin_slope
from coeflab.fits.statistics.data_gate import Gate
from coeflab.fits.statistics.exchanged_rows import exchanged
from coeflab.law.symbols import primed
from coeflab.study.table_sweeps import Sweep, setting_in_words, sweeps_of
from coeflab.tables.force_table import ForceTable

APART, NEARER = 0.05, 3.0  # of the largest reading; how much nearer another row is
NOTHING = 0.01  # of the largest primed force or moment: a component below it is next to nothing


class Slope(NamedTuple):
    """A slope at the origin that the table gives: its rows of the table, points and value."""

    symbol: str
    rows: NDArray[np.intp]
    x: Array
    y: Array
    se: Array | None
    value: float
    u95: float

    def with_exchanged(self, rows: tuple[int, int]) -> origin_slope.OriginSlope | None:
        """The estimate with two rows exchanged; None where it has not both."""
        at = [int(k[0]) for row in rows if len(k := np.flatnonzero(self.rows == row)) == 1]
        if len(at) != 2:
            return None
        y, se = np.array(self.y), None if self.se is None else np.array(self.se)
        for column in (y, *([] if se is None else [se])):
            column[at] = column[at[::-1]]
        return origin_slope.estimate(self.x, y, se)


@dataclass(frozen=True, slots=True)
class Exchanged:
    """Two rows of a table, and what is found of them."""

    rows: tuple[int, int]
    finding: Finding

    @classmethod
    def of(
        cls, table: ForceTable, sweep: Sweep, components: Sequence[str], places: tuple[int, int], held: tuple[float, float],
        slopes: Sequence[Slope],
    ) -> Exchanged:  # fmt: skip
        """The finding, with the slope that the exchange moves most."""
        rows = int(sweep.rows[places[0]]), int(sweep.rows[places[1]])
        moved = []
        for s in slopes:
            other = s.with_exchanged(rows) if s.symbol[0] in components else None
            if other is not None and np.isfinite(s.value) and np.isfinite(other.value):
                moved.append((abs(s.value - other.value) / max(other.u95, 1e-300), s, other))
        facts: dict[str, Any] = {"moves": "none"}
        if moved:
            _, s, other = max(moved, key=lambda m: m[0])
            facts = {"moves": "some", "symbol": primed(s.symbol), "value": s.value, "u95": s.u95, "exchanged": other.value,
                     "exchanged_u95": other.u95}  # fmt: skip
        return cls(
            rows,
            Finding.of(
                "data_gate.exchanged_rows", _where(table, rows), Severity.WARN, statistic=held[0], threshold=held[1],
                settings=tuple(setting_in_words(sweep.variable, sweep.x[k]) for k in places), components=tuple(components), **facts,
            ),
        )  # fmt: skip


def _where(table: ForceTable, rows: Sequence[int]) -> str:
    names = [str(table.lines[i]) if table.lines else table.labels[i] for i in rows]
    return f"{table.name} {'lines' if table.lines else 'rows'} {' and '.join(names)}"


def exchanged_rows(
    table: ForceTable, sweep: Sweep, gates: Mapping[str, Gate]
) -> tuple[tuple[tuple[int, int], float, float], ...]:
    """Places of pairs of a sweep in each other's place, with the log likelihood that the exchange gains and its threshold.

    Parameters
    ----------
    table : ForceTable
    sweep : Sweep
        Its rows are those of every component.
    gates : mapping of component to Gate
        Of the settings of the sweep.
    """
    readings = [table.primed_force(c, table.scaling.length)[sweep.rows] for c in gates]
    return tuple((e.rows, e.gain, e.threshold) for e in exchanged(list(gates.values()), readings))


def grid_rows_elsewhere(table: ForceTable) -> Iterator[Finding]:
    """Rows of other grids whose forces are those of another setting than their own.

    The nearest of them is held against the row in use and against every other row of the sweep, all components together, each over
    its largest reading: a warning where another row is `NEARER` times as near and the row in use is off by more than `APART`.
    """
    if table.cells is None:
        return
    used = np.all([table.usable[c] for c in table.usable], axis=0)
    setting = table.setting
    for sweep in sweeps_of(table, used):
        rows = sweep.rows
        forces = np.array([table.primed_force(c, table.scaling.length) for c in table.usable])
        size = np.abs(forces[:, rows]).max(1)
        telling = (size > NOTHING * size.max()) & (np.ptp(forces[:, rows], axis=1) > APART * size)
        if not telling.any():
            continue
        forces = forces[telling] / size[telling][:, None]
        for row in map(int, rows):
            grids = [
                int(i) for i in np.flatnonzero((setting == setting[row]) & ~used)
                if np.isfinite(table.cells[i]) and table.cells[i] != table.cells[row] and np.all(np.isfinite(forces[:, i]))
                and not (table.variants and table.variants[i])
            ]  # fmt: skip
            if not grids:
                continue
            apart = np.abs(forces[:, grids][:, :, None] - forces[:, None, rows]).max(0).min(0)
            own, nearest = float(apart[rows == row][0]), int(np.argmin(apart))
            if own > APART and apart[nearest] * NEARER < own:
                place = int(np.flatnonzero(rows == row)[0])
                yield Finding.of(
                    "data_gate.grid_rows_elsewhere", _where(table, (row, int(rows[nearest]))), Severity.WARN, statistic=own,
                    threshold=NEARER * float(apart[nearest]), setting=setting_in_words(sweep.variable, sweep.x[place]),
                    suits=setting_in_words(sweep.variable, sweep.x[nearest]),
                    grids=tuple(table.lines[i] if table.lines else table.labels[i] for i in grids),
                )  # fmt: skip

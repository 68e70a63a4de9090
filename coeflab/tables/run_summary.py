"""What one run gave: the plateau of its history, means and errors over it, and what its files say."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from coeflab.core.text.bounded import stream_of
from coeflab.core.types import brief
from coeflab.core.units import fits
from coeflab.law.symbols import COMPONENTS
from coeflab.tables.conditions import Condition
from coeflab.tables.histories import LEAST_ROWS, Convergence, is_cycle, plateau
from coeflab.tables.raw_table import Ended, RawColumn, RawTable, Run, Stated

_RESIDUAL = re.compile(
    r"resid|\brms|continuity|[xyz][- ](?:velocity|momentum)|^(?:k|omega|epsilon|energy|nut|tke|sdr|tdr)$", re.IGNORECASE
)
ENDED = {Ended.CRASHED: Convergence.CRASHED, Ended.DIVERGED: Convergence.DIVERGED, Ended.EMPTY: Convergence.EMPTY}


@brief
@dataclass(frozen=True, slots=True, eq=False)
class RunSummary:
    """What one run gave: small, however long its history.

    Attributes
    ----------
    name : str
        Path from the folder of runs, with ``/``.
    status : Convergence
    why : str
        What shows the status; empty for a converged run.
    means, errors : mapping of str to float
        Mean over the plateau and its standard error (NaN for a single row), in the units of the history, by component.
    units : mapping of str to str
    headers : mapping of str to str
        Name of the column in the history.
    by_name : bool
        The format does not say which column is which component: means and errors go by the names of the columns.
    other_columns : mapping of str to (float, str)
        Mean and unit of the columns that are none of these.
    unsure : mapping of str to bool
        As `coeflab.tables.histories.Plateau` has it.
    start : float
        Time or iteration at which the plateau begins; NaN without one.
    start_unit : str
    averaged : str
        The part of the history that the means are over, such as ``iterations 151 to 300``; empty without one.
    rows, window : int
        Of the history and of the plateau.
    iterations : float
        The last iteration where the history counts them, else the rows.
    last : float
        The last time or iteration, else the rows.
    is_cut : bool
        A file of the history ends within a line.
    stated_conditions : mapping of str to Stated
        As the files have them.
    patches : mapping of str to (float, str)
        Mean and unit by ``Y(sail)``.
    files : tuple of str
        That were read; absolute.
    dialect : mapping of str to str
    stated : mapping of str to Stated
        Keys of campaign.toml.
    remarks : tuple of str
    conditions : mapping of str to Condition
        From all origins.
    """

    name: str
    status: Convergence
    why: str = ""
    means: Mapping[str, float] = field(default_factory=dict)
    errors: Mapping[str, float] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    headers: Mapping[str, str] = field(default_factory=dict)
    by_name: bool = False
    other_columns: Mapping[str, tuple[float, str]] = field(default_factory=dict)
    unsure: Mapping[str, bool] = field(default_factory=dict)
    start: float = math.nan
    start_unit: str = ""
    averaged: str = ""
    rows: int = 0
    window: int = 0
    iterations: float = math.nan
    last: float = math.nan
    is_cut: bool = False
    stated_conditions: Mapping[str, Stated] = field(default_factory=dict)
    patches: Mapping[str, tuple[float, str]] = field(default_factory=dict)
    files: tuple[str, ...] = ()
    dialect: Mapping[str, str] = field(default_factory=dict)
    stated: Mapping[str, Stated] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    conditions: Mapping[str, Condition] = field(default_factory=dict)


def summarised(run: Run, name: str, *, steady: bool = False) -> RunSummary:
    """The plateau of a run, its means and errors, and what its files say.

    Parameters
    ----------
    run : Run
    name : str
        Under which it is listed.
    steady : bool
        Of a solver that is known to be steady: no error is below what the range of its iterations allows. Of others that holds
        for iterations that end in a cycle, see `coeflab.tables.histories.is_cycle`.
    """
    history = run.history
    tables = (history, *run.patches.values())
    common = RunSummary(
        name=name,
        status=ENDED.get(run.ended, Convergence.CONVERGED),
        why=run.why,
        rows=len(history),
        stated_conditions=dict(run.conditions),
        files=tuple(dict.fromkeys(str(f.absolute()) for t in tables for f in (t.files or (t.path,)))),
        dialect=dict(history.dialect),
        stated=dict(history.stated),
        remarks=history.remarks,
    )
    at = history.meaning("time") or history.meaning("iteration")
    if at is not None and at.means == "iteration" and len(at.values):
        common = replace(common, iterations=float(at.values[-1]))
    else:
        common = replace(common, iterations=float(len(history)))
    last = float(at.values[-1]) if at is not None and len(at.values) else common.iterations
    common = replace(common, last=last, is_cut=any(map(_ends_within_a_line, history.files or (history.path,))))
    if run.ended in ENDED:
        return common
    columns, by_name = deciding(history)
    if not columns:
        return replace(common, status=Convergence.EMPTY, why="no column of a force or moment")
    if is_final_value(run, at):
        return _of_last_row(common, run, columns, by_name, at)
    times = at.values if at is not None and at.means == "time" else None
    groups = {name: column.unit for name, column in columns.items()} if by_name else None
    found = plateau(
        {name: column.values for name, column in columns.items()}, times, groups, 0.0 if by_name else run.length
    )
    if not found.status.has_numbers:
        return replace(common, status=found.status, why=found.why)
    start = float(at.values[found.start]) if at is not None else float(found.start)
    counted = at is not None and at.means == "iteration"
    used = {id(at), *map(id, columns.values())}
    others = [c for c in history.columns if id(c) not in used and not c.is_text and not _RESIDUAL.search(c.name)]
    return replace(
        common,
        status=found.status,
        why=found.why,
        means={c: m.value for c, m in found.means.items()},
        errors={
            c: m.steady_error if steady or (counted and is_cycle(columns[c].values[found.start :])) else m.error
            for c, m in found.means.items()
        },
        units={c: k.unit for c, k in columns.items()},
        headers={c: k.name for c, k in columns.items()},
        by_name=by_name,
        unsure=found.unsure,
        other_columns={c.name: (float(np.mean(c.values[found.start :])), c.unit) for c in others},
        start=start,
        start_unit=at.unit if at is not None else "",
        averaged=_averaged(at, found.start, len(history)),
        window=found.rows,
        patches=_patches(run, start),
    )


def is_final_value(run: Run, at: RawColumn | None) -> bool:
    """Whether a run has a result and no history: by its importer, or as its one row is of an iteration that many came before."""
    n = len(run.history)
    counted = at is not None and at.means == "iteration" and n == 1 and float(at.values[0]) >= LEAST_ROWS
    return 0 < n < LEAST_ROWS and (run.is_final or counted)


def _of_last_row(
    common: RunSummary, run: Run, columns: Mapping[str, RawColumn], by_name: bool, at: RawColumn | None
) -> RunSummary:
    """The last row as it stands: no standard error follows from it."""
    values = {c: float(k.values[-1]) for c, k in columns.items()}
    if not all(map(math.isfinite, values.values())):
        return replace(common, status=Convergence.DIVERGED, why="a force that is no number")
    used = set(map(id, columns.values()))
    others = [
        c for c in run.history.columns if id(c) not in used and not c.is_text and c.means not in ("time", "iteration")
    ]
    last = float(at.values[-1]) if at is not None else len(run.history) - 1.0
    return replace(
        common, status=Convergence.FINAL, means=values, errors=dict.fromkeys(values, math.nan),
        units={c: k.unit for c, k in columns.items()}, headers={c: k.name for c, k in columns.items()}, by_name=by_name,
        other_columns={c.name: (float(c.values[-1]), c.unit) for c in others if not _RESIDUAL.search(c.name)},
        averaged="the last row", window=1, patches=_patches(run, last),
    )  # fmt: skip


def _averaged(at: RawColumn | None, first: int, rows: int) -> str:
    """The window of a mean from its first row to the end, in words."""
    if at is None:
        return f"rows {first + 1} to {rows}"
    named = "iterations" if at.means == "iteration" else "times"
    unit = f" {at.unit}" if at.unit not in ("", "-") else ""
    return f"{named} {float(at.values[first]):.6g} to {float(at.values[-1]):.6g}{unit}"


def _ends_within_a_line(file: Path) -> bool:
    with suppress(OSError), stream_of(file) as stream:
        if stream.seek(0, os.SEEK_END):
            stream.seek(-1, os.SEEK_END)
            return stream.read(1) not in b"\r\n"
    return False


def deciding(history: RawTable) -> tuple[dict[str, RawColumn], bool]:
    """The columns whose plateau decides, and whether they go by their own names.

    Components that the format fixes; else what has a unit of force or moment; else all numbers but residuals.
    """
    known = {c: column for c in COMPONENTS if (column := history.meaning(c)) is not None}
    if known:
        return known, False
    numbers = {c.name: c for c in history.columns if not c.means and not c.is_text and not _RESIDUAL.search(c.name)}
    forces = {name: c for name, c in numbers.items() if fits(c.unit, "force") or fits(c.unit, "moment")}
    return forces or numbers, True


def _patches(run: Run, start: float) -> dict[str, tuple[float, str]]:
    """Means of every patch over the plateau of the whole."""
    out = {}
    for patch, table in run.patches.items():
        at = table.meaning("time") or table.meaning("iteration")
        inside = np.arange(len(table)) >= start if at is None else at.values >= start
        for c in COMPONENTS:
            column = table.meaning(c)
            if column is not None and np.any(inside):
                out[f"{c}({patch})"] = float(np.mean(column.values[inside])), column.unit
    return out

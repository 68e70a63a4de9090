"""The table of a folder of runs: one row a run, its settings, means and errors, and where they come from."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from coeflab.core.errors import together
from coeflab.core.table import ABSENT, Table
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.units import SI
from coeflab.law.symbols import COMPONENTS
from coeflab.tables.conditions import DIMENSIONS, SETTINGS, Condition, named
from coeflab.tables.histories import ORDER, Convergence
from coeflab.tables.raw_table import HALF_MODEL, RawColumn, RawTable, Stated
from coeflab.tables.run_summary import RunSummary

ONE_FOR_ALL = ("axes.", "scaling.", "conditions.density", "conditions.viscosity", "table.contains_inertia")
ITERATIONS, START, STATUS, ORIGIN = "iterations", "plateau start", "status", "condition from"
WINDOW = "averaged over"
DOUBTFUL, ALL, LABEL, IGNORE = "uncertain", "all", "label", "ignore"
SAME = 1e-5  # relative: speeds come from vectors of six digits
# Ratio of two standard errors beyond what eight batches explain: 95 % of chi-square of 7 degrees of freedom.
UNLIKE = 3.0


def runs_shown(table: RawTable, most: int = 0) -> Table | None:
    """Every run with its condition, the place that it comes from, and its status; None for a table of no runs.

    Parameters
    ----------
    table : RawTable
    most : int
        Runs shown, those that are not converged first; 0 for all.
    """
    texts = {c.name: c.texts for c in table.columns if c.name in (ORIGIN, STATUS)}
    if len(texts) < 2:
        return None
    chosen = list(range(len(table)))
    if most and len(chosen) > most:
        chosen = sorted(sorted(chosen, key=lambda i: -ORDER.index(Convergence(texts[STATUS][i])))[:most])
    settings = [c for c in table.columns if c.means in SETTINGS]
    start, iterations = table.column(START).values, table.column(ITERATIONS).values
    rows = [
        (
            table.row_labels[i],
            *(f"{c.values[i]:.5g} {c.unit}".removesuffix(" -") for c in settings),
            ABSENT if math.isnan(iterations[i]) else f"{iterations[i]:.10g}",
            ABSENT if math.isnan(start[i]) else f"{start[i]:g}",
            texts[STATUS][i],
            texts[ORIGIN][i],
        )
        for i in chosen
    ]
    counts = ", ".join(f"{n} {s}" for s in ORDER if (n := texts[STATUS].count(s)))
    more = f"; {len(table) - len(rows)} are not shown" if len(rows) < len(table) else ""
    heads = ("run", *(c.name for c in settings), ITERATIONS, "plateau from", STATUS, ORIGIN)
    return Table("Runs", heads, tuple(rows), (f"{counts}{more}.",), frozenset({0, len(heads) - 2, len(heads) - 1}))


def table_of_runs(
    path: Path, importer: str, rows: Sequence[RunSummary], known: Sequence[str], doubtful: Mapping[str, str],
    remarks: tuple[str, ...],
) -> RawTable:  # fmt: skip
    """A table by what `coeflab.tables.collect` found out about its rows.

    Parameters
    ----------
    path : Path
        Folder of the runs.
    importer : str
    rows : sequence of RunSummary
    known : sequence of str
        Settings that every row has.
    doubtful : mapping of str to str
        By run, the columns that no fit uses.
    remarks : tuple of str
    """
    columns = [_setting(rows, name) for name in known]
    by_name = _by_name(rows)
    found = dict.fromkeys(c for r in rows for c in r.means)
    components = list(found) if by_name else [c for c in COMPONENTS if c in found]
    more = list(remarks)
    for c in components:
        header = next(r.headers[c] for r in rows if c in r.means)
        values = _numbers([r.means.get(c) for r in rows])
        columns.append(RawColumn(header, _unit_of(rows, c), values, means="" if by_name else c))
    header_of = {c: next(r.headers[c] for r in rows if c in r.means) if by_name else c for c in components}
    for c in components:
        errors = _numbers([r.errors.get(c) for r in rows])
        bare = [r.name for r, e in zip(rows, errors, strict=True) if c in r.means and not e > 0.0]
        if bare and all(r.status is Convergence.FINAL for r in rows if c in r.means):
            continue  # said of the runs
        if bare:
            more.append(f"No se_{c}: {named(bare)} without a history, or of zeros only, has no standard error.")
        else:
            errors, raised = _floored(errors, [r.status is Convergence.CONVERGED for r in rows])
            if raised:
                unit = _unit_of(rows, c)
                more.append(raised.format(f"se_{header_of[c]}", f" {unit}" if unit not in ("", "-") else ""))
            columns.append(RawColumn(f"se_{c}", _unit_of(rows, c), errors, means="" if by_name else f"se_{c}"))
    others = dict.fromkeys(k for r in rows for k in r.conditions if k not in SETTINGS)
    columns += [
        _other(rows, k)
        for k in ("cells", "y_plus", *(o for o in others if o not in ("cells", "y_plus")))
        if k in others
    ]
    columns.append(RawColumn(ITERATIONS, "-", _numbers([r.iterations for r in rows]), means=IGNORE))
    unit = next((r.start_unit for r in rows if r.start_unit), "-")
    columns.append(RawColumn(START, unit, _numbers([r.start for r in rows]), means=IGNORE))
    columns.append(_text(STATUS, [str(r.status) for r in rows]))
    columns.append(_text(WINDOW, [r.averaged for r in rows]))
    columns.append(_text(ORIGIN, [_origin(r, known) for r in rows]))
    columns.append(_text(DOUBTFUL, [doubtful[r.name] for r in rows], means=DOUBTFUL))
    columns += _extra_columns([r.patches for r in rows], IGNORE) + _extra_columns(
        [r.other_columns for r in rows], "" if by_name else IGNORE
    )
    stated, differing = _stated(rows)
    more += [f"{k} differs between runs ({text}) and is left out." for k, text in differing.items()]
    versions = sorted({v for r in rows if (v := r.dialect.get("version"))})
    return RawTable(
        path=path,
        columns=tuple(columns),
        row_labels=tuple(r.name for r in rows),
        files=tuple(dict.fromkeys(Path(f) for r in rows for f in r.files)),
        dialect={
            "importer": importer,
            "runs": str(len(rows)),
            **({"version": ", ".join(versions)} if versions else {}),
            **({WINDOW: averaged} if (averaged := _averaged(rows)) else {}),
        },
        stated=stated,
        remarks=tuple(more),
    )


def _averaged(rows: Sequence[RunSummary]) -> str:
    """What the means of all runs are over: one window, or where each run has its own."""
    windows = {r.averaged for r in rows if r.averaged}
    return windows.pop() if len(windows) == 1 else "a window of each run" if windows else ""


def _floored(errors: Array, converged: Sequence[bool]) -> tuple[Array, str]:
    """Standard errors of runs, none below the pooled one of the converged runs where they differ more than chance explains.

    A history that converged to the last digit says nothing of how far its mean is from that of its neighbours: unless errors are
    pooled, few rows carry the whole fit.
    """
    own = errors[np.array(converged) & np.isfinite(errors)]
    if own.size < 2 or float(own.max()) <= UNLIKE * float(own.min()):
        return errors, ""
    pooled = float(np.sqrt(np.mean(own**2)))
    low = errors < pooled
    words = f"{{}} of {int(low.sum())} of {errors.size} runs raised to {pooled:.2g}{{}}, the pooled error (root mean square) of the "
    words += f"converged runs: their own differ {own.max() / own.min():.2g}-fold, which would leave the fit to the few smallest."
    return np.where(low, pooled, errors), words


def _numbers(values: Sequence[float | None]) -> Array:
    return np.array([math.nan if v is None else v for v in values], dtype=float)


def _extra_columns(rows: Sequence[Mapping[str, tuple[float, str]]], means: str) -> list[RawColumn]:
    """Columns of patches, or of what is no force."""
    first = {name: unit for row in reversed(rows) for name, (_, unit) in row.items()}
    names = dict.fromkeys(name for row in rows for name in row)
    return [RawColumn(n, first[n], _numbers([r[n][0] if n in r else None for r in rows]), means=means) for n in names]


def _origin(run: RunSummary, known: Sequence[str]) -> str:
    return "; ".join(dict.fromkeys(o for k in known for o in run.conditions[k].origins))


def _by_name(rows: Sequence[RunSummary]) -> bool:
    """Whether the columns go by their own names, in all runs alike."""
    kinds = {r.by_name: r.name for r in rows if r.means}
    if len(kinds) > 1:
        raise input_error("tables.named_and_other_components", components=kinds[False], names=kinds[True])
    return True in kinds


def _text(name: str, texts: Sequence[str], means: str = LABEL) -> RawColumn:
    return RawColumn(name, "", np.full(len(texts), np.nan), tuple(texts), means)


def _setting(rows: Sequence[RunSummary], name: str) -> RawColumn:
    """A column of settings: in the unit of its origin where all runs have one, else in SI."""
    cells = [r.conditions[name] for r in rows]
    units = {c.unit for c in cells}
    written = len(units) == 1
    values = [c.written if written else c.value for c in cells]
    unit = cells[0].unit if written else SI[DIMENSIONS[name]] or "-"
    return RawColumn(name, unit, np.array(values, dtype=float), means=name)


def _other(rows: Sequence[RunSummary], name: str) -> RawColumn:
    """A column of what is no setting: labels, cells, y+."""
    cells = [r.conditions.get(name) for r in rows]
    means = name if name == "cells" else IGNORE
    if any(c is not None and isinstance(c.value, str) for c in cells):
        texts = ["" if c is None else str(c.value) for c in cells]
        return _text(name, texts)
    unit = next((c.unit for c in cells if c is not None and c.unit), "-")
    return RawColumn(name, unit, _numbers([_as_number(c) for c in cells]), means=means)


def _as_number(condition: Condition | None) -> float | None:
    return None if condition is None or isinstance(condition.value, str) else condition.written


def _unit_of(rows: Sequence[RunSummary], component: str) -> str:
    units: dict[str, str] = {}
    for r in rows:
        if component in r.units:
            units.setdefault(r.units[component], r.name)
    if len(units) > 1:
        some = " and ".join(f"[{u}] in {name}" for u, name in units.items())
        raise input_error("tables.several_units", column=component, component=component, some=some)
    return next(iter(units), "")


def _alike(a: object, b: object) -> bool:
    """Whether two stated values are one, but for rounding."""
    if isinstance(a, (float, tuple)) and isinstance(b, (float, tuple)):
        return np.shape(a) == np.shape(b) and bool(np.allclose(a, b, rtol=SAME, atol=1e-9))
    return a == b


def _stated(rows: Sequence[RunSummary]) -> tuple[dict[str, Stated], dict[str, str]]:
    """What all runs state alike, and of what differs two values; axes, points and densities must not differ."""
    first: dict[str, tuple[str, Stated]] = {}
    differing: dict[str, str] = {}
    complaints = []
    for r in rows:
        for key, one in r.stated.items():
            name, before = first.setdefault(key, (r.name, one))
            if _alike(before.value, one.value) or key in differing:
                continue
            differing[key] = f"{_five(before.value)} in {name}, {_five(one.value)} in {r.name}"
            if key.startswith(ONE_FOR_ALL):
                complaints.append(input_error(
                    "tables.several_values", key=key, value=before.value, name=name, place=before.place, other=one.value, another=r.name,
                    other_place=one.place,
                ))  # fmt: skip
    halves = {HALF_MODEL in r.stated: r for r in rows if r.status.has_numbers}
    if len(halves) > 1:
        complaints.append(input_error(
            "tables.some_halves", key=HALF_MODEL, half=halves[True].name, contradicted=halves[True].stated[HALF_MODEL].contradicted,
            whole=halves[False].name,
        ))  # fmt: skip
    if complaints:
        raise together(complaints)
    return {k: s for k, (_, s) in first.items() if k not in differing}, differing


def _five(value: str | float | bool | tuple[float, ...]) -> str:
    if isinstance(value, tuple):
        return f"({', '.join(f'{x:.5g}' for x in value)})"
    return str(value) if isinstance(value, (str, bool)) else f"{value:.5g}"

"""A folder of runs becomes one table, one row a condition: plateaus averaged, conditions joined, gaps and doubles named."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import together
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.table import ABSENT, Table
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.core.units import SI
from coeflab.law.symbols import ANGULAR, COMPONENTS, LINEAR
from coeflab.tables.conditions import DIMENSIONS, SETTINGS, Condition, NamePattern, name_pattern, named, of_files
from coeflab.tables.histories import ORDER, Convergence
from coeflab.tables.raw_table import HALF_MODEL, NO_FORCES, RawColumn, RawTable, Stated
from coeflab.tables.run_list import RunList, joined, read_run_list, required
from coeflab.tables.runs import Progress, RunSummary, find_runs, read_all

FULL, FEWEST = 0.75, 6  # a matrix of settings: share that is there, and its least size
ONE_FOR_ALL = ("axes.", "scaling.", "conditions.density", "conditions.viscosity", "table.contains_inertia")
ITERATIONS, START, STATUS, ORIGIN = "iterations", "plateau start", "status", "condition from"
WINDOW = "averaged over"
DOUBTFUL, ALL, LABEL, IGNORE = "uncertain", "all", "label", "ignore"
MOST_REMARKS = 20
OF_MOTION = re.compile(r"\b(?:velocit(?:y|ies)|speed|angle|inflow)\b")
SETTING_NAMES = frozenset(SETTINGS)
MOST_SILENT = 3  # remarks of runs that a complaint about their conditions repeats
FINE = 0.01  # of the largest mean of a component: a standard error below it is small enough, however short the history
KEPT = {
    Convergence.FINAL: "taken as they stand: without a history they have no standard error",
    Convergence.SHORT: f"as every error, the range of the plateau in it, is below {100 * FINE:g} % of the largest mean of its component",
    Convergence.TOO_SHORT: "of which what is too short is marked as uncertain and not used",
    Convergence.DRIFTING: "which are kept but marked as uncertain",
}
SAME = 1e-5  # relative: speeds come from vectors of six digits
EARLY = 0.6  # of the median end of all runs: what ends before it may have crashed
# Ratio of two standard errors beyond what eight batches explain: 95 % of chi-square of 7 degrees of freedom.
UNLIKE = 3.0


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Collected:
    """A folder of runs as one table.

    Attributes
    ----------
    table : RawTable
        One row for every run whose condition is known, in the order of ``runs``.
    runs : tuple of RunSummary
        All that were found, in natural order of their names.
    missing : tuple of str
        Runs that the list names and the folder lacks, and holes in a regular matrix of settings.
    duplicates : tuple of tuple of str
        Names of runs of one condition, each group once; runs of several grids are none.
    importer : str
    again : int
        Runs that were read now; the others were known from the state file.
    """

    table: RawTable
    runs: tuple[RunSummary, ...]
    missing: tuple[str, ...]
    duplicates: tuple[tuple[str, ...], ...]
    importer: str
    again: int

    def __len__(self) -> int:
        return len(self.runs)

    @property
    def counts(self) -> dict[Convergence, int]:
        """How many runs ended how, the best first; only what occurs."""
        found = [r.status for r in self.runs]
        return {s: found.count(s) for s in ORDER if s in found}

    def inputs(self) -> tuple[InputFile, ...]:
        """Every file that was read, with its sha256; computed now, from the files as they are now."""
        root = self.table.path if self.table.path.is_dir() else self.table.path.parent
        paths = dict.fromkeys(p for r in self.runs for p in r.files)
        return tuple(InputFile(Path(os.path.relpath(p, root)).as_posix(), sha256_of(Path(p))) for p in paths)

    def shown(self, most: int = 0) -> Table:
        """Every run of the table with its condition, see `runs_shown`."""
        return runs_shown(self.table, most) or Table("Runs", ("run",), ())


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


def collect(
    path: Path,
    importer: str = "",
    *,
    options: Mapping[str, Any] | None = None,
    names: str = "",
    run_list: Path | None = None,
    progress: Progress | None = None,
    workers: int | None = None,
    state: Path | None = None,
) -> Collected:
    """Collect a folder of runs, or a single one, into a table.

    Parameters
    ----------
    path : Path
    importer : str
        Format of the runs; empty: the one that recognises them.
    options : mapping, optional
        Of the importer.
    names : str
        Pattern of the runs' names, see `coeflab.tables.conditions.NamePattern`.
    run_list : Path, optional
        CSV or TOML with the conditions of runs, see `coeflab.tables.conditions.read_run_list`.
    progress : callable, optional
        Is handed a line now and then.
    workers : int, optional
        Processes; unless given, as many as there are cores once work is long enough.
    state : Path, optional
        File, or folder for one, that keeps what was read; a run whose files did not change is not read again.

    Raises
    ------
    InputError
        No run, runs of two formats, conditions that are unknown or contradict each other, units or axes that differ between
        runs; all complaints of one kind at once.
    CoeflabError
        A process was killed; what was read is kept in the state file.
    OutputError
        The state file cannot be written.
    """
    return collect_groups(
        path,
        importer,
        options=options,
        patterns=(names,),
        run_list=run_list,
        progress=progress,
        workers=workers,
        state=state,
    )[0]


def collect_groups(
    path: Path,
    importer: str = "",
    *,
    options: Mapping[str, Any] | None = None,
    patterns: Sequence[str] = ("",),
    run_list: Path | None = None,
    progress: Progress | None = None,
    workers: int | None = None,
    state: Path | None = None,
) -> tuple[Collected, ...]:
    """Runs whose names follow several patterns as a table each; they are read once.

    Parameters
    ----------
    patterns : sequence of str
        A run belongs to the one that its name fits. Of a single pattern, which may be empty, all runs are.
    path, importer, options, run_list, progress, workers, state
        See `collect`.

    Raises
    ------
    InputError
        As `collect`; a run with forces whose name fits no pattern, or two.
    """
    named_by = [name_pattern(text) if text else None for text in patterns]
    listed_runs = read_run_list(run_list) if run_list is not None else None
    chosen, found = find_runs(path, importer)
    matched = set((listed_runs.matches(list(found)) if listed_runs else {}).values())
    summaries, again = read_all(path, chosen, found, options or {}, progress, workers, state)
    summaries = _broken_off(summaries)
    if len(named_by) == 1:
        groups = [summaries]
    else:
        fits = {s.name: [p for p in named_by if p and p.conditions(s.name) is not None] for s in summaries}
        complaints = [
            input_error(
                "tables.several_patterns_fit", s.name, count=len(fits[s.name]) or "no", ending="s" * (not fits[s.name])
            )
            for s in summaries if len(fits[s.name]) != 1 and (fits[s.name] or s.status.has_numbers)
        ]  # fmt: skip
        if complaints:
            raise together(complaints)
        groups = [[s for s in summaries if p in fits[s.name]] for p in named_by]
    out = []
    for pattern, group in zip(named_by, groups, strict=True):
        if not group:
            raise input_error(
                "tables.no_run_of_pattern", path, pattern=pattern.text if pattern else "", some=named(list(found)[:3])
            )
        out.append(_collected(path, chosen, group, pattern, listed_runs, matched, again))
    return tuple(out)


def _collected(
    path: Path, chosen: str, summaries: Sequence[RunSummary], pattern: NamePattern | None, listed_runs: RunList | None,
    matched: set[str], again: int,
) -> Collected:  # fmt: skip
    """Runs of one table."""
    conditions = joined({s.name: of_files(s.stated_conditions) for s in summaries}, pattern, listed_runs)
    conditions = _with_straight_runs(conditions)
    summaries = [replace(s, conditions=conditions[s.name]) for s in summaries]
    if complaints := required({s.name: s.conditions for s in summaries if s.status.has_numbers}, pattern):
        silent = list(
            dict.fromkeys(
                r
                for s in summaries
                if s.status.has_numbers and not SETTING_NAMES & set(s.conditions)
                for r in s.remarks
            )
        )
        moving = [r for r in silent if OF_MOTION.search(r)]  # what stopped a file from saying it
        complaints[0].advice += "".join(f" {remark}" for remark in moving[:MOST_SILENT])
        raise together(complaints)
    known = [s for s in SETTINGS if any(s in r.conditions for r in summaries)]
    rows = [s for s in summaries if all(k in s.conditions for k in known)]
    absent = [f"{n} of {listed_runs.path.name}" for n in listed_runs.runs if n not in matched] if listed_runs else []
    duplicates, copies, grids = _duplicates(rows, known)
    missing = (*absent, *_holes(rows, known))
    doubtful = _doubtful(rows, copies)
    used = {s.name: replace(s, status=Convergence.SHORT) for s in rows if _is_short_but_used(s, doubtful)}
    rows, summaries = [used.get(s.name, s) for s in rows], [used.get(s.name, s) for s in summaries]
    remarks = _remarks(summaries, rows, missing, duplicates, copies, grids)
    table = _table(path, chosen, rows, known, doubtful, remarks)
    return Collected(table, tuple(summaries), missing, duplicates, chosen, again)


def _broken_off(runs: Sequence[RunSummary]) -> list[RunSummary]:
    """The runs, those as crashed that end early among runs that go on, which their format cannot show.

    A run ends early at less than `EARLY` of the median of all, within a line where others end with one, or not converged where
    all others reach one and the same end.
    """
    ended = [r for r in runs if r.status.has_numbers and math.isfinite(r.last)]
    middle = EARLY * float(np.median([r.last for r in ended])) if len(ended) > 2 else -math.inf
    others = [r for r in ended if r.last >= middle]
    ends = {r.last for r in others}
    cut_is_news = not all(r.is_cut for r in others)

    def judged(r: RunSummary) -> RunSummary:
        is_early = r.status.has_numbers and r.last < middle
        alone = len(ends) == 1 and r.status is not Convergence.CONVERGED
        if not is_early or not (alone or (r.is_cut and cut_is_news)):
            return r
        end = f"{max(ends):g}" if len(ends) == 1 else f"{min(ends):g} to {max(ends):g}"
        why = f"ends at {r.last:g}{' within a line' * (r.is_cut and cut_is_news)}, the others at {end}"
        return replace(
            r, status=Convergence.CRASHED, why=why, means={}, errors={}, units={}, headers={}, by_name=False, beside={},
            unsure={}, patches={}, start=math.nan, start_unit="", averaged="", window=0,
        )  # fmt: skip

    return [judged(r) for r in runs]


def _with_straight_runs(stated: Mapping[str, dict[str, Condition]]) -> dict[str, dict[str, Condition]]:
    """Rates of zero for runs whose files state a velocity and no rotating frame, where other runs of the folder turn."""
    if not any(set(ANGULAR) <= set(c) for c in stated.values()):
        return dict(stated)
    still = {rate: Condition(0.0, 0.0, SI["rate"], ("no rotating frame in its files",)) for rate in ANGULAR}
    return {
        run: c if set(ANGULAR) & set(c) or not set(LINEAR) <= set(c) else {**c, **still} for run, c in stated.items()
    }


def _point(run: RunSummary, known: Sequence[str]) -> tuple[Any, ...]:
    """What makes a condition: settings to four digits, and labels."""
    settings = (run.conditions[k].value for k in known)
    numbers = (v if isinstance(v, str) else 0.0 if abs(v) < 1e-6 else float(f"{v:.4g}") for v in settings)
    labels = sorted((k, c.value) for k, c in run.conditions.items() if k not in SETTINGS and isinstance(c.value, str))
    return (*numbers, *labels)


def _duplicates(
    rows: Sequence[RunSummary], known: Sequence[str]
) -> tuple[tuple[tuple[str, ...], ...], dict[str, str], tuple[tuple[str, ...], ...]]:
    """Groups of one condition, copies (equal to the last digit) with their original, and groups of several grids."""
    groups: dict[tuple[Any, ...], list[RunSummary]] = {}
    for r in rows:
        groups.setdefault(_point(r, known), []).append(r)
    duplicates: list[tuple[str, ...]] = []
    grids: list[tuple[str, ...]] = []
    copies: dict[str, str] = {}
    for group in groups.values():
        if len(group) < 2:
            continue
        cells = [r.conditions["cells"].value for r in group if "cells" in r.conditions]
        several = len(cells) == len(group) and len(set(cells)) == len(group)
        (grids if several else duplicates).append(tuple(r.name for r in group))
        originals: dict[tuple[Any, ...], str] = {}
        for r in group:
            if not several and r.means:
                first = originals.setdefault((tuple(sorted(r.means.items())), r.window), r.name)
                copies |= {r.name: first} if first != r.name else {}
    return tuple(duplicates), copies, tuple(grids)


def _doubtful(rows: Sequence[RunSummary], copies: Mapping[str, str]) -> dict[str, str]:
    """By run, what no fit uses: ``all``, or the columns that are too short, with semicolons between them."""
    largest: dict[str, float] = {}
    for r in rows:
        if r.status in (Convergence.CONVERGED, Convergence.FINAL, Convergence.TOO_SHORT):
            for c, mean in r.means.items():
                largest[c] = max(largest.get(c, 0.0), abs(mean))

    def of(r: RunSummary) -> str:
        if r.name in copies or r.status not in (Convergence.CONVERGED, Convergence.FINAL, Convergence.TOO_SHORT):
            return ALL
        short = [c for c, enough in r.unsure.items() if not (enough and r.errors[c] < FINE * largest[c])]
        heads = [r.headers[c] if r.by_name else c for c in short]
        return ALL if any(";" in h for h in heads) or len(short) == len(r.means) else "; ".join(heads)

    return {r.name: of(r) for r in rows}


def _is_short_but_used(run: RunSummary, doubtful: Mapping[str, str]) -> bool:
    return run.status is Convergence.TOO_SHORT and not doubtful[run.name]


def _lacks_forces(run: RunSummary) -> bool:
    return run.status is Convergence.EMPTY and NO_FORCES in run.why


def _with_reasons(runs: Sequence[RunSummary]) -> str:
    return named([f"{s.name} ({s.why})" if s.why else s.name for s in runs])


def _holes(rows: Sequence[RunSummary], known: Sequence[str]) -> tuple[str, ...]:
    """Conditions that a matrix of settings lacks, where at least three quarters of it are there."""
    # Of a velocity, u follows from the speed and the cross flow.
    free = [k for k in known if k != "u" or not {"v", "w"} & set(known)]
    varied = [k for k in free if len({_point(r, [k])[0] for r in rows}) > 1]
    if len(varied) < 2:
        return ()
    have = {_point(r, varied)[: len(varied)] for r in rows}
    axes = [sorted({point[i] for point in have}) for i in range(len(varied))]
    size = math.prod(map(len, axes))
    if size < FEWEST or len(have) >= size or len(have) < FULL * size:
        return ()
    texts = [{_point(r, [k])[0]: f"{k} = {str(r.conditions[k]).partition(' (')[0]}" for r in rows} for k in varied]
    holes: list[tuple[Any, ...]] = [()]
    for axis in axes:
        holes = [(*hole, value) for hole in holes for value in axis]
    return tuple(", ".join(t[v] for t, v in zip(texts, hole, strict=True)) for hole in holes if hole not in have)


def _remarks(
    summaries: Sequence[RunSummary], rows: Sequence[RunSummary], missing: Sequence[str], duplicates: Sequence[Sequence[str]],
    copies: Mapping[str, str], grids: Sequence[Sequence[str]],
) -> tuple[str, ...]:  # fmt: skip
    """What a person has to know of the runs, a sentence each; many runs of one kind in one sentence."""
    out = []
    in_table = {r.name for r in rows}
    if bare := [s.name for s in summaries if _lacks_forces(s)]:
        advice = "" if any(s.means for s in summaries) else next(f" ({s.why})" for s in summaries if _lacks_forces(s))
        out.append(f"{len(bare)} case{'s' * (len(bare) > 1)} without forces: {named(bare)}{advice}")
    for status in ORDER[1:]:
        alike = [s for s in summaries if s.status is status and not _lacks_forces(s)]
        if not alike:
            continue
        what = KEPT.get(status, "which have no numbers")
        outside = sum(s.name not in in_table for s in alike)
        what += f"; {outside} without a known condition are left out" if outside else ""
        out.append(f"{len(alike)} {status}, {what}: {_with_reasons(alike)}.")
    if missing:
        out.append(f"{len(missing)} missing: {named([f'[{m}]' for m in missing])}.")
    if duplicates:
        groups = [" = ".join(g) for g in duplicates]
        out.append(f"{len(groups)} condition{'s' * (len(groups) > 1)} more than once: {named(groups)}.")
    if copies:
        pairs = [f"{a} of {b}" for a, b in copies.items()]
        out.append(f"Copies to the last digit, marked as uncertain: {named(pairs)}.")
    if grids:
        out.append(
            f"{len(grids)} condition{'s' * (len(grids) > 1)} on several grids: {named([' = '.join(g) for g in grids])}."
        )
    common: dict[str, list[str]] = {}
    for s in summaries:
        for remark in s.remarks:
            common.setdefault(remark, []).append(s.name)
    out += [f"{remark} ({named(runs)})" for remark, runs in list(common.items())[:MOST_REMARKS]]
    if len(common) > MOST_REMARKS:
        out.append(f"{len(common) - MOST_REMARKS} more remarks of single runs.")
    return tuple(out)


def _table(
    path: Path, importer: str, rows: Sequence[RunSummary], known: Sequence[str], doubtful: Mapping[str, str],
    remarks: tuple[str, ...],
) -> RawTable:  # fmt: skip
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
    columns += _beside([r.patches for r in rows], IGNORE) + _beside([r.beside for r in rows], "" if by_name else IGNORE)
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


def _beside(rows: Sequence[Mapping[str, tuple[float, str]]], means: str) -> list[RawColumn]:
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

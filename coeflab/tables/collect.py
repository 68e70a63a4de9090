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
from coeflab.core.table import Table
from coeflab.core.texts import input_error
from coeflab.core.types import brief
from coeflab.core.units import SI
from coeflab.law.symbols import ANGULAR, LINEAR
from coeflab.tables.conditions import SETTINGS, Condition, NamePattern, name_pattern, named, of_files
from coeflab.tables.histories import ORDER, Convergence
from coeflab.tables.raw_table import NO_FORCES, ONE_FLOW, RawTable, Stated
from coeflab.tables.run_list import RunList, joined, read_run_list, required, turned_in_one_flow
from coeflab.tables.run_summary import RunSummary
from coeflab.tables.runs import Progress, find_runs, read_all
from coeflab.tables.runs_table import ALL, runs_shown, table_of_runs

FULL, FEWEST = 0.75, 6  # a matrix of settings: share that is there, and its least size
MOST_REMARKS = 20
OF_MOTION = re.compile(r"\b(?:velocit(?:y|ies)|speed|angle|inflow)\b")
SETTING_NAMES = frozenset(SETTINGS)
MOST_SILENT = 3  # remarks of runs that a complaint about their conditions repeats
FINE = 0.01  # of the largest mean of a component: a standard error below it is small enough, however short the history
STATUS_WORDS = {
    Convergence.FINAL: "taken as they stand: without a history they have no standard error",
    Convergence.SHORT: f"as every error, the range of the plateau in it, is below {100 * FINE:g} % of the largest mean of its component",
    Convergence.TOO_SHORT: "of which what is too short is marked as uncertain and not used",
    Convergence.DRIFTING: "which are kept but marked as uncertain",
}
EARLY = 0.6  # of the median end of all runs: what ends before it may have crashed


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
    """Collect a folder of runs, or a single one; those whose names follow one of several patterns are a table, and all are read once.

    Parameters
    ----------
    path : Path
    importer : str
        Format of the runs; empty: the one that recognises them.
    options : mapping, optional
        Of the importer.
    patterns : sequence of str
        Of names, see `coeflab.tables.conditions.NamePattern`; a run belongs to the one that its name fits. Of a single pattern,
        which may be empty, all runs are.
    run_list : Path, optional
        CSV or TOML with the conditions of runs, see `coeflab.tables.run_list.read_run_list`.
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
        runs, a run with forces whose name fits no pattern, or two; all complaints of one kind at once.
    CoeflabError
        A process was killed; what was read is kept in the state file.
    OutputError
        The state file cannot be written.
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
    if all(s.status is Convergence.UNREADABLE for s in summaries):
        raise input_error("tables.unreadable_runs", path, count=len(summaries), reasons=_with_reasons(summaries))
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
    table = table_of_runs(path, chosen, rows, known, doubtful, remarks)
    if flow := turned_in_one_flow(conditions):
        table = replace(table, stated={**table.stated, ONE_FLOW: Stated(flow.value, flow.origins[0])})
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
            r, status=Convergence.CRASHED, why=why, means={}, errors={}, units={}, headers={}, by_name=False, other_columns={},
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
    reasons: dict[str, list[str]] = {}
    for s in runs:
        reasons.setdefault(s.why, []).append(s.name)
    return named([named(names) + f" ({why})" * bool(why) for why, names in reasons.items()])


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
        what = STATUS_WORDS.get(status, "which have no numbers")
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

"""What a tow gives: the runs read back, their campaign, its fits, and the report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from coeflab.core.errors import CoeflabError, InputError
from coeflab.core.files import write_all
from coeflab.core.types import brief
from coeflab.fits import BY_DEFAULT
from coeflab.fits.results.fit_result import FitResult
from coeflab.law.coefficient import CoefficientSet
from coeflab.law.symbols import ANGULAR, LINEAR
from coeflab.report.rendered import rendered
from coeflab.study.run import run
from coeflab.study.secants import secant
from coeflab.study.study import Plan, PlannedTow, Study
from coeflab.study.towed import NOT_RUN, OPEN, SECANT, TowedRow, runs_used
from coeflab.study.towed import towed as compared
from coeflab.tables.force_table import ForceTable
from coeflab.tables.raw_table import RawTable, Run
from coeflab.tables.reading import read_tables, table_at
from coeflab.tank.campaign import SIX, campaign_files, rows_of
from coeflab.tank.earlier import earlier_run
from coeflab.tank.folder import CAMPAIGN, REPORT, TANK
from coeflab.tank.jobs import Job, JobState, Progressed, progress
from coeflab.tank.plateau import until
from coeflab.tank.solvers import SOLVERS
from coeflab.tank.test_matrix import EXACT, TowCondition
from coeflab.tank.tow import Tow
from coeflab.tank.towed_run import TowedRun, towed_run

FEWEST = 3  # settings of a sweep: an intercept, a slope and an error


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Collected:
    """What a tow has given so far.

    Attributes
    ----------
    runs : tuple of TowedRun
        Every condition of the matrix.
    study : Study or None
        Fits of the campaign; None where nothing can be fitted.
    unfitted : str
        Why there is no study.
    tables : tuple of ForceTable
        Of the campaign, where there is no study.
    files : tuple of Path
        That were written.
    """

    runs: tuple[TowedRun, ...]
    study: Study | None = None
    unfitted: str = ""
    tables: tuple[ForceTable, ...] = ()
    files: tuple[Path, ...] = ()

    @property
    def six(self) -> tuple[TowedRow, ...]:
        """Every one of the six derivatives, one without a value with its reason."""
        if self.study is None:
            lines = {s: secant(self.tables, s, self.tables[0].scaling) if self.tables else None for s in SIX}
            return tuple(
                TowedRow(s, c, None, "" if c else OPEN, f"{SECANT}; {self.unfitted}" if c else self.unfitted, ())
                for s, c in lines.items()
            )
        tables = self.study.tables
        return tuple(_with_count(_left_out(row, self.runs), tables) for row in compared(self.study)[0].rows)

    @property
    def failed(self) -> tuple[TowedRun, ...]:
        """Conditions that were run and do not count."""
        return tuple(r for r in self.runs if not r.counts and r.state is not JobState.WAITING)


def _left_out(row: TowedRow, runs: Sequence[TowedRun]) -> TowedRow:
    """A derivative whose runs left no table, because none of them has a mean, with the states of these runs."""
    if row.missing != NOT_RUN:
        return row
    variable = row.varies
    ended = [r for r in runs if variable in _moves(r.condition) and not r.condition.variant]
    states = Counter(r.status for r in ended if not r.counts)
    if not ended or all(r.state is JobState.WAITING for r in ended):
        return row
    return replace(row, missing=OPEN, why=runs_used(len(ended), variable, states))


def _moves(condition: TowCondition) -> tuple[str, ...]:
    """What a condition moves in, besides ahead."""
    motion = (*condition.velocity[1:], *condition.rates)
    return tuple(m for m, x in zip((*LINEAR[1:], *ANGULAR), motion, strict=True) if abs(x) > EXACT * condition.speed)


def _with_count(row: TowedRow, tables: Sequence[ForceTable]) -> TowedRow:
    """A derivative without a value with the number of runs that count, where these are too few for a fit."""
    own = [t for t in tables if row.symbol[1] in t.varies]
    if row.coefficient is not None or not own:
        return row
    runs = sum(max((len(np.unique(t.setting[mask])) for mask in t.usable.values()), default=0) for t in own)
    return row if runs >= FEWEST else replace(row, why=f"{runs} runs with {row.symbol[1]} count, {FEWEST} are needed")


def collected(tow: Tow, fitted: bool = True) -> Collected:
    """Write the campaign of what is finished so far and, if wanted, fit it and write the report.

    Raises
    ------
    InputError
        A history that cannot be read; a table that an outside solver gives.
    """
    runs, stated, kind = _runs(tow)
    inputs = {"body.toml": tow.tank.body, "tank.toml": tow.folder / TANK}
    files = campaign_files(tow.tank, tow.body, runs, tow.installed.version or tow.tank.solver, inputs, stated, kind)
    folder = tow.folder / CAMPAIGN
    write_all(folder, files)
    for stale in sorted(folder.glob("*.csv")) if folder.is_dir() else ():
        if stale.name not in files:
            stale.unlink()
    written = tuple(folder / name for name in files)
    if not fitted:
        return Collected(runs, files=written)
    if not files or not _has_a_sweep(folder):
        why = f"no sweep has {FEWEST} runs that count"
        return Collected(runs, files=written, unfitted=why, tables=read_tables(table_at(folder)) if files else ())
    try:
        study = _study(tow, folder)
    except CoeflabError as why:  # the campaign stands, whatever a fit makes of it
        return Collected(runs, files=written, unfitted=str(why), tables=read_tables(table_at(folder)))
    report = rendered(study)
    write_all(tow.folder / REPORT, report)
    return Collected(runs, study, files=(*written, *(tow.folder / REPORT / name for name in report)))


def filled(tow: Tow) -> int:
    """Conditions that the table of a method without runs has forces of.

    Raises
    ------
    InputError
        The table cannot be read.
    """
    return sum(r.state is not JobState.WAITING for r in _runs(tow)[0])


def _runs(tow: Tow) -> tuple[tuple[TowedRun, ...], str, str]:
    """Every condition as it came out, what is stated of forces that no run of ours gave, and the kind of the source."""
    solver, jobs = tow.solver, tow.of
    if solver.table is not None:
        with SOLVERS.guarded(tow.tank.solver):
            table: RawTable = solver.table(tow.tank, tow.body, tow.folder)
        result = table.stated.get("source.how_obtained")
        kind = table.stated.get("source.kind")
        words = f"{result.value if result is not None else tow.tank.solver} ({table.path.name})"
        return rows_of(tow.tank, table), words, "cfd" if kind is None else str(kind.value)
    states = {name: progress(job) for name, job in jobs.items()}
    out = []
    for condition in tow.tank.matrix:
        job = jobs.get(condition.name)
        if job is None:
            out.append(TowedRun(condition, JobState.WAITING, "no job of that name"))
            continue
        now = states[condition.name]
        earlier = earlier_run(condition, job, now.state)
        if earlier is not None:
            out.append(earlier)
            continue
        remarks = [r for name in job.needs if name in states for r in states[name].remarks]
        out.append(towed_run(condition, now, jobs, job, _history(tow, job, now), remarks))
    return tuple(out), "", "cfd"


def _history(tow: Tow, job: Job, now: Progressed) -> Run | None:
    """The history up to where the plateau was recognised: how long the solver took to stop must not count."""
    if now.state in (JobState.WAITING, JobState.CHANGED) or tow.solver.history is None:
        return None
    try:
        with SOLVERS.guarded(tow.tank.solver):
            found = tow.solver.history(job.folder)
    except InputError:
        if now.state.is_final:
            raise
        return None
    return until(found, now.plateau) if now.plateau else found


def _study(tow: Tow, campaign: Path) -> Study:
    """The six derivatives as far as the campaign gives them: a table with too few runs is left out and named.

    Raises
    ------
    InputError
        No table has runs enough.
    """
    tank = tow.tank
    planned = PlannedTow(tank.title, tow.body.body.name, tank.name, added=campaign)
    study = run(
        Plan(
            name=tank.name, title=tank.title, tables=(table_at(campaign, BY_DEFAULT),), scaling=tank.scaling,
            conditions=tank.conditions, body=tank.body, wanted=SIX, tows=(planned,),
        )
    )  # fmt: skip
    if tow.solver.known is None:
        return study
    with SOLVERS.guarded(tank.solver):
        among = tow.solver.known(tank, tow.body)
    return replace(study, fits=tuple(_with_scatter(f, among) for f in study.fits))


def _with_scatter(fit: FitResult, among: CoefficientSet) -> FitResult:
    """A fit to forces of a method, with the method's own U95 and covariance of the coefficients that it states."""
    own = [c.symbol for c in fit.coefficients.coefficients]
    at = [(i, among.symbols.index(s)) for i, s in enumerate(own) if s in among]
    changed = tuple(
        replace(c, u95=among[c.symbol].u95, parts=among[c.symbol].parts)
        if c.value is not None and c.symbol in among
        else c
        for c in fit.coefficients.coefficients
    )
    spread = np.array(fit.coefficients.covariance)
    if at:
        mine, theirs = (np.array(k) for k in zip(*at, strict=True))
        spread[np.ix_(mine, mine)] = among.covariance[np.ix_(theirs, theirs)]
    return replace(fit, coefficients=replace(fit.coefficients, coefficients=changed, covariance=spread))


def _has_a_sweep(campaign: Path) -> bool:
    tables = read_tables(table_at(campaign))
    return any(len(np.unique(t.setting[mask])) >= FEWEST for t in tables for mask in t.usable.values())

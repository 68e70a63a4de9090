"""States of the jobs of a tow, from their files: what a table of runs shows, also of a tow that another process carries out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import isfinite, nan
from pathlib import Path

from coeflab.core.texts import input_error
from coeflab.core.types import brief
from coeflab.core.wording import natural
from coeflab.tank.jobs import JOB, Job, JobState, Progressed, idle_meshes, progress, read_job

FAILED = (JobState.CRASHED, JobState.DIVERGED, JobState.UNCONVERGED)  # of a mesh: nothing can be run on it


@brief
@dataclass(frozen=True, slots=True, eq=False)
class JobRow:
    """One job and how far it is.

    Attributes
    ----------
    job : Job
    progress : Progressed
        Seen with what is true now; ``why`` of a waiting job names the failed one that it needs.
    left : float
        Seconds that it is expected to take still: at its pace, else at that of the finished meshes or runs, else by its
        estimate. 0 for one that is kept or cannot be
        begun; NaN for one that takes longer than was expected.
    """

    job: Job
    progress: Progressed
    left: float


def states_of(folder: Path) -> tuple[JobRow, ...]:
    """The jobs of a tow, meshes first, then runs in natural order; reads nothing but ``job.json`` and ``state.json``.

    Parameters
    ----------
    folder : Path
        Of the tow.

    Raises
    ------
    InputError
        No job is there, or a job.json or state.json is none.
    """
    jobs = sorted((read_job(path.parent) for path in _found(folder)), key=lambda j: (bool(j.needs), natural(j.name)))
    if not jobs:
        raise input_error("tow.folder_tow", folder)
    return rows_of(jobs)


def rows_of(jobs: Sequence[Job]) -> tuple[JobRow, ...]:
    """The states of these jobs, in their order.

    Raises
    ------
    InputError
        A state.json is none.
    """
    now = {job.name: progress(job) for job in jobs}
    idle = idle_meshes(jobs, {name for name, found in now.items() if not found.state.is_final})
    finished = [(job, now[job.name]) for job in jobs if now[job.name].state is JobState.FINISHED]
    paces = {runs: _pace(f for f in finished if bool(f[0].needs) is runs) for runs in (False, True)}
    return tuple(
        _row(job, now[job.name], blocked_by(job, now), job.name in idle, job.seconds * paces[bool(job.needs)])
        for job in jobs
    )


def _pace(finished: Iterable[tuple[Job, Progressed]]) -> float:
    """Seconds that finished jobs took over those that they were expected to take; 1 without one."""
    both = [(found.seconds, job.seconds) for job, found in finished if found.seconds > 0.0 and job.seconds > 0.0]
    return sum(took for took, _ in both) / sum(expected for _, expected in both) if both else 1.0


def blocked_by(job: Job, now: dict[str, Progressed]) -> str:
    """Name and state of a job that failed and without which this one cannot be begun; empty where there is none."""
    return next((f"{n} is {now[n].state.value}" for n in job.needs if n in now and now[n].state in FAILED), "")


def _row(job: Job, found: Progressed, blocked: str, idle: bool, expected: float) -> JobRow:
    if found.state.is_final:
        return JobRow(job, found, 0.0)
    if idle and found.state is not JobState.RUNNING:
        return JobRow(job, replace(found, why="not needed: its runs are kept"), 0.0)
    if found.state is JobState.WAITING and blocked:
        return JobRow(job, replace(found, why=blocked), 0.0)
    if found.state in (JobState.WAITING, JobState.CHANGED):
        return JobRow(job, found, expected)
    left = found.left if isfinite(found.left) else expected - found.seconds
    return JobRow(job, found, left if left > 0.0 else nan)


def time_left(rows: Sequence[JobRow], cores: int) -> float:
    """Seconds until all jobs have ended that can: their work shared by so many cores, and no less than the longest chain.

    Parameters
    ----------
    rows : sequence of JobRow
    cores : int
        That all jobs together may take.

    Returns
    -------
    float
        Jobs that take longer than was expected count as nothing.
    """
    left = {row.job.name: row.left if isfinite(row.left) else 0.0 for row in rows}
    work = sum(left[row.job.name] * min(row.job.cores, cores) for row in rows) / max(cores, 1)
    chain = max(
        (left[row.job.name] + max((left.get(n, 0.0) for n in row.job.needs), default=0.0) for row in rows), default=0.0
    )
    return max(work, chain)


def _found(folder: Path) -> Iterator[Path]:
    """``mesh/NAME`` and ``CONDITION``: nothing deeper, for cases have thousands of files."""
    yield from folder.glob(f"*/{JOB}")
    yield from folder.glob(f"*/*/{JOB}")

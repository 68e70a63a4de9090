"""Runs jobs as processes of this machine, several at once within a budget of cores and memory."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from coeflab.core.declarations import Declaration, Pure, Within
from coeflab.core.errors import CoeflabError, InputError, OutputError
from coeflab.core.machine import cores as all_cores
from coeflab.core.machine import physical_memory
from coeflab.core.text.bounded import log_text
from coeflab.tank.job import ONE_THREAD, REFUSED, disk_is_full
from coeflab.tank.jobs import Job, JobState, progress

summary = "processes of this machine, within a budget of cores and memory"
citations = ()
NAP = 0.25  # s between two looks at the processes
LOG = "log.coeflab"  # what the process of a job says, in its folder
OF_MEMORY = 0.9  # of the machine's, that jobs may take together
WHOLE = Within(lambda v: "" if v >= 0.0 and v == int(v) else "a whole number, 0 or more", schema={"minimum": 0})
NICENESS = Within(
    lambda v: "" if v in range(20) else "a whole number from 0 to 19", schema={"minimum": 0, "maximum": 19}
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Local(Declaration):
    """Jobs as processes of this machine.

    Attributes
    ----------
    cores : int
        That all jobs together may take; 0 for all that this process may use.
    nice : int
        From 0, the priority of other programs, to 19, the lowest.
    """

    cores: Annotated[Pure, WHOLE] = 0
    nice: Annotated[Pure, NICENESS] = 10


options = Local


def carry_out(jobs: Sequence[Job], folder: Path, options: Local, look: Callable[[], None]) -> None:
    """Carry out every job whose needs are finished, in their order as far as cores and memory allow.

    A job begins when its cores are free and it fits into nine tenths of the memory together with those that run; one that is
    larger than that runs alone. Ctrl-C lets all jobs write what they have, and end; a second one kills their solvers.

    Raises
    ------
    InputError
        A job takes more cores than there are to be used.
    OutputError
        The disk is full: no job is begun any more, and those that ran have ended.
    CoeflabError
        Jobs that could not be carried out at all; the others have ended.
    """
    budget = int(options.cores) or all_cores()
    for job in jobs:
        if job.cores > budget:
            raise InputError(f"{job.cores} cores for {job.name}", f"at most {budget}, which all jobs together may take",
                             column="cores", advice="Take fewer cores a run, or allow more.")  # fmt: skip
    waiting = list(jobs)
    running: list[tuple[Job, subprocess.Popen[bytes]]] = []
    refused: list[str] = []
    failed: set[str] = set()
    try:
        while waiting or running:
            for job, process in [(j, p) for j, p in running if p.poll() is not None]:
                running.remove((job, process))
                if process.returncode == REFUSED:
                    refused.append(_last_message(job))
                if process.returncode == REFUSED or progress(job).state is not JobState.FINISHED:
                    failed.add(job.name)
            waiting = list(_possible(waiting, failed))
            full = bool(waiting) and disk_is_full(folder)
            if full and not running:
                raise OutputError(f"the disk of {folder} is full. Free some space, then go on with --continue.")
            for job in () if full else tuple(_startable(waiting, [j for j, _ in running], budget)):
                waiting.remove(job)
                running.append((job, _begun(job, int(options.nice))))
            look()
            time.sleep(NAP)
    finally:
        _end([process for _, process in running])
    if refused:
        raise CoeflabError("\n".join(refused))


def _possible(waiting: Sequence[Job], failed: set[str]) -> Iterator[Job]:
    """The jobs that do not need one that failed; the others count as failed."""
    for job in waiting:
        if failed.intersection(job.needs):
            failed.add(job.name)
        else:
            yield job


def _startable(waiting: Sequence[Job], running: Sequence[Job], budget: int) -> Iterator[Job]:
    """The jobs that fit beside those that run, and whose needs are behind."""
    ahead = {job.name for job in (*waiting, *running)}
    cores, memory = budget - sum(j.cores for j in running), sum(j.memory for j in running)
    most, count = OF_MEMORY * (physical_memory() or float("inf")), len(running)
    for job in waiting:
        fits = job.cores <= cores and (memory + job.memory <= most or not count)
        if fits and not ahead.intersection(job.needs):
            cores, memory, count = cores - job.cores, memory + job.memory, count + 1
            yield job


def _begun(job: Job, nice: int) -> subprocess.Popen[bytes]:
    """The process of a job, in a session of its own: Ctrl-C reaches this process alone."""
    command = (
        sys.executable,
        "-m",
        "coeflab.tank.job",
        str(job.folder),
        "--end-with",
        str(os.getpid()),
        "--nice",
        str(nice),
    )
    try:
        with (job.folder / LOG).open("ab") as log:
            return subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, env={**ONE_THREAD, **os.environ},
                start_new_session=True,
            )  # fmt: skip
    except OSError as why:
        raise OutputError(f"{job.name} cannot be begun: {why.strerror or why}.") from None


def _last_message(job: Job) -> str:
    """The last that the process of a job said."""
    lines = log_text(job.folder / LOG).splitlines()
    return f"{job.name}: {lines[-1].removeprefix('error: ') if lines else 'it printed nothing'}"


def _end(processes: Sequence[subprocess.Popen[bytes]]) -> None:
    """Ask the processes of jobs to end, once more at every further Ctrl-C, and wait until they have."""
    interrupted = False
    while living := [p for p in processes if p.poll() is None]:
        for process in living:
            process.terminate()
        try:
            for process in living:
                process.wait()
        except KeyboardInterrupt:
            interrupted = True
    if interrupted:
        raise KeyboardInterrupt

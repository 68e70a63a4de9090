"""Runs jobs on the workers of a Dask scheduler; one whose worker dies is carried on by another one.

The workers need the folder of the tow at the same path, this release of coeflab and the solver. One that is started with
``--resources "cores=16"`` takes as many jobs at once as their cores allow; without, every thread of it takes one job.
"""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coeflab.core.declarations import Declaration, Words
from coeflab.core.errors import CoeflabError
from coeflab.core.machine import dask_client
from coeflab.core.texts import input_error
from coeflab.tank.job import REFUSED
from coeflab.tank.jobs import Job, JobState, progress, read_progress

summary = "the workers of a Dask scheduler, each job as a process there"
citations = (
    "Rocklin, M. (2015): Dask: Parallel Computation with Blocked algorithms and Task Scheduling. Proc. 14th Python in Science "
    "Conf., 126-132.",
)
NAP = 0.25  # s between two looks at the jobs
CORES = "cores"  # the resource that workers may declare


@dataclass(frozen=True, slots=True, kw_only=True)
class Dask(Declaration):
    """Jobs on the workers of a Dask scheduler.

    Attributes
    ----------
    scheduler : str
        Its address, such as ``tcp://host:8786``.
    """

    scheduler: Words = ""


options = Dask


def attempted(folder: str) -> tuple[int, str]:
    """Carry out a job, in a worker: the exit code, and the last that its process said.

    Parameters
    ----------
    folder : str
        Of the job.
    """
    # The process ends with the thread that started it, which waits for it here.
    command = (sys.executable, "-m", "coeflab.tank.job", "--end-with", str(os.getpid()), folder)
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False)
    lines = done.stderr.splitlines()
    return done.returncode, lines[-1].removeprefix("error: ") if lines else ""


def stopped(folders: Sequence[str]) -> None:
    """Ask the jobs that this machine carries out to end, in a worker.

    Parameters
    ----------
    folders : sequence of str
        Of the jobs.
    """
    for folder in folders:
        found = read_progress(Path(folder))
        if found.state is JobState.RUNNING and found.host == socket.gethostname():
            with suppress(ProcessLookupError):
                os.kill(found.process, signal.SIGTERM)


def carry_out(jobs: Sequence[Job], folder: Path, options: Dask, look: Callable[[], None]) -> None:  # noqa: ARG001
    """Carry out every job whose needs are finished; Ctrl-C lets those that run write what they have, and end.

    Raises
    ------
    InputError
        No distributed, no scheduler that answers, or no worker with the cores of a job.
    CoeflabError
        A worker lacks coeflab, or jobs could not be carried out at all; the others have ended.
    """
    with dask_client(options.scheduler, "scheduler") as client:
        offered = _offered(client)
        for job in jobs:
            if offered and job.cores > max(offered.values()):
                found = f"{job.cores} cores for {job.name}"
                raise input_error("tow.most_resource_cores", column=CORES, found=found, max=max(offered.values()))
        waiting, failed, refused = list(jobs), set[str](), list[str]()
        running: dict[str, tuple[Job, Any]] = {}
        try:
            while waiting or running:
                for name in [name for name, (_, future) in running.items() if future.done()]:
                    job, future = running.pop(name)
                    refused += _refused(job, future)
                    if progress(job).state is not JobState.FINISHED:
                        failed.add(name)
                failed.update(job.name for job in waiting if failed.intersection(job.needs))
                waiting = [job for job in waiting if job.name not in failed]
                ahead = {job.name for job in waiting} | set(running)
                for job in [job for job in waiting if not ahead.intersection(job.needs)]:
                    waiting.remove(job)
                    asked = {CORES: job.cores} if offered else None
                    running[job.name] = job, client.submit(attempted, str(job.folder), pure=False, resources=asked)
                look()
                time.sleep(NAP)
        except (KeyboardInterrupt, SystemExit):
            client.cancel([future for _, future in running.values()])
            client.run(stopped, [str(job.folder) for job, _ in running.values()])
            raise
    if refused:
        raise CoeflabError("\n".join(refused))


def _offered(client: Any) -> Mapping[str, float]:
    """Cores that workers declare; empty where none does."""
    workers = client.scheduler_info(n_workers=-1)["workers"]
    return {address: worker["resources"][CORES] for address, worker in workers.items() if CORES in worker["resources"]}


def _refused(job: Job, future: Any) -> list[str]:
    """What is to be said of a job that could not be carried out."""
    import distributed

    try:
        code, words = future.result()
    except ModuleNotFoundError as why:
        raise CoeflabError(f"A Dask worker has no module {why.name}: install this release of coeflab there.") from None
    except distributed.KilledWorker:
        return [f"{job.name}: every worker that carried it out died."]
    return [f"{job.name}: {words or 'it printed nothing'}"] if code == REFUSED else []

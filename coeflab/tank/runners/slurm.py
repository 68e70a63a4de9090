"""Runs jobs on a cluster under Slurm, through submitit: arrays of jobs that need the same meshes, and these before them.

An attempt that comes to its wall time lets its solver write and goes back into the queue, as does one whose node dies; the next
attempt goes on from what the solver wrote last. The nodes need the folder of the tow and this Python at the same paths.
"""

from __future__ import annotations

import hashlib
import importlib.util
import json
import logging
import math
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any

from coeflab.core import declarations as takes
from coeflab.core.declarations import Declaration
from coeflab.core.errors import CoeflabError, InputError, shown
from coeflab.core.files import write_atomically
from coeflab.core.text.records import plain_name, read_record
from coeflab.core.texts import input_error
from coeflab.tank.jobs import Job, JobState, Progressed, read_progress, write_progress

summary = "a cluster under Slurm: arrays of jobs, requeued at their wall time or when a node dies"
citations = (
    "Yoo, A.B., Jette, M.A., Grondona, M. (2003): SLURM: Simple Linux Utility for Resource Management. LNCS 2862, 44-60.",
)

COMMAND = (sys.executable, "-m", "coeflab.tank.job", "--alone")  # Slurm sees to it that no other node carries it out
SIGNAL = "USR2"  # that submitit expects before the wall time
LEFT = "slurm.json"  # ids of the jobs that were given to Slurm, in folder/.runner
OVER = {
    "BOOT_FAIL",
    "CANCELLED",
    "COMPLETED",
    "DEADLINE",
    "FAILED",
    "NODE_FAIL",
    "OUT_OF_MEMORY",
    "PREEMPTED",
    "TIMEOUT",
}
LOOK, SOONEST, LATEST = 0.25, 1.0, 30.0  # s between two looks at state files, and the bounds between two at the queue
SILENT = 900.0  # s that Slurm may leave questions unanswered


def _whole(given: Any, _file: Path) -> int:
    if isinstance(given, bool) or not isinstance(given, int) or given < 1:
        raise InputError(shown(given), "a whole number above zero")
    return given


Whole = Annotated[int, takes.Takes("a whole number above zero", _whole, {"type": "integer", "minimum": 1})]


@dataclass(frozen=True, slots=True, kw_only=True)
class Slurm(Declaration):
    """Jobs of a cluster.

    Attributes
    ----------
    partition : str
        By default that of the cluster.
    account : str
        That the time is booked on.
    wall_time : float
        Of one attempt. A run that takes longer goes back into the queue and goes on from what it wrote last.
    notice : float
        Before the end of the wall time, in which the solver writes and ends.
    attempts : int
        That a job may take because of its wall time; a node that dies does not count.
    at_once : int
        Jobs of an array that run at the same time, at most.
    memory : float
        Asked for, over what the job is expected to take; zero asks for none.
    setup : tuple of str
        Lines of the shell before every job, such as ``module load openfoam``.
    extra : mapping
        Further options of sbatch without their dashes, such as ``qos = "long"``.
    cancel : bool
        Take the jobs out of the queue when the tow is interrupted. By default they go on, and ``--continue`` finds them.
    """

    partition: takes.Words = ""
    account: takes.Words = ""
    wall_time: Annotated[takes.Time, takes.ABOVE_ZERO] = 14400.0
    notice: Annotated[takes.Time, takes.ABOVE_ZERO] = 120.0
    attempts: Whole = 20
    at_once: Whole = 256
    memory: Annotated[takes.Pure, takes.ZERO_OR_MORE] = 1.5
    setup: takes.Texts = ()
    extra: Annotated[Mapping[str, Any], takes.TABLE] = field(default_factory=dict)
    cancel: takes.Flag = False

    def check(self) -> None:
        """The notice is within the wall time."""
        if self.notice >= self.wall_time:
            found, expected = f"{self.notice:g} s", f"less than the wall time of {self.wall_time:g} s"
            raise InputError(found, expected, column="notice")


options = Slurm


class Attempt:
    """One attempt at a job, on its node: submitit calls it, and asks it to checkpoint before the wall time.

    Parameters
    ----------
    command : tuple of str
        Carries out the job whose folder comes last.
    folder : str
    """

    def __init__(self, command: tuple[str, ...], folder: str) -> None:
        self.command, self.folder = command, folder
        self.process: subprocess.Popen[bytes] | None = None

    def __call__(self) -> None:
        """Carry out the job.

        Raises
        ------
        CoeflabError
            It did not end as it should: Slurm does not start what needs it.
        """

        # Slurm may send the signal to all processes of a job; a solver would end by it, or write at the wrong time.
        def unsignalled() -> None:
            signal.signal(signal.Signals[f"SIG{SIGNAL}"], signal.SIG_IGN)

        command = (*self.command, "--end-with", str(os.getpid()), self.folder)
        self.process = subprocess.Popen(command, preexec_fn=unsignalled)  # noqa: PLW1509 - no threads here
        while self.process.poll() is None:  # not wait: checkpoint would find it locked
            time.sleep(LOOK)
        if self.process.returncode:
            raise CoeflabError(f"{self.folder}: exit code {self.process.returncode}")

    def checkpoint(self) -> Any:
        """End the job as it stands, and give what goes on from there: called by submitit's handler of the signal."""
        from submitit.helpers import DelayedSubmission

        if self.process is not None:
            with suppress(ProcessLookupError, ChildProcessError):
                os.kill(self.process.pid, signal.SIGTERM)
                os.waitid(os.P_PID, self.process.pid, os.WEXITED | os.WNOWAIT)
        return DelayedSubmission(Attempt(self.command, self.folder))


@dataclass(frozen=True, slots=True)
class Queue:
    """What Slurm says of jobs.

    Attributes
    ----------
    name : str
        That the jobs of this tow have in the queue.
    ids : dict of str to str
        Of each job by its name: ``12_0`` in an array.
    """

    name: str
    ids: dict[str, str]

    def states(self) -> dict[str, str]:
        """State by id, also of jobs that ended a short time ago.

        Raises
        ------
        CoeflabError
            Slurm does not answer.
        """
        lines = _asked(
            "squeue", "--me", "--array", "--noheader", "--states=all", "--format=%i %T", f"--name={self.name}"
        )
        return dict(line.split() for line in lines.splitlines() if len(line.split()) == 2)

    def cancel(self, names: Iterable[str]) -> None:
        """Take jobs out of the queue, and end those that run.

        Raises
        ------
        CoeflabError
            Slurm does not answer.
        """
        if ids := [self.ids[name] for name in names if name in self.ids]:
            _asked("scancel", "--quiet", *ids)


def _asked(*command: str) -> str:
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    except (OSError, subprocess.TimeoutExpired) as why:
        raise CoeflabError(f"Slurm's {command[0]} does not answer ({type(why).__name__}).") from None
    if done.returncode:
        raise CoeflabError(f"Slurm's {command[0]} says: {done.stderr.strip()}")
    return done.stdout


def carry_out(jobs: Sequence[Job], folder: Path, options: Slurm, look: Callable[[], None]) -> None:
    """Give the jobs to Slurm, those of an earlier call that are still in its queue left there, and wait for their end.

    Parameters
    ----------
    jobs : sequence of Job
    folder : Path
        Of the tow.
    options : Slurm
    look : callable

    Raises
    ------
    InputError
        There is no Slurm here, no submitit, or Slurm refuses an option.
    CoeflabError
        Slurm does not answer any more.
    """
    _there()
    selected = folder / ".runner" / LEFT
    queue, keys = _left(selected, folder)
    waiting = _taken_over(jobs, queue, keys)
    given: list[str] = []
    try:
        for group in arrays([job for job in jobs if job.name not in waiting]):
            before = [queue.ids[job.name] for job in jobs if job.name in group[0].needs]
            queue.ids.update(_submitted(group, before, queue.name, folder / ".runner" / "slurm", options))
            keys.update({job.name: job.key for job in group})
            given += [job.name for job in group]
            content = {name: {"id": number, "key": keys[name]} for name, number in queue.ids.items()}
            write_atomically(selected, (json.dumps(content, indent=1) + "\n").encode())
        _watched(jobs, queue, look)
    except InputError:
        queue.cancel(given)
        raise
    except (KeyboardInterrupt, SystemExit):
        if options.cancel:
            queue.cancel(job.name for job in jobs)
        else:
            words = "the jobs go on in Slurm; `coeflab tow --continue` finds them, `scancel --name=%s` ends them."
            logging.getLogger("coeflab").warning(words, queue.name)
        raise


def _there() -> None:
    for program in ("sbatch", "squeue", "srun"):
        if shutil.which(program) is None:
            raise InputError(f"no {program}", "Slurm on this machine", key="runner", advice='Use runner = "local".')
    if importlib.util.find_spec("submitit") is None:
        advice = 'pip install "coeflab[slurm]"'
        raise InputError("the runner slurm without submitit", "the extra", key="runner", advice=advice)


def _left(file: Path, folder: Path) -> tuple[Queue, dict[str, str]]:
    """What an earlier call gave to Slurm, and with which keys."""
    advice = "Delete it once none of its jobs is in the queue: squeue."
    shape = {plain_name: {"id": str, "key": str}}
    content = read_record(file, shape, "the jobs that Slurm has", advice=advice) if file.is_file() else {}
    own = hashlib.sha256(str(folder.absolute()).encode()).hexdigest()[:6]
    name = f"coeflab_{re.sub(r'[^A-Za-z0-9_.-]', '_', folder.name)}_{own}"
    return Queue(name, {n: c["id"] for n, c in content.items()}), {n: c["key"] for n, c in content.items()}


def _taken_over(jobs: Sequence[Job], queue: Queue, keys: Mapping[str, str]) -> set[str]:
    """Names of jobs that Slurm still has as they are; those that changed meanwhile are taken out of the queue."""
    if not queue.ids:
        return set()
    states = queue.states()
    there = {job.name: keys[job.name] == job.key for job in jobs
             if job.name in queue.ids and states.get(queue.ids[job.name], "CANCELLED") not in OVER}  # fmt: skip
    queue.cancel(name for name, same in there.items() if not same)
    return {name for name, same in there.items() if same}


def arrays(jobs: Sequence[Job]) -> list[list[Job]]:
    """Jobs that need the same and take as many cores, together; each group after those that it needs."""
    groups: dict[tuple[frozenset[str], int], list[Job]] = {}
    for job in jobs:
        groups.setdefault((frozenset(job.needs), job.cores), []).append(job)
    return list(groups.values())


def _submitted(group: Sequence[Job], before: Sequence[str], name: str, folder: Path, options: Slurm) -> dict[str, str]:
    """Give a group to Slurm, behind the jobs of those ids; the ids of its own.

    Raises
    ------
    InputError
        Slurm refuses it.
    """
    import submitit

    folder.mkdir(parents=True, exist_ok=True)
    # One process asks for all cores of a job, since mpirun starts one a task; submitit takes the place of the shell, so that
    # the signal comes to it alone.
    executor = submitit.SlurmExecutor(
        folder, max_num_timeout=options.attempts - 1, python=f"exec {shlex.quote(sys.executable)}"
    )
    extra = {"ntasks": group[0].cores, "signal": f"B:{SIGNAL}@{options.notice:.0f}"}
    extra |= {"requeue": True, "kill-on-invalid-dep": "yes"}
    extra |= {option: value for option, value in options.extra.items() if value is not False}
    memory = options.memory * max(job.memory for job in group)
    chosen = {
        "job_name": name, "time": math.ceil(options.wall_time / 60.0), "use_srun": False, "stderr_to_stdout": True,
        "wckey": None, "partition": options.partition or None, "account": options.account or None,
        "mem": f"{math.ceil(memory / 1e6)}M" if memory else None, "setup": list(options.setup) or None,
        "dependency": "afterok:" + ":".join(before) if before else None, "array_parallelism": options.at_once,
        "additional_parameters": extra,
    }  # fmt: skip
    executor.update_parameters(**{key: value for key, value in chosen.items() if value is not None or key == "wckey"})
    try:
        given = executor.submit_array([Attempt(COMMAND, str(job.folder)) for job in group])
    except (submitit.core.utils.UncompletedJobError, submitit.core.utils.FailedSubmissionError) as why:
        words = re.sub(r"sbatch: (error: )?", "", str(why)).strip().replace("\n", " ")
        raise input_error("tow.options_slurm_refuses", key="[runner.slurm]", words=words) from None
    return {job.name: one.job_id for job, one in zip(group, given, strict=True)}


def _watched(jobs: Sequence[Job], queue: Queue, look: Callable[[], None]) -> None:
    """Wait until Slurm has none of the jobs any more, and say of those that it ended what their files cannot."""
    open_jobs = {queue.ids[job.name]: job for job in jobs}
    over: dict[str, str] = {}  # by id, as seen the last time: a job that is requeued may look ended for a moment
    begun = answered = time.monotonic()
    while open_jobs:
        until = time.monotonic() + min(max(SOONEST, (time.monotonic() - begun) / 20.0), LATEST)
        while time.monotonic() < until:
            look()
            time.sleep(LOOK)
        try:
            states = queue.states()
        except CoeflabError:
            if time.monotonic() - answered > SILENT:
                raise
            continue
        answered = time.monotonic()
        now = {number: states.get(number, "gone") for number in open_jobs}
        for number, state in now.items():
            if (state in OVER or state == "gone") and over.get(number) == state:
                _ended(open_jobs.pop(number), number, state)
        over = now
    look()


def _ended(job: Job, number: str, state: str) -> None:
    """Say in the job's own file how Slurm ended it, where the job could not."""
    found = read_progress(job.folder)
    if found.state is JobState.RUNNING:
        killed = "it took more memory than was asked for: set memory in [runner.slurm]"
        why = killed if state == "OUT_OF_MEMORY" else "`coeflab tow --continue` carries it on"
        ended = JobState.CRASHED if state == "OUT_OF_MEMORY" else JobState.STOPPED
        write_progress(
            job.folder, replace(found, state=ended, left=math.nan, why=f"Slurm, job {number}: {state}; {why}")
        )
    elif found.state is JobState.WAITING and state == "FAILED":
        why = f"Slurm, job {number}: {state} before it began; see .runner/slurm/{number}_0_log.out"
        write_progress(job.folder, Progressed(JobState.CRASHED, key=job.key, why=why))

"""One job, carried out: ``python -m coeflab.tank.job FOLDER``.

Its steps run one after another, each with its log. The solver is watched: it is stopped on its plateau, when it diverges and
when this process is asked to end (SIGTERM, SIGINT). Whatever ends this process, the solver ends with it, ``state.json`` shows
it, and the next attempt goes on from what the solver wrote last.

A plateau is looked for at fixed lengths of the history, so that the result does not depend on when this process looked. A run
that has to make all its iterations is judged at its end.

The exit code is 0 for a job that is kept (finished, unconverged), 1 for one that diverged or crashed, 2 for one that cannot be
carried out, 3 for one that was stopped and goes on.
"""

from __future__ import annotations

import argparse
import itertools
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coeflab.core.errors import CoeflabError, InputError, OutputError, shown
from coeflab.core.text.bounded import log_text
from coeflab.tank import jobs
from coeflab.tank.processes import end_session, ends_with, memory, started

if TYPE_CHECKING:
    from coeflab.tables.raw_table import Run
    from coeflab.tank.plateau import Verdict
    from coeflab.tank.solvers import TowSolver

GRACE, KILL = 60.0, 10.0  # s in which a solver has to write and end when it is asked to, and to end when it is made to
NOTICE, BEAT = 0.2, 5.0  # s until a signal is noticed, and between signs of life
TOGETHER = 2.0  # s in which a signal that goes to all processes of a job has reached this one, too
EARLIEST, LATEST, SHARE = 2.0, 60.0, 50.0  # s between two looks at the history; times what one takes of a core
FIRST, SPACING, LEAST = (
    50,
    1.1,
    10,
)  # rows at which a plateau is looked for: the first, the ratio to the next, the least step
FULL = 16e6  # bytes that are left of a full disk
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # unless the environment says otherwise
FAILED, REFUSED, STOPPED = 1, 2, 3  # exit codes
MOST_WORDS = 400  # letters of an error that a log says
_FATAL = re.compile(r"--> FOAM FATAL (IO )?ERROR:?")
_SOURCE = re.compile(r"file: |From |in file |FOAM \w*\s*(exiting|aborting)")
ASKING = ("SIGTERM", "SIGINT")
CODES = {jobs.JobState.DIVERGED: FAILED, jobs.JobState.CRASHED: FAILED, jobs.JobState.STOPPED: STOPPED}


@dataclass(slots=True)
class Asked:
    """How often this process was asked to end."""

    times: int = 0


def carry_out(folder: Path, alone: bool = False) -> jobs.Progressed:
    """Carry out the job of a folder, from the start or from what its solver wrote last, and say how it ended.

    Parameters
    ----------
    folder : Path
    alone : bool
        The caller, such as a scheduler that requeues, knows that no other machine carries the job out.

    Returns
    -------
    Progressed
        As ``state.json`` has it. A job that is kept is left alone.

    Raises
    ------
    InputError
        The folder has no job, or another process carries it out.
    OutputError
        The folder cannot be written.
    """
    job = jobs.read_job(folder)
    with jobs.only_one(job.folder, "job", jobs.PATIENCE) as lock:
        before = jobs.progress(job)
        if before.state.is_final:
            return before
        if before.state is jobs.JobState.RUNNING and not alone:
            raise InputError(f"a job that process {before.process} on {before.host} carries out", "one job at a time in a folder",
                             file=job.folder, advice="Wait for it, or end that process.")  # fmt: skip
        (job.folder / jobs.EARLIER).unlink(missing_ok=True)  # from now on the run is our own
        with asked_to_end() as asked:
            return _Attempt(job, before, lock, asked).execute()


@contextmanager
def asked_to_end() -> Iterator[Asked]:
    """Count SIGTERM and SIGINT instead of ending by them."""
    asked = Asked()

    def count(_number: int, _frame: object) -> None:
        asked.times += 1

    before = {number: signal.signal(number, count) for number in (signal.SIGTERM, signal.SIGINT)}
    try:
        yield asked
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def lengths(rows: int) -> Iterator[int]:
    """Rows of a history at which a plateau is looked for, up to those that there are."""
    n = FIRST
    while n <= rows:
        yield n
        n = max(n + LEAST, int(SPACING * n))


class _Attempt:
    """One attempt at a job."""

    def __init__(self, job: jobs.Job, before: jobs.Progressed, lock: int, asked: Asked) -> None:
        self.job, self.before, self.lock, self.asked = job, before, lock, asked
        self.began = time.monotonic()
        me = os.getpid()
        self.now = jobs.Progressed(
            jobs.JobState.RUNNING, job.key, seconds=before.seconds, memory=before.memory, process=me,
            host=socket.gethostname(), started=started(me),
        )  # fmt: skip
        self.solver: TowSolver | None = None
        self.verdict: Verdict | None = None
        self.took = 0.0  # s of this process for the last look
        self.looked = 0  # rows at which a plateau was looked for last
        self.pace: tuple[float, float] | None = None  # time and iteration of the first look
        self.killed = ""  # what is to be said of a solver that did not end by itself
        self.stopped = False

    def execute(self) -> jobs.Progressed:
        """Carry out the steps; whatever happens, no process of a step is left and the state says how it ended."""
        try:
            self._say()
            steps, at = self._steps()
            self._say(resumed_from=at, iteration=at)
            code = 0
            for step in steps:
                self._say(step=step.name)
                code = self._run(step)
                self.stopped = (
                    self.stopped or (self.asked.times > 0 and step is not steps[-1]) or self._ended_with_us(code)
                )
                if code or self.stopped:
                    break
            self._end(code)
        except CoeflabError as why:
            self._say(state=jobs.JobState.CRASHED, left=nan, why=str(why))
        except BaseException as why:
            with suppress(OutputError):
                self._say(state=jobs.JobState.CRASHED, left=nan, why=f"{type(why).__name__}: {shown(why)}")
            raise
        return self.now

    def _steps(self) -> tuple[tuple[jobs.Step, ...], float]:
        """What is left to do, and the iteration from which it goes on."""
        resumed = self._plugin().resumed if self.before.state.goes_on else None
        return resumed(self.job) if resumed is not None else (self.job.steps, nan)

    def _plugin(self) -> TowSolver:
        if self.solver is None:
            from coeflab.tank.solvers import SOLVERS

            self.solver = SOLVERS.load(self.job.solver)
        return self.solver

    def _say(self, **changes: Any) -> None:
        spent = self.before.seconds + time.monotonic() - self.began
        self.now = replace(self.now, seconds=spent, **changes)
        jobs.write_progress(self.job.folder, self.now)

    def _run(self, step: jobs.Step) -> int:
        """Run one step to its end; its exit code, negative for a signal."""
        log = self.job.folder / f"log.{step.name}"
        _move_aside(log)
        try:
            with log.open("wb") as stream:
                process = subprocess.Popen(
                    step.command, cwd=self.job.folder, stdin=subprocess.DEVNULL, stdout=stream, stderr=subprocess.STDOUT,
                    env={**ONE_THREAD, **os.environ}, start_new_session=True, pass_fds=(self.lock,),
                    preexec_fn=ends_with(os.getpid()),  # noqa: PLW1509 - no threads here
                )  # fmt: skip
        except OSError as why:
            words = f"{step.command[0]} cannot be started: {why.strerror or why}"
            raise OutputError(words) from None
        try:
            return self._watch(step, process)
        finally:
            if process.poll() is None:
                end_session(process.pid, KILL)
            process.wait()

    def _ended_with_us(self, code: int) -> bool:
        """Whether a step was ended by a signal that this process got as well, as by a scheduler that ends a whole tree."""
        if not code or self.now.plateau or (self.verdict is not None and self.verdict.diverged):
            return False
        end = time.monotonic() + TOGETHER
        while _signal_of(code) in ASKING and not self.asked.times and time.monotonic() < end:
            time.sleep(NOTICE)
        return self.asked.times > 0

    def _watch(self, step: jobs.Step, process: subprocess.Popen[bytes]) -> int:
        """Wait for the end of a step, give signs of life, and look at the history of a solver."""
        begun = time.monotonic()
        if step.watched:
            self._plugin()  # imported while the solver starts, too
        beat, look = begun + NOTICE, begun + EARLIEST
        while True:
            with suppress(subprocess.TimeoutExpired):
                return process.wait(NOTICE)
            now = time.monotonic()
            if self.asked.times:
                return self._stop(step, process)
            if now >= beat:
                self._say(memory=max(self.now.memory, memory(process.pid)))
                beat = now + min(max(now - begun, NOTICE), BEAT)
            if step.watched and now >= look:
                self._look()
                if self.verdict is not None and (self.verdict.diverged or self.now.plateau):
                    return self._stop(step, process)
                look = time.monotonic() + min(max(SHARE * self.took, EARLIEST, self._until_next()), LATEST)

    def _look(self) -> None:
        """Read the history and look for a plateau at the lengths that it has reached since the last look."""
        history = self._plugin().history
        if history is None:
            return
        begun = time.process_time()
        with suppress(InputError, OSError):  # nothing written yet, or half a line
            run = history(self.job.folder)
            self._judge(run, [n for n in lengths(len(run.history)) if n > self.looked])
        self.took = time.process_time() - begun

    def _judge(self, run: Run, rows: Sequence[int], ends: bool = False) -> None:
        from coeflab.tank.plateau import on_plateau, until

        at = run.history.meaning("iteration") or run.history.meaning("time")
        iteration = float(at.values[-1]) if at is not None and len(at.values) else float(len(run.history))
        for n in rows:
            self.looked, self.verdict = n, on_plateau(until(run, n))
            if self.verdict.diverged or (self.verdict.settled and not self.job.to_the_end):
                break
        counts = self.verdict is not None and self.verdict.settled and (ends or not self.job.to_the_end)
        changes: dict[str, Any] = {}
        if self.verdict is not None:
            means = self.verdict.plateau.means
            changes = {
                "means": {c: m.value for c, m in means.items()}, "errors": {c: m.steady_error for c, m in means.items()},
                "plateau": self.looked if counts else 0, "why": self.verdict.why,
            }  # fmt: skip
        self._say(iteration=iteration, left=self._left(iteration), **changes)

    def _until_next(self) -> float:
        """Seconds until the history has the next length at which it is judged, at the pace since the first look."""
        if self.pace is None or not self.now.iteration > self.pace[1]:
            return 0.0
        then, first = self.pace
        following = next(n for n in lengths(int(2 * self.looked + 2 * FIRST)) if n > self.looked)
        return (following - self.now.iteration) * (time.monotonic() - then) / (self.now.iteration - first)

    def _left(self, iteration: float) -> float:
        """Seconds to the last iteration, at the pace since the first look."""
        now = time.monotonic()
        if self.pace is None:
            self.pace = now, iteration
        then, first = self.pace
        return (self.job.iterations - iteration) * (now - then) / (iteration - first) if iteration > first else nan

    def _stop(self, step: jobs.Step, process: subprocess.Popen[bytes]) -> int:
        """End a step; a solver is asked to write first, unless it diverged or somebody asks a second time."""
        settled = self.now.plateau > 0
        diverged = self.verdict is not None and self.verdict.diverged
        self.stopped = not settled and not diverged
        stop = self._plugin().stop if step.watched and not diverged else None
        if stop is not None:
            stop(self.job.folder)
            end = time.monotonic() + GRACE
            while time.monotonic() < end and self.asked.times < 2:
                with suppress(subprocess.TimeoutExpired):
                    process.wait(NOTICE)
                    return 0
            self.killed = f"{step.name} did not end within {GRACE:g} s when it was asked to, and was killed"
        self._say(memory=max(self.now.memory, memory(process.pid)))
        end_session(process.pid, KILL)
        code = process.wait()
        return 0 if settled else code

    def _end(self, code: int) -> None:
        """Say how the job ended."""
        if self.stopped:
            self._say(state=jobs.JobState.STOPPED, left=nan, why="asked to end")
            return
        plugin = self._plugin()
        watched = plugin.history is not None and any(step.watched for step in self.job.steps)
        if watched and not self.now.plateau:
            self._judge_whole()
        remarks, reason = plugin.ended(self.job) if plugin.ended is not None else ((), "")
        if self.killed:
            remarks = (*remarks, self.killed)
        state, why = jobs.JobState.FINISHED, ""
        if self.verdict is not None and self.verdict.diverged:
            state, why = jobs.JobState.DIVERGED, self.verdict.why
        elif code or (reason and not self.killed):
            state = jobs.JobState.DIVERGED if _signal_of(code) == "SIGFPE" else jobs.JobState.CRASHED
            words = self._last_words(code) if code else ""
            why = "; ".join(filter(None, (words, "" if words and reason.startswith("log.") else reason)))
        elif watched and not self.now.plateau:
            state, why = jobs.JobState.UNCONVERGED, self.now.why or "no history of forces"
        self._say(state=state, left=nan, why=why, remarks=tuple(remarks))

    def _judge_whole(self) -> None:
        """Look at the history of a solver that ended by itself: at the lengths that are left, and at its whole."""
        history = self._plugin().history
        try:
            run = history(self.job.folder) if history is not None else None
        except (InputError, OSError) as why:
            self._say(why=str(why))
            return
        if run is not None and len(run.history):
            rows = len(run.history)
            left = () if self.job.to_the_end else (n for n in lengths(rows) if n > self.looked)
            self._judge(run, sorted({rows, *left}), ends=True)

    def _last_words(self, code: int) -> str:
        """What shows a crash: a full disk, else what the log says of a fatal error, else its last line."""
        log = self.job.folder / f"log.{self.now.step}"
        by = _signal_of(code)
        how = f"ended by {by}" if by else f"exit code {code}"
        how += ", as by a system without memory" * (by == "SIGKILL")
        with suppress(OSError):
            if disk_is_full(self.job.folder):
                return f"the disk is full ({self.now.step}: {how})"
            lines = log_text(log).splitlines()
            number, text = fatal_error(lines)
            if not number:
                number = max((i for i, line in enumerate(lines, 1) if line.strip()), default=0)
                text = shown(lines[number - 1].strip()) if number else ""
            if number:
                return f"{self.now.step}: {how}; {log.name}:{number}: {text}"
        return f"{self.now.step}: {how}"


def fatal_error(lines: Sequence[str]) -> tuple[int, str]:
    """What OpenFOAM says behind ``--> FOAM FATAL ERROR`` or ``FATAL IO ERROR``, and its line from 1; 0 and nothing without.

    What comes after it names its sources and ends with ``FOAM exiting``, which says nothing.
    """
    bare = [re.sub(r"^\[\d+\]\s*|\(openfoam[^)]*\)", "", line).strip() for line in lines]
    at = next((i for i, line in enumerate(bare) if _FATAL.match(line)), -1)
    if at < 0:
        return 0, ""
    bare[at] = _FATAL.sub("", bare[at]).strip()
    start = next((i for i in range(at, len(bare)) if bare[i]), at)
    words = itertools.takewhile(lambda line: line and not _SOURCE.match(line), bare[start:])
    return start + 1, " ".join(" ".join(words).split())[:MOST_WORDS]


def _signal_of(code: int) -> str:
    """Name of the signal that ended a program; a shell and mpirun add 128 to its number."""
    number = -code if code < 0 else code - 128
    return signal.Signals(number).name if number in set(signal.Signals) else ""


def disk_is_full(folder: Path) -> bool:
    """Whether next to nothing can be written there any more."""
    return shutil.disk_usage(folder).free < FULL


def _move_aside(log: Path) -> None:
    """Move the log of an earlier attempt aside: log.simpleFoam.1 is the first."""
    if log.exists():
        number = 1
        while log.with_name(f"{log.name}.{number}").exists():
            number += 1
        log.replace(log.with_name(f"{log.name}.{number}"))


def main(arguments: Sequence[str] | None = None) -> int:
    """Carry out the job that the command line names; the exit code."""
    parser = argparse.ArgumentParser(prog="python -m coeflab.tank.job", description="Carry out one job of a tow.")
    parser.add_argument("folder", type=Path, help="folder of the job")
    parser.add_argument("--alone", action="store_true", help="no other machine carries it out, whatever its state says")
    parser.add_argument(
        "--end-with", type=int, default=0, metavar="PID", help="stop when that process, the parent, is gone"
    )
    parser.add_argument("--nice", type=int, default=0, metavar="N", help="lower the priority by so much")
    given = parser.parse_args(arguments)
    if given.end_with:
        ends_with(given.end_with)()
    if given.nice:
        os.nice(given.nice)
    try:
        found = carry_out(given.folder, given.alone)
    except CoeflabError as why:
        print(f"error: {why}", file=sys.stderr)  # noqa: T201 - this is a command of its own
        return REFUSED
    return CODES.get(found.state, 0)


if __name__ == "__main__":
    sys.exit(main())

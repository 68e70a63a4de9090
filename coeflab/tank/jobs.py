"""Jobs: what has to be computed, as commands in a folder; their states, which files keep and any process may read.

A solver writes jobs, a runner starts them, here or on a cluster: ``python -m coeflab.tank.job FOLDER`` carries one out. Neither
knows the other. This file is read by every process that carries a job out: it imports nothing heavy.
"""

from __future__ import annotations

import json
import os
import socket
import sys
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, field, fields, replace
from enum import StrEnum
from math import nan
from pathlib import Path
from types import MappingProxyType
from typing import Any

from coeflab.core.errors import InputError, OutputError
from coeflab.core.files import write_atomically
from coeflab.core.text.records import OrNone, plain_name, read_record
from coeflab.core.types import brief
from coeflab.core.wording import finite
from coeflab.tank.processes import is_alive

if sys.platform != "win32":
    import fcntl

JOB, STATE, LOCK = "job.json", "state.json", ".lock"  # in the folder of every job
EARLIER = "earlier.json"  # in that of a run whose row an earlier tow made (`coeflab.tank.earlier`)
KIND = "coeflab job 1"
ANEW = "`coeflab tow` writes it anew."
SILENT = 300.0  # s without a sign of life from another machine, after which a job counts as stopped
PATIENCE = 100.0  # s that a killed attempt may take to end its solver


class JobState(StrEnum):
    """Where a job is."""

    WAITING = "waiting"
    RUNNING = "running"
    FINISHED = "finished"  # a run: on its plateau; a mesh: made and sound
    UNCONVERGED = "unconverged"  # ended at its last iteration without a plateau
    DIVERGED = "diverged"
    CRASHED = "crashed"
    STOPPED = "stopped"  # killed, or out of time: goes on from what it wrote last
    CHANGED = "changed"  # finished with another mesh, case or solver: is run anew

    @property
    def is_final(self) -> bool:
        """Whether the job is left as it is: carried out again, it would end the same."""
        return self in (JobState.FINISHED, JobState.UNCONVERGED, JobState.DIVERGED)

    @property
    def goes_on(self) -> bool:
        """Whether it is carried on from what it wrote last."""
        return self in (JobState.RUNNING, JobState.STOPPED, JobState.CRASHED)


@dataclass(frozen=True, slots=True)
class Step:
    """One command of a job.

    Attributes
    ----------
    name : str
        ``snappyHexMesh``; its output goes to ``log.NAME``.
    command : tuple of str
        Run in the folder of the job. A launcher such as mpirun is part of it.
    watched : bool
        Is the solver itself: its history is looked at while it runs, and it is stopped on its plateau or when it diverges.
    """

    name: str
    command: tuple[str, ...]
    watched: bool = False


@brief
@dataclass(frozen=True, slots=True)
class Job:
    """A mesh or a run.

    Attributes
    ----------
    name : str
        ``mesh/medium_z<0`` or the condition's name.
    folder : Path
        Absolute; holds the case, ``job.json`` and ``state.json``.
    solver : str
        Name of the plugin that watches, stops and resumes it.
    steps : tuple of Step
    needs : tuple of str
        Names of the jobs that have to be finished before.
    cores : int
    memory : float
        That it is expected to take, bytes.
    seconds : float
        That it is expected to take on an idle machine of the kind that the estimate was measured on.
    key : str
        sha256 of everything that its result depends on: files of the case, keys of the jobs it needs, version of the solver.
    iterations : float
        That the solver makes at most; NaN where it counts none.
    cells : float
        Of its grid, as expected; 0 where that is unknown.
    to_the_end : bool
        Makes all its iterations, whether it is on a plateau before or not: a study of their number.
    """

    name: str
    folder: Path
    solver: str
    steps: tuple[Step, ...]
    needs: tuple[str, ...] = ()
    cores: int = 1
    memory: float = 0.0
    seconds: float = 0.0
    key: str = ""
    iterations: float = nan
    cells: float = 0.0
    to_the_end: bool = False


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Progressed:
    """What ``state.json`` says of a job.

    Attributes
    ----------
    state : JobState
    key : str
        Of the job when it was carried out.
    step : str
        Now, or the last one.
    iteration : float
        Of the solver; NaN before it has begun.
    seconds : float
        Spent so far, over all attempts.
    memory : float
        The most that it took, bytes.
    process, host : int, str
        Who carries it out.
    started : float
        When that process began, clock ticks since the machine did: another one may get its number. NaN where unknown.
    left : float
        Seconds to the last iteration at the pace so far; NaN where unknown.
    means, errors : mapping of str to float
        X Y Z K M N of the whole body over what is a plateau so far, and their standard errors, N and N m.
    plateau : int
        Rows of the history within which the plateau was recognised; what the solver wrote until it stopped comes after them
        and counts for nothing, so that a result does not depend on when somebody looked. 0 without a plateau.
    resumed_from : float
        Iteration or time from which the last attempt went on; NaN for one from the start.
    why : str
        What shows a state that is not finished, with file and line.
    remarks : tuple of str
        Such as the share of the surface that layers cover, where it is below its limit.
    """

    state: JobState
    key: str = ""
    step: str = ""
    iteration: float = nan
    seconds: float = 0.0
    memory: float = 0.0
    process: int = 0
    host: str = ""
    started: float = nan
    left: float = nan
    means: Mapping[str, float] = field(default_factory=dict)
    errors: Mapping[str, float] = field(default_factory=dict)
    plateau: int = 0
    resumed_from: float = nan
    why: str = ""
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("means", "errors"):
            object.__setattr__(self, name, MappingProxyType(dict(getattr(self, name))))


JOB_SHAPE = {
    "name": plain_name, "solver": str, "steps": [{"name": plain_name, "command": [str], "watched": bool}], "needs": [plain_name],
    "cores": int, "memory": float, "seconds": float, "key": str, "iterations": OrNone(float), "cells": float, "to_the_end": bool,
}  # fmt: skip
STATE_SHAPE = {
    "state": JobState, "key": str, "step": str, "iteration": OrNone(float), "seconds": OrNone(float), "memory": OrNone(float),
    "process": int, "host": str, "started": OrNone(float), "left": OrNone(float), "means": {str: OrNone(float)},
    "errors": {str: OrNone(float)}, "plateau": int, "resumed_from": OrNone(float), "why": str, "remarks": [str],
}  # fmt: skip


def write_job(job: Job) -> bool:
    """Write ``job.json`` into the job's folder, which is not named in it: a tow may be moved.

    Returns
    -------
    bool
        Whether the file changed.

    Raises
    ------
    OutputError
        The folder cannot be written.
    """
    content = {"kind": KIND} | {f.name: getattr(job, f.name) for f in fields(job) if f.name != "folder"}
    content |= {"steps": [asdict(step) for step in job.steps], "iterations": finite(job.iterations)}
    return write_atomically(job.folder / JOB, _bytes(content))


def read_job(folder: Path) -> Job:
    """The job of a folder.

    Raises
    ------
    InputError
        There is no job, or one that this release does not know.
    """
    path = folder.absolute() / JOB
    if not path.is_file():
        raise InputError(f"no {JOB}", "the folder of a job", file=folder)
    content = read_record(path, JOB_SHAPE, "a job", kind=KIND, advice=ANEW)
    steps = tuple(Step(s["name"], tuple(s["command"]), s["watched"]) for s in content["steps"])
    own = {name: content[name] for name in JOB_SHAPE if name not in ("steps", "needs", "iterations")}
    iterations, needs = or_nan(content["iterations"]), tuple(content["needs"])
    return Job(folder=path.parent.resolve(), steps=steps, needs=needs, iterations=iterations, **own)


def write_progress(folder: Path, progressed: Progressed) -> None:
    """Write ``state.json``, whole or not at all; on a full disk into the place that the last one takes.

    Raises
    ------
    OutputError
        It cannot be written at all.
    """
    content = {f.name: getattr(progressed, f.name) for f in fields(progressed)}
    for name, value in content.items():
        if isinstance(value, float):
            content[name] = finite(value)
        elif isinstance(value, Mapping):
            content[name] = {k: finite(v) for k, v in value.items()}
    try:
        write_atomically(folder / STATE, _bytes(content))
    except OutputError:
        _overwrite(folder / STATE, _bytes(content))
        if not (folder / STATE).is_file():
            raise


def _overwrite(path: Path, content: bytes) -> None:
    """Into the blocks that the file has: a full disk has no others."""
    with suppress(OSError), path.open("r+b") as stream:
        size = os.fstat(stream.fileno()).st_size
        stream.write(content.ljust(size))
        stream.truncate()


def read_progress(folder: Path) -> Progressed:
    """What ``state.json`` says, word for word; WAITING without one.

    Raises
    ------
    InputError
        The file is no state of a job.
    """
    path = folder / STATE
    if not os.path.lexists(path):
        return Progressed(JobState.WAITING)
    advice = "Delete the file: the job is carried out anew."
    found = read_record(path, STATE_SHAPE, "the state of a job", advice=advice)
    content = {name: found[name] for name in STATE_SHAPE}
    for f in fields(Progressed):
        if f.type == "float":
            content[f.name] = or_nan(content[f.name])
    for name in ("means", "errors"):
        content[name] = {k: or_nan(v) for k, v in content[name].items()}
    return Progressed(**content | {"state": JobState(content["state"]), "remarks": tuple(content["remarks"])})


def progress(job: Job) -> Progressed:
    """How far a job is: ``state.json`` seen with what is true now.

    A job that runs by its file and whose process is gone is STOPPED; one that was carried out with another key is CHANGED.

    Raises
    ------
    InputError
        The file is no state of a job.
    """
    found = read_progress(job.folder)
    if found.state is JobState.RUNNING and not _is_carried_out(job.folder, found):
        why = f"killed: process {found.process} on {found.host} is gone"
        found = replace(found, state=JobState.STOPPED, left=nan, why=why)
    if found.state not in (JobState.WAITING, JobState.RUNNING) and found.key != job.key:
        why = f"{found.state.value} with another mesh, case or solver ({found.key[:8]}, now {job.key[:8]})"
        found = replace(found, state=JobState.CHANGED, why=why)
    return found


def outstanding(jobs: Sequence[Job]) -> tuple[Job, ...]:
    """The jobs that a runner has to carry out, in their order: runs that are not kept, and the meshes that these need.

    Raises
    ------
    InputError
        A ``state.json`` is no state of a job.
    """
    left = [job for job in jobs if not progress(job).state.is_final]
    idle = idle_meshes(jobs, {job.name for job in left})
    return tuple(job for job in left if job.name not in idle)


def idle_meshes(jobs: Sequence[Job], left: Collection[str]) -> frozenset[str]:
    """Names of the jobs that others need, but none of those that are left to do."""
    ever = {name for job in jobs for name in job.needs}
    return frozenset(ever - {name for job in jobs if job.name in left for name in job.needs})


def _is_carried_out(folder: Path, found: Progressed) -> bool:
    if found.host == socket.gethostname():
        return is_alive(found.process, found.started)
    try:
        return time.time() - (folder / STATE).stat().st_mtime < SILENT
    except OSError:
        return False


@contextmanager
def only_one(folder: Path, what: str, patience: float = 0.0) -> Iterator[int]:
    """Hold a folder against other processes; children that inherit the descriptor hold it too, until they end.

    Parameters
    ----------
    folder : Path
        It is made.
    what : str
        For the complaint: ``tow``, ``job``.
    patience : float
        Seconds to wait for another one to end.

    Yields
    ------
    int
        The descriptor that holds the lock.

    Raises
    ------
    InputError
        Another process holds it.
    OutputError
        The folder cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
    except OSError as why:
        raise OutputError(f"cannot write {folder}: {why.strerror or why}. Choose another folder.") from None
    try:
        until = time.monotonic() + patience
        while not _locked(handle):
            if time.monotonic() >= until:
                owner = os.pread(handle, 200, 0).decode(errors="replace").strip() or "another process"
                raise InputError(f"a {what} that {owner} carries out", f"one {what} at a time in a folder", file=folder,
                                 advice="Wait for it, or end that process.")  # fmt: skip
            time.sleep(0.2)
        with suppress(OSError):  # a full disk: then nobody learns whose it is
            os.ftruncate(handle, 0)
            os.pwrite(handle, f"process {os.getpid()} on {socket.gethostname()}".encode(), 0)
        yield handle
    finally:
        os.close(handle)


def _locked(handle: int) -> bool:
    if sys.platform == "win32":
        return True
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return True
    return True


def or_nan(value: float | None) -> float:
    """A number of a file of ours; NaN for one that it does not have."""
    return nan if value is None else float(value)


def _bytes(content: Mapping[str, Any]) -> bytes:
    return (json.dumps(content, indent=1, ensure_ascii=False) + "\n").encode()

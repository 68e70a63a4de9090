"""Jobs: what has to be computed, as commands in a folder; their states, which files keep and any process may read.

A solver writes jobs, a runner starts them, here or on a cluster: ``python -m coeflab.tank.job FOLDER`` carries one out. Neither
knows the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from coeflab.core.types import brief

JOB, STATE = "job.json", "state.json"  # in the folder of every job


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


@brief
@dataclass(frozen=True, slots=True)
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
    iteration: float = float("nan")
    seconds: float = 0.0
    memory: float = 0.0
    process: int = 0
    host: str = ""
    resumed_from: float = float("nan")
    why: str = ""
    remarks: tuple[str, ...] = ()

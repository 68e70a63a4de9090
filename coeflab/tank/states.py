"""States of the jobs of a tow, from their files: what a table of runs shows, also of a tow that another process carries out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from coeflab.core.types import brief
from coeflab.tank.jobs import Job, Progressed


@brief
@dataclass(frozen=True, slots=True, eq=False)
class JobRow:
    """One job and how far it is.

    Attributes
    ----------
    job : Job
    progress : Progressed
        Seen with what is true now; ``why`` of a waiting job names what it cannot do without.
    left : float
        Seconds that it still takes, from its pace, else from its estimate; 0 for one that is kept.
    """

    job: Job
    progress: Progressed
    left: float


def states_of(folder: Path) -> tuple[JobRow, ...]:
    """The jobs below the folder of a tow, meshes first, then runs in natural order.

    Raises
    ------
    InputError
        No job is there, or a job.json or state.json is none.
    """
    raise NotImplementedError


def time_left(rows: Sequence[JobRow], cores: int) -> float:
    """Seconds until all jobs have ended that can, on so many cores."""
    raise NotImplementedError

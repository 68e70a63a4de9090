"""Runs jobs as processes of this machine, several at once within a budget of cores and memory."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from coeflab.core.declarations import Declaration, Pure
from coeflab.tank.jobs import Job

summary = "processes of this machine, within a budget of cores and memory"
citations = ()


@dataclass(frozen=True, slots=True)
class Options(Declaration):
    """``[runner.local]``: jobs as processes of this machine.

    Attributes
    ----------
    cores : float
        That all jobs together may take; by default all that the process may use.
    nice : float
        Priority from 0, that of other programs, to 19, the lowest.
    """

    cores: Pure = 0.0
    nice: Pure = 10.0


options = Options


def carry_out(jobs: Sequence[Job], folder: Path, options: Options, look: Callable[[], None]) -> None:
    """Carry out every job whose needs are finished, until no job is left that can be."""
    raise NotImplementedError

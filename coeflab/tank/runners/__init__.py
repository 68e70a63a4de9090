"""Runners of jobs: one plugin a file, and what a plugin is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Protocol, runtime_checkable

from coeflab.core.declarations import Declaration
from coeflab.core.registry import Plugin, Registry
from coeflab.tank.jobs import Job


@runtime_checkable
class Runner(Plugin, Protocol):
    """Carries out jobs in processes of their own, ``python -m coeflab.tank.job FOLDER`` each.

    Attributes
    ----------
    options : type of Declaration
        The keys of ``[runner.NAME]`` in tank.toml.
    """

    options: type[Declaration]

    def carry_out(self, jobs: Sequence[Job], folder: Path, options: Declaration, look: Callable[[], None]) -> None:
        """Carry out every job whose needs are finished, until no job is left that can be.

        Jobs that are finished with their own key are not among them. A job that fails ends itself and what needs it, nothing else.

        Parameters
        ----------
        jobs : sequence of Job
        folder : Path
            Of the tow; the runner may keep files of its own in ``folder/.runner``.
        options : Declaration
        look : callable
            To be called a few times a second while jobs run; shows the states that their files have.

        Raises
        ------
        CoeflabError
            The runner itself cannot work: no scheduler, no such partition.
        """
        ...


RUNNERS = Registry("coeflab.tow_runners", "runner", Runner, __name__)  # type: ignore[type-abstract]

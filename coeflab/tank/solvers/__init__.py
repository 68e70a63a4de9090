"""Solvers of the tow tank: one plugin a file, and what a plugin is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from coeflab.core.declarations import Declaration
from coeflab.core.registry import Plugin, Registry
from coeflab.core.types import brief
from coeflab.law.coefficient import CoefficientSet
from coeflab.tables.raw_table import RawTable, Run
from coeflab.tank.jobs import Job, Step
from coeflab.tank.tank import Tank

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody


@brief
@dataclass(frozen=True, slots=True)
class Installation:
    """What is installed of a solver.

    Attributes
    ----------
    version : str
        As the solver says it; empty where it is not installed.
    missing : str
        What to install, in one sentence; empty where nothing is missing.
    """

    version: str
    missing: str = ""


@runtime_checkable
class TowSolver(Plugin, Protocol):
    """Gives the forces on a towed body: by jobs that a runner carries out, or at once.

    Attributes
    ----------
    options : type of Declaration
        The keys of ``[solver.NAME]`` in tank.toml.
    paths : mapping of str to str
        Keys of its options that name a file, with the folder of what is shipped of that kind.
    jobs : callable or None
        ``jobs(tank, body, folder)``: writes the meshes and cases below the folder, each once, and gives their jobs in an order
        in which they can be carried out. Files that are there and equal are left alone; what is of no condition and no mesh
        stands in a folder of the solver's name.
    history : callable or None
        ``history(folder)``: the run so far, also while the solver writes; in SI, whole body (halves are doubled), FRD.
    stop : callable or None
        ``stop(folder)``: asks the running solver to write what it has and to end.
    resumed : callable or None
        ``resumed(job)``: the steps that carry the job on from what it wrote last, and the iteration of that; the job's own steps
        and NaN where nothing is left to go on from.
    ended : callable or None
        ``ended(job)``: what shows that a job that ended is not sound (diverged, few layers, ...), as remarks and a reason.
    table : callable or None
        ``table(tank, body, folder)``: the whole table at once, of a method that needs no runs of ours; a row bears the name of
        its condition in ``row_labels``, columns their plain name in ``means``, in SI, whole body, FRD. ``folder`` is that of the
        tow, in which ``jobs`` may have written what a person fills in.
    known : callable or None
        ``known(tank, body)``: coefficients with the U95 of the method itself, where rows cannot show it.
    """

    options: type[Declaration]
    paths: Mapping[str, str] = MappingProxyType({})
    jobs: Callable[[Tank, TowedBody, Path], tuple[Job, ...]] | None = None
    history: Callable[[Path], Run] | None = None
    stop: Callable[[Path], None] | None = None
    resumed: Callable[[Job], tuple[tuple[Step, ...], float]] | None = None
    ended: Callable[[Job], tuple[tuple[str, ...], str]] | None = None
    table: Callable[[Tank, TowedBody, Path], RawTable] | None = None
    known: Callable[[Tank, TowedBody], CoefficientSet] | None = None

    def installed(self) -> Installation:
        """What is installed here."""
        ...


SOLVERS = Registry("coeflab.tow_solvers", "tow solver", TowSolver, __name__)  # type: ignore[type-abstract]

"""A condition of a tow as it came out: its state, and means over its plateau."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from coeflab.core.types import brief
from coeflab.tables.raw_table import Run
from coeflab.tables.run_summary import RunSummary, summarised
from coeflab.tank.jobs import Job, JobState, Progressed
from coeflab.tank.plateau import on_plateau, until
from coeflab.tank.test_matrix import TowCondition

CONVERGED = "converged"


@brief
@dataclass(frozen=True, slots=True, eq=False)
class TowedRun:
    """One condition as it came out.

    Attributes
    ----------
    condition : TowCondition
    state : JobState
    why : str
        What shows a state that is not finished.
    summary : RunSummary or None
        Means over the plateau, N and N m, whole body, FRD; None where nothing was run.
    remarks : tuple of str
        Of the mesh and of the run.
    case, mesh : str
        Keys of the run and of the mesh that it needs; empty for a method without runs.
    history : Run or None
        For the short history that the campaign keeps.
    short : bytes
        That short history, of a run whose fields and history are gone (`coeflab.tank.earlier`).
    """

    condition: TowCondition
    state: JobState
    why: str = ""
    summary: RunSummary | None = None
    remarks: tuple[str, ...] = ()
    case: str = ""
    mesh: str = ""
    history: Run | None = None
    short: bytes = b""

    @property
    def counts(self) -> bool:
        """Whether fits may use it: finished, and on a plateau by the rule of all runs."""
        return self.state is JobState.FINISHED and self.status == CONVERGED

    @property
    def status(self) -> str:
        """As the column of the table has it: ``converged``, or what it is instead."""
        if self.state is JobState.FINISHED and self.summary is not None:
            return str(self.summary.status)
        return "not run" if self.state is JobState.WAITING else str(self.state)


def towed_run(
    condition: TowCondition, progressed: Progressed, jobs: Mapping[str, Job], job: Job, history: Run | None,
    mesh_remarks: Sequence[str] = (),
) -> TowedRun:  # fmt: skip
    """A condition with what its job left.

    Parameters
    ----------
    condition : TowCondition
    progressed : Progressed
        State of its job.
    jobs : mapping of str to Job
        All of the tow, for the mesh.
    job : Job
    history : Run or None
        As the solver reads it, up to where the plateau was recognised; None where there is none.
    mesh_remarks : sequence of str
    """
    counted = history
    if history is not None and progressed.plateau:
        counted = until(history, len(history.history), on_plateau(history).first)
    meshes = [jobs[name].key for name in job.needs if name in jobs]
    return TowedRun(
        condition,
        progressed.state,
        progressed.why,
        None if counted is None or not len(counted.history) else summarised(counted, condition.name, steady=True),
        (*mesh_remarks, *progressed.remarks),
        job.key,
        "+".join(meshes),
        history,
    )

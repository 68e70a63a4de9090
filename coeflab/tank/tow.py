"""A virtual tow: a body and a tank.toml become cases, and their runs, in one folder."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from coeflab.bodies.readers import read_body
from coeflab.core.declarations import declared
from coeflab.core.errors import InputError
from coeflab.core.files import write_all, write_atomically
from coeflab.core.provenance import sha256_of
from coeflab.core.text.bounded import log_text
from coeflab.core.text.toml import read_toml
from coeflab.core.types import brief
from coeflab.tank.earlier import matching, take_over
from coeflab.tank.folder import BODY, PLAN, TANK, body_file, copied, forget, plan_text, read_plan, refuse_other
from coeflab.tank.jobs import (
    Job,
    JobState,
    Progressed,
    only_one,
    outstanding,
    progress,
    read_job,
    write_job,
    write_progress,
)
from coeflab.tank.runners import RUNNERS
from coeflab.tank.solvers import SOLVERS, Installation, TowSolver
from coeflab.tank.tank import Tank
from coeflab.tank.tank_file import declared_body, default_tank, default_text, read_tank
from coeflab.tank.tank_keys import TankFile
from coeflab.tank.towed_body import TowedBody, stl, towed

GOES_ON, BEGINS, ANEW = "goes on from what it wrote last", "begins anew, as it had written nothing", "run anew"
SMALL = 100_000  # bytes of a dictionary
Look = Callable[[], None]


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Tow:
    """A folder with everything that is to be computed in it.

    Attributes
    ----------
    folder : Path
        Absolute.
    tank : Tank
    body : TowedBody
    installed : Installation
        Of the solver.
    jobs : tuple of Job
        Meshes and runs in an order in which they can be carried out; none of a method without runs.
    restored : tuple of str
        Files of cases that somebody had edited by hand, and that are again as tank.toml has them.
    """

    folder: Path
    tank: Tank
    body: TowedBody
    installed: Installation
    jobs: tuple[Job, ...] = ()
    restored: tuple[str, ...] = ()

    @property
    def solver(self) -> TowSolver:
        """The plugin."""
        return SOLVERS.load(self.tank.solver)

    @property
    def of(self) -> dict[str, Job]:
        """The jobs by their names."""
        return {job.name: job for job in self.jobs}


@brief
@dataclass(frozen=True, slots=True)
class Reuse:
    """What an earlier start left of a job.

    Attributes
    ----------
    name : str
    state : JobState
    what : str
        ``kept``, ``goes on from iteration 240``, ``run anew`` ...
    why : str
        Of what is run anew.
    """

    name: str
    state: JobState
    what: str
    why: str = ""


def read(body: Path | None, matrix: Path | None, solver: str = "", runner: str = "") -> tuple[Tank, TowedBody]:
    """The tank and the body that a person means.

    Parameters
    ----------
    body : Path or None
        Folder of a body.toml, or the file; None where tank.toml names it.
    matrix : Path or None
        A tank.toml; without one the default matrix.
    solver, runner : str
        In the place of those of the file.

    Raises
    ------
    InputError
        Everything that is wrong with the files, or a body that cannot be towed.
    PluginError
        No such solver or runner.
    """
    file = body if body is not None else declared_body(matrix) if matrix is not None else None
    if file is None:
        raise InputError("no body", "a folder with a body.toml, or a shipped name", column="BODY")
    file = file / "body.toml" if file.is_dir() else file
    own, file = read_body(file), file.resolve()
    point = own.reference_point
    if matrix is not None:
        words = declared(TankFile, read_toml(matrix)).tank.reference_point
        point = point if words is None else words
    surface = towed(own, point)
    if matrix is None:
        return default_tank(file, surface, solver=solver, runner=runner), surface
    return read_tank(matrix, surface, body_file=file, solver=solver, runner=runner), surface


def laid_out(tank: Tank, body: TowedBody, folder: Path, matrix: Path | None = None) -> Tow:
    """Write body, meshes and cases below a folder, with the jobs that compute them; equal files are left alone.

    Parameters
    ----------
    tank : Tank
    body : TowedBody
    folder : Path
        New, or with this tow in it.
    matrix : Path, optional
        The tank.toml, of which a copy is kept.

    Raises
    ------
    InputError
        Another tow is in the folder, or is being carried out there.
    OutputError
        The folder cannot be written.
    """
    folder = folder.resolve()
    solver = SOLVERS.load(tank.solver)
    installed = solver.installed()
    refuse_other(folder, tank, body.body.name)
    with only_one(folder, "tow"):
        own = default_text(body).encode() if matrix is None else copied(matrix, folder)
        write_all(folder, {TANK: own, BODY: stl(body)})
        jobs: tuple[Job, ...] = ()
        keys = read_plan(folder)["jobs"] if (folder / PLAN).is_file() else {}
        there = {name: _case_of(folder / name) for name in keys}
        if solver.jobs is not None:
            try:
                with SOLVERS.guarded(tank.solver):
                    jobs = tuple(solver.jobs(tank, body, folder))
            except InputError as why:
                key = why.column or ""
                if why.file is not None or not key or matrix is None:
                    raise
                key = key if "." in key else f"solver.{tank.solver}.{key}"
                raise read_toml(matrix).fail(key, why.found, why.expected, why.advice) from None
        for job in jobs:
            write_job(job)
        forget(folder, {job.folder for job in jobs})
        same = [job for job in jobs if keys.get(job.name) == job.key]  # so coeflab writes what it wrote before
        restored = [
            f"{j.name}/{f}" for j in same for f, old in _case_of(j.folder).items() if there[j.name].get(f, old) != old
        ]
        tow = Tow(folder, tank, body, installed, jobs, tuple(restored))
        write_atomically(folder / PLAN, plan_text(folder, tank, body.body.name, installed.version, jobs))
    return tow


def _case_of(folder: Path) -> dict[str, str]:
    """The small files of a case by their paths, without what coeflab itself changes while a key stays."""
    own = re.compile(r"(?m)^(stopAt|endTime|writeInterval)\s.*$")
    found = [f for d in ("0", "constant", "system") for f in sorted((folder / d).glob("*"))]
    return {
        str(f.relative_to(folder)): own.sub("", log_text(f))
        for f in found
        if f.is_file() and f.name != "decomposeParDict" and f.stat().st_size < SMALL
    }


def reopened(
    folder: Path, matrix: Path | None = None, solver: str = "", runner: str = ""
) -> tuple[Tank, TowedBody, Path]:
    """Tank and body of a tow as its folder has them, and the tank.toml.

    Parameters
    ----------
    folder : Path
    matrix : Path, optional
        A tank.toml in the place of that of the folder.
    solver, runner : str
        In the place of those that the tow was begun with.

    Raises
    ------
    InputError
        No tow is in the folder, or its files do not do any more.
    """
    plan = read_plan(folder)
    own = matrix if matrix is not None else folder / TANK
    tank, body = read(body_file(folder, plan), own, solver or plan["solver"], runner or plan["runner"])
    return tank, body, own


def taken_over(tow: Tow, campaign: Path) -> tuple[str, ...]:
    """Take over what an earlier tow of the same cases finished, so that it is not run again; names of these conditions.

    Parameters
    ----------
    tow : Tow
        Laid out.
    campaign : Path
        Of the earlier tow, such as a folder of ``cfd_data``.

    Raises
    ------
    InputError
        The folder has no campaign of a tow, or none of its conditions has a case and mesh of this one.
    """
    with only_one(tow.folder, "tow"):
        return take_over(campaign, tow.jobs)


def require_finished(tank: Tank, body: TowedBody, matrix: Path | None, campaign: Path) -> None:
    """Refuse a campaign of which nothing could be taken over, before anything is written where the tow is to be.

    Parameters
    ----------
    tank : Tank
    body : TowedBody
    matrix : Path or None
        The tank.toml.
    campaign : Path
        Of the earlier tow.

    Raises
    ------
    InputError
        As `taken_over`.
    """
    with TemporaryDirectory() as trial:
        matching(campaign, laid_out(tank, body, Path(trial) / "tow", matrix).jobs)


def opened(folder: Path) -> Tow:
    """A tow as its folder has it; nothing is written, so that another process may carry it out meanwhile.

    Raises
    ------
    InputError
        No tow is in the folder, or its files do not do any more.
    """
    tank, body, _ = reopened(folder)
    jobs = tuple(read_job(folder / name) for name in read_plan(folder)["jobs"])
    return Tow(folder.resolve(), tank, body, SOLVERS.load(tank.solver).installed(), jobs)


def reuse(tow: Tow, before: Mapping[str, Any] | None = None) -> tuple[Reuse, ...]:
    """What happens to each job when the tow goes on: kept, gone on with, or run anew and why.

    Parameters
    ----------
    tow : Tow
    before : mapping, optional
        ``tow.json`` as it was before it was laid out again; it tells what changed.
    """
    return tuple(_fate(tow, job, before) for job in tow.jobs)


def _fate(tow: Tow, job: Job, before: Mapping[str, Any] | None) -> Reuse:
    now = progress(job)
    if now.state is JobState.WAITING:
        return Reuse(job.name, now.state, "to be run")
    if now.state is JobState.CHANGED:
        return Reuse(job.name, now.state, ANEW, _changed(tow, job, before))
    if _may_go_on(job, now):
        what = f"goes on from iteration {now.iteration:.0f} to {job.iterations:.0f} at most"
        return Reuse(job.name, JobState.STOPPED, what, "more iterations are allowed")
    if now.state.is_final:
        return Reuse(job.name, now.state, f"kept, {now.state}")
    why = "" if now.state is JobState.STOPPED else now.why
    if now.state is JobState.RUNNING or tow.solver.resumed is None:
        return Reuse(job.name, now.state, GOES_ON, why)
    with SOLVERS.guarded(tow.tank.solver):
        _, at = tow.solver.resumed(job)  # as the next attempt does first
    return Reuse(job.name, now.state, f"{GOES_ON}, iteration {at:.0f}" if at > 0.0 else BEGINS, why)


def _may_go_on(job: Job, now: Progressed) -> bool:
    """Whether a run that ended without a plateau has iterations left, because more are allowed now."""
    return now.state is JobState.UNCONVERGED and job.iterations > now.iteration


def _changed(tow: Tow, job: Job, before: Mapping[str, Any] | None) -> str:
    """What made the key of a job another one, as far as it shows."""
    if before is not None:
        if before.get("version") != tow.installed.version:
            return f"the solver was {before.get('version') or 'not installed'}, now {tow.installed.version or 'not installed'}"
        if before.get("surface_sha256") != sha256_of(tow.folder / BODY):
            return "the body's surface changed"
        keys = before.get("jobs", {})
        if any(keys.get(name) != tow.of[name].key for name in job.needs if name in tow.of):
            return f"its mesh changed ({', '.join(job.needs)})"
        return "its case changed"
    return "its mesh, case or solver changed"


def carried_out(tow: Tow, cores: int, look: Look) -> None:
    """Carry out what is not finished, by the runner of the tank; returns when nothing is left that can be.

    Parameters
    ----------
    tow : Tow
    cores : int
        Budget of the runner, where it has one; 0 leaves that of tank.toml.
    look : callable
        Is called a few times a second.

    Raises
    ------
    InputError
        The solver is not installed.
    CoeflabError
        The runner cannot work.
    """
    for job in tow.jobs:
        now = progress(job)
        if _may_go_on(job, now):
            write_progress(job.folder, replace(now, state=JobState.STOPPED, why="more iterations are allowed"))
    jobs = outstanding(tow.jobs)
    if not jobs:
        return
    require_installed(tow)
    runner = RUNNERS.load(tow.tank.runner)
    options = runner.options(**_with_cores(tow, cores))
    with RUNNERS.guarded(tow.tank.runner), only_one(tow.folder, "tow"):
        runner.carry_out(jobs, tow.folder, options, look)


def _with_cores(tow: Tow, cores: int) -> dict[str, Any]:
    options = dict(tow.tank.runner_options)
    if cores:
        names = getattr(RUNNERS.load(tow.tank.runner).options, "__dataclass_fields__", {})
        if "cores" not in names:
            raise InputError(f"--cores with the runner {tow.tank.runner}", "a runner with a budget of cores, such as local",
                             column="--cores")  # fmt: skip
        options["cores"] = cores
    return options


def require_installed(tow: Tow) -> None:
    """Raise where the solver is not installed, with what to do.

    Raises
    ------
    InputError
    """
    if tow.installed.missing:
        raise InputError(f"the solver {tow.tank.solver}, which is not installed", "one that is", column="solver",
                         advice=f"{tow.installed.missing} The cases are in {tow.folder}.")  # fmt: skip

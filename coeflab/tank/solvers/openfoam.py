"""OpenFOAM, of openfoam.com and openfoam.org: steady RANS by simpleFoam on meshes of snappyHexMesh, forces of every patch."""

from __future__ import annotations

import functools
import re
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass, replace
from operator import itemgetter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from coeflab.core.declarations import ABOVE_ZERO, Flag, Pure, Takes, one_of
from coeflab.core.errors import InputError, shown
from coeflab.core.files import write_all
from coeflab.core.text.bounded import stream_of
from coeflab.core.text.foam import FoamCase
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.law.symbols import COMPONENTS
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.raw_table import Ended, RawColumn, RawTable, Run
from coeflab.tank.jobs import Job, Step
from coeflab.tank.openfoam import case, rendered, step
from coeflab.tank.openfoam.mesh import mesh_job
from coeflab.tank.openfoam.mesh_report import expected_cells, mesh_ended
from coeflab.tank.openfoam.mesh_sizes import MeshKeys, mesh_sizes
from coeflab.tank.solvers import Installation
from coeflab.tank.tank import Tank
from coeflab.tank.test_matrix import Half, Kind, TowCondition

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody

summary = "steady RANS by simpleFoam of OpenFOAM on meshes of snappyHexMesh; the arm as a rotating frame"
citations = (
    "Weller, Tabor, Jasak and Fureby (1998): A tensorial approach to computational continuum mechanics using "
    "object-oriented techniques. Computers in Physics 12, 620-631",
    "Menter (1994): Two-equation eddy-viscosity turbulence models for engineering applications. AIAA Journal 32, 1598-1605",
    "Shih, Liou, Shabbir, Yang and Zhu (1995): A new k-epsilon eddy viscosity model for high Reynolds number turbulent flows. "
    "Computers and Fluids 24, 227-238",
    "Spalart and Allmaras (1994): A one-equation turbulence model for aerodynamic flows. La Recherche Aerospatiale 1, 5-21",
    "Van Doormaal and Raithby (1984): Enhancements of the SIMPLE method for predicting incompressible fluid flows. "
    "Numerical Heat Transfer 7, 147-163",
)

SOLVER, TOOLS = (
    "simpleFoam",
    ("blockMesh", "snappyHexMesh", "checkMesh", "topoSet", "decomposePar", "reconstructPar", "simpleFoam"),
)
MODELS = {
    "k-omega SST": "kOmegaSST",
    "realizable k-epsilon": "realizableKE",
    "Spalart-Allmaras": "SpalartAllmaras",
    "laminar": "",
}
# No force on a body is as large: a flat plate across the flow has about one of its own area.
BOUND, SETTLED = 100.0, 20
# Iterations until their plateau over cells^(1/3): mean of 51 runs on 12 meshes of 60,000 to 690,000 cells, 5.6 to 13.3.
ITERATIONS_A_CELL_ACROSS = 9.7
# An iteration on one core of a machine with a run on every core, of two turbulent equations: 2.3e-6 to 3.6e-6 were measured; a run
# alone took 1.6e-6. Laminar 1.6e-6, where two equations took 2.3e-6: each is .15 of the whole.
SECONDS_A_CELL, SHARE_OF_AN_EQUATION = 2.9e-6, 0.15
EQUATIONS = {"laminar": 0, "Spalart-Allmaras": 1}
BYTES_A_CELL, BYTES_A_PROCESS = 1.4e3, 1.5e8
PARALLEL = 0.9  # of the ideal speed-up is left with every doubling of the cores
WITHOUT_SHARES = Step("cleanProcessors", ("sh", "-c", "rm -rf processor*"))
COUNTED = "a whole number, one or more"


def _counted(given: Any, _file: Path) -> int:
    if isinstance(given, bool) or not isinstance(given, (int, float)) or given < 1 or given != int(min(given, 1e9)):
        raise InputError(shown(given), COUNTED)
    return int(given)


Count = Annotated[int, Takes(COUNTED, _counted, {"type": "integer", "minimum": 1})]


@dataclass(frozen=True, slots=True, kw_only=True)
class OpenFOAM(MeshKeys):
    """OpenFOAM: the flow, and how its meshes are made.

    Attributes
    ----------
    turbulence : {"k-omega SST", "realizable k-epsilon", "Spalart-Allmaras", "laminar"}
        Model; a wall that is resolved or not is said by ``wall``.
    intensity : float
        Of the turbulence in the water, over the speed of the condition.
    viscosity_ratio : float
        Of its eddy viscosity to the viscosity of the water.
    iterations : int
        At most; a run ends on the plateau of its forces.
    checkpoint : int
        Iterations after which a run writes its fields, from which it goes on when it was stopped.
    simplec : bool
        SIMPLEC; false for the plain SIMPLE, slower and safer on distorted cells.
    """

    turbulence: Annotated[str, one_of(*MODELS)] = "k-omega SST"
    intensity: Annotated[Pure, ABOVE_ZERO] = 0.004
    viscosity_ratio: Annotated[Pure, ABOVE_ZERO] = 10.0
    iterations: Count = 1600
    checkpoint: Count = 100
    simplec: Flag = True


options = OpenFOAM


@functools.cache
def installed() -> Installation:
    """What is installed here: the version as simpleFoam says it."""
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        what = (
            f"OpenFOAM is not installed: no {', '.join(missing)} on the PATH. Debian: apt-get install openfoam; others: "
            "openfoam.com or openfoam.org, then source its etc/bashrc. --solver external writes the runs for any other solver."
        )
        return Installation("", what)
    words = subprocess.run(
        step("help", SOLVER, "-help").command, capture_output=True, text=True, timeout=60, check=False
    ).stdout
    using, build = (re.search(rf"^{w}:\s*(.*)$", words, re.MULTILINE) for w in ("Using", "Build"))
    number = re.search(r"v?\d[\w.]*", using[1]) if using is not None else None
    text = f"OpenFOAM {number[0]}" if number is not None else "OpenFOAM of unknown version"
    return Installation(f"{text}, {build[1].strip()}" if build is not None and build[1].strip() else text)


def jobs(tank: Tank, body: TowedBody, folder: Path) -> tuple[Job, ...]:
    """Write the meshes and cases below the folder, and give their jobs, meshes first.

    Raises
    ------
    InputError
        No viscosity, an arm whose axis lies in the domain, or what `coeflab.tank.openfoam.mesh.mesh_job` and `coeflab.tank.towed_body.towed` raise.
    OutputError
        A folder cannot be written.
    """
    from coeflab.tank.towed_body import towed  # not imported by the process that watches a run

    given = OpenFOAM(**tank.options)
    version = installed().version
    meshes: dict[tuple[Any, ...], tuple[TowedBody, Job]] = {}
    runs = []
    _refuse_axes_inside(tank, body, given)
    for condition in tank.matrix:
        domain = float(condition.variant.get("domain", 1.0))
        which = (condition.grid, condition.half, tuple(sorted(condition.controls.items())), domain)
        if which not in meshes:
            turned = (
                towed(body.body, tank.reference_point, condition.controls) if any(condition.controls.values()) else body
            )
            result = mesh_job(
                tank,
                turned,
                tank.grid(condition.grid),
                condition.half,
                condition.controls,
                given,
                folder,
                version,
                domain,
            )
            meshes[which] = turned, _with_zone(result)
        turned, mesh = meshes[which]
        runs.append(_run(tank, turned, condition, given, mesh, folder / condition.name, version))
    return (*(mesh for _, mesh in meshes.values()), *runs)


def _refuse_axes_inside(tank: Tank, body: TowedBody, given: OpenFOAM) -> None:
    """Refuse an arm so short that its axis lies in the domain: the body would swim in circles within its own tank.

    A body that turns about an axis through the reference point, in rolling or on the spot, is on no arm.
    """
    boxes: dict[tuple[Any, ...], tuple[Array, Array]] = {}
    for condition in filter(lambda c: np.any(np.cross(c.velocity, c.rates)), tank.matrix):
        domain = float(condition.variant.get("domain", 1.0))
        which = (condition.grid, condition.half, domain)
        if which not in boxes:
            sizes = mesh_sizes(body, tank.grid(condition.grid).size, condition.half, given, tank.conditions, domain)
            boxes[which] = sizes.low, sizes.high
        low, high = boxes[which]
        if case.axis_inside(condition.velocity, condition.rates, low, high):
            _refuse_axis(tank, condition, low, high, f"beside = {given.beside * domain:g}")


def _refuse_axis(tank: Tank, condition: TowCondition, low: Array, high: Array, beside: str) -> None:
    fits, inside = 0.0, 1.0  # shares of the rates
    while inside - fits > 1e-4:
        half = 0.5 * (fits + inside)
        is_inside = case.axis_inside(condition.velocity, half * condition.rates, low, high)
        fits, inside = (fits, half) if is_inside else (half, inside)
    vertical = abs(condition.rates[1]) > abs(condition.rates[2])
    name, sweep = ("q'", "pitch") if vertical else ("r'", "yaw")
    rate = float(np.linalg.norm(condition.rates)) * tank.scaling.length / (condition.speed or 1.0)
    arm = float(np.linalg.norm(case.frame(condition.velocity, condition.rates)[1]))
    raise InputError(
        f"{name} = {rate:.3g} ({condition.name}): the axis of this arm of {arm:.3g} m lies inside the tank",
        f"{name} = {np.floor(1e3 * rate * fits) / 1e3:g} at most with {beside}",
        column="matrix.combined" if condition.kind is Kind.COMBINED else f"matrix.{sweep}",
        advice="Leave larger rates out. A smaller solver.openfoam.beside makes the tank narrower, at the cost of blockage.",
    )


def _with_zone(mesh: Job) -> Job:
    """The mesh with a last step that puts all cells into the zone of the rotating frame."""
    write_all(mesh.folder, {"system/topoSetDict": rendered("case/system/topoSetDict")})
    steps = (*mesh.steps, step("topoSet", "topoSet", "-constant"))
    return replace(mesh, steps=steps, cells=expected_cells(mesh.folder))


def _run(
    tank: Tank, body: TowedBody, condition: TowCondition, given: OpenFOAM, mesh: Job, folder: Path, version: str
) -> Job:  # fmt: skip
    """Write the case of one condition."""
    folder = folder.resolve()
    viscosity = tank.conditions.viscosity
    if viscosity is None:
        raise InputError("no viscosity", "the kinematic viscosity of the water", column="conditions.viscosity")
    words = condition.variant.get("turbulence", given.turbulence)
    if words not in MODELS:
        raise InputError(f'turbulence "{words}"', " or ".join(f'"{m}"' for m in MODELS), column="study.turbulence")
    model, most = MODELS[words], int(float(condition.variant.get("iterations", given.iterations)))
    to_the_end = "iterations" in condition.variant
    speed = condition.speed or case.fastest(body, condition)
    fields = case.turbulent_fields(model, given.wall, speed, viscosity, given.intensity, given.viscosity_ratio)
    files = case.case_files(
        tank, body, condition, fields, model, simplec=given.simplec, iterations=most, checkpoint=int(given.checkpoint)
    )
    case.placed(folder, files, mesh.folder)
    cells, cores = expected_cells(mesh.folder), tank.cores
    steps = [Step("clean", ("sh", "-c", "rm -rf processor* postProcessing [1-9]*"))]
    steps += [step("decomposePar", "decomposePar")] * (cores > 1)
    steps += [step(SOLVER, SOLVER, cores=cores, watched=True)]
    usual = ITERATIONS_A_CELL_ACROSS * cells ** (1.0 / 3.0)
    speed_up = cores * PARALLEL ** np.log2(cores)
    seconds = SECONDS_A_CELL * (1.0 - SHARE_OF_AN_EQUATION * (2 - EQUATIONS.get(words, 2)))
    return Job(
        condition.name, folder, "openfoam", tuple(steps), (mesh.name,), cores,
        memory=cells * BYTES_A_CELL + cores * BYTES_A_PROCESS,
        seconds=float((most if to_the_end else min(most, usual)) * cells * seconds / speed_up),
        key=case.digest(files, mesh.key, version, *([str(most)] if to_the_end else ())),
        iterations=float(most), cells=cells, to_the_end=to_the_end,
    )  # fmt: skip


def history(folder: Path) -> Run:
    """The run so far, also while the solver writes: forces of the whole body and of every patch, FRD, N and N m.

    Raises
    ------
    InputError
        Files that cannot be read.
    """
    if not _has_rows(folder):
        return Run(folder, folder.name, RawTable(folder, ()), ended=Ended.EMPTY, why="no iteration yet")
    read = IMPORTERS.load("openfoam").run
    run = read(folder, {"function": "forces", "rotation": "body"})  # type: ignore[misc]  # that importer reads runs
    half, divided, pairs, length, fastest = _towing(folder)
    patches = {
        n: _whole_body(t, half) for n, t in run.patches.items() if n in divided or n not in map(itemgetter(0), pairs)
    }
    for mine, image in pairs:
        if mine in run.patches:
            patches |= {mine: run.patches[mine], image: _mirrored(run.patches[mine], half)}
    run = replace(run, history=_whole_body(run.history, half), patches=patches, length=length)
    density = float(str(run.history.stated["conditions.density"].value))
    grown = _too_large(run.history, 0.5 * density * fastest**2 * length**2, length)
    if grown:
        return replace(run, ended=Ended.DIVERGED, why=grown)
    if run.ended is Ended.CRASHED and run.cut:
        return replace(run, ended=Ended.WHOLE, why="")  # a line that the solver is writing now
    return run


def _towing(folder: Path) -> tuple[Half, tuple[str, ...], tuple[tuple[str, str], ...], float, float]:
    """Half, patches that the cut divides, patches and their images, length of the body, speed of its fastest point."""
    about = FoamCase(folder)
    towing = about.read("constant/towProperties")
    words = [about.value(towing, n) for n in ("half", "divided", "mirrored", "length", "fastest")]
    try:
        half, divided, pairs, length, fastest = (v[0] for v in words if v is not None)
        return Half(half.strip('"')), tuple(divided), tuple((a, b) for a, b in pairs), float(length), float(fastest)
    except (ValueError, AttributeError, TypeError):
        raise input_error("tow.what_coeflab_writes", folder / "constant/towProperties") from None


def _has_rows(folder: Path) -> bool:
    """Whether the forces of one iteration are there, and their moments."""
    files = [f for n in ("force*.dat", "moment*.dat") for f in (folder / "postProcessing/forces").glob(f"*/{n}")]
    return bool(files) and all(_has_a_row(f) for f in files)


def _has_a_row(file: Path) -> bool:
    with stream_of(file) as stream:
        return any(line.endswith(b"\n") and not line.startswith(b"#") for line in stream)


def _whole_body(table: RawTable, half: Half) -> RawTable:
    """Forces of a half doubled; those that are zero by symmetry are left out."""
    if half is Half.WHOLE:
        return table
    even = case.EVEN[half]
    columns = [
        replace(c, values=2.0 * c.values) if c.means in even else c
        for c in table.columns if c.means in even or c.means not in COMPONENTS
    ]  # fmt: skip
    return replace(table, columns=tuple(columns))


def _mirrored(table: RawTable, half: Half) -> RawTable:
    """Forces on the image of a patch."""
    odd = set(COMPONENTS) - set(case.EVEN[half])
    return replace(table, columns=tuple(replace(c, values=-c.values) if c.means in odd else c for c in table.columns))


def _too_large(table: RawTable, force: float, length: float) -> str:
    """What shows that the forces grew beyond anything physical; empty where they did not."""
    by_means: Mapping[str, RawColumn] = {c.means: c for c in table.columns}
    for name, scale in (*((n, force) for n in "XYZ"), *((n, force * length) for n in "KMN")):
        if name in by_means and len(values := by_means[name].values) > SETTLED:
            over = np.flatnonzero(np.abs(values[SETTLED:]) > BOUND * scale)
            if over.size:
                row = SETTLED + int(over[0])
                return f"{name} of {values[row]:.3g} at iteration {row + 1}: more than {BOUND:g} times the dynamic pressure"
    return ""


def stop(folder: Path) -> None:
    """Ask the solver to write its fields after the iteration and to end."""
    case.set_stop(folder, "writeNow")


def resumed(job: Job) -> tuple[tuple[Step, ...], float]:
    """The steps that carry a run on from the fields that it wrote last, and their iteration; a mesh is made anew.

    A folder of fields that was not written to its end is removed.
    """
    if not any(s.watched for s in job.steps):
        return job.steps, float("nan")
    case.set_stop(job.folder, "endTime")
    times = case.written_times(job.folder)
    if not times:
        return job.steps, float("nan")
    case.remove_after(job.folder, times[-1])
    shares, wanted = case.shares(job.folder), job.cores if job.cores > 1 else 0
    steps: tuple[Step, ...] = ()
    if shares != wanted:  # it was begun on another number of cores
        if shares:
            steps = (step("reconstructPar", "reconstructPar", "-latestTime"), WITHOUT_SHARES)
        steps += tuple(s for s in job.steps if s.name == "decomposePar")
    return (*steps, *(s for s in job.steps if s.watched)), times[-1]


def ended(job: Job) -> tuple[tuple[str, ...], str]:
    """Remarks on a job that ended, and why it is not sound."""
    if not any(s.watched for s in job.steps):
        return mesh_ended(job)
    run = history(job.folder)
    if run.ended is not Ended.WHOLE:
        return (), run.why
    return run.history.remarks, ""

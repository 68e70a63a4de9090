"""The folder of a tow: what ``tow.json`` says of it, and whether another tow is in the way."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError
from coeflab.core.files import names_in, shipped
from coeflab.core.provenance import sha256_of
from coeflab.core.text.records import plain_name, read_record
from coeflab.core.text.toml import quoted, read_toml
from coeflab.core.version import VERSION
from coeflab.tank.jobs import JOB, STATE, Job
from coeflab.tank.solvers import SOLVERS
from coeflab.tank.tank import Tank

KIND = "coeflab tow 1"
PLAN, TANK, BODY = "tow.json", "tank.toml", "body/body.stl"
CAMPAIGN, REPORT = "campaign", "report"
OWN = (
    TANK,
    "body",
    "mesh",
    ".lock",
    CAMPAIGN,
)  # what, with its conditions, a tow leaves that stops before its plan is written


def plan_text(folder: Path, tank: Tank, body: str, version: str, jobs: Sequence[Job]) -> bytes:
    """``tow.json``: conditions, jobs with their keys, and what they depend on.

    Parameters
    ----------
    folder : Path
        With the body's surface in it.
    tank : Tank
    body, version : str
        Names of the body and of the solver as it is installed.
    jobs : sequence of Job
    """
    density = tank.conditions.density
    content = {
        "kind": KIND, "coeflab": VERSION, "name": tank.name, "title": tank.title, "body": body,
        "body_file": _portable(tank.body, folder), "body_sha256": sha256_of(tank.body),
        "surface_sha256": sha256_of(folder / BODY), "solver": tank.solver, "version": version, "runner": tank.runner,
        "jobs": {job.name: job.key for job in jobs},
        "conditions": [
            {
                "name": c.name, "kind": str(c.kind), "half": str(c.half), "grid": c.grid, "variant": dict(c.variant),
                "velocity": c.velocity.tolist(), "rates": c.rates.tolist(), "controls": dict(c.controls),
                # of one unit of a primed force and of a primed moment: the table of runs shows primes
                "units": [tank.scaling.unit(x, density, c.speed) for x in ("Y", "N")],
            }
            for c in tank.matrix
        ],
    }  # fmt: skip
    return (json.dumps(content, indent=1) + "\n").encode()


def _portable(path: Path, folder: Path) -> str:
    """A path that holds when folder and body are moved together; of a shipped body its name."""
    inside = shipped("geometry").resolve()
    if path.resolve().is_relative_to(inside):
        return path.resolve().relative_to(inside).parts[0]
    return Path(os.path.relpath(path, folder)).as_posix()


def copied(matrix: Path, folder: Path) -> bytes:
    """A tank.toml as it was written, its paths as they are seen from the folder of the tow.

    Parameters
    ----------
    matrix : Path
    folder : Path
    """
    file = read_toml(matrix)
    lines = file.text.split("\n")
    solvers = [name for name in file.content.get("solver", {}) if name in SOLVERS.names()]
    theirs = [(("solver", name, key), kind) for name in solvers for key, kind in SOLVERS.load(name).paths.items()]
    for place, kind in ((("tank", "body"), "geometry"), *theirs):
        named: Any = file.content
        for key in place:
            named = named.get(key) if isinstance(named, dict) else None
        at = file.line(place)
        if not isinstance(named, str) or at is None or matrix.parent.resolve() == folder.resolve():
            continue
        found = (matrix.parent / named).resolve()
        if not found.exists() and (shipped(kind) / named).exists():
            continue  # the name of something shipped
        before, key, _ = lines[at - 1].partition(place[-1])
        if key and "=" in lines[at - 1]:
            lines[at - 1] = f"{before}{key} = {quoted(Path(os.path.relpath(found, folder.resolve())).as_posix())}"
    return "\n".join(lines).encode()


def body_file(folder: Path, plan: dict[str, Any]) -> Path:
    """The body.toml of a tow."""
    name = plan["body_file"]
    inside = shipped("geometry") / name
    return inside if "/" not in name and inside.is_dir() else Path(os.path.normpath(folder / name))


_TRIPLE = (float, float, float)
_SHAPE = {
    "name": str, "body": str, "body_file": str, "body_sha256?": str, "surface_sha256?": str, "solver": str, "version": str,
    "runner": str, "jobs": {plain_name: str}, "conditions": [{
        "name": plain_name, "kind": str, "half": str, "velocity": _TRIPLE, "rates": _TRIPLE, "controls": {str: float},
        "units": (float, float),
    }],
}  # fmt: skip


def read_plan(folder: Path) -> dict[str, Any]:
    """What ``tow.json`` says.

    Raises
    ------
    InputError
        No tow is in the folder, or one of another release; by line and key what is not as it was written.
    """
    path = folder / PLAN
    advice = "`coeflab tow BODY --out FOLDER` begins one."
    if not path.is_file():
        raise InputError("no tow", f"a folder with a {PLAN}", file=folder, advice=advice)
    return read_record(path, _SHAPE, "a plan of a tow", kind=KIND, advice=advice)


def refuse_other(folder: Path, tank: Tank, body: str) -> None:
    """Refuse a folder that holds another tow, one of another body than this name, or files of something else.

    Raises
    ------
    InputError
        With what is there.
    """
    if not folder.exists():
        return
    if not folder.is_dir():
        raise InputError("a file", "a folder", file=folder, column="--out")
    if not (folder / PLAN).exists():
        own = {*OWN, tank.solver, *(c.name for c in tank.matrix)} if (folder / TANK).is_file() else OWN
        if any(name not in own for name in names_in(folder)):
            raise InputError(f"a folder without {PLAN}, which is not empty", "a new folder, or that of a tow", file=folder,
                             advice="Name another.")  # fmt: skip
        return
    there = read_plan(folder)
    if (there["name"], there["solver"]) != (tank.name, tank.solver):
        raise InputError(f"the tow of {there['name']} by {there['solver']}", f"that of {tank.name} by {tank.solver}",
                         file=folder, advice="Name another folder: a folder holds one tow.")  # fmt: skip
    if there["body"] != body:
        raise InputError(f"a tow of the body {there['body']}", f"one of {body}", file=folder,
                         advice="Name another folder: a folder holds one tow.")  # fmt: skip


def forget(folder: Path, own: set[Path]) -> None:
    """Take jobs out of the plan that are not in the matrix any more; what they computed stays, and counts again with them."""
    for job in _of_every_job(folder, JOB):
        if job.parent not in own:
            job.unlink()


def has_begun(folder: Path) -> bool:
    """Whether some job of the folder was started."""
    return bool(_of_every_job(folder, STATE))


def _of_every_job(folder: Path, name: str) -> list[Path]:
    return sorted(folder.glob(f"*/{name}")) + sorted(folder.glob(f"mesh/*/{name}"))

"""A solver for the tow tank that is no solver: a process that writes a history of known forces, as fast or as slow as asked.

``planted(folder)`` makes a folder for PYTHONPATH with which every process finds it under the name ``planted``.
"""

from __future__ import annotations

import csv
import hashlib
import json
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from coeflab.core.declarations import Declaration, Pure, Texts
from coeflab.core.files import write_all
from coeflab.law.symbols import COMPONENTS, FORCES
from coeflab.tables.raw_table import RawColumn, RawTable, Run, Stated
from coeflab.tank import job
from coeflab.tank.jobs import Job, JobState, Step, progress, read_job
from coeflab.tank.runners import RUNNERS
from coeflab.tank.solvers import SOLVERS, Installation
from coeflab.tank.tank import Tank
from coeflab.tank.test_matrix import TowCondition
from coeflab.tank.towed_body import TowedBody

summary = "known forces at a chosen pace, for tests"
citations = ()
ROOT = Path(__file__).resolve().parents[1]
CHECKPOINT = 20
SOLVER = """
import csv, json, math, pathlib, sys, time
said = json.loads(pathlib.Path("case.json").read_text())
there = pathlib.Path("history.csv")
rows = there.read_text().splitlines() if there.exists() else []
print("from", max(len(rows) - 1, 0), flush=True)
if said["crashes"]:
    sys.exit("planted: floating point exception")
with there.open("a") as stream:
    if not rows:
        print(",".join(["iteration", *said["forces"]]), file=stream)
    for i in range(max(len(rows), 1), said["iterations"] + 1):
        noise = (i * 7919 % 1009) / 1009 - 0.5
        drift = 0.004 * i if said["restless"] else math.exp(-i / 3)
        print(",".join([str(i), *(repr(f * (1 + drift + 1e-3 * noise)) for f in said["forces"].values())]), file=stream, flush=True)
        if pathlib.Path("stop").exists():
            break
        time.sleep(said["pace"])
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Planted(Declaration):
    """``[solver.planted]``.

    Attributes
    ----------
    iterations, pace : float
        How many, and seconds for one.
    crashes, restless : tuple of str
        Conditions whose run crashes, or whose forces never settle.
    version : str
        Of the solver; "" for one that is not installed.
    """

    iterations: Pure = 160.0
    pace: Pure = 0.0
    crashes: Texts = ()
    restless: Texts = ()


options = Planted


def installed() -> Installation:
    version = os.environ.get("PLANTED_VERSION", "planted 1")
    return Installation(
        version, "" if version else "Planted is not installed: apt install planted. Or take --solver external."
    )


def forces(tank: Tank, condition: TowCondition) -> dict[str, float]:
    """Of a law with known derivatives, SI."""
    v, w = (float(x) / condition.speed for x in condition.velocity[1:])
    q, r = (float(x) * tank.scaling.length / condition.speed for x in condition.rates[1:])
    primes = {
        "X": -1e-3 - 2e-3 * (v * v + w * w), "Y": -6e-3 * v - 2e-2 * v * abs(v) + 2e-3 * r, "Z": -6e-3 * w - 2e-2 * w * abs(w),
        "M": 1.3e-2 * w - 2e-3 * q, "N": -1.3e-2 * v - 2e-3 * r - 1e-3 * r * abs(r),
    }  # fmt: skip
    kept = {"": "XYZMN", "z<0": "XYN", "y<0": "XZM"}[str(condition.half)]
    at = tank.conditions
    return {c: x * tank.scaling.unit(c, at.density, condition.speed) for c, x in primes.items() if c in kept}


def jobs(tank: Tank, body: TowedBody, folder: Path) -> tuple[Job, ...]:
    given = Planted(**dict(tank.options))
    meshes: dict[str, Job] = {}
    runs = []
    for c in tank.matrix:
        name = f"mesh/{c.grid}_{ {'': 'whole', 'z<0': 'upper', 'y<0': 'port'}[str(c.half)] }"
        key = hashlib.sha256(f"{name} {len(body.faces)} {installed().version}".encode()).hexdigest()
        if name not in meshes:
            write_all(folder / name, {"size": f"{tank.grid(c.grid).size}\n".encode()})
            step = Step("mesher", (sys.executable, "-S", "-E", "-c", "print('mesh')"))
            meshes[name] = Job(name, folder / name, "planted", (step,), (), 1, 1e8, 5.0, key, cells=5e4)
        case = {
            "forces": forces(tank, c), "iterations": int(float(c.variant.get("iterations", given.iterations))), "pace": given.pace,
            "crashes": c.name in given.crashes, "restless": c.name in given.restless, "grid": c.grid,
        }  # fmt: skip
        own = json.dumps(case).encode()
        slower = {k: x for k, x in case.items() if k not in ("pace", "crashes", "iterations")}
        write_all(folder / c.name, {"case.json": own, "solver.py": SOLVER.encode()})
        solver = Step("solver", (sys.executable, "-S", "-E", "solver.py"), watched=True)
        digest = hashlib.sha256(f"{json.dumps(slower)} {key}".encode()).hexdigest()
        steps = (Step("clean", ("rm", "-f", "history.csv", "stop")), solver)
        runs.append(
            Job(c.name, folder / c.name, "planted", steps, (name,), 1, 2e8, 60.0, digest, given.iterations, cells=5e4)
        )
    return (*meshes.values(), *runs)


def history(folder: Path) -> Run:
    path = folder / "history.csv"
    rows = list(csv.reader(path.read_text().splitlines())) if path.exists() else []
    rows = [row for row in rows if len(row) == len(rows[0])]
    head, body = (rows[0], rows[1:]) if rows else ([], [])
    values = np.array(body, dtype=float).reshape(len(body), len(head))
    columns = tuple(
        RawColumn(n, "-" if n not in COMPONENTS else "N" if n in FORCES else "N*m", values[:, i], means=n)
        for i, n in enumerate(head)
    )
    table = RawTable(path, columns, files=(path,))
    hull = replace(
        table, columns=tuple(c if c.means == "iteration" else replace(c, values=0.9 * c.values) for c in columns)
    )
    cells = {"coarse": 2.3e4, "medium": 5e4, "fine": 1.1e5}[json.loads((folder / "case.json").read_text())["grid"]]
    return Run(folder, folder.name, table, {"cells": Stated(cells, "case.json")}, {"hull": hull} if body else {})


def stop(folder: Path) -> None:
    (folder / "stop").touch()


def resumed(job: Job) -> tuple[tuple[Step, ...], float]:
    path = job.folder / "history.csv"
    rows = path.read_text().splitlines(keepends=True) if path.exists() else []
    at = max(len(rows) - 1, 0) // CHECKPOINT * CHECKPOINT
    (job.folder / "stop").unlink(missing_ok=True)
    if not at or not any(s.watched for s in job.steps):
        return job.steps, float("nan")
    path.write_text("".join(rows[: at + 1]))
    return tuple(s for s in job.steps if s.watched), float(at)


@dataclass(frozen=True, slots=True, kw_only=True)
class Nothing(Declaration):
    """``[runner.here]``."""


def carry_out_here(jobs: Sequence[Job], folder: Path, options: Declaration, look: Callable[[], None]) -> None:
    """One after the other, in this process."""
    for one in jobs:
        if all(progress(read_job(folder / name)).state is JobState.FINISHED for name in one.needs):
            job.carry_out(one.folder)
        look()


HERE = SimpleNamespace(
    __name__="here", summary="one job after the other, in this process", citations=(), options=Nothing,
    carry_out=carry_out_here,
)  # fmt: skip


@contextmanager
def planted_here(folder: Path) -> Iterator[None]:
    """This process finds the solver, and a runner ``here``."""
    planted(folder)
    sys.path.insert(0, str(folder))
    for registry in (SOLVERS, RUNNERS):
        registry.__dict__.pop("_claims", None)
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        for registry in (SOLVERS, RUNNERS):
            registry.__dict__.pop("_claims", None)


def planted(folder: Path, environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """The environment in which coeflab finds this solver; its files go into the folder."""
    info = folder / "planted_tank-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: planted-tank\nVersion: 1.0\n")
    points = (
        "[coeflab.tow_solvers]\nplanted = tests.planted_tank\n[coeflab.tow_runners]\nhere = tests.planted_tank:HERE\n"
    )
    (info / "entry_points.txt").write_text(points)
    return {**environment, "PYTHONPATH": os.pathsep.join([str(folder), str(ROOT)])}

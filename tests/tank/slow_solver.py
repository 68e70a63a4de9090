"""A solver that takes its time: as a plugin, and as the program that the plugin starts.

The program writes one row of forces an iteration and its "fields" every so many iterations, ends when a file asks it to, and
goes on from its fields. Row i is the same whenever and however often it is computed. ``case.json`` says what goes wrong.
"""

from __future__ import annotations

import json
import math
import os
import signal
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

summary = "a slow synthetic solver for tests"
citations = ("synthetic",)
HISTORY, FIELDS, ASKED, CASE = "forces.csv", "fields", "stop", "case.json"
ENDS = {"kill": signal.SIGKILL, "zero": signal.SIGFPE}  # of a system without memory; of a division by zero
USUAL = {"iterations": 400, "pause": 0.0, "fields": 50, "fails": "", "at": 60, "deaf": False}


def row(i: int) -> tuple[float, float]:
    """Y and N at an iteration: a decaying start, and scatter that depends on nothing but i."""
    noise = [(math.sin(12.9898 * i + k) * 43758.5453) % 1.0 - 0.5 for k in (0.0, 1.0)]
    return 10.0 + 8.0 * math.exp(-i / 8.0) + 0.1 * noise[0], -30.0 * (1.0 + math.exp(-i / 6.0)) + 0.2 * noise[1]


def program() -> None:
    """Compute in the current folder."""
    case = USUAL | json.loads(Path(CASE).read_text())
    first = int(Path(FIELDS).read_text()) if "--on" in sys.argv else 0
    rows = Path(HISTORY).read_text().splitlines()[:first] if first else []
    with Path(HISTORY).open("w") as history:
        history.write("".join(f"{line}\n" for line in rows))
        for i in range(first + 1, case["iterations"] + 1):
            if case["fails"] == "crash" and i == case["at"]:
                sys.exit("solving for p\nFATAL: no matrix")
            if case["fails"] in ENDS and i == case["at"]:
                os.kill(os.getpid(), ENDS[case["fails"]])
            y, n = row(i)
            y *= 10.0 ** (i - case["at"]) if case["fails"] == "diverge" and i > case["at"] else 1.0
            history.write(f"{i},{y!r},{n!r}\n")
            history.flush()
            asked = Path(ASKED).exists() and not case["deaf"]
            if i % case["fields"] == 0 or asked:
                Path(f"{FIELDS}.new").write_text(str(i))  # a kill leaves the last ones whole
                Path(f"{FIELDS}.new").replace(FIELDS)
            if asked:
                return
            time.sleep(case["pause"])


def prepared(
    folder: Path, name: str = "run", needs: tuple[str, ...] = (), cores: int = 1, key: str = "k", **case: object
):
    """The job of a case below a folder, written there."""
    from coeflab.tank.jobs import Job, Step, write_job

    (folder / name).mkdir(parents=True, exist_ok=True)
    (folder / name / CASE).write_text(json.dumps(case))
    steps = (Step("clean", ("rm", "-f", HISTORY, FIELDS, ASKED)), Step("slow", COMMAND, watched=True))
    job = Job(name, folder / name, "slow", steps, needs, cores, seconds=1.0, key=key, iterations=400.0)
    write_job(job)
    return job


def rows(folder: Path) -> int:
    """Rows that the history has."""
    path = folder / HISTORY
    return len(path.read_text().splitlines()) if path.exists() else 0


def wait(for_what: Callable[[], object], seconds: float = 20.0) -> None:
    """Until it is so."""
    end = time.monotonic() + seconds
    while not for_what():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)


def solvers_in(folder: Path) -> list[int]:
    """Living processes whose working folder this is."""
    out = []
    for entry in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            state = (entry / "stat").read_text().rpartition(")")[2].split()[0]
            if state not in "ZX" and (entry / "cwd").resolve() == folder.resolve():
                out.append(int(entry.name))
    return out


def environment(folder: Path) -> dict[str, str]:
    """Variables with which this is a plugin of an installed package, whose metadata are written into the folder."""
    info = folder / "slow-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: slow\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[coeflab.tow_solvers]\nslow = {__name__}\n")
    root = Path(__file__).parents[2]
    return {"PYTHONPATH": f"{folder}{os.pathsep}{root}", "OPENBLAS_NUM_THREADS": "1"}


COMMAND = (sys.executable, "-S", "-E", __file__)

if __name__ == "__main__":
    program()
else:
    import numpy as np

    from coeflab.core.declarations import Declaration
    from coeflab.core.errors import InputError
    from coeflab.tables.raw_table import RawColumn, RawTable, Run
    from coeflab.tank.jobs import Job, Step
    from coeflab.tank.solvers import Installation

    class options(Declaration):  # noqa: N801
        """None."""

    def installed() -> Installation:
        return Installation("1")

    def jobs(tank: object, body: object, folder: Path) -> tuple[Job, ...]:
        return (prepared(folder),)

    def history(folder: Path) -> Run:
        path = folder / HISTORY
        if not path.is_file():
            raise InputError("no history", "one", file=path)
        lines = [line.split(",") for line in path.read_text().rpartition("\n")[0].splitlines()]
        values = np.array(lines, dtype=float).reshape(-1, 3)
        columns = [
            RawColumn("i", "", values[:, 0], means="iteration"),
            *(RawColumn(c, u, values[:, k], means=c) for k, (c, u) in enumerate((("Y", "N"), ("N", "N m")), 1)),
        ]
        return Run(
            folder, folder.name, RawTable(path, tuple(columns)), patches={"hull": RawTable(path, tuple(columns))}
        )

    def stop(folder: Path) -> None:
        (folder / ASKED).touch()

    def resumed(job: Job) -> tuple[tuple[Step, ...], float]:
        (job.folder / ASKED).unlink(missing_ok=True)
        if not (job.folder / FIELDS).exists():
            return job.steps, math.nan
        return (Step("slow", (*COMMAND, "--on"), watched=True),), float((job.folder / FIELDS).read_text())

    def ended(job: Job) -> tuple[tuple[str, ...], str]:
        return ("a remark",), "unsound" if json.loads((job.folder / CASE).read_text()).get("fails") == "unsound" else ""

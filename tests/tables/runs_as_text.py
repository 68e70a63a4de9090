"""Runs in a format of the tests' own, read by an importer that stands in a package of its own, as anybody's would."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.tables.collect import Collected, collect_groups

FILE = "forces.stub"
IMPORTER = """
import json
import numpy as np
from pathlib import Path
from coeflab.core.errors import InputError
from coeflab.tables.raw_table import Ended, RawColumn, RawTable, Run, Stated

summary = "a format of the tests: runs as JSON and columns"
reads = "runs of the tests"
citations = ("sname1950",)
LOG = None

def recognises(path):
    file = path / "forces.stub" if path.is_dir() else path
    return file.is_file() and file.read_bytes()[:8] == b"stubrun "

def table(file, about, names, rows, part):
    scale = 1.0 if part is None else part
    columns = [RawColumn("time", about.get("time", "-"), rows[:, 0], means=about.get("counts", "iteration"))]
    columns += [RawColumn(about.get("prefix", "") + n, about.get("unit", "N"), scale * rows[:, i + 1], means="" if about.get("unnamed") else n)
                for i, n in enumerate(names)]
    stated = {k: Stated(tuple(v) if isinstance(v, list) else v, f"{file.parent.name}/setup:7") for k, v in about.get("stated", {}).items()}
    return RawTable(file, tuple(columns), files=(file,), stated=stated, dialect={"version": about.get("version", "1")},
                    remarks=tuple(about.get("remarks", ())))

def run(path, options):
    file = path / "forces.stub" if path.is_dir() else path
    with file.open() as stream:
        about = json.loads(stream.readline().removeprefix("stubrun "))
        names = stream.readline().split()[1:]
        text = stream.readlines()
    if about.get("log"):
        with open(about["log"], "a") as log:
            log.write(path.name + "\\\\n")
    if about.get("slow"):
        import time
        time.sleep(about["slow"])
    if about.get("broken"):
        raise InputError(about["broken"] if isinstance(about["broken"], str) else "a line of letters", "numbers", file=file, line=9)
    rows = np.array([[float(c) for c in line.split()] for line in text]).reshape(len(text), len(names) + 1)
    parts = about.get("patches", {})
    return Run(path, path.name, table(file, about, names, rows, None),
               {k: Stated(v[0], v[1]) for k, v in about.get("conditions", {}).items()},
               {k: table(file, about, names, rows, share) for k, share in parts.items()},
               Ended(about.get("ended", "whole")), about.get("why", ""))
"""


def collect(path: Path, importer: str = "", *, names: str = "", **how: Any) -> Collected:
    """A folder of runs as one table."""
    return collect_groups(path, importer, patterns=(names,), **how)[0]


def install(site: Path) -> None:
    """Put the importer where `importlib.metadata` finds it once the folder is on the path."""
    info = site / "stubruns-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: stubruns\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[coeflab.importers]\nstub = stubruns\n")
    (site / "stubruns.py").write_text(IMPORTER.replace("\\\\n", "\\n"))


def write_run(
    folder: Path, forces: dict[str, Any] | None = None, *, rows: int = 200, seed: int = 1, **about: Any
) -> Path:
    """One run: ``forces`` are means, or whole histories; noise of 0.1 % lies on means. Its files look an hour old."""
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(seed)
    given = {"X": -40.0, "Y": 8.0, "N": 70.0} if forces is None else forces
    columns = [
        np.asarray(v, dtype=float) if np.ndim(v) else v * (1.0 + 0.001 * rng.normal(size=rows)) for v in given.values()
    ]
    count = len(columns[0])
    lines = [f"stubrun {json.dumps(about)}", f"time {' '.join(given)}"]
    lines += [
        " ".join(map(repr, map(float, (i + 1, *row)))) for i, row in zip(range(count), zip(*columns, strict=True))
    ]
    (folder / FILE).write_text("\n".join(lines) + "\n")
    old = (folder / FILE).stat().st_mtime - 3600.0
    for path in (folder / FILE, folder):
        os.utime(path, (old, old))
    return folder

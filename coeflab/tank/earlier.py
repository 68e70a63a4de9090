"""Conditions that an earlier tow finished, taken over from its campaign: meshes and fields may be gone, the rows are kept.

A row is taken over where the sha256 of its case and of its mesh in ``runs.csv`` are the keys that the jobs have now. Its
numbers are those of the tables, digit for digit, so that the campaign is the same bytes as if the runs were still there.
"""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError, shown
from coeflab.core.files import write_atomically
from coeflab.core.limits import JSON_BYTES
from coeflab.core.provenance import sha256_of
from coeflab.core.text.csv_rows import plain
from coeflab.core.text.records import OrNone, read_record
from coeflab.core.text.toml import read_text, read_toml
from coeflab.core.texts import input_error
from coeflab.tables.campaign import FILE
from coeflab.tables.histories import Convergence
from coeflab.tables.raw_table import Stated
from coeflab.tables.run_summary import RunSummary
from coeflab.tank.campaign import HISTORIES, RUNS
from coeflab.tank.jobs import EARLIER, Job, JobState, Progressed, or_nan, progress, write_progress
from coeflab.tank.test_matrix import TowCondition
from coeflab.tank.towed_run import TowedRun

_FORCE = re.compile(r"(?P<error>se_)?(?P<name>[XYZKMN])(?P<patch>\(.+\))? \[(?P<unit>N|N\*m)\]")
_ROW = {
    "why": str, "summary_why": str, "status": Convergence, "means": {str: float}, "errors": {str: float},
    "patches": {str: (float, str)}, "mesh": str, "iterations": OrNone(float), "cells": float, "remarks": [str], "history": str,
}  # fmt: skip
_OURS = "a campaign that `coeflab tow` made"


def take_over(campaign: Path, jobs: Sequence[Job]) -> tuple[str, ...]:
    """Count runs as carried out that the campaign of an earlier tow has with the same case and mesh.

    Parameters
    ----------
    campaign : Path
        Folder with campaign.toml, its tables, runs.csv and histories.
    jobs : sequence of Job
        Of the tow, written. Those that are kept already are left as they are.

    Returns
    -------
    tuple of str
        Names of the conditions that were taken over.

    Raises
    ------
    InputError
        The folder has no such campaign, a table is not as campaign.toml has it, or no row is of a case of this tow.
    OutputError
        The folder of a job cannot be written.
    """
    found = matching(campaign, jobs)
    rows = _rows(campaign)
    for job in jobs:
        words = found.get(job.name)
        if words is None or progress(job).state.is_final:
            continue
        row = _content(words, rows.get(job.name, {}))
        history = campaign / HISTORIES / f"{job.name}.csv"
        row["history"] = read_text(history, JSON_BYTES) if history.is_file() else ""
        write_atomically(job.folder / EARLIER, (json.dumps(row, indent=1) + "\n").encode())
        write_progress(
            job.folder,
            Progressed(
                JobState(words["state"]), job.key, iteration=or_nan(row["iterations"]), means=row["means"],
                errors=row["errors"], why=row["why"], remarks=tuple(row["remarks"]),
            ),
        )  # fmt: skip
    return tuple(found)


def matching(campaign: Path, jobs: Sequence[Job]) -> dict[str, Mapping[str, str]]:
    """Rows of an earlier campaign with the case and mesh of these jobs, by condition; nothing is written.

    Raises
    ------
    InputError
        As `take_over`.
    """
    ended = _ended(campaign)
    _rows(campaign)
    keys = {job.name: job.key for job in jobs}
    out: dict[str, Mapping[str, str]] = {}
    for job in jobs:
        words = ended.get(job.name)
        mesh = "+".join(keys.get(name, "") for name in job.needs)
        if words is not None and (words["case sha256"], words["mesh sha256"]) == (job.key, mesh):
            out[job.name] = words
    if not out:
        raise input_error(
            "tow.conditions_ended_none", campaign, column="--finished", count_of_ended=len(ended), runs=RUNS,
        )  # fmt: skip
    return out


def earlier_run(condition: TowCondition, job: Job, state: JobState) -> TowedRun | None:
    """A condition as the earlier tow left it; None where its run is our own.

    Parameters
    ----------
    condition : TowCondition
    job : Job
    state : JobState
        Now; a run whose key has changed since is None too.

    Raises
    ------
    InputError
        The file in the job's folder is damaged.
    """
    path = job.folder / EARLIER
    if not state.is_final or not path.is_file():
        return None
    advice = "Delete it and state.json beside it: the condition is run anew."
    row = read_record(path, _ROW, "the row of an earlier tow", advice=advice, largest=JSON_BYTES)
    summary = None
    if row["means"]:
        cells = {"cells": Stated(row["cells"], FILE)} if row["cells"] else {}
        summary = RunSummary(
            condition.name, Convergence(row["status"]), row["summary_why"], row["means"], row["errors"],
            iterations=or_nan(row["iterations"]), stated_conditions=cells,
            patches={name: (mean, unit) for name, (mean, unit) in row["patches"].items()},
        )  # fmt: skip
    return TowedRun(
        condition,
        state,
        row["why"],
        summary,
        tuple(row["remarks"]),
        job.key,
        row["mesh"],
        short=row["history"].encode(),
    )


def _ended(campaign: Path) -> dict[str, dict[str, str]]:
    """Rows of runs.csv that are kept, by condition."""
    path = campaign / RUNS
    if not path.is_file():
        raise InputError(f"no {RUNS}", _OURS, file=campaign, column="--finished")
    try:
        rows = _read(io.StringIO(read_text(path, JSON_BYTES), newline=""))
        selected = {
            r["condition"]: r for r in rows if JobState(r["state"]).is_final and r["case sha256"] + r["mesh sha256"]
        }
    except (ValueError, KeyError, TypeError, csv.Error) as why:
        raise InputError(f"no table of runs ({shown(why)[1:-1]})", _OURS, file=path, column="--finished") from None
    return selected


def _rows(campaign: Path) -> dict[str, Mapping[str, str]]:
    """Rows of the tables that were run, by condition; a table that somebody has edited is refused."""
    file = read_toml(campaign / FILE)
    out: dict[str, Mapping[str, str]] = {}
    for i, table in enumerate(file.content.get("table", [])):
        if "by_symmetry" in table:
            continue
        path = campaign / str(table.get("file"))
        if not path.is_file() or sha256_of(path) != table.get("sha256"):
            raise file.fail(f"table[{i}].sha256", f"not the sha256 of {path.name}", "the table as the tow wrote it",
                            "Rows that were edited by hand cannot be taken over.")  # fmt: skip
        stream = io.StringIO(read_text(path, JSON_BYTES), newline="")
        rows = _read(line for line in stream if not line.startswith("#"))
        out |= {r["point"]: r for r in rows if r.get("point")}
    return out


def _read(lines: Iterable[str]) -> list[dict[str, str]]:
    """Rows of a table of ours by their heads, texts as they were before they were written."""
    return [{plain(k): plain(v) if isinstance(v, str) else v for k, v in r.items() if k} for r in csv.DictReader(lines)]


def _content(given: Mapping[str, str], row: Mapping[str, str]) -> dict[str, Any]:
    """What the campaign says of a condition: ``runs.csv`` and its row of the table, which is empty for a run without means."""
    means, errors, patches = {}, {}, {}
    for head, cell in row.items():
        found = _FORCE.fullmatch(head)
        if found is None or not cell:
            continue
        if found["patch"]:
            patches[found["name"] + found["patch"]] = (float(cell), found["unit"])
        elif found["error"]:
            errors[found["name"]] = float(cell)
        else:
            means[found["name"]] = float(cell)
    status = given["status"] if given["status"] in list(Convergence) else Convergence.DRIFTING
    return {
        "why": given["why"] if given["state"] != JobState.FINISHED else "",
        "summary_why": given["why"] if given["state"] == JobState.FINISHED else "",
        "status": status, "means": means, "errors": errors, "patches": patches, "mesh": given["mesh sha256"],
        "iterations": float(row["iterations"]) if row.get("iterations") else None, "cells": float(row.get("cells") or 0.0),
        "remarks": [given["remarks"]] if given["remarks"] else [],
    }  # fmt: skip

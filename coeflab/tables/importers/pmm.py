"""Runs of a planar motion mechanism: a list of runs and one file of forces over time for each.

The list (``runs.csv``) says of every run its file, motion and frequency, and what the files do not hold; a file has ``t`` and the
forces, and may have the motion: displacements y z phi theta psi, velocities u v w p q r, accelerations udot ... rdot. A file may
also be a captive test as the SIMMAN workshops ask for it.
All of them are in the axes that campaign.toml declares, displacements in axes that move with the carriage and lie along
those of the body at rest.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.axes import angle_sign
from coeflab.core.errors import InputError, shown
from coeflab.core.options import NoOptions, parse_options
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.text.bounded import stream_of
from coeflab.core.text.delimited import Cells, read_cells
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.law.symbols import ANGULAR, COMPONENTS, FORCES, LINEAR, MOMENTS
from coeflab.tables.campaign import Campaign, TableDeclaration, TowedInertia
from coeflab.tables.force_table import ForceTable
from coeflab.tables.planar_motion import (
    DISPLACEMENTS,
    VARIABLES,
    Filter,
    PlanarMotionRun,
    PlanarMotionTable,
    TimeSeries,
)
from coeflab.tables.simman_files import is_captive_test, record

summary = (
    "runs of a planar motion mechanism: runs.csv (file, motion, frequency [Hz] ...) and one CSV over time for each"
)
citations = ("sname1950", "ittc_captive")
reads = "PMM runs"
fit = "planar_motion"

OFFSETS, TURNS = ("x", "y", "z"), ("phi", "theta", "psi")
LINEAR_RATES, ANGULAR_RATES = tuple(f"{v}dot" for v in LINEAR), tuple(f"{v}dot" for v in ANGULAR)
GROUPS = {
    "displacements": ((OFFSETS, "length"), (TURNS, "angle")),
    "velocities": ((LINEAR, "speed"), (ANGULAR, "rate")),
    "accelerations": ((LINEAR_RATES, "acceleration"), (ANGULAR_RATES, "angular acceleration")),
    "forces": ((FORCES, "force"), (MOMENTS, "moment")),
}
DIMENSIONS = {n: d for groups in GROUPS.values() for names, d in groups for n in names}
NUMBERS = {
    "frequency": "frequency", "omega": "rate", "period": "time", "U": "speed", "phase": "angle", "beta": "angle",
    "alpha": "angle", "start": "time", **{DISPLACEMENTS[m]: DIMENSIONS[DISPLACEMENTS[m]] for m in VARIABLES},
}  # fmt: skip
TEXTS = ("run", "file", "motion", "in_air")
MEANS = "rows are means of oscillating runs, which no steady fit uses; planar_motion reads them over time"
HEAD = 4096


def recognises(path: Path) -> bool:
    """Whether the file is a list of runs: CSV with the columns file and motion, as far as its first 4 KiB say."""
    if not path.is_file():
        return False
    with stream_of(path) as stream:
        lines = stream.read(HEAD).decode("utf-8", "replace").splitlines()
    head = next((line for line in lines if line.strip() and not line.lstrip().startswith("#")), "")
    return {"file", "motion"} <= {c.strip() for c in head.lstrip("\ufeff").split(",")}


def read(
    campaign: Campaign, only: str | None = None, options: Mapping[str, Any] | None = None
) -> tuple[ForceTable, ...]:
    """Read the lists of runs of a campaign, and every file that they name.

    Parameters
    ----------
    campaign : Campaign
    only : str, optional
        File name of the one list that is wanted.
    options : mapping, optional
        None are known.

    Returns
    -------
    tuple of PlanarMotionTable

    Raises
    ------
    InputError
        A declaration that is missing, a cell that cannot be, a file that is not there.
    """
    parse_options(NoOptions, options or {}, "pmm")
    if campaign.half_model:
        raise input_error("tables.half_model_oscillates", campaign.path, column="campaign.half_model")
    return tuple(_table(campaign, t) for t in campaign.wanted(only))


def _table(campaign: Campaign, table: TableDeclaration) -> PlanarMotionTable:
    cells = read_cells(campaign.path.parent / table.file)
    runs = tuple(_runs(campaign, table, cells))
    inertia = _inertia(campaign, table, runs)
    filters, restoring = _declared(campaign, runs)
    digest = sha256_of(cells.file)
    if table.sha256 and table.sha256 != digest:
        raise input_error("tables.run_list_changed", cells.file, digest=digest[:12], sha256=table.sha256[:12])
    drift, attack, speed = (np.array([getattr(r, n) for r in runs]) for n in ("drift", "attack", "speed"))
    zero = np.zeros(len(runs))
    flow = (np.cos(attack) * np.cos(drift), np.sin(drift), np.sin(attack) * np.cos(drift))
    means = {
        c: np.array([np.mean(r.record.forces[c]) if c in r.record.forces else np.nan for r in runs]) for c in COMPONENTS
    }
    means = {c: m for c, m in means.items() if np.any(np.isfinite(m))}
    folder = campaign.path.parent
    files = dict.fromkeys(s.file for r in runs for s in (r.record, r.in_air) if s is not None)
    notes = [MEANS]
    notes += [] if campaign.axes.name == "FRD" else [f"axes turned from {campaign.axes.name} to FRD"]
    notes += [f"filter of {c}: {f.text}" for c, f in filters.items() if f.text != "none"]
    return PlanarMotionTable(
        name=f"{campaign.name}/{table.file}",
        campaign=campaign.name,
        title=campaign.title,
        body=campaign.body,
        motion={**{m: speed * p for m, p in zip(LINEAR, flow, strict=True)}, **dict.fromkeys(ANGULAR, zero)},
        controls={},
        speed=speed,
        forces=means,
        errors={},
        usable={c: np.zeros(len(runs), dtype=bool) for c in means},
        exclusions=(),
        labels=tuple(r.label for r in runs),
        reference_point=campaign.reference_point,
        datum=campaign.datum,
        conditions=campaign.conditions,
        scaling=campaign.scaling,
        source=campaign.source,
        files=(
            InputFile(f"{campaign.name}/{campaign.path.name}", sha256_of(campaign.path)),
            InputFile(f"{campaign.name}/{table.file}", digest),
            *(InputFile(f"{campaign.name}/{f.relative_to(folder).as_posix()}", sha256_of(f)) for f in files),
        ),
        notes=tuple(notes),
        lines=tuple(r.line for r in runs),
        runs=runs,
        inertia=inertia,
        filters=filters,
        restoring=restoring,
    )


def _si(cells: Cells, name: str, dimension: str) -> Array:
    """A column in SI; errors of its unit at its header."""
    return cells.si(next(h for h in cells.headers if h.name == name), dimension, f"{name} [...]")


def _unknown(cells: Cells, known: tuple[str, ...]) -> None:
    strange = next((h for h in cells.headers if h.name not in known), None)
    if strange is not None:
        raise input_error(
            "tables.unknown_column_of_runs", cells.file, cells.first_line - 1, strange.text, text=shown(strange.text),
            known=", ".join(known),
        )  # fmt: skip


def _runs(campaign: Campaign, table: TableDeclaration, cells: Cells) -> list[PlanarMotionRun]:
    """Every row of the list with its record."""
    ignored = (*table.ignore, *table.labels)
    _unknown(cells, (*TEXTS, *NUMBERS, *ignored))
    names = [h.name for h in cells.headers]
    for name in ("file", "motion"):
        if name not in names:
            raise InputError(f"no column {name}", "file and motion", file=cells.file, line=cells.first_line - 1)
    texts = {n: cells.texts(n) for n in TEXTS if n in names}
    numbers = {n: _si(cells, n, d) for n, d in NUMBERS.items() if n in names}
    if "frequency" in numbers:
        numbers["omega"] = 2.0 * np.pi * numbers["frequency"]
    elif "period" in numbers:
        numbers["omega"] = 2.0 * np.pi / numbers["period"]
    signs = {n: angle_sign(n, campaign.signs.get(n), campaign.path) if n in numbers else 1.0 for n in ("alpha", "beta")}
    turn = _turns(campaign)
    out = []
    for i in range(len(cells)):
        given = {n: float(v[i]) for n, v in numbers.items() if np.isfinite(v[i])}
        motion = texts["motion"][i]

        def fail(code: str, column: str, row: int = i, **facts: Any) -> InputError:
            return input_error(code, cells.file, cells.line(row), column, **facts)

        if motion not in VARIABLES:
            raise fail("tables.unknown_motion", "motion", motion=shown(motion), variables=", ".join(VARIABLES))
        if not given.get("omega", 0.0) > 0.0:
            raise fail("tables.no_frequency", "frequency")
        speed = given.get("U", campaign.conditions.speed)
        if not speed > 0.0:
            raise fail("tables.no_speed_of_run", "U", speed=speed)
        moved = DISPLACEMENTS[motion]
        amplitude, phase = given.get(moved), given.get("phase")
        if amplitude is not None and not amplitude > 0.0:
            raise fail("tables.no_amplitude", moved, amplitude=amplitude)
        if phase is not None and abs(phase) > 2.0 * np.pi:
            raise fail("tables.phase_beyond_turn", "phase", degrees=np.degrees(phase))
        start = given.get("start", 0.0)
        record = _series(cells.file.parent, texts["file"][i], start, ignored, turn, fail)
        air = texts.get("in_air", [""] * len(cells))[i]
        if not record.has_motion and (amplitude is None or phase is None):
            raise fail("tables.no_motion", moved, moved=moved, texts=texts["file"][i])
        # A motion about or along a table's axis that points the other way is the same with the phase turned by half.
        if phase is not None and turn[moved][1] < 0.0:
            phase += np.pi
        out.append(
            PlanarMotionRun(
                label=texts["run"][i] if texts.get("run", [""] * len(cells))[i] else Path(texts["file"][i]).stem,
                line=cells.line(i),
                listed=cells.file,
                motion=motion,
                omega=given["omega"],
                speed=speed,
                amplitude=amplitude,
                phase=phase,
                drift=signs["beta"] * given.get("beta", 0.0),
                attack=signs["alpha"] * given.get("alpha", 0.0),
                record=record,
                in_air=_series(cells.file.parent, air, start, ignored, turn, fail) if air else None,
            )
        )
    return out


def _turns(campaign: Campaign) -> dict[str, tuple[str, float]]:
    """FRD name of every column of a record's triads -> the table's own column and its sign."""
    out = {}
    for groups in GROUPS.values():
        for names, _ in groups:
            for i, name in enumerate(names):
                j = int(np.argmax(np.abs(campaign.axes.rotation[i])))
                out[name] = names[j], float(campaign.axes.rotation[i, j])
    return out


def _series(
    folder: Path, name: str, start: float, ignored: tuple[str, ...], turn: Mapping[str, tuple[str, float]], fail: Any
) -> TimeSeries:
    """One record, from ``start`` on, turned to FRD."""
    path = (folder / name).resolve()
    if not name or not path.is_relative_to(folder.resolve()):
        raise fail("tables.file_elsewhere", "file", path=shown(name))
    if not path.is_file():
        raise fail("tables.no_record", "file", path=shown(name))
    path = folder / name
    if is_captive_test(path):
        time, columns = record(path)
        columns = {n: v for n, v in columns.items() if n not in ignored}
        back = np.flatnonzero(np.diff(time) <= 0.0)
        if back.size:
            raise InputError(f"{time[back[0] + 1]:g} s after {time[back[0]]:g} s", "a time that rises", file=path)
        return _turned(path, time, columns, start, turn)
    cells = read_cells(path)
    _unknown(cells, ("t", *DIMENSIONS, *ignored))
    names = [h.name for h in cells.headers if h.name not in ignored]
    if "t" not in names:
        raise InputError("no column t", "t [s]", file=path, line=cells.first_line - 1)
    columns = {n: _si(cells, n, "time" if n == "t" else DIMENSIONS[n]) for n in names}
    for n, values in columns.items():
        blank = np.flatnonzero(np.isnan(values))
        if blank.size:
            raise InputError("a blank cell", "a number", file=path, line=cells.line(int(blank[0])), column=n)
    time = columns.pop("t")
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if back.size:
        at = int(back[0]) + 1
        raise input_error("tables.time_falls", path, cells.line(at), "t", now=time[at], before=time[at - 1])
    return _turned(path, time, columns, start, turn)


def _turned(
    path: Path, time: Array, columns: Mapping[str, Array], start: float, turn: Mapping[str, tuple[str, float]]
) -> TimeSeries:
    """A record from ``start`` on, in FRD."""
    keep = time >= start
    result: dict[str, dict[str, Array]] = {}
    for kind, groups in GROUPS.items():
        frd = [n for names, _ in groups for n in names if turn[n][0] in columns]
        result[kind] = {n: turn[n][1] * columns[turn[n][0]][keep] for n in frd}
    if not result["forces"]:
        raise InputError("no force column", "at least one of X Y Z K M N", file=path)
    result["accelerations"] = {n.removesuffix("dot"): v for n, v in result["accelerations"].items()}
    return TimeSeries(file=path, time=time[keep], **result)


def _inertia(campaign: Campaign, table: TableDeclaration, runs: tuple[PlanarMotionRun, ...]) -> TowedInertia | None:
    """The inertia that is to be taken out by its numbers."""
    in_air = sum(r.in_air is not None for r in runs)
    if table.contains_inertia is None:
        raise input_error("tables.inertia_not_declared", campaign.path, column="table.contains_inertia")
    if not table.contains_inertia:
        if in_air:
            raise input_error("tables.runs_in_air_without_inertia", campaign.path, column="table.contains_inertia")
        return None
    if 0 < in_air < len(runs):
        run = next(r for r in runs if r.in_air is None)
        raise run.fail(
            f"{run.label} without a run in air", "in_air for every run, or [inertia] for all", column="in_air"
        )
    if in_air:
        return None
    if campaign.inertia is None:
        raise input_error("tables.inertia_without_mass", campaign.path, column="inertia")
    if campaign.inertia.inertia is None:
        raise input_error("tables.oscillates_without_inertia", campaign.path, column="inertia.inertia")
    return campaign.inertia


def _declared(
    campaign: Campaign, runs: tuple[PlanarMotionRun, ...]
) -> tuple[dict[str, Filter], tuple[float, float] | None]:
    """Filters by FRD channel, and restoring moments, refused where they matter and are not declared."""
    keys = campaign.planar_motion
    if keys is None:
        raise input_error("tables.no_planar_motion", campaign.path, column="planar_motion")
    known = ("forces", "motion", *COMPONENTS)
    strange = next((n for n in keys.filter if n not in known), None)
    if strange is not None:
        raise input_error(
            "tables.unknown_channel", campaign.path, column="planar_motion.filter", strange=shown(strange), known=", ".join(known),
        )  # fmt: skip
    read = {n: Filter.read(t, campaign.path, f"planar_motion.filter.{n}") for n, t in keys.filter.items()}
    turn = _turns(campaign)
    out = {}
    have = [c for c in COMPONENTS if any(c in r.record.forces for r in runs)]
    for c in [*have, *(["motion"] if any(r.record.has_motion for r in runs) else [])]:
        column = turn[c][0] if c in turn else c
        declared = read.get(column, read.get("forces") if c != "motion" else None)
        if declared is None:
            raise input_error("tables.no_filter", campaign.path, column="planar_motion.filter", head=column)
        out[c] = declared
    turning = next((r for r in runs if r.motion in ("roll", "pitch")), None)
    if keys.restoring is None and turning is not None:
        raise input_error("tables.no_restoring", campaign.path, column="planar_motion.restoring", motion=turning.motion)
    return out, None if keys.restoring is None else (keys.restoring[0], keys.restoring[1])

"""What a tow gave, as a campaign: one table a kind of condition, every row with its state, and where each row comes from.

The rows are means over the plateau of each run, as `coeflab.tables.run_summary` makes them of any solver's. Nothing in them depends
on when or how often a run was started, so that a finished run gives the same bytes after an interruption.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.provenance import sha256_of
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.text.toml import quoted, value
from coeflab.core.types import Array
from coeflab.core.version import VERSION
from coeflab.core.wording import natural, one_line
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROL_COLUMNS, FORCES, LINEAR, MOTIONS
from coeflab.tables.campaign import CUTS, FILE, FOURFOLD, PORT_STARBOARD, UP_DOWN
from coeflab.tables.histories import Convergence
from coeflab.tables.raw_table import RawTable, Run
from coeflab.tables.run_summary import RunSummary
from coeflab.tank.fourfold import SOURCES, by_fourfold_symmetry
from coeflab.tank.jobs import JobState
from coeflab.tank.tank import Tank
from coeflab.tank.test_matrix import Half, Kind, TowCondition
from coeflab.tank.towed_body import TowedBody
from coeflab.tank.towed_run import TowedRun

RUNS, HISTORIES = "runs.csv", "histories"
HISTORY_ROWS = 200  # of the history of a run that the campaign keeps
SIX = ("Yv", "Nv", "Zw", "Mw", "Yr", "Nr")
REPORTED = {
    Half.WHOLE: tuple(COMPONENTS), Half.UPPER: CUTS[UP_DOWN].doubled, Half.PORT: CUTS[PORT_STARBOARD].doubled,
}  # fmt: skip
LABELS = ("kind", "grid", "half", "status")
VARIANT = "variant"
LONG_CONTROLS = {short: name for name, short in CONTROL_COLUMNS.items()}
SMOOTH = "none per point: a smooth law, whose fits do not show the scatter of the methods"


def rows_of(tank: Tank, table: RawTable) -> tuple[TowedRun, ...]:
    """The conditions of a tank as a method gives them that needs no runs: its rows bear the conditions' names.

    Parameters
    ----------
    tank : Tank
    table : RawTable
        Forces by their meaning, SI, whole body, FRD; a condition without a row, or with blank cells, was not run.
    """
    at = {name: i for i, name in enumerate(table.row_labels)}
    known = {c.means: c for c in table.columns if c.means}
    out = []
    for condition in tank.matrix:
        row = at.get(condition.name)
        wanted = [c for c in REPORTED[condition.half] if c in known]
        means = {} if row is None else {c: float(known[c].values[row]) for c in wanted}
        means = {c: x for c, x in means.items() if math.isfinite(x)}
        if row is None or not means:
            out.append(TowedRun(condition, JobState.WAITING, "no forces in the table"))
            continue
        errors = {c: float(known[f"se_{c}"].values[row]) for c in means if f"se_{c}" in known}
        summary = RunSummary(condition.name, Convergence.CONVERGED, means=means, errors=errors)
        cells = known.get("cells")
        if cells is not None and math.isfinite(cells.values[row]):
            from coeflab.tables.raw_table import Stated

            summary = RunSummary(
                condition.name, Convergence.CONVERGED, means=means, errors=errors,
                stated_conditions={"cells": Stated(float(cells.values[row]), table.path.name)},
            )  # fmt: skip
        out.append(TowedRun(condition, JobState.FINISHED, "", summary))
    return tuple(out)


def campaign_files(
    tank: Tank, body: TowedBody, runs: Sequence[TowedRun], version: str, inputs: Mapping[str, Path] | None = None,
    stated: str = "", kind: str = "cfd",
) -> dict[str, bytes]:  # fmt: skip
    """The files of the campaign folder, by name: tables, campaign.toml, runs.csv, and a short history of each run.

    Parameters
    ----------
    tank : Tank
    body : TowedBody
    runs : sequence of TowedRun
        Every condition of the matrix, in its order.
    version : str
        Of the solver.
    inputs : mapping of str to Path, optional
        Files whose sha256 is written down: ``body.toml``, ``tank.toml``.
    stated : str
        Who made the rows, and the table, where they are no runs of ours: then nothing is said of how they came about.
    kind : str
        Of the source, as campaign.toml has it.

    Returns
    -------
    dict of str to bytes
        Without a table where no condition has a mean.
    """
    groups = _grouped(runs)
    turned = by_fourfold_symmetry(groups) if FOURFOLD in tank.symmetry else {}
    files: dict[str, bytes] = {}
    declared: list[str] = []
    for name, group in {**groups, **turned}.items():
        if not any(r.summary is not None and r.summary.means for r in group):
            continue
        origin = f"by fourfold symmetry, from {SOURCES[name]}.csv turned by 90 deg about x" if name in turned else ""
        files[f"{name}.csv"], notes = _table(group, origin)
        declared.append(
            _declared(
                name, group, notes, origin, hashlib.sha256(files[f"{name}.csv"]).hexdigest(), tank.reference_point
            )
        )
    if not declared:
        return {}
    files[FILE] = _campaign_text(
        tank, body, runs, version, inputs or {}, declared, tuple(turned), stated, kind
    ).encode()
    files[RUNS] = _runs_text(runs)
    for r in runs:
        short = r.short if r.history is None or not len(r.history.history) else short_history(r.history)
        if short:
            files[f"{HISTORIES}/{r.condition.name}.csv"] = short
    return files


def _grouped(runs: Sequence[TowedRun]) -> dict[str, list[TowedRun]]:
    """Runs by the table that they belong to; a table has conditions of one kind that report the same components."""
    kinds = {r.condition.kind for r in runs}
    out: dict[str, list[TowedRun]] = {}
    for r in runs:
        out.setdefault(_table_name(r.condition, kinds), []).append(r)
    return {name: out[name] for name in sorted(out, key=lambda n: (_place(n), natural(n)))}


_ORDER = ("straight", "drift", "attack", "arm", "arm_pitch", "arm_roll", "combined", "control")


def _place(name: str) -> int:
    return _ORDER.index(name) if name in _ORDER else len(_ORDER)


def _table_name(condition: TowCondition, kinds: set[Kind]) -> str:
    """``drift``, ``attack``, ``arm`` ...: straight runs are the zero of the sweep that has their half of the body."""
    half = condition.half
    if condition.kind is Kind.STRAIGHT:
        order = (Kind.ATTACK, Kind.DRIFT) if half is Half.PORT else (Kind.DRIFT, Kind.ATTACK)
        return next((str(k) for k in order if k in kinds), "straight")
    if condition.kind is Kind.ARM:
        p, q, r = np.abs(condition.rates)
        return "arm" if r >= max(p, q) else "arm_pitch" if q >= p else "arm_roll"
    usual = {Kind.DRIFT: (Half.WHOLE, Half.UPPER), Kind.ATTACK: (Half.WHOLE, Half.PORT)}.get(condition.kind, ())
    is_usual = not usual or half in usual
    return str(condition.kind) if is_usual else f"{condition.kind}_{'port' if half is Half.PORT else 'upper'}"


def _table(group: Sequence[TowedRun], origin: str) -> tuple[bytes, dict[str, list[str]]]:
    """One table as CSV, and the names of its columns that are labels, and that are ignored."""
    motions = [m for m in MOTIONS if m == "u" or any(_motion(r, m) != 0.0 for r in group)]
    controls = [c for c in dict.fromkeys(k for r in group for k in r.condition.controls) if c in LONG_CONTROLS]
    given = {c for r in group if r.summary for c in r.summary.means if c in REPORTED[r.condition.half]}
    components = [c for c in COMPONENTS if c in given]
    # A run of a few iterations has means and no standard error yet: its numbers wait, so that finished rows keep theirs.
    judged = [r for r in group if r.counts] or group
    with_errors = [
        c for c in components if all(_error(r, c) > 0.0 for r in judged if r.summary and c in r.summary.means)
    ]
    patches = list(dict.fromkeys(p for r in group if r.summary for p in r.summary.patches if p[0] in components))
    has_cells = any(_cells(r) for r in group)
    heads = ["point", *(f"{m} [{'m/s' if m in LINEAR else 'rad/s'}]" for m in motions)]
    heads += [f"{LONG_CONTROLS[c]} [rad]" for c in controls]
    heads += [f"{c} [{'N' if c in FORCES else 'N*m'}]" for c in components]
    heads += [f"se_{c} [{'N' if c in FORCES else 'N*m'}]" for c in with_errors]
    varies = any(variant_of(r.condition) for r in group)
    heads += [*LABELS, *([VARIANT] if varies else []), *(["cells"] if has_cells else []), "iterations"]
    heads += [f"{p} [{'N' if p[0] in FORCES else 'N*m'}]" for p in patches]
    heads.append("uncertain")
    rows = [heads]
    for r in group:
        c, s = r.condition, r.summary
        means = s.means if s is not None else {}
        means = {x: mean for x, mean in means.items() if x not in with_errors or _error(r, x) > 0.0}
        known = REPORTED[c.half]
        doubtful = [x for x in components if not r.counts or x not in means or x not in known]
        cells = [c.name, *(_exact(_motion(r, m)) for m in motions), *(_exact(c.controls.get(k, 0.0)) for k in controls)]
        cells += [_number(means.get(x)) if x in known else "" for x in components]
        cells += [_short(_error(r, x)) if x in known else "" for x in with_errors]
        cells += [str(c.kind), c.grid, str(c.half) or "whole", r.status]
        cells += [variant_of(c)] if varies else []
        cells += [_cells(r)] if has_cells else []
        cells.append("" if s is None or not math.isfinite(s.iterations) else f"{s.iterations:.10g}")
        cells += ["" if s is None or p not in s.patches else _number(s.patches[p][0]) for p in patches]
        cells.append(" ".join(doubtful))
        rows.append(cells)
    names = {"labels": list(LABELS), "ignore": ["iterations", *patches]}
    if has_cells:
        names["cells"] = ["cells"]
    return csv_text(rows, [f"Not run: {origin}."] * bool(origin)).encode(), names


def variant_of(condition: TowCondition) -> str:
    """What a study changes, ``domain = 1.5``; empty for a condition of the matrix itself."""
    return ", ".join(f"{k} = {v}" for k, v in condition.variant.items())


def _motion(run: TowedRun, name: str) -> float:
    c = run.condition
    return float(c.velocity[LINEAR.index(name)] if name in LINEAR else c.rates[ANGULAR.index(name)])


def _error(run: TowedRun, component: str) -> float:
    error = run.summary.errors.get(component, math.nan) if run.summary is not None else math.nan
    return error if math.isfinite(error) else 0.0


def _cells(run: TowedRun) -> str:
    stated = run.summary.stated_conditions.get("cells") if run.summary is not None else None
    return f"{stated.value:.0f}" if stated is not None and isinstance(stated.value, (int, float)) else ""


def _exact(x: float) -> str:
    """Twelve digits: settings come from angles, and rows at one setting have to be recognised."""
    return f"{x + 0.0:.12g}"


def _number(x: float | None) -> str:
    return "" if x is None or not math.isfinite(x) else f"{x + 0.0:.6g}"


def _short(x: float) -> str:
    return f"{x:.3g}" if x > 0.0 else ""


def _declared(
    name: str, group: Sequence[TowedRun], names: Mapping[str, list[str]], origin: str, digest: str, point: Array
) -> str:
    """The ``[[table]]`` of one table, whose bytes have the sha256 ``digest``; its runs turn about ``point``."""
    lines = ["[[table]]", f'file = "{name}.csv"', f'sha256 = "{digest}"']
    if any(r.condition.turns for r in group):
        lines.append(f"{'contains_inertia = false':<41} # the solver's frame turns: hydrodynamic force only")
        still = f"arm_point = {value([float(x) for x in point])}"
        lines.append(f"{still:<41} # U and drift hold here")
    lines.append(f"labels = {value(names['labels'])}")
    if names["ignore"]:
        lines.append(f"ignore = {value(names['ignore'])}")
    if "cells" in names:
        own = 'cells = "cells"'
        lines.append(f"{own:<41} # of the grid, for the grid study")
    if any(variant_of(r.condition) for r in group):
        lines.append(f"variant = {quoted(VARIANT)}")
    if len({r.condition.grid for r in group}) > 1:
        lines.append(f"select = {value({'grid': 'medium', 'reason': 'grid study only'})}")
    if origin:
        source = f"by_symmetry = {quoted(f'{SOURCES[name]}.csv')}"
        lines.append(f"{source:<41} # turned by 90 deg about x: stated, not run")
    return "\n".join(lines)


def _campaign_text(
    tank: Tank, body: TowedBody, runs: Sequence[TowedRun], version: str, inputs: Mapping[str, Path],
    declared: Sequence[str], turned: Sequence[str], origin: str, kind: str,
) -> str:  # fmt: skip
    finished = sum(r.counts for r in runs)
    stated = [*tank.by_symmetry, *(f"{t}.csv from {SOURCES[t]}.csv by fourfold symmetry" for t in turned)]
    files = "; ".join(f"{name} sha256 {sha256_of(path)[:16]}..." for name, path in inputs.items())
    at = tank.conditions
    how = (
        f"{version}, run by coeflab {VERSION}. Means over plateaus, se from batch means and range "
        "(iteration noise only). Half bodies are doubled. Runs: runs.csv." + (f" {files}." if files else "")
    )
    if origin:
        how = f"As the table gives it: {origin}, read by coeflab {VERSION}." + (f" {files}." if files else "")
    grids = {r.condition.grid for r in runs}
    errors = any(r.summary is not None and r.summary.errors for r in runs)
    own = ("errors per point (se_) as the table states them; " if errors else "no errors stated; ") if origin else ""
    scatter = (own or "iteration noise per point (se_); ") + (
        f"grids {', '.join(g.name for g in tank.grids if g.name in grids)} for chosen conditions"
        if len(grids) > 1
        else "one grid: grid error not assessed"
    )
    sections: dict[str, dict[str, Any]] = {
        "campaign": {
            "name": tank.name, "title": tank.title, "body": body.body.name, "symmetry": list(tank.symmetry) or None,
            "notes": " ".join([f"{finished} of {len(runs)} conditions {'given' if origin else 'converged'}.", *(f"By symmetry: {s}." for s in stated)]),
        },
        "axes": {
            "frame": "FRD", "datum": tank.datum.id, "datum_note": tank.datum.note or None,
            "reference_point": [float(x) for x in tank.reference_point],
        },
        "scaling": {"length": float(tank.scaling.length), "length_name": tank.scaling.length_name},
        "conditions": {
            "speed": float(at.speed), "density": float(at.density), "viscosity": at.viscosity,
            "reynolds": at.reynolds_on(tank.scaling.length),
        },
        "source": {
            "citation": f"{body.body.name}: {origin}" if origin else f"coeflab tow of {body.body.name}, {version}",
            "kind": kind, "how_obtained": how,
            "stated_uncertainty": SMOOTH if kind == "estimate" else f"{scatter}; modelling error not assessed",
        },
    }  # fmt: skip
    lines = ["# Made by `coeflab tow`. What its rows come from, run by run, is in runs.csv."]
    for section, keys in sections.items():
        lines += ["", f"[{section}]"]
        lines += [f"{k} = {quoted(v) if isinstance(v, str) else value(v)}" for k, v in keys.items() if v is not None]
    return "\n".join([*lines, *(f"\n{d}" for d in declared)]) + "\n"


def _runs_text(runs: Sequence[TowedRun]) -> bytes:
    """Every condition with its state, what shows it, and the keys of its case and mesh."""
    rows = [["condition", "state", "status", "why", "remarks", "case sha256", "mesh sha256"]]
    for r in runs:
        shown = r.why or (r.summary.why if r.summary is not None else "")
        texts = (r.condition.name, str(r.state), r.status, shown, "; ".join(r.remarks), r.case, r.mesh)
        rows.append([one_line(t) for t in texts])
    return csv_text(rows).encode()


def short_history(run: Run, most: int = HISTORY_ROWS) -> bytes:
    """At most so many rows of a history, evenly spread, the last among them: iteration and forces, six digits.

    Parameters
    ----------
    run : Run
    most : int
    """
    history = run.history
    at = history.meaning("time") or history.meaning("iteration")
    columns = [*([at] if at is not None else []), *(c for x in COMPONENTS if (c := history.meaning(x)) is not None)]
    n = len(history)
    rows = np.unique(np.linspace(0, n - 1, min(n, most)).round().astype(int))
    heads = [f"{c.means} [{c.unit}]" if c.means in COMPONENTS else c.means for c in columns]
    return csv_text([heads, *([f"{c.values[i]:.6g}" for c in columns] for i in rows)]).encode()

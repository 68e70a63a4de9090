"""Tables of the tow tank: what a tow will take, how far it is, and how its conditions ended. At most 80 columns."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import ABSENT, Table, with_u95
from coeflab.core.texts import words
from coeflab.core.types import brief
from coeflab.core.wording import listed
from coeflab.law.coefficient import Status
from coeflab.law.symbols import ANGULAR, LINEAR, primed
from coeflab.report.printable import shortened
from coeflab.study.checks.symmetry import biases
from coeflab.study.towed import NO_RESULT, TowedRow
from coeflab.tables.conditions import named
from coeflab.tank.jobs import Job, JobState

if TYPE_CHECKING:
    from coeflab.study.study import Study
    from coeflab.tank.states import JobRow
    from coeflab.tank.tank import Tank
    from coeflab.tank.test_matrix import TowCondition
    from coeflab.tank.towed_run import TowedRun

NAME, MOTION, LONGEST, LONGEST_WHY = 20, 17, 44, 42  # letters
SIGN_OPEN = "sign open"
IN_A_PLANE = ("Y'", "N'", "Z'", "M'")
LEAST = 1e-4  # of a thousandth of a primed unit
# What a person looks for first, where not all rows fit.
FIRST = (
    JobState.RUNNING, JobState.CRASHED, JobState.DIVERGED, JobState.STOPPED, JobState.UNCONVERGED, JobState.CHANGED,
    JobState.WAITING, JobState.FINISHED,
)  # fmt: skip


@brief
@dataclass(frozen=True, slots=True)
class Shown:
    """What the table of runs has to know of a condition.

    Attributes
    ----------
    force, moment : str
        The components that it is for: Y and N, or Z and M.
    units : tuple of 2 floats
        SI value of one unit of a primed force and moment.
    """

    force: str
    moment: str
    units: tuple[float, float]


def shown_of(plan: Mapping[str, Any]) -> dict[str, Shown]:
    """By condition, from ``tow.json``."""
    out = {}
    for c in plan["conditions"]:
        (_, v, w), (_, q, r) = c["velocity"], c["rates"]
        across = max(abs(v), abs(r)), max(abs(w), abs(q))
        vertical = c["half"] == "y<0" or across[1] > across[0]
        out[c["name"]] = Shown(*(("Z", "M") if vertical else ("Y", "N")), (c["units"][0], c["units"][1]))
    return out


def solver_name(version: str) -> str:
    """As people read it: ``OpenFOAM 1912 (patch=200626)``; keys of jobs keep the text of the solver."""
    return version.replace(", (", " (")


def duration(seconds: float) -> str:
    """``45 s``, ``12 min``, ``2.4 h``; a dash where it is not known."""
    if not math.isfinite(seconds):
        return ABSENT
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


def size(count: float, unit: str = "") -> str:
    """``608k``, ``1.46M``, ``1.6 G``; a dash for nothing."""
    if not count > 0.0:
        return ABSENT
    for factor, letter in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if count >= 0.9995 * factor:
            number = f"{count / factor:.3g}"
            return f"{number} {letter}{unit}" if unit else f"{number}{letter}"
    return f"{count:.3g}{f' {unit}' if unit else ''}"


def motion(condition: TowCondition, tank: Tank) -> str:
    """``v' 0.07``, ``r' 0.12 dr 5 deg``: what differs from straight ahead."""
    speed = condition.speed or 1.0
    parts = [f"{m}' {x / speed:.3g}" for m, x in zip(LINEAR[1:], condition.velocity[1:], strict=True) if abs(x) > 1e-9]
    scale = tank.scaling.length / speed
    parts += [f"{m}' {x * scale:.3g}" for m, x in zip(ANGULAR, condition.rates, strict=True) if abs(x) > 1e-12]
    parts += [f"{c} {np.degrees(a):.3g} deg" for c, a in condition.controls.items()]
    parts += [f"{k} {v}" for k, v in condition.variant.items()]
    return " ".join(parts) or "straight"


def planned(tank: Tank, jobs: Sequence[Job]) -> Table:
    """Every mesh and condition with what it is expected to take."""
    conditions = {c.name: c for c in tank.matrix}
    rows = []
    for job in jobs:
        c = conditions.get(job.name)
        what = ("", "", "") if c is None else (motion(c, tank), str(c.half) or "whole", c.grid)
        rows.append((
            shortened(job.name, NAME), shortened(what[0], MOTION), what[1], shortened(what[2], 8), size(job.cells),
            size(job.memory, "B"), duration(job.seconds) if job.seconds else ABSENT,
        ))  # fmt: skip
    have = {job.name for job in jobs}
    rows += [
        (shortened(c.name, NAME), shortened(motion(c, tank), MOTION), str(c.half) or "whole", c.grid, *(ABSENT,) * 3)
        for c in tank.matrix
        if c.name not in have
    ]
    heads = ("job", "motion", "half", "grid", "cells", "memory", "time")
    return Table("Conditions", heads, tuple(rows), (), frozenset({0, 1, 2, 3}))


def states(rows: Sequence[JobRow], shown: Mapping[str, Shown], most: int = 0) -> Table:
    """How far every mesh and run is, with its primed force and moment so far.

    Parameters
    ----------
    rows : sequence of JobRow
    shown : mapping of str to Shown
        By condition.
    most : int
        Rows, of those that matter most now; 0 for all.
    """
    chosen = list(rows)
    notes = []
    if most and len(chosen) > most:
        order = sorted(range(len(rows)), key=lambda i: FIRST.index(rows[i].progress.state))[:most]
        chosen = [rows[i] for i in sorted(order)]
        left = [rows[i].progress.state for i in range(len(rows)) if i not in order]
        notes = [f"Not shown: {listed([f'{left.count(s)} {s}' for s in dict.fromkeys(left)])}."]
    cells = [_state(row, shown.get(row.job.name)) for row in chosen]
    heads = ("job", "state", "iter.", "1e3 force'", "1e3 moment'", "left")
    return Table("Runs", heads, tuple(cells), (*notes, *reasons(chosen)), frozenset({0, 1}))


def _state(row: JobRow, shown: Shown | None) -> tuple[str, ...]:
    now = row.progress
    iteration = f"{now.iteration:.0f}" if math.isfinite(now.iteration) else ""
    values = ["", ""]
    if shown is not None:
        for i, (c, unit) in enumerate(zip((shown.force, shown.moment), shown.units, strict=True)):
            if c in now.means:
                error = 1e3 * now.errors.get(c, math.nan) / unit
                values[i] = f"{c} {_with_error(1e3 * now.means[c] / unit, error)}"
    runs = now.state in (JobState.RUNNING, JobState.WAITING, JobState.STOPPED, JobState.CHANGED)
    left = duration(row.left) if runs and row.left > 0.0 else ""
    return (shortened(row.job.name, NAME), str(now.state), iteration, *values, left)


def _with_error(value: float, error: float) -> str:
    """``-2.318+-0.012``: the error to two digits and at most four decimals, not below the last of these."""
    if not math.isfinite(error):
        return f"{value + 0.0:.3f}"
    error = max(error, LEAST)
    places = min(max(1 - math.floor(math.log10(error)), 0), 4)
    return f"{round(value, places) + 0.0:.{places}f}+-{error:.{places}f}"


def reasons(rows: Sequence[JobRow]) -> tuple[str, ...]:
    """What shows the state of every job that ended badly, whole, on as many lines as that takes."""
    bad = (JobState.CRASHED, JobState.DIVERGED, JobState.UNCONVERGED, JobState.STOPPED, JobState.CHANGED)
    phrases = (_whole(r.job.name, r.progress.why) for r in rows if r.progress.state in bad and r.progress.why)
    return tuple(line for lines in phrases for line in lines)


def _whole(name: str, why: str) -> list[str]:
    return textwrap.wrap(f"{name}: {why}", 77, subsequent_indent="  ", break_on_hyphens=False)


def counted(rows: Sequence[JobRow]) -> str:
    """``3 of 14 finished, 2 running, 1 crashed``; meshes do not count."""
    own = [r.progress.state for r in rows if not r.job.name.startswith("mesh/")]
    parts = [f"{own.count(JobState.FINISHED)} of {len(own)} finished"]
    parts += [f"{own.count(s)} {s}" for s in FIRST if s not in (JobState.FINISHED, JobState.WAITING) and s in own]
    return ", ".join(parts)


def six(tank: Tank, rows: Sequence[TowedRow], unfitted: str = "") -> Table:
    """The answer: six derivatives with U95, one without a value with its reason."""
    cells = []
    for r in rows:
        if r.coefficient is None:
            cells.append((primed(r.symbol), r.missing, "", "" if unfitted else shortened(r.why, LONGEST)))
            continue
        status = "" if r.coefficient.status is Status.OK else r.coefficient.status.replace("_", " ")
        is_open = r.value is not None and r.u95 is not None and abs(r.value) <= r.u95 and SIGN_OPEN not in status
        wide = "" if r.is_result else f"no result: U95 above {NO_RESULT:.0%}"
        phrases = "; ".join(filter(None, (status, SIGN_OPEN * is_open, wide, r.why)))
        cells.append((primed(r.symbol), *with_u95(r.value, r.u95), shortened(phrases, LONGEST)))
    about = ", ".join(f"{x:.4g}" for x in tank.reference_point)
    notes = [f"About ({about}) m from the {tank.datum.id}, primed by {tank.scaling}."]
    notes += [f"Not fitted: {unfitted}."] if unfitted else []
    return Table(shortened(tank.title, 79), ("", "value", "U95", ""), tuple(cells), tuple(notes), frozenset({0, 3}))


def water(tank: Tank, by_default: bool = False) -> str:
    """Speed, density and Reynolds number, and where they come from if nobody said them."""
    at = tank.conditions
    reynolds = at.reynolds_on(tank.scaling.length)
    number = "" if not reynolds else f", Re {reynolds:.1e}".replace("e+0", "e").replace("e+", "e")
    defaults = " (defaults; --matrix tank.toml changes them)" * by_default
    return f"{at.speed:.4g} m/s, {at.density:.5g} kg/m^3{number}{defaults}."


def is_estimated(rows: Sequence[TowedRow]) -> bool:
    """Whether all values are estimates from the shape: nothing was run."""
    known = [r.coefficient for r in rows if r.coefficient is not None]
    return bool(known) and all(c.origin == "estimate" for c in known)


def covers(rows: Sequence[TowedRow]) -> str:
    """What U95 is of, and what it leaves out; empty where no derivative has one."""
    if not any(r.u95 is not None for r in rows):
        return ""
    if is_estimated(rows):
        return "U95: 95 %, the scatter and the spread of the methods of estimates. No measurement and no CFD."
    phrases = "U95: 95 %, of the fit and the scatter of the runs about it."
    studied = [f"{primed(r.symbol)} {r.u_grid:.2g}" for r in rows if r.u_grid is not None]
    spread = [f"{primed(r.symbol)} {r.model:.2g}" for r in rows if r.model is not None]
    if studied:
        phrases += f" By the grid study, 95 %: {', '.join(studied)}."
    else:
        phrases += " The error of the grid is not in it: there is no grid study."
    if spread:
        return f"{phrases} Model error beside it, by another turbulence model: {', '.join(spread)}. Domain: see the report."
    return (
        f"{phrases} Domain and turbulence model: see the report."
        if studied
        else f"{phrases} Nor are those of domain and turbulence model."
    )


def symmetry_checks(study: Study | None) -> tuple[str, ...]:
    """What straight runs have of components that symmetry makes zero, a sentence each, of forces and moments in a plane.

    Parameters
    ----------
    study : Study or None
    """
    found = () if study is None else biases(study)
    out = []
    for f in found:
        text = words(f)
        if f["component"] in IN_A_PLANE:
            warned = f.severity is Severity.WARN
            out.append(f"{'Warning' if warned else 'Check'}: {text.statement}" + f" {text.advice}" * warned)
    return tuple(out)


def outcome(runs: Sequence[TowedRun], estimated: bool = False) -> str:
    """How many conditions converged, and what became of the others; of estimates, which never ran, how many there are."""
    if estimated:
        return f"{len(runs)} condition{'s' * (len(runs) != 1)} estimated, none run."
    bad = [r.status for r in runs if not r.counts]
    parts = [f"{len(runs) - len(bad)} of {len(runs)} conditions converged"]
    return ", ".join([*parts, *(f"{bad.count(s)} {s}" for s in dict.fromkeys(bad))]) + "."


def remarks(runs: Sequence[TowedRun]) -> dict[str, str]:
    """What is to be known of finished runs and their meshes: each remark once, with the conditions it is of."""
    out: dict[str, list[str]] = {}
    for r in runs:
        for remark in r.remarks:
            out.setdefault(remark, []).append(r.condition.name)
    return {remark: "all conditions" if len(names) == len(runs) > 1 else named(names) for remark, names in out.items()}


def ended(runs: Sequence[TowedRun]) -> Table:
    """The conditions that do not count, each with its reason."""
    rows, notes = [], []
    for r in runs:
        if not r.counts:
            why = r.why or (r.summary.why if r.summary is not None else "")
            fits = len(why) <= LONGEST_WHY
            rows.append((shortened(r.condition.name, NAME), r.status, why if fits else "see below"))
            notes += [] if fits else _whole(r.condition.name, why)
    heads = ("condition", "state", "why")
    return Table("Without a converged result", heads, tuple(rows), tuple(notes), frozenset({0, 1, 2}))

"""``coeflab tow``: from a shape to six derivatives, in a folder that a killed tow goes on in."""

from __future__ import annotations

import shlex
import sys
import tempfile
import textwrap
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import complete, options, show
from coeflab.core.errors import CoeflabError, InputError
from coeflab.core.files import located, shipped, typed
from coeflab.core.machine import cores as machine_cores
from coeflab.core.machine import physical_memory
from coeflab.core.wording import file_stem, finite
from coeflab.tank.folder import CAMPAIGN, PLAN, REPORT, TANK, has_begun, read_plan, refuse_other
from coeflab.tank.jobs import JobState
from coeflab.tank.states import JobRow, states_of, time_left

if TYPE_CHECKING:
    from coeflab.tank.collected import Collected
    from coeflab.tank.tow import Tow


EXAMPLE = "coeflab tow suboff_bare_hull --dry-run"


def solvers(incomplete: str) -> list[str]:
    """Solvers of the tow tank."""
    return complete.plugins("tow_solvers", incomplete)


def runners(incomplete: str) -> list[str]:
    """Runners of the tow tank."""
    return complete.plugins("tow_runners", incomplete)


RUNS = "runs"
REFRESH = 1.0  # s between two looks at the states
INTERRUPTED = 130  # exit code after Ctrl-C, as of every program
RESERVED = 12  # lines of a terminal that are not for rows


@options.worded
def command(
    *,
    body: str = "",
    matrix: Path | None = None,
    solver: str = "",
    out: Path | None = None,
    dry_run: bool = False,
    go_on: bool = False,
    finished: str = "",
    status: bool = False,
    collect: bool = False,
    runner: str = "",
    cores: int = 0,
    json: bool = False,
) -> None:
    """Tow a body through a virtual tank (CFD).

    Drift, attack and rotating arm; coefficients with uncertainty come out. Writes meshes, cases, runs, a campaign and a report into one folder. Ctrl-C and kill -9 lose nothing: --continue goes
    on. Exit code 1 when a condition did not converge.
    """
    modes = {"--dry-run": dry_run, "--continue": go_on, "--status": status, "--collect": collect}
    chosen = [name for name, on in modes.items() if on]
    if len(chosen) > 1:
        raise InputError(" and ".join(chosen), "one of them", column=chosen[1])
    out = None if out is None else typed(out)
    there = typed(body) if body else None
    if there is not None and out is None and (there / PLAN).is_file():
        out, body = there, ""
    elif there is not None and (there / TANK).is_file() and not (there / "body.toml").is_file():
        raise InputError("a tow that was stopped before its cases were written", "one with its cases", file=there,
                         advice=f"Lay it out again: coeflab tow BODY --matrix TANK --out {there}")  # fmt: skip
    matrix = None if matrix is None else typed(matrix)
    if status or collect:
        folder = _folder(out, body)
        _status(folder, json) if status else _collected_only(folder, json)
        return
    if not body and out is not None and (out / PLAN).is_file():
        if not go_on and not dry_run and has_begun(out):
            _refuse_begun(out)
        _tow("", matrix, solver, out, dry_run, runner, cores, json, finished=finished)
        return
    if not body and matrix is None:
        raise InputError("no body", "a body.toml, its folder or a shipped body; or the folder of a tow", column="BODY")
    _tow(body, matrix, solver, out, dry_run, runner, cores, json, go_on, finished)


def _folder(out: Path | None, body: str) -> Path:
    """The folder of a tow that is there."""
    folder = out if out is not None else Path(RUNS) / Path(body).name if body else Path()
    if not (folder / PLAN).is_file() and body and out is None and Path(body).is_dir():
        folder = Path(body)
    read_plan(folder)
    return folder


def _refuse_begun(folder: Path) -> None:
    raise InputError("a tow that has begun", "--continue to go on with it, or another --out", file=folder,
                     advice="What is finished and unchanged is kept.")  # fmt: skip


def _tow(
    body_name: str, matrix: Path | None, solver: str, out: Path | None, dry_run: bool, runner: str, cores: int, json: bool,
    go_on: bool = True, finished: str = "",
) -> None:  # fmt: skip
    """Lay out, and unless it is a dry run, carry out and collect."""
    import coeflab.tank.tow as tank_room

    body = located(body_name, "geometry") if body_name else None
    with show.progress(json) as say:
        say("reading the body")
        own = matrix
        if body is None and out is not None and (out / PLAN).is_file():
            tank, surface, own = tank_room.reopened(out, matrix, solver, runner)
        else:
            tank, surface = tank_room.read(body, matrix, solver, runner)
    folder = out if out is not None else Path(RUNS) / file_stem(tank.name)
    before: Mapping[str, Any] | None = None
    if (folder / PLAN).is_file():
        refuse_other(folder, tank, surface.body.name)
        before = read_plan(folder)
        if not go_on and not dry_run and has_begun(folder):
            _refuse_begun(folder)
    if finished:
        campaign = located(finished, "cfd_data")
        with show.progress(json) as say:
            say("comparing the cases")
            tank_room.require_finished(tank, surface, own, campaign)
    with _place(folder, dry_run and out is None) as place:
        with show.progress(json) as say:
            say("writing the cases")
            tow = tank_room.laid_out(tank, surface, place, own)
        if tow.restored:
            show.error(f"warning: edited by hand, and again as tank.toml has it: {', '.join(tow.restored)}")
        if finished:
            taken = tank_room.taken_over(tow, campaign)
            if not json:
                show.sentence(f"Taken over from {finished}: {len(taken)} of {len(tow.tank.matrix)} conditions.")
        if dry_run:
            asked = [*([body_name] if body_name else []), *(["--matrix", str(matrix)] if matrix else [])]
            asked += ["--solver", solver] if solver else []
            _dry(tow, before, asked, None if place != folder else folder, cores, json, by_default=own is None)
            return
    _carry_out(tow, before, folder, cores, json)


@contextmanager
def _place(folder: Path, temporary: bool) -> Iterator[Path]:
    if not temporary:
        yield folder
        return
    with tempfile.TemporaryDirectory(prefix="coeflab_tow_") as result:
        yield Path(result)


def _dry(
    tow: Tow, before: Mapping[str, Any] | None, asked: Sequence[str], folder: Path | None, cores: int, json: bool,
    by_default: bool = False,
) -> None:  # fmt: skip
    """What the tow is expected to take, and what to install."""
    from coeflab.tank import tables

    budget = cores or _cores(tow)
    rows = states_of(tow.folder) if tow.jobs else ()
    seconds = time_left(rows, budget) if rows else 0.0
    memory = max((j.memory for j in tow.jobs), default=0.0)
    missing = tow.installed.missing
    if json:
        show.json_object({
            "name": tow.tank.name, "solver": tow.tank.solver, "version": tow.installed.version, "missing": missing or None,
            "cores": budget, "seconds": seconds, "folder": None if folder is None else str(folder),
            "jobs": [
                {"name": j.name, "cells": j.cells or None, "memory": j.memory, "seconds": j.seconds, "cores": j.cores}
                for j in tow.jobs
            ],
            "conditions": [c.name for c in tow.tank.matrix], "by_symmetry": list(tow.tank.by_symmetry),
        })  # fmt: skip
        return
    meshes = sum(j.name.startswith("mesh/") for j in tow.jobs)
    runs = len(tow.tank.matrix)
    many = f"{runs} condition{'s' * (runs != 1)}" + (f" on {meshes} mesh{'es' * (meshes != 1)}" if meshes else "")
    head = f"{tow.tank.name}: {many} by {tables.solver_name(tow.installed.version or tow.tank.solver)}"
    if tow.jobs:
        together = _at_once(tow, budget)
        head += f", about {tables.duration(seconds)} on {budget} core{'s' * (budget != 1)}, up to {tables.size(together, 'B')}."
    else:
        head += "."
    show.sentence(head)
    show.sentence(tables.water(tow.tank, by_default))
    own = physical_memory()
    if own and memory > 0.9 * own:
        show.sentence(f"The largest job takes {tables.size(memory, 'B')} of this machine's {tables.size(own, 'B')}.")
    if missing:
        show.sentence(missing)
    if tow.tank.by_symmetry:
        show.text("By symmetry, not run:")
        for stated in tow.tank.by_symmetry:
            show.lines(textwrap.fill(stated, 79, initial_indent="  ", subsequent_indent="    "))
    show.text()
    show.table(tables.planned(tow.tank, tow.jobs))
    if before is not None:
        _fates(tow, before)
    if folder is None:
        show.sentence("Nothing was kept; add --out DIR to look at the cases.")
        show.command_line("Next", f"{shlex.join(['coeflab', 'tow', *asked])} --out {RUNS}/{tow.tank.name}")
    else:
        show.text(f"Cases in {folder}")
        begun = before is not None or has_begun(folder)
        show.command_line("Next", f"coeflab tow {shlex.quote(str(folder))}" + " --continue" * begun)


def _at_once(tow: Tow, budget: int) -> float:
    """Memory of the largest jobs that fit into the cores together."""
    total, free = 0.0, budget
    for job in sorted(tow.jobs, key=lambda j: -j.memory):
        if job.cores <= free or free == budget:
            total, free = total + job.memory, free - job.cores
    return total


def _fates(tow: Tow, before: Mapping[str, Any] | None) -> None:
    """What is kept, and what is run anew and why."""
    from coeflab.tank.tow import ANEW, BEGINS, reuse

    found = reuse(tow, before)
    same = [k for k in found if k.state.is_final]
    waiting = [k for k in found if k.state is JobState.WAITING]
    others = [k for k in found if k not in same and k not in waiting]
    anew = [k for k in others if k.what in (ANEW, BEGINS)]
    parts = (("go on", len(others) - len(anew)), ("run anew", len(anew)), ("to be run", len(waiting)))
    show.text("; ".join([f"Kept: {len(same)} of {len(found)}", *(f"{what}: {n}" for what, n in parts)]))
    for k in others:
        line = f"{k.name}: {k.what}" + (f", {k.why}" if k.why else "")
        show.lines(textwrap.fill(line, 79, initial_indent="  ", subsequent_indent="    ", break_long_words=False))
    dropped = [] if before is None else [n for n in before.get("jobs", {}) if n not in tow.of]
    if dropped:
        show.sentence(f"Not in the matrix any more, left on disk: {', '.join(dropped)}.")
    show.text()


def _carry_out(tow: Tow, before: Mapping[str, Any] | None, folder: Path, cores: int, json: bool) -> None:
    """Run what is not finished with a live table; then the answer. Ctrl-C leaves everything to go on from."""
    import coeflab.tank.tow as tank_room
    from coeflab.tank.collected import collected, filled

    if before is not None and not json and has_begun(tow.folder):
        _fates(tow, before)
    try:
        with _live(tow, json) as look:
            tank_room.carried_out(tow, cores, look)
    except KeyboardInterrupt:
        collected(tow, fitted=False)
        _stopped(tow, folder)
        raise typer.Exit(INTERRUPTED) from None
    show.step("fitting and drawing the report", json)
    result = collected(tow)
    if tow.solver.table is not None and not json and not filled(tow):
        show.sentence(f"{tow.tank.name}: {len(tow.tank.matrix)} conditions to be computed or measured outside coeflab.")
        show.text(f"Run list: {folder / tow.tank.solver / 'run_list.csv'}")
        show.text("Next:")
        show.sentence(f"  {_next(tow, result, folder)}")
        return
    _answer(tow, result, folder, json, begun=tow.solver.table is not None and not filled(tow))


def _stopped(tow: Tow, folder: Path) -> None:
    from coeflab.tank import tables

    show.text()
    show.sentence(f"Stopped: {tables.counted(states_of(tow.folder))}. Nothing is lost.")
    show.command_line("Next", f"coeflab tow {shlex.quote(str(folder))} --continue")


@contextmanager
def _live(tow: Tow, json: bool) -> Iterator[Any]:
    """A function that shows how far the runs are: a table on a terminal, elsewhere a line for each that ended.

    The campaign is written again whenever a run has ended, so that a kill leaves what was finished as a table.
    """
    from coeflab.tank import tables
    from coeflab.tank.collected import collected

    shown = tables.shown_of(read_plan(tow.folder))
    words: dict[str, str] = {row.job.name: str(row.progress.state) for row in states_of(tow.folder)} if tow.jobs else {}
    trouble: list[str] = []
    last = [-REFRESH]
    on_terminal = sys.stdout.isatty() and not json

    def rows_now() -> tuple[JobRow, ...]:
        rows = states_of(tow.folder)
        fresh = [r for r in rows if words.get(r.job.name) != str(r.progress.state)]
        for r in fresh:
            words[r.job.name] = str(r.progress.state)
        over = [r for r in fresh if r.progress.state.is_final or r.progress.why]
        if any(not r.job.name.startswith("mesh/") for r in over):
            try:
                collected(tow, fitted=False)
            except CoeflabError as why:  # it is tried again with the next run, and at the end
                trouble[:] = [str(why)]
        if not on_terminal and not json:
            for r in over:
                show.lines(_ended(r, shown, rows))
        return rows

    if not on_terminal:

        def look() -> None:
            if time.monotonic() - last[0] >= REFRESH:
                last[0] = time.monotonic()
                rows_now()

        yield look
    else:
        import shutil

        from rich.console import Console
        from rich.live import Live
        from rich.text import Text

        from coeflab.report.printable import visible

        with Live(console=Console(), auto_refresh=False, transient=True) as live:

            def draw() -> None:
                if time.monotonic() - last[0] < REFRESH:
                    return
                last[0] = time.monotonic()
                rows = rows_now()
                most = max(shutil.get_terminal_size().lines - RESERVED, 5)
                head = f"{tow.tank.name}: {tables.counted(rows)}, {_left(time_left(rows, _cores(tow)))}"
                lines = [head, *show.plain_lines(tables.states(rows, shown, most))[1:], *trouble]
                live.update(Text("\n".join(visible(line) for line in lines), no_wrap=True), refresh=True)

            yield draw
    if tow.jobs:
        rows_now()
    for line in trouble:
        show.error(f"error: {line}")


def _cores(tow: Tow) -> int:
    return int(tow.tank.runner_options.get("cores", 0)) or machine_cores()


def _left(seconds: float) -> str:
    from coeflab.tank import tables

    return f"about {tables.duration(seconds)} left" if seconds > 0.0 else "nothing left to run"


def _ended(row: JobRow, shown: Mapping[str, Any], rows: Sequence[JobRow]) -> str:
    """One line of a run that ended."""
    from coeflab.tank import tables

    cells = tables.states((row,), shown).rows[0]
    values = "".join(f", 1e3 {v}" for v in cells[3:5] if v)
    at = f" at {cells[2]}" if cells[2] else ""
    words = f"{row.job.name}: {cells[1]}{at}{values} ({tables.counted(rows).partition(' finished')[0]})"
    return "\n".join(
        [
            *textwrap.wrap(words, 79, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False),
            *(textwrap.wrap(row.progress.why, 75, initial_indent="  ", subsequent_indent="  ", break_long_words=False)),
        ]
    )


def _status(folder: Path, json: bool) -> None:
    """The states of a tow that another process may carry out."""
    from coeflab.tank import tables

    plan = read_plan(folder)
    if not plan["jobs"]:
        from coeflab.tank.collected import filled
        from coeflab.tank.tow import opened

        tow = opened(folder)
        done, many = filled(tow), len(tow.tank.matrix)
        if json:
            show.json_object({"name": plan["name"], "solver": plan["solver"], "filled": done, "conditions": many})
            return
        where = tow.tank.options.get("table") or folder / tow.tank.solver / "forces.csv"
        show.sentence(f"{plan['name']}: {plan['solver']} needs no runs; {done} of {many} rows of {where} are filled.")
        show.sentence(f"Next: coeflab tow {shlex.quote(str(folder))} --collect")
        return
    rows = states_of(folder)

    seconds = time_left(rows, machine_cores())
    if json:
        show.json_object({"name": plan["name"], "solver": plan["solver"], "seconds_left": finite(seconds),
                          "jobs": [_row(r) for r in rows]})  # fmt: skip
        return
    show.sentence(
        f"{plan['name']} by {tables.solver_name(plan['version'] or plan['solver'])}: {tables.counted(rows)}; {_left(seconds)}."
    )
    show.table(tables.states(rows, tables.shown_of(plan)))


def _row(row: JobRow) -> dict[str, Any]:
    now = row.progress
    return {
        "name": row.job.name, "state": str(now.state), "iteration": finite(now.iteration), "seconds": now.seconds,
        "seconds_left": finite(row.left), "memory": now.memory, "resumed_from": finite(now.resumed_from),
        "means": {k: finite(v) for k, v in now.means.items()}, "errors": {k: finite(v) for k, v in now.errors.items()},
        "why": now.why or None, "remarks": list(now.remarks),
    }  # fmt: skip


def _collected_only(folder: Path, json: bool) -> None:
    from coeflab.tank.collected import collected
    from coeflab.tank.tow import opened

    with show.progress(json) as say:
        say("reading the tow")
        tow = opened(folder)
    show.step("fitting and drawing the report", json)
    _answer(tow, collected(tow), folder, json)


def _answer(tow: Tow, result: Collected, folder: Path, json: bool, begun: bool = False) -> None:
    """The six derivatives first, then the conditions, the files and the next command; exit code 1 where one did not converge."""
    from coeflab.tank import tables

    if json:
        show.json_object(_as_json(tow, result))
    else:
        show.table(tables.six(tow.tank, result.six, result.unfitted))
        estimated = tables.is_estimated(result.six)
        checks = () if estimated else tables.symmetry_checks(result.study)
        for words in (tables.covers(result.six), *checks):
            show.sentence(words)
        show.sentence(tables.outcome(result.runs, estimated))
        for remark, names in tables.remarks(result.runs).items():
            show.sentence(f"  {remark} ({names})")
        show.table(tables.ended(result.runs))
        if result.files:
            show.text(f"Campaign: {folder / CAMPAIGN}")
        for page in (p for p in result.files if p.suffix == ".html"):
            show.text(f"Report:   {folder / REPORT / page.name}")
        show.sentence(f"Next: {_next(tow, result, folder)}")
    if not begun and not all(r.counts for r in result.runs):
        raise typer.Exit(1)


def _as_json(tow: Tow, result: Collected) -> dict[str, Any]:
    six = {}
    for r in result.six:
        status = r.missing if r.coefficient is None else str(r.coefficient.status)
        six[f"{r.symbol}'"] = {"value": r.value, "u95": r.u95, "status": status, "why": r.why or None}
    return {
        "name": tow.tank.name, "solver": tow.tank.solver, "version": tow.installed.version, "six": six,
        "conditions": [{"name": r.condition.name, "state": r.status, "why": r.why or None} for r in result.runs],
        "unfitted": result.unfitted or None, "files": [str(p) for p in result.files],
    }  # fmt: skip


def _next(tow: Tow, result: Collected, folder: Path) -> str:
    """What to type, or to mend first."""
    from coeflab.tank.tables import is_estimated

    place = shlex.quote(str(folder))
    states = {r.state for r in result.runs if not r.counts}
    if tow.solver.table is not None and states:
        where = tow.tank.options.get("table") or folder / tow.tank.solver / "forces.csv"
        return f"fill in {where}, then coeflab tow {place} --collect"
    if states - {JobState.UNCONVERGED, JobState.DIVERGED, JobState.FINISHED}:
        return f"coeflab tow {place} --continue"
    if JobState.UNCONVERGED in states:
        return f"allow more iterations in {folder / TANK}, then coeflab tow {place} --continue"
    if is_estimated(result.six):
        body = tow.tank.body.parent
        named = body.name if body.parent == shipped("geometry") else str(tow.tank.body)
        return (
            f"coeflab vehicle {shlex.quote(named)} adds mass and added mass; coeflab tow without --solver runs OpenFOAM"
        )
    return f"coeflab next {place}/{CAMPAIGN}"

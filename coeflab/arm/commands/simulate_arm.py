"""What ``coeflab simulate`` does with a vehicle with an arm."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import typer

from coeflab.cli import show
from coeflab.core.texts import input_error

TAKEN = {"file", "manoeuvre", "current", "record", "to", "out", "json"}


def explain_options() -> None:
    """Manoeuvres of an arm and their options, those of its motion, and the keys of its phases."""
    from coeflab.arm.arm_keys import ArmPhaseKeys, ControllerKeys, StartKeys
    from coeflab.arm.manoeuvres import MANOEUVRES
    from coeflab.cli.formats import explain
    from coeflab.core.declarations import meanings, taken
    from coeflab.core.options import described
    from coeflab.core.table import Table

    named = tuple((f"--manoeuvre {name}", one.summary) for name, one in MANOEUVRES.items())
    notes = ("Without --manoeuvre: phases.",)
    show.table(
        Table("Manoeuvres of a vehicle with an arm", ("option", "what it does"), named, notes, frozenset({0, 1}))
    )
    for name, one in MANOEUVRES.items():
        own = tuple((o.name, o.takes, o.default, o.meaning) for o in described(one.options))
        if own:
            heads = ("option", "takes", "default", "meaning")
            show.table(Table(f"Options of {name}", heads, own, (), frozenset({0, 1, 2, 3})))
    explain("simulators", "arm")
    rows = [
        (f"{table}{key}", takes.words, meanings(kind)[key])
        for table, kind in (("[[phase]] ", ArmPhaseKeys), ("[start] ", StartKeys), ("[controller] ", ControllerKeys))
        for key, takes in taken(kind).items()
    ]
    notes = ("All keys of a body.toml of an arm: docs/files.md; a whole one: geometry/urv_puma.",)
    show.table(Table("Motion in the body.toml", ("key", "takes", "meaning"), tuple(rows), notes, frozenset({0, 1, 2})))


def place(file: Path) -> Path | None:
    """The body.toml of a vehicle with an arm that a person means, by path or shipped name; None for anything else."""
    from coeflab.arm.arm_file import is_arm
    from coeflab.core.files import shipped, typed

    path = typed(file)
    for one in (path, shipped("geometry") / path.name if len(path.parts) == 1 else path):
        if is_arm(one):
            return one
    return None


def simulate(
    body: Path, asked: Mapping[str, Any], options: Mapping[str, Any], to: str, out: Path | None, json: bool
) -> None:
    """A motion of a vehicle with an arm.

    Parameters
    ----------
    body : Path
        As `place` has it.
    asked : mapping of str to value
        Options of the command that were typed.
    options : mapping of str to value
        Further ones, of the manoeuvre and of its motion.
    to : str
        Format of the motion: csv or parquet.
    out : Path, optional
        Folder for motion and pictures; without it nothing is written.
    json : bool
        Whether one JSON object is printed.

    Raises
    ------
    InputError
        An option of other vehicles; or what the file and the manoeuvre do not take.
    Exit
        The motion ended early: code 1.
    """
    from coeflab.arm.simulated import moved_by, pictures
    from coeflab.arm.tables import arm_phases
    from coeflab.core.files import write_all
    from coeflab.report.tables.motion import columns, motion_csv, motion_parquet

    if strange := sorted(set(asked) - TAKEN):
        raise input_error("arm.vehicle_arm", column=f"--{strange[0]}", strange=strange[0])
    record = {"record": asked["record"]} if "record" in asked else {}
    chain, manoeuvre, moved = moved_by(body, asked.get("manoeuvre", "phases"), {**record, **options})
    table = motion_csv(moved) if to == "csv" else motion_parquet(moved)
    content = {} if out is None else {f"{manoeuvre.name}.{to}": table, **pictures(body, chain, manoeuvre.name, moved)}
    write_all(Path(out or ""), content)
    files = [str(Path(out or "") / name) for name in content]
    if json:
        last = {name: float(values[-1]) for name, values in columns(moved).items()}
        words = {"name": chain.name, "phases": list(moved.phases), "ended": moved.ended.value, "why": moved.why}
        show.json_object({**words, "last": last, "statements": list(moved.statements), "files": files})
    else:
        show.table(arm_phases(moved, chain.name))
        for line in moved.statements:
            show.text(f"  {line}")
        if moved.why:
            show.text(f"  {moved.ended.value}: {moved.why}")
        for path in files:
            show.path(path)
    if moved.ended.value != "complete":
        raise typer.Exit(1)

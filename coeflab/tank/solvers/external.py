"""Any solver outside coeflab, or a towing tank: a list of the runs, an empty table beside it, and the filled table read back.

``external/run_list.csv`` says every motion in SI, FRD, at the reference point; ``external/forces.csv`` has a line for each, with
blank cells. What is filled in is the fluid's force on the whole body; what stays blank was not run.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np

from coeflab.core import declarations as takes
from coeflab.core.declarations import Declaration
from coeflab.core.errors import InputError, UnitsError, shown, together
from coeflab.core.files import write_atomically
from coeflab.core.limits import JSON_BYTES
from coeflab.core.text.bounded import whole_bytes
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.text.delimited import Cells, read_cells, require_unit
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.units import Header, factor
from coeflab.law.symbols import ANGULAR, COMPONENTS, LINEAR, MOMENTS
from coeflab.tables.campaign import CUTS, PORT_STARBOARD, UP_DOWN
from coeflab.tables.raw_table import RawColumn, RawTable, Stated
from coeflab.tank.jobs import Job
from coeflab.tank.solvers import Installation
from coeflab.tank.tank import Tank
from coeflab.tank.test_matrix import Half
from coeflab.tank.towed_body import TowedBody

summary = "any solver or tank outside coeflab: a list of runs, an empty table to fill in, and that table read back"
citations = ()

FOLDER, LIST, FORCES = "external", "run_list.csv", "forces.csv"
CONDITION, COUNTS = "condition", ("cells", "iterations")
CANCELLED = {Half.UPPER: CUTS[UP_DOWN].cancelled, Half.PORT: CUTS[PORT_STARBOARD].cancelled}
BY_SYMMETRY = {Half.WHOLE: "", **{h: " ".join(c) for h, c in CANCELLED.items()}}  # zero, and not to be filled in


@dataclass(frozen=True, slots=True, kw_only=True)
class External(Declaration):
    """``[solver.external]``: forces that come from elsewhere.

    Attributes
    ----------
    table : Path
        The filled table, from the folder of tank.toml; external/forces.csv of the tow unless given.
    made_by : str
        Name and version of what computed or measured the forces, for the record.
    """

    table: Annotated[Path | None, takes.Takes("a path", lambda v, file: file.parent / takes.text_of(v, file),
                                              {"type": "string", "minLength": 1})] = None  # fmt: skip
    made_by: takes.Words = ""


options = External
paths = {"table": "cfd_data"}


def installed() -> Installation:
    """Nothing is needed here."""
    return Installation("an outside solver")


def jobs(tank: Tank, body: TowedBody, folder: Path) -> tuple[Job, ...]:  # noqa: ARG001 - as the port has it
    """Write the list of runs and the empty table; no jobs.

    A table with numbers in it is kept, and gets lines for the conditions that are new.

    Parameters
    ----------
    tank : Tank
    body : TowedBody
    folder : Path
        Of the tow.

    Raises
    ------
    InputError
        A table that cannot be read.
    OutputError
        The folder cannot be written.
    """
    place = folder / FOLDER
    write_atomically(place / LIST, _run_list(tank))
    write_atomically(place / FORCES, _lines(tank, place / FORCES))
    return ()


def table(tank: Tank, body: TowedBody, folder: Path | None = None) -> RawTable:  # noqa: ARG001 - as the port has it
    """The filled table, in SI and in the order of its lines.

    Parameters
    ----------
    tank : Tank
    body : TowedBody
    folder : Path, optional
        Of the tow; not needed where ``[solver.external]`` names a table.

    Raises
    ------
    InputError
        No table, a line of no condition or a second one, or a cell that is no number.
    """
    path = tank.options.get("table") or (folder / FOLDER / FORCES if folder is not None else None)
    if path is None:
        advice = f"Add [solver.external] with table, the path of the filled {FORCES}."
        raise InputError("no table of forces", "the path of one", column="solver.external.table", advice=advice)
    cells = read_cells(path)
    columns: list[RawColumn] = []
    complaints: list[InputError] = []
    names: tuple[str, ...] = ()
    try:
        names = _names(cells, {c.name for c in tank.matrix})
    except InputError as why:
        complaints += [why, *why.others]
    for header in cells.headers:
        if header.name == CONDITION:
            continue
        try:
            columns.append(_column(cells, header))
        except InputError as why:
            complaints += [why, *why.others]
    if complaints:
        raise together(sorted(complaints, key=lambda c: c.line or 0))
    result = tank.options.get("made_by") or "an outside solver"
    return RawTable(
        path=path,
        columns=tuple(columns),
        header_line=cells.first_line - 1,
        lines=np.arange(len(cells), dtype=np.int64) + cells.first_line,
        row_labels=names,
        files=(path,),
        stated={"source.how_obtained": Stated(str(result), f"{path.name}")},
    )


def _names(cells: Cells, known: set[str]) -> tuple[str, ...]:
    """The condition of every line.

    Raises
    ------
    InputError
        Of every wrong line.
    """
    line = cells.first_line - 1
    if CONDITION not in [h.name for h in cells.headers]:
        raise InputError("no column of conditions", f"a column {CONDITION}", file=cells.file, line=line)
    names = cells.texts(CONDITION)
    complaints = []
    for row, name in enumerate(names):
        at = {"file": cells.file, "line": cells.line(row), "column": CONDITION}
        if name not in known:
            found = InputError(shown(name), f"a condition of {LIST}", **at)  # type: ignore[arg-type]
            complaints.append(found)
        elif name in names[:row]:
            complaints.append(InputError(f"{shown(name)} twice", "every condition once", **at))  # type: ignore[arg-type]
    if complaints:
        raise together(complaints)
    return tuple(names)


def _column(cells: Cells, header: Header) -> RawColumn:
    """One column in SI."""
    name, line = header.name, cells.first_line - 1
    bare = name.removeprefix("se_")
    if name in COUNTS:
        values, unit = cells.numbers(name), "-"
    elif bare in COMPONENTS:
        dimension, unit = ("moment", "N*m") if bare in MOMENTS else ("force", "N")
        try:
            values = cells.numbers(name) * factor(require_unit(header, cells.file, line, f"{name} [{unit}]"), dimension)
        except UnitsError as why:
            raise why.at(cells.file, line, header.text) from None
    else:
        known = f"{CONDITION}, {', '.join(COMPONENTS)}, se_ before one of these, {', '.join(COUNTS)}"
        raise input_error("tow.unknown_column", cells.file, line, header.text, text=shown(header.text), expected=known)
    if name != bare or name in COUNTS:
        _require_positive(cells, header, values)
    return RawColumn(name, unit, values, means=name)


def _require_positive(cells: Cells, header: Header, values: Array) -> None:
    texts = cells.texts(header.name)
    wrong = [
        InputError(shown(texts[row]), "a number above zero, or a blank cell", file=cells.file, line=cells.line(row),
                   column=header.text)
        for row in np.flatnonzero(values <= 0.0).tolist()
    ]  # fmt: skip
    if wrong:
        raise together(wrong)


def _run_list(tank: Tank) -> bytes:
    """Every condition in SI, all digits."""
    at, point = tank.conditions, ", ".join(f"{x:.6g}" for x in tank.reference_point)
    viscosity = "" if at.viscosity is None else f", kinematic viscosity {at.viscosity:g} m^2/s"
    comments = (
        f"Runs of {tank.name}. Density {at.density:g} kg/m^3{viscosity}; the body is in body/body.stl.",
        "Velocities and rates of the body at the reference point, FRD (x forward, y starboard, z down),",
        f"at ({point}) m from the {tank.datum.id}. Half: what the domain may be cut to, at a symmetry plane.",
    )
    controls = list(dict.fromkeys(name for c in tank.matrix for name in c.controls))
    studied = list(dict.fromkeys(name for c in tank.matrix for name in c.variant))
    heads = [CONDITION, "kind", "half", "grid", "cell size", *studied]
    heads += [f"{m} [m/s]" for m in LINEAR] + [f"{m} [rad/s]" for m in ANGULAR] + [f"{c} [rad]" for c in controls]
    rows = [[*heads, "zero by symmetry"]]
    for c in tank.matrix:
        numbers = (*c.velocity, *c.rates, *(c.controls.get(name, 0.0) for name in controls))
        row = [c.name, str(c.kind), str(c.half) or "whole", c.grid, f"{tank.grid(c.grid).size:.6g}"]
        row += [c.variant.get(name, "") for name in studied]
        rows.append([*row, *(f"{x + 0.0:.12g}" for x in numbers), BY_SYMMETRY[c.half]])
    return csv_text(rows, comments).encode()


def _lines(tank: Tank, path: Path) -> bytes:
    """The empty table, or the one that is there with lines for the conditions that it lacks."""
    names = [c.name for c in tank.matrix]
    if path.is_file():
        cells = read_cells(path)
        position = (
            [h.name for h in cells.headers].index(CONDITION) if CONDITION in [h.name for h in cells.headers] else None
        )
        filled = position is None or any(text for row in cells.rows for i, text in enumerate(row) if i != position)
        if filled:
            there = set() if position is None else set(cells.texts(CONDITION))
            content = whole_bytes(path, JSON_BYTES)
            new = [name for name in names if name not in there] if position is not None else []
            blank = [[name if i == position else "" for i in range(len(cells.headers))] for name in new]
            ended = content if content.endswith(b"\n") or not new else content + b"\n"
            return ended + csv_text(blank).encode()
    units = {c: "N*m" if c in MOMENTS else "N" for c in COMPONENTS}
    heads = [
        CONDITION,
        *(f"{c} [{u}]" for c, u in units.items()),
        *(f"se_{c} [{u}]" for c, u in units.items()),
        *COUNTS,
    ]
    comments = (
        "The fluid's force on the whole body (of a half: doubled), FRD, about the reference point, without the body's inertia.",
        "se_: standard error of the mean. What stays blank was not run, or is zero by symmetry.",
    )
    return csv_text([heads, *([name, *[""] * (len(heads) - 1)] for name in names)], comments).encode()

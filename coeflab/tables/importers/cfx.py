"""Monitor data of Ansys CFX as ``cfx5mondata -out FILE.csv`` writes it.

The first column is ACCUMULATED TIMESTEP, the others are ``USER POINT,NAME`` for monitors of an expression and other
categories (``FORCE,...``, ``IMBALANCE,...``) in the same form. The file states neither units nor directions: what a column
means has to be said by a person.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from coeflab.core.options import NoOptions, parse_options
from coeflab.core.texts import input_error
from coeflab.tables.half_bodies import planes_in_files
from coeflab.tables.monitor_files import decoded, files_of, first_filled, head, kind_of, lines_of, require
from coeflab.tables.monitors import how_ended, in_order, laid_out, raw_table, read_monitor
from coeflab.tables.raw_table import Run

summary = "monitor data of Ansys CFX by cfx5mondata (CSV)"
computed = True
reads = "monitor CSV of CFX (cfx5mondata)"
citations = ("Ansys Inc. (2024): Ansys CFX-Solver Manager User's Guide, Release 2024 R2: cfx5mondata.",)

_POINT = "USER POINT,"


# Setups in CFX's command language stand in .ccl files and at the head of every .out file.
_TEXTS = (".ccl", ".out", ".txt", ".log", ".pre", ".cse", ".dat")
_SYMMETRY = re.compile(r"(?i)^[\s|>&]*Boundary Type\s*=\s*SYMMETRY\b")
_BOUNDARY = re.compile(r"(?i)^[\s|>&]*(?:replace\s+)?BOUNDARY\s*:\s*(.+)")


def wrote(lines: Sequence[str]) -> bool:
    """Whether the first column is ACCUMULATED TIMESTEP."""
    return any(line.startswith('"ACCUMULATED TIMESTEP",') for _, line in first_filled(lines, 1))


def recognises(path: Path) -> bool:
    """Whether a file is written by cfx5mondata, or a folder holds one such file and no other monitors."""
    if path.is_dir():
        return len(files_of(path, "cfx")) == 1
    return path.is_file() and kind_of(head(path)) == "cfx"


def run(path: Path, options: Mapping[str, Any] | None = None) -> Run:
    """Read the monitors of a run.

    Parameters
    ----------
    path : Path
        The CSV file, or the folder that holds it.
    options : mapping, optional
        None are known.

    Returns
    -------
    Run
        Columns by their names, without unit and meaning but for the time step; no conditions.

    Raises
    ------
    InputError
        Another content, several files in a folder, broken lines, or another header amid the rows.
    """
    parse_options(NoOptions, options or {}, "importers.cfx")
    file = path
    if path.is_dir():
        found = files_of(path, "cfx")
        if len(found) != 1:
            raise input_error("tables.several_monitor_files", path, count=len(found))
        file = found[0]
    raw = head(file)
    if not raw.strip() and file.is_file():
        return Run.empty(path, f"{file.name}: empty", [file])
    require(raw, file, "cfx", 'a file of cfx5mondata ("ACCUMULATED TIMESTEP", ...)')
    lines = lines_of(decoded(raw)[0])
    ((at, first),) = first_filled(lines, 1)
    # Names hold quotation marks and commas of their own: "USER POINT,P1,D1,"x= 4.65E-02,y= 0.",Temperature".
    names = [" ".join(name.split()) for name in first.removeprefix('"').removesuffix('"').split('","')]
    names = [n if names.index(n) == i else f"{n} ({names[:i].count(n) + 1})" for i, n in enumerate(names)]
    monitor = in_order(read_monitor(file, laid_out(raw, file, at, names, ",", at)), 0)
    ended, why = how_ended(monitor, range(len(names))[1:])
    columns = [(j, name.removeprefix(_POINT), "", "" if j else "iteration") for j, name in enumerate(names)]
    dialect = {"format": "CFX monitor data", "delimiter": "comma", "decimal mark": "point"}
    remarks = (f"{file.name}: monitor data state no directions and no units",)
    stated, texts = planes_in_files(path, _TEXTS, _SYMMETRY, _BOUNDARY)
    table = raw_table(monitor, path, columns, (file, *texts), dialect, stated, remarks)
    return Run(path, path.stem, table, ended=ended, why=why)

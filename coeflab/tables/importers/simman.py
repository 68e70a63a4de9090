"""Static captive tests of the SIMMAN workshops: one row of means a condition, in the axes and units that they ask for.

Oscillating tests in the same columns are files of a list of runs, which the importer pmm reads.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from coeflab.core.options import NoOptions, parse_options
from coeflab.core.texts import input_error
from coeflab.tables.monitors import raw_table
from coeflab.tables.raw_table import RawTable, Stated
from coeflab.tables.simman_files import STATED, captive_test, is_captive_test, is_record, line_of_names

summary = "static captive tests in the columns that the SIMMAN workshops ask for"
reads = "captive tests of SIMMAN (X Y N, u v r, udot vdot rdot)"
citations = (
    "SIMMAN (2014): Workshop on Verification and Validation of Ship Manoeuvring Simulation Methods, Instructions: Format of "
    "Model Test Results; Coordinate Systems. simman2014.dk.",
)

DELIMITERS = {",": "comma", ";": "semicolon", "\t": "tab", " ": "blanks"}
MEANT = ("X", "Y", "N", "u", "v", "r")


def wrote(lines: Sequence[str]) -> bool:
    """Whether a line names forces X Y N, velocities u v r and accelerations udot vdot rdot."""
    return line_of_names(lines) > 0


recognises = is_captive_test


def raw(path: Path, options: Mapping[str, Any] | None = None) -> RawTable:
    """Read a table of static tests.

    Parameters
    ----------
    path : Path
    options : mapping, optional
        None are known.

    Returns
    -------
    RawTable
        Forces and velocities mean what their names say; position, heading, time and accelerations are left alone. The axes are
        stated; the reference point and whether the forces contain inertia are not.

    Raises
    ------
    InputError
        Another content, broken lines, or the time series of an oscillating test.
    """
    parse_options(NoOptions, options or {}, "importers.simman")
    monitor, units, delimiter = captive_test(path)
    if not len(monitor):
        raise input_error("tables.no_whole_rows", path, monitor.header_line)
    if is_record(dict(zip(monitor.names, monitor.columns, strict=True))):
        raise input_error("tables.record_of_oscillating_test", path, monitor.header_line)
    columns = [
        (j, name, unit, name if name in MEANT else "ignore")
        for j, (name, unit) in enumerate(zip(monitor.names, units, strict=True))
    ]
    return raw_table(
        monitor, path, columns, (path,),
        {"format": "SIMMAN captive test", "delimiter": DELIMITERS[delimiter], "units": "as written, else SI"},
        {"axes.frame": Stated("FRD", "SIMMAN 2014, Coordinate Systems", convention=True)},
        (f"{path.name}: model scale and SI units, as {STATED} asks",),
    )  # fmt: skip

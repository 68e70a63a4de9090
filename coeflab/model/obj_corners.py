"""Faces of an OBJ whose corners do not exist, by line."""

from __future__ import annotations

import re
from pathlib import Path

from coeflab.core.errors import InputError, shown

WHOLE = re.compile(rb"-?\d+")


def require_corners(path: Path) -> None:
    """Hold every corner of every face of an OBJ against its vertices; for a file that could not be read.

    Corners count from 1, or back from the vertex above them with a minus; ``7/1/3`` names texture and normal too, which
    do not matter here.

    Raises
    ------
    InputError
        By file and line: a corner that is no whole number, that is zero, or whose vertex does not exist.
    """
    lines = path.read_bytes().splitlines()
    total = sum(line.split(maxsplit=1)[:1] == [b"v"] for line in lines)
    above = 0
    for number, line in enumerate(lines, 1):
        key, *corners = line.split() or [b""]
        above += key == b"v"
        for corner in corners if key == b"f" else ():
            index = corner.partition(b"/")[0]
            at = int(index) if WHOLE.fullmatch(index) and len(index) < 20 else 0
            if not (1 <= at <= total or -above <= at <= -1):
                raise InputError(
                    f"a face with the corner {shown(corner.decode('latin-1'))}",
                    f"numbers from 1 to {total}, of the vertices in the file",
                    file=path,
                    line=number,
                    advice="Export it again.",
                )

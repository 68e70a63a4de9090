"""What a campaign declares beyond its forces: cells of the grids and uncertainty of the inputs, put on its tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from coeflab.core.delimited import read_cells
from coeflab.core.errors import InputError
from coeflab.model.campaign import Campaign
from coeflab.model.force_table import ForceTable
from coeflab.model.input_uncertainty import InputUncertainty


def with_declarations(
    table: ForceTable, file: Path, cells: str = "", uncertainty: InputUncertainty | None = None
) -> ForceTable:
    """A table with its cell counts and input uncertainty.

    Parameters
    ----------
    table : ForceTable
        As its importer read it, row for row.
    file : Path
        The table's own file.
    cells : str
        Column of the cell counts, or empty.
    uncertainty : InputUncertainty, optional

    Raises
    ------
    InputError
        No such column, or a count that is not above zero.
    """
    if not cells:
        return replace(table, uncertainty=uncertainty)
    read = read_cells(file)
    if cells not in [h.name for h in read.headers]:
        raise InputError(
            f"no column {cells}", "the column of cell counts that [[table]] cells names", file=file,
            line=read.first_line - 1, column=cells,
        )  # fmt: skip
    counts = read.numbers(cells)
    bad = np.flatnonzero(counts <= 0.0)
    if bad.size:
        raise InputError(
            f"{counts[bad[0]]:g} cells", "a count above zero", file=file, line=read.line(int(bad[0])), column=cells
        )
    return replace(table, cells=counts, uncertainty=uncertainty)


def declared(tables: Sequence[ForceTable], campaign: Campaign) -> tuple[ForceTable, ...]:
    """The tables of a campaign with what its campaign.toml declares about them."""
    columns = {f"{campaign.name}/{t.file}": t for t in campaign.tables}
    out = []
    for table in tables:
        t = columns[table.name]
        out.append(with_declarations(table, campaign.path.parent / t.file, t.cells, campaign.uncertainty))
    return tuple(out)

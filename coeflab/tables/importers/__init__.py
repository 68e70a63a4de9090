"""Readers of force tables: one plugin a file, what a plugin is, and tables by the campaign that a person names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.registry import Plugin, Registry
from coeflab.core.text.delimited import read_cells
from coeflab.core.types import brief
from coeflab.tables.campaign import FILE, Campaign, InputUncertainty, read_campaign
from coeflab.tables.force_table import ForceTable


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


@runtime_checkable
class Importer(Plugin, Protocol):
    """Reads the tables of a campaign into SI and FRD."""

    def recognises(self, path: Path) -> bool:
        """Whether the file or folder is one that it reads, by its content; at most one importer knows a path.

        Parameters
        ----------
        path : Path
        """
        ...

    def read(
        self, campaign: Campaign, only: str | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[ForceTable, ...]:
        """Tables in SI and FRD.

        Parameters
        ----------
        campaign : Campaign
        only : str, optional
            File name of the one table that is wanted.
        options : mapping, optional
            Of the plugin's `Options`.
        """
        ...


IMPORTERS = Registry("coeflab.importers", "importer", Importer, __name__)  # type: ignore[type-abstract]


def read_tables(planned: PlannedTable) -> tuple[ForceTable, ...]:
    """The tables of a planned campaign: a folder, its campaign.toml, or one CSV beside it."""
    path = planned.campaign
    declaration = path / FILE if path.is_dir() else path if path.suffix == ".toml" else path.parent / FILE
    if not declaration.exists():
        raise InputError(
            f"no {FILE} in {declaration.parent}",
            f"a {FILE} that declares axes, angle sign, reference point and scaling",
            file=path,
            advice="`coeflab new DIR` writes a commented one.",
        )
    campaign = read_campaign(declaration)
    with IMPORTERS.guarded(campaign.importer):
        read = IMPORTERS.load(campaign.importer).read(campaign, planned.only)
    return declared(read, campaign)


@brief
@dataclass(frozen=True, slots=True)
class PlannedTable:
    """One ``[[table]]``: a campaign (a folder, a campaign.toml or one CSV of it), its fits and their options."""

    campaign: Path
    fits: tuple[str, ...]
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    only: str | None = None

"""Readers of force tables: one plugin a file, what a plugin is, and tables by the campaign that a person names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
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
from coeflab.tables.raw_table import RawTable, Run


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
    return replace(table, cells=counts, uncertainty=uncertainty).on_finest_grids()


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
    """Reads one format: whole tables (`raw`), single runs that are collected into a table (`run`), or campaigns (`read`).

    Attributes
    ----------
    reads : str
        What it reads, as lists of formats name it.
    raw : callable or None
        ``raw(path, options)``: the table as the file has it.
    run : callable or None
        ``run(path, options)``: one condition with its history.
    read : callable or None
        ``read(campaign, only, options)``: tables in SI and FRD, where a format says everything itself; by default `raw`
        or the collected runs, turned by the campaign's ``[columns]``.
    """

    reads: str = ""
    raw: Callable[[Path, Mapping[str, Any]], RawTable] | None = None
    run: Callable[[Path, Mapping[str, Any]], Run] | None = None
    read: Callable[[Campaign, str | None, Mapping[str, Any]], tuple[ForceTable, ...]] | None = None

    def recognises(self, path: Path) -> bool:
        """Whether the file or folder is one that it reads, by its content; at most one importer knows a path.

        Reads at most the first 64 KiB of a file, and lists a folder at most once; never raises for unreadable ones.

        Parameters
        ----------
        path : Path
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
        importer = IMPORTERS.load(campaign.importer)
        if importer.read is None:
            raise InputError(
                f"the importer {campaign.importer}",
                "one that reads campaigns",
                file=declaration,
                column="campaign.importer",
            )
        read = importer.read(campaign, planned.only, {})
    return declared(read, campaign)


@brief
@dataclass(frozen=True, slots=True)
class PlannedTable:
    """One ``[[table]]``: a campaign (a folder, a campaign.toml or one CSV of it), its fits and their options."""

    campaign: Path
    fits: tuple[str, ...]
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    only: str | None = None

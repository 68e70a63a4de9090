"""Readers of force tables: one plugin a file, what a plugin is, and the campaign that a person names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

from coeflab.core.registry import Plugin, Registry
from coeflab.core.types import brief
from coeflab.tables.campaign import Campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.raw_table import RawTable, Run


@runtime_checkable
class Importer(Plugin, Protocol):
    """Reads one format: whole tables (`raw`), single runs that are collected into a table (`run`), or campaigns (`read`).

    Attributes
    ----------
    reads : str
        What it reads, as lists of formats name it.
    computed : bool
        Of a solver: its forces hold no inertia of the body.
    wrote : callable or None
        ``wrote(lines)``: whether the solver wrote a monitor that begins with these lines, of its first 64 KiB.
    fit : str
        The fit that its tables are for.
    raw : callable or None
        ``raw(path, options)``: the table as the file has it.
    run : callable or None
        ``run(path, options)``: one condition with its history.
    read : callable or None
        ``read(campaign, only, options)``: tables in SI and FRD, where a format says everything itself; by default `raw`
        or the collected runs, turned by the campaign's ``[columns]``.
    """

    reads: str = ""
    computed: bool = False
    wrote: Callable[[Sequence[str]], bool] | None = None
    fit: str = "slope_at_origin"
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


@brief
@dataclass(frozen=True, slots=True)
class PlannedTable:
    """One ``[[table]]``: a campaign (a folder, a campaign.toml or one CSV of it), its fits, their options, the one speed wanted."""

    campaign: Path
    fits: tuple[str, ...]
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    only: str | None = None
    speed: float | None = None

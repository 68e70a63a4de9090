"""What a path is before anybody says what it means: a body, a bare mesh, a table, a single run; and the checks of a campaign."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from coeflab.bodies.mesh.file import SELF_DESCRIBED
from coeflab.bodies.proposed_mesh import proposed
from coeflab.bodies.simplify.source import names_body
from coeflab.core.errors import InputError
from coeflab.core.files import located
from coeflab.core.table import Check
from coeflab.study.checks import data_gate
from coeflab.tables.campaign import FILE, read_campaign
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.raw_table import Run
from coeflab.tables.reading import OF_RUNS, importer_of, read_tables, table_at

__all__ = [
    "Run",
    "campaign_tables",
    "is_mendable",
    "is_raw",
    "lacks_unit_or_axes",
    "names_body",
    "proposed",
    "single_run",
]


def lacks_unit_or_axes(name: str, unit: str = "", axes: str = "") -> bool:
    """Whether a mesh file is meant whose unit or axes nobody states.

    Parameters
    ----------
    name : str
        A path, or a shipped body.
    unit, axes : str
        As stated.
    """
    path = located(name, "geometry")
    if path.is_dir() or path.suffix.lower() == ".toml":
        return False
    own_unit, own_axes = SELF_DESCRIBED.get(path.suffix.lower().lstrip("."), ("", ""))
    return not ((unit or own_unit) and (axes or own_axes))


def is_mendable(name: str) -> bool:
    """Whether a mesh file is meant that states unit and axes and is sound once repaired."""
    path = located(name, "geometry")
    if path.suffix.lower().lstrip(".") not in SELF_DESCRIBED:
        return False
    found = proposed(path)
    return found.closed and found.repair


def is_raw(name: str) -> bool:
    """Whether a file or folder is meant that is part of no campaign.

    Examples
    --------
    >>> is_raw("suboff_roddy_2")
    False
    """
    path = located(name, "cfd_data")
    if path.is_dir() or path.suffix == ".toml":
        return path.is_dir() and not (path / FILE).exists()
    declaration = path.parent / FILE
    return not declaration.exists() or path.name not in {
        t.file.split("/")[-1] for t in read_campaign(declaration).tables
    }


def single_run(path: Path, importer: str = "", options: Mapping[str, Any] | None = None) -> tuple[str, Run] | None:
    """A run of a solver that is no row of a table yet, and the name of its importer; None where a path is no run.

    Parameters
    ----------
    path : Path
    importer : str
        The one that a person names, or empty.
    options : mapping, optional
        Of the importer.

    Raises
    ------
    InputError
        A run that cannot be read.
    """
    try:
        name = importer_of(path, importer)
    except InputError:
        return None
    plugin = IMPORTERS.load(name)
    if plugin.run is None or not plugin.recognises(path):
        return None
    with IMPORTERS.guarded(name):
        return name, plugin.run(path, {k: v for k, v in (options or {}).items() if k not in OF_RUNS})


def campaign_tables(path: Path) -> tuple[tuple[ForceTable, ...], tuple[Check, ...]]:
    """The tables of a campaign, and what the checks of data find in them before any fit.

    Parameters
    ----------
    path : Path
        A folder, its campaign.toml, or one CSV of it.

    Raises
    ------
    InputError
        By file, line and column.
    """
    read = read_tables(table_at(path))
    return read, data_gate.findings(read, read[0].scaling.length)

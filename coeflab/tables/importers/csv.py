"""CSV tables with units in their headers, beside a campaign.toml that declares what the numbers mean."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.options import NoOptions, parse_options
from coeflab.core.text.delimited import Cells, read_cells
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.units import Header, factor
from coeflab.core.wording import Verbatim
from coeflab.law.symbols import CONTROL_COLUMNS, MOTIONS
from coeflab.tables.campaign import Campaign, TableDeclaration
from coeflab.tables.column_map import EXAMPLES, FORCES, ROLES, ColumnMap
from coeflab.tables.columns import DIGIT, UNIFORM, Columns, rounded_to
from coeflab.tables.dialect import is_house_table
from coeflab.tables.force_table import ForceTable
from coeflab.tables.to_frd import force_table, speed_of_rows
from coeflab.tables.vocabulary import did_you_mean, one_name

summary = "CSV with units in the headers (beta [deg], Y [N], Y' [-]) and a campaign.toml"
citations = ("sname1950",)

UNCERTAIN, POINT = "uncertain", "point"
OWN = tuple(name for name, role in ROLES.items() if role != "word" and name not in FORCES)


def _kind(name: str) -> ColumnMap | None:
    """What a column is by its name, None for an unknown one."""
    primed = name.endswith("'")
    plain = one_name(name.removesuffix("'"))
    force = plain.removeprefix("se_")
    if force in FORCES:
        return ColumnMap(force, primed=primed, error=plain != force)
    return ColumnMap(plain, primed=primed) if plain in (MOTIONS if primed else OWN) else None


def _values(cells: Cells, header: Header, kind: ColumnMap) -> Array:
    unit = "-" if kind.primed else "rps" if kind.name == "rps" else EXAMPLES[kind.dimension]
    try:
        return cells.si(header, "none" if kind.primed else kind.dimension, f"{header.name} [{unit}]")
    except UnitsError as why:
        if kind.primed and header.unit is not None:
            why.advice = f"A primed column has the unit [-]; for a dimensional one write {header.name[:-1]} [...]."
        elif header.unit == "-" and kind.dimension != "angle":
            why.advice = f"For the nondimensional (prime) form write {header.name}' [-]."
        raise


def _unknown(cells: Cells, header: Header) -> InputError:
    known = ", ".join((*OWN, *CONTROL_COLUMNS, *FORCES))
    near = did_you_mean(header.name)
    return InputError(
        f"the unknown column {shown(header.text)}",
        f"one of {known}, se_..., {DIGIT}..., {POINT}, {UNCERTAIN}",
        file=cells.file,
        line=cells.first_line - 1,
        column=header.text,
        advice=f"{near} Name other columns under labels or ignore of the [[table]] in campaign.toml.".lstrip(),
    )


def _columns(cells: Cells, campaign: Campaign, table: TableDeclaration) -> Columns:
    """The columns in SI. Primed ones need the speed, so they are made dimensional last."""
    given: dict[str, dict[str, Array]] = {role: {} for role in (*ROLES.values(), "error", "shown", "stated")}
    labels: dict[str, list[str]] = {}
    headers: dict[str, str] = {}
    primes: list[tuple[str, ColumnMap, Array]] = []
    for header in cells.headers:
        if header.name in table.ignore:
            continue
        if header.name in (*table.labels, UNCERTAIN, POINT):
            labels[header.name] = list(map(Verbatim, cells.texts(header.name)))
            continue
        if header.name in (table.cells, table.variant):
            continue
        stated = DIGIT * header.name.startswith(DIGIT)
        kind = _kind(header.name.removeprefix(stated))
        if kind is None or (stated and kind.role != "force"):
            raise _unknown(cells, header)
        if (name := stated + kind.plain) in headers:
            raise input_error(
                "tables.column_twice", cells.file, cells.first_line - 1, header.text, headers=headers[name], text=header.text,
            )  # fmt: skip
        headers[name] = header.text
        values = _values(cells, header, kind)
        own = {"stated": values / UNIFORM} if stated else {kind.role: values}
        if "force" in own:
            scale = 1.0 if kind.primed else factor(header.unit or "", kind.dimension)
            own["shown"] = np.full(len(cells), rounded_to(cells.numbers(header.name)) * scale)
        for role, column in own.items():
            if kind.primed:
                primes.append((role, kind, column))
            else:
                given[role][kind.name] = column
    shares = {kind.name: values for role, kind, values in primes if role == "velocity"}
    speed = speed_of_rows(
        given["speed"].get("U"), given["velocity"], shares, campaign, len(cells), bool(given["angle"])
    )
    density = given["density"].get("density")
    for role, kind, values in primes:
        unit = campaign.scaling.unit(kind.component, campaign.conditions.density if density is None else density, speed)
        given[role][kind.name] = values * unit
    return Columns(
        file=cells.file,
        header_line=cells.first_line - 1,
        lines=tuple(cells.line(i) for i in range(len(cells))),
        headers=headers,
        angles=given["angle"],
        velocity=given["velocity"],
        controls=given["control"],
        speed=speed,
        forces=given["force"],
        errors=given["error"],
        rounding=given["shown"] | given["stated"],
        labels=labels,
        doubtful=_doubtful(cells, labels.get(UNCERTAIN, [""] * len(cells)), headers),
        row_labels=tuple(labels.get(POINT, ())),
        radius=given["radius"].get("R"),
        density=density,
        propeller=given["propeller"],
    )


def _doubtful(cells: Cells, texts: list[str], headers: dict[str, str]) -> tuple[frozenset[str], ...]:
    """Plain names of the columns that a row's ``uncertain`` cell names."""
    out = []
    for row, text in enumerate(texts):
        names = set()
        for token in text.replace(";", " ").split():
            name = one_name(token.removesuffix("'"))
            if name not in headers or name.startswith("se_"):
                raise input_error(
                    "tables.no_column_to_doubt", cells.file, cells.line(row), UNCERTAIN, token=shown(token)
                )
            names.add(name)
        out.append(frozenset(names))
    return tuple(out)


def recognises(path: Path) -> bool:
    """Whether the names of the columns are ours, each with its unit in brackets, between commas."""
    return is_house_table(path)


def read(
    campaign: Campaign, only: str | None = None, options: Mapping[str, Any] | None = None
) -> tuple[ForceTable, ...]:
    """Read the tables of a campaign.

    Parameters
    ----------
    campaign : Campaign
    only : str, optional
        File name of the one table that is wanted.
    options : mapping, optional
        None are known.

    Returns
    -------
    tuple of ForceTable

    Raises
    ------
    InputError
        Names file, line and column, what was found and what was expected.
    """
    parse_options(NoOptions, options or {}, "csv")
    found = ((table, read_cells(campaign.path.parent / table.file)) for table in campaign.wanted(only))
    return tuple(force_table(_columns(cells, campaign, table), campaign, table) for table, cells in found)

"""Tables without a campaign.toml: arrays as a raw table, and filled-in tables as force tables, with no file between."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.declarations import validated
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.units import parse_header
from coeflab.core.wording import Verbatim
from coeflab.tables.campaign import FILE, CampaignFile, campaign_of
from coeflab.tables.force_table import ForceTable
from coeflab.tables.imported import Filled, angles_assumed, own_keys
from coeflab.tables.mapping import mapped_table
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.settings import SECTIONS, Settings
from coeflab.tables.words.points import POINT_OF

NOWHERE = "<no file>"


def raw_of_columns(columns: Mapping[str, Any], name: str) -> RawTable:
    """Arrays by their headers, ``"Y [N]"`` or ``"Y"``, as a table of which nothing else is known.

    Parameters
    ----------
    columns : mapping of str to (n,) array_like
        A ``dict`` or a ``pandas.DataFrame``. Texts become labels.
    name : str
        What messages call the table.

    Raises
    ------
    InputError
        No column, columns of other lengths, or a column of more than one dimension.
    """
    result = [_column(str(header), columns[header], name) for header in columns]
    if not result:
        raise input_error("tables.no_arrays", name)
    sizes = {c.name: len(c.values) for c in result}
    if len(set(sizes.values())) > 1:
        raise input_error("tables.unequal_columns", name, items=", ".join(f"{n} ({k})" for n, k in sizes.items()))
    rows = next(iter(sizes.values()))
    if not rows:
        raise InputError("no rows", "rows of numbers", file=name)
    return RawTable(Path(name), tuple(result), lines=np.arange(rows))


def _column(header: str, values: Any, name: str) -> RawColumn:
    head = parse_header(header)
    cells = np.asarray(values)
    if cells.ndim != 1:
        raise InputError(f"an array of {cells.ndim} dimensions", "one dimension", file=name, column=header)
    if cells.dtype.kind in "biuf":
        return RawColumn(head.name, head.unit or "", cells.astype(float))
    numbers = np.full(len(cells), np.nan)
    for i, cell in enumerate(cells):
        try:
            numbers[i] = float(cell)
        except (TypeError, ValueError):
            continue
    texts = tuple("" if cell is None else str(cell) for cell in cells)
    whole = not np.any(np.isnan(numbers))
    return RawColumn(head.name, head.unit or "", numbers, () if whole else texts)


def tables_of(filled: Sequence[Filled]) -> tuple[ForceTable, ...]:
    """Filled-in tables in SI and FRD, about the reference point of the first.

    Parameters
    ----------
    filled : sequence of Filled

    Raises
    ------
    InputError
        What campaign.toml would refuse, by its key; what `coeflab.tables.mapping.mapped_table` refuses.
    """
    out = []
    first = filled[0].settings
    for t in filled:
        if str(t.settings["axes.datum"].value) != str(first["axes.datum"].value):
            raise input_error(
                "tables.two_datums", column="axes.datum", one=shown(str(t.settings["axes.datum"].value)),
                other=shown(str(first["axes.datum"].value)),
            )  # fmt: skip
        common = {**t.settings, POINT_OF: first[POINT_OF]}
        file = validated(CampaignFile, _declared(common, t))
        campaign = replace(
            campaign_of(file, Path(NOWHERE) / FILE),
            name=Verbatim(str(t.settings["campaign.name"].value)), columns=t.mapping,
        )  # fmt: skip
        out.append(mapped_table(t.raw, campaign, campaign.tables[0]))
    return tuple(out)


def _declared(settings: Settings, t: Filled) -> dict[str, Any]:
    """The content of a campaign.toml of one table."""
    sections: dict[str, dict[str, Any]] = {name: {} for name in SECTIONS}
    for key, one in settings.items():
        section, _, name = key.partition(".")
        sections[section][name] = one.value
    if assumed := angles_assumed(settings):
        sections["axes"]["assumed"] = assumed
    own = {name: value for name, (value, _) in own_keys(t, settings[POINT_OF].value).items()}
    sections.pop("table")
    return {name: keys for name, keys in sections.items() if keys} | {
        "table": [{"file": t.file.removesuffix(".csv"), **own}]
    }

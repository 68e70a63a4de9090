"""The files of a campaign made from another file: table.csv in coeflab's own names, a commented campaign.toml, mapping.toml."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from coeflab.core.declarations import validated
from coeflab.core.errors import InputError
from coeflab.core.provenance import sha256_of
from coeflab.core.text.toml import toml_text, value
from coeflab.core.units import quantity
from coeflab.core.version import VERSION
from coeflab.law.symbols import CONTROL_COLUMNS
from coeflab.tables.campaign import FILE, CampaignFile, read_campaign
from coeflab.tables.column_map import ColumnMap
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers.csv import read as read_house
from coeflab.tables.mapping import Assigned, doubtful, mapped_table, row_name, texts_of, usable_rows
from coeflab.tables.raw_table import RawTable
from coeflab.tables.settings import CONFIRMED, SECTIONS, Settings

LONG = {short: name for name, short in CONTROL_COLUMNS.items()}
TABLE = "table.csv"
SAVED = "mapping.toml"


def contents(
    raw: RawTable, importer: str, options: Mapping[str, Any], columns: Sequence[Assigned],
    mapping: Mapping[str, ColumnMap], settings: Settings,
) -> dict[str, bytes]:  # fmt: skip
    """The files of the campaign: table.csv, campaign.toml and mapping.toml.

    Parameters
    ----------
    raw : RawTable
    importer : str
        Its name.
    options : mapping
        Those of the importer.
    columns : sequence of Assigned
    mapping : mapping of str to ColumnMap
        What each column was confirmed to be, ignored ones too.
    settings : mapping of str to Setting
        Every key.

    Raises
    ------
    InputError
        Something that campaign.toml does not take.
    """
    table, labels = _table(raw, columns, settings)
    declared: dict[str, Any] = {"file": TABLE, "source_sha256": sha256_of(raw.path, raw.files)}
    comments = {"table.source_sha256": f"of {raw.path.name}, from which {TABLE} was made"}
    if labels:
        declared["labels"] = labels
    if any(c.said.name == "cells" for c in columns):
        declared["cells"] = "cells"
    dialect = "; ".join(f"{k} {v}" for k, v in raw.dialect.items() if k != "importer")
    how = f"Imported from {raw.path.name} by coeflab {VERSION}, importer {importer}" + (
        f" ({dialect})" if dialect else ""
    )
    named = ", ".join(f"{name} = {said}" for name, said in mapping.items() if said.name != "ignore")
    sections: dict[str, dict[str, Any]] = {name: {} for name in SECTIONS}
    for key, one in settings.items():
        section, _, name = key.partition(".")
        sections[section][name] = one.value
        comments[key] = one.origin
    sections["source"]["how_obtained"] = ". ".join(
        [*filter(None, [str(sections["source"].get("how_obtained", ""))]), f"{how}. Columns: {named}."]
    )
    comments.pop("source.how_obtained", None)
    sections["table"] = declared | sections["table"]
    content: dict[str, Any] = {k: v for k, v in sections.items() if v and k != "table"}
    content["table"] = [sections["table"]]
    validated(CampaignFile, content)
    saved = {
        "campaign": {"importer": importer},
        "importer": dict(options),
        "columns": {name: str(said) for name, said in mapping.items()},
    }
    for key, one in settings.items():
        section, _, name = key.partition(".")
        if one.origin.startswith(CONFIRMED) and section != "campaign":
            saved.setdefault(section, {})[name] = one.value
    head = f"# Used again by: coeflab import FILE --mapping {SAVED} --out DIR --accept\n"
    return {
        TABLE: table,
        FILE: _campaign_text(sections, comments, raw).encode(),
        SAVED: (head + toml_text({k: v for k, v in saved.items() if v})).encode(),
    }


def _campaign_text(sections: Mapping[str, Mapping[str, Any]], comments: Mapping[str, str], raw: RawTable) -> str:
    lines = [f"# What the numbers in {TABLE} mean. Made by `coeflab import` from {_plain(raw.path.name)}."]
    lines += [f"# {_plain(remark)}" for remark in raw.remarks]
    for section, keys in sections.items():
        if not keys:
            continue
        lines += ["", f"[[{section}]]" if section == "table" else f"[{section}]"]
        for name, content in keys.items():
            line = f"{name} = {value(content)}"
            said = comments.get(f"{section}.{name}", "")
            lines.append(f"{line:<41} # {_plain(said)}" if said else line)
        lines += [f"# {hint}" for hint in HINTS.get(section, ()) if hint.partition(" ")[0] not in keys]
    return "\n".join(lines) + "\n"


HINTS = {
    "campaign": ("half_model = true                       symmetry plane: X, Z, M are doubled; Y, K, N refused",),
    "conditions": ("viscosity = 1.05e-6                     m^2/s; for the Reynolds number",),
    "table": (
        "contains_inertia = true                 for a balance on a real rotating arm; then add [inertia]",
        'select = { run = "A", reason = "..." }  only these rows, by a column of labels',
    ),
}


def _plain(text: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in text)


def _table(raw: RawTable, columns: Sequence[Assigned], settings: Settings) -> tuple[bytes, list[str]]:
    """The table in coeflab's names and the file's units, all digits; and the names of its label columns."""
    rows = usable_rows(columns, len(raw))
    length = quantity(settings["scaling.length"].value, "length")
    heads: list[str] = []
    cells: list[list[str]] = []
    labels: list[str] = []
    doubts = [set(words) for words in doubtful(raw, columns)]
    if not any(c.said.name == "point" for c in columns):
        heads.append("point")
        cells.append([row_name(raw, int(row)) for row in rows])
    for one in columns:
        said = one.said
        if said.name == "uncertain":
            continue
        if said.name in ("label", "point"):
            name = "point" if said.name == "point" else _label(one.column.name, heads)
            labels += [name] * (said.name == "label")
            heads.append(name)
            texts = texts_of(one.column)
            cells.append([_plain(texts[row]).strip() for row in rows])
            continue
        own = one.column.values * (-1.0 if said.negative else 1.0)
        if said.area:
            own = own * (said.area * (said.length or 1.0) / length ** (3 if said.length else 2))
        if said.pure:
            own = own * abs(one.factor)
        values = np.where(np.isnan(one.values), np.nan, own)[rows]
        heads.append(_head(said))
        cells.append(["" if np.isnan(x) else repr(x + 0.0) for x in values.tolist()])
        for row in rows[np.isnan(values)] if said.role == "force" else ():
            doubts[row].add(said.name)
    if any(doubts[row] for row in rows):
        heads.append("uncertain")
        names = [LONG.get(one.said.name, one.said.name) for one in columns if not one.said.error]
        words = [{LONG.get(name, name) for name in doubts[row]} for row in rows]
        cells.append([" ".join(name for name in names if name in own) for own in words])
    out = io.StringIO()
    out.write(f"# Made by `coeflab import` from {_plain(raw.path.name)}; all digits of the file.\n")
    left = sorted(set(range(len(raw))) - set(rows.tolist()))
    if left:
        out.write("# Left out, a setting has no number: " + ", ".join(row_name(raw, row) for row in left) + ".\n")
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(zip(*cells, strict=True))
    return out.getvalue().encode(), labels


def _head(said: ColumnMap) -> str:
    if said.name == "cells":
        return "cells"
    name = f"se_{said.name}" if said.error else LONG.get(said.name, said.name)
    return f"{name}' [-]" if said.pure else f"{name} [{said.unit}]"


def _label(name: str, taken: Sequence[str]) -> str:
    """A name for a label column that is no column of numbers."""
    out = " ".join(_plain(name).replace("[", "(").replace("]", ")").split()) or "label"
    while out in taken or len(out) < 3 or out in ("point", "cells", "beta", "alpha", "uncertain"):
        out = f"{out} label" if "label" not in out else f"{out}_"
    return out


def checked(made: Mapping[str, bytes], raw: RawTable, mapping: Mapping[str, ColumnMap]) -> ForceTable:
    """The table as the new campaign reads, tried in a temporary folder; complaints are about the file that was imported.

    Parameters
    ----------
    made : mapping of str to bytes
        From `contents`.
    raw : RawTable
    mapping : mapping of str to ColumnMap

    Raises
    ------
    InputError
        All that does not agree.
    """
    with TemporaryDirectory(prefix="coeflab_") as folder:
        path = Path(folder) / FILE
        for file, content in made.items():
            (Path(folder) / file).write_bytes(content)
        try:
            campaign = read_campaign(path)
            declared = replace(campaign.tables[0], labels=(), ignore=(), cells="", select={})
            mapped_table(raw, replace(campaign, columns=mapping), declared)
        except InputError as why:
            for one in (why, *why.others):
                if one.file is not None and Path(one.file) == path:
                    one.file = one.line = None
            raise
        return read_house(campaign)[0]

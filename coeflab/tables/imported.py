"""The files of a campaign made from another file: table.csv in coeflab's own names, a commented campaign.toml, mapping.toml."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from coeflab.core.declarations import validated
from coeflab.core.errors import InputError, shown
from coeflab.core.provenance import sha256_of
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.text.toml import toml_text, value
from coeflab.core.texts import input_error
from coeflab.core.types import brief
from coeflab.core.units import density_as_written, quantity
from coeflab.core.version import VERSION
from coeflab.core.wording import identifier, one_line
from coeflab.law.symbols import CONTROL_COLUMNS
from coeflab.tables.campaign import FILE, CampaignFile, cut_of, read_campaign
from coeflab.tables.column_map import ColumnMap
from coeflab.tables.columns import DIGIT, UNIFORM, rounded_to
from coeflab.tables.conditions import BETWEEN
from coeflab.tables.evidence import SLENDER
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers.csv import read as read_house
from coeflab.tables.levels import levels_of
from coeflab.tables.mapping import Assigned, doubtful, mapped_table, row_name, texts_of, usable_rows, without_a_setting
from coeflab.tables.raw_table import HALF_MODEL, RawTable
from coeflab.tables.settings import ARM_POINT, CONFIRMED, EACH, OF_ARMS, REFERENCE, SECTIONS, Settings
from coeflab.tables.words.points import POINT_OF

LONG = {short: name for name, short in CONTROL_COLUMNS.items()}
TABLE = "table.csv"
SAVED = "mapping.toml"
MOST_NAMED = 200  # rows that the table names as left out


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Filled:
    """A table of which everything is said.

    Attributes
    ----------
    name : str
        Of the sheet, file or group of runs; empty where it is the only one.
    raw : RawTable
    importer : str
    options : mapping
        Those of the importer.
    columns : tuple of Assigned
    mapping : mapping of str to ColumnMap
        What each column was confirmed to be, ignored ones too.
    settings : mapping of str to Setting
        Every key, as it holds for this table.
    asked : frozenset of str
        Keys that this table raises.
    assumed : tuple of str
        Keys that were accepted and that no source states.
    """

    name: str
    raw: RawTable
    importer: str
    options: Mapping[str, Any]
    columns: tuple[Assigned, ...]
    mapping: Mapping[str, ColumnMap]
    settings: Settings
    asked: frozenset[str]
    assumed: tuple[str, ...] = ()

    @property
    def file(self) -> str:
        """Of its table in the campaign."""
        return f"{identifier(self.name)}.csv" if self.name else TABLE


def contents(tables: Sequence[Filled], settings: Settings, source: Path) -> dict[str, bytes]:
    """The files of the campaign: its tables, campaign.toml and mapping.toml.

    Parameters
    ----------
    tables : sequence of Filled
    settings : mapping of str to Setting
        Every key, of all tables together; what one has of its own has its name and a slash before it.
    source : Path
        What was imported.

    Raises
    ------
    InputError
        Something that campaign.toml does not take; tables that count from two points of the body.
    """
    common = {key: one for key, one in settings.items() if "/" not in key}
    for key in (k for t in tables for k in t.settings if k not in common and not k.startswith("table.")):
        common[key] = next(t.settings[key] for t in tables if key in t.settings)
    _require_one(tables, common)
    comments: dict[str, str] = {}
    sections: dict[str, dict[str, Any]] = {name: {} for name in SECTIONS}
    for key, one in common.items():
        section, _, name = key.partition(".")
        if section != "table":
            sections[section][name] = density_as_written(one.value) if name == "density" else one.value
            comments[key] = one.origin
    halves = [t.settings[HALF_MODEL].value if HALF_MODEL in t.settings else False for t in tables]
    if len(set(map(str, halves))) > 1:
        sections["campaign"].pop("half_model", None)
    elif HALF_MODEL in common:
        comments[HALF_MODEL] += _of_half(common[HALF_MODEL].value)
    sections["source"]["how_obtained"] = (
        ". ".join(
            [*filter(None, [str(sections["source"].get("how_obtained", ""))]), *(_how_obtained(t) for t in tables)]
        )
        + "."
    )
    comments.pop("source.how_obtained", None)
    if assumed := angles_assumed(common):
        sections["axes"]["assumed"] = assumed
        comments["axes.assumed"] = "a sign inferred from the slope: delete this once it is known from the source"
    sections.pop("table")
    result, declared = dict[str, bytes](), list[tuple[dict[str, Any], dict[str, str]]]()
    for t in tables:
        result[t.file], labels = _table(t.raw, t.columns, t.settings, _constants(t, common))
        own: dict[str, Any] = {"file": t.file, "source_sha256": sha256_of(t.raw.path, t.raw.files)}
        words = {"source_sha256": f"of {t.raw.path.name}, from which {t.file} was made"}
        if labels:
            own["labels"] = labels
        if any(c.meaning.name == "cells" for c in t.columns):
            own["cells"] = "cells"
        keys = own_keys(t, common[POINT_OF].value, len(tables) == 1, len(set(map(str, halves))) > 1, _held(t))
        own |= {name: content for name, (content, _) in keys.items()}
        words |= {name: why for name, (_, why) in keys.items()}
        declared.append((own, words))
    content: dict[str, Any] = {k: v for k, v in sections.items() if v}
    content["table"] = [own for own, _ in declared]
    validated(CampaignFile, content)
    return {
        **result,
        FILE: _campaign_text(sections, comments, declared, tables, source).encode(),
        SAVED: _saved(tables, settings).encode(),
    }


def angles_assumed(settings: Settings) -> list[str]:
    """Angles whose sign was inferred from the force that should follow from it."""
    angles = (a for a in ("alpha", "beta") if f"axes.{a}" in settings)
    return [a for a in angles if SLENDER in settings[f"axes.{a}"].origin]


def own_keys(
    t: Filled, point: Any, alone: bool = False, half: bool = True, constant: Mapping[str, float] | None = None
) -> dict[str, tuple[Any, str]]:
    """Keys of the ``[[table]]`` of one table, each with what it rests on.

    Parameters
    ----------
    t : Filled
    point : sequence of float
        The campaign's reference point.
    alone : bool
        The campaign has no other table.
    half : bool
        Whether it says itself what half of the body it is of.
    constant : mapping, optional
        What the test held.
    """
    out: dict[str, tuple[Any, str]] = {}
    for key, one in t.settings.items():
        section, _, name = key.partition(".")
        if section == "table" and (alone or key in t.asked or key not in OF_ARMS):
            at_reference = key == ARM_POINT and one.value == REFERENCE
            why = f"{one.origin}: the {REFERENCE}" if at_reference else one.origin
            out[name] = (t.settings[POINT_OF].value if at_reference else one.value), why
    if flagged := [key for key in t.assumed if key not in ("axes.alpha", "axes.beta")]:
        out["assumed"] = flagged, "accepted, not stated by the source; what hangs on it says so"
    if constant:
        out["constant"] = constant, "one number throughout, while the speed varied"
    model_density = t.raw.stated.get("conditions.density")
    if model_density is not None and not model_density.offered and isinstance(model_density.value, float):
        out["forces_density"] = density_as_written(model_density.value), f"stated: {model_density.place}"
    if half and HALF_MODEL in t.settings:
        out["half_model"] = (which := t.settings[HALF_MODEL]).value, which.origin + _of_half(which.value)
    if t.settings[POINT_OF].value != point:
        out["reference_point"] = t.settings[POINT_OF].value, t.settings[POINT_OF].origin
    return out


def _of_half(half: bool | str) -> str:
    """What becomes of the forces, for the comment beside half_model."""
    cut = cut_of(half)
    if cut is None:
        return ": forces are of the whole body"
    doubled, cancelled = ", ".join(cut.doubled), ", ".join(cut.cancelled)
    return f": cut at {cut.plane}, {doubled} are doubled; {cancelled} left out"


def _require_one(tables: Sequence[Filled], common: Settings) -> None:
    """Refuse tables that count places from two points of the body."""
    for t in tables:
        if str(t.settings["axes.datum"].value) != str(common["axes.datum"].value):
            raise input_error(
                "tables.another_datum", column="axes.datum", own=shown(str(t.settings["axes.datum"].value)), name=t.name,
                other=shown(str(common["axes.datum"].value)),
            )  # fmt: skip


def _how_obtained(table: Filled) -> str:
    dialect = "; ".join(f"{k} {v}" for k, v in table.raw.dialect.items() if k != "importer")
    how = f"Imported from {table.raw.path.name} by coeflab {VERSION}, importer {table.importer}"
    named = ", ".join(f"{name} = {given}" for name, given in table.mapping.items() if given.name != "ignore")
    of = f"{table.file}: " * bool(table.name)
    rows = "".join(f". Rows {words}" for words in without_a_setting(table.raw, table.columns))
    return f"{of}{how}{f' ({dialect})' if dialect else ''}. Columns: {named}{rows}"


def _constants(table: Filled, common: Settings) -> dict[str, float]:
    """Heads and values of columns for what one table has of its own where a campaign has one: speed and density."""
    roles = {c.meaning.role for c in table.columns}
    primed = all(c.meaning.primed for c in table.columns if c.meaning.role == "velocity")
    out = {}
    for key, role, head in (
        ("conditions.speed", "speed", "U [m/s]"),
        ("conditions.density", "density", "density [kg/m^3]"),
    ):
        own = quantity(table.settings[key].value, role)
        if own != quantity(common[key].value, role) and role not in roles and (role == "density" or primed):
            out[head] = own
    return out


def _held(table: Filled) -> dict[str, float]:
    """Columns of no use with one number throughout, of a table of several speeds: what the test held while the speed varied."""
    speeds = next((c.values for c in table.columns if c.meaning.role == "speed"), np.empty(0))
    if np.unique(levels_of(speeds[np.isfinite(speeds)])).size < 2:
        return {}
    used = {c.column.name for c in table.columns if c.meaning.role != "propeller"}
    idle = [
        c
        for c in table.raw.columns
        if c.name not in used and not c.means and np.all(np.isfinite(c.values)) and len(c.values)
    ]
    return {_label(c.name, ()): float(c.values[0]) for c in idle if not np.ptp(c.values) and c.values[0] != 0.0}


def _saved(tables: Sequence[Filled], settings: Settings) -> str:
    """mapping.toml: what was confirmed, for the next file of the same kind."""
    importers = {t.importer for t in tables}
    several = len(tables) > 1
    options = {k: v for k, v in tables[0].options.items() if not (several and k in ("sheet", "files", "names"))}
    if several and "names" in tables[0].options:
        options["names"] = BETWEEN.join(str(t.options["names"]) for t in tables)
    columns: dict[str, str] = {}
    for t in tables:
        for name, words in t.mapping.items():
            same = {str(o.mapping[name]) for o in tables if name in o.mapping}
            columns[name if len(same) == 1 else f"{t.name}/{name}"] = str(words)
    named = (
        importers.pop() if len(importers) == 1 and not (several and tables[0].raw.path != tables[-1].raw.path) else ""
    )
    saved: dict[str, dict[str, Any]] = {
        "campaign": {"importer": named} if named else {},
        "importer": options,
        "columns": columns,
    }
    for key, one in settings.items():
        table, _, plain = key.rpartition("/")
        section, _, name = plain.partition(".")
        if one.origin.startswith(CONFIRMED) and section != "campaign":
            saved.setdefault(EACH if table else section, {})[key if table else name] = one.value
    head = f"# Used again by: coeflab import FILE --mapping {SAVED} --out DIR --accept\n"
    return head + toml_text({k: v for k, v in saved.items() if v})


def _campaign_text(
    sections: Mapping[str, Mapping[str, Any]], comments: Mapping[str, str],
    declared: Sequence[tuple[Mapping[str, Any], Mapping[str, str]]], tables: Sequence[Filled], source: Path,
) -> str:  # fmt: skip
    result = ", ".join(t.file for t in tables)
    lines = [f"# What the numbers in {result} mean. Made by `coeflab import` from {one_line(source.name)}."]
    for t in tables:
        lines += [
            f"# {one_line(f'{t.name}: ' * bool(t.name) + remark)}"
            for remark in (*t.raw.remarks, *without_a_setting(t.raw, t.columns))
        ]
    every: list[tuple[str, Mapping[str, Any], Mapping[str, str]]] = [
        (name, keys, {k: comments.get(f"{name}.{k}", "") for k in keys}) for name, keys in sections.items()
    ]
    every += [("table", own, words) for own, words in declared]
    for section, keys, words in every:
        if not keys:
            continue
        lines += ["", f"[[{section}]]" if section == "table" else f"[{section}]"]
        for name, content in keys.items():
            line = f"{name} = {value(content)}"
            lines.append(f"{line:<41} # {one_line(words[name])}" if words.get(name) else line)
        lines += [f"# {hint}" for hint in HINTS.get(section, ()) if hint.partition(" ")[0] not in keys]
    return "\n".join(lines) + "\n"


HINTS = {
    "campaign": (
        'half_model = "port"                     or "starboard", cut at y = 0: X, Z, M are doubled; Y, K, N refused',
        'half_model = "upper"                    or "lower", cut at z = 0: X, Y, N are doubled; Z, K, M refused',
    ),
    "conditions": ("viscosity = 1.05e-6                     m^2/s; for the Reynolds number",),
    "table": (
        "contains_inertia = true                 for a balance on a real rotating arm; then add [inertia]",
        'select = { run = "A", reason = "..." }  only these rows, by a column of labels',
    ),
}


def _table(
    raw: RawTable, columns: Sequence[Assigned], settings: Settings, constants: Mapping[str, float]
) -> tuple[bytes, list[str]]:
    """The table in coeflab's names and the file's units, all digits; and the names of its label columns."""
    rows = usable_rows(raw, columns)
    length = quantity(settings["scaling.length"].value, "length")
    speed = next(
        (c.values for c in columns if c.meaning.role == "speed"), quantity(settings["conditions.speed"].value, "speed")
    )
    heads: list[str] = []
    cells: list[list[str]] = []
    labels: list[str] = []
    doubts = [set(words) for words in doubtful(raw, columns)]
    if not any(c.meaning.name == "point" for c in columns):
        heads.append("point")
        cells.append([row_name(raw, int(row)) for row in rows])
    for one in columns:
        given = one.meaning
        if given.name == "uncertain":
            continue
        if given.name in ("label", "point"):
            name = "point" if given.name == "point" else _label(one.column.name, heads)
            labels += [name] * (given.name == "label")
            heads.append(name)
            texts = texts_of(one.column)
            cells.append([one_line(texts[row]).strip() for row in rows])
            continue
        scale = np.ones(len(raw))
        if given.area:
            scale *= given.area * (given.length or 1.0) / length ** (3 if given.length else 2)
        if given.per_speed:
            scale *= speed**2
        if given.ship:
            scale /= given.ship**0.5
        if given.pure:
            scale *= abs(one.factor)
        own = one.column.values * (-scale if given.negative else scale)
        values = np.where(np.isnan(one.values), np.nan, own)[rows]
        heads.append(_head(given))
        cells.append(["" if np.isnan(x) else repr(x + 0.0) for x in values.tolist()])
        if given.role == "force" and not np.allclose(
            digit := (one.column.rounding * scale)[rows], rounded_to(values), atol=0.0
        ):
            heads.append(DIGIT + _head(given))
            cells.append([f"{x:.6g}" for x in (digit * UNIFORM).tolist()])
        for row in rows[np.isnan(values)] if given.role == "force" else ():
            doubts[row].add(given.name)
    for head, number in constants.items():
        heads.append(head)
        cells.append([repr(number)] * len(rows))
    if any(doubts[row] for row in rows):
        heads.append("uncertain")
        names = [LONG.get(one.meaning.name, one.meaning.name) for one in columns if not one.meaning.error]
        words = [{LONG.get(name, name) for name in doubts[row]} for row in rows]
        cells.append([" ".join(name for name in names if name in own) for own in words])
    comments = [f"Made by `coeflab import` from {one_line(raw.path.name)}; all digits of the file."]
    left = sorted(set(range(len(raw))) - set(rows.tolist()))
    if left:
        first = ", ".join(row_name(raw, row) for row in left[:MOST_NAMED])
        comments.append(
            f"Left out, no number or another level: {first}{f' and {len(left) - MOST_NAMED} more' * (len(left) > MOST_NAMED)}."
        )
    return csv_text([heads, *zip(*cells, strict=True)], comments).encode(), labels


def _head(meaning: ColumnMap) -> str:
    if meaning.name == "cells":
        return "cells"
    name = f"se_{meaning.name}" if meaning.error else LONG.get(meaning.name, meaning.name)
    return f"{name}' [-]" if meaning.pure else f"{name} [{meaning.unit}]"


def _label(name: str, taken: Sequence[str]) -> str:
    """A name for a label column that is no column of numbers."""
    out = " ".join(one_line(name).replace("[", "(").replace("]", ")").split()) or "label"
    while out in taken or len(out) < 3 or out in ("point", "cells", "beta", "alpha", "uncertain"):
        out = f"{out} label" if "label" not in out else f"{out}_"
    return out


def checked(files: Mapping[str, bytes], tables: Sequence[Filled]) -> tuple[ForceTable, ...]:
    """The tables as the new campaign reads, tried in a temporary folder; complaints are about the file that was imported.

    Parameters
    ----------
    files : mapping of str to bytes
        From `contents`.
    tables : sequence of Filled

    Raises
    ------
    InputError
        All that does not agree.
    """
    with TemporaryDirectory(prefix="coeflab_") as folder:
        path = Path(folder) / FILE
        for file, content in files.items():
            (Path(folder) / file).write_bytes(content)
        try:
            campaign = read_campaign(path)
            for t, own in zip(tables, campaign.tables, strict=True):
                declared = replace(own, labels=(), ignore=(), cells="", select={})
                at = (quantity(t.settings[f"conditions.{name}"].value, name) for name in ("density", "speed"))
                conditions = replace(campaign.conditions, **dict(zip(("density", "speed"), at, strict=True)))
                one = replace(campaign, columns=t.mapping, conditions=conditions, tables=(declared,), lines=())
                mapped_table(t.raw, one, declared)
        except InputError as why:
            for complaint in (why, *why.others):
                if complaint.file is not None and Path(complaint.file) == path:
                    complaint.file = complaint.line = None
            raise
        return read_house(campaign)

"""Several tables of one campaign: sheets of a workbook, tables of a folder, runs whose names follow several patterns.

What all of them share is said once; what one of them has of its own has its name before it: ``Arm/table.centre``, ``Arm/Fy``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import takewhile
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from coeflab.core.errors import InputError, shown, together
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.core.wording import listed, natural
from coeflab.law.symbols import COMPONENTS
from coeflab.tables.column_company import proposals
from coeflab.tables.columns import FEWEST, UNIFORM, rounded_to
from coeflab.tables.conditions import BETWEEN, SETTINGS, SPELT, UNIT_ASKED, NoConditionError, name_pattern
from coeflab.tables.form import Group, Line
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.mapping import texts_of
from coeflab.tables.proposals import AREA, LENGTH_OF, UNITS_OF
from coeflab.tables.raw_table import HALF_MODEL, RawColumn, RawTable, SeveralError, Stated
from coeflab.tables.reading import importer_of, read_groups, read_raw, recognised
from coeflab.tables.runs import NoRunsError
from coeflab.tables.runs_table import DOUBTFUL as UNCERTAIN
from coeflab.tables.settings import Setting
from coeflab.tables.settings_in_files import stated_settings
from coeflab.tables.words.points import POINT_FROM, POINT_OF

Progress = Callable[[str], None]
Value = TypeVar("Value")
MOST = 40  # tables of a folder, sheets of a workbook
JOIN = "joined"  # option: tables of the same columns become one
SPLIT = (  # each table may have its own
    "conditions.speed", "conditions.density", HALF_MODEL, POINT_OF, "table.", "coefficients.", "columns.",
)  # fmt: skip
OWN_KEYS = f"table.centre, .arm_point, .contains_inertia, {HALF_MODEL}, {POINT_OF}, conditions.speed, conditions.density, {AREA}, {LENGTH_OF}, {UNITS_OF}"
ALONE = ("table.", "coefficients.")  # what one table has is no proposal for another
_SETS = ("angle", "velocity", "radius", "control")  # what a row of a table of means has, and a record over time has not


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """One table of the campaign.

    Attributes
    ----------
    name : str
        By which a person names it; empty where it is the only one.
    raw : RawTable
    importer : str
    options : mapping
        Those it was read with.
    """

    name: str
    raw: RawTable
    importer: str
    options: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Chosen:
    """An option of reading that nobody said and somebody has to accept.

    Attributes
    ----------
    key, value : str
    why, about : str
        In short, and whole.
    left : tuple of str
        What is not taken, each with its reason.
    """

    key: str
    value: str
    why: str
    about: str
    left: tuple[str, ...] = ()

    @property
    def line(self) -> Line:
        """Its line of the form: accepting confirms it."""
        return Line(self.key, self.value, self.why, Group.GRAVE, f"{self.about}.", pending=True)


def read_parts(
    path: Path, importer: str, options: Mapping[str, Any], progress: Progress | None = None
) -> tuple[tuple[Part, ...], tuple[Chosen, ...]]:
    """The tables that a file or folder holds, and what was chosen in reading them.

    Parameters
    ----------
    path : Path
    importer : str
        The one that a person names, or empty.
    options : mapping
        Of the importer; ``sheet`` may name several with commas between, ``names`` several patterns with `BETWEEN`; `JOIN`.
    progress : callable, optional

    Raises
    ------
    InputError
        By file and line.
    """
    if JOIN in options:
        rest = {key: value for key, value in options.items() if key != JOIN}
        parts, chosen = read_parts(path, importer, rest, progress)
        return tuple(replace(p, options={**p.options, JOIN: "yes"}) for p in joined_tables(parts)), chosen
    try:
        name = importer_of(path, importer)
    except NoRunsError:
        found = _of_folder(path, options) if not importer else None
        if not found:
            raise
        return found
    given = dict(options)
    if BETWEEN in str(given.get("names", "")):
        tables = joined_components(read_groups(path, name, given, progress))
        if len(tables) == 1:
            return (Part("", tables[0], name, given),), ()
        named = _called([_word_of(t.dialect["names"]) for t in tables])
        own = [{**given, "names": t.dialect["names"]} for t in tables]
        return tuple(Part(n, t, name, o) for n, t, o in zip(named, tables, own, strict=True)), ()
    try:
        return (Part("", read_raw(path, name, given, progress), name, given),), ()
    except SeveralError as several:
        if not several.choices:
            raise
        if len(several.choices) > MOST:
            raise input_error("tables.too_many_sheets", path, count=len(several.choices), most=MOST) from None  # fmt: skip
        return _of_sheets(path, name, given, several.choices)
    except NoConditionError as unsaid:
        if given.get("names") or not unsaid.patterns or any(UNIT_ASKED in pattern for pattern in unsaid.patterns):
            raise
        given["names"] = BETWEEN.join(unsaid.patterns)
        parts, _ = read_parts(path, importer, given, progress)
        return parts, (_by_names(unsaid),)
    except InputError:
        if not 0 < str(given.get("sheet", "")).count(",") < MOST:
            raise
        return _of_sheets(path, name, given, [s.strip() for s in str(given["sheet"]).split(",")], stated=True)


def joined_components(tables: Sequence[RawTable]) -> tuple[RawTable, ...]:
    """Runs of the same conditions that hold different components, forces in one and moments in the other, as one table.

    Parameters
    ----------
    tables : sequence of RawTable
        Of collected runs.
    """
    out: list[RawTable] = []
    for table in tables:
        home = next((i for i, other in enumerate(out) if _complements(other, table)), None)
        if home is None:
            out.append(table)
        else:
            out[home] = _side_by_side(out[home], table)
    return tuple(out)


def _conditions(table: RawTable) -> tuple[list[str], list[tuple[float, ...]]]:
    """The settings of a table of runs, and those of each row to six digits."""
    own = [c for c in table.columns if c.means in SETTINGS]
    rows = zip(*(c.values for c in own), strict=True) if own else ()
    return [f"{c.means} [{c.unit}]" for c in own], [tuple(float(f"{x:.6g}") + 0.0 for x in row) for row in rows]


def _measured(table: RawTable) -> dict[str, RawColumn]:
    """Columns of numbers that differ between runs by what they hold: no setting, no count of iterations."""
    endings = ("", *COMPONENTS, *(f"se_{c}" for c in COMPONENTS))
    return {c.means or c.name: c for c in table.columns if not c.is_text and c.means in endings}


def _complements(one: RawTable, other: RawTable) -> bool:
    (names, rows), (theirs, others) = _conditions(one), _conditions(other)
    return (
        bool(names) and names == theirs and len(set(rows)) == len(rows) and sorted(rows) == sorted(others)
        and _measured(one).keys().isdisjoint(_measured(other))
    )  # fmt: skip


def _side_by_side(one: RawTable, other: RawTable) -> RawTable:
    """The columns of both, row by row of one condition; what either marks as uncertain is so."""
    rows, others = _conditions(one)[1], _conditions(other)[1]
    order = [others.index(row) for row in rows]

    def marked(c: RawColumn) -> RawColumn:
        if not (c.is_text and c.means == UNCERTAIN):
            return c
        theirs = other.column(c.name).texts
        return replace(
            c, texts=tuple("; ".join(filter(None, (t, theirs[i]))) for t, i in zip(c.texts, order, strict=True))
        )

    columns = [marked(c) for c in one.columns]
    columns += [replace(c, values=c.values[order]) for c in _measured(other).values()]
    labels = tuple(f"{a}, {other.row_labels[i]}" for a, i in zip(one.row_labels, order, strict=True))
    return replace(
        one, columns=tuple(columns), row_labels=labels, files=tuple(dict.fromkeys((*one.files, *other.files))),
        dialect={**one.dialect, "names": BETWEEN.join(t.dialect["names"] for t in (one, other))}, stated={**other.stated, **one.stated},
        remarks=(*one.remarks, *(r for r in other.remarks if r not in one.remarks)),
    )  # fmt: skip


def _of_sheets(
    path: Path, name: str, options: Mapping[str, Any], sheets: Sequence[str], stated: bool = False
) -> tuple[tuple[Part, ...], tuple[Chosen, ...]]:
    """The sheets with forces, or those that somebody said."""
    tables: dict[str, RawTable] = {}
    left: dict[str, str] = {}
    complaints: list[InputError] = []
    for sheet in sheets:
        try:
            tables[sheet] = read_raw(path, name, {**options, "sheet": sheet})
        except InputError as unread:
            complaints.append(unread)
            left[sheet] = str(unread)
    if stated and complaints:
        raise together(complaints)
    if not stated:
        bare = [s for s, raw in tables.items() if why_no_table(raw)]
        left |= {s: why_no_table(tables[s]) for s in bare}
        tables = {s: raw for s, raw in tables.items() if s not in bare} or dict(list(tables.items())[:1])
    if not tables:
        raise together(complaints)
    others = tuple(f"sheet {sheet}: {why}" for sheet, why in left.items() if sheet not in tables)
    value = ", ".join(tables)
    why = f"{'those' if len(tables) > 1 else 'the one'} with forces" + f"; others: {', '.join(left)}" * bool(left)
    about = f"Sheets with numbers: {', '.join(sheets)}. One or several with commas between; each becomes a table of the campaign"
    chosen = () if stated else (Chosen("sheet", value, why, about, others),)
    names = _called(list(tables)) if len(tables) > 1 else [""]
    return tuple(
        Part(n, raw, name, {**options, "sheet": sheet}) for n, (sheet, raw) in zip(names, tables.items(), strict=True)
    ), chosen


def why_no_table(raw: RawTable) -> str:
    """Why a table is none of forces over settings, by its names and units; empty where it is."""
    roles = {one.role for one in proposals(raw)}
    if "force" not in roles:
        return "no force or moment by its names"
    return "" if roles & {*_SETS} else "no angle, velocity, rate or radius by its names"


def _of_folder(path: Path, options: Mapping[str, Any]) -> tuple[tuple[Part, ...], tuple[Chosen, ...]] | None:
    """The tables of a folder that holds no runs; None where it holds none."""
    if not path.is_dir():
        return None
    found: list[tuple[str, RawTable, str, Mapping[str, Any]]] = []
    left: list[str] = []
    wanted = [name.strip() for name in str(options.get("files", "")).split(",") if name.strip()]
    try:
        every = sorted((f for f in path.iterdir() if f.is_file() and f.name[0] != "."), key=lambda f: natural(f.name))
    except OSError as shut:
        raise input_error("tables.shut_folder", path, strerror=shut.strerror) from None
    if absent := [name for name in wanted if name not in [f.name for f in every]]:
        raise input_error(
            "tables.no_such_files", path, absent=", ".join(map(shown, absent)), every=", ".join(f.name for f in every[:MOST]),
        )  # fmt: skip
    own = {key: value for key, value in options.items() if key != "files"}
    for file in (f for f in every if not wanted or f.name in wanted):
        known = [n for n in recognised(file) if IMPORTERS.load(n).raw]
        if len(known) != 1:
            left += [f"{file.name}: no table by its content"] * (file.suffix != ".toml")
            continue
        try:
            parts, chosen = read_parts(file, known[0], own)
        except InputError as unread:
            left.append(str(unread))
            continue
        left += [f"{file.name}, {text}" for one in chosen for text in one.left]
        for part in parts:
            if why := why_no_table(part.raw):
                left.append(f"{file.name}: {why}")
            else:
                found.append((f"{file.stem} {part.name}".strip(), part.raw, part.importer, part.options))
        if len(found) > MOST:
            raise input_error("tables.too_many_tables", path, most=MOST)
    if not found or (wanted and left):
        if left:
            raise input_error("tables.folder_without_tables", path, left=" ".join(f"{text}." for text in left[:5]))
        return None
    names = _called([name for name, *_ in found]) if len(found) > 1 else [""]
    taken = dict.fromkeys(raw.path.name for _, raw, _, _ in found)
    why = f"the tables of the folder{f'; {len(left)} not taken' * bool(left)}"
    about = "Files of the folder that are read, with commas between; each becomes a table of the campaign"
    return tuple(
        Part(n, raw, importer, given) for n, (_, raw, importer, given) in zip(names, found, strict=True)
    ), () if wanted else (Chosen("files", ", ".join(taken), why, about, tuple(left)),)


def _by_names(unsaid: NoConditionError) -> Chosen:
    """The patterns of names of runs, with what they make of them."""
    patterns = [name_pattern(text) for text in unsaid.patterns]
    read = []
    for run in unsaid.runs:
        found = next((c for p in patterns if (c := p.conditions(run)) is not None), {})
        read.append(f"{run}: " + ", ".join(f"{key} = {one}".partition(" (name")[0] for key, one in found.items()))
    several = f"{len(patterns)} patterns, a table each; what a name does not say is zero there. " * (len(patterns) > 1)
    firsts = [
        next(t for t, run in zip(read, unsaid.runs, strict=True) if p.conditions(run) is not None) for p in patterns
    ]
    shown_first = "; ".join(firsts if len(patterns) > 1 else read[:2])
    return Chosen("names", BETWEEN.join(unsaid.patterns), shown_first,
                  f"Conditions by the names of the runs. {several}{'; '.join(read)}. {SPELT}.")  # fmt: skip


def _word_of(pattern: str) -> str:
    """The text before the first number of a pattern, or the setting that it gives."""
    found = re.match(r"[^{*]*", pattern)
    word = found[0].strip("_-. /") if found else ""
    return word or pattern.partition("{")[2].partition(":")[0] or "runs"


def _called(names: Sequence[str]) -> list[str]:
    """Names without slashes, brackets and equals, each once."""
    out: list[str] = []
    for name in names:
        plain = re.sub(r"[/=;?\[\]\s]+", "_", name).strip("_") or "table"
        out.append(plain if plain not in out else f"{plain}_{1 + sum(o.startswith(plain) for o in out)}")
    return out


def own(stated: Mapping[str, Value], part: Part, parts: Sequence[Part]) -> dict[str, Value]:
    """What is said of one part: of all together, and under its name."""
    others = tuple(f"{p.name}/" for p in parts if p.name)
    out = {key: value for key, value in stated.items() if not key.startswith(others)} if others else dict(stated)
    if part.name:
        out |= {key.removeprefix(f"{part.name}/"): v for key, v in stated.items() if key.startswith(f"{part.name}/")}
    return out


def require_parts(keys: Iterable[str], parts: Sequence[Part]) -> None:
    """Refuse keys of parts that are not there, and keys that one table of several cannot have.

    Raises
    ------
    InputError
        All of them.
    """
    names = [p.name for p in parts if p.name]
    strange = [key for key in keys if "/" in key and key.rpartition("/")[0] not in names]
    if strange:
        expected = (
            f"one of {', '.join(names)} before the slash" if names else "a key without a slash: there is one table"
        )
        raise together([InputError(shown(key), expected, column="--set") for key in strange])
    if shared := [key for key in keys if "/" in key and not key.rpartition("/")[2].startswith((*SPLIT, "axes.datum"))]:
        raise together([input_error(
            "tables.key_shared_by_tables", column="--set", whole=shown(key), plain=key.rpartition("/")[2], own_keys=OWN_KEYS,
            table=key.rpartition("/")[0],
        ) for key in shared])  # fmt: skip


def stated_together(parts: Sequence[Part]) -> dict[str, Setting]:
    """What the files state with certainty: plain where all agree, under the names of the parts where they differ."""
    each = [stated_settings(p.raw) for p in parts]
    out: dict[str, Setting] = {}
    for key in dict.fromkeys(k for one in each for k in one):
        values = {str(one[key].value) for one in each if key in one}
        if len(values) == 1 and (all(key in one for one in each) or not key.startswith(SPLIT)):
            out[key] = next(one[key] for one in each if key in one)
        else:
            out |= {f"{p.name}/{key}": one[key] for p, one in zip(parts, each, strict=True) if key in one}
    return out


def alike(parts: Sequence[Part]) -> list[tuple[str, ...]]:
    """Names of tables that have the same columns in the same units: parts of one sweep, or tests of two bodies."""
    found: dict[tuple[object, ...], list[str]] = {}
    for p in parts:
        found.setdefault(tuple((c.name, c.unit, c.means) for c in p.raw.columns), []).append(p.name)
    return [tuple(names) for names in found.values() if len(names) > 1]


def joined_tables(parts: Sequence[Part]) -> tuple[Part, ...]:
    """Tables of the same columns as one each, with a label that says which file or sheet a row is from.

    Raises
    ------
    InputError
        Their words say different speeds or densities.
    """
    by_name = {p.name: p for p in parts}
    out = {p.name: p for p in parts}
    for names in alike(parts):
        own = [by_name[n] for n in names]
        stated: dict[str, Stated] = {}
        for p in own:
            for key, one in p.raw.stated.items():
                before = stated.setdefault(key, replace(one, place=f"{p.name}, {one.place}"))
                if before.value != one.value:
                    raise input_error(
                        "tables.two_values_of_joined_tables", p.raw.path, value=before.value, place=before.place, other=one.value,
                        name=p.name, other_place=one.place, setting=key, join=JOIN,
                    )  # fmt: skip
        columns = []
        for many in zip(*(p.raw.columns for p in own), strict=True):
            texts = tuple(t for c in many for t in texts_of(c)) if any(c.is_text for c in many) else ()
            values = np.concatenate([c.values for c in many])
            columns.append(replace(many[0], values=values, texts=texts, digits=_digits_of(many)))
        origin = tuple(p.name for p in own for _ in range(len(p.raw)))
        columns.append(RawColumn("from", "", np.full(len(origin), np.nan), origin, "label"))
        first = own[0].raw
        raw = replace(
            first, columns=tuple(columns), lines=np.concatenate([p.raw.lines for p in own]), stated=stated,
            row_labels=tuple(f"{p.name} {label}" for p in own for label in p.raw.row_labels),
            files=tuple(dict.fromkeys(f for p in own for f in p.raw.files)),
            remarks=tuple(f"{p.name}: {text}" for p in own for text in p.raw.remarks),
            dialect={**first.dialect, JOIN: ", ".join(names)},
        )  # fmt: skip
        out[names[0]] = replace(own[0], name=_common(names), raw=raw)
        for n in names[1:]:
            del out[n]
    found = tuple(out.values())
    return found if len(found) > 1 else (replace(found[0], name=""),)


def _digits_of(files: Sequence[RawColumn]) -> Array:
    """The last digits of one column of several files, (n,): each file its own, one of too few numbers to show it the coarsest of all."""
    own = [c.rounding * UNIFORM for c in files]
    coarsest = np.max(np.concatenate(own)) or rounded_to(np.concatenate([c.values for c in files])) * UNIFORM
    few = (c.digits is None and np.count_nonzero(np.nan_to_num(c.values)) < FEWEST for c in files)
    return np.concatenate([np.full(len(d), coarsest) if f else d for d, f in zip(own, few, strict=True)])


def _common(names: Sequence[str]) -> str:
    """What all names begin with, without what separates it from the rest."""
    alike = takewhile(lambda letters: len(set(letters)) == 1, zip(*names, strict=False))
    return "".join(letters[0] for letters in alike).rstrip("_-. ") or names[0]


def with_shared_words(parts: Sequence[Part]) -> tuple[Part, ...]:
    """Words over one table count for all, and are open where those of two tables differ; speeds and densities may differ."""
    if len(parts) < 2:
        return tuple(parts)
    stated = [dict(p.raw.stated) for p in parts]
    if any(POINT_FROM in one for one in stated):  # a point by its name alone is one at no distance from it
        for one in stated:
            if (named := one.get("axes.datum")) and named.offered and not {POINT_FROM, POINT_OF} & set(one):
                one[POINT_FROM] = replace(named, value=f"0 m {named.value}")
    for key in dict.fromkeys(k for one in stated for k in one):
        have = [(p, one[key]) for p, one in zip(parts, stated, strict=True) if key in one]
        if not all(s.offered for _, s in have):
            continue
        placed = {p.name: replace(s, place=f"{p.name}, {s.place}") for p, s in have}
        if key.startswith(("table.", HALF_MODEL)):
            for p, one in zip(parts, stated, strict=True):
                if p.name in placed:
                    one[key] = placed[p.name]
            continue
        if silent := [p.name for p in parts if p.name not in placed]:
            placed = {
                n: replace(s, place=f"{s.place}, for {listed(silent)} too, without words of its own")
                for n, s in placed.items()
            }
        values = {str(s.value) for _, s in have}
        split = key in ("conditions.speed", "conditions.density")
        for p, one in zip(parts, stated, strict=True):
            first = placed.get(p.name) or next(iter(placed.values()))
            if len(values) > 1 and (not split or p.name not in placed):
                a, b = (next(s for s in placed.values() if str(s.value) == v) for v in sorted(values)[:2])
                first = replace(first, contradicted=f"{a.place}, but {b.place}")
            one[key] = first
    return tuple(replace(p, raw=replace(p.raw, stated=one)) for p, one in zip(parts, stated, strict=True))

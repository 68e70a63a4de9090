"""From a table as its file has it to columns in SI: what each column is, by the campaign, its format or nobody."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import Axes
from coeflab.core.errors import InputError, UnitsError, shown, together
from coeflab.core.limits import LARGEST_NUMBER
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief
from coeflab.core.units import factor, fits
from coeflab.core.wording import Verbatim, listed
from coeflab.law.symbols import COMPONENTS
from coeflab.tables.campaign import Campaign, TableDeclaration
from coeflab.tables.column_map import (
    EXAMPLES,
    OPEN_SIZES,
    PER,
    WORDS,
    ColumnMap,
    counted_in,
    read_column_map,
    share,
    unturned,
)
from coeflab.tables.columns import Columns
from coeflab.tables.dialect import Marks
from coeflab.tables.force_table import ForceTable
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.levels import APART, levels_of
from coeflab.tables.raw_table import ONE_FLOW, RawColumn, RawTable
from coeflab.tables.to_frd import BLANK, SAME_DENSITY, force_table, speed_of_rows
from coeflab.tables.vocabulary import folded, vocabulary
from coeflab.tables.words.axes import BODY_AXES

SETTINGS = ("angle", "velocity", "control", "speed", "radius", "density")
REMARKS = 5
ALL = "all"
NO_FORCE = "no force column"
MARKS = re.compile(r"[*!?#\u2020\u2021x]{1,3}\)?")  # of a row that somebody doubts
MOST_NAMED = 20
PURE = ("", "-", "1")
FASTEST = 30.0  # Mach number; beyond it a column is none
INCOMPRESSIBLE = 0.3  # Mach number up to which a prime does not depend on it
SAME_VISCOSITY = 1e-2  # relative: by less than a degree of temperature


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Assigned:
    """A column of a file and what it is.

    Attributes
    ----------
    column : RawColumn
    meaning : ColumnMap
        Its unit is known.
    factor : float
        Makes SI of the file's numbers, with the sign; of primes and coefficients the sign only.
    """

    column: RawColumn
    meaning: ColumnMap
    factor: float = 1.0

    @property
    def values(self) -> Array:
        """SI, primes or coefficients; NaN where the file has no number, or one out of all bounds."""
        with np.errstate(over="ignore", invalid="ignore"):
            out = self.column.values * self.factor
            return np.where(np.abs(out) <= LARGEST_NUMBER, out, np.nan)


def header(column: RawColumn) -> str:
    """Name and unit of a column as messages write them."""
    return f"{column.name} [{column.unit}]" if column.unit else column.name


def known_as(column: RawColumn) -> tuple[str, ...]:
    """By which keys a mapping may name the column: its name alone, or with its unit."""
    name = " ".join(column.name.split())
    return name, f"{name} [{column.unit}]", f"{name} ({column.unit})"


def meaning_of(column: RawColumn, mapping: Mapping[str, ColumnMap], columns: Sequence[RawColumn]) -> ColumnMap | None:
    """What a mapping says of a column of a table, or of the force whose standard error it is; None where it says nothing."""
    for name in (column.name, *known_as(column)):
        if name in mapping:
            return mapping[name]
    of_format = (c for c in columns if c.means and column.means.split()[:1] == [f"se_{c.means.split()[0]}"])
    forces = [column.name.removeprefix("se_")] * column.name.startswith("se_")
    of = next(
        (mapping[n] for n in (*forces, *(n for c in of_format for n in (c.name, *known_as(c)))) if n in mapping), None
    )
    if of is None:
        return None
    return replace(of, error=True, negative=False) if of.role == "force" else ColumnMap("ignore")


def entry_of(column: RawColumn, mapping: Mapping[str, ColumnMap], columns: Sequence[RawColumn]) -> ColumnMap | None:
    """What a mapping says of a column, `meaning_of`, else what its format fixes, else None."""
    given = meaning_of(column, mapping, columns)
    if given is not None or not column.means:
        return given
    try:
        return read_column_map(column.means)
    except InputError:
        return ColumnMap("label")  # the format knows what it is, and no fit uses it


def declared_mapping(campaign: Campaign, table: TableDeclaration) -> Mapping[str, ColumnMap]:
    """What a campaign says of the columns of a table: ``[columns]``, and labels, ignore and cells of the ``[[table]]``."""
    words = {"label": table.labels, "ignore": table.ignore, "cells": (table.cells,) if table.cells else ()}
    return {**campaign.columns, **{name: ColumnMap(word) for word, names in words.items() for name in names}}


def assigned(raw: RawTable, mapping: Mapping[str, ColumnMap], whole: bool = True) -> tuple[Assigned, ...]:
    """What every column of a table is.

    Parameters
    ----------
    raw : RawTable
    mapping : mapping of str to ColumnMap
        By the names of the file.
    whole : bool
        Refuse an entry whose column the file lacks.

    Raises
    ------
    InputError
        Every column that nothing is known of, that has no unit or an impossible one, or that another one doubles.
    """
    out: list[Assigned] = []
    complaints: list[InputError] = []
    taken: dict[str, str] = {}
    for column in raw.columns:
        given = entry_of(column, mapping, raw.columns)
        if given is None:
            complaints.append(fault("tables.unidentified_column", raw, column, own=shown(column.name)))
            continue
        if given.name not in ("label", "ignore"):
            if given.plain in taken:
                found = f"{shown(taken[given.plain])} and {shown(column.name)} as {given.plain}"
                complaints.append(fault("tables.two_columns_of_a_name", raw, column, found=found))
            taken[given.plain] = column.name
        if given.name == "ignore":
            continue
        try:
            out.append(with_unit(raw, column, given))
        except InputError as why:
            complaints.append(why)
    names = {name for column in raw.columns for name in (column.name, *known_as(column))}
    for name in (n for n in mapping if whole and n not in names):
        near = difflib.get_close_matches(name, [c.name for c in raw.columns], n=1)
        have = ", ".join(shown(c.name) for c in raw.columns[:MOST_NAMED])
        complaints.append(
            input_error(
                "tables.no_such_column", raw.path, raw.header_line or None, name=shown(name), have=have,
                near=f"Did you mean {shown(near[0])}?" if near else "",
            )
        )  # fmt: skip
    if not any(a.meaning.role == "force" for a in out) and not complaints:
        complaints.append(InputError(NO_FORCE, "at least one of X Y Z K M N", file=raw.path))
    if complaints:
        raise together(complaints)
    return tuple(out)


def fault(code: str, raw: RawTable, column: RawColumn, row: int | None = None, **facts: Any) -> InputError:
    """An error about a column of the file, or one cell of it, to be raised by the caller."""
    line = raw.header_line if row is None else int(raw.lines[row]) if len(raw.lines) else row + 1
    where = f" in {row_name(raw, row)}" if row is not None and raw.path.is_dir() else ""
    return input_error(code, raw.path, (not raw.path.is_dir() and line) or None, header(column), where=where, **facts)


def with_unit(raw: RawTable, column: RawColumn, meaning: ColumnMap) -> Assigned:
    """The column with the unit that the mapping gives, else the file's own.

    Raises
    ------
    InputError
        No unit, an impossible one, or two that do not agree; no number in the column.
    """
    sign = -1.0 if meaning.negative else 1.0
    if meaning.name == "cells" and (bad := np.flatnonzero(column.values <= 0.0)).size:
        raise fault("tables.no_count_of_cells", raw, column, row=int(bad[0]), values=column.values[bad[0]])
    if meaning.name in WORDS:
        return Assigned(column, meaning)
    if not np.any(np.isfinite(column.values)):
        example = f", such as {shown(column.texts[0])}" if column.texts else ""
        raise fault("tables.no_number_in_column", raw, column, example=example)
    if meaning.pure:
        stated = column.unit.strip(" -1")
        if fits(stated, meaning.dimension):
            raise fault("tables.unit_of_pure_number", raw, column, unit=column.unit, said=meaning)
        by_header = counted_in(column.name, column.unit)[1]
        counted, declared = share(by_header), share(meaning.unit)
        if not declared if by_header == "?" else counted is None and any(ch.isdigit() for ch in stated):
            raise fault("tables.digits_in_a_unit", raw, column, unit=header(column), said=meaning)
        if declared and stated and counted is not None and counted != declared:
            raise fault(
                "tables.two_units", raw, column, unit=column.unit, meant=meaning.unit, plain=replace(meaning, unit="-")
            )
        return Assigned(column, meaning, sign * (declared or counted or 1.0))
    if meaning.unit == OPEN_SIZES:
        raise fault(
            "tables.coefficient_without_area",
            raw,
            column,
            said=meaning,
            plain=meaning.plain,
            per=PER[meaning.dimension],
        )
    own = factor(column.unit, meaning.dimension) if fits(column.unit, meaning.dimension) else None
    unit = meaning.unit or column.unit
    if not unit or (unit == "-" and not meaning.unit):
        example = EXAMPLES[meaning.dimension]
        pure = f"; or {meaning.plain}' for a prime" if meaning.role in ("force", "velocity", "error") else ""
        pure += (
            f", {meaning.plain} [{PER[meaning.dimension]}] for a coefficient"
            if meaning.role in ("force", "error")
            else ""
        )
        raise fault(
            "tables.column_of_no_unit", raw, column, found="no unit" if not unit else "[-]", dimension=meaning.dimension,
            own=shown(column.name), said=meaning, example=example, pure=pure,
        )  # fmt: skip
    try:
        size = factor(unit, meaning.dimension)
    except UnitsError as why:
        raise why.at(raw.path, raw.header_line or None, header(column)) from None
    if meaning.unit and own is not None and abs(own / size - 1.0) > 1e-9:
        raise fault(
            "tables.two_units", raw, column, unit=column.unit, meant=meaning.unit, plain=replace(meaning, unit="")
        )
    return Assigned(column, replace(meaning, unit=unit), sign * size / (meaning.ship**0.5 or 1.0))


def along_the_flow(
    raw: RawTable, mapping: Mapping[str, ColumnMap], frame: Axes | None
) -> Iterator[tuple[RawColumn, ColumnMap, ColumnMap]]:
    """Forces of a body that is turned in one inflow, along that flow or along the body: columns with either meaning, while nobody has named one.

    Parameters
    ----------
    raw : RawTable
    mapping : mapping of str to ColumnMap
        What a person says of columns.
    frame : Axes, optional
        Of the file; y to starboard and z up where nobody has said it.
    """
    flow, of = raw.stated.get(ONE_FLOW), {c: one for c in COMPONENTS if (one := raw.meaning(c)) is not None}
    given = {c: meaning_of(column, mapping, raw.columns) for c, column in of.items()}
    if flow is None or ((x := given.get("X")) is not None and x.name == "X"):
        return
    turned = "".join(a for a in ("alpha", "beta") if (angle := raw.meaning(a)) is not None and np.any(angle.values))
    starboard, up = (1.0, 1.0) if frame is None else (frame.rotation[1][1], -frame.rotation[2][2])
    along = -float(str(flow.value))
    wind: dict[str, tuple[str, float]] = {"X": ("drag", along), "Y": ("side", starboard), "Z": ("lift", up)}
    still = {"beta": "ZKM", "alpha": "YKN"}.get(turned, "KMN")
    for component, column in of.items():
        if given[component] is None and (component in wind or component in still):
            name, sign = ("ignore", 1.0) if component in still else wind[component]
            plain = ColumnMap(component, column.unit)
            yield column, replace(plain, name=name, negative=sign < 0.0, unit=column.unit * (name != "ignore")), plain


def usable_rows(raw: RawTable, columns: Sequence[Assigned]) -> NDArray[np.int64]:
    """Rows with a number in every setting, of the level that a label wants, and of several Mach numbers those of the lowest."""
    blank = [_lacking(one) for one in columns if one.meaning.role in SETTINGS]
    return np.flatnonzero(
        ~np.logical_or.reduce([at_higher_mach(raw, columns)[1], *blank, *map(_of_another_level, columns)])
    )


def at_higher_mach(raw: RawTable, columns: Sequence[Assigned]) -> tuple[str, NDArray[np.bool_]]:
    """The column of a Mach number, where nobody uses it, and the rows above `INCOMPRESSIBLE`, else above its lowest level.

    A prime holds at one Mach number; rows of several in one sweep would give a slope of none of them. Rows without one, or at zero, stay.

    Parameters
    ----------
    raw : RawTable
    columns : sequence of Assigned
    """
    used = {one.column.name for one in columns}
    for one in (c for c in raw.columns if c.name not in used and c.unit in PURE):
        known = one.values[np.isfinite(one.values) & (one.values != 0.0)]  # zero: at rest, wind off
        if not known.size or known.min() < 0.0 or known.max() > FASTEST:
            continue
        level = levels_of(known)
        by_levels = one.name.strip() == "M" and known.size == len(raw) and level.max() < len(raw) / 2
        if not (by_levels or folded(one.name) in vocabulary().lists["mach"]):
            continue
        lowest = min(
            float(known[level == 0].max()), float(known.min()) * (1.0 + 2.0 * APART)
        )  # of a sweep in small steps too
        higher = one.values > max(INCOMPRESSIBLE, lowest)
        if np.any(higher):
            return one.name, higher
    return "", np.zeros(len(raw), dtype=bool)


def without_a_setting(raw: RawTable, columns: Sequence[Assigned]) -> Iterator[str]:
    """Rows without a setting, in a sentence for each column that lacks it, and those of higher Mach numbers."""
    for one in columns:
        if one.meaning.role not in SETTINGS:
            continue
        blank = np.flatnonzero(_lacking(one))
        if blank.size:
            above = " above zero" * (one.meaning.role == "speed" and not np.all(np.isnan(one.values[blank])))
            yield f"left out, no {one.column.name}{above}: {places(raw, blank)}"
    for one in columns:
        if (other := np.flatnonzero(_of_another_level(one))).size:
            yield f"left out, another {one.column.name} than {one.meaning.unit}: {places(raw, other)}"
    mach, higher = at_higher_mach(raw, columns)
    if mach:
        yield f'left out, above the lowest {mach}: {places(raw, np.flatnonzero(higher))}; --map "{mach}=label" takes all'


def _of_another_level(one: Assigned) -> NDArray[np.bool_]:
    """Rows of another level than a label wants; none where it wants no one."""
    wanted, values = one.meaning.unit if one.meaning.name == "label" else "", one.column.values
    if not wanted:
        return np.zeros(len(values), dtype=bool)
    number = Marks().number(wanted)
    if one.column.texts or number is None:
        return np.array([text.strip() != wanted for text in texts_of(one.column)], dtype=bool)
    return ~(np.abs(values - number) <= APART / 10.0 * abs(number))


def _lacking(one: Assigned) -> NDArray[np.bool_]:
    """Rows without a number in a setting, or at rest where others move: of those nothing can be primed."""
    moving = np.nan_to_num(one.values) != 0.0
    return np.asarray(~moving if one.meaning.role == "speed" and np.any(moving) else np.isnan(one.values))


def places(raw: RawTable, rows: Sequence[int] | NDArray[np.int64]) -> str:
    """Rows as a reader of the file finds them: lines, at most a few, and how many more."""
    shown_ = [row_name(raw, int(row)) for row in rows[:REMARKS]]
    more = [f"{len(rows) - REMARKS} more"] if len(rows) > REMARKS else []
    return listed([*shown_, *more])


def row_name(raw: RawTable, row: int) -> str:
    """One row: its line, or its name, or its number."""
    if len(raw.lines):
        return f"line {raw.lines[row]}"
    return raw.row_labels[row] if raw.row_labels else f"row {row + 1}"


def texts_of(column: RawColumn) -> list[str]:
    """A column as texts; numbers as they read best."""
    if column.texts:
        return [Verbatim(text) for text in column.texts]
    return [Verbatim("" if np.isnan(x) else f"{x:.12g}") for x in column.values.tolist()]


def _columns(raw: RawTable, known: Sequence[Assigned], campaign: Campaign) -> Columns:
    rows = usable_rows(raw, known)
    if not rows.size:
        raise input_error("tables.no_row_with_settings", raw.path)
    given: dict[str, dict[str, Array]] = {r: {} for r in (*SETTINGS, "error", "force", "propeller", "rounding")}
    primes: dict[str, Array] = {}
    for one in known:
        if one.meaning.role in given:
            values = one.values[rows]
            given[one.meaning.role][one.meaning.name] = values
            if one.meaning.role == "force":
                given["rounding"][one.meaning.name] = one.column.rounding[rows] * abs(one.factor)
            if one.meaning.primed and one.meaning.role == "velocity":
                primes[one.meaning.name] = values
    own = {name: values for name, values in given["velocity"].items() if name not in primes}
    speed = speed_of_rows(given["speed"].get("U"), own, primes, campaign, len(rows), bool(given["angle"]))
    density = given["density"].get("density", np.full(len(rows), campaign.conditions.density))
    for one in known:
        unit = speed**2 if one.meaning.per_speed else np.ones(len(rows))
        if one.meaning.pure:
            of_area = 0.5 * density * speed**2 * one.meaning.area * (one.meaning.length or 1.0)
            unit = unit * (
                of_area if one.meaning.area else campaign.scaling.unit(one.meaning.component, density, speed)
            )
        if one.meaning.per_speed or one.meaning.pure:
            for role in (one.meaning.role, *(["rounding"] if one.meaning.role == "force" else [])):
                given[role][one.meaning.name] = given[role][one.meaning.name] * unit
    lines = raw.lines[rows] if len(raw.lines) else rows + 1
    point = next((texts_of(one.column) for one in known if one.meaning.name == "point"), list(raw.row_labels))
    if not point and not len(raw.lines):
        point = [f"row {row + 1}" for row in range(len(raw))]
    numbered = {one.meaning.name: one.values[rows] for one in known if one.meaning.role == "force"}
    blank = {name: np.isnan(values) for name, values in numbered.items()}
    words = doubtful(raw, known)
    return Columns(
        file=raw.path,
        header_line=raw.header_line,
        lines=tuple(int(line) for line in lines),
        headers={one.meaning.plain: header(one.column) for one in known if one.meaning.name not in WORDS},
        angles=given["angle"],
        velocity=given["velocity"],
        controls=given["control"],
        speed=speed,
        forces=given["force"],
        errors=given["error"],
        rounding=given["rounding"],
        labels={one.column.name: _taken(texts_of(one.column), rows) for one in known if one.meaning.name == "label"},
        doubtful=tuple(frozenset(n for n, mask in blank.items() if mask[i]) | words[row] for i, row in enumerate(rows)),
        row_labels=tuple(_taken(point, rows)) if point else (),
        files=raw.files,
        radius=given["radius"].get("R"),
        density=given["density"].get("density"),
        propeller=given["propeller"],
    )


def doubtful(raw: RawTable, known: Sequence[Assigned]) -> list[frozenset[str]]:
    """For every row of the file the plain names that its column ``uncertain`` names; ``all`` are all forces and moments.

    A column may go by its name in the file, between semicolons where it has blanks; one that nobody uses counts for nothing.
    A mark such as * is all of them, in that column or behind the name or label of a row.

    Raises
    ------
    InputError
        A word that is the name of no column.
    """
    column = next((one.column for one in known if one.meaning.name == "uncertain"), None)
    names = {one.meaning.name for one in known if one.meaning.name not in WORDS}
    forces = frozenset(one.meaning.name for one in known if one.meaning.role == "force")
    starred = _starred(known, len(raw))
    if column is None:
        return [forces if star else frozenset() for star in starred]
    used = {one.column.name for one in known}
    own = {n: "" for c in raw.columns for n in (c.name, c.means) if n and n not in used | names | {ALL}}
    own |= {one.column.name: one.meaning.name for one in known if one.meaning.name in names and not one.meaning.error}
    out = []
    for row, text in enumerate(texts_of(column)):
        if starred[row] or MARKS.fullmatch(text.strip()):
            out.append(forces)
            continue
        words: set[str] = set()
        for part in map(str.strip, text.split(";")):
            single = [part] if part in own else part.replace(",", " ").split()
            words |= {own.get(word, word.removesuffix("'")) for word in single}
        words.discard("")
        words = words - {ALL} | forces if ALL in words else words
        if strange := sorted(words - names):
            raise fault(
                "tables.no_column_doubted", raw, column, row=row, strange=shown(strange[0]), all=ALL, names=", ".join(sorted(names)),
            )  # fmt: skip
        out.append(frozenset(words))
    return out


def _starred(known: Sequence[Assigned], rows: int) -> NDArray[np.bool_]:
    """Rows whose name or label ends in a star, where less than half do."""
    out = np.zeros(rows, dtype=bool)
    for one in known:
        if one.meaning.name in ("point", "label") and one.column.is_text:
            stars = np.array([text.rstrip(") ").endswith("*") for text in one.column.texts], dtype=bool)
            if 2 * stars.sum() < rows:
                out |= stars
    return out


def _taken(texts: Sequence[str], rows: NDArray[np.int64]) -> list[str]:
    return [texts[row] for row in rows]


def another_density(raw: RawTable, known: Sequence[Assigned], density: float) -> InputError | None:
    """The complaint where forces were computed with a density that the file states, and another one is declared.

    Primes divide by the declared density: with rhoInf 1 of a solver and 998.2 here they would be 1/998 of what they are.
    """
    given = raw.stated.get("conditions.density")
    own = any(one.meaning.name == "density" for one in known)
    in_newton = any(one.meaning.role == "force" and not one.meaning.pure for one in known)
    if given is None or given.offered or not isinstance(given.value, float) or own or not in_newton:
        return None
    if abs(density - given.value) <= SAME_DENSITY * abs(given.value):
        return None
    advice = f"Leave conditions.density at {given.value:g}: primes are right with the density of the forces."
    importer = raw.dialect.get("importer")
    if importer and hasattr(IMPORTERS.load(importer).Options, "density"):
        advice = (
            f"Leave it out, primes are right with {given.value:g}; or turn the forces: --option density={density:g}."
        )
    return input_error(
        "tables.another_density", raw.path, column="conditions.density", density=density, value=given.value, place=given.place,
        advice=advice,
    )  # fmt: skip


def another_viscosity(raw: RawTable, viscosity: float) -> InputError | None:
    """The complaint where a solver ran with a viscosity that the file states, and another one is declared."""
    given = raw.stated.get("conditions.viscosity")
    if given is None or given.offered or not isinstance(given.value, float):
        return None
    if abs(viscosity - given.value) <= SAME_VISCOSITY * abs(given.value):
        return None
    return input_error(
        "tables.another_viscosity", raw.path, column="conditions.viscosity", viscosity=viscosity, value=given.value, place=given.place,
    )  # fmt: skip


def _found(one: Assigned | None, row: int) -> str:
    """Why a force cell gives no number: what is written there, or that there is none."""
    text = one.column.texts[row].strip() if one is not None and np.isnan(one.values[row]) else ""
    try:
        float(text or "nan")
    except ValueError:
        return f"{shown(text)} is no number"
    return "no number in the source"


def mapped_table(raw: RawTable, campaign: Campaign, table: TableDeclaration) -> ForceTable:
    """A table in SI and FRD from its file and the ``[columns]`` of its campaign; what was left out stands in its notes.

    Raises
    ------
    InputError
        All that is wrong with the columns; then a cell that cannot be, or what campaign.toml leaves open.
    """
    mapping = declared_mapping(campaign, table)
    for column, flow, own in along_the_flow(raw, mapping, campaign.axes):
        raise fault("tables.turned_in_one_flow", raw, column, flow=flow, body=own, place=raw.stated[ONE_FLOW].place)
    known = assigned(raw, mapping, len(campaign.tables) == 1)
    if why := another_density(raw, known, campaign.conditions.density):
        raise why
    columns = _columns(raw, known, campaign)
    out = force_table(columns, campaign, table)
    rows = usable_rows(raw, known)
    written = {one.meaning.name: one for one in known if one.meaning.role == "force" and one.column.texts}
    exclusions = tuple(
        replace(e, reason=e.reason.replace(BLANK, _found(written.get(e.component), int(rows[e.row]))))
        if e.component and not e.uncertain
        else e
        for e in out.exclusions
    )
    body = BODY_AXES in raw.stated
    warned = [f"warning: {text}" for one in known if not body and (text := unturned(one.column.name, one.meaning))]
    words = [*warned, *without_a_setting(raw, known), *raw.remarks]
    more = [f"{len(words) - REMARKS} more remarks; coeflab inspect lists them"] if len(words) > REMARKS else []
    cells = next((one.values[rows] for one in known if one.meaning.name == "cells"), None)
    notes = (*out.notes, *words[:REMARKS], *more)
    out = replace(out, exclusions=exclusions, notes=notes, cells=cells, uncertainty=campaign.uncertainty)
    return out if cells is None else out.on_one_grid()

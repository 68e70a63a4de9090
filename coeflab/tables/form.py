"""The form of ``coeflab import``: all that makes a file a campaign on one screen, and what a person types into it."""

from __future__ import annotations

import re
import shlex
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import IntEnum

import numpy as np

from coeflab.core.errors import InputError, shown, together
from coeflab.core.table import folded
from coeflab.core.texts import input_error
from coeflab.tables.column_map import ColumnMap, read_column_map
from coeflab.tables.interpretation import Doubt, Interpretation
from coeflab.tables.mapping import with_unit
from coeflab.tables.proposals import OPEN, Proposal
from coeflab.tables.questions import Question, names_in_order, without_unit
from coeflab.tables.raw_table import HALF_MODEL, RawColumn, RawTable
from coeflab.tables.settings import (
    EXTRA,
    SYMMETRY,
    VISCOSITY,
    Setting,
    Settings,
    read_in,
    require_one_datum,
    reynolds,
)  # fmt: skip

MANY = 20  # columns, beyond which those that no fit uses have no line
AGAINST = "! but "  # before a line of the file that a setting contradicts
KEY, VALUE = 25, 22  # letters
DECISIVE = (HALF_MODEL, SYMMETRY)  # of the keys of the campaign: what decides numbers
GRAVE = ("axes.", "table.", "inertia.", "coefficients.", *DECISIVE)
UNSHOWN = ("campaign.", "source.how_obtained", "table.source", "table.labels", "table.cells")


class Group(IntEnum):
    """Parts of the form, in their order."""

    OPEN = 0
    GRAVE = 1
    COLUMN = 2
    FURTHER = 3


TITLES = {
    Group.OPEN: "? Open: nothing in the file says these",
    Group.GRAVE: "Axes, signs, points, inertia{whole}: accepting confirms these",
    Group.COLUMN: "Columns",
    Group.FURTHER: "Further",
}


@dataclass(frozen=True, slots=True)
class Line:
    """One key of the form.

    Attributes
    ----------
    key : str
        Of campaign.toml, or the name of a column.
    value : str
        What is said or proposed; empty where it is open.
    why : str
        What it rests on in a few words; the choices where it is open.
    group : Group
    about : str
        The long explanation.
    argument : str
        What says it on the command line, with ``?`` in the place of what is open.
    pending : bool
        Somebody has to accept it.
    number : int
        By which a person names it, which stays as long as the form is asked.
    """

    key: str
    value: str
    why: str
    group: Group
    about: str = ""
    argument: str = ""
    pending: bool = False
    number: int = 0


def argument(option: str, key: str, text: str) -> str:
    """An argument of the command line as a shell takes it."""
    return f"{option} {quoted(f'{key}={text}')}"


def quoted(text: str) -> str:
    """A word as a shell takes it; primes in double quotes."""
    plain = "'" in text and not set(text) & set('"$`\\!\n')
    return f'"{text}"' if plain else shlex.quote(text)


def is_shown(key: str) -> bool:
    """Whether the form has a line for a setting."""
    return key in DECISIVE or not key.startswith(UNSHOWN)


def question_line(q: Question) -> Line:
    """The line of a key that nobody has said."""
    group = Group.OPEN if q.open else Group.GRAVE if q.grave else Group.FURTHER
    value, why = q.default or q.shown, (q.short or q.why) if not q.open else q.choices
    about = q.asks + (f". Proposed: {value}, {q.why or q.short}" if value else "")
    return Line(q.key, value, why, group, f"{about}.", argument("--set", q.key, q.default or OPEN), not q.harmless)


def setting_line(key: str, one: Setting, about: str, against: str) -> Line:
    """The line of a key that is known; ``against`` is a line of the file that says something else."""
    group = Group.GRAVE if key.startswith(GRAVE) else Group.FURTHER
    value = ", ".join(map(str, one.value)) if isinstance(one.value, list) else str(one.value)
    why = f"{AGAINST}{against}" if against else one.origin.replace("confirmed", "said")
    return Line(key, value, why, group, f"{about}. It is {value}: {one.origin}.")


def with_reynolds(line: Line, settings: Settings) -> Line:
    """The line of the viscosity with its unit and the Reynolds number, which show a dynamic one; any other as it is."""
    if line.key.rpartition("/")[2] != VISCOSITY:
        return line
    number = reynolds(settings)
    value = line.value if line.value.endswith("s") else f"{line.value} m^2/s"
    words = "kinematic" if number is None else f"kinematic, Re = {number:.3g}"
    return replace(line, value=value, why=f"{words}; {line.why}")


def column_lines(raw: RawTable, found: Interpretation) -> Iterator[Line]:
    """The lines of the columns."""
    doubts = {d.column.name: d for d in found.doubts}
    still = {column.name: offer for column, offer in found.open}
    nothing = len(still) == len(raw.columns) > 1 and {o.text for o in still.values()} <= {"", "ignore", "point"}
    if nothing and not raw.header_line:
        names = names_in_order()
        yield Line("columns", "", names.choices, Group.OPEN, names.asks, argument("--option", "columns", OPEN), True)
        return
    for column, offer in zip(raw.columns, found.proposals, strict=True):
        name, span = column.name, _span(column)
        if offer.certain and name in raw.dialect:  # told in the head of the form
            continue
        if name in doubts:
            yield _doubtful(doubts[name])
        elif name in still and not offer.whole and (own := name.removeprefix("se_")) != name and own in still:
            yield Line(
                name, "", f"the standard error of {own}, whatever that is{span}", Group.COLUMN, f"Column {shown(name)}."
            )
        elif name in still:
            missing = _covered(offer)
            group = Group.COLUMN if offer.whole or missing else Group.OPEN
            why = f"{offer.why.partition(';')[0]}{span}" if group is Group.COLUMN else _unread(raw, offer)
            if offer.note and group is Group.COLUMN:
                group, why = Group.GRAVE, offer.note
            text = offer.text.replace("coefficient A=?", "coefficient")
            about = f'Column "{name}": {offer.text or "not known"}; {offer.why}. Say such as Y [N], -beta [deg], r\' [-], label or ignore.'
            yield Line(
                name, "" if group is Group.OPEN else text, missing or why, group, about,
                argument("--map", name, offer.text or OPEN), True,
            )  # fmt: skip
        elif (given := found.mapping.get(name)) is not None and not (
            given.name == "ignore" and len(raw.columns) > MANY
        ):
            by = "accepted" if name in found.accepted else "said"
            why = offer.why.partition(";")[0] if offer.certain else by
            yield Line(name, str(given), why + span, Group.COLUMN, f'Column "{name}": {given}; {offer.why}.')


def _unread(raw: RawTable, offer: Proposal) -> str:
    """Why a column is open; a unit that nobody knows by the line where it stands."""
    if offer.unread:
        place = f"line {raw.header_line}: " if raw.header_line and raw.dialect.get("units") == "in the header" else ""
        return place + offer.why.partition("; ")[2]
    return offer.why.replace("; no unit is stated", "; unit?")


def _covered(offer: Proposal) -> str:
    """By which key what a proposal lacks is said for all columns; empty where it lacks nothing, or something of its own."""
    if offer.whole:
        return ""
    if "coefficient" in offer.text:
        return "by coefficients.area" + " and .length" * ("L=?" in offer.text)
    return "by columns.units" if without_unit(offer) else ""


def _doubtful(doubt: Doubt) -> Line:
    turned, selected = (str(replace(doubt.meaning, negative=negative)) for negative in (True, False))
    if doubt.instead is not None:
        turned = str(doubt.instead)
    name = doubt.column.name
    turns = f"; {name} > 0 then {doubt.turns}" * bool(doubt.turns)
    about = f'Column "{name}": {doubt.why}. {turned} turns its sign, {selected} keeps it{turns}.'
    if doubt.instead is not None:
        about = f'Column "{name}": {turned} or {selected}: {doubt.why}.'
    if doubt.another:
        about = f'Column "{name}": {doubt.why}. {turned} {doubt.turns} where {name} > 0, {selected} the other way.'
    return Line(
        name, "", f"{turned} or {selected}: {doubt.why}", Group.OPEN, about, argument("--map", name, OPEN), True
    )


def _span(column: RawColumn) -> str:
    known = column.values[np.isfinite(column.values)]
    if not known.size:
        return ""
    blank = len(column.values) - known.size
    return f"; {known.min() + 0.0:.4g} to {known.max() + 0.0:.4g}" + f", {blank} blank" * bool(blank)


def open_lines(lines: Sequence[Line]) -> list[Line]:
    """Those that somebody has to say."""
    return [line for line in lines if line.group is Group.OPEN]


_LONG_NUMBER = re.compile(r"\d+\.\d{7,}")


def screen(lines: Sequence[Line], changed: Collection[str] = (), width: int = 80, most_lines: int = 99) -> list[str]:
    """The form as text: number, key, value, why; ``>`` before what has changed.

    Parameters
    ----------
    lines : sequence of Line
    changed : collection of str
        Keys.
    width : int
        Letters of a line.
    most_lines : int
        Of an open key.
    """
    out: list[str] = []
    most = max((min(len(line.key), KEY) for line in lines), default=0)
    for group in Group:
        if not (own := [line for line in lines if line.group is group]):
            continue
        undoubled = "" if any(line.key.endswith("half_model") for line in lines) else ", forces of the whole body"
        out.append(TITLES[group].format(whole=undoubled))
        for line in own:
            head = f"{'>' if line.key in changed else ' '}{line.number:3d}{'?' if group is Group.OPEN else ' '} {_cut(line.key, KEY):<{most}}  "
            text = _LONG_NUMBER.sub(lambda m: f"{float(m[0]):.6g}", _one_line(line.value))
            if group is Group.OPEN:
                whole = folded(line.why, width - 1, head, " " * len(head))
                out += whole[:most_lines] if "." in line.key else whole[:3]
                continue
            room = width - 1 - len(head) - 2 - max(len(text), VALUE)
            decides = (
                group is not Group.COLUMN
                and ("." in line.key or line.argument.startswith("--map"))
                and (line.pending or line.why.startswith((AGAINST, "line ")))
            )
            if decides and len(_one_line(line.why)) > room and len(head) + len(text) < width // 2 + VALUE:
                out += folded(f"{text}  {line.why}", width - 1, head, " " * (len(head) + 2), whole=False)
            elif decides and len(_one_line(line.why)) > room:
                below = " " * (len(head) + 2)
                out += folded(text, width - 1, head, " " * len(head))
                out += folded(line.why, width - 1, below, below, whole=False)
            elif len(text) > VALUE and room < min(len(line.why), 12):
                out += folded(text, width - 1, head, " " * len(head))
            else:
                out.append(f"{head}{text:<{VALUE}}  {_cut(line.why, room)}".rstrip())
    return out


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _cut(text: str, most: int) -> str:
    flat = _one_line(text)
    return flat if len(flat) <= most else flat[: max(most - 2, 0)].rstrip(" ,;:(") + " …" * (most > 2)


@dataclass(slots=True)
class Typed:
    """What a person typed into the form.

    Attributes
    ----------
    columns : dict of str to ColumnMap
    settings : dict of str to Setting
    options : dict of str to str
        Of the importer.
    explain : list of Line
        What is to be explained.
    """

    columns: dict[str, ColumnMap] = field(default_factory=dict)
    settings: dict[str, Setting] = field(default_factory=dict)
    options: dict[str, str] = field(default_factory=dict)
    explain: list[Line] = field(default_factory=list)


Places = Mapping[str, tuple[str, tuple[tuple[RawTable, RawColumn], ...]]]


def typed(text: str, lines: Sequence[Line], columns: Places, options: Collection[str] = ()) -> Typed:
    """What ``3=Y [N]; axes.frame=CFD; 5 ?`` means: by number, key or column; several with semicolons between.

    A bare answer such as ``midship`` counts for the one line that is open.

    Parameters
    ----------
    text : str
    lines : sequence of Line
        Of the form that the person saw.
    columns : mapping of str to (str, places)
        By every name of a column its key, and the tables that have it; see `coeflab.tables.parts.columns_by_name`.
    options : collection of str
        Keys that are options of the importer.

    Raises
    ------
    InputError
        All that cannot be read.
    """
    out, complaints = Typed(), list[InputError]()
    parts = [*filter(None, map(str.strip, re.split(r";(?![^\[]*\])", text)))]
    bare = [one for one in parts if not set("=?") & set(one) and _line(one, () if one.isdecimal() else lines) is None]
    alone = open_lines(lines)
    if len(bare) == len(alone) == 1:
        parts = [f"{alone[0].key}={one}" if one == bare[0] else one for one in parts]
    for part in parts:
        asked = re.fullmatch(r"(?:\?\s*(?P<after>.+)|(?P<before>.+?)\s*\?|(?P<number>\d+)|\?)", part)
        if asked and "=" not in part.replace(" ", "").removesuffix("=?"):
            name = (asked["after"] or asked["before"] or asked["number"] or "").rstrip("= ")
            one = _line(name, lines)
            if one is None and name:
                complaints.append(_no_key(name, lines))
            out.explain += [one] if one else open_lines(lines) if not name else []
            continue
        try:
            _take(out, part, lines, columns, options)
        except InputError as why:
            complaints.append(why)
    if complaints:
        raise together(complaints)
    return out


def _take(out: Typed, part: str, lines: Sequence[Line], columns: Places, options: Collection[str]) -> None:
    """One KEY=VALUE."""
    fits = [n for n in columns if part.startswith(f"{n}=")]
    name = max(fits, key=len) if fits else part.partition("=")[0].strip()
    words = part[len(name) :].lstrip()
    one = None if fits else _line(name, lines)
    key = one.key if one else name
    if not words.startswith("="):
        raise input_error("tables.no_key_value", part=shown(part))
    words = words[1:].strip()
    if key in options:
        out.options[key] = words
    elif key in columns:
        own, places = columns[key]
        for raw, column in places:
            out.columns[own] = _column(raw, column, words)
    elif "." not in key:
        raise _no_key(key, lines)
    else:
        read = read_in(key, words)
        require_one_datum(out.settings, read)
        out.settings |= {k: Setting(value, "confirmed") for k, value in read.items()}


def _column(raw: RawTable, column: RawColumn, meaning: str) -> ColumnMap:
    try:
        out = read_column_map(meaning)
        if out.name != "ignore":
            with_unit(raw, column, out)
    except InputError as why:
        raise type(why)(
            why.found, why.expected, column=column.name, advice=why.advice.replace(" under [columns]", "")
        ) from None
    return out


def _line(name: str, lines: Sequence[Line]) -> Line | None:
    if name.isdecimal():
        return next((line for line in lines if line.number == int(name[:4])), None)
    return next((line for line in lines if line.key.casefold() == name.casefold()), None)


def _no_key(name: str, lines: Sequence[Line]) -> InputError:
    return input_error("tables.no_line_of_the_form", name=shown(name), count=len(lines))


def of_campaign(settings: Settings) -> dict[str, Setting]:
    """The settings without what was said of columns alone."""
    return {key: one for key, one in settings.items() if key.rpartition("/")[2] not in EXTRA}

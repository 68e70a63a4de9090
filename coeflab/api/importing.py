"""`Draft`: a campaign in the making: what is read of a file or folder, what a person states of it, what is open."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from coeflab.core.errors import InputError, shown, together
from coeflab.core.units import quantity
from coeflab.law.scaling import beyond_ends
from coeflab.tables import several_tables
from coeflab.tables.campaign import FILE
from coeflab.tables.column_map import ColumnMap, read_column_map
from coeflab.tables.conditions import BETWEEN
from coeflab.tables.force_table import ForceTable
from coeflab.tables.form import Line, Typed, of_campaign, open_lines, quoted, screen, typed
from coeflab.tables.imported import Filled, checked, contents
from coeflab.tables.interpretation import Interpretation, accepted_without_source
from coeflab.tables.mapping import assigned, without_a_setting
from coeflab.tables.parts import JOIN, Part, alike, own, read_parts, require_parts, stated_together, with_shared_words
from coeflab.tables.runs_table import runs_shown
from coeflab.tables.settings import Setting, assumed, read_in, require_one_datum, saved_mapping
from coeflab.tables.settings_in_files import doubtful_setting
from coeflab.tables.vocabulary import words_of
from coeflab.tables.words.points import POINT_OF

__all__ = [
    "FILE", "Campaign", "Draft", "Interpretation", "Line", "Part", "Stated", "assumed", "column_maps", "filled_in", "of_runs", "open_lines", "options_of",
    "quoted", "refuse_contradictions", "runs_shown", "screen", "stated_of", "without_a_setting", "words_of",
]  # fmt: skip
INERTIA = "table.contains_inertia"


@dataclass(slots=True)
class Stated:
    """What a person states: columns, settings, importer, options; and keys that are left open on purpose."""

    columns: dict[str, ColumnMap] = field(default_factory=dict)
    settings: dict[str, Setting] = field(default_factory=dict)
    importer: str = ""
    options: dict[str, Any] = field(default_factory=dict)
    left: list[str] = field(default_factory=list)


class Campaign(NamedTuple):
    """A campaign that nothing is open of.

    Attributes
    ----------
    filled : tuple of Filled
        Its tables as they were read, with all that is stated of them.
    files : mapping of str to bytes
        campaign.toml, tables and mapping.toml, by name.
    tables : tuple of ForceTable
        As the campaign reads, SI and FRD.
    """

    filled: tuple[Filled, ...]
    files: Mapping[str, bytes]
    tables: tuple[ForceTable, ...]


@dataclass(slots=True)
class Draft:
    """A campaign in the making: the tables as they are read, and what is stated of them so far.

    Examples
    --------
    >>> import coeflab as cf
    >>> draft = Draft(cf.shipped("cfd_data") / "suboff_roddy_2" / "table.csv", Stated())
    >>> draft.read()
    >>> draft.settle(accept=False)
    False
    >>> open_lines(draft.lines())[0].key
    'axes.frame'
    """

    file: Path
    stated: Stated
    assumed: Mapping[str, Setting] = field(default_factory=dict)
    maps: Sequence[str] = ()
    chosen: list[Line] = field(default_factory=list)
    left: tuple[str, ...] = ()
    numbers: dict[str, int] = field(default_factory=dict)
    parts: tuple[Part, ...] = ()
    founds: tuple[Interpretation, ...] = ()
    settings: dict[str, Setting] = field(default_factory=dict)

    @property
    def whole(self) -> str:
        """Name of what is imported, for its citation; empty where the one table says it."""
        return self.file.resolve().name if len(self.parts) > 1 else ""

    def read(self, progress: Callable[[str], None] | None = None) -> None:
        """Read the file, with sheets, tables of the folder or patterns of names as a proposal where it needs some."""
        parts, chosen = read_parts(self.file, self.stated.importer, self.stated.options, progress)
        self.parts = with_shared_words(parts)
        before = {one.key for one in self.chosen}
        self.chosen = [*self.chosen, *(one.line for one in chosen if one.key not in before)]
        self.left = tuple(text for one in chosen for text in one.left)
        self.stated.options |= {one.key: one.value for one in chosen}
        open_ = [t for t in self.maps if "?" in t.partition("=")[2]]
        self.stated.columns = self.stated.columns | _mapped([t for t in self.maps if t not in open_], self.parts)
        self.stated.left += [t.partition("=")[0] for t in open_]
        require_parts(self.stated.settings, self.parts)
        self.settings = {**self.assumed, **stated_together(self.parts), **self.stated.settings}

    def understand(self) -> None:
        """What follows from what is stated so far; `founds` is of it."""
        self.founds = several_tables.interpreted_together(self.parts, self.stated.columns, self.settings)

    def lines(self) -> tuple[Line, ...]:
        """The form as it stands."""
        return several_tables.form_together(
            self.parts, self.founds, self.settings, self.chosen, self.numbers, self.whole
        )

    def settle(self, accept: bool) -> bool:
        """Take what is harmless, or with ``accept`` all that is proposed; whether nothing is open then.

        Where something is, `founds` and without ``accept`` `settings` are as before it.

        Raises
        ------
        InputError
            What cannot be, all of it.
        """
        founds, settings = several_tables.settled_together(
            self.parts, self.stated.columns, self.settings, accept, self.whole
        )
        refuse_contradictions(founds)
        waits = several_tables.is_pending(self.parts, founds) or (bool(self.chosen) and not accept)
        if done := not waits and not self.stated.left:
            self.founds, self.settings = founds, settings
            return done
        self.understand()
        if accept:
            self.founds, self.settings = founds, settings
        return done

    def typed(self, answer: str, lines: Sequence[Line]) -> Typed:
        """A line of answers as it is meant.

        Raises
        ------
        InputError
            What of it is no answer.
        """
        return typed(answer, lines, several_tables.columns_by_name(self.parts), [one.key for one in self.chosen])

    def take(self, given: Typed, read: Callable[[], None] | None = None) -> None:
        """Take answers in; all or none.

        Parameters
        ----------
        given : Typed
        read : callable, optional
            Reads again where an option of the importer changes; `read` unless given.

        Raises
        ------
        InputError
            What they say together is not possible.
        """
        if given.options:
            before, chosen = dict(self.stated.options), self.chosen
            self.stated.options |= given.options
            self.chosen = [replace(one, value=str(self.stated.options[one.key])) for one in self.chosen]
            try:
                (read or self.read)()
            except InputError:
                self.stated.options, self.chosen = before, chosen
                raise
        require_parts(given.settings, self.parts)
        if POINT_OF not in given.settings:
            require_one_datum(self.settings, {k: one.value for k, one in given.settings.items()})
        columns, settings = self.stated.columns | given.columns, self.stated.settings | given.settings
        founds = several_tables.interpreted_together(self.parts, columns, self.settings | given.settings)
        refuse_contradictions(founds)
        self.stated.columns, self.stated.settings, self.founds = columns, settings, founds
        self.settings |= given.settings

    def campaign(self) -> Campaign:
        """The campaign, once everything is stated; nothing is written.

        Raises
        ------
        InputError
            Columns that cannot be what is stated of them.
        """
        filled = filled_in(self.parts, self.founds, self.settings)
        files = contents(filled, of_campaign(self.settings), self.file)
        return Campaign(filled, files, checked(files, filled))

    def inertia(self) -> dict[str, str]:
        """What is asked for besides where forces hold the model's inertia, with what is proposed; empty where that is no question."""
        asked = [one.key for one in open_lines(self.lines()) if one.key.endswith(INERTIA)]
        if not asked:
            return {}
        inside = {**self.settings, **dict.fromkeys(asked, Setting(True, ""))}
        questions = [
            q for f in several_tables.interpreted_together(self.parts, self.stated.columns, inside) for q in f.questions
        ]
        return {q.key: q.default or "..." for q in questions if q.key.startswith("inertia.")}

    def warned(self) -> list[str]:
        """What looks wrong in what is stated so far."""
        sizes = []
        for part in self.parts:
            mine = own(self.settings, part, self.parts)
            sizes += [f"warning, {k}: {why}" for k in mine if (why := doubtful_setting(part.raw, mine, k))]
        sizes += [f"warning, {POINT_OF}: {why}" for why in [self._beyond_ends()] if why]
        shows = [e.text for found in self.founds for e in found.shows if e.warns]
        same = [
            f"warning: {' and '.join(names)} have the same columns. Parts of one sweep are joined by --option {JOIN}=yes; tests of "
            "another body are a campaign of their own: name one by --option sheet= or files="
            for names in alike(self.parts)
        ]
        return list(dict.fromkeys([*same, *sizes, *shows]))

    def _beyond_ends(self) -> str:
        """Where the reference point is off the body."""
        point, datum, length = (self.settings.get(k) for k in (POINT_OF, "axes.datum", "scaling.length"))
        if point is None or datum is None:
            return ""
        size = None if length is None else quantity(length.value, "length")
        return beyond_ends(str(datum.value), quantity(point.value[0], "length"), size)


def refuse_contradictions(founds: Sequence[Interpretation]) -> None:
    """Refuse what cannot be.

    Raises
    ------
    InputError
        All of it.
    """
    if complaints := several_tables.complaints_of(founds):
        raise together(complaints)


def filled_in(
    parts: Sequence[Part], founds: Sequence[Interpretation], settings: Mapping[str, Setting]
) -> tuple[Filled, ...]:
    """Tables with all that holds for each; what was accepted without a source is named.

    Parameters
    ----------
    parts, founds : sequences
    settings : mapping of str to Setting
        Of all tables together.

    Raises
    ------
    InputError
        Columns that cannot be what is stated of them.
    """
    out = []
    for part, found in zip(parts, founds, strict=True):
        mine = own(settings, part, parts)
        out.append(Filled(
            part.name, part.raw, part.importer, part.options, assigned(part.raw, found.mapping), found.mapping, of_campaign(mine),
            frozenset(found.about), accepted_without_source(found, mine),
        ))  # fmt: skip
    return tuple(out)


def stated_of(mapping: Path | None, set_: Sequence[str], option: Sequence[str], as_: str) -> Stated:
    """All that ``--set``, ``--option``, ``--as`` and a saved mapping state, but for columns; complaints at once.

    Parameters
    ----------
    mapping : Path, optional
        A mapping.toml.
    set_, option : sequence of str
        ``KEY=VALUE``.
    as_ : str
        An importer.
    """
    out = Stated()
    if mapping is not None:
        out.columns, out.settings, out.importer, out.options = saved_mapping(mapping)
    out.importer = as_ or out.importer
    complaints: list[InputError] = []
    for text in set_:
        key, equals, words = text.partition("=")
        if equals and "?" in words:
            out.left.append(key.strip())
            continue
        if not equals:
            complaints.append(InputError(shown(text), "KEY=VALUE, such as axes.frame=CFD", column="--set"))
            continue
        try:
            read = read_in(key.strip(), words.strip())
            require_one_datum(out.settings, read)
            out.settings |= {k: Setting(v, "confirmed") for k, v in read.items()}
        except InputError as why:
            complaints.append(why)
    try:
        out.options |= options_of(option)
    except InputError as why:
        complaints += [why, *why.others]
    if complaints:
        raise together(complaints)
    return out


def options_of(texts: Sequence[str]) -> dict[str, Any]:
    """Options of an importer from ``NAME=VALUE``; numbers where they read as such."""
    wrong = [t for t in texts if "=" not in t]
    if wrong:
        raise together([InputError(shown(t), "NAME=VALUE, such as sheet=Drift", column="--option") for t in wrong])
    pairs = (text.partition("=") for text in texts)
    return {key.strip(): _number(words.strip()) for key, _, words in pairs}


def of_runs(name: Sequence[str], runs: Path | None, state: Path | None = None) -> list[str]:
    """Options of collected runs as ``--option`` takes them.

    Parameters
    ----------
    name : sequence of str
        Patterns of the names of runs.
    runs, state : Path, optional
        A list of runs; where what was read of them is held.
    """
    given = {"names": BETWEEN.join(name), "run_list": runs, "state": state}
    return [f"{option}={value}" for option, value in given.items() if value]


def _number(text: str) -> Any:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _mapped(texts: Sequence[str], parts: Sequence[Part]) -> dict[str, ColumnMap]:
    """What ``--map NAME=WHAT`` states, by the names of the file, which may hold a sign of equality."""
    names, stated = several_tables.columns_by_name(parts), {}
    for text in texts:
        name = max((n for n in names if text.startswith(f"{n}=")), key=len, default=text.partition("=")[0])
        stated[name.strip() if name not in names else name] = text[len(name) + 1 :]
    return column_maps(stated, parts, "--map", "--map {name}={text}", parts[0].raw.path)


def column_maps(
    stated: Mapping[str, str],
    parts: Sequence[Part],
    option: str,
    one: str,
    file: str | Path,
    own: str | Path | None = None,
) -> dict[str, ColumnMap]:
    """What columns are, by their own names, with that of their table before it where one is given.

    Parameters
    ----------
    stated : mapping of str to str
        ``Y [N]``, ``-beta [deg]``, ``label`` by a name of a column, with or without its unit.
    parts : sequence of Part
    option, one : str
        What complaints call all of them, and one of a ``{name}`` and ``{text}``.
    file, own : str or Path
        What complaints about names are about, and those about one text.

    Raises
    ------
    InputError
        No such column, or a text that says nothing of one.
    """
    names = {name: key for name, (key, _) in several_tables.columns_by_name(parts).items()}
    out: dict[str, ColumnMap] = {}
    complaints: list[InputError] = []
    for name, text in stated.items():
        key = names.get(name) or names.get(name.partition(" [")[0])
        if key is None:
            have = ", ".join(dict.fromkeys(c.name for part in parts for c in part.raw.columns))
            complaints.append(InputError(f"no column {shown(name)}", f"one of {have}", file=file, column=option))
            continue
        try:
            out[key] = read_column_map(text)
        except InputError as why:
            place = one.format(name=name, text=text)
            complaints.append(InputError(why.found, why.expected, file=own, column=place, advice=why.advice))
    if complaints:
        raise together(complaints)
    return out

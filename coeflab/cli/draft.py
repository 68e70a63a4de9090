"""A campaign in the making: what is read, what is said of it on the command line or in the form, what is open."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import show
from coeflab.core.errors import InputError

if TYPE_CHECKING:
    from coeflab.tables.column_map import ColumnMap
    from coeflab.tables.conditions import NoConditionError
    from coeflab.tables.form import Line, Typed
    from coeflab.tables.questions import Understood
    from coeflab.tables.raw_table import RawTable
    from coeflab.tables.settings import Setting


@dataclass(slots=True)
class Said:
    """What a person says: columns, settings, importer, options."""

    columns: dict[str, ColumnMap] = field(default_factory=dict)
    settings: dict[str, Setting] = field(default_factory=dict)
    importer: str = ""
    options: dict[str, Any] = field(default_factory=dict)
    left: list[str] = field(default_factory=list)


@dataclass(slots=True)
class Draft:
    """A campaign in the making: the file as it is read, and what is said of it so far."""

    file: Path
    said: Said
    assumed: Mapping[str, Setting]
    maps: Sequence[str]
    accept: bool = False
    importer: str = ""
    sheets: tuple[str, ...] = ()
    chosen: list[Line] = field(default_factory=list)
    numbers: dict[str, int] = field(default_factory=dict)
    raw: RawTable = field(init=False)
    found: Understood = field(init=False)
    settings: dict[str, Setting] = field(default_factory=dict)

    def read(self) -> None:
        """Read the file, with a sheet or a pattern of names as a proposal where it needs one."""
        from coeflab.tables.conditions import UNNAMED, NoConditionError
        from coeflab.tables.raw_table import SeveralError
        from coeflab.tables.reading import importer_of, read_raw
        from coeflab.tables.settings import stated_settings

        self.importer = importer_of(self.file, self.said.importer)
        with show.narrated(), show.progress(False) as say:
            while True:
                try:
                    self.raw = read_raw(self.file, self.importer, self.said.options, say)
                    break
                except SeveralError as several:
                    if not several.choices:
                        raise
                    self.sheets = several.choices
                    self.said.options["sheet"] = _likely_sheet(self.file, self.importer, self.said.options, self.sheets)
                except NoConditionError as unsaid:
                    if self.said.options.get("names") or not unsaid.pattern or UNNAMED in unsaid.pattern:
                        raise
                    self.said.options["names"] = unsaid.pattern
                    self.chosen.append(_pattern_line(unsaid))
        if self.sheets:
            others = ", ".join(s for s in self.sheets if s != self.said.options["sheet"])
            self.chosen = [one for one in self.chosen if one.key != "sheet"]
            self.chosen.append(
                _line(
                    "sheet",
                    self.said.options["sheet"],
                    f"others: {others}",
                    f"Sheets with numbers: {', '.join(self.sheets)}.",
                )
            )
        names = {column.name for column in self.raw.columns}
        shown, left = (
            [t for t in self.maps if "?" not in t.partition("=")[2]],
            [t for t in self.maps if "?" in t.partition("=")[2]],
        )
        self.said.columns = {n: c for n, c in self.said.columns.items() if n in names or not self.sheets} | _mapped(
            shown, self.raw
        )
        self.said.left += [t.partition("=")[0] for t in left]
        self.settings = {**self.assumed, **stated_settings(self.raw), **self.said.settings}

    def lines(self) -> tuple[Line, ...]:
        """The form as it stands."""
        from coeflab.tables.form import form

        return form(self.raw, self.found, self.settings, self.chosen, self.numbers)

    def asked(self) -> None:
        """Show the form, take lines of answers, until nothing is open and an empty line accepts what is shown."""
        from coeflab.core.errors import together
        from coeflab.tables.form import open_lines, settled, typed
        from coeflab.tables.questions import understood

        self.found = understood(self.raw, self.said.columns, self.settings)
        if self.found.complaints:
            raise together(list(self.found.complaints))
        described(self.raw, self.importer, self.found, whole=False)
        changed: set[str] = set()
        again = True
        while True:
            lines = self.lines()
            if again:
                self.shown(lines, changed)
            missing = open_lines(lines)
            hint = "N=VALUE; KEY=VALUE; N ? explains" + ("" if missing else "; Enter accepts all")
            answer = str(typer.prompt(f"  {hint}\n>", default="", show_default=False, prompt_suffix=" ")).strip()
            again = False
            if not answer and missing:
                show.error(f"  Open: {', '.join(f'{one.number} {one.key}' for one in missing)}")
                continue
            try:
                if not answer:
                    found, settings = settled(self.raw, self.said.columns, self.settings, True)
                    if found.complaints:
                        raise together(list(found.complaints))
                    self.found, self.settings = found, settings
                    if not open_lines(self.lines()):
                        return
                else:
                    said = typed(answer, lines, self.raw, [one.key for one in self.chosen])
                    for one in said.explain:
                        show.sentence(f"  {one.key}: {one.about}")
                    if not (said.columns or said.settings or said.options):
                        continue
                    self.take(said)
            except InputError as wrong:
                for complaint in wrong.lines:
                    show.error(f"  {complaint}")
                continue
            before = {one.key: (one.value, one.group) for one in lines}
            changed = {one.key for one in self.lines() if before.get(one.key) != (one.value, one.group)}
            again = True

    def take(self, said: Typed) -> None:
        """Take answers in; all or none.

        Raises
        ------
        InputError
            What they say together is not possible.
        """
        from coeflab.core.errors import together
        from coeflab.tables.questions import understood

        if said.options:
            before = dict(self.said.options)
            self.said.options |= said.options
            self.chosen = [replace(one, value=str(self.said.options[one.key])) for one in self.chosen]
            try:
                self.read()
            except InputError:
                self.said.options = before
                raise
        columns, settings = self.said.columns | said.columns, self.said.settings | said.settings
        found = understood(self.raw, columns, self.settings | said.settings)
        if found.complaints:
            raise together(list(found.complaints))
        self.said.columns, self.said.settings, self.found = columns, settings, found
        self.settings |= said.settings

    def unasked(self, words: Sequence[str], accept: bool) -> None:
        """Settle everything by what the command says, or show the form and the command that does, and stop.

        Raises
        ------
        InputError
            What cannot be, all of it.
        """
        from coeflab.core.errors import together
        from coeflab.tables.form import open_lines, pending, settled
        from coeflab.tables.questions import understood
        from coeflab.tables.settings import Setting

        found, settings = settled(self.raw, self.said.columns, self.settings, accept)
        if found.complaints:
            raise together(list(found.complaints))
        waits = pending(found) or (bool(self.chosen) and not accept)
        if not waits and not self.said.left:
            self.found, self.settings = found, settings
            return
        self.found = understood(self.raw, self.said.columns, self.settings)
        if accept:
            self.found, self.settings = found, settings
        described(self.raw, self.importer, self.found, whole=False)
        lines = self.lines()
        self.shown(lines)
        for key in self.said.left:
            own = next((one for one in lines if one.key == key), None)
            about = f"{own.why}" if own else "no such key"
            show.error(f'found "{key}=?", left open; expected a value: {about}')
        missing = open_lines(lines)
        many = f"{len(missing)} open: replace each ? by its value. " if missing else ""
        show.sentence(f"{many}--accept takes the proposals shown. Nothing is written yet.")
        if any(one.key == "table.contains_inertia" for one in missing):
            inside = {**self.settings, "table.contains_inertia": Setting(True, "")}
            more = [
                q for q in understood(self.raw, self.said.columns, inside).questions if q.key.startswith("inertia.")
            ]
            show.sentence("# if true: add " + " ".join(f"--set {q.key}={q.default or '...'}" for q in more))
        show.command_line(
            "coeflab import", " ".join([*words, *(one.argument for one in missing), "--accept"]), separator=" "
        )
        raise typer.Exit(2)

    def shown(self, lines: Sequence[Line], changed: Collection[str] = ()) -> None:
        """Print the form, and what looks wrong in it."""
        from coeflab.tables.form import screen

        for line in screen(lines, changed, min(show.width(), 100)):
            show.lines(line)
        show.text()
        print_list("Check", self.warned())

    def warned(self) -> list[str]:
        """What looks wrong in what is said so far."""
        from coeflab.tables.settings import doubtful_setting
        from coeflab.tables.words_above import POINT_OF

        sizes = [f"warning, {k}: {why}" for k in self.settings if (why := doubtful_setting(self.raw, self.settings, k))]
        sizes += [f"warning, {POINT_OF}: {why}" for why in [self._beyond_ends()] if why]
        return [*sizes, *(e.text for e in self.found.shows if e.text.startswith("warning"))]

    def _beyond_ends(self) -> str:
        """Where the reference point is off the body."""
        from coeflab.core.units import quantity
        from coeflab.law.scaling import beyond_ends
        from coeflab.tables.words_above import POINT_OF

        point, datum, length = (self.settings.get(k) for k in (POINT_OF, "axes.datum", "scaling.length"))
        if point is None or datum is None:
            return ""
        size = None if length is None else quantity(length.value, "length")
        return beyond_ends(str(datum.value), quantity(point.value[0], "length"), size)


def _line(key: str, value: str, why: str, about: str) -> Line:
    from coeflab.tables.form import Group, Line

    return Line(key, value, why, Group.GRAVE, about, pending=True)


def _likely_sheet(file: Path, importer: str, options: Mapping[str, Any], sheets: Sequence[str]) -> str:
    """The first sheet with a column that may be a force or moment by its name; else the first."""
    from coeflab.tables.proposals import proposals
    from coeflab.tables.reading import read_raw

    for sheet in sheets:
        try:
            raw = read_raw(file, importer, {**options, "sheet": sheet})
        except InputError:
            continue
        if any(re.match(r"-?(?:[XYZKMN]|lift|drag|side)\b", one.text) for one in proposals(raw)):
            return sheet
    return sheets[0]


def _pattern_line(unsaid: NoConditionError) -> Line:
    """The pattern of names of runs, with what it makes of them."""
    from coeflab.tables.conditions import SPELT, name_pattern

    pattern = name_pattern(unsaid.pattern)
    read = [
        f"{run}: "
        + ", ".join(f"{key} = {one}".partition(" (name")[0] for key, one in (pattern.conditions(run) or {}).items())
        for run in unsaid.runs
    ]
    return _line(
        "names",
        unsaid.pattern,
        "; ".join(read[:2]),
        f"Conditions by the names of the runs. {'; '.join(read)}. {SPELT}.",
    )


def described(raw: RawTable, importer: str, found: Understood, *, whole: bool = True) -> None:
    """Print what a file is and what its numbers show; its columns and what it says of itself where the form does not."""
    from coeflab.report.tables import raw_tables
    from coeflab.tables.collect import runs_shown

    said = "; ".join(f"{key} {text}" for key, text in raw.dialect.items() if key != "importer")
    show.sentence(f"{raw.path}: read by {importer}" + (f"; {said}" if said else ""))
    if runs := runs_shown(raw, MOST if whole else FEW):
        show.table(runs)
    if whole:
        show.table(raw_tables.columns(raw, found.proposals, found.mapping))
        show.table(raw_tables.stated(raw))
    print_list("Left out or mended", raw.remarks)
    print_list("The numbers show", [e.text for e in found.shows if whole or not e.text.startswith("warning")])


MOST, FEW = 12, 3


def print_list(title: str, texts: Sequence[str]) -> None:
    """A heading and at most `MOST` texts below it; nothing for none."""
    if not texts:
        return
    show.text(title)
    for text in texts[:MOST]:
        show.lines(textwrap.fill(text, 79, initial_indent="  ", subsequent_indent="    ", break_long_words=False))
    if len(texts) > MOST:
        show.text(f"  and {len(texts) - MOST} more")
    show.text()


def said_on_command_line(mapping: Path | None, set_: Sequence[str], option: Sequence[str], as_: str) -> Said:
    """All that the command line and a saved mapping say, but for columns; complaints at once."""
    from coeflab.core.errors import shown, together
    from coeflab.tables.settings import Setting, read_settings, saved_mapping

    out = Said()
    if mapping is not None:
        out.columns, out.settings, out.importer, out.options = saved_mapping(mapping)
    out.importer = as_ or out.importer
    complaints: list[InputError] = []
    for text in set_:
        key, equals, said = text.partition("=")
        if equals and "?" in said:
            out.left.append(key.strip())
            continue
        if not equals:
            complaints.append(InputError(shown(text), "KEY=VALUE, such as axes.frame=CFD", column="--set"))
            continue
        try:
            out.settings |= {k: Setting(v, "confirmed") for k, v in read_settings(key.strip(), said.strip()).items()}
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
    from coeflab.core.errors import shown, together

    wrong = [t for t in texts if "=" not in t]
    if wrong:
        raise together([InputError(shown(t), "NAME=VALUE, such as sheet=Drift", column="--option") for t in wrong])
    pairs = (text.partition("=") for text in texts)
    return {key.strip(): _number(said.strip()) for key, _, said in pairs}


def of_runs(name: str, runs: Path | None, state: Path | None = None) -> list[str]:
    """Options of collected runs as ``--option`` takes them."""
    given = {"names": name, "run_list": runs, "state": state}
    return [f"{option}={value}" for option, value in given.items() if value]


def _number(text: str) -> Any:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _mapped(map_: Sequence[str], raw: RawTable) -> dict[str, ColumnMap]:
    """What ``--map`` says, by the names of the file."""
    from coeflab.core.errors import shown, together
    from coeflab.tables.column_map import read_column_map
    from coeflab.tables.mapping import known_as

    names = {n: c.name for c in raw.columns for n in (c.name, *known_as(c))}
    out: dict[str, ColumnMap] = {}
    complaints: list[InputError] = []
    for text in map_:
        fits = [n for n in names if text.startswith(f"{n}=")]
        name = max(fits, key=len) if fits else text.partition("=")[0].strip()
        if name not in names:
            have = ", ".join(c.name for c in raw.columns)
            complaints.append(InputError(f"no column {shown(name)}", f"one of {have}", file=raw.path, column="--map"))
            continue
        try:
            out[names[name]] = read_column_map(text[len(name) + 1 :])
        except InputError as why:
            complaints.append(InputError(why.found, why.expected, column=f"--map {text}", advice=why.advice))
    if complaints:
        raise together(complaints)
    return out

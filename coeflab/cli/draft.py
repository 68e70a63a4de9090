"""A campaign in the making: what is read, what is said of it on the command line or in the form, what is open."""

from __future__ import annotations

import textwrap
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import typer

from coeflab.cli import show
from coeflab.core.errors import InputError, shown, together
from coeflab.core.units import quantity
from coeflab.law.scaling import beyond_ends
from coeflab.report.tables import raw_tables
from coeflab.tables.collect import runs_shown
from coeflab.tables.column_map import ColumnMap, read_column_map
from coeflab.tables.conditions import BETWEEN
from coeflab.tables.form import Line, Typed, of_campaign, open_lines, screen, typed
from coeflab.tables.imported import Filled
from coeflab.tables.interpretation import Interpretation, accepted_without_source
from coeflab.tables.mapping import assigned
from coeflab.tables.parts import JOIN, Part, alike, own, read_parts, require_parts, stated_together, with_shared_words
from coeflab.tables.settings import Setting, read_in, require_one_datum, saved_mapping
from coeflab.tables.settings_in_files import doubtful_setting
from coeflab.tables.several_tables import (
    columns_by_name,
    complaints_of,
    form_together,
    interpreted_together,
    is_pending,
    settled_together,
)
from coeflab.tables.words.points import POINT_OF


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
    """A campaign in the making: the tables as they are read, and what is said of them so far."""

    file: Path
    said: Said
    assumed: Mapping[str, Setting]
    maps: Sequence[str]
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

    def read(self) -> None:
        """Read the file, with sheets, tables of the folder or patterns of names as a proposal where it needs some."""
        with show.narrated(), show.progress(False) as say:
            parts, chosen = read_parts(self.file, self.said.importer, self.said.options, say)
        self.parts = with_shared_words(parts)
        before = {one.key for one in self.chosen}
        fresh = [one.line for one in chosen if one.key not in before]
        self.chosen = [*self.chosen, *fresh]
        self.left = tuple(text for one in chosen for text in one.left)
        self.said.options |= {one.key: one.value for one in chosen}
        shown, left = (
            [t for t in self.maps if "?" not in t.partition("=")[2]],
            [t for t in self.maps if "?" in t.partition("=")[2]],
        )
        self.said.columns = self.said.columns | _mapped(shown, self.parts)
        self.said.left += [t.partition("=")[0] for t in left]
        require_parts(self.said.settings, self.parts)
        self.settings = {**self.assumed, **stated_together(self.parts), **self.said.settings}

    def understand(self) -> None:
        """What follows from what is said so far; `founds` is of it."""
        self.founds = interpreted_together(self.parts, self.said.columns, self.settings)

    def lines(self) -> tuple[Line, ...]:
        """The form as it stands."""
        return form_together(self.parts, self.founds, self.settings, self.chosen, self.numbers, self.whole)

    def filled(self) -> tuple[Filled, ...]:
        """The tables, once everything is said.

        Raises
        ------
        InputError
            Columns that cannot be what is said of them.
        """
        return tuple(
            Filled(
                part.name, part.raw, part.importer, part.options, assigned(part.raw, found.mapping), found.mapping,
                of_campaign(own(self.settings, part, self.parts)), frozenset(found.about),
                accepted_without_source(found, own(self.settings, part, self.parts)),
            )
            for part, found in zip(self.parts, self.founds, strict=True)
        )  # fmt: skip

    def asked(self) -> None:
        """Show the form, take lines of answers, until nothing is open and an empty line accepts what is shown."""
        self.understand()
        if complaints := complaints_of(self.founds):
            raise together(complaints)
        self.described()
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
                    founds, settings = settled_together(self.parts, self.said.columns, self.settings, True, self.whole)
                    if complaints := complaints_of(founds):
                        raise together(complaints)
                    self.founds, self.settings = founds, settings
                    if not open_lines(self.lines()):
                        return
                else:
                    given = typed(answer, lines, columns_by_name(self.parts), [one.key for one in self.chosen])
                    for one in given.explain:
                        show.sentence(f"  {one.key}: {one.about}")
                    if not (given.columns or given.settings or given.options):
                        continue
                    self.take(given)
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
        if said.options:
            before, chosen = dict(self.said.options), self.chosen
            self.said.options |= said.options
            self.chosen = [replace(one, value=str(self.said.options[one.key])) for one in self.chosen]
            try:
                self.read()
            except InputError:
                self.said.options, self.chosen = before, chosen
                raise
        require_parts(said.settings, self.parts)
        if POINT_OF not in said.settings:
            require_one_datum(self.settings, {k: one.value for k, one in said.settings.items()})
        columns, settings = self.said.columns | said.columns, self.said.settings | said.settings
        founds = interpreted_together(self.parts, columns, self.settings | said.settings)
        if complaints := complaints_of(founds):
            raise together(complaints)
        self.said.columns, self.said.settings, self.founds = columns, settings, founds
        self.settings |= said.settings

    def unasked(self, words: Sequence[str], accept: bool) -> None:
        """Settle everything by what the command says, or show the form and the command that does, and stop.

        Raises
        ------
        InputError
            What cannot be, all of it.
        """
        founds, settings = settled_together(self.parts, self.said.columns, self.settings, accept, self.whole)
        if complaints := complaints_of(founds):
            raise together(complaints)
        waits = is_pending(self.parts, founds) or (bool(self.chosen) and not accept)
        if not waits and not self.said.left:
            self.founds, self.settings = founds, settings
            return
        self.understand()
        if accept:
            self.founds, self.settings = founds, settings
        self.described()
        lines = self.lines()
        self.shown(lines)
        for key in self.said.left:
            own = next((one for one in lines if one.key == key), None)
            about = f"{own.why}" if own else "no such key"
            show.error(f'found "{key}=?", left open; expected a value: {about}')
        missing = open_lines(lines)
        many = f"{len(missing)} open: replace each ? by its value. " if missing else ""
        show.sentence(f"{many}--accept takes the proposals shown. Nothing is written yet.")
        if any(not offer.text for found in founds for _, offer in found.open):
            show.sentence(FOLLOWS)
        if inertia := [one.key for one in missing if one.key.endswith("table.contains_inertia")]:
            inside = {**self.settings, **dict.fromkeys(inertia, Setting(True, ""))}
            asked = [q for f in interpreted_together(self.parts, self.said.columns, inside) for q in f.questions]
            more = {q.key: q.default or "..." for q in asked if q.key.startswith("inertia.")}
            show.sentence("# if true: add " + " ".join(f"--set {key}={phrases}" for key, phrases in more.items()))
        show.command_line(
            "coeflab import", " ".join([*words, *(one.argument for one in missing), "--accept"]), separator=" "
        )
        raise typer.Exit(2)

    def shown(self, lines: Sequence[Line], changed: Collection[str] = ()) -> None:
        """Print the form, and what looks wrong in it."""
        for line in screen(lines, changed, min(show.width(), 100)):
            show.lines(line)
        show.text()
        print_list("Check", self.warned())

    def described(self) -> None:
        """Print what each table is, what its numbers show, and what is not taken."""
        for part, found in zip(self.parts, self.founds, strict=True):
            described(part, found, whole=False)
        print_list("Not taken", self.left)

    def warned(self) -> list[str]:
        """What looks wrong in what is said so far."""
        sizes = []
        for part in self.parts:
            mine = own(self.settings, part, self.parts)
            sizes += [f"warning, {k}: {why}" for k in mine if (why := doubtful_setting(part.raw, mine, k))]
        sizes += [f"warning, {POINT_OF}: {why}" for why in [self._beyond_ends()] if why]
        shows = [e.text for found in self.founds for e in found.shows if e.text.startswith("warning")]
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


def described(part: Part, found: Interpretation, *, whole: bool = True, most: int = 0) -> None:
    """Print what a table is and what its numbers show; its columns and what it says of itself where the form does not; ``most`` of each list."""
    raw = part.raw
    words = "; ".join(f"{key} {text}" for key, text in raw.dialect.items() if key != "importer")
    name = f"{part.name}: " * bool(part.name)
    show.sentence(f"{name}{raw.path}: read by {part.importer}" + (f"; {words}" if words else ""))
    if runs := runs_shown(raw, MOST if whole else FEW):
        show.table(runs)
    if whole:
        show.table(raw_tables.columns(raw, found.proposals, found.mapping))
        show.table(raw_tables.stated(raw))
    print_list("Left out or mended", raw.remarks, most or MOST)
    shows = [e.text for e in found.shows if whole or not e.text.startswith("warning")]
    print_list("The numbers show", shows, most + 1 if most else MOST)


MOST, FEW = 12, 3
FOLLOWS = (
    "# columns named so need, in the same command: alpha or beta --set axes.alpha=+ (or -); p, q, r --set table.arm_point=... "
    "--set table.contains_inertia=...; a coefficient --set coefficients.area=..., of a moment .length"
)


def print_list(title: str, texts: Sequence[str], most: int = MOST) -> None:
    """A heading and at most ``most`` texts below it; nothing for none."""
    if not texts:
        return
    show.text(title)
    for text in texts[:most]:
        show.lines(textwrap.fill(text, 79, initial_indent="  ", subsequent_indent="    ", break_long_words=False))
    if len(texts) > most:
        show.text(f"  and {len(texts) - most} more")
    show.text()


def said_on_command_line(mapping: Path | None, set_: Sequence[str], option: Sequence[str], as_: str) -> Said:
    """All that the command line and a saved mapping say, but for columns; complaints at once."""
    out = Said()
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
    """Options of collected runs as ``--option`` takes them."""
    given = {"names": BETWEEN.join(name), "run_list": runs, "state": state}
    return [f"{option}={value}" for option, value in given.items() if value]


def _number(text: str) -> Any:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _mapped(map_: Sequence[str], parts: Sequence[Part]) -> dict[str, ColumnMap]:
    """What ``--map`` says, by the names of the file."""
    names = {name: key for name, (key, _) in columns_by_name(parts).items()}
    out: dict[str, ColumnMap] = {}
    complaints: list[InputError] = []
    for text in map_:
        fits = [n for n in names if text.startswith(f"{n}=")]
        name = max(fits, key=len) if fits else text.partition("=")[0].strip()
        if name not in names:
            have = ", ".join(dict.fromkeys(c.name for part in parts for c in part.raw.columns))
            file = parts[0].raw.path
            complaints.append(InputError(f"no column {shown(name)}", f"one of {have}", file=file, column="--map"))
            continue
        try:
            out[names[name]] = read_column_map(text[len(name) + 1 :])
        except InputError as why:
            complaints.append(InputError(why.found, why.expected, column=f"--map {text}", advice=why.advice))
    if complaints:
        raise together(complaints)
    return out

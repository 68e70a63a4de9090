"""``coeflab import``: a file or folder of any known kind becomes a campaign, once somebody has said what it means."""

from __future__ import annotations

import re
import shlex
import sys
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import complete, show
from coeflab.core.errors import InputError

if TYPE_CHECKING:
    from coeflab.tables.column_map import ColumnMap
    from coeflab.tables.conditions import NoConditionError
    from coeflab.tables.force_table import ForceTable
    from coeflab.tables.proposals import Proposal
    from coeflab.tables.questions import Doubt, Group, Question, Understood
    from coeflab.tables.raw_table import RawColumn, RawTable, SeveralError
    from coeflab.tables.settings import Setting


EXAMPLE = "coeflab import drift.csv --out cfd_data/mine"


class OpenError(InputError):
    """What nobody has said yet, with the arguments that say it."""

    def __init__(self, path: Path, points: Sequence[tuple[str, str]], wrong: Sequence[InputError] = ()) -> None:
        many = f"{len(points)} open point" + "s" * (len(points) != 1)
        super().__init__(many, "these arguments, with values for words in capitals", file=path)
        self.points = points
        self.wrong = tuple(str(one) for one in wrong)

    @property
    def lines(self) -> tuple[str, ...]:
        """The arguments, each with its question below."""
        points = getattr(self, "points", ())
        proposed = any(open_value(argument) is None for argument, _ in points)
        taken = ["  --yes takes those with values."] * proposed
        return (*super().lines, *point_lines(points), *taken, *getattr(self, "wrong", ()))


def open_value(argument: str) -> str | None:
    """The word in capitals of an argument, or ``or`` between two ways; None where it has a value."""
    if " or --map " in argument:
        return "or"
    word = re.search(r"\b(?:FRAME|POINT|NAME|SOURCE|KIND|SIGN|SIDE|METRES|DENSITY|SPEED|X,Y,Z|IX,IY,IZ|MASS|TRUE_OR_FALSE|"
                     r"UNIT|SIZE|WHAT)\b", argument.partition("=")[2])  # fmt: skip
    return word[0] if word else None


def point_lines(points: Sequence[tuple[str, str]]) -> list[str]:
    """Arguments and what they are about, at most 80 columns where words allow."""
    out = []
    for argument, why in points:
        out.append(f"  {argument}")
        out += textwrap.wrap(why, 72, initial_indent="      ", subsequent_indent="      ", break_long_words=False)
    return out


@dataclass(slots=True)
class Said:
    """What a person says: columns, settings, importer, options."""

    columns: dict[str, ColumnMap] = field(default_factory=dict)
    settings: dict[str, Setting] = field(default_factory=dict)
    importer: str = ""
    options: dict[str, Any] = field(default_factory=dict)


def command(
    path: str = typer.Argument(
        ...,
        metavar="PATH",
        help="A table, or a folder of cases: text, Excel, OpenFOAM ... (coeflab formats importers).",
    ),
    out: Path = typer.Option(..., "--out", metavar="FOLDER", help="Folder of the new campaign, such as cfd_data/mine."),
    map_: list[str] = typer.Option(
        [], "--map", metavar="COLUMN=WHAT", help="What a column is: 'Fy=Y [N]', 'Run=label', 'Note=ignore'; repeatable."
    ),
    set_: list[str] = typer.Option(
        [], "--set", metavar="KEY=VALUE", help="Any key of campaign.toml: axes.frame=CFD; repeatable."
    ),
    mapping: Path = typer.Option(None, metavar="FILE.toml", help="A mapping.toml that an earlier import wrote."),
    option: list[str] = typer.Option(
        [], "--option", metavar="NAME=VALUE", help="An option of the importer: sheet=Drift; repeatable."
    ),
    as_: str = typer.Option(
        "",
        "--as",
        metavar="IMPORTER",
        autocompletion=complete.importers,
        help="Read it with this importer (coeflab formats importers).",
    ),
    name: str = typer.Option(
        "", "--name", metavar="PATTERN", help="Conditions in names of runs: 'b{beta:deg}_r{r:rad/s}'."
    ),
    runs: Path = typer.Option(None, "--runs", metavar="LIST.csv", help="A list of runs with their conditions."),
    state: Path = typer.Option(
        None, metavar="FILE", help="Keeps what was read of many runs, so that a stopped import goes on."
    ),
    yes: bool = typer.Option(False, "--yes", help="Take proposals that the file or clear evidence supports."),
    force: bool = typer.Option(False, "--force", help="Replace a campaign that is there."),
) -> None:
    """Make a campaign of a table or a folder of runs.

    Writes table.csv and a commented campaign.toml. It proposes what each column is and shows what the numbers say of signs. On a terminal it asks; elsewhere it lists all
    open points at once with the arguments that settle them. Axes, angle signs, reference point and inertia are never guessed.
    """
    from coeflab.core.errors import OutputError
    from coeflab.core.files import typed, write_all
    from coeflab.tables.conditions import NoConditionError
    from coeflab.tables.imported import checked, contents
    from coeflab.tables.mapping import assigned
    from coeflab.tables.questions import understood
    from coeflab.tables.raw_table import SeveralError
    from coeflab.tables.reading import importer_of, read_raw
    from coeflab.tables.settings import assumed, doubtful_setting, stated_settings

    file, out = typed(path), typed(out)
    if not force and out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise OutputError(f"{out} exists and is not empty. Name another --out, or replace it with --force.")
    said = _said(mapping, set_, [*option, *of_runs(name, runs, state)], as_)
    importer = importer_of(file, said.importer)
    sheets: tuple[str, ...] = ()
    while True:
        try:
            with show.narrated(), show.progress(False) as say:
                raw = read_raw(file, importer, said.options, say)
            break
        except SeveralError as several:
            if not several.choices or not sys.stdin.isatty():
                raise several if not several.choices else _each(several, path, out) from None
            sheets = several.choices
            said.options["sheet"] = _asked_sheet(sheets)
        except NoConditionError as unsaid:
            if name or runs or not sys.stdin.isatty():
                raise
            said.options["names"] = _asked_pattern(unsaid)
    said.columns |= _mapped(map_, raw)
    settings = assumed(out) | stated_settings(raw) | said.settings
    found = understood(raw, said.columns, settings, yes)
    described(raw, importer, found)
    if sys.stdin.isatty():
        columns, settings = _asked(raw, said.columns, settings, found, yes)
    else:
        columns, settings = _without_asking(file, found, settings, yes)
        _listed(
            "Check", [f"warning, {key}: {why}" for key in settings if (why := doubtful_setting(raw, settings, key))]
        )
    known = assigned(raw, columns)
    made = contents(raw, importer, said.options, known, columns, settings)
    table = checked(made, raw, columns)
    write_all(out, made)
    _written(out, table, settings)
    others = [s for s in sheets if s != said.options.get("sheet")]
    _listed(
        "The other sheets, with the answers of this one",
        [_of_sheet(path, s, out, out / "mapping.toml") for s in others],
    )


def _of_sheet(path: str, sheet: str, out: Path, mapping: Path | None = None) -> str:
    """The command that imports one sheet into a folder of its own."""
    from coeflab.core.wording import identifier

    words = ["coeflab", "import", path, "--option", f"sheet={sheet}", *(["--mapping", str(mapping)] if mapping else [])]
    return shlex.join([*words, "--out", f"{out}_{identifier(sheet)}"])


def _each(several: SeveralError, path: str, out: Path) -> SeveralError:
    """The error of a file with several tables, with a command for each; fits take several campaigns together."""
    commands = "; ".join(_of_sheet(path, sheet, out) for sheet in several.choices)
    made = type(several)(several.found, several.expected, file=several.file, advice=f"One each: {commands}.")
    made.choices = several.choices
    return made


def _asked_sheet(sheets: Sequence[str]) -> str:
    """The sheet that is meant, by its name or number."""
    show.sentence("Sheets with rows of numbers: " + ", ".join(f"{i} {s}" for i, s in enumerate(sheets, start=1)) + ".")
    while True:
        typed = str(typer.prompt("  sheet")).strip()
        if typed in sheets:
            return typed
        if typed.isdecimal() and 0 < int(typed[:4]) <= len(sheets):
            return sheets[int(typed[:4]) - 1]
        show.error(f"  {typed}: no such sheet")


def _asked_pattern(open_: NoConditionError) -> str:
    """The pattern of the runs' names, proposed, with what it makes of them, and confirmed."""
    from coeflab.tables.conditions import SPELT, UNNAMED, name_pattern

    show.sentence(f"No file states an angle, rate or speed for {len(open_.runs)} runs, such as {', '.join(open_.runs[:FEW])}. A pattern of "
                  f"their names says it: {{beta:deg}} for a number, * for any text. {SPELT}.")  # fmt: skip
    if UNNAMED in open_.pattern:
        show.sentence(f"They look like {open_.pattern}, with NAME beta, alpha, r, U ... and its UNIT.")
    default = open_.pattern if UNNAMED not in open_.pattern else ""
    while True:
        try:
            pattern = name_pattern(str(typer.prompt("  --name", default=default or None)).strip(" '\""))
        except InputError as why:
            show.error(f"  {why}")
            continue
        read = {run: pattern.conditions(run) for run in open_.runs}
        if unfit := [run for run, found in read.items() if not found]:
            show.error(f"  The name {unfit[0]} does not fit. {SPELT}.")
            continue
        told = [
            f"{run}: " + ", ".join(f"{key} = {one}".partition(" (name")[0] for key, one in (found or {}).items())
            for run, found in read.items()
        ]
        _listed("Read as", told)
        if typer.confirm("  Is that what they are, number, sign and unit?", default=None):
            return pattern.text


def described(raw: RawTable, importer: str, found: Understood) -> None:
    """Print what a file is, its columns, what it says of itself and what its numbers show."""
    from coeflab.report.tables import raw_tables
    from coeflab.tables.collect import runs_shown

    said = "; ".join(f"{key} {text}" for key, text in raw.dialect.items() if key != "importer")
    show.sentence(f"{raw.path}: read by {importer}" + (f"; {said}" if said else ""))
    if runs := runs_shown(raw, MOST):
        show.table(runs)
    show.table(raw_tables.columns(raw, found.proposals, found.mapping))
    show.table(raw_tables.stated(raw))
    _listed("Left out or mended", raw.remarks)
    _listed("The numbers show", [e.text for e in found.shows])


MOST, FEW = 12, 3


def _listed(title: str, texts: Sequence[str]) -> None:
    if not texts:
        return
    show.text(title)
    for text in texts[:MOST]:
        show.lines(textwrap.fill(text, 79, initial_indent="  ", subsequent_indent="    ", break_long_words=False))
    if len(texts) > MOST:
        show.text(f"  and {len(texts) - MOST} more")
    show.text()


def _said(mapping: Path | None, set_: Sequence[str], option: Sequence[str], as_: str) -> Said:
    """All that the command line and a saved mapping say, but for columns; complaints at once."""
    from coeflab.core.errors import shown, together
    from coeflab.tables.settings import Setting, read_setting, saved_mapping

    out = Said()
    if mapping is not None:
        out.columns, out.settings, out.importer, out.options = saved_mapping(mapping)
    out.importer = as_ or out.importer
    complaints: list[InputError] = []
    for text in set_:
        key, equals, said = text.partition("=")
        if not equals:
            complaints.append(InputError(shown(text), "KEY=VALUE, such as axes.frame=CFD", column="--set"))
            continue
        try:
            out.settings[key.strip()] = Setting(read_setting(key.strip(), said.strip()), "confirmed")
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


Settled = tuple[Mapping[str, "ColumnMap"], dict[str, "Setting"]]


def _without_asking(file: Path, found: Understood, settings: Mapping[str, Setting], yes: bool) -> Settled:
    """Everything that is settled; what is not, in one error."""
    from coeflab.tables.questions import open_points

    if points := open_points(found, yes):
        raise OpenError(file, points, found.complaints)
    _possible(found)
    taken = {q.key: _taken(q, q.default) for q in found.questions}
    return found.mapping, {**settings, **taken}


def _possible(found: Understood) -> None:
    from coeflab.core.errors import together

    if found.complaints:
        raise together(list(found.complaints))


def _taken(question: Question, text: str) -> Setting:
    from coeflab.tables.settings import Setting, read_setting

    return Setting(read_setting(question.key, text), question.why if text == question.default else "confirmed")


def _asked(
    raw: RawTable, said: Mapping[str, ColumnMap], settings: Mapping[str, Setting], found: Understood, yes: bool
) -> Settled:
    """Everything, asked for where it is open; a default only where the file or clear evidence gives one."""
    from coeflab.tables.questions import alone, together_with, understood
    from coeflab.tables.settings import doubtful_setting

    _listed("Check", [f"warning, {key}: {why}" for key in settings if (why := doubtful_setting(raw, settings, key))])
    answers = {**said, **_asked_columns(raw, found)}
    settings = dict(settings)
    shown = {e.text for e in found.shows}
    judged = set(said)
    while True:
        now = understood(raw, answers, settings, yes, judged)
        fresh = [e for e in now.shows if e.text not in shown]
        _listed("The numbers show", [e.text for e in fresh])
        shown |= {e.text for e in now.shows}
        _possible(now)
        against = [e.key for e in fresh if e.key in settings and e.text.startswith("warning")]
        if against and not typer.confirm(f"  Keep {against[0]} as declared?", default=None):
            del settings[against[0]]
            continue
        if now.doubts and "axes.frame" in settings:
            one_doubt = now.doubts[0]
            judged.add(one_doubt.column.name)
            answers[one_doubt.column.name] = _judged(one_doubt)
            continue
        if not now.questions:
            return now.mapping, settings
        one = now.questions[0]
        if yes and one.default:
            settings[one.key] = _taken(one, one.default)
        else:
            settings |= _typed(raw, settings, together_with(one, now.questions) or alone(one))


def _judged(doubt: Doubt) -> ColumnMap:
    """What a rate is that the numbers contradict, as a person judges its sign."""
    name = doubt.column.name
    show.sentence(f'Column "{name}": {doubt.why}.')
    turn = doubt.turns.replace("s ", " ", 1)
    if typer.confirm(f"  Does {name} > 0 {turn}?", default=None):
        return doubt.said
    return replace(doubt.said, negative=not doubt.said.negative)


def _typed(raw: RawTable, settings: Mapping[str, Setting], asked: Group) -> dict[str, Setting]:
    """Settings of one line, asked again until it can be read and doubtful numbers are kept; said back where it is not plain."""
    from coeflab.tables.settings import PLACE_KEYS, doubtful_setting

    show.sentence(asked.text)
    while True:
        try:
            enter = asked.enter
            prompt = f"  {asked.name} [{enter}]" if enter else f"  {asked.name}"
            typed = str(typer.prompt(prompt, default="" if enter else None, show_default=False))
            found = {key: _taken(asked.question(key), text) for key, text in asked.answers(typed).items()}
        except InputError as wrong:
            show.error(f"  {wrong}")
            continue
        if len(found) > 1 or set(found) & set(PLACE_KEYS):
            show.sentence("  Taken: " + "; ".join(f"{key} = {one.value}" for key, one in found.items()) + ".")
        doubts = [why for key in found if (why := doubtful_setting(raw, {**settings, **found}, key))]
        for why in doubts:
            show.sentence(f"  warning: {why}.")
        if not doubts or typer.confirm("  Keep it?", default=None):
            return found


def _with_sizes(offered: Sequence[tuple[RawColumn, Proposal]]) -> list[tuple[RawColumn, Proposal]]:
    """Proposals whose coefficients have their area and length, which are asked once for all."""
    from coeflab.core.errors import shown
    from coeflab.core.units import quantity
    from coeflab.tables.proposals import OPEN

    out = list(offered)
    for letter, dimension, unit, example in (("A", "area", "m^2", "0.2 m^2"), ("L", "length", "m", "4.26 m")):
        want = f"{letter}={OPEN}"
        named = [column.name for column, offer in out if want in offer.text]
        if not named:
            continue
        whose = "by 1/2 rho U^2 A" if letter == "A" else "of moments, by 1/2 rho U^2 A L"
        show.sentence(f"{dimension.capitalize()} {letter} of the coefficients {', '.join(named)} ({whose}), such as {example}; "
                      "prime: they are primes by the campaign's length; Enter: each column is asked.")  # fmt: skip
        while typed := str(typer.prompt(f"  {letter}", default="", show_default=False)).strip():
            if typed.casefold().strip("s") == "prime":
                return [(c, replace(o, text=_primed(c, o)) if OPEN in o.text else o) for c, o in out]
            try:
                size = quantity(float(typed) if typed.replace(".", "", 1).isdigit() else typed, dimension)
            except InputError as why:
                show.error(f"  {why}")
                continue
            if size <= 0.0:
                show.error(f"  found {shown(typed)}; expected a number above zero")
                continue
            out = [(c, replace(o, text=o.text.replace(want, f"{letter}={size!r} {unit}"))) for c, o in out]
            break
    return out


def _primed(column: RawColumn, offer: Proposal) -> str:
    """The proposal of a coefficient as a prime, counted in what the file says."""
    from coeflab.tables.column_map import share

    name = offer.text.partition(" [")[0]
    return (
        f"{name}' [{column.unit.strip() if share(column.unit) else '-'}]" if "coefficient" in offer.text else offer.text
    )


def _asked_columns(raw: RawTable, found: Understood) -> dict[str, ColumnMap]:
    from coeflab.tables.column_map import read_column_map
    from coeflab.tables.mapping import error_of, with_unit

    out: dict[str, ColumnMap] = {}
    opened = _with_sizes(found.open)
    whole = [(column, offer) for column, offer in opened if offer.whole]
    if whole:
        show.sentence(
            "Proposed by name and unit: "
            + "; ".join(f"{c.name} = {o.text}" + f" ({o.note})" * bool(o.note) for c, o in whole)
            + "."
        )
        if typer.confirm("  All of them right?", default=None):
            out = {column.name: read_column_map(offer.text) for column, offer in whole}
    for column, offer in opened:
        if column.name in out or error_of(column, out):
            continue
        hint = f"{offer.text}: {offer.why}" if offer.text else offer.why
        own = column.unit not in ("", "-", "1")
        example = f"Y or -Y, in the file's {column.unit}" if own else "Y [N], -beta [deg], r' [-]"
        show.sentence(f'Column "{column.name}" ({hint}). Say {example}, label, ignore ...')
        while column.name not in out:
            try:
                answer = read_column_map(str(typer.prompt(f"  {column.name}")))
                if answer.name != "ignore":
                    with_unit(raw, column, answer)
                out[column.name] = answer
            except InputError as why:
                show.error(f"  {why.found}; expected {why.expected}. {why.advice}".rstrip())
    return out


def _written(out: Path, table: ForceTable, settings: Mapping[str, Setting]) -> None:
    """What was written, what was taken without a question, and the next command."""
    from coeflab.tables.settings import CONFIRMED

    taken = [f"{k} = {s.value} ({s.origin})" for k, s in settings.items() if not s.origin.startswith(CONFIRMED)]
    _listed("Taken as it stands", taken)
    many = len(table.exclusions)
    excluded = f", {many} cell{'s' * (many != 1)} excluded" if many else ""
    show.text(f"Written: {out / 'table.csv'} ({len(table)} rows{excluded}), campaign.toml, mapping.toml")
    show.sentence(f"  varies: {', '.join(table.varies) or 'nothing'}; in SI and FRD: {', '.join(table.forces)}")
    show.command_line("Next", f"coeflab fit {shlex.quote(str(out))}")

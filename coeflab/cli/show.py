"""Printing: lines that fit the terminal, coloured there and plain in a pipe, one JSON object for machines.

What users named can hold control characters, which a terminal obeys; they are shown as ``U+XXXX``.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

import typer

from coeflab.api.names import FRESH_DENSITY
from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, Line, Table, folded, set_lines
from coeflab.report.printable import visible

if TYPE_CHECKING:
    from pathlib import Path

    from coeflab.api.parameters import ParameterFile


SLOW = 2.0
QUOTED = re.compile(r"'[^']*'|\"[^\"]*\"")  # words of a shell that hold blanks
MOST_WARNINGS, MOST_FILES = 8, 4  # before they are named in short
COLOURS = {
    "pass": "green", "holds": "green", "within": "green", "written": "green", "fail": "bold red", "apart": "bold red",
    "warn": "yellow", "beyond": "yellow", "no verdict": "dim", "no table": "dim", "no data": "dim",
}  # fmt: skip
ANSI: dict[str, dict[str, Any]] = {"fail": {"fg": "red", "bold": True}, "warn": {"fg": "yellow"}}
STYLES = {"title": "bold", "head": "underline", "note": "dim"}


def text(line: str = "") -> None:
    """A line on standard output, folded between words to the terminal's width; a long word such as a path stays whole."""
    for part in _folded(visible(line), width()):
        typer.echo(part)


def lines(many: str) -> None:
    """Lines on standard output, as they are: text for machines, or folded already."""
    for line in many.split("\n"):
        typer.echo(visible(line))


def sentence(line: str) -> None:
    """A sentence on standard output; nothing where it is empty."""
    if line:
        text(line)


def marked(word: str, line: str) -> int:
    """A word such as ``warn``, coloured on a terminal, and behind it a sentence that hangs below itself; how many lines."""
    behind = " " * max(6, len(word) + 2)
    first, *others = folded(visible(line), _prose(width()), behind, behind)
    typer.echo(typer.style(word, **ANSI.get(word, {})) + first[len(word) :])
    for one in others:
        typer.echo(one)
    return 1 + len(others)


def path(place: object, more: str = "") -> None:
    """A path alone on its line, unbroken; what is said of it goes on below where the line is too long."""
    line = f"  {visible(str(place))}"
    if more and len(line) + 2 + len(more) > width():
        typer.echo(line)
        text(f"    {more}")
    else:
        typer.echo(f"{line}  {more}".rstrip())


def command_line(word: str, typed: str, separator: str = ": ") -> None:
    """A command to copy; a long one goes on behind a backslash between words, as a shell reads it."""
    import textwrap

    held = QUOTED.sub(lambda m: m[0].replace(" ", "\0"), visible(f"{word}{separator}{typed}"))
    folded = textwrap.wrap(
        held, _prose(width()) - 2, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False
    )
    typer.echo(" \\\n".join(folded).replace("\0", " "))


def error(line: str) -> None:
    """A line on standard error, folded where a person reads it."""
    for part in _folded(visible(line), _terminal()) if sys.stderr.isatty() else [visible(line)]:
        typer.echo(part, err=True)


def table(content: Table) -> None:
    """A table: coloured on a terminal, the same letters in a pipe."""
    if not content.rows:
        return
    found = set_lines(_visible(content), width() - 1)
    if sys.stdout.isatty():
        _coloured(found)
    else:
        for line in found:
            typer.echo(line.text)
    typer.echo()


def whole() -> bool:
    """Whether ``--wide`` asks for every column and table."""
    return _asked["wide"]


def widen(value: bool) -> None:
    """Take ``--wide`` from the command line."""
    _asked["wide"] = value


def width() -> int:
    """Letters of a line: of the terminal, 80 in a pipe, no end with ``--wide``."""
    return ENDLESS if whole() else _terminal() if sys.stdout.isatty() else PROSE


FRESH_WATER = FRESH_DENSITY
_asked = {"wide": False}
PROSE, NARROWEST, ENDLESS = 80, 40, 1_000_000


def _terminal() -> int:
    import os
    import shutil

    columns = shutil.get_terminal_size().columns
    if not os.environ.get("COLUMNS", "").isdigit():
        with suppress(OSError, ValueError):  # of this output, wherever the interpreter's first one leads
            columns = os.get_terminal_size(sys.stdout.fileno()).columns
    return max(columns, NARROWEST)


def _prose(most: int) -> int:
    """Letters of a line of text: long lines are hard to read."""
    return most if most == ENDLESS else min(most, PROSE) - 1


def _folded(line: str, most: int) -> list[str]:
    """A line as lines of at most 80 letters or the terminal's, which hang below its indent."""
    indent = line[: len(line) - len(line.lstrip())]
    return folded(line.strip(), _prose(most), indent, indent + "  " * bool(indent))


def _visible(content: Table) -> Table:
    from dataclasses import replace

    headers, notes = (tuple(map(visible, texts)) for texts in (content.headers, content.notes))
    rows = tuple(tuple(map(visible, row)) for row in content.rows)
    spare = tuple(map(visible, content.spare))
    return replace(content, title=visible(content.title), headers=headers, rows=rows, notes=notes, spare=spare)


def _coloured(found: Sequence[Line]) -> None:
    """Lines of a table on a terminal; the letters are those of a pipe."""
    from rich.console import Console
    from rich.text import Text

    from coeflab.core.table import GAP, MARGIN

    console = Console(highlight=False)
    for line in found:
        if line.kind in STYLES:
            out = Text(line.text, STYLES[line.kind])
        else:
            # A text that is no Text is read for rich's own markup, which names may happen to hold.
            cells = [_bar(cell) or Text(cell, COLOURS.get(cell.strip(), "")) for cell in line.cells]
            out = Text(MARGIN) + Text(GAP).join(cells)
            out.rstrip()
        console.print(out, soft_wrap=True)


def _bar(cell: str) -> Any:
    """A number with its bar, drawn and coloured: green within U95, red beyond; None where there is no bar."""
    import re

    from rich.text import Text

    found = re.fullmatch(r"([+-]\d+\.\d+ )(#+)(!?)(\s*)", cell)
    if found is None:
        return None
    drawn = "\u2588" * len(found[2]) if (sys.stdout.encoding or "").lower().startswith("utf") else found[2]
    return Text.assemble(found[1], (drawn + found[3], "bold red" if found[3] else "green"), found[4])


def plain_lines(content: Table) -> list[str]:
    """The table as aligned plain text."""
    return [line.text for line in set_lines(content, width() - 1)]


def json_object(content: dict[str, Any]) -> None:
    """One JSON object on standard output; numbers, truth values and arrays of numpy count as Python's."""
    written = json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False, default=_of_numpy)
    try:
        written.encode(sys.stdout.encoding or "utf-8")
    except UnicodeEncodeError:  # JSON has codes of its own for letters that the console lacks
        written = json.dumps(content, indent=2, allow_nan=False, default=_of_numpy)
    typer.echo("".join(ch if ch.isprintable() or ch == "\n" else json.dumps(ch)[1:-1] for ch in written))


def _of_numpy(value: Any) -> Any:
    """What numpy's own scalars and arrays hold, as Python has it."""
    try:
        return value.tolist()
    except AttributeError:
        raise TypeError(f"no JSON is known for {type(value).__name__}") from None


def in_browser(address: str) -> None:
    """Open an address in the browser; says so where there is none."""
    import webbrowser

    if not webbrowser.open(address):
        error(f"No browser could be started; open {address} yourself.")


def step(line: str, quiet: bool) -> None:
    """What begins, on standard error while it is a terminal; without a thread, so that work can be shared among cores."""
    if not quiet and sys.stderr.isatty():
        error(f"{line} ...")


@contextmanager
def progress(quiet: bool) -> Iterator[Callable[[str], None]]:
    """Says what happens on standard error, while it is a terminal; its thread is gone afterwards."""
    if quiet or not sys.stderr.isatty():
        yield lambda _: None
        return
    import threading

    from rich.console import Console
    from rich.text import Text

    with Console(stderr=True).status("reading") as status:
        yield lambda line: status.update(Text(visible(line)))
    # rich tells its thread to end and does not wait; while it lives, drawing keeps to one core.
    for thread in threading.enumerate():
        if type(thread).__module__.startswith("rich."):
            thread.join(1.0)


@contextmanager
def narrated() -> Iterator[None]:
    """Passes on to standard error what readers say of large meshes; on a terminal also what is being done, once it lasts."""
    import logging

    from coeflab.core.machine import STAGE

    with _slow_status() as update:

        class Echo(logging.Handler):
            def emit(self, record: logging.LogRecord) -> None:
                if record.name == STAGE:
                    update(record.getMessage())
                else:
                    error(record.getMessage())

        logger, handler = logging.getLogger("coeflab"), Echo(logging.INFO)
        before = logger.level
        logger.addHandler(handler)
        logger.setLevel(logging.INFO)
        try:
            yield
        finally:
            logger.setLevel(before)
            logger.removeHandler(handler)


@contextmanager
def _slow_status() -> Iterator[Callable[[str], None]]:
    """A line on standard error that appears after two seconds, while it is a terminal."""
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from threading import Timer

    from rich.console import Console
    from rich.text import Text

    status = Console(stderr=True).status("working")
    timer = Timer(SLOW, status.start)
    timer.daemon = True
    timer.start()
    try:
        yield lambda line: status.update(Text(visible(line)))
    finally:
        timer.cancel()
        status.stop()


def written(folder: Path, names: Sequence[str], changed: int, exported: Sequence[str] = ()) -> None:
    """Where the files are: pages, parameter files and what a simulator loads by name, of the others how many; all with ``--wide``."""
    text(f"Written ({changed} of {len(names)} files changed):")
    ranks = ((".html", ".pdf"), (".parameters.json",))
    first = [n for ends in ranks for n in names if n.endswith(ends)] or list(names[:1])
    first += [n for n in names if n in exported and n not in first]
    first = first if len(first) <= MOST_FILES else first[:1]
    for name in names if whole() else first:
        path(folder / name)
    if not whole() and len(names) > len(first):
        path(folder, f"{len(names) - len(first)} more; --wide names them")


def findings(found: Sequence[Check], *, notes: bool = False, most: int = 0) -> None:
    """Every failure and warning, those of one rule together, and notes where they are asked for; the rest is counted.

    Of more than `MOST_WARNINGS` warnings those of one check are a line, with ``--wide`` all. With ``most`` no finding begins below that many lines, failures first; what is left out is counted.
    """
    counts = {s.value: sum(c.severity is s for c in found) for s in Severity}
    groups: dict[tuple[Severity, str, str, str], list[Check]] = {}
    notes = notes or whole()
    in_short = not notes and not most and sum(c.severity is Severity.WARN for c in found) > MOST_WARNINGS
    for severity in (Severity.FAIL, Severity.WARN, *((Severity.NOTE,) if notes else ())):
        for c in found:
            if c.severity is severity:
                alone = ("", "") if in_short and severity is Severity.WARN else (c.rule, c.comment)
                groups.setdefault((severity, c.name, *alone), []).append(c)
    printed = left = 0
    for (severity, name, rule, comment), same in groups.items():
        if in_short and severity is Severity.WARN:
            marked(str(severity), _in_short(name, same))
            continue
        if most and printed >= most:
            left += len(same)
            continue
        about = name.replace("_", " ")
        meant = comment if notes or severity is Severity.FAIL else _short(comment)
        if len(same) == 1:
            (c,) = same
            stop = "" if c.statistic.endswith(".") else "."
            held = f" Expected: {rule}." if rule else ""
            printed += marked(
                str(severity), f"{about}, {c.subject}: {c.statistic}{stop} {meant}{held}".replace("  ", " ").rstrip()
            )
            continue
        alike = {c.statistic for c in same}
        shared = f"{same[0].statistic}. " if len(alike) == 1 else ""
        held = f" Expected: {rule}." if rule else ""
        printed += marked(
            str(severity),
            f"{about}, {len(same)} findings{': ' if shared else '. '}{shared}{meant}{held}".replace("  ", " ").rstrip(),
        )
        shown = same[: max(most - printed, 1)] if most else same
        for c in shown:
            text(f"        {c.subject}" if shared else f"        {c.subject}: {c.statistic}")
        printed, left = printed + len(shown), left + len(same) - len(shown)
    if left:
        text(f"        and {left} more, which `coeflab fit` shows")
    held_back = {Severity.WARN.value: " (--wide shows their numbers)"} if in_short else {}
    hint = held_back or (
        {Severity.NOTE.value: " (--wide shows them)"} if counts[Severity.NOTE.value] and not notes and not most else {}
    )
    text("Checks: " + ", ".join(f"{n} {name}{hint.get(name, '')}" for name, n in counts.items()) + ".")


def _in_short(name: str, same: Sequence[Check]) -> str:
    """The warnings of one check: whose they are, and the first advice."""
    others = len({c.subject for c in same}) - 1
    more = f" and {others} more" if others else ""
    return f"{name.replace('_', ' ')}, {same[0].subject}{more}: {_short(same[0].comment)}"


def file_findings(name: str, found: Sequence[Check]) -> None:
    """What `coeflab params check` finds wrong in a file that a command uses; nothing where all passes."""
    if any(c.severity in (Severity.FAIL, Severity.WARN) for c in found):
        text(f"Checks of the file {name} (coeflab params check):")
        findings(found)
        text()


def not_used(parameters: ParameterFile, tables: bool = False) -> None:
    """First lines of a command: what of the file's sources of force it does not use; nothing where it uses all."""
    from coeflab.api.parameters import not_used as by_law

    found(by_law(parameters, tables))


def found(findings: Sequence[Finding]) -> None:
    """Findings in words, a line each."""
    from coeflab.core.texts import remark

    for line in map(remark, findings):
        text(line)


def failed(found: Sequence[Check]) -> bool:
    """Whether a finding is a failure."""
    return any(c.severity is Severity.FAIL for c in found)


def exit_code(failed: bool, warned: bool, strict: bool) -> None:
    """End with 1 where a finding fails, or warns and no warning is allowed.

    Raises
    ------
    typer.Exit
    """
    if failed or (strict and warned):
        raise typer.Exit(1)


def _short(comment: str) -> str:
    """The first sentence of what a finding means; all of it with ``--wide``."""
    first, stop, _ = comment.partition(". ")
    return comment if whole() else first + stop.rstrip()

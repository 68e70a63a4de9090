"""Printing: rich tables on a terminal, plain text in a pipe, one JSON object for machines.

What users named can hold control characters, which a terminal obeys; they are shown as ``U+XXXX``.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import typer

from coeflab.report.printable import visible

if TYPE_CHECKING:
    from collections.abc import Callable

    from coeflab.core.table import Table


SLOW = 2.0
ACCELERATIONS = (
    "Acceleration derivatives of the file before its computed added mass, where M + M_A stays positive definite; or computed "
    "throughout."
)
COLOURS = {"pass": "green", "fail": "bold red", "warn": "yellow", "no verdict": "dim", "no table": "dim"}


def text(line: str = "") -> None:
    """A line on standard output."""
    typer.echo(visible(line))


def lines(many: str) -> None:
    """Lines on standard output."""
    for line in many.split("\n"):
        text(line)


def sentence(line: str) -> None:
    """A long line on standard output, folded to 80 columns; nothing where it is empty."""
    import textwrap

    if line:
        lines(textwrap.fill(line, 79, break_long_words=False, break_on_hyphens=False))


def error(line: str) -> None:
    """A line on standard error."""
    typer.echo(visible(line), err=True)


def table(content: Table) -> None:
    """A table for a person on a terminal, or aligned plain text in a pipe."""
    if not content.rows:
        return
    content = _visible(content)
    if sys.stdout.isatty() and _fits(content):
        _rich(content)
    else:
        _plain(content)


def width() -> int:
    """Letters of a line: of the terminal, at least 80, and 80 in a pipe."""
    import shutil

    return max(shutil.get_terminal_size().columns, 80) if sys.stdout.isatty() else 80


def folded(content: Table) -> None:
    """A table whose notes are folded to 80 columns."""
    import textwrap
    from dataclasses import replace

    notes = (line for note in content.notes for line in textwrap.wrap(note, 77, subsequent_indent="  "))
    table(replace(content, notes=tuple(notes)))


def _visible(content: Table) -> Table:
    from dataclasses import replace

    headers, notes = (tuple(map(visible, texts)) for texts in (content.headers, content.notes))
    rows = tuple(tuple(map(visible, row)) for row in content.rows)
    return replace(content, title=visible(content.title), headers=headers, rows=rows, notes=notes)


def _fits(content: Table) -> bool:
    """Whether the terminal is wide enough to keep every number on one line; text columns may fold to 12 characters."""
    import shutil

    rows = [content.headers, *content.rows]
    longest = [max(len(word) for row in rows for word in (row[i].split() or [""])) for i in range(len(content.headers))]
    whole = [max(len(row[i]) for row in content.rows) for i in range(len(content.headers))]
    widths = [max(longest[i], 12) if i in content.left else max(whole[i], longest[i]) for i in range(len(whole))]
    return sum(min(w, 40) for w in widths) + 3 * len(widths) <= shutil.get_terminal_size().columns


def _rich(content: Table) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table as RichTable
    from rich.text import Text

    # A title that is no Text is read for rich's own markup, which names may happen to hold.
    out = RichTable(title=Text(content.title, "bold"), title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    for i, header in enumerate(content.headers):
        out.add_column(
            Text(header),
            justify="left" if i in content.left else "right",
            overflow="fold",
            no_wrap=i not in content.left and " " not in header,
        )
    for row in content.rows:
        out.add_row(*(Text(cell, style=COLOURS.get(cell, "")) for cell in row))
    console = Console()
    console.print(out)
    for note in content.notes:
        console.print(Text(note, style="dim"))
    console.print()


def _plain(content: Table) -> None:
    for line in plain_lines(content):
        typer.echo(line)
    typer.echo()


def plain_lines(content: Table) -> list[str]:
    """The table as aligned plain text."""
    rows = [content.headers, *content.rows]
    widths = [max(len(row[i]) for row in rows) for i in range(len(content.headers))]
    out = [content.title]
    for row in rows:
        cells = [
            c.ljust(w) if i in content.left else c.rjust(w) for i, (c, w) in enumerate(zip(row, widths, strict=True))
        ]
        out.append("  " + "  ".join(cells).rstrip())
    return [*out, *(f"  {note}" for note in content.notes)]


def json_object(content: dict[str, Any]) -> None:
    """One JSON object on standard output."""
    written = json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False)
    try:
        written.encode(sys.stdout.encoding or "utf-8")
    except UnicodeEncodeError:  # JSON has codes of its own for letters that the console lacks
        written = json.dumps(content, indent=2, allow_nan=False)
    typer.echo("".join(ch if ch.isprintable() or ch == "\n" else json.dumps(ch)[1:-1] for ch in written))


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

"""The form of a campaign in the making: shown, answered on a terminal, or ended with the command that answers it."""

from __future__ import annotations

import textwrap
from collections.abc import Collection, Sequence

import typer

from coeflab.api import importing
from coeflab.cli import show
from coeflab.core.errors import InputError
from coeflab.report.tables import raw_tables

MOST, FEW = 12, 3
FOLLOWS = (
    "# columns named so need, in the same command: alpha or beta --set axes.alpha=+ (or -); p, q, r --set table.arm_point=... "
    "--set table.contains_inertia=...; a coefficient --set coefficients.area=..., of a moment .length"
)


def read(draft: importing.Draft) -> None:
    """Read the file and say what is being done."""
    with show.narrated(), show.progress(False) as say:
        draft.read(say)


def asked(draft: importing.Draft) -> None:
    """Show the form, take lines of answers, until nothing is open and an empty line accepts what is shown."""
    draft.understand()
    importing.refuse_contradictions(draft.founds)
    _described(draft)
    changed: set[str] = set()
    again = True
    while True:
        lines = draft.lines()
        if again:
            _shown(draft, lines, changed)
        missing = importing.open_lines(lines)
        hint = "N=VALUE; KEY=VALUE; N ? explains" + ("" if missing else "; Enter accepts all")
        answer = str(typer.prompt(f"  {hint}\n>", default="", show_default=False, prompt_suffix=" ")).strip()
        again = False
        if not answer and missing:
            show.error(f"  Open: {', '.join(f'{one.number} {one.key}' for one in missing)}")
            continue
        try:
            if not answer:
                draft.settle(accept=True)
                if not importing.open_lines(draft.lines()):
                    return
            else:
                given = draft.typed(answer, lines)
                for one in given.explain:
                    show.sentence(f"  {one.key}: {one.about}")
                if not (given.columns or given.settings or given.options):
                    continue
                draft.take(given, lambda: read(draft))
        except InputError as wrong:
            for complaint in wrong.lines:
                show.error(f"  {complaint}")
            continue
        before = {one.key: (one.value, one.group) for one in lines}
        changed = {one.key for one in draft.lines() if before.get(one.key) != (one.value, one.group)}
        again = True


def unasked(draft: importing.Draft, words: Sequence[str], accept: bool) -> None:
    """Settle everything by what the command says, or show the form and the command that does, and stop.

    Raises
    ------
    InputError
        What cannot be, all of it.
    """
    if draft.settle(accept):
        return
    _described(draft)
    lines = draft.lines()
    _shown(draft, lines)
    for key in draft.stated.left:
        own = next((one for one in lines if one.key == key), None)
        about = f"{own.why}" if own else "no such key"
        show.error(f'found "{key}=?", left open; expected a value: {about}')
    missing = importing.open_lines(lines)
    many = f"{len(missing)} open: replace each ? by its value. " if missing else ""
    show.sentence(f"{many}--accept takes the proposals shown. Nothing is written yet.")
    if any(not offer.text for found in draft.founds for _, offer in found.open):
        show.sentence(FOLLOWS)
    if more := draft.inertia():
        show.sentence("# if true: add " + " ".join(f"--set {key}={phrases}" for key, phrases in more.items()))
    show.command_line(
        "coeflab import", " ".join([*words, *(one.argument for one in missing), "--accept"]), separator=" "
    )
    raise typer.Exit(2)


def _shown(draft: importing.Draft, lines: Sequence[importing.Line], changed: Collection[str] = ()) -> None:
    """Print the form, and what looks wrong in it."""
    for line in importing.screen(lines, changed, min(show.width(), 100)):
        show.lines(line)
    show.text()
    print_list("Check", draft.warned())


def _described(draft: importing.Draft) -> None:
    """Print what each table is, what its numbers show, and what is not taken."""
    for part, found in zip(draft.parts, draft.founds, strict=True):
        described(part, found, whole=False)
    print_list("Not taken", draft.left)


def described(part: importing.Part, found: importing.Interpretation, *, whole: bool = True, most: int = 0) -> None:
    """Print what a table is and what its numbers show; its columns and what it says of itself where the form does not; ``most`` of each list."""
    raw = part.raw
    words = "; ".join(f"{key} {text}" for key, text in raw.dialect.items() if key != "importer")
    name = f"{part.name}: " * bool(part.name)
    show.sentence(f"{name}{raw.path}: read by {part.importer}" + (f"; {words}" if words else ""))
    if runs := importing.runs_shown(raw, MOST if whole else FEW):
        show.table(runs)
    if whole:
        show.table(raw_tables.columns(raw, found.proposals, found.mapping))
        show.table(raw_tables.stated(raw))
    print_list("Left out or mended", raw.remarks, most or MOST)
    shows = [e.text for e in found.shows if whole or not e.warns]
    print_list("The numbers show", shows, most + 1 if most else MOST)


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

"""``coeflab import``: a file or folder of any known kind becomes a campaign, once somebody has said what it means."""

from __future__ import annotations

import re
import shlex
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coeflab.cli import options, show
from coeflab.core.errors import OutputError
from coeflab.core.texts import input_error

if TYPE_CHECKING:
    from coeflab import ForceTable
    from coeflab.api.importing import Campaign

MODEL = "manoeuvring_model"
FINDINGS = 12  # lines of findings below the first slopes
EXAMPLE = "coeflab import drift.csv --out cfd_data/mine"
OTHER_OUT = "Name another --out, or replace it with --force."


@options.worded
def command(
    *,
    ctx: typer.Context,
    path: list[str],
    out: Path | None = None,
    map_: list[str],
    set_: list[str],
    mapping: Path | None = None,
    option: list[str],
    as_: str = "",
    name: list[str],
    runs: Path | None = None,
    state: Path | None = None,
    words: Path | None = None,
    accept: bool = False,
    force: bool = False,
) -> None:
    """Make a campaign of a table, several of one folder, or a folder of runs.

    Shows one form: what each column is and what each setting would be, why, and what is open. On a terminal one line answers
    it; elsewhere its last lines are the command that does. Writes table.csv and a commented campaign.toml, and prints the
    first slopes with the checks that fail or warn. Nothing is taken that the form did not show. Exit code 1 when a check fails.
    """
    from coeflab.api.importing import Draft, assumed, of_runs, stated_of, words_of
    from coeflab.cli.draft import asked, print_list, read, unasked
    from coeflab.core.files import readable, typed, write_all

    ctx.with_resource(words_of(words))
    file, among = _one_place(path)
    out = typed(out) if out is not None else _named_after(file)
    readable(file)
    if not force and out.exists() and not _may_be_written(out, accept):
        raise OutputError(f"{out} exists and is not empty. {OTHER_OUT}")
    stated = stated_of(mapping, set_, [*option, *among, *of_runs(name, runs, state)], as_)
    draft = Draft(file, stated, assumed(out), map_)
    read(draft)
    if sys.stdin.isatty():
        asked(draft)
    else:
        unasked(
            draft, _typed_so_far(path, out, map_, set_, mapping, option, as_, name, runs, state, force, words), accept
        )
    campaign = draft.campaign()
    write_all(out, campaign.files, new=not force, otherwise=OTHER_OUT)
    if not sys.stdin.isatty():
        print_list("Check", draft.warned())
    print_list("Not taken", draft.left)  # travels with what was written: the form may not have been shown
    _written(out, campaign, "campaign.body" not in stated.settings)
    failed = _first_slopes(out)
    if failed:
        raise typer.Exit(1)


def _one_place(paths: Sequence[str]) -> tuple[Path, list[str]]:
    """What is read, and the option that chooses several files of a folder."""
    from coeflab.core.files import readable, typed

    files = [typed(path) for path in paths]
    if len(files) == 1:
        return files[0], []
    for file in files:
        readable(file)
    folders = {file.resolve().parent for file in files}
    if len(folders) > 1 or any(file.is_dir() for file in files):
        raise input_error("commands.one_file_several", count_of_files=len(files))
    return files[0].parent, [f"files={','.join(file.name for file in files)}"]


def _may_be_written(out: Path, accept: bool) -> bool:
    """Whether a folder is empty, or may hold what the same command wrote before it was stopped: that is compared byte for byte."""
    from coeflab.core.files import names_in

    names = names_in(out) if out.is_dir() else [out.name]
    return not names or (
        accept and out.is_dir() and all(n in ("campaign.toml", "mapping.toml") or n.endswith(".csv") for n in names)
    )


def _named_after(file: Path) -> Path:
    """A folder of the current one, called after what is read."""
    whole = file.resolve()
    name = f"{whole.name}_campaign" if whole.is_dir() or not whole.suffix else whole.stem
    return Path(re.sub(r"[^\w.-]+", "_", name).strip("._") or "campaign")


def _typed_so_far(
    paths: Sequence[str], out: Path, map_: Sequence[str], set_: Sequence[str], mapping: Path | None, option: Sequence[str], as_: str,
    name: Sequence[str], runs: Path | None, state: Path | None, force: bool, words: Path | None,
) -> list[str]:  # fmt: skip
    """The words of the command as they were typed, without what was left open."""
    from coeflab.api.importing import quoted

    typed = [quoted(path) for path in paths]
    alone = {"--as": as_, "--words": words, "--runs": runs, "--state": state, "--mapping": mapping}
    typed += [f"{flag} {quoted(str(phrases))}" for flag, phrases in alone.items() if phrases]
    typed += [f"--name {quoted(text)}" for text in name]
    for flag, many in (("--option", option), ("--map", map_), ("--set", set_)):
        typed += [f"{flag} {quoted(text)}" for text in many if "?" not in text.partition("=")[2]]
    return [*typed, *["--force"] * force, f"--out {quoted(str(out))}"]


def _written(out: Path, campaign: Campaign, by_default: bool) -> None:
    """What was written, which rows of the file were not, what of it no fit uses, and the body where nobody named it."""
    from coeflab.api.importing import without_a_setting
    from coeflab.report.tables.force_tables import unused

    filled, tables = campaign.filled, campaign.tables
    several = len(tables) > 1
    files = [t.file for t in filled]
    sizes = [f"{file} ({len(table)} rows)" for file, table in zip(files, tables, strict=True)]
    show.text(f"Written: {out / sizes[0]}{''.join(f', {one}' for one in sizes[1:])}, campaign.toml, mapping.toml")
    for file, table in zip(files, tables, strict=True):
        of = f"{file}: " * several
        show.sentence(
            f"  {of}varies: {', '.join(table.varies) or _speed_alone(table)}; in SI and FRD: {', '.join(table.forces)}"
        )
    for t in filled:
        for words in without_a_setting(t.raw, t.columns):
            show.sentence(f"{f'{t.file}: ' * several}Rows {words}.")
    show.sentence(unused(tables))
    if body := campaign.tables[0].body if by_default else "":
        show.sentence(f"Body: {body}; other campaigns of this hull: --set campaign.body={body}")
    show.text()


def _speed_alone(table: ForceTable) -> str:
    return "the speed alone" if len(set(table.speed.tolist())) > 1 else "nothing"


def _first_slopes(folder: Path) -> bool:
    """The main table of derivatives that the campaign gives, or in one line why it gives none, and the command for more.

    Below it what the checks find, as `coeflab fit` says it; true where one fails.
    """
    from coeflab.api.campaigns import first_fit
    from coeflab.api.importing import FILE
    from coeflab.core.finding import Severity
    from coeflab.report.tables import results as tables

    failed = False
    with show.progress(False) as say:
        first = first_fit(folder, say)
    study, by = first.study, "" if first.suited else first.by
    typed = f"coeflab fit {shlex.quote(str(folder))}" + f" --fit {first.further}" * bool(first.further)
    if study is None:
        show.sentence(f"No slopes: {first.why}")
    else:
        found = tables.coefficients_in(study, show.width())
        selected = [i for i, head in enumerate(found.headers) if head in ("", "value", "U95", "U95 %")]
        open_ones = {f"{c.symbol}'" for f in study.fits for c in f.coefficients.coefficients if c.value is None}
        lacking = [row[0] for row in found.rows if row[0] in open_ones] if first.by == MODEL else []
        notes = [
            note.partition(". random:")[0] + "." * (". random:" in note)  # what U95 covers, without what its parts are
            for note in found.notes
            if not note.startswith(("Not shown", *([f"{tables.NO_VALUE}:"] if lacking else [])))
        ]
        notes += [f"The rows do not determine {', '.join(lacking)}."] if lacking else []
        notes += [
            *tables.resistances(study),
            tables.primed_about(study),
            *tables.undetermined_by_move(study),
            *tables.answers(study),
        ]
        heading = "First coefficients" if any(f.straight for f in study.fits) else "First slopes"
        show.table(replace(
            found, title=f"{heading}, primed" + f", by {by}" * bool(by), headers=tuple(found.headers[i] for i in selected),
            notes=tuple(notes), rows=tuple(tuple(row[i] for i in selected) for row in found.rows if row[0] not in lacking),
            left=frozenset({0}),
        ))  # fmt: skip
        for c in study.checks:  # the one hint at a wrong sign of a moment; a hull with large fins has it too
            if c.name == "centre_of_pressure" and c.finding is not None and c.finding["way"] == "behind":
                show.marked(str(c.severity), f"centre of pressure, {c.subject}: {c.statistic}. {c.comment}")
        show.findings(study.checks, most=FINDINGS)
        failed = any(c.severity is Severity.FAIL for c in study.checks)
        if failed:
            show.sentence(
                f"The campaign is written, and a check fails. Correct its {FILE}, or import again with --force."
            )
    if first.planned:
        show.command_line("Report", f"coeflab run {shlex.quote(str(folder))}")
    show.command_line("Next", typed)
    return failed

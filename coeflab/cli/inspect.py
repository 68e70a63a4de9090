"""``coeflab inspect``: what a table or a body says once units, axes and signs are settled."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coeflab.cli import options, show
from coeflab.core.errors import InputError
from coeflab.core.files import located
from coeflab.core.texts import input_error

if TYPE_CHECKING:
    from coeflab import Body, ForceTable
    from coeflab.api.inspecting import Run


EXAMPLE = "coeflab inspect suboff_cfd_barehull"


@options.worded
def command(
    *,
    ctx: typer.Context,
    table: str,
    unit: str = "",
    axes: str = "",
    repair: bool = False,
    fill: bool = False,
    sheets: bool = False,
    density: float = show.FRESH_WATER,
    name: list[str],
    runs: Path | None = None,
    as_: str = "",
    option: list[str],
    words: Path | None = None,
    rows: int = 60,
    strict: bool = False,
    json: bool = False,
) -> None:
    """Show a table in SI and FRD, a mesh, or a body.

    Of a table: its declarations, excluded cells and readings that do not belong.

    Of a mesh file without --unit and --axes: what both may be by its size and outline, and the command that takes them.

    Of any other file or folder: what it is, its columns with what they may be, what it states, and what is missing to read
    it as a campaign. Of a body or a mesh file: volume, centre, areas and inertia, once the checks of its mesh have passed.
    """
    from coeflab.api.importing import of_runs, words_of
    from coeflab.api.inspecting import is_mendable, is_raw, lacks_unit_or_axes, names_body

    ctx.with_resource(words_of(words))
    if not 0.0 < density < float("inf"):
        raise InputError(f"a density of {density:g} kg/m^3", "a value above zero", column="--density")
    if names_body(table):
        if lacks_unit_or_axes(table, unit, axes):
            _proposal(table, unit, axes, json)
            return
        try:
            from coeflab.api.body import typed_body

            with show.narrated():
                body = typed_body(table, unit, axes, repair, fill, sheets)
        except InputError:
            if unit or axes or repair or fill or sheets or not is_mendable(table):
                raise
            _proposal(table, unit, axes, json)  # of a URDF, which states its unit and axes
            return
        _body(body, density, json)
        return
    if unit or axes or repair or fill or sheets:
        raise input_error("commands.unit_axes_repair")
    every = [*option, *of_runs(name, runs)]
    if as_ or every or is_raw(table):
        given = [("--as", as_), *(("--name", n) for n in name), ("--runs", str(runs or ""))]
        given += [*(("--option", o) for o in option), ("--words", str(words or ""))]
        _raw(table, as_, every, json, [(flag, phrases) for flag, phrases in given if phrases])
        return
    _tables(table, json, strict, rows)


def _proposal(table: str, unit: str, axes: str, json: bool) -> None:
    """Unit and axes that size and outline propose, and the command that takes them."""
    from coeflab.api.inspecting import proposed
    from coeflab.report.as_json.findings import finding_as_data

    with show.narrated():
        found = proposed(located(table, "geometry"), unit, axes)
    following = " ".join(["coeflab vehicle", shlex.quote(table), *found.options]) if found.closed else ""
    if json:
        words = {"unit": found.unit, "axes": found.axes, "repair": found.repair, "sizes": list(found.sizes)}
        show.json_object(
            {"proposed": words, "findings": [finding_as_data(f) for f in found.findings], "next": following}
        )
        return
    show.found(found.findings)
    if following:
        show.command_line("Next", following)


def _raw(table: str, importer: str, option: Sequence[str], json: bool, given: Sequence[tuple[str, str]]) -> None:
    """What a file is before anybody said what it means, and what is missing to read it as a campaign.

    The next command repeats what was given, as it was given, and names what is open.
    """
    from coeflab.api.importing import Draft, Stated, open_lines, options_of, screen
    from coeflab.api.inspecting import single_run
    from coeflab.cli.draft import MOST, described, print_list
    from coeflab.core.wording import identifier
    from coeflab.report.tables.raw_tables import by_format

    path = located(table, "cfd_data")
    given_it = options_of(option)
    draft = Draft(path, Stated(importer=importer, options=dict(given_it)))
    try:
        with show.narrated(), show.progress(json) as say:
            draft.read(say)
    except InputError as why:
        if run := single_run(path, importer, given_it):
            _run(path, *run, json, why)
            return
        raise
    draft.understand()
    parts, founds, lines = draft.parts, draft.founds, draft.lines()
    out = f"cfd_data/{identifier(path.resolve().stem)}"
    words = ["coeflab import", shlex.quote(table), *(f"{flag} {shlex.quote(phrases)}" for flag, phrases in given)]
    still = [one.argument for one in open_lines(lines)]
    following = " ".join([*words, f"--out {out}", *still, *(["--accept"] if still else [])])
    if json:
        from coeflab.report.tables.raw_tables import as_json

        missing = [{"argument": one.argument, "about": one.about} for one in open_lines(lines)]
        every = [
            as_json(part.raw, part.importer, found.proposals, found.shows) | ({"name": part.name} if part.name else {})
            for part, found in zip(parts, founds, strict=True)
        ]
        content = every[0] if len(every) == 1 else {"path": str(path), "tables": every}
        proposed = [{"key": one.key, "value": one.value, "about": one.about} for one in draft.chosen]
        show.json_object(content | {"proposed": proposed, "missing": missing, "next": following})
        return
    brief = path.is_dir() and not show.whole()
    for part, found in zip(parts, founds, strict=True):
        described(part, found, whole=not brief, most=1 if brief else MOST)
    print_list("Not taken", draft.left)
    selected = [one for one in lines if one.pending or not brief]
    for line in screen(selected, (), min(show.width(), 100), 4 if brief else 99):
        show.lines(line)
    if brief:
        for part, found in zip(parts, founds, strict=True):
            show.sentence(by_format(part.raw, found.proposals))
        show.sentence("--wide: every column and key, and what is left out or mended.")
    show.text()
    show.command_line("Next", following)
    if still:
        show.sentence(f"{len(still)} open: replace each ? by its value. --accept takes the proposals shown.")


def _run(path: Path, importer: str, run: Run, json: bool, missing: InputError) -> None:
    """What a single run holds that is no row of a table yet, and what is missing for it to be one."""
    from coeflab.report.tables import raw_tables

    tables = raw_tables.of_run(run)
    if json:
        words = {t.title: [dict(zip(t.headers, row, strict=True)) for row in t.rows] for t in tables}
        about = {"path": str(path), "importer": importer, "ended": str(run.ended), "why": run.why}
        show.json_object(about | words | {"missing": list(missing.lines)})
        return
    ended = f"{run.ended}: {run.why}" if run.why else str(run.ended)
    show.sentence(f"{path}: a run, read by {importer}; ended {ended}")
    for table in tables:
        show.table(table)
    show.text("Missing to read it as a row of a table")
    for line in missing.lines:
        show.sentence(line)


def _body(body: Body, density: float, json: bool) -> None:
    from coeflab.report.as_json.shapes import body as as_json
    from coeflab.report.tables import added_mass as added_mass_tables

    if json:
        show.json_object(as_json(body, density))
        return
    show.table(added_mass_tables.particulars(body))
    show.table(added_mass_tables.displaced(body, density))
    for line in added_mass_tables.seen(body):
        show.text(f"  {line}")
    show.text("  next: coeflab added-mass for the 6 x 6 matrix, coeflab simplify for cylinders and plates")


def _tables(table: str, json: bool, strict: bool, rows: int) -> None:
    from coeflab.api.inspecting import campaign_tables
    from coeflab.core.finding import Severity
    from coeflab.report.as_json.findings import finding
    from coeflab.report.as_json.studies import table as as_json

    read, found = campaign_tables(located(table, "cfd_data"))
    if json:
        show.json_object({"tables": [as_json(t) for t in read], "checks": [finding(c) for c in found]})
    else:
        _print(read, rows)
        show.findings(found)
    if strict and any(c.severity is Severity.WARN for c in found):
        raise typer.Exit(1)


def _print(read: Sequence[ForceTable], rows: int) -> None:
    from coeflab.core.provenance import work
    from coeflab.report.tables import data_quality, force_tables

    for t in read:
        show.table(force_tables.inspected(t, rows))
        point = ", ".join(f"{x:g}" for x in t.reference_point)
        show.text(f"  {t.title}; body {t.body}; {t.source.kind}; {work(t.source.citation)}")
        show.text(f"  varies: {', '.join(t.varies) or 'nothing'}; moments about ({point}) m from: {t.datum}")
        show.text(f"  primes by {t.scaling}; {t.run_at}")
        for note in t.notes:
            show.text(f"  {note}")
        show.text()
    for quality in data_quality.of_tables(read):
        show.table(quality)

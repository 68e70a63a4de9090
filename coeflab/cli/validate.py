"""``coeflab validate``: a shipped validation against published values."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coeflab.cli import show

if TYPE_CHECKING:
    from coeflab.report.acceptance import Acceptance


EXAMPLE = "coeflab validate suboff"


def command(
    name: str = typer.Argument(..., help="Name of the validation: suboff, huuv, flyingfish, thauv or tank."),
    out: Path | None = typer.Option(None, help="Folder for the files; default reports/NAME."),
    strict: bool = typer.Option(False, "--strict", help="Exit code 1 for a warning, too."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Hold shipped tables against published derivatives, or reproduce a published vehicle; write what comes out."""
    from coeflab.cli.run import REPORTS, carry_out
    from coeflab.published import validation
    from coeflab.report.acceptance import Acceptance

    with show.progress(json) as say:
        say(f"computing {name}")
        found = validation(name)
    if isinstance(found, Acceptance):
        _side_by_side(found, out if out is not None else Path(REPORTS) / name, json)
    else:
        carry_out(found, out, json, strict)


def _side_by_side(found: Acceptance, folder: Path, json: bool) -> None:
    from coeflab.core.files import write_all
    from coeflab.published.documents import report_of, written
    from coeflab.report import acceptance as acceptance_tables
    from coeflab.report.sections import acceptance as acceptance_document
    from coeflab.workbench.exports import parameter_files_rendered

    files = parameter_files_rendered(found.parameter_files) | dict(written(report_of(found).document, ["html"]))
    files |= {f"{found.name}.csv": acceptance_tables.acceptance_csv(found)}
    files |= {f"{name}.svg": figure.svg.encode() for name, figure in found.figures}
    write_all(folder, files)
    paths = [folder / name for name in sorted(files)]
    if json:
        from coeflab.cli.as_json import acceptance

        show.json_object({**acceptance(found), "files": [str(p) for p in paths]})
    else:
        show.text(found.title)
        show.text()
        for line in acceptance_document.headline(found):
            show.text(line)
        show.text()
        for table in acceptance_tables.tables(found):
            show.table(table)
        show.table(acceptance_tables.errata(found))
        for line in found.statements:
            show.text(line)
        for line in (f"Parameter file: {note}" for note in found.file_notes):
            show.text(line)
        bare = [p.name for p in found.parameter_files if not p.measured]
        if bare:
            show.text(f"No measured points in {', '.join(bare)}: these laws are not compared with any.")
        for path in paths:
            show.text(f"  {path}")
    if not found.holds:
        raise typer.Exit(1)

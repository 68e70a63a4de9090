"""``coeflab validate``: a shipped validation against published values."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coeflab.cli import options, show

if TYPE_CHECKING:
    from coeflab.report.acceptance import Acceptance


EXAMPLE = "coeflab validate suboff"


@options.worded
def command(*, name: str, out: Path | None = None, strict: bool = False, json: bool = False) -> None:
    """Compare shipped data with their publication.

    Fits shipped tables and compares the derivatives with published ones, or reproduces a published vehicle; writes report,
    parameter files and tables.
    """
    from coeflab.api.validations import validation
    from coeflab.cli.run import REPORTS, carry_out
    from coeflab.report.acceptance import Acceptance

    with show.progress(json) as say:
        say(f"computing {name}")
        found = validation(name)
    if isinstance(found, Acceptance):
        _side_by_side(found, out if out is not None else Path(REPORTS) / name, json)
    else:
        carry_out(found, out, json, strict)


def _side_by_side(found: Acceptance, folder: Path, json: bool) -> None:
    from coeflab.api.documents import acceptance_files
    from coeflab.core.files import write_all

    files = acceptance_files(found)
    changed = sum(write_all(folder, files).values())
    paths = [folder / name for name in sorted(files)]
    if json:
        from coeflab.report.as_json.studies import acceptance

        show.json_object({**acceptance(found), "files": [str(p) for p in paths]})
    else:
        _print(found)
        show.written(folder, sorted(files), changed)
    if not found.holds:
        raise typer.Exit(1)


def _print(found: Acceptance) -> None:
    """The answer, and the numbers that do not hold; every number with ``--wide``."""
    from coeflab.cli.run import answered
    from coeflab.report import acceptance as acceptance_tables
    from coeflab.report.first_page import answer

    answered(answer(found, drawn=False))
    for whole in found.shown:
        show.table(whole)
    if show.whole():
        for line in acceptance_tables.headline(acceptance_tables.held(found)):
            show.text(line)
        show.text()
        for table in acceptance_tables.tables(found):
            show.table(table)
        show.table(acceptance_tables.errata(found))
        for line in (*found.statements, *(f"Parameter file: {note}" for note in found.file_notes)):
            show.text(line)
    else:
        for table in () if found.shown else acceptance_tables.tables(found):
            show.table(replace(table, rows=tuple(row for row in table.rows if row[-1] == "fail")))
        show.text("--wide prints every number, erratum and statement.")
    bare = [p.name for p in found.parameter_files if not p.measured]
    if bare:
        show.text(f"Without measured points to compare the force law with: {', '.join(bare)}.")

"""``coeflab validate``: a shipped validation against published values."""

from __future__ import annotations

from pathlib import Path

import typer

EXAMPLE = "coeflab validate suboff"


def command(
    name: str = typer.Argument(..., help="Name of the validation, for example suboff."),
    out: Path | None = typer.Option(None, help="Folder for the files; default reports/NAME."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Hold shipped tables against published derivatives; write report, parameter files and tables."""
    from coeflab.cli.carry_out import carry_out
    from coeflab.studies.validate import validation

    carry_out(validation(name), out, json)

"""``coeflab run``: a plan of the user's own."""

from __future__ import annotations

from pathlib import Path

import typer

EXAMPLE = "coeflab run my_study/plan.toml"


def command(
    plan: Path = typer.Argument(..., help="The plan.toml."),
    out: Path | None = typer.Option(None, help="Folder for the files; default reports/STUDY."),
    strict: bool = typer.Option(False, "--strict", help="Exit code 1 for a warning, too."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Carry out a plan: fit its tables, check them, write report, parameter files and tables."""
    from coeflab.cli.carry_out import carry_out
    from coeflab.core.errors import InputError
    from coeflab.core.files import typed
    from coeflab.study.plan import read_plan

    plan = typed(plan)
    file = plan / "plan.toml" if plan.is_dir() else plan
    try:
        carry_out(read_plan(file), out, json, strict)
    except InputError as why:
        if why.file is None:  # an option of a fit, which knows nothing of files
            why.file = file
        raise

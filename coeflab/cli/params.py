"""``coeflab params``: parameter files, and the model files of simulators."""

from __future__ import annotations

from pathlib import Path

import typer

from coeflab.cli import Command, complete, show

app = typer.Typer(help="Check a parameter file; print what its fields mean.", no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False, add_completion=False)  # fmt: skip


@app.callback()
def _root() -> None:
    pass


@app.command(cls=Command, epilog="Example: coeflab params check reports/suboff/suboff_fully_appended.parameters.json")
def check(
    file: Path = typer.Argument(
        ...,
        metavar="PARAMS",
        autocompletion=complete.parameters,
        help="A parameter file, or a model: SDF, URDF or xacro, xdyn YAML, MSS .m.",
    ),
    density: float | None = typer.Option(None, metavar="DENSITY", help="kg/m^3, for a model that states none."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Check a parameter file or a simulator's model.

    The exit code is 1 where a finding fails, and 2 where the file cannot be read, whatever its format.
    """
    from coeflab.core.errors import InputError
    from coeflab.formats.model_files import read_model_file
    from coeflab.report.tables import formats as model_file_tables

    if density is not None and not 0.0 < density < float("inf"):
        raise InputError(f"{density:g}", "a density above zero", column="--density")
    found = read_model_file(file, density)
    p = found.parameters
    if json:
        from coeflab.cli.as_json import findings as findings_json

        show.json_object({
            "valid": True, "format": found.format, "name": p.name, "schema_version": p.schema_version,
            "coefficients": [c.symbol for c in p.coefficients], "passed": found.passed,
            "by_added_mass": [row[0] for row in model_file_tables.by_added_mass(p).rows],
            "findings": findings_json(found.findings),
        })  # fmt: skip
    else:
        show.table(model_file_tables.contents(p, found.format))
        if found.format != "coeflab" or show.whole():
            show.table(model_file_tables.by_added_mass(p))
        show.findings(found.findings, notes=True)
    if not found.passed:
        raise typer.Exit(1)


@app.command(cls=Command, epilog="Example: coeflab params schema > parameter_file.md")
def schema(json: bool = typer.Option(False, "--json", help="Print the JSON Schema.")) -> None:
    """Print what every field of a parameter file means."""
    from coeflab.report.tables.formats import schema_page
    from coeflab.vehicle import parameter_file

    show.lines((parameter_file.schema() if json else schema_page()).decode().removesuffix("\n"))

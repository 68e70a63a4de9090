"""``coeflab params``: parameter files."""

from __future__ import annotations

from pathlib import Path

import typer

from coeflab.cli import show

app = typer.Typer(help="Parameter files.", no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.callback()
def _root() -> None:
    pass


@app.command(epilog="Example: coeflab params check reports/suboff/suboff_fully_appended.parameters.json")
def check(
    file: Path = typer.Argument(..., help="A parameter file."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Validate a parameter file against its schema and say what it holds."""
    from coeflab.model.parameter_file import read_parameter_file
    from coeflab.model.table import Table, coefficient

    p = read_parameter_file(file)
    if json:
        show.json_object({"valid": True, "name": p.name, "schema_version": p.schema_version,
                          "coefficients": [c.symbol for c in p.coefficients]})  # fmt: skip
        return
    rows = tuple(
        (c.symbol, coefficient(c.value), coefficient(c.u95), c.status.replace("_", " "), c.origin, c.estimator)
        for c in p.coefficients
    )
    headers = ("", "value", "U95", "status", "origin", "how")
    point = ", ".join(f"{x:g}" for x in p.reference_point.point)
    notes = (
        f"primed by {p.scaling.length_name} {p.scaling.length:.6g} m; about ({point}) m from: {p.reference_point.datum}",
        f"schema {p.schema_version}, written by coeflab {p.provenance.coeflab_version}; valid",
        *p.provenance.notes,
    )
    show.table(Table(f"{p.name} ({p.body})", headers, rows, notes, frozenset({0, 3, 4, 5})))

"""``coeflab inspect``: what a table or a body says once units, axes and signs are settled."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import typer

from coeflab.cli import show
from coeflab.core.errors import InputError

if TYPE_CHECKING:
    from coeflab.tables.force_table import ForceTable


EXAMPLE = "coeflab inspect suboff_cfd_barehull"


def command(
    table: str = typer.Argument(
        ..., help="A campaign folder, one CSV of it, or a shipped campaign's name; or a body.toml, or a mesh file."
    ),
    unit: str = typer.Option("", help="Unit of a mesh file: m, mm, in ..."),
    axes: str = typer.Option("", help="Axes of a mesh file: FRD, FLU, CFD, or three directions with commas."),
    repair: bool = typer.Option(False, "--repair", help="Mend a mesh file that is not sound, and say what was mended."),
    density: float = typer.Option(1000.0, "--density", help="Of the water that a body displaces, kg/m^3."),
    rows: int = typer.Option(60, "--rows", min=0, help="Most rows of a table that are shown; 0 shows all."),
    strict: bool = typer.Option(False, "--strict", help="Exit code 1 for a warning, too."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Show a force table in SI and FRD with its declarations, excluded cells and readings that do not belong.

    Of a body or a mesh file: volume, centre, areas and inertia, once the checks of its mesh have passed.
    """
    from coeflab.bodies.simplify.source import names_body

    if names_body(table):
        _body(table, unit, axes, repair, density, json)
        return
    if unit or axes or repair:
        raise InputError(
            "--unit, --axes or --repair", "a mesh file with them", advice="A campaign.toml says these itself."
        )
    _tables(table, json, strict, rows)


def _body(name: str, unit: str, axes: str, repair: bool, density: float, json: bool) -> None:
    from coeflab.bodies.mesh.mesh import TriangleMesh
    from coeflab.bodies.simplify.source import mesh_body
    from coeflab.cli.as_json import body_json
    from coeflab.report.tables import added_mass as added_mass_tables

    if not 0.0 < density < float("inf"):
        raise InputError(f"a density of {density:g} kg/m^3", "a value above zero", column="--density")
    with show.narrated():
        body = mesh_body(name, unit, axes, repair)
    if json:
        show.json_object(body_json(body, density))
        return
    show.table(added_mass_tables.particulars(body))
    show.table(added_mass_tables.displaced(body, density))
    if isinstance(body.shape, TriangleMesh) and body.shape.remade is None:
        show.text(f"  {added_mass_tables.sound(body.shape)}")
    show.text("  next: coeflab added-mass for the 6 x 6 matrix, coeflab simplify for cylinders and plates")


def _tables(table: str, json: bool, strict: bool, rows: int) -> None:
    from coeflab.cli.as_json import finding
    from coeflab.cli.run import findings
    from coeflab.core.files import located
    from coeflab.core.table import Severity
    from coeflab.study.checks import data_gate
    from coeflab.tables.importers import PlannedTable
    from coeflab.workbench import read_tables

    path = located(table, "cfd_data")
    only = path.name if path.is_file() and path.suffix != ".toml" else None
    read = read_tables(PlannedTable(path, (), {}, only))
    found = data_gate.findings(read, read[0].scaling.length)
    if json:
        show.json_object(
            {
                "tables": [
                    {
                        "name": t.name,
                        "body": t.body,
                        "rows": len(t),
                        "varies": list(t.varies),
                        "components": list(t.forces),
                        "reference_point": [float(x) for x in t.reference_point],
                        "datum": t.datum.id,
                        "scaling": str(t.scaling),
                        "density": t.conditions.density,
                        "excluded": [
                            {"line": e.line, "component": e.component, "reason": e.reason} for e in t.exclusions
                        ],
                        "notes": list(t.notes),
                    }
                    for t in read
                ],
                "checks": [finding(c) for c in found],
            }
        )
    else:
        _print(read, rows)
        findings(found)
    if strict and any(c.severity is Severity.WARN for c in found):
        raise typer.Exit(1)


def _print(read: Sequence[ForceTable], rows: int) -> None:
    from coeflab.core.provenance import work
    from coeflab.report.tables import data_quality
    from coeflab.report.tables import results as tables

    for t in read:
        show.table(tables.inspected(t, rows))
        point = ", ".join(f"{x:g}" for x in t.reference_point)
        show.text(f"  {t.title}; body {t.body}; {t.source.kind}; {work(t.source.citation)}")
        show.text(f"  varies: {', '.join(t.varies) or 'nothing'}; moments about ({point}) m from: {t.datum}")
        show.text(f"  primes by {t.scaling}; density {t.conditions.density:g} kg/m^3")
        for note in t.notes:
            show.text(f"  {note}")
        show.text()
    for quality in data_quality.of_tables(read):
        show.table(quality)

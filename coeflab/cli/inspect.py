"""``coeflab inspect``: what a table says once units, axes and signs are settled."""

from __future__ import annotations

import typer

from coeflab.cli import show

EXAMPLE = "coeflab inspect suboff_cfd_barehull"


def command(
    table: str = typer.Argument(..., help="A campaign folder, one CSV of it, or a shipped campaign's name."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Show a force table in SI and FRD with its declarations and excluded cells."""
    from coeflab.core.citations import work
    from coeflab.core.files import located
    from coeflab.model.study import PlannedTable
    from coeflab.presentation import tables
    from coeflab.workbench import read_tables

    path = located(table, "cfd_data")
    only = path.name if path.is_file() and path.suffix != ".toml" else None
    read = read_tables(PlannedTable(path, (), {}, only))
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
                        "datum": t.datum,
                        "scaling": str(t.scaling),
                        "density": t.conditions.density,
                        "excluded": [
                            {"line": e.line, "component": e.component, "reason": e.reason} for e in t.exclusions
                        ],
                        "notes": list(t.notes),
                    }
                    for t in read
                ]
            }
        )
        return
    for t in read:
        show.table(tables.inspected(t))
        point = ", ".join(f"{x:g}" for x in t.reference_point)
        show.text(f"  {t.title}; body {t.body}; {t.source.kind}; {work(t.source.citation)}")
        show.text(f"  varies: {', '.join(t.varies) or 'nothing'}; moments about ({point}) m from: {t.datum}")
        show.text(f"  primes by {t.scaling}; density {t.conditions.density:g} kg/m^3")
        for note in t.notes:
            show.text(f"  {note}")
        show.text()

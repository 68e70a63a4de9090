"""``coeflab added-mass``: the 6 x 6 matrix of a body by several methods."""

from __future__ import annotations

import typer

from coeflab.cli import complete, show

EXAMPLE = "coeflab added-mass suboff_bare_hull"
CONTEXT = {"allow_extra_args": True, "ignore_unknown_options": True}


def command(
    ctx: typer.Context,
    body: str = typer.Argument(
        ...,
        metavar="BODY",
        autocompletion=complete.bodies,
        help="A body.toml, its folder, a shipped body, or a mesh file with --unit and --axes.",
    ),
    method: str = typer.Option(
        "all",
        "--method",
        metavar="METHOD",
        autocompletion=complete.methods,
        help="all, or one: ellipsoid, primitives, strip, strip:lamb, panel ...",
    ),
    unit: str = typer.Option("", metavar="UNIT", help="Unit of a mesh file: m, mm, in ..."),
    axes: str = typer.Option(
        "", metavar="AXES", help="Axes of a mesh file: FRD, FLU, CFD, or three directions with commas."
    ),
    repair: bool = typer.Option(False, "--repair", help="Mend a mesh file that is not sound, and say what was mended."),
    density: float = typer.Option(1000.0, "--density", metavar="DENSITY", help="Of the water, kg/m^3."),
    json: bool = typer.Option(False, "--json", help="Print {method: 6 x 6 in SI}; remarks go to standard error."),
) -> None:
    """Show a body's added mass by several methods.

    About its reference point in FRD. With one method any further --option VALUE goes to it: --method panel --panels 9000 (see coeflab formats panel).
    """
    from coeflab.bodies.simplify.source import mesh_body
    from coeflab.cli.fit import further
    from coeflab.core.provenance import work
    from coeflab.report.tables import added_mass as tables
    from coeflab.report.tables import nouns as noun_tables
    from coeflab.workbench.hulls import added_masses

    with show.narrated():
        found = added_masses(mesh_body(body, unit, axes, repair), density, method, further(ctx.args))
    if json:
        for line in (*(f"{c.name}: {c.title}" for c in found.body.configurations), *tables.remarks(found)):
            show.error(line)
        show.json_object({r.method: r.matrix.tolist() for r in found.results})
        return
    show.table(tables.particulars(found.body))
    show.table(tables.displaced(found.body, density))
    for result in found.results:
        show.table(noun_tables.matrix(result))
    show.table(tables.derivatives(found))
    show.table(tables.symmetry(found))
    show.table(tables.primes(found))
    for citation in found.citations:
        show.text(f"  {work(citation)}")

"""``coeflab added-mass``: the 6 x 6 matrix of a body by several methods."""

from __future__ import annotations

import typer

from coeflab.cli import show

EXAMPLE = "coeflab added-mass suboff_bare_hull"


def command(
    body: str = typer.Argument(..., help="A body.toml, its folder, or a shipped body's name."),
    method: str = typer.Option("all", "--method", help="all, or one: ellipsoid, primitives, strip, strip:lamb ..."),
    density: float = typer.Option(1000.0, "--density", help="Of the water, kg/m^3."),
    json: bool = typer.Option(False, "--json", help="Print {method: 6 x 6 in SI}."),
) -> None:
    """Show a body's added mass by several methods, about its reference point in FRD."""
    from coeflab.core.citations import work
    from coeflab.core.files import located
    from coeflab.presentation import added_mass_tables as tables
    from coeflab.workbench import read_body
    from coeflab.workbench.hulls import added_masses

    path = located(body, "geometry")
    with show.narrated():
        found = added_masses(read_body(path / "body.toml" if path.is_dir() else path), density, method)
    if json:
        show.json_object({r.method: r.matrix.tolist() for r in found.results})
        return
    show.table(tables.particulars(found.body))
    show.table(tables.displaced(found.body, density))
    for result in found.results:
        show.table(tables.matrix(result))
    show.table(tables.derivatives(found))
    show.table(tables.symmetry(found))
    show.table(tables.primes(found))
    for citation in found.citations:
        show.text(f"  {work(citation)}")

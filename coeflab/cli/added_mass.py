"""``coeflab added-mass``: the 6 x 6 matrix of a body by several methods."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from coeflab.cli import options, show
from coeflab.core.texts import input_error

if TYPE_CHECKING:
    from coeflab.api.body import Body

EXAMPLE = "coeflab added-mass suboff_bare_hull"
CONTEXT = {"allow_extra_args": True, "ignore_unknown_options": True}


@options.worded
def command(
    *,
    ctx: typer.Context,
    body: str,
    method: str = "all",
    unit: str = "",
    axes: str = "",
    repair: bool = False,
    fill: bool = False,
    sheets: bool = False,
    wall: str = "",
    distance: str = "",
    error: str = "",
    density: float = show.FRESH_WATER,
    json: bool = False,
) -> None:
    """Show a body's added mass by several methods.

    About its reference point in FRD. With one method any further --option VALUE goes to it: --method panel --panels 9000 (see coeflab formats panel).
    """
    from coeflab.api.body import added_masses, finer, typed_body
    from coeflab.api.questions import share_of
    from coeflab.cli.fit import further
    from coeflab.core.provenance import work
    from coeflab.report.as_json.shapes import added_mass as as_json
    from coeflab.report.tables import added_mass as tables
    from coeflab.report.tables import nouns as noun_tables

    share = f"{100.0 * share_of(error, '--error'):.10g}%" if error else ""
    with show.narrated():
        given = typed_body(body, unit, axes, repair, fill, sheets)
        if wall or distance:
            more = further(ctx.args) | ({"error": share} if share else {})
            _near(given, density, method, wall, distance, more, json)
            return
        found = added_masses(given, density, method, further(ctx.args), error=share)
    if json:
        for line in (*(f"{c.name}: {c.title}" for c in found.body.configurations), *tables.remarks(found)):
            show.error(line)
        chosen = "" if found.none_recommended else found.recommended.method
        show.json_object({r.method: as_json(r, density, chosen) for r in found.results})
        return
    show.table(tables.particulars(found.body))
    show.table(tables.displaced(found.body, density))
    for result in found.results:
        show.table(noun_tables.matrix(result))
    show.table(tables.derivatives(found))
    show.table(tables.symmetry(found))
    show.table(tables.primes(found))
    cost = [f for r in found.results if (f := finer(r, further(ctx.args))) is not None]
    show.found(cost)
    for citation in found.citations:
        show.text(f"  {work(citation)}")


def distances_of(wall: str, distance: str, method: str) -> list[float]:
    """Distances from a wall, m, as typed.

    Raises
    ------
    InputError
        One without the other, another method than panel, or no numbers.
    """
    from coeflab.core.errors import InputError, shown

    if not (wall and distance) or method not in ("all", "panel"):
        raise input_error("commands.wall_without_distance", column="--wall")
    try:
        return [float(word) for word in distance.split(",")]
    except ValueError:
        raise InputError(shown(distance), "metres with commas, such as 0.5,1,2", column="--distance") from None


def _near(
    body: Body, density: float, method: str, wall: str, distance: str, given: dict[str, int | float | str], json: bool
) -> None:
    from coeflab.api.body import near_walls
    from coeflab.report.as_json.shapes import added_mass as as_json
    from coeflab.report.tables import added_mass as tables
    from coeflab.report.tables import nouns as noun_tables

    found = near_walls(body, density, wall, distances_of(wall, distance, method), given)
    if json:
        far = found[0]
        walls = [{"wall": w.wall, "distance": w.distance, "matrix": w.matrix.tolist()} for w in far.walls]
        show.json_object({"method": far.method, **as_json(far, density, far.method), "walls": walls})
        return
    for result in found:
        show.table(noun_tables.matrix(result))
    show.table(tables.near_walls(found))

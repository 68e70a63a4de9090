"""``coeflab formats``: the rooms and their plugins."""

from __future__ import annotations

import typer

from coeflab.cli import show

EXAMPLE = "coeflab formats"


def command(json: bool = typer.Option(False, "--json", help="Print one JSON object.")) -> None:
    """List everything that can be plugged in: importers, fits, exporters, checks, reports, validations."""
    from coeflab.added_mass import ADDED_MASS
    from coeflab.bodies import BODIES
    from coeflab.checks import CHECKS
    from coeflab.exporters import EXPORTERS
    from coeflab.fits import FITS
    from coeflab.importers import IMPORTERS
    from coeflab.model.table import Table
    from coeflab.parameter_importers import PARAMETER_IMPORTERS
    from coeflab.reporting import REPORTERS
    from coeflab.simulators import SIMULATORS
    from coeflab.studies.validate import validations

    rooms = (
        IMPORTERS, BODIES, FITS, ADDED_MASS, SIMULATORS, EXPORTERS, PARAMETER_IMPORTERS, CHECKS, REPORTERS,
    )  # fmt: skip
    rows = [(room.kind, name, room.load(name).summary) for room in rooms for name in room.names()]
    rows += [("validation", name, f"coeflab validate {name}") for name in validations()]
    if json:
        show.json_object({"plugins": [dict(zip(("kind", "name", "summary"), row, strict=True)) for row in rows]})
        return
    show.table(Table("Formats", ("kind", "name", "what"), tuple(rows), (), frozenset({0, 1, 2})))

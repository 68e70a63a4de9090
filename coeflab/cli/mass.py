"""``coeflab mass``: mass, centres, inertia and static trim of a body from its parts."""

from __future__ import annotations

import typer

from coeflab.cli import complete, show

EXAMPLE = "coeflab mass myring_auv"


def command(
    body: str = typer.Argument(
        ...,
        metavar="BODY",
        autocompletion=complete.bodies,
        help="A body.toml with [[mass]], its folder, or a shipped body.",
    ),
    json: bool = typer.Option(False, "--json", help="Print one JSON object: SI, FRD, from the datum."),
) -> None:
    """Show a body's mass part by part, its centres, its inertia and how it trims at rest.

    From [[mass]] in its body.toml: solids, shells, payload, ballast and flooded rooms (docs/bodies.md).
    """
    from coeflab.api.body import read_body
    from coeflab.core.errors import InputError

    found = read_body(body)
    if found.mass_model is None:
        raise InputError(
            f"{found.name}, a body without [[mass]]", "parts with masses",
            advice='Add [[mass]] with name, and mass and centre, or material and of = "hull" and thickness.',
        )  # fmt: skip
    if json:
        show.json_object({"body": found.name, **found.mass_model.as_json()})
        return
    show.table(found.mass_model.table())

"""``coeflab mass``: mass, centres, inertia and static trim of a body from its parts."""

from __future__ import annotations

from coeflab.cli import options, show
from coeflab.core.texts import input_error

EXAMPLE = "coeflab mass myring_auv"


@options.worded
def command(*, body: str, json: bool = False) -> None:
    """Show a body's mass part by part, its centres, its inertia and how it trims at rest.

    From [[mass]] in its body.toml: solids, shells, payload, ballast and flooded rooms (docs/bodies.md).
    """
    from coeflab.api.body import read_body

    found = read_body(body)
    if found.mass_model is None:
        raise input_error("commands.body_without_mass", name=found.name)
    if json:
        show.json_object({"body": found.name, **found.mass_model.as_json()})
        return
    show.table(found.mass_model.table())

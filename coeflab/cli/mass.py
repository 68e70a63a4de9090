"""``coeflab mass``: mass, centres, inertia and static trim of a body from its parts."""

from __future__ import annotations

from coeflab.cli import options, show

EXAMPLE = "coeflab mass myring_auv"


@options.worded
def command(*, body: str, json: bool = False) -> None:
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

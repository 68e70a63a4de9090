"""``coeflab schema``: what each kind of file may say, for people and for editors."""

from __future__ import annotations

import typer

from coeflab.api.schemas import KINDS
from coeflab.cli import complete, options, show

EXAMPLE = "coeflab schema plan > plan.schema.json"


def kinds(incomplete: str) -> list[str]:
    """Kinds of files that begin so."""
    return complete.names(KINDS, incomplete)


@options.worded
def command(
    *,
    kind: str = typer.Argument(
        ..., metavar="KIND", autocompletion=kinds, help=f"{', '.join(KINDS[:-1])} or {KINDS[-1]}."
    ),
) -> None:
    """Print the JSON Schema of a kind of file, for editors."""
    from coeflab.api.schemas import schema

    show.lines(schema(kind).decode().removesuffix("\n"))

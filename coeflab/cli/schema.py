"""``coeflab schema``: what each kind of file may say, for people and for editors."""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from importlib import import_module
from operator import or_
from typing import Any

import typer

from coeflab.cli import complete, show
from coeflab.core.applications import declared

EXAMPLE = "coeflab schema plan > plan.schema.json"
KINDS = {
    "plan": "study.plan.PlanFile",
    "campaign": "tables.campaign.CampaignFile",
    "body": "",
    "published": "vehicle.reference.ReferenceFile",
    "parameters": "",
    **{kind: f"{home}.{place}" for home, theirs in declared("FILES").items() for kind, place in theirs.items()},
}


def kinds(incomplete: str) -> list[str]:
    """Kinds of files that begin so."""
    return complete.names(KINDS, incomplete)


def command(
    kind: str = typer.Argument(
        ...,
        metavar="KIND",
        autocompletion=kinds,
        help=f"{', '.join(list(KINDS)[:-1])} or {list(KINDS)[-1]}.",
    ),
) -> None:
    """Print the JSON Schema of a kind of file, for editors."""
    show.lines(schema(kind).decode().removesuffix("\n"))


def schema(kind: str) -> bytes:
    """The JSON Schema of a kind of file.

    Raises
    ------
    InputError
        No such kind.
    """
    from coeflab.core.declarations import json_schema
    from coeflab.core.errors import InputError, shown

    if kind not in KINDS:
        raise InputError(shown(kind), f"one of {', '.join(KINDS)}", column="kind")
    if kind == "parameters":
        from coeflab.vehicle.parameter_file import schema as of_parameters

        return of_parameters()
    return json_schema(declaration(kind), kind)


def declaration(kind: str) -> Any:
    """The class that declares a kind of file; of bodies all of them, as any of these."""
    if kind == "body":
        from coeflab.bodies.readers import BODIES

        modules: Iterator[Any] = map(BODIES.load, BODIES.names())
        return reduce(or_, (module.File for module in modules if hasattr(module, "File")))
    module, _, name = KINDS[kind].rpartition(".")
    return getattr(import_module(f"coeflab.{module}"), name)

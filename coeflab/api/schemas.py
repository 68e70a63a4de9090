"""`schema`: what each kind of file may say, as a JSON Schema for editors."""

from __future__ import annotations

from functools import reduce
from operator import or_
from typing import Any

from coeflab.core.applications import declared
from coeflab.core.declarations import json_schema
from coeflab.core.errors import InputError, shown
from coeflab.core.registry import of_application

_BROUGHT = {kind: (home, place) for home, theirs in declared("FILES").items() for kind, place in theirs.items()}
KINDS = ("plan", "campaign", "body", "published", "parameters", *_BROUGHT)


def schema(kind: str) -> bytes:
    """The JSON Schema of a kind of file.

    Parameters
    ----------
    kind : str
        One of `KINDS`.

    Raises
    ------
    InputError
        No such kind.

    Examples
    --------
    >>> import json
    >>> json.loads(schema("published"))["type"]
    'object'
    """
    if kind not in KINDS:
        raise InputError(shown(kind), f"one of {', '.join(KINDS)}", column="kind")
    if kind == "parameters":
        from coeflab.vehicle.parameter_file import schema as of_parameters

        return of_parameters()
    return json_schema(_declaration(kind), kind)


def _declaration(kind: str) -> Any:
    """The class that declares a kind of file; of bodies all of them, as any of these."""
    if kind in _BROUGHT:
        home, place = _BROUGHT[kind]
        module, _, name = place.rpartition(".")
        return getattr(of_application(home, module), name)
    from coeflab.bodies.readers import BODIES
    from coeflab.study.plan import PlanFile
    from coeflab.tables.campaign import CampaignFile
    from coeflab.vehicle.published_values import ReferenceFile

    if kind == "body":
        return reduce(or_, (m.File for m in map(BODIES.load, BODIES.names()) if hasattr(m, "File")))
    return {"plan": PlanFile, "campaign": CampaignFile, "published": ReferenceFile}[kind]

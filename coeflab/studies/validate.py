"""Validations: shipped plans that hold real tables against published derivatives."""

from __future__ import annotations

import difflib
from pathlib import Path

from coeflab.core.errors import InputError, shown
from coeflab.core.files import shipped
from coeflab.model.plan import read_plan
from coeflab.model.study import Plan

PLAN = "plan.toml"


def validations() -> tuple[str, ...]:
    """Names of the shipped validations."""
    return tuple(sorted(p.parent.name for p in shipped("cfd_data").glob(f"*/{PLAN}")))


def validation(name: str) -> Plan:
    """The plan of a shipped validation.

    Raises
    ------
    InputError
        No validation has that name.
    """
    if name not in validations():
        near = difflib.get_close_matches(name, validations(), n=1)
        raise InputError(
            f"the validation {shown(name)}",
            f"one of {', '.join(validations())}",
            advice=f"Did you mean {near[0]}?" if near else "",
        )
    return read_plan(Path(shipped("cfd_data")) / name / PLAN)

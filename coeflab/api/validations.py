"""Validations: shipped plans that hold real tables against published derivatives, and published systems reproduced."""

from __future__ import annotations

import difflib
from functools import cache
from pathlib import Path

from coeflab.core.applications import declared
from coeflab.core.errors import InputError, shown
from coeflab.core.files import shipped
from coeflab.core.registry import of_application
from coeflab.report.acceptance import Acceptance
from coeflab.study.plan import read_plan
from coeflab.study.study import Plan

PLAN = "plan.toml"


@cache
def _systems() -> dict[str, tuple[str, str]]:
    """Application and module that reproduce a published system, by its name."""
    return {
        place.parent.name: (home, f"{place.parent.name}.{module}")
        for home, module in declared("VALIDATIONS").items()
        for place in Path(__file__).parents[1].glob(f"{home}/*/{module}.py")
    }


def validations() -> tuple[str, ...]:
    """Names of the shipped validations; plans of synthetic tables validate nothing.

    Examples
    --------
    >>> validations()
    ('estimates', 'flyingfish', 'huuv', 'suboff', 'tank', 'thauv', 'urv')
    """
    plans = (p.parent.name for p in shipped("cfd_data").glob(f"*/{PLAN}"))
    return tuple(sorted((*(name for name in plans if not name.endswith("_synthetic")), *_systems())))


def validation(name: str | Path) -> Plan | Acceptance:
    """The plan of a shipped validation, or a publication as it comes out.

    Raises
    ------
    InputError
        No validation has that name.
    """
    name = str(name)
    if name not in validations():
        near = difflib.get_close_matches(name.casefold(), validations(), n=1)
        raise InputError(
            f"no validation {shown(name)}",
            f"one of {', '.join(validations())}",
            advice=f"Did you mean {near[0]}?" if near else "",
        )
    if name in _systems():
        found: Acceptance = of_application(*_systems()[name]).acceptance()
        return found
    return read_plan(Path(shipped("cfd_data")) / name / PLAN)

"""Drag that was measured or computed at another Reynolds number than that of the file's speed: friction does not scale with 1/2 rho U^2."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.law.friction_line import FRICTION_APART, friction_line
from coeflab.law.symbols import derivative, primed

if TYPE_CHECKING:
    from coeflab.law.coefficient import Coefficient
    from coeflab.law.scaling import Conditions
    from coeflab.tables.force_table import ForceTable


def drag_elsewhere(
    coefficients: Sequence[Coefficient], tables: Sequence[ForceTable], conditions: Conditions, length: float
) -> Iterator[Finding]:
    """One finding for each fitted X0' whose friction differs by more than `FRICTION_APART` at the file's speed, by ITTC 1957.

    Parameters
    ----------
    coefficients : sequence of Coefficient
    tables : sequence of ForceTable
        Those behind the coefficients.
    conditions : Conditions
        Of the file. Without a viscosity its water is taken to be that of the tables.
    length : float
        Of the primes, m.
    """
    for c in coefficients:
        if c.origin != "fit" or c.value is None or derivative(c.symbol).text != "X0":
            continue
        runs = [(r, t.speed) for t in tables if t.campaign == c.campaign and (r := t.reynolds(length)) is not None]
        if not runs:
            continue
        measured = float(np.median(np.concatenate([r for r, _ in runs])))
        speed = float(np.median(np.concatenate([u for _, u in runs])))
        nu = conditions.viscosity
        here = measured * conditions.speed / speed if nu is None else conditions.speed * length / nu
        apart = friction_line(here) / friction_line(measured) - 1.0
        if abs(apart) > FRICTION_APART:
            yield Finding.of(
                "law.drag_of_another_reynolds", f"{primed(c.symbol)} of {c.campaign}", Severity.NOTE, statistic=apart,
                threshold=FRICTION_APART, measured=measured, here=here, water="unknown" if nu is None else "known",
            )  # fmt: skip

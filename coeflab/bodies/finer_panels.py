"""What a smaller error of the panel method would cost: panels, memory and time, and what to type."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from coeflab.bodies.added_mass.panel import MOST_PANELS, Options
from coeflab.bodies.panel_solver.solve import memory_needed
from coeflab.core.finding import Finding, Severity
from coeflab.core.options import parse_options
from coeflab.law.added_mass import AddedMass

FASTER = 2.0  # of the panels: a quarter of the error at second order, half at first
MATTERS = 0.01  # of a diagonal entry: nobody needs less


def finer_panels(found: AddedMass, given: Mapping[str, Any]) -> Finding | None:
    """What about half of the error costs; None of another method, of an error that is unknown, or of one below 1 %.

    Parameters
    ----------
    found : AddedMass
    given : mapping
        Options of the method as they were typed.

    Notes
    -----
    At first order, the lowest, half the error takes panels half as long: four times as many, 16 times the time and memory.
    """
    if found.method != "panel" or found.error is None:
        return None
    own, half = np.diag(found.matrix), np.diag(found.error)
    live = own > half
    worst = float(np.max(np.divide(half, own, out=np.zeros_like(own), where=live), initial=0.0))
    if worst <= MATTERS:
        return None
    panels = parse_options(Options, dict(given), "panel").panels
    more = min(int(panels * FASTER**2), MOST_PANELS)
    if more <= panels:
        return Finding.of("added_mass.finest", found.body, Severity.NOTE, statistic=worst, panels=panels)
    left = worst * float(np.sqrt(panels / more))
    return Finding.of(
        "added_mass.finer", found.body, Severity.NOTE, statistic=worst, advice=f"--method panel --panels {more}",
        panels=more, left=left, times=float((more / panels) ** 2), memory=memory_needed(more) / 2**30,
    )  # fmt: skip

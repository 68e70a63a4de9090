"""What a sweep gives by other forms, with other settings, and without some of its points."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from coeflab.core.table import Table, coefficient, number, percent, probability, with_u95
from coeflab.law.symbols import primed
from coeflab.report.texts import table_of

if TYPE_CHECKING:
    from coeflab.fits.results.fit_result import Sweep


def _window(sweep: Sweep, value: float) -> str:
    if sweep.is_angle:
        return f"{math.degrees(math.asin(min(value, 1.0))):.1f} deg"
    if sweep.variable in ("dr", "ds", "db"):
        return f"{math.degrees(value):.1f} deg"
    return number(value, 3)


def _angle(sweep: Sweep) -> str:
    """The angle that a window is of; empty where the variable is that of a control or a rate."""
    return f"asin({sweep.variable}/U)" if sweep.is_angle else ""


def estimators(sweep: Sweep) -> Table:
    """Single forms in every window: what plain evaluations would have said."""
    rows = tuple(
        (
            e.family.name.format(x=f"{sweep.variable}'"), _window(sweep, e.window), str(len(e.rows)),
            *with_u95(e.value, e.half_hc2), with_u95(e.value, e.half_hc3)[1], number(e.freedom, 3),
            probability(e.lack_of_fit), number(e.aicc, 5),
        )
        for e in sweep.forms
    )  # fmt: skip
    return table_of(
        "sweeps.estimators",
        rows,
        [f"Window: largest {_angle(sweep)}."] if _angle(sweep) else [],
        symbol=primed(sweep.symbol),
    )


def sensitivity(sweep: Sweep) -> Table:
    """The recommended value had the sweep ended sooner."""
    rows = tuple((_window(sweep, s.cap), *with_u95(s.value, s.u95), percent(s.u95, s.value)) for s in sweep.sensitivity)
    title = f"{primed(sweep.symbol)} by largest setting" + (f", {_angle(sweep)}" if _angle(sweep) else "")
    return table_of("sweeps.sensitivity", rows, title=title)


def left_out(sweep: Sweep) -> Table:
    """Points that the sweep does not use."""
    rows = tuple((p.label, signed(sweep, p.x), coefficient(p.y), p.reason) for p in sweep.left_out)
    headers = ("point", sweep.variable, f"{sweep.component}'", "reason")
    return Table(f"Points left out of {primed(sweep.symbol)}", headers, rows, (), frozenset({0, 3}))


def signed(sweep: Sweep, x: float) -> str:
    """A setting of a sweep as people write it, with its sign: degrees, or a rate."""
    return ("-" if x < 0 else "") + _window(sweep, abs(x))

"""Motions and their intervals, and what a merge replaced, for machines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from coeflab.report.tables.uncertainty import ranking

if TYPE_CHECKING:
    from coeflab.law.coefficient import Coefficient
    from coeflab.motion.manoeuvre import Figure, Simulation
    from coeflab.motion.uncertainty.uncertainty import Carried
    from coeflab.vehicle.inertia import WaterInertia
    from coeflab.vehicle.merge import Merged


def accelerations(water: WaterInertia) -> dict[str, Any]:
    """Which accelerations were asked for and taken, and where they come from."""
    return {"asked": water.asked, "used": water.used, "source": water.source, "warnings": list(water.warnings)}


def figures(found: tuple[Figure, ...]) -> list[dict[str, Any]]:
    """Figures of a manoeuvre; absent values are null and carry a status."""
    return [
        {
            "name": f.name, "value": f.value, "unit": f.unit, "status": f.status, "why": f.why or None,
            "interval_95": None if f.low is None else [f.low, f.high], "definition": f.definition,
        }
        for f in found
    ]  # fmt: skip


def simulation(made: Simulation) -> dict[str, Any]:
    """A simulated manoeuvre without its time series."""
    t = made.trajectory
    return {
        "vehicle": made.vehicle.name, "manoeuvre": made.manoeuvre.name, "free": list(made.vehicle.free),
        "accelerations": accelerations(made.vehicle.water), "ended": t.ended.value, "why": t.why or None, "duration": float(t.time[-1]),
        "outside": sorted(name for name, flags in t.outside.items() if flags.any()),
        "determined_until": None if math.isinf(made.determined) else made.determined, "undetermined": made.undetermined or None,
        "figures": figures(made.figures), "statements": list(made.statements),
    }  # fmt: skip


def carried(made: Carried) -> dict[str, Any]:
    """Figures in SI with intervals, shares of the variance, ranking and statements; absent values null."""
    q = made.question
    return {
        "vehicle": made.vehicle, "manoeuvre": q.manoeuvre, "members": q.members, "seed": q.seed,
        "accelerations": accelerations(made.water), "motions": made.runs, "undetermined": made.undetermined or None,
        "figures": [
            {
                "name": s.figure.name, "unit": s.figure.unit, "value": s.figure.value, "status": s.figure.status,
                "median": s.median, "low": s.low, "high": s.high, "low_error": s.low_error, "high_error": s.high_error,
                "members_with_it": s.having, "members_beyond_the_data": s.extrapolated, "interval": s.status, "why": s.why or None,
                "definition": s.figure.definition,
            }
            for s in made.spreads
        ],
        "shares": {
            i.figure: {
                "rows": i.rows,
                "why": i.why or None,
                "if_known": dict(i.known),
                "tests": dict(i.tests),
                "groups": [
                    {
                        "symbols": list(s.symbols), "source": s.source, "first": s.first, "first_bounds": list(s.first_bounds),
                        "total": s.total, "total_bounds": list(s.total_bounds),
                    }
                    for s in i.shares
                ],
            }
            for i in made.importances
        },
        "varied": {s: float(d) for s, d in zip(made.varied.symbols, made.varied.deviation, strict=True)},
        "held": list(made.varied.held), "ranking": list(ranking(made)), "statements": list(made.statements),
    }  # fmt: skip


def merged(made: Merged, of: Sequence[Carried]) -> dict[str, Any]:
    """What was replaced, what is left, and the uncertainty of the first manoeuvre."""

    def one(c: Coefficient | None) -> dict[str, Any] | None:
        return None if c is None else {"value": c.value, "u95": c.u95, "status": str(c.status), "campaign": c.campaign}

    return {
        "name": made.parameters.name,
        "replaced": [{"symbol": r.symbol, "before": one(r.before), "after": one(r.after)} for r in made.replaced],
        "estimates": [c.symbol for c in made.estimates],
        "lengths": made.lengths or None,
        "uncertainty": [carried(c) for c in of],
    }

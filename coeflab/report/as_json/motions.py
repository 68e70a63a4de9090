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


def simulation(result: Simulation) -> dict[str, Any]:
    """A simulated manoeuvre without its time series."""
    t = result.trajectory
    return {
        "vehicle": result.vehicle.name, "manoeuvre": result.manoeuvre.name, "free": list(result.vehicle.free),
        "accelerations": accelerations(result.vehicle.water), "ended": t.ended.value, "why": t.why or None, "duration": float(t.time[-1]),
        "outside": sorted(name for name, flags in t.outside.items() if flags.any()),
        "determined_until": None if math.isinf(result.determined) else result.determined, "undetermined": result.undetermined or None,
        "figures": figures(result.figures), "statements": list(result.statements),
    }  # fmt: skip


def carried(result: Carried) -> dict[str, Any]:
    """Figures in SI with intervals, shares of the variance, ranking and statements; absent values null."""
    q = result.question
    return {
        "vehicle": result.vehicle, "manoeuvre": q.manoeuvre, "members": q.members, "seed": q.seed,
        "accelerations": accelerations(result.water), "motions": result.runs, "undetermined": result.undetermined or None,
        "figures": [
            {
                "name": s.figure.name, "unit": s.figure.unit, "value": s.figure.value, "status": s.figure.status,
                "median": s.median, "low": s.low, "high": s.high, "low_error": s.low_error, "high_error": s.high_error,
                "members_with_it": s.having, "members_beyond_the_data": s.extrapolated, "interval": s.status, "why": s.why or None,
                "definition": s.figure.definition,
            }
            for s in result.spreads
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
            for i in result.importances
        },
        "varied": {s: float(d) for s, d in zip(result.varied.symbols, result.varied.deviation, strict=True)},
        "held": list(result.varied.held), "ranking": list(ranking(result)), "statements": list(result.statements),
    }  # fmt: skip


def merged(result: Merged, of: Sequence[Carried]) -> dict[str, Any]:
    """What was replaced, what is left, and the uncertainty of the first manoeuvre."""

    def one(c: Coefficient | None) -> dict[str, Any] | None:
        return None if c is None else {"value": c.value, "u95": c.u95, "status": str(c.status), "campaign": c.campaign}

    return {
        "name": result.parameters.name,
        "replaced": [{"symbol": r.symbol, "before": one(r.before), "after": one(r.after)} for r in result.replaced],
        "estimates": [c.symbol for c in result.estimates],
        "lengths": result.lengths or None,
        "uncertainty": [carried(c) for c in of],
    }

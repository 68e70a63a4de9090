"""``coeflab glide``: steady glides, speed polar and dive-and-surface cycles of a glider."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import complete, options, show

if TYPE_CHECKING:
    from coeflab.glider.flight import Flown


EXAMPLE = "coeflab glide thauv"


def gliders(incomplete: str) -> list[str]:
    """Shipped gliders, and paths."""
    return complete.or_paths(("thauv", "slocum"), incomplete)


@options.worded
def command(
    *,
    glider: str,
    cycles: int = 1,
    roller: float = 0.0,
    record: float = 1.0,
    out: Path | None = None,
    basis: bool = False,
    json: bool = False,
) -> None:
    """Show the steady glides of a glider and fly its cycles.

    Write CSV and figures with --out. Exit code 1 when a motion ended early.
    """
    from coeflab.core.files import write_all
    from coeflab.core.texts import remark
    from coeflab.glider import tables as glide_tables
    from coeflab.glider.flight import files, fly

    flown = fly(glider, cycles, {"step": record}, math.radians(roller))
    result = {} if out is None else files(flown)
    changed = write_all(Path(out or ""), result)
    if json:
        show.json_object({"gliders": [as_json(f) for f in flown], "files": [str(Path(out or "") / n) for n in result]})
    else:
        for f in flown:
            show.table(glide_tables.steady(f.run.glider, f.steady))
            if any(p.turns for p in f.run.glider.phases):
                show.table(glide_tables.spirals(f.run.glider, f.spirals))
            show.table(glide_tables.phases(f.run))
            for found in f.run.glider.findings:
                show.marked(str(found.severity), remark(found))
            if basis:
                show.table(glide_tables.basis(f.run.glider))
        for name, new in changed.items():
            show.path(f"{Path(out or '') / name}:", "written" if new else "unchanged")
    if not all(f.complete for f in flown):
        raise typer.Exit(1)


def as_json(flown: Flown) -> dict[str, Any]:
    """Steady glides and phases of one glider, SI and radians."""
    from coeflab.report.as_json.findings import finding_as_data

    run = flown.run
    return {
        "name": run.glider.name,
        "title": run.glider.title,
        "citation": run.glider.citation,
        "basis": dict(run.glider.basis),
        "findings": [finding_as_data(x) for x in run.glider.findings],
        "steady_glides": [
            {
                "phase": s.phase,
                "net_mass": s.net_mass,
                "position": s.position,
                "speed": s.speed,
                "alpha": s.alpha,
                "zeta": s.zeta,
                "theta": s.theta,
                "stable": s.stable,
                "growth": s.growth,
            }
            for s in flown.steady
        ],
        "spirals": [
            {
                "phase": phase,
                "speed": s.speed,
                "alpha": s.alpha,
                "beta": s.beta,
                "phi": s.phi,
                "theta": s.theta,
                "turn": s.turn,
                "radius": s.radius,
                "sinking": s.sinking,
            }
            for phase, s in flown.spirals
        ],
        "phases": [
            {
                "phase": run.phase_of(i).name,
                "ends": float(run.time[row]),
                "depth": float(run.depth[row]),
                "x": float(run.x[row]),
                "speed": float(run.speed[row]),
                "met_depth": run.trajectory.reached[i] is not None,
                "settled": run.settled(i),
            }
            for i, row in enumerate(run.ends)
        ],
        "ended": run.trajectory.ended.value,
        "why": run.trajectory.why,
        "statements": list(run.statements),
    }

"""``coeflab tune``: numbers of a parameter file fitted to measured motions."""

from __future__ import annotations

from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from coeflab.cli import complete, options, show

if TYPE_CHECKING:
    from coeflab.identify.tune import Tuned


EXAMPLE = "coeflab tune cfd_data/huuv/tune.toml"


def tunings(incomplete: str) -> list[str]:
    """Shipped plans of a tuning, and paths."""
    return complete.or_paths(complete.shipped_with("cfd_data", "tune.toml"), incomplete)


@options.worded
def command(*, plan: Path, out: Path | None = None, json: bool = False) -> None:
    """Tune numbers of a parameter file to measured steady turns.

    With priors and bounds. Output-error least squares through the vehicle's own equations. Says which parameters the data do not determine, and
    writes the tuned parameter file with its provenance, the motions before and after, and a figure. Exit code 1 when the
    fit did not come to an end.
    """
    from coeflab.cli.run import REPORTS
    from coeflab.identify import tuning_tables
    from coeflab.identify.tune import tune, write
    from coeflab.identify.tuning_plan import read_tuning_plan

    read = read_tuning_plan(plan)
    if not json:
        show.not_used(read.parameters)
    with show.progress(json) as say:
        say(f"tuning {plan}")
        tuned = tune(read)
    paths = write(tuned, out if out is not None else Path(REPORTS) / tuned.plan.name)
    found = tuned.checks
    if json:
        from coeflab.report.as_json.findings import findings

        show.json_object({**as_json(tuned), "findings": findings(found), "files": [str(p) for p in paths]})
    else:
        show.table(tuning_tables.parameters(tuned.tuning))
        show.table(tuning_tables.quantities(tuned.tuning))
        show.table(tuning_tables.correlations(tuned.tuning))
        show.table(tuning_tables.together(tuned.tuning))
        for path in paths:
            show.path(path)
        show.file_findings(tuned.parameters.name, found)
    if not tuned.tuning.converged or show.failed(found):
        raise typer.Exit(1)


def as_json(tuned: Tuned) -> dict[str, Any]:
    """Parameters, quantities, correlations and what stays open; absent values null."""
    t = tuned.tuning
    return {
        "name": t.name,
        "converged": t.converged,
        "birge": t.birge,
        "freedom": t.freedom,
        "parameters": [
            {
                "name": p.name, "unit": p.unit, "before": p.before, "after": p.after, "u95": p.u95,
                "prior_share": p.prior_share, "status": p.status, "places": [w.text for w in f.places],
            }
            for p, f in zip(t.parameters, tuned.plan.free, strict=True)
        ],
        "quantities": [
            {"name": q.name, "unit": q.unit, "cases": q.count, "rms_before": q.rms(after=False), "rms_after": q.rms()}
            for q in t.quantities
        ],
        "correlation": [[None if isnan(v) else v for v in row] for row in t.correlation.tolist()],
        "singular_values": t.singular.tolist(),
        "not_determined": list(t.together),
        "statements": list(t.statements),
    }  # fmt: skip

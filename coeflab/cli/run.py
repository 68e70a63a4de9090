"""``coeflab run``: a plan of the user's own.

Run a plan, write its files, print what a person wants to see first.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

from coeflab.cli import show

if TYPE_CHECKING:
    from collections.abc import Sequence

    from coeflab.core.table import Check
    from coeflab.study.study import Plan, Study


EXAMPLE = "coeflab run my_study/plan.toml"


def command(
    plan: Path = typer.Argument(..., help="The plan.toml."),
    out: Path | None = typer.Option(None, help="Folder for the files; default reports/STUDY."),
    strict: bool = typer.Option(False, "--strict", help="Exit code 1 for a warning, too."),
    json: bool = typer.Option(False, "--json", help="Print one JSON object."),
) -> None:
    """Carry out a plan: fit its tables, check them, write report, parameter files and tables."""
    from coeflab.core.errors import InputError
    from coeflab.core.files import typed
    from coeflab.study.plan import read_plan

    plan = typed(plan)
    file = plan / "plan.toml" if plan.is_dir() else plan
    try:
        carry_out(read_plan(file), out, json, strict)
    except InputError as why:
        if why.file is None:  # an option of a fit, which knows nothing of files
            why.file = file
        raise


REPORTS = "reports"


def carry_out(plan: Plan, out: Path | None, as_json: bool, strict: bool = False) -> None:
    """Run, render everything, then write; exit code 1 when a check or a comparison fails, or an export is refused.

    ``strict``: for a warning, too.
    """
    from coeflab.core.files import write_all
    from coeflab.workbench import rendered, run

    folder = out if out is not None else Path(REPORTS) / plan.name
    with show.progress(as_json) as say:
        study = run(plan, say)
    # Outside of the progress display, whose thread would keep the drawing on one core.
    show.step("drawing the report", as_json)
    files = rendered(study)
    changed = sum(write_all(folder, files).values())
    paths = [str(folder / name) for name in sorted(files)]
    if as_json:
        from coeflab.cli.as_json import study as study_json

        show.json_object(study_json(study, paths))
    else:
        summarise(study)
        show.text(f"Written to {folder} ({changed} of {len(files)} files changed):")
        for path in paths:
            show.text(f"  {path}")
    for refused in study.refused:
        show.error(f"error: {refused.why}")
    if study.failed or (strict and study.warned):
        raise typer.Exit(1)


def summarise(study: Study) -> None:
    """Comparison, coefficients, fitted models and grave findings."""
    from coeflab.report.acceptance import headline, held_of_study
    from coeflab.report.tables import formats as format_tables
    from coeflab.report.tables import models as joint_tables
    from coeflab.report.tables import models as model_tables
    from coeflab.report.tables import nouns as noun_tables
    from coeflab.report.tables import results as tables
    from coeflab.study.towed import towed
    from coeflab.vehicle.derived import stability
    from coeflab.vehicle.force_law import points_of

    show.text(study.plan.title)
    show.sentence(tables.headline(study))
    show.text()
    show.table(tables.side_by_side(study))
    for tow in towed(study):
        show.folded(tables.own_tow(tow))
        show.folded(tables.tow_against(tow))
    verdicts = tables.verdicts(study)
    show.table(verdicts)
    if verdicts.rows:
        show.table(tables.by_campaign(study))
    else:
        show.table(tables.coefficients(study))
    models = tuple(m for f in study.fits for m in f.models)
    for model in models:
        show.table(noun_tables.terms(model))
    show.table(model_tables.quality(models))
    show.table(joint_tables.campaigns(study.fits))
    for name, parameters in study.parameter_files.items():
        show.table(format_tables.at_points(points_of(parameters), f"Force law of {name}"))
    findings(study.checks)
    decided = {f"{p.name} {d.name}" for p in study.parameter_files.values() for d in stability(p) if d.decided}
    for c in study.checks:
        if c.name == "stability" and c.subject in decided:
            show.text(f"{c.subject.split()[0]}: {c.statistic}. {c.comment}")
    judged = [c.passed for c in study.comparisons if c.passed is not None]
    if judged:
        show.text(f"Verdict: {sum(judged)} of {len(judged)} re-analysed coefficients agree within U95.")
        for line in headline(held_of_study(study)):
            show.text(line)


def findings(found: Sequence[Check], folded: bool = False) -> None:
    """Warnings and failures, as a table or as sentences folded to 80 columns; the rest is counted."""
    from coeflab.core.table import Severity
    from coeflab.report.tables import results as tables

    grave = {Severity.FAIL, Severity.WARN}
    shown = tables.checks([c for c in found if c.severity in grave])
    if folded:
        for severity, name, subject, statistic, rule, comment in shown.rows:
            show.sentence(f"{severity}, {name}, {subject}: {statistic}; expected {rule}. {comment}".rstrip())
    else:
        show.table(shown)
    counts = {s.value: sum(c.severity is s for c in found) for s in Severity}
    show.text("Checks: " + ", ".join(f"{n} {name}" for name, n in counts.items()) + ".")

"""``coeflab run``: a plan of the user's own.

Run a plan, write its files, print what a person wants to see first.
"""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

from coeflab.cli import options, show
from coeflab.core.wording import listed

if TYPE_CHECKING:
    from coeflab.api.motion import Simulation
    from coeflab.api.studies import Plan, Study
    from coeflab.report.document import Answer


FEW = 2  # tables whose answers stand on the screen
EXAMPLE = "coeflab run my_study/plan.toml"


@options.worded
def command(*, plan: Path, out: Path | None = None, strict: bool = False, json: bool = False) -> None:
    """Carry out a plan: fits, checks, report, parameter files.

    Prints the answer first; --wide prints every table.
    """
    from coeflab.core.files import typed

    plan = typed(plan)
    carry_out(plan, out, json, strict, str(plan))


REPORTS = "reports"
FIRST_FIGURES = 3


def carry_out(plan: Plan | Path, out: Path | None, as_json: bool, strict: bool = False, typed_as: str = "") -> None:
    """Run, render everything, then write; exit code 1 when a check or a comparison fails, or an export is refused.

    ``strict``: for a warning, too. ``typed_as``: the plan as it was typed, for the next command.
    """
    from coeflab.api.studies import run
    from coeflab.cli.vehicle import for_simulators
    from coeflab.core.files import write_all
    from coeflab.report.rendered import rendered

    with show.progress(as_json) as say:
        study = run(plan, say)
    folder = out if out is not None else Path(REPORTS) / study.plan.name
    # Outside of the progress display, whose thread would keep the drawing on one core.
    show.step("drawing the report", as_json)
    files = rendered(study)
    changed = sum(write_all(folder, files).values())
    paths = [str(folder / name) for name in sorted(files)]
    if as_json:
        from coeflab.report.as_json.shapes import from_shape
        from coeflab.report.as_json.studies import study as study_json

        more = {} if study.shape is None else {"vehicle": from_shape(study)}
        show.json_object(study_json(study, paths) | more)
    else:
        summarise(study, folder)
        show.written(folder, sorted(files), changed, for_simulators(study))
        if typed_as:
            show.command_line("Appendix", f"coeflab report {shlex.quote(typed_as)} --full")
    for refused in study.refused:
        show.error(f"error: {refused.why}")
    show.exit_code(study.failed, study.warned, strict)


def summarise(study: Study, folder: Path) -> None:
    """The answer, the findings that matter, and with ``--wide`` every table."""
    from coeflab.report.first_page import answer
    from coeflab.report.tables import models as model_tables
    from coeflab.report.tables import sources as source_tables
    from coeflab.report.tables.results import answers

    if study.shape is not None:
        from coeflab.cli.vehicle import summarise as of_shape

        of_shape(study, folder)
        show.findings(study.checks)
        return
    answered(answer(study, drawn=False))
    lines = answers(study)
    for line in lines if show.whole() or len(lines) <= FEW else ():
        show.sentence(line)
    if len(lines) > FEW and not show.whole():
        show.sentence(f"A finer grid? --wide answers for {len(lines)} tables.")
    models = tuple(m for f in study.fits for m in f.models)
    if show.whole():
        _every_table(study)
        for source in source_tables.sources(study):
            show.sentence(source)
        show.text()
    else:
        _tows(study)
        for each in model_tables.qualities(models):
            show.table(each)
        show.table(model_tables.campaigns(study.fits))
    _moved(study)
    show.findings(study.checks)


def _moved(study: Study) -> None:
    """What the planned manoeuvres come to: their first figures with a value, or why there is none; with ``--wide`` all."""
    from coeflab.core.finding import Severity
    from coeflab.core.table import Table
    from coeflab.report.sections.manoeuvres import without_u95
    from coeflab.report.tables.motion import figure_table

    rows = []
    without: dict[str, list[str]] = {}
    for result in study.manoeuvres:
        name = result.manoeuvre.name.replace("_", " ")
        found = figure_table(result.figures, f"{name} of {result.vehicle.name}", result.vehicle.length)
        if show.whole():
            show.table(found)
        known = [row for row, figure in zip(found.rows, result.figures, strict=True) if figure.value is not None]
        if not known:
            without.setdefault(f"of {result.vehicle.name}, no value: {_why(result)}", []).append(name)
        rows += [
            (result.vehicle.name if not i else "", name if not i else "", *row[:3], row[-2])
            for i, row in enumerate(known[:FIRST_FIGURES])
        ]
    for why, names in without.items():
        line = listed(names)
        show.marked(str(Severity.WARN), f"{line[:1].upper()}{line[1:]} {why}")
    if rows and not show.whole():
        headers = ("file", "manoeuvre", "quantity", "value", "unit", "status")
        notes = (without_u95(study),)
        show.table(Table("Simulated manoeuvres", headers, tuple(rows), notes, frozenset({0, 1, 2, 4, 5})))


def _why(result: Simulation) -> str:
    """Why a manoeuvre has no quantity with a value."""
    found = next(iter(result.figures), None)
    return result.trajectory.ended.value if found is None else found.why or found.status


def answered(found: Answer) -> None:
    """What a reader wants first: the sentence, the wanted coefficients, and how it stands."""
    from coeflab.report.answer_table import answer_table

    show.sentence(found.sentence)
    show.text()
    show.table(answer_table(found))
    for chip in found.chips:
        if chip.anchor != "checks":  # which `show.findings` counts
            show.marked(str(chip.severity), f"{chip.name}: {chip.text}")


def _tows(study: Study) -> None:
    """Of every body that was towed the coefficients, and its comparison error; of the others that they were not."""
    from coeflab.report.tables import own_cfd

    found = [tow for tow in study.tows if tow.tow.campaign]
    for tow in found if show.whole() else ():
        show.table(own_cfd.own_tow(tow))
        show.table(own_cfd.tow_against(tow))
    if found and not show.whole():
        show.marked("note", f"Own CFD of {'; '.join(t.tow.name for t in found)}: values and E = S - D by --wide")
    absent = [f"{t.tow.name} ({listed(t.tow.absent)})" for t in study.tows if not t.tow.campaign]
    if absent:
        show.sentence(f"Not towed yet: {listed(absent)}.")


def _every_table(study: Study) -> None:
    """Comparison, coefficients, fitted models and force laws."""
    from coeflab.report.acceptance import headline_of_study
    from coeflab.report.tables import comparisons
    from coeflab.report.tables import model_file as law_tables
    from coeflab.report.tables import models as model_tables
    from coeflab.report.tables import nouns as noun_tables
    from coeflab.report.tables import results as tables

    show.sentence(tables.headline(study))
    show.text()
    show.table(comparisons.side_by_side(study))
    _tows(study)
    show.table(comparisons.verdicts(study))
    show.table(comparisons.by_campaign(study))
    show.table(tables.coefficients(study))
    models = tuple(m for f in study.fits for m in f.models)
    for model in models:
        show.table(noun_tables.terms(model))
    for each in model_tables.qualities(models):
        show.table(each)
    show.table(model_tables.campaigns(study.fits))
    for law in law_tables.laws(study):
        show.table(law)
    for line in law_tables.decided(study):
        show.text(line)
    for line in headline_of_study(study) if any(c.passed is not None for c in study.comparisons) else ():
        show.text(line)

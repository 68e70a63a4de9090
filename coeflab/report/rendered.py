"""The files of a study, and of a merge, by name; nothing is written."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.machine import one_thread
from coeflab.formats.export import parameter_files_rendered, placed
from coeflab.motion.manoeuvre import Simulation
from coeflab.motion.uncertainty.uncertainty import Carried
from coeflab.report.content import document
from coeflab.report.document import Document, Section
from coeflab.report.formats import REPORTERS
from coeflab.report.reproduction import digest_of
from coeflab.report.sections.estimates import answer_of_merge, manoeuvre_table, replaced_section
from coeflab.study.study import Study
from coeflab.vehicle.merge import Merged


@one_thread()
def rendered(study: Study, formats: Sequence[str] = ("html",)) -> dict[str, bytes]:
    """Every file of a study: parameter files, exports and the core of the report, by name. Nothing is written."""
    files: dict[str, bytes] = {}
    report = document(study, full=False)
    for name in formats:
        with REPORTERS.guarded(name):
            files.update(REPORTERS.load(name).render(report))
    files.update(parameter_files_rendered(study.parameter_files.values()))
    return files | placed(study.exports)


@one_thread()
def replaced_files(result: Merged, moves: Sequence[Simulation], carried: Sequence[Carried]) -> dict[str, bytes]:
    """The merged parameter file with its tables, and a report of it, by name.

    Parameters
    ----------
    result : Merged
    moves : sequence of Simulation
    carried : sequence of Carried
        Of `replaced`.
    """
    p = result.parameters
    moved_so = Section("manoeuvres", "First manoeuvres", tables=(manoeuvre_table(moves, carried),))
    page = Document(p.name, f"Estimates of {p.body} and what replaced them", (replaced_section(result, carried), moved_so), p.name,
                    digest_of(p.provenance.inputs), answer=answer_of_merge(result, moves, carried))  # fmt: skip
    files = parameter_files_rendered([p])
    with REPORTERS.guarded("html"):
        files.update(REPORTERS.load("html").render(page))
    return files

"""The report of anything that a person can name: a plan, a folder with one, a shipped validation."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from coeflab.api.validations import PLAN, validation, validations
from coeflab.core.errors import InputError, shown
from coeflab.core.files import shipped, typed
from coeflab.core.machine import one_thread
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.texts import input_error
from coeflab.core.types import brief
from coeflab.formats.export import parameter_files_rendered
from coeflab.report import content
from coeflab.report.acceptance import Acceptance, acceptance_csv
from coeflab.report.document import Document, Section
from coeflab.report.first_page import acceptance_summary, study_summary
from coeflab.report.formats import REPORTERS
from coeflab.report.sections import acceptance as acceptance_document
from coeflab.study.plan import plan_at, read_plan
from coeflab.study.study import Plan, Study

Progress = Callable[[str], None]
COMPARED, CONVENTIONS, REPRODUCE = "compared", "conventions", "reproduce"


@brief
@dataclass(frozen=True, slots=True)
class Report:
    """A document and whether what it tells of fails."""

    document: Document
    failed: bool


def studied(study: str, progress: Progress = lambda _: None) -> Study | Acceptance:
    """Compute a study.

    Parameters
    ----------
    study : str
        A plan.toml, a folder with one, or the name of a shipped validation.
    progress : callable, optional
        Means in words what happens.

    Raises
    ------
    InputError
        There is no such study; or its input cannot be used.
    """
    from coeflab.study.run import run

    found = _meant(study)
    if isinstance(found, Plan):
        return run(found, progress)
    progress(f"computing {found}")
    result = validation(found)
    return run(result, progress) if isinstance(result, Plan) else result


@one_thread()
def report_of(found: Study | Acceptance, *, short: bool = False, full: bool = False, review: bool = False) -> Report:
    """The report of what was computed; figures are drawn on several cores while this process has a single thread.

    Parameters
    ----------
    found : Study or Acceptance
    short : bool
        One page.
    full : bool
        With the appendix.
    review : bool
        With what a reviewer asks for in the place of the appendix; of a publication the whole.
    """
    if isinstance(found, Study):
        if short:
            return Report(_one_page(study_summary(found)), found.failed)
        result = content.document(found, full=full, review=review)
        return Report(
            _commanded(result, "--for-review" if review else "--full") if full or review else result, found.failed
        )
    whole = acceptance_document.document(found, _inputs(found.name))
    if short:
        return Report(_one_page(acceptance_summary(found, whole)), not found.holds)
    parted = _parted(whole, found)
    return Report(_commanded(parted, "--full") if full or review else content.core(parted), not found.holds)


def _one_page(document: Document) -> Document:
    """The answer alone, where there is one: it is the page."""
    return document if document.answer is None else replace(document, sections=())


LONGEST = 8  # rows of a table of numbers that the core prints


def _parted(whole: Document, found: Acceptance) -> Document:
    """Long tables whose every number holds belong to the appendix, and axes that the first page shows; the overview counts them."""
    shown = {t.title for t in found.tables if not t.holds}
    has_axes = whole.answer is not None and whole.answer.axes is not None

    def marked(section: Section) -> Section:
        if section.anchor == CONVENTIONS and has_axes:
            drawn = Section("axes-drawn", "Axes and signs, drawn", figures=section.figures, appendix=True)
            return replace(section, figures=(), subsections=(*section.subsections, drawn))
        if section.anchor != COMPARED:
            return section
        parts = tuple(
            replace(s, appendix=s.title not in shown and any(len(t.rows) > LONGEST for t in s.tables))
            for s in section.subsections
        )
        long = f"Tables of more than {LONGEST} rows whose every number holds: coeflab report {found.name} --full."
        words = (long,) if any(s.appendix for s in parts) else ()
        return replace(section, paragraphs=(*section.paragraphs, *words), subsections=parts)

    return replace(whole, sections=tuple(map(marked, whole.sections)))


def _commanded(whole: Document, option: str) -> Document:
    """The command that makes it again, with its appendix; `coeflab run` writes the core alone."""

    def marked(section: Section) -> Section:
        text = tuple(p.replace("writes the same HTML", "writes the core of it as HTML") for p in section.paragraphs)
        return replace(section, code=tuple(f"{line} {option}" for line in section.code), paragraphs=text)

    return replace(whole, sections=tuple(marked(s) if s.anchor == REPRODUCE else s for s in whole.sections))


def only(document: Document, names: Sequence[str]) -> Document:
    """The document with nothing but the named sections, in its own order.

    Parameters
    ----------
    document : Document
    names : sequence of str
        Anchors or titles, in any case; of subsections too.

    Raises
    ------
    InputError
        A name belongs to no section.

    Examples
    --------
    >>> page = Document("T", "s", (Section("one", "One"), Section("two", "Two")))
    >>> [s.title for s in only(page, ["two"]).sections]
    ['Two']
    """
    if not names:
        return document
    known = {n for s in _every(document.sections) for n in (s.anchor.casefold(), s.title.casefold())}
    for name in names:
        if name.casefold() not in known:
            near = difflib.get_close_matches(name.casefold(), sorted(known), n=1)
            raise InputError(
                f"the section {shown(name)}",
                f"one of {', '.join(s.anchor for s in document.sections)}, or a subsection",
                column="--section",
                advice=f"Did you mean {near[0]}?" if near else "",
            )
    return replace(document, sections=_selected(document.sections, {n.casefold() for n in names}))


def written(document: Document, formats: Sequence[str]) -> Mapping[str, bytes]:
    """The files of a document in some formats; nothing is written.

    Raises
    ------
    InputError
        No renderer has that name.
    """
    renderers = {name: REPORTERS.load(name) for name in formats}
    files: dict[str, bytes] = {}
    for name, renderer in renderers.items():
        with REPORTERS.guarded(name):
            files.update(renderer.render(document))
    return files


def acceptance_files(found: Acceptance) -> dict[str, bytes]:
    """Report, parameter files, numbers as CSV and figures of a publication, by name; nothing is written."""
    files = parameter_files_rendered(found.parameter_files) | dict(written(report_of(found).document, ["html"]))
    files |= {f"{found.name}.csv": acceptance_csv(found)}
    return files | {f"{name}.svg": figure.svg.encode() for name, figure in found.figures} | dict(found.pages)


def _meant(study: str) -> Plan | str:
    """The plan at a path, else the plan of a validation, else the name of a publication."""
    try:
        path = typed(study)
    except InputError as why:
        raise _unknown(study, why.found) from None
    if path.is_file():
        return read_plan(path)
    if (path / PLAN).is_file():
        return read_plan(path / PLAN)
    if path.exists() and study not in validations():
        if plan_at(path).is_file():
            return read_plan(plan_at(path))
        raise input_error("front_door.folder_without_campaign", study=shown(study, 300), plan=PLAN)
    if study not in validations():
        campaign = shipped("cfd_data") / study / "campaign.toml"
        if not campaign.is_file():
            raise _unknown(study, shown(study, 300))
        return read_plan(campaign)
    plan = shipped("cfd_data") / study / PLAN
    return read_plan(plan) if plan.is_file() else study


def _unknown(study: str, found: str) -> InputError:
    near = difflib.get_close_matches(study.casefold(), validations(), n=1)
    return InputError(
        f"the study {found}",
        f"a {PLAN}, a folder with one, or a shipped validation ({', '.join(validations())})",
        advice=f"Did you mean {near[0]}?" if near else "",
    )


def _inputs(name: str) -> tuple[InputFile, ...]:
    """The shipped files of a publication."""
    folder = shipped("cfd_data") / name
    return tuple(
        InputFile(f"{name}/{p.relative_to(folder).as_posix()}", sha256_of(p))
        for p in sorted(folder.rglob("*"))
        if p.is_file() and "__pycache__" not in p.parts
    )


def _every(sections: Sequence[Section]) -> list[Section]:
    return [s for one in sections for s in (one, *_every(one.subsections))]


def _selected(sections: Sequence[Section], names: set[str]) -> tuple[Section, ...]:
    """Named sections whole; of the others those that hold a named one, without their own text."""
    out = []
    for s in sections:
        if names & {s.anchor.casefold(), s.title.casefold()}:
            out.append(s)
        elif inner := _selected(s.subsections, names):
            out.append(Section(s.anchor, s.title, subsections=inner))
    return tuple(out)

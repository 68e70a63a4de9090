"""What a report says about a study, in order; formats render it.

Independent parts of a report, drawn on other cores while this one goes on.
"""

from __future__ import annotations

import gc
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from multiprocessing import current_process, get_all_start_methods, get_context
from typing import TypeVar

from coeflab.core.machine import cores, end_with_parent
from coeflab.core.table import Severity
from coeflab.core.wording import listed
from coeflab.fits.results.fit_result import FitResult
from coeflab.law.coefficient import COVERS, Status
from coeflab.law.symbols import primed
from coeflab.report.acceptance import headline, held_of_study
from coeflab.report.answer import answer
from coeflab.report.bench import bench_of
from coeflab.report.document import Document, Section, digest_of, reproduction
from coeflab.report.figures.svg import settings
from coeflab.report.notation import keeping, users_texts
from coeflab.report.sections.body import added_mass_sections, body_sections
from coeflab.report.sections.campaign import anchor, budget_sections, campaign_section, filled, tow_sections
from coeflab.report.sections.conventions import conventions_section
from coeflab.report.sections.data_quality import quality_sections
from coeflab.report.sections.parameter_file import export_sections, in_words, manoeuvre_sections, stability_sections
from coeflab.report.tables import formats as format_tables
from coeflab.report.tables import models as model_tables
from coeflab.report.tables import nouns as noun_tables
from coeflab.report.tables import results as tables
from coeflab.study.study import Study
from coeflab.vehicle.force_law import points_of
from coeflab.vehicle.reference import Comparison, Relation

Part = TypeVar("Part")
MOST = 4
_JOBS: list[Callable[[], object]] = []


@contextmanager
def begun(jobs: Sequence[Callable[[], Part]], sizes: Sequence[int] = ()) -> Iterator[Callable[[], list[Part]]]:
    """Start jobs; the yielded function waits for what they return, in their own order.

    Copies of this process do the work, so that a job may hold anything; what it returns is pickled. Where copying is not
    to be had or not safe (a second Python thread might hold a lock), the jobs are done here, with the same result.

    Parameters
    ----------
    jobs : sequence of callable
        Pure, and of numpy and matplotlib alone: libraries with threads of their own do not survive the copying.
    sizes : sequence of int, optional
        How much each has to do; the largest begins.
    """
    workers = min(MOST, len(jobs), cores())
    if workers < 2 or _JOBS or not _safe():
        yield lambda: [job() for job in jobs]
        return
    _JOBS.extend(jobs)
    try:
        with ProcessPoolExecutor(workers, get_context("fork"), initializer=_prepare) as pool:
            with warnings.catch_warnings():
                warnings.filterwarnings("ignore", message=".*fork", category=DeprecationWarning)
                order = sorted(range(len(jobs)), key=lambda i: -sizes[i] if sizes else i)
                waiting = {i: pool.submit(_done, i) for i in order}

            def results() -> list[Part]:
                try:
                    return [waiting[i].result() for i in range(len(jobs))]  # type: ignore[misc]
                except BrokenProcessPool:
                    return [job() for job in jobs]

            yield results
    finally:
        _JOBS.clear()


def _prepare() -> None:
    """What a copy does first."""
    end_with_parent()
    # What was there before the copying is not searched for garbage again and again.
    gc.freeze()


def _done(index: int) -> object:
    return _JOBS[index]()


def _safe() -> bool:
    forks = "fork" in get_all_start_methods() and sys.platform != "darwin"  # whose system libraries do not survive it
    return forks and not current_process().daemon and threading.active_count() == 1


FEW = 8


def document(study: Study) -> Document:
    """The whole report of a study."""
    verbatim = users_texts(study)
    with keeping(verbatim):
        return replace(_document(study), verbatim=verbatim, bench=bench_of(study))


def _document(study: Study) -> Document:
    places: set[str] = set()
    own = [anchor(f"campaign {fit.campaign}", places) for fit in study.fits]
    alone = [partial(_alone, study, fit, place, places) for fit, place in zip(study.fits, own, strict=True)]
    sizes = [len(f.sweeps) for f in study.fits]
    with settings(), begun(alone if sum(sizes) > FEW else (), sizes) as drawn:
        about = [
            *budget_sections(study),
            *body_sections(study),
            *added_mass_sections(study),
            *stability_sections(study),
            *manoeuvre_sections(study),
        ]
        campaigns = tuple(drawn() or [job() for job in alone])
    sections = (
        verdict(study),
        *_comparison(study),
        *tow_sections(study),
        _coefficients(study),
        *_models(study),
        *_laws(study),
        *about,
        *export_sections(study),
        Section(
            "campaigns",
            "Campaigns",
            ("Every coefficient and every fitted model with its points, its curves and what was tried.",),
            subsections=campaigns,
        ),
        *quality_sections(study),
        _checks(study),
        conventions_section(study),
        _provenance(study),
        reproduction(study),
    )
    names = ", ".join(dict.fromkeys(f.body.replace("_", " ") for f in study.fits))
    return Document(
        study.plan.title or study.plan.name, f"Coefficients of {names}", sections, study.plan.name, digest_of(study.inputs),
        tables.works(study), answer=answer(study),
    )  # fmt: skip


def _alone(study: Study, fit: FitResult, place: str, places: set[str]) -> Section:
    return campaign_section(study, fit, place, set(places))


def _counted(n: int, one: str) -> str:
    return f"{n} {one}" if n == 1 else f"{n} {one}s"


def _named(c: Comparison) -> str:
    return f"{primed(c.coefficient.symbol)} of {c.coefficient.campaign}"


def _re_analysis(study: Study) -> list[str]:
    ours = [c for c in study.comparisons if c.relation is Relation.RE_ANALYSIS]
    judged = [c for c in ours if c.passed is not None]
    if not judged:
        return ["No published evaluation of these data is held against the results, so there is no verdict on them."]
    failed = [c for c in judged if c.passed is False]
    count = _counted(len(judged), "comparison")
    if failed:
        out = [
            f"{len(failed)} of {count} with the authors' own evaluation of the same data failed: "
            f"{listed([_named(c) for c in failed])} lies further from the published value than U95."
        ]
    else:
        verb = "passed" if len(judged) == 1 else "all passed"
        out = [
            f"{count} with the authors' own evaluation of the same data {verb}: each difference lies within our U95."
        ]
    if len(ours) > len(judged):
        rest = listed([_named(c) for c in ours if c.passed is None])
        out.append(f"No verdict could be given for {rest}, which has no U95.")
    out.append(" ".join(headline(held_of_study(study))))
    out.append(
        "This is a re-analysis: both sides use the same measurements. A pass says that the evaluation reproduces the "
        "published one within its stated uncertainty; it says nothing on whether the measurements are right."
    )
    return out


def verdict(study: Study) -> Section:
    """What comes out, in sentences: the slopes with U95 and what it covers, then the verdict itself."""
    first = tables.headline(study)
    text = [*([first] if first else []), *_re_analysis(study), _harvest(study)]
    others = [c for c in study.comparisons if c.relation is Relation.CROSS_BODY]
    if others:
        names = listed(list(dict.fromkeys(c.reference for c in others)))
        text.append(
            f"Cross-body comparison with {names}: those values belong to another body or come from another method, so "
            "they stand beside ours without a verdict. A difference there may be the appendages as well as an error."
        )
    text += [*in_words(study), *_without_value(study)]
    failed = [c for c in study.checks if c.severity is Severity.FAIL]
    warned = sum(c.severity is Severity.WARN for c in study.checks)
    if study.checks:
        text.append(
            f"Of {_counted(len(study.checks), 'check')}, {len(failed)} failed and {warned} warned; see Checks below."
        )
    if study.failed:
        text.append("The study as a whole fails.")
    elif study.checks or study.comparisons:
        text.append("The study as a whole has no failing comparison or check.")
    return Section("verdict", "Verdict", tuple(text))


def _harvest(study: Study) -> str:
    found = [c for c in study.coefficients if c.value is not None]
    bounded = sum(c.u95 is not None for c in found)
    campaigns = list(dict.fromkeys(t.campaign for t in study.tables))
    if not campaigns:
        return "The study holds no tables."
    rows = _counted(sum(len(t) for t in study.tables), "row")
    source = f"{rows} of {_counted(len(campaigns), 'campaign')}: {listed(campaigns)}."
    models = sum(len(f.models) for f in study.fits)
    if not found and models:
        return (
            f"Found: {_counted(models, 'fitted model')}, none with coefficients that have a SNAME symbol, from {source}"
        )
    if not found:
        return f"No coefficient could be determined from {source}"
    uncertain = "each with U95" if bounded == len(found) else f"{bounded} of them with U95"
    return f"Found: {_counted(len(found), 'coefficient')}, {uncertain}, from {source}"


def _without_value(study: Study) -> list[str]:
    absent = [c for c in study.coefficients if c.value is None]
    out = []
    for status in dict.fromkeys(c.status for c in absent):
        places: dict[str, list[str]] = {}
        for c in absent:
            if c.status is status:
                places.setdefault(c.campaign or c.body, []).append(primed(c.symbol))
        names = "; ".join(f"{listed(symbols)} of {place}" for place, symbols in places.items())
        out.append(f"Without a value: {names}. {status.advice}".strip())
    return out


def _coefficients(study: Study) -> Section:
    text: tuple[str, ...] = (
        f"A slope at the origin comes from one model of the whole sweep: line, v|v|, cubic and a smooth remainder of unknown "
        f"size and onset, in proportion to how well each explains the points. U95 covers {COVERS}; no form or window is "
        "chosen, and no published value enters. How it was calibrated, and what remains: docs/slope_at_origin.md.",
        "Its random part is what the scatter of single readings does, its form part the rest, joined as a root sum of squares. "
        "What single forms would have said stands under each coefficient, for comparison only.",
        "A part that was not assessed is shown by a dash and is not in U95; the budget of every coefficient names what is "
        "missing. The turbulence model of a computation is in it only where the campaign has a study of it.",
    )
    single = any(c.status is Status.SINGLE_ESTIMATOR for c in study.coefficients)
    if single:
        text += ("Where an interval could not be had, the value is printed without U95 and should not be relied on.",)
    if any(c.status is Status.FORM_REJECTED for c in study.coefficients):
        text += (f"Form rejected: {Status.FORM_REJECTED.advice}",)
    return Section("coefficients", "Coefficients", text, filled(tables.coefficients(study)))


def _models(study: Study) -> tuple[Section, ...]:
    models = tuple(m for f in study.fits for m in f.models)
    if not models:
        return ()
    text = (
        "Force laws and tables over one or more variables. What the data leave open is said below each table and has no "
        "number; a reader outside the domain follows the stated rule. Pictures, influential points and correlations stand "
        "under Campaigns.",
    )
    each = tuple(noun_tables.terms(m) for m in models)
    return (Section("models", "Fitted models", text, filled(model_tables.quality(models), *each)),)


def _laws(study: Study) -> tuple[Section, ...]:
    each = filled(
        *(format_tables.at_points(points_of(p), f"Force law of {name}") for name, p in study.parameter_files.items())
    )
    if not each:
        return ()
    text = (
        "The force law of every parameter file, evaluated as a simulation evaluates it, at the measured points that it was fitted "
        "to. It may miss a point by three times the scatter of repeated runs plus 5 % of the largest force of that component in "
        "that table; a point missed by more, where the law is said to hold, is a failure. Exports and motions are given the range "
        "in which it holds.",
    )
    return (Section("law-at-points", "The law at the measured points", text, each),)


def _comparison(study: Study) -> tuple[Section, ...]:
    if not study.comparisons:
        return ()
    text = ["Published values are primed by our length before they are compared."]
    for r in study.references:
        if r.other_scaling is not None:
            text.append(
                f'"{r.name}" is shown in two readings, as the length that its coefficients are divided by is not '
                f"certain: {r.scaling}, which is taken as printed, and {r.other_scaling}, which rescales every value."
            )
    shown = filled(tables.side_by_side(study), tables.differences(study), tables.verdicts(study))
    return (Section("comparison", "Comparison with published values", tuple(text), shown),)


def _checks(study: Study) -> Section:
    if not study.checks:
        return Section("checks", "Checks", ("No checks were made.",))
    text = ("A note or a warning asks for attention; only a failure makes the study fail.",)
    return Section("checks", "Checks", text, filled(tables.checks(study.checks)))


def _provenance(study: Study) -> Section:
    text = ["The files below are known by the sha256 of their bytes. Equal inputs give this report byte for byte."]
    settings = dict.fromkeys(
        f"{f.fit}: {', '.join(f'{k} {v}' for k, v in sorted(f.settings.items()))}." for f in study.fits if f.settings
    )
    text += settings
    return Section("provenance", "Provenance", tuple(text), filled(tables.provenance(study)))

"""The verdict of a study, matter by matter: what agrees, what was found, what is missing, what to measure next."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.finding import Severity
from coeflab.core.wording import collected, counted, in_sentences, listed
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.symbols import derivative, primed, read_factors
from coeflab.report.acceptance import on_predictions
from coeflab.report.document import Section, Topic
from coeflab.report.figures.first_page import share_text
from coeflab.report.sections.estimates import verdict_of_shape
from coeflab.report.sections.stability import in_words
from coeflab.report.tables import comparisons
from coeflab.report.texts import text_of
from coeflab.study.study import Study
from coeflab.study.towed import towed
from coeflab.study.validation import WIDE, by_measured_number, printed_indices, validations
from coeflab.vehicle.published_values import Comparison, Relation

SEVERAL = 3  # campaigns that a sentence names; of more it says how many, and the table has them


def _named(c: Comparison) -> str:
    return f"{primed(c.coefficient.symbol)} of {c.coefficient.campaign}"


def _agree(good: int, count: int, one: str) -> str:
    """How many agree, for example ``2 of 3 coefficients agree``."""
    return f"{good} of {counted(count, one)} {'agrees' if good == 1 else 'agree'}"


def _re_analyses(study: Study) -> list[str]:
    """Our fits against the authors' evaluation of the same data."""
    ours = [c for c in study.comparisons if c.relation is Relation.RE_ANALYSIS]
    judged = [c for c in ours if c.passed is not None]
    if not judged:
        return ["The plan names no published evaluation of these data, so there is no verdict on them."]
    failed = [c for c in judged if c.passed is False]
    good = len(judged) - len(failed)
    out = [f"{_agree(good, len(judged), 'coefficient')} with the authors' own evaluation of their data, within U95."]
    if failed:
        out.append(in_sentences("Beyond U95, a failure: ", [_named(c) for c in failed], join=listed))
    if wide := [f"{_named(c)} ({share_text(comparisons.weight(c))})" for c in judged if comparisons.is_weak(c)]:
        out.append(in_sentences(f"Weak, as {comparisons.WEAK}: ", wide, join=listed))
    if len(ours) > len(judged):
        out.append(in_sentences("No verdict without U95: ", [_named(c) for c in ours if c.passed is None], join=listed))
    return [*out, text_of("verdict.same_data")]


def _predictions(study: Study) -> list[str]:
    """Coefficients from CFD against those that were measured on the same body."""
    found = validations(study, study.budgets)
    counted = [all(v.within for v in one) for one in by_measured_number(found)]
    out = []
    if counted:
        out.append(text_of("verdict.predictions", counted=_agree(sum(counted), len(counted), "coefficient")))
    out += on_predictions(study)
    if missed := [f"{primed(v.symbol)} of {v.simulation} against {v.experiment}" for v in found if v.within is False]:
        out.append(" ".join((in_sentences("Beyond U_V: ", missed, join=listed), text_of("verdict.no_failure"))))
    return [*out, *_beyond_without_verdict(study, also=bool(missed))]


def _recomputed(study: Study) -> list[str]:
    """Stability indices from printed derivatives."""
    found = [i.holds for i in printed_indices(study)]
    if not found:
        return []
    indices, follow = ("index", "follows") if len(found) == 1 else ("indices", "follow")
    return [text_of("verdict.recomputed", good=sum(found), count=len(found), indices=indices, follow=follow)]


def _beyond_without_verdict(study: Study, *, also: bool) -> list[str]:
    """Coefficients of own tows beyond U_V that do not count, and why; ``also``: others that count are beyond it as well."""
    out = []
    known = {(v.symbol, v.simulation) for v in validations(study, study.budgets)}
    for tow in towed(study):
        reasons: dict[tuple[str, ...], list[str]] = {}
        for r in tow.rows:
            of = r.validation
            if r.verdict is None and of is not None and of.beyond and (of.symbol, of.simulation) not in known:
                apart = f" ({100.0 * of.error / of.measured:+.0f} %)" if of.measured else ""
                reasons.setdefault(r.reasons, []).append(f"{primed(r.symbol)}{apart}")
        for why, symbols in reasons.items():
            differ, them = ("differs", "it") if len(symbols) == 1 else ("differ", "them")
            out.append(
                f"{listed(symbols)} of {tow.tow.campaign} {'also ' * also}{differ} from the test by more than U_V. We do not count {them}: {'; '.join(why)}."
            )
    return out


def _no_verdict_on(study: Study, others: Sequence[Comparison]) -> str:
    """Columns without a verdict by reason: another body, or another method on the same one."""
    bodies = {r.name: r.body for r in study.references}
    by = collected(
        ("body" if bodies.get(name) != body else "method", name)
        for name, body in dict.fromkeys((c.reference, c.coefficient.body) for c in others)
    )
    return " ".join(
        text_of(
            "verdict.others",
            names=listed(list(dict.fromkeys(n))),
            its="its" if len(set(n)) == 1 else "their",
            what=what,
        )
        for what, n in by.items()
    )


def _outcome(study: Study) -> tuple[str, ...]:
    """Whether the study fails, and by what; empty where nothing was judged."""
    failed = [c for c in study.checks if c.severity is Severity.FAIL]
    beyond = [c for c in study.comparisons if c.passed is False]
    judged = [c for c in study.comparisons if c.passed is not None]
    what = [f"{len(beyond)} of {counted(len(judged), 're-analysis', 're-analyses')}"] if beyond else []
    what += [f"{len(failed)} of {counted(len(study.checks), 'check')}"] if failed else []
    refused = f"{counted(len(study.refused), 'export')} {'was' if len(study.refused) == 1 else 'were'} refused"
    if study.failed:
        each = [f"{listed(what)} failed"] if what else []
        return (f"The study fails: {'; '.join([*each, *([refused] if study.refused else [])])}.",)
    warned = sum(c.severity is Severity.WARN for c in study.checks)
    warnings = f" {warned} of {counted(len(study.checks), 'check')} gave a warning." if warned else ""
    if judged and study.checks:
        return (f"The study passes: no re-analysis and no check failed.{warnings}",)
    if study.checks or judged:
        return (f"The study passes: no {'check' if study.checks else 're-analysis'} failed.{warnings}",)
    return ()


def verdict(study: Study) -> Section:
    """What comes out, matter by matter: what agrees, stability, what was found and what is missing."""
    if study.shape is not None:
        return verdict_of_shape(study)
    others = [c for c in study.comparisons if c.relation is Relation.CROSS_BODY]
    topics = (
        Topic("Re-analyses", tuple(_re_analyses(study))),
        Topic("Predictions", tuple(_predictions(study))),
        Topic("Recomputed", tuple(_recomputed(study))),
        Topic("Other bodies", (_no_verdict_on(study, others),) if others else ()),
        Topic("Stability", tuple(in_words(study))),
        Topic("Coefficients", (_harvest(study), *_wide(study))),
        Topic("No value", tuple(_without_value(study))),
        Topic("Measure next", tuple(_next(study))),
    )
    return Section("verdict", "Verdict", _outcome(study), topics=tuple(t for t in topics if t.texts))


def _harvest(study: Study) -> str:
    every = [c for c in study.coefficients if c.value is not None]
    found = [c for c in every if not _is_copied(study, c)]
    bounded = sum(c.u95 is not None for c in found)
    campaigns = list(dict.fromkeys(t.campaign for t in study.tables))
    if not campaigns:
        return "The study holds no tables."
    rows = counted(sum(len(t) for t in study.tables if not t.by_symmetry), "row")
    named = f": {listed(campaigns)}" * (len(campaigns) <= SEVERAL)
    source = f"{rows} of {counted(len(campaigns), 'campaign')}{named}."
    models = sum(len(f.models) for f in study.fits)
    if not found and models:
        return f"We found {counted(models, 'fitted model')}, none with coefficients that have a SNAME symbol, from {source}"
    if not found:
        return f"No coefficient could be determined from {source}"
    uncertain = "each with U95" if bounded == len(found) else f"{bounded} of them with U95"
    each = f"We found {counted(len(found), 'coefficient')} ({_by_kind(found)}), {uncertain}, from {source}"
    alone = sum(c.u95 is not None and c.parts.model_form is None and c.parts.input is None for c in found)
    each += f" U95 of {alone} is scatter alone." * bool(alone)
    copies = len(every) - len(found)
    more = "Another one follows" if copies == 1 else f"Another {copies} follow"
    return each + f" {more} from these by symmetry." * bool(copies)


def _is_copied(study: Study, c: Coefficient) -> bool:
    """Whether only tables turned by symmetry, and no runs, vary the motions of a coefficient."""
    if any((f.campaign, s.symbol) == (c.campaign, c.symbol) for f in study.fits for s in f.sweeps if s.by_symmetry):
        return True
    mine = [t for t in study.tables if t.campaign == c.campaign]
    own, turned = ({m for t in mine if bool(t.by_symmetry) is is_copy for m in t.varies} for is_copy in (False, True))
    factors = {name for name, _ in read_factors(c.symbol.removesuffix("'")[1:]) or ()}
    return bool(factors) and factors <= turned - own


def _by_kind(found: Sequence[Coefficient]) -> str:
    """How many are slopes, forces at zero angle and rate, and terms of higher degree."""
    degrees = [len(read_factors(c.symbol.removesuffix("'")[1:]) or ()) for c in found]
    counts = (degrees.count(1), degrees.count(0), sum(d > 1 for d in degrees))
    return ", ".join(
        f"{n} {name}" for n, name in zip(counts, ("linear", "constant", "of higher degree"), strict=True) if n
    )


def _without_value(study: Study) -> list[str]:
    absent = [c for c in study.coefficients if c.value is None]
    out = []
    for status in dict.fromkeys(c.status for c in absent):
        places = collected((c.campaign or c.body, c.symbol) for c in absent if c.status is status)
        is_untabled = status is Status.NO_TABLE
        names = [
            f"{listed([primed(s) for s in symbols])} of {place}{_not_varied(symbols) if is_untabled else ''}"
            for place, symbols in places.items()
        ]
        reason = "reason in its section" if status is Status.NOT_DETERMINED else status.replace("_", " ")
        start = "" if is_untabled else f"{reason[0].upper()}{reason[1:]}: "
        out.append(f"{in_sentences(start, names)} {'' if is_untabled else status.advice}".strip())
    return out


def _next(study: Study) -> list[str]:
    """Motions that no table of a body varies."""
    varied: dict[str, set[str]] = {}
    for t in study.tables:
        varied.setdefault(t.body, set()).update(t.varies)
    lacking: dict[str, dict[str, None]] = {}
    for c in study.coefficients:
        if c.status is Status.NO_TABLE and c.body:
            lacking.setdefault(c.body, {}).update(
                dict.fromkeys(f for f in derivative(c.symbol).factors if f not in varied.get(c.body, set()))
            )
    runs = [f"runs that vary {' and '.join(motions)}, of {body}" for body, motions in lacking.items() if motions]
    return [f"{listed(runs)[:1].upper()}{listed(runs)[1:]}."] if runs else []


def _wide(study: Study) -> list[str]:
    """Wanted values with a wide interval, and how to find the runs that narrow it."""
    wide = collected(
        (c.campaign or c.body, primed(c.symbol))
        for c in study.coefficients
        if c.symbol in study.plan.wanted and c.value and c.u95 and c.u95 > WIDE * abs(c.value)
    )
    if not wide:
        return []
    each = [f"{listed(symbols)} of {place}" for place, symbols in wide.items()]
    start = f"U95 exceeds {100.0 * WIDE:.0f} % of the value for "
    return [f"{in_sentences(start, each)} `coeflab next TABLE` names the runs that narrow it most."]


def _not_varied(symbols: Sequence[str]) -> str:
    """Motions of these derivatives, which no table of a campaign varies."""
    motions = dict.fromkeys(v for s in symbols for v in derivative(s).factors)
    return f" (no run varies {' or '.join(motions)})" if motions else ""

"""The uncertainty budget in a report: what U95 holds, what a validation concludes, how it carries on."""

from __future__ import annotations

from coeflab.core.wording import listed
from coeflab.law.symbols import primed
from coeflab.report.document import Section
from coeflab.report.figures.tornado import tornado_figure
from coeflab.report.sections.campaign import filled
from coeflab.report.tables import budgets as budget_tables
from coeflab.report.tables import own_cfd
from coeflab.report.tables.budgets import SET_IN_A_COMPUTATION
from coeflab.report.texts import text_of
from coeflab.study.lines import MEANING
from coeflab.study.study import Study
from coeflab.study.towed import Towed, towed
from coeflab.study.validation import validations
from coeflab.vehicle.stability import centre_of_pressure, stability


def budget_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where no coefficient has a budget."""
    found = study.budgets
    models = tuple(m for f in study.fits for m in f.models)
    if not found and not any(m.shared for m in models):
        return ()
    derived = [d for f in study.fits for d in centre_of_pressure(f.coefficients, f.campaign)]
    derived += [d for p in study.parameter_files.values() for d in stability(p)]
    tables = (
        budget_tables.overview(found),
        budget_tables.grids(found),
        budget_tables.variant_studies(found),
        budget_tables.validation(validations(study, found)),
        budget_tables.derived(derived),
        *(budget_tables.model_parts(m) for m in models),
    )
    text = (
        text_of("campaign.joined"),
        text_of("campaign.inputs"),
    )
    turned = {(s.campaign, s.symbol) for f in study.fits for s in f.sweeps if s.by_symmetry}
    own_tows = {t.campaign for t in study.plan.tows if t.added is not None}  # in the overview alone
    wanted = [
        b
        for b in found
        if b.symbol.removesuffix("'") in study.plan.wanted
        and (b.campaign, b.symbol.removesuffix("'")) not in turned
        and b.campaign not in own_tows
    ]
    parts = tuple(
        Section(
            f"budget-{i}",
            f"{primed(b.symbol)} of {b.campaign}",
            tables=(budget_tables.budget(b),),
            figures=(tornado_figure(b, f"tornado-{i}"),),
        )
        for i, b in enumerate(wanted)
    )
    return (Section("budget", "Uncertainty budget", text, filled(*tables), subsections=parts),)


def tow_sections(study: Study) -> tuple[Section, ...]:
    """Bodies that our own computations tow, or none where the plan names none."""
    found = towed(study)
    if not found:
        return ()
    campaigns = {one.tow.campaign for one in found}
    budgets = [b for b in study.budgets if b.campaign in campaigns]
    known = {*SET_IN_A_COMPUTATION, *(b.open_grid.name for b in budgets if b.open_grid)}
    left = "; ".join(dict.fromkeys(name for b in budgets for name in b.unassessed if name not in known))
    text: tuple[str, ...] = (
        text_of(
            "campaign.own_tows",
            left=f" U95 leaves out: {left}." * bool(left),
            conditions=text_of("campaign.conditions"),
            meaning=MEANING,
        ),
        "E = S - D, simulation minus test, is compared with the validation uncertainty U_V (ASME V&V 20). A verdict needs a steady test of the same body.",
    )
    with_values = [one for one in found if any(r.value is not None for r in one.rows)]
    text += tuple(_nothing(one) for one in found if one not in with_values)
    judged = {v.simulation for v in validations(study, study.budgets)}  # whose errors stand under Comparison
    each = (
        t for one in with_values
        for t in (own_cfd.own_tow(one), *(() if one.tow.campaign in judged else (own_cfd.tow_against(one),)))
    )  # fmt: skip
    rest = filled(*(own_cfd.own_tow(one) for one in found if one not in with_values))
    more = (Section("no-tow", "Own CFD without a value", tables=rest, appendix=True),) if rest else ()
    return (Section("own-tows", "Own CFD", text, filled(*each), subsections=more),)


def _nothing(found: Towed) -> str:
    """A body without any value, in one line."""
    reasons = "; ".join(dict.fromkeys(r.why for r in found.rows if r.why))
    missing = listed(list(dict.fromkeys(r.missing for r in found.rows if r.missing)))
    return f"{found.tow.name}: {missing or 'no value'}{f', as {reasons}' if reasons else ''}."

"""The uncertainty budget in a report: what U95 holds, what a validation concludes, how it carries on."""

from __future__ import annotations

from coeflab.core.symbols import primed
from coeflab.model.derived import centre_of_pressure, stability
from coeflab.model.study import Study
from coeflab.model.table import Table
from coeflab.model.validation import validations
from coeflab.presentation import budget_tables
from coeflab.presentation.document import Section
from coeflab.presentation.tornado_figure import tornado_figure


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
        budget_tables.validation(validations(study, found)),
        budget_tables.derived(derived),
        *(budget_tables.shared(m) for m in models),
    )
    text = (
        "U95 joins every assessed part as a root sum of squares: the scatter of the points, the model form, the grid where "
        "a campaign has a grid study, and the inputs that a campaign declares under [uncertainty] (angle, speed, "
        "calibration, reference point, length). A part that was not assessed is named, never zero.",
    )
    wanted = [b for b in found if b.symbol.removesuffix("'") in study.plan.wanted]
    parts = tuple(
        Section(
            f"budget-{i}",
            f"{primed(b.symbol)} of {b.campaign}",
            tables=(budget_tables.budget(b),),
            figures=(tornado_figure(b, f"tornado-{i}"),),
        )
        for i, b in enumerate(wanted)
    )
    return (Section("budget", "Uncertainty budget", text, _filled(tables), subsections=parts),)


def _filled(tables: tuple[Table, ...]) -> tuple[Table, ...]:
    return tuple(t for t in tables if t.rows)

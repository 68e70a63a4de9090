"""Added mass in a report: the bodies, every method side by side, and what is booked as potential in the coefficients."""

from __future__ import annotations

from coeflab.bodies.triangulation import RULE, Triangulation
from coeflab.core.wording import collected
from coeflab.formats import loss_tables
from coeflab.report.document import Section
from coeflab.report.sections.body import drawn_body
from coeflab.report.sections.campaign import filled
from coeflab.report.tables import added_mass as tables
from coeflab.report.tables import nouns as noun_tables
from coeflab.report.texts import text_of
from coeflab.study.study import Study


def added_mass_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where no parameter file has a hull."""
    if not study.hulls:
        return ()
    users = collected((found.body.name, name) for name, found in study.hulls.items())
    text = (
        text_of("body.added_mass"),
        f"Recommended by this rule: {RULE}.",
        text_of("body.potential"),
    )
    bodies = tuple(
        _body(study, study.hulls[names[0]], tuple(names), f"hull-{i}") for i, names in enumerate(users.values())
    )
    files = tuple(
        Section(
            f"potential-{i}",
            f"Potential and viscous parts, {name}",
            tables=filled(loss_tables.parts(study.parameter_files[name])),
        )
        for i, name in enumerate(study.hulls)
    )
    return (Section("added-mass", "Added mass", text, subsections=(*bodies, *files)),)


def _body(study: Study, found: Triangulation, files: tuple[str, ...], anchor: str) -> Section:
    return Section(
        anchor,
        found.body.title or found.body.name,
        tables=filled(
            tables.particulars(found.body),
            tables.derivatives(found),
            tables.primes(found),
            noun_tables.matrix(found.recommended),
            tables.symmetry(found),
        ),
        figures=(drawn_body(study, found.body, files, anchor),),
    )

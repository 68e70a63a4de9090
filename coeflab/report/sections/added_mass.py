"""Added mass in a report: the bodies, every method side by side, and what is booked as potential in the coefficients."""

from __future__ import annotations

from coeflab.bodies.triangulation import RULE, Triangulation
from coeflab.report.document import Section
from coeflab.report.sections.body import drawn_body
from coeflab.report.sections.campaign import filled
from coeflab.report.tables import added_mass as tables
from coeflab.report.tables import formats as loss_tables
from coeflab.report.tables import nouns as noun_tables
from coeflab.study.study import Study


def added_mass_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where no parameter file has a hull."""
    if not study.hulls:
        return ()
    first: dict[str, Triangulation] = {}
    users: dict[str, list[str]] = {}
    for name, found in study.hulls.items():
        first.setdefault(found.body.name, found)
        users.setdefault(found.body.name, []).append(name)
    text = (
        "Added mass in unbounded fluid by every method that applies, about the body's reference point. Potential theory is "
        "not tuned to a measurement: where one stands beside it, the gap is shown.",
        f"Recommended by this rule: {RULE}.",
        "A force measured in steady motion holds an ideal fluid's part, an entry of -C_A(nu) nu such as the Munk moment in "
        "Nv' and Mw'. It is booked apart, so that a simulator that adds C_A(nu) itself is given the viscous part alone.",
    )
    bodies = tuple(
        _body(study, found, tuple(users[name]), f"hull-{i}") for i, (name, found) in enumerate(first.items())
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

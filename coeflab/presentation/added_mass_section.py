"""Added mass in a report: the bodies, every method side by side, and what is booked as potential in the coefficients."""

from __future__ import annotations

from coeflab.model.shape import Parts
from coeflab.model.study import Study
from coeflab.model.triangulation import RULE, Triangulation
from coeflab.presentation import added_mass_tables as tables
from coeflab.presentation import loss_tables
from coeflab.presentation.body_figure import body_figure
from coeflab.presentation.campaign_sections import filled
from coeflab.presentation.document import Figure, Section
from coeflab.presentation.hull_figure import hull_figure


def added_mass_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where no parameter file has a hull."""
    if not study.hulls:
        return ()
    first: dict[str, Triangulation] = {}
    for found in study.hulls.values():
        first.setdefault(found.body.name, found)
    text = (
        "Added mass in unbounded fluid by every method that applies, about the body's reference point. Potential theory is "
        "not tuned to a measurement: where one stands beside it, the gap is shown.",
        f"Recommended by this rule: {RULE}.",
        "A force measured in steady motion holds an ideal fluid's part, an entry of -C_A(nu) nu such as the Munk moment in "
        "Nv' and Mw'. It is booked apart, so that a simulator that adds C_A(nu) itself is given the viscous part alone.",
    )
    bodies = tuple(_body(found, f"hull-{i}") for i, found in enumerate(first.values()))
    files = tuple(
        Section(
            f"potential-{i}",
            f"Potential and viscous parts, {name}",
            tables=filled(loss_tables.parts(study.parameter_files[name])),
        )
        for i, name in enumerate(study.hulls)
    )
    return (Section("added-mass", "Added mass", text, subsections=(*bodies, *files)),)


def _body(found: Triangulation, anchor: str) -> Section:
    return Section(
        anchor,
        found.body.title or found.body.name,
        tables=filled(
            tables.particulars(found.body),
            tables.derivatives(found),
            tables.primes(found),
            tables.matrix(found.recommended),
            tables.symmetry(found),
        ),
        figures=_figures(found, anchor),
    )


def _figures(found: Triangulation, anchor: str) -> tuple[Figure, ...]:
    shape = found.body.require_shape()
    if isinstance(shape, Parts):
        return (body_figure(found.body.name, shape, None, f"{anchor}-parts"),)
    return (hull_figure(found.body, f"{anchor}-outline"),)

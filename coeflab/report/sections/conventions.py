"""The conventions that every number of a report obeys, in short."""

from __future__ import annotations

from coeflab.report.document import Section
from coeflab.report.figures.axes import axes_figures
from coeflab.report.texts import text_of
from coeflab.study.study import Study

TITLE = "Conventions used"


def conventions_section(study: Study, *, drawn: bool = True) -> Section:
    """Axes, signs, reference point, length, and what the forces contain.

    Parameters
    ----------
    study : Study
    drawn : bool
        With the drawings of axes and signs in the section itself; else in its appendix, where the first page has a sketch.
    """
    text = (
        text_of("conventions.axes"),
        text_of("conventions.in_degrees"),
        text_of("conventions.controls") if any(t.controls for t in study.tables) else "",
        _reference_points(study),
        _lengths(study),
        text_of("conventions.potential"),
    )
    figures = axes_figures("axes")
    more = (Section("axes-drawn", "Axes and signs, drawn", figures=figures, appendix=True),)
    return Section(
        "conventions",
        TITLE,
        tuple(t for t in text if t),
        figures=figures if drawn else (),
        subsections=() if drawn else more,
    )


def published_conventions(own: tuple[str, ...]) -> Section:
    """Axes and signs of a publication reproduced.

    Parameters
    ----------
    own : tuple of str
        What holds for this publication alone.
    """
    return Section(
        "conventions",
        TITLE,
        (text_of("conventions.axes"), text_of("conventions.angles"), *own),
        figures=axes_figures("axes", controls=False),
    )


def _reference_points(study: Study) -> str:
    places: dict[str, list[str]] = {}
    for f in study.fits:
        x, y, z = (float(c) for c in f.coefficients.reference_point)
        at = f"({x:.5g}, {y:.5g}, {z:.5g}) m from {f.coefficients.datum}"
        places.setdefault(at, []).append(f.campaign)
    if len(places) == 1:
        which = "of_tables" if study.plan.reference_point is None else "of_study"
        return text_of(f"conventions.point_{which}", at=next(iter(places)))
    each = "; ".join(f"{', '.join(dict.fromkeys(names))}: {at}" for at, names in places.items())
    return f"Moments and velocities refer to these points, in the axes above. {each}." if each else ""


def _lengths(study: Study) -> str:
    lengths = list(dict.fromkeys(str(f.coefficients.scaling) for f in study.fits))
    if not lengths:
        return ""
    named = " and ".join(lengths)
    return text_of("conventions.lengths", named=named)

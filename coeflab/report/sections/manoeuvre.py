"""Simulated manoeuvres in a report: figures with status, track and histories as far as the file determines them."""

from __future__ import annotations

from coeflab.motion.manoeuvre import Simulation
from coeflab.report.document import Section
from coeflab.report.figures.motion import motion_figures
from coeflab.report.tables.motion import figure_table
from coeflab.study.study import Study

TEXT = (
    "Each manoeuvre is computed from a parameter file of this study alone. A figure that leans on motions which no data cover says "
    "so, and one that no coefficient of the file decides has no value.",
)


def manoeuvre_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where the plan asks for no manoeuvre."""
    if not study.manoeuvres:
        return ()
    each = tuple(_manoeuvre(made, f"manoeuvre-{i}") for i, made in enumerate(study.manoeuvres))
    return (Section("manoeuvres", "Simulated manoeuvres", TEXT, subsections=each),)


def _manoeuvre(made: Simulation, anchor: str) -> Section:
    name = made.manoeuvre.name.replace("_", " ")
    title = f"{name[:1].upper()}{name[1:]} of {made.vehicle.name}"
    text = [f"Assumed and found: {'; '.join(made.statements)}."]
    if made.undetermined:
        text.append(f"Nothing is drawn, as the file determines nothing of this motion. {made.undetermined}")
    if made.trajectory.why:
        text.append(f"The motion could not be computed to its end: {made.trajectory.why}")
    length = made.vehicle.length
    return Section(
        anchor,
        title,
        tuple(text),
        (figure_table(made.figures, title, length),),
        motion_figures(made.trajectory.until(made.determined), anchor, length, title),
    )

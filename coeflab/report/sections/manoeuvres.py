"""Simulated manoeuvres in a report: figures with status, track and histories as far as the file determines them."""

from __future__ import annotations

from coeflab.core.wording import listed
from coeflab.law.symbols import primed
from coeflab.motion.manoeuvre import Simulation
from coeflab.report.document import Section
from coeflab.report.figures.motion import motion_figures
from coeflab.report.tables.motion import figure_table
from coeflab.report.texts import text_of, texts_of
from coeflab.study.study import Study
from coeflab.vehicle.parameter_file import ParameterFile

SHOWN = ("track", "profile", "angle")  # of the drawings of a motion, in the core


def manoeuvre_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where the plan asks for no manoeuvre."""
    if not study.manoeuvres:
        return ()
    files = {p.name: p for p in study.parameter_files.values()}
    each = tuple(_manoeuvre(m, f"manoeuvre-{i}", files.get(m.vehicle.name)) for i, m in enumerate(study.manoeuvres))
    return (
        Section(
            "manoeuvres",
            "Simulated manoeuvres",
            (*texts_of("manoeuvres.section"), without_u95(study)),
            subsections=each,
        ),
    )


def without_u95(study: Study) -> str:
    """Why the quantities of the manoeuvres have no U95, or that there is none to have one."""
    if drawn := _drawn(study):
        names = list(dict.fromkeys(result.manoeuvre.name.replace("_", " ") for result in study.manoeuvres))
        single = [n for n in names if n not in drawn]
        rest = f" The {listed(single)} is computed once: coeflab uncertainty FILE gives intervals." if single else ""
        members = ", ".join(f"{name} {count}" for name, count in drawn.items())
        return f"The 95 % ranges on the first page are of draws of the coefficients: {members}.{rest}"
    if any(f.value is not None for result in study.manoeuvres for f in result.figures):
        return text_of("manoeuvres.without_u95")
    every = listed(list(dict.fromkeys(result.manoeuvre.name.replace("_", " ") for result in study.manoeuvres)))
    return f"{every[:1].upper()}{every[1:]} could not be computed, so there is no U95."


def _drawn(study: Study) -> dict[str, int]:
    """Manoeuvres of a vehicle from its shape that were repeated with random coefficients, and how often."""
    carried = study.shape.carried if study.shape is not None else ()
    return {
        c.question.manoeuvre.replace("_", " "): c.question.members
        for c in carried
        if any(s.low is not None for s in c.spreads)
    }


def _stated_rates(result: Simulation, parameters: ParameterFile | None) -> str:
    """Which rotary derivatives of a motion that no data cover are from literature, a sentence; empty where none is."""
    covered = {c.variable.removesuffix("'") for c in result.vehicle.covered}
    wanted = [f"{c}{r}" for r, components in (("r", "YN"), ("q", "ZM")) if r in result.vehicle.free for c in components]
    found = [parameters.coefficient(s) for s in wanted if s[-1] not in covered] if parameters else []
    stated = [primed(c.symbol) for c in found if c is not None and c.origin == "literature" and c.value is not None]
    return f" {listed(stated)} are published values, not fits." if stated else ""


def _manoeuvre(result: Simulation, anchor: str, parameters: ParameterFile | None) -> Section:
    """Its figures and two drawings; in the appendix what was assumed, the other drawings, and figures without any value."""
    name = result.manoeuvre.name.replace("_", " ")
    title = f"{name[:1].upper()}{name[1:]} of {result.vehicle.name}"
    text = []
    if result.undetermined:
        text.append(
            f"Nothing is drawn: the data do not support this motion. {result.undetermined}{_stated_rates(result, parameters)}"
        )
    if result.trajectory.why:
        text.append(f"The motion could not be computed to its end: {result.trajectory.why}")
    length = result.vehicle.length
    drawn = motion_figures(result.trajectory.until(result.determined), anchor, length, title)
    shown = tuple(f for f in drawn if f.anchor.removeprefix(f"{anchor}-") in SHOWN) or drawn[:2]
    table = (figure_table(result.figures, title, length),)
    is_empty = bool(text) and all(f.value is None for f in result.figures)
    if is_empty:
        text.append(f"No value: {listed([f.name for f in result.figures])}.")
    more = Section(
        f"{anchor}-more",
        "Assumed and found",
        tuple(f"{s[:1].upper()}{s[1:]}." for s in result.statements),
        table if is_empty else (),
        figures=tuple(f for f in drawn if f not in shown),
        appendix=True,
    )
    return Section(anchor, title, tuple(text), () if is_empty else table, shown, (more,))

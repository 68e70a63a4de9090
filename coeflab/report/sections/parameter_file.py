"""Stability of straight motion with controls fixed: indices with U95, roots against speed, critical speed.

Eigenvalues of small motions against speed: real parts above, imaginary parts below where there are any.

Simulated manoeuvres in a report: figures with status, track and histories as far as the file determines them.

Exports in a report: what every target makes of a parameter file, and what it loses.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from coeflab.core.errors import CoeflabError
from coeflab.core.table import ABSENT, Table, number
from coeflab.core.types import Array
from coeflab.core.wording import grouped, in_sentences, listed
from coeflab.formats import loss_tables
from coeflab.formats.export import ASSUMED, LOSSLESS, Export, Kind, Loss, Refused
from coeflab.law.symbols import COMPONENTS, MOTIONS, primed
from coeflab.motion.manoeuvre import Simulation
from coeflab.motion.steady_state import RootLocus, root_locus
from coeflab.report.document import Figure, Section, Series
from coeflab.report.figures.motion import motion_figures
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import BOTTOM, GAP, drawing, legend, limits, panel
from coeflab.report.figures.series import STYLES, curve, numbers, tagged
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.tables.added_mass import mass_table
from coeflab.report.tables.motion import figure_table
from coeflab.study.study import Study
from coeflab.vehicle.criteria import REVERSAL, TURNING, criteria
from coeflab.vehicle.inertia import against_computed
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.reference import Relation
from coeflab.vehicle.stability import FAST, INDICES, NO_CRITERION, SIGN_OPEN, Derived, by_mass, sense, stability

UPPER, LOWER, LEGEND = 150.0, 80.0, 34.0
IN_PLANE = {"G_h": "the horizontal plane", "G_v": "the vertical plane"}
ACROSS = "speed  [m/s]"
RUDDER = float(np.radians(15.0))  # at which the diameter of the linear turn is stated


def root_locus_figure(locus: RootLocus, name: str, anchor: str) -> Figure:
    """Roots of one plane over speed.

    Parameters
    ----------
    locus : RootLocus
    name : str
        Of the parameter file.
    anchor : str
    """
    waves = bool(np.any(locus.roots.imag != 0.0))
    bottom = BOTTOM + (LOWER + GAP if waves else 0.0)
    title = f"{name}: roots of straight motion in {IN_PLANE[locus.index]}"
    across = (0.0, float(locus.speed[-1]))
    description = f"{_said('Real', locus.roots.real)}{_said('Imaginary', locus.roots.imag) if waves else ''}"
    with settings():
        figure = drawing(bottom + UPPER + 8.0 + LEGEND)
        real = np.append(locus.roots.real, 0.0)
        main = panel(
            figure, bottom, UPPER, across=across, up=limits(real, 0.08) or (-1.0, 1.0), name_up="real part  [1/s]",
            name_across="" if waves else ACROSS,
        )  # fmt: skip
        handles = _lines(main, locus, locus.roots.real)
        panels = [numbers(main, _series(locus, locus.roots.real), ACROSS, "real part  [1/s]")]
        if waves:
            up = limits(locus.roots.imag, 0.1) or (-1.0, 1.0)
            lower = panel(
                figure, BOTTOM, LOWER, across=across, up=up, name_up="imag.  [1/s]", name_across=ACROSS, most_up=3
            )
            _lines(lower, locus, locus.roots.imag)
            panels.append(numbers(lower, _series(locus, locus.roots.imag), ACROSS, "imaginary part  [1/s]"))
        legend(figure, handles, bottom + UPPER)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, "" if locus.index == "G_h" else locus.statement, description, tuple(panels))


def _lines(axes: Axes, locus: RootLocus, values: Array) -> list[Any]:
    axes.axhline(0.0, color=COLOURS["ink"], linewidth=0.8, zorder=1)
    if locus.critical is not None:
        axes.axvline(locus.critical, color=COLOURS["ink"], linewidth=0.9, linestyle=(0, (1.0, 2.0)), zorder=1)
    handles: list[Any] = []
    for i, style in zip(range(values.shape[1]), STYLES, strict=False):
        look: dict[str, Any] = {"color": style.colour, "linestyle": style.line, "linewidth": 1.4}
        handles += tagged(axes.plot(locus.speed, values[:, i], label=f"root {i + 1}", zorder=2.5, **look), f"root{i}")
    return handles


def _series(locus: RootLocus, values: Array) -> list[Series]:
    return [curve(f"root{i}", f"root {i + 1}", locus.speed, values[:, i]) for i in range(values.shape[1])]


def _said(part: str, values: Array) -> str:
    ends = ", ".join(f"{low:.3g} to {high:.3g}" for low, high in zip(values[0], values[-1], strict=True))
    return f"{part} parts from the slowest to the fastest speed, 1/s: {ends}. "


TEXT = (
    "G_h = 1 - Nv' (Yr' - m') / [Yv' (Nr' - xG' m')] and G_v = 1 - Mw' (Zq' + m') / [Zw' (Mq' - xG' m')], controls fixed, positive: stable. G_v "
    "and roots of the vertical plane without BG hold at high speed: the restoring moment is left out.",
    "U95 comes from that of the derivatives; errors of mass and centre of gravity are not in it. A root with a real part above zero grows.",
)
TURNING_TEXT = (
    "r'/dr = (Nv' Ydr' - Yv' Ndr') / [Yv' (Nr' - xG' m') - Nv' (Yr' - m')] is the turning ability of the rudder."
)
REVERSAL_TEXT = "U_c is the critical speed of the stern planes: slower, planes to dive make it rise. U_c^2 = Zds' BG W / [1/2 rho L^3 (Mw' Zds' - Zw' Mds')]."


def in_words(study: Study) -> list[str]:
    """Which parameter files are unstable, and which are not, plane by plane; none where no index can be given."""
    named: dict[str, dict[str, dict[str, list[str]]]] = {index: {} for index in IN_PLANE}
    for parameters in study.parameter_files.values():
        for d in stability(parameters):
            named[d.name].setdefault(sense(d), {}).setdefault(parameters.name, []).append(_value(d))
    lacking = {p.name: p.conditions.speed for p in study.parameter_files.values() if p.hydrostatics is None}
    out: list[str] = []
    for index, senses in named.items():
        each = [
            named
            for v in sorted(senses, key=lambda v: ("unstable" not in v, v))
            for named in _of_one_sense(index, v, senses[v], lacking)
        ]
        if each:
            start = (
                f"In {IN_PLANE[index]}, it is"
                if out
                else f"With controls fixed, straight motion in {IN_PLANE[index]} is"
            )
            out.append(f"{start} {'. It is '.join(each)}.")
    return [" ".join((*out, *_one_body(study), *_by_others(study)))] if out else []


PLACES = 170  # letters of the parameter files that one sentence names beside its verdict
SOURCES = {"experiment": "test", "cfd": "CFD"}


def _one_body(study: Study) -> list[str]:
    """Which parameter files with an index are of one body, and what each comes from."""
    by: dict[str, dict[str, str]] = {}
    for p in study.parameter_files.values():
        if stability(p):
            of = {name for c in p.coefficients for name in (c.campaign or "").split(", ")}
            kinds = dict.fromkeys(SOURCES.get(t.source.kind, t.source.kind) for t in study.tables if t.campaign in of)
            by.setdefault(p.body, {})[p.name] = " and ".join(kinds)
    return [
        f"The parameter files {listed([f'{name} ({kind})' for name, kind in files.items()])} describe one body, the {body.replace('_', ' ')}."
        for body, files in by.items()
        if len(files) > 1
    ]


def _of_one_sense(
    index: str, verdict: str, places: Mapping[str, Sequence[str]], lacking: Mapping[str, float]
) -> list[str]:
    """The parameter files that one verdict holds for, so many at a time; at high speed also what is open at their own."""
    each = [f"{name} ({', '.join(values)})" for name, values in places.items()]
    open_at = ""
    if FAST in verdict:
        speeds = listed([number(u, 3) for u in dict.fromkeys(lacking[n] for n in places if n in lacking)] or [""])
        open_at = f". {index} gives no verdict at {speeds} m/s, because BG is unknown" if speeds else ""
    undecided = {SIGN_OPEN: f"undecided (sign of {index} open)", NO_CRITERION: "without a verdict"}
    words = undecided.get(verdict, verdict.replace(FAST, f"{FAST} (restoring moment left out)"))
    groups = [f"{words}: {', '.join(group)}" for group in grouped(each, PLACES, ", ".join)]
    return [*groups[:-1], groups[-1] + open_at]


def _by_others(study: Study) -> list[str]:
    """Which derivatives of the indices are from literature, file by file; none where an index has no other."""
    each = []
    for p in study.parameter_files.values():
        stated = [from_literature(p, d.name) for d in stability(p)]
        symbols = dict.fromkeys(s for few in stated if len(few) < len(INDICES["G_h"]) - 1 for s in few)
        each += [f"{listed([primed(s) for s in symbols])} of {p.name}"] if symbols else []
    start = "Where the data give no value, the indices use published ones: "
    return [in_sentences(start, each)] if each else []


def from_literature(parameters: ParameterFile, index: str) -> list[str]:
    """Derivatives of a stability index that no campaign of the study gave."""
    found = [parameters.coefficient(str(s)) for s in INDICES[index][:-1]]
    return [c.symbol for c in found if c is not None and c.origin == "literature"]


def _value(d: Derived) -> str:
    if d.result is None:
        return f"{d.name} = {d.value:.3g}"
    beside = d.limits and d.represented
    skewed = f"; Monte Carlo {number(d.result.low, 3)} to {number(d.result.high, 3)}" if beside else ""
    return f"{d.name} = {d.in_words}{skewed}"


def stability_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where no parameter file has any derivative that an index needs."""
    rows: list[tuple[str, ...]] = []
    roots: list[tuple[str, ...]] = []
    figures: list[Figure] = []
    refused: list[str] = []
    for i, (name, parameters) in enumerate(study.parameter_files.items()):
        found = _indices(parameters)
        rows += [*found, *_other_criteria(parameters)]
        for index in (row[1] for row in found if row[2] != ABSENT):
            try:
                locus = root_locus(parameters, index)
            except CoeflabError as why:
                refused.append(f"{name}, {IN_PLANE[index]}: no roots, as the file has {why}")
                continue
            roots.append(_roots(name, locus))
            figures.append(root_locus_figure(locus, name, f"roots-{i}-{index[-1]}"))
    if not rows:
        return ()
    tables = [_shown(rows, study)]
    if roots:
        heads = ("parameter file", "plane", "roots 1/s", "time to double or halve s", "critical speed m/s")
        speeds: dict[str, list[str]] = {}
        for name in dict.fromkeys(row[0] for row in roots):
            speeds.setdefault(f"{number(study.parameter_files[name].conditions.speed, 3)} m/s", []).append(name)
        at = (
            f"Roots at {next(iter(speeds))}, the speed of the parameter file"
            if len(speeds) == 1
            else "Roots at the speed of the parameter file"
        )
        each = "; ".join(f"{u}: {listed(names)}" for u, names in speeds.items())
        notes = [f"speed of the parameter file: {each}."] if len(speeds) > 1 else []
        tables.append(Table(at, heads, tuple(roots), tuple(notes), frozenset({0, 1, 2, 4})))
    made_of = _made_of(study, {(row[0], row[1]) for row in rows if row[2] != ABSENT})
    used = (*((made_of,) if made_of.rows else ()), *mass_table(study))
    mass = Section("mass-used", "What the indices are computed from", tables=used, appendix=True)
    given = {row[1] for row in rows}
    also = [text for name, text in ((TURNING, TURNING_TEXT), (REVERSAL, REVERSAL_TEXT)) if name in given]
    return (
        Section(
            "stability", "Stability", (TEXT[0], *also, *TEXT[1:], *refused), tuple(tables), tuple(figures), (mass,)
        ),
    )


def _indices(parameters: ParameterFile) -> list[tuple[str, ...]]:
    """A row for every plane of which the file has at least one derivative."""
    given = {d.name: d for d in stability(parameters)}
    out: list[tuple[str, ...]] = []
    for index, (*symbols, _) in INDICES.items():
        found = [parameters.coefficient(str(s)) for s in symbols]
        lacking = [str(s) for s, c in zip(symbols, found, strict=True) if c is None or c.value is None]
        if len(lacking) == len(symbols):
            continue
        if index not in given:
            lacking += ["m'"] if parameters.mass is None else []
            remark = f"missing: {', '.join(lacking)}"
            out.append((parameters.name, index, ABSENT, ABSENT, "no value", remark))
            continue
        d = given[index]
        half = d.half_width
        stated = from_literature(parameters, index)
        remarks = [f"{', '.join(stated)} published"] if stated else []
        remarks += [d.statement] if d.result is None else []
        remarks += [d.limits] if d.limits else []
        remarks.append(f"1 % of m' changes {index} by {number(by_mass(parameters, d), 2)}")
        out.append((parameters.name, index, number(d.value), number(half, 2), sense(d), "; ".join(remarks)))
    return out


def _other_criteria(parameters: ParameterFile) -> list[tuple[str, ...]]:
    """Turning ability and the critical speed of the stern planes, a row each."""
    index = next((d for d in stability(parameters) if d.name == "G_h"), None)
    out: list[tuple[str, ...]] = []
    for d in criteria(parameters):
        remarks = [d.statement] if d.result is None else [d.limits] if d.limits else []
        if d.name == TURNING:
            holds = index is not None and index.decided and sense(index).startswith("stable")
            verdict = f"D/L = {number(2.0 / (abs(d.value) * RUDDER), 3)}" if holds else NO_CRITERION
            open_one = index is None or not index.decided
            without = (
                "a steady linear turn only if stable, which is open"
                if open_one
                else "no steady linear turn: not stable"
            )
            remarks.insert(0, "steady turn at 15 deg of rudder, linear" if holds else without)
        else:
            slower = parameters.conditions.speed < d.value
            verdict = "planes reversed" if slower else "planes as ordered"
            remarks.insert(0, f"at {number(parameters.conditions.speed, 3)} m/s")
        out.append((parameters.name, d.name, number(d.value), number(d.half_width, 2), verdict, "; ".join(remarks)))
    return out


def _shown(rows: list[tuple[str, ...]], study: Study) -> Table:
    """The indices, and beside them those that the source of the same data prints."""
    headers = ("parameter file", "criterion", "value", "U95", "verdict", "remark")
    printed = [_printed(study, name, index) for name, index, *_ in rows]
    if not any(value for value, _ in printed):
        return Table("Standard criteria", headers, tuple(rows), (), frozenset({0, 1, 4, 5}))
    notes = tuple(dict.fromkeys(f"published: {source}" for _, source in printed if source))
    beside = [(*row[:4], value or ABSENT, *row[4:]) for row, (value, _) in zip(rows, printed, strict=True)]
    words = (
        "published: the index that the source prints. We do not judge ours by it, as ours uses our own Yv', Nv', Zw' or Mw'.",
        *notes,
    )
    return Table(
        "Standard criteria", (*headers[:4], "published", *headers[4:]), tuple(beside), words, frozenset({0, 1, 5, 6})
    )


def _made_of(study: Study, given: set[tuple[str, str]]) -> Table:
    """The numbers that the indices are computed from, a row an index, five digits, with their sources."""
    rows = []
    for p in study.parameter_files.values():
        for index, (*symbols, _) in INDICES.items():
            found = [c for s in symbols if (c := p.coefficient(str(s))) is not None and c.value is not None]
            if p.mass is None or (p.name, index) not in given:
                continue
            by: dict[str, list[str]] = {}
            for c in found:
                origin = "published" if c.origin == "literature" else c.origin
                by.setdefault(c.campaign if c.origin == "fit" and c.campaign else origin, []).append(c.symbol)
            sources = [f"{', '.join(those)}: {source}" for source, those in by.items()] if len(by) > 1 else list(by)
            derivatives = (f"{c.symbol} = {number(float(c.value or 0.0), 5)}" for c in found)
            centre = p.mass.mass_moment_prime / p.mass.mass_prime
            values = (*derivatives, f"m' = {number(p.mass.mass_prime, 5)}", f"xG' = {number(centre, 5)}")
            rows.append((p.name, index, ", ".join(values), "; ".join(sources)))
    headers = ("parameter file", "index", "computed from", "derivatives from")
    notes = (
        "m' and xG' are those of the appendix (--full), \"Mass and inertia used\". The indices above have four digits, so that they can be "
        "recomputed from these numbers.",
    )
    return Table("What the indices are computed from", headers, tuple(rows), notes, frozenset(range(4)))


def _printed(study: Study, name: str, index: str) -> tuple[str, str]:
    """An index as the authors of the data of a parameter file print it, and where; empty where none does."""
    parameters = next(p for p in study.parameter_files.values() if p.name == name)
    campaigns = {c.campaign for c in parameters.coefficients}
    for r in study.references:
        if r.relation is Relation.RE_ANALYSIS and r.body == parameters.body and campaigns & set(r.campaigns):
            for value in r.indices:
                if value.symbol == index:
                    return value.printed, f"{index} of {name}: {r.name} ({r.place})"
    return "", ""


def _roots(name: str, locus: RootLocus) -> tuple[str, ...]:
    real = float(locus.at_speed[0].real)
    time = f"{'doubles' if real > 0.0 else 'halves'} in {number(np.log(2.0) / abs(real), 3)}" if real else ABSENT
    if locus.critical is not None:
        critical = number(locus.critical)
    else:
        critical = "none" if locus.is_restored or locus.index == "G_h" else "no value: no BG"
    left = "" if locus.is_restored or locus.index == "G_h" else ", BG left out"
    return name, IN_PLANE[locus.index].removeprefix("the ") + left, _pairs(locus.at_speed), time, critical


def _pairs(values: NDArray[np.complex128]) -> str:
    """Eigenvalues, conjugate ones together."""
    out = []
    for v in values:
        if v.imag > 0.0:
            out.append(f"{number(v.real, 3)} ± {number(v.imag, 3)} i")
        elif v.imag == 0.0:
            out.append(number(v.real, 3))
    return "; ".join(out)


SIMULATED = ("Extrapolated: the motion leaves the range of the data.",)
WITHOUT_U95 = (
    "No U95: each manoeuvre is computed once, with the values of its file; coeflab uncertainty FILE gives intervals."
)
SHOWN = ("track", "profile", "angle")  # of the drawings of a motion, in the core


def manoeuvre_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where the plan asks for no manoeuvre."""
    if not study.manoeuvres:
        return ()
    files = {p.name: p for p in study.parameter_files.values()}
    each = tuple(_manoeuvre(m, f"manoeuvre-{i}", files.get(m.vehicle.name)) for i, m in enumerate(study.manoeuvres))
    return (Section("manoeuvres", "Simulated manoeuvres", (*SIMULATED, without_u95(study)), subsections=each),)


def without_u95(study: Study) -> str:
    """Why the quantities of the manoeuvres have no U95, or that there is none to have one."""
    if drawn := _drawn(study):
        names = list(dict.fromkeys(result.manoeuvre.name.replace("_", " ") for result in study.manoeuvres))
        single = [n for n in names if n not in drawn]
        rest = f" The {listed(single)} is computed once: coeflab uncertainty FILE gives intervals." if single else ""
        members = ", ".join(f"{name} {count}" for name, count in drawn.items())
        return f"The 95 % ranges on the first page are of draws of the coefficients: {members}.{rest}"
    if any(f.value is not None for result in study.manoeuvres for f in result.figures):
        return WITHOUT_U95
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


def _stated_rates(made: Simulation, parameters: ParameterFile | None) -> str:
    """Which rotary derivatives of a motion that no data cover are from literature, a sentence; empty where none is."""
    covered = {c.variable.removesuffix("'") for c in made.vehicle.covered}
    wanted = [f"{c}{r}" for r, components in (("r", "YN"), ("q", "ZM")) if r in made.vehicle.free for c in components]
    found = [parameters.coefficient(s) for s in wanted if s[-1] not in covered] if parameters else []
    stated = [primed(c.symbol) for c in found if c is not None and c.origin == "literature" and c.value is not None]
    return f" {listed(stated)} are published values, not fits." if stated else ""


def _manoeuvre(made: Simulation, anchor: str, parameters: ParameterFile | None) -> Section:
    """Its figures and two drawings; in the appendix what was assumed, the other drawings, and figures without any value."""
    name = made.manoeuvre.name.replace("_", " ")
    title = f"{name[:1].upper()}{name[1:]} of {made.vehicle.name}"
    text = []
    if made.undetermined:
        text.append(
            f"Nothing is drawn: the data do not support this motion. {made.undetermined}{_stated_rates(made, parameters)}"
        )
    if made.trajectory.why:
        text.append(f"The motion could not be computed to its end: {made.trajectory.why}")
    length = made.vehicle.length
    drawn = motion_figures(made.trajectory.until(made.determined), anchor, length, title)
    shown = tuple(f for f in drawn if f.anchor.removeprefix(f"{anchor}-") in SHOWN) or drawn[:2]
    table = (figure_table(made.figures, title, length),)
    is_empty = bool(text) and all(f.value is None for f in made.figures)
    if is_empty:
        text.append(f"No value: {listed([f.name for f in made.figures])}.")
    more = Section(
        f"{anchor}-more",
        "Assumed and found",
        tuple(f"{s[:1].upper()}{s[1:]}." for s in made.statements),
        table if is_empty else (),
        figures=tuple(f for f in drawn if f not in shown),
        appendix=True,
    )
    return Section(anchor, title, tuple(text), () if is_empty else table, shown, (more,))


EXPORTED = (
    "Largest difference: forces and accelerations of the written file by the simulator's own equations against those of the parameter file.",
)


def export_sections(study: Study) -> tuple[Section, ...]:
    """One section, or none where the plan asks for no export."""
    if not study.exports and not study.refused:
        return ()
    each = tuple(
        Section(
            f"export-{i}",
            f"{result.parameters} for {result.target}",
            tables=_tables(result.target, result.loss),
            appendix=True,
        )
        for i, result in enumerate(study.exports)
        if result.loss is not None
    )
    refused = tuple(f"Refused, and not written: {_sentence(r)}" for r in study.refused)
    text = (*EXPORTED, *refused, *added_masses(study))
    return (Section("exports", "Exports", text, (summary(study),), subsections=each),)


def added_masses(study: Study) -> tuple[str, ...]:
    """Of every parameter file that is exported, where its added mass rests on a mean or differs from the computed one."""
    waters = {result.parameters: result.loss.water for result in study.exports if result.loss is not None}
    files = {p.name: p for p in study.parameter_files.values()}
    each = {name: [*w.warnings, against_computed(files[name]) if name in files else ""] for name, w in waters.items()}
    named = {name: ". ".join(f"{w[:1].upper()}{w[1:]}" for w in words if w) for name, words in each.items()}
    return tuple(
        f"Added mass of {name} for stability, motions and exports: {words}." for name, words in named.items() if words
    )


def _tables(target: str, loss: Loss) -> tuple[Table, ...]:
    points = loss_tables.at_points(loss.at_points, f"Force law of {target}", controls=False)
    return (loss_tables.forces(loss), *((points,) if points.rows else ()))


def _sentence(refused: Refused) -> str:
    why = refused.why
    return f"{refused.parameters} for {refused.target}. Found {why.found}; expected {why.expected}."


KINDS = {
    Kind.NOT_HELD: "a term that the target's force law does not have",
    Kind.MISSING: "a number that the target needs and the parameter file does not state",
    Kind.REPLACED: "a number of the parameter file in whose place the target gets another",
    Kind.MISMATCH: "a number that the target understands in another way",
    Kind.LEFT_OUT: "a term with which the target would drive what the file damps, or damp what it drives",
}


ACCELERATIONS = {
    "measured": "the file's acceleration derivatives; gaps are filled with computed added mass",
    "computed": "computed added mass only",
}


def summary(study: Study) -> Table:
    """One row an export, those that were refused last."""
    rows = tuple(
        (result.parameters, result.target, _verdict(result), _worst(result), _accelerations(result), _place(result))
        for result in study.exports
    )
    rows += tuple((r.parameters, r.target, "refused", ABSENT, ABSENT, "none") for r in study.refused)
    headers = ("parameter file", "target", "loss", "largest difference in %", "added mass", "files")
    lossy = [result.loss for result in study.exports if result.loss is not None]
    kinds = {x.kind for loss in lossy for x in loss.lost} | {Kind.NOT_HELD for loss in lossy if loss.not_held}
    notes = (
        *(
            ("accepted: the study's plan allows this loss, so the file is written.",)
            if any("accepted" in row[2] for row in rows)
            else ()
        ),
        *(f"{kind}: {KINDS[kind]}." for kind in Kind if kind in kinds),
        *(
            f"added mass {used}: {ACCELERATIONS[used]}."
            for used in ACCELERATIONS
            if any(row[4] == used for row in rows)
        ),
        *(["files: each row also has one loss report, .loss.txt."] if lossy else []),
        "Largest difference in %: export minus parameter file, of any force or acceleration, divided by its largest value. A "
        "component below 1 % of the largest force or moment is too small to judge. "
        f"States tried: the ranges of the campaigns; from -{ASSUMED:g} to {ASSUMED:g} (primed) for a motion that no campaign varies.",
    )
    return Table("Exports of this study", headers, rows, notes, frozenset({0, 1, 2, 4, 5}))


def _accelerations(made: Export) -> str:
    return ABSENT if made.loss is None else made.loss.water.used


def _verdict(made: Export) -> str:
    if made.loss is None:
        return "none: tables of the file's own values"
    if made.lossless:
        return "none"
    return f"accepted: {loss_tables.counted(made.loss) or 'force or acceleration differs'}"


def _worst(made: Export) -> str:
    if made.loss is None:
        return ABSENT
    name, worst = made.loss.furthest
    small = made.loss.too_small
    if name not in small:
        return f"{loss_tables.percent(worst)} ({name})" if worst > LOSSLESS else loss_tables.percent(worst)
    shares = {c: float(x) for c, x in zip(COMPONENTS, np.nan_to_num(made.loss.relative), strict=True) if c not in small}
    if made.loss.accelerations is not None:
        i, share = made.loss.accelerations.furthest
        shares[f"d{MOTIONS[i]}/dt"] = share
    name = max(shares, key=lambda c: shares[c])
    rest = (
        f"{loss_tables.percent(shares[name])} ({name})"
        if shares[name] > LOSSLESS
        else loss_tables.percent(shares[name])
    )
    return f"{rest}; {', '.join(small)} too small to judge"


def _place(made: Export) -> str:
    names = ", ".join(n for n in sorted(made.files) if made.loss is None or not n.endswith(".loss.txt"))
    return f"{made.folder}/: {names}" if made.folder else names

"""Estimates in a report: a vehicle from its shape, which numbers are estimates, and what each does to the first manoeuvre."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import ABSENT, Table, number, percent, with_u95
from coeflab.core.wording import counted, listed
from coeflab.law.added_mass import AddedMass
from coeflab.law.coefficient import Coefficient
from coeflab.law.symbols import CONTROLS, derivative, primed
from coeflab.motion.manoeuvre import Simulation
from coeflab.motion.uncertainty.spread import Importance, Spread
from coeflab.motion.uncertainty.uncertainty import Carried
from coeflab.report.document import Answer, AnswerRow, Chip, Figure, Section, Topic
from coeflab.report.figures.first_page import forest_figure, share_text
from coeflab.report.figures.hull_outline import hull_figure
from coeflab.report.figures.motion import track_figures
from coeflab.report.figures.uncertainty import bars
from coeflab.report.sections.stability import no_index
from coeflab.report.tables import nouns as noun_tables
from coeflab.report.tables.uncertainty import shown_unit
from coeflab.report.texts import table_of, text_of
from coeflab.study.study import FromShape, Study
from coeflab.vehicle.merge import Merged, estimates_of
from coeflab.vehicle.parameter_file import ParameterFile
from coeflab.vehicle.stability import Derived, missing_for_stability, sense, stability

SIX = ("Yv", "Nv", "Zw", "Mw", "Yr", "Nr")
COLUMN = 244.0  # points: 86 mm
BEFORE = "estimate before"
FIRST = (
    "tactical diameter",
    "advance",
    "stopping time",
)  # figures that a manoeuvre is known by, the first that is there
OFF = "thrust off at time zero"  # what a coast-down says of itself
ROUNDING, FINEST = 1e-6, 1e-9
LISTS = ("not in the estimates", "not stated", "drag without lift")  # of what is missing: what follows names it
LEAST, TENTH, MOST_PARTS, LONGEST = 0.005, 0.1, 3, 160


def main_spread(carried: Sequence[Carried]) -> tuple[Spread, Importance] | None:
    """The figure that the first manoeuvre is known by, with where its variance comes from; None where none has an interval."""
    for c in carried:
        found = {s.figure.name: s for s in c.spreads if s.status == "ok"}
        shares = {i.figure: i for i in c.importances}
        name = next((n for n in FIRST if n in found), None)
        if name is not None:
            return found[name], shares[name]
    return None


def particulars_table(shape: FromShape, hull: AddedMass | None = None) -> Table:
    """Displacement, centres, areas, mass, inertia and added mass, with what is assumed in the notes."""
    c, rho = shape.weighed.configuration, shape.conditions.density
    rows = [("displacement", number(rho * (c.volume or 0.0)), "kg"), ("volume", number(c.volume, 5), "m^3")]
    datum = shape.weighed.body.datum
    if c.mass is not None:
        rows.append(("mass", number(c.mass.mass), "kg"))
    if c.centre_of_buoyancy is not None:
        rows.append(("centre of buoyancy x, y, z", _three(c.centre_of_buoyancy), "m"))
    if c.mass is not None:
        rows.append(
            ("centre of gravity x, y, z", _three(c.mass.centre_of_gravity + shape.weighed.body.reference_point), "m")
        )
        if c.mass.inertia_matrix is not None:
            rows.append(("inertia x, y, z", _three(np.diag(c.mass.inertia_matrix)), "kg m^2"))
    rows.append(("wetted surface", number(c.wetted_surface), "m^2"))
    if c.projected_areas is not None:
        rows.append(("silhouettes along x, y, z", _three(c.projected_areas), "m^2"))
    if hull is not None:
        along, about = np.diag(hull.matrix)[:3], np.diag(hull.matrix)[3:]
        rows += [("added mass along x, y, z", _three(along), "kg"), ("added inertia x, y, z", _three(about), "kg m^2")]
    if hull is not None and hull.u95 is not None:
        half = np.diag(hull.u95)
        rows += [("U95 of added mass", _three(half[:3]), "kg"), ("U95 of added inertia", _three(half[3:]), "kg m^2")]
    by = f"; added mass by {hull.method}" if hull is not None else ""
    return table_of(
        "estimates.particulars_table",
        rows,
        shape.statements,
        name=shape.weighed.body.name,
        datum=datum,
        reference_point=_three(shape.weighed.body.reference_point),
        by=by,
    )


def _three(values: np.ndarray) -> str:
    size = max(float(np.max(np.abs(values))), ROUNDING)
    return ", ".join("0" if abs(float(v)) < ROUNDING * size + FINEST else number(float(v), 4) for v in values)


def estimates_table(
    parameters: ParameterFile,
    carried: Sequence[Carried] = (),
    parts: Mapping[str, Mapping[str, float]] | None = None,
    few: bool = False,
) -> Table:
    """Every number of a file with its U95, whether it is an estimate, what it is made of, its share in the first figure.

    Parameters
    ----------
    parameters : ParameterFile
    carried : sequence of Carried
        The first manoeuvre's.
    parts : mapping of symbol to mapping of part to value, optional
        Of estimates.
    few : bool
        First-order slopes of the two planes, resistance and controls, and what has a tenth of the variance.
    """
    main = main_spread(carried)
    shares = dict(main[1].known) if main is not None else {}
    order = {primed(s): i for i, s in enumerate(SIX)}
    valued = [c for c in parameters.coefficients if c.value is not None]
    if few:
        wanted = {*order, *(primed(s) for s in ("X0", "Xuu", "Xu|u|"))}
        shown = [c for c in valued if c.symbol in wanted or shares.get(c.symbol, 0.0) >= TENTH or _controls(c)]
        rest, valued = len(valued) - len(shown), shown
    rows = tuple(
        (
            c.symbol, *with_u95(c.value, c.u95), percent(c.u95, c.value), _status(c),
            *((f"{100.0 * shares[c.symbol]:.0f} %" if c.symbol in shares else "",) if main is not None else ()),
            *((_contributions(c, parts),) if parts is not None else ()),
        )
        for c in sorted(valued, key=lambda c: (order.get(c.symbol, len(order)), len(derivative(c.symbol).factors)))
    )  # fmt: skip
    heads = (
        "",
        "value",
        "U95",
        "U95",
        "status",
        *((f"of {main[0].figure.name}",) if main is not None else ()),
        *(("made of",) if parts is not None else ()),
    )
    left = frozenset({0, 4, *((len(heads) - 1,) if parts is not None else ())})
    notes = [f"{rest} more; --wide shows all."] if few and rest else []
    if main is not None and sum(shares.values()) > 1.0:
        notes.append(text_of("estimates.together", of=main[0].figure.name))
    return Table(f"{parameters.name}: numbers and estimates", heads, rows, tuple(notes), left, ("made of",))


def _controls(c: Coefficient) -> bool:
    factors = derivative(c.symbol).factors
    return len(factors) == 1 and factors[0] in CONTROLS and c.symbol[0] in "YZMN"


def _status(c: Coefficient) -> str:
    return "estimate" if c.status == "estimate" else c.campaign or str(c.status).replace("_", " ")


def _contributions(c: Coefficient, parts: Mapping[str, Mapping[str, float]]) -> str:
    """The kinds of contributions with their shares, the largest first."""
    if c.status != "estimate" or not c.value:
        return ""
    kinds: dict[str, float] = {}
    for name, value in parts.get(c.symbol.removesuffix("'"), {}).items():
        kind = name.rpartition(", ")[2]
        kinds[kind] = kinds.get(kind, 0.0) + value
    largest = sorted(kinds.items(), key=lambda p: -abs(p[1]))
    words = [f"{name} {100.0 * v / c.value:.0f} %" for name, v in largest if abs(v) >= 0.01 * abs(c.value)]
    return ", ".join(words[:MOST_PARTS]) + (f" and {len(words) - MOST_PARTS} more" if len(words) > MOST_PARTS else "")


def shares_figure(parameters: ParameterFile, carried: Sequence[Carried], anchor: str) -> Figure | None:
    """Bars of what each number contributes to the variance of the first figure, estimates marked; None without an interval."""
    main = main_spread(carried)
    if main is None or not main[1].known:
        return None
    estimated = {c.symbol for c in estimates_of(parameters)}
    known = tuple((f"{s} estimate" if s in estimated else s, v) for s, v in main[1].known if v >= LEAST)
    return bars(replace(main[1], known=known, shares=()), anchor) if known else None


def interval_in_words(carried: Sequence[Carried], speed: float) -> str:
    """The first figure with its interval, for example ``tactical diameter 12.4 m at 15 deg of rudder and 2 m/s (95 % 9 to 19), estimate``.

    Empty without one. The speed is that of the approach, m/s.
    """
    main = main_spread(carried)
    if main is None or main[0].low is None or main[0].high is None or main[0].figure.value is None:
        return ""
    s, (factor, unit) = main[0], shown_unit(main[0].figure.unit)
    asked = next(c.question for c in carried if any(k is s for k in c.spreads))
    if "remaining" in asked.options:
        so = f"to {asked.options['remaining']:g} of {speed:g} m/s"
    elif "rudder" in asked.options:
        so = f"at {_degrees(asked.options['rudder'])} of rudder and {speed:g} m/s"
    else:
        so = f"by thrusters from {speed:g} m/s"
    first, last, middle = ((x or 0.0) * factor for x in (s.low, s.high, s.figure.value))
    value, low, high = (with_u95(x, (last - first) / 2.0)[0] for x in (middle, first, last))
    return f"{s.figure.name} {value}{f' {unit}' if unit else ''} {so} (95 % {low} to {high}), estimate"


def _degrees(angle: float | str) -> str:
    return f"{np.degrees(float(angle)):.3g} deg"


def _how(result: Simulation) -> str:
    """From which speed and by what a manoeuvre goes, for example ``15 deg of rudder from 2 m/s, dr = -15 deg``."""
    speed = float(result.manoeuvre.velocity[0])
    if result.manoeuvre.name == "stop":
        down = result.manoeuvre.phases[0].until
        return f"thrust off at {speed:g} m/s, until {down.value if down is not None else 0.0:g} m/s are left"
    angle = result.manoeuvre.phases[0].orders.get("dr", 0.0)
    if not angle:
        return f"unequal thrusters from {speed:g} m/s"
    return f"{_degrees(abs(angle))} of rudder from {speed:g} m/s, dr = {_degrees(angle)}"


def _held(moves: Sequence[Simulation]) -> tuple[str, ...]:
    """What the first manoeuvres hold, and whether the straight course that is held is stable."""
    straight = [m for m in moves if "v" not in m.vehicle.free]
    if not straight:
        return ("In the horizontal plane: heave, roll and pitch are held. Every number is an estimate.",)
    words = [s for s in straight[0].statements if "straight" in s]
    return (*(f"{s[:1].upper()}{s[1:]}." for s in words), "Every number is an estimate.")


def manoeuvre_table(moves: Sequence[Simulation], carried: Sequence[Carried]) -> Table:
    """Figures of the first manoeuvres, with intervals where the uncertainty was carried through."""
    bounds = {(c.question.manoeuvre, s.figure.name): s for c in carried for s in c.spreads if s.status == "ok"}
    rows, notes = [], []
    for result in moves:
        name = result.manoeuvre.name
        called = "coast-down" if OFF in result.manoeuvre.statements else name.replace("_", " ")
        notes.append(f"{called}: {_how(result)}.")
        if carried and not any(c.question.manoeuvre == name for c in carried):
            notes.append(
                f"{called}: no 95 %, as only the first manoeuvre is repeated with random coefficients; coeflab uncertainty FILE --manoeuvre {name} has it."
            )
        notes += [f"{called}: {s.removeprefix('limit: ')}." for s in result.statements if s.startswith("limit: ")]
        for f in result.figures:
            factor, unit = shown_unit(f.unit)
            s = bounds.get((name, f.name))
            ends = f"{(s.low or 0.0) * factor:.3g} to {(s.high or 0.0) * factor:.3g}" if s is not None else ABSENT
            value = f.status if f.value is None else number(f.value * factor, 3)
            if f.name != "lateral deviation":
                rows.append((called, f.name, value, unit, ends))
    main = main_spread(carried)
    if main is not None and main[1].tests:
        causes = ", ".join(f"{test} {100.0 * share:.0f} %" for test, share in main[1].tests[:MOST_PARTS])
        notes.append(
            f"{main[0].figure.name}: causes of its 95 %, as the share of the variance that a test would take off: {causes}."
        )
    return table_of("estimates.manoeuvre_table", rows, (*notes, *_held(moves)))


def sentence(study: Study) -> str:
    """What came out, in one sentence."""
    shape, parameters = _shape(study), next(iter(study.parameter_files.values()))
    found = estimates_of(parameters)
    shares = sorted(abs(c.u95 / c.value) for c in found if c.u95 and c.value)
    wide = f", median U95 {share_text(shares[len(shares) // 2])}" if shares else ""
    c = shape.weighed.configuration
    displaced = shape.conditions.density * (c.volume or 0.0)
    mass = f"{c.mass.mass:.3g} kg in {displaced:.3g} kg of displacement" if c.mass else f"displaces {displaced:.3g} kg"
    turn = interval_in_words(shape.carried, parameters.conditions.speed)
    ended = f"; {turn}." if turn else "."
    long, short = (f"{mass}; {len(found)} estimates from the shape{w}{ended}" for w in (wide, ""))
    names = [name for name in (study.plan.title, study.plan.name, "Vehicle") if name]
    named = (f"{name}: {rest}" for rest in (long, short) for name in names[:-1])
    return next((s for s in (*named, f"{names[-1]}: {short}", short) if len(s) <= LONGEST), short[:LONGEST])


def _shape(study: Study) -> FromShape:
    if study.shape is None:
        raise TypeError("a study with tables has no shape of its own")
    return study.shape


def answer_of_shape(study: Study, *, drawn: bool = True) -> Answer:
    """The first page of a body alone: six slopes as estimates, the first manoeuvre, and what is missing."""
    shape, parameters = _shape(study), next(iter(study.parameter_files.values()))
    wanted = study.plan.wanted or SIX
    rows = []
    for symbol in wanted:
        c = parameters.coefficient(symbol)
        value, u95 = (c.value, c.u95) if c is not None else (None, None)
        status = "" if value is not None else "no estimate"
        rows.append(AnswerRow(symbol, value, u95, status, "estimates", anchor="coefficients"))
    indices = stability(parameters)
    held = _stability(indices[0]) if indices else no_index(missing_for_stability(parameters))
    turn = interval_in_words(shape.carried, parameters.conditions.speed)
    chips = (
        Chip("Stability", f"{held}, estimate" if indices else held, Severity.NOTE, "stability"),
        Chip("First manoeuvre", turn or "no interval", Severity.NOTE, "manoeuvres" if study.manoeuvres else ""),
        Chip("Missing", _missing(shape.missing), Severity.WARN if shape.missing else Severity.PASS, "estimates"),
        _exports(study),
    )  # fmt: skip
    by = f"Estimates by semi-empirical methods, no measurement; primes made with {parameters.scaling.length_name} = {parameters.scaling.length:.5g} m."
    result = Answer(
        sentence(study),
        rows=tuple(rows),
        chips=chips,
        notes=(by, *(f"{s[:1].upper()}{s[1:]}." for s in shape.statements[:2])),
    )
    if not drawn:
        return result
    left = _track(study.manoeuvres)
    of, mass = shape.weighed, shape.weighed.configuration.mass
    is_stated = mass is not None and "centre" not in of.assumed
    gravity = of.body.reference_point + mass.centre_of_gravity if mass is not None and is_stated else None
    outline = hull_figure(of.body, "answer-body", COLUMN, gravity)
    return replace(result, slope=left, forest=shares_figure(parameters, shape.carried, "answer-shares"), axes=outline)


def _track(moves: Sequence[Simulation]) -> Figure | None:
    """Of the first manoeuvre, where there is one."""
    for first in moves:
        return track_figures(first.trajectory, "answer-track", first.vehicle.length, f", {_how(first)}")[0]
    return None


def _missing(missing: Sequence[str]) -> str:
    """How many things a vehicle lacks; the name of a single one, such as no thruster."""
    if len(missing) == 1:
        head, _, rest = missing[0].partition(": ")
        named = rest.partition("; ")[0].partition(", without")[0]
        return f"{head}: {named}" if head.startswith(LISTS) else head
    return counted(len(missing), "thing") if missing else "nothing"


def _stability(index: Derived) -> str:
    """The verdict with what it rests on: an interval that holds zero says why nothing is determined."""
    found = f"{index.value:.2f}" if index.result is None else index.in_words
    return f"{sense(index).partition(' at ')[0]}, {index.name} = {found}"


def _exports(study: Study) -> Chip:
    """How many exports were made, and how many refused."""
    result, refused = len(study.exports), len(study.refused)
    loss = sum(not e.lossless for e in study.exports)
    words = f"{result} made{f', {loss} with losses' if loss else ''}" if result else "" if refused else "none asked for"
    words = ", ".join(filter(None, (words, f"{refused} refused" if refused else "")))
    return Chip("Exports", words, Severity.WARN if refused else Severity.NOTE, "exports" if result else "")


def verdict_of_shape(study: Study) -> Section:
    """What comes out of a shape alone, in short paragraphs."""
    shape = _shape(study)
    text = [sentence(study), *(f"{s[:1].upper()}{s[1:]}." for s in shape.statements)]
    missing = (Topic("Missing", tuple(f"{m[:1].upper()}{m[1:]}." for m in shape.missing)),) if shape.missing else ()
    return Section("verdict", "Verdict", tuple(text), topics=missing)


def estimates_sections(study: Study) -> tuple[Section, ...]:
    """Particulars and estimates of a body alone."""
    if study.shape is None:
        return ()
    shape, (name, parameters) = study.shape, next(iter(study.parameter_files.items()))
    figure = shares_figure(parameters, shape.carried, f"shares-{name}"[:60].replace("_", "-"))
    tables = [
        particulars_table(shape, parameters.added_mass),
        estimates_table(parameters, shape.carried, shape.estimates.shares),
    ]
    text = (
        (text_of("estimates.estimated"), text_of("estimates.shares"))
        if figure is not None
        else (text_of("estimates.estimated"),)
    )
    notes = tuple(f"{n[:1].upper()}{n[1:]}." for n in shape.estimates.notes)
    missing = (
        Section("missing", "Missing", tuple(f"{m[:1].upper()}{m[1:]}." for m in shape.missing))
        if shape.missing
        else None
    )
    outside = dict.fromkeys(
        f"{c.part}, {c.kind} by {c.method}: {c.outside}." for c in shape.estimates.contributions if c.outside
    )
    works = Section("methods", "Methods of the estimates", (*notes, *outside), (_methods(shape),), appendix=True)
    hull = parameters.added_mass
    matrix = Section("added-mass-used", "Added mass", tables=(noun_tables.matrix(hull),)) if hull is not None else None
    subsections = tuple(s for s in (missing, matrix, works) if s is not None)
    return (
        Section("coefficients", "Estimates", text, tuple(tables), (figure,) if figure is not None else (), subsections),
    )


def _methods(shape: FromShape) -> Table:
    rows = tuple(
        dict.fromkeys(
            (c.part, c.kind, c.method, f"{100.0 * c.share:.0f} %", f"{c.citation}{f', {c.place}' if c.place else ''}")
            for c in shape.estimates.contributions
        )
    )
    return table_of("estimates.methods", rows)


def given(result: Merged) -> str:
    """How many numbers and fitted tables came from the other file."""
    numbers = sum(r.after is not None for r in result.replaced)
    return listed([
        *([counted(numbers, "number")] if numbers or not result.tables else []),
        *([counted(len(result.tables), "fitted table")] if result.tables else []),
    ])  # fmt: skip


def merged_table(result: Merged) -> Table:
    """What was replaced: before, after, and how far apart they are in the U95 of both."""
    rows = []
    for r in result.replaced:
        before, after = (_value(c) for c in (r.before, r.after))
        apart = ABSENT
        if (
            r.before
            and r.after
            and r.before.u95
            and r.after.u95
            and r.before.value is not None
            and r.after.value is not None
        ):
            apart = f"{abs(r.after.value - r.before.value) / np.hypot(r.before.u95, r.after.u95):.2f}"
        rows.append((r.symbol, before, after if r.after else "left out", apart))
    left = ", ".join(c.symbol for c in result.estimates) or "none"
    return table_of("estimates.merged_table", rows, name=result.parameters.name, left=left)


def _value(c: Coefficient | None) -> str:
    if c is None:
        return ABSENT
    value, u95 = with_u95(c.value, c.u95)
    return f"{value} +- {u95}" if c.u95 else value


def answer_of_merge(result: Merged, moves: Sequence[Simulation], carried: Sequence[Carried]) -> Answer:
    """The first page of a merge: six slopes beside the estimates that they replace, and what is still an estimate."""
    p, left = result.parameters, len(result.estimates)
    before = {r.symbol.removesuffix("'"): r.before.value for r in result.replaced if r.before is not None}
    rows = []
    for symbol in SIX:
        c = p.coefficient(symbol)
        value, u95 = (c.value, c.u95) if c is not None else (None, None)
        source = "" if c is None else _status(c)
        status = "no estimate" if value is None else "" if u95 else "no U95"
        rows.append(AnswerRow(symbol, value, u95, status, source, (before.get(symbol),), anchor="coefficients"))
    turn = interval_in_words(carried, p.conditions.speed).removesuffix(", estimate")
    words = f"{p.name}: {given(result)} replaced, {counted(left, 'estimate')} left{f'; {turn}' if turn else ''}."
    chips = (
        Chip("Replaced", given(result), Severity.PASS, "coefficients"),
        Chip("Estimates left", str(left), Severity.NOTE, "coefficients"),
        Chip("First manoeuvre", turn or "no interval", Severity.NOTE, "manoeuvres"),
    )
    left_figure = _track(moves)
    right = forest_figure(rows, (BEFORE,), BEFORE) or forest_figure(rows, (BEFORE,), "")
    note = f"{BEFORE}: the value that was replaced, of the base. Made dimensionless with {p.scaling.length_name} = {p.scaling.length:.5g} m."
    return Answer(words[:LONGEST], (BEFORE,), "", tuple(rows), chips, left_figure, right, None, (note,))


def replaced_section(result: Merged, carried: Sequence[Carried]) -> Section:
    """What was replaced, which estimates remain, and what they contribute to the uncertainty of the turn."""
    figure = shares_figure(result.parameters, carried, "shares")
    main = main_spread(carried)
    text = [
        text_of("estimates.estimated"),
        *([f"{result.lengths[:1].upper()}{result.lengths[1:]}."] if result.lengths else []),
    ]
    if main is not None:
        estimated = {c.symbol for c in result.estimates}
        own = [(symbol, v) for symbol, v in main[1].known if symbol in estimated]
        words = interval_in_words(carried, result.parameters.conditions.speed).removesuffix(", estimate")
        which = (
            f"Of the estimates still in it {listed([symbol for symbol, _ in own])} contribute, the largest "
            f"{100.0 * max(v for _, v in own):.0f} % of its variance."
            if own
            else "No estimate still in it contributes."
        )
        text.append(f"{words[:1].upper()}{words[1:]}. {which}")
        text.append(text_of("estimates.shares"))
    return Section("coefficients", "Estimates and what replaced them", tuple(text),
                   (merged_table(result), estimates_table(result.parameters, carried)), (figure,) if figure else ())  # fmt: skip

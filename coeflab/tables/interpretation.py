"""How far a file is understood: what is settled, what is open, what is doubtful because the numbers contradict it."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from coeflab.core.axes import Axes
from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error, text_of
from coeflab.core.units import SI, quantity
from coeflab.core.wording import listed
from coeflab.law.symbols import LINEAR
from coeflab.tables.campaign import Cut, cut_of
from coeflab.tables.column_company import FEW_STRANGE, proposals, without_strangers
from coeflab.tables.column_map import ANGLES, FORCES, WIND, ColumnMap, read_column_map, unturned
from coeflab.tables.column_names import named_as
from coeflab.tables.evidence import Evidence, across_planes, astern, evidence, turn_of
from coeflab.tables.force_table import FEWEST_SPEEDS
from coeflab.tables.level_columns import slopes_by_idle_columns
from coeflab.tables.low_aspect import above_low_aspect
from coeflab.tables.mapping import (
    NO_FORCE,
    SETTINGS,
    Assigned,
    along_the_flow,
    another_density,
    another_viscosity,
    assigned,
    entry_of,
    fault,
    header,
    known_as,
    meaning_of,
    with_unit,
)
from coeflab.tables.proposals import AREA, Proposal, Reason, coefficient_by_sizes, lacks_sizes, may_be_force, taken_as
from coeflab.tables.questions import Question, known_sizes, questions
from coeflab.tables.raw_table import HALF_MODEL, ONE_FLOW, RawColumn, RawTable
from coeflab.tables.settings import EXTRA, OF_ARMS, SYMMETRY, VISCOSITY, Setting, Settings, frame_of, read_setting
from coeflab.tables.settings_in_files import against_words, overruled
from coeflab.tables.time_record import IDENTIFY, clock, record_over_time
from coeflab.tables.vocabulary import folded, vocabulary
from coeflab.tables.words.axes import BODY_AXES, TURN_OF_R

MOST_IDLE = 5  # columns that a warning names


@dataclass(frozen=True, slots=True)
class Doubt:
    """A rate that the numbers contradict.

    Attributes
    ----------
    column : RawColumn
    meaning : ColumnMap
        What it is by now, or, where its axis is contradicted, the rate about the other axis.
    why : str
    turns : str
        What a positive number of the column does if it is what is said; empty while the axes are not known.
    another : bool
        The axis is contradicted, not the sign.
    instead : ColumnMap or None
        What the column is where its force counts along the flow, not along the body; None where that is no question.
    """

    column: RawColumn
    meaning: ColumnMap
    why: str
    turns: str = ""
    another: bool = False
    instead: ColumnMap | None = None


@dataclass(frozen=True, slots=True)
class Interpretation:
    """How far a file is understood.

    Attributes
    ----------
    proposals : tuple of Proposal
        One a column, whether or not a person has said otherwise.
    mapping : mapping of str to ColumnMap
        What is settled.
    open : tuple of (RawColumn, Proposal)
        Columns that nobody has confirmed.
    columns : tuple of Assigned
        As they would be if all whole proposals are right.
    shows : tuple of Evidence
    questions : tuple of Question
        What nobody has said yet.
    complaints : tuple of InputError
        What is said of columns and cannot be.
    doubts : tuple of Doubt
        Rates whose sign the numbers contradict and that no person has judged, and rates about another axis than the forces say.
    about : mapping of str to str
        The long explanation of every key, said ones too.
    accepted : frozenset of str
        Columns whose proposal was accepted: nobody named them.
    """

    proposals: tuple[Proposal, ...]
    mapping: Mapping[str, ColumnMap]
    open: tuple[tuple[RawColumn, Proposal], ...]
    columns: tuple[Assigned, ...]
    shows: tuple[Evidence, ...]
    questions: tuple[Question, ...]
    complaints: tuple[InputError, ...] = ()
    doubts: tuple[Doubt, ...] = ()
    about: Mapping[str, str] = field(default_factory=dict)
    accepted: frozenset[str] = frozenset()


def interpreted(
    raw: RawTable, meanings: Mapping[str, ColumnMap], settings: Settings, accept: bool = False,
    judged: Collection[str] | None = None,
) -> Interpretation:  # fmt: skip
    """What of a file is settled, what is open, and what its numbers show.

    Parameters
    ----------
    raw : RawTable
    meanings : mapping of str to ColumnMap
        What a person said of columns, by their names in the file.
    settings : mapping of str to Setting
    accept : bool
        Take whole proposals as confirmed.
    judged : collection of str, optional
        Columns whose sign a person has settled, by default all of ``meanings``.
    """
    in_frame = frame_of(_with_frame(raw, settings))
    cut = _cut_of(settings)
    offers = _offers(raw, meanings, settings, in_frame, cut)
    mapping: dict[str, ColumnMap] = {}
    still: list[tuple[RawColumn, Proposal]] = []
    accepted: set[str] = set()
    for column, offer in zip(raw.columns, offers, strict=True):
        one = meaning_of(column, meanings, raw.columns)
        if one is not None and lacks_sizes(column, one):
            one = read_column_map(offer.text) if offer.whole else None
        if one is None and offer.whole and (offer.certain or accept):
            one = read_column_map(offer.text)
            accepted.add(column.name)
        if one is None:
            still.append((column, offer))
        else:
            mapping[column.name] = one
    tentative = {c.name: _likely_map(c, o) for c, o in still}
    known_meanings = mapping | tentative
    columns, complaints = _columns(raw, known_meanings, any(not offer.whole for _, offer in still))
    record = tuple(record_over_time(raw))
    if not meanings and not record and (bare := _no_table(raw, offers)):
        complaints = (bare,)
    likely = _with_frame(raw, settings)
    frame = frame_of(likely)
    warned = {unturned(c.column.name, c.meaning) for c in columns} if BODY_AXES in raw.stated else set()
    shows = tuple(_against(e, settings) for e in evidence(columns, frame) if e.statement not in warned)
    if not any(e.instead for e in shows):  # a doubtful axis comes first
        shows += tuple(_across(columns, frame, settings))
    names = [o.meaning.name for _, o in still if o.meaning and not o.whole]
    shows += tuple(
        Evidence(f"{key} = {value}, but {place}", warns=True) for key, value, place in against_words(raw, settings)
    )
    halved = [
        c.name for c, o in zip(raw.columns, offers, strict=True) if o.reason is Reason.HALF and "se_" not in c.name
    ]
    if cut is not None:
        shows += (Evidence(
            f"half of the body, cut at {cut.plane}: {', '.join(cut.doubled)} are doubled" + f"; {', '.join(halved)} left out" * bool(halved)
        ),)  # fmt: skip
    shows += tuple(Evidence(unread, warns=True) for one in columns if (unread := taken_as(one)))
    shows += (
        *slopes_by_idle_columns(raw, columns),
        *above_low_aspect(columns, frame, *known_sizes(raw, settings), settings),
    )
    if all(offer.whole or offer.role not in SETTINGS for _, offer in still):
        shows += tuple(_at_rest(raw, columns))
    primes = _primes_by_name(raw, columns, meanings, [c.name for c, o in still if not o.whole])
    asked = questions(raw, columns, likely, shows, names, [o for _, o in still], primes or AREA in settings)
    if frame and (back := astern(columns, frame)):
        complaints += (_astern(raw, back, frame),)
    complaints += (
        *record, *_another_water(raw, columns, settings), *_two_ways(raw, columns), *overruled(raw, settings),
    )  # fmt: skip
    settled = set(meanings if judged is None else judged)
    doubts = [
        _doubt(one, e, frame) for e in shows for one in columns
        if e.against and one.meaning.name == e.against and not one.meaning.error
        and (e.instead or not settled & {one.column.name, *known_as(one.column)})
    ]  # fmt: skip
    yet = tuple(q for q in asked if q.key not in settings)
    about = {q.key: q.asks for q in asked}
    doubts += [
        *_turned_by_words(raw, columns, frame, settled, doubts),
        *_in_one_flow(raw, {n: one for n, one in meanings.items() if n in settled}, frame),
    ]
    more, vain = _in_vain(raw, mapping, still)
    shows, complaints = (*shows, *more), (*complaints, *vain)
    return Interpretation(
        offers, mapping, tuple(still), columns, shows, yet, complaints, tuple(doubts), about, frozenset(accepted)
    )


def _columns(
    raw: RawTable, known_meanings: Mapping[str, ColumnMap], unfinished: bool
) -> tuple[tuple[Assigned, ...], tuple[InputError, ...]]:
    """The columns, or those that are possible with what is wrong; that no force is said yet is not, while some are open."""
    try:
        return assigned(raw, known_meanings, whole=False), ()
    except InputError as why:
        return tuple(_possible(raw, known_meanings)), () if why.found == NO_FORCE and unfinished else (why, *why.others)


def _primes_by_name(
    raw: RawTable, columns: Sequence[Assigned], meanings: Mapping[str, ColumnMap], unsized: Collection[str]
) -> bool:
    """Whether a force is a prime by its name alone, not one of a size that is still open."""
    by_name = {c.name for c in raw.columns if not {c.name, *known_as(c)} & set(meanings)} - set(unsized)
    forces = (c for c in columns if c.meaning.role == "force" and c.column.name in by_name)
    return any(c.meaning.pure and not c.meaning.area for c in forces)


def _likely_map(column: RawColumn, offer: Proposal) -> ColumnMap:
    """What a column is as far as questions hang on it: a force in a unit, or by an area, that nobody has said shows signs all the same."""
    if offer.whole:
        return read_column_map(offer.text)
    name, _, unit = offer.text.partition(" [")
    if not name and "side" in (meanings := vocabulary().several.get(folded(column.name), "").split()):
        name, unit = meanings[0], "coefficient"  # either shows the sign of beta
    if name.lstrip("-") not in (*FORCES, *ANGLES) or offer.unread:
        return ColumnMap("ignore")
    pure = unit.startswith("coefficient")  # a sign shows in any unit
    return read_column_map(f"{name}' [-]" if pure else f"{name} [{SI[read_column_map(name).dimension]}]")


def _no_table(raw: RawTable, offers: Sequence[Proposal]) -> InputError | None:
    """The complaint about what cannot be a table of forces: no number in it, or nothing known of forces and settings."""
    if len(raw) and not any(np.any(np.isfinite(c.values)) for c in raw.columns):
        return InputError("no number", "forces over settings", file=raw.path)
    roles = {o.role for o in offers}
    strange = [c.name for c, o in zip(raw.columns, offers, strict=True) if o.reason is Reason.UNKNOWN]
    if "force" in roles and not roles & {*SETTINGS} and len(strange) > FEW_STRANGE:
        return input_error(
            "tables.forces_without_settings", raw.path, names=listed([shown(n) for n in strange[:MOST_IDLE]]), first=strange[0],
        )  # fmt: skip
    if roles & {"force", "error"} or any(map(may_be_force, offers, raw.columns)):
        return None
    for blank in (c for c in raw.columns if named_as(c.name) in FORCES and not np.any(np.isfinite(c.values))):
        return fault("tables.no_number_in_column", raw, blank, example="")
    names = listed([shown(c.name) for c in raw.columns[:MOST_IDLE]])
    if "propeller" in roles and any(o.reason is Reason.PROPELLER for o in offers):
        return input_error("tables.propeller_alone", raw.path, names=names)
    over = clock(raw)
    words = vocabulary()
    unread = {
        header(c): f"{c.name}={words.of_flow(c.name)} [lbf]" for c in raw.columns if c.unit and words.of_flow(c.name)
    }
    worded = {
        c.name: f"{c.name}={n} [coefficient A=1 m^2]"
        for c in raw.columns
        if (n := named_as(c.name.split("_")[0])) in FORCES
    }
    for found, one in (("in units that are not known", unread), ("with words behind them", worded)) if not over else ():
        if one:
            return input_error(
                "tables.forces_unread", raw.path, found=found, one=listed([shown(n) for n in [*one][:MOST_IDLE]]),
                next=next(iter(one.values())),
            )  # fmt: skip
    return input_error(
        "tables.forces_over_settings", raw.path,
        found=over or f"no name of a force{', an angle, a speed or a rate' * (not roles & {*SETTINGS})}: {names}",
        identify=f"{IDENTIFY} " * bool(over),
    )  # fmt: skip


def accepted_without_source(found: Interpretation, settings: Settings) -> tuple[str, ...]:
    """Keys, and columns with a guessed unit, that were accepted although neither a person nor the file states them."""
    of_coefficients = any(one.pure and one.role == "force" for one in found.mapping.values())  # the others have units
    keys = [
        k for k, one in settings.items()
        if one.assumed and (k not in OF_ARMS or k in found.about) and (of_coefficients or not k.startswith("coefficients."))
    ]  # fmt: skip
    units = {o.text for o in found.proposals if o.assumed}
    columns = [
        f"columns.{one.name}" for name, one in found.mapping.items() if name in found.accepted and str(one) in units
    ]
    return (*keys, *columns)


def _another_water(raw: RawTable, columns: Sequence[Assigned], settings: Settings) -> Iterator[InputError]:
    """A stated density or viscosity that is not the one that the runs were computed with."""
    if "conditions.density" in settings:
        other = another_density(raw, columns, quantity(settings["conditions.density"].value, "density"))
        yield from (other,) if other else ()
    if VISCOSITY in settings:
        with suppress(InputError):  # a text that is no viscosity is complained of with the whole campaign
            different = another_viscosity(raw, quantity(settings[VISCOSITY].value, "viscosity"))
            yield from (different,) if different else ()


def _cut_of(settings: Settings) -> Cut | None:
    """The cut of a body of which the table has one half."""
    half = settings.get("table.half_model") or settings.get(HALF_MODEL)
    return cut_of(half.value) if half is not None else None


def _across(columns: Sequence[Assigned], frame: Axes | None, settings: Settings) -> Iterator[Evidence]:
    """Forces across a plane, while nobody has said whether the forces are of the whole body."""
    if HALF_MODEL in settings or "table.half_model" in settings:
        return
    symmetry = settings[SYMMETRY].value if SYMMETRY in settings else ()
    length = quantity(settings["scaling.length"].value, "length") if "scaling.length" in settings else 0.0
    yield from across_planes(columns, frame, symmetry, length)


def _of_half(offer: Proposal, cut: Cut, frame: Axes | None) -> Proposal:
    """What a column of half of a body is: of the components that the cut loses, nothing that is used."""
    given = offer.meaning
    own = {c: name for c, (name, _) in frame.columns.items()} if frame else {c: c for c in cut.cancelled}
    if given is None or given.role not in ("force", "error") or given.name not in [own[c] for c in cut.cancelled]:
        return offer
    return Proposal(
        "ignore",
        f"of half of the body, cut at {cut.plane}; {given} of the whole is not known",
        certain=True,
        reason=Reason.HALF,
    )


def _offers(
    raw: RawTable, meanings: Mapping[str, ColumnMap], settings: Settings, frame: Axes | None, cut: Cut | None
) -> tuple[Proposal, ...]:
    """What every column may be; where a person called one a coefficient without its area, that by the area that all share."""
    known = {key: settings[key].value for key in (*EXTRA, "scaling.length") if key in settings}
    out = []
    for column, offer in zip(raw.columns, proposals(raw, known, frame), strict=True):
        one = meaning_of(column, meanings, raw.columns)
        lacks = one is not None and lacks_sizes(column, one)
        out.append(
            coefficient_by_sizes(one, known)
            if one is not None and lacks
            else _of_half(offer, cut, frame)
            if cut
            else offer
        )
    confirmed = [meaning_of(column, meanings, raw.columns) for column in raw.columns]
    if not any(one is not None and one.role == "force" for one in confirmed):
        return tuple(out)
    known_too = [replace(offer, text=str(one)) if one else offer for one, offer in zip(confirmed, out, strict=True)]
    left = without_strangers(raw, known_too, confirmed=True)
    return tuple(offer if one else alone for one, offer, alone in zip(confirmed, out, left, strict=True))


def _in_vain(
    raw: RawTable, mapping: Mapping[str, ColumnMap], still: Sequence[tuple[RawColumn, Proposal]]
) -> tuple[tuple[Evidence, ...], tuple[InputError, ...]]:
    """What no answer mends: a single row, lift without drag, drag at a drift angle without side, a speed of zero; a warning where a
    column is left that may be what lacks.
    """
    known_meanings = dict(mapping) | {c.name: o.meaning for c, o in still if o.meaning}
    names = {m.name: name for name, m in known_meanings.items() if not m.error}
    moving = [c.name for c in raw.columns if np.any(np.nan_to_num(c.values))]
    wind = next((w for w in WIND if w in names), "")
    vain = []
    for lacks, angle in (("drag", ""), ("side", "beta"), ("lift", "alpha")) if wind else ():
        own = {lacks, *("YZ" if angle else "")}
        if names.keys().isdisjoint(own) and (not angle or names.get(angle) in moving):
            vain.append(input_error(
                "tables.wind_without", raw.path, column=names[wind], wind=wind, lacks=lacks, more=f" at {angle}" * bool(angle),
            ))  # fmt: skip
    shows = [
        Evidence("one row: a slope needs several settings. Runs of one sweep are read as one folder", warns=True)
    ] * (len(raw) == 1)
    if vain and (strange := [c.name for c, o in still if not o.text]):
        shows += [
            Evidence(f"{v.found}: nothing follows, unless it is one of {listed(strange[:MOST_IDLE])}", warns=True)
            for v in vain
        ]
        vain = []
    if len(raw) and names.get("U", moving[:1]) not in (*moving, moving[:1]):
        vain.append(InputError("a speed of zero throughout", "a speed above zero", file=raw.path, column=names["U"]))
    return tuple(shows), tuple(vain)


def _at_rest(raw: RawTable, columns: Sequence[Assigned]) -> Iterator[Evidence]:
    """A warning where no setting is anything but zero, with the columns that vary and that no fit would use."""
    moving = [
        c for c in columns if c.meaning.role in ("angle", "velocity", "control", "radius") and c.meaning.name != "u"
    ]
    if any(np.any(np.nan_to_num(c.values) != 0.0) for c in moving) or not any(
        c.meaning.role == "force" for c in columns
    ):
        return
    used = {c.column.name for c in columns}
    idle = [c for c in raw.columns if c.name not in used and np.unique(c.values[np.isfinite(c.values)]).size > 1]
    varied = f"; not used, and it varies: {listed([c.name for c in idle[:MOST_IDLE]])}" if idle else ""
    if _is_straight(columns):
        says = "nothing varies but the speed: straight runs give X0', and no slope"
        yield Evidence(f"{says}{varied}", warns=bool(idle))
        return
    column = idle[0].name if idle else "COLUMN"
    yield Evidence(
        "nothing varies: no column is an angle, a velocity, a rate, a control or a radius, so no slope follows"
        f"{varied}. Say what was varied, such as --map {shlex.quote(f'{column}=r [rad/s]')}",
        warns=True,
    )


def _two_ways(raw: RawTable, columns: Sequence[Assigned]) -> Iterator[InputError]:
    """The complaint about angles of the flow beside components of the speed: which of both holds cannot be known."""
    angles = [c for c in columns if c.meaning.role == "angle"]
    linear = [c for c in columns if c.meaning.role == "velocity" and c.meaning.name in LINEAR]
    if not angles or not linear:
        return
    named, speeds = (listed([c.column.name for c in some]) for some in (angles, linear))
    alone = len(linear) == 1 and linear[0].meaning.name == "u"
    way = f"Give --map {shlex.quote(f'{linear[0].column.name}=U [m/s]')} where {speeds} is the speed." * alone
    yield input_error(
        "tables.angles_and_velocities", raw.path, column=named, named=named, speeds=speeds,
        way=way or "Leave the columns of one kind out: --map COLUMN=ignore.",
    )  # fmt: skip


def _is_straight(columns: Sequence[Assigned]) -> bool:
    """Whether a surge force stands beside three speeds or more, so that straight runs give X0'."""
    speeds = [
        c for c in columns if c.meaning.role == "speed" or (c.meaning.role == "velocity" and c.meaning.name == "u")
    ]
    found = [np.unique(c.values[np.isfinite(c.values)]).size for c in speeds]
    return max(found, default=0) >= FEWEST_SPEEDS and any(
        c.meaning.role == "force" and c.meaning.name in ("X", "drag") for c in columns
    )


def _with_frame(raw: RawTable, settings: Settings) -> Settings:
    """The settings, with the axes that words over the table say where nobody has declared any."""
    given = raw.stated.get("axes.frame")
    if given is None or not given.offered or given.contradicted or "axes.frame" in settings:
        return settings
    return {**settings, "axes.frame": Setting(read_setting("axes.frame", given.value), given.place)}


def _turned_by_words(
    raw: RawTable, columns: Sequence[Assigned], frame: Axes | None, settled: Collection[str], doubts: Sequence[Doubt]
) -> Iterator[Doubt]:
    """Rates that turn to another side, by the axes, than words over the table say."""
    words = raw.stated.get(TURN_OF_R)
    for one in columns if frame and words else ():
        if one.meaning.name != "r" or one.meaning.error or set(settled) & {one.column.name, *known_as(one.column)}:
            continue
        turn = turn_of(one.meaning, frame)  # type: ignore[arg-type]
        if turn.startswith("turns") and str(words.value) not in turn and one.column not in [d.column for d in doubts]:  # type: ignore[union-attr]
            yield Doubt(one.column, one.meaning, f"{words.place}, but by the axes r > 0 {turn}", turn)  # type: ignore[union-attr]


def _in_one_flow(raw: RawTable, by_person: Mapping[str, ColumnMap], frame: Axes | None) -> Iterator[Doubt]:
    """Forces of a body that is turned in the mesh: along the flow, or along the body."""
    for column, flow, body in along_the_flow(raw, by_person, frame):
        yield Doubt(column, body, text_of("foam.turned_mesh", place=raw.stated[ONE_FLOW].place), instead=flow)


def _doubt(one: Assigned, shows: Evidence, frame: Axes | None) -> Doubt:
    words = replace(one.meaning, name=shows.instead, negative=False) if shows.instead else one.meaning
    return Doubt(one.column, words, shows.text, turn_of(words, frame) if frame else "", bool(shows.instead))


def _against(shows: Evidence, settings: Settings) -> Evidence:
    """Evidence of a sign, as a warning where the opposite is declared."""
    declared = settings.get(shows.key)
    if declared is None or " ".join(str(declared.value).split()) == shows.value:
        return shows
    return replace(shows, warns=True, statement=f"{shows.statement}, so {shows.value}; declared is {shows.key} = {declared.value}. One of "
                   f"them is wrong: the sign of the angle, of the force, or the axes")  # fmt: skip


def _astern(raw: RawTable, back: Assigned, frame: Axes) -> InputError:
    other = "CFD (x aft)" if frame.rotation[0][0] > 0.0 else "FRD or FLU (x forward)"
    return fault("tables.moves_astern", raw, back.column, other=other)


def _possible(raw: RawTable, meanings: Mapping[str, ColumnMap]) -> Iterator[Assigned]:
    """Columns of which what is said of them is possible."""
    for column in raw.columns:
        one = entry_of(column, meanings, raw.columns)
        if one is None or one.name == "ignore":
            continue
        try:
            yield with_unit(raw, column, one)
        except InputError:  # among the complaints
            continue

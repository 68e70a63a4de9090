"""What a file leaves open before it is a campaign: settings with their origins, questions, and the arguments that answer them."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from coeflab.core.axes import ANGLE_SIGNS, Axes
from coeflab.core.errors import InputError, shown
from coeflab.core.provenance import TABLE_KINDS
from coeflab.core.units import quantity
from coeflab.law.symbols import ANGULAR
from coeflab.tables.campaign import CENTRES
from coeflab.tables.column_map import ROLES, ColumnMap, read_column_map, unturned
from coeflab.tables.mapping import Assigned, another_density, assigned, entry_of, error_of, fault, known_as, with_unit
from coeflab.tables.proposals import OPEN, Evidence, Proposal, astern, evidence, proposals, turn_of
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.settings import POINT_OF, Settings, frame_of
from coeflab.tables.words_above import BODY_AXES

FRAMES_ASKED = (
    "Axes of the forces: FRD (x forward, y starboard, z down), FLU (x forward, y port, z up), CFD (x aft, y starboard, "
    "z up), or three directions such as aft,port,down"
)
PLACE_ASKED = "x, y, z in m from the datum, x forward, y starboard, z down, such as -2.1, 0, 0 (2.1 m aft of it), or 0 for the datum"
INERTIA_ASKED = (
    "Do the forces contain the model's own inertia: true for a balance on a real rotating arm, false for a solver"
)


@dataclass(frozen=True, slots=True)
class Question:
    """A key of campaign.toml that somebody has to say.

    Attributes
    ----------
    key : str
    asks : str
    place : str
        Stands for the value where an argument is shown.
    default : str
        What follows from the file or from unambiguous evidence; empty where nothing does.
    why : str
        What the default rests on.
    certain : bool
        The file itself gives the default.
    on_enter : str
        What Enter takes on a terminal, where a person sees it; ``--yes`` does not.
    """

    key: str
    asks: str
    place: str
    default: str = ""
    why: str = ""
    certain: bool = False
    on_enter: str = ""


def questions(
    raw: RawTable, columns: Sequence[Assigned], settings: Settings, shows: Sequence[Evidence] = (),
    likely: Sequence[str] = (),
) -> tuple[Question, ...]:  # fmt: skip
    """What has to be said yet before the file is a campaign.

    Parameters
    ----------
    raw : RawTable
    columns : sequence of Assigned
        May be empty while nobody knows what the columns are.
    settings : mapping of str to Setting
        What is known.
    shows : sequence of Evidence
        What the numbers show; a default comes of it only where one key follows.
    likely : sequence of str
        What columns are by name whose unit is still open.
    """
    rates = {c.said.name: np.nan_to_num(c.values) != 0.0 for c in columns if c.said.name in ANGULAR}
    angles = [c.said.name for c in columns if c.said.role == "angle"]
    angles += [name for name in likely if ROLES[name] == "angle"]
    follows = {e.key: e for e in shows if e.key}
    out = [Question("axes.frame", FRAMES_ASKED, "FRAME")]
    for name in angles:
        side = {"beta": "v to starboard", "alpha": "w down"}[name]
        asks = f"Sign of {name}: {' or '.join(ANGLE_SIGNS[name])}, {side}, whatever the axes are; or just + or -"
        found = follows.get(f"axes.{name}")
        out.append(Question(f"axes.{name}", asks, "SIGN", found.value if found else "", found.text if found else ""))
    at = raw.stated.get(POINT_OF)
    own = f". The file has {_point(at.value)} in its own axes from its own origin ({at.place})" if at else ""
    here, turned = "", at.value if at else ""
    if isinstance(turned, tuple) and len(turned) == 3 and (frame := frame_of(settings)):
        here = ", ".join(f"{x + 0.0:.12g}" for x in frame.rotation @ np.array(turned))
        own += f", in FRD ({here}): Enter takes it, if the datum is that origin"
    known = settings[POINT_OF].value if POINT_OF in settings else None
    same = ", ".join(map(str, known)) if isinstance(known, list) else ""
    enter = "; Enter: the reference point" * bool(same)
    median = {role: _median(columns, role) for role in ("speed", "density")}
    why = {role: f"median of the column of {role}" if found else "" for role, found in median.items()}
    out += [
        Question("axes.datum", "Point of the body that places count from: nose, cg, midship ...", "POINT"),
        Question(POINT_OF, f"Where the moments are about: {PLACE_ASKED}{own}", "X,Y,Z", on_enter=here),
        Question("scaling.length", "Length of the primes, m", "METRES"),
        Question("scaling.length_name", "Which length that is: LBP, LOA ...", "NAME"),
        *(
            Question(f"conditions.{role}", asks, role.upper(), median[role], why[role], bool(median[role]))
            for role, asks in (("density", "Density of the water, kg/m^3"), ("speed", "Speed, m/s"))
        ),
    ]
    arm = "R" in likely or any(c.said.role == "radius" for c in columns)
    if arm:
        out += [
            Question("table.centre", f"Where the centre of the circle lies: {', '.join(CENTRES)}", "SIDE"),
            Question("table.arm_point", f"Where R and U are measured to: {PLACE_ASKED}{enter}", "X,Y,Z", on_enter=same),
        ]
    if arm or set(ANGULAR) & set(likely) or any(map(np.any, rates.values())):
        out.append(Question("table.contains_inertia", INERTIA_ASKED, "TRUE_OR_FALSE"))
    if (inside := settings.get("table.contains_inertia")) and inside.value is True:
        out += [
            Question("inertia.mass", "Mass of the model, kg", "MASS"),
            Question(
                "inertia.centre_of_gravity", f"Its centre of gravity: {PLACE_ASKED}{enter}", "X,Y,Z", on_enter=same
            ),
        ]
        # About one axis alone the moment of inertia holds nothing: omega x I omega = 0.
        if np.any(np.sum([*rates.values()], axis=0) > 1) or (arm and "alpha" in angles):
            out.append(Question("inertia.inertia", "Ix, Iy, Iz about its centre of gravity, kg m^2", "IX,IY,IZ"))
    kinds = ", ".join(TABLE_KINDS)
    cited = raw.path.resolve().name
    out += [
        Question("source.kind", f"What the numbers are: {kinds}", "KIND"),
        Question("source.citation", "Their report, test or person", "SOURCE", cited, "the file's name", True),
    ]
    return tuple(_offered(q, raw) for q in out if q.key not in settings)


def _offered(q: Question, raw: RawTable) -> Question:
    """The question with what words over the table say as its default, where nothing else gives one."""
    said = raw.stated.get(q.key)
    if q.default or said is None or not said.offered:
        return q
    value = f"{said.value:.12g}" if isinstance(said.value, float) else str(said.value)
    return replace(q, default=value, why=said.place)


@dataclass(frozen=True, slots=True)
class Doubt:
    """A rate that the numbers contradict.

    Attributes
    ----------
    column : RawColumn
    said : ColumnMap
        What it is by now, or, where its axis is contradicted, the rate about the other axis.
    why : str
    turns : str
        What a positive number of the column does if it is what is said; empty while the axes are not known.
    another : bool
        The axis is contradicted, not the sign.
    """

    column: RawColumn
    said: ColumnMap
    why: str
    turns: str = ""
    another: bool = False


@dataclass(frozen=True, slots=True)
class Understood:
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
    complaints : tuple of InputError
        What is said of columns and cannot be.
    doubts : tuple of Doubt
        Rates whose sign the numbers contradict and that no person has judged, and rates about another axis than the forces say.
    """

    proposals: tuple[Proposal, ...]
    mapping: Mapping[str, ColumnMap]
    open: tuple[tuple[RawColumn, Proposal], ...]
    columns: tuple[Assigned, ...]
    shows: tuple[Evidence, ...]
    questions: tuple[Question, ...]
    complaints: tuple[InputError, ...] = ()
    doubts: tuple[Doubt, ...] = ()


def understood(
    raw: RawTable, said: Mapping[str, ColumnMap], settings: Settings, accept: bool = False,
    judged: Collection[str] | None = None,
) -> Understood:  # fmt: skip
    """What of a file is settled, what is open, and what its numbers show.

    Parameters
    ----------
    raw : RawTable
    said : mapping of str to ColumnMap
        What a person said of columns, by their names in the file.
    settings : mapping of str to Setting
    accept : bool
        Take whole proposals as confirmed.
    judged : collection of str, optional
        Columns whose sign a person has settled, by default all of ``said``.
    """
    offers = proposals(raw)
    mapping: dict[str, ColumnMap] = {}
    still: list[tuple[RawColumn, Proposal]] = []
    for column, offer in zip(raw.columns, offers, strict=True):
        one = next((said[name] for name in (column.name, *known_as(column)) if name in said), error_of(column, said))
        if one is None and offer.whole and (offer.certain or accept):
            one = read_column_map(offer.text)
        if one is None:
            still.append((column, offer))
        else:
            mapping[column.name] = one
    tentative = {c.name: read_column_map(o.text) if o.whole else ColumnMap("ignore") for c, o in still}
    said_of = mapping | tentative
    complaints: tuple[InputError, ...] = ()
    try:
        columns = assigned(raw, said_of, whole=False)
    except InputError as why:
        complaints = (why, *why.others)
        columns = tuple(_possible(raw, said_of))
    frame = frame_of(settings)
    warned = {unturned(c.column.name, c.said) for c in columns} if BODY_AXES in raw.stated else set()
    shows = tuple(_against(e, settings) for e in evidence(columns, frame) if e.text not in warned)
    names = [read_column_map(o.text.partition(" [")[0]).name for _, o in still if o.text and not o.whole]
    asked = questions(raw, columns, settings, shows, names)
    if frame and (back := astern(columns, frame)):
        complaints += (_astern(raw, back, frame),)
    if "conditions.density" in settings:
        other = another_density(raw, columns, quantity(settings["conditions.density"].value, "density"))
        complaints += (other,) if other else ()
    settled = set(said if judged is None else judged)
    doubts = [
        _doubt(one, e, frame) for e in shows for one in columns
        if e.against and one.said.name == e.against and not one.said.error
        and (e.instead or not settled & {one.column.name, *known_as(one.column)})
    ]  # fmt: skip
    return Understood(offers, mapping, tuple(still), columns, shows, asked, complaints, tuple(doubts))


def _doubt(one: Assigned, shows: Evidence, frame: Axes | None) -> Doubt:
    said = replace(one.said, name=shows.instead, negative=False) if shows.instead else one.said
    return Doubt(one.column, said, shows.text, turn_of(said, frame) if frame else "", bool(shows.instead))


def _against(shows: Evidence, settings: Settings) -> Evidence:
    """Evidence of a sign, as a warning where the opposite is declared."""
    declared = settings.get(shows.key)
    if declared is None or " ".join(str(declared.value).split()) == shows.value:
        return shows
    return replace(shows, text=f"warning: {shows.text}, so {shows.value}; declared is {shows.key} = {declared.value}. One of "
                   f"them is wrong: the sign of the angle, of the force, or the axes")  # fmt: skip


def _astern(raw: RawTable, back: Assigned, frame: Axes) -> InputError:
    other = "CFD (x aft)" if frame.rotation[0][0] > 0.0 else "FRD or FLU (x forward)"
    return fault(
        raw, "u is below zero in every row: in these axes the body moves astern", "u above zero", back.column,
        f"Is the frame {other}? A test astern is read in place, by [columns] of its campaign.toml.",
    )  # fmt: skip


def _possible(raw: RawTable, said: Mapping[str, ColumnMap]) -> Iterator[Assigned]:
    """Columns of which what is said of them is possible."""
    for column in raw.columns:
        one = entry_of(column, said)
        if one is None or one.name == "ignore":
            continue
        try:
            yield with_unit(raw, column, one)
        except InputError:  # among the complaints
            continue


def argument(option: str, key: str, text: str) -> str:
    """An argument of the command line as a shell takes it; primes in double quotes."""
    said = f"{key}={text}"
    plain = "'" in said and not set(said) & set('"$`\\!\n')
    return f'{option} "{said}"' if plain else f"{option} {shlex.quote(said)}"


def open_points(found: Understood, accept: bool = False) -> tuple[tuple[str, str], ...]:
    """Arguments that settle what is open, each with what it rests on.

    Parameters
    ----------
    found : Understood
    accept : bool
        Leave out questions whose answer follows from evidence.
    """
    out = []
    for d in found.doubts:
        ways = [argument("--map", d.column.name, str(replace(d.said, negative=turned))) for turned in (True, False)]
        if d.another:
            which = f"The second {d.turns} where {d.column.name} > 0, the first the other way"
        else:
            which = "The first turns its sign, the second keeps it" + f": {d.column.name} > 0 {d.turns}" * bool(d.turns)
        out.append((" or ".join(ways), f"{d.why}. {which}"))
    doubted = [d.column.name for d in found.doubts]
    for column, offer in found.open:
        if column.name in doubted:
            continue
        text = offer.text.replace(OPEN, "UNIT" if "coefficient" not in offer.text else "SIZE") or "WHAT"
        out.append((argument("--map", column.name, text), offer.why))
    for q in found.questions:
        if not (q.certain or (accept and q.default)):
            out.append((argument("--set", q.key, q.default or q.place), q.why or q.asks))
    return tuple(out)


def _point(value: Any) -> str:
    return f"({', '.join(f'{x:g}' for x in value)})" if isinstance(value, tuple) else str(value)


def _median(columns: Sequence[Assigned], role: str) -> str:
    """Of the column of a role, in SI; empty where there is none."""
    values = next((c.values for c in columns if c.said.role == role), np.empty(0))
    usable = values[np.isfinite(values)]
    return f"{float(np.median(usable)):.12g}" if usable.size else ""


@dataclass(frozen=True, slots=True)
class Group:
    """Questions that one line answers; what it leaves open is asked alone.

    Attributes
    ----------
    name : str
        For the prompt.
    keys : tuple of str
    asks : str
        With an example.
    split : callable
        From what was typed to texts, one a key; empty ones are open.
    questions : tuple of Question
        In the order of the keys.
    """

    name: str
    keys: tuple[str, ...]
    asks: str
    split: Callable[[str], tuple[str, ...]]
    questions: tuple[Question, ...] = ()

    def question(self, key: str) -> Question:
        """The question of a key."""
        return self.questions[self.keys.index(key)]

    @property
    def enter(self) -> str:
        """What Enter takes; empty where nothing is offered for the first question."""
        offers = [q.default or q.on_enter for q in self.questions]
        return ", ".join(filter(None, offers)) if offers[0] else ""

    @property
    def text(self) -> str:
        """What it asks, and what is offered with what it rests on."""
        offers = [f"{q.default} ({q.why})" if len(self.keys) > 1 else q.why for q in self.questions if q.default]
        return f"{self.asks}." + f" {'Default' if self.enter else 'Unless said'}: {'; '.join(offers)}." * bool(offers)

    def answers(self, typed: str) -> dict[str, str]:
        """Texts by key; fewer texts than keys go to those without a default, which the others take.

        Raises
        ------
        InputError
            More than is asked for, or a place with its side in words.
        """
        parts = self.split(typed)
        if len(parts) > len(self.keys):
            raise InputError(shown(typed), f"at most {len(self.keys)} answers: {', '.join(self.keys)}")
        defaults = {q.key: q.default or q.on_enter for q in self.questions}
        bare = [k for k in self.keys if not defaults[k]]
        said = dict(zip(bare if len(parts) == len(bare) else self.keys, parts))
        return {k: text for k in self.keys if (text := said.get(k, "") or defaults[k])}


def _place_and_datum(typed: str) -> tuple[str, ...]:
    """``-2.1 from nose``, ``nose -2.1, 0, 0``, or ``midship``, which is the point itself."""
    numbers = re.search(r"[-+]?\d[^A-Za-z]*(?:(?:mm|cm|m)\b)?", typed)
    at = numbers[0].strip(" ,;:@") if numbers else ""
    rest = (
        (typed[: numbers.start()] + " " + typed[numbers.end() :] if numbers else typed)
        .replace("(", " ")
        .replace(")", " ")
    )
    words = [w for w in re.split(r"[\s,;:@]+", rest) if w]
    if numbers and (sided := {w.casefold() for w in words} & _SIDED):
        raise InputError(
            f"{shown(typed)}, the side as a word", "the side as a sign, x forward: -2.1 from nose is 2.1 m aft of it",
            advice=f"Leave out {sided.pop()}.",
        )  # fmt: skip
    named = " ".join(w for w in words if w.casefold() not in _BETWEEN)
    return named, at or ("0" if named else "")


_BETWEEN = frozenset(["from", "of", "the", "at", "von", "vom", "ab", "am", "du", "de", "la", "m"])
_SIDED = frozenset(
    [
        "aft",
        "behind",
        "abaft",
        "astern",
        "after",
        "forward",
        "fwd",
        "fore",
        "ahead",
        "before",
        "below",
        "above",
        "under",
        "over",
        "port",
        "starboard",
        "hinter",
        "vor",
        "achtern",
        "achterlich",
        "vorn",
        "ueber",
        "über",
        "unter",
        "derriere",
        "derrière",
        "devant",
    ]
)


def _size_and_name(typed: str) -> tuple[str, ...]:
    """``4.3 m LBP``, ``4.3, LBP`` or ``4300 mm``."""
    found = re.match(r"\s*([-+]?[\d.,]*\d(?:\s*(?:mm|cm|m|ft|in)\b)?)[\s,;:]*(.*)", typed)
    return (found[1].strip(), found[2].strip(" ()")) if found else (typed, "")


def _numbers(typed: str) -> tuple[str, ...]:
    """``998.8 kg/m^3, 1.5 m/s`` or ``998.8 1.5``."""
    return tuple(p for p in re.split(r"\s*;\s*|,\s+|(?<=\d),(?=\d+\.)|\s+(?=[-+.]?\d)", typed.strip()) if p)


def _kind_and_citation(typed: str) -> tuple[str, ...]:
    kind, _, cited = typed.replace(":", ",", 1).replace(";", ",", 1).partition(",")
    return kind.strip(), cited.strip()


GROUPS = (
    Group("moments about", ("axes.datum", POINT_OF), "Point that the moments are about: a named one (midship, cg, nose), or x or "
          "x, y, z in m from one, x forward, y starboard, z down: -2.1 from nose (2.1 m aft of it)", _place_and_datum),
    Group("length", ("scaling.length", "scaling.length_name"), "Length of the primes and its name, such as 4.3 m LBP", _size_and_name),
    Group("density, speed", ("conditions.density", "conditions.speed"), "Density of the water in kg/m^3 and speed in m/s, such as "
          "998.8, 1.5", _numbers),
    Group("source", ("source.kind", "source.citation"), f"What the numbers are ({', '.join(TABLE_KINDS)}), and their report, test "
          "or person, such as experiment, basin report 12", _kind_and_citation),
)  # fmt: skip


def alone(one: Question) -> Group:
    """A question by itself."""
    return Group(one.key, (one.key,), one.asks, lambda typed: (typed,), (one,))


def together_with(one: Question, asked: Sequence[Question]) -> Group | None:
    """The group of a question, if all of it is open and what Enter takes is clear; else None."""
    by_key = {q.key: q for q in asked}
    group = next((g for g in GROUPS if one.key in g.keys), None)
    if group is None or any(k not in by_key or by_key[k].on_enter for k in group.keys):
        return None
    return replace(group, questions=tuple(by_key[k] for k in group.keys))

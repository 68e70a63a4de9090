"""What a file leaves open before it is a campaign: settings with their origins, questions, and the arguments that answer them."""

from __future__ import annotations

import json
import shlex
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.axes import ANGLE_SIGNS, FRAMES, Axes, angle_sign, parse_axes
from coeflab.core.declarations import POINT, numbers, one_of, text_of
from coeflab.core.errors import InputError, shown, together
from coeflab.core.provenance import TABLE_KINDS
from coeflab.core.text.toml import read_toml
from coeflab.core.units import quantity
from coeflab.law.scaling import Scaling, doubtful_size, speaks_of_air
from coeflab.law.symbols import ANGULAR
from coeflab.tables.campaign import (
    CENTRES,
    CampaignAxes,
    CampaignConditions,
    CampaignHead,
    InputUncertainty,
    TableDeclaration,
    TableSource,
    TowedInertia,
)  # fmt: skip
from coeflab.tables.column_map import ROLES, ColumnMap, read_column_map
from coeflab.tables.mapping import Assigned, another_density, assigned, entry_of, error_of, fault, known_as, with_unit
from coeflab.tables.proposals import OPEN, Evidence, Proposal, astern, evidence, proposals
from coeflab.tables.raw_table import RawColumn, RawTable

POINT_OF = "axes.reference_point"
CONFIRMED = ("confirmed", "from ")
_KINDS = {
    "campaign": CampaignHead, "axes": CampaignAxes, "scaling": Scaling, "conditions": CampaignConditions,
    "source": TableSource, "inertia": TowedInertia, "uncertainty": InputUncertainty, "table": TableDeclaration,
}  # fmt: skip
SECTIONS = {section: tuple(f.name for f in fields(kind)) for section, kind in _KINDS.items()}
PLACES = ("FRAME", "POINT", "NAME", "SOURCE", "KIND", "SIGN", "SIDE")
RESERVED = ("table.file", "table.source_sha256", "table.sha256", "table.cells", "campaign.importer")


FRAMES_ASKED = (
    "Axes of the forces: FRD (x forward, y starboard, z down), FLU (x forward, y port, z up), CFD (x aft, y starboard, "
    "z up), or three directions such as aft,port,down"
)
PLACE_ASKED = "x, y, z in m from the datum, x forward, y starboard, z down, such as -2.1, 0, 0 (2.1 m aft of it), or 0 for the datum"
PLACE_WANTED = "x, y, z in m, such as -2.1, 0, 0; 0 is the datum"
PLACE_KEYS = ("axes.reference_point", "inertia.centre_of_gravity", "table.arm_point", "table.reference_point")
INERTIA_ASKED = (
    "Do the forces contain the model's own inertia: true for a balance on a real rotating arm, false for a solver"
)


@dataclass(frozen=True, slots=True)
class Setting:
    """A value of campaign.toml and where it comes from.

    Attributes
    ----------
    value : object
        As TOML holds it.
    origin : str
        For the comment beside it.
    """

    value: Any
    origin: str


Settings = Mapping[str, Setting]


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


def _sign(name: str) -> Callable[[Any], Any]:
    def read(said: Any) -> str:
        formulas = {"+" if sign > 0 else "-": formula for formula, sign in ANGLE_SIGNS[name].items()}
        text = formulas.get(str(said), said)
        angle_sign(name, text)
        return " ".join(str(text).split())

    return read


def _frame(said: Any) -> Any:
    if isinstance(said, str) and said not in FRAMES:
        listed = [word.strip(" \"'[]") for word in said.split(",")]
        said = said.upper() if said.upper() in FRAMES else listed if len(listed) == 3 else said
    parse_axes(said)
    return said


def _triple(read: Callable[[Any, Path], Any]) -> Callable[[Any], Any]:
    def parsed(typed: Any) -> Any:
        said = list(typed) if isinstance(typed, tuple) else typed
        if isinstance(said, str):
            inner = said.strip(" []()")
            parts = inner.split("," if "," in inner else ";" if ";" in inner else None)
            said = [_toml(part.strip(" \"'")) for part in parts]
        try:
            read(said, Path())
        except InputError as why:
            if not isinstance(typed, str):
                raise
            advice = "Write a decimal point." if len(said) > 3 and "." not in typed else why.advice
            raise type(why)(shown(typed), why.expected, advice=advice) from None
        return said

    return parsed


def _place(said: Any) -> Any:
    if not isinstance(said, bool) and said in (0, "0"):
        return [0.0, 0.0, 0.0]
    try:
        return _triple(POINT.read)(said)
    except InputError as why:
        raise type(why)(why.found, PLACE_WANTED, advice=why.advice) from None


def _flag(said: Any) -> bool:
    words = {"yes": True, "y": True, "true": True, "no": False, "n": False, "false": False}
    found = said if isinstance(said, bool) else words.get(str(said).casefold())
    if found is None:
        raise InputError(shown(said), "true or false")
    return found


def _measured(dimension: str) -> Callable[[Any], Any]:
    def read(said: Any) -> Any:
        if not quantity(said, dimension) > 0.0:
            raise InputError(shown(said), f"a {dimension} above zero")
        return said

    return read


def _one_of(*words: str) -> Callable[[Any], Any]:
    return lambda said: one_of(*words).read(said, Path())


READERS: dict[str, Callable[[Any], Any]] = {
    "axes.frame": _frame,
    "axes.alpha": _sign("alpha"),
    "axes.beta": _sign("beta"),
    **dict.fromkeys(PLACE_KEYS, _place),
    "table.centre": _one_of(*CENTRES),
    "inertia.inertia": _triple(numbers(3, "inertia", "three numbers [Ix, Iy, Iz]").read),
    "inertia.mass": _measured("mass"),
    "scaling.length": _measured("length"),
    "conditions.density": _measured("density"),
    "conditions.speed": _measured("speed"),
    "table.contains_inertia": _flag,
    "source.kind": _one_of(*TABLE_KINDS),
    **dict.fromkeys(
        ("axes.datum", "axes.datum_note", "scaling.length_name", "source.citation", "campaign.title", "campaign.body", "campaign.name"),
        lambda said: str(text_of(said if isinstance(said, str) else json.dumps(said), Path())),
    ),
}  # fmt: skip


def _toml(text: str) -> Any:
    try:
        return tomllib.loads(f"x = {text}")["x"]
    except (tomllib.TOMLDecodeError, RecursionError):
        return text


def read_setting(key: str, text: Any) -> Any:
    """A value of campaign.toml as a person types it: TOML, or bare words.

    Raises
    ------
    InputError
        No such key, or nothing that it takes.
    """
    section, _, name = key.partition(".")
    if name not in SECTIONS.get(section, ()) or key in RESERVED:
        known = [f"{section}.{n}" for n in SECTIONS.get(section, ()) if f"{section}.{n}" not in RESERVED]
        expected = f"one of {', '.join(known or SECTIONS)}" + ("" if known else " with a key, such as axes.frame")
        raise InputError(f"the key {shown(key)}", expected)
    if text in PLACES:
        raise InputError(shown(text), "a value in its place", column=key)
    typed = _toml(text) if isinstance(text, str) and READERS.get(key) is not READERS["axes.datum"] else text
    try:
        return READERS.get(key, lambda said: said)(typed)
    except InputError as why:
        raise type(why)(why.found, why.expected, column=key, advice=why.advice) from None


def stated_settings(raw: RawTable) -> dict[str, Setting]:
    """What a file says of itself, as far as campaign.toml has keys for it.

    A reference point is left out: a file counts it in its own axes from its own origin.
    """
    out = {}
    for key, said in raw.stated.items():
        section, _, name = key.partition(".")
        if name in SECTIONS.get(section, ()) and key not in (*RESERVED, POINT_OF):
            plain = list(map(float, said.value)) if isinstance(said.value, tuple) else said.value
            out[key] = Setting(plain, f"stated: {said.place}")
    return out


def doubtful_setting(raw: RawTable, settings: Settings, key: str) -> str:
    """Why the number of a key is probably one in another unit; empty where it is a usual one, or the file states it."""
    one = settings[key]
    sizes = {"conditions.density": "density", "conditions.speed": "speed", "scaling.length": "length"}
    if key not in sizes or one.origin.startswith("stated"):
        return ""
    texts = [
        raw.path.name,
        raw.dialect.get("importer", ""),
        *(s.value for k, s in settings.items() if k.startswith(("campaign.", "source."))),
    ]
    return doubtful_size(key, quantity(one.value, sizes[key]), speaks_of_air(texts))


def frame_of(settings: Settings) -> Axes | None:
    """The axes of the file, where they are known."""
    return parse_axes(settings["axes.frame"].value) if "axes.frame" in settings else None


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
    return tuple(q for q in out if q.key not in settings)


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
    doubts : tuple of (RawColumn, ColumnMap, str)
        Rates whose sign the numbers contradict and of which no person said what they are, with the reason.
    """

    proposals: tuple[Proposal, ...]
    mapping: Mapping[str, ColumnMap]
    open: tuple[tuple[RawColumn, Proposal], ...]
    columns: tuple[Assigned, ...]
    shows: tuple[Evidence, ...]
    questions: tuple[Question, ...]
    complaints: tuple[InputError, ...] = ()
    doubts: tuple[tuple[RawColumn, ColumnMap, str], ...] = ()


def understood(raw: RawTable, said: Mapping[str, ColumnMap], settings: Settings, accept: bool = False) -> Understood:
    """What of a file is settled, what is open, and what its numbers show.

    Parameters
    ----------
    raw : RawTable
    said : mapping of str to ColumnMap
        What a person said of columns, by their names in the file.
    settings : mapping of str to Setting
    accept : bool
        Take whole proposals as confirmed.
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
    shows = evidence(columns, frame)
    names = [read_column_map(o.text.partition(" [")[0]).name for _, o in still if o.text and not o.whole]
    asked = questions(raw, columns, settings, shows, names)
    if frame and (back := astern(columns, frame)):
        complaints += (_astern(raw, back, frame),)
    if "conditions.density" in settings:
        other = another_density(raw, columns, quantity(settings["conditions.density"].value, "density"))
        complaints += (other,) if other else ()
    doubts = [
        (one.column, one.said, e.text) for e in shows for one in columns
        if e.against and one.said.name == e.against and not set(said) & {one.column.name, *known_as(one.column)}
    ]  # fmt: skip
    return Understood(offers, mapping, tuple(still), columns, shows, asked, complaints, tuple(doubts))


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
    for column, said, why in found.doubts:
        ways = [argument("--map", column.name, str(replace(said, negative=turned))) for turned in (True, False)]
        out.append((" or ".join(ways), f"{why}. The first turns its sign, the second keeps it"))
    doubted = [column.name for column, _, _ in found.doubts]
    for column, offer in found.open:
        if column.name in doubted:
            continue
        text = offer.text.replace(OPEN, "UNIT" if "coefficient" not in offer.text else "SIZE") or "WHAT"
        out.append((argument("--map", column.name, text), offer.why))
    for q in found.questions:
        if not (q.certain or (accept and q.default)):
            out.append((argument("--set", q.key, q.default or q.place), q.why or q.asks))
    return tuple(out)


def saved_mapping(path: Path) -> tuple[dict[str, ColumnMap], dict[str, Setting], str, dict[str, Any]]:
    """Columns, settings, importer and its options of a mapping.toml that an import wrote, or of a campaign.toml.

    Raises
    ------
    InputError
        All that is wrong with it, by line and key.
    """
    file = read_toml(path)
    content = dict(file.content)
    columns: dict[str, ColumnMap] = {}
    settings: dict[str, Setting] = {}
    complaints: list[InputError] = []
    options = content.pop("importer", {})
    named = content.pop("columns", {})
    for name, text in named.items() if isinstance(named, dict) else ():
        try:
            columns[name] = read_column_map(text)
        except InputError as why:
            line = file.line(("columns", name))
            complaints.append(InputError(why.found, why.expected, file=path, line=line, key=f"columns.{name}"))
    importer = ""
    for section, inner in content.items():
        keys = inner[0] if isinstance(inner, list) and inner else inner
        for name, said in keys.items() if isinstance(keys, dict) else {section: keys}.items():
            key = f"{section}.{name}"
            if key == "campaign.importer":
                importer = str(said)
            elif key not in RESERVED and section != "campaign":
                try:
                    settings[key] = Setting(read_setting(key, said), f"from {path.name}")
                except InputError as why:
                    complaints.append(file.fail(key, why.found, why.expected, why.advice))
    if complaints:
        raise together(complaints)
    return columns, settings, importer, dict(options) if isinstance(options, dict) else {}


def _point(value: Any) -> str:
    return f"({', '.join(f'{x:g}' for x in value)})" if isinstance(value, tuple) else str(value)


def _median(columns: Sequence[Assigned], role: str) -> str:
    """Of the column of a role, in SI; empty where there is none."""
    values = next((c.values for c in columns if c.said.role == role), np.empty(0))
    usable = values[np.isfinite(values)]
    return f"{float(np.median(usable)):.12g}" if usable.size else ""


def assumed(out: Path) -> dict[str, Setting]:
    """Names without physics, by the folder that is written."""
    name = out.resolve().name or "campaign"
    return {
        "campaign.name": Setting(name, "the folder's"),
        "campaign.title": Setting(name, "for people; reports print it"),
        "campaign.body": Setting(name, "the configuration of body.toml that the table is about"),
    }

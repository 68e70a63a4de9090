"""What a file leaves open before it is a campaign: settings with what they probably are, and what that rests on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from coeflab.core.axes import ANGLE_SIGNS, ANYWHERE, parse_axes
from coeflab.core.provenance import TABLE_KINDS
from coeflab.core.text.bounded import own_text
from coeflab.core.text.toml import own_toml
from coeflab.core.wording import identifier
from coeflab.law.symbols import ANGULAR, MOMENTS
from coeflab.tables.campaign import CENTRES, PORT_STARBOARD, SYMMETRIES, UP_DOWN, cut_of
from coeflab.tables.column_map import ROLES
from coeflab.tables.evidence import Evidence, along_x, centre_of, evidence
from coeflab.tables.importers import IMPORTERS
from coeflab.tables.mapping import Assigned
from coeflab.tables.proposals import AREA, EITHER, LENGTH_OF, OPEN, UNITS_OF, Proposal
from coeflab.tables.raw_table import HALF_MODEL, RawTable, Stated
from coeflab.tables.settings import ARM_POINT, REFERENCE, SYMMETRY, Setting, Settings, frame_of, of_datum
from coeflab.tables.settings_in_files import arm_by_words, known_length, point_by_words, with_formula
from coeflab.tables.words.above import of_the_test
from coeflab.tables.words.points import CENTRE_FROM, POINT_FRAME, POINT_FROM, POINT_OF, UNSAID
from coeflab.tables.words.primes import BASIS, LEVER, SIZES, area_of, length_of

UNSAID_IN_WORDS = "; from where it does not say: taken aft of the nose"
PLACE_ASKED = (
    "x, or x, y, z, in m from a point of the body, x forward, y starboard, z down: -2.1 from nose is 2.1 m aft of it"
)
ONCE = "once its unit is said"
NO_POINT = "forces alone: no point matters"
ANY_SIGN = "zeros throughout: any sign is right"
SIGNS = ("axes.alpha", "axes.beta")
# By where x points: y to starboard, to port.
READINGS = {1: ("FRD", "FLU"), -1: ("CFD", ["aft", "port", "down"]), 0: ("FRD", "FLU")}


class Basis(Enum):
    """What the default of a question rests on."""

    ELSEWHERE = auto()  # words, a name, what numbers show
    COLUMN = auto()  # the median of a column
    CANCELS = auto()  # nothing: no number hangs on it
    ZEROS = auto()  # nothing: an angle of zeros has any sign
    UNSTATED = auto()  # nothing: a word for what nobody stated


@dataclass(frozen=True, slots=True)
class Question:
    """A key of campaign.toml, with what it probably is.

    Attributes
    ----------
    key : str
    asks : str
        The long explanation, with the choices.
    choices : str
        The choices in a few words, for one who has to say it.
    default : str
        What follows from the file or from evidence; empty where nothing does.
    why : str
        What the default rests on, whole; the campaign.toml says it too.
    short : str
        The same in a few words.
    shown : str
        What is shown in the place of the default, where it follows once another key is known.
    harmless : bool
        The file gives the default, or no number hangs on it: nobody has to accept it.
    grave : bool
        Axes, signs, points, inertia: a wrong one makes wrong slopes that look right.
    assumed : bool
        Neither words nor numbers of the file give the default: once accepted, what hangs on it says so.
    basis : Basis
        What the default rests on, as `why` has it in words.
    """

    key: str
    asks: str
    choices: str = ""
    default: str = ""
    why: str = ""
    short: str = ""
    shown: str = ""
    harmless: bool = False
    grave: bool = False
    assumed: bool = False
    basis: Basis = Basis.ELSEWHERE

    @property
    def open(self) -> bool:
        """Whether somebody has to say it."""
        return not (self.default or self.shown)


@cache
def _words() -> dict[str, dict[str, Any]]:
    return own_toml(own_text(files("coeflab.tables.words") / "questions.toml"))


def _asked(key: str, default: str = "", words: str = "", **facts: object) -> Question:
    """A question in the words of words/questions.toml, those of its key or others; facts stand in their braces."""
    own = _words()[words or key]
    worded: dict[str, Any] = {n: v.format_map(facts) if isinstance(v, str) else v for n, v in own.items()}
    return Question(key, default=default, **worded)


def names_in_order() -> Question:
    """The question for the names of all columns of a table that has none."""
    return _asked("names")


def questions(
    raw: RawTable, columns: Sequence[Assigned], settings: Settings, shows: Sequence[Evidence] = (),
    likely: Sequence[str] = (), offers: Sequence[Proposal] = (), primes: bool = False,
) -> tuple[Question, ...]:  # fmt: skip
    """Every key that makes the file a campaign, said or not.

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
    offers : sequence of Proposal
        Of the columns that nobody has confirmed.
    primes : bool
        Whether a force is a prime by its name alone, so that somebody has to confirm what it was divided by.
    """
    raw = replace(raw, stated=with_formula(raw.stated, settings))
    words = with_formula(of_the_test([("its name", raw.path.resolve().name.replace("_", " "))]), settings)
    out = [
        *_of_coefficients(raw, offers, settings, primes), *_of_axes(columns, settings, shows, likely), *_of_points(raw, settings, _holds_anywhere(columns, likely)),
        *_of_halves(raw, settings, shows), *_of_sizes(columns, settings, likely), *_of_rotation(raw, columns, settings, likely, words), *_of_source(raw),
    ]  # fmt: skip
    return tuple(_offered(q, raw, words) for q in out)


def without_unit(offer: Proposal) -> bool:
    """Whether a column states no unit, so that one for all such columns may give it; angles are asked one by one."""
    if offer.unread or not offer.text.endswith(f"[{OPEN}]"):
        return False
    return offer.meaning is not None and offer.meaning.dimension not in ("angle", "none")


def _of_coefficients(raw: RawTable, offers: Sequence[Proposal], settings: Settings, primes: bool) -> Iterator[Question]:
    """Sizes and units that several columns share."""
    texts = [one.text for one in offers]
    if any(f"A={OPEN}" in text for text in texts) or primes:
        yield _of_basis(raw, settings, primes)
    if any(f"L={OPEN}" in text for text in texts):
        yield _of_lever(raw, settings)
    if any(map(without_unit, offers)):
        both = sorted({one.either for one in offers if one.either})
        yield _asked(UNITS_OF, both="".join(f"{unit}: {EITHER}; " for unit in both))


def _of_lever(raw: RawTable, settings: Settings) -> Question:
    """The length of coefficients of moments: by words over the table, else that of the primes; a volume alone leaves it open."""
    lever, basis, known = raw.stated.get(LEVER), raw.stated.get(BASIS), settings.get("scaling.length")
    asked = replace(_asked(LENGTH_OF, "" if known is None else str(known.value)), basis=Basis.UNSTATED)
    words = lever or (basis if basis is not None and basis.value == "V^(2/3)" else None)
    if words is None:
        return asked
    short, length = f"{words.value}: {words.place}", None
    if words is lever and not words.contradicted:
        length = length_of(str(words.value), known_sizes(raw, settings)[0])
    if length is not None or (words.value == "L" and not words.contradicted):
        default = asked.default if length is None else f"{length:.12g} m"
        return replace(asked, default=default, why=words.place, short=short, assumed=False, basis=Basis.ELSEWHERE)
    choices = f"{words.place}: V^(1/3), L"
    if words.contradicted:
        choices = str(_words()["by_column"]["choices"]).format(words=words.contradicted)
    return replace(asked, default="", shown="", choices=choices, why="", short="", basis=Basis.ELSEWHERE)


def _of_basis(raw: RawTable, settings: Settings, primes: bool) -> Question:
    """What coefficients and primes were divided by: by words over the table, else by the names of primes; always to be confirmed."""
    asked = _asked(AREA)
    given = raw.stated.get(BASIS)
    sizes, places = known_sizes(raw, settings)
    if given is not None and not given.contradicted:
        basis = str(given.value)
        area = area_of(basis, sizes)
        if basis == "L L":
            return replace(asked, default="prime", why=given.place, short=given.place, grave=True)
        if area is not None:
            sources = dict.fromkeys([given.place, *(places[f] for f in basis.split() if f in places)])
            why = "; ".join(sources)
            return replace(asked, default=f"{area:.12g} m^2", why=why, short=f"{basis}: {why}", grave=True)
        if "L" in basis.split() and "L" not in sizes and area_of(basis, {**sizes, "L": 1.0}) is not None:
            later = f"{basis}, once L is said"
            return replace(asked, why=given.place, short=f"{basis}: {given.place}", shown=later, grave=True)
        return replace(asked, choices=f"{given.place}: {basis}, in m^2; {asked.choices}", grave=True)
    areas = [p for name, p in places.items() if name in ("wetted", "frontal", "lateral", "area")]
    if given is not None or (primes and areas):
        named = given.contradicted if given is not None else "; ".join(areas)
        return replace(asked, choices=f"{named}; {asked.choices}", grave=True)
    return replace(asked, **_words()["by_name"]) if primes else asked


def known_sizes(raw: RawTable, settings: Settings) -> tuple[dict[str, float], dict[str, str]]:
    """Sizes of the body by their letters, L T B D V, and areas by their names, m, m^3 and m^2; and what words say each."""
    sizes, places = dict[str, float](), dict[str, str]()
    for name, key in SIZES.items():
        if (one := raw.stated.get(key)) is not None and isinstance(one.value, float):
            sizes[name], places[name] = one.value, one.place
    if (length := known_length(raw, settings)) is not None:
        sizes["L"] = length
    if (area := raw.stated.get(AREA)) is not None and area.offered and isinstance(area.value, float):
        sizes["area"], places["area"] = area.value, area.place
    return sizes, places


def _of_axes(
    columns: Sequence[Assigned], settings: Settings, shows: Sequence[Evidence], likely: Sequence[str]
) -> Iterator[Question]:
    frame, (ahead, seen) = frame_of(settings), along_x(columns)
    pairs = {1: "FRD (y stb, z down) or FLU (y port, z up)", -1: "CFD (y stb, z up) or aft,port,down",
             0: "FRD, FLU, CFD or such as aft,port,down"}  # fmt: skip
    pair = pairs[ahead] + (f": {seen}" if seen else "")
    yield _asked("axes.frame", seen=seen and f". {seen}", pair=pair)
    angles = [c.meaning.name for c in columns if c.meaning.role == "angle"]
    follows = {e.key: e for e in shows if e.key}
    for name in dict.fromkeys((*angles, *(name for name in likely if ROLES[name] == "angle"))):
        side = {"beta": "v to starboard", "alpha": "w down"}[name]
        found = follows.get(f"axes.{name}")
        if any(c.meaning.name == name and not np.any(np.nan_to_num(c.values)) for c in columns):
            yield Question(
                f"axes.{name}",
                ANY_SIGN,
                "",
                next(iter(ANGLE_SIGNS[name])),
                ANY_SIGN,
                ANY_SIGN,
                harmless=True,
                basis=Basis.ZEROS,
            )
            continue
        both = [_signs(columns, name, reading) for reading in READINGS[ahead]] if frame is None else []
        shown, short = "", ""
        if not found and len(both) == 2 and all(both):
            one, two = (word[4] for word in both)
            sides = {"beta": ("starboard", "port"), "alpha": ("down", "up")}[name]
            shown = one if one == two else f"{one} if {'yz'[name == 'alpha']} is {sides[0]}, else {two}"
            shown = (
                shown if name == "beta" or one == two else f"{one} if z is {'down' if ahead >= 0 else 'up'}, else {two}"
            )
            short = f"assumed: {'Yv' if name == 'beta' else 'Zw'}' < 0"
        force = {"beta": "Y", "alpha": "Z"}[name]
        unclear = (
            frame is not None and not found and any(c.meaning.name == force and not c.meaning.error for c in columns)
        )
        why = f"; {force} over {name} shows no clear sign: too few rows, or a wrong reading" if unclear else ""
        asked = _asked(
            f"axes.{name}", words="sign", angle=name, formulas=" or ".join(ANGLE_SIGNS[name]), side=side, unclear=why
        )
        damps = f"assumed: {'Yv' if name == 'beta' else 'Zw'}' < 0"
        yield (
            replace(asked, default=found.value, why=found.text, short=damps)
            if found
            else replace(asked, short=short, shown=shown)
        )


def _signs(columns: Sequence[Assigned], angle: str, reading: Any) -> str:
    """The sign of an angle that follows in axes that nobody has declared."""
    return next((e.value for e in evidence(columns, parse_axes(reading)) if e.key == f"axes.{angle}"), "")


def _holds_anywhere(columns: Sequence[Assigned], likely: Sequence[str]) -> bool:
    """Whether the numbers are the same about every point: forces without moments, of a body that does not turn."""
    names = {*(c.meaning.component for c in columns), *(c.meaning.role for c in columns), *likely}
    return "force" in names and not names & {*MOMENTS, *ANGULAR, "R", "radius"}


def _of_points(raw: RawTable, settings: Settings, anywhere: bool) -> Iterator[Question]:
    at, frame, datum = raw.stated.get(POINT_OF), frame_of(settings), settings.get("axes.datum")
    if framed := raw.stated.get(POINT_FRAME):  # of the point alone: forces may count in another one
        frame = None if framed.contradicted else parse_axes(framed.value)
    own = at.value if at and isinstance(at.value, tuple) and len(at.value) == 3 else None
    asked = _asked(POINT_OF, place=PLACE_ASKED)
    asks, choices = asked.asks, asked.choices
    here, why, short, shown = "", "", "", ""
    text, point, x = point_by_words(raw, settings)
    words = raw.stated.get(POINT_FROM)
    by_words = words is not None and (datum is None or of_datum(str(datum.value), point))
    if words is not None and own is None:
        unsaid = UNSAID_IN_WORDS * words.value.endswith(UNSAID)  # type: ignore[union-attr]
        if words.contradicted or not by_words:
            choices = f"{words.contradicted or words.place}; {choices}"
        elif x is None:
            shown, short = text, f"{words.place}{unsaid}"
        else:
            here, why, short = f"{x:.12g}, 0, 0", f"{words.place}{unsaid}", f"{words.place}{unsaid}"
    elif own is not None and at is not None:
        why = f"the file's point {_point(own)} from the origin of its axes, {at.place}"
        asks += f". The file has {_point(own)} in its own axes from its own origin ({at.place})"
        short = f"of the file, {at.place}"
        shown = f"{_point(own)} in {framed.value if framed and frame else 'its axes'}"
        if frame is not None or not any(own):
            here = ", ".join(f"{x + 0.0:.12g}" for x in (frame.rotation @ np.array(own) if frame else np.array(own)))
    elif (given := raw.stated.get("axes.datum")) and (
        given.contradicted or (datum is not None and not of_datum(str(datum.value), str(given.value)))
    ):
        choices = f"{given.contradicted or given.place}; {choices}"
    elif datum is not None or given is not None:
        here, why, short = "0, 0, 0", "the datum itself", "the datum itself"
    elif anywhere and POINT_OF not in settings:
        for key, default in ((POINT_OF, "0, 0, 0"), ("axes.datum", ANYWHERE.id)):
            plain = _asked(key, default, place=PLACE_ASKED)
            yield replace(plain, choices="", why=ANYWHERE.note, short=NO_POINT, harmless=True, grave=False)
        return
    unsaid = why == "the datum itself" or why.endswith(UNSAID_IN_WORDS)
    yield replace(asked, asks=asks, choices=choices, default=here, why=why, short=short, shown=shown, assumed=unsaid)
    origin = _asked("axes.datum", f"origin_{identifier(raw.path.resolve().stem)}"[:40], "origin")
    if own is not None:
        yield origin
    elif by_words and words is not None and not words.contradicted:
        yield replace(origin, default=point, why=words.place, short=words.place)
    else:
        follows = "" if POINT_OF in settings else "as the point says"
        shorts = "nose, midship, cg ...", "-2.1 from nose: nose"
        yield replace(origin, default="", shown=follows, choices=shorts[0], why="", short=shorts[1])


def _of_halves(raw: RawTable, settings: Settings, shows: Sequence[Evidence]) -> Iterator[Question]:
    """Which half of the body a domain with a symmetry plane holds, and what a body that may be cut there is."""
    half = settings.get(HALF_MODEL)
    across = "; ".join(e.text for e in shows if e.key == HALF_MODEL)
    if HALF_MODEL in raw.stated or across or half is not None:
        yield _asked(HALF_MODEL, across=f"{across}{'; ' * bool(across)}")
    cut = cut_of(half.value) if half is not None else None
    if cut is not None and cut.symmetry == UP_DOWN:
        names = ", ".join(SYMMETRIES)
        yield _asked(SYMMETRY, UP_DOWN, plane=cut.plane, symmetries=names, up_down=UP_DOWN, sides=PORT_STARBOARD)


def _of_sizes(columns: Sequence[Assigned], settings: Settings, likely: Sequence[str]) -> Iterator[Question]:
    every = [c for c in columns if c.meaning.role == "force"]
    forces = [c.meaning for c in every if np.any(np.nan_to_num(c.values))] or [
        c.meaning for c in every
    ]  # zeros are zeros in any unit
    pure = bool(forces) and all(given.pure for given in forces)
    plain = not any(c.meaning.role == "velocity" and not c.meaning.primed for c in columns)
    length = next((given.length for given in forces if given.length), 0.0)
    far = _from_the_nose(settings)
    beyond = f"the reference point lies {far:g} m from the nose, further than the {length:g} m of the coefficients; "
    beyond, length = (beyond, 0.0) if 0.0 < length < far else ("", length)
    asked = _asked("scaling.length", f"{length!r}" if length else "", beyond=beyond)
    yield replace(asked, assumed=bool(length))
    yield replace(_asked("scaling.length_name", "L"), basis=Basis.UNSTATED)
    median = {role: _median(columns, role) for role in ("speed", "density")}
    u = next((c for c in columns if c.meaning.name == "u" and not c.meaning.primed), None)
    if u is not None and not median["speed"]:
        half = float(np.nanmedian(np.abs(u.values))) if np.any(u.values) else 0.0
        median["speed"] = f"{half:.12g}" if half else ""  # most rows of one velocity at a time stand still along x
    for role, cancels in (("density", "1000" if pure else ""), ("speed", "1" if pure and plain else "")):
        found = median[role]
        follows = not found and not cancels and {"speed": "U"}.get(role, role) in likely
        cancelled = "it cancels: forces and motions are pure numbers" if cancels else ""
        why = f"median of the column of {role}" if found else cancelled
        yield replace(
            _asked(f"conditions.{role}", found or cancels), why=why, short=why.partition(":")[0] or ONCE * follows,
            shown="median of its column" * follows, harmless=bool(found),
            basis=Basis.COLUMN if found else Basis.CANCELS if cancels else Basis.ELSEWHERE,
        )  # fmt: skip


def _from_the_nose(settings: Settings) -> float:
    """Distance of the reference point along x, m, where it is said from the nose; zero elsewhere."""
    datum, point = settings.get("axes.datum"), settings.get(POINT_OF)
    named = str(datum.value).casefold().split() if datum else []
    along = point.value[0] if point and isinstance(point.value, (list, tuple)) else 0.0
    return abs(float(along)) if {"nose", "bow", "bug", "nase"} & set(named) else 0.0


def _of_rotation(
    raw: RawTable, columns: Sequence[Assigned], settings: Settings, likely: Sequence[str], words: Mapping[str, Any]
) -> Iterator[Question]:
    rates = {c.meaning.name: np.nan_to_num(c.values) != 0.0 for c in columns if c.meaning.name in ANGULAR}
    known = settings[POINT_OF].value if POINT_OF in settings else None
    same = ", ".join(map(str, known)) if isinstance(known, list) else ""
    arm = "R" in likely or any(c.meaning.role == "radius" for c in columns)
    if arm:
        side, why, shown = centre_of(columns, frame_of(settings))
        asked = _asked("table.centre", side, centres=", ".join(CENTRES), why=why)
        yield replace(asked, short="so that Nr' < 0" if side or shown else "", shown=shown)
        at, later, line = arm_by_words(raw, settings) or (same, "the reference point", "")
        asked = _asked("table.arm_point", at, "radius", place=PLACE_ASKED, line=f"{line}; " * bool(line))
        rests = line or "the reference point, unless said"
        yield replace(asked, why=line or "the reference point", short=rests, shown=later, assumed=not line)
    elif {"q", "r"} & set(likely) or any(np.any(rates[m]) for m in ("q", "r") if m in rates):
        yield _where_still(raw, settings)
    inside: Setting | Stated | None = settings.get("table.contains_inertia")
    if arm or set(ANGULAR) & set(likely) or any(map(np.any, rates.values())):
        by_words = raw.stated.get("table.contains_inertia")
        computed = _is_computed(raw) or _kind(raw, settings, words) == "cfd"
        yield _asked("table.contains_inertia", "false" if computed else "")
        if inside is None and by_words is not None and not (computed or by_words.contradicted):
            inside = by_words
    if inside is not None and inside.value is True:
        yield _asked("inertia.mass")
        at, place = _centre_of_gravity(raw, settings)
        asked = _asked("inertia.centre_of_gravity", at, place=PLACE_ASKED)
        yield replace(
            asked, choices=f"{'' if at else place}; {asked.choices}".removeprefix("; "), why=place, short=place
        )
        # About one axis alone the moment of inertia holds nothing: omega x I omega = 0.
        angles = [c.meaning.name for c in columns if c.meaning.role == "angle"] + list(likely)
        if np.any(np.sum([*rates.values()], axis=0) > 1) or (arm and "alpha" in angles):
            yield _asked("inertia.inertia")


def _where_still(raw: RawTable, settings: Settings) -> Question:
    """The point that turning rows state no drift for, of a table with a rate: no number of it shows the point."""
    at, later, line = arm_by_words(raw, settings) or ("", "", "")
    asked = _asked(ARM_POINT, REFERENCE, place=PLACE_ASKED, line=f"{line}; " * bool(line))
    if at or later:
        return replace(asked, default=at, why=line, short=line, shown=later if not at else "")
    return replace(asked, assumed=True)


def _centre_of_gravity(raw: RawTable, settings: Settings) -> tuple[str, str]:
    """Its place as words give it from the datum, empty where they count it from another point; and the words."""
    given = raw.stated.get(CENTRE_FROM)
    if given is None:
        return "", ""
    x, _, point = str(given.value).partition(" ")
    datum = settings.get("axes.datum") or raw.stated.get("axes.datum")
    same = datum is not None and bool(point) and of_datum(str(datum.value), point)
    return (f"{x}, 0, 0" if same else "", given.place)


def _kind(raw: RawTable, settings: Settings, words: Mapping[str, Any]) -> str:
    """What the numbers are, as said or as words say it."""
    if "source.kind" in settings:
        return str(settings["source.kind"].value)
    if _is_computed(raw):
        return "cfd"
    given = raw.stated.get("source.kind") or words.get("source.kind")
    return str(given.value) if given else ""


def _is_computed(raw: RawTable) -> bool:
    """Whether an importer of a solver read the table."""
    name = raw.dialect.get("importer", "")
    return bool(name) and IMPORTERS.load(name).computed


def _of_source(raw: RawTable) -> Iterator[Question]:
    kind = "cfd" if _is_computed(raw) else "unstated"
    why = "files of a solver" if kind == "cfd" else "not stated"
    yield replace(
        _asked("source.kind", kind, kinds=", ".join(TABLE_KINDS)),
        why=why,
        short=why,
        basis=Basis.UNSTATED if kind == "unstated" else Basis.ELSEWHERE,
    )
    yield _asked("source.citation", raw.path.resolve().name)


def _offered(q: Question, raw: RawTable, words: Mapping[str, Any]) -> Question:
    """The question with what words over the table or its name say as its default, where no number gives one."""
    given = raw.stated.get(q.key) or words.get(q.key)
    if (q.key in (POINT_OF, "axes.datum") and POINT_FROM in raw.stated) or (
        given is not None and isinstance(given.value, tuple)
    ):
        return q
    if given is not None and given.contradicted and q.basis is not Basis.COLUMN:
        choices = f"{given.contradicted}; {q.choices}".rstrip("; ")
        return replace(
            q,
            default="",
            shown="",
            choices=choices,
            why=given.contradicted,
            asks=f"{q.asks}. {given.contradicted}",
            harmless=False,
            basis=Basis.ELSEWHERE,
        )
    if given is not None and q.key in (*SIGNS, "table.centre", "table.contains_inertia") and q.default:
        if str(given.value).casefold() in q.default.casefold():
            return replace(q, assumed=False, why=given.place, short=given.place)  # numbers and words agree
        against = f"{given.place}, but {q.default}: {q.why}"
        return replace(
            q, default="", shown="", choices=f"{against}; {q.choices}", asks=f"{q.asks}. {against}", why=against,
            basis=Basis.ELSEWHERE,
        )  # fmt: skip
    if (
        given is None
        or not given.offered
        or (
            q.default
            and not q.harmless
            and q.key not in ("axes.datum", "conditions.density", "conditions.speed", "scaling.length")
        )
    ):
        return q
    if q.harmless and q.default and q.basis is Basis.COLUMN:
        return q
    value = f"{given.value:.12g}" if isinstance(given.value, float) else str(given.value)
    value = value.casefold() if isinstance(given.value, bool) else value
    return replace(q, default=value, why=given.place, short=given.place, shown="", assumed=False, basis=Basis.ELSEWHERE)


def _point(value: Any) -> str:
    return f"({', '.join(f'{x:g}' for x in value)})" if isinstance(value, tuple) else str(value)


def _median(columns: Sequence[Assigned], role: str) -> str:
    """Of the column of a role, in SI; empty where there is none."""
    values = next((c.values for c in columns if c.meaning.role == role), np.empty(0))
    usable = values[np.isfinite(values)]
    return f"{float(np.median(usable)):.12g}" if usable.size else ""

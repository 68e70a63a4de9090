"""What the columns of an unknown file probably are, by their names and units. Proposals are confirmed by a person."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, replace
from itertools import permutations

import numpy as np

from coeflab.core.axes import Axes
from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.types import Array
from coeflab.core.units import SI, factor, quantity
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROL_COLUMNS, LINEAR, MOMENTS
from coeflab.tables.column_map import (
    ACROSS,
    EXAMPLES,
    FORCES,
    OPEN_SIZES,
    ROLES,
    SETTINGS,
    WIND,
    WORDS,
    ColumnMap,
    read_column_map,
    share,
)
from coeflab.tables.evidence import TURN
from coeflab.tables.mapping import MARKS, Assigned
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.vocabulary import folded, recorded, vocabulary
from coeflab.tables.words.axes import BODY_AXES
from coeflab.tables.words.primes import SCALE

OPEN = "?"
EITHER = "which of them the numbers are in"
US = {"force": "lbf", "moment": "lbf*ft", "speed": "ft/s", "length": "ft"}
UNKNOWN = "no known name"
BESIDE_WIND = "lift, drag and moments are there as coefficients already"
TURNED_WIND = "lift and drag turned by alpha, in every row"
PROPELLER = "a coefficient of the propeller, by its name beside J"
OF_PROPELLER = frozenset({"ct", "cp", "cq", "kt", "kq", "10kq"})
SIDEWAYS = frozenset({"beta", "v", "r", "R", "dr", "Y", "side"})  # without which a Cn need not be a yaw moment
PURE = ("", "-", "1")
FEW_STRANGE = 2  # columns without a known name or unit that are asked one by one
MOST_ASKED = 6  # of which more ask a person too much
SAME = 0.1
TURNED_APART = 0.02
GOES_ALONG = 0.9  # correlation with a setting: a coupled rudder, not a second measurement
VARIED = frozenset(SETTINGS) - {"speed"}  # which alone make no sweep
FROUDE = 1.5
REYNOLDS = frozenset({"re", "reynolds", "reynoldsnumber"})
MACH = 1.2  # of what may still be water or a slow wind tunnel
AREA, LENGTH_OF, UNITS_OF = "coefficients.area", "coefficients.length", "columns.units"
# Of a time a wrong split makes one, r_rads_s, so the name has to say it too.
_OF_TIME = re.compile(r"(?i)(?:^|[\W_])(?:t|wall|cpu)(?:[\W_]|$)|time|zeit|dauer|duration|temps|duree|durée|elapsed")
OWN = frozenset((*ROLES, *CONTROL_COLUMNS)) - {"label", "ignore", *WIND}  # names that coeflab's own tables have
ALLOWED = {
    "speed": "U, u, v, w", "rate": "p, q, r", "angle": "alpha, beta, dr, ds, db", "force": "X, Y, Z", "moment": "K, M, N",
    "length": "R", "density": "density",
}  # fmt: skip
TURNED = "{} the flow, turned to body axes by the alpha and beta of each row"
_PRIME = r"([XYZKMN])['\u2032\u2019]?"
_THOUSAND = re.compile(
    rf"{_PRIME}[\s_]*[x*×·]?[\s_]*(?:1000|1e3|10\^3|10³)|(?:1000|1e3|10\^3|10³)[\s_]*[x*×·]?[\s_]*{_PRIME}"
)
_BEHIND = re.compile(r"[(\[]([^()\[\]]*[A-Za-z][^()\[\]]*)[)\]]$")  # what may be a unit behind a name
_DECIMAL = re.compile(r"[-+]?\d[\d.,' ]*[.,]\d+(?:[eE][-+]?\d+)?")
_ERROR = re.compile(r"^(?:se|stderr|standarderror(?:of)?)(?=.)|(?<=.)(?:se|stderr|standarderror)$")


@dataclass(frozen=True, slots=True)
class Proposal:
    """What a column may be.

    Attributes
    ----------
    text : str
        As ``--map`` takes it, with ? for what has to be said; empty where nothing is known.
    why : str
        What it rests on.
    certain : bool
        The format itself fixes it, or the file uses coeflab's own names and a unit.
    note : str
        What a person should read beside it.
    unread : str
        The unit that the file writes, where it is none that the column can have.
    assumed : bool
        The unit is a guess.
    """

    text: str
    why: str
    certain: bool = False
    note: str = ""
    unread: str = ""
    assumed: bool = False

    @property
    def said(self) -> ColumnMap | None:
        """What it says, without a unit; None where nothing is known."""
        return read_column_map(self.text.partition(" [")[0]) if self.text else None

    @property
    def role(self) -> str:
        """Of what it says; empty where nothing is known."""
        return self.said.role if self.said else ""

    @property
    def whole(self) -> bool:
        """Whether nothing has to be added."""
        return bool(self.text) and OPEN not in self.text


def is_marks(column: RawColumn) -> bool:
    """Whether a column holds nothing but marks such as * and blanks, as tables mark doubtful rows."""
    cells = {cell.strip() for cell in column.texts} - {"", "-"}
    blank = any(cell.strip() in ("", "-") for cell in column.texts)
    return bool(cells) and blank and all(MARKS.fullmatch(cell) for cell in cells)


def proposed(column: RawColumn, stated: Mapping[str, object] | None = None) -> Proposal:
    """What a column may be, by what its format fixes, else by its name and unit.

    Parameters
    ----------
    column : RawColumn
    stated : mapping, optional
        What the file or a person says; ``coefficients.area`` and ``coefficients.length`` complete a coefficient, an area "prime"
        makes primes, ``columns.units`` "SI" is the unit of columns without one.
    """
    if not column.means and not column.is_text and len(column.values) and not np.any(np.isfinite(column.values)):
        return Proposal("ignore", "blank throughout")
    if not column.means and is_marks(column):
        return Proposal("uncertain", "marks of rows, which no fit then uses")
    unit = vocabulary().units.get(column.unit.casefold(), column.unit)
    if folded(column.name) in vocabulary().lists["ship"] and _fits(unit, "speed"):
        scale = (stated or {}).get(SCALE)
        if scale is None:
            return Proposal(
                "",
                f"a speed of the ship: U [{unit} ship 31.6] with the scale of its model, U [{unit}] if forces are of the ship",
            )
        return Proposal(
            f"U [{unit} ship {scale!r}]", f"of the ship, over the root of the scale {scale:g}: the speed of the model"
        )
    name, why, certain = _name(column)
    if not name and column.unit in ("", "-", "1") and (m := _THOUSAND.fullmatch(column.name.strip())):
        prime = m[1] or m[2]
        return Proposal(f"{prime}' [1e-3]", f"its name: 1000 {prime}', a prime by the campaign's length")
    if not name:
        if column.is_text:
            held = bool(_lost(column)) or bool(np.any(np.isfinite(column.values)))
            held = held and (_fits(column.unit, "force") or _fits(column.unit, "moment"))
            why = f"{_worded(column)}{allowed(column.unit, column.name.startswith('se_'))}"
            return Proposal("", why) if held else Proposal("label", "text")
        if why == UNKNOWN and (idle := _idle(column)):
            return Proposal("ignore", f"{why}; {idle}")
        return Proposal("", why + allowed(column.unit, column.name.startswith("se_")) * (why == UNKNOWN))
    given = read_column_map(name)
    if given.name in WORDS:
        return Proposal(name, why, certain)
    if given.name in FORCES and column.is_text and _lost(column):
        left = " leaves these cells out" * bool(np.any(np.isfinite(column.values)))
        return Proposal("", f"{_worded(column)}; {name} [{column.unit or OPEN}]{left}, or ignore")
    if column.is_text and not np.any(np.isfinite(column.values)):
        if given.name in FORCES and column.unit:
            return Proposal(
                "",
                f"its name and unit are of a force, and no cell is a number: {shown(column.texts[0])}; label, or ignore",
            )
        return Proposal("label", "text")
    said_of = stated or {}
    by = (said_of.get(AREA), said_of.get(LENGTH_OF, said_of.get("scaling.length")))
    one, system = _with_unit(column, given, why, certain, by), said_of.get(UNITS_OF)
    if one.text.endswith(f"[{OPEN}]") and not one.unread and system and given.dimension not in ("angle", "none"):
        either = _either(unit, given.dimension)
        units = {
            "SI": either[0] or SI[given.dimension],
            "US": either[1] or US.get(given.dimension, SI[given.dimension]),
        }
        return Proposal(
            f"{one.text.partition(' [')[0]} [{units[str(system)]}]",
            f"{why.partition(';')[0]}; in {system} units, as said",
        )
    return one


def _lost(column: RawColumn) -> list[str]:
    """Cells that are numbers with the other decimal mark, which the file's mark makes texts."""
    return [
        t for t, v in zip(column.texts, column.values, strict=True) if np.isnan(v) and _DECIMAL.fullmatch(t.strip())
    ]


def _worded(column: RawColumn) -> str:
    """Which cells of a column are no numbers."""
    words = _lost(column) or [t for t, v in zip(column.texts, column.values, strict=True) if np.isnan(v) and t.strip()]
    first = ", ".join(f'"{t.strip()}"' for t in words[:3]) + f" and {len(words) - 3} more" * (len(words) > 3)
    return f"{first} {'is no number' if len(words) == 1 else 'are no numbers'} by the file's decimal mark"


def _idle(column: RawColumn) -> str:
    """Why a column of numbers cannot matter to a fit: one number throughout, or a unit of nothing that fits use."""
    known = column.values[np.isfinite(column.values)]
    if known.size and not np.any(known):
        return "zeros throughout"
    if known.size and float(np.ptp(known)) <= 1e-9 * float(np.abs(known).max()) and not allowed(column.unit):
        return "one number throughout"
    unit = column.unit.strip().casefold()
    words = vocabulary().lists
    if folded(unit) in words["idle"] or (unit in words["times"] and _OF_TIME.search(column.name)):
        return f"no fit uses [{column.unit}]"
    return ""


def allowed(unit: str, error: bool = False) -> str:
    """What a column, or a standard error, may be by its unit alone, to follow a text; empty where the unit says nothing."""
    words = " ".join(unit.split())
    plain = vocabulary().units.get(words.casefold(), words)
    names = next((phrases for dimension, phrases in ALLOWED.items() if _fits(plain, dimension)), "")
    if error and names[:1] in COMPONENTS:
        names = ", ".join(f"se_{name}" for name in names.split(", "))
    return f"; {words}: {names}, or ignore" if names else ""


def _fits(unit: str, dimension: str) -> bool:
    try:
        return bool(unit) and factor(unit, dimension) > 0.0
    except UnitsError:
        return False


def _name(column: RawColumn) -> tuple[str, str, bool]:
    """Plain name, what it rests on, and whether it is certain; of ``Side Force Monitor: Fy`` by both parts."""
    found = _whole_name(column)
    if found[0] or found[1] != UNKNOWN:
        return found
    error = "se_" * column.name.startswith("se_")
    parts = [recorded(p) for p in column.name.removeprefix("se_").split(":")]
    named = {n: why for p in parts for n, why, _ in [_whole_name(replace(column, name=error + p))] if n}
    if len(named) == 1:
        return (*named.popitem(), False)
    if (
        not named
        and (wind := vocabulary().of_flow(column.name))
        and (_fits(column.unit, "force") or _either(column.unit, "force")[0])
    ):
        return f"{error}{wind}", f"a word of its name, {TURNED.format(ACROSS[wind])}", False
    return "", f"{' or '.join(named)} by its name" if named else UNKNOWN, False


def named_as(name: str) -> str:
    """What a column is by its name alone, ``beta`` of sideslip; empty where it has no known name."""
    return _whole_name(RawColumn(name, "", np.empty(0)))[0]


def _whole_name(column: RawColumn) -> tuple[str, str, bool]:
    """By the name as it stands."""
    if column.means:
        try:
            return str(read_column_map(column.means)), "its format says so", True
        except InputError:
            return "label", f"its format says that it is {column.means}, which no fit uses", True
    own = column.name.strip()
    short = own.replace("′", "'").replace("’", "'")
    plain = short.removeprefix("se_").removesuffix("'")
    bare = folded(own)
    if meanings := vocabulary().several.get(bare):
        return _by_unit(meanings.split(), column.unit)
    if plain in OWN and bare not in vocabulary().own:
        try:
            return str(read_column_map(short)), "its name", True
        except InputError:
            pass
    if own == "n" and column.unit.casefold() in vocabulary().turns:
        return "rps", "its name and unit", False
    if own == "T" and _fits(column.unit, "force"):
        return "thrust", "its name and unit", False
    bare = _OF_ALL.sub("", bare) if not _knows(bare) else bare
    error = None if bare in vocabulary().columns else _ERROR.search(bare)  # Achse, Bremse
    bare = _ERROR.sub("", bare) if error else bare
    prefix, prime = "se_" if error else "", ""
    if bare.endswith("prime") or short.endswith("'"):
        bare, prime = bare.removesuffix("prime"), "'"
    known = _knows(bare) or error or prime
    wind = vocabulary().flow.get(bare) or ("" if known else _in_other_words(own))
    if wind in WIND:
        also = "; Cl of aircraft is also the rolling moment, K" if bare == "cl" else ""
        return f"{prefix}{wind}{prime}", f"its name, {TURNED.format(ACROSS[wind])}{also}", False
    single = {c.casefold(): c for c in COMPONENTS} if prime or error else {}
    single |= {c: c for c in (*LINEAR, *ANGULAR)} if prime else {}
    words = vocabulary()
    pure = "" if prime else words.coefficients.get(bare, "")
    name = words.columns.get(bare) or _with_symbol(own) or single.get(bare) or pure or wind
    if not name:
        return "", UNKNOWN, False
    if error and name not in COMPONENTS:
        return "", UNKNOWN, False
    return f"{prefix}{name}{prime}", "its name", False


_OF_ALL = re.compile(
    r"^(?:mean|total|avg|average)(?=..)|(?<=..)(?:total|tot|mean|avg|average|net|gesamt|mittel|mittelwert)$"
)


def _knows(bare: str) -> bool:
    """Whether a folded name stands in the vocabulary as it is."""
    words = vocabulary()
    return any(bare in section for section in (words.columns, words.flow, words.coefficients))


def _in_other_words(name: str) -> str:
    """What a name is by its words in another order, or cut short: Angle of drift, drift ang, Lift coeff; empty where it is nothing."""
    words, parts = vocabulary(), _words(name)
    full = [w for part in parts if (w := words.short.get(part, part))]
    every = (
        ("".join(some) for some in permutations(full)) if len(full) <= 3 and (full != parts or len(full) > 1) else ()
    )
    found = next((n for w in every if (n := words.columns.get(w) or words.flow.get(w))), "")
    return found if found in FORCES or not {*parts} & words.lists["coefficient"] else ""


def _words(name: str) -> list[str]:
    return [folded(w) for w in re.findall(r"[^\W\d_]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name))]


def _is_pure(name: str) -> bool:
    """Whether a name is that of a coefficient."""
    bare, words = folded(name), {*_words(name)}
    pure = not {bare, _OF_ALL.sub("", bare), *words}.isdisjoint(vocabulary().coefficients)
    return pure or not words.isdisjoint(vocabulary().lists["coefficient"])


def _by_unit(meanings: list[str], unit: str) -> tuple[str, str, bool]:
    """Of several meanings the first that the unit fits; nothing where it fits none or there is none."""
    spelt = vocabulary().units.get(unit.casefold(), unit)
    fits = [m for m in meanings if m not in WORDS and _fits(spelt, read_column_map(m).dimension)]
    return (fits[0], "its name", False) if fits else ("", f"{' or '.join(meanings)} by its name", False)


def _with_symbol(own: str) -> str:
    """Of a name with its symbol behind it, ``Driftwinkel β``, where both say the same."""
    word, _, symbol = own.rpartition(" ")
    name = vocabulary().columns.get(folded(word), "")
    same = {*vocabulary().symbols.get(name, "").split(), name} - {""}
    return name if symbol.strip("()[], ") in same else ""


def _by_sizes(name: str, moment: bool, by: tuple[object, object]) -> str:
    """A coefficient by an area, and of a moment a length; ? for what nobody said."""
    sizes = zip(by, ("area", "length"), strict=True)
    area, length = (f"{quantity(x, d)!r} {SI[d]}" if x is not None else OPEN for x, d in sizes)
    return f"{name} [coefficient A={area}" + (f" L={length}]" if moment else "]")


def lacks_sizes(column: RawColumn, said: ColumnMap) -> bool:
    """Whether a force is called a coefficient, by its column's unit or in words, without area and length."""
    return said.unit == OPEN_SIZES or (said.role == "force" and not said.unit and column.unit.strip() in ("-", "1"))


def coefficient_as_said(said: ColumnMap, known: Mapping[str, object]) -> Proposal:
    """A column that a person called a coefficient, by the area and the length that all coefficients share, or as a prime."""
    area, length = known.get(AREA), known.get(LENGTH_OF, known.get("scaling.length"))
    name, why = f"{'-' * said.negative}{said.plain}", "as said"
    if area == "prime":
        return Proposal(f"{name}' [-]", why, certain=True)
    return Proposal(_by_sizes(name, said.name in MOMENTS, (area, length)), why, certain=True)


def _with_unit(column: RawColumn, said: ColumnMap, why: str, certain: bool, by: tuple[object, object]) -> Proposal:
    unit = " ".join(column.unit.split())
    if said.role == "propeller":
        unit = vocabulary().turns.get(unit.casefold(), unit) if said.name == "rps" else unit
        by_name = next((turns for turns in ("rpm", "rps") if turns in folded(column.name)), "")
        unit = unit or {"rps": by_name, "J": "-"}.get(said.name, "")
    name = str(said).partition(" [")[0]
    why += f"; {TURN}" * (said.name == "r")
    counted = share(unit) is not None
    if said.primed:
        return Proposal(f"{name} [{unit if counted else '-'}]", why, certain)
    unit = vocabulary().units.get(unit.casefold(), unit)
    moment = said.name in MOMENTS
    is_coefficient = said.name in FORCES and (
        unit in ("-", "1") or counted or (not unit and _is_pure(column.name) and not certain)
    )
    zeros = bool(column.values.size) and not np.any(np.nan_to_num(column.values))
    if is_coefficient and zeros and said.name not in ("lift", "drag"):  # without drag nothing turns lift
        return Proposal("ignore", f"{why}; zeros throughout")
    if is_coefficient and by[0] == "prime":
        return Proposal(f"{name}' [{unit if counted else '-'}]", f"{why}; a prime, as said")
    if is_coefficient:
        text = _by_sizes(name, moment, by)
        pure = f"counted in {unit}" if counted else "no unit"
        return Proposal(text, f"{why}, {pure}: by 1/2 rho U^2 A{' L' * moment}, or {name}' for primes", certain)
    try:
        whole = read_column_map(f"{name} [{unit}]") if unit else None
    except InputError:
        if column.name.strip().upper() in ("X", "Y", "Z") and _fits(unit, "length"):
            return Proposal("ignore", f"[{unit}] is a length: a position, no force")
        if any(_either(unit, said.dimension)):
            return Proposal(f"{name} [{OPEN}]", f"{why}; {unit}: {EITHER}")
        return _unread(name, said, column.unit, why)
    if whole is not None:
        by_both = why.replace("its name", "its name and unit", 1)
        return Proposal(str(whole), by_both, certain)
    if not unit and said.dimension != "angle" and (m := _BEHIND.search(column.name)):
        return _unread(name, said, m[1].strip(), why)
    if not np.any(np.nan_to_num(column.values)) and said.name not in ("U", "density", "R") and column.values.size:
        return Proposal(
            f"{name} [{'deg' if said.dimension == 'angle' else SI[said.dimension]}]", f"{why}; zeros throughout"
        )
    if said.dimension == "angle" and np.nanmax(np.abs(column.values), initial=0.0) > np.pi:
        return Proposal(f"{name} [deg]", f"{why}; beyond half a turn in radians")
    if said.dimension == "angle" and _whole_degrees(column.values):
        return Proposal(f"{name} [deg]", f"{why}; whole numbers", assumed=True)
    return Proposal(f"{name} [{OPEN}]", f"{why}; no unit is stated, such as {EXAMPLES[said.dimension]}")


def _either(unit: str, dimension: str) -> tuple[str, str]:
    """The SI and the US unit of a head that gives both, ``lb / N``, so that the numbers may be in either; empty elsewhere."""
    words = vocabulary().units
    pounds = {"lb": "lbf", "lbs": "lbf"} if dimension == "force" else {}
    parts = [words.get(p.casefold(), pounds.get(p.casefold(), p)) for p in map(str.strip, unit.split("/"))]
    if len(parts) != 2 or not all(_fits(p, dimension) for p in parts):
        return "", ""
    us = [bool({"lbf", "ft", "in"} & {*re.split(r"[^a-z]", p)}) for p in parts]
    return (parts[us.index(False)], parts[us.index(True)]) if us[0] != us[1] else ("", "")


def _unread(name: str, said: ColumnMap, unit: str, why: str) -> Proposal:
    """A column whose unit stands in the file and cannot be read: a person says it, and nothing else does."""
    example = EXAMPLES[said.dimension].replace("*", " ")
    wanted = f"its unit [{unit}] is none known of {said.dimension}: say such as {name} [{example}]"
    wanted += f" or {name} [k{example}]" * (example[0] == "N")
    return Proposal(f"{name} [{OPEN}]", f"{why}; {wanted}", unread=unit)


def taken_as(one: Assigned) -> str:
    """What a unit text that nobody knows was taken for; empty where the file's unit is known, or there is none."""
    unit, given = " ".join(one.column.unit.split()), one.said
    known = _fits(vocabulary().units.get(unit.casefold(), unit), given.dimension)
    known |= vocabulary().turns.get(unit.casefold()) == given.unit
    if known or unit in PURE or given.pure or given.per_speed or given.name in WORDS:
        return ""
    return f"{one.column.name}: the unit [{unit}] of the file is none known; taken as [{one.said.unit}], as said"


def _whole_degrees(values: Array) -> bool:
    """Whether angles are halves or wholes of something, one at least, as only degrees are."""
    known = values[np.isfinite(values)]
    return bool(known.size) and float(np.abs(known).max()) >= 1.0 and bool(np.all(known * 2.0 == np.round(known * 2.0)))


def proposals(
    raw: RawTable, known: Mapping[str, object] | None = None, frame: Axes | None = None
) -> tuple[Proposal, ...]:
    """What every column of a table may be; of several that may be the same, or name the rows, only the first keeps it.

    Parameters
    ----------
    raw : RawTable
    known : mapping, optional
        What a person says of coefficients and of units that are not stated; see `proposed`.
    frame : Axes, optional
        Of the file, where they are known.
    """
    stated = {key: None if s.contradicted else s.value for key, s in raw.stated.items()} | dict(known or {})
    offered = any(s.offered for key, s in raw.stated.items() if key.startswith("coefficients.")) or bool(known)
    out: list[Proposal] = []
    taken: dict[str, str] = {}
    turned = _turned_wind(raw.columns)
    pure = {folded(c.name) for c in raw.columns if c.unit in PURE} & {*vocabulary().coefficients, *vocabulary().several}
    names = {named_as(c.name).partition(" ")[0] for c in raw.columns} | {folded(c.name) for c in raw.columns} & REYNOLDS
    for column in raw.columns:
        if column.name in turned:
            one = Proposal("ignore", TURNED_WIND, note=TURNED_WIND)
        else:
            one = by_said_area(_of_company(proposed(column, stated), column, pure, names, frame, stated), known or {})
        one = replace(one, certain=False) if offered and "coefficient" in one.text else one
        one = _along_the_body(one, column, raw.stated[BODY_AXES].place) if BODY_AXES in raw.stated else one
        if one.why == UNKNOWN and column is raw.columns[0] and _is_index(column):
            one = Proposal("point", "it counts the rows")
        given = one.said
        if given is not None and given.name not in ("label", "ignore"):
            if given.name == "point" and (given.plain in taken or _repeats(column)):
                one = Proposal("label", f"{one.why}, but rows share it" if _repeats(column) else one.why, one.certain)
            elif given.plain in taken:
                first = next(i for i, c in enumerate(raw.columns) if c.name == taken[given.plain])
                again = f"{given.plain} is {{}} already"
                unsized = (
                    out[first].text.endswith(f"[{OPEN}]") and "coefficient" in one.text
                )  # a force without unit beside its coefficient
                if (one.whole and not out[first].whole) or unsized:
                    out[first] = Proposal("ignore", again.format(column.name))
                    taken[given.plain] = column.name
                else:
                    kinds = {"coefficient" in o.text for o in (one, out[first])}  # a force beside its coefficient
                    settled = (out[first].whole and not one.whole) or len(kinds) == 2
                    one = Proposal("ignore" * settled, again.format(taken[given.plain]))
            else:
                taken[given.plain] = column.name
        out.append(one)
    if "drag" in taken and not {"side", "lift"} & set(taken) and (body := next((c for c in "YZ" if c in taken), "")):
        out = [_beside_the_body(one, taken[body], body) for one in out]
    if len(doubles := [o for o in out if not o.text and o.why.endswith(" already")]) > FEW_STRANGE:
        out = [replace(o, text="ignore", note=o.why) if o in doubles else o for o in out]
    out = _without_strangers(raw, out)
    for i, column in enumerate(raw.columns):
        # V is the speed beside what says where the water comes from, and over a resistance; alone it may be a sway velocity in capitals.
        over = {"drag"} - {
            read_column_map(n).name for c in raw.columns if (n := named_as(c.name)) in ("Y", "N", "side")
        }
        beside = ({"alpha", "beta", "R"} | over) & set(taken) and not {"U", "v"} & set(taken)
        if beside and column.name.strip() == "V" and out[i].why.startswith(UNKNOWN) and _fits(column.unit, "speed"):
            out[i] = Proposal(f"U [{column.unit}]", "its unit, beside an angle or a radius")
            taken["U"] = column.name
        if folded(column.name) in vocabulary().lists["ship"] and taken.get("U", column.name) != column.name:
            out[i] = Proposal("ignore", f"U is {taken['U']} already")
        if column.name.strip() == "Q" and {"rps", "thrust"} & set(taken) and _fits(column.unit, "moment"):
            out[i] = Proposal("ignore", "the torque of the propeller, by its name beside its rate or thrust")
        if {"r", "R"} <= set(taken) and column.name == taken["R"]:
            out[i] = Proposal("ignore", f"r is {taken['r']} already, U over it")
    return tuple(_without_a_doubled_flow(raw, _without_lone_errors(out)))


def _is_index(column: RawColumn) -> bool:
    """Whether a column without a name, or called so, counts the rows from 0 or 1, again from there where tables were joined."""
    first = column.values[0] if len(column.values) > 1 else np.nan
    steps = np.diff(column.values)
    unnamed = column.name == "column 1" or folded(column.name) in vocabulary().lists["index"]
    return unnamed and first in (0.0, 1.0) and bool(np.all((steps == 1.0) | (column.values[1:] == first)))


def _without_lone_errors(out: Sequence[Proposal]) -> list[Proposal]:
    """A standard error whose force is left out goes with it."""
    valued = {m.name for one in out if (m := one.said) is not None and not m.error}
    lone = [(m := one.said) is not None and m.error and m.name not in valued for one in out]
    return [
        Proposal("ignore", f"no column {one.said.name}") if o and one.said else one
        for one, o in zip(out, lone, strict=True)
    ]


def _without_a_doubled_flow(raw: RawTable, out: Sequence[Proposal]) -> Iterator[Proposal]:
    """Of angles of the flow beside components of the speed those that are zeros throughout say nothing."""
    roles = [one.said for one in out]
    still = [not np.any(np.nan_to_num(c.values)) for c in raw.columns]
    both = [
        ("angle" if m.role == "angle" else "speed")
        if m and not m.error and (m.role == "angle" or m.name in LINEAR)
        else ""
        for m in roles
    ]
    varied = {kind for kind, zero in zip(both, still, strict=True) if kind and not zero}
    for one, kind, zero in zip(out, both, still, strict=True):
        yield (
            Proposal("ignore", f"{one.why}; zeros throughout")
            if kind and zero and varied and kind not in varied
            else one
        )


def _turned_wind(columns: Sequence[RawColumn]) -> frozenset[str]:
    """Names of the pure numbers that are lift and drag along the body, normal or axial, of either sign: no forces of their own."""
    own = {named_as(c.name): c for c in reversed(columns) if not c.is_text and not c.means}
    if not {"alpha", "lift", "drag"} <= {*own} or own["lift"].unit not in PURE:
        return frozenset()
    alpha, lift, drag = (own[name].values for name in ("alpha", "lift", "drag"))
    if not np.any(np.nan_to_num(alpha)):
        return frozenset()
    angle = alpha if own["alpha"].unit == "rad" else np.radians(alpha)
    normal, axial = lift * np.cos(angle) + drag * np.sin(angle), drag * np.cos(angle) - lift * np.sin(angle)
    used = {own[name].name for name in ("alpha", "lift", "drag")}
    others = [c for c in columns if c.unit in PURE and not c.is_text and c.name not in used]
    return frozenset(c.name for c in others for force in (normal, axial) if _agree(np.abs(c.values), np.abs(force)))


def _agree(one: Array, other: Array) -> bool:
    """Whether two columns agree in every row where both are known, within `TURNED_APART` of the largest."""
    both = np.isfinite(one) & np.isfinite(other)
    largest = float(np.max(one[both], initial=0.0))
    return bool(both.sum() > FEW_STRANGE) and float(np.max(np.abs(one - other)[both])) < TURNED_APART * largest


def _of_company(
    one: Proposal, column: RawColumn, pure: Set[str], names: Set[str], frame: Axes | None, stated: Mapping[str, object]
) -> Proposal:
    """A column that the coefficients beside it make another thing than its name: M a Mach number, N a count, CN a normal force.

    Parameters
    ----------
    one : Proposal
    column : RawColumn
    pure : set of str
        Folded names of the coefficients of the table.
    names : set of str
        What all columns are by their names.
    frame : Axes or None
        Of the file, where they are known.
    stated : mapping
        As for `proposed`.
    """
    known, bare = column.values[np.isfinite(column.values)], folded(column.name)
    if (
        "J" in names
        and bare in OF_PROPELLER
        and column.unit in PURE
        and not {"alpha", "beta", "lift", "cd"} & (names | pure)
    ):
        return Proposal("ignore", PROPELLER)
    if "cd" in pure and column.unit in PURE and column.name.strip() in ("M", "N") and known.size:
        is_mach = one.text[0] == "M" and known.min() > 0.0 and (known.max() < MACH or REYNOLDS & names)
        if is_mach or (one.text[0] == "N" and known.min() >= 1.0 and np.all(known == np.round(known))):
            what = "a Mach number" if is_mach else "a count"
            note = f"{what} by its values beside coefficients; {one.text[0]} [{OPEN}] if it is the moment"
            return Proposal("ignore", note, note=note)
    froude = bare in ("fn", "fr") and column.unit in PURE
    if froude and known.size and 0.0 < known.min() <= known.max() < FROUDE:
        note = f"a Froude number by its values; Z [{OPEN}] if it is a force"
        return Proposal("ignore", note, note=note * (bare == "fn"))
    own = {vocabulary().coefficients.get(name) for name in pure}
    name = one.said.name if one.said else ""
    place = column.name.strip() in ("Y", "y") and column.unit in PURE and not {"beta", "v", "r"} & names
    twice = (
        name in ("X", "Z") or place or (name in own - {"lift", "drag"} and one.whole and "coefficient" not in one.text)
    )
    if {"lift", "drag"} <= own and name in FORCES and twice and not column.means:
        return Proposal("ignore", BESIDE_WIND, note=BESIDE_WIND)
    of_body = {"ca", "ct", "cn"} & pure if "cn" in pure else set()
    if len(of_body) > 1 and bare in of_body and {"cl", "cd"} <= pure:
        return Proposal("ignore", BESIDE_WIND, note=BESIDE_WIND)
    if bare == "cn" and column.unit in PURE and "alpha" in names and not SIDEWAYS & names and not {"cll", "ca"} & pure:
        return Proposal("", "N or -Z by its name: no column is of a motion sideways, so it may be the normal force")
    if bare == "ct" and {"cn", "ct"} == of_body and "alpha" in names:
        return Proposal("", "X or -X by its name beside Cn: positive forward or aft")
    if {"ca", "cn"} <= pure and bare in ("ca", "cn"):
        axial = bare == "ca"
        body, beside, way = ("X", "CN", "aft") if axial else ("Z", "CA", "up")
        along = 0.0 if frame is None else float(frame.rotation[0, 0] if axial else frame.rotation[2, 2])
        if not along:
            return Proposal("", f"its name beside {beside}: positive {way}, whatever the axes")
        # x forward and z down are +1: an axial force is positive aft, a normal force positive up.
        plain = proposed(replace(column, name=f"C{body.casefold()}"), stated)
        return replace(
            plain, text=f"{'-' * (along > 0.0)}{plain.text}", why=f"its name beside {beside}: positive {way}"
        )
    return one


def _without_strangers(raw: RawTable, out: list[Proposal]) -> list[Proposal]:
    """Of many columns that neither name nor unit says anything of, those that cannot be a setting are of no use.

    Nothing is left out where no force or no setting is known without them.
    """
    strange = [i for i, one in enumerate(out) if one.why == UNKNOWN and raw.columns[i].name.strip() != "V"]
    roles, many = {one.role for one in out}, len(strange) > MOST_ASKED
    if len(strange) <= FEW_STRANGE or "force" not in roles or roles.isdisjoint(VARIED | {"speed"} if many else VARIED):
        return out
    settings = [c.values for c, one in zip(raw.columns, out, strict=True) if one.role in VARIED]
    plain = {c.name.strip() for c in raw.columns}
    series = Counter(_counted(raw.columns[i].name) for i in strange)
    idle = {
        i
        for i in strange
        if _is_of_a_force(raw.columns[i].name, plain)
        or series[_counted(raw.columns[i].name)] > FEW_STRANGE
        or not _like_a_setting(raw.columns[i].values, settings)
    }
    if roles.isdisjoint(VARIED) and len({*strange} - idle) > FEW_STRANGE:
        idle = {*strange}
    return [
        replace(one, text="ignore", why=f"{UNKNOWN}, one of {len(strange)} such") if i in idle else one
        for i, one in enumerate(out)
    ]


def _counted(name: str) -> str:
    """A name of a series without its number: Cp_ of Cp_017; of others the name itself."""
    return re.sub(r"(?<=[A-Za-z_ ])[\d.]+$", "", name.strip())


def _is_of_a_force(name: str, names: Set[str]) -> bool:
    """Whether a name is that of a force of the table with a letter or words behind it: Cza beside Cz, Fx_visc beside Fx, Ma beside M,
    Cl_fine beside Cl_exp.
    """
    own = re.split(r"(?<=[a-z0-9])(?=[A-Z_ ])|[_ ]", name.strip())[0]
    forces = {base: named_as(base) for base in names if base != name.strip()}
    bases = {base for base, force in forces.items() if force in FORCES}
    beside = any(base.startswith(f"{own}_") and forces[base] == named_as(own) for base in bases)
    return beside or not bases.isdisjoint({own, own[:-1]})


def _like_a_setting(values: Array, settings: Sequence[Array]) -> bool:
    """Whether a column takes few levels again and again, or goes along with a setting: left out, it would bend a slope unseen."""
    levels = np.unique(values[np.isfinite(values)]).size
    if 1 < levels <= values.size / 2:
        return True
    return levels > 1 and any(_together(values, s) > GOES_ALONG and not _same(values, s) for s in settings)


def _same(one: Array, other: Array) -> bool:
    """Whether two columns have the same numbers, a raw and a corrected angle: within `SAME` of the largest."""
    both = np.isfinite(one) & np.isfinite(other)
    largest = float(np.max(np.abs(other[both]), initial=0.0))
    return bool(both.any()) and float(np.median(np.abs(one - other)[both])) < SAME * largest


def _together(one: Array, other: Array) -> float:
    """Size of the correlation of two columns where both are known."""
    both = np.isfinite(one) & np.isfinite(other)
    if both.sum() < 3 or not np.ptp(one[both]) or not np.ptp(other[both]):
        return 0.0
    return float(abs(np.corrcoef(one[both], other[both])[0, 1]))


def by_said_area(one: Proposal, known: Mapping[str, object]) -> Proposal:
    """A prime as a coefficient of the area that a person, or words that were accepted, say it was divided by."""
    area = known.get(AREA)
    if area is None or area == "prime":
        return one
    given = one.said
    if given is None or given.name not in FORCES or not given.primed:
        return one
    length = known.get(LENGTH_OF, known.get("scaling.length"))
    moment = given.name in MOMENTS
    sizes = f"A={quantity(area, 'area')!r} m^2" + (
        f" L={OPEN if length is None else repr(quantity(length, 'length'))} m" if moment else ""
    )
    counted = re.search(r"\[([^\]]*)\]", one.text)
    if counted and share(counted[1]) is not None:  # a coefficient has no power of ten of its own
        return one
    text = f"{str(given).partition(' [')[0].rstrip(chr(39))} [coefficient {sizes.replace(f'L={OPEN} m', f'L={OPEN}')}]"
    return replace(one, text=text, why=f"{one.why}, by 1/2 rho U^2 A{' L' * moment}, as said")


def _beside_the_body(one: Proposal, other: str, body: str) -> Proposal:
    """A drag with the other reading that a force of the body beside it makes as likely: X differs by Y sin(beta)."""
    if not re.match(r"drag\b", one.text) or one.certain or one.note:
        return one
    x = one.text.replace("drag", "X", 1)
    note = f"along the flow, by its name; but {other} is {body} of the body. If this is along the body too: -{x} where x points forward, {x} where aft"
    return replace(one, why=f"{one.why}; {note}", note=note)


def _along_the_body(one: Proposal, column: RawColumn, place: str) -> Proposal:
    """A resistance as X of the body, reversed where it is above zero, for words over the table say body axes."""
    if not one.text.removeprefix("se_").startswith("drag") or "coefficient" in one.text or one.certain:
        return one
    known = column.values[np.isfinite(column.values)]
    positive = bool(known.size) and float(np.median(known)) > 0.0
    error = one.text.startswith("se_")
    text = one.text.replace("drag", "-X" if positive and not error else "X", 1)
    note = f"X of the body{', reversed' if positive and not error else ''}: {place}; {one.text} if it is along the flow"
    return Proposal(text, f"{one.why.partition(', along the flow')[0]}, {note}", note=note)


def _repeats(column: RawColumn) -> bool:
    cells = column.texts or tuple(column.values.tolist())
    return len(set(cells)) < len(cells)

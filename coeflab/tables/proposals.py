"""What the columns of an unknown file probably are, by their names and units. Proposals are confirmed by a person."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.types import Array
from coeflab.core.units import SI, fits, quantity
from coeflab.law.symbols import COMPONENTS, MOMENTS
from coeflab.tables.column_map import (
    EXAMPLES,
    FORCES,
    OPEN_SIZES,
    WORDS,
    ColumnMap,
    counted_in,
    read_column_map,
    share,
)
from coeflab.tables.column_names import UNKNOWN, either_unit, is_pure, name_of, named_as
from coeflab.tables.evidence import TURN
from coeflab.tables.mapping import MARKS, Assigned
from coeflab.tables.raw_table import RawColumn
from coeflab.tables.vocabulary import folded, vocabulary
from coeflab.tables.words.primes import SCALE

OPEN = "?"
SCALED = "its name holds a factor that may go either way"
EITHER = "which of them the numbers are in"
US = {"force": "lbf", "moment": "lbf*ft", "speed": "ft/s", "length": "ft"}
PURE = ("", "-", "1")
AREA, LENGTH_OF, UNITS_OF = "coefficients.area", "coefficients.length", "columns.units"
# Of a time a wrong split makes one, r_rads_s, so the name has to say it too.
_OF_TIME = re.compile(r"(?i)(?:^|[\W_])(?:t|wall|cpu)(?:[\W_]|$)|time|zeit|dauer|duration|temps|duree|durée|elapsed")
ALLOWED = {
    "speed": "U, u, v, w", "rate": "p, q, r", "angle": "alpha, beta, dr, ds, db", "force": "X, Y, Z", "moment": "K, M, N",
    "length": "R", "density": "density",
}  # fmt: skip
_BEHIND = re.compile(r"[(\[]([^()\[\]]*[A-Za-z][^()\[\]]*)[)\]]$")  # what may be a unit behind a name
_DECIMAL = re.compile(r"[-+]?\d[\d.,' ]*[.,]\d+(?:[eE][-+]?\d+)?")


class Reason(Enum):
    """Why a column is left open or out, where what follows hangs on it."""

    UNKNOWN = "unknown"  # no known name
    NO_NUMBERS = "no numbers"
    REPEATED = "repeated"  # another column is the same
    PROPELLER = "propeller"
    HALF = "half"  # of half of the body


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
    reason : Reason or None
    either : str
        The unit that the file writes, where it is of two systems.
    """

    text: str
    why: str
    certain: bool = False
    note: str = ""
    unread: str = ""
    assumed: bool = False
    reason: Reason | None = None
    either: str = ""

    @property
    def meaning(self) -> ColumnMap | None:
        """What it says, without a unit; None where nothing is known."""
        return read_column_map(self.text.partition(" [")[0]) if self.text else None

    @property
    def role(self) -> str:
        """Of what it says; empty where nothing is known."""
        return self.meaning.role if self.meaning else ""

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
    if folded(column.name) in vocabulary().lists["ship"] and fits(unit, "speed"):
        scale = (stated or {}).get(SCALE)
        if scale is None:
            return Proposal(
                "",
                f"a speed of the ship: U [{unit} ship 31.6] with the scale of its model, U [{unit}] if forces are of the ship",
            )
        return Proposal(
            f"U [{unit} ship {scale!r}]", f"of the ship, over the root of the scale {scale:g}: the speed of the model"
        )
    own = column.name.strip()
    bare, counted = counted_in(column.name, column.unit)
    bare += "'" * (bare in COMPONENTS)
    symbol = named_as(bare) if counted and not column.means else ""
    if symbol and read_column_map(symbol).role in ("force", "error", "velocity"):
        if counted == OPEN:
            prime = symbol.partition(" ")[0].rstrip("'") + "'"
            return Proposal("", f"{SCALED}: {prime} [1e-3] or [1e3] if it is a prime; else rename the column")
        column = replace(column, name=bare, unit=counted)
    name, why, certain = name_of(column)
    certain = certain and (not counted or bare == own)  # a factor in a name is confirmed
    if not name:
        if column.is_text:
            held = bool(_other_decimal_cells(column)) or bool(np.any(np.isfinite(column.values)))
            held = held and (fits(column.unit, "force") or fits(column.unit, "moment"))
            why = f"{_worded(column)}{allowed(column.unit, column.name.startswith('se_'))}"
            return Proposal("", why, reason=Reason.NO_NUMBERS) if held else Proposal("label", "text")
        if why != UNKNOWN:
            return Proposal("", why)
        if idle := _idle(column):
            return Proposal("ignore", f"{why}; {idle}", reason=Reason.UNKNOWN)
        return Proposal("", why + allowed(column.unit, column.name.startswith("se_")), reason=Reason.UNKNOWN)
    given = read_column_map(name)
    if given.name in WORDS:
        return Proposal(name, why, certain)
    if given.name in FORCES and column.is_text and _other_decimal_cells(column):
        left = " leaves these cells out" * bool(np.any(np.isfinite(column.values)))
        return Proposal("", f"{_worded(column)}; {name} [{column.unit or OPEN}]{left}, or ignore")
    if column.is_text and not np.any(np.isfinite(column.values)):
        if given.name in FORCES and column.unit:
            return Proposal(
                "",
                f"its name and unit are of a force, and no cell is a number: {shown(column.texts[0])}; label, or ignore",
            )
        return Proposal("label", "text")
    known_meanings = stated or {}
    by = (known_meanings.get(AREA), known_meanings.get(LENGTH_OF))
    one, system = _with_unit(column, given, why, certain, by), known_meanings.get(UNITS_OF)
    if one.text.endswith(f"[{OPEN}]") and not one.unread and system and given.dimension not in ("angle", "none"):
        either = either_unit(unit, given.dimension)
        units = {
            "SI": either[0] or SI[given.dimension],
            "US": either[1] or US.get(given.dimension, SI[given.dimension]),
        }
        return Proposal(
            f"{one.text.partition(' [')[0]} [{units[str(system)]}]",
            f"{why.partition(';')[0]}; in {system} units, as said",
        )
    return one


def _other_decimal_cells(column: RawColumn) -> list[str]:
    """Cells that are numbers with the other decimal mark, which the file's mark makes texts."""
    return [
        t for t, v in zip(column.texts, column.values, strict=True) if np.isnan(v) and _DECIMAL.fullmatch(t.strip())
    ]


def _worded(column: RawColumn) -> str:
    """Which cells of a column are no numbers."""
    words = _other_decimal_cells(column) or [
        t for t, v in zip(column.texts, column.values, strict=True) if np.isnan(v) and t.strip()
    ]
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


def _by_unit(unit: str) -> str:
    """What a column may be by its unit alone; empty where the unit says nothing."""
    words = " ".join(unit.split())
    plain = vocabulary().units.get(words.casefold(), words)
    return next((names for dimension, names in ALLOWED.items() if fits(plain, dimension)), "")


def may_be_force(one: Proposal, column: RawColumn) -> bool:
    """Whether an open column without a known name, or without numbers, is a force or a moment by its unit."""
    is_open = one.reason in (Reason.UNKNOWN, Reason.NO_NUMBERS) and not one.text
    return is_open and not column.name.startswith("se_") and _by_unit(column.unit)[:1] in COMPONENTS


def allowed(unit: str, error: bool = False) -> str:
    """What a column, or a standard error, may be by its unit alone, to follow a text; empty where the unit says nothing."""
    words, names = " ".join(unit.split()), _by_unit(unit)
    if error and names[:1] in COMPONENTS:
        names = ", ".join(f"se_{name}" for name in names.split(", "))
    return f"; {words}: {names}, or ignore" if names else ""


def _by_sizes(name: str, moment: bool, by: tuple[object, object]) -> str:
    """A coefficient by an area, and of a moment a length; ? for what nobody said."""
    sizes = zip(by, ("area", "length"), strict=True)
    area, length = (f"{quantity(x, d)!r} {SI[d]}" if x is not None else OPEN for x, d in sizes)
    return f"{name} [coefficient A={area}" + (f" L={length}]" if moment else "]")


def lacks_sizes(column: RawColumn, meaning: ColumnMap) -> bool:
    """Whether a force is called a coefficient, by its column's unit or in words, without area and length."""
    return meaning.unit == OPEN_SIZES or (
        meaning.role == "force" and not meaning.unit and column.unit.strip() in ("-", "1")
    )


def coefficient_by_sizes(meaning: ColumnMap, known: Mapping[str, object]) -> Proposal:
    """A column that a person called a coefficient, by the area and the length that all coefficients share, or as a prime."""
    area, length = known.get(AREA), known.get(LENGTH_OF)
    name, why = f"{'-' * meaning.negative}{meaning.plain}", "as said"
    if area == "prime":
        return Proposal(f"{name}' [-]", why, certain=True)
    return Proposal(_by_sizes(name, meaning.name in MOMENTS, (area, length)), why, certain=True)


def _with_unit(column: RawColumn, meaning: ColumnMap, why: str, certain: bool, by: tuple[object, object]) -> Proposal:
    unit = " ".join(column.unit.split())
    if meaning.role == "propeller":
        unit = vocabulary().turns.get(unit.casefold(), unit) if meaning.name == "rps" else unit
        by_name = next((turns for turns in ("rpm", "rps") if turns in folded(column.name)), "")
        unit = unit or {"rps": by_name, "J": "-"}.get(meaning.name, "")
    name = str(meaning).partition(" [")[0]
    why += f"; {TURN}" * (meaning.name == "r")
    counted = share(unit) is not None
    if meaning.primed:
        return Proposal(f"{name} [{unit if counted else '-'}]", why, certain)
    unit = vocabulary().units.get(unit.casefold(), unit)
    moment = meaning.name in MOMENTS
    is_coefficient = meaning.name in FORCES and (
        unit in ("-", "1") or counted or (not unit and is_pure(column.name) and not certain)
    )
    zeros = bool(column.values.size) and not np.any(np.nan_to_num(column.values))
    if is_coefficient and zeros and meaning.name not in ("lift", "drag"):  # without drag nothing turns lift
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
        if column.name.strip().upper() in ("X", "Y", "Z") and fits(unit, "length"):
            return Proposal("ignore", f"[{unit}] is a length: a position, no force")
        if any(either_unit(unit, meaning.dimension)):
            return Proposal(f"{name} [{OPEN}]", f"{why}; {unit}: {EITHER}", either=unit)
        return _unread(name, meaning, column.unit, why)
    if whole is not None:
        by_both = why.replace("its name", "its name and unit", 1)
        return Proposal(str(whole), by_both, certain)
    if not unit and meaning.dimension != "angle" and (m := _BEHIND.search(column.name)):
        return _unread(name, meaning, m[1].strip(), why)
    if not np.any(np.nan_to_num(column.values)) and meaning.name not in ("U", "density", "R") and column.values.size:
        return Proposal(
            f"{name} [{'deg' if meaning.dimension == 'angle' else SI[meaning.dimension]}]", f"{why}; zeros throughout"
        )
    if meaning.dimension == "angle" and np.nanmax(np.abs(column.values), initial=0.0) > np.pi:
        return Proposal(f"{name} [deg]", f"{why}; beyond half a turn in radians")
    if meaning.dimension == "angle" and _whole_degrees(column.values):
        return Proposal(f"{name} [deg]", f"{why}; whole numbers", assumed=True)
    return Proposal(f"{name} [{OPEN}]", f"{why}; no unit is stated, such as {EXAMPLES[meaning.dimension]}")


def _unread(name: str, meaning: ColumnMap, unit: str, why: str) -> Proposal:
    """A column whose unit stands in the file and cannot be read: a person says it, and nothing else does."""
    example = EXAMPLES[meaning.dimension].replace("*", " ")
    wanted = f"its unit [{unit}] is none known of {meaning.dimension}: say such as {name} [{example}]"
    wanted += f" or {name} [k{example}]" * (example[0] == "N")
    return Proposal(f"{name} [{OPEN}]", f"{why}; {wanted}", unread=unit)


def taken_as(one: Assigned) -> str:
    """What a unit text that nobody knows was taken for; empty where the file's unit is known, or there is none."""
    unit, given = " ".join(one.column.unit.split()), one.meaning
    known = fits(vocabulary().units.get(unit.casefold(), unit), given.dimension)
    known |= vocabulary().turns.get(unit.casefold()) == given.unit
    if known or unit in PURE or given.pure or given.per_speed or given.name in WORDS:
        return ""
    return f"{one.column.name}: the unit [{unit}] of the file is none known; taken as [{one.meaning.unit}], as said"


def _whole_degrees(values: Array) -> bool:
    """Whether angles are halves or wholes of something, one at least, as only degrees are."""
    known = values[np.isfinite(values)]
    return bool(known.size) and float(np.abs(known).max()) >= 1.0 and bool(np.all(known * 2.0 == np.round(known * 2.0)))

"""What a column is by its name, in any order of its words, with what it rests on."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import permutations

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.units import fits
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROL_COLUMNS, LINEAR
from coeflab.tables.column_map import ACROSS, FORCES, ROLES, WIND, WORDS, counted_in, read_column_map
from coeflab.tables.raw_table import RawColumn
from coeflab.tables.vocabulary import folded, recorded, vocabulary

UNKNOWN = "no known name"
TURNED = "{} the flow, turned to body axes by the alpha and beta of each row"
OWN = frozenset((*ROLES, *CONTROL_COLUMNS)) - {"label", "ignore", *WIND}  # names that coeflab's own tables have
_ERROR = re.compile(r"^(?:se|stderr|standarderror(?:of)?)(?=.)|(?<=.)(?:se|stderr|standarderror)$")


def name_of(column: RawColumn) -> tuple[str, str, bool]:
    """Plain name, what it rests on, and whether it is certain; of ``Side Force Monitor: Fy`` by both parts."""
    found = _whole_name(column)
    if found[0] or found[1] != UNKNOWN:
        return found
    error = "se_" * column.name.startswith("se_")
    parts = [recorded(p) for p in column.name.removeprefix("se_").split(":")]
    named = {n: why for p in parts for n, why, _ in [_whole_name(replace(column, name=error + p))] if n}
    if len(named) == 1:
        return (*named.popitem(), False)
    wind = vocabulary().of_flow(column.name)
    if not named and wind and (fits(column.unit, "force") or either_unit(column.unit, "force")[0]):
        return f"{error}{wind}", f"a word of its name, {TURNED.format(ACROSS[wind])}", False
    return "", f"{' or '.join(named)} by its name" if named else UNKNOWN, False


def named_as(name: str) -> str:
    """What a column is by its name alone, ``beta`` of sideslip; empty where it has no known name."""
    return _whole_name(RawColumn(counted_in(name)[0], "", np.empty(0)))[0]


def _whole_name(column: RawColumn) -> tuple[str, str, bool]:
    """By the name as it stands."""
    if column.means:
        try:
            return str(read_column_map(column.means)), "its format says so", True
        except InputError:
            return "label", f"its format says that it is {column.means}, which no fit uses", True
    own = _without_symbol(column.name.strip())
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
    if own == "T" and fits(column.unit, "force"):
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


_IN_SYMBOLS = re.compile(r"\b[A-Za-z]['′’](?![A-Za-z])|100")  # M' and a factor are no words
_SYMBOL = re.compile(r"[FMCRc][_A-Za-z0-9]{0,3}")
_OF_ALL = re.compile(
    r"^(?:mean|total|avg|average)(?=..)|(?<=..)(?:total|tot|mean|avg|average|net|gesamt|mittel|mittelwert)$"
)


def _knows(bare: str) -> bool:
    """Whether a folded name stands in the vocabulary as it is."""
    words = vocabulary()
    return any(bare in section for section in (words.columns, words.flow, words.coefficients))


def _in_other_words(name: str) -> str:
    """What a name is by its words in another order, or cut short: Angle of drift, drift ang, Lift coeff; empty where it is nothing."""
    words, parts = vocabulary(), _words("" if _IN_SYMBOLS.search(name) else name)
    full = [w for part in parts if (w := words.short.get(part, part))]
    every = (
        ("".join(some) for some in permutations(full)) if len(full) <= 3 and (full != parts or len(full) > 1) else ()
    )
    found = next((n for w in every if (n := words.columns.get(w) or words.flow.get(w))), "")
    return found if found in FORCES or not {*parts} & words.lists["coefficient"] else ""


def _words(name: str) -> list[str]:
    return [folded(w) for w in re.findall(r"[^\W\d_]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name))]


def is_pure(name: str) -> bool:
    """Whether a name is that of a coefficient."""
    bare, words = folded(name), {*_words(name)}
    pure = not {bare, _OF_ALL.sub("", bare), *words}.isdisjoint(vocabulary().coefficients)
    return pure or not words.isdisjoint(vocabulary().lists["coefficient"])


def _by_unit(meanings: list[str], unit: str) -> tuple[str, str, bool]:
    """Of several meanings the first that the unit fits; nothing where it fits none or there is none."""
    spelt = vocabulary().units.get(unit.casefold(), unit)
    fitting = [m for m in meanings if m not in WORDS and fits(spelt, read_column_map(m).dimension)]
    return (fitting[0], "its name", False) if fitting else ("", f"{' or '.join(meanings)} by its name", False)


def _without_symbol(own: str) -> str:
    """A known name without the symbol behind it, of a force, moment or coefficient, where that says nothing else: Querkraft Fq, Lift FL."""
    name, _, symbol = own.rpartition(" ")
    words = vocabulary()
    if not name or not _SYMBOL.fullmatch(symbol.strip("()[],")):
        return own
    of_name, of_symbol = (
        {what for s in (words.columns, words.flow, words.coefficients) if (what := s.get(folded(text)))}
        for text in (name, symbol)
    )
    also = {*words.several.get(folded(symbol), "").split()}
    return name if of_name and (not of_symbol | also or of_name & (of_symbol | also)) else own


def _with_symbol(own: str) -> str:
    """Of a name with its symbol behind it, ``Driftwinkel β``, where both say the same."""
    word, _, symbol = own.rpartition(" ")
    name = vocabulary().columns.get(folded(word), "")
    same = {*vocabulary().symbols.get(name, "").split(), name} - {""}
    return name if symbol.strip("()[], ") in same else ""


def either_unit(unit: str, dimension: str) -> tuple[str, str]:
    """The SI and the US unit of a head that gives both, ``lb / N``, so that the numbers may be in either; empty elsewhere."""
    words = vocabulary().units
    pounds = {"lb": "lbf", "lbs": "lbf"} if dimension == "force" else {}
    parts = [words.get(p.casefold(), pounds.get(p.casefold(), p)) for p in map(str.strip, unit.split("/"))]
    if len(parts) != 2 or not all(fits(p, dimension) for p in parts):
        return "", ""
    us = [bool({"lbf", "ft", "in"} & {*re.split(r"[^a-z]", p)}) for p in parts]
    return (parts[us.index(False)], parts[us.index(True)]) if us[0] != us[1] else ("", "")

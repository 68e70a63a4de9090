"""The condition of every run: what its files state and what its name says; never guessed, each value with its origin."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import takewhile
from types import MappingProxyType

import numpy as np

from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.types import brief
from coeflab.core.units import SI, factor
from coeflab.core.wording import listed, repeated
from coeflab.law.symbols import ANGULAR, CONTROLS, LINEAR, MOTIONS
from coeflab.tables.raw_table import Stated
from coeflab.tables.vocabulary import did_you_mean, one_name

ANGLES = ("alpha", "beta", *CONTROLS)
DIMENSIONS = {
    **dict.fromkeys(ANGLES, "angle"),
    **dict.fromkeys(("U", *LINEAR), "speed"),
    **dict.fromkeys(ANGULAR, "rate"),
    **{f"{m}'": "none" for m in MOTIONS},
}
SETTINGS = tuple(DIMENSIONS)
COUNTED = ("cells", "y_plus")  # numbers of a run that are no settings
TEXT = "text"
MOST_NAMED = 10
_FIELD = re.compile(r"\{([^{}]*)\}")
_SPELLING = re.compile(r"([A-Za-z]{1,8}|\*[A-Za-z]{1,8}(?!=\.))=([-+.])")
BEHIND = "*"  # before the letters of a sign that stands behind its number
_SCALE = re.compile(r"x([0-9]*\.?[0-9]+)")
EXTENSION = re.compile(r"\.[A-Za-z]\w*$")
# What a number in a name may be, by the word before it; a person confirms it.
_WORDS = {
    word: field
    for field, words in {
        "beta:deg": "b beta drift driftangle sideslip yaw yawangle", "alpha:deg": "a alpha aoa attack incidence pitch pitchangle",
        "r:UNIT": "r yawrate", "q:UNIT": "q pitchrate", "p:UNIT": "rollrate", "U:m/s": "u speed velocity", "dr:deg": "dr rudder",
        "ds:deg": "ds sternplane",
    }.items()
    for word in words.split()
}  # fmt: skip
_SIGNS = {
    **dict.fromkeys(("", "-", "+"), ""), **dict.fromkeys(["m", "n", "M", "N", "neg", "minus"], "-"), **dict.fromkeys(["p", "P", "pos", "plus"], "+"),
}  # fmt: skip
_BEFORE = re.compile(r"(?<![A-Za-z])(?:neg|minus|pos|plus|[mnpMNP]|[-+])$")  # a sign before a number
_DIGITS = re.compile(r"([0-9]+(?:\.[0-9]+|p[0-9]+)?)")
_RATE_UNIT = re.compile(r"(?i)_?(?:(?P<deg>deg_?p?s|dps|grad_?s)|rad_?p?s)(?![a-z])")  # behind the number of a rate
UNNAMED = "NAME:UNIT"
UNIT_ASKED = ":UNIT"  # degrees and radians a second differ by 57: nothing but a person says which
SPELT = "A minus is - unless the pattern spells it: {beta:deg:m=-,p=+} reads m12 as -12 and p4 as 4; with p=. too, p2p5 as 2.5. {beta:deg:*P=-,*S=+} has the sign behind its number: b04P is -4"
BETWEEN = " | "  # several patterns of names in one option
_LONGEST, MOST_OPEN = 200, 3  # letters of a name, and asterisks and labels: each may end anywhere


@brief
@dataclass(frozen=True, slots=True)
class Condition:
    """One setting, number or label of one run.

    Attributes
    ----------
    value : float or str
        SI; a label as it is written.
    written : float
        The number in its unit; NaN for a label.
    unit : str
        As its origin writes it.
    origins : tuple of str
        Where it comes from: file and line, line of the list of runs, the name. The first one's value counts.
    """

    value: float | str
    written: float
    unit: str
    origins: tuple[str, ...]

    def __str__(self) -> str:
        number = self.value if isinstance(self.value, str) else f"{self.written:.10g} {self.unit}".removesuffix(" -")
        return f"{number} ({', '.join(self.origins)})"


def in_a_list(name: str) -> str:
    """How a list of runs says a setting, in a few words."""
    dimension = DIMENSIONS[name]
    unit = "deg" if dimension == "angle" else SI[dimension] or "-"
    return f"a list of runs has them: --runs list.csv with the columns run,{name} [{unit}]"


def condition_of(written: float, unit: str, name: str, origin: str) -> Condition:
    """A number of a setting as its origin writes it."""
    dimension = DIMENSIONS.get(name)
    value = written * (factor(unit, dimension) if dimension else 1.0)
    return Condition(value, written, unit, (origin,))


@dataclass(frozen=True, slots=True)
class _Field:
    name: str
    unit: str
    signs: Mapping[str, str]
    points: tuple[str, ...]
    scale: float


@brief
@dataclass(frozen=True, slots=True)
class NamePattern:
    """A pattern of names such as ``b{beta:deg}_r{r:rad/s}``.

    ``{NAME:UNIT}`` is a number with a point for its decimals, ``*`` any text, ``{NAME:text}`` a label. Other spellings hold
    only where the pattern has them, behind a further colon: ``{beta:deg:m=-,p=.}`` reads m2p5 as -2.5,
    ``{beta:deg:P=-,S=+}`` P4 as -4, ``{beta:deg:*P=-,*S=+}`` 4P, ``{r:rad/s:x0.01}`` 015 as 0.15. A letter may be both sign and point,
    ``{beta:deg:m=-,p=+,p=.}``: before the first digit it is the sign, between digits the point.

    Attributes
    ----------
    text : str
        As written; with ``/`` it covers folders above the run too.
    fields : tuple
    expression : re.Pattern
    """

    text: str
    fields: tuple[_Field, ...]
    expression: re.Pattern[str] = field(repr=False)

    def conditions(self, name: str) -> dict[str, Condition] | None:
        """What a name says, or None where the pattern does not fit it.

        Parameters
        ----------
        name : str
            Path of the run from the folder of runs, with ``/``.
        """
        levels = _FIELD.sub("", self.text).count("/")
        parts = name.split("/")[-levels - 1 :]
        tail = "/".join(parts)
        stem = tail.rpartition(".")[0] if "." in parts[-1] else ""
        match = next(
            (m for t in (tail, stem) if t and len(t) <= _LONGEST and (m := self.expression.fullmatch(t))), None
        )
        if match is None:
            return None
        out = {}
        origin = f"name {tail}"
        for f, text in zip(self.fields, match.groups(), strict=True):
            if f.unit == TEXT:
                out[f.name] = Condition(text, np.nan, "", (origin,))
            else:
                out[f.name] = condition_of(_spelt(text, f), f.unit, f.name, origin)
        return out


def _spelt(text: str, spelling: _Field) -> float:
    """A number of a name; letters stand for what the pattern says."""
    plain = text.replace("\u2212", "-")
    for letters in sorted(spelling.signs, key=len, reverse=True):
        word = letters.removeprefix(BEHIND)
        if plain.endswith(word) if letters != word else plain.startswith(word):
            plain = spelling.signs[letters] + plain.removesuffix(word).removeprefix(word)
            break
    for letters in sorted(spelling.points, key=len, reverse=True):
        plain = plain.replace(letters, ".")
    return float(plain) * spelling.scale


def name_pattern(text: str) -> NamePattern:
    """Read a pattern of names.

    Raises
    ------
    InputError
        No field, an unknown one, one twice, no unit or a wrong one, a spelling that is none, fields without text between.
    """
    fields: list[_Field] = []
    pieces: list[str] = []
    position = 0

    def fail(found: str, expected: str, advice: str = "") -> InputError:
        return InputError(
            *(" ".join(words.split()) for words in (found, expected)),
            column=f"name pattern {shown(text)}",
            advice=advice,
        )

    many = text.count("*") + sum(match[1].strip().endswith(TEXT) for match in _FIELD.finditer(text))
    if len(text) > _LONGEST or many > MOST_OPEN:
        raise fail(f"{len(text)} letters, {many} asterisks and labels", f"at most {_LONGEST} and {MOST_OPEN}")
    for match in _FIELD.finditer(text):
        between = text[position : match.start()]
        if fields and between in ("", "*"):
            raise fail("two numbers without text between them", "text between them that separates them")
        pieces.append(_literal(between))
        one = _field(match[1], fail)
        fields.append(one)
        pieces.append(_number_expression(one))
        position = match.end()
    rest = text[position:]
    if "{" in "".join(pieces) + rest and re.search(r"(?<!\\)[{}]", _FIELD.sub("", text)):
        raise fail("a brace that is not closed", "{NAME:UNIT}")
    if not fields:
        raise fail("no {NAME:UNIT}", "at least one", "Such as 'b{beta:deg}_r{r:rad/s}'.")
    if twice := repeated(f.name for f in fields):
        raise fail(f"{listed(twice)} twice", "every name once")
    return NamePattern(text, tuple(fields), re.compile("".join(pieces) + _literal(rest)))


def likely_patterns(names: Sequence[str]) -> tuple[str, ...]:
    """The pattern that all names of runs seem to have, or those of groups of alike names; to be confirmed.

    Numbers that differ, between texts that do not. What each is follows from the word before it, else it is ``{NAME:UNIT}``;
    so is ``{r:UNIT}`` of a rate whose names do not say deg/s or rad/s; letters for signs and decimals are spelt as `NamePattern` takes them. Empty where a name belongs to none.

    Examples
    --------
    >>> likely_patterns(["drift_m12", "drift_p4", "yaw_r0.1rads", "yaw_r0.2rads"])
    ('drift_{beta:deg:m=-,p=+}', 'yaw_r{r:rad/s}rads')
    """
    texts = _texts(names)
    if whole := _likely(texts):
        return (whole,)
    groups: dict[tuple[str, ...], list[str]] = {}
    for text in texts:
        words = _DIGITS.split(text)[::2]
        groups.setdefault((str(len(words)), *(_BEFORE.sub("", w) for w in words)), []).append(text)
    joined: list[list[str]] = []
    for group in groups.values():
        home = next((other for other in joined if _likely([*other, *group])), None)
        if home is None:
            joined.append(group)
        else:
            home += group
    found = tuple(map(_likely, joined))
    return found if all(found) else ()


def _texts(names: Sequence[str]) -> list[str]:
    """The last parts of names where they differ, else whole, without an extension that all share."""
    lasts = [name.rpartition("/")[2] for name in names]
    texts = lasts if len(set(lasts)) == len(lasts) else list(names)
    ends = {found[0] if (found := EXTENSION.search(text)) else "" for text in texts}
    return [text.removesuffix(next(iter(ends))) for text in texts] if len(ends) == 1 else texts


def _likely(texts: Sequence[str]) -> str:
    """The one pattern of names without their folders and extension; empty where they have none, or are fewer than two."""
    split = [_DIGITS.split(text) for text in texts]
    if len(texts) < 2 or len({len(parts) for parts in split}) != 1 or len(split[0]) < 3:
        return ""
    columns: list[tuple[str, ...]] = list(zip(*split, strict=True))
    out, taken = "", set()
    for i in range(0, len(columns) - 1, 2):
        before, numbers = columns[i], columns[i + 1]
        shared = "".join(letters[0] for letters in takewhile(lambda ls: len(set(ls)) == 1, zip(*before, strict=False)))
        signs = {text.removeprefix(shared) for text in before}
        if not signs <= set(_SIGNS):
            return ""
        if len(set(numbers)) == 1 and signs == {""}:
            out += shared + numbers[0]
            continue
        spelt = [f"{sign}={_SIGNS[sign]}" for sign in sorted(signs) if _SIGNS[sign]]
        spelt += ["p=."] * any("p" in number for number in numbers)
        word = re.search(r"([A-Za-z]*)[^A-Za-z]*$", shared)
        field = _WORDS.get(word[1].casefold() if word else "", UNNAMED)
        if field.endswith(UNIT_ASKED) and field != UNNAMED and (unit := _rate_unit(columns[i + 2])):
            field = field.replace("UNIT", unit)
        field = UNNAMED if field in taken else field
        taken.add(field)
        out += shared + "{" + ":".join([field, *([",".join(spelt)] if spelt else [])]) + "}"
    if len(set(columns[-1])) != 1 or not taken:
        return ""
    return out + columns[-1][0]


def _rate_unit(behind: Sequence[str]) -> str:
    """The unit that every name has behind the number of a rate; empty where one has none."""
    found = [m for text in behind if (m := _RATE_UNIT.match(text))]
    units = {"deg/s" if m["deg"] else "rad/s" for m in found}
    return units.pop() if len(found) == len(behind) and len(units) == 1 else ""


class NoConditionError(InputError):
    """Nobody says the conditions of any run; ``runs`` are their names, ``patterns`` those that they seem to have."""

    def __init__(self, runs: Sequence[str]) -> None:
        self.runs = tuple(runs)
        self.patterns = likely_patterns(runs)
        sources = "a list of runs or a pattern of names, such as --name 'b{beta:deg}_r{r:rad/s}'"
        options = " ".join(f"--name '{pattern}'" for pattern in self.patterns)
        proposed = f" If this is what they mean: {options}." if self.patterns else ""
        if UNNAMED in options:
            proposed = f" If their numbers are a setting: {options}, with NAME beta, alpha, r, U ... and its UNIT; "
            proposed += "what is known anyway goes with it: --set axes.frame=CFD --set 'scaling.length=4.3 LOA' ..."
        elif UNIT_ASKED in options:
            proposed = f" If this is what they mean: {options}, with deg/s or rad/s for UNIT: no name says it, and they differ by 57."
        proposed = proposed or f" Or {in_a_list('beta')}."
        super().__init__(
            f"no angle, rate or speed for {named(runs)}", f"them in the files, {sources}",
            advice=f"Nothing is taken from names unless a pattern says what they mean.{proposed}",
        )  # fmt: skip


def _literal(text: str) -> str:
    return "[^/]*?".join(map(re.escape, text.split("*")))


def _field(text: str, fail: Callable[..., InputError]) -> _Field:
    name, _, rest = (part.strip() for part in text.partition(":"))
    unit, _, spelling = (part.strip() for part in rest.partition(":"))
    name = one_name(name)
    if not unit:
        raise fail(f"{{{text}}} without a unit", f"{{{name or 'beta'}:UNIT}}", "Angles deg or rad, r' and the like -.")
    if unit == TEXT:
        if not name or spelling:
            raise fail(f"{{{text}}}", "{NAME:text}")
        return _Field(name, TEXT, {}, (), 1.0)
    if name not in DIMENSIONS and name not in COUNTED:
        near = did_you_mean(name)
        raise fail(
            shown(name),
            f"one of {', '.join(SETTINGS)}, cells, y_plus",
            f"{near} For a label: {{{name}:text}}.".lstrip(),
        )
    try:
        factor(unit, DIMENSIONS.get(name, "none"))
    except UnitsError as why:
        raise fail(why.found, why.expected, why.advice) from None
    signs: dict[str, str] = {}
    points: list[str] = []
    scale = 1.0
    for word in filter(None, (w.strip() for w in spelling.split(","))):
        if match := _SPELLING.fullmatch(word):
            if match[2] == ".":
                points.append(match[1])
            elif signs.setdefault(match[1], match[2]) != match[2]:
                raise fail(f"{match[1]} as - and as +", "one sign a letter")
        elif (match := _SCALE.fullmatch(word)) and float(match[1]) > 0.0:
            scale = float(match[1])
        else:
            raise fail(shown(word), "spellings such as m=-, p=. or x0.01, with commas between them")
    return _Field(name, unit, MappingProxyType(signs), tuple(points), scale)


def _number_expression(f: _Field) -> str:
    if f.unit == TEXT:
        return "([^/]+?)"
    points = "|".join([r"\.", *map(re.escape, f.points)])
    first = "|".join([r"\.", *(re.escape(s) for s in f.points if s not in f.signs)])
    sign = "|".join(["[-+\u2212]", *(re.escape(s) for s in f.signs if not s.startswith(BEHIND))])
    behind = "|".join(re.escape(s.removeprefix(BEHIND)) for s in f.signs if s.startswith(BEHIND))
    plain = f"(?:[0-9]+(?:(?:{points})[0-9]+)?|(?:{first})[0-9]+)"
    return f"({plain}(?:{behind})?|(?:{sign}){plain})" if behind else f"((?:{sign})?{plain})"


def of_files(stated: Mapping[str, Stated]) -> dict[str, Condition]:
    """What the files of a run state of its condition, SI."""
    out = {}
    for name, one in stated.items():
        if isinstance(one.value, str):
            out[name] = Condition(one.value, np.nan, "", (one.place,))
        elif not isinstance(one.value, tuple):
            out[name] = Condition(
                float(one.value), float(one.value), SI[DIMENSIONS.get(name, "none")] or "-", (one.place,)
            )
    return out


def named(runs: Sequence[str]) -> str:
    """The first ten by name, the others counted."""
    head = list(runs[:MOST_NAMED])
    return listed(head) if len(runs) <= MOST_NAMED else f"{', '.join(head)} and {len(runs) - MOST_NAMED} more"

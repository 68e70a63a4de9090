"""What the form of `coeflab import` asks, as keywords: which keyword says which key, and a question that is open as an InputError."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, shown, together
from coeflab.core.keywords import option
from coeflab.core.texts import input_error
from coeflab.core.types import Array
from coeflab.core.units import with_unit
from coeflab.tables.form import Group, Line
from coeflab.tables.settings import Setting, read_in, require_one_datum

KEYS = {
    "frame": "axes.frame",
    "alpha": "axes.alpha",
    "beta": "axes.beta",
    "datum": "axes.datum",
    "about": "axes.reference_point",
    "length": "scaling.length",
    "length_name": "scaling.length_name",
    "density": "conditions.density",
    "speed": "conditions.speed",
    "viscosity": "conditions.viscosity",
    "half_model": "campaign.half_model",
    "symmetry": "campaign.symmetry",
    "body": "campaign.body",
    "centre": "table.centre",
    "arm_point": "table.arm_point",
    "contains_inertia": "table.contains_inertia",
    "mass": "inertia.mass",
    "centre_of_gravity": "inertia.centre_of_gravity",
    "inertia": "inertia.inertia",
    "area": "coefficients.area",
    "moment_length": "coefficients.length",
    "units": "columns.units",
    "kind": "source.kind",
    "citation": "source.citation",
}
KEYWORDS = {key: keyword for keyword, key in KEYS.items()}
PLACES = ("about", "arm_point", "centre_of_gravity")
_SIDE = re.compile(r"\b(aft|astern|behind|forward|fwd|ahead)(?:\s+of)?\b", re.IGNORECASE)
_AFT = ("aft", "astern", "behind")


def settings_of(given: Mapping[str, Any]) -> dict[str, Setting]:
    """Keywords as settings of a campaign; None says nothing.

    Parameters
    ----------
    given : mapping of str to object
        By keyword.

    Raises
    ------
    InputError
        Every value that its key does not take, by keyword.
    """
    out: dict[str, Setting] = {}
    complaints: list[InputError] = []
    for keyword, value in given.items():
        if value is None:
            continue
        try:
            for key, read in read_in(KEYS[keyword], _typed(keyword, value)).items():
                require_one_datum(out, {key: read})
                out[key] = Setting(read, "confirmed")
        except InputError as why:
            complaints.append(type(why)(why.found, why.expected, column=keyword, advice=why.advice))
    if complaints:
        raise together(complaints)
    return out


def _typed(keyword: str, value: Any) -> Any:
    """A value as a person types it into the form: places with their side as a sign."""
    if keyword in PLACES and isinstance(value, str):
        return in_signs(value)
    if keyword in PLACES:
        return ", ".join(repr(float(v)) for v in value) if hasattr(value, "__len__") else repr(float(value))
    if keyword == "symmetry" and not isinstance(value, str):
        return ", ".join(value)
    if isinstance(value, bool):
        return str(value).casefold()
    if keyword == "inertia" and hasattr(value, "__len__") and not isinstance(value, str):
        return ", ".join(repr(float(v)) for v in value)
    if keyword == "frame" and not isinstance(value, str):
        return ", ".join(value)
    return value if isinstance(value, str) else repr(float(value))


def in_signs(place: str) -> str:
    """A place with its side in words as one with a sign, x forward: ``nose, 1.0 m aft`` is ``-1.0 m from nose``.

    Examples
    --------
    >>> in_signs("nose, 1.0 m aft")
    '-1.0 m from nose'
    >>> in_signs("0.3 m forward of midship")
    '0.3 m from midship'
    >>> in_signs("-2.1 from nose")
    '-2.1 from nose'
    """
    sides = _SIDE.findall(place)
    number = re.search(r"(?<![\w.])(\d+(?:\.\d*)?|\.\d+)\s*(mm|cm|m|ft|in)?\b", place)
    if len(sides) != 1 or number is None:
        return place
    rest = _SIDE.sub(" ", place[: number.start()] + " " + place[number.end() :])
    datum = " ".join(w for w in re.split(r"[\s,]+", rest) if w and w.casefold() not in ("of", "the", "from"))
    sign = "-" if sides[0].casefold() in _AFT else ""
    size = f"{sign}{number[1]}{f' {number[2]}' if number[2] else ''}"
    return f"{size} from {datum}" if datum else size


_AS_TYPED = (
    (re.compile(r"(?<![\w\"])(\w+)=([A-Z]\w*'? \[[^\]]*\])"), r'columns={"\1": "\2"}'),
    (re.compile(r", \.(?=centre_of_gravity|inertia)"), ", inertia."),
)


def in_python(text: str) -> str:
    """Words of the form of ``coeflab import`` with keywords in the place of keys and options.

    Examples
    --------
    >>> in_python("SI for all; or Fy=Y [kN]")
    'SI for all; or columns={"Fy": "Y [kN]"}'
    >>> in_python("true: with inertia.mass, .centre_of_gravity")
    'true: with mass, centre_of_gravity'
    """
    for pattern, words in _AS_TYPED:
        text = pattern.sub(words, text)
    for key, keyword in KEYWORDS.items():
        text = re.sub(rf"(?<![\w.]){re.escape(key)}(?![\w.])", keyword, text)
    return text


_EITHER = re.compile(r"([+-]) if (.+), else ([+-])")


def open_questions(lines: Sequence[Line], source: str, parts: Sequence[str] = ()) -> InputError:
    """What of a form is open or waits to be accepted, as one error that names the keywords.

    Parameters
    ----------
    lines : sequence of Line
    source : str
        What is read, for messages.
    parts : sequence of str
        Names of the tables, where there are several.
    """
    waits = [one for one in lines if one.group is Group.OPEN or one.pending]
    if any(one.key.endswith(KEYS["about"]) for one in waits):  # which names its datum
        waits = [one for one in waits if one.key != KEYS["datum"]]
    return together(list(_asked(waits, source, parts)))


def _asked(lines: Sequence[Line], source: str, parts: Sequence[str]) -> Iterator[InputError]:
    for one in lines:
        plain = one.key.rpartition("/")[2] if any(one.key.startswith(f"{p}/") for p in parts if p) else one.key
        keyword = KEYWORDS.get(plain)
        either, why, about = _EITHER.fullmatch(str(one.value)), in_python(one.why), in_python(one.about)
        if either is not None:
            offered = f'{keyword}="{either[1]}" if {either[2]}, else {keyword}="{either[3]}"'
        elif one.value:
            offered = f'{keyword or "columns"}="{one.value}" if that is right, or accept=True: {why}'
        else:
            offered = why
        if keyword is None and "." in one.key and not one.argument.startswith("--map"):
            yield InputError(
                f"nothing said of {one.key}", why or "a value", file=source, column=f'settings["{one.key}"]'
            )
        elif keyword is None and not one.argument:  # of the importer, chosen in reading
            offered = f'options={{"{one.key}": "{one.value}"}} if that is right, or accept=True: {one.why}'
            yield InputError(f"no option {one.key}", offered, file=source, column="options")
        elif keyword is None:
            offered = f'columns={{"{one.key}": "{one.value or "..."}"}}'
            yield input_error(
                "front_door.column_nobody_said", source, column="columns", key_2=one.key, offered=offered, why=why
            )
        else:
            yield InputError(
                f"no {keyword}", offered, file=source, column=keyword, advice=about if not one.value or either else ""
            )


def in_keywords(why: InputError, source: str) -> InputError:
    """A complaint about keys of campaign.toml as one about keywords; every other as it is."""
    for one in (why, *why.others):
        if one.column is not None and (keyword := KEYWORDS.get(one.column.rpartition("/")[2])) is not None:
            one.column, one.keyed = keyword, True
        one.found, one.expected, one.advice = map(in_python, (one.found, one.expected, one.advice))
        one.file = source if one.file is None or str(one.file) in (".", "campaign.toml") else one.file
        one.args = (str(one),)
    return why


def si(value: float | str, dimension: str, keyword: str) -> float:
    """A number in SI, or a text with its unit.

    Parameters
    ----------
    value : float or str
    dimension : str
        Key of `coeflab.core.units.SI`.
    keyword : str
        For the error.

    Raises
    ------
    InputError
        Neither; a bare angle of more than half a turn, which can only be degrees.

    Examples
    --------
    >>> round(si("20 deg", "angle", "rudder"), 6)
    0.349066
    """
    try:
        number = value if isinstance(value, str) else _number(value)
        typed = isinstance(value, str) or dimension == "density"
        found = with_unit(number, dimension) if typed else float(number)
    except InputError as why:
        raise why.at(column=option(keyword)) from None
    if dimension == "angle" and not typed and abs(found) > math.pi:
        raise input_error("front_door.rad_beyond_half", column=option(keyword), found=found)
    return found


def above_zero(value: float | str, dimension: str, keyword: str) -> float:
    """A number in SI, or a text with its unit, that is above zero; as `si`.

    Parameters
    ----------
    value : float or str
    dimension : str
        Key of `coeflab.core.units.SI`, and what the number is called.
    keyword : str
        For the error.
    """
    found = si(value, dimension, keyword)
    if not found > 0.0:
        raise InputError(shown(str(value)), f"a {dimension} above zero", column=option(keyword))
    return found


def share_of(value: float | str, keyword: str) -> float:
    """A share above zero and below one: 0.1, or ``"10 %"``.

    Parameters
    ----------
    value : float or str
    keyword : str
        For the error.

    Raises
    ------
    InputError
        No such share.

    Examples
    --------
    >>> share_of("10 %", "target"), share_of(0.1, "target")
    (0.1, 0.1)
    """
    text = str(value).strip()
    try:
        found = float(text.removesuffix("%")) / (100.0 if text.endswith("%") else 1.0) if "_" not in text else 0.0
    except ValueError:
        found = 0.0
    if not 0.0 < found < 1.0:
        raise InputError(shown(text), "a share above zero and below one, such as 2% or 0.02", column=option(keyword))
    return found


def three(values: Any, dimension: str, keyword: str) -> Array:
    """Three numbers in SI, each a text with its unit where it is one, such as x, y, z.

    Parameters
    ----------
    values : sequence of float or str
    dimension : str
        Key of `coeflab.core.units.SI`.
    keyword : str
        For the error.

    Raises
    ------
    InputError
        Not three, or no numbers.

    Examples
    --------
    >>> three((0.1, 0, "20 mm"), "length", "centre_of_gravity").tolist()
    [0.1, 0.0, 0.02]
    """
    if isinstance(values, str) or np.shape(values) != (3,):
        raise InputError(shown(str(values)), "three numbers", column=option(keyword))
    return np.array([si(v, dimension, keyword) for v in values])


def _number(value: Any) -> float:
    from coeflab.core.units import quantity

    return quantity(value.item() if hasattr(value, "item") else value, "none")

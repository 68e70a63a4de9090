"""Keys of campaign.toml as a person types them, or an earlier import saved them."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from coeflab.core.axes import ANGLE_SIGNS, Axes, angle_sign, datum_name, parse_axes
from coeflab.core.declarations import POINT, numbers, one_of, text_of
from coeflab.core.errors import InputError, shown, together
from coeflab.core.provenance import TABLE_KINDS
from coeflab.core.text.toml import read_toml, typed_value
from coeflab.core.texts import input_error
from coeflab.core.units import quantity, with_unit
from coeflab.law.scaling import Scaling, require_hull
from coeflab.tables import campaign
from coeflab.tables.column_map import ColumnMap, read_column_map
from coeflab.tables.input_uncertainty import InputUncertainty
from coeflab.tables.raw_table import HALF_MODEL
from coeflab.tables.vocabulary import vocabulary
from coeflab.tables.words.above import of_the_test
from coeflab.tables.words.points import POINT_OF

EXTRA = ("coefficients.area", "coefficients.length", "columns.units")  # said of columns: no keys of campaign.toml
SIZES = {
    "conditions.density": "density", "conditions.speed": "speed", "scaling.length": "length", "inertia.mass": "mass",
}  # fmt: skip
SAME_SIZE = 0.01  # share by which a setting may differ from the words of the file
CONFIRMED = ("confirmed", "from ")
_KINDS = {
    "campaign": campaign.CampaignHead, "axes": campaign.CampaignAxes, "scaling": Scaling, "conditions": campaign.CampaignConditions,
    "source": campaign.TableSource, "inertia": campaign.TowedInertia, "uncertainty": InputUncertainty, "table": campaign.TableDeclaration,
}  # fmt: skip
SECTIONS = {section: tuple(f.name for f in fields(kind)) for section, kind in _KINDS.items()}
ARM_POINT, TABLE_POINT = "table.arm_point", "table.reference_point"
SYMMETRY = "campaign.symmetry"
REFERENCE = "reference point"  # what a person may say for the point of the arm
OF_ARMS = ("table.centre", "table.arm_point", "table.contains_inertia")  # keys that a straight tow has not
VISCOSITY = "conditions.viscosity"
EACH = "each"  # in mapping.toml: keys of one table of several, by its name
RESERVED = ("table.file", "table.source_sha256", "table.sha256", "table.cells", "campaign.importer")
PLACE_WANTED = "x, y, z in m, such as -2.1, 0, 0, or x alone; 0 is the datum"
_ALONG = re.compile(r"[-+]?\d+(?:\.\d*)?\s*[a-z]{1,4}")
CENTRE_OF_GRAVITY = "inertia.centre_of_gravity"
PLACE_KEYS = (POINT_OF, CENTRE_OF_GRAVITY, ARM_POINT, TABLE_POINT)


@dataclass(frozen=True, slots=True)
class Setting:
    """A value of campaign.toml and where it comes from.

    Attributes
    ----------
    value : object
        As TOML holds it.
    origin : str
        For the comment beside it.
    assumed : bool
        It was accepted, and neither a person nor the source states it.
    """

    value: Any
    origin: str
    assumed: bool = False


Settings = Mapping[str, Setting]


def _sign(name: str) -> Callable[[Any], Any]:
    def read(value: Any) -> str:
        formulas = {"+" if sign > 0 else "-": formula for formula, sign in ANGLE_SIGNS[name].items()}
        text = formulas.get(str(value), value)
        angle_sign(name, text)
        return " ".join(str(text).split())

    return read


_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_WITH_UNIT = re.compile(rf"({_NUMBER.pattern})\s*([^\d\s.].*)")


def _triple(read: Callable[[Any, Path], Any]) -> Callable[[Any], Any]:
    def parsed(typed: Any) -> Any:
        value = list(typed) if isinstance(typed, tuple) else typed
        if isinstance(value, str):
            inner = value.strip(" []()")
            parts = inner.split("," if "," in inner else ";" if ";" in inner else None)
            value = [typed_value(part) for part in _one_unit([part.strip(" \"'") for part in parts])]
        try:
            read(value, Path())
        except InputError as why:
            if not isinstance(typed, str):
                raise
            advice = "Write a decimal point." if len(value) > 3 and "." not in typed else why.advice
            raise type(why)(shown(typed), why.expected, advice=advice) from None
        return value

    return parsed


def _one_unit(parts: list[str]) -> list[str]:
    """Three numbers with a unit behind the last alone: it is that of all three."""
    last = _WITH_UNIT.fullmatch(parts[-1]) if parts else None
    if len(parts) == 3 and last and all(_NUMBER.fullmatch(p) for p in parts[:2]):
        return [*(f"{p} {last[2]}" for p in parts[:2]), parts[2]]
    return parts


def _place(value: Any) -> Any:
    """Three numbers, or x alone of a point on the axis: -2.1, -2.1 m, -2100 mm."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return _triple(POINT.read)([float(value), 0.0, 0.0])
    if isinstance(value, str) and _ALONG.fullmatch(value.strip()):
        return [quantity(value.strip(), "length"), 0.0, 0.0]
    try:
        return _triple(POINT.read)(value)
    except InputError as why:
        raise type(why)(why.found, PLACE_WANTED, advice=why.advice) from None


def _flag(value: Any) -> bool:
    words = {"yes": True, "y": True, "true": True, "no": False, "n": False, "false": False}
    found = value if isinstance(value, bool) else words.get(str(value).casefold())
    if found is None:
        raise InputError(shown(value), "true or false")
    return found


def _half(value: Any) -> bool | str:
    words = {"yes": True, "no": False, "whole": False}
    plain = value.strip().casefold() if isinstance(value, str) else value
    return campaign.half_of_body(words.get(plain, plain) if isinstance(plain, str) else plain)


def _listed(value: Any) -> Any:
    return [word for part in value.split(",") if (word := part.strip(" \"'[]"))] if isinstance(value, str) else value


def _measured(dimension: str) -> Callable[[Any], Any]:
    def read(value: Any) -> Any:
        if not with_unit(value, dimension) > 0.0:
            raise InputError(shown(value), f"a {dimension} above zero")
        return value

    return read


def _one_of(*words: str) -> Callable[[Any], Any]:
    return lambda value: one_of(*words).read(value, Path())


def _area(value: Any) -> Any:
    if str(value).casefold().rstrip("s") == "prime":
        return "prime"
    return quantity(_measured("area")(value), "area")


def _hull(value: Any) -> Any:
    require_hull(value)
    return _measured("length")(value)


READERS: dict[str, Callable[[Any], Any]] = {
    "coefficients.area": _area,
    "coefficients.length": lambda value: quantity(_measured("length")(value), "length"),
    "columns.units": _one_of("SI", "US"),
    "axes.frame": lambda value: parse_axes(value).declared,
    "axes.alpha": _sign("alpha"),
    "axes.beta": _sign("beta"),
    **dict.fromkeys(PLACE_KEYS, _place),
    ARM_POINT: lambda value: REFERENCE if is_reference(value) else _place(value),
    "table.centre": _one_of(*campaign.CENTRES),
    "inertia.inertia": _triple(numbers(3, "inertia", "three numbers [Ix, Iy, Iz]").read),
    "inertia.mass": _measured("mass"),
    "scaling.length": _hull,
    "conditions.density": _measured("density"),
    "conditions.speed": _measured("speed"),
    "table.contains_inertia": _flag,
    **dict.fromkeys((HALF_MODEL, "table.half_model"), _half),
    SYMMETRY: lambda value: list(campaign.SYMMETRY_WORDS.read(_listed(value), Path())),
    "source.kind": _one_of(*TABLE_KINDS),
    "axes.datum": lambda value: datum_name(str(text_of(value, Path()))),
    **dict.fromkeys(
        ("axes.datum_note", "scaling.length_name", "source.citation", "campaign.title", "campaign.body", "campaign.name"),
        lambda value: str(text_of(value if isinstance(value, str) else json.dumps(value), Path())),
    ),
}  # fmt: skip


def read_setting(key: str, text: Any) -> Any:
    """A value of campaign.toml as a person types it: TOML, or bare words.

    Raises
    ------
    InputError
        No such key, or nothing that it takes.
    """
    section, _, name = key.partition(".")
    if key not in EXTRA and (name not in SECTIONS.get(section, ()) or key in RESERVED):
        known = [f"{section}.{n}" for n in SECTIONS.get(section, ()) if f"{section}.{n}" not in RESERVED]
        expected = f"one of {', '.join(known or SECTIONS)}" + ("" if known else " with a key, such as axes.frame")
        raise InputError(f"the key {shown(key)}", expected)
    typed = (
        typed_value(text)
        if isinstance(text, str) and READERS.get(key) not in (READERS["axes.datum"], READERS["axes.datum_note"])
        else text
    )
    try:
        return READERS.get(key, lambda value: value)(typed)
    except OverflowError:
        raise input_error("tables.number_beyond_sizes", column=key, typed=shown(typed)) from None
    except InputError as why:
        raise why.at(column=key) from None


_PLACED = re.compile(r"[-+]?\d[^A-Za-z]*(?:(?:mm|cm|m|ft|in(?!\s+front))\b)?")
_NO_METRES = re.compile(
    r"\d\s*(?:mm|cm|m)\b|\b(?:in|ft|dm|km|yd|feet|foot|inch|inches|L)\b|^\s*(?!(?:from|m)\b)\w+\s+(?:from|von|vom)\b"
)  # what stands beside the number of a place and would change it
_SIZED = re.compile(r"\s*([-+]?[\d.,]*\d(?:\s*(?:mm|cm|m|ft|in)\b)?)[\s,:]*(.*)")


def is_reference(value: Any) -> bool:
    """Whether a person says that the point of the arm is the reference point."""
    return isinstance(value, str) and " ".join(re.split(r"[\s_]+", value.strip().casefold())) in (
        REFERENCE,
        "reference",
    )


def read_settings(key: str, text: str) -> dict[str, Any]:
    """What a person types for a key; a point says its datum and a length its name with it.

    Places, such as ``axes.reference_point`` and ``inertia.centre_of_gravity``, take ``-2.1 from nose`` and ``midship``,
    ``table.arm_point`` also ``reference point``;
    ``scaling.length`` takes ``4.3 m LOA``.

    Raises
    ------
    InputError
        As `read_setting`; or a place with its side in words.
    """
    if key == ARM_POINT and is_reference(text):
        return {key: REFERENCE}
    if key in PLACE_KEYS and re.search(r"[A-Za-zÄÖÜäöü]{2,}", re.sub(r"\b(?:mm|cm|ft|in)\b", "", text)):
        datum, at = _place_and_datum(text, key)
        return ({"axes.datum": read_setting("axes.datum", datum)} if datum else {}) | {key: read_setting(key, at)}
    if (
        key == "scaling.length"
        and (sized := _SIZED.fullmatch(text))
        and (name := sized[2].strip(" ()"))
        and name not in vocabulary().lists["no_length"]
    ):
        if re.match(r"(?:dm|km|yd|feet|foot|inch|inches|met(?:er|re)s?)\b|['′\"″]", name, re.IGNORECASE):
            raise input_error("tables.length_in_another_unit", column=key, text=shown(text))
        return {key: read_setting(key, sized[1].strip()), "scaling.length_name": name}
    return {key: read_setting(key, text)}


def read_in(key: str, text: str) -> dict[str, Any]:
    """`read_settings` of a key that may have the name of a table before it; a datum of a table's points is that of all tables."""
    part, slash, plain = key.rpartition("/")
    read = read_settings(plain, text)
    return {
        k if plain in (ARM_POINT, TABLE_POINT) and k != plain else f"{part}{slash}{k}": value
        for k, value in read.items()
    }


def of_datum(value: str, point: str) -> bool:
    """Whether a datum that a person named is a point of the body by its plain name: midships is midship."""
    found = of_the_test([("", f"reference point {value}")]).get("axes.datum")
    return value.casefold() == point.casefold() or (found is not None and found.value == point)


def require_one_datum(known: Settings, read: Mapping[str, Any]) -> None:
    """Refuse a point of the arm or of a table from another datum than the rest: both places would move.

    Raises
    ------
    InputError
        Naming both.
    """
    new, old = read.get("axes.datum"), known.get("axes.datum")
    own = next((k for k in PLACE_KEYS[1:] if any(key.endswith(k) for key in (*read, *known))), "")
    if own and new is not None and old is not None and not of_datum(str(old.value), str(new)):
        raise input_error(
            "tables.two_datums_of_places", column=own, one=shown(str(old.value)), other=shown(str(new)), point_of=POINT_OF, own=own,
        )  # fmt: skip


def _place_and_datum(typed: str, key: str) -> tuple[str, str]:
    """``-2.1 from nose``, ``nose -2.1, 0, 0``, or ``midship``, which is the point itself."""
    numbers = _PLACED.search(typed)
    at = numbers[0].strip(" ,;:@") if numbers else ""
    if (unit := re.search(r"[a-z]+$", at)) and "," in at:  # one unit behind all three
        at = ", ".join(
            repr(quantity(f"{x.strip()} {unit[0]}", "length", key=key)) for x in at[: unit.start()].split(",")
        )
    rest = typed[: numbers.start()] + " " + typed[numbers.end() :] if numbers else typed
    words = [w for w in re.split(r"[\s,;:@()]+", rest) if w]
    if numbers and (sided := {w.casefold() for w in words} & vocabulary().lists["sided"]):
        raise input_error("tables.side_as_a_word", column=key, typed=shown(typed), pop=sided.pop())
    around = (typed[: numbers.start()], typed[numbers.end() :]) if numbers else ()
    if any(_NO_METRES.search(part) for part in around) or re.search("['\"′″]", at):
        raise input_error("tables.place_in_another_unit", column=key, typed=shown(typed), place_wanted=PLACE_WANTED)
    if "/" in rest or (not numbers and len(words) > 2):
        raise input_error("tables.no_place", column=key, typed=shown(typed), place_wanted=PLACE_WANTED)
    return " ".join(w for w in words if w.casefold() not in vocabulary().lists["between"]), at or "0"


def reynolds(settings: Settings) -> float | None:
    """U L / nu by what is said so far; None while one of them is open."""
    found = [settings.get(key) for key in ("conditions.speed", "scaling.length", VISCOSITY)]
    with suppress(InputError, ZeroDivisionError):
        speed, length, nu = (
            quantity(one.value, dimension) if one is not None else np.nan
            for one, dimension in zip(found, ("speed", "length", "viscosity"), strict=True)
        )
        return None if np.isnan(speed * length * nu) else speed * length / nu
    return None


def frame_of(settings: Settings) -> Axes | None:
    """The axes of the file, where they are known."""
    return parse_axes(settings["axes.frame"].value) if "axes.frame" in settings else None


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
    each = content.pop(EACH, {})
    for key, value in each.items() if isinstance(each, dict) else ():
        try:
            settings[key] = Setting(read_setting(key.rpartition("/")[2], value), f"from {path.name}")
        except InputError as why:
            complaints.append(file.fail(EACH, why.found, why.expected, why.advice))
    for section, inner in content.items():
        keys = inner[0] if isinstance(inner, list) and inner else inner
        for name, value in keys.items() if isinstance(keys, dict) else {section: keys}.items():
            key = f"{section}.{name}"
            if key == "campaign.importer":
                importer = str(value)
            elif key not in RESERVED and section != "campaign":
                try:
                    settings[key] = Setting(read_setting(key, value), f"from {path.name}")
                except InputError as why:
                    complaints.append(file.fail(key, why.found, why.expected, why.advice))
    if complaints:
        raise together(complaints)
    return columns, settings, importer, dict(options) if isinstance(options, dict) else {}


def assumed(out: Path) -> dict[str, Setting]:
    """Names without physics, by the folder that is written."""
    name = out.resolve().name or "campaign"
    return {
        "campaign.name": Setting(name, "the folder's"),
        "campaign.title": Setting(name, "for people; reports print it"),
        "campaign.body": Setting(name, "the configuration of body.toml that the table is about"),
    }

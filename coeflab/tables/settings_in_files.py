"""What a source says of keys of campaign.toml, in its files or in words over a table, held against what a person says of them."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from coeflab.core.axes import parse_axes
from coeflab.core.errors import InputError
from coeflab.core.texts import input_error, text_of
from coeflab.core.units import quantity
from coeflab.law.scaling import doubtful_size, doubtful_viscosity, speaks_of_air
from coeflab.tables.raw_table import RawTable, Stated
from coeflab.tables.settings import (
    ARM_POINT,
    CONFIRMED,
    EXTRA,
    REFERENCE,
    RESERVED,
    SAME_SIZE,
    SECTIONS,
    SIZES,
    VISCOSITY,
    Setting,
    Settings,
    frame_of,
    of_datum,
    read_setting,
)
from coeflab.tables.words.axes import FORMULA
from coeflab.tables.words.points import ARM_FROM, OF_MOMENTS, POINT_FRAME, POINT_FROM, POINT_OF


def stated_settings(raw: RawTable) -> dict[str, Setting]:
    """What a file says of itself, as far as campaign.toml has keys for it.

    A reference point is left out: a file counts it in its own axes from its own origin.
    """
    out = {}
    for key, given in raw.stated.items():
        section, _, name = key.partition(".")
        if name in SECTIONS.get(section, ()) and key not in (*RESERVED, POINT_OF) and not given.offered:
            plain = list(map(float, given.value)) if isinstance(given.value, tuple) else given.value
            out[key] = Setting(plain, f"stated: {given.place}")
    return out


def overruled(raw: RawTable, settings: Settings) -> list[InputError]:
    """Complaints about keys that the source itself states and a person says otherwise; words over a table are proposals only.

    A reference point counts in the file's own axes and from its own origin, so that only one from that origin can be held against it.
    """
    out = []
    for key, stated in raw.stated.items():
        one = settings.get(key)
        section, _, name = key.partition(".")
        other = stated.offered or stated.convention or key in _JUDGED_BY_THEIR_OWN
        if one is None or other or not one.origin.startswith(CONFIRMED):
            continue
        if section in ("source", "campaign") or (name not in SECTIONS.get(section, ()) and key not in EXTRA):
            continue
        if not _same(key, one.value, stated.value, settings):
            value = (
                f"({', '.join(f'{x:g}' for x in stated.value)})"
                if isinstance(stated.value, tuple)
                else str(stated.value)
            )
            words = ", ".join(map(str, one.value)) if isinstance(one.value, list) else str(one.value)
            out.append(input_error(
                "tables.source_states", raw.path, column=key, key_2=key, words=words,
                value=value.casefold() if isinstance(stated.value, bool) else value, place=stated.place,
                advice=ADVICE.get(key, f"Leave {key} out: what the source states holds. If the source is wrong, correct it there."),
            ))  # fmt: skip
    return out


_JUDGED_BY_THEIR_OWN = (POINT_OF, "conditions.density", VISCOSITY)  # complained of with what each makes wrong
ADVICE = {
    "table.arm_point": "Leave it out: the velocities of the source already hold there, and another point would count the drift of the arm twice.",
    "scaling.length": 'Leave it out; primes by another length are those of `coeflab fit --length "4.3 m" --length-name LOA`, or of a plan.',
}


BY_WORDS = ("axes.frame", "axes.alpha", "axes.beta", "table.contains_inertia")


def _same(key: str, value: Any, stated: Any, settings: Settings) -> bool:
    """Whether a person says of a key what the source states."""
    if key in SIZES or key in ("coefficients.area", "coefficients.length"):
        dimension = SIZES.get(key, key.rpartition(".")[2])
        return value != "prime" and abs(quantity(value, dimension) / float(stated) - 1.0) <= SAME_SIZE
    if key == ARM_POINT and stated == REFERENCE:
        about = settings.get(POINT_OF)
        return value == REFERENCE or (about is not None and bool(np.allclose(value, about.value, rtol=0.0, atol=1e-9)))
    if key == "axes.frame":
        return bool(np.array_equal(parse_axes(value).rotation, parse_axes(read_setting(key, stated)).rotation))
    if isinstance(stated, tuple):
        return bool(np.allclose(np.asarray(value, dtype=float), stated, rtol=SAME_SIZE, atol=1e-9))
    return str(value).casefold() == str(stated).casefold()


def with_formula(stated: Mapping[str, Stated], settings: Settings) -> Mapping[str, Stated]:
    """What words say, a formula of v as the sign of beta: v to starboard, by axes that are known; where y has no side it says nothing."""
    given, frame = stated.get(FORMULA), frame_of(settings)
    if frame is None and (words := stated.get("axes.frame")) and not words.contradicted:
        frame = parse_axes(read_setting("axes.frame", words.value))
    side = 0.0 if given is None or frame is None else frame.rotation[1, 1]
    if given is None or not side:
        return stated
    formula = str(given.value) if side > 0.0 else str(given.value).translate(str.maketrans("+-", "-+"))
    other = stated.get("axes.beta", given)
    against = f"{other.place}, but {given.place}" if other is not given and other.value != formula else ""
    return {
        **stated,
        "axes.beta": replace(given, value=formula, contradicted=other.contradicted or given.contradicted or against),
    }


def against_words(raw: RawTable, settings: Settings) -> list[tuple[str, str, str]]:
    """Settings that differ from what words over the table say: key, what is set, the words with their line."""
    out = []
    for key, words in with_formula(raw.stated, settings).items():
        one = settings.get(POINT_OF if key == POINT_FROM else key)
        if key == POINT_OF and one is not None and (right := _unturned_point(raw, one, settings)):
            out.append((key, str(one.value), text_of("signs.point_not_turned", place=words.place, right=right)))
            continue
        idle = words.contradicted or not (words.offered or words.convention)
        if one is None or idle or key.startswith(("source.", "coefficients.")):
            continue
        if key == POINT_FROM:
            _, point, x = point_by_words(raw, settings)
            datum = settings.get("axes.datum")
            near = SAME_SIZE * (
                quantity(settings["scaling.length"].value, "length") if "scaling.length" in settings else 1.0
            )
            same = x is None or datum is None or not of_datum(str(datum.value), point) or abs(one.value[0] - x) <= near
        elif key == "table.centre":
            same = str(words.value) in str(one.value) if not str(one.value).startswith(("+", "-")) else True
        elif (key in SIZES and isinstance(words.value, float)) or key in BY_WORDS:
            same = _same(key, one.value, words.value, settings)
        else:
            continue
        if not same:
            phrases = str(one.value).casefold() if isinstance(one.value, bool) else str(one.value)
            out.append((POINT_OF if key == POINT_FROM else key, phrases, words.place))
    return out


def _unturned_point(raw: RawTable, one: Setting, settings: Settings) -> str:
    """The file's point in FRD, where what is set are its numbers in the file's axes; empty where it is another, or the same in both."""
    at, framed = raw.stated[POINT_OF].value, raw.stated.get(POINT_FRAME)
    frame = frame_of(settings) if framed is None or framed.contradicted else parse_axes(framed.value)
    if frame is None or not isinstance(at, tuple) or not isinstance(one.value, list):
        return ""
    own, point = np.array(at, dtype=float), np.array([quantity(x, "length") for x in one.value])
    right = frame.rotation @ own
    near = SAME_SIZE * float(np.linalg.norm(own))
    copied = own.shape == point.shape and np.all(np.abs(point - own) <= near)
    return f"{right.tolist()}" if copied and np.any(np.abs(point - right) > near) else ""


def known_length(raw: RawTable, settings: Settings) -> float | None:
    """The length of the primes, m, as a person or the file says it; None where nobody does, or the file in two ways."""
    length: Setting | Stated | None = settings.get("scaling.length") or raw.stated.get("scaling.length")
    if length is None or (isinstance(length, Stated) and length.contradicted):
        return None
    return quantity(length.value, "length")


def point_by_words(raw: RawTable, settings: Settings) -> tuple[str, str, float | None]:
    """What words over the table say of the point of the moments: as people say it, its datum, and x in m.

    Shares of the length have no x while it is open: ``-0.45 L from nose``. Empty texts where no words give a number.
    """
    given = raw.stated.get(POINT_FROM)
    if given is None:
        return "", "", None
    number, unit, named = str(given.value).split()
    datum = named.rstrip("?")
    by = 1.0 if unit == "m" else known_length(raw, settings)
    if by is None:
        return f"{number} L from {datum}", datum, None
    return f"{float(number) * by:.6g} from {datum}", datum, float(f"{float(number) * by:.12g}")


def arm_by_words(raw: RawTable, settings: Settings) -> tuple[str, str, str] | None:
    """What words over the table say of the point that R and U are measured to; None where they say nothing.

    Returns
    -------
    default, shown : str
        x, y, z from the datum; or what it will be once the reference point or the datum is known. Both empty where open.
    line : str
    """
    given = raw.stated.get(ARM_FROM)
    if given is None:
        return None
    if given.contradicted or not given.value:
        return "", "", given.contradicted or given.place
    number, unit, point = str(given.value).split()
    by = 1.0 if unit == "m" else known_length(raw, settings)
    if by is None:
        return "", "", given.place
    x = float(number) * by
    known, datum = settings.get(POINT_OF), settings.get("axes.datum")
    if point == OF_MOMENTS:
        if known is None:
            off = f"{abs(x):g} m {'forward' if x > 0.0 else 'aft'} of " * bool(x)
            return "", f"{off}the reference point", given.place
        return ", ".join(f"{a + b:.12g}" for a, b in zip(known.value, (x, 0.0, 0.0), strict=True)), "", given.place
    if datum is None:
        return "", f"{x:.12g} from {point}" if x else point, given.place
    return (f"{x:.12g}, 0, 0" if of_datum(str(datum.value), point) else ""), "", given.place


def doubtful_setting(raw: RawTable, settings: Settings, key: str) -> str:
    """Why the number of a key is probably one in another unit; empty where it is a usual one, or the file states it."""
    one = settings[key]
    sizes = {key: SIZES[key] for key in ("conditions.density", "conditions.speed", "scaling.length")}
    if key == VISCOSITY and "conditions.density" in settings:
        with suppress(InputError):
            nu, rho = quantity(one.value, "viscosity"), quantity(settings["conditions.density"].value, "density")
            return doubtful_viscosity(nu, rho)
    if key not in sizes or one.origin.startswith("stated"):
        return ""
    texts = [
        raw.path.name,
        raw.dialect.get("importer", ""),
        *(s.value for k, s in settings.items() if k.startswith(("campaign.", "source.")) and isinstance(s.value, str)),
    ]
    return doubtful_size(key, quantity(one.value, sizes[key]), speaks_of_air(texts))

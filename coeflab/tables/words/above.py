"""What words over a table say of its tests: "v = 1,5 m/s", "rho: 998.8 kg/m3", cells "L", "4.3", "m". Offered, never taken."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from coeflab.tables.dialect import Marks, Row
from coeflab.tables.half_bodies import half_in_words
from coeflab.tables.raw_table import HALF_MODEL, Stated
from coeflab.tables.vocabulary import folded
from coeflab.tables.words.axes import BODY_AXES, along_body, frame_in_words, side_of_turns, signs
from coeflab.tables.words.points import (
    ARM_FROM,
    CENTRE_FROM,
    POINT_FROM,
    arm_point,
    centre_of_gravity,
    datum_in_words,
    moments_point,
)
from coeflab.tables.words.primes import prime_basis, size_in
from coeflab.tables.words.water import APART, density_in_words, states_density, with_words_before

_NAMES = {
    "conditions.speed": "v u vm vs speed velocity towingspeed carriagespeed modelspeed uinf vinf geschwindigkeit vitesse "
    "schleppgeschwindigkeit modellgeschwindigkeit",
    "conditions.density": "rho ρ density waterdensity dichte wasserdichte densite massevolumique",
    "scaling.length": "l lpp lbp loa lwl los lua luea length modellength lange laenge modelllange modelllaenge longueur",
    "coefficients.area": "a s aref sref referencearea area flache flaeche bezugsflache bezugsflaeche surface",
    "coefficients.length": "lref cref referencelength referencechord chord bezugslange bezugslaenge",
    "inertia.mass": "m mass masse modelmass modellmasse",
    "conditions.viscosity": "nu ν viscosity kinematicviscosity viskositat viskositaet kinematischeviskositat viscosite",
}
_KEYS = {word: key for key, words in _NAMES.items() for word in words.split()}
_DIMENSIONS = {
    "conditions.speed": "speed", "conditions.density": "density", "scaling.length": "length", "coefficients.area": "area",
    "coefficients.length": "length", "inertia.mass": "mass",
    "conditions.viscosity": "viscosity",
}  # fmt: skip
_LENGTHS = ("lpp", "lbp", "loa", "lwl", "los")
_STATED = re.compile(
    r"(?P<name>[^\W\d_](?:[^=:;,()\[\]]{0,39}?[^=:;,()\[\]\s])?)\s*(?:[\[(](?P<before>[^\[\]()]{1,12})[\])]\s*)?(?:=|:)\s*"
    r"(?P<number>[-+]?\d[\d.,' ]*(?:[eE][-+]?\d+)?)\s*[\[(]?(?P<unit>(?:[^\W\d]|[°µ])[^\s,;=\[\])]*)?"
)
_BROAD = r"diam(?:eter|[èe]tre)?|durchmesser|chord|profiltiefe|corde|breadth|beam|breite|largeur|width"
_SYMBOL = r"(?:\s*(?:\([^()]{1,20}\)|\b[A-Za-z]\w{0,4}\b))?\s*(?:=|:|\bof\b|\bis\b|\bvon\b|\bist\b|\bde\b)?\s*"
_SIZES = {
    key: re.compile(
        rf"(?i)(?<![^\W_])(?P<name>{words}){_SYMBOL}(?P<number>\d[\d.,]*)\s*[\[(]?(?P<unit>{unit})(?![^\W_])(?:[\])]?\s*\([^()]{{1,30}}\)"
        rf"|,?\s*(?:(?:the|its|hull|body|model|max\w*|der|le)\s+){{0,3}}(?:{_BROAD})(?![^\W_]|\s*(?:[=:(\d]|\w{{1,3}}\s*=)))?"
    )
    for key, words, unit in (
        ("coefficients.length", r"(?:reference|ref\.?)[\s-]*(?:length|chord)|(?:mean\s+(?:aerodynamic\s+)?)?chord(?:\s+length)?|[lc]_?ref"
         r"|bezugsl(?:ä|ae)nge|profiltiefe|longueur\s+de\s+r[ée]f[ée]rence|corde", "mm|cm|m|ft|in"),
        ("scaling.length", r"overall\s+length|length\s+over\s*all|l_?(?:oa|pp|bp|wl)|l(?:ä|ae)nge\s+(?:ü|ue)ber\s+alles|gesamtl(?:ä|ae)nge"
         r"|longueur\s+hors\s+tout|(?:model|hull|body)\s+length|(?:modell|rumpf)l(?:ä|ae)nge", "mm|cm|m|ft|in"),
        ("coefficients.area", r"(?:reference|ref\.?)[\s-]*area|[as]_?ref|(?:bezugs|referenz)fl(?:ä|ae)che|surface\s+de\s+r[ée]f[ée]rence", r"m\^?2|m²|cm\^?2|cm²|ft\^?2"),
        ("conditions.speed", r"(?:(?:carriage|towing|tow|model|test|ship|vehicle|water)\s+)?speed(?!\s+(?:above|below|over|under|up|range|from))"
         r"|(?:schlepp|modell|wagen|fahr)geschwindigkeit|vitesse\s+de\s+(?:remorquage|traction)", "m/s|kn|km/h"),
        ("inertia.mass", r"(?:model\s+)?mass(?:e?\s+of\s+the\s+model)?|(?:modell)?masse(?:\s+du\s+mod[èe]le)?", "kg|t"),
    )
}  # fmt: skip
_OF_A_PART = re.compile(
    r"(?i)(?:rudder|fin|hydroplane|propeller|elevator|ruder|flosse|gouvernail)s?['’]?s?\s+$"
)  # a wing's is that of its model
_ANOTHER_SPEED = re.compile(r"(?i)(?:wind|shaft|sound|propeller|rotor|tip|angular|rotation\w*|air|turn\w*)\s+$")
_SEVERAL = re.compile(r"(?i)\s*(?:,|/|and|und|et|to|bis|or|oder)\s*\d[\d.,]*\s*(?:m/s|kn|km/h)?")
_BY_VOLUME = re.compile(
    r"(?i)(?<![^\W_])(?:V|∇|vol(?:umen?|ume)?|displacement|verdr(?:ä|ae)ngung)\s*(?:\^|\*\*|hoch)?\s*[({]?\s*[12]\s*/\s*3|∇\s*⅔|V⅔"
)
_OVERALL = re.compile(r"(?i)over\s*all|über\s+alles|ueber\s+alles|gesamt|hors|l_?oa")
_ACROSS = re.compile(rf"(?i)(?<![^\W_])(?:{_BROAD})(?![^\W_])|\bc_?ref")
_INERTIA = re.compile(
    r"(?i)(?<!moment of )(?<!moments of )(?<![^\W_])(?:inertia\w*|(?:model\s+)?mass(?:e|es)?|mass\s+forces?|(?:massen|modell)?tr(?:ä|ae)gheit\w*"
    r"|massenkr(?:ä|ae)ft\w*|modellmasse|inertie\w*)(?![^\W_])"
)
_TAKEN_OR_HELD = re.compile(
    r"(?i)(?<![^\W_])(?P<un>un|non-?|in)?(?:(?P<taken>correct(?:ed|ions?)|subtracted|removed|deducted|compensated|korrigiert|korrektur|abgezogen"
    r"|bereinigt|herausgerechnet|entfernt|eliminiert|eliminated|corrig[ée]e?s?|corrections?|soustrait\w*|d[ée]duit\w*)|(?P<held>inclu(?:ded?|des|ding)|contain(?:s|ed|ing)?|enth(?:alten|ält)|inklusive|inkl|incl|samt|einschlie(?:ß|ss)lich"
    r"|inclus\w*|comprise?s?|contien\w+))(?![^\W_])"
)
_NOT = re.compile(r"(?i)(?<![^\W_])(?:not|no|never|without|nicht|keine?\w*|ohne|sans|pas|non|aucune?)(?![^\W_])|n't\b")
_FREE_OF = re.compile(
    rf"(?i)(?<![^\W_])(?:without|free\s+of|ohne|sans)\s+(?:the\s+|model\W?s?\s+|own\s+|l')*{_INERTIA.pattern[4:]}(?!\s*korrekt|\s+correct)"
)
_WITH = re.compile(rf"(?i)(?<![^\W_])(?:with|mit|avec)\s+(?:the\s+|model\W?s?\s+|own\s+|l')*{_INERTIA.pattern[4:]}")
LONGEST = 500
POINTED = Marks()
_KINDS = {
    "cfd": r"cfd|rans\w*|open\s?foam|star-?ccm\+?|fluent|cfx|su2|simulation|k-?omega|k-?epsilon|sst",
    "experiment": r"tow(?:ing)?[- ]tank|basin|tank|rotating[- ]arm|experiment\w*|measure[dm]\w*|wind[- ]?tunnel|schlepp\w*|versuch\w*|"
    r"messung\w*|drehkran\w*|rundlauf\w*|bassin|essais?|mesur\w*",
    "synthetic": r"synthetic|synthetisch|synth[ée]tique|invented",
}


def words_above(rows: Iterable[Row], marks: Marks) -> dict[str, Stated]:
    """What rows over the names of a table say of keys of campaign.toml.

    Parameters
    ----------
    rows : iterable of (line, cells)
        A line of text is one cell.
    marks : Marks
        Of the numbers below.

    Returns
    -------
    dict of str to Stated
        Offered: somebody has to confirm them. In SI. A key that two lines say differently is `contradicted`. A single
        letter without a unit that fits is left out. `BODY_AXES` where the words say that forces count along the body.
    """
    rows = list(rows)
    found, volume = dict[str, Stated](), ""
    for line, cells in rows:
        if (whole := " ".join(c for c in cells if c)[:LONGEST]) and (body := along_body(f"line {line}", whole)):
            found.setdefault(BODY_AXES, body)
        if m := _BY_VOLUME.search(whole):
            volume = f'line {line}: "{with_words_before(whole, *m.span())}"'
        for key, name, size, part in (
            one for t in dict.fromkeys(t[:LONGEST] for t in _pairs(cells)) for one in _sizes(t, marks)
        ):
            place = f'line {line}: "{" ".join(part.split())}"'
            if key in found and abs(float(str(found[key].value)) / size - 1.0) > 1e-9:
                against = found[key].contradicted or f"{found[key].place}, but {place}"
                found[key] = replace(found[key], contradicted=against)
            found.setdefault(key, Stated(size, place, offered=True))
            if name in _LENGTHS:
                found.setdefault("scaling.length_name", Stated(name.upper(), place, offered=True))
    if "scaling.length" not in found and (by := found.get("coefficients.length")) and (m := _ACROSS.search(by.place)):
        against = f"{by.place} is a {m[0]}, perhaps not the body's length"
        found["scaling.length"] = replace(by, contradicted=against)
    if volume:
        against = f"{volume} speaks of primes by the volume V: for these the length is V^(1/3)"
        length = found.get("scaling.length", Stated("", volume, offered=True))
        found["scaling.length"] = replace(length, contradicted=against)
    phrases = of_the_test(((f"line {line}", _sentence(cells)[:LONGEST]) for line, cells in rows), marks)
    phrases |= prime_basis(((f"line {line}", " ".join(c for c in cells if c)[:LONGEST]) for line, cells in rows), marks)
    water = phrases.get("conditions.density")
    own = found.pop("conditions.density", None)
    if own and not (water and states_density(water.place)):  # a number without a unit, or in another one
        far = water is not None and abs(float(str(own.value)) / float(str(water.value)) - 1.0) > APART
        against = f"{own.place}, but {water.value} by {water.place}" if water and far else ""
        phrases["conditions.density"] = replace(own, contradicted=against)
    return phrases | found


def of_the_test(texts: Iterable[tuple[str, str]], marks: Marks = POINTED) -> dict[str, Stated]:
    """What words say of the water, the kind of the source, the axes and the point of the moments; offered.

    Parameters
    ----------
    texts : iterable of (place, text)
        Such as lines over a table with their numbers, or a file's name.
    marks : Marks
        Of the numbers.
    """
    found: dict[str, Stated] = {}
    texts = list(texts)
    for place, text in texts:
        for kind, words in _KINDS.items():
            if m := re.search(rf"(?i)(?<![^\W_])(?:{words})(?![^\W_])", text):
                found.setdefault("source.kind", Stated(kind, f'{place}: "{" ".join(m[0].split())}"', offered=True))
        if where := moments_point(place, text, marks):
            if "axes.datum" not in found:
                found |= {key: one for key, one in where.items() if key not in found}
            if (one := found.get(POINT_FROM)) and (other := where.get(POINT_FROM, one)).value != one.value:
                found[POINT_FROM] = replace(one, contradicted=f"{one.place}, but {other.place}")
        elif datum := datum_in_words(place, text):
            found.setdefault("axes.datum", datum)
        for key, given in _of_the_turn(place, text, marks):
            one = found.setdefault(key, given)
            if one.value != given.value and not one.contradicted:
                found[key] = replace(one, contradicted=f"{one.place}, but {given.place}")
    if half := half_in_words(texts):
        found[HALF_MODEL] = half
    if density := density_in_words(texts, marks):
        found["conditions.density"] = density
    if frame := frame_in_words(texts):
        found["axes.frame"] = frame
    return found


def _of_the_turn(place: str, text: str, marks: Marks) -> Iterator[tuple[str, Stated]]:
    """What a line says of a rotating test: whether forces hold inertia, where its mass lies, to which side it turns."""
    for clause in re.split(r"[;:]|,\s|\.\s", text):
        phrases = set(_holds_inertia(clause))
        if phrases:
            where = f'{place}: "{" ".join(clause.split())}"'
            yield (
                "table.contains_inertia",
                Stated(True in phrases, where, True, f"{where} says both" * (len(phrases) == 2)),
            )
    yield from signs(place, text)
    if arm := arm_point(place, text, marks):
        yield ARM_FROM, arm
    if side := side_of_turns(place, text):
        yield "table.centre", side
    if centre := centre_of_gravity(place, text, marks):
        yield CENTRE_FROM, centre


def _holds_inertia(clause: str) -> Iterator[bool]:
    """Whether a clause says that forces hold the model's inertia: "not subtracted", "included"; nothing where it says neither."""
    if not _INERTIA.search(clause):
        return
    verbs = list(_TAKEN_OR_HELD.finditer(clause))
    if not verbs and (m := _WITH.search(clause)):
        yield not re.search(r"(?i)[ck]orr", m[0])  # mit Trägheitskorrektur
        return
    if not verbs and _FREE_OF.search(clause):
        yield False
    begin = 0
    for m in verbs:
        negated = bool(m["un"]) or bool(_NOT.search(clause, begin, m.start()))
        begin = m.end()
        yield bool(m["held"]) != negated


def _sentence(cells: Sequence[str]) -> str:
    """Cells as the sentence that the delimiter split, with a comma between words and none beside a number of its own cell."""
    out = ""
    for before, cell in pairwise(["", *(c for c in cells if c)]):
        worded = all(any(map(str.isalpha, c)) for c in (before, cell))
        out += (", " if worded else " " if out else "") + cell
    return out


def _pairs(cells: Sequence[str]) -> Iterable[str]:
    """The texts of a row of cells that may say something: with its own sign, or a name, a number and a unit side by side."""
    yield " ".join(c for c in cells if c)
    for i, (name, number) in enumerate(pairwise(cells)):
        if name and name[0].isalpha() and number[:1].strip("+-").isdigit() | number[1:2].isdigit():
            unit = cells[i + 2] if i + 2 < len(cells) else ""
            yield f"{name.rstrip(' =:')} = {number} {unit}"


def _sizes(text: str, marks: Marks) -> Iterator[tuple[str, str, float, str]]:
    """Key, name, number in SI and words of what a text states with a sign, and of lengths that it states without one."""
    lengths = [(key, m) for key, words in _SIZES.items() for m in words.finditer(text)]
    for key, m in lengths:
        if key == "conditions.speed" and (_ANOTHER_SPEED.search(text[: m.start()]) or _SEVERAL.match(text[m.end() :])):
            continue
        if key == "coefficients.area" and _OF_A_PART.search(text[: m.start()]):
            continue
        if size := size_in(m["number"], m["unit"] or "", _DIMENSIONS[key], marks):
            short = folded(m["name"])
            overall = key == "scaling.length" and _OVERALL.search(m["name"])
            name = short if short in _LENGTHS else "loa" if overall else ""
            yield key, name, size, m[0]
    spans = [m.span() for _, m in lengths]
    for m in _STATED.finditer(text):
        words = m["name"].split()
        name = next((f for w in (m["name"], words[-1], words[0]) if (f := folded(w)) in _KEYS), "")
        unit = (m["before"] or m["unit"] or "").strip(" .;")
        begun = any(begin < m.end("number") <= end for begin, end in spans)
        if not name or begun or (not unit and len(name) == 1):
            continue
        if size := size_in(m["number"], unit, _DIMENSIONS[_KEYS[name]], marks):
            yield _KEYS[name], "loa" if name in ("lua", "luea") else name, size, m[0]

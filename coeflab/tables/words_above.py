"""What words over a table say of its tests: "v = 1,5 m/s", "rho: 998.8 kg/m3", cells "L", "4.3", "m". Offered, never taken."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from itertools import pairwise

from coeflab.core.errors import InputError
from coeflab.core.units import quantity
from coeflab.tables.column_map import folded
from coeflab.tables.dialect import Marks, Row
from coeflab.tables.raw_table import Stated

_NAMES = {
    "conditions.speed": "v u vm vs speed velocity towingspeed carriagespeed modelspeed uinf vinf geschwindigkeit vitesse "
    "schleppgeschwindigkeit modellgeschwindigkeit",
    "conditions.density": "rho ρ density waterdensity dichte wasserdichte densite massevolumique",
    "scaling.length": "l lpp lbp loa lwl los length modellength lange laenge modelllange modelllaenge longueur",
    "coefficients.area": "a s aref sref referencearea area flache flaeche bezugsflache bezugsflaeche surface",
    "coefficients.length": "lref referencelength bezugslange bezugslaenge",
    "inertia.mass": "m mass masse modelmass modellmasse",
}
_KEYS = {word: key for key, words in _NAMES.items() for word in words.split()}
_DIMENSIONS = {
    "conditions.speed": "speed", "conditions.density": "density", "scaling.length": "length", "coefficients.area": "area",
    "coefficients.length": "length", "inertia.mass": "mass",
}  # fmt: skip
_LENGTHS = ("lpp", "lbp", "loa", "lwl", "los")
_SAID = re.compile(
    r"(?P<name>[^\W\d_][^=:;,()\[\]]{0,40}?)\s*(?:[\[(](?P<before>[^\[\]()]{1,12})[\])])?\s*(?:=|:)\s*"
    r"(?P<number>[-+]?\d[\d.,' ]*(?:[eE][-+]?\d+)?)\s*[\[(]?(?P<unit>(?:[^\W\d]|[°µ])[^\s,;=\[\])]*)?"
)
LONGEST = 500
BODY_AXES = "forces.axes"  # no key of campaign.toml: the words say that forces count along the body
_BODY = re.compile(
    r"(?i)\b(?:k(?:ö|oe|o)rper|schiffs|boots|modell)fest|\b(?:body|ship|hull|vessel)[- ]?(?:fixed|axes|axis|frame)\b"
    r"|\brep[èe]re\s+(?:li[ée]|du\s+(?:corps|navire))\b|\baxes\s+li[ée]s\b"
)


def _number(text: str, marks: Marks) -> float | None:
    """The one reading of a number; None where it has two, 1,025 with a decimal comma and with thousands."""
    plain = text.strip().rstrip(",.")
    for decimal in (marks.decimal, *({".", ","} - {marks.decimal})):
        value = Marks(decimal).number(plain)
        if value is not None:
            certain = decimal == marks.decimal or not re.fullmatch(r"[-+]?[1-9]\d{0,2}[.,]\d{3}", plain)
            return value if certain else None
    return None


def _pairs(cells: Sequence[str]) -> Iterable[str]:
    """The texts of a row of cells that may say something: with its own sign, or a name, a number and a unit side by side."""
    yield " ".join(c for c in cells if c)
    for i, (name, number) in enumerate(pairwise(cells)):
        if name and name[0].isalpha() and number[:1].strip("+-").isdigit() | number[1:2].isdigit():
            unit = cells[i + 2] if i + 2 < len(cells) else ""
            yield f"{name.rstrip(' =:')} = {number} {unit}"


def _around(text: str, found: re.Match[str]) -> str:
    """The part between commas that holds what was found."""
    begin = max(text.rfind(mark, 0, found.start()) for mark in ",;:") + 1
    ends = [at for mark in ",;:" if (at := text.find(mark, found.end())) >= 0]
    return " ".join(text[begin : min(ends, default=len(text))].split())


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
        Offered: somebody has to confirm them. In SI. A key that two lines say differently is left out, and so is a single
        letter without a unit that fits. `BODY_AXES` where the words say that forces count along the body.
    """
    found: dict[str, Stated] = {}
    twice: set[str] = set()
    for line, cells in rows:
        if (whole := " ".join(c for c in cells if c)[:LONGEST]) and (body := _BODY.search(whole)):
            found.setdefault(BODY_AXES, Stated("body", f'line {line}: "{_around(whole, body)}"', offered=True))
        for text in dict.fromkeys(t[:LONGEST] for t in _pairs(cells)):
            for m in _SAID.finditer(text):
                words = m["name"].split()
                name = next((f for w in (m["name"], words[-1], words[0]) if (f := folded(w)) in _KEYS), "")
                value = _number(m["number"], marks)
                if not name or value is None:
                    continue
                key, unit = _KEYS[name], (m["before"] or m["unit"] or "").strip(" .;")
                if not unit and len(name) == 1:
                    continue
                try:
                    size = quantity(f"{value!r} {unit}" if unit else value, _DIMENSIONS[key])
                except InputError:
                    continue
                if not size > 0.0:
                    continue
                place = f'line {line}: "{" ".join(m[0].split())}"'
                if key in found and abs(float(str(found[key].value)) / size - 1.0) > 1e-9:
                    twice.add(key)
                found.setdefault(key, Stated(size, place, offered=True))
                if name in _LENGTHS:
                    found.setdefault("scaling.length_name", Stated(name.upper(), place, offered=True))
    return {key: one for key, one in found.items() if key not in twice}

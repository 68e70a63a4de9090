"""What words over a table say that its coefficients were divided by: "0.5 rho Lpp T U^2", "bezogen auf L·T", "surface mouillée 1,2 m²".

`BASIS` is the area as a product of sizes, ``L T`` or ``V^(2/3)`` or ``wetted``; `SIZES` are the sizes of the body that words give beside
the length: draught, breadth, diameter, volume, wetted and frontal area.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.units import quantity
from coeflab.tables.dialect import Marks, one_reading
from coeflab.tables.raw_table import Stated

SCALE = "model.scale"  # no key of campaign.toml: the ship over its model
_SCALE = re.compile(
    r"(?i)(?<![^\W_])(?:(?:model\s+)?scale(?:\s+(?:factor|ratio))?|λ|lambda|ma(?:ß|ss)stab|[ée]chelle)\s*(?:\([^()]{1,12}\)\s*)?(?:=|:|of|is)?\s*"
    r"(?:1\s*[:/]\s*)?(?P<scale>[1-9]\d{0,3}(?:[.,]\d{1,4})?)(?![\d:/%]|\s*(?:kN|N|m|deg|m/s)\b)"
)
BASIS = "basis.area"  # no key of campaign.toml: what the source's coefficients were divided by, beside 1/2 rho U^2
LEVER = "basis.lever"  # no key: the length beside that area by which moments were divided
# Sizes by their letters and areas by their names: dimension, letters, words.
_OF_BODY = {
    "T": ("draught", "length", r"T", r"draughts?|drafts?|tiefgang|tirant\s+d['’]eau"),
    "B": ("breadth", "length", r"B", r"breadth|beam|breite|largeur|bau"),
    "D": ("diameter", "length", r"[Dd]", r"(?:max(?:imum)?\.?\s+|hull\s+)?diam(?:eter|[èe]tre)|(?:rumpf)?durchmesser"),
    "V": ("volume", "volume", r"V|∇", r"volume|volumen|displaced\s+volume|verdr(?:ä|ae)ngung(?:svolumen)?|volume\s+de\s+car[èe]ne|∇|nabla"),
    "wetted": ("wetted_area", "area", r"S_?w(?:et)?", r"wetted\s+(?:surface|area)(?:\s+area)?|benetzte\s+(?:ober)?fl(?:ä|ae)che|surface\s+mouill[ée]e"),
    "frontal": (
        "frontal_area", "area", r"A_?f", r"frontal\s+area|(?:cross|mid(?:ship)?)[\s-]*section(?:al\s+area|\s+area)?|stirnfl(?:ä|ae)che"
        r"|spantfl(?:ä|ae)che|hauptspant\w*|querschnittsfl(?:ä|ae)che|ma[îi]tre[\s-]couple|surface\s+frontale|section\s+transversale",
    ),
    "lateral": (
        "lateral_area", "area", r"A_?l(?:at)?",
        r"lateral\s+area|planform\s+area|projected\s+area|lateralfl(?:ä|ae)che|projizierte\s+fl(?:ä|ae)che|surface\s+lat[ée]rale|plan\s+lat[ée]ral",
    ),
}  # fmt: skip
SIZES = {name: f"basis.{what}" for name, (what, *_) in _OF_BODY.items()}
_UNITS = {"length": r"mm|cm|m|ft|in", "volume": r"m\^?3|m³|l|cm\^?3", "area": r"m\^?2|m²|cm\^?2|cm²|ft\^?2"}
_SIZE = {
    name: re.compile(
        rf"(?<![^\W_])(?:(?i:{words})(?:\s+\(?(?:{letters})\)?)?|(?:{letters})(?=\s*[=:]))"
        rf"\s*(?:=|:|\bof\b|\bis\b|\bvon\b|\bde\b)?\s*(?P<number>\d[\d.,]*)\s*[\[(]?(?P<unit>{_UNITS[dimension]})(?![^\W_])"
    )
    for name, (_, dimension, letters, words) in _OF_BODY.items()
}
_RAISED = r"(?:\s*(?:\^|\*\*)?\s*[({]?\s*(?P<power>2\s*/\s*3|[123])\s*[)}]?|(?P<small>[²³]))?"
# One factor of a product: a length by its name, a size, the speed.
_FACTOR = re.compile(
    rf"(?:\s+x\s+|[\s*·×⋅]*)(?P<name>L(?:_?(?:pp|PP|BP|bp|oa|OA|wl|WL|os|OS|ua))?|l|T|[Dd]|B|∇|nabla|[Vv]ol(?:umen?)?"
    rf"|[UVSA](?:_?[a-z]{{1,4}}|_[A-Z][A-Za-z]{{0,3}}|_0)?)"
    rf"(?![a-z]){_RAISED}"
)
_HEAD = re.compile(
    r"(?:0?[.,]5|1\s*/\s*2|½)\s*\)?\s*[*·×⋅]?\s*(?:rho|ρ|Rho)(?![a-z])|(?:rho|ρ)\s*/\s*2(?![\d.])|(?:0?[.,]5|½)(?=\s*[*·×⋅]?\s*(?:density|dichte))"
    r"|(?<![\d.^])2\s*[*·×⋅]?\s*(?:[XYZKMN]|F_?[xyz]?|M_?[xyz])\s*/\s*\(?\s*(?:rho|ρ|Rho)(?![a-z])"  # Y' = 2 Y / (rho U^2 L T)
)
_SAYS_BY = re.compile(
    r"(?i)(?:non-?dimensional\w*|dimensionless|normali[sz]ed|made\s+dimensionless|divided|based|referred|coefficients?|primes?|entdimensioniert|bezogen|dimensionslos"
    r"|normiert|adimensionn\w*|rapport[ée]\w*|coefficients?)[^.;]{0,40}?(?<![^\W_])(?:by|with|on|to|auf|mit|durch|par|à|avec|area)\s+(?:the\s+|die\s+|der\s+|la\s+|le\s+)?"
)
_AREA_IS = re.compile(
    r"(?i)(?:reference\s+area|(?:referenz|bezugs)fl(?:ä|ae)che|surface\s+de\s+r[ée]f[ée]rence)\s*(?:=|:|\bis\b|\bist\b|\best\b)?\s*(?:the\s+|die\s+|la\s+)?"
)
# The prime system II of SNAME has L T for an area; the bis system divides by the mass.
_SYSTEM = (
    (re.compile(r"(?i)\bprime(?:[\s-]*system)?[\s-]*(?:II|2)\b"), "L T"),
    (re.compile(r"(?i)\bbis[\s-]*system\b"), "mass"),
)
LONGEST = 60


def prime_basis(texts: Iterable[tuple[str, str]], marks: Marks) -> dict[str, Stated]:
    """What texts say of the area of coefficients, under `BASIS`, and of sizes of the body, under the keys of `SIZES`; offered.

    Parameters
    ----------
    texts : iterable of (place, text)
    marks : Marks
        Of the numbers.

    Examples
    --------
    >>> found = prime_basis([("line 1", "coefficients by 0.5 rho Lpp T U^2, draught 0.25 m")], Marks())
    >>> found["basis.area"].value, found["basis.draught"].value
    ('L T', 0.25)
    """
    out: dict[str, Stated] = {}
    for place, text in texts:
        for name, pattern in _SIZE.items():
            if (m := pattern.search(text)) and (size := size_in(m["number"], m["unit"], _OF_BODY[name][1], marks)):
                out.setdefault(SIZES[name], Stated(size, f'{place}: "{" ".join(m[0].split())}"', offered=True))
        if m := _SCALE.search(text):
            out.setdefault(
                SCALE, Stated(float(m["scale"].replace(",", ".")), f'{place}: "{" ".join(m[0].split())}"', offered=True)
            )
        areas = [*_of_formulas(text)] or [*filter(None, [_of_sentence(text)])]
        levers = _of_formulas(text, areas[0][0]) if areas else ()
        for key, found in (*((BASIS, a) for a in areas), *((LEVER, one) for one in levers)):
            given = Stated(found[0], f'{place}: "{" ".join(found[1].split())}"', offered=True)
            before = out.setdefault(key, given)
            if before.value != given.value and not before.contradicted:
                out[key] = Stated(before.value, before.place, True, f"{before.place}, but {given.place}")
    return out


def size_in(number: str, unit: str, dimension: str, marks: Marks) -> float:
    """A number above zero in SI; zero where it has none, or two readings."""
    value = one_reading(number, marks)
    plain = unit.replace("²", "^2").replace("³", "^3")
    if value is not None and dimension == "volume":
        return max(value * {"l": 1e-3, "cm3": 1e-6, "cm^3": 1e-6}.get(plain, 1.0), 0.0)
    try:
        return 0.0 if value is None else max(quantity(f"{value!r} {plain}" if plain else value, dimension), 0.0)
    except InputError:
        return 0.0


def _of_formulas(text: str, area: str = "") -> Iterator[tuple[str, str]]:
    """Areas in ``1/2 rho U^2 L T``, of forces, by every formula of a text; beside an area the lengths in ``1/2 rho U^2 L^2 T``, of moments."""
    for head in _HEAD.finditer(text):
        factors, end = _product(text, head.end())
        speeds = [(n, p) for n, p in factors if n in ("U", "V") and p == "2"]
        if not speeds:
            continue
        rest = list(factors)
        rest.remove(next((s for s in speeds if s[0] == "U"), speeds[0]))
        if found := _lever(rest, area) if area else _basis(rest):
            yield found, text[head.start() : end]


def _lever(factors: list[tuple[str, str]], area: str) -> str:
    """What a product has beside an area, a length: ``D``, ``V^(1/3)``; empty where it is none."""
    if area == "V^(2/3)" and factors == [("V", "")]:
        return "V^(1/3)"
    own = next((k for k in range(len(factors)) if area and _basis(factors[k : k + 1]) == area), None)
    if own is not None:
        rest = [n for k, (n, p) in enumerate(factors) if k != own for _ in range(int(p) if p.isdigit() else 1)]
    else:
        rest = [n for n, p in factors for _ in range(int(p) if p.isdigit() else 1)]
        for name in area.split():
            if name not in rest:
                return ""
            rest.remove(name)
    return rest[0] if len(rest) == 1 and rest[0] in "LTBD" else ""


def _of_sentence(text: str) -> tuple[str, str] | None:
    """The area in ``bezogen auf L·T`` and ``coefficients by the wetted area``."""
    for head in (*_SAYS_BY.finditer(text), *_AREA_IS.finditer(text)):
        for name in ("wetted", "frontal", "lateral"):
            if m := re.compile(rf"(?i)(?:{_OF_BODY[name][3]})").match(text, head.end()):
                return name, text[head.start() : m.end()]
        factors, end = _product(text, head.end())
        if (len(factors) > 1 or any(p for _, p in factors)) and (basis := _basis(factors)):
            return basis, text[head.start() : end]
    return next(((basis, m[0]) for system, basis in _SYSTEM if (m := system.search(text))), None)


def _product(text: str, at: int) -> tuple[list[tuple[str, str]], int]:
    """Factors with their powers, and where they end."""
    out: list[tuple[str, str]] = []
    begun = at
    while at - begun < LONGEST and (m := _FACTOR.match(text, at)):
        power = (m["power"] or {"²": "2", "³": "3"}.get(m["small"] or "", "")).replace(" ", "")
        name = m["name"]
        plain = (
            "L" if name[0] in "Ll" else "D" if name in "Dd" else "V" if name[0] in "∇n" or name.lower().startswith("vol")
            else "U" if name[0] == "U" else "V" if name[0] == "V" else name
        )  # fmt: skip
        out.append((plain, power))
        at = m.end()
    return out, at


def _basis(factors: list[tuple[str, str]]) -> str:
    """A product that is an area, as text: ``L L``, ``L T``, ``V^(2/3)``, ``wetted``; empty where it is none, as of moments."""
    lengths: list[str] = []
    for name, power in factors:
        if name in ("L", "T", "B", "D"):
            lengths += [name] * int(power or 1) if power in ("", "1", "2", "3") else [""] * 9
        elif name == "V" and power == "2/3":
            return "V^(2/3)" if len(factors) == 1 else ""
        elif name[0] in "SA" and power in ("", "1"):
            low = name.lower().lstrip("sa_")
            kind = (
                "wetted"
                if name[0] == "S" or low.startswith("w")
                else "frontal"
                if low.startswith("f")
                else "lateral"
                if low.startswith("l")
                else "area"
            )
            return kind if len(factors) == 1 else ""
        else:
            return ""
    return " ".join(sorted(lengths, key="LTBD".index)) if len(lengths) == 2 and "" not in lengths else ""


def length_of(lever: str, sizes: Mapping[str, float]) -> float | None:
    """The length of a lever, m, from sizes by their letters; None where it is not known.

    Examples
    --------
    >>> length_of("V^(1/3)", {"V": 0.125})
    0.5
    """
    if lever == "V^(1/3)":
        return float(np.cbrt(sizes["V"])) if "V" in sizes else None
    return sizes.get(lever)


def area_of(basis: str, sizes: Mapping[str, float]) -> float | None:
    """The area of a basis, m^2, from sizes by their letters; None where one is not known.

    Examples
    --------
    >>> area_of("L T", {"L": 4.0, "T": 0.25})
    1.0
    """
    if basis == "V^(2/3)":
        return sizes["V"] ** (2.0 / 3.0) if "V" in sizes else None
    factors = basis.split()
    if not factors or any(f not in sizes for f in factors):
        return None
    out = 1.0
    for f in factors:
        out *= sizes[f]
    return out

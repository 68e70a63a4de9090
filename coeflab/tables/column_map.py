"""What one column of a file is, in a few words of a person: ``Y [N]``, ``-beta [deg]``, ``N [coefficient A=1.2 m^2 L=4 m]``."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Annotated, Any

from coeflab.core.declarations import Takes
from coeflab.core.errors import InputError, UnitsError, shown
from coeflab.core.texts import input_error
from coeflab.core.units import SI, factor, quantity
from coeflab.law.symbols import ANGULAR, COMPONENTS, CONTROLS, LINEAR, MOMENTS
from coeflab.tables.vocabulary import did_you_mean, one_name, vocabulary

WORDS = ("label", "point", "cells", "uncertain", "ignore")
WIND = {"drag": "X", "side": "Y", "lift": "Z"}  # along and across the flow, with the body axis whose scale they share
FORCES = (*COMPONENTS, *WIND)
ANGLES = ("alpha", "beta")
PROPELLER = {"rps": "rate", "J": "none", "thrust": "force"}  # what a propeller ran at, by its dimension
SETTINGS = ("angle", "velocity", "speed", "control", "radius")  # roles of what a run is made at
ROLES = {
    **dict.fromkeys(ANGLES, "angle"),
    "U": "speed",
    "R": "radius",
    "density": "density",
    **dict.fromkeys((*LINEAR, *ANGULAR), "velocity"),
    **dict.fromkeys(CONTROLS, "control"),
    **dict.fromkeys(FORCES, "force"),
    **dict.fromkeys(PROPELLER, "propeller"),
    **dict.fromkeys(WORDS, "word"),
}
DIMENSIONS = {
    **dict.fromkeys((*ANGLES, *CONTROLS), "angle"),
    **dict.fromkeys((*LINEAR, "U"), "speed"),
    **dict.fromkeys(ANGULAR, "rate"),
    "R": "length",
    "density": "density",
    **PROPELLER,
    **{c: "moment" if c in MOMENTS else "force" for c in FORCES},
}
EXAMPLES = {
    "angle": "deg", "speed": "m/s", "rate": "deg/s", "force": "N", "moment": "N*m", "length": "m", "density": "kg/m^3", "none": "-",
}  # fmt: skip
EXPECTED = (
    'what the column is, such as "Y [N]", "-beta [deg]", "r\' [-]", "se_N [N*m]", "Y [coefficient A=1.2 m^2]", '
    f"{', '.join(WORDS)}"
)
_ENTRY = re.compile(
    r"(?P<sign>[-+\u2212]?)\s*(?P<error>se_)?(?P<name>[A-Za-z]\w*)(?P<prime>['\u2032\u2019]?)"
    r"\s*(?:\[(?P<unit>[^\[\]]*)\])?"
)
_COEFFICIENT = re.compile(r"coefficient(?:[\s,]+A\s*=\s*(?P<area>.+?))?(?:[\s,]+L\s*=\s*(?P<length>.+?))?")
_SHIP = re.compile(r"(?P<unit>\S+)\s+ship\s+(?P<scale>[1-9]\d{0,3}(?:\.\d+)?)")  # of a model, 1 to 9999
_PER_SPEED = re.compile(
    r"(?P<unit>k?N(?:[\s*·.]?m)?|lbf)(?:[\s*·.]*s(?:\^|\*\*)?[2²](?:\s*/\s*\(?m(?:\^|\*\*)?[2²]\)?|[\s*·.]*m(?:\^-2|\*\*-2|⁻²))|\s*/\s*\(m/s\)(?:\^2|\*\*2|²))"
)
_LONGEST = 120
ACROSS = {"drag": "along", "lift": "across", "side": "across"}
OPEN_SIZES = "coefficient"  # of a column whose area, and length, are said for all of them
PER = {"force": "coefficient A=1.2 m^2", "moment": "coefficient A=1.2 m^2 L=4.26 m"}


@dataclass(frozen=True, slots=True)
class ColumnMap:
    """What one column is.

    Attributes
    ----------
    name : str
        One of alpha beta U R density u v w p q r dr ds db X Y Z K M N lift drag side, rps J thrust of a propeller, or label, point,
        cells, uncertain, ignore.
    unit : str
        Of the column; empty for the one that its file states, ``-`` for a prime or a coefficient, or what a prime is counted
        in, such as ``1e-3``; of a label the one level whose rows count, ``label [0.8]``.
    negative : bool
        Whether the column has the opposite sign.
    primed : bool
        Made dimensionless by the campaign's length, density and speed.
    error : bool
        The standard error of the force or moment, not the force itself.
    area : float
        m^2, of a coefficient by 1/2 rho U^2 A (moments: A L); 0 for no coefficient.
    length : float
        m, of a coefficient of a moment.
    ship : float
        Scale of the model beside a speed of the ship: U is the column over its root (Froude); 0 for the speed of the model.
    per_speed : bool
        A force over the square of the speed, ``X [N s^2/m^2]``; the unit is that of the force, over m/s.
    """

    name: str
    unit: str = ""
    negative: bool = False
    primed: bool = False
    error: bool = False
    area: float = 0.0
    length: float = 0.0
    ship: float = 0.0
    per_speed: bool = False

    @property
    def role(self) -> str:
        """angle, speed, radius, density, velocity, control, force, error, propeller or word."""
        return "error" if self.error else ROLES[self.name]

    @property
    def plain(self) -> str:
        """Plain name, with ``se_`` for a standard error."""
        return f"se_{self.name}" if self.error else self.name

    @property
    def dimension(self) -> str:
        """Key of `coeflab.core.units.SI`."""
        return DIMENSIONS.get(self.name, "none")

    @property
    def component(self) -> str:
        """The body axis whose scale a force shares: X of drag, Y of side, Z of lift."""
        return WIND.get(self.name, self.name)

    @property
    def pure(self) -> bool:
        """Whether its numbers have no unit: a prime or a coefficient."""
        return self.primed or bool(self.area)

    def __str__(self) -> str:
        sign, prime = "-" if self.negative else "", "'" if self.primed else ""
        unit = self.unit + " s^2/m^2" * self.per_speed + f" ship {self.ship!r}" * bool(self.ship)
        if self.area:
            unit = f"coefficient A={self.area!r} m^2" + (f" L={self.length!r} m" if self.length else "")
        return f"{sign}{self.plain}{prime}" + (f" [{unit}]" if unit else "")


_TEN = r"(?:1[eE]|10\s*(?:\^|\*\*)\s*)\(?[+-]?\d{1,2}\)?"
_SHARE = re.compile(rf"(?:[xX*×·]\s*)?(?P<power>{_TEN})|(?P<percent>%)")
_SCALED = (  # M' x1000 and M' * 7; M' (x1e3) and M' [x10^-3]; X'E3; 1000 M'; Z1000
    re.compile(rf"(?P<name>.*?[^\s,;])[,;]?(?:\s*[*×·⋅]|(?:\s+|(?<=['′’)\]])_?)[xX])\s*(?P<power>{_TEN}|\d[\d.,]*)"),
    re.compile(rf"(?P<name>.*?\S)\s*[(\[<]\s*(?P<times>[xX*×·⋅])?\s*(?P<power>{_TEN}|100+|%)\s*[)\]>]"),
    re.compile(r"(?P<name>.*['′’])\s*(?P<power>1?[eE]\d)"),
    re.compile(rf"(?P<power>{_TEN}|100+)(?:\s*[xX*×·⋅](?![a-z])|_)?\s*(?P<name>[A-Za-z].*)"),
    re.compile(rf"(?P<name>[XYZKMN])[\s_]*(?P<power>{_TEN}|100+)"),
)
_RAISED = str.maketrans("⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹−", "-+0123456789-")


def share(unit: str) -> float | None:
    """What a pure number is counted in, 0.001 of ``1e-3``, ``10^-3`` and ``10⁻³``, 0.01 of ``%``; None of anything else."""
    plain = unit.strip()
    plain = plain[1:-1].strip() if plain[:1] + plain[-1:] in ("[]", "()", "<>") else plain
    m = _SHARE.fullmatch(_flat(plain))
    return None if m is None else 0.01 if m["percent"] else 10.0 ** _exponent(m["power"])


def _flat(text: str) -> str:
    """10^3 of 10³, 10^-3 of 10-3."""
    return re.sub(r"(?<!\d)10(?=[⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹+−-])", "10^", text).translate(_RAISED)


def _exponent(power: str) -> int:
    """Of 1000, 1e3, E3 and 10^(3)."""
    return int(re.split(r"[eE^*]+\s*", power)[-1].strip("()")) if power.strip("10") else power.count("0")


def counted_in(name: str, unit: str = "") -> tuple[str, str]:
    """A name without the factor in it, and what its numbers are counted in: nothing without a factor, ? where it reads both ways.

    A factor beside a symbol is a product, and 1000 M' is counted in 1e-3; one in brackets is a unit. Products below one, and units
    above one behind a times sign, are more often meant the other way round.

    Examples
    --------
    >>> counted_in("M' x1000"), counted_in("10^3 CX"), counted_in("Z'", "x10^-3"), counted_in("N' x 10^-3"), counted_in("Mx")
    (("M'", '1e-3'), ('CX', '1e-3'), ("Z'", '1e-3'), ("N'", '?'), ('Mx', ''))
    """
    pure = unit in ("", "-", "1")
    text = _flat(name.strip() if pure else f"{name.strip()} [{unit}]")
    for form in _SCALED:
        if m := form.fullmatch(text):
            if not re.fullmatch(rf"{_TEN}|1?[eE]\d|100*", m["power"]):
                return m["name"], m["power"] if m["power"] == "%" else "?"
            power, bracketed = _exponent(m["power"]), form is _SCALED[1]
            doubted = power > 0 and m["times"] if bracketed else power < 0
            return m["name"], "?" if doubted else f"1e{power if bracketed else -power}"
    bare, counted = (name, "") if pure else counted_in(name)
    return bare, "?" if counted else ""


def unturned(name: str, meaning: ColumnMap) -> str:
    """A warning where a column whose name is that of lift or drag is called a force along a body axis; else empty."""
    wind = vocabulary().of_flow(name)
    if not wind or meaning.error or meaning.name not in ("X", "Y", "Z"):
        return ""
    exact = str(replace(meaning, name=wind, negative=False))
    return (
        f"{shown(name)} is read as {meaning}, a force along the body, but its name is that of {wind}, {ACROSS[wind]} "
        f"the flow: slopes would lack C_D0, often a tenth and more. If it is {wind}, call it {exact}"
    )


def read_column_map(text: Any) -> ColumnMap:
    """What a person says that a column is.

    Raises
    ------
    InputError
        No such name, or a unit that does not fit.
    """
    match = _ENTRY.fullmatch(text.strip()) if isinstance(text, str) and len(text) <= _LONGEST else None
    if match is None:
        raise InputError(shown(text), EXPECTED)
    name = match["name"] if match["name"] in ROLES else one_name(match["name"])
    if name not in ROLES:
        raise input_error(
            "tables.unknown_name", match=shown(match["name"]), roles=", ".join(ROLES), did_you_mean=did_you_mean(match["name"]),
        )  # fmt: skip
    out = ColumnMap(
        name,
        (match["unit"] or "").strip(),
        match["sign"] in ("-", "\u2212"),
        bool(match["prime"]),
        bool(match["error"]),
    )
    return _checked(out, text)


def _checked(meaning: ColumnMap, text: str) -> ColumnMap:
    """The entry with its unit understood."""
    if meaning.role == "word":
        if (meaning.unit and meaning.name != "label") or meaning.negative or meaning.primed:
            raise input_error("tables.word_with_sign", text=shown(text), name=meaning.name)
        return meaning
    if meaning.error and (meaning.name not in FORCES or meaning.negative):
        raise input_error("tables.no_standard_error", text=shown(text), forces=" ".join(FORCES))
    if meaning.primed:
        if meaning.name not in (*FORCES, *LINEAR, *ANGULAR):
            raise InputError(shown(text), f"a prime of {' '.join((*COMPONENTS, *LINEAR, *ANGULAR, *WIND))} only")
        if meaning.unit not in ("", "-") and share(meaning.unit) is None:
            raise input_error("tables.no_share", kind=UnitsError, unit=meaning.unit, name=meaning.name)
        return replace(meaning, unit=meaning.unit or "-")
    if meaning.unit.startswith("coefficient"):
        return _coefficient(meaning, text)
    if meaning.dimension == "none" and meaning.unit in ("", "-", "1"):
        return replace(meaning, unit="-")
    if meaning.unit == "-":
        advice = f"For the prime by the campaign's length write {meaning.name}' [-]"
        if meaning.name in FORCES:
            advice += f"; for a coefficient by an area {meaning.plain} [{PER[meaning.dimension]}]"
        raise UnitsError(
            "[-]", f"a unit of {meaning.dimension}, such as {EXAMPLES[meaning.dimension]}", advice=advice + "."
        )
    if meaning.name == "U" and (m := _SHIP.fullmatch(meaning.unit)):
        factor(m["unit"], "speed")
        return replace(meaning, unit=m["unit"], ship=float(m["scale"]))
    if meaning.name in FORCES and (m := _PER_SPEED.fullmatch(meaning.unit)):
        factor(m["unit"], meaning.dimension)
        return replace(meaning, unit=m["unit"], per_speed=True)
    if meaning.unit:
        factor(meaning.unit, meaning.dimension)
    return meaning


def _coefficient(meaning: ColumnMap, text: str) -> ColumnMap:
    match = _COEFFICIENT.fullmatch(meaning.unit)
    moment = meaning.dimension == "moment"
    if meaning.unit == OPEN_SIZES and meaning.name in FORCES:
        return meaning
    if match is None or not match["area"] or meaning.name not in FORCES or moment != bool(match["length"]):
        expected = f"{meaning.plain} [{PER['moment' if moment else 'force']}]"
        raise input_error(
            "tables.no_coefficient", text=shown(text), wanted=expected if meaning.name in FORCES else f"a coefficient of {' '.join(FORCES)} only",
        )  # fmt: skip
    area, length = _size("A", match["area"], "area"), _size("L", match["length"], "length") if moment else 0.0
    if area <= 0.0 or (moment and length <= 0.0):
        raise input_error("tables.no_sizes", text=shown(text))
    return replace(meaning, unit="-", area=area, length=length)


def _size(name: str, typed: str, dimension: str) -> float:
    """A size of a coefficient with its unit; complaints quote what was typed."""
    try:
        return quantity(typed, dimension)
    except InputError as why:
        bare = typed.strip().replace(".", "", 1).isdigit()
        example = f"{typed.strip() if bare else 2.5} {SI[dimension]}"
        raise type(why)(
            shown(f"{name}={typed}"), f"{name} with its unit, such as {example}", advice=why.advice
        ) from None


Entry = Annotated[
    ColumnMap,
    Takes(EXPECTED, lambda v, _: read_column_map(v), {"type": "string", "minLength": 1, "maxLength": _LONGEST}),
]

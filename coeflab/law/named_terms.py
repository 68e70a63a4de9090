"""Terms of manoeuvring models by their SNAME names, the standard sets of them, and linear equations between them.

Sets: Gertler & Hagen, NSRDC 2510 (1967), axial, lateral, normal, rolling, pitching and yawing equations; Feldman,
DTNSRDC/SPD-0393-09 (1979). The static, rotary and control terms of motions in one plane; (v^2 + w^2)^(1/2) is |v| in
the horizontal and |w| in the vertical plane. Accelerations have no term: the data are steady.
"""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass

from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import brief
from coeflab.law.symbols import COMPONENTS, LONGEST, PORT_STARBOARD
from coeflab.law.terms import Term, term_of

SETS: dict[str, tuple[str, ...]] = {
    "horizontal": (
        "X0", "Xvv", "Xrr", "Xvr", "Xdrdr",
        "Y0", "Yv", "Yv|v|", "Yr", "Yv|r|", "Yp", "Yp|p|", "Ydr", "Y|r|dr",
        "Z0", "Zvv", "Zrr", "Zvr",
        "K0", "Kv", "Kv|v|", "Kr", "Kp", "Kp|p|", "Kdr",
        "M0", "Mvv", "Mrr", "Mvr",
        "N0", "Nv", "Nv|v|", "Nr", "Nr|r|", "N|v|r", "Np", "Ndr", "N|r|dr",
    ),
    "vertical": (
        "X0", "Xww", "Xqq", "Xwq", "Xdsds", "Xdbdb",
        "Z0", "Zw", "Zw|w|", "Z|w|", "Zww", "Zq", "Zw|q|", "Zds", "Z|q|ds", "Zdb",
        "M0", "Mw", "Mw|w|", "M|w|", "Mww", "Mq", "Mq|q|", "M|w|q", "Mds", "M|q|ds", "Mdb",
    ),
}  # fmt: skip
CATALOGUE = tuple(
    dict.fromkeys([*SETS["horizontal"], *SETS["vertical"], *(f"{c}{v * 3}" for c in COMPONENTS for v in "vwpqr")])
)
Key = tuple[str, tuple[tuple[str, int, bool], ...]]
_NUMBER = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_SYMBOL = re.compile(r"[A-Z][A-Za-z0-9|]*'?")


@brief
@dataclass(frozen=True, slots=True)
class NamedTerm:
    """A term of one force component, with the name that its coefficient has.

    Attributes
    ----------
    symbol : str
        As written, without prime: ``Yv|r|``.
    component : str
    term : Term
    """

    symbol: str
    component: str
    term: Term

    @property
    def key(self) -> Key:
        """The same for every spelling of one term: ``Yv|r|`` and ``Y|r|v``, ``Yvv`` and ``Y|v||v|``."""
        return self.component, canonical(self.term)


def canonical(term: Term) -> tuple[tuple[str, int, bool], ...]:
    """Per variable: power, and whether the term changes sign with it; sorted by variable."""
    totals: dict[str, tuple[int, int]] = {}
    for variable, power, absolute in term.factors:
        total, signed = totals.get(variable, (0, 0))
        totals[variable] = total + power, signed + (0 if absolute else power)
    return tuple(sorted((v, n, s % 2 == 1) for v, (n, s) in totals.items()))


def symmetric(component: str, term: Term) -> bool:
    """Whether a body symmetric port to starboard may have the term: factors inside ``| |`` do not change sign."""
    flips = sum(odd for v, _, odd in canonical(term) if v in PORT_STARBOARD)
    return flips % 2 == (component in PORT_STARBOARD)


def read_term(text: str, place: str) -> NamedTerm:
    """Read a SNAME symbol as a term.

    Parameters
    ----------
    text : str
        ``Yv|r|``, with or without prime.
    place : str
        Where it stands, for messages.

    Raises
    ------
    InputError
        No term of steady motion; names the nearest ones.
    """
    symbol = text.strip().removesuffix("'")
    term = term_of(symbol[1:]) if symbol[:1] in COMPONENTS else None
    if term is not None and term.degree <= LONGEST:
        return NamedTerm(symbol, symbol[0], term)
    near = difflib.get_close_matches(symbol[:12], CATALOGUE, n=3, cutoff=0.5)
    advice = f"Did you mean {', '.join(near)}?" if near else ""
    if "dot" in symbol:
        advice = "Steady tests hold no acceleration; added mass gives that derivative."
    raise InputError(shown(text), "a term such as Yv, Yv|v|, Yv|r|, Y|v|r, Nrr|r| or Y0", column=place, advice=advice)


def read_terms(texts: tuple[str, ...], place: str) -> tuple[NamedTerm, ...]:
    """Read a list of symbols.

    Raises
    ------
    InputError
        A symbol is no term, or two of them name one term.
    """
    found: dict[Key, NamedTerm] = {}
    for text in texts:
        named = read_term(text, place)
        if (other := found.get(named.key)) is not None:
            raise InputError(f"{shown(text)} beside {shown(other.symbol)}", "every term once", column=place,
                             advice="They are the same function of the motion. Leave one out.")  # fmt: skip
        found[named.key] = named
    return tuple(found.values())


@brief
@dataclass(frozen=True, slots=True)
class Equation:
    """A linear equation between coefficients: the sum of weight times coefficient is ``right``.

    Attributes
    ----------
    weights : tuple of (symbol, float)
        No weight is zero, no symbol stands twice.
    right : float
    """

    weights: tuple[tuple[str, float], ...]
    right: float = 0.0

    def __str__(self) -> str:
        text = ""
        for symbol, weight in self.weights:
            sign = ("- " if weight < 0 else "+ ") if text else ("-" if weight < 0 else "")
            size = "" if abs(weight) == 1.0 else f"{abs(weight)!r} "
            text += f"{' ' if text else ''}{sign}{size}{symbol}"
        return f"{text} = {self.right!r}"

    @property
    def spoken(self) -> str:
        """As a person writes it: ``Mw = -Nv`` where two coefficients are multiples of each other."""
        if self.right != 0.0 or len(self.weights) != 2:
            return str(self)
        (first, a), (second, b) = self.weights
        ratio = -b / a
        return f"{first} = {'-' if ratio < 0.0 else ''}{'' if abs(ratio) == 1.0 else f'{abs(ratio):.6g} '}{second}"


def _side(text: str, whole: str, place: str) -> tuple[dict[Key, tuple[str, float]], float]:
    """Weights by term and the sum of the plain numbers of one side."""
    weights: dict[Key, tuple[str, float]] = {}
    constant, at, first = 0.0, 0, True
    rest = text.strip()
    while at < len(rest) or first:
        sign = re.compile(r"\s*([+-]?)\s*").match(rest, at)
        if sign is None or (not first and not sign.group(1)):
            raise _not_an_equation(whole, place)
        at = sign.end()
        number = _NUMBER.match(rest, at)
        factor = (-1.0 if sign.group(1) == "-" else 1.0) * (float(number.group()) if number else 1.0)
        at = number.end() if number else at
        star = re.compile(r"\s*\*?\s*").match(rest, at)
        symbol = _SYMBOL.match(rest, star.end() if star else at)
        if symbol is not None:
            named = read_term(symbol.group(), place)
            weights[named.key] = named.symbol, weights.get(named.key, ("", 0.0))[1] + factor
            at = symbol.end()
        elif number is not None:
            constant += factor
        else:
            raise _not_an_equation(whole, place)
        first = False
    return weights, constant


def _not_an_equation(text: str, place: str) -> InputError:
    return input_error("law.linear_equation_such", column=place, found=shown(text))


def split_equations(text: str) -> list[str]:
    """The equations of one text, separated by commas or semicolons; blanks inside them do not matter."""
    return [part.strip() for part in re.split("[,;]", text) if part.strip()]


def read_equation(text: str, place: str) -> Equation:
    """Read ``Mw = -Nv``, ``Zw = Yv``, ``2 Yv + 0.5*Nv = 1e-3``.

    Raises
    ------
    InputError
        No linear equation, or one in which every coefficient cancels.
    """
    sides = text.split("=")
    if len(sides) != 2:
        raise _not_an_equation(text, place)
    left, on_left = _side(sides[0], text, place)
    right, on_right = _side(sides[1], text, place)
    for key, (symbol, weight) in right.items():
        known = left.get(key, (symbol, 0.0))
        left[key] = known[0], known[1] - weight
    selected = tuple((s, w) for s, w in left.values() if w != 0.0)
    if not selected:
        raise InputError(shown(text), "an equation with a coefficient that does not cancel", column=place)
    return Equation(selected, on_right - on_left + 0.0)

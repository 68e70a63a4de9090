"""SNAME symbols: what a derivative's name means and what its dimension is.

Sources: SNAME Technical and Research Bulletin 1-5 (1950); Gertler & Hagen, NSRDC 2510 (1967);
Feldman, DTNSRDC/SPD-0393-09 (1979).
"""

from __future__ import annotations

import difflib
import re
from dataclasses import dataclass
from functools import lru_cache

from coeflab.core.errors import InputError, shown
from coeflab.core.texts import input_error

FORCES = ("X", "Y", "Z")
MOMENTS = ("K", "M", "N")
COMPONENTS = FORCES + MOMENTS
LINEAR = ("u", "v", "w")
ANGULAR = ("p", "q", "r")
MOTIONS = LINEAR + ANGULAR
CONTROLS = ("dr", "ds", "db")
ANGLE_NAMES = {"dr": "rudder angle", "ds": "stern plane angle", "db": "bow plane angle"}
CONTROL_COLUMNS = {"delta_r": "dr", "delta_s": "ds", "delta_b": "db"}
FLOW_ANGLES = {
    "alpha": "alpha = atan2(w, u)",
    "beta": "beta = asin(v/V), so v = +V sin(beta), whatever sign the campaign declares",
}
PORT_STARBOARD = frozenset("YKNvpr") | {"dr"}

LONGEST = 5  # factors; no model has more
SEEN = 1 << 12  # symbols that are read once
_FACTOR = r"(?:dr|ds|db|[uvwpqr]dot|[uvwpqr])"
_TOKEN = re.compile(rf"\|(?P<absolute>{_FACTOR})\||(?P<signed>{_FACTOR})")


@dataclass(frozen=True, slots=True)
class Derivative:
    """A force component differentiated by motion variables, such as ``Yv``, ``Xvv``, ``Nrdot``, ``Y|v|v``, ``X0``.

    Attributes
    ----------
    component : str
        One of X Y Z K M N.
    factors : tuple of str
        The variables, in order; empty for a force at rest angle (``X0``).
    text : str
        The symbol as written, without prime.
    """

    component: str
    factors: tuple[str, ...]
    text: str

    @property
    def unit(self) -> str:
        """SI unit, for example ``N/(m/s)`` for Yv or ``N*m/(rad/s)`` for Nr."""
        names = {**dict.fromkeys(LINEAR, "m/s"), **dict.fromkeys(ANGULAR, "rad/s"), **dict.fromkeys(CONTROLS, "rad")}
        top = "N*m" if self.component in MOMENTS else "N"
        bottom: dict[str, int] = {}
        for factor in self.factors:
            base = names[factor.removesuffix("dot")] + ("^2" if factor.endswith("dot") else "")
            bottom[base] = bottom.get(base, 0) + 1
        for base, power in bottom.items():
            top += f"/({base})" + (f"^{power}" if power > 1 else "")
        return top

    @property
    def odd_in_port_starboard(self) -> bool:
        """True when a body symmetric port to starboard must have zero for this derivative; |v| does not flip."""
        signed = [name.removesuffix("dot") for name, absolute in read_factors(self.text[1:]) or () if not absolute]
        flips = [self.component, *signed]
        return sum(name in PORT_STARBOARD for name in flips) % 2 == 1


@lru_cache(SEEN)
def read_factors(subscript: str) -> tuple[tuple[str, bool], ...] | None:
    """The variables of a subscript such as ``v|r|`` or ``rdot``, in order, each with whether it stands between bars.

    Empty for ``0``; None where the text is no subscript.
    """
    out, at = [], 0
    while at < len(subscript) and subscript != "0":
        match = _TOKEN.match(subscript, at)
        if match is None:
            return None
        out.append((match["absolute"] or match["signed"], match["absolute"] is not None))
        at = match.end()
    return tuple(out) if subscript else None


@lru_cache(SEEN)
def derivative(symbol: str) -> Derivative:
    """Read a SNAME symbol, with or without its prime.

    Parameters
    ----------
    symbol : str
        For example ``Yv``, ``Nr'``, ``X0``, ``Xvv``, ``Y|v|v``, ``Ydr``, ``Mqdot``.

    Raises
    ------
    InputError
        The text is not a SNAME derivative; names the nearest ones.
    """
    text = symbol.removesuffix("'")
    component, rest = text[:1], text[1:]
    read = read_factors(rest) if component in COMPONENTS else None
    if read is None or len(read) > LONGEST:
        if same := respelled(symbol):
            raise input_error("law.sname_derivative_such_2", found=shown(symbol), same=same)
        known = [c + f for c in COMPONENTS for f in ("v", "w", "r", "q", "p", "vv", "ww", "rr", "dr", "ds", "0")]
        near = difflib.get_close_matches(text[:12], known, n=3, cutoff=0.4)
        raise InputError(
            shown(symbol),
            "a SNAME derivative such as Yv', Nr', Xvv', X0' or Ydr'",
            advice=f"Did you mean {', '.join(n + chr(39) for n in near)}?" if near else "",
        )
    return Derivative(component, tuple(name for name, _ in read), text)


_MARKS = re.compile(r"[_{}\s\\^]|['\u2018\u2019\u201b\u2032\u00b4`]+$")


def respelled(symbol: str) -> str:
    """The derivative that is written otherwise, without prime, such as ``Yv`` of ``Y_v``; empty where it is none.

    Indices behind an underscore or in braces, curly and typeset primes, and ``delta_r`` are read.
    """
    text = symbol.strip()
    for name, control in CONTROL_COLUMNS.items():
        text = text.replace(name, control)
    text = _MARKS.sub("", text)
    read = read_factors(text[1:]) if text[:1] in COMPONENTS else None
    return text if read is not None and len(read) <= LONGEST else ""


def primed(symbol: str) -> str:
    """Printed form of a nondimensional derivative: ``Yv`` -> ``Yv'``."""
    return symbol.removesuffix("'") + "'"

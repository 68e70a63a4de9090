"""Numbers and derivatives of a MATLAB file with plain assignments, and the units that it is written in.

Nothing is run: numbers, ``+ - * / ^`` and names assigned above are computed, all else is passed over. Primes are those of MSS
VESSELS/npsauv.m, where r2 = rho*L^2/2 and so on tell that the derivatives are primed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from coeflab.core.arithmetic import ArithmeticProblem, evaluate
from coeflab.core.errors import InputError, shown
from coeflab.core.limits import M_FILE_BYTES, bounded_number, positive_number
from coeflab.core.text.toml import read_text
from coeflab.core.texts import input_error
from coeflab.core.types import brief
from coeflab.core.wording import one_line
from coeflab.formats import NoDensityError
from coeflab.formats.exported_law import sname
from coeflab.formats.mss.assignments import (
    CLOSING,
    DRIVEN,
    NAMED,
    OPENING,
    TABLED,
    Assignment,
    assignments,
    own_part,
    statements,
)
from coeflab.law.scaling import Conditions, Scaling
from coeflab.law.symbols import COMPONENTS, LINEAR, MOMENTS, MOTIONS, derivative
from coeflab.vehicle.imported_numbers import FEET_PER_SECOND, FOOT, SLUG, SLUGS

LENGTHS = ("L", "Lpp", "LBP", "LOA", "Loa", "L_auv", "length")
SPHEROID_DENSITY = {
    "imlay61": 1026.0,
    "spheroid": 1025.0,
}  # kg/m^3, in the functions themselves, LIBRARY/modeling of MSS 736a3d1
_CALL = re.compile(
    r"\[\s*([A-Za-z]\w*)[\s,]+[A-Za-z~]\w*\s*\]\s*=\s*(imlay61|spheroid)\s*\(([^()]*(?:\([^()]*\)[^()]*)*)\)", re.ASCII
)
_VECTOR = re.compile(r"\[([^\[\];]*)\]'?|\[([^\[\],]*)\]", re.ASCII)
DENSITIES, GRAVITIES, MASSES = ("rho", "rho_water"), ("g", "g_mu"), ("m", "mass")
_CHANGED = re.compile(r"^[^%#\n]*\bC_?A\s*\(", re.MULTILINE)
_ADDED = ("CA", "C_A")


@brief
@dataclass(frozen=True, slots=True)
class MFile:
    """What a file states.

    Attributes
    ----------
    numbers, texts : mapping of last name to value
    derivatives : mapping of SNAME symbol to (group, value)
    adds_coriolis : bool
        Whether it computes C_A(nu).
    changes_coriolis : bool
        Whether it then sets entries of it.
    uses : mapping of last name to last names
        What the expression of a number names.
    unread : mapping of last name to line
        Assignments whose value is no plain arithmetic.
    calls : tuple of str
        Calls of `imlay61` and `spheroid`, of which mass, inertia and added mass are computed.
    vectors : mapping of last name to three numbers
        Such as r_bG.
    tabled, driven : bool
        Whether look-up tables follow, which are not read.
    """

    numbers: dict[str, float]
    texts: dict[str, str]
    derivatives: dict[str, tuple[str, float]]
    adds_coriolis: bool
    changes_coriolis: bool
    uses: dict[str, frozenset[str]]
    unread: dict[str, int]
    calls: tuple[str, ...] = ()
    vectors: dict[str, tuple[float, ...]] = field(default_factory=dict)
    tabled: bool = False
    driven: bool = False

    def needed(self, names: Iterable[str]) -> set[str]:
        """These names and all that their expressions name."""
        out: set[str] = set()
        waiting = list(names)
        while waiting:
            if (name := waiting.pop()) not in out:
                out.add(name)
                waiting += self.uses.get(name, ())
        return out

    def named(self, *names: str) -> tuple[str, float] | None:
        """The first of these that is a number, with its name."""
        return next(((n, self.numbers[n]) for n in names if n in self.numbers), None)

    def first(self, *names: str) -> float | None:
        """Its number alone."""
        found = self.named(*names)
        return None if found is None else found[1]


def read_m_file(path: Path) -> MFile:
    """Read a file.

    Raises
    ------
    InputError
        No derivative, or one that is no plain arithmetic or has two values; NaN or Inf in any place.
    """
    whole = read_text(path, M_FILE_BYTES)
    text = own_part(whole)
    lines = assignments(text)
    adds = any("m2c(" in a.expression or a.target.split(".")[-1] in _ADDED for a in lines) or "imlay61" in text
    out = MFile(
        {}, {}, {}, adds, _CHANGED.search(text) is not None, {}, {}, tabled=TABLED in whole, driven=DRIVEN in whole
    )
    names: dict[str, float] = {"pi": math.pi}
    for a in lines:
        group, _, last = a.target.rpartition(".")
        if a.quoted is not None:
            out.texts.setdefault(last, one_line(a.quoted))
            continue
        symbol = _symbol(last)
        value = _value(a, symbol, names, path)
        if value is None and (three := _three(a.expression, names)) is not None:
            out.vectors.setdefault(last, three)
            continue
        if value is None:
            out.unread.setdefault(last, a.line)
            continue
        out.numbers.setdefault(last, value)
        out.uses.setdefault(last, frozenset(n.rpartition(".")[2] for n in NAMED.findall(a.expression)))
        if symbol and group.rpartition(".")[2] != "ideal":
            before = out.derivatives.setdefault(symbol, (group.rpartition(".")[2], value))
            if before[1] != value:
                raise InputError(f"{last} = {value:g} after {before[1]:g}", "one value", file=path, line=a.line)
    called = _spheroids(text, names, out, path)
    out = replace(out, calls=called)
    if not out.derivatives:
        raise input_error("formats.no_derivatives", path)
    return out


def _three(expression: str, names: Mapping[str, float]) -> tuple[float, ...] | None:
    """Three numbers or names in brackets, such as ``[0 0 0.02]'``; None of anything else."""
    match = _VECTOR.fullmatch(expression.strip())
    if match is None:
        return None
    parts = re.split(r"[\s,;]+", (match[1] or match[2] or "").strip())
    try:
        return tuple(float(evaluate(p, names)) for p in parts) if len(parts) == 3 else None
    except ArithmeticProblem:
        return None


def _spheroids(text: str, names: Mapping[str, float], out: MFile, path: Path) -> tuple[str, ...]:
    """Mass, inertia and added mass of the file's calls of MSS's spheroids, computed here: Fossen (2021), section 8.4.2; Imlay (1961)."""
    calls = []
    for line, statement in statements(text):
        match = _CALL.fullmatch(statement)
        if match is None:
            continue
        arguments = _arguments(match[3])
        try:
            a, b = (float(evaluate(x, names)) for x in arguments[:2])
            roll = float(evaluate(arguments[3], names)) if match[2] == "imlay61" and len(arguments) > 3 else 0.0
        except (ArithmeticProblem, ValueError, IndexError) as why:
            raise input_error("formats.no_semi_axes", path, line, statement=shown(statement), why=why) from None
        if not a > b > 0.0 or positive_number(a) or positive_number(b):
            raise InputError(f"semi-axes {a:g} and {b:g}", "a above b above zero", file=path, line=line)
        mass = 4.0 / 3.0 * math.pi * SPHEROID_DENSITY[match[2]] * a * b**2
        ix, iy = 0.4 * mass * b**2, 0.2 * mass * (a**2 + b**2)
        if match[2] == "spheroid":
            at = out.vectors.get(arguments[3].strip(), (0.0, 0.0, 0.0)) if len(arguments) > 3 else (0.0, 0.0, 0.0)
            for key, number in (
                ("m", mass),
                ("Ix", ix),
                ("Iy", iy),
                ("Iz", iy),
                ("xG", at[0]),
                ("yG", at[1]),
                ("zG", at[2]),
            ):
                out.numbers.setdefault(key, number)
            out.uses.setdefault("m", frozenset())
        else:
            e = math.sqrt(1.0 - (b / a) ** 2)
            log = math.log((1.0 + e) / (1.0 - e))
            alpha, beta = 2.0 * (1.0 - e**2) / e**3 * (0.5 * log - e), 1.0 / e**2 - (1.0 - e**2) / (2.0 * e**3) * log
            k1, k2 = alpha / (2.0 - alpha), beta / (2.0 - beta)
            k = e**4 * (beta - alpha) / ((2.0 - e**2) * (2.0 * e**2 - (2.0 - e**2) * (beta - alpha)))
            for symbol, number in zip(
                ("Xudot", "Yvdot", "Zwdot", "Kpdot", "Mqdot", "Nrdot"),
                (mass * k1, mass * k2, mass * k2, roll * ix, k * iy, k * iy), strict=True,
            ):  # fmt: skip
                out.derivatives.setdefault(symbol, ("", -number))
        calls.append(match[2])
        out.uses[match[2]] = frozenset(n for x in arguments for n in NAMED.findall(x))
    return tuple(dict.fromkeys(calls))


def _arguments(text: str) -> list[str]:
    """Arguments of a call, apart at commas outside of brackets."""
    out, depth = [""], 0
    for c in text:
        depth += (c in OPENING) - (c in CLOSING)
        if c == "," and not depth:
            out.append("")
        else:
            out[-1] += c
    return out


def _value(a: Assignment, symbol: str, names: dict[str, float], path: Path) -> float | None:
    """The value of an assignment, kept for those below; None where it is none and no derivative is lost by it."""
    try:
        names[a.target] = float(evaluate(a.expression, names))
    except ArithmeticProblem as why:
        if symbol or _literal(a.expression):
            raise input_error(
                "formats.no_number", path, a.line, expression=shown(a.expression), why=why, target=a.target
            ) from None  # fmt: skip
        names.pop(a.target, None)
        return None
    if symbol and (expected := bounded_number(names[a.target])):
        raise InputError(f"{a.target} = {names[a.target]:g}", expected, file=path, line=a.line)
    return names[a.target]


def _literal(expression: str) -> bool:
    """Whether it is one number, NaN and Inf among them."""
    try:
        float(expression)
    except ValueError:
        return False
    return True


def _symbol(name: str) -> str:
    try:
        return derivative(sname(name)).text
    except InputError:
        return ""


def is_derivative(name: str) -> bool:
    """Whether a name is one of a SNAME derivative."""
    return bool(_symbol(name))


@brief
@dataclass(frozen=True, slots=True)
class MValues:
    """Derivatives as primes, and what told their units.

    Attributes
    ----------
    scaling : Scaling
    conditions : Conditions
    primed : bool
        Whether the file writes primes.
    imperial : bool
        Whether it is in slug and foot.
    values : mapping of symbol to prime
    """

    scaling: Scaling
    conditions: Conditions
    primed: bool
    imperial: bool
    values: dict[str, float]

    @property
    def units(self) -> tuple[float, float]:
        """Mass and length of the file, kg and m."""
        return (SLUG, FOOT) if self.imperial else (1.0, 1.0)

    def product(self, symbol: str) -> float:
        """SI value of a derivative as the factor of velocities, rates and, where they are missing to two, u."""
        return self.values[symbol] * self.scaling.unit(symbol, self.conditions.density)

    def stays(self, symbol: str) -> bool:
        """Whether the force does not grow with the speed: damping about a state of rest."""
        factors = derivative(symbol).factors
        return not self.primed and sum(f in MOTIONS for f in factors) != 2 and not is_acceleration(symbol)

    @property
    def added_mass(self) -> NDArray[np.float64]:
        """Added mass (6, 6), SI."""
        return added_mass({s: self.product(s) for s in self.values if is_acceleration(s)})


def foreign_values(found: MFile, path: Path, density: float | None = None) -> MValues:
    """Somebody's own model: SI or slug and foot, primed or not, by what the file itself says.

    Parameters
    ----------
    found : MFile
    path : path
        For messages.
    density : float, optional
        kg/m^3, where the file states none.

    Raises
    ------
    InputError
        A length or density that is not above zero.
    NoDensityError
    """
    rho = found.first(*DENSITIES)
    imperial = is_imperial(found)
    mass_unit, length_unit = (SLUG, FOOT) if imperial else (1.0, 1.0)
    if rho is None and density is None:
        raise NoDensityError(
            "no density", "rho = 1025 or the like", file=path,
            advice="Add it, in the units of the file, or give it in kg/m^3 (--density 1025).",
        )  # fmt: skip
    si = density if rho is None and density is not None else (rho or 0.0) * mass_unit / length_unit**3
    if expected := positive_number(si):
        raise InputError(f"rho = {rho:g}", expected.replace("value", "density"), file=path)
    name, length = found.named(*LENGTHS) or ("1 m", 1.0 / length_unit)
    if expected := positive_number(length * length_unit):
        raise InputError(f"{name} = {length:g}", expected.replace("value", "length"), file=path)
    primed = rho is not None and any(
        math.isclose(found.numbers[f"r{k}"], 0.5 * rho * length**k, rel_tol=1e-9)
        for k in range(2, 6)
        if f"r{k}" in found.numbers
    )
    speed = found.first("U0", "U")
    scaling, at = Scaling(length * length_unit, name), Conditions(si, abs(speed or 0.0) * length_unit or 1.0)
    values = {s: v if primed else _si(s, v, mass_unit, length_unit) / scaling.unit(s, at.density, at.speed)
              for s, (_, v) in found.derivatives.items()}  # fmt: skip
    return MValues(scaling, at, primed, imperial, values)


def is_imperial(found: MFile) -> bool:
    """Whether density, or gravity where there is none, is in slug and foot."""
    rho, gravity = found.first(*DENSITIES), found.first(*GRAVITIES) or 0.0
    feet = FEET_PER_SECOND[0] < gravity < FEET_PER_SECOND[1]
    return SLUGS[0] < rho < SLUGS[1] if rho is not None else feet


def _si(symbol: str, value: float, mass_unit: float, length_unit: float) -> float:
    d = derivative(symbol)
    power = (2 if d.component in MOMENTS else 1) - sum(f.removesuffix("dot") in LINEAR for f in d.factors)
    return value * mass_unit * length_unit**power


def is_acceleration(symbol: str) -> bool:
    """Whether a symbol is an acceleration derivative."""
    factors = derivative(symbol).factors
    return len(factors) == 1 and factors[0].endswith("dot")


def added_mass(accelerations: Mapping[str, float]) -> NDArray[np.float64]:
    """Added mass (6, 6) of acceleration derivatives; one whose mirror image is not stated stands for both."""
    matrix = np.zeros((6, 6))
    for symbol, value in accelerations.items():
        matrix[COMPONENTS.index(symbol[0]), MOTIONS.index(symbol[1])] = -value
    for i in range(6):
        for j in range(6):
            if f"{COMPONENTS[i]}{MOTIONS[j]}dot" not in accelerations:
                matrix[i, j] = matrix[j, i]
    return matrix

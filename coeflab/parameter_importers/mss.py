"""Vehicle models of the Marine Systems Simulator (MSS): ``.m`` files whose coefficients are plain assignments.

Nothing is run: numbers, ``+ - * / ^`` and names assigned above are computed, all else is passed over. Primes are those of
VESSELS/npsauv.m, where r2 = rho*L^2/2 and so on tell that the derivatives are primed.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from coeflab.core.arithmetic import ArithmeticProblem, evaluate
from coeflab.core.errors import InputError, shown
from coeflab.core.identifiers import one_line
from coeflab.core.matlab import Assignment, assignments
from coeflab.core.provenance import InputFile, sha256_of
from coeflab.core.symbols import COMPONENTS, LINEAR, MOMENTS, MOTIONS, derivative
from coeflab.core.toml import read_text
from coeflab.model.added_mass import AddedMass
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.potential import potential_part
from coeflab.model.scaling import Conditions, Scaling
from coeflab.model.stated_file import Array, Law, Stated, StatedMass, matrix_doubts, stated_file
from coeflab.model.written_law import sname

summary = "MSS .m files with plain assignments: primed or SI derivatives, slug and foot units told by rho or g"
citations = ("sname1950", "fossen2011", "mss")

SLUG, FOOT = 14.593902937206, 0.3048
WATER = (900.0, 1100.0)
LENGTHS = ("L", "Lpp", "LBP", "LOA", "Loa", "L_auv", "length")
OWN_AXES = ("Xuu", "Yvv", "Zww", "Kpp", "Mqq", "Nrr")
SMALLEST_PRIME = 1e-5


@dataclass(frozen=True, slots=True)
class _Read:
    """Numbers by their last name, texts by theirs, SNAME derivatives by group and name."""

    numbers: dict[str, float]
    texts: dict[str, str]
    derivatives: dict[str, tuple[str, float]]
    adds_coriolis: bool

    def first(self, *names: str) -> float | None:
        return next((self.numbers[n] for n in names if n in self.numbers), None)


def read(path: Path) -> ParameterFile:
    """Read a model file.

    Raises
    ------
    InputError
        No derivative or no density in it, a derivative that is no plain arithmetic or has two values, units that are
        neither SI nor slug and foot.
    """
    found = _found(assignments(read_text(path)), path)
    source = InputFile(path.name, sha256_of(path))
    stated = _own(found, path) if "coeflab" in found.numbers else _foreign(found, path)
    return stated_file(stated, [source], citations)


def _found(lines: tuple[Assignment, ...], path: Path) -> _Read:
    names: dict[str, float] = {"pi": math.pi}
    out = _Read({}, {}, {}, any("m2c(" in a.expression or a.target.split(".")[-1] in ("CA", "C_A") for a in lines))
    for a in lines:
        group, _, last = a.target.rpartition(".")
        if a.quoted is not None:
            out.texts.setdefault(last, one_line(a.quoted))
            continue
        symbol = _symbol(last)
        try:
            value = evaluate(a.expression, names)
        except ArithmeticProblem as why:
            if symbol:
                raise InputError(
                    f"{shown(a.expression)}: {why}", f"{a.target} as a number, or + - * / ^ of numbers and names above",
                    file=path, line=a.line,
                ) from None  # fmt: skip
            names.pop(a.target, None)
            continue
        names[a.target] = value
        out.numbers.setdefault(last, value)
        if symbol and group.rpartition(".")[2] != "ideal":
            before = out.derivatives.setdefault(symbol, (group.rpartition(".")[2], value))
            if before[1] != value:
                raise InputError(f"{last} = {value:g} after {before[1]:g}", "one value", file=path, line=a.line)
    if not out.derivatives:
        raise InputError("no derivative such as Yv or Zwdot", "plain assignments of SNAME derivatives", file=path)
    return out


def _symbol(name: str) -> str:
    try:
        return derivative(sname(name)).text
    except InputError:
        return ""


def _own(found: _Read, path: Path) -> Stated:
    """A file that the exporter wrote: nothing is guessed."""
    n = found.numbers
    missing = [k for k in ("rho", "U0", "L", "x_ref", "y_ref", "z_ref") if k not in n]
    if missing:
        raise InputError(f"no {', '.join(missing)}", "every fact that the exporter writes", file=path)
    scaling, at = Scaling(n["L"], found.texts.get("L_name", "L")), Conditions(n["rho"], n["U0"], n.get("viscosity"))
    coefficients: dict[str, tuple[float, Law]] = {}
    matrix, method = None, found.texts.get("MA_method")
    if method is not None:
        primes = {s: v for s, (_, v) in found.derivatives.items() if _is_acceleration(s)}
        matrix = _matrix({s: v * scaling.factor(s, at) for s, v in primes.items()})
        _refuse_doubts(matrix, path)
    for symbol, (group, value) in found.derivatives.items():
        if group == "rest":
            coefficients[symbol] = (value / scaling.factor(symbol, at), "rest")
        elif matrix is None or not _is_acceleration(symbol):
            coefficients[symbol] = (value, "motion")
    return Stated(
        name=found.texts.get("name", "")[:200] or path.stem,
        body=found.texts.get("body", "")[:200] or path.stem,
        scaling=scaling,
        conditions=at,
        coefficients=coefficients,
        point=(n["x_ref"], n["y_ref"], n["z_ref"]),
        datum=found.texts.get("datum", "origin of the model"),
        matrix=matrix,
        matrix_body=found.texts.get("MA_body", ""),
        matrix_method=method or "stated",
        mass=_own_mass(n),
    )


def _own_mass(n: Mapping[str, float]) -> StatedMass | None:
    if "m" not in n or "mxG" not in n:
        return None
    centre = [n[k] for k in ("xG", "yG", "zG") if k in n]
    inertia = [n[f"I{i}{j}"] for i in (1, 2, 3) for j in (1, 2, 3) if f"I{i}{j}" in n]
    return StatedMass(
        n["m"],
        n["mxG"],
        n.get("I_transverse"),
        np.array(centre) if len(centre) == 3 else None,
        np.array(inertia).reshape(3, 3) if len(inertia) == 9 else None,
    )


def _foreign(found: _Read, path: Path) -> Stated:
    """Somebody's own model: SI or slug and foot, primed or not, by what the file itself says."""
    notes = []
    rho, gravity = found.first("rho", "rho_water"), found.first("g", "g_mu") or 0.0
    imperial = (rho is not None and 1.9 < rho < 2.05) or 32.0 < gravity < 32.4
    if rho is None:
        raise InputError("no density", "rho = 1025 or the like", file=path, advice="Add it, in the units of the file.")
    mass_unit, length_unit = (SLUG, FOOT) if imperial else (1.0, 1.0)
    density = rho * mass_unit / length_unit**3
    if not WATER[0] < density < WATER[1]:
        raise InputError(f"rho = {rho:g}", "the density of water in kg/m^3 or slug/ft^3", file=path)
    if imperial:
        notes.append(f"slug, foot and pound told by rho = {rho:g}, g = {gravity:g}; converted to SI")
    name, length = next(((k, found.numbers[k]) for k in LENGTHS if k in found.numbers), ("1 m", 1.0 / length_unit))
    primed = any(
        math.isclose(found.numbers[f"r{k}"], 0.5 * rho * length**k, rel_tol=1e-9)
        for k in range(2, 6)
        if f"r{k}" in found.numbers
    )
    if not length > 0.0:
        raise InputError(f"{name} = {length:g}", "a length above zero", file=path)
    speed = found.first("U0", "U")
    scaling, at = Scaling(length * length_unit, name), Conditions(density, abs(speed or 0.0) * length_unit or 1.0)
    notes.append(f"lengths made dimensionless by {name}" + ("" if name != "1 m" else ": the file states none"))
    notes.append(
        "primed derivatives, told by r2 = rho*L^2/2 and the like; U is taken where the file's own equations may have u"
        if primed
        else "dimensional derivatives: forces do not scale with U unless the velocities in the name say so"
    )
    values = {s: v if primed else _si(s, v, mass_unit, length_unit) / scaling.factor(s, at)
              for s, (_, v) in found.derivatives.items()}  # fmt: skip
    if not primed and name != "1 m":
        _refuse_primes(values, path)
    accelerations = {s: v * scaling.factor(s, at) for s, v in values.items() if _is_acceleration(s)}
    matrix = _matrix(accelerations)
    doubts = matrix_doubts(matrix)
    kept = matrix if found.adds_coriolis and not doubts else None
    notes += [*doubts, *_coriolis_note(found.adds_coriolis, kept is not None)]
    hull = None if kept is None else AddedMass(kept, np.zeros(3), "origin of the model", path.stem, "stated")
    coefficients: dict[str, tuple[float, Law]] = {}
    for symbol, value in values.items():
        if kept is not None and _is_acceleration(symbol):
            continue
        factors = derivative(symbol).factors
        damping = f"{symbol[:2]}|{symbol[2:]}|"
        if symbol in OWN_AXES and value < 0.0 and damping not in values:
            notes.append(f"{symbol} read as {damping}: it damps in both directions")
            coefficients[damping] = (value, "motion")
            continue
        rest = not primed and sum(f in MOTIONS for f in factors) != 2 and not _is_acceleration(symbol)
        own = 0.0 if hull is None or rest else potential_part(symbol, hull, scaling, density) or 0.0
        coefficients[symbol] = (value + own, "rest" if rest else "motion")
    return Stated(
        name=path.stem[:200], body=path.stem[:200], scaling=scaling, conditions=at, coefficients=coefficients, matrix=kept,
        mass=_mass(found, primed, mass_unit, length_unit, scaling, density), notes=tuple(notes),
    )  # fmt: skip


def _coriolis_note(adds: bool, kept: bool) -> tuple[str, ...]:
    if kept:
        return ("the file adds C_A(nu) nu itself: its derivatives are viscous, totals are written here",)
    if adds:
        return ("the file adds C_A(nu) nu itself, which this added mass does not allow: its products are left out",)
    return ("no C_A(nu) in the file: products of velocities that it does not name are taken as zero",)


def _si(symbol: str, value: float, mass_unit: float, length_unit: float) -> float:
    d = derivative(symbol)
    power = (2 if d.component in MOMENTS else 1) - sum(f.removesuffix("dot") in LINEAR for f in d.factors)
    return value * mass_unit * length_unit**power


def _refuse_primes(values: Mapping[str, float], path: Path) -> None:
    sway = [abs(values[s]) for s in ("Yvdot", "Zwdot") if values.get(s)]
    if sway and max(sway) < SMALLEST_PRIME:
        raise InputError(
            f"acceleration derivatives of {max(sway):.1e} of 1/2 rho L^3", "SI values, or primes told by r3 = rho*L^3/2",
            file=path, advice="Add r3 = rho*L^3/2; if the derivatives are primed.",
        )  # fmt: skip


def _is_acceleration(symbol: str) -> bool:
    factors = derivative(symbol).factors
    return len(factors) == 1 and factors[0].endswith("dot")


def _matrix(accelerations: Mapping[str, float]) -> Array:
    """Added mass (6, 6); a derivative whose mirror image is not stated stands for both."""
    matrix = np.zeros((6, 6))
    for symbol, value in accelerations.items():
        matrix[COMPONENTS.index(symbol[0]), MOTIONS.index(symbol[1])] = -value
    for i in range(6):
        for j in range(6):
            if f"{COMPONENTS[i]}{MOTIONS[j]}dot" not in accelerations:
                matrix[i, j] = matrix[j, i]
    return matrix


def _refuse_doubts(matrix: Array, path: Path) -> None:
    doubts = matrix_doubts(matrix)
    if doubts:
        raise InputError("; ".join(doubts), "the added mass of a kinetic energy", file=path)


def _mass(
    found: _Read, primed: bool, mass_unit: float, length_unit: float, scaling: Scaling, density: float
) -> StatedMass | None:
    """Mass where the centre of gravity is known too; in a file of primes a mass below one is a prime."""
    mass, forward = found.first("m", "mass"), found.first("xG", "x_G", "xg")
    if mass is None or forward is None or mass <= 0.0:
        return None
    kilograms = mass * 0.5 * density * scaling.length**3 if primed and mass < 1.0 else mass * mass_unit
    pitch, yaw = found.first("Iy", "Iyy"), found.first("Iz", "Izz")
    transverse = pitch * mass_unit * length_unit**2 if pitch is not None and pitch == yaw and pitch > 1.0 else None
    return StatedMass(kilograms, kilograms * forward * length_unit, transverse)

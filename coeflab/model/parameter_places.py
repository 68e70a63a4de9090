"""Places of a parameter file by name, so that a fit can read and move what stands there.

``Yv'``, ``C_S beta`` (a term of a fitted table), ``mass``, ``added_mass Yvdot`` (SI), ``thruster left ahead c0`` (coefficient of
the thrust curve, ``ahead`` or ``astern``), ``thruster left y`` (position). A minus in front takes the opposite sign.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.errors import InputError, shown
from coeflab.core.symbols import COMPONENTS, MOTIONS, derivative
from coeflab.kernels.brief import brief
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.parameter_vehicle import CurveSegment, ParameterThruster

EXPECTED = "a coefficient (Yv'), a term of a table (C_S beta), mass, added_mass Yvdot, thruster NAME ahead c0 or thruster NAME y"
AXES = "xyz"


@brief
@dataclass(frozen=True, slots=True)
class Place:
    """One number of a parameter file.

    Attributes
    ----------
    text : str
        As written.
    kind : {"coefficient", "term", "mass", "added_mass", "curve", "position"}
    key : tuple
        Where, in terms of the kind.
    sign : float
    unit : str
    """

    text: str
    kind: str
    key: tuple[Any, ...]
    sign: float
    unit: str


def place(text: str, p: ParameterFile) -> Place:
    """The place of a name.

    Raises
    ------
    InputError
        No such place, or nothing stands there.
    """
    bare = text.strip().removeprefix("-").strip()
    words, sign = bare.split(), -1.0 if text.strip().startswith("-") else 1.0
    found: tuple[str, tuple[Any, ...], str] | None = None
    if bare == "mass" and p.mass is not None:
        found = "mass", (), "kg"
    elif len(words) == 2 and words[0] == "added_mass" and p.added_mass is not None:
        d = derivative(words[1])
        if len(d.factors) == 1 and d.factors[0].endswith("dot"):
            at = COMPONENTS.index(d.component), MOTIONS.index(d.factors[0].removesuffix("dot"))
            found = "added_mass", at, "kg" if max(at) < 3 else "kg m^2" if min(at) >= 3 else "kg m"
    elif len(words) > 2 and words[0] == "thruster":
        found = _of_thruster(words[1:], p)
    elif len(words) == 1 and (c := p.coefficient(bare)) is not None and c.value is not None:
        found = "coefficient", (c.symbol,), "1"
    else:
        for i, m in enumerate(p.models):
            for j, t in enumerate(m.terms):
                if f"{m.response} {t.symbol}" == bare and t.value is not None:
                    found = "term", (i, j), m.unit
    if found is None:
        raise InputError(f"the place {shown(text)}", EXPECTED, advice=f"The file has {_listed(p)}.")
    return Place(text, found[0], found[1], sign, found[2])


def _of_thruster(words: list[str], p: ParameterFile) -> tuple[str, tuple[Any, ...], str] | None:
    at = next((i for i, t in enumerate(p.thrusters) if t.name == words[0]), None)
    if at is None:
        return None
    if len(words) == 2 and words[1] in tuple(AXES):
        return "position", (at, AXES.index(words[1])), "m"
    if len(words) == 3 and words[1] in ("ahead", "astern") and words[2][:1] == "c" and words[2][1:].isdigit():
        segment, power = _segment(p.thrusters[at], words[1] == "ahead"), int(words[2][1:])
        if segment is not None and power < len(p.thrusters[at].curve.segments[segment].coefficients):
            unit = p.thrusters[at].curve.unit
            return "curve", (at, segment, power), "N" if not power else f"N/{unit}" + (f"^{power}" if power > 1 else "")
    return None


def _segment(thruster: ParameterThruster, ahead: bool) -> int | None:
    """The first segment that pushes ahead, or the last one that pushes astern."""
    pushing = [i for i, s in enumerate(thruster.curve.segments) if (s.at(s.high) > 0.0 if ahead else s.at(s.low) < 0.0)]
    return (pushing[0] if ahead else pushing[-1]) if pushing else None


def _listed(p: ParameterFile) -> str:
    names = [c.symbol for c in p.coefficients if c.value is not None]
    names += [f"{m.response} {t.symbol}" for m in p.models for t in m.terms if t.value is not None]
    names += [f"thruster {t.name}" for t in p.thrusters]
    return ", ".join(names) or "no coefficient, table or thruster"


def value_at(p: ParameterFile, where: Place) -> float:
    """What stands at a place, with its sign."""
    key = where.key
    if where.kind == "coefficient":
        c = p.coefficient(key[0])
        found = c.value if c is not None else None
    elif where.kind == "term":
        found = p.models[key[0]].terms[key[1]].value
    elif where.kind == "mass":
        found = p.mass.mass if p.mass is not None else None
    elif where.kind == "added_mass":
        found = -p.added_mass.matrix[key[0]][key[1]] if p.added_mass is not None else None
    elif where.kind == "position":
        found = p.thrusters[key[0]].position[key[1]]
    else:
        found = p.thrusters[key[0]].curve.segments[key[1]].coefficients[key[2]]
    if found is None:
        raise InputError(f"nothing at {shown(where.text)}", "a value")
    return where.sign * found


def moved(p: ParameterFile, values: Mapping[Place, float]) -> ParameterFile:
    """The file with other values at places; not validated again, so that a fit may pass through what cannot be."""
    for where, value in values.items():
        p = _moved(p, where, where.sign * value)
    return p


def _moved(p: ParameterFile, where: Place, value: float) -> ParameterFile:
    key = where.key
    if where.kind == "coefficient":
        changed = tuple(
            c.model_copy(update={"value": value, "value_si": _si(c.value, c.value_si, value, p, c.symbol)})
            if c.symbol == key[0]
            else c
            for c in p.coefficients
        )
        return p.model_copy(update={"coefficients": changed})
    if where.kind == "term":
        m = p.models[key[0]]
        terms = _with(m.terms, key[1], m.terms[key[1]].model_copy(update={"value": value}))
        return p.model_copy(update={"models": _with(p.models, key[0], m.model_copy(update={"terms": terms}))})
    if where.kind == "mass" and p.mass is not None:
        ratio = value / p.mass.mass
        scaled = {n: getattr(p.mass, n) * ratio for n in ("mass_moment", "mass_prime", "mass_moment_prime")}
        return p.model_copy(update={"mass": p.mass.model_copy(update={"mass": value, **scaled})})
    if where.kind == "added_mass" and p.added_mass is not None:
        matrix = np.array(p.added_mass.matrix)
        matrix[key[0], key[1]] = matrix[key[1], key[0]] = -value
        rows = tuple(tuple(row) for row in matrix.tolist())
        return p.model_copy(update={"added_mass": p.added_mass.model_copy(update={"matrix": rows})})
    t = p.thrusters[key[0]]
    if where.kind == "position":
        t = t.model_copy(update={"position": _with(t.position, key[1], value)})
    else:
        t = t.model_copy(update={"curve": _curve(t, key[1], key[2], value)})
    return p.model_copy(update={"thrusters": _with(p.thrusters, key[0], t)})


def _si(old: float | None, old_si: float | None, value: float, p: ParameterFile, symbol: str) -> float | None:
    if old_si is None:
        return None
    if old:
        return old_si / old * value
    from coeflab.model.scaling import Conditions, Scaling

    primes = Scaling(p.scaling.length, p.scaling.length_name)
    return value * primes.factor(symbol, Conditions(p.conditions.density, p.conditions.speed))


def _with(values: tuple[Any, ...], at: int, value: Any) -> tuple[Any, ...]:
    return (*values[:at], value, *values[at + 1 :])


def _curve(thruster: ParameterThruster, at: int, power: int, value: float) -> Any:
    """The curve with one coefficient moved, its dead zone ending where the thrust is zero."""
    segments = thruster.curve.segments
    s = segments[at]
    ahead = s.at(s.high) > 0.0
    began_at_zero = abs(s.at(s.low if ahead else s.high)) <= 1e-6 * max(abs(s.at(s.low)), abs(s.at(s.high)))
    coefficients = _with(s.coefficients, power, value)
    update: dict[str, Any] = {"coefficients": coefficients}
    edge = s.low if ahead else s.high
    at_edge = CurveSegment(low=s.low, high=s.high, coefficients=coefficients).at(edge)
    pushes_back = at_edge < 0.0 if ahead else at_edge > 0.0
    zero = _zero(coefficients, edge) if began_at_zero or pushes_back else None
    if zero is not None:
        floor = segments[at - 1].high if at > 0 else -np.inf
        roof = segments[at + 1].low if at + 1 < len(segments) else np.inf
        if ahead and floor <= zero < s.high:
            update["low"] = zero
        elif not ahead and s.low < zero <= roof:
            update["high"] = zero
    changed: CurveSegment = s.model_copy(update=update)
    return thruster.curve.model_copy(update={"segments": _with(segments, at, changed)})


def _zero(coefficients: tuple[float, ...], near: float) -> float | None:
    """The command nearest to another at which a polynomial is zero."""
    roots = np.roots(coefficients[::-1])
    real = roots.real[np.abs(roots.imag) <= 1e-9 * np.maximum(1.0, np.abs(roots.real))]
    return float(real[np.argmin(np.abs(real - near))]) if real.size else None

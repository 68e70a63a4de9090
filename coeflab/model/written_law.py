"""The force law of a parameter file as named numbers and expressions, for targets that are programs.

Absolute values in a name are written with ``a`` before the factor, ``Yvav`` for Yv|v|, as in MSS navalvessel.m.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from coeflab.core.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.kernels.brief import brief
from coeflab.kernels.terms import Term, parse_suffix
from coeflab.model.force_law import force_law
from coeflab.model.inertia import water_inertia
from coeflab.model.parameter_file import ParameterFile

_SPELT = re.compile(r"a(dr|ds|db|[uvwpqr](?!dot))")


@brief
@dataclass(frozen=True, slots=True)
class WrittenTerm:
    """One term of the law.

    Attributes
    ----------
    group : {"prime", "rest", "potential"}
        Primed and multiplied by 1/2 rho L^k and a power of U; SI, whatever U is; primed products of the ideal fluid.
    name : str
        SNAME, spelt for a program.
    value : float
    component : str
    length_power : int
        k of 1/2 rho L^k; 0 for SI.
    speed_power : int
    term : Term
    note : str
        U95 and origin, in words.
    """

    group: str
    name: str
    value: float
    component: str
    length_power: int
    speed_power: int
    term: Term
    note: str

    def expression(self, place: Callable[[str, str], str], power: str) -> str:
        """The term as an expression.

        Parameters
        ----------
        place : callable
            Group and name -> what the program calls the number.
        power : str
            ``^`` or ``**``.
        """
        parts = [f"r{self.length_power}"] if self.length_power else []
        parts.append(place(self.group, self.name))
        if self.speed_power > 0:
            parts.append("U" + (f"{power}{self.speed_power}" if self.speed_power > 1 else ""))
        for variable, n, absolute in self.term.factors:
            parts.append((f"abs({variable})" if absolute else variable) + (f"{power}{n}" if n > 1 else ""))
        text = "*".join(parts)
        return (
            text
            if self.speed_power >= 0
            else f"{text}/U" + (f"{power}{-self.speed_power}" if self.speed_power < -1 else "")
        )


def spelt(symbol: str) -> str:
    """``Yv|v|'`` as a program can name it: ``Yvav``."""
    return re.sub(r"\|(\w+)\|", r"a\1", symbol.removesuffix("'"))


def sname(name: str) -> str:
    """The SNAME symbol, without prime, of a name that `spelt` made."""
    return name[:1] + _SPELT.sub(r"|\1|", name[1:])


def written_terms(parameters: ParameterFile) -> tuple[WrittenTerm, ...]:
    """Every coefficient with a value but accelerations, then the ideal fluid's products that these leave open."""
    density, length = parameters.conditions.density, parameters.scaling.length
    out = []
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is None or any(f.endswith("dot") for f in d.factors):
            continue
        note = c.origin if c.u95 is None else f"U95 {c.u95:.2g}, {c.origin}"
        rest = c.law == "rest" and c.value_si is not None
        value = c.value_si if rest and c.value_si is not None else c.value
        scale, power = (0, 0) if rest else (d.powers[1], d.powers[0])
        out.append(
            WrittenTerm(
                "rest" if rest else "prime",
                spelt(d.text),
                value,
                d.component,
                scale,
                power,
                parse_suffix(d.text[1:]),
                note,
            )
        )
    ideal = force_law(parameters).ideal
    for i, component in enumerate(COMPONENTS):
        for j, first in enumerate(MOTIONS):
            for k, second in enumerate(MOTIONS[j:], j):
                value = ideal[i, j, k] * (1.0 if j == k else 2.0)
                name = component + first + second
                scale = derivative(name).powers[1]
                if value:
                    prime = float(value / (0.5 * density * length**scale))
                    term = parse_suffix(first + second)
                    out.append(WrittenTerm("potential", name, prime, component, scale, 0, term, ""))
    return tuple(out)


def written_accelerations(parameters: ParameterFile) -> tuple[dict[str, float], str]:
    """Primed acceleration derivatives that are not zero, and where they come from."""
    water = water_inertia(parameters)
    matrix, source = water.matrix, water.source
    density, length = parameters.conditions.density, parameters.scaling.length
    out = {}
    for i, component in enumerate(COMPONENTS):
        for j, motion in enumerate(MOTIONS):
            if matrix[i, j]:
                name = f"{component}{motion}dot"
                out[name] = float(-matrix[i, j] / (0.5 * density * length ** derivative(name).powers[1]))
    return out, source


def written_controls(terms: tuple[WrittenTerm, ...]) -> tuple[str, ...]:
    """The controls that terms use."""
    used = {v for t in terms for v, _, _ in t.term.factors}
    return tuple(c for c in CONTROLS if c in used)


def not_written(parameters: ParameterFile) -> tuple[str, ...]:
    """What no expression of velocities and controls holds: products with an acceleration."""
    dots = [s for s in force_law(parameters).left_out if "dot" in s]
    return tuple(f"{s} (product with an acceleration)" for s in dots if len(derivative(s).factors) > 1)


def written_changes(parameters: ParameterFile, target: str, ideal: str, matrix: str) -> tuple[str, ...]:
    """How any program has the law, in words.

    Parameters
    ----------
    parameters : ParameterFile
    target : str
        Who adds no C_A(nu) nu.
    ideal : str
        As what the ideal fluid's products stand.
    matrix : str
        What the added mass is called.
    """
    water = water_inertia(parameters)
    return (
        "axes, signs, primes and reference point are the file's; primes are multiplied by 1/2 rho L^k U^n in the program",
        f"totals are written, for {target} adds no C_A(nu) nu; products of the ideal fluid that nothing measured speaks of stand as "
        f"{ideal}",
        f"{matrix}: {water.source}",
        *water.warnings,
    )

"""The steady hydrodynamic force that a parameter file states, as a function of the velocities.

Measured terms are taken as measured, potential part and all. Where an added-mass matrix is known, those products of two
velocities that no measured term speaks of get their share of -C_A(nu) nu of the added mass that the vehicle moves with
(`coeflab.model.inertia`), so that nothing is counted twice and nothing known is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, CONTROLS, MOTIONS, derivative
from coeflab.kernels.brief import brief
from coeflab.kernels.kirchhoff import ideal_quadratics
from coeflab.kernels.terms import Term, parse_suffix
from coeflab.model.frozen import locked
from coeflab.model.inertia import water_inertia
from coeflab.model.parameter_file import ParameterFile

Array = NDArray[np.float64]
SLOWEST = 1e-9


@brief
@dataclass(frozen=True, slots=True)
class LawTerm:
    """One term of the law: coefficient times velocities times a power of the speed.

    Attributes
    ----------
    symbol : str
        Without prime.
    component : str
    term : Term
        Over u v w p q r in m/s and rad/s, without the speed.
    coefficient : float
        SI, with the density in it.
    speed_power : int
        Of U = |(u, v, w)|.
    potential : float or None
        Part of the coefficient that an ideal fluid gives; None where that is not known.
    """

    symbol: str
    component: str
    term: Term
    coefficient: float
    speed_power: int
    potential: float | None

    @property
    def pair(self) -> tuple[int, int] | None:
        """The product of two velocities that the term is near straight motion; None for others."""
        if any(a for _, _, a in self.term.factors) or self.term.degree > 2 or self.term.degree + self.speed_power != 2:
            return None
        at = sorted(MOTIONS.index(v) for v, n, _ in self.term.factors for _ in range(n))
        first, second = [0] * (2 - len(at)) + at
        return first, second


@brief
@dataclass(frozen=True, slots=True, eq=False)
class ForceLaw:
    """Terms, and the ideal fluid's quadratics of the products that they leave open.

    Attributes
    ----------
    terms : tuple of LawTerm
    ideal : (6, 6, 6) array
        Q of `coeflab.kernels.kirchhoff.ideal_quadratics`, zero where a measured term speaks.
    left_out : tuple of str
        Symbols with a value that are no part of the law: controls and accelerations.
    """

    terms: tuple[LawTerm, ...]
    ideal: Array
    left_out: tuple[str, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "ideal", locked(self.ideal))

    def force(self, nu: Array) -> Array:
        """X Y Z K M N, shape (n, 6), for velocities (n, 6) at the reference point."""
        speed = np.maximum(np.linalg.norm(nu[:, :3], axis=1), SLOWEST)
        columns = dict(zip(MOTIONS, nu.T, strict=True))
        out = np.einsum("ijk,nj,nk->ni", self.ideal, nu, nu)
        for t in self.terms:
            out[:, COMPONENTS.index(t.component)] += t.coefficient * speed**t.speed_power * t.term.evaluate(columns)
        return np.asarray(out)


def force_law(parameters: ParameterFile) -> ForceLaw:
    """The law of a parameter file at its density.

    Literature values stand in where nothing was fitted, as in the file. Coefficients without a value give nothing.
    """
    density, length = parameters.conditions.density, parameters.scaling.length
    terms, left_out = [], []
    for c in parameters.coefficients:
        d = derivative(c.symbol)
        if c.value is None:
            continue
        if any(f in CONTROLS or f.endswith("dot") for f in d.factors):
            left_out.append(d.text)
            continue
        term = parse_suffix(d.text[1:])
        scale = 0.5 * density * length ** d.powers[1]
        if c.law == "rest" and c.value_si is not None:
            value, power = c.value_si, 0
            scale = value / c.value if c.value else 0.0
        else:
            value, power = scale * c.value, 2 - term.degree
        potential = None if c.potential is None else c.potential * scale
        terms.append(LawTerm(d.text, d.component, term, value, power, potential))
    ideal = np.zeros((6, 6, 6))
    if parameters.added_mass is not None:
        ideal = np.where(_open(terms), ideal_quadratics(water_inertia(parameters).matrix), 0.0)
    return ForceLaw(tuple(terms), ideal, tuple(left_out))


def open_pairs(parameters: ParameterFile) -> NDArray[np.bool_]:
    """(6, 6, 6), by force and two velocities: the products that no measured term of a parameter file speaks of."""
    return _open(force_law(parameters).terms)


def _open(terms: Sequence[LawTerm]) -> NDArray[np.bool_]:
    out = np.ones((6, 6, 6), dtype=bool)
    for t in terms:
        if t.pair is not None:
            i, (j, k) = COMPONENTS.index(t.component), t.pair
            out[i, j, k] = out[i, k, j] = False
    return out

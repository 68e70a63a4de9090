"""An operating point: the solution of named equations in named unknowns, with all that may be said of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum

import numpy as np

from coeflab.core.table import Table, number
from coeflab.core.types import Array, in_angles
from coeflab.motion.small_motions import Growth
from coeflab.motion.trim.moves import HOLDS
from coeflab.motion.trim.solver import Found, Problem, solve

FAMILY_SHOWN = 0.05  # an unknown that moves less, of the one that moves most, is left out of the words
NOTABLE_SHARE = 1e-2  # an equation violated less, of the worst, is left out of the words


class Outcome(Enum):
    """What came of the search."""

    UNIQUE = "unique"
    SEVERAL = "several"
    FAMILY = "family"
    SINGULAR = "singular"
    INFEASIBLE = "infeasible"
    NOT_CONVERGED = "not_converged"

    @property
    def solved(self) -> bool:
        """Whether the equations hold."""
        return self not in (Outcome.INFEASIBLE, Outcome.NOT_CONVERGED)


@dataclass(frozen=True, slots=True)
class Unknown:
    """A quantity to be found; given where low and high are one.

    Attributes
    ----------
    name, unit : str
    low, high : float
    scale : float
        A change that counts as one.
    target, weight : float
        The rule of selection: the least sum of (weight (x - target) / scale)^2; a weight of zero does not count.
    force : callable or None
        Of a command with a target of zero: its force in N, which the rule counts over `strongest` instead; it rises with x.
    strongest : float
        N.
    """

    name: str
    unit: str
    low: float
    high: float
    scale: float
    target: float = 0.0
    weight: float = 1.0
    force: Callable[[float], float] | None = None
    strongest: float = 1.0

    def shown(self, value: float, digits: int = 6) -> str:
        """A value with its unit, angles in degrees; 0 where it is less than a search can tell from it."""
        value = 0.0 if abs(value) < HOLDS * self.scale else value
        turned = self.unit.startswith("rad")
        text = number(float(np.degrees(value) if turned else value) + 0.0, digits)
        return f"{text} {self.unit.replace('rad', 'deg') if turned else self.unit}"

    def at(self, value: float) -> Unknown:
        """The same, given."""
        return replace(self, low=value, high=value, target=value, weight=0.0)


@dataclass(frozen=True, slots=True)
class Equation:
    """An equation that has to be zero; it holds to 1e-9 of ``size``."""

    name: str
    unit: str
    size: float


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class OperatingPoint:
    """Result of `operating_point`.

    Attributes
    ----------
    unknowns : tuple of Unknown
    equations : tuple of Equation
    found : Found
    rule : str
        How one solution is chosen among several, in words.
    modes : tuple of complex
        Eigenvalues of small motions about it, 1/s, the least stable first; empty where they were not asked for.
    growth : {"stable", "neutral", "unstable"} or None
    statements : tuple of str
    """

    unknowns: tuple[Unknown, ...]
    equations: tuple[Equation, ...]
    found: Found
    rule: str
    modes: tuple[complex, ...] = ()
    growth: Growth | None = None
    statements: tuple[str, ...] = field(default=())

    @property
    def outcome(self) -> Outcome:
        """Kind of solution, as far as the starts have shown."""
        f = self.found
        if not f.holds:
            return Outcome.INFEASIBLE if f.settled else Outcome.NOT_CONVERGED
        if f.singular:
            return Outcome.SINGULAR
        if self.dimension:
            return Outcome.FAMILY
        return Outcome.SEVERAL if len(f.others) else Outcome.UNIQUE

    @property
    def dimension(self) -> int:
        """How many parameters the family of solutions has; zero for isolated ones."""
        return int(self.found.family.shape[1])

    @property
    def family(self) -> tuple[Mapping[str, float], ...]:
        """How solutions of a family go on from this one: a direction a parameter, every unknown by name, the largest scaled change one."""
        scale = np.array([u.scale for u in self.unknowns])
        return tuple(
            {u.name: float(x) for u, x in zip(self.unknowns, d / np.max(np.abs(d / scale)), strict=True)}
            for d in self.found.family.T
        )

    def __repr__(self) -> str:
        found = ", ".join(f"{u.name} {u.shown(x, 4)}" for u, x in zip(self.unknowns, self.found.point, strict=True))
        return in_angles(self, f"{self.outcome.value}: {found}")

    @property
    def values(self) -> Mapping[str, float]:
        """Every unknown by its name."""
        return {u.name: float(x) + 0.0 for u, x in zip(self.unknowns, self.found.point, strict=True)}

    @property
    def residuals(self) -> Mapping[str, float]:
        """What is left of every equation."""
        return {e.name: float(x) + 0.0 for e, x in zip(self.equations, self.found.residuals, strict=True)}

    @property
    def violated(self) -> tuple[Equation, ...]:
        """Equations that do not hold, the worst first."""
        share = {e.name: abs(self.residuals[e.name]) / e.size for e in self.equations}
        return tuple(sorted((e for e in self.equations if share[e.name] > HOLDS), key=lambda e: -share[e.name]))

    @property
    def saturated(self) -> tuple[tuple[Unknown, float], ...]:
        """Unknowns that a bound holds back, with that bound."""
        f = self.found
        return tuple(
            (u, u.low if low else u.high) for u, low, h in zip(self.unknowns, f.at_low, f.held, strict=True) if h
        )

    def words(self) -> tuple[str, ...]:
        """What was found, in sentences."""
        f = self.found
        tried = f"{f.reached} of {f.starts} starts"
        free = sum(u.low < u.high for u in self.unknowns)
        count = f"{free} unknowns, {len(self.equations)} equations of rank {f.rank}"
        phrases = {
            Outcome.UNIQUE: f"One solution: {count}; {tried} converged to it, none to another.",
            Outcome.SEVERAL: f"{1 + len(f.others)} isolated solutions: {count}; {tried} converged to one of them.",
            Outcome.FAMILY: f"Not unique: a family of {self.dimension} parameter{'s' * (self.dimension > 1)}; {count}.",
            Outcome.SINGULAR: f"One solution, where the equations are singular: {count}; none found beside it.",
            Outcome.INFEASIBLE: f"No solution within the bounds: none of {f.starts} starts converged to one. "
            + self._least(),
            Outcome.NOT_CONVERGED: f"The search did not converge from any of {f.starts} starts. " + self._least(),
        }[self.outcome]
        out = [phrases]
        if self.outcome in (Outcome.FAMILY, Outcome.SEVERAL):
            out.append(f"Chosen by the rule: {self.rule}.")
        if self.outcome is Outcome.FAMILY:
            out += [self._direction(d) for d in f.family.T]
            if len(f.others):
                out.append(f"{len(f.others)} other local least{'s' * (len(f.others) > 1)} of the rule, each with more.")
        out += self._held()
        if self.growth is not None:
            slowest = self.modes[0]
            out.append(f"Small motions about it are {self.growth}: largest real part {slowest.real:.4g} 1/s.")
        return (*out, *self.statements)

    def doubts(self) -> tuple[str, ...]:
        """That it is not the only solution, and what a bound holds."""
        first = {Outcome.FAMILY, Outcome.SEVERAL, Outcome.SINGULAR} & {self.outcome}
        return (*self.words()[: len(first)], *self._held())

    def _held(self) -> list[str]:
        return [f"{u.name} is held at its bound of {u.shown(b)}." for u, b in self.saturated]

    def _least(self) -> str:
        worst = max((abs(self.residuals[e.name]) / e.size for e in self.violated), default=0.0)
        left = [
            f"{e.name} is off by {number(self.residuals[e.name], 4)} {e.unit}"
            for e in self.violated
            if abs(self.residuals[e.name]) / e.size >= NOTABLE_SHARE * worst
        ]
        return f"At the least violation {', '.join(left)}."

    def _direction(self, direction: Array) -> str:
        scaled = direction / np.array([u.scale for u in self.unknowns])
        moving = np.abs(scaled) > FAMILY_SHOWN * np.max(np.abs(scaled))
        share = direction / np.max(np.abs(scaled))
        parts = [f"{u.name} {u.shown(share[i], 3)}" for i, u in enumerate(self.unknowns) if moving[i]]
        return f"The family extends along {', '.join(parts)}."

    def table(self) -> Table:
        """Unknowns with their bounds, angles in degrees; what was found in sentences."""
        rows = []
        for u, x, held in zip(self.unknowns, self.found.point, self.found.held, strict=True):
            bounds = "given" if u.low == u.high else f"{u.shown(u.low, 4).partition(' ')[0]} .. {u.shown(u.high, 4)}"
            value, _, unit = u.shown(float(x)).partition(" ")
            rows.append((u.name, value, unit, bounds, "held" if held else ""))
        return Table(
            "Operating point", ("", "value", "unit", "bounds", ""), tuple(rows), self.words(), frozenset({0, 2, 3, 4})
        )


def least_effort(unknowns: Sequence[Unknown]) -> str:
    """The rule in words, as the weights of the unknowns have it."""
    parts = [
        f"thrust of {u.name} / {number(u.strongest / u.weight, 4)} N"
        if u.force is not None
        else f"{f'({u.name} - {u.shown(u.target)})' if u.target else u.name} / {u.shown(u.scale / u.weight, 4)}"
        for u in unknowns
        if u.weight > 0.0 and u.low < u.high
    ]
    return f"the least sum of squares of {', '.join(parts)}" if parts else "the one that the first start converges to"


def nearest(unknowns: Sequence[Unknown], point: Mapping[str, float]) -> tuple[Unknown, ...]:
    """Unknowns whose rule is to stay near a point in their scales; those that it does not name do not count."""
    return tuple(
        replace(u, target=point[u.name], weight=1.0, force=None) if u.name in point else replace(u, weight=0.0)
        for u in unknowns
    )


def operating_point(
    unknowns: Sequence[Unknown],
    equations: Sequence[Equation],
    function: Callable[[Array], Array],
    first: Sequence[float] | None = None,
    starts: int = 8,
    seed: int = 0,
) -> OperatingPoint:
    """Solve, select, and look for other solutions.

    Parameters
    ----------
    unknowns, equations : sequence
    function : callable
        (n,) values -> (m,) residuals, in the order and the units of both.
    first : sequence of float, optional
        A first start; the targets where None.
    starts, seed : int
        Seeded cold starts.
    """

    def column(name: str) -> Array:
        return np.array([getattr(u, name) for u in unknowns])

    forces = [(i, u.force, u.strongest) for i, u in enumerate(unknowns) if u.force is not None]
    scale = column("scale")

    def spent(x: Array) -> Array:
        out = x / scale
        for i, force, strongest in forces:
            out[i] = force(float(x[i])) / strongest
        return np.asarray(out)

    problem = Problem(
        function, column("low"), column("high"), scale, np.array([e.size for e in equations]),
        column("target"), column("weight"), spent=spent if forces else None,
    )  # fmt: skip
    found = solve(problem, None if first is None else np.array(first), starts, seed)
    return OperatingPoint(tuple(unknowns), tuple(equations), found, least_effort(unknowns))

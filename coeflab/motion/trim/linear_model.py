"""The linear model of small motions about a steady one: x_dot = A x + B d, with the error of its derivatives and its modes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.types import Array, brief
from coeflab.motion.dynamics import NEUTRAL, STEP, Slopes, modes, participation
from coeflab.motion.trim.trim import Trim

RATES = {"m/s": "m/s^2", "rad/s": "rad/s^2", "rad": "rad/s"}
LEAST_ERROR = 1e-10  # that is stated


@dataclass(frozen=True, slots=True)
class Variable:
    """A state or a command of the model: its name, its SI unit and its value in the steady motion."""

    name: str
    unit: str
    value: float


@dataclass(frozen=True, slots=True)
class Mode:
    """An eigenvalue of A.

    Attributes
    ----------
    eigenvalue : complex
        1/s.
    shares : mapping of str to float
        Participation of every state, their sum one: the product of left and right eigenvectors, which no unit changes.
    neutral : bool
        Neither grows nor dies out, within rounding.
    """

    eigenvalue: complex
    shares: Mapping[str, float]
    neutral: bool

    @property
    def doubles(self) -> float | None:
        """Time to double, s; None of one that does not grow."""
        return math.log(2.0) / self.eigenvalue.real if not self.neutral and self.eigenvalue.real > 0.0 else None

    @property
    def halves(self) -> float | None:
        """Time to halve, s; None of one that does not die out."""
        return -math.log(2.0) / self.eigenvalue.real if not self.neutral and self.eigenvalue.real < 0.0 else None

    @property
    def period(self) -> float | None:
        """Of the oscillation, s; None of a real eigenvalue."""
        return 2.0 * math.pi / abs(self.eigenvalue.imag) if self.eigenvalue.imag else None


@brief
@dataclass(frozen=True, slots=True, eq=False)
class LinearModel:
    """Small departures x of the states and d of the commands from a steady motion: x_dot = A x + B d.

    Attributes
    ----------
    vehicle : str
    states, commands : tuple of Variable
        Velocities that are free to change, then roll where p is and pitch where q is; SI, rad, FRD.
    a, b : Slopes
        (n, n) and (n, m).
    modes : tuple of Mode
        The least stable first.
    statements : tuple of str
    """

    vehicle: str
    states: tuple[Variable, ...]
    commands: tuple[Variable, ...]
    a: Slopes
    b: Slopes
    modes: tuple[Mode, ...]
    statements: tuple[str, ...]

    @property
    def A(self) -> Array:  # noqa: N802 - as every textbook has it
        """(n, n) of the states."""
        return self.a.matrix

    @property
    def B(self) -> Array:  # noqa: N802
        """(n, m) of the commands."""
        return self.b.matrix

    @property
    def rate_units(self) -> tuple[str, ...]:
        """Unit of the rate of every state."""
        return tuple(RATES[s.unit] for s in self.states)


def linear_model(found: Trim) -> LinearModel:
    """Linearise about the steady motion that trim found.

    Parameters
    ----------
    found : Trim

    Raises
    ------
    InputError
        No steady motion was found, or rates that are not finite.
    """
    if not found.point.outcome.solved:
        raise InputError(
            "no steady motion to linearise about", "a motion that the commands can keep", column="--linear"
        )
    steady, x = found.motion, found.point.found.point
    a, b = steady.state_slopes(x), steady.command_slopes(x)
    states = tuple(Variable(n, u, float(v) + 0.0) for (n, u), v in zip(steady.states, steady.departed(x), strict=True))
    commands = tuple(Variable(u.name, u.unit, found.point.values[u.name]) for u in steady.command_unknowns)
    shares = participation(a.matrix)
    values = modes(a.matrix)
    fastest = max(1.0, float(np.max(np.abs(values), initial=0.0)))
    named = [s.name for s in states]
    found_modes = tuple(
        Mode(complex(v), dict(zip(named, part.tolist(), strict=True)), abs(v.real) <= NEUTRAL * fastest)
        for v, part in zip(values, shares, strict=True)
    )
    return LinearModel(
        found.motion.vehicle.name, states, commands, a, b, found_modes, (*_accuracy(a, b), *_kinks(a, b, states, commands))
    )  # fmt: skip


def _accuracy(a: Slopes, b: Slopes) -> tuple[str, ...]:
    """To a power of ten upwards: the digits of rounding differ from machine to machine."""
    below = [10.0 ** math.ceil(math.log10(max(float(np.max(s.error, initial=0.0)), LEAST_ERROR))) for s in (a, b)]
    return (
        f"Derivatives are central differences of the equations of motion with steps of {STEP:g} and {STEP / 2.0:g} of each "
        "variable's scale, extrapolated. Their error, twice the change when the steps are halved, is below "
        f"{below[0]:g} in A and {below[1]:g} in B",
    )


def _kinks(a: Slopes, b: Slopes, states: tuple[Variable, ...], commands: tuple[Variable, ...]) -> tuple[str, ...]:
    out = []
    for found, variables in ((a, states), (b, commands)):
        for i, variable in enumerate(variables):
            rows = [s.name for s, kink in zip(states, found.kinks[:, i], strict=True) if kink]
            if rows:
                out.append(
                    f"At {variable.name} = {variable.value:.4g} {variable.unit} slopes to either side differ for the rates of "
                    f"{', '.join(rows)}: the mean stands here, and no linear model holds on both sides"
                )
    return tuple(out)

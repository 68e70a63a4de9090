"""Parameters of a model tuned to what was measured: values, intervals where there are any, and what the data leave open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.wording import listed
from coeflab.kernels.brief import brief
from coeflab.kernels.output_error import Estimate
from coeflab.kernels.output_problem import Problem
from coeflab.model.frozen import locked
from coeflab.model.table import number

Array = NDArray[np.float64]
OK, PRIOR, BOUND, OPEN = "ok", "prior_only", "at_bound", "not_identifiable"
STATUSES = {
    OK: "the data determine it",
    PRIOR: "more than nine tenths of what is known of it is its prior",
    BOUND: "it ended at a bound, so there is no interval",
    OPEN: "the data do not determine it: its 95 % half-width would exceed its own size; no interval",
}
MOSTLY = 0.9  # of the variance from the prior: the data hardly add to it
SAME_RATIO = 0.25  # changes alike within a quarter read as a ratio
TAKES_PART = 0.05  # of the largest change: less is not named


@dataclass(frozen=True, slots=True)
class TunedParameter:
    """One parameter.

    Attributes
    ----------
    name, unit : str
    before, after : float
    u95 : float or None
        95 % half-width; None where the status gives none.
    prior_share : float
        0: the data alone speak, 1: the prior alone.
    status : str
        A key of `STATUSES`.
    """

    name: str
    unit: str
    before: float
    after: float
    u95: float | None
    prior_share: float
    status: str


@brief
@dataclass(frozen=True, slots=True, eq=False)
class TunedQuantity:
    """One measured quantity, a value a case; NaN where it was not measured.

    Attributes
    ----------
    name, unit : str
    measured, before, after : (n,) arrays
    error : (n,) array
        Standard error that weighed each case.
    """

    name: str
    unit: str
    measured: Array
    before: Array
    after: Array
    error: Array

    def __post_init__(self) -> None:
        for name in ("measured", "before", "after", "error"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    def rms(self, after: bool = True) -> float:
        """Root mean square of model minus measured."""
        return float(np.sqrt(np.nanmean((np.asarray(self.after if after else self.before) - self.measured) ** 2)))

    @property
    def count(self) -> int:
        """Cases in which it was measured."""
        return int(np.isfinite(self.measured).sum())

    @property
    def worst(self) -> float:
        """Largest difference of model and measurement, after the fit."""
        return float(np.nanmax(np.abs(self.after - self.measured)))


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Tuning:
    """What came of a fit.

    Attributes
    ----------
    name : str
    parameters : tuple of TunedParameter
    correlation : (p, p) array
        NaN where a parameter has no interval.
    covariance : (p, p) array
    quantities : tuple of TunedQuantity
    together : tuple of str
        Combinations that the data leave open, in words.
    singular : (p,) array
        Of the Jacobian, outputs by their errors, parameters by their sizes.
    birge : float
    freedom : float
    converged : bool
    statements : tuple of str
    """

    name: str
    parameters: tuple[TunedParameter, ...]
    correlation: Array
    covariance: Array
    quantities: tuple[TunedQuantity, ...]
    together: tuple[str, ...]
    singular: Array
    birge: float
    freedom: float
    converged: bool
    statements: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("correlation", "covariance", "singular"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    def parameter(self, name: str) -> TunedParameter:
        """The parameter of a name."""
        return next(p for p in self.parameters if p.name == name)

    def quantity(self, name: str) -> TunedQuantity:
        """The quantity of a name."""
        return next(q for q in self.quantities if q.name == name)


def tuned_parameters(
    names: Sequence[str], units: Sequence[str], p: Problem, found: Estimate
) -> tuple[TunedParameter, ...]:
    """Every parameter with its status."""
    errors = found.standard_errors
    out = []
    for i, name in enumerate(names):
        if found.at_bound[i]:
            status = BOUND
        elif found.open[i]:
            status = OPEN
        else:
            status = PRIOR if found.prior_share[i] > MOSTLY else OK
        u95 = None if status in (BOUND, OPEN) else 2.0 * float(errors[i])
        share = float(found.prior_share[i]) if status in (OK, PRIOR) else 0.0
        out.append(TunedParameter(name, units[i], float(p.start[i]), float(found.parameters[i]), u95, share, status))
    return tuple(out)


def statements(p: Problem, found: Estimate) -> tuple[str, ...]:
    """How the intervals are to be read."""
    out = []
    if not found.converged:
        out.append(f"The fit did not come to an end ({found.message}); its numbers are those of the last step.")
    if found.birge > 1.0:
        out.append(
            f"The residuals are {found.birge:.2g} times the stated errors; the intervals are widened by that (Birge ratio)."
        )
    if np.any(found.open):
        out.append("Parameters without an interval stand where a weak leash to the start left them.")
    out.append("Intervals hold for the form of the model and for everything that was not free at its value.")
    if int(np.isfinite(p.measured).sum()) <= len(p.start):
        out.append("There are no more measurements than parameters; nothing is left to judge the model by.")
    return tuple(out)


def together_in_words(names: Sequence[str], change: Array, values: Array) -> str:
    """A change of parameters that the outputs do not show, as a sentence; per cent are of sizes, + away from zero.

    Parameters
    ----------
    names : sequence of str
    change : (p,) array
        In units of the parameters' sizes, the largest entry 1.
    values : (p,) array
        What the parameters are; their signs count.
    """
    away = change * np.where(values < 0.0, -1.0, 1.0)
    away = away / away[np.argmax(np.abs(away))]
    parts = [(n, float(c)) for n, c in zip(names, away, strict=True) if abs(c) >= TAKES_PART]
    if len(parts) == 1:
        return f"{parts[0][0]}: the data hardly show it at all."
    together = listed([n for n, _ in parts])
    if all(abs(c - 1.0) <= SAME_RATIO for _, c in parts):
        only = "as a ratio" if len(parts) == 2 else "as ratios to each other"
        return f"{together}: only {only}; the data do not show all of them rise alike."
    shown = listed([f"{n} {100.0 * c:+.0f} %" for n, c in parts])
    return f"{together}: only together; the data do not show a change of {shown}."


def largest_correlations(tuning: Tuning, above: float = 0.7) -> tuple[tuple[str, str, float], ...]:
    """Pairs of parameters with a large correlation, the largest first."""
    names = [p.name for p in tuning.parameters]
    pairs = [
        (names[i], names[j], float(tuning.correlation[i, j]))
        for i in range(len(names))
        for j in range(i + 1, len(names))
        if abs(tuning.correlation[i, j]) >= above
    ]
    return tuple(sorted(pairs, key=lambda pair: -abs(pair[2])))


def moved_in_words(p: TunedParameter) -> str:
    """From where to where a parameter went."""
    interval = f" +- {number(p.u95, 2)}" if p.u95 is not None else ""
    prior = f", prior share {100.0 * p.prior_share:.0f} %" if p.prior_share else ""
    return f"{p.name}: from {number(p.before, 6)} to {number(p.after, 6)}{interval} {p.unit} ({p.status}{prior})"

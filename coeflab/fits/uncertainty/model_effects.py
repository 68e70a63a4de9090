"""How the uncertain inputs of a campaign move fitted models: the whole fit, repeated on moved tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.types import Array, dataclass, locking
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.uncertainty.moved_tables import SET_ANGLES, UncertainInput, moved, uncertain_inputs
from coeflab.fits.uncertainty.propagation import STEP, Propagated, normal_draws, summary_of
from coeflab.law.scaling import Scaling
from coeflab.tables.force_table import ForceTable

Refit = Callable[[Sequence[ForceTable], Scaling], FitResult]
ROUNDING = 1e-9
FEWEST_DRAWS = 100  # fits that came out: 2.5 % tails of two or three


@dataclass(frozen=True, slots=True, eq=False)
@locking("gradients sample nominal")
class ModelEffects:
    """Inputs carried to the numbers of a fit: the coefficients of its models in their order, then those of its set.

    Attributes
    ----------
    inputs : tuple of UncertainInput
        k of them.
    gradients : (k, m) array
        Derivative of every number by every input; NaN where the input changes which rows or terms its model has.
    sample : (s, m) array
        The numbers over all inputs at once, NaN likewise.
    nominal : (m,) array
    seed : int
    """

    inputs: tuple[UncertainInput, ...]
    gradients: Array
    sample: Array
    nominal: Array
    seed: int

    def shifts(self, numbers: slice) -> dict[str, Array]:
        """Signed 95 % shift of some numbers by every input that acts on them and could be carried to all of them."""
        known = np.isfinite(self.nominal[numbers])
        return {
            i.name: np.where(known, np.nan_to_num(row[numbers]), 0.0) * i.half_width
            for i, row in zip(self.inputs, self.gradients, strict=True)
            if np.all(np.isfinite(row[numbers][known])) and np.any(row[numbers][known] != 0.0)
        }

    def lacking(self, numbers: slice) -> tuple[UncertainInput, ...]:
        """Inputs that could not be carried to some numbers."""
        known = np.isfinite(self.nominal[numbers])
        return tuple(
            i
            for i, row in zip(self.inputs, self.gradients, strict=True)
            if not np.all(np.isfinite(row[numbers][known]))
        )

    def propagated(self, number: int) -> Propagated | None:
        """All inputs together on one number, linear beside Monte Carlo; None with fewer than 100 usable draws."""
        sample = self.sample[:, number]
        sample = sample[np.isfinite(sample)]
        if not self.inputs or len(sample) < min(FEWEST_DRAWS, len(self.sample)):
            return None
        covariance = np.diag((np.array([i.half_width for i in self.inputs]) / 2.0) ** 2)
        gradient = np.nan_to_num(self.gradients[:, number])
        return summary_of(sample, float(self.nominal[number]), gradient, covariance, self.seed)


def numbers_of(fit: FitResult) -> Array:
    """Coefficients of all models, then of the set; NaN where there is none."""
    among = [np.nan if c.value is None else c.value for c in fit.coefficients.coefficients]
    return np.concatenate([*(m.fit.coefficients for m in fit.models), np.array(among, dtype=float)])


def _moved_numbers(fit: FitResult, other: FitResult) -> Array | None:
    """Numbers of a moved fit, NaN for models with other rows or terms; None where the models are others altogether."""
    if [m.symbols for m in fit.models] != [m.symbols for m in other.models]:
        return None
    if fit.coefficients.symbols != other.coefficients.symbols:
        return None
    numbers, at, changed = numbers_of(other), 0, set()
    for one, two in zip(fit.models, other.models, strict=True):
        stop = at + len(one.symbols)
        if one.labels != two.labels:
            numbers[at:stop] = np.nan
            changed |= {s.removesuffix("'") for s in one.symbols}
        at = stop
    for i, c in enumerate(fit.coefficients.coefficients):
        if c.symbol in changed:
            numbers[at + i] = np.nan
    return numbers


def model_effects(
    fit: FitResult, tables: Sequence[ForceTable], scaling: Scaling, refit: Refit, draws: int, seed: int
) -> ModelEffects | None:
    """Effects of the declared inputs; None where none is declared or the fit chose its terms by looking at the data.

    Parameters
    ----------
    fit : FitResult
        With models, as the plugin made it from ``tables`` and ``scaling``.
    tables : sequence of ForceTable
    scaling : Scaling
    refit : callable
        The same plugin with the same options.
    draws, seed : int
        Of the Monte Carlo.
    """
    variables = dict.fromkeys(v for m in fit.models for v in m.domain.variables if _is_set(v, m.unit))
    inputs = uncertain_inputs(tables, tuple(variables))
    if not inputs or any(m.post_selection for m in fit.models):
        return None
    nominal = numbers_of(fit)
    nothing = np.full(len(nominal), np.nan)

    def numbers(some: Sequence[UncertainInput], errors: Array) -> Array:
        try:
            found = _moved_numbers(fit, refit(*moved(tables, scaling, some, errors)))
        except InputError:
            return nothing
        return nothing if found is None else found

    rows = []
    for given in inputs:
        step = STEP * given.half_width
        row = (numbers([given], np.array([step])) - numbers([given], np.array([-step]))) / (2.0 * step)
        rows.append(np.where(np.abs(row * given.half_width) <= ROUNDING * np.abs(nominal), 0.0, row))
    half = np.array([i.half_width for i in inputs])
    sample = [numbers(inputs, e) for e in normal_draws(np.diag((half / 2.0) ** 2), draws, seed)]
    return ModelEffects(inputs, np.array(rows), np.array(sample), nominal, seed)


def _is_set(variable: str, unit: str) -> bool:
    """Whether a variable is an angle that somebody set: alpha, beta, controls; v and w where they are primed."""
    return variable in SET_ANGLES and (unit == "1" or variable not in ("v", "w"))

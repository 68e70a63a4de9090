"""How the uncertain inputs of a campaign move fitted models: the whole fit, repeated on moved tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.kernels.propagation import STEP, Propagated, normal_draws, summary_of
from coeflab.model.fit_result import FitResult
from coeflab.model.force_table import ForceTable
from coeflab.model.frozen import locked
from coeflab.model.moved_tables import UncertainInput, moved, uncertain_inputs
from coeflab.model.scaling import Scaling

Array = NDArray[np.float64]
Refit = Callable[[Sequence[ForceTable], Scaling], FitResult]
ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class ModelEffects:
    """Inputs carried to the numbers of a fit: the coefficients of its models in their order, then those of its set.

    Attributes
    ----------
    inputs : tuple of UncertainInput
        k of them.
    gradients : (k, m) array
        Derivative of every number by every input.
    sample : (s, m) array
        The numbers over all inputs at once; draws that change which rows or terms the fit uses are left out.
    nominal : (m,) array
    seed : int
    lacking : tuple of str
        Declared inputs whose effect could not be computed, with the reason.
    """

    inputs: tuple[UncertainInput, ...]
    gradients: Array
    sample: Array
    nominal: Array
    seed: int
    lacking: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("gradients", "sample", "nominal"):
            object.__setattr__(self, name, locked(getattr(self, name)))

    @property
    def half_widths(self) -> Array:
        """(k,) declared."""
        return np.array([i.half_width for i in self.inputs])

    def shifts(self, numbers: slice) -> dict[str, Array]:
        """Signed 95 % shift of some numbers by every input."""
        return {
            i.name: row[numbers] * i.half_width
            for i, row in zip(self.inputs, self.gradients, strict=True)
            if np.any(row[numbers] != 0.0)
        }

    def propagated(self, number: int) -> Propagated | None:
        """All inputs together on one number, linear beside Monte Carlo; None without inputs or draws."""
        if not self.inputs or not len(self.sample):
            return None
        covariance = np.diag((self.half_widths / 2.0) ** 2)
        sample, nominal = self.sample[:, number], float(self.nominal[number])
        return summary_of(sample, nominal, self.gradients[:, number], covariance, self.seed)


def numbers_of(fit: FitResult) -> Array:
    """Coefficients of all models, then of the set; NaN where there is none."""
    among = [np.nan if c.value is None else c.value for c in fit.coefficients.coefficients]
    return np.concatenate([*(m.fit.coefficients for m in fit.models), np.array(among, dtype=float)])


def _same(one: FitResult, other: FitResult) -> bool:
    """Whether two fits use the same rows and terms."""
    return [(m.symbols, m.labels) for m in one.models] == [(m.symbols, m.labels) for m in other.models]


def model_effects(
    fit: FitResult, tables: Sequence[ForceTable], scaling: Scaling, refit: Refit, draws: int, seed: int
) -> ModelEffects | None:
    """Effects of the declared inputs; None where none is declared or the fit chose its terms by looking at the data.

    Parameters
    ----------
    fit : FitResult
        With models, as the plugin made it from ``tables`` and ``scaling``.
    refit : callable
        The same plugin with the same options.
    draws, seed : int
        Of the Monte Carlo.
    """
    variables = tuple(dict.fromkeys(v for m in fit.models if m.unit == "1" for v in m.domain.variables))
    declared = uncertain_inputs(tables, variables)
    if not declared or any(m.post_selection for m in fit.models):
        return None
    nominal = numbers_of(fit)

    def numbers(inputs: Sequence[UncertainInput], errors: Array) -> Array | None:
        try:
            found = refit(*moved(tables, scaling, inputs, errors))
        except InputError:
            return None
        return numbers_of(found) if _same(fit, found) else None

    kept, rows, lacking = [], [], []
    for given in declared:
        step = STEP * given.half_width
        up, down = numbers([given], np.array([step])), numbers([given], np.array([-step]))
        if up is None or down is None:
            lacking.append(f"{given.name}: it changes which rows or terms the fit can use")
            continue
        row = (up - down) / (2.0 * step)
        telling = np.abs(row * given.half_width) > ROUNDING * np.abs(nominal)
        kept.append(given)
        rows.append(np.where(telling, np.nan_to_num(row), 0.0))
    inputs = tuple(kept)
    half = np.array([i.half_width for i in inputs])
    sample = [numbers(inputs, e) for e in normal_draws(np.diag((half / 2.0) ** 2), draws, seed)] if kept else []
    usable = [s for s in sample if s is not None]
    shape = (len(usable), len(nominal))
    return ModelEffects(
        inputs,
        np.array(rows).reshape(len(kept), len(nominal)),
        np.array(usable).reshape(shape),
        nominal,
        seed,
        tuple(lacking),
    )

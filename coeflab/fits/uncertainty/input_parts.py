"""How the uncertain inputs of a campaign move the coefficients that its sweeps give.

Every coefficient of a fit is one function of the declared inputs: the sweeps moved along and scaled with their curves
held fixed, then moved by the error of the reference point. Linear sensitivities and Monte Carlo are of that same function.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.fits.uncertainty.propagation import STEP, Propagated, normal_draws, summary_of
from coeflab.law.coefficient import transfer_matrix
from coeflab.law.symbols import ANGULAR, COMPONENTS, MOMENTS
from coeflab.law.transforms import force_transfer
from coeflab.tables.input_uncertainty import NAMES, InputUncertainty

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.fits.results.fit_result import FitResult, Sweep


ROUNDING = 1e-9
NEWTON = 4


@dataclass(frozen=True, slots=True)
class InputPart:
    """How one uncertain input moves a coefficient.

    Attributes
    ----------
    name : str
    half_width : float
        Declared: rad, m or relative.
    sensitivity : float
        Derivative of the coefficient by the input.
    """

    name: str
    half_width: float
    sensitivity: float

    @property
    def linear(self) -> float:
        """95 % half-width of the coefficient from this input."""
        return abs(self.sensitivity) * self.half_width


def acting(component: str, rate: bool, angle: bool | None = None) -> tuple[str, ...]:
    """Inputs that can act on a coefficient of a component and whose effect its own rows show.

    Parameters
    ----------
    component : str
    rate : bool
        It multiplies a rate.
    angle : bool, optional
        Its rows set an angle; by default those that are no rates do. An angle error of a rotating arm adds a drift whose
        coupling with the rate a sweep of the rate alone does not know.
    """
    moment = component in MOMENTS
    names = {
        "angle": not rate if angle is None else angle, "rate": rate, "speed": True, "force": not moment,
        "moment": moment, "reference_point": component in ("M", "N") or rate, "length": True, "density": True,
    }  # fmt: skip
    return tuple(n for n, acts in names.items() if acts)


def perturbed(sweep: Sweep, names: Sequence[str]) -> Callable[[Array], Array]:
    """The sweep's value as a function of input errors, the curve held fixed: (s, k) deviations -> (s,) values.

    A deviation d says that the true angle is the set one plus d, that true speed, rate, length, density and forces are
    1 + d times those in the table. An offset of the angle moves the origin along the recommended curve: a slope becomes
    that of the curve there, a value at rest the curve's own, a curvature stays, as it feels it in second order only. The
    reference point is left to `CoefficientSet.about`.
    """
    force_power = 3 if sweep.component in MOMENTS else 2
    rate = sweep.variable in ANGULAR
    value = sweep.value or 0.0
    at, force, _ = sweep.curve
    moved = np.zeros(len(at))
    if not rate and sweep.target != "x2":
        moved = np.gradient(force, at) if sweep.target == "x" else force
        moved = moved - moved[len(at) // 2]

    def values(deviations: Array) -> Array:
        error = dict(zip(names, deviations.T, strict=True))
        none = np.zeros(len(deviations))
        one = {n: 1.0 + error.get(n, none) for n in NAMES}
        x_factor = one["rate"] * one["length"] / one["speed"] if rate else none + 1.0
        calibration = one["moment" if sweep.component in MOMENTS else "force"]
        y_factor = calibration / (one["density"] * one["speed"] ** 2 * one["length"] ** force_power)
        offset = none if rate else -error.get("angle", none)
        if sweep.is_angle:
            offset = np.sin(offset)
        power = {"1": 0, "x": 1, "x2": 2}[sweep.target]
        return np.asarray(y_factor / x_factor**power * (value + np.interp(offset, at, moved)))

    return values


def moved_by(
    fit: FitResult, sweeps: tuple[Sweep, ...], declared: InputUncertainty, measured: Array, draws: int, seed: int
) -> list[tuple[tuple[InputPart, ...], Propagated]]:
    """Inputs of every sweep's coefficient, and all inputs together by both ways; `measured` are the points (m, 3) that their balances read about."""
    names = declared.declared
    half = np.array([getattr(declared, n) for n in names], dtype=float)
    function, transferable = _of_inputs(fit, sweeps, names, measured)
    step = STEP * half
    around = function(np.vstack([np.diag(step), -np.diag(step)]))
    gradients = (around[: len(names)] - around[len(names) :]) / (2.0 * step[:, None])
    nominal = function(np.zeros((1, len(names))))[0]
    gradients = np.where(np.abs(gradients * half[:, None]) > ROUNDING * np.abs(nominal), gradients, 0.0)
    covariance = np.diag((half / 2.0) ** 2)
    sample = function(normal_draws(covariance, draws, seed))
    out = []
    for i, sweep in enumerate(sweeps):
        acts = [
            n for n in acting(sweep.component, sweep.variable in ANGULAR) if n != "reference_point" or transferable[i]
        ]
        inputs = tuple(
            InputPart(n, float(half[k]), float(gradients[k, i]))
            for k, n in enumerate(names)
            if n in acts or gradients[k, i] != 0.0
        )
        out.append((inputs, summary_of(sample[:, i], float(nominal[i]), gradients[:, i], covariance, seed)))
    return out


def _of_inputs(
    fit: FitResult, sweeps: tuple[Sweep, ...], names: tuple[str, ...], measured: Array
) -> tuple[Callable[[Array], Array], NDArray[np.bool_]]:
    """All coefficients of a fit as functions of the inputs, (s, k) -> (s, m), and which of them a transfer determines."""
    shift, known, first, second = _transfer(fit, sweeps)
    length = fit.coefficients.scaling.length
    each = [perturbed(s, names) for s in sweeps]
    lever = _levers(sweeps, fit.coefficients.reference_point - np.array([shift, 0.0, 0.0]) - measured, length)

    def values(deviations: Array) -> Array:
        about = np.column_stack([f(deviations) for f in each])
        error = {n: deviations[:, [names.index(n)]] for n in names if n in ("force", "moment")}
        about = about + (error.get("force", 0.0) - error.get("moment", 0.0)) * (about @ lever.T)
        dx = np.full((len(deviations), 1), shift)
        if "reference_point" in names:
            dx = dx + deviations[:, [names.index("reference_point")]]
        return np.asarray(about + dx * (about @ first.T) + dx**2 * (about @ second.T))

    return values, known


def _transfer(fit: FitResult, sweeps: Sequence[Sweep]) -> tuple[float, NDArray[np.bool_], Array, Array]:
    """How the coefficients follow from the sweeps: a shift d, m, which of them it determines, and A and B (m, m) of I + d A + d^2 B.

    A fit may have swept about another point than the one that its coefficients are about; how far forward the coefficients'
    point lies is read off the coefficients.
    """
    symbols = tuple(s.symbol for s in sweeps)
    length = fit.coefficients.scaling.length
    at = [transfer_matrix(symbols, frozenset(symbols), np.array([d / length, 0.0, 0.0])) for d in (1.0, -1.0)]
    known = at[0][1] & at[1][1]
    first = np.where(known[:, None], 0.5 * (at[0][0] - at[1][0]), 0.0)
    second = np.where(known[:, None], 0.5 * (at[0][0] + at[1][0]) - np.eye(len(symbols)), 0.0)
    raw = np.array([s.value for s in sweeps], dtype=float)
    final = np.array([fit.coefficients[s].value or 0.0 for s in symbols])
    slopes, curves = first @ raw, second @ raw
    k = int(np.argmax(np.abs(slopes)))
    shift = 0.0
    if slopes[k] != 0.0:
        for _ in range(NEWTON):
            shift += (final[k] - raw[k] - shift * slopes[k] - shift**2 * curves[k]) / (
                slopes[k] + 2 * shift * curves[k]
            )
    return shift, known, first, second


def moved_digits(fit: FitResult, sweeps: Sequence[Sweep]) -> Array:
    """(m,) bounds of what the rounding of printed digits does to the coefficients, by that of the sweeps that they follow from."""
    own = np.array([s.rounding for s in sweeps])
    if not np.any(own):
        return own
    shift, _, first, second = _transfer(fit, sweeps)
    return np.asarray(np.abs(np.eye(len(own)) + shift * first + shift**2 * second) @ own)


def _levers(sweeps: Sequence[Sweep], shift: Array, length: float) -> Array:
    """(m, m) moments that the coefficients of forces make by shifts (m, 3) from the points that the balances read about.

    A calibration is of what is read: of N there and of Y, so that N + T Y here becomes (1 + m) N + (1 + f) T Y.
    """
    transfers = [force_transfer(s) - np.eye(len(COMPONENTS)) for s in shift]
    return np.array([
        [
            transfer[COMPONENTS.index(a.component), COMPONENTS.index(b.component)] / length
            if (a.variable, a.target) == (b.variable, b.target) and {a.component, b.component} <= {*COMPONENTS} else 0.0
            for b in sweeps
        ]
        for a, transfer in zip(sweeps, transfers, strict=True)
    ])  # fmt: skip

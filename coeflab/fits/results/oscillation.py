"""What oscillating runs give: equivalent linear coefficients of every run, and what they say at zero amplitude."""

from __future__ import annotations

import numpy as np

from coeflab.core.types import Array, dataclass, locking
from coeflab.fits.statistics.harmonics import CUBIC, QUADRATIC, AtZero


@dataclass(frozen=True, slots=True, eq=False)
@locking("sizes theta measured fitted")
class OscillatedForce:
    """One force component of one run, primed, filter and model inertia subtracted.

    Attributes
    ----------
    label : str
    amplitude, frequency : float
        Of the primed velocity (v' or r' ...), and w' = omega L/U.
    cycles : float
    drift : float
        Mean v' (of sway, roll and yaw) or w' (of heave and pitch).
    damping, inertia : (float, float)
        Equivalent linear coefficient of the velocity and of the acceleration, each with the 95 % half-width by its cycles (NaN
        from a single cycle).
    mean : float
    sizes : (K,) array
        Of the harmonics.
    theta, measured, fitted : (n,) array
        Phase of the velocity (rad, from 0 at its largest), and the force as recorded and as its harmonics give it: filter and
        inertia still in it.
    used : bool
        Whether it enters the value at zero amplitude: runs with a mean drift do not.
    """

    label: str
    amplitude: float
    frequency: float
    cycles: float
    drift: float
    damping: tuple[float, float]
    inertia: tuple[float, float]
    mean: float
    sizes: Array
    theta: Array
    measured: Array
    fitted: Array
    used: bool


@dataclass(frozen=True, slots=True, eq=False)
class Oscillation:
    """One force component over the runs of one motion.

    Attributes
    ----------
    motion, variable, component : str
        sway, v, Y.
    runs : tuple of OscillatedForce
    damping, inertia : AtZero
        Yv' and Yvdot' at zero amplitude.
    interval : (float, float) or None
        w' over which the values are extrapolated to zero frequency; None where they are those of the runs' frequencies.
    """

    motion: str
    variable: str
    component: str
    runs: tuple[OscillatedForce, ...]
    damping: AtZero
    inertia: AtZero
    interval: tuple[float, float] | None = None

    @property
    def symbol(self) -> str:
        """Of the damping coefficient, such as Yv."""
        return f"{self.component}{self.variable}"

    @property
    def used(self) -> tuple[OscillatedForce, ...]:
        """Runs that carry the values."""
        return tuple(r for r in self.runs if r.used)

    @property
    def largest(self) -> OscillatedForce:
        """The run of the largest amplitude of those that carry the values."""
        return max(self.used, key=lambda r: r.amplitude)

    def explained(self) -> Explained:
        """How far amplitude moves the damping of the largest run from its value at zero amplitude."""
        run, at_zero = self.largest, self.damping
        known = at_zero.at_zero
        change = sum(f.weight * f.slope * describing(f.name, run.amplitude) for f in at_zero.forms) if known else np.nan
        return Explained(
            self.symbol, run.amplitude, run.damping, (at_zero.value, at_zero.half_width), float(change), np.nan, ""
        )


@dataclass(frozen=True, slots=True)
class Explained:
    """A coefficient of an oscillating run beside a slope at rest, and what part of their difference amplitude explains.

    Attributes
    ----------
    symbol : str
    amplitude : float
        Primed.
    measured, slope : (float, float)
        Equivalent coefficient of the run, slope at zero amplitude; values with 95 % half-widths.
    by_amplitude : float
        Difference that the nonlinear terms give at that amplitude; NaN where there are none.
    by_amplitude_half : float
        Its 95 % half-width; NaN where the slope and the terms come from the same runs, whose errors are not independent.
    against : str
        Whose slope and terms these are; empty for the oscillating runs' own.
    """

    symbol: str
    amplitude: float
    measured: tuple[float, float]
    slope: tuple[float, float]
    by_amplitude: float
    by_amplitude_half: float
    against: str

    @property
    def difference(self) -> float:
        """Measured less slope."""
        return self.measured[0] - self.slope[0]

    @property
    def rest(self) -> tuple[float, float]:
        """What amplitude leaves of it, with the 95 % half-width.

        Errors of slope and terms are joined as if independent; as they oppose each other in a fit of both, that is wide.
        """
        parts = (self.measured[1], self.slope[1], self.by_amplitude_half)
        known = np.isnan(self.by_amplitude) or not np.isnan(self.by_amplitude_half)
        half = float(np.sqrt(np.nansum(np.square(parts)))) if known and np.isfinite(parts[:2]).all() else np.nan
        return self.difference - float(np.nan_to_num(self.by_amplitude)), half


def describing(form: str, amplitude: float) -> float:
    """Share of a form's coefficient in the equivalent linear one at an amplitude."""
    return {"{0}|{0}|": QUADRATIC * amplitude, "{0}^3": CUBIC * amplitude**2}.get(form, 0.0)

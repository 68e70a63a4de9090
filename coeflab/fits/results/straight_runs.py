"""What straight runs over the speed give: X0' = X / (1/2 rho U^2 L^2), its scatter, and its trend with speed."""

from __future__ import annotations

import numpy as np

from coeflab.core.table import plus_minus
from coeflab.core.types import Array, dataclass, locked

DOUBTFUL = 0.05  # probability of a trend as large by chance, below which there is one
SYMBOL = "X0"


@dataclass(frozen=True, slots=True, eq=False)
class StraightRuns:
    """The resistance of one table in which nothing varies but the speed.

    Attributes
    ----------
    table, campaign, body : str
    labels : tuple of str
    speed : (n,) array
        m/s.
    force : (n,) array
        X, N.
    primes : (n,) array
        X / (1/2 rho U^2 L^2) of every run.
    reynolds : (n,) array or None
        U L / nu; None where the viscosity is not known.
    value : float
        Mean of the primes.
    random : float
        95 % half-width of the mean by the scatter of the runs about their trend, or about the mean where there is none.
    trend : float
        Change of the prime from the slowest to the fastest run, by a line in the logarithm of the speed.
    ends : float
        How far that line, or a run, lies from the value at most.
    probability : float
        Of a trend as large by chance; NaN where the runs cannot tell.
    """

    table: str
    campaign: str
    body: str
    labels: tuple[str, ...]
    speed: Array
    force: Array
    primes: Array
    reynolds: Array | None
    value: float
    random: float
    trend: float
    ends: float
    probability: float

    def __post_init__(self) -> None:
        for name in ("speed", "force", "primes", "reynolds"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, locked(getattr(self, name)))

    @property
    def has_trend(self) -> bool:
        """Whether the primes change with the speed beyond their scatter."""
        return bool(self.probability < DOUBTFUL)

    @property
    def form(self) -> float:
        """What U95 holds of the trend: how far it leads from the value; zero without a trend."""
        return self.ends if self.has_trend else 0.0

    @property
    def u95(self) -> float:
        """Scatter and trend, root sum of squares: value +- U95 holds the trend over the speeds of the runs."""
        return float(np.hypot(self.random, self.form))

    @property
    def span(self) -> str:
        """Over which speeds and Reynolds numbers, in words."""
        speeds = f"{np.min(self.speed):.3g} to {np.max(self.speed):.3g} m/s"
        if self.reynolds is None:
            return speeds
        low, high = (1e-6 * float(f(self.reynolds)) for f in (np.min, np.max))
        return f"{speeds}, Reynolds number {low:.3g} to {high:.3g} million"

    @property
    def runs(self) -> str:
        """How many runs over which speeds, in words."""
        return f"{len(self.speed)} straight runs, {self.span}"

    @property
    def changes(self) -> str:
        """How X0' changes with the speed, in words."""
        if not self.has_trend:
            return "no trend with speed beyond the scatter"
        share = 100.0 * self.trend / self.value if self.value else np.nan
        chance = "p < 0.001" if self.probability < 1e-3 else f"p = {self.probability:.2g}"
        what = "falls" if share < 0.0 else "rises"
        return f"|X0'| {what} by {abs(share):.2g} % from the slowest to the fastest run ({chance})"

    @property
    def in_words(self) -> str:
        """Value, U95, runs and trend, a sentence."""
        held = f", which U95 holds over these speeds, not beyond (scatter alone +- {self.random:.2g})"
        return f"X0' = {plus_minus(self.value, self.u95)} from {self.runs}: {self.changes}{held * self.has_trend}."

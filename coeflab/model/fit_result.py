"""What a fit returns: coefficients, and for each sweep everything a reader needs to judge them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.kernels.brief import brief
from coeflab.kernels.slopes import Estimate, Recommendation
from coeflab.model import noun_tables
from coeflab.model.coefficient import CoefficientSet
from coeflab.model.fitted_model import FittedModel
from coeflab.model.frozen import locked
from coeflab.model.pooling import Pooling

Array = NDArray[np.float64]


@brief
@dataclass(frozen=True, slots=True)
class BootstrapInterval:
    """Percentile intervals of one member: pairs and wild, with the share of usable resamples."""

    pairs: tuple[float, float]
    wild: tuple[float, float]
    usable: float


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """The recommendation when no window may exceed ``cap`` (in the motion variable)."""

    cap: float
    value: float | None
    u95: float | None


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A point that the fit does not use: its setting, its force (NaN if blank), its label and the reason."""

    x: float
    y: float
    label: str
    reason: str


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """One force component over one motion variable, and the coefficient that it gives.

    Attributes
    ----------
    symbol : str
        Coefficient, without prime.
    variable, component : str
    parity : str
        ``odd`` (slope) or ``even`` (curvature or value at rest).
    target : str
        Term of the families whose coefficient is the result.
    x, y : (n,) array
        Primed motion variable and force.
    se : (n,) array or None
    labels : tuple of str
    left_out : tuple of LeftOut
    recommendation : Recommendation
    plain : tuple of Estimate
        Each family without nuisance terms in every window: the single estimators of the literature.
    bootstrap : dict of family name to BootstrapInterval
    sensitivity : tuple of Sensitivity
    one_sided : bool
    table, campaign, body : str
    offset : str
        What was subtracted before the fit, if anything.
    borrowed : str
        Table that lent its row at rest, if any.
    """

    symbol: str
    variable: str
    component: str
    parity: str
    target: str
    x: Array
    y: Array
    se: Array | None
    labels: tuple[str, ...]
    left_out: tuple[LeftOut, ...]
    recommendation: Recommendation
    plain: tuple[Estimate, ...]
    bootstrap: dict[str, BootstrapInterval]
    sensitivity: tuple[Sensitivity, ...]
    one_sided: bool
    table: str
    campaign: str
    body: str
    offset: str = ""
    borrowed: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", locked(self.x))
        object.__setattr__(self, "y", locked(self.y))
        if self.se is not None:
            object.__setattr__(self, "se", locked(self.se))

    @property
    def is_angle(self) -> bool:
        """Whether the motion variable is the sine of an angle."""
        return self.variable in ("v", "w")

    @property
    def angle_name(self) -> str:
        """What the motion variable is called on paper."""
        return {"v": "v' = v/U", "w": "w' = w/U", "dr": "rudder angle", "ds": "stern plane angle"}.get(
            self.variable, f"{self.variable}' = {self.variable} L/U"
        )

    def window_of(self, estimate: Estimate) -> tuple[float, float]:
        """Range of the rows that an estimate used: radians for v', w' and controls, r' for rates."""
        rows = self.x[estimate.rows]
        low, high = float(rows.min()), float(rows.max())
        if self.is_angle:
            return float(np.arcsin(max(low, -1.0))), float(np.arcsin(min(high, 1.0)))
        return low, high


@brief
@dataclass(frozen=True, slots=True, eq=False)
class FitResult:
    """Coefficients of one campaign, or of several jointly, by one fit.

    Attributes
    ----------
    fit : str
        Plugin name.
    campaign, body : str
        Of several campaigns the names, joined by commas.
    coefficients : CoefficientSet
    sweeps : tuple of Sweep
    citations : tuple of str
    settings : dict of str to str
        Options as used, seed and replicates among them.
    models : tuple of FittedModel
        Force laws and tables over one or more variables.
    poolings : tuple of Pooling
        What each of several campaigns adds, one a component.
    differences : tuple of str
        What sets several campaigns apart: bodies, Reynolds numbers, sources, points.
    """

    fit: str
    campaign: str
    body: str
    coefficients: CoefficientSet
    sweeps: tuple[Sweep, ...]
    citations: tuple[str, ...]
    settings: dict[str, str]
    models: tuple[FittedModel, ...] = ()
    poolings: tuple[Pooling, ...] = ()
    differences: tuple[str, ...] = ()

    @property
    def campaigns(self) -> tuple[str, ...]:
        """The campaigns that it comes from."""
        return tuple(self.campaign.split(", "))

    def _repr_html_(self) -> str:
        """Coefficients and terms, for notebooks."""
        return "".join(t._repr_html_() for t in noun_tables.fit_tables(self))

    def sweep(self, symbol: str) -> Sweep:
        """The sweep of a coefficient."""
        for s in self.sweeps:
            if s.symbol == symbol.removesuffix("'"):
                return s
        raise KeyError(symbol)

"""What a fit returns: coefficients, and for each sweep everything a reader needs to judge them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.cards import html_by
from coeflab.core.finding import Finding
from coeflab.core.types import Array, dataclass, in_angles, locking
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.results.oscillation import Oscillation
from coeflab.fits.results.pooling import Pooling
from coeflab.fits.results.straight_runs import StraightRuns
from coeflab.fits.statistics.least_squares import Index
from coeflab.fits.statistics.slopes import Estimate
from coeflab.law.coefficient import Coefficient, CoefficientSet
from coeflab.law.scaling import Conditions, Scaling
from coeflab.tables.force_table import ForceTable


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """The recommended slope had the sweep ended at ``cap`` (in the motion variable)."""

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


@dataclass(frozen=True, slots=True, eq=False)
@locking("x y curve fitted by_row se")
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
    value, u95, random : float or None
        Recommended, and the part of U95 that is scatter; None where there are too few settings.
    reason : str
        Why there is no value or what it rests on, from the calibrated model.
    notes : tuple of str
        Duplicates, mirror images, one-sided sweep.
    used : (n,) boolean array
        Rows that carry the value: neither repeated nor left out.
    wrong : (k,) integer array
        Rows that were left out because they do not fit the others.
    with_all : float or None
        The value with every row, wrong or not.
    curve : (3, m) array
        Settings over the sweep and its mirror image, the recommended curve there and the half-width of its 95 % band; NaN
        without one.
    fitted : (n,) array
        The recommended curve at the rows.
    at_rest : (float, float)
        The recommended curve at zero and its 95 % half-width.
    by_row : (n,) array
        How much a reading moves the value; zero for rows that do not carry it.
    forms : tuple of Estimate
        Each family in every window: the single estimators of the literature, for comparison.
    sensitivity : tuple of Sensitivity
    one_sided : bool
    table, campaign, body : str
    offset : str
        What was subtracted before the fit, if anything.
    borrowed : str
        Table that lent its row at rest, if any.
    one_size : bool
        Whether all settings have one size, so that they determine neither slope nor curvature.
    symmetry : str
        Declared symmetry by which a sweep of one side is odd or even; empty where both sides were run or none is declared.
    withdrawn : tuple of (value, U95) or None
        What a declared symmetry would give that the points rule out.
    by_symmetry : str
        Table whose rows these are, turned by a declared symmetry; empty for rows that were run.
    held : str
        Angle of the other plane that all rows have, as ``beta = 4 deg``; empty at none.
    rounding : float
        95 % half-width of the value by the rounding of printed digits; not in ``u95``.
    bias : float
        Primed force of the rows at rest, which a declared symmetry says is zero; what it does to the value is in U95.
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
    value: float | None
    u95: float | None
    random: float | None
    reason: str
    notes: tuple[str, ...]
    used: NDArray[np.bool_]
    wrong: Index
    with_all: float | None
    curve: Array
    fitted: Array
    at_rest: tuple[float, float]
    by_row: Array
    forms: tuple[Estimate, ...]
    sensitivity: tuple[Sensitivity, ...]
    one_sided: bool
    table: str
    campaign: str
    body: str
    offset: str = ""
    borrowed: str = ""
    one_size: bool = False
    symmetry: str = ""
    by_symmetry: str = ""
    withdrawn: tuple[float, float] | None = None
    bias: float = 0.0
    held: str = ""
    rounding: float = 0.0

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

    @property
    def window(self) -> tuple[float, float] | None:
        """Range of the rows that carry the value: radians for v', w' and controls, r' for rates; None without any."""
        rows = self.x[self.used]
        if not len(rows):
            return None
        low, high = float(rows.min()), float(rows.max())
        if self.is_angle:
            return float(np.arcsin(max(low, -1.0))), float(np.arcsin(min(high, 1.0)))
        return low, high

    @property
    def repeated(self) -> Index:
        """Rows that repeat an earlier one exactly and count once."""
        return np.setdiff1d(np.flatnonzero(np.logical_not(self.used)), self.wrong)


@dataclass(frozen=True, slots=True, eq=False)
@locking("moves")
class Tied:
    """What coefficients of one fit owe to those of another that they were tied to.

    Attributes
    ----------
    fit : str
        The other fit, of the same campaign.
    symbols : tuple of str
        Its coefficients.
    moves : (n, m) array
        Change of every coefficient with each of those.
    set_up : tuple of (table, term, value)
        Primed forces of the set-up that the fit took off and no coefficient holds: ``Y0`` at rest, ``Xv`` of X odd in drift.
    """

    fit: str
    symbols: tuple[str, ...]
    moves: Array
    set_up: tuple[tuple[str, str, float], ...]


@dataclass(frozen=True, slots=True, eq=False)
@locking("covariance")
class Shared:
    """What the coefficients of one fit have in common with those of another, whose numbers moved them to another point.

    Attributes
    ----------
    fit, campaign : str
        The other.
    covariance : (n, m) array
        Of this fit's coefficients with the other's.
    """

    fit: str
    campaign: str
    covariance: Array


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
        Options as used.
    models : tuple of FittedModel
        Force laws and tables over one or more variables.
    poolings : tuple of Pooling
        What each of several campaigns adds, one a component.
    differences : tuple of str
        What sets several campaigns apart: bodies, Reynolds numbers, sources, points.
    tied : Tied or None
        The fit whose law these coefficients complete.
    oscillations : tuple of Oscillation
        Of oscillating runs, one a force component and motion.
    straight : tuple of StraightRuns
        Of tables in which nothing varies but the speed.
    findings : tuple of Finding
        What is assumed, left out or not assessed; they travel with its numbers.
    shared : tuple of Shared
        Of fits that were moved to one point together.
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
    tied: Tied | None = None
    oscillations: tuple[Oscillation, ...] = ()
    straight: tuple[StraightRuns, ...] = ()
    findings: tuple[Finding, ...] = ()
    shared: tuple[Shared, ...] = ()

    @property
    def law(self) -> str:
        """The fit whose force law the coefficients belong to."""
        return self.tied.fit if self.tied else self.fit

    @property
    def campaigns(self) -> tuple[str, ...]:
        """The campaigns that it comes from."""
        return tuple(self.campaign.split(", "))

    def __repr__(self) -> str:
        found = [c.said for c in self.coefficients.coefficients if c.value is not None]
        models = [f"{len(self.models)} models"] if self.models else []
        return in_angles(self, f"{self.fit} of {self.campaign}: {', '.join([*models, *found]) or 'no coefficient'}")

    def _repr_html_(self) -> str:
        """Its curve and coefficients, for notebooks."""
        return html_by("fit", self)

    def sweep(self, symbol: str) -> Sweep:
        """The sweep of a coefficient."""
        for s in self.sweeps:
            if s.symbol == symbol.removesuffix("'"):
                return s
        raise KeyError(symbol)


def result_of(
    fit: str,
    first: ForceTable,
    scaling: Scaling,
    coefficients: Sequence[Coefficient],
    covariance: Array,
    *,
    conditions: Conditions | None = None,
    **more: Any,
) -> FitResult:
    """Coefficients about the point of a table as the result of a fit.

    Parameters
    ----------
    fit : str
        Plugin name.
    first : ForceTable
        Campaign, body, point and datum, unless ``more`` says others.
    scaling : Scaling
    coefficients : sequence of Coefficient
    covariance : (n, n) array
        Of standard uncertainties; what has no U95 is NaN in the result.
    conditions : Conditions, optional
        Of coefficients in SI.
    **more
        Further fields of `FitResult`.
    """
    unknown = np.isnan(np.diag(covariance)) | np.array([c.u95 is None for c in coefficients], dtype=bool)
    covariance = np.where(unknown | unknown[:, None], np.nan, covariance)
    own: dict[str, Any] = {"campaign": first.campaign, "body": first.body, "sweeps": (), **more}
    held = CoefficientSet(
        tuple(coefficients), covariance, scaling, first.reference_point, first.datum, own["body"], conditions
    )
    return FitResult(fit, coefficients=held, **own)


def independent(blocks: Sequence[Array]) -> Array:
    """The covariance of coefficients by groups that share no errors."""
    from scipy.linalg import block_diag

    return np.asarray(block_diag(*blocks)) if blocks else np.zeros((0, 0))


def covariance_of(fits: Sequence[FitResult]) -> Array:
    """(k, k) covariance of all coefficients of some fits, one after the other; NaN where a U95 is not known.

    Fits have a covariance where one is tied to the other, or where both were moved to a point together.
    """
    ends = np.cumsum([0, *(len(f.coefficients.coefficients) for f in fits)])
    out = np.zeros((ends[-1], ends[-1]))
    for i, a in enumerate(fits):
        for j, b in enumerate(fits[: i + 1]):
            block = _between(a, b)
            out[ends[i] : ends[i + 1], ends[j] : ends[j + 1]] = block
            out[ends[j] : ends[j + 1], ends[i] : ends[i + 1]] = block.T
    void = np.isnan(np.diag(out))
    out[void, :] = out[:, void] = np.nan
    return out


def _between(a: FitResult, b: FitResult) -> Array:
    if a is b:
        return a.coefficients.covariance
    for f, other, turned in ((a, b, False), (b, a, True)):
        found = next((s.covariance for s in f.shared if (s.fit, s.campaign) == (other.fit, other.campaign)), None)
        if found is None and f.tied is not None and (f.tied.fit, f.campaign) == (other.fit, other.campaign):
            found = f.tied.moves @ np.nan_to_num(other.coefficients.covariance)
        if found is not None:
            return found.T if turned else found
    return np.zeros((len(a.coefficients.coefficients), len(b.coefficients.coefficients)))

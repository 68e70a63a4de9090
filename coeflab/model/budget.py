"""The uncertainty budget of a coefficient: what is in its U95, by how much, and what was not assessed.

Parts are joined as a root sum of squares (JCGM 100:2008, ITTC 7.5-02-06-04). They are taken as independent; the window
part overlaps with the model-form part, as each form has its own window, which makes the sum conservative. An input error
is one that all points of a campaign share.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import ANGULAR, MOMENTS, derivative, primed
from coeflab.kernels.propagation import Propagated, displaced, propagate, refit, sensitivities
from coeflab.model.coefficient import Coefficient, CoefficientSet, transfer_matrix
from coeflab.model.fit_result import FitResult, Sweep
from coeflab.model.force_table import ForceTable
from coeflab.model.grid_study import GridStudy, gravest, grid_studies
from coeflab.model.input_uncertainty import NAMES, InputUncertainty
from coeflab.model.study import Study

Array = NDArray[np.float64]
DRAWS, SEED = 2000, 1
ROUNDING = 1e-9
ALWAYS_OPEN = {
    "cfd": ("turbulence model", "domain and boundary conditions"),
    "experiment": ("rig interference and blockage",),
    "literature": ("whatever the source left out",),
    "synthetic": (),
}
NOT_OF_A_COMPUTATION = ("force", "moment")


@dataclass(frozen=True, slots=True)
class BudgetPart:
    """One part of a U95.

    Attributes
    ----------
    name : str
        ``random``, ``model form``, ``window``, ``grid``, or the name of an input.
    half_width : float
        95 %, primed.
    share : float or None
        Of the variance, 0 to 1; None where no U95 is given.
    """

    name: str
    half_width: float
    share: float | None


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


@dataclass(frozen=True, slots=True, eq=False)
class Budget:
    """The budget of one coefficient.

    Attributes
    ----------
    symbol, campaign, body, table, kind : str
        ``kind`` of the source: ``cfd``, ``experiment``, ``literature`` or ``synthetic``.
    value : float
        Primed.
    parts : tuple of BudgetPart
        Assessed ones only.
    u95 : float or None
        None where the fit itself gives none.
    inputs : tuple of InputPart
        Those that act on this coefficient.
    monte_carlo : Propagated or None
        All inputs together, linear beside Monte Carlo; None where none was declared.
    grid : GridStudy or None
    unassessed : tuple of str
    """

    symbol: str
    campaign: str
    body: str
    table: str
    kind: str
    value: float
    parts: tuple[BudgetPart, ...]
    u95: float | None
    inputs: tuple[InputPart, ...]
    monte_carlo: Propagated | None
    grid: GridStudy | None
    unassessed: tuple[str, ...]

    def part(self, name: str) -> float | None:
        """Half-width of a part; None where it was not assessed."""
        return next((p.half_width for p in self.parts if p.name == name), None)

    @property
    def input(self) -> float | None:
        """All inputs together, linear; None where none was declared."""
        return None if self.monte_carlo is None else self.monte_carlo.linear

    def joined(self, *names: str) -> float:
        """Root sum of squares of the named parts that were assessed."""
        return float(np.sqrt(sum((self.part(n) or 0.0) ** 2 for n in names)))


def budgets(study: Study, draws: int = DRAWS, seed: int = SEED) -> tuple[Budget, ...]:
    """Budgets of all fitted coefficients that come from a sweep and have a value.

    Parameters
    ----------
    study : Study
    draws, seed : int
        Of the Monte Carlo over the inputs.
    """
    tables = {t.name: t for t in study.tables}
    out = []
    for fit in study.fits:
        for sweep in fit.sweeps:
            c = fit.coefficients[sweep.symbol]
            if c.value is not None and sweep.table in tables:
                out.append(budget(c, sweep, fit.coefficients, tables[sweep.table], draws, seed))
    return tuple(out)


def budget(
    c: Coefficient, sweep: Sweep, among: CoefficientSet, table: ForceTable, draws: int = DRAWS, seed: int = SEED
) -> Budget:
    """The budget of one coefficient, which must have a value."""
    value = 0.0 if c.value is None else c.value
    found: dict[str, float] = {}
    lacking: list[str] = []
    spread = [s.value for s in sweep.sensitivity if s.value is not None]
    for name, part in (
        ("random", c.parts.random),
        ("model form", c.parts.model_form),
        ("window", float(np.ptp([*spread, value])) / 3.0**0.5 if spread else None),
    ):
        if part is None:
            lacking.append(name)
        else:
            found[name] = part
    study = gravest(grid_studies(table, sweep.component)) if table.source.kind == "cfd" else None
    relative = None if study is None else study.convergence.relative
    if relative is not None:
        found["grid"] = relative * abs(value)
    elif table.source.kind == "cfd":
        lacking.append("grid" if study is None else f"grid ({study.convergence.statement})")
    inputs, total = _inputs(sweep, among, table, draws, seed)
    found.update({p.name: p.linear for p in inputs})
    lacking += _undeclared(sweep, table, inputs, shifted(sweep.symbol, among)) + list(ALWAYS_OPEN[table.source.kind])
    u95 = None if c.u95 is None else float(np.sqrt(sum(h * h for h in found.values())))
    parts = tuple(BudgetPart(n, h, (h / u95) ** 2 if u95 else None) for n, h in found.items())
    return Budget(
        c.symbol, sweep.campaign, sweep.body, sweep.table, table.source.kind, value, parts, u95, inputs, total, study,
        tuple(lacking),
    )  # fmt: skip


def acting(symbol: str, variable: str) -> tuple[str, ...]:
    """Inputs that act on a coefficient of a sweep over ``variable``, the reference point apart."""
    d = derivative(symbol)
    rate = variable in ANGULAR
    names = {
        "angle": not rate, "rate": rate and bool(d.factors), "speed": True, "force": d.component not in MOMENTS,
        "moment": d.component in MOMENTS, "length": True, "density": True,
    }  # fmt: skip
    return tuple(n for n, acts in names.items() if acts)


def perturbed(sweep: Sweep, names: Sequence[str]) -> Callable[[Array], Array]:
    """The recommendation as a function of input errors, members held fixed: (s, k) deviations -> (s,) values.

    A deviation d says that the true angle is the set one plus d, that true speed, rate, length, density and forces are
    1 + d times those in the table.
    """
    force_power = 3 if sweep.component in MOMENTS else 2
    rate = sweep.variable in ANGULAR

    def values(deviations: Array) -> Array:
        error = dict(zip(names, deviations.T, strict=True))
        none = np.zeros(len(deviations))
        one = {n: 1.0 + error.get(n, none) for n in NAMES}
        x_factor = one["rate"] * one["length"] / one["speed"] if rate else none + 1.0
        calibration = one["moment" if sweep.component in MOMENTS else "force"]
        y_factor = calibration / (one["density"] * one["speed"] ** 2 * one["length"] ** force_power)
        offset = none if rate else error.get("angle", none)
        x, y = displaced(sweep.x, offset, x_factor, sweep.y, y_factor, sweep.is_angle)
        return refit(sweep.recommendation.members, x, y)

    return values


def shifted(symbol: str, among: CoefficientSet) -> tuple[float, float] | None:
    """First and second order change of a coefficient when its reference point moves forward, per m and per m^2.

    None where a coefficient that the transfer needs is not known.
    """
    i, h = among.symbols.index(symbol), 1.0
    values = np.array([0.0 if c.value is None else c.value for c in among.coefficients])
    length = among.scaling.length
    moved = []
    for step in (h, -h):
        matrix, known = transfer_matrix(among.symbols, among.available, np.array([step / length, 0.0, 0.0]))
        if not known[i]:
            return None
        moved.append(float(matrix[i] @ values) - float(values[i]))
    return 0.5 * (moved[0] - moved[1]), 0.5 * (moved[0] + moved[1])


def _inputs(
    sweep: Sweep, among: CoefficientSet, table: ForceTable, draws: int, seed: int
) -> tuple[tuple[InputPart, ...], Propagated | None]:
    declared = table.uncertainty
    if declared is None or not declared.declared or not sweep.recommendation.members:
        return (), None
    names = [n for n in acting(sweep.symbol, sweep.variable) if n in declared.declared]
    shift = shifted(sweep.symbol, among)
    moves = declared.reference_point is not None and shift is not None and shift != (0.0, 0.0)
    data = perturbed(sweep, names)
    first, second = shift if moves and shift is not None else (0.0, 0.0)
    every = [*names, "reference_point"] if moves else names
    if not every:
        return (), None

    def values(deviations: Array) -> Array:
        along = deviations[:, len(names)] if moves else np.zeros(len(deviations))
        return data(deviations[:, : len(names)]) + first * along + second * along**2

    half = np.array([_half_width(declared, n) for n in every])
    gradient = sensitivities(values, half)
    gradient = np.where(np.abs(gradient * half) > ROUNDING * abs(float(values(np.zeros((1, len(half))))[0])), gradient, 0.0)
    total = propagate(values, gradient, np.diag((half / 2.0) ** 2), draws, seed)
    return tuple(InputPart(n, float(u), float(s)) for n, u, s in zip(every, half, gradient, strict=True)), total


def _feels_point(sweep: Sweep) -> bool:
    """Whether moving the reference point along x can change the coefficient."""
    return sweep.component in ("M", "N") or sweep.variable in ("q", "r")


def _half_width(declared: InputUncertainty, name: str) -> float:
    return float(getattr(declared, name))


def _undeclared(
    sweep: Sweep, table: ForceTable, inputs: tuple[InputPart, ...], shift: tuple[float, float] | None
) -> list[str]:
    """Inputs that may act and were not assessed, by name."""
    computed = table.source.kind == "cfd"
    if table.source.kind == "synthetic" and table.uncertainty is None:
        return []
    wanted = [n for n in acting(sweep.symbol, sweep.variable) if not (computed and n in NOT_OF_A_COMPUTATION)]
    if sweep.variable in ANGULAR:
        wanted.append("angle")
    if _feels_point(sweep):
        wanted.append("reference_point")
    known = {p.name for p in inputs} | (set() if shift != (0.0, 0.0) else {"reference_point"})
    return [n.replace("_", " ") for n in wanted if n not in known]


def covariance(among: CoefficientSet, found: Sequence[Budget]) -> Array:
    """Covariance of standard uncertainties of a set with the budgets' further parts, shape (k, k).

    Random parts keep the correlation of the set; window and grid parts are taken as independent; an input error is
    common to the coefficients of a campaign, so that it cancels where a ratio does not feel it.
    """
    return np.asarray(among.covariance + further(among.symbols, [c.campaign for c in among.coefficients], found))


def further(symbols: Sequence[str], campaigns: Sequence[str | None], found: Sequence[Budget]) -> Array:
    """Covariance that the window, grid and input parts add, shape (k, k); symbols with or without prime."""
    by = {(primed(b.symbol), b.campaign): b for b in found}
    chosen = [by.get((primed(s), c or "")) for s, c in zip(symbols, campaigns, strict=True)]
    out = np.zeros((len(symbols), len(symbols)))
    for i, a in enumerate(chosen):
        for j, b in enumerate(chosen):
            if a is None or b is None or a.campaign != b.campaign:
                continue
            other = {p.name: p.sensitivity for p in b.inputs}
            out[i, j] += sum(p.sensitivity * other.get(p.name, 0.0) * p.half_width**2 for p in a.inputs) / 4.0
            if i == j:
                out[i, i] += a.joined("window", "grid") ** 2 / 4.0
    return out


def of_fit(fit: FitResult, found: Sequence[Budget]) -> tuple[Budget, ...]:
    """The budgets of one fit's coefficients."""
    return tuple(b for b in found if b.campaign == fit.campaign and b.symbol in fit.coefficients)

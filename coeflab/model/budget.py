"""The uncertainty budget of a coefficient: what is in its U95, by how much, and what was not assessed.

Parts are joined as a root sum of squares (JCGM 100:2008, ITTC 7.5-02-06-04) and taken as independent. An input error is
one that all points of a campaign share.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import ANGULAR, primed
from coeflab.kernels.brief import brief
from coeflab.kernels.propagation import Propagated
from coeflab.model.coefficient import Coefficient, CoefficientSet
from coeflab.model.fit_result import FitResult, Sweep
from coeflab.model.force_table import ForceTable
from coeflab.model.grid_study import GridStudy, gravest, grid_studies
from coeflab.model.input_effects import InputPart, acting, moved_by

Array = NDArray[np.float64]
DRAWS, SEED = 2000, 1  # 2.5 % tails of 50 draws each: half-widths to about 3 %
TELLING = 0.05  # of the largest force: the relative grid error of a smaller one says nothing
ALWAYS_OPEN = {
    "cfd": ("turbulence model", "domain and boundary conditions"),
    "experiment": ("rig interference and blockage",),
    "literature": ("whatever the source left out",),
    "synthetic": (),
}
COUPLED = "angle, coupled with the rate"
NOT_OF_A_COMPUTATION = ("force", "moment")


@dataclass(frozen=True, slots=True)
class BudgetPart:
    """One part of a U95.

    Attributes
    ----------
    name : str
        ``random``, ``model form``, ``grid``, or the name of an input.
    half_width : float
        95 %, primed.
    share : float or None
        Of the variance, 0 to 1; None where no U95 is given.
    """

    name: str
    half_width: float
    share: float | None


@brief
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
        Assessed ones only; ``random and model form`` in one where a move of the reference point has joined them.
    u95 : float or None
        None where the fit itself gives none.
    inputs : tuple of InputPart
        Those that act on this coefficient.
    monte_carlo : Propagated or None
        All inputs together, linear beside Monte Carlo; None where none was declared.
    grid : GridStudy or None
    window : float or None
        How far the value moves when no window may exceed a cap, 2 / sqrt 3 times the largest move; for information, as
        each form has its own window and the model-form part holds that choice already.
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
    window: float | None
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


def budgets_of(
    fit: FitResult, tables: Mapping[str, ForceTable], draws: int = DRAWS, seed: int = SEED
) -> tuple[Budget, ...]:
    """Budgets of the coefficients of one fit that come from a sweep and have a value.

    Parameters
    ----------
    fit : FitResult
        As the fit made it, before `with_budget`.
    tables : mapping of name to ForceTable
    draws, seed : int
        Of the Monte Carlo over the inputs.
    """
    sweeps = [s for s in fit.sweeps if s.recommendation.value is not None and s.table in tables]
    if not sweeps:
        return ()
    declared = tables[sweeps[0].table].uncertainty
    moved = None
    if declared is not None and declared.declared:
        moved = moved_by(fit, tuple(sweeps), declared, draws, seed)
    found = []
    for i, sweep in enumerate(sweeps):
        c = fit.coefficients[sweep.symbol]
        if c.value is not None:
            found.append(_budget(c, sweep, tables[sweep.table], *(moved[i] if moved else ((), None))))
    return tuple(found)


def _budget(
    c: Coefficient, sweep: Sweep, table: ForceTable, inputs: tuple[InputPart, ...], total: Propagated | None
) -> Budget:
    raw = sweep.recommendation.value or 0.0
    apart = [abs(s.value - raw) for s in sweep.sensitivity if s.value is not None]
    fitted = {"random": c.parts.random, "model form": c.parts.model_form}
    if c.u95 is not None and c.parts.random is None:
        fitted = {"random and model form": c.u95}
    wanted = acting(sweep.component, sweep.variable in ANGULAR)
    lacking = undeclared(wanted, (table,), inputs) + ([COUPLED] if sweep.variable in ANGULAR else [])
    if _true_by_construction((table,)):
        lacking = []
    window = 2.0 * max(apart) / 3.0**0.5 if apart else None
    return budget_of(c, sweep.component, (table,), fitted, inputs, total, lacking, window)


def budget_of(
    c: Coefficient,
    component: str,
    tables: Sequence[ForceTable],
    fitted: Mapping[str, float | None],
    inputs: tuple[InputPart, ...],
    total: Propagated | None,
    lacking: Sequence[str],
    window: float | None = None,
    study: GridStudy | None = None,
) -> Budget:
    """The budget of a coefficient.

    Parameters
    ----------
    c : Coefficient
        With a value.
    component : str
        X .. N, for its grid studies.
    tables : sequence of ForceTable
        Those that it comes from.
    fitted : mapping of part to half-width
        What the fit assessed; None where it could have and did not.
    inputs, total
        See `Budget`.
    lacking : sequence of str
        Inputs that may act and were not assessed.
    window : float, optional
        See `Budget`.
    study : GridStudy, optional
        The one to take; by default the gravest of the component in these tables.
    """
    value = 0.0 if c.value is None else c.value
    kinds = tuple(dict.fromkeys(t.source.kind for t in tables))
    found = {name: part for name, part in fitted.items() if part is not None}
    open_parts = [name for name, part in fitted.items() if part is None]
    study = study or grid_study_of(tables, component)
    relative = None if study is None else study.convergence.relative
    if relative is not None:
        found["grid"] = relative * abs(value)
    elif "cfd" in kinds:
        open_parts.append("grid" if study is None else f"grid: {study.convergence.convergence}")
    found.update({p.name.replace("_", " "): p.linear for p in inputs if p.linear > 0.0})
    unassessed = (*open_parts, *lacking, *(u for kind in kinds for u in ALWAYS_OPEN[kind]))
    u95 = None if c.u95 is None else float(np.sqrt(sum(h * h for h in found.values())))
    parts = tuple(BudgetPart(n, h, (h / u95) ** 2 if u95 else None) for n, h in found.items())
    return Budget(
        c.symbol, c.campaign or "", c.body, c.table or "", kinds[0], value, parts, u95, inputs, total, study, window, unassessed
    )  # fmt: skip


def grid_study_of(tables: Sequence[ForceTable], component: str, variables: Sequence[str] = ()) -> GridStudy | None:
    """The gravest grid study of a component in computed tables; one where the force is next to nothing has no relative
    error to carry on.

    Parameters
    ----------
    tables : sequence of ForceTable
    component : str
    variables : sequence of str
        Only studies in which one of these moves; all where none is named.
    """
    studies: list[GridStudy] = []
    for table in tables:
        if table.source.kind != "cfd" or component not in table.forces:
            continue
        force = table.forces[component][table.usable[component]]
        least = TELLING * float(np.max(np.abs(force), initial=0.0))
        found = [g for g in grid_studies(table, component) if not variables or set(variables) & set(g.moving)]
        studies += [g for g in found if abs(g.convergence.values[g.convergence.used]) >= least]
    return gravest(tuple(studies))


def _true_by_construction(tables: Sequence[ForceTable]) -> bool:
    return all(t.source.kind == "synthetic" and t.uncertainty is None for t in tables)


def undeclared(wanted: Sequence[str], tables: Sequence[ForceTable], inputs: Sequence[InputPart]) -> list[str]:
    """Inputs that may act and were not assessed, by name; none where the tables are synthetic and declare none."""
    if _true_by_construction(tables):
        return []
    computed = all(t.source.kind == "cfd" for t in tables)
    known = {p.name.split(" ")[0] for p in inputs}
    named = [n for n in wanted if not (computed and n in NOT_OF_A_COMPUTATION)]
    return [n.replace("_", " ") for n in named if n not in known]


def with_budget(fit: FitResult, found: Sequence[Budget]) -> FitResult:
    """The fit with the grid and input parts in the U95 and covariance of its coefficients."""
    mine = {b.symbol: b for b in found if b.campaign == fit.campaign}
    if not any(b.u95 is not None for b in mine.values()):
        return fit
    among = fit.coefficients
    changed = []
    for c in among.coefficients:
        b = mine.get(c.symbol)
        outside = None if b is None else float(np.hypot(b.input or 0.0, b.part("grid") or 0.0))
        if b is None or b.u95 is None or not outside:
            changed.append(c)
        else:
            changed.append(replace(c, u95=b.u95, parts=replace(c.parts, input=outside)))
    wider = replace(among, coefficients=tuple(changed), covariance=covariance(among, tuple(mine.values())))
    return replace(fit, coefficients=wider)


def covariance(among: CoefficientSet, found: Sequence[Budget]) -> Array:
    """Covariance of standard uncertainties of a set with the budgets' further parts, shape (k, k).

    Random parts keep the correlation of the set. A grid error is common to the coefficients of one component that take it
    from one study, and independent of others. An input error is common to the coefficients of a campaign, so that it
    cancels where a ratio does not feel it.
    """
    return np.asarray(among.covariance + further(among.symbols, [c.campaign for c in among.coefficients], found))


def _one_grid(a: Budget, b: Budget) -> bool:
    """Whether two budgets take their grid part from one study."""
    if a.grid is None or b.grid is None:
        return False
    return (a.grid.table, a.grid.component, a.grid.setting) == (b.grid.table, b.grid.component, b.grid.setting)


def further(symbols: Sequence[str], campaigns: Sequence[str | None], found: Sequence[Budget]) -> Array:
    """Covariance that the grid and input parts add, shape (k, k); symbols with or without prime."""
    by = {(primed(b.symbol), b.campaign): b for b in found}
    chosen = [by.get((primed(s), c or "")) for s, c in zip(symbols, campaigns, strict=True)]
    out = np.zeros((len(symbols), len(symbols)))
    for i, a in enumerate(chosen):
        for j, b in enumerate(chosen):
            if a is None or b is None or a.campaign != b.campaign:
                continue
            other = {p.name: p.sensitivity for p in b.inputs}
            out[i, j] += sum(p.sensitivity * other.get(p.name, 0.0) * p.half_width**2 for p in a.inputs) / 4.0
            if i == j or _one_grid(a, b):
                out[i, j] += (
                    float(np.copysign(a.joined("grid"), a.value) * np.copysign(b.joined("grid"), b.value)) / 4.0
                )
    return out

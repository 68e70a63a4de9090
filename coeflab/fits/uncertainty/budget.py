"""The uncertainty budget of a coefficient: what is in its U95, by how much, and what was not assessed.

Parts are joined as a root sum of squares (JCGM 100:2008, ITTC 7.5-02-06-04) and taken as independent. An input error is
one that all points of a campaign share.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from coeflab.core.cards import html_by
from coeflab.core.finding import Finding, Severity
from coeflab.core.table import plus_minus
from coeflab.core.types import in_angles
from coeflab.fits.results.fitted_model import DIGITS
from coeflab.fits.uncertainty.grid_studies import gravest, grid_studies, variant_studies
from coeflab.law.coefficient import Parts, Status
from coeflab.law.symbols import ANGULAR, primed
from coeflab.tables.force_table import STUDIES

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.fits.results.fit_result import FitResult, Sweep
    from coeflab.fits.uncertainty.grid_convergence import Convergence
    from coeflab.fits.uncertainty.grid_studies import GridStudy, VariantStudy
    from coeflab.fits.uncertainty.propagation import Propagated
    from coeflab.law.coefficient import Coefficient, CoefficientSet
    from coeflab.tables.force_table import ForceTable

from coeflab.fits.uncertainty.input_parts import InputPart, acting, moved_by, moved_digits

DRAWS, SEED = 2000, 1  # 2.5 % tails of 50 draws each: half-widths to about 3 %
TELLING = 0.05  # of the largest force: the relative grid error of a smaller one says nothing
RIG = "rig interference and blockage"
ALWAYS_OPEN = {
    "cfd": ("turbulence model", "domain and boundary conditions"),
    "experiment": (RIG,),
    "literature": ("whatever the source left out",),
    "synthetic": (),
    "estimate": ("scatter of the methods of estimates",),
    "unstated": ("whatever the source left out",),
}
MODEL = STUDIES["turbulence"]
REMAINS = {
    MODEL: ("turbulence model", "turbulence model, its spread stated beside U95"),
    STUDIES["domain"]: ("domain and boundary conditions", "boundary conditions"),
}  # what is open without a study, and with one
COUPLED = "error of the drift angle in the rate sweep"
NOT_OF_A_COMPUTATION = ("force", "moment")
ITERATIONS = STUDIES["iterations"]
MOST = 0.5  # of the variance, by the last digit: more digits would narrow U95 most
LEAST_DIGITS = 1.01  # U95 with that part over U95 without it, below which it is left out
OF_RESULTS = ("grid", *STUDIES.values(), DIGITS)  # parts from outside the points that no input is


@dataclass(frozen=True, slots=True)
class BudgetPart:
    """One part of a U95.

    Attributes
    ----------
    name : str
        ``random``, ``model form``, ``grid``, ``domain size``, ``iterations``, `DIGITS`, or the name of an input.
    half_width : float
        95 %, primed.
    share : float or None
        Of the variance, 0 to 1; None where no U95 is given.
    """

    name: str
    half_width: float
    share: float | None


@dataclass(frozen=True, slots=True)
class OpenGrid:
    """How a budget leaves the grid open: by a study without an order, by a bound alone, or without a study.

    Attributes
    ----------
    study : Convergence or None
    bound : bool
        U95 holds a bound by the range of the study.
    """

    study: Convergence | None
    bound: bool = False

    @property
    def name(self) -> str:
        """As unassessed parts name it."""
        return "grid" if self.study is None else f"grid (study {self.study}{': a bound only' * self.bound})"

    @property
    def reason(self) -> str:
        """Why no verdict holds."""
        return "no grid study" if self.study is None else f"grid study {self.study}{': a bound only' * self.bound}"


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
        How far the value moves had the sweep ended sooner, 2 / sqrt 3 times the largest move; for information, as the
        model-form part holds that already.
    unassessed : tuple of str
    studies : tuple of VariantStudy
        Of the domain, the turbulence model and the iterations, the gravest of each.
    stated : str
        What the source of its tables states of its uncertainty, in its own words.
    open_grid : OpenGrid or None
        How a computed value leaves the grid open; ``unassessed`` names it.
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
    studies: tuple[VariantStudy, ...] = ()
    stated: str = ""
    open_grid: OpenGrid | None = None

    def __repr__(self) -> str:
        largest = max(self.parts, key=lambda p: p.half_width, default=None)
        most = "" if largest is None else f", most of it {largest.name}"
        text = plus_minus(self.value, self.u95)
        return in_angles(self, f"{primed(self.symbol)} = {text} by {len(self.parts)} parts{most}, {self.campaign}")

    def _repr_html_(self) -> str:
        """Its parts as bars and in a table, for notebooks."""
        return html_by("budget", self)

    def part(self, name: str) -> float | None:
        """Half-width of a part; None where it was not assessed."""
        return next((p.half_width for p in self.parts if p.name == name), None)

    @property
    def model_spread(self) -> float | None:
        """How far other turbulence models move the value, 95 % half-width; it stands beside U95, which holds no error of a model."""
        tried = next((s for s in self.studies if s.name == MODEL), None)
        return None if tried is None else tried.relative * abs(self.value)

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
    sweeps = [s for s in fit.sweeps if s.value is not None and s.table in tables]
    if not sweeps:
        return ()
    declared = tables[sweeps[0].table].uncertainty
    moved = None
    if declared is not None and declared.declared:
        of = [tables[s.table] for s in sweeps]
        measured = np.array([t.reference_point if t.measured_about is None else t.measured_about for t in of])
        moved = moved_by(fit, tuple(sweeps), declared, measured, draws, seed)
    found, digits = [], moved_digits(fit, sweeps)
    for i, sweep in enumerate(sweeps):
        c = fit.coefficients[sweep.symbol]
        if c.value is not None:
            found.append(_budget(c, sweep, tables[sweep.table], float(digits[i]), *(moved[i] if moved else ((), None))))
    return tuple(found)


def _budget(
    c: Coefficient,
    sweep: Sweep,
    table: ForceTable,
    digits: float,
    inputs: tuple[InputPart, ...],
    total: Propagated | None,
) -> Budget:
    raw = sweep.value or 0.0
    apart = [abs(s.value - raw) for s in sweep.sensitivity if s.value is not None]
    fitted = {"random": c.parts.random, "model form": c.parts.model_form}
    if c.u95 is not None and c.parts.random is None:
        fitted = {"random and model form": c.u95}
    wanted = acting(sweep.component, sweep.variable in ANGULAR)
    lacking = undeclared(wanted, (table,), inputs) + ([COUPLED] if sweep.variable in ANGULAR else [])
    if _true_by_construction((table,)):
        lacking = []
    window = 2.0 * max(apart) / 3.0**0.5 if apart else None
    return budget_of(c, sweep.component, (table,), fitted, inputs, total, lacking, window, digits=digits)


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
    variants: Sequence[VariantStudy] | None = None,
    digits: float = 0.0,
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
    variants : sequence of VariantStudy, optional
        Those to take; by default the gravest of each in these tables.
    digits : float
        Half-width by the rounding of printed digits.
    """
    value = 0.0 if c.value is None else c.value
    kinds = tuple(dict.fromkeys(t.source.kind for t in tables))
    found = {name: part for name, part in fitted.items() if part is not None}
    lacks = [name for name, part in fitted.items() if part is None]
    study = study or grid_study_of(tables, component)
    relative, open_grid = None if study is None else study.convergence.relative, None
    if relative is not None and study is not None:
        found["grid"] = relative * abs(value)
        if not study.convergence.convergence.converges:
            open_grid = OpenGrid(study.convergence.convergence, bound=True)
    elif "cfd" in kinds:
        open_grid = OpenGrid(None if study is None else study.convergence.convergence)
    lacks += [] if open_grid is None else [open_grid.name]
    studies = tuple(variant_studies_of(tables, component) if variants is None else variants)
    found.update({s.name: s.relative * abs(value) for s in studies if s.name != MODEL})
    found.update({p.name.replace("_", " "): p.linear for p in inputs if p.linear > 0.0})
    noisy = any(t.source.kind == "cfd" and not _has_errors(t, component) for t in tables)
    lacks += [ITERATIONS] * (noisy and ITERATIONS not in found)
    remains = dict(REMAINS[s.name] for s in studies if s.name in REMAINS)
    always = [remains.get(u, u) for kind in kinds for u in ALWAYS_OPEN[kind]]
    unassessed = (*lacks, *lacking, *always)
    u95 = None if c.u95 is None else float(np.sqrt(sum(h * h for h in found.values())))
    if u95 is not None and np.hypot(u95, digits) > LEAST_DIGITS * u95:
        found[DIGITS], u95 = digits, float(np.hypot(u95, digits))
    parts = tuple(BudgetPart(n, h, (h / u95) ** 2 if u95 else None) for n, h in found.items())
    return Budget(
        c.symbol, c.campaign or "", c.body, c.table or "", kinds[0], value, parts, u95, inputs, total, study, window, unassessed,
        studies, "; ".join(dict.fromkeys(filter(None, (t.source.stated_uncertainty for t in tables)))), open_grid,
    )  # fmt: skip


def _has_errors(table: ForceTable, component: str) -> bool:
    """Whether the rows in use state the error that the iterations left; one without the component says nothing of it."""
    if component not in table.forces:
        return True
    errors = table.errors.get(component)
    return errors is not None and bool(np.any(np.isfinite(errors[table.usable[component]])))


def grid_study_of(tables: Sequence[ForceTable], component: str, variables: Sequence[str] = ()) -> GridStudy | None:
    """The gravest grid study of a component; one where the force is next to nothing has no relative
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
        if component not in table.forces:
            continue
        force = table.forces[component][table.usable[component]]
        least = TELLING * float(np.max(np.abs(force), initial=0.0))
        found = [g for g in grid_studies(table, component) if not variables or set(variables) & set(g.moving)]
        studies += [g for g in found if abs(g.convergence.values[g.convergence.used]) >= least]
    return gravest(tuple(studies))


def variant_studies_of(
    tables: Sequence[ForceTable], component: str, variables: Sequence[str] = ()
) -> tuple[VariantStudy, ...]:
    """Of each study of the domain, the turbulence model and the iterations the gravest, as `grid_study_of` does."""
    gravest_of: dict[str, VariantStudy] = {}
    for table in tables:
        if component not in table.forces:
            continue
        force = table.forces[component][table.usable[component]]
        least = TELLING * float(np.max(np.abs(force), initial=0.0))
        for s in variant_studies(table, component):
            known = gravest_of.get(s.name)
            if abs(s.used) < least or s.used == 0.0 or (variables and not set(variables) & set(s.moving)):
                continue
            if known is None or s.relative > known.relative:
                gravest_of[s.name] = s
    return tuple(gravest_of[name] for name in STUDIES.values() if name in gravest_of)


def _true_by_construction(tables: Sequence[ForceTable]) -> bool:
    return all(t.source.kind == "synthetic" and t.uncertainty is None for t in tables)


def undeclared(wanted: Sequence[str], tables: Sequence[ForceTable], inputs: Sequence[InputPart]) -> list[str]:
    """Inputs that may act and were not assessed, by name; none where the tables are synthetic and declare none."""
    if _true_by_construction(tables):
        return []
    computed = all(t.source.kind in ("cfd", "estimate") for t in tables)
    known = {p.name.split(" ")[0] for p in inputs}
    named = [n for n in wanted if not (computed and n in NOT_OF_A_COMPUTATION)]
    return [n.replace("_", " ") for n in named if n not in known]


def with_budget(fit: FitResult, found: Sequence[Budget]) -> FitResult:
    """The fit with the parts of studies and inputs in the U95 and covariance of its coefficients."""
    mine = {b.symbol: b for b in found if b.campaign == fit.campaign}
    if not any(b.u95 is not None for b in mine.values()):
        return replace(fit, findings=(*fit.findings, *open_parts(tuple(mine.values()))))
    among = fit.coefficients
    changed = []
    for c in among.coefficients:
        b = mine.get(c.symbol)
        outside = None if b is None else float(np.hypot(b.input or 0.0, b.joined(*OF_RESULTS)))
        if b is None or b.u95 is None or not outside:
            changed.append(c)
        else:
            is_open = c.status is Status.OK and c.value is not None and abs(c.value) <= b.u95
            status = Status.SIGN_OPEN if is_open else c.status
            changed.append(replace(c, u95=b.u95, status=status, parts=replace(c.parts, input=outside)))
    wider = replace(among, coefficients=tuple(changed), covariance=covariance(among, tuple(mine.values())))
    return replace(fit, coefficients=wider, findings=(*fit.findings, *open_parts(tuple(mine.values()))))


def _alike(found: Sequence[Budget]) -> Iterator[list[Budget]]:
    """Budgets by their grid study; a study and its copy by symmetry, which differ in signs alone, are one."""
    groups: dict[tuple[Any, ...], list[Budget]] = {}
    for b in found:
        if b.grid is not None:
            sizes = tuple(float(f"{abs(v):.9g}") for v in b.grid.convergence.values)
            groups.setdefault((b.campaign, tuple(b.grid.cells), sizes), []).append(b)
    yield from groups.values()


def open_parts(found: Sequence[Budget]) -> tuple[Finding, ...]:
    """What no part of some budgets holds, campaign by campaign, and grid studies that do not converge.

    Parameters
    ----------
    found : sequence of Budget

    Returns
    -------
    tuple of Finding
        ``budget.grid_not_converging`` and ``budget.grid_run_left_out``, warnings, once a study, the first a note where no
        value is told from zero anyway; ``budget.digits``, a warning where these are most of a U95, and ``budget.not_assessed``, a note, once a
        campaign.
    """
    out = []
    for those in _alike([b for b in found if b.grid is not None]):
        studies = [b.grid for b in those if b.grid is not None]
        study, judged = studies[0], studies[0].convergence
        about = f"{those[0].campaign} {', '.join(dict.fromkeys(primed(b.symbol) for b in those))}"
        where: dict[str, Any] = {
            "component": tuple(dict.fromkeys(s.component for s in studies)), "setting": tuple(dict.fromkeys(s.setting for s in studies)),
            "table": study.table,
        }  # fmt: skip
        if not judged.convergence.converges:
            level = Severity.WARN if any(_is_significant(b) for b in those) else Severity.NOTE
            out.append(
                Finding.of(
                    "budget.grid_not_converging", about, level, statistic=judged.relative, how=judged.convergence.value,
                    cells=study.cells, values=judged.values, **where,
                )
            )  # fmt: skip
    left_out: dict[tuple[str, tuple[int, ...]], list[Budget]] = {}
    for b in found:
        if b.grid is not None and b.grid.left_out:
            left_out.setdefault((b.campaign, tuple(b.grid.left_out)), []).append(b)
    for (campaign, cells), those in left_out.items():
        studies = [b.grid for b in those if b.grid is not None]
        out.append(
            Finding.of(
                "budget.grid_run_left_out", f"{campaign} {', '.join(dict.fromkeys(primed(b.symbol) for b in those))}", Severity.WARN,
                cells=cells, used=studies[0].cells, table=studies[0].table,
                component=tuple(dict.fromkeys(s.component for s in studies)), setting=tuple(dict.fromkeys(s.setting for s in studies)),
            )
        )  # fmt: skip
    for campaign in dict.fromkeys(c for b in found for c in b.campaign.split(", ")):
        mine = [b for b in found if campaign in b.campaign.split(", ")]
        parts = tuple(dict.fromkeys(name for b in mine for name in b.unassessed))
        stated = "; ".join(dict.fromkeys(filter(None, (b.stated for b in mine))))
        shares = {primed(b.symbol): p.share for b in mine for p in b.parts if p.name == DIGITS and p.share is not None}
        if shares:
            most = max(shares.values())
            level = Severity.WARN if most > MOST else Severity.NOTE
            out.append(
                Finding.of("budget.digits", campaign, level, statistic=most, threshold=MOST, symbols=tuple(shares))
            )
        if parts:
            out.append(
                Finding.of(
                    "budget.not_assessed", campaign, Severity.NOTE, parts=parts, states="some" if stated else "none", stated=stated,
                    symbols=tuple(dict.fromkeys(primed(b.symbol) for b in mine if b.unassessed)),
                )
            )  # fmt: skip
    return tuple(out)


def _is_significant(b: Budget) -> bool:
    """Whether a value is told from zero but for its grid study."""
    return abs(b.value) > b.joined(*(p.name for p in b.parts if p.name != "grid"))


def as_estimates(fit: FitResult) -> FitResult:
    """A fit to estimated forces: its values are estimates, and its intervals, which a smooth law makes small, say nothing."""
    among = fit.coefficients
    changed = tuple(
        c if c.value is None else replace(c, u95=None, parts=Parts(), status=Status.ESTIMATE, origin="estimate")
        for c in among.coefficients
    )
    unknown = np.full_like(among.covariance, np.nan)
    return replace(fit, coefficients=replace(among, coefficients=changed, covariance=unknown))


def covariance(among: CoefficientSet, found: Sequence[Budget]) -> Array:
    """Covariance of standard uncertainties of a set with the budgets' further parts, shape (k, k).

    Random parts keep the correlation of the set. The error that a study finds is common to the coefficients of one component
    that take it from one study, and independent of others. An input error is common to the coefficients of a campaign, so that it
    cancels where a ratio does not feel it.
    """
    return np.asarray(among.covariance + further(among.symbols, [c.campaign for c in among.coefficients], found))


def _shared_studies(a: Budget, b: Budget) -> tuple[str, ...]:
    """Parts that two budgets take from one study."""
    one, two = ({name: (s.table, s.component, s.setting) for name, s in _studies_of(budget)} for budget in (a, b))
    return tuple(name for name in one if one[name] == two.get(name))


def _studies_of(b: Budget) -> list[tuple[str, GridStudy | VariantStudy]]:
    grid: list[tuple[str, GridStudy | VariantStudy]] = [] if b.grid is None else [("grid", b.grid)]
    return [*grid, *((s.name, s) for s in b.studies)]


def further(symbols: Sequence[str], campaigns: Sequence[str | None], found: Sequence[Budget]) -> Array:
    """Covariance that studies and inputs add, shape (k, k); symbols with or without prime."""
    by = {(primed(b.symbol), b.campaign): b for b in found}
    chosen = [by.get((primed(s), c or "")) for s, c in zip(symbols, campaigns, strict=True)]
    out = np.zeros((len(symbols), len(symbols)))
    for i, a in enumerate(chosen):
        for j, b in enumerate(chosen):
            if a is None or b is None or a.campaign != b.campaign:
                continue
            other = {p.name: p.sensitivity for p in b.inputs}
            out[i, j] += sum(p.sensitivity * other.get(p.name, 0.0) * p.half_width**2 for p in a.inputs) / 4.0
            for name in OF_RESULTS if i == j else _shared_studies(a, b):
                pair = (np.copysign(x.joined(name), x.value) for x in (a, b))
                out[i, j] += float(np.prod(list(pair))) / 4.0
    return out

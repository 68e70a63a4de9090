"""Slopes at the origin: Yv', Nv', Zw', Mw', Yr', Nr' and their like, with what they are worth.

Every force component is regressed on v' = sin(beta), w' = sin(alpha), r' = r L/U or a control angle by several forms in
growing windows; `coeflab.fits.statistics.slopes.recommend` gives the rule.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from coeflab.core.limits import REPLICATES
from coeflab.core.options import bounded, parse_options
from coeflab.core.types import Array
from coeflab.fits.results.fit_result import BootstrapInterval, FitResult, Sensitivity, Sweep
from coeflab.fits.rows.sweeps import INCIDENCE, SweepRows, arm_shift, collect_points, sweep_rows
from coeflab.fits.statistics import slopes
from coeflab.fits.statistics import slopes as families
from coeflab.fits.statistics.diagnostics import drawn_counts, levels, pairs, percentile_interval, wild
from coeflab.law.coefficient import Coefficient, CoefficientSet, Parts, Status
from coeflab.law.scaling import Scaling
from coeflab.tables.force_table import ForceTable

summary = "slopes at the origin by several forms and windows, with random and model-form uncertainty"
citations = ("mackinnon1985", "bell2002", "imbens2016", "davidson2008", "hurvich1989")
ODD = {"v": "YNK", "w": "ZM", "r": "YNK", "q": "ZM", "p": "K", "dr": "YNK", "ds": "ZM", "db": "ZM"}
EVEN = {"v": "X", "w": "X", "r": "X", "q": "X"}
SMALLEST_ANGLE = np.sin(np.radians(3.0))
ANGLE_CAPS = (10.0, 12.0, 18.0)
RATE_CAPS = (0.5, 0.75, 1.0)


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    replicates : int
        Bootstrap replicates.
    seed : int
        Seed of the bootstrap.
    largest_angle : float
        Largest drift or attack angle that any window may reach, degrees.
    """

    replicates: int = bounded(2000, 100, REPLICATES)
    seed: int = bounded(1, 0, 2**31)
    largest_angle: float = bounded(90.0, 1.0, 90.0)


def _bootstrap(recommendation: slopes.Recommendation, y: Array, options: Options) -> dict[str, BootstrapInterval]:
    out = {}
    for k, e in enumerate(recommendation.members):
        seed = options.seed * 1009 + k
        rows = e.rows
        drawn = drawn_counts(len(rows), options.replicates, seed)
        by_pairs = np.concatenate([pairs(e.factorised, y[rows, None], c)[:, e.target, 0] for c in drawn])
        by_signs = wild(e.factorised, e.coefficients, e.residuals, options.replicates, seed + 500)[:, e.target]
        low, high, usable = percentile_interval(by_pairs)
        wild_low, wild_high, _ = percentile_interval(by_signs)
        out[e.family.name] = BootstrapInterval((low, high), (wild_low, wild_high), usable)
    return out


def _sweep(
    rows: SweepRows,
    variable: str,
    component: str,
    symbol: str,
    parity: str,
    length: float,
    options: Options,
    slope: float,
) -> Sweep:
    offset, taken_out = "", np.zeros(len(rows.table))
    if variable in INCIDENCE and slope:
        motion = INCIDENCE[variable]
        taken_out = slope * rows.table.primed_motion(motion, length)
        offset = f"{component}{motion}' {motion}' of the residual incidence taken out"
    x, y, se, labels, left = collect_points(rows, component, length, taken_out)
    target = "x" if parity == "odd" else "1" if symbol.endswith("0") else "x2"
    is_angle = variable in ("v", "w")
    limit = np.sin(np.radians(options.largest_angle)) if is_angle else np.inf
    smallest = SMALLEST_ANGLE if is_angle else 0.0

    def recommended(largest: float) -> slopes.Recommendation:
        if len(x) == 0:
            return slopes.Recommendation(None, None, None, None, (), ())
        return slopes.recommend(x, y, se, parity=parity, target=target, smallest=smallest, largest=largest)

    recommendation = recommended(limit)
    reach = float(np.max(np.abs(x), initial=0.0))
    caps = [float(np.sin(np.radians(c))) for c in ANGLE_CAPS] if is_angle else [c * reach for c in RATE_CAPS]
    caps = [c for c in caps if c <= reach * 1.03]
    forms = families.ODD if parity == "odd" else families.EVEN
    plain = tuple(
        e
        for f in forms
        for _, index in slopes.windows(x, 0.0, limit)
        if (e := slopes.estimate(f, f.terms, target, x, y, se, index)) is not None
    )
    return Sweep(
        symbol=symbol,
        variable=variable,
        component=component,
        parity=parity,
        target=target,
        x=x,
        y=y,
        se=se,
        labels=labels,
        left_out=left,
        recommendation=recommendation,
        plain=plain,
        bootstrap=_bootstrap(recommendation, y, options),
        sensitivity=tuple(Sensitivity(c, r.value, r.u95) for c in caps for r in [recommended(min(c, limit))]),
        one_sided=slopes.is_one_sided(x),
        table=rows.table.name,
        campaign=rows.table.campaign,
        body=rows.table.body,
        offset=offset,
        borrowed=rows.rest[0].name if rows.rest is not None and component in rows.rest[0].forces else "",
    )


def _moved(shift: float) -> dict[str, str]:
    if not shift:
        return {}
    return {"swept about": f"a point {shift:+.6g} m forward, where the rotating runs do not drift; then moved back"}


def _coefficient(sweep: Sweep, citation: str) -> Coefficient:
    r = sweep.recommendation
    if r.value is None:
        return Coefficient(
            sweep.symbol, None, None, Status.NOT_DETERMINED if r.panel else Status.TOO_FEW_POINTS, sweep.body,
            origin="fit", table=sweep.table, campaign=sweep.campaign, n_points=len(sweep.x), citation=citation,
            estimator="no form stands its next-term test or has an interval" if r.panel else "",
        )  # fmt: skip
    widest = max(r.members, key=lambda e: e.window)
    return Coefficient(
        symbol=sweep.symbol,
        value=r.value,
        u95=r.u95,
        status=Status.OK if r.u95 is not None else Status.SINGLE_ESTIMATOR,
        body=sweep.body,
        parts=Parts(random=r.random, model_form=r.model_form),
        origin="fit",
        table=sweep.table,
        campaign=sweep.campaign,
        estimator=("median of " if len(r.members) > 1 else "")
        + ", ".join(e.family.name.format(x=f"{sweep.variable}'") for e in r.members)
        + (f", with the rest row of {sweep.borrowed}" if sweep.borrowed else ""),
        window=sweep.window_of(widest),
        n_points=len(widest.rows),
        citation=citation,
    )


def _row_keys(sweep: Sweep) -> list[tuple[str, int]]:
    """What names a row across the sweeps of a table: its label and, where labels repeat, which of them it is."""
    seen: Counter[str] = Counter()
    keys = []
    for label in sweep.labels:
        keys.append((label, seen[label]))
        seen[label] += 1
    return keys


def _covariance(sweeps: list[Sweep], coefficients: list[Coefficient]) -> Array:
    """(U95/2)^2 on the diagonal; between coefficients of one table, the correlation of their random parts.

    The correlation is that of the rows which both use, so a cell that only one of them leaves out does not undo it.
    """
    k = len(sweeps)
    out = np.zeros((k, k))
    names = {key: n for n, key in enumerate(dict.fromkeys(key for s in sweeps for key in _row_keys(s)))}
    moved: list[Array | None] = []
    for s in sweeps:
        on_all = None
        if s.recommendation.members:
            on_all = np.zeros(len(names))
            on_all[[names[key] for key in _row_keys(s)]] = slopes.influence(s.recommendation.members, len(s.x))
        moved.append(on_all)
    for i in range(k):
        for j in range(i + 1, k):
            a, b, ci, cj = moved[i], moved[j], coefficients[i], coefficients[j]
            same = sweeps[i].table == sweeps[j].table
            if a is None or b is None or not same or ci.parts.random is None or cj.parts.random is None:
                continue
            size = float(np.linalg.norm(a) * np.linalg.norm(b))
            if size > 0.0:
                out[i, j] = out[j, i] = float(a @ b) / size * ci.parts.random * cj.parts.random / 4.0
    for i, c in enumerate(coefficients):
        out[i, i] = np.nan if c.u95 is None else (c.u95 / 2.0) ** 2
        if c.u95 is None:
            out[i, :] = out[:, i] = np.nan
    return out


def _jobs(tables: Sequence[ForceTable], length: float) -> dict[str, tuple[SweepRows, str, str, str]]:
    """Which table gives which coefficient: the one whose sweep has the most settings, the first among equals."""
    out: dict[str, tuple[SweepRows, str, str, str]] = {}
    most: dict[str, int] = {}
    for variable, odd in ODD.items():
        for table in (t for t in tables if variable in t.varies):
            rows = sweep_rows(table, variable, tables, length)
            wanted = [(c, f"{c}{variable}", "odd") for c in odd]
            for c in EVEN.get(variable, ""):
                wanted += [(c, f"{c}0", "even"), (c, f"{c}{variable}{variable}", "even")]
            for component, symbol, parity in wanted:
                if component not in table.forces:
                    continue
                usable = table.usable[component][rows.rows]
                settings = len(np.unique(levels(rows.x[rows.rows][usable])))
                if settings > most.get(symbol, -1):
                    out[symbol], most[symbol] = (rows, variable, component, parity), settings
    return out


def fit(tables: Sequence[ForceTable], scaling: Scaling, options: Mapping[str, Any]) -> FitResult:
    """Fit every coefficient that the tables of one campaign give.

    Parameters
    ----------
    tables : sequence of ForceTable
        Of one campaign, about one reference point.
    scaling : Scaling
        Length of the primes.
    options : mapping
        See `Options`.

    Returns
    -------
    FitResult
        Coefficients that could not be determined carry their status.
    """
    chosen = parse_options(Options, options, "slope_at_origin")
    length = scaling.length
    wanted = tables[0].reference_point
    shift = arm_shift(tables)
    tables = [t.about(wanted + np.array([shift, 0.0, 0.0])) for t in tables]
    sweeps: list[Sweep] = []
    for symbol, (rows, variable, component, parity) in _jobs(tables, length).items():
        static = f"{component}{INCIDENCE.get(variable, '')}"
        known = [s.recommendation.value for s in sweeps if s.symbol == static and s.table == rows.table.name]
        slope = known[0] if known and known[0] is not None else 0.0
        sweeps.append(_sweep(rows, variable, component, symbol, parity, length, chosen, slope))
    first = tables[0]
    coefficients = [_coefficient(s, first.source.citation) for s in sweeps]
    return FitResult(
        fit="slope_at_origin",
        campaign=first.campaign,
        body=first.body,
        coefficients=CoefficientSet(
            tuple(coefficients),
            _covariance(sweeps, coefficients),
            scaling,
            first.reference_point,
            first.datum,
            first.body,
        ).about(wanted),
        sweeps=tuple(sweeps),
        citations=citations,
        settings={"replicates": str(chosen.replicates), "seed": str(chosen.seed)} | _moved(shift),
    )

"""Slopes at the origin: Yv', Nv', Zw', Mw', Yr', Nr' and their like, with what they are worth.

Every force component is regressed on v' = sin(beta), w' = sin(alpha), r' = r L/U or a control angle by several forms in
growing windows; `coeflab.kernels.slopes.recommend` gives the rule.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from coeflab.core.options import bounded, parse_options
from coeflab.kernels import slopes
from coeflab.kernels.bootstrap import draw_counts, pairs, percentile_interval, wild
from coeflab.model.coefficient import Coefficient, CoefficientSet, Parts, Status
from coeflab.model.fit_result import BootstrapInterval, FitResult, LeftOut, Sensitivity, Sweep
from coeflab.model.force_table import ForceTable
from coeflab.model.scaling import Scaling

summary = "slopes at the origin by several forms and windows, with random and model-form uncertainty"
citations = ("mackinnon1985", "bell2002", "imbens2016", "davidson2008", "hurvich1989")

Array = NDArray[np.float64]
ODD = {"v": "YNK", "w": "ZM", "r": "YNK", "q": "ZM", "p": "K", "dr": "YNK", "ds": "ZM"}
EVEN = {"v": "X", "w": "X", "r": "X", "q": "X"}
INCIDENCE = {"dr": "v", "ds": "w"}
AT_REST = np.sin(np.radians(0.05))
NEAR_ZERO = np.sin(np.radians(0.3))
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

    replicates: int = bounded(2000, 100, 1_000_000)
    seed: int = bounded(1, 0, 2**31)
    largest_angle: float = bounded(90.0, 1.0, 90.0)


@dataclass(frozen=True, slots=True, eq=False)
class _Rows:
    """Rows of one sweep, with rest rows of the same campaign where a one-sided sweep has none of its own."""

    table: ForceTable
    x: Array
    rows: NDArray[np.intp]
    rest: tuple[ForceTable, NDArray[np.intp]] | None


def _others_at_rest(table: ForceTable, variable: str, length: float) -> NDArray[np.bool_]:
    """Rows in which nothing but surge and ``variable`` moves (control sweeps: within 0.3 degrees of zero incidence)."""
    keep = np.ones(len(table), dtype=bool)
    for name in ("v", "w", "p", "q", "r", *table.controls):
        if name != variable:
            limit = NEAR_ZERO if INCIDENCE.get(variable) == name else AT_REST
            keep &= np.abs(table.primed_motion(name, length)) <= limit
    return keep


def _rows(table: ForceTable, variable: str, tables: Sequence[ForceTable], length: float) -> _Rows:
    keep = _others_at_rest(table, variable, length)
    x = table.primed_motion(variable, length)
    rest = None
    if slopes.is_one_sided(x[keep]) and not np.any(keep & (np.abs(x) <= AT_REST)):
        for other in tables:
            still = _others_at_rest(other, "", length)
            if other is not table and np.any(still) and np.allclose(other.speed[still], table.speed.mean(), rtol=0.01):
                rest = (other, np.flatnonzero(still))
                break
    return _Rows(table, x, np.flatnonzero(keep), rest)


def _collect(
    rows: _Rows, component: str, length: float, taken_out: Array
) -> tuple[Array, Array, Array | None, tuple[str, ...], tuple[LeftOut, ...]]:
    """x, y, se, labels of the usable points, and those left out with their reasons.

    ``taken_out`` is subtracted from the primed force of every row of the sweep's own table.
    """
    table = rows.table
    reasons = {(e.row, e.component): e.reason for e in table.exclusions}
    parts: list[tuple[ForceTable, NDArray[np.intp], Array]] = [(table, rows.rows, rows.x[rows.rows])]
    if rows.rest is not None and component in rows.rest[0].forces:
        parts.append((*rows.rest, np.zeros(len(rows.rest[1]))))
    x, y, se, labels = [], [], [], []
    left: list[LeftOut] = []
    for source, index, at in parts:
        force = source.primed_force(component, length) - (taken_out if source is table else 0.0)
        error = source.primed_force(component, length, source.errors[component]) if component in source.errors else None
        for i, xi in zip(index, at, strict=True):
            if source.usable[component][i]:
                x.append(xi)
                y.append(force[i])
                se.append(np.nan if error is None else error[i])
                labels.append(source.labels[i])
            elif source is table:
                why = reasons.get((int(i), component)) or reasons.get((int(i), ""), "excluded")
                left.append(LeftOut(float(xi), float(force[i]), source.labels[i], why))
    errors = np.array(se)
    known = errors if len(errors) and np.all(np.isfinite(errors)) else None
    return np.array(x), np.array(y), known, tuple(labels), tuple(left)


def _bootstrap(recommendation: slopes.Recommendation, y: Array, options: Options) -> dict[str, BootstrapInterval]:
    out = {}
    for k, e in enumerate(recommendation.members):
        seed = options.seed * 1009 + k
        rows = e.rows
        counts = draw_counts(len(rows), options.replicates, seed)
        by_pairs = pairs(e.factorised, y[rows, None], counts)[:, e.target, 0]
        by_signs = wild(e.factorised, e.coefficients, e.residuals, options.replicates, seed + 500)[:, e.target]
        low, high, usable = percentile_interval(by_pairs)
        wild_low, wild_high, _ = percentile_interval(by_signs)
        out[e.family.name] = BootstrapInterval((low, high), (wild_low, wild_high), usable)
    return out


def _sweep(
    rows: _Rows, variable: str, component: str, symbol: str, parity: str, length: float, options: Options, slope: float
) -> Sweep:
    offset, taken_out = "", np.zeros(len(rows.table))
    if variable in INCIDENCE and slope:
        motion = INCIDENCE[variable]
        taken_out = slope * rows.table.primed_motion(motion, length)
        offset = f"{component}{motion}' {motion}' of the residual incidence taken out"
    x, y, se, labels, left = _collect(rows, component, length, taken_out)
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
    families = slopes.ODD if parity == "odd" else slopes.EVEN
    plain = tuple(
        e
        for f in families
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
    )


def _arm_shift(tables: Sequence[ForceTable]) -> float:
    """How far forward the point lies at which rotating runs have no cross flow; 0 if there is no one such point.

    About any other point an arm's runs have v = r dx (w = -q dx), and no row turns without drifting.
    """
    found: list[Array] = []
    for table in tables:
        for rate, drift, sign in (("r", "v", -1.0), ("q", "w", 1.0)):
            turning = table.motion[rate] != 0.0
            if np.any(turning):
                found.append(sign * table.motion[drift][turning] / table.motion[rate][turning])
    if not found:
        return 0.0
    shifts = np.concatenate(found)
    scale = float(tables[0].scaling.length)
    return float(np.median(shifts)) if float(np.ptp(shifts)) <= 1e-6 * scale else 0.0


def _moved(shift: float) -> dict[str, str]:
    if not shift:
        return {}
    return {"swept about": f"a point {shift:+.6g} m forward, where the rotating runs do not drift; then moved back"}


def _coefficient(sweep: Sweep, citation: str) -> Coefficient:
    r = sweep.recommendation
    if r.value is None:
        return Coefficient(
            sweep.symbol, None, None, Status.TOO_FEW_POINTS, sweep.body, origin="fit", table=sweep.table,
            campaign=sweep.campaign, n_points=len(sweep.x), citation=citation,
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
        + ", ".join(e.family.name.format(x=f"{sweep.variable}'") for e in r.members),
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
    shift = _arm_shift(tables)
    tables = [t.about(wanted + np.array([shift, 0.0, 0.0])) for t in tables]
    sweeps: list[Sweep] = []
    for table in tables:
        for variable in (v for v in (*ODD,) if v in table.varies):
            rows = _rows(table, variable, tables, length)
            jobs = [(c, f"{c}{variable}", "odd") for c in ODD[variable]]
            for c in EVEN.get(variable, ""):
                jobs += [] if any(s.symbol == f"{c}0" for s in sweeps) else [(c, f"{c}0", "even")]
                jobs += [(c, f"{c}{variable}{variable}", "even")]
            for component, symbol, parity in jobs:
                if component in table.forces and not any(s.symbol == symbol for s in sweeps):
                    static = f"{component}{INCIDENCE.get(variable, '')}"
                    known = [s.recommendation.value for s in sweeps if s.symbol == static and s.table == table.name]
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

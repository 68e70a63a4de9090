"""Slopes at the origin: Yv', Nv', Zw', Mw', Yr', Nr' and their like, each with a U95 that covers the form of the curve.

Every force component is regressed on v' = sin(beta), w' = sin(alpha), r' = r L/U or a control angle by the calibrated
model of `coeflab.fits.statistics.origin_slope`. Even coefficients come from the same model: X0' is its curve at rest,
Xvv' the slope at the origin of (X - X0)/v' over v', every row weighed by v'^2, the error of X0 in its U95. The
calibration in ``tests/coverage`` is of slopes only. Of even coefficients 30 campaigns each were tried, for v^2 alone, with
v^4, an odd part or an onset of stall: both were covered in 83 to 100 %. Not so for v^2 + |v|^3 at a noise of 1 % of the
largest force, where |v|^3 passes for v^4 and Xvv' is covered in 30 to 50 %.

Of a table in which nothing varies but the speed, X0' is the mean of X' over the runs; U95 holds their scatter, and a trend of X'
with the speed beyond it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import fdtrc

from coeflab.core.axes import point_in_words
from coeflab.core.finding import Finding, Severity
from coeflab.core.options import bounded, parse_options
from coeflab.core.types import Array
from coeflab.fits.results.fit_result import FitResult, LeftOut, Sensitivity, Sweep, independent, result_of
from coeflab.fits.rows.straight_runs import resistance
from coeflab.fits.rows.sweeps import (
    ACROSS,
    ACROSS_AT,
    FEWEST_SETTINGS,
    INCIDENCE,
    JUMPED,
    STALLED,
    arm_shift,
    collect_points,
    held,
    one_size,
    sweep_rows,
)
from coeflab.fits.statistics import origin_slope, printed_digits, slopes
from coeflab.fits.statistics.diagnostics import levels
from coeflab.fits.statistics.many_rows import condensed_rows, images
from coeflab.law.coefficient import Coefficient, Parts, Status
from coeflab.law.symbols import ANGULAR, primed
from coeflab.tables.campaign import PORT_STARBOARD, UP_DOWN
from coeflab.tables.force_table import AT_REST

if TYPE_CHECKING:
    from coeflab.fits.rows.sweeps import SweepRows
    from coeflab.fits.statistics.origin_slope import OriginSlope
    from coeflab.law.scaling import Scaling
    from coeflab.tables.force_table import ForceTable

summary = "slopes at the origin without a choice of form or window, with a calibrated uncertainty"
citations = ("wahba1990", "kimeldorf1970", "grunwald2017", "mackinnon1985", "bell2002", "hurvich1989")
ODD = {"v": "YNK", "w": "ZM", "r": "YNK", "q": "ZM", "p": "K", "dr": "YNK", "ds": "ZM", "db": "ZM"}
SIDEWAYS = {**dict.fromkeys(("v", "p", "r", "dr"), PORT_STARBOARD), **dict.fromkeys(("w", "q", "ds", "db"), UP_DOWN)}
MIRRORED = "mirror image of another row: counts once"
COMPUTED = "cfd"
PAIRED = "the other side of {}: half the difference of both counts"
AT_REST_BY_SYMMETRY = "at rest, where it is zero by declared symmetry"
EVEN = {"v": "X", "w": "X", "r": "X", "q": "X"}
ANGLE_CAPS = (10.0, 12.0, 18.0)
RATE_CAPS = (0.5, 0.75, 1.0)
MOST_NAMED = 12  # rows that do not fit their neighbours
UNLIKE = 0.05  # probability of as large a miss of runs by rows turned into their plane, below which those are withdrawn
WIDER = 2.0  # U95 by a declared symmetry over that without it, above which it is withdrawn
NEAR = 20  # settings beside rest that say by themselves what the slope is
NODES = 41  # of the recommended curve, odd: one is at rest


_Points = tuple[Array, Array, Array | None, tuple[str, ...], tuple[LeftOut, ...]]  # as `collect_points` gives them


@dataclass(frozen=True, slots=True)
class Options:
    """Options of the fit.

    Attributes
    ----------
    largest_angle : float
        Largest drift or attack angle that is used, degrees.
    """

    largest_angle: float = bounded(90.0, 1.0, 90.0, degrees=True)


def _within(limit: float, points: _Points) -> _Points:
    """The points up to the largest setting; the others are left out."""
    inside = np.abs(points[0]) <= limit
    return _only(points, inside, {int(i): "beyond largest_angle" for i in np.flatnonzero(~inside)})


def _before_stall(rows: SweepRows, variable: str, length: float, points: _Points) -> _Points:
    """The points up to where the force across the flow falls again with the angle, or the reading jumps; those beyond belong to another flow."""
    points = _between(slopes.before_jump(points[0], points[1]), points, JUMPED)
    across = {"v": "Y", "w": "Z"}.get(variable, "")
    if across not in rows.table.forces:
        return points
    x, y, *_ = collect_points(rows, across, length, np.zeros(len(rows.table)))
    return _between(slopes.before_stall(x, y), points, STALLED)


def _between(ends: tuple[float, float], points: _Points, why: str) -> _Points:
    margin = 1.0 + 1e-5  # settings are compared as they were rounded
    inside = (points[0] >= ends[0] * margin) & (points[0] <= ends[1] * margin)
    return _only(points, inside, dict.fromkeys(np.flatnonzero(~inside).tolist(), why))


def _only(points: _Points, keep: NDArray[np.bool_], why: Mapping[int, str]) -> _Points:
    x, y, se, labels, left = points
    left += tuple(LeftOut(float(x[i]), float(y[i]), labels[i], why[int(i)]) for i in np.flatnonzero(~keep))
    named = tuple(label for label, stays in zip(labels, keep, strict=True) if stays)
    return x[keep], y[keep], None if se is None else se[keep], named, left


def _on_one_side(
    rows: SweepRows, variable: str, parity: str, points: _Points
) -> tuple[str, _Points, float]:  # fmt: skip
    """The declared symmetry that gives the other side of a sweep, the points that count by it, and the bias at rest.

    A row and its mirror image are one reading. An odd force at rest is zero by declaration: a row there says nothing of the slope,
    and what little noise it has is not that of the others; what it has is a bias. A pair of computed rows at both signs of one
    setting counts once, by half its difference, which is free of that bias.
    """
    plane = SIDEWAYS[variable]
    if plane not in rows.table.symmetry:
        return "", points, 0.0
    again = images(points[0], points[1], -1.0 if parity == "odd" else 1.0)
    if np.any(again):
        points = _only(points, ~again, dict.fromkeys(np.flatnonzero(again).tolist(), MIRRORED))
    if parity == "odd" and rows.table.source.kind == COMPUTED:
        points = _paired(points)
    x = points[0]
    if not slopes.is_one_sided(x):
        return "", points, 0.0
    resting, bias = np.abs(x) <= AT_REST, 0.0
    if parity == "odd" and np.any(resting):
        bias = float(points[1][resting].mean())
        points = _only(points, ~resting, dict.fromkeys(np.flatnonzero(resting).tolist(), AT_REST_BY_SYMMETRY))
    return plane, points, bias


def _paired(points: _Points) -> _Points:
    """The points with those at the other side of a setting taken into its own: half their difference, with its error."""
    x, y, se, labels, _ = points
    mine = np.flatnonzero(x * np.sign(x[np.argmax(np.abs(x))]) > AT_REST) if len(x) else np.zeros(0, dtype=np.int64)
    y, se, taken = y.copy(), None if se is None else se.copy(), {}
    for i in np.setdiff1d(np.flatnonzero(np.abs(x) > AT_REST), mine):
        own = mine[np.abs(x[mine] + x[i]) <= AT_REST]
        if len(own) != 1:
            continue
        j = int(own[0])
        y[j] = (y[j] - y[i]) / 2.0
        if se is not None:
            se[j] = np.hypot(se[j], se[i]) / 2.0
        taken[int(i)] = PAIRED.format(labels[j])
    keep = np.ones(len(x), dtype=bool)
    keep[list(taken)] = False
    return _only((x, y, se, labels, points[4]), keep, taken) if taken else points


def _sweep(
    rows: SweepRows,
    variable: str,
    component: str,
    symbol: str,
    parity: str,
    length: float,
    options: Options,
    slope: float,
    last: tuple[Sweep, OriginSlope] | None,
) -> tuple[Sweep, OriginSlope]:
    offset, taken_out = "", np.zeros(len(rows.table))
    if variable in INCIDENCE and slope:
        motion = INCIDENCE[variable]
        taken_out = slope * rows.table.primed_motion(motion, length)
        offset = f"{component}{motion}' {motion}' of the residual incidence taken out"
    target = "x" if parity == "odd" else "1" if symbol.endswith("0") else "x2"
    is_angle = variable in ("v", "w")
    limit = float(np.sin(np.radians(options.largest_angle))) * (1.0 + slopes.SAME_LEVEL) if is_angle else np.inf
    every = _before_stall(rows, variable, length, _within(limit, collect_points(rows, component, length, taken_out)))
    plane, (x, y, se, labels, far), bias, withdrawn = _by_symmetry(rows, variable, parity, every)
    odd, each, variance = bool(plane) and parity == "odd", (x, y, se), None
    if (
        last is not None
        and odd == (bool(last[0].symmetry) and last[0].parity == "odd")
        and np.array_equal(last[0].x, x)
        and np.array_equal(last[0].y, y)
    ):
        origin, curve, fitted, at_rest = last[1], last[0].curve, last[0].fitted, last[0].at_rest
    else:
        few = condensed_rows(x, y, se, odd)
        if few is None:
            origin = origin_slope.estimate(x, y, se, odd=odd)
        else:
            origin = origin_slope.estimate_condensed(few, odd=odd)
            far += tuple(
                LeftOut(float(x[i]), float(y[i]), labels[i], "does not fit its neighbours")
                for i in np.flatnonzero(few.strip < 0)[:MOST_NAMED]
            )
            x, y, se, variance = few.x, few.y, origin.noise * np.sqrt(few.variance), few.variance
            labels = tuple(f"mean of {n} rows" for n in np.bincount(few.strip[few.strip >= 0]))
        over = float(np.max(np.abs(x), initial=0.0)) * np.linspace(-1.0, 1.0, NODES)
        mean, halves = origin_slope.curve(origin, np.concatenate([x, over]))
        fitted, curve = mean[: len(x)], np.stack([over, mean[len(x) :], halves[len(x) :]])
        at_rest = (float(curve[1, NODES // 2]), float(curve[2, NODES // 2]))
    middle = None if se is None or not np.any(se > 0.0) else float(np.median(se[se > 0.0]))
    value, u95, moved = slopes.determined(origin, target, middle, at_rest, bool(plane))
    if single := _one_size(rows, variable, target, x, origin):
        value, u95, moved = None, None, np.zeros_like(moved)
    by_row = np.zeros(len(x))
    by_row[origin.used] = moved
    if u95 is not None and bias:
        u95 = float(np.hypot(u95, bias * moved.sum()))
    near = [] if value is None else _nearest(*each, target, middle, bool(plane), odd)
    u95 = _holding(near, value, u95)
    random = _random(origin, moved, u95)
    with_all = value
    if parity == "even" and np.any(np.isfinite(origin.without) & np.logical_not(origin.used)):
        everything = slopes.of_all_rows(origin, x, y, se)
        mean, half = origin_slope.curve(everything, np.zeros(1))
        with_all, _, _ = slopes.determined(everything, target, middle, (float(mean[0]), float(half[0])), bool(plane))
    elif parity == "odd" and origin.design is not None:
        with_all = origin.with_all
    reach = float(np.max(np.abs(x), initial=0.0))
    caps = [float(np.sin(np.radians(c))) for c in ANGLE_CAPS] if is_angle else [c * reach for c in RATE_CAPS]
    caps = [c for c in caps if c <= reach * 1.03] if parity == "odd" and reach else []
    shorter = slopes.by_largest(x, y, [w for c in caps if (w := c * (1.0 + slopes.SAME_LEVEL)) < reach], se, odd=odd)
    ended = [s for _, s in shorter] + [origin] * (len(caps) - len(shorter))
    sweep = Sweep(
        symbol=symbol,
        variable=variable,
        component=component,
        parity=parity,
        target=target,
        x=x,
        y=y,
        se=se,
        labels=labels,
        left_out=far,
        value=value,
        u95=u95,
        random=random,
        reason=single or origin.reason,
        notes=origin.notes,
        used=origin.used,
        wrong=np.flatnonzero(np.logical_not(origin.used) & np.isfinite(origin.without)),
        with_all=with_all,
        curve=curve,
        fitted=fitted,
        at_rest=at_rest,
        by_row=by_row,
        forms=tuple(
            e
            for f in (slopes.ODD if parity == "odd" else slopes.EVEN)
            for _, index in slopes.windows(x, limit)
            if (e := slopes.estimate(f, target, x, y, se, index)) is not None
        ),
        sensitivity=tuple(Sensitivity(*n) for n in reversed(near if parity == "odd" else []))
        + tuple(
            Sensitivity(c, *((None, None) if s.design is None else (s.value, s.u95)))
            for c, s in zip(caps, ended, strict=True)
        ),
        one_sided=slopes.is_one_sided(x),
        table=rows.table.name,
        campaign=rows.table.campaign,
        body=rows.table.body,
        offset=offset,
        one_size=bool(single),
        symmetry=plane,
        withdrawn=withdrawn,
        by_symmetry=rows.table.by_symmetry,
        held=_angle_across(rows.table, variable),
        bias=bias,
        rounding=0.0
        if value is None or u95 is None
        else slopes.by_digits(
            x,
            y,
            se,
            _digits(rows, component, length, x, variance, origin.noise),
            target,
            origin.noise,
            bool(plane),
            odd,
            value,
            u95,
        ),
        borrowed=rows.rest[0].name if rows.rest is not None and component in rows.rest[0].forces and not odd else "",
    )
    return sweep, origin


def _nearest(
    x: Array, y: Array, se: Array | None, target: str, middle: float | None, plane: bool, odd: bool
) -> list[tuple[float, float, float]]:
    """Reach, value and U95 by the rows near rest alone, of halves of the range as long as they hold `NEAR` settings.

    A kink within a degree of rest (a laminar bubble) is no form of the mixture: U95 of the whole sweep passes it by, and rows enough
    beside rest see it.
    """
    out, size = [], np.abs(x)
    half = float(np.max(size, initial=0.0)) / 2.0
    while half and len(np.unique(np.round(x[inside := size <= half] / half, 2))) >= NEAR:
        value, u95 = slopes.of_rows(
            x[inside], y[inside], None if se is None else se[inside], target, middle, plane, odd
        )
        if value is not None and u95 is not None:
            out.append((half, value, u95))
        half /= 2.0
    return out


def _holding(near: list[tuple[float, float, float]], value: float | None, u95: float | None) -> float | None:
    """U95 that holds the intervals of the rows near rest where these rule the value out."""
    if value is None or u95 is None:
        return u95
    return max([u95, *(abs(v - value) + u for _, v, u in near if abs(v - value) > np.hypot(u, u95))])


def _digits(rows: SweepRows, component: str, length: float, x: Array, variance: Array | None, noise: float) -> Array:
    """Primed standard errors by the last printed digit at settings (n,), the coarsest of several at one; of means where these have a
    variance; zero of all digits.
    """
    every = rows.table.primed_force(component, length, rows.table.digits[component])[rows.rows]
    if not np.any(every):
        return np.zeros(len(x))
    apart = np.abs(rows.x[rows.rows] - x[:, None])
    own = np.asarray(np.where(apart <= apart.min(axis=1, keepdims=True), every, 0.0).max(axis=1))
    return own if variance is None else printed_digits.of_means(own, variance, noise)


def _random(origin: OriginSlope, moved: Array, u95: float | None) -> float | None:
    if u95 is None or origin.design is None:
        return None
    return min(2.0 * origin.noise * float(np.linalg.norm(moved * np.sqrt(origin.design.variance))), u95)


def _by_symmetry(
    rows: SweepRows, variable: str, parity: str, every: _Points
) -> tuple[str, _Points, float, tuple[float, float] | None]:
    """What `_on_one_side` gives, unless the points rule the declared symmetry out; then what it would have given, with its U95.

    They do where that slope and the one with a constant are farther apart than both U95, where its U95 is over twice the other's, as the
    misfit widens what the fewer parameters of a true declaration narrow, or where the curve with a constant leaves zero out at rest and
    no row at rest has brought that into U95 as a bias.
    """
    plane, points, bias = _on_one_side(rows, variable, parity, every)
    if plane and parity == "odd" and len(np.unique(levels(points[0]))) >= FEWEST_SETTINGS:
        declared, free = origin_slope.estimate(*points[:3], odd=True), origin_slope.estimate(*every[:3])
        apart = abs(declared.value - free.value) > np.hypot(declared.u95, free.u95)
        at_rest, half = origin_slope.curve(free, np.zeros(1))
        unseen = not np.any(np.abs(every[0]) <= AT_REST) and abs(at_rest[0]) > half[0]
        if apart or unseen or declared.u95 > WIDER * free.u95:
            return "", every, 0.0, (declared.value, declared.u95)
    return plane, points, bias, None


def _one_size(rows: SweepRows, variable: str, target: str, x: Array, origin: OriginSlope) -> str:
    """Why the settings determine neither slope nor curvature; a force at rest needs no second size."""
    if target == "1" or (origin.design is None and variable not in ANGULAR):
        return ""
    return one_size(x, variable, rows.table.speed[rows.rows])


def _no_symmetry(sweep: Sweep) -> Finding:
    value, u95 = sweep.withdrawn or (float("nan"), float("nan"))
    return Finding.of(
        "symmetry.withdrawn", f"{sweep.campaign} {primed(sweep.symbol)}", Severity.WARN, statistic=value, u95=u95, value=sweep.value,
        own=sweep.u95, table=sweep.table,
    )  # fmt: skip


def _angle_across(table: ForceTable, variable: str) -> str:
    at = held(table, variable)
    return f"{ACROSS[variable][1]} = {np.degrees(at):.4g} deg" if at else ""


def _held(sweeps: Sequence[Sweep]) -> Iterator[Finding]:
    """Which slopes are those at an angle of the other plane, a warning for each."""
    for table, at in dict.fromkeys((s.table, s.held) for s in sweeps if s.held and s.value is not None):
        symbols = [primed(s.symbol) for s in sweeps if (s.table, s.held) == (table, at) and s.value is not None]
        yield Finding.of(ACROSS_AT, table, Severity.WARN, at=at, symbols=symbols)


def _moved(shift: float, table: ForceTable) -> dict[str, str]:
    """Of a table about the point of its sweeps, ``shift`` forward of the point of the coefficients."""
    return {"swept about": point_in_words(table.reference_point, table.datum)} if shift else {}


def _coefficient(sweep: Sweep, citation: str) -> Coefficient:
    """U95 is split: random is what scatter of one reading does through the fixed mixture, the rest is the form."""
    value, u95, random = sweep.value, sweep.u95, sweep.random
    if value is None or u95 is None or random is None:
        status = Status.NOT_DETERMINED if sweep.one_size else Status.TOO_FEW_POINTS
        return Coefficient(
            sweep.symbol, None, None, status, sweep.body, origin="fit", table=sweep.table,
            campaign=sweep.campaign, n_points=len(sweep.x), citation=citation, estimator=sweep.reason,
        )  # fmt: skip
    estimator = {"x": "calibrated slope", "x2": "calibrated slope of the part over x", "1": "calibrated curve at rest"}
    out = ", ".join(sweep.labels[i] for i in sweep.wrong)
    return Coefficient(
        symbol=sweep.symbol,
        value=value,
        u95=u95,
        status=Status.SYMMETRY_ASSUMED if sweep.by_symmetry else Status.SIGN_OPEN if abs(value) <= u95 else Status.OK,
        body=sweep.body,
        parts=Parts(random=random, model_form=float(np.sqrt(u95**2 - random**2))),
        origin="fit",
        table=sweep.table,
        campaign=sweep.campaign,
        estimator=estimator[sweep.target]
        + (f" without point {out}" if out else "")
        + (f", at {sweep.held}" if sweep.held else "")
        + (f", with the rest row of {sweep.borrowed}" if sweep.borrowed else "")
        + (f", not run: {sweep.by_symmetry} turned by symmetry" if sweep.by_symmetry else ""),
        window=sweep.window,
        window_over=sweep.variable if sweep.target == "1" else "",
        n_points=int(sweep.used.sum()),
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


def _readings_of(sweep: Sweep) -> str:
    """The table that was run."""
    return sweep.by_symmetry or sweep.table


def _covariance(sweeps: list[Sweep], coefficients: list[Coefficient]) -> Array:
    """(U95/2)^2 on the diagonal; between coefficients of one table, the correlation of their random parts.

    A row's misfit moves every coefficient by its share in the mixture. The correlation is that of the rows which both
    use, so a cell that only one of them leaves out does not undo it.
    """
    k = len(sweeps)
    out = np.zeros((k, k))
    names = {key: n for n, key in enumerate(dict.fromkeys(key for s in sweeps for key in _row_keys(s)))}
    moved: list[Array | None] = []
    for s in sweeps:
        on_all = None
        if s.value is not None:
            on_all = np.zeros(len(names))
            on_all[[names[key] for key in _row_keys(s)]] = s.by_row * (s.y - s.fitted)
        moved.append(on_all)
    for i in range(k):
        for j in range(i + 1, k):
            a, b, ci, cj = moved[i], moved[j], coefficients[i], coefficients[j]
            same = _readings_of(sweeps[i]) == _readings_of(sweeps[j])
            if a is None or b is None or not same or ci.parts.random is None or cj.parts.random is None:
                continue
            size = float(np.linalg.norm(a) * np.linalg.norm(b))
            if size > 0.0:
                out[i, j] = out[j, i] = float(a @ b) / size * ci.parts.random * cj.parts.random / 4.0
    np.fill_diagonal(out, [np.nan if c.u95 is None else (c.u95 / 2.0) ** 2 for c in coefficients])
    return out


def _jobs(tables: Sequence[ForceTable], length: float) -> dict[str, tuple[SweepRows, str, str, str]]:
    """Which table gives which coefficient: the one whose sweep has the most settings, the first among equals.

    Rows that were run come before those that a symmetry turns into their plane, whatever these would narrow.
    """
    out: dict[str, tuple[SweepRows, str, str, str]] = {}
    most: dict[str, tuple[bool, int]] = {}
    for variable, odd in ODD.items():
        for table in (t for t in tables if variable in t.varies and not held(t, ACROSS.get(variable, ("", ""))[0])):
            rows = sweep_rows(table, variable, tables, length)
            wanted = [(c, f"{c}{variable}", "odd") for c in odd]
            at = held(table, variable)
            for c in EVEN.get(variable, "") if not at else "":
                wanted += [(c, f"{c}0", "even"), (c, f"{c}{variable}{variable}", "even")]
            for component, symbol, parity in wanted:
                if component not in table.forces:
                    continue
                usable = table.usable[component][rows.rows]
                settings = len(np.unique(levels(rows.x[rows.rows][usable])))
                rank = (settings >= FEWEST_SETTINGS and not table.by_symmetry and not at, settings)
                if rank > most.get(symbol, (False, -1)):
                    out[symbol], most[symbol] = (rows, variable, component, parity), rank
    return out


def _without_ruled_out(tables: Sequence[ForceTable], length: float) -> tuple[list[ForceTable], list[Finding]]:
    """The tables without those by symmetry that runs in their plane rule out, and what was compared.

    Of every odd component the runs are held against the curve of the turned rows, all of a table together.
    """
    selected, found = [], []
    for table in tables:
        squares, count, freedom = 0.0, 0, np.inf
        for variable in (v for v in ODD if table.by_symmetry and v in table.varies):
            runs = [t for t in tables if not t.by_symmetry and t.name != table.by_symmetry and variable in t.varies]
            for component in (c for c in ODD[variable] if runs and c in table.forces):
                every = collect_points(
                    sweep_rows(table, variable, tables, length), component, length, np.zeros(len(table))
                )
                plane, points, _ = _on_one_side(sweep_rows(table, variable, tables, length), variable, "odd", every)
                slope = origin_slope.estimate(*points[:3], odd=bool(plane))
                if slope.design is None:
                    continue  # too few settings for a curve: nothing to hold runs against
                for t in (t for t in runs if component in t.forces):
                    at, y = collect_points(sweep_rows(t, variable, (), length), component, length, np.zeros(len(t)))[:2]
                    moving = np.abs(at) > AT_REST
                    more, own = origin_slope.miss_of(slope, at[moving], y[moving])
                    squares, count, freedom = squares + more, count + int(moving.sum()), min(freedom, own)
        share = float(fdtrc(count, freedom, squares / count)) if count else 1.0
        if count:
            found.append(
                Finding.of(
                    "symmetry.planes", table.name, Severity.WARN if share < UNLIKE else Severity.PASS, statistic=share, threshold=UNLIKE,
                    turned=table.by_symmetry, readings=count, judged="apart" if share < UNLIKE else "alike",
                )
            )  # fmt: skip
        if share >= UNLIKE:
            selected.append(table)
    return selected, found


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
    tables, compared = _without_ruled_out([t.about(wanted + np.array([shift, 0.0, 0.0])) for t in tables], length)
    sweeps: list[Sweep] = []
    last: tuple[Sweep, OriginSlope] | None = None
    for symbol, (rows, variable, component, parity) in _jobs(tables, length).items():
        static = f"{component}{INCIDENCE.get(variable, '')}"
        known = [s.value for s in sweeps if s.symbol == static and s.table == rows.table.name]
        slope = known[0] if known and known[0] is not None else 0.0
        last = _sweep(rows, variable, component, symbol, parity, length, chosen, slope, last)
        sweeps.append(last[0])
    first = tables[0]
    coefficients = [_coefficient(s, first.source.citation) for s in sweeps]
    covariance = _covariance(sweeps, coefficients)
    straight, ahead = resistance(tables, length, first.source.citation)
    if ahead is not None and all(c.symbol != ahead.symbol for c in coefficients):
        coefficients.append(ahead)
        own = np.nan if ahead.u95 is None else (ahead.u95 / 2.0) ** 2
        covariance = independent([covariance, np.array([[own]])])
    result = result_of(
        "slope_at_origin", first, scaling, coefficients, covariance, citations=citations, settings=_moved(shift, first),
        sweeps=tuple(sweeps), straight=straight,
        findings=(*(_no_symmetry(s) for s in sweeps if s.withdrawn is not None), *compared, *_held(sweeps)),
    )  # fmt: skip
    return replace(result, coefficients=result.coefficients.about(wanted))

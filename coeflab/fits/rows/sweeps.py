"""Rows of a table in which one motion variable is swept while the others rest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass
from coeflab.fits.results.fit_result import LeftOut, Sweep
from coeflab.fits.statistics.diagnostics import levels
from coeflab.fits.statistics.slopes import is_one_sided
from coeflab.law.symbols import LINEAR
from coeflab.law.transforms import incidence
from coeflab.tables.force_table import AT_REST, SAME_SIZE, ForceTable

INCIDENCE = {"dr": "v", "ds": "w", "db": "w"}
ACROSS_AT = "sweep.held"
ACROSS = {"v": ("w", "alpha"), "w": ("v", "beta")}  # what a sweep of one angle may hold at another than zero
ASTERN = "moves astern (u <= 0): an angle beyond 90 degrees, or degrees declared as radians?"
STALLED = "past stall: the force across the flow falls again"
JUMPED = "beyond a jump of its reading"
SAME_SETTING = 0.02  # a rate's prime changes with the point at which the speed is taken
SAME_POINT = 1e-6  # of the length: rotating runs that do not drift about one point
FEWEST_SETTINGS = 3  # for an intercept, a slope and an error
NEAR_ZERO = np.sin(np.radians(0.3))  # what is left of a setting of zero when a model is aligned


@dataclass(frozen=True, slots=True, eq=False)
class SweepRows:
    """Rows of one sweep, with rest rows of the same campaign where a one-sided sweep has none of its own.

    ``astern`` rows do not run ahead: sin(beta) is the same at 10 and at 170 degrees, the force is not.
    """

    table: ForceTable
    x: Array
    rows: NDArray[np.intp]
    rest: tuple[ForceTable, NDArray[np.intp]] | None
    astern: NDArray[np.intp]


def held(table: ForceTable, variable: str) -> float:
    """Angle, rad, at which every row of a sweep of ``variable`` holds the other one, drift or attack; zero where it holds none."""
    if variable not in ACROSS or not len(table):
        return 0.0
    other = incidence(*(np.asarray(table.motion[m]) for m in LINEAR))[("alpha", "beta").index(ACROSS[variable][1])]
    several = _settings(table.primed_motion(variable, table.scaling.length)) >= FEWEST_SETTINGS
    still = float(np.ptp(other)) <= AT_REST < float(np.min(np.abs(other)))
    return float(np.mean(other)) if several and still else 0.0


def _others_at_rest(table: ForceTable, variable: str, length: float) -> NDArray[np.bool_]:
    """Rows in which nothing but surge and ``variable`` moves, or what they hold (control sweeps: within 0.3 degrees of zero incidence)."""
    keep = np.ones(len(table), dtype=bool)
    holds = ACROSS[variable][0] if held(table, variable) else ""
    for name in ("v", "w", "p", "q", "r", *table.controls):
        if name not in (variable, holds):
            limit = NEAR_ZERO if INCIDENCE.get(variable) == name else AT_REST
            keep &= np.abs(table.primed_motion(name, length)) <= limit
    return keep


def sweep_rows(table: ForceTable, variable: str, tables: Sequence[ForceTable], length: float) -> SweepRows:
    """The rows of ``table`` that sweep a variable.

    A one-sided sweep without a row at rest borrows those of the first other table at the same speed.
    """
    keep = _others_at_rest(table, variable, length)
    ahead = table.motion["u"] > 0.0
    astern = np.flatnonzero(keep & ~ahead)
    keep &= ahead
    x = table.primed_motion(variable, length)
    rest = None
    if is_one_sided(x[keep]) and not held(table, variable) and not np.any(keep & (np.abs(x) <= AT_REST)):
        for other in tables:
            still = _others_at_rest(other, "", length)
            if other is not table and np.any(still) and np.allclose(other.speed[still], table.speed.mean(), rtol=0.01):
                rest = (other, np.flatnonzero(still))
                break
    return SweepRows(table, x, np.flatnonzero(keep), rest, astern)


def collect_points(
    rows: SweepRows, component: str, length: float, taken_out: Array
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
    if len(rows.astern):
        away = table.primed_force(component, length)
        left += [LeftOut(float(rows.x[i]), float(away[i]), table.labels[i], ASTERN) for i in rows.astern]
    for source, index, at in parts:
        force = source.primed_force(component, length) - (taken_out if source is table else 0.0)
        error = source.primed_force(component, length, source.errors[component]) if component in source.errors else None
        for i, xi in zip(index, at, strict=True):
            if source.usable[component][i]:
                x.append(xi)
                y.append(force[i])
                se.append(np.nan if error is None else error[i])
                labels.append(source.labels[i] if source is table else f"{source.name} {source.labels[i]}")
            elif source is table:
                why = reasons.get((int(i), component)) or reasons.get((int(i), ""), "excluded")
                left.append(LeftOut(float(xi), float(force[i]), source.labels[i], why))
    errors = np.array(se)
    known = errors if len(errors) and np.all(np.isfinite(errors)) else None
    return np.array(x), np.array(y), known, tuple(labels), tuple(left)


def not_belonging(table: ForceTable, component: str, sweeps: Sequence[Sweep], length: float) -> NDArray[np.bool_]:
    """Rows of a table whose force a sweep over it left out, past stall or because it does not fit the others, shape (n,)."""
    out = np.zeros(len(table), dtype=bool)
    labels = np.array(table.labels, dtype=object)
    for s in (s for s in sweeps if (s.table, s.component) == (table.name, component)):
        x = table.primed_motion(s.variable, length)
        of_sweep = np.array(s.labels, dtype=object)
        for i in map(int, s.wrong):
            here = np.flatnonzero((labels == s.labels[i]) & np.isclose(x, s.x[i], rtol=SAME_SETTING))
            there = np.flatnonzero((of_sweep == s.labels[i]) & np.isclose(s.x, s.x[i], rtol=SAME_SETTING))
            out[here[there == i] if len(here) == len(there) else here] = True
        stalled = [p.x for p in s.left_out if p.reason == STALLED]
        out |= np.isclose(x[:, None], np.array(stalled)[None, :], rtol=SAME_SETTING).any(axis=1)
    return out


def one_size(x: Array, variable: str, speed: Array) -> str:
    """Why settings (n,) of one size determine no slope, in words; empty where they have several.

    Readings at -a, 0 and a give the odd part of the force at a: one number for x and x|x| together. On a rotating arm the
    radius alone makes |r'| = L/R; the speed, shape (n,), does not.
    """
    sizes = np.abs(x[np.abs(x) > AT_REST])
    if not len(sizes) or float(np.ptp(sizes)) > SAME_SIZE * float(sizes.max()):
        return ""
    size = float(np.median(sizes))
    faster = float(np.ptp(speed)) > SAME_SIZE * float(speed.max())
    details = [f"speeds {speed.min():.3g} to {speed.max():.3g} m/s"] if faster else []
    details += ["both signs"] if np.any(x > AT_REST) and np.any(x < -AT_REST) else []
    seen = f" ({', '.join(details)})" if details else ""
    name, how = f"{variable}'", " (L/R: other radii, not speeds)" if variable in "qr" else ""
    return f"one |{name}|, {size:.3g}{seen}: {name} and {name}|{name}| cannot be separated; measure |{name}| near {size / 3.0:.2g} and {2.0 * size / 3.0:.2g}{how}"


def arm_shift(tables: Sequence[ForceTable]) -> float:
    """How far forward the point lies at which rotating runs have no cross flow; 0 if there is no such point.

    About any other point an arm's runs have v = r dx (w = -q dx), and no row turns without drifting. Of runs that combine drift with
    rotation it is the point about which most rates are run without drift, if they are enough for a slope.
    """
    places, rates, drifts = list[Array](), list[Array](), list[Array]()
    for table in tables:
        for rate, drift, sign in (("r", "v", -1.0), ("q", "w", 1.0)):
            turning = table.motion[rate] != 0.0
            places.append(sign * table.motion[drift][turning] / table.motion[rate][turning])
            rates.append(table.primed_motion(rate, 1.0)[turning])
            drifts.append(table.primed_motion(drift, 1.0)[turning])
    shifts, over = np.concatenate(places), np.concatenate(rates)
    away = np.abs(np.concatenate(drifts)) > AT_REST
    if not np.any(away):
        return 0.0
    order = np.flatnonzero(away)[np.argsort(shifts[away], kind="stable")]
    apart = SAME_POINT * float(tables[0].scaling.length)
    about = np.split(order, np.flatnonzero(np.diff(shifts[order]) > apart) + 1)
    # Slow rates of an arm drift little enough to count as pure; their place says that they turn about its point.
    about = [np.flatnonzero((shifts >= shifts[b[0]] - apart) & (shifts <= shifts[b[-1]] + apart)) for b in about]
    if len(about) == 1 and len(about[0]) == len(shifts):
        return float(np.median(shifts))
    best = max(about, key=lambda rows: (_settings(over[rows]), -abs(float(np.median(shifts[rows])))))
    pure = ~away
    pure[best] = False
    enough = max(FEWEST_SETTINGS - 1, _settings(over[pure]))
    return float(np.median(shifts[best])) if _settings(over[best]) > enough else 0.0


def _settings(x: Array) -> int:
    """How many settings differ in size or sign."""
    return len(np.unique(np.sign(x) * (levels(x) + 1)))

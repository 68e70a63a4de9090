"""Quality of force tables: which settings they hold, how far readings are converged, mirrored, repeated and free of tares."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from coeflab.core.finding import Severity
from coeflab.core.table import ABSENT, Check, Table, coefficient, number, with_u95
from coeflab.core.wording import collected
from coeflab.fits.statistics.diagnostics import replicate_groups
from coeflab.law.symbols import LINEAR, MOTIONS, PORT_STARBOARD
from coeflab.report.texts import table_of
from coeflab.tables.force_table import AT_REST, ForceTable

if TYPE_CHECKING:
    from coeflab.core.types import Array
    from coeflab.fits.results.fit_result import FitResult

SAME_SETTING = 1e-6
MIRRORED = 0.006  # rad or primed, 0.34 degrees: as far as a set angle is from its mirror image
MOST_LABELS = 12


def settings_of(table: ForceTable) -> dict[str, Array]:
    """What changes in a table as people set it: v' and w' as angles in degrees, control angles too, rates primed."""
    out = {}
    for name in table.varies:
        primes = table.primed_motion(name, table.scaling.length)
        if name in table.controls:
            out[f"{name} [deg]"] = np.degrees(primes)
        elif name in LINEAR:
            out[f"asin({name}') [deg]"] = np.degrees(np.arcsin(np.clip(primes, -1.0, 1.0)))
        else:
            out[f"{name}'"] = primes
    if np.ptp(table.speed) > SAME_SETTING * table.speed.max():
        out["U [m/s]"] = np.asarray(table.speed)
    return out


def coverage(tables: Sequence[ForceTable]) -> Table:
    """Settings by table and variable: how many, how far, on which side, and the largest gap."""
    rows = []
    for t in tables:
        for name, x in settings_of(t).items():
            levels = np.unique(np.round(x, 6))
            side = "both" if levels[0] < 0.0 < levels[-1] else "one"
            gap = np.max(np.diff(levels), initial=0.0)
            moved = int(np.count_nonzero(np.abs(x) > SAME_SETTING))
            ends = (number(float(levels[0]), 4), number(float(levels[-1]), 4), number(float(gap), 3))
            rows.append((t.name, name, str(len(levels)), str(moved), *ends, ABSENT if name.startswith("U") else side))
    return table_of("data_quality.coverage", rows)


def convergence(tables: Sequence[ForceTable]) -> Table:
    """Standard errors that the tables state (iterations, samples): typical and worst, and where."""
    rows = []
    for t in tables:
        length = t.scaling.length
        for component, errors in t.errors.items():
            selected = np.flatnonzero(t.usable[component] & np.isfinite(errors))
            if not len(selected):
                continue
            se = t.primed_force(component, length, errors)[selected]
            largest = float(np.nanmax(np.abs(t.primed_force(component, length)[selected])))
            worst = int(np.argmax(se))
            shares = (f"{100.0 * v / largest:.2g} %" if largest else ABSENT for v in (np.median(se), se[worst]))
            rows.append((t.name, f"{component}'", str(len(selected)), *shares, t.labels[selected[worst]]))
    note = "Standard errors as the tables state them, over the largest force; they hold no grid or model error."
    return table_of("data_quality.convergence", rows, (note,))


def mirror_pairs(table: ForceTable) -> NDArray[np.intp]:
    """(n, 2) rows that are each other's image in the plane of symmetry."""
    length = table.scaling.length
    primes = {m: table.primed_motion(m, length) for m in (*MOTIONS, *table.controls)}
    across = [m for m in primes if m in PORT_STARBOARD]
    if not any(np.any(np.abs(primes[m]) > AT_REST) for m in across):
        return np.empty((0, 2), dtype=np.intp)
    here = np.column_stack([*primes.values(), np.log(table.speed)])
    sign = np.array([-1.0 if m in PORT_STARBOARD else 1.0 for m in primes] + [1.0])
    far, other = cKDTree(here).query(here * sign, p=np.inf, distance_upper_bound=MIRRORED)
    moved = np.any([np.abs(primes[m]) > MIRRORED for m in across], axis=0)
    own = np.arange(len(table))
    selected = np.isfinite(far) & moved
    selected[selected] &= (own < other)[selected]
    pairs: NDArray[np.intp] = np.column_stack([own, other])[selected]
    return pairs


def symmetry(tables: Sequence[ForceTable]) -> Table:
    """How far mirrored rows are from mirrored forces, by table and force."""
    rows = []
    for t in tables:
        pairs = mirror_pairs(t)
        for component, usable in t.usable.items():
            both = pairs[np.all(usable[pairs], axis=1)] if len(pairs) else pairs
            if not len(both):
                continue
            y = t.primed_force(component, t.scaling.length)
            sign = -1.0 if component in PORT_STARBOARD else 1.0
            apart = y[both[:, 0]] - sign * y[both[:, 1]]
            largest = float(np.nanmax(np.abs(y[usable])))
            worst = int(np.argmax(np.abs(apart)))
            size = float(np.sqrt(np.mean(apart**2)))
            shares = (f"{100.0 * v / largest:.2g} %" if largest else ABSENT for v in (size, abs(apart[worst])))
            where = " and ".join(t.labels[i] for i in both[worst])
            rows.append((t.name, f"{component}'", str(len(both)), *shares, where))
    note = "Of the largest force. Rows are a pair within 0.34 deg; both parts of a setting error are in the difference."
    return table_of("data_quality.symmetry", rows, (note,))


def at_rest(fits: Sequence[FitResult]) -> Table:
    """Forces at no angle of the odd sweeps, from the recommended curves, as force and as angle."""
    rows = []
    for s in (s for fit in fits for s in fit.sweeps if s.target == "x" and s.value is not None):
        value, half = s.at_rest
        angle = ABSENT if not s.value or not s.is_angle else f"{np.degrees(value / s.value):+.2f}"
        largest = float(np.max(np.abs(s.y)))
        measured = [y for x, y in zip(s.x, s.y, strict=True) if abs(x) <= SAME_SETTING]
        at_zero = ABSENT if not measured else coefficient(float(np.mean(measured)))
        share = f"{100.0 * abs(value) / largest:.1f} %" if largest > 0.0 else ABSENT
        rows.append((s.campaign, f"{s.component}'", s.variable + "'", *with_u95(value, half), at_zero, share, angle))
    note = "of the curve: the recommended curve at no angle; of largest: its size over the largest force of the sweep."
    return table_of("data_quality.at_rest", rows, (note,))


def tares(tables: Sequence[ForceTable]) -> Table:
    """Readings with the body at rest but for its speed ahead: the first, the last, and how far they are apart."""
    rows = []
    for t in tables:
        length = t.scaling.length
        moving = [np.abs(t.primed_motion(m, length)) > AT_REST for m in (*MOTIONS[1:], *t.controls)]
        still = ~np.any(moving, axis=0)
        for component, usable in t.usable.items():
            selected = np.flatnonzero(still & usable)
            if len(selected) < 2 or component == "X":
                continue
            y = t.primed_force(component, length)
            largest = float(np.nanmax(np.abs(y[usable])))
            spread = f"{100.0 * float(np.ptp(y[selected])) / largest:.2g} %" if largest else ABSENT
            ends = (coefficient(float(y[selected[i]])) for i in (0, -1))
            rows.append((t.name, f"{component}'", str(len(selected)), *ends, spread))
    return table_of("data_quality.tares", rows)


def repeats(tables: Sequence[ForceTable]) -> Table:
    """Pooled standard deviation of repeated settings, per table and force."""
    rows = []
    for t in tables:
        names = [*t.varies] or ["v"]
        length = t.scaling.length
        settings = np.column_stack([t.primed_motion(v, length) for v in names] + [t.speed / float(np.max(t.speed))])
        for component, usable in t.usable.items():
            selected = np.flatnonzero(usable & np.isfinite(t.forces[component]))
            groups = _groups(settings[selected])
            if not groups:
                continue
            y = t.primed_force(component, length)[selected]
            freedom = sum(len(g) - 1 for g in groups)
            pooled = np.sqrt(sum(float(np.sum((y[g] - y[g].mean()) ** 2)) for g in groups) / freedom)
            largest = float(np.max(np.abs(y)))
            share = f"{100.0 * pooled / largest:.2g} %" if largest else ABSENT
            rows.append((t.name, f"{component}'", str(len(groups)), str(freedom), number(float(pooled), 3), share))
    return table_of("data_quality.repeats", rows)


def _groups(settings: Array) -> list[NDArray[np.intp]]:
    """Rows of equal settings, of two and more."""
    if not len(settings):
        return []
    _, key = np.unique(np.round(settings / SAME_SETTING), axis=0, return_inverse=True)
    return replicate_groups(np.asarray(key, dtype=float).ravel(), 0.5)


def outliers(found: Sequence[Check]) -> Table:
    """Readings that do not belong to their sweep, as the data gate names them."""
    rows = [(c.subject, c.statistic) for c in found if c.name == "data_gate" and c.severity is Severity.WARN]
    return table_of("data_quality.outliers", rows)


def counts(tables: Sequence[ForceTable]) -> Table:
    """Rows, cells, and what is not used of them."""
    rows = []
    for t in tables:
        cells = sum(mask.size for mask in t.usable.values())
        used = sum(int(mask.sum()) for mask in t.usable.values())
        whole = sum(not e.component for e in t.exclusions)
        doubtful = sum(e.uncertain for e in t.exclusions)
        rejected = len(t.exclusions) - whole - sum(e.uncertain and bool(e.component) for e in t.exclusions)
        rows.append((t.name, *map(str, (len(t), cells, used, rejected, doubtful, whole))))
    return table_of("data_quality.counts", rows)


def not_used(tables: Sequence[ForceTable]) -> Table:
    """Cells and rows that are not used, gathered by table and reason."""
    places = collected(
        ((t.name, "doubtful" if e.uncertain else "rejected", e.reason), (e.component or "whole row", t.labels[e.row]))
        for t in tables
        for e in t.exclusions
    )
    rows = (
        (*key, "; ".join(f"{force}: {_some(labels)}" for force, labels in collected(what).items()))
        for key, what in places.items()
    )
    return table_of("data_quality.not_used", rows)


def _some(labels: list[str]) -> str:
    if len(labels) <= 4 * MOST_LABELS:
        return ", ".join(labels)
    return f"{', '.join(labels[:MOST_LABELS])} and {len(labels) - MOST_LABELS} more"


def of_tables(tables: Sequence[ForceTable]) -> Iterator[Table]:
    """What the tables alone say, those that have rows."""
    for result in (coverage, convergence, symmetry, repeats, tares):
        table = result(tables)
        if table.rows:
            yield table

"""The law of a parameter file against the measured points that it was fitted to, and the range in which it holds.

The points travel in the file (since version 1.4), so that every reader, and the force law of every simulator, can be compared
with them. A law may miss a point by three times the scatter of repeated runs plus 5 % of the largest force of that component
in that table.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from coeflab.core.stored import Finite, Means, Name, NotNegative
from coeflab.core.types import Array
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.rows.sweeps import NEAR_ZERO, not_belonging
from coeflab.fits.statistics.diagnostics import (
    NARROWEST,
    about_a_curve,
    allowed_miss,
    certain_miss,
    pairs_of_replicates,
    scatter_of_replicates,
)
from coeflab.fits.tied_law import DRIFTS
from coeflab.law.named_terms import read_term
from coeflab.law.symbols import COMPONENTS, CONTROLS, FORCES, LINEAR, MOTIONS
from coeflab.tables.force_table import AT_REST, ForceTable
from coeflab.vehicle.parameter_parts import Strict

SMALL = 0.01  # of the largest force or moment of the table: below it nothing is judged
NEAR = 1e-9
ANGLES = {"v": "asin(v/U)", "w": "asin(w/U)"}
Moved = Literal["u", "v", "w", "p", "q", "r", "dr", "ds", "db"]
Component = Literal["X", "Y", "Z", "K", "M", "N"]
Force = Callable[[Array, Array], Array]  # velocities (n, 6), controls (n, 3) -> forces (n, 6), SI


class MeasuredMotion(Strict):
    """One velocity, rate or control of every row."""

    name: Annotated[Moved, Means("u v w p q r dr ds db")]
    values: Annotated[tuple[Finite, ...], Means("about the file's reference point", "m/s, rad/s, rad")]


class MeasuredForce(Strict):
    """One measured force component of every row."""

    component: Annotated[Component, Means("X Y Z K M N")]
    values: Annotated[
        tuple[Finite | None, ...], Means("at the density of `conditions`; null where no fit used the row", "N or N m")
    ]
    at_rest: Annotated[
        tuple[Finite, ...],
        Means(
            "force of the set-up, by row: at no angle and no rate; X odd in drift. No part of the law, taken off the values",
            "N or N m",
        ),
    ]
    scatter: Annotated[NotNegative | None, Means("of repeated runs about the law; null where none repeats", "N or N m")]
    small: Annotated[bool, Means("below 1 % of the largest force or moment of its table: not judged")] = False


class MeasuredTable(Strict):
    """The points of one table that the coefficients were fitted to."""

    table: Annotated[str, Means("file of the table")]
    campaign: Annotated[str, Means("campaign of the table")]
    labels: Annotated[tuple[str, ...], Means("run or point number of every row")]
    motion: Annotated[tuple[MeasuredMotion, ...], Means("what moves; all else is zero")]
    forces: Annotated[tuple[MeasuredForce, ...], Means("what was measured and fitted")]

    @model_validator(mode="after")
    def _as_long(self) -> MeasuredTable:
        n = len(self.labels)
        columns = [
            *(m.values for m in self.motion),
            *(f.values for f in self.forces),
            *(f.at_rest for f in self.forces),
        ]
        if any(len(c) != n for c in columns):
            raise ValueError(f"{self.table}: columns that are not as long as the {n} labels")
        return self

    @property
    def states(self) -> tuple[Array, Array]:
        """Velocities (n, 6) and controls (n, 3), SI."""
        rows = np.zeros((len(self.labels), 9))
        for m in self.motion:
            rows[:, (*MOTIONS, *CONTROLS).index(m.name)] = m.values
        return rows[:, :6], rows[:, 6:]

    def primes(self, length: float) -> Mapping[str, Array]:
        """v/U, r L/U and controls of every row."""
        nu, controls = self.states
        speed = np.linalg.norm(nu[:, :3], axis=1)
        speed = np.where(speed > 0.0, speed, 1.0)
        out = {v: nu[:, i] / speed * (1.0 if v in LINEAR else length) for i, v in enumerate(MOTIONS) if i}
        return out | {c: controls[:, i] for i, c in enumerate(CONTROLS)}


class HeldRange(Strict):
    """Range of a motion variable in which the law of one component meets its points."""

    component: Annotated[Component, Means("X Y Z K M N")]
    variable: Annotated[Name, Means("as in `covered`")]
    low: Annotated[Finite, Means("lowest value", "see unit")]
    high: Annotated[Finite, Means("highest value", "see unit")]
    unit: Annotated[Literal["rad", "1"], Means("of low and high")]
    campaign: Annotated[str, Means("which campaign's points")]


class LawAtPoints(Strict):
    """How far the law of one component is from the points of one table."""

    component: Annotated[Component, Means("X Y Z K M N")]
    table: Annotated[str, Means("file of the table")]
    n_points: Annotated[int, Field(ge=0), Means("points of the table that a fit used")]
    largest: Annotated[NotNegative, Means("largest measured force", "N or N m")]
    allowed: Annotated[NotNegative, Means("3 scatter + 5 % of the largest", "N or N m")]
    worst: Annotated[NotNegative, Means("largest miss where the law is said to hold", "N or N m")]
    worst_at: Annotated[str, Means("point of the largest miss, and its motion")]
    rms: Annotated[NotNegative, Means("root mean square miss where the law is said to hold", "N or N m")]
    missed: Annotated[tuple[str, ...], Means("points missed by more than allowed where the law is said to hold")] = ()
    beyond: Annotated[tuple[str, ...], Means("points outside of where the law is said to hold")] = ()
    worst_beyond: Annotated[NotNegative, Means("largest miss of those", "N or N m")] = 0.0
    small: Annotated[bool, Means("not judged: below 1 % of the largest force or moment of the table")] = False

    @property
    def share(self) -> float:
        """Worst over largest."""
        return self.worst / self.largest if self.largest else 0.0

    @property
    def rms_share(self) -> float:
        """Root mean square over largest."""
        return self.rms / self.largest if self.largest else 0.0


def measured_tables(
    tables: Sequence[ForceTable],
    fits: Sequence[FitResult],
    spoken: Mapping[tuple[str, str], frozenset[str]],
    crossed: Mapping[str, tuple[frozenset[str], ...]],
    constants: frozenset[str],
    length: float,
    density: float,
) -> tuple[MeasuredTable, ...]:
    """The points behind a law, with the forces at rest of the set-up. Scatter is left to `with_scatter`.

    Parameters
    ----------
    tables : sequence of ForceTable
        About the file's reference point.
    fits : sequence of FitResult
    spoken : mapping of (component, table) to variables
        Motions that a coefficient fitted to that table speaks of.
    crossed : mapping of component to sets of variables
        Motions that one term combines; rows that combine others count where a fit took them in, see `coeflab.fits.tied_law`.
    constants : frozenset of str
        Components whose force at rest is part of the law.
    length, density : float
        Of the file, m and kg/m^3.
    """
    out = []
    for t in tables:
        names = [m for m in (*MOTIONS[1:], *CONTROLS) if m in MOTIONS or m in t.controls]
        moving = np.array([np.abs(t.primed_motion(m, length)) > AT_REST for m in names])
        forces = []
        scale = density / t.water_density
        tied = any(f.tied is not None and f.campaign == t.campaign for f in fits)
        sweeps = [s for f in fits for s in f.sweeps if s.campaign == t.campaign]
        others = [f for f in fits if t.campaign in f.campaigns and not (f.sweeps or f.tied)]
        elsewhere = {k.symbol[0] for f in others for k in f.coefficients.coefficients if k.value is not None}
        for c in COMPONENTS:
            variables = spoken.get((c, t.name))
            if variables is None or c not in t.forces or (not variables and np.any(moving)):
                continue  # rows at rest alone, of a table that moves: `coeflab.vehicle.not_in_law` has the others
            if tied:  # about another point than that of its runs a rate drifts
                known = frozenset[str]().union(*(own for (other, _), own in spoken.items() if other == c))
                variables |= {DRIFTS[m] for m in variables & DRIFTS.keys()} & known
            strange = np.any(moving[[m not in variables for m in names]], axis=0)
            combined = _combined(t, names, length) & (not tied)
            for row in np.flatnonzero(combined):
                moved = {m for m, on in zip(names, moving[:, row], strict=True) if on}
                combined[row] = not any(moved <= together for together in crossed.get(c, ()))
            usable = t.usable[c] & (t.motion["u"] > 0.0) & ~strange & ~combined
            if c not in elsewhere:
                usable &= ~not_belonging(t, c, sweeps, length)
            if np.any(usable):
                still = usable & ~np.any(moving, axis=0)
                rest = _of_set_up(t, c, fits, still, length, in_law=c in constants)
                forces.append((c, usable, np.asarray(t.forces[c]) * scale, rest * scale))
        if not forces:
            continue
        keep = np.logical_or.reduce([usable for _, usable, _, _ in forces])
        columns = {**t.motion, **t.controls}
        out.append(
            MeasuredTable(
                table=t.name,
                campaign=t.campaign,
                labels=tuple(np.array(t.labels, dtype=object)[keep].tolist()),
                motion=tuple(
                    MeasuredMotion.model_validate({"name": m, "values": tuple(map(float, columns[m][keep]))})
                    for m in (*MOTIONS, *CONTROLS)
                    if m in columns and np.any(columns[m][keep])
                ),
                forces=tuple(
                    MeasuredForce.model_validate(
                        {
                            "component": c,
                            "values": tuple(
                                float(v) if u else None for v, u in zip(f[keep], usable[keep], strict=True)
                            ),
                            "at_rest": tuple(map(float, rest[keep])),
                            "scatter": None,
                            "small": _is_small(t, c, usable, length),
                        }
                    )
                    for c, usable, f, rest in forces
                ),
            )
        )
    return tuple(out)


def _combined(t: ForceTable, names: Sequence[str], length: float) -> NDArray[np.bool_]:
    """Rows in which two motions move at once, incidence by more than an alignment leaves."""
    limits = [NEAR_ZERO if m in LINEAR else AT_REST for m in names]
    moved = [np.abs(t.primed_motion(m, length)) > limit for m, limit in zip(names, limits, strict=True)]
    return np.asarray(np.sum(moved, axis=0) > 1)


def _of_set_up(
    t: ForceTable, component: str, fits: Sequence[FitResult], still: NDArray[np.bool_], length: float, *, in_law: bool
) -> Array:
    """Force of a set-up, by row, at the table's density: what a fit took off, else the mean of the rows at rest, else zero.

    ``in_law``: the force at rest is the law's, and not the set-up's.
    """
    unit = 1.0 / t.primed_force(component, length, np.ones(len(t)))
    motion = {m: t.primed_motion(m, length) for m in (*MOTIONS[1:], *t.controls)}
    found = [
        v * read_term(term, t.name).term.evaluate(motion)
        for f in fits
        if f.tied
        for name, term, v in f.tied.set_up
        if name == t.name and term[0] == component
    ]
    if found or in_law:
        return np.asarray(unit * np.sum([np.zeros(len(t)), *found], axis=0))
    pooled = [
        s.intercept
        for f in fits
        for p in f.poolings
        if p.response == component
        for s in p.shares
        if s.campaign == t.campaign and s.intercept is not None
    ]
    if pooled:
        return np.asarray(unit * pooled[0])
    primes = t.primed_force(component, length)[still]
    return np.asarray(unit * (float(primes.mean()) if len(primes) else 0.0))


def _is_small(t: ForceTable, component: str, usable: NDArray[np.bool_], length: float) -> bool:
    """Whether a component is next to nothing beside its like."""

    def largest(c: str, rows: NDArray[np.bool_]) -> float:
        return float(np.max(np.abs(t.primed_force(c, length)[rows]), initial=0.0))

    like = [c for c in t.forces if (c in FORCES) == (component in FORCES)]
    return largest(component, usable) < SMALL * max(largest(c, np.asarray(t.usable[c])) for c in like)


def _misses(f: MeasuredForce, force: Array) -> Array:
    """Measured less rest less law, NaN where no fit used the row."""
    values = np.array([np.nan if v is None else v for v in f.values])
    return np.asarray(values - np.array(f.at_rest) - force[:, COMPONENTS.index(f.component)])


def _largest(f: MeasuredForce) -> float:
    return max((abs(v) for v in f.values if v is not None), default=0.0)


def with_scatter(measured: Sequence[MeasuredTable], force: Force, length: float) -> tuple[MeasuredTable, ...]:
    """The tables with the scatter of repeated runs about a law."""
    out = []
    for m in measured:
        by = force(*m.states)
        shares, forces = _shares(m, length), []
        for f in m.forces:
            missed = _misses(f, by)
            rows = np.isfinite(missed)
            forces.append(f.model_copy(update={"scatter": scatter_of_replicates(shares[rows], missed[rows])}))
        out.append(m.model_copy(update={"forces": tuple(forces)}))
    return tuple(out)


def _shares(m: MeasuredTable, length: float) -> Array:
    """Motions of every row as shares of the largest."""
    return np.column_stack([x / max(float(np.abs(x).max()), AT_REST) for x in m.primes(length).values()])


def missed_for_certain(measured: Sequence[MeasuredTable], found: LawAtPoints, length: float) -> bool:
    """Whether the noise of its table leaves its worst miss impossible: that of repeated runs, or of readings about curves of their own."""
    m, f = next((m, f) for m in measured for f in m.forces if (m.table, f.component) == (found.table, found.component))
    there = np.array([v is not None for v in f.values])
    shares = _shares(m, length)[there]
    readings = np.array([v for v in f.values if v is not None]) - np.array(f.at_rest)[there]
    moving = np.abs(shares) > AT_REST
    squares, freedom = 0.0, 0
    for x, own in zip(shares.T, moving.T, strict=True):
        alone = (moving.sum(1) == own) if own.any() else own
        more, degrees = about_a_curve(x[alone], readings[alone])
        squares, freedom = squares + more, freedom + degrees
    return found.worst > certain_miss(f.scatter, pairs_of_replicates(shares), squares, freedom, found.largest)


def _dominant(primes: Mapping[str, Array]) -> list[str]:
    """The motion of every row that goes furthest in its own range; empty at rest."""
    sizes = np.array([np.abs(x) for x in primes.values()])
    shares = sizes / np.maximum(sizes.max(axis=1, keepdims=True), AT_REST)
    furthest = np.where(sizes > AT_REST, shares, -1.0)
    names = list(primes)
    return [names[i] if far else "" for i, far in zip(furthest.argmax(0), furthest.max(0) >= 0.0, strict=True)]


def caps(
    measured: Sequence[MeasuredTable], force: Force, length: float, higher: Mapping[str, frozenset[str]]
) -> Mapping[tuple[str, str], float]:
    """How far from rest a component's law meets its points, by (component, variable), where that is less than they go.

    Where a law with terms beyond its slopes misses a point within half of the range, no smaller range is named: the law is
    wrong, not short. Slopes alone, and the even law of X, may hold in any part.

    Parameters
    ----------
    measured : sequence of MeasuredTable
        With scatter.
    force : callable
        Of the file's law.
    length : float
    higher : mapping of component to variables
        In which the law has terms beyond slopes and curvatures.
    """
    reach: dict[tuple[str, str], float] = {}
    cap: dict[tuple[str, str], float] = {}
    for m in measured:
        primes, by = m.primes(length), force(*m.states)
        dominant = _dominant(primes)
        for f in m.forces:
            missed = np.abs(_misses(f, by))
            allowed = allowed_miss(f.scatter, _largest(f))
            for row in map(int, np.flatnonzero(np.isfinite(missed))):
                v = dominant[row]
                if not v:
                    continue
                at = float(abs(primes[v][row]))
                reach[f.component, v] = max(at, reach.get((f.component, v), 0.0))
                if missed[row] > allowed and not f.small:
                    cap[f.component, v] = min(at, cap.get((f.component, v), np.inf))
    out = {}
    for (c, v), first in cap.items():
        sizes = [
            abs(float(x))
            for m in measured
            for f in m.forces
            if f.component == c
            for x, used in zip(m.primes(length)[v], f.values, strict=True)
            if used is not None and abs(x) < first * (1.0 - NEAR)
        ]
        inner = max(sizes, default=0.0)
        if inner > AT_REST and (inner >= NARROWEST * reach[c, v] or c == "X" or v not in higher.get(c, frozenset())):
            out[c, v] = inner
    return out


def law_at_points(
    measured: Sequence[MeasuredTable], held: Sequence[HeldRange], force: Force, length: float, *, controls: bool = True
) -> tuple[LawAtPoints, ...]:
    """How far a law is from the points, by component and table.

    Parameters
    ----------
    measured : sequence of MeasuredTable
    held : sequence of HeldRange
        Where the law is said to hold.
    force : callable
    length : float
    controls : bool
        Whether rows with a control off zero count; many targets take none.
    """
    out = []
    for m in measured:
        (nu, angles), primes = m.states, m.primes(length)
        by = force(nu, angles)
        for f in m.forces:
            missed = _misses(f, by)
            if not controls:
                missed[np.any(np.abs(angles) > AT_REST, axis=1)] = np.nan
            rows = np.flatnonzero(np.isfinite(missed))
            if not len(rows):
                continue
            within = _within(m, f.component, held, primes)
            inner, outer = rows[within[rows]], rows[~within[rows]]
            size = np.abs(missed)
            allowed = allowed_miss(f.scatter, _largest(f))
            worst = int(inner[size[inner].argmax()]) if len(inner) else -1
            out.append(
                LawAtPoints(
                    component=f.component,
                    table=m.table,
                    n_points=len(rows),
                    largest=_largest(f),
                    allowed=allowed,
                    worst=float(size[worst]) if len(inner) else 0.0,
                    worst_at=_place(m, primes, worst) if len(inner) else "",
                    rms=float(np.sqrt(np.mean(missed[inner] ** 2))) if len(inner) else 0.0,
                    missed=tuple(m.labels[i] for i in inner if size[i] > allowed),
                    beyond=tuple(m.labels[i] for i in outer),
                    worst_beyond=float(size[outer].max()) if len(outer) else 0.0,
                    small=f.small,
                )
            )
    return tuple(out)


def motion_of(variable: str) -> str:
    """``v`` for asin(v/U), ``r`` for r', a control as it is."""
    return variable.removeprefix("asin(").split("/")[0].removesuffix("'")


def _within(
    m: MeasuredTable, component: str, held: Sequence[HeldRange], primes: Mapping[str, Array]
) -> NDArray[np.bool_]:
    """Rows inside every held range to rounding, since the row that ended one may be a hundredth of a degree beyond it; rows at rest."""
    out = np.ones(len(m.labels), dtype=bool)
    for h in held:
        v = motion_of(h.variable)
        if (h.component, h.campaign) == (component, m.campaign) and v in primes:
            low, high = (np.sin(h.low), np.sin(h.high)) if h.variable.startswith("asin(") else (h.low, h.high)
            inside = (primes[v] >= low - NEAR) & (primes[v] <= high + NEAR)
            has_rest = low <= AT_REST and high >= -AT_REST
            out &= inside | (has_rest & (np.abs(primes[v]) <= AT_REST))
    return out


def _place(m: MeasuredTable, primes: Mapping[str, Array], row: int) -> str:
    words = []
    for v, x in primes.items():
        if abs(x[row]) > AT_REST:
            angle = v in LINEAR or v in CONTROLS
            value = np.degrees(np.arcsin(np.clip(x[row], -1.0, 1.0)) if v in LINEAR else x[row]) if angle else x[row]
            name = ANGLES.get(v, v if v in CONTROLS else f"{v}'")
            words.append(f"{name} {value:.3g}{' deg' if angle else ''}")
    return f"{m.labels[row]} ({', '.join(words) or 'zero angle and rate'})"


def held_ranges(
    measured: Sequence[MeasuredTable], cap: Mapping[tuple[str, str], float], length: float
) -> tuple[HeldRange, ...]:
    """Where the law of every component holds, as far as the points of a campaign go; angles of v/U and w/U."""
    ends: dict[tuple[str, str, str], tuple[float, float]] = {}
    for m in measured:
        for v, x in m.primes(length).items():
            low, high = min(float(x.min()), 0.0), max(float(x.max()), 0.0)
            for f in m.forces:
                moved = [value for value, at in zip(f.values, x, strict=True) if abs(at) > AT_REST]
                if any(value is not None for value in moved):
                    limit = cap.get((f.component, v), np.inf)
                    before = ends.get((f.component, v, m.campaign), (0.0, 0.0))
                    ends[f.component, v, m.campaign] = (
                        min(max(low, -limit), before[0]),
                        max(min(high, limit), before[1]),
                    )
    out = []
    for (c, v, campaign), (low, high) in ends.items():
        name, unit = ANGLES.get(v, v if v in CONTROLS else f"{v}'"), "rad" if v in ANGLES or v in CONTROLS else "1"
        first, last = (float(np.arcsin(np.clip(x, -1.0, 1.0))) if v in ANGLES else x for x in (low, high))
        out.append(
            HeldRange.model_validate(
                {"component": c, "variable": name, "low": first, "high": last, "unit": unit, "campaign": campaign}
            )
        )
    return tuple(out)

"""Do the runs carry the fit: enough points, both sides, no extrapolation, nothing hidden in replicates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Severity
from coeflab.core.table import Check, as_check
from coeflab.fits.rows.sweeps import ACROSS_AT, FEWEST_SETTINGS, JUMPED, STALLED
from coeflab.fits.rows.too_few import FEW_ROWS
from coeflab.fits.statistics.diagnostics import replicate_groups
from coeflab.fits.statistics.least_squares import Index, factorise, solve
from coeflab.fits.statistics.robust_errors import t_probability
from coeflab.fits.statistics.slopes import design
from coeflab.law.coefficient import Status
from coeflab.law.symbols import primed
from coeflab.tables.evidence import trend
from coeflab.tables.force_table import AT_REST, ForceTable

if TYPE_CHECKING:
    from coeflab.fits.results.fit_result import Sweep
    from coeflab.study.study import Study

summary = "points, sides, distance of the first angle, sign, replicates, a moment of the other plane"
citations = ("roddy1990",)

FEW = 7
REPLICATE_LEVEL = 0.01


def _points(s: Sweep, status: Status) -> Check:
    n = len(s.x)
    subject = f"{s.campaign} {primed(s.symbol)}"
    if status is Status.TOO_FEW_POINTS:
        return Check.of("coverage.too_few", subject, Severity.WARN, advice=status.advice, n=n, why=s.reason)
    severity, size = (Severity.PASS, "enough") if n >= FEW else (Severity.NOTE, "few")
    return Check.of("coverage.points", subject, severity, n=n, least=FEW, size=size)


def _sides(s: Sweep) -> Check | None:
    if s.value is None:
        return None
    subject = f"{s.table} {s.variable}'"
    if s.symmetry:
        return Check.of("coverage.declared", subject, Severity.PASS, symmetry=s.symmetry)
    if s.one_sided:
        return Check.of("coverage.one_sided", subject, Severity.WARN)
    low, high = float(s.x.min()), float(s.x.max())
    if min(-low, high) < 0.5 * max(-low, high):
        return Check.of("coverage.uneven", subject, Severity.NOTE, low=low, high=high)
    return None


def _stalled(s: Sweep) -> list[Check]:
    """Rows past a peak of the force across the flow, or past a jump of the reading, which no slope uses."""
    out = []
    for reason, code, subject in (
        (STALLED, "stalled", f"{s.table} {s.variable}'"),
        (JUMPED, "jumped", f"{s.campaign} {primed(s.symbol)}"),
    ):
        if beyond := [abs(p.x) for p in s.left_out if p.reason == reason]:
            out.append(Check.of(f"coverage.{code}", subject, Severity.WARN, n=len(beyond), least=min(beyond)))
    return out


def _extrapolation(s: Sweep, tables: Sequence[ForceTable]) -> Check | None:
    """The slope at the origin is an extrapolation when no run lies near it; one at zero gives none by a declared symmetry."""
    size = np.abs(s.x)
    if not len(size) or size.max() == 0.0 or size.min() <= 0.25 * size.max():
        return None
    moved = [t.primed_motion(s.variable, t.scaling.length) for t in tables if t.name == s.table]
    has_zero = bool(s.symmetry) and any(np.any(np.abs(x) <= AT_REST) for x in moved)
    return Check.of(
        "coverage.extrapolated", f"{s.table} {s.variable}'", Severity.WARN, variable=f"{s.variable}'", least=float(size.min()),
        most=float(size.max()), zero="there" if has_zero else "none", symmetry=s.symmetry,
    )  # fmt: skip


def _repeated(s: Sweep) -> list[Index]:
    """Groups of rows at one setting of an odd sweep."""
    size = float(np.max(np.abs(s.x), initial=0.0))
    return replicate_groups(s.x, 1e-4 * size) if s.parity == "odd" and size > 0.0 else []


def replicates(s: Sweep, groups: int) -> list[Check]:
    """Replicates of which one departs from the mean of its group more than the scatter of the other rows allows.

    The rows outside the group are fitted by the full polynomial with even term; their residual spread is the scale, so
    that a bad pair cannot hide in its own scatter.

    Parameters
    ----------
    s : Sweep
    groups : int
        Groups of replicates that share the level (Bonferroni).
    """
    out = []
    for group in _repeated(s):
        rest = np.setdiff1d(np.arange(len(s.x)), group)
        terms = ("1", "x", "x2", "x3")
        if len(rest) < len(terms) + 2:
            continue
        f = factorise(design(terms, s.x[rest]))
        _, residuals = solve(f, s.y[rest])
        spread = float(np.sqrt(np.sum(residuals**2) / max(f.freedom, 1)))
        gap = float(np.ptp(s.y[group]))
        k = len(group)
        largest = float(np.max(np.abs(s.y[group] - s.y[group].mean()))) * (k / (k - 1.0)) ** 0.5
        p = float(t_probability(largest / spread, f.freedom)) * (k if k > 2 else 1) if spread else 0.0
        if p < REPLICATE_LEVEL / groups and gap > 1e-9 * float(np.max(np.abs(s.y))):
            out.append(Check.of(
                "replicates.differ", f"{s.campaign} {primed(s.symbol)}", Severity.WARN, points=", ".join(s.labels[i] for i in group),
                gap=gap, deviations=gap / spread if spread else np.inf, level=REPLICATE_LEVEL, groups=groups,
            ))  # fmt: skip
    return out


def _moment_of_the_other_plane(t: ForceTable) -> Check | None:
    """A moment that varies with motions of one plane alone, named for the other plane, while this plane has none."""
    largest = float(np.max(t.speed, initial=0.0))
    unit = {"v": largest, "w": largest, "q": largest / t.scaling.length, "r": largest / t.scaling.length}
    moves = {m: bool(t.motion[m].size and np.ptp(t.motion[m]) > AT_REST * one) for m, one in unit.items()}
    for own, other, motions, still in (("M", "N", "wq", "vr"), ("N", "M", "vr", "wq")):
        moving = next((m for m in motions if moves[m]), "")
        if not moving or any(moves[m] for m in still) or own in t.forces or other not in t.forces:
            continue
        if trend(t.forces[other], t.motion, moving):
            return Check.of(
                "coverage.other_plane", f"{t.name} {other}", Severity.WARN, other=other, moving=moving, own=own
            )
    return None


def _bodies(study: Study) -> list[Check]:
    """Campaigns whose bodies share no coefficient: mostly tests of one body under two names."""
    found = "; ".join(f"{', '.join(map(primed, symbols))}: {body}" for body, symbols in study.by_body.items())
    if not found:
        return []
    return [Check.of("coverage.bodies", " and ".join(study.by_body), Severity.WARN, found=found)]


def check(study: Study) -> Sequence[Check]:
    """Findings on every sweep, and on every table whose only moment is that of the other plane."""
    out = [c for t in study.tables if (c := _moment_of_the_other_plane(t)) is not None]
    out += _bodies(study)
    few = list(dict.fromkeys(found for f in study.fits for found in f.findings if found.code == FEW_ROWS))
    short = {(found.subject, found["variable"]) for found in few}
    across = dict.fromkeys(found for f in study.fits for found in f.findings if found.code == ACROSS_AT)
    out += [as_check("coverage", found) for found in (*few, *across)]
    for f in study.fits:
        groups = max(sum(len(_repeated(s)) for s in f.sweeps), 1)
        for s in f.sweeps:
            if (s.table, f"{s.variable}'") in short and len(s.x) < FEWEST_SETTINGS:
                continue
            out.append(_points(s, f.coefficients[s.symbol].status))
            if s.by_symmetry:  # a copy has the findings of its source
                continue
            found = [
                c for c in (_sides(s), *_stalled(s), _extrapolation(s, study.tables)) if c is not None
            ] + replicates(s, groups)
            out += [c for c in found if c not in out]
    return out

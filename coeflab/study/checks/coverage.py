"""Do the runs carry the fit: enough points, both sides, no extrapolation, nothing hidden in replicates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.core.table import Check, Severity, plus_minus, with_u95
from coeflab.fits.results.fit_result import Sweep
from coeflab.fits.statistics.diagnostics import replicate_groups
from coeflab.fits.statistics.least_squares import Index, factorise, solve
from coeflab.fits.statistics.slopes import design
from coeflab.law.coefficient import Status
from coeflab.law.symbols import primed
from coeflab.study.study import Study

summary = "points, sides, distance of the first angle, sign, wrong points, replicates, copied rows"
citations = ("roddy1990",)

FEW = 7
REPLICATE_LIMIT = 3.0


def _points(s: Sweep, status: Status) -> Check:
    n = len(s.x)
    subject = f"{s.campaign} {primed(s.symbol)}"
    if status is Status.TOO_FEW_POINTS:
        return Check("coverage", subject, Severity.WARN, f"{n} points, {s.reason}", "three settings", status.advice)
    severity = Severity.PASS if n >= FEW else Severity.NOTE
    comment = (
        "Enough to tell forms apart." if n >= FEW else "Few points: intervals rest on very few degrees of freedom."
    )
    return Check("coverage", subject, severity, f"{n} points", f"at least {FEW}", comment)


def _sides(s: Sweep) -> Check | None:
    if s.value is None:
        return None
    subject = f"{s.table} {s.variable}'"
    if s.one_sided:
        return Check(
            "coverage",
            subject,
            Severity.WARN,
            "all points on one side",
            "points on both sides of zero",
            "Even and odd parts cannot be told apart; the body is taken as symmetric.",
        )
    low, high = float(s.x.min()), float(s.x.max())
    if min(-low, high) < 0.5 * max(-low, high):
        return Check(
            "coverage",
            subject,
            Severity.NOTE,
            f"settings from {low:.3g} to {high:.3g}",
            "both sides within a factor of two",
            "The sweep is not symmetric about zero.",
        )
    return None


def _extrapolation(s: Sweep) -> Check | None:
    """The slope at the origin is an extrapolation when no run lies near it."""
    size = np.abs(s.x)
    if not len(size) or size.max() == 0.0 or size.min() <= 0.25 * size.max():
        return None
    return Check(
        "coverage",
        f"{s.table} {s.variable}'",
        Severity.WARN,
        f"smallest |{s.variable}'| = {size.min():.3g} of {size.max():.3g}",
        "a run within a quarter of the range from zero",
        "The value at the origin is extrapolated. Run smaller settings.",
    )


def _replicates(s: Sweep) -> list[Check]:
    """Replicates that differ by more than three standard deviations pooled over the other rows.

    The rows outside the group are fitted by the full polynomial with even term; their residual spread is the scale, so
    that a bad pair cannot hide in its own scatter.
    """
    out = []
    size = float(np.max(np.abs(s.x), initial=0.0))
    if s.parity != "odd" or size == 0.0:
        return []
    for group in replicate_groups(s.x, 1e-4 * size):
        rest = np.setdiff1d(np.arange(len(s.x)), group)
        terms = ("1", "x", "x2", "x3")
        if len(rest) < len(terms) + 2:
            continue
        f = factorise(design(terms, s.x[rest]))
        _, residuals = solve(f, s.y[rest])
        spread = float(np.sqrt(np.sum(residuals**2) / max(f.freedom, 1)))
        gap = float(np.ptp(s.y[group]))
        if gap > REPLICATE_LIMIT * spread and gap > 1e-9 * float(np.max(np.abs(s.y))):
            names = ", ".join(s.labels[i] for i in group)
            out.append(
                Check(
                    "replicates",
                    f"{s.campaign} {primed(s.symbol)}",
                    Severity.WARN,
                    f"points {names} differ by {gap:.3g}, {gap / spread if spread else np.inf:.1f} standard deviations",
                    f"within {REPLICATE_LIMIT:g} pooled standard deviations",
                    "One of them may be a bad run; all are in the fit.",
                )
            )
    return out


def _named(s: Sweep, rows: Index) -> str:
    return f"point{'s' * (len(rows) > 1)} {', '.join(s.labels[i] for i in rows)}"


def _robust(s: Sweep) -> list[Check]:
    """Points that do not fit the others, with the value with and without them, and rows that were pasted."""
    subject, out = f"{s.campaign} {primed(s.symbol)}", []
    if len(s.wrong) and s.value is not None:
        out.append(
            Check(
                "outliers",
                subject,
                Severity.WARN,
                f"{_named(s, s.wrong)} left out: {primed(s.symbol)} = {plus_minus(s.value, s.u95)}, "
                f"with {'it' if len(s.wrong) == 1 else 'them'} {with_u95(s.with_all, s.u95)[0]}",
                "every point within the scatter of the others about any smooth curve",
                "Look at this run: a sign, a decimal, a wrong angle. If it is right, run its neighbours.",
            )
        )
    if len(s.repeated):
        out.append(
            Check(
                "replicates",
                f"{s.table} {s.component} over {s.variable}'",
                Severity.WARN,
                f"{_named(s, s.repeated)} repeat{'s' * (len(s.repeated) == 1)} an earlier row exactly",
                "no two rows alike to the last digit",
                "A copied row is no new reading; each counts once.",
            )
        )
    if any("mirror" in note for note in s.notes):
        out.append(
            Check(
                "replicates",
                f"{s.table} {s.component} over {s.variable}'",
                Severity.WARN,
                "every row has its exact mirror image",
                "readings of their own on either side",
                "A mirrored half is no new reading; U95 is wider by the square root of two.",
            )
        )
    return out


def check(study: Study) -> Sequence[Check]:
    """Findings on every sweep."""
    out: list[Check] = []
    for f in study.fits:
        for s in f.sweeps:
            out.append(_points(s, f.coefficients[s.symbol].status))
            found = [c for c in (_sides(s), _extrapolation(s)) if c is not None] + _replicates(s) + _robust(s)
            out += [c for c in found if c not in out]
    return out

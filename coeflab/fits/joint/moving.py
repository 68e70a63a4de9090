"""Fits of one body about one point, each by what the others measured; what no move brings there is a finding."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.types import Array
from coeflab.fits.results.fit_result import FitResult, Shared, covariance_of
from coeflab.law.coefficient import MovedSets, moved_together
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import primed

LEFT_OUT = "move.left_out"


def distance(of: Array) -> str:
    """How far a point is moved: ``7 mm``, ``0.3 m``.

    Examples
    --------
    >>> distance(np.array([0.007, 0.0, 0.0])), distance(np.array([-0.3, 0.0, 0.0]))
    ('7 mm', '0.3 m')
    """
    size = float(np.linalg.norm(of))
    return f"{1000.0 * size:.3g} mm" if size < 0.1 else f"{size:.3g} m"


def left_out(
    moved: MovedSets, names: Sequence[str], shifts: Sequence[Array], severity: Severity
) -> list[list[Finding]]:
    """What of every set was not moved, one finding a set and kind.

    Parameters
    ----------
    moved : MovedSets
    names : sequence of str
        Of the sets.
    shifts : sequence of (3,) array
        How far each was moved, m.
    severity : Severity
    """
    out: list[list[Finding]] = [[] for _ in names]
    for i, name in enumerate(names):
        for needed in (True, False):
            lacking = [one for one in moved.lacking if one.of == i and bool(one.needs) is needed]
            if lacking:
                needs = dict.fromkeys(primed(n) for one in lacking for n in one.needs)
                out[i].append(Finding.of(
                    LEFT_OUT, name, severity, statistic=float(np.linalg.norm(shifts[i])),
                    by="needs" if needed else "form", symbols=tuple(primed(one.symbol) for one in lacking),
                    needs=tuple(needs), distance=distance(shifts[i]),
                ))  # fmt: skip
    return out


def fits_about(fits: Sequence[FitResult], point: Array, scaling: Scaling | None = None) -> tuple[FitResult, ...]:
    """Fits of one body about a point, with the covariance that a common move gives them, and findings on what was left out.

    Parameters
    ----------
    fits : sequence of FitResult
        Of one datum.
    point : (3,) array
        m, FRD, from the datum.
    scaling : Scaling, optional
        Of the primes; that of the first unless given.
    """
    by = scaling or fits[0].coefficients.scaling
    sets = [f.coefficients.to_length(by) for f in fits]
    longer = np.concatenate([[f.coefficients.scaling.ratio(s, by) for s in f.coefficients.symbols] for f in fits])
    moved = moved_together(sets, covariance_of(fits) * np.outer(longer, longer), point)
    found = left_out(
        moved, [f.campaign for f in fits], [np.asarray(point) - s.reference_point for s in sets], Severity.WARN
    )
    ends = np.cumsum([0, *(len(s.coefficients) for s in sets)])
    out = []
    for i, f in enumerate(fits):
        shared = [
            Shared(g.fit, g.campaign, moved.covariance[ends[i] : ends[i + 1], ends[j] : ends[j + 1]])
            for j, g in enumerate(fits) if j != i
        ]  # fmt: skip
        lent = [
            Finding.of(
                "move.lent", f.campaign, Severity.NOTE, lender=fits[j].campaign,
                distance=distance(np.asarray(point) - sets[i].reference_point),
            )
            for a, j in sorted(moved.lent) if a == i
        ]  # fmt: skip
        held = tuple(s for s in shared if np.any(np.nan_to_num(s.covariance)))
        out.append(replace(f, coefficients=moved.sets[i], shared=held, findings=(*f.findings, *lent, *found[i])))
    return tuple(out)

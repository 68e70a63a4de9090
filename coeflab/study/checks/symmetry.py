"""Symmetry: a body alike to port and starboard has no side force at zero drift, and one cut in half has a force across the cut."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check, plus_minus
from coeflab.law.symbols import FORCES
from coeflab.study.single_motion import commanded
from coeflab.tables.campaign import CUTS, Cut
from coeflab.tables.force_table import AT_REST, ForceTable
from coeflab.tables.half_bodies import FORCE, LEVER, MOMENT, Along, forces_across, judged

if TYPE_CHECKING:
    from coeflab.fits.results.fit_result import Sweep
    from coeflab.study.study import Study

summary = "intercepts of Y, K, N at zero drift and yaw rate; forces across a plane of symmetry, in motions along it"
citations = ("wahba1990",)
ZEROS = 1e-9  # of the largest primed force or moment of the campaign: below it a component holds numerical zeros
RULED_OUT = ("symmetry.withdrawn", "symmetry.planes", "symmetry.body")
NOTHING, LARGE = 1e-3, 0.05
HALF = 0.5  # of the largest reading: what does not change its sign over a sweep to both sides is of no angle


def _intercept(sweep: Sweep, force: float) -> Check | None:
    """A component at rest; ``force`` is the largest primed force of its campaign."""
    if sweep.component not in "YKN" or sweep.variable not in ("v", "r") or sweep.value is None or sweep.symmetry:
        return None
    value, error = sweep.at_rest
    reach = float(abs(sweep.y).max())
    share = abs(value) / reach if reach else 0.0
    if abs(value) <= error:
        severity, size = Severity.PASS, "zero"
    elif share < NOTHING:
        severity, size = Severity.PASS, "negligible"
    elif share < LARGE:
        severity, size = Severity.NOTE, "small"
    else:
        least = force * (FORCE if sweep.component in FORCES else MOMENT * LEVER)
        severity, size = Severity.WARN, "half" if share > HALF and abs(value) > least else "large"
    return Check.of(
        "symmetry.intercept", f"{sweep.campaign} {sweep.component}0'", severity, component=f"{sweep.component}'", motion=_motion(sweep),
        value=plus_minus(value, error), share=100 * share, note=100 * NOTHING, warning=100 * LARGE, size=size,
    )  # fmt: skip


def _motion(sweep: Sweep) -> str:
    return "drift" if sweep.variable == "v" else "yaw rate"


def check(study: Study) -> Sequence[Check]:
    """One finding per odd sweep of a port-starboard component; one per table with forces across a plane of symmetry."""
    sweeps = [s for f in study.fits for s in f.sweeps]
    largest, force = defaultdict[str, float](float), defaultdict[str, float](float)
    for s in sweeps:
        size = float(np.abs(s.y).max(initial=0.0))
        largest[s.campaign] = max(largest[s.campaign], size)
        force[s.campaign] = max(force[s.campaign], size * (s.component in FORCES))
    odd = [s for s in sweeps if s.parity == "odd" and np.abs(s.y).max(initial=0.0) >= ZEROS * largest[s.campaign]]
    across = [c for t in study.tables if not t.by_symmetry for cut in CUTS.values() for c in _across(t, cut)]
    ruled_out = [f for fit in study.fits for f in fit.findings if f.code in RULED_OUT]
    found = [as_check("symmetry", f) for f in (*biases(study), *ruled_out)]
    return [c for s in odd if (c := _intercept(s, force[s.campaign])) is not None] + found + across


def biases(study: Study) -> tuple[Finding, ...]:
    """What rows at rest have of a force that a declared symmetry makes zero, over that of the smallest setting, of every sweep over one side.

    The smallest that was commanded, whether its run converged or not: what is left of a sweep would make a bias look small.

    Parameters
    ----------
    study : Study
    """
    tables = {t.name: t for t in study.tables}
    out = []
    for f in study.fits:
        for s in (s for s in f.sweeps if s.bias and s.value is not None and not s.by_symmetry):
            length = f.coefficients.scaling.length
            rows = commanded(tables[s.table], s.component, s.variable, length) if s.table in tables else ()
            if (least := min((r for r in rows if r.y), key=lambda r: r.size, default=None)) is None:
                continue
            share = abs(s.bias) / abs(least.y)
            of_value = abs(s.bias * float(s.by_row.sum()) / s.value) if s.value else np.inf
            out.append(
                Finding.of(
                    "symmetry.bias", s.table, Severity.WARN if share > LARGE else Severity.PASS, statistic=share, threshold=LARGE,
                    advice=f'matrix.pairs = ["{least.label}"]', component=f"{s.component}'", row=least.label,
                    ended="" if least.counts else ", which did not converge", symbol=f"{s.symbol}'", of_value=of_value,
                    judged="much" if share > LARGE else "little",
                )
            )  # fmt: skip
    return tuple(out)


def _across(table: ForceTable, cut: Cut) -> Iterator[Check]:
    """Forces across a plane in motions along it: of half of a body, or of one that is not as symmetric as it should be."""
    declared = cut.symmetry in table.symmetry
    if cut.symmetry not in judged(table.symmetry):
        return
    length = table.scaling.length
    moving = [table.primed_motion(m, length) for m in (*cut.across, *(c for c in cut.controls if c in table.controls))]
    along = np.all([np.abs(x) <= AT_REST for x in moving], axis=0)
    in_plane = abs(float(table.reference_point["xyz".index(cut.plane[0])])) <= AT_REST * length
    rows = Along(table.forces, table.errors, {c: along & mask for c, mask in table.usable.items()}, length)
    if found := forces_across(table.name, cut, rows, declared=declared, in_plane=in_plane):
        yield as_check("symmetry", found)

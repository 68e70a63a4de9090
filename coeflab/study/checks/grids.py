"""Which of several grids a table is fitted on, and whether a finer one is needed: the worst of its grid studies, in a line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.fits.uncertainty.budget import TELLING
from coeflab.fits.uncertainty.grid_convergence import Convergence
from coeflab.fits.uncertainty.grid_studies import GridStudy, grid_studies
from coeflab.tables.force_table import FINER, ForceTable, grids

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "grid that a table is fitted on, and whether its grid studies ask for a finer one"
citations = ("celik2008", "eca2014")
answers = True
WIDE = 0.05  # of the force: a 95 % half-width of the grid above it is worth a finer one
ANGLES = {"v": "drift", "w": "attack"}


def check(study: Study) -> Sequence[Check]:
    """Notes of every table with cell counts; a warning where the rows in use ran on different grids."""
    return [as_check("grids", found) for t in study.tables if not t.by_symmetry for found in (*in_use(t), *finer(t))]


def in_use(table: ForceTable) -> Iterator[Finding]:
    """Rows of finer grids than the one in use, and rows in use of another one.

    Parameters
    ----------
    table : ForceTable
    """
    if table.cells is None:
        return
    used = np.logical_or.reduce([*table.usable.values(), np.zeros(len(table), dtype=bool)]) & np.isfinite(table.cells)
    if not np.any(used):
        return
    cells = table.cells[used]
    level = grids(cells)
    common = level == level.max() - np.argmax(np.bincount(level)[::-1])
    about = millions(float(np.median(cells[common])))
    above = {e.row for e in table.exclusions if e.reason == FINER}
    if above:
        yield Finding.of("grids.apart", table.name, Severity.NOTE, count=len(above), cells=about)
    if not np.all(common):
        yield Finding.of(
            "grids.mixed", table.name, Severity.WARN, count=int(np.sum(~common)), of=len(cells), common=about,
            cells=f"{millions(float(cells.min()))} to {millions(float(cells.max()))}",
        )  # fmt: skip


def finer(table: ForceTable) -> Iterator[Finding]:
    """Whether a finer grid is needed: of the grid studies that say something of a force that counts, the worst.

    Parameters
    ----------
    table : ForceTable
    """
    found = []
    for kind in ("XYZ", "KMN"):
        own = [c for c in kind if c in table.forces]
        least = TELLING * max(
            (float(np.max(np.abs(table.forces[c][table.usable[c]]), initial=0.0)) for c in own), default=0.0
        )
        found += [
            s for c in own for s in grid_studies(table, c) if abs(s.convergence.values[s.convergence.used]) > least
        ]
    if not found:
        return
    worst = max(found, key=lambda s: (not s.convergence.convergence.converges, s.convergence.relative or 0.0))
    judged = worst.convergence
    near = judged.used - 1 if judged.used else 1  # the next finer grid, else the next coarser
    fine, coarse = sorted((judged.used, near))
    change = abs(judged.values[fine] - judged.values[coarse]) / abs(judged.values[judged.used])
    wide = (judged.relative or 0.0) > WIDE
    need = (
        "diverges" if not judged.convergence.converges
        else "unknown" if judged.convergence is Convergence.TWO_GRIDS and wide
        else "wide" if wide else "no"
    )  # fmt: skip
    ranked = sorted(worst.cells, reverse=True)
    yield Finding.of(
        "grids.finer", table.name, Severity.PASS if need == "no" else Severity.NOTE, statistic=judged.relative, threshold=WIDE, need=need,
        component=worst.component, change=100.0 * change, coarse=millions(ranked[coarse]), fine=millions(ranked[fine]),
        setting=_setting(table, worst), how=judged.convergence.value,
    )  # fmt: skip


def _setting(table: ForceTable, study: GridStudy) -> str:
    """Where a study is: the angle of a drift or of an angle of attack, else as it says itself."""
    if len(study.moving) == 1 and study.moving[0] in ANGLES:
        name = study.moving[0]
        sine = float(study.setting.split()[2]) / float(np.median(table.speed))
        return f"{abs(np.degrees(np.arcsin(np.clip(sine, -1.0, 1.0)))):.2g} deg of {ANGLES[name]}"
    return study.setting


def millions(cells: float) -> str:
    """A count of cells in three digits, as 1.2M or 560k.

    Examples
    --------
    >>> millions(1.2e6), millions(560300)
    ('1.2M', '560k')
    """
    return f"{cells / 1e6:.3g}M" if cells >= 1e6 else f"{cells / 1e3:.3g}k" if cells >= 1e3 else f"{cells:.0f}"

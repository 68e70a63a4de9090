"""When a run may end: on the plateau of all its forces and moments, of the whole body and of every patch.

The plateau itself, its mean and standard error are those of `coeflab.tables.histories`. A run that is watched is asked again
and again, so more is asked for than of a run that has ended: rows enough for a calibrated error, and that the three thirds of
the plateau do not run towards another value. A geometric approach m1, m2, m3 ends at m3 + (m3 - m2) q / (1 - q) with
q = (m3 - m2)/(m2 - m1) (Aitken 1926).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from coeflab.core.types import Array, brief
from coeflab.law.symbols import COMPONENTS, FORCES
from coeflab.tables.histories import CALIBRATED_ROWS, OF_THE_WHOLE, SHARE, Convergence, Mean, Plateau, plateau, scales
from coeflab.tables.raw_table import Ended, Run

CITATIONS = (
    "Aitken (1926): On Bernoulli's numerical solution of algebraic equations. Proc. R. Soc. Edinburgh 46, 289-305",
)
SHARES = ("pressure", "viscous", "internal", "porous")  # of the force, not parts of the body
SLOWEST = 0.9  # ratio of the changes from third to third


@brief
@dataclass(frozen=True, slots=True, eq=False)
class Verdict:
    """Whether a run may end.

    Attributes
    ----------
    settled : bool
        On its plateau.
    why : str
        What shows that it is not; empty where it is.
    diverged : bool
        It never will be.
    plateau : Plateau
        Of the whole body's forces and moments; its means are what the run says by now.
    """

    settled: bool
    why: str
    diverged: bool
    plateau: Plateau


def on_plateau(history: Run) -> Verdict:
    """Whether a run has settled: whole body and every patch, forces and moments.

    Parameters
    ----------
    history : Run
        Of which the patches are parts of the body; the shares by pressure and friction are passed over.
    """
    whole = {c.means: c.values for c in history.history.columns if c.means in COMPONENTS}
    found = plateau(whole or {"X": np.empty(0)}, length=history.length)
    if history.ended is Ended.DIVERGED or found.status is Convergence.DIVERGED:
        return Verdict(False, history.why or found.why, True, found)
    if found.status is Convergence.EMPTY:
        return Verdict(False, found.why, False, found)
    columns = dict(whole)
    for name, table in history.patches.items():
        if name not in SHARES:
            columns |= {f"{c.means}({name})": c.values for c in table.columns if c.means in COMPONENTS}
    rows = min(map(len, columns.values()))
    columns = {n: v[:rows] for n, v in columns.items()}
    groups = {n: "force" if n[0] in FORCES else "moment" for n in columns}
    both = plateau(columns, groups=groups, length=history.length)
    why = both.why or found.why
    if both.status is Convergence.CONVERGED:
        if both.rows < CALIBRATED_ROWS:
            why = f"{both.rows} rows on the plateau, {CALIBRATED_ROWS} needed"
        else:
            scale = scales({n: abs(m.value) for n, m in both.means.items()}, groups, history.length)
            why = why or _still_settling({n: v[both.start :] for n, v in columns.items()}, both.means, scale)
    return Verdict(not why, why, False, found)


def _still_settling(columns: Mapping[str, Array], means: Mapping[str, Mean], scale: Mapping[str, float]) -> str:
    """The columns that run towards another value by more than a share of it; empty where none does."""
    out = []
    for name, values in columns.items():
        tolerance = SHARE * max(abs(means[name].value), OF_THE_WHOLE * scale[name])
        left = settling(values, means[name].error)
        if abs(left) > tolerance:
            out.append(f"{name} by {left:+.2g}")
    return f"still settles: {', '.join(out)}" if out else ""


def settling(values: Array, error: float) -> float:
    """By how much the mean of a plateau misses the value that its thirds approach; 0 where they approach none significantly.

    Parameters
    ----------
    values : (n,) array
        n of 3 or more.
    error : float
        Standard error of their mean.

    Returns
    -------
    float
        The limit of a geometric approach less the mean. One whose changes shrink by less than a tenth from third to third
        cannot be told from one that does not end, and counts as this.
    """
    size = len(values) // 3
    one, two, three = values[len(values) - 3 * size :].reshape(3, size).mean(axis=1)
    before, after = two - one, three - two
    # Means of thirds have about sqrt(3) times the error of the whole mean, their differences sqrt(2) times that.
    if abs(after) <= 2.0 * np.sqrt(6.0) * error or before * after <= 0.0:
        return 0.0
    ratio = min(after / before, SLOWEST)
    return float(three + after * ratio / (1.0 - ratio) - (one + two + three) / 3.0)

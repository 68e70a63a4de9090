"""When a run may end: on the plateau of all its forces and moments, of the whole body and of every patch.

The plateau itself, its mean and standard error are those of `coeflab.tables.histories`. A run that is watched is asked again
and again, so more is asked for than of a run that has ended: rows enough for a calibrated error, and that the three thirds of
the plateau do not run towards another value. A geometric approach m1, m2, m3 ends at m3 + (m3 - m2) q / (1 - q) with
q = (m3 - m2)/(m2 - m1) (Aitken 1926).

A steady solver approaches its end smoothly, and for such a history the plateau that begins within the first half comes late: all
of the second half has to lie within a hundredth. So the last quarter, a calibrated length at least, is judged by itself as well.
It counts where the same rule holds there, where the limit of its thirds is no further off than what does not matter, whether it
is significant or not, and where the mean of as many rows before it is not either: neither a slow approach nor the crest of a
slow wave passes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from coeflab.core.types import Array, brief
from coeflab.law.symbols import COMPONENTS, FORCES
from coeflab.tables.histories import CALIBRATED_ROWS, OF_THE_WHOLE, SHARE, Convergence, Mean, Plateau, plateau, scales
from coeflab.tables.raw_table import Ended, RawTable, Run

CITATIONS = (
    "Aitken (1926): On Bernoulli's numerical solution of algebraic equations. Proc. R. Soc. Edinburgh 46, 289-305",
)
SHARES = ("pressure", "viscous", "internal", "porous")  # of the force, not parts of the body
LATE = 4  # part of a history that is judged by itself: the last of so many
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
    first : int
        Rows before the part of the history that was judged.
    """

    settled: bool
    why: str
    diverged: bool
    plateau: Plateau
    first: int = 0


def on_plateau(history: Run) -> Verdict:
    """Whether a run has settled: whole body and every patch, forces and moments.

    Parameters
    ----------
    history : Run
        Of which the patches are parts of the body; the shares by pressure and friction are passed over.
    """
    verdict = _judged(history)
    rows = len(history.history)
    late = max(CALIBRATED_ROWS, rows // LATE)
    if verdict.settled or verdict.diverged or rows < 2 * late:
        return verdict
    last = _judged(until(history, rows, rows - late))
    stays = last.settled and _stays(*_columns(history), late, history.length)
    return replace(last, first=rows - late) if stays else verdict


def until(run: Run, rows: int, first: int = 0) -> Run:
    """A run as it was when its history had so many rows, without the first ones; patches are cut at the same iterations or times.

    Parameters
    ----------
    run : Run
    rows, first : int
    """
    history = _between(run.history, first, rows)
    at = history.meaning("iteration") or history.meaning("time")
    patches = {}
    for name, table in run.patches.items():
        its = table.meaning("iteration") or table.meaning("time")
        begin, end = first, rows
        if at is not None and its is not None and len(at.values):
            begin, end = int((its.values < at.values[0]).sum()), int((its.values <= at.values[-1]).sum())
        patches[name] = _between(table, begin, end)
    return replace(run, history=history, patches=patches)


def _between(table: RawTable, first: int, end: int) -> RawTable:
    columns = tuple(replace(c, values=c.values[first:end], texts=c.texts[first:end]) for c in table.columns)
    return replace(table, columns=columns, lines=table.lines[first:end], row_labels=table.row_labels[first:end])


def _columns(history: Run) -> tuple[dict[str, Array], dict[str, str]]:
    """All forces and moments, of the whole body and of patches, of one length, and what belongs together."""
    columns = {c.means: c.values for c in history.history.columns if c.means in COMPONENTS}
    for name, table in history.patches.items():
        if name not in SHARES:
            columns |= {f"{c.means}({name})": c.values for c in table.columns if c.means in COMPONENTS}
    rows = min(map(len, columns.values()), default=0)
    columns = {n: v[:rows] for n, v in columns.items()}
    return columns, {n: "force" if n[0] in FORCES else "moment" for n in columns}


def _stays(columns: Mapping[str, Array], groups: Mapping[str, str], late: int, length: float) -> bool:
    """Whether the last rows are where as many before were, and where their thirds lead to."""
    means = {n: float(v[-late:].mean()) for n, v in columns.items()}
    scale = scales({n: abs(m) for n, m in means.items()}, groups, length)
    for name, values in columns.items():
        tolerance = SHARE * max(abs(means[name]), OF_THE_WHOLE * scale[name])
        before = float(values[-2 * late : -late].mean())
        if max(abs(before - means[name]), abs(settling(values[-late:], 0.0))) > tolerance:
            return False
    return True


def _judged(history: Run) -> Verdict:
    whole = {c.means: c.values for c in history.history.columns if c.means in COMPONENTS}
    found = plateau(whole or {"X": np.empty(0)}, length=history.length)
    if history.ended is Ended.DIVERGED or found.status is Convergence.DIVERGED:
        return Verdict(False, history.why or found.why, True, found)
    if found.status is Convergence.EMPTY:
        return Verdict(False, found.why, False, found)
    if not any(
        np.any(values) for values in whole.values()
    ):  # a towed body has drag: its patches are not those of the forces
        return Verdict(False, "every force is zero", False, found)
    columns, groups = _columns(history)
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
    return f"still settling: {', '.join(out)}" if out else ""


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

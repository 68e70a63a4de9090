"""Rows that a source prints and no fit uses: rejected or doubtful, kept for pictures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import Array, dataclass, locking
from coeflab.tables.force_table import ForceTable


@dataclass(frozen=True, slots=True, eq=False)
@locking("x y")
class SetAside:
    """Points beside a fit.

    Attributes
    ----------
    x : mapping of variable to (n,) array
        As the rows of the fit.
    y : (n,) array
    labels : tuple of str
    """

    x: Mapping[str, Array]
    y: Array
    labels: tuple[str, ...]

    def only(self, keep: NDArray[np.bool_]) -> SetAside:
        """Some of the points."""
        labels = tuple(t for t, k in zip(self.labels, keep, strict=True) if k)
        return SetAside({v: x[keep] for v, x in self.x.items()}, self.y[keep], labels)


def joined(parts: list[SetAside]) -> SetAside | None:
    """The points of several tables over the same variables; None where there are none."""
    found = [p for p in parts if len(p.y)]
    if not found:
        return None
    return SetAside(
        {v: np.concatenate([p.x[v] for p in found]) for v in found[0].x},
        np.concatenate([p.y for p in found]),
        tuple(t for p in found for t in p.labels),
    )


def readmitted(table: ForceTable) -> ForceTable:
    """The table with every printed cell in use that its file or its declaration turns away.

    Rows that a fit leaves out of its own accord, as another variable moves in them, have no line of a file and stay out.
    """
    usable = {c: np.isfinite(values) for c, values in table.forces.items()}
    for e in table.exclusions:
        if not e.line:
            for component in [e.component] if e.component else usable:
                usable[component][e.row] = False
    return replace(table, usable=usable)

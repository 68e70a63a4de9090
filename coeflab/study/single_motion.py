"""Rows of a table that move in one variable alone: those that count, and those whose run did not end as it should."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from coeflab.law.symbols import ANGULAR, LINEAR
from coeflab.tables.force_table import AT_REST, ForceTable


class Commanded(NamedTuple):
    """One row.

    Attributes
    ----------
    label : str
    size : float
        Primed, of the setting.
    x, y : float
        Primed motion and force.
    counts : bool
        Whether fits may use it; else its run did not converge.
    """

    label: str
    size: float
    x: float
    y: float
    counts: bool


def commanded(table: ForceTable, component: str, variable: str, length: float) -> Iterator[Commanded]:
    """Rows with a force that vary one motion, without those of studies and those that the campaign does not select.

    Parameters
    ----------
    table : ForceTable
    component, variable : str
    length : float
        Of the primes, m.
    """
    if component not in table.forces:
        return
    others = [m for m in (*LINEAR[1:], *ANGULAR, *table.controls) if m != variable]
    x, y = table.primed_motion(variable, length), table.primed_force(component, length)
    rests = [np.abs(table.primed_motion(m, length)) <= AT_REST for m in others]
    mine = [e for e in table.exclusions if e.component in ("", component)]
    states, apart = ({e.row for e in mine if bool(e.status) is wanted} for wanted in (True, False))
    for i in np.flatnonzero((np.abs(x) > AT_REST) & np.isfinite(y) & np.all(rests, axis=0)).tolist():
        counts = bool(table.usable[component][i])
        if i not in apart and not (table.variants and table.variants[i]) and (counts or i in states):
            yield Commanded(table.labels[i], float(abs(x[i])), float(x[i]), float(y[i]), counts)

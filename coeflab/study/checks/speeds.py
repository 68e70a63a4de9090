"""Speeds that are pooled in one sweep although its primed slope depends on the speed, as of a rudder behind a propeller at one rate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check, number
from coeflab.law.symbols import primed
from coeflab.tables.force_table import AT_REST, ForceTable
from coeflab.tables.levels import SHARE, slopes_by_level

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "whether a primed slope is one at every speed of its table; the settings that the source held constant"
citations = ("sname1950",)
SWEPT = {"v": "YN", "r": "YN", "w": "ZM", "q": "ZM", "dr": "YN", "ds": "ZM", "db": "ZM"}


def check(study: Study) -> Sequence[Check]:
    """One warning per slope that depends on the speed; none where a table has one speed."""
    return [as_check("speeds", found) for t in study.tables if not t.by_symmetry for found in pooled_speeds(t)]


def pooled_speeds(table: ForceTable) -> Iterator[Finding]:
    """Slopes of a table that depend on its speeds.

    Parameters
    ----------
    table : ForceTable
    """
    length = table.scaling.length
    names = [*(m for m in table.motion if m != "u"), *table.controls]
    primes = {m: table.primed_motion(m, length) for m in names}
    for variable in (m for m in table.varies if m in SWEPT):
        others = [np.abs(primes[m]) <= AT_REST for m in names if m != variable]
        alone = np.logical_and.reduce([*others, np.ones(len(table), dtype=bool)])
        for component in (c for c in SWEPT[variable] if c in table.forces):
            rows = alone & table.usable[component]
            found = slopes_by_level(
                primes[variable][rows], table.primed_force(component, length)[rows], np.asarray(table.speed)[rows]
            )
            if found is None or not found.depends:
                continue
            constant = dict(table.declared.constant) if table.declared else {}
            campaign = table.name.partition("/")[0]
            yield Finding.of(
                "levels.speed", f"{table.name} {primed(component + variable)}", Severity.WARN, statistic=found.spread, threshold=SHARE,
                advice=f"coeflab fit {campaign} --speed {found.levels[-1]:.4g}", symbol=primed(component + variable),
                slopes=tuple(number(s, 3) for s in found.slopes), levels=tuple(f"{u:.4g}" for u in found.levels),
                constant=tuple(f"{name} {value:.6g}" for name, value in constant.items()), at="constant" if constant else "varied",
            )  # fmt: skip

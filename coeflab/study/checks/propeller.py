"""Tests in which a propeller runs: its thrust is kept out of X0', and the rate at which it pushes the model by itself is named."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.tables.force_table import AT_REST, DRIVEN, ForceTable
from coeflab.tables.levels import APART, levels_of

if TYPE_CHECKING:
    from coeflab.study.study import Study

summary = "rows in which a propeller runs, and the rate of self-propulsion by X of straight runs"
citations = ("sname1950",)
answers = True
TURN = 2.0 * np.pi  # rad/s of a turn in a second


def check(study: Study) -> Sequence[Check]:
    """A warning where X of a running propeller is left out, a note for each speed with a rate of self-propulsion."""
    return [
        as_check("propeller", f) for t in study.tables if not t.by_symmetry for f in (*left_out(t), *self_propulsion(t))
    ]


def left_out(table: ForceTable) -> Iterator[Finding]:
    """The finding about rows whose X holds thrust.

    Parameters
    ----------
    table : ForceTable
    """
    rows = {e.row for e in table.exclusions if e.reason == DRIVEN}
    if rows:
        advice = "[[table]] contains_thrust = false"
        yield Finding.of("propeller.thrust_in_x", table.name, Severity.WARN, count=len(rows), advice=advice)


def self_propulsion(table: ForceTable) -> Iterator[Finding]:
    """Of each speed the rate at which X of straight runs is zero, between the two runs about it by a line.

    Parameters
    ----------
    table : ForceTable
    """
    if "rps" not in table.propeller or "X" not in table.forces or not any(e.reason == DRIVEN for e in table.exclusions):
        return
    rate, force = table.propeller["rps"] / TURN, table.forces["X"]
    still = np.isfinite(rate) & np.isfinite(force)
    for name in (*(m for m in table.motion if m != "u"), *table.controls):
        still &= np.abs(table.primed_motion(name, table.scaling.length)) <= AT_REST
    level = levels_of(table.speed)
    for k in np.unique(level[still]):
        rows = np.flatnonzero(still & (level == k))
        rows = rows[np.argsort(rate[rows], kind="stable")]
        for a, b in pairwise(rows):
            if force[a] < 0.0 <= force[b] and rate[b] > (1.0 + APART) * rate[a]:
                share = -force[a] / (force[b] - force[a])
                ratio = table.propeller.get("J", np.full(len(table), np.nan))
                advance = float(ratio[a] + share * (ratio[b] - ratio[a]))
                yield Finding.of(
                    "propeller.self_propulsion", table.name, Severity.NOTE, statistic=float(rate[a] + share * (rate[b] - rate[a])),
                    speed=float(np.mean(table.speed[[a, b]])), rps=float(rate[a] + share * (rate[b] - rate[a])), J=advance,
                    low=float(rate[a]), high=float(rate[b]), known="J" if np.isfinite(advance) else "rps alone",
                )  # fmt: skip
                break

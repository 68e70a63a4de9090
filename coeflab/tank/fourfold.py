"""Tables of a tow that fourfold symmetry states: the rows of another plane, turned by 90 deg about x."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from coeflab.law.symbols import ANGULAR, LINEAR, MOTIONS
from coeflab.tables.run_summary import RunSummary
from coeflab.tank.test_matrix import Half, Kind, TowCondition
from coeflab.tank.towed_run import TowedRun

QUARTER = {"v": ("w", 1.0), "w": ("v", -1.0), "q": ("r", 1.0), "r": ("q", -1.0),
            "Y": ("Z", 1.0), "Z": ("Y", -1.0), "M": ("N", 1.0), "N": ("M", -1.0)}  # fmt: skip
SOURCES = {"attack": "drift", "arm_pitch": "arm"}


def by_fourfold_symmetry(groups: Mapping[str, Sequence[TowedRun]]) -> dict[str, list[TowedRun]]:
    """Attack from drift and a pitching arm from a yawing one, where they were not run: the same rows a quarter of a turn on."""
    return {
        name: [_turned(r, name) for r in groups[source]]
        for name, source in SOURCES.items()
        if name not in groups and source in groups
    }


def _turned(run: TowedRun, kind: str) -> TowedRun:
    """A run as it would be had body and motion been turned by 90 deg about x: starboard becomes down."""
    c = run.condition
    motion = dict(zip(MOTIONS, (*c.velocity, *c.rates), strict=True))
    new = dict.fromkeys(MOTIONS, 0.0)
    for name, x in motion.items():
        to, sign = QUARTER.get(name, (name, 1.0))
        new[to] = sign * float(x) + 0.0
    condition = TowCondition(
        c.name, Kind.ATTACK if kind == "attack" else c.kind, np.array([new[m] for m in LINEAR]),
        np.array([new[m] for m in ANGULAR]), {}, Half.PORT if c.half is Half.UPPER else c.half, c.grid, c.variant,
    )  # fmt: skip
    s = run.summary
    if s is None:
        return TowedRun(condition, run.state, run.why, None, run.remarks, run.case, run.mesh)
    means, errors = {}, {}
    for name, x in s.means.items():
        to, sign = QUARTER.get(name, (name, 1.0))
        means[to] = sign * x + 0.0
        if name in s.errors:
            errors[to] = s.errors[name]
    summary = RunSummary(
        s.name, s.status, s.why, means, errors, iterations=s.iterations, stated_conditions=s.stated_conditions
    )
    return TowedRun(condition, run.state, run.why, summary, run.remarks, run.case, run.mesh)

"""Conversion to primes: a campaign and its copy in other units, axes and about another point agree row by row."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.law.symbols import MOTIONS

if TYPE_CHECKING:
    from coeflab.study.study import Conversion, Study

summary = "primes of a campaign and of its copy in other units, axes and about another point"
citations = ()
WITHIN = 1e-6  # of the largest value of the component: copies are written with nine digits


def check(study: Study) -> Sequence[Check]:
    """One finding per component and copy."""
    return [
        replace(as_check("conversion", found), campaign=pair.copy.campaign)
        for pair in study.conversions for found in differences(pair)
    ]  # fmt: skip


def differences(pair: Conversion) -> Iterator[Finding]:
    """The largest difference of each primed force, moment, velocity and angle, over the largest value."""
    copy, original = pair.copy, pair.original
    length = original.scaling.length
    columns = {
        c: (copy.primed_force(c, length), original.primed_force(c, length)) for c in original.forces if c in copy.forces
    }
    columns |= {
        m: (copy.primed_motion(m, length), original.primed_motion(m, length)) for m in (*MOTIONS, *original.controls)
    }
    for name, (found, due) in columns.items():
        if not np.any(np.isfinite(due)) or not np.nanmax(np.abs(due), initial=0.0) + np.nanmax(
            np.abs(found), initial=0.0
        ):
            continue
        blank = np.isnan(found) != np.isnan(due)
        apart = np.inf if np.any(blank) else float(np.nanmax(np.abs(found - due)) / max(np.nanmax(np.abs(due)), 1e-12))
        yield Finding.of(
            "conversion.agrees" if apart <= WITHIN else "conversion.differs", f"{copy.campaign} {name}'",
            Severity.PASS if apart <= WITHIN else Severity.FAIL,
            statistic=min(apart, 1e300), threshold=WITHIN, original=original.campaign,
        )  # fmt: skip

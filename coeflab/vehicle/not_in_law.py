"""Forces that a table holds and no coefficient of a file does: Z and M over drift behind a sail, X over a rudder's angle."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from scipy.special import stdtrit

from coeflab.core.finding import Finding, Severity
from coeflab.core.types import Array
from coeflab.fits.rows.sweeps import FEWEST_SETTINGS
from coeflab.fits.statistics.diagnostics import CERTAIN, SHARE, levels
from coeflab.law.symbols import COMPONENTS, CONTROLS, FORCES, MOTIONS, PORT_STARBOARD, primed
from coeflab.tables.force_table import AT_REST, ForceTable
from coeflab.vehicle.law_at_points import SMALL

NOT_IN_LAW = "law.not_in_law"


def not_in_law(tables: Sequence[ForceTable], spoken: Mapping[str, frozenset[str]], length: float) -> Iterator[Finding]:
    """One finding for each force of a table that changes with a motion of which no coefficient of that component speaks.

    A change with the first term that symmetry allows, v^2 of Z or r of Y, counts from 5 % of the largest force of the component in the
    table beside its error (Student, 99 %). Where the body's
    port-starboard symmetry allows none, as of Y, K and N over attack, the force is the set-up's.

    Parameters
    ----------
    tables : sequence of ForceTable
        About the file's reference point.
    spoken : mapping of component to motions and controls
    length : float
        Of the primes, m.
    """
    for t in (t for t in tables if not t.by_symmetry):
        names = [m for m in (*MOTIONS[1:], *CONTROLS) if m in MOTIONS or m in t.controls]
        moved = np.array([np.abs(t.primed_motion(m, length)) > AT_REST for m in names])
        ahead = t.motion["u"] > 0.0
        size = {c: np.abs(t.primed_force(c, length)) * (t.usable[c] & ahead) for c in t.forces}
        for c in (c for c in COMPONENTS if c in t.forces):
            largest = float(np.max(size[c], initial=0.0))
            like = max(float(np.max(size[o], initial=0.0)) for o in size if (o in FORCES) == (c in FORCES))
            for k, m in enumerate(names):
                foreign = c in PORT_STARBOARD and m not in PORT_STARBOARD
                if m in spoken.get(c, frozenset()) or foreign or largest < SMALL * like:
                    continue
                rows = t.usable[c] & ahead & ~np.any(np.delete(moved, k, axis=0), axis=0)
                x, y = t.primed_motion(m, length)[rows], t.primed_force(c, length)[rows]
                even = c not in PORT_STARBOARD and (m in PORT_STARBOARD or c == "X")
                if len(np.unique(levels(x))) < FEWEST_SETTINGS:
                    continue
                change, noise = _change(x * x if even else x, y)
                if change > noise + SHARE * largest:
                    yield Finding.of(
                        NOT_IN_LAW, f"{c} {t.name}", Severity.WARN, statistic=change / largest, motion=m,
                        symbol=primed(f"{c}{m}{m}" if even else f"{c}{m}"),
                    )  # fmt: skip


def _change(term: Array, y: Array) -> tuple[float, float]:
    """How far y (n,) changes with a term (n,) beside a constant, and Student's 99 % of the error of that."""
    about, freedom = term - term.mean(), len(y) - 2
    slope = float(about @ y / (about @ about))
    rest = y - y.mean() - slope * about
    deviation = float(np.sqrt(rest @ rest / (about @ about) / max(freedom, 1)))
    reach = float(np.ptp(term))
    return abs(slope) * reach, float(stdtrit(max(freedom, 1), CERTAIN)) * deviation * reach

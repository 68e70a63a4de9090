"""Intervals of figures, where they come from, and which test takes most off, as tables and in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import ABSENT, Table
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.wording import collected
from coeflab.motion.uncertainty.tests import tests_of
from coeflab.report.tables.motion import DEGREES
from coeflab.report.texts import table_of, text_of

if TYPE_CHECKING:
    from coeflab.motion.uncertainty.spread import Importance, Spread
    from coeflab.motion.uncertainty.uncertainty import Carried

SMALL = 0.01
LISTED = 5


def shown_unit(unit: str) -> tuple[float, str]:
    """Factor and unit that a figure is shown in."""
    return (180.0 / np.pi, DEGREES[unit]) if unit in DEGREES else (1.0, "" if unit == "1" else unit)


def spread_table(carried: Carried) -> Table:
    """Every figure with its interval, or why it has none."""
    rows = []
    for s in carried.spreads:
        factor, unit = shown_unit(s.figure.unit)
        value = ABSENT if s.figure.value is None else f"{s.figure.value * factor:.5g}"
        rows.append(
            (s.figure.name, value, unit, *_interval(s, factor), f"{100.0 * s.having:.4g} %", s.figure.status, s.status)
        )
    reasons = collected((s.why, s.figure.name) for s in carried.spreads if s.why)
    notes = [f"{', '.join(names)}: {why}." for why, names in reasons.items()]
    beyond = [s.figure.name for s in carried.spreads if s.extrapolated]
    if beyond:
        notes.append(f"Beyond the data: {', '.join(beyond)}. The interval does not contain the error of extrapolating.")
    q = carried.question
    notes.append(text_of("uncertainty.members", members=q.members, seed=q.seed))
    what = "stability" if carried.undetermined else q.manoeuvre.replace("_", " ")
    return table_of("uncertainty.spread_table", rows, notes, what=what, vehicle=carried.vehicle)


def _interval(s: Spread, factor: float) -> tuple[str, str, str, str]:
    if s.low is None or s.high is None or s.median is None or s.low_error is None or s.high_error is None:
        return ABSENT, ABSENT, ABSENT, ABSENT
    ends = f"{s.low * factor:.4g} .. {s.high * factor:.4g}"
    return f"{s.median * factor:.5g}", ends, f"{s.low_error * factor:.2g}", f"{s.high_error * factor:.2g}"


def share_table(found: Importance) -> Table:
    """Sobol indices of one figure, groups below 1 % left out; without rows where there are none."""
    rows = tuple(
        (
            " ".join(s.symbols), s.source, f"{s.first:.3f}", _bounds(s.first_bounds), f"{s.total:.3f}",
            _bounds(s.total_bounds),
        )
        for s in found.shares
        if s.total_bounds[1] >= SMALL
    )  # fmt: skip
    notes = (text_of("uncertainty.first_total", rows=found.rows),)
    return table_of("uncertainty.share_table", rows, notes, figure=found.figure)


def _bounds(pair: tuple[float, float]) -> str:
    return f"{pair[0]:.2f} .. {pair[1]:.2f}"


def known_table(carried: Carried) -> Table:
    """Share of each figure's variance that one coefficient explains, correlations and all."""
    having = [i for i in carried.importances if i.known]
    symbols = [s for s in carried.varied.symbols if any(s in dict(i.known) for i in having)]
    rows = tuple(
        (s, *(f"{100.0 * dict(i.known)[s]:.0f} %" if s in dict(i.known) else "" for i in having)) for s in symbols
    )
    notes = ("A cubic of the coefficient, over the members; what chance alone would show is left out.",)
    headers = ("if known exactly", *(i.figure for i in having))
    return Table("share of the variance that would go", headers, rows, notes if rows else (), frozenset({0}))


def tests_table(carried: Carried) -> Table:
    """Which test takes most off the variance of the manoeuvre's figures, the first first; without rows where nothing varies."""
    having = [i for i in carried.importances if i.tests and (i.figure in carried.names or not carried.names)]
    mean: dict[str, float] = {}
    for name, share in (p for i in having for p in i.tests):
        mean[name] = mean.get(name, 0.0) + share / len(having)
    gives = tests_of(carried.varied.symbols)
    first = Counter(i.tests[0][0] for i in having)
    largest = sorted(mean.items(), key=lambda p: -p[1])
    rows = tuple(
        (name, _some(gives[name]), f"{100.0 * share:.0f} %", f"{first[name]} of {len(having)}")
        for name, share in largest
        if share >= SMALL
    )
    notes = (text_of("uncertainty.tests", having=_counted(len(having))),)
    return table_of("uncertainty.tests_table", rows, notes if rows else ())


def _some(symbols: Sequence[str]) -> str:
    more = len(symbols) - LISTED
    return " ".join(symbols[:LISTED]) + (f" and {more} more" if more > 0 else "")


def ranking(carried: Carried) -> tuple[str, ...]:
    """What narrows each figure most if known exactly, in words."""
    return tuple(_narrowing(i) for i in carried.importances if i.shares or i.known)


def _counted(figures: int) -> str:
    return "one figure" if figures == 1 else f"{figures} figures"


def _parts(found: Importance) -> list[tuple[str, float]]:
    if found.shares:
        return [(f"{' '.join(s.symbols)} ({s.source})", s.first) for s in found.shares]
    return list(found.known)


def _narrowing(found: Importance) -> str:
    words = [(name, share) for name, share in _parts(found) if share >= SMALL][:LISTED]
    if not words:
        return f"{found.figure}: nothing alone narrows its interval, which is a joint effect"
    each = ", ".join(f"{name} by {_narrower(share)}" for name, share in words)
    pair = found.shares[:2]
    close = len(pair) == 2 and pair[1].first_bounds[1] > pair[0].first_bounds[0]
    return f"{found.figure}: if known exactly, its interval narrows: {each}" + (
        "; the order of the first two is not certain" if close else ""
    )


def _narrower(share: float) -> str:
    """A share of the variance as what it takes from the width of the interval."""
    return f"{100.0 * (1.0 - max(1.0 - share, 0.0) ** 0.5):.0f} %"


def members_csv(carried: Carried) -> bytes:
    """One row a member: deviations of the coefficients in the file's units, and figures in SI; empty where it has none."""
    rows = [[*(f"d {s}" for s in carried.varied.symbols), *(f"{n}" for n in carried.names)]]
    for row, found in zip(carried.deviations, carried.values, strict=True):
        rows.append([*map(repr, row.tolist()), *("" if np.isnan(v) else repr(v) for v in found.tolist())])
    return csv_text(rows).encode()

"""Intervals of figures, where they come from, and which input is worth another test, as tables and in words."""

from __future__ import annotations

import numpy as np

from coeflab.core.table import ABSENT, Table
from coeflab.motion.uncertainty.carried import Carried, Importance, Spread
from coeflab.report.tables.motion import DEGREES

SMALL = 0.01
LISTED = 5


def shown_unit(unit: str) -> tuple[float, str]:
    """Factor and unit that a figure is shown in."""
    return (180.0 / np.pi, DEGREES[unit]) if unit in DEGREES else (1.0, "" if unit == "1" else unit)


def spread_table(carried: Carried) -> Table:
    """Every figure with its interval, or why it has none."""
    rows = []
    reasons: dict[str, list[str]] = {}
    for s in carried.spreads:
        factor, unit = shown_unit(s.figure.unit)
        value = ABSENT if s.figure.value is None else f"{s.figure.value * factor:.5g}"
        rows.append(
            (s.figure.name, value, unit, *_interval(s, factor), f"{100.0 * s.having:.4g} %", s.figure.status, s.status)
        )
        if s.why:
            reasons.setdefault(s.why, []).append(s.figure.name)
    notes = [f"{', '.join(names)}: {why}." for why, names in reasons.items()]
    beyond = [s.figure.name for s in carried.spreads if s.extrapolated]
    if beyond:
        notes.append(
            f"Lean on motions that no data cover: {', '.join(beyond)}. The interval knows nothing of the error of that."
        )
    q = carried.question
    notes.append(
        f"{q.members} members, seed {q.seed}; percentiles 2.275 and 97.725 (two standard uncertainties to both sides); "
        "+-: standard error of the ends for so many members."
    )
    headers = (
        "figure",
        "value",
        "unit",
        "median",
        "95 % interval",
        "+- low",
        "+- high",
        "members",
        "status",
        "interval",
    )
    what = "stability" if carried.undetermined else q.manoeuvre.replace("_", " ")
    title = f"{what} of {carried.vehicle}"
    return Table(title, headers, tuple(rows), tuple(notes), frozenset({0, 2, 8, 9}))


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
    notes = (
        f"{found.rows} rows. first: share of the variance that goes if the group is known; total: share that stays if all the "
        "others are.",
    )
    headers = ("group", "from", "first", "95 %", "total", "95 %")
    return Table(f"{found.figure}: where its variance comes from", headers, rows, notes, frozenset({0, 1}))


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


def ranking(carried: Carried) -> tuple[str, ...]:
    """What is worth another test or CFD run: over all figures of the manoeuvre, then figure by figure, in words."""
    told = [i for i in carried.importances if i.shares or i.known]
    own = [_parts(i) for i in told if i.figure in carried.names]
    mean: dict[str, float] = {}
    for name, share in (p for parts in own for p in parts):
        mean[name] = mean.get(name, 0.0) + share / len(own)
    first = [name for name, share in sorted(mean.items(), key=lambda p: -p[1]) if share >= SMALL][:LISTED]
    whole = f"worth another test or CFD run, by the mean share in the variance of {_counted(len(own))}: {', then '.join(first)}"
    return (*([whole] if first else []), *map(_narrowing, told))


def _counted(figures: int) -> str:
    return "one figure" if figures == 1 else f"{figures} figures"


def _parts(found: Importance) -> list[tuple[str, float]]:
    if found.shares:
        return [(f"{' '.join(s.symbols)} ({s.source})", s.first) for s in found.shares]
    return list(found.known)


def _narrowing(found: Importance) -> str:
    told = [(name, share) for name, share in _parts(found) if share >= SMALL][:LISTED]
    if not told:
        return f"{found.figure}: nothing alone narrows its interval, which is a joint effect"
    each = ", ".join(f"{name} by {_narrower(share)}" for name, share in told)
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
    lines = [",".join((*(f"d {s}" for s in carried.varied.symbols), *(f"{n}" for n in carried.names)))]
    for row, found in zip(carried.deviations, carried.values, strict=True):
        lines.append(",".join([*map(repr, row.tolist()), *("" if np.isnan(v) else repr(v) for v in found.tolist())]))
    return ("\n".join(lines) + "\n").encode()

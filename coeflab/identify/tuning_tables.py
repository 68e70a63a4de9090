"""A tuning as tables: parameters, quantities, correlations and what stays open."""

from __future__ import annotations

from coeflab.core.table import ABSENT, Table, number, with_u95
from coeflab.identify.tuning import STATUSES, WORDS, Tuning, largest_correlations


def parameters(tuning: Tuning) -> Table:
    """Every parameter from where to where, with its interval or why there is none."""
    rows = tuple(
        (
            p.name,
            p.unit,
            number(p.before, 5),
            *((number(p.after, 5), ABSENT) if p.u95 is None else with_u95(p.after, p.u95)),
            ABSENT if p.u95 is None else f"{100.0 * p.prior_share:.0f} %",
            WORDS[p.status],
        )
        for p in tuning.parameters
    )
    used = dict.fromkeys(p.status for p in tuning.parameters)
    notes = (*(f"{WORDS[s]}: {STATUSES[s]}." for s in used), *tuning.statements)
    headers = ("parameter", "unit", "before", "after", "U95", "prior", "status")
    return Table(f"{tuning.name}: parameters", headers, rows, notes, frozenset({0, 1, 6}))


def quantities(tuning: Tuning) -> Table:
    """Root mean squares before and after."""
    rows = tuple(
        (q.name, q.unit, str(q.count), number(q.rms(after=False), 3), number(q.rms(), 3), number(q.worst, 3))
        for q in tuning.quantities
    )
    headers = ("quantity", "unit", "cases", "rms before", "rms after", "largest after")
    return Table(f"{tuning.name}: model less data", headers, rows, (), frozenset({0, 1}))


def correlations(tuning: Tuning) -> Table:
    """Pairs of parameters with a correlation of 0.7 and more; without rows where there are none."""
    rows = tuple((a, b, f"{r:+.2f}") for a, b, r in largest_correlations(tuning))
    return Table(f"{tuning.name}: correlations", ("parameter", "with", "correlation"), rows, (), frozenset({0, 1}))


def together(tuning: Tuning) -> Table:
    """What the data determine only together; without rows where there is nothing."""
    rows = tuple((text,) for text in tuning.together)
    return Table(f"{tuning.name}: what the data do not determine", ("combination",), rows)

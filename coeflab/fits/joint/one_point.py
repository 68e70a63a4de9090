"""Tables of several campaigns about one point, and what sets the campaigns apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from coeflab.core.axes import ANYWHERE
from coeflab.core.errors import ScalingMismatchError, shown
from coeflab.law.scaling import Scaling
from coeflab.tables.force_table import ForceTable, counted_once

ALIKE = 0.02  # Reynolds numbers: temperatures of one tank within a degree, and rounding in reports
ROUNDED = 1e-6  # lengths in feet that were converted with different digits


def about_one_point(tables: Sequence[ForceTable]) -> tuple[ForceTable, ...]:
    """All tables about the reference point of the first, every reading once.

    Raises
    ------
    ScalingMismatchError
        Reference points from different datums.
    """
    first = next((t for t in tables if t.datum != ANYWHERE), tables[0])
    tables = [t.counted_from(first.datum, first.reference_point) for t in tables]
    for t in tables:
        if t.datum != first.datum:
            raise ScalingMismatchError(
                f"{first.campaign} measures points from {shown(first.datum.id)}, {t.campaign} from {shown(t.datum.id)}; state "
                "the reference points of both from one datum."
            )
    return tuple(t.about(first.reference_point) for t in counted_once(tables))


def one_length(tables: Sequence[ForceTable]) -> Scaling:
    """The scaling that all tables share, to the rounding of a length in other units.

    Raises
    ------
    ScalingMismatchError
        Tables primed by different lengths.
    """
    first = tables[0]
    for t in tables:
        if abs(t.scaling.length / first.scaling.length - 1.0) > ROUNDED:
            raise ScalingMismatchError(
                f"{first.campaign} is primed by {first.scaling}, {t.campaign} by {t.scaling}; name one length for both "
                "([scaling] in a plan, or --length and --length-name)."
            )
    return first.scaling


def differences(tables: Sequence[ForceTable], length: float) -> tuple[str, ...]:
    """What sets the campaigns of some tables apart, in words: body, Reynolds number, kind of source, point.

    Parameters
    ----------
    tables : sequence of ForceTable
        As read, about their own points.
    length : float
        m, of Reynolds numbers that follow from speed and viscosity.
    """
    first = {t.campaign: t for t in reversed(tables)}
    by = {c: first[c] for c in dict.fromkeys(t.campaign for t in tables)}
    if len(by) == 1:
        return ()
    out = []
    if len({t.body for t in by.values()}) > 1:
        out.append(f"Different bodies: {_each(by, lambda t: t.body)}.")
    rows = {c: t.reynolds(length) for c, t in by.items()}
    numbers = {c: None if at is None else float(np.median(at)) for c, at in rows.items()}
    known = [n for n in numbers.values() if n is not None]
    if len(known) < len(by):
        out.append(f"Reynolds numbers unknown: {', '.join(c for c, n in numbers.items() if n is None)}.")
    if known and max(known) > (1.0 + ALIKE) * min(known):
        out.append(f"Different Reynolds numbers: {', '.join(f'{n:.3g} ({c})' for c, n in numbers.items() if n)}.")
    if len({t.source.kind for t in by.values()}) > 1:
        out.append(f"Different kinds of source: {_each(by, lambda t: t.source.kind)}.")
    point = tables[0].reference_point
    moved = [c for c, t in by.items() if not np.allclose(t.reference_point, point, rtol=0.0, atol=1e-9)]
    if moved:
        place = ", ".join(f"{x:.6g}" for x in point)
        out.append(f"Moved to the point of {tables[0].campaign}, ({place}) m: {', '.join(moved)}.")
    return tuple(out)


def _each(by: dict[str, ForceTable], what: Callable[[ForceTable], str]) -> str:
    return ", ".join(f"{what(t)} ({c})" for c, t in by.items())

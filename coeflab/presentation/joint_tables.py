"""Campaigns of a joint fit, side by side."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.model.fit_result import FitResult
from coeflab.model.out_of_sample import OutOfSample
from coeflab.model.pooling import Pooling
from coeflab.model.table import ABSENT, Table, coefficient, number

NOT_AVAILABLE = "not available"


def campaigns(fits: Sequence[FitResult]) -> Table:
    """What every campaign adds to a joint fit, and how well the others predict it; no rows without a joint fit."""
    rows = tuple(row for f in fits for p in f.poolings for row in _rows(p))
    headers = ("", "campaign", "n", "own intercept", "95 %", "noise", "rms", "rms alone", "left out", "one law")
    notes = (
        "own intercept: force at rest, taken off the rows; noise: scatter about the campaign's own law, which weighs its "
        "rows; rms, rms alone: residuals about the joint law and about the same terms fitted to this campaign alone; left "
        "out: rms error of a campaign predicted from the others, as a share of its range, one constant of its own free; on "
        "the line of all campaigns every third point is left out; one law: Wald test by campaign (HC2, approximate "
        "Hotelling T^2).",
    )
    return Table("Campaigns of the joint fit", headers, rows, notes, frozenset({0, 1, 9}))


def _rows(p: Pooling) -> list[tuple[str, ...]]:
    out: list[tuple[str, ...]] = [
        (p.response, s.campaign, str(s.n_points), coefficient(s.intercept), coefficient(s.half_width), number(s.noise, 3),
         number(s.rms, 3), number(s.rms_alone, 3), _share(s.left_out), "")
        for s in p.shares
    ]  # fmt: skip
    n = sum(s.n_points for s in p.shares)
    whole = (sum(s.n_points * s.rms**2 for s in p.shares) / n) ** 0.5
    verdict = {None: NOT_AVAILABLE, True: f"rejected, {p.statistic}", False: p.statistic}[p.rejected]
    out.append(
        (p.response, "all", str(n), ABSENT, ABSENT, ABSENT, number(whole, 3), ABSENT, _share(p.every_third), verdict)
    )
    return out


def _share(seen: OutOfSample) -> str:
    return f"{100.0 * seen.rms:.2f} %" if seen.told else NOT_AVAILABLE

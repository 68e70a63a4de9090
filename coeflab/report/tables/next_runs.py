"""The settings whose measurement would narrow a slope most, as a table for the terminal and numbers for JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import ABSENT, Table, with_u95
from coeflab.core.texts import words as words_of
from coeflab.law.symbols import primed
from coeflab.report.tables.results import signed

if TYPE_CHECKING:
    from coeflab.fits.results.fit_result import FitResult, Sweep
    from coeflab.study.study import Study


OF_THE_SWEEP = ("random", "model form", "random and model form")  # parts of a budget that further runs narrow


def outside(fit: FitResult, sweep: Sweep) -> float:
    """95 % half-width of a slope that no further run of its sweep narrows: grid, other studies and declared inputs."""
    return fit.coefficients[sweep.symbol].parts.input or 0.0


def next_runs(study: Study, fit: FitResult, sweep: Sweep, count: int) -> tuple[tuple[float, float], ...]:
    """`Sweep.next_runs` with the whole U95; of a computed campaign distinct settings, as a solver gives the same number again."""
    kinds = {t.name: t.source.kind for t in study.tables}
    found = sweep.next_runs(count, distinct=kinds.get(sweep.table) == "cfd")
    return tuple((x, math.hypot(after, outside(fit, sweep))) for x, after in found)


def no_run_narrows(study: Study, fit: FitResult, sweeps: Sequence[Sweep]) -> list[Finding]:
    """What leads the U95 of slopes that is mostly no scatter of their sweeps, one finding for each that leads."""
    led: dict[str, list[tuple[str, float]]] = {}
    for s in sweeps:
        rest, own = outside(fit, s), s.u95 or 0.0
        if rest > own:
            held = next((b for b in study.budgets if (b.symbol, b.campaign) == (s.symbol, fit.campaign)), None)
            parts = [p for p in (held.parts if held else ()) if p.name not in OF_THE_SWEEP]
            leads = max(parts, key=lambda p: p.half_width).name if parts else "what is declared"
            led.setdefault(leads, []).append((primed(s.symbol), rest**2 / (rest**2 + own**2)))
    return [
        Finding.of(
            "budget.no_run_narrows", fit.campaign, Severity.NOTE, statistic=max(share for _, share in of), leads=leads,
            shares=tuple(f"{100.0 * share:.0f} % ({symbol})" for symbol, share in of),
        )
        for leads, of in led.items()
    ]  # fmt: skip


def next_points(study: Study, fit: FitResult, count: int, symbols: Sequence[str] = ()) -> Table:
    """The settings whose measurement would narrow every determined slope most, and its U95 after each.

    Parameters
    ----------
    study : Study
    fit : FitResult
        One of the study.
    count : int
    symbols : sequence of str
        Only of these, without prime; by default of all.
    """
    rows, angles, sides, repeats = [], [], [], False
    sweeps = [s for s in fit.sweeps if not symbols or s.symbol in symbols]
    for s in sweeps:
        now = None if s.u95 is None else math.hypot(s.u95, outside(fit, s))
        ran = [*s.x]
        for i, (x, after) in enumerate(next_runs(study, fit, s, count), 1):
            first = i == 1
            words = (primed(s.symbol), fit.campaign, *with_u95(s.value, now)) if first else ("", "", "", "")
            again = any(math.isclose(x, other, rel_tol=1e-9, abs_tol=1e-9) for other in ran)
            ran.append(x)
            repeats |= again
            over = f"asin({s.variable}/U)" if s.is_angle else f"{s.variable}'"
            angles += [s.variable] if s.is_angle else []
            sides += (
                [f"{primed(s.symbol)}, such as {signed(s, -x)}"] if first and s.one_sided and not s.symmetry else []
            )
            narrower = f"{100.0 * after / now:.1f} %" if now else ABSENT
            at = signed(s, x) + " again" * again
            rows.append((*words, str(i), over, at, with_u95(s.value, after)[1], narrower))
    headers = ("", "campaign", "value", "U95 now", "run", "over", "at", "U95 then", "of now")
    notes = [
        "One more reading at each, one after the other, at the present noise; predicted from the present fit. U95 now and then "
        "are whole: with declared inputs and grid, which stay.",
    ]
    notes += [words_of(f).statement for f in no_run_narrows(study, fit, [s for s in sweeps if s.next_runs(1)])]
    notes += [
        f"asin({v}/U) is the {name} of a file with {v} = +U sin({name}); with {v} = -U sin({name}) its sign is the other."
        for v, name in (("v", "beta"), ("w", "alpha"))
        if v in angles
    ]
    notes += ["again: a repeat of a setting that was run or stands above; it narrows the scatter only."] * repeats
    notes += (
        [
            f"All points lie on one side of zero. A run on the other would show the even part, which no line here counts: {'; '.join(sides)}."
        ]
        if sides
        else []
    )
    return Table(
        f"Next runs of {fit.campaign}", headers, tuple(rows), tuple(notes), frozenset({0, 1, 5}), ("campaign",)
    )

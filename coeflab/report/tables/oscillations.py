"""Tables of oscillating runs: every run, what amplitude explains of its damping, and how coefficients go with frequency."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coeflab.core.table import ABSENT, Table, number, percent, plus_minus, probability, with_u95
from coeflab.core.wording import finite
from coeflab.fits.planar_motion import against_steady
from coeflab.fits.results.fit_result import FitResult
from coeflab.fits.results.oscillation import Explained, Oscillation
from coeflab.law.symbols import primed
from coeflab.report.texts import table_of, text_of, texts_of

OWN = "zero amplitude"
SIGNIFICANT = 0.05


def _pair(both: tuple[float, float]) -> tuple[str, str]:
    return with_u95(finite(both[0]), finite(both[1]))


def headline(fit: FitResult) -> str:
    """The damping and the acceleration derivatives of a fit in one sentence; empty where it has none."""
    if not fit.oscillations:
        return ""
    names = [s for o in fit.oscillations for s in (o.symbol, f"{o.symbol}dot")]
    own = [fit.coefficients[s] for s in names if s[0] == {"v": "Y", "w": "Z", "p": "K", "q": "M", "r": "N"}[s[1]]]
    each = ", ".join(f"{primed(c.symbol)} = {plus_minus(c.value, c.u95)}" for c in own)
    at = "taken to zero frequency" if any(o.interval for o in fit.oscillations) else "at the frequencies of the runs"
    return f"{each} (U95; zero amplitude where runs of two and more amplitudes are; {at})."


def explained(fit: FitResult, others: Sequence[FitResult] = ()) -> Table:
    """Damping of the run of the largest amplitude against zero amplitude and against steady laws of the same body."""
    own = [o.explained() for o in fit.oscillations]
    against = [*own, *against_steady(fit, others)]
    rows = tuple(_explained(e) for e in against if e.against or np.isfinite(e.by_amplitude))
    notes = texts_of("oscillations.explained_notes", own=OWN) + (
        texts_of("oscillations.steady") if len(against) > len(own) else ()
    )
    return table_of("oscillations.explained", rows, notes if rows else (), campaign=fit.campaign)


def _explained(e: Explained) -> tuple[str, ...]:
    half = finite(e.measured[1])
    whole = e.difference
    share = ABSENT if np.isnan(e.by_amplitude) else with_u95(e.by_amplitude, half)[0]
    if not np.isnan(e.by_amplitude) and abs(whole) > e.measured[1]:
        share += f" ({percent(e.by_amplitude, whole)})" if e.by_amplitude * whole > 0.0 else ""
    return (
        primed(e.symbol), e.against or OWN, number(e.amplitude, 3), *_pair(e.measured), with_u95(e.slope[0], half)[0],
        with_u95(whole, half)[0], share, *_pair((e.rest[0], e.rest[1] if e.against else float("nan"))),
    )  # fmt: skip


def runs(fit: FitResult) -> tuple[Table, ...]:
    """Equivalent linear coefficients of every run, one table a component and motion."""
    return tuple(_runs(o) for o in fit.oscillations)


def _runs(o: Oscillation) -> Table:
    rows = tuple(
        (
            r.label + ("" if r.used else " (not used)"), number(r.amplitude, 3), number(r.frequency, 3), f"{r.cycles:.3g}",
            number(r.drift, 2) if abs(r.drift) > 1e-9 else ABSENT, *_pair(r.damping), *_pair(r.inertia),
            *(percent(float(s), float(r.sizes[0])) if r.sizes[0] > 0.0 else ABSENT for s in r.sizes[1:3]),
        )
        for r in o.runs
    )  # fmt: skip
    symbol = primed(o.symbol)
    more = ("2nd", "3rd")[: max(len(o.runs[0].sizes) - 1, 0)]
    mean = "w'" if o.motion in ("heave", "pitch") else "v'"
    rate = primed(f"{o.symbol}dot")
    headers = (
        "run",
        f"{o.variable}'",
        "omega'",
        "cycles",
        f"mean {mean}",
        symbol,
        f"U95 of {symbol}",
        rate,
        f"U95 of {rate}",
        *more,
    )
    notes = (text_of("oscillations.runs"),)
    return Table(f"{o.motion.capitalize()} runs: {symbol} and {rate}", headers, rows, notes)


def over_frequency(fit: FitResult) -> Table:
    """Slopes of the coefficients over frequency, where the runs vary it."""
    rows = []
    for o in fit.oscillations:
        for symbol, at in ((o.symbol, o.damping), (f"{o.symbol}dot", o.inertia)):
            slope, half, p = at.frequency
            if np.isnan(slope):
                continue
            low, high = (f(r.frequency for r in o.used) for f in (min, max))
            seen = "not known" if np.isnan(p) else "goes with frequency" if p < SIGNIFICANT else "no trend seen"
            cells = *_pair((slope, half)), ABSENT if np.isnan(p) else probability(p)
            rows.append((primed(symbol), f"{number(low, 3)} to {number(high, 3)}", *cells, seen))
    return table_of("oscillations.over_frequency", rows, campaign=fit.campaign)

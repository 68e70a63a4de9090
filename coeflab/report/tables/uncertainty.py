"""Intervals of figures, where they come from, and which test takes most off, as tables and in words.

Uncertainty budgets, grid studies, validations and derived quantities, as tables to be shown.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import ABSENT, Table, coefficient, number, percent, with_u95
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.wording import collected, listed
from coeflab.fits.uncertainty.budget import COUPLED
from coeflab.law.friction_line import FRICTION_APART
from coeflab.law.symbols import primed
from coeflab.motion.uncertainty.tests import tests_of
from coeflab.report.tables.motion import DEGREES
from coeflab.report.texts import table_of, text_of
from coeflab.study.validation import AS_PRINTED, WIDE

if TYPE_CHECKING:
    from coeflab.fits.results.fitted_model import FittedModel
    from coeflab.fits.uncertainty.budget import Budget
    from coeflab.motion.uncertainty.spread import Importance, Spread
    from coeflab.motion.uncertainty.uncertainty import Carried
    from coeflab.study.validation import Validation
    from coeflab.vehicle.stability import Derived

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


UNITS = {"angle": "rad", "reference point": "m"}
READ = ("angle", "rate", "speed", "force", "moment", "length", "density", "reference point", COUPLED)
SET = (
    "angle",
    "speed",
    "length",
    "density",
    "reference point",
    "rate",
    COUPLED,
)  # in a computation: no errors of readings


def sentences_on_open(names: Iterable[str], *, what: str = "Not in U95") -> list[str]:
    """What an uncertainty leaves out, in a sentence that begins so; none where nothing is open.

    Parameters
    ----------
    names : iterable of str
        As in `Budget.unassessed`.
    what : str
    """
    left = list(dict.fromkeys(names))
    read = [n.removeprefix("error of ") for n in left if n in READ]
    words = [*([f"errors of {listed(read)}"] if read else []), *(n for n in left if n not in READ)]
    return [f"{what}: {'; '.join(words)}."] if words else []


def overview(budgets: Sequence[Budget]) -> Table:
    """One row a coefficient: U95 and the share of every part; a dash is a part that was not assessed."""
    names = list(dict.fromkeys(p.name for b in budgets for p in b.parts))
    rows = []
    for b in budgets:
        shares = {p.name: _share(p.share) for p in b.parts}
        rows.append(
            (
                primed(b.symbol), b.campaign, *with_u95(b.value, b.u95), percent(b.u95, b.value),
                *(shares.get(n, ABSENT) for n in names), "; ".join(b.unassessed) or ABSENT,
            )
        )  # fmt: skip
    headers = ("", "campaign", "value", "U95", "U95 %", *names, "not assessed")
    notes = (text_of("uncertainty.parts"),)
    return Table("Uncertainty budgets", headers, tuple(rows), notes, frozenset({0, 1, len(headers) - 1}))


def _share(share: float | None) -> str:
    return ABSENT if share is None else f"{100.0 * share:.1f} %"


def _size(b: Budget, half: float | None) -> tuple[str, str]:
    """A half-width in the digits that go with the value, and over it."""
    return with_u95(b.value, half)[1], percent(half, b.value)


def budget(b: Budget) -> Table:
    """Every part of one coefficient."""
    sensitivity = {p.name.replace("_", " "): p for p in b.inputs}
    rows = []
    for part in b.parts:
        given = sensitivity.get(part.name)
        unit = _unit(given.name) if given else ""
        of_input = (f"{number(given.half_width, 3)} {unit}", number(given.sensitivity)) if given else (ABSENT, ABSENT)
        rows.append((part.name, *of_input, *_size(b, part.half_width), _share(part.share)))
    rows.append(("U95", ABSENT, ABSENT, *_size(b, b.u95), ABSENT if b.u95 is None else "100 %"))
    notes = []
    if b.monte_carlo is not None:
        m = b.monte_carlo
        notes.append(
            text_of(
                "uncertainty.monte_carlo",
                linear=coefficient(m.linear),
                monte_carlo=coefficient(m.monte_carlo),
                draws=m.draws,
                seed=m.seed,
            )
        )
    if b.grid is not None:
        c = b.grid.convergence
        notes.append(
            text_of(
                "uncertainty.grid",
                component=b.grid.component,
                setting=b.grid.setting,
                names=", ".join(map(str, b.grid.cells)),
                cells_used=b.grid.cells_used,
                statement=c.statement,
            )
        )
    notes += [f"{s.component} at {s.setting}, {s.statement}: 95 % {percent(s.half_width, s.used)}." for s in b.studies]
    notes.append(f"Not assessed: {', '.join(b.unassessed) or 'nothing known'}.")
    return table_of("uncertainty.budget", rows, notes, symbol=primed(b.symbol), campaign=b.campaign)


def _unit(name: str) -> str:
    """Unit of the half-width of an input: ``angle beta`` is an angle, ``reference point`` a length."""
    return next((unit for kind, unit in UNITS.items() if name.replace("_", " ").startswith(kind)), "-")


def shared(model: FittedModel) -> Table:
    """What the half-widths of a fitted model hold beside the scatter; no rows where nothing."""
    names = tuple(model.shared)
    forms = np.zeros(len(model.terms)) if model.remainder is None else model.remainder.half_width
    columns = (
        model.fit.coefficients,
        model.half_width,
        model.fit.half_width,
        forms,
        *(abs(model.shared[n]) for n in names),
    )
    rows = tuple(
        (symbol, *(coefficient(float(values[i])) for values in columns))
        for i, symbol in enumerate(model.symbols)
        if names
    )
    headers = ("", "value", "95 %", "random", "form", *names)
    notes = (f"Not assessed: {'; '.join(model.not_assessed) or 'nothing known'}.",)
    return Table(f"{model.response} of {model.campaign}: parts of the half-widths", headers, rows, notes)


def grids(budgets: Sequence[Budget]) -> Table:
    """Every grid study once, finest grid first."""
    found = {(g.table, g.component): g for b in budgets if (g := b.grid) is not None}
    rows = tuple(
        (
            g.component,
            g.setting,
            ", ".join(map(str, g.cells)),
            ", ".join(number(v, 5) for v in g.convergence.values),
            number(g.convergence.order, 3),
            number(g.convergence.extrapolated if g.convergence.order is not None else None, 5),
            number(g.convergence.safety, 3),
            number(g.convergence.half_width, 3),
            percent(g.convergence.half_width, g.convergence.values[g.convergence.used]),
            g.convergence.convergence.value,
        )
        for g in found.values()
    )
    words = tuple(f"{g.component} at {g.setting}: {g.convergence.statement}." for g in found.values())
    return table_of("uncertainty.grids", rows, words)


def studies(budgets: Sequence[Budget]) -> Table:
    """Every study of the domain, the turbulence model and the iterations once."""
    found = {(s.name, s.table, s.component, s.setting): s for b in budgets for s in b.studies}
    rows = tuple(
        (
            s.name if i == 0 else "", s.component if i == 0 else "", s.setting if i == 0 else "", what,
            number(value, 5), percent(value - s.used, s.used), percent(s.half_width, s.used) if i == 0 else "",
        )
        for s in found.values()
        for i, (what, value) in enumerate((("in use", s.used), *s.changed))
    )  # fmt: skip
    return table_of("uncertainty.studies", rows)


def validation(found: Sequence[Validation]) -> Table:
    """Comparison error against validation uncertainty, ASME V&V 20."""
    verdicts = {True: "|E| < U_V", False: "|E| > U_V", None: "no verdict"}
    rows = tuple(
        (
            primed(v.symbol), v.simulation, v.experiment.removesuffix(AS_PRINTED), coefficient(v.computed), coefficient(v.measured),
            coefficient(v.error), coefficient(v.u_measured), coefficient(v.u_numerical), coefficient(v.u_reduction),
            coefficient(v.u_input), coefficient(v.u_validation), verdicts[v.within],
        )
        for v in found
    )  # fmt: skip
    return table_of("uncertainty.validation", rows, (f"{primed(v.symbol)}: {v.statement}." for v in found))


def _in_digits(value: float, half: float | None) -> str:
    """In the digits that go with a half-width; of a value that they do not show, two of its own."""
    return number(value, 2) if half and abs(value) < 0.01 * half else with_u95(value, half)[0]


def predictions(found: Sequence[Validation]) -> Table:
    """Comparison error of every computed coefficient, those with a verdict first, in digits that go with U_V."""
    rows = tuple(
        (
            primed(v.symbol), v.simulation, v.experiment.removesuffix(AS_PRINTED), _in_digits(v.computed, v.u_validation), with_u95(v.measured, v.u_validation)[0],
            *with_u95(v.error, v.u_validation), _verdict(v),
        )
        for v in sorted(found, key=lambda v: v.within is None)
    )  # fmt: skip
    weak = f" weak: U_V exceeds {100.0 * WIDE:.0f} % of D." if any(v.weak for v in found) else ""
    printed = " For a test by another method, D is the printed value." if any(v.method for v in found) else ""
    return table_of("uncertainty.predictions", rows, printed=printed, weak=weak, friction_apart=100.0 * FRICTION_APART)


def _verdict(v: Validation) -> str:
    """In words; a weak one with what makes it so."""
    if v.within is None:
        return "no verdict"
    return f"weak: U_V is {v.share} of D" if v.weak else "within U_V" if v.within else "beyond U_V"


def derived(found: Sequence[Derived]) -> Table:
    """Centres of pressure and stability indices, linear and Monte Carlo half-widths side by side."""
    rows = tuple(
        (
            d.name,
            d.subject,
            *(with_u95(d.value, d.result.linear) if d.result else (number(d.value), ABSENT)),
            number(d.result.monte_carlo if d.result else None, 2),
            f"{number(d.result.low)} .. {number(d.result.high)}" if d.result else ABSENT,
            d.statement,
        )
        for d in found
    )
    return table_of("uncertainty.derived", rows)

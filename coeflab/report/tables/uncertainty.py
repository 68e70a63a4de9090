"""Intervals of figures, where they come from, and which test takes most off, as tables and in words.

Uncertainty budgets, grid studies, validations and derived quantities, as tables to be shown.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from coeflab.core.table import ABSENT, Table, coefficient, number, percent, with_u95
from coeflab.core.text.csv_rows import csv_text
from coeflab.core.wording import listed
from coeflab.fits.uncertainty.budget import COUPLED
from coeflab.law.friction_line import FRICTION_APART
from coeflab.law.symbols import primed
from coeflab.motion.uncertainty.tests import tests_of
from coeflab.report.tables.motion import DEGREES
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
        notes.append(f"Beyond the data: {', '.join(beyond)}. The interval does not contain the error of extrapolating.")
    q = carried.question
    notes.append(
        f"{q.members} members, seed {q.seed}; percentiles 2.275 and 97.725 (two standard uncertainties to both sides); "
        "+-: standard error of the ends for so many members."
    )
    headers = (
        "quantity",
        "value",
        "unit",
        "median",
        "95 % interval",
        "low +-",
        "high +-",
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
    headers = ("group", "from", "first", "U95 of first", "total", "U95 of total")
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


def tests_table(carried: Carried) -> Table:
    """Which test takes most off the variance of the manoeuvre's figures, the first first; without rows where nothing varies."""
    having = [i for i in carried.importances if i.tests and (i.figure in carried.names or not carried.names)]
    mean: dict[str, float] = {}
    for name, share in (p for i in having for p in i.tests):
        mean[name] = mean.get(name, 0.0) + share / len(having)
    gives = tests_of(carried.varied.symbols)
    rows = tuple(
        (
            name,
            _some(gives[name]),
            f"{100.0 * share:.0f} %",
            f"{sum(i.tests[0][0] == name for i in having)} of {len(having)}",
        )
        for name, share in sorted(mean.items(), key=lambda p: -p[1])
        if share >= SMALL
    )
    notes = (
        f"Mean share in the variance of {_counted(len(having))} that would go if the test gave all these exactly; most of: figures that it takes most off. Coefficients of one estimate or "
        "fit go together, so that the shares may add up to more than 100 %.",
    )
    headers = ("test", "gives", "takes off", "most of")
    return Table("Which test takes most off", headers, rows, notes if rows else (), frozenset({0, 1}))


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


def sentences_on_open(names: Iterable[str], *, computed: bool = False, what: str = "Not in U95") -> list[str]:
    """What an uncertainty leaves out, as sentences; none where nothing is open.

    Parameters
    ----------
    names : iterable of str
        As in `Budget.unassessed`.
    computed : bool
        Of a computation, whose conditions are set and have no errors of readings.
    what : str
        How the sentence begins.
    """
    left = list(dict.fromkeys(names))
    fixed = [n for n in left if computed and n in SET]
    rest = [n for n in left if n not in fixed]
    read = [n.removeprefix("error of ") for n in rest if n in READ]
    others = [n for n in rest if n not in READ]
    words = [*([f"errors of {listed(read)}"] if read else []), *others]
    out = [f"{what}: {'; '.join(words)}."] if words else []
    known = [n for n in fixed if n != COUPLED]
    return [*out, f"In CFD these are prescribed and carry no measurement error: {listed(known)}."] if known else out


def overview(budgets: Sequence[Budget]) -> Table:
    """One row a coefficient: U95 and the share of every part; a dash is a part that was not assessed."""
    names = list(dict.fromkeys(p.name for b in budgets for p in b.parts))
    rows = []
    for b in budgets:
        shares = {p.name: ABSENT if p.share is None else f"{100.0 * p.share:.1f} %" for p in b.parts}
        rows.append(
            (
                primed(b.symbol), b.campaign, *with_u95(b.value, b.u95), percent(b.u95, b.value),
                *(shares.get(n, ABSENT) for n in names), "; ".join(b.unassessed) or ABSENT,
            )
        )  # fmt: skip
    headers = ("", "campaign", "value", "U95", "U95 %", *names, "not assessed")
    notes = (
        "Columns of parts: share of the variance. U95: root sum of squares of the parts, taken as independent. A dash: "
        "not assessed or not acting, never zero.",
    )
    return Table("Uncertainty budgets", headers, tuple(rows), notes, frozenset({0, 1, len(headers) - 1}))


def budget(b: Budget) -> Table:
    """Every part of one coefficient."""
    sensitivity = {p.name.replace("_", " "): p for p in b.inputs}
    rows = []
    for part in b.parts:
        given = sensitivity.get(part.name)
        unit = _unit(given.name) if given else ""
        rows.append(
            (
                part.name,
                number(given.half_width, 3) + f" {unit}" if given else ABSENT,
                number(given.sensitivity, 4) if given else ABSENT,
                with_u95(b.value, part.half_width)[1],
                percent(part.half_width, b.value),
                ABSENT if part.share is None else f"{100.0 * part.share:.1f} %",
            )
        )
    rows.append(
        (
            "U95",
            ABSENT,
            ABSENT,
            with_u95(b.value, b.u95)[1],
            percent(b.u95, b.value),
            ABSENT if b.u95 is None else "100 %",
        )
    )
    notes = []
    if b.monte_carlo is not None:
        m = b.monte_carlo
        notes.append(
            f"All inputs: linear {coefficient(m.linear)}, Monte Carlo {coefficient(m.monte_carlo)} ({m.draws} draws, seed "
            f"{m.seed}); curve held fixed."
        )
    if b.grid is not None:
        c = b.grid.convergence
        notes.append(
            f"Grid: {b.grid.component} at {b.grid.setting} on {', '.join(map(str, b.grid.cells))} cells, "
            f"{b.grid.cells_used} in use: {c.statement}. Its relative half-width is taken for the coefficient."
        )
    notes += [f"{s.component} at {s.setting}, {s.statement}: 95 % {percent(s.half_width, s.used)}." for s in b.studies]
    notes.append(f"Not assessed: {', '.join(b.unassessed) or 'nothing known'}.")
    headers = ("part", "half-width of the input", "sensitivity", "95 %", "of the value", "of the variance")
    return Table(f"Budget of {primed(b.symbol)}, {b.campaign}", headers, tuple(rows), tuple(notes), frozenset({0}))


def _unit(name: str) -> str:
    """Unit of the half-width of an input: ``angle beta`` is an angle, ``reference point`` a length."""
    return next((unit for kind, unit in UNITS.items() if name.replace("_", " ").startswith(kind)), "-")


def shared(model: FittedModel) -> Table:
    """What the half-widths of a fitted model hold beside the scatter; no rows where nothing."""
    names = tuple(model.shared)
    forms = [0.0] * len(model.terms) if model.remainder is None else model.remainder.half_width
    rows = tuple(
        (
            symbol,
            coefficient(float(value)),
            coefficient(float(whole)),
            coefficient(float(scatter)),
            coefficient(float(form)),
            *(coefficient(abs(float(model.shared[n][i]))) for n in names),
        )
        for i, (symbol, value, whole, scatter, form) in enumerate(
            zip(model.symbols, model.fit.coefficients, model.half_width, model.fit.half_width, forms, strict=True)
        )
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
    headers = (
        "", "setting", "cells", "values", "order", "extrapolated", "factor", "U95", "U95 %", "convergence",
    )  # fmt: skip
    words = tuple(f"{g.component} at {g.setting}: {g.convergence.statement}." for g in found.values())
    notes = ("Half-widths are those of the grid in use. SI units.", *words)
    return Table("Grid convergence", headers, rows, notes, frozenset({0, 1, 2, 3, 9}))


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
    headers = ("study", "", "setting", "", "value", "apart", "95 %")
    notes = (
        "One thing changed at a time. 95 %: 2 / sqrt 3 of the largest distance, at least of the iteration noise.",
        "U95 holds domain and iterations. The spread of turbulence models is an error of the model and stands beside U95 and U_V.",
    )
    return Table("Studies of domain, turbulence model and iterations", headers, rows, notes, frozenset({0, 1, 2, 3}))


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
    headers = (
        "", "computed", "measured", "S", "D", "E = S - D", "U_D", "U_SN", "U_red", "U_input", "U_V", "verdict",
    )  # fmt: skip
    notes = (
        "U_SN: grid, domain, iterations and their noise; U_red: form of the curve drawn through computed points; a dash: "
        "not assessed. E also holds the difference of Reynolds number and rig between both.",
        *(f"{primed(v.symbol)}: {v.statement}." for v in found),
    )
    return Table("Validation of the computation", headers, rows, notes, frozenset({0, 1, 2, 11}))


def _beside(value: float, half: float | None) -> str:
    """In the digits that go with a half-width; of a value that they do not show, two of its own."""
    return number(value, 2) if half and abs(value) < 0.01 * half else with_u95(value, half)[0]


def predictions(found: Sequence[Validation]) -> Table:
    """Comparison error of every computed coefficient, those with a verdict first, in digits that go with U_V."""
    rows = tuple(
        (
            primed(v.symbol), v.simulation, v.experiment.removesuffix(AS_PRINTED), _beside(v.computed, v.u_validation), with_u95(v.measured, v.u_validation)[0],
            *with_u95(v.error, v.u_validation), _verdict(v),
        )
        for v in sorted(found, key=lambda v: v.within is None)
    )  # fmt: skip
    headers = ("", "CFD campaign", "test campaign", "S, CFD", "D, test", "E = S - D", "U_V", "verdict")
    weak = f" weak: U_V exceeds {100.0 * WIDE:.0f} % of D." if any(v.weak for v in found) else ""
    printed = " For a test by another method, D is the printed value." if any(v.method for v in found) else ""
    notes = (
        f"S is computed and D is measured, independently, on the same body. D is our fit to the points of the test.{printed} E is formed before "
        f"rounding. U_V: root sum of squares of the uncertainties of S and D. If |E| < U_V, the comparison cannot reveal a modelling error.{weak}",
        "There is no verdict if the grid error is not estimated, the test used another method, symmetry makes the value zero, or, for drag, friction at "
        f"the two Reynolds numbers differs by over {100.0 * FRICTION_APART:.0f} %.",
    )
    return Table("Predictions by CFD against tests", headers, rows, notes, frozenset({0, 1, 2, 7}))


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
    headers = ("", "subject", "value", "95 % linear", "95 % Monte Carlo", "percentiles", "")
    return Table("Centre of pressure and stability with the budgets", headers, rows, (), frozenset({0, 1, 6}))

"""Uncertainty budgets, grid studies, validations and derived quantities, as tables to be shown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from coeflab.core.table import ABSENT, Table, coefficient, number, percent, with_u95
from coeflab.core.wording import listed
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.uncertainty.budget import COUPLED, Budget
from coeflab.law.friction_line import FRICTION_APART
from coeflab.law.symbols import primed
from coeflab.report.texts import table_of, text_of
from coeflab.study.validation import AS_PRINTED, WIDE, Validation
from coeflab.vehicle.stability import Derived

UNITS = {"angle": "rad", "reference point": "m"}
READ_IN_A_TEST = ("angle", "rate", "speed", "force", "moment", "length", "density", "reference point", COUPLED)
SET_IN_A_COMPUTATION = (
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
    read = [n.removeprefix("error of ") for n in left if n in READ_IN_A_TEST]
    words = [*([f"errors of {listed(read)}"] if read else []), *(n for n in left if n not in READ_IN_A_TEST)]
    return [f"{what}: {'; '.join(words)}."] if words else []


def grid_of_some(name: str, among: Sequence[Budget] | Sequence[Validation], some: bool) -> str:
    """A part that was not assessed; the grid with its symbols where it is in the uncertainty of the others.

    Parameters
    ----------
    name : str
        As in `Budget.unassessed`.
    among : sequence of Budget or Validation
    some : bool
        Whether it is.
    """
    having = [one for one in among if one.open_grid is not None and one.open_grid.name == name]
    if not having or not some:
        return name
    grid = having[0].open_grid
    state = f" ({grid.reason})" if grid is not None and grid.study is not None else ""
    return f"grid, for {listed([primed(one.symbol) for one in having])}{state}"


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


def model_parts(model: FittedModel) -> Table:
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


def variant_studies(budgets: Sequence[Budget]) -> Table:
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


def predictions(found: Sequence[Validation]) -> Table:
    """Comparison error of every computed coefficient, those with a verdict first, in digits that go with U_V."""
    rows = tuple(
        (
            primed(v.symbol), v.simulation, v.experiment.removesuffix(AS_PRINTED), number(v.computed, 2) if v.u_validation and abs(v.computed) < 0.01 * v.u_validation else with_u95(v.computed, v.u_validation)[0], with_u95(v.measured, v.u_validation)[0],
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

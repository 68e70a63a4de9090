"""Uncertainty budgets, grid studies, validations and derived quantities, as tables to be shown."""

from __future__ import annotations

from collections.abc import Sequence

from coeflab.core.table import ABSENT, Table, coefficient, number, percent, with_u95
from coeflab.fits.results.fitted_model import FittedModel
from coeflab.fits.uncertainty.budget import Budget
from coeflab.law.symbols import primed
from coeflab.study.validation import Validation
from coeflab.vehicle.derived import Derived

UNITS = {"angle": "rad", "reference point": "m"}


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
    headers = ("", "campaign", "value", "U95", "U95", *names, "not assessed")
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
        "", "setting", "cells", "values", "order", "extrapolated", "factor", "95 %", "95 %", "convergence",
    )  # fmt: skip
    said = tuple(f"{g.component} at {g.setting}: {g.convergence.statement}." for g in found.values())
    notes = ("Half-widths are those of the grid in use. SI units.", *said)
    return Table("Grid convergence", headers, rows, notes, frozenset({0, 1, 2, 3, 9}))


def validation(found: Sequence[Validation]) -> Table:
    """Comparison error against validation uncertainty, ASME V&V 20."""
    verdicts = {True: "|E| < U_V", False: "|E| > U_V", None: "no verdict"}
    rows = tuple(
        (
            primed(v.symbol), v.simulation, v.experiment, coefficient(v.computed), coefficient(v.measured),
            coefficient(v.error), coefficient(v.u_measured), coefficient(v.u_numerical), coefficient(v.u_reduction),
            coefficient(v.u_input), coefficient(v.u_validation), verdicts[v.within],
        )
        for v in found
    )  # fmt: skip
    headers = (
        "", "computed", "measured", "S", "D", "E = S - D", "U_D", "U_SN", "U_red", "U_input", "U_V", "verdict",
    )  # fmt: skip
    notes = (
        "U_SN: grid and iteration noise; U_red: form of the curve drawn through computed points; a dash: "
        "not assessed. E also holds the difference of Reynolds number and rig between both.",
        *(f"{primed(v.symbol)}: {v.statement}." for v in found),
    )
    return Table("Validation of the computation", headers, rows, notes, frozenset({0, 1, 2, 11}))


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

"""Own tows beside published columns: every wanted coefficient of each towed body, a missing one with its reason.

A verdict by ASME V&V 20 needs one body and one method on both sides: tests of the very body that was towed, at steady angles.
Against another body, or derivatives from an oscillation, E and U_V are given and no verdict; nor is there one on a tow
without a grid study, whose numerical error is not known.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from coeflab.core.types import brief
from coeflab.core.wording import listed
from coeflab.law.coefficient import Coefficient, Status
from coeflab.law.symbols import ANGULAR, LINEAR, derivative, primed
from coeflab.study.lines import line
from coeflab.study.secants import secant
from coeflab.study.validation import Validation, against_printed, reynolds_of, validation
from coeflab.tables.campaign import FOURFOLD
from coeflab.tables.force_table import AT_REST, ForceTable
from coeflab.vehicle.published_values import Reference, Relation

if TYPE_CHECKING:
    from coeflab.fits.results.fit_result import FitResult
    from coeflab.fits.uncertainty.budget import Budget
    from coeflab.law.scaling import Scaling
    from coeflab.study.study import PlannedTow, Study

# A quarter of a turn about x: v -> w, Y -> Z, N -> -M, r -> -q.
TURNED = {"Zw": ("Yv", 1.0), "Mw": ("Nv", -1.0), "Zq": ("Yr", -1.0), "Mq": ("Nr", 1.0)}
SECANT = "secant of one setting"
NO_RESULT, FORCES_OF_SIX = 0.4, "YZMN"  # U95 over the value, from which Yr' and its like are no result
NOT_TOWED, NOT_RUN, OPEN = "not towed", "not run", "open"
RUNS = {"": "straight", "v": "drift", "w": "attack", "p": "rolling", "q": "pitching", "r": "turning"}
STATES = {"unconverged": "did not converge", "not run": "not started", "drifting": "still drifting"}


@brief
@dataclass(frozen=True, slots=True)
class TowedRow:
    """One coefficient of a towed body.

    Attributes
    ----------
    symbol : str
    coefficient : Coefficient or None
        None where the tow gives none.
    u_grid : float or None
        95 % half-width by the grid study; None without one.
    missing : str
        ``not towed``, ``not run`` or ``open`` in the place of a value; empty with one.
    why : str
        What is missing or left out, or by which symmetry the value is stated; empty where there is nothing to say.
    published : tuple of float or None
        In the order of the columns, primed by our length; None where a column has no such value.
    validation : Validation or None
        Against the experiment; None where it has no such value, or the row is stated by symmetry.
    verdict : bool or None
        Whether |E| lies within U_V; None where no verdict can be given.
    why_none : str
        Why not.
    reasons : tuple of str
        The same as clauses of a sentence, where there is a comparison error.
    line : float or None
        By the estimator of the steady-CFD study, `coeflab.study.lines`.
    model : float or None
        How far other turbulence models move the value, 95 % half-width, beside U95; None where none was tried.
    no_grid : str
        Why U95 leaves the grid out: ``no grid study``, ``grid study divergent``; empty where it holds it.
    is_turned : bool
        Whether fourfold symmetry sets it equal to another one.
    varies : str
        Motion that no run varies, or too few, where there is no value; empty for straight runs.
    """

    symbol: str
    coefficient: Coefficient | None
    u_grid: float | None
    missing: str
    why: str
    published: tuple[float | None, ...]
    validation: Validation | None = None
    verdict: bool | None = None
    why_none: str = ""
    no_grid: str = ""
    reasons: tuple[str, ...] = ()
    line: float | None = None
    model: float | None = None
    is_turned: bool = False
    varies: str = ""

    @property
    def is_result(self) -> bool:
        """Whether a derivative over a rate is known well enough to be one: U95 at most `NO_RESULT` of it."""
        over_rate = self.symbol[1:] in ANGULAR and self.symbol[0] in FORCES_OF_SIX
        return not (over_rate and self.value is not None and self.u95 and self.u95 > NO_RESULT * abs(self.value))

    @property
    def value(self) -> float | None:
        """Primed."""
        return None if self.coefficient is None else self.coefficient.value

    @property
    def u95(self) -> float | None:
        """95 % half-width; None where there is none."""
        return None if self.coefficient is None else self.coefficient.u95


@brief
@dataclass(frozen=True, slots=True)
class Towed:
    """A towed body.

    Attributes
    ----------
    tow : PlannedTow
    body : str
        As its campaign names it; the plan's where there is none.
    columns : tuple of str
        Names of the published columns.
    rows : tuple of TowedRow
        One a wanted coefficient.
    turned : tuple of str
        Which of its tables are no runs but others turned by symmetry, in sentences.
    reynolds : float or None
        On the length of the primes; None where the campaign does not tell, or there is none.
    """

    tow: PlannedTow
    body: str
    columns: tuple[str, ...]
    rows: tuple[TowedRow, ...]
    turned: tuple[str, ...] = ()
    reynolds: float | None = None


def towed(study: Study) -> tuple[Towed, ...]:
    """Every planned tow, whether it was carried out or not."""
    return tuple(_towed(study, tow) for tow in study.plan.tows)


def _towed(study: Study, tow: PlannedTow) -> Towed:
    by_name = {r.name: r for r in study.references}
    columns = tuple(by_name[name] for name in tow.columns if name in by_name)
    tests = tuple(by_name[name] for name in tow.experiment if name in by_name)
    fits = tuple(f for f in study.fits if f.campaign == tow.campaign)
    body = fits[0].body if fits else tow.body
    rows = tuple(
        replace(
            _row(study, tow, symbol, fits, columns, tests), line=_line(study, tow, symbol, fits),
            model=None if (budget := _budget(study, tow.campaign, _source(study, tow, symbol)[0])) is None else budget.model_spread,
        )
        for symbol in study.plan.wanted
    )  # fmt: skip
    length = fits[0].coefficients.scaling.length if fits else None
    reynolds = None if length is None else reynolds_of(study, tow.campaign, length)
    names = tuple(f"{c.name}, as quoted" if c.relation is Relation.QUOTED else c.name for c in columns)
    return Towed(tow, body, names, rows, _turned(_tables(study, tow.campaign)), reynolds)


def _turned(tables: tuple[ForceTable, ...]) -> tuple[str, ...]:
    """Which tables are no runs, in one sentence; none without any."""
    copies = [(t.name.rpartition("/")[2], t.by_symmetry.rpartition("/")[2]) for t in tables if t.by_symmetry]
    if not copies:
        return ()
    own, sources = (listed(names) for names in zip(*copies, strict=True))
    verb = "is" if len(copies) == 1 else "are"
    return (f"{own}, in the vertical plane, {verb} {sources} rotated by 90 deg about x: no runs of their own.",)


def _row(
    study: Study,
    tow: PlannedTow,
    symbol: str,
    fits: tuple[FitResult, ...],
    columns: tuple[Reference, ...],
    tests: tuple[Reference, ...],
) -> TowedRow:
    scaling = fits[0].coefficients.scaling if fits else study.plan.scaling
    published = tuple(_published(study, fits, r, symbol, scaling) for r in columns)
    fourfold = tow.fourfold or any(FOURFOLD in t.symmetry for t in _tables(study, tow.campaign))
    source, sign = TURNED.get(symbol, ("", 1.0)) if fourfold else ("", 1.0)
    own = _coefficient(fits, source or symbol)
    budget = _budget(study, tow.campaign, source or symbol)
    u_grid = None if budget is None else budget.part("grid")
    no_grid = "" if budget is None or budget.open_grid is None else budget.open_grid.reason
    if own is None or own.value is None:
        missing, why = _missing(study, tow, source or symbol, own)
        one = secant(_tables(study, tow.campaign), source or symbol, scaling) if missing == OPEN and scaling else None
        if one is None or one.value is None:
            return TowedRow(symbol, None, u_grid, missing, why, published, varies=_variable(source or symbol))
        if source:
            one = replace(one, symbol=symbol, value=sign * one.value)
        return TowedRow(symbol, one, u_grid, "", f"{SECANT}; {why}", published, why_none=SECANT, no_grid=no_grid)
    if source:
        turned = replace(own, symbol=symbol, value=sign * own.value)
        equal = f"{'-' if sign < 0.0 else ''}{primed(source)}"
        why, none = f"set equal to {equal} by fourfold symmetry", f"as {primed(source)}"
        return TowedRow(symbol, turned, u_grid, "", why, published, why_none=none, no_grid=no_grid, is_turned=True)
    why = _left_out(study, tow.campaign, symbol)
    result = None if budget is None else _against(study, budget, own, fits, tests)
    if result is None:
        lacking = "no budget" if budget is None else "no test of it" if tests else ""
        return TowedRow(symbol, own, u_grid, "", why, published, why_none=lacking, no_grid=no_grid)
    found, others = result
    none = "; ".join(filter(None, (*others, found.why_none)))
    verdict = None if none else found.within
    reasons = (*others.values(), *found.reasons)
    return TowedRow(symbol, own, u_grid, "", why, published, found, verdict, none, no_grid, reasons)


def _line(study: Study, tow: PlannedTow, symbol: str, fits: tuple[FitResult, ...]) -> float | None:
    """By one line through all points; of a body that a quarter of a turn leaves as it is from the runs that were made."""
    tables = _tables(study, tow.campaign)
    if not fits or not tables:
        return None
    source, sign = _source(study, tow, symbol)
    found = line(tables, source, fits[0].coefficients.scaling.length)
    return None if found is None else sign * found


def _source(study: Study, tow: PlannedTow, symbol: str) -> tuple[str, float]:
    """The derivative that was run, and its sign in this one."""
    turned = tow.fourfold or any(FOURFOLD in t.symmetry for t in _tables(study, tow.campaign))
    return TURNED.get(symbol, (symbol, 1.0)) if turned else (symbol, 1.0)


def _coefficient(fits: tuple[FitResult, ...], symbol: str) -> Coefficient | None:
    """Of the first fit that gives it a value, else of the first that knows it."""
    known = [f.coefficients[symbol] for f in fits if symbol in f.coefficients]
    return next((c for c in known if c.value is not None), known[0] if known else None)


def _budget(study: Study, campaign: str, symbol: str) -> Budget | None:
    return next((b for b in study.budgets if (b.campaign, b.symbol) == (campaign, symbol)), None)


def _published(
    study: Study, fits: tuple[FitResult, ...], reference: Reference, symbol: str, scaling: Scaling | None
) -> float | None:
    """A printed value about our reference point and by our length, read as printed; from PMM where it is no other."""
    point = fits[0].coefficients.reference_point if fits else study.plan.reference_point
    elsewhere = reference.reference_point is not None and (
        point is None or not np.allclose(reference.reference_point, point, atol=1e-6)
    )
    if scaling is None or elsewhere:
        return None
    read = reference.readings(symbol, scaling)
    if read:
        return read[0][1]
    stated = reference.printed_by_any_method(symbol)
    value = None if stated is None else stated.value
    return None if value is None else value * reference.scaling.ratio(symbol, scaling)


def _against(
    study: Study, budget: Budget, own: Coefficient, fits: tuple[FitResult, ...], tests: tuple[Reference, ...]
) -> tuple[Validation, dict[str, str]] | None:
    """The comparison with the first test that has the derivative, and why it has no verdict: in short, and as a clause."""
    ours = next(f.coefficients for f in fits if own.symbol in f.coefficients and f.coefficients[own.symbol] is own)
    for r in tests:
        others = (
            {f"the test is of another body, {r.body}": f"the test was of another body ({r.body})"}
            if r.body != own.body
            else {}
        )
        for campaign in r.campaigns:
            measured = _budget(study, campaign, own.symbol)
            theirs = next((f.coefficients for f in study.fits if f.campaign == campaign and f.sweeps), None)
            if measured is None or theirs is None or theirs.datum != ours.datum:
                continue
            if np.allclose(theirs.reference_point, ours.reference_point, atol=1e-6):
                length = ours.scaling.length
                reynolds = (reynolds_of(study, budget.campaign, length), reynolds_of(study, campaign, length))
                return validation(budget, measured, theirs.scaling.ratio(own.symbol, ours.scaling), reynolds), others
        printed = against_printed(budget, r, ours)
        if printed is not None:
            return printed, others
    return None


def _missing(study: Study, tow: PlannedTow, symbol: str, own: Coefficient | None) -> tuple[str, str]:
    """What stands in the place of a value, and why."""
    if not tow.campaign:
        return NOT_TOWED, f"there is no campaign {listed(tow.absent)} yet"
    variable = _variable(symbol)
    left_out = _left_out(study, tow.campaign, symbol)
    if not any(np.any(_moving(t, variable)) for t in _tables(study, tow.campaign)):
        return NOT_RUN, f"no run varies {variable}" if variable else "no straight run"
    if left_out:
        return OPEN, left_out
    refused = study.unfitted.get(tow.campaign, "")
    if own is None or own.status is Status.NO_TABLE:
        return OPEN, refused or f"too few runs that vary {variable}"
    return OPEN, own.status.replace("_", " ")


def _left_out(study: Study, campaign: str, symbol: str) -> str:
    """How many runs of a motion count, and why the others do not; empty where all do."""
    variable, component = _variable(symbol), symbol[:1]
    states: Counter[str] = Counter()
    runs = 0
    for t in _tables(study, campaign):
        if component not in t.forces:
            continue
        moving = [int(i) for i in np.flatnonzero(_moving(t, variable)) if not (t.variants and t.variants[i])]
        apart = {e.row for e in t.exclusions if not e.status and e.component in ("", component)}  # of other grids
        own = {e.row: e.status for e in t.exclusions if e.status and e.component in ("", component)}
        states.update(own[i] for i in moving if i in own and i not in apart)
        runs += sum(i not in apart for i in moving)
    return runs_used(runs, variable, states) if states else ""


def runs_used(runs: int, variable: str, states: Mapping[str, int]) -> str:
    """How many of the runs of a motion count, and what became of the others.

    Parameters
    ----------
    runs : int
    variable : str
        What moves: ``v``, ``r``; empty for straight runs.
    states : mapping of str to int
        Of those that do not count.
    """
    words = ", ".join(f"{n} {STATES.get(state, state)}" for state, n in sorted(states.items()))
    kind, used = RUNS.get(variable, variable), runs - sum(states.values())
    return f"fitted to {used} of {runs} {kind} runs; {words}" if used else f"no {kind} run used (of {runs}, {words})"


def _variable(symbol: str) -> str:
    """What moves; empty for a force at rest."""
    return next(iter(derivative(symbol).factors), "")


def _tables(study: Study, campaign: str) -> tuple[ForceTable, ...]:
    return tuple(t for t in study.tables if t.campaign == campaign)


def _moving(table: ForceTable, variable: str) -> NDArray[np.bool_]:
    """Rows, (n,), that move in this variable beyond rounding, and in no other of drift, attack, rates and controls."""
    length = table.scaling.length
    names = [*LINEAR[1:], *ANGULAR, *table.controls]
    moves = {m: np.abs(table.primed_motion(m, length)) > AT_REST for m in names}
    own = moves.pop(variable, np.full(len(table), not variable))
    return np.asarray(own & ~np.any(list(moves.values()), axis=0))

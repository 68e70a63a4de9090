"""Rows of several tables for one response, with the run that each comes from.

Tables of several campaigns about one point, and what sets the campaigns apart.

A force component of a joint fit, and the equations that tie components together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from coeflab.core.axes import ANYWHERE
from coeflab.core.errors import InputError, ScalingMismatchError, shown
from coeflab.core.texts import input_error
from coeflab.core.types import Array, dataclass
from coeflab.fits.results.fitted_model import SetAside, joined
from coeflab.fits.rows.regression import Area, Rows, collect, response, variable
from coeflab.fits.rows.too_few import TooFewRowsError
from coeflab.fits.statistics.groups import noise_of_groups
from coeflab.fits.statistics.least_squares import Index
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import COMPONENTS
from coeflab.law.terms import Equation, NamedTerm, design, read_term
from coeflab.tables.force_table import AT_REST, ForceTable, counted_once


@dataclass(frozen=True, slots=True, eq=False)
class JointRows:
    """Rows of one response over all tables that have it.

    Attributes
    ----------
    rows : Rows
    table : (n,) array
        Index of the table of every row.
    campaign : (n,) array
        Index in `campaigns` of every row.
    run : (n,) array
        Number of the run, the same for every response of that run.
    campaigns : tuple of str
        Those of all tables.
    statements : tuple of str
        Rows that are left out, in words.
    """

    rows: Rows
    table: Index
    campaign: Index
    run: Index
    campaigns: tuple[str, ...]
    statements: tuple[str, ...]

    @property
    def present(self) -> tuple[int, ...]:
        """Indices of the campaigns that have a row."""
        return tuple(int(k) for k in np.unique(self.campaign))

    def only(self, keep: NDArray[np.bool_], *statements: str) -> JointRows:
        """Some of the rows, and what to say about it."""
        names = dict(zip(np.unique(self.table).tolist(), self.rows.tables, strict=True))
        tables = tuple(names[k] for k in np.unique(self.table[keep]).tolist())
        return replace(
            self,
            rows=replace(_only(self.rows, keep), tables=tables),
            table=self.table[keep],
            campaign=self.campaign[keep],
            run=self.run[keep],
            statements=(*self.statements, *statements),
        )

    def without_campaigns_at_rest(self) -> JointRows:
        """Without campaigns in which none of the variables moves: with an intercept of their own they tell nothing."""
        moves = np.any([np.abs(x) > AT_REST for x in self.rows.x.values()], axis=0)
        resting = [k for k in self.present if not np.any(moves[self.campaign == k])]
        if len(resting) in (0, len(self.present)):
            return self
        note = f"{', '.join(self.campaigns[k] for k in resting)} is at rest in {', '.join(self.rows.x)}: no row of it is used."
        return self.only(~np.isin(self.campaign, resting), note)


def moving(tables: Sequence[ForceTable]) -> tuple[str, ...]:
    """Motion variables and controls that change in any of the tables, in the order of the tables."""
    return tuple(dict.fromkeys(v for t in tables for v in t.varies))


def measured(tables: Sequence[ForceTable]) -> tuple[str, ...]:
    """Force components that have a usable row in any of the tables."""
    return tuple(c for c in COMPONENTS if any(c in t.forces and np.any(t.usable[c]) for t in tables))


def joint_name(names: Iterable[str]) -> str:
    """Names of campaigns or bodies in one text, each once."""
    return ", ".join(dict.fromkeys(names))


def prime_area(length: float) -> Area:
    """The prime system as an area: L^2, moments with L."""
    return Area(length**2, "L^2", length)


def joint_rows(tables: Sequence[ForceTable], variables: Sequence[str], component: str, length: float) -> JointRows:
    """Usable rows in which nothing but surge and ``variables`` moves (others within 0.05 degrees or 9e-4 of rest).

    Raises
    ------
    InputError
        No table has the component.
    TooFewRowsError
        No row is left.
    """
    if not any(component in t.forces for t in tables):
        raise InputError(f"no {component} in the tables of {tables[0].campaign}", f"a column {component}",
                         column="terms", advice="Leave its terms out or add a table.")  # fmt: skip
    area, others = prime_area(length), [v for v in moving(tables) if v not in variables]
    parts: list[Rows] = []
    table, run, start, left = [], [], 0, dict.fromkeys(others, 0)
    for k, t in enumerate(tables):
        usable = response(t, component, area)[2] if component in t.forces else np.zeros(len(t), dtype=bool)
        if np.any(usable):
            index = np.flatnonzero(usable)
            keep = np.ones(len(index), dtype=bool)
            for v in others:
                moves = np.abs(variable(t, v, length)[index]) > AT_REST
                left[v] += int(np.sum(moves & keep))
                keep &= ~moves
            own = _only(collect([t], variables, component, area), keep)
            parts.append(replace(own, set_aside=_set_aside(t, variables, others, component, area)))
            table += [k] * int(keep.sum())
            run += list(start + index[keep])
        start += len(t)
    campaigns = tuple(dict.fromkeys(t.campaign for t in tables))
    full = [p for p in parts if len(p.y)]
    if not full:
        raise TooFewRowsError.for_terms(component, (), 0, "terms")
    rows = _joined(full, tables)
    note = [f"{n} rows in which {v} moves are left out of {component}: no term of it contains {v}."
            for v, n in left.items() if n]  # fmt: skip
    of_table = np.array([campaigns.index(t.campaign) for t in tables], dtype=np.int64)
    index = np.array(table, dtype=np.int64)
    return JointRows(rows, index, of_table[index], np.array(run, dtype=np.int64), campaigns, tuple(note))


def _set_aside(
    table: ForceTable, variables: Sequence[str], others: Sequence[str], component: str, area: Area
) -> SetAside | None:
    """Printed rows that no fit may use, in which the other variables are at rest."""
    found = collect([table], (*variables, *others), component, area).set_aside if table.exclusions else None
    if found is None:
        return None
    still = np.ones(len(found.y), dtype=bool)
    for v in others:
        still &= np.abs(found.x[v]) <= AT_REST
    still_rows = found.only(still)
    return replace(still_rows, x={v: still_rows.x[v] for v in variables})


def _only(rows: Rows, keep: NDArray[np.bool_]) -> Rows:
    return replace(
        rows,
        x={v: x[keep] for v, x in rows.x.items()},
        y=rows.y[keep],
        errors=None if rows.errors is None else rows.errors[keep],
        labels=tuple(t for t, k in zip(rows.labels, keep, strict=True) if k),
    )


def _joined(parts: Sequence[Rows], tables: Sequence[ForceTable]) -> Rows:
    errors = [p.errors for p in parts if p.errors is not None]
    alone = len({t.campaign for t in tables}) == 1
    return replace(
        parts[0],
        x={v: np.concatenate([p.x[v] for p in parts]) for v in parts[0].x},
        y=np.concatenate([p.y for p in parts]),
        errors=np.concatenate(errors) if len(errors) == len(parts) else None,
        labels=tuple(t if alone else f"{p.campaign} {t}" for p in parts for t in p.labels),
        tables=tuple(t for p in parts for t in p.tables),
        campaign=joint_name(t.campaign for t in tables),
        body=joint_name(t.body for t in tables),
        set_aside=joined([p.set_aside for p in parts if p.set_aside is not None]),
    )


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


Constraint = tuple[Array, Array]


@dataclass(frozen=True, slots=True, eq=False)
class Component:
    """One force component of a joint fit.

    Attributes
    ----------
    name : str
    terms : tuple of NamedTerm
        Common to all campaigns.
    data : JointRows
    errors : (n,) array or None
        Standard deviations that weigh the rows.
    own : bool
        Every campaign has an intercept of its own, in columns behind those of the terms.
    lines : bool
        A slope without another power of its variable may lack x|x|, whatever the residuals show: nobody chose the form.
    """

    name: str
    terms: tuple[NamedTerm, ...]
    data: JointRows
    errors: Array | None = None
    own: bool = False
    lines: bool = False

    @property
    def common(self) -> Array:
        """Design of the terms, shape (n, p)."""
        return design(tuple(t.term for t in self.terms), self.data.rows.x)

    @property
    def intercepts(self) -> Array:
        """Which campaign every row is of, as columns of 0 and 1, shape (n, campaigns); none where they are shared."""
        present = np.array(self.data.present if self.own else (), dtype=np.int64)
        return np.asarray(self.data.campaign[:, None] == present, dtype=np.float64)

    @property
    def matrix(self) -> Array:
        """Design, shape (n, p + intercepts)."""
        return np.column_stack([self.common, self.intercepts])

    @property
    def width(self) -> int:
        """Columns of the design."""
        return len(self.terms) + (len(self.data.present) if self.own else 0)

    @property
    def symbols(self) -> tuple[str, ...]:
        """Names of the common coefficients."""
        return tuple(t.symbol for t in self.terms)

    @property
    def idle(self) -> tuple[str, ...]:
        """Common coefficients whose motion occurs in no row."""
        return tuple(s for s, column in zip(self.symbols, self.common.T, strict=True) if not np.any(column))

    @property
    def every_symbol(self) -> tuple[str, ...]:
        """Names of all columns."""
        campaigns = [self.data.campaigns[k] for k in self.data.present] if self.own else []
        return (*self.symbols, *(f"{self.name}0 of {c}" for c in campaigns))

    def weighed(self, *, stated: bool) -> Component:
        """With the weights of the rows: several campaigns by the scatter of each about its own law.

        Parameters
        ----------
        stated : bool
            Weigh the rows of a campaign by their standard errors.
        """
        errors = self.data.rows.errors if stated else None
        if len(self.data.present) > 1:
            errors = noise_of_groups(self.matrix, self.data.rows.y, self.data.campaign, errors)
        return replace(self, errors=errors)


def constraint_of(equations: Sequence[Equation], parts: Sequence[Component], place: str) -> Constraint:
    """C and d of C b = d over all columns of ``parts``.

    Raises
    ------
    InputError
        An equation names a coefficient that the model does not have.
    """
    starts = accumulate((p.width for p in parts), initial=0)
    index = {t.key: start + i for p, start in zip(parts, starts, strict=False) for i, t in enumerate(p.terms)}
    matrix = np.zeros((len(equations), sum(p.width for p in parts)))
    for row, equation in enumerate(equations):
        for symbol, weight in equation.weights:
            named = read_term(symbol, place)
            if named.key not in index:
                names = ", ".join(s for p in parts for s in p.symbols)
                apart = not named.term.factors and any(p.own and p.name == named.component for p in parts)
                raise input_error(
                    "fits.coefficients_model", column=place, symbol=shown(symbol), equation=shown(equation), names=names,
                    advice=f"Add {symbol} to the terms" + ("; one value then serves all campaigns." if apart else "."),
                )  # fmt: skip
            matrix[row, index[named.key]] += weight
    return matrix, np.array([e.right for e in equations])


def linked(components: Sequence[str], equations: Sequence[Equation]) -> list[tuple[str, ...]]:
    """Components that equations tie together, in the order given."""
    group = {c: {c} for c in components}
    for equation in equations:
        tied = {symbol[0] for symbol, _ in equation.weights}
        merged = set().union(*(group.get(c, set()) for c in tied))
        for c in merged:
            group[c] = merged
    out: list[tuple[str, ...]] = []
    for c in components:
        if not any(c in g for g in out):
            out.append(tuple(k for k in components if k in group[c]))
    return out

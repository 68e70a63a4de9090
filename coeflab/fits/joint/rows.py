"""Rows of several tables for one response, with the run that each comes from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.types import dataclass
from coeflab.fits.results.set_aside import SetAside, joined
from coeflab.fits.rows.regression import Area, Rows, all_digits, all_known, collect, response, variable
from coeflab.fits.rows.too_few import TooFewRowsError
from coeflab.fits.statistics.least_squares import Index
from coeflab.law.symbols import COMPONENTS
from coeflab.tables.force_table import AT_REST, ForceTable


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
        rounding=None if rows.rounding is None else rows.rounding[keep],
        labels=tuple(t for t, k in zip(rows.labels, keep, strict=True) if k),
    )


def _joined(parts: Sequence[Rows], tables: Sequence[ForceTable]) -> Rows:
    alone = len({t.campaign for t in tables}) == 1
    return replace(
        parts[0],
        x={v: np.concatenate([p.x[v] for p in parts]) for v in parts[0].x},
        y=np.concatenate([p.y for p in parts]),
        errors=all_known([p.errors for p in parts]),
        rounding=all_digits([p.rounding for p in parts], [p.y for p in parts]),
        labels=tuple(t if alone else f"{p.campaign} {t}" for p in parts for t in p.labels),
        tables=tuple(t for p in parts for t in p.tables),
        campaign=joint_name(t.campaign for t in tables),
        body=joint_name(t.body for t in tables),
        set_aside=joined([p.set_aside for p in parts if p.set_aside is not None]),
    )

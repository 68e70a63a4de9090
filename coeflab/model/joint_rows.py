"""Rows of several tables for one response, with the run that each comes from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.symbols import COMPONENTS
from coeflab.kernels.least_squares import Index
from coeflab.model.force_table import ForceTable
from coeflab.model.regression import Area, Rows, collect, response, variable

AT_REST = float(np.sin(np.radians(0.05)))


@dataclass(frozen=True, slots=True, eq=False)
class JointRows:
    """Rows of one response over all tables that have it.

    Attributes
    ----------
    rows : Rows
    table : (n,) array
        Index of the table of every row.
    run : (n,) array
        Number of the run, the same for every response of that run.
    statements : tuple of str
        Rows that are left out, in words.
    """

    rows: Rows
    table: Index
    run: Index
    statements: tuple[str, ...]


def moving(tables: Sequence[ForceTable]) -> tuple[str, ...]:
    """Motion variables and controls that change in any of the tables, in the order of the tables."""
    return tuple(dict.fromkeys(v for t in tables for v in t.varies))


def measured(tables: Sequence[ForceTable]) -> tuple[str, ...]:
    """Force components that have a usable row in any of the tables."""
    return tuple(c for c in COMPONENTS if any(c in t.forces and np.any(t.usable[c]) for t in tables))


def prime_area(length: float) -> Area:
    """The prime system as an area: L^2, moments with L."""
    return Area(length**2, "L^2", length)


def joint_rows(tables: Sequence[ForceTable], variables: Sequence[str], component: str, length: float) -> JointRows:
    """Usable rows in which nothing but surge and ``variables`` moves (others within 0.05 degrees or 9e-4 of rest).

    Raises
    ------
    InputError
        No table has the component, or no row is left.
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
            parts.append(_only(collect([t], variables, component, area), keep))
            table += [k] * int(keep.sum())
            run += list(start + index[keep])
        start += len(t)
    rows = _joined([p for p in parts if len(p.y)], component)
    said = [f"{n} rows in which {v} moves are left out of {component}: no term of it contains {v}."
            for v, n in left.items() if n]  # fmt: skip
    return JointRows(rows, np.array(table, dtype=np.int64), np.array(run, dtype=np.int64), tuple(said))


def _only(rows: Rows, keep: NDArray[np.bool_]) -> Rows:
    return replace(
        rows,
        x={v: x[keep] for v, x in rows.x.items()},
        y=rows.y[keep],
        errors=None if rows.errors is None else rows.errors[keep],
        labels=tuple(t for t, k in zip(rows.labels, keep, strict=True) if k),
    )


def _joined(parts: Sequence[Rows], component: str) -> Rows:
    if not parts:
        raise InputError(f"no usable rows for {component}", "rows in which only motions of its terms occur",
                         column="terms", advice="Add terms in the motions that the tables vary.")  # fmt: skip
    errors = [p.errors for p in parts if p.errors is not None]
    return replace(
        parts[0],
        x={v: np.concatenate([p.x[v] for p in parts]) for v in parts[0].x},
        y=np.concatenate([p.y for p in parts]),
        errors=np.concatenate(errors) if len(errors) == len(parts) else None,
        labels=tuple(t for p in parts for t in p.labels),
        tables=tuple(t for p in parts for t in p.tables),
    )

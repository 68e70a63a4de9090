"""Rows of a table in which nothing but the wanted variables moves."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from coeflab.core.errors import InputError
from coeflab.core.texts import input_error
from coeflab.fits.rows.regression import WIND, Area, Rows, response
from coeflab.law.scaling import Scaling
from coeflab.law.symbols import COMPONENTS, FORCES
from coeflab.tables.force_table import AT_REST, Exclusion, ForceTable, counted_once

MOVED_BY = {"alpha": ("w",), "beta": ("v",)}
PRIMES = "L^2"
AREAS = (PRIMES, "frontal", "wetted", "projected", "planform", "volume^(2/3)")


def area_of(value: float, name: str, scaling: Scaling) -> Area:
    """The area that force coefficients are divided by; 0 is the square of the primes' length.

    Parameters
    ----------
    value : float
        m^2, or 0.
    name : str
        One of `AREAS`.
    scaling : Scaling
        Whose length the primes have.

    Raises
    ------
    InputError
        An area without its name, or a name without its area.
    """
    if value == 0.0 and name == PRIMES:
        return Area(scaling.length**2, PRIMES, scaling.length)
    if value == 0.0 or name == PRIMES:
        raise input_error(
            "fits.area_named", column="area", value=value, name=name, areas=", ".join(AREAS[1:]), primes=PRIMES,
            scaling=scaling,
        )  # fmt: skip
    return Area(value, name, scaling.length)


def area_settings(area: Area) -> dict[str, str]:
    """The area among the settings of a fit, from which the parameter file takes it."""
    return {"area": repr(area.area), "area_name": area.name}


def without_blanks(options: Mapping[str, Any], name: str) -> dict[str, Any]:
    """Options in which one text of ``key=value`` words may have blanks around the equals sign."""
    text = options.get(name)
    return {**options, name: re.sub(r"\s*=\s*", "=", text)} if isinstance(text, str) else dict(options)


def check_varies(rows: Rows) -> None:
    """Raise where a variable of two stands still, within `AT_REST`."""
    for name, x in rows.x.items():
        if np.ptp(x) <= AT_REST:
            others = ", ".join(v for v in rows.x if v != name)
            raise input_error(
                "fits.never_varies_rows", column="variables", name=name, response=rows.response, campaign=rows.campaign,
                others=others,
            )  # fmt: skip


def named_response(name: str, area: Area) -> str:
    """``Y'`` for primes, ``C_Y`` by another area; ``C_D`` and its like stay."""
    if name not in COMPONENTS:
        return name
    return f"{name}'" if area.name == PRIMES else f"C_{name}"


def allowed(tables: Sequence[ForceTable], name: str, area: Area) -> list[ForceTable]:
    """The tables that have what a response needs."""
    if name in WIND and not any(c in t.forces for t in tables for c in FORCES):
        return []
    out = []
    for table in tables:
        try:
            _, _, usable = response(table, name, area)
        except InputError:
            continue
        if np.any(usable):
            out.append(table)
    return out


def only_moving(
    tables: Sequence[ForceTable], variables: Sequence[str], length: float
) -> tuple[list[ForceTable], tuple[str, ...]]:
    """The tables with the rows out of use in which another variable moves.

    Surge does not count. Another variable is at rest within the sine of 0.05 degrees, in primes.

    Returns
    -------
    tables : list of ForceTable
        Tables without such a row are left out.
    statements : tuple of str
        How many rows were left out, where any.
    """
    free = {"u"} | {m for v in variables for m in MOVED_BY.get(v, (v,))}
    selected, statements = [], []
    for table in counted_once(tables, axial=len(variables) > 1):
        still = np.ones(len(table), dtype=bool)
        for name in ("v", "w", "p", "q", "r", *table.controls):
            if name not in free:
                still &= np.abs(table.primed_motion(name, length)) <= AT_REST
        dropped = int(np.sum(~still))
        if not dropped:
            selected.append(table)
            continue
        statements.append(f"{dropped} of {len(table)} rows of {table.name} are left out: other variables move in them.")
        if dropped < len(table):
            moving = tuple(
                Exclusion(int(i), 0, "", f"moves in more than {', '.join(variables)}") for i in np.flatnonzero(~still)
            )
            usable = {c: mask & still for c, mask in table.usable.items()}
            selected.append(replace(table, usable=usable, exclusions=(*table.exclusions, *moving)))
    if not selected:
        raise input_error("fits.no_row_only_may", column="variable", variables=" and ".join(variables))
    return selected, tuple(statements)

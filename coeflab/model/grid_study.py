"""Grid studies inside a force table: rows of one setting, computed on several grids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import LINEAR, MOTIONS
from coeflab.kernels.brief import brief
from coeflab.kernels.grid_convergence import GridConvergence, cell_sizes, grid_convergence
from coeflab.kernels.grid_least_squares import fitted_convergence
from coeflab.model.force_table import ForceTable

AT_REST = 1e-4  # of the largest motion in the table: rounding of a printed angle, not a motion


@brief
@dataclass(frozen=True, slots=True)
class GridStudy:
    """One force component at one setting on several grids.

    Attributes
    ----------
    table, component : str
    setting : str
        Motion that is not zero, in words.
    moving : tuple of str
        Its variables.
    cells : tuple of int
        Finest grid first.
    cells_used : int
        Of the grid that the fit uses.
    convergence : GridConvergence
    """

    table: str
    component: str
    setting: str
    moving: tuple[str, ...]
    cells: tuple[int, ...]
    cells_used: int
    convergence: GridConvergence


def grid_studies(table: ForceTable, component: str, dimension: int = 3) -> tuple[GridStudy, ...]:
    """Grid studies of a component: settings with two or more cell counts, one of them in use.

    Cell sizes follow from the counts as (1/cells)^(1/dimension), so the grids must be refined alike everywhere.
    """
    cells = table.cells
    if cells is None or component not in table.forces:
        return ()
    settings = np.column_stack([table.motion[m] for m in MOTIONS] + list(table.controls.values()) + [table.speed])
    found = []
    for group in _alike(settings):
        rows = [int(i) for i in group if np.isfinite(cells[i]) and np.isfinite(table.forces[component][i])]
        used = [i for i in rows if table.usable[component][i]]
        if len(used) != 1 or len(np.unique(cells[rows])) != len(rows) or len(rows) < 2:
            continue
        noise = 2.0 * table.errors[component][rows] if component in table.errors else None
        values, sizes, place = table.forces[component][rows], cell_sizes(cells[rows], dimension), rows.index(used[0])
        if len(rows) > 3:
            judged = fitted_convergence(values, sizes, used=place)
        else:
            judged = grid_convergence(values, sizes, used=place, noise=noise)
        counts = tuple(sorted((int(cells[i]) for i in rows), reverse=True))
        found.append(
            GridStudy(
                table.name, component, _setting(table, used[0]), _moving(table, used[0]), counts, int(cells[used[0]]), judged
            )
        )  # fmt: skip
    return tuple(found)


def gravest(studies: tuple[GridStudy, ...]) -> GridStudy | None:
    """The study with the largest relative half-width; one without a half-width counts as the gravest."""
    if not studies:
        return None
    return max(studies, key=lambda s: np.inf if s.convergence.relative is None else s.convergence.relative)


def _alike(settings: NDArray[np.float64]) -> list[NDArray[np.intp]]:
    scale = np.maximum(np.max(np.abs(settings), axis=0), 1e-300)
    _, names = np.unique(np.round(settings / scale, 9), axis=0, return_inverse=True)
    groups = names.ravel()
    return [np.flatnonzero(groups == k) for k in range(int(groups.max(initial=-1)) + 1)]


def _moving(table: ForceTable, row: int) -> tuple[str, ...]:
    scale = {m: table.speed[row] / (table.scaling.length if m in "pqr" else 1.0) for m in MOTIONS}
    names = [m for m in table.varies if m in MOTIONS and abs(table.motion[m][row]) > AT_REST * scale[m]]
    return (*names, *(c for c, a in table.controls.items() if a[row] != 0.0))


def _setting(table: ForceTable, row: int) -> str:
    names = _moving(table, row)
    units = {m: "m/s" if m in LINEAR else "rad/s" for m in MOTIONS}
    parts = [f"{m} = {table.motion[m][row]:.3g} {units[m]}" for m in names if m in units]
    parts += [f"{c} = {np.degrees(table.controls[c][row]):.3g} deg" for c in names if c in table.controls]
    return ", ".join(parts) or "at rest"

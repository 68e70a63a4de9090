"""Studies inside a force table: rows of one setting, computed on several grids, or with one thing changed at a time."""

from __future__ import annotations

import numpy as np

from coeflab.core.types import dataclass
from coeflab.fits.uncertainty.grid_convergence import GridConvergence, cell_sizes, grid_convergence
from coeflab.fits.uncertainty.several_grids import fitted_convergence
from coeflab.law.symbols import LINEAR, MOTIONS
from coeflab.tables.force_table import STUDIES, ForceTable

MANY = 3
WITHOUT_PLATEAU = {"too short", "drifting", "unconverged"}
AT_REST = 1e-4  # of the largest motion in the table: rounding of a printed angle, not a motion


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
    left_out : tuple of int
        Cells of runs at this setting that did not converge.
    """

    table: str
    component: str
    setting: str
    moving: tuple[str, ...]
    cells: tuple[int, ...]
    cells_used: int
    convergence: GridConvergence
    left_out: tuple[int, ...] = ()


def grid_studies(table: ForceTable, component: str, dimension: int = 3) -> tuple[GridStudy, ...]:
    """Grid studies of a component: settings with two or more cell counts, one of them in use.

    Cell sizes follow from the counts as (1/cells)^(1/dimension), so the grids must be refined alike everywhere.
    """
    cells = table.cells
    if cells is None or component not in table.forces:
        return ()
    found, setting, judged_rows = [], table.setting, table.sound(component)
    for group in (np.flatnonzero(setting == k) for k in range(int(setting.max(initial=-1)) + 1)):
        sized = [int(i) for i in group if np.isfinite(cells[i]) and not _changed(table, int(i))]
        rows, doubtful = [i for i in sized if judged_rows[i]], tuple(int(cells[i]) for i in sized if not judged_rows[i])
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
                table.name, component, _setting(table, used[0]), _moving(table, used[0]), counts, int(cells[used[0]]), judged,
                doubtful,
            )
        )  # fmt: skip
    return tuple(found)


def gravest(studies: tuple[GridStudy, ...]) -> GridStudy | None:
    """The study with the largest relative half-width; one without a half-width counts as the gravest."""
    if not studies:
        return None
    return max(studies, key=lambda s: np.inf if s.convergence.relative is None else s.convergence.relative)


@dataclass(frozen=True, slots=True)
class VariantStudy:
    """One force component at one setting, with one thing changed at a time: the domain, the turbulence model, the iterations.

    Attributes
    ----------
    name : str
        Of the part of a budget: ``domain size``, ``turbulence model`` or ``iterations``.
    table, component : str
    setting : str
        Motion that is not zero, in words.
    moving : tuple of str
        Its variables.
    used : float
        Force of the row that the fit uses.
    changed : tuple of (str, float)
        What was changed, and the force with it.
    half_width : float
        95 % half-width of the force in use.
    statement : str
    """

    name: str
    table: str
    component: str
    setting: str
    moving: tuple[str, ...]
    used: float
    changed: tuple[tuple[str, float], ...]
    half_width: float
    statement: str

    @property
    def relative(self) -> float:
        """Half-width over the absolute force in use; infinite where that is zero."""
        return self.half_width / abs(self.used) if self.used else float("inf")


def variant_studies(table: ForceTable, component: str) -> tuple[VariantStudy, ...]:
    """Studies of a component in which something else than the grid was changed.

    The half-width is that of a rectangular distribution about the value in use that reaches to the farthest of the others,
    JCGM 100:2008, 4.3.7: 2 / sqrt 3 times the largest distance; a distance below the iteration noise of both values counts
    as that noise. Rows of other grids than the row in use, where cells are known and the domain is the same, are not judged.
    Nor are runs that did not converge, but for those that a study of the iterations ended sooner.
    """
    if component not in table.forces or not any(table.variants):
        return ()
    force, sound, setting = table.forces[component], table.sound(component), table.setting
    noise = 2.0 * table.errors[component] if component in table.errors else np.zeros(len(table))
    noise = np.nan_to_num(noise)
    found = []
    for row in (int(i) for i in np.flatnonzero(table.usable[component] & sound)):
        alike = [int(i) for i in np.flatnonzero((setting == setting[row]) & sound)]
        if any(i != row and not _changed(table, i) and table.usable[component][i] for i in alike):
            continue
        sooner = [int(i) for i in np.flatnonzero(setting == setting[row]) if _ended_sooner(table, component, int(i))]
        for name, part in STUDIES.items():
            rows = [
                i
                for i in (*alike, *sooner)
                if _changed(table, i) == name and (name == "domain" or _one_grid(table, row, i))
            ]
            if not rows:
                continue
            apart = np.maximum(np.abs(force[rows] - force[row]), np.hypot(noise[rows], noise[row]))
            half = 2.0 / 3.0**0.5 * float(np.max(apart))
            others = ", ".join(f"{table.variants[i].partition('= ')[2]} {force[i]:.4g}" for i in rows)
            changed = tuple((table.variants[i], float(force[i])) for i in rows)
            text = f"{part}: {force[row]:.4g} in use, {others}"
            own = (part, table.name, component, _setting(table, row), _moving(table, row))
            found.append(VariantStudy(*own, float(force[row]), changed, half, text))
    return tuple(found)


def _changed(table: ForceTable, row: int) -> str:
    """Name of the study that a row belongs to; ``several`` of one with several changes, empty for one of the matrix itself."""
    names = table.variants[row].split(" = ") if table.variants else [""]
    return names[0] if len(names) < MANY else "several"


def _ended_sooner(table: ForceTable, component: str, row: int) -> bool:
    """Whether a row of a study of the iterations has a force, but no plateau."""
    states = {e.status for e in table.exclusions if e.row == row and e.status}
    ended = bool(states) and states <= WITHOUT_PLATEAU
    return ended and _changed(table, row) == "iterations" and bool(np.isfinite(table.forces[component][row]))


def _one_grid(table: ForceTable, a: int, b: int) -> bool:
    cells = table.cells
    return cells is None or not np.all(np.isfinite(cells[[a, b]])) or bool(cells[a] == cells[b])


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

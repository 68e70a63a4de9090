"""The tow tank against theory: Lamb's coefficients of inertia, and what was towed of the shapes that a theory covers.

An isolated stern plane: lift slope after Whicker & Fehlner. A prolate spheroid: the Munk moment of Lamb's coefficients.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from coeflab.bodies.closed_forms.ellipsoid import ellipsoid_added_mass, spheroid_munk_slope
from coeflab.bodies.closed_forms.revolution import graded_nodes, meridian_integrals
from coeflab.bodies.fin_lift import LIFT_LOSS, low_aspect_lift_slope
from coeflab.core.errors import InputError
from coeflab.core.files import shipped
from coeflab.core.machine import one_thread
from coeflab.core.table import plus_minus
from coeflab.fits.uncertainty.grid_convergence import cell_sizes, grid_convergence
from coeflab.law.coefficient import Coefficient
from coeflab.published.publication import Row, publication
from coeflab.report.acceptance import Acceptance, ComparedTable
from coeflab.study.run import run
from coeflab.study.study import Plan
from coeflab.tables.importers import PlannedTable

PAPER = publication("tank")

# c/a, k1, k2, k' as printed in R&M 623.
LAMB = (
    (1.00, 0.5, 0.5, 0.0), (1.50, 0.305, 0.621, 0.094), (2.00, 0.209, 0.702, 0.240), (2.51, 0.156, 0.763, 0.367),
    (2.99, 0.122, 0.803, 0.465), (3.99, 0.082, 0.860, 0.608), (4.99, 0.059, 0.895, 0.701), (6.01, 0.045, 0.918, 0.764),
    (6.97, 0.036, 0.933, 0.805), (8.01, 0.029, 0.945, 0.840), (9.02, 0.024, 0.954, 0.865), (9.97, 0.021, 0.960, 0.883),
)  # fmt: skip
PLANE, SPHEROID = "tank_naca0020_plane", "tank_spheroid"  # campaigns
ASPECT = 1.4673  # of the plane and its mirror image, which is also their area over the mean chord squared
FINENESS = 6.0
SWEEPS = (0.0, 30.0, 45.0, 60.0)  # deg
LONG, LONG_WITHIN = 1e6, 1e-5  # aspect of a wing without end, and what is left of its ends
EDGES, ORDER = (64, 32, 16), 2.0  # cells along the edge of a cube, and the order of the values made up on them


def inertia_of_spheroid(ratio: float) -> tuple[float, float, float]:
    """Lamb's k1, k2 and k' of a prolate spheroid whose length is ``ratio`` times its breadth."""
    moved = np.diag(ellipsoid_added_mass(np.array([ratio, 1.0, 1.0]), 1.0))
    volume = 4.0 / 3.0 * np.pi * ratio
    return (
        float(moved[0] / volume), float(moved[1] / volume), float(moved[4] / (volume * (ratio**2 + 1.0) / 5.0)),
    )  # fmt: skip


@one_thread()
def acceptance(folder: Path | None = None) -> Acceptance:
    """Theory, and the tows that are there.

    Parameters
    ----------
    folder : Path, optional
        Of the campaigns ``tank_naca0020_plane`` and ``tank_spheroid``; the shipped ones by default.
    """
    place = shipped("cfd_data") if folder is None else folder
    tables, statements = [_lamb(), _closed_forms()], []
    for name, judged in ((PLANE, _plane), (SPHEROID, _spheroid)):
        if not (place / name).is_dir():
            statements.append(f"Not towed: there is no campaign {name} yet.")
            continue
        try:
            tables.append(judged(_slopes(place / name)))
        except InputError as why:
            statements.append(f"Open: {name} has {why.found}.")
    return PAPER.acceptance(tables, statements)


def _lamb() -> ComparedTable:
    rows = tuple(
        Row(f"c/a = {ratio:g}", name, "1", printed, ours)
        for ratio, *values in LAMB
        for name, printed, ours in zip(("k1", "k2", "k'"), values, inertia_of_spheroid(ratio), strict=True)
    )
    return PAPER.table("lamb", rows)


def _closed_forms() -> ComparedTable:
    """What theory says of formulas that the tow tank and the estimates use, where it says it in closed form."""
    rows = []
    for sweep in SWEEPS:
        due = LIFT_LOSS * 2.0 * np.pi * float(np.cos(np.radians(sweep)))
        found = low_aspect_lift_slope(LONG, float(np.radians(sweep)))
        rows.append(Row(f"infinite span, sweep {sweep:g} deg", "lift slope", "1/rad", due, found, LONG_WITHIN))
    x, weight = graded_nodes(-FINENESS, FINENESS, 64)
    radius = np.sqrt(1.0 - (x / FINENESS) ** 2)
    whole = meridian_integrals(x, weight, radius, -x / FINENESS**2)
    turning = whole.second_moment / whole.volume / FINENESS**2
    rows += [
        Row("6:1 by sections", "volume over b^3", "1", 4.0 / 3.0 * np.pi * FINENESS, whole.volume),
        Row("6:1 by sections", "turning over displaced mass and a^2", "1", 0.2, turning),
    ]
    sizes = cell_sizes(np.array(EDGES, dtype=float) ** 3)
    result = grid_convergence(1.0 + 0.01 * (EDGES[0] / np.array(EDGES)) ** ORDER, sizes)
    rows += [
        Row("cubes of 64, 32 and 16 cells an edge", "order", "1", ORDER, result.order, 1e-6),
        Row("cubes of 64, 32 and 16 cells an edge", "value without cells", "1", 1.0, result.extrapolated),
    ]  # fmt: skip
    return PAPER.table("closed_forms", rows)


def _slopes(campaign: Path) -> dict[str, Coefficient]:
    """Coefficients of a tow with a value."""
    study = run(
        Plan(campaign.name, campaign.name, (PlannedTable(campaign, ("slope_at_origin",)),), wanted=("Yv", "Nv"))
    )
    return {c.symbol: c for c in study.coefficients if c.value is not None}


def _plane(found: dict[str, Coefficient]) -> ComparedTable:
    side, along = (found.get(s) for s in ("Yv", "X0"))
    slope = None
    if side is not None and side.value is not None:
        drag = 0.0 if along is None or along.value is None else along.value
        slope = (drag - side.value) / ASPECT
    row = Row("a = 1.467", "lift slope", "1/rad", low_aspect_lift_slope(ASPECT), slope)
    return PAPER.table("plane", (row,), side=_of(side, "Yv'"))


def _spheroid(found: dict[str, Coefficient]) -> ComparedTable:
    moment, side = (found.get(s) for s in ("Nv", "Yv"))
    value = None if moment is None else moment.value
    row = Row("6:1", "Nv'", "1", spheroid_munk_slope(FINENESS, 1.0), value)
    return PAPER.table("spheroid", (row,), moment=_of(moment, "Nv'"), side=_of(side, "Yv'"))


def _of(c: Coefficient | None, name: str) -> tuple[str, ...]:
    return () if c is None else (f"{name} = {plus_minus(c.value, c.u95)}.",)

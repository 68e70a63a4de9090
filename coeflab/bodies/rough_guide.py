"""How far an added mass may be off that is only a rough guide to its body, as U95 and as findings.

The 95 % half-width of a diagonal entry is a share of the entry and the displaced water together: an ellipsoid of three like
axes turns about in water without moving any, so that no share of the entry itself would hold. The shares (``rough_share`` of a method) are those that hold 95 %
of the diagonal entries of the twelve meshes of ``tests/bodies/twelve.py`` against the panel method, 2,000 panels extrapolated: a
calibration, whose own 95 % validates nothing. Ten single bodies that had no part in it (cone, torus, plate, tall box, disc, wedge,
octahedron, capsule, flat spheroid, short ring; 1,000 panels) have all of their 108 entries inside, at .71 of the half-width at most.
On such plain bodies the shares are wide; of vehicles of several parts no other sample was held against them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.added_mass import ADDED_MASS
from coeflab.bodies.shape import Shape
from coeflab.bodies.volume_moments import displaced
from coeflab.core.finding import Finding, Severity
from coeflab.core.types import Array
from coeflab.law.added_mass import AddedMass


def rough_u95(found: AddedMass, shape: Shape, density: float, vanishing: NDArray[np.bool_]) -> Array:
    """(6, 6) 95 % half-widths of a rough guide, kg, kg m, kg m^2; never below its numerical error.

    Parameters
    ----------
    found : AddedMass
    shape : Shape
    density : float
        kg/m^3.
    vanishing : (6, 6) array of bool
        What symmetry makes vanish.
    """
    scale = np.diag(found.matrix) + displaced(shape, density, found.reference_point)
    half = ADDED_MASS.load(found.method.partition(":")[0]).rough_share * np.sqrt(np.outer(scale, scale))
    error = np.zeros((6, 6)) if found.error is None else found.error
    return np.where(vanishing, error, np.maximum(half, error))


def rough_finding(found: AddedMass, advice: str) -> Finding:
    """A warning with the half-widths of the diagonal; the statistic is the worst over its entry."""
    half = np.diag(np.zeros((6, 6)) if found.u95 is None else found.u95)
    own = np.diag(found.matrix)
    worst = max((float(h / v) for h, v in zip(half, own, strict=True) if v > 0.0), default=np.nan)
    return Finding.of(
        "added_mass.rough", found.body, Severity.WARN, statistic=None if np.isnan(worst) else worst, advice=advice,
        method=found.method, entries=[float(f"{v:.4g}") for v in own], half_widths=[float(f"{v:.3g}") for v in half],
    )  # fmt: skip


def unresolved_finding(body: str, method: str, why: str, advice: str) -> Finding:
    """A warning that the panel method did not take a body, and another stands in its place."""
    return Finding.of("added_mass.without_panels", body, Severity.WARN, advice=advice, method=method, why=why)

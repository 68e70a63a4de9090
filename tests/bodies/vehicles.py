"""Fused vehicles of known dimensions, as manifold solids; all synthetic."""

from __future__ import annotations

import numpy as np
from manifold3d import CrossSection, Manifold

HULL, LENGTH = 0.25, 4.0


def lathe(x: np.ndarray, radius: np.ndarray, around: int = 64) -> Manifold:
    outline = np.column_stack([np.r_[0.0, radius, 0.0], np.r_[x[0], x, x[-1]]])
    return Manifold.revolve(CrossSection([outline]), around).rotate((0.0, 90.0, 0.0))


def rod(radius: float, length: float, around: int = 64) -> Manifold:
    return lathe(np.array([-length / 2, length / 2]), np.array([radius, radius]), around)


def fin(chord: float, thickness: float, span: float, angle: float, x: float) -> Manifold:
    """A slab from the axis outward; 0 deg is down, 90 deg to starboard."""
    slab = Manifold.cube((chord, thickness, span)).translate((x - chord / 2, -thickness / 2, 0.0))
    return slab.rotate((-angle, 0.0, 0.0))


def tailed_hull() -> Manifold:
    """A cylinder of 4 m with four fins of 0.3 m chord that reach to 0.6 m from the axis."""
    fins = [fin(0.3, 0.02, 0.6, a, -1.7) for a in (0.0, 90.0, 180.0, 270.0)]
    return rod(HULL, LENGTH) + fins[0] + fins[1] + fins[2] + fins[3]

"""What a person may name: symbols, sources of accelerations, angles; and fresh water. Light: nothing that computes is imported."""

from __future__ import annotations

from coeflab.law.symbols import COMPONENTS, CONTROLS, FLOW_ANGLES, MOTIONS, primed
from coeflab.law.water import FRESH_DENSITY
from coeflab.vehicle.inertia import ACCELERATIONS

__all__ = ["ACCELERATIONS", "CONTROLS", "FLOW_ANGLES", "FRESH_DENSITY", "primed", "slopes"]


def slopes() -> tuple[str, ...]:
    """Derivatives of forces and moments by velocities, rates and control angles, without primes.

    Examples
    --------
    >>> slopes()[:3], len(slopes())
    (('Xu', 'Xv', 'Xw'), 54)
    """
    return tuple(f"{force}{motion}" for force in COMPONENTS for motion in (*MOTIONS, *CONTROLS))

"""Whether a target of another form takes a term: its derivative at straight motion beside that of the file."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, MOTIONS
from coeflab.model.force_law import LawTerm

Array = NDArray[np.float64]
# Of the speed; products such as v|v| err by the first power of a step, which two steps take off.
TOLERANCE, STEP = 1e-6, 1e-5


def held_when_straight(force: Callable[[Array], Array], speed: float) -> Callable[[LawTerm], bool]:
    """A test of terms: constants and those linear in one velocity are held if the target's force has them to 1e-6.

    Parameters
    ----------
    force : callable
        Velocities (n, 6) -> forces (n, 6) of the target, FRD about the file's reference point.
    speed : float
        m/s, straight ahead; derivatives are taken there, extrapolated to no step, for a term such as r|r| bends the line.
    """
    straight = np.array([speed, 0.0, 0.0, 0.0, 0.0, 0.0])

    def held(t: LawTerm) -> bool:
        if t.term.degree > 1 or t.speed_power != 2 - t.term.degree:
            return False
        i = COMPONENTS.index(t.component)
        if not t.term.factors:
            theirs, ours = float(force(straight[None])[0, i]), t.coefficient * speed**2
        else:
            step = speed * np.eye(6)[MOTIONS.index(t.term.factors[0][0])]
            slopes = []
            for h in (STEP, STEP / 2.0):
                pair = force(np.array([straight + h * step, straight - h * step]))
                slopes.append(float(pair[0, i] - pair[1, i]) / (2.0 * h * speed))
            theirs, ours = 2.0 * slopes[1] - slopes[0], t.coefficient * speed
        return abs(theirs - ours) <= TOLERANCE * abs(ours)

    return held

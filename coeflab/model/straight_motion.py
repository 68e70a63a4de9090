"""A law near a straight course ahead, whatever its terms are called, and whether a target of another form takes a term."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, MOTIONS
from coeflab.model.force_law import ForceLaw, LawTerm
from coeflab.model.manoeuvring_terms import canonical

Array = NDArray[np.float64]
# Of the speed; products such as v|v| err by the first power of a step, which two steps take off.
TOLERANCE, STEP = 1e-6, 1e-5


def canonical_name(term: LawTerm) -> str | None:
    """What a term is on a straight course ahead, where U = u = |u|: ``Yv`` for Yv, Yuv, Yv|u|; ``X0`` for X0, Xu|u|, Xuu, Xu;
    ``Yv|v|``; None for products of other motions and for terms even in one.
    """
    match [f for f in canonical(term.term) if f[0] != "u"]:
        case []:
            return f"{term.component}0"
        case [(x, 1, True)]:
            return term.component + x
        case [(x, 2, True)]:
            return f"{term.component}{x}|{x}|"
        case _:
            return None


def straight_coefficients(law: ForceLaw, speed: float) -> Mapping[str, float]:
    """Sums of terms alike on a straight course, by their canonical names.

    Parameters
    ----------
    law : ForceLaw
    speed : float
        m/s, at which a term in another power of the speed than its name says counts: Xu of a state of rest is X0 = Xu / U.

    Returns
    -------
    mapping of str to float
        SI: ``X0`` by U^2, ``Yv`` by U, ``Yv|v|`` by no power of U.
    """
    out: dict[str, float] = {}
    for t in law.terms:
        name = canonical_name(t)
        if name is not None:
            ahead = sum(n for v, n, _ in t.term.factors if v == "u")
            rest = t.term.degree - ahead
            out[name] = out.get(name, 0.0) + t.coefficient * speed ** (t.speed_power + ahead + rest - 2)
    return out


def held_when_straight(force: Callable[[Array], Array], law: ForceLaw, speed: float) -> Callable[[LawTerm], bool]:
    """A test of terms: constants and those linear in one velocity are held if the target's force has them to 1e-6.

    Terms that are alike on a straight course, such as Yv and Yuv, are held together or not at all.

    Parameters
    ----------
    force : callable
        Velocities (n, 6) -> forces (n, 6) of the target, FRD about the file's reference point.
    law : ForceLaw
        Of the file.
    speed : float
        m/s, straight ahead; derivatives are taken there, extrapolated to no step, for a term such as r|r| bends the line.
    """
    straight = np.array([speed, 0.0, 0.0, 0.0, 0.0, 0.0])
    wanted = straight_coefficients(law, speed)

    def held(t: LawTerm) -> bool:
        name = canonical_name(t)
        if name is None or "|" in name or t.speed_power + t.term.degree != 2:
            return False
        i = COMPONENTS.index(t.component)
        if name.endswith("0"):
            theirs, ours = float(force(straight[None])[0, i]), wanted[name] * speed**2
        else:
            step = speed * np.eye(6)[MOTIONS.index(name[1:])]
            slopes = []
            for h in (STEP, STEP / 2.0):
                pair = force(np.array([straight + h * step, straight - h * step]))
                slopes.append(float(pair[0, i] - pair[1, i]) / (2.0 * h * speed))
            theirs, ours = 2.0 * slopes[1] - slopes[0], wanted[name] * speed
        return abs(theirs - ours) <= TOLERANCE * abs(ours)

    return held

"""Forces of first and second order in the six velocities: the form that most simulators hold.

Where a force law says U, the form says u: U v becomes |u| v, U^2 becomes u^2. Both agree on straight courses ahead and differ
by 1 - cos(beta) in drift. The resistance X0 U^2 alone stands whole, as u|u| + v^2 + w^2, which is U^2 on every course ahead.
"""

from __future__ import annotations

import numpy as np

from coeflab.core.axes import FLU
from coeflab.core.types import Array, dataclass, locking
from coeflab.law.force_law import ForceLaw, ForceTerm
from coeflab.law.symbols import COMPONENTS, MOTIONS

ROUNDING = 1e-12
SURGE = 0
ACROSS = (1, 2)


@dataclass(frozen=True, slots=True, eq=False)
@locking("linear signed absolute")
class SecondOrder:
    """force i = linear[i, j] nu_j + signed[i, j, k] nu_j nu_k + absolute[i, j, k] nu_j abs(nu_k).

    Attributes
    ----------
    linear : (6, 6) array
    signed : (6, 6, 6) array
        Zero below the diagonal j = k, so that every product stands once.
    absolute : (6, 6, 6) array
    resistance : float
        What u|u|, v^2 and w^2 in X hold in common as one resistance X0 U^2.
    """

    linear: Array
    signed: Array
    absolute: Array
    resistance: float = 0.0

    def force(self, nu: Array) -> Array:
        """(n, 6) for velocities (n, 6)."""
        out = nu @ self.linear.T + np.einsum("ijk,nj,nk->ni", self.signed, nu, nu)
        return np.asarray(out + np.einsum("ijk,nj,nk->ni", self.absolute, nu, np.abs(nu)))

    def turned(self, signs: Array = FLU) -> SecondOrder:
        """In axes of which each is the old one times a sign; factors between bars do not turn."""
        s = signs
        both = np.outer(s, s)
        return SecondOrder(
            self.linear * both,
            self.signed * both[:, :, None] * s[None, None, :],
            self.absolute * both[:, :, None],
            self.resistance,
        )

    def less(self, quadratics: Array) -> SecondOrder:
        """What remains for a target that adds quadratics (6, 6, 6) itself.

        Taken from |u| v where a term stands there, else from the signed product; what rounding leaves is zero.
        """
        signed, absolute = self.signed.copy(), self.absolute.copy()
        once = products_once(quadratics)
        for i, j, k in np.argwhere(once):
            at = (i, k, SURGE) if j == SURGE and k != SURGE and absolute[i, k, SURGE] else None
            held, place = (absolute, at) if at else (signed, (i, j, k))
            left = held[place] - once[i, j, k]
            held[place] = 0.0 if abs(left) <= ROUNDING * abs(once[i, j, k]) else left
        return SecondOrder(self.linear, signed, absolute, self.resistance)


def products_once(quadratics: Array) -> Array:
    """Quadratics that are symmetric in their last axes, as coefficients of products that stand once."""
    return np.asarray(np.triu(quadratics + np.swapaxes(quadratics, 1, 2)) - np.einsum(
        "ijk,jk->ijk", quadratics, np.eye(6)
    ))  # fmt: skip


Slot = tuple[str, int, int]


def slot(term: ForceTerm) -> Slot | None:
    """Where a term stands: ``linear``, ``signed`` or ``absolute`` with its velocities; None where the form has no place."""
    signed = sorted(MOTIONS.index(v) for v, n, a in term.product.factors for _ in range(n) if not a and v in MOTIONS)
    bars = sorted(MOTIONS.index(v) for v, n, a in term.product.factors for _ in range(n) if a and v in MOTIONS)
    if len(signed) + len(bars) != term.product.degree:
        return None
    match signed, bars, term.speed_power:
        case [j], [], 0:
            return "linear", j, 0
        case [j, k], [], 0:
            return "signed", j, k
        case [j], [k], 0:
            return "absolute", j, k
        case [], [j, k], 0 if j == k:
            return "signed", j, k
        case [j], [], 1:
            return "absolute", j, SURGE
        case [], [k], 1:
            return "absolute", SURGE, k
        case [], [], 2:
            return ("absolute" if term.component == "X" else "signed"), SURGE, SURGE
        case _:
            return None


def resists(term: ForceTerm) -> bool:
    """Whether a term is the resistance X0 U^2."""
    return term.component == "X" and term.product.degree == 0 and term.speed_power == 2


def second_order(law: ForceLaw) -> SecondOrder:
    """A force law, its ideal fluid's products among them, without the terms that have no `slot`."""
    arrays = {"linear": np.zeros((6, 6)), "signed": products_once(law.ideal), "absolute": np.zeros((6, 6, 6))}
    resistance = 0.0
    for t in law.terms:
        place = slot(t)
        if place is None:
            continue
        kind, j, k = place
        at = (COMPONENTS.index(t.component), j) if kind == "linear" else (COMPONENTS.index(t.component), j, k)
        arrays[kind][at] += t.coefficient
        if resists(t):
            resistance += t.coefficient
            for across in ACROSS:
                arrays["signed"][SURGE, across, across] += t.coefficient
    return SecondOrder(arrays["linear"], arrays["signed"], arrays["absolute"], resistance)

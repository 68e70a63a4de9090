"""A Munk moment counted twice: written as damping into a file whose simulator adds that of its added mass itself.

The moment of an ideal fluid on a body in steady drift is (Yvdot - Xudot) u v in yaw and its like in pitch (Lamb 1932, article
124). A measured derivative contains it; what remains of a hull once it is taken out is the lift of tail and fins, of the
other sign. So a written slope of the same sign and size as the ideal fluid's is the measured total.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.model.check import Check, Severity
from coeflab.model.second_order import products_once

Array = NDArray[np.float64]
# A product u v over the ideal fluid's; a linear term over it is a speed, m/s.
SIMILAR = (0.5, 2.0)
USUAL_SPEEDS = (0.5, 4.0)
MOMENTS = {"N": (5, 0, 1), "M": (4, 0, 2)}
PRODUCTS = {"N": "u v", "M": "u w"}


@dataclass(frozen=True, slots=True)
class Written:
    """One term of a file that turns a body in drift.

    Attributes
    ----------
    component : str
        ``N`` for what goes with v, ``M`` for what goes with w.
    key : str
        Where it stands in the file.
    value : float
        FRD; of u v or u w in kg, or of v or w in N m/(m/s).
    with_speed : bool
        Whether the force is that of the product with u.
    """

    component: str
    key: str
    value: float
    with_speed: bool


def munk_twice(kind: str, written: Sequence[Written], added: Array, ideal: Array) -> tuple[Check, ...]:
    """Findings about yaw and pitch.

    Parameters
    ----------
    kind : str
        Format of the file.
    written : sequence of Written
    added : (6, 6, 6) array
        Quadratics that the simulator adds itself, FRD.
    ideal : (6, 6, 6) array
        Those of an ideal fluid for the file's added mass.

    Notes
    -----
    A term of the product u v fails from half to twice the ideal fluid's. A linear one does not grow with the speed as the
    Munk moment does; it is pointed at where both are equal at a usual speed of a vehicle, 0.5 to 4 m/s.
    """
    out = []
    for component, at in MOMENTS.items():
        own, potential = products_once(added)[at], products_once(ideal)[at]
        if own == 0.0 or potential == 0.0:
            continue
        for with_speed in (True, False):
            terms = [w for w in written if (w.component, w.with_speed) == (component, with_speed) and w.value != 0.0]
            total = sum(w.value for w in terms)
            share = total / potential
            low, high = SIMILAR if with_speed else USUAL_SPEEDS
            if low <= share <= high:
                keys = ", ".join(w.key for w in terms)
                out.append(_check(kind, component, keys, total, own, share, with_speed, bool(own * potential > 0.0)))
    return tuple(out)


def _check(
    kind: str, component: str, keys: str, total: float, own: float, share: float, with_speed: bool, same: bool
) -> Check:
    product = PRODUCTS[component]
    mine = f"{total:.4g} {product}" if with_speed else f"{total:.4g} {product[-1]}, equal at {share:.3g} m/s"
    viscous = f", here {total - own:.4g} {product}" if with_speed else ""
    comment = (
        f"Munk moment twice: the simulator adds it from the added mass. Write the total less that{viscous}."
        if same
        else "The Coriolis term of the simulator has the reverse sign: the two cancel. Disable it and keep the total here."
    )
    return Check(
        kind, keys, Severity.FAIL if with_speed else Severity.WARN,
        f"{component} of {mine}, beside {own:.4g} {product} of the simulator's C_A(nu)", "the Munk moment once", comment,
    )  # fmt: skip

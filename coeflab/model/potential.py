"""What an ideal fluid gives to a velocity derivative: total = potential + viscous.

A measured force in steady motion holds every entry of -C_A(nu) nu: the Munk moment in Nv and Mw, and shares of Yr, Nr, Zq,
Mq, Xvr and others. A simulator that adds C_A(nu) itself must be given the viscous part alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from coeflab.core.symbols import COMPONENTS, MOTIONS, derivative
from coeflab.kernels.kirchhoff import ideal_quadratics
from coeflab.model.added_mass import AddedMass
from coeflab.model.scaling import Scaling

Array = NDArray[np.float64]


def potential_part(symbol: str, added_mass: AddedMass, scaling: Scaling, density: float) -> float | None:
    """The potential part of a primed derivative.

    Parameters
    ----------
    symbol : str
        With or without prime. Terms of the first order are derivatives at straight motion with u = U.
    added_mass : AddedMass
        About the point that the derivative is about.
    scaling : Scaling
    density : float
        That the added mass was computed with, kg/m^3.

    Returns
    -------
    float or None
        Zero for terms in |v| and of the third order: an ideal fluid has products of two velocities only. None for controls
        and accelerations, of which it is no part.

    Notes
    -----
    In primes u is sqrt(1 - v'^2 - w'^2), so a product u v written in v' alone has a tail, -v'^3 / 2 and on. It is not
    booked: a target that adds u v itself differs by it, 1 - cos(beta) of the potential part, as its loss report shows.
    """
    d = derivative(symbol)
    if any(f not in MOTIONS for f in d.factors):
        return None
    if "|" in d.text or len(d.factors) > 2:
        return 0.0
    force = COMPONENTS.index(d.component)
    quadratics = ideal_quadratics(added_mass.matrix)[force]
    at = [MOTIONS.index(f) for f in d.factors]
    if not at:
        value = quadratics[0, 0]
    elif len(at) == 1:
        value = 2.0 * quadratics[0, at[0]]
    else:
        value = quadratics[at[0], at[1]] * (1.0 if at[0] == at[1] else 2.0)
    return float(value / (0.5 * density * scaling.length ** d.powers[1]))

"""Layers of cells on a wall: how many, how thick.

They lead from a first cell of the wanted y+ to a last one that suits the cell on it. On a foil they grow by a fifth and begin at
the lower end of the logarithmic law, so that together they are about as thick as its boundary layer: eight on SUBOFF's sail
(9.9 mm for .37 c Re^-1/5 = 9.1 mm at 2 m/s), five on its planes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from coeflab.core.declarations import one_of
from coeflab.law.friction_line import friction_line
from coeflab.law.scaling import Conditions
from coeflab.tank.openfoam.features import foils

if TYPE_CHECKING:
    from coeflab.tank.towed_body import TowedBody

Wall = Annotated[str, one_of("functions", "resolved", "none")]
# Of the middle of the first cell: within the log law (30 to 300) and above its foot where the flow slows down on a hull, at its foot
# on foils, whose boundary layer is thin; inside the viscous sublayer, below 1, of a resolved wall.
Y_PLUS, Y_PLUS_OF_FOILS = {"functions": 60.0, "resolved": 0.8}, {"functions": 30.0, "resolved": 0.8}
GROWTH, LAST_LAYER, LEAST_LAYER = 1.3, 0.35, 0.02  # the last and the thinnest over the cell that they lie on
GROWTH_OF_FOILS, LAST_OF_FOILS, LEAST_OF_FOILS = 1.2, 0.43, 0.01
FEWEST_ON_FOILS, MOST_LAYERS = 3, 30
THICKEST = 1.5  # all layers of a foil over its boundary layer


@dataclass(frozen=True, slots=True)
class Layers:
    """Layers on a patch.

    Attributes
    ----------
    count : int
    last : float
        Thickness of the outermost one over the cell that it lies on.
    first : float
        Thickness at the wall, m, on the grid ``medium``.
    growth : float
        From one to the next.
    least : float
        Thickness below which none is laid, over the cell.
    """

    count: int
    last: float
    first: float
    growth: float = GROWTH
    least: float = LEAST_LAYER


def layers(
    body: TowedBody, patch: str, edge: float, wall: str, y_plus: float | None, conditions: Conditions
) -> Layers | None:
    """As many as lead from the first cell to the last one; of foils three at least, the first one thinner if need be.

    Parameters
    ----------
    body : TowedBody
    patch : str
    edge : float
        Of the cells on it, m.
    wall : {"functions", "resolved", "none"}
    y_plus : float or None
        Of the middle of the first cell.
    conditions : Conditions

    Returns
    -------
    Layers or None
        None without a wall or a viscosity, and where the first layer of a hull would be thicker than the last.
    """
    if wall == "none" or conditions.viscosity is None:
        return None
    is_foil = patch in foils(body)
    growth, last = (GROWTH_OF_FOILS, LAST_OF_FOILS) if is_foil else (GROWTH, LAST_LAYER)
    wanted = y_plus or (Y_PLUS_OF_FOILS if is_foil else Y_PLUS)[wall]
    chord = body.chord.get(patch, body.length)
    first = 2.0 * wanted * wall_unit(conditions.speed, chord, conditions.viscosity)
    count = min(1 + round(float(np.log(last * edge / first) / np.log(growth))), MOST_LAYERS)
    if is_foil:
        over = THICKEST * boundary_layer(conditions.speed, chord, conditions.viscosity) / first
        count = min(count, round(float(np.log(1.0 + (growth - 1.0) * over) / np.log(growth))))
        if count < FEWEST_ON_FOILS:
            count, first = FEWEST_ON_FOILS, min(first, last * edge / growth ** (FEWEST_ON_FOILS - 1))
    if count < 1:
        return None
    least = LEAST_OF_FOILS if is_foil else LEAST_LAYER
    return Layers(count, first * growth ** (count - 1) / edge, first, growth, least)


def wall_unit(speed: float, length: float, viscosity: float) -> float:
    """Viscous length nu/u_tau of a turbulent boundary layer on a plate, m; friction by the ITTC 1957 line.

    Parameters
    ----------
    speed, length : float
        m/s and m; a Reynolds number below 1e4, where the line means nothing, counts as 1e4.
    viscosity : float
        Kinematic, m^2/s.
    """
    reynolds = max(speed * length / viscosity, 1e4)
    return float(viscosity / (speed * np.sqrt(friction_line(reynolds) / 2.0)))


def boundary_layer(speed: float, length: float, viscosity: float) -> float:
    """Thickness of a turbulent boundary layer at the end of a plate, .37 L Re^-1/5 (Prandtl), m.

    Parameters
    ----------
    speed, length : float
        m/s and m; a Reynolds number below 1e4 counts as 1e4.
    viscosity : float
        Kinematic, m^2/s.
    """
    return float(0.37 * length * max(speed * length / viscosity, 1e4) ** -0.2)

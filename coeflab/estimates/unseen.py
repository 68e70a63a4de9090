"""Area that no method sees: no force of its own, and a half-width for the lift, the cross-flow and the drag that it may have.

A part that is taken for bluff has its drag elsewhere; the lift that a foil in its place would have is unknown, and stands here too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from coeflab.bodies.fin_lift import low_aspect_lift_slope
from coeflab.bodies.outline import Outline
from coeflab.core.types import Array, brief, locking
from coeflab.estimates import Contribution, Forces, Water

summary = "half-widths for area that no other method sees, and for the lift of bluff parts on a hull"
citations = ("whicker1958", "pitts1957", "hoerner1965")

ASPECT = 2.0  # with its mirror image: in the middle of what was tested, 1 to 3
# NACA 1307, a foil twice as high as the hull's radius: with the hull's share.
HULL_CARRYOVER = ((1.0 + 1.0 / 3.0) ** 2 + 4.0 / 3.0) / 2.0
PLATE_DRAG = 1.17  # a plate across, Hoerner 1965, chapter 3
FRICTION_ALONG = 0.05  # friction of both sides and interference, of the area from the side


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("centre")
class HalfWidth:
    """One half-width of a force at a place.

    Attributes
    ----------
    centre : (3,) array
        m, from the datum.
    row : int
        Along x, y or z.
    lift, drag : float
        Per 1/2 rho: of |u| and the velocity along the row, and of that velocity and its size, m^2.
    density : float
    """

    centre: NDArray[np.float64]
    row: int
    lift: float
    drag: float
    density: float

    def __call__(self, nu: Array, angles: dict[str, Array]) -> Array:
        """Forces about the datum, (n, 6)."""
        del angles
        own = nu[:, :3] + np.cross(nu[:, 3:], self.centre)
        ahead, velocity = np.abs(own[:, 0]), own[:, self.row]
        force = np.zeros((len(nu), 3))
        force[:, self.row] = -0.5 * self.density * (self.lift * ahead + self.drag * np.abs(velocity)) * velocity
        return np.hstack([force, np.cross(self.centre, force)])


def contributions(outline: Outline, water: Water) -> tuple[Contribution, ...]:
    """Half-widths of every unseen area, and of the lift of bluff parts beside a hull.

    Parameters
    ----------
    outline : Outline
    water : Water
    """
    out = []
    for one in outline.unseen:
        out.append(_contribution(one.name, "unseen area", one.centre, one.areas, PLATE_DRAG, water))
    for part in outline.bluff if outline.hulls else ():
        out.append(_contribution(part.name, "lift not computed", part.centre, part.areas, 0.0, water))
    return tuple(out)


def _contribution(name: str, kind: str, centre: Array, areas: Array, cross: float, water: Water) -> Contribution:
    slope = low_aspect_lift_slope(ASPECT) * HULL_CARRYOVER
    halves: list[Forces] = []
    for row in (1, 2):
        halves.append(HalfWidth(centre, row, slope * float(areas[row]), 0.0, water.density))
        if cross:
            halves.append(HalfWidth(centre, row, 0.0, cross * float(areas[row]), water.density))
    if cross:
        halves.append(HalfWidth(centre, 0, 0.0, FRICTION_ALONG * float(areas[1:].sum()), water.density))
    place = f"half-width: lift of a foil of aspect {ASPECT:g}, drag of a plate"
    return Contribution(name, kind, "unseen", _none, 0.0, ", ".join(citations), place, scatter=tuple(halves))


def _none(nu: Array, angles: dict[str, Array]) -> Array:
    del angles
    return np.zeros((len(nu), 6))

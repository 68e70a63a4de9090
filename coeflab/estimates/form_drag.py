"""Form and base drag of hulls, over the friction of their surface."""

from __future__ import annotations

from functools import partial

import numpy as np

from coeflab.bodies.hull_flow import axial, hull_flow
from coeflab.bodies.outline import Outline
from coeflab.estimates import Contribution, Water

summary = "form drag of hulls over their friction by Hoerner and by Gillmer & Johnson, drag of blunt bases by Hoerner"
citations = ("hoerner1965", "gillmer1982")

SHARE, BLUNT = 0.30, 0.02  # base area over the largest section


def hoerner_form(fineness: float) -> float:
    """Form drag over friction of a streamlined body (Hoerner 1965, equation 6-28): 1.5 (d/l)^(3/2) + 7 (d/l)^3."""
    return float(1.5 * fineness**-1.5 + 7.0 * fineness**-3)


def gillmer_form(fineness: float) -> float:
    """The same after Gillmer & Johnson (1982): 0.5 d/l + 3 (d/l)^3."""
    return float(0.5 / fineness + 3.0 * fineness**-3)


def base_drag(forebody: float) -> float:
    """C_D of a blunt base on its area, from that of the forebody on the same area (Hoerner 1965, chapter 3): 0.029 / sqrt."""
    return float(0.029 / np.sqrt(forebody))


def contributions(outline: Outline, water: Water) -> tuple[Contribution, ...]:
    """Axial force of every hull.

    Parameters
    ----------
    outline : Outline
    water : Water
    """
    out = []
    for hull in outline.hulls:
        flow = hull_flow(hull, water.density, water.viscosity, water.speed)
        fineness, friction = hull.length / flow.diameter, flow.friction * float(flow.surface[-1])
        place = np.array([hull.x.mean(), *flow.axis])
        outside = "" if fineness >= 3.0 else f"length over diameter {fineness:.2g} is below 3"
        two = (("Hoerner", hoerner_form, "hoerner1965", "equation 6-28"),
               ("Gillmer & Johnson", gillmer_form, "gillmer1982", "form factor of submarines"))  # fmt: skip
        for name, form, work, where in two:
            force = partial(axial, form(fineness) * friction, place, water.density)
            out.append(Contribution(hull.name, "form drag", f"form_drag, {name}", force, SHARE, work, where, outside))
        base, largest = float(hull.area[-1]), float(hull.area.max())
        if base > BLUNT * largest:
            area = base_drag(friction / base) * base
            force = partial(axial, area, place, water.density)
            out.append(
                Contribution(hull.name, "base drag", "form_drag", force, SHARE, "hoerner1965", "chapter 3, base drag")
            )
    return tuple(out)

"""Friction of hulls and foils: the ITTC 1957 line on the wetted surface, with an allowance for roughness."""

from __future__ import annotations

from functools import partial

import numpy as np

from coeflab.bodies.hull_flow import axial, hull_flow
from coeflab.bodies.outline import Outline
from coeflab.estimates import Contribution, Water
from coeflab.law.friction_line import friction_line

summary = "friction of hulls and foils: ITTC 1957 line, roughness by Townsin; thickness of sections by Hoerner"
citations = ("ittc1957", "townsin1990", "hoerner1965")

HULL_SHARE, FOIL_SHARE = 0.10, 0.30


def roughness_allowance(reynolds: float, relative: float) -> float:
    """Delta C_F of a roughness height over the length (Townsin; ITTC 7.5-02-02-02): at least zero.

    0.044 ((k/L)^(1/3) - 10 Re^(-1/3)) + 0.000125.
    """
    if relative <= 0.0:
        return 0.0
    return float(max(0.0, 0.044 * (relative ** (1.0 / 3.0) - 10.0 * reynolds ** (-1.0 / 3.0)) + 0.000125))


def section_drag(friction: float, thickness: float) -> float:
    """C_D of a foil section by its planform, from C_F on one side (Hoerner 1965, equation 6-6)."""
    return 2.0 * friction * (1.0 + 2.0 * thickness + 60.0 * thickness**4)


def contributions(outline: Outline, water: Water) -> tuple[Contribution, ...]:
    """Axial force of every hull, foil and ring wing.

    Parameters
    ----------
    outline : Outline
    water : Water
    """
    out = []
    for hull in outline.hulls:
        flow = hull_flow(hull, water.density, water.viscosity, water.speed)
        reynolds = water.speed * hull.length / water.viscosity
        line = flow.friction + roughness_allowance(reynolds, water.roughness / hull.length)
        area = line * float(flow.surface[-1])
        force = partial(axial, area, np.array([hull.x.mean(), *flow.axis]), water.density)
        outside = "" if reynolds > 1e5 else f"Re {reynolds:.2g} is below 1e5: no turbulent layer all along"
        out.append(
            Contribution(
                hull.name, "friction", "friction", force, HULL_SHARE, "ittc1957", "8th ITTC, friction line", outside
            )
        )
    thin = [(f.name, f.area, (f.root_chord + f.tip_chord) / 2.0, f.thickness, (f.root + f.tip) / 2.0)
            for f in outline.foils]  # fmt: skip
    thin += [(r.name, np.pi * r.diameter * r.chord, r.chord, r.thickness, r.centre) for r in outline.rings]
    for name, planform, chord, thickness, centre in thin:
        line = friction_line(water.speed * chord / water.viscosity)
        area = section_drag(line, thickness) * float(planform)
        force = partial(axial, area, np.asarray(centre), water.density)
        out.append(Contribution(name, "friction", "friction", force, FOIL_SHARE, "hoerner1965", "equation 6-6"))
    return tuple(out)

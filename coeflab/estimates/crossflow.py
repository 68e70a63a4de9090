"""Viscous forces across hulls, strip by strip: friction, linear in the cross velocity, and drag, quadratic in it."""

from __future__ import annotations

from functools import partial

import numpy as np

from coeflab.bodies.hull_flow import HullFlow, hull_flow, integral, surge
from coeflab.bodies.outline import Outline
from coeflab.core.types import Array
from coeflab.estimates import Contribution, Water

summary = "cross-flow of hulls by strips: friction and drag, of sway, heave, yaw, pitch and their products"
citations = ("allen1951", "roshko1961", "hoerner1965")

# Drag of cylinders of finite length over that of long ones (Wieselsberger's tests: 0.63, 0.68, 0.74, 0.74, 0.82, 0.90, 0.98
# of 1.20), the eta of Allen & Perkins.
LENGTHS, DRAGS, LONG = (1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 40.0), (0.63, 0.68, 0.74, 0.74, 0.82, 0.90, 0.98), 1.20
SUBCRITICAL, SUPERCRITICAL = 1.2, 0.7  # Allen & Perkins; Roshko above Re 3.5e6
SQUARE = 2.05  # Hoerner: a square across
DRAG_SHARE, FRICTION_SHARE = 0.30, 0.50


def of_finite_length(fineness: float) -> float:
    """Drag of a cylinder of that length over diameter over that of a long one."""
    return float(np.interp(np.log(max(fineness, 1e-9)), np.log(LENGTHS), DRAGS) / LONG)


def fuller(fullness: float) -> float:
    """Drag of a section over that of an ellipse, linear in area over breadth times depth up to the square's."""
    square = (fullness - np.pi / 4.0) / (1.0 - np.pi / 4.0)
    return float(1.0 + np.clip(square, 0.0, 1.0) * (SQUARE / SUBCRITICAL - 1.0))


def contributions(outline: Outline, water: Water) -> tuple[Contribution, ...]:
    """Forces across every hull.

    Parameters
    ----------
    outline : Outline
    water : Water
    """
    out = []
    for hull in outline.hulls:
        flow = hull_flow(hull, water.density, water.viscosity, water.speed)
        friction = partial(rubbed, flow)
        out.append(
            Contribution(
                hull.name, "cross-flow friction", "crossflow", friction, FRICTION_SHARE, "ittc1957",
                "shear along the local stream about a round section",
            )
        )  # fmt: skip
        boxed = float(np.max(hull.breadth * hull.depth))
        shape = 1.0 if hull.round_sections or boxed <= 0.0 else fuller(float(np.max(hull.area)) / boxed)
        shape *= of_finite_length(hull.length / flow.diameter)
        two = ((SUBCRITICAL, "allen1951", "equation 5, c_dc 1.2"), (SUPERCRITICAL, "roshko1961", "Re above 3.5e6"))
        for coefficient, work, place in two:
            force = partial(dragged, flow, coefficient * shape)
            out.append(
                Contribution(
                    hull.name, "cross-flow drag", f"crossflow, c_dc {coefficient:g}", force, DRAG_SHARE, work, place
                )
            )
    return tuple(out)


def across(flow: HullFlow, nu: Array) -> tuple[Array, Array]:
    """Velocities v and w at each station, (n, m)."""
    x, (y, z) = flow.hull.x, flow.axis
    side = nu[:, 1:2] + nu[:, 5:6] * x - nu[:, 3:4] * z
    down = nu[:, 2:3] - nu[:, 4:5] * x + nu[:, 3:4] * y
    return side, down


def collected(flow: HullFlow, side: Array, down: Array) -> Array:
    """(n, 6) forces about the datum of (n, m) loads per length along y and z."""
    x, (y, z) = flow.hull.x, flow.axis
    lateral, normal = integral(side, x), integral(down, x)
    out = np.zeros((len(side), 6))
    out[:, 1], out[:, 2], out[:, 3] = lateral, normal, y * normal - z * lateral
    out[:, 4], out[:, 5] = -integral(down * x, x), integral(side * x, x)
    return out


def rubbed(flow: HullFlow, nu: Array, angles: dict[str, Array]) -> Array:  # noqa: ARG001 - as forces are
    """Friction across: mean over the girth of 2 v sin^2, times 1/2 rho C_F |u|."""
    side, down = across(flow, nu)
    share = -0.5 * flow.density * flow.friction * flow.hull.girth * np.abs(surge(flow.axis, nu))[:, None]
    return collected(flow, share * side, share * down)


def dragged(flow: HullFlow, coefficient: float, nu: Array, angles: dict[str, Array]) -> Array:  # noqa: ARG001
    """Drag across: 1/2 rho c_dc of the section's height by the local cross velocity."""
    side, down = across(flow, nu)
    share = -0.5 * flow.density * coefficient * np.hypot(side, down)
    return collected(flow, share * flow.hull.depth * side, share * flow.hull.breadth * down)

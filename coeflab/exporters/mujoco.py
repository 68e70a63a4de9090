"""MuJoCo: a free body with one geom of ``fluidshape="ellipsoid"``.

The ellipsoid has the file's three added masses, hence its Munk moment; MuJoCo has no force in proportion to acceleration, so
the body moves without added inertia. Five coefficients and the place of the geom are all that is left: they take X0, Yv, Nv,
Yr and a mean of Nr.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.identifiers import identifier, one_line
from coeflab.core.xml import numbers, parse_xml, serialised
from coeflab.kernels.mujoco_fluid import FluidEllipsoid, ellipsoid_of_masses
from coeflab.model.exported_law import central_inertia, centre_of_gravity, number, states_buoyancy
from coeflab.model.force_law import ForceLaw, force_law
from coeflab.model.inertia import water_inertia
from coeflab.model.loss import unheld
from coeflab.model.lost import missing_mass
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.straight_motion import held_when_straight

summary = "MuJoCo: an MJCF body with a fluid ellipsoid; Munk moment and drag, no added inertia"
citations = ("lamb1932", "mujoco")
adds_coriolis = True
holds: frozenset[str] = frozenset()

Array = NDArray[np.float64]
FLU = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
RATE = 0.25
HELD = 1e-6
_LEFT_OUT = "added inertia: MuJoCo has no force in proportion to acceleration"


@dataclass(frozen=True, slots=True, eq=False)
class _Geom:
    """The ellipsoid, x of its centre ahead of the reference point, m, as it is and as Nv would have it, and the r L/U of Nr."""

    ellipsoid: FluidEllipsoid
    forward: float
    rate: float
    wanted: float

    def force(self, nu: Array) -> Array:
        """(n, 6), FRD, about the reference point."""
        v, w = (nu * FLU)[:, :3], (nu * FLU)[:, 3:]
        arm = np.array([self.forward, 0.0, 0.0])
        force, torque = self.ellipsoid.force(v + np.cross(w, arm), w)
        return np.asarray(np.hstack([force, torque + np.cross(arm, force)]) * FLU)


def _fitted(parameters: ParameterFile) -> tuple[_Geom, ForceLaw]:
    """The geom whose law is nearest in the sense of the module's first lines.

    Raises
    ------
    InputError
        The added masses along x, y and z are not all known, or those of no ellipsoid.
    """
    law = force_law(parameters)
    masses, rho = np.diag(water_inertia(parameters).matrix)[:3], parameters.conditions.density
    if np.any(masses <= 0.0):
        raise InputError("no added mass along x, y and z", "an added mass, for the ellipsoid takes its shape from it")
    axes, miss = ellipsoid_of_masses(masses, rho)
    if miss > HELD:
        raise InputError(f"added masses {', '.join(f'{m:.4g}' for m in masses)} kg", "those of some ellipsoid")
    of = {t.symbol: t.coefficient for t in law.terms if t.speed_power == 2 - t.term.degree}
    (a, b, c), length = axes, parameters.scaling.length
    drag, cross = max(0.0, -of.get("X0", 0.0)), max(0.0, -of.get("Yv|v|", 0.0))
    sway, munk = of.get("Yv", 0.0), float(masses[1] - masses[0])
    blunt, slender = _drag(axes, drag / rho, cross / rho)
    lift = 0.0 if not sway or np.isclose(a, b) else (-sway - drag) / (rho * np.pi * b * c * ((a / b) ** 2 - 1.0))
    wanted = (of["Nv"] + munk) / sway if lift and "Nv" in of else 0.0
    forward = wanted if abs(wanted) <= length else 0.0
    volume = 4.0 / 3.0 * np.pi * a * b * c
    surge = float(masses[0])
    magnus = (of["Yr"] - forward * sway + surge) / (rho * volume) if "Yr" in of else 0.0
    turning = forward * (forward * sway - surge + magnus * rho * volume - munk) - of.get("Nr", 0.0)
    rates = [max(abs(r.low), abs(r.high)) / 2.0 for r in parameters.covered if r.variable == "r'"]
    rate = max(rates, default=0.0) or RATE
    longest, middle = np.sort(axes)[::-1][:2]
    swept, largest = 8.0 / 15.0 * np.pi * c * max(a, b) ** 4, 8.0 / 15.0 * np.pi * middle * longest**4
    angular = (turning * length / (rho * rate) - slender * (largest - swept)) / swept if "Nr" in of else 0.0
    coefficients = (blunt, slender, max(0.0, float(angular)), float(lift), float(magnus))
    return _Geom(FluidEllipsoid(axes, *coefficients, rho), float(forward), rate, float(wanted)), law


def _drag(axes: Array, ahead: float, across: float) -> tuple[float, float]:
    """Blunt and slender coefficients for drags per density ahead and abeam; equal, the same drag whatever the course, where the
    latter is not known or both do not fit.
    """
    a, b, c = axes
    front, side, longest = np.pi * b * c, np.pi * a * c, np.pi * np.prod(np.sort(axes)[1:])
    system = np.array([[front, longest - front], [side, longest - side]])
    if across and not np.isclose(front, side):
        blunt, slender = np.linalg.solve(system, [ahead, across])
        if blunt >= 0.0 and slender >= 0.0:
            return float(blunt), float(slender)
    return ahead / float(longest), ahead / float(longest)


def render(parameters: ParameterFile) -> Mapping[str, bytes]:
    """One model file; the body's frame is x forward, y port, z up, its origin the reference point.

    Raises
    ------
    InputError
        As `_fitted` says, or an inertia that is not positive.
    """
    geom, _ = _fitted(parameters)
    e, name = geom.ellipsoid, identifier(parameters.name)
    a, b, c = (float(x) for x in e.axes)
    root = Element("mujoco", model=name)
    SubElement(root, "option", density=number(e.density), viscosity="0", integrator="implicitfast")
    body = SubElement(SubElement(root, "worldbody"), "body", name=name, gravcomp="1")
    SubElement(body, "freejoint")
    if parameters.mass is not None:
        mass, at = parameters.mass.mass, centre_of_gravity(parameters) * FLU[:3]
        solid = mass / 5.0 * np.diag([b**2 + c**2, a**2 + c**2, a**2 + b**2])
        known = central_inertia(parameters)
        ((xx, xy, xz), (_, yy, yz), (_, _, zz)) = (
            solid if known is None else known * np.outer(FLU[:3], FLU[:3])
        ).tolist()
        moments = _row(xx, yy, zz, xy, xz, yz)
        SubElement(body, "inertial", pos=_row(*at.tolist()), mass=number(mass), fullinertia=moments)
    SubElement(
        body, "geom", name="fluid", type="ellipsoid", size=_row(a, b, c), pos=_row(geom.forward, 0.0, 0.0), density=number(e.density),
        contype="0", conaffinity="0", fluidshape="ellipsoid", fluidcoef=_row(e.blunt, e.slender, e.angular, e.kutta, e.magnus),
    )  # fmt: skip
    comment = (
        f"{one_line(parameters.name)}, body: {one_line(parameters.body)}",
        f"Shape by the inertia of the water: {one_line(water_inertia(parameters).source)}",
        "Body frame: x forward, y port, z up, origin at the reference point. Weight is balanced (gravcomp), nothing rights it.",
    )
    return {f"{name}.xml": serialised(root, comment)}


def _row(*values: float) -> str:
    return " ".join(number(v) for v in values)


def force(files: Mapping[str, bytes], nu: NDArray[np.float64]) -> NDArray[np.float64]:
    """MuJoCo's own law (`coeflab.kernels.mujoco_fluid`, with its source) of the geom in the file, turned to FRD."""
    (content,) = files.values()
    root = parse_xml(content.decode())
    option, geom = root.find("option"), root.find("worldbody/body/geom")
    if option is None or geom is None:
        raise InputError("no geom", "a body with a fluid ellipsoid")
    size = np.array(numbers(geom.get("size"), (3,), "size"))
    at = numbers(geom.get("pos"), (3,), "pos")
    blunt, slender, angular, kutta, magnus = numbers(geom.get("fluidcoef"), (5,), "fluidcoef")
    density, viscosity = float(option.get("density", "0")), float(option.get("viscosity", "0"))
    fluid = FluidEllipsoid(size, blunt, slender, angular, kutta, magnus, density, viscosity)
    return _Geom(fluid, at[0], RATE, at[0]).force(nu)


def added_mass(files: Mapping[str, bytes]) -> Array:  # noqa: ARG001 - the port's signature
    """Zero: MuJoCo has no force in proportion to acceleration."""
    return np.zeros((6, 6))


def not_held(parameters: ParameterFile) -> tuple[str, ...]:
    """Added inertia; every term whose derivative at straight motion is not the target's; products; controls."""
    geom, law = _fitted(parameters)
    held = held_when_straight(geom.force, parameters.conditions.speed)
    return (_LEFT_OUT, *unheld(law, held, ideal=False))


def missing(parameters: ParameterFile) -> tuple[str, ...]:
    """Mass and moments of inertia, where the file has none."""
    return missing_mass(
        parameters, "those of the ellipsoid, solid and as heavy as the file says or water, stand until you write yours"
    )


def changes(parameters: ParameterFile) -> tuple[str, ...]:
    """How the ellipsoid was made, in words."""
    geom, _ = _fitted(parameters)
    source = water_inertia(parameters).source
    e = geom.ellipsoid
    a, b, c = e.axes
    said = [
        f"the hull is an ellipsoid of semi-axes {a:.4g} {b:.4g} {c:.4g} m, whose added masses along x, y and z are those of the file "
        f"({source}); MuJoCo adds its Munk moment",
        f"its centre lies {geom.forward:+.4g} m along x from the reference point, where Yv and the Munk moment make up the total Nv",
        f"fluidcoef: blunt and slender drag {e.blunt:.4g} {e.slender:.4g} from X0 and Yv|v|, Kutta lift {e.kutta:.4g} from Yv, Magnus "
        f"lift {e.magnus:.4g} from Yr",
        f"angular drag {e.angular:.4g}: quadratic in r, it stands for Nr at r L/U = {geom.rate:.3g} and the file's speed",
        "derivatives are met at straight motion; in drift and turning its lift and drag bend away, by the differences in this report",
        "axes: FRD to the body frame x forward, y port, z up",
        "weight is balanced by gravcomp and nothing rights the body: "
        + states_buoyancy(parameters, "the file states no buoyancy"),
    ]
    if geom.wanted != geom.forward:
        said.append(
            f"Nv would need the centre at {geom.wanted:+.4g} m, more than a length away: it stays, and Nv is the Munk moment alone"
        )
    return tuple(said)

"""An SDF model of one link under gz-sim's Hydrodynamics system, written from a parameter file."""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from numpy.typing import NDArray

from coeflab.core.errors import InputError
from coeflab.core.identifiers import identifier, one_line
from coeflab.core.xml import serialised
from coeflab.kernels.kirchhoff import ideal_quadratics
from coeflab.model.force_law import ForceLaw, force_law
from coeflab.model.gz_link import FLUID_TAGS, FORCES, SYSTEM, VELOCITIES
from coeflab.model.inertia import added_mass_of
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.second_order import FLU, SecondOrder, second_order, slot

Array = NDArray[np.float64]
LINK = "base_link"


def number(value: float) -> str:
    """All digits, and no minus before a zero."""
    return repr(float(value) + 0.0)


@dataclass(frozen=True, slots=True, eq=False)
class Hydrodynamics:
    """What both ways of writing share: the law, its second-order form in FRD, the added mass and where it comes from."""

    law: ForceLaw
    form: SecondOrder
    matrix: Array
    source: str
    mirrored: float

    @property
    def inert(self) -> bool:
        """Whether no added mass is known."""
        return not np.any(self.matrix)


def hydrodynamics(parameters: ParameterFile) -> Hydrodynamics:
    """Law and added mass of a parameter file; an asymmetric added mass is replaced by the mean of it and its mirror."""
    law = force_law(parameters)
    stated, source = added_mass_of(parameters)
    matrix = (stated + stated.T) / 2.0
    return Hydrodynamics(law, second_order(law), matrix, source, float(np.max(np.abs(stated - matrix))))


def viscous(h: Hydrodynamics) -> SecondOrder:
    """The form less everything that a target adds from the added mass."""
    return h.form.less(ideal_quadratics(h.matrix))


def sdf(parameters: ParameterFile, version: str, plugin: list[tuple[str, str]], fluid: Array | None) -> bytes:
    """A model whose link has its origin at the reference point.

    Parameters
    ----------
    parameters : ParameterFile
    version : str
        Of SDFormat.
    plugin : list of (tag, text)
    fluid : (6, 6) array or None
        FLU, positive.
    """
    root = Element("sdf", version=version)
    model = SubElement(root, "model", name=identifier(parameters.name))
    link = SubElement(model, "link", name=LINK)
    _inertial(link, parameters, fluid)
    SubElement(link, "gravity").text = "false"
    system = SubElement(model, "plugin", SYSTEM)
    SubElement(system, "link_name").text = LINK
    for tag, text in plugin:
        SubElement(system, tag).text = text
    p = parameters
    return serialised(
        root,
        (
            f"{one_line(p.name)}, body: {one_line(p.body)}",
            f"Link frame: x forward, y port, z up, origin at the reference point; density {number(p.conditions.density)} kg/m^3",
            "No weight and no buoyancy: the parameter file states neither. Collisions and visuals are yours to add.",
        ),
    )


def centre_of_gravity(parameters: ParameterFile) -> float:
    """x_G, m forward of the reference point; zero where the file has no mass."""
    return 0.0 if parameters.mass is None else parameters.mass.mass_moment / parameters.mass.mass


def central_inertia(parameters: ParameterFile) -> float | None:
    """Transverse moment of inertia through the centre of gravity.

    Raises
    ------
    InputError
        It would not be positive.
    """
    mass = parameters.mass
    if mass is None or mass.inertia is None:
        return None
    central = mass.inertia - mass.mass_moment**2 / mass.mass
    if central <= 0.0:
        raise InputError(f"an inertia of {central:g} kg m^2 through the centre of gravity", "one above zero", column="mass")
    return central


def _inertial(link: Element, parameters: ParameterFile, fluid: Array | None) -> None:
    if parameters.mass is None and fluid is None:
        return
    inertial = SubElement(link, "inertial")
    if parameters.mass is not None:
        SubElement(inertial, "pose").text = f"{number(centre_of_gravity(parameters))} 0 0 0 0 0"
        SubElement(inertial, "mass").text = number(parameters.mass.mass)
        central = central_inertia(parameters)
        if central is not None:
            inertia = SubElement(inertial, "inertia")
            for tag in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
                SubElement(inertia, tag).text = number(central) if tag[1] == tag[2] else "0"
    if fluid is not None:
        element = SubElement(inertial, "fluid_added_mass")
        for (i, j), tag in FLUID_TAGS.items():
            SubElement(element, tag).text = number(fluid[i, j])


def tags(form: SecondOrder) -> list[tuple[str, str]]:
    """Tags of the plugin for a form in FRD, without zeros."""
    turned = form.turned(FLU)
    out = []
    for i, j in np.argwhere(turned.linear):
        out.append((FORCES[i] + VELOCITIES[j], number(turned.linear[i, j])))
    for i, j, k in np.argwhere(turned.absolute):
        out.append((f"{FORCES[i]}{VELOCITIES[j]}abs{VELOCITIES[k]}", number(turned.absolute[i, j, k])))
    for i, j, k in np.argwhere(turned.signed):
        out.append((FORCES[i] + VELOCITIES[j] + VELOCITIES[k], number(turned.signed[i, j, k])))
    return out


def common_changes(parameters: ParameterFile, h: Hydrodynamics) -> tuple[str, ...]:
    """What any export of this kind changes, in words."""
    out = [
        "axes: FRD to the link frame x forward, y port, z up; Y Z M N v w q r change sign, factors between bars do not",
        f"numbers are SI: primes times 1/2 rho L^k at {parameters.conditions.density:g} kg/m^3",
    ]
    speed = [t.symbol for t in h.law.terms if t.speed_power and slot(t) is not None and t.coefficient]
    if speed:
        out.append(
            f"|u| stands for U in {', '.join(speed)} (u|u| or u^2 for U^2): alike on a straight course ahead, less by up to "
            "1 - cos(beta)^2 of the term in drift"
        )
    if h.mirrored:
        out.append(f"added mass: mean of the matrix and its mirror image, which differ by up to {2.0 * h.mirrored:.3g}")
    if parameters.mass is None:
        out.append("no mass in the parameter file: the target's default stands until you write the vehicle's")
    elif parameters.mass.inertia is None:
        out.append("no moment of inertia in the parameter file: the target's default stands until you write the vehicle's")
    else:
        out.append("roll inertia is not in the parameter file: the transverse one stands in its place; write the vehicle's")
    return (*out, "no weight and no buoyancy: the parameter file states neither")

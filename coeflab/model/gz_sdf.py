"""An SDF model of one link under gz-sim's Hydrodynamics system, written from a parameter file."""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

import numpy as np
from numpy.typing import NDArray

from coeflab.core.identifiers import identifier, one_line
from coeflab.core.xml import serialised
from coeflab.model.exported_law import central_inertia, centre_of_gravity, number
from coeflab.model.gz_link import FLUID_TAGS, FORCES, SYSTEM, VELOCITIES
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.second_order import FLU, SecondOrder

Array = NDArray[np.float64]
LINK = "base_link"
INERTIA = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
AXES = "axes: FRD to the link frame x forward, y port, z up; Y Z M N v w q r change sign, factors between bars do not"
WEIGHTLESS = "no weight and no buoyancy (<gravity> false): the parameter file states neither"


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


def _inertial(link: Element, parameters: ParameterFile, fluid: Array | None) -> None:
    if parameters.mass is None and fluid is None:
        return
    inertial = SubElement(link, "inertial")
    if parameters.mass is not None:
        centre = FLU[:3] * centre_of_gravity(parameters)
        SubElement(inertial, "pose").text = f"{' '.join(map(number, centre))} 0 0 0"
        SubElement(inertial, "mass").text = number(parameters.mass.mass)
        central = central_inertia(parameters)
        if central is not None:
            inertia = SubElement(inertial, "inertia")
            turned = central * np.outer(FLU[:3], FLU[:3])
            for i, j in INERTIA:
                SubElement(inertia, f"i{'xyz'[i]}{'xyz'[j]}").text = number(turned[i, j])
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


def placed(parameters: ParameterFile) -> tuple[str, ...]:
    """Where the link's origin and its centre of gravity are, in words."""
    at = FLU[:3] * centre_of_gravity(parameters) + 0.0
    moved = (f"centre of gravity at {at[0]:.6g} {at[1]:.6g} {at[2]:.6g} m, in <inertial><pose>",) if np.any(at) else ()
    return (AXES, "the link's origin is the reference point", *moved, WEIGHTLESS)

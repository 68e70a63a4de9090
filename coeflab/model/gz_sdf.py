"""An SDF model of one link under gz-sim's Hydrodynamics system, written from a parameter file."""

from __future__ import annotations

from collections.abc import Mapping
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from numpy.typing import NDArray

from coeflab.core.identifiers import identifier, one_line
from coeflab.core.xml import parse_xml, serialised
from coeflab.model.exported_law import central_inertia, centre_of_gravity, exported_law, number, states_buoyancy
from coeflab.model.gz_link import FLUID_TAGS, FORCES, RESISTANCE, SYSTEM, VELOCITIES, read_gz_link
from coeflab.model.inertia import water_inertia
from coeflab.model.loss import unheld
from coeflab.model.lost import missing_mass, missing_water
from coeflab.model.parameter_file import ParameterFile
from coeflab.model.second_order import FLU, SecondOrder, slot

Array = NDArray[np.float64]
LINK = "base_link"
INERTIA = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
AXES = "axes: FRD to the link frame x forward, y port, z up; Y Z M N v w q r change sign, factors between bars do not"
WEIGHTLESS = "no weight and no buoyancy"
NEITHER = "the parameter file states neither"


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
    source = water_inertia(p).source
    return serialised(
        root,
        (
            f"{one_line(p.name)}, body: {one_line(p.body)}",
            f"Link frame: x forward, y port, z up, origin at the reference point; density {number(p.conditions.density)} kg/m^3",
            f"Inertia of the water: {one_line(source)}",
            f"N{WEIGHTLESS[1:]}: {states_buoyancy(p, NEITHER)}. Collisions and visuals are yours to add.",
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
    """Tags of the plugin for a form in FRD, without zeros; the last says what its reader is to take for X0."""
    turned = form.turned(FLU)
    out = []
    for i, j in np.argwhere(turned.linear):
        out.append((FORCES[i] + VELOCITIES[j], number(turned.linear[i, j])))
    for i, j, k in np.argwhere(turned.absolute):
        out.append((f"{FORCES[i]}{VELOCITIES[j]}abs{VELOCITIES[k]}", number(turned.absolute[i, j, k])))
    for i, j, k in np.argwhere(turned.signed):
        out.append((FORCES[i] + VELOCITIES[j] + VELOCITIES[k], number(turned.signed[i, j, k])))
    if form.resistance:
        out.append((RESISTANCE, number(form.resistance)))
    return out


def placed(parameters: ParameterFile) -> tuple[str, ...]:
    """Where the link's origin and its centre of gravity are, in words."""
    at = FLU[:3] * centre_of_gravity(parameters) + 0.0
    moved = (f"centre of gravity at {at[0]:.6g} {at[1]:.6g} {at[2]:.6g} m, in <inertial><pose>",) if np.any(at) else ()
    weightless = f"{WEIGHTLESS} (<gravity> false): {states_buoyancy(parameters, NEITHER)}"
    return (AXES, "the link's origin is the reference point", *moved, weightless)


def sdf_force(files: Mapping[str, bytes], nu: Array) -> Array:
    """The system's own law (`coeflab.model.gz_link`, with file and lines of its source) of a rendered model, turned to FRD."""
    (content,) = files.values()
    return np.asarray(read_gz_link(parse_xml(content.decode())).force(nu * FLU) * FLU)


def sdf_added_mass(files: Mapping[str, bytes]) -> Array:
    """(6, 6) of <fluid_added_mass>, or of <xDotU> ... where the plugin uses them, turned to FRD."""
    (content,) = files.values()
    link = read_gz_link(parse_xml(content.decode()))
    plugin = 0.0 if link.disable_added_mass else -link.plugin_mass
    return np.asarray((link.fluid_mass + plugin) * np.outer(FLU, FLU))


def not_in_sdf(parameters: ParameterFile) -> tuple[str, ...]:
    """Terms that are no product of one or two velocities, and controls."""
    return unheld(exported_law(parameters).law, lambda t: slot(t) is not None, ideal=True)


def missing_in_sdf(parameters: ParameterFile) -> tuple[str, ...]:
    """Mass, moments of inertia and added mass, where the file has none."""
    default = "SDFormat's default, 1 kg or 1 kg m^2, stands until you write the vehicle's"
    return (*missing_mass(parameters, default), *missing_water(parameters))
